//! Random legal ISO programs in the dialects that write them alike, written by the small writer of this
//! file, and random words in all dialects.

use geom::Vec3;
use proptest::prelude::*;
use toolpost_control::{Action, Dialect, Event, Settings, Setup, read};

const DIALECTS: [Dialect; 5] =
    [Dialect::Fanuc, Dialect::Haas, Dialect::LinuxCnc, Dialect::Mach3, Dialect::Grbl];

fn run(dialect: Dialect, text: &str) -> Result<Vec<Event>, Box<program::Diagnostic>> {
    crate::common::records(&Settings::new(dialect, [true, false, true]), "t.nc", text)
}

/// A number of thousandths as a program writes it, with its point.
fn written(thousandths: i64) -> String {
    let sign = if thousandths < 0 { "-" } else { "" };
    format!("{sign}{}.{:03}", thousandths.abs() / 1000, thousandths.abs() % 1000)
}

/// A block of a random program; lengths are thousandths of the unit.
#[derive(Clone, Debug)]
enum Block {
    Straight {
        rapid: bool,
        to: [Option<i64>; 3],
        incremental: bool,
    },
    /// From `from` on the circle of a 3-4-5 triangle to another of its corners, in a plane.
    Arc {
        plane: usize,
        clockwise: bool,
        size: i64,
        from: usize,
        to: usize,
        rise: i64,
        incremental: bool,
    },
}

/// The corners of a circle of radius 5 that have whole coordinates.
const CORNERS: [[i64; 2]; 12] = [
    [5, 0],
    [4, 3],
    [3, 4],
    [0, 5],
    [-3, 4],
    [-4, 3],
    [-5, 0],
    [-4, -3],
    [-3, -4],
    [0, -5],
    [3, -4],
    [4, -3],
];

fn blocks() -> impl Strategy<Value = Vec<Block>> {
    let length = || -200_000..200_000i64;
    let straight =
        (any::<bool>(), prop::array::uniform3(prop::option::of(length())), any::<bool>())
            .prop_map(|(rapid, to, incremental)| Block::Straight { rapid, to, incremental });
    let arc = (
        0..3usize,
        any::<bool>(),
        1..5000i64,
        0..12usize,
        0..12usize,
        -5000..5000i64,
        any::<bool>(),
    )
        .prop_map(|(plane, clockwise, size, from, to, rise, incremental)| Block::Arc {
            plane,
            clockwise,
            size,
            from,
            to,
            rise,
            incremental,
        });
    prop::collection::vec(prop_oneof![straight, arc], 1..30)
}

/// What the writer reckons that a block does.
#[derive(Debug)]
enum Expected {
    Rapid([i64; 3]),
    Line([i64; 3]),
    Arc { end: [i64; 3], center: [i64; 3], normal: [f64; 3] },
}

/// The program, and where each of its moves goes.
fn write(blocks: &[Block]) -> (String, Vec<Expected>) {
    let mut text = String::from("G17 G90 G94\nG0 X0. Y0. Z0.\nF100\n");
    let mut expected = vec![Expected::Rapid([0; 3])];
    let mut at = [0i64; 3];
    let words = |letters: &[u8; 3], values: [Option<i64>; 3]| -> String {
        (0..3)
            .filter_map(|i| Some(format!(" {}{}", char::from(letters[i]), written(values[i]?))))
            .collect()
    };
    for (n, block) in blocks.iter().enumerate() {
        match *block {
            Block::Straight { rapid, to, incremental } => {
                if to == [None; 3] {
                    continue;
                }
                let target = [0, 1, 2].map(|i| match to[i] {
                    Some(value) => value + if incremental { at[i] } else { 0 },
                    None => at[i],
                });
                let (distance, motion) = (90 + i32::from(incremental), i32::from(!rapid));
                text += &format!("N{n} G{distance} G{motion}{}\n", words(b"XYZ", to));
                at = target;
                expected.push(if rapid { Expected::Rapid(at) } else { Expected::Line(at) });
            }
            Block::Arc { plane, clockwise, size, from, to, rise, incremental } => {
                let [first, second, third] = [[0, 1, 2], [2, 0, 1], [1, 2, 0]][plane];
                let (from, to) = (CORNERS[from], CORNERS[to]);
                let (mut center, mut end, mut offset) = (at, at, [None; 3]);
                for (k, axis) in [first, second].into_iter().enumerate() {
                    center[axis] -= from[k] * size;
                    offset[axis] = Some(-from[k] * size);
                    end[axis] = center[axis] + to[k] * size;
                }
                end[third] += rise;
                let words_of_end =
                    [0, 1, 2].map(|i| Some(if incremental { end[i] - at[i] } else { end[i] }));
                text += &format!(
                    "G{} G{} G{}{}{}\n",
                    17 + plane,
                    90 + i32::from(incremental),
                    if clockwise { 2 } else { 3 },
                    words(b"XYZ", words_of_end),
                    words(b"IJK", offset)
                );
                let mut normal = [0.0; 3];
                normal[third] = if clockwise { -1.0 } else { 1.0 };
                at = end;
                expected.push(Expected::Arc { end, center, normal });
            }
        }
    }
    (text, expected)
}

