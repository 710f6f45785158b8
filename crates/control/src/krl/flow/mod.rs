//! Through a file: the program that it begins with, those behind it, and those of other files that are called.

use super::execution::State;
use super::language::{Name, Scan, Statement, Target, function_name, of_kuka, read};
use crate::event::Action;
use crate::kernel::Channel;
use crate::kernel::flow::{BlockLocation, line, lines};
use crate::kernel::source::Source;
use crate::{ArmAction, Settings};
use program::{Diagnostic, Outcome, Rule};
use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::Path;

/// Most calls within calls (KSS: 20 levels).
const DEEPEST: usize = 20;

/// A file.
struct File<'t> {
    text: &'t [u8],
    /// Its name; none of the file that is run.
    name: Option<Box<str>>,
    /// Where its programs begin: behind their `DEF`.
    programs: HashMap<Name, BlockLocation>,
    first: Option<(Name, BlockLocation)>,
}

/// Runs a program.
pub(super) fn run(
    settings: &Settings,
    (file_name, text): (&str, &[u8]),
    channel: &mut Channel,
) -> Outcome {
    let file = File::of(text, None)?;
    let Some((name, at)) = file.first else {
        let message = "the file has no program: it begins with DEF name ( )";
        return Err(Diagnostic::error(Rule::ProgramFrame, message).line(1).into());
    };
    is_called_as((name, at.line - 1), file_name)?;
    hides_none_of_kuka(settings)?;
    let mut run = Run { settings, state: State::new(&settings.tool_change), channel };
    run.data(name)?;
    let end = run.routine(&file, at, 0)?;
    run.channel.report(end, Action::End)
}

/// The name that a program has to have in a file that a controller takes; none of other files.
fn name_in(file_name: &str) -> Option<&str> {
    let path = Path::new(file_name);
    let is_source = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("src"));
    is_source.then(|| path.file_stem().and_then(OsStr::to_str).unwrap_or_default())
}

/// # Errors
/// No program has the name of a file that is called so.
pub(super) fn check_file_name(file_name: &str) -> Outcome {
    let Some(stem) = name_in(file_name) else { return Ok(()) };
    let text = format!("DEF {stem} ( )");
    let defined = read(&mut Scan::new(Source { line: 1, text: text.as_bytes() }), &State::new(""));
    let why = match defined {
        Ok(Statement::Define(name)) if stem.eq_ignore_ascii_case(name.as_str()) => return Ok(()),
        Err(found) if found.rule == Rule::ProgramFrame => found.message,
        Ok(_) | Err(_) => format!("`{stem}` is none"),
    };
    let message = format!("a KUKA finds a program by the name of its file: {why}");
    let help = "give the file a name of up to 24 letters, digits and _, a letter first, that neither the language nor KUKA's software has, by \
                `post --output`";
    Err(Diagnostic::error(Rule::ProgramFrame, message).help(help).into())
}

/// # Errors
/// A file that a controller takes has another name than its first program.
fn is_called_as((name, line): (Name, u32), file_name: &str) -> Outcome {
    let Some(stem) = name_in(file_name) else { return Ok(()) };
    if stem.eq_ignore_ascii_case(name.as_str()) {
        return Ok(());
    }
    let message = format!(
        "the program is called {name}, and its file {stem}: the controller finds a program by the name of its file"
    );
    let help = format!(
        "save it as {}.src, or give both a name of up to 24 letters, digits and _",
        name.as_str().to_ascii_lowercase()
    );
    Err(Diagnostic::error(Rule::ProgramFrame, message).help(help).line(line).into())
}

/// # Errors
/// A file in a folder for called programs has the name of a program of KUKA's software, which it would hide.
fn hides_none_of_kuka(settings: &Settings) -> Outcome {
    let folders = &settings.setup.folders;
    let Some((name, file)) = of_kuka().find_map(|name| Some((name, folders.find(name, "src")?)))
    else {
        return Ok(());
    };
    let message = format!(
        "beside the program lies {file}: {name} is a program of KUKA's own software, and this one would be called in its place"
    );
    let help = "give that program another name, or take its file out of the folder";
    Err(Diagnostic::error(Rule::ProgramFrame, message).help(help).line(1).into())
}

