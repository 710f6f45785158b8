//! The course of a program: from block to block, over jumps, loops and calls.

use super::Fallible;
use super::block::Block;
use super::definition::Signature;
use super::expression::Evaluator;
use super::interpreter::Interpreter;
use super::library::{Library, Program};
use super::outline::{Place, Word};
use super::scan::{Name, Scanner, Source};
use super::state::Modes;
use super::statement::{Count, Jump, ProgramCall, Search, Section, Statement, Target};
use super::value::Value;
use super::variables::{ELEMENTS_IN_A_TURN, Locals, Variable};
use crate::Settings;
use crate::compensation::Compensator;
use crate::flow::DEEPEST;
use program::Diagnostic;
use std::rc::Rc;

/// Most characters of a block, its end included (Programming Manual 06/2019, 2.2.2.2).
const LONGEST_BLOCK: usize = 512;

/// Most program levels, that of the main program included (Programming Manual 12/2019, 3.2.1.3).
const LEVELS: usize = 16;
const _: () = assert!(LEVELS <= DEEPEST);

/// A program that runs.
struct Level<'a> {
    program: Rc<Program<'a>>,
    /// The block that comes next.
    next: Place,
    /// Whether a block has done something, behind which no variable is defined any more.
    working: bool,
    /// The sections that are being repeated, the inmost last.
    sections: Vec<Repetition>,
    /// The last values of the `FOR` loops that run, each with the byte of its first block.
    counts: Vec<(usize, f64)>,
    /// What the caller gets back; none for the main program.
    caller: Option<Caller>,
}

/// A section that is being repeated.
struct Repetition {
    from: Place,
    /// The byte behind its last block.
    end: usize,
    /// How often it still starts again.
    left: u32,
    /// Where it goes on afterwards.
    back: Place,
}

/// What a caller gets back.
struct Caller {
    locals: Locals,
    /// Variables that were given themselves (`VAR`).
    references: Vec<Reference>,
    /// Modal commands (`SAVE`).
    modes: Option<Box<Modes>>,
    /// The line that records of the caller carry.
    line: Option<u32>,
    /// The values of the parameters, and how often the program runs again with them.
    again: (u32, Vec<(Name, Variable)>),
}

/// A variable of the caller that is a parameter.
struct Reference {
    parameter: usize,
    variable: usize,
    element: Option<usize>,
}

/// A run of a main program.
pub(super) struct Run<'a, 's> {
    library: Library<'a>,
    interpreter: Interpreter<'a, 's>,
    level: Level<'a>,
    callers: Vec<Level<'a>>,
}

impl<'a> Level<'a> {
    fn new(program: Rc<Program<'a>>, caller: Option<Caller>) -> Level<'a> {
        let next = Place { at: 0, line: program.first_line };
        let (sections, counts) = (Vec::new(), Vec::new());
        Level { program, next, working: false, sections, counts, caller }
    }
}

impl<'a, 's> Run<'a, 's> {
    /// Runs the main program of `text`.
    pub fn main(
        settings: &'a Settings,
        text: &'a [u8],
        compensator: &'a mut Compensator<'s>,
    ) -> Fallible<()> {
        let library = Library::new(&settings.setup.folders, text)?;
        let Some(program) = library.main() else { return Ok(()) };
        let interpreter = Interpreter::new(settings, compensator);
        let level = Level::new(program, None);
        let mut run = Run { library, interpreter, level, callers: Vec::new() };
        let mut block = Block::empty();
        loop {
            let program = Rc::clone(&run.level.program);
            let ended = run.blocks(&program, &mut block);
            if ended.map_err(|error| run.in_file(&program, error))? {
                return Ok(());
            }
        }
    }

    /// An error of a called file names that file.
    fn in_file(&self, program: &Program, mut error: Box<Diagnostic>) -> Box<Diagnostic> {
        if let Some(file) = &program.file
            && error.file.is_empty()
            && !self.interpreter.stopped
        {
            error.file.clone_from(file);
            if let Some(line) = self.interpreter.line
                && error.help.is_empty()
            {
                error.help = format!("it was called from line {line} of the main program");
            }
        }
        error
    }

