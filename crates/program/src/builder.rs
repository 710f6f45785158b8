//! Building a program record by record: what people and other programs say of it is checked once, here.

use crate::{
    ArcTo, Auxiliary, Circle, CompensatedPath, Compensation, Coolant, Cycle, CycleKind, Diagnostic,
    Feed, Input, Op, Output, OutputValue, Pose, Program, Rule, Spindle, Tool, Withdrawal,
    WorkOffset,
};
use geom::{Arc, ArcError, Vec3};

/// How far the ends of an arc may differ in their distance from its centre, mm: as in cutter-location
/// data.
const RADIUS_TOLERANCE: f64 = 0.005;

/// The most turns of an arc.
const MOST_TURNS: u32 = 10_000;

/// Builds a [`Program`].
///
/// Points are tool tips in mm, in the work frame. A tool axis holds until another is given; it begins as
/// +Z. Feed, spindle, coolant and compensation hold until they are set anew. A record that is refused
/// changes nothing.
///
/// ```
/// use toolpost_program::{Builder, Feed, Spindle, Tool};
///
/// let mut builder = Builder::new("slot");
/// builder.tool(Tool { number: 1, ..Tool::default() })?;
/// builder.spindle(Spindle::Clockwise(8000.0))?;
/// builder.rapid([0.0, 0.0, 5.0], None)?;
/// builder.feed(Feed::PerMinute(300.0))?;
/// builder.line([0.0, 0.0, -1.0], None)?;
/// assert!(builder.line([f64::NAN, 0.0, 0.0], None).is_err());
/// assert_eq!(builder.build().records.len(), 6);
/// # Ok::<(), Box<toolpost_program::Diagnostic>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Builder {
    program: Program,
    axis: Vec3,
    /// Where the tool is, where that is known.
    tip: Option<Vec3>,
}

use crate::Outcome;

impl Builder {
    /// A program of this name with nothing in it.
    pub fn new(name: impl Into<String>) -> Builder {
        Builder { program: Program::new(name), axis: Vec3::Z, tip: None }
    }

    /// What there is so far, without an end.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The program as it is so far, with its end.
    pub fn build(&self) -> Program {
        let mut built = self.clone();
        built.push(Op::End);
        built.program
    }

    /// Goes to a point by rapid; where an axis is given, the tool turns to it.
    ///
    /// # Errors
    /// `number` for a coordinate that is not finite, `zero-vector` for an axis without a direction.
    pub fn rapid(&mut self, point: [f64; 3], axis: Option<[f64; 3]>) -> Outcome {
        let pose = self.go(point, axis)?;
        self.push(Op::Rapid(pose));
        Ok(())
    }

    /// Cuts straight to a point; where an axis is given, the tool turns to it on the way.
    ///
    /// # Errors
    /// As [`Builder::rapid`].
    pub fn line(&mut self, point: [f64; 3], axis: Option<[f64; 3]>) -> Outcome {
        let pose = self.go(point, axis)?;
        self.push(Op::Line(pose));
        Ok(())
    }

    /// Cuts along an arc or a helix about `center`, counter-clockwise seen against `normal`, with so many
    /// full turns more than the shortest.
    ///
    /// # Errors
    /// `no-start` where the tool is nowhere yet; `off-the-circle` where both ends are not equally far from the
    /// centre (0.005 mm), or there is no radius; and as [`Builder::rapid`].
    pub fn arc(
        &mut self,
        end: [f64; 3],
        center: [f64; 3],
        normal: [f64; 3],
        turns: u32,
    ) -> Outcome {
        let center = point("the centre", center)?;
        let normal = direction("the normal", normal)?;
        let Some(start) = self.tip else {
            let found = Diagnostic::error(Rule::NoStart, "an arc, but from nowhere");
            return Err(found.help("go to its start before").into());
        };
        if turns > MOST_TURNS {
            let message = format!("an arc of {turns} full turns more; {MOST_TURNS} are the most");
            return Err(Diagnostic::error(Rule::Number, message).into());
        }
        let end = point("the end", end)?;
        Arc::new(start, end, center, normal, turns, RADIUS_TOLERANCE)
            .map_err(|error| no_arc(&error))?;
        let pose = Pose::new(end, self.axis)?;
        self.tip = Some(end);
        self.push(Op::Arc(Box::new(ArcTo {
            end: pose,
            circle: Circle::new(center, normal, turns)?,
        })));
        Ok(())
    }

