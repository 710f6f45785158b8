//! The path of the wire as a neutral program: as lines and arcs, or as points.

use crate::points::Points;
use crate::{Contour, Element, Path};
use geom::{Vec2, Vec3};
use program::{ArcTo, Circle, Compensation, Feed, NoPose, Op, Pose, Program};

/// A segment of the wire path: what is cut without a break, such as one pass with its leads.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Where the wire goes.
    pub path: Path,
    /// The same as points, where the control takes those.
    pub points: Option<Points>,
    /// mm/min.
    pub feed: Option<f64>,
    /// Index of the contour that it cuts.
    pub opening: usize,
    /// 0 for the first pass there.
    pub pass: usize,
    /// What the control itself does to the wire; `None`: nothing.
    pub by_control: Option<ByControl>,
    /// Whether it cuts the tab that held the part.
    pub tab: bool,
    /// Whether the wire is threaded at its start; otherwise it is there already.
    pub thread: bool,
    /// Whether the wire is cut at its end.
    pub cut: bool,
    /// Whether the machine stops before it, for the operator to hold the part.
    pub stop: bool,
}

/// What the control does to the wire.
#[derive(Clone, Copy, Debug)]
pub struct ByControl {
    /// On which side and by which register it offsets it.
    pub offset: Compensation,
    /// The taper, degrees as [`Op::Taper`] counts them.
    pub taper: f64,
}

impl ByControl {
    const OFF: ByControl = ByControl { offset: Compensation::Off, taper: 0.0 };

    fn push(self, program: &mut Program, line: u32, leans: bool) {
        program.push(line, Op::Compensation(self.offset));
        if leans {
            program.push(line, Op::Taper(self.taper));
        }
    }
}

/// Which end of the wire.
#[derive(Clone, Copy, Debug)]
pub enum End {
    /// The one at Z 0.
    Lower,
    /// The one at the height of the part.
    Upper,
}

impl Segment {
    /// A whole opening along `path`.
    pub fn of(path: Path) -> Segment {
        Segment {
            path,
            points: None,
            feed: None,
            opening: 0,
            pass: 0,
            by_control: None,
            tab: false,
            thread: true,
            cut: true,
            stop: false,
        }
    }

    /// The line of the source where it begins; a lead has none.
    pub fn line(&self) -> u32 {
        let mut lines = self.path.lower().elements().iter().map(|element| element.line);
        lines.find(|line| *line > 0).unwrap_or_default()
    }

    /// The line of the source that brings the wire to where it begins.
    fn starts_by(&self) -> u32 {
        match self.path.lower().starts_by() {
            0 => self.line(),
            line => line,
        }
    }

    /// Whether the wire leans anywhere.
    pub fn leans(&self) -> bool {
        self.path.upper().is_some()
    }

    /// The contour that one end follows.
    pub fn contour(&self, end: End) -> &Contour {
        match end {
            End::Lower => self.path.lower(),
            End::Upper => self.path.upper().unwrap_or(self.path.lower()),
        }
    }
}

/// The program of `segments`: as points where they have them, else with their arcs. Wires with a taper reach
/// the upper contour at `height` mm. With `feeds` the program has feeds.
///
/// # Errors
/// A point that is not finite.
pub fn program(
    name: &str,
    segments: &[Segment],
    height: f64,
    feeds: bool,
) -> Result<Program, NoPose> {
    assemble(name, segments, feeds, |segment| match &segment.points {
        Some(points) => divided(points, segment.line(), height),
        None => exact(segment.path.lower()),
    })
}

/// The same with every arc, for one end of the wire.
///
/// # Errors
/// A point that is not finite.
pub fn end(name: &str, segments: &[Segment], end: End, feeds: bool) -> Result<Program, NoPose> {
    assemble(name, segments, feeds, |segment| exact(segment.contour(end)))
}

/// Where a segment starts, and its moves with their lines of the source.
type Moves = Result<(Pose, Vec<(u32, Op)>), NoPose>;

fn assemble(
    name: &str,
    segments: &[Segment],
    feeds: bool,
    moves: impl Fn(&Segment) -> Moves,
) -> Result<Program, NoPose> {
    let mut program = Program::new(name);
    let mut feed = None;
    let mut line = 0;
    for segment in segments {
        let (start, moves) = moves(segment)?;
        line = segment.starts_by();
        if segment.stop {
            program.push(line, Op::Stop);
        }
        if segment.thread {
            program.push(line, Op::Rapid(start));
            program.push(line, Op::ThreadWire);
        }
        if let Some(new) = segment.feed.filter(|new| feeds && feed.replace(*new) != Some(*new)) {
            program.push(line, Op::Feed(Feed::PerMinute(new)));
        }
        // The control offsets and tilts the wire from the first move on, and ends that with the last.
        let last = moves.len().saturating_sub(1);
        for (i, (from, op)) in moves.into_iter().enumerate() {
            line = from;
            match segment.by_control {
                Some(it) if i == 0 => it.push(&mut program, line, it.taper != 0.0),
                Some(it) if i == last => ByControl::OFF.push(&mut program, line, it.taper != 0.0),
                _ => {}
            }
            program.push(line, op);
        }
        if segment.cut {
            program.push(line, Op::CutWire);
        }
    }
    program.push(line, Op::End);
    Ok(program)
}

fn exact(contour: &Contour) -> Moves {
    let moves = contour.elements().iter().map(|element| Ok((element.line, op(element)?)));
    Ok((upright(contour.start())?, moves.collect::<Result<_, _>>()?))
}

fn op(element: &Element) -> Result<Op, NoPose> {
    let end = upright(element.end)?;
    Ok(match element.turn {
        None => Op::Line(end),
        Some(turn) => {
            let normal = Vec3::Z * turn.sweep.signum();
            Op::Arc(Box::new(ArcTo {
                end,
                circle: Circle::new(turn.center.extend(0.0), normal, 0)?,
            }))
        }
    })
}

fn divided(points: &Points, first: u32, height: f64) -> Moves {
    let pose = |(i, lower): (usize, &Vec2)| {
        let lean = points.upper.get(i).map_or(Vec2::ZERO, |upper| *upper - *lower);
        match lean == Vec2::ZERO {
            true => upright(*lower),
            false => Pose::new(lower.extend(0.0), lean.extend(height).normalize()),
        }
    };
    let mut poses = points.lower.iter().enumerate().map(pose);
    let start = poses.next().unwrap_or_else(|| upright(Vec2::ZERO))?;
    let line = |i| points.line_of(i).unwrap_or(first);
    let moves = (1..).zip(poses).map(|(i, pose)| Ok((line(i), Op::Line(pose?))));
    Ok((start, moves.collect::<Result<_, _>>()?))
}

fn upright(point: Vec2) -> Result<Pose, NoPose> {
    Pose::upright(point.extend(0.0))
}
