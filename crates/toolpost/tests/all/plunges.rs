//! Robots out of holes and slots that they have plunged into, and back in: the joints lead a tool aside, which only a straight line does not.

use crate::robot::{joints, paths, proof_of, proven, source};
use control::{ArmPath, Dialect};
use geom::{Frame, Vec3};
use machine::Machine;
use program::Program;

/// A source of these statements between its first rapid and its last one, 65 mm above the part.
fn at_100_50(cuts: &str) -> Program {
    let head = "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/100,50,65\nFEDRAT/MMPM,300\n";
    source(&format!("{head}{cuts}SPINDL/OFF\nFINI\n"))
}

/// A hole drilled by moves, its feed from 60 mm above the bottom on.
fn deep() -> Program {
    at_100_50("RAPID\nGOTO/100,50,60\nGOTO/100,50,0\nRAPID\nGOTO/100,50,65\n")
}

/// The same in two pecks, the second entered by rapid.
fn pecks() -> Program {
    at_100_50(
        "RAPID\nGOTO/100,50,2\nGOTO/100,50,-30\nRAPID\nGOTO/100,50,2\nRAPID\nGOTO/100,50,-29\nGOTO/100,50,-60\nRAPID\nGOTO/100,50,65\n",
    )
}

/// A slot as deep as its plunge, left at its other end.
fn slot() -> Program {
    at_100_50("RAPID\nGOTO/100,50,2\nGOTO/100,50,-60\nGOTO/100,90,-60\nRAPID\nGOTO/100,90,65\n")
}

/// A hole that was there before: the feed begins 1 mm above its bottom.
fn drilled_before() -> Program {
    at_100_50("RAPID\nGOTO/100,50,-29\nGOTO/100,50,-30\nRAPID\nGOTO/100,50,65\n")
}

/// The same, entered and left with stops on the way, which are no other holes.
fn by_stops() -> Program {
    at_100_50(
        "RAPID\nGOTO/100,50,5\nRAPID\nGOTO/100,50,-20\nRAPID\nGOTO/100,50,-40\nGOTO/100,50,-60\nRAPID\nGOTO/100,50,-50\nRAPID\nGOTO/100,50,-30\n\
         RAPID\nGOTO/100,50,65\n",
    )
}

/// Pecks of a cycle at the bottom of a hole, and a rapid behind them.
fn cycle_below() -> Program {
    at_100_50(
        "CYCLE/DEEP,RAPTO,2,FEDTO,40,RTRCTO,10,MMPM,150,STEP,12\nGOTO/100,50,-40\nCYCLE/OFF\nRAPID\nGOTO/100,50,65\n",
    )
}

/// The same, with nothing behind them: the arm goes home from within the hole.
fn ends_below() -> Program {
    at_100_50(
        "CYCLE/DEEP,RAPTO,2,FEDTO,40,RTRCTO,10,MMPM,150,STEP,12\nGOTO/100,50,-40\nCYCLE/OFF\n",
    )
}

/// The program of the KUKA, with its line behind the last cut to `tip` made by the joints.
fn left_by_joints(text: &str, machine: &Machine, tip: [f64; 3]) -> String {
    let [x, y, z] = tip;
    let line = format!("LIN {{X {x:.3},Y {y:.3},Z {z:.3},A ");
    let at = text.rfind(&line).unwrap_or_else(|| panic!("{line}\n{text}"));
    let (before, after) = text.split_at(at);
    let (own, rest) = after.split_once("}\r\n").unwrap();
    let turn = own.trim_start_matches(&line).split(',').next().unwrap().parse().unwrap();
    let [a1, a2, a3, a4, a5, a6] = joints(machine, tip, turn);
    format!(
        "{before}PTP {{A1 {a1:.4},A2 {a2:.4},A3 {a3:.4},A4 {a4:.4},A5 {a5:.4},A6 {a6:.4}}}\r\n{rest}"
    )
}

#[test]
fn joints_that_lead_the_tool_aside_within_a_plunge_are_refused() {
    let machine = machine::load("kuka-kr6-r900").unwrap();
    for (source, tip, why) in [
        (deep(), [100.0, 50.0, 65.0], "below where the source begins to feed"),
        (pecks(), [100.0, 50.0, 65.0], "beyond the cuts"),
        (pecks(), [100.0, 50.0, -29.0], "below where the source begins to feed"),
        (slot(), [100.0, 90.0, 65.0], "below where the source begins to feed"),
        (drilled_before(), [100.0, 50.0, 65.0], "not left below its higher end"),
        (drilled_before(), [100.0, 50.0, -29.0], "not left below its higher end"),
        (by_stops(), [100.0, 50.0, 65.0], "not left below its higher end"),
        (by_stops(), [100.0, 50.0, -20.0], "not left below its higher end"),
        (cycle_below(), [100.0, 50.0, 65.0], "not left below its higher end"),
    ] {
        let text = left_by_joints(&proven(&source, &machine), &machine, tip);
        let report = proof_of(&source, &machine, &text);
        let found = report.mismatches.first().unwrap_or_else(|| panic!("{tip:?} proven\n{text}"));
        assert_eq!(found.rule.name(), "rapid-path", "{found}");
        assert!(found.message.contains(why), "{found}");
    }
}

