//! Where positions are counted from, and how the tool axis is said: the work frame, a tilted plane,
//! tool center point control by angles or vectors, or the positions of the machine's own axes.

use crate::catalogue::{BlockName, WordName};
use crate::motion::hangs_on;
use crate::template::{LENGTH_OFFSET, ORIENTATION, POSITION, place_value};
use crate::tilt::Solution;
use crate::walk::{Outcome, Walk, motion, refuse};
use crate::words::{Words, bit};
use geom::{ANGLE_EPSILON, Euler, Frame, Mat3, Vec3, angle_between};
use machine::plan::{self, Plan, Step, Target, TargetKind};
use machine::{Machine, OrientationMode};
use minijinja::value::Value;
use program::{Diagnostic, Op, Pose, Pulse, Record, Rule};

/// How the control counts at the moment.
#[derive(Clone, Debug)]
pub(crate) enum Kind {
    /// The machine's own coordinates, tool axis not said: nothing is on.
    Bare,
    /// The work frame, tool axis +Z.
    Plain,
    /// A tilted plane: from the work frame into it, and the tool axis in the work frame.
    Tilted(Frame, Vec3),
    /// The tool tip in the work frame, with the rotary positions.
    ToolCenter,
    /// The tool tip in the work frame, the tool axis as a vector.
    Vectors,
    /// Positions of the linear and rotary axes.
    Machine,
}

/// How the control counts, and where the rotary axes stand.
#[derive(Clone, Debug)]
pub(crate) struct CoordinateMode {
    pub(crate) kind: Kind,
    /// Degrees of A, B, C as they are written; `None` where the program does not know them.
    degrees: Option<[f64; 3]>,
    /// The frame of the set-up in the source.
    set_up: Frame,
    /// Rotary positions that the control may take for the tilted plane that is on.
    solutions: Vec<Solution>,
    /// The origin of the tilted plane that has been written last.
    origin: Vec3,
    /// Whether tool-centre control goes on with the next move.
    pub(crate) begins: bool,
    /// How far the table has carried the zero from which positions of the axes count, mm, while the dynamic offset is on.
    carried: Option<Vec3>,
    /// Whether a rotary axis that the block places has to turn.
    pub(crate) turned: bool,
    /// Whether nothing has moved since the control stopped keeping the tip, or since a tilted plane went off.
    pub(crate) just_off: [bool; 2],
}

impl CoordinateMode {
    pub(crate) fn start(machine: &Machine) -> CoordinateMode {
        let fixed = machine.rotary.is_empty();
        let kind = if fixed { Kind::Plain } else { Kind::Bare };
        CoordinateMode {
            kind,
            degrees: None,
            set_up: Frame::IDENTITY,
            solutions: Vec::new(),
            origin: Vec3::ZERO,
            begins: false,
            carried: None,
            turned: false,
            just_off: [false; 2],
        }
    }

    /// The place as templates see it; `home` where Z is home.
    pub(crate) fn value(&self, home: bool) -> Value {
        let tilted = matches!(self.kind, Kind::Tilted(..) | Kind::ToolCenter | Kind::Vectors);
        place_value(home, self.turned, tilted, self.just_off)
    }

    /// How far the zero from which positions of the axes count lies from where it was set up, mm.
    pub(crate) fn carried(&self) -> Vec3 {
        self.carried.unwrap_or(Vec3::ZERO)
    }

    pub(crate) fn degrees(&self) -> Option<[f64; 3]> {
        self.degrees
    }

    /// Whether a rotary axis stands off 0, or nobody knows where it stands.
    fn is_turned(&self) -> bool {
        self.degrees != Some([0.0; 3])
    }

    pub(crate) fn turn_to(&mut self, degrees: [f64; 3]) {
        self.degrees = Some(degrees);
    }

    pub(crate) fn solutions(&self) -> &[Solution] {
        &self.solutions
    }

    pub(crate) fn keep_solutions(&mut self, solutions: Vec<Solution>) {
        self.solutions = solutions;
    }

