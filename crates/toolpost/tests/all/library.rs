//! The machines of the library: the sample program of each, and what each makes of every file of
//! cutter-location data.

use crate::files::{mills, root, sources};
use machine::{Machine, OptionKey, OptionValue};
use program::{Diagnostic, Program};
use std::collections::BTreeSet;
use std::path::Path;

fn read(path: &Path) -> Program {
    let text = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_string_lossy();
    source::apt::read(&name, &text, &Default::default()).unwrap().program
}

/// The proven program, or why there is none.
fn proven(program: &Program, machine: &Machine) -> Result<Vec<u8>, Box<Diagnostic>> {
    let first = |found: Vec<Diagnostic>| found.into_iter().next().map(Box::new);
    let text = post::write(program, machine).map_err(|errors| first(errors).unwrap())?.text;
    let report = proof::prove(program, machine, "program", &text, &Default::default());
    first(report.mismatches).map_or(Ok(text), Err)
}

/// The samples were read by a person, against the programming manual of each control. Whoever changes
/// one on purpose writes it anew (`make samples`) and reads what has changed.
#[test]
fn the_sample_program_of_each_machine_is_as_it_was_read() {
    let samples = root().join("machines/samples");
    for machine in mills() {
        let name = &machine.name;
        let axes = if machine.rotary.is_empty() { "three-axes" } else { "five-axes" };
        let program = read(&samples.join(axes).with_extension("cls"));
        let text = proven(&program, &machine).unwrap_or_else(|why| panic!("{name}: {why}"));
        let sample = samples.join(format!("{name}.{}", machine.extension));
        let expected = std::fs::read_to_string(&sample).unwrap_or_default();
        let written = String::from_utf8(text).unwrap();
        let differs = written.lines().zip(expected.lines()).position(|(a, b)| a != b);
        let at = differs.unwrap_or(written.lines().count().min(expected.lines().count()));
        assert!(
            written == expected,
            "{}:{}: {:?}, but now {:?}",
            sample.display(),
            at + 1,
            expected.lines().nth(at),
            written.lines().nth(at)
        );
    }
}

/// The files whose tool axis turns, or points elsewhere than up.
const TILTED: &[&str] =
    &["dome.cls", "lean.cls", "Sacrifice-Board.apt", "Teste-Metrologia.apt", "shimemcunha.apt"];

