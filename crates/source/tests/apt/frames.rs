//! Units, frames, origins and shifts.

use crate::support::{HEAD, Z, assert_poses, error, ops, reading};
use geom::Vec3;
use program::Op;
use toolpost_source::apt::{Csys, Dialect, Options, Reading, SetUps, read};

#[test]
fn frames_are_resolved_relative_to_the_first() {
    let msys = |values: &str| format!("MSYS/{values}\n");
    let first = msys("100,0,0,1,0,0,0,1,0");
    // Turned by a quarter about Z, and 10 further along X.
    let second = msys("110,0,0,0,1,0,-1,0,0");
    let text = format!("{first}GOTO/1,2,3\n{second}GOTO/1,2,3\n{first}GOTO/1,2,3");
    let whole = reading(&format!("{HEAD}{text}\n"));
    assert_eq!(whole.dialect, Dialect::Nx);
    let ops: Vec<Op> = whole.program.records.into_iter().map(|r| r.op).collect();
    assert_poses(&ops, &[([1., 2., 3.], Z), ([10. - 2., 1., 3.], Z), ([1., 2., 3.], Z)]);
    let frames: Vec<Vec3> = ops
        .iter()
        .filter_map(|op| match op {
            Op::Frame(frame) => Some(frame.matrix3.x_axis),
            _ => None,
        })
        .collect();
    assert_eq!(frames, [Vec3::Y, Vec3::X]);
    // On its side: Z of the set-up is X of the work frame, and the tool stands along it.
    let side = msys("0,0,0,0,1,0,0,0,1");
    let text =
        format!("{}GOTO/0,0,0\n{side}GOTO/1,2,3\nGOTO/1,2,3,1,0,0", msys("0,0,0,1,0,0,0,1,0"));
    let ops: Vec<Op> =
        reading(&format!("{HEAD}{text}\n")).program.records.into_iter().map(|r| r.op).collect();
    let x = [1., 0., 0.];
    assert_poses(&ops, &[([0.; 3], Z), ([3., 1., 2.], x), ([3., 1., 2.], [0., 1., 0.])]);
    assert_eq!(error("MSYS/0,0,0,1,0,0,1,0,0"), "frame");
    assert_eq!(error("MSYS/0,0,0,1,0,0,0,2,0"), "frame");
}

#[test]
fn origins_shifts_inches_and_axes_are_resolved() {
    for (text, poses) in [
        ("ORIGIN/1,2,3\nGOTO/1,2,3", vec![([0.; 3], Z)]),
        ("TRANS/1,2,3\nGOTO/1,2,3", vec![([2., 4., 6.], Z)]),
        ("TRANS/1,2,3\nORIGIN/1,0,0\nGOTO/0,0,0", vec![([0., 2., 3.], Z)]),
        ("UNITS/INCHES\nTRANS/0,0,1\nGOTO/1,0,0", vec![([25.4, 0., 25.4], Z)]),
        (
            "TRANS/5,0,0\nGOTO/1,0,0\nTRANS/0,0,0\nGOTO/,7,0",
            vec![([6., 0., 0.], Z), ([6., 7., 0.], Z)],
        ),
        ("TLAXIS/0,3,4\nGOTO/1,2,3", vec![([1., 2., 3.], [0., 0.6, 0.8])]),
        (
            "GOTO/1,2,3,1,0,0\nMULTAX/OFF\nGOTO/1,2,3",
            vec![([1., 2., 3.], [1., 0., 0.]), ([1., 2., 3.], Z)],
        ),
        ("MULTAX/ON\nGOTO/1,2,3,1,0,0", vec![([1., 2., 3.], [1., 0., 0.])]),
        ("ROTATE/TABLE,ATANGL,0\nMODE/ABSOL\nGOTO/1,2,3", vec![([1., 2., 3.], Z)]),
    ] {
        assert_poses(&ops(text), &poses);
    }
    for (text, rule) in [
        ("ORIGIN/0,0,0,1,0,0,0,0,1", "malformed"),
        ("UNITS/FURLONG", "unknown-unit"),
        ("ROTATE/TABLE,ATANGL,90", "unsupported"),
        ("ROTATE/TABLE,INCR,0,0", "unsupported"),
        ("MODE/INCR", "unsupported"),
        ("ROTABL/ATANGL,90", "unsupported"),
        ("HEAD/2", "unsupported"),
        ("TRACUT/A", "unsupported"),
        ("GOHOME", "unsupported"),
        ("TRNTYP/LOCAL,0,0,0", "frame"),
        ("TRNTYP/WORLD,0,0,5", "frame"),
        ("CSYS/0,0,1,0,0,1,0,0,-1,0,0,0", "frame"),
        ("TRNTYP/WORLD\nCSYS/1,0,0,0,0,1,0,0,0,0,-1,0", "frame"),
        // Without TRNTYP/WORLD nothing says where the second set-up stands.
        ("CSYS/1,0,0,0,0,1,0,0,0,0,1,0\nCSYS/1,0,0,5,0,1,0,0,0,0,1,0", "frame"),
    ] {
        assert_eq!(error(text), rule, "{text}");
    }
}

