//! What an arm makes of a toolpath before anything is written: its joints along the way, its margins, and how it would be elsewhere.

use super::plan::{self, Kind, Step, stretches};
use crate::center;
use ::arm::{Arm, Joints};
use armpath::{Cell as Frames, Point, Worst, stand};
use geom::Frame;
use machine::{Cell, Machine};
use program::{Diagnostic, Program};
use std::borrow::Cow;

/// At so many points of a tool's path the arm is looked at elsewhere.
const LOOKS: usize = 48;

/// At so many turns about the tool.
const TURNS: u16 = 24;

/// The least margins of an arm along a toolpath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmMargins {
    /// Of a joint from its limit, degrees.
    pub limit: f64,
    /// Of joint 5 from stretched or folded, degrees.
    pub wrist: f64,
    /// Of the elbow from stretched or folded, degrees.
    pub elbow: f64,
    /// Of the wrist from axis 1, mm.
    pub shoulder: f64,
    /// The largest part of a joint's speed in a cut, percent.
    pub speed: f64,
    /// The least of them, as a part of what is ample: above 1 where all are.
    pub ease: f64,
}

/// A motion of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmMotion {
    /// Line of the source.
    pub line: u32,
    /// Whether it cuts; else it is a rapid.
    pub cuts: bool,
    /// mm/min.
    pub feed: f64,
    /// Length of the straight line to its end, mm; of an arc, at least that of the two lines through its middle.
    pub length: f64,
    /// The tool at its end, in the frame of the part.
    pub tool: Frame,
    /// The joints at its end, radians.
    pub joints: Joints,
}

/// The motions of an arm along a toolpath.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmMotions {
    /// In their order.
    pub motions: Vec<ArmMotion>,
    /// None where nothing moves.
    pub margins: Option<ArmMargins>,
}

/// A toolpath at so few points that many places of the part can be looked at.
#[derive(Clone, Debug)]
pub struct ArmLooks<'m> {
    arm: &'m Arm,
    cell: &'m Cell,
    tools: Vec<ToolPoints>,
}

/// The points of one tool's path.
#[derive(Clone, Debug)]
struct ToolPoints {
    /// Its length, where it is stated, mm.
    length: Option<f64>,
    points: Vec<Point>,
    /// The line of the source of each.
    lines: Vec<u32>,
    /// Numbers of those that are looked at.
    looks: Vec<usize>,
}

/// The joints that the writer chooses along `program` for `machine`, a robot, and the margins.
///
/// # Errors
/// What an arm cannot do, or this one cannot reach, with the line of the source and the margin; the machine is no robot.
pub fn arm_motions(program: &Program, machine: &Machine) -> Result<ArmMotions, Vec<Diagnostic>> {
    let (arm, cell) = robot(machine)?;
    let program = followed(program, machine)?;
    let mut steps = Vec::new();
    let mut margins: Option<ArmMargins> = None;
    let found = stretches(&program, machine, cell).and_then(|stretches| {
        for stretch in stretches {
            if let Some(worst) = stretch.chosen((arm, cell), &mut steps)? {
                margins = Some(margins.map_or(ArmMargins::of(&worst), |known| known.least(&worst)));
            }
        }
        Ok(())
    });
    found.map_err(|found| vec![*found])?;
    let mut here: Option<plan::Position> = None;
    let motions = steps.iter().filter_map(|step| match step {
        Step::Act(..) => None,
        Step::Move(motion) => {
            let length = here.replace(motion.end).map_or(0.0, |from| motion.length(&from));
            let plan::Position { tool, joints } = motion.end;
            let cuts = motion.kind != Kind::Rapid;
            Some(ArmMotion { line: motion.line, cuts, feed: motion.feed, length, tool, joints })
        }
    });
    Ok(ArmMotions { motions: motions.collect(), margins })
}

