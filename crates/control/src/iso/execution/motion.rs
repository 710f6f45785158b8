//! Moves: what a block moves, where to, and the straight ones.

use super::state::{Polar, Tilt};
use super::step::Step;
use crate::event::{Action, Risk};
use crate::iso::dialects::facts::Rollover;
use crate::iso::language::Fault;
use crate::iso::language::words::{FeedMode, G, Group, Motion, bit};
use crate::kernel::modulo::{self, Modulo};
use geom::{Arc, Vec3};
use program::{Compensation, Feed, Rule};

/// The letters of the linear axes.
pub(super) const LINEAR: [u8; 3] = *b"XYZ";

/// Where a block goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// In the programmed frame, mm.
    pub point: Vec3,
    /// Degrees of A, B, C.
    pub rotary: [f64; 3],
    /// The axes that the block names: bit 0 is X, 3 is A; [`super::wire::LEANS`].
    pub named: u8,
}

impl Step<'_, '_, '_> {
    /// What the block moves.
    pub(super) fn motion(&mut self) -> Result<(), Fault> {
        self.counts_axes()?;
        self.taps_behind_rigid()?;
        let Some(word) = self.block.g(Group::OneShot) else {
            return self.interpolation().and_then(|()| self.go());
        };
        if let G::LookAhead { letter, on } = word {
            return self.look_ahead(letter, on);
        }
        let takes_axis_words = matches!(
            word,
            G::Home
                | G::SecondHome
                | G::Machine
                | G::OneSided
                | G::Skip
                | G::FromHome
                | G::WriteData
                | G::ShiftHere
                | G::ShiftTo
                | G::Pocket { .. }
                | G::Pattern(_)
        );
        if takes_axis_words {
            self.has_the_axis_words(word)?;
        }
        self.interpolation()?;
        match word {
            G::Home | G::SecondHome => self.home(word == G::SecondHome),
            G::StoreHome { second } => self.store_home(second),
            G::FromHome => self.leave_home(),
            G::Machine => self.machine_position(),
            G::SwingToTilt => self.swing(),
            // A skip that does not come is no error.
            G::Skip => self.probe(false, false),
            G::OneSided => self.one_sided(),
            G::Pocket { clockwise } => self.pocket(clockwise),
            G::Pattern(pattern) => self.pattern(pattern),
            G::WriteData | G::ShiftHere | G::ShiftTo => self.coordinates(word),
            G::CancelShift { .. } | G::RestoreShift => {
                self.coordinates(word)?;
                self.go()
            }
            // What follows is executed elsewhere (modes, dwells, calls), and the block moves as the modes say. Each word is named: a new
            // one does not compile before it is decided here.
            G::Motion(_)
            | G::Cycle(_)
            | G::CancelCycle
            | G::Plane(_)
            | G::Incremental(_)
            | G::CentersAbsolute(_)
            | G::FeedMode(_)
            | G::Inches(_)
            | G::Compensation(_)
            | G::DynamicCompensation(_)
            | G::Taper(_)
            | G::Length
            | G::ToolCenter
            | G::DynamicLength
            | G::CancelLength
            | G::ReturnToR(_)
            | G::WorkOffset(_)
            | G::FurtherOffset { .. }
            | G::Neutral(_)
            | G::Path(_)
            | G::LockOverrides
            | G::Smoothness
            | G::Turn
            | G::Tilt
            | G::Upright
            | G::Scale(_)
            | G::Mirror(_)
            | G::Polar(_)
            | G::Diameter(_)
            | G::SurfaceSpeed(_)
            | G::Dwell
            | G::DynamicOffset(_)
            | G::ExactBlock
            | G::LookAhead { .. }
            | G::MacroCall { .. }
            | G::CancelMacroCall => self.go(),
        }
    }

    /// What a block without an axis word means for a motion that needs one.
    ///
    /// # Errors
    /// The block asks for that motion.
    pub(super) fn has_no_axis_word(&self) -> Result<(), Fault> {
        let asks = matches!(self.block.g(Group::Motion), Some(G::Motion(_)))
            || self.block.g(Group::OneShot) == Some(G::Skip);
        if !asks {
            return Ok(());
        }
        Err(self.block.whole(Rule::MissingWord, "no axis word says where the move goes"))
    }

    /// # Errors
    /// Another word of the block uses its axis words, too.
    fn has_the_axis_words(&self, word: G) -> Result<(), Fault> {
        let motion = self.block.g(Group::Motion);
        let takes = self.facts.motion.one_shot_with_motion;
        let is_refused = match motion {
            None => return Ok(()),
            Some(G::Motion(Motion::Rapid)) => takes || word == G::Machine,
            Some(G::Motion(Motion::Line)) => word == G::Machine || takes && word == G::Skip,
            Some(_) => false,
        };
        if is_refused {
            return Ok(());
        }
        let message = "two words of the block use its axis words: which one has them?";
        Err(self.block.at_group(Group::OneShot, Rule::ModalGroup, message))
    }

    /// The motion word of the block: on LinuxCNC and GRBL also a cycle or `G80`.
    /// "Between M29 and G84 no axis moves" (B-64484EN-2, "Rigid tapping"; alarm PS0204).
    fn taps_behind_rigid(&self) -> Result<(), Fault> {
        let waits = self.state.rigid && self.state.cycle.is_none();
        let is_cycle = matches!(self.block.g(Group::Cycle), Some(G::Cycle(_)));
        let moves = self.block.g(Group::OneShot).is_none()
            && b"XYZABC".iter().any(|&letter| self.block.has(letter));
        if !waits || is_cycle || !moves {
            return Ok(());
        }
        let message = "an axis moves between M29 and its G84 or G74 (alarm PS0204)";
        let fault = self.block.whole(Rule::Cycle, message);
        Err(fault.help("write M29 right before the block of the cycle").into())
    }

    pub(super) fn motion_of_block(&self) -> Option<Motion> {
        match self.block.g(Group::Motion) {
            Some(G::Motion(motion)) => Some(motion),
            Some(_) => None,
            None => self.state.motion,
        }
    }

    /// Takes over the words for interpolation and cycles.
    fn interpolation(&mut self) -> Result<(), Fault> {
        let motion = self.block.g(Group::Motion);
        let cycle = self.block.g(Group::Cycle);
        if cycle.is_some() && matches!(motion, Some(G::Cycle(_)))
            || motion.is_some() && matches!(cycle, Some(G::Cycle(_)))
        {
            let message = "a cycle and another motion word in a block";
            return Err(self.block.at_group(Group::Cycle, Rule::ModalGroup, message));
        }
        for word in [cycle, motion].into_iter().flatten() {
            if let G::Motion(motion) = word {
                self.end_cycle();
                self.state.motion = Some(motion);
            } else if word == G::CancelCycle {
                self.end_cycle();
                // FANUC goes on with the interpolation of before: a cycle is no part of group 01.
                if !self.facts.cycles.apart {
                    self.state.motion = None;
                }
            } else if let G::Cycle(canned) = word {
                self.begin_cycle(canned)?;
            }
        }
        Ok(())
    }

    /// Moves as the modes say.
    pub(super) fn go(&mut self) -> Result<(), Fault> {
        if self.state.cycle.is_some() {
            return self.holes();
        }
        let Some(motion) = self.state.motion else {
            return match b"XYZABC@^".iter().find(|&&letter| self.block.has(letter)) {
                Some(&letter) => {
                    let message = "an axis word, and no G0, G1, G2 or G3 says how to move";
                    Err(self.block.at_word(letter, Rule::MissingWord, message))
                }
                None => Ok(()),
            };
        };
        match motion {
            Motion::Thread => self.thread(),
            Motion::RigidTap => self.rigid_tap(),
            Motion::Probe { away, must_answer } => self.probe(away, must_answer),
            Motion::Spline { cubic } => self.spline(cubic),
            Motion::Nurbs => self.control_point(),
            Motion::EndOfNurbs => self.along_nurbs(),
            Motion::Arc { clockwise } => {
                let target = self.target(false)?;
                let asked = matches!(self.block.g(Group::Motion), Some(G::Motion(_)));
                let arc_words = b"IJKR".iter().any(|&letter| self.block.has(letter));
                if target.named == 0 && !arc_words && !asked {
                    return Ok(());
                }
                self.feed_for_cut()?;
                let (from, first) =
                    (self.state.place.point(self.state.position), self.actions.len());
                self.arc(target, clockwise)?;
                if self.facts.arcs.counts_radii {
                    self.count_radii(from, first);
                }
                Ok(())
            }
            Motion::Rapid | Motion::Line => {
                let target = self.target(false)?;
                if target.named == 0 {
                    let says = self.block.g(Group::Motion) == Some(G::Motion(Motion::Line));
                    return match says && self.facts.feed.word_needs_feed {
                        true => self.has_feed(),
                        false => Ok(()),
                    };
                }
                if motion == Motion::Line {
                    self.feed_for_cut()?;
                }
                self.straight(target, motion == Motion::Rapid)
            }
        }
    }

    /// The axis words of the block. With `unknown_stays` an increment of 0 from an unknown position
    /// is legal and leaves it unknown.
    ///
    /// # Errors
    /// An increment from an unknown position; an axis that the machine lacks; a rotary axis in a
    /// tilted plane.
    pub(super) fn target(&mut self, unknown_stays: bool) -> Result<Target, Fault> {
        let mut target = Target { point: self.state.position, rotary: self.state.rotary, named: 0 };
        self.in_plane(&mut target, unknown_stays)?;
        self.along(self.state.plane.axes()[2], &mut target, unknown_stays)?;
        target.named |= self.lean()?;
        self.together(target.named)?;
        if self.block.has_any(bit(b'A') | bit(b'B') | bit(b'C')) {
            self.turned(&mut target, unknown_stays)?;
        }
        if let Some(word) = self.state.frames.lost.filter(|_| target.named != 0) {
            let message =
                format!("{word} has moved the zero by what the control held before the program");
            let fault = self.block.whole(Rule::UnknownShift, message);
            return Err(fault.help(format!("write {word} before the first move")).into());
        }
        Ok(target)
    }

    /// The words of the rotary axes.
    fn turned(&mut self, target: &mut Target, unknown_stays: bool) -> Result<(), Fault> {
        for (axis, letter) in b"ABC".iter().copied().enumerate() {
            if !self.block.has(letter) {
                continue;
            }
            if self.stays_at_zero(axis, letter)? {
                continue;
            }
            self.has_axis(axis, letter)?;
            if self.state.tilt != Tilt::None {
                let message =
                    "a rotary axis moved by hand in a tilted plane; G53.1 or G69 moves it";
                return Err(self.block.at_word(letter, Rule::TiltedPlane, message));
            }
            if let Some(value) = self.take_degrees(letter)? {
                target.named |= 1 << (axis + 3);
                let from = target.rotary[axis];
                target.rotary[axis] = self.advance(from, value, letter, unknown_stays)?;
                self.hold_way(axis, from, target.rotary[axis]);
            }
        }
        Ok(())
    }

    /// FANUC turns an axis that rolls over (parameter 1008#0) the shorter way, or by the sign of its word (1008#1), LinuxCNC by
    /// the sign (`WRAPPED_ROTARY`). Away from the part it may turn as it likes.
    fn hold_way(&mut self, axis: usize, from: f64, to: f64) {
        let modulo = match (self.facts.motion.rollover, self.state.rotary_by_sign) {
            (Rollover::BySign, _) | (Rollover::AsSetUp, Some(true)) => Modulo::BySign,
            (Rollover::AsSetUp, Some(false)) => Modulo::Shorter,
            (Rollover::AsSetUp, None) => Modulo::ShorterOrBySign,
            (Rollover::NotFollowed, _) => return,
        };
        let sure = modulo::is_sure(from, to, self.state.modulo[axis], modulo);
        let away = self.state.z_is_home || self.state.position.z.is_nan();
        if !self.state.incremental && !sure && !away {
            self.actions.push(Action::Risk(Risk::ROTARY_WAY.into()));
        }
    }

    /// The words of the two axes of the plane.
    pub(super) fn in_plane(
        &mut self,
        target: &mut Target,
        unknown_stays: bool,
    ) -> Result<(), Fault> {
        let [first, second, _] = self.state.plane.axes();
        if let Some(polar) = self.state.polar {
            self.by_angle(polar, target)?;
        } else if self.block.has(b'@') || self.block.has(b'^') {
            self.about_zero(target)?;
        } else {
            self.along(first, target, unknown_stays)?;
            self.along(second, target, unknown_stays)?;
        }
        Ok(())
    }

    /// The word of a linear axis.
    fn along(
        &mut self,
        axis: usize,
        target: &mut Target,
        unknown_stays: bool,
    ) -> Result<(), Fault> {
        let letter = LINEAR[axis];
        if let Some(value) = self.take_length(letter)? {
            target.named |= 1 << axis;
            target.point[axis] = self.advance(target.point[axis], value, letter, unknown_stays)?;
        }
        Ok(())
    }

    /// After the coordinates have been turned, what one axis means alone depends on the other: makers
    /// ask for absolute words of both. Only increments in turned coordinates are those of the tool
    /// from where it stands (B-64484EN, "Coordinate system rotation").
    pub(super) fn together(&mut self, named: u8) -> Result<(), Fault> {
        if named & self.state.loose == 0 {
            return Ok(());
        }
        let all = named & self.state.loose == self.state.loose;
        if self.state.incremental && self.state.frames.transform.turn.is_some() {
            return Ok(());
        }
        if self.state.incremental || !all {
            let message = "the coordinates have been turned: the first move in the plane names both \
                           its axes in G90";
            return Err(self.block.whole(Rule::Frame, message));
        }
        self.state.loose = 0;
        Ok(())
    }

    /// Polar words: the first axis of the plane is the radius, the second the angle.
    fn by_angle(&mut self, mut polar: Polar, target: &mut Target) -> Result<(), Fault> {
        let [first, second, _] = self.state.plane.axes();
        let radius = self.take_length(LINEAR[first])?;
        let angle = self.take_degrees(LINEAR[second])?;
        if radius.is_none() && angle.is_none() {
            return Ok(());
        }
        if let Some(radius) = radius {
            if self.state.incremental {
                let message =
                    "a polar radius in G91 moves the pole to where the tool stands: write G90";
                return Err(self.block.at_word(LINEAR[first], Rule::Polar, message));
            }
            polar.radius = radius;
        }
        if let Some(angle) = angle {
            let from = if self.state.incremental { polar.angle } else { 0.0 };
            polar.angle = from + angle;
        }
        if polar.radius.is_nan() || polar.angle.is_nan() || polar.pole.is_nan() {
            let message = "polar coordinates, and radius, angle or pole are not known yet";
            return Err(self.block.whole(Rule::Polar, message));
        }
        let (sin, cos) = polar.angle.to_radians().sin_cos();
        target.point[first] = polar.pole[first] + polar.radius * cos;
        target.point[second] = polar.pole[second] + polar.radius * sin;
        target.named |= 1 << first | 1 << second;
        self.state.polar = Some(polar);
        Ok(())
    }

    /// LinuxCNC's `@` and `^`: radius and angle about the zero, of which the one that is not given
    /// stays what it is where the tool stands; in G91 both add to that.
    fn about_zero(&mut self, target: &mut Target) -> Result<(), Fault> {
        let Vec3 { x, y, .. } = target.point;
        let cartesian = b"XY".iter().find(|&&letter| self.block.has(letter));
        if self.state.plane.axes()[2] != 2 || cartesian.is_some() {
            let message = "@ and ^ are for the plane G17, and not in a block with X or Y";
            return Err(self.block.whole(Rule::Polar, message));
        }
        let (mut radius, mut degrees) = (x.hypot(y), y.atan2(x).to_degrees());
        let from = if self.state.incremental { (radius, degrees) } else { (0.0, 0.0) };
        if let Some(length) = self.take_length(b'@')? {
            radius = from.0 + length;
        }
        if let Some(angle) = self.take_degrees(b'^')? {
            degrees = from.1 + angle;
        }
        if radius.is_nan() || degrees.is_nan() {
            let message =
                "radius or angle stay what they are where the tool stands, which is not known";
            return Err(self.block.whole(Rule::UnknownPosition, message));
        }
        if self.state.incremental && from.0 == 0.0 {
            let message = "a polar increment from the zero has no direction";
            return Err(self.block.whole(Rule::Polar, message));
        }
        let (sin, cos) = degrees.to_radians().sin_cos();
        (target.point.x, target.point.y) = (radius * cos, radius * sin);
        target.named |= 3;
        Ok(())
    }

    /// Whether the word leaves a rotary axis at 0 of which the machine is not known; it then counts as used.
    fn stays_at_zero(&mut self, axis: usize, letter: u8) -> Result<bool, Fault> {
        if !self.state.rotary_at_zero || self.axes[axis] || self.state.incremental {
            return Ok(false);
        }
        if self.take_degrees(letter)? != Some(0.0) {
            self.block.again(&[letter]);
            return Ok(false);
        }
        self.actions.push(Action::Risk(Risk::ROTARY_AT_ZERO.into()));
        Ok(true)
    }

    /// # Errors
    /// The machine lacks the rotary axis (0 is A) of this letter.
    pub(super) fn has_axis(&self, axis: usize, letter: u8) -> Result<(), Fault> {
        if self.axes.get(axis).is_some_and(|&exists| exists) {
            return Ok(());
        }
        let message = format!("the machine has no axis {}", char::from(letter));
        Err(self.block.at_word(letter, Rule::UnknownAxis, message))
    }

    /// The coordinate that `value` gives an axis that stands at `from`.
    #[inline]
    pub(super) fn advance(
        &self,
        from: f64,
        value: f64,
        letter: u8,
        unknown_stays: bool,
    ) -> Result<f64, Fault> {
        if !self.state.incremental {
            return Ok(value);
        }
        if from.is_nan() && !(unknown_stays && value == 0.0) {
            return Err(self.nowhere(letter));
        }
        Ok(from + value)
    }

    /// An increment of an axis of which nobody knows where it stands.
    #[cold]
    fn nowhere(&self, letter: u8) -> Fault {
        let message = format!("an increment, and where {} stands is not known", char::from(letter));
        let fault = self.block.at_word(letter, Rule::UnknownPosition, message);
        fault.help("give the position in G90 first").into()
    }

    /// Whether the block may move at feed.
    ///
    /// # Errors
    /// No feed is active, or in `G93` the block has none of its own, or the tool is not in.
    pub(super) fn feed_for_cut(&mut self) -> Result<(), Fault> {
        self.has_feed()?;
        self.state.cut |= self.state.feed.is_some();
        Ok(())
    }

    fn has_feed(&self) -> Result<(), Fault> {
        let message = match self.state.feed {
            // A wire goes as fast as its generator lets it.
            None if self.state.wire.is_some() || !self.state.purpose.asks_technology() => {
                return Ok(());
            }
            None => "a move at feed, and no feed has been given by F",
            Some(Feed::InverseTime(_)) if !self.block.gives(b'F') => {
                "in G93 each move needs its own F"
            }
            Some(_) if self.state.feed_mode == FeedMode::PerTurn && self.spindle_stands() => {
                "a feed per turn while the spindle stands"
            }
            Some(_) if self.state.awaits_tool(self.facts) => {
                let message = "T has named a tool, and no M0 has stopped the program to put it in";
                return Err(self.block.whole(Rule::Tool, message));
            }
            Some(_) => return Ok(()),
        };
        Err(self.block.whole(Rule::Feed, message))
    }

    /// FANUC's F of an arc in `G93` is the feed divided by the radius (B-62764EN, "Inverse time feed"), so the arc from
    /// `from` goes F times into a minute for each radian that it turns. The arc is behind `first` of the actions.
    fn count_radii(&mut self, from: Vec3, first: usize) {
        let Some(Feed::InverseTime(f)) = self.state.feed else { return };
        let arcs = self.actions[first..].iter().enumerate().rev();
        let found = arcs.filter_map(|(i, action)| {
            if let Action::Arc(to) = action { Some((first + i, to)) } else { None }
        });
        let Some((at, to)) = found.take(1).next() else { return };
        let arc = Arc::new(from, to.end.point, to.center, to.normal, to.turns, f64::INFINITY);
        let rate = arc.map_or(f64::NAN, |arc| f / arc.sweep);
        self.actions.insert(at, Action::Feed(Feed::InverseTime(rate)));
        // The next move says its own.
        self.state.feed = None;
    }

    fn spindle_stands(&self) -> bool {
        self.state.spindle == program::Spindle::Off && !self.state.rigid
    }

    /// A straight move to `target`.
    pub(super) fn straight(&mut self, target: Target, rapid: bool) -> Result<(), Fault> {
        if let Tilt::Declared(_) = self.state.tilt {
            let message =
                "a move in a tilted plane before G53.1 has brought the tool upright to it";
            return Err(self.block.whole(Rule::TiltedPlane, message));
        }
        let (from, to) = (self.state.position, target.point);
        let aside = !(to.x.is_finite() && to.y.is_finite());
        if matches!(self.state.tilt, Tilt::Reached(_)) && to.z.is_finite() && aside {
            let message =
                "Z in a tilted plane before X and Y: where the tool goes down is not known";
            return Err(self.block.whole(Rule::UnknownPosition, message));
        }
        if !rapid {
            self.stood();
        }
        // On LinuxCNC with any straight move (`rs274`).
        let [first, second, _] = self.state.plane.axes();
        if from[first] != to[first]
            || from[second] != to[second]
            || self.facts.motion.any_line_compensates
        {
            self.switch_compensation();
        }
        let pose = self.state.pose(to, target.rotary);
        let at_no_height = matches!(self.state.tilt, Tilt::Reached(_)) && to.z.is_nan() && !aside;
        self.actions.push(match rapid {
            true if at_no_height => {
                Action::Across(Box::new(self.state.pose(to.with_z(0.0), target.rotary)))
            }
            true => Action::Rapid(pose),
            false => Action::Line(pose),
        });
        self.state.arrive(target.point, target.rotary);
        Ok(())
    }

    /// Says where the tool stands, where `G92` alone has said so.
    pub(super) fn stood(&mut self) {
        if !self.state.is_reported && self.state.position.is_finite() {
            let here = self.state.pose(self.state.position, self.state.rotary);
            self.actions.push(Action::Rapid(here));
            self.state.is_reported = true;
            self.state.frames.used();
        }
    }

    /// Compensation starts and ends with the next linear move in the plane. In mirrored coordinates
    /// left is right.
    pub(super) fn switch_compensation(&mut self) {
        let compensation = &mut self.state.compensation;
        if compensation.active == compensation.asked {
            return;
        }
        compensation.active = compensation.asked;
        let [first, second, _] = self.state.plane.axes();
        let swaps = self.state.frames.transform.swaps_sides(first, second);
        self.actions.push(Action::Compensation(match compensation.asked {
            Compensation::Left(register) if swaps => Compensation::Right(register),
            Compensation::Right(register) if swaps => Compensation::Left(register),
            side @ (Compensation::Off | Compensation::Left(_) | Compensation::Right(_)) => side,
        }));
    }

    /// Look-ahead, which changes how fast the path is run and not where it is; R says how exactly (B-64484EN,
    /// "Machining condition selecting function").
    fn look_ahead(&mut self, letter: u8, on: u32) -> Result<(), Fault> {
        if !self.block.has_only(&[letter, b'R'], Group::OneShot) {
            let message = "look-ahead goes on and off in a block of its own";
            return Err(self.block.at_group(Group::OneShot, Rule::LookAhead, message));
        }
        self.take_whole(b'R')?;
        match self.take_whole(letter)? {
            Some(number) if number == on || number == 0 => {
                self.state.looks_ahead = number == on;
                Ok(())
            }
            _ => {
                let letter = char::from(letter);
                let message =
                    format!("look-ahead goes on with {letter}{on} and off with {letter}0");
                Err(self.block.at_group(Group::OneShot, Rule::LookAhead, message))
            }
        }
    }

    /// Tells that look-ahead is on at something before which it ends.
    pub(super) fn looks_ahead_no_more(&mut self) {
        if self.state.looks_ahead {
            self.actions.push(Action::Risk(Risk::LOOK_AHEAD.into()));
        }
    }

    /// Whether compensation is about to change with the next linear move.
    pub(super) fn compensation_waits(&self) -> bool {
        self.state.compensation.active != self.state.compensation.asked
    }
}
