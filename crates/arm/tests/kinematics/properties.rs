//! Both solutions undo each other, on arms of every kind.

use crate::robots::{UR5E, apart, spherical};
use geom::{Euler, wrap};
use proptest::prelude::*;
use std::f64::consts::PI;
use toolpost_arm::{
    Arm, Calibration, Coupling, CouplingLimit, Dh, Frame, Joint, Joints, Mat3, Posture, Spherical,
    Structure, Vec3,
};

fn any_joints() -> impl Strategy<Value = Joints> {
    prop::array::uniform6(-PI..PI)
}

fn arm(structure: Structure) -> Arm {
    let joint = Joint { min: -2.0 * PI, max: 2.0 * PI, speed: 3.0, acceleration: None };
    Arm::new(structure, [joint; 6], Some(Coupling::None), 300.0).unwrap()
}

fn any_spherical() -> impl Strategy<Value = Arm> {
    let maker = prop::sample::select(vec!["kuka", "abb", "fanuc", "staubli"]);
    let lengths = (
        0.0..400.0,
        -300.0..300.0,
        -50.0..50.0,
        0.0..900.0,
        200.0..1300.0,
        200.0..1400.0,
        0.0..300.0,
    );
    (maker, lengths).prop_map(|(maker, (a1, a2, b, c1, c2, c3, c4))| {
        arm(spherical(maker, [a1, a2, b, c1, c2, c3, c4]))
    })
}

/// The UR5e, measured: each link a little longer and a little crooked.
fn measured(off: [f64; 6]) -> Arm {
    let twist = |angles: [f64; 3], at: [f64; 3]| {
        Frame::from_mat3_translation(Euler::FixedXyz.matrix(angles), Vec3::from_array(at))
    };
    let [a, b, c, d, e, f] = off;
    let frames = [
        twist([0.0, 0.0, a * 1e-4], [0.0, 0.0, 162.5 + b]),
        twist([PI / 2.0 + c * 1e-3, 0.0, d * 1e-3], [a, 0.0, 0.0]),
        twist([e * 1e-3, f * 1e-3, 0.0], [-425.0 + c, 0.0, 0.0]),
        twist([f * 1e-3, a * 1e-3, b * 1e-3], [-392.2 + d, 0.0, 133.3]),
        twist([PI / 2.0 + b * 1e-3, 0.0, c * 1e-3], [0.0, -99.7 + e, 0.0]),
        twist([-PI / 2.0 + d * 1e-3, 0.0, e * 1e-3], [0.0, 99.6 + f, 0.0]),
    ];
    arm(Structure::Ur(UR5E, Some(Box::new(Calibration(frames)))))
}

/// A joint that turns a little moves the flange about its axis.
fn turns_about_its_axes(arm: &Arm, joints: &Joints) -> Result<(), TestCaseError> {
    let (flange, axes) = arm.flange_and_axes(joints);
    prop_assert_eq!(flange, arm.flange(joints));
    for (i, axis) in axes.iter().enumerate() {
        let mut moved = *joints;
        moved[i] += 1e-3;
        let turn = Mat3::from_axis_angle(axis.direction, 1e-3);
        let at = axis.point + turn * (flange.translation - axis.point);
        let off =
            apart(&Frame::from_mat3_translation(turn * flange.matrix3, at), &arm.flange(&moved));
        prop_assert!(off.0 < 1e-9 && off.1 < 1e-9, "joint {}: {off:?}", i + 1);
    }
    Ok(())
}

