//! The words of the control structures, and which of them belong together.

/// A word of a control structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Word {
    If,
    Else,
    EndIf,
    Loop,
    EndLoop,
    For,
    EndFor,
    While,
    EndWhile,
    Repeat,
    Until,
}

/// The words, and the name of each.
const WORDS: [(&str, Word); 11] = [
    ("IF", Word::If),
    ("ELSE", Word::Else),
    ("ENDIF", Word::EndIf),
    ("LOOP", Word::Loop),
    ("ENDLOOP", Word::EndLoop),
    ("FOR", Word::For),
    ("ENDFOR", Word::EndFor),
    ("WHILE", Word::While),
    ("ENDWHILE", Word::EndWhile),
    ("REPEAT", Word::Repeat),
    ("UNTIL", Word::Until),
];

impl Word {
    /// The word of that name.
    pub fn named(name: &str) -> Option<Word> {
        WORDS.iter().find(|(n, _)| *n == name).map(|(_, word)| *word)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        WORDS.iter().find(|(_, word)| *word == self).map_or("", |(name, _)| name)
    }

    /// The word that opened what this one ends.
    pub fn opener(self) -> Option<Word> {
        Some(match self {
            Word::EndIf | Word::Else => Word::If,
            Word::EndLoop => Word::Loop,
            Word::EndFor => Word::For,
            Word::EndWhile => Word::While,
            Word::Until => Word::Repeat,
            Word::If | Word::Loop | Word::For | Word::While | Word::Repeat => return None,
        })
    }
}
