//! All joints that put the flange of an arm into a frame, next to rs-opw-kinematics in the same run; and the choice of turn and posture
//! along a path, next to the joints of all its turns alone.

use crate::fastest;
use ::arm::{Arm, Coupling, Frame, Joint, Joints, Mat3, Spherical, Structure, Vec3};
use armpath::{Cell, Point, Settings, choose};
use program::{Diagnostic, Rule};
use rs_opw_kinematics::kinematic_traits::{Kinematics, Pose};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
use std::hint::black_box;

/// KUKA KR 6 R900 sixx, mm.
const LENGTHS: Spherical = Spherical {
    a1: 25.0,
    a2: -35.0,
    b: 0.0,
    c1: 400.0,
    c2: 455.0,
    c3: 420.0,
    c4: 80.0,
    offsets: [0.0, -std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0, 0.0],
    signs: [-1.0, 1.0, 1.0, -1.0, 1.0, -1.0],
};

/// Prints what all solutions of so many frames take.
///
/// # Errors
/// None comes; the figures are those of other stages.
pub fn measure(poses: usize, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let misfit = |why: ::arm::Misfit| vec![Diagnostic::error(Rule::Internal, why.to_string())];
    let joint = Joint { min: -3.0, max: 3.0, speed: 6.0, acceleration: None };
    let structure = Structure::Spherical(LENGTHS);
    let arm = Arm::new(structure, [joint; 6], Some(Coupling::None), 0.0).map_err(misfit)?;
    let joints: Vec<Joints> = (0..poses).map(spread).collect();
    let frames: Vec<Frame> = joints.iter().map(|joints| arm.flange(joints)).collect();
    let peer = peer();
    let theirs: Vec<Pose> = joints.iter().map(|joints| peer.forward(joints)).collect();

    let mut found = [0, 0];
    let by_peer = fastest(rounds, &mut || {
        found[0] = theirs.iter().map(|pose| black_box(peer.inverse(pose)).len()).sum();
        Ok(())
    })?;
    let ours = fastest(rounds, &mut || {
        found[1] =
            frames.iter().map(|frame| black_box(arm.inverse(frame, 0.0)).iter().count()).sum();
        Ok(())
    })?;
    let forward = fastest(rounds, &mut || {
        joints.iter().for_each(|joints| {
            black_box(arm.flange(joints));
        });
        Ok(())
    })?;
    println!("{poses} frames of an arm, all joints that reach each");
    println!("  rs-opw-kinematics: {}; {} solutions", by_peer.time, found[0]);
    println!("  inverse: {}; {} solutions", ours.time, found[1]);
    println!("    the peer divided by it: {}", by_peer.time.times(ours.time));
    println!("  forward: {}", forward.time);
    path(poses / 2, rounds, &arm)
}

/// Prints what the choice along a path of so many points takes.
fn path(count: usize, rounds: usize, arm: &Arm) -> Result<(), Vec<Diagnostic>> {
    let out = Frame::from_translation(Vec3::new(0.0, 0.0, 80.0));
    let leaning = Frame::from_mat3(Mat3::from_rotation_y(std::f64::consts::FRAC_PI_4));
    let part = Frame::from_translation(Vec3::new(500.0, 0.0, 150.0));
    let cell = Cell { tool: out * leaning * out, part };
    let points: Vec<Point> = (0..count).map(|i| dome(i, count)).collect();
    let (settings, flange) = (Settings::default(), cell.tool.inverse());
    let turns = usize::from(settings.turns);
    let floor = fastest(1, &mut || {
        for point in &points {
            let at = Frame::from_translation(part.transform_point3(point.tip));
            for turn in 0..turns {
                let turned = Frame::from_rotation_z(turn as f64);
                black_box(arm.inverse(&(at * turned * flange), 0.0));
            }
        }
        Ok(())
    })?;
    let mut sections = 0;
    let ours = fastest(rounds.min(2), &mut || {
        let choice = choose(arm, &cell, &points, &settings);
        let blocked =
            |why: armpath::Blocked| vec![Diagnostic::error(Rule::Internal, why.to_string())];
        sections = choice.map_err(blocked)?.sections.len();
        Ok(())
    })?;
    println!("turn and posture of an arm along {count} points, {turns} turns; {sections} section");
    println!("  floor: the joints of all turns, on one thread: {}", floor.time);
    println!("  choice: {}; peak {} MB", ours.time, ours.peak / 1_000_000);
    println!("    divided by the floor: {}", ours.time.times(floor.time));
    Ok(())
}

/// A point of rings on a dome, with the tool at right angles to it.
fn dome(i: usize, count: usize) -> Point {
    let part = i as f64 / count as f64;
    let (turn, lean) = (part * 200.0 * std::f64::consts::TAU, (2.0 + 38.0 * part).to_radians());
    let axis = Vec3::new(lean.sin() * turn.cos(), lean.sin() * turn.sin(), lean.cos());
    Point {
        tip: (axis - Vec3::Z) * 120.0,
        axis,
        side: None,
        cut: i > 0,
        feed: 1800.0,
        inside: false,
    }
}

fn peer() -> OPWKinematics {
    let metres = |mm: f64| mm / 1000.0;
    OPWKinematics::new(Parameters {
        a1: metres(LENGTHS.a1),
        a2: metres(LENGTHS.a2),
        b: metres(LENGTHS.b),
        c1: metres(LENGTHS.c1),
        c2: metres(LENGTHS.c2),
        c3: metres(LENGTHS.c3),
        c4: metres(LENGTHS.c4),
        offsets: LENGTHS.offsets,
        sign_corrections: LENGTHS.signs.map(|sign| sign as i8),
        dof: 6,
    })
}

/// Joints that fill the range evenly (golden ratio and its kin): the same in every run.
fn spread(i: usize) -> Joints {
    let steps = [0.618_034, 0.754_878, 0.569_840, 0.819_173, 0.671_044, 0.549_700];
    steps.map(|step| ((i as f64 * step).fract() - 0.5) * 6.0)
}
