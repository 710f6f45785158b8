//! Rotary positions for a tool axis, in closed form.
//!
//! Seen from the part, the tool axis is v = R(k₁, φ₁) · R(k₂, φ₂) · Z: first the rotary axis nearest
//! to the part, then the one nearest to the tool, whatever each of them carries. That is the second
//! subproblem of Paden and Kahan (Murray, Li and Sastry, *A Mathematical Introduction to Robotic
//! Manipulation*, 1994, section 3.3.2); one axis alone is the first. Both are solved here for axes of
//! any direction, so nutating heads and tables need nothing of their own.
//!
//! Where v lies on k₁ every φ₁ will do: the pose is singular and that angle is free.

use crate::{Machine, Mount};
use geom::{ANGLE_EPSILON, Vec3, angle_between};
use std::f64::consts::{PI, TAU};

/// How far a tool axis may be out of reach and still be taken as the nearest one in reach, radians:
/// cutter-location data are written to five decimals or more, and this is below a step of 0.001°.
pub const REACH_EPSILON: f64 = 1e-5;

/// The tool axis cannot be reached by any rotary position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unreachable {
    /// Angle in radians to the nearest axis that can be reached.
    pub deviation: f64,
}

/// The rotary positions for one tool axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solutions {
    /// Degrees of A, B, C, each in (−180, 180]; the preferred solution first. Equal where there is
    /// only one.
    pub degrees: [[f64; 3]; 2],
    /// Index (0 for A, 1 for B, 2 for C) of the axis that may have any position, where there is one; it
    /// is given in its kinematic zero.
    pub free: Option<usize>,
}

impl Machine {
    /// The rotary positions that bring the tool along `axis` (unit vector, work frame). Travel limits
    /// are not looked at.
    ///
    /// # Errors
    /// [`Unreachable`] where no position does.
    pub fn inverse(&self, axis: Vec3) -> Result<Solutions, Unreachable> {
        Inverse::of(self).solve(axis)
    }

    /// Whether these positions are of the solution that the machine does not prefer.
    pub(crate) fn misses_preference(&self, degrees: [f64; 3]) -> bool {
        self.rotary.iter().any(|axis| axis.prefer * degrees[axis.index()] < -1e-6)
    }
}

/// The inverse kinematics of the rotary axes of one machine, made once for many tool axes.
#[derive(Clone, Debug)]
pub struct Inverse<'a> {
    machine: &'a Machine,
    /// Degrees of A, B, C in the kinematic zero.
    zero: [f64; 3],
    chain: Chain,
}

impl<'a> Inverse<'a> {
    /// That of `machine`.
    pub fn of(machine: &'a Machine) -> Inverse<'a> {
        let zero = machine.rotary.iter().fold([0.0; 3], |mut zero, axis| {
            zero[axis.index()] = axis.offset;
            zero
        });
        Inverse { machine, zero, chain: Chain::new(machine, zero) }
    }

    /// The machine whose axes these are.
    pub fn machine(&self) -> &'a Machine {
        self.machine
    }

    /// [`Machine::inverse`].
    ///
    /// # Errors
    /// [`Unreachable`] where no position brings the tool along `axis`.
    pub fn solve(&self, axis: Vec3) -> Result<Solutions, Unreachable> {
        let Inverse { machine, zero, chain } = self;
        let angles = chain.rotary_angles(axis)?;
        let mut degrees = [0, 1].map(|family| {
            let turns = chain.solution(&angles, family);
            let held = if angles.free() { zero[chain.places[0]] } else { turns[0].degrees() };
            chain.spread([held, turns[1].degrees()])
        });
        if machine.misses_preference(degrees[0]) && !machine.misses_preference(degrees[1]) {
            degrees.swap(0, 1);
        }
        let free = (angles.free() && chain.links > 0).then_some(chain.places[0]);
        Ok(Solutions { degrees, free })
    }
}

/// An angle in 2⁻³² of a turn: adding wraps by itself, quarter turns are exact, and a step is
/// 0.0000001°, a thousandth of what the finest rotary word says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Turn(i32);

impl Turn {
    const STEPS: f64 = 4_294_967_296.0;

    fn of_radians(angle: f64) -> Turn {
        // A float beyond the range of i64 saturates, so no angle, however broken, can do harm here.
        let steps = angle * (Turn::STEPS / TAU);
        Turn((steps + 0.5f64.copysign(steps)) as i64 as i32)
    }

    /// Degrees in (−180, 180]. What is within rounding of −180 is 180.
    pub(crate) fn degrees(self) -> f64 {
        let steps = f64::from(self.0) + if self.0 < i32::MIN + 16 { Turn::STEPS } else { 0.0 };
        steps * (360.0 / Turn::STEPS)
    }

    fn plus(self, other: Turn) -> Turn {
        Turn(self.0.wrapping_add(other.0))
    }

