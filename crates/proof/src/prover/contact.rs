//! The spindle in motions that are no cuts: near the part a tool may touch it by rapid as well. What the source switches on
//! nowhere, the program does not switch on anywhere.

use super::*;
use crate::speeds::Speeds;
use program::{CycleKind, Op, Program, Rule};

/// What the spindle has done in the last motion, and where the tool is free of the part.
pub(super) struct Contact {
    /// All that the source reaches by feed; counted where it is asked for.
    fed: Option<CutBox>,
    /// How the spindle turned at the end of the last motion.
    turned: Spindle,
    /// Whether the control has left the spindle standing behind a tap or a bore, and nothing has started it since.
    left_standing: bool,
    /// The spindle has been switched where the tool stands near the part, as neither the source has it nor the last motion: on this line,
    /// and how.
    switched: Option<(u32, Spindle)>,
    /// What the source switches on anywhere; counted where it is asked for.
    used: Option<Used>,
    /// How fast the source has its tools turn; counted where it is asked for.
    speeds: Option<Speeds>,
}

/// What a source switches on anywhere.
#[derive(Default)]
struct Used {
    clockwise: bool,
    counter_clockwise: bool,
    coolants: Coolants,
}

/// Each kind of coolant by itself.
#[derive(Clone, Copy, Default)]
struct Coolants {
    flood: bool,
    mist: bool,
    through: bool,
}

impl Coolants {
    fn of(coolant: Coolant) -> Coolants {
        Coolants {
            flood: matches!(coolant, Coolant::Flood | Coolant::FloodAndMist),
            mist: matches!(coolant, Coolant::Mist | Coolant::FloodAndMist),
            through: coolant == Coolant::Through,
        }
    }

    fn with(self, other: Coolants) -> Coolants {
        Coolants {
            flood: self.flood || other.flood,
            mist: self.mist || other.mist,
            through: self.through || other.through,
        }
    }

    /// The first kind that is on here and not in `others`, by name.
    fn beyond(self, others: Coolants) -> Option<&'static str> {
        [
            (self.flood && !others.flood, "flood coolant"),
            (self.mist && !others.mist, "mist"),
            (self.through && !others.through, "coolant through the tool"),
        ]
        .into_iter()
        .find_map(|(beyond, name)| beyond.then_some(name))
    }
}

impl Used {
    #[expect(clippy::wildcard_enum_match_arm, reason = "no other record switches anything on")]
    fn of(source: &Program) -> Used {
        let mut used = Used::default();
        for record in &source.records {
            match &record.op {
                Op::Spindle(Spindle::Clockwise(_)) => used.clockwise = true,
                Op::Spindle(Spindle::CounterClockwise(_)) => used.counter_clockwise = true,
                // A tap that is made by moves turns both ways.
                Op::Cycle(cycle) if matches!(cycle.kind, CycleKind::Tap { .. }) => {
                    (used.clockwise, used.counter_clockwise) = (true, true);
                }
                Op::Coolant(coolant) => {
                    used.coolants = used.coolants.with(Coolants::of(*coolant));
                }
                _ => {}
            }
        }
        used
    }
}

impl Contact {
    /// Before the first motion.
    pub fn new() -> Contact {
        Contact {
            fed: None,
            turned: Spindle::Off,
            left_standing: false,
            switched: None,
            used: None,
            speeds: None,
        }
    }

    /// A motion has ended with the spindle so.
    pub fn moved(&mut self, spindle: Spindle) {
        (self.turned, self.switched) = (spindle, None);
    }

    /// The program has made a hole of this kind by its cycle.
    pub fn drilled(&mut self, kind: CycleKind) {
        self.left_standing = matches!(kind, CycleKind::Tap { .. } | CycleKind::Bore);
    }
}

