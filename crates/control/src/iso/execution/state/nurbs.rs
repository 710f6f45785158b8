//! A NURBS that is being given.

use geom::Vec3;

/// A curve whose `G5.3` has not come yet.
#[derive(Clone, Debug)]
pub(crate) struct Nurbs {
    /// Control points in the coordinates of the program, mm: X and Y times their weight, and the weight.
    pub points: Vec<Vec3>,
    pub order: usize,
}
