//! Statements of custom macro B: `#1 = ..`, `IF`, `GOTO`, `WHILE`, `DO`, `END` (B-63684EN, 16.3 and 16.5).
//!
//! Numbers of blocks and programs are looked up in the file when the first jump or call needs them.

use super::run::Run;
use super::source::{self, Source};
use crate::WholeNumbers;
use crate::event::{Action, Risk};
use crate::iso::language::arithmetic;
use crate::iso::language::block::{Fault, Word};
use crate::iso::language::expression::{Reader, Target};
use crate::iso::language::words::WHOLE_NUMBERS_HELP;
use crate::kernel::decimal;
use crate::kernel::flow::{self, BlockLocation, Labels, Structures};
use program::{Diagnostic, Rule};

/// What begins a statement.
const KEYWORDS: [(&[u8], Keyword); 10] = [
    (b"IF", Keyword::If),
    (b"WHILE", Keyword::While),
    (b"DO", Keyword::Do),
    (b"END", Keyword::End),
    (b"GOTO", Keyword::GoTo),
    (b"POPEN", Keyword::Print),
    (b"PCLOS", Keyword::Print),
    (b"DPRNT", Keyword::Print),
    (b"BPRNT", Keyword::Print),
    (b"SETVN", Keyword::Print),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Keyword {
    If,
    While,
    Do,
    End,
    GoTo,
    /// Goes to a printer or gives a name to a variable, and moves nothing.
    Print,
}

/// The numbers of programs and blocks and the loops of a file.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    /// Where each program begins.
    programs: Vec<usize>,
    by_number: Labels<u32>,
    blocks: Labels<u32>,
    /// Each `DO` and `END` by its number.
    loops: Structures<usize>,
}

/// Where the statement of a line stands, if the line is one.
pub(super) fn at(line: &[u8]) -> Option<usize> {
    let at = match line.first()? {
        b'#' => return Some(0),
        b' ' | b'\t' | b'/' | b'N' => source::start(line).0,
        b'A'..=b'Z' => 0,
        _ => return None,
    };
    match line.get(at)? {
        b'#' => Some(at),
        b'A'..=b'Z' if line.get(at + 1).is_some_and(u8::is_ascii_uppercase) => Some(at),
        _ => None,
    }
}

/// The keyword at `at` and its length.
fn keyword(line: &[u8], at: usize) -> Option<(Keyword, usize)> {
    let rest = line.get(at..)?;
    let found = KEYWORDS.iter().find(|(word, _)| rest.starts_with(word));
    found.map(|(word, keyword)| (*keyword, word.len()))
}

/// The number of a `DO` or `END` behind the keyword: 1, 2 or 3.
fn loop_number(line: &[u8], at: usize) -> Option<usize> {
    let rest = line.get(at..)?.trim_ascii_start();
    let number = decimal::parse(rest).filter(|n| matches!(n.value, 1.0 | 2.0 | 3.0) && !n.point)?;
    Some(number.value as usize)
}

/// The `DO` of a line that loops, the place behind it.
fn do_of(line: &[u8], at: usize) -> Option<usize> {
    match keyword(line, at)? {
        (Keyword::Do, length) => Some(at + length),
        (Keyword::While, _) => {
            // It stands behind the last bracket.
            let bracket = line.iter().rposition(|&b| b == b']')?;
            let rest = &line[bracket + 1..];
            let blanks = rest.iter().take_while(|b| matches!(b, b' ' | b'\t')).count();
            rest.get(blanks..)?.starts_with(b"DO").then_some(bracket + 1 + blanks + 2)
        }
        _ => None,
    }
}

