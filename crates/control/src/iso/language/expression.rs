//! Numbers that a program calculates: `#1`, `[#<depth> + 2 * SIN[30]]`. They are evaluated as they are read.
//!
//! By rank, from left to right within one:
//!
//! | RS274/NGC (LinuxCNC manual, "Binary Operators") | custom macro B (B-63684EN, 16.3) |
//! | --- | --- |
//! | `**` | |
//! | `*` `/` `MOD` | `*` `/` `AND` `MOD` |
//! | `+` `-` | `+` `-` `OR` `XOR` |
//! | `EQ` `NE` `GT` `GE` `LT` `LE` | `EQ` `NE` `GT` `GE` `LT` `LE` |
//! | `AND` `OR` `XOR` of truths | |

use super::Fault;
use super::arithmetic::{
    BINARY, Binary, FUNCTIONS, Function, MACRO_FUNCTIONS, NGC_FUNCTIONS, macro_binary,
    macro_function, ngc_binary, ngc_function, truth, whole,
};
use super::parameters::Values;
use super::value::{Target, Value};
use crate::iso::dialects::facts::Language;
use crate::kernel::decimal;
use crate::kernel::expression::{Grammar, Next, Rank, Span, evaluate};
use program::{Diagnostic, Rule};

/// How deep brackets may nest in macro B (B-63684EN, 16.3: alarm 118).
const DEEPEST_MACRO: u32 = 5;

/// Reads numbers from a line.
pub(crate) struct Reader<'t, 'v> {
    values: &'v Values<'v>,
    line: u32,
    text: &'t [u8],
    /// The next byte.
    pub at: usize,
    depth: usize,
    brackets: u32,
}

impl<'t, 'v> Reader<'t, 'v> {
    /// For the number at `at` of `text`, which is line `line`.
    pub(crate) fn new(
        values: &'v Values<'v>,
        line: u32,
        text: &'t [u8],
        at: usize,
    ) -> Reader<'t, 'v> {
        Reader { values, line, text, at, depth: 0, brackets: 0 }
    }

    /// The byte here, behind blanks.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        while let Some(b' ' | b'\t') = self.text.get(self.at) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    /// Passes over the comment that begins here.
    pub(crate) fn pass_comment(&mut self) -> Result<(), Fault> {
        let rest = self.text.get(self.at..).unwrap_or_default();
        match memchr::memchr(b')', rest) {
            Some(end) => {
                self.at += end + 1;
                Ok(())
            }
            None => Err(self.wrong("the comment has no end")),
        }
    }

    /// Takes `byte` where it is here.
    pub(crate) fn take(&mut self, byte: u8) -> bool {
        let here = self.peek() == Some(byte);
        self.at += usize::from(here);
        here
    }

    /// A number: written, of a parameter, of a function, or in brackets; with signs.
    pub(crate) fn value(&mut self) -> Result<Value, Fault> {
        self.nested(|reader| match reader.peek() {
            Some(b'[') => reader.expression(),
            Some(b'#') => reader.parameter(),
            Some(b'+') => {
                reader.at += 1;
                reader.value()
            }
            Some(b'-') => {
                reader.at += 1;
                reader.value().map(|value| value.map(|value| -value))
            }
            Some(b'0'..=b'9' | b'.') => reader.number(),
            Some(b'A'..=b'Z' | b'a'..=b'z') => reader.function(),
            _ => Err(reader.wrong("a number is missing")),
        })
    }

    fn number(&mut self) -> Result<Value, Fault> {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let number = decimal::parse(rest).ok_or_else(|| self.wrong("a number is missing"))?;
        self.at += number.len;
        Ok(Some(number.value))
    }

    /// Numbers and operators, as they stand behind the `=` of macro B.
    pub(crate) fn formula(&mut self) -> Result<Value, Fault> {
        evaluate(self)
    }

    /// An expression in brackets.
    pub(crate) fn expression(&mut self) -> Result<Value, Fault> {
        self.open()?;
        let value = evaluate(self)?;
        self.close()?;
        Ok(value)
    }

