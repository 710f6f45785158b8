//! README.md: each command is run in the order of the page, and each file that it names is there.

use crate::folder::Folder;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).unwrap()
}

/// The parts of the page between lines of three backticks, and what is outside of them.
fn blocks(text: &str) -> (Vec<&str>, String) {
    let parts: Vec<&str> = text.split("```").collect();
    let inside = parts.iter().copied().skip(1).step_by(2).collect();
    (inside, parts.iter().copied().step_by(2).collect())
}

/// What stands between single backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// The words of a command line without its comment; `None` where it is another command.
fn words(line: &str) -> Option<Vec<&str>> {
    let line = line.strip_prefix("$ ").unwrap_or(line).split(" #").next().unwrap();
    let mut words = line.split_whitespace();
    (words.next() == Some("toolpost")).then(|| words.collect())
}

/// The command lines of the code blocks.
fn commands(text: &str) -> Vec<Vec<&str>> {
    blocks(text).0.iter().flat_map(|block| block.lines().filter_map(words)).collect()
}

/// What stands below a command in its block: `...` for lines that are left out.
fn output<'a>(text: &'a str, command: &'a [&str]) -> impl Iterator<Item = &'a str> {
    let here =
        move |block: &&str| block.lines().any(|line| words(line).as_deref() == Some(command));
    let block = blocks(text).0.into_iter().find(here).unwrap_or("");
    let below =
        block.lines().skip_while(move |line| words(line).as_deref() != Some(command)).skip(1);
    below.take_while(|line| words(line).is_none())
}

/// A folder with the examples in it.
fn with_examples() -> Folder {
    let folder = Folder::empty();
    fs::create_dir(folder.path().join("examples")).unwrap();
    for entry in fs::read_dir(root().join("examples")).unwrap() {
        let entry = entry.unwrap();
        let to = folder.path().join("examples").join(entry.file_name());
        fs::copy(entry.path(), to).unwrap();
    }
    folder
}

#[test]
fn every_command_of_the_readme_does_what_it_says() {
    let text = readme();
    let commands = commands(&text);
    let named: BTreeSet<&str> = commands.iter().map(|words| words[0]).collect();
    assert_eq!(Vec::from_iter(named), ["machines", "pcb", "post", "prove", "wire"]);
    let folder = with_examples();
    for words in &commands {
        let proves = words[0] == "prove";
        if proves {
            // The mistyped Y of the page: in block N390.
            let program = folder.read(words[1]);
            assert!(text.contains("    | N390 G1 Y-42."));
            assert!(program.contains("N390 G1 Y-24."), "{program}");
            folder.write(words[1], program.replace("N390 G1 Y-24.", "N390 G1 Y-42."));
        }
        let said = folder.run(words);
        assert_eq!(said.code, i32::from(proves), "{words:?}: {said:?}");
        let printed: BTreeSet<&str> = said.out.lines().chain(said.err.lines()).collect();
        for line in output(&text, words).filter(|line| *line != "...") {
            assert!(printed.contains(line), "{line} is not what {words:?} prints: {said:?}");
        }
        if let Some(at) = words.iter().position(|word| *word == "-o") {
            assert!(folder.path().join(words[at + 1]).exists(), "{words:?}");
        }
    }
}

#[test]
fn every_command_that_a_sentence_of_the_readme_names_is_there() {
    let text = readme();
    let (_, sentences) = blocks(&text);
    let folder = Folder::empty();
    for quoted in quoted(&sentences) {
        // `toolpost machines list` · `show`: the command of a table, with words for what is given.
        let Some(words) = words(quoted) else { continue };
        let placeholder =
            |word: &&str| word.starts_with(['[', '-']) || word.to_uppercase() == *word;
        let given: Vec<&str> =
            words.iter().copied().take_while(|word| !placeholder(word)).collect();
        let said = folder.run(&[&given[..], &["--help"]].concat());
        assert_eq!(said.code, 0, "{quoted}: {said:?}");
        for option in words.iter().filter(|word| word.starts_with('-')) {
            assert!(said.out.contains(option), "{quoted}: {}", said.out);
        }
        if given.len() == words.len() && words.len() > 1 {
            let said = folder.run(&words);
            assert_eq!(said.code, 0, "{quoted}: {said:?}");
        }
    }
}

#[test]
fn every_file_and_goal_of_make_that_the_readme_names_is_there() {
    let text = readme();
    let (inside, sentences) = blocks(&text);
    let links = sentences.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
    let in_the_project = |name: &&str| {
        ["docs/", "examples/", "integrations/", "machines/", "controls/", "crates/", "scripts/"]
            .iter()
            .any(|folder| name.starts_with(folder))
    };
    let named = quoted(&sentences).filter(in_the_project);
    let used = inside.iter().flat_map(|block| block.split(['\n', ' ', '"'])).filter(in_the_project);
    let mut count = 0;
    for name in links.chain(named).chain(used).filter(|name| !name.contains("://")) {
        assert!(root().join(name).exists(), "README.md names {name}");
        count += 1;
    }
    assert!(count > 20, "{count}");

    let makefile = fs::read_to_string(root().join("Makefile")).unwrap();
    let lines = inside.iter().flat_map(|block| block.lines()).chain(quoted(&sentences));
    let goals: Vec<&str> = lines
        .filter_map(|line| line.strip_prefix("make "))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(["demo", "install", "test"].iter().all(|goal| goals.contains(goal)), "{goals:?}");
    for goal in goals {
        assert!(makefile.contains(&format!("\n{goal}:")), "README.md names make {goal}");
    }
}

#[test]
fn every_machine_of_the_library_is_in_the_table_of_its_page() {
    let page = fs::read_to_string(root().join("docs/machines.md")).unwrap();
    // The first table: up to the first line that is none of its rows.
    let rows: Vec<&str> = page
        .lines()
        .skip_while(|line| !line.starts_with("| machine |"))
        .take_while(|line| line.starts_with('|'))
        .collect();
    let columns = |row: &str| row.matches('|').count();
    let mut named = Vec::new();
    for row in &rows[2..] {
        assert_eq!(columns(row), columns(rows[0]), "{row}");
        // `generic-3axis-grbl`, `-marlin`: the second begins as the first does.
        let names: Vec<&str> = quoted(row.split('|').nth(1).unwrap()).collect();
        for name in &names {
            named.push(match name.strip_prefix('-') {
                Some(ending) => format!("generic-3axis-{ending}"),
                None => (*name).to_owned(),
            });
        }
    }
    named.retain(|name| name != "emco_post");
    named.sort();
    let mut library: Vec<&str> = machine::library::names(machine::library::MACHINES).collect();
    library.sort_unstable();
    assert_eq!(named, library);
}
