//! The arm that a chain of six joints is: where their axes meet says its kind, its lengths, its zeros and its signs.

use super::urdf::{Chain, Revolute};
use super::{RIGHT, Read, fail};
use arm::{Arm, Dh, Frame, Joint, Joints, Spherical, Structure, Vec3};
use geom::{Mat3, rotate};
use program::{Diagnostic, Rule};
use std::f64::consts::{FRAC_PI_2, PI};

/// Points as near as this are one, mm.
const SAME: f64 = 0.1;

/// No arm reaches farther, mm.
const LONGEST: f64 = 1e4;

/// How far the arm may be from the chain at any joints, mm.
const AGREES: f64 = 0.05;

/// The arm of a chain.
pub(super) struct Found {
    pub(super) arm: Arm,
}

/// An axis: a point of it, and its direction.
#[derive(Clone, Copy)]
struct Axis {
    point: Vec3,
    along: Vec3,
}

impl Axis {
    fn is_parallel(&self, other: &Axis) -> bool {
        self.along.cross(other.along).length() <= RIGHT
    }

    fn is_square(&self, other: &Axis) -> bool {
        self.along.dot(other.along).abs() <= RIGHT
    }

    /// The point of this axis that is nearest to another, and how far that is.
    fn nearest(&self, other: &Axis) -> (Vec3, f64) {
        let normal = self.along.cross(other.along);
        let square = normal.length_squared();
        let gap = other.point - self.point;
        let along = gap.cross(other.along).dot(normal) / square;
        (self.point + self.along * along, gap.dot(normal).abs() / square.sqrt())
    }
}

fn refused(message: impl Into<String>) -> Diagnostic {
    let help =
        "arms whose last three axes meet in one point, and those of Universal Robots, are known";
    Diagnostic::error(Rule::ArmKind, message).help(help)
}

/// The arm of a chain.
pub(super) fn find(chain: &Chain) -> Read<Found> {
    let turned = chain.world.matrix3;
    if (turned.z_axis - Vec3::Z).length() > RIGHT
        || chain.world.translation.truncate().length() > SAME
    {
        return fail(refused("the world of the controller (`base`) is not upright above the foot"));
    }
    // All in a frame at the foot that is turned as the world is.
    let foot = Frame::from_mat3(turned).inverse();
    let (axes, flange) = at_zero(chain, &foot);
    let [first, second, third, fourth, fifth, sixth] = axes;
    if first.along.z.abs() < 1.0 - RIGHT || first.point.truncate().length() > SAME {
        return fail(refused("axis 1 is not upright in the foot"));
    }
    if !second.is_square(&first) || !second.is_parallel(&third) {
        return fail(refused("axis 2 is not level, or not parallel to axis 3"));
    }
    let structure = if third.is_parallel(&fourth) {
        ur(&axes, &flange)?
    } else if fourth.is_square(&fifth) && fifth.is_square(&sixth) && fourth.is_square(&third) {
        spherical(&axes, &flange)?
    } else {
        return fail(refused("axes 4, 5 and 6 are not at right angles to each other"));
    };
    let joints: Vec<Joint> = chain.joints.iter().map(limits).collect();
    let joints: [Joint; 6] = joints.try_into().map_err(|_| refused("an arm has six joints"))?;
    let arm = Arm::new(structure, joints, None, chain.world.translation.z)
        .map_err(|why| refused(why.to_string()))?;
    if arm.reach() > LONGEST || arm.world_height().abs() > LONGEST {
        let message = format!("the arm would reach {:.0} mm", arm.reach());
        return fail(refused(message).help("a description has its lengths in metres"));
    }
    agrees(&arm, chain)?;
    Ok(Found { arm })
}

fn limits(joint: &Revolute) -> Joint {
    Joint { min: joint.min, max: joint.max, speed: joint.speed, acceleration: None }
}

/// The axes and the flange with all joints at zero.
fn at_zero(chain: &Chain, foot: &Frame) -> ([Axis; 6], Frame) {
    let mut here = *foot;
    let axes = std::array::from_fn(|i| {
        here *= chain.joints[i].frame;
        Axis { point: here.translation, along: here.matrix3 * chain.joints[i].axis }
    });
    (axes, here * chain.flange)
}

/// The nearer of an angle's two ways to lie along a line: within a quarter turn, and whether it was turned round.
fn within_quarter(angle: f64) -> (f64, f64) {
    let angle = geom::wrap(angle);
    if angle > FRAC_PI_2 + RIGHT {
        (angle - PI, -1.0)
    } else if angle <= -FRAC_PI_2 + RIGHT {
        (angle + PI, -1.0)
    } else {
        (angle, 1.0)
    }
}

