//! Calls: subroutines, `M98` and `M99`, and the macros of `G65` and `G66`.

use super::frame::{Frame, Kind, Modal};
use super::macros;
use super::run::Run;
use super::source::SourceLocation;
use crate::event::{Action, Risk};
use crate::iso::dialects::facts::Language;
use crate::iso::language::Fault;
use crate::iso::language::arithmetic;
use crate::iso::language::block::Block;
use crate::iso::language::parameters::Locals;
use crate::iso::language::words::{G, Group, M};
use program::Rule;

/// How many calls LinuxCNC nests (`INTERP_SUB_ROUTINE_LEVELS` less that of the program).
const NGC_CALLS: usize = 9;

/// How many macros FANUC nests (B-64484EN, 16.6).
const MACRO_CALLS: usize = 5;

/// How many calls FANUC nests, macros and subprograms together (B-64484EN, 13.3 and 16.6).
const ALL_CALLS: usize = 15;

impl<'a> Run<'a, '_> {
    /// The subprogram of `M98 P L` and how often it is run.
    pub(super) fn called_program(&mut self) -> Result<(SourceLocation<'a>, u32), Fault> {
        let fault =
            |block: &Block, message: String| block.at_group(Group::Flow, Rule::Call, message);
        let Some(program) = self.whole_word(b'P')? else {
            return Err(fault(&self.block, "M98 needs P, the number of the subprogram".into()));
        };
        let turns = self.whole_word(b'L')?;
        if self.language == Language::Ngc {
            if !self.block.has_only(b"PL", Group::Flow) {
                return Err(fault(&self.block, "M98 stands alone with P and L".into()));
            }
            let place = self.o_program(program)?.map_err(|message| fault(&self.block, message))?;
            // `L0` skips the call.
            return Ok((place, turns.unwrap_or(1)));
        }
        // FANUC without L: four digits of the program behind those of the repeats.
        let (program, turns) = match turns {
            Some(turns) => (program, turns),
            None if self.facts.syntax.repeats_in_p && program > 9999 => {
                (program % 10_000, program / 10_000)
            }
            None => (program, 1),
        };
        if turns == 0 {
            return Err(fault(&self.block, "a subprogram is run once at least".into()));
        }
        let place = match self.block.m(Group::Flow) {
            Some(M::CallBlock) => self.block_of_program(program)?,
            _ => self.macro_program(program)?,
        };
        Ok((place.map_err(|message| fault(&self.block, message))?, turns))
    }

    /// The whole number of this letter of the block.
    pub(super) fn whole_word(&mut self, letter: u8) -> Result<Option<u32>, Fault> {
        let Some(word) = self.block.take(letter) else { return Ok(None) };
        match arithmetic::whole(word.value).filter(|_| !word.point) {
            Some(value) => Ok(Some(value)),
            None => {
                let message = format!("{} must be a whole number", char::from(letter));
                Err(self.block.at_word(letter, Rule::Number, message))
            }
        }
    }

    /// `G65` calls a macro, `G66` asks for it after each move.
    pub(super) fn macro_call(&mut self) -> Result<(), Fault> {
        self.flows = true;
        let fault =
            |block: &Block, message: String| block.at_group(Group::Macro, Rule::Call, message);
        let Some(program) = self.whole_word(b'P')? else {
            return Err(fault(&self.block, "a macro call needs P, the number of the macro".into()));
        };
        let turns = self.whole_word(b'L')?.unwrap_or(1);
        if !self.block.has_only(b"PL", Group::Macro) || turns == 0 {
            let message = "a macro call stands alone with P, L (from 1) and its arguments";
            return Err(fault(&self.block, message.into()));
        }
        let locals = self.arguments()?;
        let place = self.macro_program(program)?;
        let place = place.map_err(|message| fault(&self.block, message))?;
        if self.block.g(Group::Macro) == Some(G::MacroCall { modal: true }) {
            if self.frame().modal.is_some() {
                let message = "a second macro after each move is not followed; write G67 first";
                return Err(fault(&self.block, message.into()));
            }
            self.frame().modal = Some(Modal { place, turns, locals });
            return Ok(());
        }
        self.call(Kind::Macro { modal: false }, place, turns, Some(locals))
            .map_err(|message| fault(&self.block, message))
    }

    /// The arguments of the macro call that has been read, as local variables.
    fn arguments(&self) -> Result<Locals, Fault> {
        let mut locals: Locals = [None; 34];
        let mut triples = [0usize; 3];
        for &word in &self.block.arguments {
            let letter = word.letter;
            let value = self.argument(word)?;
            // The second I, J or K and those after it are of argument specification II: `#7` and so on.
            let variable = match letter {
                b'I' | b'J' | b'K' => {
                    let which = usize::from(letter - b'I');
                    triples[which] += 1;
                    4 + which + 3 * (triples[which] - 1)
                }
                _ => macros::variable_of(letter).unwrap_or(usize::MAX),
            };
            let Some(place) = locals.get_mut(variable) else {
                let message = format!("{} is no argument of a macro", char::from(letter));
                return Err(self.block.at_group(Group::Macro, Rule::Call, message));
            };
            *place = Some(value);
        }
        Ok(locals)
    }

    /// After a move the macro of `G66` is called.
    pub(super) fn after_move(&mut self) -> Result<(), Fault> {
        let moves = |action: &Action| {
            action.position().is_some()
                || matches!(action, Action::Home(_) | Action::MachineMove(_))
        };
        let Some(modal) = self.frames.last().and_then(|frame| frame.modal.as_ref()) else {
            return Ok(());
        };
        if !self.actions.iter().any(moves) {
            return Ok(());
        }
        let (place, turns, locals) = (modal.place, modal.turns, modal.locals);
        self.call(Kind::Macro { modal: true }, place, turns, Some(locals))
            .map_err(|message| self.block.whole(Rule::Call, message))
    }

    /// Calls what begins at `place`, `turns` times, with these local values or those of the caller.
    ///
    /// # Errors
    /// Calls nest too deep.
    pub(super) fn call(
        &mut self,
        kind: Kind,
        place: SourceLocation<'a>,
        turns: u32,
        locals: Option<Locals>,
    ) -> Result<(), String> {
        if turns == 0 {
            return Ok(());
        }
        self.channel.budget.jump()?;
        let macros = self.frames.iter().filter(|f| matches!(f.kind, Kind::Macro { .. })).count();
        let calls = self.frames.len();
        let (most, now) = match (self.language, kind) {
            (Language::Ngc, _) => (NGC_CALLS, calls),
            (_, Kind::Macro { .. }) if calls <= ALL_CALLS => (MACRO_CALLS, macros + 1),
            _ => (ALL_CALLS, calls),
        };
        if now > most {
            return Err(format!("calls nest deeper than {most}: does the program call itself?"));
        }
        if kind != Kind::Subprogram || self.language == Language::Ngc {
            self.parameters.enter(locals);
        }
        let (back, caller) = (self.here, self.caller);
        if self.caller.is_none() && !std::ptr::eq(place.source, self.main) {
            self.caller = Some(self.here.line);
        } else if std::ptr::eq(place.source, self.main) {
            self.caller = None;
        }
        self.frames.push(Frame { caller, turns, locals, ..Frame::new(kind, place, back) });
        self.here = place;
        Ok(())
    }

    /// The called program has ended: it is run again, or its caller goes on.
    pub(super) fn leave(&mut self) -> Result<(), Fault> {
        let begin = self.frames.last().map_or(self.here.at, |frame| frame.begin.at);
        let read = self.here.at.saturating_sub(begin);
        let counted = self.channel.budget.again(read);
        counted.map_err(|message| self.at_line(Rule::Endless, message))?;
        let modes = self.frame().modes.filter(|modes| modes.until_return);
        let Some(frame) = (if self.frames.len() > 1 { self.frames.pop() } else { None }) else {
            return Ok(());
        };
        let own = frame.kind != Kind::Subprogram || self.language == Language::Ngc;
        let left = own.then(|| self.parameters.leave(frame.kind == Kind::Subprogram));
        self.here = frame.back;
        self.caller = frame.caller;
        if let (Kind::Macro { modal: true }, Some(modal), Some(left)) =
            (frame.kind, self.frame().modal.as_mut(), left)
        {
            // `G66` alone sets them, not each call.
            modal.locals = left;
        }
        if let Some(modes) = modes {
            self.restore(&modes)?;
        }
        if frame.turns > 1 {
            let again = self.call(frame.kind, frame.begin, frame.turns - 1, frame.locals);
            return again.map_err(|message| self.block.whole(Rule::Call, message));
        }
        Ok(())
    }

    /// `M99`: to the caller; with P to a block of its.
    pub(super) fn back(&mut self, label: Option<u32>) -> Result<(), Fault> {
        self.flows = true;
        let fault =
            |run: &Self, message: &str| run.block.at_group(Group::Flow, Rule::Call, message);
        match (self.kind(), label) {
            (Kind::Main, None) if self.language == Language::Ngc => {
                Err(fault(self, "M99 in the program itself runs it again without end; write M2"))
            }
            // The control begins the program again: what follows is not reached.
            (Kind::Main, None) => {
                self.actions.push(Action::Risk(Risk::PROGRAM_REPEATS.into()));
                self.leave_on();
                if self.control.state.is_down() {
                    self.actions.push(Action::Risk(Risk::TOOL_DOWN.into()));
                }
                self.actions.push(Action::End);
                self.control.state.ended = true;
                Ok(())
            }
            (Kind::Subroutine, _) => Err(fault(self, "a subroutine ends with endsub")),
            (_, Some(_)) if self.language == Language::Ngc => {
                Err(fault(self, "M99 takes no P here"))
            }
            (Kind::Main, Some(label)) => self.go_to(label),
            (_, None) => self.leave(),
            (_, Some(label)) => {
                // The block of the caller comes in place of further turns.
                self.frame().turns = 1;
                self.leave()?;
                self.go_to(label)
            }
        }
    }
}