    /// Makes a hole at each of `points`, which lie on the surface.
    ///
    /// # Errors
    /// What [`Cycle::checked`] refuses; and as [`Builder::rapid`].
    pub fn drill(&mut self, cycle: Cycle, points: &[[f64; 3]], axis: Option<[f64; 3]>) -> Outcome {
        let cycle = cycle.checked()?;
        let axis = axis.map_or(Ok(self.axis), |axis| direction("the tool axis", axis))?;
        let poses = points.iter().map(|at| Ok(Pose::new(point("the point", *at)?, axis)?));
        let poses: Vec<Pose> = poses.collect::<Result<_, Box<Diagnostic>>>()?;
        self.axis = axis;
        self.tip = poses.last().map_or(self.tip, |last| Some(last.point() + axis * cycle.retract));
        self.push(Op::Cycle(Box::new(cycle)));
        for pose in poses {
            self.push(Op::Hole(pose));
        }
        self.push(Op::CycleOff);
        Ok(())
    }

    /// Changes to a tool.
    ///
    /// # Errors
    /// `number` for tool 0, or a length that is none.
    pub fn tool(&mut self, tool: Tool) -> Outcome {
        if tool.number == 0 {
            let found = Diagnostic::error(Rule::Number, "tool 0 is no tool");
            return Err(found.help("tools count from 1").into());
        }
        for (what, length) in [("diameter", tool.diameter), ("length", tool.length)] {
            length.map_or(Ok(()), |length| positive(what, length))?;
        }
        tool.corner_radius.map_or(Ok(()), |radius| finite("corner_radius", radius))?;
        self.push(Op::Tool(Box::new(tool)));
        Ok(())
    }

    /// Feed from here on.
    ///
    /// # Errors
    /// `number` for a feed that is not greater than 0.
    pub fn feed(&mut self, feed: Feed) -> Outcome {
        positive("feed", feed.value())?;
        self.push(Op::Feed(feed));
        Ok(())
    }

