//! Where a surface is probed, and the program that does it.

use crate::heights::APART;
use geom::{Vec2, Vec3};
use program::{Diagnostic, Feed, Op, Pose, Probe, Program, Rule};

/// The most points that a grid has: a probe takes seconds for each.
const MOST_PLACES: usize = 10_000;

/// How near to each other columns and rows may be, mm. The words of a program round them by up to 0.005 mm and the
/// machine answers in steps; nearer than 0.05 mm a log does not distinguish them ([`crate::height_map`]).
const NEAREST: f64 = 2.0 * APART;

/// The names of files that a comment can hold.
const NAME: &str = "letters, digits and . - _ /";

/// By which part of their distance a column or a row is moved out of a hole at most, and by which at once.
const SHIFTED: [f64; 2] = [0.4, 0.02];

/// Points in columns and rows over a rectangle: at even distances, its corners among them, until [`Grid::clear_of`] moves some.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// X of each column, rising, mm.
    columns: Vec<f64>,
    /// Y of each row, rising, mm.
    rows: Vec<f64>,
}

impl Grid {
    /// The grid of `columns` by `rows` places over the rectangle between two corners, mm.
    ///
    /// # Errors
    /// Fewer than two columns or rows, or nearer to each other than 0.1 mm; more than 10,000 places; a rectangle without
    /// area.
    pub fn new(from: Vec2, to: Vec2, columns: usize, rows: usize) -> Result<Grid, Box<Diagnostic>> {
        let wrong = |message: String, help: &str| {
            Err(Diagnostic::error(Rule::ProbingGrid, message).help(help).into())
        };
        if columns < 2 || rows < 2 || columns.saturating_mul(rows) > MOST_PLACES {
            let message = format!("a grid of {columns} by {rows} places");
            return wrong(message, "2 columns and 2 rows at least, and 10000 places at most");
        }
        let (from, to) = (from.min(to), from.max(to));
        if !(from.is_finite() && to.is_finite() && from.x < to.x && from.y < to.y) {
            let message = format!("a grid from X{} Y{} to X{} Y{} mm", from.x, from.y, to.x, to.y);
            return wrong(message, "the corners of a rectangle lie apart in X and in Y");
        }
        for (what, count, length) in
            [("columns", columns, to.x - from.x), ("rows", rows, to.y - from.y)]
        {
            let apart = length / (count - 1) as f64;
            if apart < NEAREST {
                let message = format!("{count} {what} over {length} mm are {apart} mm apart");
                return wrong(message, &format!("{NEAREST} mm at least: fewer {what}"));
            }
        }
        let lines = |from: f64, to: f64, count: usize| {
            let at = |i: usize| from + (to - from) * (i as f64 / (count - 1) as f64);
            (0..count).map(at).collect()
        };
        Ok(Grid { columns: lines(from.x, to.x, columns), rows: lines(from.y, to.y, rows) })
    }

    /// The grid with columns, and where that is not enough rows, moved by as little as it takes for every place to be one where
    /// `is_free` says yes: by two fifths of their distance at most, the outermost inwards. `None` where that does not do.
    pub fn clear_of(&self, is_free: impl Fn(Vec2) -> bool) -> Option<Grid> {
        let mut grid = self.clone();
        for across in [false, true] {
            let [moved, crossed] = match across {
                false => [&self.columns, &self.rows],
                true => [&self.rows, &grid.columns],
            };
            let at = |line: f64, other: f64| match across {
                false => Vec2::new(line, other),
                true => Vec2::new(other, line),
            };
            let is_clear = |line: f64| crossed.iter().all(|other| is_free(at(line, *other)));
            // A line that cannot be cleared stays, and the other lines are moved out of the holes that are left.
            let lines = (0..moved.len()).map(|i| shifted(moved, i, is_clear).unwrap_or(moved[i]));
            let lines: Vec<f64> = lines.collect();
            *(if across { &mut grid.rows } else { &mut grid.columns }) = lines;
            let is_apart =
                |lines: &[f64]| lines.windows(2).all(|pair| pair[1] - pair[0] >= NEAREST);
            if grid.places().all(&is_free) {
                return Some(grid).filter(|grid| grid.lines().into_iter().all(is_apart));
            }
        }
        None
    }

