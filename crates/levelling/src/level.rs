//! A program that follows a surface.

use crate::ground::Ground;
use crate::surface_line::{SurfaceLine, heights_along};
use geom::{Vec2, Vec3};
use program::heights::HeightMap;
use program::{
    ArcTo, Circle, Compensation, Diagnostic, Feed, Op, Outcome, Pose, Program, Record, Rule,
    WorkOffset,
};
use std::f64::consts::TAU;

/// The most records of a levelled program, which are kept in memory.
const MOST_RECORDS: usize = 20_000_000;

/// Pieces of an arc that are shorter go straight, mm: rounded, they could be taken for full circles.
const SHORT: f64 = 0.01;

/// What two radii of an arc may differ by, mm.
const ROUND: f64 = 0.01;

/// How much a levelled program may leave the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowed {
    /// How far the tool may be from its height over the surface, mm, 0.0001 at least.
    pub deviation: f64,
    /// How far outside the places that were probed a cut may go, mm, where the surface is taken to be as high as
    /// at their edge.
    pub outside: f64,
}

/// The program with the surface of `map` where `program` has Z 0: each cut is as far from the surface as it was
/// from Z 0, its lines and arcs divided so that they follow it; an arc becomes a helix. Holes go down from
/// the surface where they are. Rapids stay as far above the highest place as they were above Z 0; those straight
/// down, and in a hole, keep their distance from the surface there.
///
/// # Errors
/// What cannot be levelled, with its line: a cut outside the map, a tilted tool, an arc in another plane than
/// XY, threads and probing moves, a cycle that retracts to less than the highest place, radius compensation, feeds as inverse time, a rapid along the board below its
/// surface, several work offsets, a cut from an unknown place.
pub fn level(program: &Program, map: &HeightMap, allowed: &Allowed) -> Outcome<Program> {
    let levelled = levelled(program, Ground::Known(map), allowed)?;
    Ok(program.with_records(levelled.records))
}

/// The same for any surface.
pub(crate) fn levelled<'a>(
    program: &Program,
    ground: Ground<'a>,
    allowed: &'a Allowed,
) -> Outcome<Level<'a>> {
    let mut level = Level::new(ground, allowed)?;
    for record in program.each() {
        level.record(record).map_err(|found| Box::new(found.line(record.line)))?;
    }
    Ok(level)
}

/// Where the tool is: as the program has it, and its height over the surface.
#[derive(Clone, Copy, Debug)]
struct ToolPosition {
    planned: Vec3,
    height: f64,
}

/// A program as far as it is levelled.
pub(crate) struct Level<'a> {
    ground: Ground<'a>,
    allowed: &'a Allowed,
    /// By how much rapids are higher, mm.
    lift: f64,
    tool_at: Option<ToolPosition>,
    /// Retract level of the cycle that holds, mm above the point of a hole.
    retract: f64,
    work_offset: Option<WorkOffset>,
    /// Z of the highest pose that keeps its distance from the surface, mm.
    pub(crate) follows: f64,
    /// Z of the lowest that is above all of it instead, mm.
    pub(crate) clears: f64,
    pub(crate) records: Vec<Record>,
}

