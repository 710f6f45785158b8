//! Transformations, tilted planes and patterns of the Klartext control, against the manuals' examples
//! and calculations by hand.

use crate::common::klartext::*;
use geom::Vec3;
use program::Compensation;
use toolpost_control::{Action, Orientation};

/// The points of these blocks behind a start at 0, 0, 50.
fn moves(blocks: &str) -> Vec<[f64; 3]> {
    points(&run(&format!("{START}{blocks}")))[1..].to_vec()
}

/// A cycle that drills 10 deep from 0, with clearances of 2 and 50.
const DRILL: &str =
    "CYCL DEF 200 DRILLING Q200=2 Q201=-10 Q206=100 Q202=20 Q210=0 Q203=0 Q204=50\n";

/// The places of the holes of these blocks.
fn holes(blocks: &str) -> Vec<[f64; 3]> {
    let ops = run(&format!("{START}{DRILL}{blocks}"));
    let hole =
        |op: &Action| if let Action::Hole(pose) = op { Some(pose.point.to_array()) } else { None };
    ops.iter().filter_map(hole).collect()
}

#[test]
fn a_rotation_turns_about_the_datum_and_counts_on() {
    // The manual's example: the datum at 65, 65, the same part turned by 45 degrees each time.
    let blocks = "CYCL DEF 7.0 DATUM SHIFT
CYCL DEF 7.1 X+65
CYCL DEF 7.2 Y+65
LBL 10
L X+10 Y+0 FMAX
CYCL DEF 10.0 ROTATION
CYCL DEF 10.1 IROT+45
CALL LBL 10 REP 2
CYCL DEF 10.0 ROTATION
CYCL DEF 10.1 ROT+0
CYCL DEF 7.0 DATUM SHIFT
CYCL DEF 7.1 X+0
CYCL DEF 7.2 Y+0
L X+1 Y+2 FMAX";
    let s = 50f64.sqrt();
    assert_near(
        &moves(blocks),
        &[[75.0, 65.0, 50.0], [65.0 + s, 65.0 + s, 50.0], [65.0, 75.0, 50.0], [1.0, 2.0, 50.0]],
    );
}

#[test]
fn a_mirror_turns_arcs_and_sides_round() {
    let blocks = "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nL X+10 Y+0 RL F100\nCC X+0 Y+0
C X+0 Y+10 DR+\nL Y+20 R0\nCYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1\nL IX+3";
    let ops = run(&format!("{START}{blocks}"));
    let arc = arcs(&ops)[0];
    assert_eq!(
        (arc.end.point, arc.center),
        (Vec3::new(0.0, 10.0, 50.0), Vec3::new(0.0, 0.0, 50.0))
    );
    assert_eq!(arc.normal, Vec3::NEG_Z);
    assert!(ops.contains(&Action::Compensation(Compensation::Right(None))));
    assert_near(
        &points(&ops)[1..],
        &[[-10.0, 0.0, 50.0], [0.0, 10.0, 50.0], [0.0, 20.0, 50.0], [3.0, 20.0, 50.0]],
    );
    // Both axes: half a turn, in which left stays left.
    let ops = run(&format!(
        "{START}CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X Y\nL X+10 RL F100\nCC X+0 Y+0\nC X+0 Y+10 DR+"
    ));
    assert_eq!(arcs(&ops)[0].normal, Vec3::Z);
    assert!(ops.contains(&Action::Compensation(Compensation::Left(None))));
}

#[test]
fn a_scale_multiplies_from_the_datum_or_from_its_center() {
    // TNC 406 p. 160: datum at 60, 40, factor 0.75.
    let blocks = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+60\nCYCL DEF 7.2 Y+40
CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.75\nL X+8 Y+4 Z+0 FMAX\nCC X+0 Y+0\nC X-8 Y-4 DR+ F9";
    assert_near(&moves(blocks), &[[66.0, 43.0, 0.0], [54.0, 37.0, 0.0]]);
    // TNC 640 cycles, 26: X1.4 Y0.6 about 15, 20.
    let blocks = "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X1.4 Y0.6 CCX+15 CCY+20
L X+25 Y+30 FMAX\nL X+15 Y+20 FMAX";
    assert_near(&moves(blocks), &[[29.0, 26.0, 50.0], [15.0, 20.0, 50.0]]);
    let arc = format!("{START}{blocks}\nCC X+0 Y+0\nC X+15 Y-20 DR+ F9");
    assert_eq!(refused(&arc).rule, "transformation");
}

