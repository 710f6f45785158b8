//! Random legal ISO programs in all three flavours, written by the small writer of this file, and
//! random words.

use geom::Vec3;
use program::{Op, Record};
use proptest::prelude::*;
use toolpost_control::{Dialect, Settings, read};

const FLAVORS: [Dialect; 3] = [Dialect::Fanuc, Dialect::LinuxCnc, Dialect::Grbl];

fn run(dialect: Dialect, text: &str) -> Result<Vec<Record>, Box<program::Diagnostic>> {
    let settings = Settings::new(dialect, [true, false, true]);
    let mut records = Vec::new();
    read(&settings, "t.nc", text.as_bytes(), &mut |record| {
        records.push(record);
        Ok(())
    })?;
    Ok(records)
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
    let moves: Vec<&Op> =
        records.iter().map(|record| &record.op).filter(|op| op.pose().is_some()).collect();
    assert_eq!(moves.len(), expected.len());
    for (op, expected) in moves.into_iter().zip(expected) {
        let near = |a: Vec3, b: [i64; 3]| a.distance(point(b, unit)) < 1e-6;
        let agrees = match (op, expected) {
            (Op::Rapid(pose), Expected::Rapid(end)) => near(pose.point, *end),
            (Op::Line(pose), Expected::Line(end)) => near(pose.point, *end),
            (Op::Arc(arc), Expected::Arc { end, center, normal }) => {
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
        for dialect in FLAVORS {
            check(dialect, &format!("G21\n{text}"), &expected, 1.0);
            check(dialect, &format!("G20\n{text}"), &expected, 25.4);
        }
    }

    #[test]
    fn any_words_are_refused_or_run_but_never_panic(
        blocks in prop::collection::vec(
            prop::collection::vec((prop::sample::select(&b"ABCDFGHIJKLMNOPQRSTXYZ/(;%#"[..]), prop_oneof![
                Just(String::new()),
                (0..100u32).prop_map(|n| n.to_string()),
                (-99_999..99_999i64).prop_map(written),
            ]), 0..6),
            0..20,
        )
    ) {
        let line = |words: &Vec<(u8, String)>| -> String {
            words.iter().map(|(letter, number)| format!("{}{number}", char::from(*letter))).collect()
        };
        let text: String = blocks.iter().map(|words| line(words) + "\n").collect();
        for dialect in FLAVORS {
            if let Err(error) = run(dialect, &text) {
                prop_assert!(error.line > 0 && !error.message.is_empty());
            }
        }
    }
}
