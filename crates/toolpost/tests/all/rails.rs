//! An arm on a rail: the outer axis of programs written by hand and by the writer.

use crate::robot::{JOB, LINE, proof_of, proven, source};
use control::{Action, ArmAction, Dialect, Event};
use machine::Machine;
use program::Program;

/// The KR 6 on a rail of 2 m along Y, on which the part of the library's cell lies 1 m from where the rail stands at home.
fn on_rail() -> Machine {
    let rail = "part = [450, 1000, 150, 0, 0, 0]\nrail = { direction = [0, 2, 0], origin = [0, 0, 0, 0, 0, 0], min = 0, max = 2000, \
                speed = 60000, home = 0 }";
    crate::robot::changed("kuka-kr6-r900", &[("part = [450, 0, 150, 0, 0, 0]", rail)])
}

/// The blocks of KRL with the rail.
const KRL: &str = "[blocks]\njoints = \"PTP { {{J1}},{{J2}},{{J3}},{{J4}},{{J5}},{{J6}},{{RAIL}}}\"\n\
    linear = \"LIN { {{X}},{{Y}},{{Z}},{{A}},{{B}},{{C}},{{RAIL}}}{{corner}}\"\n\
    arc_through = \"CIRC { {{MX}},{{MY}},{{MZ}},{{MA}},{{MB}},{{MC}}},{ {{X}},{{Y}},{{Z}},{{A}},{{B}},{{C}},{{RAIL}}}{{corner}}\"\n\n[spindle]";

/// The same with a control that writes the rail, and with the spindle straight down at home: where a tool leans it would have to be far
/// above all of a long part.
fn writing_rail() -> Machine {
    let rail = "part = [450, 1000, 150, 0, 0, 0]\nrail = { direction = [0, 2, 0], origin = [0, 0, 0, 0, 0, 0], min = 0, max = 2000, \
                speed = 60000, home = 0 }";
    let changes = [
        ("part = [450, 0, 150, 0, 0, 0]", rail),
        ("home = [0, -90, 90, 0, 45, 0]", "home = [0, -90, 90, 0, 90, 0]"),
        ("[spindle]", KRL),
    ];
    crate::robot::changed("kuka-kr6-r900", &changes)
}

/// The program of the arm that stands before the part on the floor, by hand on the rail: at E1 1000 it stands before the part as well, so
/// that all joints are the same.
fn by_hand(source: &Program) -> String {
    let text = proven(source, &machine::load("kuka-kr6-r900").unwrap());
    let text = text.replace("$BASE={X 450.000,Y 0.000", "$BASE={X 450.000,Y 1000.000");
    let home = "A1 0.0000,A2 -90.0000,A3 90.0000,A4 0.0000,A5 45.0000,A6 0.0000";
    let lines = text.split_inclusive("\r\n").map(|line| match line.split_once('}') {
        Some((before, after)) if line.starts_with("PTP") || line.starts_with("LIN") => {
            let rail = if line.contains(home) { 0 } else { 1000 };
            format!("{before},E1 {rail}.000}}{after}")
        }
        _ => String::from(line),
    });
    lines.collect()
}

/// The program with its `number`th line that begins with `word` changed, counted from 0.
fn changed(text: &str, (word, number): (&str, usize), from: &str, to: &str) -> String {
    let mut lines: Vec<String> = text.split_inclusive("\r\n").map(String::from).collect();
    let line = lines.iter_mut().filter(|line| line.starts_with(word)).nth(number).unwrap();
    assert!(line.contains(from), "{line}");
    *line = line.replace(from, to);
    lines.concat()
}

#[test]
fn a_program_by_hand_with_the_rail_moved_before_the_part_is_proven() {
    let (source, machine) = (source(LINE), on_rail());
    let text = by_hand(&source);
    let report = proof_of(&source, &machine, &text);
    assert!(report.proven, "{text}\n{:#?}", report.mismatches);
    // E1 stays where a line leaves it out.
    let text = changed(&text, ("LIN", 1), ",E1 1000.000", "");
    assert!(proof_of(&source, &machine, &text).proven);
}