/// What a machine cannot make, and why: the rule by which it refuses. Everything else is proven.
const REFUSED: &[(&str, &[&str], &str)] = &[
    ("generic-3axis-", TILTED, "unreachable-orientation"),
    ("linuxcnc-mill", TILTED, "unreachable-orientation"),
    ("mach3-mill", TILTED, "unreachable-orientation"),
    ("marlin-cnc", TILTED, "unreachable-orientation"),
    // From below: no table of these turns that far.
    ("sinumerik-840d-table-ac", &["Sacrifice-Board.apt"], "axis-limit"),
    ("fanuc-table-bc", &["Sacrifice-Board.apt"], "axis-limit"),
    ("haas-umc-750", &["Sacrifice-Board.apt"], "axis-limit"),
    ("sinumerik-840d-traori", &["Sacrifice-Board.apt"], "axis-limit"),
    ("dmu50-heidenhain", &["Sacrifice-Board.apt"], "unreachable-orientation"),
    ("linuxcnc-xyz", &["Sacrifice-Board.apt"], "axis-limit"),
    // Taps need a cycle, and that the kinematics of the axes.
    ("linuxcnc-xyzbc-head", &["plate.cls"], "cycle-tap"),
    // Nothing couples feed and spindle in a tap.
    ("generic-3axis-iso", &["plate.cls"], "cycle-tap"),
    ("generic-3axis-mach3", &["plate.cls"], "cycle-tap"),
    ("mach3-mill", &["plate.cls"], "cycle-tap"),
    // No tapping.
    ("generic-3axis-grbl", &["plate.cls"], "cycle-tap"),
    ("generic-3axis-marlin", &["plate.cls"], "cycle-tap"),
    ("marlin-cnc", &["plate.cls"], "cycle-tap"),
    // Too high, too long, too fast for the machines of a desk.
    ("marlin-cnc", &["coremill.cls"], "axis-limit"),
    ("linuxcnc-mill", &["Top-light-cover.apt", "coremill.cls"], "axis-limit"),
    ("linuxcnc-mill", &["Dem-target1.apt", "Dem-target2.apt"], "spindle-range"),
    ("mach3-mill", &["SupPetriLED.apt", "coremill.cls"], "axis-limit"),
    // No coolant, 45 mm in Z, 10,000 1/min.
    ("grbl-3018", &["coremill.cls", "plate.cls"], "axis-limit"),
    ("grbl-3018", &["Dem-target1.apt", "Dem-target2.apt"], "spindle-range"),
    ("grbl-3018", TILTED, "unreachable-orientation"),
    (
        "grbl-3018",
        &[
            "Interface-glue.apt",
            "SupPetriLED.apt",
            "Teflon-gasket.apt",
            "Top-light-cover.apt",
            "basemach.apt",
        ],
        "missing-block",
    ),
    // A small mill: 5000 1/min, ten tools, 150 mm in Y.
    ("emco-", &["plate.cls"], "spindle-range"),
    ("emco-", &["coremill.cls"], "axis-limit"),
    ("emco-", TILTED, "unreachable-orientation"),
    (
        "emco-",
        &[
            "Plane_1.cldata",
            "Plane_2.cldata",
            "Dem-target1.apt",
            "Dem-target2.apt",
            "Interface-glue.apt",
            "SupPetriLED.apt",
            "Teflon-gasket.apt",
            "Top-light-cover.apt",
            "basemach.apt",
        ],
        "tool-range",
    ),
];

#[test]
fn every_file_is_proven_on_every_machine_that_can_make_it() {
    for file in &sources() {
        let (program, file) = (read(file), file.file_name().unwrap().to_string_lossy());
        for machine in mills() {
            let name = machine.name.as_str();
            let rules: Vec<&str> = (REFUSED.iter())
                .filter(|(machine, files, _)| {
                    name.starts_with(machine) && files.contains(&file.as_ref())
                })
                .map(|(_, _, rule)| *rule)
                .collect();
            match proven(&program, &machine) {
                Ok(_) => assert!(rules.is_empty(), "{file} on {name}: made, not {rules:?}"),
                Err(why) => {
                    assert!(rules.contains(&why.rule.name()), "{file} on {name}, {rules:?}: {why}");
                    assert!(why.line > 0, "{file} on {name}: no line in {why}");
                }
            }
        }
    }
}

/// Whether a machine file has no mistake, and no key that does nothing.
fn holds(text: &str) -> bool {
    machine::load_text("mine.toml", text).is_ok_and(|machine| {
        post::check(&machine).is_ok() && post::without_effect(&machine).is_empty()
    })
}

/// The keys of a machine file that do nothing.
fn idle(text: &str) -> Vec<(u32, String)> {
    let found = post::without_effect(&machine::load_text("mine.toml", text).unwrap());
    assert!(
        found.iter().all(|found| found.rule.name() == "no-effect" && found.file == "mine.toml")
    );
    found
        .into_iter()
        .map(|found| (found.line, format!("{} = {}", found.message, found.help)))
        .collect()
}

#[test]
fn no_file_of_the_library_states_a_key_that_does_nothing() {
    for name in machine::library::names(machine::library::CONTROLLED) {
        let found = post::without_effect(&machine::load(name).unwrap());
        assert!(found.is_empty(), "{name}: {found:?}");
    }
}

