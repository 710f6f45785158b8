//! ABB robots: a toolpath posted in RAPID, proven, and what the proof finds of damages to the program.

use crate::files::root;
use crate::robot::{JOB, proof_of, proven, source, written};
use control::Dialect;
use machine::Machine;

fn irb120() -> Machine {
    machine::load("abb-irb120-mill").unwrap()
}

/// The machine of the library with lines of its file changed.
fn irb120_with(changes: &[(&str, &str)]) -> Machine {
    crate::robot::changed("abb-irb120-mill", changes)
}

#[test]
fn the_job_of_the_specification_is_posted_and_proven_on_two_arms() {
    for name in ["abb-irb120-mill", "abb-irb6700-235-mill"] {
        let text = proven(&source(JOB), &machine::load(name).unwrap());
        assert!(text.starts_with("MODULE MOD_JOB\r\n"), "{text}");
        assert!(text.ends_with("SetDO DO10_1,0;\r\nEXIT;\r\nENDPROC\r\nENDMODULE\r\n"), "{text}");
        assert!(text.contains("MoveC [[74.142,5.858,-2.000]"), "{text}");
        assert!(text.contains(",[5.000,500,5000,1000],"), "{text}");
    }
}

/// The joints that the specification has calculated for this place of the part.
#[test]
fn the_joints_above_the_start_are_those_of_the_specification() {
    let machine = irb120_with(&[("part = [350, 0, 150", "part = [450, 0, 150")]);
    let text = proven(&source(JOB), &machine);
    assert!(text.contains("MoveAbsJ [[0.0000,34.62"), "{text}");
    assert!(text.contains(",-4.65") || text.contains(",-4.66"), "{text}");
}

/// A part of the proven job, what it becomes, and the rule by which the proof refuses that.
const DAMAGES: &[(&str, &str, &str)] = &[
    ("wPost:=[FALSE,TRUE,\"\",[[350.000", "wPost:=[FALSE,TRUE,\"\",[[351.000", "frame"),
    ("wPost:=[FALSE,TRUE,\"\",[[350.000", "wPost:=[FALSE,FALSE,\"\",[[350.000", "unsupported"),
    ("wPost:=[FALSE,TRUE,\"\",[[350.000", "wPost:=[TRUE,TRUE,\"\",[[350.000", "frame"),
    ("tPost:=[TRUE,[[0.000,0.000,150.000", "tPost:=[TRUE,[[0.000,0.000,149.000", "frame"),
    ("tPost:=[TRUE,[[0.000,0.000,150.000", "tPost:=[FALSE,[[0.000,0.000,150.000", "frame"),
    ("[1.500,[0.00,0.00,60.00]", "[1.600,[0.00,0.00,60.00]", "payload"),
    ("[1.500,[0.00,0.00,60.00]", "[1.500,[0.00,0.00,80.00]", "payload"),
    ("[1.500,[0.00,0.00,60.00]", "[0.000,[0.00,0.00,60.00]", "payload"),
    ("SingArea\\Off", "SingArea\\Wrist", "orientation-way"),
    ("SingArea\\Off;\r\n", "", "orientation-way"),
    ("CirPathMode\\ObjectFrame", "CirPathMode\\PathFrame", "orientation-way"),
    ("CirPathMode\\ObjectFrame;\r\n", "", "orientation-way"),
    ("MoveL [[60.000", "MoveL [[61.000", "path"),
    ("MoveL [[60.000,0.000", "MoveL [[60.000,0.010", "path"),
    ("MoveL [[0.000,0.000,-2.000", "MoveL [[0.000,0.000,-2.002", "end-point"),
    ("MoveC [[74.142", "MoveC [[74.242", "arc"),
    ("MoveC [[74.142,5.858", "MoveC [[45.858,5.858", "arc"),
    ("[5.000,500,5000,1000]", "[50.000,500,5000,1000]", "feed"),
    ("[100.000,50.000,5000,1000],fine", "v7000,fine", "rapid-feed"),
    ("[100.000,50.000,5000,1000],fine", "[100.000,60.000,5000,1000],fine", "rapid-feed"),
    ("PROC main()", "LOCAL PERS num spon:=1;\nPROC main()\nWaitTime spon;\nspon:=0;", "variable"),
    ("[20.000,500,5000,1000]", "[20.010,500,5000,1000]", "feed"),
    ("SetDO DO10_1,1", "SetDO DO10_1,0", "dwell"),
    ("SetDO DO10_1,1", "SetDO DO10_3,1", "output"),
    ("SetDO DO10_1,1", "SetDO DO11_1,1", "operator-data"),
    ("SetAO AO10_1,0.50000", "SetAO AO10_1,0.60000", "spindle"),
    ("SetAO AO10_1,0.50000", "SetAO AO10_2,0.50000", "output"),
    ("WaitTime 3.00", "WaitTime 1.00", "dwell"),
    ("WaitTime 3.00;\r\n", "", "spindle-dwell"),
    ("SetDO DO10_1,0;\r\nEXIT", "EXIT", "left-on"),
    ("[FALSE,0.100,0.100,0.100", "[FALSE,0.500,0.100,0.100", "path-tolerance"),
    ("[FALSE,0.100,0.100,0.100", "[FALSE,0.100,0.500,0.100", "path-tolerance"),
    ("fine,tPost", "z1,tPost", "path-tolerance"),
    ("fine,tPost\\WObj:=wPost", "fine,tool0\\WObj:=wPost", "payload"),
    ("[9E9,9E9,9E9,9E9,9E9,9E9]],[", "[0,9E9,9E9,9E9,9E9,9E9]],[", "rail"),
    (
        "MoveAbsJ [[0.0000,0.0000,0.0000,0.0000,60.0000",
        "MoveAbsJ [[0.0000,0.0000,5.0000,0.0000,60.0000",
        "home",
    ),
    ("EXIT;\r\n", "SetDO DO10_2,1;\r\nEXIT;\r\n", "left-on"),
    ("EXIT;\r\n", "", "no-end"),
];

