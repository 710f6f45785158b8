//! What the tests of robots have in common: a toolpath posted and proven, and what the proof finds of damages to the program.

use crate::dice::Dice;
use crate::files::root;
use arm::Joints;
use control::{Action, ArmAction, ArmPath, Dialect, Event, Settings};
use geom::{Euler, Frame, Mat3, Vec3};
use machine::Machine;
use program::{Feed, OutputValue, Program};
use proof::Report;

/// The job of the specification of robots, as cutter-location data.
pub const JOB: &str = "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\nGOTO/0,0,-2\n\
FEDRAT/MMPM,1200\nGOTO/60,0,-2\nCIRCLE/60,20,-2,0,0,1,20\nGOTO/80,20,-2\nRAPID\nGOTO/80,20,50\nFINI\n";

/// A plunge and a line.
pub const LINE: &str = "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\n\
GOTO/0,0,-2\nFEDRAT/MMPM,1200\nGOTO/60,0,-2\nRAPID\nGOTO/60,0,50\nFINI\n";

/// So many steps of 6 degrees round a ball of 20 mm, the tool 25° off a direction that leans by 45° towards the arm: about the direction of
/// its forearm, so that joint 4 turns with the cut.
pub fn rings(steps: u32) -> Program {
    let (tilt, half) = (45_f64.to_radians(), 25_f64.to_radians());
    let direction = Vec3::new(-tilt.sin(), 0.0, tilt.cos());
    let across = Vec3::new(tilt.cos(), 0.0, tilt.sin());
    let mut text =
        String::from("PARTNO/RINGS\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\n");
    let last = f64::from(steps) * std::f64::consts::TAU / 60.0;
    let mut goto = |height: f64, turn: f64| {
        let about = across * turn.cos() + Vec3::Y * turn.sin();
        let axis = direction * half.cos() + about * half.sin();
        let tip = axis * (20.0 + height) + Vec3::Z * 100.0;
        let [x, y, z] = tip.to_array();
        let [i, j, k] = axis.to_array();
        text += &format!("GOTO/{x:.5},{y:.5},{z:.5},{i:.9},{j:.9},{k:.9}\n");
        if height > 0.0 && turn == 0.0 {
            text += "FEDRAT/MMPM,300\n";
        } else if turn == 0.0 {
            text += "FEDRAT/MMPM,600\n";
        } else if turn == last && height == 0.0 {
            text += "RAPID\n";
        }
    };
    goto(60.0, 0.0);
    for step in 0..=steps {
        goto(0.0, f64::from(step) * std::f64::consts::TAU / 60.0);
    }
    goto(60.0, last);
    source(&format!("{text}FINI\n"))
}

/// A robot of the library with parts of its file changed.
pub fn changed(name: &str, changes: &[(&str, &str)]) -> Machine {
    let path = root().join(format!("machines/robots/{name}.toml"));
    let mut text = std::fs::read_to_string(path).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    machine::load_text("mine.toml", &text).unwrap()
}

/// [`LINE`] with a part changed is refused, at this line and with these words.
#[track_caller]
pub fn refused(from: &str, to: &str, machine: &Machine, line: u32, what: &str) {
    assert!(LINE.contains(from), "{from}");
    let source = source(&LINE.replacen(from, to, 1));
    let found = post::write(&source, machine).expect_err(to);
    let found = &found[0];
    assert!(found.message.contains(what) || found.help.contains(what), "{found}");
    assert_eq!(found.line, line, "{found}");
}

/// Where the motions of a program go.
pub fn paths(dialect: Dialect, text: &str) -> Vec<ArmPath> {
    let of = |event: Event| match event.action {
        Action::Arm(ArmAction::Move(motion)) => Some(motion.path),
        _ => None,
    };
    events(dialect, text).into_iter().filter_map(of).collect()
}

pub fn source(text: &str) -> Program {
    source::apt::read("job.cls", text.as_bytes(), &Default::default()).unwrap().program
}

pub fn written(source: &Program, machine: &Machine) -> Result<String, String> {
    let output = post::write(source, machine).map_err(|found| found[0].to_string())?;
    Ok(String::from_utf8(output.text).unwrap())
}