    /// Spindle from here on.
    ///
    /// # Errors
    /// `number` for a speed that is not greater than 0.
    pub fn spindle(&mut self, spindle: Spindle) -> Outcome {
        if let Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) = spindle {
            positive("speed", speed)?;
        }
        self.push(Op::Spindle(spindle));
        Ok(())
    }

    /// Coolant from here on.
    pub fn coolant(&mut self, coolant: Coolant) {
        self.push(Op::Coolant(coolant));
    }

    /// Cutter radius compensation from here on.
    pub fn compensation(&mut self, side: Compensation) {
        self.push(Op::Compensation(side));
    }

    /// Which path the coordinates are where cutter compensation is on, in the whole program.
    ///
    /// # Errors
    /// `compensated-path` where the other has been said before.
    pub fn compensated_path(&mut self, path: CompensatedPath) -> Outcome {
        if self.program.compensated_path.is_some_and(|known| known != path) {
            let message = "compensation with coordinates of the tool's centre and of the contour in one program";
            let found = Diagnostic::error(Rule::CompensatedPath, message);
            return Err(found.help("build two programs").into());
        }
        self.program.compensated_path = Some(path);
        Ok(())
    }

    /// Work offset from here on. Where the tool is in it is not known.
    pub fn work_offset(&mut self, offset: WorkOffset) {
        self.tip = None;
        self.push(Op::WorkOffset(offset));
    }

    /// The tool leaves the part: Z goes home.
    pub fn home(&mut self) {
        self.tip = None;
        self.push(Op::Home);
    }

    /// Waits, s.
    ///
    /// # Errors
    /// `number` for a time that is not greater than 0.
    pub fn dwell(&mut self, seconds: f64) -> Outcome {
        positive("dwell", seconds)?;
        self.push(Op::Dwell(seconds));
        Ok(())
    }

    /// Stops until the operator goes on; with `optional` only where he has asked for it.
    pub fn stop(&mut self, optional: bool) {
        self.push(if optional { Op::OptionalStop } else { Op::Stop });
    }

    /// Sets an output of the machine.
    ///
    /// # Errors
    /// `number` for an analog value that is not finite.
    pub fn output(&mut self, output: Output) -> Outcome {
        if let OutputValue::Analog(value) = output.value {
            finite("value", value)?;
        }
        self.push(Op::Output(output));
        Ok(())
    }

    /// Waits for an input of the machine.
    ///
    /// # Errors
    /// `number` for a time that is not finite, or below 0.
    pub fn input(&mut self, input: Input) -> Outcome {
        if input.timeout != 0.0 {
            positive("timeout", input.timeout)?;
        }
        self.push(Op::Input(Box::new(input)));
        Ok(())
    }

    /// Calls a function that the builder of the machine has added, by the number of its M function.
    pub fn auxiliary(&mut self, number: u32) {
        self.push(Op::Auxiliary(Auxiliary::of(number)));
    }

    /// An operation begins, of this name.
    pub fn operation(&mut self, name: &str) {
        self.push(Op::Operation(name.into()));
    }

    /// Words for the reader of the program.
    pub fn comment(&mut self, text: &str) {
        self.push(Op::Comment(text.into()));
    }

    /// Words for the operator's screen.
    pub fn message(&mut self, text: &str) {
        self.push(Op::Message(text.into()));
    }

    /// Records count as lines.
    fn push(&mut self, op: Op) {
        let line = u32::try_from(self.program.records.len() + 1).unwrap_or(u32::MAX);
        self.program.push(line, op);
    }

    /// The pose at `at`, with the axis that holds or a new one; the tool is there then.
    fn go(&mut self, at: [f64; 3], axis: Option<[f64; 3]>) -> Result<Pose, Box<Diagnostic>> {
        let at = point("the point", at)?;
        let axis = axis.map_or(Ok(self.axis), |axis| direction("the tool axis", axis))?;
        let pose = Pose::new(at, axis)?;
        (self.axis, self.tip) = (axis, Some(at));
        Ok(pose)
    }
}

impl Cycle {
    /// This cycle, where it is one that a tool can make.
    ///
    /// # Errors
    /// `number` for what is not finite, or not greater than 0 where it has to be; `no-clear-plane` where the tool
    /// would feed from below the bottom, or go back below the clearance; `peck`, `pitch` and `aside` where the
    /// kind needs or takes none.
    pub fn checked(self) -> Result<Cycle, Box<Diagnostic>> {
        let no = |rule, message: &str| Err(Diagnostic::error(rule, message).into());
        if let Some(Withdrawal { aside, angle }) = self.kind.withdrawal() {
            point("aside", aside.to_array())?;
            angle.map_or(Ok(()), |degrees| finite("angle", degrees))?;
            if *aside == Vec3::ZERO {
                return no(Rule::Aside, "`fine-bore` and `back-bore`, and no other, go aside");
            }
        }
        finite("retract", self.retract)?;
        positive("depth", self.depth)?;
        finite("clearance", self.clearance)?;
        self.feed.map_or(Ok(()), |feed| positive("feed", feed.value()))?;
        if self.dwell != 0.0 {
            positive("dwell", self.dwell)?;
        }
        self.first_peck.map_or(Ok(()), |peck| positive("first_peck", peck))?;
        self.peck.map_or(Ok(()), |peck| positive("peck", peck))?;
        if self.clearance <= -self.depth || self.retract < self.clearance {
            return no(
                Rule::NoClearPlane,
                "the tool feeds from `clearance`, above the bottom, and goes back to `retract`, no lower",
            );
        }
        let pecks = matches!(self.kind, CycleKind::Deep | CycleKind::BreakChip);
        if pecks != (self.peck.is_some() || self.first_peck.is_some()) {
            return no(Rule::Peck, "`deep` and `break-chip`, and no other, take a peck");
        }
        if let CycleKind::Tap { pitch, .. } = self.kind {
            positive("pitch", pitch)?;
        }
        Ok(self)
    }
}

