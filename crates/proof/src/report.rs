//! What a proof found, for a machinist and for a program that reads JSON.

use crate::tolerance::Applied;
use control::{Orientation, Position};
use geom::{Arc, Vec2, Vec3};
use machine::Unsaid;
use machine::limits::Travel;
use machine::time::Times;
use program::{Diagnostic, Severity};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The most mismatches and the most warnings that a report names; more of a rule raise its count.
pub(crate) const MOST: usize = 20;

/// The most excursions that a report lists; all are counted.
const MOST_EXCURSIONS: usize = 100;

/// What the proof found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Whether the program makes the motion of the source.
    pub proven: bool,
    /// The mismatches, first to last, up to a fixed number; the same rule is listed once, with its
    /// count. Their lines are those of the NC program.
    pub mismatches: Vec<Diagnostic>,
    /// What is worth knowing.
    pub warnings: Vec<Diagnostic>,
    /// What would be mismatches, had their rules not been accepted for this run ([`Accepted`](crate::Accepted)).
    pub accepted: Vec<Diagnostic>,
    /// The first mismatch as source line and program block.
    pub first_mismatch: Option<SideBySide>,
    /// How close the motions had to be.
    pub tolerances: Applied,
    /// How many motions and events of the source were found in the program.
    pub compared: Compared,
    /// The largest deviations.
    pub deviations: Deviations,
    /// Where the program leaves the source's path and comes back to it; the first hundred.
    pub excursions: Vec<Excursion>,
    /// What of the travel of the axes was checked.
    pub travel: TravelChecked,
    /// What was checked of the joints, where the machine is a robot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arm: Option<ArmChecked>,
    /// What the program does, as the control runs it.
    pub program: Summary,
}

/// What was checked of the joints of an arm, on the whole path of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ArmChecked {
    /// The least distance of a joint from its limits, degrees.
    pub limit_degrees: Option<f64>,
    /// The least distance of joint 5 from stretched along a line or an arc, degrees.
    pub wrist_degrees: Option<f64>,
    /// The largest part of a joint's speed along a line or an arc, percent.
    pub speed_percent: f64,
    /// By how much cuts (`compared.slowed` of them) take longer than at their feed, since the control turns the tool no faster, s.
    pub slowed_s: f64,
}

impl ArmChecked {
    pub(crate) fn note_limit(&mut self, radians: f64) {
        let degrees = radians.to_degrees();
        self.limit_degrees = Some(self.limit_degrees.map_or(degrees, |least| least.min(degrees)));
    }

    pub(crate) fn note_wrist(&mut self, radians: f64) {
        let degrees = radians.to_degrees();
        self.wrist_degrees = Some(self.wrist_degrees.map_or(degrees, |least| least.min(degrees)));
    }
}

/// What of the travel of the axes was checked, in machine space. Limits of rotary axes always are.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TravelChecked {
    /// How X, Y and Z were checked.
    pub linear: Travel,
    /// What nobody says, for want of which positions of X, Y and Z were not checked.
    pub unsaid: Vec<Unsaid>,
}

/// A place of the source with a place of the program.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SideBySide {
    /// Line of the source, from 1; 0 where the source has none.
    pub source_line: u32,
    /// The called file of the NC program; none for the one that is run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program_file: Option<String>,
    /// Line of the NC program, from 1; 0 for its end.
    pub program_line: u32,
    /// The block on that line.
    pub block: String,
}

/// Counts of what was compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Compared {
    /// Rapid moves of the source.
    pub rapids: usize,
    /// Straight cutting moves of the source, threads and probing moves among them.
    pub lines: usize,
    /// Arcs and helices of the source.
    pub arcs: usize,
    /// Holes of the source.
    pub holes: usize,
    /// Moves of the source too short to be a step of the machine, left out by the program.
    pub left_out: usize,
    /// Dwells, stops and optional stops.
    pub events: usize,
    /// Tool changes of the program.
    pub tool_changes: usize,
    /// Excursions of the program.
    pub excursions: usize,
    /// Contours along which the control leads the centre of the source's tool as it has to.
    pub contours: usize,
    /// Cuts in which the tip is slower than the source wants it, since an axis, or F, can go no faster.
    pub slowed: usize,
}

/// The largest deviations of the program from the source.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Deviations {
    /// Of the tool tip at the end of a move, mm.
    pub tip_mm: Worst,
    /// Of the tool axis at the end of a move, degrees.
    pub axis_degrees: Worst,
    /// Of the tool tip from the path of a cutting move, mm.
    pub path_mm: Worst,
    /// Of the tool tip, anywhere on the way of a rapid, from the straight way of the source, mm: where it keeps to that way, and
    /// where it is not beyond all cuts. As the axes really go; what is beyond all cuts may go in any way and does not count.
    pub rapid_mm: Worst,
    /// Of the average speed of the tip from the feed of the source, percent, where the number behind F is not that speed: in
    /// inverse time, and where rotary axes turn and the control counts their degrees. By F alone: a cut in which an axis can
    /// go no faster is in it where its F says so.
    pub tip_speed_percent: Worst,
}

