//! The proof: the motion that an NC program makes, compared with the program from which it came.
//!
//! The text is run on the virtual control of its dialect; every pose goes through the machine's forward
//! kinematics into the work frame and is compared there with the source: tool tip, tool axis, arcs,
//! order, rapid or feed, feed, spindle, coolant, tool, compensation, dwell. The control's events are
//! compared as they come and not kept, but for the contours of a program with compensation: a second run calculates them with the
//! tools of the source. A coordinate that no
//! block has set is not equal to anything.
//!
//! ```
//! use program::{Builder, Feed, Spindle, Tool};
//! use toolpost_proof::{Tolerances, prove};
//!
//! let mut slot = Builder::new("slot");
//! slot.tool(Tool { number: 1, ..Tool::default() })?;
//! slot.spindle(Spindle::Clockwise(5000.0))?;
//! slot.rapid([0.0, 0.0, 5.0], None)?;
//! slot.feed(Feed::PerMinute(300.0))?;
//! slot.line([0.0, 0.0, -1.0], None)?;
//! slot.rapid([0.0, 0.0, 5.0], None)?;
//! let (source, machine) = (slot.build(), machine::load("generic-3axis-linuxcnc")?);
//! let proven = |depth: &str| {
//!     let text = format!(
//!         "G21 G17 G40 G49 G80 G90 G91.1 G94 G54\nG64 P0.005 Q0.005\nG53 G0 Z0\nT1 M6\nS5000 M3\nG43 H1\nG0 X0 Y0\nZ5\nG1 Z{depth} F300\nG0 Z5\nM5\n\
//!          G53 G0 Z0\nM2\n"
//!     );
//!     prove(&source, &machine, "slot.ngc", text.as_bytes(), &Tolerances::default())
//! };
//! assert!(proven("-1").proven, "{:?}", proven("-1").mismatches);
//! // A tenth too deep: the finding names block and source line.
//! assert!(!proven("-1.1").proven);
//! # Ok::<(), Box<program::Diagnostic>>(())
//! ```
//!
//! Lengths are mm, angles of tolerances degrees. It never reads templates and never writes a program.
//!
//! # What is accepted
//!
//! 1. **Every motion of the source, in its order.** Each ends with the tool tip and the tool axis within
//!    the tolerances of the report ([`Applied`]). Only a motion that is shorter than a step of the
//!    machine may be missing.
//! 2. **A rapid for a rapid.** It may stop where each coordinate of the block is as before
//!    or as after (axis by axis), or on the tool axis above either end. As the control really goes it stays on
//!    the straight line of the source, or beyond all that the source cuts.
//! 3. **A line**: one block or several at feed, all on the line, no block backwards. While rotary axes turn,
//!    the path between the ends is sampled through the kinematics.
//! 4. **Arcs for an arc**, in its plane and direction, points between the ends compared; or chords
//!    within the machine's lowering tolerance.
//! 5. **Excursions**: from any point of a cut away along the tool axis by rapid (or Z home), axis by
//!    axis where it must, and back along the tool axis to the same point. Each is reported. Otherwise
//!    home positions are for the start, tool changes, new set-ups by rapid, and the end, Z first.
//! 6. **A hole** by a canned cycle (bottom, R plane, retract level, kind, pecks, dwell, pitch), or by
//!    the moves that make it. The tool goes down only over it. A thread only by a cycle. A thread in step
//!    with the spindle, or a probing move, by one block that makes the same.
//! 7. **In every cut**: feed, spindle, coolant, tool, length offset, work offset, compensation.
//!    Compensation switches with the first straight cut in the plane at the latest, off with the first
//!    straight move there, and never on an arc. A tool change stops spindle and coolant.
//! 8. **Dwells and stops** between the same motions; where the source has stopped the spindle, it
//!    stands at the stop.
//! 9. **An end**, and before it, after the last motion, only moves away from the part.
//!
//! A program that finds the surface itself is run on three surfaces, and compared with the source raised
//! to each.
//!
//! The rules in full, with what each keeps out, are in `docs/proof.md`.

#![deny(clippy::wildcard_enum_match_arm)]

mod accepted;
mod arc;
mod arm;
mod compensation;
mod expected;
mod gauge;
mod hole;
mod line;
mod machine_pose;
mod observer;
mod pace;
mod prover;
mod report;
mod resolved_pose;
mod speeds;
mod state;
mod stops;
mod surfaces;
mod tilt;
mod tolerance;
mod travel;

pub use accepted::{ACCEPTABLE, Accepted};
pub use observer::{
    AxisPositions, Course, Deviation, MachineState, Motion, MotionKind, Observer, SpindleState,
    ToolPose,
};
pub use prover::Prover;
pub use report::{
    ArmChecked, Compared, Deviations, Excursion, Extent, Report, SideBySide, Summary,
    TravelChecked, Worst,
};
pub use state::same_tool;
pub use tolerance::{Applied, Tolerances};

use compensation::resolved;
use control::{Folders, Setup};
use machine::Machine;
use observer::{EVENTS_AT_ONCE, Mark, Silent};
use program::{Diagnostic, Program, Rule};
use surfaces::MappedSurface;

/// Runs `text` on the virtual control of `machine` and holds it against `source`.
///
/// A block that the control does not understand is a mismatch, like any other difference.
pub fn prove(
    source: &Program,
    machine: &Machine,
    file_name: &str,
    text: &[u8],
    tolerances: &Tolerances,
) -> Report {
    prove_for(source, machine, file_name, text, tolerances, &mut ())
}

