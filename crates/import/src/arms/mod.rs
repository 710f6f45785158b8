//! Descriptions of arms as machine files: URDF, and the calibration of an arm of Universal Robots.
//!
//! What a description does not say, the file does not say either: how the controller counts joint 3 is left open, and a reach
//! that nobody has stated is not written.

mod calibration;
mod geometry;
mod urdf;
mod write;

pub use calibration::import as import_calibration;

use crate::Import;
use program::{Diagnostic, Rule, encoding};

/// The largest description that is taken, bytes.
const LARGEST: usize = 4 << 20;

/// Angles that are as near to a right angle as this are one, radians.
const RIGHT: f64 = 1e-4;

/// What a reader gives.
type Read<T> = Result<T, Box<Diagnostic>>;

fn fail<T>(found: Diagnostic) -> Read<T> {
    Err(found.into())
}

/// Makes a machine file of the bytes of the URDF `file`. `reach` is what the maker states from axis 1 to the wrist centre, mm.
///
/// # Errors
/// What cannot be read, with its line; an arm that is none of the kinds that are known; one whose reach is not the stated one.
pub fn import_urdf(
    file: &str,
    bytes: &[u8],
    reach: Option<f64>,
) -> Result<Import, Vec<Diagnostic>> {
    let refused = |found: Box<Diagnostic>| vec![found.file(file)];
    let source = text(bytes).map_err(refused)?;
    let read = urdf::read(source).map_err(refused)?;
    let found = geometry::find(&read.chain).map_err(refused)?;
    if let Some(stated) = reach.filter(|stated| !found.arm.reaches(*stated)) {
        let made = found.arm.reach();
        let message =
            format!("the arm reaches {made:.1} mm to the wrist centre, and {stated} mm are stated");
        let help = "the description is that of another arm, or a wrong one: do not use it";
        return Err(vec![Diagnostic::error(Rule::ArmReach, message).help(help).file(file)]);
    }
    let mut findings: Vec<Diagnostic> = read.findings;
    findings.extend(write::open(&found.arm, reach));
    let findings = findings.into_iter().map(|finding| finding.file(file)).collect();
    Ok(Import {
        text: write::file(file, &read.name, &found.arm, reach),
        extends: String::new(),
        findings,
    })
}

/// The text of a description.
fn text(bytes: &[u8]) -> Read<&str> {
    if bytes.len() > LARGEST {
        let message = format!("{} bytes are more than any description of an arm has", bytes.len());
        return fail(
            Diagnostic::error(Rule::Import, message).help("leave meshes in files of their own"),
        );
    }
    encoding::utf_8(bytes)
}
