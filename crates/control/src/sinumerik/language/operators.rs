//! The operators of logic, texts and comparisons, with the rank of each.

use super::scan::Scanner;
use super::system;
use super::value::{LONGEST_TEXT, Value};

/// How far apart two reals may be, as a part of the larger, and still be equal (Job Planning 12/2019,
/// 3.1.3.4: relative equality).
const RELATIVE_EQUALITY: f64 = 1e-12;

/// An operator that ranks below the sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
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
const WORDS: [(&str, Operator); 6] = [
    ("AND", Operator::And),
    ("OR", Operator::Or),
    ("XOR", Operator::Xor),
    ("B_AND", Operator::BitAnd),
    ("B_OR", Operator::BitOr),
    ("B_XOR", Operator::BitXor),
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
            (b'<', _) => (Operator::Less, 1),
            (b'>', _) => (Operator::Greater, 1),
            (b'A' | b'O' | b'X' | b'B', next) if next == b'_' || next.is_ascii_alphabetic() => {
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
        self.rank() == 11
    }

    /// The rank of the control, the first binds closest.
    pub fn rank(self) -> u8 {
        match self {
            Operator::BitAnd => 4,
            Operator::BitXor => 5,
            Operator::BitOr => 6,
            Operator::And => 7,
            Operator::Xor => 8,
            Operator::Or => 9,
            Operator::Chain => 10,
            _ => 11,
        }
    }

    /// The rank of the usual languages, where comparisons come before logic.
    pub fn usual_rank(self) -> u8 {
        match self {
            Operator::Chain => 6,
            Operator::And | Operator::Xor | Operator::Or => self.rank() + 10,
            other => other.rank(),
        }
    }

    fn apply(self, a: Value, b: Value) -> Result<Value, String> {
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

/// Applies the operators between the operands, those of the first rank first.
pub(super) fn reduce(
    operands: Vec<Value>,
    operators: &[Operator],
    rank: fn(Operator) -> u8,
) -> Result<Value, String> {
    let mut values: Vec<Value> = Vec::with_capacity(operands.len());
    let mut pending: Vec<Operator> = Vec::new();
    let fold = |values: &mut Vec<Value>, operator: Operator| -> Result<(), String> {
        if let (Some(b), Some(a)) = (values.pop(), values.pop()) {
            values.push(operator.apply(a, b)?);
        }
        Ok(())
    };
    let mut operands = operands.into_iter();
    values.extend(operands.next());
    for (operator, operand) in operators.iter().zip(operands) {
        while let Some(before) = pending.pop_if(|before| rank(*before) <= rank(*operator)) {
            fold(&mut values, before)?;
        }
        pending.push(*operator);
        values.push(operand);
    }
    while let Some(operator) = pending.pop() {
        fold(&mut values, operator)?;
    }
    values.pop().ok_or_else(|| String::from("there is no value"))
}

/// A value as `<<` writes it.
fn written(value: &Value) -> String {
    match value {
        Value::Real(value) => value.to_string(),
        Value::Int(value) => value.to_string(),
        Value::Bool(value) => u8::from(*value).to_string(),
        Value::Char(value) => char::from(*value).to_string(),
        Value::Text(text) => text.to_string(),
        Value::Axis(axis) => system::axis_name(*axis).to_owned(),
    }
}

/// The bits of a whole number.
pub(super) fn bits(value: &Value) -> Option<i64> {
    let whole = |real: f64| real.fract() == 0.0 && real.abs() <= f64::from(u32::MAX);
    value.whole().or_else(|| value.number().filter(|real| whole(*real)).map(|real| real as i64))
}
