//! What is calculated: formulas, `FN` functions, and texts.
//!
//! Order of a formula (TNC7 81762x-17, "Rules for formulas"): parentheses, sign and functions, powers
//! (from right to left), multiplication and division, addition and subtraction.

use super::registers::{LONGEST, Parameter, Registers};
use super::scan::Scanner;
use crate::kernel::Outcome;
use crate::kernel::expression::{Grammar, Next, Rank, Span, evaluate};
use program::Rule;
use std::f64::consts::PI;

/// A formula to the end of its block.
pub(crate) fn formula(s: &mut Scanner, registers: &Registers) -> Outcome<f64> {
    let value = evaluate(&mut Formula { s, registers, depth: 0 })?.value;
    s.finish()?;
    Ok(value)
}

/// An operand of an `FN` function: a number or a parameter with a sign.
pub(super) fn operand(s: &mut Scanner, registers: &Registers) -> Outcome<f64> {
    s.is_done();
    let (_, number) = s.number_or_parameter(registers)?;
    number.ok_or_else(|| s.error_here(Rule::Syntax, "a number or a Q parameter is expected here"))
}

/// A text that is put together: `"A" || QS5`, to the end of its block.
pub(crate) fn text(s: &mut Scanner, registers: &Registers) -> Outcome<Vec<u8>> {
    let mut text = Vec::new();
    loop {
        let from = *s;
        match s.parameter()? {
            Some(Parameter::Text(index)) => match registers.text(index) {
                Ok(more) => text.extend_from_slice(more),
                Err(message) => return Err(s.error(Rule::Parameter, (from.at(), s.at()), message)),
            },
            Some(_) => {
                return Err(s.error(Rule::Syntax, (from.at(), s.at()), "a text is expected here"));
            }
            None if s.peek().starts_with(b"\"") => text.extend_from_slice(s.quoted()?),
            None => {
                let message = "a text in quotes or a QS parameter is expected here";
                let help = "the functions of texts (TOCHAR, SUBSTR ...) are not supported";
                return Err(s.error_here(Rule::Unsupported, message).help(help).into());
            }
        }
        if text.len() > LONGEST {
            let message = format!("the text is longer than {LONGEST} characters");
            return Err(s.error_block(Rule::Parameter, message));
        }
        if !s.take_symbol(b"||") {
            s.finish()?;
            return Ok(text);
        }
    }
}

struct Formula<'s, 't, 'r> {
    s: &'s mut Scanner<'t>,
    registers: &'r Registers,
    depth: usize,
}

impl Formula<'_, '_, '_> {
    /// A value with its sign, or a function of one.
    fn signed(&mut self) -> Outcome<f64> {
        if self.s.take_symbol(b"-") {
            return Ok(0.0 - self.nested(Self::signed)?);
        }
        if self.s.take_symbol(b"+") {
            return self.nested(Self::signed);
        }
        if self.s.take_symbol(b"(") {
            let value = self.nested(evaluate)?.value;
            if self.s.take_symbol(b")") {
                return Ok(value);
            }
            return Err(self.s.error_here(Rule::Syntax, "a closing parenthesis is expected here"));
        }
        let from = *self.s;
        if let Some(parameter) = self.s.parameter()? {
            return self.registers.number(parameter).map_err(|message| {
                self.s.error(Rule::Parameter, (from.at(), self.s.at()), message)
            });
        }
        let name = self.s.letters();
        if !name.is_empty() {
            return self.function(from, name);
        }
        let (_, number) = self.s.number();
        number.ok_or_else(|| self.s.error_here(Rule::Syntax, "a value is expected here"))
    }

    fn function(&mut self, from: Scanner, name: &[u8]) -> Outcome<f64> {
        if name == b"PI" {
            return Ok(PI);
        }
        let Some(function) = FUNCTIONS.iter().find(|(known, _)| *known == name) else {
            let shown = String::from_utf8_lossy(name);
            let message = format!("{shown} is not a function of formulas");
            return Err(self.s.error(Rule::UnknownWord, (from.at(), self.s.at()), message));
        };
        let argument = self.nested(Self::signed)?;
        let value = (function.1)(argument);
        if value.is_finite() {
            return Ok(value);
        }
        let shown = String::from_utf8_lossy(name);
        Err(self.wrong(from, &format!("{shown} of {argument} cannot be calculated")))
    }

    fn wrong(&self, from: Scanner, message: &str) -> Box<program::Diagnostic> {
        self.s.error(Rule::Expression, (from.at(), self.s.at()), message)
    }
}

/// A number, and what it was calculated from.
struct Number {
    value: f64,
    /// Whether by `*` or `/`, or by `%`.
    points: bool,
    remainder: bool,
}

impl Number {
    fn of(value: f64) -> Number {
        Number { value, points: false, remainder: false }
    }
}

