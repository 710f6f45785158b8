//! Boring bars that stop in position and go aside from the wall, on every control that has them.

use geom::Vec3;
use program::{Cycle, CycleKind, Op, Withdrawal};
use toolpost_control::{Dialect, Settings, read};

/// The holes of a program with their cycles and the heights of their points, on a machine whose setting
/// says `aside`; or the rule that it breaks.
fn holes(
    dialect: Dialect,
    aside: Option<Vec3>,
    text: &str,
) -> Result<Vec<(Cycle, f64)>, &'static str> {
    let mut settings = Settings::new(dialect, [false; 3]);
    settings.setup.aside = aside;
    let (mut active, mut holes) = (None, Vec::new());
    let run = read(&settings, "p.nc", text.as_bytes(), &mut |record| {
        match record.op {
            Op::Cycle(cycle) => active = Some(*cycle),
            Op::Hole(pose) => holes.extend(active.map(|cycle| (cycle, pose.point.z))),
            _ => {}
        }
        Ok(())
    });
    run.map(|()| holes).map_err(|found| found.rule)
}

/// Without a peck, at the active feed, with no dwell.
fn cycle(kind: CycleKind, depth: f64, clearance: f64, retract: f64) -> Cycle {
    let (first_peck, peck) = (None, None);
    Cycle { kind, depth, clearance, retract, feed: None, dwell: 0.0, first_peck, peck }
}

fn fine(aside: Vec3, angle: Option<f64>) -> CycleKind {
    CycleKind::FineBore(Withdrawal { aside, angle })
}

const START: &str = "G21 G90 G54 G0 X0 Y0 Z50. M3 S500\n";

/// B-64484EN-2, "Fine boring cycle": at the bottom the spindle stops in position, the tool goes aside by
/// Q and out by rapid. Which way is parameter 5148; on Haas setting 27.
#[test]
fn fine_boring_goes_aside_as_the_machine_is_set() {
    let down = Some(Vec3::NEG_Y);
    let kind = fine(Vec3::new(0.0, -0.5, 0.0), None);
    for (dialect, dwell) in [(Dialect::Fanuc, "P200"), (Dialect::Haas, "P0.2")] {
        let block = format!("G76 X1. Z-20. R2. Q0.5 {dwell} F50\n");
        let to_initial = Cycle { dwell: 0.2, ..cycle(kind, 22.0, 0.0, 48.0) };
        assert_eq!(
            holes(dialect, down, &format!("{START}G98 {block}")),
            Ok(vec![(to_initial, 2.0)])
        );
        let to_r = Cycle { retract: 0.0, ..to_initial };
        assert_eq!(holes(dialect, down, &format!("{START}G99 {block}")), Ok(vec![(to_r, 2.0)]));
    }
    for (aside, block) in [
        (None, "G98 G76 X1. Z-20. R2. Q0.5 F50"),
        (down, "G98 G76 X1. Z-20. R2. F50"),
        (down, "G98 G76 X1. Z-20. R2. Q-0.5 F50"),
        (down, "M5\nG98 G76 X1. Z-20. R2. Q0.5 F50"),
    ] {
        let text = format!("{START}{block}\n");
        assert_eq!(holes(Dialect::Fanuc, aside, &text), Err("nc-cycle"), "{block}");
    }
    let turned = format!("{START}G68 X0 Y0 R30.\nG98 G76 X1. Y0 Z-20. R2. Q0.5 F50\n");
    assert_eq!(holes(Dialect::Fanuc, down, &turned), Err("nc-frame"));
}

/// B-64484EN-2, "Back boring cycle": aside at the initial level, by rapid to R, back to the axis, up to Z
/// at the feed with the spindle clockwise, aside and out to the initial level.
#[test]
fn back_boring_feeds_up_from_r_to_z() {
    let right = Some(Vec3::X);
    let withdrawal = Withdrawal { aside: Vec3::new(3.0, 0.0, 0.0), angle: None };
    let back = cycle(CycleKind::BackBore { withdrawal, through: None }, 10.0, 70.0, 70.0);
    for block in ["G98 G87 X1. Z-20. R-30. Q3. F50", "G91 G98 G87 X1. Z10. R-80. Q3. F50"] {
        let text = format!("{START}{block}\n");
        assert_eq!(holes(Dialect::Fanuc, right, &text), Ok(vec![(back, -20.0)]), "{block}");
    }
    for block in [
        "G99 G87 X1. Z-20. R-30. Q3. F50",
        "G98 G87 X1. Z-30. R-20. Q3. F50",
        "G98 G87 X1. Z60. R-20. Q3. F50",
        "M5\nM4\nG98 G87 X1. Z-20. R-30. Q3. F50",
    ] {
        let text = format!("{START}{block}\n");
        assert_eq!(holes(Dialect::Fanuc, right, &text), Err("nc-cycle"), "{block}");
    }
}
