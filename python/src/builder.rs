//! Building a program record by record.

use crate::arguments::{direction, number, point, positive, word};
use crate::error::refused;
use crate::program::Program;
use crate::record::{COOLANTS, FEED_UNITS};
use geom::{Arc, ArcError, Vec3};
use program::{
    ArcTo, Compensation, Cycle, CycleKind, Diagnostic, Feed, Op, Pose, Spindle, Tool, Withdrawal,
};
use pyo3::prelude::*;
use toolpost::toolpath::Toolpath;

/// How far the ends of an arc may differ in their distance from its centre, mm: as in cutter-location
/// data.
const RADIUS_TOLERANCE: f64 = 0.005;

/// The most turns of an arc.
const MOST_TURNS: u32 = 10_000;

/// Builds a :class:`Program`; every method but :meth:`build` answers the builder, for a chain of calls.
///
/// Points are tool tips in mm, in the work frame. A tool axis holds until another is given; it begins as
/// +Z. Feed, spindle, coolant and compensation hold until they are set anew.
///
/// Every method raises :class:`toolpost.Error` for what no program can say: ``number`` (not finite, or not
/// greater than 0 where it has to be), ``zero-vector``, ``argument``.
#[pyclass(module = "toolpost")]
pub struct Builder {
    program: program::Program,
    axis: Vec3,
    /// Where the tool is, where that is known.
    tip: Option<Vec3>,
}

/// The builder again.
type Built<'py> = PyResult<PyRefMut<'py, Builder>>;

impl Builder {
    /// A program of this name with nothing in it.
    pub fn new(name: &str) -> Builder {
        Builder { program: program::Program::new(name), axis: Vec3::Z, tip: None }
    }

    /// Records count as lines.
    fn push(&mut self, op: Op) {
        let line = u32::try_from(self.program.records.len() + 1).unwrap_or(u32::MAX);
        self.program.push(line, op);
    }

    /// A pose at `at`, with the axis that holds or a new one.
    fn pose(&mut self, py: Python<'_>, at: [f64; 3], axis: Option<[f64; 3]>) -> PyResult<Pose> {
        let at = point(py, "the point", at)?;
        if let Some(axis) = axis {
            self.axis = direction(py, "the tool axis", axis)?;
        }
        self.tip = Some(at);
        Ok(Pose::new(at, self.axis))
    }
}

