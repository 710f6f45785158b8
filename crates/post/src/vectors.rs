//! Where the rotary axes come while the control turns the tool along a vector: the tool goes on the great circle, and the
//! axes follow it from where they stand, without a jump.

use crate::sweep::short_way;
use geom::{Vec3, angle_between, between};
use machine::{Inverse, Machine, RotaryAxis, Solutions};

/// The longest turn of the tool between two places that are looked at, radians (1°).
const LONGEST: f64 = 0.0175;

/// The shortest, radians (0.002°): nearer than a few of these to a pole the tool goes through it.
const SHORTEST: f64 = 3.5e-5;

/// The longest turn of a rotary axis between two places that are looked at, degrees.
const TURN: f64 = 15.0;

/// Of two solutions that are nearer than this, degrees, the control may take either.
const ALIKE: f64 = 0.1;

/// Within this angle of a pole, degrees, the control leads a vector that goes past it through it (MD24530, as delivered).
const POLE_LIMIT: f64 = 2.0;

/// What is kept from that limit for the rounding of words, degrees.
const MARGIN: f64 = 0.001;

/// A way that comes nearer to the pole than this, degrees, goes through it.
const THROUGH_POLE: f64 = 0.0009;

/// So many places are looked at on either side of the middle, each time closer.
const GRID: i32 = 60;

/// How far a position may be beyond the end of a travel by rounding, degrees.
const ROUNDING: f64 = 1e-3;

/// The most whole turns that are looked at on either side.
const TURNS: i32 = 2;

/// A way along a vector that has been followed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Followed {
    /// Degrees of A, B, C at its start.
    pub from: [f64; 3],
    /// The tool axis at its end.
    pub to: Vec3,
    /// What [`arrival`] answers.
    pub arrival: Option<[f64; 3]>,
}

/// The degrees of A, B, C to which the axes come from `from` while the tool turns to `to`; `None` where the travel of one
/// ends before, or where it is not known.
pub(crate) fn arrival(inverse: &Inverse, from: [f64; 3], to: Vec3) -> Option<[f64; 3]> {
    let machine = inverse.machine();
    let start = machine.axis_at(from);
    let turn = angle_between(start, to);
    let (mut done, mut at, mut points) = (0.0, from, start);
    let mut step = LONGEST;
    while done < turn {
        let goal = (done + step).min(turn);
        let axis = if goal < turn { between(start, to, goal / turn) } else { to };
        let solutions = inverse.solve(axis).ok()?;
        let (next, way, other) = nearest(machine, at, &solutions);
        let half = angle_between(points, axis) / 2.0;
        let is_sure = way <= TURN && pole(machine, &solutions) > 2.0 * half;
        if goal - done > 1.001 * SHORTEST && !is_sure {
            step = ((goal - done) / 2.0).max(SHORTEST);
            continue;
        }
        let is_either = other.is_some_and(|other| other - way < ALIKE);
        if is_either || !is_within(machine, next) {
            return None;
        }
        (at, done, points, step) = (next, goal, axis, (2.0 * step).min(LONGEST));
    }
    Some(at)
}

/// How far from the pole, degrees, the tool goes past it on its turn from `start` to `to`, where the control leads such a
/// vector through the pole, or stops: both ends farther than [`POLE_LIMIT`], the way nearer.
pub(crate) fn passes_pole(inverse: &Inverse, start: Vec3, to: Vec3) -> Option<f64> {
    let away = |axis: Vec3| {
        let solutions = inverse.solve(axis);
        solutions.map_or(f64::INFINITY, |all| pole(inverse.machine(), &all)).to_degrees()
    };
    let turn = angle_between(start, to).to_degrees();
    if turn == 0.0 {
        return None;
    }
    let ends = [away(start), away(to)];
    if ends[0] + ends[1] > turn + 2.0 * POLE_LIMIT || ends[0].min(ends[1]) < POLE_LIMIT - MARGIN {
        return None;
    }
    let (mut at, mut width, mut least) = (0.5, 0.5, f64::INFINITY);
    // The nearest of so many places, then of so many about it, until they lie together.
    while width * turn > THROUGH_POLE / 100.0 {
        let around = (-GRID..=GRID).map(|i| at + width * f64::from(i) / f64::from(GRID));
        let inside = around.filter(|part| (0.0..=1.0).contains(part));
        let found = inside.map(|part| (part, away(between(start, to, part))));
        (at, least) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
        width *= 2.0 / f64::from(GRID);
    }
    (least < POLE_LIMIT + MARGIN && least > THROUGH_POLE).then_some(least)
}

