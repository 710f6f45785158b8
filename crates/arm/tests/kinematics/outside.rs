//! Two libraries of others, EAIK (subproblems) and ur-analytic-ik, find the same joints for the same frames.

use crate::robots::{UR5E, UR10E, apart, frame, free, spherical};
use geom::wrap;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;
use toolpost_arm::{Arm, Frame, Joints, Mat3, Structure};

/// Reads arms and frames (file 1), prints the forward kinematics of joints and all inverse solutions as JSON.
const SOLVE: &str = r#"
import json, sys
import numpy as np
jobs = json.load(open(sys.argv[1]))
out = []
for job in jobs:
    poses = [np.array(p, dtype=float).reshape(4, 4) for p in job["poses"]]
    if job["judge"] == "eaik":
        from eaik.IK_HP import HPRobot
        robot = HPRobot(np.array(job["H"], dtype=float), np.array(job["P"], dtype=float))
        forward = [np.asarray(robot.fwdKin(np.array(q, dtype=float))) for q in job["joints"]]
        solutions = []
        for pose in poses:
            found = robot.IK(pose)
            exact = [not bool(ls) for ls in found.is_LS] if hasattr(found, "is_LS") else [True] * len(found.Q)
            solutions.append([list(map(float, q)) for q, good in zip(found.Q, exact) if good])
    else:
        import ur_analytic_ik
        robot = getattr(ur_analytic_ik, job["judge"])
        forward = [robot.forward_kinematics(*q) for q in job["joints"]]
        solutions = [[list(map(float, q)) for q in robot.inverse_kinematics(pose)] for pose in poses]
    out.append({"forward": [f.flatten().tolist() for f in forward], "solutions": solutions})
json.dump(out, sys.stdout)
"#;

/// Joints that differ from run to run of the loop and not from run to run of the test.
fn joints(count: usize) -> Vec<Joints> {
    let mut state = 17_u64;
    let mut angle = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * TAU
    };
    (0..count).map(|_| std::array::from_fn(|_| angle())).collect()
}

fn rows(frame: &Frame, scale: f64) -> Vec<f64> {
    let (m, t) = (frame.matrix3, frame.translation * scale);
    let row = |i: usize| [m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat()
}

fn frame_of(rows: &[f64], scale: f64) -> Frame {
    let axes = Mat3::from_cols_array(&[
        rows[0], rows[4], rows[8], rows[1], rows[5], rows[9], rows[2], rows[6], rows[10],
    ]);
    frame([rows[3], rows[7], rows[11]].map(|length| length / scale), axes)
}

fn solved(python: &Path, jobs: &Value) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("jobs.json");
    fs::write(&file, jobs.to_string()).unwrap();
    let run = Command::new(python).args(["-c", SOLVE]).arg(&file).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    serde_json::from_slice(&run.stdout).unwrap()
}

/// Compares what a judge says of an arm; `scale` is the length of its unit in ours.
fn compare(name: &str, arm: &Arm, all: &[Joints], said: &Value, scale: f64, tolerance: f64) {
    let list = |value: &Value| -> Vec<f64> { serde_json::from_value(value.clone()).unwrap() };
    let mut count = 0;
    for (i, joints) in all.iter().enumerate() {
        let flange = arm.flange(joints);
        let (mm, turned) = apart(&flange, &frame_of(&list(&said["forward"][i]), scale));
        assert!(mm < 1e-6 && turned < 1e-9, "{name} forward {joints:?}: {mm} mm, {turned}");
        let solutions = arm.inverse(&flange, joints[3]);
        // Near a singularity angles are worth fewer digits.
        let good = |q: &Joints| {
            let margins = arm.margins(q);
            margins.wrist > 0.02 && margins.elbow > 0.02 && margins.shoulder > 5.0
        };
        if !solutions.iter().all(|(_, q)| good(q)) {
            continue;
        }
        let theirs: Vec<Joints> = (said["solutions"][i].as_array().unwrap().iter())
            .map(|q| list(q).try_into().unwrap())
            .collect();
        let near =
            |a: &Joints, b: &Joints| a.iter().zip(b).all(|(a, b)| wrap(a - b).abs() < tolerance);
        for (posture, ours) in solutions.iter() {
            assert!(
                theirs.iter().any(|q| near(q, ours)),
                "{name} {posture:?} {ours:?} in {theirs:?}"
            );
        }
        for q in &theirs {
            assert!(
                solutions.iter().any(|(_, ours)| near(q, ours)),
                "{name} {q:?} in {solutions:?}"
            );
        }
        count += solutions.iter().count();
    }
    assert!(count > 3 * all.len(), "{name}: {count} solutions of {} frames", all.len());
}

