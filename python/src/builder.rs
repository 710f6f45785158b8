//! Building a program record by record: Python's words for `program::Builder`, which checks them.

use crate::arguments::word;
use crate::error::refused;
use crate::program::Program;
use crate::record::{COOLANTS, FEED_UNITS};
use app::toolpath::Toolpath;
use geom::Vec3;
use program::{
    CompensatedPath, Compensation, Cycle, CycleKind, Diagnostic, Feed, Output, OutputValue, Rule,
    Spindle, Tool, Withdrawal, WorkOffset,
};
use pyo3::prelude::*;
use pyo3::types::PyBool;

/// Builds a :class:`Program`; every method but :meth:`build` answers the builder, for a chain of calls.
///
/// Points are tool tips in mm, in the work frame. A tool axis holds until another is given; it begins as
/// +Z. Feed, spindle, coolant and compensation hold until they are set anew.
///
/// Every method raises :class:`toolpost.Error` for what no program can say: ``number`` (not finite, or not
/// greater than 0 where it has to be), ``zero-vector``, ``argument``.
#[pyclass(module = "toolpost")]
pub struct Builder {
    built: program::Builder,
}

/// The builder again.
type Built<'py> = PyResult<PyRefMut<'py, Builder>>;

impl Builder {
    /// A program of this name with nothing in it.
    pub fn new(name: &str) -> Builder {
        Builder { built: program::Builder::new(name) }
    }
}

