//! The tables of the source next to ours, and its test vectors.

use super::appendix_f;
use super::parabola::Parabola;
use super::surrogate::FITTED;
use super::{POINTS, surrogate::Surrogate};
use crate::clock::{pump_limit, ticks};
use crate::comparison::{Positioner, full_step, micro_step};
use crate::optics::{Beam, Ray, rayleigh, spot};
use crate::polar::{Branch, Polar, track_speed};
use crate::profile::{Limits, Profile};
use glam::DVec2 as Vec2;
use serde::Serialize;
use std::fmt::Write as _;

/// A number of the source and ours.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// The test of the specification's section 6.
    pub id: &'static str,
    /// What is computed.
    pub what: String,
    /// The source's number.
    pub expected: f64,
    /// Ours.
    pub ours: f64,
    /// By how much they may differ.
    pub tolerance: f64,
}

impl Check {
    /// Whether they agree.
    pub fn agrees(&self) -> bool {
        (self.ours - self.expected).abs() <= self.tolerance
    }
}

/// One row of appendix F.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Row {
    /// Acceleration, m/s²; of the sorting angle's series that angle, degrees.
    pub parameter: f64,
    /// Time as printed, s.
    pub time: f64,
    /// Points per second as printed.
    pub rate: f64,
    /// Time by the surrogate, s; `None` where the row depends on the lost cloud.
    pub ours: Option<f64>,
}

/// A series of appendix F.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    /// What was held.
    pub title: String,
    /// The rows.
    pub rows: Vec<Row>,
}

/// Appendix F with the times of the surrogate.
pub fn series() -> Vec<Series> {
    let swept = |rate: f64, speed: f64, rows: &[[f64; 3]]| {
        let row = |&[acceleration, time, printed]: &[f64; 3]| {
            let per_point = FITTED.ticks_per_point(rate, Limits::metric(acceleration, speed));
            let ours = Some(per_point * POINTS / rate);
            Row { parameter: acceleration, time, rate: printed, ours }
        };
        let title = format!("{rate} Hz, {speed} m/s, by acceleration in m/s²");
        Series { title, rows: rows.iter().map(row).collect() }
    };
    let angle = |&[parameter, time, rate]: &[f64; 3]| Row { parameter, time, rate, ours: None };
    vec![
        swept(50.0, 0.08, &appendix_f::F50_V008),
        swept(50.0, 0.1, &appendix_f::F50_V010),
        swept(100.0, 0.08, &appendix_f::F100_V008),
        swept(100.0, 0.1, &appendix_f::F100_V010),
        Series {
            title: String::from("100 Hz, 0.08 m/s, 7 m/s², by sorting angle in degrees"),
            rows: appendix_f::SORTING_ANGLE.iter().map(angle).collect(),
        },
    ]
}

/// Root mean square and largest difference of the surrogate's times from the printed ones, as parts of those.
fn deviation(series: &[Series]) -> (f64, f64) {
    let rows = series.iter().flat_map(|series| &series.rows);
    let parts: Vec<f64> = rows.filter_map(|row| Some(row.ours? / row.time - 1.0)).collect();
    let square = parts.iter().map(|part| part * part).sum::<f64>() / parts.len() as f64;
    (square.sqrt(), parts.iter().fold(0.0, |most, part| part.abs().max(most)))
}

/// Appendix G: object, block, points, time (s), points per second.
const APPENDIX_G: [(&str, &str, f64, f64, f64); 4] = [
    ("Libra", "20x20x20", 13_196.0, 144.0, 91.64),
    ("Virgo", "40x40x40", 15_777.0, 172.0, 91.73),
    ("Galleon", "40x40x40", 175_305.0, 1906.0, 91.98),
    ("Scorpio", "20x20x20", 21_997.0, 239.0, 92.04),
];

