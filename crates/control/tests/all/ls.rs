//! LS, by what is known of FANUC's listings, the job of the specification, and a program that RoboDK has written.

use crate::arm::moves;
use geom::{Frame, Vec3};
use program::{Feed, Output, OutputValue, Until};
use toolpost_control::{
    Action, ArmAction, ArmPath, Corner, Dialect, Event, Rounding, Settings, Turning, read,
};

fn settings() -> Settings {
    Settings { own_frame: Some(9), ..Settings::new(Dialect::Ls, [false; 3]) }
}

fn run_with(settings: &Settings, text: &str) -> Result<Vec<Event>, String> {
    crate::arm::run(settings, "JOB.LS", text)
}

/// Positions: 1 joints, 2 to 4 poses.
const POSITIONS: &str = "P[1]{
   GP1:
\tUF : 1, UT : 1,
\tJ1=     0.000 deg,\tJ2=    23.408 deg,\tJ3=   -42.993 deg,
\tJ4=     0.000 deg,\tJ5=   -47.007 deg,\tJ6=     0.000 deg
};
P[2]{
   GP1:
\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',
\tX =     0.000  mm,\tY =     0.000  mm,\tZ =    -2.000  mm,
\tW =   180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg
};
P[3]{
   GP1:
\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',
\tX =    74.142  mm,\tY =     5.858  mm,\tZ =    -2.000  mm,
\tW =   180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg
};
P[4]{
   GP1:
\tUF : 1, UT : 1,\t\tCONFIG : 'F D B, 1, -1, 0',
\tX =    80.000  mm,\tY =    20.000  mm,\tZ =    -2.000  mm,
\tW =   180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg
};
";

/// A program of these instructions behind the choice of the frames, which stand in lines 3 and 4.
fn program(lines: &[&str]) -> String {
    let mut text = String::from("/PROG  JOB\n/MN\n   1:  UFRAME_NUM=1 ;\n   2:  UTOOL_NUM=1 ;\n");
    for (number, line) in (3..).zip(lines) {
        text += &format!("{number:4}:{line} ;\n");
    }
    text + "/POS\n" + POSITIONS + "/END\n"
}

fn body(lines: &[&str]) -> Result<Vec<Event>, String> {
    run_with(&settings(), &program(lines))
}

#[track_caller]
fn refused(line: &str, what: &str) {
    let found = body(&[line]).expect_err(line);
    assert!(found.contains("JOB.LS:5:") && found.contains(what), "{line}: {found}");
}

/// The job of the specification: an arc goes on in a second line.
const JOB: [&str; 9] = [
    "J P[1] 20% FINE   ",
    "  DO[1]=ON",
    "  WAIT   2.00(sec)",
    "L P[2] 30cm/min FINE   ",
    "L P[2] 120cm/min CNT10   ",
    "C P[3]\n    :  P[4] 120cm/min FINE   ",
    "L P[2] 100mm/sec FINE   ",
    "  DO[1]=OFF",
    "  WAIT   1.00(sec)",
];

