//! Arcs in every notation: centre, radius, opening angle, through a point.

use super::interpreter::Interpreter;
use crate::event::Action;
use crate::kernel::corner::Element;
use crate::kernel::source::Source;
use crate::kernel::{Outcome, arc};
use crate::sinumerik::language::block::{Block, Coordinate, Count};
use crate::sinumerik::language::commands::{Diameter, Motion};
use geom::{Arc, ArcError, Vec3, direction, rotate};
use program::Rule;

/// How far the radii at the ends of an arc may be apart: mm for small arcs, part of the radius for
/// large ones (MD21000, MD21010 as delivered; alarm 14040).
const RADIUS_ERROR: f64 = 0.01;
const RADIUS_ERROR_FACTOR: f64 = 0.001;

/// Most further turns of a helix (`TURN`).
const MOST_TURNS: f64 = 999.0;

const CENTER_NAMES: [&str; 3] = ["I", "J", "K"];
const AXIS_NAMES: [&str; 3] = ["X", "Y", "Z"];

/// A circle of the program: a point of its axis, and the direction about which it turns
/// counter-clockwise.
struct Circle {
    center: Vec3,
    normal: Vec3,
}

/// What an arc starts from, and its plane.
struct Ends {
    start: Vec3,
    end: Vec3,
    /// Index of the axis perpendicular to the plane.
    across: usize,
    /// Unit vector about which the arc turns counter-clockwise.
    normal: Vec3,
}

impl Interpreter<'_, '_> {
    /// An arc from where the tool is.
    pub fn arc(&mut self, source: &Source, block: &Block) -> Outcome {
        let error = |message: &str| Err(source.block_error(Rule::Arc, message));
        if block.has_rotary() || block.has_vector() {
            return error("the tool turns during an arc, which is not supported");
        }
        let (mut end, mut programmed) = self.target(source, block)?;
        let start = self.state.position;
        if start.is_nan() || end.is_nan() {
            return error("the arc starts at a point that is not known");
        }
        let across = self.state.plane_normal;
        let sign = if self.state.motion == Motion::Clockwise { -1.0 } else { 1.0 };
        let ends = Ends { start, end, across, normal: Vec3::AXES[across] * sign };
        if self.state.diameter != Diameter::Off
            && (self.state.motion == Motion::ThroughPoint
                || block.center[0].is_some_and(|i| i.count == Count::Absolute))
        {
            return error("an absolute centre or a point of the arc while X is a diameter");
        }
        let circle = if self.state.motion == Motion::ThroughPoint {
            self.through_point(source, block, &ends)?
        } else if self.state.motion == Motion::Tangential {
            self.tangential(source, block, &ends)?
        } else {
            check_helix(source, block, &ends)?;
            let ways = usize::from(block.radius.is_some()) + usize::from(block.opening.is_some());
            let centered = block.center.iter().any(Option::is_some);
            if block.through.iter().any(Option::is_some) {
                return error("I1= J1= K1= belong to CIP");
            }
            match (block.radius, block.opening) {
                (Some(radius), None) if !centered => {
                    by_radius(source, &ends, radius * self.state.unit)?
                }
                (None, Some(opening)) if centered => {
                    let circle = self.by_center(source, block, &ends)?;
                    end = opened(source, block, &ends, &circle, opening)?;
                    programmed = end;
                    circle
                }
                (None, Some(opening)) => by_opening(source, &ends, opening)?,
                (None, None) if centered => self.by_center(source, block, &ends)?,
                // In polar coordinates the pole is the centre.
                (None, None) if block.has_polar() => {
                    let mut center = self.state.pole;
                    center[across] = start[across];
                    Circle { center, normal: ends.normal }
                }
                _ if ways + usize::from(centered) > 1 => {
                    return error("the arc is given in two ways: I J K, CR= or AR=");
                }
                _ => return error("the arc has no centre: give I J K, CR= or AR="),
            }
        };
        let turns = turns(source, block)?;
        let radius = (start - circle.center).reject_from_normalized(circle.normal).length();
        let tolerance = RADIUS_ERROR.max(radius * RADIUS_ERROR_FACTOR);
        match Arc::new(start, end, circle.center, circle.normal, turns, tolerance) {
            Ok(_) => {}
            Err(ArcError::OffTheCircle(at_start, at_end)) => {
                let message = format!(
                    "the end is not on the circle: its radius is {at_start:.4} mm at the start and \
                     {at_end:.4} mm at the end (alarm 14040)"
                );
                return Err(source.block_error(Rule::ArcRadius, message));
            }
            Err(_) => return error("the arc has no radius"),
        }
        self.state.position = end;
        self.state.programmed = programmed;
        self.state.heading = circle.normal.cross(end - circle.center);
        let circle = Some((circle.center, circle.normal));
        let element = Element { start, end, circle, cut: turns == 0 };
        let mut action = self.piece(source, &element)?;
        if let Action::Arc(arc) = &mut action {
            arc.turns = turns;
        }
        if self.cornered(block) {
            return self.go_round(source, block, element, action);
        }
        self.emit(source, action)
    }

