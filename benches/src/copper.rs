//! A circuit board: its copper united, and grown by the radius of a tool, compared with another library's union
//! and growth of the same copper as polygons.

use crate::clock::Taken;
use crate::{Measured, fastest};
use clipper2_rust::core::{FillRule, PathsD, PointD};
use clipper2_rust::offset::{EndType, JoinType};
use clipper2_rust::{inflate_paths_d, union_subjects_d};
use geom::region::{Cap, Region, RegionError};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};

/// How far the middle of a chord of the other library's polygons is from its arc, mm: as far as in `region`.
const CHORD_ERROR: f64 = 0.0009;

/// Decimal places of a millimetre that the other library keeps.
const PLACES: i32 = 6;

/// The radius of the tool, mm.
const TOOL: f64 = 0.1;

/// Prints what boards of `shapes` pads and tracks, and of sixteen times as many, take.
///
/// # Errors
/// Where a board is refused.
pub fn measure(shapes: usize, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let mut before: Option<Taken> = None;
    for shapes in [shapes, 16 * shapes] {
        let copper = board(shapes).map_err(refused)?;
        let united = Region::union_of(&copper).map_err(refused)?;
        println!(
            "a board of {shapes} pads and tracks: {} islands, {} lines and arcs",
            united.islands().len(),
            united.rings().map(|ring| ring.elements().len()).sum::<usize>(),
        );
        let copper_polygons: PathsD = copper.iter().flat_map(polygons).collect();
        let theirs = fastest(rounds, &mut || {
            std::hint::black_box(union_subjects_d(&copper_polygons, FillRule::Positive, PLACES));
            Ok(())
        })?;
        let ours = fastest(rounds, &mut || {
            std::hint::black_box(Region::union_of(&copper).map_err(refused)?);
            Ok(())
        })?;
        row("united", &ours, &theirs);
        let united_polygons: PathsD = polygons(&united);
        let theirs = fastest(rounds, &mut || {
            let (join, end) = (JoinType::Round, EndType::Polygon);
            std::hint::black_box(inflate_paths_d(
                &united_polygons,
                TOOL,
                join,
                end,
                2.0,
                PLACES,
                CHORD_ERROR,
            ));
            Ok(())
        })?;
        let grown = fastest(rounds, &mut || {
            std::hint::black_box(united.offset(TOOL).map_err(refused)?);
            Ok(())
        })?;
        row("grown", &grown, &theirs);
        if let Some(before) = before.replace(ours.time) {
            println!(
                "  united, divided by the board with a sixteenth of it: {}",
                ours.time.times(before)
            );
        }
    }
    Ok(())
}

/// A row: what it takes, and what it takes the other library, which uses one thread.
fn row(what: &str, ours: &Measured, theirs: &Measured) {
    let mb = |of: &Measured| of.peak / 1_000_000;
    println!(
        "  {what}: {}, {} MB\n    the other library: {}, {} MB; divided by ours: {}",
        ours.time,
        mb(ours),
        theirs.time,
        mb(theirs),
        theirs.time.times(ours.time),
    );
}

fn refused(error: RegionError) -> Vec<Diagnostic> {
    vec![Diagnostic::error(Rule::Board, error.to_string())]
}

/// Eight directions.
const WAYS: [(f64, f64); 8] = [
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

/// Pads on a grid of 0.25 mm, and tracks between its places with bends of 45°, as dense as on a board.
fn board(shapes: usize) -> Result<Vec<Region>, RegionError> {
    let mut random = 1u64;
    let mut below = |end: usize| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (random >> 33) as usize % end
    };
    let side = (shapes as f64).sqrt() as usize * 4;
    let mut copper = Vec::with_capacity(shapes);
    while copper.len() < shapes {
        let mut at = Vec2::new(below(side) as f64, below(side) as f64) * GRID;
        copper.push(Region::disc(at, [0.25, 0.375, 0.5][below(3)])?);
        let (width, mut way) = ([0.2, 0.25, 0.4][below(3)], below(8));
        for _ in 0..below(4) {
            let to = at + Vec2::from(WAYS[way % 8]) * GRID * (1 + below(8)) as f64;
            copper.push(Region::stroke(&Element::line(at, to), width, Cap::Round)?);
            way += [7, 0, 1][below(3)];
            at = to;
        }
    }
    copper.truncate(shapes);
    Ok(copper)
}

/// The rings of a region as polygons.
fn polygons(region: &Region) -> Vec<Vec<PointD>> {
    region.rings().map(|ring| ring.elements().iter().flat_map(chords).collect()).collect()
}

/// The starts of the chords of an element.
fn chords(element: &Element) -> impl Iterator<Item = PointD> {
    let steps = element.turn.zip(element.radius()).map_or(1.0, |(turn, radius)| {
        (turn.sweep.abs() / (8.0 * CHORD_ERROR / radius).sqrt()).ceil()
    });
    (0..steps as usize).map(move |i| {
        let point = element.at(i as f64 / steps);
        PointD { x: point.x, y: point.y }
    })
}
