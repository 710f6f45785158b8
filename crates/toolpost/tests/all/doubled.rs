//! No word of a program is written for nothing: each that is taken out of a block changes what the control does, or stands in a list
//! with its reason; and nothing is switched that the next block switches back before anything moves.

use crate::files::root;
use control::{Action, Setup};
use machine::Machine;
use program::Program;
use std::collections::BTreeMap;

/// A source, read from the project.
fn source(name: &str) -> Program {
    let text = std::fs::read(root().join(name)).unwrap();
    source::apt::read("job.cls", &text, &Default::default()).unwrap().program
}

/// Two tools, coolants, a stop, a dwell, a cycle, and the first tool again.
const SWITCHES: &str = "PARTNO/SWITCHES\nUNITS/MM\nLOADTL/1,LENGTH,60\nCUTTER/10,0\nSPINDL/1000,RPM,CLW\nCOOLNT/FLOOD\nFEDRAT/300,MMPM\n\
    RAPID\nGOTO/0,0,50\nRAPID\nGOTO/0,0,2\nGOTO/0,0,-1\nGOTO/20,0,-1\nDELAY/1\nGOTO/20,10,-1\nFEDRAT/200,MMPM\nGOTO/0,10,-1\nRAPID\n\
    GOTO/0,10,50\nSTOP\nSPINDL/1200,RPM,CLW\nRAPID\nGOTO/40,0,50\nGOTO/40,0,-1\nGOTO/60,0,-1\nRAPID\nGOTO/60,0,50\nCOOLNT/OFF\n\
    LOADTL/2,LENGTH,50\nCUTTER/6.8,0\nSPINDL/2000,RPM,CLW\nCOOLNT/FLOOD\nRAPID\nGOTO/10,10,50\n\
    CYCLE/DRILL,FEDTO,10,MMPM,150,RAPTO,2,RTRCTO,5\nGOTO/10,10,0\nGOTO/30,10,0\nCYCLE/OFF\nRAPID\nGOTO/30,10,50\nCOOLNT/OFF\n\
    SPINDL/OFF\nFINI\n";

/// The jobs of a machine.
fn jobs(machine: &Machine) -> Vec<(&'static str, Program)> {
    let axes = match machine.rotary.is_empty() {
        true => "machines/samples/three-axes.cls",
        false => "machines/samples/five-axes.cls",
    };
    let switches = source::apt::read("switches.cls", SWITCHES.as_bytes(), &Default::default());
    vec![
        ("sample", source(axes)),
        ("plate", source("examples/plate.cls")),
        ("switches", switches.unwrap().program),
    ]
}

/// What a program makes the machine do, without its lines and what is for people.
fn does(machine: &Machine, text: &str) -> Option<Vec<String>> {
    let settings = nc::settings(machine, Setup::default()).unwrap();
    let mut does = Vec::new();
    let read = control::read(&settings, "p", text.as_bytes(), &mut |event| {
        if !matches!(event.action, Action::Comment(_) | Action::Message(_)) {
            does.push(format!("{:?}", event.action));
        }
        Ok(())
    });
    read.ok().map(|_| does)
}

/// The words of a block with their places, without its comment. Where no blanks stand between them, a word begins at a letter behind a
/// digit.
fn words(line: &str) -> Vec<(usize, usize)> {
    let code = line.split([';', '(']).next().unwrap_or_default();
    let code = if line.contains("CYCLE") || line.contains('"') { line } else { code };
    let mut words: Vec<(usize, usize)> = Vec::new();
    let mut before = ' ';
    for (at, c) in code.char_indices() {
        let begins =
            before == ' ' || c.is_ascii_uppercase() && (before.is_ascii_digit() || before == '.');
        if c != ' ' && begins {
            words.push((at, at + c.len_utf8()));
        } else if c != ' '
            && let Some(last) = words.last_mut()
        {
            last.1 = at + c.len_utf8();
        }
        before = c;
    }
    words
}

/// Whether a word switches something: M, S, F, T, and G but for those that move.
fn switches(word: &str) -> bool {
    let mut letters = word.chars();
    let letter = letters.next().unwrap_or_default();
    let digits = letters.as_str();
    let number = digits.starts_with(|c: char| c.is_ascii_digit());
    number && ("MSFT".contains(letter) || letter == 'G' && !["0", "1", "2", "3"].contains(&digits))
}

