//! Our programs for LinuxCNC, through its own interpreter `rs274` and through our virtual control, block number by block
//! number: the same moves to the same places, with the same feed, spindle and coolant.
//!
//! The judge is Debian's package `linuxcnc-uspace`, run as a program; where it is not installed the test says so and
//! passes, but not in CI.

use crate::files::{root, sources};
use control::{Action, Setup};
use geom::Vec3;
use machine::Machine;
use program::{Coolant, Cycle, Feed, Spindle};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};

/// How a tool goes to the end of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
enum MoveKind {
    Rapid,
    Feed,
    /// About a centre, mm, so many turns begun, counter-clockwise where above 0.
    Arc(Vec3, i32),
    /// In and out again: to this bottom of Z, mm, with so many s of dwell.
    Hole(f64, f64),
    Dwell(f64),
    Tool(u32),
}

/// A move of a block, and what is on while it runs.
#[derive(Clone, Copy, Debug)]
struct Move {
    kind: MoveKind,
    /// mm; NaN where it is not known.
    end: Vec3,
    /// mm/min.
    feed: f64,
    /// 1/min; counter-clockwise below 0.
    spindle: f64,
    coolant: [bool; 2],
}

/// The moves of each block by its number.
type Blocks = BTreeMap<u32, Vec<Move>>;

/// What has been reported so far.
struct Reported {
    blocks: Blocks,
    now: Move,
}

impl Reported {
    /// Nothing yet, the tool being at `start`.
    fn nothing(start: Vec3) -> Reported {
        let (kind, coolant) = (MoveKind::Rapid, [false; 2]);
        let now = Move { kind, end: start, feed: 0.0, spindle: 0.0, coolant };
        Reported { blocks: Blocks::new(), now }
    }

    fn moves(&mut self, block: u32, kind: MoveKind, end: Vec3) {
        (self.now.kind, self.now.end) = (kind, end);
        self.blocks.entry(block).or_default().push(self.now);
    }

    fn stays(&mut self, block: u32, kind: MoveKind) {
        self.moves(block, kind, self.now.end);
    }
}

/// The text with the number of its line before each block.
fn numbered(text: &str) -> String {
    let number = |(i, line): (usize, &str)| match line.starts_with(['(', '%']) {
        true => format!("{line}\n"),
        false => format!("N{} {line}\n", i + 1),
    };
    text.lines().enumerate().map(number).collect()
}

