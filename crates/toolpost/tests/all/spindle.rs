//! When the spindle is switched, on every mill of the library: it is started where something needs it, and stopped once.

use crate::files::{mills, root, sources};
use control::{Action, Setup};
use geom::Vec3;
use machine::Machine;
use program::{Cycle, CycleKind, Feed, Op, Pose, Program, Spindle, Tool};
use std::collections::BTreeSet;
use std::path::Path;

/// Numbers of the M functions of a block, in order; what stands in comments and quotes is none.
fn functions(block: &str) -> Vec<u32> {
    let (mut found, mut brackets, mut quoted, mut word) = (Vec::new(), 0, false, false);
    for (at, c) in block.char_indices() {
        match c {
            ';' => break,
            '"' => quoted = !quoted,
            '(' => brackets += 1,
            ')' => brackets -= 1,
            'M' if brackets == 0 && !quoted && !word => {
                let digits = block[at + 1..].split(|c: char| !c.is_ascii_digit()).next().unwrap();
                found.extend(digits.parse::<u32>());
            }
            _ => {}
        }
        word = c.is_ascii_alphabetic();
    }
    found
}

/// The lines of a program on which something needs the spindle: cuts, holes, dwells.
fn lines_that_need_it(machine: &Machine, text: &str) -> BTreeSet<u32> {
    let mut lines = BTreeSet::new();
    let needs = |action: &Action| {
        matches!(
            action,
            Action::Line(_)
                | Action::Arc(_)
                | Action::Hole(_)
                | Action::Thread(_)
                | Action::Dwell(_)
        )
    };
    control::read(
        &nc::settings(machine, Setup::default()).unwrap(),
        "p",
        text.as_bytes(),
        &mut |event| {
            if needs(&event.action) {
                lines.insert(event.line);
            }
            Ok(())
        },
    )
    .unwrap();
    lines
}

/// What a program does twice, or for nothing.
fn idle(machine: &Machine, text: &str) -> Option<String> {
    let needed = lines_that_need_it(machine, text);
    let (mut stopped, mut started) = (false, None);
    for (line, block) in (1..).zip(text.lines()) {
        if needed.contains(&line) {
            started = None;
        }
        for function in functions(block) {
            match function {
                3 | 4 | 13 | 14 => (stopped, started) = (false, Some(line)),
                5 if stopped => return Some(format!("{line}: a second M5")),
                0 | 1 | 2 | 5 | 6 | 30 => {
                    if let Some(line) = started {
                        return Some(format!("{line}: a start for nothing"));
                    }
                    stopped |= function == 5;
                }
                _ => {}
            }
        }
    }
    None
}

fn at(x: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, 0.0, z)).unwrap()
}

fn hole(kind: CycleKind) -> [Op; 3] {
    let cycle = Cycle {
        kind,
        depth: 6.0,
        clearance: 2.0,
        retract: 5.0,
        feed: Some(Feed::PerMinute(100.0)),
        peck: None,
        first_peck: None,
        dwell: 0.0,
    };
    [Op::Cycle(Box::new(cycle)), Op::Hole(at(10.0, 0.0)), Op::CycleOff]
}

/// Jobs whose spindle a control or an operator stops besides the source: taps, bores, stops.
fn jobs() -> Vec<(&'static str, Vec<Op>)> {
    let tap = CycleKind::Tap { pitch: 1.0, left: false };
    let up = || Op::Rapid(at(10.0, 50.0));
    let off = || Op::Spindle(Spindle::Off);
    let on = |speed| Op::Spindle(Spindle::Clockwise(speed));
    let next = || Op::Tool(Box::new(Tool { number: 2, ..Tool::default() }));
    let cut = || Op::Line(at(20.0, -1.0));
    let with = |kind, rest: Vec<Op>| hole(kind).into_iter().chain(rest).collect::<Vec<_>>();
    vec![
        ("tap, up, off", with(tap, vec![up(), off()])),
        ("tap, up, end", with(tap, vec![up()])),
        ("tap, up, next tool", with(tap, vec![up(), next(), up(), cut(), off(), up()])),
        ("bore, up, off", with(CycleKind::Bore, vec![up(), off(), up()])),
        (
            "off, stop, next tool",
            vec![cut(), up(), off(), Op::Stop, next(), on(900.0), up(), cut()],
        ),
        ("stop, up, end", vec![cut(), Op::Stop, up()]),
        ("stop, operation, up, off", vec![cut(), Op::Stop, Op::Operation("B".into()), up(), off()]),
        (
            "optional stop, next tool",
            vec![cut(), up(), off(), Op::OptionalStop, next(), up(), cut()],
        ),
        ("two speeds, one cut", vec![on(500.0), up(), on(900.0), up(), cut(), off()]),
        ("a speed for nothing", vec![cut(), on(500.0), up(), off(), off()]),
        ("warm up", vec![on(900.0), up(), Op::Dwell(60.0), off(), up()]),
    ]
}

