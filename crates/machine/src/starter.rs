//! A machine file to begin with: a copy of another one, under a title of its own, with the keys that a shop states besides offered as
//! comments. Each of them holds as soon as the `#` before it is taken away.

use crate::upgrade::{is_header, table, turns_text};

/// Keys of one table that are offered.
struct Offer {
    /// The table; empty for the top of the file.
    table: &'static str,
    /// What stands behind its header, where the file does not have it yet.
    about: &'static str,
    /// Keys with an example and what it means. Those that hold only together are one entry.
    entries: &'static [&'static str],
}

/// What stands above what is offered.
const ABOUT: &str = "# What else a shop states of its machine, with units, here and in the tables below: take away the `#` before a key. `toolpost explain NAME`
# says more of each, docs/machines.md what is taken where one is missing.
";

const OFFERS: [Offer; 6] = [
    Offer {
        table: "",
        about: "",
        entries: &[
            "safe_height = 0         # mm: Z in machine coordinates where the tool is clear of the part",
            "work_zero = [0, 0, 0]   # mm: the zero of the part in machine coordinates",
            "feed_max = 5000         # mm/min",
            "auxiliary = [88, 89]    # M functions of the builder that move no axis",
        ],
    },
    Offer {
        table: "cell",
        about: "",
        entries: &[
            "reentry_feed = 400           # mm/min: a cut that no turn of the tool carries may be left and entered again",
            "cable_joint_4 = [-180, 180]  # degrees: what cables and hoses leave to a joint",
            "cable_joint_6 = [-180, 180]",
            "load_mass = 4                # kg, with load_center: what hangs on the flange, with a tool in the spindle
load_center = [0, 0, 60]     # mm, with load_mass: its centre of gravity, from the flange",
        ],
    },
    Offer {
        table: "axes",
        about: "min, max in mm; rapid in mm/min; acceleration in m/s²",
        entries: &[
            "X = { min = -500, max = 0, rapid = 20000, acceleration = 2 }",
            "Y = { min = -400, max = 0, rapid = 20000, acceleration = 2 }",
            "Z = { min = -450, max = 0, rapid = 20000, acceleration = 2 }",
        ],
    },
    Offer { table: "spindle", about: "1/min", entries: &["min = 50", "max = 12000"] },
    Offer {
        table: "settings",
        about: "of the control",
        entries: &[
            "rapid_path = \"independent\"  # G0: each axis goes at its own speed; \"linear\" where they go straight",
            "high_feed = 5000             # mm/min: rapids near the part that are written as G1",
        ],
    },
    Offer {
        table: "blocks",
        about: "each in place of the control's",
        entries: &["coolant_flood = \"{{N}} M8\""],
    },
];

/// The file `text` with the title `title`.
pub fn titled(text: &str, title: &str) -> String {
    let mut lines: Vec<String> = text.lines().map(|line| format!("{line}\n")).collect();
    let line = format!("title = {}\n", toml::Value::from(title));
    let top = lines.iter().position(|line| is_header(line)).unwrap_or(lines.len());
    let is_title = |line: &String| key(line) == "title";
    match lines[..top].iter().position(is_title) {
        Some(at) => lines[at] = line,
        None => lines.insert(table(&lines, "").unwrap_or(0), line),
    }
    lines.concat()
}

/// The file `text` with what it does not state offered as comments, as far as it holds: `holds` says whether a file does.
pub fn offered(text: &str, holds: &dyn Fn(&str) -> bool) -> String {
    let mut lines: Vec<String> = text.lines().map(|line| format!("{line}\n")).collect();
    let mut is_first = true;
    for Offer { table, about, entries } in OFFERS {
        let Some((at, header)) = place(&lines, table) else { continue };
        let about = if about.is_empty() { String::new() } else { format!("   # {about}") };
        let header = if header { format!("\n[{table}]{about}\n") } else { String::new() };
        let with = |entry: &str| {
            let (before, behind) = lines.split_at(at);
            [&before.concat(), &header, entry, "\n", &behind.concat()].concat()
        };
        let good = entries.iter().filter(|entry| holds(&with(entry)));
        let comments: String =
            good.flat_map(|entry| entry.lines()).map(|line| format!("# {line}\n")).collect();
        if comments.is_empty() {
            continue;
        }
        let about =
            if std::mem::take(&mut is_first) { format!("\n{ABOUT}#\n") } else { String::new() };
        lines.insert(at, format!("{header}{about}{comments}"));
        lines = lines.concat().lines().map(|line| format!("{line}\n")).collect();
    }
    lines.concat()
}

/// The key that a line states.
fn key(line: &str) -> &str {
    line.split_once('=').map_or("", |(key, _)| key.trim())
}

/// Where keys of a table go, and whether its header has to be written before them; nothing where the file has it in another form, or
/// where it is one that no file is given besides.
fn place(lines: &[String], name: &str) -> Option<(usize, bool)> {
    if name.is_empty() {
        return Some((table(lines, name)?, false));
    }
    let stated = lines.concat().parse::<toml::Table>().ok()?;
    match (table(lines, &format!("[{name}]")), stated.contains_key(name)) {
        (Some(first), _) => Some((end(lines, first), false)),
        (None, true) => None,
        // A cell has keys that must be there.
        (None, false) if name == "cell" => None,
        (None, false) => Some((lines.len(), true)),
    }
}

/// Behind the last key of the table whose first line is `first`.
fn end(lines: &[String], first: usize) -> usize {
    let mut in_text = false;
    let mut last = first;
    for (at, line) in lines.iter().enumerate().skip(first) {
        if !in_text && is_header(line) {
            break;
        }
        let says = in_text || !(line.trim().is_empty() || line.trim_start().starts_with('#'));
        in_text ^= turns_text(line);
        if says {
            last = at + 1;
        }
    }
    last
}
