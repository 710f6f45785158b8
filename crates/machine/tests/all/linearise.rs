//! The tip of a linearised line, followed through the forward kinematics.

use crate::common::{axis, machine, table_ac};
use geom::{Vec3, nearest_on_segment};
use proptest::prelude::*;
use toolpost_machine::linearise::RotaryPose;
use toolpost_machine::{Machine, Mount, RotaryAxis};

/// How far the tip leaves the line from `a` to `b` while all axes go straight through the points.
fn largest_deviation(
    machine: &Machine,
    a: RotaryPose,
    b: RotaryPose,
    length: f64,
    points: &[RotaryPose],
) -> f64 {
    let axes = |s: &RotaryPose| (machine.linear_for(s.tip, s.degrees, length), s.degrees);
    let mut worst: f64 = 0.0;
    let mut last = axes(&a);
    for point in points {
        let next = axes(point);
        for i in 0..=16 {
            let part = f64::from(i) / 16.0;
            let degrees = [0, 1, 2].map(|k| last.1[k] + (next.1[k] - last.1[k]) * part);
            let (tip, _) = machine.forward(last.0.lerp(next.0, part), degrees, length);
            worst = worst.max(nearest_on_segment(a.tip, b.tip, tip).1);
        }
        last = next;
    }
    worst
}

#[test]
fn a_line_without_turning_needs_no_point() {
    let from = RotaryPose { tip: Vec3::ZERO, degrees: [30.0, 0.0, 40.0] };
    let to = RotaryPose { tip: Vec3::X * 500.0, ..from };
    let points: Vec<_> = table_ac().linearise(from, to, Some(100.0), 1e-6).unwrap().collect();
    assert_eq!(points, [to]);
}

#[test]
fn turning_about_a_tip_at_rest_takes_the_chords_of_its_circle() {
    // The table turns by 90° under a tip 100 mm out: chords of an arc of that radius.
    let from = RotaryPose { tip: Vec3::X * 100.0, degrees: [0.0; 3] };
    let to = RotaryPose { degrees: [0.0, 0.0, 90.0], ..from };
    let count = table_ac().linearise(from, to, Some(0.0), 0.01).unwrap().len();
    let step = 2.0 * (1.0 - 0.01 / 100.0f64).acos().to_degrees();
    assert_eq!(count, (90.0 / step).ceil() as usize);
}

#[test]
fn a_line_without_end_is_refused() {
    let from = RotaryPose { tip: Vec3::X * 1e6, degrees: [0.0; 3] };
    let to = RotaryPose { degrees: [0.0, 0.0, 170.0], ..from };
    let refusal =
        |to: RotaryPose, tolerance: f64| match table_ac().linearise(from, to, Some(0.0), tolerance)
        {
            Ok(points) => panic!("{} points", points.len()),
            Err(refused) => refused.rule,
        };
    assert_eq!(refusal(to, 1e-9), "linearisation");
    assert_eq!(refusal(to, 0.0), "linearisation");
    assert_eq!(refusal(to, -1.0), "linearisation");
    assert_eq!(refusal(RotaryPose { tip: Vec3::NAN, ..to }, 0.01), "linearisation");
    assert_eq!(refusal(RotaryPose { degrees: [f64::NAN; 3], ..to }, 0.01), "linearisation");
}

fn any_vector(size: f64) -> impl Strategy<Value = Vec3> {
    [-size..size, -size..size, -size..size].prop_map(Vec3::from)
}

fn any_rotary(letter: char) -> impl Strategy<Value = RotaryAxis> {
    let direction = any_vector(1.0).prop_filter("short", |v| v.length() > 0.1);
    (direction, any_vector(200.0), any::<bool>(), any::<bool>()).prop_map(
        move |(direction, point, head, positive)| RotaryAxis {
            point,
            is_placed: true,
            ..axis(
                letter,
                if head { Mount::Head } else { Mount::Table },
                direction,
                if positive { 1.0 } else { -1.0 },
            )
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn the_tip_stays_within_the_tolerance_on_every_machine(
        rotary in prop_oneof![
            any_rotary('B').prop_map(|b| vec![b]),
            (any_rotary('A'), any_rotary('C')).prop_map(|(a, c)| vec![a, c]),
        ],
        ends in [any_vector(150.0), any_vector(150.0)],
        from in [-180.0..180.0f64, -180.0..180.0, -180.0..180.0],
        turn in [-60.0..60.0f64, -60.0..60.0, -60.0..60.0],
        zero in any_vector(300.0),
        length in 0.0..200.0f64,
        tolerance in prop_oneof![Just(0.1), Just(0.005)],
    ) {
        let machine = Machine { work_zero: Some(zero), ..machine(rotary) };
        let a = RotaryPose { tip: ends[0], degrees: from };
        let b = RotaryPose { tip: ends[1], degrees: [0, 1, 2].map(|k| from[k] + turn[k]) };
        let points: Vec<_> = machine.linearise(a, b, Some(length), tolerance).unwrap().collect();
        prop_assert_eq!(points.last(), Some(&b));
        let worst = largest_deviation(&machine, a, b, length, &points);
        prop_assert!(worst <= tolerance, "{} mm with {} points", worst, points.len());
    }
}