#[test]
fn the_job_of_the_specification_makes_its_motion() {
    let events = body(&JOB).unwrap();
    let moves = moves(&events);
    assert_eq!(moves.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [5, 8, 9, 10, 12]);
    let joints = ArmPath::Joints([0.0, 23.408, -42.993, 0.0, -47.007, 0.0]);
    assert_eq!((moves[0].1.path, moves[0].1.corner), (joints, Corner::Exact));
    let ArmPath::Line(end) = moves[1].1.path else { panic!("{:?}", moves[1]) };
    assert_eq!(end.translation, Vec3::new(0.0, 0.0, -2.0));
    // W 180 is half a turn about X: the tool points down, its Y backwards.
    assert!((end.matrix3 * Vec3::Z).distance(Vec3::NEG_Z) < 1e-12);
    assert!((end.matrix3 * Vec3::X).distance(Vec3::X) < 1e-12);
    assert_eq!((moves[1].1.corner, moves[1].1.turning), (Corner::Exact, Some(Turning::Even)));
    // CNT has no bound in mm.
    assert_eq!(moves[2].1.corner, Corner::Unbounded);
    let ArmPath::Arc { via, end } = moves[3].1.path else { panic!("{:?}", moves[3]) };
    assert_eq!(via.translation, Vec3::new(74.142, 5.858, -2.0));
    assert_eq!(end.translation, Vec3::new(80.0, 20.0, -2.0));
    let feeds: Vec<Feed> = events
        .iter()
        .filter_map(|event| match event.action {
            Action::Feed(feed) => Some(feed),
            _ => None,
        })
        .collect();
    assert_eq!(feeds, [300.0, 1200.0, 6000.0].map(Feed::PerMinute));
    let spindle = |on| Output { number: 1, value: OutputValue::Digital(on), with_motion: false };
    for (line, action) in [
        (3, Action::Arm(ArmAction::Base(None))),
        (5, Action::Arm(ArmAction::JointSpeed(Some(20.0)))),
        (6, Action::Output(spindle(true))),
        (7, Action::Dwell(2.0)),
        (13, Action::Output(spindle(false))),
        (14, Action::End),
    ] {
        assert!(events.contains(&Event { line, action: action.clone() }), "{line} {action:?}");
    }
}

#[test]
fn letters_and_turns_state_the_posture() {
    let moves = moves(&body(&["L P[2] 10mm/sec FINE", "L P[4] 10mm/sec FINE"]).unwrap());
    let [first, second] = [moves[0].1.posture, moves[1].1.posture];
    assert_eq!([first.flip, first.below, first.rear], [Some(false); 3]);
    assert_eq!([second.flip, second.below, second.rear], [Some(true); 3]);
    assert_eq!(first.joints[0], Some([-180.0, 180.0]));
    assert_eq!(
        (second.joints[0], second.joints[3]),
        (Some([180.0, 540.0]), Some([-540.0, -180.0]))
    );
    assert_eq!([second.joints[1], second.joints[2], second.joints[4]], [None; 3]);
}

#[test]
fn the_program_of_robodk_is_read_with_its_frames_and_its_call() {
    let Some(folder) = judge::data("robots") else { return };
    let text = std::fs::read_to_string(folder.join("programs/robodk-Program.LS")).unwrap();
    // Its last two lines have numbers beyond nothing, and no end: 100 and 9999 in front of no instruction.
    let found = run_with(&settings(), &text).unwrap_err();
    assert!(found.contains("JOB.LS:53:") && found.contains("Subprog"), "{found}");
    let called = tempfile::tempdir().unwrap();
    std::fs::write(
        called.path().join("Subprog.LS"),
        "/PROG SUBPROG\n/MN\n 1:  PAUSE ;\n/POS\n/END\n",
    )
    .unwrap();
    let mut settings = settings();
    settings.setup.folders = vec![called.path().to_path_buf()].into();
    let events = run_with(&settings, &text).unwrap();
    assert_eq!(moves(&events).len(), 6);
    let stops = events.iter().filter(|event| event.action == Action::Stop).count();
    assert_eq!(stops, 2);
    let waits = events.iter().any(|event| match &event.action {
        Action::Input(input) => input.number == 5 && input.until == Until::High,
        _ => false,
    });
    assert!(waits);
    // Tool 9 is what its registers say: -30, 0, 40, turned by -60° about Y.
    let tool = events.iter().find_map(|event| match &event.action {
        Action::Arm(ArmAction::Tool(Some(tool))) => Some(tool),
        _ => None,
    });
    let tool = tool.unwrap();
    assert_eq!(tool.translation, Vec3::new(-30.0, 0.0, 40.0));
    let expected = Vec3::new(-(60_f64.to_radians().sin()), 0.0, 0.5);
    assert!((tool.matrix3 * Vec3::Z).distance(expected) < 1e-12);
}

