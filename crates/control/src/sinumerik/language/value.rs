//! Values and the types of variables.
//!
//! How one type becomes another when it is assigned: Job Planning 12/2019, 3.1.1 (a real number is
//! rounded to a whole one, 0.5 upwards; what is not 0 is TRUE).

use std::rc::Rc;

/// Longest text that a variable holds, characters; longer ones are cut by no one, they are refused.
pub(super) const LONGEST_TEXT: usize = 1024;

/// A value of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// `REAL`.
    Real(f64),
    /// `INT`.
    Int(i64),
    /// `BOOL`.
    Bool(bool),
    /// `CHAR`, by its number.
    Char(u8),
    /// `STRING`.
    Text(Rc<str>),
    /// `AXIS`: X Y Z A B C by its index.
    Axis(usize),
}

/// The type of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// `REAL`.
    Real,
    /// `INT`: 32 bits with a sign.
    Int,
    /// `BOOL`.
    Bool,
    /// `CHAR`.
    Char,
    /// `STRING`, with the most characters that it holds.
    Text(usize),
    /// `AXIS`.
    Axis,
}

impl Value {
    /// A text.
    pub fn text(text: impl Into<Rc<str>>) -> Value {
        Value::Text(text.into())
    }

    /// The number that it is in arithmetic.
    #[inline]
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Real(value) => Some(*value),
            Value::Int(value) => Some(*value as f64),
            Value::Bool(value) => Some(f64::from(u8::from(*value))),
            Value::Char(value) => Some(f64::from(*value)),
            Value::Text(_) | Value::Axis(_) => None,
        }
    }

    /// The whole number that it is, where it is one by its type.
    #[inline]
    pub fn whole(&self) -> Option<i64> {
        match self {
            Value::Int(value) => Some(*value),
            Value::Bool(value) => Some(i64::from(*value)),
            Value::Char(value) => Some(i64::from(*value)),
            Value::Real(_) | Value::Text(_) | Value::Axis(_) => None,
        }
    }

    /// Whether it is TRUE: a number that is not 0.
    #[inline]
    pub fn truth(&self) -> Option<bool> {
        self.number().map(|value| value != 0.0)
    }

    /// What kind of value it is, for messages.
    pub fn name(&self) -> &'static str {
        match self {
            Value::Real(_) | Value::Int(_) => "a number",
            Value::Bool(_) => "a BOOL",
            Value::Char(_) => "a CHAR",
            Value::Text(_) => "a text",
            Value::Axis(_) => "an axis",
        }
    }
}

impl Kind {
    /// The value of a variable that nothing has been assigned to yet; an axis has none.
    pub fn initial(self) -> Option<Value> {
        match self {
            Kind::Real => Some(Value::Real(0.0)),
            Kind::Int => Some(Value::Int(0)),
            Kind::Bool => Some(Value::Bool(false)),
            Kind::Char => Some(Value::Char(0)),
            Kind::Text(_) => Some(Value::text("")),
            Kind::Axis => None,
        }
    }

    /// `value` as a variable of this type keeps it.
    ///
    /// # Errors
    /// What to say where it cannot.
    pub fn keep(self, value: Value) -> Result<Value, String> {
        let wrong = |value: &Value| Err(format!("{} does not become {self}", value.name()));
        match (self, &value) {
            (Kind::Text(most), Value::Text(text)) => {
                let length = text.chars().count();
                if length <= most {
                    return Ok(value);
                }
                Err(format!("a text of {length} characters in a {self}"))
            }
            (Kind::Text(most), Value::Char(byte)) if most > 0 => {
                Ok(Value::text(char::from(*byte).to_string()))
            }
            (Kind::Char, Value::Text(text)) => match text.as_bytes() {
                [byte] => Ok(Value::Char(*byte)),
                _ => Err(String::from("a CHAR is one character")),
            },
            (Kind::Axis, Value::Axis(_)) => Ok(value),
            (Kind::Text(_) | Kind::Axis, _) => wrong(&value),
            (_, other) => match (other.number(), self) {
                (None, _) => wrong(other),
                (Some(number), Kind::Real) => Ok(Value::Real(number)),
                (Some(number), Kind::Bool) => Ok(Value::Bool(number != 0.0)),
                (Some(number), Kind::Char) => match (number + 0.5).floor() {
                    byte if (0.0..=255.0).contains(&byte) => Ok(Value::Char(byte as u8)),
                    _ => Err(format!("{number} is not the number of a CHAR (0 to 255)")),
                },
                (Some(number), _) => match (number + 0.5).floor() {
                    whole if whole.abs() <= f64::from(i32::MAX) => Ok(Value::Int(whole as i64)),
                    _ => Err(format!("{number} is beyond an INT (2147483647)")),
                },
            },
        }
    }
}

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Kind::Real => f.write_str("REAL"),
            Kind::Int => f.write_str("INT"),
            Kind::Bool => f.write_str("BOOL"),
            Kind::Char => f.write_str("CHAR"),
            Kind::Text(most) => write!(f, "STRING[{most}]"),
            Kind::Axis => f.write_str("AXIS"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_real_is_rounded_to_an_int_with_the_half_upwards() {
        for (real, int) in [(2.5, 3), (2.4, 2), (-2.5, -2), (-2.6, -3)] {
            assert_eq!(Kind::Int.keep(Value::Real(real)), Ok(Value::Int(int)));
        }
        assert!(Kind::Int.keep(Value::Real(3e9)).is_err());
    }

    #[test]
    fn what_is_not_zero_is_true_and_a_text_is_no_number() {
        assert_eq!(Kind::Bool.keep(Value::Real(0.1)), Ok(Value::Bool(true)));
        assert_eq!(Kind::Real.keep(Value::Bool(true)), Ok(Value::Real(1.0)));
        assert!(Kind::Real.keep(Value::text("1")).is_err());
        assert_eq!(Kind::Char.keep(Value::text("A")), Ok(Value::Char(65)));
        assert!(Kind::Text(2).keep(Value::text("abc")).is_err());
    }
}
