//! A board that is small enough to be worked out by hand.
//!
//! ```text
//!   10 ┌────────────────────┐     front: pads of 2 mm at 4,5 and 14,5, a hole of 0.8 mm in each
//!    5 │   (o)       (o)    │     back: pads of 1 mm at 4,3 and 14,8
//!    0 └────────────────────┘
//!      0   4         14    20
//! ```

use crate::folder::{Folder, Said};

/// What isolates it, on a machine that has room for it.
pub const CALL: [&str; 8] = ["pcb", "board", "-o", "out", "-m", "grbl-3018", "--tool", "0.4"];

/// Two pads on the front.
pub const FRONT: &str = "D10*\nX4000Y5000D03*\nX14000Y5000D03*\n";

/// The edge.
pub const EDGE: &str = "D11*\nX0Y0D02*\nX20000D01*\nY10000D01*\nX0D01*\nY0D01*\n";

/// A drill file with two holes.
pub const DRILL: &str = "M48\nMETRIC\nT1C0.8\n%\nT1\nX4.0Y5.0\nX14.0Y5.0\nM30\n";

/// A Gerber file in mm with three decimals, whose first body line is its eighth.
pub fn gerber(function: &str, body: &str) -> String {
    format!(
        "%TF.FileFunction,{function}*%\n%FSLAX33Y33*%\n%MOMM*%\n%ADD10C,2*%\n%ADD11C,1*%\n\
         %ADD12R,2X2*%\nG01*\n{body}M02*\n"
    )
}

/// A folder with the files of the board in `board`.
pub fn small() -> Folder {
    let folder = Folder::empty();
    std::fs::create_dir(folder.path().join("board")).unwrap();
    front(&folder, FRONT);
    folder.write(
        "board/back.gbr",
        gerber("Copper,L2,Bot", "D11*\nX4000Y3000D03*\nX14000Y8000D03*\n"),
    );
    edge(&folder, EDGE);
    folder.write("board/holes.drl", DRILL);
    folder
}

/// Another front for it.
pub fn front(folder: &Folder, body: &str) {
    folder.write("board/front.gbr", gerber("Copper,L1,Top", body));
}

/// Another edge for it.
pub fn edge(folder: &Folder, body: &str) {
    folder.write("board/edge.gbr", gerber("Profile,NP", body));
}

/// Calls `toolpost` with [`CALL`] and more.
pub fn call(folder: &Folder, more: &[&str]) -> Said {
    folder.run(&[&CALL, more].concat())
}

/// Refused with this code and in these words, and a way out for each error; nothing is written.
#[track_caller]
pub fn refused(folder: &Folder, arguments: &[&str], code: i32, words: &[&str]) -> Said {
    let before = folder.names();
    let said = folder.run(arguments);
    assert_eq!(said.code, code, "{said:?}");
    for word in words {
        assert!(said.err.contains(word), "`{word}` is missing in\n{}", said.err);
    }
    let ways_out = said.err.matches("\n    = ").count();
    assert!(ways_out >= said.err.matches("error[").count(), "{}", said.err);
    assert_eq!(folder.names(), before);
    said
}
