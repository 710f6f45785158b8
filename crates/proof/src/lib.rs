//! The proof: the motion an NC program makes, held against the program it came from.
//!
//! The text is run on the virtual control of its dialect; every pose goes through the machine's forward
//! kinematics into the work frame and is compared there with the source: tool tip, tool axis, arcs,
//! order, rapid or feed, feed, spindle, coolant, tool, compensation, dwell. The control's records are
//! compared as they come and not kept, so memory does not grow with the program.

mod arc;
mod expected;
mod gauge;
mod hole;
mod line;
mod place;
mod prover;
mod report;
mod state;
mod stops;
mod tolerance;

pub use prover::Prover;
pub use report::{Compared, Deviations, Excursion, Extent, Report, SideBySide, Summary, Worst};
pub use tolerance::{Applied, Tolerances};

use control::{Dialect, Settings};
use machine::Machine;
use program::{Diagnostic, Program};

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
    let mut prover = Prover::new(source, machine, tolerances);
    let run = match settings(machine) {
        Ok(settings) => {
            control::read(&settings, file_name, text, &mut |record| prover.record(&record))
        }
        Err(found) => Err(found),
    };
    if let Err(found) = run {
        prover.refused(*found);
    }
    let mut report = prover.finish();
    report.quote(file_name, text);
    report
}

/// What the virtual control has to know of `machine`.
fn settings(machine: &Machine) -> Result<Settings, Box<Diagnostic>> {
    let Some(dialect) = Dialect::named(&machine.reader) else {
        let message = format!("machine \"{}\" has no reader \"{}\"", machine.name, machine.reader);
        let names = Dialect::NAMES.map(|(name, _)| name).join(", ");
        return Err(Diagnostic::error("reader", message).help(format!("one of {names}")).into());
    };
    let mut rotary = [false; 3];
    for axis in &machine.rotary {
        rotary[axis.index()] = true;
    }
    Ok(Settings { dialect, rotary, auxiliary: machine.auxiliary.clone() })
}
