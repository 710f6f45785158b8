//! Clouds of more points than a slab holds: what is found does not stop at the borders of slabs. Expected values are counted by hand.

use toolpost_glass::cloud::{Point, distances};
use toolpost_glass::control::read;
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::post::write;
use toolpost_glass::proof::{Task, prove};
use toolpost_glass::weld::welded;

/// A lattice of so many points along each axis, `pitch` µm apart, from 5 mm on; from below.
fn lattice(count: i32, pitch: i32) -> Vec<Point> {
    let at = move |i: i32| 5_000 + pitch * i;
    let row = move |z: i32, y: i32| (0..count).map(move |x| [at(x), at(y), at(z)]);
    (0..count).flat_map(|z| (0..count).flat_map(move |y| row(z, y))).collect()
}

#[test]
fn pairs_of_points_in_two_slabs_are_counted_once() {
    // 103³ = 1,092,727 points; 3 x 103² x 102 pairs are 150 µm apart, and every point has such a neighbour.
    let points = lattice(103, 150);
    let found = distances(&points, 151);
    assert_eq!((found.too_close, found.crowded), (3 * 103 * 103 * 102, 103 * 103 * 103));
    assert_eq!(found.nearest.unwrap().distance, 0.15);
    assert_eq!(distances(&points, 150).too_close, 0);
}

#[test]
fn points_that_are_kept_in_one_slab_weld_those_of_the_next() {
    // Every point once more, 100 µm higher. The first 1,048,576 points end within the 156th layer, of 82² points each: one of those
    // that are to be left out, 100 µm above what is kept in the slab before.
    let points = lattice(82, 300);
    let higher = points.iter().map(|[x, y, z]| [*x, *y, z + 100]);
    let all: Vec<Point> = points.iter().copied().chain(higher).collect();
    let kept = welded(&all, 130);
    assert_eq!(kept, points);
}

#[test]
fn points_at_one_place_are_welded_in_no_time() {
    assert_eq!(welded(&vec![[1, 2, 3]; 2_000_000], 130), [[1, 2, 3]]);
}

#[test]
fn a_point_in_another_slab_shadows_and_is_missed_all_the_same() {
    let text = library("glass-planar-200hz").unwrap();
    let machine = Machine::read(text, "").unwrap();
    let cloud = lattice(103, 150);
    let block = [25.0, 25.0, 30.0];
    let task = Task {
        cloud: &cloud,
        machine: &machine,
        lens: machine.lens(70.0).unwrap(),
        index: 1.5195,
        block,
        blocks: 1,
        spacing: 0.14,
        accept_shadowed: false,
    };
    // Snell's law at f = 70 mm, by hand: 0.657873 mm of drive for each mm of depth.
    let drive = |[x, y, z]: Point| [x, y, ((f64::from(z) - 30_000.0) * 0.657_873).round() as i32];
    let judged = |order: &[usize]| {
        let axes: Vec<Point> = order.iter().map(|&i| drive(cloud[i])).collect();
        let run = read(&write(&axes, &[], &[], &machine, (block, 1)), &machine).unwrap();
        let (proof, found) = prove(&run, &task).unwrap();
        (proof, found.iter().map(|found| found.rule.name()).collect::<Vec<_>>())
    };
    let mut order: Vec<usize> = (0..cloud.len()).collect();
    let (proof, found) = judged(&order);
    assert_eq!((proof.shadowed, proof.pulses, found.len()), (0, 1_092_727, 0));

    // The last point first: it shadows all lower ones in its cone; nothing is shadowed by the first point, which comes last, but
    // the points above it shadow that one.
    order.swap(0, cloud.len() - 1);
    let top = cloud[cloud.len() - 1];
    let hidden = |point: &&Point| {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(top[axis] - point[axis]) * 1e-3);
        // The half angle of 1.3453° in the glass: tan of asin(sin(atan(2.5 / 70)) / 1.5195).
        z > 0.0 && x.hypot(y) < 0.0675 + 0.023_495 * z
    };
    let count = cloud[1..].iter().filter(hidden).count() as u64;
    let (proof, found) = judged(&order);
    assert_eq!((proof.shadowed, found), (count + 1, vec!["shadowed"]));

    order.pop();
    assert_eq!(judged(&order).1, ["lost", "shadowed"]);
}
