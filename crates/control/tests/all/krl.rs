//! KRL, by what KUKA's manuals say of it, the job of the specification, and programs that others have written.

use crate::arm::moves;
use geom::{Euler, Frame, Vec3};
use program::{Feed, Output, OutputValue, Until};
use toolpost_control::{
    Action, ArmAction, ArmPath, Corner, Dialect, Event, Rounding, Settings, Turning, read,
};

fn settings() -> Settings {
    Settings::new(Dialect::Krl, [false; 3])
}

fn run_with(settings: &Settings, text: &str) -> Result<Vec<Event>, String> {
    crate::arm::run(settings, "job.src", text)
}

/// The events of a program of these lines.
fn body(lines: &str) -> Result<Vec<Event>, String> {
    run_with(&settings(), &format!("DEF job ( )\n{lines}\nEND\n"))
}

#[track_caller]
fn refused(lines: &str, line: u32, what: &str) {
    let found = body(lines).expect_err(lines);
    assert!(
        found.contains(&format!("job.src:{line}:")) && found.contains(what),
        "{lines}: {found}"
    );
}

/// Half of the shorter motion at the most, and an output ends the look-ahead.
fn within(distance: f64) -> Rounding {
    Rounding { distance, shortened: true, stops: true }
}

const START: &str = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\n";

/// The job of the specification, whose joints put the tool at (0, 0, 50) of the part.
const JOB: &str = "&ACCESS RVP\r\n&REL 1\r\nDEF job ( )\r\nBAS (#INITMOV,0)\r\n\
$BASE={X 450.0,Y 0.0,Z 150.0,A 0.0,B 0.0,C 0.0}\r\n$TOOL={X 0.0,Y 0.0,Z 150.0,A 0.0,B 0.0,C 0.0}\r\n\
$IPO_MODE=#BASE\r\n$ORI_TYPE=#VAR\r\n$CIRC_TYPE=#BASE\r\nBAS (#VEL_PTP,20)\r\n\
PTP {A1 0.0,A2 -61.080,A3 126.744,A4 0.0,A5 24.336,A6 0.0}\r\n$OUT[1]=TRUE\r\nWAIT SEC 2.0\r\n$VEL.CP=0.00500\r\n\
LIN {X 0.0,Y 0.0,Z -2.0,A 180.0,B 0.0,C 180.0}\r\n$VEL.CP=0.02000\r\n$APO.CDIS=1.0\r\n\
LIN {X 60.0,Y 0.0,Z -2.0,A 180.0,B 0.0,C 180.0} C_DIS\r\n\
CIRC {X 74.142,Y 5.858,Z -2.0,A 180.0,B 0.0,C 180.0},{X 80.0,Y 20.0,Z -2.0,A 180.0,B 0.0,C 180.0}\r\n\
$VEL.CP=0.10000\r\nLIN {X 80.0,Y 20.0,Z 50.0,A 180.0,B 0.0,C 180.0}\r\n$OUT[1]=FALSE\r\nWAIT SEC 1.0\r\nEND\r\n";

#[test]
fn the_job_of_the_specification_makes_its_motion() {
    let events = run_with(&settings(), JOB).unwrap();
    let moves = moves(&events);
    assert_eq!(moves.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [11, 15, 18, 19, 21]);
    let joints = ArmPath::Joints([0.0, -61.08, 126.744, 0.0, 24.336, 0.0]);
    assert_eq!((moves[0].1.path, moves[0].1.corner), (joints, Corner::Exact));
    let ArmPath::Line(end) = moves[1].1.path else { panic!("{:?}", moves[1]) };
    assert_eq!(end.translation, Vec3::new(0.0, 0.0, -2.0));
    // A 180, C 180 is half a turn about Y: the tool points down, its X backwards.
    assert!((end.matrix3 * Vec3::Z).distance(Vec3::NEG_Z) < 1e-12);
    assert!((end.matrix3 * Vec3::X).distance(Vec3::NEG_X) < 1e-12);
    assert_eq!((moves[1].1.corner, moves[1].1.turning), (Corner::Exact, Some(Turning::Even)));
    assert_eq!(moves[2].1.corner, Corner::Within(within(1.0)));
    let ArmPath::Arc { via, end } = moves[3].1.path else { panic!("{:?}", moves[3]) };
    assert_eq!(via.translation, Vec3::new(74.142, 5.858, -2.0));
    assert_eq!(end.translation, Vec3::new(80.0, 20.0, -2.0));
    assert_eq!(moves[3].1.turning, Some(Turning::Even));
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
        (10, Action::Arm(ArmAction::JointSpeed(Some(20.0)))),
        (12, Action::Output(spindle(true))),
        (13, Action::Dwell(2.0)),
        (22, Action::Output(spindle(false))),
        (24, Action::End),
    ] {
        assert!(events.contains(&Event { line, action: action.clone() }), "{line} {action:?}");
    }
    let tool = Frame::from_translation(Vec3::new(0.0, 0.0, 150.0));
    assert!(
        events.contains(&Event {
            line: 6,
            action: Action::Arm(ArmAction::Tool(Some(Box::new(tool))))
        })
    );
}

