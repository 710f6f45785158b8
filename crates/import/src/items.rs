//! A line of a post cut into the words of a program, each with what it does: a header says at one place
//! what our files say at several.

use crate::foreign::{Line, Part, Piece, Post};
use crate::text;
use std::mem::take;

/// A word of a line, as our template has it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Item {
    pub text: String,
    pub role: Role,
}

/// What a word does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Role {
    Blank,
    /// The block number.
    Number,
    Comment,
    /// `G20`, `G21`, `G70`, `G71`.
    Unit,
    /// `G0`, `G1`.
    Motion,
    /// A coordinate, or a place that only the other system knows; whether along Z.
    Coordinate {
        z: bool,
    },
    /// `G28`, `G30`, `G53`: the coordinates of the line are those of the machine.
    Reference,
    Feed,
    /// `M3`, `M4` and the speed.
    Spindle,
    /// Which tool.
    Tool,
    /// `M6`.
    Change,
    /// `G43`, H.
    Length,
    /// `M7`, `M8`.
    Coolant,
    /// `M0`, `M1`.
    Stop,
    /// `M2`, `M30`.
    End,
    /// `%`.
    Tape,
    /// A function of the machine, which may have words of its own.
    Function,
    /// A code that says what the other words of its line mean: `G10`, `G92`.
    Command,
    /// Any other word.
    Other,
    /// What cannot be written, and why.
    Unknown(&'static str),
}

/// The words of a line of `part`.
pub(crate) fn items(line: &Line, part: Part, post: &Post) -> Vec<Item> {
    let mut cut = Cutter { items: Vec::new(), word: String::new(), comment: None };
    for piece in &line.pieces {
        match piece {
            Piece::Text(text) => text.chars().for_each(|c| cut.character(c)),
            Piece::Word(word) => cut.placed(word, post),
            Piece::Value(name) => cut.value(name, part),
            Piece::Home { z } if cut.comment.is_none() => {
                // An address before it is its own.
                cut.address();
                cut.push(String::new(), Role::Coordinate { z: *z });
            }
            Piece::Home { .. } => cut.push(String::new(), Role::Unknown(HOME)),
            Piece::Unknown(text, why) => cut.push(text.clone(), Role::Unknown(why)),
        }
    }
    cut.end_word();
    bind(&mut cut.items);
    cut.items
}

/// Leaves the words of a command with it: `M84 S0` is no speed, `G92 X0` no way.
fn bind(items: &mut [Item]) {
    let any = |role: fn(&Item) -> bool| items.iter().any(role);
    let moves = any(|item| {
        item.role == Role::Motion
            || matches!(code(&item.text), Some(('M', m)) if m == 3.0 || m == 4.0)
    });
    if !any(|item| item.role == Role::Command)
        && (moves || !any(|item| item.role == Role::Function))
    {
        return;
    }
    for item in items {
        item.role = match item.role {
            Role::Coordinate { .. } if item.text.is_empty() => Role::Unknown(HOME),
            Role::Spindle | Role::Feed if item.text.contains('{') => Role::Unknown(NOT_HERE),
            Role::Coordinate { .. } | Role::Spindle | Role::Feed | Role::Length => Role::Other,
            ref role => role.clone(),
        };
    }
}

const HOME: &str = "a home or a safe height is not known where a program of ours is written";
const OUTSIDE: &str = "outside of a comment a control would take it for words";
const NOT_HERE: &str = "has no value here";
const SIGNS: &str = "holds signs that a block of ours cannot";

struct Cutter {
    items: Vec<Item>,
    /// The word that has begun.
    word: String,
    /// What ends the comment that has begun; nothing but the end of the line where it is `\n`.
    comment: Option<char>,
}

impl Cutter {
    fn character(&mut self, c: char) {
        if let Some(end) = self.comment {
            match text::literal(c.encode_utf8(&mut [0; 4])) {
                true => self.inside(c.encode_utf8(&mut [0; 4])),
                false => self.push(c.to_string(), Role::Unknown(SIGNS)),
            }
            if c == end {
                self.comment = None;
            }
        } else if c == '(' || c == ';' {
            self.end_word();
            self.comment = Some(if c == '(' { ')' } else { '\n' });
            self.push(c.to_string(), Role::Comment);
        } else if c.is_ascii_whitespace() {
            self.end_word();
            self.push(" ".to_owned(), Role::Blank);
        } else {
            let number = c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
            let begins = !number && !self.word.ends_with(|c: char| c.is_ascii_alphabetic());
            if begins {
                self.end_word();
            }
            self.word.push(c);
        }
    }

    fn push(&mut self, text: String, role: Role) {
        self.end_word();
        self.items.push(Item { text, role });
    }

    fn end_word(&mut self) {
        if !self.word.is_empty() {
            let text = take(&mut self.word);
            let role = if text::literal(&text) { role(&text) } else { Role::Unknown(SIGNS) };
            self.items.push(Item { text, role });
        }
    }

