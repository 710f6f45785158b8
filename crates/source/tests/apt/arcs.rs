//! `CIRCLE` with `GOTO`, and `TLON`.

use crate::support::{HEAD, Z, assert_poses, at, error, ops, reading};
use geom::Vec3;
use program::{ArcTo, Op};
use toolpost_source::apt::{Dialect, Options, read};

/// `circle` after a start at `start` and before an end; its arc.
fn arc(sign: &str, start: &str, circle: &str) -> ArcTo {
    let reading = reading(&format!("{sign}\n{HEAD}{start}\n{circle}\n"));
    let arc = reading.program.records.iter().find_map(|r| match &r.op {
        Op::Arc(arc) => Some(**arc),
        _ => None,
    });
    arc.unwrap()
}

#[test]
fn the_way_an_arc_turns_is_the_habit_of_the_system() {
    let body = ("GOTO/10,0,0", "CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\nFINI");
    for (sign, dialect, normal) in [
        ("PAINT/PATH", Dialect::Nx, Vec3::NEG_Z),
        ("PPRINT/APTCL-SPEC,MAKINO-FF,1", Dialect::Makino, Vec3::NEG_Z),
        ("CSI_SET_FLUTE_LENGTH/2.", Dialect::SolidWorksCam, Vec3::Z),
        ("$$* Pro/CLfile", Dialect::Creo, Vec3::Z),
        ("$$ ", Dialect::Iso, Vec3::Z),
    ] {
        assert_eq!(arc(sign, body.0, body.1).circle.normal(), normal, "{dialect}");
        let whole = reading(&format!("{sign}\n{HEAD}{}\n{}\n", body.0, body.1));
        assert_eq!(whole.dialect, dialect);
        // Where no source says how, that is said.
        let doubt = whole.warnings.iter().any(|w| w.rule.name() == "arc-direction");
        assert_eq!(doubt, dialect == Dialect::Iso, "{dialect}");
    }
}

#[test]
fn the_path_is_held_against_the_habit() {
    // Straight along +Y into a quarter that goes on to -X: counter-clockwise about +Z.
    let path = |k: i32| {
        format!("GOTO/10,-5,0\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,{k},10\nGOTO/0,10,0\nGOTO/-5,10,0")
    };
    let right = reading(&format!("{HEAD}{}\nFINI", path(1)));
    assert!(right.warnings.is_empty());
    assert_eq!(error(&path(-1)), "arc-direction");
    let nx = format!("PAINT/PATH\n{HEAD}{}\n", path(1));
    assert_eq!(
        read("a.cls", nx.as_bytes(), &Options::default()).unwrap_err()[0].rule.name(),
        "arc-direction"
    );
    // One of three: a warning that names its line.
    let mixed = format!("{HEAD}{}\n{}\n{}\nFINI", path(1), path(1), path(-1));
    let warnings = reading(&mixed).warnings;
    assert_eq!((warnings[0].rule.name(), warnings[0].line), ("arc-direction", 18));
    assert!(warnings[0].excerpt.starts_with("GOTO/0,10,0\n^"));
}

/// In the plane of X and Z: down to X0 Z0, then a quarter about X10 Z0 up to X10 Z10. The other way round it would go on down, three quarters.
#[test]
fn a_short_arc_that_rises_out_of_a_plunge_is_read_as_it_stands() {
    let plunge = "GOTO/0,0,5\nGOTO/0,0,0\n";
    let after = "\nRAPID\nGOTO/10,0,30";
    let quarter = |k: i32| format!("CIRCLE/10,0,0,0,{k},0,10\nGOTO/10,0,10");
    let whole = reading(&format!("{HEAD}{plunge}{}{after}\nFINI", quarter(1)));
    assert!(whole.program.records.iter().any(|record| matches!(record.op, Op::Arc(_))));
    // The long way goes on smoothly, down and around.
    reading(&format!("{HEAD}{plunge}{}{after}\nFINI", quarter(-1)));
    // What goes up by the long way, out of the plunge, and is short the other way round: its direction is wrong.
    let long = |k: i32| format!("{plunge}CIRCLE/10,0,0,0,{k},0,10\nGOTO/10,0,-10{after}");
    assert_eq!(error(&long(1)), "arc-direction");
    reading(&format!("{HEAD}{}\nFINI", long(-1)));
    // With a cut behind it that it reverses too, also a short one is.
    let behind = format!("{plunge}{}\nGOTO/0,0,10{after}", quarter(1));
    assert_eq!(error(&behind), "arc-direction");
    // In the plane of the cut as ever: straight along +Y and back.
    let level =
        "GOTO/10,-5,0\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,-1,10\nGOTO/0,-10,0\nRAPID\nGOTO/0,-10,30";
    assert_eq!(error(level), "arc-direction");
}

