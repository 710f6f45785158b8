//! The course of a program: from block to block, over jumps, loops and calls.

use super::level::{LEVELS, Level, Repetition, check_length};
use super::library::{Library, Program};
use crate::Settings;
use crate::event::{Action, Risk};
use crate::kernel::Channel;
use crate::kernel::Outcome;
use crate::kernel::flow::{BlockLocation, Calls, Labels};
use crate::kernel::source::Source;
use crate::sinumerik::execution::interpreter::Interpreter;
use crate::sinumerik::execution::state::modal::Modal;
use crate::sinumerik::language::block::Block;
use crate::sinumerik::language::expression::Evaluator;
use crate::sinumerik::language::scan::Name;
use crate::sinumerik::language::statement::{Count, Jump, Search, Section, Statement, Target};
use crate::sinumerik::language::structure::Word;
use crate::sinumerik::language::value::Value;
use crate::sinumerik::language::variables::ELEMENTS_IN_A_TURN;
use crate::sinumerik::models::Facts;
use program::{Diagnostic, Rule};
use std::hash::Hash;
use std::rc::Rc;

/// A run of a main program.
pub(crate) struct Run<'a, 's> {
    pub library: Library<'a>,
    pub interpreter: Interpreter<'a, 's>,
    pub level: Level<'a>,
    pub callers: Calls<Level<'a>>,
}

