//! Arithmetic behind `=`.
//!
//! Operators by rank: unary sign; `*` `/` `DIV` `MOD`; `+` `-`; from left to right within a rank.
//! Angles of the trigonometric functions are degrees (Job Planning, arithmetic functions). `/` gives
//! a real number also for two whole numbers, `DIV` the whole quotient, `MOD` its remainder.

use super::Fallible;
use super::scan::Scanner;
use program::Diagnostic;
use std::cell::Cell;

/// How many R parameters there are (`R0` to `R999`; the machine's builder says how many, MD28050).
pub(super) const R_PARAMETERS: usize = 1000;

/// How deep brackets and signs may nest.
const DEEPEST: usize = 32;

/// What is known of an R parameter.
#[derive(Clone, Copy)]
enum Parameter {
    /// A block has set it.
    Set(f64),
    /// The operator sets it at the machine.
    Operator,
    /// Nothing: it keeps what another program has left there.
    Unknown,
}

/// The R parameters.
pub(super) struct Parameters {
    values: Vec<Parameter>,
}

impl Parameters {
    /// Before a program: those of the operator, and no other.
    pub fn new(operator: &[u32]) -> Parameters {
        let mut values = vec![Parameter::Unknown; R_PARAMETERS];
        for index in operator {
            if let Some(place) = values.get_mut(*index as usize) {
                *place = Parameter::Operator;
            }
        }
        Parameters { values }
    }

    /// Sets a parameter (an index beyond the last is checked where it is read).
    pub fn set(&mut self, index: usize, value: f64) {
        if let Some(place) = self.values.get_mut(index) {
            *place = Parameter::Set(value);
        }
    }

    fn get(&self, index: usize) -> Parameter {
        self.values.get(index).copied().unwrap_or(Parameter::Unknown)
    }
}

/// Evaluates the expressions of one block.
pub(super) struct Evaluator<'a> {
    /// Values before the block.
    pub parameters: &'a Parameters,
    /// What the block has assigned so far.
    pub assigned: &'a [(usize, f64)],
    /// The operator's parameter that the expression has added; it counts as 0.
    offset: Cell<Option<usize>>,
}

