//! From files to a [`Machine`]: reading, merging along `extends`, checking.
//!
//! A [`Sheet`] is one file as it stands; every field may be missing, no other field may be there. The
//! sheets of a chain are merged, the nearer one winning field by field, and the result must be whole.

use crate::library;
use crate::model::*;
use geom::{Vec3, direction};
use program::Diagnostic;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// How many files a chain of `extends` may have.
const LONGEST_CHAIN: usize = 16;

/// Largest file that is read, bytes.
const LARGEST_FILE: u64 = 4 << 20;

type Result<T> = std::result::Result<T, Box<Diagnostic>>;

/// Loads a machine: a name of the library, or the path of a file (with a `/` or ending in `.toml`).
///
/// # Errors
/// The first mistake in the chain of files, with file, line, column and the way out.
pub fn load(name_or_path: &str) -> Result<Machine> {
    let file = if is_path(name_or_path) {
        SheetFile::read(Path::new(name_or_path))?
    } else {
        SheetFile::of_library(name_or_path, library::MACHINES)?
    };
    build(file)
}

/// Loads a machine from TOML text, as if it stood in `file_name`. What it extends by path is looked up
/// from the folder of that name.
///
/// # Errors
/// As [`load`].
pub fn load_text(file_name: &str, text: &str) -> Result<Machine> {
    build(SheetFile { path: PathBuf::from(file_name), text: text.to_string(), own: true })
}

fn build(file: SheetFile) -> Result<Machine> {
    let name = file.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let leaf = file.parse()?;
    let mut control = None;
    let mut merged = leaf.check(&file)?;
    let mut here = file;
    for depth in 0.. {
        let Some(parent) = merged.extends.take() else { break };
        if depth == LONGEST_CHAIN {
            return Err(here
                .at("extends", &parent, "the chain of `extends` has no end")
                .help("no file may extend itself, not even by way of others")
                .into());
        }
        let next = here.parent(&parent)?;
        control.get_or_insert_with(|| parent.get_ref().clone());
        merged = next.parse()?.check(&next)?.under(merged);
        here = next;
    }
    let missing = |what: &str| {
        let message = format!("{what} is missing, here and in everything that this file extends");
        Box::new(Diagnostic::error("machine-incomplete", message).file(name.clone()))
    };
    merged.finish(name.clone(), control.unwrap_or_else(|| name.clone()), &missing)
}

fn is_path(name: &str) -> bool {
    name.contains(['/', '\\']) || name.ends_with(".toml")
}

/// A file with its text.
struct SheetFile {
    path: PathBuf,
    text: String,
    /// Whether it is a file of the user's, not of the library.
    own: bool,
}

impl SheetFile {
    fn read(path: &Path) -> Result<SheetFile> {
        let shown = path.display().to_string();
        let fail = |why: String| {
            Diagnostic::error("machine-unreadable", why)
                .help("`toolpost machines list` names the machines of the library")
                .file(shown.clone())
        };
        let size = std::fs::metadata(path).map_err(|e| fail(format!("cannot be read: {e}")))?.len();
        if size > LARGEST_FILE {
            return Err(fail(format!("{size} bytes are no machine file")).into());
        }
        let text =
            std::fs::read_to_string(path).map_err(|e| fail(format!("cannot be read: {e}")))?;
        Ok(SheetFile { path: path.to_path_buf(), text, own: true })
    }

    fn of_library(name: &str, kinds: &[library::Kind]) -> Result<SheetFile> {
        match library::find(name, kinds) {
            Some((path, text)) => {
                Ok(SheetFile { path: PathBuf::from(path), text: text.to_string(), own: false })
            }
            None => {
                let known = library::names(kinds).collect::<Vec<_>>().join(", ");
                let message = format!("`{name}` is not in the library");
                Err(Diagnostic::error("machine-unknown", message)
                    .help(format!("one of {known}, or the path of a file"))
                    .into())
            }
        }
    }

