//! How close the two motions must be.

use crate::accepted::Accepted;
use crate::resolved_pose::PartialPose;
use control::{Orientation, Position};
use geom::Vec3;
use machine::{Machine, Mount};
use serde::Serialize;

/// How close the two motions must be, and what is let pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tolerances {
    /// Distance of the tool tips, mm; by default from the resolution of the machine's words.
    pub position: Option<f64>,
    /// Angle between the tool axes, degrees; by default from the resolution of the rotary words.
    pub angle: Option<f64>,
    /// Rules that are let pass.
    pub accepted: Accepted,
}

/// The tolerances that a proof used, each with its unit in its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Applied {
    /// Distance of the tool tips that rounding of the linear words explains, mm.
    pub tip_mm: f64,
    /// Error of one rotary word, degrees: it moves the tip by its angle at the distance from the
    /// centre of rotation, which is allowed on top of `tip_mm`.
    pub rotary_degrees: f64,
    /// Angle between the tool axes at the end of a move, degrees.
    pub axis_degrees: f64,
    /// Angle by which the tool axis may leave the great circle within a move, degrees.
    pub sweep_degrees: f64,
    /// Distance of the tip from a commanded line while rotary axes turn without tool-center control,
    /// mm, on top of `tip_mm`.
    pub linearisation_mm: f64,
    /// Chord error of arcs that are written as lines, mm, on top of `tip_mm`.
    pub chord_mm: f64,
    /// Feed, mm/min.
    pub feed: f64,
    /// Feed per turn of the spindle, mm.
    pub feed_per_turn: f64,
    /// Feed in inverse time, 1/min.
    pub inverse_time: f64,
    /// Spindle speed, 1/min.
    pub speed_per_min: f64,
    /// Lean of a wire by the control, degrees.
    pub taper_degrees: f64,
    /// Dwell, s.
    pub dwell_s: f64,
}

/// The two rotary axes turn evenly between two points, which is not a great circle of the tool axis;
/// how far it may leave that within one move, degrees.
const SWEEP: f64 = 1.0;

/// How far the tool axis of a source may lean where no axis of the machine turns, radians: CL data have five decimals
/// or more, and at 100 mm from the tip the tool is 0.001 mm off.
const UPRIGHT: f64 = 1e-5;

/// A position counts as unchanged below this, mm: noise of the kinematics, far below any word.
const NOISE: f64 = 1e-6;

impl Applied {
    /// The tolerances of `machine`, or those given.
    pub fn new(machine: &Machine, given: &Tolerances) -> Applied {
        let step = |name: &str, otherwise: i32| {
            let word = machine.words.get(name);
            word.map_or(10f64.powi(-otherwise), machine::Word::resolution)
        };
        let half = |name: &str| step(name, 3) / 2.0 * (1.0 + 1e-9);
        // Where F has no form of its own for a unit, it is written as in mm/min.
        let form = |name: &'static str| if machine.words.contains_key(name) { name } else { "F" };
        let rotary = match given.angle {
            Some(_) => 0.0,
            None if machine.rotary.is_empty() => 0.0,
            None => machine.rotary_resolution().max(step("A", 3)) / 2.0,
        };
        // Vector words are components of a unit vector: half a step is an angle in radians.
        let vector = machine
            .words
            .iter()
            .filter(|(name, _)| ["A3", "B3", "C3", "TX", "TY", "TZ"].contains(&name.as_str()))
            .map(|(_, word)| {
                (3f64.sqrt() / 2.0 * 10f64.powi(-i32::from(word.decimals))).to_degrees()
            })
            .fold(0.0, f64::max);
        // U and V are rounded each, at the height of the upper plane.
        let height = machine.wire.and_then(|wire| wire.height).unwrap_or(f64::INFINITY);
        let lean = (step("U", 3) / 2f64.sqrt() / height).atan().to_degrees();
        let upright = match machine.rotary.is_empty() && machine.wire.is_none() {
            true => UPRIGHT.to_degrees(),
            false => 0.0,
        };
        Applied {
            tip_mm: given.position.unwrap_or(machine.resolution() / 2.0 * 3f64.sqrt()) + NOISE,
            rotary_degrees: rotary,
            axis_degrees: given
                .angle
                .unwrap_or((rotary * turns_added(machine)).max(vector).max(lean).max(upright))
                + NOISE,
            sweep_degrees: SWEEP,
            linearisation_mm: machine.orientation.tolerance,
            chord_mm: machine.capabilities.lowering_tolerance,
            feed: half("F"),
            feed_per_turn: half(form("F_per_turn")),
            inverse_time: half(form("F_inverse_time")),
            speed_per_min: step("S", 0) / 2.0 * (1.0 + 1e-9),
            taper_degrees: step("TAPER", 3) / 2.0 * (1.0 + 1e-9),
            dwell_s: 1e-3,
        }
    }