#[test]
fn a_shift_in_one_block_says_every_axis() {
    let blocks =
        "TRANS DATUM AXIS X+10 Y+25 Z+42\nL X+1 Y+1 Z+1 FMAX\nTRANS DATUM RESET\nL IX+1 FMAX";
    assert_near(&moves(blocks), &[[11.0, 26.0, 43.0], [12.0, 26.0, 43.0]]);
    let kept = format!("{START}TRANS DATUM AXIS X+10\nTRANS DATUM AXIS Y+10");
    assert_eq!(refused(&kept).rule, "missing-word");
}

#[test]
fn what_transformations_do_to_each_other_unclearly_is_refused_when_it_moves() {
    let rotated = "CYCL DEF 7.0 D\nCYCL DEF 7.1 X+10\nCYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+90\n";
    assert_near(&moves(&format!("{rotated}L X+5 Y+0 FMAX")), &[[10.0, 5.0, 50.0]]);
    let shifted = format!("{rotated}CYCL DEF 7.0 D\nCYCL DEF 7.1 X+20\n");
    let error = refused(&format!("{START}{shifted}L X+5 Y+0 FMAX"));
    assert_eq!(error.rule, "transformation");
    // Without the rotation it is clear again; taking the shift away is clear too.
    let cleared = format!("{shifted}CYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+0\nL X+5 Y+0 FMAX");
    assert_near(&moves(&cleared), &[[25.0, 0.0, 50.0]]);
    let taken = format!("{rotated}CYCL DEF 7.0 D\nCYCL DEF 7.1 X+0\nL X+5 Y+0 FMAX");
    assert_near(&moves(&taken), &[[0.0, 5.0, 50.0]]);
    // A shift that comes after the rotation is one of the rotated coordinates.
    let inside =
        "CYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+90\nCYCL DEF 7.0 D\nCYCL DEF 7.1 X+10\nL X+5 Y+0 FMAX";
    assert_near(&moves(inside), &[[0.0, 15.0, 50.0]]);
}

#[test]
fn transformations_that_are_not_clear_are_refused() {
    for (blocks, rule) in [
        ("L X+1 RL F9\nCYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+9", "compensation"),
        ("CYCL DEF 8.0 M\nCYCL DEF 8.1 Z", "unsupported"),
        ("CYCL DEF 11.0 S\nCYCL DEF 11.1 SCL0", "cycle-parameter"),
        ("CYCL DEF 10.0 R\nCYCL DEF 10.1 X+9", "cycle-parameter"),
        ("CYCL DEF 7.0 D\nCYCL DEF 7.1 #5", "unsupported"),
        ("TRANS DATUM TABLE TABLINE1", "unsupported"),
        // The pole was that of the coordinates before.
        ("CC X+5 Y+0\nCYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+9\nC X+1 Y+0 DR+ F9", "missing-word"),
        (
            "CYCL DEF 11.0 S\nCYCL DEF 11.1 SCL2\nCYCL DEF 200 D Q200=2 Q201=-9 Q206=9 Q202=9 Q210=0 Q203=0 \
          Q204=9\nCYCL CALL",
            "transformation",
        ),
    ] {
        let error = refused(&format!("{START}{blocks}"));
        assert_eq!(error.rule, rule, "{blocks}: {error}");
    }
    let error = refused_five("CYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+9\nPLANE RESET STAY");
    assert_eq!(error.rule, "transformation");
}

