//! The contours that a neutral program cuts.

use crate::contour::Contour;
use geom::{Vec2, angle_between};
use program::{ArcTo, Compensation, Diagnostic, Op, Pose, Program, Rule};
use sketch::{ARC_TOLERANCE, Direction, Element, SAME};

/// What `program` cuts in the plane of X and Y: each contour runs from where a rapid ends to where the
/// next begins, and its start is where the wire is threaded. `start` is where the wire stands before
/// the first move, where that is known.
///
/// # Errors
/// Those of [`cuts`] and [`Contour::new`].
pub fn contours(program: &Program, start: Option<Vec2>) -> Result<Vec<Contour>, Box<Diagnostic>> {
    let contour =
        |Cut { brought_by, elements }| Ok(Contour::new(elements, 0.0)?.starting_by(brought_by));
    cuts(program, start)?.into_iter().map(contour).collect()
}

/// What is cut from one rapid to the next, move by move.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cut {
    /// The line of the rapid that brings the wire to its start; 0 for none.
    pub brought_by: u32,
    /// The moves.
    pub elements: Vec<Element>,
}

/// The same move by move: also those that only the other end of the wire makes.
///
/// # Errors
/// The first record that a wire cannot follow: an arc out of the plane, a tilted or turned tool, a
/// hole cycle, a compensation that is not resolved, a cut from an unknown place; and what
/// [`Element::arc_by_center`] refuses. `empty-contour` where nothing is cut.
pub fn cuts(program: &Program, start: Option<Vec2>) -> Result<Vec<Cut>, Box<Diagnostic>> {
    let mut position = start.unwrap_or(Vec2::NAN);
    let mut cuts = vec![Cut::default()];
    for record in &program.records {
        let at = |d: Box<Diagnostic>| Box::new(d.line(record.line));
        let element = match &record.op {
            Op::Line(pose) => Element::line(position, upright(pose).map_err(at)?),
            Op::Arc(arc) => turned(position, arc).map_err(at)?,
            Op::Rapid(pose) => {
                let to = upright(pose).map_err(at)?;
                // What only goes down stays where the one before has brought it.
                let before = cuts
                    .last()
                    .filter(|cut| cut.elements.is_empty() && cut.brought_by > 0 && to == position);
                let brought_by = before.map_or(record.line, |cut| cut.brought_by);
                position = to;
                cuts.push(Cut { brought_by, elements: Vec::new() });
                continue;
            }
            Op::MachineMove(_) | Op::Joints(_) => {
                position = Vec2::NAN;
                cuts.push(Cut::default());
                continue;
            }
            Op::Hole(_) => return Err(at(refused(Rule::NotACut, "a hole cycle", "take it out"))),
            Op::Taper(degrees) if *degrees != 0.0 => {
                let way_out = "take the contour without it, and lean the wire with --taper";
                return Err(at(refused(Rule::OpenTaper, "a wire that the control leans", way_out)));
            }
            Op::Thread(_) | Op::Probe(_) => {
                return Err(at(refused(Rule::NotACut, "a screw thread or a probe", "take it out")));
            }
            Op::Compensation(Compensation::Left(_) | Compensation::Right(_)) => {
                let what = "a wire offset whose amount is not known";
                let way_out =
                    "--side with --wire and --gap: the offset path is then calculated here";
                return Err(at(refused(Rule::OpenCompensation, what, way_out)));
            }
            _ => continue,
        };
        if element.start.is_nan() || element.end.is_nan() {
            let what = "a cut, and where it starts or ends is not known in X and Y";
            let way_out = "begin with a rapid to the start point, or name it";
            return Err(at(refused(Rule::UnknownPosition, what, way_out)));
        }
        position = element.end;
        if let Some(cut) = cuts.last_mut() {
            cut.elements.push(element.from_line(record.line));
        }
    }
    cuts.retain(|cut| cut.elements.iter().any(|element| element.length() >= SAME));
    if cuts.is_empty() {
        return Err(refused(Rule::EmptyContour, "the program cuts nothing in X and Y", ""));
    }
    Ok(cuts)
}

/// A contour from which the control of the source program offsets the wire.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetContour {
    /// The moves between the lead-in and the lead-out.
    pub contour: Contour,
    /// Whether the wire runs on its left (`G41`).
    pub left: bool,
    /// Where the lead-in begins, mm.
    pub thread: Vec2,
}

