//! ISO code of wire-EDM machines.

use geom::Vec3;
use program::{Compensation, Diagnostic, Feed, Purpose};
use toolpost_control::{Action, ArcTo, Dialect, Position, Settings, Setup, Wire};

fn run(dialect: Dialect, text: &str, height: Option<f64>) -> Result<Vec<Action>, Box<Diagnostic>> {
    let wire = Wire { height, thread: Some(60), cut: Some(50) };
    let setup = Setup { purpose: Purpose::Contour, ..Setup::default() };
    let settings = Settings { wire, setup, ..Settings::new(dialect, [false; 3]) };
    crate::common::ops(&settings, "part.nc", text)
}

fn at(x: f64, y: f64) -> Position {
    Position::new(Vec3::new(x, y, 0.0), Vec3::Z)
}

/// Nothing names Z, and no feed: the wire has none.
#[test]
fn a_die_with_the_controls_offset() {
    let text = "%\nO1\nN1 G21 G90 G40 G50 G92 X0 Y0\nN2 M60\nN3 G41 D1 S2 G1 X10.\n\
                N4 G3 X0. Y10. I-10. J0.\nN5 G1 G40 X0. Y0.\nN6 M50\nN7 M2\n%\n";
    let arc = ArcTo { end: at(0.0, 10.0), center: Vec3::ZERO, normal: Vec3::Z, turns: 0 };
    let expected = [
        Action::Rapid(at(0.0, 0.0)),
        Action::ThreadWire,
        Action::Compensation(Compensation::Left(Some(1))),
        Action::Line(at(10.0, 0.0)),
        Action::Arc(Box::new(arc)),
        Action::Compensation(Compensation::Off),
        Action::Line(at(0.0, 0.0)),
        Action::CutWire,
        Action::End,
    ];
    assert_eq!(run(Dialect::FanucWire, text, None).unwrap(), expected);
}

#[test]
fn u_and_v_count_at_the_upper_plane_and_stay() {
    let text = "G21 G90 G0 X1. Y2. U3.\nM60\nG1 X5. F6.\nU0. V-4.\nG91 V4. X1.\nM50\nG90\nM30\n";
    // 3-4-5, and 45 degrees.
    let (half, point) = (0.5f64.sqrt(), |x: f64, y: f64| Vec3::new(x, y, 0.0));
    let over = |x: f64, y: f64| Position::new(point(x, y), Vec3::new(0.6, 0.0, 0.8));
    let back = |x: f64, y: f64| Position::new(point(x, y), Vec3::new(0.0, -half, half));
    let expected = [
        Action::Rapid(over(1.0, 2.0)),
        Action::ThreadWire,
        Action::Feed(Feed::PerMinute(6.0)),
        Action::Line(over(5.0, 2.0)),
        Action::Line(back(5.0, 2.0)),
        Action::Line(at(6.0, 2.0)),
        Action::CutWire,
        Action::End,
    ];
    let ops = run(Dialect::FanucWire, text, Some(4.0)).unwrap();
    assert_eq!(ops.len(), expected.len());
    for (op, expected) in ops.iter().zip(&expected) {
        match (op.position(), expected.position()) {
            (Some(pose), Some(wanted)) => {
                assert_eq!(pose.point, wanted.point);
                assert!(pose.axis().unwrap().distance(wanted.axis().unwrap()) < 1e-15);
            }
            _ => assert_eq!(op, expected),
        }
    }
}

#[test]
fn the_control_leans_the_wire_to_either_side_of_its_way() {
    let text = |left: &str, right: &str| {
        format!("G21 G90 G0 X0. Y0.\nM60\nG51 {left} G1 X5.\nG52 {right} Y5.\nG50 X0.\nM50\n")
    };
    let tapers = |dialect, text: &str| -> Vec<f64> {
        let ops = run(dialect, text, None).unwrap();
        ops.iter()
            .filter_map(|op| if let Action::Taper(a) = op { Some(*a) } else { None })
            .collect()
    };
    assert_eq!(tapers(Dialect::FanucWire, &text("T1.5", "T30.")), [1.5, -30.0, 0.0]);
    assert_eq!(tapers(Dialect::Sodick, &text("A1.5", "A30.")), [1.5, -30.0, 0.0]);
    let open = text("T1.5", "T30.").replace("G50 X0.\n", "");
    assert_eq!(run(Dialect::FanucWire, &open, None).unwrap_err().rule.name(), "taper");
    let both = text("T1.5", "T30. U1.");
    assert_eq!(run(Dialect::FanucWire, &both, Some(9.0)).unwrap_err().rule.name(), "wire");
    let agie = text("T1.5", "T30.").replace("G21", "G71");
    assert_eq!(run(Dialect::Agie, &agie, None).unwrap_err().rule.name(), "unknown-word");
}

