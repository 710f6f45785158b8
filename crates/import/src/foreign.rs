//! A post of another system, as its reader understands it.

use std::collections::BTreeMap;

/// A post: what it says of words, and the lines of its parts.
#[derive(Debug, Default)]
pub(crate) struct Post {
    /// What a person calls it.
    pub title: String,
    /// Ending of its programs.
    pub extension: Option<String>,
    /// Whether its programs are in inches.
    pub inches: bool,
    /// What ends a line.
    pub line_end: Option<String>,
    /// First block number, step, and the largest.
    pub numbers: [Option<u32>; 3],
    /// How words are written, by their names in our files.
    pub words: BTreeMap<&'static str, Form>,
    /// The lines of each part that is there.
    pub parts: BTreeMap<Part, Vec<Line>>,
}

/// How a word is written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Form {
    pub address: String,
    /// Decimals, zeros at the end kept; those of the control where nothing is said.
    pub decimals: Option<u8>,
    /// Whether it is left out while it repeats itself; as the control has it where nothing is said.
    pub modal: Option<bool>,
    pub scale: f64,
}

/// What a part of a post is written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    Start,
    ToolChange,
    /// A new toolpath with the same tool.
    Segment,
    Rapid,
    Linear,
    ArcCw,
    ArcCcw,
    HelixCw,
    HelixCcw,
    /// Drilling one hole.
    Hole,
    Dwell,
    End,
}

/// A line of a part.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    /// Where it stands, from 1.
    pub number: u32,
    pub pieces: Vec<Piece>,
}

/// A piece of a line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Piece {
    Text(String),
    /// A word of ours.
    Word(&'static str),
    /// A variable of ours.
    Value(&'static str),
    /// A place that only the other system knows (home, safe height); whether along Z.
    Home {
        z: bool,
    },
    /// Nothing that we have: as it is written, and why.
    Unknown(String, &'static str),
}

impl Line {
    /// The words that it places.
    pub fn words(&self) -> impl Iterator<Item = &'static str> {
        self.pieces.iter().filter_map(|piece| match piece {
            Piece::Word(word) => Some(*word),
            _ => None,
        })
    }
}
