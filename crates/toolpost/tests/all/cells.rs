//! Cells of robots: cuts that are left and entered again.

use crate::robot::{LINE, joints, proof_of, proven, rings, source};
use machine::Machine;
use program::Program;

/// A KUKA that may leave a cut and enter it again, at 300 mm/min.
fn reentering() -> Machine {
    crate::robot::changed("kuka-kr6-r900", &[("rapid = 6000", "rapid = 6000\nreentry_feed = 300")])
}

/// [`LINE`] on the KUKA with its cut left at X30 and entered again with the tool turned by 90 degrees, written by hand.
fn left_at_30(source: &Program, machine: &Machine) -> String {
    let text = proven(source, machine);
    let cut = "LIN {X 60.000,Y 0.000,Z -2.000,A 0.0000,B 0.0000,C 180.0000}\r\n";
    let (before, after) = text.split_once(cut).unwrap();
    let [a1, a2, a3, a4, a5, a6] = joints(machine, [30.0, 0.0, 60.0], 90.0);
    let way = format!(
        "LIN {{X 30.000,Y 0.000,Z -2.000,A 0.0000,B 0.0000,C 180.0000}}\r\n\
         $VEL.CP=0.005000\r\n\
         LIN {{X 30.000,Y 0.000,Z -0.500,A 0.0000,B 0.0000,C 180.0000}}\r\n\
         $VEL.CP=0.100000\r\n\
         LIN {{X 30.000,Y 0.000,Z 60.000,A 0.0000,B 0.0000,C 180.0000}}\r\n\
         PTP {{A1 {a1:.4},A2 {a2:.4},A3 {a3:.4},A4 {a4:.4},A5 {a5:.4},A6 {a6:.4}}}\r\n\
         LIN {{X 30.000,Y 0.000,Z -0.500,A 90.0000,B 0.0000,C 180.0000}}\r\n\
         $VEL.CP=0.005000\r\n\
         LIN {{X 30.000,Y 0.000,Z -2.000,A 90.0000,B 0.0000,C 180.0000}}\r\n\
         $VEL.CP=0.020000\r\n"
    );
    let after = after.replace("A 0.0000,B 0.0000,C 180.0000", "A 90.0000,B 0.0000,C 180.0000");
    format!("{before}{way}{}{after}", cut.replace("A 0.0000", "A 90.0000"))
}

#[test]
fn a_cut_that_is_left_along_the_tool_and_entered_at_the_same_place_is_proven_where_the_cell_allows_it()
 {
    let (source, machine) = (source(LINE), reentering());
    let text = left_at_30(&source, &machine);
    let report = proof_of(&source, &machine, &text);
    assert!(report.proven, "{text}\n{:#?}", report.mismatches);
    let left = &report.excursions[0];
    let line = 1 + text.lines().position(|line| line.contains("Z -0.500,A 0.0000")).unwrap();
    assert_eq!((left.source_line, left.first_program_line), (10, line as u32), "{left:?}");
    assert_eq!(left.last_program_line, line as u32 + 6, "{left:?}");
    assert!((left.lift_mm - 62.0).abs() < 1e-2, "{left:?}");
    // Without a word of the cell it is a motion that the source does not have.
    let report = proof_of(&source, &machine::load("kuka-kr6-r900").unwrap(), &text);
    assert_eq!(report.mismatches[0].rule.name(), "path", "{:?}", report.mismatches);
}

