//! What is wrong with a block, at its place and with the way out.

use super::Fault;
use super::block::{Block, Word};
use super::words::{Group, index};
use crate::iso::dialects::facts::Language;
use crate::kernel::coolant::Doubtful;
use program::{Diagnostic, Rule};

impl Block<'_> {
    /// A word as it is written.
    pub(crate) fn shown(&self, letter: u8) -> String {
        let word = self.words[index(letter)];
        let text = self.text.get(word.start as usize..word.end as usize).unwrap_or_default();
        String::from_utf8_lossy(text).into_owned()
    }

    /// A finding at the word of this letter.
    #[cold]
    pub(crate) fn at_word(&self, letter: u8, rule: Rule, message: impl Into<String>) -> Fault {
        let word = self.words[index(letter)];
        self.fault(rule, message, word.start as usize, word.end as usize)
    }

    /// A finding at the G or M word of this group; at the whole block where there is none.
    #[cold]
    pub(crate) fn at_group(&self, group: Group, rule: Rule, message: impl Into<String>) -> Fault {
        if self.g(group).is_none() && self.m(group).is_none() {
            return self.whole(rule, message);
        }
        let word = self.places[group as usize];
        self.fault(rule, message, word.start as usize, word.end as usize)
    }

    /// A finding about the whole block.
    #[cold]
    pub(crate) fn whole(&self, rule: Rule, message: impl Into<String>) -> Fault {
        self.fault(rule, message, 0, self.text.len())
    }

    #[cold]
    pub(super) fn fault(
        &self,
        rule: Rule,
        message: impl Into<String>,
        start: usize,
        end: usize,
    ) -> Fault {
        Diagnostic::error(rule, message).at(self.line, self.text, start, end).into()
    }

    #[cold]
    pub(super) fn same_group(&self, group: Group, start: usize, end: usize) -> Fault {
        let first = self.places[group as usize];
        let show = |from: usize, to: usize| {
            String::from_utf8_lossy(self.text.get(from..to).unwrap_or_default()).into_owned()
        };
        let message = format!(
            "{} and {} exclude each other in a block",
            show(first.start as usize, first.end as usize),
            show(start, end)
        );
        self.fault(Rule::ModalGroup, message, start, end)
    }

    #[cold]
    pub(super) fn repeated(&self, letter: u8, start: usize, end: usize) -> Fault {
        let message = format!("{} is given twice in the block", char::from(letter));
        self.fault(Rule::RepeatedWord, message, start, end)
    }

    #[cold]
    pub(super) fn unknown(&self, letter: u8, word: &Word) -> Fault {
        let (start, end) = (word.start as usize, word.end as usize);
        let shown = String::from_utf8_lossy(self.text.get(start..end).unwrap_or_default());
        let message = if matches!(letter, b'G' | b'M') {
            format!("{shown} is not known to this control")
        } else {
            format!("{} is no word of this control", char::from(letter))
        };
        let fault = Diagnostic::error(Rule::UnknownWord, message);
        let fault = match self.facts.why_refused(letter, word.value) {
            Some(reason) => fault.help(reason),
            None if letter == b'M' => fault.help(
                "where the builder of the machine has added it and nothing moves for it, list it under \
                 `auxiliary` in the machine's file, or where it switches coolant, under [coolant]",
            ),
            None => fault,
        };
        fault.at(self.line, self.text, start, end).into()
    }

    /// An M function of the control itself that the machine file names in `[coolant]`.
    #[cold]
    pub(super) fn taken_for_coolant(&self, word: &Word) -> Fault {
        let (start, end) = (word.start as usize, word.end as usize);
        let shown = String::from_utf8_lossy(self.text.get(start..end).unwrap_or_default());
        let Doubtful { message, help } = Doubtful::of_the_control(&shown);
        Diagnostic::error(Rule::Coolant, message)
            .help(help)
            .at(self.line, self.text, start, end)
            .into()
    }

    #[cold]
    pub(super) fn no_number(&self, letter: u8, at: usize, from: usize) -> Fault {
        match self.text.get(from) {
            Some(&byte @ (b'#' | b'[')) => self.stray(byte, from),
            Some(byte) if self.facts.source.is_some() && !byte.is_ascii_whitespace() => {
                let rest = self.text.get(from..).unwrap_or_default();
                let length = rest.iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
                self.nothing(at, from + length)
            }
            _ => {
                let message = format!("a number is missing after {}", char::from(letter));
                self.fault(Rule::Number, message, at, from)
            }
        }
    }

    /// The word of a CAM system's from `start` to `end` has a number that is none.
    #[cold]
    pub(super) fn nothing(&self, start: usize, end: usize) -> Fault {
        let word = String::from_utf8_lossy(self.text.get(start..end).unwrap_or_default());
        let message = format!("{word} is no number: it could not be calculated");
        Diagnostic::error(Rule::Number, message).at(self.line, self.text, start, end).into()
    }

    #[cold]
    pub(super) fn stray(&self, byte: u8, at: usize) -> Fault {
        let syntax = &self.facts.syntax;
        let message = match byte {
            b'#' | b'[' if self.facts.language == Language::Plain => {
                "this control has no parameters and does not calculate".to_owned()
            }
            b'#' => "a variable is set at the start of a block that has nothing else".to_owned(),
            b'[' | b']' | b'=' => "an expression without its word".to_owned(),
            b'$' if syntax.console => {
                "$ begins a command of the console ($H homes, $J jogs, $X unlocks, $n= sets), no block"
                    .to_owned()
            }
            b'%' if !syntax.percent => {
                "% begins no block; a line with it is for the sender (%name = sets its variables)"
                    .to_owned()
            }
            b'%' => "% stands alone on its line".to_owned(),
            b'(' => "( begins no comment on this control".to_owned(),
            b'0'..=b'9' | b'.' | b'+' | b'-' => "a number without its letter".to_owned(),
            b'a'..=b'z' if !syntax.small_letters => "small letters are no words".to_owned(),
            b'!'..=b'~' => format!("{} begins no word", char::from(byte)),
            _ => format!("byte {byte:#04x} begins no word"),
        };
        let fault = self.fault(Rule::Syntax, message, at, at + 1);
        match byte {
            b'$' if syntax.console => {
                fault.help("take it out, and give it by hand before the start").into()
            }
            b'%' if !syntax.percent => {
                fault.help("take the line out; the variables of a sender are its own").into()
            }
            b'(' => fault.help("write a comment behind ;").into(),
            b'a'..=b'z' => fault.help("write capital letters").into(),
            _ => fault,
        }
    }
}
