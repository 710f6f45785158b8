//! Joints and frames that others have computed or read from controllers: `vectors.json` of the real input, all of it.

use crate::robots::*;
use geom::{Euler, wrap};
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use toolpost_arm::{Arm, Coupling, Frame, Joints, Mat3, Posture, Vec3};

fn degrees(value: &Value) -> Joints {
    numbers::<6>(value).map(f64::to_radians)
}

/// The flange of a vector in each of the five notations that it has.
fn notations(flange: &Value) -> Vec<Mat3> {
    let [w, x, y, z]: [f64; 4] = numbers(&flange["quaternion_wxyz"]);
    let (xx, yy, zz) = (Vec3::new(x, y, z), w * w - x * x - y * y - z * z, 2.0);
    let turned = |v: Vec3| v * yy + xx * (zz * xx.dot(v)) + xx.cross(v) * (zz * w);
    let quaternion = Mat3::from_cols(turned(Vec3::X), turned(Vec3::Y), turned(Vec3::Z));
    let [a, b, c] = numbers::<3>(&flange["kuka_abc_deg"]).map(f64::to_radians);
    let wpr = numbers::<3>(&flange["fanuc_wpr_deg"]).map(f64::to_radians);
    let vector = Vec3::from_array(numbers(&flange["rotation_vector_rad"]));
    let (axis, angle) = (vector.normalize_or(Vec3::X), vector.length());
    let rotated = [Vec3::X, Vec3::Y, Vec3::Z].map(|v| geom::rotate(v, axis, angle));
    vec![
        quaternion,
        Euler::FixedXyz.matrix([c, b, a]),
        Euler::FixedXyz.matrix(wpr),
        Mat3::from_cols(rotated[0], rotated[1], rotated[2]),
    ]
}

fn near(a: &Joints, b: &Joints, tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| wrap(a - b).abs() < tolerance)
}

fn posture(flags: &Value) -> Posture {
    let [rear, below, flip] = numbers::<3>(flags).map(|flag| flag != 0.0);
    Posture::of(rear, below, flip)
}

/// That the inverse has exactly the joints listed, each in the posture listed where one is.
fn has_exactly(arm: &Arm, flange: &Frame, listed: &[Value], what: &str) {
    let solutions = arm.inverse(flange, 0.0);
    assert_eq!(solutions.iter().count(), listed.len(), "{what}: {solutions:?}");
    for solution in listed {
        // Ten digits of degrees: near a stretched elbow or wrist the seventh counts.
        let joints = degrees(&solution["joints_deg"]);
        let found = solutions.iter().find(|(_, found)| near(found, &joints, 5e-5));
        let (found_in, found) =
            found.unwrap_or_else(|| panic!("{what}: {joints:?} in {solutions:?}"));
        if let Some(flags) = solution.get("rear_below_flip") {
            assert_eq!(found_in, posture(flags), "{what}");
            assert_eq!(arm.posture(found), found_in, "{what}");
        }
        if let Some(within) = solution.get("within_limits") {
            let mut limits = arm.joints().iter().zip(&joints);
            let met = limits.any(|(joint, q)| {
                (wrap(q - joint.min)).abs().min(wrap(q - joint.max).abs()) < 1e-6
            });
            // At a limit rounding decides.
            let is_within = arm.within(found).next().is_some();
            assert!(met || is_within == within.as_bool().unwrap(), "{what} {joints:?}");
        }
    }
}

