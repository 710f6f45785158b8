//! What Universal Robots has measured of one arm: the `calibration.yaml` that its driver for ROS saves.
//!
//! Two levels of mappings, of which the inner ones hold numbers: more of YAML is not read.

use super::{Read, fail};
use crate::Import;
use arm::{Arm, Calibration, Dh, Joint, Joints, Structure};
use program::{Diagnostic, Rule, nearest};
use std::fmt::Write as _;

/// The links in their order.
const LINKS: [&str; 6] = ["shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"];
const PARTS: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];

/// How far a measured arm may be from the one it was built as, mm.
const LIKE: f64 = 20.0;

/// Makes a machine file of the bytes of the calibration `file`, which extends the arm `extends`.
///
/// # Errors
/// What cannot be read, with its line; a calibration that is not one of that arm.
pub fn import(file: &str, bytes: &[u8], extends: Option<&str>) -> Result<Import, Vec<Diagnostic>> {
    let refused = |found: Diagnostic| vec![found.file(file)];
    let boxed = |found: Box<Diagnostic>| vec![found.file(file)];
    let rows = read(super::text(bytes).map_err(boxed)?).map_err(boxed)?;
    let help = "say which arm it was measured on by --extends, such as ur5e or ur10e";
    let name = extends.ok_or_else(|| {
        refused(
            Diagnostic::error(Rule::ArmExtends, "it does not say of which arm it is").help(help),
        )
    })?;
    let machine = machine::load(name).map_err(|why| vec![*why])?;
    let nominal = machine.arm.as_ref().map(Arm::structure);
    let Some(Structure::Ur(dh, _)) = nominal else {
        let message = format!("`{name}` is no arm of Universal Robots");
        return Err(refused(Diagnostic::error(Rule::ArmExtends, message).help(help)));
    };
    let off = off(dh, &rows).map_err(boxed)?;
    if off.is_nan() || off > LIKE {
        let message = format!("the arm that was measured is up to {off:.1} mm from `{name}`");
        return Err(refused(Diagnostic::error(Rule::ArmCalibration, message).help(help)));
    }
    let message = format!("the arm as measured is up to {off:.3} mm from `{name}`");
    let findings = vec![Diagnostic::warning(Rule::ArmCalibration, message).file(file).help(
        "programs of joints depend on it, programs of poses do not; it is true of this one arm",
    )];
    Ok(Import { text: write(file, name, &rows), extends: name.to_owned(), findings })
}

fn write(file: &str, name: &str, rows: &[[f64; 6]; 6]) -> String {
    let (origin, name) = (crate::text::short(file), crate::text::quoted(name));
    let mut out = format!(
        "# Imported from {origin}: one arm, as its factory has measured it.\nextends = {name}\n\n[arm]\ncalibration = [\n"
    );
    for (link, row) in LINKS.iter().zip(rows) {
        let numbers: Vec<String> = row.iter().map(f64::to_string).collect();
        let _ = writeln!(out, "    [{}], # {link}", numbers.join(", "));
    }
    out.push_str("]\n");
    out
}

/// Rows of mm and degrees.
fn read(text: &str) -> Read<[[f64; 6]; 6]> {
    let wrong = |line: usize, message: String| {
        let help = "take the file as the driver of Universal Robots saves it: six links, each with x, y, z, roll, pitch and yaw";
        Diagnostic::error(Rule::Calibration, message)
            .line(u32::try_from(line).unwrap_or(u32::MAX))
            .help(help)
    };
    let mut rows = [[None::<f64>; 6]; 6];
    let mut link = None;
    for (number, line) in (1..).zip(text.lines()) {
        let content = line.split('#').next().unwrap_or_default();
        let trimmed = content.trim();
        if trimmed.is_empty() || trimmed == "---" {
            continue;
        }
        let Some((key, value)) = trimmed.split_once(':') else {
            return fail(wrong(number, format!("`{trimmed}` is no `key: value`")));
        };
        let (key, value) = (key.trim(), value.trim());
        if value.is_empty() {
            link = LINKS.iter().position(|name| *name == key);
            if link.is_none() && key != "kinematics" {
                let meant = nearest(key, LINKS.into_iter());
                let help = if meant.is_empty() {
                    format!("there are {}", LINKS.join(", "))
                } else {
                    format!("did you mean {meant}?")
                };
                return fail(wrong(number, format!("`{key}` is no link of the arm")).help(help));
            }
            continue;
        }
        // A fingerprint of the figures, for the driver.
        if key == "hash" {
            continue;
        }
        let part = PARTS.iter().position(|name| *name == key);
        let (Some(link), Some(part)) = (link, part) else {
            return fail(
                wrong(number, format!("`{key}` belongs to no link"))
                    .help(format!("a link has {}", PARTS.join(", "))),
            );
        };
        let number_of = value.parse::<f64>().ok().filter(|value| value.abs() <= 100.0);
        let Some(value) = number_of else {
            return fail(wrong(
                number,
                format!("`{value}` is no number up to 100 (metres, radians)"),
            ));
        };
        if rows[link][part].replace(value).is_some() {
            return fail(wrong(number, format!("`{key}` of `{}` is said twice", LINKS[link])));
        }
    }
    let mut whole = [[0.0; 6]; 6];
    for (link, row) in rows.iter().enumerate() {
        for (part, value) in row.iter().enumerate() {
            let message = || format!("`{}` of `{}` is missing", PARTS[part], LINKS[link]);
            let value = value.ok_or_else(|| wrong(0, message()))?;
            whole[link][part] = if part < 3 { value * 1000.0 } else { value.to_degrees() };
        }
    }
    Ok(whole)
}

/// The farthest that the measured flange is from the nominal one, mm, over joints of the whole range.
fn off(dh: &Dh, rows: &[[f64; 6]; 6]) -> Read<f64> {
    let joint = Joint { min: -1.0, max: 1.0, speed: 1.0, acceleration: None };
    let arm = |calibration| Arm::new(Structure::Ur(*dh, calibration), [joint; 6], None, 0.0);
    let wrong = |why: arm::Misfit| {
        Diagnostic::error(Rule::Calibration, why.to_string())
            .help("take the file as the driver saves it")
    };
    let nominal = arm(None).map_err(wrong)?;
    let measured = arm(Some(Box::new(Calibration::of_rows(*rows)))).map_err(wrong)?;
    let mut most: f64 = 0.0;
    for i in 0..32_u32 {
        let joints: Joints =
            std::array::from_fn(|k| f64::from((i * 7 + 5 * k as u32) % 32) * 0.2 - 3.1);
        most = most.max(
            nominal.flange(&joints).translation.distance(measured.flange(&joints).translation),
        );
    }
    Ok(most)
}
