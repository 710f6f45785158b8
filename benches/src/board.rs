//! Real boards, from their files to proven programs: time, memory, blocks and paths, compared with their marks, and a
//! panel of sixteen boards compared with one.

use crate::clock::{self, Taken};
use crate::memory;
use program::{Diagnostic, Rule};
use serde_json::Value;
use std::path::Path;

/// Width of the tool, mm: that of the settings by which pcb2gcode is run on the large board (twice its
/// `offset`).
const TOOL: &str = "0.002";

/// Height of rapid moves, from which the tool feeds too, mm: `zsafe` of these settings.
const SAFE: &str = "0.08";

/// What boards take elsewhere, on two cores, and what we ask of ourselves: wall.
const MARKS: [(&str, &str); 2] = [
    (
        "a64",
        "pcb2gcode: 67 to 80 s of wall, 378 MB, 147590 lines; mark: 1.5 s of wall, 300 MB, 36897 blocks, 6.1 m of rapids on the back",
    ),
    ("pic_programmer", "mark: 0.15 s of wall"),
];

/// Prints what each board takes, with one pass around the copper of both sides, and the outline.
///
/// # Errors
/// Where a board is refused.
pub fn measure(boards: &[impl AsRef<Path>], rounds: usize) -> Result<(), Vec<Diagnostic>> {
    for board in boards {
        let board = board.as_ref();
        let one = fastest(board, &[], rounds)?;
        println!("{}: {}", board.display(), one.described());
        let name = board.file_name().unwrap_or_default();
        for (_, mark) in MARKS.iter().filter(|(of, _)| name == *of) {
            println!("  {mark}");
        }
        let panel = fastest(board, &["--panel", "4x4"], 1)?;
        println!(
            "  a panel of 16: {}\n    divided by one board: {}",
            panel.described(),
            panel.time.times(one.time)
        );
    }
    Ok(())
}

/// What a board took.
struct Made {
    time: Taken,
    /// The most bytes in use at once.
    peak: usize,
    blocks: u64,
    /// Length of the cuts and of the rapids, mm.
    cutting: f64,
    rapid: f64,
}

impl Made {
    fn described(&self) -> String {
        format!(
            "{}, {} MB, {} blocks, cuts {:.2} m, rapid {:.2} m",
            self.time,
            self.peak / 1_000_000,
            self.blocks,
            self.cutting / 1e3,
            self.rapid / 1e3,
        )
    }
}

/// The fastest of some rounds by wall.
fn fastest(board: &Path, more: &[&str], rounds: usize) -> Result<Made, Vec<Diagnostic>> {
    let folder = std::env::temp_dir().join(format!("toolpost-bench-{}", std::process::id()));
    let output = folder.display().to_string();
    let source = board.display().to_string();
    let mut words = vec!["toolpost", "--quiet", "pcb", &source, "-m", "generic-3axis-linuxcnc"];
    words.extend(["--tool", TOOL, "--depth", "0.04", "-o", &output]);
    words.extend(["--travel", SAFE, "--approach", SAFE]);
    words.extend(more);
    let mut best: Option<Made> = None;
    for _ in 0..rounds.max(1) {
        let ((code, peak), time) =
            clock::time(|| memory::peak(|| toolpost::run(words.iter().map(Into::into), None)));
        let report = std::fs::read(folder.join("report.json")).unwrap_or_default();
        let _ = std::fs::remove_dir_all(&folder);
        let report: Value = serde_json::from_slice(&report).unwrap_or_default();
        let programs = report["programs"].as_array().filter(|_| code == 0).ok_or_else(|| {
            vec![Diagnostic::error(
                Rule::Internal,
                format!("{source} is refused: exit code {code}"),
            )]
        })?;
        let sum = |of: &dyn Fn(&Value) -> Option<f64>| programs.iter().filter_map(of).sum::<f64>();
        let measure = |program: &Value, what: &str| program["source"]["measures"][what].as_f64();
        let made = Made {
            time,
            peak,
            blocks: sum(&|program| program["program"]["blocks"].as_f64()) as u64,
            cutting: sum(&|program| measure(program, "cutting_length")),
            rapid: sum(&|program| measure(program, "rapid_length")),
        };
        if best.as_ref().is_none_or(|best| made.time.wall < best.time.wall) {
            best = Some(made);
        }
    }
    best.ok_or_else(Vec::new)
}
