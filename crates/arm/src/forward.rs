//! From joints to the flange: the links, multiplied one after the other.

use crate::arm::{Arm, Calibration, Dh, Joints, Spherical, Structure};
use geom::{Frame, Mat3, Vec3};
use std::f64::consts::FRAC_PI_2;

impl Arm {
    /// The flange for joints, whether they are within the limits or not, in the world of the controller.
    pub fn flange(&self, joints: &Joints) -> Frame {
        self.flange_and_axes(joints).0
    }

    /// The flange, and the axis about which each joint turns what is behind it while its angle grows.
    pub fn flange_and_axes(&self, joints: &Joints) -> (Frame, [Axis; 6]) {
        let (flange, axes) = match &self.structure {
            Structure::Spherical(arm) => spherical(arm, joints),
            Structure::Ur(dh, None) => denavit_hartenberg(dh, joints),
            Structure::Ur(_, Some(calibration)) => measured(calibration, joints),
        };
        let down = Vec3::new(0.0, 0.0, self.world_height);
        let frame = Frame::from_mat3_translation(flange.axes, flange.at - down);
        (frame, axes.map(|axis| Axis { point: axis.point - down, ..axis }))
    }
}

/// The axis of a joint, in the world of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// A point on it, mm.
    pub point: Vec3,
    /// Unit vector about which the joint turns by the right hand.
    pub direction: Vec3,
}

impl Axis {
    const NONE: Axis = Axis { point: Vec3::ZERO, direction: Vec3::ZERO };
}

/// A frame that moves along the links.
#[derive(Clone, Copy)]
struct Link {
    axes: Mat3,
    at: Vec3,
}

impl Link {
    const FOOT: Link = Link { axes: Mat3::IDENTITY, at: Vec3::ZERO };

    /// Goes on along its own axes.
    fn go(self, x: f64, y: f64, z: f64) -> Link {
        Link { at: self.at + self.axes * Vec3::new(x, y, z), ..self }
    }

    fn turn(self, rotation: Mat3) -> Link {
        Link { axes: self.axes * rotation, ..self }
    }

    fn about_x(self, angle: f64) -> Link {
        self.turn(Mat3::from_rotation_x(angle))
    }

    fn about_y(self, angle: f64) -> Link {
        self.turn(Mat3::from_rotation_y(angle))
    }

    fn about_z(self, angle: f64) -> Link {
        self.turn(Mat3::from_rotation_z(angle))
    }

    fn y(&self) -> Axis {
        Axis { point: self.at, direction: self.axes.y_axis }
    }

    fn z(&self) -> Axis {
        Axis { point: self.at, direction: self.axes.z_axis }
    }
}

fn spherical(arm: &Spherical, joints: &Joints) -> (Link, [Axis; 6]) {
    let [t1, t2, t3, t4, t5, t6] = arm.angles(joints);
    let foot = Link::FOOT.go(0.0, 0.0, arm.c1);
    let shoulder = foot.about_z(t1).go(arm.a1, arm.b, 0.0);
    let elbow = shoulder.about_y(t2).go(0.0, 0.0, arm.c2);
    let wrist = elbow.about_y(t3).go(arm.a2, 0.0, arm.c3);
    let hand = wrist.about_z(t4);
    let bent = hand.about_y(t5);
    let mut axes = [foot.z(), shoulder.y(), elbow.y(), wrist.z(), hand.y(), bent.z()];
    axes.iter_mut().zip(arm.signs).for_each(|(axis, sign)| axis.direction *= sign);
    (bent.about_z(t6).go(0.0, 0.0, arm.c4), axes)
}

fn denavit_hartenberg(dh: &Dh, joints: &Joints) -> (Link, [Axis; 6]) {
    let links = [
        (dh.d1, 0.0, FRAC_PI_2),
        (0.0, dh.a2, 0.0),
        (0.0, dh.a3, 0.0),
        (dh.d4, 0.0, FRAC_PI_2),
        (dh.d5, 0.0, -FRAC_PI_2),
        (dh.d6, 0.0, 0.0),
    ];
    let (mut link, mut axes) = (Link::FOOT, [Axis::NONE; 6]);
    for ((joint, (along, across, twist)), axis) in joints.iter().zip(links).zip(&mut axes) {
        *axis = link.z();
        link = link.about_z(*joint).go(across, 0.0, along).about_x(twist);
    }
    (link, axes)
}

fn measured(calibration: &Calibration, joints: &Joints) -> (Link, [Axis; 6]) {
    let (mut link, mut axes) = (Link::FOOT, [Axis::NONE; 6]);
    for ((joint, frame), axis) in joints.iter().zip(&calibration.0).zip(&mut axes) {
        let [x, y, z] = frame.translation.to_array();
        link = link.go(x, y, z).turn(frame.matrix3);
        *axis = link.z();
        link = link.about_z(*joint);
    }
    (link, axes)
}
