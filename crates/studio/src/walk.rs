//! The walk: all moves of a program in the control's order, as columns. Whatever the page asks is looked up here.
//!
//! A move takes 47 bytes on three axes (those of a machine that has more take 8 bytes each, 24 more where any tool leans, 4 where its lines
//! do not go up with the moves, 4 while the records of its source have no lines), and what changes seldom is kept where it changes: feeds, states, arcs, waits, and where a move does not begin where the one
//! before it ended.

use crate::ask::{Excursion, Jump, Operation, ToolUse};
use crate::drawing::Drawing;
use crate::geometry::{self, CHUNK, Exact, Geometry};
use crate::index::Index;
use crate::job::Waits;
use geom::ending::Ended;
use geom::{Arc, Vec3};
use machine::Machine;
use machine::axis_motion::{AxisMotion, Chain};
use program::{Compensation, Diagnostic, Feed, Op, Program, Tool};
use proof::{AxisPositions, Course, MachineState, Motion, MotionKind, Observer, Report, ToolPose};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::{Deref, Range};
use std::sync::{self, Mutex, PoisonError};

/// How a move goes, by its number in vertices and rows.
pub const KINDS: [&str; 6] = ["gap", "rapid", "feed", "arc", "joints", "pulse"];

/// No line is drawn to this vertex.
pub const GAP: u8 = 0;
/// As fast as the axes can.
pub const RAPID: u8 = 1;
/// Straight, at the feed.
pub const FEED: u8 = 2;
/// An arc or a helix.
pub const ARC: u8 = 3;
/// All joints of an arm together.
pub const JOINTS: u8 = 4;
/// To a place at which a laser fires: that alone is drawn.
pub const PULSE: u8 = 5;

/// Above the number of its kind: how the axes go between the ends of a move.
const COURSE: u32 = 4;
const COURSES: [Course; 4] = [Course::Tool, Course::Tip, Course::Axes, Course::EachAxis];

/// No tool is known, or one that is not among the first 255.
pub const NO_TOOL: u8 = 255;

/// Marks of a move: compensation is switched with it.
pub const SWITCHED: u8 = 1;
/// It belongs to an excursion.
pub const EXCURSION: u8 = 2;
/// It is the last one before the first mismatch.
pub const MISMATCH: u8 = 4;

/// How much memory a walk takes, bytes: what goes beyond is left out.
const MOST_BYTES: usize = 3 << 29;

/// How many operations are listed.
const MOST_NAMED: usize = 10_000;

/// By how much a rotary axis turns in a cut that is listed as a jump, degrees.
const JUMP: f64 = 30.0;
/// How many jumps, and how many excursions, are listed.
const LISTED: usize = 1000;

/// After so many moves it is looked at.
const LOOK: usize = 4096;

/// Six joints and a rail are the most.
const MOST_AXES: usize = 7;

/// How far X, Y and Z may be from where they are taken to be, mm.
const SAME: f64 = 1e-9;

/// Where the axes are.
#[derive(Clone, Copy, Debug)]
pub struct Positions {
    values: [f64; MOST_AXES],
    count: usize,
}

