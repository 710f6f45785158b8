//! From files to a [`Machine`]: reading, merging along `extends`, checking.
//!
//! A [`Sheet`] is one file as it stands; every key may be missing, no other key may be there. The
//! sheets of a chain are merged, the nearer one winning field by field, and the result must be whole.

use crate::library;
use crate::model::*;
use crate::sheet::*;
use geom::{Vec3, direction};
use program::Diagnostic;
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

/// Loads a control of the library by its name, as the machine that says nothing beyond it.
///
/// # Errors
/// As [`load`].
pub fn load_control(name: &str) -> Result<Machine> {
    build(SheetFile::of_library(name, library::CONTROLS)?)
}

/// Loads what a program was written for: a machine as [`load`] does, or a control of the library.
///
/// # Errors
/// As [`load`].
pub fn load_origin(name_or_path: &str) -> Result<Machine> {
    match is_path(name_or_path) {
        true => load(name_or_path),
        false => build(SheetFile::of_library(name_or_path, library::EVERYTHING)?),
    }
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
    let shown = file.name();
    let mut control = None;
    let mut merged = CheckedSheet::new(file.parse()?, &file)?;
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
        merged = CheckedSheet::new(next.parse()?, &next)?.under(merged);
        here = next;
    }
    let missing = |what: &str| {
        let message = format!("{what} is missing, here and in everything that this file extends");
        Box::new(Diagnostic::error("machine-incomplete", message).file(shown.clone()))
    };
    let control = control.unwrap_or_else(|| name.clone());
    merged.finish(name.clone(), shown.clone(), control, &missing)
}

