//! Arithmetic, logic and texts: what stands behind `=`, in brackets, and behind `IF`.
//!
//! Operators by rank: `NOT B_NOT` and signs; `*` `/` `DIV` `MOD`; `+` `-`; `B_AND`; `B_XOR`; `B_OR`; `AND`;
//! `XOR`; `OR`; `<<`; the comparisons; from left to right within a rank (Job Planning 04.00, 1.8). Angles
//! are degrees. `/` gives a real number also for two whole numbers.
//!
//! A comparison ranks below `AND`: `R1==1 AND R2==2` is `R1==(1 AND R2)==2`. Whoever writes that means
//! something else; where the two readings differ the block is refused.

use super::functions::{self, MOST_ARGUMENTS};
use super::operators::{Operator, bits, reduce};
use super::scan::Scanner;
use super::system;
use super::value::Value;
use super::variables::{Place, Readable};
use crate::sinumerik::Fallible;
use program::Diagnostic;
use std::cell::Cell;
use std::rc::Rc;

/// How deep brackets and signs may nest.
const DEEPEST: usize = 32;

/// Evaluates the expressions of one block.
pub(crate) struct Evaluator<'a> {
    /// Before the block.
    pub(super) state: &'a dyn Readable,
    /// What the block has assigned so far.
    pub(super) assigned: &'a [(Place, Value)],
    /// The operator's parameter that the expression has added; it counts as 0.
    pub(super) offset: Cell<Option<usize>>,
}

