//! From records to the motions of an arm: where they end, and with which joints.

use super::rail::{Group, Stand, groups};
use super::rapid::RapidPlanner;
use ::arm::{Arm, Joints};
use armpath::{Cell as Frames, Choice, Point, Settings, Why, Worst, choose};
use geom::{Arc, Frame, Mat3, Vec3};
use machine::{Cell, Machine};
use program::lowering::{HoleMove, feed_per_minute, hole};
use program::{
    CompensatedPath, Compensation, Coolant, Cycle, Diagnostic, Feed, Op, Outcome, Output, PathMode,
    Pose, Program, Record, Rule, Spindle, Tool,
};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// How far the radii at the ends of an arc of the source may differ, as a part of them.
const RADII: f64 = 0.01;

/// Points along an arc, at which joints are looked for, are so far apart at the most, radians.
const ALONG_ARC: f64 = 0.1;

/// Arcs that turn by less than this, radians, or from whose start the point half way is nearer than this, mm, are written as chords:
/// controllers refuse three points so near to a line or to each other (RAPID: 1° between the other two points, 0.1 mm).
const LEAST_SWEEP: f64 = 0.08;
const LEAST_CHORD: f64 = 0.12;

/// So many places of the rail are tried for points that are cut from one.
const TRIES: usize = 4;

/// Chords leave an arc in a plane by no more steps of the words; one that a single chord leaves by no more is written as that.
const FLATTEST: f64 = 2.0;

/// What an arm does, in order.
pub(super) enum Step<'a> {
    /// A motion.
    Move(Motion),
    /// The tool leaves the cut, and enters it again at the same place.
    Reenter(Reentry),
    /// What happens between motions, and its line and record of the source.
    Act(Act<'a>, u32, usize),
}

/// A cut that is left and entered again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reentry {
    /// Line of the source.
    pub(super) line: u32,
    /// Where the arm stands when it is back.
    pub(super) back: Position,
    /// mm/min; `None` where the cell allows no cut to be left.
    pub(super) feed: Option<f64>,
    /// What ends the cut with the turn and the posture before.
    pub(super) why: Why,
}

impl Reentry {
    /// What is wrong where no cut may be left, and whether it would help to allow that.
    pub(super) fn refusal(&self, helps: bool, cell: &Cell) -> Diagnostic {
        let why = self.why;
        let message = format!(
            "no turn about the tool and no posture passes the whole cut: behind this point {why}, and the arm would have to retract, turn \
             and enter the cut again"
        );
        let help = match helps {
            true => {
                "`reentry_feed` below [cell] of the machine file allows that; or move the part (`part`), or cut it in two operations"
            }
            false => {
                "that cannot be written here: another place of the part (`toolpost fit` looks for one), or cut it in two operations"
            }
        };
        let help = with_cable(help.to_owned(), why, cell);
        Diagnostic::error(Rule::ArmPath, message).help(help).line(self.line)
    }
}

/// A way out, with the key of the cell that bounds the joint where it is that.
fn with_cable(help: String, why: Why, cell: &Cell) -> String {
    let bounded = match why {
        Why::Limit(joint, _) | Why::Range(joint) => cell.cable(joint),
        Why::Reach(_)
        | Why::Wrist(_)
        | Why::Shoulder(_)
        | Why::Elbow(_)
        | Why::Speed(..)
        | Why::Apart
        | Why::Numbers => None,
    };
    match bounded {
        Some(cable) => format!("{help}; {cable}"),
        None => help,
    }
}

/// What happens between motions.
#[derive(Clone, Copy, Debug)]
pub(super) enum Act<'a> {
    Tool(&'a Tool),
    Home,
    Spindle(Spindle),
    Coolant(Coolant),
    /// Seconds.
    Dwell(f64),
    Stop,
    Output(Output),
    Operation(&'a str),
    Text(&'a str),
}

/// A motion to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// Line of the source.
    pub(super) line: u32,
    /// Which record of the source it is.
    pub(super) record: usize,
    pub(super) kind: Kind,
    /// mm/min; of a rapid that of the cell.
    pub(super) feed: f64,
    /// Where it ends.
    pub(super) end: Position,
    /// How far its end may be left, mm, where it cuts.
    pub(super) corner: f64,
}

impl Motion {
    /// How long its path is from there, mm.
    pub(super) fn length(&self, from: &Position) -> f64 {
        let [a, b] = [from, &self.end].map(|position| position.tool.translation);
        match self.kind {
            Kind::Rapid | Kind::Line => a.distance(b),
            // Not longer than the arc itself.
            Kind::Arc(via) => a.distance(via) + via.distance(b),
        }
    }
}

/// How a motion goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Rapid,
    Line,
    /// Through this point, in the frame of the part.
    Arc(Vec3),
}

