//! Options of `toolpost pcb` in a file: `toolpost.toml` beside the board, or a millproject of pcb2gcode. They become words of the command
//! line, in front of those that are typed.

use crate::args::CommandLine;
use app::pcb::SETTINGS;
use app::{Source, Stop};
use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches, CommandFactory, Parser};
use import::{Stated, import_millproject};
use program::{Diagnostic, Rule, nearest};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// A command line with the options of a file in it.
#[derive(Default)]
pub struct Expanded {
    /// Its words.
    pub words: Vec<OsString>,
    /// Those of them that stand in the file.
    pub stated: Vec<String>,
    /// What was found in the file.
    pub found: Vec<Diagnostic>,
    /// Where its options stand.
    pub origins: Vec<Origin>,
}

/// Where an option that is not typed stands.
#[derive(Clone, Debug)]
pub struct Origin {
    /// As it is typed, without the dashes in front.
    option: String,
    /// File, line from 1, and the line itself.
    file: String,
    line: u32,
    text: String,
}

/// The same with the places of what begins with the name of an option that a settings file states.
pub fn placed(stop: Stop, origins: &[Origin]) -> Stop {
    let placed = |found: Diagnostic| {
        let name = found.message.strip_prefix('`').and_then(|rest| rest.split('`').next());
        let name = name.map(|name| name.replace('_', "-"));
        let origin = origins.iter().find(|origin| Some(&origin.option) == name.as_ref());
        match origin.filter(|_| found.file.is_empty()) {
            Some(Origin { file, line, text, .. }) => {
                found.file(file).at(*line, text.as_bytes(), 0, text.len())
            }
            None => found,
        }
    };
    Stop { findings: stop.findings.into_iter().map(placed).collect(), ..stop }
}

/// Options that are files or folders: one in a file lies where that file does.
const FILES: [&str; 7] = ["front", "back", "outline", "drill", "heights", "output", "machine"];

/// Options of which one that is typed leaves those of a file no meaning.
const EITHER: [&[&str]; 3] =
    [&["tool", "vee", "tip"], &["corner", "as-drawn"], &["passes", "isolation-width"]];

/// Options that no file states.
const TYPED: [&str; 4] = ["settings", "json", "quiet", "help"];

/// Options that do not say what programs do.
const ELSEWHERE: [&str; 9] =
    ["settings", "json", "quiet", "help", "output", "machine", "picture", "strict", "option"];

/// The command line with what a settings file says, which `--settings` names, or which lies beside the board.
///
/// # Errors
/// What is wrong with the file.
pub fn expanded(words: Vec<OsString>) -> Result<Expanded, Stop> {
    let as_typed = |words| Ok(Expanded { words, ..Expanded::default() });
    let Some(typed) = of_board(&words) else { return as_typed(words) };
    let Some(file) = file(&typed) else {
        let found = lies_beside(&typed, SETTINGS[1]).map(|file| unused(&file));
        let found = found.into_iter().collect();
        return Ok(Expanded { words, found, ..Expanded::default() });
    };
    with(words, &Source::File(file))
}

/// What is typed after `pcb`, where that is the command.
fn of_board(words: &[OsString]) -> Option<ArgMatches> {
    let command = CommandLine::command().ignore_errors(true);
    let (name, typed) = command.try_get_matches_from(words).ok()?.remove_subcommand()?;
    (name == "pcb").then_some(typed)
}

