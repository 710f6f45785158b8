//! One record of a program.

use geom::Vec3;
use program::{Compensation, Coolant, CycleKind, Feed, Op, Pose, Spindle};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// One thing that happens in a program, and the line of the source that says so.
///
/// Attributes
/// ----------
/// kind : str
///     What it is: ``rapid``, ``line``, ``arc``, ``thread``, ``probe``, ``hole``, ``cycle``, ``cycle-off``,
///     ``feed``, ``spindle``, ``surface-speed``, ``coolant``, ``tool``, ``preselect``, ``length-offset``, ``compensation``,
///     ``frame``, ``work-offset``, ``thread-wire``, ``cut-wire``, ``taper``, ``home``, ``dwell``, ``stop``,
///     ``optional-stop``, ``operation``, ``end-of-operation``, ``comment``, ``message``, ``end``.
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
        let kind = kind(&record.op, &words)?;
        let pose = pose(&record.op);
        Ok(Record {
            kind,
            line: record.line,
            point: pose.map(|pose| pose.point.into()),
            axis: pose.and_then(Pose::axis).map(Vec3::into),
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

/// What a record is; its words go into `words`.
fn kind(op: &Op, words: &Bound<'_, PyDict>) -> PyResult<&'static str> {
    Ok(match op {
        Op::Rapid(_) => "rapid",
        Op::Line(_) => "line",
        Op::Arc(arc) => {
            words.set_item("center", triple(arc.center))?;
            words.set_item("normal", triple(arc.normal))?;
            words.set_item("turns", arc.turns)?;
            "arc"
        }
        Op::Thread(thread) => {
            words.set_item("pitch", thread.pitch)?;
            "thread"
        }
        Op::Probe(probe) => {
            words.set_item("away", probe.away)?;
            words.set_item("must_answer", probe.must_answer)?;
            "probe"
        }
        Op::Hole(_) => "hole",
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
            "cycle"
        }
        Op::CycleOff => "cycle-off",
        Op::Feed(feed) => {
            say_feed(*feed, words)?;
            "feed"
        }
        Op::Spindle(spindle) => {
            let (speed, clockwise) = match *spindle {
                Spindle::Off => (0.0, true),
                Spindle::Clockwise(speed) => (speed, true),
                Spindle::CounterClockwise(speed) => (speed, false),
            };
            words.set_item("speed", speed)?;
            words.set_item("clockwise", clockwise)?;
            "spindle"
        }
        Op::SurfaceSpeed(speed) => {
            words.set_item("speed", speed)?;
            "surface-speed"
        }
        Op::Coolant(coolant) => {
            let name = COOLANTS.iter().find(|(_, known)| known == coolant);
            words.set_item("coolant", name.map(|(name, _)| *name))?;
            "coolant"
        }
        Op::Tool(tool) => {
            words.set_item("number", tool.number)?;
            words.set_item("name", &tool.name)?;
            words.set_item("diameter", tool.diameter)?;
            words.set_item("corner_radius", tool.corner_radius)?;
            words.set_item("length", tool.length)?;
            words.set_item("offset", tool.offset)?;
            "tool"
        }
        Op::Preselect(number) => {
            words.set_item("number", number)?;
            "preselect"
        }
        Op::LengthOffset(register) => {
            words.set_item("register", register)?;
            "length-offset"
        }
        Op::Compensation(compensation) => {
            let (side, register) = match *compensation {
                Compensation::Off => ("off", None),
                Compensation::Left(register) => ("left", register),
                Compensation::Right(register) => ("right", register),
            };
            words.set_item("side", side)?;
            words.set_item("register", register)?;
            "compensation"
        }
        Op::Frame(frame) => {
            words.set_item("origin", triple(frame.translation))?;
            let turned = frame.matrix3;
            let axes = [turned.x_axis, turned.y_axis, turned.z_axis];
            words.set_item("axes", <(_, _, _)>::from(axes.map(triple)))?;
            "frame"
        }
        Op::WorkOffset(number) => {
            words.set_item("number", number)?;
            "work-offset"
        }
        Op::Surface(_) => "surface",
        Op::ThreadWire => "thread-wire",
        Op::CutWire => "cut-wire",
        Op::Taper(degrees) => {
            words.set_item("degrees", degrees)?;
            "taper"
        }
        Op::Home(axes) => {
            let letters = "XYZABC".chars().enumerate().filter(|(bit, _)| axes >> bit & 1 == 1);
            words.set_item("axes", letters.map(|(_, letter)| letter).collect::<String>())?;
            "home"
        }
        Op::Dwell(seconds) => {
            words.set_item("seconds", seconds)?;
            "dwell"
        }
        Op::Stop => "stop",
        Op::OptionalStop => "optional-stop",
        Op::Operation(name) => {
            words.set_item("name", &**name)?;
            "operation"
        }
        Op::EndOfOperation => "end-of-operation",
        Op::Comment(text) => {
            words.set_item("text", &**text)?;
            "comment"
        }
        Op::Message(text) => {
            words.set_item("text", &**text)?;
            "message"
        }
        Op::End => "end",
    })
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