#[test]
fn above_where_a_plunge_begins_the_joints_may_go() {
    let machine = machine::load("kuka-kr6-r900").unwrap();
    let text = proven(&deep(), &machine);
    // Straight up to where the feed began, and on by the joints.
    let line = "LIN {X 100.000,Y 50.000,Z 65.000,A ";
    let (_, after) = text.split_at(text.rfind(line).unwrap());
    let (own, _) = after.split_once("\r\n").unwrap();
    let by_joints = left_by_joints(&text, &machine, [100.0, 50.0, 65.0]);
    let at = by_joints.rfind("PTP {").unwrap();
    let at = by_joints[..at].rfind("PTP {").unwrap();
    let low = own.replace("Z 65.000", "Z 60.000");
    let text = format!("{}{low}\r\n{}", &by_joints[..at], &by_joints[at..]);
    let report = proof_of(&deep(), &machine, &text);
    assert!(report.proven, "{text}\n{:#?}", report.mismatches);
}

/// The ends of all motions of joints of more than 30 mm, and where the tool was before each: shorter ones stay near enough to the line.
fn ends_of_joints(machine: &Machine, text: &str) -> Vec<Vec3> {
    let (arm, cell) = (machine.arm.as_ref().unwrap(), machine.cell.as_ref().unwrap());
    let dialect = Dialect::named(&machine.reader).unwrap();
    let tool = cell.tool(Some(50.0)).unwrap();
    // URScript states its poses in the world.
    let in_part = |end: &Frame| match dialect {
        Dialect::UrScript => (cell.part.inverse() * *end).translation,
        _ => end.translation,
    };
    let (mut ends, mut here) = (Vec::new(), None);
    for path in paths(dialect, text) {
        let end = match &path {
            ArmPath::Line(end) | ArmPath::Arc { end, .. } => in_part(end),
            ArmPath::Joints(shown) => {
                let joints = arm.model(&shown.map(f64::to_radians)).unwrap();
                (cell.part.inverse() * arm.flange(&joints) * tool).translation
            }
            ArmPath::Point(_) => panic!("{text}"),
        };
        if matches!(path, ArmPath::Joints(_)) {
            let from = here.filter(|from: &Vec3| from.distance(end) > 30.0);
            ends.extend(from.into_iter().flat_map(|from| [from, end]));
        }
        here = Some(end);
    }
    ends
}

#[test]
fn out_of_plunges_and_back_in_every_robot_goes_straight() {
    let leaning = crate::robot::changed(
        "fanuc-r2000ic-mill",
        &[("spindle = [0, 0, 100, 0, 0, 0]", "spindle = [0, 0, 100, 0, 30, 0]")],
    );
    let names = ["kuka-kr6-r900", "fanuc-lrmate-200id-mill", "abb-irb120-mill", "universal-ur5e"];
    let library = names.map(|name| machine::load(name).unwrap());
    for machine in library.iter().chain([&leaning]) {
        for (source, top) in [
            (deep(), 60.0),
            (pecks(), 2.0),
            (slot(), 2.0),
            (drilled_before(), 65.0),
            (by_stops(), 65.0),
            (cycle_below(), 65.0),
            (ends_below(), 65.0),
        ] {
            let text = proven(&source, machine);
            let lowest =
                ends_of_joints(machine, &text).iter().fold(f64::INFINITY, |z, end| z.min(end.z));
            assert!(lowest > top - 0.05, "{}: {lowest}\n{text}", machine.name);
        }
    }
}

/// The first rapid of the source leads into a hole that was there before: nobody knows from where, and the tool comes from as high as it leaves.
#[test]
fn from_home_the_tool_comes_into_a_hole_from_above() {
    let text = "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/100,50,-40\nFEDRAT/MMPM,300\nGOTO/100,50,-60\nRAPID\n\
                GOTO/100,50,65\nSPINDL/OFF\nFINI\n";
    let (source, machine) = (source(text), machine::load("kuka-kr6-r900").unwrap());
    let text = proven(&source, &machine);
    let lowest = ends_of_joints(&machine, &text).iter().fold(f64::INFINITY, |z, end| z.min(end.z));
    assert!(lowest > 65.0 - 0.05, "{lowest}\n{text}");
    let by_joints = left_by_joints(&text, &machine, [100.0, 50.0, -40.0]);
    let report = proof_of(&source, &machine, &by_joints);
    assert_eq!(report.mismatches[0].rule.name(), "rapid-path", "{by_joints}");
}

#[test]
fn the_way_home_by_joints_is_refused_from_where_the_source_goes_higher() {
    let (source, machine) = (ends_below(), machine::load("kuka-kr6-r900").unwrap());
    let text = proven(&source, &machine);
    // Without the line up to there.
    let at = text.rfind("LIN {X 100.000,Y 50.000,Z 65.000,").unwrap_or_else(|| panic!("{text}"));
    let end = at + text[at..].find("\r\n").unwrap() + 2;
    let damaged = format!("{}{}", &text[..at], &text[end..]);
    let report = proof_of(&source, &machine, &damaged);
    let found = report.mismatches.first().unwrap_or_else(|| panic!("proven\n{damaged}"));
    assert_eq!(found.rule.name(), "rapid-path", "{found}");
    assert!(found.message.contains("lower along the tool"), "{found}");
}