    pub(crate) fn set_up(&mut self, frame: Frame) {
        self.set_up = frame;
    }
}

/// Part of a program in which the tool axis is written in one way: up to the next operation or tool.
pub(crate) struct Route {
    /// How many records it has.
    pub(crate) records: usize,
    mode: OrientationMode,
    turning: bool,
    plan: Option<Plan>,
}

/// How one pose of a route is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    pub(crate) mode: OrientationMode,
    /// Whether the tool axis turns in cuts of this operation.
    pub(crate) turning: bool,
    /// Whether this is the first pose of the route.
    pub(crate) first: bool,
    /// Where the rotary axes go, as far as the program says it.
    pub(crate) step: Option<Step>,
}

impl Route {
    /// How many of `records` belong to the operation that begins with them.
    pub(crate) fn length(records: &[Record]) -> usize {
        let starts = |r: &Record| matches!(r.op, Op::Tool(_) | Op::Operation(_));
        records.iter().skip(1).position(starts).map_or(records.len(), |i| i + 1)
    }

    /// The operation that begins with `records`, after the pose `here`, with the rotary axes at
    /// `degrees`.
    ///
    /// # Errors
    /// A tool axis that the machine cannot reach; the work was ended.
    pub(crate) fn of(
        machine: &Machine,
        records: &[Record],
        here: Option<Pose>,
        degrees: Option<[f64; 3]>,
        mut waits: Pulse,
    ) -> Result<Route, Box<Diagnostic>> {
        if machine.rotary.is_empty() {
            let (records, mode) = (records.len(), OrientationMode::Fixed);
            return Ok(Route { records, mode, turning: false, plan: None });
        }
        let count = Route::length(records);
        let turning = turns_in_a_cut(&records[..count], here);
        let settings = &machine.orientation;
        let mode = if turning { settings.simultaneous } else { settings.positioned };
        // Where the axes only position, each orientation is a route of its own: an axis that is free
        // in one of them has no reason to turn for the next one there.
        let count = if turning { count } else { one_orientation(&records[..count]) };
        let mut end = None;
        let targets = records[..count].iter().enumerate().map_while(|(i, record)| {
            end = waits.step(i).err();
            end.is_none().then_some(record)
        });
        let targets = targets.filter_map(target);
        let plan = match mode {
            OrientationMode::Fixed | OrientationMode::TiltedPlane => None,
            OrientationMode::ToolCenterAngles
            | OrientationMode::Vectors
            | OrientationMode::DynamicOffset
            | OrientationMode::MachineAngles => Some(plan::plan(machine, degrees, targets)?),
        };
        if let Some(end) = end {
            return Err(end);
        }
        Ok(Route { records: count, mode, turning, plan })
    }

    pub(crate) fn warnings(&self) -> impl Iterator<Item = Diagnostic> {
        self.plan.iter().flat_map(|plan| plan.rewinds.iter().map(|rewind| rewind.warning()))
    }

    /// How its poses are written, in order.
    pub(crate) fn stops(&self) -> impl Iterator<Item = Stop> {
        let mut steps = self.plan.as_ref().map(Plan::iter);
        let Route { mode, turning, .. } = *self;
        let mut first = true;
        std::iter::from_fn(move || {
            let step = match &mut steps {
                Some(steps) => Some(steps.next()?),
                None => None,
            };
            Some(Stop { mode, turning, first: std::mem::take(&mut first), step })
        })
    }
}

fn target(record: &Record) -> Option<Target> {
    let axis = record.op.pose()?.axis();
    let (free, arc) =
        (matches!(record.op, Op::Rapid(_) | Op::Hole(_)), matches!(record.op, Op::Arc(_)));
    let kind = match (free, arc) {
        (true, _) => TargetKind::Rapid,
        (_, true) => TargetKind::Arc,
        _ => TargetKind::Feed,
    };
    Some(Target { axis, line: record.line, kind })
}

/// How many records there are before the tool axis changes.
fn one_orientation(records: &[Record]) -> usize {
    let mut held = None;
    let changes = |record: &Record| {
        let axis = record.op.pose().map(Pose::axis);
        axis.is_some_and(|axis| !same(*held.get_or_insert(axis), axis))
    };
    records.iter().position(changes).unwrap_or(records.len())
}

