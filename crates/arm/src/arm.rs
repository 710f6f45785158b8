//! What an arm is.

use geom::{Euler, Frame, Vec3, wrap};
use std::f64::consts::TAU;
use std::fmt;

/// Positions of the six joints, radians: those of the model, see the front page.
pub type Joints = [f64; 6];

/// Joint positions farther from zero than this are no arm's, radians: ten revolutions.
pub const FARTHEST: f64 = 10.0 * TAU;

/// How far the reach of the lengths may be from the stated one, as a part of it.
const REACH: f64 = 0.02;

/// An arm of six revolute joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    pub(crate) structure: Structure,
    pub(crate) joints: [Joint; 6],
    pub(crate) coupling: Option<Coupling>,
    pub(crate) world_height: f64,
    pub(crate) coupling_limit: Option<CouplingLimit>,
    /// Of seven lengths: how far the wrist centre is from axis 3, mm, and the angle there from the upper arm at joint 3 0, radians.
    pub(crate) forearm: [f64; 2],
}

/// How its links are put together.
#[derive(Clone, Debug, PartialEq)]
pub enum Structure {
    /// The last three axes meet in one point.
    Spherical(Spherical),
    /// Joints 2, 3 and 4 are parallel, as on the arms of Universal Robots.
    Ur(Dh, Option<Box<Calibration>>),
}

/// An arm whose last three axes meet in the wrist centre, by its seven lengths (Brandstötter, Angerer, Hofbaur 2014), mm.
/// Joint `i` of the model has the angle `signs[i] * q[i] - offsets[i]`; with all those angles zero the arm stands straight up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spherical {
    /// From axis 1 forward to axis 2.
    pub a1: f64,
    /// From axis 3 across to axis 4: negative where axis 4 lies above axis 3 with the forearm level.
    pub a2: f64,
    /// Sideways from axis 1 to the plane of the arm.
    pub b: f64,
    /// From the foot up to axis 2.
    pub c1: f64,
    /// From axis 2 to axis 3.
    pub c2: f64,
    /// From axis 3 along the forearm to the wrist centre.
    pub c3: f64,
    /// From the wrist centre to the flange.
    pub c4: f64,
    /// What is taken from each joint, radians.
    pub offsets: Joints,
    /// 1 or -1: which way each joint counts.
    pub signs: Joints,
}

/// An arm of Universal Robots by its Denavit-Hartenberg parameters, mm; the twists are 90, 0, 0, 90, -90, 0 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dh {
    /// From the foot up to axis 2.
    pub d1: f64,
    /// Upper arm, negative as the maker writes it.
    pub a2: f64,
    /// Forearm, negative.
    pub a3: f64,
    /// Sideways from axis 1 to axis 5.
    pub d4: f64,
    /// From axis 4 to axis 6.
    pub d5: f64,
    /// From axis 5 to the flange.
    pub d6: f64,
}

/// What the factory has measured of one arm: the frame of each joint in the one before it, with all joints at zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration(pub [Frame; 6]);

impl Calibration {
    /// Of a row for each joint as a machine file has it: x, y, z in mm, and the turns about the fixed X, Y and Z axes in degrees.
    pub fn of_rows(rows: [[f64; 6]; 6]) -> Calibration {
        Calibration(rows.map(|[x, y, z, roll, pitch, yaw]| {
            let turns = [roll, pitch, yaw].map(f64::to_radians);
            Frame::from_mat3_translation(Euler::FixedXyz.matrix(turns), Vec3::new(x, y, z))
        }))
    }
}

/// A joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Lowest position, radians.
    pub min: f64,
    /// Highest position, radians.
    pub max: f64,
    /// Fastest, radians/s.
    pub speed: f64,
    /// Acceleration, radians/s², where the maker states one.
    pub acceleration: Option<f64>,
}

/// How the controller counts joint 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// Against the upper arm, as the model does.
    None,
    /// Against the horizontal: what it shows is the model's joint 3 less joint 2 (FANUC).
    LessJoint2,
    /// By a parallel rod: what it shows is the model's joint 3 and joint 2 together (ABB IRB 2400, 4400, 460).
    PlusJoint2,
}

/// Limits of joint 3 as the controller shows it, radians, beyond those of the model's joint 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplingLimit {
    /// Lowest position.
    pub min: f64,
    /// Highest position.
    pub max: f64,
}

/// Why numbers make no arm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misfit(pub(crate) String);

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Misfit {}

impl Coupling {
    /// Joint 2's share in what the controller shows as joint 3.
    fn share(self) -> f64 {
        match self {
            Coupling::None => 0.0,
            Coupling::LessJoint2 => -1.0,
            Coupling::PlusJoint2 => 1.0,
        }
    }
}

