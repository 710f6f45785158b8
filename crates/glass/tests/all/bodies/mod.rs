//! Bodies that tests need.

use glam::DVec3;
use std::f64::consts::TAU;
use toolpost_glass::mesh::Mesh;

/// A closed body over a grid of `columns` by `rows` of two parameters from 0 to 1. The last column is the first one;
/// triangles without area are left out.
fn grid(columns: u32, rows: u32, place: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let mut mesh = Mesh::default();
    let part = |i: u32, of: u32| f64::from(i) / f64::from(of);
    for j in 0..=rows {
        mesh.vertices.extend((0..columns).map(|i| place(part(i, columns), part(j, rows))));
    }
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let next = (i + 1) % columns;
        let [a, b] = [i, next].map(|i| j * columns + i);
        let [c, d] = [a, b].map(|i| i + columns);
        for corners in [[a, b, d], [a, d, c]] {
            let [p, q, r] = corners.map(|corner| mesh.vertices[corner as usize]);
            if p != q && q != r && r != p {
                mesh.triangles.push(corners);
            }
        }
    }
    mesh
}

/// The sine and cosine of a part of a turn; 0 where it is 0 but for rounding.
fn turned(part: f64) -> (f64, f64) {
    let (sin, cos) = (part * TAU).sin_cos();
    let exact = |value: f64| if value.abs() < 1e-12 { 0.0 } else { value };
    (exact(sin), exact(cos))
}

/// A sphere around the origin, mm.
pub fn sphere(radius: f64, rows: u32) -> Mesh {
    grid(2 * rows, rows, |u, v| {
        let ((sin, cos), (out, up)) = (turned(u), turned(0.5 * v));
        radius * DVec3::new(out * cos, out * sin, -up)
    })
}

/// A ring around Z, mm.
pub fn torus(radius: f64, tube: f64, rows: u32) -> Mesh {
    grid(3 * rows, rows, |u, v| {
        let ((sin, cos), (up, out)) = (turned(u), turned(v % 1.0));
        let far = radius + tube * out;
        DVec3::new(far * cos, far * sin, tube * up)
    })
}