/// Table 6: point, arm and table in degrees and in radians.
const TABLE_6: [([f64; 2], [f64; 2], [f64; 2]); 6] = [
    ([30.0, 30.0], [337.590, 30.050], [5.892_056_121, 0.524_474_762]),
    ([29.0, 30.0], [337.618, 29.456], [5.892_548_24, 0.514_112_49]),
    ([28.0, 30.0], [337.640, 28.867], [5.892_931_41, 0.503_826_55]),
    ([27.0, 30.0], [337.656, 28.282], [5.893_205_32, 0.493_619_46]),
    ([26.0, 30.0], [337.665, 27.702], [5.893_369_75, 0.483_493_58]),
    ([24.0, 30.0], [22.335, -26.556], [0.389_815_558, -0.463_494_25]),
];

/// The machine of table 6.
const EXAMPLE: Polar = Polar { side: 50.0, distance: 200.0, offset: 70.0, arm: 120.0 };

/// Collects checks.
struct Checks(Vec<Check>);

impl Checks {
    fn add(
        &mut self,
        id: &'static str,
        what: impl Into<String>,
        expected: f64,
        ours: f64,
        tolerance: f64,
    ) {
        self.0.push(Check { id, what: what.into(), expected, ours, tolerance });
    }

    fn relative(
        &mut self,
        id: &'static str,
        what: impl Into<String>,
        expected: f64,
        ours: f64,
        part: f64,
    ) {
        self.add(id, what, expected, ours, part * expected.abs());
    }

    fn exact(&mut self, id: &'static str, what: impl Into<String>, expected: f64, ours: f64) {
        self.relative(id, what, expected, ours, 1e-12);
    }
}

/// The test vectors of the specification's section 6.
pub fn checks() -> Vec<Check> {
    let mut all = Checks(Vec::new());
    polar_checks(&mut all);
    motion_checks(&mut all);
    parabola_checks(&mut all);
    throughput_checks(&mut all);
    for (kind, name, expected) in [
        (Positioner::Screw, "screw", 0.5),
        (Positioner::Planar, "planar", 1.0),
        (Positioner::Polar, "polar", 2.0),
    ] {
        all.exact("S1", format!("stiffness, {name}"), expected, kind.stiffness(1.0, 1.0));
    }
    all.exact("L1", "rate that a pump energy of 20 J must stay below, Hz", 50.0, pump_limit(20.0));
    all.exact("D1", "micro step of a motor, µm", 0.15625, 1e3 * micro_step(0.64, 4096));
    all.exact("D1", "full step of a motor, mm", 0.16, full_step(0.64));
    all.0
}

fn polar_checks(all: &mut Checks) {
    for (i, (point, degrees, radians)) in TABLE_6.into_iter().enumerate() {
        let id = if i < 5 { "K1" } else { "K2" };
        let Some(pose) = EXAMPLE.as_printed(Vec2::from_array(point)) else { continue };
        let name = format!("P({}, {})", point[0], point[1]);
        for (angle, what, degrees, radians) in [
            (pose.arm, "arm", degrees[0], radians[0]),
            (pose.table, "table", degrees[1], radians[1]),
        ] {
            all.add(id, format!("{name} {what}, degrees"), degrees, angle.to_degrees(), 5.1e-4);
            all.add(id, format!("{name} {what}, rad"), radians, angle, 5.1e-9);
        }
    }
    let last = Vec2::new(24.0, 30.0);
    if let Some(pose) = EXAMPLE.as_printed(last) {
        let reached = EXAMPLE.forward(pose);
        all.add("K3", "x that the printed pose of P(24, 30) reaches, mm", 26.0, reached.x, 1e-3);
        all.add("K3", "y that it reaches, mm", 30.0, reached.y, 1e-3);
    }
    for (branch, expected) in
        [(Branch::Left, [337.6652, 26.5563]), (Branch::Right, [22.3348, -27.7021])]
    {
        let Some(pose) = EXAMPLE.inverse(last, branch) else { continue };
        let what = |axis| format!("P(24, 30), {branch:?}, {axis}, degrees");
        all.add("K4", what("arm"), expected[0], pose.arm.to_degrees(), 1e-4);
        all.add("K4", what("table"), expected[1], pose.table.to_degrees(), 1e-4);
    }
    all.add("K5", "inverse and forward on a grid, both branches, mm", 0.0, round_trip(), 1e-9);
    all.add(
        "K6",
        "part of the block that the arm does not reach",
        0.1736,
        EXAMPLE.unreachable(2000),
        1e-3,
    );
    let arm = Polar { arm: 130.0, ..EXAMPLE };
    for (degrees, arc, track) in [
        (10.0f64, 34.730, 59.853),
        (20.0, 68.404, 99.199),
        (30.0, 100.0, 119.338),
        (40.0, 128.558, 127.932),
    ] {
        let angle = degrees.to_radians();
        all.add("K7", format!("arc pitch at {degrees}°, mm/rad"), arc, arm.arc_pitch(angle), 1e-3);
        all.add(
            "K8",
            format!("track pitch at {degrees}°, mm/rad"),
            track,
            arm.track_pitch(angle),
            1e-3,
        );
    }
    for (rate, radius, expected) in
        [(100.0, 70.0, 0.142_857), (100.0, 100.0, 0.1), (200.0, 100.0, 0.2)]
    {
        let what = format!("table speed, 0.1 mm at {rate} Hz and radius {radius} mm, rad/s");
        all.add("K9", what, expected, track_speed(0.1, rate, radius), 1e-6);
    }
}

