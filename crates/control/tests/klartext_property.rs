//! Random legal Klartext programs, written by the small writer of this file, and random bytes.

use geom::Vec3;
use program::{Feed, Op, Record};
use proptest::prelude::*;
use toolpost_control::{Dialect, Settings, read};

fn run(text: &str) -> Vec<Record> {
    let settings = Settings::new(Dialect::Klartext, [false; 3]);
    let mut records = Vec::new();
    let sink = &mut |record| {
        records.push(record);
        Ok(())
    };
    read(&settings, "t.h", text.as_bytes(), sink).unwrap_or_else(|error| panic!("{error}\n{text}"));
    records
}

/// A number of ten-thousandths, and how a program writes it.
fn written(ticks: i64) -> String {
    format!(
        "{}{}.{:04}",
        if ticks < 0 { '-' } else { '+' },
        ticks.abs() / 10_000,
        ticks.abs() % 10_000
    )
}

/// One block of a random program. Lengths are ten-thousandths of a mm, angles ten-thousandths of a
/// degree.
#[derive(Clone, Debug)]
enum Block {
    Rapid {
        to: [i64; 3],
        incremental: [bool; 3],
    },
    Line {
        to: [i64; 3],
        incremental: [bool; 3],
        feed: u32,
    },
    /// About a pole, so far from the tool, by an angle.
    Helix {
        pole: [i64; 2],
        angle: i64,
        rise: i64,
    },
    /// By a chord and a radius so many times half of it.
    Radius {
        chord: [i64; 2],
        factor: f64,
        long: bool,
        left: bool,
    },
}

fn block() -> impl Strategy<Value = Block> {
    let length = -5_000_000i64..5_000_000;
    let point = prop::array::uniform3(length.clone());
    let flags = prop::array::uniform3(any::<bool>());
    prop_oneof![
        (point.clone(), flags).prop_map(|(to, incremental)| Block::Rapid { to, incremental }),
        (point, flags, 1u32..20_000).prop_map(|(to, incremental, feed)| Block::Line {
            to,
            incremental,
            feed
        }),
        (
            prop::array::uniform2(10_000i64..1_000_000),
            prop_oneof![1_000_000i64..20_000_000, -20_000_000i64..-1_000_000],
            length.clone()
        )
            .prop_map(|(pole, angle, rise)| Block::Helix { pole, angle, rise }),
        (prop::array::uniform2(10_000i64..1_000_000), 1.01f64..5.0, any::<bool>(), any::<bool>())
            .prop_map(|(chord, factor, long, left)| Block::Radius { chord, factor, long, left }),
    ]
}

/// What a block must have done.
#[derive(Debug)]
enum Expected {
    Rapid(Vec3),
    Line(Vec3, f64),
    Arc { end: Vec3, center: Vec3, left: bool, sweep: f64 },
}

/// Writes blocks and reckons, with its own arithmetic, where they lead.
fn write(blocks: &[Block]) -> (String, Vec<Expected>) {
    let mut text = String::from("0 BEGIN PGM T MM\n1 L X+0 Y+0 Z+0 R0 FMAX\n2 L X+0 F500\n");
    let mut number = 3;
    let mut here = Vec3::ZERO;
    let mut feed = 500.0;
    let mut expected = vec![Expected::Rapid(here), Expected::Line(here, feed)];
    let mut put = |block: String| {
        text += &format!("{number} {block}\n");
        number += 1;
    };
    let length = |ticks: i64| ticks as f64 * 1e-4;
    for block in blocks {
        let words = |to: &[i64; 3], incremental: &[bool; 3]| -> String {
            (0..3)
                .map(|i| {
                    let sign = if incremental[i] { "I" } else { "" };
                    format!(" {sign}{}{}", ["X", "Y", "Z"][i], written(to[i]))
                })
                .collect()
        };
        let go = |here: &mut Vec3, to: &[i64; 3], incremental: &[bool; 3]| {
            for i in 0..3 {
                here[i] = length(to[i]) + if incremental[i] { here[i] } else { 0.0 };
            }
        };
        match block {
            Block::Rapid { to, incremental } => {
                put(format!("L{} R0 FMAX", words(to, incremental)));
                go(&mut here, to, incremental);
                expected.push(Expected::Rapid(here));
            }
            Block::Line { to, incremental, feed: f } => {
                put(format!("L{} F{f}", words(to, incremental)));
                go(&mut here, to, incremental);
                feed = f64::from(*f);
                expected.push(Expected::Line(here, feed));
            }
            Block::Helix { pole, angle, rise } => {
                put(format!("CC IX{} IY{}", written(pole[0]), written(pole[1])));
                let turn = if *angle > 0 { '+' } else { '-' };
                put(format!("CP IPA{} IZ{} DR{turn}", written(*angle), written(*rise)));
                let spoke = Vec3::new(length(pole[0]), length(pole[1]), 0.0);
                let center = here + spoke;
                let sweep = length(*angle).to_radians();
                let (sin, cos) = sweep.sin_cos();
                here = center
                    + Vec3::new(
                        -spoke.x * cos + spoke.y * sin,
                        -spoke.x * sin - spoke.y * cos,
                        length(*rise),
                    );
                expected.push(Expected::Arc {
                    end: here,
                    center,
                    left: *angle > 0,
                    sweep: sweep.abs(),
                });
            }
            Block::Radius { chord, factor, long, left } => {
                let along = Vec3::new(length(chord[0]), length(chord[1]), 0.0);
                let radius = (along.length() / 2.0 * factor * 1e4).round() as i64;
                let sign = if *long { '-' } else { '+' };
                put(format!(
                    "CR IX{} IY{} R{sign}{} DR{}",
                    written(chord[0]),
                    written(chord[1]),
                    &written(radius)[1..],
                    if *left { '+' } else { '-' }
                ));
                // The angle between a chord and the tangent at its end is half of that at the center.
                let short = 2.0 * (along.length() / 2.0 / length(radius)).asin();
                let sweep = if *long { std::f64::consts::TAU - short } else { short };
                let to_tangent = if *left { -sweep / 2.0 } else { sweep / 2.0 };
                let tangent = geom::rotate(along.normalize(), Vec3::Z, to_tangent);
                let inward = if *left { Vec3::Z } else { Vec3::NEG_Z }.cross(tangent);
                let center = here + inward * length(radius);
                here += along;
                expected.push(Expected::Arc { end: here, center, left: *left, sweep });
            }
        }
    }
    put("END PGM T MM".into());
    (text, expected)
}

