//! Random legal SINUMERIK programs, written by the small writer of this file, and random bytes.

use crate::common::sinumerik::{run, settings};
use geom::Vec3;
use proptest::prelude::*;
use std::fmt::Write;
use toolpost_control::{Action, Orientation, read};

/// One block of a random program. Lengths are thousandths of a mm, angles thousandths of a degree.
#[derive(Clone, Debug)]
enum Block {
    /// To a place, each axis absolute, incremental or left out; with rotary positions.
    Straight { rapid: bool, to: [Option<(bool, i64)>; 3], turn: [Option<i64>; 2], feed: u32 },
    /// About a centre, by an angle in degrees, with a rise.
    Arc { center: [i64; 2], angle: f64, rise: i64, absolute_center: bool },
    /// Half chord and height of the centre over it, for an arc by its radius.
    Radius { chord: [i64; 2], long: bool, left: bool, share: f64 },
    /// Programmable offset.
    Offset { by: [i64; 3], additive: bool },
    /// Hole with depth, safety distance and height of the retraction plane over the reference plane.
    Hole { surface: i64, depth: u32, safety: u32, retract: u32, relative: bool },
}

fn block() -> impl Strategy<Value = Block> {
    let length = || -500_000i64..500_000;
    let axis = || prop::option::of((any::<bool>(), length()));
    let turn = || prop::option::of(-720_000i64..720_000);
    prop_oneof![
        4 => (any::<bool>(), [axis(), axis(), axis()], [turn(), turn()], 1u32..20_000)
            .prop_map(|(rapid, to, turn, feed)| Block::Straight { rapid, to, turn, feed }),
        2 => ([length(), length()], 1.0..359.0f64, -20_000i64..20_000, any::<bool>())
            .prop_filter("a radius", |(center, ..)| center[0].abs() + center[1].abs() > 1000)
            .prop_map(|(center, angle, rise, absolute_center)| {
                Block::Arc { center, angle, rise, absolute_center }
            }),
        2 => ([length(), length()], any::<bool>(), any::<bool>(), 1.0..5.0f64)
            .prop_filter("a chord", |(chord, ..)| chord[0].abs() + chord[1].abs() > 1000)
            .prop_map(|(chord, long, left, share)| Block::Radius { chord, long, left, share }),
        1 => ([length(), length(), length()], any::<bool>())
            .prop_map(|(by, additive)| Block::Offset { by, additive }),
        1 => (length(), 1u32..100_000, 0u32..9_000, 1u32..90_000, any::<bool>())
            .prop_map(|(surface, depth, safety, retract, relative)| {
                Block::Hole { surface, depth, safety, retract, relative }
            }),
    ]
}

/// Thousandths as a program writes them.
fn written(thousandths: i64) -> String {
    let sign = if thousandths < 0 { "-" } else { "" };
    let (whole, part) = (thousandths.abs() / 1000, thousandths.abs() % 1000);
    if part == 0 { format!("{sign}{whole}") } else { format!("{sign}{whole}.{part:03}") }
}

fn mm(thousandths: i64) -> f64 {
    thousandths as f64 / 1000.0
}

/// What the writer expects of a block.
#[derive(Debug)]
enum Expected {
    Move { rapid: bool, point: Vec3, degrees: [f64; 2] },
    Arc { end: Vec3, center: Vec3, ccw: bool },
    Hole { point: Vec3, depth: f64, safety: f64, retract: f64 },
}

