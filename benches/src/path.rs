//! A five-axis toolpath of any length: a ball end mill going to and fro over a wavy surface, the tool
//! leaning from its normal to one side, so that it never points along the pole of a rotary axis: a control
//! that is given vectors would lead it through the pole there, and such a cut is refused (`pole-way`).

use geom::Vec3;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Points of one pass.
const PASS: usize = 2_000;

/// Half the width of the surface, mm.
const HALF: f64 = 100.0;

/// How far the tool leans from the normal, radians: more than the surface slopes.
const LEAN: f64 = 20.0 / 360.0 * TAU;

/// Cutter-location data (APT) with `records` points; the tool leans, or it is upright.
pub fn cutter_location_data(records: usize, leans: bool) -> String {
    let mut text = String::with_capacity(records * 70 + 1_000);
    text.push_str("PARTNO/WAVE\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,12000,CLW\nCOOLNT/ON\n");
    text.push_str("RAPID\n");
    put(&mut text, Vec3::new(-HALF, -HALF, 60.0), Vec3::Z);
    text.push_str("FEDRAT/MMPM,3000\n");
    let passes = records.div_ceil(PASS);
    for i in 0..records {
        let (pass, along) = (i / PASS, i % PASS);
        let along = along as f64 / (PASS - 1) as f64 * 2.0 - 1.0;
        // Every other pass goes back, so that the path has no jumps.
        let x = HALF * if pass % 2 == 0 { along } else { -along };
        let y = HALF * (pass as f64 / passes as f64 * 2.0 - 1.0);
        let (point, axis) = surface(x, y);
        put(&mut text, point, if leans { axis } else { Vec3::Z });
    }
    text.push_str("SPINDL/OFF\nCOOLNT/OFF\nFINI\n");
    text
}

/// The point above x, y (mm) and the unit tool axis there, 17 to 34 degrees from the vertical.
fn surface(x: f64, y: f64) -> (Vec3, Vec3) {
    let (u, v) = (TAU * x / 150.0, TAU * y / 180.0);
    let z = 4.0 * u.sin() * v.cos() + 0.02 * x;
    let slope_x = 4.0 * TAU / 150.0 * u.cos() * v.cos() + 0.02;
    let slope_y = -4.0 * TAU / 180.0 * u.sin() * v.sin() + 0.1;
    let normal = Vec3::new(-slope_x, -slope_y, 1.0).normalize();
    let (sin, cos) = LEAN.sin_cos();
    let axis =
        Vec3::new(normal.x, cos * normal.y - sin * normal.z, sin * normal.y + cos * normal.z);
    (Vec3::new(x, y, z + 0.1 * y), axis)
}

fn put(text: &mut String, p: Vec3, axis: Vec3) {
    // Writing to a string does not fail.
    let _ = writeln!(
        text,
        "GOTO/{:.4},{:.4},{:.4},{:.7},{:.7},{:.7}",
        p.x, p.y, p.z, axis.x, axis.y, axis.z
    );
}
