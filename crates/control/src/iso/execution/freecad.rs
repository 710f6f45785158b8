//! FreeCAD's feeds: mm/s, with `G93` moves a second, and beside a tap the pitch.

use super::cycles::Holding;
use super::step::Step;
use crate::event::Action;
use crate::iso::language::block::Fault;
use crate::iso::language::words::{Canned, FeedMode, G, Group, Motion};
use crate::kernel::decimal;
use program::{Feed, Rule};

/// How many digits FreeCAD's shorter form of a number has (`Command G1 [ F:3.3333 ]`). It leaves zeros
/// at the end out, so that a number with fewer digits is as good as one with so many.
const DIGITS: u8 = 5;

/// No decimals to the most of a feed in mm/min that somebody has typed, as powers of ten.
const TYPED: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];

/// The feed a minute that `value` gives a second, which is written with so many digits before and behind its
/// point: where a number with few decimals lies within what these leave open, that number, since it is what was
/// typed (3.333333 is 200, not 199.99998).
fn per_minute(value: f64, [whole, decimals]: [u8; 2]) -> f64 {
    let places = decimals.max(DIGITS.saturating_sub(whole)).min(15);
    let open = 60.0 * 0.5 * (1.0 / decimal::POWERS[usize::from(places)]);
    let exact = value * 60.0;
    let mut typed = TYPED.iter().map(|scale| (exact * scale).round() / scale);
    // Half of the last place, and what the doubles add to it.
    typed.find(|typed| (typed - exact).abs() <= open * 1.000_001).unwrap_or(exact)
}

impl Step<'_, '_, '_> {
    /// F, in every mode a second: FreeCAD's posts write 60 F, whatever has been said before. Beside a rapid
    /// it says how fast that is, or 0, and beside a tap it is the pitch.
    pub(super) fn feed_of_command(&mut self) -> Result<(), Fault> {
        let motion = self.block.g(Group::Motion);
        let taps = matches!(motion, Some(G::Cycle(Canned::Tap | Canned::LeftTap)));
        if !taps && self.state.cycle.as_ref().is_some_and(Holding::taps) {
            self.state.feed = None;
        }
        let Some(word) = self.block.take(b'F') else { return Ok(()) };
        if matches!(motion, Some(G::Motion(Motion::Rapid))) {
            return Ok(());
        }
        if word.value <= 0.0 {
            return Err(self.block.at_word(b'F', Rule::Feed, "the feed must be greater than 0"));
        }
        let sixty = || per_minute(word.value, word.digits);
        let feed = match self.state.feed_mode {
            _ if taps => Feed::PerTurn(word.value),
            FeedMode::PerMinute => Feed::PerMinute(sixty()),
            FeedMode::PerTurn => Feed::PerTurn(sixty()),
            FeedMode::InverseTime => Feed::InverseTime(sixty()),
        };
        if self.state.feed.replace(feed) != Some(feed) {
            self.actions.push(Action::Feed(feed));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::per_minute;
    use crate::kernel::decimal;

    fn read(text: &str) -> f64 {
        let number = decimal::parse(&text.as_bytes()[1..]).unwrap();
        per_minute(number.value, number.digits.map(|count| count as u8))
    }

    #[test]
    fn a_feed_is_what_was_typed_in_mm_per_minute() {
        // Six decimals: 200/60, 254/60, 0.05/60.
        assert_eq!(read("F3.333333"), 200.0);
        assert_eq!(read("F4.233333"), 254.0);
        assert_eq!(read("F0.000833"), 0.05);
        // Five digits: 200/60, 1000/60, 10000/60, 73.8/60.
        assert_eq!(read("F3.3333"), 200.0);
        assert_eq!(read("F16.667"), 1000.0);
        assert_eq!(read("F166.67"), 10000.0);
        assert_eq!(read("F1.23"), 73.8);
        assert_eq!(read("F1.5"), 90.0);
        assert_eq!(read("F3"), 180.0);
    }

    #[test]
    fn a_feed_that_nobody_has_typed_stays_what_it_is() {
        // No number with three decimals is as near as the text says.
        assert_eq!(read("F5.123457"), 5.123457 * 60.0);
    }
}
