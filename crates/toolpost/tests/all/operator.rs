//! What belongs to the operator: work offsets, tool lengths and radii that he has measured, and the keys by which he
//! stops and slows a program. A program that takes them is refused, whoever wrote it; for one run it may be accepted.

use machine::{Machine, load};
use std::path::Path;

fn sample() -> program::Program {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/samples/three-axes.cls");
    let text = std::fs::read(&file).unwrap();
    source::apt::read("three-axes.cls", &text, &Default::default()).unwrap().program
}

/// The sample's program for the machine, with `lines` before the one that starts with `before`.
fn with(machine: &Machine, before: &str, lines: &str) -> String {
    let output = post::write(&sample(), machine).unwrap_or_else(|found| panic!("{found:?}"));
    let text = String::from_utf8(output.text).unwrap();
    let place = text.lines().position(|line| line.contains(before));
    let place = place.unwrap_or_else(|| panic!("{before}\n{text}"));
    let mut all: Vec<&str> = text.lines().collect();
    all.insert(place, lines);
    all.join("\n") + "\n"
}

fn rule(machine: &Machine, text: &str, accepted: &[&str]) -> Option<&'static str> {
    let mut tolerances = proof::Tolerances::default();
    for rule in accepted {
        tolerances.accepted = tolerances.accepted.and(rule).unwrap();
    }
    let report = proof::prove(&sample(), machine, "t", text.as_bytes(), &tolerances);
    report.mismatches.first().map(|found| found.rule.name())
}

#[test]
fn data_that_the_operator_has_measured_are_not_rewritten() {
    for (name, before, lines) in [
        // B-64484EN-2, "Programmable data input"; LinuxCNC "G10 L1 … L20"; SINUMERIK "Job Planning", "$P_UIFR".
        ("generic-3axis-fanuc", "M6", "G10 L2 P2 X0. Y0. Z-50."),
        ("generic-3axis-fanuc", "M6", "G10 L10 P7 R10."),
        ("generic-3axis-haas", "M6", "G10 L2 P2 X0. Y0. Z-50."),
        ("generic-3axis-haas", "M6", "G10 L10 P7 R10."),
        ("linuxcnc-mill", "M6", "G10 L2 P2 X0 Y0 Z-50"),
        ("linuxcnc-mill", "M6", "G10 L20 P2 X0"),
        ("linuxcnc-mill", "M6", "G10 L1 P7 Z10"),
        // "G28.1", "G30.1": kept over the end of the program, and where every G28 goes by rapid.
        ("linuxcnc-mill", "M6", "G28.1"),
        ("linuxcnc-mill", "M6", "G30.1"),
        ("generic-3axis-grbl", "S3000", "G28.1"),
        ("mach3-mill", "M6", "G10 L2 P2 X0 Y0 Z-50"),
        ("generic-3axis-grbl", "S3000", "G10 L2 P2 X0 Y0 Z-50"),
        ("generic-3axis-sinumerik", "M6", "$P_UIFR[2,X,TR]=10"),
    ] {
        let machine = load(name).unwrap();
        let text = with(&machine, before, lines);
        assert_eq!(rule(&machine, &text, &[]), Some("operator-data"), "{name}: {lines}");
        assert_eq!(rule(&machine, &text, &["operator-data"]), None, "{name}: {lines}");
        assert_eq!(rule(&machine, &text, &["path-tolerance"]), Some("operator-data"), "{name}");
    }
}

/// What is rewritten is in force, whoever accepts it.
#[test]
fn what_is_accepted_still_moves_the_tool_where_it_says() {
    for (name, before, lines) in [
        ("generic-3axis-fanuc", "G43", "G10 L2 P1 X0. Y0. Z-50."),
        ("linuxcnc-mill", "G43", "G10 L2 P1 X0 Y0 Z-50"),
        ("linuxcnc-mill", "G43", "G92 X1"),
    ] {
        let machine = load(name).unwrap();
        let text = with(&machine, before, lines);
        assert!(rule(&machine, &text, &["operator-data"]).is_some(), "{name}: {lines}");
    }
}