#[test]
fn arcs_lie_in_any_plane_and_go_round_as_often_as_asked() {
    let creo = "$$* Pro/CLfile";
    let side = arc(creo, "GOTO/0,10,5", "CIRCLE/0,0,5,1,0,0,10\nGOTO/0,0,15\nFINI");
    assert_eq!(
        (side.circle.normal(), side.circle.center(), side.circle.turns()),
        (Vec3::X, Vec3::new(0., 0., 5.), 0)
    );
    let full = arc(creo, "GOTO/10,0,0", "CIRCLE/0,0,0,0,0,-2,10\nGOTO/10,0,0\nFINI");
    assert_eq!(
        (full.circle.normal(), full.end, full.circle.turns()),
        (Vec3::NEG_Z, at(10., 0., 0.), 0)
    );
    let helix = arc(creo, "GOTO/10,0,0", "CIRCLE/0,0,0,0,0,1,10,TIMES,3\nGOTO/10,0,-6\nFINI");
    assert_eq!((helix.end, helix.circle.turns()), (at(10., 0., -6.), 2));
    let canon = arc(creo, "GOTO/10,0,0", "CIRCLE/CANON,0,0,0,0,0,1,10\nGOTO/0,10,0\nFINI");
    assert_eq!(canon.circle.normal(), Vec3::Z);
    let other_records = "CIRCLE/0,0,0,0,0,1,10\nPAINT/COLOR,1\nFEDRAT/5,MMPM\nGOTO/0,10,0\nFINI";
    assert_eq!(arc("PAINT/PATH", "GOTO/10,0,0", other_records).end, at(0., 10., 0.));
    let inches = arc(creo, "UNITS/INCHES\nGOTO/1,0,0", "CIRCLE/0,0,0,0,0,1,1\nGOTO/0,1,0\nFINI");
    assert_eq!(inches.end, at(0., 25.4, 0.));
}

#[test]
fn an_arc_that_is_none_is_refused() {
    for (text, rule) in [
        ("CIRCLE/0,0,0,0,0,1,10", "circle-without-goto"),
        ("CIRCLE/0,0,0,0,0,1,10\nRAPID\nGOTO/0,10,0", "circle-without-goto"),
        ("CIRCLE/0,0,0,0,0,1,10\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0", "circle-without-goto"),
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10.006,0", "off-the-circle"),
        ("CIRCLE/0,0,0,0,0,1,10.1\nGOTO/0,10,0", "off-the-circle"),
        ("CIRCLE/10,0,0,0,0,1,10\nGOTO/0,10,0", "off-the-circle"),
        ("CIRCLE/0,0,0,0,0,0,10\nGOTO/0,10,0", "zero-vector"),
        ("CIRCLE/0,0,0,0,0\nGOTO/0,10,0", "malformed"),
        ("CIRCLE/0,0,0,0,0,1,10,TIMES,2\nGOTO/0,10,0", "unsupported"),
        ("CIRCLE/0,0,0,0,0,1,10,TIMES,1.5\nGOTO/10,0,0", "malformed"),
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0,0,1,1", "unsupported"),
        ("RAPID\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0", "unsupported"),
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/10,-.001,0", "arc-chord"),
    ] {
        assert_eq!(error(&format!("GOTO/10,0,0\n{text}")), rule, "{text}");
    }
    assert_eq!(error("CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0"), "no-start");
    let radii = format!("{HEAD}GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,10.5,0\nFINI");
    let errors = read("r.apt", radii.as_bytes(), &Options::default()).unwrap_err();
    assert!(errors[0].message.contains("10.0000") && errors[0].message.contains("10.5000"));
    assert_eq!((errors[0].line, errors[0].column), (7, 6));
}

