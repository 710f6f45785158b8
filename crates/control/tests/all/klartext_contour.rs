//! Corners, tangential arcs, approaches and departures of the Klartext control: the manuals' examples,
//! with the points calculated in another way than the control does.

use crate::common::klartext::*;
use geom::Vec3;
use program::{Compensation, Feed};
use toolpost_control::Action;

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// The points of these blocks behind the start, which leaves the tool at 0, 0, −5 at F500.
fn path(blocks: &str) -> Vec<Action> {
    let at_depth = "TOOL CALL 5 Z S3000 F500\nL X+0 Y+0 Z-5 R0 FMAX M3\n";
    run_with_radius(5.0, &format!("{at_depth}{blocks}"))[4..].to_vec()
}

/// The arc from a corner's bisector: where it begins, its center, and where it ends.
fn rounded(before: Vec3, corner: Vec3, after: Vec3, radius: f64) -> [Vec3; 3] {
    let (back, on) = ((before - corner).normalize(), (after - corner).normalize());
    let half = back.dot(on).acos() / 2.0;
    let along = radius / half.tan();
    let center = corner + (back + on).normalize() * (radius / half.sin());
    [corner + back * along, center, corner + on * along]
}

#[test]
fn a_corner_is_rounded_by_an_arc_that_touches_both_lines() {
    // iTNC 530 606 42x-03 p. 232, blocks 5 to 8.
    let ops = path("L X+10 Y+40 F300 M3\nL X+40 Y+25\nRND R5 F100\nL X+10 Y+5");
    let (before, corner, after) = (v(10.0, 40.0, -5.0), v(40.0, 25.0, -5.0), v(10.0, 5.0, -5.0));
    let [from, center, to] = rounded(before, corner, after, 5.0);
    assert_near(
        &points(&ops),
        &[before.to_array(), from.to_array(), to.to_array(), after.to_array()],
    );
    let arc = arcs(&ops)[0];
    assert!(arc.center.distance(center) < 1e-9 && arc.normal == Vec3::NEG_Z);
    // The feed of RND holds for the arc alone.
    let feeds: Vec<&Action> = ops.iter().filter(|op| matches!(op, Action::Feed(_))).collect();
    let [first, rounding, again] = feeds[..] else { panic!("{feeds:?}") };
    assert_eq!(*rounding, Action::Feed(Feed::PerMinute(100.0)));
    assert_eq!(first, again);
    // Comments may stand between, and corners follow each other.
    let ops = path("L X+40 F300\n; HERE\nRND R5\n* - THERE\nL Y+40\nRND R3\nL X+0");
    assert_near(
        &points(&ops),
        &[
            [35.0, 0.0, -5.0],
            [40.0, 5.0, -5.0],
            [40.0, 37.0, -5.0],
            [37.0, 40.0, -5.0],
            [0.0, 40.0, -5.0],
        ],
    );
}

#[test]
fn a_corner_between_a_line_and_an_arc_is_rounded() {
    // A line along X meets at (30, 0) an arc of radius 20 about (50, 0) that goes up, clockwise. By
    // hand: the center of the rounding is 5 above the line and 25 from (50, 0), at 50 - sqrt(625 - 25).
    let ops = path("L X+30 F300\nRND R5\nCC X+50 Y+0\nC X+50 Y+20 DR-");
    let x = 50.0 - 600f64.sqrt();
    let touch = [50.0 - 0.8 * 600f64.sqrt(), 4.0, -5.0];
    assert_near(&points(&ops), &[[x, 0.0, -5.0], touch, [50.0, 20.0, -5.0]]);
    let arcs = arcs(&ops);
    assert!(arcs[0].center.distance(v(x, 5.0, -5.0)) < 1e-9 && arcs[0].normal == Vec3::Z);
    assert!(arcs[1].center.distance(v(50.0, 0.0, -5.0)) < 1e-9);
    // The same backwards is its mirror image in time.
    let back = path("L X+50 Y+20 F300\nCC X+50 Y+0\nC X+30 Y+0 DR+\nRND R5\nL X+0");
    assert_near(&points(&back)[1..3], &[touch, [x, 0.0, -5.0]]);
}

#[test]
fn a_corner_between_two_arcs_is_rounded() {
    // Two circles of radius 25 about (0, 0) and (30, 0) meet at (15, 20). The path goes up the first
    // and down the second, so the rounding of radius 5 lies within both: 20 from both centers.
    let ops =
        path("L X+25 Y+0 F300\nCC X+0 Y+0\nC X+15 Y+20 DR+\nRND R5\nCC X+30 Y+0\nC X+5 Y+0 DR+");
    let center = v(15.0, 175f64.sqrt(), -5.0);
    let from = v(0.0, 0.0, -5.0) + (center - v(0.0, 0.0, -5.0)) * 1.25;
    let to = v(30.0, 0.0, -5.0) + (center - v(30.0, 0.0, -5.0)) * 1.25;
    assert!(arcs(&ops)[1].center.distance(center) < 1e-9, "{ops:?}");
    assert_near(&points(&ops)[1..3], &[from.to_array(), to.to_array()]);
}

