//! Any bytes as a few discs, strokes and polygons, on a grid and off it, in two heaps: no panic, areas of
//! booleans add up, and no boundary crosses itself.
#![no_main]

use geom::region::{Cap, Fill, Region, Ring};
use geom::{Element, Vec2};
use libfuzzer_sys::fuzz_target;

/// Nearer than this is anything, mm.
const NEAR: f64 = 0.001;

/// The next number of the bytes, -32768 to 32767; 0 after the last.
fn next(bytes: &mut &[u8]) -> f64 {
    let Some((pair, rest)) = bytes.split_first_chunk::<2>() else { return 0.0 };
    *bytes = rest;
    i16::from_le_bytes(*pair).into()
}

/// A point within 8 mm, on a grid of 0.25 mm or less than 5 µm off it.
fn place(bytes: &mut &[u8]) -> Vec2 {
    let mut along = || {
        let value = next(bytes);
        let apart = (value.rem_euclid(512.0) - 256.0) / 256.0;
        (value / 1024.0).floor() * 0.25 + apart.powi(5) * 0.005
    };
    Vec2::new(along(), along())
}

/// A shape; `None` where the numbers make none.
fn shape(bytes: &mut &[u8]) -> Option<Region> {
    let kind = next(bytes) as i32;
    let (from, to) = (place(bytes), place(bytes));
    let size = (1.0 + next(bytes).abs() / 512.0).floor() * 0.05;
    match kind.rem_euclid(4) {
        0 => Region::disc(from, size),
        1 => Region::stroke(&Element::line(from, to), size, Cap::Round),
        2 => {
            let middle = (from + to) / 2.0;
            let arc = Element::arc(from, to, middle, std::f64::consts::PI);
            Region::stroke(&arc, size, if kind < 0 { Cap::Round } else { Cap::Square })
        }
        _ => {
            let ring = Ring::polygon(&[from, to, place(bytes), place(bytes)]).ok()?;
            Region::inside(&[ring], Fill::EvenOdd)
        }
    }
    .ok()
}

/// Its islands are something, and no element crosses another deeper than by rounding.
fn is_sound(region: &Region) {
    assert!(region.islands().iter().all(|island| island.area() > 0.0));
    let elements: Vec<&Element> = region.rings().flat_map(|ring| ring.elements()).collect();
    for (i, one) in elements.iter().enumerate() {
        for other in elements.iter().skip(i + 1) {
            let points: Vec<Vec2> = one.crossings(other).map(|crossing| crossing.point).collect();
            for point in &points {
                let along = |element: &Element| element.tangent(element.nearest(*point).0);
                let across = along(one).perp_dot(along(other)).abs();
                let ends = [one.start, one.end, other.start, other.end];
                let others = points.iter().filter(|other| *other != point);
                let apart = ends.iter().chain(others).map(|end| end.distance(*point) * across);
                let deep = apart.fold(f64::INFINITY, f64::min);
                assert!(deep < 3e-6, "{one:?} and {other:?} cross at {point}, {deep} mm deep");
            }
        }
    }
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = data;
    let mut heaps = [Vec::new(), Vec::new()];
    for i in 0..12 {
        heaps[i % 2].extend(shape(&mut bytes));
    }
    let [first, second] = heaps.map(|heap| Region::union_of(&heap).unwrap());
    let (union, common) = (first.union(&second).unwrap(), first.intersection(&second).unwrap());
    let (rest, either) = (first.difference(&second).unwrap(), first.xor(&second).unwrap());
    let length: f64 = first.rings().chain(second.rings()).map(Ring::length).sum();
    let same = |one: f64, two: f64| {
        assert!((one - two).abs() <= 1e-6 + NEAR * length, "{one} mm² and {two} mm²");
    };
    same(first.area() + second.area(), union.area() + common.area());
    same(first.area(), rest.area() + common.area());
    same(either.area(), union.area() - common.area());
    let distance = next(&mut bytes) / 65536.0;
    let apart = first.offset(distance).unwrap();
    assert!((apart.area() - first.area()) * distance >= -1e-6 - NEAR * length);
    [first, second, union, common, rest, either, apart].iter().for_each(is_sound);
});
