//! Arithmetic, logic and texts: what stands behind `=`, in brackets, and behind `IF`.
//!
//! Operators by rank: `NOT B_NOT` and signs; `*` `/` `DIV` `MOD`; `+` `-`; `B_AND`; `B_XOR`; `B_OR`; `AND`;
//! `XOR`; `OR`; `<<`; the comparisons; from left to right within a rank (Job Planning 04.00, 1.8). Angles
//! are degrees. `/` gives a real number also for two whole numbers.
//!
//! A comparison ranks below `AND`: `R1==1 AND R2==2` is `R1==(1 AND R2)==2`. Whoever writes that means
//! something else; where the two readings differ the block is refused.

use super::axis;
use super::functions::{self, MOST_ARGUMENTS};
use super::operators::{Operator, bits};
use super::scan::Scanner;
use super::system;
use super::value::Value;
use super::variables::{AssignmentTarget, Readable};
use crate::kernel::Outcome;
use crate::kernel::expression::{self, Grammar, Next, Rank, Span, Stack};
use program::{Diagnostic, Rule};
use std::rc::Rc;

/// Evaluates the expressions of one block.
pub(crate) struct Evaluator<'a> {
    /// Before the block.
    pub(super) state: &'a dyn Readable,
    /// What the block has assigned so far.
    pub(super) assigned: &'a [(AssignmentTarget, Value)],
}

/// A value, and the operator's parameter that is added to it, which counts as 0.
#[derive(Clone)]
pub(super) struct Operand {
    pub value: Value,
    pub offset: Option<usize>,
}

impl From<Value> for Operand {
    fn from(value: Value) -> Operand {
        Operand { value, offset: None }
    }
}

impl<'a> Evaluator<'a> {
    /// For a block that has assigned `assigned` so far.
    pub fn new(
        state: &'a dyn Readable,
        assigned: &'a [(AssignmentTarget, Value)],
    ) -> Evaluator<'a> {
        Evaluator { state, assigned }
    }

    /// Takes an expression of any type.
    pub fn value(&self, scanner: &mut Scanner) -> Outcome<Value> {
        let start = scanner.at;
        let found = self.finite(scanner)?;
        without_offset(scanner, start, found)
    }

    /// Takes a number.
    pub fn expression(&self, scanner: &mut Scanner) -> Outcome<f64> {
        let start = scanner.at;
        let value = self.value(scanner)?;
        number(scanner, start, &value)
    }

    /// Takes an expression to which one parameter of the operator may be added: its value without
    /// that, and the parameter.
    pub fn offset_expression(&self, scanner: &mut Scanner) -> Outcome<(f64, Option<usize>)> {
        let start = scanner.at;
        let found = self.finite(scanner)?;
        Ok((number(scanner, start, &found.value)?, found.offset))
    }

    /// Takes a condition.
    pub fn condition(&self, scanner: &mut Scanner) -> Outcome<bool> {
        let start = scanner.at;
        let value = self.value(scanner)?;
        value.truth().ok_or_else(|| {
            let message = format!("a condition is a number or a BOOL, not {}", value.name());
            scanner.error_since(start, Rule::Type, message)
        })
    }

    /// Takes a text.
    pub fn text(&self, scanner: &mut Scanner) -> Outcome<Rc<str>> {
        let start = scanner.at;
        match self.value(scanner)? {
            Value::Text(text) => Ok(text),
            other => {
                let message = format!("a text must stand here, not {}", other.name());
                Err(scanner.error_since(start, Rule::Type, message))
            }
        }
    }

    /// Takes a whole number within `range`.
    pub fn within(
        &self,
        scanner: &mut Scanner,
        range: std::ops::RangeInclusive<u32>,
    ) -> Outcome<u32> {
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
        Err(scanner.error_since(start, Rule::Number, message))
    }

    fn finite(&self, scanner: &mut Scanner) -> Outcome<Operand> {
        let start = scanner.at;
        let found = Expression { evaluator: self, scanner, depth: 0 }.whole()?;
        if found.value.number().is_none_or(f64::is_finite) {
            return Ok(found);
        }
        Err(scanner.error_since(start, Rule::Arithmetic, "the result is not a finite number"))
    }
}