#[pymethods]
impl Builder {
    /// Go to a point by rapid.
    #[pyo3(signature = (point, axis = None))]
    fn rapid<'py>(
        mut slf: PyRefMut<'py, Self>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
    ) -> Built<'py> {
        let py = slf.py();
        let pose = slf.pose(py, point, axis)?;
        slf.push(Op::Rapid(pose));
        Ok(slf)
    }

    /// Cut straight to a point; where an axis is given, the tool turns to it on the way.
    #[pyo3(signature = (point, axis = None))]
    fn line<'py>(
        mut slf: PyRefMut<'py, Self>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
    ) -> Built<'py> {
        let py = slf.py();
        let pose = slf.pose(py, point, axis)?;
        slf.push(Op::Line(pose));
        Ok(slf)
    }

    /// Cut along an arc or a helix about a centre: counter-clockwise, seen against ``normal``.
    ///
    /// Raises
    /// ------
    /// toolpost.Error
    ///     ``no-start`` where the tool is nowhere yet; ``off-the-circle`` where both ends are not equally far
    ///     from the centre (0.005 mm), or there is no radius.
    #[pyo3(signature = (end, center, *, clockwise = false, normal = [0.0, 0.0, 1.0], turns = 0))]
    fn arc<'py>(
        mut slf: PyRefMut<'py, Self>,
        end: [f64; 3],
        center: [f64; 3],
        clockwise: bool,
        normal: [f64; 3],
        turns: u32,
    ) -> Built<'py> {
        let py = slf.py();
        let center = point(py, "the centre", center)?;
        let normal = direction(py, "the normal", normal)?;
        let normal = if clockwise { -normal } else { normal };
        let Some(start) = slf.tip else {
            let found = Diagnostic::error("no-start", "an arc, but from nowhere");
            return Err(refused(py, found.help("go to its start before")));
        };
        if turns > MOST_TURNS {
            let message = format!("an arc of {turns} full turns more; {MOST_TURNS} are the most");
            return Err(refused(py, Diagnostic::error("number", message)));
        }
        let end = point(py, "the end", end)?;
        Arc::new(start, end, center, normal, turns, RADIUS_TOLERANCE)
            .map_err(|error| refused(py, no_arc(&error)))?;
        slf.tip = Some(end);
        let end = Pose::new(end, slf.axis);
        slf.push(Op::Arc(Box::new(ArcTo { end, center, normal, turns })));
        Ok(slf)
    }

    /// Make a hole at each of ``points``, which lie on the surface.
    ///
    /// Parameters
    /// ----------
    /// points : sequence of tuples of 3 floats
    ///     Where, mm.
    /// depth : float
    ///     Of the bottom below the point, along the tool axis, mm.
    /// clearance : float
    ///     Height above the point from which the tool feeds, mm.
    /// retract : float, optional
    ///     Height above the point to which it goes back, mm; by default ``clearance``.
    /// kind : {"drill", "deep", "break-chip", "tap", "ream", "bore", "fine-bore", "back-bore"}
    ///     What the tool does in the hole.
    /// feed : float, optional
    ///     mm/min; by default the feed that holds.
    /// dwell : float
    ///     At the bottom, s.
    /// peck, first_peck : float, optional
    ///     Depths of the pecks of ``deep`` and ``break-chip``, mm.
    /// pitch : float, optional
    ///     Of a tap, mm for a turn.
    /// left : bool
    ///     Whether the tap cuts a left-hand thread.
    /// aside : tuple of 3 floats, optional
    ///     How far and where to the bar of ``fine-bore`` and ``back-bore`` leaves the wall, mm.
    /// angle : float, optional
    ///     Position of the spindle for that, degrees; by default the one that the machine is set to.
    /// axis : tuple of 3 floats, optional
    ///     The tool axis of all of them.
    ///
    /// Raises
    /// ------
    /// toolpost.Error
    ///     ``no-clear-plane`` where the tool would feed from below the bottom, or go back below
    ///     ``clearance``; ``peck``, ``pitch`` and ``aside`` where the kind needs or takes none.
    #[pyo3(signature = (points, depth, *, clearance, retract = None, kind = "drill", feed = None, dwell = 0.0,
                        peck = None, first_peck = None, pitch = None, left = false, aside = None, angle = None, axis = None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn drill<'py>(
        mut slf: PyRefMut<'py, Self>,
        points: Vec<[f64; 3]>,
        depth: f64,
        clearance: f64,
        retract: Option<f64>,
        kind: &str,
        feed: Option<f64>,
        dwell: f64,
        peck: Option<f64>,
        first_peck: Option<f64>,
        pitch: Option<f64>,
        left: bool,
        aside: Option<[f64; 3]>,
        angle: Option<f64>,
        axis: Option<[f64; 3]>,
    ) -> Built<'py> {
        let py = slf.py();
        let no = |rule, message: &str| Err(refused(py, Diagnostic::error(rule, message)));
        let withdrawal = Withdrawal {
            aside: point(py, "aside", aside.unwrap_or_default())?,
            angle: angle.map(|degrees| number(py, "angle", degrees)).transpose()?,
        };
        let kinds = [
            ("drill", CycleKind::Drill),
            ("deep", CycleKind::Deep),
            ("break-chip", CycleKind::BreakChip),
            ("tap", CycleKind::Tap { pitch: pitch.unwrap_or(0.0), left }),
            ("ream", CycleKind::Ream),
            ("bore", CycleKind::Bore),
            ("fine-bore", CycleKind::FineBore(withdrawal)),
            ("back-bore", CycleKind::BackBore { withdrawal, through: None }),
        ];
        let kind = word(py, "kind", kind, &kinds)?;
        let retract = number(py, "retract", retract.unwrap_or(clearance))?;
        let cycle = Cycle {
            kind,
            depth: positive(py, "depth", depth)?,
            clearance: number(py, "clearance", clearance)?,
            retract,
            feed: feed.map(|feed| positive(py, "feed", feed)).transpose()?.map(Feed::PerMinute),
            dwell: if dwell == 0.0 { 0.0 } else { positive(py, "dwell", dwell)? },
            first_peck: first_peck.map(|peck| positive(py, "first_peck", peck)).transpose()?,
            peck: peck.map(|peck| positive(py, "peck", peck)).transpose()?,
        };
        if clearance <= -depth || retract < clearance {
            return no(
                "no-clear-plane",
                "the tool feeds from `clearance`, above the bottom, and goes back to `retract`, no lower",
            );
        }
        let pecks = matches!(kind, CycleKind::Deep | CycleKind::BreakChip);
        if pecks != (peck.is_some() || first_peck.is_some()) {
            return no("peck", "`deep` and `break-chip`, and no other, take a peck");
        }
        if matches!(kind, CycleKind::Tap { .. }) != pitch.is_some() {
            return no("pitch", "`tap`, and no other, takes a pitch");
        }
        if kind.withdrawal().is_some() != aside.is_some_and(|aside| aside != [0.0; 3]) {
            return no("aside", "`fine-bore` and `back-bore`, and no other, go aside");
        }
        if let Some(pitch) = pitch {
            positive(py, "pitch", pitch)?;
        }
        let poses: PyResult<Vec<Pose>> =
            points.into_iter().map(|at| slf.pose(py, at, axis)).collect();
        let poses = poses?;
        slf.push(Op::Cycle(Box::new(cycle)));
        for pose in poses {
            slf.push(Op::Hole(pose));
        }
        slf.push(Op::CycleOff);
        slf.tip = slf.tip.map(|tip| tip + slf.axis * retract);
        Ok(slf)
    }

    /// Change to a tool.
    ///
    /// Parameters
    /// ----------
    /// number : int
    ///     Its place in the magazine, from 1.
    /// name : str
    ///     What it is called.
    /// diameter, corner_radius, length : float, optional
    ///     Of the tool, mm; the length from the gauge line of the spindle to the tip.
    /// offset : int, optional
    ///     Register of its length offset, where that is not the tool's own.
    #[pyo3(signature = (number, name = "", *, diameter = None, corner_radius = None, length = None, offset = None))]
    fn tool<'py>(
        mut slf: PyRefMut<'py, Self>,
        number: u32,
        name: &str,
        diameter: Option<f64>,
        corner_radius: Option<f64>,
        length: Option<f64>,
        offset: Option<u32>,
    ) -> Built<'py> {
        let py = slf.py();
        if number == 0 {
            let found = Diagnostic::error("number", "tool 0 is no tool");
            return Err(refused(py, found.help("tools count from 1")));
        }
        let size = |what, mm: Option<f64>| mm.map(|mm| positive(py, what, mm)).transpose();
        let (diameter, length) = (size("diameter", diameter)?, size("length", length)?);
        let corner_radius =
            corner_radius.map(|mm| self::number(py, "corner_radius", mm)).transpose()?;
        let name = name.to_owned();
        let tool = Tool { number, name, diameter, corner_radius, length, offset };
        slf.push(Op::Tool(Box::new(tool)));
        Ok(slf)
    }

    /// Feed from here on, in ``mm/min``, ``mm/rev`` (for a turn of the spindle) or ``1/min`` (moves in a
    /// minute).
    #[pyo3(signature = (feed, unit = "mm/min"))]
    fn feed<'py>(mut slf: PyRefMut<'py, Self>, feed: f64, unit: &str) -> Built<'py> {
        let py = slf.py();
        let unit = word(py, "unit", unit, &FEED_UNITS)?;
        let feed = positive(py, "feed", feed)?;
        slf.push(Op::Feed(unit(feed)));
        Ok(slf)
    }

    /// Spindle speed from here on, 1/min; 0 stops it.
    #[pyo3(signature = (speed, *, clockwise = true))]
    fn spindle<'py>(mut slf: PyRefMut<'py, Self>, speed: f64, clockwise: bool) -> Built<'py> {
        let py = slf.py();
        let spindle = match (speed == 0.0, clockwise) {
            (true, _) => Spindle::Off,
            (false, true) => Spindle::Clockwise(positive(py, "speed", speed)?),
            (false, false) => Spindle::CounterClockwise(positive(py, "speed", speed)?),
        };
        slf.push(Op::Spindle(spindle));
        Ok(slf)
    }

    /// Coolant from here on: ``off``, ``flood``, ``mist``, ``flood-and-mist`` or ``through`` (the tool).
    fn coolant<'py>(mut slf: PyRefMut<'py, Self>, coolant: &str) -> Built<'py> {
        let coolant = word(slf.py(), "coolant", coolant, &COOLANTS)?;
        slf.push(Op::Coolant(coolant));
        Ok(slf)
    }

    /// Cutter radius compensation from here on: ``off``, or the tool ``left`` or ``right`` of the path.
    #[pyo3(signature = (side, register = None))]
    fn compensation<'py>(
        mut slf: PyRefMut<'py, Self>,
        side: &str,
        register: Option<u32>,
    ) -> Built<'py> {
        let sides = [
            ("off", Compensation::Off),
            ("left", Compensation::Left(register)),
            ("right", Compensation::Right(register)),
        ];
        let compensation = word(slf.py(), "side", side, &sides)?;
        slf.push(Op::Compensation(compensation));
        Ok(slf)
    }

    /// Work offset from here on: 54 is the first that the control can set (``G54``), 55 the second.
    fn work_offset<'py>(mut slf: PyRefMut<'py, Self>, number: u32) -> Built<'py> {
        slf.tip = None;
        slf.push(Op::WorkOffset(number));
        Ok(slf)
    }

    /// The tool leaves the part: Z goes home.
    fn home<'py>(mut slf: PyRefMut<'py, Self>) -> Built<'py> {
        slf.tip = None;
        slf.push(Op::Home(4));
        Ok(slf)
    }

    /// Wait, s.
    fn dwell<'py>(mut slf: PyRefMut<'py, Self>, seconds: f64) -> Built<'py> {
        let seconds = positive(slf.py(), "dwell", seconds)?;
        slf.push(Op::Dwell(seconds));
        Ok(slf)
    }

    /// Stop until the operator goes on; with ``optional`` only where he has asked for it.
    #[pyo3(signature = (*, optional = false))]
    fn stop<'py>(mut slf: PyRefMut<'py, Self>, optional: bool) -> Built<'py> {
        slf.push(if optional { Op::OptionalStop } else { Op::Stop });
        Ok(slf)
    }

    /// An operation begins, of this name.
    fn operation<'py>(mut slf: PyRefMut<'py, Self>, name: &str) -> Built<'py> {
        slf.push(Op::Operation(name.into()));
        Ok(slf)
    }

    /// Words for the reader of the program.
    fn comment<'py>(mut slf: PyRefMut<'py, Self>, text: &str) -> Built<'py> {
        slf.push(Op::Comment(text.into()));
        Ok(slf)
    }

    /// Words for the operator's screen.
    fn message<'py>(mut slf: PyRefMut<'py, Self>, text: &str) -> Built<'py> {
        slf.push(Op::Message(text.into()));
        Ok(slf)
    }

    /// The program as it is so far, with its end.
    fn build(&self) -> Program {
        let mut built = Builder { program: self.program.clone(), ..*self };
        built.push(Op::End);
        Toolpath::of_program(built.program, "built").into()
    }

    fn __repr__(&self) -> String {
        format!("<Builder {}: {} records>", self.program.name, self.program.records.len())
    }
}

/// As a reader of cutter-location data says it.
fn no_arc(error: &ArcError) -> Diagnostic {
    let message = match error {
        ArcError::NoAxis => String::from("the normal has no direction"),
        ArcError::NoRadius => String::from("the arc starts on its own axis"),
        ArcError::OffTheCircle(start, end) => {
            format!("the arc starts {start:.4} mm from the centre, but ends {end:.4} mm from it")
        }
    };
    Diagnostic::error("off-the-circle", message)
}
