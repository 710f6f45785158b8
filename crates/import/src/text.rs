//! Text of other systems, as it may be shown and as it may stand in a file of ours.

/// The most characters of foreign text that a finding shows.
const SHOWN: usize = 40;

/// The beginning of a text, without what steers a terminal.
pub(crate) fn short(text: &str) -> String {
    let shown = text.chars().take(SHOWN).map(|c| if c.is_control() { ' ' } else { c });
    let cut = if text.chars().nth(SHOWN).is_some() { "…" } else { "" };
    shown.chain(cut.chars()).collect()
}

/// Whether a template may hold it as it stands: printable ASCII that begins no statement.
pub(crate) fn literal(text: &str) -> bool {
    let printable = text.chars().all(|c| (' '..='~').contains(&c) || c == '\t');
    printable && !text.contains(['{', '}'])
}

/// A string of TOML, over several lines where it has some.
pub(crate) fn quoted(text: &str) -> String {
    let escape = |text: &str| text.replace('\\', "\\\\").replace('"', "\\\"").replace('\t', "\\t");
    match text.contains('\n') {
        true => format!("\"\"\"\n{}\n\"\"\"", escape(text.trim_end_matches('\n'))),
        false => format!("\"{}\"", escape(&text.replace('\r', ""))),
    }
}