#[test]
fn a_chamfer_begins_and_ends_at_its_length_from_the_corner() {
    let ops = path("L X+0 Y+30 F300\nL X+40 IY+5\nCHF 12 F250\nL IX+5 Y+0");
    let corner = v(40.0, 35.0, -5.0);
    let from = corner - v(40.0, 5.0, 0.0).normalize() * 12.0;
    let to = corner + v(5.0, -35.0, 0.0).normalize() * 12.0;
    assert_near(
        &points(&ops),
        &[[0.0, 30.0, -5.0], from.to_array(), to.to_array(), [45.0, 0.0, -5.0]],
    );
    assert!(ops.contains(&Action::Feed(Feed::PerMinute(250.0))));
}

#[test]
fn a_corner_that_cannot_be_cut_off_is_refused() {
    for blocks in [
        "L X+10 F300\nRND R11\nL Y+20",
        "L X+10 F300\nRND R5\nL X+20",
        "L X+10 F300\nRND R5\nL X+0",
        "L X+10 F300\nRND R5\nL Y+10 Z+1",
        "L X+10 Z+1 F300\nRND R5\nL Y+10",
        "L X+10 F300\nCHF 2\nCC X+10 Y+5\nC X+10 Y+10 DR+",
        "L X+10 FMAX\nRND R5\nL Y+20",
        "L X+10 F300\nRND R5\nL Y+20 FMAX",
        "L X+10 F300 M9\nRND R5\nL Y+20",
        "L X+10 F300\nRND R5\nRND R5\nL Y+20",
        "L X+10 F300\nRND R5\nM3",
        "L X+10 F300\nRND R5\nTOOL CALL 1 Z",
        "L X+10 F300\nRND R5",
        "L X+10 F300\nRND R0\nL Y+20",
        "L X+10 F300\nRND R5 FMAX\nL Y+20",
        "RND R5\nL Y+20",
    ] {
        let error = refused(&format!("{START}L Z-5 F100\n{blocks}"));
        assert!(["contour", "missing-word"].contains(&error.rule.name()), "{blocks}: {error}");
    }
}

#[test]
fn a_tangential_arc_goes_on_in_the_direction_before_it() {
    // iTNC 530 606 42x-03 p. 237, blocks 7 to 9. By hand: the center lies on the normal to (5, 1) in
    // (25, 30), as far from there as from (45, 20): at (28.571429, 12.142857), to the right.
    let ops = path("L X+0 Y+25 F300\nL X+25 Y+30\nCT X+45 Y+20\nL Y+0");
    let arc = arcs(&ops)[0];
    assert!(arc.center.distance(v(200.0 / 7.0, 85.0 / 7.0, -5.0)) < 1e-9, "{arc:?}");
    assert_eq!((arc.normal, arc.turns), (Vec3::NEG_Z, 0));
    // Behind an arc: two quarters of an S.
    let ops = path("L X+10 F300\nCT X+20 Y+10\nCT X+30 Y+20");
    let [first, second] = arcs(&ops)[..] else { panic!() };
    assert!(first.center.distance(v(10.0, 10.0, -5.0)) < 1e-9 && first.normal == Vec3::Z);
    assert!(second.center.distance(v(30.0, 10.0, -5.0)) < 1e-9 && second.normal == Vec3::NEG_Z);
    for blocks in ["CT X+5 Y+5", "L X+10 F300\nCT X+20 Y+0", "L X+10 F300\nCT X+20 Y+9 Z+1"] {
        let blocks = format!("TOOL CALL 5 Z S1 F9\nL X+0 Y+0 Z+0 FMAX M91\n{blocks}");
        let error = refused(&blocks);
        assert!(["arc", "unknown-position"].contains(&error.rule.name()), "{error}");
    }
}