#[test]
fn frames_are_those_of_the_operator_unless_the_program_sets_them() {
    let set: Vec<String> = [450.0, 0.0, -180.0, 0.0, 0.0, 90.0]
        .iter()
        .zip(1..)
        .map(|(value, i)| format!("  PR[9,{i}]={value:.3}"))
        .collect();
    let mut lines: Vec<&str> = set.iter().map(String::as_str).collect();
    lines.extend(["  UFRAME[9]=PR[9]", "  UFRAME_NUM=9"]);
    let events = body(&lines).unwrap();
    let bases: Vec<Option<Frame>> = events
        .iter()
        .filter_map(|event| match &event.action {
            Action::Arm(ArmAction::Base(base)) => Some(base.as_deref().copied()),
            _ => None,
        })
        .collect();
    assert_eq!(bases[..2], [None, None]);
    let base = bases[2].unwrap();
    assert_eq!(base.translation, Vec3::new(450.0, 0.0, -180.0));
    assert!((base.matrix3 * Vec3::X).distance(Vec3::Y) < 1e-12);
    assert!(!events.iter().any(|event| matches!(event.action, Action::Risk(_))));
    // Frames and registers that are not the programs' own may have been measured.
    let other: Vec<String> =
        lines.iter().map(|line| line.replace("9]", "3]").replace("[9,", "[3,")).collect();
    let lines: Vec<&str> = other.iter().map(String::as_str).collect();
    let events = body(&lines[..7]).unwrap();
    assert_eq!(events.iter().filter(|event| matches!(event.action, Action::Risk(_))).count(), 7);
    // 0 is the world.
    let events = body(&["  UFRAME_NUM=0"]).unwrap();
    assert!(
        events
            .iter()
            .any(|event| event.action
                == Action::Arm(ArmAction::Base(Some(Box::new(Frame::IDENTITY)))))
    );
    refused("  UFRAME[9]=PR[8]", "no instruction has set PR[8,1]");
    refused("  UFRAME_NUM=11", "no frame has the number 11");
}

#[test]
fn a_position_counts_in_the_frames_that_are_active() {
    let found = body(&["  UFRAME_NUM=2", "L P[2] 10mm/sec FINE"]).unwrap_err();
    assert!(found.contains("JOB.LS:6:") && found.contains("user frame 1 with tool 1"), "{found}");
    refused("L P[7] 10mm/sec FINE", "no position P[7]");
    refused("L P[1] 10mm/sec FINE", "a line or an arc to joints");
}

#[test]
fn corners_are_bounded_by_cr_alone() {
    let corner =
        |end: &str| moves(&body(&[&format!("L P[2] 10mm/sec {end}")]).unwrap())[0].1.corner;
    assert_eq!(corner("FINE"), Corner::Exact);
    assert_eq!(corner("CNT0"), Corner::Unbounded);
    let rounding = Rounding { distance: 3.0, shortened: true, stops: false };
    assert_eq!(corner("CR3"), Corner::Within(rounding));
    let joints = moves(&body(&["J P[1] 10% CR3"]).unwrap())[0].1.corner;
    assert_eq!(joints, Corner::Unbounded);
    let wrist = moves(&body(&["L P[2] 10mm/sec FINE Wjnt"]).unwrap())[0].1.turning;
    assert_eq!(wrist, Some(Turning::ByJoints));
}

#[test]
fn a_tool_is_changed_by_the_program_of_the_operator_behind_which_nothing_is_known() {
    let settings = Settings { tool_change: String::from("CHANGE"), ..settings() };
    let events = run_with(&settings, &program(&["  CALL CHANGE(2)"])).unwrap();
    let at = events.iter().position(|event| matches!(event.action, Action::Tool(_))).unwrap();
    let behind: Vec<&Action> = events[at..].iter().map(|event| &event.action).collect();
    assert!(behind.contains(&&Action::Arm(ArmAction::Base(None))), "{behind:?}");
    let found = run_with(&settings, &program(&["  CALL CHANGE"])).unwrap_err();
    assert!(found.contains("one argument"), "{found}");
    let found =
        run_with(&settings, &program(&["  CALL CHANGE(2)", "L P[2] 10mm/sec FINE"])).unwrap_err();
    assert!(found.contains("not the active ones"), "{found}");
}