/// An option that is stated in the library is read by the code, or by a template of some machine that has it: a new one that neither does is found
/// here, and one that the code alone reads has its name in `OptionKey`.
#[test]
fn every_option_of_the_library_does_something_somewhere() {
    let mut all = BTreeSet::new();
    let mut read = BTreeSet::new();
    for name in machine::library::names(machine::library::CONTROLLED) {
        for (option, value) in machine::load(name).unwrap().options {
            let value = match value {
                OptionValue::Flag(flag) => flag.to_string(),
                OptionValue::Number(number) => number.to_string(),
                OptionValue::Text(text) => format!("{text:?}"),
            };
            let text = format!("extends = \"{name}\"\n[options]\n{option} = {value}\n");
            let lines = idle(&text);
            all.insert(option.clone());
            if lines.is_empty() {
                read.insert(option);
            }
        }
    }
    assert_eq!(all.difference(&read).collect::<Vec<_>>(), [""; 0]);
    let stated: BTreeSet<&str> =
        machine::library::options().iter().map(|option| option.name).collect();
    let unstated = OptionKey::ALL.iter().filter(|key| !stated.contains(key.name()));
    assert_eq!(unstated.collect::<Vec<_>>(), Vec::<&OptionKey>::new());
}

/// Another safe height makes another program wherever no warning says that it does nothing.
#[test]
fn a_safe_height_moves_the_retracts_of_a_machine_or_is_warned_of() {
    let samples = root().join("machines/samples");
    let mut warned = Vec::new();
    for machine in mills() {
        let name = &machine.name;
        let axes = if machine.rotary.is_empty() { "three-axes" } else { "five-axes" };
        // A tool change that takes Z home by itself leaves a stop to retract before.
        let text = std::fs::read_to_string(samples.join(axes).with_extension("cls")).unwrap();
        let text = text.replacen("FINI", "STOP\nFINI", 1);
        let program =
            source::apt::read("job.cls", text.as_bytes(), &Default::default()).unwrap().program;
        assert!(program.records.iter().any(|record| record.op == program::Op::Stop));
        let top = if machine.linear[2].max.is_finite() { machine.linear[2].max } else { 400.0 };
        let with = |height: f64| format!("extends = \"{name}\"\nsafe_height = {height}\n");
        let written = |height: f64| {
            let machine = machine::load_text("mine.toml", &with(height)).unwrap();
            post::write(&program, &machine).unwrap().text
        };
        let differs = written(top) != written(top - 1.0);
        let found = idle(&with(top));
        assert_eq!(found.is_empty(), differs, "{name}: {found:?}");
        warned.extend(found.first().map(|(line, said)| (name.clone(), *line, said.clone())));
    }
    let of = |name: &str| warned.iter().find(|(warned, ..)| warned == name).unwrap();
    // Step 5 of docs/your-shop.md.
    let (_, line, said) = of("generic-3axis-fanuc");
    assert_eq!(*line, 2);
    assert!(
        said.ends_with("`retract_by_g53 = true` below [options]: retracts then go to it"),
        "{said}"
    );
    assert!(of("grbl-3018").2.contains("retract"), "{warned:?}");
}

