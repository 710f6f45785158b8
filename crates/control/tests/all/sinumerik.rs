//! Blocks, words, modes and arcs of the SINUMERIK virtual control, against hand calculation.

use crate::common::sinumerik::{arcs, blocks, degrees, near, points, poses, run, v};
use program::{Axes, Compensation, Coolant, Feed, MachineMove, Spindle, WorkOffset};
use std::f64::consts::FRAC_1_SQRT_2;
use toolpost_control::{Action, Orientation, Position};

#[test]
fn the_block_style_of_the_source_system_runs() {
    let text = "N1T1D1\nN2M6\nN3G0G54G64G90G94\nN4FGROUP(X,Y,Z,A,C)\nN5S3000M3\nN6M27M29\n\
                N7G0A30C=45+R24\nN8M26M28\nN9X10\nN10Y20M8\nN11Z30\nN12G1X12.5F200\nN13G41Y25\n\
                N14G40Y30\nN15Z100\nN16G54\nN17G75Z0M5M9\nN18M17\n";
    let records = run(text).unwrap_or_else(|error| panic!("{error}"));
    let pose = |x: f64, y: f64, z: f64| Position {
        point: v(x, y, z),
        orientation: Orientation::Rotary { degrees: [30.0, 0.0, 45.0], tool_center: false },
    };
    let expected: Vec<(u32, Action)> = vec![
        (1, Action::Preselect(1)),
        (1, Action::LengthOffset(Some(1))),
        (3, Action::WorkOffset(WorkOffset::FIRST)),
        (5, Action::Spindle(Spindle::Clockwise(3000.0))),
        (10, Action::Coolant(Coolant::Flood)),
        (12, Action::Feed(Feed::PerMinute(200.0))),
        (12, Action::Line(pose(12.5, 20.0, 30.0))),
        (13, Action::Compensation(Compensation::Left(Some(1)))),
        (13, Action::Line(pose(12.5, 25.0, 30.0))),
        (14, Action::Compensation(Compensation::Off)),
        (14, Action::Line(pose(12.5, 30.0, 30.0))),
        (15, Action::Line(pose(12.5, 30.0, 100.0))),
        (17, Action::Spindle(Spindle::Off)),
        (17, Action::Coolant(Coolant::Off)),
        (17, Action::Home(Axes::Z)),
        (18, Action::End),
    ];
    let mut rest = records.iter();
    for (line, op) in expected {
        let found = rest.any(|record| record.line == line && record.action == op);
        assert!(found, "{op:?} is missing in order at line {line}: {records:#?}");
    }
}

#[test]
fn a_coordinate_that_no_block_has_said_is_not_known() {
    let records = run("G0 X1\nM30\n").unwrap();
    let Action::Rapid(pose) = records[0].action else { panic!() };
    assert!(pose.point.x == 1.0 && pose.point.y.is_nan() && pose.point.z.is_nan());
    assert!(degrees(&pose).0[0].is_nan() && degrees(&pose).0[1] == 0.0);
}

#[test]
fn numbers_are_read_in_every_form() {
    assert_eq!(points("G0 X.5 Y-2. Z+003")[0], v(0.5, -2.0, 3.0));
    assert_eq!(points("G0 X1.5EX2 Y=-.1EX-1 Z 7")[0], v(150.0, -0.01, 7.0));
    assert_eq!(points("G00 x1y2Z0.123456789012345678")[0], v(1.0, 2.0, 0.123_456_789_012_345_68));
}

#[test]
fn expressions_follow_the_rank_of_their_operators() {
    for (expression, value) in [
        ("1+1-1+-1", 0.0),
        ("-2/3", -2.0 / 3.0),
        ("7 DIV 3", 2.0),
        ("3 MOD 4", 3.0),
        ("2+3*4-6/2", 11.0),
        ("(2+3)*4", 20.0),
        ("2*-3", -6.0),
        ("10-4-3", 3.0),
        ("SIN(30)+COS(60)", 1.0),
        // The example of the manual, to its four decimals.
        ("ATAN2(30.5,80.1)", 20.8455),
        ("SQRT(POT(3)+POT(4))", 5.0),
        ("TRUNC(2.7)+ROUND(2.7)+ABS(-1)", 6.0),
        ("R1+R[R2]*2", 31.0),
    ] {
        let point = points(&format!("R1=1 R2=3\nR3=15\nG0 X={expression}"))[0];
        assert!((point.x - value).abs() < 5e-5, "{expression} is {value}, not {}", point.x);
    }
}

