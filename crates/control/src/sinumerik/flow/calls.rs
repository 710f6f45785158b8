//! Program levels: a call, its parameters, and the way back.

use super::level::{Caller, LEVELS, Level, Reference, check_rest};
use super::library::Program;
use super::run::Run;
use crate::kernel::Outcome;
use crate::kernel::flow::BlockLocation;
use crate::kernel::source::Source;
use crate::sinumerik::execution::state::modal::Modal;
use crate::sinumerik::language::definition::Signature;
use crate::sinumerik::language::expression::Evaluator;
use crate::sinumerik::language::scan::{Name, Scanner};
use crate::sinumerik::language::statement::ProgramCall;
use crate::sinumerik::language::variables::{Locals, Variable};
use program::Rule;

impl Run<'_, '_> {
    /// Goes into a called program.
    pub fn call(&mut self, source: &Source, call: ProgramCall) -> Outcome {
        self.turn(source)?;
        let error = |rule, message: String| source.block_error(rule, message);
        let program = self.library.find(&call.program).map_err(|message| {
            let mut error = error(Rule::CalledProgram, message);
            error.message =
                format!("'{}' is no word of this control, and {}", call.program, error.message);
            error
        })?;
        self.interpreter.reads(source, program.text.len())?;
        let signature = self.signature(&program)?;
        let (bound, references) = self
            .bind(&signature, &call)
            .map_err(|message| error(Rule::Call, format!("{}: {message}", call.program)))?;
        let again = (call.times - 1, if call.times > 1 { bound.clone() } else { Vec::new() });
        if again.0 > 0 && !references.is_empty() {
            let message = "a repeated call with VAR parameters is not supported";
            return Err(error(Rule::Unsupported, message.into()));
        }
        let state = &mut self.interpreter.state;
        let locals = std::mem::replace(&mut state.locals, enter(bound));
        let modes = signature.save.then(|| Box::new(state.modes()));
        let line = self.interpreter.line;
        self.interpreter.line =
            if program.file.is_some() { line.or(Some(source.line)) } else { None };
        let caller = Caller { locals, references, modes, line, modal: None, again };
        let level = Level::new(program, Some(caller));
        self.callers.enter(std::mem::replace(&mut self.level, level)).map_err(|_| {
            let message = format!("calls nest deeper than {LEVELS} program levels (alarm 12620)");
            error(Rule::Nesting, message)
        })?;
        self.interpreter.called = true;
        Ok(())
    }

    /// Goes into the program that `MCALL` names, behind the block that has moved.
    pub fn call_due(&mut self, source: &Source) -> Outcome {
        let state = &mut self.interpreter.state;
        let Modal::Due(call) = std::mem::replace(&mut state.modal, Modal::Running) else {
            return Ok(());
        };
        if state.ended {
            let message = "the program ends in a block with a motion while MCALL is active";
            return Err(source.block_error(Rule::Call, message));
        }
        self.call(source, call.clone())?;
        if let Some(caller) = &mut self.level.caller {
            caller.modal = Some(call);
        }
        Ok(())
    }

    /// The `PROC` line of a program, where it begins with one.
    fn signature(&self, program: &Program) -> Outcome<Signature> {
        let mut place = program.start();
        while let Some((source, next)) = program.block(place.at, place.line) {
            place = BlockLocation { at: next, line: place.line.saturating_add(1) };
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
    pub fn end(
        &mut self,
        program: &Program,
        source: &Source,
        after: BlockLocation,
    ) -> Outcome<bool> {
        let state = &mut self.interpreter.state;
        let Some(caller) = &mut self.level.caller else {
            // What stands behind the end is only reached by jumps.
            return if program.has_jumped() { Ok(true) } else { check_rest(program, after) };
        };
        state.ended = false;
        if caller.again.0 > 0 {
            caller.again.0 -= 1;
            state.locals = enter(caller.again.1.clone());
            self.level.next = program.start();
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
        if let Some(call) = caller.modal {
            state.modal = Modal::Program(call);
        }
        if let Some(modes) = caller.modes {
            self.interpreter.restore(source, *modes)?;
        }
        self.interpreter.line = caller.line;
        if let Some(level) = self.callers.leave() {
            self.level = level;
        }
        self.interpreter.called = self.callers.last().is_some();
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
