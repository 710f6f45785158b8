//! The catalogue of rules (`crates/program/src/rule`): each is in the documentation, some source makes a finding of it, and its
//! example, where it is a program, is refused for it.
//!
//! `TOOLPOST_DOCS=write cargo test -p toolpost --test rules` writes `docs/rules.md` anew.

use control::{Action, Dialect, Settings};
use program::{Diagnostic, Rule};
use source::apt;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

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
    let told = fs::read_to_string(path).unwrap();
    assert!(told == page(), "TOOLPOST_DOCS=write cargo test -p toolpost --test rules");
}

/// The texts of the Rust files below a folder, but for the catalogue.
fn sources(folder: &Path, all: &mut String) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, all);
        } else if path.extension().is_some_and(|end| end == "rs") && !path.ends_with("catalogue.rs")
        {
            all.push_str(&fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn some_source_makes_a_finding_of_each_rule() {
    let mut all = String::new();
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        sources(&entry.unwrap().path().join("src"), &mut all);
    }
    sources(&root().join("python/src"), &mut all);
    let made = |rule: &Rule| {
        let names = std::iter::once(rule.name()).chain(rule.former_names().iter().copied());
        all.split(&format!("Rule::{rule:?}"))
            .skip(1)
            .any(|rest| !rest.starts_with(char::is_alphanumeric))
            || names.map(|name| format!("\"{name}\"")).any(|name| all.contains(&name))
    };
    let unused: Vec<_> =
        Rule::ALL.iter().filter(|rule| !made(rule)).map(|rule| rule.name()).collect();
    assert!(unused.is_empty(), "no source makes a finding of {}", unused.join(", "));
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
