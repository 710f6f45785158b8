//! Every finding has a way out: its own, or that of its rule in `crates/program/src/ways_out.rs`.

use program::Diagnostic;
use std::fs;
use std::path::{Path, PathBuf};

/// The sources of a crate, without comments and tests.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]\nmod ").next().unwrap();
            let lines = text.lines().map(|line| match line.trim_start().starts_with("//") {
                true => "\n".into(),
                false => format!("{line}\n"),
            });
            all.push((path, lines.collect()));
        }
    }
    all
}

/// The byte behind the string that begins at byte `at`.
fn behind_string(text: &[u8], mut at: usize) -> usize {
    at += 1;
    while text[at] != b'"' {
        at += if text[at] == b'\\' { 2 } else { 1 };
    }
    at + 1
}

/// The arguments of a call whose `(` is at byte `open`, and the byte behind it.
fn arguments(text: &str, open: usize) -> (Vec<&str>, usize) {
    let bytes = text.as_bytes();
    let (mut depth, mut at, mut from, mut all) = (0, open, open + 1, Vec::new());
    loop {
        match bytes[at] {
            b'"' => {
                at = behind_string(bytes, at);
                continue;
            }
            b'\'' if bytes[at + 1] == b'\\' => at += 3,
            b'\'' if bytes.get(at + 2) == Some(&b'\'') => at += 2,
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth -= 1,
            b',' if depth == 1 => {
                all.push(text[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
        if depth == 0 {
            all.push(text[from..at].trim());
            return (all, at + 1);
        }
        at += 1;
    }
}

/// The rule that an argument names.
fn rule(argument: &str) -> Option<&str> {
    let name = argument.strip_prefix('"')?.strip_suffix('"')?;
    let kebab = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    (!name.is_empty() && name.chars().all(kebab)).then_some(name)
}

/// Whether `.help(` follows at byte `at`, behind any other calls of methods.
fn has_help(text: &str, mut at: usize) -> bool {
    loop {
        let rest = text[at..].trim_start();
        let Some(name) = rest.strip_prefix('.') else { return false };
        let length = name.bytes().take_while(|b| b.is_ascii_alphanumeric() || *b == b'_').count();
        if name.starts_with("help(") {
            return true;
        }
        if name.as_bytes().get(length) != Some(&b'(') {
            return false;
        }
        at = arguments(text, text.len() - name.len() + length).1;
    }
}

/// A function or closure that takes a rule.
struct Maker<'t> {
    name: &'t str,
    file: &'t Path,
    parameters: usize,
    /// Whether it takes a way out with the rule, or gives one.
    helps: bool,
}

fn makers(texts: &[(PathBuf, String)]) -> Vec<Maker<'_>> {
    let mut makers = Vec::new();
    for (file, text) in texts {
        for (at, _) in text.match_indices("fn ") {
            let Some(open) = text[at..].find('(').map(|open| at + open) else { continue };
            let (parameters, end) = arguments(text, open);
            let names: Vec<&str> = parameters.iter().filter_map(|p| p.split(':').next()).collect();
            let Some(body) = text[end..].find('{').filter(|_| names.contains(&"rule")) else {
                continue;
            };
            let body = arguments(text, end + body);
            let helps = ["help", "way_out"].iter().any(|name| names.contains(name))
                || body.0.iter().any(|part| part.contains(".help("));
            let own = names.iter().filter(|name| !name.ends_with("self") && !name.is_empty());
            let name = text[at + 3..open].split('<').next().unwrap();
            makers.push(Maker { name, file, parameters: own.count(), helps });
        }
        for (at, _) in text.match_indices("= |rule") {
            let name = text[..at].trim_end().rsplit(' ').next().unwrap();
            let inside = text[at + 3..].split('|').next().unwrap();
            let helps = inside.contains("help") || inside.contains("way_out");
            makers.push(Maker { name, file, parameters: inside.split(',').count(), helps });
        }
    }
    makers
}

/// Whether a call makes a finding, and leaves its way out to the rule.
fn leaves_it_to_the_rule(makers: &[Maker], name: &str, file: &Path, arguments: usize) -> bool {
    if ["Diagnostic::error", "Diagnostic::warning"].contains(&name) {
        return true;
    }
    let same = |maker: &&Maker| maker.name == name && maker.parameters == arguments;
    let near = makers.iter().filter(same).filter(|maker| maker.file == file);
    let mut near = near.peekable();
    match near.peek() {
        Some(_) => near.any(|maker| !maker.helps),
        None => makers.iter().filter(same).any(|maker| !maker.helps),
    }
}

/// The findings of a crate that have no way out.
fn without_way_out(texts: &[(PathBuf, String)]) -> Vec<String> {
    let makers = makers(texts);
    let mut names: Vec<&str> = makers.iter().map(|maker| maker.name).collect();
    names.extend(["Diagnostic::error", "Diagnostic::warning"]);
    names.sort_unstable();
    names.dedup();
    let mut found = Vec::new();
    for (path, text) in texts {
        for name in &names {
            for (at, _) in text.match_indices(&format!("{name}(")) {
                let before = &text[..at];
                let joined = before.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
                let (arguments, end) = arguments(text, at + name.len());
                let rule = arguments.iter().find_map(|argument| rule(argument));
                let Some(rule) = rule.filter(|_| !joined && !before.ends_with("fn ")) else {
                    continue;
                };
                let count = arguments.iter().filter(|argument| !argument.is_empty()).count();
                let of_rule = Diagnostic::error(String::from(rule).leak(), "").help;
                if of_rule.is_empty()
                    && leaves_it_to_the_rule(&makers, name, path, count)
                    && !has_help(text, end)
                {
                    found.push(format!("{}:{}: {rule}", path.display(), before.lines().count()));
                }
            }
        }
    }
    found
}

#[test]
fn every_finding_that_the_sources_make_has_a_way_out() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut folders: Vec<_> =
        fs::read_dir(root.join("crates")).unwrap().map(|e| e.unwrap().path().join("src")).collect();
    folders.push(root.join("python/src"));
    let found: Vec<_> =
        folders.iter().flat_map(|folder| without_way_out(&sources(folder))).collect();
    assert!(
        found.is_empty(),
        "no way out: give it `.help(...)`, or its rule a row in crates/program/src/ways_out.rs\n{}",
        found.join("\n")
    );
}

#[test]
fn the_way_out_of_a_rule_goes_where_nothing_says_that_rule_any_more() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let all: String = fs::read_dir(root.join("crates"))
        .unwrap()
        .map(|entry| entry.unwrap().path().join("src"))
        .chain([root.join("python/src")])
        .flat_map(|folder| sources(&folder))
        .filter(|(path, _)| !path.ends_with("ways_out.rs"))
        .map(|(_, text)| text)
        .collect();
    let rows = fs::read_to_string(root.join("crates/program/src/ways_out.rs")).unwrap();
    let rows = rows.split("&[\n").nth(1).unwrap().split("];").next().unwrap();
    let names = rows.split("    (").filter_map(|row| row.trim_start().split('"').nth(1));
    let unused: Vec<_> = names.filter(|name| !all.contains(&format!("\"{name}\""))).collect();
    assert!(unused.is_empty(), "no source makes a finding of {}", unused.join(", "));
}

#[test]
fn a_finding_without_a_way_out_is_found() {
    let text = r#"
        fn refused(rule: &'static str, message: String) -> Diagnostic { Diagnostic::error(rule, message) }
        fn fault(rule: &'static str, help: &str) {}
        fn turned(rule: &'static str, message: String) { refused(rule, message).help("turn") }
        fn all() {
            refused("no-such-rule", format!("a, b) {}", 1)).line(3);
            refused("another-rule", String::new()).line(3).help("turn");
            fault("third-rule", "turn");
            turned("third-rule", String::new());
            Diagnostic::warning("fourth-rule", "x")
        }"#;
    let mut found = without_way_out(&[("a.rs".into(), text.into())]);
    found.sort();
    assert_eq!(found, ["a.rs:10: fourth-rule", "a.rs:6: no-such-rule"]);
}