/// The command line of a board with what this file says; files that it names lie where it does.
///
/// # Errors
/// What is wrong with the file.
pub fn with(words: Vec<OsString>, file: &Source) -> Result<Expanded, Stop> {
    let text = file.text()?;
    let file = file.path();
    let typed = of_board(&words).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let is_toml = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    let name = file.display().to_string();
    let (stated, found) = match is_toml {
        true => (of_toml(&text).map_err(|found| (*found).file(&name))?, Vec::new()),
        false => import_millproject(&text).map_err(|found| (*found).file(&name))?,
    };
    let found = found.into_iter().map(|found: Diagnostic| found.file(&name)).collect();
    let more = spelled(&stated, &typed, file).map_err(|found| {
        Stop::invalid(found.into_iter().map(|found| found.file(&name)).collect())
    })?;
    let mut all = words;
    let behind = all.iter().position(|word| word == "pcb").map_or(all.len(), |command| command + 1);
    all.splice(behind..behind, more.iter().map(OsString::from));
    let line_of = |line: u32| text.lines().nth((line as usize).wrapping_sub(1));
    let origin = |Stated { name, line, .. }: Stated| {
        let text = line_of(line)?.to_owned();
        Some(Origin { option: name, file: file.display().to_string(), line, text })
    };
    let origins = stated.into_iter().filter_map(origin).collect();
    Ok(Expanded { words: all, stated: more, found, origins })
}

/// The options of a command line as they are typed, each with its value in one word, for a later proof: without those that say
/// where programs go and how they are shown.
pub fn options(words: &[OsString]) -> Vec<String> {
    let command = CommandLine::command().ignore_errors(true);
    let Ok(matches) = command.try_get_matches_from(words) else { return Vec::new() };
    let Some(("pcb", typed)) = matches.subcommand() else { return Vec::new() };
    let command = CommandLine::command();
    let pcb = command.find_subcommand("pcb");
    let mut options = Vec::new();
    for option in pcb.into_iter().flat_map(|pcb| pcb.get_arguments()) {
        let Some(name) = option.get_long().filter(|name| !ELSEWHERE.contains(name)) else {
            continue;
        };
        let id = option.get_id().as_str();
        if typed.value_source(id) != Some(ValueSource::CommandLine) {
            continue;
        }
        match option.get_action() {
            ArgAction::SetTrue => options.push(format!("--{name}")),
            _ => {
                let values = typed.get_raw(id).into_iter().flatten();
                let value =
                    |value: &std::ffi::OsStr| format!("--{name}={}", value.to_string_lossy());
                options.extend(values.map(value));
            }
        }
    }
    options
}

/// The settings file that is meant.
fn file(typed: &ArgMatches) -> Option<PathBuf> {
    if let Ok(Some(named)) = typed.try_get_one::<PathBuf>("settings") {
        return Some(named.clone());
    }
    lies_beside(typed, SETTINGS[0])
}

/// The file of that name beside the board, where there is one.
fn lies_beside(typed: &ArgMatches, name: &str) -> Option<PathBuf> {
    let board = typed.try_get_many::<PathBuf>("board").ok()??.next()?;
    let folder = if board.is_dir() { board } else { board.parent().unwrap_or(Path::new("")) };
    Some(folder.join(name)).filter(|file| file.is_file())
}

/// A millproject is of another program and perhaps of another machine: nobody has asked for it.
pub fn unused(file: &Path) -> Diagnostic {
    let message = "the options of pcb2gcode beside the board are not used";
    let help = format!("take them by `--settings {}`", file.display());
    Diagnostic::warning(Rule::FileUnused, message).help(help).file(file.display().to_string())
}

/// The options that a TOML file states.
fn of_toml(text: &str) -> Result<Vec<Stated>, Box<Diagnostic>> {
    let line = |at: usize| 1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count() as u32;
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(1, |span| line(span.start));
        Diagnostic::error(Rule::SettingsKey, error.message().trim_end()).line(at)
    })?;
    let mut stated = Vec::new();
    for (key, value) in table.get_ref() {
        let raw =
            |span: std::ops::Range<usize>| text.get(span).unwrap_or_default().replace('_', "");
        let one = |value: &DeValue, span| match value {
            DeValue::String(text) => Some(text.to_string()),
            DeValue::Integer(_) | DeValue::Float(_) => Some(raw(span)),
            _ => None,
        };
        let line = line(key.span().start);
        let values = match value.get_ref() {
            DeValue::Boolean(false) => continue,
            DeValue::Boolean(true) => Some(Vec::new()),
            DeValue::Array(all) => all.iter().map(|v| one(v.get_ref(), v.span())).collect(),
            value_of => one(value_of, value.span()).map(|value| vec![value]),
        };
        let Some(values) = values else {
            let message =
                format!("`{}` is no text, number, true, false or list of them", key.get_ref());
            let help =
                "write it as it is typed: `passes = 2`, `drills = [0.8, 1]`, `strict = true`";
            return Err(Diagnostic::error(Rule::SettingsKey, message).help(help).line(line).into());
        };
        stated.push(Stated { name: key.get_ref().replace('_', "-"), values, line });
    }
    stated.sort_by_key(|stated| stated.line);
    Ok(stated)
}