impl<'a> Evaluator<'a> {
    /// For a block that has assigned `assigned` so far.
    pub fn new(state: &'a dyn Readable, assigned: &'a [(Place, Value)]) -> Evaluator<'a> {
        Evaluator { state, assigned, offset: Cell::new(None) }
    }

    /// Takes an expression of any type.
    pub fn value(&self, scanner: &mut Scanner) -> Fallible<Value> {
        let start = scanner.at;
        let value = self.finite(scanner)?;
        match self.offset.get() {
            None => Ok(value),
            Some(index) => Err(only_added(scanner, start, index)),
        }
    }

    /// Takes a number.
    pub fn expression(&self, scanner: &mut Scanner) -> Fallible<f64> {
        let start = scanner.at;
        let value = self.value(scanner)?;
        number(scanner, start, &value)
    }

    /// Takes an expression to which one parameter of the operator may be added: its value without
    /// that, and the parameter.
    pub fn offset_expression(&self, scanner: &mut Scanner) -> Fallible<(f64, Option<usize>)> {
        let start = scanner.at;
        let value = self.finite(scanner)?;
        Ok((number(scanner, start, &value)?, self.offset.take()))
    }

    /// Takes a condition.
    pub fn condition(&self, scanner: &mut Scanner) -> Fallible<bool> {
        let start = scanner.at;
        let value = self.value(scanner)?;
        value.truth().ok_or_else(|| {
            let message = format!("a condition is a number or a BOOL, not {}", value.name());
            scanner.error_since(start, "type", message)
        })
    }

    /// Takes a text.
    pub fn text(&self, scanner: &mut Scanner) -> Fallible<Rc<str>> {
        let start = scanner.at;
        match self.value(scanner)? {
            Value::Text(text) => Ok(text),
            other => {
                let message = format!("a text must stand here, not {}", other.name());
                Err(scanner.error_since(start, "type", message))
            }
        }
    }

    /// Takes a whole number within `range`.
    pub fn within(
        &self,
        scanner: &mut Scanner,
        range: std::ops::RangeInclusive<u32>,
    ) -> Fallible<u32> {
        scanner.blanks();
        let start = scanner.at;
        let value = self.expression(scanner)?;
        let bounds = f64::from(*range.start())..=f64::from(*range.end());
        if value.fract() == 0.0 && bounds.contains(&value) {
            return Ok(value as u32);
        }
        let message = format!(
            "a whole number from {} to {} must stand here, not {value}",
            range.start(),
            range.end()
        );
        Err(scanner.error_since(start, "number", message))
    }

    fn finite(&self, scanner: &mut Scanner) -> Fallible<Value> {
        let start = scanner.at;
        let value = self.chain(scanner, 0)?;
        if value.number().is_none_or(f64::is_finite) {
            return Ok(value);
        }
        Err(scanner.error_since(start, "arithmetic", "the result is not a finite number"))
    }

    /// Sums, joined by comparisons and logic.
    fn chain(&self, scanner: &mut Scanner, depth: usize) -> Fallible<Value> {
        if depth > DEEPEST {
            return Err(scanner.error_here("syntax", "brackets nest too deep"));
        }
        scanner.blanks();
        let start = scanner.at;
        let first = self.sum(scanner, depth)?;
        let Some(operator) = Operator::take(scanner) else { return Ok(first) };
        if let Some(index) = self.offset.get() {
            return Err(only_added(scanner, start, index));
        }
        let (mut operands, mut operators) = (vec![first], vec![operator]);
        loop {
            operands.push(self.sum(scanner, depth)?);
            match Operator::take(scanner) {
                Some(operator) => operators.push(operator),
                None => break,
            }
        }
        if let Some(index) = self.offset.get() {
            return Err(only_added(scanner, start, index));
        }
        let doubtful = operators.len() > 1 && operators.iter().any(|o| o.compares());
        let usual = doubtful.then(|| reduce(operands.clone(), &operators, Operator::usual_rank));
        let value = reduce(operands, &operators, Operator::rank)
            .map_err(|message| scanner.error_since(start, "type", message))?;
        if usual.is_none_or(|usual| usual.as_ref() == Ok(&value)) {
            return Ok(value);
        }
        Err(rank_in_doubt(scanner, start))
    }

    fn sum(&self, scanner: &mut Scanner, depth: usize) -> Fallible<Value> {
        let start = scanner.at;
        let mut value = self.term(scanner, depth, true)?;
        loop {
            let added = scanner.take(b'+');
            if !added && !scanner.take(b'-') {
                return Ok(value);
            }
            let term = self.term(scanner, depth, added)?;
            value = match (value.whole(), term.whole()) {
                (Some(a), Some(b)) => {
                    let sum = if added { a.checked_add(b) } else { a.checked_sub(b) };
                    Value::Int(sum.ok_or_else(|| too_large(scanner, start))?)
                }
                _ => {
                    let a = number(scanner, start, &value)?;
                    let b = number(scanner, start, &term)?;
                    Value::Real(if added { a + b } else { a - b })
                }
            };
        }
    }

    /// A product, which is added or taken off. A parameter of the operator is one by itself, outside
    /// of brackets and added: anything else would not be an offset.
    fn term(&self, scanner: &mut Scanner, depth: usize, added: bool) -> Fallible<Value> {
        scanner.blanks();
        let start = scanner.at;
        let before = self.offset.take();
        let value = self.product(scanner, depth)?;
        let Some(index) = self.offset.get() else {
            self.offset.set(before);
            return Ok(value);
        };
        let text = scanner.source.text.get(start..scanner.at).unwrap_or_default().trim_ascii();
        let alone = text.iter().skip(1).all(u8::is_ascii_digit);
        if alone && added && depth == 0 && before.is_none() {
            return Ok(value);
        }
        Err(only_added(scanner, start, index))
    }

    fn product(&self, scanner: &mut Scanner, depth: usize) -> Fallible<Value> {
        let start = scanner.at;
        let mut value = self.signed(scanner, depth)?;
        loop {
            let at = scanner.at;
            if scanner.take(b'*') {
                let factor = self.signed(scanner, depth)?;
                value = match (value.whole(), factor.whole()) {
                    (Some(a), Some(b)) => {
                        Value::Int(a.checked_mul(b).ok_or_else(|| too_large(scanner, start))?)
                    }
                    _ => Value::Real(
                        number(scanner, start, &value)? * number(scanner, start, &factor)?,
                    ),
                };
                continue;
            }
            let division = if scanner.take(b'/') {
                Division::Exact
            } else if scanner.take_word("DIV") {
                Division::Whole
            } else if scanner.take_word("MOD") {
                Division::Rest
            } else {
                return Ok(value);
            };
            let divisor = self.signed(scanner, depth)?;
            let (a, b) = (number(scanner, start, &value)?, number(scanner, start, &divisor)?);
            if b == 0.0 {
                return Err(scanner.error_since(at, "arithmetic", "division by zero"));
            }
            let whole = value.whole().is_some() && divisor.whole().is_some();
            value = match division {
                Division::Exact => Value::Real(a / b),
                // Whole numbers that doubles do not hold do not come out of INT variables.
                Division::Whole if whole => Value::Int((a / b).trunc() as i64),
                Division::Rest if whole => Value::Int((a % b) as i64),
                Division::Whole => Value::Real((a / b).trunc()),
                Division::Rest => Value::Real(a % b),
            };
        }
    }

    /// An operand behind signs, `NOT` and `B_NOT`.
    fn signed(&self, scanner: &mut Scanner, depth: usize) -> Fallible<Value> {
        if depth > DEEPEST {
            return Err(scanner.error_here("syntax", "signs nest too deep"));
        }
        scanner.blanks();
        let start = scanner.at;
        match scanner.peek() {
            b'-' => {
                scanner.at += 1;
                match self.signed(scanner, depth + 1)? {
                    Value::Int(value) => Ok(Value::Int(value.saturating_neg())),
                    other => Ok(Value::Real(-number(scanner, start, &other)?)),
                }
            }
            b'+' => {
                scanner.at += 1;
                self.signed(scanner, depth + 1)
            }
            b'N' if scanner.take_word("NOT") => {
                let value = self.signed(scanner, depth + 1)?;
                let back = scanner.at;
                if Operator::take(scanner).is_some_and(Operator::compares) {
                    return Err(rank_in_doubt(scanner, start));
                }
                scanner.at = back;
                let truth = value.truth().ok_or_else(|| no_number(scanner, start, &value))?;
                Ok(Value::Bool(!truth))
            }
            b'B' if scanner.take_word("B_NOT") => {
                let value = self.signed(scanner, depth + 1)?;
                let bits = bits(&value).ok_or_else(|| no_number(scanner, start, &value))?;
                Ok(Value::Int(!bits))
            }
            _ => self.operand(scanner, depth),
        }
    }

    fn operand(&self, scanner: &mut Scanner, depth: usize) -> Fallible<Value> {
        match scanner.peek() {
            b'(' => {
                scanner.at += 1;
                let value = self.chain(scanner, depth + 1)?;
                scanner.expect(b')')?;
                Ok(value)
            }
            b'0'..=b'9' | b'.' => constant(scanner),
            b'"' => scanner.quoted().map(Value::text),
            b'\'' => based_constant(scanner),
            b'R' if scanner.peek_at(1).is_ascii_digit() || scanner.peek_at(1) == b'[' => {
                self.parameter(scanner).map(Value::Real)
            }
            b'$' => system::read(self, self.state, scanner),
            b'A'..=b'Z' | b'_' => self.named(scanner, depth),
            _ => Err(scanner.error_here("syntax", "a value is missing here")),
        }
    }

    /// A variable, a function, a constant or an axis.
    fn named(&self, scanner: &mut Scanner, depth: usize) -> Fallible<Value> {
        let start = scanner.at;
        let name = scanner.name()?;
        if let Some(index) = self.state.locals().find(&name) {
            return self.variable(scanner, start, index);
        }
        match name.as_str() {
            "TRUE" => return Ok(Value::Bool(true)),
            "FALSE" => return Ok(Value::Bool(false)),
            name => {
                if let Some(axis) = system::axis(name) {
                    return Ok(Value::Axis(axis));
                }
            }
        }
        let name = name.as_str();
        let Some(function) = functions::named(name) else {
            let message = format!("'{name}' is not a value that is known here (alarm 12550)");
            let mut error = scanner.error_since(start, "unknown-word", message);
            error.help = "a variable needs its DEF in the same program".into();
            return Err(error);
        };
        scanner.expect(b'(')?;
        let mut arguments = [const { Value::Int(0) }; MOST_ARGUMENTS];
        let mut count = 0;
        for argument in &mut arguments {
            *argument = self.chain(scanner, depth + 1)?;
            count += 1;
            if !scanner.take(b',') {
                break;
            }
        }
        scanner.expect(b')')?;
        let arguments = arguments.get(..count).unwrap_or(&[]);
        let value = function(arguments).and_then(|value| match value.number() {
            Some(number) if !number.is_finite() => Err(String::from("it has no value here")),
            _ => Ok(value),
        });
        value.map_err(|message| {
            scanner.error_since(start, "arithmetic", format!("{name}: {message}"))
        })
    }
}