#[test]
fn the_program_of_robodk_is_read_with_its_messages_and_its_call() {
    let Some(folder) = judge::data("robots") else { return };
    let text = std::fs::read(folder.join("programs/robodk-Program.src")).unwrap();
    let text = String::from_utf8(text).unwrap();
    // Its file is Program.src.
    let found = run_with(&settings(), &text).unwrap_err();
    assert!(found.contains("program is called PROGRAM, and its file job"), "{found}");
    let text = text.replacen("DEF Program", "DEF Job", 1);
    let found = run_with(&settings(), &text).unwrap_err();
    assert!(found.contains("job.src:64:") && found.contains("SUBPROG"), "{found}");
    let called = tempfile::tempdir().unwrap();
    std::fs::write(called.path().join("subprog.src"), "DEF Subprog()\nHALT\nEND\n").unwrap();
    let mut settings = settings();
    settings.setup.folders = vec![called.path().to_path_buf()].into();
    let events = run_with(&settings, &text).unwrap();
    assert_eq!(moves(&events).len(), 6);
    let count = |action: &Action| events.iter().filter(|event| event.action == *action).count();
    // HALT of its own, and the one of the program that it calls, by the line there.
    assert_eq!(count(&Action::Stop), 2);
    let file = |name: Option<&str>| Action::Arm(ArmAction::File(name.map(Box::from)));
    let called = Event { line: 64, action: file(Some("subprog.src")) };
    let at = events.iter().position(|event| *event == called).unwrap();
    assert_eq!(events[at + 1], Event { line: 2, action: Action::Stop });
    assert_eq!(events[at + 2], Event { line: 3, action: file(None) });
    let waits = events.iter().any(|event| match &event.action {
        Action::Input(input) => input.number == 5 && input.until == Until::High,
        _ => false,
    });
    assert!(waits);
    assert_eq!(count(&Action::Message("Set Digital Output 5 to ON".into())), 1);
}