#[test]
fn a_cut_that_is_left_otherwise_is_refused() {
    let (source, machine) = (source(LINE), reentering());
    let text = left_at_30(&source, &machine);
    let back = "LIN {X 30.000,Y 0.000,Z -2.000,A 90.0000,B 0.0000,C 180.0000}\r\n";
    let up = "LIN {X 30.000,Y 0.000,Z 60.000,A 0.0000,B 0.0000,C 180.0000}\r\n";
    let on = "LIN {X 60.000,Y 0.000,Z -2.000,A 90.0000";
    let ptp =
        text.lines().rfind(|line| line.starts_with("PTP {A1") && !line.contains("A2 -90")).unwrap();
    let elsewhere = {
        let [a1, a2, a3, a4, a5, a6] = joints(&machine, [32.0, 0.0, 60.0], 90.0);
        format!("PTP {{A1 {a1:.4},A2 {a2:.4},A3 {a3:.4},A4 {a4:.4},A5 {a5:.4},A6 {a6:.4}}}")
    };
    let damages: &[(&str, &str, &str)] = &[
        // In again farther on, higher, or deeper.
        (back, &back.replace("X 30.000", "X 31.000"), "extra-motion"),
        (back, &back.replace("Y 0.000", "Y 0.050"), "extra-motion"),
        (back, &back.replace("Z -2.000", "Z -1.000"), "extra-motion"),
        (back, &back.replace("Z -2.000", "Z -2.100"), "extra-motion"),
        (back, "", "extra-motion"),
        // Out sideways, or leaning.
        (
            "LIN {X 30.000,Y 0.000,Z -0.500,A 0.0000",
            "LIN {X 30.000,Y 1.000,Z -0.500,A 0.0000",
            "path",
        ),
        (up, &up.replace("X 30.000", "X 35.000"), "extra-motion"),
        (up, &up.replace("A 0.0000", "A 90.0000"), "extra-motion"),
        // The turn is made too low.
        (&format!("$VEL.CP=0.100000\r\n{up}"), &up.replace("Z 60.000", "Z -1.800"), "rapid-path"),
        // Above the cut, and below where the feed into the part begins.
        (up, &up.replace("Z 60.000", "Z 20.000"), "rapid-path"),
        // Over another place.
        (ptp, &elsewhere, "extra-motion"),
        // A corner is passed out of the cut.
        (back, &back.replace("}\r\n", "} C_DIS\r\n"), "path-tolerance"),
        // Too fast near the cut.
        (
            "$VEL.CP=0.005000\r\nLIN {X 30.000,Y 0.000,Z -0.500",
            "$VEL.CP=0.010000\r\nLIN {X 30.000,Y 0.000,Z -0.500",
            "feed",
        ),
        (&format!("$VEL.CP=0.005000\r\n{back}"), back, "feed"),
        // Something else happens meanwhile, or a part of the cut is missing.
        (back, &format!("$OUT[1]=FALSE\r\n{back}"), "missing"),
        (back, &format!("WAIT SEC 1.0\r\n{back}"), "missing"),
        (on, &on.replace("X 60.000", "X 29.000"), "path"),
        (on, &on.replace("Y 0.000", "Y 0.100"), "path"),
    ];
    for (from, to, rule) in damages {
        let damaged = text.replacen(from, to, 1);
        assert_ne!(damaged, text, "{from}");
        let report = proof_of(&source, &machine, &damaged);
        let found: Vec<&str> = report.mismatches.iter().map(|found| found.rule.name()).collect();
        assert_eq!(found, [*rule], "{from} -> {to}: {:#?}", report.mismatches);
    }
}

/// Robots that have to turn their wrist over on [`rings`], with a place of the part at which they reach it, and why.
const TURNING: [(&str, &str, &str, &str); 3] = [
    (
        "kuka-kr6-r900",
        "part = [450, 0, 150, 0, 0, 0]",
        "part = [700, 0, 0, 0, 0, 0]",
        "joint 4 would have turned through all of its range",
    ),
    (
        "abb-irb120-mill",
        "part = [350, 0, 150, 0, 0, 0]",
        "part = [620, 0, 0, 0, 0, 0]",
        "no turn about the tool",
    ),
    (
        "fanuc-lrmate-200id-mill",
        "part = [450, 0, -180, 0, 0, 0]",
        "part = [680, 25, -330, 0, 0, 0]",
        "joint 4 would have turned through all of its range",
    ),
];