/// Where the arm is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Position {
    /// The tool in the frame of the part.
    pub(super) tool: Frame,
    pub(super) joints: Joints,
    /// Of the rail, mm; 0 without one.
    pub(super) rail: f64,
}

/// What the source says up to a tool change, and what of it are points of a path.
pub(super) struct Stretch<'a> {
    /// Length of its tool, where the source states it, mm.
    pub(super) length: Option<f64>,
    pub(super) points: Vec<Point>,
    pub(super) lines: Vec<u32>,
    /// How fast the tool may turn, degrees/s, its axis and about it each, where the control states that.
    turn_speed: Option<f64>,
    steps: Vec<Planned<'a>>,
}

enum Planned<'a> {
    /// A motion, and the number of the point at which it ends.
    Move {
        line: u32,
        record: usize,
        kind: Kind,
        feed: f64,
        corner: f64,
        point: usize,
    },
    Act(Act<'a>, u32, usize),
}

/// The motions of a program, with joints.
///
/// # Errors
/// What an arm cannot do, or this one cannot reach, with the line of the source and the margin.
pub(super) fn plan<'a>(
    source: &'a Program,
    machine: &Machine,
    (arm, cell): (&Arm, &Cell),
) -> Outcome<Vec<Step<'a>>> {
    let mut steps = Vec::new();
    let rapids = RapidPlanner::new(source, machine, (arm, cell));
    for stretch in stretches(source, machine, cell)? {
        stretch.chosen(&rapids, &mut steps)?;
    }
    Ok(steps)
}

/// What the source says, by tools.
///
/// # Errors
/// What an arm cannot do.
pub(super) fn stretches<'a>(
    source: &'a Program,
    machine: &Machine,
    cell: &Cell,
) -> Outcome<Vec<Stretch<'a>>> {
    let mut walk = Walk {
        machine,
        cell,
        index: 0,
        stretches: vec![Stretch::new(None, machine.turn_speed())],
        here: None,
        feed: None,
        cycle: None,
        spindle: Spindle::Off,
        corner: machine.path_tolerance(),
        path: source.compensated_path,
    };
    for (index, record) in source.each().enumerate() {
        walk.index = index;
        walk.record(record).map_err(|found| Box::new(found.line(record.line)))?;
    }
    Ok(walk.stretches)
}