impl Arm {
    /// An arm. `coupling` is `None` where nobody has said how its controller counts joint 3; `world_height` is how far the origin
    /// of its world lies above its foot, mm.
    ///
    /// # Errors
    /// Lengths that leave nothing to move, numbers that are not finite, limits that hold nothing.
    pub fn new(
        structure: Structure,
        joints: [Joint; 6],
        coupling: Option<Coupling>,
        world_height: f64,
    ) -> Result<Arm, Misfit> {
        structure.check()?;
        for (number, joint) in (1..).zip(&joints) {
            joint.check(number)?;
        }
        match world_height.is_finite() {
            true => {
                let forearm = match &structure {
                    Structure::Spherical(arm) => [arm.a2.hypot(arm.c3), arm.a2.atan2(arm.c3)],
                    Structure::Ur(..) => [0.0; 2],
                };
                Ok(Arm { structure, joints, coupling, world_height, coupling_limit: None, forearm })
            }
            false => Err(Misfit(String::from("the height of the world is no number"))),
        }
    }

    /// The same arm, with limits of joint 3 as the controller shows it.
    ///
    /// # Errors
    /// Limits that hold nothing.
    pub fn with_coupling_limit(self, limit: CouplingLimit) -> Result<Arm, Misfit> {
        match limit.min < limit.max {
            true => Ok(Arm { coupling_limit: Some(limit), ..self }),
            false => Err(Misfit(String::from("the coupled limits of joint 3 hold nothing"))),
        }
    }

    /// The same arm, with a joint (number from 1 to 6) that turns less far than its maker lets it: cables and hoses hang on it. Radians.
    ///
    /// # Errors
    /// A range that holds nothing, or goes beyond that of the maker.
    pub fn with_range(mut self, number: usize, [min, max]: [f64; 2]) -> Result<Arm, Misfit> {
        let wrong = |what: &str| Err(Misfit(format!("joint {number}: {what}")));
        let Some(joint) = number.checked_sub(1).and_then(|i| self.joints.get_mut(i)) else {
            return wrong("an arm has six joints");
        };
        if !joint.holds(min) || !joint.holds(max) {
            return wrong("its range with cables goes beyond the limits of the joint");
        }
        if min >= max {
            return wrong("its range with cables holds nothing");
        }
        (joint.min, joint.max) = (min, max);
        Ok(self)
    }

    /// How its links are put together.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Its joints, the first at the foot.
    pub fn joints(&self) -> &[Joint; 6] {
        &self.joints
    }

    /// How its controller counts joint 3, where that is known.
    pub fn coupling(&self) -> Option<Coupling> {
        self.coupling
    }

    /// How far the origin of its controller's world lies above its foot, mm.
    pub fn world_height(&self) -> f64 {
        self.world_height
    }

    /// How far the flange may be from where joints put it by these lengths, mm, while its controller reaches poses exactly: of an arm
    /// that is measured one by one (Universal Robots), and whose measures are not stated. 0 of every other: its controller calculates
    /// with the same lengths.
    ///
    /// Universal Robots' driver for ROS warns of centimetres (`ur_robot_driver`, "Extract calibration information").
    pub fn unmeasured(&self) -> f64 {
        match &self.structure {
            Structure::Ur(_, None) => 20.0,
            Structure::Ur(_, Some(_)) | Structure::Spherical(_) => 0.0,
        }
    }

    /// How far the wrist centre reaches from axis 2, and axis 2 from axis 1, mm: what data sheets call the reach.
    pub fn reach(&self) -> f64 {
        match &self.structure {
            Structure::Spherical(arm) => arm.a1 + arm.c2 + arm.a2.hypot(arm.c3),
            Structure::Ur(dh, _) => dh.a2.abs() + dh.a3.abs(),
        }
    }

    /// Whether [`Arm::reach`] is what a data sheet states, mm, within 2 %.
    pub fn reaches(&self, stated: f64) -> bool {
        (self.reach() - stated).abs() <= REACH * stated
    }

    /// Joints as the controller shows them; `None` where it is not known how it counts joint 3.
    pub fn shown(&self, joints: &Joints) -> Option<Joints> {
        let [q1, q2, q3, q4, q5, q6] = *joints;
        self.coupling.map(|coupling| [q1, q2, q3 + coupling.share() * q2, q4, q5, q6])
    }

    /// Model joints of what the controller shows; `None` where it is not known how it counts joint 3.
    pub fn model(&self, shown: &Joints) -> Option<Joints> {
        let [q1, q2, q3, q4, q5, q6] = *shown;
        self.coupling.map(|coupling| [q1, q2, q3 - coupling.share() * q2, q4, q5, q6])
    }

    /// Whether joints are within the limits, and joint 3 as the controller shows it within its own.
    pub fn allows(&self, joints: &Joints) -> bool {
        self.joints.iter().zip(joints).all(|(joint, q)| joint.holds(*q))
            && self.allows_shown(joints)
    }