#[test]
fn each_damage_is_refused() {
    let (source, machine) = (source(JOB), irb120());
    let text = proven(&source, &machine);
    let mut wrong = Vec::new();
    for (from, to, rule) in DAMAGES {
        assert!(text.contains(from), "{from}: {text}");
        let damaged = text.replacen(from, to, 1);
        let report = proof_of(&source, &machine, &damaged);
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        if found != [*rule] {
            wrong.push(format!("{from} to {to}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn single_signs_of_the_sample_changed_at_random_are_refused_or_harmless() {
    let sample = std::fs::read_to_string(root().join("machines/samples/robot.cls")).unwrap();
    let refused = crate::robot::damaged_by_dice(&sample, (&irb120(), Dialect::Rapid), "ConfJ", 23);
    assert!(refused > 100, "{refused}");
}

#[test]
fn an_arm_whose_joint_3_may_be_coupled_is_posted_only_where_that_is_stated() {
    let arm = |coupling: &str| {
        irb120_with(&[
            ("model = \"abb-irb120\"", &format!("model = \"abb-irb2400\"{coupling}")),
            ("part = [350, 0, 150", "part = [900, 0, 500"),
        ])
    };
    let refused = written(&source(JOB), &arm("")).unwrap_err();
    assert!(refused.contains("joint 3"), "{refused}");
    let plain = proven(&source(JOB), &arm("\ncoupling = \"none\""));
    let coupled = proven(&source(JOB), &arm("\ncoupling = \"plus-joint-2\""));
    assert_ne!(plain, coupled);
}

#[test]
fn the_mass_on_the_flange_is_asked_for() {
    let machine = irb120_with(&[("load_mass = 1.5\nload_center = [0, 0, 60]\n", "")]);
    let refused = written(&source(JOB), &machine).unwrap_err();
    assert!(refused.contains("load"), "{refused}");
}

/// The zone of the orientation stays that of `z200`, 300 mm, whatever `\\Z` says of the tip.
#[test]
fn a_zone_whose_orientation_is_passed_in_a_wider_one_is_refused() {
    let (source, machine) = (source(JOB), machine::load("abb-irb120-mill").unwrap());
    let text = proven(&source, &machine);
    let from = text.find("[FALSE,0").unwrap();
    let to = from + text[from..].find(']').unwrap() + 1;
    let damaged = format!("{}z200\\Z:=0.1{}", &text[..from], &text[to..]);
    let report = proof_of(&source, &machine, &damaged);
    let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
    assert_eq!(found, ["path-tolerance"], "{damaged}");
}

/// The control rounds 101.103 to 101.10299682: the end is then 0.000870 mm from that of the source, where the words alone leave 0.000866.
#[test]
fn an_end_half_a_step_off_on_each_axis_is_rounded_to_single_precision_besides() {
    let text = "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/101.1035,57.1335,65\nFEDRAT/MMPM,300\n\
                GOTO/101.1035,57.1335,-33.9865\nRAPID\nGOTO/101.1035,57.1335,65\nSPINDL/OFF\nFINI\n";
    let text = proven(&source(text), &irb120());
    assert!(text.contains("MoveL [[101.103,57.133,-33.986]"), "{text}");
}