#[test]
fn header_labels_skip_marks_and_comments_are_read() {
    let text = "%_N_PART_1_MPF\r\n;$PATH=/_N_MPF_DIR\r\n\r\n/1 N10 G0 X1 ; first\r\n\
                :20 NEXT_PART: Y2\r\nN30 MSG(\"a;b\")\r\nN40 M30\r\n; done\r\n";
    let ops: Vec<Action> = run(text).unwrap().into_iter().map(|record| record.action).collect();
    assert_eq!(ops[0], Action::Comment("$PATH=/_N_MPF_DIR".into()));
    assert_eq!(ops[1], Action::Comment("first".into()));
    assert_eq!(poses(&ops)[1].point.y, 2.0);
    assert_eq!(ops[4], Action::Message("a;b".into()));
    assert_eq!(ops[5], Action::End);
    assert_eq!(ops.len(), 6);
}

#[test]
fn words_that_do_not_move_leave_no_trace() {
    let text = "G60 G601 SOFT FFWON COMPCAD G642 DYNFINISH\n\
                FGROUP(X,Y,Z)\nM40\nM26 M28\nSTOPRE\nCYCLE832()\nORIWKS ORIAXES\nFNORM\nSETMS\n\
                SETMS(1)\nGROUP_BEGIN(0,\"HEAD\",0,0)\nGROUP_ADDEND(0,0)\nGROUP_END(0,0)\nG64\nCOMPOF\nBRISK\nFFWOF\nDYNNORM";
    let text = text.replace("ORIWKS ORIAXES", "ORIWKS\nORIAXES");
    let text = text.replace("G60 G601", "G601");
    let functions = [26, 28].map(|number| Action::Auxiliary(program::Auxiliary::of(number)));
    assert_eq!(blocks(&text), [&functions[..], &[Action::End]].concat());
}

#[test]
fn incremental_words_count_from_the_last_programmed_place() {
    let expected = [v(10.0, 0.0, 100.0), v(15.0, -2.0, 100.0), v(1.0, -2.0, 103.0)];
    assert_eq!(points("G91 G0 X10\nX5 Y-2\nX=AC(1) Z=IC(3)"), expected);
    assert_eq!(points("G0 X1\nTRANS X100\nX=IC(1)\nX=IC(2)\nX=IC(3)")[1..].len(), 3);
}

#[test]
fn inches_are_converted_with_and_without_the_feed() {
    let ops = blocks("G70 G1 X1 F100\nG700 X2 F10\nG71 X3 F30");
    assert_eq!(poses(&ops)[0].point.x, 25.4);
    assert_eq!(poses(&ops)[1].point.x, 50.8);
    assert_eq!(poses(&ops)[2].point.x, 3.0);
    let feeds: Vec<_> = ops.iter().filter(|op| matches!(op, Action::Feed(_))).collect();
    let feed = |value| Action::Feed(Feed::PerMinute(value));
    assert_eq!(feeds, [&feed(100.0), &feed(254.0), &feed(30.0)]);
}

#[test]
fn inverse_time_is_reported_for_every_block() {
    let ops = blocks("G93 G1 X1 F10\nX2 F10\nG95 X3 F0.2");
    let feeds: Vec<_> = ops.iter().filter(|op| matches!(op, Action::Feed(_))).collect();
    let inverse = Action::Feed(Feed::InverseTime(10.0));
    assert_eq!(feeds, [&inverse, &inverse, &Action::Feed(Feed::PerTurn(0.2))]);
}

