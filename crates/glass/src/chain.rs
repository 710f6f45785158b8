//! A positioner by its declared axes: what moves the block, what moves the beam, and where both stand at home (spec 2.15, UP = f(O, L)).
//!
//! Two axes act in the plane, each on the block or on the beam, and each in a straight line or about an upright axis; the third moves
//! the focus along the beam. Of axes that act on the same, the first carries the second. Positions of the block and the beam in the
//! frame of the machine's base are homogeneous matrices: the beam hits the block at `block⁻¹ beam spot`. The same formula serves every such
//! machine, so that the three kinds that are built in can be compared with it.

use glam::{DAffine2, DMat2, DVec2};
use serde::Deserialize;

/// What an axis moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Moves {
    /// The block: O.
    Block,
    /// The beam: L.
    Beam,
}

/// An axis in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// What it moves.
    pub moves: Moves,
    /// Its direction in the base, of any length; of a straight one only.
    #[serde(default)]
    pub along: Option<[f64; 2]>,
    /// Where it stands at home, mm in the base; of a turning one only. It turns counter-clockwise as seen against the beam.
    #[serde(default)]
    pub about: Option<[f64; 2]>,
}

/// Two axes in the plane, and what stands where at home.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// The first axis.
    pub a: Joint,
    /// The second.
    pub b: Joint,
    /// Where the beam hits at home, mm in the base.
    pub spot: [f64; 2],
    /// Where the corner of the block is at home, mm in the base; its sides lie along X and Y then.
    pub corner: [f64; 2],
    /// Where both axes stand about as they work, mm or degrees: of several ways to a place the one near it is taken.
    pub near: [f64; 2],
}

/// How near a place is found, mm: far less than the rounding of words.
const FOUND: f64 = 1e-9;

/// Most steps to a place.
const STEPS: u32 = 60;

/// From where a place is looked for besides `near`, degrees of each turning axis.
const AROUND: [f64; 5] = [0.0, 60.0, -60.0, 120.0, -120.0];

impl Joint {
    /// Whether it is a turning axis.
    pub fn turns(&self) -> bool {
        self.about.is_some()
    }

    /// What it does at a position (mm or degrees).
    fn matrix(&self, at: f64) -> DAffine2 {
        match (self.about, self.along) {
            (Some(center), _) => {
                let center = DVec2::from_array(center);
                let turn = DMat2::from_angle(at.to_radians());
                DAffine2::from_mat2_translation(turn, center - turn * center)
            }
            (None, Some(along)) => {
                DAffine2::from_translation(DVec2::from_array(along).normalize_or_zero() * at)
            }
            (None, None) => DAffine2::IDENTITY,
        }
    }

    fn check(&self, name: &str) -> Result<(), String> {
        let finite = [self.along, self.about].into_iter().flatten().flatten();
        if finite.clone().any(|value| !value.is_finite() || value.abs() > 1e4) {
            return Err(format!("chain.{name}: numbers from -10000 to 10000 are needed"));
        }
        match (self.along, self.about) {
            (Some(along), None) if DVec2::from_array(along).length() > 1e-6 => Ok(()),
            (None, Some(_)) => Ok(()),
            _ => Err(format!(
                "chain.{name} needs `along` (a direction in the plane) or `about` (a place), and not both"
            )),
        }
    }
}

impl Chain {
    /// Whether it can be.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), String> {
        self.a.check("a")?;
        self.b.check("b")?;
        let values = self.spot.iter().chain(&self.corner).chain(&self.near);
        if values.clone().any(|value| !value.is_finite() || value.abs() > 1e4) {
            return Err(String::from(
                "chain.spot, chain.corner and chain.near must be from -10000 to 10000",
            ));
        }
        if self.slopes(self.near).determinant().abs() < 1e-6 {
            return Err(String::from(
                "both axes of [chain] move the beam over the block in one direction: nothing but a line is reached",
            ));
        }
        Ok(())
    }

    /// Where the beam hits the block at these positions: mm from the block's corner.
    pub fn forward(&self, at: [f64; 2]) -> DVec2 {
        let (mut block, mut beam) = (DAffine2::IDENTITY, DAffine2::IDENTITY);
        for (joint, at) in [self.a, self.b].iter().zip(at) {
            match joint.moves {
                Moves::Block => block *= joint.matrix(at),
                Moves::Beam => beam *= joint.matrix(at),
            }
        }
        let spot = beam.transform_point2(DVec2::from_array(self.spot));
        block.inverse().transform_point2(spot) - DVec2::from_array(self.corner)
    }

    /// How the place changes with each position.
    fn slopes(&self, at: [f64; 2]) -> DMat2 {
        let by = |axis: usize| {
            let step = |sign: f64| {
                let mut there = at;
                there[axis] += sign * 1e-4;
                self.forward(there)
            };
            (step(1.0) - step(-1.0)) / 2e-4
        };
        DMat2::from_cols(by(0), by(1))
    }

    /// The positions, within `travel`, at which the beam hits a place of the block, of several those nearest to `near`; `None` where
    /// there are none.
    pub fn inverse(&self, place: DVec2, travel: [[f64; 2]; 2]) -> Option<[f64; 2]> {
        let starts = |axis: usize, joint: Joint| {
            let near = self.near[axis];
            AROUND
                .iter()
                .take(if joint.turns() { AROUND.len() } else { 1 })
                .map(move |off| near + off)
        };
        let within = |at: &[f64; 2]| {
            (0..2).all(|axis| (travel[axis][0]..=travel[axis][1]).contains(&at[axis]))
        };
        let all = starts(0, self.a).flat_map(|a| starts(1, self.b).map(move |b| [a, b]));
        let mut found = all.filter_map(|start| self.solve(place, start)).filter(within);
        let far =
            |at: &[f64; 2]| (0..2).map(|axis| (at[axis] - self.near[axis]).powi(2)).sum::<f64>();
        let first = found.next()?;
        // What is so near needs no second look.
        if far(&first) < 30.0 * 30.0 {
            return Some(first);
        }
        Some(found.fold(first, |best, at| if far(&at) < far(&best) - 1e-6 { at } else { best }))
    }

    /// Newton's way from `start` to the positions of a place.
    fn solve(&self, place: DVec2, start: [f64; 2]) -> Option<[f64; 2]> {
        let mut at = start;
        for _ in 0..STEPS {
            let missing = place - self.forward(at);
            if missing.length() < FOUND {
                let turned = |axis: usize, joint: Joint| match joint.turns() {
                    // The same position, as near to `near` as can be.
                    true => at[axis] - 360.0 * ((at[axis] - self.near[axis]) / 360.0).round(),
                    false => at[axis],
                };
                return Some([turned(0, self.a), turned(1, self.b)]);
            }
            let slopes = self.slopes(at);
            if slopes.determinant().abs() < 1e-12 {
                return None;
            }
            let step = slopes.inverse() * missing;
            for (axis, joint) in [self.a, self.b].iter().enumerate() {
                let most = if joint.turns() { 20.0 } else { 1e4 };
                at[axis] += step[axis].clamp(-most, most);
            }
        }
        None
    }
}