fn program(ops: Vec<Op>) -> Program {
    let start = [
        Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })),
        Op::Spindle(Spindle::Clockwise(600.0)),
        Op::Feed(Feed::PerMinute(200.0)),
        Op::Rapid(at(10.0, 20.0)),
    ];
    let mut program = Program::new("spindle");
    for (line, op) in (1..).zip(start.into_iter().chain(ops).chain([Op::End])) {
        program.push(line, op);
    }
    program
}

fn written(machine: &Machine, source: &Program) -> Option<String> {
    let text = post::write(source, machine).ok()?.text;
    let report = proof::prove(source, machine, "p", &text, &Default::default());
    assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    Some(String::from_utf8(text).unwrap())
}

fn read(path: &Path) -> Program {
    let text = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_string_lossy();
    source::apt::read(&name, &text, &Default::default()).unwrap().program
}

#[test]
fn no_program_stops_its_spindle_twice_or_starts_it_for_nothing() {
    let samples = ["three-axes", "five-axes"];
    let samples = samples.map(|name| root().join(format!("machines/samples/{name}.cls")));
    let examples = sources().into_iter().filter(|path| path.starts_with(root().join("examples")));
    let mut sources: Vec<(String, Program)> =
        jobs().into_iter().map(|(name, ops)| (name.to_owned(), program(ops))).collect();
    sources.extend(
        samples.into_iter().chain(examples).map(|path| (path.display().to_string(), read(&path))),
    );
    let (mut made, mut wrong) = (0, Vec::new());
    for machine in mills() {
        for (name, source) in &sources {
            let Some(text) = written(&machine, source) else { continue };
            made += 1;
            wrong.extend(idle(&machine, &text).map(|why| format!("{} {name}:{why}", machine.name)));
        }
    }
    assert!(made > 200, "{made} programs");
    assert!(wrong.is_empty(), "{} of {made}: {wrong:#?}", wrong.len());
}

#[test]
fn the_functions_of_a_block_are_those_outside_of_comments_and_quotes() {
    assert_eq!(functions("N10 G75Z0M5M9 (M3 first) T=\"M4\" ; M30"), [5, 9]);
    assert_eq!(functions("12 L Z+0 R0 FMAX M91"), [91]);
}

/// The program of a slot on the machine of this text.
fn slot(text: &str) -> (Program, Machine, String) {
    let machine = machine::load_text("m.toml", text).unwrap();
    let up = || Op::Rapid(at(10.0, 20.0));
    let source = program(vec![
        Op::Line(at(10.0, -1.0)),
        up(),
        Op::Stop,
        up(),
        Op::Line(at(10.0, -2.0)),
        up(),
    ]);
    let text = written(&machine, &source).unwrap();
    (source, machine, text)
}

fn rules(source: &Program, machine: &Machine, text: &str) -> Vec<&'static str> {
    let report = proof::prove(source, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.iter().map(|found| found.rule.name()).collect()
}

/// Two seconds, in the unit of each control.
#[test]
fn behind_each_start_of_a_spindle_that_nobody_waits_for_the_program_dwells() {
    for (name, start, dwell) in [
        ("generic-3axis-fanuc", "S600 M3", "G4 X2."),
        ("generic-3axis-haas", "S600 M3", "G4 P2000"),
        ("generic-3axis-grbl", "S600 M3", "G4 P2"),
        ("generic-3axis-marlin", "M3 S600", "G4 P2000"),
        ("generic-3axis-mach3", "S600 M3", "G4 P2"),
    ] {
        let file = format!("extends = \"{name}\"\n[spindle]\ndwell = 2\n");
        let (source, machine, text) = slot(&file);
        let blocks: Vec<&str> = text.lines().collect();
        let starts = blocks.windows(2).filter(|two| two[0].ends_with(start));
        // At the start, and behind the stop, at which the operator may have switched it off.
        assert_eq!(starts.filter(|two| two[1].ends_with(dwell)).count(), 2, "{name}: {text}");
        assert_eq!(blocks.iter().filter(|block| block.ends_with(dwell)).count(), 2, "{name}");
        assert_eq!(rules(&source, &machine, &text), [""; 0]);
    }
}