impl<'t> File<'t> {
    /// # Errors
    /// Two programs have one name, or one has no end; a line with `DEF` is not understood.
    fn of(text: &'t [u8], name: Option<Box<str>>) -> Outcome<File<'t>> {
        let (mut programs, mut first) = (HashMap::new(), None);
        // The line of the program in which the next one stands.
        let mut begun = None;
        for (place, after, block) in lines(text) {
            let source = Source { line: place.line, text: block };
            let is_inside = stands(source, begun.is_some(), first.is_some())?;
            begun = is_inside.then(|| begun.unwrap_or(place.line));
            if begins_with(block, b"DEFFCT") {
                function_name(&mut Scan::new(source))?;
            }
            if !begins_with(block, b"DEF") {
                continue;
            }
            let mut scan = Scan::new(Source { line: place.line, text: block });
            if let Statement::Define(name) = read(&mut scan, &State::new(""))? {
                if programs.insert(name, after).is_some() {
                    let message = format!("the file has two programs {name}");
                    return Err(scan.since(0, Rule::Twice, message));
                }
                first = first.or(Some((name, after)));
            }
        }
        match begun {
            Some(line) => Err(no_end(line)),
            None => Ok(File { text, name, programs, first }),
        }
    }
}

fn no_end(line: u32) -> Box<Diagnostic> {
    let found = Diagnostic::error(
        Rule::NoEnd,
        "the program has no END: a controller takes none of the file",
    );
    Box::new(found.line(line))
}

/// Whether the line behind this one stands within a program.
///
/// # Errors
/// A sign is there that ends a line for some readers and not for others; a statement outside of programs, a program within another, or a
/// line of the head of the file behind it.
fn stands(source: Source, is_inside: bool, has_program: bool) -> Outcome<bool> {
    let text = source.text;
    let wrong = |rule: Rule, message: &str| Err(source.error(rule, 0..text.len(), message));
    let separates = |pair: &[u8]| pair == b"\xC2\x85";
    let parts = |three: &[u8]| matches!(three, b"\xE2\x80\xA8" | b"\xE2\x80\xA9");
    // Without a branch, several bytes are looked at at once.
    let is_control = |found, byte: &u8| found | (byte.is_ascii_control() & (*byte != b'\t'));
    if text.iter().fold(false, is_control)
        || !text.is_ascii() && (text.windows(2).any(separates) || text.windows(3).any(parts))
    {
        return wrong(Rule::Syntax, "a control character stands in the line: it may end it");
    }
    let text = text.trim_ascii_start();
    let length = text.iter().take_while(|byte| byte.is_ascii_alphanumeric() || **byte == b'_');
    let word = text.get(..length.count()).unwrap_or_default();
    let is = |words: [&str; 2]| words.iter().any(|own| word.eq_ignore_ascii_case(own.as_bytes()));
    match (word, text.first(), is_inside) {
        (_, None | Some(b';'), _) => Ok(is_inside),
        (_, Some(b'&'), _) if !has_program => Ok(is_inside),
        (_, Some(b'&'), _) => {
            wrong(Rule::ProgramFrame, "a line with & stands before the first DEF")
        }
        (_, _, true) if is(["DEF", "DEFFCT"]) => {
            wrong(Rule::ProgramFrame, "a program begins within another: END is missing before it")
        }
        _ if is(["DEF", "DEFFCT"]) => Ok(true),
        (_, _, true) if is(["END", "ENDFCT"]) => Ok(false),
        (_, _, true) => Ok(true),
        (_, _, false) => {
            wrong(Rule::ProgramFrame, "the line stands outside of programs: between DEF and END")
        }
    }
}

fn begins_with(block: &[u8], word: &[u8]) -> bool {
    let text = block.trim_ascii_start();
    let own = text.get(..word.len()).unwrap_or_default();
    own.eq_ignore_ascii_case(word) && text.get(word.len()).is_some_and(u8::is_ascii_whitespace)
}

struct Run<'r, 'c> {
    settings: &'r Settings,
    state: State,
    channel: &'r mut Channel<'c>,
}

impl Run<'_, '_> {
    /// Runs a program from behind its `DEF` to its end; the line of that.
    fn routine(&mut self, file: &File, from: BlockLocation, depth: usize) -> Outcome<u32> {
        let (mut place, mut has_begun) = (from, false);
        while let Some((text, after)) = line(file.text, place) {
            let mut scan = Scan::new(Source { line: place.line, text });
            let statement = read(&mut scan, &self.state)?;
            let number = place.line;
            if matches!(statement, Statement::Declare(_, _, None)) && has_begun {
                let message = "declarations stand before the first statement of a program";
                return Err(scan.since(0, Rule::Definition, message));
            }
            has_begun |= !matches!(
                statement,
                Statement::Declare(..) | Statement::Nothing | Statement::Comment(_)
            );
            match statement {
                Statement::End | Statement::Return => return Ok(number),
                Statement::EndData => {
                    let message = "ENDDAT ends a data list (.dat), and no program";
                    return Err(scan.since(0, Rule::ProgramFrame, message));
                }
                Statement::Define(_) | Statement::DefineData(_) => {
                    let message = "a program begins within another: END is missing before it";
                    return Err(scan.since(0, Rule::ProgramFrame, message));
                }
                Statement::Call(name, arguments) => {
                    if !self.state.called(&scan, name, &arguments, self.channel)? {
                        self.call(file, &scan, (name, arguments.is_empty()), depth)?;
                    }
                }
                other => self.statement(&scan, other)?,
            }
            place = after;
        }
        Err(no_end(place.line))
    }