#[test]
fn a_cut_that_no_posture_carries_is_left_and_entered_again_and_the_line_is_reported() {
    let source = rings(150);
    for (name, from, to, why) in TURNING {
        let part = crate::robot::changed(name, &[(from, to)]);
        let found = &post::write(&source, &part).unwrap_err()[0];
        assert_eq!(found.rule.name(), "arm-path", "{found}");
        assert!(found.message.contains(why) && found.help.contains("reentry_feed"), "{found}");
        let machine = crate::robot::changed(name, &[(from, &format!("{to}\nreentry_feed = 600"))]);
        let output = post::write(&source, &machine).unwrap();
        assert!(output.warnings.iter().all(|found| found.rule.name() == "rewind"));
        let lines = |found: &program::Diagnostic| [vec![found.line], found.lines.clone()].concat();
        let mut left: Vec<u32> = output.warnings.iter().flat_map(lines).collect();
        left.sort_unstable();
        assert_eq!(left[0], found.line, "{name}");
        let text = String::from_utf8(output.text).unwrap();
        let report = proof_of(&source, &machine, &text);
        assert!(report.proven, "{name} {:#?}", report.mismatches);
        assert_eq!(report.compared.lines, 151);
        // But for the lift before the way home.
        let end = last_line(&source);
        let places = report.excursions.iter().map(|place| place.source_line);
        let places: Vec<u32> = places.filter(|line| *line != end).collect();
        assert_eq!(places, left, "{name}");
        // A program whose way is left out, but for the first line, is refused.
        let (first, last) =
            (report.excursions[0].first_program_line, report.excursions[0].last_program_line);
        for leave_out in first..=last {
            let kept = proof_of(&source, &machine, &without(&text, leave_out)).proven;
            assert!(
                !kept || !text.lines().nth(leave_out as usize - 1).unwrap().contains("PTP"),
                "{leave_out}"
            );
        }
    }
}

/// Line of the last motion of a source.
fn last_line(source: &Program) -> u32 {
    let mut moves = source.records.iter().rev().filter(|record| record.op.pose().is_some());
    moves.next().unwrap().line
}

/// A text without one of its lines, number from 1.
fn without(text: &str, leave_out: u32) -> String {
    let lines = text.split_inclusive('\n').zip(1..);
    lines.filter(|(_, number)| *number != leave_out).map(|(line, _)| line).collect()
}