    /// Runs blocks of `program` until another one goes on; whether the main program has ended.
    fn blocks(&mut self, program: &Program, block: &mut Block) -> Fallible<bool> {
        let mut here = self.level.next;
        let skips = self.interpreter.settings.setup.block_delete;
        while let Some((source, next)) = program.block(here.at, here.line) {
            let after = Place { at: next, line: here.line.saturating_add(1) };
            if source.text.iter().all(u8::is_ascii_whitespace) {
                here = after;
                continue;
            }
            check_length(&source)?;
            if skips && source.text.trim_ascii_start().first() == Some(&b'/') {
                here = after;
                continue;
            }
            block.read(source, &self.interpreter.state)?;
            match block.statement.take().map(|statement| *statement) {
                None => {
                    self.level.working |= block.any;
                    self.interpreter.run(&source, block)?;
                    here = after;
                }
                Some(Statement::Call(call)) => {
                    self.level.working = true;
                    self.level.next = after;
                    if call.times > 0 {
                        return self.call(&source, call).map(|()| false);
                    }
                    here = after;
                }
                Some(statement) => {
                    here = self.statement(program, &source, here, after, statement)?;
                }
            }
            if self.interpreter.state.ended {
                return self.end(program, &source, after);
            }
            if !self.level.sections.is_empty() {
                here = self.repeat(&source, here)?;
            }
        }
        let message = "the program has no end: M30, M2, M17 or RET is missing";
        let line = here.line.saturating_sub(1).max(program.first_line - 1);
        Err(Diagnostic::error("program-end", message).line(line).into())
    }

    /// Another turn of a loop, a jump or a call.
    fn turn(&mut self, source: &Source) -> Fallible<()> {
        self.interpreter.spend(source, 1)
    }

    /// Carries out a statement of the block at `here`: the block that comes next.
    fn statement(
        &mut self,
        program: &Program,
        source: &Source,
        here: Place,
        after: Place,
        statement: Statement,
    ) -> Fallible<Place> {
        let partner = || -> Fallible<(Place, Place)> {
            program.outline()?.partner(here.at).ok_or_else(|| {
                source.block_error("control-structure", "the control structure is not complete")
            })
        };
        if let Statement::Define(_) | Statement::Declaration = statement {
            if self.level.working {
                let message = "definitions stand before the first block that does something (alarm \
                               14500)";
                return Err(source.block_error("definition", message));
            }
        } else {
            self.level.working = true;
        }
        match statement {
            Statement::Define(variables) => {
                for (name, variable) in variables {
                    self.interpreter.spend(source, variable.values.len() / ELEMENTS_IN_A_TURN)?;
                    let locals = &mut self.interpreter.state.locals;
                    locals
                        .define(name, variable)
                        .map_err(|message| source.block_error("definition", message))?;
                }
                Ok(after)
            }
            Statement::If(true) | Statement::While(true) => {
                program.outline()?;
                Ok(after)
            }
            Statement::If(false) | Statement::While(false) => Ok(partner()?.1),
            Statement::Until(true) | Statement::Jump(None) => Ok(after),
            Statement::Plain(Word::EndIf | Word::Loop | Word::Repeat) => {
                program.outline()?;
                Ok(after)
            }
            Statement::Plain(Word::Else) => Ok(partner()?.1),
            Statement::Plain(Word::EndLoop) | Statement::Until(false) => {
                self.turn(source)?;
                Ok(partner()?.1)
            }
            Statement::Plain(Word::EndFor) => {
                self.turn(source)?;
                let (first, body) = partner()?;
                self.count_on(program, first, body, after)
            }
            // ENDWHILE; the others are read with their conditions.
            Statement::Plain(_) => {
                self.turn(source)?;
                Ok(partner()?.0)
            }
            Statement::For(count) => {
                let behind = partner()?.1;
                self.set(source, &count, count.start)?;
                self.level.counts.retain(|(at, _)| *at != here.at);
                self.level.counts.push((here.at, count.end));
                Ok(if reaches(count.start, count.end) { after } else { behind })
            }
            Statement::Jump(Some(jump)) => {
                self.turn(source)?;
                self.jump(program, source, here, after, &jump)
            }
            Statement::Section(section) => {
                self.turn(source)?;
                self.section(program, source, here, after, &section)
            }
            // Calls go to another program, and a declaration has no effect of its own.
            Statement::Call(_) | Statement::Declaration => Ok(after),
        }
    }

    fn set(&mut self, source: &Source, count: &Count, value: f64) -> Fallible<()> {
        let state = &mut self.interpreter.state;
        let (kind, _) = Evaluator::new(state, &[]).room(count.place);
        let value =
            kind.keep(Value::Real(value)).map_err(|message| source.block_error("type", message))?;
        state.assign(count.place, value);
        Ok(())
    }

