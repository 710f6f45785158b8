//! Rotary axes turn where Z is home: a table swings the part up, a head its tool down, whatever the block says.

use crate::files::root;
use machine::{Machine, load};
use program::Program;

fn sample() -> Program {
    let text = std::fs::read(root().join("machines/samples/five-axes.cls")).unwrap();
    source::apt::read("five-axes.cls", &text, &Default::default()).unwrap().program
}

fn proven(machine: &Machine, text: &str) -> Result<(), (&'static str, u32)> {
    let report = proof::prove(&sample(), machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err((found.rule.name(), found.line)))
}

/// The sample program of the machine without every block that holds `retract` before the block that holds `turn`, from the
/// last motion on; and the line of `turn` in it.
fn lowered(machine: &Machine, retract: &str, turn: &str) -> (String, u32) {
    let text = post::write(&sample(), machine).unwrap_or_else(|found| panic!("{found:?}")).text;
    let text = String::from_utf8(text).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    let at = lines.iter().position(|line| line.contains(turn)).unwrap();
    let from = lines[..at].iter().rposition(|line| line.contains(retract)).unwrap();
    let taken = lines[from..at].iter().take_while(|line| line.contains(retract)).count();
    lines.drain(from..from + taken);
    let numbered = lines.iter().enumerate().map(|(i, line)| match machine.reader.as_str() {
        // HEIDENHAIN counts its blocks.
        "klartext" if !line.starts_with('Q') => {
            let before = lines[..i].iter().filter(|line| !line.starts_with('Q')).count();
            format!("{before} {}\n", line.split_once(' ').unwrap().1)
        }
        _ => format!("{line}\n"),
    });
    (numbered.collect(), (at - taken + 1) as u32)
}

#[test]
fn axes_turn_only_where_z_is_home() {
    for (name, retract, turn) in [
        ("dmu50-heidenhain", "M91", "PLANE SPATIAL"),
        ("fanuc-table-bc", "G91 G28 Z0", "G53.1"),
        ("sinumerik-840d-traori", "SUPA Z0", "CYCLE800(0"),
    ] {
        let machine = load(name).unwrap();
        let (text, line) = lowered(&machine, retract, turn);
        let Err(found) = proven(&machine, &text) else { panic!("{name} is proven:\n{text}") };
        // FANUC's length ends before the plane turns.
        let (rule, line) = match name {
            "fanuc-table-bc" => ("length-change", line - 3),
            _ => ("turn-height", line),
        };
        assert_eq!(found, (rule, line), "{name}:\n{text}");
    }
}

/// The program begins with a tool change and turns the table behind it: that the change brings Z up, the file says.
#[test]
fn a_tool_change_that_does_not_go_up_leaves_no_room_to_turn() {
    let file =
        "extends = \"sinumerik-840d-table-ac\"\n[tools]\nretracts = false\nmax_number = 60\n";
    let machine = machine::load_text("low.toml", file).unwrap();
    let text = post::write(&sample(), &load("sinumerik-840d-table-ac").unwrap()).unwrap().text;
    let text = String::from_utf8(text).unwrap();
    assert_eq!(proven(&machine, &text), Err(("turn-height", 8)));
}

/// The same sample on fork heads, by vectors and by positions of the axes: without either of the two words, and with the
/// other kind of turn, it is refused where it first turns the tool in a cut.
#[test]
fn how_the_tool_turns_in_a_cut_has_to_be_said() {
    let vectors = load("sinumerik-840d-traori").unwrap();
    let positions = "extends = \"sinumerik-840d\"\nsafe_height = 0\n[orientation]\nsimultaneous = \"tool-center-angles\"\n\
                     tolerance = 0.005\n[axes]\nZ = { min = -800, max = 0, rapid = 30000, acceleration = 3 }\n\
                     [[rotary]]\nletter = \"C\"\non = \"head\"\naxis = [0, 0, 1]\npoint = [0, 0, 0]\nmodulo = false\nrapid = 9000\nacceleration = 400\n\
                     [[rotary]]\nletter = \"A\"\non = \"head\"\naxis = [1, 0, 0]\npoint = [0, 0, 220]\nmin = -115\nmax = 115\nrapid = 9000\nacceleration = 400\n";
    let positions = machine::load_text("shop.toml", positions).unwrap();
    for (machine, words, other) in [
        (&vectors, ["ORIWKS", "ORIVECT"], "ORIAXES"),
        (&positions, ["ORIMKS", "ORIAXES"], "ORIVECT"),
    ] {
        let text = post::write(&sample(), machine).unwrap_or_else(|found| panic!("{found:?}")).text;
        let text = String::from_utf8(text).unwrap();
        assert_eq!(proven(machine, &text), Ok(()), "{text}");
        for (word, with) in [(words[0], ";"), (words[1], ";"), (words[1], other)] {
            let damage = text.replace(&format!(" {word}\n"), &format!(" {with}\n"));
            assert_ne!(damage, text);
            let Err((rule, _)) = proven(machine, &damage) else { panic!("proven:\n{damage}") };
            assert_eq!(rule, "orientation-way", "{damage}");
        }
    }
}

/// Where a program begins, Z stands wherever the operator has left it; most machines bring it up for a tool change, and nobody
/// guarantees it.
#[test]
fn a_first_tool_change_before_z_is_home_is_reported() {
    for (name, retract) in [
        ("generic-3axis-fanuc", "G91 G28 Z0"),
        ("generic-3axis-haas", "G91 G28 Z0"),
        ("linuxcnc-mill", "G53 G0 Z0"),
        ("generic-3axis-sinumerik", "SUPA Z0"),
    ] {
        let machine = load(name).unwrap();
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../machines/samples/three-axes.cls");
        let source = std::fs::read(file).unwrap();
        let source = source::apt::read("sample.cls", &source, &Default::default()).unwrap().program;
        let text = String::from_utf8(post::write(&source, &machine).unwrap().text).unwrap();
        let reported = |text: &str| {
            let report = proof::prove(&source, &machine, "p", text.as_bytes(), &Default::default());
            assert!(report.proven, "{name}: {:?}\n{text}", report.mismatches);
            report.warnings.iter().any(|found| found.rule.name() == "tool-change-height")
        };
        assert!(!reported(&text), "{name}");
        let first = text.lines().position(|line| line.contains(retract)).unwrap();
        let without: String = text
            .lines()
            .enumerate()
            .filter(|(i, _)| *i != first)
            .map(|(_, line)| format!("{line}\n"))
            .collect();
        assert!(reported(&without), "{name}\n{without}");
    }
}
