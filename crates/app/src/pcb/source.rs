//! Which board is meant: a folder of files, some files, a board of KiCad, or a model.

use crate::account::Stop;
use crate::files;
use crate::input;
use pcb::board::{Artwork, File, Layer};
use pcb::model::LONGEST;
use pcb::plan::{self, Settings};
use pcb::{Drawn, LayerFile};
use program::{Diagnostic, Rule};
use serde_json::{Map, Value};
use std::path::Path;

/// The most files of a folder that are looked at.
const MOST_FILES: usize = 1000;

/// A board as it was read.
pub struct Source {
    /// The board, with copper that is still to be united.
    pub artwork: Artwork,
    /// Its files, and what each holds.
    pub layers: Vec<(String, String)>,
    /// The files that were read.
    pub files: Vec<input::Source>,
    /// Which of them draws what.
    pub kind: Kind,
}

/// How the files of a board draw it.
pub enum Kind {
    /// One file of KiCad has all of it.
    Kicad,
    /// One file says by which rules it is made: it draws nothing itself.
    Model,
    /// Files of layers, each by its place among all.
    Layers(Vec<(usize, Layer)>),
}

/// What the files of a board draw, each element with its line; nothing of files that have been changed since they were read, or of a
/// model.
pub fn drawn(files: &[input::Source], kind: &Kind, settings: &Settings) -> Drawn {
    let text = |place: usize| Some((files.get(place)?.name(), files.get(place)?.text().ok()?));
    let drawn = match kind {
        Kind::Model => None,
        Kind::Kicad => text(0).map(|(name, text)| Drawn::of_kicad(&name, &text)),
        Kind::Layers(layers) => {
            let layer = |place: usize| layers.iter().find(|(of, _)| *of == place);
            let texts = (0..files.len()).map(|place| Some((layer(place)?.1, text(place)?)));
            let texts: Vec<_> = texts.collect();
            let unit = settings.unit;
            let layers = texts.iter().map(|read| {
                let (layer, (name, text)) = read.as_ref()?;
                Some(LayerFile { name, layer: *layer, unit, text })
            });
            Some(Drawn::of_layers(&layers.collect::<Vec<_>>()))
        }
    };
    drawn.and_then(Result::ok).unwrap_or_default()
}

/// Reads the board that `given` is (all that is in a folder of the name `folder`, where there is one), and the files `named` of which
/// the caller says what they hold, with the layers that programs need for which `settings` ask.
///
/// # Errors
/// What is wrong with a file, or with all of them together.
pub fn read(
    given: &[input::Source],
    named: &[(input::Source, Layer)],
    folder: Option<&str>,
    settings: &Settings,
) -> Result<Source, Stop> {
    let first = named.first().map(|(file, _)| file.clone());
    let name = folder.map_or_else(|| name(given.first().or(first.as_ref())), str::to_owned);
    let mut files = match (given, folder) {
        (files, Some(folder)) => {
            let files = files.iter().filter(|file| may_be_of_board(&file.name())).cloned();
            chosen(&[], counted(files.collect(), folder)?)?
        }
        ([input::Source::File(folder)], None) if folder.is_dir() => chosen(given, within(folder)?)?,
        (files, None) => chosen(given, files.to_vec())?,
    };
    files.retain(|file| named.iter().all(|(other, _)| !is_same(other, file)));
    if let Some(board) =
        files.iter().find(|file| ending(file) == "kicad_pcb").filter(|_| !named.is_empty())
    {
        return Err(not_alone(board));
    }
    let unnamed = files.len();
    files.extend(named.iter().map(|(file, _)| file.clone()));
    let mut texts = Vec::with_capacity(files.len());
    for file in &files {
        texts.push((file.name(), file.text()?));
    }
    let (artwork, layers, kind) = match (&texts[..], files.first().map(ending)) {
        ([(file, text)], Some(kind)) if kind == "kicad_pcb" => {
            let artwork = pcb::kicad::artwork(file, text).map_err(Stop::invalid)?;
            (artwork, vec![(file.clone(), String::from("a board of KiCad"))], Kind::Kicad)
        }
        ([(file, text)], Some(kind)) if MODEL.contains(&kind.as_str()) => {
            let artwork = pcb::model::artwork(file, text).map_err(Stop::invalid)?;
            (artwork, vec![(file.clone(), String::from("a model"))], Kind::Model)
        }
        _ => {
            let layer = |i: usize| Some(named.get(i.checked_sub(unnamed)?)?.1);
            let all = texts.iter().enumerate();
            let unit = settings.unit;
            let all: Vec<File> =
                all.map(|(i, (name, text))| File { name, layer: layer(i), unit, text }).collect();
            let wanted = |layer| plan::needs(layer, settings);
            let (artwork, layers) =
                pcb::board::artwork(&name, &all, wanted).map_err(Stop::invalid)?;
            let place = |name: &str| texts.iter().position(|(of, _)| of == name);
            let places = layers.iter().filter_map(|(name, layer)| Some((place(name)?, *layer)));
            let kind = Kind::Layers(places.collect());
            let named = |(name, layer): (String, Layer)| (name, layer.to_string());
            (artwork, layers.into_iter().map(named).collect(), kind)
        }
    };
    let asked = &settings.outline;
    let mut artwork =
        artwork.outlined(asked.close_gaps, asked.board_margin).map_err(Stop::invalid)?;
    if asked.rectangular {
        let margin = asked.board_margin.unwrap_or(0.0);
        artwork = artwork.rectangular(margin).map_err(Stop::invalid)?;
    }
    Ok(Source { artwork, layers, files, kind })
}