/// What `rs274` makes of it. Every tool is in its table, without length and without wear.
fn theirs(folder: &Path, text: &str) -> Result<Blocks, String> {
    std::fs::write(folder.join("program.ngc"), text).unwrap();
    let table: String = (1..100).map(|tool| format!("T{tool} P{tool} D0 Z0\n")).collect();
    std::fs::write(folder.join("tools.tbl"), table).unwrap();
    let run = Command::new("rs274")
        .args(["-t", "tools.tbl", "-g", "program.ngc"])
        .current_dir(folder)
        .env("HOME", folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    if !run.status.success() {
        return Err(format!("{said}{}", String::from_utf8_lossy(&run.stderr)));
    }
    let mut reported = Reported::nothing(Vec3::ZERO);
    let (mut speed, mut plane) = (0.0, 0);
    for line in said.lines() {
        // `   19 N12    STRAIGHT_TRAVERSE(1.0000, 2.0000, ...)`
        let Some((head, rest)) = line.split_once('(') else { continue };
        let mut head = head.split_whitespace().skip(1);
        let (Some(block), Some(call)) = (head.next(), head.next()) else { continue };
        let numbers: Vec<f64> =
            rest.trim_end_matches(')').split(',').filter_map(|n| n.trim().parse().ok()).collect();
        let place = || Vec3::new(numbers[0], numbers[1], numbers[2]);
        let number = || {
            let number = block[1..].parse();
            number.unwrap_or_else(|_| panic!("a move in a block without a number: {line}"))
        };
        match call {
            "SELECT_PLANE" => {
                plane = ["XY", "YZ", "XZ"].iter().position(|p| rest.contains(p)).unwrap();
            }
            "STRAIGHT_TRAVERSE" => reported.moves(number(), MoveKind::Rapid, place()),
            "STRAIGHT_FEED" => reported.moves(number(), MoveKind::Feed, place()),
            "RIGID_TAP" => reported.stays(number(), MoveKind::Hole(numbers[2], 0.0)),
            "ARC_FEED" => {
                // First and second axis of the plane (X Y, Y Z, Z X), then the one it rises along.
                let turned = |a: f64, b: f64, c: f64| match plane {
                    0 => Vec3::new(a, b, c),
                    1 => Vec3::new(c, a, b),
                    _ => Vec3::new(b, c, a),
                };
                let center = turned(numbers[2], numbers[3], f64::NAN);
                reported.moves(
                    number(),
                    MoveKind::Arc(center, numbers[4] as i32),
                    turned(numbers[0], numbers[1], numbers[5]),
                );
            }
            "DWELL" => reported.stays(number(), MoveKind::Dwell(numbers[0])),
            "CHANGE_TOOL" => reported.stays(number(), MoveKind::Tool(numbers[0] as u32)),
            "SET_FEED_RATE" => reported.now.feed = numbers[0],
            "SET_SPINDLE_SPEED" => {
                speed = numbers[1];
                reported.now.spindle =
                    speed.copysign(reported.now.spindle) * reported.now.spindle.abs().min(1.0);
            }
            "START_SPINDLE_CLOCKWISE" => reported.now.spindle = speed,
            "START_SPINDLE_COUNTERCLOCKWISE" => reported.now.spindle = -speed,
            "STOP_SPINDLE_TURNING" => reported.now.spindle = 0.0,
            "FLOOD_ON" => reported.now.coolant[0] = true,
            "FLOOD_OFF" => reported.now.coolant[0] = false,
            "MIST_ON" => reported.now.coolant[1] = true,
            "MIST_OFF" => reported.now.coolant[1] = false,
            _ => {}
        }
    }
    Ok(reported.blocks)
}

/// What the virtual control of the proof makes of it.
fn ours(machine: &Machine, text: &str) -> Blocks {
    let settings = nc::settings(machine, Setup::default()).unwrap();
    let mut reported = Reported::nothing(Vec3::NAN);
    let mut cycle: Option<Cycle> = None;
    let run = control::read(&settings, "p.ngc", text.as_bytes(), &mut |event| {
        let line = event.line;
        match &event.action {
            Action::Rapid(to) => reported.moves(line, MoveKind::Rapid, to.point),
            Action::Line(to) => reported.moves(line, MoveKind::Feed, to.point),
            Action::Arc(arc) => {
                let about = arc.normal.x + arc.normal.y + arc.normal.z;
                let turns = (arc.turns as i32 + 1) * about.signum() as i32;
                let axis = arc.normal.abs();
                let center = arc.center + axis * f64::NAN;
                let center = Vec3::select(axis.cmpgt(Vec3::splat(0.5)), center, arc.center);
                reported.moves(line, MoveKind::Arc(center, turns), arc.end.point);
            }
            Action::Cycle(new) => cycle = Some(**new),
            Action::Hole(at) => {
                let cycle = cycle.expect("a hole has a cycle");
                if let Some(Feed::PerMinute(own)) = cycle.feed {
                    reported.now.feed = own;
                }
                let end = at.point + Vec3::Z * cycle.retract;
                reported.moves(line, MoveKind::Hole(at.point.z - cycle.depth, cycle.dwell), end);
            }
            Action::MachineMove(to) => {
                let z = to.linear[2].unwrap_or(f64::NAN);
                reported.moves(line, MoveKind::Rapid, Vec3::new(f64::NAN, f64::NAN, z));
            }
            Action::Dwell(seconds) => reported.stays(line, MoveKind::Dwell(*seconds)),
            Action::Tool(tool) => reported.moves(line, MoveKind::Tool(tool.number), Vec3::NAN),
            Action::Feed(Feed::PerMinute(feed)) => reported.now.feed = *feed,
            Action::Spindle(spindle) => {
                reported.now.spindle = match *spindle {
                    Spindle::Off => 0.0,
                    Spindle::Clockwise(speed) => speed,
                    Spindle::CounterClockwise(speed) => -speed,
                }
            }
            Action::Coolant(coolant) => {
                reported.now.coolant = match coolant {
                    Coolant::Off => [false; 2],
                    Coolant::Flood => [true, false],
                    Coolant::Mist => [false, true],
                    Coolant::FloodAndMist => [true; 2],
                    other => panic!("LinuxCNC has no {other:?}"),
                }
            }
            Action::Home(_) | Action::Thread(_) | Action::Probe(_) | Action::Feed(_) => {
                panic!("{event:?}")
            }
            _ => {}
        }
        Ok(())
    });
    run.unwrap_or_else(|found| panic!("{found}"));
    reported.blocks
}

/// The moves of a block that drills, as one.
fn as_hole(moves: &[Move]) -> Option<Move> {
    let bottom = |m: &Move| if let MoveKind::Hole(z, _) = m.kind { z } else { m.end.z };
    let bottom = moves.iter().map(bottom).fold(f64::INFINITY, f64::min);
    let dwell = |m: &Move| if let MoveKind::Dwell(seconds) = m.kind { seconds } else { 0.0 };
    let kind = MoveKind::Hole(bottom, moves.iter().map(dwell).sum());
    moves.last().map(|last| Move { kind, ..*last })
}

/// What a block of ours does otherwise than LinuxCNC, if anything. Places that are not known agree with any.
fn difference(ours: &Move, theirs: &Move) -> Option<&'static str> {
    let near = |a: f64, b: f64| a.is_nan() || b.is_nan() || (a - b).abs() < 2e-4;
    let close = |a: Vec3, b: Vec3| near(a.x, b.x) && near(a.y, b.y) && near(a.z, b.z);
    let same_way = match (ours.kind, theirs.kind) {
        (MoveKind::Arc(a, n), MoveKind::Arc(b, m)) => close(a, b) && n == m,
        (MoveKind::Hole(a, t), MoveKind::Hole(b, u)) => near(a, b) && near(t, u),
        (MoveKind::Dwell(a), MoveKind::Dwell(b)) => near(a, b),
        (a, b) => a == b,
    };
    let feeds = matches!(ours.kind, MoveKind::Feed | MoveKind::Arc(..) | MoveKind::Hole(..));
    match () {
        () if !same_way => Some("another kind"),
        () if !close(ours.end, theirs.end) => Some("another end"),
        () if feeds && !near(ours.feed, theirs.feed) => Some("another feed"),
        () if !matches!(ours.kind, MoveKind::Tool(_)) && !near(ours.spindle, theirs.spindle) => {
            Some("another spindle")
        }
        () if feeds && ours.coolant != theirs.coolant => Some("another coolant"),
        () => None,
    }
}

