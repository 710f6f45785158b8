//! Lengths and work offsets on the way: damages, most of them by dice, the same each time. A tool length that begins in a block without Z,
//! one that is none or another's before and behind the cuts, another work offset, and corners of rapids near the part that are rounded.

use crate::dice::Dice;
use crate::files::root;
use control::{Action, Setup};
use machine::{Machine, load};
use program::Program;

/// So many damages of each kind.
const DAMAGES: usize = 60;

fn job(axes: &str) -> Program {
    let text = std::fs::read(root().join(format!("machines/samples/{axes}.cls"))).unwrap();
    source::apt::read("job.cls", &text, &Default::default()).unwrap().program
}

fn written(source: &Program, machine: &Machine) -> Vec<String> {
    let text = String::from_utf8(post::write(source, machine).unwrap().text).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// The rules that a program breaks.
fn rules(source: &Program, machine: &Machine, lines: &[String]) -> Vec<&'static str> {
    let text = lines.join("\n") + "\n";
    let report = proof::prove(source, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.iter().map(|found| found.rule.name()).collect()
}

#[test]
fn a_length_in_a_block_without_z_is_refused_wherever_it_stands() {
    let mut dice = Dice(5006);
    for (name, axes) in [("fanuc-table-bc", "five-axes"), ("generic-3axis-fanuc", "three-axes")] {
        let (source, machine) = (job(axes), load(name).unwrap());
        let good = written(&source, &machine);
        assert_eq!(rules(&source, &machine, &good), [""; 0]);
        let begins: Vec<usize> = (0..good.len()).filter(|at| good[*at].contains("G43")).collect();
        let first = good.iter().position(|line| line.contains("M6")).unwrap() + 1;
        for _ in 0..DAMAGES {
            let mut lines = good.clone();
            let at = dice.one_of(&begins);
            let code = if lines[at].contains("G43.4") { "G43.4" } else { "G43" };
            let register =
                lines[at].split(' ').find(|word| word.starts_with('H')).unwrap().to_owned();
            match dice.below(3) {
                // The length alone, and its position behind it.
                0 => {
                    lines[at] = lines[at]
                        .replace(&format!("{code} "), "")
                        .replace(&format!(" {register}"), "");
                    lines.insert(at, format!("{code} {register}"));
                }
                // No length at all.
                1 => {
                    lines[at] = lines[at]
                        .replace(&format!("{code} "), "")
                        .replace(&format!(" {register}"), "")
                }
                // Another one, anywhere behind the first tool.
                _ => {
                    let end = lines.len() - 2;
                    let at = first + dice.index(end - first);
                    lines.insert(at, format!("{code} H9"));
                }
            }
            assert!(!rules(&source, &machine, &lines).is_empty(), "{name}\n{}", lines.join("\n"));
        }
    }
}

#[test]
fn a_corner_of_a_rapid_that_begins_in_the_part_is_rounded_by_no_word() {
    let mut dice = Dice(64);
    let source = job("three-axes");
    for (name, wide, narrow) in [
        ("linuxcnc-mill", "G64 P", "G64 P0.005 Q0.005"),
        ("generic-3axis-haas", "G187 E", "G187 E0.01"),
        ("mach3-mill", "G64", "G61"),
    ] {
        let machine = load(name).unwrap();
        let good = written(&source, &machine);
        assert_eq!(rules(&source, &machine, &good), [""; 0]);
        let settings = nc::settings(&machine, Setup::default()).unwrap();
        let (mut low, mut z) = (Vec::new(), f64::NAN);
        control::read(&settings, "p", (good.join("\n") + "\n").as_bytes(), &mut |event| {
            if matches!(event.action, Action::Rapid(_)) && z < 0.0 {
                low.push(event.line as usize - 1);
            }
            if let Some(position) = event.action.position() {
                z = position.point.z;
            }
            Ok(())
        })
        .unwrap();
        assert!(!low.is_empty(), "{name}");
        for _ in 0..DAMAGES {
            let mut lines = good.clone();
            let at = dice.one_of(&low);
            let by = dice.number(0.2, 50.0);
            let word = if wide == "G64" { wide.to_owned() } else { format!("{wide}{by:?}") };
            lines.insert(at + 1, narrow.to_owned());
            lines.insert(at, word);
            assert_eq!(
                rules(&source, &machine, &lines),
                ["path-tolerance"],
                "{name}\n{}",
                lines.join("\n")
            );
        }
    }
}

/// The tip goes down by the length of the tool where the control does not count it, or counts that of another: before the first cut,
/// behind the last one, on the way to the tool change. In another work offset it goes anywhere.
#[test]
fn another_length_and_another_work_offset_are_refused_on_every_way() {
    let source = job("three-axes");
    let approach = "X10 Y10";
    let iso = ["G49 Z25", "G43 Z25 H0", "G43 Z25 H9"];
    let sinumerik = ["D0 Z25", "D2 Z25", "D0 Z20"];
    let mills: [(&str, &[&str], [&str; 2]); 6] = [
        ("generic-3axis-fanuc", &iso, ["G55", "G54"]),
        ("generic-3axis-haas", &iso, ["G55", "G54"]),
        ("generic-3axis-linuxcnc", &iso, ["G55", "G54"]),
        ("generic-3axis-mach3", &iso, ["G59", "G54"]),
        ("generic-3axis-sinumerik", &sinumerik, ["G55", "G54"]),
        (
            "generic-3axis-heidenhain",
            &["TOOL CALL 9 Z S100\nL Z+25 R0 FMAX"],
            ["CYCL DEF 247 DATUM SETTING Q339=+2", "CYCL DEF 247 DATUM SETTING Q339=+1"],
        ),
    ];
    for (name, lengths, [other, own]) in mills {
        let machine = load(name).unwrap();
        let good = written(&source, &machine);
        let bare = |line: &str| {
            let words = line.replace(['.', '+'], "");
            let number = words.split_once(' ').filter(|(n, _)| {
                n.trim_start_matches('N').bytes().all(|byte| byte.is_ascii_digit())
            });
            number.map_or(words.clone(), |(_, rest)| rest.to_owned())
        };
        let is_up = |line: &&String| {
            let line = bare(line);
            line.ends_with("Z20") || line.contains("Z20 H") || line.contains("Z20 R0 FMAX")
        };
        let is_over = |line: &&String| bare(line).contains(approach);
        // Above the slot behind the approach, above the ring on the way to the tool change, and at the end.
        let ups: Vec<usize> = (0..good.len()).filter(|at| is_up(&&good[*at])).collect();
        assert!(ups.len() >= 4, "{name}: {ups:?} {good:#?}");
        let klartext = name.ends_with("heidenhain");
        let try_out = |at: usize, blocks: &str| {
            let mut lines = good.clone();
            let point = if name.ends_with("fanuc") || name.ends_with("haas") { "." } else { "" };
            for (i, block) in blocks.lines().enumerate() {
                let words = block.split(' ').map(|word| match word.as_bytes() {
                    [b'X' | b'Y' | b'Z', ..] if !klartext => format!("{word}{point}"),
                    _ => word.to_owned(),
                });
                lines.insert(at + 1 + i, words.collect::<Vec<_>>().join(" "));
            }
            if klartext {
                let mut number = -1;
                for line in &mut lines {
                    let rest = line.split_once(' ').filter(|(n, _)| n.parse::<u32>().is_ok());
                    let continues = line.starts_with('Q');
                    if !continues {
                        number += 1;
                        *line =
                            format!("{number} {}", rest.map_or(line.as_str(), |(_, rest)| rest));
                    }
                }
            }
            (rules(&source, &machine, &lines), lines.join("\n"))
        };
        for &at in &ups {
            for length in lengths {
                let (found, text) = try_out(at, length);
                assert!(!found.is_empty(), "{name} {length}\n{text}");
            }
            let down = if klartext { "L Z+25 R0 FMAX" } else { "Z25" };
            let (found, text) = try_out(at, &format!("{other}\n{down}\n{own}"));
            assert!(found.contains(&"work-offset"), "{name} {found:?}\n{text}");
        }
        // Down to the part in another work offset, before the first point of the source.
        let over = good.iter().position(|line| is_over(&line)).unwrap();
        let down = match klartext {
            true => {
                format!("{other}\nL X+10 Y+10 R0 FMAX\nL Z+3 R0 FMAX\n{own}\nL X+10 Y+10 R0 FMAX")
            }
            false => format!("{other}\nX10 Y10\nZ3\n{own}\nX10 Y10"),
        };
        let (found, text) = try_out(over, &down);
        assert!(!found.is_empty(), "{name}\n{text}");
    }
}
