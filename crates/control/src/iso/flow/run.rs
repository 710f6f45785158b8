//! The run of a program: line after line, and the calls and jumps from one to another.

use super::ahead::Ahead;
use super::frame::{Frame, Kind};
use super::numbers;
use super::owords;
use super::source::{Source, SourceLocation};
use super::start::start;
use crate::Ending;
use crate::Settings;
use crate::event::{Action, Event, Risk};
use crate::iso::dialects::facts::{Facts, Language};
use crate::iso::execution::state::State;
use crate::iso::execution::step::Control;
use crate::iso::execution::straight::StraightContinuation;
use crate::iso::language::Fault;
use crate::iso::language::arithmetic;
use crate::iso::language::block::Block;
use crate::iso::language::expression::Reader;
use crate::iso::language::parameters::{Parameters, Values};
use crate::iso::language::words::{G, Group, M};
use crate::kernel::corner::{Element, Shape};
use crate::kernel::{Channel, flow};
use geom::Vec3;
use program::{Diagnostic, Rule};
use std::collections::HashMap;
use std::ptr;

/// A program on its way through a control.
pub(crate) struct Run<'a, 's> {
    pub settings: &'a Settings,
    pub facts: &'static Facts,
    pub language: Language,
    pub control: Control,
    pub parameters: Parameters,
    pub block: Block<'a>,
    pub actions: Vec<Action>,
    /// The program itself.
    pub main: &'a Source<'a>,
    pub here: SourceLocation<'a>,
    /// The line that is run, and its number.
    pub(super) text: (&'a [u8], u32),
    /// The line of the program itself in which a call into another file is under way.
    pub caller: Option<u32>,
    pub frames: Vec<Frame<'a>>,
    /// Which of several O-words of a name (of a file, the first) has been run.
    pub twins: HashMap<(*const u8, usize), usize>,
    /// The program has jumped, called or calculated: what stands behind its end may belong to it.
    pub flows: bool,
    /// The program has ended, and what follows is no part of it.
    over: bool,
    /// The lines that have been read ahead.
    ahead: Ahead,
    /// The block before has moved, and straight moves go on behind it.
    continuation: Option<StraightContinuation>,
    /// The block whose corner waits for the next one.
    pub(super) held: Option<WaitingCorner>,
    /// Where the events go.
    pub(super) channel: &'a mut Channel<'s>,
}

/// A block whose corner waits for the next one.
pub(crate) struct WaitingCorner {
    /// Its cut.
    pub(super) action: Action,
    pub(super) element: Element,
    /// About which its arcs turn.
    pub(super) up: Vec3,
    pub(super) shape: Shape,
    pub(super) line: u32,
}

impl<'a, 's> Run<'a, 's> {
    /// At the start of `main`.
    pub(crate) fn new(
        facts: &'static Facts,
        settings: &'a Settings,
        main: &'a Source<'a>,
        ahead: Ahead,
        channel: &'a mut Channel<'s>,
    ) -> Run<'a, 's> {
        let here = SourceLocation { source: main, at: 0, line: 0, percent_signs: 0 };
        Run {
            settings,
            facts,
            language: facts.language,
            control: Control::new(settings, facts),
            parameters: Parameters::new(facts.language),
            block: Block::new(facts, settings),
            actions: Vec::new(),
            main,
            here,
            text: (b"", 0),
            caller: None,
            frames: vec![Frame::new(Kind::Main, here, here)],
            twins: HashMap::new(),
            flows: false,
            over: false,
            ahead,
            continuation: None,
            held: None,
            channel,
        }
    }

    /// Runs the program to its end.
    pub(crate) fn run(&mut self) -> Result<(), Fault> {
        while !self.over {
            let source = self.here.source;
            let from = self.here.at;
            if from >= source.text.len() {
                return self.end_of_text();
            }
            let plain = match self.facts.syntax.one_command {
                // Texts without brackets stand behind some of its words.
                true => None,
                false => self.ahead.line(&self.here, ptr::eq(source, self.main)),
            };
            let (text, line) = self.here.next(plain);
            self.text = (text, line);
            if plain.is_none() || !self.goes_on(text) {
                let is_plain = plain.is_some();
                self.line(from, text, line, is_plain).map_err(|fault| source.located(fault))?;
            }
            let line = self.caller.unwrap_or(line);
            for action in self.actions.drain(..) {
                if let Action::Compensation(side) = action {
                    let terms = self.control.state.compensation_terms();
                    self.channel.switch(line, side, terms)?;
                } else {
                    self.channel.take(Event { line, action })?;
                }
            }
        }
        Ok(())
    }

