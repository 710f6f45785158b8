//! Where the axes lead the tip, by hand.

use geom::Vec3;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use toolpost_machine::axis_motion::Chain;
use toolpost_machine::linkage::Linkage;
use toolpost_machine::{load, load_text};

fn near(found: Vec3, wanted: [f64; 3]) {
    assert!(found.distance(Vec3::from_array(wanted)) < 1e-9, "{found}, not {wanted:?}");
}

/// Distance of a point from the line between two others.
fn off(point: Vec3, [a, b]: [Vec3; 2]) -> f64 {
    (point - a).reject_from(b - a).length()
}

/// A mill with C on the table about the work zero, and all axes with these rapids, mm/min and degrees a minute, that are reached at once.
fn turning_table(rapids: [f64; 4]) -> toolpost_machine::Machine {
    let [x, y, z, c] = rapids;
    let axes = ["X", "Y", "Z"].iter().zip([x, y, z]);
    let axes: String = axes
        .map(|(axis, rapid)| format!("{axis} = {{ rapid = {rapid}, acceleration = 1000 }}\n"))
        .collect();
    let text = format!(
        "reader = \"fanuc\"\nwork_zero = [0, 0, 0]\n[orientation]\nsimultaneous = \"machine-angles\"\ntolerance = 0.01\n[words]\nX = {{ decimals = 3 }}\nC = {{ decimals = 3 }}\n[axes]\n{axes}\
         [[rotary]]\nletter = \"C\"\non = \"table\"\naxis = [0, 0, 1]\npoint = [0, 0, 0]\nsign = -1\nrapid = {c}\nacceleration = 1e7\n"
    );
    load_text("shop.toml", &text).unwrap()
}

#[test]
fn a_table_that_turns_alone_draws_a_circle_on_the_part() {
    let machine = turning_table([1e4; 4]);
    let chain = Chain::of(&machine);
    // At C 0 the tip is at X 100, and C 90 turns what was there away from it: the part turns by -90 about Z, the tip on it by 90.
    let (from, to) = ([100.0, 0.0, 5.0, 0.0], [100.0, 0.0, 5.0, 90.0]);
    let end = (Vec3::new(0.0, 100.0, 5.0), Vec3::Z);
    let motion = chain.motion([&from, &to], end, true).unwrap();
    let tool = motion.tool();
    near(tool(0.0).0, [100.0, 0.0, 5.0]);
    near(tool(0.5).0, [100.0 * FRAC_1_SQRT_2, 100.0 * FRAC_1_SQRT_2, 5.0]);
    near(tool(1.0).0, [0.0, 100.0, 5.0]);
    assert_eq!(motion.axes(0.5), [100.0, 0.0, 5.0, 45.0]);
    // A chord over the angle a of a circle of 100 mm is off by 100 (1 - cos a/2): 0.002 mm at 0.01265 rad. So 125 chords are needed.
    let least = FRAC_PI_2 / (2.0 * (1.0 - 0.002_f64 / 100.0).acos());
    let parts = motion.parts(0.002, 1_000_000);
    assert!((least..1.5 * least).contains(&(parts.len() as f64)), "{least}, {}", parts.len());
    assert_eq!(parts.last(), Some(&1.0));
    let places: Vec<Vec3> =
        std::iter::once(0.0).chain(parts.iter().copied()).map(|part| tool(part).0).collect();
    for pair in places.windows(2) {
        let middle = (pair[0] + pair[1]) / 2.0;
        let sagitta = 100.0 - middle.truncate().length();
        assert!(sagitta <= 0.002 && (middle.z - 5.0).abs() < 1e-9, "{sagitta}");
    }
    // What takes too many is drawn with as many as there may be.
    assert_eq!(motion.parts(0.002, 16).len(), 16);
    let round_and_round = [100.0, 0.0, 5.0, 1e12];
    let motion = chain.motion([&from, &round_and_round], (end.0, Vec3::Z), true).unwrap();
    assert_eq!(motion.parts(0.002, 100).len(), 100);
}

#[test]
fn a_tip_that_goes_on_while_the_table_turns_is_within_the_bound() {
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let chain = Chain::of(&machine);
    let from = [10.0, -20.0, 300.0, -10.0, 30.0];
    for (to, most) in [
        ([40.0, 80.0, 250.0, 60.0, 200.0], 5000),
        ([10.5, -20.2, 300.1, -10.1, 30.2], 2),
        ([10.0, -20.0, 300.0, -9.0, 30.0], 200),
    ] {
        let motion = chain.motion([&from, &to], (Vec3::new(7.0, 8.0, 9.0), Vec3::Z), true);
        let motion = motion.unwrap();
        let (parts, tool) = (motion.parts(0.002, 1_000_000), motion.tool());
        assert!(parts.len() <= most, "{}", parts.len());
        let mut begin = 0.0;
        for end in parts {
            let ends = [begin, end].map(|part| tool(part).0);
            for step in 1..8 {
                let between = begin + (end - begin) * f64::from(step) / 8.0;
                let off = off(tool(between).0, ends);
                assert!(off <= 0.002, "{off} mm at {between} of {to:?}");
            }
            begin = end;
        }
    }
}

