//! The path between the ends of a move, as positions of the axes.

use control::{Orientation, Position};
use geom::Arc;

/// The most points of one rapid in a picture.
pub(crate) const MOST_PLACES: f64 = 1440.0;

/// Positions of a block between which the axes go nearly straight; the last is its end.
pub(crate) fn between(
    from: &Position,
    to: &Position,
    arc: Option<&control::ArcTo>,
) -> Vec<Position> {
    let arc = arc.and_then(|arc| {
        let ends = (from.point, arc.end.point);
        Arc::new(ends.0, ends.1, arc.center, arc.normal, arc.turns, f64::INFINITY).ok()
    });
    let followed = |position: &Position| {
        let Orientation::Rotary { degrees, tool_center: true } = position.orientation else {
            return None;
        };
        Some(degrees)
    };
    let turns = followed(from).zip(followed(to));
    let turn =
        turns.map_or(0.0, |(a, b)| (0..3).map(|i| f64::abs(b[i] - a[i])).fold(0.0, f64::max));
    let sweep = arc.map_or(0.0, |arc| arc.sweep.to_degrees() / 2.0);
    let places = turn.max(sweep).ceil().clamp(1.0, MOST_PLACES) as u32;
    let place = |i: u32| {
        let part = f64::from(i) / f64::from(places);
        let point = arc.map_or_else(|| from.point.lerp(to.point, part), |arc| arc.at(part));
        let orientation = match turns {
            Some((a, b)) => Orientation::Rotary {
                degrees: std::array::from_fn(|k| a[k] + (b[k] - a[k]) * part),
                tool_center: true,
            },
            None => to.orientation,
        };
        Position { point, orientation }
    };
    (1..=places).map(place).collect()
}
