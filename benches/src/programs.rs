//! NC programs of each control, run on its virtual control: plain blocks, and loops with expressions.
//! The floor is to read the numbers of the text and to print them back; the peer is LinuxCNC's `rs274`. It reads a file
//! and prints what it has run, so the virtual control is measured next to the whole command `toolpost show`, which reads the
//! same file.

use crate::clock::{Taken, time_children};
use crate::{Measured, fastest, floor, outside};
use control::{Dialect, Event, Settings, Setup};
use geom::Vec3;
use program::Diagnostic;
use std::fmt::Write;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Prints how fast programs with `blocks` blocks run on each virtual control.
///
/// # Errors
/// A program that a control refuses.
pub fn measure(blocks: usize, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    println!("NC programs of {blocks} blocks, run on their virtual controls");
    let columns = format!("{:>9}{:>8}{:>9}", "s", "M/s", "by hand");
    println!("{:28}{:>26}{:>26}", "", "processor time", "wall");
    println!("{:28}{columns}{columns}{:>9}", "", "bytes");
    for dialect in DIALECTS {
        let (name, plain, loops) = dialect.programs(blocks);
        for (what, text) in [("plain blocks", &plain), ("a loop", &loops)] {
            let ours = fastest(rounds, &mut || run(dialect.0, text))?;
            // A loop has few numbers to read.
            let by_hand = match what {
                "plain blocks" => Some(fastest(rounds, &mut || {
                    std::hint::black_box(floor::by_hand(text.as_bytes()));
                    Ok(())
                })?),
                _ => None,
            };
            row(&format!("{name}: {what}"), blocks, &ours, by_hand.as_ref());
            if dialect.0 == Dialect::LinuxCnc {
                compared(text, what, ours.time, rounds)?;
            }
        }
    }
    Ok(())
}

fn row(name: &str, blocks: usize, ours: &Measured, by_hand: Option<&Measured>) {
    let times = by_hand.map(|by_hand| ours.time.times(by_hand.time));
    let half = |time: Duration, times: Option<f64>| {
        let seconds = time.as_secs_f64();
        let times = times.map_or(String::from("-"), |times| format!("{times:.2}x"));
        format!("{seconds:9.3}{:8.2}{times:>9}", blocks as f64 / seconds / 1e6)
    };
    println!(
        "{name:28}{}{}{:9}",
        half(ours.time.processor, times.map(|times| times.processor)),
        half(ours.time.wall, times.map(|times| times.wall)),
        ours.peak,
    );
}

/// Prints what the whole command takes for the program, and the peer.
fn compared(text: &str, what: &str, ours: Taken, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let folder = tempfile::tempdir().map_err(|error| outside::failed(&error))?;
    let file = folder.path().join("program.ngc");
    fs::write(&file, text).map_err(|error| outside::failed(&error))?;
    let name = file.display().to_string();
    let whole =
        outside::command(&["show", &name, "--from", "linuxcnc", "--start", "0,0,0"], rounds)?;
    println!("  the whole command `toolpost show`: {whole}");
    match peer(folder.path(), rounds) {
        Some(peer) => println!(
            "  rs274, {what}: {peer}\n    divided by the virtual control: {}\n    divided by the whole command: {}",
            peer.times(ours),
            peer.times(whole),
        ),
        None => println!("  rs274 (Debian package linuxcnc-uspace) is not installed"),
    }
    Ok(())
}

