//! Statements of custom macro B: `#1 = ..`, `IF`, `GOTO`, `WHILE`, `DO`, `END` (B-63684EN, 16.3 and 16.5).
//!
//! Numbers of blocks and programs are looked up in the file when the first jump or call needs them.

use super::numbers::{Keyword, do_of, keyword};
use super::run::Run;
use super::source::{Source, SourceLocation};
use crate::WholeNumbers;
use crate::event::{Action, Risk};
use crate::iso::language::Fault;
use crate::iso::language::block::Word;
use crate::iso::language::expression::Reader;
use crate::iso::language::value::Target;
use crate::iso::language::words::WHOLE_NUMBERS_HELP;
use program::{Diagnostic, Rule};

/// The local variable of an argument's letter (argument specification I; B-63684EN, 16.6).
pub(super) fn variable_of(letter: u8) -> Option<usize> {
    Some(match letter {
        b'A'..=b'C' => usize::from(letter - b'A') + 1,
        b'D'..=b'F' => usize::from(letter - b'D') + 7,
        b'H' => 11,
        b'M' => 13,
        b'Q'..=b'Z' => usize::from(letter - b'Q') + 17,
        _ => return None,
    })
}

impl<'a> Run<'a, '_> {
    /// Runs the line `text`, whose statement stands at `at`; the line began at byte `from`.
    pub(super) fn statement(
        &mut self,
        from: usize,
        text: &'a [u8],
        at: usize,
    ) -> Result<(), Fault> {
        self.flows = true;
        let deletes = self.settings.setup.block_delete;
        if text.get(at) == Some(&b'#') {
            return self.set_variable(text, at);
        }
        let Some((keyword, length)) = keyword(text, at) else {
            return Err(self.wrong(text, at, "no statement of a macro begins so"));
        };
        let behind = at + length;
        match keyword {
            Keyword::If => {
                let (holds, at) = self.condition(text, behind)?;
                if text.get(at..).is_some_and(|rest| rest.starts_with(b"GOTO")) {
                    let (label, behind) = self.label(text, at + 4)?;
                    self.rest(text, behind)?;
                    return if holds { self.go_to_from(from, label) } else { Ok(()) };
                }
                if !text.get(at..).is_some_and(|rest| rest.starts_with(b"THEN")) {
                    return Err(self.wrong(text, at, "IF [..] needs GOTO or THEN"));
                }
                let values = self.values();
                let reader = &mut Reader::new(&values, self.here.line, text, at + 4);
                match (reader.peek(), holds) {
                    (_, false) => Ok(()),
                    (Some(b'#'), true) => {
                        let at = reader.at;
                        self.set_variable(text, at)
                    }
                    _ => Err(reader.wrong("THEN sets a variable: THEN #1 = 2")),
                }
            }
            Keyword::GoTo => {
                let (label, behind) = self.label(text, behind)?;
                self.rest(text, behind)?;
                self.go_to_from(from, label)
            }
            Keyword::While | Keyword::Do => {
                let numbers = self.here.source.numbers(deletes)?;
                let holds = keyword == Keyword::Do || self.condition(text, behind)?.0;
                if let Some(behind) = do_of(text, at) {
                    let number = text.get(behind..).unwrap_or_default();
                    let blanks = number.len() - number.trim_ascii_start().len();
                    self.rest(text, behind + blanks + 1)?;
                } else {
                    return Err(self.wrong(text, at, "WHILE [..] needs DO"));
                }
                match numbers.loops.partner(from) {
                    Some(end) if !holds => self.jump(end.after),
                    _ => Ok(()),
                }
            }
            Keyword::End => match self.here.source.numbers(deletes)?.loops.partner(from) {
                Some(begun) => self.jump(begun.place),
                None => Err(self.wrong(text, at, "END without its DO")),
            },
            Keyword::Print => {
                let shown = String::from_utf8_lossy(text.get(at..).unwrap_or_default());
                self.tell(Action::Comment(shown.trim().into()));
                Ok(())
            }
        }
    }

    /// `#1 = 2`, also where a system variable does something.
    fn set_variable(&mut self, text: &'a [u8], at: usize) -> Result<(), Fault> {
        let line = self.here.line;
        let (target, value, behind) = {
            let values = self.values();
            let mut reader = Reader::new(&values, line, text, at + 1);
            let target = reader.target()?;
            if !reader.take(b'=') {
                return Err(reader.wrong("= is missing"));
            }
            (target, reader.formula()?, reader.at)
        };
        self.rest(text, behind)?;
        let Target::Number(number) = target else { return Ok(()) };
        let code = value.unwrap_or(0.0);
        match number {
            // The comment is the message (B-63684EN, 16.2).
            3000 => {
                let message =
                    format!("the program raises alarm {}: {}", 3000.0 + code, self.comment());
                Err(Diagnostic::error(Rule::Alarm, message).at(line, text, at, text.len()).into())
            }
            3006 => {
                if self.control.state.is_running() && self.facts.functions.stop_leaves_on {
                    self.tell(Action::Risk(Risk::STOP_RUNNING.into()));
                }
                self.tell(Action::Stop);
                Ok(())
            }
            3003 | 3004 if code != 0.0 => {
                self.tell(Action::Risk(Risk::OPERATOR_CONTROLS.into()));
                Ok(())
            }
            // Clocks, and the keys of the operator given back.
            3001..=3004 | 3011 | 3012 => Ok(()),
            0 => Err(self.wrong(text, at, "#0 is null and cannot be set")),
            // Common variables that stay when the power is off (B-64484EN-2, "Variables"; Haas, "Macro Variable Table").
            500..=999 => {
                self.tell(Action::Risk(Risk::KEPT_VARIABLE.into()));
                self.parameters.set(target, value).map_err(|message| self.wrong(text, at, message))
            }
            _ => {
                self.parameters.set(target, value).map_err(|message| self.wrong(text, at, message))
            }
        }
    }

    /// The condition in brackets at `at` and the place behind it.
    fn condition(&mut self, text: &'a [u8], at: usize) -> Result<(bool, usize), Fault> {
        let values = self.values();
        let mut reader = Reader::new(&values, self.here.line, text, at);
        let value = reader.expression()?;
        reader.peek();
        Ok((value.unwrap_or(0.0) != 0.0, reader.at))
    }

    /// The number of a block at `at` and the place behind it.
    fn label(&mut self, text: &'a [u8], at: usize) -> Result<(u32, usize), Fault> {
        let values = self.values();
        let mut reader = Reader::new(&values, self.here.line, text, at);
        let label = reader.whole("the number of a block")?;
        Ok((label, reader.at))
    }

    /// Goes on at the block N of this number, looked for from here.
    pub(super) fn go_to(&mut self, label: u32) -> Result<(), Fault> {
        self.go_to_from(self.here.at, label)
    }

    /// Goes on at the block N of this number, looked for from byte `from` on.
    fn go_to_from(&mut self, from: usize, label: u32) -> Result<(), Fault> {
        let numbers = self.here.source.numbers(self.settings.setup.block_delete)?;
        let Some(place) = numbers.block(label, from) else {
            let message = format!("there is no block N{label} in this program");
            return Err(self.at_line(Rule::Macro, message));
        };
        if !numbers.loops.may_jump(from, place.at) {
            let message = format!("N{label} is inside of a loop: a jump into it is not allowed");
            return Err(self.at_line(Rule::Macro, message));
        }
        self.jump(place)
    }

    /// Where the block N of this number is (Haas `M97`).
    pub(super) fn block_of_program(
        &self,
        label: u32,
    ) -> Result<Result<SourceLocation<'a>, String>, Fault> {
        let source = self.here.source;
        let numbers = source.numbers(self.settings.setup.block_delete)?;
        Ok(match numbers.block(label, self.here.at) {
            Some(place) => Ok(SourceLocation::called(source, place)),
            None => Err(format!("there is no block N{label} in this program")),
        })
    }

    /// Where the program of this number begins: in this file, in the program's own, or in one of its
    /// name.
    pub(super) fn macro_program(
        &self,
        number: u32,
    ) -> Result<Result<SourceLocation<'a>, String>, Fault> {
        let deletes = self.settings.setup.block_delete;
        let find = |source: &'a Source<'a>| -> Result<Option<SourceLocation<'a>>, Fault> {
            let place = source.numbers(deletes)?.by_number.first(&number);
            Ok(place.map(|place| SourceLocation::called(source, place)))
        };
        for source in [self.here.source, self.main] {
            if let Some(place) = find(source)? {
                return Ok(Ok(place));
            }
        }
        let names = ["", ".nc", ".NC"].map(|ending| format!("O{number:04}{ending}"));
        match self.main.open(&self.settings.setup.folders, &names) {
            Ok(source) => Ok(match find(source)? {
                Some(place) => Ok(place),
                None => Err(format!("{} does not hold the program O{number}", source.name)),
            }),
            Err(missing) => Ok(Err(format!("no program O{number} in this file, and {missing}"))),
        }
    }

    /// The value of an argument. Without a point it counts as a length does; letters of numbers count
    /// as they are.
    pub(super) fn argument(&self, word: Word) -> Result<f64, Fault> {
        let counts = matches!(word.letter, b'D' | b'H' | b'M' | b'S' | b'T');
        if counts || word.is_in_units() || word.value == 0.0 {
            return Ok(word.value);
        }
        match self.settings.setup.whole_numbers {
            WholeNumbers::Units => Ok(word.value),
            WholeNumbers::Increments => self.increments(word),
            WholeNumbers::Unknown => {
                let message = format!(
                    "argument {} has no decimal point: units or increments, as the machine is set",
                    char::from(word.letter)
                );
                let fault = self.at_line(Rule::DecimalPoint, message);
                Err(fault.help(WHOLE_NUMBERS_HELP).into())
            }
        }
    }

    /// An argument without a point counts least input increments of its address (B-63684EN, 16.6): of a length or of an
    /// angle. Which those of E and F are, and those of A, B and C with inches, depends on the machine.
    fn increments(&self, word: Word) -> Result<f64, Fault> {
        let is_angle = matches!(word.letter, b'A'..=b'C');
        match (self.control.state.inches, word.letter) {
            (_, b'E' | b'F') => {}
            (Some(false), _) => return Ok(word.value / 1000.0),
            (Some(true), _) if !is_angle => return Ok(word.value / 10_000.0),
            (None, _) if !is_angle => {
                let message = format!(
                    "argument {} counts increments, and neither G20 nor G21 has been given",
                    char::from(word.letter)
                );
                return Err(self.at_line(Rule::Units, message).help("write G20 or G21").into());
            }
            _ => {}
        }
        let message = format!(
            "argument {} has no decimal point: what it counts depends on the machine",
            char::from(word.letter)
        );
        Err(self.at_line(Rule::DecimalPoint, message).help("write the point").into())
    }
}