pub fn proof_of(source: &Program, machine: &Machine, text: &str) -> Report {
    proof::prove(source, machine, "job", text.as_bytes(), &Default::default())
}

#[track_caller]
pub fn proven(source: &Program, machine: &Machine) -> String {
    let text = written(source, machine).unwrap();
    let report = proof_of(source, machine, &text);
    assert!(report.proven, "{text}\n{:#?}", report.mismatches);
    text
}

/// The joints, as the controller shows them, that put the tool straight down at a point, turned by `turn` degrees about its axis.
pub fn joints(machine: &Machine, tip: [f64; 3], turn: f64) -> Joints {
    let (arm, cell) = (machine.arm.as_ref().unwrap(), machine.cell.as_ref().unwrap());
    let turns = [180.0_f64, 0.0, turn].map(f64::to_radians);
    let turned: Mat3 = Euler::FixedXyz.matrix(turns);
    let at = Frame::from_mat3_translation(turned, Vec3::from_array(tip));
    let flange = cell.part * at * cell.tool(None).unwrap().inverse();
    let found = arm.inverse(&flange, 0.0);
    let home = arm.model(&cell.home.map(f64::to_radians)).unwrap();
    let posture = arm.posture(&home);
    let (_, joints) = found.iter().find(|(of, _)| *of == posture).unwrap();
    arm.shown(joints).unwrap().map(f64::to_degrees)
}

/// What a control of `dialect` does.
pub fn events(dialect: Dialect, text: &str) -> Vec<Event> {
    let mut events = Vec::new();
    let settings = Settings::new(dialect, [false; 3]);
    control::read(&settings, "job", text.as_bytes(), &mut |event| {
        events.push(event);
        Ok(())
    })
    .unwrap();
    events
}

/// Whether the tips of two frames, and the axes, are the same: how the tool is turned about its axis the source leaves free.
fn near(a: &Frame, b: &Frame) -> bool {
    a.translation.distance(b.translation) < 2e-2
        && a.matrix3.z_axis.distance(b.matrix3.z_axis) < 3e-5
}

/// Whether two programs make the same motion, but for what their tolerances leave open.
fn alike((machine, dialect): (&Machine, Dialect), a: &str, b: &str) -> bool {
    let [a, b] = [a, b].map(|text| kept(dialect, text));
    // Where each motion begins.
    let mut from = None;
    a.len() == b.len()
        && a.iter().zip(&b).all(|((a, fast), (b, other))| {
            let here = from;
            from = match a {
                Action::Arm(ArmAction::Move(motion)) => match motion.path {
                    ArmPath::Line(end) | ArmPath::Arc { end, .. } => Some(end.translation),
                    ArmPath::Joints(_) | ArmPath::Point(_) => None,
                },
                _ => from,
            };
            // The speed of a straight rapid is free.
            same(machine, here, (a, b))
                && ((fast - other).abs() < 0.1 || *fast == machine.cell.as_ref().unwrap().rapid)
        })
}

/// What matters of a program, each line and arc with its feed, mm/min.
fn kept(dialect: Dialect, text: &str) -> Vec<(Action, f64)> {
    let mut feed = 0.0;
    let mut kept = Vec::new();
    for Event { action, .. } in events(dialect, text) {
        match action {
            Action::Feed(Feed::PerMinute(new)) => feed = new,
            Action::Comment(_)
            | Action::Arm(
                ArmAction::JointSpeed(_)
                | ArmAction::JointRate(_)
                | ArmAction::RailSpeed(_)
                | ArmAction::TurnSpeed(_)
                | ArmAction::TipAcceleration(_)
                | ArmAction::JointAcceleration(_),
            ) => {}
            Action::Arm(ArmAction::Move(motion)) => {
                let by_joints = matches!(motion.path, ArmPath::Joints(_));
                let feed = if by_joints { 0.0 } else { feed };
                kept.push((Action::Arm(ArmAction::Move(motion)), feed));
            }
            action => kept.push((action, 0.0)),
        }
    }
    kept
}

