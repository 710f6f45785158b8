//! What each record means, one by one. Expected values are worked out by hand from the record's
//! definition (`docs/sources/apt.md` names the source of each).

use geom::Vec3;
use program::{
    ArcTo, Compensation, Coolant, Cycle, CycleKind, Feed, Op, Orientation, Pose, Spindle, Tool,
};
use toolpost_source::apt::{Dialect, Options, Reading, read};

/// Unit, tool, spindle and feed, so that a cut may follow at once.
const HEAD: &str = "UNITS/MM\nLOAD/TOOL,1\nSPINDL/1000,RPM,CLW\nFEDRAT/100,MMPM\n";
/// Records that `HEAD` makes.
const HEAD_OPS: usize = 3;

fn reading(text: &str) -> Reading {
    read("test.apt", text.as_bytes(), &Options::default()).unwrap_or_else(|e| panic!("{}", e[0]))
}

/// The records of `body` after [`HEAD`], without the end, and without any warning.
fn ops(body: &str) -> Vec<Op> {
    let reading = reading(&format!("{HEAD}{body}\nFINI\n"));
    assert!(reading.warnings.is_empty(), "{}", reading.warnings[0]);
    let mut ops: Vec<Op> = reading.program.records.into_iter().map(|record| record.op).collect();
    assert_eq!(ops.pop(), Some(Op::End));
    ops.split_off(HEAD_OPS)
}

/// The rules of the warnings of `body` after [`HEAD`].
fn warnings(body: &str) -> Vec<&'static str> {
    reading(&format!("{HEAD}{body}\nFINI\n")).warnings.iter().map(|w| w.rule).collect()
}

/// The one error of `body` after [`HEAD`].
fn error(body: &str) -> &'static str {
    let text = format!("{HEAD}{body}\nFINI\n");
    let errors = read("test.apt", text.as_bytes(), &Options::default()).expect_err(body);
    errors[0].rule
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Vec3::Z)
}

/// Whether the poses of `ops` are `expected` (point, axis) within rounding.
#[track_caller]
fn assert_poses(ops: &[Op], expected: &[([f64; 3], [f64; 3])]) {
    let poses: Vec<&Pose> = ops.iter().filter_map(Op::pose).collect();
    assert_eq!(poses.len(), expected.len(), "{ops:?}");
    for (pose, (point, axis)) in poses.iter().zip(expected) {
        let near = |a: Vec3, b: [f64; 3]| a.distance(Vec3::from_array(b)) < 1e-9;
        assert!(near(pose.point, *point), "{:?} is not {point:?}", pose.point);
        assert!(near(pose.axis().unwrap(), *axis), "{:?} is not {axis:?}", pose.axis());
    }
}

const Z: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn goto_moves_at_feed_and_keeps_what_is_left_out() {
    let (s, up) = (0.5f64.sqrt(), Z);
    for (text, poses) in [
        ("GOTO/1,2,3", vec![([1., 2., 3.], up)]),
        ("goto / 1. , 2. , 3.", vec![([1., 2., 3.], up)]),
        ("\tGOTO/1,2,3 \0", vec![([1., 2., 3.], up)]),
        ("GOTO/1,$\n 2,$\n3 $$ there", vec![([1., 2., 3.], up)]),
        ("GOTO/1,2,\n3", vec![([1., 2., 3.], up)]),
        ("GOTO/1,2,3\nGOTO/4,,6", vec![([1., 2., 3.], up), ([4., 2., 6.], up)]),
        (
            "GOTO/1,2,3,0,1,1\nGOTO/4,5,6",
            vec![([1., 2., 3.], [0., s, s]), ([4., 5., 6.], [0., s, s])],
        ),
        ("GOTO/1,2,3,0,0,-250", vec![([1., 2., 3.], [0., 0., -1.])]),
    ] {
        let ops = ops(text);
        assert!(ops.iter().all(|op| matches!(op, Op::Line(_))), "{text}");
        assert_poses(&ops, &poses);
    }
}

#[test]
fn a_goto_that_is_not_one_is_refused() {
    for (text, rule) in [
        ("GOTO/1,2", "malformed"),
        ("GOTO/1,2,3,4", "malformed"),
        ("GOTO/1,2,3,4,5", "malformed"),
        ("GOTO/1,2,3,0,0,1,7", "malformed"),
        ("GOTO/,2,3", "malformed"),
        ("GOTO/1,2,A", "malformed"),
        ("GOTO/1,2,NAN", "malformed"),
        ("GOTO/1,2,INF", "malformed"),
        ("GOTO/1 2,3,4", "malformed"),
        ("GOTO/1/2,3,4", "malformed"),
        ("GOTO/1.2.3,4,5", "malformed"),
        ("GOTO/1,2,3,0,0,0", "zero-vector"),
        ("GOTO/1,2,3,1E-12,0,0", "zero-vector"),
        ("GOTO/1,2,3,0,0,", "malformed"),
        // A comma at the end continues the record: the value after it has to come.
        ("GOTO/1,2,3\nGOTO/,5,", "malformed"),
        ("GOTO/1,2,1000001", "out-of-range"),
        ("GOTO/1,2,1e308", "out-of-range"),
        ("GOTO/1,2,1e999", "malformed"),
        ("N10 GOTO/1,2,3", "malformed"),
    ] {
        assert_eq!(error(text), rule, "{text}");
    }
}

#[test]
fn rapid_holds_for_one_motion() {
    for rapid in ["RAPID", "RAPID/", "RAPID / "] {
        let ops = ops(&format!("{rapid}\nGOTO/1,2,3\nGOTO/1,2,0"));
        assert_eq!(ops, [Op::Rapid(at(1., 2., 3.)), Op::Line(at(1., 2., 0.))]);
    }
}