#[test]
fn polar_coordinates_stay_and_count_on() {
    // 530: blocks 12 to 16 of CTP, "the pole is not the center of the contour arc".
    let ops = path("CC X+40 Y+35\nL X+0 Y+35 F250\nLP PR+25 PA+120\nCTP PR+30 PA+30\nL Y+0");
    let end = [40.0 + 30.0 * 0.75f64.sqrt(), 50.0, -5.0];
    assert_near(&[arcs(&ops)[0].end.point.to_array()], &[end]);
    // A hexagon: the radius stays, the angle counts on (manual, LP).
    let h = 30.0 * 0.75f64.sqrt();
    let ops = path("CC X+45 Y+25\nLP PR+30 PA+0 F300\nLP PA+60\nLP IPA+60\nLP PA+180\nLP IPR+5");
    assert_near(
        &points(&ops),
        &[
            [75.0, 25.0, -5.0],
            [60.0, 25.0 + h, -5.0],
            [30.0, 25.0 + h, -5.0],
            [15.0, 25.0, -5.0],
            [10.0, 25.0, -5.0],
        ],
    );
    assert_eq!(refused(&format!("{START}CC\nLP IPA+10 F9")).rule.name(), "unknown-position");
}

/// 10 right of the way from (10, 20) to (20, 35), as a unit vector: the side of RR.
fn right() -> Vec3 {
    v(15.0, -10.0, 0.0) / 325f64.sqrt()
}

#[test]
fn a_line_in_the_direction_of_the_contour_leads_to_it() {
    // Manual, APPR LT: LEN 15 back along (1, 1) from (20, 20).
    let ops = path("L X+40 Y+10 FMAX\nAPPR LT X+20 Y+20 Z-10 LEN15 RR F100\nL X+35 Y+35");
    // The tool of radius 5 is to the right of it from the auxiliary point on.
    let back = 20.0 - 15.0 * 0.5f64.sqrt();
    let right = |at: f64, z| [at + 12.5f64.sqrt(), at - 12.5f64.sqrt(), z];
    assert_near(
        &points(&ops)[1..],
        &[right(back, -5.0), right(back, -10.0), right(20.0, -10.0), right(35.0, -10.0)],
    );
    // Rapid to the auxiliary point, as the positioning before.
    assert!(matches!(ops[1], Action::Rapid(_)));
    assert_eq!(ops[2], Action::Feed(Feed::PerMinute(100.0)));
    // With a tool that is not in the table the contour is reported, and that it is compensated.
    let ops = run("TOOL CALL 5 Z S3000 F500\nL X+40 Y+10 Z-5 R0 FMAX\n\
                   APPR LT X+20 Y+20 Z-10 LEN15 RR F100\nL X+35 Y+35");
    let side = ops.iter().position(|op| *op == Action::Compensation(Compensation::Right(None)));
    assert_near(&points(&ops[side.unwrap()..])[..1], &[[back, back, -5.0]]);
}

#[test]
fn a_line_at_right_angles_leads_to_the_contour() {
    // Manual, APPR LN: LEN 15 and the radius of the tool, 5, to the side of RR; compensated from PH on.
    let ops = path("L X+40 Y+10 FMAX\nAPPR LN X+10 Y+20 Z-10 LEN15 RR F100\nL X+20 Y+35");
    let offset = |x: f64, y: f64, z: f64, by: f64| (v(x, y, z) + right() * by).to_array();
    assert_near(
        &points(&ops)[1..],
        &[
            offset(10.0, 20.0, -5.0, 20.0),
            offset(10.0, 20.0, -10.0, 20.0),
            offset(10.0, 20.0, -10.0, 5.0),
            offset(20.0, 35.0, -10.0, 5.0),
        ],
    );
}

#[test]
fn an_arc_leads_to_the_contour() {
    // Manual, APPR CT: half a circle of radius 10 on the side of RR, clockwise (TNC7 81762x-16: "RR,
    // positive: clockwise; negative: counterclockwise").
    for (sign, side, normal) in [("+", 1.0, Vec3::NEG_Z), ("-", -1.0, Vec3::Z)] {
        let ops = path(&format!(
            "L X+40 Y+10 FMAX\nAPPR CT X+10 Y+20 Z-10 CCA180 R{sign}10 RR F100\nL X+20 Y+35"
        ));
        // The tool of radius 5 runs inside the one and outside the other.
        let contour = v(10.0, 20.0, -10.0);
        let before = contour + right() * (20.0 * side - 5.0);
        let offset = contour + right() * 5.0;
        assert_near(&points(&ops)[2..4], &[before.to_array(), offset.to_array()]);
        let arc = arcs(&ops)[0];
        assert!(arc.center.distance(contour + right() * (10.0 * side)) < 1e-9);
        assert_eq!(arc.normal, normal);
    }
}

