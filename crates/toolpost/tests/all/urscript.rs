//! Universal Robots: a toolpath posted, proven, and what the proof finds of damages to the program.

use crate::files::root;
use crate::robot::{JOB, proof_of, proven, refused, source};
use control::{ArmPath, Dialect};
use geom::{Frame, Vec3};
use machine::Machine;
use std::f64::consts::FRAC_PI_2;

fn ur5e() -> Machine {
    machine::load("universal-ur5e").unwrap()
}

/// The machine of the library with lines of its file changed.
fn ur5e_with(changes: &[(&str, &str)]) -> Machine {
    crate::robot::changed("universal-ur5e", changes)
}

/// The rows of a calibration.yaml, which are those of the arm as drawn (`config/ur5e/default_kinematics.yaml` of the maker's ROS package).
const CALIBRATION: &str = "[[0, 0, 162.5, 0, 0, 0], [0, 0, 0, 90, 0, 0], [-425, 0, 0, 0, 0, 0], \
[-392.2, 0, 133.3, 0, 0, 0], [0, -99.7, 0, 90, 0, 0], [0, 99.6, 0, 90, 180, 180]]";

/// An arm whose calibration is stated: its joints are exact.
fn measured() -> Machine {
    let model = format!("model = \"ur5e\"\ncalibration = {CALIBRATION}");
    ur5e_with(&[("model = \"ur5e\"", &model)])
}

#[test]
fn the_job_of_the_specification_is_posted_with_its_joints_and_proven() {
    let measured = crate::robot::paths(Dialect::UrScript, &proven(&source(JOB), &measured()));
    // The joints that the specification has calculated for the tool at (0, 0, 50), radians; how it is turned about its axis is free.
    let ArmPath::Joints(start) = measured[1] else { panic!("{measured:?}") };
    for (at, expected) in start.iter().zip([2.84086, -1.65957, 2.0143, -1.92553, -FRAC_PI_2]) {
        assert!((at.to_radians() - expected).abs() < 1e-5, "{start:?}");
    }
    let text = proven(&source(JOB), &ur5e());
    let paths = crate::robot::paths(Dialect::UrScript, &text);
    let ends: Vec<Vec3> = paths
        .iter()
        .filter_map(|path| match path {
            ArmPath::Line(end) => Some(end.translation),
            _ => None,
        })
        .collect();
    // The part lies at (450, 0, 150). Of an arm that is not measured the joints lead 20 mm higher than the source ever goes, and the first line corrects
    // what they leave.
    let expected = [
        [450.0, 0.0, 220.0],
        [450.0, 0.0, 200.0],
        [450.0, 0.0, 148.0],
        [510.0, 0.0, 148.0],
        [530.0, 20.0, 200.0],
        [530.0, 20.0, 220.0],
    ];
    assert_eq!(ends.len(), expected.len());
    for (end, expected) in ends.iter().zip(expected) {
        assert!(end.distance(Vec3::from(expected)) < 1e-9, "{ends:?}");
    }
    let through = paths.iter().find_map(|path| match path {
        ArmPath::Arc { via, end } => Some((via.translation, end.translation)),
        _ => None,
    });
    let (via, end) = through.unwrap();
    assert!(via.distance(Vec3::new(524.142, 5.858, 148.0)) < 1e-9);
    assert!(end.distance(Vec3::new(530.0, 20.0, 148.0)) < 1e-9);
    // 300, 1200 and 6000 mm/min.
    for speed in ["v=0.005000,", "v=0.020000,", "v=0.100000,"] {
        assert!(text.contains(speed), "{text}");
    }
    assert!(text.ends_with("set_standard_digital_out(0,False)\nend\n"), "{text}");
}