/// The largest error of inverse and forward kinematics on a grid of points, both branches, mm.
fn round_trip() -> f64 {
    let grid = (0..=50).flat_map(|i| (0..=50).map(move |j| Vec2::new(f64::from(i), f64::from(j))));
    let both = grid.flat_map(|point| [Branch::Left, Branch::Right].map(|branch| (point, branch)));
    let error = |(point, branch)| {
        EXAMPLE.inverse(point, branch).map(|pose| EXAMPLE.forward(pose).distance(point))
    };
    both.filter_map(error).fold(0.0, f64::max)
}

fn motion_checks(all: &mut Checks) {
    let fastest = |length, a, v| Profile::Triangle.fastest(length, Limits::metric(a, v));
    for (id, length, a, v, time, speed) in [
        ("M1", 0.1, 7.5, 0.08, 7.302_967, Some(0.027_386_1)),
        ("M2", 0.1, 2.0, 0.08, 14.142_136, Some(0.014_142_1)),
        ("M3", 0.85, 7.5, 0.08, 21.291_626, Some(0.079_843_6)),
        ("M4", 2.0, 7.5, 0.08, 35.666_667, Some(0.08)),
        ("M5", 50.0, 7.5, 0.1, 513.333_33, Some(0.1)),
        ("M6", 0.1, 20.0, 1.0, 4.472_136, None),
        ("M6", 0.1, 30.0, 1.5, 3.651_484, None),
    ] {
        let motion = fastest(length, a, v);
        let what = format!("{length} mm at {a} m/s² and {v} m/s");
        all.relative(id, format!("{what}: ms"), time, motion.time * 1e3, 1e-6);
        if let Some(speed) = speed {
            all.relative(id, format!("{what}: m/s"), speed, motion.speed * 1e-3, 1e-5);
        }
    }
    for (id, rate, a, expected) in [
        ("M7", 50.0, 2.0, 0.2),
        ("M7", 50.0, 5.0, 0.5),
        ("M7", 50.0, 7.5, 0.75),
        ("M7", 50.0, 10.0, 1.0),
        ("M8", 100.0, 2.0, 0.05),
        ("M8", 100.0, 5.0, 0.125),
        ("M8", 100.0, 7.5, 0.1875),
        ("M8", 100.0, 10.0, 0.25),
        ("M8", 200.0, 10.0, 0.0625),
        ("M8", 200.0, 20.0, 0.125),
        ("M8", 200.0, 30.0, 0.1875),
    ] {
        let reach = Profile::Triangle.reach(1.0 / rate, Limits::metric(a, 1e3));
        all.exact(id, format!("reach in a tick at {rate} Hz and {a} m/s², mm"), expected, reach);
    }
    for (profile, acceleration, speed) in
        [(Profile::Triangle, 4.0, 2.0), (Profile::Trapezoid, 4.5, 1.5), (Profile::Spline, 6.0, 1.5)]
    {
        let motion = profile.fastest(3.0, Limits::metric(7.5, 1e3));
        let what = profile.name();
        let by_acceleration = motion.acceleration * motion.time * motion.time / 3.0;
        all.exact(
            "M9",
            format!("{what}: peak acceleration times T²/L"),
            acceleration,
            by_acceleration,
        );
        all.exact(
            "M9",
            format!("{what}: peak speed times T/L"),
            speed,
            motion.speed * motion.time / 3.0,
        );
    }
}

