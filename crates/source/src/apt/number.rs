//! Decimal numbers, exactly.
//!
//! Every number of a toolpath passes here, so the common shape (a sign, at most 15 or so digits, a
//! point) is read by hand; all else goes to the standard library. Both give the nearest `f64`. An
//! exponent may be written with `D`, as Fortran does.

/// Powers of ten that an `f64` holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The number at the start of `text` (no blanks before it) and how many bytes it takes; `None` where
/// there is no finite decimal number. What follows it is the caller's to judge.
pub(super) fn leading(text: &[u8]) -> Option<(f64, usize)> {
    let mut at = 0;
    let negative = match text.first()? {
        b'-' => {
            at = 1;
            true
        }
        b'+' => {
            at = 1;
            false
        }
        _ => false,
    };
    let mut mantissa: u64 = 0;
    let digits_from = at;
    while let Some(digit) = text.get(at).map(|c| c.wrapping_sub(b'0')).filter(|d| *d < 10) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        at += 1;
    }
    let mut digits = at - digits_from;
    let mut decimals = 0;
    if text.get(at) == Some(&b'.') {
        at += 1;
        let decimals_from = at;
        while let Some(digit) = text.get(at).map(|c| c.wrapping_sub(b'0')).filter(|d| *d < 10) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
            at += 1;
        }
        decimals = at - decimals_from;
        digits += decimals;
    }
    if digits == 0 {
        return None;
    }
    if matches!(text.get(at), Some(b'e' | b'E' | b'd' | b'D')) || digits > 19 || mantissa >= 1 << 53
    {
        return by_the_standard_library(text, at);
    }
    // Mantissa and power are exact, so their quotient is the correctly rounded value.
    let value = match POWERS.get(decimals) {
        Some(power) => mantissa as f64 / power,
        None => return by_the_standard_library(text, at),
    };
    Some((if negative { -value } else { value }, at))
}

/// As [`leading`], for a number whose digits end at `at` and which an exponent may follow.
#[cold]
fn by_the_standard_library(text: &[u8], mut at: usize) -> Option<(f64, usize)> {
    let mut fortran = None;
    if let Some(mark @ (b'e' | b'E' | b'd' | b'D')) = text.get(at) {
        fortran = matches!(mark, b'd' | b'D').then_some(at);
        at += 1;
        if matches!(text.get(at), Some(b'+' | b'-')) {
            at += 1;
        }
        while text.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
    }
    let number = std::str::from_utf8(text.get(..at)?).ok()?;
    let value: f64 = match fortran {
        Some(mark) => {
            format!("{}E{}", number.get(..mark)?, number.get(mark + 1..)?).parse().ok()?
        }
        None => number.parse().ok()?,
    };
    value.is_finite().then_some((value, at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_habits_of_cam_systems_are_numbers() {
        for (text, value) in [
            ("10", 10.0),
            ("10.", 10.0),
            (".5", 0.5),
            ("-.331", -0.331),
            ("+1.25", 1.25),
            ("-0.0000000", -0.0),
            ("1E-3", 1e-3),
            ("1.5e+2", 150.0),
            ("1D2", 100.0),
            ("-.25d-01", -0.025),
            ("0000000000000000000000000012.5", 12.5),
            ("0.1000000000000000055511151231257827021181583404541015625", 0.1),
        ] {
            let (read, length) = leading(text.as_bytes()).unwrap();
            assert_eq!((read.to_bits(), length), (f64::to_bits(value), text.len()), "{text}");
        }
    }

    #[test]
    fn what_is_no_finite_number_is_none() {
        for text in
            ["", "-", ".", "+.", "abc", "nan", "inf", "-inf", "1e999", "1e", "1d", "E5", "--1"]
        {
            assert_eq!(leading(text.as_bytes()), None, "{text}");
        }
        assert_eq!(leading(b"1,2"), Some((1.0, 1)));
        assert_eq!(leading(b"1.2.3"), Some((1.2, 3)));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4_000))]

        #[test]
        fn every_decimal_is_read_as_the_standard_library_reads_it(
            text in "[-+]?([0-9]{1,24}\\.?[0-9]{0,30}|\\.[0-9]{1,25})([eEdD][-+]?[0-9]{1,3})?",
        ) {
            let expected: f64 = text.replace(['d', 'D'], "e").parse().unwrap();
            match leading(text.as_bytes()) {
                Some((value, length)) => {
                    prop_assert_eq!(value.to_bits(), expected.to_bits());
                    prop_assert_eq!(length, text.len());
                }
                None => prop_assert!(!expected.is_finite()),
            }
        }

        #[test]
        fn what_is_printed_is_read_back(value in proptest::num::f64::NORMAL) {
            let text = format!("{value}");
            prop_assert_eq!(leading(text.as_bytes()), Some((value, text.len())));
        }
    }
}
