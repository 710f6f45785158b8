//! What `toolpost machines` says of an arm.

use crate::answer::Answer;
use ::arm::{Arm, Structure};
use app::toolpath::describe;
use app::{Verdict, summary};
use machine::Machine;
use serde_json::{Value, json};

/// Joints, reach and rail (mm), and what is known of it.
pub fn abilities(machine: &Machine) -> String {
    let reach = machine.arm.as_ref().map_or(0.0, Arm::reach);
    let rail = machine.cell.as_ref().and_then(|cell| cell.rail);
    let rail = rail.map_or_else(String::new, |rail| {
        format!(", on a rail of {} mm", summary::number(rail.max - rail.min, 1))
    });
    format!("six joints, reach {} mm{rail}", summary::number(reach, 1))
}

/// An arm without mistakes: how far it reaches, its joints, and what is left open.
pub fn check(machine: &Machine, arm: &Arm) -> Answer {
    let kind = match arm.structure() {
        Structure::Spherical(_) => "axes 4 to 6 meet in one point",
        Structure::Ur(_, None) => "axes 2 to 4 are parallel",
        Structure::Ur(_, Some(_)) => "axes 2 to 4 are parallel, as the factory has measured them",
    };
    let unchecked = unchecked(arm);
    let mut lines = vec![
        ("machine", machine.title.clone()),
        ("arm", format!("{kind}; reach {} mm", summary::number(arm.reach(), 1))),
        ("world", format!("{} mm above the foot", summary::number(arm.world_height(), 3))),
    ];
    let names = ["joint 1", "joint 2", "joint 3", "joint 4", "joint 5", "joint 6"];
    for (name, joint) in names.into_iter().zip(arm.joints()) {
        let [min, max, speed] =
            [joint.min, joint.max, joint.speed].map(|angle| summary::number(angle.to_degrees(), 3));
        lines.push((name, format!("{min} to {max} degrees, {speed} degrees/s")));
    }
    lines.push(("mistakes", String::from("none")));
    lines.push(("not checked", unchecked.join("; ")));
    let joints: Vec<Value> = (arm.joints().iter())
        .map(|joint| {
            json!({
                "min_degrees": joint.min.to_degrees(),
                "max_degrees": joint.max.to_degrees(),
                "speed_degrees_s": joint.speed.to_degrees(),
                "acceleration_degrees_s2": joint.acceleration.map(f64::to_degrees),
            })
        })
        .collect();
    let data = json!({
        "machine": describe(machine),
        "arm": { "reach_mm": arm.reach(), "world_height_mm": arm.world_height(), "joints": joints },
        "not_checked": unchecked,
    });
    Answer::summary(Verdict::Done, summary::rows(&lines), data)
}

/// What its file leaves open.
fn unchecked(arm: &Arm) -> Vec<&'static str> {
    let mut open = Vec::new();
    if arm.coupling().is_none() {
        open.push(
            "joint 3 as the controller counts it: `coupling` is missing in [arm]; compare the pendant with joint 2 at 0 \
             and at 30 degrees",
        );
    }
    if arm.joints().iter().any(|joint| joint.acceleration.is_none()) {
        open.push("accelerations: a joint has none, times are estimates");
    }
    open.push("whether the arm hits itself or its cell");
    open
}