/// The program, and what it must do. Positions are thousandths in the program's coordinates.
fn write(blocks: &[Block], blanks: bool) -> (String, Vec<Expected>) {
    let gap = if blanks { " " } else { "" };
    let mut text = "T1M6\nG0X0Y0Z0A=R24 C=R24 F100\n".to_owned();
    let (mut at, mut turned, mut offset) = ([0i64; 3], [0i64; 2], [0i64; 3]);
    let mut expected = Vec::new();
    for (n, block) in blocks.iter().enumerate() {
        let _ = write!(text, "N{n}{gap}");
        match block {
            Block::Straight { rapid, to, turn, feed } => {
                let _ = write!(text, "G{}", u8::from(!rapid));
                for (i, target) in to.iter().enumerate() {
                    let Some((incremental, value)) = target else { continue };
                    let name = ["X", "Y", "Z"][i];
                    if *incremental {
                        let _ = write!(text, "{gap}{name}=IC({})", written(*value));
                        at[i] += value;
                    } else {
                        let _ = write!(text, "{gap}{name}{}", written(*value));
                        at[i] = *value;
                    }
                }
                for (i, target) in turn.iter().enumerate() {
                    let Some(value) = target else { continue };
                    let _ = write!(text, "{gap}{}={}+R24", ["A", "C"][i], written(*value));
                    turned[i] = *value;
                    // Letters behind R24 would be part of a name.
                    text.push(' ');
                }
                let _ = write!(text, "{gap}F{feed}");
                if to.iter().any(Option::is_some) || turn.iter().any(Option::is_some) {
                    let degrees = turned.map(mm);
                    expected.push(Expected::Move {
                        rapid: *rapid,
                        point: base(at, offset),
                        degrees,
                    });
                }
            }
            Block::Arc { center, angle, rise, absolute_center } => {
                let spoke = Vec3::new(-mm(center[0]), -mm(center[1]), 0.0);
                let turned = geom::rotate(spoke, Vec3::Z, angle.to_radians()) - spoke;
                let end = [turned.x, turned.y].map(|v| (v * 1000.0).round() as i64);
                let middle = Vec3::new(mm(at[0] + center[0]), mm(at[1] + center[1]), mm(at[2]));
                let target = [at[0] + end[0], at[1] + end[1], at[2] + rise];
                let [x, y, z] = target.map(written);
                let _ = write!(text, "G3{gap}X{x}{gap}Y{y}{gap}Z{z}{gap}");
                let [i, j] = [0, 1].map(|a| written(center[a]));
                let [ai, aj] = [0, 1].map(|a| written(at[a] + center[a]));
                let _ = if *absolute_center {
                    write!(text, "I=AC({ai}){gap}J=AC({aj})")
                } else {
                    write!(text, "I{i}{gap}J{j}")
                };
                at = target;
                let center = middle + base([0; 3], offset);
                expected.push(Expected::Arc { end: base(at, offset), center, ccw: true });
            }
            Block::Radius { chord, long, left, share } => {
                let half = Vec3::new(mm(chord[0]), mm(chord[1]), 0.0) / 2.0;
                let radius = ((half.length() * share * 1000.0).round() + 1.0) / 1000.0;
                let sign = if *long { -1.0 } else { 1.0 };
                let height = (radius * radius - half.length_squared()).sqrt();
                // To the left of the chord for a short counter-clockwise arc.
                let side = if *left == *long { -1.0 } else { 1.0 };
                let aside = Vec3::new(-half.y, half.x, 0.0).normalize() * height * side;
                let middle = base(at, offset) + half + aside;
                at = [at[0] + chord[0], at[1] + chord[1], at[2]];
                let [x, y] = [0, 1].map(|a| written(at[a]));
                let command = if *left { 3 } else { 2 };
                let _ = write!(text, "G{command}{gap}X{x}{gap}Y{y}{gap}CR={:.3}", sign * radius);
                expected.push(Expected::Arc { end: base(at, offset), center: middle, ccw: *left });
            }
            Block::Offset { by, additive } => {
                let [x, y, z] = by.map(written);
                let command = if *additive { "ATRANS" } else { "TRANS" };
                let _ = write!(text, " {command} X{x}{gap}Y{y}{gap}Z{z}\nG0");
                for i in 0..3 {
                    offset[i] = if *additive { offset[i] + by[i] } else { by[i] };
                }
                // Back to where it was in the new coordinates.
                let [x, y, z] = at.map(written);
                let _ = write!(text, "{gap}X{x}{gap}Y{y}{gap}Z{z}");
                let degrees = turned.map(mm);
                expected.push(Expected::Move { rapid: true, point: base(at, offset), degrees });
            }
            Block::Hole { surface, depth, safety, retract, relative } => {
                let [depth, safety, retract] = [*depth, *safety, *retract].map(i64::from);
                let down = if *relative {
                    format!(",{}", written(depth))
                } else {
                    written(surface - depth)
                };
                let [top, level] = [surface + retract, *surface].map(written);
                let _ = write!(text, " CYCLE81({top},{level},{},{down})", written(safety));
                at[2] = *surface;
                let point = base(at, offset);
                at[2] = surface + retract;
                let [depth, safety, retract] = [depth, safety, retract].map(mm);
                expected.push(Expected::Hole { point, depth, safety, retract });
            }
        }
        text.push('\n');
    }
    text.push_str("M30\n");
    (text, expected)
}

