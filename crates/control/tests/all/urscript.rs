//! URScript, by what the script manual says of it, the job of the specification, and a program that RoboDK has written.

use crate::arm::moves;
use geom::{Frame, Vec3};
use program::{Feed, Output, OutputValue, Until};
use toolpost_control::{
    Action, ArmAction, ArmPath, Corner, Dialect, Event, Rounding, Settings, Turning, read,
};

fn settings() -> Settings {
    Settings::new(Dialect::UrScript, [false; 3])
}

fn run_with(settings: &Settings, text: &str) -> Result<Vec<Event>, String> {
    crate::arm::run(settings, "job.script", text)
}

/// The events of a program of these lines.
fn body(lines: &str) -> Result<Vec<Event>, String> {
    run_with(&settings(), &format!("def job():\n{lines}\nend\n"))
}

fn feeds(events: &[Event]) -> Vec<Feed> {
    let of = |event: &Event| match event.action {
        Action::Feed(feed) => Some(feed),
        _ => None,
    };
    events.iter().filter_map(of).collect()
}

#[track_caller]
fn refused(lines: &str, line: u32, what: &str) {
    let found = body(lines).expect_err(lines);
    assert!(
        found.contains(&format!("job.script:{line}:")) && found.contains(what),
        "{lines}: {found}"
    );
}

/// Blends that the controller does not shorten, and that nothing stops.
fn blend(distance: f64) -> Corner {
    Corner::Within(Rounding { distance, shortened: false, stops: false })
}

/// The job of the specification, whose joints put the tool at (0, 0, 50) of the part.
const JOB: &str = "def job():
  set_tcp(p[0,0,0.15,0,0,0])
  set_payload(1.5,[0,0,0.075])
  part = p[0.45,0,0.15,0,0,0]
  movej([2.84086,-1.65957,2.0143,-1.92553,-1.5708,-1.87153],a=1.4,v=0.5)
  set_standard_digital_out(0,True)
  sleep(2.0)
  movel(pose_trans(part,p[0,0,-0.002,3.1415927,0,0]),a=1.2,v=0.005)
  movel(pose_trans(part,p[0.06,0,-0.002,3.1415927,0,0]),a=1.2,v=0.02,r=0.001)
  movec(pose_trans(part,p[0.074142,0.005858,-0.002,3.1415927,0,0]),pose_trans(part,p[0.08,0.02,-0.002,3.1415927,0,0]),a=1.2,v=0.02,r=0,mode=0)
  movel(pose_trans(part,p[0.08,0.02,0.05,3.1415927,0,0]),a=1.2,v=0.1)
  set_standard_digital_out(0,False)
  sleep(1.0)
end
";