#[test]
fn linuxcnc_itself_does_in_each_block_what_the_proof_reads() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let sample = root().join("machines/samples/three-axes.cls");
    let (mut programs, mut count) = (0, 0);
    for machine in ["generic-3axis-linuxcnc", "linuxcnc-mill"].map(machine::load) {
        let machine = machine.unwrap();
        for file in sources().into_iter().chain([sample.clone()]) {
            let text = std::fs::read(&file).unwrap();
            let name = file.display().to_string();
            let source = source::apt::read(&name, &text, &Default::default()).unwrap().program;
            // What the machine refuses stands in `library.rs`.
            let Ok(output) = post::write(&source, &machine) else { continue };
            let text = numbered(&String::from_utf8(output.text).unwrap());
            let theirs = theirs(folder.path(), &text).unwrap_or_else(|why| panic!("{name}: {why}"));
            let ours = ours(&machine, &text);
            programs += 1;
            let blocks: std::collections::BTreeSet<u32> =
                ours.keys().chain(theirs.keys()).copied().collect();
            for block in blocks {
                let moves = |all: &Blocks| all.get(&block).cloned().unwrap_or_default();
                let (our, mut their) = (moves(&ours), moves(&theirs));
                if let [Move { kind: MoveKind::Hole(..), .. }] = our[..] {
                    their = as_hole(&their).into_iter().collect();
                }
                let line = || text.lines().nth(block as usize - 1).unwrap_or_default().to_owned();
                assert_eq!(our.len(), their.len(), "{name}: {}\n{our:?}\n{their:?}", line());
                for (our, their) in our.iter().zip(&their) {
                    count += 1;
                    if let Some(what) = difference(our, their) {
                        panic!("{name}: {}: {what}\n{our:?}\n{their:?}", line());
                    }
                }
            }
        }
    }
    eprintln!("{programs} programs, {count} moves");
    assert!(programs > 15 && count > 10_000, "{programs} programs, {count} moves");
}