#[test]
fn a_cut_within_a_circle_is_left_between_the_arcs_that_it_is_written_in() {
    // Twice round the foot of a UR5e: joint 1 turns by two revolutions at the most, less two degrees.
    let twice = "PARTNO/TWICE\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/400,0,60\nFEDRAT/MMPM,600\nGOTO/400,0,0\n\
        CIRCLE/0,0,0,0,0,1,400\nGOTO/400,0,0\nCIRCLE/0,0,0,0,0,1,400\nGOTO/400,0,0\nRAPID\nGOTO/400,0,60\nFINI\n";
    let part = "part = [0, 0, 100, 0, 0, 0]";
    let from = "part = [450, 0, 150, 0, 0, 0]";
    let source = source(twice);
    let found = &post::write(&source, &crate::robot::changed("universal-ur5e", &[(from, part)]))
        .unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("arm-path", 12), "{found}");
    assert!(found.message.contains("joint 1") && found.help.contains("reentry_feed"), "{found}");
    let again = format!("{part}\nreentry_feed = 400");
    let machine = crate::robot::changed("universal-ur5e", &[(from, &again)]);
    let text = proven(&source, &machine);
    let report = proof_of(&source, &machine, &text);
    // The other one is the lift before the way home.
    assert_eq!((report.compared.arcs, report.excursions.len()), (2, 2), "{text}");
    let excursion = &report.excursions[0];
    assert_eq!(excursion.source_line, 12);
    // It is left half way round.
    let line = |number: u32| text.lines().nth(number as usize - 1).unwrap();
    let (first, last) = (excursion.first_program_line, excursion.last_program_line);
    assert!(line(first - 1).starts_with("movec") && line(last + 1).starts_with("movec"), "{text}");
    assert!(line(last).contains("p[-0.400000,0.000000,0.000000,"), "{text}");
    // Another line of a safe lift may be missing; the first, the joints and the last may not.
    for number in [first, last] {
        assert!(!proof_of(&source, &machine, &without(&text, number)).proven, "{number}");
    }
    let joints = (first..=last).find(|number| line(*number).starts_with("movej")).unwrap();
    assert!(!proof_of(&source, &machine, &without(&text, joints)).proven);
    for (from, to) in [
        // In again 1 mm aside, 0.1 mm deeper, elsewhere on the circle.
        ("p[-0.400000,0.000000,0.000000,", "p[-0.400000,0.001000,0.000000,"),
        ("p[-0.400000,0.000000,0.000000,", "p[-0.400000,0.000000,-0.000100,"),
        ("p[-0.400000,0.000000,0.000000,", "p[0.000000,0.400000,0.000000,"),
    ] {
        let changed = line(last).replace(from, to);
        assert_ne!(changed, line(last));
        let before: Vec<&str> = text.lines().take(last as usize - 1).collect();
        let behind: Vec<&str> = text.lines().skip(last as usize).collect();
        let damaged = format!("{}\n{changed}\n{}\n", before.join("\n"), behind.join("\n"));
        assert!(!proof_of(&source, &machine, &damaged).proven, "{changed}");
    }
}

#[test]
fn the_range_that_cables_leave_to_a_joint_is_kept_in_cuts_and_in_the_air() {
    let (source, machine) = (source(crate::robot::JOB), machine::load("kuka-kr6-r900").unwrap());
    let text = proven(&source, &machine);
    let with = |range: &str| {
        let cables = format!("rapid = 6000\ncable_joint_6 = {range}");
        crate::robot::changed("kuka-kr6-r900", &[("rapid = 6000", &cables)])
    };
    let axis_6 = |text: &str| -> Vec<f64> {
        let of = |path| match path {
            control::ArmPath::Joints(joints) => Some(joints[5]),
            _ => None,
        };
        crate::robot::paths(control::Dialect::Krl, text).into_iter().filter_map(of).collect()
    };
    // The choice of all turns takes one that cables do not allow, so the joint comes the other way round, and the proof knows which.
    let most = axis_6(&text).into_iter().map(f64::abs).fold(0.0, f64::max);
    assert!(most > 100.0, "{text}");
    let narrow = with("[-20, 200]");
    let other = proven(&source, &narrow);
    assert!(axis_6(&other).iter().all(|at| (-20.0..=200.0).contains(at)), "{other}");
    let report = proof_of(&source, &narrow, &text);
    assert_eq!(report.mismatches[0].rule.name(), "axis-limit", "{:?}", report.mismatches);
    // A whole turn in the air, to the same pose: the maker's limits allow it, cables do not.
    let start = axis_6(&other).into_iter().find(|at| *at != 0.0).unwrap_or(0.0);
    let (from, to) = (
        format!("A6 {start:.4}"),
        format!("A6 {:.4}", start + if start > 0.0 { -360.0 } else { 360.0 }),
    );
    assert!((start + if start > 0.0 { -360.0 } else { 360.0_f64 }).abs() < 350.0, "{start}");
    let damaged = other.replace(&from, &to);
    assert_ne!(damaged, other, "{other}");
    let report = proof_of(&source, &narrow, &damaged);
    assert_eq!(report.mismatches[0].rule.name(), "axis-limit", "{:?}", report.mismatches);
    // Ranges that are none.
    let path = crate::files::root().join("machines/robots/kuka-kr6-r900.toml");
    let text = std::fs::read_to_string(path).unwrap();
    for (range, what) in [
        ("[-400, 100]", "beyond the limits of the joint"),
        ("[100, -100]", "the lower one first"),
        ("[10]", "cable_joint_6"),
    ] {
        let text = text.replace("rapid = 6000", &format!("rapid = 6000\ncable_joint_6 = {range}"));
        let found = machine::load_text("mine.toml", &text).unwrap_err();
        assert!(found.to_string().contains(what), "{found}");
    }
}

