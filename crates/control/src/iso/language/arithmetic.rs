//! What operators and functions calculate, in RS274/NGC and in custom macro B.

use super::value::Value;
use crate::iso::dialects::facts::Language;

/// How near two numbers are taken as equal in RS274/NGC, and a number as a whole one.
const NEAR: f64 = 1e-4;

/// The largest number that macro B takes as bits.
const MOST_BITS: f64 = 2_147_483_647.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binary {
    Power,
    Times,
    Divide,
    Modulo,
    Plus,
    Minus,
    And,
    Or,
    Xor,
    Equal,
    Unequal,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sqrt,
    Abs,
    Round,
    Fix,
    Fup,
    Ln,
    Exp,
    Exists,
    Pow,
    Bin,
    Bcd,
    Adp,
}

/// Words between two numbers.
pub(super) const BINARY: [(&[u8], Binary); 10] = [
    (b"EQ", Binary::Equal),
    (b"NE", Binary::Unequal),
    (b"GT", Binary::Greater),
    (b"GE", Binary::GreaterOrEqual),
    (b"LT", Binary::Less),
    (b"LE", Binary::LessOrEqual),
    (b"AND", Binary::And),
    (b"OR", Binary::Or),
    (b"XOR", Binary::Xor),
    (b"MOD", Binary::Modulo),
];

/// Functions of both languages.
pub(super) const FUNCTIONS: [(&[u8], Function); 13] = [
    (b"SIN", Function::Sin),
    (b"COS", Function::Cos),
    (b"TAN", Function::Tan),
    (b"ASIN", Function::Asin),
    (b"ACOS", Function::Acos),
    (b"ATAN", Function::Atan),
    (b"SQRT", Function::Sqrt),
    (b"ABS", Function::Abs),
    (b"ROUND", Function::Round),
    (b"FIX", Function::Fix),
    (b"FUP", Function::Fup),
    (b"LN", Function::Ln),
    (b"EXP", Function::Exp),
];

/// Functions of RS274/NGC alone.
pub(super) const NGC_FUNCTIONS: [(&[u8], Function); 1] = [(b"EXISTS", Function::Exists)];

/// Functions of macro B alone; `SQR` and `RND` are short forms (after the long ones).
pub(super) const MACRO_FUNCTIONS: [(&[u8], Function); 6] = [
    (b"POW", Function::Pow),
    (b"BIN", Function::Bin),
    (b"BCD", Function::Bcd),
    (b"ADP", Function::Adp),
    (b"SQR", Function::Sqrt),
    (b"RND", Function::Round),
];

impl Binary {
    /// The higher goes first.
    pub(super) fn rank(self, language: Language) -> u8 {
        let macro_b = language == Language::MacroB;
        match self {
            Binary::And if macro_b => 4,
            Binary::Or | Binary::Xor if macro_b => 3,
            Binary::And | Binary::Or | Binary::Xor => 1,
            Binary::Equal
            | Binary::Unequal
            | Binary::Greater
            | Binary::GreaterOrEqual
            | Binary::Less
            | Binary::LessOrEqual => 2,
            Binary::Plus | Binary::Minus => 3,
            Binary::Times | Binary::Divide | Binary::Modulo => 4,
            Binary::Power => 5,
        }
    }
}

/// The whole number that a calculated one stands for.
pub(crate) fn whole(value: f64) -> Option<u32> {
    let nearest = value.round();
    let near = (value - nearest).abs() <= NEAR && (0.0..=f64::from(u32::MAX)).contains(&nearest);
    near.then_some(nearest as u32)
}

pub(super) fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// RS274/NGC.
pub(super) fn ngc_binary(operator: Binary, left: f64, right: f64) -> Result<f64, &'static str> {
    let near = (left - right).abs() < NEAR;
    let (a, b) = (left != 0.0, right != 0.0);
    Ok(match operator {
        Binary::Plus => left + right,
        Binary::Minus => left - right,
        Binary::Times => left * right,
        Binary::Divide if right == 0.0 => return Err("a division by 0"),
        Binary::Divide => left / right,
        Binary::Modulo if right == 0.0 => return Err("MOD by 0"),
        Binary::Modulo => left.rem_euclid(right),
        Binary::Power if left < 0.0 && right.fract() != 0.0 => {
            return Err("a number below 0 to a power that is not whole");
        }
        Binary::Power => left.powf(right),
        Binary::And => truth(a && b),
        Binary::Or => truth(a || b),
        Binary::Xor => truth(a != b),
        Binary::Equal => truth(near),
        Binary::Unequal => truth(!near),
        Binary::Greater => truth(left > right),
        Binary::GreaterOrEqual => truth(left >= right),
        Binary::Less => truth(left < right),
        Binary::LessOrEqual => truth(left <= right),
    })
}

