//! What the arm of a polar machine reaches, from above.

use crate::paper::{INK, begin, shorten, write_text};
use glam::DVec2;
use std::fmt::Write as _;

/// What is drawn, mm: the table's axis is the origin, the arm's is above it.
pub struct ReachPicture<'a> {
    /// Sides of the block along X and Y; its near side lies `offset` from the table's axis, its middle on the line of the axes.
    pub block: [f64; 2],
    /// From the table's axis to the near side of the block.
    pub offset: f64,
    /// Radius of the table.
    pub table: f64,
    /// From the table's axis to the arm's, and the length of the arm.
    pub arm: [f64; 2],
    /// How many cells there are along X, and whether the middle of each is reached: row by row from the near side.
    pub cells: (usize, &'a [bool]),
}

/// The field of the picture: low and high corner, pixels.
const FIELD: [DVec2; 2] = [DVec2::new(40.0, 70.0), DVec2::new(1160.0, 720.0)];

const REACHED: &str = "#7fbf7b";
const MISSED: &str = "#d7301f";
const EDGE: &str = "#4a5666";

/// Draws what the arm reaches of a block as SVG under a title.
pub fn reach(title: &str, picture: &ReachPicture) -> String {
    let ReachPicture { block: [x, y], offset, table, arm: [distance, arm], cells } = *picture;
    let mut out = begin(&format!("What the arm reaches: {title}"));
    write_text(&mut out, &shorten(title, 60), DVec2::new(40.0, 40.0), 12.0, INK);
    // From the far side of the table to the arm's axis, and as much at the sides.
    let (low, high) = (DVec2::new(-table, -table), DVec2::new(table, distance.max(table) + 10.0));
    let room = FIELD[1] - FIELD[0];
    let scale = (room / (high - low)).min_element();
    let seen = |place: DVec2| {
        DVec2::new(FIELD[0].x, FIELD[1].y) + (place - low) * DVec2::new(scale, -scale)
    };
    let (columns, reached) = cells;
    let rows = reached.len() / columns.max(1);
    let step = DVec2::new(x / columns as f64, y / rows.max(1) as f64);
    let corner = DVec2::new(-0.5 * x, offset);
    // Cells of a row that are alike are one piece.
    for (row, cells) in reached.chunks(columns.max(1)).enumerate() {
        let mut column = 0;
        for alike in cells.chunk_by(|a, b| a == b) {
            let color = if alike[0] { REACHED } else { MISSED };
            let near = seen(corner + step * DVec2::new(column as f64, row as f64 + 1.0));
            // A little more, so that the painter leaves no seam between rows.
            let size = step * DVec2::new(alike.len() as f64, 1.0) * scale + DVec2::Y * 0.6;
            let _ = writeln!(
                out,
                "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{color}\"/>",
                near.x, near.y, size.x, size.y
            );
            column += alike.len();
        }
    }
    let mut circle = |at: DVec2, radius: f64| {
        let at = seen(at);
        let _ = writeln!(
            out,
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{:.2}\" fill=\"none\" stroke=\"{EDGE}\"/>",
            at.x,
            at.y,
            radius * scale
        );
    };
    let axis = DVec2::new(0.0, distance);
    circle(DVec2::ZERO, table);
    circle(DVec2::ZERO, 2.0);
    circle(axis, 2.0);
    // Where the beam is nearest to the table's axis.
    circle(DVec2::ZERO, (distance - arm).abs());
    let missed = reached.iter().filter(|reached| !**reached).count();
    let share = 100.0 * missed as f64 / reached.len().max(1) as f64;
    let texts = [
        format!("block {x} x {y} mm, {offset} mm from the table's axis"),
        format!("arm {arm} mm, axes {distance} mm apart"),
        format!("table of radius {table} mm"),
        format!("red: not reached, {share:.1} % of the block"),
    ];
    for (number, text) in texts.iter().enumerate() {
        let at = DVec2::new(660.0, 120.0 + 24.0 * number as f64);
        write_text(&mut out, text, at, 11.0, INK);
    }
    out.push_str("</svg>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_are_alike_are_drawn_in_one_piece_and_the_share_is_stated() {
        let reached = [false, false, true, true, true, true];
        let picture = ReachPicture {
            block: [30.0, 20.0],
            offset: 70.0,
            table: 150.0,
            arm: [200.0, 120.0],
            cells: (3, &reached),
        };
        let drawn = reach("a block", &picture);
        // One piece is missed, one in its row is reached, and one is the other row: 2 of 6 cells.
        assert_eq!((drawn.matches(MISSED).count(), drawn.matches(REACHED).count()), (1, 2));
        assert_eq!(drawn.matches("<circle").count(), 4);
        assert_eq!(drawn, reach("a block", &picture));
    }
}
