//! Moves in machine coordinates: the values count. A retract goes up to the safe height, and no axis beyond its
//! travel, whoever wrote the block.

use machine::{Machine, library, load, load_text};
use std::path::Path;

/// The block of a retract on a control, with any words.
fn block(machine: &Machine, words: &str) -> String {
    match machine.reader.as_str() {
        "klartext" => format!("L {words} R0 FMAX M91"),
        "sinumerik" | "sinumerik-828d" => format!("G0 SUPA {words} D0"),
        _ => format!("G53 G0 {words}"),
    }
}

fn sample() -> program::Program {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/samples/three-axes.cls");
    let text = std::fs::read(&file).unwrap();
    source::apt::read("three-axes.cls", &text, &Default::default()).unwrap().program
}

fn posted(machine: &Machine) -> Result<String, &'static str> {
    let text = post::write(&sample(), machine).map_err(|found| found[0].rule.name())?.text;
    Ok(String::from_utf8(text).unwrap())
}

/// Whether the program is proven on the machine, or the rule of the first mismatch.
fn proven(machine: &Machine, text: &str) -> Result<(), &'static str> {
    let report = proof::prove(&sample(), machine, "t", text.as_bytes(), &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err(found.rule.name()))
}

/// The mills of three axes, with the program of the sample on each.
fn mills() -> impl Iterator<Item = (Machine, String)> {
    let machines = library::names(library::MACHINES).map(|name| load(name).unwrap());
    let mills = machines.filter(|machine| machine.wire.is_none() && machine.rotary.is_empty());
    mills.map(|machine| {
        let text = posted(&machine).unwrap_or_else(|rule| panic!("{}: {rule}", machine.name));
        assert_eq!(proven(&machine, &text), Ok(()), "{}", machine.name);
        (machine, text)
    })
}

/// The program with a line put before the second tool change.
fn with(text: &str, line: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let change = lines.iter().rposition(|line| line.contains("T2") || line.contains("TOOL CALL 2"));
    let change = change.expect("a second tool");
    lines.insert(change, line);
    if !text.starts_with("0 BEGIN PGM") {
        return lines.join("\n") + "\n";
    }
    // HEIDENHAIN numbers each block; a line that goes on has no number.
    let mut next = 0;
    let numbered = |line: &str| {
        let rest = match line.split_once(' ') {
            Some((number, rest)) if number.parse::<u32>().is_ok() => rest,
            _ if line.starts_with('Q') => return format!("{line}\n"),
            _ => line,
        };
        next += 1;
        format!("{} {rest}\n", next - 1)
    };
    lines.into_iter().map(numbered).collect()
}

#[test]
fn a_retract_in_machine_coordinates_that_goes_down_is_refused_on_every_mill() {
    for (machine, text) in mills() {
        let name = &machine.name;
        let down = with(&text, &block(&machine, "Z-400.0"));
        assert_eq!(proven(&machine, &down), Err("machine-position"), "{name}");
        let away = with(&text, &block(&machine, "X-9999.0 Y-9999.0"));
        assert_eq!(proven(&machine, &away), Err("machine-position"), "{name}");
        let Some(height) = machine.safe_height else { continue };
        let up = with(&text, &block(&machine, &format!("Z{height:+.1}")));
        assert_eq!(proven(&machine, &up), Ok(()), "{name}");
        let lower = with(&text, &block(&machine, &format!("Z{:+.2}", height - 0.01)));
        assert_eq!(proven(&machine, &lower), Err("machine-position"), "{name}");
    }
}

#[test]
fn axes_go_within_their_travel() {
    let machine = load("linuxcnc-mill").unwrap();
    let text = posted(&machine).unwrap();
    for (words, expected) in [
        ("X0 Y0", Ok(())),
        ("X355 Y-190", Ok(())),
        ("X355.1", Err("machine-position")),
        ("X-0.1", Err("machine-position")),
        ("Y0.1", Err("machine-position")),
        ("Z0.1", Err("machine-position")),
    ] {
        assert_eq!(proven(&machine, &with(&text, &block(&machine, words))), expected, "{words}");
    }
    // Of a machine whose travel nobody knows, no place can be said to be within it.
    let endless = load("generic-3axis-linuxcnc").unwrap();
    let text = with(&posted(&endless).unwrap(), &block(&endless, "X0 Y0"));
    assert_eq!(proven(&endless, &text), Err("machine-position"));
}

#[test]
fn a_block_of_the_machine_is_held_to_the_same() {
    let own = |keys: &str| {
        let change = "M5\\nM9\\nG53 G0 X-9999 Y-9999 Z-9999\\n{{T}} M6";
        let text =
            format!("extends = \"linuxcnc-mill\"\n{keys}\n[blocks]\ntool_change = \"{change}\"\n");
        load_text("own.toml", &text).unwrap()
    };
    let machine = own("");
    assert_eq!(proven(&machine, &posted(&machine).unwrap()), Err("machine-position"));
}

