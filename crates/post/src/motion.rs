//! Straight cuts, and the words of any straight move: where it goes, and whether the axes may go there.

use crate::catalogue::{BlockName, WordName};
use crate::coordinate_mode::{Kind, Stop, same};
use crate::template::{ORIENTATION, POSITION};
use crate::vectors::{self, Followed};
use crate::walk::{AxisPositions, Cut, Outcome, Walk, motion, refuse};
use crate::words::Words;
use geom::{ANGLE_EPSILON, Vec3};
use machine::Unsaid;
use machine::linearise::RotaryPose;
use machine::plan::{NEAR, Step};
use program::{Diagnostic, Pose, Rule};

/// How far beyond everything the source touches the tool is drawn back before it turns, mm.
const CLEAR: f64 = 5.0;

/// How far the tool axis may leave its way in a cut, degrees.
const SWING: f64 = 1.0;

impl Walk<'_> {
    /// A straight cut of the source.
    pub(crate) fn line(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        self.not_from_probe("a cut")?;
        self.end_cycle()?;
        self.before_cut()?;
        self.settle(pose, stop, true)?;
        self.look_ahead_in_cuts()?;
        if !self.position.is_located() {
            let message =
                "the first move of the tool is a cut: it starts from wherever the tool is";
            self.findings.warn(Diagnostic::warning(Rule::FeedApproach, message).line(self.line));
            self.position.locate();
        }
        self.position.begin_cut(self.position.distance(pose.point()));
        if let Some(degrees) = stop.step.and_then(|step| step.rewind) {
            self.rewind(degrees, stop)?;
        }
        if let Some(near) = self.vector_past_pole(pose.axis()) {
            let message = format!(
                "the tool goes past the pole of the rotary axes at {near:.3}° in this cut: along a vector the control leads it \
                 through the pole there, or stops"
            );
            let help = "tool axes in the source that go round the pole by more than 2° or through it, or positions of the rotary axes \
                        in place of vectors (`simultaneous = \"tool-center-angles\"` in [orientation] of the machine file)";
            return Err(refuse(Rule::PoleWay, message).help(help).into());
        }
        if self.vector_strays(pose.axis())
            && let Some(here) = self.position.pose()
        {
            let degrees = self.vector_start(here.axis(), pose.axis())?;
            let message = "the travel of the rotary axes ends in this cut: the tool is drawn back, turned and brought in again";
            self.findings.warn(Diagnostic::warning(Rule::Rewind, message).line(self.line));
            self.rewind(degrees, stop)?;
        }
        self.line_to(pose, stop)
    }

    /// Where the rotary axes come while the control turns the tool along a vector to `axis`, where it does and that is known.
    fn vector_ends(&self, axis: Vec3) -> Option<[f64; 3]> {
        let from = self.place.degrees().filter(|_| matches!(self.place.kind, Kind::Vectors))?;
        // It is asked for before a block is aimed, and by the block.
        let known = self.followed.get().filter(|way| way.from == from && way.to == axis);
        let followed = known.unwrap_or_else(|| {
            let arrival = vectors::arrival(&self.inverse, from, axis);
            Followed { from, to: axis, arrival }
        });
        self.followed.set(Some(followed));
        followed.arrival
    }

    /// Whether a rotary axis would leave its travel while the control turns the tool along a vector to `axis`.
    pub(crate) fn vector_strays(&self, axis: Vec3) -> bool {
        matches!(self.place.kind, Kind::Vectors)
            && self.place.degrees().is_some()
            && self.vector_ends(axis).is_none()
    }

    /// How far from the pole, degrees, the tool would go past it along a vector to `axis`, where the control does not follow.
    pub(crate) fn vector_past_pole(&self, axis: Vec3) -> Option<f64> {
        let here = self.position.pose().filter(|_| matches!(self.place.kind, Kind::Vectors))?;
        vectors::passes_pole(&self.inverse, here.axis(), axis)
    }

    /// Where the rotary axes have to stand along `from`, so that each stays within its travel on the way to `to`.
    fn vector_start(&self, from: Vec3, to: Vec3) -> Result<[f64; 3], Box<Diagnostic>> {
        let machine = self.machine;
        let off = |start: [f64; 3]| {
            let end = vectors::arrival(&self.inverse, start, to)?;
            Some((start, vectors::off_center(machine, start) + vectors::off_center(machine, end)))
        };
        let starts = vectors::starts(&self.inverse, from).into_iter().filter_map(off);
        let best = starts.min_by(|a, b| a.1.total_cmp(&b.1));
        best.map(|(start, _)| start).ok_or_else(|| {
            let message =
                "along the vector of this cut a rotary axis leaves its travel, wherever it starts";
            let help = "make the steps of the tool axis smaller, or turn the part on the table";
            Box::new(Diagnostic::error(Rule::AxisLimit, message).help(help))
        })
    }

    /// Whether the tool points in `pose` as it does here.
    #[inline]
    pub(crate) fn keeps_orientation(&self, pose: &Pose) -> bool {
        self.position.pose().is_some_and(|here| here.axis() == pose.axis())
    }

    /// A straight cut of the source that goes on from another one: `cut`, where nothing that it asks for can have
    /// changed.
    #[inline]
    pub(crate) fn line_on(&mut self, pose: &Pose) -> Outcome {
        self.position.go_to(*pose);
        self.writer.repeat();
        self.writer.code(WordName::Motion, motion::LINEAR);
        self.aim_to(pose.point());
        if self.writer.changes(POSITION) {
            self.check_limits()?;
            self.block(BlockName::Linear)?;
            self.follow(false)?;
        } else {
            self.writer.unset(Words::ALL);
        }
        self.goes_on = true;
        Ok(())
    }

    /// The travel of a rotary axis ends in a cut: out along the tool axis, beyond every point of the
    /// source, to where the machine may turn, and in again at the same point.
    fn rewind(&mut self, degrees: [f64; 3], stop: &Stop) -> Outcome {
        let Some(here) = self.position.pose() else { return Ok(()) };
        let axis = here.axis();
        let way = self.reach(axis) - here.point().dot(axis) + CLEAR;
        let out = here.at(here.point() + axis * way)?;
        let at = |degrees| Stop { step: Some(Step { degrees, rewind: None }), ..*stop };
        if let Some(held) = self.place.degrees() {
            self.rapid_at_once(&out, &at(held))?;
        }
        self.turn(axis, &at(degrees))?;
        self.approach(&out, &at(degrees))?;
        self.line_to(&here, &at(degrees))
    }

    /// A straight cut in the orientation at hand.
    pub(crate) fn line_to(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        let from = self.position.go_to(*pose);
        let length = from.map_or(0.0, |from| from.point().distance(pose.point()));
        self.switch_plane(pose.axis())?;
        if let (Kind::ToolCenter | Kind::Machine, Some(from), Some(step), Some(degrees)) =
            (&self.place.kind, from, stop.step, self.place.degrees())
        {
            self.keeps_to_its_way([degrees, step.degrees], [from.axis(), pose.axis()])?;
        }
        if let (Kind::Machine, Some(from), Some(step), Some(degrees)) =
            (&self.place.kind, from, stop.step, self.place.degrees())
        {
            let to = RotaryPose { tip: pose.point(), degrees: self.written(step.degrees) };
            if to.degrees != degrees {
                return self.turning_line(RotaryPose { tip: from.point(), degrees }, to, length);
            }
        }
        let pieces = match from.and_then(|from| self.half_way(&from, pose, stop)) {
            Some(half) => {
                self.aim_at(half.tip, self.machine.axis_at(half.degrees), Some(half.degrees));
                self.cut(length / 2.0, 2, Cut::Straight)?;
                2
            }
            None => 1,
        };
        self.aim(pose, stop);
        self.cut(length / pieces as f64, pieces, Cut::Straight)
    }

    /// Holds the tool axis on its way in a cut that could not be split finely enough.
    fn keeps_to_its_way(&self, degrees: [[f64; 3]; 2], axes: [Vec3; 2]) -> Outcome {
        let turn: f64 = (0..3).map(|i| (degrees[1][i] - degrees[0][i]).abs()).sum();
        if turn <= NEAR {
            return Ok(());
        }
        let swing = self.machine.swing(degrees, axes).to_degrees();
        if swing <= SWING {
            return Ok(());
        }
        let message = format!(
            "the rotary axes swing the tool axis {swing:.2}° off its way in this cut, {SWING}° are allowed"
        );
        let help = "make the steps of the tool axis smaller in the source";
        Err(refuse(Rule::AxisSwing, message).help(help).into())
    }

    /// The place half way of a cut in which an axis that may be counted modulo 360° turns by half a turn: which way it
    /// would go in one block nobody knows.
    fn half_way(&self, from: &Pose, to: &Pose, stop: &Stop) -> Option<RotaryPose> {
        let (Kind::ToolCenter, Some(step)) = (&self.place.kind, stop.step) else { return None };
        let (here, there) = (self.place.degrees()?, self.written(step.degrees));
        let step = self.rotary_resolution;
        let halves = self.machine.rotary.iter().any(|axis| {
            let i = axis.index();
            axis.modulo != Some(false) && ((there[i] - here[i]).abs() - 180.0).abs() < step
        });
        let degrees = [0, 1, 2].map(|i| (here[i] + there[i]) / 2.0);
        halves.then(|| RotaryPose { tip: from.point().lerp(to.point(), 0.5), degrees })
    }

    /// A straight cut while rotary axes turn that the control moves on their own: with as many points
    /// between as keep the tool tip on the line.
    fn turning_line(&mut self, from: RotaryPose, to: RotaryPose, length: f64) -> Outcome {
        let tolerance = self.machine.orientation.tolerance;
        let poses = self.machine.linearise(from, to, self.tool_length(), tolerance)?;
        let count = poses.len();
        let (length_of_tool, start) = (self.tool_length().unwrap_or(0.0), from.degrees);
        let start = self.machine.linear_for(from.tip, start, length_of_tool);
        let mut here = AxisPositions { linear: self.rounded(start), degrees: from.degrees };
        // The way of the tip for which no block was written: its axes have not changed by a step.
        let mut owed = 0.0;
        for pose in poses {
            self.aim_at(pose.tip, Vec3::Z, Some(pose.degrees));
            let degrees = self.place.degrees().unwrap_or(pose.degrees);
            let there = AxisPositions { linear: self.rounded(self.position.said()), degrees };
            let way = here.to(&there);
            let length = length / count as f64 + owed;
            owed = if way == AxisPositions::default() { length } else { 0.0 };
            self.cut(length, count, Cut::Turning(way))?;
            here = there;
        }
        if count > 1 {
            self.findings.lowered(Rule::Linearised, "moves with turning axes", self.line, count);
        }
        Ok(())
    }

    /// Positions of the linear axes, as their words give them.
    fn rounded(&self, at: Vec3) -> Vec3 {
        let rounded = |word, value| self.writer.rounded(word, value);
        Vec3::new(
            rounded(WordName::X, at.x),
            rounded(WordName::Y, at.y),
            rounded(WordName::Z, at.z),
        )
    }

    /// Writes the straight cut that has been aimed, `length` mm long, one of so many pieces of the source's.
    #[inline]
    fn cut(&mut self, length: f64, pieces: usize, cut: Cut) -> Outcome {
        self.goes_on = false;
        if !self.writer.changes(POSITION | ORIENTATION) {
            self.writer.unset(Words::ALL);
            return Ok(());
        }
        let goes_on = self.can_go_on();
        self.check_limits()?;
        self.say_feed(length, pieces, cut)?;
        self.compensate()?;
        if self.wire.is_some() {
            self.say_taper();
        }
        self.writer.code(WordName::Motion, motion::LINEAR);
        self.writer.keep();
        self.block(self.straight(BlockName::Linear))?;
        self.follow(false)?;
        self.goes_on = goes_on;
        Ok(())
    }

    /// Whether a straight cut in the orientation at hand may be followed by one that differs from it in where
    /// it goes alone: neither its feed nor anything else depends on its way. Cuts in pieces, and those in which axes turn, are
    /// of the other kinds of coordinates.
    #[inline]
    fn can_go_on(&self) -> bool {
        matches!(self.place.kind, Kind::Plain | Kind::Tilted(..))
            && self.wire.is_none()
            && self.wanted.repeats_straight_cuts(self.sent.compensation())
    }

    /// The block for a straight move in the orientation at hand.
    #[inline]
    pub(crate) fn straight(&self, name: BlockName) -> BlockName {
        let vector = match name == BlockName::Rapid {
            true => BlockName::RapidVector,
            false => BlockName::LinearVector,
        };
        let by_vector = matches!(self.place.kind, Kind::Vectors) && self.templates.has(vector);
        if by_vector { vector } else { name }
    }

    /// Says in the next block where the tool goes.
    #[inline]
    pub(crate) fn aim(&mut self, pose: &Pose, stop: &Stop) {
        let degrees = stop.step.map(|step| step.degrees);
        self.aim_at(pose.point(), pose.axis(), degrees);
    }

    #[inline]
    pub(crate) fn aim_at(&mut self, point: Vec3, axis: Vec3, degrees: Option<[f64; 3]>) {
        if let Some(degrees) = degrees {
            if matches!(self.place.kind, Kind::ToolCenter | Kind::Machine) {
                self.say_degrees(degrees);
            }
            // Along a vector the axes stand where the control has brought them, whatever was planned.
            let stands = self.vector_ends(axis).unwrap_or(degrees);
            self.place.turn_to(self.written(stands));
        }
        if matches!(self.place.kind, Kind::Vectors) {
            self.writer.set(WordName::VX, axis.x);
            self.writer.set(WordName::VY, axis.y);
            self.writer.set(WordName::VZ, axis.z);
        }
        if self.wire.is_some() {
            self.say_lean(axis);
        }
        if !matches!(self.place.kind, Kind::ToolCenter | Kind::Vectors) {
            self.say_length_offset();
        }
        self.aim_to(point);
        self.say_surface(point);
    }

    /// Says in the next block where the tool tip goes.
    #[inline]
    fn aim_to(&mut self, point: Vec3) {
        let said = self.local(point);
        self.position.aim(point, said);
        self.writer.set(WordName::X, said.x);
        self.writer.set(WordName::Y, said.y);
        self.writer.set(WordName::Z, said.z);
    }

    /// A point of the work frame as blocks give it at the moment.
    #[inline]
    pub(crate) fn local(&self, point: Vec3) -> Vec3 {
        match &self.place.kind {
            Kind::Bare | Kind::Plain | Kind::ToolCenter | Kind::Vectors => point,
            Kind::Tilted(into, _) => into.transform_point3(point),
            Kind::Machine => {
                let degrees = self.place.degrees().unwrap_or_default();
                let length = self.tool_length().unwrap_or(0.0);
                self.machine.linear_for(point, degrees, length) - self.place.carried()
            }
        }
    }

    /// Whether a tool along `axis` stands along Z of the coordinates that blocks have.
    pub(crate) fn is_along_z(&self, axis: Vec3) -> bool {
        match &self.place.kind {
            Kind::Bare | Kind::Plain | Kind::Tilted(..) => true,
            Kind::ToolCenter | Kind::Vectors => same(axis, Vec3::Z),
            Kind::Machine => {
                let up = self.local(axis) - self.local(Vec3::ZERO);
                up.distance(Vec3::Z) < 10.0 * ANGLE_EPSILON
            }
        }
    }

    /// Checks the position that has been aimed against the limits of the axes.
    #[inline]
    pub(crate) fn check_limits(&mut self) -> Outcome {
        let degrees = self.place.degrees().unwrap_or_default();
        let length = self.tool_length();
        let linear = match self.place.kind {
            Kind::Tilted(..) => return self.check_in_plane(self.position.tip()),
            Kind::Bare | Kind::Plain => self.position.said(),
            Kind::Machine => match self.machine.unsaid(degrees, length) {
                Some(unsaid) => return Err(hangs_on(unsaid)),
                None => self.position.said() + self.place.carried(),
            },
            // The control knows what its file does not say; the proof reports what was not checked.
            Kind::ToolCenter | Kind::Vectors => {
                if let Some(from) = self.position.check(degrees) {
                    self.check_way(from, degrees)?;
                }
                match self.machine.unsaid(degrees, length) {
                    Some(_) => Vec3::NAN,
                    None => {
                        self.machine.linear_for(self.position.tip(), degrees, length.unwrap_or(0.0))
                    }
                }
            }
        };
        for &sway in self.sways(self.position.tip()) {
            self.limits.position(linear + Vec3::Z * sway, degrees, length, self.line)?;
        }
        Ok(())
    }

    /// Says the tool length offset in the next block.
    pub(crate) fn say_length_offset(&mut self) {
        if let Some(register) = self.sent.length_register() {
            self.writer.code(WordName::Length, 0);
            self.writer.set(WordName::H, register);
        }
    }

    /// Length of the tool, mm, where the source says it.
    pub(crate) fn tool_length(&self) -> Option<f64> {
        self.wanted.tool().and_then(|tool| tool.length)
    }
}

/// The positions of the axes depend on what nobody has stated.
#[cold]
pub(crate) fn hangs_on(unsaid: Unsaid) -> Box<Diagnostic> {
    let message = format!("{unsaid} is not stated: the positions of all axes depend on it");
    refuse(unsaid.rule(), message).help(unsaid.way_out()).into()
}
