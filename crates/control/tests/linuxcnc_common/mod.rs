//! LinuxCNC's own interpreter beside ours: what `rs274 -g` makes of a program, what we make of it, and
//! where the two differ.

use geom::{Frame, Mat3, Vec3};
use program::{Op, Orientation, Pose};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};
use toolpost_control::{Dialect, Settings, Setup, ToolData, read};

/// The longest that either side may take over a program.
const LONGEST: Duration = Duration::from_secs(10);

/// The tools of the table: 6 mm in diameter and as many mm long as their number.
const TOOLS: std::ops::RangeInclusive<u32> = 1..=99;

/// What `rs274` says of a file without `M2` and `%`.
const NO_END: &str = "File ended with no percent sign or program end";

/// A move as the machine makes it: its end in mm and degrees in the frame of the first work offset.
#[derive(Clone, Debug)]
enum Motion {
    Rapid([f64; 6]),
    Feed([f64; 6]),
    /// The centre, the axis about which it turns (0 X, 1 Y, 2 Z) and its turns begun.
    Arc {
        end: [f64; 6],
        center: Vec3,
        axis: usize,
        turns: i32,
    },
    Dwell(f64),
}

/// How a program differs: `None` where `rs274` is not installed, `Some(None)` where it does not.
pub fn difference(text: &[u8], folders: &[PathBuf]) -> Option<Option<String>> {
    let Some(theirs) = theirs(text, folders) else {
        eprintln!("rs274 (Debian package linuxcnc-uspace) is not installed: LinuxCNC is not asked");
        return None;
    };
    Some(match (ours(text, folders), theirs) {
        (Err(_), Err(_)) => None,
        (Err(error), Ok(_)) => Some(format!("we refuse: {error}")),
        (Ok(_), Err(error)) => Some(format!("LinuxCNC refuses: {error}")),
        (Ok(ours), Ok(theirs)) => {
            let (ours, theirs) = (essential(ours), essential(theirs));
            let n = (0..ours.len().max(theirs.len())).find(
                |&n| !matches!((ours.get(n), theirs.get(n)), (Some(a), Some(b)) if same(a, b)),
            );
            n.map(|n| format!("move {n}\nours   {:?}\ntheirs {:?}", ours.get(n), theirs.get(n)))
        }
    })
}

/// What `rs274 -g` makes of a program; `None` where it is not installed.
///
/// It reports a file without `M2` and `%` when it has run it to its end, which we take as its end.
fn theirs(text: &[u8], folders: &[PathBuf]) -> Option<Result<Vec<Motion>, String>> {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    let subroutines: Vec<String> = folders.iter().map(|f| f.display().to_string()).collect();
    let ini = format!("[RS274NGC]\nSUBROUTINE_PATH = {}\n", subroutines.join(":"));
    fs::write(path("judge.ini"), ini).unwrap();
    // By itself the interpreter counts inches.
    let line = |n| format!("T{n} P{n} Z{:.9} D{:.9}\n", f64::from(n) / 25.4, 6.0 / 25.4);
    let table = TOOLS.map(line);
    fs::write(path("tool.tbl"), table.collect::<String>()).unwrap();
    fs::write(path("rs274.var"), "").unwrap();
    fs::write(path("program.ngc"), text).unwrap();
    let status = run(place.path()).ok()?;
    let errors = fs::read(path("errors")).unwrap();
    let errors = String::from_utf8_lossy(&errors).into_owned();
    match status {
        None => return Some(Err("takes too long".into())),
        Some(status) if status.success() || errors.contains(NO_END) => {}
        Some(_) => return Some(Err(errors)),
    }
    let printed = fs::read(path("out")).unwrap();
    Some(Ok(canonical(&String::from_utf8_lossy(&printed))))
}