    /// The letters that stand right before a variable; a word that has its number is one of its own.
    fn address(&mut self) -> String {
        if self.word.contains(|c: char| c.is_ascii_digit()) {
            self.end_word();
        }
        take(&mut self.word)
    }

    /// A word of ours.
    fn placed(&mut self, word: &'static str, post: &Post) {
        let own = post.words.contains_key(word);
        let placed = format!("{{{{{word}}}}}");
        if self.comment.is_some() {
            match word {
                "T" => self.inside("{{ tool.number }}"),
                _ => self.push(String::new(), Role::Unknown("is no text for a comment")),
            }
            return;
        }
        let role = match word {
            "N" => Role::Number,
            "F" => Role::Feed,
            "S" => Role::Spindle,
            "T" => Role::Tool,
            _ => return self.push(placed, Role::Unknown(NOT_HERE)),
        };
        match (word, self.address().as_str()) {
            ("T", "H") => self.push("H".to_owned(), Role::Length),
            // The address of the word stands in the line where the post has none for it.
            ("T", "T") => self.push(placed, role),
            ("T", "") if own => self.push(placed, role),
            ("T", _) => self.push(String::new(), Role::Unknown("a tool is called by T")),
            (_, before) if !text::literal(before) => {
                self.push(before.to_owned(), Role::Unknown(SIGNS));
            }
            (_, before) => self.push(format!("{before}{placed}"), role),
        }
    }

    /// A variable of ours.
    fn value(&mut self, name: &'static str, part: Part) {
        let known = match name {
            "operation.name" => part == Part::Segment,
            "tool.name" | "tool.diameter" => matches!(part, Part::Start | Part::ToolChange),
            _ => true,
        };
        match (self.comment.is_some(), name) {
            _ if !known => self.push(String::new(), Role::Unknown(NOT_HERE)),
            (false, _) => self.push(String::new(), Role::Unknown(OUTSIDE)),
            // Where the source is silent it is not there.
            (true, "tool.diameter") => {
                self.inside("{% if tool.diameter %}{{ tool.diameter }}{% endif %}");
            }
            (true, _) => self.inside(&format!("{{{{ {name} }}}}")),
        }
    }

    /// More of the comment.
    fn inside(&mut self, text: &str) {
        match self.items.last_mut() {
            Some(item) if item.role == Role::Comment => item.text.push_str(text),
            _ => self.items.push(Item { text: text.to_owned(), role: Role::Comment }),
        }
    }
}

/// A code without its leading zeros: `G00` is `G0`.
pub(crate) fn code(word: &str) -> Option<(char, f64)> {
    let letter = word.chars().next().filter(char::is_ascii_alphabetic)?;
    let number = word.get(1..)?.parse().ok()?;
    Some((letter.to_ascii_uppercase(), number))
}

/// The modes, which need no other word.
const SIMPLE: &[u32] =
    &[17, 18, 19, 40, 49, 54, 55, 56, 57, 58, 59, 61, 64, 80, 90, 91, 94, 97, 98, 99];

fn role(word: &str) -> Role {
    let Some((letter, number)) = code(word) else {
        return if word == "%" { Role::Tape } else { Role::Other };
    };
    let whole = if number.fract() == 0.0 { number as i64 } else { -1 };
    match (letter, whole) {
        ('G', 0 | 1) => Role::Motion,
        ('G', 20 | 21 | 70 | 71) => Role::Unit,
        ('G', 28 | 30 | 53) => Role::Reference,
        ('G', 43) | ('H', _) => Role::Length,
        ('M', 3 | 4) | ('S', _) => Role::Spindle,
        ('M', 6) => Role::Change,
        ('M', 7 | 8) => Role::Coolant,
        ('M', 0 | 1) => Role::Stop,
        ('M', 2 | 30) => Role::End,
        ('X' | 'Y' | 'A' | 'B' | 'C', _) => Role::Coordinate { z: false },
        ('Z', _) => Role::Coordinate { z: true },
        ('F', _) => Role::Feed,
        ('T', _) => Role::Unknown("calls a tool of its own"),
        ('G', 4) => Role::Unknown("is a dwell, and the toolpath says where the tool dwells"),
        ('G', _) if SIMPLE.contains(&(number.trunc() as u32)) => Role::Other,
        ('G', _) => Role::Command,
        ('M', 5 | 9) => Role::Other,
        ('M', _) => Role::Function,
        _ => Role::Other,
    }
}

/// The codes of a text: letters with a number.
pub(crate) fn codes(text: &str) -> impl Iterator<Item = (char, f64)> + use<> {
    let mut words: Vec<String> = Vec::new();
    for c in text.chars() {
        match words.last_mut() {
            Some(word) if c.is_ascii_digit() || matches!(c, '.' | '-' | '+') => word.push(c),
            _ => words.push(c.to_string()),
        }
    }
    words.into_iter().filter_map(|word| code(&word))
}
