//! Values.

use crate::kernel::formula::Typed;
pub(crate) use crate::kernel::scan::Name;
use geom::{Frame, Quat, Vec3};

/// How far from 1 the length of a quaternion may be.
const LENGTH: f64 = 1e-4;

/// What a formula comes to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Flag(bool),
    Text(Box<str>),
    /// The parts of a record, in their order.
    List(Vec<Value>),
}

impl Typed for Value {
    const NUMBER: fn(f64) -> Value = Value::Number;
    const FLAG: fn(bool) -> Value = Value::Flag;
    const TEXT: fn(Box<str>) -> Value = Value::Text;

    fn kind(&self) -> &'static str {
        match self {
            Value::Number(_) => "a number",
            Value::Flag(_) => "TRUE or FALSE",
            Value::Text(_) => "a text",
            Value::List(_) => "an aggregate",
        }
    }

    fn number(&self) -> Option<f64> {
        if let Value::Number(number) = self { Some(*number) } else { None }
    }

    fn flag(&self) -> Option<bool> {
        if let Value::Flag(flag) = self { Some(*flag) } else { None }
    }
}

impl Value {
    /// Its parts; none where it is no record.
    pub(crate) fn parts(&self) -> &[Value] {
        match self {
            Value::List(parts) => parts,
            Value::Number(_) | Value::Flag(_) | Value::Text(_) => &[],
        }
    }

    /// Whether it is `TRUE`.
    pub(crate) fn is_true(&self) -> bool {
        *self == Value::Flag(true)
    }

    /// Its numbers, where it is a record of so many, as the control keeps them: a `num` of a position has 24 bits.
    pub(crate) fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let parts = self.parts();
        let mut all = [0.0; N];
        for (number, part) in all.iter_mut().zip(parts) {
            *number = f64::from(part.number()? as f32);
        }
        (parts.len() == N).then_some(all)
    }
}

/// The frame of a `pose`, or of the first two parts of a robtarget: a place and a quaternion, its scalar first.
///
/// # Errors
/// What is wrong in it.
pub(crate) fn frame(parts: &[Value]) -> Result<Frame, String> {
    let [place, turn, ..] = parts else { return Err(String::from("a frame is needed here")) };
    let (Some(place), Some([w, x, y, z])) = (place.numbers::<3>(), turn.numbers::<4>()) else {
        return Err(String::from("a frame has three lengths and a quaternion"));
    };
    let turn = Quat::from_xyzw(x, y, z, w);
    let length = turn.length();
    if (length - 1.0).is_nan() || (length - 1.0).abs() > LENGTH {
        return Err(format!("the quaternion has the length {length:.5}, and not 1"));
    }
    Ok(Frame::from_rotation_translation(turn.normalize(), Vec3::from(place)))
}
