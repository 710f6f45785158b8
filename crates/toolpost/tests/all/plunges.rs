//! Robots out of holes, slots and pockets, and back in: the joints lead a tool aside, which only a straight line does not.

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

/// Two holes on the floor of a pocket that was there before: entered from home by two rapids, and the tool goes across within the pocket.
fn two_below() -> Program {
    source(
        "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/100,50,-20\nRAPID\nGOTO/100,50,-38\nFEDRAT/MMPM,300\n\
         GOTO/100,50,-60\nRAPID\nGOTO/100,50,-38\nRAPID\nGOTO/100,90,-38\nGOTO/100,90,-60\nRAPID\nGOTO/100,90,65\nSPINDL/OFF\nFINI\n",
    )
}

/// Out of the same hole by ways that are no line: a kink, off the wall behind a cycle, back down.
fn by_kinks() -> [Program; 3] {
    let bored = "RAPID\nGOTO/100,50,-40\nGOTO/100,50,-60\n";
    let out = |way: &str| at_100_50(&format!("{bored}{way}"));
    [
        out("RAPID\nGOTO/100,50,-20\nRAPID\nGOTO/110,50,65\n"),
        out("RAPID\nGOTO/100,50,-30\nRAPID\nGOTO/100.3,50,-30\nRAPID\nGOTO/100.3,50,65\n"),
        out(
            "RAPID\nGOTO/100,50,-30\nRAPID\nGOTO/100,50,-35\nRAPID\nGOTO/100,50,-10\nRAPID\nGOTO/100,50,65\n",
        ),
    ]
}

