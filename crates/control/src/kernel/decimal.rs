//! Decimal numbers as NC programs write them: a sign, digits, a point; never an exponent.

/// A number and how it was written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Decimal {
    /// Its value, the nearest double.
    pub value: f64,
    /// How many bytes it takes, the sign included.
    pub len: usize,
    /// Whether it has a decimal point.
    pub point: bool,
    /// How many digits it has before the point, and behind it.
    pub digits: [usize; 2],
}

/// Powers of ten that a double holds exactly.
pub(crate) const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// By what so many digits are shifted to the left.
const SCALES: [u64; 9] = [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// The number that `text` begins with (`-1.5`, `+3.`, `.25`), or `None` where there is no digit.
///
/// The value is correctly rounded: up to 15 digits the digits and the power of ten are both exact
/// doubles, so one division rounds once (Clinger 1990); longer ones go to the standard library.
#[inline]
pub fn parse(text: &[u8]) -> Option<Decimal> {
    let (negative, sign) = match text.first() {
        Some(b'-') => (true, 1),
        Some(b'+') => (false, 1),
        _ => (false, 0),
    };
    let (mut number, mut at) = (0u64, sign);
    // Few digits stand before the point.
    while let Some(digit @ 0..=9) = text.get(at).map(|byte| byte.wrapping_sub(b'0')) {
        number = number.wrapping_mul(10).wrapping_add(u64::from(digit));
        at += 1;
    }
    let integer = at - sign;
    let point = text.get(at) == Some(&b'.');
    let mut places = 0;
    if point {
        at += 1;
        (number, places) = digits(text.get(at..).unwrap_or_default(), number);
    }
    let len = at + places;
    let magnitude = match integer + places {
        0 => return None,
        // Below 2^53, and a signed number is faster to convert.
        1..=15 => number as i64 as f64 / POWERS[places],
        _ => std::str::from_utf8(&text[sign..len]).ok()?.parse().ok()?,
    };
    let value = if negative { -magnitude } else { magnitude };
    Some(Decimal { value, len, point, digits: [integer, places] })
}

/// The digits at the start of `text` behind those of `number`, and how many they are.
fn digits(mut text: &[u8], mut number: u64) -> (u64, usize) {
    let mut count = 0;
    while let Some((eight, rest)) = text.split_first_chunk() {
        let (value, digits) = leading(u64::from_le_bytes(*eight));
        number = number.wrapping_mul(SCALES[digits]).wrapping_add(value);
        count += digits;
        if digits < 8 {
            return (number, count);
        }
        text = rest;
    }
    for &byte in text {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            break;
        }
        number = number.wrapping_mul(10).wrapping_add(u64::from(digit));
        count += 1;
    }
    (number, count)
}

/// The value of the digits with which eight bytes begin, the first of which is the lowest, and how many they
/// are: all at once (Lemire, "Quickly parsing eight digits", 2018).
#[inline]
fn leading(bytes: u64) -> (u64, usize) {
    const EACH: u64 = u64::MAX / 0xFF;
    let digits = bytes ^ (EACH * 0x30);
    // The highest bit of each byte that is more than 9.
    let others = (((digits & (EACH * 0x7F)) + EACH * (0x7F - 9)) | digits) & (EACH * 0x80);
    let count = others.trailing_zeros() / 8;
    // Zeros before them, in place of what follows them.
    let digits = digits.checked_shl(64 - 8 * count).unwrap_or(0);
    let pairs = (digits * 10).wrapping_add(digits >> 8);
    let pair = |at: u32| (pairs >> at) & 0x0000_00FF_0000_00FF;
    let value = (pair(0).wrapping_mul(100 + (1_000_000 << 32)))
        .wrapping_add(pair(16).wrapping_mul(1 + (10_000 << 32)))
        >> 32;
    (value, count as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_read_up_to_the_first_other_byte() {
        let read = |text: &str| parse(text.as_bytes()).map(|d| (d.value, d.len, d.point));
        assert_eq!(read("-1.5Y2"), Some((-1.5, 4, true)));
        assert_eq!(read("+3."), Some((3.0, 3, true)));
        assert_eq!(read(".25 "), Some((0.25, 3, true)));
        assert_eq!(read("100"), Some((100.0, 3, false)));
        assert_eq!(read("1e5"), Some((1.0, 1, false)));
        assert_eq!(read("1.2.3"), Some((1.2, 3, true)));
        for nothing in ["", "-", ".", "+.", "X1", "--1"] {
            assert_eq!(read(nothing), None, "{nothing:?}");
        }
    }

    #[test]
    fn digits_are_counted_on_either_side_of_the_point() {
        let count = |text: &str| parse(text.as_bytes()).map(|d| d.digits);
        assert_eq!(count("-12.5"), Some([2, 1]));
        assert_eq!(count("007"), Some([3, 0]));
        assert_eq!(count("3."), Some([1, 0]));
        assert_eq!(count(".1234567890123"), Some([0, 13]));
    }

    proptest! {
        #[test]
        fn every_decimal_has_the_nearest_double(text in "-?[0-9]{1,25}(\\.[0-9]{0,25})?") {
            let read = parse(text.as_bytes()).unwrap();
            prop_assert_eq!(read.value, text.parse::<f64>().unwrap());
            prop_assert_eq!(read.len, text.len());
        }
    }
}
