//! The kinematic chain.
//!
//! Programmed linear positions are where the tool tip would be, from the work zero, with the head in
//! its zero position: that is what a control with tool length offset moves to. A table turns the part
//! under the tool, a head turns the tool about points fixed to the spindle; so the tip in the work
//! frame follows from the tip in the machine by undoing the table.

use crate::{Machine, Mount, RotaryAxis, Wire};
use geom::{ANGLE_EPSILON, Vec2, Vec3, angle_between, between, rotate};
use program::Rule;
use serde::Serialize;
use std::fmt;

/// A fact on which the place of a tool hangs, and that nobody has said: nothing that is missing is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unsaid {
    /// A point of this rotary axis (`point` of the machine file).
    AxisPoint(char),
    /// The work zero in machine coordinates (`work_zero` of the machine file).
    WorkZero,
    /// The length of the tool.
    ToolLength,
    /// Which of its two solutions the control takes for a tilted plane, or for a vector.
    Solution,
}

impl Unsaid {
    /// The rule under which a program that hangs on it is refused.
    pub fn rule(self) -> Rule {
        match self {
            Unsaid::AxisPoint(_) | Unsaid::WorkZero | Unsaid::Solution => Rule::Kinematics,
            Unsaid::ToolLength => Rule::ToolLength,
        }
    }

    /// Where it is said.
    pub fn way_out(self) -> String {
        match self {
            Unsaid::AxisPoint(letter) => format!(
                "`point = [x, y, z]` (mm) in the [[rotary]] of {letter}: of a table in machine coordinates, of a head from \
                 the gauge point of the spindle"
            ),
            Unsaid::WorkZero => String::from(
                "`work_zero = [x, y, z]` (mm) in the machine file: where G54 lies in machine coordinates",
            ),
            Unsaid::ToolLength => String::from(
                "LENGTH in the source's tool call, or in its tool table; tool center point control needs none",
            ),
            Unsaid::Solution => String::from(
                "`work_zero = [x, y, z]` (mm) in the machine file: then each is checked",
            ),
        }
    }
}

impl fmt::Display for Unsaid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unsaid::AxisPoint(letter) => write!(f, "where the axis of {letter} lies"),
            Unsaid::WorkZero => f.write_str("where the work lies on the turned table"),
            Unsaid::ToolLength => f.write_str("the length of the tool that the head tilts"),
            Unsaid::Solution => {
                f.write_str("which positions the rotary axes take for a tilted plane")
            }
        }
    }
}

/// Rounding of a whole turn, turns.
const WHOLE: f64 = 1e-12;

impl Machine {
    /// The tool tip (mm, work frame) and the tool axis (unit vector, work frame) for positions of the
    /// linear axes (mm) and the rotary axes (degrees of A, B, C), with a tool of `tool_length` mm.
    pub fn forward(&self, linear: Vec3, degrees: [f64; 3], tool_length: f64) -> (Vec3, Vec3) {
        if self.rotary.is_empty() {
            return (linear, Vec3::Z);
        }
        let zero = self.work_zero.unwrap_or(Vec3::ZERO);
        let swing = self.head_swing(degrees, tool_length);
        let tip = self.on(Mount::Table).fold(linear + swing + zero, |p, axis| {
            axis.point + rotate(p - axis.point, axis.axis, -axis.turned(degrees[axis.index()]))
        });
        (tip - zero, self.axis_at(degrees))
    }

    /// How far the table has carried the work zero with the rotary axes at `degrees`, mm, along the axes of the machine.
    pub fn carried_zero(&self, degrees: [f64; 3]) -> Vec3 {
        let zero = self.work_zero.unwrap_or(Vec3::ZERO);
        let carried = self.on(Mount::Table).rev().fold(zero, |p, axis| {
            axis.point + rotate(p - axis.point, axis.axis, axis.turned(degrees[axis.index()]))
        });
        carried - zero
    }

    /// The tool axis (unit vector, work frame) for positions of the rotary axes in degrees.
    pub fn axis_at(&self, degrees: [f64; 3]) -> Vec3 {
        let tool = self
            .on(Mount::Head)
            .rev()
            .fold(Vec3::Z, |v, axis| rotate(v, axis.axis, axis.turned(degrees[axis.index()])));
        self.on(Mount::Table)
            .fold(tool, |v, axis| rotate(v, axis.axis, -axis.turned(degrees[axis.index()])))
    }

    /// How far the tool axis leaves the great circle between two tool axes (unit vectors, work frame), radians, while the
    /// rotary axes turn evenly from one of `degrees` to the other, sampled at seven points in between.
    pub fn swing(&self, degrees: [[f64; 3]; 2], axes: [Vec3; 2]) -> f64 {
        let off = |t: f64| {
            let turned = [0, 1, 2].map(|i| degrees[0][i] + t * (degrees[1][i] - degrees[0][i]));
            angle_between(self.axis_at(turned), between(axes[0], axes[1], t))
        };
        (1..8).map(|i| off(f64::from(i) / 8.0)).fold(0.0, f64::max)
    }

