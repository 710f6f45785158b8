//! Clamps of rotary axes: an axis turns only while its clamp is open, and the machine's file says which M functions
//! open and close it.

use machine::{Machine, load, load_text};
use std::path::Path;

fn sample() -> program::Program {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/samples/five-axes.cls");
    let text = std::fs::read(&file).unwrap();
    source::apt::read("five-axes.cls", &text, &Default::default()).unwrap().program
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

/// The program without the block of that number in the text, from 1, or with others instead.
fn instead(text: &str, line: usize, blocks: &str) -> String {
    let lines = text.lines().enumerate();
    let lines = lines.map(|(i, old)| if i + 1 == line { blocks } else { old });
    lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n") + "\n"
}

/// The program without the blocks that say `code` alone.
fn without(text: &str, code: &str) -> String {
    let end = format!(" {code}");
    text.lines().filter(|line| !line.ends_with(&end)).map(|line| format!("{line}\n")).collect()
}

/// M27 opens A, M26 closes it; M29 and M28 do the same for C.
#[test]
fn a_rotary_axis_turns_only_while_its_clamp_is_open() {
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let text = posted(&machine);
    assert_eq!(proven(&machine, &text), Ok(()));
    let of = |what: &str| -> Vec<usize> {
        let lines = text.lines().enumerate().filter(|(_, line)| line.contains(what));
        lines.map(|(i, _)| i + 1).collect()
    };
    let [first, second, third] = of("M27M29")[..] else { panic!("{text}") };
    // Nothing is clamped while the third operation turns the axes in the cut.
    let [after_first, after_second, at_end] = of("M26M28")[..] else { panic!("{text}") };
    assert!(text.lines().nth(at_end - 2).unwrap().ends_with("G0A0C=0+R24"), "{text}");
    assert!(after_first == first + 2 && after_second == second + 2 && third > after_second);
    for (line, blocks, rule) in [
        (first, "", Err("clamp")),
        (second, "", Err("clamp")),
        (second, "N99 M26M28", Err("clamp")),
        (second, "N99 M27", Err("clamp")),
        (second, "N99 M29", Err("clamp")),
        (third, "", Err("clamp")),
        (third + 2, "N99 M26\nN98 X-7.125", Err("clamp")),
        (third + 2, "N99 M28\nN98 X-7.125", Err("clamp")),
        // An axis that stands may be held or not.
        (after_first, "", Ok(())),
    ] {
        let damaged = instead(&text, line, blocks);
        assert_eq!(proven(&machine, &damaged), rule, "{line}: {blocks}");
    }
}

const TABLE: &str = r#"
extends = "fanuc-table-bc"
[orientation]
simultaneous = "tool-center-angles"
positioned = "tool-center-angles"
tolerance = 0.005
[[rotary]]
letter = "B"
on = "table"
axis = [0, 1, 0]
min = -110
max = 110
rapid = 7200
acceleration = 400
clamp_open = 11
clamp_close = 10
[[rotary]]
letter = "C"
on = "table"
axis = [0, 0, 1]
rapid = 14400
acceleration = 800
clamp_open = 13
clamp_close = 12
[blocks]
unclamp = """
{{N}} M11
{{N}} M13
"""
clamp = """
{{N}} M10
{{N}} M12
"""
"#;

/// One M function a block, as a FANUC wants it.
#[test]
fn a_fanuc_table_opens_each_clamp_in_a_block_of_its_own() {
    let machine = load_text("own.toml", TABLE).unwrap();
    post::check(&machine).unwrap();
    let text = posted(&machine);
    assert_eq!(proven(&machine, &text), Ok(()), "{text}");
    for code in ["M11", "M13"] {
        assert_eq!(proven(&machine, &without(&text, code)), Err("clamp"), "{code}");
    }
}

/// The rotary axes turn by words before `G68.2`, and stand at `G53.1`: the clamps are open at both, and closed in the cuts.
#[test]
fn clamps_are_open_where_a_plane_is_tilted_and_closed_in_its_cuts() {
    let own =
        TABLE.replacen("positioned = \"tool-center-angles\"", "positioned = \"tilted-plane\"", 1);
    let machine = load_text("own.toml", &own).unwrap();
    post::check(&machine).unwrap();
    let text = posted(&machine);
    assert_eq!(proven(&machine, &text), Ok(()), "{text}");
    let blocks: Vec<&str> = text.lines().filter_map(|line| Some(line.split_once(' ')?.1)).collect();
    let slope = blocks.iter().position(|block| *block == "G0 B-45. C-45.").unwrap();
    assert_eq!(blocks[slope - 2..slope], ["M11", "M13"]);
    assert_eq!(blocks[slope + 2..slope + 5], ["G53.1", "M10", "M12"]);
    // Upright again, and at the start.
    let upright: Vec<usize> = (0..blocks.len()).filter(|&i| blocks[i] == "G0 B0. C0.").collect();
    assert_eq!(blocks[upright[0] + 1..upright[0] + 3], ["M10", "M12"]);
    for code in ["M11", "M13"] {
        assert_eq!(proven(&machine, &without(&text, code)), Err("clamp"), "{code}");
    }
    // A plane that the control turns to by itself.
    let alone =
        "plane_tilt = \"\"\"\nG68.2 {{OX}} {{OY}} {{OZ}} {{E1}} {{E2}} {{E3}}\nG53.1\n\"\"\"\n";
    let alone = format!("{own}{alone}");
    assert!(load_text("own.toml", &alone).unwrap_err().message.contains("written as positions"));
    // Closed between the turn and the swivel.
    let early = text.replacen("G53.1\n", "M10\nN9999 G53.1\n", 1);
    assert_eq!(proven(&machine, &early), Err("clamp"));
}

#[test]
fn a_machine_with_clamps_says_all_that_they_need() {
    let fails = |old: &str, new: &str| {
        assert!(TABLE.contains(old), "{old}");
        let text = TABLE.replacen(old, new, 1);
        let found = load_text("own.toml", &text).map(|machine| post::check(&machine));
        match found {
            Err(found) => found.message.clone(),
            Ok(Err(found)) => found[0].message.clone(),
            Ok(Ok(())) => panic!("{new} is taken"),
        }
    };
    assert!(fails("clamp_open = 11\n", "").contains("both or none"));
    assert!(fails("clamp_open = 11", "clamp_open = 10").contains("both or none"));
    assert!(
        fails("clamp_open = 11", "clamp_open = 12").contains("opens a clamp and closes another")
    );
    let planes = fails("positioned = \"tool-center-angles\"", "positioned = \"vectors\"");
    assert!(planes.contains("written as positions"), "{planes}");
    assert!(fails("unclamp = ", "message = ").contains("unclamp"));
}

/// The clamps of the machine that a program comes from are none of another one.
#[test]
fn clamps_of_a_source_are_left_to_the_machine_and_reported() {
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let text = posted(&machine);
    let read = nc::read(&machine, Default::default(), "s.mpf", text.as_bytes()).unwrap();
    let clamps = read.program.records.iter().filter(|record| {
        matches!(record.op, program::Op::Clamp(clamp) if clamp.axes == program::Axes::A | program::Axes::C || clamp.axes == program::Axes::A)
    });
    assert!(clamps.count() > 2);
    let target = load("fanuc-table-bc").unwrap();
    let output = post::write(&read.program, &target).unwrap();
    assert!(
        output.warnings.iter().any(|found| found.rule.name() == "clamp"),
        "{:?}",
        output.warnings
    );
    let text = String::from_utf8(output.text).unwrap();
    assert!(!text.lines().any(|line| line.contains("M26") || line.contains("M27")), "{text}");
}
