//! Values.

use geom::{Frame, Mat3, Quat, Vec3};

/// mm in a metre, in which poses count.
const METRE: f64 = 1000.0;

/// What an expression comes to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Flag(bool),
    Text(Box<str>),
    List(Vec<Value>),
    /// `p[x,y,z,rx,ry,rz]`: metres, and a vector along the axis of rotation that is as long as its angle, radians.
    Pose([f64; 6]),
}

impl Value {
    /// What it is, for an error.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Value::Number(_) => "a number",
            Value::Flag(_) => "True or False",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Pose(_) => "a pose",
        }
    }

    /// The numbers of a list of `N`.
    pub(crate) fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let Value::List(list) = self else { return None };
        let number = |value: &Value| match value {
            Value::Number(number) => Some(*number),
            _ => None,
        };
        let all: Option<Vec<f64>> = list.iter().map(number).collect();
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