/// An expression on its way through its block.
struct Expression<'e, 'a, 's, 't> {
    evaluator: &'e Evaluator<'a>,
    scanner: &'s mut Scanner<'t>,
    depth: usize,
}

impl Expression<'_, '_, '_, '_> {
    /// An expression. It is read by the ranks of the control, and where it compares also by the usual ones.
    fn whole(&mut self) -> Outcome<Operand> {
        let mut own = Stack::default();
        let mut read = Vec::new();
        let start = self.start();
        let (found, last) = loop {
            let from = self.start();
            let value = self.operand()?;
            let right = expression::Operand { value, place: [from, self.end()] };
            let next = self.operator();
            let rank = next.map(|next| next.rank);
            // What stands before the first comparison or logic is the same by both ranks.
            let kept = (!read.is_empty()).then(|| right.clone());
            let settled = own.settle(right, rank, |o, v, span| self.apply(o, v, span))?;
            match (next, kept) {
                (Some(next), kept) => {
                    if next.operator.is_logic() || kept.is_some() {
                        read.push((kept.unwrap_or_else(|| settled.clone()), next));
                    }
                    own.push(settled, next);
                }
                (None, Some(last)) => break (settled.value, last),
                (None, None) => return Ok(settled.value),
            }
        };
        let logical = read.iter().filter(|(_, next)| next.operator.is_logic()).count();
        if logical < 2 || !read.iter().any(|(_, next)| next.operator.compares()) {
            return Ok(found);
        }
        let usual = (|| {
            let mut usual = Stack::default();
            for (operand, next) in read {
                let next = Next { rank: Rank::Left(next.operator.usual_rank()), ..next };
                let apply = |o, v, span| self.apply(o, v, span);
                let settled = usual.settle(operand, Some(next.rank), apply)?;
                usual.push(settled, next);
            }
            usual.settle(last, None, |o, v, span| self.apply(o, v, span))
        })();
        match usual {
            Ok(usual) if usual.value.value == found.value => Ok(found),
            _ => Err(rank_in_doubt(self.scanner, start)),
        }
    }

    /// An expression in brackets, behind the first of them.
    fn inner(&mut self) -> Outcome<Value> {
        let start = self.scanner.at;
        let found = self.nested(Self::whole)?;
        without_offset(self.scanner, start, found)
    }

    /// An operand behind signs, `NOT` and `B_NOT`.
    fn signed(&mut self) -> Outcome<Operand> {
        self.scanner.blanks();
        let start = self.scanner.at;
        let sign = match self.scanner.peek() {
            sign @ (b'-' | b'+') => {
                self.scanner.at += 1;
                sign
            }
            b'N' if self.scanner.take_word("NOT") => b'N',
            b'B' if self.scanner.take_word("B_NOT") => b'B',
            _ => return self.operand_alone(),
        };
        let found = self.nested(Self::signed)?;
        let value = without_offset(self.scanner, start, found)?;
        Ok(Operand::from(match (sign, value) {
            (b'+', value) => value,
            (b'-', Value::Int(value)) => Value::Int(value.saturating_neg()),
            (b'-', value) => Value::Real(-number(self.scanner, start, &value)?),
            (b'N', value) => {
                let back = self.scanner.at;
                if Operator::take(self.scanner).is_some_and(Operator::compares) {
                    return Err(rank_in_doubt(self.scanner, start));
                }
                self.scanner.at = back;
                let truth = value.truth();
                Value::Bool(!truth.ok_or_else(|| {
                    self.scanner.error_since(start, Rule::Type, no_number(&value))
                })?)
            }
            (_, value) => {
                let bits = bits(&value).ok_or_else(|| {
                    self.scanner.error_since(start, Rule::Type, no_number(&value))
                })?;
                Value::Int(!bits)
            }
        }))
    }

