//! Moves: each part is one block of ours, whole, or the control's own stands in its place.

use crate::foreign::{Line, Part, Piece};
use crate::items::codes;
use crate::text::{literal, short};
use crate::write::Writing;
use machine::CycleName;
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
pub(crate) const CIRCLE: &[&str] = &["I", "CX", "R", "MX", "SWEEP"];

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

impl Writing<'_> {
    /// Makes the blocks of moves.
    pub(crate) fn moves(&mut self) {
        for (part, name, needs) in MOVES {
            let Some(lines) = self.post.parts.get(part) else { continue };
            let number = lines.first().map_or(0, |line| line.number);
            if *part == Part::Rapid && lines.iter().flat_map(Line::words).any(|word| word == "F") {
                self.findings.lost(number, "a rapid has no feed");
            }
            match self.block(lines, *part, needs) {
                Ok(text) => drop(self.blocks.insert(name, text)),
                Err((line, why)) => {
                    let line = if line == 0 { number } else { line };
                    let instead = match part {
                        Part::ArcCw | Part::ArcCcw => "is left out, arcs are written as lines",
                        Part::HelixCw | Part::HelixCcw => {
                            "is left out, helices are lines where `arc_cw` has no Z"
                        }
                        Part::Hole => "is left out, holes are drilled by moves",
                        _ => "is that of the control",
                    };
                    self.findings.lost(line, format!("`{name}` {instead}: {why}"));
                }
            }
        }
        if let Some(text) = self.blocks.get("cycle_drill").cloned() {
            let number = self.post.parts.get(&Part::Hole).and_then(|lines| lines.first());
            let number = number.map_or(0, |line| line.number);
            let why = if !codes(&text).any(|code| code == ('G', 81.0)) {
                Some("only G81 is a block")
            } else if !self.base.capabilities.cycles.contains(&CycleName::Drill) {
                Some("the control has no such cycle")
            } else {
                None
            };
            if let Some(why) = why {
                self.blocks.remove("cycle_drill");
                let message =
                    format!("holes are drilled by moves, which `rapid` and `linear` write: {why}");
                self.findings.lost(number, message);
            } else {
                self.blocks.insert("cycle_hole", text);
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
                Piece::Word("F") if part == Part::Rapid => {}
                Piece::Word(word) => {
                    let has = match *word {
                        "N" | "X" | "Y" | "Z" => true,
                        "F" => part != Part::Dwell,
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
                    return Err(String::from("it goes to a position that only the job knows"));
                }
                Piece::Unknown(text, why) => return Err(format!("`{text}` {why}")),
            }
        }
        Ok(row)
    }
}