fn base(at: [i64; 3], offset: [i64; 3]) -> Vec3 {
    Vec3::new(mm(at[0] + offset[0]), mm(at[1] + offset[1]), mm(at[2] + offset[2]))
}

fn near(a: Vec3, b: Vec3) -> bool {
    a.distance(b) < 1e-6 * (1.0 + b.length())
}

fn check(expected: &Expected, op: &Action, cycle: Option<program::Cycle>) -> bool {
    match (expected, op) {
        (Expected::Move { rapid, point, degrees }, Action::Rapid(pose) | Action::Line(pose)) => {
            let Orientation::Rotary { degrees: found, .. } = pose.orientation else { return false };
            matches!(op, Action::Rapid(_)) == *rapid
                && near(pose.point, *point)
                && found == [degrees[0], 0.0, degrees[1]]
        }
        (Expected::Arc { end, center, ccw }, Action::Arc(arc)) => {
            near(arc.end.point, *end)
                && near(arc.center, *center)
                && arc.normal == if *ccw { Vec3::Z } else { Vec3::NEG_Z }
        }
        (Expected::Hole { point, depth, safety, retract }, Action::Hole(pose)) => {
            let close = |a: f64, b: f64| (a - b).abs() < 1e-6;
            near(pose.point, *point)
                && cycle.is_some_and(|cycle| {
                    close(cycle.depth, *depth)
                        && close(cycle.clearance, *safety)
                        && close(cycle.retract, *retract)
                })
        }
        _ => false,
    }
}

/// Words that mean something, to build nonsense from.
const SCRAPS: &[&str] = &[
    "G0",
    "G1",
    "G2",
    "CIP",
    "G41",
    "G40",
    "G90",
    "G91",
    "G53",
    "SUPA",
    "G75",
    "G4",
    "X1",
    "Y=IC(2)",
    "Z=AC(",
    "I5",
    "J=",
    "CR=5",
    "A30",
    "A3=1",
    "C3=0",
    "C=DC(10)",
    "F100",
    "S1=3",
    "M3",
    "M6",
    "M30",
    "T1",
    "D1",
    "TRANS",
    "AROT",
    "RPL=30",
    "TRAORI",
    "TRAFOOF",
    "CYCLE800(1,\"\",0,57,0,0,0,30,0,0,0,0,0,1)",
    "CYCLE800()",
    "MCALL",
    "CYCLE81(10,0,2,-5)",
    "CYCLE83(10,0,1,-9,,,3,0,0,0,1,1)",
    "R1=R2+1",
    "(",
    ")",
    "=",
    ",",
    "\"",
    ";",
    "\n",
    "\r\n",
    " ",
    "%_N_A_MPF",
    "1EX5",
    "SIN(",
    "TURN=2",
    "MSG(\"a\")",
    "G70",
    "G18",
    "G93",
    "-",
    ".",
    "/",
    ":",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_is_written_is_what_moves(blocks in prop::collection::vec(block(), 1..30), blanks: bool) {
        let (text, expected) = write(&blocks, blanks);
        let records = run(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let mut cycle = None;
        let mut wanted = expected.iter();
        for record in records.iter().filter(|record| record.line > 2) {
            match &record.action {
                Action::Cycle(c) => cycle = Some(**c),
                op @ (Action::Rapid(_) | Action::Line(_) | Action::Arc(_) | Action::Hole(_)) => {
                    let want = wanted.next();
                    let fits = want.is_some_and(|want| check(want, op, cycle));
                    prop_assert!(fits, "{op:?} is not {want:?} in\n{text}");
                }
                _ => {}
            }
        }
        prop_assert!(wanted.next().is_none());
    }

    #[test]
    fn nonsense_is_refused_without_a_panic(scraps in prop::collection::vec(0..SCRAPS.len(), 0..60)) {
        let text: String = scraps.iter().map(|i| SCRAPS[*i]).collect::<Vec<_>>().join(" ");
        let _ = run(&text);
        let packed: String = scraps.iter().map(|i| SCRAPS[*i]).collect();
        let _ = run(&packed);
    }

    #[test]
    fn any_bytes_are_read_without_a_panic(bytes: Vec<u8>) {
        let _ = read(&settings(), "p.mpf", &bytes, &mut |_| Ok(()));
    }
}