#[test]
fn from_is_no_motion_but_a_cut_from_it_needs_the_way_there() {
    assert_eq!(ops("FROM/0,0,50\nRAPID\nGOTO/1,2,3"), [Op::Rapid(at(1., 2., 3.))]);
    let cut = "FROM/0,0,50\nGOTO/1,2,3";
    assert_eq!(warnings(cut), ["from"]);
    let reading = reading(&format!("{HEAD}{cut}\nFINI"));
    assert_eq!(reading.program.records[HEAD_OPS].op, Op::Rapid(at(0., 0., 50.)));
    assert_eq!(reading.program.records[HEAD_OPS].line, 5);
}

#[test]
fn godlta_moves_relatively() {
    let start = "GOTO/10,20,30,1,0,0\n";
    let (from, x) = (([10., 20., 30.], [1., 0., 0.]), [1., 0., 0.]);
    for (text, to, axis) in [
        ("GODLTA/1,2,3", [11., 22., 33.], x),
        ("GODLTA/-5", [5., 20., 30.], x),
        ("GODLTA/1,2,3,0,0,4", [11., 22., 33.], Z),
    ] {
        assert_poses(&ops(&format!("{start}{text}")), &[from, (to, axis)]);
    }
    assert_eq!(error("GODLTA/1,2,3"), "no-start");
    assert_eq!(error("GOTO/0,0,999999\nGODLTA/2"), "out-of-range");
}

#[test]
fn feeds_come_in_every_unit_and_both_orders() {
    for (text, feed) in [
        ("FEDRAT/250", Feed::PerMinute(250.0)),
        ("FEDRAT/ 1000.0000,MMPM", Feed::PerMinute(1000.0)),
        ("FEDRAT/MMPM,250.5", Feed::PerMinute(250.5)),
        ("FEDRAT/10,IPM", Feed::PerMinute(254.0)),
        ("FEDRAT/PERMIN,141", Feed::PerMinute(141.0)),
        ("FEDRAT/0.2,MMPR", Feed::PerTurn(0.2)),
        ("FEDRAT/IPR,.01", Feed::PerTurn(0.254)),
        ("FEDRAT/PERREV,.3", Feed::PerTurn(0.3)),
        ("FEDRAT/INVERS,2.5", Feed::InverseTime(2.5)),
        ("FEDRAT/0.1,MMPR\nFEDRAT/0.2", Feed::PerTurn(0.2)),
        ("UNITS/INCHES\nFEDRAT/PERMIN,2", Feed::PerMinute(50.8)),
        ("UNITS/INCHES\nFEDRAT/2,MMPM", Feed::PerMinute(2.0)),
    ] {
        let ops = ops(&format!("{text}\nGOTO/1,2,3"));
        let last = ops.iter().rev().find_map(|op| match op {
            Op::Feed(feed) => Some(*feed),
            _ => None,
        });
        assert_eq!(last, Some(feed), "{text}");
    }
    let bare = "UNITS/INCHES\nLOAD/TOOL,1\nSPINDL/1000,CLW\nFEDRAT/2\nGOTO/1,2,3\nFINI";
    assert_eq!(reading(bare).program.records[2].op, Op::Feed(Feed::PerMinute(50.8)));
    for (text, rule) in [
        ("FEDRAT/1,FURLONG", "unknown-unit"),
        ("FEDRAT/MMPM", "malformed"),
        ("FEDRAT/-1,MMPM", "feed"),
        ("FEDRAT/MMPM,1,2", "malformed"),
    ] {
        assert_eq!(error(text), rule, "{text}");
    }
}

#[test]
fn spindles_come_in_every_order_and_by_surface_speed() {
    use Spindle::{Clockwise, CounterClockwise, Off};
    // 100 m/min on a diameter of 10 mm; 300 feet/min on one of 0.5 inch: v / (pi d).
    let smm = 100_000.0 / (10.0 * std::f64::consts::PI);
    let sfm = 300.0 * 12.0 / (0.5 * std::f64::consts::PI);
    for (text, spindle) in [
        ("SPINDL/RPM,1310,CLW", Clockwise(1310.0)),
        ("SPINDL/12000,RPM,CLW", Clockwise(12000.0)),
        ("SPINDL/ 70.0000,RPM,CCLW", CounterClockwise(70.0)),
        ("SPINDL/CCLW,RPM,500", CounterClockwise(500.0)),
        ("SPINDL/CLW,500,RPM", Clockwise(500.0)),
        ("SPINDL/500,CCLW", CounterClockwise(500.0)),
        ("SPINDL/700", Clockwise(700.0)),
        ("SPINDL/500,RPM,CCLW\nSPINDL/700", CounterClockwise(700.0)),
        ("SPINDL/OFF", Off),
        ("SPINDL/500,CCLW\nSPINDL/OFF\nSPINDL/ON", CounterClockwise(500.0)),
        ("CUTTER/10,0\nSPINDL/SMM,100,CLW", Clockwise(smm)),
        ("RAPID\nGOTO/0,0,9\nCUTTER/10,0\nLOAD/TOOL,2\nSPINDL/100,SMM,CLW", Clockwise(smm)),
        ("UNITS/IN\nCUTTER/.5\nSPINDL/300,SFM,CLW", Clockwise(sfm)),
    ] {
        let ops = ops(&format!("{text}\nRAPID\nGOTO/1,2,3"));
        let last = ops.iter().rev().find_map(|op| match op {
            Op::Spindle(spindle) => Some(*spindle),
            _ => None,
        });
        let (Some(Clockwise(a) | CounterClockwise(a)), Clockwise(b) | CounterClockwise(b)) =
            (last, spindle)
        else {
            assert_eq!(last, Some(spindle), "{text}");
            continue;
        };
        assert!((a - b).abs() < 1e-9, "{text}: {a} {b}");
        assert_eq!(matches!(last, Some(Clockwise(_))), matches!(spindle, Clockwise(_)), "{text}");
    }
    assert_eq!(error("SPINDL/SMM,100,CLW"), "spindle");
    assert_eq!(error("SPINDL/-5,RPM,CLW"), "spindle");
    assert_eq!(error("SPINDL/100,FAST"), "malformed");
}