    fn open(&mut self) -> Result<(), Fault> {
        if !self.take(b'[') {
            return Err(self.wrong("[ is missing"));
        }
        self.brackets += 1;
        if self.values.language() == Language::MacroB && self.brackets > DEEPEST_MACRO {
            return Err(self.wrong(format!("brackets nest deeper than {DEEPEST_MACRO}")));
        }
        Ok(())
    }

    fn close(&mut self) -> Result<(), Fault> {
        if !self.take(b']') {
            return Err(self.wrong("an operator or ] is missing"));
        }
        self.brackets -= 1;
        Ok(())
    }

    /// A number in the place of a whole one: near to it, not null, not below 0.
    pub(crate) fn whole(&mut self, what: &str) -> Result<u32, Fault> {
        let start = self.at;
        let value = self.value()?.unwrap_or(f64::NAN);
        whole(value).ok_or_else(|| {
            let message = format!("{what} must be a whole number, and it is {value}");
            self.fault(Rule::Number, message, start)
        })
    }

    /// Takes what follows a `#` as the parameter that is meant: its number, or its name in `< >`.
    pub(crate) fn target(&mut self) -> Result<Target<'t>, Fault> {
        match self.peek() {
            Some(b'<') if self.values.language() == Language::Ngc => {
                let from = self.at + 1;
                let rest = self.text.get(from..).unwrap_or_default();
                let Some(length) = memchr::memchr(b'>', rest) else {
                    return Err(self.wrong("the name of the parameter has no end; write >"));
                };
                self.at = from + length + 1;
                Ok(Target::Name(rest.get(..length).unwrap_or_default()))
            }
            Some(b'#') if self.values.language() == Language::MacroB => {
                Err(self.wrong("a variable that names another stands in brackets: #[#1]"))
            }
            _ => self.whole("the number of a parameter").map(Target::Number),
        }
    }

    fn parameter(&mut self) -> Result<Value, Fault> {
        let start = self.at;
        self.at += 1;
        let target = self.target()?;
        self.values.get(target).map_err(|message| self.fault(Rule::Parameter, message, start))
    }

    /// The word of `table` that stands here and its length. Macro B has no small letters.
    fn word<T: Copy>(&self, table: &[(&[u8], T)]) -> Option<(T, usize)> {
        let rest = self.text.get(self.at..)?;
        let small = self.values.language() != Language::MacroB;
        table.iter().find_map(|(word, meaning)| {
            let here = rest.get(..word.len())?;
            let same = here == *word || small && here.eq_ignore_ascii_case(word);
            same.then_some((*meaning, word.len()))
        })
    }

    fn function(&mut self) -> Result<Value, Fault> {
        let start = self.at;
        let own: &[(&[u8], Function)] = match self.values.language() {
            Language::MacroB => &MACRO_FUNCTIONS,
            Language::Ngc => &NGC_FUNCTIONS,
            _ => &[],
        };
        let Some((function, length)) = self.word(&FUNCTIONS).or_else(|| self.word(own)) else {
            let message = "no function of this control begins here";
            return Err(self.fault(Rule::Expression, message, start));
        };
        self.at += length;
        self.open()?;
        if function == Function::Exists {
            return self.exists();
        }
        let first = evaluate(self)?;
        let second = self.second_argument(function)?;
        let result = match (self.values.language(), second) {
            (Language::MacroB, second) => macro_function(function, first, second),
            (_, Some(second)) => Ok(first.unwrap_or(0.0).atan2(second).to_degrees()),
            (_, None) => ngc_function(function, first.unwrap_or(0.0)),
        };
        self.checked(result.map(Some), start, self.at)
    }

    /// The second argument of `ATAN[ ]/[ ]`, `ATAN[ , ]` and `POW[ , ]`, behind the first one.
    fn second_argument(&mut self, function: Function) -> Result<Option<f64>, Fault> {
        let macro_b = self.values.language() == Language::MacroB;
        let pair = macro_b && matches!(function, Function::Atan | Function::Pow);
        if pair && self.take(b',') {
            let second = evaluate(self)?;
            self.close()?;
            return Ok(Some(second.unwrap_or(0.0)));
        }
        self.close()?;
        if function == Function::Atan && self.take(b'/') {
            return Ok(Some(self.expression()?.unwrap_or(0.0)));
        }
        match function {
            Function::Pow => Err(self.wrong("POW needs two arguments: POW[base, exponent]")),
            Function::Atan if !macro_b => Err(self.wrong("ATAN needs two arguments: ATAN[y]/[x]")),
            _ => Ok(None),
        }
    }

    /// The rest of `EXISTS[#<name>]`.
    fn exists(&mut self) -> Result<Value, Fault> {
        let start = self.at;
        if !self.take(b'#') {
            return Err(self.wrong("EXISTS needs a parameter: EXISTS[#<name>]"));
        }
        let target = self.target()?;
        self.close()?;
        let exists = self.values.exists(target);
        exists
            .map(|exists| Some(truth(exists)))
            .map_err(|message| self.fault(Rule::Parameter, message, start))
    }

    /// # Errors
    /// There is no result, or none that is a number.
    fn checked(
        &self,
        result: Result<Value, &'static str>,
        start: usize,
        end: usize,
    ) -> Result<Value, Fault> {
        let message = match result {
            Ok(value) if value.is_none_or(f64::is_finite) => return Ok(value),
            Ok(_) => "the result is beyond all numbers",
            Err(message) => message,
        };
        Err(self.fault_between(Rule::Arithmetic, message, start, end))
    }

    /// A finding at what stands here.
    pub(crate) fn wrong(&self, message: impl Into<String>) -> Fault {
        self.fault_between(Rule::Expression, message, self.at, self.at + 1)
    }

    /// A finding about what has been read from `start` on.
    pub(super) fn fault(&self, rule: Rule, message: impl Into<String>, start: usize) -> Fault {
        self.fault_between(rule, message, start, self.at.max(start + 1))
    }

    fn fault_between(
        &self,
        rule: Rule,
        message: impl Into<String>,
        start: usize,
        end: usize,
    ) -> Fault {
        Diagnostic::error(rule, message).at(self.line, self.text, start, end).into()
    }
}

