//! The catalogue of rules (`crates/program/src/rule`): each is in the documentation, some source makes a finding of it, and its
//! example, where it is a program, is refused for it.
//!
//! `TOOLPOST_DOCS=write cargo test -p toolpost --test all rules` writes `docs/rules.md` anew.

use control::{Action, Dialect, Settings};
use program::{Diagnostic, Rule};
use source::apt;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The page of the documentation.
fn page() -> String {
    let mut page = String::from(
        "# Rules of findings\n\n\
         Every finding of Toolpost names its rule in square brackets: `error[axis-limit]`. `toolpost explain axis-limit` prints what \
         stands here. A finding may name a closer way out than its rule. Former names stay in `--json` (`former_rules`) and \
         in `--accept` for one version.\n\n\
         Where an example begins with the name of a control, its blocks are run by the virtual control of that name, with three \
         axes, behind blocks that set units, plane, work offset, position, spindle and feed.\n\n\
         | rule | meaning | way out | example |\n|---|---|---|---|\n",
    );
    let cell = |text: &str| text.replace('|', "\\|");
    for rule in Rule::ALL {
        let former = rule.former_names().iter().map(|name| format!("`{name}`")).collect::<Vec<_>>();
        let former = match former.is_empty() {
            true => String::new(),
            false => format!(" (formerly {})", former.join(", ")),
        };
        writeln!(
            page,
            "| `{rule}`{former} | {} | {} | {} |",
            cell(rule.meaning()),
            cell(rule.way_out()),
            cell(rule.example())
        )
        .unwrap();
    }
    page
}

#[test]
fn the_documentation_lists_the_catalogue() {
    let path = root().join("docs/rules.md");
    if std::env::var("TOOLPOST_DOCS").is_ok_and(|how| how == "write") {
        return fs::write(path, page()).unwrap();
    }
    let stored = fs::read_to_string(path).unwrap();
    assert!(stored == page(), "TOOLPOST_DOCS=write cargo test -p toolpost --test all rules");
}

/// Looks at each Rust file below a folder, but for the catalogue.
fn each_source(folder: &Path, look: &mut impl FnMut(&Path, &str)) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            each_source(&path, look);
        } else if path.extension().is_some_and(|end| end == "rs") && !path.ends_with("catalogue.rs")
        {
            look(&path, &fs::read_to_string(&path).unwrap());
        }
    }
}

/// The texts of the Rust files below a folder, but for the catalogue.
fn sources(folder: &Path, all: &mut String) {
    each_source(folder, &mut |_, text| all.push_str(text));
}

#[test]
fn some_source_makes_a_finding_of_each_rule() {
    let mut all = String::new();
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        sources(&entry.unwrap().path().join("src"), &mut all);
    }
    sources(&root().join("python/src"), &mut all);
    let made = |rule: &Rule| {
        let name = format!("Rule::{rule:?}");
        all.split(&name).skip(1).any(|rest| !rest.starts_with(char::is_alphanumeric))
    };
    let unused: Vec<_> =
        Rule::ALL.iter().filter(|rule| !made(rule)).map(|rule| rule.name()).collect();
    assert!(unused.is_empty(), "no source makes a finding of {}", unused.join(", "));
}

/// What a command prints.
fn printed(words: &[&str]) -> String {
    let run = Command::new(env!("CARGO_BIN_EXE_toolpost")).args(words).output().unwrap();
    String::from_utf8(run.stdout).unwrap()
}

/// The commands below the one whose help this is.
fn commands(help: &str) -> Vec<String> {
    let commands = help.split("Commands:").nth(1).unwrap_or_default();
    let lines = commands.lines().skip(1).take_while(|line| !line.trim().is_empty());
    let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.map(|line| line.trim().split(' ').next().unwrap().to_owned()).collect()
}

