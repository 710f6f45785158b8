//! Which file of a board is which: by what it says of itself, or else by its name.

use memchr::memmem;
use std::fmt;

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layer {
    /// Copper of a side.
    Copper(Face),
    /// Openings of the solder mask of a side.
    Mask(Face),
    /// What is printed on a side.
    Legend(Face),
    /// The edge of the board.
    Outline,
    /// Holes, and whether their walls are plated, where the file or its name says so.
    Holes(Option<bool>),
    /// Something else: inner copper, paste, drawings.
    Other,
}

/// A side of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Face {
    /// The side that is looked at.
    Front,
    /// The other side.
    Back,
}

impl fmt::Display for Face {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Face::Front { "front" } else { "back" })
    }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Layer::Copper(face) => write!(f, "{face} copper"),
            Layer::Mask(face) => write!(f, "{face} solder mask"),
            Layer::Legend(face) => write!(f, "{face} legend"),
            Layer::Outline => f.write_str("outline"),
            Layer::Holes(None) => f.write_str("holes"),
            Layer::Holes(Some(true)) => f.write_str("plated holes"),
            Layer::Holes(Some(false)) => f.write_str("holes that are not plated"),
            Layer::Other => f.write_str("nothing that is cut"),
        }
    }
}

/// How a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Gerber,
    Excellon,
}

impl Format {
    /// The one that `text` is in; `None` where it is in neither.
    pub(crate) fn of(text: &[u8]) -> Option<Format> {
        let head = text.get(..1 << 16).unwrap_or(text);
        let has = |word: &str| memmem::find(head, word.as_bytes()).is_some();
        if ["%FS", "%MO", "%ADD"].into_iter().any(has) {
            return Some(Format::Gerber);
        }
        // The header begins with M48; without one, there are lines of coordinates alone.
        let mut lines = head.split(|byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
        let excellon = lines.any(|line| line == b"M48" || coordinates(line));
        excellon.then_some(Format::Excellon)
    }
}

/// Whether a line has nothing but coordinates: `X0125Y-03`.
fn coordinates(line: &[u8]) -> bool {
    let sign = |byte: &u8| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.' | b'X' | b'Y');
    matches!(line, [b'X' | b'Y', _, ..]) && line.iter().all(sign)
}

impl Layer {
    /// What the file says of itself (`.FileFunction`); `None` where it says nothing.
    pub(super) fn stated(text: &[u8]) -> Option<Layer> {
        let mut fields = function(text)?;
        let function = fields.next()?;
        let rest: Vec<&str> = fields.collect();
        let face = || match () {
            () if rest.contains(&"Top") => Some(Face::Front),
            () if rest.contains(&"Bot") => Some(Face::Back),
            () => None,
        };
        let through = !rest.iter().any(is_not_through);
        let layer = match function {
            "Copper" => face().map(Layer::Copper),
            "Soldermask" => face().map(Layer::Mask),
            "Legend" => face().map(Layer::Legend),
            "Profile" => Some(Layer::Outline),
            "Plated" if through => Some(Layer::Holes(Some(true))),
            "NonPlated" if through => Some(Layer::Holes(Some(false))),
            "MixedPlating" if through => Some(Layer::Holes(None)),
            _ => None,
        };
        Some(layer.unwrap_or(Layer::Other))
    }

    /// Whether the file says that it has holes which do not go through the board.
    pub(super) fn is_not_through(text: &[u8]) -> bool {
        function(text).is_some_and(|fields| fields.skip(1).any(|field| is_not_through(&field)))
    }

    /// What a file of this name holds, as the CAD systems name them; `None` where they have no such name.
    pub(super) fn named(name: &str) -> Option<Layer> {
        let name = name.to_ascii_lowercase();
        let name = name.rsplit(['/', '\\']).next().unwrap_or(&name);
        let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
        let known = EXTENSIONS.iter().find(|(extensions, _)| extensions.contains(&extension));
        if DRAWINGS.contains(&extension) {
            return Some(Layer::Other);
        }
        let by_extension = known.map(|(_, layer)| *layer).or_else(|| numbered(extension));
        by_extension.or_else(|| {
            let known = WORDS.iter().find(|(words, _)| words.iter().any(|word| within(stem, word)));
            known.map(|(_, layer)| *layer)
        })
    }
}

impl Layer {
    /// What a Gerber file holds whose name has a side in it, and perhaps what of that side: `board.top.gbr`, `BottomMask.ger`.
    pub(super) fn by_side(name: &str) -> Option<Layer> {
        let name = name.to_ascii_lowercase();
        let name = name.rsplit(['/', '\\']).next().unwrap_or(&name);
        let (mut face, mut what) = (None, None);
        for word in name.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| !word.is_empty()) {
            let side = SIDES.iter().find_map(|(side, of)| {
                let rest = word.strip_prefix(side).or_else(|| word.strip_suffix(side))?;
                (rest.is_empty() || kind(rest).is_some()).then_some((*of, rest))
            });
            let rest = side.map_or(word, |(_, rest)| rest);
            face = face.or(side.map(|(face, _)| face));
            what = kind(rest).filter(|kind| *kind != Kind::Copper).or(what);
        }
        match what.unwrap_or(Kind::Copper) {
            Kind::Copper => face.map(Layer::Copper),
            Kind::Mask => face.map(Layer::Mask),
            Kind::Legend => face.map(Layer::Legend),
            Kind::Other => Some(Layer::Other),
        }
    }
}

