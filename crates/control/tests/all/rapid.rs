//! RAPID, by what ABB's manuals say of it, the job of the specification, and a program that others have written.

use crate::arm::moves;
use geom::{Frame, Vec3};
use program::{Feed, Output, OutputValue, Until};
use toolpost_control::{
    Action, ArmAction, ArmPath, Corner, Dialect, Event, Rounding, Settings, Turning, read,
};

fn settings() -> Settings {
    let mut settings = Settings::new(Dialect::Rapid, [false; 3]);
    settings.signals = [String::from("DO10_"), String::from("AO10_")];
    settings
}

fn run_with(settings: &Settings, text: &str) -> Result<Vec<Event>, String> {
    crate::arm::run(settings, "job.mod", text)
}

/// The events of a procedure of these statements, which begin in line 4.
fn body(lines: &str) -> Result<Vec<Event>, String> {
    let text = format!("MODULE Job\nVAR num number;\nPROC main()\n{lines}\nENDPROC\nENDMODULE\n");
    run_with(&settings(), &text)
}

#[track_caller]
fn refused(lines: &str, line: u32, what: &str) {
    let found = body(lines).expect_err(lines);
    let place = format!("job.mod:{line}:");
    assert!(found.contains(&place) && found.contains(what), "{lines}: {found}");
}

/// Half of the shorter motion at the most; what is no motion happens before the corner.
fn within(distance: f64) -> Corner {
    Corner::Within(Rounding { distance, shortened: true, stops: false })
}

/// A robtarget.
fn target(tip: &str, configuration: &str) -> String {
    format!("[[{tip}],[0,0,1,0],[{configuration}],[9E9,9E9,9E9,9E9,9E9,9E9]]")
}

fn line(tip: &str) -> String {
    format!("MoveL {},v100,fine,tool0;\n", target(tip, "0,0,0,0"))
}