#[test]
fn a_key_that_does_nothing_is_warned_of_with_its_line_where_it_is_checked_and_where_it_is_posted() {
    for (extends, text, key) in [
        ("generic-3axis-fanuc", "[settings]\nrotary_by_sign = true\n", "no rotary axis"),
        ("fanuc-table-bc", "[settings]\nhigh_feed = 3000\n", "rapids go straight"),
        ("generic-3axis-grbl", "[settings]\ndwell_p_milliseconds = true\n", "`reader` is grbl"),
        ("generic-3axis-haas", "[capabilities]\nprogram_lines = 100\n", "for robots"),
        ("generic-3axis-fanuc", "[options]\nprogram_numbr = 7\n", "no block of this machine reads"),
        ("generic-3axis-grbl", "[words]\nRX = { decimals = 3 }\n", "places this word"),
        ("kuka-kr6-r900", "[cell]\nown_frame = 3\n", "no block of this control"),
        ("kuka-kr6-r900", "[settings]\nrapid_path = \"linear\"\n", "[settings] is for mills"),
    ] {
        let text = format!("extends = \"{extends}\"\n{text}");
        let found = idle(&text);
        assert_eq!((found.len(), found[0].0), (1, 3), "{text}{found:?}");
        assert!(found[0].1.contains(key), "{text}{found:?}");
        let machine = machine::load_text("mine.toml", &text).unwrap();
        let sample = if machine.arm.is_some() { "robot" } else { "three-axes" };
        let program = read(&root().join("machines/samples").join(sample).with_extension("cls"));
        if machine.rotary.is_empty() {
            let output = post::write(&program, &machine).unwrap();
            let warned = output.warnings.iter().filter(|found| found.rule.name() == "no-effect");
            assert_eq!(warned.count(), 1, "{text}");
        }
    }
    // What does something is not warned of.
    for (extends, text) in [
        ("generic-3axis-fanuc", "safe_height = -5\n[options]\nretract_by_g53 = true\n"),
        ("fanuc-lrmate-200id-mill", "[cell]\nown_frame = 3\nload_number = 2\n"),
        ("kuka-kr6-r900", "[cell]\nload_mass = 3\nload_center = [0, 0, 50]\n"),
        (
            "generic-3axis-fanuc",
            "[options]\nmine = 3\n[blocks]\nstop = \"{% if options.mine %}{{N}} M0{% endif %}\"\n",
        ),
    ] {
        assert_eq!(idle(&format!("extends = \"{extends}\"\n{text}")), [], "{extends}");
    }
}

/// What `machines new` offers as comments holds when the `#` before it is taken away: one key alone, those of a table, and all of them.
#[test]
fn each_key_that_is_offered_to_a_new_machine_holds_where_it_stands() {
    let (mut least, mut most) = (usize::MAX, 0);
    for name in machine::library::names(machine::library::CONTROLLED) {
        let (_, text) = machine::library::find(name, machine::library::CONTROLLED).unwrap();
        let text = machine::starter::titled(text, "mine");
        assert_eq!(machine::load_text("mine.toml", &text).unwrap().title, "mine", "{name}");
        let offered = machine::starter::offered(&text, &holds);
        let lines: Vec<&str> = offered.lines().collect();
        let is_own = |line: &&str| text.lines().any(|own| own == *line);
        let is_key = |at: &usize| {
            let key = lines[*at].strip_prefix("# ").and_then(|line| line.split_once(" = "));
            let plain = |(key, _): (&str, &str)| !key.contains(' ');
            key.is_some_and(plain) && !is_own(&lines[*at])
        };
        let keys: Vec<usize> = (0..lines.len()).filter(is_key).collect();
        (least, most) = (least.min(keys.len()), most.max(keys.len()));
        let with = |keys: &[usize]| {
            let line = |(at, line): (usize, &&str)| match keys.contains(&at) {
                true => line["# ".len()..].to_owned(),
                false => (*line).to_owned(),
            };
            let text: Vec<String> = lines.iter().enumerate().map(line).collect();
            text.join("\n") + "\n"
        };
        let tried = |keys: &[usize]| {
            let text = with(keys);
            assert!(holds(&text), "{name}: {:?}\n{text}", lines[keys[0]]);
        };
        assert!(holds(&offered), "{name}\n{offered}");
        for (i, at) in keys.iter().enumerate() {
            // Mass and centre of what hangs on the flange are one: neither holds alone, and each names the other.
            match lines[*at] {
                line if line.starts_with("# load_mass") => tried(&keys[i..=i + 1]),
                line if line.starts_with("# load_center") => {
                    assert!(lines[*at].contains("with load_mass"));
                }
                _ => tried(&[*at]),
            }
        }
        for group in keys.chunk_by(|a, b| a + 1 == *b) {
            tried(group);
        }
        if !keys.is_empty() {
            tried(&keys);
        }
    }
    assert!(least >= 2 && most >= 8, "{least} {most}");
}