/// A dialect with how its programs are framed, how a point is written, and a loop.
struct Language(Dialect, &'static str);

const DIALECTS: [Language; 4] = [
    Language(Dialect::LinuxCnc, "LinuxCNC"),
    Language(Dialect::Fanuc, "FANUC"),
    Language(Dialect::Sinumerik, "SINUMERIK"),
    Language(Dialect::Klartext, "Klartext"),
];

impl Language {
    /// Its name, a program of plain blocks, and one that comes to as many blocks by a loop with
    /// expressions: three blocks a turn.
    fn programs(&self, blocks: usize) -> (&'static str, String, String) {
        let mut plain = String::with_capacity(blocks * 36 + 200);
        let klartext = self.0 == Dialect::Klartext;
        plain.push_str(match self.0 {
            Dialect::Klartext => {
                "0 BEGIN PGM PLAIN MM\n1 TOOL CALL 1 Z S5000\n2 L X+0 Y+0 Z+5 R0 FMAX M3\n"
            }
            Dialect::Sinumerik => "G0 G17 G40 G90 G94 G54 X0 Y0 Z5\nF1000 S5000 M3\n",
            _ => "G21 G17 G40 G90 G94 G54\nS5000 M3\nG0 X0. Y0. Z5.\nF1000.\n",
        });
        for i in 0..blocks {
            let t = i as f64 * 0.01;
            let (x, y, z) = (50.0 * t.cos(), 40.0 * (1.3 * t).sin(), -2.0 - t.sin());
            // Writing to a string does not fail.
            let _ = match klartext {
                true => writeln!(plain, "{} L X{x:+.3} Y{y:+.3} Z{z:+.3} F1000", i + 3),
                false => writeln!(plain, "G1 X{x:.3} Y{y:.3} Z{z:.3}"),
            };
        }
        let turns = blocks / 3;
        let loops = match self.0 {
            Dialect::LinuxCnc => format!(
                "G21 G90 G54 G0 X0 Y0 Z5\nF1000\n#1=0\no100 while [#1 LT {turns}]\n#1=[#1+1]\n\
                 G1 X[50*cos[#1*0.5]] Y[40*sin[#1*0.7]] Z[-2-#1/{turns}]\no100 endwhile\nM2\n"
            ),
            Dialect::Sinumerik => format!(
                "G0 G90 G54 X0 Y0 Z5\nF1000\nR1=0\nWHILE R1<{turns}\nR1=R1+1\n\
                 G1 X=50*COS(R1*0.5) Y=40*SIN(R1*0.7) Z=-2-R1/{turns}\nENDWHILE\nM30\n"
            ),
            Dialect::Klartext => format!(
                "0 BEGIN PGM LOOP MM\n1 L X+0 Y+0 Z+5 R0 FMAX\n2 FN 0: Q1 = +0\n3 LBL 1\n\
                 4 Q1 = Q1 + 1\n5 Q2 = 50 * COS ( Q1 * 0.5 )\n6 L X+Q2 Y+Q1 F1000\n\
                 7 FN 12: IF +Q1 LT +{} GOTO LBL 1\n8 M30\n9 END PGM LOOP MM\n",
                blocks / 5
            ),
            _ => format!(
                "G21 G90 G54 G0 X0. Y0. Z5.\nF1000.\n#1=0\nWHILE [#1 LT {turns}] DO1\n#1=#1+1\n\
                 G1 X[50*COS[#1*0.5]] Y[40*SIN[#1*0.7]] Z[-2-#1/{turns}]\nEND1\nM30\n"
            ),
        };
        plain.push_str(&match self.0 {
            Dialect::Klartext => format!("{} M30\n{} END PGM PLAIN MM\n", blocks + 3, blocks + 4),
            Dialect::LinuxCnc => String::from("M2\n"),
            _ => String::from("M30\n"),
        });
        (self.1, plain, loops)
    }
}

/// The program of plain blocks for LinuxCNC.
pub fn plain(blocks: usize) -> String {
    DIALECTS[0].programs(blocks).1
}

/// Runs a program, from where all of its offsets are 0.
pub fn run(dialect: Dialect, text: &str) -> Result<(), Vec<Diagnostic>> {
    let setup = Setup { start: Some(Vec3::ZERO), ..Setup::default() };
    let settings = Settings { setup, ..Settings::new(dialect, [false; 3]) };
    let mut keep = |event: Event| {
        std::hint::black_box(event);
        Ok(())
    };
    control::read(&settings, "program", text.as_bytes(), &mut keep).map_err(|found| vec![*found])
}

/// What `rs274` takes for `program.ngc` in `folder`, from start to end: the fastest round by wall. `None` where it is
/// not installed.
fn peer(folder: &Path, rounds: usize) -> Option<Taken> {
    let path = |name: &str| folder.join(name);
    fs::write(path("tool.tbl"), "T1 P1 Z0 D6\n").ok()?;
    let mut best: Option<Taken> = None;
    for _ in 0..rounds.max(1) {
        fs::write(path("rs274.var"), "").ok()?;
        let mut command = Command::new("rs274");
        command
            .args(["-t", "tool.tbl", "-v", "rs274.var", "-g", "program.ngc"])
            .current_dir(folder)
            .env("HOME", folder)
            .stdout(File::create(path("out.txt")).ok()?)
            .stderr(Stdio::null());
        let (status, taken) = time_children(|| command.status());
        status.ok().filter(|status| status.success())?;
        best = Some(best.map_or(taken, |best| best.faster(taken)));
    }
    best
}
