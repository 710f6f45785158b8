//! What the control remembers from block to block.

pub(in crate::sinumerik) mod modal;
mod offsets;
mod smoothed;

use super::frames::Frames;
use crate::event::{FeedPath, Orientation, Position};
use crate::kernel::compensation::Outer;
use crate::sinumerik::language::commands::{Diameter, FeedType, GROUPS, Motion};
use crate::sinumerik::language::value::Value;
use crate::sinumerik::language::variables::{
    AssignmentTarget, Locals, Parameter, Parameters, Readable,
};
use crate::sinumerik::models::Facts;
use crate::{Settings, StartModes};
use geom::{Frame, Vec3};
use modal::Modal;
use offsets::{WORK_OFFSET_AT_RESET, WorkOffsets};
use program::{Compensation, Coolant, Feed, Spindle, Tool};
use smoothed::Smoothed;

/// Coordinates that differ by less are one, mm: rotations round.
const SAME_PLACE: Vec3 = Vec3::splat(1e-9);

/// The place of a settable offset as the neutral program counts them: 53 for none (`G500`), 54 to 57,
/// then `G505` (on an 828D `G58`, `G59`) and so on.
pub fn place(number: u32) -> u32 {
    match number {
        500 => 53,
        505..=599 => number - 447,
        _ => number,
    }
}

/// Where the tool axis comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ToolAxis {
    /// The positions of the rotary axes.
    Rotary,
    /// A vector or the swivelled plane; in the work frame.
    Vector(Vec3),
}

/// What a program has said of how the tool turns within a block under `TRAORI`; `None` is as the builder has set the control up
/// (MD20150).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Turning {
    /// G group 25: in the frame of the work, and so on the great circle, or in that of the machine, and so by its axes.
    pub in_work_frame: Option<bool>,
    /// G group 51: on the great circle, or by the axes.
    pub great_circle: Option<bool>,
}

impl Turning {
    /// Whether the tool turns on the great circle: known where both groups say the same, for MD21104 says which of them counts
    /// (Job Planning, "Orientation axis reference"; Transformations, "Large circle interpolation").
    pub fn on_great_circle(self) -> Option<bool> {
        self.in_work_frame.filter(|_| self.in_work_frame == self.great_circle)
    }
}

/// The command of each G group that the program has said last, as a block keeps it.
pub(crate) type Said = [u8; GROUPS];

