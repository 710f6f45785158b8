//! Templates with `@parameter@`: a head in brackets before the lines of each field. What is accepted is in
//! `docs/controls/importing.md`.

use crate::foreign::{Form, Line, Part, Piece, Post};
use crate::moves::CIRCLE;
use crate::{Findings, text};

/// The fields of the drilling and the engraving template, by their words, and the part that each is of
/// ours.
const FIELDS: &[(&str, Field)] = &[
    ("file extension", Field::Extension),
    ("output file extension", Field::Extension),
    ("extension", Field::Extension),
    ("coordinate shift", Field::Job("a board is shifted by the job, not by the machine")),
    ("shift", Field::Job("a board is shifted by the job, not by the machine")),
    ("tool radius", Field::Job("the tool is chosen by the job, not by the machine")),
    ("program start", Field::Part(Part::Start)),
    ("start", Field::Part(Part::Start)),
    ("program end", Field::Part(Part::End)),
    ("end", Field::Part(Part::End)),
    ("rapid move", Field::Part(Part::Rapid)),
    ("linear move", Field::Part(Part::Linear)),
    ("line", Field::Part(Part::Linear)),
    ("arc clockwise", Field::Part(Part::ArcCw)),
    ("arc cw", Field::Part(Part::ArcCw)),
    ("arc counter clockwise", Field::Part(Part::ArcCcw)),
    ("arc ccw", Field::Part(Part::ArcCcw)),
    ("hole", Field::Part(Part::Hole)),
    ("drilling one hole", Field::Part(Part::Hole)),
    ("drill change", Field::Part(Part::ToolChange)),
    ("tool change", Field::Part(Part::ToolChange)),
    ("approach", Field::Job(WAYS)),
    ("approach into the material", Field::Job(WAYS)),
    ("leave", Field::Job(WAYS)),
    ("leave the material", Field::Job(WAYS)),
];

/// Why the ways into and out of the material have no block of their own.
const WAYS: &str =
    "the way into and out of the material is the toolpath's: it is written by `rapid` and `linear`";

