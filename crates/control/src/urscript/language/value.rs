//! Values.

use crate::kernel::formula::Typed;
use geom::{Frame, Mat3, Quat, Vec3};

/// mm in a metre, in which poses count.
const METRE: f64 = 1000.0;

/// What a formula comes to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Flag(bool),
    Text(Box<str>),
    List(Vec<Value>),
    /// `p[x,y,z,rx,ry,rz]`: metres, and a vector along the axis of rotation that is as long as its angle, radians.
    Pose([f64; 6]),
}

impl Typed for Value {
    const NUMBER: fn(f64) -> Value = Value::Number;
    const FLAG: fn(bool) -> Value = Value::Flag;
    const TEXT: fn(Box<str>) -> Value = Value::Text;

    fn kind(&self) -> &'static str {
        match self {
            Value::Number(_) => "a number",
            Value::Flag(_) => "True or False",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Pose(_) => "a pose",
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
    /// The numbers of a list of `N`.
    pub(crate) fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let Value::List(list) = self else { return None };
        let all: Option<Vec<f64>> = list.iter().map(Value::number).collect();
        all?.try_into().ok()
    }
}

/// The frame of a pose, mm.
pub(crate) fn frame([x, y, z, rx, ry, rz]: [f64; 6]) -> Frame {
    let turn = Mat3::from_quat(Quat::from_scaled_axis(Vec3::new(rx, ry, rz)));
    Frame::from_mat3_translation(turn, Vec3::new(x, y, z) * METRE)
}

/// The six numbers of a frame.
pub(super) fn pose(frame: &Frame) -> [f64; 6] {
    let Vec3 { x, y, z } = frame.translation / METRE;
    let Vec3 { x: rx, y: ry, z: rz } = Quat::from_mat3(&frame.matrix3).to_scaled_axis();
    [x, y, z, rx, ry, rz]
}
