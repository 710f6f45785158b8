//! Inverse kinematics against the forward ones, and against angles known from elsewhere.

use crate::common::{axis, machine, prefer, table_ac};
use geom::{Vec3, angle_between};
use proptest::prelude::*;
use toolpost_machine::{Machine, Mount, RotaryAxis};

/// Both solutions lie in (−180, 180] and bring the tool along `v`.
fn assert_solved(machine: &Machine, v: Vec3) {
    let solutions = machine.inverse(v).unwrap();
    for degrees in solutions.degrees {
        let off = angle_between(machine.axis_at(degrees), v);
        assert!(off < 1e-7, "{degrees:?} is off by {off}");
        assert!(degrees.iter().all(|d| *d > -180.0 && *d <= 180.0), "{degrees:?}");
    }
}

#[test]
fn the_angle_table_of_the_specification_holds() {
    let half = 0.5f64.sqrt();
    let table = [
        (Vec3::Z, 0.0, 0.0),
        (Vec3::Y, 90.0, 0.0),
        (Vec3::X, 90.0, -90.0),
        (Vec3::NEG_Y, 90.0, 180.0),
        (Vec3::NEG_X, 90.0, 90.0),
        (Vec3::new(0.5, 0.5, half), 45.0, -45.0),
        (Vec3::NEG_Z, 180.0, 0.0),
    ];
    for (v, a, c) in table {
        let [found, _] = table_ac().inverse(v).unwrap().degrees;
        assert!((found[0] - a).abs() < 1e-6 && (found[2] - c).abs() < 1e-6, "{v}: {found:?}");
    }
}

#[test]
fn minus_180_is_never_given_also_not_by_rounding() {
    for x in [-1e-10, 0.0, 1e-10] {
        let v = Vec3::new(x, -1.0, 0.0).normalize();
        let [found, _] = table_ac().inverse(v).unwrap().degrees;
        assert!((found[2] - 180.0).abs() < 1e-6, "{found:?}");
    }
}

#[test]
fn along_the_axis_nearest_to_the_part_that_axis_is_free() {
    assert_eq!(table_ac().inverse(Vec3::Z).unwrap().free, Some(2));
    assert_eq!(table_ac().inverse(Vec3::Y).unwrap().free, None);
    // A head C that carries a head A: the tool along Z leaves C free, too.
    let fork =
        machine(vec![axis('C', Mount::Head, Vec3::Z, 1.0), axis('A', Mount::Head, Vec3::X, 1.0)]);
    assert_eq!(fork.inverse(Vec3::Z).unwrap().free, Some(2));
}

#[test]
fn a_tilting_head_leans_the_tool_the_way_iso_841_counts() {
    // Head A right-handed about X: at A = 30° the tool leans from +Z towards −Y.
    let head = machine(vec![axis('A', Mount::Head, Vec3::X, 1.0)]);
    let v = Vec3::new(0.0, -0.5, 0.75f64.sqrt());
    let [found, other] = head.inverse(v).unwrap().degrees;
    assert!((found[0] - 30.0).abs() < 1e-6, "{found:?}");
    assert_eq!(found, other);
}

#[test]
fn a_nutating_head_lies_down_by_half_a_turn_of_its_45_degree_axis() {
    // B about (0, 1, 1): half a turn carries Z to Y; C then turns that to where it is wanted.
    let nutating = machine(vec![
        axis('C', Mount::Table, Vec3::Z, 1.0),
        axis('B', Mount::Head, Vec3::new(0.0, 1.0, 1.0), 1.0),
    ]);
    let [found, _] = nutating.inverse(Vec3::Y).unwrap().degrees;
    assert!((found[1].abs() - 180.0).abs() < 1e-3 && found[2].abs() < 1e-3, "{found:?}");
    // No tool of it points upwards from below.
    let below = Vec3::new(0.0, 1.0, -1.0).normalize();
    let deviation = nutating.inverse(below).unwrap_err().deviation.to_degrees();
    assert!((deviation - 45.0).abs() < 1e-9, "{deviation}");
}