fn spherical(axes: &[Axis; 6], flange: &Frame) -> Read<Structure> {
    let [first, second, third, fourth, fifth, sixth] = axes;
    let (centre, gap) = fifth.nearest(fourth);
    let (other, other_gap) = fifth.nearest(sixth);
    if gap > SAME || other_gap > SAME || centre.distance(other) > SAME {
        return fail(refused("axes 4, 5 and 6 do not meet in one point"));
    }
    // Joint 1 turns Y to axis 2.
    let (t1, s2) = within_quarter((-second.along.x).atan2(second.along.y));
    let shoulder = Mat3::from_rotation_z(t1);
    let (ahead, aside) = (shoulder.x_axis, shoulder.y_axis);
    let in_plane = |from: Vec3, to: Vec3| [(to - from).dot(ahead), to.z - from.z];
    let [a1, c1] = in_plane(Vec3::ZERO, second.point);
    let [x, z] = in_plane(second.point, third.point);
    let (t2, c2) = (x.atan2(z), x.hypot(z));
    // The forearm goes to the wrist.
    let [fx, fz] = in_plane(third.point, centre);
    let lean = fourth.along.dot(ahead).atan2(fourth.along.z);
    let towards = |lean: f64| fx * lean.sin() + fz * lean.cos();
    let (lean, s4) = if towards(lean) < -SAME { (lean + PI, -1.0) } else { (lean, 1.0) };
    let a2 = fx * lean.cos() - fz * lean.sin();
    let wrist = shoulder * Mat3::from_rotation_y(lean);
    let seen = wrist.transpose() * fifth.along;
    let (t4, s5) = within_quarter((-seen.x).atan2(seen.y));
    let wrist = wrist * Mat3::from_rotation_z(t4);
    let out = flange.translation - centre;
    let s6 = match out.dot(sixth.along) {
        far if far.abs() > SAME => far.signum(),
        _ => flange.matrix3.z_axis.dot(sixth.along).signum(),
    };
    let seen = wrist.transpose() * (sixth.along * s6);
    let t5 = seen.x.atan2(seen.z);
    let wrist = wrist * Mat3::from_rotation_y(t5);
    let c4 = out.dot(wrist.z_axis);
    if out.distance(wrist.z_axis * c4) > SAME
        || (flange.matrix3.z_axis - wrist.z_axis).length() > RIGHT
    {
        let message = "the flange is not on axis 6 with its Z out of the arm";
        return fail(refused(message).help("call that frame `tool0`"));
    }
    let seen = wrist.transpose() * flange.matrix3.x_axis;
    let angles = [t1, t2, lean - t2, t4, t5, seen.y.atan2(seen.x)];
    Ok(Structure::Spherical(Spherical {
        a1: tidy(a1),
        a2: tidy(a2),
        b: tidy((centre - first.point).dot(aside)),
        c1: tidy(c1),
        c2: tidy(c2),
        c3: tidy(towards(lean)),
        c4: tidy(c4),
        offsets: angles.map(|angle| degrees_tidy(-angle)),
        signs: [first.along.z.signum(), s2, third.along.dot(aside).signum(), s4, s5, s6],
    }))
}

/// An arm of Universal Robots, whose joints are those of its Denavit-Hartenberg parameters.
fn ur(axes: &[Axis; 6], flange: &Frame) -> Read<Structure> {
    let [_, second, third, fourth, fifth, sixth] = axes;
    let d4 = -fifth.point.y;
    Ok(Structure::Ur(
        Dh {
            d1: tidy(second.point.z),
            a2: tidy(third.point.x - second.point.x),
            a3: tidy(fourth.point.x - third.point.x),
            d4: tidy(d4),
            d5: tidy(second.point.z - sixth.point.z),
            d6: tidy(-flange.translation.y - d4),
        },
        None,
    ))
}

/// Rounding of metres in a file: a ten-thousandth of a millimetre.
fn tidy(mm: f64) -> f64 {
    (mm * 1e4).round() / 1e4 + 0.0
}

/// The same of angles, and every half turn as +180 degrees.
fn degrees_tidy(angle: f64) -> f64 {
    let degrees = (geom::wrap(angle).to_degrees() * 1e6).round() / 1e6 + 0.0;
    (if degrees <= -180.0 { 180.0 } else { degrees }).to_radians()
}

/// The arm has to be where the chain is, whatever the joints.
fn agrees(arm: &Arm, chain: &Chain) -> Read<()> {
    for i in 0..24_u32 {
        let joints: Joints = std::array::from_fn(|k| {
            let steps = [0.618_034, 0.754_878, 0.569_840, 0.819_173, 0.671_044, 0.549_700];
            ((f64::from(i) * steps[k]).fract() - 0.5) * 6.0
        });
        let (ours, theirs) = (arm.flange(&joints), in_chain(chain, &joints));
        let off = ours.translation.distance(theirs.translation);
        let turned = (ours.matrix3.x_axis - theirs.matrix3.x_axis).length();
        if off.is_nan() || off > AGREES || turned > RIGHT {
            return fail(refused(format!(
                "an arm with these axes would be {off:.3} mm from where the chain is"
            )));
        }
    }
    Ok(())
}

/// The flange of the chain in the world of the controller.
fn in_chain(chain: &Chain, joints: &Joints) -> Frame {
    let mut here = chain.world.inverse();
    for (joint, angle) in chain.joints.iter().zip(joints) {
        let turned = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| rotate(axis, joint.axis, *angle));
        here *= joint.frame * Frame::from_mat3(Mat3::from_cols(turned[0], turned[1], turned[2]));
    }
    here * chain.flange
}
