//! Two regions whose boundaries run next to each other, between 1 nm and 5 µm apart, and what booleans
//! make of them.

use super::board::Random;
use super::{NEAR, crossing};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toolpost_geom::region::{Cap, Fill, Region, Ring};
use toolpost_geom::{Element, Vec2};

/// A region and another nearly like it.
pub struct Pair {
    pub first: Region,
    pub second: Region,
}

/// One of a few shapes; the second is moved, turned, grown or flattened by next to nothing.
pub fn pair(random: &mut Random) -> Pair {
    let kind = random.below(6);
    let size = 0.3 + 2.0 * random.unit();
    let narrow = 0.2 + 0.6 * random.unit();
    let at = Vec2::new(150.0, -94.0) * random.below(2) as f64;
    let turned = TAU * random.unit();
    let first = form(kind, size, narrow);
    let tiny =
        |random: &mut Random| 1e-6 * 5000f64.powf(random.unit()) * [-1.0, 1.0][random.below(2)];
    let by = tiny(random);
    let (mut second, mut at_second, mut turned_second) = (first.clone(), at, turned);
    match random.below(6) {
        0 => at_second += Vec2::from_angle(TAU * random.unit()) * by,
        1 => turned_second += by / size,
        2 => second = form(kind, size + by, narrow),
        3 => second = form(kind, size, narrow + by / size),
        4 => second = first.iter().flat_map(|element| flat(element, by.abs())).collect(),
        _ => {
            second = form(kind, size + by, narrow + tiny(random));
            at_second += Vec2::from_angle(TAU * random.unit()) * tiny(random);
            turned_second += tiny(random) / size;
        }
    }
    let region = |elements: &[Element], turned: f64, at: Vec2| {
        let place = |p: Vec2| Vec2::from_angle(turned).rotate(p) + at;
        let element = |e: &Element| match e.turn {
            Some(turn) => {
                Element::arc(place(e.start), place(e.end), place(turn.center), turn.sweep)
            }
            None => Element::line(place(e.start), place(e.end)),
        };
        let ring = Ring::new(elements.iter().map(element).collect()).unwrap();
        Region::inside(&[ring], Fill::NonZero).unwrap()
    };
    Pair { first: region(&first, turned, at), second: region(&second, turned_second, at_second) }
}

/// The boundary of a shape.
fn form(kind: usize, size: f64, narrow: f64) -> Vec<Element> {
    let at = |angle: f64, radius: f64| Vec2::from_angle(angle) * radius;
    let line = Element::line;
    let of = |region: Region| region.rings().next().unwrap().elements().to_vec();
    match kind {
        0 => of(Region::disc(Vec2::ZERO, size).unwrap()),
        1 => of(Region::stroke(&line(Vec2::ZERO, Vec2::X * size), narrow, Cap::Round).unwrap()),
        2 => {
            let middle = Element::arc(at(0.3, size), at(1.7, size), Vec2::ZERO, 1.4);
            of(Region::stroke(&middle, narrow * size, Cap::Round).unwrap())
        }
        // A square with round corners.
        3 => {
            let (half, radius) = (size, size * narrow);
            let mut elements = Vec::new();
            for quarter in 0..4 {
                let turn = |p: Vec2| at(f64::from(quarter) * FRAC_PI_2, 1.0).rotate(p);
                let center = Vec2::splat(half - radius);
                let (from, to) = (center + Vec2::X * radius, center + Vec2::Y * radius);
                let before = Vec2::new(half, radius - half);
                elements.push(line(turn(before), turn(from)));
                elements.push(Element::arc(turn(from), turn(to), turn(center), FRAC_PI_2));
            }
            elements
        }
        // A wide arc, a narrow one of hardly any angle and a line, each tangent to the one before.
        4 => {
            let angle = 0.002 + 0.01 * narrow;
            let wide = Element::arc(at(0.0, size), at(0.8, size), Vec2::ZERO, 0.8);
            let center = at(0.8, size - narrow);
            let end = center + at(0.8 + angle, narrow);
            let arc = Element::arc(wide.end, end, center, angle);
            let last = end + at(0.8 + angle, size).perp();
            vec![wide, arc, line(end, last), line(last, Vec2::ZERO), line(Vec2::ZERO, wide.start)]
        }
        // A half disc on a line that its arc is tangent to at one end.
        _ => {
            let (from, to) = (Vec2::X * size, Vec2::NEG_X * size);
            let low = Vec2::new(-size, -size);
            vec![Element::arc(from, to, Vec2::ZERO, PI), line(to, low), line(low, from)]
        }
    }
}

