//! What an arm makes of a toolpath before anything is written: its joints along the way, its margins, and how it would be elsewhere.

use super::plan::{Act, Kind, Motion, Position, Reentry, Step, slows_at, stretches};
use super::rail::{Stand, groups};
use super::rapid::RapidPlanner;
use crate::arcs::arc_through;
use crate::center;
use ::arm::{Arm, Joints};
use armpath::{Cell as Frames, Point, SPACING, Worst, ease_of, stand};
use geom::{Frame, Mat3, Quat, Vec3, angle_between, wrap};
use machine::{Cell, Machine};
use program::{Diagnostic, Program};
use std::borrow::Cow;

/// At so many points of a tool's path the arm is looked at elsewhere.
const LOOKS: usize = 48;

/// Between samples of a cut the tool turns by no more than this, radians (2 degrees), and there are no more of them.
const LEAN: f64 = std::f64::consts::PI / 90.0;
const MOST: f64 = 10_000.0;

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
    /// How often the tool leaves a cut and enters it again.
    pub reentries: usize,
}

/// Where an arm stands along a toolpath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmSample {
    /// Line of the source.
    pub line: u32,
    /// Whether the tool cuts on the way here; else it comes by rapid.
    pub cuts: bool,
    /// Whether the tool has left the cut here, and enters it again.
    pub enters_again: bool,
    /// Seconds from the first sample, at the feeds of the source, slower where the tool would lean over faster than twice `turn_speed` of the options, and the rapid of the cell; without acceleration.
    pub time: f64,
    /// The tool tip in the frame of the part, mm.
    pub tip: Vec3,
    /// Degrees, as the model of the arm counts them.
    pub joints: [f64; 6],
    /// Which part of its speed each joint needs on the way here, where the tool cuts.
    pub speeds: [f64; 6],
    /// Where the rail stands on which the arm is, mm; 0 without one.
    pub rail: f64,
    /// How easily it stands, as [`ArmMargins::ease`] without speeds.
    pub ease: f64,
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

/// The least margins of the joints that the writer chooses along `program` for `machine`, a robot; none where nothing moves.
///
/// # Errors
/// What an arm cannot do, or this one cannot reach, with the line of the source and the margin; the machine is no robot.
pub fn arm_margins(
    program: &Program,
    machine: &Machine,
) -> Result<Option<ArmMargins>, Vec<Diagnostic>> {
    let (program, offsets) = followed(program, machine)?;
    chosen(&program, machine, offsets).map(|(_, margins)| margins)
}

/// Where the writer lets the arm stand along `program`, at its points and every 5 mm or 2° between those of cuts, and the margins.
///
/// # Errors
/// As [`arm_margins`].
pub fn arm_samples(
    program: &Program,
    machine: &Machine,
) -> Result<(Vec<ArmSample>, Option<ArmMargins>), Vec<Diagnostic>> {
    let (arm, cell) = robot(machine)?;
    let (program, offsets) = followed(program, machine)?;
    let (steps, margins) = chosen(&program, machine, offsets)?;
    let (tool, turn_speed) = (cell.tool(None), machine.turn_speed());
    let mut along =
        Along { arm, cell, tool, turn_speed, here: None, time: 0.0, samples: Vec::new() };
    for step in &steps {
        match step {
            Step::Act(Act::Tool(tool), ..) => {
                (along.tool, along.here) = (cell.tool(tool.length), None);
            }
            Step::Act(Act::Home, ..) => along.here = None,
            Step::Act(..) => {}
            Step::Move(motion) => along.go(motion),
            Step::Reenter(reentry) => along.reenter(reentry, cell.joint_speed),
        }
    }
    Ok((along.samples, margins))
}

/// The steps of a program, whose contours have been offset or not, and the least margins of all tools.
///
/// # Errors
/// As [`arm_margins`].
fn chosen<'a>(
    program: &'a Program,
    machine: &Machine,
    offsets: bool,
) -> Result<(Vec<Step<'a>>, Option<ArmMargins>), Vec<Diagnostic>> {
    let robot = robot(machine)?;
    let mut steps = Vec::new();
    let mut margins: Option<ArmMargins> = None;
    let rapids = RapidPlanner::new(program, machine, robot);
    let found = stretches(program, machine, robot.1).and_then(|stretches| {
        for stretch in stretches {
            for worst in stretch.chosen(&rapids, &mut steps)? {
                margins = Some(margins.map_or(ArmMargins::of(&worst), |known| known.least(&worst)));
            }
        }
        Ok(())
    });
    found.map_err(|found| vec![*found])?;
    let mut reentries = 0;
    for step in &steps {
        let Step::Reenter(reentry) = step else { continue };
        if reentry.feed.is_none() || offsets {
            return Err(vec![reentry.refusal(!offsets, robot.1)]);
        }
        reentries += 1;
    }
    Ok((steps, margins.map(|margins| ArmMargins { reentries, ..margins })))
}

/// An arm on its way.
struct Along<'a> {
    arm: &'a Arm,
    cell: &'a Cell,
    tool: Option<Frame>,
    /// Degrees/s.
    turn_speed: Option<f64>,
    here: Option<Position>,
    time: f64,
    samples: Vec<ArmSample>,
}

