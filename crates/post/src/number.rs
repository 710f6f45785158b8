//! Numbers as a control reads them: fixed decimals, by integer arithmetic. Never an exponent, never
//! minus zero, and always exactly the value that was rounded.

use machine::Word;

/// Values are counted in steps of the last decimal; below this many the counting is exact.
const MOST_STEPS: f64 = (1u64 << 51) as f64;

/// Added and taken away again, it rounds a smaller number to a whole one (ties to even).
const ROUNDER: f64 = (3u64 << 51) as f64;

/// How one word is written.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    pub(crate) address: String,
    pub(crate) suffix: String,
    pub(crate) modal: bool,
    decimals: usize,
    trim: bool,
    point: bool,
    plus: bool,
    digits: usize,
    /// Steps in a unit of the value.
    factor: f64,
    /// Steps in 1 as it is written.
    power: u64,
    most: f64,
}

impl Number {
    pub(crate) fn new(word: &Word) -> Number {
        let decimals = usize::from(word.decimals.min(9));
        let power = 10u64.pow(decimals as u32);
        Number {
            address: word.address.clone(),
            suffix: word.suffix.clone(),
            modal: word.modal,
            decimals,
            trim: word.trim,
            point: word.point,
            plus: word.plus,
            digits: usize::from(word.digits),
            factor: power as f64 * word.scale,
            power,
            most: (word.max * power as f64).min(MOST_STEPS),
        }
    }

    /// `value` in steps, rounded to the nearest (of two equally near, to the even one); `None` where
    /// it is not finite or too large.
    #[inline]
    pub(crate) fn round(&self, value: f64) -> Option<i64> {
        let product = value * self.factor;
        let within = product.abs() <= self.most;
        if !within {
            return None;
        }
        let mut steps = (product + ROUNDER) - ROUNDER;
        let rest = product - steps;
        if rest.abs() == 0.5 {
            // The product itself was rounded: its lost part decides what only looks like a tie.
            let lost = value.mul_add(self.factor, -product);
            if rest * lost > 0.0 {
                steps += 2.0 * rest;
            }
        }
        Some(steps as i64)
    }

    /// The value of so many steps: what reading the written number gives.
    #[inline]
    pub(crate) fn value(&self, steps: i64) -> f64 {
        steps as f64 / self.factor
    }

    /// The whole word: address, number, suffix.
    #[inline]
    pub(crate) fn write(&self, steps: i64, out: &mut Vec<u8>) {
        out.extend_from_slice(self.address.as_bytes());
        self.digits(steps, out);
        out.extend_from_slice(self.suffix.as_bytes());
    }

    #[inline]
    fn digits(&self, steps: i64, out: &mut Vec<u8>) {
        if steps < 0 {
            out.push(b'-');
        } else if self.plus {
            out.push(b'+');
        }
        let steps = steps.unsigned_abs();
        let (whole, fraction) = (steps / self.power, steps % self.power);
        let mut text = [b'0'; 40];
        let mut at = text.len() / 2;
        let mut rest = whole;
        while rest > 0 {
            at -= 1;
            text[at] = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        let at = at.min(text.len() / 2 - self.digits.clamp(1, text.len() / 2));
        let mut end = text.len() / 2;
        if self.decimals > 0 && !(self.trim && fraction == 0) {
            text[end] = b'.';
            end += 1 + self.decimals;
            let mut rest = fraction;
            for digit in text[end - self.decimals..end].iter_mut().rev() {
                *digit = b'0' + (rest % 10) as u8;
                rest /= 10;
            }
            while self.trim && text[end - 1] == b'0' {
                end -= 1;
            }
        } else if self.point {
            text[end] = b'.';
            end += 1;
        }
        out.extend_from_slice(&text[at..end]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn word(decimals: u8) -> Word {
        Word {
            address: String::new(),
            suffix: String::new(),
            decimals,
            trim: false,
            point: false,
            plus: false,
            digits: 1,
            modal: false,
            step: 1,
            first: 1,
            scale: 1.0,
            max: f64::INFINITY,
            codes: BTreeMap::new(),
        }
    }

    fn text(word: Word, value: f64) -> String {
        let number = Number::new(&word);
        let mut out = Vec::new();
        number.write(number.round(value).unwrap(), &mut out);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn zeros_points_and_signs_are_as_the_word_says() {
        let trim = || Word { trim: true, ..word(3) };
        assert_eq!(text(trim(), 12.5), "12.5");
        assert_eq!(text(trim(), 10.0), "10");
        assert_eq!(text(trim(), -0.0001), "0");
        assert_eq!(text(Word { point: true, ..trim() }, 10.0), "10.");
        assert_eq!(text(Word { point: true, ..word(0) }, 10.0), "10.");
        assert_eq!(text(Word { plus: true, ..word(3) }, 0.0), "+0.000");
        assert_eq!(text(Word { plus: true, ..trim() }, -7.25), "-7.25");
        assert_eq!(text(Word { digits: 4, ..word(0) }, 10.0), "0010");
        assert_eq!(text(word(3), 8e-4), "0.001");
        assert_eq!(text(word(3), -0.05), "-0.050");
    }

    #[test]
    fn address_suffix_and_scale_stand_round_the_number() {
        let c = Word { address: "C=".into(), suffix: "+R24".into(), trim: true, ..word(3) };
        assert_eq!(text(c, 45.0), "C=45+R24");
        assert_eq!(text(Word { address: "P".into(), scale: 1000.0, ..word(0) }, 1.5), "P1500");
    }

    #[test]
    fn what_is_too_large_or_no_number_has_no_text() {
        for value in [f64::NAN, f64::INFINITY, 1e308, -1e14] {
            assert_eq!(Number::new(&word(3)).round(value), None);
        }
        assert_eq!(Number::new(&Word { max: 99.0, ..word(1) }).round(99.1), None);
        assert_eq!(Number::new(&Word { max: 99.0, ..word(1) }).round(-99.0), Some(-990));
    }

    proptest! {
        #[test]
        fn the_text_is_that_of_exact_decimal_rounding(
            value in prop_oneof![-1e5..1e5f64, (-1_000_000i64..1_000_000).prop_map(|i| i as f64 / 2000.0)],
            decimals in 0u8..=9,
        ) {
            let exact = format!("{value:.*}", usize::from(decimals));
            let zero = exact.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
            let exact = if zero { exact.trim_start_matches('-') } else { &exact };
            prop_assert_eq!(text(word(decimals), value), exact);
        }

        #[test]
        fn reading_the_text_gives_the_rounded_value(value in -1e5..1e5f64, decimals in 0u8..=9) {
            let number = Number::new(&word(decimals));
            let rounded = number.value(number.round(value).unwrap());
            prop_assert_eq!(text(word(decimals), value).parse::<f64>().unwrap(), rounded);
        }
    }
}
