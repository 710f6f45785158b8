//! Text from outside, as no control and no template can misread it.

use deunicode::deunicode_with_tofu;
use machine::{COMMA, HARMLESS_SIGNS, Machine};

/// Letters, digits and harmless signs: other scripts as they are spelt in Latin letters, brackets as `<`
/// and `>`, all else as blanks.
pub(crate) fn clean(text: &str) -> String {
    with_signs(text, |c| HARMLESS_SIGNS.contains(c))
}

fn with_signs(text: &str, has: impl Fn(char) -> bool) -> String {
    let latin = deunicode_with_tofu(text, " ");
    let harmless = |c: char| match c {
        '(' | '[' | '{' => '<',
        ')' | ']' | '}' => '>',
        c if c.is_ascii_alphanumeric() || has(c) => c,
        _ => ' ',
    };
    latin.chars().map(harmless).collect()
}

/// Text for a comment: what the control prints of it, as far as it has room.
pub(crate) fn printed(machine: &Machine, text: &str) -> String {
    let format = &machine.format;
    let text = with_signs(text, |c| HARMLESS_SIGNS.contains(c) || c == COMMA);
    let has = |c: char| c.is_ascii_alphanumeric() || format.comment_signs.contains(c);
    shortened(spaced(&text, has).trim(), format.comment_length, has('.'))
}

/// The same with blanks for what a control does not print, none of them next to another blank.
fn spaced(text: &str, has: impl Fn(char) -> bool) -> String {
    let mut spaced = String::with_capacity(text.len());
    let mut replaced = false;
    for c in text.chars() {
        if !has(c) {
            replaced = true;
            if !spaced.ends_with(' ') {
                spaced.push(' ');
            }
        } else if !(replaced && c == ' ') {
            replaced = false;
            spaced.push(c);
        }
    }
    spaced
}

/// Text of ASCII, cut at a word where it is longer than `most`, with dots where the control prints them.
fn shortened(text: &str, most: usize, has_dots: bool) -> String {
    const DOTS: &str = "...";
    if text.len() <= most {
        return text.into();
    }
    let dots = if has_dots && most > 2 * DOTS.len() { DOTS } else { "" };
    let room = text.get(..most - dots.len()).unwrap_or_default();
    // A word that alone takes half of the room is cut itself.
    let whole = room.rfind(' ').filter(|at| text.as_bytes()[room.len()] != b' ' && *at > most / 2);
    format!("{}{dots}", room[..whole.unwrap_or(room.len())].trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_letters_are_spelt_in_latin_ones() {
        assert_eq!(clean("Größe Ø12 façade"), "Grosse O12 facade");
        assert_eq!(clean("Výměna nástroje, žlutý kůň"), "Vymena nastroje  zluty kun");
        assert_eq!(clean("чаша"), "chasha");
        assert_eq!(clean("\u{10FFFF}\u{E000}"), "  ");
    }

    #[test]
    fn nothing_ends_a_comment_or_is_a_command_in_it() {
        assert_eq!(clean("pocket (rough) [2]"), "pocket <rough> <2>");
        assert_eq!(
            clean("a\nG0 X1 ; \"b\" {{ T }} %!?~$'MSG,x"),
            "a G0 X1    b  << T >>       MSG x"
        );
        let all: String = (0..=0x2FFFu32).filter_map(char::from_u32).collect();
        assert!(
            clean(&all).chars().all(|c| c.is_ascii_alphanumeric() || HARMLESS_SIGNS.contains(c))
        );
    }

    #[test]
    fn a_control_declares_its_signs_and_its_longest_comment() {
        let control = "extends = \"grbl\"\n[format]\ncomment_signs = \" -\"\ncomment_length = 12";
        let machine = machine::load_text("m.toml", control).unwrap();
        assert_eq!(printed(&machine, "  pocket-1 (é) and more"), "pocket-1 e");
    }

    #[test]
    fn a_comment_that_is_too_long_ends_at_a_word() {
        let control = "extends = \"fanuc-31i\"\n[format]\ncomment_length = 20";
        let machine = machine::load_text("m.toml", control).unwrap();
        assert_eq!(printed(&machine, "finish, spot, drill, peck, ream"), "finish, spot,...");
        assert_eq!(printed(&machine, "twenty letters stand"), "twenty letters stand");
        assert_eq!(printed(&machine, "Donaudampfschifffahrtsgesellschaft"), "Donaudampfschifff...");
        assert_eq!(shortened("one two three", 7, false), "one two");
        assert_eq!(shortened("one two three", 6, false), "one tw");
    }

    /// `(MSG,...)` and its kin are commands of LinuxCNC.
    #[test]
    fn a_comma_stands_where_a_control_reads_it_as_text() {
        let of = |name| printed(&machine::load(name).unwrap(), "MSG, 2 holes");
        assert_eq!(of("generic-3axis-fanuc"), "MSG, 2 holes");
        assert_eq!(of("generic-3axis-linuxcnc"), "MSG 2 holes");
    }
}
