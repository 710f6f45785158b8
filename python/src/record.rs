//! One record of a program.

use geom::Vec3;
use program::{
    Beam, Compensation, Coolant, Course, CycleKind, Feed, Op, OutputValue, PathMode, Pose, Spindle,
    Until,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// One thing that happens in a program, and the line of the source that says so.
///
/// Attributes
/// ----------
/// kind : str
///     What it is: ``rapid``, ``line``, ``arc``, ``thread``, ``probe``, ``hole``, ``oriented``, ``joints``,
///     ``machine-move``, ``home``, ``cycle``, ``cycle-off``, ``feed``, ``path-mode``, ``spindle``, ``surface-speed``,
///     ``coolant``, ``beam``, ``pulses``, ``tool``, ``preselect``, ``compensation``, ``frame``, ``work-offset``,
///     ``surface``, ``clamp``, ``output``, ``input``, ``auxiliary``, ``thread-wire``, ``cut-wire``, ``taper``,
///     ``dwell``, ``stop``, ``optional-stop``, ``operation``, ``end-of-operation``, ``comment``, ``message``, ``end``.
/// line : int
///     Line of the source, from 1; of a program from a builder the number of the record.
/// point : tuple of 3 floats, or None
///     Where the tool tip is afterwards, mm; of a hole, the point of the cycle on the surface.
/// axis : tuple of 3 floats, or None
///     Unit vector from the tool tip towards the spindle.
/// words : dict
///     What else the record says, by name: mm, mm/min, s, 1/min, degrees.
#[pyclass(frozen, get_all, module = "toolpost")]
pub struct Record {
    kind: &'static str,
    line: u32,
    point: Option<(f64, f64, f64)>,
    axis: Option<(f64, f64, f64)>,
    words: Py<PyDict>,
}

#[pymethods]
impl Record {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut shown = format!("Record(line={}, {}", self.line, self.kind);
        if let Some((x, y, z)) = self.point {
            shown += &format!(", point=({x}, {y}, {z})");
        }
        if let Some((i, j, k)) = self.axis.filter(|axis| *axis != (0.0, 0.0, 1.0)) {
            shown += &format!(", axis=({i}, {j}, {k})");
        }
        for (name, value) in self.words.bind(py) {
            shown += &format!(", {name}={}", value.repr()?);
        }
        Ok(shown + ")")
    }
}

impl Record {
    /// A record of a program.
    pub fn new(py: Python<'_>, record: &program::Record) -> PyResult<Record> {
        let words = PyDict::new(py);
        say(&record.op, &words)?;
        let pose = pose(&record.op);
        Ok(Record {
            kind: record.op.kind().name(),
            line: record.line,
            point: pose.map(|pose| pose.point().into()),
            axis: pose.map(|pose| pose.axis().into()),
            words: words.unbind(),
        })
    }
}

/// Where the tool is after a motion, or at the latest.
pub fn pose(op: &Op) -> Option<&Pose> {
    match op {
        Op::Probe(probe) => Some(&probe.end),
        op => op.pose(),
    }
}