/// Whether the tool axis changes while the tool cuts.
fn turns_in_a_cut(records: &[Record], here: Option<Pose>) -> bool {
    let mut last = here.map(|pose| pose.axis());
    records.iter().any(|record| {
        let Some(axis) = record.op.pose().map(Pose::axis) else { return false };
        let before = last.replace(axis);
        let cut = matches!(record.op, Op::Line(_) | Op::Arc(_));
        cut && before.is_some_and(|before| !same(before, axis))
    })
}

/// Whether two tool axes are one.
#[inline]
pub(crate) fn same(a: Vec3, b: Vec3) -> bool {
    a.distance_squared(b) < ANGLE_EPSILON * ANGLE_EPSILON
}

impl Walk<'_> {
    /// Brings the control to where `pose` can be written. In a cut nothing may have to change.
    #[inline]
    pub(crate) fn settle(&mut self, pose: &Pose, stop: &Stop, cut: bool) -> Outcome {
        if self.settled(pose, stop, cut)? {
            // The axes go along with the moves of this operation.
            return if stop.turning { self.unclamp() } else { Ok(()) };
        }
        if cut && self.position.is_located() {
            let help = "begin the operation with a rapid move in the new orientation";
            let found = refuse(Rule::OrientationInCut, "the plane of work changes in a cut");
            return Err(found.help(help).into());
        }
        self.turn(pose.axis(), stop)?;
        if cut && self.place.begins {
            let help = "begin the operation with a rapid move";
            let message = "tool-centre control goes on with the first move, and that is a cut";
            return Err(refuse(Rule::OrientationInCut, message).help(help).into());
        }
        Ok(())
    }

    /// Whether `pose` can be written as the control counts, and with the rotary axes as they stand.
    ///
    /// # Errors
    /// A tool axis that a machine without rotary axes does not have, a lean that a wire cannot take.
    #[inline]
    pub(crate) fn settled(
        &self,
        pose: &Pose,
        stop: &Stop,
        cut: bool,
    ) -> Result<bool, Box<Diagnostic>> {
        let axis = pose.axis();
        Ok(match (&self.place.kind, stop.mode) {
            (Kind::Plain, OrientationMode::Fixed) => match &self.wire {
                Some(wire) => self.wire_stands(wire, pose).map(|()| true)?,
                None if same(axis, Vec3::Z) => true,
                None => return Err(unreachable(axis)),
            },
            (Kind::Plain, OrientationMode::TiltedPlane) => same(axis, Vec3::Z),
            (Kind::Tilted(_, tilted), OrientationMode::TiltedPlane) => same(*tilted, axis),
            (Kind::Machine, OrientationMode::DynamicOffset) => {
                self.stands_at(stop) && self.place.carried.is_some() == self.place.is_turned()
            }
            (Kind::ToolCenter, OrientationMode::ToolCenterAngles)
            | (Kind::Vectors, OrientationMode::Vectors)
            | (Kind::Machine, OrientationMode::MachineAngles)
                if self.place.carried.is_none() =>
            {
                // Between cuts that turn the axes go along with the rapid; otherwise they turn alone.
                (stop.turning && (!stop.first || cut)) || self.stands_at(stop)
            }
            _ => false,
        })
    }

    fn stands_at(&self, stop: &Stop) -> bool {
        match (stop.step, self.place.degrees) {
            (Some(step), Some(degrees)) => self.written(step.degrees) == degrees,
            _ => false,
        }
    }

    /// Degrees of A, B, C as their words give them.
    pub(crate) fn written(&self, degrees: [f64; 3]) -> [f64; 3] {
        let mut written = degrees;
        for rotary in &self.machine.rotary {
            let (word, index) = (rotary_word(rotary.index()), rotary.index());
            written[index] = self.writer.rounded(word, degrees[index]);
        }
        written
    }

    /// The tool leaves the part, the rotary axes turn, and the control counts as `stop` says.
    pub(crate) fn turn(&mut self, axis: Vec3, stop: &Stop) -> Outcome {
        let upright = same(axis, Vec3::Z) && stop.mode == OrientationMode::TiltedPlane;
        self.leave_part()?;
        self.leave_place()?;
        self.lose_position();
        if upright || stop.mode != OrientationMode::TiltedPlane {
            self.plane_origin(Vec3::ZERO)?;
        }
        match stop.mode {
            OrientationMode::Fixed => return Err(unreachable(axis)),
            OrientationMode::TiltedPlane if upright => {
                match self.place.degrees == Some(self.upright()) {
                    true => self.clamp()?,
                    false => self.rotate(Some(self.upright()), false)?,
                }
                self.place.kind = Kind::Plain;
            }
            OrientationMode::TiltedPlane => self.tilt(axis)?,
            mode @ (OrientationMode::ToolCenterAngles
            | OrientationMode::Vectors
            | OrientationMode::DynamicOffset
            | OrientationMode::MachineAngles) => {
                self.rotate(stop.step.map(|step| step.degrees), stop.turning)?;
                self.place.kind = match mode == OrientationMode::ToolCenterAngles {
                    true => Kind::ToolCenter,
                    false if mode == OrientationMode::Vectors => Kind::Vectors,
                    false => Kind::Machine,
                };
                if matches!(self.place.kind, Kind::ToolCenter | Kind::Vectors) {
                    self.tool_center_on()?;
                }
                if mode == OrientationMode::DynamicOffset {
                    self.dynamic_offset_on()?;
                }
            }
        }
        Ok(())
    }

    /// Positions are written in full from here on.
    pub(crate) fn lose_position(&mut self) {
        let vector = bit(WordName::VX) | bit(WordName::VY) | bit(WordName::VZ);
        self.writer.forget(POSITION | vector | bit(WordName::Motion));
        self.position.lose();
    }

    /// Away from the part in machine coordinates, before a rotary axis turns. These are positions of
    /// the axes only while the control does not keep the tool tip: SINUMERIK's `SUPA` leaves `TRAORI`
    /// on, and HEIDENHAIN wants `M129` before `M91`.
    pub(crate) fn leave_part(&mut self) -> Outcome {
        let keeps_tip = matches!(self.place.kind, Kind::ToolCenter | Kind::Vectors);
        if self.position.is_located() || keeps_tip {
            self.uncompensated("a new orientation")?;
            self.look_ahead(false)?;
            self.go_out()?;
            self.tool_center_off()?;
            self.plane_xy()?;
            self.required(BlockName::Retract)?;
            // Some retracts end the length: `D0`, `G28` of Haas, `G49`.
            self.writer.forget(LENGTH_OFFSET);
            self.lose_position();
        }
        Ok(())
    }

    /// Tool-centre control goes on: at once, or with the first move, where its block says the position.
    fn tool_center_on(&mut self) -> Outcome {
        self.writer.forget(LENGTH_OFFSET);
        self.place.begins = self.templates.places(BlockName::ToolCenterOn, WordName::Z);
        if self.place.begins {
            return Ok(());
        }
        self.say_length_offset();
        self.required(BlockName::ToolCenterOn)
    }

    /// The table carries the zero along, as it stands; at 0 it has carried it nowhere.
    fn dynamic_offset_on(&mut self) -> Outcome {
        if !self.place.is_turned() {
            return Ok(());
        }
        let degrees = self.place.degrees.unwrap_or_default();
        if let Some(unsaid) = self.machine.unsaid(degrees, self.tool_length()) {
            return Err(hangs_on(unsaid));
        }
        self.required(BlockName::DynamicOffsetOn)?;
        self.place.carried = Some(self.machine.carried_zero(degrees));
        Ok(())
    }

    fn tool_center_off(&mut self) -> Outcome {
        if matches!(self.place.kind, Kind::ToolCenter | Kind::Vectors) {
            self.required(BlockName::ToolCenterOff)?;
            self.place.just_off[0] = true;
            if matches!(self.place.kind, Kind::Vectors) {
                // Where the rotary axes stand now, the control has chosen.
                self.writer.forget(ORIENTATION);
            }
            self.place.kind = Kind::Bare;
            self.writer.forget(LENGTH_OFFSET);
            self.lose_position();
        }
        Ok(())
    }

    /// Whatever is on goes off, on the way to home.
    pub(crate) fn leave_place(&mut self) -> Outcome {
        self.go_out()?;
        match self.place.kind {
            Kind::Bare => {}
            Kind::Machine if self.place.carried.is_some() => {
                self.leave_part()?;
                self.required(BlockName::DynamicOffsetOff)?;
                self.place.carried = None;
                self.place.kind = Kind::Bare;
                self.lose_position();
            }
            Kind::Plain | Kind::Machine => {
                if !self.machine.rotary.is_empty() {
                    self.place.kind = Kind::Bare;
                }
            }
            Kind::Tilted(..) => {
                self.leave_part()?;
                self.plane_tilt_off()?;
                self.lose_position();
            }
            Kind::ToolCenter | Kind::Vectors => self.leave_part()?,
        }
        Ok(())
    }

    /// The rotary axes to these positions, while the tool is clear of the part.
    /// They are clamped there, unless they turn in the cuts that follow.
    pub(crate) fn rotate(&mut self, degrees: Option<[f64; 3]>, turning: bool) -> Outcome {
        let Some(degrees) = degrees else { return Ok(()) };
        self.say_degrees(degrees);
        let turns = self.writer.changes(ORIENTATION);
        self.writer.unset(Words::ALL);
        if turns || turning {
            self.unclamp()?;
        }
        self.say_degrees(degrees);
        self.place.degrees = Some(self.written(degrees));
        self.writer.code(WordName::Motion, motion::RAPID);
        match turns {
            true => self.required(BlockName::Rotate)?,
            false => self.writer.unset(Words::ALL),
        }
        if turning { Ok(()) } else { self.clamp() }
    }

    /// The clamps close, where they may be open: the axes stand in the cuts that follow.
    fn clamp(&mut self) -> Outcome {
        if self.machine.has_clamps() && self.sent.clamp(true) {
            self.required(BlockName::Clamp)?;
        }
        Ok(())
    }

    /// The clamps open, where they may be closed.
    pub(crate) fn unclamp(&mut self) -> Outcome {
        if self.machine.has_clamps() && self.sent.clamp(false) {
            self.required(BlockName::Unclamp)?;
        }
        Ok(())
    }

    pub(crate) fn say_degrees(&mut self, degrees: [f64; 3]) {
        for rotary in &self.machine.rotary {
            self.writer.set(rotary_word(rotary.index()), degrees[rotary.index()]);
        }
    }

    /// The clamps close where the program has opened them.
    pub(crate) fn clamp_again(&mut self) -> Outcome {
        if self.sent.clamps_are_open() { self.clamp() } else { Ok(()) }
    }

    /// The tilted plane goes off. The rotary axes stay, unless the block itself turns them to 0.
    fn plane_tilt_off(&mut self) -> Outcome {
        let turns =
            self.machine.rotary.iter().any(|axis| {
                self.templates.places(BlockName::PlaneTiltOff, rotary_word(axis.index()))
            });
        if turns {
            self.unclamp()?;
            self.writer.forget(ORIENTATION);
            self.say_degrees([0.0; 3]);
            self.writer.code(WordName::Motion, motion::RAPID);
        }
        self.required(BlockName::PlaneTiltOff)?;
        self.place.just_off[1] = true;
        self.place.kind = Kind::Bare;
        if turns {
            self.place.degrees = Some([0.0; 3]);
        }
        Ok(())
    }

    /// Writes another origin of the tilted plane, where the control has a block of its own for that.
    pub(crate) fn plane_origin(&mut self, origin: Vec3) -> Outcome {
        if !self.templates.has(BlockName::PlaneOrigin) {
            return Ok(());
        }
        let words = [WordName::OX, WordName::OY, WordName::OZ];
        let mut written = origin;
        for (i, word) in words.into_iter().enumerate() {
            written[i] = self.writer.rounded(word, origin[i]);
            self.writer.set(word, origin[i]);
        }
        if written == self.place.origin {
            self.writer.unset(Words::ALL);
            return Ok(());
        }
        self.place.origin = written;
        self.block(BlockName::PlaneOrigin)
    }

    /// A tilted plane whose Z is `axis`: that of the set-up where it fits, else the one that turns
    /// about X and Y only.
    fn tilt(&mut self, axis: Vec3) -> Outcome {
        self.unclamp()?;
        let set_up = self.place.set_up;
        let (matrix, origin) = if angle_between(set_up.matrix3.z_axis, axis) < ANGLE_EPSILON {
            (set_up.matrix3, set_up.translation)
        } else {
            (leaning(axis), Vec3::ZERO)
        };
        self.plane_origin(origin)?;
        self.say_length_offset();
        let origin_words = [WordName::OX, WordName::OY, WordName::OZ];
        let mut written = origin;
        for (i, word) in origin_words.into_iter().enumerate() {
            written[i] = self.writer.rounded(word, origin[i]);
            self.writer.set(word, origin[i]);
        }
        // Positions are counted from the frame that is written, so that its rounding moves no point.
        let mut frame = Frame::from_mat3_translation(matrix, written);
        for (notation, words) in NOTATIONS {
            let degrees = notation.angles(&matrix).map(f64::to_degrees);
            for (word, degrees) in words.into_iter().zip(degrees) {
                self.writer.set(word, degrees);
            }
            if self.templates.places(BlockName::PlaneTilt, words[0]) {
                let rounded = [0, 1, 2].map(|i| self.writer.rounded(words[i], degrees[i]));
                frame.matrix3 = notation.matrix(rounded.map(f64::to_radians));
            }
        }
        self.choose_solution(axis)?;
        self.required(BlockName::PlaneTilt)?;
        self.place.kind = Kind::Tilted(frame.inverse(), axis);
        self.place.degrees = None;
        self.writer.forget(ORIENTATION | bit(WordName::Motion));
        self.clamp()
    }
}