#[test]
fn each_maker_has_letters_of_its_own() {
    let offset = |dialect, text: &str| {
        let ops = run(dialect, text, None).unwrap();
        ops.into_iter()
            .find_map(|op| if let Action::Compensation(side) = op { Some(side) } else { None })
    };
    let start = "G90 G0 X0. Y0.\nM60\n";
    let sodick = format!("G21 {start}C001\nT84\nG42 H003 G1 X5.\n");
    assert_eq!(offset(Dialect::Sodick, &sodick), Some(Compensation::Right(Some(3))));
    let agie = format!("G71 {start}S5 T2 P1\nG41 D2 G1 X5.\n");
    assert_eq!(offset(Dialect::Agie, &agie), Some(Compensation::Left(Some(2))));
    let unknown = |dialect, text: &str| run(dialect, text, None).unwrap_err().rule.name();
    assert_eq!(unknown(Dialect::Sodick, &sodick.replace('H', "D")), "unknown-word");
    assert_eq!(unknown(Dialect::Agie, &agie.replace("G71", "G21")), "unknown-word");
    assert_eq!(unknown(Dialect::FanucWire, &agie), "unknown-word");
}

#[test]
fn what_a_wire_cannot_do_or_nobody_knows_is_refused() {
    let refused = |block: &str| {
        let text = format!("G21 G90 G0 X0. Y0.\nM60\n{block}\n");
        let found = run(Dialect::FanucWire, &text, None).unwrap_err();
        assert_eq!(found.line, 3, "{found}");
        found.rule.name()
    };
    assert_eq!(refused("G1 Z1."), "unknown-word");
    assert_eq!(refused("G51 G1 X1."), "taper");
    assert_eq!(refused("G52 T0. G1 X1."), "taper");
    assert_eq!(refused("G52 T90. G1 X1."), "taper");
    assert_eq!(refused("G18"), "unknown-word");
    assert_eq!(refused("M6"), "unknown-word");
    assert_eq!(refused("M3"), "unknown-word");
    assert_eq!(refused("M50 G1 X1."), "wire");
    assert_eq!(refused("M60 M50"), "modal-group");
    assert_eq!(refused("G1 X1. U1."), "upper-plane");
    assert_eq!(refused("G41 G1 X1."), "compensation");
    assert_eq!(refused("G1 X1"), "decimal-point");
    let offset = "G21 G90 G0 X0. Y0.\nM60\nG41 D1 G1 X1.\nM50\n";
    assert_eq!(run(Dialect::FanucWire, offset, None).unwrap_err().rule.name(), "compensation");
    let arc = "G21 G90 G0 X0. Y0. U1.\nM60\nG2 X10. I5. U2.\n";
    assert_eq!(run(Dialect::FanucWire, arc, Some(9.0)).unwrap_err().rule.name(), "wire");
}

/// FANUC, parameter 3410: the machine sets by how much the two radii of an arc may differ, and 0.01 mm is assumed, as on its
/// mills. A thousandth of the radius, as GRBL has it, is no rule of these controls.
#[test]
fn an_arc_whose_radii_differ_by_more_than_a_hundredth_is_refused() {
    for dialect in [Dialect::FanucWire, Dialect::Sodick, Dialect::Agie] {
        let units = if dialect == Dialect::Agie { "G71" } else { "G21" };
        let arc = |end: &str| {
            let text = format!("{units} G90 G0 X0. Y0.\nM60\nG2 X{end} Y0. I200. J0.\nM50\nM2\n");
            run(dialect, &text, None).map(|_| ()).map_err(|error| error.rule.name())
        };
        assert_eq!(arc("400."), Ok(()), "{dialect:?}");
        assert_eq!(arc("400.008"), Ok(()), "{dialect:?}");
        assert_eq!(arc("400.15"), Err("arc"), "{dialect:?}");
    }
}