#[test]
fn a_frame_turns_about_z_then_the_new_y_then_the_new_x() {
    let events = body("$BASE={FRAME: X 1,Y 2,Z 3,A 10,B 20,C 30}").unwrap();
    let turns = [30.0_f64, 20.0, 10.0].map(f64::to_radians);
    let rotation = Euler::FixedXyz.matrix(turns);
    let base = Frame::from_mat3_translation(rotation, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(events[0].action, Action::Arm(ArmAction::Base(Some(Box::new(base)))));
}

#[test]
fn what_a_position_leaves_out_stays_as_it_is_where_that_is_known() {
    let pose = "LIN {X 1,Y 2,Z 3,A 0,B 90,C 0}\n";
    let events = body(&format!("{START}{pose}LIN {{Z 9}}\nLIN_REL {{X 1.5}}")).unwrap();
    let moves = moves(&events);
    let end = |index: usize| match moves[index].1.path {
        ArmPath::Line(end) => end.translation,
        other => panic!("{other:?}"),
    };
    assert_eq!((end(2), end(3)), (Vec3::new(1.0, 2.0, 9.0), Vec3::new(2.5, 2.0, 9.0)));
    refused(&format!("{START}LIN {{X 1}}"), 3, "Y is left out");
    let base = "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n";
    refused(&format!("{START}{pose}{base}LIN {{X 1}}"), 5, "is left out");
    refused("PTP {A1 0}", 2, "A2 is left out");
    let events = body(&format!("{START}PTP {{A1 5}}")).unwrap();
    assert_eq!(self::moves(&events)[1].1.path, ArmPath::Joints([5.0, -90.0, 90.0, 0.0, 30.0, 0.0]));
}

#[test]
fn the_first_motion_is_a_ptp() {
    let pose = "LIN {X 1,Y 2,Z 3,A 0,B 90,C 0}";
    refused(pose, 2, "first motion");
    assert!(body(&format!("PTP $AXIS_ACT\n{pose}")).is_ok());
}

#[test]
fn status_and_turn_are_read_and_checked() {
    let events = body("PTP {X 1,Y 2,Z 3,A 0,B 90,C 0,S 'B010',T 'B110010',E1 0.0}").unwrap();
    let posture = moves(&events)[0].1.posture;
    assert_eq!(
        (posture.rear, posture.below, posture.flip),
        (Some(false), Some(false), Some(false))
    );
    // A2, A5 and A6 are below 0.
    let below = posture.joints.map(|range| range == Some([f64::NEG_INFINITY, 0.0]));
    assert_eq!(below, [false, true, false, false, true, true]);
    assert_eq!(posture.joints[0], Some([0.0, f64::INFINITY]));
    refused("PTP {X 1,Y 2,Z 3,A 0,B 90,C 0,S 32,T 0}", 2, "S is a whole number from 0 to 31");
    refused("PTP {X 1,Y 2,Z 3,A 0,B 90,C 0,S 2,T 64}", 2, "T is a whole number from 0 to 63");
    refused("PTP {X 1,Y 2,Z 3,A 0,B 90,C 0,S 2.5}", 2, "S is a whole number");
}

#[test]
fn e1_is_the_rail_and_stays_where_a_position_leaves_it_out() {
    let events = body(
        "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\nPTP {A1 10,E1 250.5}\n\
         LIN {X 1,Y 2,Z 3,A 0,B 90,C 0}\nLIN {X 2,E1 -3}\n\
         CIRC {X 3,Y 3,Z 3},{X 4,Y 2,Z 3,A 0,B 90,C 0}",
    );
    let rails: Vec<_> = moves(&events.unwrap()).iter().map(|(_, motion)| motion.rail).collect();
    assert_eq!(rails, [None, Some(250.5), Some(250.5), Some(-3.0), Some(-3.0)]);
    // Where the operator leads it while the program is stopped, no one knows.
    let halted = body("PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0,E1 5}\nHALT\nPTP {A1 10}").unwrap();
    let rails: Vec<_> = moves(&halted).iter().map(|(_, motion)| motion.rail).collect();
    assert_eq!(rails, [Some(5.0), None]);
    let arc =
        "LIN {X 1,Y 2,Z 3,A 0,B 90,C 0}\nCIRC {X 3,Y 3,Z 3,E1 1},{X 4,Y 2,Z 3,A 0,B 90,C 0,E1 2}";
    refused(&format!("{START}{arc}"), 4, "state different E1");
    refused("PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0,E1 1E9}", 2, "E1 1000000000 is beyond any rail");
    let outer = "PTP {X 1,Y 2,Z 3,A 0,B 90,C 0,S 2,T 2,E2 10}";
    refused(outer, 2, "E2 is an axis beyond the arm and its rail");
}

#[test]
fn corners_are_bounded_by_c_dis_alone() {
    let to = "LIN {X 1,Y 2,Z 3,A 0,B 90,C 0}";
    refused(&format!("{START}{to} C_DIS"), 3, "$APO.CDIS");
    let corner = |lines: &str| moves(&body(&format!("{START}{lines}")).unwrap())[1].1.corner;
    assert_eq!(corner(&format!("$APO.CDIS=0.4\n{to} C_DIS")), Corner::Within(within(0.4)));
    assert_eq!(corner(&format!("$APO.CVEL=50\n{to} C_VEL")), Corner::Unbounded);
    assert_eq!(corner(&format!("$APO.CDIS=1\n{to} C_DIS C_ORI")), Corner::Unbounded);
    assert_eq!(corner("PTP {A1 1} C_PTP"), Corner::Unbounded);
    // What INITMOV takes from the machine's configuration is not known any more.
    refused(&format!("{START}$APO.CDIS=1\nBAS (#INITMOV,0)\n{to} C_DIS"), 5, "$APO.CDIS");
}

#[test]
fn how_the_tool_turns_is_not_known_before_a_block_says_it() {
    let pose = "LIN {X 1,Y 2,Z 3,A 0,B 90,C 0}\n";
    let arc = "CIRC {X 2,Y 3,Z 3,A 0,B 90,C 0},{X 3,Y 2,Z 3,A 0,B 90,C 0}";
    let turning = |modes: &str| {
        let events = body(&format!("{START}{modes}{pose}{arc}")).unwrap();
        let moves = moves(&events);
        (moves[1].1.turning, moves[2].1.turning)
    };
    assert_eq!(turning(""), (None, None));
    assert_eq!(turning("$ORI_TYPE=#VAR\n"), (Some(Turning::Even), None));
    let path = "$ORI_TYPE=#CONSTANT\n$CIRC_TYPE=#PATH\n";
    assert_eq!(turning(path), (Some(Turning::Kept), Some(Turning::AlongPath)));
    refused("$ORI_TYPE=#FREE", 2, "$ORI_TYPE is one of #VAR");
}

#[test]
fn frames_by_number_are_those_of_the_operator_unless_the_program_sets_them() {
    let events = body("$BASE=BASE_DATA[2]\nBAS (#TOOL,3)\nBAS (#BASE,0)").unwrap();
    let expected = [
        ArmAction::Base(None),
        ArmAction::Tool(None),
        ArmAction::Base(Some(Box::new(Frame::IDENTITY))),
    ];
    let frames: Vec<ArmAction> = events
        .iter()
        .filter_map(|event| match &event.action {
            Action::Arm(action) => Some(action.clone()),
            _ => None,
        })
        .collect();
    assert_eq!(frames, expected);
    let events = body("BASE_DATA[2]={X 1,Y 0,Z 0,A 0,B 0,C 0}\n$BASE=BASE_DATA[2]").unwrap();
    assert!(matches!(events[0].action, Action::Risk(_)));
    let moved = Frame::from_translation(Vec3::X);
    assert_eq!(events[1].action, Action::Arm(ArmAction::Base(Some(Box::new(moved)))));
}

#[test]
fn the_speed_with_which_the_tool_turns_is_known_as_far_as_the_program_says_it() {
    let events = body("$VEL.ORI1=60\n$VEL.ORI2=30\nBAS (#INITMOV,0)").unwrap();
    let speeds: Vec<[Option<f64>; 2]> = events
        .iter()
        .filter_map(|event| match event.action {
            Action::Arm(ArmAction::TurnSpeed(speed)) => Some(speed),
            _ => None,
        })
        .collect();
    assert_eq!(speeds, [[Some(60.0), None], [Some(60.0), Some(30.0)], [None, None]]);
}

#[test]
fn expressions_go_by_the_ranks_of_krl() {
    let first = |value: &str| match body(&format!("$VEL.CP={value}")).unwrap()[0].action {
        Action::Feed(Feed::PerMinute(feed)) => feed / 60_000.0,
        ref other => panic!("{other:?}"),
    };
    assert_eq!(first("1+2*3"), 7.0);
    assert_eq!(first("(1+2)*3"), 9.0);
    assert_eq!(first("10-4-3"), 3.0);
    assert_eq!(first("1.5E-1"), 0.15);
    // A chain of frames: the second counts in the first.
    let chained = "$BASE={X 1,Y 0,Z 0,A 90,B 0,C 0}:{X 2,Y 0,Z 0,A 0,B 0,C 0}";
    let Action::Arm(ArmAction::Base(Some(base))) = body(chained).unwrap()[0].action.clone() else {
        panic!()
    };
    assert!(base.translation.distance(Vec3::new(1.0, 2.0, 0.0)) < 1e-12);
    refused("$VEL.CP=1/0", 2, "no result");
    refused("$VEL.CP=speed", 2, "no block has set SPEED");
    refused(&format!("$VEL.CP={}1{}", "(".repeat(50), ")".repeat(50)), 2, "nest too deep");
}

#[test]
fn inputs_are_waited_for_in_each_of_their_forms() {
    let until = |lines: &str| match &body(lines).unwrap()[0].action {
        Action::Input(input) => (input.number, input.until),
        other => panic!("{other:?}"),
    };
    assert_eq!(until("WAIT FOR $IN[7]"), (7, Until::High));
    assert_eq!(until("WAIT FOR NOT $IN[7]"), (7, Until::Low));
    assert_eq!(until("WAIT FOR ($IN[7]==FALSE)"), (7, Until::Low));
    refused("WAIT FOR $IN[1] AND $IN[2]", 2, "not understood");
    refused("WAIT SEC -1", 2, "below 0");
}

#[test]
fn programs_are_called_within_the_file_and_no_deeper_than_the_control_nests() {
    let text = "DEF job()\nsub()\nEND\nDEF sub()\nHALT\nRETURN\nEND\n";
    let events = run_with(&settings(), text).unwrap();
    assert_eq!(events[0], Event { line: 5, action: Action::Stop });
    let found = run_with(&settings(), "DEF job()\njob()\nEND\n").unwrap_err();
    assert!(found.contains("nest deeper than 20"), "{found}");
    let found = run_with(&settings(), "DEF a()\nEND\nDEF A()\nEND\n").unwrap_err();
    assert!(found.contains("two programs A"), "{found}");
}

#[test]
fn a_file_whose_programs_do_not_end_or_have_names_of_kuka_is_refused_whether_they_run_or_not() {
    let found = |behind: &str| {
        run_with(&settings(), &format!("DEF job()\nHALT\nEND\n{behind}")).unwrap_err()
    };
    for (behind, at, what) in [
        ("DEF x ( )\n", "job.src:4:", "no END"),
        ("DEF x ( )\nHALT\n", "job.src:4:", "no END"),
        ("DEFFCT INT x ( )\nRETURN 1\n", "job.src:4:", "no END"),
        ("DEF x ( )\nDEF y ( )\nEND\n", "job.src:5:", "begins within another"),
        ("DEF bas ( )\nEND\n", "job.src:4:", "BAS is a program of KUKA's own software"),
        ("DEF SPS ( )\nEND\n", "job.src:4:", "own software"),
        ("DEF Ir_Stopm ( )\nEND\n", "job.src:4:", "own software"),
        ("DEF p00 ( )\nEND\n", "job.src:4:", "own software"),
        ("DEF C_DIS ( )\nEND\n", "job.src:4:", "word of the language"),
        ("DEFFCT INT BAS ( )\nRETURN 1\nENDFCT\n", "job.src:4:", "own software"),
        ("deffct char[80] Sps (a:IN)\nRETURN 1\nENDFCT\n", "job.src:4:", "own software"),
        ("DEF Abs ( )\nEND\n", "job.src:4:", "function of the language"),
        ("DEFFCT REAL SIN ( )\nRETURN 1\nENDFCT\n", "job.src:4:", "function of the language"),
        ("DEF STRCLEAR ( )\nEND\n", "job.src:4:", "function of the language"),
        ("DEF $a ( )\nEND\n", "job.src:4:", "begin with $"),
    ] {
        let found = found(behind);
        assert!(found.contains(at) && found.contains(what), "{behind}: {found}");
    }
    let found = crate::arm::run(&settings(), "cell.src", "DEF cell ( )\nHALT\nEND\n").unwrap_err();
    assert!(found.contains("own software"), "{found}");
    // In the file of a called program as well.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("part.src"), "DEF part()\nEND\nDEF more()\n").unwrap();
    let mut settings = settings();
    settings.setup.folders = vec![folder.path().to_path_buf()].into();
    let found = run_with(&settings, "DEF job()\npart()\nEND\n").unwrap_err();
    assert!(found.contains("no END"), "{found}");
    let function = "DEF part()\nEND\nDEFFCT INT BAS()\nRETURN 1\nENDFCT\n";
    std::fs::write(folder.path().join("part.src"), function).unwrap();
    let found = run_with(&settings, "DEF job()\npart()\nEND\n").unwrap_err();
    assert!(found.contains("own software"), "{found}");
    let function = "DEF part()\nEND\nDEFFCT INT own()\nRETURN 1\nENDFCT\n";
    std::fs::write(folder.path().join("part.src"), function).unwrap();
    run_with(&settings, "DEF job()\npart()\nEND\n").unwrap();
    // KUKA keeps a file CELL.SRC where programs are; of the others none lies there.
    std::fs::write(folder.path().join("cell.src"), "DEF CELL()\nEND\n").unwrap();
    run_with(&settings, "DEF job()\npart()\nEND\n").unwrap();
    std::fs::write(folder.path().join("BAS.SRC"), "DEF BAS()\nEND\n").unwrap();
    let found = run_with(&settings, "DEF job()\npart()\nEND\n").unwrap_err();
    assert!(found.contains("lies BAS.SRC"), "{found}");
}

#[test]
fn a_called_program_is_found_in_a_file_whose_name_is_in_capitals() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("JOB_2.SRC"), "DEF job_2()\nHALT\nEND\n").unwrap();
    let mut settings = settings();
    settings.setup.folders = vec![folder.path().to_path_buf()].into();
    let events = run_with(&settings, "DEF job()\njob_2()\nEND\n").unwrap();
    assert!(events.iter().any(|event| event.action == Action::Stop), "{events:?}");
}

