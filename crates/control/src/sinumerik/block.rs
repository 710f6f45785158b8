//! A block: its words, each read once, before anything is done.

use super::Fallible;
use super::call::Call;
use super::commands::{self, Code, GROUPS};
use super::expression::{Evaluator, Parameters};
use super::scan::{Scanner, Source};

/// How a coordinate counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Count {
    /// As `G90` or `G91` says.
    Modal,
    /// `AC()`.
    Absolute,
    /// `IC()`.
    Incremental,
    /// `DC()`: rotary axis, the shorter way.
    Shorter,
    /// `ACP()`: rotary axis, in the positive direction.
    Positive,
    /// `ACN()`: rotary axis, in the negative direction.
    Negative,
}

/// A coordinate as it is programmed, in units of the program or degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coordinate {
    /// How it counts.
    pub count: Count,
    /// Its value, without what the operator adds.
    pub value: f64,
    /// The R parameter with which the operator shifts it.
    pub offset: Option<usize>,
}

/// A tool as it is called.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ToolCall {
    /// By number.
    Number(u32),
    /// By name.
    Name(String),
}

/// Most M functions in a block (Programming Manual 06/2019, 2.13).
const MOST_M: usize = 5;

/// The words of a block.
pub(super) struct Block {
    /// X Y Z A B C.
    pub axes: [Option<Coordinate>; 6],
    /// Machine axes X1 Y1 Z1 A1 B1 C1 of `G74` and `G75`: named or not.
    pub machine_axes: [bool; 6],
    /// I J K.
    pub center: [Option<Coordinate>; 3],
    /// I1 J1 K1.
    pub through: [Option<Coordinate>; 3],
    /// A3 B3 C3.
    pub vector: [Option<f64>; 3],
    /// CR.
    pub radius: Option<f64>,
    /// AR, degrees.
    pub opening: Option<f64>,
    /// TURN.
    pub turns: Option<f64>,
    /// RPL, degrees.
    pub rotation: Option<f64>,
    /// FP.
    pub fixed_point: Option<f64>,
    /// F.
    pub feed: Option<f64>,
    /// S.
    pub speed: Option<f64>,
    /// T.
    pub tool: Option<ToolCall>,
    /// D.
    pub edge: Option<u32>,
    /// M functions.
    pub m: [Option<u32>; MOST_M],
    /// `CTOL`, `ADIS`: which, and the value.
    pub path_tolerance: Option<(&'static str, f64)>,
    /// Assignments to R parameters.
    pub assigned: Vec<(usize, f64)>,
    /// A call; it stands alone.
    pub call: Option<Call>,
    /// `MSG`.
    pub message: Option<String>,
    /// Comment.
    pub comment: Option<String>,
    /// Whether there is any word.
    pub any: bool,
    /// Command of each group that the block has one of: its index plus one.
    groups: [u8; GROUPS],
    /// Number of a settable offset beyond `G57`.
    further_offset: Option<u32>,
}

impl Block {
    /// What the block's command of `group` does, if it has one.
    #[inline]
    pub fn code(&self, group: u8) -> Option<Code> {
        match self.further_offset {
            Some(number) if group == 8 => Some(Code::WorkOffset(number)),
            _ => self.groups[usize::from(group)].checked_sub(1).map(|i| commands::at(i).code),
        }
    }

    /// The name of the block's command of `group`.
    pub fn command(&self, group: u8) -> &'static str {
        self.groups[usize::from(group)].checked_sub(1).map_or("", |i| commands::at(i).name)
    }

    /// Whether it has M function `number`.
    pub fn has_m(&self, number: u32) -> bool {
        self.m.contains(&Some(number))
    }

    /// Whether it names a linear axis.
    pub fn has_linear(&self) -> bool {
        self.axes[..3].iter().any(Option::is_some)
    }

    /// Whether it names a rotary axis.
    pub fn has_rotary(&self) -> bool {
        self.axes[3..].iter().any(Option::is_some)
    }

    /// Whether it gives a tool axis as a vector.
    pub fn has_vector(&self) -> bool {
        self.vector.iter().any(Option::is_some)
    }

    /// Whether it gives a position or an orientation.
    pub fn has_position(&self) -> bool {
        self.axes.iter().any(Option::is_some) || self.has_vector()
    }