#[test]
fn the_job_of_the_specification_makes_its_motion() {
    let events = run_with(&settings(), JOB).unwrap();
    let moves = moves(&events);
    assert_eq!(moves.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [5, 8, 9, 10, 11]);
    let ArmPath::Joints(joints) = moves[0].1.path else { panic!("{:?}", moves[0]) };
    // 2.84086 rad are 162.769°.
    assert!((joints[0] - 162.769_288).abs() < 1e-5 && (joints[4] + 90.000_211).abs() < 1e-5);
    assert_eq!(moves[0].1.corner, Corner::Exact);
    let ArmPath::Line(end) = moves[1].1.path else { panic!("{:?}", moves[1]) };
    assert!(end.translation.distance(Vec3::new(450.0, 0.0, 148.0)) < 1e-9);
    // Half a turn about X: the tool points down, its Y backwards.
    assert!((end.matrix3 * Vec3::Z).distance(Vec3::NEG_Z) < 1e-6);
    assert!((end.matrix3 * Vec3::X).distance(Vec3::X) < 1e-6);
    assert_eq!((moves[1].1.corner, moves[1].1.turning), (Corner::Exact, Some(Turning::Even)));
    assert_eq!(moves[2].1.corner, blend(1.0));
    let ArmPath::Arc { via, end } = moves[3].1.path else { panic!("{:?}", moves[3]) };
    assert!(via.translation.distance(Vec3::new(524.142, 5.858, 148.0)) < 1e-9);
    assert!(end.translation.distance(Vec3::new(530.0, 20.0, 148.0)) < 1e-9);
    assert_eq!((moves[3].1.corner, moves[3].1.turning), (Corner::Exact, Some(Turning::Even)));
    assert_eq!(feeds(&events), [300.0, 1200.0, 6000.0].map(Feed::PerMinute));
    let tool = Frame::from_translation(Vec3::new(0.0, 0.0, 150.0));
    let spindle = |on| Output { number: 0, value: OutputValue::Digital(on), with_motion: false };
    for (line, action) in [
        (1, Action::Arm(ArmAction::Base(Some(Box::new(Frame::IDENTITY))))),
        (1, Action::Arm(ArmAction::Tool(None))),
        (2, Action::Arm(ArmAction::Tool(Some(Box::new(tool))))),
        (3, Action::Arm(ArmAction::Load(1.5, Vec3::new(0.0, 0.0, 75.0)))),
        (6, Action::Output(spindle(true))),
        (7, Action::Dwell(2.0)),
        (12, Action::Output(spindle(false))),
        (14, Action::End),
    ] {
        assert!(events.contains(&Event { line, action: action.clone() }), "{line} {action:?}");
    }
}

#[test]
fn the_program_of_robodk_is_read_with_its_variables_and_its_wait() {
    let Some(folder) = judge::data("robots") else { return };
    let text = std::fs::read_to_string(folder.join("programs/robodk-Prog1.script")).unwrap();
    let events = run_with(&settings(), &text).unwrap();
    let moves = moves(&events);
    // The functions before the program are not called; a movej whose corner is passed has no bound in mm.
    assert_eq!(moves.len(), 5);
    let unbounded = [false, true, false, true, false];
    for ((_, motion), unbounded) in moves.iter().zip(unbounded) {
        assert_eq!(motion.corner == Corner::Unbounded, unbounded, "{motion:?}");
    }
    assert_eq!(moves[2].1.corner, blend(1.0));
    assert_eq!(feeds(&events), [Feed::PerMinute(18_000.0)]);
    let waits = events.iter().any(|event| match &event.action {
        Action::Input(input) => input.number == 5 && input.until == Until::High,
        _ => false,
    });
    assert!(waits);
    assert!(events.iter().any(|event| event.action == Action::Message("Display message".into())));
    assert!(events.iter().any(|event| event.action == Action::Stop));
    let ArmPath::Line(end) = moves[2].1.path else { panic!() };
    assert!(end.translation.distance(Vec3::new(663.8, 60.394, 1007.847)) < 1e-9);
}

#[test]
fn orientations_are_vectors_along_the_axis_of_rotation() {
    // 90° about Y takes Z to X; a third of a turn about (1, 1, 1) takes X to Y.
    let of = |pose: &str| {
        let events = body(&format!("movel({pose},v=0.1)")).unwrap();
        let ArmPath::Line(end) = moves(&events)[0].1.path else { panic!() };
        end
    };
    let end = of("p[0.1,0.2,0.3,0,1.5707963267948966,0]");
    assert!((end.matrix3 * Vec3::Z).distance(Vec3::X) < 1e-12);
    assert_eq!(end.translation, Vec3::new(100.0, 200.0, 300.0));
    let third = "1.2091995761561452";
    let end = of(&format!("p[0,0,0,{third},{third},{third}]"));
    assert!((end.matrix3 * Vec3::X).distance(Vec3::Y) < 1e-12);
    // The part is turned by 90° about Z: its X is the robot's Y.
    let end = of("pose_trans(p[1,0,0,0,0,d2r(90)],p[0.1,0,0,0,0,0])");
    assert!(end.translation.distance(Vec3::new(1000.0, 100.0, 0.0)) < 1e-9);
    let end = of("pose_trans(pose_inv(p[0.5,0,0,0,0,0]),p[0.1,0,0,0,0,0])");
    assert!(end.translation.distance(Vec3::new(-400.0, 0.0, 0.0)) < 1e-9);
}