/// The file system of the controller keeps one file for both names.
#[test]
fn two_called_files_whose_names_differ_in_capitals_alone_are_refused() {
    for other in ["JOB_2.SRC", "Job_2.src", "job_2.Src"] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("job_2.src"), "DEF job_2()\nHALT\nEND\n").unwrap();
        let mut settings = settings();
        settings.setup.folders = vec![folder.path().to_path_buf()].into();
        run_with(&settings, "DEF job()\njob_2()\nEND\n").unwrap();
        std::fs::write(folder.path().join(other), "DEF job_2()\nEND\n").unwrap();
        let found = run_with(&settings, "DEF job()\njob_2()\nEND\n").unwrap_err();
        assert!(found.contains("job.src:2:") && found.contains(other), "{other}: {found}");
        assert!(found.contains("one file on the controller"), "{found}");
        // Nobody calls it.
        run_with(&settings, "DEF job()\nHALT\nEND\n").unwrap();
    }
}

#[test]
fn a_tool_is_changed_by_the_program_of_the_operator_behind_which_nothing_is_known() {
    let mut settings = settings();
    settings.tool_change = String::from("Tool_Change");
    let text = format!(
        "DEF job()\n{START}$APO.CDIS=1\nTOOL_CHANGE (3)\nLIN {{X 1,Y 2,Z 3,A 0,B 90,C 0}} C_DIS\nEND\n"
    );
    let found = run_with(&settings, &text).unwrap_err();
    assert!(found.contains("job.src:5:") && found.contains("$APO.CDIS"), "{found}");
    let events = run_with(&settings, "DEF job()\nTOOL_CHANGE(3)\nEND\n").unwrap();
    let Action::Tool(tool) = &events[0].action else { panic!("{events:?}") };
    assert_eq!(tool.number, 3);
    assert!(events.contains(&Event { line: 2, action: Action::Arm(ArmAction::Tool(None)) }));
    assert!(run_with(&settings, "DEF job()\nTOOL_CHANGE(0)\nEND\n").is_err());
}

