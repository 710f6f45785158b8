//! Points on surfaces: the minimum distance holds exactly, gaps are bounded, threads change nothing.

use crate::bodies::{sphere, torus};
use glam::DVec3;
use toolpost_glass::cloud::{Grid, distances, squared};
use toolpost_glass::mesh::Mesh;
use toolpost_glass::sample::{Apart, LARGEST_GAP, surface};

fn apart(spacing: u32) -> Apart {
    Apart { spacing, lost: 0.0 }
}

#[test]
fn heights_may_come_nearer_by_what_rounding_takes_and_no_two_points_do() {
    // Upright walls, on which neighbours lie above each other; 2 µm of each height are lost.
    let mesh = sphere(2.0, 60);
    let points = surface(&mesh, Apart { spacing: 90, lost: 2.0 }, 1);
    let squeezed = |a: &[i32; 3], b: &[i32; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| i64::from((a[axis] - b[axis]).abs()));
        x * x + y * y + (z - 2).max(0).pow(2)
    };
    let pairs =
        points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| (a, b)));
    assert!(pairs.map(|(a, b)| squeezed(a, b)).min().unwrap() >= 90 * 90);
    // It costs less than 3 points of 100.
    assert!(points.len() * 100 > surface(&mesh, apart(90), 1).len() * 97);
}

#[test]
fn no_two_points_of_a_sampled_surface_are_nearer_than_the_spacing() {
    // At the end of the space that points have, and so far apart that their squares have no place in 24 bits.
    let mut far = sphere(300.0, 60);
    far.vertices.iter_mut().for_each(|vertex| *vertex += DVec3::new(1699.0, -1699.0, 1699.0));
    let bodies =
        [(sphere(3.0, 60), 90), (torus(3.0, 1.0, 40), 130), (sphere(1.0, 4), 90), (far, 9001)];
    for (mesh, spacing) in bodies {
        let points = surface(&mesh, apart(spacing), 1);
        let found = distances(&points, i64::from(spacing));
        assert_eq!((found.too_close, found.crowded), (0, 0));
        // The saturated random packing has 0.6966 points in a square of the spacing; curved surfaces hold a few more.
        let density = points.len() as f64 * (f64::from(spacing) * 1e-3).powi(2) / mesh.area();
        assert!((0.65..0.75).contains(&density), "{density}");
        // Every pair once more, without the grid.
        let pairs = points
            .iter()
            .enumerate()
            .flat_map(|(i, a)| points[..i].iter().map(move |b| squared(*a, *b)));
        let nearest = (pairs.min().unwrap() as f64).sqrt() * 1e-3;
        assert_eq!(found.nearest.unwrap().distance, nearest);
    }
}

#[test]
fn no_place_of_the_surface_is_farther_from_a_point_than_1_3_spacings() {
    let spacing = 130u32;
    // Triangles smaller than a spacing, and faces that are much larger.
    for mesh in [sphere(2.0, 100), sphere(2.0, 3)] {
        let points = surface(&mesh, apart(spacing), 7);
        let mut worst = 0.0f64;
        for triangle in 0..mesh.triangles.len() as u32 {
            let [a, b, c] = mesh.corners(triangle).map(|corner| corner * 1e3);
            let parts = (a.distance(b).max(a.distance(c)) / 40.0).ceil().clamp(1.0, 30.0) as u32;
            for i in 0..=parts {
                for j in 0..=parts - i {
                    let (u, v) = (f64::from(i) / f64::from(parts), f64::from(j) / f64::from(parts));
                    let place = a + (b - a) * u + (c - a) * v;
                    let gap =
                        |p: &[i32; 3]| DVec3::from_array(p.map(f64::from)).distance_squared(place);
                    worst = worst.max(points.iter().map(gap).fold(f64::MAX, f64::min).sqrt());
                }
            }
        }
        let worst = worst / f64::from(spacing);
        assert!(worst <= LARGEST_GAP + 0.02 && LARGEST_GAP <= 1.3, "{worst}");
        assert!(worst > 0.8, "{worst}");
    }
}

#[test]
fn the_points_are_the_same_on_one_thread_and_on_four() {
    let mesh = torus(3.0, 1.0, 40);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| surface(&mesh, apart(90), 3))
    };
    assert_eq!(on(1), on(4));
    assert_ne!(on(1), surface(&mesh, apart(90), 4));
}

#[test]
fn the_nearest_pair_of_a_cloud_is_named_and_the_pairs_that_are_too_close_are_counted() {
    let cloud = [[0, 0, 0], [0, 0, 130], [500, 0, 0], [500, 129, 0], [600, 129, 0]];
    let found = distances(&cloud, 130);
    assert_eq!((found.too_close, found.crowded), (2, 3));
    let nearest = found.nearest.unwrap();
    assert_eq!((nearest.points, nearest.distance), ([3, 4], 0.1));
    assert_eq!(distances(&cloud[..1], 130).nearest, None);
    assert_eq!(distances(&[], 130).too_close, 0);
    // Equal points.
    assert_eq!(distances(&[[7; 3], [7; 3]], 1).too_close, 1);
}

#[test]
fn a_mesh_without_area_or_without_triangles_gives_no_endless_work() {
    assert!(surface(&Mesh::default(), apart(90), 1).is_empty());
    let line = Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let points = surface(&line, apart(90), 1);
    assert_eq!(distances(&points, 90).too_close, 0);
}

#[test]
fn heights_that_lose_four_times_the_spacing_keep_what_is_left() {
    // Sheets of 125 x 125 µm, 1 µm apart, at a spacing of 1 µm and in glass of index 4: points above each other are 5 µm apart.
    let side = 0.125;
    let corners = |z: f64| {
        [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(x, y)| DVec3::new(x, y, z))
    };
    let vertices = (0..125).flat_map(|sheet| corners(f64::from(sheet) * 1e-3)).collect();
    let faces = |sheet: u32| [[0, 1, 2], [0, 2, 3]].map(|face| face.map(|i| 4 * sheet + i));
    let mesh = Mesh { vertices, triangles: (0..125).flat_map(faces).collect(), ..Mesh::default() };
    let mut points = surface(&mesh, Apart { spacing: 1, lost: 4.0 }, 1);
    assert!(points.len() > 50_000, "{}", points.len());
    points.sort_unstable();
    let close = |pair: &&[[i32; 3]]| {
        let [[x, y, low], [a, b, high]] = [pair[0], pair[1]];
        (x, y) == (a, b) && high - low < 5
    };
    assert_eq!(points.windows(2).filter(close).count(), 0);
}

#[test]
fn the_points_near_a_place_are_found_where_cubes_are_many_and_where_they_are_few() {
    let mut state = 7u64;
    let mut any = |below: u64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 33) % below) as i32
    };
    // 64 cubes of 100 µm for 800 points, and 1,000,000.
    for size in [400, 10_000] {
        let points: Vec<[i32; 3]> =
            (0..800).map(|_| [any(size), any(size) - 77, any(size) - 5_000]).collect();
        let grid = Grid::new(&points, 100);
        for here in points.iter().map(|[x, y, z]| [x + 30, y - 150, z + 99]) {
            let is_near =
                |i: &u32| (0..3).all(|axis| (points[*i as usize][axis] - here[axis]).abs() <= 100);
            let mut found: Vec<u32> = grid.near(here).filter(is_near).collect();
            found.sort_unstable();
            let all: Vec<u32> = (0..800).filter(is_near).collect();
            assert_eq!(found, all, "{size} {here:?}");
        }
    }
}