    /// Where +Z of the machine points in the work frame (unit vector) with the rotary axes at `degrees`: a table turns the
    /// part under it, a head does not.
    pub fn up_at(&self, degrees: [f64; 3]) -> Vec3 {
        self.on(Mount::Table)
            .fold(Vec3::Z, |v, axis| rotate(v, axis.axis, -axis.turned(degrees[axis.index()])))
    }

    /// The positions of the linear axes (mm) that bring the tool tip to `tip` (mm, work frame) with
    /// the rotary axes at `degrees`: the inverse of [`Machine::forward`] for given rotary positions.
    pub fn linear_for(&self, tip: Vec3, degrees: [f64; 3], tool_length: f64) -> Vec3 {
        if self.rotary.is_empty() {
            return tip;
        }
        let zero = self.work_zero.unwrap_or(Vec3::ZERO);
        let turned = self.on(Mount::Table).rev().fold(tip + zero, |p, axis| {
            axis.point + rotate(p - axis.point, axis.axis, axis.turned(degrees[axis.index()]))
        });
        turned - zero - self.head_swing(degrees, tool_length)
    }

    /// The tips (mm, work frame) at the corners of the box in which the linear axes go from one tip to another with the
    /// rotary axes at `degrees`, where each goes at its own speed: the tip is never outside it.
    pub fn wandering(&self, from: Vec3, to: Vec3, degrees: [f64; 3]) -> [Vec3; 8] {
        let [a, b] = [from, to].map(|tip| self.linear_for(tip, degrees, 0.0));
        let corner = |i: usize| {
            Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 0 { a[k] } else { b[k] }))
        };
        std::array::from_fn(|i| self.forward(corner(i), degrees, 0.0).0)
    }

    /// What nobody has said of where the tool tip is with the rotary axes at `degrees` (of A, B, C): what turns must
    /// know where its axis lies, a table also where the work lies on it, and a tilted head how long its tool is.
    #[inline]
    pub fn unsaid(&self, degrees: [f64; 3], tool_length: Option<f64>) -> Option<Unsaid> {
        // Whole turns are none, wherever the axis lies.
        let turns = |axis: &&RotaryAxis| {
            let turns = axis.turned(degrees[axis.index()]) / std::f64::consts::TAU;
            (turns - turns.round()).abs() > WHOLE
        };
        let mut turned = self.rotary.iter().filter(turns);
        if let Some(axis) = turned.clone().find(|axis| !axis.is_placed) {
            return Some(Unsaid::AxisPoint(axis.letter));
        }
        if self.work_zero.is_none() && turned.any(|axis| axis.on == Mount::Table) {
            return Some(Unsaid::WorkZero);
        }
        let is_measured = tool_length.is_some() || self.rotary.is_empty();
        (!is_measured && self.tilts_tool(degrees)).then_some(Unsaid::ToolLength)
    }

    /// Whether the head turns the tool away from where it points in the zero position, with the rotary axes at `degrees`
    /// (of A, B, C).
    pub fn tilts_tool(&self, degrees: [f64; 3]) -> bool {
        let tool = self
            .on(Mount::Head)
            .rev()
            .fold(Vec3::Z, |v, axis| rotate(v, axis.axis, axis.turned(degrees[axis.index()])));
        tool.distance(Vec3::Z) > ANGLE_EPSILON
    }

    /// By how much the turned head moves the tip of a tool of `tool_length` from where it was.
    fn head_swing(&self, degrees: [f64; 3], tool_length: f64) -> Vec3 {
        let hanging = Vec3::new(0.0, 0.0, -tool_length);
        let turned = self.on(Mount::Head).rev().fold(hanging, |p, axis| {
            axis.point + rotate(p - axis.point, axis.axis, axis.turned(degrees[axis.index()]))
        });
        turned - hanging
    }

    /// The rotary axes of one side, from the machine's frame outwards.
    fn on(&self, mount: Mount) -> impl DoubleEndedIterator<Item = &RotaryAxis> {
        self.rotary.iter().filter(move |axis| axis.on == mount)
    }
}

impl Wire {
    /// U and V (mm) of a wire along `axis` (a unit vector, upwards); nothing where it leans and the
    /// height of the upper plane is not known, or it lies flat.
    pub fn lean(&self, axis: Vec3) -> Option<Vec2> {
        match self.height {
            Some(height) => lean(axis, height),
            None => (axis.truncate() == Vec2::ZERO).then_some(Vec2::ZERO),
        }
    }
}

/// How far a wire along `axis` (a unit vector, upwards) is from where it crosses Z 0 at a height of `height` mm, mm; nothing
/// where it leans and lies flat.
pub fn lean(axis: Vec3, height: f64) -> Option<Vec2> {
    let across = axis.truncate();
    match axis.z > 0.0 {
        true => Some(across * (height / axis.z)),
        false => (across == Vec2::ZERO).then_some(Vec2::ZERO),
    }
}