#[test]
fn a_rail_that_stands_elsewhere_is_refused() {
    let (source, machine) = (source(LINE), on_rail());
    let text = by_hand(&source);
    for (line, from, to, rule) in [
        // In one line by a millimetre; in the motion to the start, which leads elsewhere then.
        (("LIN", 0), "E1 1000.000", "E1 1001.000", "rail"),
        (("LIN", 1), "E1 1000.000", "E1 999.990", "rail"),
        (("PTP", 1), "E1 1000.000", "E1 1001.000", "end-point"),
        (("PTP", 1), ",E1 1000.000", "", "end-point"),
        (("PTP", 1), "E1 1000.000", "E1 -1000.000", "axis-limit"),
        (("PTP", 1), "E1 1000.000", "E1 2000.010", "axis-limit"),
        // The first motion says where the rail stands.
        (("PTP", 0), ",E1 0.000", "", "rail"),
        (("PTP", 0), "E1 0.000", "E1 10.000", "home"),
    ] {
        let damaged = changed(&text, line, from, to);
        let report = proof_of(&source, &machine, &damaged);
        let found = report.mismatches.first().map(|found| found.rule.name());
        assert_eq!(found, Some(rule), "{from} -> {to}: {:#?}", report.mismatches);
        let names_rail = report.mismatches[0].help.contains("the place of the rail (E1");
        assert!(rule != "end-point" || names_rail, "{:#?}", report.mismatches);
    }
    let home = text.rfind("E1 0.000").unwrap();
    let elsewhere = format!("{}E1 5.000{}", &text[..home], &text[home + "E1 0.000".len()..]);
    let report = proof_of(&source, &machine, &elsewhere);
    assert_eq!(report.mismatches[0].rule.name(), "end-point", "{:#?}", report.mismatches);
    // An arm that stands on no rail.
    let report = proof_of(&source, &machine::load("kuka-kr6-r900").unwrap(), &text);
    assert!(!report.proven);
}

/// Where the rail is at the end of each motion, mm.
fn rails(text: &str) -> Vec<f64> {
    let of = |event: Event| match event.action {
        Action::Arm(ArmAction::Move(motion)) => motion.rail,
        _ => None,
    };
    crate::robot::events(Dialect::Krl, text).into_iter().filter_map(of).collect()
}

#[test]
fn the_writer_takes_the_rail_to_where_the_arm_reaches_the_part() {
    let text = proven(&source(JOB), &writing_rail());
    let rails = rails(&text);
    // Home, at one place for the whole cut, home.
    let place = rails[1];
    assert!((300.0..=1700.0).contains(&place), "{text}");
    assert_eq!((rails[0], rails[rails.len() - 1]), (0.0, 0.0));
    assert!(rails[1..rails.len() - 1].iter().all(|at| *at == place), "{text}");
    // From home the part is 1 m out of reach.
    let fixed = [("part = [450, 0, 150, 0, 0, 0]", "part = [450, 1000, 150, 0, 0, 0]")];
    let found =
        post::write(&source(JOB), &crate::robot::changed("kuka-kr6-r900", &fixed)).unwrap_err();
    assert_eq!(found[0].rule.name(), "arm-path", "{found:?}");
}

/// Two cuts of 100 mm, 2.4 m apart along Y, with a rapid between them.
const FAR_APART: &str = "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,-1200,50\nFEDRAT/MMPM,1200\n\
GOTO/0,-1200,-2\nGOTO/100,-1200,-2\nRAPID\nGOTO/100,-1200,50\nRAPID\nGOTO/0,1200,50\nFEDRAT/MMPM,1200\nGOTO/0,1200,-2\nGOTO/100,1200,-2\n\
RAPID\nGOTO/100,1200,50\nFINI\n";

#[test]
fn the_rail_moves_between_cuts_and_in_none() {
    let (source, machine) = (source(FAR_APART), writing_rail());
    let text = proven(&source, &machine);
    let mut places = rails(&text);
    places.dedup();
    let [home, first, second, end] = places[..] else { panic!("{text}") };
    assert_eq!((home, end), (0.0, 0.0));
    // The arm reaches 0.9 m, the cuts lie at -200 and 2200 mm along the rail.
    assert!(first < 700.0 && second > 1300.0, "{text}");
    let lines: Vec<&str> = text.lines().collect();
    let moved = lines.windows(2).filter(|pair| {
        let at = |line: &str| Some(String::from(line.split_once("E1 ")?.1.split_once('}')?.0));
        pair[1].starts_with("LIN") && at(pair[0]).is_some() && at(pair[0]) != at(pair[1])
    });
    assert_eq!(moved.count(), 0, "{text}");
}

