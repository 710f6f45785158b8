//! The file of ours that a post becomes. What a header or a tool change says at one place goes where our
//! files say it: modes to the start, the tool to its change, the speed to the spindle; ways to places that
//! only the other system knows become the control's own way up.

use super::Findings;
use super::foreign::{Form, Line, Part, Piece, Post};
use super::items::{Item, Role, code, items};
use super::text::{literal, quoted, short};
use crate::model::Machine;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The parts that are one block of ours each, with the words that it must place: of each group one.
const MOVES: &[(Part, &str, &[&[&str]])] = &[
    (Part::Rapid, "rapid", &[&["X"], &["Y"], &["Z"]]),
    (Part::Linear, "linear", &[&["X"], &["Y"], &["Z"], &["F"]]),
    (Part::ArcCw, "arc_cw", &[&["X"], &["Y"], CIRCLE, &["F"]]),
    (Part::ArcCcw, "arc_ccw", &[&["X"], &["Y"], CIRCLE, &["F"]]),
    (Part::HelixCw, "helix_cw", &[&["X"], &["Y"], &["Z"], CIRCLE, &["F"]]),
    (Part::HelixCcw, "helix_ccw", &[&["X"], &["Y"], &["Z"], CIRCLE, &["F"]]),
    (Part::Hole, "cycle_drill", &[&["X"], &["Y"], &["BOTTOM"], &["CLEAR"], &["F"]]),
    (Part::Dwell, "dwell", &[&["P"]]),
];

/// What says the circle of an arc.
const CIRCLE: &[&str] = &["I", "CX", "R", "MX", "SWEEP"];

/// The words that only arcs have.
const OF_ARCS: &[&str] = &[
    "I",
    "J",
    "CX",
    "CY",
    "R",
    "RADIUS",
    "MX",
    "MY",
    "MZ",
    "SX",
    "SY",
    "SZ",
    "START_ANGLE",
    "END_ANGLE",
    "SWEEP",
];

/// The file for `post`, which extends `base`.
pub(super) fn file(
    post: &Post,
    base: &Machine,
    base_name: &str,
    origin: &str,
    findings: &mut Findings,
) -> String {
    let mut writing =
        Writing { post, base, findings, blocks: BTreeMap::new(), length: false, spindle: None };
    writing.moves();
    writing.places();
    writing.toml(base_name, origin)
}

struct Writing<'a> {
    post: &'a Post,
    base: &'a Machine,
    findings: &'a mut Findings,
    /// The blocks by their names.
    blocks: BTreeMap<&'static str, String>,
    /// Whether the post calls the tool length by `G43`.
    length: bool,
    /// How it switches the spindle on.
    spindle: Option<String>,
}

/// What is left of a line where its words have gone to their places.
#[derive(Default)]
struct Rest {
    text: String,
    /// Whether it calls a tool.
    tool: bool,
    change: bool,
    stop: bool,
    /// Whether it goes to a place in machine coordinates.
    reference: bool,
    end: bool,
}