/// Whether two are one file: bytes in memory by their name.
fn is_same(a: &input::Source, b: &input::Source) -> bool {
    match (a.file(), b.file()) {
        (Some(a), Some(b)) => match (std::fs::canonicalize(a), std::fs::canonicalize(b)) {
            (Ok(a), Ok(b)) => a == b,
            _ => a == b,
        },
        (None, None) => a.path() == b.path(),
        _ => false,
    }
}

/// Endings that plots of layers have mostly: where such files are in the same folder, a KiCad board is not read.
const PLOTS: [&str; 9] = ["gbr", "ger", "gtl", "gbl", "cmp", "sol", "top", "bot", "drl"];

/// What the names of copies begin with that KiCad makes while a board is edited.
const COPY: &str = "_autosave-";

/// Files of settings that lie beside a board.
pub const SETTINGS: [&str; 2] = ["toolpost.toml", "millproject"];

/// Endings of boards as models.
const MODEL: [&str; 2] = ["toml", "json"];

fn ending(file: &input::Source) -> String {
    files::ending(file.path())
}

/// The files that are read: those of layers, or one that is a board by itself.
fn chosen(named: &[input::Source], given: Vec<input::Source>) -> Result<Vec<input::Source>, Stop> {
    let is_whole = |file: &&input::Source| {
        let ending = ending(file);
        ending == "kicad_pcb" || given.len() == 1 && MODEL.contains(&ending.as_str())
    };
    let is_named = |file: &&&input::Source| named.iter().any(|named| named.path() == file.path());
    let wholes: Vec<&input::Source> = given.iter().filter(is_whole).collect();
    match &wholes[..] {
        [] => Ok(given),
        [one] if given.len() == 1 => Ok(vec![(*one).clone()]),
        _ if wholes.iter().any(|file| is_named(&file)) => Err(not_alone(wholes[0])),
        // A folder of KiCad's has a board and its plots, or the board alone.
        _ if given.iter().any(|file| PLOTS.contains(&ending(file).as_str())) => Ok(given),
        [one] => Ok(vec![(*one).clone()]),
        _ => {
            let names: Vec<String> = wholes.iter().map(|file| file.name()).collect();
            let message = format!("there are several boards in this folder: {}", names.join(", "));
            let found = Diagnostic::error(Rule::Board, message).help("give the file of the one");
            Err(found.into())
        }
    }
}

/// What the board is called.
fn name(first: Option<&input::Source>) -> String {
    let named = |source: &input::Source| match source.file().filter(|path| path.is_dir()) {
        Some(path) => files::name(&std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())),
        None => source.path().file_stem().unwrap_or_default().to_string_lossy().into_owned(),
    };
    first.map_or_else(String::new, named)
}

/// The files of a folder, in the order of their names.
fn within(folder: &Path) -> Result<Vec<input::Source>, Stop> {
    let about = |message: String| {
        Diagnostic::error(Rule::Folder, message).file(folder.display().to_string())
    };
    let entries = std::fs::read_dir(folder)
        .map_err(|error| about(format!("the folder cannot be read: {error}")))?;
    let mut files = Vec::new();
    for entry in entries.take(MOST_FILES + 1) {
        let path =
            entry.map_err(|error| about(format!("the folder cannot be read: {error}")))?.path();
        let name = files::name(&path);
        if path.is_file() && may_be_of_board(&name) {
            files.push(path);
        }
    }
    files.sort();
    let files = files.into_iter().map(input::Source::File).collect();
    counted(files, &folder.display().to_string())
}

/// Whether a file of a folder may be one of a board, by its name.
fn may_be_of_board(name: &str) -> bool {
    !name.starts_with(COPY) && !SETTINGS.contains(&name)
}

/// # Errors
/// There are no files in the folder, or too many.
fn counted(files: Vec<input::Source>, folder: &str) -> Result<Vec<input::Source>, Stop> {
    let message = match files.len() {
        0 => String::from("there is no file in this folder"),
        1..=MOST_FILES => return Ok(files),
        _ => format!("there are more than {MOST_FILES} files in this folder"),
    };
    let help = "give the folder of the Gerber and Excellon files of one board";
    Err(Diagnostic::error(Rule::Folder, message).help(help).file(folder).into())
}

/// Whether a file is a board, or a part of one: what it holds is not looked at but in JSON, which toolpaths are written in too.
pub fn is_board(file: &input::Source) -> bool {
    is_named_board(file.path()).unwrap_or_else(|| {
        let text = file.text().unwrap_or_default();
        let text = &text[..text.len().min(LONGEST)];
        let keys = serde_json::from_slice::<Map<String, Value>>(text).unwrap_or_default();
        IN_MODELS.iter().any(|key| keys.contains_key(*key))
    })
}

/// The same by the name of a file alone; `None` where that does not say it.
pub fn is_named_board(path: &Path) -> Option<bool> {
    match files::ending(path).as_str() {
        "json" => None,
        "kicad_pcb" => Some(true),
        ending => Some(MODEL.contains(&ending) || PLOTS.contains(&ending)),
    }
}

/// Keys that a board as a model has and a job of FreeCAD has not.
const IN_MODELS: [&str; 5] = ["nodes", "tracks", "pads", "edges", "groups"];

fn not_alone(board: &input::Source) -> Stop {
    let message = "it is a whole board, and other files are given with it";
    Diagnostic::error(Rule::Board, message)
        .help("give it alone, or the Gerber and Excellon files alone")
        .file(board.name())
        .into()
}