/// The joints of the KR 6 with a joint 4 that turns three times either way.
const ROUND: &str = "model = \"kuka-kr6-r900-sixx\"\njoints = [{ min = -170, max = 170, speed = 360 }, { min = -190, max = 45, speed = 300 }, \
{ min = -120, max = 156, speed = 360 }, { min = -1080, max = 1080, speed = 381 }, { min = -120, max = 120, speed = 388 }, \
{ min = -350, max = 350, speed = 615 }]";

#[test]
fn a_joint_that_goes_round_carries_the_whole_cut_until_cables_end_it() {
    let source = rings(120);
    let (_, from, to, _) = TURNING[0];
    let round = |more: &str| {
        let part = format!("{to}{more}");
        let model = "model = \"kuka-kr6-r900-sixx\"";
        let home = ("home = [0, -90, 90, 0, 45, 0]", "home = [0, -90, 120, 0, 30, 0]");
        crate::robot::changed("kuka-kr6-r900", &[(from, &part), (model, ROUND), home])
    };
    let machine = round("");
    let text = proven(&source, &machine);
    assert!(proof_of(&source, &machine, &text).excursions.is_empty());
    // Along the lines of the program no joint is printed: the proof counts the revolutions of joint 4 all the same.
    let cables = round("\ncable_joint_4 = [-185, 185]");
    let report = proof_of(&source, &cables, &text);
    let found = &report.mismatches[0];
    assert_eq!(found.rule.name(), "axis-limit", "{found}");
    assert!(found.message.contains("joint 4 would be"), "{found}");
    let found = &post::write(&source, &cables).unwrap_err()[0];
    assert!(found.message.contains("joint 4 would have turned"), "{found}");
    let leaving = round("\ncable_joint_4 = [-185, 185]\nreentry_feed = 600");
    let text = proven(&source, &leaving);
    assert!(!proof_of(&source, &leaving, &text).excursions.is_empty());
}

#[test]
fn what_cables_do_not_allow_names_them() {
    let with = |key: &str| {
        let cables = format!("rapid = 6000\n{key}");
        crate::robot::changed("kuka-kr6-r900", &[("rapid = 6000", &cables)])
    };
    let job = source(
        &std::fs::read_to_string(crate::files::root().join("machines/samples/robot.cls")).unwrap(),
    );
    let found = &post::write(&job, &with("cable_joint_6 = [10, 90]")).unwrap_err()[0];
    assert_eq!(found.rule.name(), "axis-limit", "{found}");
    assert!(found.message.contains("joint 6 at 0 degrees"), "{found}");
    assert!(
        found.help.contains("`cable_joint_6` below [cell] keeps joint 6 within 10 to 90"),
        "{found}"
    );
    let narrow = with("cable_joint_4 = [-3, 3]");
    let found = &post::write(&job, &narrow).unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("arm-path", 36), "{found}");
    assert!(
        found.help.contains("`cable_joint_4` below [cell] keeps joint 4 within -3 to 3"),
        "{found}"
    );
    let text = proven(&job, &with(""));
    let found = &proof_of(&job, &narrow, &text).mismatches[0];
    assert_eq!(found.rule.name(), "axis-limit", "{found}");
    assert!(found.help.contains("`cable_joint_4`"), "{found}");
}

