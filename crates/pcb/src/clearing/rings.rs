//! Rings one within the other, by which a tool covers all that it reaches.
//!
//! The first is the edge of where the middle of the tool may be, and each next one is a step further in. What
//! is between two rings is at most a step from the outer one; so rings of at most half the tool's width
//! leave nothing. Wider steps leave ridges: in sharp corners, and where there is no next ring. There the
//! tool also goes along the middle of what is left, half its width from the outer ring, from which
//! a ridge is farther than that and nearer than a step.

use super::SLIVER;
use crate::Path;
use geom::region::{Index, Region, RegionError};

/// The rings of a tool of `width` mm, a `step` mm (up to the width) apart, in the region that its middle
/// may be in; from the outside inwards.
pub(super) fn of(mut middles: Region, width: f64, step: f64) -> Result<Vec<Path>, RegionError> {
    let half = width / 2.0;
    let mut paths = Vec::new();
    while !middles.is_empty() {
        paths.extend(middles.rings().filter_map(Path::around));
        let next = middles.offset(-step)?;
        if step > half {
            let halfway = middles.offset(-half)?;
            let ridges = halfway.difference(&next.offset(half + SLIVER)?)?;
            if !ridges.is_empty() {
                let near = ridges.offset(half)?;
                let near = Index::new(&near);
                let rings = halfway.rings().filter_map(Path::around);
                paths.extend(rings.flat_map(|ring| ring.within(&near)));
            }
        }
        middles = next;
    }
    Ok(paths)
}