/// The frame of a plane: where its unit vectors and its datum go.
fn frame(plane: &str) -> [Vec3; 3] {
    let at = "L X+0 Y+0 Z+0 R0 FMAX\nL X+1 FMAX\nL X+0 Y+1 FMAX\nL Y+0 Z+1 FMAX";
    let ops = run_five(&format!("{plane} TURN FMAX\n{at}"));
    let points: Vec<Vec3> = poses(&ops)[1..].iter().map(|pose| pose.point).collect();
    let [datum, x, y, z] = points[..] else { panic!("{points:?}") };
    [x - datum, y - datum, z - datum]
}

#[test]
fn euler_angles_turn_about_z_then_the_new_x_then_the_new_z() {
    // By hand: Z goes to (sin P sin N, -cos P sin N, cos N); with R = 0 X stays in the plane, at P.
    let (p, n) = (45f64.to_radians(), 20f64.to_radians());
    let [x, _, z] = frame("PLANE EULER EULPR45 EULNU20 EULROT0");
    assert!(z.distance(Vec3::new(p.sin() * n.sin(), -p.cos() * n.sin(), n.cos())) < 1e-12);
    assert!(x.distance(Vec3::new(p.cos(), p.sin(), 0.0)) < 1e-12);
    // A rotation of 90 makes Y of what was X.
    let [_, y, turned] = frame("PLANE EULER EULPR+45 EULNU+20 EULROT-90");
    assert!(turned.distance(z) < 1e-12 && y.distance(x) < 1e-12);
}

#[test]
fn three_points_give_a_plane_with_x_from_the_first_to_the_second() {
    // The manual's points. The normal by hand: (30, 31, 0) x (0, 41, 12.5).
    let [x, y, z] =
        frame("PLANE POINTS P1X+0 P1Y+0 P1Z+20 P2X+30 P2Y+31 P2Z+20 P3X+0 P3Y+41 P3Z+32.5");
    assert!(x.distance(Vec3::new(30.0, 31.0, 0.0).normalize()) < 1e-12);
    assert!(z.distance(Vec3::new(387.5, -375.0, 1230.0).normalize()) < 1e-12);
    assert!(y.distance(z.cross(x)) < 1e-12);
    let line = "PLANE POINTS P1X+0 P1Y+0 P1Z+0 P2X+1 P2Y+1 P2Z+1 P3X+2 P3Y+2 P3Z+2 TURN FMAX";
    assert_eq!(refused_five(line).rule, "tilted-plane");
}

/// Cycle 19 is PLANE SPATIAL where its entries are spatial angles (iTNC 530 340 422 p. 460), and of one
/// angle where they are positions of the axes, too. Where the axes stand then is in Q120 to Q122.
#[test]
fn cycle_19_tilts_the_plane_about_one_axis() {
    let tilt = "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+30 C+0\n";
    let turn = "L B+Q121 C+Q122 R0 FMAX\n";
    let at = "L X+0 Y+0 Z+10 R0 FMAX";
    let ops = run_five(&format!("{START}{tilt}{turn}{at}"));
    let pose = *poses(&ops).last().unwrap();
    // Z of the plane goes to (sin B, 0, cos B).
    let (sin, cos) = 30f64.to_radians().sin_cos();
    assert!(pose.point.distance(Vec3::new(10.0 * sin, 0.0, 10.0 * cos)) < 1e-12);
    let stands = Orientation::Rotary { degrees: [0.0, 30.0, 0.0], tool_center: true };
    assert_eq!(pose.orientation, stands);
    // The same as by PLANE, block for block.
    let plane = "PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY\nL B+30 C+0 R0 FMAX\n";
    assert_eq!(format!("{ops:?}"), format!("{:?}", run_five(&format!("{START}{plane}{at}"))));
    // Without an angle it ends.
    let ended = format!("{tilt}{turn}CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1\n{turn}{at}");
    let pose = *poses(&run_five(&format!("{START}{ended}"))).last().unwrap();
    assert_eq!(pose.point, Vec3::new(0.0, 0.0, 10.0));
    // Whether the axes have turned is not known, nor which plane two angles mean.
    assert_eq!(refused_five(&format!("{tilt}{at}\nL X+5 F100")).rule, "unknown-position");
    let two = tilt.replace("C+0", "C+90");
    assert_eq!(refused_five(&two).rule, "unsupported");
    assert_eq!(refused_five(&tilt.replace("C+0", "F1000")).rule, "tilted-plane");
    // About an axis that the machine does not have other axes turn.
    let other = tilt.replace("A+0 B+30", "A+30");
    assert_eq!(refused_five(&format!("{other}{turn}")).rule, "parameter");
}