#[test]
fn a_cut_before_the_spindle_has_its_speed_is_refused() {
    let (source, machine, text) = slot("extends = \"generic-3axis-grbl\"\n[spindle]\ndwell = 2\n");
    for (was, is, rule) in [
        ("M3\nG4 P2\n", "M3\n", "spindle-dwell"),
        ("M3\nG4 P2\n", "M3\nG4 P1.5\n", "spindle-dwell"),
        // It is no dwell of the machine's where nothing has started.
        ("G1 Z-1 F200\n", "G1 Z-1 F200\nG4 P2\n", "dwell"),
        ("M3\nG4 P2\n", "M3\nG4 P2\nG4 P2\n", "dwell"),
    ] {
        let wrong = text.replacen(was, is, 1);
        assert_ne!(wrong, text, "{was}");
        assert!(rules(&source, &machine, &wrong).contains(&rule), "{rule}: {wrong}");
    }
    // A machine whose file says nothing of it is not asked for it.
    let (source, machine, text) = slot("extends = \"linuxcnc-mill\"\n");
    assert!(!text.contains("G4 "));
    assert_eq!(rules(&source, &machine, &text), [""; 0]);
}

/// A slot that ends at its bottom: out by rapid, across, and back by rapid into what has been cut.
fn deep_slot() -> Program {
    program(vec![
        Op::Line(at(10.0, -8.0)),
        Op::Line(at(30.0, -8.0)),
        Op::Rapid(at(30.0, 20.0)),
        Op::Rapid(at(12.0, 20.0)),
        Op::Rapid(at(12.0, -7.0)),
        Op::Line(at(20.0, -9.0)),
        Op::Rapid(at(20.0, 20.0)),
    ])
}

/// The lines of the rapids of a program from which the tool goes out of the slot, and into it, and of the cut behind them.
fn lines_of_the_slot(machine: &Machine, text: &str) -> [usize; 3] {
    let (mut cut, mut lines) = (false, Vec::new());
    let settings = nc::settings(machine, Setup::default()).unwrap();
    control::read(&settings, "p", text.as_bytes(), &mut |event| {
        let low = |position: &control::Position| position.point.z < 0.0;
        match &event.action {
            Action::Line(_) if lines.len() == 2 => lines.push(event.line as usize - 1),
            Action::Line(_) => cut = true,
            Action::Rapid(_) if cut && lines.is_empty() => lines.push(event.line as usize - 1),
            Action::Rapid(to) if lines.len() == 1 && low(to) => {
                lines.push(event.line as usize - 1);
            }
            _ => {}
        }
        Ok(())
    })
    .unwrap();
    lines.try_into().unwrap()
}

/// The text with blocks put in before these lines, from 0; Klartext is numbered anew.
fn with(machine: &Machine, text: &str, blocks: &[(usize, &str)]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (line, block) in blocks.iter().rev() {
        lines.insert(*line, block.to_string());
    }
    if machine.reader != "klartext" {
        return lines.join("\n") + "\n";
    }
    let plain = |line: &String| match line.split_once(' ') {
        Some((number, rest)) if number.parse::<u32>().is_ok() => rest.to_owned(),
        _ => line.clone(),
    };
    let numbered = |(n, line): (usize, &String)| format!("{n} {}\n", plain(line));
    lines.iter().enumerate().map(numbered).collect()
}