fn parabola_checks(all: &mut Checks) {
    let parabola =
        Parabola { curvature: 2.0, half_width: 0.05, damping: [-1.5, -2.0], gain: [0.8, 1.2] };
    all.add("M10", "length of the parabola, m", 0.100_662_722_7, parabola.length(), 1e-9);
    for (x5, v, growth, expected) in [
        (0.01, 0.08, 1.0, [0.190_764, 0.957_771]),
        (0.05, 0.1, 0.0, [-0.05, 0.166_667]),
        (0.09, 0.05, -2.0, [0.368_281, -1.564_715]),
    ] {
        let ours = parabola.controls(x5, v, growth);
        all.add("M11", format!("u4 at x5 = {x5} m"), expected[0], ours[0], 1e-6);
        all.add("M11", format!("u6 at x5 = {x5} m"), expected[1], ours[1], 1e-6);
    }
    let (time, off) = parabola.run(0.1, 1e-4);
    all.add("M12", "time along the parabola at 0.1 m/s, s", 1.00663, time, 5e-6);
    all.add("M12", "largest distance from the parabola, m", 0.0, off, 1e-12);
}

fn throughput_checks(all: &mut Checks) {
    let series = series();
    for row in series.iter().flat_map(|series| &series.rows) {
        let what = format!("points per second, {} s", row.time);
        all.add("T1", what, row.rate, POINTS / row.time, 0.006);
    }
    let used = |rows: &[[f64; 3]], a: f64, rate: f64| {
        let row = rows.iter().find(|row| row[0] == a);
        row.map_or(f64::NAN, |row| row[2] / rate)
    };
    for (slow, fast) in [(2.0, 8.0), (2.5, 10.0)] {
        let expected = used(&appendix_f::F50_V008, slow, 50.0);
        let ours = used(&appendix_f::F100_V008, fast, 100.0);
        let what = format!("similarity: 50 Hz at {slow} m/s² and 100 Hz at {fast} m/s²");
        all.relative("T2", what, expected, ours, 0.01);
    }
    let (rms, most) = deviation(&series);
    all.add("T3", "surrogate, 53 rows: root mean square, %", 1.34, 100.0 * rms, 0.06);
    all.add("T3", "surrogate, 53 rows: largest, %", 3.02, 100.0 * most, 0.08);
    for (a, expected) in [(10.0, 122.0), (20.0, 154.0), (30.0, 171.0)] {
        let ours = 200.0 / FITTED.ticks_per_point(200.0, Limits::metric(a, 1.0));
        all.add(
            "T4",
            format!("planar drive, 200 Hz, {a} m/s²: points per second"),
            expected,
            ours,
            1.0,
        );
    }
    for (object, _, points, time, rate) in APPENDIX_G {
        all.add("T5", format!("{object}: points per second"), rate, points / time, 0.01);
    }
}

