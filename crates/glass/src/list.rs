//! Lists of points as text: one point a line, its coordinates in columns that blanks, commas or semicolons part.

use crate::mesh::{Fault, lines, number};
use glam::DVec3;
use program::{Rule, encoding};

/// In which columns the coordinates stand, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns(pub [usize; 3]);

impl Default for Columns {
    fn default() -> Columns {
        Columns([0, 1, 2])
    }
}

/// Whether commas cannot be distinguished from decimal ones: with semicolons in the line, or where blanks alone part words of it.
fn may_hold_decimal_commas(line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().collect();
    let parts_alone = |pair: &[&str]| !pair[0].ends_with(',') && !pair[1].starts_with(',');
    line.contains(',') && (line.contains(';') || words.windows(2).any(parts_alone))
}

/// Reads the points (mm). Lines that begin with `#`, `;` or `//` are comments; a first line without a number is a head.
pub(crate) fn read(bytes: &[u8], columns: Columns) -> Result<Vec<DVec3>, Fault> {
    let mut points = Vec::new();
    each(bytes, columns, |_, point| points.push(point))?;
    Ok(points)
}

/// The lines of the points of a list, from 1; none of what is no list.
pub fn lines_of_points(bytes: &[u8], columns: Columns) -> Vec<u32> {
    let mut found = Vec::new();
    let read = each(encoding::without_mark(bytes), columns, |line, _| {
        found.push(u32::try_from(line).unwrap_or(u32::MAX));
    });
    read.map(|()| found).unwrap_or_default()
}

/// Gives each point with its line.
fn each(bytes: &[u8], columns: Columns, mut take: impl FnMut(usize, DVec3)) -> Result<(), Fault> {
    let mut head = true;
    for (at, line) in lines(bytes) {
        let line = line.trim();
        if line.is_empty() || ["#", ";", "//"].iter().any(|mark| line.starts_with(mark)) {
            continue;
        }
        if may_hold_decimal_commas(line) {
            let message = "commas next to another separator may be decimal commas: write points";
            return Err(Fault::new(Rule::Number, message).line(at));
        }
        let words: Vec<&str> = line
            .split(|c: char| c.is_whitespace() || c == ',' || c == ';')
            .filter(|word| !word.is_empty())
            .collect();
        if std::mem::take(&mut head) && words.iter().all(|word| word.parse::<f64>().is_err()) {
            continue;
        }
        let mut place = DVec3::ZERO;
        for (axis, &column) in columns.0.iter().enumerate() {
            place[axis] = number(words.get(column).copied(), at)?;
        }
        take(at, place);
    }
    Ok(())
}
