//! Solids, and the three ways of the source to make points of bodies. Expected values are counted by hand.

use crate::bodies::sphere;
use glam::DVec3;
use toolpost_glass::cloud::{Point, place};
use toolpost_glass::fill::{Fill, Filling, Left, Sections, direction, points};
use toolpost_glass::mesh::Mesh;
use toolpost_glass::sample::Apart;

const APART: Apart = Apart { spacing: 130, lost: 1.52 };

/// A box from the origin, with two triangles a side.
fn cuboid(x: f64, y: f64, z: f64) -> Mesh {
    let corner = |i: u32| {
        let side = |bit: u32, length: f64| if i >> bit & 1 == 1 { length } else { 0.0 };
        DVec3::new(side(0, x), side(1, y), side(2, z))
    };
    let sides: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { vertices: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

fn filled(mesh: &Mesh, fill: Fill, step: Option<f64>, direction: DVec3) -> (Vec<Point>, Left) {
    let made = points(mesh, &Filling { fill, step, direction }, APART, 1);
    ([made.sampled, made.others].concat(), made.left)
}

fn cut(mesh: &Mesh, how: Sections, step: f64, direction: DVec3) -> (Vec<Point>, Left) {
    filled(mesh, Fill::Sections(how), Some(step), direction)
}

const PLAIN: Sections = Sections { layer: None, first: 0.1, twist: 0.0, ends: true };

#[test]
fn sections_have_points_every_step_of_each_contour() {
    // 4 mm high: planes at 0.1, 1.1, 2.1 and 3.1 mm; the contour is 2 (10 + 6) mm long: 32 points of 1 mm.
    let mesh = cuboid(10.0, 6.0, 4.0);
    let (points, left) = cut(&mesh, PLAIN, 1.0, DVec3::Z);
    assert_eq!(points.len(), 4 * 32);
    // Bottom and top lie along the planes.
    assert_eq!(left, Left { along: 4, ..Left::default() });
    let heights = |z: i32| points.iter().filter(|point| point[2] == z).count();
    assert_eq!([100, 1_100, 2_100, 3_100].map(heights), [32; 4]);
    assert!(points.iter().all(|[x, y, _]| [0, 10_000].contains(x) || [0, 6_000].contains(y)));
    // 32 mm in steps of 0.9 mm come out even at 32 / 35 mm.
    let (points, _) = cut(&mesh, Sections { layer: Some(10.0), ..PLAIN }, 0.9, DVec3::Z);
    assert_eq!(points.len(), 35);
    // Planes at 0.5, 2 and 3.5 mm.
    let (points, _) = cut(&mesh, Sections { layer: Some(1.5), first: 0.5, ..PLAIN }, 1.0, DVec3::Z);
    assert_eq!(points.len(), 3 * 32);
    // Across X: 10 mm; contours of 20 mm.
    let (points, _) = cut(&mesh, PLAIN, 1.0, direction(0, [0.0; 3]));
    assert_eq!(points.len(), 10 * 20);
    // Z turned about X by 90° is -Y: 6 planes, contours of 28 mm.
    let (points, _) = cut(&mesh, PLAIN, 1.0, direction(2, [90.0, 0.0, 0.0]));
    assert_eq!(points.len(), 6 * 28);
}

#[test]
fn a_twist_moves_each_contour_and_an_open_one_has_its_end() {
    let mesh = cuboid(10.0, 6.0, 4.0);
    let (plain, _) = cut(&mesh, PLAIN, 1.0, DVec3::Z);
    let (twisted, _) = cut(&mesh, Sections { twist: 0.5, ..PLAIN }, 1.0, DVec3::Z);
    assert_eq!(twisted.len(), plain.len());
    let whole = |points: &[Point], z: i32| {
        points.iter().filter(|p| p[2] == z && p[0] % 1000 == 0 && p[1] % 1000 == 0).count()
    };
    assert_eq!([whole(&plain, 100), whole(&plain, 1_100)], [32, 32]);
    assert_eq!([whole(&twisted, 100), whole(&twisted, 1_100), whole(&twisted, 2_100)], [32, 0, 32]);
    // One wall of 10 mm: 0 to 9.9 mm in steps of 1.1 mm, and its end.
    let wall = Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X * 10.0, DVec3::new(10.0, 0.0, 4.0), DVec3::Z * 4.0],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let once = Sections { layer: Some(100.0), ..PLAIN };
    assert_eq!(cut(&wall, once, 1.1, DVec3::Z).0.len(), 11);
    assert_eq!(cut(&wall, Sections { ends: false, ..once }, 1.1, DVec3::Z).0.len(), 10);
}

#[test]
fn sections_of_a_sphere_are_circles_of_the_right_radius() {
    let mesh = sphere(5.0, 200);
    let (points, _) = cut(&mesh, Sections { layer: Some(1.0), first: 1.0, ..PLAIN }, 0.2, DVec3::Z);
    for plane in 0..9 {
        let z = -4.0 + f64::from(plane);
        let of: Vec<DVec3> =
            points.iter().map(|p| place(*p)).filter(|p| (p.z - z).abs() < 1e-3).collect();
        let radius = (25.0 - z * z).sqrt();
        let count = (std::f64::consts::TAU * radius / 0.2).floor();
        assert!((of.len() as f64 - count).abs() <= 1.0, "{z}: {} {count}", of.len());
        assert!(of.iter().all(|p| (p.truncate().length() - radius).abs() < 0.01), "{z}");
    }
}

#[test]
fn triangles_have_a_grid_and_small_ones_are_counted() {
    // A right angle with sides of 3 mm, grid of 1 mm: 4 + 3 + 2 + 1 points.
    let mesh = Mesh {
        vertices: vec![
            DVec3::ZERO,
            DVec3::X * 3.0,
            DVec3::Y * 3.0,
            DVec3::new(0.1, 0.1, 5.0),
            DVec3::X * 0.4,
            DVec3::Y * 0.4,
        ],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let (points, left) = filled(&mesh, Fill::Triangles(false), Some(1.0), DVec3::Z);
    assert_eq!((points.len(), left.triangles), (10, 0));
    assert!(points.contains(&[0, 3_000, 0]) && points.contains(&[1_000, 2_000, 0]));
    let small = Mesh { triangles: vec![[0, 1, 2], [0, 4, 5]], ..mesh };
    let (points, left) = filled(&small, Fill::Triangles(false), Some(1.0), DVec3::Z);
    assert_eq!((points.len(), left.triangles), (10, 1));
    let (points, left) = filled(&small, Fill::Triangles(true), Some(1.0), DVec3::Z);
    assert_eq!((points.len(), left.triangles), (11, 1));
    assert_eq!(points[10], [133, 133, 0]);
}

#[test]
fn every_ray_meets_a_closed_body_as_often_as_it_leaves_it() {
    // Nodes every 1 mm lie on edges and corners of the box: each is met once on the bottom and once on the top.
    let (points, left) = filled(&cuboid(10.0, 6.0, 4.0), Fill::Rays, Some(1.0), DVec3::Z);
    let of = |z: i32| points.iter().filter(|point| point[2] == z).count();
    assert_eq!(of(0), of(4_000));
    assert!((60..=77).contains(&of(0)), "{}", of(0));
    assert_eq!((points.len(), left.along), (2 * of(0), 8));
    // Gauss's circle: 1961 nodes lie within 25 steps of one, 20 of them on the circle, outside of the body.
    let tilted = direction(2, [20.0, 30.0, 0.0]);
    let (points, _) = filled(&sphere(5.0, 100), Fill::Rays, Some(0.2), tilted);
    assert_eq!(points.len(), 2 * (1961 - 20));
    assert!(points.iter().all(|point| (place(*point).length() - 5.0).abs() < 0.01));
}

#[test]
fn a_solid_is_filled_within_and_an_open_one_reports_where() {
    let (points, left) = filled(&sphere(3.0, 60), Fill::Solid, Some(0.3), DVec3::Z);
    assert_eq!(left, Left::default());
    let within: Vec<&Point> = points.iter().filter(|p| place(**p).length() < 2.9).collect();
    // A column has 0.3² x 0.866 mm² and a point each 0.3 mm: 42.8 points a mm³, in a ball of 2.9 mm.
    let expected = 4.0 / 3.0 * std::f64::consts::PI * 2.9f64.powi(3) / (0.027 * 0.75f64.sqrt());
    assert!((within.len() as f64 / expected - 1.0).abs() < 0.02, "{} {expected}", within.len());
    assert!(points.iter().all(|point| place(*point).length() < 3.001));
    let nearest = |a: &Point| {
        let squared = |b: &&Point| place(*a).distance_squared(place(**b));
        within.iter().filter(|b| **b != a).map(squared).fold(f64::MAX, f64::min).sqrt()
    };
    assert!(within.iter().take(500).map(|point| nearest(point)).fold(f64::MAX, f64::min) > 0.298);
    // Inside out it is filled as well.
    let mut inverted = sphere(3.0, 60);
    inverted.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    let (turned, left) = filled(&inverted, Fill::Solid, Some(0.3), DVec3::Z);
    let count = turned.iter().filter(|point| place(**point).length() < 2.9).count();
    assert_eq!((count, left), (within.len(), Left::default()));
    let mut open = cuboid(4.0, 4.0, 4.0);
    open.triangles.truncate(10);
    let (_, left) = filled(&open, Fill::Solid, Some(0.3), DVec3::Z);
    assert!(left.columns > 10 && left.first_column.is_some(), "{left:?}");
}

#[test]
fn a_body_that_crosses_itself_is_filled_once() {
    let mut both = sphere(3.0, 60);
    let mut other = sphere(3.0, 60);
    other.vertices.iter_mut().for_each(|place| place.x += 3.0);
    both.join(other);
    let filling = Filling { fill: Fill::Solid, step: Some(0.3), direction: DVec3::Z };
    let made = points(&both, &filling, APART, 1);
    assert_eq!(made.left, Left::default());
    let is_within = |point: &Point| {
        let place = place(*point);
        place.length().min((place - DVec3::X * 3.0).length()) < 2.9
    };
    let within = made.others.iter().filter(|point| is_within(point)).count() as f64;
    // Two balls of 2.9 mm 3 mm apart share a lens of pi (4 r + d) (2 r - d)² / 12 = 29.97 mm³, which is filled once.
    let volume = 2.0 * 4.0 / 3.0 * std::f64::consts::PI * 2.9f64.powi(3) - 29.97;
    let expected = volume / (0.027 * 0.75f64.sqrt());
    assert!((within / expected - 1.0).abs() < 0.02, "{within} {expected}");
}