/// The same for an observer, who is asked whether the proof goes on. A proof that ends before its end is not proven: its mismatch has the rule
/// `cancelled`.
pub fn prove_for(
    source: &Program,
    machine: &Machine,
    file_name: &str,
    text: &[u8],
    tolerances: &Tolerances,
    observer: &mut dyn Observer,
) -> Report {
    let alone = Folders::default();
    prove_files(source, machine, (file_name, text, &alone), tolerances, observer)
}

/// The same of a program that may call those of `folders`.
pub fn prove_files(
    source: &Program,
    machine: &Machine,
    (file_name, text, folders): (&str, &[u8], &Folders),
    tolerances: &Tolerances,
    observer: &mut dyn Observer,
) -> Report {
    let report = compare(source, machine, (file_name, text, folders), tolerances, observer);
    observer.ended(&report);
    report
}

fn compare(
    source: &Program,
    machine: &Machine,
    (file_name, text, folders): (&str, &[u8], &Folders),
    tolerances: &Tolerances,
    observer: &mut dyn Observer,
) -> Report {
    if let (Some(arm), Some(cell)) = (&machine.arm, &machine.cell) {
        let robot = (machine, arm, cell);
        return arm::prove(source, robot, (file_name, text, folders), tolerances, observer);
    }
    if let Some(found) = compensation::unsettled(source, machine) {
        return refused(source, machine, tolerances, found);
    }
    let run = |source: &Program, setup: Setup, observer: &mut dyn Observer| {
        let program = (file_name, text);
        let report = prove_on(source, machine, setup.clone(), program, tolerances, observer);
        if !report.proven {
            return report;
        }
        let mut optional = control::optional_blocks(text);
        let Some((_, level)) = optional.next() else { return report };
        if let Some((line, other)) = optional.find(|(_, other)| *other != level) {
            let message = format!(
                "blocks behind /{level} and /{other} are switched apart: not each position is proven"
            );
            let found =
                Diagnostic::error(Rule::BlockSkip, message).help("use one of them").line(line);
            return refused(source, machine, tolerances, found);
        }
        // The operator may have switched the blocks behind `/` off.
        let setup = Setup { block_delete: true, ..setup };
        let mut without =
            prove_on(source, machine, setup, program, tolerances, &mut Silent(observer));
        for found in &mut without.mismatches {
            found.message = format!("without the blocks behind `/`: {}", found.message);
        }
        if without.proven { report } else { without }
    };
    let setup = Setup { folders: folders.clone(), ..Setup::default() };
    let Some(surface) = surfaces::found(source) else {
        return run(source, setup, observer);
    };
    let trials = match surfaces::trials(surface) {
        Ok(trials) => trials,
        Err(found) => return refused(source, machine, tolerances, *found),
    };
    let mut proven: Option<Report> = None;
    for MappedSurface { places, heights } in trials {
        let setup = Setup { surface: places, ..setup.clone() };
        let report = match heights.raise(source) {
            Ok(raised) if proven.is_none() => run(&raised, setup, observer),
            Ok(raised) => run(&raised, setup, &mut Silent(observer)),
            Err(found) => return refused(source, machine, tolerances, *found),
        };
        match &mut proven {
            _ if !report.proven => return report,
            Some(proven) => proven.deviations.widen(&report.deviations),
            None => proven = Some(report),
        }
    }
    proven.unwrap_or_default()
}

/// The report of a proof that cannot begin.
fn refused(
    source: &Program,
    machine: &Machine,
    tolerances: &Tolerances,
    found: Diagnostic,
) -> Report {
    let mut prover = Prover::new(source, machine, tolerances);
    prover.refused(found);
    prover.finish()
}

/// The proof of a program on a control with this set-up.
fn prove_on(
    source: &Program,
    machine: &Machine,
    setup: Setup,
    (file_name, text): (&str, &[u8]),
    tolerances: &Tolerances,
    observer: &mut dyn Observer,
) -> Report {
    let mut prover = Prover::new(source, machine, tolerances);
    let wants_motions = observer.wants_motions();
    if wants_motions {
        prover.tell_motions();
    }
    let resolved = compensation::is_resolved(source, machine);
    if resolved == Ok(true) {
        prover.keep_trail();
    }
    let mut mark = Mark::default();
    let run = nc::settings(machine, setup.clone()).and_then(|settings| {
        observer::run(
            &settings,
            (file_name, text),
            (observer, EVENTS_AT_ONCE),
            |event, observer| {
                let outcome = prover.event_for(event, observer);
                if wants_motions {
                    mark.tell(prover.mismatches(), observer);
                }
                outcome
            },
        )
    });
    if let Err(found) = run {
        prover.refused(*found);
    }
    let (gauge, stretches) = prover.stretches();
    let mut report = prover.finish();
    if report.proven {
        match resolved {
            Ok(_) if stretches.is_empty() => {}
            Ok(_) => {
                let program = (file_name, text);
                resolved::compare(source, setup, program, gauge, &stretches, &mut report);
                report.proven = report.mismatches.is_empty();
            }
            Err(found) => report.warn(*found),
        }
    }
    report.quote(file_name, text);
    if wants_motions {
        mark.tell(&report.mismatches, observer);
    }
    report
}
