//! Blocks behind `/`: the operator may have switched them off, so a program is proven with them and without.

use machine::{Machine, load};
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

/// The first line that holds `what` behind `skip`.
fn optional(text: &str, what: &str, skip: &str) -> String {
    let at = text.lines().position(|line| line.contains(what));
    let at = at.unwrap_or_else(|| panic!("{what} in\n{text}"));
    let line = |(i, line): (usize, &str)| format!("{}{line}\n", if i == at { skip } else { "" });
    text.lines().enumerate().map(line).collect()
}

fn proven(machine: &Machine, text: &str) -> Result<(), &'static str> {
    let report = proof::prove(&sample(), machine, "t", text.as_bytes(), &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err(found.rule.name()))
}

#[test]
fn what_the_program_needs_may_not_be_switched_off() {
    for (name, needed, free) in [
        (
            "generic-3axis-fanuc",
            &[("G43", "length-offset"), ("S3000 M3", "spindle"), ("G1 Z-2", "rapid-feed")][..],
            "M5",
        ),
        ("generic-3axis-haas", &[("G43", "length-offset"), ("T2 M6", "length-offset")], "M5"),
        ("linuxcnc-mill", &[("G43", "length-offset"), ("G64", "path-tolerance")], "M5"),
        ("mach3-mill", &[("G61", "path-tolerance")], "M5"),
        ("generic-3axis-sinumerik", &[("S3000 M3", "spindle"), ("G1 Z-2", "rapid-feed")], "M5"),
        ("generic-3axis-heidenhain", &[("L Z-2", "path")], "M5"),
    ] {
        let machine = load(name).unwrap();
        let text = posted(&machine);
        assert_eq!(proven(&machine, &text), Ok(()), "{name}");
        for (what, rule) in needed {
            let found = proven(&machine, &optional(&text, what, "/"));
            assert_eq!(found, Err(*rule), "{name}: {what}");
        }
        assert_eq!(proven(&machine, &optional(&text, free, "/")), Ok(()), "{name}: {free}");
    }
}

#[test]
fn two_levels_of_the_switch_are_not_proven_together() {
    let machine = load("generic-3axis-sinumerik").unwrap();
    let one = optional(&posted(&machine), "M5", "/1 ");
    assert_eq!(proven(&machine, &one), Ok(()));
    assert_eq!(proven(&machine, &optional(&one, "M9", "/2 ")), Err("block-skip"));
    assert_eq!(proven(&machine, &optional(&one, "M9", "/1 ")), Ok(()));
}

#[test]
fn a_source_with_blocks_that_may_be_switched_off_is_reported() {
    let machine = load("generic-3axis-fanuc").unwrap();
    let text = "%\nO1\nG21\n/G4 X1.\r\nT1 M6\n/S9 M3\nM30\n%\n";
    let read = nc::read(&machine, Default::default(), "s.nc", text.as_bytes()).unwrap();
    let [found] = &read.warnings[..] else { panic!("{:?}", read.warnings) };
    assert_eq!((found.rule.name(), found.line, found.count), ("block-skip", 4, 2));
    assert!(found.message.ends_with("are read as run"), "{}", found.message);
}
