//! The rotary positions of whole operations.

use crate::common::{axis, machine, prefer, table_ac, within};
use geom::{Vec3, angle_between, rotate};
use proptest::prelude::*;
use toolpost_machine::plan::{Plan, Target, TargetKind, plan};
use toolpost_machine::{Machine, Mount};

fn feed(axis: Vec3) -> Target {
    Target { axis, line: 0, kind: TargetKind::Feed }
}

fn rapid(axis: Vec3) -> Target {
    Target { kind: TargetKind::Rapid, ..feed(axis) }
}

/// A tool axis `polar` degrees off +Z, towards `azimuth` degrees from +X.
fn leaning(polar: f64, azimuth: f64) -> Vec3 {
    let out = rotate(Vec3::X, Vec3::Z, azimuth.to_radians());
    Vec3::Z * polar.to_radians().cos() + out * polar.to_radians().sin()
}

fn degrees(plan: &Plan) -> Vec<[f64; 3]> {
    plan.iter().map(|step| step.degrees).collect()
}

fn assert_near(found: [f64; 3], wanted: [f64; 3]) {
    let near = found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(near, "{found:?}, not {wanted:?}");
}

/// A trunnion whose table turns once in each direction.
fn limited_ac() -> Machine {
    machine(vec![
        prefer(1.0, within(-30.0, 120.0, axis('A', Mount::Table, Vec3::X, 1.0))),
        within(-360.0, 360.0, axis('C', Mount::Table, Vec3::Z, -1.0)),
    ])
}

#[test]
fn an_unlimited_axis_winds_on_through_two_turns_and_back() {
    let there = (0..=24).map(|i| leaning(30.0, f64::from(i) * -30.0));
    let path: Vec<_> = there.clone().chain(there.rev()).map(feed).collect();
    let found = degrees(&plan(&table_ac(), None, path).unwrap());
    for pair in found.windows(2) {
        assert!((pair[1][2] - pair[0][2]).abs() < 31.0, "{pair:?}");
    }
    assert!((found[24][2] - found[0][2]).abs() > 719.0);
    assert_near(found[49], found[0]);
}

#[test]
fn the_preferred_solution_is_taken_where_both_travel_alike() {
    let path = [leaning(20.0, 90.0), leaning(30.0, 90.0)].map(feed);
    assert_near(degrees(&plan(&table_ac(), None, path).unwrap())[1], [30.0, 0.0, 0.0]);
    let mut other = table_ac();
    other.rotary[0].prefer = -1.0;
    assert_near(degrees(&plan(&other, None, path).unwrap())[1], [-30.0, 0.0, 180.0]);
}

#[test]
fn a_limit_that_comes_late_decides_the_solution_at_the_start() {
    // Until 30° both solutions will do and the other one is preferred; then only A positive does.
    let mut machine = limited_ac();
    machine.rotary[0].prefer = -1.0;
    let path = (1..=9).map(|i| feed(leaning(f64::from(i) * 10.0, 90.0)));
    let plan = plan(&machine, None, path).unwrap();
    assert!(plan.rewinds.is_empty());
    for (i, found) in degrees(&plan).into_iter().enumerate() {
        assert_near(found, [10.0 * (i + 1) as f64, 0.0, 0.0]);
    }
}

#[test]
fn a_turn_and_three_quarters_starts_where_the_travel_lets_it_end() {
    // C goes from 0° on by 630°, within −360° to 360°: it must start at −360° or −270°.
    let path: Vec<_> = (0..=63).map(|i| feed(leaning(60.0, 90.0 + f64::from(i) * 10.0))).collect();
    let plan =
        plan(&limited_ac(), Some([0.0; 3]), [rapid(Vec3::Z)].into_iter().chain(path)).unwrap();
    assert!(plan.rewinds.is_empty());
    let found = degrees(&plan);
    assert!(found.iter().all(|d| d[2].abs() <= 360.0));
    assert!(found.windows(2).skip(1).all(|pair| (pair[1][2] - pair[0][2]).abs() < 11.0));
}

#[test]
fn where_the_travel_ends_the_tool_turns_back_and_comes_in_again() {
    // Three turns do not fit in two: the one rewind is as late as it can be.
    let path: Vec<_> = (0..=108)
        .map(|i| Target { line: i + 1, ..feed(leaning(60.0, 90.0 - f64::from(i) * 10.0)) })
        .collect();
    let machine = limited_ac();
    let plan = plan(&machine, None, path.clone()).unwrap();
    let [rewind] = plan.rewinds[..] else { panic!("{:?}", plan.rewinds) };
    assert_eq!((rewind.index, rewind.line), (73, 74));
    assert_eq!(rewind.warning().line, 74);
    let mut last: Option<[f64; 3]> = None;
    for (i, (step, target)) in plan.iter().zip(&path).enumerate() {
        assert!(angle_between(machine.axis_at(step.degrees), target.axis) < 1e-7);
        assert!(step.degrees[2].abs() <= 360.0);
        assert_eq!(step.rewind.is_some(), i == 73);
        if let Some(again) = step.rewind {
            // The tool comes in where it went out, the table turned back.
            let left = path[i - 1].axis;
            assert!(angle_between(machine.axis_at(again), left) < 1e-7);
            assert!((last.unwrap()[2] - again[2]).abs() >= 359.0);
            last = Some(again);
        }
        if let Some(last) = last {
            assert!((step.degrees[2] - last[2]).abs() < 11.0);
        }
        last = Some(step.degrees);
    }
}