#[test]
fn a_rotary_axis_or_another_head_is_refused_with_the_reason_and_the_way_out() {
    for (text, reason, way_out) in [
        ("ROTATE/TABLE,90", "ROTATE turns a rotary axis", "tool-axis vectors"),
        ("ROTHED/AAXIS,ATANGL,30", "ROTHED turns a rotary axis", "tool-axis vectors"),
        ("HEAD/2", "another head", "file of its own"),
    ] {
        let whole = format!("{HEAD}{text}\nGOTO/1,2,3\nFINI");
        let error = read("r.apt", whole.as_bytes(), &Options::default()).unwrap_err().remove(0);
        assert_eq!((error.rule.name(), error.line, error.column), ("unsupported", 5, 1), "{text}");
        assert!(error.message.contains(reason) && error.help.contains(way_out), "{error}");
    }
}

#[test]
fn creo_gives_its_tool_and_its_coordinate_system_in_directives() {
    let system = |x: &str| {
        format!("$$-> CSYS / {x}, 0.0, 0.0, 0.0, $\n 0.0, 1.0, 0.0, 0.0, $\n 0.0, 0.0, 1.0, 0.0\n")
    };
    let head = "$$* Pro/CLfile  Version Creo\n$$-> MFGNO / MFG0001\n$$-> FEATNO / 4 2 B\n";
    let same = format!(
        "{head}{HEAD}$$-> CUTTER / 12.5\n{}GOTO/1,2,3\n{}GOTO/4,5,6\nFINI",
        system("1.0"),
        system("1.0")
    );
    let whole = reading(&same);
    assert!(whole.warnings.is_empty(), "{}", whole.warnings[0]);
    let ops: Vec<Op> = whole.program.records.into_iter().map(|r| r.op).collect();
    assert_poses(&ops, &[([1., 2., 3.], Z), ([4., 5., 6.], Z)]);
    assert!(matches!(&ops[0], Op::Tool(tool) if tool.diameter == Some(12.5)));
    let other = format!("{}GOTO/1,2,3\n{}", system("1.0"), system("-1.0"));
    assert_eq!(error(&other), "frame");
}

#[test]
fn catia_locks_the_tool_axis_where_multi_axis_output_ends() {
    let text = format!(
        "$$ Start generation of : Sweeping.1\n{HEAD}MULTAX/ON\nGOTO/1,2,3,0,-.6,.8\nMULTAX/OFF\n\
         GOTO/4,5,6\nFINI"
    );
    let ops: Vec<Op> = reading(&text).program.records.into_iter().map(|r| r.op).collect();
    assert_poses(&ops, &[([1., 2., 3.], [0., -0.6, 0.8]), ([4., 5., 6.], [0., -0.6, 0.8])]);
}