fn point(thousandths: [i64; 3], unit: f64) -> Vec3 {
    Vec3::from_array(thousandths.map(|v| v as f64 / 1000.0 * unit))
}

fn check(dialect: Dialect, text: &str, expected: &[Expected], unit: f64) {
    let records = run(dialect, text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let moves: Vec<&Action> =
        records.iter().map(|record| &record.action).filter(|op| op.position().is_some()).collect();
    assert_eq!(moves.len(), expected.len());
    for (op, expected) in moves.into_iter().zip(expected) {
        let near = |a: Vec3, b: [i64; 3]| a.distance(point(b, unit)) < 1e-6;
        let agrees = match (op, expected) {
            (Action::Rapid(pose), Expected::Rapid(end)) => near(pose.point, *end),
            (Action::Line(pose), Expected::Line(end)) => near(pose.point, *end),
            (Action::Arc(arc), Expected::Arc { end, center, normal }) => {
                // The centre may be any point of the axis.
                let along = Vec3::from_array(*normal);
                near(arc.end.point, *end)
                    && (arc.center - point(*center, unit)).cross(along).length() < 1e-6
                    && arc.normal == along
            }
            _ => false,
        };
        assert!(agrees, "{dialect:?} {op:?} {expected:?}\n{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn a_program_goes_where_its_writer_reckoned(blocks in blocks()) {
        let (text, expected) = write(&blocks);
        for dialect in DIALECTS {
            check(dialect, &format!("G21\n{text}"), &expected, 1.0);
            check(dialect, &format!("G20\n{text}"), &expected, 25.4);
        }
    }

    #[test]
    fn any_words_are_refused_or_run_but_never_panic(
        known in any::<bool>(),
        blocks in prop::collection::vec(
            prop::collection::vec((prop::sample::select(LETTERS), prop_oneof![
                Just(String::new()),
                (0..200u32).prop_map(|n| n.to_string()),
                (0..2000u32).prop_map(|n| format!("{}.{}", n / 10, n % 10)),
                (-99_999..99_999i64).prop_map(written),
            ]), 0..6),
            0..20,
        )
    ) {
        let line = |words: &Vec<(u8, String)>| -> String {
            words.iter().map(|(letter, number)| format!("{}{number}", char::from(*letter))).collect()
        };
        let text: String = blocks.iter().map(|words| line(words) + "\n").collect();
        let setup = Setup { start: known.then_some(Vec3::ZERO), ..Setup::default() };
        for dialect in DIALECTS.into_iter().chain([Dialect::Marlin]) {
            let settings = Settings { setup: setup.clone(), ..Settings::new(dialect, [true; 3]) };
            if let Err(error) = read(&settings, "t.nc", text.as_bytes(), &mut |_| Ok(())) {
                prop_assert!(error.line > 0 && !error.message.is_empty());
            }
        }
    }

    /// Legal blocks one after the other get farther than random words.
    #[test]
    fn any_blocks_are_refused_or_run_but_never_panic(
        blocks in prop::collection::vec(prop::sample::select(BLOCKS), 1..12)
    ) {
        let text = format!("G21\nG90\nS100 M3\nF100\nG0 X1. Y2. Z30.\n{}\n", blocks.join("\n"));
        let setup = Setup { start: Some(Vec3::ZERO), ..Setup::default() };
        for dialect in DIALECTS.into_iter().chain([Dialect::Marlin]) {
            let settings = Settings { setup: setup.clone(), ..Settings::new(dialect, [true; 3]) };
            // What a dialect does not know is left out, so that the rest is tried.
            let mut kept: Vec<&str> = text.lines().collect();
            while let Err(error) = read(&settings, "t.nc", kept.join("\n").as_bytes(), &mut sound) {
                let line = error.line as usize;
                prop_assert!((1..=kept.len()).contains(&line), "{error}");
                kept.remove(line - 1);
            }
        }
    }
}

/// What holds for every record.
fn sound(record: Event) -> Result<(), Box<program::Diagnostic>> {
    match &record.action {
        Action::Arc(arc) => {
            assert!(arc.end.point.is_finite() && arc.center.is_finite(), "{arc:?}");
            assert!((arc.normal.length() - 1.0).abs() < 1e-9, "{arc:?}");
        }
        Action::Hole(pose) => assert!(pose.point.is_finite(), "{pose:?}"),
        Action::Cycle(cycle) => assert!(cycle.depth > 0.0 && cycle.retract >= 0.0, "{cycle:?}"),
        _ => {}
    }
    Ok(())
}

/// What a word may begin with.
const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZ/(;%#@^$[";

/// Blocks that mean something to one dialect or another.
const BLOCKS: &[&str] = &[
    "G1 X5. Y6.",
    "G0 Z-3.",
    "G2 X10. Y2. R20.",
    "G3 I5. J0.",
    "G91",
    "G90",
    "G17",
    "G18",
    "G19",
    "G7",
    "G8",
    "G10 L2 P1 X5. Y5.",
    "G10 L2 P2 X5. R30.",
    "G10 L20 P1 X0 Z1.",
    "G10 L20 P2 X0",
    "G10 L1 P1 Z20.",
    "G10 L10 P1 R20.",
    "G92 X0 Y0",
    "G92.1",
    "G92.2",
    "G92.3",
    "G52 X5. Y5.",
    "G54",
    "G55",
    "G59.3",
    "G54.1 P5",
    "G154 P5",
    "G68 X1. Y1. R30.",
    "G68 A1 B1 R30",
    "G69",
    "G51 X0 Y0 Z0 P2.",
    "G51 X2 Y2",
    "G50",
    "G51.1 X5.",
    "G50.1 X0",
    "G101 X0",
    "G100 X0",
    "G16",
    "G15",
    "X10. Y30.",
    "@10 ^30",
    "^60",
    "G98",
    "G99",
    "G81 X1. Y1. Z-5. R2.",
    "G83 X2. Z-5. R2. Q1.",
    "G84 X3. Z-5. R2.",
    "G88 X3. Z-5. R2. P1",
    "X5. L3",
    "X5. K3",
    "G70 I5. J0 L6",
    "G72 I5. J30. L6",
    "G80",
    "G12 I5",
    "G28 X0",
    "G28.1",
    "G29 X1. Z1.",
    "G30 Z0",
    "G31 Z-5.",
    "G33 Z-9. K1.",
    "G33 Z-9. F1.",
    "G33 Z-9. F50.",
    "G33.1 Z-9. K1.",
    "G38.2 Z-9.",
    "G5 X9. Y9. I1. J2. P-3. Q0",
    "G5.1 X9. Y9. I1. J2.",
    "G41 D1",
    "G40",
    "G43 H1",
    "G43.1 Z5.",
    "G43.4 H1",
    "G49",
    "G53 G0 X0",
    "G60 X5.",
    "G68.2 X0 Y0 Z0 I0 J45. K0",
    "G53.1",
    "G93 F2.",
    "G94 F100.",
    "A30. C20.",
    "T1 M6",
    "M61 Q2",
    "M7",
    "M8",
    "M9",
    "M19",
    "M5",
    "M3",
    "M0",
    "M2",
    "G20",
    "G21",
    "G92 X0 Y0 Z0",
    "F100",
];