    pub(crate) fn allows_shown(&self, joints: &Joints) -> bool {
        match (self.coupling_limit, self.shown(joints)) {
            (Some(limit), Some(shown)) => (limit.min..=limit.max).contains(&shown[2]),
            _ => true,
        }
    }

    /// All positions within the limits that differ from `joints` by whole revolutions of single joints.
    pub fn within<'a>(&'a self, joints: &Joints) -> impl Iterator<Item = Joints> + 'a {
        let turns = std::array::from_fn(|i| self.joints[i].turns(joints[i]));
        let from: Joints = turns.map(|(first, _): (f64, u32)| first);
        let counts = turns.map(|(_, count)| count);
        (0..counts.iter().product::<u32>())
            .map(move |number| {
                let mut rest = number;
                std::array::from_fn(|i| {
                    let turn = rest % counts[i];
                    rest /= counts[i];
                    from[i] + TAU * f64::from(turn)
                })
            })
            .filter(|joints| self.allows_shown(joints))
    }
}

/// Rounding of a position that stands at its limit, radians.
const AT_LIMIT: f64 = 1e-9;

impl Joint {
    /// Whether a position is within the limits.
    pub fn holds(&self, position: f64) -> bool {
        (self.min - AT_LIMIT..=self.max + AT_LIMIT).contains(&position)
    }

    /// The lowest position within the limits that is `position` by whole revolutions, and how many there are.
    pub(crate) fn turns(&self, position: f64) -> (f64, u32) {
        let low = self.min - AT_LIMIT;
        let first = position + TAU * ((low - position) / TAU).ceil();
        let span = self.max + AT_LIMIT - first;
        // At most twenty: limits lie within ten revolutions either way.
        (first, if span < 0.0 { 0 } else { 1 + (span / TAU) as u32 })
    }

    fn check(&self, number: usize) -> Result<(), Misfit> {
        let wrong = |what: &str| Err(Misfit(format!("joint {number}: {what}")));
        let far = |angle: f64| angle.is_nan() || angle.abs() > FARTHEST;
        let positive = |rate: f64| rate.is_finite() && rate > 0.0;
        if far(self.min) || far(self.max) {
            return wrong("a limit is beyond ten revolutions");
        }
        if self.min >= self.max {
            return wrong("the lower limit is not below the upper one");
        }
        match positive(self.speed) && self.acceleration.is_none_or(positive) {
            true => Ok(()),
            false => wrong("speed and acceleration are above 0"),
        }
    }
}

impl Structure {
    /// The longest that a length may be, mm.
    const LONGEST: f64 = 1e5;

    fn check(&self) -> Result<(), Misfit> {
        let within = |lengths: &[f64]| match lengths
            .iter()
            .all(|length| length.abs() <= Structure::LONGEST)
        {
            true => Ok(()),
            false => Err(Misfit(String::from("a length is no number from -100000 to 100000 mm"))),
        };
        let needed = |name: &str, length: f64| match length.abs() > 1e-3 {
            true => Ok(()),
            false => Err(Misfit(format!("{name} is 0: the arm could not bend there"))),
        };
        match self {
            Structure::Spherical(arm) => {
                let Spherical { a1, a2, b, c1, c2, c3, c4, offsets, signs } = arm;
                within(&[*a1, *a2, *b, *c1, *c2, *c3, *c4])?;
                needed("c2", *c2)?;
                needed("the distance from axis 3 to the wrist (a2, c3)", a2.hypot(*c3))?;
                let turned = |offset: &f64| offset.abs() <= TAU;
                match offsets.iter().all(turned) && signs.iter().all(|sign| sign.abs() == 1.0) {
                    true => Ok(()),
                    false => Err(Misfit(String::from(
                        "offsets are within one revolution, and signs are 1 or -1",
                    ))),
                }
            }
            Structure::Ur(Dh { d1, a2, a3, d4, d5, d6 }, calibration) => {
                within(&[*d1, *a2, *a3, *d4, *d5, *d6])?;
                needed("a2", *a2)?;
                needed("a3", *a3)?;
                match calibration
                    .iter()
                    .flat_map(|measured| measured.0)
                    .all(|frame| frame.is_finite())
                {
                    true => Ok(()),
                    false => Err(Misfit(String::from("the calibration is not made of numbers"))),
                }
            }
        }
    }
}

impl Spherical {
    /// Angles of the model that joints come to.
    pub(crate) fn angles(&self, joints: &Joints) -> Joints {
        std::array::from_fn(|i| self.signs[i] * joints[i] - self.offsets[i])
    }

    /// Joints, each in (-π, π], that come to these angles of the model.
    pub(crate) fn joints(&self, angles: &Joints) -> Joints {
        std::array::from_fn(|i| wrap(self.signs[i] * (angles[i] + self.offsets[i])))
    }
}
