//! Attributes (chapter 5): what the file, its apertures and its objects are for.
//!
//! Of the file all are kept; of apertures the function, of objects net, component and pin. Others do not
//! say anything that a machine needs.

use super::image::Image;
use crate::report::{Outcome, fault};
use program::Rule;
use std::sync::Arc;

/// What an object is part of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Names of its nets (`.N`): none where the file does not say, or the copper is part of none.
    pub nets: Option<Arc<[String]>>,
    /// Name of the component (`.C`, `.P`), such as `U1`.
    pub component: Option<Arc<str>>,
    /// Name of the pin (`.P`), such as `7`.
    pub pin: Option<Arc<str>>,
}

impl Attributes {
    /// Nothing is said.
    pub(super) const NONE: Attributes = Attributes { nets: None, component: None, pin: None };
}

/// The attributes that hold for what comes next.
#[derive(Default)]
pub(super) struct Dictionary {
    object: Attributes,
    /// What apertures and regions are for.
    pub(super) function: Option<String>,
    /// Index of `object` in the image, once something has it.
    index: Option<u32>,
}

impl Dictionary {
    /// Obeys `TF`, `TA`, `TO` or `TD`: `text` is all between `%` and `*`, or what a comment holds.
    pub(super) fn obey(&mut self, text: &[u8], image: &mut Image) -> Outcome {
        let text = String::from_utf8_lossy(text);
        let text: String = text.chars().filter(|c| !matches!(c, '\n' | '\r')).collect();
        let (kind, rest) = text.split_at_checked(2).unwrap_or((&text, ""));
        let (name, rest) =
            rest.split_once(',').map_or((rest, None), |(name, rest)| (name, Some(rest)));
        let values: Vec<String> =
            rest.map(|rest| rest.split(',').map(unescaped).collect()).unwrap_or_default();
        if name.is_empty() && kind != "TD" {
            let help = "an attribute is %TF.Name,value*%";
            return Err(fault(
                Rule::Attribute,
                format!("{kind} without the name of an attribute"),
                help,
            ));
        }
        match kind {
            "TF" => image.file_attributes.push((name.into(), values)),
            "TA" if name == ".AperFunction" => self.function = Some(values.join(",")),
            "TO" => {
                let mut values = values.into_iter().filter(|value| !value.is_empty());
                self.index = None;
                match name {
                    ".N" => {
                        let nets: Vec<String> = values.collect();
                        self.object.nets = (!nets.is_empty()).then(|| nets.into());
                    }
                    ".C" => self.object.component = values.next().map(Arc::from),
                    ".P" => {
                        self.object.component = values.next().map(Arc::from);
                        self.object.pin = values.next().map(Arc::from);
                    }
                    _ => {}
                }
            }
            "TD" => self.delete(name),
            _ => {}
        }
        Ok(())
    }

    /// Index of what holds for an object, in `image`.
    pub(super) fn index(&mut self, image: &mut Image) -> u32 {
        if let Some(index) = self.index {
            return index;
        }
        if image.attributes.last() != Some(&self.object) {
            image.attributes.push(self.object.clone());
        }
        let index = u32::try_from(image.attributes.len() - 1).unwrap_or(u32::MAX);
        self.index = Some(index);
        index
    }

    /// Section 5.5: one attribute, or all of apertures and objects.
    fn delete(&mut self, name: &str) {
        let all = name.is_empty();
        if all || name == ".AperFunction" {
            self.function = None;
        }
        if all || name == ".N" {
            self.object.nets = None;
        }
        if all || name == ".P" {
            self.object.pin = None;
        }
        if all || name == ".P" || name == ".C" {
            self.object.component = None;
        }
        self.index = None;
    }
}

/// With `\u002C` as the character that it stands for (section 3.4.3); `\002C` is how KiCad 5 wrote it.
fn unescaped(field: &str) -> String {
    let mut parts = field.split('\\');
    let mut text = String::from(parts.next().unwrap_or_default());
    for part in parts {
        let hex = part.strip_prefix(['u', 'U']).unwrap_or(part);
        let code = hex.get(..4).and_then(|hex| u32::from_str_radix(hex, 16).ok());
        match code.and_then(char::from_u32) {
            Some(character) => {
                text.push(character);
                text.push_str(&hex[4..]);
            }
            None => {
                text.push('\\');
                text.push_str(part);
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escaped_characters() {
        assert_eq!(unescaped(r"a\u002Cb\u0025"), "a,b%");
        assert_eq!(unescaped(r"C:\temp"), r"C:\temp");
        assert_eq!(unescaped(r"\u00"), r"\u00");
    }
}