    /// The text has ended: so has the program, but not one that it has called.
    fn end_of_text(&mut self) -> Result<(), Fault> {
        if self.frames.len() == 1 {
            self.control.ends_no_curve().map_err(|message| self.at_line(Rule::Spline, message))?;
            if self.facts.syntax.ending == Ending::Text && !self.control.state.ended {
                let line = self.here.line.max(1);
                for risk in self.control.state.left_on(self.facts) {
                    self.channel.report(line, Action::Risk(risk.into()))?;
                }
                self.channel.report(line, Action::End)?;
            }
            return Ok(());
        }
        let end = match self.kind() == Kind::Subroutine {
            true => "endsub",
            false => "M99",
        };
        let message = format!("the called program ends without {end}");
        Err(self.here.source.located(self.at_line(Rule::Call, message)))
    }

    /// Whether the plain line `text` is a straight move behind another one: that has then been executed.
    fn goes_on(&mut self, text: &[u8]) -> bool {
        let Some(continuation) = &self.continuation else { return false };
        if text.len() > self.facts.words.longest {
            return false;
        }
        let Some(action) = self.control.go_on(continuation, self.ahead.words()) else {
            return false;
        };
        self.actions.push(action);
        true
    }

    /// Runs the line `text`, which begins at byte `from`; where it is plain, its words are known.
    fn line(
        &mut self,
        from: usize,
        text: &'a [u8],
        line: u32,
        is_plain: bool,
    ) -> Result<(), Fault> {
        self.continuation = None;
        self.is_short(from, text)?;
        if text.first() == Some(&b'%') && self.facts.syntax.percent {
            return self.percent(from, text, line);
        }
        if self.settings.setup.block_delete && text.trim_ascii_start().first() == Some(&b'/') {
            return Ok(());
        }
        if self.control.state.ended && self.ends_here(text) {
            self.over = true;
            return Ok(());
        }
        match self.language {
            Language::Ngc => {
                if let Some(o) = owords::at(text) {
                    return self.o_word(from, text, o);
                }
            }
            Language::MacroB => {
                if let Some(at) = numbers::at(text) {
                    return self.statement(from, text, at);
                }
            }
            Language::Rs274 | Language::Plain => {}
        }
        if is_plain {
            self.block.take_over(line, text, self.ahead.words())?;
        } else {
            let values = values(self.settings, &self.control.state, &self.parameters, line);
            self.block.read(line, text, 0, &values)?;
            self.assign()?;
            self.comments();
        }
        if self.block.is_empty {
            return Ok(());
        }
        self.execute()
    }

    /// # Errors
    /// The line `text`, which begins at byte `from`, is longer than the control reads, comments included. Behind the end it reads none.
    fn is_short(&self, from: usize, text: &[u8]) -> Result<(), Fault> {
        if self.control.state.ended {
            return Ok(());
        }
        let longest = self.facts.syntax.longest_line;
        let carriage_return = self.here.source.text.get(from + text.len()) == Some(&b'\r');
        let length = text.len() + usize::from(carriage_return);
        if length <= longest {
            return Ok(());
        }
        let message =
            format!("the line has {length} bytes with its blanks and comments, at most {longest}");
        Err(self.at_line(Rule::BlockLength, message))
    }

    /// `%` stands alone on its line, which begins at byte `from`; a program ends at the second, or at one behind its first block.
    /// LinuxCNC takes none behind the first block but the second ("Bad character '%' used", found with `rs274`).
    fn percent(&mut self, from: usize, text: &[u8], line: u32) -> Result<(), Fault> {
        let before = &self.here.source.text[..from];
        let is_late = self.here.percent_signs == 0
            && !self.control.state.ended
            && !before.trim_ascii().is_empty();
        if is_late && self.language == Language::Ngc {
            let fault = Diagnostic::error(
                Rule::Syntax,
                "% stands behind the first block of a program that does not begin with it",
            );
            let help = "begin the program with %, or leave both out";
            return Err(fault.help(help).at(line, text, 0, text.len()).into());
        }
        self.here.percent_signs += if is_late { 2 } else { 1 };
        let alone = text[1..].iter().all(|b| matches!(b, b' ' | b'\t'));
        if !alone || self.here.percent_signs > 2 {
            let message = "a line with % holds nothing else, and a program has two at most";
            let fault = Diagnostic::error(Rule::Syntax, message);
            return Err(fault.at(line, text, 0, text.len()).into());
        }
        if self.here.percent_signs == 2 && self.frames.len() > 1 {
            return self.end_of_text();
        }
        Ok(())
    }

