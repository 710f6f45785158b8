//! What the source wants, step by step.

use crate::compensation::centre::NOWHERE;
use crate::compensation::trail::{CompensatedMoves, Piece, Terms};
use crate::resolved_pose::PartialPose;
use geom::{Arc, Vec3};
use machine::Machine;
use program::lowering::feed_per_minute;
use program::{
    ArcTo, CompensatedPath, Compensation, Coolant, Cycle, CycleKind, Diagnostic, Feed, Input, Op,
    Outcome, Output, PathMode, Pose, Program, Rule, Spindle, Tool,
};
use std::rc::Rc;

/// How far the radii at the ends of a source's arc may differ, as a part of them.
const RADII: f64 = 0.01;

/// How far above the last depth of a hole a rapid may end, mm: as in `docs/proof.md`, "Hole by moves".
pub(super) const REENTRY: f64 = 2.0;

/// The most pecks of a hole.
const MOST_PECKS: usize = 10_000;

/// A step of the source.
#[derive(Clone, Debug)]
pub(super) struct Expected {
    /// Line of the source.
    pub(super) line: u32,
    /// Which record of the source it is.
    pub(super) record: usize,
    pub(super) step: Step,
    /// What is on while it moves.
    pub(super) state: State,
}

/// What happens.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Rapid(Option<Pose>, Pose),
    /// From where, and to where.
    Line(Pose, Pose),
    Arc(Box<Arc>, Pose),
    /// The tool's centre along a contour, from the way in to the way out.
    Contour(Rc<Contour>),
    /// By rapid to a place on the axis of the hole whose last depth is this pose: above it, by no more than [`REENTRY`].
    Above(Pose),
    Home,
    Tool(Box<Tool>),
    Dwell(f64),
    Stop,
    Output(Output),
    Input(Input),
}

/// A contour along which the program leads the tool's centre.
#[derive(Clone, Debug)]
pub(super) struct Contour {
    pub(super) moves: CompensatedMoves,
    pub(super) radius: f64,
    /// 1 where the tool is on the left, -1 where it is on the right.
    pub(super) left: f64,
    /// Of each piece, and of the way out.
    pub(super) elements: Vec<Element>,
    /// Where the centre is at its end.
    pub(super) end: Pose,
}

/// An element of a contour, as the source has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    /// Line of the source.
    pub(super) line: u32,
    /// Which record of it.
    pub(super) record: usize,
    /// What is on.
    pub(super) state: State,
}

/// A contour that is not at its end.
struct Open {
    line: u32,
    side: Compensation,
    radius: f64,
    left: f64,
    pieces: Vec<Piece>,
    elements: Vec<Element>,
    /// Whether compensation is off, from the next move in the plane on.
    leaves: bool,
}

/// What the source has switched on.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    /// mm/min of this step, where it cuts.
    pub(super) feed: f64,
    pub(super) spindle: Spindle,
    pub(super) coolant: Coolant,
    /// How far corners may be left, mm, where the source says it.
    pub(super) corner: Option<f64>,
    /// Length of the tool, mm, where the source states it.
    pub(super) tool_length: Option<f64>,
}

impl Expected {
    /// The steps of a program.
    ///
    /// # Errors
    /// What no program of an arm is proven against, with its line.
    pub(super) fn of(source: &Program, machine: &Machine) -> Outcome<Vec<Expected>> {
        let mut walk = Walk {
            machine,
            steps: Vec::with_capacity(source.records.len()),
            here: None,
            feed: None,
            cycle: None,
            radius: None,
            // A path of the centre is followed as it is.
            offsets: source.compensated_path == Some(CompensatedPath::Contour),
            open: None,
            at: 0,
            state: State {
                feed: 0.0,
                spindle: Spindle::Off,
                coolant: Coolant::Off,
                corner: None,
                tool_length: None,
            },
        };
        for (at, record) in source.each().enumerate() {
            walk.at = at;
            walk.record(record.line, &record.op)
                .map_err(|found| Box::new(found.line(record.line)))?;
        }
        Ok(walk.steps)
    }
}

struct Walk<'a> {
    machine: &'a Machine,
    steps: Vec<Expected>,
    here: Option<Pose>,
    feed: Option<Feed>,
    cycle: Option<Cycle>,
    /// Radius of the tool, mm, where it is known.
    radius: Option<f64>,
    /// Whether compensation offsets the coordinates.
    offsets: bool,
    open: Option<Open>,
    /// Which record of the source is at hand.
    at: usize,
    state: State,
}

