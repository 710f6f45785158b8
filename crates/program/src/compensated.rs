//! Which path the coordinates of a program are where cutter compensation is on.

use crate::{Compensation, Diagnostic, Op, Pose, Program, Rule, Tool};
use geom::{Arc, Vec3};
use std::f64::consts::PI;

/// Which path the coordinates are where cutter compensation is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompensatedPath {
    /// That of the tool's centre, already offset by the tool: the control may add no more than wear.
    Center,
    /// The contour that is cut: the control adds the radius of the tool.
    Contour,
}

impl CompensatedPath {
    /// Its name, as users give it.
    pub fn name(self) -> &'static str {
        match self {
            CompensatedPath::Center => "centre",
            CompensatedPath::Contour => "contour",
        }
    }

    /// What it is, in a sentence.
    pub fn described(self) -> &'static str {
        match self {
            CompensatedPath::Center => "the path of the tool's centre",
            CompensatedPath::Contour => "the contour",
        }
    }
}

/// The arc of a program that shows which path its coordinates are.
///
/// Two things show it, each since the other reading makes no part:
///
/// - An arc that turns towards the tool's side, of a smaller radius than the tool: as a contour no tool could cut it, so the
///   coordinates are the path of the centre.
/// - An arc that turns away from the tool's side by half a turn or more, in one plane, of a smaller radius than the tool: as
///   the path of the centre nothing of what it goes around would be left, so the coordinates are the contour.
///
/// Nothing else does: a rounded outer corner smaller than the tool, a short way in, two tools on one path may be either. Where
/// the radius of the tool is not known, or depends on the depth ([`Tool::tapered`]), nothing is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathEvidence {
    /// Which path it is.
    pub path: CompensatedPath,
    /// Line of the source of the first arc that shows it.
    pub line: u32,
    /// Radius of that arc, mm.
    pub radius: f64,
    /// Radius of the tool, mm.
    pub tool_radius: f64,
    /// In how many stretches compensation is on.
    pub stretches: usize,
    /// In how many of them an arc shows which path it is.
    pub showing: usize,
}

/// By how much an arc must be smaller than the tool, mm: the ends of an arc of cutter-location data may be off by as much.
const CLEARLY: f64 = 0.005;

/// Two arcs whose centres are no farther apart, mm, are parts of one.
const SAME_CENTER: f64 = 0.005;

/// How much an arc may rise and still lie in one plane, mm.
const FLAT: f64 = 1e-3;

/// By how much half a turn may be missed, radians.
const ANGLE: f64 = 1e-4;

impl PathEvidence {
    /// What `program` shows; nothing where no arc does, or compensation is never on.
    ///
    /// # Errors
    /// `compensated-path` where one arc shows the one and another the other.
    pub fn of(program: &Program) -> Result<Option<PathEvidence>, Box<Diagnostic>> {
        let mut search = Search::default();
        for record in program.each() {
            search.take(record.line, &record.op);
        }
        match search.first {
            [Some(center), Some(contour)] => Err(contradiction(&center, &contour).into()),
            [found, None] | [None, found] => {
                let Search { stretches, showing, .. } = search;
                Ok(found.map(|found| PathEvidence { stretches, showing, ..found }))
            }
        }
    }
}

impl Program {
    /// Line of the first record that switches cutter compensation on.
    pub fn compensates(&self) -> Option<u32> {
        let on = |op: &Op| {
            matches!(op, Op::Compensation(Compensation::Left(_) | Compensation::Right(_)))
        };
        self.records.iter().find(|record| on(&record.op)).map(|record| record.line)
    }
}

/// A walk along a program.
#[derive(Default)]
struct Search {
    here: Option<Pose>,
    /// Radius of the tool, mm, where it is one and known.
    radius: Option<f64>,
    /// Which way an arc turns that turns towards the tool: 1 counter-clockwise; 0 without compensation.
    side: f64,
    stretches: usize,
    showing: usize,
    /// Whether the stretch at hand shows something.
    shows: bool,
    /// The centre of the last arcs, how far they turn together (radians, positive counter-clockwise).
    round: Option<(Vec3, f64)>,
    /// The first arc that shows a path of the centre, and a contour.
    first: [Option<PathEvidence>; 2],
}

