//! Posts of VCarve and Aspire (`.pp`): `VAR` lines, `begin` blocks with a line of the program in quotes
//! each. What is believed of the format, with its sources, is in `docs/controls/importing.md`.

use crate::foreign::{Form, Line, Part, Piece, Post};
use crate::items::codes;
use crate::{Findings, text};
use std::collections::BTreeMap;

/// What the variables of a post are in ours.
const VARIABLES: &[(&str, Piece)] = &[
    ("LINE_NUMBER", Piece::Word("N")),
    ("SPINDLE_SPEED", Piece::Word("S")),
    ("FEED_RATE", Piece::Word("F")),
    ("CUT_RATE", Piece::Word("F")),
    ("PLUNGE_RATE", Piece::Word("F")),
    ("TOOL_NUMBER", Piece::Word("T")),
    ("DWELL_TIME", Piece::Word("P")),
    ("X_POSITION", Piece::Word("X")),
    ("Y_POSITION", Piece::Word("Y")),
    ("Z_POSITION", Piece::Word("Z")),
    ("ARC_CENTRE_I_INC_POSITION", Piece::Word("I")),
    ("ARC_CENTRE_J_INC_POSITION", Piece::Word("J")),
    ("ARC_CENTRE_I_ABS_POSITION", Piece::Word("CX")),
    ("ARC_CENTRE_J_ABS_POSITION", Piece::Word("CY")),
    ("ARC_RADIUS", Piece::Word("R")),
    ("ARC_START_X_POSITION", Piece::Word("SX")),
    ("ARC_START_Y_POSITION", Piece::Word("SY")),
    ("ARC_MID_X_POSITION", Piece::Word("MX")),
    ("ARC_MID_Y_POSITION", Piece::Word("MY")),
    ("X_HOME_POSITION", Piece::Home { z: false }),
    ("Y_HOME_POSITION", Piece::Home { z: false }),
    ("Z_HOME_POSITION", Piece::Home { z: true }),
    ("SAFE_Z_HEIGHT", Piece::Home { z: true }),
];

/// What text variables, and variables that no `VAR` names, are in ours.
const NAMED: &[(&str, Piece)] = &[
    ("T", Piece::Word("T")),
    ("DWELL", Piece::Word("P")),
    ("SAFEZ", Piece::Home { z: true }),
    ("XH", Piece::Home { z: false }),
    ("YH", Piece::Home { z: false }),
    ("ZH", Piece::Home { z: true }),
    ("TOOLNAME", Piece::Value("tool.name")),
    ("TOOLPATH_NAME", Piece::Value("operation.name")),
    ("TP_FILENAME", Piece::Value("program.name")),
];

/// The blocks of a post: the part that each is of ours, the first of two of a part winning; the others
/// differ from it by the feed at most, or are reported.
const BLOCKS: &[(&str, Part)] = &[
    ("HEADER", Part::Start),
    ("TOOLCHANGE", Part::ToolChange),
    ("NEW_SEGMENT", Part::Segment),
    ("FIRST_RAPID_MOVE", Part::Rapid),
    ("RAPID_MOVE", Part::Rapid),
    ("FIRST_FEED_MOVE", Part::Linear),
    ("FEED_MOVE", Part::Linear),
    ("PLUNGE_MOVE", Part::Linear),
    ("RETRACT_MOVE", Part::Rapid),
    ("FIRST_CW_ARC_MOVE", Part::ArcCw),
    ("CW_ARC_MOVE", Part::ArcCw),
    ("FIRST_CCW_ARC_MOVE", Part::ArcCcw),
    ("CCW_ARC_MOVE", Part::ArcCcw),
    ("FIRST_CW_HELICAL_ARC_MOVE", Part::HelixCw),
    ("CW_HELICAL_ARC_MOVE", Part::HelixCw),
    ("FIRST_CW_HELICAL_ARC_PLUNGE_MOVE", Part::HelixCw),
    ("CW_HELICAL_ARC_PLUNGE_MOVE", Part::HelixCw),
    ("FIRST_CCW_HELICAL_ARC_MOVE", Part::HelixCcw),
    ("CCW_HELICAL_ARC_MOVE", Part::HelixCcw),
    ("FIRST_CCW_HELICAL_ARC_PLUNGE_MOVE", Part::HelixCcw),
    ("CCW_HELICAL_ARC_PLUNGE_MOVE", Part::HelixCcw),
    ("DWELL_MOVE", Part::Dwell),
    ("FOOTER", Part::End),
];

/// A block as it stands.
struct Block<'a> {
    name: String,
    begins: u32,
    lines: Vec<(u32, &'a str)>,
}