/// How a division is made.
#[derive(Clone, Copy)]
enum Division {
    /// `/`.
    Exact,
    /// `DIV`: the whole quotient.
    Whole,
    /// `MOD`: what remains.
    Rest,
}

fn number(scanner: &Scanner, start: usize, value: &Value) -> Fallible<f64> {
    value.number().ok_or_else(|| no_number(scanner, start, value))
}

#[cold]
fn no_number(scanner: &Scanner, start: usize, value: &Value) -> Box<Diagnostic> {
    let message = format!("a number must stand here, not {}", value.name());
    scanner.error_since(start, "type", message)
}

#[cold]
fn too_large(scanner: &Scanner, start: usize) -> Box<Diagnostic> {
    scanner.error_since(start, "arithmetic", "the result is beyond the whole numbers")
}

#[cold]
fn rank_in_doubt(scanner: &Scanner, start: usize) -> Box<Diagnostic> {
    let message = "comparisons rank below AND, OR, XOR and NOT on this control, and here that gives \
                   another result than reading them first";
    let mut error = scanner.error_since(start, "operator-rank", message);
    error.help = "put every comparison in brackets: (R1==1) AND (R2==2)".into();
    error
}

/// A number; one without a point is whole.
fn constant(scanner: &mut Scanner) -> Fallible<Value> {
    let start = scanner.at;
    let value = scanner.constant()?;
    let text = scanner.source.text.get(start..scanner.at).unwrap_or(&[]);
    if text.len() <= 10 && text.iter().all(u8::is_ascii_digit) {
        return Ok(Value::Int(value as i64));
    }
    Ok(Value::Real(value))
}