#[test]
fn eaik_finds_all_solutions_that_we_find_and_no_others() {
    let Some(python) = judge::python("eaik") else { return };
    let all = joints(400);
    // Of each maker one, as lengths alone: EAIK has no zeros and signs.
    let lengths = [
        ("KR 6 R900 sixx", [25.0, -35.0, 0.0, 400.0, 455.0, 420.0, 80.0]),
        ("KR 120 R2700-2", [330.0, -115.0, 0.0, 645.0, 1150.0, 1220.0, 215.0]),
        ("IRB 120", [0.0, -70.0, 0.0, 290.0, 270.0, 302.0, 72.0]),
        ("IRB 6700", [320.0, -200.0, 0.0, 780.0, 1135.0, 1182.5, 200.0]),
        ("LR Mate 200iD", [50.0, -35.0, 0.0, 330.0, 330.0, 335.0, 80.0]),
        ("R-2000iC", [312.0, -225.0, 0.0, 670.0, 1075.0, 1280.0, 215.0]),
        ("TX60", [0.0, 0.0, 20.0, 375.0, 290.0, 310.0, 70.0]),
    ];
    let arms: Vec<Arm> = lengths.iter().map(|(_, l)| free(spherical("staubli", *l))).collect();
    let job = |(arm, (_, [a1, a2, b, c1, c2, c3, c4])): (&Arm, &(&str, [f64; 7]))| {
        let metres = |point: [f64; 3]| point.map(|mm| mm / 1000.0);
        let points =
            [[0.0, 0.0, *c1], [*a1, *b, 0.0], [0.0, 0.0, *c2], [*a2, 0.0, *c3]].map(metres);
        json!({
            "judge": "eaik",
            "H": [[0, 0, 1], [0, 1, 0], [0, 1, 0], [0, 0, 1], [0, 1, 0], [0, 0, 1]],
            "P": [points[0], points[1], points[2], points[3], [0, 0, 0], [0, 0, 0], metres([0.0, 0.0, *c4])],
            "joints": all,
            "poses": all.iter().map(|q| rows(&arm.flange(q), 1e-3)).collect::<Vec<_>>(),
        })
    };
    let jobs: Vec<Value> = arms.iter().zip(&lengths).map(job).collect();
    let said = solved(&python, &json!(jobs));
    for ((arm, (name, _)), said) in arms.iter().zip(&lengths).zip(&said) {
        compare(name, arm, &all, said, 1e-3, 1e-9);
    }
}

#[test]
fn ur_analytic_ik_finds_all_solutions_that_we_find_and_no_others() {
    let Some(python) = judge::python("ur_analytic_ik") else { return };
    let all = joints(400);
    let arms =
        [("ur5e", UR5E), ("ur10e", UR10E)].map(|(name, dh)| (name, free(Structure::Ur(dh, None))));
    let jobs = arms.iter().map(|(name, arm)| {
        let poses: Vec<_> = all.iter().map(|q| rows(&arm.flange(q), 1e-3)).collect();
        json!({ "judge": name, "joints": all, "poses": poses })
    });
    let said = solved(&python, &jobs.collect());
    for ((name, arm), said) in arms.iter().zip(&said) {
        compare(name, arm, &all, said, 1e-3, 1e-9);
    }
}
