//! The ways around copper: hand calculation, and the distances of points to the copper.

use geom::Vec2;
use geom::region::Region;
use std::f64::consts::{PI, TAU};
use toolpost_pcb::isolation::{Direction, Isolation};
use toolpost_pcb::{Copper, Cutter};

/// A cut 0.2 mm wide.
const ISOLATION: Isolation = Isolation {
    cutter: Cutter::Cylinder { diameter: 0.2 },
    depth: 0.05,
    passes: 1,
    overlap: 0.0,
    direction: Direction::Climb,
};

/// Copper of unnamed islands.
fn copper(shapes: &[Region]) -> Copper {
    let region = Region::union_of(shapes).unwrap();
    Copper { nets: vec![None; region.islands().len()], region }
}

fn disc(x: f64, y: f64, radius: f64) -> Region {
    Region::disc(Vec2::new(x, y), radius).unwrap()
}

#[test]
fn around_a_pad_passes_are_circles_each_farther_out() {
    let two = Isolation { passes: 2, overlap: 0.25, ..ISOLATION };
    let paths = two.passes(&copper(&[disc(3.0, 4.0, 1.0)]), None).unwrap();
    // 0.1 mm from the copper, and three quarters of 0.2 mm farther.
    for (path, radius) in paths.iter().zip([1.1, 1.25]) {
        assert!(path.is_closed());
        assert!((path.length() - TAU * radius).abs() < 1e-6, "{}", path.length());
    }
    assert_eq!(paths.len(), 2);
}

#[test]
fn climbing_has_the_copper_on_its_right() {
    let ring = disc(0.0, 0.0, 3.0).difference(&disc(0.0, 0.0, 2.0)).unwrap();
    for (direction, side) in [(Direction::Climb, -1.0), (Direction::Conventional, 1.0)] {
        let paths =
            Isolation { direction, ..ISOLATION }.passes(&copper(&[ring.clone()]), None).unwrap();
        assert_eq!(paths.len(), 2);
        for path in paths {
            let element = path.elements()[0];
            let outside = element.start.length() > 2.5;
            let inwards = if outside { -element.start } else { element.start };
            assert!(element.tangent(0.0).perp().dot(inwards) * side > 0.0, "{direction:?}");
        }
    }
}

#[test]
fn a_way_ends_where_the_board_ends() {
    let area = disc(0.0, 0.0, 2.0);
    let paths = ISOLATION.passes(&copper(&[disc(2.0, 0.0, 0.9)]), Some(&area)).unwrap();
    let [path] = &*paths else { panic!("{paths:?}") };
    assert!(!path.is_closed());
    // Circles of radius 2 and 1, 2 apart: the part within is 2·acos(1/4) of the smaller.
    assert!((path.length() - 2.0 * 0.25f64.acos()).abs() < 1e-6);
    assert!((path.start().length() - 2.0).abs() < 1e-6 && (path.end().length() - 2.0).abs() < 1e-6);
    let inside = ISOLATION.passes(&copper(&[disc(0.0, 0.0, 0.9)]), Some(&area)).unwrap();
    assert!(inside[0].is_closed() && (inside[0].length() - 2.0 * PI).abs() < 1e-6);
}
