//! Random legal Klartext programs, written by the small writer of this file, and random bytes.

use geom::Vec3;
use program::Feed;
use proptest::prelude::*;
use toolpost_control::{Action, Dialect, Event, Settings, read};

fn run(text: &str) -> Vec<Event> {
    let records = crate::common::klartext::read_on([false; 3], text.as_bytes());
    records.unwrap_or_else(|error| panic!("{error}\n{text}"))
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
            match record.action {
                Action::Feed(Feed::PerMinute(f)) => feed = f,
                Action::Rapid(pose) => {
                    let Some(Expected::Rapid(to)) = expected.next() else { panic!("{text}") };
                    prop_assert!(pose.point.distance(*to) < 1e-6, "{text}");
                    here = pose.point;
                }
                Action::Line(pose) => {
                    let Some(Expected::Line(to, f)) = expected.next() else { panic!("{text}") };
                    prop_assert!(pose.point.distance(*to) < 1e-6 && feed == *f, "{text}");
                    here = pose.point;
                }
                Action::Arc(arc) => {
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
        let first = |text: String| run(&text)[0].action.position().unwrap().point;
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
                "TZ+0", "LBL", "1", "REP", "2", "Q1", "Q1=", "QS1", "=", "+3", "SIN", "(", ")", "||", "FN", "1:",
                "9:", "IF", "EQU", "GOTO", "RND", "R5", "CHF", "CT", "CTP", "IX+5", "Y+9", "APPR", "DEP",
                "LT", "LCT", "LEN5", "CCA90", "8.0", "8.1", "10.0", "10.1", "ROT+9", "11.1", "SCL2", "26.1",
                "TRANS", "DATUM", "AXIS", "PATTERN", "POS1", "(X+1", "Y+2)", "PAT", "220", "221", "Q241=3",
                "EULER", "POINTS", "RELATIV", "PGM", "A.H", "1,5", "/", "^",
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

/// A formula, and what it comes to.
#[derive(Clone, Debug)]
enum Formula {
    Number(i64),
    Parameter(usize),
    Negative(Box<Formula>),
    Function(&'static str, Box<Formula>),
    Between(char, Box<Formula>, Box<Formula>),
}

/// What Q1 to Q3 hold.
const HELD: [f64; 3] = [2.5, -0.75, 31.0];

fn formula() -> impl Strategy<Value = Formula> {
    let leaf = prop_oneof![
        (0i64..1_000_000).prop_map(Formula::Number),
        (0usize..3).prop_map(Formula::Parameter),
    ];
    leaf.prop_recursive(5, 40, 2, |inner| {
        let name =
            prop::sample::select(&["SIN", "COS", "SQ", "ABS", "NEG", "INT", "FRAC", "ATAN"][..]);
        let sign = prop::sample::select(&['+', '-', '*', '/'][..]);
        prop_oneof![
            inner.clone().prop_map(|f| Formula::Negative(f.into())),
            (name, inner.clone()).prop_map(|(name, f)| Formula::Function(name, f.into())),
            (sign, inner.clone(), inner).prop_map(|(sign, f, g)| Formula::Between(
                sign,
                f.into(),
                g.into()
            )),
        ]
    })
}

impl Formula {
    /// How it is written; in parentheses where it binds less than what is around it (1 sum, 2 product,
    /// 3 value).
    fn text(&self, around: u32) -> String {
        let (binds, text) = match self {
            Formula::Number(ticks) => (3, written(*ticks)[1..].to_owned()),
            Formula::Parameter(index) => (3, format!("Q{}", index + 1)),
            Formula::Negative(f) => (3, format!("-{}", f.text(3))),
            Formula::Function(name, f) => (3, format!("{name} {}", f.text(3))),
            Formula::Between(sign, f, g) => {
                let binds = if "+-".contains(*sign) { 1 } else { 2 };
                (binds, format!("{} {sign} {}", f.text(binds), g.text(binds + 1)))
            }
        };
        if binds < around { format!("({text})") } else { text }
    }

    fn value(&self) -> f64 {
        match self {
            Formula::Number(ticks) => *ticks as f64 / 1e4,
            Formula::Parameter(index) => HELD[*index],
            Formula::Negative(f) => -f.value(),
            Formula::Function(name, f) => {
                let x = f.value();
                match *name {
                    "SIN" => x.to_radians().sin(),
                    "COS" => x.to_radians().cos(),
                    "SQ" => x * x,
                    "ABS" => x.abs(),
                    "NEG" => -x,
                    "INT" => x.trunc(),
                    "FRAC" => x - x.trunc(),
                    _ => x.atan().to_degrees(),
                }
            }
            Formula::Between(sign, f, g) => match sign {
                '+' => f.value() + g.value(),
                '-' => f.value() - g.value(),
                '*' => f.value() * g.value(),
                _ => f.value() / g.value(),
            },
        }
    }
}

/// A part of a program that moves by steps.
#[derive(Clone, Debug)]
enum Part {
    Step(i64),
    Repeat(u32, Vec<Part>),
    /// A loop that counts a parameter of its own down.
    Count(u32, Vec<Part>),
    Call(usize),
}

fn parts() -> impl Strategy<Value = Vec<Part>> {
    let leaf = prop_oneof![
        (-1_000_000i64..1_000_000).prop_map(Part::Step),
        (0usize..3).prop_map(Part::Call),
    ];
    let part = leaf.prop_recursive(3, 30, 4, |inner| {
        let inner = prop::collection::vec(inner, 0..4);
        prop_oneof![
            (1u32..4, inner.clone()).prop_map(|(n, parts)| Part::Repeat(n, parts)),
            (1u32..4, inner).prop_map(|(n, parts)| Part::Count(n, parts)),
        ]
    });
    prop::collection::vec(part, 1..6)
}

/// Writes parts as blocks; labels and counters are numbered through.
fn write_parts(parts: &[Part], number: &mut u32, blocks: &mut Vec<String>) {
    for part in parts {
        match part {
            Part::Step(step) => blocks.push(format!("L IX{} FMAX", written(*step))),
            Part::Call(index) => blocks.push(format!("CALL LBL \"S{index}\"")),
            Part::Repeat(times, parts) => {
                *number += 1;
                let label = *number;
                blocks.push(format!("LBL {label}"));
                write_parts(parts, number, blocks);
                blocks.push(format!("CALL LBL {label} REP {times}"));
            }
            Part::Count(times, parts) => {
                *number += 1;
                let label = *number;
                blocks.push(format!("FN 0: Q{} = +{times}", 200 + label));
                blocks.push(format!("LBL {label}"));
                write_parts(parts, number, blocks);
                blocks.push(format!("Q{0} = Q{0} - 1", 200 + label));
                blocks.push(format!("FN 11: IF +Q{} GT +0 GOTO LBL {label}", 200 + label));
            }
        }
    }
}

/// Where the steps of parts lead.
fn follow(parts: &[Part], subprograms: &[Vec<Part>; 3], at: &mut i64, reached: &mut Vec<i64>) {
    for part in parts {
        match part {
            Part::Step(step) => {
                *at += step;
                reached.push(*at);
            }
            Part::Call(index) => follow(&subprograms[*index], subprograms, at, reached),
            Part::Repeat(times, parts) => {
                (0..=*times).for_each(|_| follow(parts, subprograms, at, reached));
            }
            Part::Count(times, parts) => {
                (0..*times).for_each(|_| follow(parts, subprograms, at, reached));
            }
        }
    }
}

/// A subprogram calls only those behind it, so that there is an end.
fn forward(parts: Vec<Part>, from: usize) -> Vec<Part> {
    let inner = |part| match part {
        Part::Call(index) if index < from => Part::Step(1),
        Part::Repeat(n, parts) => Part::Repeat(n, forward(parts, from)),
        Part::Count(n, parts) => Part::Count(n, forward(parts, from)),
        part => part,
    };
    parts.into_iter().map(inner).collect()
}

fn numbered(blocks: &[String]) -> String {
    let mut text = String::from("0 BEGIN PGM T MM\n");
    for (i, block) in blocks.iter().enumerate() {
        text += &format!("{} {block}\n", i + 1);
    }
    text + &format!("{} END PGM T MM\n", blocks.len() + 1)
}

proptest! {
    #[test]
    fn a_formula_comes_to_what_its_writer_calculated(formula in formula()) {
        let expected = formula.value();
        prop_assume!(expected.is_finite() && expected.abs() < 1e9);
        let mut blocks: Vec<String> =
            HELD.iter().enumerate().map(|(i, value)| format!("Q{} = {value}", i + 1)).collect();
        blocks.push(format!("Q9 = {}", formula.text(0)));
        blocks.push("L X+Q9 FMAX".into());
        let settings = Settings::new(Dialect::Klartext, [false; 3]);
        let mut found = None;
        let text = numbered(&blocks);
        let result = read(&settings, "t.h", text.as_bytes(), &mut |record| {
            found = found.or(record.action.position().map(|pose| pose.point.x));
            Ok(())
        });
        match result {
            // The control reckons division by zero within a formula as an error, doubles do not.
            Err(error) => prop_assert!(text.contains('/') && error.rule == "expression", "{error}"),
            Ok(()) => {
                let found = found.unwrap();
                prop_assert!((found - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{found} {expected}\n{text}");
            }
        }
    }

    #[test]
    fn loops_and_calls_lead_where_their_writer_followed_them(
        main in parts(), a in parts(), b in parts(), c in parts(),
    ) {
        let subprograms = [forward(a, 1), forward(b, 2), forward(c, 3)];
        let (mut number, mut blocks) = (0, vec!["L X+0 FMAX".to_owned()]);
        write_parts(&main, &mut number, &mut blocks);
        blocks.push("M30".into());
        for (i, parts) in subprograms.iter().enumerate() {
            blocks.push(format!("LBL \"S{i}\""));
            write_parts(parts, &mut number, &mut blocks);
            blocks.push("LBL 0".into());
        }
        let mut reached = Vec::new();
        follow(&main, &subprograms, &mut 0, &mut reached);
        prop_assume!(reached.len() < 20_000);
        let text = numbered(&blocks);
        let found: Vec<f64> =
            run(&text).iter().filter_map(|record| record.action.position().map(|pose| pose.point.x)).collect();
        prop_assert_eq!(found.len(), reached.len() + 1);
        for (x, ticks) in found[1..].iter().zip(&reached) {
            prop_assert!((x - *ticks as f64 / 1e4).abs() < 1e-6, "{} {}\n{}", x, ticks, text);
        }
    }

    #[test]
    fn a_rounded_corner_touches_both_lines(
        first in 1f64..100.0, second in 1f64..100.0, heading in 0f64..360.0, bend in 1f64..179.0,
        left in any::<bool>(), part in 0.01f64..0.99,
    ) {
        let bend = if left { bend } else { -bend };
        let toward = |degrees: f64| Vec3::new(degrees.to_radians().cos(), degrees.to_radians().sin(), 0.0);
        let corner = toward(heading) * first;
        let end = corner + toward(heading + bend) * second;
        // The tangent of half the bend is what a radius takes of each line.
        let take = part * first.min(second);
        let radius = take / (bend.abs().to_radians() / 2.0).tan();
        prop_assume!(radius < 1e5);
        let text = numbered(&[
            "L X+0 Y+0 Z+0 R0 FMAX".into(),
            format!("L X{:+.9} Y{:+.9} F100", corner.x, corner.y),
            format!("RND R{radius:.9}"),
            format!("L X{:+.9} Y{:+.9}", end.x, end.y),
        ]);
        let arc = run(&text).iter().find_map(|record| match &record.action {
            Action::Arc(arc) => Some(**arc),
            _ => None,
        }).unwrap();
        let start = corner - toward(heading) * take;
        prop_assert!(arc.end.point.distance(corner + toward(heading + bend) * take) < 1e-4, "{text}");
        prop_assert!((arc.center.distance(start) - radius).abs() < 1e-4 * (1.0 + radius), "{text}");
        prop_assert_eq!(arc.normal.z > 0.0, left);
        let spoke = (arc.center - start).normalize();
        prop_assert!(spoke.dot(toward(heading)).abs() < 1e-4, "{text}");
    }

    #[test]
    fn transformations_lead_where_their_writer_reckoned(
        shift in prop::array::uniform2(-1000f64..1000.0), angle in -359f64..359.0,
        mirror in prop::array::uniform2(any::<bool>()), factor in 0.01f64..50.0,
        point in prop::array::uniform2(-1000f64..1000.0),
    ) {
        let axes = [mirror[0].then_some(" X"), mirror[1].then_some(" Y")];
        let text = numbered(&[
            "CYCL DEF 7.0 DATUM".into(),
            format!("CYCL DEF 7.1 X{:+.6}", shift[0]),
            format!("CYCL DEF 7.2 Y{:+.6}", shift[1]),
            "CYCL DEF 8.0 MIRROR".into(),
            format!("CYCL DEF 8.1{}{}", axes[0].unwrap_or(""), axes[1].unwrap_or("")),
            "CYCL DEF 10.0 ROTATION".into(),
            format!("CYCL DEF 10.1 ROT{angle:+.6}"),
            "CYCL DEF 11.0 SCALING".into(),
            format!("CYCL DEF 11.1 SCL{factor:.6}"),
            format!("L X{:+.6} Y{:+.6} Z+0 FMAX", point[0], point[1]),
        ]);
        // From the inside out: scaled, turned, mirrored, shifted.
        let (sin, cos) = angle.to_radians().sin_cos();
        let (x, y) = (point[0] * factor, point[1] * factor);
        let (x, y) = (x * cos - y * sin, x * sin + y * cos);
        let sign = |flag| if flag { -1.0 } else { 1.0 };
        let expected =
            Vec3::new(x * sign(mirror[0]) + shift[0], y * sign(mirror[1]) + shift[1], 0.0);
        let found = run(&text)[0].action.position().unwrap().point;
        prop_assert!(found.distance(expected) < 1e-2, "{found} {expected}\n{text}");
    }
}
