//! Arcs: `CIRCLE` and `GOTO`, and the `TLON` of CATIA and Creo.
//!
//! A `CIRCLE` gives centre and axis, the `GOTO` after it the end. In which direction the arc turns about
//! the axis is a habit of the CAM system ([`Dialect::turn`]). The path itself shows whether the habit was taken
//! rightly: contours are smooth, so an arc in the wrong direction reverses the path at a straight
//! move next to it. [`judge`] checks every file for that.

use super::Reader;
use super::dialect::{Dialect, Turn};
use super::frame::no_direction;
use super::motion::Next;
use super::report::{Fault, Outcome};
use super::statement::Statement;
use geom::{ANGLE_EPSILON, Arc, ArcError, Vec3, angle_between, direction};
use program::{ArcTo, Circle, Diagnostic, Op, Pose, Program, Rule};
use std::f64::consts::{PI, TAU};

/// How far the ends of an arc, and the radius the statement gives, may be from each other, mm. Files give
/// four decimals: in mm the radii of the real ones differ by up to 0.00015, and an inch has 25.4.
pub(super) const RADIUS_TOLERANCE: f64 = 0.005;

/// Cosine of 3°: closer than that to the tangent, a straight move goes on from the arc smoothly.
const SMOOTH: f64 = 0.9986;

/// An arc that turns by no more is the shorter one of its circle between its ends, radians; of half a turn, within rounding, neither is.
const SHORT: f64 = PI - 1e-3;

/// A direction nearer to a coordinate axis than this (radians) is the axis: what `INDIRV` loses in five
/// decimals.
const SNAP: f64 = 1e-4;

/// Ends of an arc nearer than this, mm, differ by rounding.
const NEARLY: f64 = 0.002;

/// A circle of a statement, in the work frame.
#[derive(Clone, Debug)]
pub(super) struct CircleWord {
    center: Vec3,
    /// As the statement gives it.
    axis: Vec3,
    radius: Option<f64>,
    /// `TIMES,n`: full turns in all.
    times: u32,
}

impl Reader {
    /// `CIRCLE/cx,cy,cz,i,j,k`, then `r`, and of Siemens NX and Makino tolerance, its share, and the
    /// tool's diameter and corner radius; `TIMES,n` for a helix. The next `GOTO` is the end.
    pub(super) fn circle(&mut self, statement: &Statement) -> Outcome {
        self.may_turn()?;
        let first = usize::from(statement.is(0, "CANON"));
        let times = (first..statement.fields.len()).find(|i| statement.is(*i, "TIMES"));
        let count = times.unwrap_or(statement.fields.len()) - first;
        if !matches!(count, 6..=11) {
            let message = format!("{count} values where a circle takes 6 to 11");
            return Err(Fault::new(Rule::Malformed, message)
                .help("write CIRCLE/cx,cy,cz,i,j,k,r")
                .fields(first, count));
        }
        let center = self.setup.to_work.transform_point3(self.point(statement, first)?);
        let axis = Vec3::from_array(statement.numbers(first + 3)?);
        let axis = direction(axis).ok_or_else(|| no_direction().fields(first + 3, 3))?;
        let radius = match count {
            6 => None,
            _ => Some(self.length(statement.number(first + 6, "the radius")?)?),
        };
        let times = match times {
            None => 1,
            Some(i) => match statement.number(i + 1, "the number of turns")? {
                n if n.fract() == 0.0 && (1.0..=1e4).contains(&n) => n as u32,
                n => {
                    let message = format!("{n} turns cannot be made");
                    return Err(Fault::new(Rule::Malformed, message).fields(i + 1, 1));
                }
            },
        };
        let axis = self.setup.to_work.transform_vector3(axis);
        self.next = Next::Arc(Box::new(CircleWord { center, axis, radius, times }));
        self.circle_at = statement.line;
        Ok(())
    }

    /// Whether an arc may come here.
    fn may_turn(&mut self) -> Outcome {
        self.no_pending_circle()?;
        if matches!(self.next, Next::Rapid) {
            return Err(Fault::new(Rule::Unsupported, "an arc cannot be a rapid"));
        }
        if self.cycle.is_some() {
            return Err(Fault::new(Rule::Unsupported, "an arc within a hole cycle")
                .help("add CYCLE/OFF before it"));
        }
        Ok(())
    }