impl<'a> Stretch<'a> {
    fn new(length: Option<f64>, turn_speed: Option<f64>) -> Stretch<'a> {
        let (points, lines, steps) = (Vec::new(), Vec::new(), Vec::new());
        Stretch { length, points, lines, turn_speed, steps }
    }

    fn point(&mut self, line: u32, pose: &Pose, cut: Option<f64>) -> usize {
        self.points.push(Point {
            tip: pose.point(),
            axis: pose.axis(),
            side: None,
            cut: cut.is_some(),
            feed: cut.unwrap_or(0.0),
            inside: false,
        });
        self.lines.push(line);
        self.points.len() - 1
    }

    /// The steps, with the joints that are chosen for them; the least margins on the way, of each place of the rail.
    pub(super) fn chosen(
        self,
        rapids: &RapidPlanner,
        steps: &mut Vec<Step<'a>>,
    ) -> Outcome<Vec<Worst>> {
        let chosen = match self.points.is_empty() {
            true => Chosen::default(),
            false => self.positions(rapids)?,
        };
        for step in self.steps {
            match step {
                Planned::Act(act, line, record) => steps.push(Step::Act(act, line, record)),
                Planned::Move { line, record, kind, feed, corner, point } => {
                    let end = chosen.positions[point];
                    steps.push(Step::Move(Motion { line, record, kind, feed, corner, end }));
                    steps.extend(chosen.reentries.get(&point).copied().map(Step::Reenter));
                }
            }
        }
        Ok(chosen.worst)
    }

    fn positions(&self, rapids: &RapidPlanner) -> Outcome<Chosen> {
        let (arm, cell) = (rapids.arm, rapids.cell);
        let Some(tool) = cell.tool(self.length) else {
            let message =
                "neither the source nor `tool_length` of the cell states the length of the tool";
            let help = "LENGTH in the source's tool call, or `tool_length` below [cell] of the machine file";
            return Err(Box::new(
                Diagnostic::error(Rule::ToolLength, message).help(help).line(self.lines[0]),
            ));
        };
        let mut chosen = Chosen::default();
        for group in groups(&Stand { arm, cell, tool }, &self.points) {
            self.place((rapids, tool), &group, &mut chosen)?;
        }
        Ok(chosen)
    }

    /// The positions of points that are cut from one place of the rail.
    fn place(
        &self,
        (rapids, tool): (&RapidPlanner, Frame),
        group: &Group,
        chosen: &mut Chosen,
    ) -> Outcome {
        let (arm, cell) = (rapids.arm, rapids.cell);
        let points = &self.points[group.points.clone()];
        let lines = &self.lines[group.points.clone()];
        // Where axis 1 turns by a revolution the arm reaches everything over its back as well: it does not leave the posture of home.
        let is_round = arm.joints()[0].max - arm.joints()[0].min > TAU;
        let home = arm.model(&cell.home.map(f64::to_radians));
        let settings = settings(self.turn_speed, (home, is_round));
        let at = |rail: f64| {
            let frames = Frames { tool, part: cell.part_from(rail) };
            choose(arm, &frames, points, &settings).map(|choice| (rail, choice))
        };
        // The places have been looked at with some of the points. The first that needs no cut to be left is taken, or the one that needs fewest.
        let left = |rail: f64, choice: &Choice| reentries(rapids, &tool, (points, choice), rail);
        let mut tries = group.places.iter().take(TRIES).map(|rail| at(*rail));
        let mut found = tries.next().unwrap_or_else(|| at(0.0));
        while found.as_ref().map_or(true, |(rail, choice)| left(*rail, choice) != (0, 0)) {
            let Some(next) = tries.next() else { break };
            let is_better = match (&found, &next) {
                (Ok((rail, found)), Ok((other, next))) => left(*other, next) < left(*rail, found),
                (Err(_), Ok(_)) => true,
                (_, Err(_)) => false,
            };
            if is_better {
                found = next;
            }
        }
        let (rail, choice): (f64, Choice) = found.map_err(|blocked| {
            let message = format!("the arm cannot go here: {blocked}");
            let place = match blocked.why {
                Why::Speed(..) | Why::Apart => "move the part (`part` below [cell]), tilt the spindle on the flange, or take a lower feed",
                Why::Reach(_)
                | Why::Limit(..)
                | Why::Range(_)
                | Why::Wrist(_)
                | Why::Shoulder(_)
                | Why::Elbow(_)
                | Why::Numbers => {
                    "move the part (`part` below [cell]; `toolpost fit` looks for places), or tilt the spindle on the flange"
                }
            };
            let mut help = Vec::new();
            let at = points.get(blocked.point);
            let is_far = matches!(blocked.why, Why::Reach(_) | Why::Numbers);
            if at.is_some_and(|point| point.inside) && !is_far {
                help.push("a cut is left and entered again at the ends of an arc alone: divide the arc there in the source, in case another posture passes its rest");
            }
            let stand = Stand { arm, cell, tool };
            let is_long = group.ease.is_none()
                || matches!(blocked.why, Why::Reach(_) | Why::Limit(..) | Why::Elbow(_));
            if is_long && at.is_some_and(|point| stand.reaches(point)) {
                help.push("the rail stands still within a cut, and no place of it reaches the whole of this one: divide the cut in the source");
            }
            help.push(place);
            let help = with_cable(help.join("; or "), blocked.why, cell);
            let line = lines[blocked.point.min(lines.len() - 1)];
            Diagnostic::error(Rule::ArmPath, message).help(help).line(line)
        })?;
        chosen.worst.push(choice.worst);
        for section in &choice.sections {
            let positions = points[section.first..].iter().zip(&section.positions);
            let mut positions = positions.map(|(point, position)| placed(point, position, rail));
            if let Some(why) = section.reentry {
                let (line, feed) = (lines[section.first], cell.reentry_feed);
                if let Some(back) = positions.next() {
                    let point = group.points.start + section.first;
                    chosen.reentries.insert(point, Reentry { line, back, feed, why });
                }
            }
            chosen.positions.extend(positions);
        }
        Ok(())
    }
}