/// Cycle 208 by hand: a bore of 25 with a tool of 20 is a helix of 2.5; from 2 above to 8 below with 4 a turn
/// it makes two turns and a half.
#[test]
fn cycle_208_mills_a_bore_on_a_helix() {
    let cycle =
        "CYCL DEF 208 BORE MILLING Q200=2 Q201=-8 Q206=150 Q334=4 Q203=0 Q204=50 Q335=25 Q342=0";
    let ops = run_with_radius(10.0, &format!("{START}M3\n{cycle} Q351=1\nL X+1 Y+2 FMAX M99"));
    let ends: Vec<_> = poses(&ops).iter().map(|pose| pose.point.to_array()).collect();
    let expected = [
        [1.0, 2.0, 2.0],
        [3.5, 2.0, 2.0],
        [-1.5, 2.0, -8.0],
        [-1.5, 2.0, -8.0],
        [1.0, 2.0, -8.0],
        [1.0, 2.0, 50.0],
    ];
    assert_near(&ends[ends.len() - 6..], &expected);
    let ways: Vec<_> = arcs(&ops).iter().map(|arc| (arc.center.x, arc.normal, arc.turns)).collect();
    let ccw = Vec3::Z;
    assert_eq!(ways, [(2.25, ccw, 0), (1.0, ccw, 2), (1.0, ccw, 0), (-0.25, ccw, 0)]);
    assert!(ops.contains(&Action::Feed(program::Feed::PerMinute(150.0))));
    // 4.2 / 0.7 is six turns: five, what is left of the sixth, and the flat one.
    let six = cycle.replace("Q201=-8", "Q201=-2.2").replace("Q334=4", "Q334=0.7");
    let ops = run_with_radius(10.0, &format!("{START}M3\n{six}\nCYCL CALL"));
    let turns: Vec<_> = arcs(&ops).iter().map(|arc| arc.turns).collect();
    assert_eq!(turns, [0, 5, 0, 0]);
    let up_cut = run_with_radius(10.0, &format!("{START}M3\n{cycle} Q351=-1\nCYCL CALL"));
    assert!(arcs(&up_cut).iter().all(|arc| arc.normal == Vec3::NEG_Z));
    // A tool as wide as the bore goes straight down.
    let straight = run_with_radius(12.5, &format!("{START}M3\n{cycle}\nCYCL CALL"));
    assert!(arcs(&straight).is_empty());
    assert_eq!(poses(&straight).iter().rev().nth(1).unwrap().point.z, -8.0);
    // Wider than the bore, or less than half as wide, the control takes none.
    for (radius, roughed) in [(13.0, "Q342=0"), (6.0, "Q342=0"), (6.0, "Q342=30")] {
        let cycle = cycle.replace("Q342=0", roughed);
        let text = format!("{START}M3\n{cycle}\nCYCL CALL");
        let tool =
            toolpost_control::ToolData { number: 5, name: String::new(), radius, length: 9.0 };
        let setup = toolpost_control::Setup { tools: vec![tool], ..Default::default() };
        let error = read_with(setup, [false; 3], program("T", "MM", &text).as_bytes()).unwrap_err();
        assert_eq!(error.rule, "cycle-parameter", "{radius} {roughed}");
    }
    assert_eq!(refused(&format!("{START}M3\n{cycle}\nCYCL CALL")).rule, "cycle-parameter");
}