impl<'a> Evaluator<'a> {
    /// For a block that has assigned `assigned` so far.
    pub fn new(parameters: &'a Parameters, assigned: &'a [(usize, f64)]) -> Evaluator<'a> {
        Evaluator { parameters, assigned, offset: Cell::new(None) }
    }

    /// Takes an expression.
    pub fn expression(&self, scanner: &mut Scanner) -> Fallible<f64> {
        let start = scanner.at;
        let value = self.finite(scanner)?;
        match self.offset.get() {
            None => Ok(value),
            Some(index) => Err(only_added(scanner, start, index)),
        }
    }

    /// Takes an expression to which one parameter of the operator may be added: its value without
    /// that, and the parameter.
    pub fn offset_expression(&self, scanner: &mut Scanner) -> Fallible<(f64, Option<usize>)> {
        let value = self.finite(scanner)?;
        Ok((value, self.offset.take()))
    }

    fn finite(&self, scanner: &mut Scanner) -> Fallible<f64> {
        let start = scanner.at;
        let value = self.sum(scanner, 0)?;
        if value.is_finite() {
            return Ok(value);
        }
        Err(scanner.error_since(start, "arithmetic", "the result is not a finite number"))
    }

    /// Takes the index of an R parameter behind its `R`.
    pub fn index(&self, scanner: &mut Scanner) -> Fallible<usize> {
        let start = scanner.at;
        let index = if scanner.take(b'[') {
            let index = self.expression(scanner)?;
            scanner.expect(b']')?;
            if index.fract() == 0.0 && index >= 0.0 { index as usize } else { R_PARAMETERS }
        } else {
            scanner.integer()? as usize
        };
        if index < R_PARAMETERS {
            return Ok(index);
        }
        Err(scanner.error_since(start, "r-parameter", "there are R0 to R999"))
    }

    fn sum(&self, scanner: &mut Scanner, depth: usize) -> Fallible<f64> {
        if depth > DEEPEST {
            return Err(scanner.error_here("syntax", "brackets nest too deep"));
        }
        let mut value = self.term(scanner, depth, true)?;
        loop {
            if scanner.take(b'+') {
                value += self.term(scanner, depth, true)?;
            } else if scanner.take(b'-') {
                value -= self.term(scanner, depth, false)?;
            } else {
                return Ok(value);
            }
        }
    }

    /// A product, which is added or taken off. A parameter of the operator is one by itself, outside
    /// of brackets and added: anything else would not be an offset.
    fn term(&self, scanner: &mut Scanner, depth: usize, added: bool) -> Fallible<f64> {
        scanner.blanks();
        let start = scanner.at;
        let before = self.offset.take();
        let value = self.product(scanner, depth)?;
        let Some(index) = self.offset.get() else {
            self.offset.set(before);
            return Ok(value);
        };
        let text = scanner.source.text.get(start..scanner.at).unwrap_or_default().trim_ascii();
        let alone = text[1..].iter().all(u8::is_ascii_digit);
        if alone && added && depth == 0 && before.is_none() {
            return Ok(value);
        }
        Err(only_added(scanner, start, index))
    }

    fn product(&self, scanner: &mut Scanner, depth: usize) -> Fallible<f64> {
        let mut value = self.signed(scanner, depth)?;
        loop {
            let start = scanner.at;
            let by_zero =
                |scanner: &Scanner| scanner.error_since(start, "arithmetic", "division by zero");
            if scanner.take(b'*') {
                value *= self.signed(scanner, depth)?;
            } else if scanner.take(b'/') {
                let divisor = self.signed(scanner, depth)?;
                if divisor == 0.0 {
                    return Err(by_zero(scanner));
                }
                value /= divisor;
            } else if let Some(whole) = word_operator(scanner) {
                let divisor = self.signed(scanner, depth)?;
                if divisor == 0.0 {
                    return Err(by_zero(scanner));
                }
                value = if whole { (value / divisor).trunc() } else { value % divisor };
            } else {
                return Ok(value);
            }
        }
    }

    fn signed(&self, scanner: &mut Scanner, depth: usize) -> Fallible<f64> {
        let mut negative = false;
        for _ in 0..DEEPEST {
            if scanner.take(b'-') {
                negative = !negative;
            } else if !scanner.take(b'+') {
                let value = self.operand(scanner, depth)?;
                return Ok(if negative { -value } else { value });
            }
        }
        Err(scanner.error_here("syntax", "too many signs"))
    }

    fn operand(&self, scanner: &mut Scanner, depth: usize) -> Fallible<f64> {
        scanner.blanks();
        match scanner.peek() {
            b'(' => {
                scanner.at += 1;
                let value = self.sum(scanner, depth + 1)?;
                scanner.expect(b')')?;
                Ok(value)
            }
            b'0'..=b'9' | b'.' => scanner.number(),
            b'R' if scanner.peek_at(1).is_ascii_digit() || scanner.peek_at(1) == b'[' => {
                self.parameter(scanner)
            }
            b'$' => {
                Err(scanner.error_here("unsupported", "system variables are not supported yet"))
            }
            b'A'..=b'Z' | b'_' => self.function(scanner, depth),
            _ => Err(scanner.error_here("syntax", "a value is missing here")),
        }
    }

    fn parameter(&self, scanner: &mut Scanner) -> Fallible<f64> {
        let start = scanner.at;
        scanner.at += 1;
        let index = self.index(scanner)?;
        if scanner.name_goes_on() {
            return Err(scanner.error_here(
                "syntax",
                "a blank is missing: letters behind an R parameter would read as its name",
            ));
        }
        if self.assigned.iter().any(|(i, _)| *i == index) {
            return Err(scanner.error_since(
                start,
                "r-parameter",
                format!("R{index} is set and read in one block"),
            ));
        }
        match self.parameters.get(index) {
            Parameter::Set(value) => Ok(value),
            Parameter::Operator => {
                self.offset.set(Some(index));
                Ok(0.0)
            }
            Parameter::Unknown => {
                let message = format!("R{index} is read, and no block before has set it");
                let mut error = scanner.error_since(start, "r-parameter", message);
                error.help = format!(
                    "set it in the program; or, where the operator sets it, write \
                     operator_parameters = [\"R{index}\"] into the machine file"
                );
                Err(error)
            }
        }
    }

    fn function(&self, scanner: &mut Scanner, depth: usize) -> Fallible<f64> {
        let start = scanner.at;
        let name = scanner.name()?;
        let Some((_, count, function)) = FUNCTIONS.iter().find(|f| f.0 == name.as_str()) else {
            let message = format!("'{}' is not a value that is known here", name.as_str());
            return Err(scanner.error_since(start, "unknown-word", message));
        };
        scanner.expect(b'(')?;
        let mut arguments = [0.0; 2];
        for (i, argument) in arguments.iter_mut().take(*count).enumerate() {
            if i > 0 {
                scanner.expect(b',')?;
            }
            *argument = self.sum(scanner, depth + 1)?;
        }
        scanner.expect(b')')?;
        let value = function(arguments[0], arguments[1]);
        if value.is_finite() {
            return Ok(value);
        }
        let message = format!("{} has no value here", name.as_str());
        Err(scanner.error_since(start, "arithmetic", message))
    }
}

fn only_added(scanner: &Scanner, start: usize, index: usize) -> Box<Diagnostic> {
    let message = format!(
        "R{index} is the operator's: it is only added to the position of a rotary axis, once, as in \
         C=45+R{index}"
    );
    scanner.error_since(start, "operator-offset", message)
}

/// Takes `DIV` (true) or `MOD` (false).
fn word_operator(scanner: &mut Scanner) -> Option<bool> {
    let back = scanner.at;
    scanner.blanks();
    let word = [scanner.peek(), scanner.peek_at(1), scanner.peek_at(2)];
    scanner.at += 3;
    match &word {
        b"DIV" if !scanner.name_goes_on() => Some(true),
        b"MOD" if !scanner.name_goes_on() => Some(false),
        _ => {
            scanner.at = back;
            None
        }
    }
}

/// Name, number of arguments, value.
type Function = (&'static str, usize, fn(f64, f64) -> f64);

/// The arithmetic functions.
const FUNCTIONS: &[Function] = &[
    ("SIN", 1, |x, _| x.to_radians().sin()),
    ("COS", 1, |x, _| x.to_radians().cos()),
    ("TAN", 1, |x, _| x.to_radians().tan()),
    ("ASIN", 1, |x, _| x.asin().to_degrees()),
    ("ACOS", 1, |x, _| x.acos().to_degrees()),
    ("ATAN2", 2, |y, x| y.atan2(x).to_degrees()),
    ("SQRT", 1, |x, _| x.sqrt()),
    ("ABS", 1, |x, _| x.abs()),
    ("POT", 1, |x, _| x * x),
    ("TRUNC", 1, |x, _| x.trunc()),
    ("ROUND", 1, |x, _| x.round()),
    ("LN", 1, |x, _| x.ln()),
    ("EXP", 1, |x, _| x.exp()),
];