    /// A circle that waits for its `GOTO` must not be left waiting.
    pub(super) fn no_pending_circle(&mut self) -> Outcome {
        if !matches!(self.next, Next::Arc(_)) {
            return Ok(());
        }
        self.next = Next::Line;
        let message = format!("the CIRCLE of line {} has no GOTO", self.circle_at);
        Err(Fault::new(Rule::CircleWithoutGoto, message).help("add the GOTO that ends the arc"))
    }

    /// The arc of `circle` from where the tool is to `end`.
    pub(super) fn arc(&mut self, statement: &Statement, circle: &CircleWord, end: Pose) -> Outcome {
        self.circles = true;
        let normal = match self.dialect.turn().unwrap_or(Turn::RightHand) {
            Turn::RightHand => circle.axis,
            Turn::LeftHand => -circle.axis,
        };
        self.arc_about(statement, circle, normal, end)
    }

    /// The arc of `circle` counter-clockwise about `normal`.
    fn arc_about(
        &mut self,
        statement: &Statement,
        circle: &CircleWord,
        normal: Vec3,
        end: Pose,
    ) -> Outcome {
        self.prepare(statement, true)?;
        let Some(start) = self.tip else {
            return Err(Fault::new(Rule::NoStart, "an arc, but from nowhere")
                .help("add a GOTO to its start before the CIRCLE"));
        };
        let arc = Arc::new(start.point(), end.point(), circle.center, normal, 0, RADIUS_TOLERANCE)
            .map_err(|error| not_an_arc(&error))?;
        let radius = arc.radius();
        if let Some(given) = circle.radius
            && (given - radius).abs() > RADIUS_TOLERANCE
        {
            let message = format!(
                "the arc starts {radius:.4} mm from the centre, but its radius is {given:.4} mm"
            );
            return Err(Fault::new(Rule::OffTheCircle, message));
        }
        if arc.sweep < TAU && arc.sweep > PI && start.point().distance(end.point()) < NEARLY {
            let message = "the ends of this arc are not the same, but so near that it could be a full \
                           circle or nothing";
            return Err(
                Fault::new(Rule::ArcChord, message).help("give the same point for a full circle")
            );
        }
        if circle.times > 1 && arc.sweep < TAU {
            let message = "several turns that do not end where they began (seen along the axis) are \
                           not defined";
            return Err(Fault::new(Rule::Unsupported, message)
                .help("end the full turns first, then the rest in an arc of its own"));
        }
        let tilt = angle_between(start.axis(), end.axis());
        if tilt > ANGLE_EPSILON {
            return Err(Fault::new(Rule::Unsupported, "the tool axis turns during this arc")
                .help("let the CAM system write lines where the axis turns"));
        }
        let turns = circle.times - 1;
        let to = ArcTo { end, circle: Circle::new(circle.center, arc.normal, turns)? };
        self.push(statement.line, Op::Arc(Box::new(to)));
        self.arrive(end);
        self.last_arc = Some(start.point());
        Ok(())
    }

    /// A further point of the arc that the last statement made: the arc goes on to it. Whether there is
    /// such an arc.
    pub(super) fn lengthen_arc(&mut self, statement: &Statement) -> Result<bool, Box<Fault>> {
        let Some(start) = self.last_arc else { return Ok(false) };
        statement.count(&[3, 6], "x,y,z")?;
        let point = self.setup.to_work.transform_point3(self.point(statement, 0)?);
        let Some(Op::Arc(to)) = self.program.records.last_mut().map(|r| &mut r.op) else {
            return Ok(false);
        };
        let arc =
            |end| Arc::new(start, end, to.circle.center(), to.circle.normal(), 0, RADIUS_TOLERANCE);
        let so_far = arc(to.end.point()).map_err(|error| not_an_arc(&error))?;
        let further = arc(point).map_err(|error| not_an_arc(&error))?;
        if further.sweep <= so_far.sweep {
            let message = "the points of this arc do not follow each other in its direction";
            return Err(Fault::new(Rule::ArcDirection, message));
        }
        let end = to.end.at(point)?;
        to.end = end;
        self.arrive(end);
        self.last_arc = Some(start);
        Ok(true)
    }

