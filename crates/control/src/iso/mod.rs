//! ISO code: FANUC, LinuxCNC (RS-274) and GRBL.

use crate::{Settings, Sink};
use program::Diagnostic;

/// Runs a program.
pub(crate) fn run(_: &Settings, _: &[u8], _: &mut Sink) -> Result<(), Box<Diagnostic>> {
    Err(Diagnostic::error("unsupported", "this dialect cannot be read yet").into())
}
