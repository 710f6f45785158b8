//! Pictures, as SVG or PNG: of a tool path, of the arm that leads it, of the path of a wire, of a board, of points in glass.
//!
//! The crate promises the same bytes for the same input on every machine (letters are drawn as lines, there are no fonts in
//! them), of bounded size, however long the program.
//!
//! Coordinates are mm of the work frame, in a stated view; sizes of pictures are pixels. All pictures are drawn from straight
//! pieces ([`walk()`] makes them of a program).
//!
//! ```
//! use program::{Op, Pose, Program};
//! use toolpost_drawing::walk;
//!
//! # fn main() -> Result<(), program::NoPose> {
//! let mut program = Program::new("slot");
//! for (x, z) in [(0.0, 5.0), (0.0, -1.0), (10.0, -1.0)] {
//!     let pose = Pose::upright(geom::Vec3::new(x, 0.0, z))?;
//!     program.push(1, if z > 0.0 { Op::Rapid(pose) } else { Op::Line(pose) });
//! }
//! let mut cuts = 0;
//! walk(&program, 0.01, &mut |segment| cuts += usize::from(segment.cuts));
//! assert_eq!(cuts, 2, "down, and along");
//! # Ok(())
//! # }
//! ```
//!
//! It never checks what it draws: a picture is no proof.

#![deny(clippy::wildcard_enum_match_arm)]

mod arm_path;
mod board;
mod chart;
mod glass;
mod lettering;
mod paper;
mod reach;
mod tool_path;
mod trace;
mod view;
mod walk;
mod wire_path;

pub use arm_path::{ArmPicture, ArmSample, arm_path};
pub use board::{
    Area, AreaKind, BoardAreas, BoardPicture, BoardSheet, BoardSide, MOST_AREAS, Trapezoid, board,
    board_sheet,
};
pub use chart::{Chart, Curve, charts};
pub use glass::{GlassPicture, GlassView, glass};
pub use reach::{ReachPicture, reach};
pub use tool_path::tool_path;
pub use walk::{Segment, walk};
pub use wire_path::{WirePicture, WireSegment, wire_path};

use program::{Diagnostic, Rule};
use std::path::Path;

/// How a picture is saved.
#[derive(Clone, Copy, Debug)]
pub enum Format {
    /// As it was drawn.
    Svg,
    /// Painted, at twice its size.
    Png,
}

impl Format {
    /// The format that the name of a file asks for.
    ///
    /// # Errors
    /// Where it asks for another.
    pub fn of(file: &Path) -> Result<Format, Box<Diagnostic>> {
        let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            "png" => Ok(Format::Png),
            "svg" => Ok(Format::Svg),
            _ => Err(Diagnostic::error(Rule::Drawing, format!("cannot draw {}", file.display()))
                .help("a drawing is a .svg or a .png")
                .into()),
        }
    }

    /// The bytes of a picture that was drawn as SVG.
    ///
    /// # Errors
    /// Where it is too large for the memory.
    pub fn bytes(self, svg: String) -> Result<Vec<u8>, Box<Diagnostic>> {
        match self {
            Format::Svg => Ok(svg.into_bytes()),
            Format::Png => paper::png(&svg),
        }
    }
}
