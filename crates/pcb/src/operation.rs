//! What a machine does to a board: tools and their cuts, in order.

use crate::Path;
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

impl Operation {
    /// How wide its tool cuts where it goes deepest, mm.
    pub fn width(&self) -> f64 {
        let depths = self.cuts.iter().map(|cut| match cut {
            Cut::Hole { depth, .. } => *depth,
            Cut::Path(segments) => segments.iter().map(|segment| segment.depth).fold(0.0, f64::max),
        });
        self.tool.cutter.width(depths.fold(0.0, f64::max))
    }
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
        /// How deep until the tool comes up to clear the chips, each time, mm; `None` where it goes down
        /// at once.
        peck: Option<f64>,
    },
    /// Down where the first segment starts, along all of them, and out at the end. Each starts where the
    /// one before ends; where their depths differ, the tool goes straight down or up between them.
    Path(Vec<Segment>),
}

impl Cut {
    /// Where the tool goes down, mm.
    pub fn start(&self) -> Vec2 {
        match self {
            Cut::Hole { at, .. } => *at,
            Cut::Path(segments) => segments.first().map_or(Vec2::ZERO, |first| first.element.start),
        }
    }

    /// Where it comes up, mm.
    pub fn end(&self) -> Vec2 {
        match self {
            Cut::Hole { at, .. } => *at,
            Cut::Path(segments) => segments.last().map_or(Vec2::ZERO, |last| last.element.end),
        }
    }

    /// Along `path` at each of `depths` in turn, without leaving the board: around and around where it is
    /// closed, else there and back.
    pub fn along(path: &Path, depths: &[f64]) -> Cut {
        let back = if path.is_closed() { path.clone() } else { path.reversed() };
        let paths = [path, &back].into_iter().cycle().zip(depths);
        let segments = paths.flat_map(|(path, &depth)| {
            path.elements().iter().map(move |&element| Segment { element, depth })
        });
        Cut::Path(segments.collect())
    }
}

/// The depths at which to cut down to `depth` mm: equally far apart, and by no more than `step` mm. Both
/// are greater than 0. A step that is a tenth of a micrometre too small for a whole number of them is
/// taken as meant.
pub fn depths(depth: f64, step: f64) -> Vec<f64> {
    /// No machine makes a smaller step, mm.
    const LEAST: f64 = 1e-4;
    let levels = ((depth - LEAST) / step.max(LEAST)).ceil().max(1.0) as usize;
    (1..=levels).map(|level| depth * level as f64 / levels as f64).collect()
}

/// A line or arc at one depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The path of the centre of the tool.
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

    #[test]
    fn levels_are_equally_deep_and_none_deeper_than_the_step() {
        assert_eq!(depths(1.5, 0.5), [0.5, 1.0, 1.5]);
        assert_eq!(depths(1.0, 0.6), [0.5, 1.0]);
        assert_eq!(depths(0.1, 0.6), [0.1]);
        // 0.3 / 0.1 is a little less than 3, 0.9 / 0.3 a little more.
        assert_eq!((depths(0.3, 0.1).len(), depths(0.9, 0.3).len()), (3, 3));
        assert_eq!(depths(0.01, 1e-300).len(), 99);
    }

    #[test]
    fn a_ring_is_gone_around_again_and_a_line_there_and_back() {
        let (a, b) = (Vec2::ZERO, Vec2::X);
        let line = Path::new(vec![Element::line(a, b)]).unwrap();
        let Cut::Path(cut) = Cut::along(&line, &[1.0, 2.0, 3.0]) else { panic!("a hole") };
        let there = |depth| Segment { element: Element::line(a, b), depth };
        let back = |depth| Segment { element: Element::line(b, a), depth };
        assert_eq!(cut, [there(1.0), back(2.0), there(3.0)]);
        let ring = Path::new(vec![Element::line(a, b), Element::line(b, a)]).unwrap();
        let Cut::Path(cut) = Cut::along(&ring, &[1.0, 2.0]) else { panic!("a hole") };
        assert_eq!(cut, [there(1.0), back(1.0), there(2.0), back(2.0)]);
    }
}