#[test]
fn tools_are_called_by_number_and_name() {
    let ops = blocks("T=\"MILL D8\" M6\nD2\nT5\nM6\nD0");
    let tools: Vec<_> = ops
        .iter()
        .filter_map(|op| match op {
            Action::Tool(tool) => Some((tool.number, tool.name.as_str())),
            _ => None,
        })
        .collect();
    assert_eq!(tools, [(0, "MILL D8"), (5, "")]);
    let offsets: Vec<_> = ops.iter().filter(|op| matches!(op, Action::LengthOffset(_))).collect();
    let offset = |edge| Action::LengthOffset(edge);
    assert_eq!(offsets, [&offset(Some(1)), &offset(Some(2)), &offset(Some(1)), &offset(None)]);
}

#[test]
fn spindle_and_coolant_are_reported_where_they_change() {
    let ops = blocks("S1000\nM3\nS1=1200\nM1=4 M8\nM4 M7\nM5 M9");
    let expected = vec![
        Action::Spindle(Spindle::Clockwise(1000.0)),
        Action::Spindle(Spindle::Clockwise(1200.0)),
        Action::Spindle(Spindle::CounterClockwise(1200.0)),
        Action::Coolant(Coolant::Flood),
        Action::Coolant(Coolant::FloodAndMist),
        Action::Spindle(Spindle::Off),
        Action::Coolant(Coolant::Off),
        Action::End,
    ];
    assert_eq!(ops, expected);
}

#[test]
fn spindle_comes_before_the_motion_and_a_stop_after_it() {
    let ops = blocks("G1 X5 S100 M3 M0");
    let [
        Action::Spindle(_),
        Action::Line(_),
        Action::Risk(_),
        Action::Stop,
        Action::Spindle(off),
        Action::End,
    ] = ops[..]
    else {
        panic!("{ops:?}")
    };
    assert_eq!(off, Spindle::Off);
}

#[test]
fn a_dwell_counts_seconds_or_turns() {
    let ops = blocks("S600 M3\nG4 F1.5\nG4 S30\nG1 X1");
    // 30 turns at 600 a minute are 3 s; neither F nor S of G4 stays.
    assert!(ops.contains(&Action::Dwell(1.5)) && ops.contains(&Action::Dwell(3.0)));
    assert!(!ops.iter().any(|op| matches!(op, Action::Feed(_))));
}

#[test]
fn compensation_starts_with_the_first_move_in_the_plane() {
    let ops = blocks("G1 G41 Z5\nX10\nG40\nZ9\nY5");
    let kinds: Vec<_> = ops
        .iter()
        .map(|op| match op {
            Action::Compensation(Compensation::Left(edge)) => format!("left {edge:?}"),
            Action::Compensation(_) => "off".into(),
            Action::Line(_) => "line".into(),
            _ => "end".into(),
        })
        .collect();
    assert_eq!(kinds, ["line", "left Some(1)", "line", "line", "off", "line", "end"]);
}

#[test]
fn an_arc_by_its_centre_turns_the_way_of_its_command_in_each_plane() {
    // From (0, 0, 100): the centre 10 mm along the first axis of the plane, a half turn.
    for (text, end, center, normal) in [
        ("G17 G2 X20 Y0 I10 J0", v(20.0, 0.0, 100.0), v(10.0, 0.0, 100.0), v(0.0, 0.0, -1.0)),
        ("G17 G3 X20 Y0 I10", v(20.0, 0.0, 100.0), v(10.0, 0.0, 100.0), v(0.0, 0.0, 1.0)),
        ("G18 G2 X0 Z120 K10", v(0.0, 0.0, 120.0), v(0.0, 0.0, 110.0), v(0.0, -1.0, 0.0)),
        ("G19 G3 Y20 J=AC(10)", v(0.0, 20.0, 100.0), v(0.0, 10.0, 100.0), v(1.0, 0.0, 0.0)),
    ] {
        let arc = arcs(text)[0];
        near(arc.end.point, end);
        near(arc.center, center);
        near(arc.normal, normal);
    }
}