#[test]
fn a_relative_angle_turns_the_active_plane() {
    // About the tilted X by 45 after 45 about X: Z lies down to -Y.
    let [_, _, z] = frame("PLANE SPATIAL SPA+45 SPB+0 SPC+0 STAY\nPLANE RELATIV SPA+45");
    assert!(z.distance(Vec3::NEG_Y) < 1e-12);
    // About the tilted Y: first X by 90 (Y up), then 90 about that: X to -(Z tilted) = +Y.
    let [x, y, _] = frame("PLANE SPATIAL SPA+90 SPB+0 SPC+0 STAY\nPLANE RELATIV SPB+90");
    assert!(y.distance(Vec3::Z) < 1e-12 && x.distance(Vec3::Y) < 1e-12);
    for plane in ["PROJECTED PROPR+0 PROMIN+0 ROT+0", "AXIAL B+45"] {
        assert_eq!(refused_five(&format!("PLANE {plane} TURN FMAX")).rule, "unsupported");
    }
}

#[test]
fn a_rotation_in_a_tilted_plane_is_one_of_the_plane() {
    // SPA+90: the plane's Y is up. Turned by 90 in the plane, X goes there.
    let ops = run_five(
        "PLANE SPATIAL SPA+90 SPB+0 SPC+0 TURN FMAX\nCYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+90
L X+5 Y+0 R0 FMAX\nL Z+2 FMAX",
    );
    let last = ops.iter().filter_map(Action::position).next_back().unwrap();
    assert!(last.point.distance(Vec3::new(0.0, -2.0, 5.0)) < 1e-12, "{last:?}");
    assert!(last.axis().unwrap().distance(Vec3::NEG_Y) < 1e-12);
}

#[test]
fn a_pattern_on_a_circle_is_drilled_point_by_point() {
    // TNC 320 cycles p. 178: a full circle of 8 about 50, 50 with diameter 80.
    let circle = |parameters: &str| {
        format!(
            "CYCL DEF 220 PATTERN ~\n  Q216=+50 Q217=+50 Q244=80 {parameters} ~\n  Q200=2 Q203=+30 Q204=50 Q301=1 Q365=0"
        )
    };
    let found = holes(&circle("Q245=+0 Q246=+360 Q247=+0 Q241=8"));
    let expected: Vec<[f64; 3]> = (0..8)
        .map(|i| f64::from(i) * std::f64::consts::FRAC_PI_4)
        .map(|angle| [50.0 + 40.0 * angle.cos(), 50.0 + 40.0 * angle.sin(), 30.0])
        .collect();
    assert_near(&found, &expected);
    // A part of a circle has a point at both ends; a step counts before the stopping angle.
    let part = [[90.0, 50.0, 30.0], [50.0, 90.0, 30.0], [10.0, 50.0, 30.0]];
    assert_near(&holes(&circle("Q245=+0 Q246=+180 Q247=+0 Q241=3")), &part);
    assert_near(&holes(&circle("Q245=+0 Q246=+1 Q247=+90 Q241=3")), &part);
    // First to the 2nd clearance above the surface, which the pattern sets for the cycle.
    let ops = run(&format!("{START}{DRILL}{}", circle("Q245=+0 Q246=+360 Q247=+0 Q241=8")));
    assert_near(&points(&ops)[1..3], &[[0.0, 0.0, 80.0], [90.0, 50.0, 80.0]]);
    assert_eq!(cycles(&ops)[0].retract, 50.0);
}

#[test]
fn a_pattern_of_lines_goes_to_and_fro() {
    // TNC 128 p. 380 with three columns and two lines, turned by 90 degrees: columns go up.
    let lines = "CYCL DEF 221 CARTESIAN PATTERN ~\n  Q225=+15 Q226=+15 Q237=+10 Q238=+8 Q242=3 Q243=2 \
                 Q224=+90 ~\n  Q200=2 Q203=+30 Q204=50 Q301=0";
    let expected = [
        [15.0, 15.0, 30.0],
        [15.0, 25.0, 30.0],
        [15.0, 35.0, 30.0],
        [7.0, 35.0, 30.0],
        [7.0, 25.0, 30.0],
        [7.0, 15.0, 30.0],
    ];
    assert_near(&holes(lines), &expected);
    // Between the holes at the set-up clearance; where the tool ends is not said.
    let ops = run(&format!("{START}{DRILL}{lines}"));
    assert_eq!(cycles(&ops)[0].retract, 2.0);
    let error = refused(&format!("{START}{DRILL}{lines}\nL X+0 F100"));
    assert_eq!(error.rule, "unknown-position");
}

