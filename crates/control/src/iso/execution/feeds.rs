//! What F means.

use super::state::Holding;
use super::step::Step;
use crate::event::Action;
use crate::iso::dialects::facts::{FeedMeaning, FeedUnit, SourceRules};
use crate::iso::language::Fault;
use crate::iso::language::words::{Canned, FeedMode, G, Group, Motion};
use program::{Feed, Rule};

impl Step<'_, '_, '_> {
    /// F of the block, in the feed mode of the block.
    pub(super) fn feed(&mut self) -> Result<(), Fault> {
        if let Some(G::FeedMode(mode)) = self.block.g(Group::FeedMode)
            && (mode != self.state.feed_mode || self.facts.feed.mode_ends_feed)
        {
            // The old number means nothing in the new mode.
            self.state.feed_mode = mode;
            self.state.feed = None;
        }
        if self.facts.feed.pitch_by_f && self.motion_of_block() == Some(Motion::Thread) {
            return Ok(());
        }
        if let Some(source) = self.facts.source {
            return self.feed_of_source(source);
        }
        if self.facts.feed.meaning == FeedMeaning::PointedTime
            && self.state.feed_mode == FeedMode::InverseTime
        {
            return self.feed_as_time();
        }
        let Some(word) = self.block.take(b'F') else { return Ok(()) };
        let inches = self.inches_of_feed()?;
        if word.value <= 0.0 {
            return Err(self.block.at_word(b'F', Rule::Feed, "the feed must be greater than 0"));
        }
        self.state.f = Some(word.value);
        self.set_feed(match self.state.feed_mode {
            FeedMode::PerMinute => Feed::PerMinute(word.value * self.unit(inches, b'F')?),
            FeedMode::PerTurn => Feed::PerTurn(word.value * self.unit(inches, b'F')?),
            FeedMode::InverseTime => Feed::InverseTime(word.value),
        });
        Ok(())
    }

    /// This is the feed from here on, which is reported where it is another.
    fn set_feed(&mut self, feed: Feed) {
        if self.state.feed.replace(feed) != Some(feed) {
            self.actions.push(Action::Feed(feed));
        }
    }

    /// F in `G93` of a FANUC (B-62764EN, "Inverse time feed"): 0.001 to 9999.999, and a thousandth of a number that has no
    /// point, unless parameter 3401#0 says otherwise.
    fn feed_as_time(&mut self) -> Result<(), Fault> {
        let Some((value, thousandths)) = self.take_pointed(b'F')? else { return Ok(()) };
        let rate = if thousandths { value / 1000.0 } else { value };
        if !(0.001..=9999.999).contains(&rate) {
            let message = "F takes 0.001 to 9999.999 in G93";
            return Err(self.block.at_word(b'F', Rule::Feed, message));
        }
        self.state.f = Some(value);
        self.set_feed(Feed::InverseTime(rate));
        Ok(())
    }

    /// The unit that F is in, where the block itself changes units, too.
    fn inches_of_feed(&self) -> Result<Option<bool>, Fault> {
        let before = self.state.inches;
        let Some(G::Inches(inches)) = self.block.g(Group::Units) else { return Ok(before) };
        match self.facts.feed.unit {
            FeedUnit::OfBlock => Ok(Some(inches)),
            _ if before == Some(inches) => Ok(before),
            FeedUnit::OfBefore if before.is_some() => Ok(before),
            FeedUnit::OfFirst if before.is_none() => Ok(Some(inches)),
            FeedUnit::OfBefore | FeedUnit::OfFirst | FeedUnit::Unclear => {
                let message = "F in the block that changes the units counts in those of before";
                let fault = self.block.at_word(b'F', Rule::Feed, message);
                Err(fault.help("write G20 or G21 in a block before").into())
            }
        }
    }

    /// F of a CAM system, which counts in its own way in every mode: next to a rapid it says how fast that is, or 0, and next
    /// to a tap it is the pitch.
    fn feed_of_source(&mut self, source: SourceRules) -> Result<(), Fault> {
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
        let feed = || (source.feed)(word.value, word.digits);
        self.set_feed(match self.state.feed_mode {
            _ if taps => Feed::PerTurn(word.value),
            FeedMode::PerMinute => Feed::PerMinute(feed()),
            FeedMode::PerTurn => Feed::PerTurn(feed()),
            FeedMode::InverseTime => Feed::InverseTime(feed()),
        });
        Ok(())
    }
}
