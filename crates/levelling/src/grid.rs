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

/// Points at even distances over a rectangle, its corners among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    from: Vec2,
    to: Vec2,
    columns: usize,
    rows: usize,
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
        Ok(Grid { from, to, columns, rows })
    }

    /// Its places in the order in which they are probed, row after row, every second one backwards.
    pub fn places(&self) -> impl Iterator<Item = Vec2> + '_ {
        self.order().map(|(column, row)| Vec2::new(self.column(column), self.row(row)))
    }

    /// Column and row of the places in that order.
    pub(crate) fn order(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.rows).flat_map(move |row| {
            (0..self.columns).map(move |column| {
                (if row % 2 == 0 { column } else { self.columns - 1 - column }, row)
            })
        })
    }

    /// X of the columns and Y of the rows, rising, mm.
    pub(crate) fn lines(&self) -> [Vec<f64>; 2] {
        let columns = (0..self.columns).map(|column| self.column(column));
        [columns.collect(), (0..self.rows).map(|row| self.row(row)).collect()]
    }

    fn column(&self, column: usize) -> f64 {
        self.from.x + (self.to.x - self.from.x) * (column as f64 / (self.columns - 1) as f64)
    }

    fn row(&self, row: usize) -> f64 {
        self.from.y + (self.to.y - self.from.y) * (row as f64 / (self.rows - 1) as f64)
    }
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
            let pose = |z: f64| Pose::upright(Vec3::new(grid.column(at.0), grid.row(at.1), z));
            let (end, place) = (pose(-reach)?, place(at));
            moves.push(Op::Rapid(pose(travel)?));
            moves.push(Op::Probe(Box::new(Probe { end, away: false, must_answer: true, place })));
            moves.push(Op::Rapid(pose(travel)?));
        }
        Ok(moves)
    }
}