    fn parent(&self, parent: &Spanned<String>) -> Result<SheetFile> {
        let name = parent.get_ref();
        let found = if is_path(name) && self.own {
            let folder = self.path.parent().unwrap_or(Path::new(""));
            SheetFile::read(&folder.join(name))
        } else {
            SheetFile::of_library(name, library::EVERYTHING)
        };
        found.map_err(|d| self.at("extends", parent, &d.message).help(d.help).into())
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn parse(&self) -> Result<Sheet> {
        toml::from_str(&self.text).map_err(|e| {
            let span = e.span().unwrap_or(0..0);
            let message = e.message().trim().replace('\n', "; ");
            self.diagnostic("machine-file", message, span).into()
        })
    }

    fn at<T>(&self, what: &str, place: &Spanned<T>, message: &str) -> Diagnostic {
        self.diagnostic("machine-file", format!("{what}: {message}"), place.span())
    }

    fn diagnostic(
        &self,
        rule: &'static str,
        message: String,
        span: std::ops::Range<usize>,
    ) -> Diagnostic {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        let start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        let line = self.line_of(span.start);
        let text = self.text.as_bytes()[start..].split(|&b| b == b'\n').next().unwrap_or_default();
        Diagnostic::error(rule, message).file(self.name()).at(
            line,
            text,
            span.start - start,
            span.end.saturating_sub(start),
        )
    }

    fn line_of(&self, offset: usize) -> u32 {
        let before = &self.text.as_bytes()[..offset.min(self.text.len())];
        1 + before.iter().filter(|&&b| b == b'\n').count() as u32
    }

    /// The block whose TOML value stands at `value`: a text in triple quotes begins on the line after.
    fn block(&self, value: Spanned<String>) -> Block {
        let span = value.span();
        let raw = self.text.get(span.clone()).unwrap_or_default();
        let opened = raw.starts_with("\"\"\"\n") || raw.starts_with("'''\n");
        let line = self.line_of(span.start) + u32::from(opened);
        let before = self.text.get(..span.start).unwrap_or_default();
        let indent = before.chars().rev().take_while(|&c| c != '\n').count();
        let quotes = raw.bytes().take_while(|&b| matches!(b, b'"' | b'\'')).count();
        let column = if opened { 1 } else { 1 + indent + quotes.min(3) };
        let column = u32::try_from(column).unwrap_or(u32::MAX);
        Block { text: value.into_inner(), file: self.name(), line, column }
    }
}

/// One file as it stands.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sheet {
    extends: Option<Spanned<String>>,
    title: Option<String>,
    reader: Option<String>,
    extension: Option<String>,
    #[serde(default)]
    capabilities: CapabilitiesSheet,
    #[serde(default)]
    format: FormatSheet,
    #[serde(default)]
    words: BTreeMap<String, WordSheet>,
    #[serde(default)]
    blocks: BTreeMap<String, Spanned<String>>,
    #[serde(default)]
    axes: BTreeMap<LinearName, LinearSheet>,
    rotary: Option<Vec<Spanned<RotarySheet>>>,
    work_zero: Option<[f64; 3]>,
    #[serde(default)]
    orientation: OrientationSheet,
    #[serde(default)]
    spindle: SpindleSheet,
    #[serde(default)]
    tools: ToolsSheet,
    auxiliary: Option<Vec<u32>>,
    approach: Option<Vec<String>>,
    #[serde(default)]
    options: BTreeMap<String, OptionSheet>,
}

/// A struct whose fields are all optional, and how a nearer one lies over it.
macro_rules! sheet {
    ($name:ident { $($field:ident: $type:ty),* $(,)? }) => {
        #[derive(Default, Deserialize)]
        #[serde(deny_unknown_fields)]
        struct $name { $($field: Option<$type>,)* }
        impl $name {
            fn under(self, nearer: $name) -> $name {
                $name { $($field: nearer.$field.or(self.$field),)* }
            }
        }
    };
}

sheet!(CapabilitiesSheet {
    arcs: Vec<Plane>,
    helix: bool,
    full_circle: bool,
    arc_tolerance: f64,
    cycles: Vec<CycleName>,
    compensation: bool,
    feed_per_turn: bool,
    inverse_time: bool,
    length_offset: LengthOffset,
    line_length: usize,
    lowering_tolerance: f64,
});