#[test]
fn the_tool_never_swings_to_the_other_solution_in_the_cut() {
    // C ends at 100°, where the other solution goes on at −80°, but at 60° the tool would swing over.
    let machine = machine(vec![
        within(-120.0, 120.0, axis('A', Mount::Table, Vec3::X, 1.0)),
        within(-100.0, 100.0, axis('C', Mount::Table, Vec3::Z, -1.0)),
    ]);
    for (polar, rewinds) in [(60.0, 1), (0.4, 0)] {
        let once: Vec<_> =
            (0..=14).map(|i| feed(leaning(polar, 90.0 - f64::from(i) * 10.0))).collect();
        let twice: Vec<_> = once.iter().flat_map(|t| [*t, *t]).collect();
        for path in [once, twice] {
            assert_eq!(plan(&machine, None, path).unwrap().rewinds.len(), rewinds);
        }
    }
}

#[test]
fn a_rapid_turns_back_without_a_rewind() {
    let turn = |i: u32| leaning(60.0, 90.0 - f64::from(i) * 10.0);
    let mut path: Vec<_> = (0..=108).map(|i| feed(turn(i))).collect();
    path.insert(50, rapid(turn(49)));
    let plan = plan(&limited_ac(), None, path).unwrap();
    assert!(plan.rewinds.is_empty());
    assert!(plan.iter().all(|step| step.degrees[2].abs() <= 360.0));
}

#[test]
fn a_singular_pose_holds_the_free_axis() {
    let path = [leaning(20.0, 0.0), leaning(10.0, 0.0), Vec3::Z, Vec3::Z].map(feed);
    let found = degrees(&plan(&table_ac(), None, path).unwrap());
    assert_near(found[3], [0.0, 0.0, found[0][2]]);
    // Nothing but singular poses: it stays where it was.
    let found = degrees(&plan(&table_ac(), Some([5.0, 0.0, 77.0]), [rapid(Vec3::Z)]).unwrap());
    assert_near(found[0], [0.0, 0.0, 77.0]);
}

#[test]
fn the_free_axis_turns_in_the_last_rapid_before_it_is_needed() {
    let path = [rapid(Vec3::Z), rapid(Vec3::Z), feed(Vec3::Z), feed(leaning(10.0, 0.0))];
    let found = degrees(&plan(&table_ac(), Some([0.0, 0.0, 5.0]), path).unwrap());
    assert_near(found[0], [0.0, 0.0, 5.0]);
    assert_near(found[1], [0.0, 0.0, -90.0]);
    assert_near(found[2], [0.0, 0.0, -90.0]);
    assert_near(found[3], [10.0, 0.0, -90.0]);
}

#[test]
fn without_a_rapid_the_free_axis_turns_while_the_tool_stands_upright() {
    let path = [rapid(leaning(20.0, 90.0)), feed(Vec3::Z), feed(Vec3::Z), feed(leaning(60.0, 0.0))];
    let found = degrees(&plan(&limited_ac(), None, path).unwrap());
    assert_near(found[1], [0.0, 0.0, 0.0]);
    assert_near(found[2], [0.0, 0.0, -90.0]);
    assert_near(found[3], [60.0, 0.0, -90.0]);
}

#[test]
fn through_the_pole_the_table_does_not_turn() {
    let path = (-5..=5).map(|i| feed(leaning(f64::from(i) * 2.0, 90.0)));
    let found = degrees(&plan(&table_ac(), None, path).unwrap());
    assert!(found.windows(2).all(|pair| (pair[1][2] - pair[0][2]).abs() < 1e-5), "{found:?}");
}

#[test]
fn an_orientation_out_of_travel_is_refused_with_its_line_and_both_solutions() {
    let path =
        [Target { line: 7, ..feed(Vec3::Y) }, Target { line: 8, ..feed(leaning(130.0, 90.0)) }];
    let refused = plan(&limited_ac(), None, path).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("axis-limit", 8));
    assert!(refused.message.contains("A 130.000 C 0.000"), "{}", refused.message);
    assert!(refused.message.contains("A -130.000 C 180.000"), "{}", refused.message);
    let fixed = machine(Vec::new());
    let refused = plan(&fixed, None, [Target { line: 3, ..feed(Vec3::Y) }]).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("unreachable-orientation", 3));
    assert!(plan(&fixed, None, [feed(Vec3::Z)]).is_ok());
}

#[test]
fn a_tool_axis_that_turns_during_an_arc_is_refused() {
    let arc = Target { kind: TargetKind::Arc, line: 4, ..feed(Vec3::Y) };
    let refused = plan(&table_ac(), None, [feed(Vec3::Z), arc]).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("arc-orientation", 4));
}