/// The same tool is called within the hole: the arm goes home and comes back.
fn called_below() -> Program {
    at_100_50(
        "RAPID\nGOTO/100,50,-40\nGOTO/100,50,-60\nRAPID\nGOTO/100,50,-30\nLOADTL/1,LENGTH,50\nRAPID\nGOTO/100,50,65\n",
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
    let [kinked, off_wall, down_again] = by_kinks();
    for (source, tip) in [
        (deep(), [100.0, 50.0, 65.0]),
        (pecks(), [100.0, 50.0, 65.0]),
        (pecks(), [100.0, 50.0, -29.0]),
        (slot(), [100.0, 90.0, 65.0]),
        (drilled_before(), [100.0, 50.0, 65.0]),
        (drilled_before(), [100.0, 50.0, -29.0]),
        (by_stops(), [100.0, 50.0, 65.0]),
        (by_stops(), [100.0, 50.0, -20.0]),
        (cycle_below(), [100.0, 50.0, 65.0]),
        (kinked, [110.0, 50.0, 65.0]),
        (off_wall, [100.3, 50.0, 65.0]),
        (down_again, [100.0, 50.0, 65.0]),
        (two_below(), [100.0, 50.0, -20.0]),
        (two_below(), [100.0, 90.0, -38.0]),
    ] {
        let text = left_by_joints(&proven(&source, &machine), &machine, tip);
        let report = proof_of(&source, &machine, &text);
        let found = report.mismatches.first().unwrap_or_else(|| panic!("{tip:?} proven\n{text}"));
        assert_eq!(found.rule.name(), "rapid-path", "{found}");
        let why =
            ["beyond the cuts along the tool", "lower along the tool than the source ever goes"];
        assert!(why.iter().any(|why| found.message.contains(why)), "{found}");
    }
}

#[test]
fn as_high_as_the_source_goes_the_joints_may_lead_elsewhere() {
    let source = at_100_50("RAPID\nGOTO/100,50,2\nGOTO/100,50,-5\nRAPID\nGOTO/100,-50,65\n");
    let machine = machine::load("kuka-kr6-r900").unwrap();
    let text = proven(&source, &machine);
    // The source's own way is straight; instead up along the tool, and on by the joints at two heights.
    let (before, last) = text.split_at(text.rfind("LIN {X 100.000,Y -50.000,Z 65.000,A ").unwrap());
    let (line, after) = last.split_once("\r\n").unwrap();
    let up = |height: f64| line.replace("Y -50.000,Z 65.000", &format!("Y 50.000,Z {height:.3}"));
    let turn = line.split_once("A ").unwrap().1.split(',').next().unwrap().parse().unwrap();
    let [a1, a2, a3, a4, a5, a6] = joints(&machine, [100.0, -50.0, 90.0], turn);
    let over = format!("PTP {{A1 {a1:.4},A2 {a2:.4},A3 {a3:.4},A4 {a4:.4},A5 {a5:.4},A6 {a6:.4}}}");
    for (height, proven) in [(90.0, true), (60.0, false)] {
        let text = format!("{before}{}\r\n{over}\r\n{line}\r\n{after}", up(height));
        let report = proof_of(&source, &machine, &text);
        assert_eq!(report.proven, proven, "{height}\n{text}\n{:#?}", report.mismatches);
    }
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
        let [kinked, off_wall, down_again] = by_kinks();
        for source in [
            deep(),
            pecks(),
            slot(),
            drilled_before(),
            by_stops(),
            cycle_below(),
            ends_below(),
            two_below(),
            kinked,
            off_wall,
            down_again,
            called_below(),
        ] {
            let text = proven(&source, machine);
            let lowest =
                ends_of_joints(machine, &text).iter().fold(f64::INFINITY, |z, end| z.min(end.z));
            assert!(lowest > 65.0 - 0.05, "{}: {lowest}\n{text}", machine.name);
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

/// In a hole that was there before the tool leans by 12 degrees, as it does nowhere above; the arm goes home from there.
fn leans_below() -> Program {
    let lean = "0.2079117,0,0.9781476";
    source(&format!(
        "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/100,50,65,0,0,1\nRAPID\nGOTO/100,50,-38,0,0,1\n\
         RAPID\nGOTO/100,50,-38,{lean}\nFEDRAT/MMPM,300\nGOTO/97.921,50,-47.781,{lean}\nRAPID\nGOTO/100,50,-38,{lean}\nSPINDL/OFF\nFINI\n"
    ))
}

/// A bore that leans by 45 degrees, and a rapid 230 mm above it: up along the tool the way to that height is longer than the arm. With the tool set upright out of
/// the bore it goes straight up, and the refusal says so.
#[test]
fn out_of_a_leaning_bore_an_upright_rapid_leads_home() {
    let machine = machine::load("kuka-kr6-r900").unwrap();
    let lean = "0.7071068,0,0.7071068";
    let job = |upright: &str| {
        source(&format!(
            "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/100,50,250,0,0,1\nRAPID\nGOTO/100,50,20,0,0,1\n\
             RAPID\nGOTO/100,50,20,{lean}\nFEDRAT/MMPM,300\nGOTO/85.8579,50,5.8579,{lean}\nRAPID\nGOTO/100,50,20,{lean}\n{upright}SPINDL/OFF\nFINI\n"
        ))
    };
    let found = post::write(&job(""), &machine).unwrap_err();
    assert_eq!((found[0].rule.name(), found[0].line), ("rapid-path", 15), "{found:?}");
    assert!(
        found[0].help.starts_with("a rapid of the toolpath that sets the tool upright"),
        "{found:?}"
    );
    proven(&job("RAPID\nGOTO/100,50,20,0,0,1\n"), &machine);
}

#[test]
fn the_way_home_by_joints_is_refused_from_where_the_source_goes_higher() {
    let machine = machine::load("kuka-kr6-r900").unwrap();
    for source in [ends_below(), leans_below()] {
        let text = proven(&source, &machine);
        // Without the line up to there.
        let at = text.rfind("LIN {").unwrap_or_else(|| panic!("{text}"));
        let end = at + text[at..].find("\r\n").unwrap() + 2;
        let damaged = format!("{}{}", &text[..at], &text[end..]);
        let report = proof_of(&source, &machine, &damaged);
        let found = report.mismatches.first().unwrap_or_else(|| panic!("proven\n{damaged}"));
        assert_eq!(found.rule.name(), "rapid-path", "{found}");
        let why = "lower along the tool than the source ever goes";
        assert!(found.message.contains(why), "{found}");
    }
}

/// A source that stays within a hole: its zero is taken for the top of the part, and a warning says so.
#[test]
fn into_a_hole_that_the_source_never_leaves_the_tool_comes_from_above_its_zero() {
    let machine = machine::load("kuka-kr6-r900").unwrap();
    let head = "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/100,50,-40\nFEDRAT/MMPM,300\nGOTO/100,50,-60\nRAPID\n";
    for (end, told) in [("GOTO/100,50,-30\n", true), ("GOTO/100,50,5\n", false)] {
        let source = source(&format!("{head}{end}SPINDL/OFF\nFINI\n"));
        let text = proven(&source, &machine);
        let warnings = proof_of(&source, &machine, &text).warnings;
        let found = warnings.iter().find(|found| found.rule.name() == "home-height");
        assert_eq!(
            found.is_some_and(|found| found.message.contains("Z-30.0")),
            told,
            "{warnings:?}"
        );
        let lowest =
            ends_of_joints(&machine, &text).iter().fold(f64::INFINITY, |z, end| z.min(end.z));
        assert!(lowest > 0.95, "{lowest}\n{text}");
        let low = left_by_joints(&text, &machine, [100.0, 50.0, -40.0]);
        assert!(!proof_of(&source, &machine, &low).proven, "{low}");
    }
}

/// A bore in a side wall, entered and left at its upper Z: as high as that along Z the joints would still be within it. Another tool goes higher, upright.
#[test]
fn within_a_bore_of_a_side_wall_the_height_along_z_frees_no_tool() {
    let machine = crate::robot::changed(
        "kuka-kr6-r900",
        &[("part = [450, 0, 150, 0, 0, 0]", "part = [450, 0, 250, 0, 0, 0]")],
    );
    let goto = |y: f64, z: f64| format!("GOTO/0,{y},{z},0,-1,0\n");
    let [out, within, low, deep] =
        [goto(-95.0, 80.0), goto(-45.0, 80.0), goto(-45.0, 60.0), goto(-25.0, 60.0)];
    let source = source(&format!(
        "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nRAPID\nGOTO/0,0,90,0,0,1\nLOADTL/2,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\n{out}\
         RAPID\n{within}RAPID\n{low}FEDRAT/MMPM,300\n{deep}RAPID\n{low}RAPID\n{within}SPINDL/OFF\nFINI\n"
    ));
    let text = proven(&source, &machine);
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("LIN {X ")).collect();
    let [.., out, up] = lines[..] else { panic!("{text}") };
    // Out along the tool, at least to where the source has come from; then straight up along Z.
    let (aside, above) = (tip_of(out), tip_of(up));
    assert!(aside.y <= -95.0 && (aside.z, above.y) == (80.0, aside.y), "{text}");
    assert!(above.z >= 89.95, "{text}");
    let found = |text: &str| {
        let report = proof_of(&source, &machine, text);
        let found = report.mismatches.first().unwrap_or_else(|| panic!("proven\n{text}"));
        found.rule.name()
    };
    // The way in has the same lines.
    let (before, last) = text.split_at(text.rfind(out).unwrap());
    let damaged = |out_now: &str, up_now: &str| {
        let last = last.replacen(&format!("{out}\r\n"), out_now, 1);
        format!("{before}{}", last.replacen(&format!("{up}\r\n"), up_now, 1))
    };
    let y = |line: &str, y: f64| {
        let line = line.replace(&format!("Y {:.3}", aside.y), &format!("Y {y:.3}"));
        format!("{line}\r\n")
    };
    assert_eq!(found(&damaged("", "")), "rapid-path");
    // Up along Z still within the bore, aslant, and from a place that is not out along the tool.
    assert_eq!(found(&damaged(&y(out, -60.0), &y(up, -60.0))), "extra-motion");
    assert_eq!(found(&damaged(&y(out, aside.y), &y(up, aside.y - 1.0))), "extra-motion");
    assert_eq!(found(&damaged("", &y(up, aside.y))), "extra-motion");
    assert!(proof_of(&source, &machine, &damaged(&y(out, aside.y), &y(up, aside.y))).proven);
}

/// A drafted pocket, 40 mm deep, into which the tool comes upright; it leans along the wall, and the source ends there, 86 mm aside.
fn ends_leaning(lean: &str) -> Program {
    let goto = |place: &str| format!("GOTO/{place},{lean}\n");
    let [high, low, along] = ["-26,60,-20", "-30,60,-38", "-30,-60,-38"].map(goto);
    let end = goto("-26,-60,-20");
    source(&format!(
        "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/60,0,5,0,0,1\nRAPID\nGOTO/60,0,-20,0,0,1\n\
         RAPID\n{high}FEDRAT/MMPM,400\n{low}{along}RAPID\n{end}SPINDL/OFF\nFINI\n"
    ))
}

/// The coordinates of a line of a KUKA's program.
fn tip_of(line: &str) -> Vec3 {
    let number = |axis: &str| -> f64 {
        let after = line.split_once(axis).unwrap_or_else(|| panic!("{line}")).1;
        after.split(',').next().unwrap().parse().unwrap()
    };
    Vec3::new(number("{X "), number(",Y "), number(",Z "))
}

/// Leaning by 10 degrees, the tool is in the pocket as high along itself as where it came in: 9.7 mm up along it, which leaves it 10 mm below the top.
#[test]
fn from_a_pocket_a_leaning_tool_goes_straight_until_it_is_as_high_along_z() {
    let machine = crate::robot::changed(
        "kuka-kr6-r900",
        &[("part = [450, 0, 150, 0, 0, 0]", "part = [450, 0, 250, 0, 0, 0]")],
    );
    let source = ends_leaning("-0.17364818,0,0.98480775");
    let text = proven(&source, &machine);
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("LIN {X ")).collect();
    let [.., end, up] = lines[..] else { panic!("{text}") };
    let (from, to) = (tip_of(end), tip_of(up));
    assert!(from.distance(Vec3::new(-26.0, -60.0, -20.0)) < 0.002, "{text}");
    assert!(to.z >= 4.95, "{to}\n{text}");
    let axis = Vec3::new(-0.173_648_18, 0.0, 0.984_807_75);
    assert!((to - from).reject_from_normalized(axis).length() < 0.002, "{to}\n{text}");
    let way = |mm: f64| {
        let [x, y, z] = (from + axis * mm).to_array();
        let turn = up.split_once(",A ").unwrap().1;
        text.replace(up, &format!("LIN {{X {x:.3},Y {y:.3},Z {z:.3},A {turn}"))
    };
    assert!(proof_of(&source, &machine, &way(26.0)).proven, "{text}");
    for mm in [10.0, 24.0] {
        let report = proof_of(&source, &machine, &way(mm));
        let found = report.mismatches.first().unwrap_or_else(|| panic!("{mm} proven\n{text}"));
        assert_eq!(found.rule.name(), "rapid-path", "{found}");
        assert!(found.message.contains("lower along Z than the source ever goes"), "{found}");
    }
}

/// A pocket in a side wall, which the tool enters along -Y and leaves leaning by 10 degrees: 20.1 mm out along itself it is as high along itself as where it came in, and
/// still 5 mm within the mouth, for which it takes 25.4 mm.
#[test]
fn from_a_pocket_of_a_side_wall_a_leaning_tool_goes_straight_until_it_is_out_along_the_way_in() {
    let machine = crate::robot::changed(
        "kuka-kr6-r900",
        &[("part = [450, 0, 150, 0, 0, 0]", "part = [450, 0, 250, 0, 0, 0]")],
    );
    let lean = "-0.17364818,-0.98480775,0";
    let source = source(&format!(
        "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/0,-85,80,0,-1,0\nRAPID\nGOTO/0,-60,80,0,-1,0\n\
         RAPID\nGOTO/-26,-60,60,{lean}\nFEDRAT/MMPM,400\nGOTO/-30,-42,60,{lean}\nGOTO/-30,-42,-60,{lean}\nRAPID\nGOTO/-26,-60,-60,{lean}\nSPINDL/OFF\nFINI\n"
    ));
    let text = proven(&source, &machine);
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("LIN {X ")).collect();
    let [.., end, out, up] = lines[..] else { panic!("{text}") };
    let (from, to) = (tip_of(end), tip_of(out));
    assert!(from.distance(Vec3::new(-26.0, -60.0, -60.0)) < 0.002, "{text}");
    assert!(to.y <= -84.95, "{to}\n{text}");
    let axis = Vec3::new(-0.173_648_18, -0.984_807_75, 0.0);
    assert!((to - from).reject_from_normalized(axis).length() < 0.002, "{to}\n{text}");
    // Out by so much, and straight up along Z from there.
    let found = |mm: f64| {
        let aside = from + axis * mm;
        let mut text = text.clone();
        for line in [out, up] {
            let behind = line.split_once(",Z ").unwrap().1;
            let moved = format!("LIN {{X {:.3},Y {:.3},Z {behind}", aside.x, aside.y);
            text = text.replace(line, &moved);
        }
        let report = proof_of(&source, &machine, &text);
        report.mismatches.first().map(|found| found.rule.name())
    };
    assert_eq!(found(22.0), Some("extra-motion"));
    assert_ne!(found(26.0), Some("extra-motion"));
}