impl Grammar for Reader<'_, '_> {
    type Value = Value;
    type Operator = Binary;
    type Error = Fault;
    const DEEPEST: usize = 100;

    fn depth(&mut self) -> &mut usize {
        &mut self.depth
    }

    fn too_deep(&mut self) -> Fault {
        self.wrong("the expression nests too deep")
    }

    fn start(&mut self) -> usize {
        self.at
    }

    fn end(&self) -> usize {
        self.at
    }

    fn operand(&mut self) -> Result<Value, Fault> {
        self.value()
    }

    fn operator(&mut self) -> Option<Next<Binary>> {
        let language = self.values.language();
        let (operator, length) = match self.peek()? {
            b'+' => (Binary::Plus, 1),
            b'-' => (Binary::Minus, 1),
            b'/' => (Binary::Divide, 1),
            b'*' if self.text.get(self.at + 1) == Some(&b'*') && language != Language::MacroB => {
                (Binary::Power, 2)
            }
            b'*' => (Binary::Times, 1),
            // The first RS274/NGC does not compare.
            _ if language == Language::Rs274 => self.word(&BINARY[6..])?,
            _ => self.word(&BINARY)?,
        };
        let at = self.at;
        self.at += length;
        Some(Next { operator, rank: Rank::Left(operator.rank(language)), at })
    }

    fn apply(
        &mut self,
        operator: Binary,
        [left, right]: [Value; 2],
        span: Span,
    ) -> Result<Value, Fault> {
        let result = match self.values.language() {
            Language::MacroB => macro_binary(operator, left, right),
            _ => ngc_binary(operator, left.unwrap_or(0.0), right.unwrap_or(0.0)).map(Some),
        };
        self.checked(result, span.start, span.end)
    }
}