#[test]
fn a_variable_is_found_in_its_function_before_it_is_global() {
    let program = "def other(x):
  z = x + 1
  speed = 0.3
  movel(p[0,0,z,0,0,0],v=speed)
end
def job():
  global speed = 0.1
  y = 5
  other(1)
  movel(p[0,0,y,0,0,0],v=speed)
end
job()
";
    let events = run_with(&settings(), program).unwrap();
    let moves = moves(&events);
    assert_eq!(moves.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [4, 10]);
    let heights = moves.iter().map(|(_, motion)| match motion.path {
        ArmPath::Line(end) => end.translation.z,
        _ => 0.0,
    });
    assert_eq!(heights.collect::<Vec<_>>(), [2000.0, 5000.0]);
    // `speed` is global, so the function that is called sets it for all.
    assert_eq!(feeds(&events), [Feed::PerMinute(18_000.0)]);
    let hidden = program.replace("  speed = 0.3", "  local speed = 0.3");
    let events = run_with(&settings(), &hidden).unwrap();
    assert_eq!(feeds(&events), [18_000.0, 6000.0].map(Feed::PerMinute));
    // What a function sets of the first level, the controller sets for all; which level that is, differs.
    for (from, to) in [
        ("  z = x", "  y = x"),
        ("  y = 5", "  y = 5\n  global y = 6"),
        ("  y = 5", "  local speed = 5"),
    ] {
        let found = run_with(&settings(), &program.replace(from, to)).unwrap_err();
        assert!(found.contains("stands in two scopes"), "{to}: {found}");
    }
}

#[test]
fn the_program_is_the_one_function_of_the_file_or_the_one_that_is_called() {
    let two = "def a():\nsleep(1)\nend\ndef b():\nsleep(2)\nend\n";
    assert!(run_with(&settings(), two).unwrap_err().contains("more than one function"));
    let events = run_with(&settings(), &format!("{two}b()\n")).unwrap();
    assert!(events.iter().any(|event| event.action == Action::Dwell(2.0)));
    assert!(!events.iter().any(|event| event.action == Action::Dwell(1.0)));
    assert!(run_with(&settings(), &format!("{two}b()\na()\n")).unwrap_err().contains("no more"));
    assert!(run_with(&settings(), "# nothing\n").unwrap_err().contains("no program"));
    assert!(run_with(&settings(), "def a():\nsleep(1)\n").unwrap_err().contains("no end"));
    assert!(run_with(&settings(), "def a():\nend\nend\n").unwrap_err().contains("closes nothing"));
    assert!(run_with(&settings(), "def a(x):\nend\n").unwrap_err().contains("has parameters"));
    let again = "def a():\na()\nend\n";
    assert!(run_with(&settings(), again).unwrap_err().contains("nest deeper than 20"));
}

#[test]
fn an_arc_turns_the_tool_evenly_or_with_its_tangent() {
    let turning = |mode: &str| {
        let lines = format!("movec(p[0,0,0,0,0,0],p[1,0,0,0,0,0],a=1,v=0.1,r=0{mode})");
        moves(&body(&lines).unwrap())[0].1.turning
    };
    assert_eq!(turning(""), Some(Turning::Even));
    assert_eq!(turning(",mode=0"), Some(Turning::Even));
    assert_eq!(turning(",mode=1"), Some(Turning::AlongPath));
    refused("movec(p[0,0,0,0,0,0],p[1,0,0,0,0,0],mode=2)", 2, "0 or 1, not 2");
}