/// The tester's damage: the tool is drawn out of a slot, or goes back into it, with a spindle that stands, turns the other way round
/// or is slow, and is started anew before the next cut. At height the program may stop and start it.
#[test]
fn near_the_part_the_spindle_turns_as_the_source_says_by_rapid_too() {
    for (name, words, on) in [
        ("generic-3axis-fanuc", &["M5", "M4", "M19", "S50"][..], "S600 M3"),
        ("generic-3axis-haas", &["M5", "M4", "M19", "S50"], "S600 M3"),
        ("generic-3axis-sinumerik", &["M5", "M4", "M19", "SPOS=0", "S50"], "S600 M3"),
        ("generic-3axis-linuxcnc", &["M5", "M4", "M19 R0", "S50"], "S600 M3"),
        ("generic-3axis-mach3", &["M5", "M4", "S50"], "S600 M3"),
        ("generic-3axis-grbl", &["M5", "M4", "S50"], "S600 M3"),
        ("generic-3axis-heidenhain", &["M5", "M4"], "M3"),
    ] {
        let machine = machine::load(name).unwrap();
        let source = deep_slot();
        let text = written(&machine, &source).unwrap();
        let [out, back, cut] = lines_of_the_slot(&machine, &text);
        for word in words {
            for damage in [[(out, *word), (cut, on)], [(back, word), (cut, on)]] {
                let wrong = with(&machine, &text, &damage);
                let found = rules(&source, &machine, &wrong);
                assert!(found.contains(&"spindle"), "{name} {damage:?}: {found:?}\n{wrong}");
            }
            let dwell = format!("G4 P{}", machine.spindle.dwell);
            let mut own = vec![(back, *word), (back, on)];
            own.extend(
                (machine.spindle.dwell > 0.0 && *word != "S50").then_some((back, dwell.as_str())),
            );
            let own = with(&machine, &text, &own);
            // But never in a direction in which it turns nowhere in the source.
            let found: &[&str] = if *word == "M4" { &["spindle"] } else { &[] };
            assert_eq!(rules(&source, &machine, &own), found, "{name} {word}\n{own}");
        }
    }
}

/// A cutter bursts in the air too: no tool turns faster than the source names a speed for it, wherever it is.
#[test]
fn no_tool_turns_faster_than_the_source_names_a_speed_for_it() {
    let on = |speed: f64| Op::Spindle(Spindle::Clockwise(speed));
    let next = || Op::Tool(Box::new(Tool { number: 2, ..Tool::default() }));
    let up = || Op::Rapid(at(10.0, 50.0));
    let cut = || Op::Line(at(20.0, -1.0));
    // T1 600 and 900, T2 2000, and T1 once more at 600.
    let first = || Op::Tool(Box::new(Tool { number: 1, ..Tool::default() }));
    let source = program(vec![
        cut(),
        up(),
        on(900.0),
        cut(),
        up(),
        next(),
        on(2000.0),
        up(),
        cut(),
        up(),
        first(),
        on(600.0),
        up(),
        cut(),
        up(),
    ]);
    for (name, is_klartext) in [
        ("generic-3axis-fanuc", false),
        ("generic-3axis-haas", false),
        ("generic-3axis-sinumerik", false),
        ("generic-3axis-linuxcnc", false),
        ("generic-3axis-heidenhain", true),
    ] {
        let machine = machine::load(name).unwrap();
        let text = written(&machine, &source).unwrap_or_else(|| panic!("{name}"));
        // Behind each retract that is high over the part: T1, T1 at 900, T2, T1.
        let (mut high, mut low) = (Vec::new(), false);
        let settings = nc::settings(&machine, Setup::default()).unwrap();
        control::read(&settings, "p", text.as_bytes(), &mut |event| {
            if let Some(to) = event.action.position() {
                if low && to.point.z == 50.0 {
                    high.push(event.line as usize);
                }
                low = to.point.z < 0.0;
            }
            Ok(())
        })
        .unwrap();
        let [first, second, third, last] = high[..] else { panic!("{name} {high:?}\n{text}") };
        for (line, speed, is_right) in [
            (first, 900, true),
            (first, 901, false),
            (first, 15000, false),
            (second, 300, true),
            (second, 2000, false),
            (third, 2000, true),
            (third, 600, true),
            (third, 2001, false),
            (last, 900, true),
            (last, 2000, false),
        ] {
            let word = match is_klartext {
                true => format!("TOOL CALL Z S{speed}"),
                false => format!("S{speed}"),
            };
            // Where the cut behind it needs its own speed.
            let back = if line == first { "900" } else { "" };
            let mut blocks = vec![(line, word.as_str())];
            let again = match is_klartext {
                true => format!("TOOL CALL Z S{back}"),
                false => format!("S{back}"),
            };
            blocks.extend((!back.is_empty()).then_some((line, again.as_str())));
            let changed = with(&machine, &text, &blocks);
            let expected: &[&str] = if is_right { &[] } else { &["spindle"] };
            assert_eq!(rules(&source, &machine, &changed), expected, "{name} {word}\n{changed}");
        }
    }
}