#[test]
fn a_radius_above_zero_is_the_short_arc_and_below_the_long_one() {
    // Start (0, 0), end (10, 10), radius 10, counter-clockwise: the short arc turns about (0, 10),
    // the long one about (10, 0); clockwise it is the other way round.
    for (text, center) in [
        ("G3 X10 Y10 CR=10", v(0.0, 10.0, 100.0)),
        ("G3 X10 Y10 CR=-10", v(10.0, 0.0, 100.0)),
        ("G2 X10 Y10 CR=10", v(10.0, 0.0, 100.0)),
        ("G2 X10 Y10 CR=-10", v(0.0, 10.0, 100.0)),
        ("G2 X20 Y0 CR=10", v(10.0, 0.0, 100.0)),
        ("G2 X20.002 Y0 CR=10", v(10.001, 0.0, 100.0)),
    ] {
        near(arcs(text)[0].center, center);
    }
}

#[test]
fn an_opening_angle_needs_an_end_or_a_centre() {
    // A quarter counter-clockwise from (0, 0) to (10, 10).
    near(arcs("G3 X10 Y10 AR=90")[0].center, v(0.0, 10.0, 100.0));
    near(arcs("G3 X10 Y10 AR=270")[0].center, v(10.0, 0.0, 100.0));
    near(arcs("G3 I0 J10 AR=90")[0].end.point, v(10.0, 10.0, 100.0));
    near(arcs("G2 I0 J10 AR=90 Z90")[0].end.point, v(-10.0, 10.0, 90.0));
}

#[test]
fn an_arc_through_a_point_may_lie_in_any_plane() {
    let flat = arcs("CIP X20 Y0 I1=10 J1=10 K1=100")[0];
    near(flat.center, v(10.0, 0.0, 100.0));
    near(flat.normal, v(0.0, 0.0, -1.0));
    // A half circle from (0, 0, 100) over (10, 0, 110) to (20, 0, 100), which stands upright.
    let upright = arcs("CIP X20 Y0 Z100 I1=IC(10) J1=AC(0) K1=110")[0];
    near(upright.center, v(10.0, 0.0, 100.0));
    near(upright.normal, v(0.0, 1.0, 0.0));
    let tilted = arcs("CIP X10 Y10 Z110 I1=10 J1=0 K1=100")[0];
    // Right-angled at the middle point, so that the centre halves the way from start to end.
    near(tilted.center, v(5.0, 5.0, 105.0));
    near(tilted.normal, v(0.0, -FRAC_1_SQRT_2, FRAC_1_SQRT_2));
}

#[test]
fn a_helix_counts_its_turns_and_a_full_circle_needs_no_end() {
    let helix = arcs("G2 X0 Y0 Z80 I10 J0 TURN=3")[0];
    assert_eq!((helix.turns, helix.end.point), (3, v(0.0, 0.0, 80.0)));
    let circle = arcs("G3 I-5")[0];
    assert_eq!((circle.end.point, circle.center), (v(0.0, 0.0, 100.0), v(-5.0, 0.0, 100.0)));
}

#[test]
fn the_end_of_an_arc_may_leave_the_circle_by_what_the_machine_data_say() {
    // MD21000: 0.01 mm below a radius of 10 mm, MD21010: a thousandth above.
    assert_eq!(arcs("G2 X20.009 Y0 I10 J0").len(), 1);
    assert_eq!(arcs("G2 X200.09 Y0 I100 J0").len(), 1);
}

#[test]
fn rotary_words_name_positions_and_ways() {
    let ops = blocks("G0 C350\nC=DC(10)\nC=ACP(5)\nC=ACN(350)\nC=IC(-5) A=AC(3)\nG91 C1");
    let c: Vec<_> = poses(&ops).iter().map(|pose| degrees(pose).0[2]).collect();
    // DC goes 20 degrees forward to 370; 5 is 355 further; 350 is 15 back; then 5 back, 1 forward.
    let expected = [350.0, 370.0, 725.0, 710.0, 705.0, 706.0];
    assert!(c.iter().zip(expected).all(|(c, e)| (c - e).abs() < 1e-9), "{c:?}");
}

#[test]
fn under_traori_the_position_is_the_tool_tip() {
    let ops = blocks("TRAORI\nORIWKS\nORIAXES\nG0 X1 Y2\nG1 Z3 A10 C=20\nTRAFOOF\nG0 X0");
    let poses = poses(&ops);
    assert!(poses[0].point.z.is_nan(), "the tip is elsewhere than the axes were");
    assert_eq!(poses[1].point, v(1.0, 2.0, 3.0));
    assert_eq!(degrees(&poses[1]), ([10.0, 0.0, 20.0], true));
    assert!(!degrees(&poses[2]).1 && poses[2].point.y.is_nan());
}