impl<'m> ArmLooks<'m> {
    /// Points of `program` for `machine`, a robot.
    ///
    /// # Errors
    /// What no arm can do; the machine is no robot.
    pub fn of(program: &Program, machine: &'m Machine) -> Result<ArmLooks<'m>, Vec<Diagnostic>> {
        let (arm, cell) = robot(machine)?;
        let program = followed(program, machine)?;
        let stretches = stretches(&program, machine, cell).map_err(|found| vec![*found])?;
        let tools = stretches.into_iter().filter(|stretch| !stretch.points.is_empty());
        let tools = tools.map(|stretch| ToolPoints {
            length: stretch.length,
            looks: spread(&stretch.points),
            points: stretch.points,
            lines: stretch.lines,
        });
        Ok(ArmLooks { arm, cell, tools: tools.collect() })
    }

    /// Looks at a point of this line of the source as well.
    pub fn look_at(&mut self, line: u32) {
        for tool in &mut self.tools {
            let is_new = |at: &usize| tool.lines[*at] == line && !tool.looks.contains(at);
            let new = (0..tool.lines.len()).rev().find(is_new);
            tool.looks.extend(new);
            tool.looks.sort_unstable();
        }
    }

    /// Where the machine file puts the part, in the world of the controller.
    pub fn part(&self) -> Frame {
        self.cell.part
    }

    /// How easily the arm stands at all of them with the part there, as [`ArmMargins::ease`] without speeds, with one turn about the tool and one
    /// posture for each tool; `None` where it does not.
    pub fn ease(&self, part: Frame) -> Option<f64> {
        self.tools.iter().try_fold(f64::INFINITY, |least, tool| {
            let frames = Frames { tool: self.cell.tool(tool.length)?, part };
            let points: Vec<Point> = tool.looks.iter().map(|at| tool.points[*at]).collect();
            Some(least.min(stand(self.arm, &frames, &points, TURNS)?))
        })
    }
}

impl ArmMargins {
    fn of(worst: &Worst) -> ArmMargins {
        ArmMargins {
            limit: worst.limit.0.to_degrees(),
            wrist: worst.wrist.0.to_degrees(),
            elbow: worst.elbow.0.to_degrees(),
            shoulder: worst.shoulder.0,
            speed: 100.0 * worst.speed.0,
            ease: worst.ease(),
        }
    }

    fn least(self, worst: &Worst) -> ArmMargins {
        let other = ArmMargins::of(worst);
        ArmMargins {
            limit: self.limit.min(other.limit),
            wrist: self.wrist.min(other.wrist),
            elbow: self.elbow.min(other.elbow),
            shoulder: self.shoulder.min(other.shoulder),
            speed: self.speed.max(other.speed),
            ease: self.ease.min(other.ease),
        }
    }
}

fn robot(machine: &Machine) -> Result<(&Arm, &Cell), Vec<Diagnostic>> {
    crate::robot(machine).ok_or_else(|| {
        let message = format!("`{}` is no robot with a cell", machine.name);
        let help = "`toolpost machines list` names the robots";
        vec![Diagnostic::error(program::Rule::Unsupported, message).help(help)]
    })
}

/// The program whose path the arm follows: of a contour the path of the tool's centre.
fn followed<'a>(
    program: &'a Program,
    machine: &Machine,
) -> Result<Cow<'a, Program>, Vec<Diagnostic>> {
    let centered = center::centered(program, machine.resolution());
    Ok(match centered.map_err(|found| vec![*found])? {
        Some((centered, _)) => Cow::Owned(centered),
        None => Cow::Borrowed(program),
    })
}

/// The numbers of some of many points, and of those that lie farthest out.
fn spread(points: &[Point]) -> Vec<usize> {
    let every = points.len().div_ceil(LOOKS);
    let mut chosen: Vec<usize> = (0..points.len()).step_by(every).collect();
    for axis in 0..3 {
        let by = |a: &usize, b: &usize| points[*a].tip[axis].total_cmp(&points[*b].tip[axis]);
        chosen.extend((0..points.len()).min_by(by));
        chosen.extend((0..points.len()).max_by(by));
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}