    /// Whether what follows the end of the program is not its own: other programs, or what it has
    /// jumped over.
    fn ends_here(&self, text: &[u8]) -> bool {
        let (at, _) = start(text);
        let begins = matches!(text.get(at), Some(b'O' | b'o' | b':'));
        self.flows || begins && self.here.percent_signs < 2
    }

    /// What the block sets takes effect.
    fn assign(&mut self) -> Result<(), Fault> {
        for &(target, value) in &self.block.assignments {
            self.flows = true;
            let set = self.parameters.set(target, value);
            set.map_err(|message| self.block.whole(Rule::Parameter, message))?;
        }
        Ok(())
    }

    /// The block that has been read: its motion, and then where it leads.
    fn execute(&mut self) -> Result<(), Fault> {
        if self.control.state.ended || self.here.percent_signs == 2 {
            let message = "the program has ended before this block";
            return Err(self.block.whole(Rule::AfterEnd, message));
        }
        self.begin_program()?;
        if matches!(self.block.g(Group::Macro), Some(G::MacroCall { .. })) {
            return self.macro_call();
        }
        let flow = self.block.m(Group::Flow);
        let calls = matches!(flow, Some(M::Call | M::CallBlock));
        let call = if calls { Some(self.called_program()?) } else { None };
        let back = if flow == Some(M::Return) { self.whole_word(b'P')? } else { None };
        if flow == Some(M::End) && self.frames.iter().any(|frame| frame.modal.is_some()) {
            self.tell(Action::Risk(Risk::MODAL_MACRO.into()));
        }
        let corner = self.block.corner;
        let state = &self.control.state;
        let start =
            (corner.is_some() || self.held.is_some()).then(|| state.place.point(state.position));
        self.control.execute(&mut self.block, &mut self.actions)?;
        if let Some(start) = start {
            self.go_round(start, corner)?;
        }
        if self.block.g(Group::Macro) == Some(G::CancelMacroCall) {
            self.frame().modal = None;
        }
        if self.block.m(Group::Modes).is_some() {
            self.modes()?;
        }
        if let Some((place, turns)) = call {
            self.flows = true;
            let locals = None;
            return self
                .call(Kind::Subprogram, place, turns, locals)
                .map_err(|message| self.block.at_group(Group::Flow, Rule::Call, message));
        }
        if flow == Some(M::Return) {
            return self.back(back);
        }
        if self.frame().modal.is_none() && self.held.is_none() {
            self.continuation = StraightContinuation::behind(&self.block, &self.control.state);
        }
        self.after_move()
    }

    /// `O` names the program and stands at its start: another one is another program.
    fn begin_program(&mut self) -> Result<(), Fault> {
        let begun = std::mem::replace(&mut self.frame().begun, true);
        if self.block.has(b'O') && begun {
            let message = match self.kind() == Kind::Main {
                true => "another program begins here, and this one has no M30 before",
                false => "another program begins here, and the called one has no M99 before",
            };
            return Err(self.block.at_word(b'O', Rule::ProgramNumber, message));
        }
        match self.block.take(b'O') {
            Some(word) if arithmetic::whole(word.value).is_none() || word.point => {
                let message = "O must be a whole number";
                Err(self.block.at_word(b'O', Rule::Number, message))
            }
            _ => Ok(()),
        }
    }

    /// Goes on at a block of this file.
    pub(super) fn jump(&mut self, to: flow::BlockLocation) -> Result<(), Fault> {
        let again = self.here.at.saturating_sub(to.at);
        (self.here.at, self.here.line) = (to.at, to.line - 1);
        let counted = self.channel.budget.again(again);
        counted.map_err(|message| self.at_line(Rule::Endless, message))
    }

