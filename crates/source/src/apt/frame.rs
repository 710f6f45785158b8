//! Units and frames: everything that moves or turns what the coordinates mean.
//!
//! The frame in which the file's first coordinates stand is the work frame. A later one is resolved
//! relative to it, so that all poses leave the reader in the work frame.

use super::report::{Fault, Outcome};
use super::statement::Statement;
use super::{Csys, Dialect, Reader, SetUps};
use geom::{Frame, INCH, Mat3, Vec3, direction};
use program::{Op, Rule};

/// Coordinates beyond this are a fault of the file, mm: no machine is a kilometre long.
pub(super) const FARTHEST: f64 = 1e6;

/// How far two origins of one place may be apart, in the unit of the file: they are printed with six decimals.
const SAME_ORIGIN: f64 = 1e-6;

/// How far axis vectors printed with a few decimals may be from unit length and a right angle.
pub(super) const SKEW: f64 = 1e-3;

/// Where the coordinates of the file stand.
pub(super) struct Setup {
    /// From the coordinates of the statements to the work frame.
    pub(super) to_work: Frame,
    /// Whether that is no change at all; spares the product on the fast path.
    pub(super) identity: bool,
    /// The first `MSYS` (or axis system of CATIA): the frame all others are relative to.
    first: Option<Frame>,
    /// Of `ORIGIN`, in the coordinates of the file.
    origin: Vec3,
    /// Of `TRANS`, in the coordinates of the file.
    shift: Vec3,
    /// The frame of the set-up, without origin and shift.
    base: Frame,
    /// The orientation of the last `Op::Frame`.
    written: Mat3,
    /// `TRNTYP/WORLD` was given: coordinates are in the world whatever `CSYS` says.
    world: bool,
    /// What the options say of the coordinates behind `CSYS`.
    csys: Option<Csys>,
    /// Origin of the last `CSYS`, as the file gives it, and how often it was another one than before.
    csys_origin: Option<(Vec3, usize)>,
    /// The first coordinate system of a Creo file.
    creo_system: Option<[f64; 12]>,
    /// Rows of an axis system of CATIA that is being read, and where it began.
    rows: Option<(u32, Vec<[f64; 4]>)>,
}

impl Setup {
    /// The work frame itself.
    pub(super) fn new(csys: Option<Csys>) -> Setup {
        Setup {
            to_work: Frame::IDENTITY,
            identity: true,
            first: None,
            origin: Vec3::ZERO,
            shift: Vec3::ZERO,
            base: Frame::IDENTITY,
            written: Mat3::IDENTITY,
            world: false,
            csys,
            csys_origin: None,
            creo_system: None,
            rows: None,
        }
    }

    /// The set-ups, where the file has had `CSYS`.
    pub(super) fn set_ups(&self) -> Option<SetUps> {
        let (_, changes) = self.csys_origin?;
        let csys = self.csys.unwrap_or(Csys::World);
        Some(SetUps { csys, is_given: self.csys.is_some(), changes })
    }

    /// The options say where the coordinates behind `CSYS` stand, and there is none.
    pub(super) fn lacks_csys(&self) -> bool {
        self.csys.is_some() && self.csys_origin.is_none()
    }
}

/// The frame with these axes and origin, its axes made exactly perpendicular.
fn frame(origin: Vec3, x: Vec3, y: Vec3) -> Result<Frame, Box<Fault>> {
    let skew = || {
        Fault::new(Rule::Frame, "the axes of this frame are not perpendicular unit vectors")
            .help("give x and y axes of length 1 at a right angle")
    };
    let unit = |v: Vec3| (v.length() - 1.0).abs() <= SKEW;
    if !(unit(x) && unit(y) && x.dot(y).abs() <= SKEW) {
        return Err(skew());
    }
    let x = direction(x).ok_or_else(skew)?;
    let z = direction(x.cross(y)).ok_or_else(skew)?;
    Ok(Frame::from_mat3_translation(Mat3::from_cols(x, z.cross(x), z), origin))
}

/// The frame of a matrix given in rows of three axis components and one of the origin.
fn frame_of_rows(rows: &[[f64; 4]]) -> Result<Frame, Box<Fault>> {
    let [a, b, c] = rows else {
        return Err(Fault::new(Rule::Frame, "this frame has not three rows"));
    };
    let column = |i: usize| Vec3::new(a[i], b[i], c[i]);
    let frame = frame(column(3), column(0), column(1))?;
    if frame.matrix3.z_axis.distance(column(2)) > 2.0 * SKEW {
        return Err(Fault::new(Rule::Frame, "the axes of this frame are not right-handed"));
    }
    Ok(frame)
}