sheet!(FormatSheet {
    separator: String,
    line_end: String,
    comment_start: String,
    comment_end: String,
});

sheet!(WordSheet {
    address: String,
    suffix: String,
    decimals: Spanned<u8>,
    trim: bool,
    point: bool,
    plus: bool,
    digits: u8,
    modal: bool,
    step: u32,
    first: u32,
    scale: f64,
    max: f64,
    codes: BTreeMap<String, String>,
});

sheet!(LinearSheet { min: f64, max: f64, rapid: f64, acceleration: f64 });

sheet!(OrientationSheet {
    simultaneous: OrientationMode,
    positioned: OrientationMode,
    tolerance: f64,
});

sheet!(SpindleSheet { min: f64, max: f64 });

sheet!(ToolsSheet { max_number: u32, max_diameter: f64, max_length: f64 });

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RotarySheet {
    letter: char,
    on: Mount,
    axis: [f64; 3],
    #[serde(default)]
    point: [f64; 3],
    #[serde(default = "one")]
    sign: f64,
    #[serde(default)]
    offset: f64,
    #[serde(default = "no_minimum")]
    min: f64,
    #[serde(default = "no_maximum")]
    max: f64,
    rapid: f64,
    acceleration: f64,
    #[serde(default)]
    prefer: f64,
}

fn one() -> f64 {
    1.0
}

fn no_minimum() -> f64 {
    f64::NEG_INFINITY
}