    /// Whether it gives something of an arc.
    pub fn has_arc_word(&self) -> bool {
        self.center.iter().chain(&self.through).any(Option::is_some)
            || self.radius.is_some()
            || self.opening.is_some()
            || self.turns.is_some()
    }

    /// Whether it has nothing but a command of `group` and perhaps a block number.
    pub fn only_group(&self, group: u8) -> bool {
        let others =
            self.groups.iter().enumerate().any(|(g, c)| *c != 0 && g != usize::from(group));
        !others
            && self.further_offset.is_none()
            && self.m.iter().all(Option::is_none)
            && self.tool.is_none()
            && self.edge.is_none()
            && self.assigned.is_empty()
            && !self.has_vector()
            && !self.has_arc_word()
    }

    /// No words.
    pub fn empty() -> Block {
        Block {
            axes: [None; 6],
            machine_axes: [false; 6],
            center: [None; 3],
            through: [None; 3],
            vector: [None; 3],
            radius: None,
            opening: None,
            turns: None,
            rotation: None,
            fixed_point: None,
            feed: None,
            speed: None,
            tool: None,
            edge: None,
            m: [None; MOST_M],
            path_tolerance: None,
            assigned: Vec::new(),
            call: None,
            message: None,
            comment: None,
            any: false,
            groups: [0; GROUPS],
            further_offset: None,
        }
    }

    /// Reads a block.
    ///
    /// # Errors
    /// The first word that is not understood, repeated, or against the rules of a block.
    pub fn read(&mut self, source: Source, parameters: &Parameters) -> Fallible<()> {
        *self = Block::empty();
        let mut reader = Reader { scanner: Scanner::new(source), parameters, block: self };
        reader.head()?;
        loop {
            reader.scanner.blanks();
            match reader.scanner.peek() {
                0 if reader.scanner.at >= source.text.len() => return Ok(()),
                b';' => {
                    reader.comment();
                    return Ok(());
                }
                _ => {
                    reader.block.any = true;
                    reader.word()?;
                }
            }
        }
    }
}

struct Reader<'a, 'b> {
    scanner: Scanner<'a>,
    parameters: &'a Parameters,
    block: &'b mut Block,
}

impl Reader<'_, '_> {
    /// Skip mark, block number, label. Skipped blocks are run: the switch is off.
    fn head(&mut self) -> Fallible<()> {
        self.scanner.blanks();
        if self.scanner.peek() == b'/' {
            self.scanner.at += 1;
            if self.scanner.digit_next() {
                self.scanner.at += 1;
            }
            self.scanner.blanks();
        }
        let numbered = self.scanner.peek() == b':'
            || self.scanner.peek() == b'N' && self.scanner.peek_at(1).is_ascii_digit();
        if numbered {
            self.scanner.at += 1;
            self.scanner.integer()?;
        }
        self.label()
    }

    /// A label: a name of which the first two characters are letters or underscores, and a colon.
    fn label(&mut self) -> Fallible<()> {
        self.scanner.blanks();
        let starts = |byte: u8| byte == b'_' || byte.is_ascii_alphabetic();
        if !starts(self.scanner.peek()) || !starts(self.scanner.peek_at(1)) {
            return Ok(());
        }
        let back = self.scanner.at;
        let mut ahead = 0;
        while self.scanner.peek_at(ahead) == b'_'
            || self.scanner.peek_at(ahead).is_ascii_alphanumeric()
        {
            ahead += 1;
        }
        if self.scanner.peek_at(ahead) != b':' {
            return Ok(());
        }
        self.scanner.name()?;
        self.scanner.at = back + ahead + 1;
        Ok(())
    }

    fn comment(&mut self) {
        let bytes = self.scanner.source.text.get(self.scanner.at + 1..).unwrap_or(&[]);
        self.block.comment = Some(String::from_utf8_lossy(bytes).trim().to_owned());
        self.scanner.at = self.scanner.source.text.len();
    }

    fn word(&mut self) -> Fallible<()> {
        let letter = self.scanner.peek();
        if !letter.is_ascii_alphabetic() && letter != b'_' {
            let message = match letter {
                b'$' => "system variables are not supported yet",
                b'(' => "a comment starts with ';'",
                _ => "this character does not belong in a block",
            };
            return Err(self.scanner.error_here("syntax", message));
        }
        let next = self.scanner.peek_at(1);
        if letter == b'_' || next == b'_' || next.is_ascii_alphabetic() {
            self.named_word()
        } else {
            self.address_word(letter)
        }
    }

