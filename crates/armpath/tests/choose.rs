//! Ways of an arm along paths, checked by its forward kinematics alone.

use arm::{Arm, Coupling, CouplingLimit, Dh, Frame, Joint, Mat3, Spherical, Structure, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toolpost_armpath::{Blocked, Cell, Choice, Point, Settings, Why, choose};

/// KUKA KR 6 R900 sixx.
fn kuka() -> Arm {
    let structure = Structure::Spherical(Spherical {
        a1: 25.0,
        a2: -35.0,
        b: 0.0,
        c1: 400.0,
        c2: 455.0,
        c3: 420.0,
        c4: 80.0,
        offsets: [0.0, -FRAC_PI_2, 0.0, 0.0, 0.0, 0.0],
        signs: [-1.0, 1.0, 1.0, -1.0, 1.0, -1.0],
    });
    let limits = [
        (-170.0, 170.0, 360.0),
        (-190.0, 45.0, 300.0),
        (-120.0, 156.0, 360.0),
        (-185.0, 185.0, 381.0),
        (-120.0, 120.0, 388.0),
        (-350.0, 350.0, 615.0),
    ];
    let joint = |(min, max, speed): (f64, f64, f64)| Joint {
        min: min.to_radians(),
        max: max.to_radians(),
        speed: speed.to_radians(),
        acceleration: None,
    };
    Arm::new(structure, limits.map(joint), Some(Coupling::None), 0.0).unwrap()
}

/// The part 500 mm in front of the foot and 150 mm above it; a spindle that leans by an angle against the flange.
fn cell(lean: f64) -> Cell {
    let out = Frame::from_translation(Vec3::new(0.0, 0.0, 80.0));
    Cell {
        tool: out * Frame::from_mat3(Mat3::from_rotation_y(lean)) * out,
        part: Frame::from_translation(Vec3::new(500.0, 0.0, 150.0)),
    }
}

const LEANING: f64 = std::f64::consts::FRAC_PI_4;

/// Points along a curve, all of them cut but the first, at 1800 mm/min with the tool upright.
fn upright(count: usize, curve: impl Fn(f64) -> Vec3) -> Vec<Point> {
    let point = |i: usize| Point {
        tip: curve(i as f64 / (count - 1) as f64),
        axis: Vec3::Z,
        side: None,
        cut: i > 0,
        feed: 1800.0,
        inside: false,
    };
    (0..count).map(point).collect()
}

/// Rings on a dome, leaning up to 40 degrees.
fn dome(count: usize) -> Vec<Point> {
    let point = |i: usize| {
        let t = i as f64 / count as f64;
        let (turn, lean) = (t * 12.0 * TAU, (2.0 + 38.0 * t).to_radians());
        let axis = Vec3::new(lean.sin() * turn.cos(), lean.sin() * turn.sin(), lean.cos());
        Point {
            tip: axis * 120.0 - Vec3::Z * 120.0,
            axis,
            side: None,
            cut: i > 0,
            feed: 1800.0,
            inside: false,
        }
    };
    (0..count).map(point).collect()
}

/// That every point is reached, in order and once in each section, and that the joints do what a way promises.
fn proven(arm: &Arm, cell: &Cell, points: &[Point], settings: &Settings, way: &Choice) {
    let mut next = 0;
    for section in &way.sections {
        assert_eq!(section.first, if section.reentry.is_some() { next - 1 } else { next });
        assert!(
            section.reentry.is_some()
                || !points[section.first].cut
                || points[section.first].side.is_some()
        );
        for (i, stand) in section.positions.iter().enumerate() {
            let point = &points[section.first + i];
            let tip = cell.part.inverse() * arm.flange(&stand.joints) * cell.tool;
            assert!(tip.translation.distance(point.tip) < 1e-6, "{i}: {tip:?} {point:?}");
            assert!((tip.matrix3.z_axis + point.axis).length() < 1e-9, "{i}");
            assert!((tip.matrix3.x_axis - stand.side).length() < 1e-9, "{i}");
            assert!(
                arm.allows(&stand.joints) && arm.posture(&stand.joints) == section.posture,
                "{i}"
            );
            let margins = arm.margins(&stand.joints);
            assert!(
                margins.wrist >= settings.wrist
                    && margins.elbow >= settings.elbow
                    && margins.shoulder >= settings.shoulder
            );
            let Some(before) = i.checked_sub(1).map(|i| section.positions[i].joints) else {
                continue;
            };
            let length = point.tip.distance(points[section.first + i - 1].tip);
            let turned = points[section.first + i - 1].axis.angle_between(point.axis);
            let time = (length / (point.feed / 60.0))
                .max(settings.slows_at.map_or(0.0, |rate| turned / rate));
            for (k, joint) in arm.joints().iter().enumerate() {
                let change = (stand.joints[k] - before[k]).abs();
                assert!(
                    change <= joint.speed * time * (settings.speed + 1e-6) + 1e-9,
                    "joint {} at {i}: {change}",
                    k + 1
                );
            }
        }
        next = section.first + section.positions.len();
    }
    assert_eq!(next, points.len());
}

fn way(cell: &Cell, points: &[Point]) -> Result<Choice, Blocked> {
    let settings = Settings { slows_at: Some(60_f64.to_radians()), ..Settings::default() };
    let arm = kuka();
    let way = choose(&arm, cell, points, &settings)?;
    proven(&arm, cell, points, &settings, &way);
    Ok(way)
}

#[test]
fn a_dome_is_cut_in_one_section_with_a_leaning_spindle() {
    let points = dome(4000);
    let way = way(&cell(LEANING), &points).unwrap();
    assert_eq!(way.sections.len(), 1);
    assert!(way.worst.wrist.0 > 5_f64.to_radians() && way.worst.speed.0 < 0.9, "{:?}", way.worst);
}

#[test]
fn an_arm_of_universal_robots_cuts_the_same_dome() {
    let dh = Dh { d1: 162.5, a2: -425.0, a3: -392.2, d4: 133.3, d5: 99.7, d6: 99.6 };
    let joint = Joint { min: -TAU, max: TAU, speed: PI, acceleration: None };
    let arm = Arm::new(Structure::Ur(dh, None), [joint; 6], Some(Coupling::None), 0.0).unwrap();
    let (cell, points, settings) = (cell(LEANING), dome(1500), Settings::default());
    let choice = choose(&arm, &cell, &points, &settings).unwrap();
    proven(&arm, &cell, &points, &settings, &choice);
    assert_eq!(choice.sections.len(), 1);
}

#[test]
fn a_spindle_along_axis_6_has_no_free_turn_and_a_singular_wrist_in_a_cut_is_refused_with_its_point()
{
    // Leaning the tool through the direction of the forearm: joint 5 passes 0, whatever the turn.
    let axis = |t: f64| Vec3::new(-(t.sin()), 0.0, t.cos());
    let points: Vec<Point> = (0..=90)
        .map(|i| Point {
            tip: Vec3::new(0.0, 0.0, 350.0),
            axis: axis(f64::from(i).to_radians()),
            side: None,
            cut: i > 0,
            feed: 1800.0,
            inside: false,
        })
        .collect();
    let blocked = way(&cell(0.0), &points).unwrap_err();
    assert!(
        matches!(blocked.why, Why::Wrist(_)) && (1..90).contains(&blocked.point),
        "{blocked:?}"
    );
    assert!(blocked.to_string().contains("degrees from stretched"), "{blocked}");
    // The same with a leaning spindle: the turn goes round the singularity.
    way(&cell(LEANING), &points).unwrap();
}

#[test]
fn a_turn_that_the_source_says_is_kept() {
    let mut points = upright(200, |t| Vec3::new(100.0 * t, 50.0 - 100.0 * t, 0.0));
    let side = Vec3::new(0.6, 0.8, 0.0);
    points.iter_mut().for_each(|point| point.side = Some(side));
    let way = way(&cell(LEANING), &points).unwrap();
    assert!(
        way.sections
            .iter()
            .flat_map(|section| &section.positions)
            .all(|stand| stand.side.distance(side) < 1e-9)
    );
}

#[test]
fn what_is_out_of_reach_or_too_near_is_refused_with_how_much() {
    let far = upright(60, |t| Vec3::new(600.0 * t, 0.0, 0.0));
    let blocked = way(&cell(LEANING), &far).unwrap_err();
    assert!(matches!(blocked.why, Why::Reach(mm) if mm > 0.0 && mm < 20.0), "{blocked:?}");
    assert!(blocked.to_string().contains("mm out of reach"), "{blocked}");
    // In the foot of the arm.
    let near = upright(60, |t| Vec3::new(-500.0 * t, 0.0, 0.0));
    let blocked = way(&cell(0.0), &near).unwrap_err();
    assert!(blocked.point > 0, "{blocked:?}");
    // Behind the base.
    let behind = upright(2, |t| Vec3::new(-1700.0 - t, 0.0, 0.0));
    let blocked = way(&cell(0.0), &behind).unwrap_err();
    assert!(
        blocked.point == 0 && matches!(blocked.why, Why::Reach(mm) if mm > 100.0),
        "{blocked:?}"
    );
}

/// A line far beyond the reach of the arm: the first place of it that is not reached lacks 0.1 mm or so, the end of it a metre and more.
#[test]
fn of_a_place_within_a_motion_it_says_where_that_is_and_how_far_the_end_is() {
    let cell = cell(LEANING);
    let blocked = way(&cell, &upright(2, |t| Vec3::new(2000.0 * t, 0.0, -2.0))).unwrap_err();
    let within = blocked.within.unwrap();
    let (Why::Reach(first), Some(Why::Reach(end))) = (blocked.why, within.end) else {
        panic!("{blocked:?}")
    };
    assert!(blocked.point == 1 && within.tip.y.abs() < 1e-9 && (within.tip.z + 2.0).abs() < 1e-9);
    // From the place to the end the line leads away from the shoulder, but for the height of that: 250 mm over 2500 mm.
    let rest = 2000.0 - within.tip.x;
    assert!((end - first - rest).abs() < 0.03 * rest, "{blocked:?}");
    // A step before, the arm is within its reach.
    let before = within.tip - Vec3::X * 10.0;
    assert!(way(&cell, &upright(2, |t| before * t - Vec3::Z * 2.0 * (1.0 - t))).is_ok());
    let said = blocked.to_string();
    assert!(said.contains("before the end of the motion, the tool is"), "{said}");
    assert!(said.ends_with(&format!("at the end the tool is {end:.1} mm out of reach")), "{said}");
    // At the end of a motion there is nothing to add.
    let far = upright(2, |t| Vec3::new(2000.0 + t, 0.0, 0.0));
    assert_eq!(way(&cell, &far).unwrap_err().within, None);
}

#[test]
fn a_feed_that_is_too_fast_for_a_joint_is_refused_far_from_any_singularity() {
    let line = |feed: f64| {
        let mut points = upright(200, |t| Vec3::new(0.0, 200.0 * t - 100.0, 0.0));
        points.iter_mut().for_each(|point| point.feed = feed);
        points
    };
    let slow = way(&cell(LEANING), &line(30_000.0)).unwrap();
    assert!(slow.worst.speed.0 > 0.05, "{:?}", slow.worst);
    let blocked = way(&cell(LEANING), &line(3_000_000.0)).unwrap_err();
    assert!(matches!(blocked.why, Why::Speed(_, share, 0.9) if share > 0.9), "{blocked:?}");
    assert!(
        blocked.to_string().ends_with("% of its speed at this feed, and a cut may use 90 %"),
        "{blocked}"
    );
}

#[test]
fn a_ring_round_the_foot_is_divided_where_joint_1_ends() {
    // One and a half times round: joint 1 turns 340 degrees.
    let ring = upright(1200, |t| {
        let angle = t * 3.0 * PI;
        Vec3::new(500.0 * angle.cos() - 500.0, 500.0 * angle.sin(), 0.0)
    });
    let way = way(&cell(LEANING), &ring).unwrap();
    assert!(way.sections.len() >= 2 && way.sections[1].reentry.is_some(), "{}", way.sections.len());
    assert!(way.sections.len() <= 4, "{}", way.sections.len());
}

#[test]
fn a_cut_is_not_divided_within_a_motion() {
    let mut ring = upright(1200, |t| {
        let angle = t * 3.0 * PI;
        Vec3::new(500.0 * angle.cos() - 500.0, 500.0 * angle.sin(), 0.0)
    });
    for (i, point) in ring.iter_mut().enumerate() {
        point.inside = i % 10 != 0;
    }
    let divided = way(&cell(LEANING), &ring).unwrap();
    assert!(divided.sections.len() >= 2, "{}", divided.sections.len());
    assert!(divided.sections.iter().all(|section| section.first % 10 == 0));
    // The whole ring as one motion passes in no section.
    ring.iter_mut().for_each(|point| point.inside = true);
    assert!(way(&cell(LEANING), &ring).is_err());
}

/// A line outwards in steps of 0.02 mm, which is far less than the steps of the choice.
#[test]
fn where_points_are_dense_the_first_that_is_not_reached_is_found_all_the_same() {
    let line = upright(40_001, |t| Vec3::new(800.0 * t, 0.0, 0.0));
    let blocked = way(&cell(LEANING), &line).unwrap_err();
    let by = match blocked.why {
        Why::Elbow(angle) => 5_f64.to_radians() - angle,
        Why::Wrist(angle) => 5_f64.to_radians() - angle,
        Why::Reach(mm) => mm / 100.0,
        Why::Limit(_, by) => by,
        why => panic!("{why:?}"),
    };
    // A step on by 0.02 mm turns no joint there by more than 0.1 degrees.
    assert!((0.0..2e-3).contains(&by), "{blocked:?}");
    let arm = kuka();
    let reached = &line[..blocked.point];
    let choice = way(&cell(LEANING), reached).unwrap();
    proven(&arm, &cell(LEANING), reached, &Settings::default(), &choice);
}

#[test]
fn a_tool_that_is_turned_round_and_round_by_its_source_is_divided_where_joint_6_ends() {
    let mut points = upright(800, |t| Vec3::new(0.0, 100.0 * t, 0.0));
    for (i, point) in points.iter_mut().enumerate() {
        let angle = i as f64 * 4.0 * TAU / 800.0;
        (point.side, point.feed) = (Some(Vec3::new(angle.cos(), angle.sin(), 0.0)), 100.0);
    }
    let settings = Settings { slows_at: Some(60_f64.to_radians()), ..Settings::default() };
    let arm = kuka();
    let way = choose(&arm, &cell(0.0), &points, &settings).unwrap();
    // 1440 degrees in spans of at most 698.
    assert!((3..=4).contains(&way.sections.len()), "{}", way.sections.len());
    let all = way.sections.iter().flat_map(|section| &section.positions);
    assert!(all.clone().all(|stand| arm.allows(&stand.joints)));
}

#[test]
fn cuts_with_a_rapid_between_them_are_sections_of_their_own() {
    let mut points = dome(600);
    points[300].cut = false;
    let way = way(&cell(LEANING), &points).unwrap();
    assert_eq!(way.sections.iter().map(|section| section.first).collect::<Vec<_>>(), [0, 300]);
    assert!(way.sections.iter().all(|section| section.reentry.is_none()));
}

#[test]
fn limits_of_joint_3_as_the_controller_counts_it_hold_on_the_way() {
    let free = kuka();
    let points = upright(100, |t| Vec3::new(100.0 * t, 0.0, 0.0));
    let (cell, settings) = (cell(LEANING), Settings::default());
    let way = choose(&free, &cell, &points, &settings).unwrap();
    let coupled =
        Arm::new(free.structure().clone(), *free.joints(), Some(Coupling::LessJoint2), 0.0)
            .unwrap();
    let shown = |stand: &toolpost_armpath::Position| coupled.shown(&stand.joints).unwrap()[2];
    let highest = way.sections[0].positions.iter().map(shown).fold(f64::NEG_INFINITY, f64::max);
    let limit =
        |max: f64| coupled.clone().with_coupling_limit(CouplingLimit { min: -9.0, max }).unwrap();
    assert!(choose(&limit(highest + 0.01), &cell, &points, &settings).is_ok());
    if let Ok(other) = choose(&limit(highest - 0.05), &cell, &points, &settings) {
        let all = other.sections.iter().flat_map(|section| &section.positions);
        assert!(all.clone().all(|stand| shown(stand) <= highest - 0.05));
    }
    assert!(choose(&limit(-8.0), &cell, &points, &settings).is_err());
}

#[test]
fn what_is_no_number_is_refused_with_its_point() {
    let with = |change: &dyn Fn(&mut Point)| {
        let mut points = dome(20);
        change(&mut points[7]);
        way(&cell(LEANING), &points).unwrap_err()
    };
    let refused = Blocked { point: 7, within: None, why: Why::Numbers };
    assert_eq!(with(&|point| point.tip.x = f64::NAN), refused);
    assert_eq!(with(&|point| point.axis = Vec3::ZERO), refused);
    assert_eq!(with(&|point| point.feed = 0.0), refused);
    assert_eq!(with(&|point| point.side = Some(point.axis)), refused);
    assert_eq!(with(&|point| point.tip.x = 1e9), refused);
    let settings = Settings { turns: 0, ..Settings::default() };
    assert!(choose(&kuka(), &cell(0.0), &dome(5), &settings).is_err());
    assert!(choose(&kuka(), &cell(0.0), &[], &Settings::default()).unwrap().sections.is_empty());
}

#[test]
fn the_way_is_the_same_on_one_thread_and_on_many() {
    let (arm, cell, points) = (kuka(), cell(LEANING), dome(1500));
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| choose(&arm, &cell, &points, &Settings::default()).unwrap())
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn an_arm_goes_slower_where_the_tool_turns_only_if_its_controller_does() {
    // 40 degrees on 10 mm at 1800 mm/min: a third of a second, 120 degrees/s.
    let points: Vec<Point> = (0..=10)
        .map(|i| {
            let lean = (4.0 * f64::from(i)).to_radians();
            let (tip, axis) =
                (Vec3::new(f64::from(i), 0.0, 100.0), Vec3::new(0.0, lean.sin(), lean.cos()));
            Point { tip, axis, side: None, cut: i > 0, feed: 1800.0, inside: false }
        })
        .collect();
    let arm = kuka();
    let speed = |slows_at: Option<f64>| {
        let settings = Settings { slows_at, ..Settings::default() };
        choose(&arm, &cell(LEANING), &points, &settings).unwrap().worst.speed.0
    };
    let kept = speed(None);
    // The same steps at a third of the speed need a third of the joints' speeds.
    let slowed = speed(Some(40_f64.to_radians()));
    // About: the choice of the turn differs a little.
    assert!((kept / slowed - 3.0).abs() < 0.1, "{kept} {slowed}");
    assert!((speed(Some(200_f64.to_radians())) - kept).abs() < 1e-12);
    let never = Settings { slows_at: Some(0.0), ..Settings::default() };
    assert_eq!(choose(&arm, &cell(LEANING), &points, &never).unwrap_err().why, Why::Numbers);
}

/// A search over a long cut ends in its middle where the work was ended.
#[test]
fn a_search_ends_with_the_work_that_it_is_of() {
    let points = dome(200);
    let ended = geom::ending::Ended::default();
    let chosen = || choose(&kuka(), &cell(LEANING), &points, &Settings::default()).is_ok();
    assert!(ended.run(chosen).is_some());
    ended.end();
    assert!(ended.run(chosen).is_none());
}
