//! The words of a block, read from left to right, each once.

use super::block::{Block, Coordinate, Count, ToolCall};
use super::call::{self, Call};
use super::commands::{self, Code, GROUPS};
use super::definition::Filling;
use super::expression::Evaluator;
use super::functions;
use super::scan::Scanner;
use super::settings;
use super::statement;
use super::structure::Word;
use super::variables::{AssignmentTarget, Readable};
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use program::Rule;

impl Block {
    /// Reads a block. Expressions have the values before it.
    ///
    /// # Errors
    /// The first word that is not understood, repeated, or against the rules of a block.
    pub fn read(&mut self, source: Source, state: &dyn Readable) -> Outcome {
        *self = Block::empty();
        let mut reader = Reader { scanner: Scanner::new(source), state, block: self };
        reader.scanner.head()?;
        loop {
            reader.scanner.blanks();
            match reader.scanner.peek() {
                0 if reader.scanner.at >= source.text.len() => return Ok(()),
                b';' => {
                    reader.comment();
                    return Ok(());
                }
                _ => {
                    let first = !std::mem::replace(&mut reader.block.any, true);
                    reader.word(first)?;
                }
            }
        }
    }
}

pub(super) struct Reader<'a, 'b> {
    pub(super) scanner: Scanner<'a>,
    pub(super) state: &'a dyn Readable,
    pub(super) block: &'b mut Block,
}

impl Reader<'_, '_> {
    fn comment(&mut self) {
        let bytes = self.scanner.source.text.get(self.scanner.at + 1..).unwrap_or(&[]);
        self.block.comment = Some(String::from_utf8_lossy(bytes).trim().to_owned());
        self.scanner.at = self.scanner.source.text.len();
    }

    fn word(&mut self, first: bool) -> Outcome {
        let letter = self.scanner.peek();
        if letter == b'$' {
            return self.assignment();
        }
        if !letter.is_ascii_alphabetic() && letter != b'_' {
            let message = match letter {
                b'(' => "a comment starts with ';'",
                _ => "this character does not belong in a block",
            };
            return Err(self.scanner.error_here(Rule::Syntax, message));
        }
        let next = self.scanner.peek_at(1);
        if letter == b'_' || next == b'_' || next.is_ascii_alphabetic() {
            self.named_word(first)
        } else {
            self.address_word(letter, first)
        }
    }

    /// A letter and a number, `=` and an expression, or an extension, `=` and an expression.
    #[inline]
    fn address_word(&mut self, letter: u8, first: bool) -> Outcome {
        let start = self.scanner.at;
        if letter == b'R' {
            return self.assignment();
        }
        self.scanner.at += 1;
        if let Some(extension) = self.extension() {
            return self.extended_word(start, letter, extension);
        }
        match letter {
            b'G' => {
                self.scanner.blanks();
                let number = self.scanner.integer()?;
                self.numbered_command(start, number)
            }
            b'X'..=b'Z' => self.axis(start, usize::from(letter - b'X')),
            b'A'..=b'C' => self.axis(start, usize::from(letter - b'A') + 3),
            b'I'..=b'K' => {
                let value = self.coordinate()?;
                let place = &mut self.block.center[usize::from(letter - b'I')];
                let repeated = place.replace(value).is_some();
                self.once(start, repeated)
            }
            b'F' => {
                let value = self.value()?;
                let repeated = self.block.feed.replace(value).is_some();
                self.once(start, repeated)
            }
            b'S' => {
                let value = self.value()?;
                let repeated = self.block.speed.replace(value).is_some();
                self.once(start, repeated)
            }
            b'D' => {
                let value = self.whole(start)?;
                let repeated = self.block.edge.replace(value).is_some();
                self.once(start, repeated)
            }
            b'T' => {
                let tool = self.tool(start)?;
                let repeated = self.block.tool.replace(tool).is_some();
                self.once(start, repeated)
            }
            b'M' => {
                let number = self.whole(start)?;
                self.m_function(start, number)
            }
            b'L' if first && self.scanner.digit_next() => {
                while self.scanner.digit_next() {
                    self.scanner.at += 1;
                }
                self.program_call(start)
            }
            b'H' => {
                let message = "H is not supported: it tells the builder's program a number";
                Err(self.scanner.error_since(start, Rule::Unsupported, message))
            }
            b'N' => Err(self.scanner.error_since(
                start,
                Rule::Syntax,
                "a block number stands once, at the start of the block",
            )),
            _ => {
                let message = format!("there is no address {}", letter as char);
                Err(self.scanner.error_since(start, Rule::UnknownWord, message))
            }
        }
    }

