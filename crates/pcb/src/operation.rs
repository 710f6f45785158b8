//! What a machine does to a board: tools and their cuts, in order.

use geom::{Element, Vec2};

/// What one tool does, in the order in which it does it.
#[derive(Clone, Debug, PartialEq)]
pub struct Operation {
    /// What it is, in a few words: `isolation`, `drill 0.8 mm`.
    pub name: String,
    /// With what.
    pub tool: Tool,
    /// The cuts, in order.
    pub cuts: Vec<Cut>,
}

/// One stay of the tool in the board. Depths are mm below the surface, greater than 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Cut {
    /// Straight down and out again.
    Hole {
        /// Where, mm.
        at: Vec2,
        /// How deep.
        depth: f64,
    },
    /// Down where the first stretch starts, along all of them, and out at the end. Each starts where the
    /// one before ends; where their depths differ, the tool goes straight down or up between them.
    Way(Vec<Stretch>),
}

/// A line or arc at one depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The way of the middle of the tool.
    pub element: Element,
    /// How deep its tip is, mm below the surface.
    pub depth: f64,
}

/// A tool and how it is used.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// What it is called: `V-bit 30°`, `drill 0.8 mm`.
    pub name: String,
    /// Its form.
    pub cutter: Cutter,
    /// Feed along the board, mm/min.
    pub feed: f64,
    /// Feed straight down, mm/min.
    pub plunge: f64,
    /// Speed of the spindle, 1/min.
    pub speed: f64,
}

/// The form of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cutter {
    /// Equally wide at every depth: an end mill, a drill.
    Cylinder {
        /// mm.
        diameter: f64,
    },
    /// A V-bit.
    Vee {
        /// Width of its tip, mm, 0 or more.
        tip: f64,
        /// Between its edges, radians, above 0 and below π.
        angle: f64,
    },
}

impl Cutter {
    /// How wide it cuts at the surface when its tip is `depth` mm below it, mm.
    pub fn width(&self, depth: f64) -> f64 {
        match *self {
            Cutter::Cylinder { diameter } => diameter,
            Cutter::Vee { tip, angle } => tip + 2.0 * depth.max(0.0) * (angle / 2.0).tan(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_v_bit_is_wider_the_deeper_it_goes() {
        let vee = Cutter::Vee { tip: 0.1, angle: FRAC_PI_2 };
        // Edges at 45° each: as far out as down.
        assert!((vee.width(0.2) - 0.5).abs() < 1e-12);
        assert_eq!(Cutter::Cylinder { diameter: 0.8 }.width(3.0), 0.8);
    }
}