#[test]
fn coolants_compensations_dwells_and_stops() {
    let cases: [(&str, Vec<Op>); 14] = [
        ("COOLNT/ON", vec![Op::Coolant(Coolant::Flood)]),
        ("COOLNT/FLOOD", vec![Op::Coolant(Coolant::Flood)]),
        ("COOLNT/MIST", vec![Op::Coolant(Coolant::Mist)]),
        ("COOLNT/THRU", vec![Op::Coolant(Coolant::Through)]),
        ("COOLNT/OFF", vec![Op::Coolant(Coolant::Off)]),
        ("CUTCOM/LEFT", vec![Op::Compensation(Compensation::Left(None))]),
        ("CUTCOM/RIGHT,12", vec![Op::Compensation(Compensation::Right(Some(12)))]),
        ("CUTCOM/LEFT,ADJUST,3", vec![Op::Compensation(Compensation::Left(Some(3)))]),
        (
            "CUTCOM/RIGHT\nCUTCOM/OFF\nCUTCOM/ON",
            vec![
                Op::Compensation(Compensation::Right(None)),
                Op::Compensation(Compensation::Off),
                Op::Compensation(Compensation::Right(None)),
            ],
        ),
        (
            "CUTCOM/LEFT,GOTO/1,2,3",
            vec![Op::Compensation(Compensation::Left(None)), Op::Line(at(1., 2., 3.))],
        ),
        (
            "CUTCOM/OFF GOTO/1,2,3,0,0,1",
            vec![Op::Compensation(Compensation::Off), Op::Line(at(1., 2., 3.))],
        ),
        ("DELAY/1.5", vec![Op::Dwell(1.5)]),
        // Ten turns at 1000 1/min.
        ("DELAY/10,REV", vec![Op::Dwell(0.6)]),
        ("STOP\nOPSTOP", vec![Op::Stop, Op::OptionalStop]),
    ];
    for (text, expected) in cases {
        let mut expected = expected;
        expected.push(Op::Line(at(9., 9., 9.)));
        assert_eq!(ops(&format!("{text}\nGOTO/9,9,9")), expected, "{text}");
    }
    for text in ["COOLNT/BEER", "CUTCOM/UP", "CUTCOM/ON", "DELAY/1,HOUR"] {
        assert_eq!(error(text), "malformed", "{text}");
    }
    assert_eq!(error("DELAY/-1"), "dwell");
}

#[test]
fn tools_are_described_before_or_after_they_are_loaded() {
    let tool = |text: &str| {
        let all = ops(&format!("{text}\nRAPID\nGOTO/0,0,0"));
        let tools = all.into_iter().rev().find_map(|op| match op {
            Op::Tool(tool) => Some(*tool),
            _ => None,
        });
        tools.unwrap()
    };
    let plain = Tool { number: 7, ..Tool::default() };
    assert_eq!(tool("LOAD/TOOL,7"), plain);
    assert_eq!(tool("LOADTL/7"), plain);
    assert_eq!(tool("LOADTL/7,1"), Tool { offset: Some(1), ..plain.clone() });
    assert_eq!(tool("LOAD/TOOL,7,ADJUST,3"), Tool { offset: Some(3), ..plain.clone() });
    assert_eq!(
        tool("LOADTL/7,LENGTH,120.5,OSETNO,2"),
        Tool { offset: Some(2), length: Some(120.5), ..plain.clone() }
    );
    let mill = Tool {
        name: "BALL10".into(),
        diameter: Some(10.0),
        corner_radius: Some(5.0),
        ..plain.clone()
    };
    let move_first = "RAPID\nGOTO/1,1,1\n";
    for text in [
        "LOAD/TOOL,7\nCUTTER/10,5,0,5,0,0,70\nTPRINT/BALL10",
        "LOAD/TOOL,7\nTPRINT/BALL10\nCUTTER/10,5",
    ] {
        assert_eq!(tool(text), mill, "{text}");
    }
    assert_eq!(tool(&format!("{move_first}CUTTER/10,5\nTPRINT/BALL10\nLOAD/TOOL,7")), mill);
    assert_eq!(
        tool("CUTTER/8,1\nRAPID\nGOTO/1,1,1\nUNITS/INCHES\nCUTTER/.5,.25\nLOAD/TOOL,7"),
        Tool { diameter: Some(12.7), corner_radius: Some(6.35), ..plain }
    );
    for text in ["LOAD/TOOL,0", "LOAD/TOOL,1.5", "LOADTL/-3", "LOAD/TOOL,1e12"] {
        assert_eq!(error(text), "tool-number", "{text}");
    }
    assert_eq!(
        ops("SELECT/TOOL,16\nSELCTL/4\nGOTO/0,0,0")[..2],
        [Op::Preselect(16), Op::Preselect(4)]
    );
}

#[test]
fn without_a_load_the_tool_is_number_one_and_a_second_tool_is_refused() {
    let text = "UNITS/MM\nTOOL PATH/A,TOOL,MILL\nTLDATA/MILL,30.0,2.0,75.0,0.0,0.0\n\
                SPINDL/RPM,1000,CLW\nFEDRAT/MMPM,250\nGOTO/0,0,0\nEND-OF-PATH\n";
    let first = reading(text);
    assert_eq!(first.warnings[0].rule, "tool-number");
    let expected = Tool {
        number: 1,
        name: "MILL".into(),
        diameter: Some(30.0),
        corner_radius: Some(2.0),
        ..Tool::default()
    };
    assert!(first.program.records.iter().any(|r| r.op == Op::Tool(Box::new(expected.clone()))));
    let second = "TOOL PATH/B,TOOL,DRILL\nTLDATA/DRILL,MILL,8.0,0.0,80.0,118.0,35.0\nGOTO/0,0,1\nEND-OF-PATH\n";
    let errors = read("t.cls", format!("{text}{second}").as_bytes(), &Options::default());
    assert_eq!(errors.unwrap_err()[0].rule, "tool-change");
    // With its own LOAD it is changed to.
    let loaded = second.replace("GOTO", "LOAD/TOOL,2\nGOTO");
    let both = reading(&format!("{text}{loaded}"));
    assert!(both.program.records.iter().any(|r| matches!(&r.op, Op::Tool(t) if t.name == "DRILL")));
}