fn unreachable(axis: Vec3) -> Box<Diagnostic> {
    let message = format!(
        "the machine cannot bring the tool axis to ({:.6}, {:.6}, {:.6}), {:.3}° from Z of the part",
        axis.x,
        axis.y,
        axis.z,
        axis.angle_between(Vec3::Z).to_degrees()
    );
    refuse(Rule::UnreachableOrientation, message)
}

/// The word of the rotary axis with that place in the order A, B, C.
pub(crate) fn rotary_word(index: usize) -> WordName {
    [WordName::A, WordName::B, WordName::C][index.min(2)]
}

/// The frame whose Z is `axis`, turned about X and then about the new Y, and not about Z.
fn leaning(axis: Vec3) -> Mat3 {
    let about_y = axis.x.clamp(-1.0, 1.0).asin();
    let about_x = if axis.y.hypot(axis.z) < 1e-12 { 0.0 } else { (-axis.y).atan2(axis.z) };
    Mat3::from_rotation_x(about_x) * Mat3::from_rotation_y(about_y)
}

/// The notations for the rotation of a tilted plane, and the words that say them: those of `CYCLE800`
/// with mode 57, of `PLANE SPATIAL`, and of `G68.2`.
const NOTATIONS: [(Euler, [WordName; 3]); 3] = [
    (Euler::MovingXyz, [WordName::RX, WordName::RY, WordName::RZ]),
    (Euler::FixedXyz, [WordName::SpatialA, WordName::SpatialB, WordName::SpatialC]),
    (Euler::MovingZxz, [WordName::Euler1, WordName::Euler2, WordName::Euler3]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_leaning_frame_has_its_z_along_the_axis(
            x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64,
        ) {
            if let Some(axis) = geom::direction(Vec3::new(x, y, z)) {
                prop_assert!(leaning(axis).z_axis.distance(axis) < 1e-9);
            }
        }
    }
}
