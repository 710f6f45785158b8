//! Frames and swivelled planes of the SINUMERIK virtual control, against hand calculation.

use crate::common::sinumerik::{blocks, degrees, error, near, points, poses, v};
use program::Axes;
use std::f64::consts::FRAC_1_SQRT_2;
use toolpost_control::{Action, Orientation, TiltChoice};

/// The tool axis and the point X1 Y2 Z3 in the plane of a `CYCLE800` with these arguments.
fn swivelled(arguments: &str) -> (geom::Vec3, geom::Vec3) {
    let ops = blocks(&format!("CYCLE800({arguments})\nG0 X1 Y2\nZ3"));
    let pose = *poses(&ops).last().unwrap();
    (pose.axis().unwrap(), pose.point)
}

#[test]
fn an_offset_replaces_the_last_and_an_additive_one_adds() {
    // The comments of trans_reset in the interpreter of CEAD say the same of the manual, 3.12.2.2.
    let text = "G0 X1 Y1\nTRANS X100 Y20\nX2 Y2\nTRANS X10\nX3 Y3\nTRANS\nX4 Y4\nATRANS X50\nX5 Y5\n\
                ROT\nX6 Y6";
    let expected = [(1.0, 1.0), (102.0, 22.0), (13.0, 3.0), (4.0, 4.0), (55.0, 5.0), (6.0, 6.0)];
    let found: Vec<_> = points(text).iter().map(|p| (p.x, p.y)).collect();
    assert_eq!(found, expected);
}

#[test]
fn an_offset_alone_does_not_move_but_is_travelled_by_an_incremental_word() {
    let points = points("G0 X1\nTRANS X100\nY5\nX=IC(1)\nX=IC(2)\nX=IC(3)");
    let x: Vec<_> = points.iter().map(|p| p.x).collect();
    assert_eq!(x, [1.0, 1.0, 102.0, 104.0, 107.0]);
}

#[test]
fn a_rotation_in_the_plane_turns_about_its_perpendicular() {
    near(points("ROT RPL=90\nG0 X10 Y0 Z5")[0], v(0.0, 10.0, 5.0));
    near(points("G18\nROT RPL=90\nG0 Z10 X0 Y0")[0], v(10.0, 0.0, 0.0));
    near(points("TRANS X5\nAROT RPL=90\nG0 X10 Y0 Z0")[0], v(5.0, 10.0, 0.0));
    near(points("ROT RPL=90\nATRANS X5\nG0 X10 Y0 Z0")[0], v(0.0, 15.0, 0.0));
}

#[test]
fn a_rotation_in_space_turns_about_z_then_the_new_y_then_the_new_x() {
    // X of the program: a quarter about Z takes it to Y; the quarter about X leaves it there.
    // Z of the program: a quarter about the new X (which is Y) takes it to X.
    near(points("ROT X90 Z90\nG0 X10 Y0 Z0")[0], v(0.0, 10.0, 0.0));
    near(points("ROT X90 Z90\nG0 X0 Y0 Z10")[0], v(10.0, 0.0, 0.0));
}

#[test]
fn a_rotation_of_the_frame_does_not_turn_the_tool() {
    let pose = poses(&blocks("ROT X30\nG0 X0 Y0 Z10"))[0];
    assert_eq!(degrees(&pose), ([0.0; 3], false));
    near(pose.point, v(0.0, -5.0, 10.0 * 0.75f64.sqrt()));
}

#[test]
fn what_stays_still_while_the_frame_turns_is_known_in_the_new_axes() {
    // At (10, 0, 100); in axes turned by a quarter that is (0, -10, 100).
    near(points("G0 X10\nROT RPL=90\nX3")[1], v(10.0, 3.0, 100.0));
}

#[test]
fn mode_57_turns_about_x_y_z() {
    // 30 about X: Z leans to -Y, the point goes with it.
    let (axis, point) = swivelled("1,\"\",0,57,0,0,0,30,0,0,0,0,0,1,0");
    let (sin, cos) = (0.5, 0.75f64.sqrt());
    near(axis, v(0.0, -sin, cos));
    near(point, v(1.0, 2.0 * cos - 3.0 * sin, 2.0 * sin + 3.0 * cos));
    // 90 about X, then 90 about the new Y (which is Z): Z to -Y, then to X.
    near(swivelled("0,\"\",0,57,0,0,0,90,90,0,0,0,0,-1").0, v(1.0, 0.0, 0.0));
}

#[test]
fn mode_27_turns_about_z_y_x_with_the_angles_in_that_order() {
    // 90 about Z, then 90 about the new Y (which is -X): Z to Y.
    near(swivelled("0,\"\",0,27,0,0,0,90,90,0,0,0,0,1").0, v(0.0, 1.0, 0.0));
    // 45 as the third angle is about X.
    let leaning = v(0.0, -FRAC_1_SQRT_2, FRAC_1_SQRT_2);
    near(swivelled("0,\"\",0,27,0,0,0,0,0,45,0,0,0,1").0, leaning);
}

