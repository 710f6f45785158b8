//! Robots: a toolpath posted on a KUKA, proven, and what the proof finds of damages to the program.

use crate::files::root;
use crate::robot::{JOB, proof_of, proven, refused, source, written};
use control::{Action, ArmAction, ArmPath, Dialect, Event};
use geom::Vec3;
use machine::Machine;
use program::{CompensatedPath, Op, Program};

fn kuka() -> Machine {
    machine::load("kuka-kr6-r900").unwrap()
}

/// A machine of the library with lines of its file changed.
fn kuka_with(changes: &[(&str, &str)]) -> Machine {
    crate::robot::changed("kuka-kr6-r900", changes)
}

/// A cell whose operator has a program that changes the tool.
fn kuka_with_tool_change() -> Machine {
    // The block is not one of the library's: each shop has a program of its own.
    kuka_with(&[
        ("joint_speed = 20", "joint_speed = 20\ntool_change = \"TOOL_CHANGE\""),
        ("dwell = 3\n", "dwell = 3\n[blocks]\ntool_change = \"TOOL_CHANGE ({{T}})\"\n"),
    ])
}

#[test]
fn the_job_of_the_specification_is_posted_with_its_joints_and_proven() {
    let text = proven(&source(JOB), &kuka());
    let paths = crate::robot::paths(Dialect::Krl, &text);
    // The joints that the specification has calculated for the tool at (0, 0, 50); how it is turned about its axis is free.
    let ArmPath::Joints(start) = paths[1] else { panic!("{text}") };
    for (at, expected) in start.iter().zip([0.0, -61.080, 126.744, 0.0, 24.336]) {
        assert!((at - expected).abs() < 1e-3, "{start:?}");
    }
    let lines: Vec<Vec3> = paths
        .iter()
        .filter_map(|path| match path {
            ArmPath::Line(end) => Some(end.translation),
            _ => None,
        })
        .collect();
    assert!(
        lines.contains(&Vec3::new(0.0, 0.0, -2.0)) && lines.contains(&Vec3::new(60.0, 0.0, -2.0))
    );
    let through = paths.iter().find_map(|path| match path {
        ArmPath::Arc { via, end } => Some((via.translation, end.translation)),
        _ => None,
    });
    assert_eq!(through, Some((Vec3::new(74.142, 5.858, -2.0), Vec3::new(80.0, 20.0, -2.0))));
    // It begins and ends with the joints at home, and leaves nothing on.
    let home = ArmPath::Joints([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    assert_eq!((paths[0], paths[paths.len() - 1]), (home, home));
    assert!(text.contains("$VEL.CP=0.005000\r\n") && text.contains("$VEL.CP=0.020000\r\n"));
    assert!(text.ends_with("$OUT[1]=FALSE\r\nEND\r\n"), "{text}");
}

#[test]
fn the_sample_program_of_each_robot_is_as_it_was_read() {
    let samples = root().join("machines/samples");
    let text = std::fs::read_to_string(samples.join("robot.cls")).unwrap();
    for name in machine::library::names(machine::library::ROBOTS) {
        let machine = machine::load(name).unwrap();
        let text = proven(&source(&text), &machine);
        let sample = samples.join(format!("{name}.{}", machine.extension));
        assert_eq!(
            text,
            std::fs::read_to_string(&sample).unwrap_or_default(),
            "{}",
            sample.display()
        );
    }
}

/// A line of the proven job, what it becomes, and the rule by which the proof refuses that.
const DAMAGES: &[(&str, &str, &str)] = &[
    ("$BASE={X 450.000", "$BASE={X 451.000", "frame"),
    (
        "$BASE={X 450.000,Y 0.000,Z 150.000,A 0.0000",
        "$BASE={X 450.000,Y 0.000,Z 150.000,A 1.0000",
        "frame",
    ),
    ("$TOOL={X 0.000,Y 0.000,Z 150.000", "$TOOL={X 0.000,Y 0.000,Z 149.000", "frame"),
    ("$TOOL={X 0.000,Y 0.000,Z 150.000,A 0.0000,B 0.0000", "$TOOL=TOOL_DATA[1];", "frame"),
    ("$IPO_MODE=#BASE", "$IPO_MODE=#TCP", "frame"),
    ("$ORI_TYPE=#VAR", "$ORI_TYPE=#JOINT", "orientation-way"),
    ("$ORI_TYPE=#VAR", ";", "orientation-way"),
    ("$CIRC_TYPE=#BASE", "$CIRC_TYPE=#PATH", "orientation-way"),
    ("LIN {X 60.000", "LIN {X 61.000", "path"),
    ("LIN {X 0.000,Y 0.000,Z -2.000", "LIN {X 0.000,Y 0.000,Z -2.002", "end-point"),
    ("LIN {X 60.000,Y 0.000,Z -2.000,A 0.0000", "LIN {X 60.000,Y 0.010,Z -2.000,A 0.0000", "path"),
    ("C 180.0000}\r\n$VEL.CP=0.100000", "C 179.0000}\r\n$VEL.CP=0.100000", "end-point"),
    ("CIRC {X 74.142", "CIRC {X 74.242", "arc"),
    ("CIRC {X 74.142,Y 5.858", "CIRC {X 45.858,Y 5.858", "arc"),
    ("$VEL.CP=0.005000", "$VEL.CP=0.050000", "feed"),
    ("$VEL.CP=0.020000", ";", "feed"),
    ("$OUT[1]=TRUE", "$OUT[1]=FALSE", "dwell"),
    ("$OUT[1]=TRUE", "$OUT[3]=TRUE", "output"),
    ("$ANOUT[1]=0.50000", "$ANOUT[1]=0.60000", "spindle"),
    ("$ANOUT[1]=0.50000", "$ANOUT[2]=0.50000", "output"),
    ("WAIT SEC 3.00", "WAIT SEC 1.00", "dwell"),
    ("WAIT SEC 3.00\r\n", "", "spindle-dwell"),
    ("$OUT[1]=FALSE\r\nEND", "END", "left-on"),
    ("$APO.CDIS=0.100", "$APO.CDIS=0.500", "path-tolerance"),
    ("C_DIS", "C_VEL", "path-tolerance"),
    ("END", "HALT\r\nEND", "stop"),
    ("END", "$OUT[2]=TRUE\r\nEND", "left-on"),
    ("DEF JOB ( )", "DEF JOB ( )\r\nDEF OTHER ( )", "program-frame"),
    // An INT over an INT is cut off: 1/2 is 0, 121/2 is 60.
    ("$ANOUT[1]=0.50000", "$ANOUT[1]=1/2", "spindle"),
    ("$OUT[1]=TRUE", "$OUT[1]=(1/2)>0", "dwell"),
    ("$VEL.CP=0.005000", "$VEL.CP=5/1000", "number"),
    ("LIN {X 60.000", "LIN {X 121/2-0.5", "arc"),
    ("WAIT SEC 3.00", "WAIT SEC 7/2-1", "dwell"),
    ("BAS (#INITMOV,0)", "DECL INT K\r\nK=-182.4366", "type"),
    ("BAS (#INITMOV,0)", "K=3", "variable"),
    // How fast the joints go.
    ("BAS (#VEL_PTP,20)", "BAS (#VEL_PTP,100)", "rapid-feed"),
    ("BAS (#VEL_PTP,20)\r\n", "", "rapid-feed"),
    ("BAS (#VEL_PTP,20)", "BAS (#VEL_PTP,20)\r\n$VEL_AXIS[1]=100", "rapid-feed"),
    ("BAS (#VEL_PTP,20)", "BAS (#VEL_PTP,20)\r\n$ACC_AXIS[1]=100", "unproven"),
    ("BAS (#VEL_PTP,20)", "BAS (#VEL_PTP,20)\r\n$ACC.CP=50", "unproven"),
    ("BAS (#VEL_PTP,20)", "BAS (#VEL_PTP,20)\r\nBAS (#ACC_PTP,100)", "unproven"),
    ("$IPO_MODE=#BASE", "BAS (#INITMOV,0)\r\n$IPO_MODE=#BASE", "rapid-feed"),
    // The point on the way is 0.02 mm outside of the circle.
    ("CIRC {X 74.142,Y 5.858", "CIRC {X 74.156,Y 5.844", "arc"),
    ("CIRC {X 74.142,Y 5.858", "CIRC {X 74.145,Y 5.855", "arc"),
    (
        "{X 60.000,Y 0.000,Z -2.000,A 0.0000",
        "{X 60.000,Y 0.000,Z -2.000,A 180.0000",
        "orientation-way",
    ),
    (
        "{X 60.000,Y 0.000,Z -2.000,A 0.0000",
        "{X 60.000,Y 0.000,Z -2.000,A 179.6000",
        "orientation-way",
    ),
    ("$TOOL=", "$LOAD={M 100,CM {X 0,Y 0,Z 0,A 0,B 0,C 0},J {X 1,Y 1,Z 1}}\r\n$TOOL=", "payload"),
    ("WAIT SEC 3.00", "WAIT SEC 1E300", "dwell"),
    ("WAIT SEC 3.00", "WAIT SEC 600", "dwell"),
    (
        ",{X 80.000,Y 20.000,Z -2.000,A 0.0000,B 0.0000,C 180.0000}",
        ",{X 80.000,Y 20.000,Z -2.000}",
        "unknown-position",
    ),
    ("; KUKA", "; KUKA\r$OUT[1]=TRUE ;", "syntax"),
    ("; KUKA", "; KUKA\u{b}", "syntax"),
    ("; KUKA", "; KUKA\u{2028}", "syntax"),
    ("DEF JOB ( )", "DEF LIN ( )", "syntax"),
    ("$IPO_MODE=#BASE", "DECL INT K\r\n$IPO_MODE=#BASE", "definition"),
    ("DEF JOB ( )", "DEF JOB ( )\r\n&REL 2", "program-frame"),
    ("END\r\n", "END\r\nEND\r\n", "program-frame"),
    ("END\r\n", "END\r\n$OUT[1]=TRUE\r\n", "program-frame"),
    (
        "PTP {A1 0.0000,A2 -90.0000,A3 90.0000,A4 0.0000,A5 45.0000,A6 0.0000}\r\n$OUT[1]=FALSE",
        "$OUT[1]=FALSE",
        "home",
    ),
];

#[test]
fn each_damage_to_the_job_is_refused_by_its_rule() {
    let (source, machine) = (source(JOB), kuka());
    let text = proven(&source, &machine);
    for (from, to, rule) in DAMAGES {
        let damaged = text.replacen(from, to, 1);
        assert_ne!(damaged, text, "{from}");
        let report = proof_of(&source, &machine, &damaged);
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        assert_eq!(found, [*rule], "{from} -> {to}: {:#?}", report.mismatches);
    }
    let off = text.replacen("$OUT[1]=TRUE", "$OUT[1]=FALSE", 1);
    let report = proof_of(&source, &machine, &off);
    assert!(
        report.mismatches[0].help.contains("the spindle is off here"),
        "{:#?}",
        report.mismatches
    );
}

/// A line of 10° over 40 mm at 1200 mm/min takes 2 s.
const TILT: &str = "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/MMPM,1200\n\
GOTO/0,0,0,0,0,1\nGOTO/40,0,0,0,0.17364818,0.98480775\nRAPID\nGOTO/40,8.68240888,49.2403877,0,0.17364818,0.98480775\nFINI\n";

#[test]
fn a_tool_that_turns_too_slowly_for_its_feed_is_refused() {
    let (source, machine) = (source(TILT), kuka());
    let text = proven(&source, &machine);
    // At 5°/s the turn takes as long as the cut; at 4°/s 2.5 s.
    let turning = |speed: &str| text.replace("$VEL.ORI1=60", &format!("$VEL.ORI1={speed}"));
    assert!(proof_of(&source, &machine, &turning("5")).proven);
    for damaged in [turning("4"), turning("0.01"), text.replace("$VEL.ORI1=60\r\n", "")] {
        let report = proof_of(&source, &machine, &damaged);
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        assert_eq!(found, ["feed"], "{:#?}", report.mismatches);
    }
}

/// A line left out, doubled, or two of them in the other order: the program differs, or does the same.
#[test]
fn each_line_of_the_job_is_needed_or_changes_nothing() {
    let (source, machine) = (source(JOB), kuka());
    let text = proven(&source, &machine);
    let lines: Vec<&str> = text.split_inclusive("\r\n").collect();
    // Comments, the head of the file, speeds of turns where nothing turns, what is the same by itself, and the speed of the rapid out of the part, which goes
    // at that of the cut without it.
    let harmless = ["&", ";", "$VEL.ORI", "BAS (#INITMOV", "$VEL.CP=0.100000"];
    for left_out in 0..lines.len() {
        let line = lines[left_out];
        if harmless.iter().any(|start| line.starts_with(start)) {
            continue;
        }
        let rest: String = lines
            .iter()
            .enumerate()
            .filter(|(i, _)| *i != left_out)
            .map(|(_, line)| *line)
            .collect();
        let report = proof_of(&source, &machine, &rest);
        assert!(!report.proven, "without {line}");
    }
}

#[test]
fn a_straight_rapid_goes_no_faster_than_the_cell_states() {
    let sample = std::fs::read_to_string(root().join("machines/samples/robot.cls")).unwrap();
    let (source, machine) = (source(&sample), kuka());
    let text = proven(&source, &machine);
    let report = proof_of(&source, &machine, &text.replacen("$VEL.CP=0.100000", "$VEL.CP=0.2", 1));
    assert_eq!(report.mismatches[0].rule.name(), "rapid-feed", "{:?}", report.mismatches);
}

#[test]
fn of_200_single_damages_each_is_refused_or_changes_nothing() {
    let sample = std::fs::read_to_string(root().join("machines/samples/robot.cls")).unwrap();
    let refused =
        crate::robot::damaged_by_dice(&sample, (&kuka(), Dialect::Krl), "BAS (#VEL_PTP", 17);
    assert!(refused > 120, "{refused}");
}

#[test]
fn what_the_arm_cannot_do_is_refused_with_line_and_margin() {
    let machine = kuka();
    refused("GOTO/60,0,-2", "GOTO/2000,0,-2", &machine, 10, "mm out of reach");
    refused("GOTO/60,0,-2", "GOTO/2000,0,-2", &machine, 10, "before the end of the motion");
    refused("LOADTL/1", "LOADTL/1\nOPSTOP", &machine, 4, "optional_stop = \"\"");
    // Through the axis on which the arm stands.
    refused("GOTO/60,0,-2", "GOTO/-800,0,-2", &machine, 10, "the arm");
    refused("FEDRAT/MMPM,1200", "FEDRAT/MMPM,13000", &machine, 10, "13000 mm/min");
    refused("RPM,12000,CLW", "RPM,30000,CLW", &machine, 4, "30000");
    refused("RPM,12000,CLW", "RPM,12000,CCLW", &machine, 8, "counter-clockwise");
    refused("LOADTL/1", "LOADTL/1\nCUTCOM/LEFT", &machine, 4, "--cutcom centre");
    refused("RAPID\nGOTO/0,0,50\n", "", &machine, 6, "begins where nobody knows");
    let fast = kuka_with(&[("feed_max = 12000", "feed_max = 200000")]);
    refused("FEDRAT/MMPM,1200", "FEDRAT/MMPM,190000", &fast, 10, "of its speed at this feed");
    let without = kuka_with(&[("spindle_analog = 1\nspindle_full = 24000\n", "")]);
    refused("LOADTL/1", "LOADTL/1", &without, 8, "spindle_analog");
    let without = kuka_with(&[("tool_length = 50\n", "")]);
    refused("LOADTL/1", "LOADTL/1", &without, 6, "the length of the tool");
}

/// A way in, two sides of a square about the centre of a tool of radius 3, and a way out, with compensation on.
const COMPENSATED: &str = "PARTNO/JOB\nUNITS/MM\nCUTTER/6\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\n\
GOTO/0,0,-2\nCUTCOM/LEFT\nFEDRAT/MMPM,1200\nGOTO/10,0,-2\nGOTO/60,0,-2\nGOTO/60,40,-2\nCUTCOM/OFF\nGOTO/60,60,-2\n\
RAPID\nGOTO/60,60,50\nFINI\n";

#[test]
fn a_path_of_the_centre_with_compensation_is_posted_as_it_is_and_no_other_is() {
    let machine = kuka();
    let compensated = |path| Program { compensated_path: path, ..source(COMPENSATED) };
    let plain = source(&COMPENSATED.replace("CUTCOM/LEFT\n", "").replace("CUTCOM/OFF\n", ""));
    let center = compensated(Some(CompensatedPath::Center));
    let text = proven(&center, &machine);
    assert_eq!(text, proven(&plain, &machine));
    let warnings = post::write(&center, &machine).unwrap().warnings;
    let warned: Vec<_> = warnings.iter().map(|found| (found.rule.name(), found.line)).collect();
    assert_eq!(warned, [("compensated-path", 10)]);
    let unknown = compensated(None);
    let found = post::write(&unknown, &machine).unwrap_err();
    assert_eq!((found[0].rule.name(), found[0].line), ("compensated-path", 10));
    let report = proof_of(&unknown, &machine, &text);
    assert!(!report.proven);
    assert_eq!(report.mismatches[0].rule.name(), "compensated-path");
    // The centre on the contour would cut 3 mm too deep: the judge refuses the same text.
    let contour = compensated(Some(CompensatedPath::Contour));
    let report = proof_of(&contour, &machine, &text);
    assert!(!report.proven);
    assert_eq!(report.mismatches[0].rule.name(), "compensation");
}

fn contour(text: &str) -> Program {
    Program { compensated_path: Some(CompensatedPath::Contour), ..source(text) }
}

/// Where lines and arcs end.
fn ends(machine: &Machine, text: &str) -> Vec<Vec3> {
    let dialect = Dialect::named(&machine.reader).unwrap();
    let cell = machine.cell.as_ref().unwrap();
    let mut base = geom::Frame::IDENTITY;
    let of = |event: Event| match event.action {
        Action::Arm(ArmAction::Base(Some(frame))) => {
            base = *frame;
            None
        }
        Action::Arm(ArmAction::Move(motion)) => match motion.path {
            ArmPath::Line(end) | ArmPath::Arc { end, .. } => {
                Some((cell.part.inverse() * base * end).translation)
            }
            ArmPath::Joints(_) | ArmPath::Point(_) => None,
        },
        _ => None,
    };
    crate::robot::events(dialect, text).into_iter().filter_map(of).collect()
}

/// Whether the points come one behind the other, within 2 µm.
fn passes(ends: &[Vec3], points: &[[f64; 3]]) -> bool {
    let points: Vec<Vec3> = points.iter().map(|point| Vec3::from_array(*point)).collect();
    ends.windows(points.len())
        .any(|ends| ends.iter().zip(&points).all(|(end, point)| end.distance(*point) < 2e-3))
}

/// Each robot of another language.
const LANGUAGES: [&str; 4] =
    ["kuka-kr6-r900", "universal-ur5e", "fanuc-lrmate-200id-mill", "abb-irb120-mill"];

#[test]
fn a_contour_is_offset_by_the_radius_of_the_tool_and_the_way_of_its_centre_is_judged() {
    let source = contour(COMPENSATED);
    for name in LANGUAGES {
        let machine = machine::load(name).unwrap();
        let text = proven(&source, &machine);
        // By hand: 3 mm to the left, the inner corner at X60 Y0 at the crossing, out to X60 Y60.
        let points = [[10.0, 3.0, -2.0], [57.0, 3.0, -2.0], [57.0, 40.0, -2.0], [60.0, 60.0, -2.0]];
        assert!(passes(&ends(&machine, &text), &points), "{text}");
    }
    let machine = kuka();
    let text = proven(&source, &machine);
    let report = proof_of(&source, &machine, &text);
    assert_eq!(report.compared.contours, 1);
    let warnings = post::write(&source, &machine).unwrap().warnings;
    assert!(warnings.iter().any(|found| found.rule.name() == "compensated-path"
        && found.line == 10
        && found.message.contains("radius of 3 mm")));
    // 0.1 mm too near, an inner corner that is overrun, a way out too early, and a feed of another element.
    for (from, to, rule) in [
        ("Y 3.000", "Y 2.900", "compensation"),
        ("LIN {X 57.000,Y 3.000", "LIN {X 58.000,Y 3.000", "compensation"),
        ("X 57.000,Y 40.000", "X 57.000,Y 39.000", "compensation"),
        ("$VEL.CP=0.020000", "$VEL.CP=0.030000", "feed"),
    ] {
        assert!(text.contains(from), "{from}: {text}");
        let report = proof_of(&source, &machine, &text.replace(from, to));
        let found = report.mismatches.first().map(|found| found.rule.name());
        assert_eq!(found, Some(rule), "{from}");
    }
}

#[test]
fn around_outer_corners_the_centre_goes_by_an_arc_in_two_depths_and_up_from_where_it_is() {
    // Around a square of 40 mm on its outside, clockwise, with a tool of 10: down, around, deeper, around once more; then straight up.
    let text = "PARTNO/JOB\nUNITS/MM\nCUTTER/10\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/-20,20,50\nFEDRAT/MMPM,300\n\
GOTO/-20,20,-2\nCUTCOM/LEFT\nFEDRAT/MMPM,1200\nGOTO/0,20,-2\nGOTO/0,40,-2\nGOTO/40,40,-2\nGOTO/40,0,-2\nGOTO/0,0,-2\nGOTO/0,20,-2\n\
FEDRAT/MMPM,300\nGOTO/0,20,-4\nFEDRAT/MMPM,1200\nGOTO/0,40,-4\nGOTO/40,40,-4\nGOTO/40,0,-4\nGOTO/0,0,-4\nGOTO/0,20,-4\nCUTCOM/OFF\n\
RAPID\nGOTO/0,20,50\nFINI\n";
    let source = contour(text);
    for name in LANGUAGES {
        let machine = machine::load(name).unwrap();
        let text = proven(&source, &machine);
        let ends = ends(&machine, &text);
        for depth in [-2.0, -4.0] {
            let around = [
                [-5.0, 20.0, depth],
                [-5.0, 40.0, depth],
                [0.0, 45.0, depth],
                [40.0, 45.0, depth],
                [45.0, 40.0, depth],
                [45.0, 0.0, depth],
                [40.0, -5.0, depth],
                [0.0, -5.0, depth],
                [-5.0, 0.0, depth],
                [-5.0, 20.0, depth],
            ];
            assert!(passes(&ends, &around), "{name} {ends:?}\n{text}");
        }
        let report = proof_of(&source, &machine, &text);
        assert!(report.proven);
    }
}

#[test]
fn a_contour_into_which_the_tool_does_not_fit_is_refused_with_its_line() {
    let machine = kuka();
    let refused = |from: &str, to: &str, line: u32, what: &str| {
        assert!(COMPENSATED.contains(from), "{from}");
        let found = post::write(&contour(&COMPENSATED.replace(from, to)), &machine).expect_err(to);
        assert!(found[0].message.contains(what), "{}", found[0]);
        assert_eq!((found[0].rule.name(), found[0].line), ("compensation", line), "{}", found[0]);
    };
    refused("CUTTER/6\n", "", 9, "no radius of the tool");
    // A bulge of 5.9 mm over the first side, three elements on: the tool has 6.
    let bulge = "GOTO/60,20,-2\nGOTO/40,20,-2\nGOTO/40,5.9,-2\nGOTO/30,5.9,-2\nGOTO/30,20,-2\nGOTO/0,20,-2\nCUTCOM/OFF\nGOTO/-20,20,-2\n";
    refused(
        "GOTO/60,40,-2\nCUTCOM/OFF\nGOTO/60,60,-2\n",
        bulge,
        13,
        "between this element and that of line 1",
    );
    let wide = COMPENSATED
        .replace("GOTO/60,40,-2\nCUTCOM/OFF\nGOTO/60,60,-2\n", &bulge.replace("5.9", "6.1"))
        .replace("60,60,50", "-20,20,50");
    proven(&contour(&wide), &machine);
    // A step in of 2 mm between two inner corners, and an arc of radius 2 around the inside.
    refused("GOTO/60,40,-2\n", "GOTO/60,2,-2\nGOTO/50,2,-2\n", 14, "does not fit");
    refused(
        "GOTO/60,40,-2\n",
        "CIRCLE/60,2,-2,0,0,1,2\nGOTO/62,2,-2\nGOTO/62,40,-2\n",
        15,
        "an arc of radius 2",
    );
    let rapid = COMPENSATED.replace("GOTO/60,0,-2\n", "RAPID\nGOTO/60,0,-2\n");
    let found = post::write(&contour(&rapid), &machine).unwrap_err();
    assert_eq!((found[0].rule.name(), found[0].line), ("compensation-active", 14));
}

#[test]
fn a_tool_change_is_a_call_of_the_operators_program_at_home() {
    let machine = kuka_with_tool_change();
    let two = two_tools();
    let text = proven(&source(&two), &machine);
    assert!(text.contains("TOOL_CHANGE (1)") && text.contains("TOOL_CHANGE (2)"), "{text}");
    // The second tool is 10 mm longer.
    assert!(text.contains("$TOOL={X 0.000,Y 0.000,Z 160.000"), "{text}");
    let swapped = text.replace("TOOL_CHANGE (2)", "TOOL_CHANGE (3)");
    assert!(!proof_of(&source(&two), &machine, &swapped).proven);
}

/// The job, and a cut with another tool, which is 10 mm longer.
fn two_tools() -> String {
    JOB.replace("FINI", "LOADTL/2,LENGTH,60\nSPINDL/RPM,6000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,50\nFINI")
}

/// A number is one tool, whether it stays in the spindle or comes back into it: a program said that it stands 70 mm out, and then, of the same
/// tool, 50.
#[test]
fn a_tool_that_is_called_with_another_length_is_refused() {
    let again = |first: &str, between: &str, second: &str| {
        let call = format!(
            "{between}LOADTL/1{second}\nRAPID\nGOTO/0,0,50\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,50\nFINI"
        );
        source(&JOB.replace("LOADTL/1", &format!("LOADTL/1{first}")).replace("FINI", &call))
    };
    let other = "LOADTL/2\nRAPID\nGOTO/0,0,50\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,50\n";
    // The cell says 50 mm where the source states nothing.
    for (first, between, second, lengths) in [
        ("", "", ",LENGTH,46", Some(["46 mm", "50 mm"])),
        (",LENGTH,46", "", "", Some(["50 mm", "46 mm"])),
        (",LENGTH,70", other, "", Some(["50 mm", "70 mm"])),
        ("", "", ",LENGTH,50", None),
        (",LENGTH,46", "", ",LENGTH,46", None),
        (",LENGTH,46", other, ",LENGTH,46", None),
    ] {
        let job = again(first, between, second);
        for machine in [kuka(), kuka_with_tool_change()] {
            let Some([now, before]) = lengths else {
                proven(&job, &machine);
                continue;
            };
            let found = &post::write(&job, &machine).unwrap_err()[0];
            let line = if between.is_empty() { 15 } else { 21 };
            assert_eq!((found.rule.name(), found.line), ("tool-twice", line), "{found}");
            let says = format!("is called with {now}, and has been called with {before}");
            assert!(found.message.contains(&says), "{found}");
            // The program of the same job with one length.
            let text = proven(&again("", between, ""), &machine);
            let report = proof_of(&job, &machine, &text);
            assert_eq!(report.mismatches[0].rule.name(), "tool-twice");
        }
    }
}

#[test]
fn tools_are_put_in_by_hand_at_a_stop_where_no_program_changes_them() {
    let robots = [
        ("kuka-kr6-r900", "$LOOP_MSG[]=\"Tool 2 ", "HALT\r\n", "$TOOL="),
        ("universal-ur5e", "popup(\"Tool 2 ", "popup(", "set_tcp("),
        ("fanuc-lrmate-200id-mill", "MESSAGE[Tool 2,", "PAUSE ;", "UTOOL[9]=PR[9]"),
        ("abb-irb120-mill", "TPWrite \"Tool 2 ", "Stop;", "tPost:="),
    ];
    let source = source(&two_tools());
    for (name, message, stop, frame) in robots {
        let machine = machine::load(name).unwrap();
        let text = proven(&source, &machine);
        assert_eq!((text.matches(stop).count(), text.matches(message).count()), (2, 1), "{text}");
        let warnings = post::write(&source, &machine).unwrap().warnings;
        let by_hand: Vec<_> =
            warnings.iter().filter(|found| found.rule.name() == "tool-by-hand").collect();
        assert_eq!((by_hand.len(), by_hand[0].line), (1, 3), "{name}");
        assert!(by_hand[0].help.contains("tool_change"), "{name}");
        // The source states the length of the second one alone.
        let length = warnings.iter().filter(|found| found.rule.name() == "tool-length");
        let length: Vec<_> =
            length.map(|found| (found.line, found.message.contains("50 mm"))).collect();
        assert_eq!(length, [(3, true)], "{name}");
        let rule_of = |damaged: &str| {
            assert_ne!(damaged, text, "{name}");
            let report = proof_of(&source, &machine, damaged);
            report.mismatches.first().map(|found| found.rule.name())
        };
        // Another number, and no message at all.
        let other = text.replace(message, &message.replace('2', "3"));
        assert_eq!(rule_of(&other), Some("tool-by-hand"), "{name}");
        let silent = text.replace(message, &message.replace("Tool 2", "Go on"));
        assert_eq!(rule_of(&silent), Some("tool-by-hand"), "{name}");
        if name == "kuka-kr6-r900" {
            // The control shows no text then.
            for hidden in ["$LOOP_CONT=FALSE", "$BWDSTART=FALSE"] {
                let hidden = text.replace("$LOOP_CONT=TRUE", hidden);
                assert_eq!(rule_of(&hidden), Some("tool-by-hand"));
            }
        }
        // What is taken away before the stop asks for no tool.
        let erasers: &[(&str, &str)] = match name {
            "kuka-kr6-r900" => &[
                ("HALT", "WAIT FOR STRCLEAR($LOOP_MSG[])\r\nHALT"),
                ("HALT", "$LOOP_CONT=FALSE\r\nHALT"),
            ],
            "abb-irb120-mill" => &[("Stop;", "TPErase;\r\nStop;")],
            _ => &[],
        };
        for (stop, erased) in erasers {
            assert_eq!(rule_of(&text.replace(stop, erased)), Some("tool-by-hand"), "{erased}");
        }
        // Behind the stop the frame of the tool is stated anew: it is a longer one.
        let at = text.rfind(frame).unwrap();
        let line = text[at..].find('\n').unwrap();
        let without = format!("{}{}", &text[..at], &text[at + line..]);
        assert!(rule_of(&without).is_some(), "{name}");
    }
}

#[test]
fn a_stop_for_a_tool_is_at_home_with_everything_off_and_the_arm_goes_home_behind_it() {
    let (source, machine) = (source(&two_tools()), kuka());
    let text = proven(&source, &machine);
    let halt = text.rfind("HALT\r\n").unwrap();
    let (before, behind) = text.split_at(halt);
    let refused = |text: String| {
        proof_of(&source, &machine, &text).mismatches.first().map(|found| found.rule.name())
    };
    let off = before.rfind("$OUT[1]=FALSE").unwrap();
    let running = format!("{}{}{behind}", &before[..off], &before[off + 13..]);
    assert_eq!(refused(running), Some("stop-running"));
    // The way home before the stop, and behind it.
    let home = before.rfind("PTP ").unwrap();
    let away = format!("{};{}{behind}", &before[..home], &before[home..]);
    assert_eq!(refused(away), Some("tool-change"));
    let skipped = format!("{before}{}", behind.replacen("PTP ", ";", 1));
    assert_eq!(refused(skipped), Some("home"));
    assert!(refused(text.replacen("HALT\r\n", "", 1)).is_some());
}

#[test]
fn the_tool_that_is_in_the_spindle_is_not_asked_for_again() {
    let once_more = two_tools().replace("LOADTL/2,LENGTH,60", "LOADTL/1,LENGTH,50");
    let text = proven(&source(&once_more), &kuka());
    assert!(!text.contains("HALT"), "{text}");
    // Nothing is on where the source calls a tool.
    assert_eq!(text.matches("$OUT[1]=TRUE").count(), 2, "{text}");
    let back = format!(
        "{}LOADTL/2,LENGTH,60\nLOADTL/1\nSPINDL/RPM,6000,CLW\nRAPID\nGOTO/0,0,50\nFINI\n",
        two_tools().replace("FINI\n", "")
    );
    let text = proven(&source(&back), &kuka());
    assert_eq!(text.matches("HALT").count(), 3, "{text}");
}

/// The source goes by rapid to where the tool is already: over a hole at its retract height, within rounding.
#[test]
fn a_rapid_to_where_the_tool_is_already_is_no_motion() {
    let over_a_hole = "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/20,20,45.38191\n\
CYCLE/DRILL,FEDTO,4,MMPM,150,RAPTO,3,RTRCTO,45.381891\nGOTO/20,20,0\nGOTO/40,20.0001,0\nCYCLE/OFF\nRAPID\nGOTO/40,20,45.3818\n\
RAPID\nGOTO/20,20,80\nFINI\n";
    for name in machine::library::names(machine::library::ROBOTS) {
        proven(&source(over_a_hole), &machine::load(name).unwrap());
    }
}

/// Other files of cutter-location data: each is proven, or refused before anything is written.
#[test]
fn no_file_of_cutter_location_data_fails_its_own_proof_on_the_robot() {
    let mut made = [0, 0];
    for (machine, made) in [kuka(), kuka_with_tool_change()].iter().zip(&mut made) {
        for file in crate::files::sources() {
            let text = std::fs::read(&file).unwrap();
            let name = file.file_name().unwrap().to_string_lossy().into_owned();
            let Ok(read) = source::apt::read(&name, &text, &Default::default()) else { continue };
            match post::write(&read.program, machine) {
                Err(found) => eprintln!("{name}: refused ({})", found[0].rule),
                Ok(output) => {
                    let text = String::from_utf8(output.text).unwrap();
                    let report = proof_of(&read.program, machine, &text);
                    assert!(report.proven, "{name}: {:#?}", report.mismatches);
                    eprintln!("{name}: proven, {} blocks", output.blocks);
                    *made += 1;
                }
            }
        }
    }
    // Whether a program changes tools, or the operator does.
    assert_eq!(made[0], made[1]);
    // Seven of the real files change tools and compensate along the path of the centre.
    let least = if judge::data("cldata/solidworks").is_some() { 7 } else { 1 };
    assert!(made[0] >= least, "{made:?}");
}

#[test]
fn the_load_of_the_cell_is_stated() {
    let load = "joint_speed = 20\nload_mass = 1.5\nload_center = [0, 0, 60]";
    let machine = kuka_with(&[("joint_speed = 20", load)]);
    let text = proven(&source(JOB), &machine);
    let line =
        "$LOAD={M 1.500,CM {X 0.00,Y 0.00,Z 60.00,A 0.0,B 0.0,C 0.0},J {X 0.0,Y 0.0,Z 0.0}}\r\n";
    assert!(text.contains(line), "{text}");
    for (from, to) in [(line, ""), ("M 1.500", "M 15.00"), ("Z 60.00,A", "Z 80.00,A")] {
        let report = proof_of(&source(JOB), &machine, &text.replace(from, to));
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        assert_eq!(found, ["payload"], "{to}");
    }
}

/// The spindle stays as it is in the cut until the tool is out of it: stopped, or slowed, in the material it breaks the tool, also where
/// it is started again before the next cut.
#[test]
fn a_tool_leaves_a_cut_with_the_spindle_as_in_the_cut() {
    let text = std::fs::read_to_string(root().join("machines/samples/robot.cls")).unwrap();
    let (source, machine) = (source(&text), kuka());
    let text = proven(&source, &machine);
    let at = "A 0.0000,B 0.0000,C 180.0000}\r\n";
    let (bottom, above) = (
        format!("LIN {{X 0.000,Y 0.000,Z -2.000,{at}"),
        format!("LIN {{X 0.000,Y 0.000,Z 30.000,{at}"),
    );
    let hole = format!("LIN {{X 30.000,Y 20.000,Z -2.500,{at}");
    let on = "$OUT[1]=TRUE\r\nWAIT SEC 3.00\r\n";
    // The first line to Z 30 comes down to it from above.
    let lines = [&bottom, &above, &hole].map(|line| text.matches(line.as_str()).count());
    assert_eq!(lines, [1, 2, 1]);
    let behind = |text: &str, line: &str, more: &str| {
        let (before, after) = text.split_at(text.rfind(line).unwrap() + line.len());
        format!("{before}{more}{after}")
    };
    let started = behind(&text, &above, on);
    let in_hole = text.split_once(&hole).unwrap();
    let lifted = in_hole.1.split_once("\r\n").unwrap();
    let in_hole = format!("{}{hole}$OUT[1]=FALSE\r\n{}\r\n{on}{}", in_hole.0, lifted.0, lifted.1);
    for damaged in [
        behind(&started, &bottom, "$OUT[1]=FALSE\r\n"),
        behind(
            &behind(&text, &bottom, "$ANOUT[1]=0.10000\r\n"),
            &above,
            "$ANOUT[1]=0.50000\r\nWAIT SEC 3.00\r\n",
        ),
        in_hole,
    ] {
        let report = proof_of(&source, &machine, &damaged);
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        assert_eq!(found, ["spindle"], "{:#?}", report.mismatches);
    }
    // The source itself stops it at the bottom: its line is named, and what to do there.
    let last = "GOTO/60,0,-2\nSPINDL/OFF\nFINI\n";
    let in_cut = crate::robot::source(
        &JOB.split("GOTO/60,0,-2").next().map(|head| format!("{head}{last}")).unwrap(),
    );
    let report = proof_of(&in_cut, &machine, &crate::robot::written(&in_cut, &machine).unwrap());
    let found = &report.mismatches[0];
    assert!(
        found.message.starts_with("source line 10: the tool leaves a cut with the spindle off,"),
        "{found}"
    );
    assert!(found.help.contains("SPINDL/OFF"), "{found}");
    // Above the cuts it is stopped and started as the program likes.
    let free = behind(&text, &above, &format!("$OUT[1]=FALSE\r\n{on}"));
    assert!(proof_of(&source, &machine, &free).proven);
}

/// A cutter bursts in the air too: no tool turns faster than the source names a speed for it, also on the way home.
#[test]
fn no_tool_turns_faster_on_a_robot_than_the_source_names_a_speed_for_it() {
    let machine = kuka();
    let tools = two_tools().replace("RPM,6000", "RPM,12000").replacen("RPM,12000", "RPM,6000", 1);
    for (job, halves) in [(JOB.to_owned(), ["0.50000", "0.50100"]), (tools, ["0.25000", "0.50000"])]
    {
        let source = source(&job);
        let text = proven(&source, &machine);
        // The first way home behind the cuts.
        let off = text.find("$OUT[1]=FALSE").unwrap();
        let home = text[..off].rfind("PTP {A1").unwrap();
        let found = |value: &str| {
            let (before, behind) = text.split_at(home);
            let damaged = format!("{before}$ANOUT[1]={value}\r\n{behind}");
            let report = proof_of(&source, &machine, &damaged);
            report.mismatches.iter().map(|found| found.rule.name()).collect::<Vec<_>>()
        };
        let [most, more] = halves;
        assert_eq!(found(most), [""; 0], "{text}");
        assert_eq!(found("0.10000"), [""; 0], "{text}");
        assert_eq!(found(more), ["spindle"], "{text}");
        assert_eq!(found("1.00000"), ["spindle"], "{text}");
    }
    // A tool that is switched on at the speed of the one before.
    let source = source(&two_tools());
    let text = proven(&source, &machine);
    let slow = "$ANOUT[1]=0.25000\r\n$OUT[1]=TRUE\r\n";
    let late = text.replace(slow, "$OUT[1]=TRUE\r\n$ANOUT[1]=0.25000\r\n");
    assert_ne!(late, text);
    let report = proof_of(&source, &machine, &late);
    assert_eq!(report.mismatches[0].rule.name(), "spindle", "{late}");
}

/// A dwell behind SPINDL is for the spindle to run up, or to turn: it has to turn then. The cell waits 3 s behind each start, which a
/// longer dwell of the source holds already.
#[test]
fn the_spindle_turns_in_a_dwell_that_stands_behind_its_start() {
    let dwell =
        |seconds: u32| source(&JOB.replacen("CLW\n", &format!("CLW\nDELAY/{seconds}\n"), 1));
    let on = |waits: &str| format!("$ANOUT[1]=0.50000\r\n$OUT[1]=TRUE\r\n{waits}");
    for (seconds, waits) in [
        (10, "WAIT SEC 10.00\r\n"),
        (3, "WAIT SEC 3.00\r\n"),
        (1, "WAIT SEC 3.00\r\nWAIT SEC 1.00\r\n"),
    ] {
        let text = proven(&dwell(seconds), &kuka());
        assert_eq!(text.matches("WAIT SEC").count(), waits.matches("WAIT SEC").count(), "{text}");
        assert!(text.contains(&on(waits)), "{text}");
    }
    // It was written so before: the dwell, then the start with the wait of the cell.
    let text = proven(&dwell(10), &kuka());
    let late = text.replace(
        &on("WAIT SEC 10.00\r\n"),
        &format!("WAIT SEC 10.00\r\n{}", on("WAIT SEC 3.00\r\n")),
    );
    let slow = text.replace("$ANOUT[1]=0.50000", "$ANOUT[1]=0.25000");
    for damaged in [late, slow] {
        assert_ne!(damaged, text);
        let report = proof_of(&dwell(10), &kuka(), &damaged);
        let found = report.mismatches.first().unwrap_or_else(|| panic!("proven\n{damaged}"));
        assert_eq!(found.rule.name(), "spindle", "{found}");
    }
    // A cell without a wait of its own.
    let machine = kuka_with(&[("dwell = 3\n", "")]);
    let text = proven(&dwell(10), &machine);
    assert!(text.contains(&on("WAIT SEC 10.00\r\n")), "{text}");
}

/// Ten turns at 9000 a minute are 0.0667 s, of which the words of robots say hundredths.
#[test]
fn a_dwell_in_turns_is_as_long_as_its_word_says_it() {
    let job = JOB.replace("RPM,12000", "RPM,9000");
    let source = source(&job.replacen("GOTO/60,0,-2\n", "DELAY/REV,10\nGOTO/60,0,-2\n", 1));
    for (name, dwell, longer) in [
        ("kuka-kr6-r900", "WAIT SEC 0.07\r\n", "WAIT SEC 0.08\r\n"),
        ("fanuc-lrmate-200id-mill", "WAIT 0.07(sec)", "WAIT 0.06(sec)"),
    ] {
        let machine = machine::load(name).unwrap();
        let text = proven(&source, &machine);
        let report = proof_of(&source, &machine, &text.replacen(dwell, longer, 1));
        let found = report.mismatches.first().unwrap_or_else(|| panic!("proven\n{text}"));
        assert_eq!(found.rule.name(), "dwell", "{found}");
    }
}

/// What the source switches on before a tool is called, or where it calls none, is on in the cuts, as on mills: a tool change stops spindle and coolant, and they start again.
#[test]
fn spindle_and_coolant_that_stand_before_the_tool_are_on_in_its_cuts() {
    let on = "SPINDL/RPM,9000,CLW\nCOOLNT/FLOOD\n";
    let cut = |x: u32| {
        format!(
            "RAPID\nGOTO/{x},50,65\nRAPID\nGOTO/{x},50,5\nFEDRAT/MMPM,300\nGOTO/{x},50,0\nGOTO/{x},60,0\nRAPID\nGOTO/{x},60,65\n"
        )
    };
    let [first, second] = [1, 2].map(|tool| format!("LOADTL/{tool},LENGTH,50\n"));
    let job = |parts: &[&str]| {
        source(&format!("PARTNO/JOB\nUNITS/MM\n{}SPINDL/OFF\nCOOLNT/OFF\nFINI\n", parts.concat()))
    };
    for name in ["universal-ur10e", "kuka-kr6-r900", "abb-irb120-mill", "fanuc-lrmate-200id-mill"] {
        let machine = machine::load(name).unwrap();
        let behind = job(&[&first, on, &cut(100), &second, on, &cut(120)]);
        let before = job(&[on, &first, &cut(100), &second, &cut(120)]);
        let text = proven(&behind, &machine);
        assert_eq!(proven(&before, &machine), text, "{name}");
        let none = job(&[on, &cut(100)]);
        proven(&none, &machine);
        // The programs that were written before: the cuts with the spindle, or the coolant, off.
        let is_spindle = |op: &Op| matches!(op, Op::Spindle(_));
        let is_coolant = |op: &Op| matches!(op, Op::Coolant(_));
        for (job, switches, rule) in [
            (&before, &is_spindle as &dyn Fn(&Op) -> bool, "spindle"),
            (&before, &is_coolant, "coolant"),
            (&none, &is_spindle, "spindle"),
        ] {
            let mut left = job.clone();
            left.records.retain(|record| !switches(&record.op));
            let without = written(&left, &machine).unwrap();
            let report = proof_of(job, &machine, &without);
            assert_eq!(report.mismatches[0].rule.name(), rule, "{name}");
        }
    }
}