/// Puts what a record says into `words`.
fn say(op: &Op, words: &Bound<'_, PyDict>) -> PyResult<()> {
    match op {
        Op::Arc(arc) => {
            words.set_item("center", triple(arc.circle.center()))?;
            words.set_item("normal", triple(arc.circle.normal()))?;
            words.set_item("turns", arc.circle.turns())?;
        }
        Op::Thread(thread) => {
            words.set_item("pitch", thread.pitch())?;
        }
        Op::Probe(probe) => {
            words.set_item("away", probe.away)?;
            words.set_item("must_answer", probe.must_answer)?;
        }
        Op::Cycle(cycle) => {
            words.set_item("cycle", cycle_name(cycle.kind))?;
            words.set_item("depth", cycle.depth)?;
            words.set_item("clearance", cycle.clearance)?;
            words.set_item("retract", cycle.retract)?;
            words.set_item("dwell", cycle.dwell)?;
            words.set_item("first_peck", cycle.first_peck)?;
            words.set_item("peck", cycle.peck)?;
            if let CycleKind::Tap { pitch, left } = cycle.kind {
                words.set_item("pitch", pitch)?;
                words.set_item("left", left)?;
            }
            if let Some(withdrawal) = cycle.kind.withdrawal() {
                words.set_item("aside", triple(withdrawal.aside))?;
                words.set_item("angle", withdrawal.angle)?;
            }
            if let Some(feed) = cycle.feed {
                say_feed(feed, words)?;
            }
        }
        Op::Feed(feed) => {
            say_feed(*feed, words)?;
        }
        Op::Spindle(spindle) => {
            let (speed, clockwise) = match *spindle {
                Spindle::Off => (0.0, true),
                Spindle::Clockwise(speed) => (speed, true),
                Spindle::CounterClockwise(speed) => (speed, false),
            };
            words.set_item("speed", speed)?;
            words.set_item("clockwise", clockwise)?;
        }
        Op::SurfaceSpeed(speed) => {
            words.set_item("speed", speed)?;
        }
        Op::Coolant(coolant) => {
            let name = COOLANTS.iter().find(|(_, known)| known == coolant);
            words.set_item("coolant", name.map(|(name, _)| *name))?;
        }
        Op::Tool(tool) => {
            words.set_item("number", tool.number)?;
            words.set_item("name", &tool.name)?;
            words.set_item("diameter", tool.diameter)?;
            words.set_item("corner_radius", tool.corner_radius)?;
            words.set_item("length", tool.length)?;
            words.set_item("offset", tool.offset)?;
        }
        Op::Preselect(number) => {
            words.set_item("number", number)?;
        }
        Op::Compensation(compensation) => {
            let (side, register) = match *compensation {
                Compensation::Off => ("off", None),
                Compensation::Left(register) => ("left", register),
                Compensation::Right(register) => ("right", register),
            };
            words.set_item("side", side)?;
            words.set_item("register", register)?;
        }
        Op::Frame(frame) => {
            words.set_item("origin", triple(frame.translation))?;
            let turned = frame.matrix3;
            let axes = [turned.x_axis, turned.y_axis, turned.z_axis];
            words.set_item("axes", <(_, _, _)>::from(axes.map(triple)))?;
        }
        Op::WorkOffset(offset) => {
            words.set_item("number", offset.number())?;
        }
        Op::Taper(degrees) => {
            words.set_item("degrees", degrees)?;
        }
        Op::Oriented(to) => {
            words.set_item("side", triple(to.end.side()))?;
            words.set_item("external", to.external.clone())?;
            words.set_item(
                "course",
                match to.course {
                    Course::Rapid => "rapid",
                    Course::Line => "line",
                    Course::Arc { .. } => "arc",
                },
            )?;
            if let Course::Arc(circle) = to.course {
                words.set_item("center", triple(circle.center()))?;
                words.set_item("normal", triple(circle.normal()))?;
                words.set_item("turns", circle.turns())?;
            }
            if let Some(configuration) = to.configuration {
                words.set_item("backward", configuration.backward)?;
                words.set_item("elbow_down", configuration.elbow_down)?;
                words.set_item("flipped", configuration.flipped)?;
                words.set_item("joint_turns", configuration.turns)?;
            }
        }
        Op::Joints(joints) => {
            words.set_item("degrees", joints.degrees)?;
            words.set_item("external", joints.external.clone())?;
        }
        Op::MachineMove(to) => {
            let axes = "XYZABC".chars().zip(to.linear.into_iter().chain(to.rotary));
            for (letter, position) in axes {
                words.set_item(letter, position)?;
            }
        }
        Op::Home => words.set_item("axes", "Z")?,
        Op::PathMode(mode) => {
            let (mode, within) = match *mode {
                PathMode::ExactStop => ("exact-stop", None),
                PathMode::ExactPath => ("exact-path", None),
                PathMode::Blend(within) => ("blend", Some(within)),
                PathMode::AsSetUp => ("as-set-up", None),
            };
            words.set_item("mode", mode)?;
            words.set_item("within", within)?;
        }
        Op::Beam(beam) => {
            let (power, with_speed) = match *beam {
                Beam::Off => (0.0, false),
                Beam::On(power) => (power, false),
                Beam::WithSpeed(power) => (power, true),
            };
            words.set_item("power", power)?;
            words.set_item("with_speed", with_speed)?;
        }
        Op::Pulses(count) => words.set_item("count", count)?,
        Op::Clamp(clamp) => {
            words.set_item("axes", clamp.axes.letters())?;
            words.set_item("closed", clamp.closed)?;
        }
        Op::WorkOffsetData(data) => {
            words.set_item("number", data.offset.number())?;
            for (letter, value) in ["x", "y", "z", "a", "b", "c"].into_iter().zip(data.zero) {
                words.set_item(letter, value)?;
            }
        }
        Op::Output(output) => {
            words.set_item("number", output.number)?;
            match output.value {
                OutputValue::Digital(on) => words.set_item("value", on)?,
                OutputValue::Analog(value) => words.set_item("value", value)?,
            }
            words.set_item("with_motion", output.with_motion)?;
        }
        Op::Input(input) => {
            words.set_item("number", input.number)?;
            words.set_item(
                "until",
                match input.until {
                    Until::Read => "read",
                    Until::ReadAnalog => "read-analog",
                    Until::Rise => "rise",
                    Until::Fall => "fall",
                    Until::High => "high",
                    Until::Low => "low",
                },
            )?;
            words.set_item("timeout", input.timeout)?;
        }
        Op::Auxiliary(function) => {
            words.set_item("number", function.number)?;
            words.set_item("values", function.values)?;
        }
        Op::Dwell(seconds) => {
            words.set_item("seconds", seconds)?;
        }
        Op::Operation(name) => {
            words.set_item("name", &**name)?;
        }
        Op::Comment(text) => {
            words.set_item("text", &**text)?;
        }
        Op::Message(text) => {
            words.set_item("text", &**text)?;
        }
        Op::Rapid(_)
        | Op::Line(_)
        | Op::Hole(_)
        | Op::CycleOff
        | Op::Surface(_)
        | Op::ThreadWire
        | Op::CutWire
        | Op::Stop
        | Op::OptionalStop
        | Op::EndOfOperation
        | Op::End => {}
    }
    Ok(())
}