#[derive(Clone, Copy)]
enum Field {
    Part(Part),
    Extension,
    /// What the machine does not decide.
    Job(&'static str),
}

/// The names of parameters, without blanks and signs, and what each is of ours.
const PARAMETERS: &[(&[&str], Piece)] = &[
    (&["n", "block", "blocknumber", "line", "linenumber"], Piece::Word("N")),
    (&["x", "xe", "x2", "endx", "xend"], Piece::Word("X")),
    (&["y", "ye", "y2", "endy", "yend"], Piece::Word("Y")),
    (&["z", "ze", "z2", "endz", "zend"], Piece::Word("Z")),
    (&["i", "centreincx", "centerincx", "xci", "centrefromstartx"], Piece::Word("I")),
    (&["j", "centreincy", "centerincy", "yci", "centrefromstarty"], Piece::Word("J")),
    (&["xc", "cx", "centrex", "centerx", "xcentre", "xcenter"], Piece::Word("CX")),
    (&["yc", "cy", "centrey", "centery", "ycentre", "ycenter"], Piece::Word("CY")),
    (&["r", "radius"], Piece::Word("RADIUS")),
    (&["cr", "signedradius", "radiussigned"], Piece::Word("R")),
    (&["xm", "mx", "midx", "xmid", "middlex"], Piece::Word("MX")),
    (&["ym", "my", "midy", "ymid", "middley"], Piece::Word("MY")),
    (&["zm", "mz", "midz", "zmid", "middlez"], Piece::Word("MZ")),
    (&["xs", "x1", "startx", "xstart"], Piece::Word("SX")),
    (&["ys", "y1", "starty", "ystart"], Piece::Word("SY")),
    (&["zs", "z1", "startz", "zstart"], Piece::Word("SZ")),
    (&["startangle", "anglestart", "angle1", "a1"], Piece::Word("START_ANGLE")),
    (&["endangle", "angleend", "angle2", "a2"], Piece::Word("END_ANGLE")),
    (&["sweep", "sweepangle"], Piece::Word("SWEEP")),
    (&["f", "feed", "feedrate"], Piece::Word("F")),
    (&["s", "speed", "spindle", "spindlespeed"], Piece::Word("S")),
    (&["t", "tool", "toolnumber"], Piece::Word("T")),
    (&["depth", "bottom", "holedepth"], Piece::Word("BOTTOM")),
    (&["clear", "clearance", "rplane"], Piece::Word("CLEAR")),
    (&["dwell"], Piece::Word("P")),
    (&["diameter", "drill", "drilldiameter", "tooldiameter"], Piece::Value("tool.diameter")),
    (&["toolname"], Piece::Value("tool.name")),
    (&["name", "program", "programname"], Piece::Value("program.name")),
];

/// Reads the templates.
pub(crate) fn read(source: &str, findings: &mut Findings) -> Post {
    let mut post = Post::default();
    let mut field: Option<Field> = None;
    // The template, drilling or engraving, that the part was taken from.
    let mut taken: Vec<(Part, String)> = Vec::new();
    let mut skipped = false;
    for (number, line) in (1..).zip(source.lines()) {
        if let Some((template, name)) = head(line) {
            let known = FIELDS.iter().find(|(known, _)| *known == name).map(|(_, field)| *field);
            (field, skipped) = (known, false);
            match known {
                None => {
                    let names: Vec<&str> = FIELDS.iter().map(|(name, _)| *name).collect();
                    let message = format!(
                        "no field of a template is called `{}`; there are {}",
                        text::short(&name),
                        names.join(", ")
                    );
                    findings.error(number, message);
                }
                Some(Field::Job(why)) => findings.lost(number, format!("`{name}`: {why}")),
                Some(Field::Part(part)) => match taken.iter().find(|(known, _)| *known == part) {
                    Some((_, first)) if *first == template => {
                        findings.error(number, format!("`{name}` of {template} stands here again"));
                    }
                    Some((_, first)) => {
                        let message =
                            format!("`{name}` of {template}: a control has one, that of {first}");
                        findings.lost(number, message);
                        skipped = true;
                    }
                    None => taken.push((part, template)),
                },
                Some(Field::Extension) => {}
            }
            continue;
        }
        match field {
            _ if skipped || line.trim().is_empty() => {}
            Some(Field::Part(part)) => {
                let pieces = pieces(line, number, &mut post, findings);
                post.parts.entry(part).or_default().push(Line { number, pieces });
            }
            Some(Field::Extension) => {
                post.extension = Some(line.trim().trim_start_matches('.').to_owned());
            }
            Some(Field::Job(_)) => {}
            None => {
                let message = "a line before the first field, such as `[engraving: linear move]`";
                findings.error(number, message);
                skipped = true;
            }
        }
    }
    sign_radius(&mut post, findings);
    post
}

/// Gives a radius its sign where it is all that says a circle, behind the address by which controls read
/// one.
fn sign_radius(post: &mut Post, findings: &mut Findings) {
    let read = post.words.get("RADIUS").is_some_and(|form| matches!(&*form.address, "R" | "CR="));
    let has_other = |line: &Line| line.words().any(|word| CIRCLE.contains(&word));
    if !read || post.parts.values().flatten().any(has_other) {
        return;
    }
    let form = post.words.remove("RADIUS");
    post.words.extend(form.map(|form| ("R", form)));
    for line in post.parts.values_mut().flatten() {
        for piece in line.pieces.iter_mut().filter(|piece| **piece == Piece::Word("RADIUS")) {
            *piece = Piece::Word("R");
            let message = "the radius is negative over a half circle, as controls read it";
            findings.otherwise(line.number, message);
        }
    }
}

/// `[engraving: linear move]`: the template and the field, in small letters, signs as blanks.
fn head(line: &str) -> Option<(String, String)> {
    let inner = line.trim().strip_prefix('[')?.strip_suffix(']')?;
    let (template, field) = inner.split_once([':', '.', '/'])?;
    let template = template.trim().to_ascii_lowercase();
    let known = matches!(template.as_str(), "drilling" | "engraving");
    let words = field.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let field = words.collect::<Vec<_>>().join(" ").to_ascii_lowercase();
    known.then_some((template, field))
}

/// A line of the program: text and parameters between `@`. What stands right before the number of a word
/// is its address.
fn pieces(line: &str, number: u32, post: &mut Post, findings: &mut Findings) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut rest = line.trim_end();
    while let Some((before, behind)) = rest.split_once('@') {
        let Some((name, after)) = behind.split_once('@') else {
            findings.error(number, "an `@` that begins a parameter and none that ends it");
            return pieces;
        };
        rest = after;
        let plain = |c: &char| c.is_ascii_alphanumeric();
        let bare: String = name.to_ascii_lowercase().chars().filter(plain).collect();
        let known = PARAMETERS.iter().find(|(names, _)| names.contains(&bare.as_str()));
        let piece = match known {
            Some((_, piece)) => piece.clone(),
            None => Piece::Unknown(format!("@{}@", text::short(name)), "is no parameter of ours"),
        };
        let Piece::Word(word) = piece else {
            pieces.push(Piece::Text(before.to_owned()));
            pieces.push(piece);
            continue;
        };
        let address_of = |c: char| c.is_ascii_alphanumeric() || matches!(c, '=' | '_' | '-' | '+');
        let at = before.trim_end_matches(address_of).len();
        // A number before the address belongs to another word: G1X.
        let address = &before[at..];
        let glued = address.rfind(|c: char| c.is_ascii_digit()).map_or(0, |i| i + 1);
        let glued = if address.ends_with('=') { 0 } else { glued };
        let (text, address) = before.split_at(at + glued);
        let form =
            Form { address: address.to_owned(), decimals: None, modal: Some(false), scale: 1.0 };
        let piece = match post.words.get(word) {
            Some(known) if *known != form => Piece::Unknown(
                format!("{address}@{}@", text::short(name)),
                "stands behind another address elsewhere: a word has one",
            ),
            _ => {
                post.words.insert(word, form);
                Piece::Word(word)
            }
        };
        pieces.push(Piece::Text(text.to_owned()));
        pieces.push(piece);
    }
    pieces.push(Piece::Text(rest.to_owned()));
    pieces.retain(|piece| *piece != Piece::Text(String::new()));
    pieces
}