/// The job of the specification, whose joints put the tool at (0, 0, 50) of the part.
const JOB: &str = "MODULE Job\n  PERS tooldata tSp:=[TRUE,[[0,0,150],[1,0,0,0]],[1.5,[0,0,75],[1,0,0,0],0,0,0]];\n\
  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[450,0,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
  CONST speeddata vPlunge:=[5,500,5000,1000];\n  CONST speeddata vCut:=[20,500,5000,1000];\n\
  CONST jointtarget jStart:=[[0,34.622,-4.659,0,60.037,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
  CONST robtarget p1:=[[0,0,-2],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
  CONST robtarget p2:=[[60,0,-2],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
  CONST robtarget p3:=[[74.142,5.858,-2],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
  CONST robtarget p4:=[[80,20,-2],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
  CONST robtarget p5:=[[80,20,50],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n  PROC main()\n    ConfL\\Off;\n\
    MoveAbsJ jStart,v50,fine,tSp\\WObj:=wPart;\n    SetDO doSpindle,1;\n    WaitTime 2;\n\
    MoveL p1,vPlunge,fine,tSp\\WObj:=wPart;\n    MoveL p2,vCut,z1,tSp\\WObj:=wPart;\n\
    MoveC p3,p4,vCut,fine,tSp\\WObj:=wPart;\n    MoveL p5,v100,fine,tSp\\WObj:=wPart;\n    SetDO doSpindle,0;\n\
    WaitTime 1;\n  ENDPROC\nENDMODULE\n";

#[test]
fn the_job_of_the_specification_makes_its_motion() {
    let events = run_with(&settings(), JOB).unwrap();
    let moves = moves(&events);
    assert_eq!(moves.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [14, 17, 18, 19, 20]);
    let ArmPath::Joints(joints) = moves[0].1.path else { panic!() };
    for (at, expected) in joints.iter().zip([0.0, 34.622, -4.659, 0.0, 60.037, 0.0]) {
        // A num has 24 bits.
        assert!((at - expected).abs() < 1e-5, "{joints:?}");
    }
    let ArmPath::Line(end) = moves[1].1.path else { panic!() };
    assert_eq!(end.translation, Vec3::new(0.0, 0.0, -2.0));
    // Half a turn about Y: the tool points down, its X backwards.
    assert!((end.matrix3 * Vec3::Z).distance(Vec3::NEG_Z) < 1e-12);
    assert!((end.matrix3 * Vec3::X).distance(Vec3::NEG_X) < 1e-12);
    assert_eq!((moves[1].1.corner, moves[2].1.corner), (Corner::Exact, within(1.0)));
    let ArmPath::Arc { via, end } = moves[3].1.path else { panic!() };
    assert!(via.translation.distance(Vec3::new(74.142, 5.858, -2.0)) < 1e-5);
    assert_eq!(end.translation, Vec3::new(80.0, 20.0, -2.0));
    // It states neither SingArea nor CirPathMode.
    assert_eq!((moves[1].1.turning, moves[3].1.turning), (None, None));
    let feeds: Vec<Feed> = events
        .iter()
        .filter_map(|event| match event.action {
            Action::Feed(feed) => Some(feed),
            _ => None,
        })
        .collect();
    assert_eq!(feeds, [3000.0, 300.0, 1200.0, 6000.0].map(Feed::PerMinute));
    let base = Frame::from_translation(Vec3::new(450.0, 0.0, 150.0));
    for action in [
        Action::Arm(ArmAction::Base(Some(Box::new(base)))),
        Action::Arm(ArmAction::Load(1.5, Vec3::new(0.0, 0.0, 75.0))),
        Action::Arm(ArmAction::PartOnFlange(false)),
        Action::Arm(ArmAction::TurnSpeed([Some(500.0); 2])),
        Action::Dwell(2.0),
    ] {
        assert!(events.iter().any(|event| event.action == action), "{action:?}");
    }
    // The name doSpindle is that of the controller's configuration; and the job ends without EXIT.
    assert_eq!(events.iter().filter(|event| matches!(event.action, Action::Risk(_))).count(), 3);
    assert_eq!(events.last().unwrap().action, Action::End);
}

#[test]
fn the_program_of_robodk_is_read_with_its_messages_and_its_call() {
    let Some(folder) = judge::data("robots") else { return };
    let text = std::fs::read(folder.join("programs/robodk-Program.mod")).unwrap();
    let text = String::from_utf8(text).unwrap();
    let found = run_with(&settings(), &text).unwrap_err();
    assert!(found.contains("job.mod:30:") && found.contains("SUBPROG"), "{found}");
    let called = tempfile::tempdir().unwrap();
    let module = "MODULE Sub\nPROC Subprog()\nStop;\nENDPROC\nENDMODULE\n";
    std::fs::write(called.path().join("subprog.mod"), module).unwrap();
    let mut settings = settings();
    settings.signals[0] = String::from("D_OUT_");
    settings.setup.folders = vec![called.path().to_path_buf()].into();
    let events = run_with(&settings, &text).unwrap();
    assert_eq!(moves(&events).len(), 6);
    // The lines of what the called file does are its own.
    let in_file = |line: u32, file: Option<&str>| Event {
        line,
        action: Action::Arm(ArmAction::File(file.map(Box::from))),
    };
    let at = events.iter().position(|event| *event == in_file(30, Some("subprog.mod"))).unwrap();
    assert_eq!(events[at + 1], Event { line: 3, action: Action::Stop });
    assert_eq!(events[at + 2], in_file(4, None));
    let on = Output { number: 5, value: OutputValue::Digital(true), with_motion: false };
    assert!(events.iter().any(|event| event.action == Action::Output(on)));
    let waits = |event: &Event| match &event.action {
        Action::Input(input) => input.number == 5 && input.until == Until::High,
        _ => false,
    };
    assert!(events.iter().any(waits));
}

#[test]
fn configurations_are_quarters_of_joints_and_a_posture() {
    let events = body(&line("1,2,3").replace("0,0,0,0", "-1,1,-2,5")).unwrap();
    let posture = moves(&events)[0].1.posture;
    let letters = (posture.rear, posture.below, posture.flip);
    assert_eq!(letters, (Some(true), Some(false), Some(true)));
    assert_eq!(posture.joints[0], Some([-90.0, 0.0]));
    assert_eq!(posture.joints[3], Some([90.0, 180.0]));
    assert_eq!(posture.joints[5], Some([-180.0, -90.0]));
    // Under ConfL \Off the control does not use them: both sides of an edge are right.
    let events = body(&format!("ConfL\\Off;\n{}", line("1,2,3"))).unwrap();
    let [from, to] = moves(&events)[0].1.posture.joints[0].unwrap();
    assert!(from < -1e-3 && to > 90.001);
    refused(&line("1,2,3").replace("0,0,0,0", "0,0,0,8"), 4, "a configuration has");
    refused(&line("1,2,3").replace("0,0,0,0", "0,0.5,0,0"), 4, "a configuration has");
}

#[test]
fn zones_bound_corners_of_lines_and_not_those_of_joints() {
    let corner = |zone: &str| {
        let text = line("1,2,3").replace("fine", zone);
        moves(&body(&text).unwrap())[0].1.corner
    };
    assert_eq!((corner("fine"), corner("z0")), (Corner::Exact, within(0.3)));
    // The tool turns within a larger zone than the tip.
    assert_eq!(corner("z5"), within(8.0));
    assert_eq!(corner("[FALSE,0.4,0.5,0.5,0.1,0.5,0.1]"), within(0.5));
    assert_eq!(corner("[TRUE,0.4,0.5,0.5,0.1,0.5,0.1]"), Corner::Exact);
    // `\\Z` is the zone of the tip alone (RM, MoveL): the tool turns within that of `z5`, 8 mm.
    assert_eq!(corner("z5\\Z:=2"), within(8.0));
    assert_eq!(corner("z5\\Z:=12"), within(12.0));
    let joints = "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,z1,tool0;";
    assert_eq!(moves(&body(joints).unwrap())[0].1.corner, Corner::Unbounded);
    refused(&line("1,2,3").replace("fine", "[FALSE,-1,0,0,0,0,0]"), 4, "not below 0");
}

#[test]
fn how_the_tool_turns_is_what_singarea_and_cirpathmode_state() {
    let end = target("3,2,3", "0,0,0,0");
    let arc = format!("MoveC {},{end},v100,fine,tool0;", target("2,3,3", "0,0,0,0"));
    let turning = |modes: &str| {
        let events = body(&format!("{modes}\n{}{arc}", line("1,2,3"))).unwrap();
        let moves = moves(&events);
        (moves[0].1.turning, moves[1].1.turning)
    };
    let even = Some(Turning::Even);
    assert_eq!(turning(""), (None, None));
    assert_eq!(turning("SingArea\\Off;"), (even, None));
    assert_eq!(turning("SingArea\\Off;CirPathMode\\ObjectFrame;"), (even, even));
    let along = Some(Turning::AlongPath);
    assert_eq!(turning("SingArea\\Off;CirPathMode\\PathFrame;"), (even, along));
    let wrist = Some(Turning::ByJoints);
    assert_eq!(turning("SingArea\\Wrist;CirPathMode\\ObjectFrame;"), (wrist, wrist));
    refused("CirPathMode\\CirPointOri;", 4, "\\CIRPOINTORI is not followed");
}

#[test]
fn arcs_are_refused_where_the_control_refuses_them() {
    let arc = |via: &str, end: &str| {
        let [via, end] = [via, end].map(|tip| target(tip, "0,0,0,0"));
        format!("{}MoveC {via},{end},v100,fine,tool0;", line("10,0,0"))
    };
    assert!(body(&arc("0,10,0", "-10,0,0")).is_ok());
    // 270 degrees.
    refused(&arc("-7.071,7.071,0", "0,-10,0"), 5, "240°");
    refused(&arc("10,0.05,0", "9,4,0"), 5, "nearer to each other than 0.1 mm");
    refused(&arc("20,0.01,0", "30,0,0"), 5, "within 1° of a line");
    let turned = arc("0,10,0", "-10,0,0").replacen(
        "MoveC [[0,10,0],[0,0,1,0]",
        "MoveC [[0,10,0],[0,0.70710678,0.70710678,0]",
        1,
    );
    refused(&turned, 5, "not on the way");
}

#[test]
fn targets_are_displaced_in_the_object_and_in_the_tool() {
    let p = target("1,2,3", "0,0,0,0");
    let end = |expression: &str| {
        let text = format!("MoveL {expression},v100,fine,tool0;");
        match moves(&body(&text).unwrap())[0].1.path {
            ArmPath::Line(end) => end,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(end(&format!("Offs({p},10,20,30)")).translation, Vec3::new(11.0, 22.0, 33.0));
    // The tool points down: its Z is that of the object turned round.
    let moved = end(&format!("RelTool({p},0,0,5)")).translation;
    assert!(moved.distance(Vec3::new(1.0, 2.0, -2.0)) < 1e-6, "{moved}");
    let turned = end(&format!("RelTool({p},0,0,0\\Rz:=90)"));
    assert!((turned.matrix3 * Vec3::X).distance(Vec3::Y) < 1e-6, "{:?}", turned.matrix3);
}

#[test]
fn data_are_declared_assigned_and_calculated() {
    let feed = |lines: &str| {
        let events = body(&format!("{lines}\n{}", line("1,2,3").replace("v100", "v"))).unwrap();
        events.iter().find_map(|event| match event.action {
            Action::Feed(Feed::PerMinute(feed)) => Some(feed / 60.0),
            _ => None,
        })
    };
    let speed = "VAR speeddata v:=[1,500,5000,1000];";
    assert_eq!(feed(&format!("{speed}\nv.v_tcp:=2+3*4;")), Some(14.0));
    assert_eq!(feed(&format!("{speed}\nv.v_tcp:=(2+3)*4-10-5;")), Some(5.0));
    assert_eq!(feed(&format!("{speed}\nnumber:=7;v.v_tcp:=number DIV 2;")), Some(3.0));
    assert_eq!(feed(&format!("{speed}\nv:=[7.5E1,500,5000,1000];")), Some(75.0));
    refused("CONST num two:=2;\ntwo:=3;", 5, "TWO is a constant");
    refused("three:=3;", 4, "THREE is not declared");
    refused("VAR num four;\nVAR num four;", 5, "declared twice");
    refused("number:=number+1;", 4, "no statement has set NUMBER");
    refused("number:=1/0;", 4, "has no result");
    refused("number:=TRUE;", 4, "TRUE or FALSE where a num is needed");
    refused("VAR speeddata v;\nv.v_tcp:=5;", 5, "the other parts");
    refused(&format!("number:={}1{};", "(".repeat(50), ")".repeat(50)), 4, "nest too deep");
}

#[test]
fn tool_and_work_object_are_compared_with_who_holds_them() {
    let text = |tool: &str, object: &str| {
        let end = target("1,2,3", "0,0,0,0");
        format!(
            "MODULE Job\nPERS tooldata t:=[{tool},[[0,0,150],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n\
             PERS wobjdata w:=[{object},TRUE,\"\",[[1,0,0],[0.70710678,0,0,0.70710678]],[[2,0,0],[1,0,0,0]]];\n\
             PROC main()\nMoveL {end},v100,fine,t,\\WObj:=w;\nENDPROC\nENDMODULE\n"
        )
    };
    let events = run_with(&settings(), &text("TRUE", "FALSE")).unwrap();
    let base = events.iter().find_map(|event| match &event.action {
        Action::Arm(ArmAction::Base(Some(base))) => Some(base),
        _ => None,
    });
    // The object's own frame counts in that of the user, which is turned by 90 degrees.
    assert!(base.unwrap().translation.distance(Vec3::new(1.0, 2.0, 0.0)) < 1e-6);
    let events = run_with(&settings(), &text("FALSE", "TRUE")).unwrap();
    let on_flange = Action::Arm(ArmAction::PartOnFlange(true));
    assert!(events.iter().any(|event| event.action == on_flange));
    let moments = |moments: &str| {
        let with = format!("[1,0,0,0],{moments}]];");
        run_with(&settings(), &text("TRUE", "FALSE").replace("[1,0,0,0],0,0,0]];", &with))
    };
    for wrong in ["0,-1,0", "0,0,1E6", "5000,0,0"] {
        let found = moments(wrong).unwrap_err();
        assert!(found.contains("moments of inertia"), "{found}");
    }
    moments("0.01,0.01,0.02").unwrap();
    let found = run_with(&settings(), &text("TRUE", "TRUE")).unwrap_err();
    assert!(found.contains("job.mod:5:") && found.contains("held by the robot"), "{found}");
}

#[test]
fn a_tool_is_changed_by_the_procedure_of_the_operator_behind_which_nothing_is_known() {
    let mut settings = settings();
    settings.tool_change = String::from("ChangeTool");
    let text = |behind: &str| {
        format!(
            "MODULE Job\nPERS wobjdata w:=[FALSE,TRUE,\"\",[[1,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
                 PROC main()\nSingArea\\Off;\nChangeTool 3;\n{behind}ENDPROC\nENDMODULE\n"
        )
    };
    let events = run_with(&settings, &text(&line("1,2,3"))).unwrap();
    let Action::Tool(tool) = &events[0].action else { panic!("{events:?}") };
    assert_eq!((tool.number, moves(&events)[0].1.turning), (3, None));
    let found = run_with(&settings, &text(&line("1,2,3").replace("tool0", "tool0\\WObj:=w")));
    assert!(found.unwrap_err().contains("no statement has set W"));
    let twice = text("").replace("ChangeTool 3", "ChangeTool 0");
    assert!(run_with(&settings, &twice).unwrap_err().contains("number of the tool"));
}

#[test]
fn procedures_are_called_and_the_program_ends_at_exit() {
    let text = "MODULE Job\nPROC main()\nsub;\nStop;\nENDPROC\nPROC sub()\nTPWrite \"a; ! \"\"b\"\"\";\nEXIT;\nENDPROC\nENDMODULE\n";
    let events = run_with(&settings(), text).unwrap();
    let expected = [(7, Action::Message("a; ! \"b\"".into())), (8, Action::End)];
    assert_eq!(events, expected.map(|(line, action)| Event { line, action }));
    // The same without EXIT: in continuous mode it would begin anew (Technical reference manual RAPID, "EXIT").
    let events = run_with(&settings(), &text.replace("EXIT;\n", "")).unwrap();
    let found = events.iter().find_map(|event| match &event.action {
        Action::Risk(risk) => Some((event.line, risk.rule.name(), risk.refused)),
        _ => None,
    });
    assert_eq!(found, Some((5, "no-end", true)));
    let deep = "MODULE Job\nPROC main()\nmain;\nENDPROC\nENDMODULE\n";
    assert!(run_with(&settings(), deep).unwrap_err().contains("nest deeper than 20"));
}

#[test]
fn each_word_of_the_vocabulary_is_understood() {
    for word in toolpost_control::vocabulary(Dialect::Rapid) {
        assert!(body(&format!("{}{word}", line("1,2,3"))).is_ok(), "{word}");
    }
}

#[test]
fn what_is_not_understood_is_refused_with_its_line() {
    for (lines, what) in [
        ("Foo;", "FOO is no instruction"),
        ("IF number=1 THEN\nENDIF", "IF is not followed"),
        ("VelSet 50,800;", "VELSET is not followed"),
        ("PDispOn p1,tool0;", "PDISPON is not followed"),
        ("SetDO DO10_1,2;", "a signal is 0 or 1"),
        ("WaitTime -1;", "not below 0 s"),
        ("WaitTime 1", "`;` is missing"),
        ("AccSet 5,100;", "20 to 100 percent"),
        ("a_name_that_is_longer_than_thirty_two:=1;", "at most 32 letters"),
        ("TPWrite \"no end;", "the text has no end"),
        (
            "VAR tooldata t:=[TRUE,[[0,0,1],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];",
            "PERS TOOLDATA",
        ),
        ("VAR num list{5};", "arrays are not followed"),
        ("VAR clock c;", "the type CLOCK"),
        ("VAR num exit;", "EXIT is a word of RAPID"),
        ("number:=CPos(tool0);", "the function CPOS"),
        ("ConfL;", "`\\` is needed"),
    ] {
        let lines = format!("Stop;\n{lines}");
        let found = body(&lines).expect_err(&lines);
        assert!(found.contains("job.mod:5:"), "{lines}: {found}");
        assert!(found.contains(what), "{lines}: {found}");
    }
    for (from, to, what) in [
        ("fine", "fine\\Inpos:=inpos50", "of options only \\Z"),
        ("v100", "v100\\T:=5", "of options only \\V"),
        ("v100", "vmax", "VMAX is not declared"),
        ("[0,0,1,0]", "[0,0,0.99,0]", "the length 0.99"),
        ("9E9,9E9,9E9,9E9,9E9,9E9", "9E9,0,9E9,9E9,9E9,9E9", "beyond the arm and its rail"),
        ("9E9,9E9,9E9,9E9,9E9,9E9", "-1E7,9E9,9E9,9E9,9E9,9E9", "eax_a is beyond any rail"),
        (
            "tool0",
            "[TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]]",
            "the name of a tooldata",
        ),
        ("[1,2,3]", "[1,2]", "a robtarget is needed"),
    ] {
        refused(&line("1,2,3").replace(from, to), 4, what);
    }
    for (text, what) in [
        ("", "begins with MODULE"),
        ("MODULE Test\nENDMODULE\n", "TEST is a word of RAPID"),
        ("MODULE Job\nENDMODULE\n", "no procedure main"),
        ("MODULE Job\nPROC main()\nENDMODULE\n", "ENDPROC is missing"),
        ("MODULE Job\nPROC main()\nENDPROC\nENDMODULE\nmore", "behind ENDMODULE"),
        ("MODULE Job\nPROC main(num a)\nENDPROC\nENDMODULE\n", "parameters"),
        ("MODULE Job\nPROC a()\nENDPROC\nPROC A()\nENDPROC\nENDMODULE\n", "two procedures A"),
    ] {
        let found = run_with(&settings(), text).unwrap_err();
        assert!(found.contains(what), "{text}: {found}");
    }
}

#[test]
fn every_damage_of_a_job_is_read_or_refused_without_a_panic() {
    for at in 0..JOB.len() {
        for byte in [b'[', b'9', b'\n', b'(', b'"', b';', b'!', 0xff] {
            let mut text = JOB.as_bytes().to_vec();
            text[at] = byte;
            let _ = read(&settings(), "job.mod", &text, &mut |_| Ok(()));
        }
    }
}

#[test]
fn eax_a_is_the_rail_and_an_arc_states_one_position_of_it() {
    let target = |x: u8, y: u8, rail: &str| {
        format!("[[{x},{y},3],[0,0,1,0],[0,0,0,0],[{rail},9E9,9E9,9E9,9E9,9E9]]")
    };
    let arc = |via: &str, end: &str| {
        format!("MoveC {},{},v100,fine,tool0;", target(2, 1, via), target(4, 0, end))
    };
    let start = format!("MoveL {},v100,fine,tool0;\n", target(0, 0, "-12.5"));
    let rail = |text: &str| moves(&body(text).unwrap()).last().unwrap().1.rail;
    assert_eq!(rail(&start), Some(-12.5));
    assert_eq!(rail(&format!("{start}{}", arc("9E9", "9E9"))), None);
    assert_eq!(rail(&format!("{start}{}", arc("40", "40"))), Some(40.0));
    let joints = "MoveAbsJ [[0,0,0,0,30,0],[250,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;";
    assert_eq!(rail(joints), Some(250.0));
    refused(&format!("{start}{}", arc("40", "41")), 5, "different positions of the rail");
}

/// A program that loads modules one after the other, as the example of `Load` in the Technical reference manual RAPID.
const LOADS: &str = "MODULE Job\nPROC main()\nLoad \\Dynamic,diskhome\\File:=\"A.MOD\";\n%\"route_a\"%;\nUnLoad diskhome\\File:=\"A.MOD\";\n\
Load \\Dynamic,\"HOME:/b.mod\";\n%\"PartB:route_b\"%;\nUnLoad \"HOME:/b.mod\";\nEXIT;\nENDPROC\nENDMODULE\n";

/// The modules that it loads: each has data of its own, by the same name.
fn loading(text: &str) -> Result<Vec<Event>, String> {
    let folder = tempfile::tempdir().unwrap();
    let module = |name: &str, seconds: u32| {
        format!(
            "MODULE Part{name}\nLOCAL PERS num time:=0;\nPROC route_{name}()\ntime:={seconds};\nWaitTime time;\nENDPROC\nENDMODULE\n"
        )
    };
    std::fs::write(folder.path().join("a.mod"), module("a", 1)).unwrap();
    std::fs::write(folder.path().join("b.mod"), module("b", 2)).unwrap();
    std::fs::write(folder.path().join("c.mod"), module("a", 3)).unwrap();
    let mut settings = settings();
    settings.setup.folders = vec![folder.path().to_path_buf()].into();
    run_with(&settings, text)
}

#[test]
fn modules_are_loaded_called_by_a_name_and_unloaded() {
    let events = loading(LOADS).unwrap();
    let file = |name: Option<&str>| Action::Arm(ArmAction::File(name.map(Box::from)));
    let expected = [
        // The arm stands while a module is loaded.
        (3, file(None)),
        (4, file(Some("a.mod"))),
        (5, Action::Dwell(1.0)),
        (6, file(None)),
        (5, file(None)),
        (6, file(None)),
        (7, file(Some("b.mod"))),
        (5, Action::Dwell(2.0)),
        (6, file(None)),
        (8, file(None)),
        (9, Action::End),
    ];
    assert_eq!(events, expected.map(|(line, action)| Event { line, action }));
}

#[test]
fn modules_that_are_not_there_or_there_twice_or_stay_are_refused() {
    for (from, to, line, what) in [
        (
            "Load \\Dynamic,diskhome\\File:=\"A.MOD\";\n",
            "",
            3,
            "no module that is loaded has a procedure ROUTE_A",
        ),
        ("UnLoad diskhome\\File:=\"A.MOD\";\n", "", 8, "HOME:/A.MOD is still loaded"),
        (
            "UnLoad diskhome\\File:=\"A.MOD\"",
            "UnLoad diskhome\\File:=\"B.MOD\"",
            5,
            "HOME:/B.MOD is not loaded",
        ),
        (
            "\"HOME:/b.mod\";\n%",
            "\"HOME:/A.MOD\";\n%",
            7,
            "no module that is loaded has a procedure ROUTE_B",
        ),
        (
            "UnLoad diskhome\\File:=\"A.MOD\";\nLoad \\Dynamic,\"HOME:/b.mod\"",
            "Load \\Dynamic,\"HOME:/a.mod\"",
            5,
            "HOME:/a.mod is loaded already",
        ),
        (
            "UnLoad diskhome\\File:=\"A.MOD\";\nLoad \\Dynamic,\"HOME:/b.mod\"",
            "Load \\Dynamic,\"HOME:/c.mod\"",
            5,
            "another of that name is there",
        ),
        ("A.MOD", "D.MOD", 3, "HOME:/D.MOD is in no folder"),
        ("\"A.MOD\"", "\"parts/A.MOD\"", 3, "no file that lies in HOME: itself"),
        ("\"A.MOD\"", "\"../A.MOD\"", 3, "no file that lies in HOME: itself"),
        ("HOME:/b.mod", "TEMP:/b.mod", 6, "no file that lies in HOME: itself"),
        ("\\Dynamic,diskhome", "diskhome", 3, "loaded without \\Dynamic"),
        ("%\"route_a\"%", "%\"route_x\"%", 4, "has a procedure ROUTE_X"),
        ("%\"route_a\"%", "%\"PartB:route_a\"%", 4, "has a procedure ROUTE_A"),
        ("%\"route_a\"%", "%\"route a\"%", 4, "no name of a procedure"),
        ("%\"route_a\"%", "%name%", 4, "as a text alone"),
        ("%\"route_a\"%", "%\"route_a\"% 1", 4, "with arguments"),
        ("%\"route_a\"%", "%\"main\"%", 3, "is loaded already"),
    ] {
        let text = LOADS.replace(from, to);
        assert_ne!(text, LOADS, "{from}");
        let found = loading(&text).unwrap_err();
        assert!(
            found.contains(&format!("job.mod:{line}:")) && found.contains(what),
            "{to}: {found}"
        );
    }
}

/// *Basic characteristics RAPID*, "Routine scope": the scope of a local routine is the module in which it is.
#[test]
fn a_local_procedure_of_another_module_is_called_with_the_name_of_its_module_alone() {
    let text = "MODULE Job\nPROC main()\nLoad \\Dynamic,\"HOME:/a.mod\";\n%\"go\"%;\nUnLoad \"HOME:/a.mod\";\nEXIT;\nENDPROC\nENDMODULE\n";
    let run = |text: &str, module: &str| {
        let folder = tempfile::tempdir().unwrap();
        for file in ["a.mod", "go.mod"] {
            std::fs::write(folder.path().join(file), module).unwrap();
        }
        let mut settings = settings();
        settings.setup.folders = vec![folder.path().to_path_buf()].into();
        run_with(&settings, text)
    };
    let module = "MODULE A\nLOCAL PROC go()\nWaitTime 1;\nENDPROC\nENDMODULE\n";
    let found = run(text, module).unwrap_err();
    assert!(found.contains("job.mod:4:") && found.contains("LOCAL"), "{found}");
    assert!(found.contains("called-program"), "{found}");
    run(&text.replace("%\"go\"%", "%\"A:go\"%"), module).unwrap();
    run(text, &module.replace("LOCAL ", "")).unwrap();
    // A call within the module, by its text too.
    let inside = module
        .replace("WaitTime 1;", "%\"stay\"%;\nstay;")
        .replace("LOCAL PROC go", "PROC go")
        .replace("ENDMODULE", "LOCAL PROC stay()\nWaitTime 1;\nENDPROC\nENDMODULE");
    run(text, &inside).unwrap();
    // A call of a file of the name.
    let direct = "MODULE Job\nPROC main()\ngo;\nEXIT;\nENDPROC\nENDMODULE\n";
    let found = run(direct, module).unwrap_err();
    assert!(found.contains("job.mod:3:") && found.contains("LOCAL"), "{found}");
    run(direct, &module.replace("LOCAL ", "")).unwrap();
}

/// A module that is unloaded by its own procedure, and what is wrong in a module: with its file and line.
#[test]
fn what_is_wrong_in_a_module_has_its_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let text = "MODULE Job\nPROC main()\nLoad \\Dynamic,\"HOME:/a.mod\";\n%\"go\"%;\nUnLoad \"HOME:/a.mod\";\nEXIT;\nENDPROC\nENDMODULE\n";
    for (body, line, what) in [
        ("UnLoad \"HOME:/a.mod\";", 3, "while it is run"),
        ("WaitTime -1;", 3, "not below 0 s"),
        ("%\"go\"%;", 3, "nest deeper than 20"),
        ("time:=1;", 3, "TIME is not declared here"),
        ("WaitTime 1", 3, "`;` is missing"),
    ] {
        let module = format!("MODULE A\nPROC go()\n{body}\nENDPROC\nENDMODULE\n");
        std::fs::write(folder.path().join("a.mod"), module).unwrap();
        let mut settings = settings();
        settings.setup.folders = vec![folder.path().to_path_buf()].into();
        let found = run_with(&settings, text).unwrap_err();
        assert!(
            found.contains(&format!("a.mod:{line}:")) && found.contains(what),
            "{body}: {found}"
        );
    }
}
