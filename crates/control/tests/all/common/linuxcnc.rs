//! LinuxCNC's own interpreter and ours: what `rs274 -g` makes of a program, what we make of it, and
//! where the two differ.

use geom::{Frame, Mat3, Vec3};
use program::{Cycle, CycleKind, Rule};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};
use toolpost_control::{Action, Dialect, Orientation, Position, Settings, Setup, ToolData, read};

/// The longest that either side may take over a program.
const LONGEST: Duration = Duration::from_secs(10);

/// The tools of the table: 6 mm in diameter and as many mm long as their number.
const TOOLS: std::ops::RangeInclusive<u32> = 1..=99;

/// What `rs274` says of a file without `M2` and `%`.
const NO_END: &str = "File ended with no percent sign or program end";

/// A move as the machine makes it: its end in mm and degrees in the frame of the active work offset as it
/// was at the first move in it.
#[derive(Clone, Debug)]
pub enum Motion {
    Rapid([f64; 6]),
    Feed([f64; 6]),
    /// A point of the axis, the direction about which it turns counter-clockwise, and its turns begun.
    Arc {
        end: [f64; 6],
        center: Vec3,
        normal: Vec3,
        turns: i32,
    },
    /// With its pitch.
    Thread([f64; 6], f64),
    Probe([f64; 6]),
    Dwell(f64),
}