/// `circle` after a start at `start` and before an end; its arc.
fn arc(sign: &str, start: &str, circle: &str) -> ArcTo {
    let reading = reading(&format!("{sign}\n{HEAD}{start}\n{circle}\n"));
    let arc = reading.program.records.iter().find_map(|r| match &r.op {
        Op::Arc(arc) => Some(**arc),
        _ => None,
    });
    arc.unwrap()
}

#[test]
fn the_way_an_arc_turns_is_the_habit_of_the_system() {
    let body = ("GOTO/10,0,0", "CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\nFINI");
    for (sign, dialect, normal) in [
        ("PAINT/PATH", Dialect::Nx, Vec3::NEG_Z),
        ("PPRINT/APTCL-SPEC,MAKINO-FF,1", Dialect::Makino, Vec3::NEG_Z),
        ("CSI_SET_FLUTE_LENGTH/2.", Dialect::SolidWorksCam, Vec3::Z),
        ("$$* Pro/CLfile", Dialect::Creo, Vec3::Z),
        ("$$ ", Dialect::Iso, Vec3::Z),
    ] {
        assert_eq!(arc(sign, body.0, body.1).normal, normal, "{dialect}");
        let whole = reading(&format!("{sign}\n{HEAD}{}\n{}\n", body.0, body.1));
        assert_eq!(whole.dialect, dialect);
        // Where no source says how, that is said.
        let doubt = whole.warnings.iter().any(|w| w.rule == "arc-direction");
        assert_eq!(doubt, dialect == Dialect::Iso, "{dialect}");
    }
}

#[test]
fn the_path_is_held_against_the_habit() {
    // Straight along +Y into a quarter that goes on to -X: counter-clockwise about +Z.
    let path = |k: i32| {
        format!("GOTO/10,-5,0\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,{k},10\nGOTO/0,10,0\nGOTO/-5,10,0")
    };
    let right = reading(&format!("{HEAD}{}\nFINI", path(1)));
    assert!(right.warnings.is_empty());
    assert_eq!(error(&path(-1)), "arc-direction");
    let nx = format!("PAINT/PATH\n{HEAD}{}\n", path(1));
    assert_eq!(
        read("a.cls", nx.as_bytes(), &Options::default()).unwrap_err()[0].rule,
        "arc-direction"
    );
    // One of three: a warning that names its line.
    let mixed = format!("{HEAD}{}\n{}\n{}\nFINI", path(1), path(1), path(-1));
    let warnings = reading(&mixed).warnings;
    assert_eq!((warnings[0].rule, warnings[0].line), ("arc-direction", 18));
}

#[test]
fn arcs_lie_in_any_plane_and_go_round_as_often_as_asked() {
    let creo = "$$* Pro/CLfile";
    let side = arc(creo, "GOTO/0,10,5", "CIRCLE/0,0,5,1,0,0,10\nGOTO/0,0,15\nFINI");
    assert_eq!((side.normal, side.center, side.turns), (Vec3::X, Vec3::new(0., 0., 5.), 0));
    let full = arc(creo, "GOTO/10,0,0", "CIRCLE/0,0,0,0,0,-2,10\nGOTO/10,0,0\nFINI");
    assert_eq!((full.normal, full.end, full.turns), (Vec3::NEG_Z, at(10., 0., 0.), 0));
    let helix = arc(creo, "GOTO/10,0,0", "CIRCLE/0,0,0,0,0,1,10,TIMES,3\nGOTO/10,0,-6\nFINI");
    assert_eq!((helix.end, helix.turns), (at(10., 0., -6.), 2));
    let canon = arc(creo, "GOTO/10,0,0", "CIRCLE/CANON,0,0,0,0,0,1,10\nGOTO/0,10,0\nFINI");
    assert_eq!(canon.normal, Vec3::Z);
    let other_records = "CIRCLE/0,0,0,0,0,1,10\nPAINT/COLOR,1\nFEDRAT/5,MMPM\nGOTO/0,10,0\nFINI";
    assert_eq!(arc("PAINT/PATH", "GOTO/10,0,0", other_records).end, at(0., 10., 0.));
    let inches = arc(creo, "UNITS/INCHES\nGOTO/1,0,0", "CIRCLE/0,0,0,0,0,1,1\nGOTO/0,1,0\nFINI");
    assert_eq!(inches.end, at(0., 25.4, 0.));
}

#[test]
fn an_arc_that_is_none_is_refused() {
    for (text, rule) in [
        ("CIRCLE/0,0,0,0,0,1,10", "circle-without-goto"),
        ("CIRCLE/0,0,0,0,0,1,10\nRAPID\nGOTO/0,10,0", "circle-without-goto"),
        ("CIRCLE/0,0,0,0,0,1,10\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0", "circle-without-goto"),
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10.006,0", "off-the-circle"),
        ("CIRCLE/0,0,0,0,0,1,10.1\nGOTO/0,10,0", "off-the-circle"),
        ("CIRCLE/10,0,0,0,0,1,10\nGOTO/0,10,0", "off-the-circle"),
        ("CIRCLE/0,0,0,0,0,0,10\nGOTO/0,10,0", "zero-vector"),
        ("CIRCLE/0,0,0,0,0\nGOTO/0,10,0", "malformed"),
        ("CIRCLE/0,0,0,0,0,1,10,TIMES,2\nGOTO/0,10,0", "unsupported"),
        ("CIRCLE/0,0,0,0,0,1,10,TIMES,1.5\nGOTO/10,0,0", "malformed"),
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0,0,1,1", "unsupported"),
        ("RAPID\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0", "unsupported"),
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/10,-.001,0", "arc-chord"),
    ] {
        assert_eq!(error(&format!("GOTO/10,0,0\n{text}")), rule, "{text}");
    }
    assert_eq!(error("CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0"), "no-start");
    let radii = format!("{HEAD}GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,10.5,0\nFINI");
    let errors = read("r.apt", radii.as_bytes(), &Options::default()).unwrap_err();
    assert!(errors[0].message.contains("10.0000") && errors[0].message.contains("10.5000"));
    assert_eq!((errors[0].line, errors[0].column), (7, 6));
}