/// The program of the specification itself, run forward: its joints put the tool at the start, and its poses are the stated points.
#[test]
fn the_program_of_the_specification_comes_to_the_stated_points() {
    const PROGRAM: &str = "def job():
  set_tcp(p[0,0,0.15,0,0,0])
  set_payload(1.5,[0,0,0.06])
  part = p[0.45,0,0.15,0,0,0]
  movej([3.141593,-1.570796,1.570796,-1.570796,-1.570796,0],a=1.4,v=0.5)
  movej([2.84086,-1.65957,2.0143,-1.92553,-1.5708,-1.87153],a=1.4,v=0.5)
  movel(pose_trans(part,p[0,0,0.05,3.1415927,0,0]),a=1.2,v=0.1)
  set_standard_analog_out(0,0.5)
  set_standard_digital_out(0,True)
  sleep(3.0)
  movel(pose_trans(part,p[0,0,-0.002,3.1415927,0,0]),a=1.2,v=0.005)
  movel(pose_trans(part,p[0.06,0,-0.002,3.1415927,0,0]),a=1.2,v=0.02,r=0.0001)
  movec(pose_trans(part,p[0.074142,0.005858,-0.002,3.1415927,0,0]),pose_trans(part,p[0.08,0.02,-0.002,3.1415927,0,0]),a=1.2,v=0.02,r=0,mode=0)
  movel(pose_trans(part,p[0.08,0.02,0.05,3.1415927,0,0]),a=1.2,v=0.1)
  set_standard_digital_out(0,False)
  movej([3.141593,-1.570796,1.570796,-1.570796,-1.570796,0],a=1.4,v=0.5)
end
";
    let machine = measured();
    // An arm that is measured has nothing to correct.
    let correcting = "  movel(pose_trans(part,p[0,0,0.05,3.1415927,0,0]),a=1.2,v=0.1)\n";
    let report = proof_of(&source(JOB), &machine, &PROGRAM.replacen(correcting, "", 1));
    assert!(report.proven, "{:#?}", report.mismatches);
    // The joints of an arm that is not measured lead up to 20 mm beside and below where its feed begins.
    let report = proof_of(&source(JOB), &ur5e(), PROGRAM);
    assert_eq!(report.mismatches[0].rule.name(), "rapid-path", "{:?}", report.mismatches);
    let arm = machine.arm.as_ref().unwrap();
    let ArmPath::Joints(start) = crate::robot::paths(Dialect::UrScript, PROGRAM)[1] else {
        panic!()
    };
    let tool = Frame::from_translation(Vec3::new(0.0, 0.0, 150.0));
    let at = arm.flange(&start.map(f64::to_radians)) * tool;
    assert!(at.translation.distance(Vec3::new(450.0, 0.0, 200.0)) < 5e-3, "{at:?}");
}