    /// The digit of an address with a numeric extension (`A3=`), only where `=` follows.
    #[inline]
    fn extension(&mut self) -> Option<u8> {
        let digit = self.scanner.peek();
        if !digit.is_ascii_digit() || self.scanner.peek_at(1) != b'=' {
            return None;
        }
        self.scanner.at += 1;
        Some(digit - b'0')
    }

    fn extended_word(&mut self, start: usize, letter: u8, extension: u8) -> Outcome {
        match (letter, extension) {
            (b'A'..=b'C', 3) => {
                let value = self.value()?;
                let place = &mut self.block.vector[usize::from(letter - b'A')];
                let repeated = place.replace(value).is_some();
                self.once(start, repeated)
            }
            (b'I'..=b'K', 1) => {
                let value = self.coordinate()?;
                let place = &mut self.block.through[usize::from(letter - b'I')];
                let repeated = place.replace(value).is_some();
                self.once(start, repeated)
            }
            (b'X'..=b'Z' | b'A'..=b'C', 1) => {
                self.value()?;
                let index = if letter >= b'X' { letter - b'X' } else { letter - b'A' + 3 };
                let place = &mut self.block.machine_axes[usize::from(index)];
                let repeated = std::mem::replace(place, true);
                self.once(start, repeated)
            }
            // Spindle 1 is the master spindle.
            (b'S', 1) => {
                let value = self.value()?;
                let repeated = self.block.speed.replace(value).is_some();
                self.once(start, repeated)
            }
            (b'M', 1) => {
                let number = self.whole(start)?;
                if !matches!(number, 3..=5) {
                    let message = format!("M1={number}: only M1=3, M1=4, M1=5 concern the spindle");
                    return Err(self.scanner.error_since(start, Rule::UnknownWord, message));
                }
                self.m_function(start, number)
            }
            _ => {
                let message = format!("there is no address {}{extension}", letter as char);
                Err(self.scanner.error_since(start, Rule::UnknownWord, message))
            }
        }
    }

    /// `R1=...`, `NAME[1]=...`, `$P_...=...`.
    fn assignment(&mut self) -> Outcome {
        let start = self.scanner.at;
        let evaluator = Evaluator::new(self.state, &self.block.assigned);
        let place = evaluator.place(&mut self.scanner)?;
        self.scanner.expect(b'=')?;
        let at = self.scanner.at;
        let (kind, room) = evaluator.room(place);
        let filling = match room {
            0 | 1 => None,
            _ => Filling::read(&mut self.scanner, &evaluator)?,
        };
        let wrong = |scanner: &Scanner, message| scanner.error_since(at, Rule::Type, message);
        let repeated = self.block.assigned.iter().any(|(p, _)| *p == place);
        match (filling, place) {
            (Some(filling), AssignmentTarget::Element(index, element)) => {
                let elements = filling
                    .elements(kind, room)
                    .map_err(|message| wrong(&self.scanner, message))?;
                let places = elements
                    .into_iter()
                    .map(|(i, value)| (AssignmentTarget::Element(index, element + i), value));
                self.block.assigned.extend(places);
            }
            _ => {
                let value = kind.keep(evaluator.value(&mut self.scanner)?);
                let value = value.map_err(|message| wrong(&self.scanner, message))?;
                self.block.assigned.push((place, value));
            }
        }
        self.once(start, repeated)
    }

    fn program_call(&mut self, start: usize) -> Outcome {
        let evaluator = Evaluator::new(self.state, &self.block.assigned);
        let call = statement::program_call(&mut self.scanner, &evaluator, start)?;
        self.block.statement = Some(call.into());
        Ok(())
    }

    fn axis(&mut self, start: usize, index: usize) -> Outcome {
        let value = self.offset_coordinate(index >= 3)?;
        let repeated = match self.block.axes.get_mut(index) {
            Some(place) => place.replace(value).is_some(),
            None => false,
        };
        self.once(start, repeated)
    }

    /// The value of an address that may stand in `AC()`, `IC()` ...
    #[inline]
    fn coordinate(&mut self) -> Outcome<Coordinate> {
        self.offset_coordinate(false)
    }

    /// The same, to which the operator's offset may be added where `may`.
    #[inline]
    fn offset_coordinate(&mut self, may: bool) -> Outcome<Coordinate> {
        if self.scanner.take(b'=') {
            return self.counted(may);
        }
        let value = self.constant()?;
        Ok(Coordinate { count: Count::Modal, value, offset: None })
    }

