//! Surfaces on which a program is proven that finds and follows the surface itself.
//!
//! What it makes of a pose is its number and a sum of found heights, each with a factor: where that is right for heights
//! that have nothing to do with each other, it is right for any.

use geom::Vec3;
use program::heights::HeightMap;
use program::{Diagnostic, Op, Program, Surface};

/// How much of what the probe reaches these surfaces take.
const WITHIN: f64 = 0.9;

/// A surface, as its places and as a map of them.
pub(crate) struct MappedSurface {
    pub places: Vec<Vec3>,
    pub heights: HeightMap,
}

/// The surface that the control finds for `program`, where it finds one.
pub(crate) fn found(program: &Program) -> Option<&Surface> {
    let mut records = program.records.iter();
    records.find_map(
        |record| if let Op::Surface(surface) = &record.op { Some(&**surface) } else { None },
    )
}

/// A flat surface at Z 0, one that is tilted in X and Y, and one without any order.
///
/// # Errors
/// A grid that is none.
pub(crate) fn trials(surface: &Surface) -> Result<[MappedSurface; 3], Box<Diagnostic>> {
    let [low, high] = surface.reach().map(|reach| WITHIN * reach);
    let (columns, rows) = (surface.columns().len(), surface.rows().len());
    let part = |index: usize, count: usize| index as f64 / count.saturating_sub(1).max(1) as f64;
    let tilted = |column: usize, row: usize| {
        low + (high - low) * (part(column, columns) + 2.0 * (1.0 - part(row, rows))) / 3.0
    };
    let unrelated =
        |column: usize, row: usize| low + (high - low) * scattered((row * columns + column) as u64);
    Ok([trial(surface, |_, _| 0.0)?, trial(surface, tilted)?, trial(surface, unrelated)?])
}

fn trial(
    surface: &Surface,
    height: impl Fn(usize, usize) -> f64,
) -> Result<MappedSurface, Box<Diagnostic>> {
    let rows = surface.rows().iter().enumerate();
    let places: Vec<Vec3> = rows
        .flat_map(|(row, y)| {
            let columns = surface.columns().iter().enumerate();
            columns.map(move |(column, x)| (column, row, *x, *y))
        })
        .map(|(column, row, x, y)| Vec3::new(x, y, height(column, row)))
        .collect();
    let heights = places.iter().map(|place| place.z).collect();
    let heights = HeightMap::on(surface.columns().to_vec(), surface.rows().to_vec(), heights)?;
    Ok(MappedSurface { places, heights })
}

/// A number from 0 to 1 for each number, without order: the finalizer of SplitMix64 (Steele, Lea, Flood, "Fast
/// splittable pseudorandom number generators", 2014).
fn scattered(number: u64) -> f64 {
    let mut bits = number.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^= bits >> 31;
    (bits >> 11) as f64 / (1u64 << 53) as f64
}