/// What of a side a word of a name is about.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Copper,
    Mask,
    Legend,
    Other,
}

fn kind(word: &str) -> Option<Kind> {
    KINDS.iter().find(|(words, _)| words.contains(&word)).map(|(_, kind)| *kind)
}

/// Words for the sides: gEDA and pcb-rnd, DipTrace, EasyEDA, Mentor.
const SIDES: [(&str, Face); 5] = [
    ("top", Face::Front),
    ("front", Face::Front),
    ("bottom", Face::Back),
    ("back", Face::Back),
    ("bot", Face::Back),
];

/// Words for what is on a side.
const KINDS: [(&[&str], Kind); 4] = [
    (&["layer", "copper", "cu", "side", "etch", "etchlayer"], Kind::Copper),
    (&["mask", "soldermask", "solderresist", "resist", "stopmask"], Kind::Mask),
    (&["silk", "silks", "silkscreen", "legend", "overlay"], Kind::Legend),
    (
        &[
            "paste",
            "solderpaste",
            "pastemask",
            "stencil",
            "assembly",
            "fab",
            "courtyard",
            "adhesive",
            "inner",
            "drill",
            "drawing",
            "document",
        ],
        Kind::Other,
    ),
];

/// The fields of what the file says it is (`.FileFunction`).
fn function(text: &[u8]) -> Option<impl Iterator<Item = &str>> {
    let attribute = b"TF.FileFunction,";
    let value = text.get(memmem::find(text, attribute)? + attribute.len()..)?;
    let end = value.iter().position(|byte| matches!(byte, b'*' | b'\n' | b'\r'));
    let value = std::str::from_utf8(value.get(..end?)?).ok()?;
    Some(value.split(',').map(str::trim))
}

/// Whether a field of a function says that holes do not go through the board.
fn is_not_through(field: &&str) -> bool {
    matches!(*field, "Blind" | "Buried")
}

/// Whether `word` stands in `stem`, and not within another one.
fn within(stem: &str, word: &str) -> bool {
    let letter = |c: Option<char>| c.is_some_and(|c| c.is_ascii_alphanumeric());
    stem.match_indices(word).any(|(at, _)| {
        let (before, after) = (stem.get(..at), stem.get(at + word.len()..));
        !letter(before.and_then(|text| text.chars().next_back()))
            && !letter(after.and_then(|text| text.chars().next()))
    })
}

/// Extensions with a number: inner and mechanical layers, planes, drawings.
fn numbered(extension: &str) -> Option<Layer> {
    let stem = extension.trim_end_matches(|c: char| c.is_ascii_digit());
    let drawn = matches!(stem, "g" | "gp" | "gm" | "gd" | "gg" | "in" | "ly");
    (drawn && stem != extension).then_some(Layer::Other)
}

/// By the extension: Protel and Altium, EAGLE, OrCAD. `docs/sources/gerber.md` has the sources.
const EXTENSIONS: [(&[&str], Layer); 10] = [
    (&["gtl", "cmp", "top"], Layer::Copper(Face::Front)),
    (&["gbl", "sol", "bot"], Layer::Copper(Face::Back)),
    (&["gts", "stc", "tsm", "smt"], Layer::Mask(Face::Front)),
    (&["gbs", "sts", "bsm", "smb"], Layer::Mask(Face::Back)),
    (&["gto", "plc", "tsk", "sst"], Layer::Legend(Face::Front)),
    (&["gbo", "pls", "bsk", "ssb"], Layer::Legend(Face::Back)),
    (&["gko", "gm1", "gml", "dim", "mil"], Layer::Outline),
    (&["drl", "xln", "exc", "drd", "tap", "ncd"], Layer::Holes(None)),
    (&["gtp", "crc", "tsp", "spt", "gpt"], Layer::Other),
    (&["gbp", "crs", "bsp", "spb", "gpb"], Layer::Other),
];

/// Endings of drawings, pictures and models that CAD systems save in the same folder as the layers, under the same names.
const DRAWINGS: [&str; 14] = [
    "pdf", "svg", "png", "jpg", "dxf", "ps", "eps", "step", "stp", "wrl", "zip", "html", "csv",
    "gbrjob",
];