/// The options of a command and of those below it, with their dashes.
fn options_of(command: &str) -> BTreeSet<String> {
    let help = printed(&[command, "-h"]);
    let more = commands(&help).into_iter().map(|below| printed(&[command, &below, "-h"]));
    let texts: Vec<String> = [help.clone()].into_iter().chain(more).collect();
    texts.iter().flat_map(|text| named_options(text)).map(str::to_owned).collect()
}

/// The options of all commands.
fn options() -> BTreeSet<String> {
    commands(&printed(&["-h"])).iter().flat_map(|command| options_of(command)).collect()
}

/// The options that a text names.
fn named_options(text: &str) -> impl Iterator<Item = &str> {
    let ends = |c: char| !(c.is_ascii_lowercase() || c == '-');
    let starts = text
        .match_indices("--")
        .filter(|(at, _)| !text[..*at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '-'));
    let named = starts.map(move |(at, _)| {
        let rest = &text[at..];
        &rest[..rest.find(ends).unwrap_or(rest.len())]
    });
    named.filter(|name| name[2..].starts_with(|c: char| c.is_ascii_lowercase()))
}

/// Whoever follows a way out types what it names.
#[test]
fn every_option_that_is_named_in_a_text_exists() {
    let known = options();
    for option in ["--units", "--folder", "--round-corners", "--thread", "--drill-tolerance"] {
        assert!(known.contains(option), "{option}: {known:?}");
    }
    let mut wrong = Vec::new();
    for rule in Rule::ALL {
        for text in [rule.meaning(), rule.way_out(), rule.example()] {
            let unknown = named_options(text).filter(|name| !known.contains(*name));
            wrong.extend(unknown.map(|name| format!("{rule}: {name}")));
        }
    }
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let mut all = String::new();
        let folder = entry.unwrap().path();
        sources(&folder.join("src"), &mut all);
        // What tests within the sources name is theirs, and comments and code have dashes of their own.
        let texts = all.lines().filter(|line| !line.trim_start().starts_with("//"));
        let texts = texts.filter(|line| line.contains('"'));
        for line in texts {
            let unknown = named_options(line).filter(|name| !known.contains(*name));
            wrong.extend(
                unknown.map(|name| format!("{}: {name} in {}", folder.display(), line.trim())),
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The commands that say what stands in a source file: an option in its texts has to be one of each of them. None where it depends on more.
fn said_by(file: &str) -> &'static [&'static str] {
    let in_any = |parts: &[&str]| parts.iter().any(|part| file.contains(part));
    match () {
        // `show` draws what the others prove, in the frame that it is told.
        () if in_any(&["crates/toolpost/", "crates/studio/", "crates/nc/src/pose.rs"]) => &[],
        () if in_any(&["glass"]) => &["glass"],
        () if in_any(&["crates/pcb/", "crates/levelling/", "/src/pcb"]) => &["pcb"],
        () if in_any(&["crates/wire/", "crates/sketch/", "/src/wire"]) => &["wire"],
        () if in_any(&["crates/post/"]) => &["post"],
        () => &["post", "prove"],
    }
}

/// A way out by an option that the command at hand does not take leads nowhere.
#[test]
fn an_option_in_a_text_is_one_of_the_command_that_says_it() {
    let commands = ["post", "prove", "wire", "pcb", "glass"];
    let known: BTreeMap<&str, BTreeSet<String>> =
        commands.into_iter().map(|command| (command, options_of(command))).collect();
    assert!(known["prove"].contains("--against") && !known["prove"].contains("--tabs"));
    let (mut wrong, mut named) = (Vec::new(), 0);
    let mut look = |path: &Path, text: &str| {
        let file = path.display().to_string();
        let texts = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for option in texts.filter(|line| line.contains('"')).flat_map(named_options) {
            named += 1;
            let lacks = said_by(&file).iter().filter(|command| !known[**command].contains(option));
            wrong.extend(lacks.map(|command| format!("{file}: {option} is none of {command}")));
        }
    };
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        each_source(&entry.unwrap().path().join("src"), &mut look);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(named > 80, "{named}");
}

/// The ways out of which a newcomer knew no option: these name it, as it is typed.
#[test]
fn ways_out_name_the_option_that_helps() {
    for (rule, option) in [
        ("units", "--units"),
        ("called-program", "--folder"),
        ("inner-corner", "--round-corners"),
        ("no-thread", "--thread"),
        ("no-drill", "--drill-tolerance"),
        ("drill-differs", "--drills"),
        ("compensation-open", "--tools"),
        ("fit-without-memory", "--memory"),
        ("sync-point", "--pair"),
        ("dxf-layer", "--layer"),
        ("gap", "--close"),
        ("wire-height", "--height"),
        ("block-skip", "--block-delete"),
        ("unknown-start", "--start"),
        ("decimal-point", "--whole-numbers"),
        ("no-cutter", "--hole-mill"),
        ("no-tool", "--vee"),
        ("narrow-gap", "--narrow"),
    ] {
        let [rule] = Rule::named(rule)[..] else { panic!("{rule}") };
        assert!(named_options(rule.way_out()).any(|named| named == option), "{rule}: {option}");
    }
}

/// The quoted parts of an example.
fn quoted(example: &str) -> Vec<&str> {
    example.split('`').skip(1).step_by(2).collect()
}

/// What stands before the blocks of an example: units, plane, work offset, position, spindle and feed.
fn preamble(dialect: Dialect) -> &'static str {
    match dialect {
        Dialect::Sinumerik => "G71 G90 G94 G17 G54\nT1 M6\nG0 X0 Y0 Z50\nM3 S1000 F100\n",
        Dialect::Klartext => "BEGIN PGM P MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+50 R0 FMAX M3\n",
        Dialect::FanucWire => "G21 G90 G17\nG92 X0 Y0\n",
        _ => "G21\nG90 G17 G94 G54\nT1 M6\nG0 X0. Y0. Z50.\nM3 S1000\nF100.\n",
    }
}

/// The rules of what a virtual control finds in these blocks.
fn found_by_control(dialect: Dialect, blocks: &[&str]) -> Vec<Rule> {
    let blocks = blocks.join("\n");
    let end = match dialect {
        Dialect::Sinumerik => "M30\n",
        Dialect::Klartext if !blocks.contains("END PGM") => "END PGM P MM\n",
        _ => "",
    };
    let text = format!("{}{blocks}\n{end}", preamble(dialect));
    let mut rules = Vec::new();
    let settings = Settings::new(dialect, [false; 3]);
    let read = control::read(&settings, "example", text.as_bytes(), &mut |event| {
        if let Action::Risk(risk) = event.action {
            rules.push(risk.rule);
        }
        Ok(())
    });
    rules.extend(read.err().map(|found| found.rule));
    rules
}

/// The rules of what the reader of cutter-location data finds in these records.
fn found_in_records(records: &[&str]) -> Vec<Rule> {
    let text =
        format!("UNITS/MM\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\n{}\nFINI\n", records.join("\n"));
    let found = match apt::read("example", text.as_bytes(), &apt::Options::default()) {
        Ok(reading) => reading.warnings,
        Err(found) => found,
    };
    found.iter().map(|found: &Diagnostic| found.rule).collect()
}

#[test]
fn an_example_of_blocks_or_records_is_refused_for_its_rule() {
    let (mut run, mut wrong) = (0, String::new());
    for rule in Rule::ALL {
        let Some((reader, text)) = rule.example().split_once(": `") else { continue };
        let parts = quoted(rule.example());
        // What stands outside of the quotes is no block.
        if parts.is_empty()
            || !format!("`{text}").split('`').step_by(2).all(|gap| ["", ", "].contains(&gap))
        {
            continue;
        }
        let found = match control::Dialect::named(reader) {
            Some(dialect) => found_by_control(dialect, &parts),
            None if reader == "apt" => found_in_records(&parts),
            None => continue,
        };
        run += 1;
        if !found.contains(rule) {
            writeln!(wrong, "{rule}: {}: {found:?}", rule.example()).unwrap();
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    assert!(run >= 80, "{run}");
}