#[test]
fn each_word_of_the_vocabulary_is_understood() {
    for word in toolpost_control::vocabulary(Dialect::Krl) {
        let pose = "LIN {X 1,Y 2,Z 3,A 0,B 90,C 0}\n";
        let modes = "$APO.CDIS=1\n";
        // Declarations come first.
        let lines = match word.starts_with("DECL") {
            true => format!("{word}\n{START}{pose}"),
            false => format!("{START}{pose}{modes}{word}"),
        };
        assert!(body(&lines).is_ok(), "{word}");
    }
}

#[test]
fn what_is_not_understood_is_refused_with_its_line() {
    for (lines, what) in [
        ("FOO", "FOO is no word"),
        ("$NO_SUCH=1", "$NO_SUCH"),
        ("IF TRUE THEN", "IF is not followed"),
        ("SPLINE", "SPLINE is not followed"),
        ("INTERRUPT DECL 5 WHEN $IN[1] DO MOVEAWAY()", "interrupt may move"),
        ("BAS (#PTP_PARAMS,20)", "BAS (#PTP_PARAMS,20) is not understood"),
        ("$OUT[0]=TRUE", "an output has a number"),
        ("$OUT[1]=1", "takes TRUE or FALSE"),
        ("$ANOUT[1]=1.5", "from -1 to 1"),
        ("$ADVANCE=6", "0 to 5"),
        ("LIN {X 1,X 2}", "X stands twice"),
        ("CIRC {X 1,Y 0,Z 0,A 0,B 0,C 0},{X 2,Y 1,Z 0,A 0,B 0,C 0},CA 360", "CA"),
        ("DECL INT n", "declarations"),
        ("$BASE={X 1,Y 2,Z 3}", "needs each of X, Y, Z, A, B and C"),
        ("foo(1)", "called with arguments"),
        ("HALT now", "`now` is not understood"),
        ("a_name_that_is_longer_than_24=1", "at most 24 letters"),
        ("DEF inner()", "begins within another"),
    ] {
        let lines = format!("PTP $AXIS_ACT\n{lines}");
        let found = body(&lines).expect_err(&lines);
        assert!(found.contains("job.src:3:"), "{lines}: {found}");
        assert!(found.contains(what), "{lines}: {found}");
    }
    assert!(run_with(&settings(), "DEF job()\nHALT\n").unwrap_err().contains("no END"));
    assert!(body("DECL INT n=5").unwrap_err().contains("data list"));
    assert!(run_with(&settings(), "HALT\n").unwrap_err().contains("outside of programs"));
    assert!(run_with(&settings(), "\n").unwrap_err().contains("no program"));
}