impl Along<'_> {
    fn go(&mut self, motion: &Motion) {
        let from = self.here.replace(motion.end);
        let length = from.as_ref().map_or(0.0, |from| motion.length(from));
        let whole = 60.0 * length / motion.feed;
        let between = from.zip(self.tool).filter(|_| motion.kind != Kind::Rapid);
        if let Some((from, tool)) = between {
            let [a, b] = [&from.tool.matrix3, &motion.end.tool.matrix3].map(Quat::from_mat3);
            let lean = angle_between(from.tool.matrix3.z_axis, motion.end.tool.matrix3.z_axis);
            // As for the choice: controllers go slower than the feed where the tool would turn too fast.
            let whole = whole.max(slows_at(self.turn_speed).map_or(0.0, |rate| lean / rate));
            let parts = (length / SPACING).max(a.angle_between(b) / LEAN).ceil().clamp(1.0, MOST);
            let tip = path(motion.kind, from.tool.translation, motion.end.tool.translation);
            let posture = self.arm.posture(&motion.end.joints);
            let part_frame = self.cell.part_from(motion.end.rail);
            let mut before = from.joints;
            for k in 1..parts as usize {
                let part = k as f64 / parts;
                let turned = Mat3::from_quat(a.slerp(b, part));
                let at = Frame::from_mat3_translation(turned, tip(part));
                let flange = part_frame * at * tool.inverse();
                let Some(joints) = self.arm.inverse_in(posture, &flange, before[3]) else {
                    continue;
                };
                let joints: Joints =
                    std::array::from_fn(|i| before[i] + wrap(joints[i] - before[i]));
                self.sample(motion, (at.translation, joints), (before, whole / parts));
                before = joints;
            }
            let end = (motion.end.tool.translation, motion.end.joints);
            return self.sample(motion, end, (before, whole / parts));
        }
        let end = (motion.end.tool.translation, motion.end.joints);
        self.sample(motion, end, (motion.end.joints, whole));
    }

    /// The arm stands otherwise where it has left a cut: as long as its joints take for that the samples are apart.
    fn reenter(&mut self, reentry: &Reentry, percent: f64) {
        let Some(from) = self.here.replace(reentry.back) else { return };
        let joints = self.arm.joints().iter().zip(from.joints.iter().zip(reentry.back.joints));
        let times = joints.map(|(joint, (a, b))| (b - a).abs() * 100.0 / (joint.speed * percent));
        self.time += times.fold(0.0, f64::max);
        let joints = reentry.back.joints;
        self.samples.push(ArmSample {
            line: reentry.line,
            cuts: false,
            enters_again: true,
            time: self.time,
            tip: reentry.back.tool.translation,
            joints: joints.map(f64::to_degrees),
            speeds: [0.0; 6],
            rail: reentry.back.rail,
            ease: ease_of(self.arm, &joints),
        });
    }

    fn sample(
        &mut self,
        motion: &Motion,
        (tip, joints): (Vec3, Joints),
        (before, time): (Joints, f64),
    ) {
        self.time += time;
        let speed = |i: usize| match time > 0.0 {
            true => (joints[i] - before[i]).abs() / (time * self.arm.joints()[i].speed),
            false => 0.0,
        };
        self.samples.push(ArmSample {
            line: motion.line,
            cuts: motion.kind != Kind::Rapid,
            enters_again: false,
            time: self.time,
            tip,
            joints: joints.map(f64::to_degrees),
            speeds: std::array::from_fn(speed),
            rail: motion.end.rail,
            ease: ease_of(self.arm, &joints),
        });
    }
}

/// The tip along a cut, from 0 to 1.
fn path(kind: Kind, from: Vec3, to: Vec3) -> impl Fn(f64) -> Vec3 {
    let arc = match kind {
        Kind::Arc(via) => arc_through(from, via, to),
        Kind::Line | Kind::Rapid => None,
    };
    move |part| arc.map_or_else(|| from.lerp(to, part), |arc| arc.at(part))
}

impl<'m> ArmLooks<'m> {
    /// Points of `program` for `machine`, a robot.
    ///
    /// # Errors
    /// What no arm can do; the machine is no robot.
    pub fn of(program: &Program, machine: &'m Machine) -> Result<ArmLooks<'m>, Vec<Diagnostic>> {
        let (arm, cell) = robot(machine)?;
        let (program, _) = followed(program, machine)?;
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
        if self.cell.rail.is_some() {
            return self.ease_on_rail(part);
        }
        self.tools.iter().try_fold(f64::INFINITY, |least, tool| {
            let frames = Frames { tool: self.cell.tool(tool.length)?, part };
            let points: Vec<Point> = tool.looks.iter().map(|at| tool.points[*at]).collect();
            Some(least.min(stand(self.arm, &frames, &points, TURNS)?))
        })
    }

    /// The same of an arm on a rail, which goes to several places for a tool.
    fn ease_on_rail(&self, part: Frame) -> Option<f64> {
        let cell = Cell { part, ..self.cell.clone() };
        self.tools.iter().try_fold(f64::INFINITY, |least, tool| {
            let stand = Stand { arm: self.arm, cell: &cell, tool: cell.tool(tool.length)? };
            let groups = groups(&stand, &tool.points);
            groups.into_iter().try_fold(least, |least, group| Some(least.min(group.ease?)))
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
            reentries: 0,
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
            reentries: 0,
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

/// The program whose path the arm follows: of a contour the path of the tool's centre; and whether there was one.
fn followed<'a>(
    program: &'a Program,
    machine: &Machine,
) -> Result<(Cow<'a, Program>, bool), Vec<Diagnostic>> {
    let centered = center::centered(program, machine.resolution());
    Ok(match centered.map_err(|found| vec![*found])? {
        Some((centered, _)) => (Cow::Owned(centered), true),
        None => (Cow::Borrowed(program), false),
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
