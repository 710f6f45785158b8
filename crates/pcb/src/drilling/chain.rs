//! Slots made of holes that overlap.

use crate::merge::pitch;
use geom::Vec2;

/// More holes for a slot than this are not drilled.
const MOST: usize = 10_000;

/// Where to drill from `a` to `b`, in order, so that what stays between the holes along the wall is nowhere
/// higher than `scallop` mm; `None` where that takes too many. Every hole has solid material all
/// around, or as much of it on its one side along the slot as on the other: so the drill does not
/// wander. Only the ends of a slot that is shorter than the drill is wide overlap each other.
pub(super) fn places(a: Vec2, b: Vec2, drill: f64, scallop: f64) -> Option<Vec<Vec2>> {
    let length = a.distance(b);
    let pitch = pitch(drill, scallop);
    let fewest = length / pitch;
    if fewest.is_nan() || fewest > MOST as f64 {
        return None;
    }
    if length == 0.0 {
        return Some(vec![a]);
    }
    // At first holes next to each other, then one in the middle between each two, and again.
    let mut parts = ((length / drill).floor() as usize).max(1);
    let place = |part: usize, parts: usize| a.lerp(b, part as f64 / parts as f64);
    let mut places: Vec<Vec2> = (0..=parts).map(|part| place(part, parts)).collect();
    while length / parts as f64 > pitch {
        parts *= 2;
        let middles = (1..parts).step_by(2).map(|part| place(part, parts));
        // From where the drill is.
        let back = places.last().is_some_and(|last| last.distance(b) < last.distance(a));
        if back { places.extend(middles.rev()) } else { places.extend(middles) }
    }
    Some(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_first_and_then_the_middles() {
        let place = |x: f64| Vec2::new(x, 0.0);
        // Drill 1 mm: at 0.6 mm apart 0.1 mm stays (3-4-5). 2.4 mm: 0, 1.2, 2.4, and halves of 0.6.
        let found = places(place(0.0), place(2.4), 1.0, 0.1001).unwrap();
        assert_eq!(found.len(), 5);
        for (found, expected) in found.iter().zip([0.0, 1.2, 2.4, 1.8, 0.6]) {
            assert!(found.distance(place(expected)) < 1e-12);
        }
        assert_eq!(places(place(0.0), place(2.4), 1.0, 0.0999).unwrap().len(), 9);
        assert_eq!(places(place(1.0), place(1.0), 1.0, 0.1), Some(vec![place(1.0)]));
        assert_eq!(places(place(0.0), place(900.0), 0.3, 1e-9), None);
    }
}
