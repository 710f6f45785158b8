//! Bodies that tests need.

#![allow(dead_code, reason = "each test file uses its part")]

use glam::DVec3;
use std::f64::consts::{PI, TAU};
use toolpost_glass::mesh::Mesh;

/// Triangles over a grid of `columns` by `rows` of two parameters from 0 to 1.
fn grid(columns: u32, rows: u32, place: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let mut mesh = Mesh::default();
    for j in 0..=rows {
        let row = (0..=columns)
            .map(|i| place(f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows)));
        mesh.vertices.extend(row);
    }
    let wide = columns + 1;
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let a = j * wide + i;
        mesh.triangles.extend([[a, a + 1, a + wide + 1], [a, a + wide + 1, a + wide]]);
    }
    mesh
}

/// A sphere around the origin, mm.
pub fn sphere(radius: f64, rows: u32) -> Mesh {
    grid(2 * rows, rows, |u, v| {
        let (turn, fall) = (u * TAU, v * PI);
        radius * DVec3::new(fall.sin() * turn.cos(), fall.sin() * turn.sin(), -fall.cos())
    })
}

/// A ring around Z, mm.
pub fn torus(radius: f64, tube: f64, rows: u32) -> Mesh {
    grid(3 * rows, rows, |u, v| {
        let (turn, fall) = (u * TAU, v * TAU);
        let out = radius + tube * fall.cos();
        DVec3::new(out * turn.cos(), out * turn.sin(), tube * fall.sin())
    })
}
