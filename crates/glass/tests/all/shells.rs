//! Copies of a surface within a body.

use crate::bodies::{sphere, torus};
use crate::common::k9;
use glam::DVec3;
use toolpost_glass::cloud::{distances, place};
use toolpost_glass::fill::{Shells, shells};
use toolpost_glass::job::{Settings, make};
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::mesh::{Mesh, Shape};
use toolpost_glass::sample::{Apart, surface};

const APART: Apart = Apart { spacing: 130, lost: 0.0 };

fn inside(mesh: &Mesh, count: u32, distance: f64) -> Vec<DVec3> {
    let points = shells(mesh, Shells { count, distance: Some(distance) }, APART, 1);
    points.into_iter().map(place).collect()
}

/// A box from the origin, two triangles a side.
fn cuboid(size: DVec3) -> Mesh {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { 0.0 };
        DVec3::new(side(0), side(1), side(2)) * size
    };
    let sides: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Mesh { vertices: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

#[test]
fn a_shell_of_a_sphere_is_a_sphere() {
    for inverted in [false, true] {
        let mut mesh = sphere(5.0, 100);
        if inverted {
            mesh.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
        }
        let points = inside(&mesh, 3, 1.0);
        let near = |radius: f64| {
            points.iter().filter(|point| (point.length() - radius).abs() < 0.02).count() as f64
        };
        // The areas of spheres of 4 and 3 mm are as 16 to 9, and no point lies elsewhere.
        assert_eq!(near(4.0) + near(3.0), points.len() as f64);
        assert!((near(4.0) / near(3.0) - 16.0 / 9.0).abs() < 0.05, "{} {}", near(4.0), near(3.0));
        // As dense as a surface: a sphere of 4 mm has that many points.
        let own = surface(&sphere(4.0, 100), APART, 1).len() as f64;
        assert!((near(4.0) / own - 1.0).abs() < 0.02, "{} {own}", near(4.0));
    }
}

#[test]
fn a_shell_of_a_box_has_flat_sides_and_sharp_edges() {
    let size = DVec3::new(8.0, 6.0, 4.0);
    let points = inside(&cuboid(size), 2, 1.0);
    for point in &points {
        let deep = point.min(size - *point).min_element();
        assert!((deep - 1.0).abs() < 0.01, "{point}");
    }
    // A box of 6 x 4 x 2 mm has 88 mm², with 0.70 to 0.74 points in a square of the spacing.
    let density = points.len() as f64 * 0.13 * 0.13 / 88.0;
    assert!((0.68..0.76).contains(&density), "{density}");
}

#[test]
fn a_shell_of_a_body_with_sharp_corners_is_a_smaller_one() {
    // A quarter of a pyramid, whose inscribed sphere has 3 / (3 + sqrt 3) mm: 0.2 mm deep it is smaller by that part.
    let vertices = vec![DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 3.0, DVec3::Z * 3.0];
    let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let roof = Mesh { vertices, triangles, ..Mesh::default() };
    let part = 1.0 - 0.2 / (3.0 / (3.0 + 3f64.sqrt()));
    let area = roof.shell(0.2).area() / roof.area();
    assert!((area - part * part).abs() < 1e-3, "{area} {}", part * part);
}

#[test]
fn where_a_shell_would_cross_itself_there_is_none() {
    // A tube of 1 mm: 0.6 mm deep there is a tube of 0.4 mm, and none 1.2 mm deep.
    let ring = torus(4.0, 1.0, 60);
    let from_tube = |point: &DVec3| (point.truncate().length() - 4.0).hypot(point.z);
    let points = inside(&ring, 3, 0.6);
    assert!(points.len() > 2000);
    assert!(points.iter().all(|point| (from_tube(point) - 0.4).abs() < 0.04));
    // A wall of 1 mm: 0.6 mm from one side are 0.4 mm from the other.
    assert_eq!(inside(&cuboid(DVec3::new(8.0, 8.0, 1.0)), 2, 0.6), []);
}

#[test]
fn a_body_with_shells_becomes_a_proven_program() {
    let machine = Machine::read(library("glass-xyz-100hz").unwrap(), "").unwrap();
    let plain = crate::common::settings([20.0, 20.0, 30.0], 100);
    let settings = Settings { shells: Shells { count: 4, distance: None }, ..plain.clone() };
    let made = |settings: &Settings| {
        let body = Shape::Mesh(torus(3.0, 1.2, 40));
        make(vec![body], &k9(), &machine, settings).unwrap_or_else(|found| panic!("{found:?}"))
    };
    let (one, four) = (made(&plain), made(&settings));
    assert!(four.proven && four.report.proof.too_close == 0, "{:?}", four.findings);
    assert_eq!(distances(&four.cloud, 130).too_close, 0);
    // 1.5 times 133 µm of 1.2 mm each: 1 + 0.83 + 0.67 + 0.5 of the surface.
    let part = four.report.points as f64 / one.report.points as f64;
    assert!((part - 3.0).abs() < 0.15, "{part}");
}
