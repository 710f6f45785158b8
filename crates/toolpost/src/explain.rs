//! `toolpost explain`: every name that a machine or control file may use, with unit and help, and every rule of
//! findings; of a block also how the controls of the library write it, of a single rule also the way out and an
//! example.

use crate::answer::Answer;
use app::{Stop, summary};
use machine::Key;
use machine::library::{CONTROLS, StatedOption, names};
use program::{Diagnostic, Rule};
use serde_json::{Map, Value, json};

/// A name, as it is listed.
struct Row {
    name: String,
    text: String,
    data: Value,
}

impl Row {
    fn new(name: String, unit: &str, help: &str, data: Value) -> Row {
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        Row { name, text: format!("{help}{unit}"), data }
    }

    fn key(key: &Key) -> Row {
        let dot = if key.table.is_empty() { "" } else { "." };
        let name = format!("{}{dot}{}", key.table, key.name);
        let data = json!({ "kind": "key", "name": name, "unit": key.unit, "help": key.help });
        Row::new(name, key.unit, key.help, data)
    }

    fn option(option: &StatedOption) -> Row {
        let StatedOption { control, name, value, help } = option;
        let name = format!("options.{name}");
        let data = json!({ "kind": "option", "name": name, "control": control, "value": value, "help": help });
        Row { name, text: format!("{help} {control}: {value}"), data }
    }

    fn rule(rule: Rule) -> Row {
        let data = json!({
            "kind": "rule",
            "name": rule,
            "help": rule.meaning(),
            "way_out": rule.way_out(),
            "example": rule.example(),
            "former_names": rule.former_names(),
        });
        Row::new(rule.name().to_owned(), "", rule.meaning(), data)
    }
}

/// Explains one name, or all of them. The last part of a key is enough: `min` is that of every table. A table is
/// explained with its keys. Rules are also found by a former name.
pub fn run(topic: Option<&str>) -> Result<Answer, Stop> {
    let names = post::catalogue().iter();
    let names = names.map(|p| Row::new(p.name.to_owned(), p.unit, p.help, json!(p)));
    let options = machine::library::options();
    let rows = names.chain(machine::keys().map(Row::key)).chain(options.iter().map(Row::option));
    let mut found: Vec<Row> =
        rows.filter(|row| topic.is_none_or(|t| matches(&row.name, t))).collect();
    let block = topic.and_then(|topic| found.iter().find(|row| row.name == topic));
    let written = block.map_or(Ok(Vec::new()), |row| written(&row.name))?;
    let named = topic.map(Rule::named);
    found.extend(named.as_deref().unwrap_or(Rule::ALL).iter().map(|rule| Row::rule(*rule)));
    if let (true, Some(topic)) = (found.is_empty(), topic) {
        let message = format!("`{topic}` is no name of machine and control files, and no rule");
        return Err(Diagnostic::error(Rule::Topic, message)
            .help("`toolpost explain` lists them all")
            .into());
    }
    let lines: Vec<_> = found.iter().map(|row| (row.name.as_str(), row.text.clone())).collect();
    let data: Vec<_> = found.iter().map(|row| &row.data).collect();
    let mut text = summary::rows(&lines);
    let split = named.as_ref().is_some_and(|rules| rules.len() > 1);
    text.extend(named.iter().flatten().map(|rule| about(rule, split)));
    for (control, block) in &written {
        text.push_str(&format!("\n{control}\n"));
        text.extend(block.trim().lines().map(|line| format!("    {line}\n")));
    }
    let written: Map<String, Value> =
        written.into_iter().map(|(control, block)| (control.into(), block.into())).collect();
    Ok(Answer::product(text, json!({ "names": data, "written": written })))
}

/// What is said of a rule below its meaning; with its name where it is one of those that a rule was split into.
fn about(rule: &Rule, split: bool) -> String {
    let (way_out, example) = (rule.way_out().to_owned(), rule.example().to_owned());
    let mut lines = vec![("way out", way_out), ("example", example)];
    if split {
        lines.insert(0, ("rule", rule.name().to_owned()));
    }
    if !rule.former_names().is_empty() {
        lines.push(("former names", rule.former_names().join(", ")));
    }
    format!("\n{}", summary::rows(&lines))
}

/// What the controls of the library write for the block of that name: each that has it, with its text.
fn written(block: &str) -> Result<Vec<(&'static str, String)>, Stop> {
    let mut all = Vec::new();
    for control in names(CONTROLS) {
        let machine = machine::load_control(control)?;
        let text = machine.blocks.get(block).map(|block| block.text.clone());
        all.extend(text.filter(|text| !text.trim().is_empty()).map(|text| (control, text)));
    }
    Ok(all)
}

/// Whether `topic` is `name`, its last part, or the table that it stands in.
fn matches(name: &str, topic: &str) -> bool {
    let last = name.rsplit('.').next().unwrap_or(name);
    let table = name.split('.').next().unwrap_or(name);
    [name, last, table].iter().any(|name| name.eq_ignore_ascii_case(topic))
}
