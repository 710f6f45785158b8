//! How high a program goes.

use crate::{ArcTo, Cycle, Op, Pose, Program};
use geom::{Mat3, Vec3, angle_between, reach_of_box};
use std::collections::HashSet;
use std::sync::OnceLock;

/// A program that stays below its zero may be within a hole from there: it counts as going so far above zero, mm.
const ABOVE_ZERO: f64 = 1.0;

/// A tool that rises along Z by less than this part of its way along itself lies rather than stands: it leans by more than 60 degrees.
pub const LYING: f64 = 0.5;

/// So many points are looked at one by one.
const FEW: usize = 16;

/// The places to which a program goes, and how high the highest of them is.
#[derive(Clone, Debug)]
pub struct Tops<'p> {
    program: &'p Program,
    /// How high it goes along Z, mm.
    along_z: f64,
    below_zero: Option<f64>,
    /// Whether the tool stands anywhere.
    stands: bool,
    /// Its places, once they are looked at along another axis than Z.
    tree: OnceLock<Tree<Vec3>>,
    /// The ways in, once they are asked for.
    ways_in: OnceLock<WaysIn>,
}

/// The ways in, so arranged that few of them are looked at.
#[derive(Clone, Debug)]
struct WaysIn {
    /// Their axes as points, by boxes.
    tree: Tree<WayIn>,
    /// Around the axes of each box a narrower one, flat as the unit sphere is there: its corners, and how high the program goes along these, multiplied by
    /// their distance from the origin. That is convex (the highest of many products), so that within a box nothing is greater than at one of its corners.
    corners: Vec<[WayIn; 8]>,
}

/// An axis with which the tool comes to its first place, or to that behind a call of a tool or way home.
#[derive(Clone, Copy, Debug)]
struct WayIn {
    axis: Vec3,
    /// How high the program goes along it, mm.
    height: f64,
}

/// Points, so arranged that the highest along any axis is found without a look at each, and the like.
#[derive(Clone, Debug)]
struct Tree<P> {
    points: Vec<P>,
    /// Boxes around halves of the points, halves of these and so on: each before those of its own halves.
    boxes: Vec<PointBox>,
}

/// What is in a tree.
trait Point {
    /// Where it is.
    fn place(&self) -> Vec3;
}

impl Point for Vec3 {
    fn place(&self) -> Vec3 {
        *self
    }
}

impl Point for WayIn {
    fn place(&self) -> Vec3 {
        self.axis
    }
}

/// The box around some of the points.
#[derive(Clone, Copy, Debug)]
struct PointBox {
    low: Vec3,
    high: Vec3,
    /// The first point, and the one behind the last.
    points: [usize; 2],
    /// The number of the box of the second half; 0 where the points are few.
    second: usize,
}