#[test]
fn creo_lists_the_points_of_an_arc_line_by_line() {
    let head = format!("$$* Pro/CLfile\n{HEAD}GOTO / 10,0,0\nCIRCLE / 0,0,0,0,0,1,10\n");
    let many = reading(&format!("{head}GOTO / 0,10,0\n-10,0,0\n0,-10,0\nFINI"));
    let arcs: Vec<&ArcTo> = many
        .program
        .records
        .iter()
        .filter_map(|r| match &r.op {
            Op::Arc(arc) => Some(&**arc),
            _ => None,
        })
        .collect();
    assert_eq!((arcs.len(), arcs[0].end), (1, at(0., -10., 0.)));
    let wrong = |points: &str| {
        read("c.ncl", format!("{head}{points}\nFINI").as_bytes(), &Options::default()).unwrap_err()
            [0]
        .rule
    };
    assert_eq!(wrong("GOTO / -10,0,0\n0,10,0"), "arc-direction");
    assert_eq!(wrong("GOTO / 0,10,0\nGOTO / -10,0,0"), "arc-points");
    assert_eq!(error("1,2,3"), "malformed");
    assert_poses(&ops("GOTO/1,2,3\n4,5,6"), &[([1., 2., 3.], Z), ([4., 5., 6.], Z)]);
}

/// The published sample of CATIA (with a start for its first motion): centre (-42, 8), radius 21, end
/// (-42, 29) = centre + (0, 21), setting out along +Y.
const CATIA: &str = "$$ OPERATION NAME : Profile Contouring.2
$$ Start generation of : Profile Contouring.2
LOADTL/3,1
FEDRAT/ 300.0000,MMPM
SPINDL/ 70.0000,RPM,CLW
FEDRAT/ 1000.0000,MMPM
GOTO / -62.00000, -48.00000, 14.00000
RAPID
GOTO / -63.00000, -47.00000, 14.00000
GOTO / -63.00000, 8.00000, 14.00000
INDIRV/ 0.00000, 1.00000, 0.00000
TLON,GOFWD/(CIRCLE/-42.00000,8.00000,14.00000,$21.00000),
ON,(LINE/-42.00000, 8.00000, 14.00000,$-42.00000, 29.00000,14.00000)
";

#[test]
fn the_published_sample_of_catia_is_read() {
    let reading = reading(CATIA);
    assert_eq!(reading.dialect, Dialect::Catia);
    let ops: Vec<&Op> = reading.program.records.iter().map(|r| &r.op).collect();
    let center = Vec3::new(-42., 8., 14.);
    // From (-63, 8) up: clockwise, a quarter.
    let arc = ArcTo { end: at(-42., 29., 14.), center, normal: Vec3::NEG_Z, turns: 0 };
    let tool = Tool { number: 3, offset: Some(1), ..Tool::default() };
    let expected = [
        Op::Operation("Profile Contouring.2".into()),
        Op::Comment("Start generation of : Profile Contouring.2".into()),
        Op::Tool(Box::new(tool)),
        Op::Feed(Feed::PerMinute(300.0)),
        Op::Spindle(Spindle::Clockwise(70.0)),
        Op::Feed(Feed::PerMinute(1000.0)),
        Op::Line(at(-62., -48., 14.)),
        Op::Rapid(at(-63., -47., 14.)),
        Op::Line(at(-63., 8., 14.)),
        Op::Arc(Box::new(arc)),
        Op::End,
    ];
    assert_eq!(ops, expected.iter().collect::<Vec<_>>());
    let rules: Vec<&str> = reading.warnings.iter().map(|w| w.rule).collect();
    assert_eq!(rules, ["unknown-unit", "no-fini"]);
}

#[test]
fn tlon_turns_the_way_indirv_points_in_any_plane() {
    let tlon = |towards: &str, plane: &str| {
        format!("GOTO/10,0,0\nINDIRV/{towards}\nTLON,GOFWD/ (CIRCLE/ 0,0,0,$\n10),{plane}")
    };
    let normal = |text: &str| match ops(text).last() {
        Some(Op::Arc(arc)) => arc.normal,
        op => panic!("{op:?}"),
    };
    assert_eq!(normal(&tlon("0,1,0", "ON,(LINE/0,0,0,0,10,0)")), Vec3::Z);
    assert_eq!(normal(&tlon("0,-1,0", "ON,(LINE/0,0,0,0,10,0)")), Vec3::NEG_Z);
    assert_eq!(normal(&tlon("0,0,1", "ON,(LINE/0,0,0,0,0,10)")), Vec3::NEG_Y);
    assert_eq!(normal(&tlon("0,1,0", "ON,2,INTOF,(LINE/0,0,0,0,-10,0)")), Vec3::Z);
    for (text, rule) in [
        (tlon("1,0,0", "ON,(LINE/0,0,0,0,10,0)"), "zero-vector"),
        (tlon("1,1,0", "ON,(LINE/0,0,0,0,10,0)"), "arc-direction"),
        (tlon("0,1,0", "ON,(LINE/0,0,0,0,11,0)"), "off-the-circle"),
        (tlon("0,1,0", "TO,(LINE/0,0,0,0,10,0)"), "unsupported"),
        (tlon("0,1,0", "ON,(LINE/0,0,0,0,10,0"), "malformed"),
        ("GOTO/1,0,0\nTLON,GOFWD/(CIRCLE/0,0,0,1),ON,(LINE/0,0,0,0,1,0)".into(), "no-start"),
    ] {
        assert_eq!(error(&text), rule, "{text}");
    }
}