#[test]
fn speeds_are_those_of_the_command_and_the_tool_turns_by_4_radians_a_metre() {
    let events = body("movel(p[0,0,0,0,0,0])\nmovel(p[1,0,0,0,0,0],1.2,0.5)").unwrap();
    let of_joints = body("movej([0,0,0,0,0,0],a=1,v=0.5)").unwrap();
    let rate = of_joints.iter().find_map(|event| match event.action {
        Action::Arm(ArmAction::JointRate(rate)) => Some(rate),
        _ => None,
    });
    // 0.5 rad/s are 28.65 degrees/s.
    assert!((rate.unwrap() - 28.647_889_8).abs() < 1e-6);
    // Without v a line goes at 0.25 m/s.
    assert_eq!(feeds(&events), [15_000.0, 30_000.0].map(Feed::PerMinute));
    let turns: Vec<f64> = events
        .iter()
        .filter_map(|event| match event.action {
            Action::Arm(ArmAction::TurnSpeed([Some(swing), Some(_)])) => Some(swing),
            _ => None,
        })
        .collect();
    assert!((turns[0] - 57.295_779_5).abs() < 1e-6 && (turns[1] - 114.591_559).abs() < 1e-5);
}

#[test]
fn a_tool_is_changed_by_the_function_of_the_operator_behind_which_the_tool_is_not_known() {
    let settings = Settings { tool_change: String::from("change_tool"), ..settings() };
    let events =
        run_with(&settings, "def job():\nset_tcp(p[0,0,0.1,0,0,0])\nchange_tool(2)\nend\n");
    let events = events.unwrap();
    let at = events.iter().position(|event| matches!(event.action, Action::Tool(_))).unwrap();
    let behind: Vec<&Action> = events[at..].iter().map(|event| &event.action).collect();
    assert!(behind.contains(&&Action::Arm(ArmAction::Tool(None))), "{behind:?}");
    let found = run_with(&settings, "def job():\nchange_tool()\nend\n").unwrap_err();
    assert!(found.contains("job.script:2:") && found.contains("one argument"), "{found}");
    // Capitals make a difference.
    let found = run_with(&settings, "def job():\nChange_Tool(2)\nend\n").unwrap_err();
    assert!(found.contains("Change_Tool is neither"), "{found}");
}

#[test]
fn inputs_are_waited_for_in_each_of_their_forms() {
    for (condition, until) in [
        ("(get_standard_digital_in(3) != True)", Until::High),
        ("(get_standard_digital_in(3) == False)", Until::High),
        ("not get_standard_digital_in(3)", Until::High),
        ("(not get_standard_digital_in(3))", Until::High),
        ("get_standard_digital_in(3)", Until::Low),
        ("get_standard_digital_in(3) == True", Until::Low),
        ("(get_standard_digital_in(3) != False)", Until::Low),
    ] {
        let events = body(&format!("while {condition}:\n  sync()\nend")).unwrap();
        let waits = events.iter().any(|event| match &event.action {
            Action::Input(input) => input.number == 3 && input.until == until,
            _ => false,
        });
        assert!(waits, "{condition}");
    }
    let does_more = "while not get_standard_digital_in(3):\n  movel(p[0,0,0,0,0,0])\nend";
    refused(does_more, 3, "does more than wait");
}

#[test]
fn each_word_of_the_vocabulary_is_understood() {
    for word in toolpost_control::vocabulary(Dialect::UrScript) {
        assert!(body(&word).is_ok(), "{word}: {:?}", body(&word));
    }
}

#[test]
fn expressions_go_by_their_ranks() {
    for (expression, metres) in [
        ("1+2*3", 7.0),
        ("(1+2)*3", 9.0),
        ("10-4-3", 3.0),
        ("12/4/3", 1.0),
        ("7.5/1.5", 5.0),
        ("-2*-3", 6.0),
        ("[1,2,3][1]", 2.0),
    ] {
        let lines = match expression.starts_with('[') {
            true => format!("list={}\nz=list[1]", &expression[..7]),
            false => format!("z={expression}"),
        };
        let events = body(&format!("{lines}\nmovel(p[0,0,z,0,0,0])")).unwrap();
        let ArmPath::Line(end) = moves(&events)[0].1.path else { panic!() };
        assert_eq!(end.translation.z, metres * 1000.0, "{expression}");
    }
    refused("z=5/2", 2, "quotient of whole numbers");
    refused("z=1/0", 2, "");
}

