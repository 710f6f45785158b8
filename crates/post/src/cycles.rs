//! Hole cycles: the control's own where it has them, moves where not.

use crate::catalogue::{BlockName, WordName};
use crate::coordinate_mode::{Kind, Stop, same};
use crate::rapid::corner;
use crate::walk::{Cut, Outcome, Walk, motion, refuse};
use crate::words::bit;
use geom::Vec3;
use machine::CycleName;
use program::lowering::{self, HoleMove};
use program::{Cycle, CycleKind, Diagnostic, Feed, Pose, Rule, Spindle};

/// The cycle that the control has on: its definition and the levels it was given, mm along Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Open {
    block: BlockName,
    levels: Levels,
}

/// Levels of a hole along the local Z, mm, as they are written.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Levels {
    surface: f64,
    clear: f64,
    bottom: f64,
    retract: f64,
}

impl Walk<'_> {
    /// One hole of the source.
    pub(crate) fn hole(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        let Some(cycle) = self.wanted.cycle() else {
            return Err(refuse(Rule::NoCycle, "a hole without a cycle"));
        };
        check(cycle)?;
        self.not_from_probe("a hole")?;
        self.uncompensated("a hole")?;
        if self.compensation_pending() {
            return Err(refuse(
                Rule::Compensation,
                "cutter compensation cannot be switched at a hole",
            ));
        }
        if let CycleKind::Tap { left, .. } = cycle.kind {
            self.turns_into(left)?;
        }
        self.look_ahead(false)?;
        self.before_cut()?;
        if self.sent.cycle().is_some() && !self.settled(pose, stop, false)? {
            self.end_cycle()?;
        }
        if self.sent.cycle().is_none() {
            self.settle(pose, stop, false)?;
        }
        let own = self.own_cycle(cycle, pose);
        match own {
            Some(name) => self.native(name, cycle, pose, stop),
            None if matches!(cycle.kind, CycleKind::Tap { .. }) => {
                let message =
                    "the control has no tapping cycle for this hole, and moves cannot tap";
                let help = "tap by hand or mill the thread, or take a machine whose control has a tapping cycle";
                Err(refuse(Rule::CycleTap, message).help(help).into())
            }
            None if cycle.kind.withdrawal().is_some() => {
                let message = "no cycle of this machine's file goes aside from the wall of a hole, and moves \
                               cannot stop the spindle in position";
                let help = "bore without going aside (G86), or post the hole for another machine";
                Err(refuse(Rule::CycleBore, message).help(help).into())
            }
            None => self.expand(cycle, pose, stop),
        }
    }

    /// The thread of a tap goes into the hole as the spindle turns: counter-clockwise for one that is left-handed.
    fn turns_into(&self, left: bool) -> Outcome {
        let (hand, way, help) = match (left, self.wanted.spindle()) {
            (true, Spindle::Clockwise(_)) => ("left", "clockwise", "SPINDL/ with CCLW before it"),
            (false, Spindle::CounterClockwise(_)) => {
                ("right", "counter-clockwise", "SPINDL/ with CLW before it")
            }
            _ => return Ok(()),
        };
        let message = format!("a {hand}-hand thread is tapped while the spindle turns {way}");
        Err(refuse(Rule::CycleTap, message).help(help).into())
    }

    /// The block of the control's own cycle, where it has one that says everything.
    fn own_cycle(&self, cycle: &Cycle, pose: &Pose) -> Option<BlockName> {
        let dwells = cycle.dwell > 0.0;
        let name = match cycle.kind {
            CycleKind::Drill if dwells && self.templates.has(BlockName::CycleDwell) => {
                BlockName::CycleDwell
            }
            CycleKind::Drill => BlockName::CycleDrill,
            CycleKind::Deep => BlockName::CycleDeep,
            CycleKind::BreakChip => BlockName::CycleBreakChip,
            CycleKind::Tap { left: true, .. } => BlockName::CycleTapLeft,
            CycleKind::Tap { .. } => BlockName::CycleTap,
            CycleKind::Ream if dwells && self.templates.has(BlockName::CycleReamDwell) => {
                BlockName::CycleReamDwell
            }
            CycleKind::Ream => BlockName::CycleReam,
            CycleKind::Bore => BlockName::CycleBore,
            CycleKind::FineBore(_) | CycleKind::BackBore { .. } => return None,
        };
        let cycles = &self.machine.capabilities.cycles;
        let known = CycleName::of(cycle.kind).is_some_and(|name| cycles.contains(&name));
        let says_dwell =
            !dwells || self.templates.places(name, WordName::Dwell) && self.machine.counts_dwells();
        // A safety distance has no sign.
        let says_clearance =
            cycle.clearance >= 0.0 || !self.templates.places(name, WordName::Safety);
        let per_minute = !matches!(cycle.feed.or(self.wanted.feed()), Some(Feed::InverseTime(_)));
        let along_z = match self.place.kind {
            Kind::Plain | Kind::Tilted(..) | Kind::Machine => self.is_along_z(pose.axis()),
            Kind::Bare | Kind::ToolCenter | Kind::Vectors => false,
        };
        let says_all = says_dwell && says_clearance && per_minute && along_z;
        (known && self.templates.has(name) && says_all).then_some(name)
    }

    fn native(&mut self, name: BlockName, cycle: &Cycle, pose: &Pose, stop: &Stop) -> Outcome {
        let at = self.local(pose.point());
        let level = |word, height: f64| self.writer.rounded(word, at.z + height);
        let levels = Levels {
            surface: level(WordName::Surface, 0.0),
            clear: level(WordName::Clear, cycle.clearance),
            bottom: level(WordName::Bottom, -cycle.depth),
            retract: level(WordName::Retract, cycle.retract),
        };
        let over = pose.lifted(cycle.retract)?;
        self.check_hole(cycle, pose)?;
        let open = Open { block: name, levels };
        if self.templates.places(name, WordName::RPlane) {
            self.end_cycle()?;
            // The last one may have left it at rest.
            self.sync_spindle()?;
            self.settle(pose, stop, false)?;
            self.go_over(&over, stop)?;
            self.plane_xy()?;
            self.say_cycle(cycle, &levels)?;
            self.say_hole(at, &levels);
            self.block(name)?;
            self.writer.forget(bit(WordName::Motion));
        } else if self.sent.cycle() == Some(open) && self.stays_in_cycle(&over, stop) {
            self.say_hole(at, &levels);
            self.block(BlockName::CycleHole)?;
        } else {
            self.end_cycle()?;
            // The last one may have left it at rest.
            self.sync_spindle()?;
            self.settle(pose, stop, false)?;
            self.go_over(&over, stop)?;
            self.plane_xy()?;
            self.say_cycle(cycle, &levels)?;
            self.say_hole(at, &levels);
            self.block(name)?;
            if !self.templates.places(name, WordName::X) {
                self.say_hole(at, &levels);
                self.block(BlockName::CycleHole)?;
            }
            self.sent.define_cycle(open);
        }
        self.position.go_to(over);
        Ok(())
    }

    /// Checks the levels of a hole that a cycle makes against the limits.
    fn check_hole(&mut self, cycle: &Cycle, pose: &Pose) -> Outcome {
        let above = self.machine.settings.retract_above_r.filter(|_| cycle.kind == CycleKind::Deep);
        let cleared = above.map(|above| cycle.clearance + above);
        for height in [-cycle.depth, cycle.clearance, cycle.retract].into_iter().chain(cleared) {
            let tip = pose.lifted(height)?.point();
            self.position.aim(tip, self.local(tip));
            self.check_limits()?;
        }
        Ok(())
    }

    /// To the retract level over the first hole: up first and then across, or across and then down. A tool that turns on
    /// the way has no corner at which both legs are along its axis or across it: it goes there beyond all cuts, or from home.
    fn go_over(&mut self, over: &Pose, stop: &Stop) -> Outcome {
        let Some(here) = self.position.known() else {
            return self.rapid_to_hole(over, stop);
        };
        if !same(here.axis(), over.axis()) {
            return self.rapid_to_hole(over, stop);
        }
        let corner = over.at(corner(here.point(), over.point(), over.axis()))?;
        if !self.keeps_to_hole(&here, &corner, stop) || !self.keeps_to_hole(&corner, over, stop) {
            // Axes that go each at its own speed go across beyond all cuts.
            let high = corner.lifted(self.under(&corner))?;
            let up = (high.point() - here.point()).dot(here.axis());
            let down = (high.point() - over.point()).dot(over.axis());
            self.rapid_to_hole(&here.lifted(up)?, stop)?;
            self.rapid_to_hole(&over.lifted(down)?, stop)?;
            return self.rapid_to_hole(over, stop);
        }
        if corner.point().distance(here.point()) > self.resolution {
            self.rapid_to_hole(&corner, stop)?;
        }
        self.rapid_to_hole(over, stop)
    }

    /// Whether the cycle that is on may go from hole to hole by itself, to `over` at the level where it retracts.
    fn stays_in_cycle(&mut self, over: &Pose, stop: &Stop) -> bool {
        self.position.pose().is_none_or(|here| self.keeps_to_hole(&here, over, stop))
    }

    fn say_hole(&mut self, at: Vec3, levels: &Levels) {
        // A block without a position drills nothing, so it is said even where it is the old one.
        self.writer.forget(bit(WordName::X) | bit(WordName::Y));
        self.writer.set(WordName::X, at.x);
        self.writer.set(WordName::Y, at.y);
        self.writer.set(WordName::Bottom, levels.bottom);
        self.writer.set(WordName::Clear, levels.clear);
        self.writer.code(WordName::Motion, motion::RAPID);
    }

    fn say_cycle(&mut self, cycle: &Cycle, levels: &Levels) -> Outcome {
        let w = &mut self.writer;
        w.forget(bit(WordName::Bottom) | bit(WordName::Clear) | bit(WordName::Motion));
        w.forget(bit(WordName::RPlane) | bit(WordName::Retract) | bit(WordName::Lead));
        w.set(WordName::RPlane, levels.clear);
        w.set(WordName::Surface, levels.surface);
        w.set(WordName::Retract, levels.retract);
        w.set(WordName::Depth, levels.surface - levels.bottom);
        w.set(WordName::Safety, levels.clear - levels.surface);
        w.set(WordName::Lift, levels.retract - levels.surface);
        w.set(WordName::Dwell, cycle.dwell);
        if let (CycleKind::Deep | CycleKind::BreakChip, Some(pecks)) =
            (cycle.kind, lowering::pecks(cycle))
        {
            // One size of peck: the smaller of the first and the further ones, never more than asked.
            let asked = [cycle.first_peck, cycle.peck].into_iter().flatten();
            // A control refuses a peck deeper than the hole, whose depth is that of its levels as they are written.
            let peck = asked.fold(f64::INFINITY, f64::min).min(levels.surface - levels.bottom);
            w.set(WordName::Peck, peck);
            if cycle.first_peck.is_some_and(|first| first > peck) && pecks.len() > 1 {
                let message = "the first peck is made as small as the further ones";
                self.findings.warn(Diagnostic::warning(Rule::Peck, message).line(self.line));
            }
        }
        let speed = match self.wanted.spindle() {
            Spindle::Off => 0.0,
            Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => speed,
        };
        let mut feed = cycle.feed.or(self.wanted.feed());
        if let CycleKind::Tap { pitch, left } = cycle.kind {
            self.writer.set(WordName::Pitch, if left { -pitch } else { pitch });
            self.writer.set(WordName::Lead, pitch);
            // The feed of a tap follows from its pitch, whatever else is active.
            feed = Some(Feed::PerMinute(pitch * speed));
        }
        self.writer.set(WordName::S, speed);
        self.writer.set(WordName::Speed, speed);
        let before = self.wanted.set_feed(feed);
        let said = self.say_feed(0.0, 1, Cut::Straight);
        self.wanted.set_feed(before);
        self.writer.set(WordName::Plunge, said?);
        Ok(())
    }

    /// The control's cycle goes off.
    #[inline]
    pub(crate) fn end_cycle(&mut self) -> Outcome {
        let Some(open) = self.sent.end_cycle() else { return Ok(()) };
        self.block(BlockName::CycleOff)?;
        // Controls differ in whether the spindle turns after these.
        if matches!(
            open.block,
            BlockName::CycleBore | BlockName::CycleTap | BlockName::CycleTapLeft
        ) {
            self.sent.lose_spindle();
        }
        self.writer.forget(bit(WordName::Motion) | bit(WordName::Dwell));
        Ok(())
    }

    /// One hole as moves.
    fn expand(&mut self, cycle: &Cycle, pose: &Pose, stop: &Stop) -> Outcome {
        let Some(moves) = lowering::hole(cycle, pose, self.wanted.spindle()) else {
            return Err(refuse(Rule::CyclePeck, "the pecks of this cycle have no end"));
        };
        self.settle(pose, stop, false)?;
        self.go_over(&pose.lifted(cycle.retract)?, stop)?;
        self.rapid_to_hole(&pose.lifted(cycle.clearance)?, stop)?;
        let spindle = self.wanted.spindle();
        let feed = self.wanted.set_feed(cycle.feed.or(self.wanted.feed()));
        // Each move is a cut of its own, and none a piece of the last one.
        self.position.begin_cut(0.0);
        let count = moves.len();
        let done = moves.into_iter().try_for_each(|part| match part {
            HoleMove::Rapid(pose) => self.rapid_to_hole(&pose, stop),
            HoleMove::Line(pose) => self.line_to(&pose, stop),
            HoleMove::Dwell(seconds) => self.write_dwell(seconds),
            HoleMove::Spindle(spindle) => {
                self.wanted.set_spindle(spindle);
                // Out of the hole it waits for what needs it.
                if spindle == Spindle::Off { self.sync_spindle() } else { Ok(()) }
            }
        });
        self.wanted.set_spindle(spindle);
        self.wanted.set_feed(feed);
        self.findings.lowered(Rule::CycleExpanded, "holes of cycles", self.line, count);
        done
    }
}

/// What no cycle makes sense without.
fn check(cycle: &Cycle) -> Outcome {
    let levels = [cycle.depth, cycle.clearance, cycle.retract, cycle.dwell];
    let possible = levels.iter().all(|level| level.is_finite())
        && cycle.depth > 0.0
        && cycle.clearance > -cycle.depth
        && cycle.retract >= cycle.clearance
        && cycle.dwell >= 0.0;
    if possible {
        return Ok(());
    }
    let message = format!(
        "a hole {} mm deep, from {} mm above it and back to {} mm, dwell {} s",
        cycle.depth, cycle.clearance, cycle.retract, cycle.dwell
    );
    Err(refuse(Rule::Cycle, message))
}