/// A tool axis that wanders by up to a few degrees a step, now and then, where it is near, along Z, or by rapid.
fn any_path() -> impl Strategy<Value = Vec<Target>> {
    let step = (-1.5..1.5f64, -10.0..10.0f64, 0..20u8);
    (0.0..50.0f64, prop::collection::vec(step, 1..200)).prop_map(|(polar, steps)| {
        let (mut polar, mut azimuth) = (polar, 0.0);
        steps
            .into_iter()
            .map(|(p, a, dice)| {
                polar = (polar + p).clamp(0.0, 60.0);
                azimuth += a;
                if dice < 5 && polar < 1.5 {
                    polar = 0.0;
                }
                let v = if polar == 0.0 { Vec3::Z } else { leaning(polar, azimuth) };
                if dice == 1 { rapid(v) } else { feed(v) }
            })
            .enumerate()
            // The turn to the first is a long one.
            .map(|(i, target)| if i == 0 { rapid(target.axis) } else { target })
            .collect()
    })
}

fn any_travel() -> impl Strategy<Value = (f64, f64)> {
    prop_oneof![
        Just((f64::NEG_INFINITY, f64::INFINITY)),
        Just((-360.0, 360.0)),
        Just((-180.0, 180.0)),
        (-1000.0..-180.0f64, 180.0..1000.0f64),
    ]
}

/// Two rotary axes as they are built, the second with the travel given.
fn any_machine() -> impl Strategy<Value = Machine> {
    let tilt = prop_oneof![Just((-120.0, 120.0)), Just((-5.0, 110.0)), Just((-200.0, 200.0))];
    let nutating = Vec3::new(0.0, 1.0, 1.0);
    (0..5usize, tilt, any_travel()).prop_map(move |(kind, tilt, turn)| {
        let tilting = |letter, on, direction, sign| {
            prefer(1.0, within(tilt.0, tilt.1, axis(letter, on, direction, sign)))
        };
        let turning = |on, sign| within(turn.0, turn.1, axis('C', on, Vec3::Z, sign));
        machine(match kind {
            0 => vec![tilting('A', Mount::Table, Vec3::X, 1.0), turning(Mount::Table, -1.0)],
            1 => vec![tilting('B', Mount::Table, nutating, 1.0), turning(Mount::Table, -1.0)],
            2 => vec![turning(Mount::Table, -1.0), tilting('B', Mount::Head, Vec3::Y, 1.0)],
            3 => vec![turning(Mount::Head, 1.0), tilting('A', Mount::Head, Vec3::X, 1.0)],
            _ => vec![turning(Mount::Head, 1.0), tilting('B', Mount::Head, nutating, -1.0)],
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_plan_leaves_the_travel_misses_the_axis_or_jumps_in_the_cut(
        path in any_path(),
        machine in any_machine(),
        start in prop::option::of((-5.0..100.0f64, -180.0..180.0f64)),
    ) {
        let start = start.map(|(tilt, turn)| {
            let mut degrees = [tilt, tilt, turn];
            // An axis that the machine lacks stands at 0.
            for (i, letter) in ['A', 'B', 'C'].into_iter().enumerate() {
                if machine.rotary.iter().all(|axis| axis.letter != letter) {
                    degrees[i] = 0.0;
                }
            }
            degrees
        });
        let planned = plan(&machine, start, path.clone());
        let Ok(plan) = planned else {
            // With a turn of travel on both axes there is always a sequence.
            let tight = machine.rotary.iter().any(|axis| axis.max - axis.min < 400.0);
            prop_assert!(tight, "{}", planned.unwrap_err());
            return Ok(());
        };
        prop_assert_eq!(plan.len(), path.len());
        let mut last = start;
        for (step, target) in plan.iter().zip(&path) {
            let off = angle_between(machine.axis_at(step.degrees), target.axis);
            prop_assert!(off < 2e-6, "off by {}", off);
            for axis in &machine.rotary {
                let d = step.degrees[axis.index()];
                prop_assert!(axis.min <= d && d <= axis.max);
            }
            if let (Some(again), Some(last)) = (step.rewind, last) {
                let moved = angle_between(machine.axis_at(again), machine.axis_at(last));
                prop_assert!(moved < 2e-6, "the tool comes in again turned by {}", moved);
            }
            let from = step.rewind.or(last);
            if let (Some(from), TargetKind::Feed) = (from, target.kind) {
                for (a, b) in from.iter().zip(step.degrees) {
                    prop_assert!((b - a).abs() <= 180.001, "{:?} to {:?}", from, step.degrees);
                }
                let axes = [from, step.degrees].map(|degrees| machine.axis_at(degrees));
                let swing = machine.swing([from, step.degrees], axes).to_degrees();
                prop_assert!(swing <= 1.0, "{}° from {:?} to {:?}", swing, from, step.degrees);
            }
            last = Some(step.degrees);
        }
    }
}