/// The state between two blocks. The words are in units of the machine: mm, degrees, 1/min.
pub(crate) struct State {
    /// G group 1.
    pub motion: Motion,
    /// G group 6: the axis perpendicular to the plane.
    pub plane_normal: usize,
    /// G group 13: mm in a unit of length, and in a unit of length of a feed.
    pub unit: f64,
    /// mm in the unit of length of a feed.
    pub feed_unit: f64,
    /// G group 14.
    pub absolute: bool,
    /// G group 15.
    pub feed_type: FeedType,
    /// G group 29.
    pub diameter: Diameter,
    /// G group 25.
    pub vectors_in_work_frame: bool,
    /// What the program has said of how the tool turns within a block.
    pub turning: Turning,
    /// What the program has said of each G group.
    pub said: Said,
    /// Which modes of a start are sure: by the machine's file, or since a motion has leaned on what the program has said. The others
    /// are as MD20150 has them.
    pub sure: StartModes,
    /// G groups 10 and 30.
    pub smoothed: Smoothed,
    /// G group 55: whether the axes of a rapid go together, where the program says it.
    pub rapids_together: Option<bool>,
    /// The same as it was reported last, with the transformation.
    pub reported_rapids: Option<bool>,
    /// G group 8: 500 for none.
    pub work_offset: u32,
    /// G group 7 as the blocks say.
    pub compensation: Compensation,
    /// G group 7 as the axes move.
    pub compensation_in_effect: Compensation,
    /// How outer corners are gone around.
    pub corner: Outer,
    /// `DISC=` above 0: with `G450` they are not gone around on an arc.
    pub peak: bool,
    /// `KONT`: from behind the contour the tool goes around its first point.
    pub goes_around: bool,
    /// `F` in the active type, mm/min or mm.
    pub feed: Option<f64>,
    /// Which of A, B and C stand in the feed group (`FGROUP`).
    pub feed_group: [bool; 3],
    /// `FGREF`: mm that a degree of A, B and C counts in it.
    pub mm_per_degree: [f64; 3],
    /// The feed that was reported last.
    pub reported_feed: Option<Feed>,
    /// `S`, 1/min; none before the program has given it: the control keeps that of the program before.
    pub speed: Option<f64>,
    /// `M3`, `M4`, `M5`, as reported.
    pub spindle: Spindle,
    /// `M7`, `M8`, `M9`, as reported.
    pub coolant: Coolant,
    /// The tool that the next `M6` changes to.
    pub selected: Option<Box<Tool>>,
    /// The tool in the spindle, where the program has changed to one.
    pub tool: Option<Box<Tool>>,
    /// `D`; none for `D0`, and before the first tool.
    pub edge: Option<u32>,
    /// Whether the program has said that edge since the last change of the tool, or the machine's file does. Otherwise `edge` is that
    /// of a control as it is delivered: none at the start (MD20130), the first behind `M6` (MD20270).
    pub edge_is_known: bool,
    /// Whether positions are those of the tool tip (`TRAORI`).
    pub tool_center: bool,
    /// The frames.
    pub frames: Frames,
    /// Where the tool is in the coordinates of the program, mm.
    pub position: Vec3,
    /// The coordinates that were programmed last, mm: what incremental ones count from.
    pub programmed: Vec3,
    /// The way of the last move in the plane, where it ended; of any length.
    pub heading: Vec3,
    /// The pole of polar coordinates, mm.
    pub pole: Vec3,
    /// The last polar radius, mm, and the last polar angle, degrees.
    pub polar: (Option<f64>, Option<f64>),
    /// `RNDM`: the radius between all blocks, mm; 0 for none.
    pub modal_round: f64,
    /// `FRCM`: the feed of corners, in units of the program.
    pub corner_feed: Option<f64>,
    /// The last pitch of a thread, mm, with its sign.
    pub pitch: Option<f64>,
    /// The limits of the spindle's speed (`G25`, `G26`), 1/min.
    pub speed_limits: [f64; 2],
    /// Positions of A, B, C, degrees.
    pub rotary: [f64; 3],
    /// Where the tool axis comes from.
    pub tool_axis: ToolAxis,
    /// `MCALL`.
    pub modal: Modal,
    /// R parameters.
    pub parameters: Parameters,
    /// The variables of the program that runs.
    pub locals: Locals,
    /// What is known of the settable work offsets.
    pub work_offsets: WorkOffsets,
    /// The value of the active one, as it was when it was activated, mm.
    pub active_offset: Vec3,
    /// Whether the program has moved in the active one.
    pub moved: bool,
    /// Whether machine coordinates are known: where the tool starts, and so all offsets.
    pub machine_known: bool,
    /// The operator's parameter that the positions of A, B, C are written with, and the line that
    /// wrote one first.
    pub offsets: [Option<(Option<usize>, u32)>; 3],
    /// The model of the control.
    pub facts: &'static Facts,
    /// Whether the program has ended.
    pub ended: bool,
}

/// Modal commands and frame, as a program with `SAVE` finds them (Function Manual K2, 2.4.10).
pub(crate) struct Modes {
    pub said: Said,
    pub sure: StartModes,
    pub motion: Motion,
    pub plane_normal: usize,
    pub units: (f64, f64),
    pub absolute: bool,
    pub feed_type: FeedType,
    pub vectors_in_work_frame: bool,
    pub turning: Turning,
    pub smoothed: Smoothed,
    pub rapids_together: Option<bool>,
    pub work_offset: u32,
    pub compensation: Compensation,
    pub programmable: (Frame, Vec3),
    pub diameter: Diameter,
    pub corner: Outer,
    pub goes_around: bool,
}

impl Readable for State {
    fn locals(&self) -> &Locals {
        &self.locals
    }

    fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    fn facts(&self) -> &'static Facts {
        self.facts
    }

    fn counts_plainly(&self) -> bool {
        self.unit == 1.0 && self.diameter == Diameter::Off
    }

    fn position_of(&self, axis: usize) -> f64 {
        match axis {
            0..=2 => self.position[axis],
            _ => self.rotary.get(axis - 3).copied().unwrap_or(f64::NAN),
        }
    }

    fn machine_position_of(&self, axis: usize) -> f64 {
        if axis > 2 {
            return self.position_of(axis);
        }
        let plain = self.machine_known
            && self.edge.is_none()
            && !self.tool_center
            && self.frames.swivel().is_none();
        if !plain {
            return f64::NAN;
        }
        let first = self.work_offsets.first(self.work_offset).unwrap_or(self.active_offset);
        self.frames.in_work_frame(self.position)[axis] + first[axis]
    }

    fn active_feed(&self) -> Option<Feed> {
        State::active_feed(self)
    }

    fn translation(&self, axis: usize) -> f64 {
        self.frames.programmable().translation[axis]
    }

    fn work_offset(&self, number: u32, axis: usize) -> f64 {
        self.work_offsets.get(number)[axis]
    }

    fn edge(&self) -> Option<u32> {
        self.edge
    }

    fn edge_is_known(&self) -> bool {
        self.edge_is_known
    }

    fn tool_number(&self) -> Option<u32> {
        self.tool.as_ref().filter(|tool| tool.name.is_empty()).map(|tool| tool.number)
    }
}

impl State {
    /// The reset state that the maker delivers (Programming Manual 06/2019, 4.3; `G1 G17 G40 G500 G71
    /// G90 G94 ORIWKS`); where the axes stand is not known.
    pub fn new(facts: &'static Facts, settings: &Settings) -> State {
        State {
            motion: Motion::Line,
            plane_normal: 2,
            unit: 1.0,
            feed_unit: 1.0,
            absolute: true,
            feed_type: FeedType::PerMinute,
            diameter: Diameter::Off,
            vectors_in_work_frame: true,
            turning: Turning::default(),
            said: [0; GROUPS],
            sure: settings.start_modes.or(StartModes {
                centers_from_start: true,
                returns_up: true,
                first_offset: true,
                ..StartModes::NONE
            }),
            smoothed: Smoothed::default(),
            rapids_together: None,
            reported_rapids: None,
            work_offset: WORK_OFFSET_AT_RESET,
            compensation: Compensation::Off,
            compensation_in_effect: Compensation::Off,
            corner: Outer::Arc,
            peak: false,
            goes_around: false,
            feed: None,
            feed_group: [false; 3],
            mm_per_degree: [1.0; 3],
            reported_feed: None,
            speed: None,
            spindle: Spindle::Off,
            coolant: Coolant::Off,
            selected: None,
            tool: None,
            edge: None,
            edge_is_known: settings.setup.start.is_some(),
            tool_center: false,
            frames: Frames::new(),
            position: settings.setup.position_at_start(),
            programmed: settings.setup.position_at_start(),
            heading: Vec3::NAN,
            pole: Vec3::ZERO,
            polar: (None, None),
            modal_round: 0.0,
            corner_feed: None,
            pitch: None,
            speed_limits: [0.0, f64::INFINITY],
            rotary: settings.rotary.map(|exists| if exists { f64::NAN } else { 0.0 }),
            tool_axis: ToolAxis::Rotary,
            modal: Modal::None,
            parameters: Parameters::new(&settings.operator_parameters),
            locals: Locals::default(),
            work_offsets: WorkOffsets::new(settings.setup.start.is_some()),
            active_offset: Vec3::ZERO,
            moved: false,
            machine_known: settings.setup.start.is_some(),
            offsets: [None; 3],
            facts,
            ended: false,
        }
    }

    /// The pose at `point` of the program.
    #[inline(always)]
    pub fn pose(&self, point: Vec3) -> Position {
        let orientation = match self.tool_axis {
            ToolAxis::Rotary => {
                Orientation::Rotary { degrees: self.rotary, tool_center: self.tool_center }
            }
            ToolAxis::Vector(axis) => Orientation::Axis(axis),
        };
        Position { point: self.frames.in_work_frame(point), orientation }
    }

    /// Sets an R parameter, a variable or a work offset.
    pub fn assign(&mut self, place: AssignmentTarget, value: Value) {
        match (place, value.number()) {
            (AssignmentTarget::Element(index, element), _) => {
                self.locals.set(index, element, value)
            }
            (AssignmentTarget::Parameter(index), Some(number)) => {
                self.parameters.set(index, number)
            }
            (AssignmentTarget::WorkOffset(number, axis), Some(length)) => {
                self.work_offsets.set(number, axis, length);
            }
            (AssignmentTarget::Parameter(_) | AssignmentTarget::WorkOffset(..), None) => {}
        }
    }