/// An element as chords whose middles are `error` away from it.
fn flat(element: &Element, error: f64) -> Vec<Element> {
    let Some(turn) = element.turn else { return vec![*element] };
    let step = (8.0 * error / element.start.distance(turn.center)).sqrt();
    let steps = (turn.sweep.abs() / step).ceil().max(3.0) as usize;
    let at = |i: usize| element.at(i as f64 / steps as f64);
    (0..steps).map(|i| Element::line(at(i), at(i + 1))).collect()
}

/// Whether a point is in a result, by whether it is in the first and in the second.
type Rule = fn(bool, bool) -> bool;

/// Holds every boolean of the two against what is known of it without another boolean.
pub fn judge(Pair { first, second }: &Pair, random: &mut Random) {
    let union = first.union(second).unwrap();
    let common = first.intersection(second).unwrap();
    let (rest, other) = (first.difference(second).unwrap(), second.difference(first).unwrap());
    let either = first.xor(second).unwrap();

    let rings = || first.rings().chain(second.rings());
    let slack = NEAR * rings().map(Ring::length).sum::<f64>();
    let same = |what: &str, one: f64, two: f64| {
        assert!((one - two).abs() < slack, "{what}: {one} mm² and {two} mm², {slack} for rounding");
    };
    same("both", first.area() + second.area(), union.area() + common.area());
    same("first", first.area(), rest.area() + common.area());
    same("second", second.area(), other.area() + common.area());
    same("either", either.area(), union.area() - common.area());

    let away = |point: Vec2| rings().map(|ring| ring.distance(point)).fold(f64::INFINITY, f64::min);
    let points: Vec<(Vec2, bool, bool)> = rings()
        .flat_map(|ring| ring.elements())
        .flat_map(|element| [0.0, 0.5, random.unit()].map(|t| element.at(t)))
        .chain([Vec2::ZERO])
        .collect::<Vec<_>>()
        .into_iter()
        .map(|point| {
            point + Vec2::from_angle(TAU * random.unit()) * NEAR * 200f64.powf(random.unit())
        })
        .filter(|point| away(*point) > NEAR)
        .map(|point| (point, first.contains(point), second.contains(point)))
        .collect();
    let circles: Vec<(Vec2, f64, f64)> = rings()
        .flat_map(|ring| ring.elements())
        .filter_map(|element| Some((element.turn?, element.radius()?)))
        .map(|(turn, radius)| (turn.center, radius, turn.sweep.abs()))
        .collect();
    let results: [(&str, &Region, Rule); 5] = [
        ("union", &union, |a, b| a || b),
        ("intersection", &common, |a, b| a && b),
        ("difference", &rest, |a, b| a && !b),
        ("difference of the second", &other, |a, b| b && !a),
        ("xor", &either, |a, b| a != b),
    ];
    for (what, region, is_in) in results {
        crossing::never(region);
        for island in region.islands() {
            assert!(island.area() > 0.0, "{what}: an island of {} mm²", island.area());
        }
        for (point, a, b) in &points {
            assert_eq!(region.contains(*point), is_in(*a, *b), "{what}: {point}");
        }
        for element in region.rings().flat_map(|ring| ring.elements()) {
            for t in [0.0, 0.25, 0.5, 0.75] {
                let away = away(element.at(t));
                assert!(away < NEAR, "{what}: {element:?} is {away} mm off at {t}");
            }
            let Some(turn) = element.turn else { continue };
            let radius = element.start.distance(turn.center);
            // What is one circle is one arc again.
            let most: f64 = circles
                .iter()
                .filter(|(center, r, _)| {
                    center.distance(turn.center) < 2e-6 && (r - radius).abs() < 2e-6
                })
                .map(|(.., sweep)| *sweep)
                .sum();
            let over = (turn.sweep.abs() - most) * radius;
            assert!(over < NEAR, "{what}: {element:?} is {over} mm longer than what it is of");
        }
    }
}