#[test]
fn what_is_not_understood_is_refused_with_its_line() {
    for (lines, what) in [
        ("foo", "foo is no word"),
        ("foo()", "neither a command that is understood nor a function"),
        ("Movel(p[0,0,0,0,0,0])", "Movel is neither"),
        ("if True:\nend", "if is not followed"),
        ("movep(p[0,0,0,0,0,0])", "movep is not followed"),
        ("q=get_inverse_kin(p[0,0,0,0,0,0])", "the function get_inverse_kin is not followed"),
        (
            "q=get_actual_joint_positions()",
            "the function get_actual_joint_positions is not followed",
        ),
        ("movel([0,0,0,0,0,0])", "joints as the end of a line"),
        ("movel(p[0,0,0,0,0])", "six numbers"),
        ("movel(p[0,0,0,0,0,0],t=2)", "by its time"),
        ("movel(p[0,0,0,0,0,0],v=0)", "above 0"),
        ("movel(p[0,0,0,0,0,0],a=-1)", "above 0"),
        ("movel(p[0,0,0,0,0,0],r=-0.1)", "not below 0"),
        ("movel(p[0,0,0,0,0,0],x=1)", "has the arguments pose, a, v, t, r"),
        ("movel(p[0,0,0,0,0,0],a=1,a=2)", "stands twice"),
        ("movel(p[0,0,0,0,0,0],a=1,2)", "without a name stands behind"),
        ("movel()", "lacks its argument pose"),
        ("movej([0,0,0,0,0])", "six joints"),
        ("movej([0,0,0,0,0,1e9])", "beyond any arm"),
        ("movel(p[1e9,0,0,0,0,0])", "beyond any arm"),
        ("set_tcp([0,0,0,0,0,0])", "the tool is a pose"),
        ("set_payload(1.5)", "lacks its argument cog"),
        ("set_payload(0,[0,0,0])", "above 0"),
        ("set_payload(1,[0,0])", "three numbers"),
        ("set_standard_digital_out(8,True)", "the outputs are 0 to 7"),
        ("set_standard_digital_out(0.5,True)", "the outputs are 0 to 7"),
        ("set_standard_digital_out(0,1)", "True or False"),
        ("set_standard_digital_out(0)", "lacks its argument b"),
        ("set_standard_analog_out(0,1.5)", "0 to 1"),
        ("set_standard_analog_out(2,0.5)", "the outputs are 0 to 1"),
        ("sleep(-1)", "below 0"),
        ("sleep()", "lacks its argument t"),
        ("movel = 3", "is a word of the language"),
        ("x = y", "no line has set y"),
        ("x = 1 +", "a value is needed"),
        ("x = \"text", "has no end"),
        ("x = True + 1", "have no such operator"),
        ("x = 1 2", "`2` is not understood here"),
        ("thread t():\nend", "thread is not followed"),
        ("set_tool_digital_out(0,True)", "set_tool_digital_out is not followed"),
        ("halt", "halt is not followed"),
        ("@", "begins with a word"),
    ] {
        refused(lines, 2, what);
    }
    let found = run_with(&settings(), "def movel():\nend\n").unwrap_err();
    assert!(found.contains("is a word of the language"), "{found}");
}

#[test]
fn every_damage_of_a_job_is_read_or_refused_without_a_panic() {
    for at in 0..JOB.len() {
        for byte in [b'[', b'9', b'\n', b'(', b'"', b'#', 0xff] {
            let mut text = JOB.as_bytes().to_vec();
            text[at] = byte;
            let _ = read(&settings(), "job.script", &text, &mut |_| Ok(()));
        }
    }
}