impl Search {
    fn take(&mut self, line: u32, op: &Op) {
        match op {
            Op::Tool(tool) => self.radius = tool.cutting_radius(),
            Op::Compensation(compensation) => {
                let side = match compensation {
                    Compensation::Off => 0.0,
                    Compensation::Left(_) => 1.0,
                    Compensation::Right(_) => -1.0,
                };
                if side != 0.0 && side != self.side {
                    self.stretches += 1;
                    self.shows = false;
                }
                self.side = side;
                self.round = None;
            }
            Op::Arc(to) => {
                let arc = self
                    .here
                    .and_then(|here| to.circle.arc(here.point(), to.end.point(), CLEARLY).ok());
                match arc {
                    Some(arc) => self.arc(line, &arc, to.circle.normal().dot(to.end.axis())),
                    None => self.round = None,
                }
            }
            // Where the tool then stands is not known, or it has gone straight.
            Op::Rapid(_)
            | Op::Line(_)
            | Op::Thread(_)
            | Op::Hole(_)
            | Op::Oriented(_)
            | Op::Probe(_)
            | Op::Joints(_)
            | Op::MachineMove(_)
            | Op::Home
            | Op::WorkOffset(_) => self.round = None,
            Op::Cycle(_)
            | Op::CycleOff
            | Op::Feed(_)
            | Op::PathMode(_)
            | Op::Spindle(_)
            | Op::SurfaceSpeed(_)
            | Op::Coolant(_)
            | Op::Beam(_)
            | Op::Pulses(_)
            | Op::Preselect(_)
            | Op::Frame(_)
            | Op::WorkOffsetData(_)
            | Op::Surface(_)
            | Op::Clamp(_)
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
            | Op::End => return,
        }
        if !matches!(op, Op::Tool(_) | Op::Compensation(_)) {
            self.here = op.pose().copied();
        }
    }

    /// An arc; `facing` is the part of its normal along the tool.
    fn arc(&mut self, line: u32, arc: &Arc, facing: f64) {
        let across = 1.0 - facing.abs() < geom::ANGLE_EPSILON;
        let Some(tool_radius) = self.radius.filter(|_| self.side != 0.0 && across) else { return };
        let radius = arc.radius();
        if radius + CLEARLY > tool_radius {
            self.round = None;
            return;
        }
        let found =
            |path| PathEvidence { path, line, radius, tool_radius, stretches: 0, showing: 0 };
        if facing * self.side > 0.0 {
            self.round = None;
            self.note(0, found(CompensatedPath::Center));
        } else if self.turned(arc, facing.signum()) >= PI - ANGLE {
            self.note(1, found(CompensatedPath::Contour));
        }
    }

    /// How far the tool has turned about the centre of `arc` at its end, radians.
    fn turned(&mut self, arc: &Arc, direction: f64) -> f64 {
        if arc.rise().abs() > FLAT {
            self.round = None;
            return 0.0;
        }
        let sweep = direction * arc.sweep;
        let before = match self.round {
            Some((center, before)) if center.distance(arc.center) < SAME_CENTER => before,
            _ => 0.0,
        };
        let together = if before * sweep < 0.0 { sweep } else { before + sweep };
        self.round = Some((arc.center, together));
        together.abs()
    }

    fn note(&mut self, which: usize, found: PathEvidence) {
        self.first[which].get_or_insert(found);
        if !std::mem::replace(&mut self.shows, true) {
            self.showing += 1;
        }
    }
}

impl Tool {
    /// The radius with which it cuts aside, mm, where that is known and the same at every depth.
    pub fn cutting_radius(&self) -> Option<f64> {
        self.diameter.filter(|_| !self.tapered).map(|diameter| diameter / 2.0)
    }
}

/// The source is two things at once.
fn contradiction(center: &PathEvidence, contour: &PathEvidence) -> Diagnostic {
    let message = format!(
        "under CUTCOM the arc in line {} (radius {:.3} mm) can only be the path of the centre of a tool of radius {:.3} mm, \
         and that in line {} (radius {:.3} mm) only a contour",
        center.line, center.radius, center.tool_radius, contour.line, contour.radius
    );
    Diagnostic::error(Rule::CompensatedPath, message)
        .help("write the operations of the CAM system with one setting, or post them apart")
        .line(center.line.max(contour.line))
}
