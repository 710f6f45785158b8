//! The run of a program: line after line, and the calls and jumps from one to another.

use super::block::{Block, Fault};
use super::execute::Control;
use super::expression::{self, Reader};
use super::macros;
use super::owords;
use super::parameters::{Language, Locals, Parameters, Values};
use super::source::{self, Place, Source};
use super::state::{Length, State};
use super::words::{Dictionary, Flavor, G, Group, M};
use crate::flow::Budget;
use crate::{Settings, Sink};
use std::collections::HashMap;

use program::{Compensation, Coolant, Diagnostic, Feed, Op, Record, Spindle};

/// How many calls LinuxCNC nests (`INTERP_SUB_ROUTINE_LEVELS` less that of the program).
const NGC_CALLS: usize = 9;

/// How many macros FANUC nests (B-64484EN, 16.6).
const MACRO_CALLS: usize = 5;

/// How many calls FANUC nests, macros and subprograms together (B-64484EN, 13.3 and 16.6).
const ALL_CALLS: usize = 15;

/// A program on its way through a control.
pub(super) struct Run<'a, 's> {
    pub settings: &'a Settings,
    dictionary: &'static Dictionary,
    pub language: Language,
    control: Control,
    pub parameters: Parameters,
    block: Block<'a>,
    ops: Vec<Op>,
    /// The program itself.
    pub main: &'a Source<'a>,
    pub here: Place<'a>,
    /// The line that is run, and its number.
    text: (&'a [u8], u32),
    /// The line of the program itself in which a call into another file is under way.
    caller: Option<u32>,
    frames: Vec<Frame<'a>>,
    budget: Budget,
    /// Which of several O-words of a name (of a file, the first) has been run.
    pub twins: HashMap<(*const u8, usize), usize>,
    /// The program has jumped, called or calculated: what stands behind its end may belong to it.
    pub flows: bool,
    /// The program has ended, and what follows is no part of it.
    over: bool,
    sink: &'s mut Sink<'s>,
}

/// What has been called, and how it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The program itself.
    Main,
    /// `o<name> call`.
    Subroutine,
    /// `M98`.
    Subprogram,
    /// `G65`, or after a move the macro of `G66` (`modal`).
    Macro { modal: bool },
}

/// A program that is under way.
pub(super) struct Frame<'a> {
    kind: Kind,
    /// Where its caller goes on.
    back: Place<'a>,
    caller: Option<u32>,
    begin: Place<'a>,
    /// How often it is still run, with this time.
    turns: u32,
    /// With which arguments.
    locals: Option<Locals>,
    /// A block of it has been executed.
    begun: bool,
    /// The `repeat` loops that are under way.
    pub repeats: Vec<Repeat>,
    /// The modes of `M70` or `M73`, and whether they come back at its end.
    modes: Option<(Box<State>, bool)>,
    /// The macro that is called after each move.
    modal: Option<Modal<'a>>,
}

/// A `repeat` under way.
pub(super) struct Repeat {
    /// Which of the O-words of the file.
    pub word: usize,
    /// How often it is still run, with this time.
    pub left: f64,
}

/// What `G66` has asked for.
struct Modal<'a> {
    place: Place<'a>,
    turns: u32,
    locals: Locals,
}

impl<'a> Frame<'a> {
    fn new(kind: Kind, begin: Place<'a>, back: Place<'a>) -> Frame<'a> {
        Frame {
            kind,
            back,
            caller: None,
            begin,
            turns: 1,
            locals: None,
            begun: false,
            repeats: Vec::new(),
            modes: None,
            modal: None,
        }
    }
}

impl<'a, 's> Run<'a, 's> {
    /// At the start of `main`.
    pub(super) fn new(
        settings: &'a Settings,
        main: &'a Source<'a>,
        sink: &'s mut Sink<'s>,
    ) -> Run<'a, 's> {
        let dictionary = Dictionary::of(settings.dialect);
        let language = dictionary.flavor.language();
        let here = Place { source: main, at: 0, line: 0, percent_signs: 0 };
        Run {
            settings,
            dictionary,
            language,
            control: Control::new(settings, dictionary.flavor),
            parameters: Parameters::new(language),
            block: Block::new(dictionary, &settings.auxiliary),
            ops: Vec::new(),
            main,
            here,
            text: (b"", 0),
            caller: None,
            frames: vec![Frame::new(Kind::Main, here, here)],
            budget: Budget::default(),
            twins: HashMap::new(),
            flows: false,
            over: false,
            sink,
        }
    }

