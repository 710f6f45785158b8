//! Threads and probing moves: each is one block of the control.

use crate::catalogue::{BlockName, WordName};
use crate::coordinate_mode::{Kind, Stop, same};
use crate::template::POSITION;
use crate::walk::{Cut, Outcome, Walk, refuse};
use crate::words::{Words, bit};
use program::{Feed, Probe, Rule, Thread};

impl Walk<'_> {
    /// A thread of the source.
    pub(crate) fn thread(&mut self, thread: &Thread, stop: &Stop) -> Outcome {
        if self.writer.rounded(WordName::Lead, thread.pitch()) <= 0.0 {
            return Err(refuse(
                Rule::Thread,
                format!("a thread with a pitch of {} mm", thread.pitch()),
            ));
        }
        self.single(BlockName::Thread, "a thread")?;
        self.before_cut()?;
        self.settle(&thread.end, stop, true)?;
        self.aim(&thread.end, stop);
        self.position.go_to(thread.end);
        if !self.writer.changes(POSITION) {
            self.writer.unset(Words::ALL);
            return Ok(());
        }
        for word in [WordName::X, WordName::Y, WordName::Z] {
            if self.templates.places(BlockName::Thread, word) {
                continue;
            }
            if self.writer.changes(bit(word)) {
                let message = format!("the control cuts no thread along {}", word.name());
                return Err(refuse(Rule::Thread, message));
            }
            self.writer.unset(bit(word));
        }
        self.check_limits()?;
        self.writer.set(WordName::Lead, thread.pitch());
        self.block(BlockName::Thread)?;
        // The pitch may stand in F.
        self.writer.forget(bit(WordName::Motion) | bit(WordName::F));
        Ok(())
    }

    /// A probing move of the source. The axes that it moves are where only the machine knows.
    pub(crate) fn probe(&mut self, probe: &Probe) -> Outcome {
        self.single(BlockName::Probe, "a probing move")?;
        let kind = 2 * usize::from(probe.away) + usize::from(!probe.must_answer);
        let texts = self.machine.words.get(WordName::ProbeMode.name()).map(|word| &word.codes);
        let name = WordName::ProbeMode.codes().nth(kind).unwrap_or_default();
        if texts.is_none_or(|texts| !texts.contains_key(name)) {
            let message = match (probe.away, probe.must_answer) {
                (true, _) => "the control has no probing move away from the part",
                (false, true) => "the control goes on where its probe has touched nothing",
                (false, false) => "the control stops where its probe has touched nothing",
            };
            let help = "another probing move, if the program does not depend on it";
            return Err(refuse(Rule::Probe, message).help(help).into());
        }
        let Some(Feed::PerMinute(_)) = self.wanted.feed() else {
            return Err(refuse(Rule::Probe, "a probing move needs a feed in mm/min"));
        };
        self.sync_spindle()?;
        self.sync_coolant()?;
        let axis = probe.end.axis();
        let length = self.position.distance(probe.end.point());
        if self.position.pose().is_none_or(|here| !same(here.axis(), axis)) {
            return Err(refuse(Rule::Probe, "the tool axis turns in a probing move"));
        }
        self.aim_at(probe.end.point(), axis, None);
        let words = [WordName::X, WordName::Y, WordName::Z].into_iter();
        let moved: Words = words.filter(|word| self.writer.changes(bit(*word))).collect();
        if moved.is_empty() {
            return Err(refuse(Rule::Probe, "a probing move that goes nowhere"));
        }
        self.check_limits()?;
        self.say_feed(length, 1, Cut::Straight)?;
        self.writer.code(WordName::ProbeMode, kind);
        self.block(BlockName::Probe)?;
        self.writer.forget(moved | bit(WordName::Motion));
        self.position.probe();
        probe.place.map_or(Ok(()), |place| self.keep_height(place))
    }

    /// What holds for `what`, which is one block of the control.
    fn single(&mut self, block: BlockName, what: &str) -> Outcome {
        self.not_over_surface(what)?;
        self.not_from_probe(what)?;
        if !self.templates.has(block) {
            return self.required(block);
        }
        if !self.position.is_located() || !matches!(self.place.kind, Kind::Plain | Kind::Tilted(..))
        {
            let message =
                format!("{what} from a place, or with a tool axis, that blocks do not say");
            let help = "a rapid to its start before it";
            return Err(refuse(Rule::SingleBlock, message).help(help).into());
        }
        self.uncompensated(what)?;
        self.look_ahead(false)?;
        if self.compensation_pending() {
            let message = format!("cutter compensation cannot be switched at {what}");
            return Err(refuse(Rule::Compensation, message));
        }
        self.end_cycle()
    }

    /// Where a probe has answered, only the machine knows: a rapid leads away from there.
    pub(crate) fn not_from_probe(&self, what: &str) -> Outcome {
        if self.position.is_probed() {
            let message = format!("{what} from where the probe has answered, which is not known");
            return Err(refuse(Rule::Probe, message).help("a rapid before it").into());
        }
        Ok(())
    }
}
