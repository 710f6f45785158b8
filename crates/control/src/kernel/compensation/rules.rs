//! How each control begins compensation and goes around corners (`docs/controls/compensation.md`).

use crate::Dialect;
use std::f64::consts::PI;

/// What a control does with a contour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rules {
    pub entry: Entry,
    pub outer: Outer,
    /// Elements that turn by no more than this, radians, join without a corner; so near to a half turn
    /// the way goes back.
    pub smooth: f64,
    /// Whether the arc around a corner is one also before a rapid.
    pub rounds_rapids: bool,
    /// Blocks without a move in the plane past which the control still sees the next element.
    pub blind: usize,
    /// Whether a way into or out of the contour that cuts it is refused.
    pub guarded: bool,
}

/// Where the move that switches compensation on ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entry {
    /// Across the end of the move itself, which counts as the first element of the contour.
    OfItself,
    /// Across the start of the next element.
    OfNext,
}

/// How the tool goes around an outer corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outer {
    /// On an arc about the corner.
    Arc,
    /// To where the parallels of the two tangents cross; where the way turns by more than 90°, first
    /// on by the radius, then straight over to the same on the other side.
    Polygon,
    /// To where two lines cross; on an arc where the way turns by more than 100°.
    Intersection,
    /// On a curve between the two (`DISC=` of SINUMERIK), which is not followed.
    Peak,
}

/// What the register of a radius means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Registers {
    /// The tool of that number; register 0 is no radius.
    Numbered,
    /// The tool of that number; no register and register 0 are the tool in the spindle.
    NumberedOrHeld,
    /// There is none: the tool in the spindle counts.
    Held,
    /// An edge of the tool in the spindle, of which the table knows the first.
    Edges,
}

impl Registers {
    /// Those of `dialect`.
    pub(super) fn of(dialect: Dialect) -> Registers {
        match dialect {
            Dialect::LinuxCnc => Registers::NumberedOrHeld,
            Dialect::Klartext => Registers::Held,
            Dialect::Sinumerik | Dialect::Sinumerik828d => Registers::Edges,
            Dialect::Fanuc | Dialect::Haas | Dialect::Mach3 | Dialect::Grbl | Dialect::Marlin => {
                Registers::Numbered
            }
            Dialect::FanucWire | Dialect::Sodick | Dialect::Agie => Registers::Numbered,
            Dialect::Krl | Dialect::UrScript | Dialect::Ls | Dialect::Rapid => Registers::Numbered,
            Dialect::Points | Dialect::Source(_) => Registers::Numbered,
        }
    }
}

impl Outer {
    /// How much the way may turn for [`Outer::Intersection`], radians (MD20210 CUTCOM_CORNER_LIMIT).
    pub(super) const SHARPEST: f64 = 100.0 * PI / 180.0;
}

/// Elements that turn by no more than this, radians, join without a corner on most controls.
const SMOOTH: f64 = 1e-5;

impl Rules {
    /// Whether elements with a turn that a drawing may show join without a corner, so that the tool cuts into it.
    pub(crate) fn cuts_joints(self) -> bool {
        self.smooth > SMOOTH
    }

    /// Those of `dialect`; none where it has no compensation.
    pub(crate) fn of(dialect: Dialect) -> Option<Rules> {
        let rules = Rules {
            entry: Entry::OfNext,
            outer: Outer::Arc,
            smooth: SMOOTH,
            rounds_rapids: true,
            blind: usize::MAX,
            guarded: true,
        };
        match dialect {
            // All by rs274.
            Dialect::LinuxCnc => Some(Rules {
                entry: Entry::OfItself,
                smooth: 0.05,
                rounds_rapids: false,
                guarded: false,
                ..rules
            }),
            // Parameters 5003#0,#1 = 0 (type A), 19607#2 = 0, 19625 = 3 blocks, as delivered.
            Dialect::Fanuc => Some(Rules { outer: Outer::Polygon, blind: 1, ..rules }),
            // NORM, G450; MD20250 CUTCOM_MAXNUM_DUMMY_BLOCKS = 3.
            Dialect::Sinumerik | Dialect::Sinumerik828d => Some(Rules { blind: 3, ..rules }),
            Dialect::Klartext => Some(rules),
            // Mach3 and Haas have it, and how they go is not documented well enough.
            Dialect::Haas | Dialect::Mach3 => None,
            // So with wires, whose offsets are the generator's.
            Dialect::FanucWire | Dialect::Sodick | Dialect::Agie => None,
            // Robots have none: what writes for them works it out.
            Dialect::Krl | Dialect::UrScript | Dialect::Ls | Dialect::Rapid => None,
            // A CAM system has worked its paths out already; what it has not, is the new control's.
            Dialect::Grbl | Dialect::Marlin | Dialect::Points | Dialect::Source(_) => None,
        }
    }
}
