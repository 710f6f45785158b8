//! Values.

use crate::kernel::formula::Typed;
pub(crate) use crate::kernel::scan::Name;
use geom::{Euler, Frame, Vec3};

/// What a formula comes to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// A REAL.
    Number(f64),
    /// An INT: a division of two of them leaves out what is behind the point.
    Integer(i32),
    Flag(bool),
    /// An entry of an enumeration: `#BASE`.
    Entry(Name),
    Text(Box<str>),
    /// An aggregate, field by field in the order of the text.
    Fields(Vec<(Name, Value)>),
    /// A frame that the operator has measured: `TOOL_DATA[3]`.
    OfOperator,
}

/// The coordinates of a position.
pub(crate) const COORDINATES: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];

/// The axes of the arm.
pub(crate) const AXES: [&str; 6] = ["A1", "A2", "A3", "A4", "A5", "A6"];

/// The axes beyond it.
pub(crate) const OUTER: [&str; 6] = ["E1", "E2", "E3", "E4", "E5", "E6"];

impl Typed for Value {
    const NUMBER: fn(f64) -> Value = Value::Number;
    const FLAG: fn(bool) -> Value = Value::Flag;
    const TEXT: fn(Box<str>) -> Value = Value::Text;

    fn kind(&self) -> &'static str {
        match self {
            Value::Number(_) => "a number",
            Value::Integer(_) => "a whole number",
            Value::Flag(_) => "TRUE or FALSE",
            Value::Entry(_) => "an entry of an enumeration",
            Value::Text(_) => "a text",
            Value::Fields(_) => "an aggregate",
            Value::OfOperator => "a frame of the operator",
        }
    }

    fn number(&self) -> Option<f64> {
        match self {
            Value::Number(number) => Some(*number),
            Value::Integer(number) => Some(f64::from(*number)),
            _ => None,
        }
    }

    fn flag(&self) -> Option<bool> {
        if let Value::Flag(flag) = self { Some(*flag) } else { None }
    }

    fn negated(&self) -> Option<Value> {
        match self {
            Value::Integer(number) => Some(Value::Integer(number.wrapping_neg())),
            other => other.number().map(|number| Value::Number(-number)),
        }
    }
}

impl Value {
    /// The same as a REAL, where it is an INT.
    pub(crate) fn real(self) -> Value {
        match self {
            Value::Integer(number) => Value::Number(f64::from(number)),
            other => other,
        }
    }

    /// What a field of a frame or of axes holds of this: they are REAL, but for S and T.
    pub(crate) fn in_field(self, field: Name) -> Value {
        let mut reals = COORDINATES.iter().chain(&AXES).chain(&OUTER);
        let is_real = reals.any(|name| field.is(name));
        if is_real { self.real() } else { self }
    }

    /// The number of a field.
    pub(crate) fn field(&self, name: &str) -> Option<f64> {
        let Value::Fields(fields) = self else { return None };
        fields.iter().find(|(field, _)| field.is(name))?.1.number()
    }

    /// Whether every field is one of `names`.
    pub(crate) fn has_only(&self, names: &[&[&str]]) -> bool {
        let Value::Fields(fields) = self else { return false };
        fields
            .iter()
            .all(|(field, _)| names.iter().any(|list| list.iter().any(|name| field.is(name))))
    }
}

/// The frame of X, Y, Z (mm), A, B, C (degrees): turned about Z by A, about the new Y by B, about the new X by C.
pub(crate) fn frame([x, y, z, a, b, c]: [f64; 6]) -> Frame {
    let turns = [c, b, a].map(f64::to_radians);
    Frame::from_mat3_translation(Euler::FixedXyz.matrix(turns), Vec3::new(x, y, z))
}

/// The same six numbers of a frame.
pub(crate) fn coordinates(frame: &Frame) -> [f64; 6] {
    let [c, b, a] = Euler::FixedXyz.angles(&frame.matrix3).map(f64::to_degrees);
    let Vec3 { x, y, z } = frame.translation;
    [x, y, z, a, b, c]
}
