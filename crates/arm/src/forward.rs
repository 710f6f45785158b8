//! From joints to the flange: the links, multiplied one after the other.

use crate::arm::{Arm, Calibration, Dh, Joints, Spherical, Structure};
use geom::{Frame, Mat3, Vec3};
use std::f64::consts::FRAC_PI_2;

impl Arm {
    /// The flange for joints, whether they are within the limits or not, in the world of the controller.
    pub fn flange(&self, joints: &Joints) -> Frame {
        let foot = match &self.structure {
            Structure::Spherical(arm) => spherical(arm, joints),
            Structure::Ur(dh, None) => denavit_hartenberg(dh, joints),
            Structure::Ur(_, Some(calibration)) => measured(calibration, joints),
        };
        foot.in_world(self.world_height)
    }
}

/// A frame that moves along the links.
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

    fn in_world(self, height: f64) -> Frame {
        Frame::from_mat3_translation(self.axes, self.at - Vec3::new(0.0, 0.0, height))
    }
}

fn spherical(arm: &Spherical, joints: &Joints) -> Link {
    let [t1, t2, t3, t4, t5, t6] = arm.angles(joints);
    let shoulder = Link::FOOT.go(0.0, 0.0, arm.c1).about_z(t1).go(arm.a1, arm.b, 0.0);
    let elbow = shoulder.about_y(t2).go(0.0, 0.0, arm.c2);
    let wrist = elbow.about_y(t3).go(arm.a2, 0.0, arm.c3);
    wrist.about_z(t4).about_y(t5).about_z(t6).go(0.0, 0.0, arm.c4)
}

fn denavit_hartenberg(dh: &Dh, joints: &Joints) -> Link {
    let links = [
        (dh.d1, 0.0, FRAC_PI_2),
        (0.0, dh.a2, 0.0),
        (0.0, dh.a3, 0.0),
        (dh.d4, 0.0, FRAC_PI_2),
        (dh.d5, 0.0, -FRAC_PI_2),
        (dh.d6, 0.0, 0.0),
    ];
    joints.iter().zip(links).fold(Link::FOOT, |link, (joint, (along, across, twist))| {
        link.about_z(*joint).go(across, 0.0, along).about_x(twist)
    })
}

fn measured(calibration: &Calibration, joints: &Joints) -> Link {
    joints.iter().zip(&calibration.0).fold(Link::FOOT, |link, (joint, frame)| {
        let [x, y, z] = frame.translation.to_array();
        link.go(x, y, z).turn(frame.matrix3).about_z(*joint)
    })
}