/// The cycle and the holes of `text`.
fn cycle(text: &str) -> (Cycle, Vec<Pose>) {
    let ops = ops(text);
    let cycles: Vec<Cycle> = ops
        .iter()
        .filter_map(|op| match op {
            Op::Cycle(cycle) => Some(**cycle),
            _ => None,
        })
        .collect();
    let holes = ops.iter().filter_map(|op| match op {
        Op::Hole(pose) => Some(*pose),
        _ => None,
    });
    (*cycles.last().unwrap(), holes.collect())
}

#[test]
fn every_cycle_gives_its_kind_and_its_numbers() {
    let drill = Cycle {
        kind: CycleKind::Drill,
        depth: 10.0,
        clearance: 3.0,
        retract: 25.0,
        feed: Some(Feed::PerMinute(200.0)),
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    let all = "FEDTO,10,MMPM,200,RAPTO,3,RTRCTO,25";
    let deep = Cycle { kind: CycleKind::Deep, peck: Some(2.0), ..drill };
    let tap = |pitch, left| CycleKind::Tap { pitch, left };
    let cases: [(String, Cycle); 19] = [
        (format!("CYCLE/DRILL,{all}"), drill),
        (format!("CYCLE/DRILL,{all},DWELL,0"), drill),
        (format!("CYCLE/DRILL,{all},DWELL,1.5"), Cycle { dwell: 1.5, ..drill }),
        (format!("CYCLE/FACE,{all},DWELL,REV,5"), Cycle { dwell: 0.3, ..drill }),
        (format!("CYCLE/THRU,{all}"), drill),
        ("CYCLE/DRILL,DEPTH,10,MMPM,200,CLEAR,3".into(), Cycle { retract: 3.0, ..drill }),
        (
            "CYCLE / DRILL, DEPTH, 10, IPM, 10, CLEAR, 3, RETURN, 25".into(),
            Cycle { feed: Some(Feed::PerMinute(254.0)), ..drill },
        ),
        ("CYCLE/DRILL,FEDTO,10,RAPTO,3,RTRCTO,25".into(), Cycle { feed: None, ..drill }),
        (
            format!("CYCLE/DEEP2,{all},1STPECK,5.,SUBPECK,2."),
            Cycle { first_peck: Some(5.0), ..deep },
        ),
        (format!("CYCLE/DEEP,{all},INCR,2"), deep),
        (format!("CYCLE/DRILL,DEEP,STEP,2,{all}"), deep),
        (format!("CYCLE/BRKCHP,{all},STEP,2"), Cycle { kind: CycleKind::BreakChip, ..deep }),
        (format!("CYCLE/REAM,{all}"), Cycle { kind: CycleKind::Ream, ..drill }),
        (format!("CYCLE/BORE,{all}"), Cycle { kind: CycleKind::Bore, ..drill }),
        // 200 mm/min at 1000 1/min.
        (format!("CYCLE/TAP,{all}"), Cycle { kind: tap(0.2, false), ..drill }),
        (format!("CYCLE/TAP,{all},TPI,20"), Cycle { kind: tap(1.27, false), ..drill }),
        (
            "CYCLE/TAP,FEDTO,10,MMPR,1.5,RAPTO,3,RTRCTO,25".into(),
            Cycle { kind: tap(1.5, false), feed: Some(Feed::PerTurn(1.5)), ..drill },
        ),
        (format!("SPINDL/1000,CCLW\nCYCLE/TAP,{all}"), Cycle { kind: tap(0.2, true), ..drill }),
        // A cone of 90 degrees is as deep as its radius.
        ("CYCLE/CSINK,DIAMETR,20,TLANGL,90,MMPM,200,RAPTO,3,RTRCTO,25".into(), drill),
    ];
    for (text, expected) in cases {
        let (read, holes) = cycle(&format!("{text}\nGOTO/1,2,0\nGOTO/3,4,-5\nCYCLE/OFF"));
        assert!((read.depth - expected.depth).abs() < 1e-12, "{text}");
        assert_eq!(Cycle { depth: expected.depth, ..read }, expected, "{text}");
        assert_eq!(holes, [at(1., 2., 0.), at(3., 4., -5.)], "{text}");
    }
}

#[test]
fn a_cycle_begins_before_its_first_hole_and_ends_once() {
    let text = "CYCLE/INIT\nCYCLE/DRILL,FEDTO,10,MMPM,200,RAPTO,3,RTRCTO,25\nGOTO/1,1,0\nRAPID\n\
                GOTO/1,1,30\nGOTO/2,2,0\nCYCLE/OFF\nCYCLE/OFF\nRAPID\nGOTO/5,5,50\nCYCLE/ON\nGOTO/3,3,0";
    let text = format!("CSI_X/1\nUNIT/MM\nLOAD/TOOL,1\nSPINDL/1000,RPM,CLW\n{text}\nFINI\n");
    let program = reading(&text).program;
    let shape: Vec<&str> = program
        .records
        .iter()
        .map(|r| match r.op {
            Op::Cycle(_) => "cycle",
            Op::CycleOff => "off",
            Op::Hole(_) => "hole",
            Op::Rapid(_) => "rapid",
            _ => "-",
        })
        .collect();
    let expected =
        ["-", "-", "cycle", "hole", "rapid", "hole", "off", "rapid", "cycle", "hole", "-"];
    assert_eq!(shape, expected);
    // The cycle's record has the line of the cycle.
    assert_eq!(program.records[2].line, 6);
}

#[test]
fn an_automatic_retract_is_the_level_before_the_cycle() {
    // At 50 before; holes on 10 and 0: 40 and 50 above them.
    let head = format!("PAINT/PATH\n{HEAD}RAPID\nGOTO/0,0,50\n");
    let text = "CYCLE/DRILL,CLEAR,3.0,FEDTO,-10.0,RTRCTO,AUTO,MMPM,250.0\nGOTO/20,0,10\nGOTO/30,0,0\nCYCLE/OFF\n";
    let program = reading(&format!("{head}{text}")).program;
    let retracts: Vec<f64> = program
        .records
        .iter()
        .filter_map(|r| match &r.op {
            Op::Cycle(cycle) => Some(cycle.retract),
            _ => None,
        })
        .collect();
    assert_eq!(retracts, [40.0, 50.0]);
}

#[test]
fn siemens_nx_counts_depths_below_zero_and_bores_out_at_feed() {
    let kind = |text: &str| {
        let whole = format!("PAINT/PATH\n{HEAD}{text}\nGOTO/0,0,0\nCYCLE/OFF\n");
        read("n.cls", whole.as_bytes(), &Options::default()).map(|reading| {
            let cycle = reading.program.records.into_iter().find_map(|r| match r.op {
                Op::Cycle(cycle) => Some(*cycle),
                _ => None,
            });
            cycle.map(|cycle| (cycle.kind, cycle.depth))
        })
    };
    assert_eq!(kind("CYCLE/BORE,RAPTO,3,FEDTO,-8"), Ok(Some((CycleKind::Ream, 8.0))));
    assert_eq!(kind("CYCLE/BORE,DRAG,RAPTO,3,FEDTO,-8"), Ok(Some((CycleKind::Bore, 8.0))));
    assert_eq!(kind("CYCLE/DRILL,RAPTO,3,FEDTO,8").unwrap_err()[0].rule, "cycle-depth");
}

#[test]
fn a_cycle_that_is_not_whole_is_refused() {
    for (text, rule) in [
        ("CYCLE/DRILL,FEDTO,10,MMPM,200", "no-clear-plane"),
        ("CYCLE/DRILL,FEDTO,10,RAPTO,-11", "no-clear-plane"),
        ("CYCLE/DRILL,MMPM,200,RAPTO,3", "cycle-depth"),
        ("CYCLE/DRILL,FEDTO,0,RAPTO,3", "cycle-depth"),
        ("CYCLE/DRILL,FEDTO,-5,RAPTO,3", "cycle-depth"),
        ("CYCLE/DRILL,FEDTO,5,FEDTO,6,RAPTO,3", "malformed"),
        ("CYCLE/DRILL,10,200,MMPM,3", "unsupported"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,ORIENT,90", "unsupported"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO", "malformed"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,INCR,2", "peck"),
        ("CYCLE/DEEP,FEDTO,5,RAPTO,3", "peck"),
        ("CYCLE/DEEP,FEDTO,5,RAPTO,3,INCR,0", "peck"),
        ("CYCLE/TAP,FEDTO,5,RAPTO,3,TPI,0", "tap-pitch"),
        ("CYCLE/MILL,FEDTO,5,RAPTO,3", "unsupported"),
        ("CYCLE/CSINK,DIAMETR,20,RAPTO,3", "cycle-depth"),
        ("CYCLE/ON", "malformed"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,RTRCTO,AUTO\nGOTO/0,0,0", "no-start"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3\nCIRCLE/0,0,0,0,0,1\nGOTO/0,0,0", "unsupported"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3\nGOTO/0,0,0\nCYCLE/OFF\nGODLTA/0,0,5", "no-start"),
    ] {
        assert_eq!(error(text), rule, "{text}");
    }
    assert_eq!(warnings("CYCLE/DRILL,FEDTO,5,RAPTO,3,RTRCTO,1\nGOTO/0,0,0"), ["retract"]);
    assert_eq!(warnings("CYCLE/DRILL,FEDTO,5,RAPTO,3,CLEAR,5\nGOTO/0,0,0"), ["clear-plane"]);
}

#[test]
fn frames_are_resolved_relative_to_the_first() {
    let msys = |values: &str| format!("MSYS/{values}\n");
    let first = msys("100,0,0,1,0,0,0,1,0");
    // Turned by a quarter about Z, and 10 further along X.
    let second = msys("110,0,0,0,1,0,-1,0,0");
    let text = format!("{first}GOTO/1,2,3\n{second}GOTO/1,2,3\n{first}GOTO/1,2,3");
    let whole = reading(&format!("{HEAD}{text}\n"));
    assert_eq!(whole.dialect, Dialect::Nx);
    let ops: Vec<Op> = whole.program.records.into_iter().map(|r| r.op).collect();
    assert_poses(&ops, &[([1., 2., 3.], Z), ([10. - 2., 1., 3.], Z), ([1., 2., 3.], Z)]);
    let frames: Vec<Vec3> = ops
        .iter()
        .filter_map(|op| match op {
            Op::Frame(frame) => Some(frame.matrix3.x_axis),
            _ => None,
        })
        .collect();
    assert_eq!(frames, [Vec3::Y, Vec3::X]);
    // On its side: Z of the set-up is X of the work frame, and the tool stands along it.
    let side = msys("0,0,0,0,1,0,0,0,1");
    let text =
        format!("{}GOTO/0,0,0\n{side}GOTO/1,2,3\nGOTO/1,2,3,1,0,0", msys("0,0,0,1,0,0,0,1,0"));
    let ops: Vec<Op> =
        reading(&format!("{HEAD}{text}\n")).program.records.into_iter().map(|r| r.op).collect();
    let x = [1., 0., 0.];
    assert_poses(&ops, &[([0.; 3], Z), ([3., 1., 2.], x), ([3., 1., 2.], [0., 1., 0.])]);
    assert_eq!(error("MSYS/0,0,0,1,0,0,1,0,0"), "frame");
    assert_eq!(error("MSYS/0,0,0,1,0,0,0,2,0"), "frame");
}

#[test]
fn origins_shifts_inches_and_axes_are_resolved() {
    for (text, poses) in [
        ("ORIGIN/1,2,3\nGOTO/1,2,3", vec![([0.; 3], Z)]),
        ("TRANS/1,2,3\nGOTO/1,2,3", vec![([2., 4., 6.], Z)]),
        ("TRANS/1,2,3\nORIGIN/1,0,0\nGOTO/0,0,0", vec![([0., 2., 3.], Z)]),
        ("UNITS/INCHES\nTRANS/0,0,1\nGOTO/1,0,0", vec![([25.4, 0., 25.4], Z)]),
        (
            "TRANS/5,0,0\nGOTO/1,0,0\nTRANS/0,0,0\nGOTO/,7,0",
            vec![([6., 0., 0.], Z), ([6., 7., 0.], Z)],
        ),
        ("TLAXIS/0,3,4\nGOTO/1,2,3", vec![([1., 2., 3.], [0., 0.6, 0.8])]),
        (
            "GOTO/1,2,3,1,0,0\nMULTAX/OFF\nGOTO/1,2,3",
            vec![([1., 2., 3.], [1., 0., 0.]), ([1., 2., 3.], Z)],
        ),
        ("MULTAX/ON\nGOTO/1,2,3,1,0,0", vec![([1., 2., 3.], [1., 0., 0.])]),
        ("ROTATE/TABLE,ATANGL,0\nMODE/ABSOL\nGOTO/1,2,3", vec![([1., 2., 3.], Z)]),
    ] {
        assert_poses(&ops(text), &poses);
    }
    for (text, rule) in [
        ("UNITS/FURLONG", "unknown-unit"),
        ("ROTATE/TABLE,ATANGL,90", "unsupported"),
        ("ROTATE/TABLE,INCR,0,0", "unsupported"),
        ("MODE/INCR", "unsupported"),
        ("HEAD/2", "unsupported"),
        ("TRACUT/A", "unsupported"),
        ("GOHOME", "unsupported"),
        ("TRNTYP/LOCAL,0,0,0", "frame"),
        ("TRNTYP/WORLD,0,0,5", "frame"),
        ("CSYS/0,0,1,0,0,1,0,0,-1,0,0,0", "frame"),
        ("TRNTYP/WORLD\nCSYS/1,0,0,0,0,1,0,0,0,0,-1,0", "frame"),
        ("TRNTYP/WORLD\nCSYS/1,0,0,0,0,1,0,0,0,0,1,0\nCSYS/1,0,0,5,0,1,0,0,0,0,1,0", "frame"),
    ] {
        assert_eq!(error(text), rule, "{text}");
    }
}

#[test]
fn catia_gives_its_axis_system_in_remarks() {
    let system = |rows: &str| format!("$$*CATIA0\n$$ Axis.1\n{rows}");
    let first = system("$$ 1.0 0.0 0.0 50.0\n$$ 0.0 1.0 0.0 0.0\n$$ 0.0 0.0 1.0 0.0\n");
    let turned = system("$$ 0.0 -1.0 0.0 50.0\n$$ 1.0 0.0 0.0 0.0\n$$ 0.0 0.0 1.0 7.0\n");
    let whole = reading(&format!("{first}{HEAD}GOTO/1,2,3\n{turned}GOTO/1,2,3\nFINI"));
    assert_eq!(whole.dialect, Dialect::Catia);
    let ops: Vec<Op> = whole.program.records.into_iter().map(|r| r.op).collect();
    assert_poses(&ops, &[([1., 2., 3.], Z), ([-2., 1., 10.], Z)]);
    assert!(!ops.iter().any(|op| matches!(op, Op::Comment(_))));
}

#[test]
fn words_for_people_stay_words() {
    let cases = [
        ("PPRINT/clamp the part", Op::Comment("clamp the part".into())),
        ("PPRINT clamp, then go", Op::Comment("clamp, then go".into())),
        ("$$ a remark", Op::Comment("a remark".into())),
    ];
    for (text, op) in cases {
        assert_eq!(ops(&format!("{text}\nGOTO/0,0,0"))[0], op, "{text}");
    }
    let inserted =
        reading(&format!("{HEAD}INSERT/M00 G91\nINSERT/STOP turn the part\nGOTO/0,0,0\nFINI"));
    let ops: Vec<&Op> =
        inserted.program.records[HEAD_OPS..HEAD_OPS + 3].iter().map(|r| &r.op).collect();
    assert_eq!(
        ops,
        [&Op::Comment("M00 G91".into()), &Op::Stop, &Op::Message("turn the part".into())]
    );
    assert_eq!(inserted.warnings.iter().map(|w| w.rule).collect::<Vec<_>>(), ["insert", "insert"]);
    assert_eq!(
        reading(&format!("PARTNO/Housing 7\n{HEAD}GOTO/0,0,0\nFINI")).program.name,
        "Housing 7"
    );
    assert_eq!(reading(&format!("{HEAD}GOTO/0,0,0\nFINI")).program.name, "test");
}

#[test]
fn words_that_are_not_known_are_one_warning_each() {
    let text = format!("{HEAD}FOO/1\nBAR\nFOO/2\nGOTO/1,2,3\nAUXFUN/8\nFINI");
    let warnings = reading(&text).warnings;
    let seen: Vec<(&str, u32, u32)> = warnings.iter().map(|w| (w.rule, w.line, w.count)).collect();
    assert_eq!(seen, [("unknown-word", 5, 2), ("unknown-word", 6, 1), ("ignored-word", 9, 1)]);
    let strict = read("s.apt", text.as_bytes(), &Options { strict: true }).unwrap_err();
    assert!(strict.iter().all(|e| e.is_error()));
    assert_eq!(
        strict.iter().map(|e| (e.rule, e.line)).collect::<Vec<_>>()[..2],
        [("unknown-word", 5), ("unknown-word", 6)]
    );
    let silent = "PAINT/COLOR,1\nDISPLY/ON\nINTOL/0.01\nCSI_ANY/X\nMACHIN/ANY, 3\nREWIND/0";
    assert_eq!(ops(&format!("{silent}\nGOTO/1,2,3")), [Op::Line(at(1., 2., 3.))]);
}

#[test]
fn every_pose_is_an_axis_in_the_work_frame() {
    let ops = ops("RAPID\nGOTO/1,2,3,0,0,5\nGOTO/4,5,6,3,0,4");
    for op in ops {
        let Orientation::Axis(axis) = op.pose().unwrap().orientation else { panic!("{op:?}") };
        assert!((axis.length() - 1.0).abs() < 1e-12);
    }
}