/// `'HFF'`, `'B101'`.
fn based_constant(scanner: &mut Scanner) -> Fallible<Value> {
    let start = scanner.at;
    let rest = scanner.source.text.get(start + 1..).unwrap_or(&[]);
    let end = rest.iter().position(|byte| *byte == b'\'').unwrap_or(0);
    let text = rest.get(..end).and_then(|text| str::from_utf8(text).ok()).unwrap_or("");
    let base = match text.as_bytes().first() {
        Some(b'H' | b'h') => 16,
        Some(b'B' | b'b') => 2,
        _ => 0,
    };
    let digits = text.get(1..).unwrap_or("");
    scanner.at = start + end + 2;
    let plain = digits.bytes().all(|byte| byte.is_ascii_alphanumeric());
    match u32::from_str_radix(digits, base.max(2)) {
        Ok(value) if base > 0 && plain => Ok(Value::Int(i64::from(value))),
        _ => {
            let message =
                "a number in quotes is 'H' with hexadecimal digits or 'B' with binary ones";
            Err(scanner.error_since(start, "number", message))
        }
    }
}

fn only_added(scanner: &Scanner, start: usize, index: usize) -> Box<Diagnostic> {
    let message = format!(
        "R{index} is the operator's: it is only added to the position of a rotary axis, once, as in \
         C=45+R{index}"
    );
    scanner.error_since(start, "operator-offset", message)
}