    /// Creo may list several points of an arc. In `GOTO`s of their own they could not be distinguished from
    /// chords, so a line of Creo to a further point of the circle it has just left is refused. The line
    /// back to its start is the chord that closes the contour: a full circle ends at its start in its
    /// own statement.
    pub(super) fn not_on_the_arc(&mut self, statement: &Statement, pose: &Pose) -> Outcome {
        let (Dialect::Creo, Some(start)) = (self.dialect, self.last_arc) else { return Ok(()) };
        if start.distance(pose.point()) <= RADIUS_TOLERANCE {
            let message =
                "a line to the start of the arc just cut: read as the chord that closes it";
            self.report.warn(
                statement,
                Rule::ArcPoints,
                message,
                "check that no full circle is meant",
            );
            return Ok(());
        }
        // Records that move nothing may stand between.
        let last = self.program.records.iter().rev().find_map(|record| match &record.op {
            Op::Arc(to) => Some(to),
            _ => None,
        });
        let Some(to) = last else { return Ok(()) };
        let on = Arc::new(
            to.end.point(),
            pose.point(),
            to.circle.center(),
            to.circle.normal(),
            0,
            RADIUS_TOLERANCE,
        );
        match on {
            Ok(arc) if arc.rise().abs() <= RADIUS_TOLERANCE => {
                let message = "a line to another point of the circle just cut: is it a chord, or a \
                               further point of the arc?";
                Err(Fault::new(Rule::ArcPoints, message)
                    .help("let Creo write one point for an arc (NUMBER_OF_ARC_PTS 1)"))
            }
            _ => Ok(()),
        }
    }

    /// `INDIRV/i,j,k`: the direction in which the next `TLON` sets out.
    pub(super) fn indirv(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[3], "INDIRV/i,j,k")?;
        let towards = Vec3::from_array(statement.numbers(0)?);
        self.towards = Some(self.work_axis(towards).map_err(|fault| fault.fields(0, 3))?);
        Ok(())
    }

    /// `TLON,GOFWD/(CIRCLE/cx,cy,cz,r),ON,(LINE/x0,y0,z0,x1,y1,z1)`, with `ON,2,INTOF` for `ON`: along
    /// the circle, setting out as `INDIRV` says, to the end of the line.
    pub(super) fn tlon(&mut self, statement: &Statement) -> Outcome {
        self.may_turn()?;
        let syntax = "write TLON,GOFWD/(CIRCLE/cx,cy,cz,r),ON,(LINE/x0,y0,z0,x1,y1,z1)";
        let count = statement.fields.len();
        let line = if statement.is(7, "INTOF") { 8 } else { 6 };
        let known = statement.is(0, "CIRCLE")
            && statement.is(5, "ON")
            && statement.is(line, "LINE")
            && count == line + 7;
        if !known {
            let message = "only a circle up to a line is known here";
            return Err(Fault::new(Rule::Unsupported, message).help(syntax));
        }
        let center = self.setup.to_work.transform_point3(self.point(statement, 1)?);
        let radius = Some(self.length(statement.number(4, "the radius")?)?);
        let end = self.setup.to_work.transform_point3(self.point(statement, line + 4)?);
        let (Some(start), Some(towards)) = (self.tip, self.towards.take()) else {
            return Err(Fault::new(
                Rule::NoStart,
                "the start or the direction of this arc is not known",
            )
            .help("add GOTO/ and INDIRV/ before it"));
        };
        let spoke = start.point() - center;
        let Some(normal) = direction(spoke.cross(towards)) else { return Err(no_direction()) };
        if spoke.normalize_or_zero().dot(towards).abs() > 0.1 {
            return Err(Fault::new(Rule::ArcDirection, "INDIRV is not tangent to this circle"));
        }
        let principal = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        let normal = principal.into_iter().find(|a| a.distance(normal) < SNAP).unwrap_or(normal);
        self.next = Next::Line;
        let circle = CircleWord { center, axis: normal, radius, times: 1 };
        self.arc_about(statement, &circle, normal, Pose::new(end, self.axis)?)
            .map_err(|fault| fault.fields(0, count))
    }
}

/// The fault of three points and an axis that make no arc.
fn not_an_arc(error: &ArcError) -> Box<Fault> {
    match error {
        ArcError::NoAxis => no_direction(),
        ArcError::NoRadius => Fault::new(Rule::OffTheCircle, "the arc starts at its centre"),
        ArcError::OffTheCircle(start, end) => Fault::new(
            Rule::OffTheCircle,
            format!("the arc starts {start:.4} mm from the centre, but ends {end:.4} mm from it"),
        )
        .help(format!("the two may differ by {RADIUS_TOLERANCE} mm")),
    }
}

