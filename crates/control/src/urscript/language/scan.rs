//! How URScript writes names, texts and comments.

use crate::kernel::scan::{self, Lexis};

/// URScript.
pub(crate) struct UrScript;

/// A line on its way through the reader.
pub(crate) type Scan<'t> = scan::Scan<'t, UrScript>;

impl Lexis for UrScript {
    const COMMENT: Option<u8> = Some(b'#');
    const FIRST: &'static [u8] = b"_";
    const ANY_CASE: bool = false;
}
