//! The floor: what it takes to read the numbers of a text and to print them back, and no more.

use std::io::Write;

/// Reads each number of `text` as a double and prints it with four decimals, by the standard library.
pub fn standard(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(text.len());
    copy_numbers(text, &mut out, |digits, out| {
        let value: f64 =
            std::str::from_utf8(digits).ok().and_then(|d| d.parse().ok()).unwrap_or(0.0);
        // Writing to a vector does not fail.
        let _ = write!(out, "{value:.4}");
    });
    out
}

/// Reads each number of `text` as whole units of its last decimal and prints it from them: the least
/// that a number takes.
pub fn by_hand(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(text.len());
    copy_numbers(text, &mut out, |digits, out| {
        let (mut units, mut decimals, mut point) = (0u64, 0, false);
        for byte in digits {
            match byte {
                b'0'..=b'9' => {
                    units = units.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                    decimals += usize::from(point);
                }
                b'.' => point = true,
                _ => {}
            }
        }
        let mut buffer = [b'0'; 24];
        let mut at = buffer.len();
        let mut written = 0;
        while units > 0 || written <= decimals {
            if written == decimals && point {
                at -= 1;
                buffer[at] = b'.';
            }
            at -= 1;
            buffer[at] = b'0' + (units % 10) as u8;
            units /= 10;
            written += 1;
        }
        if digits.first() == Some(&b'-') {
            out.push(b'-');
        }
        out.extend_from_slice(&buffer[at..]);
    });
    out
}

/// Copies `text` with every number put through `number`.
fn copy_numbers(text: &[u8], out: &mut Vec<u8>, number: impl Fn(&[u8], &mut Vec<u8>)) {
    let mut at = 0;
    while at < text.len() {
        let is_number = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'-');
        let length = text[at..].iter().take(20).take_while(|b| is_number(b)).count();
        if length == 0 {
            out.push(text[at]);
            at += 1;
        } else {
            number(&text[at..at + length], out);
            at += length;
        }
    }
}