    /// Runs the program to its end.
    pub(super) fn run(&mut self) -> Result<(), Fault> {
        while !self.over {
            let source = self.here.source;
            let from = self.here.at;
            let Some((text, line)) = self.here.next() else { return self.end_of_text() };
            self.text = (text, line);
            self.line(from, text, line).map_err(|fault| source.located(fault))?;
            let line = self.caller.unwrap_or(line);
            for op in self.ops.drain(..) {
                self.budget.record();
                (self.sink)(Record { line, op })?;
            }
        }
        Ok(())
    }

    /// The text has ended: so has the program, but not one that it has called.
    fn end_of_text(&self) -> Result<(), Fault> {
        if self.frames.len() == 1 {
            return Ok(());
        }
        let end = match self.kind() {
            Kind::Subroutine => "endsub",
            _ => "M99",
        };
        let message = format!("the called program ends without {end}");
        Err(self.here.source.located(self.at_line("nc-call", message)))
    }

    fn line(&mut self, from: usize, text: &'a [u8], line: u32) -> Result<(), Fault> {
        if text.first() == Some(&b'%') && self.dictionary.flavor != Flavor::Grbl {
            return self.percent(text, line);
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
                if let Some(at) = macros::at(text) {
                    return self.statement(from, text, at);
                }
            }
            Language::Plain => {}
        }
        let values = values(self.settings, &self.control.state, &self.parameters, line);
        self.block.read(line, text, 0, &values)?;
        self.assign()?;
        self.comments();
        if self.block.is_empty {
            return Ok(());
        }
        self.execute()
    }

    /// `%` stands alone on its line; a program ends at the second.
    fn percent(&mut self, text: &[u8], line: u32) -> Result<(), Fault> {
        self.here.percent_signs += 1;
        let alone = text[1..].iter().all(|b| matches!(b, b' ' | b'\t'));
        if !alone || self.here.percent_signs > 2 {
            let message = "a line with % holds nothing else, and a program has two at most";
            let fault = Diagnostic::error("nc-syntax", message);
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
        let (at, _) = source::start(text);
        let begins = matches!(text.get(at), Some(b'O' | b'o' | b':'));
        self.flows || begins && self.here.percent_signs < 2
    }

    /// What the block sets takes effect.
    fn assign(&mut self) -> Result<(), Fault> {
        for &(target, value) in &self.block.assignments {
            self.flows = true;
            let set = self.parameters.set(target, value);
            set.map_err(|message| self.block.whole("nc-parameter", message))?;
        }
        Ok(())
    }

    /// The block that has been read: its motion, and then where it leads.
    fn execute(&mut self) -> Result<(), Fault> {
        if self.control.state.ended || self.here.percent_signs == 2 {
            let message = "the program has ended before this block";
            return Err(self.block.whole("nc-after-end", message));
        }
        self.begin_program()?;
        if matches!(self.block.g(Group::Macro), Some(G::MacroCall { .. })) {
            return self.macro_call();
        }
        let flow = self.block.m(Group::Flow);
        let call = if flow == Some(M::Call) { Some(self.called_program()?) } else { None };
        let back = if flow == Some(M::Return) { self.whole_word(b'P')? } else { None };
        self.control.execute(&mut self.block, &mut self.ops)?;
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
                .map_err(|message| self.block.at_group(Group::Flow, "nc-call", message));
        }
        if flow == Some(M::Return) {
            return self.back(back);
        }
        self.after_move()
    }

    /// `O` names the program and stands at its start: another one is another program.
    fn begin_program(&mut self) -> Result<(), Fault> {
        let begun = std::mem::replace(&mut self.frame().begun, true);
        if self.block.has(b'O') && begun {
            let message = match self.kind() {
                Kind::Main => "another program begins here, and this one has no M30 before",
                _ => "another program begins here, and the called one has no M99 before",
            };
            return Err(self.block.at_word(b'O', "nc-program-number", message));
        }
        match self.block.take(b'O') {
            Some(word) if expression::whole(word.value).is_none() || word.point => {
                let message = "O must be a whole number";
                Err(self.block.at_word(b'O', "nc-number", message))
            }
            _ => Ok(()),
        }
    }

    /// The subprogram of `M98 P L` and how often it is run.
    fn called_program(&mut self) -> Result<(Place<'a>, u32), Fault> {
        let fault =
            |block: &Block, message: String| block.at_group(Group::Flow, "nc-call", message);
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
        // Without L: four digits of the program behind those of the repeats.
        let (program, turns) = match turns {
            Some(turns) => (program, turns),
            None if program > 9999 => (program % 10_000, program / 10_000),
            None => (program, 1),
        };
        if turns == 0 {
            return Err(fault(&self.block, "a subprogram is run once at least".into()));
        }
        let place = self.macro_program(program)?;
        Ok((place.map_err(|message| fault(&self.block, message))?, turns))
    }

    /// The whole number of this letter of the block.
    pub(super) fn whole_word(&mut self, letter: u8) -> Result<Option<u32>, Fault> {
        let Some(word) = self.block.take(letter) else { return Ok(None) };
        match expression::whole(word.value).filter(|_| !word.point) {
            Some(value) => Ok(Some(value)),
            None => {
                let message = format!("{} must be a whole number", char::from(letter));
                Err(self.block.at_word(letter, "nc-number", message))
            }
        }
    }

    /// `G65` calls a macro, `G66` asks for it after each move.
    fn macro_call(&mut self) -> Result<(), Fault> {
        self.flows = true;
        let fault =
            |block: &Block, message: String| block.at_group(Group::Macro, "nc-call", message);
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
        for &(letter, word) in &self.block.arguments {
            let value = self.argument(letter, word)?;
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
                return Err(self.block.at_group(Group::Macro, "nc-call", message));
            };
            *place = Some(value);
        }
        Ok(locals)
    }

    /// After a move the macro of `G66` is called.
    fn after_move(&mut self) -> Result<(), Fault> {
        let moves = |op: &Op| op.pose().is_some() || matches!(op, Op::Home(_));
        let Some(modal) = self.frames.last().and_then(|frame| frame.modal.as_ref()) else {
            return Ok(());
        };
        if !self.ops.iter().any(moves) {
            return Ok(());
        }
        let (place, turns, locals) = (modal.place, modal.turns, modal.locals);
        self.call(Kind::Macro { modal: true }, place, turns, Some(locals))
            .map_err(|message| self.block.whole("nc-call", message))
    }

    /// Calls what begins at `place`, `turns` times, with these local values or those of the caller.
    ///
    /// # Errors
    /// Calls nest too deep.
    pub(super) fn call(
        &mut self,
        kind: Kind,
        place: Place<'a>,
        turns: u32,
        locals: Option<Locals>,
    ) -> Result<(), String> {
        if turns == 0 {
            return Ok(());
        }
        self.budget.jump()?;
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
        self.budget.jump().map_err(|message| self.at_line("nc-endless", message))?;
        let modes = match self.frame().modes.take() {
            Some((modes, true)) => Some(modes),
            _ => None,
        };
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
            return again.map_err(|message| self.block.whole("nc-call", message));
        }
        Ok(())
    }

    /// `M99`: to the caller; with P to a block of its.
    fn back(&mut self, label: Option<u32>) -> Result<(), Fault> {
        self.flows = true;
        let fault = |run: &Self, message: &str| run.block.at_group(Group::Flow, "nc-call", message);
        match (self.kind(), label) {
            (Kind::Main, None) => {
                Err(fault(self, "M99 in the program itself runs it again without end; write M30"))
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

    /// `M70` to `M73`.
    fn modes(&mut self) -> Result<(), Fault> {
        match self.block.m(Group::Modes) {
            Some(M::SaveModes { until_return }) => {
                let state = Box::new(self.control.state);
                self.frame().modes = Some((state, until_return));
                Ok(())
            }
            Some(M::ForgetModes) => {
                self.frame().modes = None;
                Ok(())
            }
            _ => match self.frame().modes.take() {
                Some((modes, until_return)) => {
                    self.restore(&modes)?;
                    self.frame().modes = Some((modes, until_return));
                    Ok(())
                }
                None => {
                    let message = "M72, and no M70 or M73 has kept the modes";
                    Err(self.block.at_group(Group::Modes, "nc-modes", message))
                }
            },
        }
    }

    /// The modes become what they were, but for the motion word (LinuxCNC manual, "M70 Save Modal
    /// State"), as by words in blocks: first the modes, then the numbers in their units.
    fn restore(&mut self, kept: &State) -> Result<(), Fault> {
        let (line, text) = (self.block.line, self.block.text);
        let now = self.control.state;
        let fault = |run: &Self, what: &str| {
            let message = format!("{what} has changed since it was kept, and is not brought back");
            run.block.whole("nc-modes", message)
        };
        if now.compensation.asked != kept.compensation.asked
            && kept.compensation.asked != Compensation::Off
        {
            return Err(fault(self, "radius compensation"));
        }
        if now.length != kept.length && kept.length != Length::None {
            return Err(fault(self, "the length offset"));
        }
        self.block.clear(line, text);
        let block = &mut self.block;
        if let Some(inches) = kept.inches {
            block.put_g(Group::Units, G::Inches(inches));
        }
        block.put_g(Group::Plane, G::Plane(kept.plane));
        block.put_g(Group::Distance, G::Incremental(kept.incremental));
        block.put_g(Group::ArcDistance, G::CentersAbsolute(kept.centers_absolute));
        block.put_g(Group::FeedMode, G::FeedMode(kept.feed_mode));
        if let Some(to_r) = kept.return_to_r {
            block.put_g(Group::Return, G::ReturnToR(to_r));
        }
        if let Some(offset) = kept.work_offset {
            block.put_g(Group::WorkOffset, G::WorkOffset(offset));
        }
        if now.compensation.asked != kept.compensation.asked {
            block.put_g(Group::Compensation, G::Compensation(super::words::Side::Off));
        }
        if now.length != kept.length {
            block.put_g(Group::Length, G::CancelLength);
        }
        self.control.execute(&mut self.block, &mut self.ops)?;
        self.block.clear(line, text);
        let block = &mut self.block;
        let unit = if kept.inches == Some(true) { super::execute::INCH } else { 1.0 };
        match kept.feed {
            Some(Feed::PerMinute(feed) | Feed::PerTurn(feed)) => block.put(b'F', feed / unit),
            Some(Feed::InverseTime(feed)) => block.put(b'F', feed),
            None => {}
        }
        if let Some(speed) = kept.speed {
            block.put(b'S', speed);
        }
        block.put_m(
            Group::Spindle,
            match kept.spindle {
                Spindle::Off => M::SpindleOff,
                Spindle::Clockwise(_) => M::Clockwise,
                Spindle::CounterClockwise(_) => M::CounterClockwise,
            },
        );
        block.put_m(
            Group::Coolant,
            match kept.coolant {
                Coolant::Mist => M::Mist,
                Coolant::Flood => M::Flood,
                Coolant::Off | Coolant::Through => M::CoolantOff,
            },
        );
        self.control.execute(&mut self.block, &mut self.ops)
    }

    /// Goes on at byte `at`, behind line `line`.
    pub(super) fn jump(&mut self, at: usize, line: u32) -> Result<(), Fault> {
        (self.here.at, self.here.line) = (at, line);
        self.budget.jump().map_err(|message| self.at_line("nc-endless", message))
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

    /// The comments of the block as records.
    fn comments(&mut self) {
        for comment in self.block.comments() {
            let text = String::from_utf8_lossy(comment);
            let op = match text.split_once(',') {
                Some((head, message)) if head.trim().eq_ignore_ascii_case("MSG") => {
                    Op::Message(message.trim().into())
                }
                Some((head, message)) if self.language == Language::Ngc => {
                    match head.trim().to_ascii_lowercase().as_str() {
                        "debug" => Op::Message(self.shown(message).trim().into()),
                        "print" | "log" => Op::Comment(self.shown(message).trim().into()),
                        _ => Op::Comment(text.trim().into()),
                    }
                }
                _ => Op::Comment(text.trim().into()),
            };
            self.ops.push(op);
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

    fn kind(&self) -> Kind {
        self.frames.last().map_or(Kind::Main, |frame| frame.kind)
    }

    /// Whether what is under way has been called so.
    pub(super) fn is_within(&self, kind: Kind) -> bool {
        self.kind() == kind
    }

    /// Adds a record.
    pub(super) fn tell(&mut self, op: Op) {
        self.ops.push(op);
    }

    /// What the comments of the block say.
    pub(super) fn comment(&self) -> String {
        let comments = self.block.comments().map(String::from_utf8_lossy);
        comments.collect::<Vec<_>>().join(" ")
    }

    /// A finding about the line that is run.
    pub(super) fn at_line(&self, rule: &'static str, message: impl Into<String>) -> Fault {
        let (text, line) = self.text;
        Diagnostic::error(rule, message).at(line, text, 0, text.len()).into()
    }

    /// A finding in the line `text` from byte `at` on.
    pub(super) fn wrong(&self, text: &[u8], at: usize, message: impl Into<String>) -> Fault {
        let rule = if self.language == Language::Ngc { "nc-o-word" } else { "nc-macro" };
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
    let setup = &settings.setup;
    Values { parameters, state, tools: &setup.tools, fresh: setup.start.is_some(), line }
}