impl Tops<'_> {
    /// Those of `program`, in the work frame: where its motions end, how high its arcs rise along the tool, and the heights from which
    /// and to which the tool goes at its holes. Where all are below zero, which is then the part's top for all that is known, the same places 1 mm
    /// above it, too.
    pub fn of(program: &Program) -> Tops<'_> {
        let (mut highest, mut stands) = (f64::NEG_INFINITY, false);
        places(program, |place, axis| {
            highest = highest.max(place.dot(Vec3::Z));
            stands |= axis.z >= LYING;
        });
        let below_zero = (highest < 0.0 && highest > f64::NEG_INFINITY).then_some(highest);
        let along_z = if below_zero.is_some() { ABOVE_ZERO } else { highest };
        let (tree, ways_in) = (OnceLock::new(), OnceLock::new());
        Tops { program, along_z, below_zero, stands, tree, ways_in }
    }

    /// How high the program goes along `axis`, a unit vector, mm from the origin, however its tool leans: from below that nobody knows what
    /// is around the tool elsewhere than on the program's own way. −∞ where it goes nowhere.
    pub fn along(&self, axis: Vec3) -> f64 {
        // A mill without rotary axes asks for no other: to arrange millions of places takes seconds.
        if axis == Vec3::Z {
            return self.along_z;
        }
        let tree = || {
            let mut points = Vec::new();
            places(self.program, |place, _| points.push(place));
            if self.below_zero.is_some() {
                let above = points.iter().map(|point: &Vec3| point.with_z(ABOVE_ZERO));
                points.extend(above.collect::<Vec<_>>());
            }
            Tree::of(points)
        };
        let most = |_, around: &PointBox| reach_of_box(around.low, around.high, axis);
        self.tree.get_or_init(tree).most(f64::NEG_INFINITY, &most, &|point| point.dot(axis))
    }

    /// How high the program goes along Z, mm. −∞ where its tool lies wherever it goes, or points down: Z says nothing then of where the part ends, which may
    /// be clamped on any of its sides.
    pub fn upward(&self) -> f64 {
        if self.stands { self.along_z } else { f64::NEG_INFINITY }
    }

    /// The greatest `measure`, or `least` if that is greater, of the ways in: where the tool stands nowhere, the other axes with which it comes in from home and
    /// from which one that leans as `axis` differs by no more than 60 degrees. As high along itself alone, such a tool would be deep in a pocket of a side
    /// wall, far from where it came in, on the side to which it leans.
    ///
    /// `measure` is told how far `tip` is along the way below the highest place of the program, mm, and the cosine between the way and `axis`. It may not
    /// fall with the first, and rises or falls with the second. Among many ways few are looked at.
    pub fn along_ways_in(
        &self,
        (tip, axis): (Vec3, Vec3),
        least: f64,
        measure: impl Fn(f64, f64) -> f64,
    ) -> f64 {
        if self.stands {
            return least;
        }
        let ways = self.ways_in.get_or_init(|| WaysIn::of(self));
        let most = |number: usize, _: &PointBox| {
            let (mut low, mut high, mut short) =
                (f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
            for corner in &ways.corners[number] {
                let cosine = corner.axis.dot(axis);
                (low, high) = (low.min(cosine), high.max(cosine));
                short = short.max(corner.height - tip.dot(corner.axis));
            }
            match high >= LYING {
                true => measure(short, low.max(LYING)).max(measure(short, high)),
                false => f64::NEG_INFINITY,
            }
        };
        let value = |way: &WayIn| {
            let cosine = way.axis.dot(axis);
            match cosine >= LYING && way.axis != axis {
                true => measure(way.height - tip.dot(way.axis), cosine),
                false => f64::NEG_INFINITY,
            }
        };
        ways.tree.most(least, &most, &value)
    }

    /// How high a program goes that stays below its zero, Z in mm; `None` of one that does not.
    pub fn below_zero(&self) -> Option<f64> {
        self.below_zero
    }
}

/// Tells each place to which a program goes, and the tool axis there.
fn places(program: &Program, mut tell: impl FnMut(Vec3, Vec3)) {
    let mut here: Option<Pose> = None;
    let mut cycle: Option<&Cycle> = None;
    for record in program.each() {
        if let Op::Cycle(new) = &record.op {
            cycle = Some(new);
        }
        let Some(pose) = record.op.pose() else { continue };
        let height = if matches!(record.op, Op::Hole(_)) {
            cycle.map_or(0.0, |cycle| cycle.clearance.max(cycle.retract))
        } else if let Op::Arc(to) = &record.op {
            rise(here, to)
        } else {
            0.0
        };
        tell(pose.point() + pose.axis() * height, pose.axis());
        here = Some(*pose);
    }
}

/// The axes with which the tool comes in, each once.
fn ways_in(program: &Program) -> Vec<Vec3> {
    let (mut ways, mut known, mut comes) = (Vec::new(), HashSet::new(), true);
    for record in program.each() {
        comes |= matches!(record.op, Op::Tool(_) | Op::Home);
        let Some(pose) = record.op.pose() else { continue };
        let axis = pose.axis();
        if std::mem::take(&mut comes) && known.insert(axis.to_array().map(f64::to_bits)) {
            ways.push(axis);
        }
    }
    ways
}

impl WaysIn {
    fn of(tops: &Tops) -> WaysIn {
        let ways = ways_in(tops.program).into_iter();
        let tree = Tree::of(ways.map(|axis| WayIn { axis, height: tops.along(axis) }).collect());
        let around = |points: [usize; 2]| {
            corners(&tree.points[points[0]..points[1]])
                .map(|axis| WayIn { axis, height: tops.along(axis) })
        };
        let corners = tree.boxes.iter().map(|of| around(of.points)).collect();
        WaysIn { tree, corners }
    }
}