#[test]
fn every_arm_is_where_two_separate_derivations_put_it() {
    let (Some(arms), Some(vectors)) = (data("robots.json"), data("vectors.json")) else { return };
    let (mut forward, mut inverse) = (0, 0);
    for robot in vectors["per_robot"].as_array().unwrap() {
        let name = robot["robot"].as_str().unwrap();
        let all = arms["robots"].as_array().unwrap();
        let arm = arm(all.iter().find(|arm| arm["id"] == robot["robot"]).unwrap());
        for vector in robot["vectors"].as_array().unwrap() {
            let joints = degrees(&vector["joints_deg"]);
            let flange = arm.flange(&joints);
            let stated = &vector["flange"];
            for axes in notations(stated) {
                let (mm, turned) = apart(&flange, &frame(numbers(&stated["xyz_mm"]), axes));
                assert!(mm < 1e-5 && turned < 2e-8, "{name} {joints:?}: {mm} mm, {turned}");
            }
            if let Some(shown) = vector.get("joints_controller_deg") {
                assert!(near(&arm.shown(&joints).unwrap(), &degrees(shown), 1e-9), "{name}");
                assert!(near(&arm.model(&degrees(shown)).unwrap(), &joints, 1e-9), "{name}");
            }
            if let Some(flags) = vector.get("rear_below_flip") {
                assert_eq!(arm.posture(&joints), posture(flags), "{name} {joints:?}");
            }
            if let Some(listed) = vector.get("inverse") {
                has_exactly(&arm, &flange, listed.as_array().unwrap(), name);
                inverse += 1;
            }
            forward += 1;
        }
    }
    // So many are in the file: 17 arms, 26 joint sets each, all solutions for ten of them.
    assert_eq!(forward, 17 * 26);
    assert_eq!(inverse, 170);
}

#[test]
fn an_irb_6700_reaches_what_robodk_has_printed() {
    let Some(vectors) = data("vectors.json") else { return };
    let cases = &vectors["outside"]["robodk_irb6700_155_285"];
    let arm = free(spherical("abb", named(&cases["opw_mm"], LENGTHS)));
    let tool = frame([380.0, 0.0, 200.0], Mat3::from_rotation_y(FRAC_PI_2));
    let all = cases["vectors"].as_array().unwrap();
    for case in all {
        let joints = degrees(&case["joints_deg"]);
        let [x, y, z, about_z, about_y, about_x]: Joints =
            numbers(&case["tcp_xyz_mm_abc_first_about_z"]);
        let axes = Euler::FixedXyz.matrix([about_x, about_y, about_z].map(f64::to_radians));
        let (mm, turned) = apart(&(arm.flange(&joints) * tool), &frame([x, y, z], axes));
        // Joints are printed with five decimals.
        assert!(mm < 1e-3 && turned < 1e-6, "{joints:?}: {mm} mm, {turned}");
        assert_eq!(arm.posture(&joints), posture(&case["rear_lower_flip"]), "{joints:?}");
    }
    assert_eq!(all.len(), 13);
}

#[test]
fn both_ways_agree_with_opw_kinematics_in_cpp() {
    let Some(vectors) = data("vectors.json") else { return };
    let cases = &vectors["outside"]["opw_cases"];
    let all = cases["vectors"].as_array().unwrap();
    for case in all {
        let name = case["robot"].as_str().unwrap();
        let (maker, lengths) = match name {
            "Irb2400_10" => ("abb", name),
            "KukaKR6_R700_sixx" => ("kuka", "KR 6 R700 sixx"),
            _ => panic!("{name}"),
        };
        let arm = free(spherical(maker, named(&cases["opw_mm"][lengths], LENGTHS)));
        let joints = degrees(&case["joints_deg"]);
        let [x, y, z, w]: [f64; 4] = numbers(&case["quaternion_xyzw"]);
        let stated = serde_json::json!({
            "quaternion_wxyz": [w, x, y, z], "kuka_abc_deg": [0, 0, 0],
            "fanuc_wpr_deg": [0, 0, 0], "rotation_vector_rad": [0, 0, 0],
        });
        let at = numbers::<3>(&case["xyz_m"]).map(|metres| metres * 1000.0);
        let flange = arm.flange(&joints);
        let (mm, turned) = apart(&flange, &frame(at, notations(&stated)[0]));
        assert!(mm < 1e-9 && turned < 1e-12, "{name} {joints:?}: {mm} mm, {turned}");
        let solutions = arm.inverse(&flange, joints[3]);
        for solution in case["solutions_deg"].as_array().unwrap() {
            let solution = degrees(solution);
            let found = solutions.iter().any(|(_, found)| near(found, &solution, 5e-5));
            assert!(found, "{name} {joints:?}: {solution:?} in {solutions:?}");
        }
    }
    assert_eq!(all.len(), 80);
}