#[test]
fn an_unreachable_orientation_names_the_nearest_one() {
    let three = machine(Vec::new());
    assert!(three.inverse(Vec3::Z).is_ok());
    let lean = Vec3::new(0.0, 0.6, 0.8);
    let deviation = three.inverse(lean).unwrap_err().deviation;
    assert!((deviation - 0.6f64.asin()).abs() < 1e-12);
    // One axis about X cannot lean towards X.
    let four = machine(vec![axis('A', Mount::Table, Vec3::X, 1.0)]);
    assert!(four.inverse(lean).is_ok());
    let deviation = four.inverse(Vec3::new(0.6, 0.0, 0.8)).unwrap_err().deviation;
    assert!((deviation - 0.6f64.asin()).abs() < 1e-12);
}

#[test]
fn an_axis_that_cannot_turn_the_tool_stays_where_it_is() {
    // A spindle that turns about itself, on a head that leans.
    let odd =
        machine(vec![axis('A', Mount::Head, Vec3::X, 1.0), axis('C', Mount::Head, Vec3::Z, 1.0)]);
    assert_solved(&odd, Vec3::new(0.0, 0.6, 0.8));
    assert!(odd.inverse(Vec3::X).is_err());
}

fn any_direction() -> impl Strategy<Value = Vec3> {
    (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64)
        .prop_map(|(x, y, z)| Vec3::new(x, y, z))
        .prop_filter_map("short", |v| (v.length() > 0.1).then(|| v.normalize()))
}

/// Axes as they are built (along X, Y, Z, at 45°), and any other.
fn any_axis_direction() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        Just(Vec3::X),
        Just(Vec3::Y),
        Just(Vec3::Z),
        Just(Vec3::new(0.0, 1.0, 1.0).normalize()),
        Just(Vec3::new(1.0, 0.0, -1.0).normalize()),
        any_direction(),
    ]
}

fn any_rotary(letter: char) -> impl Strategy<Value = RotaryAxis> {
    (any_axis_direction(), any::<bool>(), any::<bool>(), -180.0..180.0f64, any_direction())
        .prop_map(move |(direction, head, positive, offset, point)| RotaryAxis {
            offset,
            point: point * 200.0,
            is_placed: true,
            ..prefer(
                1.0,
                axis(
                    letter,
                    if head { Mount::Head } else { Mount::Table },
                    direction,
                    if positive { 1.0 } else { -1.0 },
                ),
            )
        })
}

fn any_machine() -> impl Strategy<Value = Machine> {
    prop_oneof![
        any_rotary('A').prop_map(|a| machine(vec![a])),
        (any_rotary('B'), any_rotary('C')).prop_map(|(b, c)| machine(vec![b, c])),
        (any_rotary('C'), any_rotary('A')).prop_map(|(c, a)| machine(vec![c, a])),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn every_axis_that_positions_give_is_solved_by_both_solutions(
        machine in any_machine(),
        degrees in [-180.0..180.0f64, -180.0..180.0, -180.0..180.0],
    ) {
        let v = machine.axis_at(degrees);
        let solutions = machine.inverse(v).unwrap();
        for found in solutions.degrees {
            let off = angle_between(machine.axis_at(found), v);
            // Near the edge of what two axes reach, an axis is as good as the nearest one in reach.
            prop_assert!(off < 2e-6, "{:?} is off by {}", found, off);
            prop_assert!(found.iter().all(|d| *d > -180.0 && *d <= 180.0));
        }
    }

    #[test]
    fn orthogonal_axes_reach_every_direction(
        v in any_direction(),
        head in [any::<bool>(), any::<bool>()],
    ) {
        let mount = |head| if head { Mount::Head } else { Mount::Table };
        let tilt = axis('B', mount(head[0]), Vec3::Y, 1.0);
        let turn = axis('C', mount(head[1]), Vec3::Z, -1.0);
        // The axis nearest to the part turns about Z: on a table it comes last, on a head first.
        let rotary = if head == [true, true] { vec![turn, tilt] } else { vec![tilt, turn] };
        let machine = machine(rotary);
        // A head that turns about Z carried by a tilting table cannot turn the tool axis.
        if head != [false, true] {
            assert_solved(&machine, v);
        }
    }

    #[test]
    fn what_is_out_of_reach_is_so_by_the_angle_named(machine in any_machine(), v in any_direction()) {
        if let Err(unreachable) = machine.inverse(v) {
            // No position of a grid comes nearer.
            for i in 0..36 {
                for j in 0..36 {
                    let (a, b) = (f64::from(i) * 10.0, f64::from(j) * 10.0);
                    let degrees = [a, a, b];
                    let off = angle_between(machine.axis_at(degrees), v);
                    prop_assert!(off >= unreachable.deviation - 1e-9);
                }
            }
        }
    }
}