fn finite(what: &str, value: f64) -> Outcome {
    match value.is_finite() {
        true => Ok(()),
        false => Err(Diagnostic::error(Rule::Number, format!("{what} is {value}")).into()),
    }
}

fn positive(what: &str, value: f64) -> Outcome {
    finite(what, value)?;
    match value > 0.0 {
        true => Ok(()),
        false => {
            let found = Diagnostic::error(Rule::Number, format!("{what} is {value}"));
            Err(found.help("it must be greater than 0").into())
        }
    }
}

fn point(what: &str, value: [f64; 3]) -> Result<Vec3, Box<Diagnostic>> {
    let [x, y, z] = value;
    match Vec3::from_array(value) {
        point if point.is_finite() => Ok(point),
        _ => Err(Diagnostic::error(Rule::Number, format!("{what} is ({x}, {y}, {z})")).into()),
    }
}

/// A direction of any length, as a unit vector.
fn direction(what: &str, value: [f64; 3]) -> Result<Vec3, Box<Diagnostic>> {
    let [x, y, z] = value;
    geom::direction(Vec3::from_array(value)).ok_or_else(|| {
        let message = format!("{what} is ({x}, {y}, {z}), which has no direction");
        Diagnostic::error(Rule::ZeroVector, message).into()
    })
}

/// As a reader of cutter-location data says it.
fn no_arc(error: &ArcError) -> Box<Diagnostic> {
    let message = match error {
        ArcError::NoAxis => String::from("the normal has no direction"),
        ArcError::NoRadius => String::from("the arc starts on its own axis"),
        ArcError::OffTheCircle(start, end) => {
            format!("the arc starts {start:.4} mm from the centre, but ends {end:.4} mm from it")
        }
    };
    Diagnostic::error(Rule::OffTheCircle, message).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_refused_changes_nothing() {
        let mut builder = Builder::new("t");
        builder.rapid([1.0, 0.0, 0.0], Some([0.0, 3.0, 4.0])).unwrap();
        let before = builder.clone();
        let drill = Cycle {
            kind: CycleKind::Drill,
            depth: 3.0,
            clearance: 1.0,
            retract: 1.0,
            feed: None,
            dwell: 0.0,
            first_peck: None,
            peck: None,
        };
        let wrong: [(&str, Outcome); 9] = [
            ("number", builder.line([0.0, f64::NAN, 0.0], Some([1.0, 0.0, 0.0]))),
            ("zero-vector", builder.line([0.0; 3], Some([0.0; 3]))),
            ("off-the-circle", builder.arc([0.0, 2.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], 0)),
            ("number", builder.arc([0.0, 1.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], 1_000_000)),
            ("number", builder.drill(drill, &[[0.0; 3], [f64::INFINITY; 3]], None)),
            ("no-clear-plane", builder.drill(Cycle { retract: 0.5, ..drill }, &[], None)),
            ("peck", builder.drill(Cycle { peck: Some(1.0), ..drill }, &[], None)),
            ("number", builder.feed(Feed::PerTurn(0.0))),
            ("number", builder.tool(Tool { number: 1, diameter: Some(-1.0), ..Tool::default() })),
        ];
        for (rule, done) in wrong {
            assert_eq!(done.unwrap_err().rule, rule);
        }
        assert_eq!(builder.program(), before.program());
        assert_eq!((builder.axis, builder.tip), (before.axis, before.tip));
    }

    #[test]
    fn an_arc_begins_where_the_last_hole_was_left() {
        let mut builder = Builder::new("t");
        let cycle = Cycle {
            kind: CycleKind::Drill,
            depth: 3.0,
            clearance: 1.0,
            retract: 4.0,
            feed: None,
            dwell: 0.0,
            first_peck: None,
            peck: None,
        };
        builder.drill(cycle, &[[1.0, 0.0, 0.0], [5.0, 0.0, 0.0]], None).unwrap();
        assert!(builder.arc([0.0, 5.0, 4.0], [0.0, 0.0, 4.0], [0.0, 0.0, 1.0], 0).is_ok());
    }
}