    fn operand_alone(&mut self) -> Outcome<Operand> {
        let scanner = &mut *self.scanner;
        let value = match scanner.peek() {
            b'(' => {
                scanner.at += 1;
                let value = self.inner()?;
                self.scanner.expect(b')')?;
                value
            }
            b'0'..=b'9' | b'.' => constant(scanner)?,
            b'"' => Value::text(scanner.quoted()?),
            b'\'' => based_constant(scanner)?,
            b'R' if scanner.peek_at(1).is_ascii_digit() || scanner.peek_at(1) == b'[' => {
                return self.evaluator.parameter(scanner);
            }
            b'$' => system::read(self.evaluator, self.evaluator.state, scanner)?,
            b'A'..=b'Z' | b'_' => self.named()?,
            _ => return Err(scanner.error_here(Rule::Syntax, "a value is missing here")),
        };
        Ok(value.into())
    }

    /// A variable, a function, a constant or an axis.
    fn named(&mut self) -> Outcome<Value> {
        let scanner = &mut *self.scanner;
        let start = scanner.at;
        let name = scanner.name()?;
        if let Some(index) = self.evaluator.state.locals().find(&name) {
            return self.evaluator.variable(scanner, start, index);
        }
        match name.as_str() {
            "TRUE" => return Ok(Value::Bool(true)),
            "FALSE" => return Ok(Value::Bool(false)),
            name => {
                if let Some(axis) = axis::axis(name) {
                    return Ok(Value::Axis(axis));
                }
            }
        }
        let name = name.as_str();
        let Some(function) = functions::named(name) else {
            let message = format!("'{name}' is not a value that is known here (alarm 12550)");
            let mut error = scanner.error_since(start, Rule::UnknownWord, message);
            error.help = "a variable needs its DEF in the same program".into();
            return Err(error);
        };
        scanner.expect(b'(')?;
        let mut arguments = [const { Value::Int(0) }; MOST_ARGUMENTS];
        let mut count = 0;
        for argument in &mut arguments {
            *argument = self.inner()?;
            count += 1;
            if !self.scanner.take(b',') {
                break;
            }
        }
        self.scanner.expect(b')')?;
        let arguments = arguments.get(..count).unwrap_or(&[]);
        let value = function(arguments).and_then(|value| match value.number() {
            Some(number) if !number.is_finite() => Err(String::from("it has no value here")),
            _ => Ok(value),
        });
        value.map_err(|message| {
            self.scanner.error_since(start, Rule::Arithmetic, format!("{name}: {message}"))
        })
    }
}

/// A sum, difference, product or quotient of two numbers.
///
/// # Errors
/// The rule, the byte from which on the block is meant, and what to say where there is none.
fn calculated(
    operator: Operator,
    a: &Value,
    b: &Value,
    span: Span,
) -> Result<Value, (Rule, usize, String)> {
    let number = |v: &Value| v.number().ok_or_else(|| (Rule::Type, span.start, no_number(v)));
    let (x, y) = (number(a)?, number(b)?);
    let divides = !matches!(operator, Operator::Plus | Operator::Minus | Operator::Times);
    if divides && y == 0.0 {
        return Err((Rule::Arithmetic, span.operator, "division by zero".into()));
    }
    let Some((m, n)) = a.whole().zip(b.whole()) else {
        return Ok(Value::Real(match operator {
            Operator::Plus => x + y,
            Operator::Minus => x - y,
            Operator::Times => x * y,
            Operator::Quotient => (x / y).trunc(),
            Operator::Remainder => x % y,
            _ => x / y,
        }));
    };
    let whole = match operator {
        Operator::Plus => m.checked_add(n),
        Operator::Minus => m.checked_sub(n),
        Operator::Times => m.checked_mul(n),
        // Whole numbers that doubles do not hold do not come out of INT variables.
        Operator::Quotient => Some((x / y).trunc() as i64),
        Operator::Remainder => Some((x % y) as i64),
        _ => return Ok(Value::Real(x / y)),
    };
    whole.map(Value::Int).ok_or_else(|| {
        (Rule::Arithmetic, span.start, "the result is beyond the whole numbers".into())
    })
}

