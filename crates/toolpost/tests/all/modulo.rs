//! An axis that a SINUMERIK counts modulo 360°: its words are `DC()`, whatever place the plan counts on to.

use machine::Machine;

const TABLE: &str = include_str!("../../../../machines/sinumerik-840d-table-ac.toml");

/// The mill with A and C whose control counts C modulo 360° (MD30310 is 1), with this word for C.
fn mill(word: &str) -> Machine {
    let (_, rotary) = TABLE.split_once("[[rotary]]").unwrap();
    let (rotary, _) = rotary.split_once("[spindle]").unwrap();
    assert!(rotary.contains("modulo = false"));
    let rotary = rotary.replace("modulo = false", "modulo = true");
    let text = format!(
        "extends = \"sinumerik-840d-table-ac\"\noperator_parameters = []\n[words]\nC = {{ {word} }}\n[[rotary]]{rotary}"
    );
    machine::load_text("modulo.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// The rules that the proof of the dome finds broken, and the program.
fn dome(machine: &Machine) -> (Vec<&'static str>, String) {
    let text = std::fs::read(format!("{}/../../examples/dome.cls", env!("CARGO_MANIFEST_DIR")));
    let source = source::apt::read("dome.cls", &text.unwrap(), &Default::default());
    let source = source.unwrap().program;
    let output = post::write(&source, machine).unwrap_or_else(|found| panic!("{found:?}"));
    let report = proof::prove(&source, machine, "p", &output.text, &Default::default());
    let found = report.mismatches.iter().map(|found| found.rule.name()).collect();
    (found, String::from_utf8(output.text).unwrap())
}

/// SINUMERIK Axes and Spindles, modulo rotary axes: `DC()` takes 0 to 359.999 (alarm 16830) and goes the shorter way.
#[test]
fn an_axis_that_is_counted_modulo_360_is_written_by_dc() {
    let (found, text) = dome(&mill("address = \"C=DC(\", suffix = \")\", within_turn = true"));
    assert!(found.is_empty(), "{found:?}");
    let places: Vec<f64> = text
        .split("C=DC(")
        .skip(1)
        .map(|rest| rest.split_once(')').unwrap().0.parse().unwrap())
        .collect();
    assert!(places.iter().all(|place| (0.0..360.0).contains(place)));
    // The dome turns the table round and round.
    let passes = |pair: &[f64]| (pair[0] - pair[1]).abs() > 180.0;
    assert!(places.windows(2).filter(|pair| passes(pair)).count() > 3, "{places:?}");
}

/// A plain position turns such an axis another way, or is an alarm.
#[test]
fn a_plain_position_of_such_an_axis_is_refused() {
    let (found, _) = dome(&mill("address = \"C=\", suffix = \"\""));
    assert_eq!(found.first(), Some(&"rotary-way"));
}
