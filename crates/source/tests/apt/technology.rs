//! Feed, spindle, tool, coolant, compensation, dwell and stop.

use crate::support::{HEAD, at, error, ops, reading, warnings};
use program::{Compensation, Coolant, Feed, Op, Spindle, Tool};
use toolpost_source::apt::{Options, read};

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

/// 150 m/min are 11937 1/min on 4 mm, 3979 on 12 mm and 955 on 50 mm.
#[test]
fn a_surface_speed_means_another_speed_on_each_tool() {
    let speeds = |text: &str| {
        let text = format!("CUTTER/4\nSPINDL/SMM,150,CCLW{text}\nRAPID\nGOTO/1,2,9");
        let ops = ops(&text);
        let rpm = |op: &Op| match op {
            Op::Tool(tool) => Some(-f64::from(tool.number)),
            Op::Spindle(Spindle::CounterClockwise(rpm)) => Some(rpm.round()),
            Op::Spindle(Spindle::Off) => Some(0.0),
            _ => None,
        };
        ops.iter().filter_map(rpm).collect::<Vec<f64>>()
    };
    let next = "\nRAPID\nGOTO/0,0,9";
    let cases: [(String, &[f64]); 10] = [
        (format!("{next}\nCUTTER/12\nLOAD/TOOL,2"), &[11937., -2., 3979.]),
        (format!("{next}\nLOAD/TOOL,2\nCUTTER/12"), &[11937., -2., 3979.]),
        (format!("{next}\nLOAD/TOOL,2\nCUTTER/4"), &[11937., -2.]),
        (format!("{next}\nCUTTER/12\nSPINDL/CCLW\nLOAD/TOOL,2"), &[11937., 11937., -2., 3979.]),
        (format!("{next}\nLOAD/TOOL,2\nCUTTER/12\nSPINDL/ON"), &[11937., -2., 3979.]),
        (format!("{next}\nSPINDL/OFF\nLOAD/TOOL,2\nCUTTER/12"), &[11937., 0., -2.]),
        (
            format!("{next}\nSPINDL/OFF\nLOAD/TOOL,2\nCUTTER/12{next}\nSPINDL/ON"),
            &[11937., 0., -2., 3979.],
        ),
        (
            format!("{next}\nCUTTER/12\nLOAD/TOOL,2{next}\nCUTTER/50\nLOAD/TOOL,3"),
            &[11937., -2., 3979., -3., 955.],
        ),
        (format!(",MAXRPM,5000{next}\nCUTTER/12\nLOAD/TOOL,2"), &[5000., -2., 3979.]),
        (
            format!("{next}\nSPINDL/700,RPM,CCLW{next}\nCUTTER/12\nLOAD/TOOL,2"),
            &[11937., 700., -2.],
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(speeds(&text), expected, "{text}");
    }
    let head = "CUTTER/4\nSPINDL/SMM,150,CLW\nRAPID\nGOTO/0,0,9\n";
    assert_eq!(error(&format!("{head}LOAD/TOOL,2\nRAPID\nGOTO/0,0,9")), "spindle");
    assert_eq!(
        error(&format!("{head}SPINDL/OFF\nLOAD/TOOL,2\nRAPID\nGOTO/0,0,9\nSPINDL/ON")),
        "malformed"
    );
}

#[test]
fn maxrpm_caps_a_surface_speed_and_the_gear_range_is_named() {
    let speed = |text: &str| {
        let reading = reading(&format!("{HEAD}CUTTER/10,0\n{text}\nRAPID\nGOTO/1,2,3\nFINI"));
        let speed = reading.program.records.iter().rev().find_map(|r| match r.op {
            Op::Spindle(spindle) => Some(spindle),
            _ => None,
        });
        let rules: Vec<&str> = reading.warnings.iter().map(|w| w.rule.name()).collect();
        (speed.unwrap(), rules)
    };
    // 100 m/min on a diameter of 10 mm are 3183 1/min, 60 m/min are 1910.
    assert_eq!(speed("SPINDL/SMM,100,MAXRPM,2500,CLW"), (Spindle::Clockwise(2500.0), vec![]));
    let (slow, rules) = speed("SPINDL/SMM,60,CCLW,MAXRPM,2500");
    let Spindle::CounterClockwise(rpm) = slow else { panic!("{slow:?}") };
    assert!((rpm - 1909.859).abs() < 1e-3 && rules.is_empty(), "{rpm}");
    assert_eq!(speed("SPINDL/2000,RPM,MAXRPM,2500"), (Spindle::Clockwise(2000.0), vec![]));
    for range in ["LOW", "MEDIUM", "HIGH", "2"] {
        let (spindle, rules) = speed(&format!("SPINDL/RPM,700,RANGE,{range},CLW"));
        assert_eq!((spindle, rules), (Spindle::Clockwise(700.0), vec!["spindle-range"]), "{range}");
    }
    // The range alone does not turn the spindle on.
    assert_eq!(speed("SPINDL/OFF\nSPINDL/RANGE,2"), (Spindle::Off, vec!["spindle-range"]));
    for (text, rule) in [
        ("SPINDL/3000,RPM,MAXRPM,2500", "spindle"),
        ("SPINDL/SMM,100,MAXRPM,0", "spindle"),
        ("SPINDL/MAXRPM,2500", "spindle"),
        ("SPINDL/700,MAXRPM", "malformed"),
        ("SPINDL/700,RANGE,FAST", "malformed"),
    ] {
        assert_eq!(error(&format!("CUTTER/10\n{text}")), rule, "{text}");
    }
}

/// Whether an older MAXRPM caps a surface speed that does not say it, nothing says: one that it would cap is refused, in whatever statement or
/// on whatever tool.
#[test]
fn a_surface_speed_above_an_older_maxrpm_is_refused() {
    let speed = |text: &str| {
        let reading = reading(&format!("{HEAD}CUTTER/10,0\n{text}\nRAPID\nGOTO/1,2,3\nFINI"));
        let mut speeds = reading.program.records.iter().filter_map(|record| match record.op {
            Op::Spindle(spindle) => Some(spindle),
            _ => None,
        });
        let Some(Spindle::Clockwise(speed)) = speeds.next_back() else { panic!("{text}") };
        speed.round()
    };
    // 100 m/min on a diameter of 10 mm are 3183 1/min, on 4 mm 7958; 60 m/min on 10 mm are 1910.
    let older = "SPINDL/SMM,60,CLW,MAXRPM,2500";
    assert_eq!(speed(&format!("{older}\nSPINDL/SMM,60,CLW")), 1910.0);
    assert_eq!(speed(&format!("{older}\nSPINDL/SMM,100,CLW,MAXRPM,2600")), 2600.0);
    assert_eq!(speed(&format!("{older}\nSPINDL/SMM,100,CLW,MAXRPM,9000")), 3183.0);
    // It is for surface speeds alone.
    assert_eq!(speed(&format!("{older}\nSPINDL/6000,RPM,CLW")), 6000.0);
    for text in [
        format!("CUTTER/10\n{older}\nSPINDL/SMM,100,CLW"),
        format!("CUTTER/10\n{older}\nSPINDL/900,RPM\nSPINDL/SMM,100,CLW"),
        format!(
            "CUTTER/10\n{older}\nSPINDL/SMM,70,CLW\nRAPID\nGOTO/0,0,9\nCUTTER/4\nLOAD/TOOL,2\nRAPID\nGOTO/0,0,9"
        ),
    ] {
        assert_eq!(error(&text), "spindle", "{text}");
    }
}

#[test]
fn coolants_compensations_dwells_and_stops() {
    let coolants = |kinds: &[Coolant]| kinds.iter().map(|kind| Op::Coolant(*kind)).collect();
    let (flood, mist, through) = (Coolant::Flood, Coolant::Mist, Coolant::Through);
    let cases: [(&str, Vec<Op>); 22] = [
        ("COOLNT/ON", vec![Op::Coolant(Coolant::Flood)]),
        ("COOLNT/FLOOD", vec![Op::Coolant(Coolant::Flood)]),
        ("COOLNT/MIST", vec![Op::Coolant(Coolant::Mist)]),
        ("COOLNT/THRU", vec![Op::Coolant(Coolant::Through)]),
        ("COOLNT/OFF", vec![Op::Coolant(Coolant::Off)]),
        ("COOLNT/ON,FLOOD", coolants(&[flood])),
        ("COOLNT/THRU,ON", coolants(&[through])),
        ("COOLNT/MIST\nCOOLNT/OFF\nCOOLNT/ON", coolants(&[mist, Coolant::Off, mist])),
        ("COOLNT/MIST\nCOOLNT/FLOOD,ON\nCOOLNT/ON", coolants(&[mist, flood, flood])),
        ("CUTCOM/LEFT", vec![Op::Compensation(Compensation::Left(None))]),
        ("CUTCOM/RIGHT,12", vec![Op::Compensation(Compensation::Right(Some(12)))]),
        ("CUTCOM/LEFT,ADJUST,3", vec![Op::Compensation(Compensation::Left(Some(3)))]),
        ("CUTCOM/ADJUST,5,LEFT", vec![Op::Compensation(Compensation::Left(Some(5)))]),
        ("CUTCOM/ADJUST,5,RIGHT,XYPLAN", vec![Op::Compensation(Compensation::Right(Some(5)))]),
        (
            "CUTCOM/ADJUST,5,LEFT,GOTO/1,2,3",
            vec![Op::Compensation(Compensation::Left(Some(5))), Op::Line(at(1., 2., 3.))],
        ),
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
        ("DELAY/SEC,2", vec![Op::Dwell(2.0)]),
        // Ten turns at 1000 1/min.
        ("DELAY/10,REV", vec![Op::Dwell(0.6)]),
        ("STOP\nOPSTOP", vec![Op::Stop, Op::OptionalStop]),
    ];
    for (text, expected) in cases {
        let mut expected = expected;
        expected.push(Op::Line(at(9., 9., 9.)));
        assert_eq!(ops(&format!("{text}\nGOTO/9,9,9")), expected, "{text}");
    }
    for text in [
        "COOLNT/BEER",
        "COOLNT/ON,BEER",
        "COOLNT/ON,OFF",
        "COOLNT/OFF,MIST",
        "COOLNT/FLOOD,MIST",
        "COOLNT/ON,ON",
        "CUTCOM/UP",
        "CUTCOM/ON",
        "CUTCOM/5,LEFT",
        "CUTCOM/LEFT,RIGHT",
        "CUTCOM/LEFT,ADJUST",
        // An offset of the fixture in some systems.
        "CUTCOM/ADJUST,5",
        "DELAY/1,HOUR",
    ] {
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
    assert_eq!(warnings("LOAD/TOOL,7,ZOFF,25.4,ADJUST,3\nRAPID\nGOTO/0,0,0"), ["tool-offset"]);
    assert_eq!(tool("LOAD/TOOL,7,ZOFF,0.0"), plain);
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
    assert_eq!(first.warnings[0].rule.name(), "tool-number");
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
    assert_eq!(errors.unwrap_err()[0].rule.name(), "tool-change");
    // With its own LOAD it is changed to; but then the number of the first tool is to be said as well.
    let loaded = second.replace("GOTO", "LOAD/TOOL,2\nGOTO");
    let first_unknown = read("t.cls", format!("{text}{loaded}").as_bytes(), &Options::default());
    assert_eq!(first_unknown.unwrap_err()[0].rule.name(), "tool-number");
    let first = text.replace("SPINDL", "LOAD/TOOL,1\nSPINDL");
    let both = reading(&format!("{first}{loaded}"));
    assert!(both.program.records.iter().any(|r| matches!(&r.op, Op::Tool(t) if t.name == "DRILL")));
}

#[test]
fn a_rapid_before_the_first_load_is_made_with_that_tool_and_a_cut_is_refused() {
    // A tool change of CATIA: its point, then the description, then the load.
    let change = "UNITS/MM\nSPINDL/70,RPM,CLW\nRAPID\nGOTO/0,0,100\nCUTTER/10,2\nTOOLNO/5,10\n\
                  TPRINT/Mill D 10\nLOADTL/5\n";
    let rest = "FEDRAT/300,MMPM\nRAPID\nGOTO/1,0,50\nGOTO/1,0,-1\nFINI";
    let text = format!("{change}{rest}");
    let read_so = reading(&text);
    let tool = Tool {
        number: 5,
        name: "Mill D 10".into(),
        diameter: Some(10.0),
        corner_radius: Some(2.0),
        ..Tool::default()
    };
    let ops: Vec<&Op> = read_so.program.records.iter().map(|r| &r.op).collect();
    let expected = [
        Op::Spindle(Spindle::Clockwise(70.0)),
        Op::Tool(Box::new(tool)),
        Op::Rapid(at(0., 0., 100.)),
        Op::Feed(Feed::PerMinute(300.0)),
        Op::Rapid(at(1., 0., 50.)),
        Op::Line(at(1., 0., -1.)),
        Op::End,
    ];
    assert_eq!(ops, expected.iter().collect::<Vec<_>>());
    let [warning] = &read_so.warnings[..] else { panic!("{:?}", read_so.warnings) };
    assert_eq!((warning.rule.name(), warning.line), ("tool-number", 4));
    assert!(warning.message.contains("line 4 ") && warning.message.contains("line 8)"));
    // The tool is described after the load as well.
    let after = reading(&text.replace("LOADTL/5\n", "LOADTL/5\nCUTTER/12\n"));
    assert!(matches!(&after.program.records[1].op, Op::Tool(t) if t.diameter == Some(12.0)));
    // A cut, a cut after a rapid, another tool, and a load that is none.
    let cut = text.replace("RAPID\nGOTO/0", "FEDRAT/9,MMPM\nGOTO/0");
    let second = text.replace("CUTTER/10,2", "FEDRAT/9,MMPM\nGOTO/0,0,99");
    let other = text.replace("RAPID\nGOTO/0", "CUTTER/8\nRAPID\nGOTO/0");
    let none = format!("{}{}", change.replace("LOADTL/5\n", "LINTOL/1,$\nLOADTL,5\n"), "FINI");
    for (text, line, named) in
        [(cut, 4, "line 8)"), (second, 6, "line 9)"), (other, 9, "line 5 "), (none, 10, "line 9 ")]
    {
        let error = read("t.apt", text.as_bytes(), &Options::default()).unwrap_err().remove(0);
        assert_eq!((error.rule.name(), error.line), ("tool-number", line), "{text}");
        assert!(error.message.contains(named), "{}", error.message);
        assert!(!error.help.is_empty());
    }
}

/// `AUXFUN/n` is the M function of that number (ISO 4343): it stays between the motions where it stands.
#[test]
fn a_function_of_the_builder_stays_where_it_stands() {
    let text = "GOTO/0,0,5\nAUXFUN/21\nGOTO/1,2,3\nAUXFUN/22\nGOTO/4,5,6";
    let functions = |number| Op::Auxiliary(program::Auxiliary::of(number));
    let own = [
        Op::Line(at(0., 0., 5.)),
        functions(21),
        Op::Line(at(1., 2., 3.)),
        functions(22),
        Op::Line(at(4., 5., 6.)),
    ];
    assert_eq!(ops(text), own);
    for wrong in
        ["AUXFUN", "AUXFUN/", "AUXFUN/M", "AUXFUN/1.5", "AUXFUN/-1", "AUXFUN/1,2", "AUXFUN/1e12"]
    {
        assert_eq!(error(&format!("GOTO/0,0,5\n{wrong}")), "malformed", "{wrong}");
    }
}

/// ISO 4343, `INTOL`, `OUTTOL`, `TOLER`: modal. What is 0 is no tolerance, and ends the one before.
#[test]
fn a_tolerance_holds_until_another_one_or_none_is_said() {
    use program::PathMode::{AsSetUp, Blend};
    let modes = |text: &str| {
        let modes = ops(text).into_iter().filter_map(|op| match op {
            Op::PathMode(mode) => Some(mode),
            _ => None,
        });
        modes.collect::<Vec<_>>()
    };
    let go = |x: u32| format!("\nGOTO/{x},0,0\n");
    let after = |first: &str, then: &str| modes(&format!("{first}{}{then}{}", go(1), go(2)));
    let tight = "INTOL/0.5\nOUTTOL/0.25";
    assert_eq!(after(tight, "INTOL/0\nOUTTOL/0"), [Blend(0.75), AsSetUp]);
    assert_eq!(after(tight, "TOLER/0"), [Blend(0.75), AsSetUp]);
    assert_eq!(after(tight, "INTOL/0"), [Blend(0.75), Blend(0.25)]);
    assert_eq!(after(tight, "OUTTOL/0.5"), [Blend(0.75), Blend(1.0)]);
    // The same again is nothing new, and none before the first is none.
    assert_eq!(after(tight, tight), [Blend(0.75)]);
    assert_eq!(after("INTOL/0\nOUTTOL/0", tight), [Blend(0.75)]);
    assert_eq!(after("TOLER/0", "TOLER/0"), [AsSetUp; 0]);
    assert_eq!(after("TOLER/0.5,0.25", "TOLER/0.25"), [Blend(0.25)]);
}

/// What a motion needs is looked at once, and again behind a statement that changes it.
#[test]
fn what_a_cut_needs_is_asked_for_again_behind_what_changes_it() {
    let cuts = "GOTO/0,0,0\nGOTO/1,0,0\n";
    assert_eq!(error(&format!("{cuts}SPINDL/OFF\nGOTO/2,0,0")), "spindle-off");
    assert_eq!(error(&format!("{cuts}FEDRAT/0,MMPM\nGOTO/2,0,0")), "no-feed");
    // The feed of a cycle ends with it.
    let drilled = "UNITS/MM\nLOAD/TOOL,1\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,5\n\
                   CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,1\nGOTO/0,0,0\nCYCLE/OFF\n";
    let text = format!("{drilled}GOTO/1,0,0\nFINI\n");
    let found = read("a.apt", text.as_bytes(), &Options::default()).unwrap_err();
    assert_eq!(found[0].rule.name(), "no-feed");
    // From the point of FROM the next motion begins, also in the middle.
    let from = reading(&format!("{HEAD}{cuts}FROM/9,9,9\nGOTO/2,0,0\nFINI\n"));
    assert!(from.program.records.iter().any(|r| r.op == Op::Rapid(at(9., 9., 9.))));
    // What is said of a tool behind its first motion is said of the next one.
    let text = format!("{HEAD}{cuts}LOAD/TOOL,2\nGOTO/2,0,0\nCUTTER/10\nGOTO/3,0,0\nFINI\n");
    let tools = reading(&text).program.records.into_iter().filter_map(|r| match r.op {
        Op::Tool(tool) => Some((tool.number, tool.diameter)),
        _ => None,
    });
    assert_eq!(tools.collect::<Vec<_>>(), [(1, None), (2, None)]);
}

#[test]
fn a_cut_for_a_described_tool_that_is_not_loaded_is_refused() {
    let cuts = "GOTO/0,0,0\nGOTO/1,0,0\n";
    let loaded = format!("UNITS/MM\nCUTTER/10,1\nLOADTL/1\nSPINDL/900,CLW\nFEDRAT/9,MMPM\n{cuts}");
    let refused = |text: &str| {
        let found = read("a.apt", format!("{loaded}{text}FINI\n").as_bytes(), &Options::default());
        let found = found.unwrap_err().remove(0);
        (found.rule.name(), found.line, found.message)
    };
    for (text, line, words) in [
        ("CUTTER/14,1\nGOTO/2,0,0\n", 9, "14 mm"),
        ("CUTTER/14,1\nRAPID\nGOTO/0,0,9\nGOTO/2,0,0\n", 11, "line 8"),
        ("CUTTER/10,0.5\nGOTO/2,0,0\n", 9, "0.5 mm"),
        ("TLDATA/MILL,14,1,75,0,0\nGOTO/2,0,0\n", 9, "14 mm"),
        ("$$-> CUTTER / 14.000000\nGOTO/2,0,0\n", 9, "14 mm"),
    ] {
        let (rule, at, message) = refused(text);
        assert_eq!((rule, at), ("tool-change", line), "{text}");
        assert!(message.contains(words), "{message}");
    }
    // The same cutter once more, and one that is loaded behind a rapid.
    let fine = "CUTTER/10,1\nGOTO/2,0,0\nCUTTER/14\nRAPID\nGOTO/0,0,9\nLOADTL/2\nGOTO/3,0,0\nLOADTL/3\nGOTO/4,0,0\n";
    let tools = reading(&format!("{loaded}{fine}FINI\n")).program.records.into_iter().filter_map(
        |r| match r.op {
            Op::Tool(tool) => Some((tool.number, tool.diameter)),
            _ => None,
        },
    );
    assert_eq!(tools.collect::<Vec<_>>(), [(1, Some(10.0)), (2, Some(14.0)), (3, None)]);
    // What is described behind the first motion of a tool of unknown size is not passed on, and is said.
    assert_eq!(warnings(&format!("{cuts}CUTTER/10\nGOTO/2,0,0")), ["tool-change"]);
}

/// A head, a register or a length that a statement names, and no program says.
#[test]
fn what_set_and_toolno_say_of_the_job_is_not_dropped_without_a_word() {
    let warned = |line: &str| {
        let text = format!("UNITS/MM\nLOADTL/1\n{line}\nRAPID\nGOTO/0,0,100\nFINI");
        let found = reading(&text).warnings;
        found.iter().any(|found| found.rule.name() == "ignored-word" && found.line == 3)
    };
    for line in
        ["SET/HOLDER,90", "SET/OFFSETL,7", "SET/ADJUST,7", "TOOLNO/ADJUST,7", "TOOLNO/1,LENGTH,80"]
    {
        assert!(warned(line), "{line}");
    }
    for line in ["SET/MODE,ABSOL", "TOOLNO/1,10"] {
        assert!(!warned(line), "{line}");
    }
}