/// A stop at the end of a plunge: the spindle would have to stop there. Drawn back along the tool, by rapid or by feed, the arm stops.
#[test]
fn a_stop_in_the_cut_is_refused() {
    let machine = machine::load("kuka-kr6-r900").unwrap();
    let to = |height: f64| format!("GOTO/100,50,{height}\n");
    let job = |back: &str, from: f64| {
        let down = to(-5.0);
        at_100_50(&format!("{}{down}{back}STOP\n{}RAPID\n{}", to(2.0), to(from), to(65.0)))
    };
    let found = post::write(&job("", -6.0), &machine).unwrap_err();
    assert_eq!((found[0].rule.name(), found[0].line), ("stop-in-cut", 10), "{found:?}");
    let by_feed = job(&to(1.0), -6.0);
    let text = proven(&by_feed, &machine);
    proven(&job(&format!("RAPID\n{}", to(1.0)), -6.0), &machine);
    // The same program without the line that draws the tool back, against the source that has none.
    let (before, after) = text.split_once("LIN {X 100.000,Y 50.000,Z 1.000,").unwrap();
    let (_, after) = after.split_once("\r\n").unwrap();
    let report = proof_of(&job("", -6.0), &machine, &format!("{before}{after}"));
    assert_eq!(report.mismatches[0].rule.name(), "stop-in-cut", "{:?}", report.mismatches);
}