    /// A letter and a number, `=` and an expression, or an extension, `=` and an expression.
    #[inline]
    fn address_word(&mut self, letter: u8) -> Fallible<()> {
        let start = self.scanner.at;
        self.scanner.at += 1;
        if letter == b'R' {
            return self.assignment();
        }
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
            b'N' => Err(self.scanner.error_since(
                start,
                "syntax",
                "a block number stands once, at the start of the block",
            )),
            _ => {
                let message = format!("there is no address {}", letter as char);
                Err(self.scanner.error_since(start, "unknown-word", message))
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

    fn extended_word(&mut self, start: usize, letter: u8, extension: u8) -> Fallible<()> {
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
                    return Err(self.scanner.error_since(start, "unknown-word", message));
                }
                self.m_function(start, number)
            }
            _ => {
                let message = format!("there is no address {}{extension}", letter as char);
                Err(self.scanner.error_since(start, "unknown-word", message))
            }
        }
    }

    /// `R1=...` behind the `R`.
    fn assignment(&mut self) -> Fallible<()> {
        let start = self.scanner.at - 1;
        let evaluator = Evaluator::new(self.parameters, &self.block.assigned);
        let index = evaluator.index(&mut self.scanner)?;
        self.scanner.expect(b'=')?;
        let value = evaluator.expression(&mut self.scanner)?;
        let repeated = self.block.assigned.iter().any(|(i, _)| *i == index);
        self.block.assigned.push((index, value));
        self.once(start, repeated)
    }

    fn axis(&mut self, start: usize, index: usize) -> Fallible<()> {
        let value = self.offset_coordinate(index >= 3)?;
        let repeated = match self.block.axes.get_mut(index) {
            Some(place) => place.replace(value).is_some(),
            None => false,
        };
        self.once(start, repeated)
    }

    /// The value of an address that may stand in `AC()`, `IC()` ...
    #[inline]
    fn coordinate(&mut self) -> Fallible<Coordinate> {
        self.offset_coordinate(false)
    }

    /// The same, to which the operator's offset may be added where `may`.
    #[inline]
    fn offset_coordinate(&mut self, may: bool) -> Fallible<Coordinate> {
        if !self.scanner.take(b'=') {
            let value = self.constant()?;
            return Ok(Coordinate { count: Count::Modal, value, offset: None });
        }
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

    fn offset_expression(&mut self, may: bool) -> Fallible<(f64, Option<usize>)> {
        if !may {
            return Ok((self.expression()?, None));
        }
        let evaluator = Evaluator::new(self.parameters, &self.block.assigned);
        evaluator.offset_expression(&mut self.scanner)
    }

    fn expression(&mut self) -> Fallible<f64> {
        Evaluator::new(self.parameters, &self.block.assigned).expression(&mut self.scanner)
    }

    /// A constant, perhaps behind blanks.
    #[inline]
    fn constant(&mut self) -> Fallible<f64> {
        self.scanner.blanks();
        self.scanner.number()
    }

    /// A constant, or `=` and an expression.
    #[inline]
    fn value(&mut self) -> Fallible<f64> {
        if self.scanner.take(b'=') { self.expression() } else { self.constant() }
    }

    /// A [`Reader::value`] that must be a whole number from 0.
    fn whole(&mut self, start: usize) -> Fallible<u32> {
        let value = self.value()?;
        if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
            return Ok(value as u32);
        }
        Err(self.scanner.error_since(start, "number", "a whole number from 0 must stand here"))
    }

    fn tool(&mut self, start: usize) -> Fallible<ToolCall> {
        let back = self.scanner.at;
        if self.scanner.take(b'=') && self.scanner.take(b'"') {
            self.scanner.at -= 1;
            let name = self.scanner.quoted()?;
            if name.trim().is_empty() {
                return Err(self.scanner.error_since(
                    start,
                    "tool",
                    "the name of the tool is empty",
                ));
            }
            return Ok(ToolCall::Name(name));
        }
        self.scanner.at = back;
        self.whole(start).map(ToolCall::Number)
    }

    fn m_function(&mut self, start: usize, number: u32) -> Fallible<()> {
        let repeated = self.block.has_m(number);
        let Some(place) = self.block.m.iter_mut().find(|m| m.is_none()) else {
            let message = "a block has at most five M functions";
            return Err(self.scanner.error_since(start, "syntax", message));
        };
        *place = Some(number);
        self.once(start, repeated)
    }

    fn numbered_command(&mut self, start: usize, number: u32) -> Fallible<()> {
        if commands::settable_offset(number) {
            let repeated = self.block.further_offset.replace(number).is_some();
            return self.once(start, repeated || self.block.groups[8] != 0);
        }
        match commands::numbered(number) {
            Some(index) => self.command(start, index),
            None => {
                let message = format!("there is no G{number}");
                Err(self.scanner.error_since(start, "unknown-word", message))
            }
        }
    }

    fn command(&mut self, start: usize, index: u8) -> Fallible<()> {
        let command = commands::at(index);
        if let Code::Unsupported(reason) = command.code {
            let message = format!("{} is not supported: {reason}", command.name);
            return Err(self.scanner.error_since(start, "unsupported", message));
        }
        let place = &mut self.block.groups[usize::from(command.group) % GROUPS];
        let before = std::mem::replace(place, index + 1);
        if before != 0 || command.group == 8 && self.block.further_offset.is_some() {
            let message = format!(
                "{} and another command of G group {} in one block",
                command.name, command.group
            );
            return Err(self.scanner.error_since(start, "group-conflict", message));
        }
        Ok(())
    }

    /// A word of more than one letter.
    fn named_word(&mut self) -> Fallible<()> {
        let start = self.scanner.at;
        let name = self.scanner.name()?;
        let name = name.as_str();
        if let Some(index) = commands::named(name) {
            return self.command(start, index);
        }
        if let Some((said, setting)) = SETTINGS.iter().find(|(n, _)| *n == name) {
            self.scanner.expect(b'=')?;
            let value = self.expression()?;
            let block = &mut *self.block;
            let place = match setting {
                Setting::Radius => &mut block.radius,
                Setting::Opening => &mut block.opening,
                Setting::Turns => &mut block.turns,
                Setting::Rotation => &mut block.rotation,
                Setting::FixedPoint => &mut block.fixed_point,
                Setting::PathTolerance => {
                    let repeated = block.path_tolerance.replace((said, value)).is_some();
                    return self.once(start, repeated);
                }
                Setting::NoMotion => return Ok(()),
            };
            let repeated = place.replace(value).is_some();
            return self.once(start, repeated);
        }
        if name == "MSG" {
            return self.message(start);
        }
        let evaluator = Evaluator::new(self.parameters, &self.block.assigned);
        let call = Call::read(&mut self.scanner, start, name, &evaluator)?;
        let repeated = self.block.call.replace(call).is_some();
        self.once(start, repeated)
    }

    /// `MSG("text")`, `MSG()`, `MSG`; a second argument says when the text appears.
    fn message(&mut self, start: usize) -> Fallible<()> {
        let mut text = String::new();
        if self.scanner.take(b'(') && !self.scanner.take(b')') {
            self.scanner.blanks();
            text = self.scanner.quoted()?;
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
    fn once(&self, start: usize, repeated: bool) -> Fallible<()> {
        if !repeated {
            return Ok(());
        }
        Err(self.scanner.error_since(start, "repeated-word", "this word stands twice in the block"))
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

/// An address of several letters.
enum Setting {
    Radius,
    Opening,
    Turns,
    Rotation,
    FixedPoint,
    /// How far the control may leave the path of a cut.
    PathTolerance,
    /// How rapids and corrections are rounded, and how far the tool axis may turn.
    NoMotion,
}

/// The addresses of several letters.
const SETTINGS: &[(&str, Setting)] = &[
    ("CR", Setting::Radius),
    ("AR", Setting::Opening),
    ("TURN", Setting::Turns),
    ("RPL", Setting::Rotation),
    ("FP", Setting::FixedPoint),
    ("ADIS", Setting::PathTolerance),
    ("ADISPOS", Setting::NoMotion),
    ("CTOL", Setting::PathTolerance),
    ("OTOL", Setting::NoMotion),
    ("DISC", Setting::NoMotion),
];
