//! How texts begin, whoever has saved them.

use crate::{Diagnostic, Outcome, Rule};

/// U+FEFF in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A text without the byte order mark that editors of some systems put before UTF-8.
pub fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text)
}

/// Whether a text is in UTF-16, with its byte order mark or without: then every second byte of ASCII is zero.
pub fn is_utf_16(text: &[u8]) -> bool {
    let is_ascii = |byte: u8| byte != 0 && byte.is_ascii();
    match *text {
        [0xfe, 0xff, ..] | [0xff, 0xfe, ..] => true,
        [a, 0, b, 0, ..] | [0, a, 0, b, ..] => is_ascii(a) && is_ascii(b),
        _ => false,
    }
}

/// What is said of a file in UTF-16, which no reader takes.
pub fn utf_16() -> Diagnostic {
    Diagnostic::error(Rule::Encoding, "this file is in UTF-16")
        .help("save it as plain text (ASCII, Latin-1 or UTF-8)")
}

/// A text that has to be UTF-8, without its byte order mark.
///
/// # Errors
/// It is in UTF-16, or anything else.
pub fn utf_8(text: &[u8]) -> Outcome<&str> {
    if is_utf_16(text) {
        return Err(utf_16().into());
    }
    std::str::from_utf8(without_mark(text)).map_err(|_| {
        let found = Diagnostic::error(Rule::Encoding, "this file is not UTF-8");
        found.help("save it as UTF-8").into()
    })
}