/// How a program differs on a machine with these of A, B, C: `None` where `rs274` is not installed, `Some(None)` where it does not.
pub fn difference(text: &[u8], rotary: [bool; 3], folders: &[PathBuf]) -> Option<Option<String>> {
    let theirs = theirs(text, folders)?;
    Some(match (ours(text, rotary, folders), theirs) {
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
pub fn theirs(text: &[u8], folders: &[PathBuf]) -> Option<Result<Vec<Motion>, String>> {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return None;
    }
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
    let status = run(place.path()).expect("rs274 is run");
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

/// The moves among the canonical calls that `rs274` prints. They are in coordinates of the program: the
/// machine goes to the origin plus the turned sum of them and the offset of `G92` (`emccanon.cc`).
fn canonical(printed: &str) -> Vec<Motion> {
    let (mut moves, mut plane, mut unit, mut pitch) = (Vec::new(), [0, 1, 2], 1.0, None);
    let (mut system, mut offset, mut shift, mut turn) = (1, Vec3::ZERO, Vec3::ZERO, 0.0f64);
    // Each work offset as it was when the program first moved in it.
    let mut first: HashMap<i32, Frame> = HashMap::new();
    let mut at = [0.0; 6];
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
        let mut from_first = || {
            let first = *first.entry(system).or_insert_with(|| frame(Vec3::ZERO));
            first.inverse() * frame(shift)
        };
        let six = |p: Vec3, rest: &[f64]| [p.x, p.y, p.z, rest[0], rest[1], rest[2]];
        let mut end = || six(from_first().transform_point3(vector(0) * unit), &numbers[3..]);
        match name {
            "STRAIGHT_TRAVERSE" => {
                at = end();
                moves.push(Motion::Rapid(at));
            }
            "STRAIGHT_FEED" => {
                at = end();
                moves.push(pitch.map_or(Motion::Feed(at), |pitch| Motion::Thread(at, pitch)));
            }
            "STRAIGHT_PROBE" => {
                at = end();
                moves.push(Motion::Probe(at));
            }
            "RIGID_TAP" => {
                let bottom = from_first().transform_point3(vector(0) * unit);
                moves.push(Motion::Feed(six(bottom, &at[3..])));
                moves.push(Motion::Dwell(0.0));
                moves.push(Motion::Feed(at));
            }
            "DWELL" => moves.push(Motion::Dwell(numbers[0])),
            "ARC_FEED" => {
                let (mut end, mut center) = (Vec3::ZERO, Vec3::ZERO);
                (end[plane[0]], end[plane[1]]) = (numbers[0] * unit, numbers[1] * unit);
                (center[plane[0]], center[plane[1]]) = (numbers[2] * unit, numbers[3] * unit);
                end[plane[2]] = numbers[5] * unit;
                let frame = from_first();
                at = six(frame.transform_point3(end), &numbers[6..]);
                moves.push(Motion::Arc {
                    end: at,
                    center: frame.transform_point3(center),
                    normal: frame.transform_vector3(Vec3::AXES[plane[2]] * numbers[4].signum()),
                    turns: numbers[4].abs() as i32,
                });
            }
            "SELECT_PLANE" => {
                plane = match arguments {
                    "CANON_PLANE_XY)" => [0, 1, 2],
                    "CANON_PLANE_XZ)" => [2, 0, 1],
                    _ => [1, 2, 0],
                }
            }
            "START_SPEED_FEED_SYNC" => pitch = Some(numbers[0] * unit),
            "STOP_SPEED_FEED_SYNCH" => pitch = None,
            "USE_LENGTH_UNITS" => unit = if arguments.contains("INCHES") { 25.4 } else { 1.0 },
            "SET_G5X_OFFSET" => (system, offset) = (numbers[0] as i32, vector(1) * unit),
            "SET_G92_OFFSET" => shift = vector(0) * unit,
            "SET_XY_ROTATION" => turn = numbers[0],
            _ => {}
        }
    }
    moves
}

/// What our control makes of it. Homing goes to 0, as with `rs274`'s empty parameter file; holes are
/// expanded as LinuxCNC's manual describes each cycle.
pub fn ours(text: &[u8], rotary: [bool; 3], folders: &[PathBuf]) -> Result<Vec<Motion>, String> {
    let tool =
        |number| ToolData { number, name: String::new(), radius: 3.0, length: number.into() };
    let settings = Settings {
        setup: Setup {
            tools: TOOLS.map(tool).collect(),
            folders: folders.to_vec().into(),
            start: Some(Vec3::ZERO),
            ..Setup::default()
        },
        ..Settings::new(Dialect::LinuxCnc, rotary)
    };
    // Where the rotary axes stand at the start is not given.
    let start = [0.0, 0.0, 0.0, f64::NAN, f64::NAN, f64::NAN];
    let (mut moves, mut at, mut active) = (Vec::new(), start, None);
    let begun = Instant::now();
    read(&settings, "program.ngc", text, &mut |record| {
        if begun.elapsed() > LONGEST {
            return Err(program::Diagnostic::error(Rule::Stopped, "takes too long").into());
        }
        let to = |pose: &Position, at: [f64; 6]| {
            let Vec3 { x, y, z } = pose.point;
            let [a, b, c] = match pose.orientation {
                Orientation::Rotary { degrees, .. } => degrees,
                Orientation::Axis(_) => [f64::NAN; 3],
            };
            let p = [x, y, z, a, b, c];
            std::array::from_fn(|i| if p[i].is_nan() { at[i] } else { p[i] })
        };
        match record.action {
            Action::Rapid(pose) => {
                at = to(&pose, at);
                moves.push(Motion::Rapid(at));
            }
            Action::Line(pose) => {
                at = to(&pose, at);
                moves.push(Motion::Feed(at));
            }
            Action::Probe(probe) => {
                at = to(&probe.end, at);
                moves.push(Motion::Probe(at));
            }
            Action::Thread(thread) => {
                at = to(&thread.end, at);
                moves.push(Motion::Thread(at, thread.pitch));
            }
            Action::Arc(arc) => {
                at = to(&arc.end, at);
                let (center, normal, turns) = (arc.center, arc.normal, arc.turns as i32 + 1);
                moves.push(Motion::Arc { end: at, center, normal, turns });
            }
            Action::Home(axes) => {
                at = std::array::from_fn(|i| {
                    if axes.letters().contains(['X', 'Y', 'Z', 'A', 'B', 'C'][i]) {
                        0.0
                    } else {
                        at[i]
                    }
                });
                moves.push(Motion::Rapid(at));
            }
            Action::MachineMove(to) => {
                let [x, y, z] = to.linear;
                let [a, b, c] = to.rotary;
                let to = [x, y, z, a, b, c];
                at = std::array::from_fn(|i| to[i].unwrap_or(at[i]));
                moves.push(Motion::Rapid(at));
            }
            Action::Dwell(seconds) => moves.push(Motion::Dwell(seconds)),
            Action::Cycle(cycle) => active = Some(*cycle),
            Action::Hole(pose) => {
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
    cycle: &Cycle,
    at: [f64; 6],
    top: [f64; 6],
    axis: usize,
) -> [f64; 6] {
    let level = |height: f64| {
        let mut p = top;
        p[axis] += height;
        p
    };
    // With G98 the way in the plane is at the initial level, also after holes with G99.
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
        // 0.010 inch, both for breaking the chip and for going back in.
        moves.push(Motion::Rapid(level(-depth + 0.254)));
    }
    moves.push(Motion::Feed(level(-cycle.depth)));
    if cycle.dwell > 0.0 || matches!(cycle.kind, CycleKind::Tap { .. }) {
        moves.push(Motion::Dwell(cycle.dwell));
    }
    match cycle.kind {
        // G85: at feed up to R, by rapid from there.
        CycleKind::Ream if cycle.dwell == 0.0 => moves.push(Motion::Feed(level(0.0))),
        // G89, G84, G74: at feed up to the retract level, also where that is the initial one.
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
        match &motion {
            Motion::Rapid(end) | Motion::Feed(end) if near(end, &at) => continue,
            Motion::Rapid(end) | Motion::Feed(end) | Motion::Probe(end) => at = *end,
            Motion::Thread(end, _) | Motion::Arc { end, .. } => at = *end,
            Motion::Dwell(_) => {}
        }
        kept.push(motion);
    }
    kept
}

/// Equal to the four decimals that `rs274` prints, in inches too, as far as we know it.
fn near(a: &[f64; 6], b: &[f64; 6]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.is_nan() || (a - b).abs() < 2.6e-3)
}

fn same(a: &Motion, b: &Motion) -> bool {
    match (a, b) {
        (Motion::Rapid(a), Motion::Rapid(b))
        | (Motion::Feed(a), Motion::Feed(b))
        | (Motion::Probe(a), Motion::Probe(b)) => near(a, b),
        (Motion::Thread(a, p), Motion::Thread(b, q)) => near(a, b) && (p - q).abs() < 1e-3,
        (Motion::Dwell(a), Motion::Dwell(b)) => a == b,
        (
            Motion::Arc { end, center, normal, turns },
            Motion::Arc { end: end_b, center: center_b, normal: normal_b, turns: turns_b },
        ) => {
            near(end, end_b)
                && (*center - *center_b).reject_from(*normal).length() < 5e-3
                && normal.distance(*normal_b) < 1e-3
                && turns == turns_b
        }
        _ => false,
    }
}