/// The contours of a program that leaves the wire's offset to the control: the straight move that comes
/// with `G41` or `G42` is the lead-in, the one with `G40` the lead-out. `None` where it offsets nothing.
///
/// # Errors
/// `open-compensation` where a cut goes without the offset, or a rapid with it; `source-passes` where a
/// contour is cut more than once; and those of [`contours`].
pub fn offset_contours(
    program: &Program,
    start: Option<Vec2>,
) -> Result<Option<Vec<OffsetContour>>, Box<Diagnostic>> {
    let on = |op: &Op| matches!(op, Op::Compensation(side) if *side != Compensation::Off);
    if !program.records.iter().any(|record| on(&record.op)) {
        return Ok(None);
    }
    let mut plain = Program::new(&*program.name);
    let (mut position, mut sides) = (start.unwrap_or(Vec2::NAN), Vec::new());
    // What holds, and whether it comes with the next move.
    let (mut side, mut switched, mut fresh) = (None, false, true);
    for record in &program.records {
        let line = record.line;
        let at = |d: Box<Diagnostic>| Box::new(d.line(line));
        match &record.op {
            Op::Compensation(asked) => {
                side = match asked {
                    Compensation::Left(_) => Some(true),
                    Compensation::Right(_) => Some(false),
                    Compensation::Off => None,
                };
                switched = true;
                continue;
            }
            Op::Line(pose) if switched => {
                if let Some(left) = side {
                    if !std::mem::take(&mut fresh) {
                        let what = "a second pass from the same thread point";
                        let way_out =
                            "leave the first pass in the program: --leave makes the others";
                        return Err(at(refused(Rule::SourcePasses, what, way_out)));
                    }
                    if position.is_nan() {
                        let what = "a lead-in, and where it starts is not known in X and Y";
                        let way_out = "begin with a rapid to the start point, or name it";
                        return Err(at(refused(Rule::UnknownPosition, what, way_out)));
                    }
                    sides.push((left, position));
                }
                switched = false;
                plain.push(line, Op::Rapid(*pose));
            }
            Op::Line(_) | Op::Arc(_) if side.is_none() => {
                let what = "a cut without the wire's offset, in a program that has it elsewhere";
                let way_out = "only the lead-in and the lead-out stand outside of G41 and G40";
                return Err(at(refused(Rule::OpenCompensation, what, way_out)));
            }
            Op::Rapid(_) if side.is_some() => {
                let way_out = "end the offset by G40 and a straight move before";
                let what = "a rapid while the wire is offset";
                return Err(at(refused(Rule::OpenCompensation, what, way_out)));
            }
            op => {
                fresh |= matches!(op, Op::Rapid(_) | Op::ThreadWire);
                plain.push(line, op.clone());
            }
        }
        if let Some(pose) = record.op.pose() {
            position = upright(pose).map_err(at)?;
        }
    }
    let contours = contours(&plain, start)?;
    if contours.len() != sides.len() {
        let what = "an offset is switched on, and nothing is cut with it";
        return Err(refused(Rule::OpenCompensation, what, "take G41 and G42 out there"));
    }
    let found = contours.into_iter().zip(sides);
    Ok(Some(
        found.map(|(contour, (left, thread))| OffsetContour { contour, left, thread }).collect(),
    ))
}

/// The place of a pose whose wire stands upright.
fn upright(pose: &Pose) -> Result<Vec2, Box<Diagnostic>> {
    let upright = angle_between(pose.axis(), geom::Vec3::Z) < geom::ANGLE_EPSILON;
    if !upright {
        let way_out = "a wire leans by U and V, or by the taper";
        return Err(refused(Rule::NotUpright, "a tool that leans or is turned", way_out));
    }
    Ok(pose.point().truncate())
}

fn turned(start: Vec2, arc: &ArcTo) -> Result<Element, Box<Diagnostic>> {
    let end = upright(&arc.end)?;
    let direction = match arc.circle.normal().z {
        z if z > 1.0 - 1e-9 => Direction::CounterClockwise,
        z if z < 1e-9 - 1.0 => Direction::Clockwise,
        _ => return Err(refused(Rule::NotACut, "an arc out of the plane G17", "cut in X and Y")),
    };
    if arc.circle.turns() > 0 {
        return Err(refused(Rule::NotACut, "an arc of more than one turn", "cut it once"));
    }
    // Where the ends are not known, the caller says so of the whole block.
    if start.is_nan() || end.is_nan() {
        return Ok(Element::line(start, end));
    }
    Element::arc_by_center(start, end, arc.circle.center().truncate(), direction, ARC_TOLERANCE)
}

fn refused(rule: Rule, what: &str, way_out: &str) -> Box<Diagnostic> {
    Diagnostic::error(rule, what).help(way_out).into()
}