    fn minus(self, other: Turn) -> Turn {
        Turn(self.0.wrapping_sub(other.0))
    }
}

/// What a tool axis says about the positions, before one of the two solutions is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RotaryAngles {
    /// Where the tool axis stands about the outer axis.
    around: Turn,
    /// By how much the inner axis is turned out of the plane of the two axes, in either direction.
    inner: Turn,
    /// What that makes about the outer axis: 0 to half a turn, or [`RotaryAngles::FREE`].
    outer: Turn,
}

impl RotaryAngles {
    /// The outer axis may stand anywhere.
    const FREE: Turn = Turn(-1);

    /// Whether the outer axis may stand anywhere.
    pub(crate) fn free(&self) -> bool {
        self.outer == RotaryAngles::FREE
    }
}

/// The rotary axes in the order in which they turn the tool axis: the outer one is nearest to the
/// part, the inner one nearest to the tool. Positions come in pairs (outer, inner).
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    /// Axes that there are.
    pub(crate) links: usize,
    /// Their places in the order A, B, C.
    pub(crate) places: [usize; 2],
    /// Position of each in its kinematic zero.
    offsets: [Turn; 2],
    solver: Solver,
}

#[derive(Clone, Debug)]
enum Solver {
    /// No axis turns the tool axis: the outer axis may stand anywhere, the inner one stands still.
    Fixed { tool: Vec3, still: Turn },
    /// Only the outer axis does; the inner one stands still.
    One { k: Vec3, x: Vec3, y: Vec3, polar: f64, still: Turn },
    /// Both do.
    Two(Pair),
}

/// What two axes have that does not depend on the tool axis wanted.
#[derive(Clone, Debug)]
struct Pair {
    k1: Vec3,
    /// k₂ less its part along k₁, and k₁ × k₂: the directions from which `around` counts.
    x: Vec3,
    y: Vec3,
    /// k₁ · k₂, k₂ · Z and 1 − (k₁ · k₂)².
    d: f64,
    b: f64,
    s2: f64,
    /// Position of the inner axis at which the tool lies in the plane of the two axes.
    in_plane: Turn,
    /// Least and largest angle between the tool axis and k₁.
    reach: [f64; 2],
}

impl Chain {
    /// The chain of `machine`. An axis that cannot turn the tool axis stays where `held` (degrees of A,
    /// B, C) has it.
    pub(crate) fn new(machine: &Machine, held: [f64; 3]) -> Chain {
        let side = |mount| machine.rotary.iter().filter(move |axis| axis.on == mount);
        // With growing position a table turns the tool axis, as the part sees it, in the other direction.
        let links: Vec<_> = side(Mount::Table)
            .rev()
            .map(|axis| (axis, -axis.axis * axis.sign))
            .chain(side(Mount::Head).map(|axis| (axis, axis.axis * axis.sign)))
            .take(2)
            .collect();
        let mut chain = Chain {
            links: links.len(),
            // A chain of less than two axes names distinct places for those it lacks.
            places: [0, 1],
            offsets: [Turn::default(); 2],
            solver: Solver::one(Vec3::Z, Vec3::Z, Turn::default()),
        };
        for (i, (axis, _)) in links.iter().enumerate() {
            chain.places[i] = axis.index();
            chain.offsets[i] = Turn::of_radians(axis.offset.to_radians());
        }
        if let [(only, _)] = links[..] {
            chain.places[1] = (only.index() + 1) % 3;
        }
        chain.solver = match links[..] {
            [] => chain.solver,
            [(_, k)] => Solver::one(k, Vec3::Z, Turn::default()),
            [(_, k1), (inner, k2), ..] => {
                let lost = |u: Vec3, v: Vec3| u.cross(v).length() < ANGLE_EPSILON;
                if lost(k2, Vec3::Z) || lost(k1, k2) {
                    let angle = (held[inner.index()] - inner.offset).to_radians();
                    Solver::one(k1, geom::rotate(Vec3::Z, k2, angle), Turn::of_radians(angle))
                } else {
                    Solver::Two(Pair::new(k1, k2))
                }
            }
        };
        chain
    }

    /// How many solutions a tool axis has.
    pub(crate) fn families(&self) -> usize {
        if matches!(self.solver, Solver::Two(_)) { 2 } else { 1 }
    }

    /// Solves for the tool axis `v`, a unit vector.
    pub(crate) fn rotary_angles(&self, v: Vec3) -> Result<RotaryAngles, Unreachable> {
        match &self.solver {
            Solver::Fixed { tool, still } => {
                within(angle_between(*tool, v))?;
                Ok(RotaryAngles {
                    inner: *still,
                    outer: RotaryAngles::FREE,
                    ..RotaryAngles::default()
                })
            }
            Solver::One { k, x, y, polar, still } => {
                within(angle_between(*k, v) - polar)?;
                let around = Turn::of_radians(v.dot(*y).atan2(v.dot(*x)));
                Ok(RotaryAngles { around, inner: *still, ..RotaryAngles::default() })
            }
            Solver::Two(pair) => pair.rotary_angles(v),
        }
    }

