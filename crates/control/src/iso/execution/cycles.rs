//! Canned cycles: `G73`, `G74`, `G76`, `G80` to `G89`.

use super::motion::{LINEAR, Target};
use super::state::{Holding, State, Tilt};
use super::step::Step;
use crate::event::{Action, Orientation, Risk};
use crate::iso::dialects::facts::Cycles;
use crate::iso::language::Fault;
use crate::iso::language::words::{Canned, FeedMode, G, Group};
use geom::Vec3;
use program::{Cycle, CycleKind, Feed, Rule, Spindle, Withdrawal};

/// The most often that a block may repeat its hole: FANUC's K has four digits.
const MOST_REPEATS: u32 = 9999;

impl Canned {
    fn pecks(self) -> bool {
        matches!(self, Canned::Deep | Canned::BreakChip)
    }

    fn goes_aside(self) -> bool {
        matches!(self, Canned::FineBore | Canned::BackBore)
    }

    fn needs_dwell(self, rules: &Cycles) -> bool {
        match self {
            Canned::DwellDrill | Canned::DwellReam | Canned::HandBore => true,
            // RS274 asks for P; FANUC's G86 has none.
            Canned::Bore => rules.bore_dwells,
            Canned::BreakChip
            | Canned::LeftTap
            | Canned::Drill
            | Canned::Deep
            | Canned::Tap
            | Canned::Ream
            | Canned::FineBore
            | Canned::BackBore => false,
        }
    }

    fn may_dwell(self, rules: &Cycles) -> bool {
        self.needs_dwell(rules)
            || self.goes_aside()
            || matches!(self, Canned::Tap | Canned::LeftTap)
    }
}

