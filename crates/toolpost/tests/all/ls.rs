//! FANUC robots: a toolpath posted, proven, and what the proof finds of damages to the program.

use crate::files::root;
use crate::robot::{JOB, LINE, proof_of, proven, refused, source};
use control::{ArmPath, Dialect};
use machine::Machine;

fn lrmate() -> Machine {
    machine::load("fanuc-lrmate-200id-mill").unwrap()
}

/// The machine of the library with lines of its file changed.
fn lrmate_with(changes: &[(&str, &str)]) -> Machine {
    crate::robot::changed("fanuc-lrmate-200id-mill", changes)
}

#[test]
fn the_job_of_the_specification_is_posted_with_its_joints_and_proven() {
    let text = proven(&source(JOB), &lrmate());
    let paths = crate::robot::paths(Dialect::Ls, &text);
    // The joints that the specification has calculated, as the pendant shows them: J3 counts against the horizontal.
    let ArmPath::Joints(start) = paths[1] else { panic!("{text}") };
    for (at, expected) in start.iter().zip([0.0, 23.408, -42.993, 0.0, -47.007]) {
        assert!((at - expected).abs() < 1e-3, "{start:?}");
    }
    // 300, 1200 and 6000 mm/min in cm/min.
    for line in ["L P[3] 30cm/min FINE ;", "L P[4] 120cm/min FINE ;", "L P[7] 600cm/min FINE ;"] {
        assert!(text.contains(line), "{text}");
    }
    assert!(text.contains("24:C P[5]\r\n: P[6] 120cm/min FINE ;\r\n"), "{text}");
    // The head counts the numbered lines.
    assert!(
        text.contains("LINE_COUNT = 27;\r\n") && text.contains("\r\n27:DO[1]=OFF ;\r\n/POS\r\n")
    );
    assert!(text.starts_with("/PROG JOB\r\n") && text.ends_with("};\r\n/END\r\n"));
}

/// A line of the proven job, what it becomes, and the rule by which the proof refuses that.
const DAMAGES: &[(&str, &str, &str)] = &[
    ("PR[9,1]=450.000", "PR[9,1]=451.000", "frame"),
    ("PR[9,6]=0.0000", "PR[9,6]=1.0000", "frame"),
    ("PR[9,3]=150.000", "PR[9,3]=149.000", "frame"),
    ("7:UFRAME[9]=PR[9] ;\r\n", "", "frame"),
    ("14:UTOOL[9]=PR[9] ;\r\n", "", "frame"),
    ("PR[9,1]=450.000", "PR[8,1]=450.000", "operator-data"),
    ("UFRAME[9]=PR[9]", "UFRAME[8]=PR[9]", "operator-data"),
    ("UFRAME_NUM=9", "UFRAME_NUM=8", "frame"),
    ("UTOOL_NUM=9", "UTOOL_NUM=0", "frame"),
    ("15:UFRAME_NUM=9 ;\r\n", "", "frame"),
    ("UF : 9, UT : 9, CONFIG", "UF : 1, UT : 9, CONFIG", "frame"),
    ("J2= 23.4083", "J2= 22.4083", "end-point"),
    ("J3= -42.9932", "J3= -19.5849", "end-point"),
    ("17:J P[1] 20% FINE ;\r\n", "", "home"),
    ("18:J P[2] 20% FINE ;\r\n", "", "extra-motion"),
    ("J P[2] 20% FINE", "J P[2] 20% CNT50", "path-tolerance"),
    ("J P[2] 20% FINE", "J P[2] 21% FINE", "rapid-feed"),
    ("X = 60.000", "X = 61.000", "path"),
    ("Y = 0.000 mm, Z = -2.000", "Y = 0.000 mm, Z = -2.010", "path"),
    ("X = 60.000 mm, Y = 0.000", "X = 60.000 mm, Y = 0.010", "path"),
    ("X = 74.142", "X = 74.242", "arc"),
    ("X = 74.142", "X = 45.858", "arc"),
    ("Z = 50.000 mm,\r\nW = 180.0000", "Z = 50.000 mm,\r\nW = 179.0000", "extra-motion"),
    ("'N U T, 0, 0, 0'", "'F U T, 0, 0, 0'", "posture"),
    ("'N U T, 0, 0, 0'", "'N D T, 0, 0, 0'", "posture"),
    ("'N U T, 0, 0, 0'", "'N U B, 0, 0, 0'", "posture"),
    ("'N U T, 0, 0, 0'", "'N U T, 1, 0, 0'", "posture"),
    ("'N U T, 0, 0, 0'", "'N U T, 0, -1, 0'", "posture"),
    ("'N U T, 0, 0, 0'", "'N U T, 0, 0, 1'", "posture"),
    ("L P[4] 120cm/min FINE", "L P[4] 120cm/min CNT10", "path-tolerance"),
    ("L P[4] 120cm/min FINE", "L P[4] 120cm/min CR3", "path-tolerance"),
    ("L P[4] 120cm/min FINE", "L P[4] 120cm/min FINE Wjnt", "orientation-way"),
    ("L P[4] 120cm/min", "L P[4] 120mm/sec", "feed"),
    ("L P[3] 30cm/min", "L P[3] 300cm/min", "feed"),
    ("L P[4] 120cm/min", "L P[6] 120cm/min", "path"),
    ("23:L P[4] 120cm/min", "23:J P[4] 20%", "unproven"),
    ("C P[5]\r\n: P[6]", "C P[6]\r\n: P[5]", "arc"),
    ("23:L P[4]", "23:J P[4]", "unsupported"),
    ("DO[1]=ON", "DO[1]=OFF", "dwell"),
    ("DO[1]=ON", "DO[3]=ON", "output"),
    ("AO[1]=500", "AO[1]=600", "spindle"),
    ("AO[1]=500", "AO[2]=500", "output"),
    ("WAIT 3.00", "WAIT 1.00", "dwell"),
    ("21:WAIT 3.00(sec) ;\r\n", "", "spindle-dwell"),
    ("27:DO[1]=OFF ;\r\n", "", "left-on"),
    ("27:DO[1]=OFF ;\r\n", "27:DO[1]=OFF ;\r\n28:DO[2]=ON ;\r\n", "left-on"),
    ("27:DO[1]=OFF ;\r\n", "27:DO[1]=OFF ;\r\n28:PAUSE ;\r\n", "stop"),
    ("26:J P[8] 20% FINE ;\r\n", "", "home"),
    ("/END", "", "program-frame"),
    ("P[2]{", "P[1]{", "twice"),
];