/// A largest value and where it is.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// Line of the source.
    pub source_line: u32,
    /// The called file of the NC program; none for the one that is run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program_file: Option<String>,
    /// Line of the NC program.
    pub program_line: u32,
}

impl Deviations {
    /// The larger of both.
    pub(crate) fn widen(&mut self, other: &Deviations) {
        let mine = [
            &mut self.tip_mm,
            &mut self.axis_degrees,
            &mut self.path_mm,
            &mut self.rapid_mm,
            &mut self.tip_speed_percent,
        ];
        let others = [
            &other.tip_mm,
            &other.axis_degrees,
            &other.path_mm,
            &other.rapid_mm,
            &other.tip_speed_percent,
        ];
        for (mine, other) in mine.into_iter().zip(others) {
            if other.value > mine.value {
                *mine = other.clone();
            }
        }
    }
}

impl Worst {
    /// Notes a value at a line of the source and at a place of the program: a line of the program that is run, or of a file that it calls.
    pub(crate) fn note<'a>(&mut self, value: f64, source_line: u32, place: impl Into<Place<'a>>) {
        if value > self.value {
            let Place { file, line } = place.into();
            let program_file = file.map(str::to_owned);
            *self = Worst { value, source_line, program_file, program_line: line };
        }
    }
}

/// A line of the program that is run, or of a file that it calls.
pub(crate) struct Place<'a> {
    file: Option<&'a str>,
    line: u32,
}

impl From<u32> for Place<'_> {
    fn from(line: u32) -> Self {
        Place { file: None, line }
    }
}

impl<'a> From<(Option<&'a str>, u32)> for Place<'a> {
    fn from((file, line): (Option<&'a str>, u32)) -> Self {
        Place { file, line }
    }
}

/// A way away from the source's path and back to it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Excursion {
    /// Line of the source move from which it leaves.
    pub source_line: u32,
    /// The called file of the NC program; none for the one that is run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program_file: Option<String>,
    /// Line of the NC program on which it leaves.
    pub first_program_line: u32,
    /// Line of the NC program on which it is back.
    pub last_program_line: u32,
    /// How far the tool is lifted along its axis, mm; 0 where it goes home instead.
    pub lift_mm: f64,
}

/// What the program does, as the control runs it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Lines with something on them, of all its files.
    pub blocks: usize,
    /// Tools in the order of their first call: numbers, or names where they are called so.
    pub tools: Vec<String>,
    /// Path length of the tip in the work frame in feed moves, holes included, mm.
    pub cutting_length_mm: f64,
    /// Path length of the tip in rapid moves between known places, as straight lines, mm.
    pub rapid_length_mm: f64,
    /// How long it takes, s, as [`machine::time`] estimates it of what the control has read: rapids as the program makes them, axis by axis
    /// and by way of a retract, probing moves as if they went to their ends. Ways from and to a place that is not known, as home, take nothing.
    pub time_s: Times,
    /// Programmed positions of X, Y and Z, mm.
    pub linear_extents_mm: [Extent; 3],
    /// U and V of a wire in the upper plane of its machine, mm; none of what has no wire.
    pub uv_extents_mm: [Extent; 2],
    /// Positions of A, B and C, degrees: programmed, or to which the control turns them in tilted planes and along vectors; all
    /// that are possible where several are.
    pub rotary_extents_degrees: [Extent; 3],
}

/// Smallest and largest position of an axis; `null` both where it is never programmed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Extent {
    /// Smallest.
    pub min: Option<f64>,
    /// Largest.
    pub max: Option<f64>,
}

impl Extent {
    /// Whether all from `low` to `high` is within.
    fn holds(&self, low: f64, high: f64) -> bool {
        self.min.is_some_and(|min| min <= low) && self.max.is_some_and(|max| high <= max)
    }

    fn include(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        self.min = Some(self.min.map_or(value, |min| min.min(value)));
        self.max = Some(self.max.map_or(value, |max| max.max(value)));
    }
}

impl Summary {
    /// Takes a programmed pose into the extents.
    pub(crate) fn include(&mut self, pose: &Position) {
        for (extent, value) in self.linear_extents_mm.iter_mut().zip(pose.point.to_array()) {
            extent.include(value);
        }
        if let Orientation::Rotary { degrees, .. } = pose.orientation {
            self.include_rotary(degrees);
        }
    }

    /// Takes the lean of a wire, U and V in mm, into the extents.
    pub(crate) fn include_lean(&mut self, uv: Vec2) {
        for (extent, value) in self.uv_extents_mm.iter_mut().zip(uv.to_array()) {
            extent.include(value);
        }
    }