    fn statement(&mut self, scan: &Scan, statement: Statement) -> Outcome {
        let number = scan.line;
        match statement {
            Statement::Comment(text) => self.channel.report(number, Action::Comment(text)),
            Statement::Motion(motion) => self.state.go(scan, &motion, self.channel),
            Statement::Assign(target, value) => {
                self.state.assign(scan, target, value, self.channel)
            }
            Statement::Wait(waiting) => self.state.wait(scan, waiting, self.channel),
            Statement::Halt => {
                self.state.halted();
                self.channel.report(number, Action::Stop)
            }
            Statement::Declare(_, _, Some(_)) => {
                let message =
                    "values of declarations stand in the data list (.dat), not in the program";
                Err(scan.since(0, Rule::Definition, message))
            }
            Statement::Declare(kind, names, None) => self.state.declare(scan, kind, &names),
            Statement::Nothing
            | Statement::Define(_)
            | Statement::DefineData(_)
            | Statement::End
            | Statement::EndData
            | Statement::Return
            | Statement::Call(_, _) => Ok(()),
        }
    }

    /// A call of a program of this file, or of another one; whether it is called without arguments.
    fn call(
        &mut self,
        file: &File,
        scan: &Scan,
        (name, plain): (Name, bool),
        depth: usize,
    ) -> Outcome {
        let refused = |rule: Rule, message: String| scan.since(0, rule, message);
        if !plain {
            let message = format!("{name} is called with arguments, which is not followed");
            return Err(refused(Rule::Argument, message));
        }
        let counted = self.channel.budget.call(depth, DEEPEST);
        counted.map_err(|(rule, message)| refused(rule, message))?;
        if let Some(place) = file.programs.get(&name) {
            return self.routine(file, *place, depth + 1).map(drop);
        }
        let called = self.settings.setup.folders.called(name.as_str(), "src");
        let called = called.map_err(|message| refused(Rule::CalledProgram, message));
        let Some(called) = called? else {
            let message = format!("the called program {name} is in no folder for called programs");
            return Err(refused(Rule::CalledProgram, message));
        };
        let inside = |found: Box<Diagnostic>| called.inside(found);
        let other = File::of(&called.text, Some(called.name.as_str().into())).map_err(inside)?;
        self.data(name)?;
        let Some(place) = other.programs.get(&name) else {
            let message = format!("{} has no program {name}", called.name);
            return Err(refused(Rule::CalledProgram, message));
        };
        self.channel.arm(scan.line, ArmAction::File(other.name.clone()))?;
        let end = self.routine(&other, *place, depth + 1).map_err(inside)?;
        self.channel.arm(end, ArmAction::File(file.name.clone())).map_err(inside)
    }

    /// The data list of a program, where a folder has it.
    ///
    /// # Errors
    /// It is no data list of this program, from `DEFDAT` to `ENDDAT`, or a value is not understood.
    fn data(&mut self, name: Name) -> Outcome {
        let list = self.settings.setup.folders.called(name.as_str(), "dat");
        let list = list.map_err(|message| Diagnostic::error(Rule::CalledProgram, message))?;
        let Some(list) = list else { return Ok(()) };
        let inside = |found: Box<Diagnostic>| list.inside(found);
        // Before its head, in it, or behind its end.
        let (mut part, mut last) = (ListPart::Before, 1);
        for (place, _, block) in lines(&list.text) {
            let mut scan = Scan::new(Source { line: place.line, text: block });
            let statement = read(&mut scan, &self.state).map_err(inside)?;
            part = self.datum(&scan, (name, statement), part).map_err(inside)?;
            last = place.line;
        }
        match part {
            ListPart::Behind => Ok(()),
            ListPart::Before | ListPart::Inside => {
                let message = "the data list has no ENDDAT: a controller takes none of it";
                Err(inside(Box::new(Diagnostic::error(Rule::NoEnd, message).line(last))))
            }
        }
    }

    /// A line of the data list of a program; in which part of the list the next one is.
    fn datum(
        &mut self,
        scan: &Scan,
        (name, statement): (Name, Statement),
        part: ListPart,
    ) -> Outcome<ListPart> {
        let wrong = |message: String| Err(scan.since(0, Rule::ProgramFrame, message));
        match (statement, part) {
            (Statement::Nothing | Statement::Comment(_), _) => Ok(part),
            (Statement::DefineData(own), ListPart::Before) if own == name => Ok(ListPart::Inside),
            (Statement::DefineData(own), ListPart::Before) => {
                wrong(format!("the data list is that of {own}, and its file that of {name}"))
            }
            (Statement::EndData, ListPart::Inside) => Ok(ListPart::Behind),
            (Statement::Declare(kind, names, value), ListPart::Inside) => {
                self.state.declare(scan, kind, &names)?;
                if let (Some(name), Some(value)) = (names.first(), value) {
                    let target = Target { name: *name, index: None, field: None };
                    self.state.set(scan, target, value)?;
                }
                Ok(part)
            }
            (Statement::Assign(target, value), ListPart::Inside) => {
                self.state.set(scan, target, value)?;
                Ok(part)
            }
            (_, ListPart::Inside) => {
                wrong(String::from("a data list has declarations and values alone"))
            }
            (_, ListPart::Before | ListPart::Behind) => wrong(String::from(
                "the line stands outside of the data list: between DEFDAT and ENDDAT",
            )),
        }
    }
}

/// Where in a data list a line stands.
#[derive(Clone, Copy)]
enum ListPart {
    Before,
    Inside,
    Behind,
}