/// The builder, where it has taken what was said.
fn taken<'py>(slf: PyRefMut<'py, Builder>, done: Result<(), Box<Diagnostic>>) -> Built<'py> {
    match done {
        Ok(()) => Ok(slf),
        Err(found) => Err(refused(slf.py(), *found)),
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
        let done = slf.built.rapid(point, axis);
        taken(slf, done)
    }

    /// Cut straight to a point; where an axis is given, the tool turns to it on the way.
    #[pyo3(signature = (point, axis = None))]
    fn line<'py>(
        mut slf: PyRefMut<'py, Self>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
    ) -> Built<'py> {
        let done = slf.built.line(point, axis);
        taken(slf, done)
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
        let normal = if clockwise { normal.map(|value| -value) } else { normal };
        let done = slf.built.arc(end, center, normal, turns);
        taken(slf, done)
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
        let withdrawal = Withdrawal { aside: Vec3::from_array(aside.unwrap_or_default()), angle };
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
        if matches!(kind, CycleKind::Tap { .. }) != pitch.is_some() {
            return no(Rule::Pitch, "`tap`, and no other, takes a pitch");
        }
        if kind.withdrawal().is_some() != aside.is_some_and(|aside| aside != [0.0; 3]) {
            return no(Rule::Aside, "`fine-bore` and `back-bore`, and no other, go aside");
        }
        let cycle = Cycle {
            kind,
            depth,
            clearance,
            retract: retract.unwrap_or(clearance),
            feed: feed.map(Feed::PerMinute),
            dwell,
            first_peck,
            peck,
        };
        let done = slf.built.drill(cycle, &points, axis);
        taken(slf, done)
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
        let name = name.to_owned();
        let tapered = false;
        let tool = Tool { number, name, diameter, corner_radius, length, offset, tapered };
        let done = slf.built.tool(tool);
        taken(slf, done)
    }

    /// Feed from here on, in ``mm/min``, ``mm/rev`` (for a turn of the spindle) or ``1/min`` (moves in a
    /// minute).
    #[pyo3(signature = (feed, unit = "mm/min"))]
    fn feed<'py>(mut slf: PyRefMut<'py, Self>, feed: f64, unit: &str) -> Built<'py> {
        let unit = word(slf.py(), "unit", unit, &FEED_UNITS)?;
        let done = slf.built.feed(unit(feed));
        taken(slf, done)
    }

    /// Spindle speed from here on, 1/min; 0 stops it.
    #[pyo3(signature = (speed, *, clockwise = true))]
    fn spindle<'py>(mut slf: PyRefMut<'py, Self>, speed: f64, clockwise: bool) -> Built<'py> {
        let done = slf.built.spindle(match (speed == 0.0, clockwise) {
            (true, _) => Spindle::Off,
            (false, true) => Spindle::Clockwise(speed),
            (false, false) => Spindle::CounterClockwise(speed),
        });
        taken(slf, done)
    }

    /// Coolant from here on: ``off``, ``flood``, ``mist``, ``flood-and-mist`` or ``through`` (the tool).
    fn coolant<'py>(mut slf: PyRefMut<'py, Self>, coolant: &str) -> Built<'py> {
        let coolant = word(slf.py(), "coolant", coolant, &COOLANTS)?;
        slf.built.coolant(coolant);
        Ok(slf)
    }

    /// Cutter radius compensation from here on: ``off``, or the tool ``left`` or ``right`` of the path, which is that of the
    /// tool's ``centre`` or the ``contour``, in the whole program.
    #[pyo3(signature = (side, register = None, *, path = None))]
    fn compensation<'py>(
        mut slf: PyRefMut<'py, Self>,
        side: &str,
        register: Option<u32>,
        path: Option<&str>,
    ) -> Built<'py> {
        let paths = [("centre", CompensatedPath::Center), ("contour", CompensatedPath::Contour)];
        let sides = [
            ("off", Compensation::Off),
            ("left", Compensation::Left(register)),
            ("right", Compensation::Right(register)),
        ];
        let compensation = word(slf.py(), "side", side, &sides)?;
        let path = path.map(|path| word(slf.py(), "path", path, &paths)).transpose()?;
        let done = path.map_or(Ok(()), |path| slf.built.compensated_path(path));
        if done.is_ok() {
            slf.built.compensation(compensation);
        }
        taken(slf, done)
    }

    /// Work offset from here on: 54 is the first that the control can set (``G54``), 55 the second.
    fn work_offset<'py>(mut slf: PyRefMut<'py, Self>, number: u32) -> Built<'py> {
        let Some(offset) = WorkOffset::numbered(number) else {
            let found =
                Diagnostic::error(Rule::Number, format!("there is no work offset {number}"));
            return Err(refused(slf.py(), found.help("54 is the first")));
        };
        slf.built.work_offset(offset);
        Ok(slf)
    }

    /// The tool leaves the part: Z goes home.
    fn home<'py>(mut slf: PyRefMut<'py, Self>) -> Built<'py> {
        slf.built.home();
        Ok(slf)
    }

    /// Wait, s.
    fn dwell<'py>(mut slf: PyRefMut<'py, Self>, seconds: f64) -> Built<'py> {
        let done = slf.built.dwell(seconds);
        taken(slf, done)
    }

    /// Stop until the operator goes on; with ``optional`` only where he has asked for it.
    #[pyo3(signature = (*, optional = false))]
    fn stop<'py>(mut slf: PyRefMut<'py, Self>, optional: bool) -> Built<'py> {
        slf.built.stop(optional);
        Ok(slf)
    }

    /// Set an output of the machine: a digital one ``True`` or ``False``, an analog one to a number. With
    /// ``with_motion`` it changes where the next motion begins, otherwise at once.
    #[pyo3(signature = (number, value, *, with_motion = false))]
    fn output<'py>(
        mut slf: PyRefMut<'py, Self>,
        number: u32,
        value: &Bound<'py, PyAny>,
        with_motion: bool,
    ) -> Built<'py> {
        let value = match value.cast::<PyBool>() {
            Ok(on) => OutputValue::Digital(on.is_true()),
            Err(_) => OutputValue::Analog(value.extract()?),
        };
        let done = slf.built.output(Output { number, value, with_motion });
        taken(slf, done)
    }

    /// Call a function that the builder of the machine has added, by the number of its M function.
    fn auxiliary(mut slf: PyRefMut<'_, Self>, number: u32) -> Built<'_> {
        slf.built.auxiliary(number);
        Ok(slf)
    }

    /// An operation begins, of this name.
    fn operation<'py>(mut slf: PyRefMut<'py, Self>, name: &str) -> Built<'py> {
        slf.built.operation(name);
        Ok(slf)
    }

    /// Words for the reader of the program.
    fn comment<'py>(mut slf: PyRefMut<'py, Self>, text: &str) -> Built<'py> {
        slf.built.comment(text);
        Ok(slf)
    }

    /// Words for the operator's screen.
    fn message<'py>(mut slf: PyRefMut<'py, Self>, text: &str) -> Built<'py> {
        slf.built.message(text);
        Ok(slf)
    }

    /// The program as it is so far, with its end.
    fn build(&self) -> Program {
        Toolpath::of_program(self.built.build(), "built").into()
    }

    fn __repr__(&self) -> String {
        let program = self.built.program();
        format!("<Builder {}: {} records>", program.name, program.records.len())
    }
}