/// Why a word that does nothing is written all the same.
fn reason(reader: &str, word: &str, block: &str) -> Option<&'static str> {
    let safe = words(block).iter().filter(|(from, _)| block[*from..].starts_with('G')).count() > 3;
    Some(match (reader, word) {
        _ if safe => "a line that cancels what an operator may have switched on between two tools",
        (_, "G80") => "a cycle is ended by its own word, before the move that would end it too",
        ("sinumerik" | "sinumerik-828d", "G17" | "G54") => {
            "each tool begins with its plane and its work offset"
        }
        ("sinumerik-828d", "M5") => "the spindle stands before the end, which stops it too",
        (_, "G98") => "each cycle says to which level it returns",
        ("fanuc" | "haas", "G43") => {
            "each H comes with it: behind G28 a parameter says whether H is enough"
        }
        ("fanuc" | "haas", "M5") if !block.contains("M3") => {
            "whether the spindle stands behind rigid tapping is not sure enough for a tool change"
        }
        ("fanuc", _) if block.contains("M29") => "M29 takes its S",
        ("haas", _) if word.starts_with('S') => "a tap of Haas takes its S from the block before",
        ("marlin", _) if word.starts_with('F') => "rapids and cuts have one F, which each says",
        ("klartext", "M126") => "each turn by words says which way it goes",
        _ => return None,
    })
}

/// The line behind the first tool change: the head before it cancels what another program may have left.
fn behind_head(lines: &[&str]) -> usize {
    let changes = |line: &&str| {
        let has = |(from, to): &(usize, usize)| ["M6", "T1"].contains(&&line[*from..*to]);
        line.contains("TOOL CALL") || words(line).iter().any(has)
    };
    lines.iter().position(changes).map_or(0, |at| at + 1)
}

#[test]
fn no_word_that_switches_something_is_written_for_nothing() {
    let (mut found, mut tried) = (BTreeMap::<String, Vec<String>>::new(), 0);
    for machine in crate::files::mills().filter(|machine| machine.reader != "points") {
        for (job, source) in jobs(&machine) {
            let Ok(output) = post::write(&source, &machine) else { continue };
            let text = String::from_utf8(output.text).unwrap();
            let whole = does(&machine, &text).unwrap();
            let lines: Vec<&str> = text.lines().collect();
            for (at, line) in lines.iter().enumerate().skip(behind_head(&lines)) {
                for (from, to) in words(line) {
                    let word = &line[from..to];
                    if !switches(word) || reason(&machine.reader, word, line).is_some() {
                        continue;
                    }
                    tried += 1;
                    let block = format!("{}{}", &line[..from], &line[to..]);
                    let mut without = lines.clone();
                    without[at] = &block;
                    if does(&machine, &(without.join("\n") + "\n")).as_ref() == Some(&whole) {
                        let place = format!("{} {job}, line {}: {line}", machine.name, at + 1);
                        found.entry(format!("{} {word}", machine.reader)).or_default().push(place);
                    }
                }
            }
        }
    }
    for (word, places) in &found {
        println!("{word}: {} times, {}", places.len(), places[0]);
    }
    assert!(found.is_empty() && tried > 500, "{tried} words");
}

/// The lines on which something is switched behind a tool change that has been switched before, and nothing has happened since.
fn switched_back(machine: &Machine, text: &[u8]) -> Vec<u32> {
    let settings = nc::settings(machine, Setup::default()).unwrap();
    let (mut found, mut last, mut begun) = (Vec::new(), BTreeMap::new(), false);
    control::read(&settings, "p", text, &mut |event| {
        begun |= matches!(event.action, Action::Tool(_));
        let kind = match event.action {
            Action::Spindle(_) => "spindle",
            Action::Coolant(_) => "coolant",
            Action::Feed(_) => "feed",
            Action::Compensation(_) => "compensation",
            Action::Comment(_) | Action::Message(_) | Action::PathMode(_) => return Ok(()),
            _ => {
                last.clear();
                return Ok(());
            }
        };
        let before = last.insert(kind, event.line);
        if begun && before.is_some_and(|line| line != event.line) {
            found.push(event.line);
        }
        Ok(())
    })
    .unwrap();
    found
}

/// What is switched runs until something moves, dwells or stops; nothing is switched back before.
#[test]
fn nothing_is_switched_that_the_next_block_switches_back() {
    for machine in crate::files::mills().filter(|machine| machine.reader != "points") {
        for (job, source) in jobs(&machine) {
            let Ok(output) = post::write(&source, &machine) else { continue };
            let lines = switched_back(&machine, &output.text);
            assert!(lines.is_empty(), "{} {job}: {lines:?}", machine.name);
        }
    }
    // The damages that it is to see.
    let machine = machine::load("generic-3axis-fanuc").unwrap();
    let source = &jobs(&machine)[2].1;
    let text = String::from_utf8(post::write(source, &machine).unwrap().text).unwrap();
    for damage in ["S1200 M3\nM5", "M8\nM9", "F5.\nF7."] {
        let damaged = text.replacen("M0\n", &format!("M0\n{damage}\n"), 1);
        assert!(!switched_back(&machine, damaged.as_bytes()).is_empty(), "{damage}\n{damaged}");
    }
}
