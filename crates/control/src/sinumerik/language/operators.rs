//! The operators, with the rank of each.

use super::axis;
use super::scan::Scanner;
use super::value::{LONGEST_TEXT, Value};

/// How far apart two reals may be, as a part of the larger, and still be equal (Job Planning 12/2019,
/// 3.1.3.4: relative equality).
const RELATIVE_EQUALITY: f64 = 1e-12;

/// An operator between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Times,
    /// `/`: a real number, also of two whole ones.
    Divide,
    /// `DIV`: the whole quotient.
    Quotient,
    /// `MOD`: what remains.
    Remainder,
    Plus,
    Minus,
    BitAnd,
    BitXor,
    BitOr,
    And,
    Xor,
    Or,
    Chain,
    Equal,
    Unequal,
    Greater,
    Less,
    GreaterOrEqual,
    LessOrEqual,
}

/// The operators that are words.
const WORDS: [(&str, Operator); 8] = [
    ("AND", Operator::And),
    ("OR", Operator::Or),
    ("XOR", Operator::Xor),
    ("B_AND", Operator::BitAnd),
    ("B_OR", Operator::BitOr),
    ("B_XOR", Operator::BitXor),
    ("DIV", Operator::Quotient),
    ("MOD", Operator::Remainder),
];

impl Operator {
    /// Takes an operator where one comes next.
    #[inline]
    pub fn take(scanner: &mut Scanner) -> Option<Operator> {
        let back = scanner.at;
        scanner.blanks();
        let (operator, length) = match (scanner.peek(), scanner.peek_at(1)) {
            (b'=', b'=') => (Operator::Equal, 2),
            (b'<', b'>') => (Operator::Unequal, 2),
            (b'<', b'<') => (Operator::Chain, 2),
            (b'<', b'=') => (Operator::LessOrEqual, 2),
            (b'>', b'=') => (Operator::GreaterOrEqual, 2),
            (b'+', _) => (Operator::Plus, 1),
            (b'-', _) => (Operator::Minus, 1),
            (b'*', _) => (Operator::Times, 1),
            (b'/', _) => (Operator::Divide, 1),
            (b'<', _) => (Operator::Less, 1),
            (b'>', _) => (Operator::Greater, 1),
            (b'A' | b'O' | b'X' | b'B' | b'D' | b'M', next)
                if next == b'_' || next.is_ascii_alphabetic() =>
            {
                let found = WORDS.iter().find(|(word, _)| scanner.take_word(word));
                if found.is_none() {
                    scanner.at = back;
                }
                return found.map(|(_, operator)| *operator);
            }
            _ => {
                scanner.at = back;
                return None;
            }
        };
        scanner.at += length;
        Some(operator)
    }

    /// Whether it is a comparison.
    pub fn compares(self) -> bool {
        self.rank() == 0
    }

    /// Whether it joins texts, truths, bits or comparisons, and ranks below the sums.
    pub fn is_logic(self) -> bool {
        self.rank() < 8
    }

    /// The rank of the control, the highest binds closest.
    pub fn rank(self) -> u8 {
        match self {
            Operator::Times | Operator::Divide | Operator::Quotient | Operator::Remainder => 9,
            Operator::Plus | Operator::Minus => 8,
            Operator::BitAnd => 7,
            Operator::BitXor => 6,
            Operator::BitOr => 5,
            Operator::And => 4,
            Operator::Xor => 3,
            Operator::Or => 2,
            Operator::Chain => 1,
            _ => 0,
        }
    }

    /// The rank of the usual languages, where comparisons come before logic.
    pub fn usual_rank(self) -> u8 {
        match self {
            Operator::Chain => 5,
            Operator::And | Operator::Xor | Operator::Or => self.rank() - 1,
            _ if self.compares() => 4,
            other => other.rank(),
        }
    }

    /// What logic, a comparison or `<<` makes of two values.
    ///
    /// # Errors
    /// They have no such result.
    pub fn apply(self, a: Value, b: Value) -> Result<Value, String> {
        let truth = |value: &Value| {
            value.truth().ok_or_else(|| format!("{} is no operand of AND, OR, XOR", value.name()))
        };
        let whole = |value: &Value| {
            bits(value).ok_or_else(|| {
                format!("{} is no operand of B_AND, B_OR, B_XOR but whole", value.name())
            })
        };
        Ok(match self {
            Operator::And => Value::Bool(truth(&a)? & truth(&b)?),
            Operator::Or => Value::Bool(truth(&a)? | truth(&b)?),
            Operator::Xor => Value::Bool(truth(&a)? ^ truth(&b)?),
            Operator::BitAnd => Value::Int(whole(&a)? & whole(&b)?),
            Operator::BitOr => Value::Int(whole(&a)? | whole(&b)?),
            Operator::BitXor => Value::Int(whole(&a)? ^ whole(&b)?),
            Operator::Chain => {
                let text = format!("{}{}", written(&a), written(&b));
                if text.len() > LONGEST_TEXT {
                    return Err(format!("a text of more than {LONGEST_TEXT} characters"));
                }
                Value::text(text)
            }
            _ => Value::Bool(self.compare(&a, &b)?),
        })
    }

    fn compare(self, a: &Value, b: &Value) -> Result<bool, String> {
        use std::cmp::Ordering::{Equal, Greater, Less};
        let order = match (a, b) {
            (Value::Text(a), Value::Text(b)) => a.cmp(b),
            (Value::Axis(a), Value::Axis(b)) => a.cmp(b),
            _ => match (a.number(), b.number()) {
                (Some(a), Some(b)) if (a - b).abs() <= RELATIVE_EQUALITY * a.abs().max(b.abs()) => {
                    Equal
                }
                (Some(a), Some(b)) => a.total_cmp(&b),
                _ => return Err(format!("{} is compared with {}", a.name(), b.name())),
            },
        };
        Ok(match self {
            Operator::Equal => order == Equal,
            Operator::Unequal => order != Equal,
            Operator::Greater => order == Greater,
            Operator::Less => order == Less,
            Operator::GreaterOrEqual => order != Less,
            _ => order != Greater,
        })
    }
}

/// A value as `<<` writes it.
fn written(value: &Value) -> String {
    match value {
        Value::Real(value) => value.to_string(),
        Value::Int(value) => value.to_string(),
        Value::Bool(value) => u8::from(*value).to_string(),
        Value::Char(value) => char::from(*value).to_string(),
        Value::Text(text) => text.to_string(),
        Value::Axis(axis) => axis::axis_name(*axis).to_owned(),
    }
}

/// The bits of a whole number.
pub(super) fn bits(value: &Value) -> Option<i64> {
    let whole = |real: f64| real.fract() == 0.0 && real.abs() <= f64::from(u32::MAX);
    value.whole().or_else(|| value.number().filter(|real| whole(*real)).map(|real| real as i64))
}