#[test]
fn a_defined_pattern_is_drilled_where_it_is_called() {
    let call = "\nCYCL CALL PAT FMAX M3\n";
    let found =
        holes(&format!("PATTERN DEF ~\n  POS1 (X+50 Y+75 Z+0) ~\n  POS2 (X+5 Y-7 Z-3){call}"));
    assert_near(&found, &[[50.0, 75.0, 0.0], [5.0, -7.0, -3.0]]);
    let found = holes(&format!("PATTERN DEF ROW1 (X+25 Y+33.5 D+8 NUM3 ROT+90 Z+0){call}"));
    assert_near(&found, &[[25.0, 33.5, 0.0], [25.0, 41.5, 0.0], [25.0, 49.5, 0.0]]);
    let found = holes(&format!(
        "PATTERN DEF PAT1 (X+0 Y+0 DX+8 DY+10 NUMX2 NUMY2 ROT+0 ROTX+0 ROTY+0 Z+0){call}"
    ));
    assert_near(&found, &[[0.0; 3], [8.0, 0.0, 0.0], [8.0, 10.0, 0.0], [0.0, 10.0, 0.0]]);
    let found = holes(&format!("PATTERN DEF CIRC1 (X+25 Y+33 D80 START+90 NUM2 Z+0){call}"));
    assert_near(&found, &[[25.0, 73.0, 0.0], [25.0, -7.0, 0.0]]);
    let found =
        holes(&format!("PATTERN DEF PITCHCIRC1 (X+0 Y+0 D20 START+0 STEP+90 NUM2 Z+0){call}"));
    assert_near(&found, &[[10.0, 0.0, 0.0], [0.0, 10.0, 0.0]]);
    // Between the points at the height of the call, or the 2nd clearance where that is higher.
    let pattern = format!("{DRILL}PATTERN DEF POS1 (X+5 Y+6 Z+0)");
    for (height, level) in [("Z+80", 80.0), ("Z+20", 50.0)] {
        let ops = run(&format!("{START}{pattern}\nL {height} FMAX{call}"));
        assert_eq!(cycles(&ops)[0].retract, level, "{height}");
    }
    for (pattern, rule) in [
        ("PATTERN DEF FRAME1 (X+0 Y+0 DX+8 DY+10 NUMX2 NUMY2 ROT+0 Z+0)", "pattern"),
        ("PATTERN DEF PAT1 (X+0 Y+0 DX+8 DY+10 NUMX2 NUMY2 ROTX+5 Z+0)", "pattern"),
        ("PATTERN DEF ROW1 (X+0 Y+0 D+8 NUM2.5 Z+0)", "pattern"),
        ("PATTERN DEF ROW1 (X+0 Y+0 NUM2 Z+0)", "pattern"),
        ("PATTERN DEF POS1 (X+0 Y+0 D+8)", "pattern"),
        ("PATTERN DEF POS1 (X+0 X+0)", "repeated-word"),
        ("PATTERN DEF POS1 (X+0 Q9)", "unknown-word"),
        ("PATTERN DEF POS1 X+0", "syntax"),
        ("PATTERN DEF", "pattern"),
        ("CYCL CALL PAT FMAX", "cycle"),
    ] {
        let error = refused(&format!("{START}{DRILL}{pattern}"));
        assert_eq!(error.rule, rule, "{pattern}: {error}");
    }
}

#[test]
fn cycles_that_mill_by_themselves_are_refused_with_a_reason() {
    for cycle in [4, 14, 210, 241, 251, 262, 13, 18, 30, 400] {
        for form in [format!("CYCL DEF {cycle} NAME"), format!("CYCL DEF {cycle}.0 NAME")] {
            let error = refused(&format!("{START}{form}"));
            assert_eq!(error.rule, "unsupported", "{form}: {error}");
            assert!(error.message.contains("not supported:"), "{error}");
        }
    }
    // Cycle 240 centers to a depth, or to a diameter, which needs the angle of the tool.
    let center =
        "CYCL DEF 240 CENTERING Q200=2 Q343=0 Q201=-2 Q344=-9 Q206=100 Q211=0 Q203=0 Q204=50";
    let ops = run(&format!("{START}{center}\nCYCL CALL"));
    assert_eq!((cycles(&ops)[0].kind, cycles(&ops)[0].depth), (program::CycleKind::Drill, 2.0));
    assert_eq!(
        refused(&format!("{START}{}", center.replace("Q343=0", "Q343=1"))).rule,
        "cycle-parameter"
    );
}