impl Walk<'_> {
    fn push(&mut self, line: u32, step: Step) {
        self.steps.push(Expected { line, record: self.at, step, state: self.state });
    }

    fn record(&mut self, line: u32, op: &Op) -> Outcome {
        if self.open.is_some() && self.along(line, op)? {
            return Ok(());
        }
        match op {
            Op::Rapid(to) => self.rapid(line, *to),
            Op::Line(to) => {
                let from = self.start()?;
                self.cut(from.point().distance(to.point()))?;
                self.push(line, Step::Line(from, *to));
                self.here = Some(*to);
            }
            Op::Arc(to) => {
                let from = self.start()?;
                let arc = arc_to(&from, to)?;
                self.cut(arc.length())?;
                self.push(line, Step::Arc(Box::new(arc), to.end));
                self.here = Some(to.end);
            }
            Op::Home => {
                self.push(line, Step::Home);
                self.here = None;
            }
            Op::Tool(tool) => {
                // The way to the change is still one with the tool before.
                self.push(line, Step::Tool(tool.clone()));
                self.state.tool_length = tool.length;
                self.radius = tool.cutting_radius();
                self.here = None;
            }
            Op::Dwell(seconds) => self.push(line, Step::Dwell(*seconds)),
            Op::Stop => self.push(line, Step::Stop),
            Op::Output(output) => self.push(line, Step::Output(*output)),
            Op::Input(input) => self.push(line, Step::Input(**input)),
            Op::Feed(feed) => self.feed = Some(*feed),
            Op::Spindle(spindle) => self.state.spindle = *spindle,
            Op::Coolant(coolant) => self.state.coolant = *coolant,
            Op::PathMode(mode) => {
                self.state.corner = match mode {
                    PathMode::ExactStop | PathMode::ExactPath => Some(0.0),
                    PathMode::Blend(mm) => Some(*mm),
                    PathMode::AsSetUp => None,
                };
            }
            Op::Cycle(cycle) => self.cycle = Some(**cycle),
            Op::CycleOff => self.cycle = None,
            Op::Hole(pose) => self.hole(line, pose)?,
            Op::OptionalStop if self.machine.leaves_out("optional_stop") => {}
            Op::Compensation(side) if self.offsets => self.switch(line, *side)?,
            Op::Compensation(_)
            | Op::SurfaceSpeed(None)
            | Op::End
            | Op::Frame(_)
            | Op::Preselect(_)
            | Op::Operation(_)
            | Op::EndOfOperation
            // Of rotary axes, which no arm has.
            | Op::Clamp(_)
            | Op::Comment(_)
            | Op::Message(_) => {}
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
            | Op::Auxiliary(_)
            | Op::ThreadWire
            | Op::CutWire
            | Op::Taper(_)
            | Op::OptionalStop => {
                let message = format!(
                    "the source has `{}`, which no program of an arm is proven against",
                    op.kind().name()
                );
                return Err(Diagnostic::error(Rule::Unproven, message).into());
            }
        }
        Ok(())
    }

    /// Compensation is switched; it holds from the next move in the plane on.
    fn switch(&mut self, line: u32, side: Compensation) -> Outcome {
        let left = match (side, &mut self.open) {
            (Compensation::Off, Some(open)) => {
                open.leaves = true;
                return Ok(());
            }
            (Compensation::Off, None) => return Ok(()),
            (Compensation::Left(_), _) => 1.0,
            (Compensation::Right(_), _) => -1.0,
        };
        if let Some(open) = &self.open {
            return match open.left == left && !open.leaves {
                true => Ok(()),
                false => unproven("compensation changes while it is on"),
            };
        }
        let Some(radius) = self.radius else {
            return unproven("a contour is offset, and the radius of the tool is not known");
        };
        let (pieces, elements) = (Vec::new(), Vec::new());
        self.open = Some(Open { line, side, radius, left, pieces, elements, leaves: false });
        Ok(())
    }

    /// A record while compensation is on, or on its way out; whether that is all of it.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "what is not named has no place on a contour"
    )]
    fn along(&mut self, line: u32, op: &Op) -> Outcome<bool> {
        let Some(open) = &self.open else { return Ok(false) };
        let (begun, leaves) = (!open.pieces.is_empty(), open.leaves);
        let aside = |from: Pose, to: &Pose| {
            (to.point() - from.point()).reject_from_normalized(from.axis()).length() > NOWHERE
        };
        match op {
            Op::Line(to) => {
                let from = self.start()?;
                let aside = aside(from, to);
                if !begun && (leaves || !aside) {
                    return Ok(false);
                }
                self.cut(from.point().distance(to.point()))?;
                self.piece(line, (from, *to), None);
                self.here = Some(*to);
                if leaves && aside {
                    self.close(Some(*to))?;
                }
                Ok(true)
            }
            Op::Arc(to) if begun && !leaves => {
                let from = self.start()?;
                let arc = arc_to(&from, to)?;
                self.cut(arc.length())?;
                self.piece(line, (from, to.end), Some(arc));
                self.here = Some(to.end);
                Ok(true)
            }
            Op::Rapid(to) if begun && leaves => {
                let from = self.start()?;
                let (aside, up) = (aside(from, to), (to.point() - from.point()).dot(from.axis()));
                self.close(None)?;
                let Some(end) = self.here.filter(|_| !aside) else { return Ok(false) };
                self.rapid(line, end.lifted(up)?);
                Ok(true)
            }
            Op::Rapid(to) if !begun => match self.here.is_some_and(|from| aside(from, to)) {
                true => unproven("a rapid while compensation is on"),
                false => Ok(false),
            },
            Op::Compensation(_)
            | Op::Feed(_)
            | Op::PathMode(_)
            | Op::Spindle(_)
            | Op::Coolant(_)
            | Op::Frame(_)
            | Op::Preselect(_)
            | Op::Comment(_)
            | Op::Message(_)
            | Op::Operation(_)
            | Op::EndOfOperation => Ok(false),
            _ if !begun => Ok(false),
            _ if leaves => {
                self.close(None)?;
                Ok(false)
            }
            _ => unproven("something else than lines and arcs while compensation is on"),
        }
    }

    fn piece(&mut self, line: u32, (from, to): (Pose, Pose), arc: Option<Arc>) {
        let place = |pose: Pose| PartialPose { tip: pose.point(), axis: pose.axis() };
        let piece = Piece { line, from: place(from), to: place(to), arc };
        let element = Element { line, record: self.at, state: self.state };
        if let Some(open) = &mut self.open {
            open.pieces.push(piece);
            open.elements.push(element);
        }
    }

    /// The contour ends: on its way out, whose end is a pose of the source, or where its last element does.
    fn close(&mut self, exit: Option<Pose>) -> Outcome {
        let (Some(open), Some(here)) = (self.open.take(), self.here) else { return Ok(()) };
        let Open { line, side, radius, left, mut pieces, mut elements, .. } = open;
        let state = self.state;
        let exit = exit.and_then(|to| Some((to, pieces.pop()?)));
        let end = match &exit {
            Some((to, _)) => *to,
            None => {
                elements.push(Element { line, record: self.at, state });
                let last = pieces.iter().rev().find(|piece| {
                    let way = piece.to.tip - piece.from.tip;
                    way.reject_from_normalized(here.axis()).length() > NOWHERE
                        || piece.arc.is_some()
                });
                let Some(last) = last.filter(|_| pieces.len() > 1) else {
                    return unproven("compensation is on and off again with no contour between");
                };
                here.at(here.point() + left * radius * across(last, here.axis()))?
            }
        };
        let terms = Terms { source_line: line, side, radius: Some(radius), tool_length: None };
        let moves =
            CompensatedMoves { terms, before: 0, pieces, exit: exit.map(|(_, piece)| piece) };
        let contour = Contour { moves, radius, left, elements, end };
        self.push(line, Step::Contour(Rc::new(contour)));
        self.here = Some(end);
        Ok(())
    }

    /// A rapid from where the tool is.
    fn rapid(&mut self, line: u32, to: Pose) {
        self.push(line, Step::Rapid(self.here, to));
        self.here = Some(to);
    }

    /// A hole by moves: over it at the height at which the tool is, down to the R plane, by pecks to the bottom, out.
    fn hole(&mut self, line: u32, hole: &Pose) -> Outcome {
        let Some(cycle) = self.cycle else {
            return Err(Diagnostic::error(Rule::Cycle, "a hole without a cycle").into());
        };
        let at = |height: f64| -> Outcome<Pose> { Ok(hole.lifted(height)?) };
        let height = self
            .here
            .map_or(cycle.clearance, |here| (here.point() - hole.point()).dot(hole.axis()));
        if height > cycle.clearance {
            self.rapid(line, at(height)?);
        }
        self.rapid(line, at(cycle.clearance)?);
        let depths = depths(&cycle)?;
        for (i, depth) in depths.iter().enumerate() {
            if i > 0 {
                let last = at(-depths[i - 1])?;
                if cycle.kind == CycleKind::Deep {
                    self.rapid(line, at(cycle.clearance)?);
                }
                self.push(line, Step::Above(last));
            }
            let own = self.feed;
            self.feed = cycle.feed.or(own);
            self.cut(cycle.clearance + depth)?;
            self.feed = own;
            self.push(line, Step::Line(at(cycle.clearance)?, at(-depth)?));
            self.here = Some(at(-depth)?);
        }
        if cycle.dwell > 0.0 {
            self.push(line, Step::Dwell(cycle.dwell));
        }
        if cycle.kind == CycleKind::Ream {
            self.push(line, Step::Line(at(-cycle.depth)?, at(cycle.clearance)?));
            self.here = Some(at(cycle.clearance)?);
        }
        self.rapid(line, at(cycle.retract)?);
        Ok(())
    }

    /// Where a cut begins.
    fn start(&self) -> Outcome<Pose> {
        self.here.ok_or_else(|| {
            let message = "the source cuts from a place that it does not say";
            Diagnostic::error(Rule::UnknownStart, message).help("begin with a rapid").into()
        })
    }

    /// A cut of this length, mm.
    fn cut(&mut self, length: f64) -> Outcome {
        let speed = match self.state.spindle {
            Spindle::Off => 0.0,
            Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => speed,
        };
        let Some(feed) = self.feed else {
            return Err(Diagnostic::error(Rule::NoFeed, "the source cuts and has no feed").into());
        };
        self.state.feed = feed_per_minute(feed, length, speed);
        Ok(())
    }
}