#[test]
fn another_posture_than_that_of_home_is_named_and_the_way_home_at_the_end_has_a_line() {
    // A ring with the tool 15° off upright, which the wrist passes turned over alone.
    let mut text =
        String::from("PARTNO/C\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\n");
    let (sin, cos) = 15_f64.to_radians().sin_cos();
    let mut goto = |step: u32, height: f64| {
        let (j, i) = (f64::from(step) * 10_f64.to_radians()).sin_cos();
        let out = 40.0 + height * sin;
        let axis = [i * sin, j * sin, cos];
        text += &format!(
            "GOTO/{:.4},{:.4},{:.4},{:.7},{:.7},{:.7}\n",
            out * i,
            out * j,
            height * cos,
            axis[0],
            axis[1],
            axis[2]
        );
        text += if height > 0.0 && step == 0 { "FEDRAT/MMPM,600\n" } else { "" };
    };
    goto(0, 60.0);
    (0..=36).for_each(|step| goto(step, 0.0));
    text += "RAPID\n";
    let (i, k) = (sin, cos);
    let ring = source(&format!(
        "{text}GOTO/{:.4},0,{:.4},{i:.7},0,{k:.7}\nFINI\n",
        40.0 + 60.0 * sin,
        60.0 * cos
    ));
    let found = &post::write(&ring, &machine::load("kuka-kr6-r900").unwrap()).unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("rapid-path", 6), "{found}");
    assert!(
        found.help.contains("the wrist turned over (joint 5)") && found.help.contains("`home`"),
        "{found}"
    );
    // The ring begins from a home like that, and joint 4 comes back with a revolution that leads round.
    let home = ("home = [0, -90, 90, 0, 45, 0]", "home = [0, -90, 90, -180, -45, 0]");
    let found =
        &post::write(&ring, &crate::robot::changed("kuka-kr6-r900", &[home])).unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("rapid-path", 46), "{found}");
    assert!(found.message.contains("way home"), "{found}");
}

#[test]
fn where_cables_leave_joint_6_little_the_cuts_are_made_in_the_posture_of_home() {
    let changes = [("rapid = 6000", "rapid = 6000\ncable_joint_6 = [-30, 30]")];
    let machine = crate::robot::changed("kuka-kr6-r900", &changes);
    // Home has joint 5 at 45 degrees: a wrist that were turned over would swing the tool through the part on the way.
    let text = proven(&source(LINE), &machine);
    for line in text.lines().filter(|line| line.starts_with("PTP")) {
        let (_, a5) = line.split_once("A5 ").unwrap();
        assert!(!a5.starts_with('-'), "{text}");
    }
}

#[test]
fn a_cut_that_cannot_be_entered_again_is_not_offered_a_word_of_the_cell() {
    // Behind line 1078 of the dome no turn of the M-20iA leads on but with the elbow below, to which no way above the cuts leads.
    let dome = dome().replace("MMPM,1500", "MMPM,1200");
    let dome = source(&dome);
    let machine = machine::load("fanuc-m20ia-mill").unwrap();
    let found = &post::write(&dome, &machine).unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("arm-path", 1078), "{found}");
    assert!(found.help.contains("toolpost fit") && !found.help.contains("reentry_feed"), "{found}");
}

fn dome() -> String {
    std::fs::read_to_string(crate::files::root().join("examples/dome.cls")).unwrap()
}

#[test]
fn joints_are_chosen_for_the_feed_where_the_control_does_not_say_how_fast_the_tool_turns() {
    // At line 225 the tool leans by 0.77 degrees on 0.096 mm: at 1500 mm/min by 195 degrees/s.
    let cell = "rapid = 6000\ncable_joint_4 = [-120, 120]\nreentry_feed = 400";
    let spindle = ("spindle = [0, 0, 100, 0, 0, 0]", "spindle = [0, 0, 100, 0, 30, 0]");
    let machine = crate::robot::changed("fanuc-r2000ic-mill", &[("rapid = 6000", cell), spindle]);
    proven(&source(&dome()), &machine);
}

