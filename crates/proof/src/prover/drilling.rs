//! Holes: by canned cycles, and by the moves that make them.

use super::*;
use program::Rule;

impl Prover<'_> {
    /// A single move while the source drills.
    pub(super) fn hole_move(&mut self, motion: MotionKind, to: &ResolvedPose) -> Outcome {
        let Step::Move(ExpectedMotion { kind: Kind::Hole(cycle), to: point, .. }) =
            &self.cursor.step
        else {
            return Ok(());
        };
        let (gauge, cycle, point) = (self.gauge, *cycle, *point);
        let hole = Hole { gauge: &gauge, point: &point, cycle: &cycle };
        let here = self.here;
        if !self.progress.hole.over {
            if motion == MotionKind::Rapid && !hole.is_over(to) {
                return self.stop_at(to);
            }
            if motion == MotionKind::Rapid {
                self.approached(to)?;
                self.comes_from_above(&hole, Some(to))?;
                self.progress.stops.clear();
                self.progress.hole.over = true;
                return Ok(());
            }
            if !hole.is_over(&here) {
                let message = format!("feeds to {}, but the hole is at {point}", to.place);
                return Err(self.lost_at(to.line, Rule::Hole, &message));
            }
            self.progress.hole.over = true;
        }
        let stopped = self.running.spindle == Spindle::Off;
        let run = &mut self.progress.hole;
        let done = match motion {
            MotionKind::Rapid => run.rapid(&hole, &here, to, stopped),
            MotionKind::Feed => run.feed(&hole, &here, to),
        }
        .map_err(|how| self.lost_at(to.line, Rule::Hole, &how))?;
        let off = hole.off(&self.progress.hole, to);
        self.has_compared(off);
        if motion == MotionKind::Feed {
            self.check_drilling(to.line, cycle.feed, self.running.feed);
        }
        if done {
            self.arrive(to);
        }
        Ok(())
    }

    /// A hole of a canned cycle.
    pub(super) fn drilled(&mut self, line: u32, pose: &Position) -> Outcome {
        let Some(own) = self.running.cycle else {
            return Err(self.lost_at(line, Rule::Hole, "drills without a cycle"));
        };
        self.pass_left_out(|_| false);
        self.miss_events(line);
        let Step::Move(ExpectedMotion { kind: Kind::Hole(cycle), to: point, .. }) =
            &self.cursor.step
        else {
            let message = "drills a hole that the source does not have";
            return Err(match self.nearest_stop() {
                Some(stop) => self.lost_at(stop.line, Rule::EndPoint, &self.not_reached(&stop)),
                None => self.lost_at(line, Rule::Hole, message),
            });
        };
        let (gauge, cycle, point) = (self.gauge, *cycle, *point);
        let hole = Hole { gauge: &gauge, point: &point, cycle: &cycle };
        self.unclamped(line, &pose.orientation);
        let drilled = Drilled::new(&gauge, line, pose, own);
        if self.progress.hole.begun(&cycle) {
            return Err(self.lost_at(
                line,
                Rule::Hole,
                "drills a hole that has been begun by moves",
            ));
        }
        // A cycle may end at the R plane: then the way up to the retract level is still to come.
        let below = own.retract == own.clearance && cycle.retract > cycle.clearance;
        let apart =
            drilled.place(&hole, !below).map_err(|how| self.lost_at(line, Rule::Hole, &how))?;
        self.has_compared(apart);
        let wrong_way = self.wrong_cycle(&drilled.r_plane);
        self.approached(&drilled.r_plane)?;
        if let Some(found) = wrong_way {
            self.found(found);
        }
        // A cycle itself goes across first, then down.
        self.comes_from_above(&hole, None)?;
        for difference in drilled.kind(&hole) {
            self.differs(line, difference);
        }
        self.check_drilling(line, cycle.feed, own.feed.or(self.running.feed));
        let summary = &mut self.report.program;
        summary.cutting_length_mm += own.clearance + own.depth;
        let poses = [&drilled.bottom, &drilled.r_plane, &drilled.retracted];
        let poses = poses.into_iter().chain(&drilled.cleared);
        for reached in poses.clone() {
            summary.include(&reached.position);
        }
        let over = self.here.place.tip.distance(drilled.r_plane.place.tip);
        let out = drilled.bottom.place.tip.distance(drilled.retracted.place.tip);
        summary.rapid_length_mm += if over.is_nan() { out } else { over + out };
        for reached in poses {
            self.hold_travel(reached, None);
        }
        self.contact.drilled(cycle.kind);
        self.standing.arrive(&pose.orientation);
        self.here = drilled.retracted;
        self.stands_at(&drilled.retracted);
        if below {
            self.progress.hole.drilled(&cycle);
            self.progress.stops.clear();
        } else {
            self.arrive(&drilled.retracted);
        }
        Ok(())
    }

    /// What must hold while a hole is drilled. A tap's feed is its pitch, which the cycle compares.
    pub(super) fn check_drilling(
        &mut self,
        line: u32,
        cycle: Option<program::Feed>,
        is: Option<program::Feed>,
    ) {
        self.check_set_up(line);
        let (allowed, wanted, running) = (&self.gauge.allowed, &self.cursor.wanted, &self.running);
        let machine = self.gauge.machine;
        let tapping = matches!(
            &self.cursor.step,
            Step::Move(ExpectedMotion { kind: Kind::Hole(c), .. })
                if matches!(c.kind, program::CycleKind::Tap { .. })
        );
        let found = [
            state::spindle_and_coolant(allowed, wanted, running),
            match tapping {
                true => None,
                false => state::feed(machine, allowed, cycle.or(wanted.feed), is, wanted.spindle),
            },
        ];
        for difference in found {
            self.check(line, difference);
        }
        self.check_compensation(line, true, false);
    }

    /// Whether the way to a hole goes down nowhere but over it: as a canned cycle goes, for what the
    /// tool was drawn back from may stand between the holes.
    fn comes_from_above(&self, hole: &Hole, to: Option<&ResolvedPose>) -> Outcome {
        let mut last = self.progress.start.unwrap_or(self.here);
        for stop in self.progress.stops.iter().chain(to) {
            if hole.off_axis_and_down(&last, stop) {
                let message = format!("goes down by rapid to {}, next to the hole", stop.place);
                return Err(self.lost_at(stop.line, Rule::Hole, &message));
            }
            last = *stop;
        }
        Ok(())
    }
}