#[test]
fn a_control_that_has_no_word_for_the_rail_is_refused_and_says_so() {
    let rail = "rapid = 6000\nrail = { direction = [1, 0, 0], origin = [0, 0, 0, 0, 0, 0], min = 0, max = 2000, speed = 60000, home = 0 }";
    for name in ["universal-ur5e", "kuka-kr6-r900"] {
        let text = std::fs::read_to_string(
            crate::files::root().join(format!("machines/robots/{name}.toml")),
        );
        let line =
            text.unwrap().lines().find(|line| line.starts_with("rapid = ")).map(String::from);
        let line = line.unwrap();
        let machine = crate::robot::changed(name, &[(&line, rail)]);
        let found = post::write(&source(LINE), &machine).unwrap_err();
        assert!(found[0].message.contains("the block `joints` lacks `RAIL`"), "{found:?}");
        assert!(found[0].help.contains("URScript has no word for a rail"), "{found:?}");
    }
    // And the other way round.
    let machine = crate::robot::changed("kuka-kr6-r900", &[("[spindle]", KRL)]);
    let found = post::write(&source(LINE), &machine).unwrap_err();
    assert!(found[0].message.contains("the arm stands on no rail"), "{found:?}");
}

/// The IRB 6700 and the R-2000iC on a rail of 6 m along Y, with the blocks that docs/machines.md shows.
fn on_long_rails() -> [(Machine, Dialect, &'static str); 2] {
    let docs = std::fs::read_to_string(crate::files::root().join("docs/machines.md")).unwrap();
    let blocks = |of: &str| {
        let (_, blocks) = docs.split_once(of).unwrap();
        let (_, blocks) = blocks.split_once("```toml\n").unwrap();
        format!("{}\n[spindle]", blocks.split_once("```").unwrap().0)
    };
    let rail = |part: &str| {
        format!(
            "part = {part}\nrail = {{ direction = [0, 1, 0], origin = [0, 0, 0, 0, 0, 0], min = 0, max = 6000, speed = 90000, home = 0 }}"
        )
    };
    let rapid = [
        ("part = [1600, 0, 700, 0, 0, 0]", &rail("[1600, 3000, 700, 0, 0, 0]")[..]),
        ("home = [0, 0, 0, 0, 60, 0]", "home = [0, 0, 0, 0, 90, 0]"),
        ("[spindle]", &blocks("In RAPID:")),
    ];
    let ls = [
        ("part = [1400, 0, -300, 0, 0, 0]", &rail("[1400, 3000, -300, 0, 0, 0]")[..]),
        ("[spindle]", &blocks("On FANUC:")),
    ];
    [
        (
            crate::robot::changed("abb-irb6700-235-mill", &rapid),
            Dialect::Rapid,
            ",9E9,9E9,9E9,9E9,9E9]",
        ),
        (crate::robot::changed("fanuc-r2000ic-mill", &ls), Dialect::Ls, " mm\r\n};"),
    ]
}

#[test]
fn rapid_and_ls_write_the_rail_into_each_position_and_damages_are_refused() {
    for (machine, dialect, behind) in on_long_rails() {
        let source = source(JOB);
        let text = proven(&source, &machine);
        let moved: Vec<f64> = crate::robot::events(dialect, &text)
            .into_iter()
            .filter_map(|event| match event.action {
                Action::Arm(ArmAction::Move(motion)) => Some(motion.rail.unwrap()),
                _ => None,
            })
            .collect();
        let place = moved[1];
        // The arm reaches 2.65 m.
        assert!((place - 3000.0).abs() < 2000.0, "{text}");
        assert!(moved[1..moved.len() - 1].iter().all(|at| *at == place), "{text}");
        assert_eq!((moved[0], moved[moved.len() - 1]), (0.0, 0.0));
        // Each position in turn, 1 mm on, of the other sign, and beyond the end of the rail.
        let written = format!("{place:.3}{behind}");
        let places: Vec<usize> = text.match_indices(&written).map(|(at, _)| at).collect();
        assert!(places.len() >= 4, "{text}");
        for at in places {
            for other in [place + 1.0, -place, 6000.1] {
                let damaged =
                    format!("{}{other:.3}{behind}{}", &text[..at], &text[at + written.len()..]);
                let report = proof_of(&source, &machine, &damaged);
                assert!(!report.proven, "{other} in {}", &text[..at]);
            }
        }
        // Left out everywhere: what the rail does then, the program does not say.
        let without = match dialect {
            Dialect::Rapid => text.replace(&written, &format!("9E9{behind}")),
            _ => text.replace(&format!(",\r\nE1= {written}"), "\r\n};"),
        };
        assert_ne!(without, text);
        let report = proof_of(&source, &machine, &without);
        assert_eq!(report.mismatches[0].rule.name(), "rail", "{:#?}", report.mismatches);
    }
}

#[test]
fn rapid_that_lets_the_rail_go_faster_than_the_cell_is_refused() {
    let [(machine, ..), _] = on_long_rails();
    let source = source(LINE);
    let text = proven(&source, &machine);
    // 20 % of 90000 mm/min.
    let (from, to) = (",300.0,1000],fine", ",301.0,1000],fine");
    assert!(text.contains(from), "{text}");
    let report = proof_of(&source, &machine, &text.replace(from, to));
    assert_eq!(report.mismatches[0].rule.name(), "rapid-feed", "{:#?}", report.mismatches);
}

#[test]
fn of_200_single_damages_to_programs_with_a_rail_each_is_refused_or_changes_nothing() {
    let [(rapid, ..), (ls, ..)] = on_long_rails();
    let krl = writing_rail();
    for (machine, dialect, begin) in [
        (&krl, Dialect::Krl, "BAS (#VEL_PTP"),
        (&rapid, Dialect::Rapid, "ConfJ"),
        (&ls, Dialect::Ls, "/MN"),
    ] {
        let refused = crate::robot::damaged_by_dice(FAR_APART, (machine, dialect), begin, 29);
        assert!(refused > 100, "{refused}");
    }
}

#[test]
fn a_cut_longer_than_the_arm_reaches_from_one_place_of_the_rail_is_refused_and_says_so() {
    let machine = writing_rail();
    let line = |from: [i32; 2], to: [i32; 2]| {
        let [from, to] = [from, to].map(|[x, y]| format!("GOTO/{x},{y},"));
        let line = LINE.replace("GOTO/0,0,", &from).replace("GOTO/60,0,", &to);
        crate::robot::written(&source(&line), &machine).unwrap_err()
    };
    // 1.9 m, each end of which is reached from its own side.
    let found = line([0, -950], [0, 950]);
    assert!(
        found.contains("arm-path") && found.contains("the rail stands still within a cut"),
        "{found}"
    );
    assert!(found.contains("divide the cut"), "{found}");
    // Out of reach from everywhere the rail is not blamed.
    let found = line([0, 0], [1900, 0]);
    assert!(found.contains("arm-path") && !found.contains("rail stands still"), "{found}");
}

/// A KUKA on a rail from 1000 mm on, which may leave cuts.
fn reentering_on_rail(max: u32) -> Machine {
    let rail = format!(
        "part = [700, 1000, 0, 0, 0, 0]\nreentry_feed = 600\nrail = {{ direction = [0, 1, 0], origin = [0, 0, 0, 0, 0, 0], \
         min = 1000, max = {max}, speed = 60000, home = 1000 }}"
    );
    let changes = [("part = [450, 0, 150, 0, 0, 0]", &*rail), ("[spindle]", KRL)];
    crate::robot::changed("kuka-kr6-r900", &changes)
}

/// From the end of the rail the arm would leave the cut where the way above it is not clear, from its beginning it does not.
#[test]
fn of_the_places_of_a_rail_one_is_taken_from_which_cuts_are_entered_again() {
    let text = proven(&crate::robot::rings(150), &reentering_on_rail(1030));
    assert!(rails(&text).contains(&1000.0), "{text}");
}

#[test]
fn a_cut_is_left_and_entered_again_on_a_rail_which_stands_meanwhile() {
    let source = crate::robot::rings(150);
    let machine = reentering_on_rail(1001);
    let text = proven(&source, &machine);
    let report = proof_of(&source, &machine, &text);
    assert!(!report.excursions.is_empty(), "{text}");
    // But for the lift before the way home.
    let left =
        report.excursions.iter().filter(|left| left.first_program_line < left.last_program_line);
    for excursion in left {
        let (first, last) = (excursion.first_program_line, excursion.last_program_line);
        let lines = || text.lines().zip(1..).filter(|(_, number)| (first..=last).contains(number));
        let motions: Vec<(&str, u32)> = lines()
            .filter(|(line, _)| line.starts_with("PTP") || line.starts_with("LIN"))
            .collect();
        assert!(motions.iter().any(|(line, _)| line.starts_with("PTP")), "{motions:?}");
        // Each states the rail where it stands: 1 mm off in any of them is refused.
        for (line, number) in motions {
            let stated = line.split(",E1 ").nth(1).unwrap().split('}').next().unwrap();
            let at: f64 = stated.parse().unwrap();
            let moved = format!(",E1 {:.3}", if at > 1000.5 { at - 1.0 } else { at + 1.0 });
            let damaged: Vec<String> = text
                .lines()
                .zip(1..)
                .map(|(own, at)| match at == number {
                    true => own.replace(&format!(",E1 {stated}"), &moved),
                    false => own.to_owned(),
                })
                .collect();
            let report = proof_of(&source, &machine, &(damaged.join("\r\n") + "\r\n"));
            assert!(!report.proven, "{number}: {line}");
        }
    }
}