    /// The positions of the outer and the inner axis in solution `family` (0 or 1).
    pub(crate) fn solution(&self, angles: &RotaryAngles, family: usize) -> [Turn; 2] {
        let RotaryAngles { around, inner, outer } = *angles;
        let turned = match &self.solver {
            Solver::Two(Pair { in_plane, .. }) if family == 0 => {
                [around.minus(outer), in_plane.minus(inner)]
            }
            Solver::Two(Pair { in_plane, .. }) => [around.plus(outer), in_plane.plus(inner)],
            Solver::Fixed { .. } | Solver::One { .. } => [around, inner],
        };
        [turned[0].plus(self.offsets[0]), turned[1].plus(self.offsets[1])]
    }

    /// The pair (outer, inner) as degrees of A, B, C.
    pub(crate) fn spread(&self, pair: [f64; 2]) -> [f64; 3] {
        let mut degrees = [0.0; 3];
        for (&place, value) in self.places.iter().zip(pair).take(self.links) {
            degrees[place] = value;
        }
        degrees
    }

    /// Degrees of A, B, C as the pair (outer, inner).
    pub(crate) fn gather(&self, degrees: [f64; 3]) -> [f64; 2] {
        let mut pair = [0.0; 2];
        for (value, &place) in pair.iter_mut().zip(&self.places).take(self.links) {
            *value = degrees[place];
        }
        pair
    }
}

/// Refuses what lies outside the reach by more than rounding.
fn within(deviation: f64) -> Result<(), Unreachable> {
    let deviation = deviation.abs();
    if deviation <= REACH_EPSILON { Ok(()) } else { Err(Unreachable { deviation }) }
}

impl Solver {
    /// The axis `k` turning a tool that stands along `tool`, the inner axis being `still`.
    fn one(k: Vec3, tool: Vec3, still: Turn) -> Solver {
        let out = tool - k * tool.dot(k);
        match geom::direction(out).filter(|_| out.length() > ANGLE_EPSILON) {
            None => Solver::Fixed { tool, still },
            Some(x) => Solver::One { k, x, y: k.cross(x), polar: angle_between(k, tool), still },
        }
    }
}

impl Pair {
    fn new(k1: Vec3, k2: Vec3) -> Pair {
        let (d, b) = (k1.dot(k2), k2.z);
        let y = k1.cross(k2);
        let in_plane = k2.dot(Vec3::Z.cross(k1)).atan2(k1.z - b * d);
        let (tilt, between) = (angle_between(Vec3::Z, k2), angle_between(k1, k2));
        Pair {
            k1,
            x: k2 - k1 * d,
            y,
            d,
            b,
            s2: y.length_squared(),
            in_plane: Turn::of_radians(in_plane),
            reach: [(tilt - between).abs(), PI - (PI - tilt - between).abs()],
        }
    }

    /// Where the tool axis goes when the inner axis turns it, c, makes the angle of v with k₁ and the
    /// angle of Z with k₂, so c = α k₁ + β k₂ ± γ k₁ × k₂ with one γ for both solutions.
    fn rotary_angles(&self, v: Vec3) -> Result<RotaryAngles, Unreachable> {
        let mut along = v.dot(self.k1);
        let (x, y) = (v.dot(self.x), v.dot(self.y));
        let free = x * x + y * y < ANGLE_EPSILON * ANGLE_EPSILON * self.s2;
        if free {
            along = 1f64.copysign(along);
        }
        let (mut alpha, mut beta) = self.in_plane_part(along);
        let mut gamma2 = 1.0 - alpha * alpha - beta * beta - 2.0 * alpha * beta * self.d;
        if gamma2 <= 0.0 || gamma2.is_nan() || free {
            let polar =
                if free { along.acos() } else { (x.hypot(y) / self.s2.sqrt()).atan2(along) };
            let nearest = polar.clamp(self.reach[0], self.reach[1]);
            within(polar - nearest)?;
            (alpha, beta) = self.in_plane_part(nearest.cos());
            gamma2 = 0.0;
        }
        let gamma = (gamma2 / self.s2).sqrt();
        Ok(RotaryAngles {
            around: Turn::of_radians(y.atan2(x)),
            inner: Turn::of_radians(gamma.atan2(alpha)),
            outer: if free { RotaryAngles::FREE } else { Turn::of_radians(gamma.atan2(beta)) },
        })
    }

    fn in_plane_part(&self, along: f64) -> (f64, f64) {
        ((along - self.d * self.b) / self.s2, (self.b - self.d * along) / self.s2)
    }
}