/// Whether arcs from `from` to `end` through `a` and through `b` are one: a point may lie anywhere on it.
fn one_arc(from: Option<Vec3>, a: Vec3, b: Vec3, end: Vec3) -> bool {
    let Some(from) = from else { return false };
    let Some((center, axis)) = control::kernel::arc::through(from, a, end) else { return false };
    let spoke = b - center;
    let side = |via: Vec3| (end - from).cross(via - from).dot(axis);
    (spoke.length() - (a - center).length()).abs() < 2e-3
        && spoke.dot(axis).abs() < 2e-3
        && side(a) * side(b) > 0.0
}

fn same(machine: &Machine, from: Option<Vec3>, pair: (&Action, &Action)) -> bool {
    let arm = machine.arm.as_ref().unwrap();
    let tool = machine.cell.as_ref().unwrap().tool(None).unwrap();
    match pair {
        // A corner that is left by less is a better one.
        (Action::Arm(ArmAction::Move(a)), Action::Arm(ArmAction::Move(b))) => {
            let [rail, other] = [a, b].map(|motion| motion.rail.unwrap_or(0.0));
            a.turning == b.turning
                && (rail - other).abs() < 2e-2
                && match (a.path, b.path) {
                    (ArmPath::Joints(a), ArmPath::Joints(b)) => {
                        let [a, b] =
                            [a, b].map(|joints| arm.flange(&joints.map(f64::to_radians)) * tool);
                        near(&a, &b)
                    }
                    (ArmPath::Line(a), ArmPath::Line(b)) => near(&a, &b),
                    // Of the point on the way its orientation does not count.
                    (ArmPath::Arc { via: a, end: c }, ArmPath::Arc { via: b, end: d }) => {
                        let [a, b] = [a, b].map(|via| via.translation);
                        (a.distance(b) < 2e-2 || one_arc(from, a, b, c.translation)) && near(&c, &d)
                    }
                    _ => false,
                }
        }
        (Action::Arm(ArmAction::Base(Some(a))), Action::Arm(ArmAction::Base(Some(b))))
        | (Action::Arm(ArmAction::Tool(Some(a))), Action::Arm(ArmAction::Tool(Some(b)))) => {
            near(a, b)
        }
        (Action::Arm(ArmAction::Load(a, c)), Action::Arm(ArmAction::Load(b, d))) => {
            (a - b).abs() <= 5e-3 && c.distance(*d) <= 0.1
        }
        (Action::Dwell(a), Action::Dwell(b)) => b >= a,
        (Action::Output(a), Action::Output(b)) => match (a.value, b.value) {
            (OutputValue::Analog(x), OutputValue::Analog(y)) => {
                a.number == b.number && (x - y).abs() < 2e-5
            }
            _ => a == b,
        },
        (a, b) => a == b,
    }
}

/// One sign of the program of `sample` changed at a time behind `begin`, 200 times: a digit, a sign, an address, a name. Each is refused,
/// or changes nothing; how many are refused.
pub fn damaged_by_dice(
    sample: &str,
    (machine, dialect): (&Machine, Dialect),
    begin: &str,
    seed: u64,
) -> usize {
    let source = source(sample);
    let text = proven(&source, machine);
    let begin = text.find(begin).unwrap();
    let mut random = Dice(seed);
    let (mut refused, mut harmless) = (0, 0);
    while refused + harmless < 200 {
        let at = begin + random.index(text.len() - begin);
        let old = text.as_bytes()[at];
        let signs: &[u8] = match old {
            b'0'..=b'9' => b"0123456789",
            b'-' | b' ' => b" -",
            b'A'..=b'Z' => b"ABCXYZSTEL",
            b'a'..=b'z' => b"aclmoprtv_",
            _ => b".,{}()[]#=",
        };
        let new = signs[random.index(signs.len())];
        if new == old || matches!(old, b'\r' | b'\n') {
            continue;
        }
        let mut damaged = text.clone().into_bytes();
        damaged[at] = new;
        let damaged = String::from_utf8(damaged).unwrap();
        let report = proof_of(&source, machine, &damaged);
        if report.proven {
            let line = text[..at].matches('\n').count();
            let shown = damaged.lines().nth(line).unwrap();
            assert!(
                alike((machine, dialect), &text, &damaged),
                "{shown} for {}",
                text.lines().nth(line).unwrap()
            );
            harmless += 1;
        } else {
            refused += 1;
        }
    }
    eprintln!("refused {refused}, harmless {harmless}");
    refused
}