/// What both languages calculate alike; angles in degrees.
fn function_of_both(function: Function, x: f64) -> Result<f64, &'static str> {
    Ok(match function {
        Function::Sin => x.to_radians().sin(),
        Function::Cos => x.to_radians().cos(),
        Function::Tan => x.to_radians().tan(),
        Function::Asin | Function::Acos if !(-1.0..=1.0).contains(&x) => {
            return Err("the arc sine or arc cosine of a number beyond -1 to 1");
        }
        Function::Asin => x.asin().to_degrees(),
        Function::Acos => x.acos().to_degrees(),
        Function::Sqrt if x < 0.0 => return Err("the square root of a number below 0"),
        Function::Sqrt => x.sqrt(),
        Function::Abs => x.abs(),
        Function::Round => x.round(),
        Function::Ln if x <= 0.0 => return Err("the logarithm of a number that is not above 0"),
        Function::Ln => x.ln(),
        Function::Exp => x.exp(),
        _ => return Err("not a function of one number"),
    })
}

pub(super) fn ngc_function(function: Function, x: f64) -> Result<f64, &'static str> {
    match function {
        Function::Fix => Ok(x.floor()),
        Function::Fup => Ok(x.ceil()),
        _ => function_of_both(function, x),
    }
}

/// Macro B: null counts as 0, but for `EQ` and `NE` (B-63684EN, 16.1 and 16.5).
pub(super) fn macro_binary(
    operator: Binary,
    left: Value,
    right: Value,
) -> Result<Value, &'static str> {
    match operator {
        Binary::Equal => return Ok(Some(truth(left == right))),
        Binary::Unequal => return Ok(Some(truth(left != right))),
        _ => {}
    }
    let (a, b) = (left.unwrap_or(0.0), right.unwrap_or(0.0));
    Ok(Some(match operator {
        Binary::Plus => a + b,
        Binary::Minus => a - b,
        Binary::Times => a * b,
        Binary::Divide if b == 0.0 => return Err("a division by 0"),
        Binary::Divide => a / b,
        Binary::Modulo if b.round() == 0.0 => return Err("MOD by 0"),
        // Of both rounded to whole numbers, with the sign of the first.
        Binary::Modulo => a.round() % b.round(),
        Binary::And => f64::from(bits(a)? & bits(b)?),
        Binary::Or => f64::from(bits(a)? | bits(b)?),
        Binary::Xor => f64::from(bits(a)? ^ bits(b)?),
        Binary::Greater => truth(a > b),
        Binary::GreaterOrEqual => truth(a >= b),
        Binary::Less => truth(a < b),
        _ => truth(a <= b),
    }))
}

/// The 32 bits of a whole number.
fn bits(value: f64) -> Result<i32, &'static str> {
    let whole = value.round();
    if whole.abs() <= MOST_BITS {
        return Ok(whole as i32);
    }
    Err("AND, OR and XOR take numbers of 32 bits")
}

pub(super) fn macro_function(
    function: Function,
    first: Value,
    second: Option<f64>,
) -> Result<f64, &'static str> {
    let x = first.unwrap_or(0.0);
    // Angles begin at 0 (parameter 6004#0 as delivered).
    let positive = |degrees: f64| if degrees < 0.0 { degrees + 360.0 } else { degrees };
    Ok(match (function, second) {
        (Function::Atan, Some(y)) => positive(x.atan2(y).to_degrees()),
        (Function::Atan, None) => x.atan().to_degrees(),
        (Function::Pow, Some(exponent)) => x.powf(exponent),
        (Function::Asin, None) => positive(function_of_both(function, x)?),
        (Function::Fix, None) => x.trunc(),
        (Function::Fup, None) => x.trunc() + if x.fract() == 0.0 { 0.0 } else { x.signum() },
        (Function::Bin, None) => from_bcd(x)?,
        (Function::Bcd, None) => to_bcd(x)?,
        (Function::Adp, None) => {
            return Err("ADP reads how an argument was written; write its point");
        }
        _ => function_of_both(function, x)?,
    })
}

/// The number whose decimal digits are the groups of four bits of `value`.
fn from_bcd(value: f64) -> Result<f64, &'static str> {
    let wrong = "BIN takes a whole number whose groups of four bits are digits";
    if value.fract() != 0.0 || !(0.0..=MOST_BITS).contains(&value) {
        return Err(wrong);
    }
    let (mut rest, mut result, mut place) = (value as u32, 0.0, 1.0);
    while rest > 0 {
        if rest % 16 > 9 {
            return Err(wrong);
        }
        result += f64::from(rest % 16) * place;
        (rest, place) = (rest / 16, place * 10.0);
    }
    Ok(result)
}

/// Each decimal digit in a group of four bits.
fn to_bcd(value: f64) -> Result<f64, &'static str> {
    if value.fract() != 0.0 || !(0.0..=99_999_999.0).contains(&value) {
        return Err("BCD takes a whole number of up to 8 digits");
    }
    let (mut rest, mut result, mut place) = (value as u32, 0.0, 1.0);
    while rest > 0 {
        result += f64::from(rest % 10) * place;
        (rest, place) = (rest / 10, place * 16.0);
    }
    Ok(result)
}
