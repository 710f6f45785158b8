//! All joints that put the flange of an arm into a frame, next to rs-opw-kinematics in the same run; and the choice of turn and posture
//! along a path, next to the joints of all its turns alone; and a whole program for a KUKA, from cutter-location data to its proof, next
//! to the joints of its points alone.

use crate::fastest;
use ::arm::{Arm, Coupling, Frame, Joint, Joints, Mat3, Spherical, Structure, Vec3};
use armpath::{Cell, Point, Settings, choose};
use program::{Diagnostic, Rule};
use rs_opw_kinematics::kinematic_traits::{Kinematics, Pose};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
use std::fmt::Write as _;
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
    path(poses / 2, rounds, &arm)?;
    whole(5 * poses, &arm)
}

/// Prints what a proven KRL program of so many points takes.
fn whole(count: usize, arm: &Arm) -> Result<(), Vec<Diagnostic>> {
    let text = rings(count);
    let machine = machine::load("kuka-kr6-r900")?;
    let cell = machine.cell.as_ref().and_then(|cell| Some((cell.part, cell.tool(None)?)));
    let Some((part, tool)) = cell else { return Ok(()) };
    let floor = fastest(1, &mut || {
        for i in 0..count {
            let (tip, _) = ring(i, count);
            let down = Frame::from_rotation_x(std::f64::consts::PI);
            let at = part * Frame::from_translation(tip) * down * tool.inverse();
            black_box(arm.inverse(&at, 0.0));
        }
        Ok(())
    })?;
    let mut bytes = 0;
    let ours = fastest(1, &mut || {
        let source = source::apt::read("rings.cls", text.as_bytes(), &Default::default())?.program;
        let written = post::write(&source, &machine)?;
        bytes = written.text.len();
        let proof =
            proof::prove(&source, &machine, "rings.src", &written.text, &Default::default());
        match proof.proven {
            true => Ok(()),
            false => Err(proof.mismatches),
        }
    })?;
    println!(
        "a KRL program of {count} points, {} MB, from cutter-location data to its proof",
        bytes / 1_000_000
    );
    println!("  floor: the joints of each point once, on one thread: {}", floor.time);
    println!("  program and proof: {}; peak {} MB", ours.time, ours.peak / 1_000_000);
    println!("    divided by the floor: {}", ours.time.times(floor.time));
    Ok(())
}

/// Rings on a shallow dome within reach of the KR 6, the tool up to 5 degrees off the vertical, as cutter-location data.
fn rings(count: usize) -> String {
    let mut text =
        String::from("PARTNO/RINGS\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\n");
    let goto = |text: &mut String, tip: Vec3, axis: Vec3| {
        let ([x, y, z], [i, j, k]) = (tip.to_array(), axis.to_array());
        // A text takes every write.
        let _ = writeln!(text, "GOTO/{x:.4},{y:.4},{z:.4},{i:.7},{j:.7},{k:.7}");
    };
    let (tip, axis) = ring(0, count);
    goto(&mut text, tip + axis * 50.0, axis);
    text += "FEDRAT/MMPM,600\n";
    for i in 0..count {
        let (tip, axis) = ring(i, count);
        goto(&mut text, tip, axis);
    }
    let (tip, axis) = ring(count.saturating_sub(1), count);
    text += "RAPID\n";
    goto(&mut text, tip + axis * 50.0, axis);
    text + "FINI\n"
}

fn ring(i: usize, count: usize) -> (Vec3, Vec3) {
    let part = i as f64 / count as f64;
    let (turn, lean) = (i as f64 * 0.3 / 60.0, (1.0 + 4.0 * part).to_radians());
    let axis = Vec3::new(lean.sin() * turn.cos(), lean.sin() * turn.sin(), lean.cos());
    ((axis - Vec3::Z) * 400.0, axis)
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