    /// `I J K`: from the start, whatever `G90` and `G91` say, unless `AC()` says otherwise.
    fn by_center(&self, source: &Source, block: &Block, ends: &Ends) -> Outcome<Circle> {
        let mut center = ends.start;
        for i in 0..3 {
            let Some(coordinate) = block.center[i] else { continue };
            if i == ends.across {
                let message = format!("{} is not in the plane of the arc", CENTER_NAMES[i]);
                return Err(source.block_error(Rule::Arc, message));
            }
            let count = match coordinate.count == Count::Modal {
                true => Count::Incremental,
                false => coordinate.count,
            };
            let coordinate = Coordinate { count, ..coordinate };
            center[i] = self.linear(source, coordinate, ends.start[i], CENTER_NAMES[i])?;
        }
        Ok(Circle { center, normal: ends.normal })
    }

    /// `CT`: goes on in the direction of the last move in the plane.
    fn tangential(&self, source: &Source, block: &Block, ends: &Ends) -> Outcome<Circle> {
        let error = |message: &str| Err(source.block_error(Rule::Arc, message));
        if block.has_arc_word() {
            return error("CT takes the end of the arc only");
        }
        let up = Vec3::AXES[ends.across];
        let heading = self.state.heading.reject_from_normalized(up);
        let Some(left) = direction(up.cross(heading)) else {
            return error("CT, and no move in the plane before it whose direction is known");
        };
        let chord = (ends.end - ends.start).reject_from_normalized(up);
        let aside = left.dot(chord);
        // Farther than any machine the arc is a line.
        if aside.abs() <= 1e-9 * chord.length() || chord == Vec3::ZERO {
            return error("the end of CT lies in the direction of the last move: there is no arc");
        }
        let height = chord.length_squared() / (2.0 * aside);
        Ok(Circle { center: ends.start + left * height, normal: up * height.signum() })
    }

    /// `CIP`: through `I1= J1= K1=`, which count like the end (`G90`, `G91`), in any plane.
    fn through_point(&self, source: &Source, block: &Block, ends: &Ends) -> Outcome<Circle> {
        let error = |message: &str| Err(source.block_error(Rule::Arc, message));
        let other_word = block.center.iter().any(Option::is_some)
            || block.radius.is_some()
            || block.opening.is_some()
            || block.turns.is_some();
        if other_word {
            return error("CIP takes the end and I1= J1= K1= only");
        }
        let mut point = ends.start;
        for i in 0..3 {
            match block.through[i] {
                Some(coordinate) => {
                    point[i] = self.linear(source, coordinate, ends.start[i], CENTER_NAMES[i])?;
                }
                None if ends.end[i] == ends.start[i] => {}
                None => return error("CIP needs I1=, J1= and K1= for each axis that moves"),
            }
        }
        match arc::through(ends.start, point, ends.end) {
            Some((center, normal)) => Ok(Circle { center, normal }),
            None => error("the three points of CIP lie on a line (alarm 14920)"),
        }
    }
}