/// The positions within the travel that bring the tool along `axis`.
pub(crate) fn starts(inverse: &Inverse, axis: Vec3) -> Vec<[f64; 3]> {
    let machine = inverse.machine();
    let Ok(solutions) = inverse.solve(axis) else { return Vec::new() };
    let mut starts = solutions.degrees.to_vec();
    if let Some(free) = solutions.free {
        let turned = |k: i32| {
            let mut degrees = solutions.degrees[0];
            degrees[free] += 45.0 * f64::from(k);
            degrees
        };
        starts = (-4..4).map(turned).collect();
    }
    for rotary in &machine.rotary {
        let i = rotary.index();
        let turned = |degrees: [f64; 3]| {
            (-TURNS..=TURNS).map(move |k| {
                let mut degrees = degrees;
                degrees[i] += 360.0 * f64::from(k);
                degrees
            })
        };
        starts = starts.into_iter().flat_map(turned).collect();
        starts.retain(|degrees| (degrees[i] <= rotary.max) && (degrees[i] >= rotary.min));
    }
    starts
}

/// How far these positions are from the middle of the travels, degrees.
pub(crate) fn off_center(machine: &Machine, degrees: [f64; 3]) -> f64 {
    let off = |axis: &RotaryAxis| {
        if axis.unlimited() {
            0.0
        } else {
            (degrees[axis.index()] - (axis.min + axis.max) / 2.0).abs()
        }
    };
    machine.rotary.iter().map(off).sum()
}

/// The solution to which the axes turn least, by how much at the most, and by how much to the other, where there is one.
fn nearest(
    machine: &Machine,
    from: [f64; 3],
    solutions: &Solutions,
) -> ([f64; 3], f64, Option<f64>) {
    let [one, other] = solutions.degrees.map(|degrees| {
        let mut wound = from;
        let mut most: f64 = 0.0;
        for i in machine.rotary.iter().map(RotaryAxis::index) {
            if solutions.free != Some(i) {
                let short = short_way(from[i], degrees[i]);
                wound[i] = from[i] + short;
                most = most.max(short.abs());
            }
        }
        (wound, most)
    });
    if solutions.free.is_some() || solutions.degrees[0] == solutions.degrees[1] {
        return (one.0, one.1, None);
    }
    let (near, far) = if one.1 <= other.1 { (one, other) } else { (other, one) };
    (near.0, near.1, Some(far.1))
}

/// How far the tool is from the pole in which both solutions are one, radians.
fn pole(machine: &Machine, solutions: &Solutions) -> f64 {
    let [one, other] = solutions.degrees;
    if solutions.free.is_none() && one == other {
        return f64::INFINITY;
    }
    let apart = |i: usize| short_way(other[i], one[i]).abs().to_radians() / 2.0;
    if solutions.free.is_some() {
        return 0.0;
    }
    machine.rotary.iter().map(|axis| apart(axis.index())).fold(f64::INFINITY, f64::min)
}

fn is_within(machine: &Machine, degrees: [f64; 3]) -> bool {
    machine.rotary.iter().all(|axis| {
        let at = degrees[axis.index()];
        at >= axis.min - ROUNDING && at <= axis.max + ROUNDING
    })
}