/// A line along X in steps of so many mm, on each of which the tool leans by 0.2 degrees more away from the arm.
fn leaning(step: f64, feed: u32) -> Program {
    let goto = |x: f64, z: f64, lean: f64| {
        let (i, k) = lean.to_radians().sin_cos();
        format!("GOTO/{x:.5},0,{z},{i:.9},0,{k:.9}\n")
    };
    let cut: String = (1..=20).map(f64::from).map(|i| goto(i * step, 0.0, 0.2 * i)).collect();
    let up = goto(20.0 * step, 60.0, 4.0);
    source(&format!(
        "PARTNO/LEAN\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\n\
         GOTO/0,0,0\nFEDRAT/MMPM,{feed}\n{cut}RAPID\n{up}FINI\n"
    ))
}

#[test]
fn a_feed_at_which_the_tool_would_turn_faster_than_the_program_states_is_refused_with_the_line() {
    let [kuka, abb] = ["kuka-kr6-r900", "abb-irb120-mill"].map(|name| machine::load(name).unwrap());
    // 0.2 degrees on 0.05 mm: 100 degrees/s at 1500 mm/min. $VEL.ORI1 is 60 degrees/s.
    let found = &post::write(&leaning(0.05, 1500), &kuka).unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("feed", 11), "{found}");
    assert!(found.help.contains("900 mm/min") && found.help.contains("turn_speed"), "{found}");
    proven(&leaning(0.05, 900), &kuka);
    // RAPID states 500 degrees/s.
    proven(&leaning(0.05, 1500), &abb);
}

#[test]
fn a_tool_that_turns_where_its_tip_stays_is_refused_where_nothing_states_how_fast() {
    let turning = leaning(0.0, 1500);
    let fanuc = machine::load("fanuc-lrmate-200id-mill").unwrap();
    let found = &post::write(&turning, &fanuc).unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("arm-path", 11), "{found}");
    assert!(found.message.contains("nothing states how fast the tool turns"), "{found}");
    proven(&turning, &machine::load("kuka-kr6-r900").unwrap());
}

#[test]
fn a_refusal_within_an_arc_says_that_a_cut_is_left_at_its_end_alone() {
    // Round the KUKA's own foot, below it, from one side over its back: joint 1 turns by 170 degrees at the most.
    let round = "PARTNO/ROUND\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,-600,50\nFEDRAT/MMPM,1200\nGOTO/0,-600,0\n\
        GOTO/-200,-565.685425,0\nCIRCLE/0,0,0,0,0,-1,600\nGOTO/-200,565.685425,0\nRAPID\nGOTO/-200,565.685425,50\nFINI\n";
    let part =
        ("part = [450, 0, 150, 0, 0, 0]", "part = [0, 0, -350, 0, 0, 0]\nreentry_feed = 600");
    let machine = crate::robot::changed("kuka-kr6-r900", &[part]);
    let found = &post::write(&source(round), &machine).unwrap_err()[0];
    assert_eq!((found.rule.name(), found.line), ("arm-path", 11), "{found}");
    assert!(found.message.contains("joint 1"), "{found}");
    assert!(found.help.contains("divide the arc there in the source"), "{found}");
}

#[test]
fn the_largest_speed_of_a_joint_on_the_way_is_that_of_the_margins() {
    let dome = source(&dome());
    for name in ["universal-ur5e", "universal-ur10e"] {
        let machine = machine::load(name).unwrap();
        let (samples, margins) = post::arm_samples(&dome, &machine).unwrap();
        let on_way = samples.iter().flat_map(|sample| sample.speeds).fold(0.0, f64::max);
        let stated = margins.unwrap().speed / 100.0;
        assert!((on_way / stated - 1.0).abs() < 0.05, "{name}: {on_way} {stated}");
    }
}