impl Writing<'_> {
    fn moves(&mut self) {
        for (part, name, needs) in MOVES {
            let Some(lines) = self.post.parts.get(part) else { continue };
            let number = lines.first().map_or(0, |line| line.number);
            match self.block(lines, *part, needs) {
                Ok(text) => drop(self.blocks.insert(name, text)),
                Err((line, why)) => {
                    let line = if line == 0 { number } else { line };
                    self.findings.lost(line, format!("`{name}` is that of the control: {why}"));
                }
            }
        }
        if let Some(text) = self.blocks.get("cycle_drill").cloned() {
            let number = self.post.parts.get(&Part::Hole).and_then(|lines| lines.first());
            let number = number.map_or(0, |line| line.number);
            match codes(&text).any(|code| code == ('G', 81.0)) {
                true => drop(self.blocks.insert("cycle_hole", text)),
                false => {
                    self.blocks.remove("cycle_drill");
                    let message = "holes are drilled by moves, which `rapid` and `linear` write: only G81 is a block";
                    self.findings.lost(number, message);
                }
            }
        }
        // Arcs are written in both directions or not at all.
        for [cw, ccw] in [["arc_cw", "arc_ccw"], ["helix_cw", "helix_ccw"]] {
            if self.blocks.contains_key(cw) != self.blocks.contains_key(ccw) {
                let lone = if self.blocks.remove(cw).is_some() { cw } else { ccw };
                self.blocks.remove(lone);
                let message = format!(
                    "`{lone}` stands alone: without the other direction neither is written"
                );
                self.findings.lost(0, message);
            }
        }
    }

    /// The block of a part that is a move.
    fn block(
        &self,
        lines: &[Line],
        part: Part,
        needs: &[&[&str]],
    ) -> Result<String, (u32, String)> {
        let mut text = String::new();
        for line in lines {
            let row = self.row(line, part).map_err(|why| (line.number, why))?;
            let _ = writeln!(text, "{}", row.trim());
        }
        let placed: Vec<&str> = lines.iter().flat_map(Line::words).collect();
        let lacks = needs.iter().find(|group| !group.iter().any(|word| placed.contains(word)));
        match lacks {
            Some([only]) => Err((0, format!("it does not say {only}"))),
            Some(_) => Err((0, String::from("it does not say its circle"))),
            None => Ok(text.trim_end().to_owned()),
        }
    }

    fn row(&self, line: &Line, part: Part) -> Result<String, String> {
        let mut row = String::new();
        let arc = matches!(part, Part::ArcCw | Part::ArcCcw | Part::HelixCw | Part::HelixCcw);
        for piece in &line.pieces {
            match piece {
                Piece::Text(text) if literal(text) => row.push_str(text),
                Piece::Text(text) => {
                    return Err(format!(
                        "`{}` holds signs that a block of ours cannot",
                        short(text)
                    ));
                }
                Piece::Word(word) => {
                    let has = match *word {
                        "N" | "X" | "Y" | "Z" => true,
                        "F" => part != Part::Rapid && part != Part::Dwell,
                        "P" => part == Part::Dwell,
                        "BOTTOM" | "CLEAR" => part == Part::Hole,
                        word => arc && OF_ARCS.contains(&word),
                    };
                    if !has {
                        return Err(format!("{word} has no value there"));
                    }
                    // The address of a dwell stands in the line where the post has none for it.
                    if *word == "P" && !self.post.words.contains_key("P") && row.ends_with('P') {
                        row.pop();
                    }
                    let gap = self.post.words.get(word).is_some_and(|w| w.address.starts_with(' '));
                    let _ = write!(row, "{}{{{{{word}}}}}", if gap { " " } else { "" });
                }
                Piece::Value(name) => return Err(format!("{name} has no value there")),
                Piece::Home { .. } => {
                    return Err(String::from("it goes to a place that only the job knows"));
                }
                Piece::Unknown(text, why) => return Err(format!("`{text}` {why}")),
            }
        }
        Ok(row)
    }

    /// Start, tool change, segment and end.
    fn places(&mut self) {
        let (mut start, mut first) = (Vec::new(), Vec::new());
        let said: Vec<_> = self.base_block("program_start").map(codes_of).unwrap_or_default();
        for rest in self.rests(Part::Start, &said) {
            let to = if rest.tool || rest.change { &mut first } else { &mut start };
            to.push(rest);
        }
        if !start.is_empty() {
            let base = self.base_block("program_start").unwrap_or_default();
            let text = format!("{}\n{}", base.trim_end(), lines(&start));
            self.blocks.insert("program_start", text);
        }
        self.tool_change(first);
        let segment = self.rests(Part::Segment, &[]);
        if !segment.is_empty() {
            self.blocks.insert("operation_start", lines(&segment));
        }
        self.end();
        if let Some(on) = self.spindle.take() {
            let number = if self.numbered() { "{{N}} " } else { "" };
            let ccw = on.replace("M03", "M04").replace("M3", "M4");
            self.blocks.insert("spindle_cw", format!("{number}{on}"));
            self.blocks.insert("spindle_ccw", format!("{number}{ccw}"));
        }
    }

    fn tool_change(&mut self, first: Vec<Rest>) {
        let place = |part: Part| {
            let line = self.post.parts.get(&part).and_then(|lines| lines.first());
            line.map_or(0, |line| line.number)
        };
        let (start, changes) = (place(Part::Start), place(Part::ToolChange));
        let mut others = self.rests(Part::ToolChange, &[]);
        if others.is_empty() {
            if !first.is_empty() {
                let message = "the post changes no tool: `tool_change` is that of the control";
                self.findings.lost(start, message);
            }
            return;
        }
        let by_hand = self.base_block("tool_change").is_some_and(|text| !text.contains("M6"));
        let all = || first.iter().chain(&others);
        let why = if by_hand && all().any(|rest| rest.change) {
            Some("the control has no M6")
        } else if !others.iter().any(|rest| rest.tool) {
            Some("it does not say which tool")
        } else {
            None
        };
        if let Some(why) = why {
            let message = format!("`tool_change` is that of the control: {why}");
            return self.findings.lost(changes, message);
        }
        // Where a tool is changed by M6 the machine waits by itself; by hand the first tool is there.
        if !by_hand {
            for rest in others.iter().filter(|rest| rest.stop) {
                let message = format!("`{}`: a stop that the toolpath does not ask for", rest.text);
                self.findings.lost(changes, message);
            }
            others.retain(|rest| !rest.stop);
        }
        let called = |rests: &[Rest]| rests.iter().any(|rest| rest.tool);
        let text = match called(&first) {
            true => {
                let (first, others) = (lines(&first), lines(&others));
                match first == others {
                    true => first,
                    false => format!(
                        "{{% if tool.first %}}{first}{{% endif %}}\n{{% if not tool.first %}}{others}{{% endif %}}"
                    ),
                }
            }
            false => {
                let row = |rest: &Rest| match rest.stop {
                    true => format!("{{% if not tool.first %}}{}{{% endif %}}", rest.text),
                    false => rest.text.clone(),
                };
                others.iter().map(row).collect::<Vec<_>>().join("\n")
            }
        };
        let up = self.unless(&others);
        self.blocks.insert("tool_change", format!("{up}{text}"));
    }

    fn end(&mut self) {
        let rests = self.rests(Part::End, &[]);
        if rests.is_empty() {
            return;
        }
        let number =
            self.post.parts.get(&Part::End).and_then(|l| l.first()).map_or(0, |l| l.number);
        let mut text = self.unless(&rests);
        text.push_str(&lines(&rests));
        let ends = |line: &&str| codes(line).any(|code| code == ('M', 2.0) || code == ('M', 30.0));
        let own = self.base_block("program_end").and_then(|text| text.lines().rfind(ends));
        if let (false, Some(own)) = (rests.iter().any(|rest| rest.end), own) {
            let _ = write!(text, "\n{own}");
            let message = "the post does not end the program: the control's own end is added";
            self.findings.otherwise(number, message);
        }
        self.blocks.insert("program_end", text);
    }

    /// What is left of the lines of a part where the start of the control already says the codes `said`.
    fn rests(&mut self, part: Part, said: &[(char, f64)]) -> Vec<Rest> {
        let post = self.post;
        let lines = post.parts.get(&part).map(Vec::as_slice).unwrap_or_default();
        lines.iter().filter_map(|line| self.rest(line, part, said)).collect()
    }

    fn rest(&mut self, line: &Line, part: Part, said: &[(char, f64)]) -> Option<Rest> {
        let mut items = items(line, part, self.post);
        let number = line.number;
        if let Some((text, why)) = items.iter().find_map(|item| match item.role {
            Role::Unknown(why) => Some((short(&item.text), why)),
            _ => None,
        }) {
            let what = if text.is_empty() { shown(line) } else { text };
            self.findings.lost(number, format!("the line is left out: `{what}` {why}"));
            return None;
        }
        let mut rest = Rest::default();
        let any =
            |items: &[Item], role: fn(&Role) -> bool| items.iter().any(|item| role(&item.role));
        rest.reference = any(&items, |role| *role == Role::Reference);
        if !rest.reference && any(&items, |role| matches!(role, Role::Place { .. })) {
            let up = any(&items, |role| *role == Role::Place { z: true });
            let message = match up {
                true => "the way to a home or safe height is the control's own way up",
                false => "no way to a home place: the toolpath says where the tool goes",
            };
            self.findings.otherwise(number, message);
            items.retain(|item| {
                !matches!(item.role, Role::Place { .. } | Role::Motion | Role::Feed)
            });
        }
        self.take_spindle(&mut items);
        self.length |= any(&items, |role| *role == Role::Length);
        items.retain(|item| item.role != Role::Length);
        for (role, why) in [
            (Role::Coolant, "coolant is the toolpath's"),
            (Role::Tape, "a tape mark is no part of the program"),
            (Role::Feed, "the feed is the toolpath's"),
            (Role::Motion, "a motion without a place"),
        ] {
            self.drop(&mut items, role, number, why);
        }
        if part != Part::ToolChange {
            self.drop(&mut items, Role::Stop, number, "a stop that the toolpath does not ask for");
        }
        items.retain(|item| item.role != Role::Unit);
        items.retain(|item| code(&item.text).is_none_or(|code| !said.contains(&code)));
        let says = |item: &Item| !matches!(item.role, Role::Blank | Role::Number);
        if !items.iter().any(says) {
            return None;
        }
        rest.tool = any(&items, |role| *role == Role::Tool);
        rest.change = any(&items, |role| *role == Role::Change);
        rest.stop = any(&items, |role| *role == Role::Stop);
        rest.end = any(&items, |role| *role == Role::End);
        let text: String = items.iter().map(|item| item.text.as_str()).collect();
        rest.text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        // A comment keeps its blanks.
        if any(&items, |role| *role == Role::Comment) {
            rest.text = text.trim().to_owned();
        }
        Some(rest)
    }

    /// Takes what switches the spindle on out of a line; the first line that says both is how it is said.
    fn take_spindle(&mut self, items: &mut Vec<Item>) {
        let spindle: Vec<&Item> = items.iter().filter(|item| item.role == Role::Spindle).collect();
        let text = spindle.iter().map(|item| item.text.as_str()).collect::<Vec<_>>().join(" ");
        let speed = spindle.iter().any(|item| item.text.contains("{{S}}"));
        let on = spindle.iter().any(|item| code(&item.text) == Some(('M', 3.0)));
        if speed && on && spindle.len() == 2 && self.spindle.is_none() {
            self.spindle = Some(text);
        }
        items.retain(|item| item.role != Role::Spindle);
    }

    fn drop(&mut self, items: &mut Vec<Item>, role: Role, number: u32, why: &str) {
        for item in items.iter().filter(|item| item.role == role) {
            self.findings.lost(number, format!("`{}`: {why}", short(&item.text)));
        }
        items.retain(|item| item.role != role);
    }

    fn base_block(&self, name: &str) -> Option<&str> {
        self.base.blocks.get(name).map(|block| block.text.as_str())
    }

    /// How the control leaves the part, as lines of their own.
    fn way_up(&self) -> String {
        let up = self.base_block("retract").unwrap_or_default().trim_end();
        if up.is_empty() { String::new() } else { format!("{up}\n") }
    }

    /// The same where none of `rests` goes to a place in machine coordinates by itself.
    fn unless(&self, rests: &[Rest]) -> String {
        let own = rests.iter().any(|rest| rest.reference);
        if own { String::new() } else { self.way_up() }
    }

    /// Whether the post places block numbers.
    fn numbered(&self) -> bool {
        self.post.parts.values().flatten().flat_map(Line::words).any(|word| word == "N")
    }

    fn toml(mut self, base: &str, origin: &str) -> String {
        let (post, plain) =
            (self.post, |text: &str| text.chars().all(|c| (' '..='~').contains(&c)));
        let mut out = format!("# Imported from {}.\nextends = {}\n", short(origin), quoted(base));
        let title = if post.title.trim().is_empty() { origin } else { post.title.trim() };
        let _ = writeln!(out, "title = {}", quoted(&short(title)));
        if let Some(ending) = post.extension.as_ref().filter(|e| plain(e) && !e.is_empty()) {
            let _ = writeln!(out, "extension = {}", quoted(&short(ending)));
        }
        out.push_str("\n[capabilities]\n");
        let linear = self.blocks.contains_key("linear");
        if linear {
            out.push_str("compensation = false\nfeed_per_turn = false\ninverse_time = false\n");
        }
        let arcs = self.blocks.contains_key("arc_cw");
        let _ = writeln!(out, "arcs = [{}]", if arcs { "\"XY\"" } else { "" });
        let rises = |name: &str| self.blocks.get(name).is_some_and(|text| text.contains("{{Z}}"));
        let helix =
            ["arc_cw", "arc_ccw"].into_iter().all(rises) || self.blocks.contains_key("helix_cw");
        let _ = writeln!(out, "helix = {helix}");
        let cycles = if self.blocks.contains_key("cycle_drill") { "\"drill\"" } else { "" };
        let _ = writeln!(out, "cycles = [{cycles}]");
        if self.length {
            for name in ["rapid", "linear"] {
                if let Some(text) = self.blocks.get_mut(name) {
                    text.push_str(" {{length}} {{H}}");
                }
            }
        } else {
            out.push_str("length_offset = \"implicit\"\n");
        }
        if let Some(end) = &post.line_end {
            let end = if end == "\n" { "\\n" } else { "\\r\\n" };
            let _ = writeln!(out, "\n[format]\nline_end = \"{end}\"");
        }
        self.words(&mut out);
        out.push_str("\n[blocks]\n");
        for (name, text) in &self.blocks {
            let _ = writeln!(out, "{name} = {}", quoted(text));
        }
        out
    }

    fn words(&self, out: &mut String) {
        out.push_str("\n[words]\n");
        let [first, step, most] = self.post.numbers;
        let mut fields =
            vec![format!("step = {}", if self.numbered() { step.unwrap_or(10) } else { 0 })];
        fields.extend(first.map(|first| format!("first = {first}")));
        fields.extend(most.filter(|most| *most > 0).map(|most| format!("max = {most}")));
        let _ = writeln!(out, "N = {{ {} }}", fields.join(", "));
        // A feed within a rapid changes the one that is active.
        let fed = |lines: &Vec<Line>| {
            lines.iter().flat_map(|line| &line.pieces).any(|piece| match piece {
                Piece::Text(text) => codes(text).any(|(letter, _)| letter == 'F'),
                _ => false,
            })
        };
        let fed = self.post.parts.get(&Part::Rapid).is_some_and(fed);
        for (word, form) in self.post.words.iter().filter(|(word, _)| **word != "N") {
            let Form { address, decimals, modal, scale } = form;
            let mut fields = vec![format!("address = {}", quoted(address.trim()))];
            // A step of a ten-thousandth of an inch is between one and three thousandths of a millimetre.
            let decimals = decimals.map(|d| if self.post.inches { d.min(3) } else { d });
            fields.extend(decimals.map(|decimals| format!("decimals = {decimals}, trim = false")));
            fields
                .extend(modal.map(|modal| format!("modal = {}", modal && !(fed && *word == "F"))));
            if *scale != 1.0 {
                fields.push(format!("scale = {scale}"));
            }
            let _ = writeln!(out, "{word} = {{ {} }}", fields.join(", "));
        }
    }
}

fn lines(rests: &[Rest]) -> String {
    rests.iter().map(|rest| rest.text.as_str()).collect::<Vec<_>>().join("\n")
}

/// The codes of a text: letters with a number.
fn codes(text: &str) -> impl Iterator<Item = (char, f64)> + use<> {
    let mut words: Vec<String> = Vec::new();
    for c in text.chars() {
        match words.last_mut() {
            Some(word) if c.is_ascii_digit() || matches!(c, '.' | '-' | '+') => word.push(c),
            _ => words.push(c.to_string()),
        }
    }
    words.into_iter().filter_map(|word| code(&word))
}

fn codes_of(text: &str) -> Vec<(char, f64)> {
    codes(text).collect()
}

/// A line as it stands in the post, for a finding.
fn shown(line: &Line) -> String {
    let piece = |piece: &Piece| match piece {
        Piece::Text(text) => text.clone(),
        Piece::Word(word) => format!("[{word}]"),
        Piece::Value(name) => format!("[{name}]"),
        Piece::Home { .. } => "[home]".to_owned(),
        Piece::Unknown(text, _) => text.clone(),
    };
    short(&line.pieces.iter().map(piece).collect::<String>())
}