impl<'a, 's> Run<'a, 's> {
    /// Runs the main program of `text`.
    pub fn main(
        facts: &'static Facts,
        settings: &'a Settings,
        text: &'a [u8],
        channel: &'a mut Channel<'s>,
    ) -> Outcome {
        let library = Library::new(&settings.setup.folders, text)?;
        let Some(program) = library.main() else { return Ok(()) };
        let interpreter = Interpreter::new(facts, settings, channel);
        let level = Level::new(program, None);
        let mut run = Run { library, interpreter, level, callers: Calls::new(LEVELS - 1) };
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
    pub fn in_file(&self, program: &Program, mut error: Box<Diagnostic>) -> Box<Diagnostic> {
        if let Some(file) = &program.file
            && error.file.is_empty()
            && !self.interpreter.stopped
        {
            error.file.clone_from(file);
            if let Some(line) = self.interpreter.line {
                error.help_too(&format!("it was called from line {line} of the main program"));
            }
        }
        error
    }

    /// Runs blocks of `program` until another one goes on; whether the main program has ended.
    fn blocks(&mut self, program: &Program, block: &mut Block) -> Outcome<bool> {
        let mut here = self.level.next;
        let skips = self.interpreter.settings.setup.block_delete;
        while let Some((source, next)) = program.block(here.at, here.line) {
            let after = BlockLocation { at: next, line: here.line.saturating_add(1) };
            if source.text.iter().all(u8::is_ascii_whitespace) {
                here = after;
                continue;
            }
            check_length(&source)?;
            if skips && source.text.trim_ascii_start().first() == Some(&b'/') {
                here = after;
                continue;
            }
            if after.at > program.text.len() && self.level.caller.is_none() {
                self.interpreter.emit(&source, Action::Risk(Risk::LINE_END.into()))?;
            }
            block.read(source, &self.interpreter.state)?;
            match block.statement.take().map(|statement| *statement) {
                None => {
                    self.level.working |= block.any;
                    self.interpreter.run(&source, block)?;
                    if let Modal::Due(_) = self.interpreter.state.modal {
                        self.level.next = after;
                        return self.call_due(&source).map(|()| false);
                    }
                    here = after;
                }
                Some(Statement::ModalCall(call)) => {
                    self.level.working = true;
                    self.interpreter.set_modal_program(&source, call)?;
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
            if here.at < after.at {
                self.interpreter.reads(&source, after.at - here.at)?;
            }
        }
        if self.level.caller.is_none() && !self.interpreter.settings.setup.purpose.asks_ends() {
            return Ok(true);
        }
        let message = "the program has no end: M30, M2, M17 or RET is missing";
        let line = here.line.saturating_sub(1).max(program.first_line - 1);
        Err(Diagnostic::error(Rule::ProgramEnd, message).line(line).into())
    }

    /// Another turn of a loop, a jump or a call.
    pub fn turn(&mut self, source: &Source) -> Outcome {
        self.interpreter.spend(source, 1)
    }

    /// Carries out a statement of the block at `here`: the block that comes next.
    fn statement(
        &mut self,
        program: &Program,
        source: &Source,
        here: BlockLocation,
        after: BlockLocation,
        statement: Statement,
    ) -> Outcome<BlockLocation> {
        let partner = || -> Outcome<(BlockLocation, BlockLocation)> {
            let mark = program.outline()?.structures.partner(here.at).ok_or_else(|| {
                source.block_error(Rule::ControlStructure, "the control structure is not complete")
            })?;
            Ok((mark.place, mark.after))
        };
        if let Statement::Define(_) | Statement::Declaration = statement {
            if self.level.working {
                let message = "definitions stand before the first block that does something (alarm \
                               14500)";
                return Err(source.block_error(Rule::Definition, message));
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
                        .map_err(|message| source.block_error(Rule::Definition, message))?;
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
            Statement::Call(_) | Statement::ModalCall(_) | Statement::Declaration => Ok(after),
        }
    }

    fn set(&mut self, source: &Source, count: &Count, value: f64) -> Outcome {
        let (kind, _) = Evaluator::new(&self.interpreter.state, &[]).room(count.place);
        let value = kind
            .keep(Value::Real(value))
            .map_err(|message| source.block_error(Rule::Type, message))?;
        self.interpreter.assign(source, count.place, value)
    }

    /// `ENDFOR`: adds 1 and goes on with the loop or behind it. When the control reads the last value
    /// is not documented, so it may not change.
    fn count_on(
        &mut self,
        program: &Program,
        first: BlockLocation,
        body: BlockLocation,
        behind: BlockLocation,
    ) -> Outcome<BlockLocation> {
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
            return Err(source.block_error(Rule::ControlStructure, message));
        }
        let value = self.interpreter.state.value_of(count.place).unwrap_or(f64::NAN) + 1.0;
        self.set(&source, &count, value)?;
        Ok(if reaches(value, count.end) { body } else { behind })
    }

    fn jump(
        &mut self,
        program: &Program,
        source: &Source,
        here: BlockLocation,
        after: BlockLocation,
        jump: &Jump,
    ) -> Outcome<BlockLocation> {
        let outline = program.outline()?;
        let error = |message: String| Err(source.block_error(Rule::Jump, message));
        // A block in front of the jump, or the one in which it stands, and one behind it.
        fn both<K: Eq + Hash>(
            labels: &Labels<K>,
            label: &K,
            at: usize,
        ) -> [Option<BlockLocation>; 2] {
            [labels.before(label, at + 1), labels.behind(label, at + 1)]
        }
        let (name, [backward, forward]) = match &jump.target {
            Target::Label(name) => (name.as_str().to_owned(), both(&outline.labels, name, here.at)),
            Target::Number(number) => {
                (format!("N{number}"), both(&outline.numbers, number, here.at))
            }
            Target::Start => return self.land(program, source, here, program.start()),
        };
        let found = match jump.search {
            Search::Forward => forward,
            Search::Backward => backward,
            Search::Both | Search::Optional | Search::Start => forward.or(backward),
        };
        match (found, jump.search) {
            (Some(target), _) => self.land(program, source, here, target),
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
        here: BlockLocation,
        target: BlockLocation,
    ) -> Outcome<BlockLocation> {
        if !program.outline()?.structures.may_jump(here.at, target.at) {
            let message = format!("the jump to line {} enters a control structure", target.line);
            return Err(source.block_error(Rule::Jump, message));
        }
        let inside = |section: &Repetition| (section.from.at..section.end).contains(&target.at);
        if self.level.sections.last().is_some_and(|section| !inside(section)) {
            let message = format!("the jump to line {} leaves a repeated section", target.line);
            return Err(source.block_error(Rule::Jump, message));
        }
        Ok(target)
    }

    /// `REPEAT`, `REPEATB` with labels.
    fn section(
        &mut self,
        program: &Program,
        source: &Source,
        here: BlockLocation,
        after: BlockLocation,
        section: &Section,
    ) -> Outcome<BlockLocation> {
        let outline = program.outline()?;
        // A label is looked for towards the start of the program, then towards its end.
        let find = |name: &Name| {
            let labels = &outline.labels;
            labels.before(name, here.at + 1).or_else(|| labels.behind(name, here.at))
        };
        let missing = |name: &Name| {
            let message = format!("the label {} is not there (alarm 14080)", name.as_str());
            source.block_error(Rule::Jump, message)
        };
        let behind =
            |place: BlockLocation| program.block(place.at, place.line).map_or(place.at, |b| b.1);
        let from = find(&section.from).ok_or_else(|| missing(&section.from))?;
        let end_label = || outline.labels.behind(&Name::of("ENDLABEL")?, from.at);
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
            return Err(source.block_error(Rule::Jump, message));
        }
        if section.times == 0 {
            return Ok(after);
        }
        self.land(program, source, here, from)?;
        if self.level.sections.len() >= LEVELS {
            let message = format!("repeated sections nest deeper than {LEVELS}");
            return Err(source.block_error(Rule::Jump, message));
        }
        let left = section.times - 1;
        self.level.sections.push(Repetition { from, end, left, back: after });
        Ok(from)
    }

    /// Starts a section again, or goes on behind it, where its end is reached.
    pub fn repeat(&mut self, source: &Source, mut here: BlockLocation) -> Outcome<BlockLocation> {
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
}

/// Whether a loop that counts to `end` is run with `value`.
fn reaches(value: f64, end: f64) -> bool {
    value <= end + end.abs() * 1e-12
}