/// Slips of the source that a reader of its tables must know.
const SLIPS: [&str; 17] = [
    "Table 6, last row: the printed pose of (24, 30) reaches (26, 30), its mirror image. The table's angle has the wrong sign left of the middle. With the signed angle no point needs another bend of the elbow, so the three conclusions of chapter 8.4 do not hold.",
    "The arm of the example (120 mm) is shorter than the distance to the work piece (130 mm): 17.4 % of the block cannot be reached.",
    "The condition a + y2 <= r2 leaves out the corners: the table of the example needs a radius of 122.6 mm, not 120 mm.",
    "A spline does not have the smaller acceleration: from rest to rest it takes 6 L/T², a triangle 4, a trapezoid 4.5. At 7.5 m/s² and 100 Hz it reaches 0.125 mm in a tick, a triangle 0.1875 mm.",
    "Equation 14: the root with plus is not feasible.",
    "Chapter 6.6.2 exchanges the names of A_M and V_M, and interpolates from X_B to X_B.",
    "Units: V printed as W, MB as MHz, kW as kWh, 7 m/s² as 7000 m/s².",
    "The lenses are for blocks up to 60 mm (f = 43) and up to 100 mm (f = 70), not above.",
    "Appendix D names a parallel port in one place, RS-422 and RS-232 in another: how the controller was connected is not known.",
    "A cloud has at most 400 000 points in one place, 2 000 000 in another; our screw drives take 2 000 000.",
    "Equations (116) and (117) are printed alike for the modules A and B of the planar motor, which lie a quarter of the pitch of its teeth apart.",
    "Chapter 5.2 explains cracks by glass that does not melt, appendix D by the temperature of plasma: equation (1) says nothing of points within glass, and is not used for them.",
    "+23 points per second between 2 and 10 m/s² at 100 Hz: the table says 90.89 - 57.37 = 33.5.",
    "+82 % from 50 to 100 Hz: the table says +73.1 % at 7.5 m/s², and +84.8 % from best to best.",
    "+47 % by the spline profile: no run without spline is printed.",
    "The index of K9 is taken for the laser's 532 nm (1.5195), not for the yellow line (1.5168): 0.06 mm at 50 mm depth.",
    "A margin of 1.5 to 2.5 mm on each side may cut the beam: its cone at f = 70 mm has a radius of 1.88 mm at 80 mm depth.",
];

/// Spot, aberration and cone of both lenses of the source, a beam of 5 mm and K9 at 532 nm.
fn optics() -> String {
    let (wavelength, diameter, index) = (532e-6, 5.0, 1.5195);
    let mut text = String::from(
        "\nOptics, mm: a beam of 5 mm of 532 nm (Gaussian, M² = 1: a beam of M² has a spot M² times as large), K9\n",
    );
    let _ = writeln!(
        text,
        "  {:>6} {:>9} {:>9} {:>7} {:>9} {:>10} {:>10}",
        "f", "spot", "Rayleigh", "depth", "drive", "aberration", "cone"
    );
    for focal in [43.0, 70.0] {
        let beam = Beam { index, slope: 0.5 * diameter / focal };
        let spot = spot(wavelength, focal, diameter);
        let length = rayleigh(spot, wavelength, index);
        for depth in [10.0, 50.0, 80.0] {
            let (drive, aberration) =
                (depth * beam.drive(Ray::Marginal), depth * beam.aberration());
            let cone = depth * beam.slope_in_glass();
            let _ = writeln!(
                text,
                "  {focal:>6} {spot:>9.5} {length:>9.4} {depth:>7} {drive:>9.4} {aberration:>10.4} {cone:>10.4}"
            );
        }
    }
    text
}