    /// What stands behind a statement: nothing but comments.
    pub(super) fn rest(&mut self, text: &'a [u8], at: usize) -> Result<(), Fault> {
        let line = self.here.line;
        let values = values(self.settings, &self.control.state, &self.parameters, line);
        self.block.read(line, text, at, &values)?;
        if !self.block.is_empty {
            return Err(self.wrong(text, at, "nothing but a comment may follow here"));
        }
        self.comments();
        Ok(())
    }

    /// The comments of the block as events.
    fn comments(&mut self) {
        for comment in self.block.comments() {
            let text = String::from_utf8_lossy(comment);
            let action = match text.split_once(',') {
                Some((head, message)) if head.trim().eq_ignore_ascii_case("MSG") => {
                    Action::Message(message.trim().into())
                }
                Some((head, message)) if self.language == Language::Ngc => {
                    match head.trim().to_ascii_lowercase().as_str() {
                        "debug" => Action::Message(self.shown(message).trim().into()),
                        "print" | "log" => Action::Comment(self.shown(message).trim().into()),
                        _ => Action::Comment(text.trim().into()),
                    }
                }
                _ => Action::Comment(text.trim().into()),
            };
            self.actions.push(action);
        }
        if let Some(message) = self.block.message() {
            self.actions.push(Action::Message(String::from_utf8_lossy(message).into()));
        }
    }

    /// A message with the values of its parameters.
    fn shown(&self, message: &str) -> String {
        let values = self.values();
        let (mut shown, mut at) = (String::new(), 0);
        while let Some(next) = message.get(at..).and_then(|rest| rest.find('#')) {
            shown.push_str(&message[at..at + next]);
            let from = at + next;
            let mut reader = Reader::new(&values, self.here.line, message.as_bytes(), from);
            match reader.value() {
                Ok(value) => shown.push_str(&format!("{:.6}", value.unwrap_or(0.0))),
                Err(_) => shown.push_str("######"),
            }
            at = reader.at.max(from + 1);
        }
        shown.push_str(message.get(at..).unwrap_or_default());
        shown
    }

    /// What expressions can read now.
    pub(super) fn values(&self) -> Values<'_> {
        values(self.settings, &self.control.state, &self.parameters, self.here.line)
    }

    /// The program that is under way.
    pub(super) fn frame(&mut self) -> &mut Frame<'a> {
        if self.frames.is_empty() {
            self.frames.push(Frame::new(Kind::Main, self.here, self.here));
        }
        let last = self.frames.len() - 1;
        &mut self.frames[last]
    }

    pub(super) fn kind(&self) -> Kind {
        self.frames.last().map_or(Kind::Main, |frame| frame.kind)
    }

    /// Whether what is under way has been called so.
    pub(super) fn is_within(&self, kind: Kind) -> bool {
        self.kind() == kind
    }

    /// Adds an event.
    pub(super) fn tell(&mut self, action: Action) {
        self.actions.push(action);
    }

    /// Reports what the program leaves on where `M99` begins it again.
    pub(super) fn leave_on(&mut self) {
        let left_on = self.control.state.left_on(self.facts);
        self.actions.extend(left_on.map(|risk| Action::Risk(risk.into())));
        if self.frames.iter().any(|frame| frame.modal.is_some()) {
            self.tell(Action::Risk(Risk::MODAL_MACRO.into()));
        }
    }

    /// What the comments of the block say.
    pub(super) fn comment(&self) -> String {
        let comments = self.block.comments().map(String::from_utf8_lossy);
        comments.collect::<Vec<_>>().join(" ")
    }

    /// A finding about the line that is run.
    pub(super) fn at_line(&self, rule: Rule, message: impl Into<String>) -> Fault {
        let (text, line) = self.text;
        Diagnostic::error(rule, message).at(line, text, 0, text.len()).into()
    }

    /// A finding in the line `text` from byte `at` on.
    pub(super) fn wrong(&self, text: &[u8], at: usize, message: impl Into<String>) -> Fault {
        let rule = if self.language == Language::Ngc { Rule::OWord } else { Rule::Macro };
        Diagnostic::error(rule, message).at(self.here.line, text, at, text.len()).into()
    }
}

/// What expressions can read.
fn values<'v>(
    settings: &'v Settings,
    state: &'v State,
    parameters: &'v Parameters,
    line: u32,
) -> Values<'v> {
    Values { parameters, system: state, fresh: settings.setup.start.is_some(), line }
}