impl Prover<'_> {
    /// Compares the spindle in a motion to `to`, or, where that is `None`, to home, that is no cut. The program may stop and start it
    /// where the tool is free of the part: home, or beyond all that the source reaches by feed. On its way out of a cut it turns as the
    /// source has it in this motion, or as it has turned in the cut.
    pub(super) fn check_contact(&mut self, line: u32, to: Option<&ResolvedPose>) {
        let (wanted, is) = (self.cursor.wanted.spindle, self.running.spindle);
        let allowed = self.gauge.allowed;
        if self.gauge.machine.wire.is_some() || state::same_spindle(&allowed, wanted, is) {
            self.contact.left_standing &= is == Spindle::Off;
            return;
        }
        let here = self.here;
        let leaves = !self.raised && self.is_near(&here);
        let moves = matches!(self.cursor.step, Step::Move(_));
        let comes = moves && to.is_some_and(|to| self.is_near(to));
        if !leaves && !comes || leaves && self.may_leave_so(wanted, is, to) {
            return;
        }
        self.differs(line, state::wrong_spindle(wanted, is));
    }

    /// Holds the speed within what the spindle takes, also where nothing is cut.
    pub(super) fn check_speed(&mut self, line: u32, spindle: Spindle) {
        let (speed, most) = (state::speed(spindle), self.gauge.machine.spindle.max);
        if speed > most + self.gauge.allowed.speed_per_min {
            let message = format!(
                "the spindle is switched on with {} 1/min, and turns at {} at the most",
                Number(speed),
                Number(most)
            );
            self.differs(line, (Rule::SpindleRange, message));
        }
    }

    /// Refuses a spindle that is started the way in which it turns nowhere in the source, also where nothing is cut.
    pub(super) fn check_direction(&mut self, line: u32, spindle: Spindle) {
        let same_way =
            |of: Spindle| std::mem::discriminant(&of) == std::mem::discriminant(&spindle);
        if spindle == Spindle::Off
            || same_way(self.cursor.wanted.spindle)
            || self.gauge.machine.wire.is_some()
        {
            return;
        }
        let used = self.used();
        let (is_used, way) = match spindle {
            Spindle::Off => return,
            Spindle::Clockwise(_) => (used.clockwise, "clockwise"),
            Spindle::CounterClockwise(_) => (used.counter_clockwise, "counter-clockwise"),
        };
        if !is_used {
            let message =
                format!("the spindle is started {way}, as it turns nowhere in the source");
            self.differs(line, (Rule::Spindle, message));
        }
    }

    /// Refuses a spindle that turns faster than the source names a speed for the tool in it, also where nothing is cut.
    pub(super) fn check_fastest(&mut self, line: u32, spindle: Spindle) {
        let is = state::speed(spindle);
        if is == 0.0 || self.gauge.machine.wire.is_some() {
            return;
        }
        let source = self.source;
        let speeds = self.contact.speeds.get_or_insert_with(|| Speeds::of(source));
        let fastest = speeds.fastest(self.running.tool.as_ref());
        // A source without any speed names no direction either.
        if fastest > 0.0 && is > fastest + self.gauge.allowed.speed_per_min {
            let message = format!(
                "the spindle is switched on with {} 1/min, and the source names no speed above {} for this tool",
                Number(is),
                Number(fastest)
            );
            self.differs(line, (Rule::Spindle, message));
        }
    }

    /// Refuses coolant of a kind that the source switches on nowhere, also where nothing is cut.
    pub(super) fn check_coolant(&mut self, line: u32, coolant: Coolant) {
        let is = Coolants::of(coolant);
        if is.beyond(Coolants::of(self.cursor.wanted.coolant)).is_none()
            || self.gauge.machine.wire.is_some()
        {
            return;
        }
        if let Some(name) = is.beyond(self.used().coolants) {
            let message = format!("{name} is switched on, as it is nowhere in the source");
            self.differs(line, (Rule::Coolant, message));
        }
    }

    fn used(&mut self) -> &Used {
        let source = self.source;
        self.contact.used.get_or_insert_with(|| Used::of(source))
    }

    /// Compares the spindle where it has been switched between two motions. Where the tool stands near the part and it is switched once
    /// more before anything moves, no motion shows what it has done in between.
    pub(super) fn check_standing(&mut self, line: u32) {
        if self.gauge.machine.wire.is_some() || self.raised {
            return;
        }
        if let Some((line, is)) = self.contact.switched.take() {
            self.differs(line, state::wrong_spindle(self.cursor.wanted.spindle, is));
        }
        let (wanted, is, here) = (self.cursor.wanted.spindle, self.running.spindle, self.here);
        if !self.is_between(is) && self.is_near(&here) && !self.may_leave_so(wanted, is, None) {
            self.contact.switched = Some((line, is));
        }
    }

    /// Whether the spindle turns as it has turned, or as the source has switched it since the last motion: the direction of one of
    /// these with the speed of another, where a program says them in two blocks.
    fn is_between(&self, is: Spindle) -> bool {
        let known = || {
            let switched = self.cursor.switched().iter().copied();
            switched.chain([self.contact.turned, self.cursor.wanted.spindle])
        };
        let with_speed = |of: Spindle| match is {
            Spindle::Off => of,
            Spindle::Clockwise(_) => Spindle::Clockwise(state::speed(of)),
            Spindle::CounterClockwise(_) => Spindle::CounterClockwise(state::speed(of)),
        };
        let as_fast = |of| state::same_spindle(&self.gauge.allowed, with_speed(of), is);
        let same_way = |of| std::mem::discriminant(&of) == std::mem::discriminant(&is);
        known().any(same_way) && known().any(as_fast)
    }

    /// Whether the spindle may be as it `is` on the way out, where the source wants it otherwise.
    fn may_leave_so(&self, wanted: Spindle, is: Spindle, to: Option<&ResolvedPose>) -> bool {
        let goal = if let Step::Move(goal) = &self.cursor.step { Some(goal) } else { None };
        let is_own = goal.is_none_or(|goal| goal.tool_change || goal.homed);
        let stops_in_hole = goal.is_some_and(
            |goal| matches!(goal.kind, Kind::Hole(cycle) if cycle.kind == CycleKind::Bore),
        );
        if is == Spindle::Off && stops_in_hole && self.progress.hole.over {
            // Whether it stands where it has to, the comparison of the hole says.
            return true;
        }
        if is == Spindle::Off && self.contact.left_standing {
            return to.is_none_or(|to| !stops::lifted(&self.gauge, to, &self.here));
        }
        let alike = |spindle: &Spindle| state::same_spindle(&self.gauge.allowed, *spindle, is);
        if is_own {
            return alike(&self.contact.turned) || self.cursor.switched().iter().any(alike);
        }
        // Where the source stops the spindle before it draws the tool out, it has a reason.
        alike(&self.contact.turned) && wanted != Spindle::Off && is != Spindle::Off
    }

    /// Whether the tool stands where the source may have something around it.
    fn is_near(&mut self, at: &ResolvedPose) -> bool {
        if !at.place.known() {
            return false;
        }
        let fed = self.contact.fed.get_or_insert_with(|| CutBox::fed(self.source));
        let PartialPose { tip, axis } = at.place;
        tip.dot(axis) < fed.reach(axis) - self.gauge.slack(at)
    }
}