    /// The number at a place.
    pub fn value_of(&self, place: AssignmentTarget) -> Option<f64> {
        match place {
            AssignmentTarget::Parameter(index) => match self.parameters.get(index) {
                Parameter::Set(value) => Some(value),
                Parameter::Operator | Parameter::Unknown => None,
            },
            AssignmentTarget::Element(index, element) => {
                self.locals.get(index)?.values.get(element)?.as_ref()?.number()
            }
            AssignmentTarget::WorkOffset(number, axis) => {
                Some(self.work_offsets.get(number)[axis]).filter(|value| !value.is_nan())
            }
        }
    }

    /// What a program with `SAVE` gives back.
    pub fn modes(&self) -> Modes {
        Modes {
            said: self.said,
            sure: self.sure,
            motion: self.motion,
            plane_normal: self.plane_normal,
            units: (self.unit, self.feed_unit),
            absolute: self.absolute,
            feed_type: self.feed_type,
            vectors_in_work_frame: self.vectors_in_work_frame,
            turning: self.turning,
            smoothed: self.smoothed,
            rapids_together: self.rapids_together,
            work_offset: self.work_offset,
            compensation: self.compensation,
            programmable: (self.frames.programmable(), self.frames.fine()),
            diameter: self.diameter,
            corner: self.corner,
            goes_around: self.goes_around,
        }
    }

    /// The way that the feed counts along.
    pub fn feed_path(&self) -> FeedPath {
        let weight = |i: usize| if self.feed_group[i] { self.mm_per_degree[i] } else { 0.0 };
        FeedPath::Group([0, 1, 2].map(weight))
    }

    /// The active feed, where `F` has been given.
    pub fn active_feed(&self) -> Option<Feed> {
        self.feed.map(|value| match self.feed_type {
            FeedType::PerMinute => Feed::PerMinute(value),
            FeedType::PerTurn => Feed::PerTurn(value),
            FeedType::InverseTime => Feed::InverseTime(value),
        })
    }

    /// A straight way to `point` gives the direction of what follows, where it goes along the plane.
    #[inline(always)]
    pub fn head_for(&mut self, point: Vec3) {
        let mut way = point - self.position;
        way[self.plane_normal] = 0.0;
        if way != Vec3::ZERO {
            self.heading = way;
        }
    }

    /// The first move in the active work offset: poses count in the offset as it is now, whatever it
    /// becomes.
    #[cold]
    pub fn move_first(&mut self) {
        self.moved = true;
        self.work_offsets.use_first(self.work_offset, self.active_offset);
    }

    /// `G17`, `G18`, `G19`. A pole belongs to the plane that it was given in.
    pub fn select_plane(&mut self, normal: usize) {
        if normal == self.plane_normal {
            return;
        }
        self.plane_normal = normal;
        self.heading = Vec3::NAN;
        self.polar = (None, None);
        if self.pole != Vec3::ZERO {
            self.pole = Vec3::NAN;
        }
    }

    /// Nobody knows any more where the linear axes are.
    pub fn lose_position(&mut self) {
        self.position = Vec3::NAN;
        self.programmed = Vec3::NAN;
        self.heading = Vec3::NAN;
    }

    /// Nobody knows any more where the existing rotary axes are.
    pub fn lose_rotary(&mut self, existing: [bool; 3]) {
        self.rotary = existing.map(|exists| if exists { f64::NAN } else { 0.0 });
        self.tool_axis = ToolAxis::Rotary;
    }

    /// Changes the frames; the axes stay where they are. A translation alone leaves the programmed
    /// values, so that the next incremental word travels the offset as well (SD42440 = 1, the
    /// delivery state). After a rotation, a scale or a mirror it is not documented whether increments count from the
    /// value that was programmed or from where the axis stands in the new frame: they count where both are one.
    pub fn change_frames(&mut self, change: impl FnOnce(&mut Frames)) {
        let base = self.frames.in_work_frame(self.position);
        let moved_only = self.frames.moved_only();
        change(&mut self.frames);
        self.position = self.frames.in_program(base);
        self.heading = Vec3::NAN;
        if !(moved_only && self.frames.moved_only()) {
            let (programmed, stands) = (self.programmed, self.position);
            let agree = programmed.cmpeq(stands) | (programmed - stands).abs().cmplt(SAME_PLACE);
            self.programmed = Vec3::select(agree, programmed, Vec3::NAN);
        }
    }
}