/// Runs `program.ngc` of a folder; none where that takes too long.
fn run(folder: &Path) -> std::io::Result<Option<ExitStatus>> {
    let mut run = Command::new("rs274")
        .args(["-i", "judge.ini", "-t", "tool.tbl", "-v", "rs274.var", "-g", "program.ngc", "out"])
        .current_dir(folder)
        // Its tool table is a file in the home folder, which all interpreters share.
        .env("HOME", folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(fs::File::create(folder.join("errors"))?)
        .spawn()?;
    let begun = Instant::now();
    loop {
        if let Some(status) = run.try_wait()? {
            return Ok(Some(status));
        }
        if begun.elapsed() > LONGEST {
            run.kill()?;
            run.wait()?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The moves among the canonical calls that `rs274` prints. They are in coordinates of the program:
/// what offsets do to them is told beside them.
fn canonical(printed: &str) -> Vec<Motion> {
    let (mut moves, mut plane, mut unit) = (Vec::new(), [0, 1, 2], 1.0);
    let (mut system, mut offset, mut shift, mut turn) = (1, Vec3::ZERO, Vec3::ZERO, 0.0f64);
    // Each work offset as it was when the program first moved in it.
    let mut first: HashMap<i32, Frame> = HashMap::new();
    for line in printed.lines() {
        let Some((name, arguments)) = line.split_once('(') else { continue };
        let name = name.rsplit(' ').next().unwrap();
        let numbers: Vec<f64> = arguments
            .trim_end_matches(')')
            .split([',', ' '])
            .filter_map(|number| number.parse().ok())
            .collect();
        let vector = |from: usize| Vec3::new(numbers[from], numbers[from + 1], numbers[from + 2]);
        let frame = |shift: Vec3| {
            let turn = Mat3::from_rotation_z(turn.to_radians());
            Frame::from_mat3_translation(turn, offset + turn * shift)
        };
        let mut place = |point: Vec3| {
            let first = *first.entry(system).or_insert_with(|| frame(Vec3::ZERO));
            first.inverse().transform_point3(frame(shift).transform_point3(point))
        };
        let six = |p: Vec3, rest: &[f64]| [p.x, p.y, p.z, rest[0], rest[1], rest[2]];
        match name {
            "STRAIGHT_TRAVERSE" => {
                moves.push(Motion::Rapid(six(place(vector(0) * unit), &numbers[3..])));
            }
            "STRAIGHT_FEED" | "STRAIGHT_PROBE" => {
                moves.push(Motion::Feed(six(place(vector(0) * unit), &numbers[3..])));
            }
            "DWELL" => moves.push(Motion::Dwell(numbers[0])),
            "ARC_FEED" => {
                let (mut end, mut center) = (Vec3::ZERO, Vec3::ZERO);
                (end[plane[0]], end[plane[1]]) = (numbers[0] * unit, numbers[1] * unit);
                (center[plane[0]], center[plane[1]]) = (numbers[2] * unit, numbers[3] * unit);
                end[plane[2]] = numbers[5] * unit;
                center[plane[2]] = end[plane[2]];
                let (end, center) = (six(place(end), &numbers[6..]), place(center));
                moves.push(Motion::Arc { end, center, axis: plane[2], turns: numbers[4] as i32 });
            }
            "SELECT_PLANE" => {
                plane = match arguments {
                    "CANON_PLANE_XY)" => [0, 1, 2],
                    "CANON_PLANE_XZ)" => [2, 0, 1],
                    _ => [1, 2, 0],
                }
            }
            "USE_LENGTH_UNITS" => unit = if arguments.contains("INCHES") { 25.4 } else { 1.0 },
            "SET_G5X_OFFSET" => (system, offset) = (numbers[0] as i32, vector(1) * unit),
            "SET_G92_OFFSET" => shift = vector(0) * unit,
            "SET_XY_ROTATION" => turn = numbers[0],
            _ => {}
        }
    }
    moves
}

/// What our control makes of it. Homing goes to 0, as with `rs274`'s empty parameter file.
fn ours(text: &[u8], folders: &[PathBuf]) -> Result<Vec<Motion>, String> {
    let tool =
        |number| ToolData { number, name: String::new(), radius: 3.0, length: number.into() };
    let settings = Settings {
        setup: Setup {
            tools: TOOLS.map(tool).collect(),
            folders: folders.to_vec(),
            start: Some(Vec3::ZERO),
            ..Setup::default()
        },
        ..Settings::new(Dialect::LinuxCnc, [true; 3])
    };
    // Where the rotary axes stand at the start is not given.
    let start = [0.0, 0.0, 0.0, f64::NAN, f64::NAN, f64::NAN];
    let (mut moves, mut at, mut active) = (Vec::new(), start, None);
    let begun = Instant::now();
    read(&settings, "program.ngc", text, &mut |record| {
        if begun.elapsed() > LONGEST {
            return Err(program::Diagnostic::error("late", "takes too long").into());
        }
        let to = |pose: &Pose, at: [f64; 6]| {
            let Vec3 { x, y, z } = pose.point;
            let [a, b, c] = match pose.orientation {
                Orientation::Rotary { degrees, .. } => degrees,
                Orientation::Axis(_) => [f64::NAN; 3],
            };
            let p = [x, y, z, a, b, c];
            std::array::from_fn(|i| if p[i].is_nan() { at[i] } else { p[i] })
        };
        match record.op {
            Op::Rapid(pose) => {
                at = to(&pose, at);
                moves.push(Motion::Rapid(at));
            }
            Op::Line(pose) => {
                at = to(&pose, at);
                moves.push(Motion::Feed(at));
            }
            Op::Probe(probe) => {
                at = to(&probe.end, at);
                moves.push(Motion::Feed(at));
            }
            Op::Thread(thread) => {
                at = to(&thread.end, at);
                moves.push(Motion::Feed(at));
            }
            Op::Arc(arc) => {
                at = to(&arc.end, at);
                let axis = arc.normal.abs().max_position();
                let turns = (arc.turns as i32 + 1) * arc.normal[axis].signum() as i32;
                moves.push(Motion::Arc { end: at, center: arc.center, axis, turns });
            }
            Op::Home(axes) => {
                at = std::array::from_fn(|i| if axes & 1 << i != 0 { 0.0 } else { at[i] });
                moves.push(Motion::Rapid(at));
            }
            Op::Dwell(seconds) => moves.push(Motion::Dwell(seconds)),
            Op::Cycle(cycle) => active = Some(*cycle),
            Op::Hole(pose) => {
                let cycle = active.as_ref().unwrap();
                let axis = pose.axis().map_or(2, |a| a.abs().max_position());
                at = hole(&mut moves, cycle, at, to(&pose, at), axis);
            }
            _ => {}
        }
        Ok(())
    })
    .map_err(|diagnostic| diagnostic.to_string())?;
    Ok(moves)
}

/// The moves of one hole ("Canned cycles" in LinuxCNC's G-code reference).
fn hole(
    moves: &mut Vec<Motion>,
    cycle: &program::Cycle,
    at: [f64; 6],
    top: [f64; 6],
    axis: usize,
) -> [f64; 6] {
    use program::CycleKind;
    let level = |height: f64| {
        let mut p = top;
        p[axis] += height;
        p
    };
    moves.push(Motion::Rapid(level((at[axis] - top[axis]).max(cycle.retract))));
    moves.push(Motion::Rapid(level(0.0)));
    let mut depth = 0.0;
    while let Some(peck) = cycle.peck
        && depth + peck < cycle.depth
    {
        depth += peck;
        moves.push(Motion::Feed(level(-depth)));
        if cycle.kind == CycleKind::Deep {
            moves.push(Motion::Rapid(level(0.0)));
        }
        moves.push(Motion::Rapid(level(-depth + 0.254)));
    }
    moves.push(Motion::Feed(level(-cycle.depth)));
    if cycle.dwell > 0.0 || matches!(cycle.kind, CycleKind::Tap { .. }) {
        moves.push(Motion::Dwell(cycle.dwell));
    }
    match cycle.kind {
        CycleKind::Ream if cycle.dwell == 0.0 => moves.push(Motion::Feed(level(0.0))),
        CycleKind::Ream | CycleKind::Tap { .. } => moves.push(Motion::Feed(level(cycle.retract))),
        _ => {}
    }
    moves.push(Motion::Rapid(level(cycle.retract)));
    level(cycle.retract)
}

/// Without the moves that go nowhere, of which both sides have some.
fn essential(moves: Vec<Motion>) -> Vec<Motion> {
    let mut at = [0.0; 6];
    let mut kept = Vec::new();
    for motion in moves {
        let end = match &motion {
            Motion::Rapid(end) | Motion::Feed(end) if near(end, &at) => continue,
            Motion::Rapid(end) | Motion::Feed(end) | Motion::Arc { end, .. } => *end,
            Motion::Dwell(_) => at,
        };
        at = end;
        kept.push(motion);
    }
    kept
}

/// Equal to the four decimals that `rs274` prints, in inches too, as far as we know it.
fn near(a: &[f64; 6], b: &[f64; 6]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.is_nan() || (a - b).abs() < 5.2e-3)
}

fn same(a: &Motion, b: &Motion) -> bool {
    match (a, b) {
        (Motion::Rapid(a), Motion::Rapid(b)) | (Motion::Feed(a), Motion::Feed(b)) => near(a, b),
        (Motion::Dwell(a), Motion::Dwell(b)) => (a - b).abs() < 1e-4,
        (
            Motion::Arc { end, center, axis, turns },
            Motion::Arc { end: end_b, center: center_b, axis: axis_b, turns: turns_b },
        ) => {
            let mut apart = *center - *center_b;
            apart[*axis] = 0.0;
            near(end, end_b) && apart.length() < 8e-3 && axis == axis_b && turns == turns_b
        }
        _ => false,
    }
}
