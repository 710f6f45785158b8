//! HEIDENHAIN Klartext (TNC 640, iTNC 530).
//!
//! A program is a list of numbered blocks between `BEGIN PGM` and `END PGM`; a line that ends in `~`
//! goes on in the next one. What a block means, in which order its parts act, and where that is
//! written is told in `docs/controls/klartext.md`.

mod approach;
mod calls;
mod contour;
mod cycle;
mod formula;
mod functions;
mod helix;
mod hole;
mod layout;
mod motion;
mod older;
mod pattern;
mod plane;
mod registers;
mod run;
mod scan;
mod source;
mod state;
mod tool;
mod transform;
mod words;

use crate::Settings;
use crate::compensation::Compensator;
use run::Run;
use scan::Result;
use state::Control;

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], compensator: &mut Compensator) -> Result<()> {
    let mut control = Control::new(settings, compensator);
    Run::begin(&mut control, "", text)?.finish()
}
