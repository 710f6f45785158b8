//! The machine file of an arm.

use crate::text::{quoted, short};
use arm::{Arm, Structure};
use program::{Diagnostic, Rule};
use std::fmt::Write as _;

/// What the file leaves open.
pub(super) fn open(arm: &Arm, reach: Option<f64>) -> Vec<Diagnostic> {
    let mut open = Vec::new();
    if matches!(arm.structure(), Structure::Spherical(_)) {
        let help = "write `coupling` into [arm]: none, less-joint-2 (FANUC) or plus-joint-2 (parallel rod of ABB)";
        let message = "no description says how the controller counts joint 3";
        open.push(Diagnostic::warning(Rule::ArmCoupling, message).help(help));
    }
    if reach.is_none() {
        let message = format!(
            "the arm reaches {:.1} mm to the wrist centre, and nobody has stated its reach",
            arm.reach()
        );
        let help = "compare it with the data sheet, and give that figure by --reach";
        open.push(Diagnostic::warning(Rule::ArmReach, message).help(help));
    }
    open
}

/// The file for an arm that the description `origin` calls `name`.
pub(super) fn file(origin: &str, name: &str, arm: &Arm, reach: Option<f64>) -> String {
    let title = if name.trim().is_empty() { origin } else { name.trim() };
    let mut out = format!(
        "# Imported from {}: confidence as that of its source.\ntitle = {}\n\n[arm]\n",
        short(origin),
        quoted(&short(title))
    );
    match arm.structure() {
        Structure::Spherical(lengths) => {
            let named = [
                ("a1", lengths.a1),
                ("a2", lengths.a2),
                ("b", lengths.b),
                ("c1", lengths.c1),
                ("c2", lengths.c2),
                ("c3", lengths.c3),
                ("c4", lengths.c4),
            ];
            let _ = writeln!(out, "lengths = {{ {} }}", fields(&named));
            let _ = writeln!(out, "offsets = [{}]", list(&lengths.offsets.map(degrees)));
            let _ = writeln!(out, "signs = [{}]", list(&lengths.signs));
            out.push_str("# How the controller counts joint 3: none, less-joint-2 or plus-joint-2. Without it no joint positions are written.\n# coupling = \"none\"\n");
        }
        Structure::Ur(dh, _) => {
            let named = [
                ("d1", dh.d1),
                ("a2", dh.a2),
                ("a3", dh.a3),
                ("d4", dh.d4),
                ("d5", dh.d5),
                ("d6", dh.d6),
            ];
            let _ = writeln!(out, "dh = {{ {} }}\ncoupling = \"none\"", fields(&named));
        }
    }
    let _ = writeln!(out, "world_height = {}", arm.world_height());
    if let (Some(reach), Structure::Spherical(_)) = (reach, arm.structure()) {
        let _ = writeln!(out, "reach = {reach}");
    }
    out.push_str("joints = [\n");
    for joint in arm.joints() {
        let [min, max, speed] = [joint.min, joint.max, joint.speed].map(degrees);
        let _ = writeln!(out, "    {{ min = {min}, max = {max}, speed = {speed} }},");
    }
    out.push_str("]\n");
    out
}

fn fields(named: &[(&str, f64)]) -> String {
    let all: Vec<String> =
        named.iter().map(|(name, length)| format!("{name} = {length}")).collect();
    all.join(", ")
}

fn list(numbers: &[f64]) -> String {
    let all: Vec<String> = numbers.iter().map(f64::to_string).collect();
    all.join(", ")
}

/// Degrees, without the rounding of radians with nine decimals.
fn degrees(angle: f64) -> f64 {
    let degrees = angle.to_degrees();
    let tidy = (degrees * 1e4).round() / 1e4 + 0.0;
    if (tidy - degrees).abs() < 1e-6 { tidy } else { degrees }
}