/// Reads a post.
pub(crate) fn read(source: &str, findings: &mut Findings) -> Post {
    let mut post = Post::default();
    let mut names: BTreeMap<String, Piece> = BTreeMap::new();
    let mut blocks: Vec<Block> = Vec::new();
    for (number, line) in (1..).zip(source.lines()) {
        let line = line.trim();
        let (head, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if line.is_empty() || line.starts_with(['+', '|']) {
            continue;
        } else if let Some(quoted) = line.strip_prefix('"') {
            match (quoted.rfind('"'), blocks.last_mut()) {
                (Some(end), Some(block)) => block.lines.push((number, &quoted[..end])),
                (None, _) => findings.error(number, "the quotes are not closed"),
                (_, None) => findings.error(number, "a line of the program before any `begin`"),
            }
        } else if head.eq_ignore_ascii_case("begin") {
            let (name, begins) = (rest.trim().to_ascii_uppercase(), number);
            blocks.push(Block { name, begins, lines: Vec::new() });
        } else if head.eq_ignore_ascii_case("var") {
            variable(rest, number, &mut post, &mut names, findings);
        } else if let Some((key, value)) = line.split_once('=') {
            setting(key.trim(), value.trim(), number, &mut post, findings);
        } else {
            findings.lost(number, format!("`{}` is no line of a post", text::short(line)));
        }
    }
    parts(&blocks, &names, &mut post, findings);
    post
}

/// `NAME = [short|A or C|address|width.decimals|factor]`.
fn variable(
    rest: &str,
    number: u32,
    post: &mut Post,
    names: &mut BTreeMap<String, Piece>,
    findings: &mut Findings,
) {
    let Some((name, value)) = rest.split_once('=') else {
        return findings.error(number, "a variable is `VAR NAME = [name|A|address|1.4]`");
    };
    let name = name.trim().to_ascii_uppercase();
    let value = value.trim();
    let Some(fields) = value.strip_prefix('[').and_then(|v| v.strip_suffix(']')) else {
        return findings
            .error(number, "what a variable is written as stands in one pair of brackets");
    };
    let fields: Vec<&str> = fields.split('|').collect();
    let [short, when, address, format, factor @ ..] = &fields[..] else {
        return findings.error(number, "a variable has a name, A or C, an address and a format");
    };
    let Some((_, piece)) = VARIABLES.iter().find(|(known, _)| *known == name) else {
        names.insert(short.to_ascii_uppercase(), unknown(short));
        return findings.lost(number, format!("no word of ours is `{}`", text::short(&name)));
    };
    names.insert(short.to_ascii_uppercase(), piece.clone());
    let Piece::Word(word) = piece else { return };
    let modal = match when.trim() {
        "C" | "c" => true,
        "A" | "a" => false,
        _ => return findings.error(number, "a variable is written always (A) or changed (C)"),
    };
    if !text::literal(address) {
        let message = format!(
            "the address `{}` has characters that no program has: write it in letters of ASCII",
            text::short(address)
        );
        return findings.error(number, message);
    }
    let decimals = format.trim().split_once('.').and_then(|(_, decimals)| decimals.parse().ok());
    let Some(decimals) = decimals.filter(|decimals| *decimals <= 9) else {
        let message = format!("`{}` is no format such as 1.4", text::short(format));
        return findings.error(number, message);
    };
    let factor = match factor {
        [] => Some(1.0),
        [factor] => factor.trim().parse().ok().filter(|factor: &f64| factor.is_finite()),
        _ => None,
    };
    match factor {
        Some(factor) if factor == 1.0 || (factor > 0.0 && matches!(*word, "F" | "S")) => {
            let (decimals, modal) = (Some(decimals), Some(modal));
            let address = address.to_string();
            let form = Form { address, decimals, modal, scale: factor };
            // Of the feeds of a post that is written which the toolpath says, in one form.
            if *post.words.entry(*word).or_insert_with(|| form.clone()) != form {
                let message = format!("`{name}` is written like the {word} before it");
                findings.otherwise(number, message);
            }
        }
        Some(factor) => {
            let message = format!(
                "{word} is multiplied by {factor}: a control of ours counts coordinates in mm, and the way \
                 its axes point"
            );
            findings.error(number, message);
        }
        None => findings
            .error(number, "the fifth field of a variable is the number that it is multiplied by"),
    }
}

/// `KEY = value`.
fn setting(key: &str, value: &str, number: u32, post: &mut Post, findings: &mut Findings) {
    let plain = value.trim_matches('"');
    let count = || plain.parse::<u32>().ok();
    let place = match key.to_ascii_uppercase().as_str() {
        "POST_NAME" => return post.title = plain.to_owned(),
        "FILE_EXTENSION" => return post.extension = Some(plain.to_owned()),
        "UNITS" => {
            post.inches = plain.to_ascii_uppercase().starts_with("INCH");
            if post.inches {
                let message = "the programs of the post are in inches: those of ours are in millimetres (G21)";
                findings.otherwise(number, message);
            }
            return;
        }
        "LINE_ENDING" => {
            let ends = plain.replace("[13]", "\r").replace("[10]", "\n");
            match ends.as_str() {
                "\r\n" | "\n" => post.line_end = Some(ends),
                _ => findings.lost(number, "a line ends with [10] or [13][10]".to_owned()),
            }
            return;
        }
        "LINE_NUMBER_START" => &mut post.numbers[0],
        "LINE_NUMBER_INCREMENT" => &mut post.numbers[1],
        "LINE_NUMBER_MAXIMUM" => &mut post.numbers[2],
        _ => {
            let message = format!("no key of ours is `{}`", text::short(key));
            return findings.lost(number, message);
        }
    };
    match count() {
        Some(count) => *place = Some(count),
        None => findings.error(number, "a whole number is needed"),
    }
}

/// The blocks as parts of ours.
fn parts(
    blocks: &[Block],
    names: &BTreeMap<String, Piece>,
    post: &mut Post,
    findings: &mut Findings,
) {
    let mut lines: BTreeMap<&str, Vec<Line>> = BTreeMap::new();
    for block in blocks {
        let known = BLOCKS.iter().any(|(name, _)| *name == block.name);
        let pieces = |(number, text): &(u32, &str)| {
            let rows = pieces(text, names);
            rows.into_iter().map(|pieces| Line { number: *number, pieces }).collect::<Vec<_>>()
        };
        let read: Vec<Line> = block.lines.iter().flat_map(pieces).collect();
        if !known && !read.is_empty() {
            let message =
                format!("nothing of ours is written where `{}` is", text::short(&block.name));
            findings.lost(block.begins, message);
        } else if known && lines.insert(&block.name, read).is_some() {
            findings.error(block.begins, format!("`{}` begins a second time", block.name));
        }
    }
    for (name, part) in BLOCKS {
        let Some(read) = lines.remove(name).filter(|lines| !lines.is_empty()) else { continue };
        let Some(taken) = post.parts.get(part) else {
            post.parts.insert(*part, read);
            continue;
        };
        if same_move(taken, &read) {
            continue;
        }
        let number = read.first().map_or(0, |line| line.number);
        findings.lost(number, format!("`{name}` is written like the first move of its kind"));
    }
}

/// Whether `other` says no more than `first` but the feed: the first of several moves says the kind of
/// motion, and the others may leave it out.
fn same_move(first: &[Line], other: &[Line]) -> bool {
    let words = |lines: &[Line]| {
        let mut words: Vec<&str> =
            lines.iter().flat_map(Line::words).filter(|w| *w != "F").collect();
        words.sort_unstable();
        words
    };
    let codes = |lines: &[Line]| -> Vec<(char, f64)> {
        let pieces = lines.iter().flat_map(|line| &line.pieces);
        let texts = pieces.filter_map(|piece| match piece {
            Piece::Text(text) => Some(codes(text)),
            _ => None,
        });
        texts.flatten().collect()
    };
    let said = codes(first);
    words(first) == words(other) && codes(other).iter().all(|code| said.contains(code))
}

/// A line of the program: text, variables in brackets, and characters by their number, of which 10 begins
/// a new line.
fn pieces(line: &str, names: &BTreeMap<String, Piece>) -> Vec<Vec<Piece>> {
    let (mut rows, mut row) = (Vec::new(), Vec::new());
    let mut rest = line;
    while let Some((before, behind)) = rest.split_once('[') {
        if !before.is_empty() {
            row.push(Piece::Text(before.to_owned()));
        }
        let (name, after) = behind.split_once(']').unwrap_or((behind, ""));
        rest = after;
        match name.trim() {
            "13" => {}
            "10" => rows.push(std::mem::take(&mut row)),
            name => {
                let upper = name.to_ascii_uppercase();
                let named =
                    || NAMED.iter().find(|(known, _)| *known == upper).map(|(_, p)| p.clone());
                let piece = names.get(&upper).cloned().or_else(named);
                row.push(piece.unwrap_or_else(|| unknown(name)));
            }
        }
    }
    if !rest.is_empty() {
        row.push(Piece::Text(rest.to_owned()));
    }
    rows.push(row);
    rows
}

fn unknown(name: &str) -> Piece {
    Piece::Unknown(
        format!("[{}]", text::short(name)),
        "is not known where a program of ours is written",
    )
}