/// A position that is chosen for a point.
fn placed(point: &Point, position: &armpath::Position, rail: f64) -> Position {
    let z = -point.axis;
    let axes = Mat3::from_cols(position.side, z.cross(position.side), z);
    let tool = Frame::from_mat3_translation(axes, point.tip);
    Position { tool, joints: position.joints, rail }
}

/// How often cuts are left and entered again with no way out and in that is clear, and how often in all.
fn reentries(
    rapids: &RapidPlanner,
    tool: &Frame,
    (points, choice): (&[Point], &Choice),
    rail: f64,
) -> (usize, usize) {
    let home = rapids.home(tool);
    let feed = rapids.cell.reentry_feed.unwrap_or(rapids.cell.rapid);
    let again = choice.sections.windows(2).filter(|pair| pair[1].reentry.is_some());
    let is_blocked = |pair: &[armpath::Section]| {
        let point = points.get(pair[1].first);
        let ends = [pair[0].positions.last(), pair[1].positions.first()];
        let [Some(from), Some(back)] = ends.map(|position| Some(placed(point?, position?, rail)))
        else {
            return true;
        };
        rapids.reentry(tool, [&from, &back, &home], feed).is_none()
    };
    let blocked: Vec<bool> = again.map(is_blocked).collect();
    (blocked.iter().filter(|is_blocked| **is_blocked).count(), blocked.len())
}

/// What is asked of a choice: `turn_speed` is how fast the tool may turn, degrees/s, its axis and about it each.
fn settings(turn_speed: Option<f64>, (home, keeps_posture): (Option<Joints>, bool)) -> Settings {
    let own = Settings::default();
    let rate = turn_speed.map(f64::to_radians);
    let turn_rate = rate.map_or(own.turn_rate, |rate| rate.min(own.turn_rate));
    Settings { turn_rate, slows_at: slows_at(turn_speed), home, keeps_posture, ..own }
}

/// Fastest turn of the tool, its axis and about it together, radians/s, where `turn_speed`, degrees/s, bounds each.
pub(super) fn slows_at(turn_speed: Option<f64>) -> Option<f64> {
    turn_speed.map(|speed| 2.0 * speed.to_radians())
}

/// What is chosen for the points of a stretch.
#[derive(Default)]
struct Chosen {
    /// Of each point, when the arm comes there.
    positions: Vec<Position>,
    /// By the number of the point at which the cut is left.
    reentries: BTreeMap<usize, Reentry>,
    /// The least margins from each place of the rail.
    worst: Vec<Worst>,
}

struct Walk<'a, 'm> {
    /// The place of the record at hand.
    index: usize,
    machine: &'m Machine,
    cell: &'m Cell,
    stretches: Vec<Stretch<'a>>,
    here: Option<Pose>,
    feed: Option<Feed>,
    cycle: Option<&'a Cycle>,
    spindle: Spindle,
    corner: f64,
    /// Which path the coordinates are where compensation is on.
    path: Option<CompensatedPath>,
}

/// What is wrong with a record that is not written for robots.
fn unwritten(record: &Record, help: &str) -> Diagnostic {
    let message = format!("`{}` is not written for robots", record.op.kind().name());
    Diagnostic::error(Rule::Unsupported, message).help(help)
}

/// # Errors
/// No robot has cutter compensation: which path the coordinates are has to be known. A contour has been offset before (`crate::center`).
fn check_path(path: Option<CompensatedPath>) -> Outcome {
    if path.is_some() {
        return Ok(());
    }
    let message = "nothing in the source shows whether its coordinates with compensation are the path of the tool's centre, which a robot \
                   follows, or the contour";
    let help = "`--cutcom centre` or `--cutcom contour` (in Python `cutcom`): look at the setting of the CAM system, or compare with the \
                drawing";
    Err(Diagnostic::error(Rule::CompensatedPath, message).help(help).into())
}