fn no_maximum() -> f64 {
    f64::INFINITY
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
enum LinearName {
    X,
    Y,
    Z,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum OptionSheet {
    Flag(bool),
    Number(f64),
    Text(String),
}

impl Sheet {
    /// What serde cannot see, told at its place in the file.
    fn check(self, file: &SheetFile) -> Result<CheckedSheet> {
        for (name, word) in &self.words {
            if let Some(decimals) = &word.decimals
                && *decimals.get_ref() > 9
            {
                let what = format!("words.{name}.decimals");
                return Err(file.at(&what, decimals, "at most 9 decimals can be written").into());
            }
        }
        let rotary = self.rotary.map(|axes| check_rotary(file, axes)).transpose()?;
        let blocks = self.blocks.into_iter().map(|(name, text)| (name, file.block(text))).collect();
        Ok(CheckedSheet {
            extends: self.extends,
            title: self.title,
            reader: self.reader,
            extension: self.extension,
            capabilities: self.capabilities,
            format: self.format,
            words: self.words,
            blocks,
            axes: self.axes,
            rotary,
            work_zero: self.work_zero,
            orientation: self.orientation,
            spindle: self.spindle,
            tools: self.tools,
            auxiliary: self.auxiliary,
            approach: self.approach,
            options: self.options,
        })
    }
}

fn check_rotary(file: &SheetFile, axes: Vec<Spanned<RotarySheet>>) -> Result<Vec<RotaryAxis>> {
    let mut checked: Vec<RotaryAxis> = Vec::new();
    for spanned in axes {
        let fail = |message: &str| Box::new(file.at("rotary", &spanned, message));
        let sheet = spanned.get_ref();
        if !matches!(sheet.letter, 'A' | 'B' | 'C') {
            return Err(fail("`letter` is one of A, B, C"));
        }
        if checked.iter().any(|axis| axis.letter == sheet.letter) {
            return Err(fail("this letter is taken by another rotary axis"));
        }
        if checked.len() == 2 {
            return Err(fail("more than two rotary axes cannot be driven"));
        }
        let axis = direction(Vec3::from_array(sheet.axis))
            .ok_or_else(|| fail("`axis` has no direction: give a vector of some length"))?;
        if !Vec3::from_array(sheet.point).is_finite() || !sheet.offset.is_finite() {
            return Err(fail("`point` and `offset` are finite numbers"));
        }
        if sheet.sign.abs() != 1.0 {
            return Err(fail("`sign` is 1 or -1"));
        }
        let limits = sheet.min < sheet.max;
        if !limits {
            return Err(fail("`min` is less than `max`, in degrees"));
        }
        if !(is_rate(sheet.rapid) && is_rate(sheet.acceleration)) {
            return Err(fail("`rapid` (degrees/min) and `acceleration` (degrees/s²) are positive"));
        }
        checked.push(RotaryAxis {
            letter: sheet.letter,
            on: sheet.on,
            axis,
            point: Vec3::from_array(sheet.point),
            sign: sheet.sign,
            offset: sheet.offset,
            min: sheet.min,
            max: sheet.max,
            rapid: sheet.rapid,
            acceleration: sheet.acceleration,
            prefer: sheet.prefer,
        });
    }
    Ok(checked)
}

fn is_rate(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

/// A file whose own values are in order.
struct CheckedSheet {
    extends: Option<Spanned<String>>,
    title: Option<String>,
    reader: Option<String>,
    extension: Option<String>,
    capabilities: CapabilitiesSheet,
    format: FormatSheet,
    words: BTreeMap<String, WordSheet>,
    blocks: BTreeMap<String, Block>,
    axes: BTreeMap<LinearName, LinearSheet>,
    rotary: Option<Vec<RotaryAxis>>,
    work_zero: Option<[f64; 3]>,
    orientation: OrientationSheet,
    spindle: SpindleSheet,
    tools: ToolsSheet,
    auxiliary: Option<Vec<u32>>,
    approach: Option<Vec<String>>,
    options: BTreeMap<String, OptionSheet>,
}

/// `nearer` over `farther`, entry by entry; what both have is joined by `join`.
fn overlay<K: Ord, V>(
    mut farther: BTreeMap<K, V>,
    nearer: BTreeMap<K, V>,
    join: impl Fn(V, V) -> V,
) -> BTreeMap<K, V> {
    for (key, value) in nearer {
        let value = match farther.remove(&key) {
            Some(under) => join(under, value),
            None => value,
        };
        farther.insert(key, value);
    }
    farther
}

impl CheckedSheet {
    fn under(self, nearer: CheckedSheet) -> CheckedSheet {
        CheckedSheet {
            extends: self.extends,
            title: nearer.title.or(self.title),
            reader: nearer.reader.or(self.reader),
            extension: nearer.extension.or(self.extension),
            capabilities: self.capabilities.under(nearer.capabilities),
            format: self.format.under(nearer.format),
            words: overlay(self.words, nearer.words, WordSheet::under),
            blocks: overlay(self.blocks, nearer.blocks, |_, nearer| nearer),
            axes: overlay(self.axes, nearer.axes, LinearSheet::under),
            rotary: nearer.rotary.or(self.rotary),
            work_zero: nearer.work_zero.or(self.work_zero),
            orientation: self.orientation.under(nearer.orientation),
            spindle: self.spindle.under(nearer.spindle),
            tools: self.tools.under(nearer.tools),
            auxiliary: nearer.auxiliary.or(self.auxiliary),
            approach: nearer.approach.or(self.approach),
            options: overlay(self.options, nearer.options, |_, nearer| nearer),
        }
    }

    fn finish(
        mut self,
        name: String,
        control: String,
        missing: &dyn Fn(&str) -> Box<Diagnostic>,
    ) -> Result<Machine> {
        let rotary = self.rotary.take().unwrap_or_default();
        let orientation = self.orientation;
        let simultaneous = orientation.simultaneous.unwrap_or(OrientationMode::Fixed);
        let positioned = orientation.positioned.unwrap_or(simultaneous);
        let capabilities = self.capabilities;
        let linear = [LinearName::X, LinearName::Y, LinearName::Z];
        let linear = linear.map(|axis| finish_linear(self.axes.remove(&axis).unwrap_or_default()));
        if linear.iter().any(|axis| axis.min >= axis.max || !is_rate(axis.rapid)) {
            return Err(missing("a travel with `min` less than `max` and a positive `rapid`"));
        }
        if rotary.is_empty() != (simultaneous == OrientationMode::Fixed) {
            return Err(missing(
                "`orientation.simultaneous` for the rotary axes (or the rotary axes themselves)",
            ));
        }
        let format = self.format;
        Ok(Machine {
            title: self.title.unwrap_or_else(|| name.clone()),
            name,
            control,
            reader: self.reader.ok_or_else(|| missing("`reader`, the virtual control,"))?,
            extension: self.extension.unwrap_or_else(|| "nc".into()),
            capabilities: Capabilities {
                arcs: capabilities.arcs.unwrap_or_default(),
                helix: capabilities.helix.unwrap_or(false),
                full_circle: capabilities.full_circle.unwrap_or(false),
                arc_tolerance: capabilities.arc_tolerance.unwrap_or(0.001),
                cycles: capabilities.cycles.unwrap_or_default(),
                compensation: capabilities.compensation.unwrap_or(false),
                feed_per_turn: capabilities.feed_per_turn.unwrap_or(false),
                inverse_time: capabilities.inverse_time.unwrap_or(false),
                length_offset: capabilities.length_offset.unwrap_or(LengthOffset::Implicit),
                line_length: capabilities.line_length.unwrap_or(256),
                lowering_tolerance: capabilities.lowering_tolerance.unwrap_or(0.005),
            },
            format: Format {
                separator: format.separator.unwrap_or_else(|| " ".into()),
                line_end: format.line_end.unwrap_or_else(|| "\n".into()),
                comment_start: format.comment_start.unwrap_or_else(|| "(".into()),
                comment_end: format.comment_end.unwrap_or_else(|| ")".into()),
            },
            words: self.words.into_iter().map(|(name, word)| finish_word(name, word)).collect(),
            blocks: self.blocks,
            linear,
            rotary,
            work_zero: self.work_zero.map(Vec3::from_array),
            orientation: OrientationSettings {
                simultaneous,
                positioned,
                tolerance: orientation.tolerance.unwrap_or(0.005),
            },
            spindle: SpindleRange {
                min: self.spindle.min.unwrap_or(0.0),
                max: self.spindle.max.unwrap_or(f64::INFINITY),
            },
            tools: ToolRange {
                max_number: self.tools.max_number.unwrap_or(u32::MAX),
                max_diameter: self.tools.max_diameter.unwrap_or(f64::INFINITY),
                max_length: self.tools.max_length.unwrap_or(f64::INFINITY),
            },
            auxiliary: self.auxiliary.unwrap_or_default(),
            approach: self.approach.unwrap_or_else(|| vec!["XY".into(), "Z".into()]),
            options: (self.options.into_iter())
                .map(|(name, value)| match value {
                    OptionSheet::Flag(flag) => (name, OptionValue::Flag(flag)),
                    OptionSheet::Number(number) => (name, OptionValue::Number(number)),
                    OptionSheet::Text(text) => (name, OptionValue::Text(text)),
                })
                .collect(),
        })
    }
}

fn finish_linear(sheet: LinearSheet) -> LinearAxis {
    LinearAxis {
        min: sheet.min.unwrap_or(f64::NEG_INFINITY),
        max: sheet.max.unwrap_or(f64::INFINITY),
        rapid: sheet.rapid.unwrap_or(10_000.0),
        acceleration: sheet.acceleration.unwrap_or(2.0),
    }
}

fn finish_word(name: String, sheet: WordSheet) -> (String, Word) {
    let word = Word {
        address: sheet.address.unwrap_or_else(|| name.clone()),
        suffix: sheet.suffix.unwrap_or_default(),
        decimals: sheet.decimals.map_or(3, Spanned::into_inner),
        trim: sheet.trim.unwrap_or(false),
        point: sheet.point.unwrap_or(false),
        plus: sheet.plus.unwrap_or(false),
        digits: sheet.digits.unwrap_or(1),
        modal: sheet.modal.unwrap_or(false),
        step: sheet.step.unwrap_or(10),
        first: sheet.first.or(sheet.step).unwrap_or(10),
        scale: sheet.scale.unwrap_or(1.0),
        max: sheet.max.unwrap_or(f64::INFINITY),
        codes: sheet.codes.unwrap_or_default(),
    };
    (name, word)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MILL: &str = r#"
title = "A mill"
reader = "linuxcnc"
[words.X]
decimals = 4
[blocks]
rapid = "G0 {{X}}"
tool_change = """
T{{T}}
M6
"""
[axes.X]
min = 0
max = 200.5
"#;

    fn refusal(text: &str) -> String {
        load_text("mill.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn what_is_written_is_what_is_loaded_and_the_rest_has_defaults() {
        let mill = load_text("shop/mill.toml", MILL).unwrap();
        assert_eq!((mill.name.as_str(), mill.title.as_str()), ("mill", "A mill"));
        assert_eq!(mill.words["X"].decimals, 4);
        assert_eq!(mill.linear[0].max, 200.5);
        assert_eq!(mill.linear[1].max, f64::INFINITY);
        assert_eq!(mill.orientation.simultaneous, OrientationMode::Fixed);
        assert_eq!(mill.resolution(), 1e-4);
    }

    #[test]
    fn a_block_knows_where_its_text_begins() {
        let mill = load_text("mill.toml", MILL).unwrap();
        assert_eq!((mill.blocks["rapid"].line, mill.blocks["rapid"].column), (7, 10));
        assert_eq!((mill.blocks["tool_change"].line, mill.blocks["tool_change"].column), (9, 1));
        assert!(mill.blocks["tool_change"].text.starts_with("T{{T}}\n"));
    }

    #[test]
    fn an_unknown_key_is_named_with_line_and_column() {
        let shown = refusal("reader = \"grbl\"\n[spindle]\nmaxx = 5\n");
        assert!(shown.starts_with("mill.toml:3:1: error[machine-file]: unknown field `maxx`"));
        assert!(shown.contains("`max`"));
    }

    #[test]
    fn mistakes_that_only_a_machinist_sees_are_told_at_their_place() {
        let rotary = |fields: &str| {
            refusal(&format!(
                "reader = \"grbl\"\n[orientation]\nsimultaneous = \"vectors\"\n[[rotary]]\nletter = \
                 \"A\"\non = \"table\"\nrapid = 1\nacceleration = 1\n{fields}\n"
            ))
        };
        assert!(rotary("axis = [0, 0, 0]").contains("`axis` has no direction"));
        assert!(rotary("axis = [1, 0, 0]\nsign = 2").contains("`sign` is 1 or -1"));
        assert!(rotary("axis = [1, 0, 0]\nmin = 5\nmax = 5").contains("`min` is less than `max`"));
        assert!(refusal("reader = \"g\"\n[words.X]\ndecimals = 12").contains(":3:12:"));
        assert!(refusal("reader = \"g\"\n[axes.X]\nmin = 3\nmax = 3").contains("travel"));
        assert!(refusal("title = \"no reader\"").contains("`reader`"));
    }

    #[test]
    fn orientation_needs_rotary_axes_and_the_other_way_round() {
        assert!(
            refusal("reader = \"g\"\n[orientation]\nsimultaneous = \"vectors\"").contains("rotary")
        );
    }

    #[test]
    fn a_missing_or_endless_ancestor_is_told_where_it_is_named() {
        let shown = refusal("extends = \"nowhere\"");
        assert!(
            shown.starts_with("mill.toml:1:11: error[machine-file]: extends: `nowhere`"),
            "{shown}"
        );
        let folder = std::env::temp_dir().join(format!("toolpost-load-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("round.toml");
        std::fs::write(&file, "extends = \"round.toml\"").unwrap();
        let shown = load(file.to_str().unwrap()).unwrap_err().to_string();
        assert!(shown.contains("the chain of `extends` has no end"), "{shown}");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_nearer_file_changes_single_values_and_keeps_the_rest() {
        let folder = std::env::temp_dir().join(format!("toolpost-merge-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("base.toml"), MILL).unwrap();
        let file = folder.join("mine.toml");
        let text = "extends = \"base.toml\"\n[words.X]\nmodal = true\n[blocks]\nrapid = \"G0\"\n";
        std::fs::write(&file, text).unwrap();
        let mine = load(file.to_str().unwrap()).unwrap();
        assert_eq!((mine.words["X"].decimals, mine.words["X"].modal), (4, true));
        assert_eq!(mine.blocks["rapid"].text, "G0");
        assert!(mine.blocks.contains_key("tool_change"));
        assert_eq!((mine.control.as_str(), mine.title.as_str()), ("base.toml", "A mill"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