/// By words in the rest of the name: KiCad, Fusion and EAGLE 9, others.
const WORDS: [(&[&str], Layer); 8] = [
    (&["f_cu", "f.cu", "copper_top", "top_copper"], Layer::Copper(Face::Front)),
    (&["b_cu", "b.cu", "copper_bottom", "bottom_copper"], Layer::Copper(Face::Back)),
    (&["f_mask", "f.mask", "soldermask_top"], Layer::Mask(Face::Front)),
    (&["b_mask", "b.mask", "soldermask_bottom"], Layer::Mask(Face::Back)),
    (
        &["f_silks", "f.silks", "f_silkscreen", "f.silkscreen", "silkscreen_top"],
        Layer::Legend(Face::Front),
    ),
    (
        &["b_silks", "b.silks", "b_silkscreen", "b.silkscreen", "silkscreen_bottom"],
        Layer::Legend(Face::Back),
    ),
    (
        &[
            "edge_cuts",
            "edge.cuts",
            "profile",
            "outline",
            "boardoutline",
            "boardoutlinelayer",
            "edge",
            "edges",
            "contour",
        ],
        Layer::Outline,
    ),
    (
        &["f_paste", "f.paste", "b_paste", "b.paste", "solderpaste_top", "solderpaste_bottom"],
        Layer::Other,
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use Face::{Back, Front};

    #[test]
    fn what_files_say_of_themselves() {
        let stated =
            |value: &str| Layer::stated(format!("G04 x*\n%TF.FileFunction,{value}*%\n").as_bytes());
        for (value, layer) in [
            ("Copper,L1,Top", Layer::Copper(Front)),
            ("Copper,L6,Bot,Mixed", Layer::Copper(Back)),
            ("Copper,L2,Inr", Layer::Other),
            ("Soldermask,Bot", Layer::Mask(Back)),
            ("Legend,Top,1", Layer::Legend(Front)),
            ("Profile,NP", Layer::Outline),
            ("Plated,1,2,PTH,Drill", Layer::Holes(Some(true))),
            ("NonPlated,1,2,NPTH", Layer::Holes(Some(false))),
            ("Plated,1,2,Blind", Layer::Other),
            ("Paste,Top", Layer::Other),
        ] {
            assert_eq!(stated(value), Some(layer), "{value}");
        }
        assert_eq!(Layer::stated(b"M48\n; #@! TF.FileFunction,Plated,1,2,PTH\n"), stated("Plated"));
        assert_eq!(Layer::stated(b"%MOMM*%"), None);
        assert_eq!(Layer::stated(b"%TF.FileFunction,"), None);
    }

    #[test]
    fn how_files_are_written() {
        for (text, format) in [
            ("G04 x*\n%FSLAX36Y36*%", Some(Format::Gerber)),
            ("; made by hand\r\nM48\r\nINCH\r\n", Some(Format::Excellon)),
            ("%\nT01\nX01Y-02.5\nM30\n", Some(Format::Excellon)),
            // What EAGLE writes in addition to the holes: the drills alone.
            ("T01  0.024in\nT02  0.031in\n", None),
            ("Ref,Val,X,Y\n", None),
            ("X marks the spot", None),
            ("", None),
        ] {
            assert_eq!(Format::of(text.as_bytes()), format, "{text}");
        }
    }

    #[test]
    fn what_their_names_say() {
        for (name, layer) in [
            ("board-F_Cu.gbr", Layer::Copper(Front)),
            ("A64-OlinuXino_Rev_D-B.Cu.gbr", Layer::Copper(Back)),
            ("out/Board.GTL", Layer::Copper(Front)),
            ("b.sol", Layer::Copper(Back)),
            ("board-B_Silkscreen.gbr", Layer::Legend(Back)),
            ("soldermask_top.gbr", Layer::Mask(Front)),
            ("profile.gbr", Layer::Outline),
            ("x.GM1", Layer::Outline),
            ("x.GM16", Layer::Other),
            ("x.G2", Layer::Other),
            ("drill_1_16.xln", Layer::Holes(None)),
        ] {
            assert_eq!(Layer::named(name), Some(layer), "{name}");
        }
        for (name, layer) in [
            ("hellboard.front.gbr", Some(Layer::Copper(Front))),
            ("out/Bottom.gbr", Some(Layer::Copper(Back))),
            ("board.topmask.gbr", Some(Layer::Mask(Front))),
            ("board-top-silk.gbr", Some(Layer::Legend(Front))),
            ("BottomSolderMask.ger", Some(Layer::Mask(Back))),
            ("EtchLayer2Bottom.gdo", Some(Layer::Copper(Back))),
            ("AssemblyTop.gdo", Some(Layer::Other)),
            ("Top Paste.gbr", Some(Layer::Other)),
            ("desktop.gbr", None),
            ("backup.gbr", None),
        ] {
            assert_eq!(Layer::by_side(name), layer, "{name}");
        }
        for name in ["README", "profiles.gbr", "board.gbr", "stuff_cut.gbr", "F_Custom.gbr", ""] {
            assert_eq!(Layer::named(name), None, "{name}");
        }
    }
}