    /// How far the tip may be from where it should be, mm, when a block says `pose`: the rounding of
    /// its linear words, and that of its rotary words at the distance from the centre.
    pub(crate) fn tip(
        &self,
        machine: &Machine,
        pose: &Position,
        place: &PartialPose,
        tool_length: Option<f64>,
    ) -> f64 {
        if self.rotary_degrees == 0.0 {
            return self.tip_mm;
        }
        let lever = match pose.orientation {
            Orientation::Rotary { tool_center: true, .. } => 0.0,
            // Only a tilted plane turns the coordinates of a block.
            Orientation::Axis(axis) if axis == Vec3::Z => 0.0,
            Orientation::Axis(_) => place.tip.length() * 3f64.sqrt(),
            Orientation::Rotary { .. } => {
                let zero = machine.work_zero.unwrap_or(Vec3::ZERO);
                let arm = |axis: &machine::RotaryAxis| match axis.on {
                    Mount::Table => (place.tip + zero).distance(axis.point),
                    Mount::Head => axis.point.length() + tool_length.unwrap_or(0.0),
                };
                machine.rotary.iter().map(arm).sum()
            }
        };
        self.tip_mm + lever * self.rotary_degrees.to_radians()
    }
}

/// By how many degrees the tool axis is off where each of two rotary words is off by 1°, at the worst of the places that
/// they bring it to.
///
/// Words that are off by e each move the tool axis c by e (k₁ × c ± k₂ × c), with k₁ the rotary axis nearest to the part
/// and k₂ the one nearest to the tool. With u = k₁ · c the square of that is e² (1 − u² + |k₂ × Z|² + 2 |k₁ · k₂ − u k₂ · Z|):
/// √2 at the most where the axes are perpendicular, 1.71 on a table that nutates by 45°, whose two axes move the tool the same
/// way where it lies flat.
fn turns_added(machine: &Machine) -> f64 {
    let tables = machine.rotary.iter().filter(|axis| axis.on == Mount::Table).rev();
    let heads = machine.rotary.iter().filter(|axis| axis.on == Mount::Head);
    let axes: Vec<Vec3> = tables.chain(heads).map(|axis| axis.axis).collect();
    let [outer, inner] = axes[..] else { return 2f64.sqrt() };
    let (between, tilt) = (outer.dot(inner), inner.z);
    // The cosine of the angle to the outer axis goes as far as the inner one turns the tool.
    let (middle, reach) =
        (between * tilt, ((1.0 - between * between) * (1.0 - tilt * tilt)).max(0.0).sqrt());
    let worst = |u: f64| 2.0 - tilt * tilt - u * u + 2.0 * (between - u * tilt).abs();
    let (low, high) = (middle - reach, middle + reach);
    // Its peaks are at the ends, where the part within | | changes its sign, and where a parabola is level.
    let peaks = [low, high, tilt, -tilt, if tilt == 0.0 { 0.0 } else { between / tilt }];
    peaks.into_iter().map(|u| worst(u.clamp(low, high))).fold(0.0, f64::max).sqrt()
}