/// The machines of the library that build on a control, in however many steps.
fn builders(control: &str) -> impl Iterator<Item = &'static str> {
    let parent = |name: &str| {
        let file = SheetFile::of_library(name, library::EVERYTHING).ok()?;
        file.parse().ok()?.extends.map(Spanned::into_inner)
    };
    library::names(library::MACHINES).filter(move |name| {
        let mut chain = std::iter::successors(parent(name), |name| parent(name));
        chain.any(|ancestor| ancestor == control)
    })
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
            None if library::find(name, library::EVERYTHING).is_some() => {
                let known = builders(name).collect::<Vec<_>>().join(", ");
                let message = format!("`{name}` is a control, not a machine");
                let own = format!("a file of your own that says `extends = \"{name}\"`");
                let help = format!("the machines that build on it are {known}; or {own}");
                Err(Diagnostic::error("machine-is-control", message).help(help).into())
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

    fn placed<T>(&self, value: Spanned<T>) -> (T, Place) {
        let place = Place { file: self.name(), line: self.line_of(value.span().start) };
        (value.into_inner(), place)
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

/// A part of a file, with the place to tell where it turns out wrong after merging.
struct Placed<T> {
    sheet: T,
    place: Diagnostic,
}

impl<T> Placed<T> {
    fn new(file: &SheetFile, what: &str, spanned: Spanned<T>) -> Placed<T> {
        let place = file.at(what, &spanned, "");
        Placed { sheet: spanned.into_inner(), place }
    }

    /// Both have been in order by themselves; what is wrong together is told at the nearer place.
    fn under(self, nearer: Placed<T>, join: impl Fn(T, T) -> T) -> Placed<T> {
        Placed { sheet: join(self.sheet, nearer.sheet), place: nearer.place }
    }
}

/// `under` for what both may lack.
fn joined<T>(
    farther: Option<Placed<T>>,
    nearer: Option<Placed<T>>,
    join: impl Fn(T, T) -> T,
) -> Option<Placed<T>> {
    match (farther, nearer) {
        (Some(farther), Some(nearer)) => Some(farther.under(nearer, join)),
        (farther, nearer) => nearer.or(farther),
    }
}

/// What is wrong at a place.
fn wrong(place: &Diagnostic, message: &str) -> Box<Diagnostic> {
    Box::new(Diagnostic { message: format!("{}{message}", place.message), ..place.clone() })
}

/// A file whose own values are in order.
struct CheckedSheet {
    extends: Option<Spanned<String>>,
    title: Option<String>,
    reader: Option<(String, Place)>,
    extension: Option<String>,
    capabilities: CapabilitiesSheet,
    format: FormatSheet,
    words: BTreeMap<String, (WordSheet, Place)>,
    blocks: BTreeMap<String, Block>,
    axes: BTreeMap<LinearName, Placed<LinearSheet>>,
    rotary: Option<Placed<Vec<RotaryAxis>>>,
    work_zero: Option<Point>,
    orientation: Option<Placed<OrientationSheet>>,
    wire: Option<Placed<WireSheet>>,
    spindle: Option<Placed<SpindleSheet>>,
    feed_max: Option<Positive>,
    tools: ToolsSheet,
    auxiliary: Option<Vec<u32>>,
    operator_parameters: Option<Vec<OperatorParameter>>,
    approach: Option<Vec<String>>,
    options: BTreeMap<String, OptionSheet>,
}

impl CheckedSheet {
    /// What serde cannot see, told at its place in the file.
    fn new(sheet: Sheet, file: &SheetFile) -> Result<CheckedSheet> {
        let word = |(name, word)| (name, file.placed(word));
        let axis = |(name, axis): (LinearName, Spanned<LinearSheet>)| {
            let placed = Placed::new(file, &format!("axes.{name:?}"), axis);
            check_range(&placed.place, placed.sheet.min, placed.sheet.max, "mm")?;
            Ok((name, placed))
        };
        let axes: Result<_> = sheet.axes.unwrap_or_default().into_iter().map(axis).collect();
        let blocks = sheet.blocks.unwrap_or_default().into_iter();
        let spindle = sheet.spindle.map(|spindle| Placed::new(file, "spindle", spindle));
        if let Some(Placed { sheet, place }) = &spindle {
            check_range(place, sheet.min, sheet.max, "1/min")?;
        }
        Ok(CheckedSheet {
            extends: sheet.extends,
            title: sheet.title,
            reader: sheet.reader.map(|reader| file.placed(reader)),
            extension: sheet.extension,
            capabilities: sheet.capabilities.unwrap_or_default(),
            format: sheet.format.unwrap_or_default(),
            words: sheet.words.unwrap_or_default().into_iter().map(word).collect(),
            blocks: blocks.map(|(name, text)| (name, file.block(text))).collect(),
            axes: axes?,
            rotary: sheet.rotary.map(|axes| check_rotary(file, axes)).transpose()?,
            work_zero: sheet.work_zero,
            orientation: sheet.orientation.map(|o| Placed::new(file, "orientation", o)),
            wire: sheet.wire.map(|wire| Placed::new(file, "wire", wire)),
            spindle,
            feed_max: sheet.feed_max,
            tools: sheet.tools.unwrap_or_default(),
            auxiliary: sheet.auxiliary,
            operator_parameters: sheet.operator_parameters,
            approach: sheet.approach.map(|order| check_approach(file, order)).transpose()?,
            options: sheet.options.unwrap_or_default(),
        })
    }
}

/// Refuses a range that holds nothing.
fn check_range(
    place: &Diagnostic,
    min: Option<Number>,
    max: Option<Number>,
    unit: &str,
) -> Result<()> {
    match (min, max) {
        (Some(Number(min)), Some(Number(max))) if min >= max => {
            let message = format!("`min` is less than `max`, not {min} {unit} and {max} {unit}");
            Err(wrong(place, &message))
        }
        _ => Ok(()),
    }
}

/// Every linear axis comes once.
fn check_approach(file: &SheetFile, order: Spanned<Vec<String>>) -> Result<Vec<String>> {
    let mut letters: Vec<char> = order.get_ref().concat().chars().collect();
    letters.sort_unstable();
    if letters != ['X', 'Y', 'Z'] || order.get_ref().iter().any(String::is_empty) {
        let message = "X, Y and Z come once each, such as [\"XY\", \"Z\"]";
        return Err(file.at("approach", &order, message).into());
    }
    Ok(order.into_inner())
}

fn check_rotary(
    file: &SheetFile,
    axes: Spanned<Vec<Spanned<RotarySheet>>>,
) -> Result<Placed<Vec<RotaryAxis>>> {
    let place = file.at("rotary", &axes, "");
    let mut checked: Vec<RotaryAxis> = Vec::new();
    for spanned in axes.into_inner() {
        let sheet = spanned.get_ref();
        let what = sheet.letter.map_or("rotary".into(), |letter| format!("rotary {letter}"));
        let fail = |message: &str| Box::new(file.at(&what, &spanned, message));
        let missing = |key: &str| fail(&format!("`{key}` is missing"));
        let letter = sheet.letter.ok_or_else(|| missing("letter"))?;
        if !matches!(letter, 'A' | 'B' | 'C') {
            return Err(fail("`letter` is one of A, B, C"));
        }
        if checked.iter().any(|axis| axis.letter == letter) {
            return Err(fail("this letter is taken by another rotary axis"));
        }
        if checked.len() == 2 {
            return Err(fail("more than two rotary axes cannot be driven"));
        }
        let axis = sheet.axis.ok_or_else(|| missing("axis"))?.0;
        let axis = direction(Vec3::from_array(axis))
            .ok_or_else(|| fail("`axis` has no direction: give a vector of some length"))?;
        let sign = sheet.sign.unwrap_or(1.0);
        if sign.abs() != 1.0 {
            return Err(fail("`sign` is 1 or -1"));
        }
        let min = sheet.min.map_or(f64::NEG_INFINITY, |min| min.0);
        let max = sheet.max.map_or(f64::INFINITY, |max| max.0);
        check_range(
            &file.at(&what, &spanned, ""),
            Some(Number(min)),
            Some(Number(max)),
            "degrees",
        )?;
        checked.push(RotaryAxis {
            letter,
            on: sheet.on.ok_or_else(|| missing("on"))?,
            axis,
            point: sheet.point.map_or(Vec3::ZERO, |point| Vec3::from_array(point.0)),
            sign,
            offset: sheet.offset.map_or(0.0, |offset| offset.0),
            min,
            max,
            rapid: sheet.rapid.ok_or_else(|| missing("rapid"))?.0,
            acceleration: sheet.acceleration.ok_or_else(|| missing("acceleration"))?.0,
            prefer: sheet.prefer.map_or(0.0, |prefer| prefer.0),
        });
    }
    Ok(Placed { sheet: checked, place })
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
            words: overlay(self.words, nearer.words, |farther, nearer| {
                (farther.0.under(nearer.0), nearer.1)
            }),
            blocks: overlay(self.blocks, nearer.blocks, |_, nearer| nearer),
            axes: overlay(self.axes, nearer.axes, |farther, nearer| {
                farther.under(nearer, LinearSheet::under)
            }),
            rotary: nearer.rotary.or(self.rotary),
            work_zero: nearer.work_zero.or(self.work_zero),
            orientation: joined(self.orientation, nearer.orientation, OrientationSheet::under),
            wire: joined(self.wire, nearer.wire, WireSheet::under),
            spindle: joined(self.spindle, nearer.spindle, SpindleSheet::under),
            feed_max: nearer.feed_max.or(self.feed_max),
            tools: self.tools.under(nearer.tools),
            auxiliary: nearer.auxiliary.or(self.auxiliary),
            operator_parameters: nearer.operator_parameters.or(self.operator_parameters),
            approach: nearer.approach.or(self.approach),
            options: overlay(self.options, nearer.options, |_, nearer| nearer),
        }
    }

    fn finish(
        mut self,
        name: String,
        file: String,
        control: String,
        missing: &dyn Fn(&str) -> Box<Diagnostic>,
    ) -> Result<Machine> {
        let mut linear = [LinearAxis::default(); 3];
        for (axis, name) in linear.iter_mut().zip([LinearName::X, LinearName::Y, LinearName::Z]) {
            if let Some(Placed { sheet, place }) = self.axes.remove(&name) {
                check_range(&place, sheet.min, sheet.max, "mm")?;
                *axis = finish_linear(&sheet);
            }
        }
        let (mut spindle, mut orientation) = (SpindleSheet::default(), OrientationSheet::default());
        if let Some(Placed { sheet, place }) = self.spindle {
            check_range(&place, sheet.min, sheet.max, "1/min")?;
            spindle = sheet;
        }
        let mut rotary = Vec::new();
        if let Some(Placed { sheet, place }) = self.rotary {
            let modes = self.orientation.as_ref().and_then(|o| o.sheet.simultaneous);
            if matches!(modes, None | Some(OrientationMode::Fixed)) && !sheet.is_empty() {
                let message = "`orientation.simultaneous` does not say how their positions are \
                               written: machine-angles, tool-center-angles or vectors";
                return Err(wrong(&place, message));
            }
            rotary = sheet;
        }
        if let Some(Placed { sheet, place }) = self.orientation {
            let modes = [sheet.simultaneous, sheet.positioned];
            let turns = |mode: &OrientationMode| *mode != OrientationMode::Fixed;
            if rotary.is_empty() && modes.iter().flatten().any(turns) {
                return Err(wrong(&place, "there are no [[rotary]] axes to turn the tool with"));
            }
            orientation = sheet;
        }
        if let Some(Placed { place, .. }) = self.wire.as_ref().filter(|_| !rotary.is_empty()) {
            return Err(wrong(
                place,
                "a wire leans by U and V: there are no [[rotary]] axes beside",
            ));
        }
        let simultaneous = orientation.simultaneous.unwrap_or(OrientationMode::Fixed);
        let positioned = orientation.positioned.unwrap_or(simultaneous);
        let capabilities = self.capabilities;
        let format = self.format;
        let (reader, reader_place) =
            self.reader.ok_or_else(|| missing("`reader`, the virtual control,"))?;
        Ok(Machine {
            title: self.title.unwrap_or_else(|| name.clone()),
            name,
            file,
            control,
            reader,
            reader_place,
            extension: self.extension.unwrap_or_else(|| "nc".into()),
            capabilities: Capabilities {
                arcs: capabilities.arcs.unwrap_or_default(),
                helix: capabilities.helix.unwrap_or(false),
                full_circle: capabilities.full_circle.unwrap_or(false),
                arc_tolerance: capabilities.arc_tolerance.map_or(0.001, |mm| mm.0),
                cycles: capabilities.cycles.unwrap_or_default(),
                compensation: capabilities.compensation.unwrap_or(false),
                feed_per_turn: capabilities.feed_per_turn.unwrap_or(false),
                inverse_time: capabilities.inverse_time.unwrap_or(false),
                length_offset: capabilities.length_offset.unwrap_or(LengthOffset::Implicit),
                line_length: capabilities.line_length.unwrap_or(256),
                lowering_tolerance: capabilities.lowering_tolerance.map_or(0.005, |mm| mm.0),
            },
            format: Format {
                separator: format.separator.unwrap_or_else(|| " ".into()),
                line_end: format.line_end.unwrap_or_else(|| "\n".into()),
                comment_start: format.comment_start.unwrap_or_else(|| "(".into()),
                comment_end: format.comment_end.unwrap_or_else(|| ")".into()),
                fresh_operations: format.fresh_operations.unwrap_or(false),
            },
            words: self.words.into_iter().map(|(name, word)| finish_word(name, word)).collect(),
            blocks: self.blocks,
            linear,
            rotary,
            work_zero: self.work_zero.map(|point| Vec3::from_array(point.0)),
            orientation: OrientationSettings {
                simultaneous,
                positioned,
                tolerance: orientation.tolerance.map_or(0.005, |mm| mm.0),
            },
            wire: self.wire.map(|wire| finish_wire(&wire.sheet)),
            spindle: SpindleRange {
                min: spindle.min.map_or(0.0, |speed| speed.0),
                max: spindle.max.map_or(f64::INFINITY, |speed| speed.0),
            },
            feed_max: self.feed_max.map_or(f64::INFINITY, |feed| feed.0),
            tools: ToolRange {
                max_number: self.tools.max_number.unwrap_or(u32::MAX),
                max_diameter: self.tools.max_diameter.map_or(f64::INFINITY, |mm| mm.0),
                max_length: self.tools.max_length.map_or(f64::INFINITY, |mm| mm.0),
            },
            auxiliary: self.auxiliary.unwrap_or_default(),
            operator_parameters: (self.operator_parameters.into_iter().flatten())
                .map(|parameter| parameter.0)
                .collect(),
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

fn finish_linear(sheet: &LinearSheet) -> LinearAxis {
    let default = LinearAxis::default();
    LinearAxis {
        min: sheet.min.map_or(default.min, |mm| mm.0),
        max: sheet.max.map_or(default.max, |mm| mm.0),
        rapid: sheet.rapid.map_or(default.rapid, |rate| rate.0),
        acceleration: sheet.acceleration.map_or(default.acceleration, |rate| rate.0),
    }
}

fn finish_wire(sheet: &WireSheet) -> Wire {
    Wire {
        height: sheet.height.map(|mm| mm.0),
        uv_travel: sheet.uv_travel.map_or(f64::INFINITY, |mm| mm.0),
        taper_max: sheet.taper_max.map_or(90.0, |degrees| degrees.0),
        thread: sheet.thread,
        cut: sheet.cut,
        memory: sheet.memory.map(|points| points as usize),
    }
}

fn finish_word(name: String, (sheet, place): (WordSheet, Place)) -> (String, Word) {
    let word = Word {
        address: sheet.address.unwrap_or_else(|| name.clone()),
        suffix: sheet.suffix.unwrap_or_default(),
        decimals: sheet.decimals.map_or(3, |decimals| decimals.0),
        trim: sheet.trim.unwrap_or(false),
        point: sheet.point.unwrap_or(false),
        plus: sheet.plus.unwrap_or(false),
        digits: sheet.digits.unwrap_or(1),
        modal: sheet.modal.unwrap_or(false),
        exact: sheet.exact.unwrap_or(false),
        step: sheet.step.unwrap_or(10),
        first: sheet.first.or(sheet.step).unwrap_or(10),
        scale: sheet.scale.map_or(1.0, |scale| scale.0),
        max: sheet.max.map_or(f64::INFINITY, |max| max.0),
        codes: sheet.codes.unwrap_or_default(),
        place,
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
        assert!(rotary("axis = [0, 0, 0]").contains("rotary A: `axis` has no direction"));
        assert!(rotary("axis = [1, 0, 0]\nsign = 2").contains("`sign` is 1 or -1"));
        assert!(rotary("axis = [1, 0, 0]\nmin = 5\nmax = 5").contains("`min` is less than `max`"));
        assert!(refusal("reader = \"g\"\n[words.X]\ndecimals = 12").contains(":3:12:"));
        let travel = refusal("reader = \"g\"\n[axes.X]\nmin = 3\nmax = 3");
        assert!(travel.starts_with("mill.toml:2:1: "), "{travel}");
        assert!(travel.contains("axes.X: `min` is less than `max`, not 3 mm and 3 mm"), "{travel}");
        let refused = |text, place, what| {
            let shown = refusal(text);
            assert!(shown.starts_with(&format!("mill.toml:{place}: ")), "{shown}");
            assert!(shown.contains(what), "{shown}");
        };
        refused("[axes]\nX = { min = 100, max = -100 }", "2:5", "axes.X: `min` is less than `max`");
        refused("[axes]\nY = { rapid = 0 }", "2:15", "a number above 0 is needed");
        refused("[spindle]\nmin = 9\nmax = 1", "1:1", "spindle: `min`");
        refused("approach = [\"XY\"]", "1:12", "approach: X, Y and Z come once each");
        refused("[tools]\nmax_length = -1", "2:14", "a number above 0 is needed");
        refused("work_zero = [0, nan, 0]", "1:13", "three finite numbers");
        assert!(refusal("title = \"no reader\"").contains("`reader`"));
    }

    #[test]
    fn orientation_needs_rotary_axes_and_the_other_way_round() {
        let shown = refusal("reader = \"g\"\n[orientation]\nsimultaneous = \"vectors\"");
        assert!(shown.starts_with("mill.toml:2:1: ") && shown.contains("[[rotary]]"), "{shown}");
        let axis = "letter = \"A\"\non = \"head\"\naxis = [1, 0, 0]\nrapid = 1\nacceleration = 1";
        let shown = refusal(&format!("reader = \"g\"\n[[rotary]]\n{axis}"));
        assert!(shown.starts_with("mill.toml:2:"), "{shown}");
        assert!(shown.contains("`orientation.simultaneous`"), "{shown}");
    }

    #[test]
    fn a_wire_leans_by_u_and_v_and_by_no_rotary_axis() {
        let wire = load_text("w.toml", "reader = \"g\"\n[wire]\nmemory = 900\n").unwrap().wire;
        let unlimited = Wire {
            height: None,
            uv_travel: f64::INFINITY,
            taper_max: 90.0,
            thread: None,
            cut: None,
            memory: Some(900),
        };
        assert_eq!(wire, Some(unlimited));
        let axis = "letter = \"A\"\non = \"head\"\naxis = [1, 0, 0]\nrapid = 1\nacceleration = 1";
        let modes = "[orientation]\nsimultaneous = \"vectors\"";
        let shown = refusal(&format!("reader = \"g\"\n[wire]\n{modes}\n[[rotary]]\n{axis}"));
        assert!(shown.starts_with("mill.toml:2:1: ") && shown.contains("U and V"), "{shown}");
    }

    #[test]
    fn what_two_files_make_wrong_together_is_told_in_the_nearer_one() {
        let folder = std::env::temp_dir().join(format!("toolpost-both-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("base.toml"), MILL).unwrap();
        let file = folder.join("mine.toml");
        std::fs::write(&file, "extends = \"base.toml\"\n\n[axes.X]\nmax = -1\n").unwrap();
        let shown = load(file.to_str().unwrap()).unwrap_err().to_string();
        assert!(
            shown.contains("mine.toml:3:1: ") && shown.contains("not 0 mm and -1 mm"),
            "{shown}"
        );
        std::fs::remove_dir_all(&folder).unwrap();
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
