//! How LS writes names, numbers and indices.

use crate::kernel::decimal;
use crate::kernel::scan::{self, Lexis};
use program::{Outcome, Rule};

/// LS.
pub(crate) struct Ls;

/// A piece of the text on its way through the reader.
pub(crate) type Scan<'t> = scan::Scan<'t, Ls>;

impl Lexis for Ls {
    const COMMENT: Option<u8> = None;
    const FIRST: &'static [u8] = b"_";
    const ANY_CASE: bool = false;
}

impl Scan<'_> {
    /// Takes a decimal with its sign, where one comes next.
    pub(crate) fn decimal(&mut self) -> Option<f64> {
        self.peek();
        let before = self.at;
        let negative = self.take(b'-');
        self.peek();
        match decimal::parse(self.rest()) {
            Some(read) => {
                self.at += read.len;
                Some(if negative { -read.value } else { read.value })
            }
            None => {
                self.at = before;
                None
            }
        }
    }

    /// Takes a whole number in square brackets, behind which a remark may stand (`[1:spindle]`).
    ///
    /// # Errors
    /// There is none, or it is above `most`.
    pub(crate) fn index(&mut self, most: u32) -> Outcome<u32> {
        self.expect("[")?;
        let from = self.at;
        let Some(number) = self.decimal() else {
            return Err(self.wrong("a number in brackets is needed here"));
        };
        if number.fract() != 0.0 || !(0.0..=f64::from(most)).contains(&number) {
            let message = format!("the number is a whole one from 0 to {most}");
            return Err(self.since(from, Rule::Index, message));
        }
        if self.take(b':') {
            let rest = self.rest();
            self.at += rest.iter().take_while(|byte| **byte != b']').count();
        }
        Ok(number as u32)
    }
}