proptest! {
    #[test]
    fn a_program_goes_where_its_writer_reckoned(blocks in prop::collection::vec(block(), 1..40)) {
        let (text, expected) = write(&blocks);
        let mut feed = 0.0;
        let mut here = Vec3::ZERO;
        let mut expected = expected.iter();
        for record in run(&text) {
            match record.op {
                Op::Feed(Feed::PerMinute(f)) => feed = f,
                Op::Rapid(pose) => {
                    let Some(Expected::Rapid(to)) = expected.next() else { panic!("{text}") };
                    prop_assert!(pose.point.distance(*to) < 1e-6, "{text}");
                    here = pose.point;
                }
                Op::Line(pose) => {
                    let Some(Expected::Line(to, f)) = expected.next() else { panic!("{text}") };
                    prop_assert!(pose.point.distance(*to) < 1e-6 && feed == *f, "{text}");
                    here = pose.point;
                }
                Op::Arc(arc) => {
                    let Some(Expected::Arc { end, center, left, sweep }) = expected.next() else {
                        panic!("{text}")
                    };
                    let path = geom::Arc::new(
                        here, arc.end.point, arc.center, arc.normal, arc.turns, 0.016,
                    ).unwrap();
                    prop_assert!(arc.end.point.distance(*end) < 1e-6, "{text}");
                    prop_assert!((arc.center - *center).truncate().length() < 1e-5, "{text}");
                    prop_assert_eq!(arc.normal.z > 0.0, *left);
                    prop_assert!((path.sweep - sweep).abs() < 1e-6, "{} {}\n{}", path.sweep, sweep, text);
                    here = arc.end.point;
                }
                _ => {}
            }
        }
        prop_assert!(expected.next().is_none());
    }

    #[test]
    fn an_inch_program_is_the_metric_one_twenty_five_point_four_times_as_large(
        to in prop::array::uniform3(-100_000i64..100_000),
    ) {
        let body = |unit| format!(
            "0 BEGIN PGM T {unit}\n1 L X{} Y{} Z{} FMAX\n2 END PGM T {unit}\n",
            written(to[0]), written(to[1]), written(to[2]),
        );
        let first = |text: String| run(&text)[0].op.pose().unwrap().point;
        prop_assert!(first(body("INCH")).distance(first(body("MM")) * 25.4) < 1e-9);
    }

    #[test]
    fn any_words_are_refused_or_run_but_never_panic(
        words in prop::collection::vec(
            prop::sample::select(&[
                "L", "C", "CC", "CR", "CP", "LP", "LN", "X+1", "IY-2", "Z", "B+30", "R0", "RL", "R+5",
                "DR+", "DR-", "FMAX", "F100", "M3", "M99", "M91", "M128", "M140", "MB", "MAX", "TOOL",
                "CALL", "DEF", "5", "S100", "CYCL", "200", "7.0", "7.1", "9.1", "~", "\n", "Q200=2",
                "PLANE", "SPATIAL", "SPA+1", "SPB+2", "SPC+3", "TURN", "STAY", "RESET", "TX+1", "TY+0",
                "TZ+0", ";", "\"", "PA+9", "IPA-9", "PR+3", "99999999999999999999", "-", ".", "\0", "é",
            ][..]),
            0..30,
        ),
    ) {
        let text = format!("0 BEGIN PGM T MM\n1 {}\n2 END PGM T MM", words.join(" "));
        let settings =
            Settings::new(Dialect::Klartext, [false, true, true]);
        if let Err(error) = read(&settings, "t.h", text.as_bytes(), &mut |_| Ok(())) {
            prop_assert!(error.line > 0 && error.column > 0 && !error.message.is_empty());
        }
    }
}
