//! Points on a sphere in glass and their order, with the marks of the work: how many are found a second, how many of the laser's
//! pulses are used. The floor of sampling is to look once at every pair of the points within two spacings, which any proof of
//! the distance has to do; that of the order, to find who shadows whom and go greedily from point to point.

use crate::fastest;
use ::glass::clock::Clock;
use ::glass::cloud::{Point, distances};
use ::glass::mesh::Mesh;
use ::glass::order::{self, Effort, Shadow};
use ::glass::profile::{Limits, Profile};
use ::glass::sample::{Apart, surface};
use geom::Vec3;
use program::{Diagnostic, Rule};
use std::f64::consts::{PI, TAU};

/// Rows of triangles from pole to pole.
const ROWS: u32 = 200;

/// Prints what a sphere of about so many points takes at both lens presets, and at 0.05 mm.
///
/// # Errors
/// Two points are too close, which is a fault of the sampling.
pub fn measure(points: usize, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    sampled(points, 50, rounds)?;
    // The triangle profile at 7.5 m/s² and 0.1 m/s, 100 Hz; the defect of each lens and the cone of a lens of 70 mm in K9.
    let clock = Clock::new(100.0, Profile::Triangle, [Limits::metric(7.5, 0.1); 3]);
    for (spacing, radius) in [(90, 47.5), (130, 67.5)] {
        let cloud = sampled(points, spacing, rounds)?;
        let shadow = Shadow { slope: 0.0235, radius };
        let mut ticks = [0; 2];
        let mut measured = Vec::new();
        for (at, most) in [0, Effort::default().rounds].into_iter().enumerate() {
            let effort = Effort { rounds: most, ..Effort::default() };
            measured.push(fastest(rounds.min(2), &mut || {
                let order = order::fastest(&cloud, &cloud, shadow, &clock, effort);
                ticks[at] = order::ticks(&cloud, &order, &clock);
                Ok(())
            })?);
        }
        let used = |ticks: u64| 100.0 * cloud.len() as f64 / ticks.max(1) as f64;
        println!("  greedy order: {}; {:.2} of 100 pulses used", measured[0].time, used(ticks[0]));
        println!("  order: {}; {:.2} of 100 pulses used", measured[1].time, used(ticks[1]));
        println!("    divided by the floor: {}", measured[1].time.times(measured[0].time));
        let bound = order::bound(&cloud, &cloud, Some(shadow), &clock);
        println!("  bound by assignment: {:.2} of 100", used(bound).min(100.0));
        // Nothing is nearer to an axis than 0.
        let none = Shadow { slope: 0.0, radius: 0.0 };
        let free = order::fastest(&cloud, &cloud, none, &clock, Effort::default());
        let free = used(order::ticks(&cloud, &free, &clock));
        println!(
            "  order without the shadow rule: {free:.2}; the rule costs {:.2}",
            free - used(ticks[1])
        );
    }
    Ok(())
}

/// A sphere of about `count` points, `spacing` µm apart: prints what they take.
fn sampled(count: usize, spacing: u32, rounds: usize) -> Result<Vec<Point>, Vec<Diagnostic>> {
    // There are some 0.72 points on a square of one spacing.
    let area = count as f64 / 0.72 * (f64::from(spacing) * 1e-3).powi(2);
    let body = sphere((area / (4.0 * PI)).sqrt());
    let mut points = Vec::new();
    let sampling = fastest(rounds, &mut || {
        points = surface(&body, Apart { spacing, lost: 0.0 }, 1);
        Ok(())
    })?;
    let mut close = 0;
    let floor = fastest(rounds, &mut || {
        close = distances(&points, i64::from(spacing)).too_close;
        Ok(())
    })?;
    if close > 0 {
        let message = format!("{close} pairs of points are nearer than {spacing} µm");
        return Err(vec![Diagnostic::error(Rule::Internal, message)]);
    }
    println!("{} points on a sphere in glass, {spacing} µm apart", points.len());
    println!(
        "  sampling: {}; {:.2} million points a second of wall",
        sampling.time,
        points.len() as f64 * 1e-6 / sampling.time.wall.as_secs_f64()
    );
    println!(
        "  floor: {}\n    divided by the floor: {}",
        floor.time,
        sampling.time.times(floor.time)
    );
    Ok(points)
}

/// A sphere around the origin, mm.
fn sphere(radius: f64) -> Mesh {
    let columns = 2 * ROWS;
    let place = |(row, column): (u32, u32)| {
        let (out, up) = (PI * f64::from(row) / f64::from(ROWS)).sin_cos();
        let (sin, cos) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
        radius * Vec3::new(out * cos, out * sin, -up)
    };
    let all = (0..=ROWS).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let number = |row: u32, column: u32| row * columns + column % columns;
    let faces = |(row, column): (u32, u32)| {
        let [a, b] = [number(row, column), number(row, column + 1)];
        let [c, d] = [number(row + 1, column + 1), number(row + 1, column)];
        [[a, b, c], [a, c, d]]
    };
    let cells = all.clone().filter(|(row, _)| *row < ROWS);
    Mesh {
        vertices: all.map(place).collect(),
        triangles: cells.flat_map(faces).collect(),
        ..Mesh::default()
    }
}