    /// `ENDFOR`: adds 1 and goes on with the loop or behind it. When the control reads the last value
    /// is not documented, so it may not change.
    fn count_on(
        &mut self,
        program: &Program,
        first: Place,
        body: Place,
        behind: Place,
    ) -> Fallible<Place> {
        let Some((source, _)) = program.block(first.at, first.line) else { return Ok(behind) };
        let mut block = Block::empty();
        block.read(source, &self.interpreter.state)?;
        let Some(Statement::For(count)) = block.statement.take().map(|s| *s) else {
            return Ok(behind);
        };
        let end = self.level.counts.iter().find(|(at, _)| *at == first.at).map(|(_, end)| *end);
        if end != Some(count.end) {
            let message = format!(
                "the last value of the loop changes from {} to {} while it runs",
                end.unwrap_or(f64::NAN),
                count.end
            );
            return Err(source.block_error("control-structure", message));
        }
        let value = self.interpreter.state.value_of(count.place).unwrap_or(f64::NAN) + 1.0;
        self.set(&source, &count, value)?;
        Ok(if reaches(value, count.end) { body } else { behind })
    }

    fn jump(
        &mut self,
        program: &Program,
        source: &Source,
        here: Place,
        after: Place,
        jump: &Jump,
    ) -> Fallible<Place> {
        let outline = program.outline()?;
        let error = |message: String| Err(source.block_error("jump", message));
        let (name, places) = match &jump.target {
            Target::Label(name) => (name.as_str().to_owned(), outline.labelled(name)),
            Target::Number(number) => (format!("N{number}"), outline.numbered(*number)),
            Target::Start => {
                let start = Place { at: 0, line: program.first_line };
                return self.land(program, source, here, start);
            }
        };
        let behind = places.partition_point(|place| place.at <= here.at);
        let forward = places.get(behind);
        let backward = behind.checked_sub(1).and_then(|index| places.get(index));
        let found = match jump.search {
            Search::Forward => forward,
            Search::Backward => backward,
            Search::Both | Search::Optional | Search::Start => forward.or(backward),
        };
        match (found, jump.search) {
            (Some(target), _) => self.land(program, source, here, *target),
            (None, Search::Optional) => Ok(after),
            (None, Search::Forward) if backward.is_some() => {
                error(format!("{name} stands before the jump, not behind it (alarm 14080)"))
            }
            (None, Search::Backward) if forward.is_some() => {
                error(format!("{name} stands behind the jump, not before it (alarm 14080)"))
            }
            (None, _) => error(format!("the target {name} is not there (alarm 14080)")),
        }
    }

    /// Whether a jump may go where it goes.
    fn land(
        &self,
        program: &Program,
        source: &Source,
        here: Place,
        target: Place,
    ) -> Fallible<Place> {
        if !program.outline()?.may_jump(here.at, target.at) {
            let message = format!("the jump to line {} enters a control structure", target.line);
            return Err(source.block_error("jump", message));
        }
        let inside = |section: &Repetition| (section.from.at..section.end).contains(&target.at);
        if self.level.sections.last().is_some_and(|section| !inside(section)) {
            let message = format!("the jump to line {} leaves a repeated section", target.line);
            return Err(source.block_error("jump", message));
        }
        Ok(target)
    }

    /// `REPEAT`, `REPEATB` with labels.
    fn section(
        &mut self,
        program: &Program,
        source: &Source,
        here: Place,
        after: Place,
        section: &Section,
    ) -> Fallible<Place> {
        let outline = program.outline()?;
        // A label is looked for towards the start of the program, then towards its end.
        let find = |name: &Name| {
            let places = outline.labelled(name);
            let behind = places.partition_point(|place| place.at <= here.at);
            behind.checked_sub(1).and_then(|i| places.get(i)).or(places.get(behind)).copied()
        };
        let missing = |name: &Name| {
            let message = format!("the label {} is not there (alarm 14080)", name.as_str());
            source.block_error("jump", message)
        };
        let behind = |place: Place| program.block(place.at, place.line).map_or(place.at, |b| b.1);
        let from = find(&section.from).ok_or_else(|| missing(&section.from))?;
        let end_label = || {
            let ends = outline.labelled(&Name::of("ENDLABEL")?);
            ends.iter().find(|place| place.at >= from.at).copied()
        };
        let last = match &section.to {
            _ if section.one_block => Some(from),
            Some(to) => Some(find(to).ok_or_else(|| missing(to))?),
            None => end_label(),
        };
        let end = last.map(behind).unwrap_or(usize::MAX);
        // What the REPEAT stands in goes as far as to it.
        let end = if from.at <= here.at && end > here.at { here.at } else { end };
        if end <= from.at || end == usize::MAX {
            let message = "the section to be repeated has no end: a second label or ENDLABEL";
            return Err(source.block_error("jump", message));
        }
        if section.times == 0 {
            return Ok(after);
        }
        self.land(program, source, here, from)?;
        if self.level.sections.len() >= LEVELS {
            let message = format!("repeated sections nest deeper than {LEVELS}");
            return Err(source.block_error("jump", message));
        }
        let left = section.times - 1;
        self.level.sections.push(Repetition { from, end, left, back: after });
        Ok(from)
    }