#[test]
fn mode_39_gives_the_sides_that_a_shop_with_a_hermle_calls_them() {
    // The probing macros of a user of such a machine (rear, left, front, right).
    for (angle, axis) in [
        ("0", v(0.0, 1.0, 0.0)),
        ("90", v(-1.0, 0.0, 0.0)),
        ("180", v(0.0, -1.0, 0.0)),
        ("-90", v(1.0, 0.0, 0.0)),
    ] {
        let arguments = format!("1,\"HERMLE\",100000,39,0,0,0,{angle},-90,0,0,0,0,-1,100,1");
        near(swivelled(&arguments).0, axis);
    }
}

#[test]
fn the_plane_is_moved_before_and_after_its_rotation() {
    // To (10, 20, 30), a quarter about X (Y to Z, Z to -Y), then (1, 2, 3) in the turned axes.
    let (_, point) = swivelled("0,\"\",0,57,10,20,30,90,0,0,1,2,3,1");
    near(point, v(10.0 + 2.0, 20.0 - 6.0, 30.0 + 4.0));
}

#[test]
fn an_additive_plane_turns_in_the_axes_of_the_last() {
    let text =
        "CYCLE800(0,\"\",0,57,0,0,0,90,0,0,0,0,0,1)\nCYCLE800(0,\"\",1,57,0,0,0,0,90,0,0,0,0,1)";
    let ops = blocks(&format!("{text}\nG0 X0 Y0\nZ1"));
    near(poses(&ops)[0].axis().unwrap(), v(1.0, 0.0, 0.0));
}

/// Operating manual *Milling*, "Swivel plane (CYCLE800)": "new" deletes programmed frames, "additive" takes them into the swivel frame.
#[test]
fn a_plane_is_not_swivelled_while_a_programmable_frame_is_active() {
    let new = "CYCLE800(0,\"\",0,57,0,0,0,0,-30,0,0,0,-5,1)";
    let additive = new.replace("\"\",0", "\"\",1");
    for frame in [
        "TRANS Z5",
        "ATRANS X1",
        "ROT Z90",
        "AROT RPL=10",
        "SCALE X2 Y2 Z2",
        "MIRROR X0",
        "G58 X5",
        "G59 X5",
    ] {
        for cycle in [new, &additive, "CYCLE800()", "CYCLE800(0,\"0\")"] {
            let found = error(&format!("{frame}\n{cycle}"));
            assert_eq!((found.rule.name(), found.line), ("tilted-plane", 2), "{frame} {cycle}");
            assert!(found.help.contains("TRANS alone"), "{found}");
        }
    }
    // Deleted before, or written in the plane.
    let in_plane =
        blocks(&format!("TRANS Z5\nTRANS\n{new}\nTRANS X2\nG0 X1 Y2\nZ3\nTRANS\nCYCLE800()"));
    near(poses(&in_plane).last().unwrap().point, swivelled_at(new, v(3.0, 2.0, 3.0)));
    let between = format!("{new}\nATRANS Z5\n{additive}");
    assert_eq!(error(&between).rule.name(), "tilted-plane");
}

/// Where a point of the plane of this `CYCLE800` is.
fn swivelled_at(cycle: &str, at: geom::Vec3) -> geom::Vec3 {
    poses(&blocks(&format!("{cycle}\nG0 X{} Y{}\nZ{}", at.x, at.y, at.z))).last().unwrap().point
}

/// The machine's builder says where `CYCLE800()` leaves the axes, also where no plane was swivelled. Rotary axes stay then.
#[test]
fn behind_the_end_of_swivelling_nothing_is_known_of_the_position() {
    for end in ["CYCLE800()", "CYCLE800(0,\"0\")", "TRAORI\nG0 X0 Y0 Z5\nCYCLE800()"] {
        let poses = poses(&blocks(&format!("{end}\nG1 X10")));
        let last = poses.last().unwrap();
        assert!(last.point.x == 10.0 && last.point.y.is_nan() && last.point.z.is_nan(), "{end}");
        assert_eq!(degrees(last).0[0], 0.0, "{end}");
    }
}

/// Hundred thousands of `_ST` are the direction as `_DIR` has it, 1 minus and 2 plus; `_DMODE` 1 is G17.
#[test]
fn the_status_of_a_swivelled_plane_may_say_its_direction_and_the_plane() {
    let plain = swivelled("1,\"\",0,57,0,0,0,30,0,0,0,0,0,1");
    for arguments in [
        "1,\"\",200000,57,0,0,0,30,0,0,0,0,0,1,100,1",
        "1,\"\",200010,57,0,0,0,30,0,0,0,0,0,1,,0",
        "1,\"\",100000,57,0,0,0,30,0,0,0,0,0,-1,100,1",
        "1,\"\",100011,57,0,0,0,30,0,0,0,0,0,-1",
    ] {
        assert_eq!(swivelled(arguments), plain, "{arguments}");
    }
}

