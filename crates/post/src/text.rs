//! Text from outside, as no control and no template can misread it.

use deunicode::deunicode_with_tofu;
use machine::{HARMLESS_SIGNS, Machine};

/// Letters, digits and harmless signs: other scripts as they are spelt in Latin letters, brackets as `<`
/// and `>`, all else as blanks.
pub(crate) fn clean(text: &str) -> String {
    let latin = deunicode_with_tofu(text, " ");
    let harmless = |c: char| match c {
        '(' | '[' | '{' => '<',
        ')' | ']' | '}' => '>',
        c if c.is_ascii_alphanumeric() || HARMLESS_SIGNS.contains(c) => c,
        _ => ' ',
    };
    latin.chars().map(harmless).collect()
}

/// Text for a comment: what the control prints of it, as far as it has room.
pub(crate) fn printed(machine: &Machine, text: &str) -> String {
    let format = &machine.format;
    let has = |c: char| c.is_ascii_alphanumeric() || format.comment_signs.contains(c);
    let text: String = clean(text).chars().map(|c| if has(c) { c } else { ' ' }).collect();
    text.trim().chars().take(format.comment_length).collect()
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
        assert_eq!(printed(&machine, "  pocket-1 (é) and more"), "pocket-1  e ");
    }
}