impl Numbers {
    /// Finds the numbers and loops of `text`; those in blocks with `/` are none where block delete is on
    /// (`deletes`).
    pub(super) fn of(text: &[u8], deletes: bool) -> Result<Numbers, Fault> {
        let mut found = Numbers { programs: vec![0], ..Numbers::default() };
        let mut percent_signs = 0;
        for (place, after, content) in flow::lines(text) {
            percent_signs += u8::from(content.first() == Some(&b'%'));
            if percent_signs == 2 {
                break;
            }
            let deleted = deletes && content.trim_ascii_start().first() == Some(&b'/');
            let (start, number) = source::start(content);
            if deleted {
                continue;
            }
            if let Some(number) = number {
                found.blocks.add(number, place);
            }
            let fault = |message: &str| -> Fault {
                let fault = Diagnostic::error(Rule::Macro, message);
                fault.at(place.line, content, start, content.len()).into()
            };
            if let Some(b'O' | b':') = content.get(start) {
                let rest = content.get(start + 1..).unwrap_or_default();
                let number = decimal::parse(rest.trim_ascii_start());
                let Some(number) = number.and_then(|n| arithmetic::whole(n.value)) else {
                    return Err(fault("O needs the number of the program"));
                };
                found.programs.push(place.at);
                if !found.by_number.add(number, place) {
                    return Err(fault("two programs of this number are in the file"));
                }
                found.loops_end(text)?;
                continue;
            }
            let Some(statement) = at(content) else { continue };
            if let Some(behind) = do_of(content, statement) {
                let Some(number) = loop_number(content, behind) else {
                    return Err(fault("DO needs its number 1, 2 or 3"));
                };
                let loops = &found.loops;
                if loops.unclosed().any(|[first, _]| loops[first].word == number) {
                    return Err(fault("a loop of this number is around this one"));
                }
                found.loops.open(number, [place, after]);
            } else if let Some((Keyword::End, length)) = keyword(content, statement) {
                let begun = found.loops.unclosed().next_back();
                let begun = begun.map(|[first, _]| found.loops[first].word);
                let Some(number) =
                    begun.filter(|_| begun == loop_number(content, statement + length))
                else {
                    return Err(fault("END without its DO, or across another loop"));
                };
                found.loops.close(number, [place, after]);
            }
        }
        found.loops_end(text)?;
        Ok(found)
    }

    /// # Errors
    /// A loop has no end.
    fn loops_end(&self, text: &[u8]) -> Result<(), Fault> {
        let Some([begun, _]) = self.loops.unclosed().next() else { return Ok(()) };
        let place = self.loops[begun].place;
        let rest = text.get(place.at..).unwrap_or_default();
        let content = rest.split(|&b| b == b'\n').next().unwrap_or_default();
        let fault = Diagnostic::error(Rule::Macro, "the DO has no END");
        Err(fault.at(place.line, content, 0, content.len()).into())
    }

    /// The block of this number that a jump from byte `from` finds: downwards to the end of the program,
    /// then from its start.
    fn block(&self, number: u32, from: usize) -> Option<BlockLocation> {
        let program = self.programs.partition_point(|at| *at <= from).saturating_sub(1);
        let start = *self.programs.get(program)?;
        let end = self.programs.get(program + 1).copied().unwrap_or(usize::MAX);
        let find = |from| self.blocks.behind(&number, from).filter(|place| place.at < end);
        find(from).or_else(|| find(start))
    }
}

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
    ) -> Result<Result<source::SourceLocation<'a>, String>, Fault> {
        let source = self.here.source;
        let numbers = source.numbers(self.settings.setup.block_delete)?;
        Ok(match numbers.block(label, self.here.at) {
            Some(place) => Ok(source::SourceLocation::called(source, place)),
            None => Err(format!("there is no block N{label} in this program")),
        })
    }

    /// Where the program of this number begins: in this file, in the program's own, or in one of its
    /// name.
    pub(super) fn macro_program(
        &self,
        number: u32,
    ) -> Result<Result<source::SourceLocation<'a>, String>, Fault> {
        let deletes = self.settings.setup.block_delete;
        let find = |source: &'a Source<'a>| -> Result<Option<source::SourceLocation<'a>>, Fault> {
            let place = source.numbers(deletes)?.by_number.first(&number);
            Ok(place.map(|place| source::SourceLocation::called(source, place)))
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
