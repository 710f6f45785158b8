//! The file of ours that a post becomes: its moves, its places, and the words and capabilities that belong
//! to them.

use crate::Findings;
use crate::foreign::{Form, Line, Part, Piece, Post};
use crate::items::codes;
use crate::text::{quoted, short};
use machine::library::{MACHINES, names};
use machine::{LengthOffset, Machine, Word, load};
use program::Rule;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The file for `post`, which extends `base`.
pub(crate) fn file(
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

/// A file that is being written.
pub(crate) struct Writing<'a> {
    pub post: &'a Post,
    pub base: &'a Machine,
    pub findings: &'a mut Findings,
    /// The blocks by their names.
    pub blocks: BTreeMap<&'static str, String>,
    /// Whether the post calls the tool length by `G43`.
    pub length: bool,
    /// How it switches the spindle on.
    pub spindle: Option<String>,
}

impl Writing<'_> {
    /// A block of the control.
    pub(crate) fn base_block(&self, name: &str) -> Option<&str> {
        self.base.blocks.get(name).map(|block| block.text.as_str())
    }

    /// Whether the post places block numbers.
    pub(crate) fn numbered(&self) -> bool {
        self.post.parts.values().flatten().flat_map(Line::words).any(|word| word == "N")
    }

    fn toml(mut self, base: &str, origin: &str) -> String {
        let (post, plain) =
            (self.post, |text: &str| text.chars().all(|c| (' '..='~').contains(&c)));
        let mut out = format!("# Imported from {}.\nextends = {}\n", short(origin), quoted(base));
        let title = if post.title.trim().is_empty() { origin } else { post.title.trim() };
        let _ = writeln!(out, "title = {}", quoted(&short(title)));
        if let (None, Some(height)) = (self.base.safe_height, self.generic_height()) {
            let _ = writeln!(
                out,
                "# The post does not say where Z is at its top: look at the machine, homed, and write it here.\n\
                 safe_height = {height}"
            );
            let message = format!(
                "no post says where Z is at its top in machine coordinates: `safe_height = {height}` \
                 is written, as of any mill with this control; write that of the machine"
            );
            self.findings.assumed(Rule::SafeHeight, message);
        }
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
        let edges = self.base.capabilities.length_offset == LengthOffset::One;
        if self.length || edges {
            let words = if edges { " {{H}}" } else { " {{length}} {{H}}" };
            for name in ["rapid", "linear"] {
                if let Some(text) = self.blocks.get_mut(name) {
                    text.push_str(words);
                }
            }
            if !self.length {
                let message = "no post says which edge of a tool counts behind its change: D1 stands in the next move; where the machine \
                               makes it active itself, `edge_at_change = 1` below [settings] leaves it out";
                self.findings.assumed(Rule::LengthOffset, message.into());
            }
        } else {
            out.push_str("length_offset = \"implicit\"\n");
            if self.base.capabilities.length_offset != LengthOffset::Implicit {
                let message = "no block takes the length of the tool: programs with one tool that is touched off are proven, others \
                               need `{{length}} {{H}}` in the blocks `rapid` and `linear` and `length_offset = \"tool-number\"`";
                self.findings.assumed(Rule::LengthOffset, message.into());
            }
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
        self.rapids(&mut out);
        out
    }

    /// How fast the axes are, where the rapids of the control go at an F.
    fn rapids(&mut self, out: &mut String) {
        let states = |machine: &Machine| machine.linear.iter().any(|axis| axis.rapid.is_some());
        if states(self.base) {
            return;
        }
        let Some(generic) = self.generic().into_iter().find(states) else { return };
        out.push_str("\n# The post does not say how fast its rapids are: write the speeds of the machine here.\n[axes]\n");
        for (name, axis) in ["X", "Y", "Z"].into_iter().zip(&generic.linear) {
            if let Some(rapid) = axis.rapid {
                let _ = writeln!(out, "{name} = {{ rapid = {rapid} }}");
            }
        }
        let message = "no post says how fast rapids are that go at an F: the `rapid` of any mill with this control is \
                       written; write that of the machine";
        self.findings.assumed(Rule::RapidFeed, message.into());
    }

    /// The safe height of any mill of the library with the same control.
    fn generic_height(&self) -> Option<f64> {
        self.generic().iter().find_map(|machine| machine.safe_height)
    }

    /// Any mills of the library with the same control.
    fn generic(&self) -> Vec<Machine> {
        let own = [&self.base.name, &self.base.control];
        let generic = names(MACHINES).filter(|name| name.starts_with("generic-"));
        let generic = generic.filter_map(|name| load(name).ok());
        generic.filter(|machine| own.contains(&&machine.control)).collect()
    }

    fn words(&self, out: &mut String) {
        out.push_str("\n[words]\n");
        let [first, step, most] = self.post.numbers;
        let mut fields =
            vec![format!("step = {}", if self.numbered() { step.unwrap_or(10) } else { 0 })];
        fields.extend(first.map(|first| format!("first = {first}")));
        fields.extend(most.filter(|most| *most > 0).map(|most| format!("max = {most}")));
        let _ = writeln!(out, "N = {{ {} }}", fields.join(", "));
        // Moves that have G0 or G1 in their own words do not set the active one for the others.
        out.push_str("motion = { modal = false }\n");
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
            let own = self.base.words.contains_key(*word);
            match (decimals, self.base.words.get("X")) {
                (Some(decimals), _) => fields.push(format!("decimals = {decimals}, trim = false")),
                (None, Some(x)) if !own => {
                    let Word { decimals, trim, point, .. } = x;
                    fields.push(format!("decimals = {decimals}, trim = {trim}, point = {point}"));
                }
                (None, _) => {}
            }
            fields
                .extend(modal.map(|modal| format!("modal = {}", modal && !(fed && *word == "F"))));
            // A dwell by another address is in seconds, whatever that of the control counts.
            let control = self.base.words.get(*word).map(|word| word.address.as_str());
            if *scale != 1.0 || (*word == "P" && control != Some(address.trim())) {
                fields.push(format!("scale = {scale}"));
            }
            let _ = writeln!(out, "{word} = {{ {} }}", fields.join(", "));
        }
    }
}