#[test]
fn creo_lists_the_points_of_an_arc_line_by_line() {
    let head = format!("$$* Pro/CLfile\n{HEAD}GOTO / 10,0,0\nCIRCLE / 0,0,0,0,0,1,10\n");
    let many = reading(&format!("{head}GOTO / 0,10,0\n-10,0,0\n0,-10,0\nFINI"));
    let arcs: Vec<&ArcTo> = many
        .program
        .records
        .iter()
        .filter_map(|r| match &r.op {
            Op::Arc(arc) => Some(&**arc),
            _ => None,
        })
        .collect();
    assert_eq!((arcs.len(), arcs[0].end), (1, at(0., -10., 0.)));
    let wrong = |points: &str| {
        read("c.ncl", format!("{head}{points}\nFINI").as_bytes(), &Options::default()).unwrap_err()
            [0]
        .rule
        .name()
    };
    assert_eq!(wrong("GOTO / -10,0,0\n0,10,0"), "arc-direction");
    assert_eq!(wrong("GOTO / 0,10,0\nGOTO / -10,0,0"), "arc-points");
    // A half circle and its diameter.
    let closed = reading(&format!("{head}GOTO / -10,0,0\nGOTO / 10,0,0\nFINI"));
    assert_eq!(closed.program.records[5].op, Op::Line(at(10., 0., 0.)));
    assert_eq!(
        closed.warnings.iter().map(|w| (w.rule.name(), w.line)).collect::<Vec<_>>(),
        [("arc-points", 9)]
    );
    assert_eq!(error("1,2,3"), "malformed");
    assert_poses(&ops("GOTO/1,2,3\n4,5,6"), &[([1., 2., 3.], Z), ([4., 5., 6.], Z)]);
}

#[test]
fn tlon_turns_the_way_indirv_points_in_any_plane() {
    let tlon = |towards: &str, plane: &str| {
        format!("GOTO/10,0,0\nINDIRV/{towards}\nTLON,GOFWD/ (CIRCLE/ 0,0,0,$\n10),{plane}")
    };
    let normal = |text: &str| match ops(text).last() {
        Some(Op::Arc(arc)) => arc.circle.normal(),
        op => panic!("{op:?}"),
    };
    assert_eq!(normal(&tlon("0,1,0", "ON,(LINE/0,0,0,0,10,0)")), Vec3::Z);
    assert_eq!(normal(&tlon("0,-1,0", "ON,(LINE/0,0,0,0,10,0)")), Vec3::NEG_Z);
    assert_eq!(normal(&tlon("0,0,1", "ON,(LINE/0,0,0,0,0,10)")), Vec3::NEG_Y);
    assert_eq!(normal(&tlon("0,1,0", "ON,2,INTOF,(LINE/0,0,0,0,-10,0)")), Vec3::Z);
    for (text, rule) in [
        (
            format!("GOTO/10,0,0\nRAPID\n{}", &tlon("0,1,0", "ON,(LINE/0,0,0,0,10,0)")[12..]),
            "unsupported",
        ),
        (tlon("0,1,0\nGOTO/10,0,0", "ON,(LINE/0,0,0,0,10,0)"), "no-start"),
        (tlon("1,0,0", "ON,(LINE/0,0,0,0,10,0)"), "zero-vector"),
        (tlon("1,1,0", "ON,(LINE/0,0,0,0,10,0)"), "arc-direction"),
        (tlon("0,1,0", "ON,(LINE/0,0,0,0,11,0)"), "off-the-circle"),
        (tlon("0,1,0", "TO,(LINE/0,0,0,0,10,0)"), "unsupported"),
        (tlon("0,1,0", "ON,(LINE/0,0,0,0,10,0"), "malformed"),
        ("GOTO/1,0,0\nTLON,GOFWD/(CIRCLE/0,0,0,1),ON,(LINE/0,0,0,0,1,0)".into(), "no-start"),
    ] {
        assert_eq!(error(&text), rule, "{text}");
    }
}