    /// The same behind its `=`.
    pub(super) fn counted(&mut self, may: bool) -> Outcome<Coordinate> {
        self.scanner.blanks();
        let back = self.scanner.at;
        if self.scanner.peek().is_ascii_alphabetic()
            && self.scanner.peek_at(1).is_ascii_alphabetic()
        {
            let name = self.scanner.name()?;
            let count = COUNTS.iter().find(|(n, _)| *n == name.as_str()).map(|(_, count)| *count);
            if let Some(count) = count {
                self.scanner.expect(b'(')?;
                let (value, offset) = self.offset_expression(may)?;
                self.scanner.expect(b')')?;
                return Ok(Coordinate { count, value, offset });
            }
            self.scanner.at = back;
        }
        let (value, offset) = self.offset_expression(may)?;
        Ok(Coordinate { count: Count::Modal, value, offset })
    }

    fn offset_expression(&mut self, may: bool) -> Outcome<(f64, Option<usize>)> {
        if !may {
            return Ok((self.expression()?, None));
        }
        let evaluator = Evaluator::new(self.state, &self.block.assigned);
        evaluator.offset_expression(&mut self.scanner)
    }

    pub(super) fn expression(&mut self) -> Outcome<f64> {
        Evaluator::new(self.state, &self.block.assigned).expression(&mut self.scanner)
    }

    /// A constant, perhaps behind blanks.
    #[inline]
    fn constant(&mut self) -> Outcome<f64> {
        self.scanner.blanks();
        self.scanner.number()
    }

    /// A constant, or `=` and an expression.
    #[inline]
    fn value(&mut self) -> Outcome<f64> {
        if self.scanner.take(b'=') { self.expression() } else { self.constant() }
    }