#[test]
fn the_keys_of_the_operator_stay_his() {
    for (name, line) in [
        ("generic-3axis-fanuc", "#3004=7"),
        ("generic-3axis-fanuc", "#3003=1"),
        ("generic-3axis-haas", "#3004=2"),
    ] {
        let machine = load(name).unwrap();
        let text = with(&machine, "M6", line);
        assert_eq!(rule(&machine, &text, &[]), Some("operator-controls"), "{name}: {line}");
        assert_eq!(rule(&machine, &text, &["operator-controls"]), None, "{name}: {line}");
        // What gives them back does no harm.
        let back = with(&machine, "M6", &format!("{}=0", &line[..5]));
        assert_eq!(rule(&machine, &back, &[]), None, "{name}");
    }
}

/// A shop may set its fixtures by programs (B-64484EN-2, "Setting workpiece coordinate system": G10 L2 P1 to P6). Where the
/// machine's file says so, the values of the source are written, and held.
#[test]
fn work_offsets_are_written_where_the_machine_declares_it() {
    let sets = "extends = \"generic-3axis-fanuc\"\n[settings]\nsets_work_offsets = true\n";
    let sets = machine::load_text("sets.toml", sets).unwrap();
    let keeps = load("generic-3axis-fanuc").unwrap();
    let text = "%\nO1\nG21\nG17 G40 G49 G80 G90 G94 G54\nG10 L2 P1 X-350. Y-210.5 Z-400.\nG10 L2 P3 X0. Z-1.\n\
                T1 M6\nS1000 M3\nG0 X0. Y0.\nG43 H1 Z50.\nG1 Z-1. F100.\nX10.\nG0 Z50.\nG91 G28 Z0.\nG90\nM30\n%\n";
    let read = |machine: &Machine| {
        nc::read(machine, Default::default(), "s.nc", text.as_bytes())
            .unwrap_or_else(|e| panic!("{e}"))
    };
    // In a source of another machine they are reported.
    assert!(read(&keeps).warnings.iter().any(|found| found.rule.name() == "operator-data"));
    let source = read(&sets);
    assert!(source.warnings.iter().all(|found| found.rule.name() != "operator-data"));
    let source = source.program;

    let output = post::write(&source, &sets).unwrap_or_else(|found| panic!("{found:?}"));
    let written = String::from_utf8(output.text).unwrap();
    let blocks = ["G10 L2 P1 X-350. Y-210.5 Z-400.", "G10 L2 P3 X0. Z-1."];
    assert!(blocks.iter().all(|block| written.contains(block)), "{written}");
    let rule = |machine: &Machine, text: &str| {
        let report = proof::prove(&source, machine, "t", text.as_bytes(), &Default::default());
        report.mismatches.first().map(|found| found.rule.name())
    };
    assert_eq!(rule(&sets, &written), None, "{written}");
    for (from, to) in [
        ("Z-400.", "Z-40."),
        ("Z-400.", ""),
        ("P1 X-350.", "P2 X-350."),
        ("X0. Z-1.", "X0. Y0. Z-1."),
        ("G10 L2 P3", "G10 L10 P3 R1. (G10 L2 P3)"),
    ] {
        let damaged = written.replacen(from, to, 1);
        assert_ne!(damaged, written);
        assert!(rule(&sets, &damaged).is_some(), "{from} {to}");
    }
    let less: String =
        written.lines().filter(|line| !line.contains("P3")).map(|l| format!("{l}\n")).collect();
    assert_eq!(rule(&sets, &less), Some("operator-data"));
    // Another machine's operator has measured his own.
    assert_eq!(rule(&keeps, &written), Some("operator-data"));
    let output = post::write(&source, &keeps).unwrap();
    assert!(output.warnings.iter().any(|found| found.rule.name() == "operator-data"));
    let written = String::from_utf8(output.text).unwrap();
    assert!(!written.contains("G10"));
    assert_eq!(rule(&keeps, &written), None);
}
