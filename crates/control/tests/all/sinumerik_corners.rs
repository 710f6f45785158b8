//! Chamfers and arcs between two blocks on the SINUMERIK virtual control, against hand calculation.

use crate::common::sinumerik::{blocks, error, near, v};
use geom::{Arc, Vec3};
use program::Feed;
use proptest::prelude::*;
use toolpost_control::Action;

/// The ways of the cuts: where each ends, and for arcs their centre and direction.
fn ways(text: &str) -> Vec<(Vec3, Option<(Vec3, Vec3)>)> {
    blocks(text)
        .iter()
        .filter_map(|op| match op {
            Action::Line(pose) => Some((pose.point, None)),
            Action::Arc(arc) => Some((arc.end.point, Some((arc.center, arc.normal)))),
            _ => None,
        })
        .collect()
}

#[test]
fn a_chamfer_cuts_the_corner_by_its_length_or_its_side() {
    let side = ways("G1 X20 CHR=2\nY10");
    let ends: Vec<_> = side.iter().map(|way| way.0).collect();
    let expected = [v(18.0, 0.0, 100.0), v(20.0, 2.0, 100.0), v(20.0, 10.0, 100.0)];
    assert_eq!(ends, expected);
    // 2 mm long at a right angle: the square root of 2 from the corner.
    let length = ways("G1 X20 CHF=2\nY10");
    near(length[0].0, v(20.0 - 2f64.sqrt(), 0.0, 100.0));
    near(length[1].0, v(20.0, 2f64.sqrt(), 100.0));
}

#[test]
fn a_corner_between_lines_is_rounded_on_its_inner_side() {
    let left = ways("G1 X20 RND=3\nY10");
    near(left[0].0, v(17.0, 0.0, 100.0));
    near(left[1].0, v(20.0, 3.0, 100.0));
    let (center, normal) = left[1].1.unwrap();
    near(center, v(17.0, 3.0, 100.0));
    near(normal, v(0.0, 0.0, 1.0));
    let right = ways("G1 X20 RND=3\nY-10");
    near(right[1].1.unwrap().0, v(17.0, -3.0, 100.0));
    near(right[1].1.unwrap().1, v(0.0, 0.0, -1.0));
    // In G18 from Z to X is to the left; seen from +Y that is counter-clockwise.
    let other = ways("G18 G1 Z120 RND=3\nX10");
    near(other[1].1.unwrap().0, v(3.0, 0.0, 117.0));
    near(other[1].1.unwrap().1, v(0.0, 1.0, 0.0));
}

#[test]
fn a_corner_next_to_an_arc_touches_it() {
    // Along X to (20, 0), then clockwise about (20, -10) would go straight on; counter-clockwise about
    // (10, 0) turns left by a right angle. The arc of radius 2 inside lies at 8 from that centre and at 2
    // above the line: (10 + sqrt(60), 2).
    let found = ways("G1 X20 RND=2\nG3 X10 Y10 I-10 J0");
    let x = 10.0 + 60f64.sqrt();
    near(found[1].1.unwrap().0, v(x, 2.0, 100.0));
    near(found[0].0, v(x, 0.0, 100.0));
    near(found[1].0, v(10.0, 0.0, 100.0) + v(60f64.sqrt(), 2.0, 0.0) / 8.0 * 10.0);
    near(found[2].1.unwrap().0, v(10.0, 0.0, 100.0));
    // Straight on there is no corner.
    assert_eq!(ways("G1 X20 RND=2\nG2 X30 Y-10 I0 J-10").len(), 2);
}

#[test]
fn every_corner_is_rounded_until_it_is_ended() {
    let found = ways("RNDM=1\nG1 X10\nY10\nX0\nRNDM=0\nY0");
    let arcs = found.iter().filter(|way| way.1.is_some()).count();
    assert_eq!((found.len(), arcs), (7, 3));
    // A block with a corner of its own, and a way down that has none.
    let found = ways("RNDM=1\nG1 X10 CHR=2\nY10\nZ90\nX0\nRNDM=0");
    assert_eq!(found.iter().filter(|way| way.1.is_some()).count(), 0);
    near(found[0].0, v(8.0, 0.0, 100.0));
    near(found[2].0, v(10.0, 10.0, 100.0));
}