/// Options as they are typed, without those that are typed already.
///
/// # Errors
/// Each that is no option of the command, or has no value of its own.
fn spelled(
    stated: &[Stated],
    typed: &ArgMatches,
    file: &Path,
) -> Result<Vec<String>, Vec<Diagnostic>> {
    let command = CommandLine::command();
    let pcb = command.find_subcommand("pcb");
    let options: Vec<_> = pcb.into_iter().flat_map(|pcb| pcb.get_arguments()).collect();
    let named = || options.iter().filter_map(|option| option.get_long());
    let named = || named().filter(|name| !TYPED.contains(name));
    let is_typed = |name: &str| {
        let id = name.replace('-', "_");
        typed.try_contains_id(&id).is_ok()
            && typed.value_source(&id) == Some(ValueSource::CommandLine)
    };
    let (mut words, mut errors) = (Vec::new(), Vec::new());
    for Stated { name, values, line } in stated {
        let Some(option) = options
            .iter()
            .find(|option| option.get_long() == Some(name) && !TYPED.contains(&name.as_str()))
        else {
            let near = nearest(name, named());
            let help = match near.is_empty() {
                true => String::from("`toolpost pcb --help` lists all options"),
                false => format!("did you mean {near}?"),
            };
            let message = format!("`{name}` is no option of `toolpost pcb`");
            errors.push(Diagnostic::error(Rule::SettingsKey, message).help(help).line(*line));
            continue;
        };
        let either = EITHER.iter().find(|names| names.contains(&name.as_str()));
        let one_of = either.copied().unwrap_or_default();
        if is_typed(name) || one_of.iter().any(|other| is_typed(other)) {
            continue;
        }
        let own = |value: &String| match FILES.contains(&name.as_str()) {
            true => beside(file, name, value),
            false => value.clone(),
        };
        let values: Vec<String> = values.iter().map(own).collect();
        let spelled: Vec<String> = match option.get_action() {
            ArgAction::Append => values.iter().map(|value| format!("--{name}={value}")).collect(),
            _ if values.is_empty() => vec![format!("--{name}")],
            _ => vec![format!("--{name}={}", values.join(","))],
        };
        // By itself, so that what is wrong has its line.
        let required = ["toolpost", "pcb", "board", "--machine=m", "--output=o"];
        let is_required = |word: &&&str| !word.starts_with(&format!("--{name}="));
        let alone = required.iter().filter(is_required).map(|word| (*word).to_owned());
        if let Err(usage) = CommandLine::try_parse_from(alone.chain(spelled.iter().cloned())) {
            let usage = usage.to_string();
            let message = usage.lines().next().unwrap_or_default().trim_start_matches("error: ");
            let help = "write it as it is typed behind the option";
            errors.push(Diagnostic::error(Rule::SettingsKey, message).help(help).line(*line));
            continue;
        }
        words.extend(spelled);
    }
    if errors.is_empty() { Ok(words) } else { Err(errors) }
}

/// A file or folder that a settings file names: beside it; a machine of the library has no folder.
fn beside(file: &Path, name: &str, value: &str) -> String {
    if name == "machine" && !value.ends_with(".toml") {
        return value.to_owned();
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    folder.join(value).display().to_string()
}