    /// A [`Reader::value`] that must be a whole number from 0.
    fn whole(&mut self, start: usize) -> Outcome<u32> {
        let value = self.value()?;
        if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
            return Ok(value as u32);
        }
        Err(self.scanner.error_since(start, Rule::Number, "a whole number from 0 must stand here"))
    }

    fn tool(&mut self, start: usize) -> Outcome<ToolCall> {
        let back = self.scanner.at;
        if self.scanner.take(b'=') && self.scanner.take(b'"') {
            self.scanner.at -= 1;
            let name = self.scanner.quoted()?;
            if name.trim().is_empty() {
                return Err(self.scanner.error_since(
                    start,
                    Rule::Tool,
                    "the name of the tool is empty",
                ));
            }
            return Ok(ToolCall::Name(name));
        }
        self.scanner.at = back;
        self.whole(start).map(ToolCall::Number)
    }

    fn m_function(&mut self, start: usize, number: u32) -> Outcome {
        let repeated = self.block.has_m(number);
        let Some(place) = self.block.m.iter_mut().find(|m| m.is_none()) else {
            let message = "a block has at most five M functions";
            return Err(self.scanner.error_since(start, Rule::Syntax, message));
        };
        *place = Some(number);
        self.once(start, repeated)
    }

    fn numbered_command(&mut self, start: usize, number: u32) -> Outcome {
        let facts = self.state.facts();
        let elsewhere = facts.offsets_elsewhere.iter().find(|(offset, _)| *offset == number);
        if let Some((_, own)) = elsewhere {
            let message = format!("there is no G{number} on an {}: write G{own}", facts.name);
            return Err(self.scanner.error_since(start, Rule::UnknownWord, message));
        }
        if commands::settable_offset(number) || facts.own_offsets.contains(&number) {
            let repeated = self.block.further_offset.replace(number).is_some();
            return self.once(start, repeated || self.block.groups[8] != 0);
        }
        match commands::numbered(number) {
            Some(index) => self.command(start, index),
            None => {
                let message = format!("there is no G{number}");
                Err(self.scanner.error_since(start, Rule::UnknownWord, message))
            }
        }
    }

    fn command(&mut self, start: usize, index: u8) -> Outcome {
        let command = commands::at(index);
        if let Code::Unsupported(reason) = command.code {
            let message = format!("{} is not supported: {reason}", command.name);
            return Err(self.scanner.error_since(start, Rule::Unsupported, message));
        }
        let place = &mut self.block.groups[usize::from(command.group) % GROUPS];
        let before = std::mem::replace(place, index + 1);
        if before != 0 || command.group == 8 && self.block.further_offset.is_some() {
            let message = format!(
                "{} and another command of G group {} in one block",
                command.name, command.group
            );
            return Err(self.scanner.error_since(start, Rule::ModalGroup, message));
        }
        Ok(())
    }

    /// A word of more than one letter.
    fn named_word(&mut self, first: bool) -> Outcome {
        let start = self.scanner.at;
        let whole_name = self.scanner.name()?;
        if self.state.locals().find(&whole_name).is_some() {
            self.scanner.at = start;
            return self.assignment();
        }
        let name = whole_name.as_str();
        if let Some(index) = commands::named(name) {
            return self.command(start, index);
        }
        if let Some((said, setting)) = settings::named(name) {
            return self.setting(start, said, setting);
        }
        match name {
            "MSG" => return self.message(start),
            "SETAL" => return self.alarm(start),
            _ => {}
        }
        let evaluator = Evaluator::new(self.state, &self.block.assigned);
        if first
            && let Some(statement) =
                statement::read(&mut self.scanner, &evaluator, start, &whole_name)?
        {
            self.block.statement = Some(statement.into());
            return Ok(());
        }
        if let Some(call) = Call::read(&mut self.scanner, start, name, &evaluator)? {
            let repeated = self.block.call.replace(call).is_some();
            return self.once(start, repeated);
        }
        self.scanner.blanks();
        let assigned = matches!(self.scanner.peek(), b'=' | b'[');
        if first && !assigned {
            return self.program_call(start);
        }
        let message = match statement::is_word(name) {
            true => format!("{name} stands at the start of a block"),
            false => {
                format!(
                    "'{name}' is not known: not a command, a cycle or an address of this control"
                )
            }
        };
        let mut error = self.scanner.error_since(start, Rule::UnknownWord, message);
        if assigned {
            error.help = "a variable needs its DEF in the same program (alarm 12550)".into();
        }
        Err(error)
    }

    /// `SETAL(number)`, `SETAL(number, text)`.
    fn alarm(&mut self, start: usize) -> Outcome {
        self.scanner.expect(b'(')?;
        let evaluator = Evaluator::new(self.state, &self.block.assigned);
        let number = evaluator.within(&mut self.scanner, 0..=u32::MAX)?;
        let mut message = format!("alarm {number}");
        if self.scanner.take(b',') {
            message.push_str(": ");
            message.push_str(&evaluator.text(&mut self.scanner)?);
        }
        self.scanner.expect(b')')?;
        // What the alarms of cycles do: 62000 to 62999 and 66000 to 66999 are shown and no more.
        if !matches!(number, 62_000..=62_999 | 66_000..=66_999) {
            let message = format!("the program ends itself here with {message}");
            return Err(self.scanner.error_since(start, Rule::Alarm, message));
        }
        let repeated = self.block.message.replace(message).is_some();
        self.once(start, repeated)
    }

    /// `MSG("text")`, `MSG()`, `MSG`; a second argument says when the text appears.
    fn message(&mut self, start: usize) -> Outcome {
        let mut text = String::new();
        if self.scanner.take(b'(') && !self.scanner.take(b')') {
            self.scanner.blanks();
            let evaluator = Evaluator::new(self.state, &self.block.assigned);
            text = evaluator.text(&mut self.scanner)?.to_string();
            if self.scanner.take(b',') {
                self.expression()?;
            }
            self.scanner.expect(b')')?;
        }
        let repeated = self.block.message.replace(text).is_some();
        self.once(start, repeated)
    }

    /// An error where the word was there before.
    #[inline]
    pub(super) fn once(&self, start: usize, repeated: bool) -> Outcome {
        if !repeated {
            return Ok(());
        }
        Err(self.scanner.error_since(
            start,
            Rule::RepeatedWord,
            "this word stands twice in the block",
        ))
    }
}

/// The functions around a coordinate.
const COUNTS: &[(&str, Count)] = &[
    ("AC", Count::Absolute),
    ("IC", Count::Incremental),
    ("DC", Count::Shorter),
    ("ACP", Count::Positive),
    ("ACN", Count::Negative),
];

/// Whether a name belongs to the language, so that no variable may have it.
pub(super) fn reserved(name: &str) -> bool {
    commands::named(name).is_some()
        || settings::named(name).is_some()
        || COUNTS.iter().any(|(n, _)| *n == name)
        || Word::named(name).is_some()
        || functions::named(name).is_some()
        || statement::is_word(name)
        || call::is_known(name)
        || matches!(name, "MSG" | "SETAL" | "TRUE" | "FALSE" | "NOT" | "AND" | "OR" | "XOR")
}
