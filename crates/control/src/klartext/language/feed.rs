//! F, and what the words of a block read of the control.

use super::registers::Registers;
use super::scan::{Scanner, Word};
use crate::kernel::Outcome;
use program::{CoolantFunctions, Rule};

/// What an F word says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FeedWord {
    /// `F` with a number, in the unit of the program.
    Value(f64),
    /// `FU`: per turn of the spindle, in the unit of the program.
    PerTurn(f64),
    /// `FMAX`: rapid in this block.
    Max,
}

/// What the words of a block can read of the control.
pub(crate) trait Readable {
    /// The Q parameters.
    fn registers(&self) -> &Registers;

    /// mm in the unit of the program.
    fn unit(&self) -> f64;

    /// The feed of the last TOOL CALL.
    fn tool_feed(&self) -> Option<FeedWord>;

    /// The M functions that the builder has added.
    fn auxiliary(&self) -> &[u32];

    /// The M functions that switch coolant, where they are not M8 and M9.
    fn coolant_functions(&self) -> CoolantFunctions;
}

/// What an F word says; `F MAX` may be written with a blank. `automatic` is the feed of the last TOOL
/// CALL, which `F AUTO` takes.
pub(crate) fn feed_word(
    s: &mut Scanner,
    word: &Word,
    automatic: Option<FeedWord>,
) -> Outcome<FeedWord> {
    match (word.address, word.number) {
        (b"FMAX", None) => Ok(FeedWord::Max),
        (b"F", None) if word.sign == 0.0 && s.take(b"MAX") => Ok(FeedWord::Max),
        (b"F" | b"FU", Some(number)) => {
            if number <= 0.0 {
                return Err(s.error(Rule::Feed, word.span, "a feed must be greater than 0"));
            }
            Ok(if word.address == b"F" {
                FeedWord::Value(number)
            } else {
                FeedWord::PerTurn(number)
            })
        }
        (b"FAUTO", None) | (b"F", None) if word.address == b"FAUTO" || s.take(b"AUTO") => automatic
            .ok_or_else(|| {
                s.error(
                    Rule::Feed,
                    word.span,
                    "F AUTO takes the feed of a TOOL CALL, which gave none",
                )
                .help("write the feed as a number")
                .into()
            }),
        (b"FZ", _) => {
            let message = "FZ is the feed of a tooth, and how many teeth the tool has is not known";
            Err(s.error(Rule::Feed, word.span, message).help("write the feed in mm/min").into())
        }
        (b"FT" | b"FMAXT", _) => {
            Err(s.error(Rule::Feed, word.span, "FT gives a time, which is not supported"))
        }
        _ => Err(unknown(s, word)),
    }
}

/// A word that is not understood where it stands.
pub(crate) fn unknown(s: &Scanner, word: &Word) -> Box<program::Diagnostic> {
    let address = String::from_utf8_lossy(word.address);
    let message = format!("the word {address} is not understood here");
    s.error(Rule::UnknownWord, word.span, message)
}