/// What the source itself switches at the bottom is right there, and no other.
#[test]
fn a_source_that_stops_the_spindle_before_it_draws_the_tool_out_is_followed() {
    let machine = machine::load("generic-3axis-fanuc").unwrap();
    let source = program(vec![
        Op::Line(at(10.0, -8.0)),
        Op::Spindle(Spindle::Off),
        Op::Rapid(at(10.0, 20.0)),
    ]);
    let text = written(&machine, &source).unwrap();
    let last = text.lines().rfind(|line| line.ends_with("M5")).unwrap();
    let wrong = text.replacen(&format!("{last}\n"), "", 1);
    assert!(rules(&source, &machine, &wrong).contains(&"spindle"), "{wrong}");
}

/// The program with these words before the second cut, one block each.
fn between_cuts(machine: &Machine, text: &str, words: &[&str]) -> String {
    let mut cuts = Vec::new();
    let settings = nc::settings(machine, Setup::default()).unwrap();
    control::read(&settings, "p", text.as_bytes(), &mut |event| {
        if matches!(event.action, Action::Line(_)) {
            cuts.push(event.line as usize);
        }
        Ok(())
    })
    .unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let at = cuts[1] - 1;
    for word in words.iter().rev() {
        lines.insert(at, (*word).to_owned());
    }
    if !text.contains("BEGIN PGM") {
        return lines.join("\n") + "\n";
    }
    // HEIDENHAIN numbers every block, and counts one that goes on in further lines once.
    let (mut number, mut goes_on) = (0, false);
    for line in &mut lines {
        let bare = line.split_once(' ').filter(|(word, _)| word.parse::<u32>().is_ok());
        let words = bare.map_or(line.as_str(), |(_, words)| words).to_owned();
        let ends = !words.ends_with('~');
        if !goes_on {
            *line = format!("{number} {words}");
            number += 1;
        }
        goes_on = !ends;
    }
    lines.join("\n") + "\n"
}

/// Between two cuts the tool stands in the part: a spindle that stops or turns the other way round there breaks it, though it turns
/// rightly again before the next cut. Faster than it can turn it is switched on nowhere.
#[test]
fn what_the_spindle_does_between_two_cuts_is_compared() {
    let source = program(vec![
        Op::Line(at(20.0, -1.0)),
        Op::Line(at(30.0, -1.0)),
        Op::Rapid(at(30.0, 20.0)),
        Op::Spindle(Spindle::Off),
    ]);
    for machine in mills() {
        let text = String::from_utf8(post::write(&source, &machine).unwrap().text).unwrap();
        let rules = |text: &str| {
            let report = proof::prove(&source, &machine, "p", text.as_bytes(), &Default::default());
            report.mismatches.iter().map(|found| found.rule.name()).collect::<Vec<_>>()
        };
        assert_eq!(rules(&text), [""; 0], "{}", machine.name);
        for words in [["M5", "S600 M3"], ["M4", "M3"]] {
            // A TOOL CALL switches the speed of a HEIDENHAIN, and S its own spindle nothing else.
            let words = words.map(|word| match text.contains("BEGIN PGM") {
                true => word.trim_start_matches("S600 "),
                false => word,
            });
            let damaged = between_cuts(&machine, &text, &words);
            let found = rules(&damaged);
            assert!(found.contains(&"spindle"), "{} {found:?}\n{damaged}", machine.name);
        }
        if machine.spindle.max.is_finite() {
            let fast = text.replace("S600", &format!("S{}", machine.spindle.max + 1.0));
            assert_ne!(fast, text, "{}", machine.name);
            let found = rules(&fast);
            assert!(found.contains(&"spindle-range"), "{} {found:?}\n{fast}", machine.name);
        }
    }
}
