//! What a machine cannot do is refused with the axis, the amount and the line.

use crate::common::{axis, machine, within};
use geom::{Arc, Vec3};
use program::{Feed, Spindle, Tool};
use toolpost_machine::limits::{Limits, Travel};
use toolpost_machine::{Machine, Mount};

fn mill() -> Machine {
    machine(vec![within(-30.0, 120.0, axis('A', Mount::Table, Vec3::X, 1.0))])
}

#[test]
fn a_thousandth_beyond_the_travel_is_refused_with_axis_amount_and_line() {
    let mill = Machine { work_zero: Some(Vec3::new(100.0, 0.0, 0.0)), ..mill() };
    let mut limits = Limits::new(&mill);
    assert!(limits.position(Vec3::X * 400.0, [0.0; 3], Some(0.0), 1).is_ok());
    let refused = limits.position(Vec3::X * 400.001, [0.0; 3], Some(0.0), 17).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("axis-limit", 17));
    assert_eq!(refused.message, "X at 500.0010 mm is 0.0010 mm beyond its limit of 500 mm");
    let refused = limits.position(Vec3::Y * -500.25, [0.0; 3], Some(0.0), 18).unwrap_err();
    assert_eq!(refused.message, "Y at -500.2500 mm is 0.2500 mm beyond its limit of -500 mm");
}

#[test]
fn the_tool_lifts_the_spindle_by_its_length() {
    let mill = mill();
    let mut limits = Limits::new(&mill);
    assert!(limits.position(Vec3::Z * 400.0, [0.0; 3], Some(100.0), 1).is_ok());
    let refused = limits.position(Vec3::Z * 400.0, [0.0; 3], Some(100.5), 2).unwrap_err();
    assert!(refused.message.starts_with("Z at 500.5000 mm"), "{}", refused.message);
}

#[test]
fn without_a_work_zero_the_way_is_held_against_the_length_of_the_travel() {
    let mill = Machine { work_zero: None, ..mill() };
    let mut limits = Limits::new(&mill);
    assert!(limits.position(Vec3::X * 3000.0, [0.0; 3], Some(0.0), 4).is_ok());
    assert!(limits.position(Vec3::X * 2000.0, [0.0; 3], Some(0.0), 5).is_ok());
    assert_eq!(limits.ways().count(), 0);
    for (x, line, way) in [
        (1999.999, 6, "1999.9990 mm (line 6) to 3000.0000 mm (line 4): 0.0010 mm"),
        (2500.0, 7, "1999.9990 mm (line 6) to 3000.0000 mm (line 4): 0.0010 mm"),
        (1500.0, 8, "1500.0000 mm (line 8) to 3000.0000 mm (line 4): 500.0000 mm"),
        // From nowhere in a source.
        (1000.0, 0, "1000.0000 mm to 3000.0000 mm (line 4): 1000.0000 mm"),
    ] {
        assert!(limits.position(Vec3::X * x, [0.0; 3], Some(0.0), line).is_ok());
        let refused: Vec<_> = limits.ways().collect();
        assert_eq!(refused.len(), 1, "{refused:?}");
        // Where it went too far first.
        assert_eq!((refused[0].rule.name(), refused[0].line), ("axis-limit", 6));
        let message = format!("X moves from {way} more than its travel of 1000 mm");
        assert_eq!(refused[0].message, message);
    }
}

#[test]
fn a_rotary_axis_has_limits_too_and_an_unknown_position_breaks_none() {
    let mill = mill();
    let mut limits = Limits::new(&mill);
    assert!(limits.position(Vec3::NAN, [120.0, 0.0, 0.0], Some(0.0), 1).is_ok());
    let refused = limits.position(Vec3::ZERO, [-30.001, 0.0, 0.0], Some(0.0), 2).unwrap_err();
    assert_eq!(refused.message, "A at -30.0010° is 0.0010° beyond its limit of -30°");
}

#[test]
fn an_arc_may_bulge_over_a_limit_that_its_ends_keep() {
    let mill = mill();
    let half_round = |x: f64| {
        let (from, to) = (Vec3::new(x, -10.0, 0.0), Vec3::new(x, 10.0, 0.0));
        Arc::new(from, to, Vec3::new(x, 0.0, 0.0), Vec3::Z, 0, 1e-3).unwrap()
    };
    let mut limits = Limits::new(&mill);
    assert!(limits.arc(&half_round(490.0), [0.0; 3], Some(0.0), 1).is_ok());
    let refused = limits.arc(&half_round(490.001), [0.0; 3], Some(0.0), 2).unwrap_err();
    assert!(refused.message.starts_with("X at 500.0010 mm is 0.0010 mm"), "{}", refused.message);
}

#[test]
fn spindle_and_tool_have_ranges() {
    let mill = mill();
    let limits = Limits::new(&mill);
    assert!(limits.spindle(Spindle::Off, 1).is_ok());
    assert!(limits.spindle(Spindle::Clockwise(12_000.0), 1).is_ok());
    for speed in [12_000.5, 49.0, 0.0, f64::NAN] {
        let refused = limits.spindle(Spindle::CounterClockwise(speed), 3).unwrap_err();
        assert_eq!((refused.rule.name(), refused.line), ("spindle-range", 3));
    }
    let tool = |number, diameter, length| Tool {
        number,
        diameter: Some(diameter),
        length: Some(length),
        ..Tool::default()
    };
    assert!(limits.tool(&tool(99, 80.0, 300.0), 1).is_ok());
    for unfit in
        [tool(0, 10.0, 50.0), tool(100, 10.0, 50.0), tool(1, 80.1, 50.0), tool(1, 10.0, 301.0)]
    {
        let refused = limits.tool(&unfit, 9).unwrap_err();
        assert_eq!((refused.rule.name(), refused.line), ("tool-range", 9));
    }
}

#[test]
fn a_feed_beyond_the_fastest_is_refused_in_mm_a_minute() {
    let mill = Machine { feed_max: 5000.0, ..mill() };
    let limits = Limits::new(&mill);
    let check = |feed, spindle| {
        limits.feed(feed, spindle, 7).map_err(|e| (e.rule.name(), e.line, e.message))
    };
    let refused = |message: &str| Err(("feed-range", 7, message.to_owned()));
    assert_eq!(check(Feed::PerMinute(5000.0), Spindle::Off), Ok(()));
    assert_eq!(check(Feed::PerMinute(5000.1), Spindle::Off), refused("feed 5000.1 mm/min"));
    // 0.5 mm a turn at 12000 1/min.
    let turns = Spindle::CounterClockwise(12_000.0);
    assert_eq!(check(Feed::PerTurn(0.5), turns), refused("feed 6000 mm/min"));
    assert_eq!(check(Feed::PerTurn(0.25), turns), Ok(()));
    assert_eq!(Limits::new(&self::mill()).feed(Feed::PerMinute(1e6), turns, 7), Ok(()));
}

#[test]
fn what_is_held_against_the_travel_depends_on_what_the_file_says() {
    assert_eq!(Travel::of(&mill()), Travel::MachineCoordinates);
    assert_eq!(Travel::of(&Machine { work_zero: None, ..mill() }), Travel::Lengths);
    let mut free = mill();
    for axis in &mut free.linear {
        (axis.min, axis.max) = (f64::NEG_INFINITY, f64::INFINITY);
    }
    assert_eq!(Travel::of(&free), Travel::Unlimited);
}