/// The corners of a box around axes, one side of which is across their middle.
fn corners(ways: &[WayIn]) -> [Vec3; 8] {
    let middle: Vec3 = ways.iter().map(|way| way.axis).sum();
    let out = middle.try_normalize().unwrap_or(Vec3::Z);
    let (right, up) = out.any_orthonormal_pair();
    let frame = Mat3::from_cols(right, up, out);
    let places = ways.iter().map(|way| frame.transpose() * way.axis);
    let low = places.clone().fold(Vec3::INFINITY, Vec3::min);
    let high = places.fold(Vec3::NEG_INFINITY, Vec3::max);
    std::array::from_fn(|i| {
        let of = |bit: usize, low: f64, high: f64| if i & bit == 0 { low } else { high };
        frame * Vec3::new(of(1, low.x, high.x), of(2, low.y, high.y), of(4, low.z, high.z))
    })
}

impl<P: Point> Tree<P> {
    fn of(points: Vec<P>) -> Tree<P> {
        let boxes = Vec::with_capacity(2 * points.len() / FEW + 1);
        let mut tree = Tree { boxes, points };
        if !tree.points.is_empty() {
            tree.divide([0, tree.points.len()]);
        }
        tree
    }

    /// The greatest `value` of a point, or `least` if that is greater. None in a box is greater than `most` says.
    fn most(
        &self,
        least: f64,
        most: &impl Fn(usize, &PointBox) -> f64,
        value: &impl Fn(&P) -> f64,
    ) -> f64 {
        let mut greatest = least;
        if let Some(all) = self.boxes.first() {
            self.look((0, most(0, all)), most, value, &mut greatest);
        }
        greatest
    }

    /// Puts a box around points, and others around each half of them.
    fn divide(&mut self, [first, end]: [usize; 2]) {
        let points = &mut self.points[first..end];
        let places = points.iter().map(P::place);
        let low = places.clone().fold(Vec3::INFINITY, Vec3::min);
        let high = places.fold(Vec3::NEG_INFINITY, Vec3::max);
        let number = self.boxes.len();
        self.boxes.push(PointBox { low, high, points: [first, end], second: 0 });
        if points.len() <= FEW {
            return;
        }
        let wide = high - low;
        let longest = if wide.x >= wide.y { 0 } else { 1 };
        let longest = if wide[longest] >= wide.z { longest } else { 2 };
        let half = points.len() / 2;
        points
            .select_nth_unstable_by(half, |a, b| a.place()[longest].total_cmp(&b.place()[longest]));
        self.divide([first, first + half]);
        self.boxes[number].second = self.boxes.len();
        self.divide([first + half, end]);
    }

    /// Looks for a point of greater value within a box, of which none is greater than its bound.
    fn look(
        &self,
        (number, bound): (usize, f64),
        most: &impl Fn(usize, &PointBox) -> f64,
        value: &impl Fn(&P) -> f64,
        greatest: &mut f64,
    ) {
        let PointBox { points: [first, end], second, .. } = self.boxes[number];
        if bound <= *greatest {
            return;
        }
        if second == 0 {
            *greatest = self.points[first..end].iter().map(value).fold(*greatest, f64::max);
            return;
        }
        let mut halves = [number + 1, second].map(|half| (half, most(half, &self.boxes[half])));
        if halves[1].1 > halves[0].1 {
            halves.reverse();
        }
        for half in halves {
            self.look(half, most, value, greatest);
        }
    }
}

