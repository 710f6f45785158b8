//! Threads and probing moves: each is one block for one move of the source.

use super::*;
use crate::hole::PITCH;
use program::Rule;

impl Prover<'_> {
    /// A thread or a probing move of the program.
    pub(super) fn single(&mut self, line: u32, pose: &Position, is: Kind) -> Outcome {
        let to = self.gauge.resolve(line, *pose);
        self.count(MotionKind::Feed, &to, None, None);
        self.hold_travel(&to, None);
        self.standing.arrive(&to.position.orientation);
        self.pass_left_out(|_| false);
        self.miss_events(line);
        let goal = match &self.cursor.step {
            Step::Move(goal) if same(&goal.kind, &is) => goal,
            Step::Move(ExpectedMotion {
                kind: kind @ (Kind::Thread(_) | Kind::Probe { .. }),
                ..
            }) => {
                let message = format!("{}, but the source {}", does(&is), does(kind));
                return Err(self.lost_at(line, Rule::SingleBlock, &message));
            }
            Step::Move(_)
            | Step::Dwell(_)
            | Step::Stop
            | Step::OptionalStop
            | Step::ThreadWire
            | Step::CutWire
            | Step::Output(_)
            | Step::Input(_)
            | Step::Auxiliary(_)
            | Step::WorkOffsetData(_)
            | Step::Unproven(_)
            | Step::End => {
                let message = format!("{} where the source does not", does(&is));
                return Err(self.lost_at(line, Rule::SingleBlock, &message));
            }
        };
        let (here, goes_to) = (self.here, goal.to);
        if !here.place.known() || !self.progress.stops.is_empty() {
            let message = format!("{} from a place where the source does not", does(&is));
            return Err(self.lost_at(line, Rule::SingleBlock, &message));
        }
        if !self.gauge.at(&to, &goes_to) {
            let message = format!("goes to {}; the source goes to {goes_to}", to.place);
            return Err(self.lost_at(line, Rule::Path, &message));
        }
        let length = goal.length();
        self.pace = Pace::default();
        // The pitch is the feed of a thread.
        let feed = match matches!(is, Kind::Thread(_)) {
            true => None,
            false => self.feed_of(&to, None, length, length),
        };
        self.check_set_up(line);
        let (allowed, wanted, running) = (&self.gauge.allowed, &self.cursor.wanted, &self.running);
        let found = [state::spindle_and_coolant(allowed, wanted, running), feed];
        for difference in found {
            self.check(line, difference);
        }
        self.check_compensation(line, true, false);
        let apart = to.place.apart(&goes_to);
        self.report.deviations.tip_mm.note(apart.0, self.cursor.line, line);
        self.has_compared(apart);
        let mut end = to;
        if matches!(is, Kind::Probe { .. }) {
            let (from, moved) = (here.position.point, &mut end.position.point);
            *moved = Vec3::select(moved.cmpeq(from), *moved, Vec3::splat(f64::NAN));
            end = self.gauge.resolve(line, end.position);
        }
        self.arrive(&end);
        self.stands_at(&to);
        Ok(())
    }
}

fn same(source: &Kind, block: &Kind) -> bool {
    match (source, block) {
        (Kind::Thread(a), Kind::Thread(b)) => (a - b).abs() <= PITCH,
        (source, block) => source == block,
    }
}

/// What a thread or a probing move does, for a person.
pub(super) fn does(kind: &Kind) -> String {
    match kind {
        Kind::Thread(pitch) => format!("cuts a thread of {} mm", Number(*pitch)),
        Kind::Probe { away, must_answer } => format!(
            "probes {} the part, {}",
            if *away { "away from" } else { "towards" },
            if *must_answer { "or stops with an error" } else { "or goes on" }
        ),
        Kind::Rapid | Kind::Line | Kind::Arc(_) | Kind::Hole(_) | Kind::Broken(_) => {
            String::from("moves")
        }
    }
}