#[test]
fn vectors_of_the_tool_have_any_length_and_hold() {
    let ops = blocks("TRAORI\nG1 X1 Y2 Z3 A3=0 B3=3 C3=4\nX2\nX3 C3=0.5");
    let axes: Vec<_> = poses(&ops).iter().map(|pose| pose.axis().unwrap()).collect();
    near(axes[0], v(0.0, 0.6, 0.8));
    near(axes[1], v(0.0, 0.6, 0.8));
    near(axes[2], v(0.0, 0.0, 1.0));
}

#[test]
fn moves_in_machine_coordinates_leave_their_axes_unknown() {
    let ops = blocks("SUPA G0 Z0 D0\nG0 X5\nG74 X1=0 Y1=0\nG75 FP=2 Z1=0\nG153 G0 A0 C0\nG1 X1");
    let is_home = |op: &&Action| matches!(op, Action::Home(_) | Action::MachineMove(_));
    let homes: Vec<_> = ops.iter().filter(is_home).collect();
    assert_eq!(
        homes,
        [
            &Action::MachineMove(machine_move([None, None, Some(0.0)], [None; 3])),
            &Action::Home(Axes::X | Axes::Y),
            &Action::Home(Axes::Z),
            &Action::MachineMove(machine_move([None; 3], [Some(0.0), None, Some(0.0)]))
        ]
    );
    assert!(ops.contains(&Action::LengthOffset(None)));
    // With a tool length, Z of the spindle is higher by what only the control knows.
    let with_length = blocks("T1 M6\nG0 SUPA X-5 Z-10");
    let [.., Action::MachineMove(to), Action::End] = &with_length[..] else {
        panic!("{with_length:?}")
    };
    assert_eq!(to.linear[0], Some(-5.0));
    assert!(to.linear[2].is_some_and(f64::is_nan), "{to:?}");
    let poses = poses(&ops);
    assert!(poses[0].point.x == 5.0 && poses[0].point.y == 0.0 && poses[0].point.z.is_nan());
    assert!(poses[1].point.x == 1.0 && poses[1].point.y.is_nan());
    assert!(degrees(&poses[1]).0[0].is_nan());
}

/// Fundamentals 11/2006, p. 100: G53 suppresses the settable and the programmable offset, G153 the total basic frame too, SUPA all.
#[test]
fn g53_leaves_the_basic_frame_in() {
    let risks = |word: &str, to: &str| {
        let ops = blocks(&format!("D0\n{word} G0 {to}"));
        let risk = |op: &Action| match op {
            Action::Risk(risk) => Some((risk.rule.name(), risk.refused)),
            _ => None,
        };
        ops.iter().filter_map(risk).collect::<Vec<_>>()
    };
    for to in ["Z0", "X0 Y0", "A0 C0"] {
        assert_eq!(risks("G53", to), [("machine-position", true)], "{to}");
        assert_eq!(risks("G153", to), [], "{to}");
        assert_eq!(risks("SUPA", to), [], "{to}");
    }
    // It goes nowhere.
    assert_eq!(risks("G53", "F100"), []);
}

#[test]
fn another_work_offset_makes_the_position_unknown() {
    let ops = blocks("G54 G0 X1 Y1 Z1\nG54 X2\nG505 X3\nG500 X4");
    let offsets: Vec<_> = ops.iter().filter(|op| matches!(op, Action::WorkOffset(_))).collect();
    assert_eq!(
        offsets,
        [
            &Action::WorkOffset(WorkOffset::FIRST),
            &Action::WorkOffset(WorkOffset::numbered(58).unwrap()),
            &Action::WorkOffset(WorkOffset::NONE)
        ]
    );
    let poses = poses(&ops);
    assert_eq!(poses[1].point, v(2.0, 1.0, 1.0));
    assert!(poses[2].point.y.is_nan());
}

fn machine_move(linear: [Option<f64>; 3], rotary: [Option<f64>; 3]) -> Box<MachineMove> {
    Box::new(MachineMove { linear, rotary })
}