#[test]
fn arms_of_universal_robots_agree_with_pybotics() {
    let Some(vectors) = data("vectors.json") else { return };
    let cases = &vectors["outside"]["pybotics_ur10"];
    let arm = free(dh(&cases["dh_mm"]));
    for case in cases["vectors"].as_array().unwrap() {
        let joints = degrees(&case["joints_deg"]);
        let m: [f64; 16] = numbers(&case["matrix_row_major_mm"]);
        let axes = Mat3::from_cols_array(&[m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]]);
        let (mm, turned) = apart(&arm.flange(&joints), &frame([m[3], m[7], m[11]], axes));
        assert!(mm < 1e-9 && turned < 1e-12, "{joints:?}: {mm} mm, {turned}");
    }
}

#[test]
fn two_arms_stand_where_the_tests_of_robots_by_visose_put_them() {
    let Some(vectors) = data("vectors.json") else { return };
    for case in vectors["outside"]["visose"]["vectors"].as_array().unwrap() {
        let (structure, joints) = match case.get("opw_mm") {
            Some(lengths) => {
                (spherical("abb", named(lengths, LENGTHS)), degrees(&case["joints_deg"]))
            }
            None => (dh(&case["dh_mm"]), numbers(&case["joints_rad"])),
        };
        let flange = free(structure).flange(&joints);
        let at = Vec3::from_array(numbers(&case["flange_xyz_mm"]));
        // Four decimals are printed, of degrees or of radians.
        let printed = if case.get("joints_rad").is_some() { 0.15 } else { 2e-3 };
        assert!(flange.translation.distance(at) < printed, "{case} {flange:?}");
        let axes = match case.get("flange_x_axis") {
            Some(_) => ["flange_x_axis", "flange_y_axis"]
                .map(|name| Vec3::from_array(numbers(&case[name]))),
            None => continue,
        };
        assert!((flange.matrix3.x_axis.distance(axes[0])) < 1e-5, "{case} {flange:?}");
        assert!((flange.matrix3.y_axis.distance(axes[1])) < 1e-5, "{case} {flange:?}");
    }
}

#[test]
fn a_point_read_from_a_fanuc_says_where_its_world_is_and_how_it_counts_joint_3() {
    let Some(vectors) = data("vectors.json") else { return };
    let case = &vectors["outside"]["fanuc_r2000ib_165f"];
    let joint = toolpost_arm::Joint { min: -4.0, max: 4.0, speed: 1.0, acceleration: None };
    let structure = spherical("fanuc", named(&case["opw_mm"], LENGTHS));
    let arm = Arm::new(structure, [joint; 6], Some(Coupling::LessJoint2), 670.0).unwrap();
    let [x, y, z, w, p, r] = named(&case["pose"], ["X", "Y", "Z", "W", "P", "R"]);
    let axes = Euler::FixedXyz.matrix([w, p, r].map(f64::to_radians));
    let solutions = arm.inverse(&frame([x, y, z], axes), 0.0);
    // N U T: neither flipped nor below nor rear; on a FANUC J5 < 0 is N, which is a positive angle of the model.
    let shown = arm.shown(solutions.get(Posture::of(false, false, false)).unwrap()).unwrap();
    for (i, stated) in case["joints_controller_deg"].as_array().unwrap().iter().take(3).enumerate()
    {
        let off = shown[i].to_degrees() - stated.as_f64().unwrap();
        assert!(off.abs() < 5e-4, "joint {}: {off}", i + 1);
    }
}