#[test]
fn each_damage_to_the_job_is_refused_by_its_rule() {
    let (source, machine) = (source(JOB), lrmate());
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

/// An instruction left out: the program differs.
#[test]
fn each_instruction_of_the_job_is_needed() {
    let (source, machine) = (source(JOB), lrmate());
    let text = proven(&source, &machine);
    let (begin, end) = (text.find("/MN").unwrap(), text.find("/POS").unwrap());
    let lines: Vec<&str> = text[begin..end].split_inclusive("\r\n").skip(1).collect();
    let instruction = |i: usize| lines[i].split_once(':').unwrap_or_default().1;
    for left_out in 0..lines.len() {
        // What a register has from before, it keeps.
        if (0..left_out).any(|before| instruction(before) == instruction(left_out)) {
            continue;
        }
        let kept = lines.iter().enumerate().filter(|(i, _)| *i != left_out);
        let rest: String = kept.map(|(_, line)| *line).collect();
        let whole = format!("{}/MN\r\n{rest}{}", &text[..begin], &text[end..]);
        let report = proof_of(&source, &machine, &whole);
        assert!(!report.proven, "without {}", lines[left_out]);
    }
}

#[test]
fn of_200_single_damages_each_is_refused_or_changes_nothing() {
    let sample = std::fs::read_to_string(root().join("machines/samples/robot.cls")).unwrap();
    // Of other seeds some move or lean the point at which the half circle is divided, along the circle or by less than a degree, which the proof takes and `alike` does not.
    let refused = crate::robot::damaged_by_dice(&sample, (&lrmate(), Dialect::Ls), "/MN", 10);
    assert!(refused > 120, "{refused}");
}

#[test]
fn what_the_arm_cannot_do_is_refused_with_line_and_margin() {
    let machine = lrmate();
    refused("GOTO/60,0,-2", "GOTO/2000,0,-2", &machine, 10, "the elbow would be");
    refused("GOTO/60,0,-2", "GOTO/-800,0,-2", &machine, 10, "the arm");
    // Tenths of inch/min: 4 mm/min would be 0.2 of them, 5.08 mm/min, and 12 mm/min 0.5.
    refused("FEDRAT/MMPM,1200", "FEDRAT/MMPM,4", &machine, 10, "no more digits");
    refused("FEDRAT/MMPM,1200", "FEDRAT/MMPM,12", &machine, 10, "12.700 mm/min");
    refused("RPM,12000,CLW", "RPM,12000,CCLW", &machine, 8, "counter-clockwise");
    let without = lrmate_with(&[("own_frame = 9\n", "")]);
    refused("LOADTL/1", "LOADTL/1", &without, 0, "own_frame");
    // Home at half a turn of joint 6: the tool comes there with it, and the turns hang on rounding.
    let mut many = String::from(LINE.split("RAPID\nGOTO/60,0,50").next().unwrap());
    for i in 0..10_000 {
        many += &format!("GOTO/{}.5,0,-2\n", i % 50);
    }
    let found =
        post::write(&source(&(many + "RAPID\nGOTO/49.5,0,50\nFINI\n")), &machine).unwrap_err();
    assert!(found[0].message.contains("the control takes 9999"), "{}", found[0]);
}

/// Letters and turns of a position are those of its joints; at the edge of a turn rounding would decide.
#[test]
fn a_position_at_the_edge_of_a_turn_is_refused() {
    // With the spindle turned on the flange by a half turn joint 6 comes to 180 degrees where it had 0.
    let machine = lrmate_with(&[("home = [0, 0, 0, 0, -90, 0]", "home = [0, 0, 0, 0, -90, 180]")]);
    match post::write(&source(LINE), &machine) {
        Ok(output) => {
            let text = String::from_utf8(output.text).unwrap();
            assert!(proof_of(&source(LINE), &machine, &text).proven, "{text}");
        }
        Err(found) => assert_eq!(found[0].rule.name(), "posture", "{}", found[0]),
    }
    // What the proof does with one: the joints of the job's first line are moved to the edge.
    let (source, machine) = (source(JOB), lrmate());
    let text = proven(&source, &machine).replace("'N U T, 0, 0, 0'", "'N U T, 0, 0, -1'");
    assert_eq!(proof_of(&source, &machine, &text).mismatches[0].rule.name(), "posture");
}

#[test]
fn corners_are_passed_by_whole_millimetres_alone() {
    let machine = lrmate_with(&[("[spindle]", "[options]\npath_tolerance = 0.9\n\n[spindle]")]);
    let text = proven(&source(JOB), &machine);
    // 1.8 mm would be CR2, which may leave the corner by 1 mm: it is written as 1.
    assert!(text.contains("L P[4] 120cm/min CR1 ;"), "{text}");
    let wider = text.replacen("CR1 ;", "CR2 ;", 1);
    let report = proof_of(&source(JOB), &machine, &wider);
    assert_eq!(report.mismatches[0].rule.name(), "path-tolerance");
}

/// `docs/controls/ls.md`: whole mm/sec and cm/min, tenths of inch/min. 85.547 mm/min are 3.37 of these and 8.6 cm/min.
#[test]
fn a_feed_between_two_whole_centimetres_is_written_in_tenths_of_an_inch() {
    let feed =
        |feed: &str| proven(&source(&LINE.replace("MMPM,300", &format!("MMPM,{feed}"))), &lrmate());
    assert!(feed("85.547").contains("L P[3] 3.4inch/min FINE ;"));
    // What cm/min say within half a percent stays as it is.
    assert!(feed("300").contains("L P[3] 30cm/min FINE ;"));
    assert!(feed("301.4").contains("L P[3] 30cm/min FINE ;"));
    let text = feed("85.547");
    for (wrong, rule) in [
        ("3.5inch/min", "feed"),
        ("9cm/min", "feed"),
        ("8.6cm/min", "number"),
        ("3.37inch/min", "number"),
    ] {
        let source = source(&LINE.replace("MMPM,300", "MMPM,85.547"));
        let report = proof_of(&source, &lrmate(), &text.replace("3.4inch/min", wrong));
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        assert_eq!(found, [rule], "{wrong}");
    }
}

#[test]
fn the_load_of_the_cell_is_chosen_by_its_number() {
    let machine = lrmate_with(&[("joint_speed = 20", "joint_speed = 20\nload_number = 3")]);
    let text = proven(&source(JOB), &machine);
    assert!(text.contains("16:UTOOL_NUM=9 ;\r\n17:PAYLOAD[3] ;\r\n18:J P[1]"), "{text}");
    let rules = |text: &str, machine: &Machine| -> Vec<&str> {
        proof_of(&source(JOB), machine, text)
            .mismatches
            .iter()
            .map(|found| found.rule.name())
            .collect()
    };
    assert_eq!(rules(&text.replace("PAYLOAD[3]", "PAYLOAD[2]"), &machine), ["payload"]);
    assert_eq!(rules(&text.replace("17:PAYLOAD[3] ;\r\n", ""), &machine), ["payload"]);
    assert_eq!(rules(&text, &lrmate()), ["payload"]);
    assert_eq!(rules(&text.replace("PAYLOAD[3]", "PAYLOAD[11]"), &machine).len(), 1);
}

#[test]
fn a_tool_change_is_a_call_of_the_operators_program_at_home() {
    let machine = lrmate_with(&[
        ("joint_speed = 20", "joint_speed = 20\ntool_change = \"CHANGE\""),
        ("dwell = 3\n", "dwell = 3\n[blocks]\ntool_change = \"{{N}}:CALL CHANGE({{T}}) ;\"\n"),
    ]);
    let two = JOB.replace("FINI", "LOADTL/2,LENGTH,60\nSPINDL/RPM,6000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,50\nFINI");
    let text = proven(&source(&two), &machine);
    assert!(text.contains("CALL CHANGE(1) ;") && text.contains("CALL CHANGE(2) ;"), "{text}");
    assert!(text.contains("PR[9,3]=160.000 ;"), "{text}");
    let swapped = text.replace("CHANGE(2)", "CHANGE(3)");
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
        for robot in ["fanuc-lrmate-200id-mill", "fanuc-m20ia-mill", "fanuc-r2000ic-mill"] {
            let machine = machine::load(robot).unwrap();
            match post::write(&read.program, &machine) {
                Err(found) => eprintln!("{robot} {name}: refused, {}", found[0]),
                Ok(output) => {
                    let text = String::from_utf8(output.text).unwrap();
                    let report = proof_of(&read.program, &machine, &text);
                    assert!(report.proven, "{robot} {name}: {:#?}", report.mismatches);
                    eprintln!("{robot} {name}: proven, {} blocks", output.blocks);
                    made += 1;
                }
            }
        }
    }
    assert!(made > 0);
}