/// The example of the manual (Fundamentals, "Feedrate", FGROUP and FGREF): which way `R1=$AC_TIME` is measured along. With
/// `FGREF[A]=360/(2*$PI)` in inches a degree counts an inch.
#[test]
fn the_feed_group_and_its_radius_say_what_the_feed_counts() {
    let text = "FGROUP(X,A)\n".replace("X,A", "X,Y,Z,A")
        + "G90 G1 G710 F100 X0 Y0 Z0 A0 C0\nX10\nX20 A10\nA20\nX20.001 A30\nG700 F100\nFGREF[A]=360/(2*$PI)\n\
           X=20.002/25.4 A40\nFGROUP()\nA50\nX21/25.4 A60";
    let text = text.replace("X=20.002/25.4", "X=(20.002/25.4)").replace("X21/25.4", "X=(21/25.4)");
    let (mut path, mut last, mut ways) = (None, None, Vec::new());
    for op in blocks(&text) {
        match op {
            Action::FeedPath(new) => path = Some(new),
            Action::Line(to) => {
                let from = last.replace(to);
                ways.extend(from.map(|from| path.unwrap().length(&from, &to)));
            }
            _ => {}
        }
    }
    let expected =
        [Some(10.0), Some(200f64.sqrt()), Some(10.0), Some(10.0), Some(254.0), None, Some(0.998)];
    assert_eq!(ways.len(), expected.len());
    for (way, expected) in ways.iter().zip(expected) {
        match (way, expected) {
            (Some(way), Some(expected)) => assert!((way - expected).abs() < 1e-4, "{ways:?}"),
            (way, expected) => assert_eq!(*way, expected, "{ways:?}"),
        }
    }
}

#[test]
fn how_fast_axes_may_be_changes_no_path() {
    let ops = blocks(
        "ACC[X]=80 ACCLIMA[Y]=50\nG0 X1 Y2 Z3\nJERKLIMA[Z]=100\nVELOLIMA[X]=90.5\nX2 ACC[Y]=200",
    );
    assert_eq!(poses(&ops).last().unwrap().point, v(2.0, 2.0, 3.0));
    for text in ["ACC[X]=0", "ACC[X]=201", "ACC[Q]=80", "ACC=80", "ACC[X]"] {
        crate::common::sinumerik::error(text);
    }
}

/// Programming Manual, "Rapid retraction during thread cutting": they act at a stop, and move nothing by themselves.
#[test]
fn where_axes_go_when_the_program_stops_moves_nothing_and_is_reported() {
    let plain = poses(&blocks("G0 X1 Y2 Z3\nG1 X5 F100"));
    let quiet = blocks("LFOF LFTXT\nLFWP\nLFPOS\nG0 X1 Y2 Z3\nLFTXT");
    assert!(!quiet.iter().any(|op| matches!(op, Action::Risk(_))), "{quiet:?}");
    let words = [
        "POLF[Z]=100",
        "POLF[Z]=IC(5) POLF[X]=AC(R1)",
        "POLFMASK(Z)",
        "POLFMASK()",
        "POLFMLIN(X,Z)",
        "LFON",
        "ALF=3",
        "DILF=5",
        "LFON LFPOS DILF=2",
        "POLFA(Z,2,50)",
    ];
    for text in words {
        let ops = blocks(&format!("R1=7\n{text}\nG0 X1 Y2 Z3\nG1 X5 F100\nLFOF LFTXT"));
        assert_eq!(poses(&ops), plain, "{text}");
        let risks: Vec<_> = ops
            .iter()
            .filter_map(|op| {
                if let Action::Risk(risk) = op {
                    Some((risk.rule.name(), risk.refused))
                } else {
                    None
                }
            })
            .collect();
        assert_eq!(risks, [("stop-retract", false)], "{text}");
    }
    // An interrupt runs a program of its own, wherever it comes.
    for text in ["SETINT(1) PRIO=1 LIFT_Z", "SETINT(2) PRIO=1 LIFTFAST", "POLF[Q]=1", "POLF=1"] {
        crate::common::sinumerik::error(text);
    }
}