/// An arc that also moves across its plane must name both axes of the plane: the 828D takes a missing
/// one for a wrong centre (seen on the machine).
fn check_helix(source: &Source, block: &Block, ends: &Ends) -> Outcome {
    if ends.end[ends.across] == ends.start[ends.across]
        || block.opening.is_some()
        || block.has_polar()
    {
        return Ok(());
    }
    for i in (0..3).filter(|i| *i != ends.across) {
        if block.axes[i].is_none() {
            let message = format!(
                "an arc that moves {} too must have {}, also where it does not change",
                AXIS_NAMES[ends.across], AXIS_NAMES[i]
            );
            return Err(source.block_error(Rule::HelixEndPoint, message));
        }
    }
    Ok(())
}

/// The chord of an arc in its plane: its middle, its half length, and the unit vector to its left.
fn chord(source: &Source, ends: &Ends) -> Outcome<(Vec3, f64, Vec3)> {
    let chord = (ends.end - ends.start).reject_from_normalized(ends.normal);
    let length = chord.length();
    if length <= 1e-9 {
        let message = "a full circle needs its centre (I J K): start and end are one point";
        return Err(source.block_error(Rule::Arc, message));
    }
    Ok((ends.start + chord / 2.0, length / 2.0, ends.normal.cross(chord / length)))
}

/// `CR=`: positive up to half a circle, negative above. The centre lies to the left of the chord of
/// a shorter arc.
fn by_radius(source: &Source, ends: &Ends, radius: f64) -> Outcome<Circle> {
    let (middle, half, left) = chord(source, ends)?;
    let size = radius.abs();
    if half > size + RADIUS_ERROR.max(size * RADIUS_ERROR_FACTOR) {
        let message = format!(
            "the radius of {size} mm does not reach: start and end are {:.4} mm apart (alarm 14040)",
            2.0 * half
        );
        return Err(source.block_error(Rule::ArcRadius, message));
    }
    let height = (size * size - half * half).max(0.0).sqrt().copysign(radius);
    Ok(Circle { center: middle + left * height, normal: ends.normal })
}

/// `AR=` with the end point.
fn by_opening(source: &Source, ends: &Ends, opening: f64) -> Outcome<Circle> {
    check_opening(source, opening)?;
    let (middle, half, left) = chord(source, ends)?;
    let height = half / (opening / 2.0).to_radians().tan();
    Ok(Circle { center: middle + left * height, normal: ends.normal })
}

/// `AR=` with the centre: the end point.
fn opened(
    source: &Source,
    block: &Block,
    ends: &Ends,
    circle: &Circle,
    opening: f64,
) -> Outcome<Vec3> {
    check_opening(source, opening)?;
    if (0..3).any(|i| i != ends.across && block.axes[i].is_some()) {
        let message = "the arc has an end point, a centre and an opening angle";
        return Err(source.block_error(Rule::Arc, message));
    }
    let spoke = ends.start - circle.center;
    let mut end = circle.center + rotate(spoke, ends.normal, opening.to_radians());
    end[ends.across] = ends.end[ends.across];
    Ok(end)
}

fn check_opening(source: &Source, opening: f64) -> Outcome {
    if opening > 0.0 && opening < 360.0 {
        return Ok(());
    }
    Err(source.block_error(Rule::Arc, "the opening angle AR= is between 0 and 360 degrees"))
}

fn turns(source: &Source, block: &Block) -> Outcome<u32> {
    match block.turns {
        None => Ok(0),
        Some(turns) if turns.fract() == 0.0 && (0.0..=MOST_TURNS).contains(&turns) => {
            Ok(turns as u32)
        }
        Some(_) => Err(source.block_error(Rule::Arc, "TURN= is a whole number from 0 to 999")),
    }
}