/// What the straight moves next to the arcs of a file show about the direction of the arcs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Evidence {
    /// Arcs that go on smoothly from or into a straight move.
    pub(super) smooth: usize,
    /// Arcs that would do so in the other direction, and reverse the path as they are.
    pub(super) reversed: usize,
    /// Line of the first of these.
    pub(super) first_reversed: u32,
}

/// A straight move next to an arc.
#[derive(Clone, Copy)]
struct Straight {
    direction: Vec3,
    /// Along the tool: a plunge or a retract.
    is_along_tool: bool,
}

/// An arc, with what went before it.
struct Turned {
    line: u32,
    before: Option<Straight>,
    start: Vec3,
    end: Vec3,
    sweep: f64,
}

impl Turned {
    /// Whether it goes on smoothly from or into a straight move, and whether it reverses the path.
    fn joints(&self, behind: Option<Straight>) -> (bool, bool) {
        let before = self.before.map(|straight| (straight, straight.direction.dot(self.start)));
        let behind = behind.map(|straight| (straight, straight.direction.dot(self.end)));
        let joints: Vec<(Straight, f64)> = before.into_iter().chain(behind).collect();
        let smooth = joints.iter().any(|(_, cosine)| *cosine > SMOOTH);
        // A plunge is no part of a contour: a short arc may rise out of it along the same line, and the other way round it would first go
        // on down, by more than half a turn.
        let shows = match joints[..] {
            [(straight, _)] => !straight.is_along_tool || self.sweep > SHORT,
            _ => !joints.is_empty(),
        };
        // A cusp at one end is a corner being cleaned; one at every end is the wrong direction.
        (smooth, shows && joints.iter().all(|(_, cosine)| *cosine < -SMOOTH))
    }
}

/// Compares the arcs of `program` with the straight moves next to them.
pub(super) fn weigh(program: &Program) -> Evidence {
    let mut evidence = Evidence::default();
    // The straight cut that ended at `here`, and the arc after it.
    let (mut here, mut before): (Option<Vec3>, Option<Straight>) = (None, None);
    let mut open: Option<Turned> = None;
    for record in &program.records {
        let Some(pose) = record.op.pose() else { continue };
        let straight = match (&record.op, here) {
            (Op::Line(_), Some(here)) => direction(pose.point() - here),
            _ => None,
        };
        let straight = straight.map(|direction| Straight {
            direction,
            is_along_tool: direction.dot(pose.axis()).abs() > SMOOTH,
        });
        if let Some(arc) = open.take() {
            let (smooth, reversed) = arc.joints(straight);
            evidence.smooth += usize::from(smooth);
            if reversed {
                if evidence.reversed == 0 {
                    evidence.first_reversed = arc.line;
                }
                evidence.reversed += 1;
            }
        }
        if let (Op::Arc(to), Some(start)) = (&record.op, here)
            && let Ok(arc) = to.circle.arc(start, pose.point(), f64::MAX)
        {
            let back = Arc { start: arc.end, end: arc.start, normal: -arc.normal, ..arc };
            let (start, end, sweep) = (arc.tangent(), -back.tangent(), arc.sweep);
            open = Some(Turned { line: record.line, before, start, end, sweep });
        }
        before = straight;
        here = Some(pose.point());
    }
    evidence
}

/// Checks the arcs of `program` against their path. It is an error where more of them reverse
/// the path than go on smoothly: then the habit of the file is another than was taken.
pub(super) fn judge(program: &Program, dialect: Dialect) -> Option<Diagnostic> {
    let Evidence { smooth, reversed, first_reversed } = weigh(program);
    if reversed > smooth {
        let message = format!(
            "the path shows that the arcs turn in the other direction: {reversed} of them reverse it, {smooth} \
             go on smoothly"
        );
        let help = "let the CAM system write lines for arcs, or TLON with INDIRV";
        return Some(
            Diagnostic::error(Rule::ArcDirection, message).help(help).line(first_reversed),
        );
    }
    if reversed > 0 {
        let message = format!(
            "{reversed} arcs reverse the path, and would not in the other direction; {smooth} go \
             on smoothly"
        );
        let warning = Diagnostic::warning(Rule::ArcDirection, message);
        return Some(warning.help("look at the path here").line(first_reversed));
    }
    if smooth == 0 && dialect.turn().is_none() {
        let message = "neither the file nor its path shows in which direction arcs turn: taken as \
                       counter-clockwise about the vector of CIRCLE";
        return Some(Diagnostic::warning(Rule::ArcDirection, message).help("look at the arcs"));
    }
    None
}