#[test]
fn the_older_hole_cycles_start_and_end_where_the_tool_stands() {
    use program::{Cycle, CycleKind, Feed};
    let at = "L X+5 Y+6 Z+2 FMAX\n";
    // TNC 407 p. 8-4: from the starting position, 2 above the surface, 15 deep by pecks of 5.
    let pecking = "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL DEF 1.2 DEPTH -15
CYCL DEF 1.3 PECKG 5\nCYCL DEF 1.4 DWELL 0.5\nCYCL DEF 1.5 F100\n";
    let ops = run(&format!("{START}{pecking}{at}CYCL CALL\nL IX+1 FMAX"));
    let expected = Cycle {
        kind: CycleKind::Deep,
        depth: 15.0,
        clearance: 2.0,
        retract: 2.0,
        feed: Some(Feed::PerMinute(100.0)),
        dwell: 0.5,
        first_peck: Some(5.0),
        peck: Some(5.0),
    };
    assert_eq!(cycles(&ops)[0], expected);
    assert_near(&points(&ops)[1..], &[[5.0, 6.0, 2.0], [5.0, 6.0, 0.0], [6.0, 6.0, 2.0]]);
    // As still older controls write it, all signs the same; and in German.
    let minus = "CYCL DEF 1.0 TIEFBOHREN\nCYCL DEF 1.1 ABST -2\nCYCL DEF 1.2 TIEFE-15
CYCL DEF 1.3 ZUSTLG-15\nCYCL DEF 1.4 V.ZEIT 0,5\nCYCL DEF 1.5 F100\n";
    let ops = run(&format!("{START}{minus}{at}L IX+0 FMAX M99"));
    let one_go = Cycle { kind: CycleKind::Drill, first_peck: None, peck: None, ..expected };
    assert_eq!(cycles(&ops)[0], one_go);
    // 1500 mm/min at 3000 1/min; the pitch of a rigid tap is given.
    for (definition, pitch, left) in [
        (
            "CYCL DEF 2.0 TAPPING\nCYCL DEF 2.1 SET UP 3\nCYCL DEF 2.2 DEPTH -20\nCYCL DEF 2.3 DWELL 0\n\
          CYCL DEF 2.4 F1500",
            0.5,
            false,
        ),
        (
            "CYCL DEF 17.0 RIGID TAPPING\nCYCL DEF 17.1 SET UP 3\nCYCL DEF 17.2 DEPTH -20\n\
          CYCL DEF 17.3 PITCH -1.25",
            1.25,
            true,
        ),
    ] {
        let cycle = cycles(&run(&format!("{START}{definition}\n{at}CYCL CALL")))[0];
        assert_eq!(cycle.kind, CycleKind::Tap { pitch, left });
        assert_eq!((cycle.depth, cycle.clearance, cycle.retract), (20.0, 3.0, 3.0));
    }
    for (blocks, rule) in [
        (pecking.replace("-15", "+15") + "CYCL CALL", "cycle-parameter"),
        (pecking.replace("F100", "F0"), "cycle-parameter"),
        (pecking.replace("CYCL DEF 1.5 F100\n", "") + "CYCL CALL", "cycle-parameter"),
        (pecking.replace("SET UP 2", "SET UP Q5"), "parameter"),
        (format!("{pecking}CYCL CALL POS X+1 Y+1 Z+1 FMAX"), "cycle"),
        (format!("{pecking}PATTERN DEF POS1 (X+1 Y+1)\nCYCL CALL PAT FMAX"), "cycle"),
    ] {
        let error = refused(&format!("{START}{blocks}"));
        assert_eq!(error.rule, rule, "{blocks}: {error}");
    }
}