#[test]
fn a_line_and_an_arc_lead_to_the_contour() {
    // The contour goes along X from the datum, the tool of radius 5 on its left; its center comes
    // straight down at X-5, which is where the circle of radius 10 - 5 about (0, 10) is touched.
    let ops = path("L X-5 Y+40 FMAX\nAPPR LCT X+0 Y+0 R10 RL F100\nL X+50");
    assert_near(&points(&ops)[1..], &[[-5.0, 10.0, -5.0], [0.0, 5.0, -5.0], [50.0, 5.0, -5.0]]);
    let arc = arcs(&ops)[0];
    assert!(arc.center.distance(v(0.0, 10.0, -5.0)) < 1e-9 && arc.normal == Vec3::Z);
    assert_eq!(ops[1], Action::Feed(Feed::PerMinute(100.0)));
    // Polar, and on the right: the mirror image.
    let ops = path("L X-5 Y-40 FMAX\nCC X-3 Y+0\nAPPR PLCT PR+3 PA+0 R10 RR F100\nL X+50");
    assert_near(&points(&ops)[1..3], &[[-5.0, -10.0, -5.0], [0.0, -5.0, -5.0]]);
}

#[test]
fn departures_go_on_from_the_last_element() {
    // To the contour from the side of the tool.
    let contour = "L X+15 Y-20 R0 FMAX\nL X+0 Y-5 RR F100\nL Y+20\n";
    // Straight on by 12.5, the tool of radius 5 on the right.
    let ops = path(&format!("{contour}DEP LT LEN12.5 F90\nL Z+100 FMAX"));
    assert_near(&points(&ops)[3..], &[[5.0, 32.5, -5.0], [5.0, 32.5, 100.0]]);
    let ops = path(&format!("{contour}DEP LN LEN20 F90\nL Z+100 FMAX"));
    assert_near(&points(&ops)[3..], &[[25.0, 20.0, -5.0], [25.0, 20.0, 100.0]]);
    // A half circle of radius 8 to the right: the tool's center ends 8 - 5 beyond its middle.
    let ops =
        path(&format!("{contour}DEP CT CCA 180 R+8 F90\nL Z+100 FMAX").replace("CCA ", "CCA"));
    assert_near(&points(&ops)[3..], &[[11.0, 20.0, -5.0], [11.0, 20.0, 100.0]]);
    assert_eq!(arcs(&ops)[0].normal, Vec3::NEG_Z);
    // An arc about (8, 20), then a line to the right at the height at which the center's circle of
    // radius 3 has its top.
    let ops = path(&format!("{contour}DEP LCT X+40 Y+23 R+8 F90"));
    assert_near(&points(&ops)[3..], &[[8.0, 23.0, -5.0], [40.0, 23.0, -5.0]]);
    let arc = ops.iter().position(|op| matches!(op, Action::Arc(_))).unwrap();
    assert!(matches!(ops[arc + 1], Action::Line(_)));
}

#[test]
fn an_approach_or_a_departure_that_is_not_clear_is_refused() {
    let at = "TOOL CALL 5 Z S3000 F500\nL X-50 Y+0 Z-5 R0 FMAX\n";
    for (blocks, rule) in [
        ("APPR LN X+0 Y+0 LEN5 R0 F100\nL X+9", "compensation"),
        ("APPR CT X+0 Y+0 CCA90 R0 F100\nL X+9", "missing-word"),
        // Without the radius of the tool in the table.
        ("APPR LN X+0 Y+0 LEN5 RL F100\nL X+9", "tool"),
        ("APPR LCT X+0 Y+0 R5 RL F100\nL X+9", "tool"),
        ("APPR LT X+0 Y+0 RL F100\nL X+9", "missing-word"),
        ("APPR LT X+0 Y+0 LEN5 RL F100\nL Z+9", "contour"),
        ("APPR LT X+0 Y+0 LEN5 RL F100\nM3", "contour"),
        ("APPR XT X+0 Y+0 LEN5 RL F100", "unknown-word"),
        ("APPR LCT X+0 Y+0 Z-9 R5 RL F100\nL X+9", "unsupported"),
        ("L X+0 RL F100\nAPPR LT X+5 Y+0 LEN5 RL F100", "compensation"),
        ("L X+0 RL F100\nDEP LT LEN5", "tool"),
        ("L X+0 R0 F100\nDEP LN LEN5", "compensation"),
        ("DEP LT X+1 LEN5", "contour"),
    ] {
        let error = refused(&format!("{at}{blocks}"));
        assert_eq!(error.rule.name(), rule, "{blocks}: {error}");
    }
}

#[test]
fn jumps_and_calculations_do_not_part_a_corner() {
    let direct = path("L X+40 F300\nRND R5\nL Y+40");
    let flow = "L X+40 F300\nRND R5\nFN 9: IF +1 EQU +1 GOTO LBL 7\nL X+0\nLBL 7\nQ1 = 40\nL Y+Q1";
    assert_eq!(format!("{:?}", path(flow)), format!("{direct:?}"));
    let asked = format!("{START}L X+40 F300\nRND R5\nFN 18: SYSREAD Q1 = ID270 NR1 IDX1\nL Y+40");
    assert_eq!(refused(&asked).rule.name(), "contour");
}
