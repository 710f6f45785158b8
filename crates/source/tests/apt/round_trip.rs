//! Any program, written as cutter-location data, is read back as it was.

use geom::{Frame, Vec3};
use program::{Compensation, Coolant, Feed, Op, Pose, Spindle};
use proptest::prelude::*;
use std::fmt::Write as _;
use toolpost_source::apt::{Options, read};

/// How a file writes what it says.
#[derive(Clone, Copy, Debug)]
struct Style {
    inches: bool,
    blanks: bool,
    /// Break statements after every comma.
    broken: bool,
    line_end: &'static str,
    /// Vector in every `GOTO`, or only where it changes.
    axis_always: bool,
}

fn style() -> impl Strategy<Value = Style> {
    let line_end = prop_oneof![Just("\n"), Just("\r\n"), Just("\r")];
    (any::<[bool; 4]>(), line_end).prop_map(|([inches, blanks, broken, axis_always], line_end)| {
        Style { inches, blanks, broken, line_end, axis_always }
    })
}

fn op() -> impl Strategy<Value = Op> {
    let coordinate = || (-10_000_000..10_000_000i32).prop_map(|v| f64::from(v) / 10_000.0);
    let point = (coordinate(), coordinate(), coordinate());
    let part = || -1000..1000i32;
    let axis = (part(), part(), 1..1000i32)
        .prop_map(|(i, j, k)| Vec3::new(f64::from(i), f64::from(j), f64::from(k)).normalize());
    let axis = prop_oneof![3 => Just(Vec3::Z), 1 => axis];
    let pose =
        (point, axis).prop_map(|((x, y, z), axis)| Pose::new(Vec3::new(x, y, z), axis).unwrap());
    let value = || (1..1_000_000i32).prop_map(|v| f64::from(v) / 100.0);
    prop_oneof![
        8 => pose.clone().prop_map(Op::Line),
        3 => pose.prop_map(Op::Rapid),
        1 => value().prop_map(|f| Op::Feed(Feed::PerMinute(f))),
        1 => value().prop_map(|f| Op::Feed(Feed::PerTurn(f))),
        1 => value().prop_map(|f| Op::Feed(Feed::InverseTime(f))),
        1 => value().prop_map(|s| Op::Spindle(Spindle::Clockwise(s))),
        1 => value().prop_map(|s| Op::Spindle(Spindle::CounterClockwise(s))),
        1 => prop_oneof![Just(Coolant::Off), Just(Coolant::Flood), Just(Coolant::Mist)]
            .prop_map(Op::Coolant),
        1 => (1..99u32).prop_map(|d| Op::Compensation(Compensation::Left(Some(d)))),
        1 => Just(Op::Compensation(Compensation::Off)),
        1 => value().prop_map(Op::Dwell),
        1 => Just(Op::Stop),
        1 => "[A-Za-z][A-Za-z0-9 ,/$]{0,30}[a-z]".prop_map(|text| Op::Comment(text.into())),
    ]
}

