//! What the readers of TOML and JSON say of a wrong value, in the words of the documentation.

use crate::nearest;

/// What is wrong with a value or a name in a file, and the way out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misread {
    /// What is wrong.
    pub message: String,
    /// The names that are taken there, and which of them is meant; empty where it is no matter of a name.
    pub help: String,
}

/// So many names are listed where none of them is near.
const MOST_LISTED: usize = 20;

impl Misread {
    /// From a message of `serde`: "unknown variant `linaer`, expected `linear` or `independent`".
    pub fn of(said: &str) -> Misread {
        let said = said.trim().replace('\n', "; ");
        // A text of the file stands between the same signs: what is expected stands behind the last such words.
        let (found, expected) = said.rsplit_once(", expected ").unwrap_or((&said, ""));
        let quoted = |kind: &str| {
            found.strip_prefix(kind).and_then(|rest| rest.strip_prefix('`')?.strip_suffix('`'))
        };
        let names: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
        if let Some(value) = quoted("unknown variant ") {
            return Misread {
                message: format!("`{value}` is none of its values"),
                help: listed("its values are ", value, &names),
            };
        }
        if let Some(key) = quoted("unknown field ") {
            return Misread {
                message: format!("no key of this table is called `{key}`"),
                help: listed("its keys are ", key, &names),
            };
        }
        let value = ["invalid type: ", "invalid value: "];
        let value = value.iter().find_map(|kind| found.strip_prefix(kind));
        let count = found.strip_prefix("invalid length ");
        let message = match (value.map(given), count, found.strip_prefix("missing field ")) {
            (Some(value), ..) => format!("{value} is given, and {} is needed", wanted(expected)),
            (None, Some(count), _) => {
                format!("a list of {count} is given, and {} is needed", wanted(expected))
            }
            (None, None, Some(key)) => format!("{key} is missing"),
            // One of some names.
            (None, None, None) if found == "wanted string or table" => "a text is needed".into(),
            (None, None, None) => said.clone(),
        };
        Misread { message, help: String::new() }
    }
}

/// The names that are taken, and those that are near to `name`.
fn listed(before: &str, name: &str, names: &[&str]) -> String {
    let near = nearest(name, names.iter().copied());
    let all = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let is_some = !near.is_empty() && near.split(", ").count() < names.len();
    match (is_some, names.len() <= MOST_LISTED) {
        (true, true) => format!("did you mean {near}? {before}{all}"),
        (true, false) => format!("did you mean {near}?"),
        (false, true) if !names.is_empty() => format!("{before}{all}"),
        (false, _) => String::new(),
    }
}

/// A value of the file, as `serde` calls it.
fn given(value: &str) -> String {
    let number = ["integer `", "floating point `", "boolean `"];
    let number = number.iter().find_map(|kind| value.strip_prefix(kind)?.strip_suffix('`'));
    match (number, value) {
        (Some(number), _) => number.into(),
        (None, "sequence") => "a list".into(),
        (None, "map") => "a table".into(),
        (None, value) => match value.strip_prefix("string ") {
            Some(text) => format!("the text {text}"),
            None => value.into(),
        },
    }
}

/// What a value has to be, as `serde` calls it.
fn wanted(expected: &str) -> String {
    let list = ["an array of length ", "a tuple of size "];
    let list = list.iter().find_map(|kind| expected.strip_prefix(kind));
    match (list, expected) {
        (Some(count), _) => format!("a list of {count}"),
        (None, "f64" | "f32") => "a number".into(),
        (None, "u8") => "a whole number from 0 to 255".into(),
        (None, "u16" | "u32" | "u64" | "usize") => "a whole number from 0 on".into(),
        (None, "i8" | "i16" | "i32" | "i64" | "isize") => "a whole number".into(),
        (None, "a boolean") => "true or false".into(),
        (None, "a string") => "a text".into(),
        (None, "a character") => "a text of one letter".into(),
        (None, "a sequence") => "a list".into(),
        (None, "a map") => "a table".into(),
        (None, expected) if expected.starts_with("struct ") => "a table".into(),
        (None, expected) => expected.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_value_is_told_in_words_of_the_documentation() {
        for (said, message, help) in [
            (
                "unknown variant `linaer`, expected `linear` or `independent`",
                "`linaer` is none of its values",
                "did you mean `linear`? its values are `linear`, `independent`",
            ),
            (
                "unknown variant `center`, expected `full` or `wear`",
                "`center` is none of its values",
                "its values are `full`, `wear`",
            ),
            // What stands in the file decides nothing.
            (
                "unknown variant `a`, expected `b`, expected one of `drill`, `deep`, `tap`",
                "`a`, expected `b` is none of its values",
                "its values are `drill`, `deep`, `tap`",
            ),
            (
                "unknown field `maxx`, expected `min` or `max`",
                "no key of this table is called `maxx`",
                "did you mean `max`? its keys are `min`, `max`",
            ),
            (
                "unknown field `zzzzzzzz`, expected `min` or `max`",
                "no key of this table is called `zzzzzzzz`",
                "its keys are `min`, `max`",
            ),
            (
                "invalid type: string \"a\", expected f64",
                "the text \"a\" is given, and a number is needed",
                "",
            ),
            (
                "invalid type: sequence, expected a boolean",
                "a list is given, and true or false is needed",
                "",
            ),
            ("invalid type: map, expected a string", "a table is given, and a text is needed", ""),
            (
                "invalid type: integer `3`, expected struct SpindleSheet",
                "3 is given, and a table is needed",
                "",
            ),
            (
                "invalid type: floating point `2.5`, expected u32",
                "2.5 is given, and a whole number from 0 on is needed",
                "",
            ),
            (
                "invalid value: integer `300`, expected u8",
                "300 is given, and a whole number from 0 to 255 is needed",
                "",
            ),
            (
                "invalid length 2, expected an array of length 3",
                "a list of 2 is given, and a list of 3 is needed",
                "",
            ),
            ("missing field `title`", "`title` is missing", ""),
            ("duplicate key", "duplicate key", ""),
            ("3 is given, and 0 to 9 is needed", "3 is given, and 0 to 9 is needed", ""),
        ] {
            let found = Misread::of(said);
            assert_eq!((found.message.as_str(), found.help.as_str()), (message, help), "{said}");
        }
    }
}