/// A line of the proven job, what it becomes, and the rule by which the proof refuses that.
const DAMAGES: &[(&str, &str, &str)] = &[
    ("set_tcp(p[0.000000,0.000000,0.150000", "set_tcp(p[0.000000,0.000000,0.149000", "frame"),
    (
        "set_tcp(p[0.000000,0.000000,0.150000,0.0000000",
        "set_tcp(p[0.000000,0.000000,0.150000,0.0100000",
        "frame",
    ),
    ("set_tcp", "#set_tcp", "frame"),
    ("set_payload(1.500", "set_payload(2.500", "payload"),
    ("0.0600])", "0.1600])", "payload"),
    ("set_payload", "#set_payload", "payload"),
    ("part=p[0.450000", "part=p[0.451000", "unknown-position"),
    (
        "part=p[0.450000,0.000000,0.150000,0.0000000",
        "part=p[0.450000,0.000000,0.150000,0.0100000",
        "unknown-position",
    ),
    ("movej([2.840858", "movej([2.850858", "end-point"),
    (
        "movej([2.840858,-1.676145,1.975186,-1.869838,-1.570796",
        "movej([2.840858,-1.676145,1.975186,-1.869838,-1.560796",
        "end-point",
    ),
    (
        "movel(pose_trans(part,p[0.000000,0.000000,0.070000",
        "#movel(pose_trans(part,p[0.000000,0.000000,0.070000",
        "unknown-position",
    ),
    ("p[0.000000,0.000000,0.070000", "p[0.000000,0.000000,0.060000", "unknown-position"),
    ("p[0.000000,0.000000,0.050000", "p[0.000000,0.000000,0.040000", "extra-motion"),
    ("p[0.060000", "p[0.061000", "path"),
    ("p[0.060000", "p[60.00000", "path"),
    ("p[0.000000,0.000000,-0.002000", "p[0.000000,0.000000,-0.002010", "path"),
    ("p[0.060000,0.000000,-0.002000", "p[0.060000,0.000010,-0.002000", "path"),
    ("p[0.060000,0.000000,-0.002000", "p[0.060000,0.000000,0.002000", "path"),
    ("pose_trans(part,p[0.060000", "pose_trans(pose_inv(part),p[0.060000", "path"),
    (
        "pose_trans(part,p[0.060000,0.000000,-0.002000,2.2214415,-2.2214415,0.0000000])",
        "p[0.060000,0.000000,-0.002000,2.2214415,-2.2214415,0.0000000]",
        "path",
    ),
    (
        "p[0.080000,0.020000,0.050000,2.2214415",
        "p[0.080000,0.020000,0.050000,2.2414415",
        "extra-motion",
    ),
    ("p[0.074142", "p[0.074242", "arc"),
    ("p[0.074142,0.005858", "p[0.045858,0.005858", "arc"),
    ("p[0.074142,0.005858", "p[0.070000,0.010000", "arc-points"),
    ("mode=0", "mode=1", "orientation-way"),
    ("v=0.005000", "v=0.050000", "feed"),
    ("v=0.020000", "v=0.030000", "feed"),
    ("r=0.000100", "r=0.000500", "path-tolerance"),
    ("r=0.000000,mode", "r=0.000100,mode", "path-tolerance"),
    ("r=0.000100)\n", "r=0.000100)\nsleep(0.1)\n", "path-tolerance"),
    ("movel(pose_trans(part,p[0.060000", "movej(pose_trans(part,p[0.060000", "unproven"),
    ("set_standard_digital_out(0,True)", "set_standard_digital_out(0,False)", "dwell"),
    ("set_standard_digital_out(0,True)", "set_standard_digital_out(3,True)", "output"),
    ("set_standard_analog_out(0,0.50000)", "set_standard_analog_out(0,0.60000)", "spindle"),
    ("set_standard_analog_out(0,0.50000)", "set_standard_analog_out(1,0.50000)", "output"),
    ("sleep(3.00)", "sleep(1.00)", "dwell"),
    ("sleep(3.00)\n", "", "spindle-dwell"),
    ("v=0.6283", "v=0.6383", "rapid-feed"),
    ("set_standard_digital_out(0,False)\nend", "end", "left-on"),
    ("\nend", "\nset_standard_digital_out(1,True)\nend", "left-on"),
    ("\nend", "\npopup(\"wait\",blocking=True)\nend", "stop"),
    ("\nend", "\n", "no-end"),
    ("def job_JOB", "def movel", "definition"),
    ("movel", "movep", "unsupported"),
    (
        "v=0.6283)\nset_standard_digital_out(0,False)",
        "v=0.6283)\nmovej([3.1,-1.5,1.5,-1.5,-1.5,0],a=1,v=0.5)\nset_standard_digital_out(0,False)",
        "end-point",
    ),
];

