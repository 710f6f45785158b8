//! Decimal numbers as the files write them.

/// A decimal number with an optional sign and point, and nothing else.
pub(crate) fn decimal(text: &[u8]) -> Option<f64> {
    let digits = text.strip_prefix(b"-").or(text.strip_prefix(b"+")).unwrap_or(text);
    let plain = digits.iter().all(|c| c.is_ascii_digit() || *c == b'.');
    if !plain || !digits.iter().any(u8::is_ascii_digit) {
        return None;
    }
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// An unsigned whole number.
pub(crate) fn whole(text: &[u8]) -> Option<u32> {
    let plain = !text.is_empty() && text.iter().all(u8::is_ascii_digit);
    plain.then(|| std::str::from_utf8(text).ok()?.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_numbers_are_numbers() {
        assert_eq!(decimal(b"-.5"), Some(-0.5));
        assert_eq!(decimal(b"+12.50"), Some(12.5));
        for text in ["", "-", ".", "1e5", "inf", "1.2.3", "--1", " 1"] {
            assert_eq!(decimal(text.as_bytes()), None, "{text}");
        }
        assert_eq!(whole(b"007"), Some(7));
        assert_eq!(whole(b"99999999999"), None);
        assert_eq!(whole(b"+1"), None);
    }
}
