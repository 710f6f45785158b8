//! Postures of an arm, and how far it is from where they meet.

use crate::arm::{Arm, Joints, Structure};

/// One of the eight solutions in which an arm reaches a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Posture(u8);

impl Posture {
    /// All eight.
    pub const ALL: [Posture; 8] = {
        let mut all = [Posture(0); 8];
        let mut i = 0;
        while i < 8 {
            all[i] = Posture(i as u8);
            i += 1;
        }
        all
    };

    /// The posture with the wrist centre behind axis 1 or not, the elbow below or not, the wrist flipped or not.
    pub const fn of(rear: bool, below: bool, flip: bool) -> Posture {
        Posture((rear as u8) << 2 | (below as u8) << 1 | flip as u8)
    }

    /// Whether the arm reaches over its first axis, backwards.
    pub const fn rear(self) -> bool {
        self.0 & 4 != 0
    }

    /// Whether the elbow is below the line from shoulder to wrist.
    pub const fn below(self) -> bool {
        self.0 & 2 != 0
    }

    /// Whether joint 5 of the model is negative.
    pub const fn flip(self) -> bool {
        self.0 & 1 != 0
    }

    /// 0 to 7.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// How far joints are from the three singularities. At 0 two postures meet, and a joint has no speed that would follow the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Of the wrist: how far joint 5 is from stretched or folded, radians.
    pub wrist: f64,
    /// Of the shoulder: how far the wrist centre (Universal Robots: the end of the wrist) is in front of axis 1 or behind, mm.
    pub shoulder: f64,
    /// Of the elbow: how far it is from stretched or folded, radians.
    pub elbow: f64,
}

/// The three figures whose signs say the posture.
struct Signed {
    /// In front of axis 1, mm.
    front: f64,
    /// Angle of the elbow.
    elbow: f64,
    /// Angle of joint 5.
    wrist: f64,
}

impl Arm {
    /// The posture in which joints put the arm.
    pub fn posture(&self, joints: &Joints) -> Posture {
        let Signed { front, elbow, wrist } = self.signed(joints);
        Posture::of(front < 0.0, elbow.sin() < 0.0, wrist.sin() < 0.0)
    }

    /// How far joints are from the singularities.
    pub fn margins(&self, joints: &Joints) -> Margins {
        let Signed { front, elbow, wrist } = self.signed(joints);
        let from_line = |angle: f64| angle.sin().abs().asin();
        Margins { wrist: from_line(wrist), shoulder: front.abs(), elbow: from_line(elbow) }
    }

    fn signed(&self, joints: &Joints) -> Signed {
        match &self.structure {
            Structure::Spherical(arm) => {
                let [_, t2, t3, _, t5, _] = arm.angles(joints);
                let [forearm, bend] = self.forearm;
                let front = arm.a1 + arm.c2 * t2.sin() + forearm * (t2 + t3 + bend).sin();
                Signed { front, elbow: t3 + bend, wrist: t5 }
            }
            // Of a calibrated arm as well: it differs by tenths of a millimetre.
            Structure::Ur(dh, _) => {
                let [_, q2, q3, q4, q5, _] = *joints;
                let reach = dh.a2 * q2.cos() + dh.a3 * (q2 + q3).cos();
                let front = reach + dh.d5 * (q2 + q3 + q4).sin();
                Signed { front, elbow: q3, wrist: q5 }
            }
        }
    }
}