#[test]
fn axes_that_go_each_at_its_own_speed_arrive_one_after_the_other() {
    // But for the ramps, of less than a millisecond: X 100 mm at 10 m/min: 0.6 s. Y 50 mm at 20 m/min: 0.15 s. C 45 degrees at 9000 degrees a minute: 0.3 s.
    let machine = turning_table([10_000.0, 20_000.0, 10_000.0, 9000.0]);
    let chain = Chain::of(&machine);
    let (from, to) = ([0.0, 0.0, 5.0, 0.0], [100.0, 50.0, 5.0, 45.0]);
    let motion = chain.motion([&from, &to], (Vec3::ZERO, Vec3::Z), false).unwrap();
    let close = |part: f64, wanted: [f64; 4]| {
        let found = motion.axes(part);
        let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.1, "{found:?}, not {wanted:?}");
    };
    close(0.125, [12.5, 25.0, 5.0, 11.25]);
    close(0.25, [25.0, 50.0, 5.0, 22.5]);
    close(0.5, [50.0, 50.0, 5.0, 45.0]);
    close(1.0, [100.0, 50.0, 5.0, 45.0]);
    // Without the turn the way has one corner, where Y arrives.
    let straight = [100.0, 50.0, 5.0, 0.0];
    let end = (Vec3::new(100.0, 50.0, 5.0), Vec3::Z);
    let motion = chain.motion([&from, &straight], end, false).unwrap();
    let corners: Vec<Vec3> =
        motion.parts(0.002, 1000).into_iter().map(|part| motion.tool()(part).0).collect();
    assert_eq!(corners.len(), 2);
    assert!(corners[0].distance(Vec3::new(25.0, 50.0, 5.0)) < 0.1, "{corners:?}");
    near(corners[1], [100.0, 50.0, 5.0]);
}

#[test]
fn an_axis_of_which_nobody_knows_where_it_stands_leads_nowhere() {
    let machine = turning_table([1e4; 4]);
    let chain = Chain::of(&machine);
    let (known, home) = ([0.0; 4], [0.0, 0.0, f64::NAN, 0.0]);
    let end = (Vec3::ZERO, Vec3::Z);
    assert!(chain.motion([&home, &known], end, true).is_none());
    assert!(chain.motion([&known, &home], end, true).is_none());
    assert!(chain.motion([&known, &known], (Vec3::NAN, Vec3::Z), true).is_none());
    assert!(chain.motion([&known[..3], &known], end, true).is_none());
    assert!(chain.motion([&known, &known], end, true).is_some());
}

#[test]
fn the_first_joint_of_an_arm_draws_a_circle_about_its_axis() {
    let machine = load("universal-ur5e").unwrap();
    let chain = Chain::of(&machine);
    let from = [0.0, -90.0, 90.0, -90.0, -90.0, 0.0];
    let to = [60.0, -90.0, 90.0, -90.0, -90.0, 0.0];
    let base = machine.cell.as_ref().unwrap().part;
    // Where the tip is in the world at the end, wherever that is: 600 mm from axis 1.
    let end = Vec3::new(300.0, 300.0 * 3f64.sqrt(), 200.0);
    let in_part = base.inverse().transform_point3(end);
    let motion = chain.motion([&from, &to], (in_part, Vec3::Z), true).unwrap();
    let begin = base.transform_point3(motion.tool()(0.0).0);
    near(begin, [600.0, 0.0, 200.0]);
    let middle = base.transform_point3(motion.tool()(0.5).0);
    near(middle, [300.0 * 3f64.sqrt(), 300.0, 200.0]);
}

/// The links of the drawing, which know nothing of how joints are found, lead the tip to where the control keeps it.
#[test]
fn while_an_arm_keeps_its_tip_on_a_line_its_joints_lead_it_there() {
    for (name, from, to) in [
        (
            "universal-ur5e",
            [10.0, -80.0, 95.0, -105.0, -90.0, 20.0],
            [40.0, -95.0, 80.0, -80.0, -70.0, 10.0],
        ),
        (
            "kuka-kr6-r900",
            [0.0, -80.0, 95.0, 10.0, 60.0, 170.0],
            [30.0, -70.0, 80.0, -20.0, 45.0, 200.0],
        ),
        (
            "fanuc-lrmate-200id-mill",
            [0.0, 20.0, -30.0, 10.0, -60.0, 0.0],
            [20.0, 30.0, -40.0, 20.0, -45.0, 10.0],
        ),
    ] {
        let machine = load(name).unwrap();
        let (chain, linkage) = (Chain::of(&machine), Linkage::of(&machine));
        let tip = |axes: &[f64]| linkage.tip(axes, 80.0);
        // The axis of a tool leads from its tip to the spindle.
        let axis = |axes: &[f64]| (linkage.tip(axes, 79.0) - tip(axes)).normalize();
        let end = (tip(&to), axis(&to));
        for part in [0.0, 0.25, 0.5, 0.9, 1.0] {
            let wanted = tip(&from).lerp(tip(&to), part);
            let (axes, leans) = chain.keeping_tip([&from, &to], end, wanted, part).unwrap();
            let off = tip(&axes).distance(wanted);
            assert!(off < 1e-6 && axis(&axes).distance(leans) < 1e-9, "{name} at {part}: {off}");
            for (joint, [a, b]) in axes.iter().zip(from.iter().zip(to).map(|(a, b)| [*a, b])) {
                assert!((joint - a.midpoint(b)).abs() < 40.0, "{name} at {part}: {axes:?}");
            }
        }
    }
    // Nothing of what is not known, and of what is out of reach.
    let chain = Chain::of(&load("universal-ur5e").unwrap());
    let joints = [10.0, -80.0, 95.0, -105.0, -90.0, 20.0];
    let far = Vec3::new(0.0, 0.0, 5000.0);
    assert!(chain.keeping_tip([&joints; 2], (Vec3::ZERO, Vec3::Z), far, 0.5).is_none());
    assert!(chain.keeping_tip([&joints[..5]; 2], (Vec3::ZERO, Vec3::Z), Vec3::ZERO, 0.5).is_none());
}