/// To the left of the way at the end of a piece, across the tool.
fn across(piece: &Piece, axis: Vec3) -> Vec3 {
    let along = match piece.arc {
        Some(arc) => arc.normal.cross(arc.end - arc.center),
        None => piece.to.tip - piece.from.tip,
    };
    axis.cross(along).normalize_or_zero()
}

/// The arc of the source from a pose.
///
/// # Errors
/// Its ends are not on its circle.
fn arc_to(from: &Pose, to: &ArcTo) -> Outcome<Arc> {
    let radius = from.point().distance(to.circle.center());
    to.circle.arc(from.point(), to.end.point(), radius * RADII).map_err(|_| {
        Diagnostic::error(Rule::Arc, "the ends of the arc are not on its circle").into()
    })
}

fn unproven<T>(what: &str) -> Outcome<T> {
    Err(Diagnostic::error(Rule::Unproven, format!("in the source {what}")).into())
}

/// The depths to which a cycle feeds, mm below the point of the hole.
fn depths(cycle: &Cycle) -> Outcome<Vec<f64>> {
    let refused = |what: &str| Err(Diagnostic::error(Rule::Cycle, what).into());
    match cycle.kind {
        CycleKind::Drill | CycleKind::Ream => return Ok(vec![cycle.depth]),
        CycleKind::Deep | CycleKind::BreakChip => {}
        CycleKind::Tap { .. }
        | CycleKind::Bore
        | CycleKind::FineBore(_)
        | CycleKind::BackBore { .. } => {
            return refused("no program of an arm is proven against a thread or a boring cycle");
        }
    }
    let Some(further) = cycle.peck.or(cycle.first_peck).filter(|peck| *peck > 0.0) else {
        return refused("the cycle pecks, and does not say how deep");
    };
    let mut depths = vec![cycle.first_peck.unwrap_or(further)];
    while depths[depths.len() - 1] < cycle.depth - 1e-3 {
        if depths.len() > MOST_PECKS {
            return refused("more pecks than a hole has");
        }
        depths.push(depths[depths.len() - 1] + further);
    }
    let last = depths.len() - 1;
    depths[last] = cycle.depth;
    Ok(depths)
}
