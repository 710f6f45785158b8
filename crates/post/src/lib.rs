//! The writer: a neutral program and a machine in, an NC program out.
//!
//! A control's blocks are templates; one that consists only of words is compiled once and runs without
//! the template engine, so that readability costs no speed. What the control lacks is lowered within a
//! stated tolerance and told in the warnings; what can be neither written nor lowered is refused.
//! Nothing here reads NC text: whether the program is right is the proof's to say.

use machine::Machine;
use program::{Diagnostic, Program};

/// A written program.
#[derive(Clone, Debug, Default)]
pub struct Output {
    /// The text, ready to be saved.
    pub text: Vec<u8>,
    /// Blocks (lines) written.
    pub blocks: usize,
    /// What was lowered or is worth knowing, with source lines.
    pub warnings: Vec<Diagnostic>,
}

/// Writes `program` for `machine`.
///
/// # Errors
/// Everything that keeps the program from being written, up to a fixed number of findings, each with
/// the source line it comes from.
pub fn write(program: &Program, machine: &Machine) -> Result<Output, Vec<Diagnostic>> {
    let _ = (program, machine);
    Err(vec![Diagnostic::error("unsupported", "nothing can be written yet")])
}
