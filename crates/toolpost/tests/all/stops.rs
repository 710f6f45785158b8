//! Stops of a program, for which somebody opens the door: on each mill of the library the spindle stands, the coolant is off, and
//! the tool is home and comes back from there. Where it is in the cut, the program is refused.

use geom::Vec3;
use machine::library::{MACHINES, ROBOTS, names};
use machine::{Machine, load};
use program::{Coolant, Feed, Op, Pose, Program, Spindle, Tool};

fn mills() -> impl Iterator<Item = Machine> {
    names(MACHINES).map(|name| load(name).unwrap()).filter(|machine| machine.wire.is_none())
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

/// A groove of two cuts with `ops` between them, with coolant where the machine has it.
fn groove(machine: &Machine, ops: &[Op]) -> Program {
    let coolant = if machine.name == "grbl-3018" { Coolant::Off } else { Coolant::Flood };
    let start = [
        Op::Tool(Box::new(Tool { number: 1, length: Some(40.0), ..Tool::default() })),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Coolant(coolant),
        Op::Feed(Feed::PerMinute(200.0)),
        Op::Rapid(at(10.0, 5.0, 20.0)),
        Op::Rapid(at(10.0, 5.0, 2.0)),
        Op::Line(at(10.0, 5.0, -1.0)),
        Op::Line(at(30.0, 5.0, -1.0)),
    ];
    let end = [Op::Line(at(30.0, 8.0, -1.0)), Op::Rapid(at(30.0, 8.0, 20.0)), Op::End];
    let mut program = Program::new("groove");
    for (line, op) in (1..).zip(start.into_iter().chain(ops.iter().cloned()).chain(end)) {
        program.push(line, op);
    }
    program
}

fn proven(source: &Program, machine: &Machine, text: &str) -> Result<(), Vec<&'static str>> {
    let report = proof::prove(source, machine, "p", text.as_bytes(), &Default::default());
    let rules = report.mismatches.iter().map(|found| found.rule.name()).collect();
    if report.proven { Ok(()) } else { Err(rules) }
}

fn written(source: &Program, machine: &Machine) -> String {
    let output =
        post::write(source, machine).unwrap_or_else(|found| panic!("{}: {found:#?}", machine.name));
    let text = String::from_utf8(output.text).unwrap();
    proven(source, machine, &text)
        .unwrap_or_else(|why| panic!("{}: {why:?}\n{text}", machine.name));
    text
}

/// Whether one of the words of a block is this.
fn says(block: &str, word: &str) -> bool {
    block.split_whitespace().any(|w| w == word)
}

#[test]
fn at_a_stop_the_tool_is_home_and_spindle_and_coolant_are_off() {
    // Away by rapid, or by feed along the tool axis; then on by rapid, or by a cut from where the tool was.
    let outs = [Op::Rapid(at(30.0, 5.0, 20.0)), Op::Line(at(30.0, 5.0, 5.0))];
    for machine in mills() {
        let has_m1 = !machine.leaves_out("optional_stop");
        for out in &outs {
            for (stop, code) in [(Op::Stop, "M0"), (Op::OptionalStop, "M1")] {
                if stop == Op::OptionalStop && !has_m1 {
                    continue;
                }
                for on in [vec![], vec![Op::Rapid(at(30.0, 8.0, 20.0))]] {
                    let ops = [vec![out.clone(), stop.clone()], on].concat();
                    let source = groove(&machine, &ops);
                    let text = written(&source, &machine);
                    let blocks: Vec<&str> = text.lines().collect();
                    let stop = blocks.iter().rposition(|block| says(block, code)).unwrap();
                    let before = blocks[..stop].iter().rev().take(3).copied().collect::<String>();
                    let name = &machine.name;
                    assert!(before.contains("M5"), "{name}\n{text}");
                    assert!(before.contains("M9") || name == "grbl-3018", "{name}\n{text}");
                    // Without M5 or M9 it is the wrong program, but on the control that stops both itself.
                    let sure = machine.reader == "haas";
                    let off = ["M5", "M9"].map(|word| {
                        let at = blocks[..stop].iter().rposition(|block| block.ends_with(word));
                        let Some(at) = at else { return };
                        let wrong = [&blocks[..at], &blocks[at + 1..]].concat().join("\n") + "\n";
                        let by_m0 = machine.reader == "klartext" && word == "M5" && code == "M0";
                        let found = proven(&source, &machine, &wrong).err().unwrap_or_default();
                        let expected = !sure && !by_m0;
                        assert_eq!(found.contains(&"stop-running"), expected, "{name}\n{wrong}");
                    });
                    assert_eq!(off.len(), 2);
                }
            }
        }
    }
}

#[test]
fn a_stop_in_the_cut_is_refused_with_its_line_and_the_way_out() {
    for machine in mills() {
        let ends = [vec![], vec![Op::Line(at(31.0, 5.0, 5.0))]];
        for end in ends {
            let source = groove(&machine, &[end, vec![Op::Stop]].concat());
            let found = post::write(&source, &machine).unwrap_err();
            let line = source.records.iter().find(|record| record.op == Op::Stop).unwrap().line;
            assert_eq!(
                (found[0].rule.name(), found[0].line),
                ("stop-in-cut", line),
                "{}",
                machine.name
            );
            assert!(found[0].help.contains("draw the tool back"));
        }
    }
}

