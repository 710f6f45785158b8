//! The holes of a board from its drill files.

use crate::excellon::Drill;
use crate::gerber::{Image, Object, Pen, Shape};
use crate::report::{Outcome, fault};
use crate::{Hole, HoleShape, SAME};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};
use std::collections::HashSet;

/// The holes of an Excellon file. What it does not say about their walls is `plated`.
pub(super) fn of_drill(drill: Drill, plated: Option<bool>) -> Vec<Hole> {
    let Drill { tools, cuts } = drill;
    let holes = cuts.into_iter().filter_map(|cut| {
        let tool = tools.get(cut.tool as usize)?;
        let (diameter, plated) = (tool.diameter, tool.plated.or(plated));
        let shape = match cut.path {
            // Some systems write slots so.
            HoleShape::Route(route) => match route[..] {
                [only] => drawn(only),
                _ => HoleShape::Route(route),
            },
            shape => shape,
        };
        Some(Hole { shape, diameter, plated })
    });
    holes.filter(|hole| hole.diameter > 0.0).collect()
}

/// The holes of a Gerber file, which flashes or draws them with circles.
///
/// # Errors
/// `hole-form` where it paints anything else.
pub(crate) fn of_image(image: &Image, plated: Option<bool>) -> Outcome<Vec<Hole>> {
    let hole = |object: &Object| {
        let odd = || {
            let help = "holes are circles that are flashed, slots are drawn with them";
            let mut found =
                fault(Rule::HoleForm, "something else than holes is on this layer", help);
            found.line = object.line;
            found
        };
        let (aperture, transform, shape) = match object.shape {
            _ if !object.dark => return Err(odd()),
            Shape::Flash { aperture, transform, at } => (aperture, transform, HoleShape::Round(at)),
            Shape::Stroke { aperture, transform, path } => (aperture, transform, drawn(path)),
            Shape::Region { .. } => return Err(odd()),
        };
        let pen = image.apertures.get(aperture as usize).and_then(|aperture| aperture.pen);
        match pen.map(|pen| (pen, transform.scale())) {
            Some((Pen::Round(diameter), scale)) if diameter * scale > 0.0 => {
                Ok(Hole { shape, diameter: diameter * scale, plated })
            }
            _ => Err(odd()),
        }
    };
    image.objects.iter().map(hole).collect()
}

fn drawn(path: Element) -> HoleShape {
    match path.turn {
        None if path.start == path.end => HoleShape::Round(path.start),
        None => HoleShape::Slot(path.start, path.end),
        Some(_) => HoleShape::Route(vec![path]),
    }
}

/// Leaves out holes that come again, which is a warning.
pub(crate) fn once(holes: &mut Vec<Hole>) -> Option<Diagnostic> {
    let mut seen = HashSet::with_capacity(holes.len());
    let all = holes.len();
    holes.retain(|hole| seen.insert(key(hole)));
    let again = all - holes.len();
    let message = format!("{again} holes come twice, at the same place and equally wide");
    let help = "they are made once; two files may hold the same holes";
    (again > 0).then(|| Diagnostic::warning(Rule::HoleTwice, message).help(help))
}

/// What holes that are the same have in common: their lengths in steps of [`SAME`], as a file in inches and
/// one in mm agree but for rounding. A slot is the same from either end.
fn key(hole: &Hole) -> Vec<i64> {
    let step = |length: f64| (length / SAME).round() as i64;
    let point = |p: Vec2| [step(p.x), step(p.y)];
    let mut key = vec![step(hole.diameter)];
    match &hole.shape {
        HoleShape::Round(at) => key.extend(point(*at)),
        HoleShape::Slot(from, to) => {
            let (from, to) = (point(*from), point(*to));
            key.extend([from.min(to), from.max(to)].concat());
        }
        HoleShape::Route(elements) => {
            for Element { start, end, turn } in elements {
                key.extend([*start, *end].into_iter().flat_map(point));
                let turn = turn.iter().flat_map(|turn| [turn.center.x, turn.center.y, turn.sweep]);
                key.extend(turn.map(step));
            }
        }
    }
    key
}