/// How far an arc rises along the tool above its end, mm. One across the tool is as high as its ends.
fn rise(from: Option<Pose>, to: &ArcTo) -> f64 {
    let (end, axis) = (to.end.point(), to.end.axis());
    let start = from.map_or(end, |from| from.point());
    if angle_between(to.circle.normal(), axis).sin() < 1e-9 {
        return 0.0;
    }
    to.circle.arc(start, end, f64::MAX).map_or(0.0, |arc| {
        let (low, high) = arc.extents();
        reach_of_box(low, high, axis) - end.dot(axis)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Circle, CycleKind};

    fn program(ops: impl IntoIterator<Item = Op>) -> Program {
        let mut program = Program::new("t");
        for (line, op) in (1..).zip(ops) {
            program.push(line, op);
        }
        program
    }

    /// The numbers of a linear congruential generator (Knuth's MMIX), 0 to 1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 7_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn the_tree_finds_what_a_look_at_each_point_finds() {
        let mut number = numbers();
        let mut any = || Vec3::new(number(), number(), number()) * 2.0 - 1.0;
        let points: Vec<Vec3> = (0..3000).map(|_| any() * 200.0).collect();
        let rapids = points.iter().map(|point| Op::Rapid(Pose::upright(*point).unwrap()));
        let program = program(rapids);
        let tops = Tops::of(&program);
        for axis in std::iter::repeat_with(|| any().normalize()).take(200).chain([Vec3::Z]) {
            let heights = points.iter().map(|point| point.dot(axis));
            assert_eq!(tops.along(axis), heights.fold(f64::NEG_INFINITY, f64::max));
        }
        assert_eq!(Tops::of(&Program::new("t")).along(Vec3::Z), f64::NEG_INFINITY);
    }

    #[test]
    fn what_stays_below_zero_counts_as_going_above_it() {
        let at = |z: f64| Op::Rapid(Pose::upright(Vec3::new(100.0, 50.0, z)).unwrap());
        let [below, above] = [[-40.0, -30.0], [-40.0, 0.0]].map(|z| program(z.map(at)));
        let [below, above] = [&below, &above].map(Tops::of);
        assert_eq!(below.below_zero(), Some(-30.0));
        assert_eq!(below.along(Vec3::X), 100.0);
        assert_eq!(above.below_zero(), None);
        // Along Z, and along an axis that is Z but for rounding, which is looked for among the places.
        for axis in [Vec3::Z, Vec3::new(1e-12, 0.0, 1.0)] {
            let heights = [&below, &above].map(|tops| tops.along(axis));
            assert!((heights[0] - 1.0).abs() < 1e-9 && heights[1].abs() < 1e-9, "{heights:?}");
        }
    }

    #[test]
    fn places_are_arranged_where_another_axis_than_z_is_asked_for() {
        let program = program([Op::Rapid(Pose::upright(Vec3::ONE).unwrap())]);
        let tops = Tops::of(&program);
        assert_eq!((tops.along(Vec3::Z), tops.upward()), (1.0, 1.0));
        assert!(tops.tree.get().is_none());
        assert_eq!(tops.along(Vec3::X), 1.0);
        assert!(tops.tree.get().is_some());
    }

    #[test]
    fn along_z_counts_where_the_tool_stands_anywhere() {
        let lean = |degrees: f64, z: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Op::Rapid(Pose::new(Vec3::new(0.0, 0.0, z), Vec3::new(sin, 0.0, cos)).unwrap())
        };
        let upward = |leans: [f64; 2]| {
            Tops::of(&program([lean(leans[0], 5.0), lean(leans[1], 40.0)])).upward()
        };
        assert_eq!(upward([0.0, 90.0]), 40.0);
        assert_eq!(upward([59.0, 180.0]), 40.0);
        assert_eq!(upward([61.0, 90.0]), f64::NEG_INFINITY);
        assert_eq!(upward([180.0, 100.0]), f64::NEG_INFINITY);
    }

    #[test]
    fn where_no_tool_stands_the_ways_in_count_to_which_it_leans_near() {
        let lean = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Vec3::new(cos, sin, 0.0)
        };
        let at = |degrees: f64| Op::Rapid(Pose::new(Vec3::ZERO, lean(degrees)).unwrap());
        // The cosines of the angles from the nearest and to the farthest way.
        let ways_in = |tops: &Tops, degrees: f64| {
            let of = (Vec3::ZERO, lean(degrees));
            let nearest = tops.along_ways_in(of, f64::NEG_INFINITY, |_, cosine| cosine);
            let farthest = -tops.along_ways_in(of, f64::NEG_INFINITY, |_, cosine| -cosine);
            [nearest, farthest].map(|cosine| match cosine.is_finite() {
                true => Some(cosine.acos().to_degrees().round()),
                false => None,
            })
        };
        let comes_in = program([at(0.0), at(40.0), Op::Home, at(90.0), Op::Home, at(0.0)]);
        let tops = Tops::of(&comes_in);
        assert_eq!(ways_in(&tops, 0.0), [None; 2]);
        assert_eq!(ways_in(&tops, 20.0), [Some(20.0); 2]);
        assert_eq!(ways_in(&tops, 40.0), [Some(40.0), Some(50.0)]);
        assert_eq!(ways_in(&tops, 70.0), [Some(20.0); 2]);
        assert_eq!(ways_in(&tops, 151.0), [None; 2]);
        let upright = Op::Rapid(Pose::upright(Vec3::ZERO).unwrap());
        assert_eq!(ways_in(&Tops::of(&program([at(0.0), upright])), 20.0), [None; 2]);
    }

    /// A program that comes in so often, by axes that lie or point down, at places 100 mm around the origin.
    fn comes_in(count: usize) -> Program {
        let mut number = numbers();
        let ops = (0..count).flat_map(|_| {
            let (z, turn) = (number() * 1.45 - 1.0, number() * std::f64::consts::TAU);
            let across = (1.0 - z * z).sqrt();
            let axis = Vec3::new(across * turn.cos(), across * turn.sin(), z);
            let place = Vec3::new(number() - 0.5, number() - 0.5, number() - 0.5) * 200.0;
            [Op::Home, Op::Rapid(Pose::new(place, axis).unwrap())]
        });
        program(ops.collect::<Vec<_>>())
    }

    #[test]
    fn the_tree_of_ways_in_finds_what_a_look_at_each_finds() {
        let program = comes_in(500);
        let tops = Tops::of(&program);
        let ways = ways_in(&program);
        assert_eq!(ways.len(), 500);
        let measures: [fn(f64, f64) -> f64; 3] = [
            |short, _| short,
            |short, cosine| (short + 0.5) / cosine,
            |short, cosine| short + cosine,
        ];
        let mut number = numbers();
        for axis in &ways {
            let tip = Vec3::new(number() - 0.5, number() - 0.5, number() - 0.5) * 500.0;
            for measure in measures {
                let near = ways.iter().filter(|way| way.dot(*axis) >= LYING && *way != axis);
                let each =
                    near.map(|way| measure(tops.along(*way) - tip.dot(*way), way.dot(*axis)));
                let greatest = each.fold(-20.0, f64::max);
                let found = tops.along_ways_in((tip, *axis), -20.0, measure);
                assert!((found - greatest).abs() < 1e-9, "{found} {greatest}");
            }
        }
    }

    /// Each axis asks once, with its tip where the program comes in by it: all were looked at each time, 10^10 times in all.
    #[test]
    fn a_hundred_thousand_ways_in_are_not_all_looked_at_by_each() {
        let count = 100_000;
        let program = comes_in(count);
        let tops = Tops::of(&program);
        let looks = std::cell::Cell::new(0_usize);
        for pose in program.records.iter().filter_map(|record| record.op.pose()) {
            let measure = |short: f64, _: f64| {
                looks.set(looks.get() + 1);
                short
            };
            tops.along_ways_in((pose.point(), pose.axis()), 0.1, measure);
        }
        let most = 32.0 * count as f64 * (count as f64).log2();
        assert!((looks.get() as f64) < most, "{} looks, {most} are the most", looks.get());
    }

    /// By hand: over a hole at Z 0 the tool goes 7 mm back, and half a circle of radius 10 that stands upright rises to Z 10.
    #[test]
    fn holes_count_with_their_heights_and_arcs_with_their_rise() {
        let at = |x: f64| Pose::upright(Vec3::new(x, 0.0, 0.0)).unwrap();
        let cycle = Cycle {
            kind: CycleKind::Drill,
            depth: 20.0,
            clearance: 2.0,
            retract: 7.0,
            feed: None,
            dwell: 0.0,
            first_peck: None,
            peck: None,
        };
        let hole = program([Op::Cycle(Box::new(cycle)), Op::Hole(at(0.0))]);
        assert_eq!(Tops::of(&hole).along(Vec3::Z), 7.0);
        let circle = |normal: Vec3| Circle::new(Vec3::ZERO, normal, 0).unwrap();
        let half =
            |normal: Vec3| Op::Arc(Box::new(ArcTo { end: at(10.0), circle: circle(normal) }));
        let over = program([Op::Rapid(at(-10.0)), half(Vec3::Y)]);
        assert!((Tops::of(&over).along(Vec3::Z) - 10.0).abs() < 1e-9);
        let flat = program([Op::Rapid(at(-10.0)), half(Vec3::Z)]);
        assert_eq!(Tops::of(&flat).along(Vec3::Z), 0.0);
    }
}
