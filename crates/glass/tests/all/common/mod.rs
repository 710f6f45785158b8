//! What the tests of whole jobs have in common.

use glam::DVec3;
use toolpost_glass::curve::Layers;
use toolpost_glass::fill::{Fill, Filling, Shells};
use toolpost_glass::job::{Order, Placing, Settings};
use toolpost_glass::material::{Material, TABLE, find};
use toolpost_glass::optics::Ray;
use toolpost_glass::order::Effort;

/// K9 for the green of the laser.
pub fn k9() -> Material {
    find(TABLE, "", "k9", 532.0).unwrap()
}

/// A surface as it is, in one block of that width, depth and height in mm with 2 mm of margin; its order is improved once, with so many
/// tries a step.
pub fn settings(block: [f64; 3], tries: u64) -> Settings {
    Settings {
        placing: Placing {
            block,
            margin: 2.0,
            scale: None,
            fit: false,
            turn: [0.0; 3],
            mirror: [false; 3],
            shift: [0.0; 3],
        },
        alone: Vec::new(),
        blocks: 1,
        focal: 70.0,
        spacing: None,
        filling: Filling { fill: Fill::Surface, step: None, direction: DVec3::Z },
        shells: Shells { count: 1, distance: None },
        layers: Layers::default(),
        ray: Ray::Marginal,
        order: Order::Fastest,
        effort: Effort { rounds: 1, tries, until: None },
        seed: 1,
        accept_shadowed: false,
    }
}
