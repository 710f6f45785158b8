//! Motion: `GOTO`, `RAPID`, `FROM`, `GODLTA`.

use crate::support::{HEAD, HEAD_OPS, Z, assert_poses, at, error, ops, reading, warnings};
use program::Op;

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
        ("GOTO/1,2,3\nGOTO/10,,", vec![([1., 2., 3.], up), ([10., 2., 3.], up)]),
        ("GOTO/1,2,3\nGOTO/,5,", vec![([1., 2., 3.], up), ([1., 5., 3.], up)]),
        // A comma at the end continues the statement where no other begins.
        ("GOTO/1,2,3\nGOTO/10,,\n7", vec![([1., 2., 3.], up), ([10., 2., 7.], up)]),
        ("GOTO/1,2,3\nCUTCOM/OFF,GOTO/,,9", vec![([1., 2., 3.], up), ([1., 2., 9.], up)]),
        ("FROM/7,8,9\nRAPID\nGOTO/,0,", vec![([7., 0., 9.], up)]),
        (
            "GOTO/1,2,3,0,.6,.8\nGOTO/4,5,6,,,",
            vec![([1., 2., 3.], [0., 0.6, 0.8]), ([4., 5., 6.], [0., 0.6, 0.8])],
        ),
        // From 0, 0.6, 0.8 only the middle value changes; the vector keeps its length of 1.
        (
            "GOTO/1,2,3,0,.6,.8\nGOTO/,,,,-.6,",
            vec![([1., 2., 3.], [0., 0.6, 0.8]), ([1., 2., 3.], [0., -0.6, 0.8])],
        ),
        ("GOTO/1,2,3,0,0,\nGOTO/1,2,3", vec![([1., 2., 3.], up), ([1., 2., 3.], up)]),
        ("GOTO/1,2,3,0,0,-250", vec![([1., 2., 3.], [0., 0., -1.])]),
    ] {
        let ops = ops(text);
        let moves = |op: &Op| matches!(op, Op::Line(_) | Op::Rapid(_) | Op::Compensation(_));
        assert!(ops.iter().all(moves), "{text}");
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
        // No earlier point, a value too many, and vectors of parts that do not belong together.
        ("GOTO/10,,", "malformed"),
        ("GOTO/1,2,3\nGOTO/10,,,", "malformed"),
        ("GOTO/1,2,3\nGODLTA/1,,", "malformed"),
        ("GOTO/1,2,3,1,0,", "tool-axis"),
        ("GOTO/1,2,3,,0,0", "tool-axis"),
        ("GOTO/1,2,1000001", "out-of-range"),
        ("GOTO/1,2,1e308", "out-of-range"),
        ("GOTO/1,2,1e999", "malformed"),
        ("N10 GOTO/1,2,3", "malformed"),
    ] {
        assert_eq!(error(text), rule, "{text}");
    }
}

#[test]
fn a_tilted_tool_without_a_vector_is_in_doubt_where_the_system_always_gives_it() {
    let tilted = "GOTO/1,2,3,1,0,0\nGOTO/4,5,6";
    assert_eq!(ops(tilted).len(), 2);
    assert_eq!(error(&format!("CSI_X/1\n{tilted}")), "tool-axis");
    // A set-up turns the tool along its own Z.
    let set_up =
        "CSI_X/1\nGOTO/1,2,3,1,0,0\nTRNTYP/WORLD,0,0,0\nCSYS/1,0,0,0,0,1,0,0,0,0,1,0\nGOTO/4,5,6";
    assert_poses(&ops(set_up), &[([1., 2., 3.], [1., 0., 0.]), ([4., 5., 6.], Z)]);
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
fn every_pose_is_an_axis_in_the_work_frame() {
    let ops = ops("RAPID\nGOTO/1,2,3,0,0,5\nGOTO/4,5,6,3,0,4");
    for op in ops {
        let axis = op.pose().unwrap().axis();
        assert!((axis.length() - 1.0).abs() < 1e-12);
    }
}