/// Every way leads back to the frame, and one of them is where the frame came from.
fn returns(arm: &Arm, joints: &Joints, mm: f64, turned: f64) -> Result<(), TestCaseError> {
    let margins = arm.margins(joints);
    let flange = arm.flange(joints);
    let solutions = arm.inverse(&flange, joints[3]);
    for posture in Posture::ALL {
        let one = arm.inverse_in(posture, &flange, joints[3]);
        prop_assert_eq!(one, solutions.get(posture).copied(), "{:?}", posture);
    }
    for (posture, found) in solutions.iter() {
        let off = apart(&arm.flange(found), &flange);
        prop_assert!(off.0 < mm && off.1 < turned, "{posture:?} {found:?}: {off:?}");
        prop_assert!(found.iter().all(|q| *q > -PI - 1e-12 && *q <= PI + 1e-12));
        // Rounding decides in which of two postures that meet the arm stands.
        let met = arm.margins(found);
        if met.wrist > 1e-6 && met.elbow > 1e-6 && met.shoulder > 1e-3 {
            prop_assert_eq!(arm.posture(found), posture);
        }
    }
    // The joints of a singularity come back as joints of the same frame, not as themselves.
    if margins.wrist > 1e-3 && margins.elbow > 1e-3 && margins.shoulder > 1.0 {
        let same = solutions.get(arm.posture(joints));
        let off = |found: &Joints| found.iter().zip(joints).all(|(a, b)| wrap(a - b).abs() < 1e-7);
        prop_assert!(same.is_some_and(off), "{joints:?} in {solutions:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn the_inverse_of_an_arm_with_a_spherical_wrist_leads_back(arm in any_spherical(), joints in any_joints()) {
        returns(&arm, &joints, 1e-9, 1e-9)?;
    }

    #[test]
    fn the_inverse_of_an_arm_of_universal_robots_leads_back(joints in any_joints()) {
        returns(&arm(Structure::Ur(UR5E, None)), &joints, 1e-9, 1e-9)?;
    }

    #[test]
    fn each_joint_turns_the_flange_about_its_axis(lengths in any_spherical(), off in prop::array::uniform6(-1.0..1.0f64), joints in any_joints()) {
        for arm in [lengths, arm(Structure::Ur(UR5E, None)), measured(off)] {
            turns_about_its_axes(&arm, &joints)?;
        }
    }

    #[test]
    fn turns_are_whole_revolutions_within_the_limits_and_none_is_missing(
        joints in any_joints(),
        limits in prop::array::uniform6((-7.0..0.0f64, 0.1..7.0f64)),
    ) {
        let joint = |i: usize| Joint { min: limits[i].0, max: limits[i].1, speed: 1.0, acceleration: None };
        let structure = spherical("abb", [100.0, -100.0, 0.0, 500.0, 700.0, 700.0, 80.0]);
        let arm = Arm::new(structure, std::array::from_fn(joint), None, 0.0).unwrap();
        let all: Vec<Joints> = arm.within(&joints).collect();
        let counted: usize = (0..6)
            .map(|i| (-3..=3).filter(|turn| {
                let q = joints[i] + std::f64::consts::TAU * f64::from(*turn);
                (limits[i].0 - 1e-9..=limits[i].1 + 1e-9).contains(&q)
            }).count())
            .product();
        prop_assert_eq!(all.len(), counted);
        for found in all {
            prop_assert!(arm.allows(&found));
            prop_assert!(found.iter().zip(&joints).all(|(a, b)| wrap(a - b).abs() < 1e-9));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    #[test]
    fn the_inverse_of_a_calibrated_arm_leads_back(off in prop::array::uniform6(-1.0..1.0f64), joints in any_joints()) {
        let arm = measured(off);
        let margins = arm.margins(&joints);
        // Near a singularity the nominal arm, from which the search starts, may reach in no posture.
        prop_assume!(margins.wrist > 0.05 && margins.elbow > 0.3 && margins.shoulder > 30.0);
        let flange = arm.flange(&joints);
        let solutions = arm.inverse(&flange, 0.0);
        let near = |found: &Joints| found.iter().zip(&joints).all(|(a, b)| wrap(a - b).abs() < 1e-7);
        prop_assert!(solutions.iter().any(|(_, found)| near(found)), "{joints:?} in {solutions:?}");
        for (_, found) in solutions.iter() {
            let off = apart(&arm.flange(found), &flange);
            prop_assert!(off.0 < 1e-8 && off.1 < 1e-8, "{off:?}");
        }
    }
}

#[test]
fn a_frame_out_of_reach_has_no_way() {
    let arm = arm(spherical("kuka", [25.0, -35.0, 0.0, 400.0, 455.0, 420.0, 80.0]));
    let far = Frame::from_translation(Vec3::new(2000.0, 0.0, 400.0));
    assert_eq!(arm.inverse(&far, 0.0).iter().count(), 0);
    // In axis 1 of an arm whose plane does not go through it.
    let offset = self::arm(spherical("staubli", [0.0, 0.0, 20.0, 375.0, 290.0, 310.0, 70.0]));
    let inside = Frame::from_translation(Vec3::new(0.0, 10.0, 300.0));
    assert_eq!(offset.inverse(&inside, 0.0).iter().count(), 0);
}

#[test]
fn a_stretched_wrist_keeps_the_joint_4_that_it_had() {
    let arm = arm(spherical("abb", [0.0, -70.0, 0.0, 290.0, 270.0, 302.0, 72.0]));
    let joints = [0.2, 0.3, -0.4, 1.1, 0.0, -0.7];
    let solutions = arm.inverse(&arm.flange(&joints), 1.1);
    let same = solutions.get(Posture::of(false, false, false)).unwrap();
    assert!(same.iter().zip(&joints).all(|(a, b)| (a - b).abs() < 1e-9), "{same:?}");
}

#[test]
fn what_is_no_arm_is_refused() {
    let joint = Joint { min: -3.0, max: 3.0, speed: 3.0, acceleration: None };
    let good = Spherical {
        a1: 25.0,
        a2: -35.0,
        b: 0.0,
        c1: 400.0,
        c2: 455.0,
        c3: 420.0,
        c4: 80.0,
        offsets: [0.0; 6],
        signs: [1.0; 6],
    };
    let refused = |structure, joint: Joint, what: &str| {
        let why = Arm::new(structure, [joint; 6], None, 0.0).unwrap_err().to_string();
        assert!(why.contains(what), "{why}");
    };
    let spherical = Structure::Spherical;
    refused(spherical(Spherical { c2: 0.0, ..good }), joint, "c2 is 0");
    refused(spherical(Spherical { a2: 0.0, c3: 0.0, ..good }), joint, "a2, c3");
    refused(spherical(Spherical { c1: f64::NAN, ..good }), joint, "100000 mm");
    refused(
        spherical(Spherical { signs: [1.0, 1.0, 0.5, 1.0, 1.0, 1.0], ..good }),
        joint,
        "1 or -1",
    );
    refused(Structure::Ur(Dh { a3: 0.0, ..UR5E }, None), joint, "a3 is 0");
    refused(spherical(good), Joint { max: -3.0, ..joint }, "joint 1: the lower limit");
    refused(spherical(good), Joint { max: 1e9, ..joint }, "ten revolutions");
    refused(spherical(good), Joint { speed: 0.0, ..joint }, "above 0");
}

#[test]
fn joint_3_as_the_controller_counts_it_has_limits_of_its_own() {
    let joint = Joint { min: -3.0, max: 3.0, speed: 3.0, acceleration: None };
    let structure = spherical("fanuc", [50.0, -35.0, 0.0, 330.0, 330.0, 335.0, 80.0]);
    let arm = Arm::new(structure.clone(), [joint; 6], Some(Coupling::LessJoint2), 330.0).unwrap();
    let joints = [0.0, -1.0, 1.5, 0.0, 0.5, 0.0];
    assert_eq!(arm.shown(&joints).unwrap()[2], 2.5);
    assert!(arm.allows(&joints));
    let arm = arm.with_coupling_limit(CouplingLimit { min: -1.0, max: 2.4 }).unwrap();
    assert!(!arm.allows(&joints) && arm.within(&joints).next().is_none());
    // An arm of which nobody has said how it counts shows nothing.
    let unsaid = Arm::new(structure, [joint; 6], None, 330.0).unwrap();
    assert_eq!((unsaid.shown(&joints), unsaid.model(&joints)), (None, None));
}
