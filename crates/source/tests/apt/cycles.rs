//! `CYCLE` and its holes.

use crate::support::{HEAD, at, error, ops, reading, warnings};
use program::{Cycle, CycleKind, Feed, Op, Pose};
use toolpost_source::apt::{Options, read};

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
    let cases: [(String, Cycle); 20] = [
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
        (format!("CYCLE/BORE,{all}"), Cycle { kind: CycleKind::Ream, ..drill }),
        (format!("CYCLE/BORE,DRAG,{all}"), Cycle { kind: CycleKind::Bore, ..drill }),
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
fn pitch_hand_and_turns_are_those_at_the_hole() {
    // Kinds and dwells of the cycles written, in their order.
    let written = |text: &str| -> Vec<(CycleKind, f64)> {
        let cycles = ops(text).into_iter().filter_map(|op| match op {
            Op::Cycle(cycle) => Some((cycle.kind, cycle.dwell)),
            _ => None,
        });
        cycles.collect()
    };
    let tap = |pitch, left| (CycleKind::Tap { pitch, left }, 0.0);
    // The speed comes after the cycle: 500 mm/min at 500 1/min, not at 1000.
    let late = "CYCLE/TAP,FEDTO,10,RAPTO,5,MMPM,500\nSPINDL/RPM,500,CLW\nGOTO/30,10,0";
    assert_eq!(written(late), [tap(1.0, false)]);
    // The feed changes between two holes: 500 / 500, then 625 / 500; the third is as the second.
    let between = "SPINDL/500,CLW\nFEDRAT/500,MMPM\nCYCLE/TAP,FEDTO,10,RAPTO,5\nGOTO/10,0,0\n\
                   FEDRAT/625,MMPM\nGOTO/20,0,0\nGOTO/30,0,0";
    assert_eq!(written(between), [tap(1.0, false), tap(1.25, false)]);
    let hand = "FEDRAT/1,MMPR\nCYCLE/TAP,FEDTO,10,RAPTO,5\nSPINDL/RPM,400,CCLW\nFEDRAT/1.5,MMPR\n\
                GOTO/30,10,0";
    assert_eq!(written(hand), [tap(1.5, true)]);
    // Five turns are 0.6 s at 500 1/min and 0.3 s at 1000.
    let dwell = "CYCLE/FACE,FEDTO,10,RAPTO,5,DWELL,REV,5\nSPINDL/500,CLW\nGOTO/1,0,0\n\
                 SPINDL/1000,CLW\nGOTO/2,0,0";
    assert_eq!(written(dwell), [(CycleKind::Drill, 0.6), (CycleKind::Drill, 0.3)]);
    // The pitch is asked for where the hole is.
    let inverse = "FEDRAT/INVERS,2\nCYCLE/TAP,FEDTO,5,RAPTO,3";
    assert_eq!(written(&format!("{inverse}\nFEDRAT/1,MMPR\nGOTO/1,0,0")), [tap(1.0, false)]);
    assert_eq!(error(&format!("{inverse}\nGOTO/1,0,0")), "tap-pitch");
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
    assert_eq!(kind("CYCLE/DRILL,RAPTO,3,FEDTO,8").unwrap_err()[0].rule.name(), "cycle-depth");
}

#[test]
fn words_of_one_control_are_named_and_bores_of_another_kind_refused() {
    let rest = "RAPTO,3,FEDTO,5,MMPR,1.25";
    for (text, rule) in [
        (format!("CYCLE/DRILL,{rest},OPTION"), "ignored-word"),
        (format!("CYCLE/DRILL,OPTION,1,{rest}"), "ignored-word"),
        (format!("CYCLE/DRILL,{rest},CAM,2"), "ignored-word"),
        (format!("CYCLE/TAP,FLOAT,{rest}"), "tap-holder"),
    ] {
        let program = reading(&format!("{HEAD}{text}\nGOTO/1,2,0\nFINI")).program;
        let cycle = program.records.iter().find_map(|r| match &r.op {
            Op::Cycle(cycle) => Some(**cycle),
            _ => None,
        });
        let cycle = cycle.unwrap();
        assert_eq!((cycle.depth, cycle.clearance), (5.0, 3.0), "{text}");
        if rule == "tap-holder" {
            assert_eq!(cycle.kind, CycleKind::Tap { pitch: 1.25, left: false });
        }
        assert_eq!(warnings(&format!("{text}\nGOTO/1,2,0")), [rule], "{text}");
    }
    assert_eq!(error(&format!("CYCLE/DRILL,{rest},CAM")), "malformed");
    for word in ["NODRAG", "BACK", "MANUAL"] {
        let text = format!("{HEAD}CYCLE/BORE,{word},{rest}\nGOTO/1,2,0\nFINI");
        let error = read("b.apt", text.as_bytes(), &Options::default()).unwrap_err().remove(0);
        assert_eq!((error.rule.name(), error.line, error.column), ("unsupported", 5, 7));
        assert!(error.message.starts_with(&format!("BORE,{word} ")) && !error.help.is_empty());
    }
}

#[test]
fn a_cycle_by_position_is_refused_with_the_way_out_of_its_system() {
    for (sign, way_out) in [
        ("$$ Start generation of : Drilling.1", "PP table"),
        ("$$* Pro/CLfile", "cycle_format to couplet"),
        ("$$ any", "FEDTO,depth"),
    ] {
        let text = format!("{sign}\n{HEAD}CYCLE/DRILL,10.,300.,MMPM,2.\nGOTO/1,2,0\nFINI");
        let error = read("b.apt", text.as_bytes(), &Options::default()).unwrap_err().remove(0);
        assert_eq!((error.rule.name(), error.line, error.column), ("unsupported", 6, 13));
        assert!(error.message.contains("by position") && error.help.contains(way_out), "{sign}");
    }
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
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,DWELL,1,REV,5", "malformed"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,REV,-1", "dwell"),
        ("CYCLE/DRILL,10,200,MMPM,3", "unsupported"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,ORIENT,90", "unsupported"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO", "malformed"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,INCR,2", "peck"),
        ("CYCLE/DEEP,FEDTO,5,RAPTO,3", "peck"),
        ("CYCLE/DEEP,FEDTO,5,RAPTO,3,INCR,0", "peck"),
        ("CYCLE/DEEP,FEDTO,5,RAPTO,3,INCR,0.000001", "peck"),
        ("CYCLE/TAP,FEDTO,5,RAPTO,3,TPI,0", "tap-pitch"),
        ("CYCLE/MILL,FEDTO,5,RAPTO,3", "unsupported"),
        ("CYCLE/CSINK,DIAMETR,20,RAPTO,3", "cycle-depth"),
        ("CYCLE/ON", "malformed"),
        ("RAPID\nCYCLE/DRILL,FEDTO,5,RAPTO,3\nGOTO/0,0,0", "unsupported"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3,RTRCTO,AUTO\nGOTO/0,0,0", "no-start"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3\nCIRCLE/0,0,0,0,0,1\nGOTO/0,0,0", "unsupported"),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3\nGOTO/0,0,0\nCYCLE/OFF\nGODLTA/0,0,5", "no-start"),
        // The next GOTO would be a hole of the new tool.
        ("CYCLE/DRILL,FEDTO,5,RAPTO,3\nGOTO/0,0,0\nLOAD/TOOL,7\nGOTO/1,0,0", "cycle-on"),
    ] {
        assert_eq!(error(text), rule, "{text}");
    }
    assert_eq!(warnings("CYCLE/DRILL,FEDTO,5,RAPTO,3,RTRCTO,1\nGOTO/0,0,0"), ["retract"]);
    assert_eq!(warnings("CYCLE/DRILL,FEDTO,5,RAPTO,3,CLEAR,5\nGOTO/0,0,0"), ["clear-plane"]);
}