#[test]
fn swivelling_lifts_as_asked_and_makes_the_position_unknown() {
    let ops =
        blocks("CYCLE800(1,\"\",0,57,0,0,0,0,0,0,0,0,0,1)\nG0 X1\nG0 Y2\nG0 Z3\nCYCLE800()\nG0 X1");
    assert_eq!(ops[0], Action::Home(Axes::Z));
    let poses = poses(&ops);
    assert!(poses[0].point.x == 1.0 && poses[0].point.y.is_nan());
    near(poses[1].point, v(1.0, 2.0, 3.0));
    assert!(matches!(poses[2].orientation, Orientation::Rotary { .. }));
    assert!(degrees(&poses[2]).0[0].is_nan() && poses[2].point.y.is_nan());
    let all = blocks("CYCLE800(2,\"\",0,57,0,0,0,10,0,0,0,0,0,1)");
    assert_eq!(all[0], Action::Home(Axes::LINEAR));
}

#[test]
fn x_and_y_of_a_swivelled_plane_are_known_before_its_z_is() {
    let ops = blocks("CYCLE800(0,\"\",0,57,0,0,5,90,0,0,0,0,0,1)\nG0 X1\nY2\nZ3");
    // The plane's Y is Z of the work, its Z is -Y; X alone says nothing of the line along the tool.
    let Some(Action::Across(over)) = ops.iter().find(|op| matches!(op, Action::Across(_))) else {
        panic!("{ops:?}")
    };
    near(over.point, v(1.0, 0.0, 7.0));
    near(over.axis().unwrap(), v(0.0, -1.0, 0.0));
    near(poses(&ops)[1].point, v(1.0, -3.0, 7.0));
}

#[test]
fn an_arc_in_a_swivelled_plane_lies_in_that_plane() {
    let ops =
        blocks("CYCLE800(0,\"\",0,57,0,0,0,90,0,0,0,0,0,1)\nG0 X0 Y0\nZ0\nG2 X20 Y0 I10 J0 F100");
    let Some(Action::Arc(arc)) = ops.iter().find(|op| matches!(op, Action::Arc(_))) else {
        panic!()
    };
    near(arc.center, v(10.0, 0.0, 0.0));
    // -Z of the plane is +Y of the work frame.
    near(arc.normal, v(0.0, 1.0, 0.0));
}

/// Operating manual, "Direction (minus/plus)": the lower or the higher position of the axis of the swivel data set.
#[test]
fn the_direction_of_cycle800_chooses_the_solution() {
    for (direction, is_higher) in [(-1, false), (1, true)] {
        let ops = blocks(&format!("CYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,{direction},0)"));
        let chosen = Action::Swivel(TiltChoice::Higher(is_higher));
        assert!(ops.contains(&chosen), "{direction}: {ops:?}");
    }
}

#[test]
fn increments_behind_a_rotation_count_where_it_leaves_the_coordinates_alone() {
    // The tool stands in the pole of the rotation, and Z is the axis that it turns about.
    let cos = std::f64::consts::FRAC_1_SQRT_2;
    near(points("G0 X0 Y0 Z5\nROT RPL=45\nG91 X10")[1], v(10.0 * cos, 10.0 * cos, 5.0));
    near(points("TRANS X20\nG0 X0 Y0 Z5\nAROT RPL=90\nG91 X10 Z-2")[1], v(20.0, 10.0, 3.0));
    near(points("G0 X0 Y0 Z5\nROT RPL=45\nX=IC(10)")[1], v(10.0 * cos, 10.0 * cos, 5.0));
    // Elsewhere it is not documented from where they count.
    let found = error("G0 X10 Y0 Z5\nROT RPL=45\nG91 X10");
    assert_eq!((found.rule.name(), found.line), ("unknown-position", 3));
    assert!(found.help.contains("absolute"), "{found}");
    // Behind a mirror Y stays what it is.
    near(points("G0 X10 Y3 Z5\nMIRROR X0\nG91 Y2")[1], v(10.0, 5.0, 5.0));
    assert_eq!(error("G0 X10 Y3 Z5\nMIRROR X0\nG91 X2").rule.name(), "unknown-position");
}

/// Function manual K2 09/2011 p. 791: they delete the rotations of the frames by which a swivelled plane may be made. Without a plane they delete nothing.
#[test]
fn frames_of_part_and_tool_are_not_deleted_in_a_swivelled_plane() {
    let plane = "CYCLE800(0,\"\",0,57,0,0,0,-30,0,0,0,0,0,1)\nG0 X1 Y2\nZ3";
    for word in ["PAROTOF", "TOROTOF"] {
        let found = error(&format!("{plane}\n{word}\nX4"));
        assert_eq!(found.rule, program::Rule::TiltedPlane, "{word}");
        assert!(found.message.contains("PAROTOF"), "{}", found.message);
        blocks(&format!("{word}\n{plane}\nX4\nCYCLE800()\n{word}\nG0 X1 Y2"));
    }
}
