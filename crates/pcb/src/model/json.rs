//! JSON as the tree that TOML is read into, so that each value knows its place.

use super::Mistake;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// How deep lists and tables may lie in each other: two for each group.
const DEEPEST: usize = 140;

/// A value with its place.
type Placed<'a> = Spanned<DeValue<'a>>;

/// The tree of a text.
pub(super) fn tree(text: &str) -> Result<Placed<'_>, Mistake> {
    let value: &RawValue = serde_json::from_str(text).map_err(|error| mistake(&error, text, 0))?;
    branch(value, text, DEEPEST)
}

fn branch<'a>(value: &'a RawValue, text: &'a str, depth: usize) -> Result<Placed<'a>, Mistake> {
    let raw = value.get();
    // A value that is read as it stands is a piece of the text.
    let start = (raw.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
    let span = start..start + raw.len();
    let Some(depth) = depth.checked_sub(1) else {
        let message = format!("lists and tables lie more than {DEEPEST} deep in each other");
        return Err(Mistake::new(message, "put groups next to each other", span));
    };
    let wrong = |error| mistake(&error, text, start);
    let value = match raw.as_bytes().first() {
        Some(b'{') => {
            let Entries(entries) = serde_json::from_str(raw).map_err(wrong)?;
            let mut table = DeTable::new();
            for (key, value) in entries {
                let value = branch(value, text, depth)?;
                let place = before(&value.span(), key.len(), text);
                if table.contains_key(key.as_ref()) {
                    let message = format!("`{key}` is given twice");
                    return Err(Mistake::new(message, "keep one of them", place));
                }
                table.insert(Spanned::new(place, key), value);
            }
            DeValue::Table(table)
        }
        Some(b'[') => {
            let items: Vec<&RawValue> = serde_json::from_str(raw).map_err(wrong)?;
            let mut array = DeArray::new();
            for item in items {
                array.push(branch(item, text, depth)?);
            }
            DeValue::Array(array)
        }
        Some(b'"') => {
            let Text(string) = serde_json::from_str(raw).map_err(wrong)?;
            DeValue::String(string)
        }
        Some(b't') => DeValue::Boolean(true),
        Some(b'f') => DeValue::Boolean(false),
        Some(b'n') => {
            let help = "leave out what has no value";
            return Err(Mistake::new("`null` is no value", help, span));
        }
        // A number of JSON is one of TOML.
        _ => DeValue::parse(raw).map_err(|error| super::of_toml(&error, text))?.into_inner(),
    };
    Ok(Spanned::new(span, value))
}

/// The place of a key of so many bytes before its value.
fn before(value: &Range<usize>, length: usize, text: &str) -> Range<usize> {
    let key = text.get(..value.start).and_then(|text| text.rfind(':'));
    let end = key.and_then(|colon| text.get(..colon)?.rfind('"')).unwrap_or(value.start);
    end.saturating_sub(length)..end
}

/// What serde_json says, within what starts at `from`.
fn mistake(error: &serde_json::Error, text: &str, from: usize) -> Mistake {
    let rest = text.get(from..).unwrap_or_default();
    let lines = rest.split_inclusive('\n').take(error.line().saturating_sub(1));
    let at = from + lines.map(str::len).sum::<usize>() + error.column().saturating_sub(1);
    let message = error.to_string();
    // serde_json ends its message with the place.
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(said, _)| said);
    Mistake::new(
        format!("this is no JSON: {message}"),
        "mend it there or a little before",
        at..at + 1,
    )
}

/// The entries of a table, in their order.
struct Entries<'a>(Vec<(Cow<'a, str>, &'a RawValue)>);

/// A text, copied only where it has escapes.
#[derive(Deserialize)]
struct Text<'a>(#[serde(borrow)] Cow<'a, str>);

impl<'de: 'a, 'a> Deserialize<'de> for Entries<'a> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Table;
        impl<'de> Visitor<'de> for Table {
            type Value = Entries<'de>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<'de>, A::Error> {
                let mut entries = Vec::new();
                while let Some((Text(key), value)) = map.next_entry()? {
                    entries.push((key, value));
                }
                Ok(Entries(entries))
            }
        }
        from.deserialize_map(Table)
    }
}