    /// Starts a section again, or goes on behind it, where its end is reached.
    fn repeat(&mut self, source: &Source, mut here: Place) -> Fallible<Place> {
        while let Some(section) = self.level.sections.last_mut().filter(|s| s.end == here.at) {
            if section.left > 0 {
                section.left -= 1;
                here = section.from;
                self.turn(source)?;
                return Ok(here);
            }
            here = section.back;
            self.level.sections.pop();
        }
        Ok(here)
    }

    /// Goes into a called program.
    fn call(&mut self, source: &Source, call: ProgramCall) -> Fallible<()> {
        self.turn(source)?;
        let error = |rule, message: String| source.block_error(rule, message);
        if self.callers.len() + 2 > LEVELS {
            let message = format!("calls nest deeper than {LEVELS} program levels (alarm 12620)");
            return Err(error("call-depth", message));
        }
        let program = self.library.find(&call.program).map_err(|message| {
            let mut error = error("unknown-program", message);
            error.message =
                format!("'{}' is no word of this control, and {}", call.program, error.message);
            error
        })?;
        let signature = self.signature(&program)?;
        let (bound, references) = self
            .bind(&signature, &call)
            .map_err(|message| error("call", format!("{}: {message}", call.program)))?;
        let again = (call.times - 1, if call.times > 1 { bound.clone() } else { Vec::new() });
        if again.0 > 0 && !references.is_empty() {
            let message = "a repeated call with VAR parameters is not supported";
            return Err(error("unsupported", message.into()));
        }
        let state = &mut self.interpreter.state;
        let locals = std::mem::replace(&mut state.locals, enter(bound));
        let modes = signature.save.then(|| Box::new(state.modes()));
        let line = self.interpreter.line;
        self.interpreter.line =
            if program.file.is_some() { line.or(Some(source.line)) } else { None };
        let caller = Caller { locals, references, modes, line, again };
        let level = Level::new(program, Some(caller));
        self.callers.push(std::mem::replace(&mut self.level, level));
        self.interpreter.called = true;
        Ok(())
    }

    /// The `PROC` line of a program, where it begins with one.
    fn signature(&self, program: &Program) -> Fallible<Signature> {
        let mut place = Place { at: 0, line: program.first_line };
        while let Some((source, next)) = program.block(place.at, place.line) {
            place = Place { at: next, line: place.line.saturating_add(1) };
            let mut scanner = Scanner::new(source);
            if scanner.rests() {
                continue;
            }
            let read = (|| {
                scanner.head()?;
                match scanner.take_word("PROC") {
                    true => {
                        let evaluator = Evaluator::new(&self.interpreter.state, &[]);
                        Signature::read(&mut scanner, &evaluator)
                    }
                    false => Ok(Signature::default()),
                }
            })();
            return read.map_err(|error| self.in_file(program, error));
        }
        Ok(Signature::default())
    }