impl<'a> Walk<'a, '_> {
    fn stretch(&mut self) -> &mut Stretch<'a> {
        if self.stretches.is_empty() {
            self.stretches.push(Stretch::new(None, self.machine.turn_speed()));
        }
        let last = self.stretches.len() - 1;
        &mut self.stretches[last]
    }

    fn record(&mut self, record: &'a Record) -> Outcome {
        match &record.op {
            Op::Rapid(to) => {
                let feed = self.cell.rapid;
                self.go(record.line, to, Kind::Rapid, (feed, 0.0));
            }
            Op::Line(to) => {
                let from = self.start()?;
                let feed = self.feed(from.point().distance(to.point()))?;
                self.go(record.line, to, Kind::Line, (feed, self.corner));
            }
            Op::Arc(to) => {
                let from = self.start()?;
                let radius = from.point().distance(to.circle.center());
                let arc = to.circle.arc(from.point(), to.end.point(), radius * RADII);
                let arc = arc.map_err(|_| {
                    Diagnostic::error(Rule::Arc, "the ends of the arc are not on its circle")
                })?;
                self.arc(record.line, &arc, &to.end)?;
            }
            Op::Tool(tool) => {
                self.stretches.push(Stretch::new(tool.length, self.machine.turn_speed()));
                self.act(record, Act::Tool(tool));
                self.here = None;
            }
            Op::Home => {
                self.act(record, Act::Home);
                self.here = None;
            }
            Op::Feed(feed) => self.feed = Some(*feed),
            Op::Spindle(spindle) => {
                self.spindle = *spindle;
                self.act(record, Act::Spindle(*spindle));
            }
            Op::PathMode(mode) => {
                let own = self.machine.path_tolerance();
                self.corner = match mode {
                    PathMode::ExactStop | PathMode::ExactPath => 0.0,
                    PathMode::Blend(mm) => mm.min(own),
                    PathMode::AsSetUp => own,
                };
            }
            Op::Coolant(coolant) => self.act(record, Act::Coolant(*coolant)),
            Op::Output(output) => self.act(record, Act::Output(*output)),
            Op::Dwell(seconds) => self.act(record, Act::Dwell(*seconds)),
            Op::Stop => self.act(record, Act::Stop),
            Op::Operation(name) => self.act(record, Act::Operation(name)),
            Op::Comment(text) | Op::Message(text) => self.act(record, Act::Text(text)),
            Op::Compensation(Compensation::Off)
            | Op::SurfaceSpeed(None)
            | Op::Frame(_)
            | Op::Preselect(_)
            // A robot has no rotary axes that a clamp would hold: see `write`.
            | Op::Clamp(_)
            | Op::EndOfOperation
            | Op::End => {}
            Op::OptionalStop if self.machine.leaves_out("optional_stop") => {}
            Op::Cycle(cycle) => self.cycle = Some(cycle),
            Op::CycleOff => self.cycle = None,
            Op::Hole(pose) => self.hole(record.line, pose)?,
            Op::Compensation(Compensation::Left(_) | Compensation::Right(_)) => {
                check_path(self.path)?
            }
            Op::Thread(_)
            | Op::Probe(_)
            | Op::Oriented(_)
            | Op::Joints(_)
            | Op::MachineMove(_)
            | Op::SurfaceSpeed(Some(_))
            | Op::Beam(_)
            | Op::Pulses(_)
            | Op::WorkOffset(_)
            | Op::WorkOffsetData(_)
            | Op::Surface(_)
            | Op::Input(_)
            | Op::Auxiliary(_)
            | Op::ThreadWire
            | Op::CutWire
            | Op::Taper(_) => {
                return Err(unwritten(record, "a toolpath without it, or a mill in place of the robot").into());
            }
            Op::OptionalStop => {
                let help = "STOP in place of OPSTOP, or `optional_stop = \"\"` under [blocks] of the machine file, which leaves it out";
                return Err(unwritten(record, help).into());
            }
        }
        Ok(())
    }

    fn act(&mut self, record: &Record, act: Act<'a>) {
        let index = self.index;
        self.stretch().steps.push(Planned::Act(act, record.line, index));
    }

    /// Where a cut begins.
    fn start(&self) -> Outcome<Pose> {
        self.here.ok_or_else(|| {
            let message = "the cut begins where nobody knows";
            Diagnostic::error(Rule::UnknownStart, message).help("begin with a rapid").into()
        })
    }

    /// The feed of a cut of this length, mm/min.
    fn feed(&self, length: f64) -> Outcome<f64> {
        let Some(feed) = self.feed else {
            return Err(Diagnostic::error(Rule::NoFeed, "the source cuts and has no feed").into());
        };
        let speed = match self.spindle {
            Spindle::Off => 0.0,
            Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => speed,
        };
        Ok(feed_per_minute(feed, length, speed))
    }

    fn go(&mut self, line: u32, to: &Pose, kind: Kind, (feed, corner): (f64, f64)) {
        let cut = (kind != Kind::Rapid).then_some(feed);
        let record = self.index;
        let stretch = self.stretch();
        let point = stretch.point(line, to, cut);
        stretch.steps.push(Planned::Move { line, record, kind, feed, corner, point });
        self.here = Some(*to);
    }

    /// A hole by moves: over it at the height at which the tool is, down to the R plane, and as [`hole`] makes it.
    fn hole(&mut self, line: u32, at: &Pose) -> Outcome {
        let moves = self.cycle.and_then(|cycle| Some((cycle, hole(cycle, at, self.spindle)?)));
        let Some((cycle, moves)) = moves else {
            let message = "a robot has no cycle that taps or bores backwards or with an oriented spindle, and moves cannot do it";
            let help = "leave these holes out of the toolpath, and make them elsewhere";
            return Err(Diagnostic::error(Rule::NoCycle, message).help(help).into());
        };
        let rapid = (self.cell.rapid, 0.0);
        let height =
            self.here.map_or(cycle.clearance, |here| (here.point() - at.point()).dot(at.axis()));
        if height > cycle.clearance {
            self.go(line, &at.lifted(height)?, Kind::Rapid, rapid);
        }
        self.go(line, &at.lifted(cycle.clearance)?, Kind::Rapid, rapid);
        let own = self.feed;
        self.feed = cycle.feed.or(own);
        let feed = self.feed(cycle.clearance + cycle.depth)?;
        self.feed = own;
        for part in moves {
            match part {
                HoleMove::Rapid(to) => self.go(line, &to, Kind::Rapid, rapid),
                HoleMove::Line(to) => self.go(line, &to, Kind::Line, (feed, 0.0)),
                HoleMove::Dwell(seconds) => {
                    let index = self.index;
                    self.stretch().steps.push(Planned::Act(Act::Dwell(seconds), line, index))
                }
                HoleMove::Spindle(_) => {
                    let message = "a boring cycle, which stops the spindle in the hole, is not written for robots";
                    return Err(Diagnostic::error(Rule::NoCycle, message).into());
                }
            }
        }
        Ok(())
    }

    /// An arc in parts that turn by no more than the control takes; one that rises in chords.
    fn arc(&mut self, line: u32, arc: &Arc, end: &Pose) -> Outcome {
        let feed = self.feed(arc.length())?;
        let corner = self.corner;
        let pose = |part: f64| end.at(arc.at(part));
        let rises = arc.rise().abs() > self.machine.resolution();
        // Chords of an arc cut into what it goes around: by what rounding of its points does.
        let count = arc.chords(match rises {
            true => self.machine.capabilities.lowering_tolerance,
            false => FLATTEST * self.machine.resolution(),
        });
        let most = self.machine.capabilities.arc_sweep;
        let half_way = 2.0 * arc.length() / arc.sweep * (arc.sweep.min(most) / 4.0).sin();
        let is_flat = arc.sweep < LEAST_SWEEP || half_way < LEAST_CHORD;
        // An arc that its chord does not leave has no third point off the line.
        if count == 1 || is_flat || rises {
            for i in 1..=count {
                self.go(line, &pose(i as f64 / count as f64)?, Kind::Line, (feed, corner));
            }
            return Ok(());
        }
        let parts = (arc.sweep / most - 1e-9).ceil().max(1.0) as usize;
        let steps = 2 * (arc.sweep / parts as f64 / ALONG_ARC / 2.0).ceil().max(1.0) as usize;
        for i in 0..parts {
            let at = |step: usize| (i as f64 + step as f64 / steps as f64) / parts as f64;
            for step in 1..steps {
                let pose = pose(at(step))?;
                let point = self.stretch().point(line, &pose, Some(feed));
                self.stretch().points[point].inside = true;
            }
            let via = arc.at(at(steps / 2));
            self.go(line, &pose(at(steps))?, Kind::Arc(via), (feed, corner));
        }
        Ok(())
    }
}
