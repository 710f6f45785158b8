//! A board that is small enough to be worked out by hand.
//!
//! ```text
//!   10 ┌────────────────────┐     front: pads of 2 mm at 4,5 and 14,5, a hole of 0.8 mm in each
//!    5 │   (o)       (o)    │     back: pads of 1 mm at 4,3 and 14,8
//!    0 └────────────────────┘
//!      0   4         14    20
//! ```

use crate::folder::{Folder, Said};
use app::Origin;
use drawing::Segment;
use geom::Vec2;
use program::Program;
use serde_json::Value;
use std::f64::consts::TAU;

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

/// A board that was made: programs that are read back by the virtual control.
pub struct Made<'a> {
    pub folder: &'a Folder,
    machine: &'a str,
    pub said: Said,
}

impl<'a> Made<'a> {
    /// Makes `board` with these arguments and no pictures, in the folder `out`.
    #[track_caller]
    pub fn of(folder: &'a Folder, board: &str, machine: &'a str, more: &[&str]) -> Made<'a> {
        let call = ["pcb", board, "-o", "out", "-m", machine, "--picture", "none"];
        let said = folder.run(&[&call, more].concat());
        assert_eq!(said.code, 0, "{said:?}");
        Made { folder, machine, said }
    }

    /// The report next to the programs.
    pub fn report(&self) -> Value {
        serde_json::from_str(&self.folder.read("out/report.json")).unwrap()
    }

    /// What the report says of the program of a part.
    pub fn report_of(&self, part: &str) -> Value {
        let report = self.report();
        let programs = report["programs"].as_array().unwrap();
        programs.iter().find(|program| program["name"] == part).unwrap().clone()
    }

    /// What its tools do, one after the other.
    pub fn operations(&self, part: &str) -> Vec<String> {
        let reported = self.report_of(part);
        let names = reported["operations"].as_array().unwrap().iter();
        names.map(|name| name.as_str().unwrap().to_owned()).collect()
    }

    /// The file of a program, named as its control wants it.
    fn file(&self, part: &str) -> String {
        format!("out/{part}.{}", machine::load(self.machine).unwrap().extension)
    }

    /// The text of a program.
    pub fn text(&self, part: &str) -> String {
        self.folder.read(&self.file(part))
    }

    /// The program of a part, as the control reads it.
    pub fn program(&self, part: &str) -> Program {
        let file = self.folder.path().join(self.file(part));
        let origin = Origin { from: Some(self.machine.to_owned()), ..Origin::default() };
        app::toolpath::read(&file.as_path().into(), false, &origin, None, program::Purpose::Program)
            .unwrap()
            .program
    }

    /// What is cut with the tip below Z 0, straight down or along.
    fn below(&self, part: &str, down: bool) -> Vec<Segment> {
        let mut below = Vec::new();
        drawing::walk(&self.program(part), 1e-4, &mut |segment| {
            let is_down = segment.from.truncate().distance(segment.to.truncate()) < 1e-6;
            if segment.cuts && segment.from.z.min(segment.to.z) < 0.0 && is_down == down {
                below.push(segment);
            }
        });
        assert!(!below.is_empty(), "nothing is cut in {part}");
        below
    }

    /// What is cut along the board.
    pub fn cuts(&self, part: &str) -> Vec<Segment> {
        self.below(part, false)
    }

    /// How far is cut along the board, mm.
    pub fn length(&self, part: &str) -> f64 {
        self.cuts(part).iter().map(|cut| cut.length).sum()
    }

    /// Where a tool goes straight down, and how far: rounded to thousandths, sorted.
    pub fn holes(&self, part: &str) -> Vec<[f64; 3]> {
        let thousandth = |at: f64| (at * 1e3).round() / 1e3 + 0.0;
        let place = |cut: Segment| cut.to.to_array().map(thousandth);
        let mut holes: Vec<_> = self.below(part, true).into_iter().map(place).collect();
        holes.sort_by(|a, b| a.partial_cmp(b).unwrap());
        holes
    }

    /// Everything that is cut goes around one of `places`, mm, at this distance and depth.
    #[track_caller]
    pub fn circles(&self, part: &str, places: &[[f64; 2]], radius: f64, depth: f64) {
        for cut in self.cuts(part) {
            for end in [cut.from, cut.to] {
                let off = |place: &[f64; 2]| Vec2::from(*place).distance(end.truncate());
                let nearest = places.iter().map(off).fold(f64::INFINITY, f64::min);
                assert!((nearest - radius).abs() < NEAR, "{part}: {end}, {nearest} mm");
                assert!((end.z + depth).abs() < 1e-6, "{part}: {end}");
            }
        }
        let whole = places.len() as f64 * TAU * radius;
        let length = self.length(part);
        assert!((length / whole - 1.0).abs() < 1e-3, "{part}: {length} mm, not {whole} mm");
    }
}

/// How far a cut may be from where it should be, mm.
pub const NEAR: f64 = 0.005;
