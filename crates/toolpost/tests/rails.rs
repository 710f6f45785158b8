//! An arm on a rail: the outer axis of programs written by hand and by the writer.

mod dice;
mod files;
mod robot;

use machine::Machine;
use program::Program;
use robot::{LINE, proof_of, proven, source};

/// The KR 6 on a rail of 2 m along Y, on which the part of the library's cell lies 1 m from where the rail stands at home.
fn on_rail() -> Machine {
    let rail = "part = [450, 1000, 150, 0, 0, 0]\nrail = { direction = [0, 2, 0], origin = [0, 0, 0, 0, 0, 0], min = 0, max = 2000, \
                speed = 60000, home = 0 }";
    robot::changed("kuka-kr6-r900", &[("part = [450, 0, 150, 0, 0, 0]", rail)])
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
    }
    let home = text.rfind("E1 0.000").unwrap();
    let elsewhere = format!("{}E1 5.000{}", &text[..home], &text[home + "E1 0.000".len()..]);
    let report = proof_of(&source, &machine, &elsewhere);
    assert_eq!(report.mismatches[0].rule.name(), "end-point", "{:#?}", report.mismatches);
    // An arm that stands on no rail.
    let report = proof_of(&source, &machine::load("kuka-kr6-r900").unwrap(), &text);
    assert!(!report.proven);
}