impl Deref for Positions {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// The moves of a program.
#[derive(Debug, Default)]
pub struct Walk {
    /// Kinds and courses.
    kinds: Vec<u8>,
    tools: Vec<u8>,
    marks: Vec<u8>,
    lines: Vec<u32>,
    source_lines: Vec<u32>,
    /// The records of the moves, where these have no lines of their own, until somebody says which they have.
    records: Vec<u32>,
    /// The moves by their blocks, and by the lines of the source.
    by_block: Index,
    by_source: Index,
    /// Time behind the move, s.
    ends: Vec<f64>,
    tips: Vec<Vec3>,
    /// The tool axis behind the move; empty where no tool leans.
    axes: Vec<Vec3>,
    /// Positions of the axes behind the move, so many for each; none of a mill without rotary axes, where they go with the tip.
    positions: Vec<f64>,
    stride: usize,
    /// How far X, Y and Z of such a mill are from the tip, from which move on.
    offsets: Vec<(u32, Vec3)>,
    /// Whether in some rapid each axis goes at its own speed.
    goes_apart: bool,
    /// The axes as a chain; none of a wire, and where there are no moves.
    chain: Option<Chain>,
    /// How far the tip is off the source, mm; NaN where nothing was compared.
    deviations: Vec<f32>,
    /// The largest of them.
    deviation: Option<f64>,
    /// The first cuts in which a rotary axis turns far, and how many there are.
    jumps: Vec<Jump>,
    jumps_in_all: u32,
    excursions: Vec<Excursion>,
    excursions_in_all: u32,
    /// Where the tool is before a move that does not begin where the one before it ended.
    starts: Vec<(u32, ToolPose)>,
    arcs: Vec<(u32, Arc)>,
    waits: Vec<(u32, f64)>,
    feeds: Vec<(u32, Option<Feed>)>,
    states: Vec<(u32, MachineState)>,
    /// Which called file a move stands in, as a place in `names`; from where on.
    files: Vec<(u32, Option<u32>)>,
    names: Vec<Box<str>>,
    tool_uses: Vec<ToolUse>,
    operations: Vec<Operation>,
    mismatch: Option<u32>,
    /// How many moves there were beyond [`MOST_BYTES`].
    left_out: usize,
    is_full: bool,
}

/// The entry of a list, ordered by moves, that holds for a move.
fn holds<T>(list: &[(u32, T)], at: u32) -> Option<&T> {
    let behind = list.partition_point(|(from, _)| *from <= at);
    behind.checked_sub(1).map(|place| &list[place].1)
}

/// The entry of a list, ordered by moves, that is of a move alone.
fn of<T>(list: &[(u32, T)], at: u32) -> Option<&T> {
    list.binary_search_by_key(&at, |(of, _)| *of).ok().map(|place| &list[place].1)
}

/// The entries of a list, ordered by moves, that are of some moves.
fn among<T>(list: &[(u32, T)], moves: Range<u32>) -> &[(u32, T)] {
    let place = |at: u32| list.partition_point(|(of, _)| *of < at);
    &list[place(moves.start)..place(moves.end)]
}

/// Which lines moves are looked up by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By<'a> {
    /// Those of the program, or of the file of this name that it calls.
    Block(Option<&'a str>),
    /// Those of the source.
    Source,
}

/// A pulse of a laser.
#[derive(Clone, Debug)]
pub struct Pulse {
    /// The line of its block.
    pub line: u32,
    /// Where it is, mm.
    pub at: Vec3,
    /// Where the axes are.
    pub positions: Vec<f64>,
    /// When it fires, s.
    pub end: f64,
    /// The line of the source that it comes from; 0 for none.
    pub source_line: u32,
    /// What begins with it.
    pub operation: Option<String>,
}

impl Walk {
    /// That of a laser, whose pulses come in their order, for as long as `goes_on` says so.
    pub fn of_pulses(
        pulses: impl Iterator<Item = Pulse>,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Walk> {
        let mut walk = Walk::default();
        for Pulse { line, at, positions, end, source_line, operation } in pulses {
            if walk.kinds.len().is_multiple_of(LOOK) {
                walk.is_full |= walk.bytes() > MOST_BYTES;
                goes_on().then_some(())?;
            }
            if walk.is_full {
                walk.left_out += 1;
                continue;
            }
            if walk.is_empty() {
                let nowhere = ToolPose { tip: Vec3::NAN, axis: Vec3::NAN };
                walk.starts.push((0, nowhere));
            }
            if let Some(name) = operation.filter(|_| walk.operations.len() < MOST_NAMED) {
                let (r#move, time_s) = (walk.len(), walk.seconds());
                walk.operations.push(Operation { name, r#move, time_s });
            }
            walk.kinds.push(PULSE);
            walk.tools.push(NO_TOOL);
            walk.marks.push(0);
            walk.lines.push(line);
            walk.source_lines.push(source_line);
            walk.ends.push(end);
            walk.tips.push(at);
            walk.stride = positions.len();
            walk.positions.extend(positions);
            walk.deviations.push(f32::NAN);
        }
        walk.by_block = Index::of(&walk.lines, goes_on)?;
        walk.by_source = Index::of(&walk.source_lines, goes_on)?;
        Some(walk)
    }

    /// Marks the first move of each of these blocks as one of a mismatch.
    pub fn mark_blocks(&mut self, lines: impl Iterator<Item = u32>) {
        for line in lines {
            if let Some([first, _]) = self.moves_of(By::Block(None), line, 1).first() {
                self.marks[*first as usize] |= MISMATCH;
                self.mismatch = Some(self.mismatch.map_or(*first, |known| known.min(*first)));
            }
        }
    }

    /// How many moves there are.
    pub fn len(&self) -> u32 {
        self.kinds.len() as u32
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// How many moves were left out, because there are too many.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// How long all of it takes, s.
    pub fn seconds(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// The tools in the order of their first use.
    pub fn tool_uses(&self) -> &[ToolUse] {
        &self.tool_uses
    }

    /// Says what tools of these numbers are called, where the control does not know it, and how wide they cut, mm.
    pub fn set_widths(&mut self, widths: &[(u32, String, f64)]) {
        for (number, name, width) in widths {
            for tool in self.tool_uses.iter_mut().filter(|tool| tool.number == *number) {
                if tool.name.is_empty() {
                    tool.name.clone_from(name);
                }
                tool.width = Some(tool.width.map_or(*width, |known| known.max(*width)));
            }
        }
    }

    /// Says of which lines the records of a source are that have none of their own.
    pub fn set_source_lines(&mut self, lines: &[u32]) {
        let records = std::mem::take(&mut self.records);
        if records.is_empty() {
            return;
        }
        let line = |record: &u32| lines.get(*record as usize).copied().unwrap_or(0);
        self.source_lines = records.iter().map(line).collect();
        self.by_source = Index::of(&self.source_lines, &|| true).unwrap_or_default();
    }

    /// The operations of the source.
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// The last move before the first mismatch; the first one where there is none before it.
    pub fn mismatch(&self) -> Option<u32> {
        self.mismatch
    }

    /// Whether any tool leans.
    pub fn leans(&self) -> bool {
        !self.axes.is_empty()
    }

    /// How many axes there are.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// How a move goes.
    pub fn kind(&self, at: u32) -> u8 {
        self.kinds[at as usize] & ((1 << COURSE) - 1)
    }

    /// How the axes go between the ends of a move.
    pub fn course(&self, at: u32) -> Course {
        COURSES[usize::from(self.kinds[at as usize] >> COURSE)]
    }

    /// Whether in all moves the axes go together.
    pub fn goes_together(&self) -> bool {
        !self.goes_apart
    }

    /// The way on which the axes lead the tip in a move, where that is no straight line, and all of it is known.
    pub fn led(&self, at: u32) -> Option<AxisMotion<'_>> {
        let together = match self.course(at) {
            Course::Tool | Course::Tip => return None,
            Course::Axes => true,
            Course::EachAxis => false,
        };
        // A mill goes straight where nothing turns; a joint always turns something.
        let turning = if self.kind(at) == JOINTS { 0 } else { 3 };
        if together && self.stride <= turning {
            return None;
        }
        let (from, to) = (self.positions(at.checked_sub(1)?), self.positions(at));
        if together && from.get(turning..) == to.get(turning..) {
            return None;
        }
        let ToolPose { tip, axis } = self.behind(at);
        self.chain.as_ref()?.motion([&from, &to], (tip, axis), together)
    }

    /// How long the tool of a mill is behind a move, mm, as its tip and the axes say: the control need not know it.
    pub fn tool_length(&self, at: u32) -> Option<f64> {
        let length = self.chain.as_ref()?.tool_length(&self.positions(at), self.behind(at).tip);
        length.is_finite().then_some(length)
    }

    /// Where the axes of an arm are, and its tool axis, where its control keeps the tip on its way in a move, and the tip is there at a part of it.
    pub fn keeping_tip(&self, at: u32, tip: Vec3, part: f64) -> Option<(Vec<f64>, Vec3)> {
        if self.course(at) != Course::Tool {
            return None;
        }
        let ends = [self.positions(at.checked_sub(1)?), self.positions(at)];
        let ToolPose { tip: end, axis } = self.behind(at);
        self.chain.as_ref()?.keeping_tip([&ends[0], &ends[1]], (end, axis), tip, part)
    }

    /// Place of its tool among [`Walk::tool_uses`], or [`NO_TOOL`].
    pub fn tool(&self, at: u32) -> u8 {
        self.tools[at as usize]
    }

    /// What is marked of it.
    pub fn marks(&self, at: u32) -> u8 {
        self.marks[at as usize]
    }

    /// The line of its block.
    pub fn line(&self, at: u32) -> u32 {
        self.lines[at as usize]
    }

    /// The called file that its block stands in; none where it is the program itself.
    pub fn file(&self, at: u32) -> Option<&str> {
        holds(&self.files, at)?.map(|name| &*self.names[name as usize])
    }

    /// The line of its record; 0 for none.
    pub fn source_line(&self, at: u32) -> u32 {
        self.source_lines[at as usize]
    }

    /// When it is over, s.
    pub fn end(&self, at: u32) -> f64 {
        self.ends[at as usize]
    }

    /// When what goes before it is over, s.
    pub fn end_before(&self, at: u32) -> f64 {
        at.checked_sub(1).map_or(0.0, |before| self.end(before))
    }

    /// How long the machine waits before it, s.
    pub fn waited(&self, at: u32) -> f64 {
        of(&self.waits, at).copied().unwrap_or(0.0)
    }

    /// Its arc.
    pub fn arc(&self, at: u32) -> Option<&Arc> {
        of(&self.arcs, at)
    }

    /// The arcs among some moves.
    pub fn arcs(&self, moves: Range<u32>) -> &[(u32, Arc)] {
        among(&self.arcs, moves)
    }

    /// Where the tool is before those of some moves that do not begin where the one before ended.
    pub fn starts(&self, moves: Range<u32>) -> &[(u32, ToolPose)] {
        among(&self.starts, moves)
    }

    /// Its feed.
    pub fn feed(&self, at: u32) -> Option<Feed> {
        *holds(&self.feeds, at)?
    }

    /// How far its tip is off the source at the most, mm; NaN where nothing was compared.
    pub fn deviation(&self, at: u32) -> f32 {
        self.deviations[at as usize]
    }

    /// The largest deviation, mm.
    pub fn largest_deviation(&self) -> Option<f64> {
        self.deviation
    }

    /// The first cuts in which a rotary axis turns far, and how many there are.
    pub fn jumps(&self) -> (&[Jump], u32) {
        (&self.jumps, self.jumps_in_all)
    }

    /// The first excursions, and how many there are.
    pub fn excursions(&self) -> (&[Excursion], u32) {
        (&self.excursions, self.excursions_in_all)
    }

    /// What holds in it.
    pub fn state(&self, at: u32) -> Option<&MachineState> {
        holds(&self.states, at)
    }

    /// The tool behind it.
    pub fn behind(&self, at: u32) -> ToolPose {
        let axis = self.axes.get(at as usize).copied().unwrap_or(Vec3::Z);
        ToolPose { tip: self.tips[at as usize], axis }
    }

    /// The tool before it.
    pub fn before(&self, at: u32) -> ToolPose {
        of(&self.starts, at).copied().unwrap_or_else(|| match at.checked_sub(1) {
            Some(before) => self.behind(before),
            None => ToolPose { tip: Vec3::NAN, axis: Vec3::NAN },
        })
    }

    /// Where the axes are behind it.
    pub fn positions(&self, at: u32) -> Positions {
        let (mut values, count) = ([f64::NAN; MOST_AXES], self.stride);
        let own = match holds(&self.offsets, at) {
            Some(offset) => &(self.tips[at as usize] + *offset).to_array()[..],
            None => &self.positions[at as usize * count..][..count],
        };
        values[..count].copy_from_slice(own);
        Positions { values, count }
    }

    /// The move that is under way at a time, s.
    pub fn at_time(&self, seconds: f64) -> Option<u32> {
        let at = self.ends.partition_point(|end| *end < seconds);
        u32::try_from(at.min(self.kinds.len().checked_sub(1)?)).ok()
    }

    /// The lines from one on that make moves, in their order, each with its moves.
    fn lines_from(&self, by: By, line: u32) -> impl Iterator<Item = (u32, u32)> {
        let (index, column) = match by {
            By::Block(_) => (&self.by_block, &self.lines),
            By::Source => (&self.by_source, &self.source_lines),
        };
        // No record and no block stands on line 0.
        index.from(column, line.max(1)).filter(move |(_, at)| match by {
            By::Block(file) => self.file(*at) == file,
            By::Source => true,
        })
    }

    /// The moves that a line makes, as ranges (first, behind the last), up to so many.
    pub fn moves_of(&self, by: By, line: u32, most: usize) -> Vec<[u32; 2]> {
        let mut ranges: Vec<[u32; 2]> = Vec::new();
        for (_, at) in self.lines_from(by, line).take_while(|(own, _)| *own == line) {
            let is_full = ranges.len() == most;
            match ranges.last_mut() {
                Some([_, end]) if *end == at => *end += 1,
                _ if is_full => break,
                _ => ranges.push([at, at + 1]),
            }
        }
        ranges
    }

    /// The first move of the first line behind `line` that makes some.
    pub fn next_line(&self, by: By, line: u32) -> Option<u32> {
        self.lines_from(by, line.checked_add(1)?).next().map(|(_, at)| at)
    }

    /// How much memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        let each =
            3 + 2 * size_of::<u32>() + size_of::<f32>() + size_of::<f64>() + size_of::<Vec3>();
        let rare = self.starts.len() * size_of::<(u32, ToolPose)>()
            + self.arcs.len() * size_of::<(u32, Arc)>()
            + self.feeds.len() * size_of::<(u32, Option<Feed>)>()
            + self.states.len() * size_of::<(u32, MachineState)>()
            + self.offsets.len() * size_of::<(u32, Vec3)>();
        let axes = self.axes.len() * size_of::<Vec3>() + self.positions.len() * size_of::<f64>();
        let records = size_of_val(&self.records[..]);
        self.kinds.len() * each
            + axes
            + rare
            + records
            + self.by_block.bytes()
            + self.by_source.bytes()
    }

    fn push(&mut self, motion: &Motion) {
        let Ok(at) = u32::try_from(self.kinds.len()) else { return };
        let Motion { tool: [before, behind], .. } = motion;
        let kind = match &motion.kind {
            MotionKind::Rapid => RAPID,
            MotionKind::Line => FEED,
            MotionKind::Arc(_) => ARC,
            MotionKind::Joints => JOINTS,
        };
        let course = match motion.course {
            Course::Tool => 0,
            Course::Tip => 1,
            Course::Axes => 2,
            Course::EachAxis => 3,
        };
        self.goes_apart |= motion.course == Course::EachAxis;
        self.kinds.push(kind | course << COURSE);
        if let MotionKind::Arc(arc) = &motion.kind {
            self.arcs.push((at, **arc));
        }
        let goes_on = at.checked_sub(1).is_some_and(|last| same(&self.behind(last), before));
        if !goes_on {
            self.starts.push((at, *before));
        }
        if !self.axes.is_empty() || behind.axis != Vec3::Z {
            self.axes.resize(self.tips.len(), Vec3::Z);
            self.axes.push(behind.axis);
        }
        self.tips.push(behind.tip);
        self.lines.push(motion.line);
        self.source_lines.push(motion.source_line);
        let (seconds, waited) = (known(motion.seconds), known(motion.waited));
        if waited > 0.0 {
            self.waits.push((at, waited));
        }
        self.ends.push(self.seconds() + waited + seconds);
        let deviation = motion.deviation.map(|deviation| deviation.tip_mm);
        self.deviations.push(deviation.map_or(f32::NAN, |mm| mm as f32));
        // What is not known is not the largest.
        self.deviation = self.deviation.into_iter().chain(deviation).reduce(f64::max);
        if self.feeds.last().is_none_or(|(_, feed)| *feed != motion.feed) {
            self.feeds.push((at, motion.feed));
        }
        let file =
            motion.file.as_ref().map(|file| match self.names.iter().position(|n| n == file) {
                Some(place) => place as u32,
                None => {
                    self.names.push(file.clone());
                    self.names.len() as u32 - 1
                }
            });
        if self.files.last().is_none_or(|(_, last)| *last != file) {
            self.files.push((at, file));
        }
    }
}

/// A duration, as far as it is one.
fn known(seconds: f64) -> f64 {
    if seconds.is_finite() { seconds.max(0.0) } else { 0.0 }
}

/// Whether two poses are the same, also where both are not known.
fn same(a: &ToolPose, b: &ToolPose) -> bool {
    let bits = |pose: &ToolPose| {
        (pose.tip.to_array().map(f64::to_bits), pose.axis.to_array().map(f64::to_bits))
    };
    bits(a) == bits(b)
}

/// A walk and its drawing.
#[derive(Debug, Default)]
pub struct Drawn {
    /// The moves.
    pub walk: Walk,
    /// The same in levels of detail.
    pub geometry: Geometry,
}

/// Writes the columns while a proof runs, and has them drawn.
pub struct Follower<'a> {
    walk: Walk,
    /// Name of the program's file.
    file: String,
    drawing: Drawing,
    /// How many chunks have been drawn, and those whose marks have changed since.
    drawn: u32,
    marked: BTreeSet<u32>,
    source: &'a Program,
    /// The records of the source have no lines of a file.
    has_no_lines: bool,
    /// Which of A, B and C the machine has.
    rotary: Vec<usize>,
    /// The control names no tools: they are those of the source.
    has_source_tools: bool,
    /// The record up to which operations have been looked for.
    searched: usize,
    numbers: BTreeMap<(u32, String), u8>,
    /// The tool that the source has in the spindle, up to the record that operations have been looked for.
    source_tool: Option<&'a Tool>,
    /// Place of the tool that is in the spindle, as the control says it.
    tool: u8,
    /// Place of the tool of the next move, where it is not looked for anew.
    tool_of_moves: Option<u8>,
    compensation: Option<Compensation>,
    /// What is marked of the next move.
    next_marks: u8,
    waits: &'a dyn Waits,
    ended: &'a Ended,
    goes_to: Slot,
}

/// Where a walk is put when its proof is over.
pub type Slot = sync::Arc<Mutex<Option<Drawn>>>;

impl<'a> Follower<'a> {
    /// Follows the proof of the program `file`, which is to make the motions of `source`, and hands the walk over at its end, unless the work
    /// is ended. Who waits is shown it meanwhile.
    pub fn new(
        file: &str,
        source: &'a Program,
        machine: &Machine,
        (waits, ended): (&'a dyn Waits, &'a Ended),
        to: Slot,
    ) -> Follower<'a> {
        // As many moves as records, about.
        let chunks = source.records.len() / CHUNK as usize + 1;
        Follower {
            walk: Walk {
                chain: machine.wire.is_none().then(|| Chain::of(machine)),
                ..Walk::default()
            },
            file: file.to_owned(),
            drawing: Drawing::begin(geometry::COARSEST / chunks, ended),
            drawn: 0,
            marked: BTreeSet::new(),
            source,
            has_no_lines: !source.records.is_empty()
                && source.records.iter().all(|record| record.line == 0),
            rotary: machine.rotary.iter().map(|axis| axis.index()).collect(),
            has_source_tools: machine.arm.is_some(),
            searched: 0,
            numbers: BTreeMap::new(),
            source_tool: None,
            tool: NO_TOOL,
            tool_of_moves: None,
            compensation: None,
            next_marks: 0,
            waits,
            ended,
            goes_to: to,
        }
    }

    /// The same of moves of the source itself, which no control has read.
    #[must_use]
    pub fn of_source(mut self) -> Follower<'a> {
        self.has_source_tools = true;
        self
    }

    /// Has the next chunk drawn, and shows what has been drawn.
    fn draw(&mut self) {
        self.drawing.next(Exact::of(&self.walk, self.drawn));
        self.drawn += 1;
        self.show();
    }

    /// Shows what has been drawn since.
    fn show(&self) {
        for piece in self.drawing.pieces() {
            self.waits.walked(&self.file, piece);
        }
    }

    /// Marks a move, also one that has been drawn.
    fn mark(&mut self, at: u32, mark: u8) {
        if let Some(marks) = self.walk.marks.get_mut(at as usize) {
            *marks |= mark;
            if at / CHUNK < self.drawn {
                self.marked.insert(at / CHUNK);
            }
        }
    }

    /// Looks, now and then, whether there is memory for more.
    fn look(&mut self) {
        if self.walk.kinds.len().is_multiple_of(LOOK) {
            self.walk.is_full |= self.walk.bytes() > MOST_BYTES;
        }
    }

    /// Notes the operations that begin up to a record, and the tool that the source has there.
    fn operations(&mut self, record: usize) {
        let records = &self.source.records;
        let end = (record + 1).min(records.len());
        for record in records.get(self.searched..end).unwrap_or_default() {
            if let Op::Tool(tool) = &record.op {
                (self.source_tool, self.tool_of_moves) = (Some(&**tool), None);
            }
            if let Op::Operation(name) = &record.op {
                let (r#move, time_s) = (self.walk.len(), self.walk.seconds());
                let begun = Operation { name: name.to_string(), r#move, time_s };
                // Of operations without a move the last one holds.
                let is_full = self.walk.operations.len() == MOST_NAMED;
                match self.walk.operations.last_mut() {
                    Some(last) if last.r#move == r#move => *last = begun,
                    _ if is_full => {}
                    _ => self.walk.operations.push(begun),
                }
            }
        }
        self.searched = self.searched.max(end);
    }

    /// The place of a tool among those that are listed: it is added where it is new.
    fn place_of(&mut self, tool: &Tool) -> u8 {
        let key = (tool.number, tool.name.clone());
        if let Some(place) = self.numbers.get(&key) {
            return *place;
        }
        let place = u8::try_from(self.walk.tool_uses.len()).unwrap_or(NO_TOOL);
        if place == NO_TOOL {
            return NO_TOOL;
        }
        self.numbers.insert(key, place);
        let (first, time_s) = (self.walk.len(), self.walk.seconds());
        self.walk.tool_uses.push(ToolUse::new(tool, first, time_s));
        place
    }

    /// Place of the tool of the next move: that of the control, with what the source knows of it; that of a robot, whose control knows none, is the source's.
    fn tool_of_move(&mut self) -> u8 {
        if let Some(place) = self.tool_of_moves {
            return place;
        }
        let place = match (self.tool, self.source_tool) {
            (NO_TOOL, Some(tool)) if self.has_source_tools => self.place_of(tool),
            (place, Some(tool)) => {
                if let Some(own) = self.walk.tool_uses.get_mut(usize::from(place)) {
                    own.know(tool);
                }
                place
            }
            (place, None) => place,
        };
        self.tool_of_moves = Some(place);
        place
    }

    /// Notes the rotary axes that turn far in the last move, where it cuts.
    fn jumps(&mut self) {
        let walk = &mut self.walk;
        let at = walk.len() - 1;
        let Some(before) = at.checked_sub(1).filter(|_| walk.kind(at) != RAPID) else { return };
        for axis in (3..).take(self.rotary.len()) {
            let (from, to) = (walk.positions(before)[axis], walk.positions(at)[axis]);
            if (to - from).abs() > JUMP {
                walk.jumps_in_all += 1;
                if walk.jumps.len() < LISTED {
                    let time_s = walk.end(before);
                    walk.jumps.push(Jump { axis: axis as u32, r#move: at, time_s, from, to });
                }
            }
        }
    }

    fn positions(&mut self, axes: &AxisPositions) {
        let positions = &mut self.walk.positions;
        let before = positions.len();
        match axes {
            AxisPositions::Mill { linear, .. } if self.rotary.is_empty() => {
                let tip = self.walk.tips[self.walk.tips.len() - 1];
                let offset = *linear - tip;
                // Where neither is known, nothing has changed.
                let is_like = |last: Vec3| {
                    let unknown = linear.is_nan_mask() & tip.is_nan_mask();
                    ((offset - last).abs().cmple(Vec3::splat(SAME)) | unknown).all()
                };
                if !self.walk.offsets.last().is_some_and(|(_, last)| is_like(*last)) {
                    self.walk.offsets.push((self.walk.len() - 1, offset));
                }
                self.walk.stride = 3;
                return;
            }
            AxisPositions::Mill { linear, rotary } => {
                positions.extend_from_slice(&linear.to_array());
                for axis in &self.rotary {
                    positions.push(rotary[*axis]);
                }
            }
            AxisPositions::Wire { guide, lean } => {
                positions.extend_from_slice(&guide.to_array());
                positions.extend_from_slice(lean);
            }
            AxisPositions::Arm { joints, rail } => {
                positions.extend_from_slice(joints);
                positions.extend(rail);
            }
        }
        self.walk.stride = positions.len() - before;
    }
}

impl Observer for Follower<'_> {
    fn wants_motions(&self) -> bool {
        true
    }

    fn moved(&mut self, motion: &Motion) {
        self.look();
        if self.walk.is_full {
            self.walk.left_out += 1;
            return;
        }
        self.operations(motion.record);
        let tool = self.tool_of_move();
        self.walk.tools.push(tool);
        if self.has_no_lines {
            self.walk.records.push(u32::try_from(motion.record).unwrap_or(u32::MAX));
        }
        self.walk.push(motion);
        self.walk.marks.push(std::mem::take(&mut self.next_marks));
        self.positions(&motion.axes);
        if !self.rotary.is_empty() {
            self.jumps();
        }
        if self.walk.len().is_multiple_of(CHUNK) {
            self.draw();
        }
    }

    fn stated(&mut self, state: &MachineState) {
        let at = self.walk.len();
        if self.walk.is_full {
            return;
        }
        if self.compensation.is_some_and(|before| before != state.compensation) {
            self.next_marks |= SWITCHED;
        }
        self.compensation = Some(state.compensation);
        let tool = state.tool.as_ref().map_or(NO_TOOL, |tool| self.place_of(tool));
        if tool != self.tool {
            (self.tool, self.tool_of_moves) = (tool, None);
        }
        // What holds for no move is not kept.
        self.walk.states.pop_if(|(from, _)| *from == at);
        self.walk.states.push((at, state.clone()));
    }

    fn mismatched(&mut self, _found: &Diagnostic) {
        let last = self.walk.len().saturating_sub(1);
        self.walk.mismatch = Some(last);
        self.mark(last, MISMATCH);
    }

    fn ended(&mut self, report: &Report) {
        // By file and first line: excursions do not overlap.
        let by_line = report.excursions.iter().map(|excursion| {
            ((excursion.program_file.as_deref(), excursion.first_program_line), excursion)
        });
        let by_line: BTreeMap<(Option<&str>, u32), &proof::Excursion> = by_line.collect();
        self.walk.excursions_in_all = report.excursions.len() as u32;
        let mut last = None;
        for at in (0..self.walk.len()).filter(|_| !by_line.is_empty()) {
            let (file, line) = (self.walk.file(at), self.walk.line(at));
            let found = by_line.range(..=(file, line)).next_back().map(|(_, found)| *found);
            let within = found.filter(|found| {
                found.program_file.as_deref() == file && line <= found.last_program_line
            });
            let Some(found) = within else { continue };
            if last.replace(found.first_program_line) != Some(found.first_program_line)
                && self.walk.excursions.len() < LISTED
            {
                let time_s = at.checked_sub(1).map_or(0.0, |before| self.walk.end(before));
                let lift_mm = found.lift_mm;
                self.walk.excursions.push(Excursion { r#move: at, time_s, lift_mm });
            }
            self.mark(at, EXCURSION);
        }
        if !self.walk.len().is_multiple_of(CHUNK) {
            self.draw();
        }
        for chunk in std::mem::take(&mut self.marked) {
            self.drawing.again(chunk, Exact::of(&self.walk, chunk));
        }
        let mut walk = std::mem::take(&mut self.walk);
        let index = |lines| Index::of(lines, &|| !self.ended.is_ended());
        let (Some(by_block), Some(by_source)) = (index(&walk.lines), index(&walk.source_lines))
        else {
            return;
        };
        (walk.by_block, walk.by_source) = (by_block, by_source);
        let Some(geometry) = self.drawing.finish() else { return };
        self.show();
        *self.goes_to.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(Drawn { walk, geometry });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(line: u32, tip: [f64; 3]) -> Motion {
        let pose = |tip: [f64; 3]| ToolPose { tip: tip.into(), axis: Vec3::Z };
        Motion {
            file: None,
            line,
            record: 0,
            source_line: 10 * line,
            kind: MotionKind::Line,
            course: Course::Axes,
            tool: [pose([0.0; 3]), pose(tip)],
            axes: AxisPositions::Mill { linear: tip.into(), rotary: [0.0; 3] },
            feed: Some(Feed::PerMinute(100.0)),
            seconds: 2.0,
            waited: 0.0,
            deviation: None,
        }
    }

    fn followed(tell: impl Fn(&mut Follower)) -> Walk {
        drawn("generic-3axis-linuxcnc", tell).walk
    }

    fn drawn(machine: &str, tell: impl Fn(&mut Follower)) -> Drawn {
        let machine = machine::load(machine).unwrap();
        let (source, ended, handed) = (Program::new("x"), Ended::default(), Slot::default());
        let (waits, to) = ((&() as &dyn Waits, &ended), Slot::clone(&handed));
        let mut follower = Follower::new("x.nc", &source, &machine, waits, to);
        tell(&mut follower);
        follower.ended(&Report::default());
        handed.lock().unwrap().take().unwrap()
    }

    #[test]
    fn a_line_that_is_run_again_makes_several_ranges() {
        let walk = followed(|follower| {
            for line in [1, 2, 2, 3, 1, 2, 9] {
                follower.moved(&motion(line, [f64::from(line), 0.0, 0.0]));
            }
        });
        let by = By::Block(None);
        assert_eq!(walk.moves_of(by, 2, 9), [[1, 3], [5, 6]]);
        assert_eq!(walk.moves_of(by, 2, 1), [[1, 3]]);
        assert_eq!(walk.moves_of(By::Source, 10, 9), [[0, 1], [4, 5]]);
        assert!(walk.moves_of(By::Block(Some("part.nc")), 2, 9).is_empty());
        assert_eq!((walk.next_line(by, 4), walk.next_line(by, 9)), (Some(6), None));
    }

    #[test]
    fn time_goes_through_waits() {
        let walk = followed(|follower| {
            follower.moved(&motion(1, [1.0, 0.0, 0.0]));
            follower.moved(&Motion { waited: 6.0, ..motion(2, [2.0, 0.0, 0.0]) });
            follower.moved(&Motion { seconds: f64::NAN, ..motion(3, [f64::NAN; 3]) });
        });
        assert_eq!((walk.end(0), walk.end(1), walk.seconds()), (2.0, 10.0, 10.0));
        assert_eq!(
            (walk.at_time(0.0), walk.at_time(2.0), walk.at_time(2.1)),
            (Some(0), Some(0), Some(1))
        );
        assert_eq!((walk.at_time(99.0), Walk::default().at_time(0.0)), (Some(2), None));
    }

    /// 1 + 1 + 1 + 4 + 4 + 4 + 8 + 24: X, Y and Z go with the tip.
    #[test]
    fn a_move_takes_as_much_memory_as_the_front_page_says() {
        let walk = followed(|follower| {
            let mut before = ToolPose { tip: Vec3::ZERO, axis: Vec3::Z };
            for line in 1..=1000 {
                let motion = motion(line, [f64::from(line), 0.0, 0.0]);
                let [_, behind] = motion.tool;
                follower.moved(&Motion { tool: [before, behind], ..motion });
                before = behind;
            }
        });
        assert!((walk.bytes() as f64 / 1000.0 - 47.0).abs() < 1.0, "{}", walk.bytes());
    }

    /// A failed proof marks its last move when the chunk of that has been drawn.
    #[test]
    fn a_mark_behind_a_chunk_that_is_drawn_is_drawn_too() {
        let drawn = drawn("generic-3axis-linuxcnc", |follower| {
            for line in 1..=CHUNK {
                follower.moved(&motion(line, [f64::from(line), 0.0, 0.0]));
            }
            follower.mismatched(&Diagnostic::error(program::Rule::RapidPath, "x"));
        });
        let vertices = drawn.geometry.vertices(&drawn.walk, 0, 0).unwrap();
        let marks = vertices.chunks(16).map(|vertex| vertex[15]);
        // Each of these moves begins at the zero point: two vertices each.
        assert_eq!(marks.rev().take(4).collect::<Vec<_>>(), [MISMATCH, MISMATCH, 0, 0]);
    }

    #[test]
    fn axes_that_go_with_the_tip_are_where_they_were_told_to_be() {
        let told = [
            ([f64::NAN, f64::NAN, f64::NAN], [1.0, 2.0, f64::NAN]),
            ([1.0, 2.0, f64::NAN], [101.0, 202.0, f64::NAN]),
            ([1.0, 2.0, 3.0], [101.0, 202.0, 303.0]),
            ([4.0, 5.0, f64::NAN], [104.0, 205.0, f64::NAN]),
            // The tip is known and the axes are not, with another work offset, and again with the one before.
            ([4.0, 5.0, 6.0], [104.0, f64::NAN, 306.0]),
            ([4.0, 5.0, 6.0], [14.0, 25.0, 36.0]),
            ([4.0, 5.0, 6.0], [104.0, 205.0, 306.0]),
        ];
        let walk = followed(|follower| {
            for (tip, linear) in told {
                let axes = AxisPositions::Mill { linear: linear.into(), rotary: [0.0; 3] };
                follower.moved(&Motion { axes, ..motion(1, tip) });
            }
        });
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 || a.is_nan() && b.is_nan();
        for (at, (_, linear)) in (1..).zip(&told[1..]) {
            let found = walk.positions(at);
            assert!(found.len() == 3 && found.iter().zip(linear).all(is_near), "{at}: {found:?}");
        }
        // Where no tip is known, nothing is said of the axes.
        assert!(walk.positions(0).iter().all(|at| at.is_nan()));
    }

    #[test]
    fn a_cut_in_which_a_rotary_axis_turns_far_is_a_jump_and_a_rapid_is_none() {
        let turns = |kind, b, c| Motion {
            axes: AxisPositions::Mill { linear: Vec3::ZERO, rotary: [0.0, b, c] },
            kind,
            ..motion(1, [0.0; 3])
        };
        let walk = drawn("fanuc-table-bc", |follower| {
            follower.moved(&turns(MotionKind::Line, 0.0, 200.0));
            follower.moved(&turns(MotionKind::Line, 29.0, 200.0));
            follower.moved(&turns(MotionKind::Rapid, 29.0, 0.0));
            follower.moved(&turns(MotionKind::Line, 60.0, -31.0));
            follower.moved(&turns(MotionKind::Line, f64::NAN, -31.0));
        });
        let (jumps, count) = walk.walk.jumps();
        let jump = |axis, from, to| Jump { axis, r#move: 3, time_s: 6.0, from, to };
        assert_eq!((jumps, count), (&[jump(3, 29.0, 60.0), jump(4, 0.0, -31.0)][..], 2));
    }

    #[test]
    fn the_largest_deviation_is_that_of_a_move_that_was_compared() {
        let off = |tip_mm| Motion {
            deviation: Some(proof::Deviation { tip_mm, axis_degrees: 0.0 }),
            ..motion(1, [0.0; 3])
        };
        let walk = followed(|follower| {
            follower.moved(&motion(1, [0.0; 3]));
            follower.moved(&off(0.004));
            follower.moved(&off(0.001));
        });
        assert!(walk.deviation(0).is_nan());
        assert_eq!((walk.deviation(1), walk.largest_deviation()), (0.004, Some(0.004)));
        assert_eq!(
            followed(|follower| follower.moved(&motion(1, [0.0; 3]))).largest_deviation(),
            None
        );
    }

    #[test]
    fn tools_and_switches_of_the_compensation_are_marked() {
        let state = |number: u32, compensation| MachineState {
            tool: Some(Tool { number, ..Tool::default() }),
            compensation,
            spindle: proof::SpindleState::Off,
            surface_speed: None,
            coolant: program::Coolant::Off,
            length_offset: None,
            work_offset: None,
            cycle: None,
            path: program::PathMode::AsSetUp,
            taper: 0.0,
            joint_speed: None,
        };
        let walk = followed(|follower| {
            follower.stated(&state(4, Compensation::Off));
            follower.moved(&motion(1, [1.0, 0.0, 0.0]));
            follower.stated(&state(7, Compensation::Off));
            follower.moved(&motion(2, [2.0, 0.0, 0.0]));
            follower.stated(&state(4, Compensation::Left(None)));
            follower.moved(&motion(3, [3.0, 0.0, 0.0]));
        });
        assert_eq!([0, 1, 2].map(|at| walk.tool(at)), [0, 1, 0]);
        assert_eq!([0, 1, 2].map(|at| walk.marks(at)), [0, 0, SWITCHED]);
        let first: Vec<(u32, u32)> =
            walk.tool_uses().iter().map(|tool| (tool.number, tool.r#move)).collect();
        assert_eq!(first, [(4, 0), (7, 1)]);
    }
}
