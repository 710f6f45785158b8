//! How far a control may leave the path at corners: what Toolpost writes bounds it, and a program that does not is
//! refused, whoever wrote it.

use machine::{Machine, load, load_text};
use std::path::Path;

fn sample() -> program::Program {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/samples/three-axes.cls");
    let text = std::fs::read(&file).unwrap();
    source::apt::read("three-axes.cls", &text, &Default::default()).unwrap().program
}

fn posted(machine: &Machine) -> String {
    let output = post::write(&sample(), machine).unwrap_or_else(|found| panic!("{found:?}"));
    String::from_utf8(output.text).unwrap()
}

/// Whether the program is proven on the machine, or the rule of the first mismatch.
fn proven(machine: &Machine, text: &str) -> Result<(), &'static str> {
    let report = proof::prove(&sample(), machine, "t", text.as_bytes(), &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err(found.rule.name()))
}

/// The same with `line` instead of the line that starts with `old`.
fn instead(text: &str, old: &str, line: &str) -> String {
    let is_old = |l: &&str| {
        l.trim_start_matches(|c: char| c == 'N' || c.is_ascii_digit()).trim().starts_with(old)
    };
    assert_eq!(text.lines().filter(is_old).count(), 1, "{old}\n{text}");
    let lines = text.lines().map(|l| if is_old(&l) { line } else { l });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

/// A real LinuxCNC 2.9 misses a corner of 90° at 6000 mm/min by 10.36 mm after `G64` and after `G64 P0`, by 0.0105 mm
/// after `G64 P0.01 Q0`, and by nothing after `G61`.
#[test]
fn linuxcnc_keeps_to_the_path_within_the_bound_of_its_file() {
    let machine = load("linuxcnc-mill").unwrap();
    let text = posted(&machine);
    assert_eq!(proven(&machine, &text), Ok(()));
    for (line, held) in [
        ("", false),
        ("G64", false),
        ("G64 P0", false),
        ("G64 P5", false),
        ("G64 P0.005 Q0.006", false),
        // Without Q lines within P are one as well.
        ("G64 P0.006", false),
        ("G64 P0.005", true),
        ("G64 P0.01 Q0", true),
        ("G61", true),
        ("G61.1", true),
    ] {
        let expected = if held { Ok(()) } else { Err("path-tolerance") };
        assert_eq!(proven(&machine, &instead(&text, "G64", line)), expected, "{line}");
    }
    assert_eq!(proven(&machine, &instead(&text, "G64", "G64 P-1")), Err("path-mode"));
    // In inches a bound is in inches.
    let inches = instead(&text, "G64", "G20 G64 P0.005 Q0\nG21");
    assert_eq!(proven(&machine, &inches), Err("path-tolerance"));
    let between = text.replacen("M6\n", "M6\nG64\n", 1);
    assert_eq!(proven(&machine, &between), Err("path-tolerance"));
}

/// What is accepted is listed, and nothing else passes with it.
#[test]
fn a_rule_that_is_accepted_passes_and_stands_in_the_report() {
    let machine = load("linuxcnc-mill").unwrap();
    let text = instead(&posted(&machine), "G64", "G64");
    let accepted = proof::Accepted::default().and("path-tolerance").unwrap();
    let tolerances = proof::Tolerances { accepted, ..Default::default() };
    let prove = |text: &str| proof::prove(&sample(), &machine, "t", text.as_bytes(), &tolerances);
    let report = prove(&text);
    assert!(report.proven && report.mismatches.is_empty());
    let [found] = &report.accepted[..] else { panic!("{:?}", report.accepted) };
    assert!(
        found.rule.name() == "path-tolerance" && !found.is_error() && found.count > 1,
        "{found:?}"
    );
    assert!(found.message.contains("by any amount"), "{}", found.message);
    let deeper = prove(&text.replacen("Z-2 ", "Z-3 ", 1));
    assert_eq!(deeper.mismatches[0].rule.name(), "path");
    for rule in ["end-point", "tool", "machine-position", ""] {
        assert!(proof::Accepted::default().and(rule).is_err(), "{rule}");
    }
}

#[test]
fn a_machine_that_keeps_to_the_path_is_told_so() {
    let exact = "extends = \"linuxcnc-mill\"\n[options]\npath_tolerance = 0\n";
    let machine = load_text("own.toml", exact).unwrap();
    let text = posted(&machine);
    assert!(text.lines().any(|line| line == "G61"), "{text}");
    assert_eq!(proven(&machine, &text), Ok(()));
    assert_eq!(proven(&machine, &text.replace("G61", "G64 P0.001")), Err("path-tolerance"));
}

/// Its constant velocity is as the operator set it up, so it counts only where the machine's file says how far.
#[test]
fn constant_velocity_of_mach3_is_as_its_file_says() {
    let machine = load("mach3-mill").unwrap();
    let text = posted(&machine);
    assert_eq!(proven(&machine, &text), Ok(()));
    for line in ["", "G64"] {
        let damaged = instead(&text, "G61", line);
        assert_eq!(proven(&machine, &damaged), Err("path-tolerance"), "{line}");
    }
    let smooth = "extends = \"mach3-mill\"\n[options]\npath_tolerance = 0.02\n";
    let smooth = load_text("own.toml", smooth).unwrap();
    let text = posted(&smooth);
    assert!(text.contains("G64\n"), "{text}");
    assert_eq!(proven(&smooth, &text), Ok(()));
}

/// Haas, "G187": without E corners are rounded as setting 85 says, with the word or without, and nothing of a program bounds
/// that; `G61` stops in each.
#[test]
fn a_haas_rounds_corners_as_far_as_g187_says_and_no_program_leaves_that_to_setting_85() {
    let haas = load("generic-3axis-haas").unwrap();
    let text = posted(&haas);
    let written = "G187 E0.01";
    assert!(text.contains(written), "{text}");
    assert_eq!(proven(&haas, &text), Ok(()));
    for (line, held) in [
        ("G187 P3 E5.", false),
        ("G187 P1 E0.", true),
        ("G187 P2", false),
        ("G187", false),
        ("", false),
        ("G61", true),
        ("G187 E0.01\nG61\nG64", true),
        ("G187 E0.01\nG187 P3", false),
        ("G64", false),
    ] {
        let damaged = text.replacen(written, line, 1);
        let expected = if held { Ok(()) } else { Err("path-tolerance") };
        assert_eq!(proven(&haas, &damaged), expected, "{line}");
    }
    let exact = "extends = \"generic-3axis-haas\"\n[options]\npath_tolerance = 0\n";
    let exact = load_text("own.toml", exact).unwrap();
    let text = posted(&exact);
    assert!(text.contains("G61\n") && !text.contains("G187"), "{text}");
    assert_eq!(proven(&exact, &text), Ok(()));
}

#[test]
fn a_tolerance_beyond_the_machines_file_is_refused_on_other_controls() {
    let heidenhain = load("generic-3axis-heidenhain").unwrap();
    let text = posted(&heidenhain);
    assert_eq!(proven(&heidenhain, &text), Ok(()));
    for (cycle, held) in [
        ("T5", false),
        ("T0.02", false),
        ("T0.005\n4 CYCL DEF 32.2 HSC-MODE:1 TA0.5", true),
        ("T0.005", true),
        // It ends the cycle: what the builder has set up is not known.
        ("", false),
    ] {
        let damaged = text.replacen("32.1 T0.01", &format!("32.1 {cycle}"), 1);
        let damaged = numbered(&damaged);
        assert_eq!(proven(&heidenhain, &damaged).is_ok(), held, "{cycle}");
    }
    let without: String = text
        .lines()
        .filter(|line| !line.contains("CYCL DEF 32"))
        .map(|line| format!("{line}\n"))
        .collect();
    assert_eq!(proven(&heidenhain, &numbered(&without)), Err("path-tolerance"));
}

/// HEIDENHAIN numbers each block; a line that goes on has no number.
fn numbered(text: &str) -> String {
    let mut next = 0;
    let number = |line: &str| {
        let rest = match line.split_once(' ') {
            Some((number, rest)) if number.parse::<u32>().is_ok() => rest,
            _ if line.starts_with('Q') => return format!("{line}\n"),
            _ => line,
        };
        next += 1;
        format!("{} {rest}\n", next - 1)
    };
    text.lines().map(number).collect()
}

#[test]
fn what_a_source_asks_for_and_the_machine_does_not_give_is_told() {
    let machine = load("linuxcnc-mill").unwrap();
    let told = |mode: &str| {
        let text = format!(
            "G21 G90 G17 G94 G54 {mode}\nT1 M6\nS1000 M3\nG43 H1\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX9\nG0 Z50\nM30\n"
        );
        let read = nc::read(&machine, Default::default(), "s.ngc", text.as_bytes()).unwrap();
        let output = post::write(&read.program, &machine).unwrap();
        let rules = output.warnings.iter().filter(|found| found.rule.name() == "path-mode");
        rules.map(|found| found.message.clone()).collect::<Vec<_>>()
    };
    assert_eq!(told("G64 P0.1"), [""; 0]);
    assert_eq!(told("G64"), [""; 0]);
    assert_eq!(
        told("G61.1"),
        ["the source stops at each corner: this control leaves it by 0.01 mm at the most there"]
    );
    assert_eq!(
        told("G64 P0.001"),
        [
            "the source leaves the path by 0.002 mm at corners: this control leaves it by 0.01 mm at the most there"
        ]
    );
}