impl Grammar for Formula<'_, '_, '_> {
    type Value = Number;
    type Operator = u8;
    type Error = Box<program::Diagnostic>;
    const DEEPEST: usize = 50;

    fn depth(&mut self) -> &mut usize {
        &mut self.depth
    }

    fn too_deep(&mut self) -> Self::Error {
        let message = format!("the formula is nested more than {} deep", Self::DEEPEST);
        self.s.error_here(Rule::Expression, message)
    }

    fn start(&mut self) -> usize {
        self.s.is_done();
        self.s.at()
    }

    fn end(&self) -> usize {
        self.s.at()
    }

    fn operand(&mut self) -> Outcome<Number> {
        self.signed().map(Number::of)
    }

    fn operator(&mut self) -> Option<Next<u8>> {
        self.s.is_done();
        let operator = self.s.byte()?;
        let rank = match operator {
            b'+' | b'-' => Rank::Left(0),
            b'*' | b'/' | b'%' => Rank::Left(1),
            b'^' => Rank::Right(2),
            _ => return None,
        };
        let at = self.s.at();
        self.s.take_symbol(&[operator]);
        Some(Next { operator, rank, at })
    }

    fn apply(&mut self, operator: u8, [left, right]: [Number; 2], span: Span) -> Outcome<Number> {
        let (a, b) = (left.value, right.value);
        let wrong =
            |from, message: &str| Err(self.s.error(Rule::Expression, (from, span.end), message));
        let (value, points, remainder) = match operator {
            b'+' => (a + b, false, false),
            b'-' => (a - b, false, false),
            b'*' => (a * b, true, false),
            b'/' if b == 0.0 => return wrong(span.operator, "a division by 0"),
            b'/' => (a / b, true, false),
            b'%' if b == 0.0 || a < 0.0 || b < 0.0 => {
                let message = "a remainder is taken of positive numbers here";
                return wrong(span.operator, message);
            }
            b'%' => (a % b, false, true),
            _ => {
                let power = a.powf(b);
                if !power.is_finite() {
                    let message = format!("{a} cannot be raised to the power of {b}");
                    return wrong(span.start, &message);
                }
                (power, false, false)
            }
        };
        if points && left.remainder || remainder && (left.points || left.remainder) {
            let message = "the manuals do not say in which order % is calculated here";
            return wrong(span.operator, message);
        }
        Ok(Number { value, points, remainder })
    }
}

/// A function of one number; NaN or infinite where it has no value.
type Function = fn(f64) -> f64;

/// The functions of formulas. Angles are degrees.
const FUNCTIONS: [(&[u8], Function); 16] = [
    (b"SIN", |x| x.to_radians().sin()),
    (b"COS", |x| x.to_radians().cos()),
    (b"TAN", |x| x.to_radians().tan()),
    (b"ASIN", |x| x.asin().to_degrees()),
    (b"ACOS", |x| x.acos().to_degrees()),
    (b"ATAN", |x| x.atan().to_degrees()),
    (b"SQ", |x| x * x),
    (b"SQRT", f64::sqrt),
    (b"LN", f64::ln),
    (b"LOG", f64::log10),
    (b"EXP", f64::exp),
    (b"NEG", |x| 0.0 - x),
    (b"INT", f64::trunc),
    (b"ABS", f64::abs),
    (b"FRAC", f64::fract),
    // Of 0 the iTNC says 1 and the TNC7 says 0.
    (b"SGN", |x| if x == 0.0 { f64::NAN } else { x.signum() }),
];

/// The functions with two operands and the word between them.
const BETWEEN: [(u32, &[u8]); 6] =
    [(1, b"+"), (2, b"-"), (3, b"*"), (4, b"DIV"), (8, b"LEN"), (13, b"ANG")];

/// The value that `FN 0` to `FN 8` and `FN 13` give, from behind their `=`.
pub(crate) fn calculated(s: &mut Scanner, number: u32, registers: &Registers) -> Outcome<f64> {
    let one = |s: &mut Scanner, word: &[u8]| {
        if !s.take_symbol(word) {
            let message = format!("{} is expected here", String::from_utf8_lossy(word));
            return Err(s.error_here(Rule::Syntax, message));
        }
        operand(s, registers)
    };
    let value = match number {
        0 => operand(s, registers)?,
        5 => one(s, b"SQRT")?.sqrt(),
        6 => one(s, b"SIN")?.to_radians().sin(),
        7 => one(s, b"COS")?.to_radians().cos(),
        _ => {
            let first = operand(s, registers)?;
            let word = BETWEEN.iter().find(|(n, _)| *n == number).map_or(&b"+"[..], |(_, w)| w);
            // The division is shown as DIV or as a stroke.
            let word = if number == 4 && s.take_symbol(b"/") { b"" } else { word };
            let second = one(s, word)?;
            match number {
                1 => first + second,
                2 => first - second,
                3 => first * second,
                4 => first / second,
                8 => first.hypot(second),
                // The angle whose opposite side is the first and whose adjacent side is the second.
                _ => first.atan2(second).to_degrees().rem_euclid(360.0),
            }
        }
    };
    s.finish()?;
    if value.is_finite() {
        return Ok(value);
    }
    Err(s.error_block(
        Rule::Expression,
        format!("FN {number} cannot be calculated with these values"),
    ))
}

/// What an `IF` of `FN 9` to `FN 12` says: whether the jump is made. The scanner ends before GOTO.
pub(crate) fn condition(s: &mut Scanner, number: u32, registers: &Registers) -> Outcome<bool> {
    s.expect(b"IF")?;
    let first = operand(s, registers)?;
    let word: &[u8] = match number {
        9 => b"EQU",
        10 => b"NE",
        11 => b"GT",
        _ => b"LT",
    };
    if !s.take_symbol(word) {
        let message = format!("{} is expected here", String::from_utf8_lossy(word));
        return Err(s.error_here(Rule::Syntax, message));
    }
    let second = operand(s, registers)?;
    Ok(match number {
        9 => first == second,
        10 => first != second,
        11 => first > second,
        _ => first < second,
    })
}