    /// Its places in the order in which they are probed, row after row, every second one backwards.
    pub fn places(&self) -> impl Iterator<Item = Vec2> + '_ {
        self.order().map(|(column, row)| Vec2::new(self.columns[column], self.rows[row]))
    }

    /// Column and row of the places in that order.
    pub(crate) fn order(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let columns = self.columns.len();
        (0..self.rows.len()).flat_map(move |row| {
            (0..columns)
                .map(move |column| (if row % 2 == 0 { column } else { columns - 1 - column }, row))
        })
    }

    /// X of the columns and Y of the rows, rising, mm.
    pub(crate) fn lines(&self) -> [&[f64]; 2] {
        [&self.columns, &self.rows]
    }
}

/// The nearest place to that of a line among `lines` at which it is clear.
fn shifted(lines: &[f64], index: usize, is_clear: impl Fn(f64) -> bool) -> Option<f64> {
    let line = lines[index];
    let [most, step] = SHIFTED;
    let count = (most / step).round() as usize;
    let towards = |other: Option<&f64>| other.map(move |other| (other - line) * step);
    let before = towards(index.checked_sub(1).and_then(|before| lines.get(before)));
    let after = towards(lines.get(index + 1));
    let moved = (1..=count).flat_map(|steps| {
        [after, before].into_iter().flatten().map(move |way| line + way * steps as f64)
    });
    std::iter::once(line).chain(moved).find(|place| is_clear(*place))
}

/// How a surface is probed; its height is expected at Z 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probing {
    /// Height of the moves from place to place, from which each probe starts, mm above Z 0: higher than `reach`.
    pub travel: f64,
    /// How far below and above Z 0 the surface may lie, mm, greater than 0.
    pub reach: f64,
    /// Feed of the probe, mm/min.
    pub feed: f64,
}

impl Probing {
    /// The program that probes `grid`. With `log` it names the file in which LinuxCNC keeps what it finds;
    /// a sender of GRBL keeps what the machine answers.
    ///
    /// # Errors
    /// A reach or feed that is not greater than 0, a height that is not above the reach; a name that a comment cannot
    /// hold.
    pub fn program(
        &self,
        name: &str,
        grid: &Grid,
        log: Option<&str>,
    ) -> Result<Program, Box<Diagnostic>> {
        let takes = |byte: u8| byte.is_ascii_alphanumeric() || b".-_/".contains(&byte);
        if let Some(file) = log.filter(|file| file.is_empty() || !file.bytes().all(takes)) {
            let message = format!("the log is called `{file}`");
            return Err(Diagnostic::error(Rule::Probing, message).help(NAME).into());
        }
        let mut program = Program::new(name);
        program.push(0, Op::Operation("probing".into()));
        if let Some(file) = log {
            program.push(0, Op::Comment(format!("PROBEOPEN {file}").into()));
        }
        self.moves(grid, |_| None)?.into_iter().for_each(|op| program.push(0, op));
        if log.is_some() {
            program.push(0, Op::Comment("PROBECLOSE".into()));
        }
        program.push(0, Op::EndOfOperation);
        program.push(0, Op::End);
        Ok(program)
    }

    /// The moves that probe `grid`, with the feed before them; `place` says for which place of a surface the height
    /// at a column and row is kept.
    ///
    /// # Errors
    /// A reach or feed that is not greater than 0, a height that is not above the reach.
    pub(crate) fn moves(
        &self,
        grid: &Grid,
        place: impl Fn((usize, usize)) -> Option<u32>,
    ) -> Result<Vec<Op>, Box<Diagnostic>> {
        let Probing { travel, reach, feed } = *self;
        for (what, value, above) in
            [("feed", feed, 0.0), ("reach", reach, 0.0), ("travel height", travel, reach)]
        {
            if !(value.is_finite() && value > above) {
                let message = format!("the {what} of the probe is {value}");
                let help = format!("greater than {above}");
                return Err(Diagnostic::error(Rule::Probing, message).help(help).into());
            }
        }
        let mut moves = vec![Op::Feed(Feed::PerMinute(feed))];
        for at in grid.order() {
            let pose = |z: f64| Pose::upright(Vec3::new(grid.columns[at.0], grid.rows[at.1], z));
            let (end, place) = (pose(-reach)?, place(at));
            moves.push(Op::Rapid(pose(travel)?));
            moves.push(Op::Probe(Box::new(Probe { end, away: false, must_answer: true, place })));
            moves.push(Op::Rapid(pose(travel)?));
        }
        Ok(moves)
    }
}