/// The text of `ops` in the frame `setup` and in `style`.
fn write(ops: &[Op], style: Style, setup: &Frame) -> String {
    let unit = if style.inches { 25.4 } else { 1.0 };
    let mut axis = Vec3::Z;
    let mut text = String::new();
    let mut statement = |words: String| {
        let slash = if style.blanks { " / " } else { "/" };
        let comma = match (style.broken, style.blanks) {
            (true, _) => ",$\n",
            (false, true) => " , ",
            (false, false) => ",",
        };
        let line = match words.starts_with("PPRINT") {
            true => words,
            false => words.replacen('/', slash, 1).replace(',', comma),
        };
        let _ = writeln!(text, "{line}");
    };
    statement(format!("UNITS/{}", if style.inches { "INCHES" } else { "MM" }));
    for word in ["LOAD/TOOL,1", "SPINDL/1,RPM,CLW", "FEDRAT/1,MMPM", "PAINT/PATH"] {
        statement(word.into());
    }
    for frame in [&Frame::IDENTITY, setup] {
        let (o, x, y) = (frame.translation / unit, frame.matrix3.x_axis, frame.matrix3.y_axis);
        statement(format!(
            "MSYS/{},{},{},{},{},{},{},{},{}",
            o.x, o.y, o.z, x.x, x.y, x.z, y.x, y.y, y.z
        ));
    }
    let local = setup.inverse();
    for op in ops {
        match op {
            Op::Line(pose) | Op::Rapid(pose) => {
                if matches!(op, Op::Rapid(_)) {
                    statement("RAPID".into());
                }
                let p = local.transform_point3(pose.point()) / unit;
                let a = local.transform_vector3(pose.axis());
                let mut line = format!("GOTO/{},{},{}", p.x, p.y, p.z);
                if style.axis_always || a.distance(axis) > 1e-12 {
                    let _ = write!(line, ",{},{},{}", a.x, a.y, a.z);
                    axis = a;
                }
                statement(line);
            }
            Op::Feed(Feed::PerMinute(f)) => statement(format!("FEDRAT/{f},MMPM")),
            Op::Feed(Feed::PerTurn(f)) => statement(format!("FEDRAT/MMPR,{f}")),
            Op::Feed(Feed::InverseTime(f)) => statement(format!("FEDRAT/INVERS,{f}")),
            Op::Spindle(Spindle::Clockwise(s)) => statement(format!("SPINDL/RPM,{s},CLW")),
            Op::Spindle(Spindle::CounterClockwise(s)) => statement(format!("SPINDL/{s},RPM,CCLW")),
            Op::Coolant(Coolant::Flood) => statement("COOLNT/FLOOD".into()),
            Op::Coolant(Coolant::Mist) => statement("COOLNT/MIST".into()),
            Op::Coolant(_) => statement("COOLNT/OFF".into()),
            Op::Compensation(Compensation::Left(Some(d))) => statement(format!("CUTCOM/LEFT,{d}")),
            Op::Compensation(_) => statement("CUTCOM/OFF".into()),
            Op::Dwell(t) => statement(format!("DELAY/{t}")),
            Op::Stop => statement("STOP".into()),
            Op::Comment(words) => statement(format!("PPRINT/{words}")),
            other => unreachable!("{other:?} is not generated"),
        }
    }
    statement("FINI".into());
    text.replace('\n', style.line_end)
}

/// Whether two records say the same, coordinates within rounding.
fn same(a: &Op, b: &Op) -> bool {
    match (a, b) {
        (Op::Line(a), Op::Line(b)) | (Op::Rapid(a), Op::Rapid(b)) => {
            a.point().distance(b.point()) < 1e-8 && a.axis().distance(b.axis()) < 1e-12
        }
        _ => a == b,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_is_written_is_read_back(
        ops in prop::collection::vec(op(), 1..40),
        style in style(),
        turned in any::<bool>(),
        angles in prop::array::uniform3(-3.0..3.0f64),
    ) {
        let mut ops = ops;
        ops.push(Op::Line(Pose::upright(Vec3::ONE).unwrap()));
        let turn = geom::Mat3::from_rotation_z(angles[0]) * geom::Mat3::from_rotation_x(angles[1]);
        let setup = match turned {
            true => Frame::from_mat3_translation(turn, Vec3::from_array(angles) * 100.0),
            false => Frame::IDENTITY,
        };
        let text = write(&ops, style, &setup);
        let reading = read("t.apt", text.as_bytes(), &Options::default());
        let reading = reading.map_err(|e| TestCaseError::fail(format!("{}\n{text}", e[0])))?;
        prop_assert!(reading.warnings.is_empty(), "{}", reading.warnings[0]);
        let head = 3 + usize::from(turned);
        let records = &reading.program.records;
        prop_assert_eq!(records.len(), head + ops.len() + 1);
        for (record, op) in records[head..].iter().zip(&ops) {
            prop_assert!(same(&record.op, op), "{:?} is not {:?}\n{}", record.op, op, text);
        }
    }

    #[test]
    fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = read("t.apt", &bytes, &Options::default());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn no_records_make_it_panic(
        statements in prop::collection::vec(
            "(GOTO|CIRCLE|CYCLE|MSYS|CSYS|SPINDL|TLON,GOFWD|FEDRAT|LOAD|DELAY|UNITS|CUTTER|FROM|GODLTA)/\
             ((DRILL|FEDTO|RAPTO|TOOL|RPM|MM|CIRCLE|LINE|-?[0-9]{1,4}(\\.[0-9]{0,3})?|),){0,12}[0-9]?\\$?",
            0..12,
        ),
    ) {
        let _ = read("t.apt", statements.join("\n").as_bytes(), &Options { strict: true, ..Options::default() });
    }
}