/// An NC program whose zero is at the foot of the block sends Z home, and names no height above 38: the block may be higher.
#[test]
fn a_source_that_sends_z_home_from_a_block_of_unknown_height_is_warned() {
    let mill = machine::load("generic-3axis-linuxcnc").unwrap();
    let machine = machine::load("kuka-kr6-r900").unwrap();
    for (top, cut, end, told) in [
        (38, 18, "G53 G0 Z0\n", true),
        (38, 18, "", false),
        (38, 18, "G0 Z60\nG53 G0 Z0\n", true),
        (38, -18, "G53 G0 Z0\n", false),
    ] {
        let text = format!(
            "G21 G90 G17 G54\nT1 M6\nG43 H1\nS9000 M3\nG0 X100 Y50\nG0 Z{top}\nG1 Z{cut} F150\nG0 Z{top}\nM5\n{end}M30\n"
        );
        let read = nc::read(&mill, Default::default(), "job.ngc", text.as_bytes());
        let source = read.unwrap().program;
        let report = proof_of(&source, &machine, &proven(&source, &machine));
        let found = report.warnings.iter().filter(|found| found.rule.name() == "home-height");
        let found: Vec<_> = found.map(|found| found.message.clone()).collect();
        let height = if end.contains("60") { "Z60.0" } else { "Z38.0" };
        assert_eq!(found.len(), usize::from(told), "{text}\n{found:?}");
        assert!(found.iter().all(|found| found.contains(height)), "{found:?}");
    }
}