impl Step<'_, '_, '_> {
    /// The cycle of the block becomes active.
    pub(super) fn begin_cycle(&mut self, canned: Canned) -> Result<(), Fault> {
        self.not_compensated("a cycle")?;
        self.looks_ahead_no_more();
        if self.state.keeps_center() {
            // It would go along Z of the work, wherever the tool points.
            let message = "a cycle while the control keeps the tool centre point: end that first";
            return Err(self.block.whole(Rule::Cycle, message));
        }
        let axis = self.state.plane.axes()[2];
        if self.facts.cycles.apart && axis != 2 {
            let message = "a cycle out of the plane G17: the drilling axis is a setting (5101#0)";
            return Err(self.block.whole(Rule::Cycle, message));
        }
        // LinuxCNC feeds along another axis than that of the plane there (found with `rs274`).
        if self.facts.cycles.taps_in_g17
            && axis != 2
            && matches!(canned, Canned::Tap | Canned::LeftTap)
        {
            let message = "G84 and G74 are followed in G17 only";
            return Err(self.block.whole(Rule::Cycle, message));
        }
        if !self.facts.cycles.apart {
            self.state.motion = None;
        }
        let fresh = Holding {
            canned,
            initial: self.state.position[axis],
            words: (None, None),
            r: None,
            bottom: None,
            q: None,
            dwell: None,
            reported: None,
            rigid: false,
        };
        self.state.cycle = Some(match self.state.cycle {
            None => fresh,
            // FANUC keeps the data until G80; LinuxCNC while the same word is repeated.
            Some(held) if self.facts.cycles.apart || held.canned == canned => {
                Holding { canned, ..held }
            }
            Some(held) => Holding {
                initial: held.initial,
                reported: held.reported,
                rigid: held.rigid,
                ..fresh
            },
        });
        Ok(())
    }

    /// Whether rigid tapping goes on behind this block, by which the spindle is an axis (B-64484EN-2, "Rigid tapping").
    pub(super) fn taps_on(&self) -> bool {
        let another = |group| self.block.g(group).is_some_and(|code| !matches!(code, G::Cycle(_)));
        let ends = [Group::Motion, Group::Cycle].into_iter().any(another);
        self.state.cycle.is_some_and(|held| held.rigid) && !ends
    }

    /// No cycle is active any more.
    pub(super) fn end_cycle(&mut self) {
        let Some(held) = self.state.cycle.take() else { return };
        if held.reported.is_some() {
            self.actions.push(Action::CycleOff);
        }
        // The end of rigid tapping leaves the spindle standing.
        if held.rigid {
            self.state.rigid = false;
            self.turn(Spindle::Off);
        }
    }

    /// Drills what the block says.
    pub(super) fn holes(&mut self) -> Result<(), Fault> {
        let Some(mut held) = self.state.cycle else { return Ok(()) };
        let drills = b"XYZ@^".iter().any(|&letter| self.block.has(letter))
            || self.facts.cycles.apart && self.block.has(b'R');
        if !drills {
            let asked = [Group::Motion, Group::Cycle]
                .iter()
                .any(|&group| matches!(self.block.g(group), Some(G::Cycle(_))));
            return if asked { Err(self.wrong("a cycle without an axis word")) } else { Ok(()) };
        }
        let level = self.series(&mut held)?;
        let repeats = self.repeats()?;
        let [first, second, axis] = self.state.plane.axes();
        for nth in 0..repeats.max(1) {
            if nth > 0 {
                // In G91 from hole to hole.
                self.block.again(&[LINEAR[first], LINEAR[second], b'@', b'^']);
            }
            let (point, rotary) = (self.state.position, self.state.rotary);
            let mut place = Target { point, rotary, named: 0 };
            self.in_plane(&mut place, false)?;
            self.together(place.named)?;
            if repeats > 0 {
                self.drill(place.point.with_axis(axis, level), &mut held)?;
            }
        }
        self.state.cycle = Some(held);
        Ok(())
    }

    /// One hole of the active cycle at `place`.
    pub(super) fn hole_at(&mut self, place: Vec3) -> Result<(), Fault> {
        let Some(mut held) = self.state.cycle else { return Ok(()) };
        let axis = self.state.plane.axes()[2];
        let level = self.series(&mut held)?;
        self.drill(place.with_axis(axis, level), &mut held)?;
        self.state.cycle = Some(held);
        Ok(())
    }

    /// Takes over what the block says of the cycle, and answers the level of its point.
    fn series(&mut self, held: &mut Holding) -> Result<f64, Fault> {
        self.may_drill(held)?;
        self.levels(held, self.state.plane.axes()[2])?;
        self.feed_for_cut()?;
        Ok(held.ends().0.unwrap_or(held.initial))
    }

    fn may_drill(&self, held: &Holding) -> Result<(), Fault> {
        let axis = self.state.plane.axes()[2];
        let transform = &self.state.frames.transform;
        if transform.factor(axis) != 1.0 || transform.mirror[axis].is_some() {
            let message = "a cycle while its axis is scaled or mirrored";
            return Err(self.block.whole(Rule::Frame, message));
        }
        if let Tilt::Declared(_) = self.state.tilt {
            let message = "a cycle in a tilted plane before G53.1 has brought the tool along its Z";
            return Err(self.block.whole(Rule::TiltedPlane, message));
        }
        if let Some(&letter) = b"ABC".iter().find(|&&letter| self.block.has(letter)) {
            let message = "a rotary axis in a cycle; move it before";
            return Err(self.block.at_word(letter, Rule::Cycle, message));
        }
        // LinuxCNC, "Canned Cycle Errors"; elsewhere F would be the time of moves that the manuals do not name.
        if self.state.feed_mode == FeedMode::InverseTime {
            let message = "a cycle in inverse time (G93), in which F is the time of a move";
            let fault = self.block.whole(Rule::Cycle, message);
            return Err(fault.help("write G94 before it, and the feed").into());
        }
        if held.initial.is_nan() {
            let message = "a cycle starts, and at which level the tool stands is not known";
            return Err(self.block.whole(Rule::UnknownPosition, message));
        }
        Ok(())
    }

    /// R, bottom, Q and P of the block; what it does not give stays.
    ///
    /// In `G91` R counts from the level where the cycle starts and the bottom from R.
    fn levels(&mut self, held: &mut Holding, axis: usize) -> Result<(), Fault> {
        let incremental = self.state.incremental;
        let level = |from: f64, value: f64| if incremental { from + value } else { value };
        let (r, z) = (self.take_length(b'R')?, self.take_length(LINEAR[axis])?);
        (held.words.0, held.words.1) = (r.or(held.words.0), z.or(held.words.1));
        if self.facts.cycles.apart {
            // The levels stay, whatever becomes of G90 and G91.
            if let Some(value) = r {
                held.r = Some(level(held.initial, value));
                held.bottom = held.bottom.filter(|_| !incremental);
            }
            if let Some(value) = z {
                held.bottom = Some(level(held.r.unwrap_or(f64::NAN), value));
            }
        } else {
            // The numbers stay, and mean what G90 or G91 now makes of them (found with `rs274`).
            held.r = held.words.0.map(|value| level(held.initial, value));
            held.bottom = held.words.1.map(|value| level(held.r.unwrap_or(f64::NAN), value));
        }
        if (held.canned.pecks() || held.canned.goes_aside())
            && let Some(value) = self.take_length(b'Q')?
        {
            if value <= 0.0 {
                return Err(self.block.at_word(b'Q', Rule::Cycle, "Q must be greater than 0"));
            }
            held.q = Some(value);
        }
        if held.canned.may_dwell(&self.facts.cycles) {
            let seconds = self.dwell_p()?;
            if seconds.is_some_and(|s| s < 0.0) {
                return Err(self.block.at_word(b'P', Rule::Cycle, "P is below 0"));
            }
            held.dwell = seconds.or(held.dwell);
            self.state.cycle_dwell = seconds.or(self.state.cycle_dwell);
        }
        Ok(())
    }

    /// The active cycle for the neutral program: its point is the upper end of its feed.
    fn cycle(&mut self, held: &mut Holding) -> Result<Cycle, Fault> {
        let (Some(top), Some(bottom)) = held.ends() else {
            let missing = if held.r.is_none() { "R" } else { "its bottom" };
            return Err(self.wrong(format!("the cycle has not been given {missing}")));
        };
        let (upper, lower) = match held.canned == Canned::BackBore {
            true => ("end of the feed", "R plane"),
            false => ("R plane", "bottom"),
        };
        if bottom >= top {
            let message = format!("the {lower} {bottom} is not below the {upper} {top}");
            return Err(self.wrong(message));
        }
        if held.initial < top && self.facts.cycles.apart {
            let message =
                format!("the {upper} {top} lies above the initial level {}", held.initial);
            return Err(self.wrong(message));
        }
        let peck = if held.canned.pecks() {
            Some(held.q.ok_or_else(|| self.wrong("a peck cycle needs Q"))?)
        } else {
            None
        };
        if held.canned.needs_dwell(&self.facts.cycles) && held.dwell.is_none() {
            return Err(self.wrong("this cycle needs its dwell P"));
        }
        let dwell = if !held.canned.may_dwell(&self.facts.cycles) {
            None
        } else if self.facts.cycles.dwell_stays {
            // Tapping without P dwells as long as the last cycle that had one (found with `rs274`).
            self.state.cycle_dwell
        } else {
            held.dwell
        };
        let kind = match held.canned {
            Canned::Drill | Canned::DwellDrill => CycleKind::Drill,
            Canned::Deep => CycleKind::Deep,
            Canned::BreakChip => CycleKind::BreakChip,
            Canned::Ream | Canned::DwellReam => CycleKind::Ream,
            // What follows the bottom is done by moves: see `by_hand`.
            Canned::HandBore | Canned::Bore => CycleKind::Bore,
            Canned::Tap => self.tapping(held, false)?,
            Canned::LeftTap => self.tapping(held, true)?,
            Canned::FineBore => CycleKind::FineBore(self.withdrawal(held)?),
            Canned::BackBore => {
                CycleKind::BackBore { withdrawal: self.withdrawal(held)?, through: None }
            }
        };
        let initial = (held.initial - top).max(0.0);
        let retract = match self.state.return_to_r {
            Some(true) if held.canned == Canned::BackBore => {
                let message = "back boring goes back to the initial level: it needs G98";
                return Err(self.wrong(message));
            }
            Some(true) => 0.0,
            Some(false) => initial,
            None => {
                let fault = self.wrong("a cycle, and neither G98 nor G99 has been given");
                let help = "write G98 or G99: a control keeps that of the program before";
                return Err(fault.help(help).into());
            }
        };
        Ok(Cycle {
            kind,
            depth: top - bottom,
            clearance: if held.canned == Canned::BackBore { initial } else { 0.0 },
            retract,
            feed: None,
            dwell: dwell.unwrap_or(0.0),
            first_peck: peck,
            peck,
        })
    }

    /// How a boring bar leaves the wall: by Q, the way that the machine is set to. That way is of the
    /// axes: no mirror and no turn of the coordinates changes it (B-64484EN-2, notes of `G76`, `G87`,
    /// `G51.1`), so it is not followed through these.
    fn withdrawal(&self, held: &Holding) -> Result<Withdrawal, Fault> {
        if self.state.frames.is_transformed() {
            let message = "the tool goes aside while the coordinates are turned, scaled or tilted";
            return Err(self.block.whole(Rule::Frame, message));
        }
        let turns = match held.canned == Canned::BackBore {
            // It starts the spindle so by itself at R.
            true => matches!(self.state.spindle, Spindle::Clockwise(_)),
            false => self.state.spindle != Spindle::Off,
        };
        if !turns {
            return Err(self.wrong("the spindle does not turn as this cycle needs"));
        }
        let q = held.q.ok_or_else(|| self.wrong("Q says how far the tool goes aside"))?;
        let Some(direction) = self.state.aside else {
            let message = "which way the tool goes aside is a setting of the machine (FANUC: \
                           parameter 5148; Haas: setting 27)";
            let help = "say it: the way that the tool goes, not that of its tip";
            return Err(self.wrong(message).help(help).into());
        };
        Ok(Withdrawal { aside: direction * q, angle: None })
    }

    /// Tapping: the pitch is what the tool advances in a turn. The spindle turns the right way
    /// already, or rigid tapping (`M29`) turns it.
    fn tapping(&mut self, held: &mut Holding, left: bool) -> Result<CycleKind, Fault> {
        let own = self.state.surface.is_none();
        let speed = self.state.speed.filter(|&speed| own && speed > 0.0);
        let speed = speed.ok_or_else(|| self.wrong("tapping needs the spindle speed S"))?;
        let needed =
            if left { Spindle::CounterClockwise(speed) } else { Spindle::Clockwise(speed) };
        // Haas turns the spindle itself in any case.
        if self.state.rigid || self.facts.cycles.turns_spindle {
            held.rigid = true;
            self.turn(needed);
        } else if self.state.spindle != needed {
            let message = "the spindle does not turn the way this tapping cycle needs";
            return Err(self.wrong(message));
        } else if !self.state.floating_holder && self.facts.source.is_none() {
            self.actions.push(Action::Risk(Risk::FLOATING_TAP.into()));
        }
        let pitch = match self.state.feed {
            Some(Feed::PerMinute(feed)) => feed / speed,
            Some(Feed::PerTurn(pitch)) => pitch,
            _ => return Err(self.wrong("tapping needs a feed in mm/min or mm per turn")),
        };
        Ok(CycleKind::Tap { pitch, left })
    }

    /// How often the hole is made: FANUC K, LinuxCNC L.
    fn repeats(&mut self) -> Result<u32, Fault> {
        let (letter, least) = self.facts.cycles.repeats;
        match self.take_whole(letter)? {
            None => Ok(1),
            Some(repeats) if (least..=MOST_REPEATS).contains(&repeats) => Ok(repeats),
            Some(_) => {
                let message =
                    format!("{} repeats {least} to {MOST_REPEATS} times", char::from(letter));
                Err(self.block.at_word(letter, Rule::Cycle, message))
            }
        }
    }

    /// Up to the R plane by rapid.
    fn lift(&mut self, r: f64, axis: usize) {
        self.state.position[axis] = r;
        let pose = self.state.pose(self.state.position, self.state.rotary);
        self.actions.push(Action::Rapid(pose));
    }

    /// One hole from its point on the R plane.
    fn drill(&mut self, at: Vec3, held: &mut Holding) -> Result<(), Fault> {
        if at.is_nan() {
            let message = "a hole, and where the tool stands in the plane is not known";
            return Err(self.block.whole(Rule::UnknownPosition, message));
        }
        let axis = self.state.plane.axes()[2];
        let cycle = self.cycle(held)?;
        let r = at[axis];
        // A series that starts below the R plane goes to it first, before the way in the plane: up, or
        // after a higher one down (found with `rs274`).
        if held.initial < r && self.state.position[axis] != r {
            self.lift(r, axis);
        }
        let level = at.with_axis(axis, r + cycle.retract);
        if held.canned == Canned::HandBore {
            self.by_hand(at, level, axis, &cycle)?;
        } else {
            if self.facts.cycles.peck_retract_is_set
                && held.canned == Canned::Deep
                && !std::mem::replace(&mut self.state.knows_peck_retract, true)
            {
                self.actions.push(Action::Risk(Risk::PECK_RETRACT.into()));
            }
            if held.reported.replace(cycle) != Some(cycle) {
                self.actions.push(Action::Cycle(Box::new(cycle)));
            }
            let mut pose = self.state.pose(at, self.state.rotary);
            if axis != 2 {
                pose.orientation = Orientation::Axis(self.state.place.direction(Vec3::AXES[axis]));
            }
            self.actions.push(Action::Hole(pose));
        }
        self.state.arrive(level, self.state.rotary);
        Ok(())
    }

    /// `G88`: at the bottom the spindle stops and the program, too; the operator draws the tool out,
    /// and the program goes on with the way back.
    fn by_hand(&mut self, at: Vec3, level: Vec3, axis: usize, cycle: &Cycle) -> Result<(), Fault> {
        let spindle = self.state.spindle;
        if spindle == Spindle::Off {
            return Err(self.wrong("the spindle stands"));
        }
        let from = self.state.position[axis].max(at[axis]);
        let rotary = self.state.rotary;
        let pose = |state: &State, point: Vec3| state.pose(point, rotary);
        self.actions.push(Action::Rapid(pose(self.state, at.with_axis(axis, from))));
        self.actions.push(Action::Rapid(pose(self.state, at)));
        self.actions
            .push(Action::Line(pose(self.state, at.with_axis(axis, at[axis] - cycle.depth))));
        self.actions.push(Action::Dwell(cycle.dwell));
        self.turn(Spindle::Off);
        self.actions.push(Action::Stop);
        self.actions.push(Action::Rapid(pose(self.state, level)));
        self.turn(spindle);
        Ok(())
    }

    fn wrong(&self, message: impl Into<String>) -> Fault {
        self.block.whole(Rule::Cycle, message)
    }
}

/// A vector with one of its coordinates replaced.
trait WithAxis {
    fn with_axis(self, axis: usize, value: f64) -> Self;
}

impl WithAxis for Vec3 {
    fn with_axis(mut self, axis: usize, value: f64) -> Vec3 {
        self[axis] = value;
        self
    }
}