/// A spindle that leans back: the choice turns the tool so that joint 6 comes to -180 degrees, at which rounding would decide its turns.
#[test]
fn a_tool_is_turned_by_a_hundredth_of_a_degree_where_rounding_would_decide_the_turns_of_a_joint() {
    let text = "extends = \"fanuc-m20ia-mill\"\n[cell]\nspindle = [0, 0, 100, 0, -20, 0]\n";
    let machine = machine::load_text("mine.toml", text).unwrap();
    let written = proven(&source(JOB), &machine);
    // Turned the other way about the tool's axis as far it is another number of turns: the control finds it.
    assert!(written.contains("CONFIG : 'N U T, 0, 0, -1',"), "{written}");
    let damaged = written.replacen("'N U T, 0, 0, -1'", "'N U T, 0, 0, 0'", 1);
    let report = proof_of(&source(JOB), &machine, &damaged);
    assert!(!report.proven);
}

/// No source says whether the tool takes the orientation of the way point of an arc.
#[test]
fn the_orientation_of_the_way_point_of_an_arc_is_on_the_way() {
    let (source, machine) = (source(JOB), lrmate());
    let text = proven(&source, &machine);
    let at = text.find("\r\nP[5]{").unwrap();
    let turned = |by: &str| {
        let (before, after) = text.split_at(at);
        let line = after.lines().find(|line| line.starts_with("W = ")).unwrap();
        format!("{before}{}", after.replacen(line, &line.replace("P = 0.0000", by), 1))
    };
    for (by, rule) in [("P = 3.0000", Some("orientation-way")), ("P = 0.5000", None)] {
        let damaged = turned(by);
        assert_ne!(damaged, text);
        let report = proof_of(&source, &machine, &damaged);
        let found = report.mismatches.first().map(|found| found.rule.name());
        assert_eq!(found, rule, "{:?}", report.mismatches);
    }
}