    /// Takes positions of A, B and C (degrees) into the extents.
    pub(crate) fn include_rotary(&mut self, degrees: [f64; 3]) {
        for (extent, value) in self.rotary_extents_degrees.iter_mut().zip(degrees) {
            extent.include(value);
        }
    }

    /// Whether the extents hold all that is as near to `center` as `reach`, mm.
    pub(crate) fn holds(&self, center: Vec3, reach: f64) -> bool {
        let mut extents = self.linear_extents_mm.iter().zip(center.to_array());
        extents.all(|(extent, at)| extent.holds(at - reach, at + reach))
    }

    /// Takes the quadrants of an arc, in the coordinates of its block, into the extents.
    pub(crate) fn include_arc(&mut self, arc: &Arc) {
        let spoke = (arc.start - arc.center).reject_from_normalized(arc.normal);
        for (i, extent) in self.linear_extents_mm.iter_mut().enumerate() {
            // Along this direction of the arc's plane the coordinate grows fastest.
            let uphill = Vec3::AXES[i].reject_from_normalized(arc.normal);
            for peak in [uphill, -uphill] {
                let angle = arc.normal.dot(spoke.cross(peak)).atan2(spoke.dot(peak));
                let t = angle.rem_euclid(std::f64::consts::TAU) / arc.sweep;
                if uphill.length_squared() > 1e-18 && t <= 1.0 {
                    extent.include(arc.at(t)[i]);
                }
            }
        }
    }

    pub(crate) fn tool(&mut self, name: String) {
        if !self.tools.contains(&name) {
            self.tools.push(name);
        }
    }
}

impl Report {
    pub(crate) fn mismatch(&mut self, source_line: u32, found: Diagnostic) {
        if self.first_mismatch.is_none() {
            let block = String::new();
            let program_file = Some(&found.file).filter(|file| !file.is_empty()).cloned();
            self.first_mismatch =
                Some(SideBySide { source_line, program_file, program_line: found.line, block });
        }
        note(&mut self.mismatches, found);
    }

    pub(crate) fn accept(&mut self, mut found: Diagnostic) {
        found.severity = Severity::Warning;
        note(&mut self.accepted, found);
    }

    pub(crate) fn warn(&mut self, found: Diagnostic) {
        note(&mut self.warnings, found);
    }

    pub(crate) fn excursion(&mut self, excursion: Excursion) {
        self.compared.excursions += 1;
        if self.excursions.len() < MOST_EXCURSIONS {
            self.excursions.push(excursion);
        }
    }

    /// Adds the file name and the blocks of the NC text to what was found, and counts the blocks.
    pub(crate) fn quote(&mut self, file_name: &str, text: &[u8]) {
        self.quote_files((file_name, text), &BTreeMap::new());
    }

    /// The same of a program that calls others: of these, findings name the file already.
    pub(crate) fn quote_files(
        &mut self,
        (file_name, text): (&str, &[u8]),
        called: &BTreeMap<String, Vec<u8>>,
    ) {
        let blocks = |text| lines(text).filter(|line| !line.trim_ascii().is_empty()).count();
        self.program.blocks =
            blocks(text) + called.values().map(|text| blocks(text)).sum::<usize>();
        for found in self.mismatches.iter_mut().chain(&mut self.warnings).chain(&mut self.accepted)
        {
            let own = called.get(&found.file);
            if own.is_none() {
                found.file = file_name.into();
            }
            let text = own.map_or(text, |text| &text[..]);
            let block = found.line.checked_sub(1).and_then(|index| lines(text).nth(index as usize));
            if let (Some(block), true) = (block, found.excerpt.is_empty()) {
                *found = found.clone().at(found.line, block, 0, 0);
                // The finding is about the whole block.
                found.column = 0;
                found.excerpt.truncate(found.excerpt.find('\n').unwrap_or(usize::MAX));
            }
        }
        if let (Some(first), Some(found)) = (&mut self.first_mismatch, self.mismatches.first()) {
            first.block = found.excerpt.lines().next().unwrap_or_default().trim_end().into();
        }
    }
}

/// What stands between the line feeds of a text.
fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut from = 0;
    memchr::memchr_iter(b'\n', text).chain([text.len()]).map(move |end| {
        let line = &text[from..end];
        from = end + 1;
        line
    })
}

fn note(list: &mut Vec<Diagnostic>, found: Diagnostic) {
    if let Some(same) = list.iter_mut().find(|d| d.rule == found.rule) {
        same.again(found.line);
    } else if list.len() < MOST {
        list.push(found);
    }
}

/// A line of the source at the head of a message; nothing where the source has no lines, as a board.
pub(crate) struct SourceLine(pub u32);

impl fmt::Display for SourceLine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0 {
            0 => Ok(()),
            line => write!(f, "source line {line}: "),
        }
    }
}