#[test]
fn catia_gives_its_axis_system_in_remarks() {
    let system = |rows: &str| format!("$$*CATIA0\n$$ Axis.1\n{rows}");
    let first = system("$$ 1.0 0.0 0.0 50.0\n$$ 0.0 1.0 0.0 0.0\n$$ 0.0 0.0 1.0 0.0\n");
    let turned = system("$$ 0.0 -1.0 0.0 50.0\n$$ 1.0 0.0 0.0 0.0\n$$ 0.0 0.0 1.0 7.0\n");
    let whole = reading(&format!("{first}{HEAD}GOTO/1,2,3\n{turned}GOTO/1,2,3\nFINI"));
    assert_eq!(whole.dialect, Dialect::Catia);
    let ops: Vec<Op> = whole.program.records.into_iter().map(|r| r.op).collect();
    assert_poses(&ops, &[([1., 2., 3.], Z), ([-2., 1., 10.], Z)]);
    assert!(!ops.iter().any(|op| matches!(op, Op::Comment(_))));
}

/// Two set-ups of a block of 100 x 40 mm, whose second origin is 60 mm further and turned a quarter: each drills two
/// holes 10 and 30 mm behind its own origin, in the world.
const TWO_SET_UPS: &str = "TRNTYP/WORLD,0,0,0\nCSYS/1,0,0,0,0,1,0,0,0,0,1,0\nGOTO/10,5,0\nGOTO/30,5,0\n\
                           TRNTYP/WORLD,0,0,0\nCSYS/0,-1,0,60,1,0,0,5,0,0,1,0\nGOTO/60,15,0\nGOTO/60,35,0";

fn read_in(csys: Option<Csys>, body: &str) -> Result<Reading, Vec<program::Diagnostic>> {
    let options = Options { csys, ..Options::default() };
    read("s.apt", format!("{HEAD}{body}\nFINI\n").as_bytes(), &options)
}

fn points(reading: &Reading) -> Vec<[f64; 3]> {
    let poses = reading.program.records.iter().filter_map(|record| record.op.pose());
    poses.map(|pose| pose.point().to_array().map(|value| (value * 1e6).round() / 1e6)).collect()
}

#[test]
fn several_origins_are_read_in_the_world_unless_somebody_says_otherwise() {
    let world = [[10., 5., 0.], [30., 5., 0.], [60., 15., 0.], [60., 35., 0.]];
    for (csys, is_given) in [(None, false), (Some(Csys::World), true)] {
        let reading = read_in(csys, TWO_SET_UPS).unwrap();
        assert_eq!(points(&reading), world);
        assert_eq!(reading.set_ups, Some(SetUps { csys: Csys::World, is_given, changes: 1 }));
    }
    // In the frame of the second, 10 mm along its X is 10 mm along Y of the first.
    let local = TWO_SET_UPS.replace("60,15,0", "10,0,0").replace("60,35,0", "30,0,0");
    let reading = read_in(Some(Csys::Local), &local).unwrap();
    assert_eq!(points(&reading), world);
    assert_eq!(reading.set_ups, Some(SetUps { csys: Csys::Local, is_given: true, changes: 1 }));
    // Origins are in the unit of the file.
    let inches = read_in(Some(Csys::Local), &format!("UNITS/INCHES\n{local}")).unwrap();
    assert_eq!(points(&inches)[2], [60.0 * 25.4, 15.0 * 25.4, 0.0]);
}

#[test]
fn where_the_coordinates_of_set_ups_stand_is_asked_where_the_file_does_not_say_it() {
    let body = TWO_SET_UPS.replace("TRNTYP/WORLD,0,0,0\n", "");
    let found = read_in(None, &body).unwrap_err().remove(0);
    assert_eq!((found.rule.name(), found.line), ("frame", 8), "{found}");
    assert!(found.help.contains("--csys local or --csys world"), "{found}");
    assert!(read_in(Some(Csys::World), &body).is_ok() && read_in(Some(Csys::Local), &body).is_ok());
    let none = read_in(Some(Csys::World), "GOTO/1,2,3").unwrap_err().remove(0);
    assert!(none.rule.name() == "frame" && none.message.contains("no CSYS"), "{none}");
}
