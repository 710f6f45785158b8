//! Numbers as a control reads them: fixed decimals, by integer arithmetic. Never an exponent, never
//! minus zero, and always exactly the value that was rounded.

use machine::Word;

/// Values are counted in steps of the last decimal; below this many the counting is exact.
const MOST_STEPS: f64 = (1u64 << 51) as f64;

/// Added and taken away again, it rounds a smaller number to a whole one (ties to even).
const ROUNDER: f64 = (3u64 << 51) as f64;

/// The most signs that a number takes, with the last of what leads it: 20 digits before the point, and 9
/// behind it.
const MOST_SIGNS: usize = Lead::SHORT + 1 + 20 + 1 + 9 + 1;

/// How one word is written.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    /// What separates words, and the address.
    separated: Lead,
    /// The address alone.
    address: Lead,
    suffix: String,
    pub(crate) modal: bool,
    /// Whether it is compared before it is rounded.
    exact: bool,
    decimals: usize,
    trim: bool,
    point: bool,
    plus: bool,
    digits: usize,
    /// Steps in a turn, where the number is written within one.
    turn: Option<i64>,
    /// Steps in a unit of the value.
    factor: f64,
    most: f64,
}

impl Number {
    pub(crate) fn new(separator: &str, word: &Word) -> Number {
        let decimals = usize::from(word.decimals.min(9));
        let power = 10u64.pow(decimals as u32);
        Number {
            separated: Lead::new(&[separator, &word.address].concat()),
            address: Lead::new(&word.address),
            suffix: word.suffix.clone(),
            modal: word.modal,
            exact: word.exact,
            decimals,
            trim: word.trim,
            point: word.point,
            plus: word.plus,
            digits: usize::from(word.digits),
            turn: word.within_turn.then_some((360.0 * power as f64 * word.scale) as i64),
            factor: power as f64 * word.scale,
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

    /// What stands for `value` where it is compared: its steps, or the bits of one that is compared before it is
    /// rounded. `None` where it has no steps.
    #[inline]
    pub(crate) fn key(&self, value: f64) -> Option<i64> {
        let steps = self.round(value)?;
        // Both zeros are one.
        Some(if self.exact { (value + 0.0).to_bits() as i64 } else { steps })
    }

    /// The steps of the value for which `key` stands.
    #[inline]
    pub(crate) fn steps(&self, key: i64) -> i64 {
        if !self.exact {
            return key;
        }
        self.round(f64::from_bits(key as u64)).unwrap_or_default()
    }

    /// The value of so many steps: what reading the written number gives.
    #[inline]
    pub(crate) fn value(&self, steps: i64) -> f64 {
        steps as f64 / self.factor
    }

    /// The whole word: address, number, suffix; `separator` first, where there is one.
    #[inline]
    pub(crate) fn write(&self, separated: bool, steps: i64, out: &mut Vec<u8>) {
        let steps = self.turn.map_or(steps, |turn| steps.rem_euclid(turn));
        self.digits(if separated { &self.separated } else { &self.address }, steps, out);
        if !self.suffix.is_empty() {
            out.extend_from_slice(self.suffix.as_bytes());
        }
    }

    /// The whole word as a sum in brackets: its number, and `rest` with its signs.
    pub(crate) fn write_sum(&self, separated: bool, steps: i64, rest: &[u8], out: &mut Vec<u8>) {
        let lead = if separated { &self.separated } else { &self.address };
        out.extend_from_slice(lead.long.as_bytes());
        out.extend_from_slice(&lead.short[Lead::SHORT - lead.length..]);
        out.push(b'[');
        self.digits(&Lead::new(""), steps, out);
        out.extend_from_slice(rest);
        out.push(b']');
        out.extend_from_slice(self.suffix.as_bytes());
    }

    #[inline]
    fn digits(&self, lead: &Lead, steps: i64, out: &mut Vec<u8>) {
        // From the right to the left: decimals, point, whole part, sign, and what leads.
        let mut text = [b'0'; 2 * MOST_SIGNS];
        let mut rest = steps.unsigned_abs();
        let mut at = MOST_SIGNS;
        for _ in 0..self.decimals / 2 {
            at -= 2;
            text[at..at + 2].copy_from_slice(pair(rest));
            rest /= 100;
        }
        if self.decimals % 2 == 1 {
            at -= 1;
            text[at] = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        at -= 1;
        let point = at;
        text[point] = b'.';
        while rest >= 100 {
            at -= 2;
            text[at..at + 2].copy_from_slice(pair(rest));
            rest /= 100;
        }
        while rest > 0 {
            at -= 1;
            text[at] = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        at = at.min(point - self.digits.clamp(1, 20));
        let mut end = MOST_SIGNS;
        if self.trim {
            while text[end - 1] == b'0' {
                end -= 1;
            }
        }
        let pointed = end > point + 1 || self.point || (self.decimals > 0 && !self.trim);
        if !pointed {
            end = point;
        }
        if steps < 0 || self.plus {
            at -= 1;
            text[at] = if steps < 0 { b'-' } else { b'+' };
        }
        text[at - Lead::SHORT..at].copy_from_slice(&lead.short);
        if !lead.long.is_empty() {
            out.extend_from_slice(lead.long.as_bytes());
        }
        // A copy of fixed size costs less than one of just the signs that there are.
        let from = at - lead.length;
        let kept = out.len() + end - from;
        out.extend_from_slice(&text[from..from + MOST_SIGNS]);
        out.truncate(kept);
    }
}

/// The last two digits of a number.
fn pair(number: u64) -> &'static [u8] {
    let at = (number % 100) as usize * 2;
    &PAIRS[at..at + 2]
}

/// What stands before the digits of a word.
#[derive(Clone, Debug)]
struct Lead {
    /// Its last characters, at the right.
    short: [u8; Lead::SHORT],
    /// How many these are.
    length: usize,
    /// All before them.
    long: String,
}

impl Lead {
    const SHORT: usize = 8;

    fn new(text: &str) -> Lead {
        let mut at = text.len().saturating_sub(Lead::SHORT);
        while !text.is_char_boundary(at) {
            at += 1;
        }
        let (long, last) = text.split_at(at);
        let mut short = [0; Lead::SHORT];
        short[Lead::SHORT - last.len()..].copy_from_slice(last.as_bytes());
        Lead { short, length: last.len(), long: long.into() }
    }
}

/// The numbers from 00 to 99.
const PAIRS: [u8; 200] = {
    let mut pairs = [b'0'; 200];
    let mut i = 0;
    while i < 100 {
        pairs[2 * i] += (i / 10) as u8;
        pairs[2 * i + 1] += (i % 10) as u8;
        i += 1;
    }
    pairs
};

#[cfg(test)]
mod tests {
    use super::*;
    use machine::FileLocation;
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
            exact: false,
            within_turn: false,
            step: 1,
            first: 1,
            scale: 1.0,
            max: f64::INFINITY,
            codes: BTreeMap::new(),
            place: FileLocation::default(),
        }
    }

    fn text(word: Word, value: f64) -> String {
        let number = Number::new("", &word);
        let mut out = Vec::new();
        number.write(false, number.round(value).unwrap(), &mut out);
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
        let q = Word { address: "Q201=DEPTH ".into(), ..word(0) };
        assert_eq!(text(q, -5.0), "Q201=DEPTH -5");
        let c = Word { address: "C=".into(), suffix: "+R24".into(), trim: true, ..word(3) };
        assert_eq!(text(c, 45.0), "C=45+R24");
        assert_eq!(text(Word { address: "P".into(), scale: 1000.0, ..word(0) }, 1.5), "P1500");
    }

    #[test]
    fn what_is_too_large_or_no_number_has_no_text() {
        for value in [f64::NAN, f64::INFINITY, 1e308, -1e14] {
            assert_eq!(Number::new("", &word(3)).round(value), None);
        }
        assert_eq!(Number::new("", &Word { max: 99.0, ..word(1) }).round(99.1), None);
        assert_eq!(Number::new("", &Word { max: 99.0, ..word(1) }).round(-99.0), Some(-990));
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
            let number = Number::new("", &word(decimals));
            let rounded = number.value(number.round(value).unwrap());
            prop_assert_eq!(text(word(decimals), value).parse::<f64>().unwrap(), rounded);
        }
    }
}
