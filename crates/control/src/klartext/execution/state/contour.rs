//! Elements of a contour, and what waits for the next one.

use crate::kernel::corner::{self, Shape};
use crate::klartext::language::feed::FeedWord;
use geom::{Vec3, direction};
use program::Compensation;

/// A straight line or an arc in the plane XY, in the coordinates of the blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Element {
    pub start: Vec3,
    pub end: Vec3,
    /// What makes it an arc.
    pub arc: Option<Bend>,
}

/// How an arc turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    pub center: Vec3,
    /// 1 counter-clockwise, −1 clockwise.
    pub sense: f64,
    /// Full turns more than the shortest.
    pub turns: u32,
}

/// What waits for the next element of the contour.
#[derive(Clone, Copy)]
pub(crate) enum Waiting {
    /// An element up to a corner that is cut off.
    Corner { first: Element, cut: Option<Cut> },
    /// An approach, whose last part depends on where the contour begins.
    Approach(Approach),
}

/// How a corner is cut off, and the feed for that.
#[derive(Clone, Copy)]
pub(crate) struct Cut {
    pub shape: Shape,
    pub feed: Option<FeedWord>,
}

/// The shape of an approach or a departure.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum ApproachShape {
    /// `LT`: a line in the direction of the contour, so long.
    Tangent(f64),
    /// `LN`: a line at right angles to the contour, so long.
    Normal(f64),
    /// `CT`: an arc of a radius, negative on the other side of the contour, and an angle in radians.
    Arc(f64, f64),
    /// `LCT`: an arc of a radius between a line and the contour.
    LineAndArc(f64),
}

/// An approach that waits for the direction of the contour.
#[derive(Clone, Copy)]
pub(crate) struct Approach {
    pub shape: ApproachShape,
    pub start: Vec3,
    pub compensation: Compensation,
    pub feed: Option<FeedWord>,
    /// Whether the way to PH is rapid, as the positioning before.
    pub rapid: bool,
}

impl Element {
    /// The direction at the start, a unit vector in the plane; `None` where the element has no length
    /// there or is not known.
    pub fn tangent_at_start(&self) -> Option<Vec3> {
        self.tangent(self.start)
    }

    /// The direction at the end.
    pub fn tangent_at_end(&self) -> Option<Vec3> {
        self.tangent(self.end)
    }

    fn tangent(&self, at: Vec3) -> Option<Vec3> {
        match self.arc {
            None => direction((self.end - self.start).with_z(0.0)),
            Some(Bend { center, sense, .. }) => {
                direction((Vec3::Z * sense).cross((at - center).with_z(0.0)))
            }
        }
    }

    /// Whether it lies in a plane parallel to XY.
    pub fn is_plane(&self) -> bool {
        self.start.z == self.end.z
    }

    /// As a part of a corner.
    pub fn part(&self) -> corner::Element {
        let turn = |bend: Bend| (bend.center.with_z(self.start.z), Vec3::Z * bend.sense);
        let circle = self.arc.map(turn);
        corner::Element { start: self.start, end: self.end, circle, cut: true }
    }
}