    /// The parameters of a call as variables of the called program, and those of the caller that are
    /// meant themselves.
    #[allow(clippy::type_complexity, reason = "it is taken apart at once")]
    fn bind(
        &self,
        signature: &Signature,
        call: &ProgramCall,
    ) -> Result<(Vec<(Name, Variable)>, Vec<Reference>), String> {
        let (given, taken) = (call.arguments.len(), signature.parameters.len());
        if given > taken {
            return Err(format!("{given} arguments, and the program has {taken} parameters"));
        }
        let mut bound = Vec::with_capacity(taken);
        let mut references: Vec<Reference> = Vec::new();
        for (parameter, formal) in signature.parameters.iter().enumerate() {
            let name = formal.name.as_str();
            let actual = call.arguments.get(parameter);
            let given = actual.and_then(|a| a.variable);
            let variable = given.and_then(|(index, element)| {
                Some((self.interpreter.state.locals.get(index)?, element))
            });
            if formal.by_reference {
                let Some(((index, element), (variable, _))) = given.zip(variable) else {
                    return Err(format!("{name} is VAR and needs a variable of the caller"));
                };
                if variable.kind != formal.kind {
                    let (is, wants) = (variable.kind, formal.kind);
                    return Err(format!("{name} is a {wants}, the variable a {is}"));
                }
                let same = |r: &Reference| {
                    r.variable == index
                        && (r.element.is_none() || element.is_none() || r.element == element)
                };
                if references.iter().any(same) {
                    return Err(format!("{name}: one variable stands for two VAR parameters"));
                }
                references.push(Reference { parameter, variable: index, element });
            }
            let value = match variable {
                Some((variable, None)) if variable.sizes.len() == formal.dimensions => {
                    if variable.kind != formal.kind {
                        return Err(format!("{name} is an array of another type"));
                    }
                    variable.clone()
                }
                Some((_, None)) => {
                    return Err(format!("{name} has {} dimensions", formal.dimensions));
                }
                _ if formal.dimensions > 0 => return Err(format!("{name} is an array")),
                _ => {
                    let value = match actual.and_then(|a| a.value.clone()) {
                        Some(value) => {
                            Some(formal.kind.keep(value).map_err(|m| format!("{name}: {m}"))?)
                        }
                        None => formal.default.clone(),
                    };
                    Variable { kind: formal.kind, sizes: Vec::new(), values: vec![value] }
                }
            };
            bound.push((formal.name, value));
        }
        Ok((bound, references))
    }

    /// `M30`, `M17` and their kin: back to the caller, or the end; whether it is the end.
    fn end(&mut self, program: &Program, source: &Source, after: Place) -> Fallible<bool> {
        let state = &mut self.interpreter.state;
        let Some(caller) = &mut self.level.caller else {
            if after.at > program.text.len() {
                let message = "the last block has no line end, without which the control (828D) does \
                               not take the program as ended";
                return Err(source.block_error("program-end", message));
            }
            // What stands behind the end is only reached by jumps.
            return if program.has_jumped() { Ok(true) } else { check_rest(program, after) };
        };
        state.ended = false;
        if caller.again.0 > 0 {
            caller.again.0 -= 1;
            state.locals = enter(caller.again.1.clone());
            self.level.next = Place { at: 0, line: program.first_line };
            self.level.working = false;
            self.turn(source)?;
            return Ok(false);
        }
        let Some(caller) = self.level.caller.take() else { return Ok(true) };
        let callee = std::mem::replace(&mut state.locals, caller.locals);
        for reference in caller.references {
            let Some(parameter) = callee.get(reference.parameter) else { continue };
            match (reference.element, parameter.values.first()) {
                (None, _) => state.locals.replace(reference.variable, parameter.values.clone()),
                (Some(element), Some(Some(value))) => {
                    state.locals.set(reference.variable, element, value.clone());
                }
                (Some(_), _) => {}
            }
        }
        if let Some(modes) = caller.modes {
            self.interpreter.restore(source, *modes)?;
        }
        self.interpreter.line = caller.line;
        if let Some(level) = self.callers.pop() {
            self.level = level;
        }
        self.interpreter.called = !self.callers.is_empty();
        if !self.level.sections.is_empty() {
            self.level.next = self.repeat(source, self.level.next)?;
        }
        Ok(false)
    }
}

/// The variables of a program that is entered. Two parameters of one name are found where they are
/// defined.
fn enter(bound: Vec<(Name, Variable)>) -> Locals {
    let mut locals = Locals::default();
    for (name, variable) in bound {
        let _ = locals.define(name, variable);
    }
    locals
}

/// Whether a loop that counts to `end` is run with `value`.
fn reaches(value: f64, end: f64) -> bool {
    value <= end + end.abs() * 1e-12
}

fn check_length(source: &Source) -> Fallible<()> {
    if source.text.len() < LONGEST_BLOCK {
        return Ok(());
    }
    let message = format!("a block has at most {LONGEST_BLOCK} characters with its end");
    Err(source.error("block-length", LONGEST_BLOCK - 1..source.text.len(), message))
}

/// Only comments follow the end of a program without jumps.
fn check_rest(program: &Program, mut place: Place) -> Fallible<bool> {
    while let Some((source, next)) = program.block(place.at, place.line) {
        check_length(&source)?;
        if !Scanner::new(source).rests() {
            let message = "there are blocks behind the end of the program";
            return Err(source.block_error("program-end", message));
        }
        place = Place { at: next, line: place.line.saturating_add(1) };
    }
    Ok(true)
}