#[test]
fn a_data_list_in_a_folder_gives_positions_their_values() {
    let folder = tempfile::tempdir().unwrap();
    let list =
        "&ACCESS RVP\nDEFDAT JOB\nDECL E6POS XP1={X 5,Y 6,Z 7,A 0,B 90,C 0,S 2,T 2,E1 0}\nENDDAT\n";
    std::fs::write(folder.path().join("job.dat"), list).unwrap();
    let mut settings = settings();
    settings.setup.folders = vec![folder.path().to_path_buf()].into();
    let events = run_with(&settings, "DEF job()\nPTP XP1\nEND\n").unwrap();
    let ArmPath::Point(end) = moves(&events)[0].1.path else { panic!() };
    assert_eq!(end.translation, Vec3::new(5.0, 6.0, 7.0));
    for (list, at, what) in [
        ("DEFDAT job\n", "job.dat:1:", "no ENDDAT"),
        ("", "job.dat:1:", "no ENDDAT"),
        ("DEFDAT foo\nENDDAT\n", "job.dat:1:", "that of FOO"),
        ("DEFDAT job\nEND\n", "job.dat:2:", "declarations and values alone"),
        ("DEFDAT job\nHALT\nENDDAT\n", "job.dat:2:", "declarations and values alone"),
        ("DEFDAT job\nENDDAT\nINT n=1\n", "job.dat:3:", "outside of the data list"),
        ("INT n=1\nDEFDAT job\nENDDAT\n", "job.dat:1:", "outside of the data list"),
    ] {
        std::fs::write(folder.path().join("job.dat"), list).unwrap();
        let found = run_with(&settings, "DEF job()\nHALT\nEND\n").unwrap_err();
        assert!(found.contains(at) && found.contains(what), "{list}: {found}");
    }
    let found = run_with(&self::settings(), "DEF job()\nHALT\nENDDAT\nEND\n").unwrap_err();
    assert!(found.contains("ENDDAT ends a data list"), "{found}");
}

#[test]
fn every_damage_of_a_job_is_read_or_refused_without_a_panic() {
    for at in 0..JOB.len() {
        for byte in [b'{', b'9', b'\n', b'(', b'\'', 0xff] {
            let mut text = JOB.as_bytes().to_vec();
            text[at] = byte;
            let _ = read(&settings(), "job.src", &text, &mut |_| Ok(()));
        }
    }
}
