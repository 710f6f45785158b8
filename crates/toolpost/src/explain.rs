//! `toolpost explain`: every name that a control file may use, with unit and help.

use crate::answer::{Answer, Stop};
use crate::summary;
use program::Diagnostic;
use serde_json::json;

/// Explains one name, or all of them.
pub fn run(topic: Option<&str>) -> Result<Answer, Stop> {
    let matches = |name: &str| topic.is_none_or(|topic| name.eq_ignore_ascii_case(topic));
    let found: Vec<_> = post::catalogue().iter().filter(|p| matches(p.name)).collect();
    if let (true, Some(topic)) = (found.is_empty(), topic) {
        return Err(Diagnostic::error("topic", format!("`{topic}` is no name of the templates"))
            .help("`toolpost explain` lists them all")
            .into());
    }
    let lines: Vec<_> = found
        .iter()
        .map(|p| {
            let unit = if p.unit.is_empty() { String::new() } else { format!(" ({})", p.unit) };
            (p.name, format!("{}{unit}", p.help))
        })
        .collect();
    Ok(Answer::product(summary::rows(&lines), json!({ "names": found })))
}