fn triple(v: Vec3) -> (f64, f64, f64) {
    v.into()
}

/// What coolants are called.
pub const COOLANTS: [(&str, Coolant); 5] = [
    ("off", Coolant::Off),
    ("flood", Coolant::Flood),
    ("mist", Coolant::Mist),
    ("flood-and-mist", Coolant::FloodAndMist),
    ("through", Coolant::Through),
];

/// A feed of so many of its units.
pub type FeedOf = fn(f64) -> Feed;

/// In what a feed is counted.
pub const FEED_UNITS: [(&str, FeedOf); 3] =
    [("mm/min", Feed::PerMinute), ("mm/rev", Feed::PerTurn), ("1/min", Feed::InverseTime)];

fn say_feed(feed: Feed, words: &Bound<'_, PyDict>) -> PyResult<()> {
    let (value, unit) = match feed {
        Feed::PerMinute(value) => (value, "mm/min"),
        Feed::PerTurn(value) => (value, "mm/rev"),
        Feed::InverseTime(value) => (value, "1/min"),
    };
    words.set_item("feed", value)?;
    words.set_item("unit", unit)
}

fn cycle_name(kind: CycleKind) -> &'static str {
    match kind {
        CycleKind::Drill => "drill",
        CycleKind::Deep => "deep",
        CycleKind::BreakChip => "break-chip",
        CycleKind::Tap { .. } => "tap",
        CycleKind::Ream => "ream",
        CycleKind::Bore => "bore",
        CycleKind::FineBore(_) => "fine-bore",
        CycleKind::BackBore { .. } => "back-bore",
    }
}
