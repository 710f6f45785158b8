//! Damages by dice, the same each time, that two rules have to find: a tool length that begins in a block without Z, and corners of rapids
//! near the part that are rounded.

mod dice;
mod files;

use control::{Action, Setup};
use dice::Dice;
use files::root;
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
