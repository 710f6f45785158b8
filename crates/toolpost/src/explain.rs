//! `toolpost explain`: every name that a machine or control file may use, with unit and help.

use crate::answer::Answer;
use app::{Stop, summary};
use machine::Key;
use program::Diagnostic;
use serde_json::{Value, json};

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
}

/// Explains one name, or all of them. The last part of a key is enough: `min` is that of every table.
pub fn run(topic: Option<&str>) -> Result<Answer, Stop> {
    let names = post::catalogue().iter();
    let names = names.map(|p| Row::new(p.name.to_owned(), p.unit, p.help, json!(p)));
    let rows = names.chain(machine::keys().map(Row::key));
    let found: Vec<Row> = rows.filter(|row| topic.is_none_or(|t| matches(&row.name, t))).collect();
    if let (true, Some(topic)) = (found.is_empty(), topic) {
        let message = format!("`{topic}` is no name of machine and control files");
        return Err(Diagnostic::error("topic", message)
            .help("`toolpost explain` lists them all")
            .into());
    }
    let lines: Vec<_> = found.iter().map(|row| (row.name.as_str(), row.text.clone())).collect();
    let data: Vec<_> = found.iter().map(|row| &row.data).collect();
    Ok(Answer::product(summary::rows(&lines), json!({ "names": data })))
}

/// Whether `topic` is `name` or its last part.
fn matches(name: &str, topic: &str) -> bool {
    let last = name.rsplit('.').next().unwrap_or(name);
    [name, last].iter().any(|name| name.eq_ignore_ascii_case(topic))
}
