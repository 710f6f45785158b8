//! Arms for the tests: those of `robots.json`, and some whose lengths a source states.

use serde_json::Value;
use std::f64::consts::{PI, TAU};
use toolpost_arm::{Arm, Coupling, Dh, Frame, Joint, Joints, Mat3, Spherical, Structure, Vec3};

/// A file of the folder `robots` of the real input; `None` without it.
pub fn data(name: &str) -> Option<Value> {
    let text = std::fs::read_to_string(judge::data("robots")?.join(name)).unwrap();
    Some(serde_json::from_str(&text).unwrap())
}

/// Zeros and signs of a maker, as the table of the specification has them.
pub fn spherical(maker: &str, [a1, a2, b, c1, c2, c3, c4]: [f64; 7]) -> Structure {
    let (offsets, signs) = match maker {
        "kuka" => ([0.0, -90.0, 0.0, 0.0, 0.0, 0.0], [-1.0, 1.0, 1.0, -1.0, 1.0, -1.0]),
        "abb" => ([0.0, 0.0, -90.0, 0.0, 0.0, 0.0], [1.0; 6]),
        "fanuc" => ([0.0, 0.0, -90.0, 0.0, 0.0, 180.0], [1.0, 1.0, -1.0, -1.0, -1.0, -1.0]),
        "staubli" => ([0.0; 6], [1.0; 6]),
        _ => unreachable!("{maker}"),
    };
    let offsets = offsets.map(f64::to_radians);
    Structure::Spherical(Spherical { a1, a2, b, c1, c2, c3, c4, offsets, signs })
}

pub const UR5E: Dh = Dh { d1: 162.5, a2: -425.0, a3: -392.2, d4: 133.3, d5: 99.7, d6: 99.6 };
pub const UR10E: Dh = Dh { d1: 180.7, a2: -612.7, a3: -571.55, d4: 174.15, d5: 119.85, d6: 116.55 };

pub fn free(structure: Structure) -> Arm {
    let joint = Joint { min: -TAU, max: TAU, speed: PI, acceleration: None };
    Arm::new(structure, [joint; 6], Some(Coupling::None), 0.0).unwrap()
}

pub fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list: Vec<f64> = value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    list.try_into().unwrap()
}

pub fn named<const N: usize>(value: &Value, names: [&str; N]) -> [f64; N] {
    names.map(|name| value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}")))
}

pub const LENGTHS: [&str; 7] = ["a1", "a2", "b", "c1", "c2", "c3", "c4"];

pub fn dh(value: &Value) -> Structure {
    let [d1, a2, a3, d4, d5, d6] = named(value, ["d1", "a2", "a3", "d4", "d5", "d6"]);
    Structure::Ur(Dh { d1, a2, a3, d4, d5, d6 }, None)
}

/// An arm of `robots.json`.
pub fn arm(robot: &Value) -> Arm {
    let structure = match robot.get("opw_mm") {
        Some(lengths) => spherical(robot["maker"].as_str().unwrap(), named(lengths, LENGTHS)),
        None => dh(&robot["dh_mm"]),
    };
    let limits = robot["limits_deg"].as_array().unwrap();
    let speeds: Joints = numbers(&robot["velocity_deg_s"]);
    let joints = std::array::from_fn(|i| {
        let [min, max] = numbers::<2>(&limits[i]).map(f64::to_radians);
        Joint { min, max, speed: speeds[i].to_radians(), acceleration: None }
    });
    let coupling = match robot["maker"].as_str() {
        Some("fanuc") => Coupling::LessJoint2,
        _ => Coupling::None,
    };
    let height = robot["world_origin_above_base_mm"].as_f64().unwrap();
    Arm::new(structure, joints, Some(coupling), height).unwrap()
}

/// The farther of how far two frames are apart: mm, and the largest difference of a direction.
pub fn apart(a: &Frame, b: &Frame) -> (f64, f64) {
    let turned = a.matrix3 - b.matrix3;
    let turned = [turned.x_axis, turned.y_axis, turned.z_axis].map(Vec3::length);
    (a.translation.distance(b.translation), turned.into_iter().fold(0.0, f64::max))
}

pub fn frame(at: [f64; 3], axes: Mat3) -> Frame {
    Frame::from_mat3_translation(axes, Vec3::from_array(at))
}