impl<'a> Level<'a> {
    /// # Errors
    /// Tolerances that nothing keeps.
    fn new(ground: Ground<'a>, allowed: &'a Allowed) -> Outcome<Level<'a>> {
        if !(allowed.deviation >= 1e-4 && allowed.deviation.is_finite() && allowed.outside >= 0.0) {
            let message = format!(
                "a deviation of {} mm, {} mm outside the map",
                allowed.deviation, allowed.outside
            );
            let help = "a deviation of 0.0001 mm at least, and no negative distance";
            return Err(Diagnostic::error(Rule::LevellingTolerance, message).help(help).into());
        }
        Ok(Level {
            ground,
            allowed,
            lift: ground.highest().max(0.0),
            tool_at: None,
            retract: 0.0,
            work_offset: None,
            follows: f64::NEG_INFINITY,
            clears: f64::INFINITY,
            records: Vec::new(),
        })
    }

    fn record(&mut self, record: &Record) -> Outcome {
        let line = record.line;
        match &record.op {
            Op::Rapid(pose) => {
                let planned = upright(pose)?;
                self.rapid(line, planned)
            }
            Op::Line(pose) => {
                let to = upright(pose)?;
                let from = self.start(line, to)?;
                self.inside(from, to)?;
                for (t, z) in self.heights_along(SurfaceLine::Line(from, to))? {
                    let at = SurfaceLine::Line(from, to).at(t);
                    self.push(line, Op::Line(Pose::upright(at.with_z(z))?))?;
                }
                self.arrive(to);
                Ok(())
            }
            Op::Arc(arc) => self.arc(line, arc),
            Op::Hole(pose) => {
                let point = upright(pose)?;
                self.inside(point, point)?;
                let height = self.ground.at(point.truncate());
                // From there the tool goes to the next one.
                if point.z + height + self.retract < self.ground.highest() {
                    let message = format!(
                        "from a hole the tool goes on at {} mm above it, and the board rises higher",
                        self.retract
                    );
                    return Err(refused(message, "a higher retract level of the cycle"));
                }
                self.push(line, Op::Hole(Pose::upright(point + Vec3::Z * height)?))?;
                self.arrive(point + Vec3::Z * self.retract);
                Ok(())
            }
            op => {
                self.modal(op)?;
                self.push(line, op.clone())
            }
        }
    }

    /// What is no move and stays as it is.
    fn modal(&mut self, op: &Op) -> Outcome {
        match op {
            Op::Rapid(_) | Op::Line(_) | Op::Arc(_) | Op::Hole(_) => {}
            Op::Cycle(cycle) => self.retract = cycle.retract,
            Op::Tool(_) | Op::Home => self.tool_at = None,
            Op::WorkOffset(number) => match self.work_offset.replace(*number) {
                Some(before) if before != *number => {
                    let message = "the program works in several work offsets, the map in one";
                    return Err(refused(message, "post each as a program of its own"));
                }
                _ => {}
            },
            Op::Thread(_) | Op::Probe(_) | Op::Surface(_) => {
                let message = "a thread, a probing move or a surface of its own in a program that is levelled";
                return Err(refused(message, "post it as a program of its own"));
            }
            Op::Oriented(_) | Op::Joints(_) | Op::MachineMove(_) => {
                let message =
                    "a move of a robot, or in machine coordinates, in a program that is levelled";
                return Err(refused(message, "post it as a program of its own"));
            }
            Op::Compensation(Compensation::Left(_) | Compensation::Right(_)) => {
                let message =
                    "radius compensation: the control decides the path of the tool's centre";
                return Err(refused(message, "post the path of the tool's centre"));
            }
            Op::Feed(Feed::InverseTime(_)) => {
                let message = "a feed as inverse time, and moves that are divided";
                return Err(refused(message, "post with feeds in mm/min"));
            }
            Op::Feed(_)
            | Op::Compensation(Compensation::Off)
            | Op::CycleOff
            | Op::PathMode(_)
            | Op::Spindle(_)
            | Op::SurfaceSpeed(_)
            | Op::Coolant(_)
            | Op::Beam(_)
            | Op::Pulses(_)
            | Op::Preselect(_)
            | Op::Frame(_)
            | Op::Clamp(_)
            | Op::WorkOffsetData(_)
            | Op::Output(_)
            | Op::Input(_)
            | Op::Auxiliary(_)
            | Op::ThreadWire
            | Op::CutWire
            | Op::Taper(_)
            | Op::Dwell(_)
            | Op::Stop
            | Op::OptionalStop
            | Op::Operation(_)
            | Op::EndOfOperation
            | Op::Comment(_)
            | Op::Message(_)
            | Op::End => {}
        }
        Ok(())
    }

    fn push(&mut self, line: u32, op: Op) -> Outcome {
        if self.records.len() >= MOST_RECORDS {
            let message = format!("the levelled program has more than {MOST_RECORDS} records");
            return Err(refused(message, "allow a larger deviation, or level it in parts"));
        }
        if let Some(pose) = op.pose().filter(|_| !matches!(op, Op::Rapid(_))) {
            self.follows = self.follows.max(pose.point().z);
        }
        self.records.push(Record { line, op });
        Ok(())
    }

    /// The tool is at the height of the surface above `planned`.
    fn arrive(&mut self, planned: Vec3) {
        let height = planned.z + self.ground.at(planned.truncate());
        self.tool_at = Some(ToolPosition { planned, height });
    }

    fn rapid(&mut self, line: u32, planned: Vec3) -> Outcome {
        let from = self.tool_at.map(|at| at.planned);
        let upright = from.filter(|from| from.truncate() == planned.truncate());
        let is_down = upright.is_some_and(|from| planned.z < from.z);
        if planned.z < 0.0 && upright.is_none() {
            let message = format!("a rapid along the board to Z{} mm, below it", planned.z);
            return Err(refused(message, "go there at feed, or above the board"));
        }
        if planned.z < 0.0 || is_down {
            let height = planned.z + self.ground.at(planned.truncate());
            self.follows = self.follows.max(height);
            return self.rapid_to(line, planned, height);
        }
        // Before it goes on across the board, what has come down goes up again.
        let low = self.tool_at.filter(|at| at.height < at.planned.z + self.lift);
        if let Some(ToolPosition { planned, .. }) =
            low.filter(|low| upright.is_none() && low.planned.z >= 0.0)
        {
            self.lifted(line, planned)?;
        }
        self.lifted(line, planned)
    }

    /// By rapid to a point above all of the surface.
    fn lifted(&mut self, line: u32, planned: Vec3) -> Outcome {
        let height = planned.z + self.lift;
        self.clears = self.clears.min(height);
        self.rapid_to(line, planned, height)
    }

    fn rapid_to(&mut self, line: u32, planned: Vec3, height: f64) -> Outcome {
        self.tool_at = Some(ToolPosition { planned, height });
        self.push(line, Op::Rapid(Pose::upright(planned.with_z(height))?))
    }

    /// Where a cut to `to` starts: the tool goes down to the surface's height there, unless the cut itself goes
    /// straight down.
    fn start(&mut self, line: u32, to: Vec3) -> Outcome<Vec3> {
        let Some(ToolPosition { planned, height }) = self.tool_at else {
            let message = "a cut from a position that is not known";
            return Err(refused(message, "a rapid to its start before it"));
        };
        let wanted = planned.z + self.ground.at(planned.truncate());
        if wanted != height && planned.truncate() != to.truncate() {
            self.push(line, Op::Line(Pose::upright(planned.with_z(wanted))?))?;
        }
        Ok(planned)
    }

    fn heights_along(&self, line: SurfaceLine) -> Outcome<Vec<(f64, f64)>> {
        heights_along(line, &self.ground, self.allowed.deviation).ok_or_else(|| {
            let message = "a move over so much of the surface that it has more than 100000 pieces";
            refused(message, "allow a larger deviation, or divide it")
        })
    }

    fn arc(&mut self, line: u32, to: &ArcTo) -> Outcome {
        let end = upright(&to.end)?;
        if to.circle.normal().truncate() != Vec2::ZERO {
            let message = "an arc that does not turn in the plane XY";
            return Err(refused(message, "post it as lines"));
        }
        // A full circle ends where it starts, and goes down first all the same.
        let from = self.start(line, Vec3::NAN)?;
        let arc = to.circle.arc(from, end, ROUND);
        let arc = arc.map_err(|_| {
            refused("an arc whose ends are not equally far from its centre", "correct the source")
        })?;
        let (low, high) = arc.extents();
        self.inside(low, high)?;
        let along = SurfaceLine::Arc(&arc);
        let mut before = 0.0;
        for (t, z) in self.heights_along(along)? {
            let pose = Pose::upright(along.at(t).with_z(z))?;
            let sweep = (t - before) * arc.sweep;
            let op = match sweep * arc.radius() < SHORT {
                true => Op::Line(pose),
                false => {
                    // Ends that meet are one turn, not none.
                    let turns = ((sweep / TAU - 1e-9).ceil() - 1.0).max(0.0) as u32;
                    let circle = Circle::new(to.circle.center(), to.circle.normal(), turns)?;
                    Op::Arc(Box::new(ArcTo { end: pose, circle }))
                }
            };
            self.push(line, op)?;
            before = t;
        }
        self.arrive(end);
        Ok(())
    }

    /// # Errors
    /// A cut between two corners goes further outside the map than is allowed.
    fn inside(&self, one: Vec3, other: Vec3) -> Outcome {
        let (from, to) = self.ground.extents();
        let (low, high) = (one.min(other).truncate(), one.max(other).truncate());
        let outside = (from - low).max(high - to).max_element();
        if outside <= self.allowed.outside {
            return Ok(());
        }
        let message = format!(
            "a cut goes {outside:.3} mm beyond what was probed, X{} to X{} and Y{} to Y{}",
            from.x, to.x, from.y, to.y
        );
        Err(refused(message, "probe all of the board, or see that both have the same zero"))
    }
}

/// The point of a pose whose tool is upright.
fn upright(pose: &Pose) -> Outcome<Vec3> {
    if pose.axis() != Vec3::Z {
        return Err(refused("the tool is tilted", "level a program whose tool is upright"));
    }
    Ok(pose.point())
}

pub(crate) fn refused(message: impl Into<String>, help: &str) -> Box<Diagnostic> {
    Diagnostic::error(Rule::Levelling, message).help(help).into()
}