#[test]
fn a_corner_has_the_feed_of_the_next_block_or_its_own() {
    let feeds = |text: &str| -> Vec<String> {
        let name = |op: &Action| match op {
            Action::Feed(Feed::PerMinute(feed)) => Some(format!("F{feed}")),
            Action::Line(_) => Some("line".into()),
            _ => None,
        };
        blocks(text).iter().filter_map(name).collect()
    };
    assert_eq!(feeds("G1 X10 CHR=1\nY10 F200"), ["line", "F200", "line", "line"]);
    let own = ["line", "F200", "F50", "line", "F200", "line"];
    assert_eq!(feeds("G1 X10 CHR=1 FRC=50\nY10 F200"), own);
    assert_eq!(feeds("FRCM=50\nG1 X10 CHR=1\nY10 F200"), own);
}

#[test]
fn records_keep_their_order_around_a_corner() {
    let ops = blocks("G1 X10 RND=1 ; one\nM8 ; two\nY10 M0");
    let names: Vec<_> = ops
        .iter()
        .map(|op| match op {
            Action::Comment(text) => text.to_string(),
            Action::Coolant(_) => "coolant".into(),
            Action::Line(_) => "line".into(),
            Action::Arc(_) => "arc".into(),
            Action::Risk(_) => "risk".into(),
            Action::Stop => "stop".into(),
            _ => "end".into(),
        })
        .collect();
    assert_eq!(names, ["one", "line", "two", "coolant", "arc", "line", "risk", "stop", "end"]);
}

#[test]
fn a_corner_without_two_sides_is_refused() {
    for (text, line) in [
        ("G1 X10 RND=1", 2),
        ("G1 X10 RND=1\nZ50", 2),
        ("G1 X10 RND=1\nG0 Y10", 2),
        ("G1 X10 RND=1\nM0\nY10", 2),
        ("G1 X10 RND=1\nTRANS X5\nY10", 2),
        ("G1 X10 RND=1\nG18 Y10", 2),
        ("G1 X10 RND=20\nY10", 2),
        ("G1 X10 CHR=11\nY20", 2),
        ("G1 X10 RND=1\nX0", 2),
        ("G1 X10 Z50 RND=1\nY10", 1),
        ("G0 X10 RND=1\nY10", 1),
        ("G1 X10 RND=-1\nY10", 1),
        ("G1 X20 CHR=1\nG3 X10 Y10 I-10 J0", 2),
        ("RNDM=1\nG1 X10\nG0 Y10", 3),
        ("RNDM=1\nG1 X10\nG4 F1\nY10", 3),
    ] {
        let found = error(text);
        assert_eq!((found.rule.name(), found.line), ("corner", line), "{text}: {found}");
    }
    assert_eq!(error("G1 CHR=2").rule.name(), "syntax");
}

proptest! {
    /// A rounded corner of two lines or arcs is smooth: each piece starts in the direction in which the
    /// last one ended, and its arc has the radius that was asked for.
    #[test]
    fn a_rounded_corner_is_smooth(
        first in (20.0..50.0f64, 0.0..360.0f64, any::<bool>()),
        second in (20.0..50.0f64, 20.0..160.0f64, any::<bool>(), any::<bool>()),
        radius in 0.5..3.0f64,
    ) {
        let at = |angle: f64| v(angle.to_radians().cos(), angle.to_radians().sin(), 0.0);
        // Arcs by their end and a large radius, so that corners of any angle stay corners.
        let way = |end: Vec3, arc: bool, more: &str| {
            let word = if arc { "G3 CR=200" } else { "G1" };
            format!("{word} X={:.9} Y={:.9} {more}\n", end.x, end.y)
        };
        let corner = at(first.1) * first.0;
        let turn = if second.3 { second.1 } else { -second.1 };
        let end = corner + at(first.1 + turn) * second.0;
        let text = way(corner, first.2, &format!("RND={radius:.9}")) + &way(end, second.2, "");
        let found = ways(&text);
        prop_assert_eq!(found.len(), 3, "{}", text);
        let mut from = v(0.0, 0.0, 100.0);
        let mut heading: Option<Vec3> = None;
        for (index, (to, circle)) in found.iter().enumerate() {
            let (start, end) = match circle {
                None => ((*to - from).normalize(), (*to - from).normalize()),
                Some((center, normal)) => {
                    let arc = Arc::new(from, *to, *center, *normal, 0, 1e-6).unwrap();
                    prop_assert!(index != 1 || (arc.radius() - radius).abs() < 1e-6);
                    prop_assert!(arc.sweep < std::f64::consts::PI, "{}", text);
                    let end = normal.cross(*to - *center).normalize();
                    (normal.cross(from - *center).normalize(), end)
                }
            };
            if let Some(heading) = heading {
                prop_assert!(heading.distance(start) < 1e-6, "{} {} {}", text, heading, start);
            }
            (heading, from) = (Some(end), *to);
        }
    }
}
