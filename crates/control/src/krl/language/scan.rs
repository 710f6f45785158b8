//! How KRL writes names, texts and comments.

use crate::kernel::scan::{self, Lexis};

/// KRL.
pub(crate) struct Krl;

/// A line on its way through the reader.
pub(crate) type Scan<'t> = scan::Scan<'t, Krl>;

impl Lexis for Krl {
    const COMMENT: Option<u8> = Some(b';');
    const FIRST: &'static [u8] = b"_$";
    const ANY_CASE: bool = true;
    // KSS, "Names in KRL".
    const LONGEST_NAME: usize = 24;
}
