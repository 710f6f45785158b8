//! The proof of programs for arms: what the control does, through the forward kinematics, compared with the source.
//!
//! Joints of a `PTP` say where the tool is; along lines and arcs the joints are followed from there step by step, by Newton's method on the
//! forward kinematics alone ([`follow`]): the closed form by which the writer finds joints is not used here.
//!
//! # What is accepted
//!
//! 1. Each motion of the source in its order, with tip and axis within the tolerances: a line by lines on it, an arc by arcs through points
//!    of it or by chords, a rapid by a straight line or by the joints.
//! 2. Along each line and arc: one posture, every joint within its limits and within its speed at the feed.
//! 3. A motion of the joints only where the tool is free of the part on the whole path (beyond all cuts along its own axis, not below where a feed begins, and
//!    on a rapid into the part or out of it not below its higher end), or within `rapid_corridor` of the straight line of the source.
//! 4. Corners that are passed within a cut, by no more than `path_tolerance`.
//! 5. In every cut feed, spindle, coolant; base and tool as the cell states them.
//! 6. Home by joints at the beginning, at tool changes, and at the end; spindle and coolant are off at tool changes and at the end, and may
//!    be on on the way home.
//! 7. Joints and straight rapids no faster than the cell states; no half turns of the tool, and no turn that a cut's feed has no time for.
//!
//! 8. Other files only where the tool is in no cut, and all of them in the order of the source; a motion of the joints to where they
//!    stand, with which each of them may begin.
//!
//! It knows nothing of the arm itself, the cell and the load: the summary says so.

mod comparison;
mod expected;
mod follow;

use crate::observer::{self, MOTIONS_AT_ONCE, Observer};
use crate::report::Report;
use crate::tolerance::{Applied, Tolerances};
use ::arm::Arm;
use comparison::Comparison;
use control::{Dialect, Folders, Setup};
use expected::Expected;
use machine::{Cell, Machine};
use program::{Diagnostic, Op, Program, Rule};
use std::collections::{BTreeMap, HashMap};

/// A tool that is called with two lengths: as the source states it, or as the cell does where it states none. The operator puts the
/// same tool into the spindle each time.
fn lengths_of_one_tool(source: &Program, cell: &Cell) -> Option<Diagnostic> {
    let mut lengths: HashMap<u32, Option<f64>> = HashMap::new();
    for record in &source.records {
        let Op::Tool(tool) = &record.op else { continue };
        let length = tool.length.or(cell.tool_length);
        if *lengths.entry(tool.number).or_insert(length) != length {
            let message = format!(
                "line {} calls tool {} with another length than before",
                record.line, tool.number
            );
            let help =
                "the same LENGTH in each call of this tool, or another number for another tool";
            return Some(Diagnostic::error(Rule::ToolTwice, message).help(help).line(record.line));
        }
    }
    None
}

/// Runs `text` on the virtual control of the robot and compares it with `source`, while `observer` says so.
pub(crate) fn prove(
    source: &Program,
    (machine, arm, cell): (&Machine, &Arm, &Cell),
    (file_name, text, folders): (&str, &[u8], &Folders),
    tolerances: &Tolerances,
    observer: &mut dyn Observer,
) -> Report {
    let mut applied = Applied::new(machine, tolerances);
    applied.tip_mm += single_precision(source, machine);
    let mut report = Report { tolerances: applied, ..Report::default() };
    if let Some(found) = crate::compensation::unsettled_for_arm(source) {
        report.mismatch(source.compensates().unwrap_or_default(), found);
        return report;
    }
    if let Some(found) = lengths_of_one_tool(source, cell) {
        report.mismatch(found.line, Diagnostic { line: 0, ..found });
        return report;
    }
    let expected = match Expected::of(source, machine) {
        Ok(expected) => expected,
        Err(found) => {
            report.mismatch(found.line, Diagnostic { line: 0, ..*found });
            return report;
        }
    };
    let mut comparison = Comparison::new(source, (machine, arm, cell), expected, report);
    let wants_motions = observer.wants_motions();
    if wants_motions {
        comparison.keep_motions();
    }
    let setup = Setup { folders: folders.clone(), ..Setup::default() };
    let run = nc::settings(machine, setup).and_then(|settings| {
        observer::run(
            &settings,
            (file_name, text),
            (observer, MOTIONS_AT_ONCE),
            |event, observer| {
                let outcome = comparison.event(event);
                if wants_motions {
                    comparison.tell_motions(observer);
                }
                outcome
            },
        )
    });
    let (mut report, called) = comparison.finish(run);
    // A file that is not understood has not been gone through.
    let refused = report.mismatches.iter().map(|found| found.file.clone());
    let called = called.into_iter().map(String::from).chain(refused);
    let called: BTreeMap<String, Vec<u8>> = called
        .filter(|name| !name.is_empty() && name != file_name)
        .filter_map(|name| folders.open(&name).ok().map(|text| (name, text)))
        .collect();
    report.quote_files((file_name, text), &called);
    // The first mismatch ends the run.
    if let (true, [first, ..]) = (wants_motions, &report.mismatches[..]) {
        observer.mismatched(first);
    }
    report
}

/// How far a control of single precision puts a tip from where its words do, mm: half a step of 24 bits on each axis.
fn single_precision(source: &Program, machine: &Machine) -> f64 {
    if !Dialect::named(&machine.reader).is_some_and(Dialect::is_single_precision) {
        return 0.0;
    }
    let poses = source.records.iter().filter_map(|record| record.op.pose());
    let largest = poses.map(|pose| pose.point().abs().max_element()).fold(0.0, f64::max);
    3f64.sqrt() * largest * 2f64.powi(-24)
}