impl Grammar for Expression<'_, '_, '_, '_> {
    type Value = Operand;
    type Operator = Operator;
    type Error = Box<Diagnostic>;
    const DEEPEST: usize = 32;

    fn depth(&mut self) -> &mut usize {
        &mut self.depth
    }

    fn too_deep(&mut self) -> Box<Diagnostic> {
        self.scanner.error_here(Rule::Syntax, "brackets and signs nest too deep")
    }

    fn start(&mut self) -> usize {
        self.scanner.blanks();
        self.scanner.at
    }

    fn end(&self) -> usize {
        self.scanner.at
    }

    fn operand(&mut self) -> Outcome<Operand> {
        self.signed()
    }

    fn operator(&mut self) -> Option<Next<Operator>> {
        let at = self.scanner.at;
        let operator = Operator::take(self.scanner)?;
        Some(Next { operator, rank: Rank::Left(operator.rank()), at })
    }

    /// A parameter of the operator is only added: anything else would not be an offset.
    fn apply(
        &mut self,
        operator: Operator,
        [left, right]: [Operand; 2],
        span: Span,
    ) -> Outcome<Operand> {
        let error = |(rule, start, message): (_, _, String)| {
            self.scanner.source.error(rule, start..span.end, message)
        };
        let offset = match (left.offset, right.offset) {
            (None, None) => None,
            (None, Some(index)) if operator == Operator::Plus => Some(index),
            (Some(index), None) if matches!(operator, Operator::Plus | Operator::Minus) => {
                Some(index)
            }
            (_, Some(index)) | (Some(index), None) => {
                return Err(error((Rule::OperatorOffset, span.start, only_added(index))));
            }
        };
        let (a, b) = (left.value, right.value);
        let value = match operator.is_logic() {
            true => operator.apply(a, b).map_err(|message| (Rule::Type, span.start, message)),
            false => calculated(operator, &a, &b, span),
        };
        Ok(Operand { value: value.map_err(error)?, offset })
    }
}

fn number(scanner: &Scanner, start: usize, value: &Value) -> Outcome<f64> {
    value.number().ok_or_else(|| scanner.error_since(start, Rule::Type, no_number(value)))
}

#[cold]
fn no_number(value: &Value) -> String {
    format!("a number must stand here, not {}", value.name())
}

#[cold]
fn rank_in_doubt(scanner: &Scanner, start: usize) -> Box<Diagnostic> {
    let message = "comparisons rank below AND, OR, XOR and NOT on this control, and here that gives \
                   another result than reading them first";
    let mut error = scanner.error_since(start, Rule::OperatorRank, message);
    error.help = "put every comparison in brackets: (R1==1) AND (R2==2)".into();
    error
}

/// A number; one without a point is whole.
fn constant(scanner: &mut Scanner) -> Outcome<Value> {
    let start = scanner.at;
    let value = scanner.constant()?;
    let text = scanner.source.text.get(start..scanner.at).unwrap_or(&[]);
    if text.len() <= 10 && text.iter().all(u8::is_ascii_digit) {
        return Ok(Value::Int(value as i64));
    }
    Ok(Value::Real(value))
}

/// `'HFF'`, `'B101'`.
fn based_constant(scanner: &mut Scanner) -> Outcome<Value> {
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
            Err(scanner.error_since(start, Rule::Number, message))
        }
    }
}

/// The value of an operand to which no parameter of the operator is added.
pub(super) fn without_offset(scanner: &Scanner, start: usize, found: Operand) -> Outcome<Value> {
    match found.offset {
        None => Ok(found.value),
        Some(index) => Err(scanner.error_since(start, Rule::OperatorOffset, only_added(index))),
    }
}

#[cold]
fn only_added(index: usize) -> String {
    format!(
        "R{index} is the operator's: it is only added to the position of a rotary axis, once, as in \
         C=45+R{index}"
    )
}