/// The groove, of which the source calls the next tool in the middle, and ends, with the tool in the cut.
fn left_in_cut(machine: &Machine) -> Program {
    let next = Op::Tool(Box::new(Tool { number: 2, length: Some(40.0), ..Tool::default() }));
    let mut source = groove(machine, &[next, Op::Rapid(at(30.0, 5.0, 20.0))]);
    let records = source.records.len();
    source.records.remove(records - 2);
    source
}

/// What is warned of the program's cuts, with lines.
fn warned(output: &post::Output) -> Vec<(u32, String)> {
    let found = output.warnings.iter().filter(|found| found.rule.name() == "ends-in-cut");
    found.map(|found| (found.line, found.message.clone())).collect()
}

/// One rule for all machines: an arm says of the same source what a mill says, goes up along the tool, and stops the spindle at home.
#[test]
fn a_robot_warns_of_a_source_that_ends_or_changes_the_tool_in_the_cut_as_a_mill_does() {
    let mill = load("generic-3axis-fanuc").unwrap();
    let expected = warned(&post::write(&left_in_cut(&mill), &mill).unwrap());
    assert_eq!(expected.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [9, 13]);
    for machine in names(ROBOTS).map(|name| load(name).unwrap()) {
        let source = left_in_cut(&machine);
        let output = post::write(&source, &machine).unwrap();
        assert_eq!(warned(&output), expected, "{}", machine.name);
        let text = String::from_utf8(output.text).unwrap();
        proven(&source, &machine, &text)
            .unwrap_or_else(|why| panic!("{}: {why:?}\n{text}", machine.name));
        // Out by feed along the tool, or by rapid.
        for out in [Op::Line(at(30.0, 8.0, 20.0)), Op::Rapid(at(30.0, 8.0, 20.0))] {
            let mut source = groove(&machine, &[]);
            let last = source.records.len() - 2;
            source.records[last].op = out;
            assert_eq!(warned(&post::write(&source, &machine).unwrap()), [], "{}", machine.name);
        }
    }
}

/// The source ends, or calls the next tool, with the tool in the cut: it is drawn back with the spindle turning, and that is said.
#[test]
fn the_spindle_turns_until_the_tool_is_out_of_the_cut() {
    for machine in mills() {
        let source = left_in_cut(&machine);
        let output = post::write(&source, &machine).unwrap();
        assert_eq!(warned(&output).len(), 2, "{}", machine.name);
        let text = String::from_utf8(output.text).unwrap();
        proven(&source, &machine, &text)
            .unwrap_or_else(|why| panic!("{}: {why:?}\n{text}", machine.name));
        let blocks: Vec<&str> = text.lines().collect();
        for (i, _) in blocks.iter().enumerate().filter(|(_, block)| says(block, "M5")) {
            let up = ["G28 Z0", "G53", "SUPA", "M91", "G75", "G90", "G49"];
            let over_work = machine.retract_height().is_some();
            let is_up = |block: &str| {
                up.iter().any(|word| block.contains(word)) || over_work && block == "G0 Z40"
            };
            let is_out = i == 0 || is_up(blocks[i - 1]);
            let tool_is_unknown = !blocks[..i].iter().any(|block| block.contains("M3"));
            let turret = machine.name.ends_with("emco-post");
            assert!(
                is_out || tool_is_unknown || turret,
                "{}: {}\n{text}",
                machine.name,
                blocks[i - 1]
            );
        }
    }
}

/// The sample that both heads of the library cut: the tool is changed behind a face at 0 and a slope at 45°. Without the block
/// that turns the head the magazine would take the tool from a leaning spindle.
#[test]
fn a_head_is_upright_where_its_tool_is_changed() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../machines/samples/five-axes.cls");
    let text = std::fs::read(path).unwrap();
    let source = source::apt::read("five-axes.cls", &text, &Default::default()).unwrap().program;
    for (name, turn) in [("sinumerik-840d-traori", "G0 A0 C0"), ("linuxcnc-xyzbc-head", "G0 B0 C0")]
    {
        let machine = load(name).unwrap();
        let text = written(&source, &machine);
        let blocks: Vec<&str> = text.lines().collect();
        let turns: Vec<usize> = (0..blocks.len()).filter(|i| blocks[*i].ends_with(turn)).collect();
        // Before both tools, and at the end.
        assert_eq!(turns.len(), 3, "{text}");
        for at in &turns[..2] {
            let wrong = [&blocks[..*at], &blocks[at + 1..]].concat().join("\n") + "\n";
            let found = proven(&source, &machine, &wrong).unwrap_err();
            assert!(found.contains(&"tool-change-tilt"), "{name}: {found:?}\n{wrong}");
        }
        let file = format!("extends = \"{name}\"\n[tools]\nturns_upright = true\n");
        let own = machine::load_text("own.toml", &file).unwrap();
        let unturned = [&blocks[..turns[1]], &blocks[turns[1] + 1..]].concat().join("\n") + "\n";
        let found = proven(&source, &own, &unturned).err().unwrap_or_default();
        assert!(!found.contains(&"tool-change-tilt"), "{found:?}");
    }
}
