//! Surfaces that the control finds while the program runs.

/// A surface of which the program knows the places alone: their heights are kept where probing moves find them
/// ([`crate::Probe::place`]). Between the places it is bilinear; outside it is as high as at the nearest place of the
/// edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// X of the columns, rising, mm; two at least.
    pub columns: Vec<f64>,
    /// Y of the rows, rising, mm; two at least.
    pub rows: Vec<f64>,
    /// Its lowest and its highest place, mm from Z 0. What lies lower is not found, and stops the program. What lies
    /// higher is found as far as the probe starts above it, and cuts follow it, but rapids and limits count on this.
    pub reach: [f64; 2],
    /// Z below which poses count from the surface, mm.
    pub clear: f64,
}