impl Reader {
    /// `UNITS/MM`, `UNITS/INCHES`, `UNIT/MM`, `UNIT/IN`.
    pub(super) fn units(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[1], "UNITS/MM or UNITS/INCHES")?;
        let mm = ["MM", "MMS", "MILLIMETER", "MILLIMETERS", "METRIC"];
        let inch = ["IN", "INCH", "INCHES"];
        let unit = match () {
            () if mm.iter().any(|word| statement.is(0, word)) => 1.0,
            () if inch.iter().any(|word| statement.is(0, word)) => INCH,
            () => {
                return Err(Fault::new(Rule::UnknownUnit, "this unit is not known")
                    .help("units are MM and INCHES")
                    .fields(0, 1));
            }
        };
        // Whether the values before the first unit of a file are meant in that unit, or in one that the
        // CAM system and its post-processor agreed upon elsewhere, the file does not say. Reading the
        // unit ahead would be a guess by which a tool, a speed or a point may be wrong by 25.4, so a
        // file that was begun in another unit is refused.
        let read_in_mm = self.unit_used.get();
        let changes = !self.unit_known && read_in_mm > 0 && unit != self.unit;
        self.unit = unit;
        self.unit_known = true;
        if changes {
            let message = format!(
                "line {read_in_mm} gives a length or a feed before line {} says the unit: is it in mm \
                 or in inches?",
                statement.line
            );
            return Err(Fault::new(Rule::UnknownUnit, message)
                .help("write the unit before the first length: at the head of the file"));
        }
        Ok(())
    }

    /// `value` of the statement at hand, in the unit of the file, as mm.
    pub(super) fn mm(&self, value: f64) -> f64 {
        // Nothing is nothing in every unit.
        if !self.unit_known && value != 0.0 && self.unit_used.get() == 0 {
            self.unit_used.set(self.line);
        }
        value * self.unit
    }

    /// [`Reader::mm`] of a length.
    ///
    /// # Errors
    /// `out-of-range` beyond [`FARTHEST`] or where it is no number.
    pub(super) fn length(&self, value: f64) -> Result<f64, Box<Fault>> {
        let mm = self.mm(value);
        if mm.abs() <= FARTHEST {
            return Ok(mm);
        }
        let message = format!("{value:e} is farther than {FARTHEST} mm");
        Err(Fault::new(Rule::OutOfRange, message))
    }

    /// Three values from field `first` on as a point or shift in mm.
    pub(super) fn point(&self, statement: &Statement, first: usize) -> Result<Vec3, Box<Fault>> {
        let mut point = statement.numbers::<3>(first)?;
        for (i, value) in point.iter_mut().enumerate() {
            *value = self.length(*value).map_err(|fault| fault.fields(first + i, 1))?;
        }
        Ok(Vec3::from_array(point))
    }

    /// Takes `base` as the frame of the statements that follow and turns the tool axis to its Z.
    fn set_up(&mut self, line: u32, base: Frame) {
        self.setup.base = base;
        self.reframe();
        self.axis = base.matrix3.z_axis;
        self.write_plane(line, base);
    }

    /// Adds a record of the plane of work where its orientation changed.
    fn write_plane(&mut self, line: u32, frame: Frame) {
        if !frame.matrix3.abs_diff_eq(self.setup.written, 1e-9) {
            self.setup.written = frame.matrix3;
            self.push(line, Op::Frame(Box::new(frame)));
        }
    }

    /// Calculates the frame of the coordinates after a change.
    fn reframe(&mut self) {
        let shift = Frame::from_translation(self.setup.shift - self.setup.origin);
        self.setup.to_work = self.setup.base * shift;
        self.setup.identity = self.setup.to_work == Frame::IDENTITY;
    }

    /// `MSYS/ox,oy,oz,xx,xy,xz,yx,yy,yz`: the coordinate system of a Siemens NX operation.
    pub(super) fn msys(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[9], "MSYS/ox,oy,oz,xx,xy,xz,yx,yy,yz")?;
        let x = Vec3::from_array(statement.numbers(3)?);
        let y = Vec3::from_array(statement.numbers(6)?);
        let frame = frame(self.point(statement, 0)?, x, y).map_err(|fault| fault.fields(3, 6))?;
        self.relative_set_up(statement.line, frame);
        Ok(())
    }

    /// A frame given in the part's coordinates: the first is the work frame, others follow from it.
    fn relative_set_up(&mut self, line: u32, frame: Frame) {
        // What moved before any frame was given stands in the part's coordinates.
        let moved = self.point.is_some();
        let first = *self.setup.first.get_or_insert(if moved { Frame::IDENTITY } else { frame });
        let base = if first == frame { Frame::IDENTITY } else { first.inverse() * frame };
        self.set_up(line, base);
    }

    /// `TRNTYP/WORLD,0,0,0`: the coordinates stay in the world, whatever `CSYS` says.
    pub(super) fn trntyp(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[1, 4], "TRNTYP/WORLD,0,0,0")?;
        if !statement.is(0, "WORLD") {
            return Err(Fault::new(Rule::Frame, "only TRNTYP/WORLD is known").fields(0, 1));
        }
        if statement.fields.len() == 4 && statement.numbers::<3>(1)? != [0.0; 3] {
            return Err(Fault::new(Rule::Frame, "a shift of the world is not known").fields(1, 3));
        }
        self.setup.world = true;
        Ok(())
    }

    /// `CSYS/xx,yx,zx,ox,xy,yy,zy,oy,xz,yz,zz,oz`: the set-up of a SolidWorks CAM operation. Behind `TRNTYP/WORLD`
    /// points and vectors are in the world already, and the set-up gives the plane of work; so it is also where the origin
    /// changes: read in the frame of each, set-ups of one part drill their holes in the same places, and read in the
    /// world the holes lie apart and within the stock.
    pub(super) fn csys(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[12], "CSYS/ and three rows of four values")?;
        let values = statement.numbers::<12>(0)?;
        let rows: Vec<[f64; 4]> =
            values.chunks_exact(4).map(|r| [r[0], r[1], r[2], r[3]]).collect();
        let mut frame = frame_of_rows(&rows).map_err(|fault| fault.fields(0, 12))?;
        let (last, count) = *self.setup.csys_origin.get_or_insert((frame.translation, 0));
        let is_another = last.distance(frame.translation) > SAME_ORIGIN;
        if is_another {
            self.setup.csys_origin = Some((frame.translation, count + 1));
        }
        let is_known = self.setup.world || self.setup.csys.is_some();
        if !is_known && (is_another || frame.matrix3 != Mat3::IDENTITY) {
            let message = "without TRNTYP/WORLD it is not known whether the coordinates are in the world or in \
                           this CSYS";
            let help =
                "let the CAM system write TRNTYP/WORLD, or give --csys local or --csys world";
            return Err(Fault::new(Rule::Frame, message).help(help));
        }
        if self.setup.csys == Some(Csys::Local) {
            for (i, field) in [3, 7, 11].into_iter().enumerate() {
                let length = self.length(frame.translation[i]);
                frame.translation[i] = length.map_err(|fault| fault.fields(field, 1))?;
            }
            self.relative_set_up(statement.line, frame);
            return Ok(());
        }
        self.axis = frame.matrix3.z_axis;
        self.write_plane(statement.line, Frame::from_mat3(frame.matrix3));
        Ok(())
    }

    /// `ORIGIN/x,y,z`: this point of the part is the zero of the coordinates that leave.
    pub(super) fn origin(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[3], "ORIGIN/x,y,z")?;
        self.setup.origin = self.point(statement, 0)?;
        self.reframe();
        Ok(())
    }

    /// `$$-> CSYS / ...` of Creo: the coordinate system of a sequence.
    pub(super) fn creo_csys(&mut self, statement: &Statement) -> Outcome {
        let system = statement.numbers::<12>(1)?;
        if *self.setup.creo_system.get_or_insert(system) == system {
            return Ok(());
        }
        let message = "this sequence has another coordinate system than the first, and how the two \
                       stand to each other is not known";
        Err(Fault::new(Rule::Frame, message).help("post the sequences one by one").fields(1, 12))
    }

    /// `TRANS/x,y,z`: adds to the coordinates that follow.
    pub(super) fn trans(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[3], "TRANS/x,y,z")?;
        self.setup.shift = self.point(statement, 0)?;
        self.reframe();
        Ok(())
    }

    /// `ROTATE/...`, `ROTABL/...`, `ROTHED/...`: a rotary axis sent to an angle. Only no rotation at all
    /// can be resolved: for any other the file does not say whether the coordinates turn with the table,
    /// and a file whose points have tool axes has no need of it.
    pub(super) fn rotate(&mut self, statement: &Statement) -> Outcome {
        let angles = statement.fields.iter().filter_map(|field| match field {
            super::statement::Field::Number(angle) => Some(*angle),
            _ => None,
        });
        let angles: Vec<f64> = angles.collect();
        if angles == [0.0] {
            return Ok(());
        }
        let word = super::text::decode(statement.major);
        let message = format!(
            "{word} turns a rotary axis, and the file does not say what that does to the coordinates \
             after it"
        );
        Err(Fault::new(Rule::Unsupported, message)
            .help("let the CAM system write tool-axis vectors (multi-axis output) instead"))
    }

    /// `HEAD/...`: another head of the machine. Where it holds the tool is not in the file.
    pub(super) fn head(&mut self, _: &Statement) -> Outcome {
        let message = "HEAD changes to another head of the machine, and how that holds the tool is not in \
                       the file";
        Err(Fault::new(Rule::Unsupported, message).help(
            "post the operations of each head as a file of its own, with the machine file of that head",
        ))
    }

    /// `MULTAX/ON`, `MULTAX/OFF`. Without multi-axis output the tool stands along Z; in CATIA its axis is
    /// locked as it was in the last point before, and no `TLAXIS` says so (Dassault Systèmes, *Syntax of
    /// Generated APT Instructions*, MULTAX influence).
    pub(super) fn multax(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[0, 1], "MULTAX/ON or MULTAX/OFF")?;
        match () {
            () if statement.fields.is_empty() || statement.is(0, "ON") => Ok(()),
            () if statement.is(0, "OFF") => {
                if self.dialect == Dialect::Catia {
                    return Ok(());
                }
                self.axis = self.setup.to_work.matrix3.z_axis;
                Ok(())
            }
            () => Err(Fault::new(Rule::Malformed, "MULTAX is ON or OFF").fields(0, 1)),
        }
    }

    /// `TLAXIS/i,j,k`: the tool axis from here on.
    pub(super) fn tlaxis(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[3], "TLAXIS/i,j,k")?;
        let axis = Vec3::from_array(statement.numbers(0)?);
        self.axis = self.work_axis(axis).map_err(|fault| fault.fields(0, 3))?;
        Ok(())
    }

    /// An axis of the file as a unit vector of the work frame.
    #[inline]
    pub(super) fn work_axis(&self, axis: Vec3) -> Result<Vec3, Box<Fault>> {
        let Some(axis) = direction(axis) else { return Err(no_direction()) };
        Ok(if self.setup.identity { axis } else { self.setup.to_work.transform_vector3(axis) })
    }

    /// Reads the remarks `$$*CATIA0`, a name, and three rows of a matrix: the axis system in which
    /// CATIA gives the coordinates that follow. Whether this remark was part of one.
    pub(super) fn axis_system(
        &mut self,
        statement: &Statement,
        text: &str,
    ) -> Result<bool, Box<Fault>> {
        if text == "*CATIA0" {
            self.setup.rows = Some((statement.line, Vec::with_capacity(3)));
            return Ok(true);
        }
        let Some((_, rows)) = &mut self.setup.rows else { return Ok(false) };
        let values: Vec<f64> =
            text.split_ascii_whitespace().map_while(|v| v.parse().ok()).collect();
        match values[..] {
            [a, b, c, d] if d.abs() <= FARTHEST / INCH => rows.push([a, b, c, d]),
            // The name of the axis system.
            _ if rows.is_empty() => return Ok(true),
            _ => {
                self.setup.rows = None;
                return Err(Fault::new(
                    Rule::Frame,
                    "this axis system of CATIA has not three rows",
                ));
            }
        }
        if rows.len() == 3 {
            let mut frame = frame_of_rows(rows)?;
            self.setup.rows = None;
            frame.translation = frame.translation.to_array().map(|value| self.mm(value)).into();
            if self.dialect == Dialect::Catia {
                self.relative_set_up(statement.line, frame);
            }
        }
        Ok(true)
    }
}

/// The fault of a tool axis or arc axis without a direction.
#[cold]
pub(super) fn no_direction() -> Box<Fault> {
    Fault::new(Rule::ZeroVector, "this vector has no direction")
        .help("give the direction of the tool axis, not zero")
}