/// The message says the line to add.
#[test]
fn without_a_safe_height_no_retract_is_written() {
    let machine = load_text("own.toml", "extends = \"linuxcnc\"\n").unwrap();
    let found = post::write(&sample(), &machine).map(|_| ()).unwrap_err();
    assert_eq!(found[0].rule.name(), "safe-height");
    assert!(found[0].help.contains("`safe_height = 0`"), "{}", found[0]);
    // A way home by reference points needs none.
    let machine = load_text("own.toml", "extends = \"fanuc-31i\"\n").unwrap();
    assert_eq!((machine.safe_height, posted(&machine).map(|_| ())), (None, Ok(())));
}

#[test]
fn a_safe_height_lies_within_the_travel() {
    let of = |height: &str| {
        let text = format!("extends = \"linuxcnc-mill\"\nsafe_height = {height}\n");
        load_text("own.toml", &text).map(|machine| machine.safe_height)
    };
    assert_eq!(of("-5"), Ok(Some(-5.0)));
    for wrong in ["1", "-400"] {
        let found = of(wrong).unwrap_err();
        assert!(found.to_string().contains("-336 to 0 mm"), "{found}");
    }
}

/// `G53` of a SINUMERIK leaves basic frames in: Z 0 of it is anywhere.
#[test]
fn a_sinumerik_goes_home_by_supa_or_g153() {
    for name in ["generic-3axis-sinumerik", "generic-3axis-sinumerik-828d"] {
        let machine = load(name).unwrap();
        let text = posted(&machine).unwrap();
        assert!(text.contains("G0 SUPA Z"), "{text}");
        assert_eq!(proven(&machine, &text.replace("SUPA", "G153")), Ok(()), "{name}");
        assert_eq!(proven(&machine, &text.replace("SUPA", "G53")), Err("machine-position"));
        // As a source it is read, with a warning.
        let setup = control::Setup::default();
        let found = |text: &str| {
            let read = nc::read(&machine, setup.clone(), "p.mpf", text.as_bytes()).unwrap();
            read.warnings.iter().filter(|found| found.message.contains("G53")).count()
        };
        assert_eq!((found(&text), found(&text.replace("SUPA", "G53"))), (0, 1), "{name}");
    }
}

/// A 3018 has no switches: where its machine zero is, nobody knows. Each retract goes over the work zero, above all cuts.
#[test]
fn a_machine_without_switches_retracts_over_its_work_zero() {
    let machine = load("grbl-3018").unwrap();
    let text = posted(&machine).unwrap();
    // The ring is cut from Z 1 down; the file says 20 mm.
    assert!(!text.contains("G53"), "{text}");
    assert_eq!(text.matches("\nG0 Z21\n").count(), 3, "{text}");
    assert_eq!(proven(&machine, &text), Ok(()));
    // Lower than the machine's file says, or moved across together with Z, it is no retract.
    let changed = |from: &str, to: &str| proven(&machine, &text.replacen(from, to, 1));
    let first = "M0\nG0 Z21\nT1";
    assert_eq!(changed(first, "M0\nG0 Z19.9\nT1"), Err("tool-change-height"));
    assert_eq!(changed(first, "M0\nG0 X0 Y0 Z20\nT1"), Err("tool-change-height"));
    // Z 0 has been set with the tool at the stop: it would go across the part at that height.
    assert_eq!(changed(first, "M0\nT1"), Err("tool-change-height"));
    // By G53 it still goes nowhere that is known.
    assert_eq!(changed(first, "M0\nG53 G0 Z0\nT1"), Err("machine-position"));
    // The source goes up to Z 20 itself.
    let of = |height: f64| {
        let own = format!("extends = \"grbl-3018\"\n[options]\nretract_height = {height}\n");
        let machine = load_text("own.toml", &own).unwrap();
        proven(&machine, &posted(&machine).unwrap())
    };
    assert_eq!((of(6.0), of(0.5)), (Ok(()), Ok(())));
    // Between the walls of a slot no tool goes across.
    let deep = text.replacen(first, "M0\nG0 Z0.5\nT1", 1);
    let own = "extends = \"grbl-3018\"\n[options]\nretract_height = 0.5\n";
    assert_eq!(proven(&load_text("own.toml", own).unwrap(), &deep), Err("home-height"));
    // Any GRBL may do so; one that is homed goes to its safe height.
    let own = "extends = \"generic-3axis-grbl\"\n[options]\nretract_height = 30\n";
    let text = posted(&load_text("own.toml", own).unwrap()).unwrap();
    assert!(text.contains("G0 Z31") && !text.contains("G53"), "{text}");
}