#[test]
fn registers_calculate_from_left_to_right() {
    for (sum, expected) in [("10+5-3", 12.0), ("(-2)*3/4", -1.5), ("2", 2.0)] {
        let lines = [format!("  R[1]={sum}"), String::from("  AO[1]=R[1]")];
        let events = body(&[&lines[0], &lines[1]]).unwrap();
        let set = events.iter().any(|event| match &event.action {
            Action::Output(output) => output.value == OutputValue::Analog(expected),
            _ => false,
        });
        assert!(set, "{sum}");
    }
    refused("  R[1]=1+2*3", "either + and - or * and /");
    refused("  R[1]=1/0", "no result");
    refused("  AO[1]=R[2]", "no instruction has set R[2]");
}

#[test]
fn each_word_of_the_vocabulary_is_understood() {
    for word in toolpost_control::vocabulary(Dialect::Ls) {
        assert!(body(&[&word]).is_ok(), "{word}: {:?}", body(&[&word]));
    }
}

#[test]
fn what_is_not_understood_is_refused_with_its_line() {
    for (line, what) in [
        ("  FOO", "FOO is no word"),
        ("  IF R[1]=1,JMP LBL[1]", "IF is not followed"),
        ("L P[2] 10mm/sec FINE ACC500", "ACC is 0 to 150 percent"),
        ("  JMP LBL[1]", "JMP is not followed"),
        ("  RO[1]=ON", "RO is not followed"),
        ("L PR[1] 10mm/sec FINE", "position register is not followed"),
        ("L P[2] 10% FINE", "mm/sec, cm/min and inch/min"),
        ("J P[1] 10mm/sec FINE", "followed in %"),
        ("J P[1] 120% FINE", "no motion goes at a speed of 120"),
        ("L P[2] 0mm/sec FINE", "no motion goes at a speed of 0"),
        ("L P[2] 10mm/sec", "FINE, CNT or CR"),
        ("L P[2] 10mm/sec CNT101", "0 to 100"),
        ("L P[2] 10mm/sec FINE Offset,PR[1]", "this option"),
        ("L P[2] 10mm/sec FINE INC", "this option"),
        ("C P[3] 10mm/sec FINE", "a position P[1]"),
        ("A P[3] 10mm/sec FINE", "A is not followed"),
        ("  DO[1]=PULSE", "ON or OFF"),
        ("  DO[0]=ON", "numbered from 1"),
        ("  WAIT 2", "(sec) is needed"),
        ("  WAIT R[1]=2", "no word"),
        ("  WAIT -1(sec)", "not below 0"),
        ("  PR[9]=P[1]", "a whole position register"),
        ("  PR[9,7]=1", "the element is 1 to 6"),
        ("  MESSAGE[text", "the text has no end"),
        ("  CALL OTHER", "no folder for called programs"),
        ("  CALL OTHER(1)", "with arguments"),
        ("  UFRAME[1]=P[1]", "a position register"),
        ("@", "begins with a word"),
    ] {
        if line == "  WAIT R[1]=2" {
            assert!(body(&[line]).is_err());
            continue;
        }
        refused(line, what);
    }
}

