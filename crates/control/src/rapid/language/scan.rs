//! How RAPID writes names, texts and comments, and how a module is gone through. A statement may go over several lines.

use crate::kernel::scan::{self, Lexis};
use program::{Outcome, Rule};

/// RAPID.
pub(crate) struct Rapid;

/// A module on its way through the reader.
pub(crate) type Scan<'t> = scan::Scan<'t, Rapid>;

impl Lexis for Rapid {
    const COMMENT: Option<u8> = Some(b'!');
    const FIRST: &'static [u8] = b"";
    const ANY_CASE: bool = true;
    // "Identifiers" of the RAPID manual.
    const LONGEST_NAME: usize = 32;
    const DOUBLED_QUOTES: bool = true;
    const LONGEST_TEXT: usize = 80;
}

impl<'t> Scan<'t> {
    /// The text of the comment that begins here.
    pub(crate) fn comment(&mut self) -> Option<&'t [u8]> {
        let rest = self.rest().strip_prefix(b"!")?;
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        self.at += 1 + length;
        rest.get(..length).map(<[u8]>::trim_ascii)
    }

    /// Goes behind the next `;` that is in no text and no comment.
    ///
    /// # Errors
    /// There is none.
    pub(crate) fn skip(&mut self) -> Outcome {
        let from = self.at;
        loop {
            match self.peek() {
                None => return Err(self.since(from, Rule::Syntax, "`;` is missing behind this")),
                Some(b';') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(b'"') => drop(self.text()?),
                Some(_) => self.at += 1,
            }
        }
    }
}
