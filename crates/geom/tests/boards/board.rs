//! Boards made of pads and tracks.

use toolpost_geom::region::{Cap, Region};
use toolpost_geom::{Element, Vec2};

/// Numbers that look random and are the same in every run.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03)
    }

    /// A number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as usize % end
    }

    /// A number from 0 to 1.
    pub fn unit(&mut self) -> f64 {
        self.below(1 << 30) as f64 / (1u64 << 30) as f64
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
}

/// What a round pen covers from one point to another; a pad where they are one.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub from: Vec2,
    pub to: Vec2,
    pub radius: f64,
}

#[derive(Debug)]
pub struct Board {
    pub shapes: Vec<Shape>,
}

impl Board {
    /// Each shape by itself, wider by `grown` all around.
    pub fn regions(&self, grown: f64) -> Vec<Region> {
        let region = |shape: &Shape| {
            let radius = shape.radius + grown;
            if shape.from == shape.to {
                return Region::disc(shape.from, radius);
            }
            Region::stroke(&Element::line(shape.from, shape.to), 2.0 * radius, Cap::Round)
        };
        self.shapes.iter().map(|shape| region(shape).unwrap()).collect()
    }

    /// The corners of a box around it with some room.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let ends = || self.shapes.iter().flat_map(|shape| [shape.from, shape.to]);
        let low = ends().fold(Vec2::INFINITY, Vec2::min);
        (low - 1.0, ends().fold(Vec2::NEG_INFINITY, Vec2::max) + 1.0)
    }
}

/// Eight directions.
const DIRECTIONS: [(f64, f64); 8] = [
    (1.0, 0.0),
    (1.0, 1.0),
    (0.0, 1.0),
    (-1.0, 1.0),
    (-1.0, 0.0),
    (-1.0, -1.0),
    (0.0, -1.0),
    (1.0, -1.0),
];

const GRID: f64 = 0.25;

/// Pads and tracks with bends of 45° on a grid of 0.25 mm; tracks start in pads or where others end.
pub fn on_a_grid(random: &mut Random) -> Board {
    let side = 8 + random.below(8);
    let radii = [0.1, 0.125, 0.25, 0.3];
    let width = random.of(&radii);
    let mut shapes: Vec<Shape> = Vec::new();
    for _ in 0..3 + random.below(6) {
        let at = Vec2::new(random.below(side) as f64, random.below(side) as f64) * GRID;
        shapes.push(Shape { from: at, to: at, radius: random.of(&[0.2, 0.25, 0.375, 0.5, width]) });
    }
    for _ in 0..1 + random.below(4) {
        let mut from = random.of(&shapes).to;
        let mut direction = random.below(8);
        let radius = if random.below(3) > 0 { width } else { random.of(&radii) };
        for _ in 0..1 + random.below(4) {
            let to =
                from + Vec2::from(DIRECTIONS[direction % 8]) * GRID * (1 + random.below(6)) as f64;
            shapes.push(Shape { from, to, radius });
            from = to;
            direction += random.of(&[7, 0, 1, 2, 4]);
        }
    }
    Board { shapes }
}

/// Pads and tracks anywhere.
pub fn at_any_angle(random: &mut Random) -> Board {
    let mut shapes = Vec::new();
    for _ in 0..6 + random.below(14) {
        let from = Vec2::new(random.unit(), random.unit()) * 4.0;
        let along = Vec2::new(random.unit() - 0.5, random.unit() - 0.5) * 3.0;
        let to = if random.below(3) == 0 { from } else { from + along };
        shapes.push(Shape { from, to, radius: 0.1 + 0.4 * random.unit() });
    }
    Board { shapes }
}
