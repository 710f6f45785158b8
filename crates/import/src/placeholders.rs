//! Start, tool change, segment and end: what a header has in one block goes into the blocks that our files have for it.

use crate::foreign::{Line, Part, Piece};
use crate::items::{Item, Role, code, codes, items};
use crate::text::short;
use crate::write::Writing;
use machine::{LengthOffset, OptionKey};
use std::fmt::Write as _;

/// What is left of a line after its words have been sorted into blocks.
#[derive(Default)]
struct Rest {
    line: u32,
    text: String,
    /// Whether it calls a tool.
    tool: bool,
    change: bool,
    stop: bool,
    /// Whether it goes to a position in machine coordinates.
    reference: bool,
    end: bool,
}

impl Writing<'_> {
    /// Makes the blocks of start, tool change, segment and end.
    pub(crate) fn places(&mut self) {
        let (mut start, mut first) = (Vec::new(), Vec::new());
        let said: Vec<_> =
            self.base_block("program_start").map(codes).into_iter().flatten().collect();
        for rest in self.rests(Part::Start, &said) {
            if rest.tool || rest.change {
                first.push(rest);
            } else if rest.text.contains("tool.") {
                let message =
                    format!("the line is left out: no tool is called by `{}`", short(&rest.text));
                self.findings.lost(rest.line, message);
            } else {
                start.push(rest);
            }
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
                self.findings.lost(rest.line, message);
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

    /// What is left of the lines of a part where the start of the control already says the codes `said`;
    /// they are said again behind a line that counts otherwise.
    fn rests(&mut self, part: Part, mut said: &[(char, f64)]) -> Vec<Rest> {
        let post = self.post;
        let mut rests = Vec::new();
        for line in post.parts.get(&part).map(Vec::as_slice).unwrap_or_default() {
            let Some(rest) = self.rest(line, part, said) else { continue };
            if rest.reference || codes(&rest.text).any(|code| code == ('G', 91.0)) {
                said = &[];
            }
            rests.push(rest);
        }
        rests
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
        let mut rest = Rest { line: number, ..Rest::default() };
        let any =
            |items: &[Item], role: fn(&Role) -> bool| items.iter().any(|item| role(&item.role));
        rest.reference = any(&items, |role| *role == Role::Reference);
        if !rest.reference && any(&items, |role| matches!(role, Role::Coordinate { .. })) {
            let up = any(&items, |role| *role == Role::Coordinate { z: true });
            let message = match up {
                true => "the way to a home or safe height is the control's own way up",
                false => "no move to a home position: the toolpath determines where the tool goes",
            };
            self.findings.otherwise(number, message);
            items.retain(|item| {
                !matches!(item.role, Role::Coordinate { .. } | Role::Motion | Role::Feed)
            });
        }
        self.take_spindle(&mut items, number);
        if self.base.capabilities.length_offset == LengthOffset::Implicit {
            self.leave_out(
                &mut items,
                Role::Length,
                number,
                "the control has no tool length offset by a word",
            );
        }
        self.length |= any(&items, |role| *role == Role::Length);
        items.retain(|item| item.role != Role::Length);
        for (role, why) in [
            (Role::Coolant, "coolant is the toolpath's"),
            (Role::Tape, "a tape mark is no part of the program"),
            (Role::Feed, "the feed is the toolpath's"),
            (Role::Motion, "a motion without an end position"),
        ] {
            self.leave_out(&mut items, role, number, why);
        }
        if part != Part::ToolChange {
            self.leave_out(
                &mut items,
                Role::Stop,
                number,
                "a stop that the toolpath does not ask for",
            );
        }
        self.leave_path_mode(&mut items, number);
        let inch = |item: &&Item| matches!(code(&item.text), Some(('G', unit)) if unit == 20.0 || unit == 70.0);
        if items.iter().any(|item| inch(&item)) {
            self.findings.otherwise(number, "programs of ours are in millimetres (G21)");
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

    /// Leaves out `G61`, and `G64` with its bounds, where the start of the control says by how much it may leave the
    /// path: the number of the post is in its own unit, and a bare `G64` bounds nothing.
    fn leave_path_mode(&mut self, items: &mut Vec<Item>, number: u32) {
        let is_mode = |item: &Item| matches!(code(&item.text), Some(('G', mode)) if mode.trunc() == 61.0 || mode == 64.0);
        if self.base.option(OptionKey::PathTolerance).is_none() || !items.iter().any(is_mode) {
            return;
        }
        let bound = |item: &Item| matches!(code(&item.text), Some(('P' | 'Q', _)));
        let (left, kept): (Vec<Item>, Vec<Item>) =
            std::mem::take(items).into_iter().partition(|item| is_mode(item) || bound(item));
        let said: Vec<&str> = left.iter().map(|item| item.text.as_str()).collect();
        let message = format!(
            "`{}`: `path_tolerance` in [options] says how far the path may be left at corners",
            short(&said.join(" "))
        );
        self.findings.otherwise(number, message);
        *items = kept;
    }

    /// Takes what switches the spindle on out of a line; the first line that says both is how it is said.
    fn take_spindle(&mut self, items: &mut Vec<Item>, number: u32) {
        let spindle: Vec<&Item> = items.iter().filter(|item| item.role == Role::Spindle).collect();
        let text = spindle.iter().map(|item| item.text.as_str()).collect::<Vec<_>>().join(" ");
        let speed = spindle.iter().any(|item| item.text.contains("{{S}}"));
        let on = spindle.iter().any(|item| code(&item.text) == Some(('M', 3.0)));
        if speed && on && spindle.len() == 2 {
            self.spindle.get_or_insert(text);
        } else if !spindle.is_empty() {
            let message = format!(
                "`{}`: the toolpath says when the spindle turns, and how fast",
                short(&text)
            );
            self.findings.lost(number, message);
        }
        items.retain(|item| item.role != Role::Spindle);
    }

    fn leave_out(&mut self, items: &mut Vec<Item>, role: Role, number: u32, why: &str) {
        for item in items.iter().filter(|item| item.role == role) {
            self.findings.lost(number, format!("`{}`: {why}", short(&item.text)));
        }
        items.retain(|item| item.role != role);
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
}

fn lines(rests: &[Rest]) -> String {
    rests.iter().map(|rest| rest.text.as_str()).collect::<Vec<_>>().join("\n")
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