#[test]
fn each_damage_to_the_job_is_refused_by_its_rule() {
    let (source, machine) = (source(JOB), ur5e());
    let text = proven(&source, &machine);
    let mut wrong = Vec::new();
    for (from, to, rule) in DAMAGES {
        let damaged = text.replacen(from, to, 1);
        assert_ne!(damaged, text, "{from}");
        let report = proof_of(&source, &machine, &damaged);
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        if found != [*rule] {
            wrong.push(format!("{from} -> {to}: {:#?}", report.mismatches));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A line left out: the program differs, or does the same.
#[test]
fn each_line_of_the_job_is_needed_or_changes_nothing() {
    let (source, machine) = (source(JOB), ur5e());
    let text = proven(&source, &machine);
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    for left_out in 0..lines.len() {
        if lines[left_out].starts_with('#') {
            continue;
        }
        let kept = lines.iter().enumerate().filter(|(i, _)| *i != left_out);
        let rest: String = kept.map(|(_, line)| *line).collect();
        let report = proof_of(&source, &machine, &rest);
        assert!(!report.proven, "without {}", lines[left_out]);
    }
}

#[test]
fn of_200_single_damages_each_is_refused_or_changes_nothing() {
    let sample = std::fs::read_to_string(root().join("machines/samples/robot.cls")).unwrap();
    for (machine, seed) in [(ur5e(), 5), (measured(), 6)] {
        let refused = crate::robot::damaged_by_dice(
            &sample,
            (&machine, Dialect::UrScript),
            "joint_acc=",
            seed,
        );
        assert!(refused > 120, "{refused}");
    }
}

#[test]
fn what_the_arm_cannot_do_is_refused_with_line_and_margin() {
    let machine = ur5e();
    refused("GOTO/60,0,-2", "GOTO/2000,0,-2", &machine, 10, "mm out of reach");
    // Through the axis on which the arm stands.
    refused("GOTO/60,0,-2", "GOTO/-900,0,-2", &machine, 10, "the arm");
    refused("FEDRAT/MMPM,1200", "FEDRAT/MMPM,13000", &machine, 10, "13000 mm/min");
    refused("RPM,12000,CLW", "RPM,12000,CCLW", &machine, 8, "counter-clockwise");
    let fast = ur5e_with(&[("feed_max = 6000", "feed_max = 200000")]);
    refused("FEDRAT/MMPM,1200", "FEDRAT/MMPM,190000", &fast, 10, "of its speed at this feed");
    let without = ur5e_with(&[("load_mass = 1.5\nload_center = [0, 0, 60]\n", "")]);
    refused("LOADTL/1", "LOADTL/1", &without, 0, "load_mass");
    let without = ur5e_with(&[("tool_length = 50\n", "")]);
    refused("LOADTL/1", "LOADTL/1", &without, 6, "the length of the tool");
}

/// Of an arm that is not measured joints lead nowhere near the part: straight lines do.
#[test]
fn joints_of_an_arm_that_is_not_measured_stay_20_mm_above_the_cuts() {
    // 10 mm over the part both lie: by joints the one comes to the other where they are exact.
    const LOW: &str = "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/MMPM,300\n\
GOTO/0,0,-2\nRAPID\nGOTO/0,0,10\nRAPID\nGOTO/60,30,10\nFEDRAT/MMPM,300\nGOTO/60,30,-2\nRAPID\nGOTO/60,30,30\nFINI\n";
    let [nominal, exact] = [ur5e(), measured()].map(|machine| proven(&source(LOW), &machine));
    let joints = |text: &str| text.matches("movej(").count();
    assert!(joints(&exact) > 0 && joints(&nominal) > 0);
    // Neither is a program for the other: what goes by joints near the part is refused, what is corrected needs no correction.
    let report = proof_of(&source(LOW), &ur5e(), &exact);
    assert!(!report.proven);
    let rules: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
    assert!(rules == ["rapid-path"] || rules == ["unknown-position"], "{:#?}", report.mismatches);
}

#[test]
fn blends_that_would_overlap_are_written_shorter_and_refused_where_they_are_not() {
    // Steps of 0.08 mm with corners that may be left by 0.05 mm, which would be a blend of 0.1 mm.
    let mut text = String::from(
        "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,30\nFEDRAT/MMPM,300\nGOTO/0,0,-2\n",
    );
    for i in 1..=10 {
        text += &format!(
            "GOTO/{:.3},{:.3},-2\n",
            0.08 * f64::from(i),
            if i % 2 == 0 { 0.0 } else { 0.02 }
        );
    }
    text += "RAPID\nGOTO/0.8,0,30\nFINI\n";
    let (source, machine) = (source(&text), ur5e());
    let text = proven(&source, &machine);
    let short = text.lines().find(|line| line.contains("r=0.0000") && !line.contains("r=0.000000"));
    let short = short.unwrap_or_else(|| panic!("{text}"));
    let at = short.find("r=").unwrap();
    let damaged = text.replace(&short[at..at + 10], "r=0.000080");
    let report = proof_of(&source, &machine, &damaged);
    assert_eq!(report.mismatches[0].rule.name(), "path-tolerance", "{:#?}", report.mismatches);
    assert!(report.mismatches[0].message.contains("would skip a point"));
}

#[test]
fn a_tool_change_is_a_call_of_the_operators_function_at_home() {
    let machine = ur5e_with(&[
        ("joint_speed = 20", "joint_speed = 20\ntool_change = \"change_tool\""),
        ("dwell = 3\n", "dwell = 3\n[blocks]\ntool_change = \"change_tool({{T}})\"\n"),
    ]);
    let two = JOB.replace("FINI", "LOADTL/2,LENGTH,60\nSPINDL/RPM,6000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,50\nFINI");
    let text = proven(&source(&two), &machine);
    assert!(text.contains("change_tool(1)") && text.contains("change_tool(2)"), "{text}");
    // The second tool is 10 mm longer; tool and load are stated anew behind the function.
    assert!(text.contains("set_tcp(p[0.000000,0.000000,0.160000"), "{text}");
    let last = text.rfind("set_payload").unwrap();
    let without = format!("{}#{}", &text[..last], &text[last..]);
    assert_eq!(proof_of(&source(&two), &machine, &without).mismatches[0].rule.name(), "payload");
    let swapped = text.replace("change_tool(2)", "change_tool(3)");
    assert!(!proof_of(&source(&two), &machine, &swapped).proven);
}

/// Other files of cutter-location data: each is proven, or refused before anything is written.
#[test]
fn no_file_of_cutter_location_data_fails_its_own_proof_on_the_robots() {
    let mut made = 0;
    for file in crate::files::sources() {
        let text = std::fs::read(&file).unwrap();
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let Ok(read) = source::apt::read(&name, &text, &Default::default()) else { continue };
        for robot in ["universal-ur5e", "universal-ur10e"] {
            let machine = machine::load(robot).unwrap();
            match post::write(&read.program, &machine) {
                Err(found) => eprintln!("{robot} {name}: refused, {}", found[0]),
                Ok(output) => {
                    let text = String::from_utf8(output.text).unwrap();
                    let report = proof_of(&read.program, &machine, &text);
                    assert!(report.proven, "{name}: {:#?}", report.mismatches);
                    eprintln!("{robot} {name}: proven, {} blocks", output.blocks);
                    made += 1;
                }
            }
        }
    }
    assert!(made > 0);
}

/// The options of the control file state 1.2 m/s2 and 1.4 rad/s2.
#[test]
fn an_arm_that_accelerates_faster_than_its_options_state_is_refused() {
    let (source, machine) = (source(JOB), ur5e());
    let text = proven(&source, &machine);
    for (from, to, is_proven) in [
        ("\nacc=1.2", "\nacc=1000", false),
        ("\njoint_acc=1.4", "\njoint_acc=14", false),
        ("\nacc=1.2", "\nacc=0.6", true),
    ] {
        let report = proof_of(&source, &machine, &text.replacen(from, to, 1));
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        assert_eq!(report.proven, is_proven, "{to}: {found:?}");
        assert!(is_proven || found == ["acceleration"], "{to}: {found:?}");
    }
}

/// By hand: 20 degrees are 0.3491 rad; at 2000 mm/min the controller turns by 4 * 0.0333 rad/s: 2.618 s for each of three lines, and not 0.03 s.
#[test]
fn cuts_in_which_the_tool_turns_more_than_the_controller_does_at_the_feed_are_counted_with_their_time()
 {
    let lean = |x: u32, lean: bool| match lean {
        true => format!("GOTO/{x},0,0,0.3420201,0,0.9396926\n"),
        false => format!("GOTO/{x},0,0,0,0,1\n"),
    };
    let text = format!(
        "PARTNO/L\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/0,0,40,0,0,1\nFEDRAT/MMPM,300\nGOTO/0,0,0,0,0,1\n\
         FEDRAT/MMPM,2000\n{}{}{}RAPID\nGOTO/23.5212,0,56.3816,0.3420201,0,0.9396926\nFINI\n",
        lean(1, true),
        lean(2, false),
        lean(3, true)
    );
    let (source, machine) = (source(&text), ur5e());
    let report = proof_of(&source, &machine, &proven(&source, &machine));
    let slowed = report.arm.unwrap().slowed_s;
    assert_eq!(report.compared.slowed, 3);
    assert!((slowed - 3.0 * (2.618 - 0.03)).abs() < 0.01, "{slowed}");
    // Where the tool stays as it is it is not slower.
    let (job, report) = (crate::robot::source(JOB), ur5e());
    let report = proof_of(&job, &report, &proven(&job, &report));
    assert_eq!((report.compared.slowed, report.arm.unwrap().slowed_s), (0, 0.0));
}