/// The tables as text.
pub fn report() -> String {
    let mut text = String::new();
    let series = series();
    let (rms, most) = deviation(&series);
    let Surrogate { median, deviation } = FITTED;
    let _ = writeln!(
        text,
        "Appendix F: 16179 points; the cloud is lost. Ours: steps with a lognormal length (median {median} mm, deviation {deviation}),\n\
         triangle profile. It has two parameters that were fitted to these rows: difference {:.2} % (root mean square), {:.2} % at most.",
        100.0 * rms,
        100.0 * most
    );
    for Series { title, rows } in &series {
        let _ = writeln!(
            text,
            "\n{title}\n  {:>9} {:>9} {:>9} {:>9} {:>9} {:>7}",
            "", "s", "ours", "points/s", "ours", ""
        );
        for row in rows {
            let _ = write!(text, "  {:>9} {:>9} ", row.parameter, row.time);
            let _ = match row.ours {
                Some(ours) => {
                    let part = 100.0 * (ours / row.time - 1.0);
                    writeln!(
                        text,
                        "{ours:>9.1} {:>9.2} {:>9.2} {part:>+6.1}%",
                        row.rate,
                        POINTS / ours
                    )
                }
                None => writeln!(text, "{:>9} {:>9.2} {:>9}", "-", row.rate, "-"),
            };
        }
    }
    text.push_str(
        "\nAppendix G: laser rate and acceleration are not printed; the objects are lost.\n",
    );
    let _ = writeln!(
        text,
        "  {:<10} {:<10} {:>9} {:>7} {:>10} {:>10}",
        "object", "block", "points", "s", "points/s", "ours"
    );
    for (object, block, points, time, rate) in APPENDIX_G {
        let _ = writeln!(
            text,
            "  {object:<10} {block:<10} {points:>9} {time:>7} {rate:>10.2} {:>10.2}",
            points / time
        );
    }
    text.push_str("\nTable 6: arm and table in degrees; the point that each pose reaches, mm\n");
    let _ = writeln!(
        text,
        "  {:<10} {:>9} {:>9}  {:<16} {:>9} {:>9} {:>9} {:>9}",
        "point", "arm", "table", "reaches", "ours", "", "or", ""
    );
    for (point, printed, radians) in TABLE_6 {
        let pose = crate::polar::Pose { arm: radians[0], table: radians[1] };
        let reached = EXAMPLE.forward(pose);
        let point = Vec2::from_array(point);
        let wrong = if reached.distance(point) > 0.01 { "  <- not its point" } else { "" };
        let _ = write!(
            text,
            "  ({}, {})   {:>9.3} {:>9.3}  ({:.3}, {:.3}) ",
            point.x, point.y, printed[0], printed[1], reached.x, reached.y
        );
        for branch in [Branch::Left, Branch::Right] {
            if let Some(pose) = EXAMPLE.inverse(point, branch) {
                let _ = write!(
                    text,
                    " {:>9.3} {:>9.3}",
                    pose.arm.to_degrees(),
                    pose.table.to_degrees()
                );
            }
        }
        let _ = writeln!(text, "{wrong}");
    }
    text.push_str(
        "\nReach in one tick of 100 Hz, mm: the table of a drive must name its profile\n",
    );
    let _ = writeln!(text, "  {:>6} {:>9} {:>9} {:>9}", "m/s²", "triangle", "trapezoid", "spline");
    for acceleration in [2.0, 5.0, 7.5, 10.0, 20.0, 30.0] {
        let limits = Limits::metric(acceleration, 1.0);
        let [a, b, c] = Profile::ALL.map(|profile| profile.reach(0.01, limits));
        let _ = writeln!(text, "  {acceleration:>6} {a:>9.4} {b:>9.4} {c:>9.4}");
    }
    text.push_str(&optics());
    let checks = checks();
    let good = checks.iter().filter(|check| check.agrees()).count();
    let _ = writeln!(text, "\nTest vectors K, M, T, L, S, D: {good} of {} agree", checks.len());
    for check in checks.iter().filter(|check| !check.agrees() || check.id != "T1") {
        let sign = if check.agrees() { "" } else { "  <- differs" };
        let Check { id, what, expected, ours, .. } = check;
        let _ = writeln!(text, "  {id:<4} {what:<62} {expected:>13.7} {ours:>13.7}{sign}");
    }
    text.push_str("\nSlips of the source\n");
    for slip in SLIPS {
        let _ = writeln!(text, "  - {slip}");
    }
    let step = Profile::Triangle.fastest(0.2, Limits::metric(7.5, 0.1));
    let _ = writeln!(
        text,
        "\nA step of 0.2 mm at 7.5 m/s² and 100 Hz takes {:.3} ms: {} ticks.",
        1e3 * step.time,
        ticks(step.time, 100.0)
    );
    text
}