#[test]
fn a_listing_has_its_parts_and_its_positions_are_whole() {
    let text = program(&["J P[1] 20% FINE"]);
    for (from, to, what) in [
        ("/PROG  JOB", "/PROX", "no /PROG"),
        ("/MN", "/XX", "no /MN"),
        ("JOB", "A_NAME_OF_MORE_LETTERS_THAN_ANY_CONTROL_TAKES", "up to 36 letters"),
        ("JOB", "1JOB", "a letter first"),
        ("/MN", "DEFAULT_GROUP = *,*,*,*,*;\n/MN", "no motion group 1"),
        ("/END", "", "no /END behind it"),
        ("/END", "/END\nmore", "behind /END"),
        ("FINE ;", "FINE", "has no end: ;"),
        ("   3:J", "   J", "begins with its number"),
        ("   3:J", "10000:J", "1 to 9999"),
        ("UF : 1, UT : 1,\n\tJ1", "J1", "does not say in which user frame"),
        ("UF : 1", "UF : F", "the number of a frame"),
        ("J6=     0.000 deg", "", "neither six joints"),
        ("J6=     0.000 deg", "J6=     0.000  mm", "J6 counts in deg"),
        ("J6=", "J5=", "J5 stands twice"),
        ("CONFIG : 'N U T, 0, 0, 0',", "", "neither six joints nor X"),
        ("'N U T, 0, 0, 0'", "'X U T, 0, 0, 0'", "one of the letters NF"),
        ("'N U T, 0, 0, 0'", "'N U T, 0, 0'", "`,` is needed"),
        ("P[2]{", "P[1]{", "two positions P[1]"),
        ("GP1:", "GP2:", "GP2 of a position"),
        ("X =     0.000  mm", "X =     0.000  mm, E2= 1.000 mm", "E2 of a position"),
        ("X =     0.000  mm", "X =     0.000  mm, E1= 1.000 deg", "E1 counts in mm"),
    ] {
        assert!(text.contains(from), "{from}");
        let found = run_with(&settings(), &text.replacen(from, to, 1)).expect_err(from);
        assert!(found.contains(what), "{from} -> {to}: {found}");
    }
}

#[test]
fn every_damage_of_a_job_is_read_or_refused_without_a_panic() {
    let text = program(&JOB);
    for at in 0..text.len() {
        for byte in [b'[', b'9', b'\n', b':', b';', b'}', 0xff] {
            let mut text = text.as_bytes().to_vec();
            text[at] = byte;
            let _ = read(&settings(), "JOB.LS", &text, &mut |_| Ok(()));
        }
    }
}

#[test]
fn a_position_without_its_group_or_out_of_order_is_refused() {
    let whole = "/PROG JOB\n/ATTR\nDEFAULT_GROUP = 1,*,*,*,*;\n/MN\n   1:UFRAME_NUM=1 ;\n   2:UTOOL_NUM=1 ;\n   3:J P[1] 20% FINE ;\n/POS\nP[1]{\n   GP1:\n UF : 1, UT : 1,\n \
        J1= 0.0 deg, J2= 0.0 deg, J3= 0.0 deg,\n J4= 0.0 deg, J5= -90.0 deg, J6= 0.0 deg\n};\n/END\n";
    let run = |text: &str| run_with(&settings(), text);
    run(whole).unwrap();
    for (from, to, what) in [
        ("   GP1:\n", "", "begins with its motion group"),
        (
            "   GP1:\n UF : 1, UT : 1,\n",
            " UF : 1, UT : 1,\n   GP1:\n",
            "begins with its motion group",
        ),
        ("J1= 0.0 deg, J2= 0.0 deg", "J2= 0.0 deg, J1= 0.0 deg", "in this order"),
        ("J4= 0.0 deg, J5= -90.0 deg", "J5= -90.0 deg, J4= 0.0 deg", "in this order"),
        ("   GP1:\n", "   GP1:\n   GP1:\n", "GP1 stands twice"),
        ("UT : 1,\n", "UT : 1, UF : 1,\n", "UF stands twice"),
        ("\n};\n", "\n}\n", "ends with };"),
    ] {
        let text = whole.replace(from, to);
        assert_ne!(text, whole);
        let found = run(&text).unwrap_err();
        assert!(found.contains(what), "{from}: {found}");
    }
}
