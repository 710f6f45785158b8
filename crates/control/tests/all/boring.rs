//! Boring bars that stop in position and go aside from the wall, on every control that has them.

use geom::Vec3;
use program::{Cycle, CycleKind, Feed, Withdrawal};
use toolpost_control::{Action, Dialect, Settings, read};

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
        match record.action {
            Action::Cycle(cycle) => active = Some(*cycle),
            Action::Hole(pose) => holes.extend(active.map(|cycle| (cycle, pose.point.z))),
            _ => {}
        }
        Ok(())
    });
    run.map(|()| holes).map_err(|found| found.rule.name())
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
        assert_eq!(holes(Dialect::Fanuc, aside, &text), Err("cycle"), "{block}");
    }
    let turned = format!("{START}G68 X0 Y0 R30.\nG98 G76 X1. Y0 Z-20. R2. Q0.5 F50\n");
    assert_eq!(holes(Dialect::Fanuc, down, &turned), Err("frame"));
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
        assert_eq!(holes(Dialect::Fanuc, right, &text), Err("cycle"), "{block}");
    }
}

/// Cycles Programming Manual 11/2006, CYCLE86: at the depth the spindle stops at POSS, the tool goes by RPA,
/// RPO and RPAP along the three axes and out by rapid; the spindle stands afterwards.
#[test]
fn cycle86_goes_aside_as_it_says() {
    let start = "G90 G54 G0 X70 Y50 Z120 F200 S300 M3\n";
    let run = |frame: &str, call: &str| {
        holes(Dialect::Sinumerik, None, &format!("{start}{frame}{call}\nM30\n"))
    };
    // The manual's example.
    let call = "CYCLE86(112,110,,77,0,2,3,-1,-1,1,45)";
    let kind = |x, y| fine(Vec3::new(x, y, 1.0), Some(45.0));
    let bored = Cycle { dwell: 2.0, ..cycle(kind(-1.0, -1.0), 33.0, 0.0, 2.0) };
    assert_eq!(run("", call), Ok(vec![(bored, 110.0)]));
    // The way aside is one of the coordinates of the program.
    let Ok(turned) = run("ROT RPL=90\n", call) else { panic!() };
    let CycleKind::FineBore(withdrawal) = turned[0].0.kind else { panic!() };
    assert!(withdrawal.aside.distance(Vec3::new(1.0, -1.0, 1.0)) < 1e-12);
}

const KLARTEXT: &str = "TOOL CALL 5 Z S1000 F500\nM3\nL X+0 Y+0 Z+50 R0 FMAX\n";

fn klartext(blocks: &str) -> Result<Vec<(Cycle, f64)>, &'static str> {
    let text = format!("BEGIN PGM B MM\n{KLARTEXT}{blocks}\nCYCL CALL\nEND PGM B MM\n");
    holes(Dialect::Klartext, None, &text)
}

/// Cycle 202: Q214 1 to 4 is the way -X, -Y, +X, +Y, by 0.2 mm; Q336 is the position of the spindle.
#[test]
fn cycle_202_disengages_the_way_that_it_says() {
    let call = "CYCL DEF 202 BORING Q200=2 Q201=-15 Q206=100 Q211=0.5 Q208=MAX Q203=20 Q204=100";
    for (way, aside) in [Vec3::NEG_X, Vec3::NEG_Y, Vec3::X, Vec3::Y]
        .into_iter()
        .enumerate()
        .map(|(i, v)| (i + 1, v))
    {
        let feed = Some(Feed::PerMinute(100.0));
        let kind = fine(aside * 0.2, Some(30.0));
        let bored = Cycle { feed, dwell: 0.5, ..cycle(kind, 15.0, 2.0, 100.0) };
        assert_eq!(klartext(&format!("{call} Q214={way} Q336=30")), Ok(vec![(bored, 20.0)]));
    }
    let turned = format!("CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30\n{call} Q214=1 Q336=0");
    assert_eq!(klartext(&turned), Err("transformation"));
}

/// Cycle 204, the manual's example: the part is 20 thick with its surface at 20, the edge stands 15 above
/// the end of the bar. By hand: the edge begins 2 below the part, at -2, and ends at 5; the tool, 15 below
/// it, goes from -17 to -10.
#[test]
fn cycle_204_bores_from_below() {
    let call = "CYCL DEF 204 BACK BORING Q200=2 Q249=+5 Q250=20 Q251=3.5 Q252=15 Q254=200 Q255=0.5 \
                Q203=+20 Q204=50";
    let bored = |through| {
        let withdrawal = Withdrawal { aside: Vec3::new(-3.5, 0.0, 0.0), angle: Some(0.0) };
        let kind = CycleKind::BackBore { withdrawal, through };
        Cycle { feed: Some(Feed::PerMinute(200.0)), dwell: 0.5, ..cycle(kind, 7.0, 32.0, 80.0) }
    };
    let slow = bored(Some(Feed::PerMinute(750.0)));
    assert_eq!(klartext(&format!("{call} Q253=750 Q214=1 Q336=0")), Ok(vec![(slow, -10.0)]));
    let rapid = bored(None);
    assert_eq!(klartext(&format!("{call} Q253=MAX Q214=1 Q336=0")), Ok(vec![(rapid, -10.0)]));
    for wrong in ["Q253=750 Q214=0", "Q253=0 Q214=1"] {
        assert_eq!(klartext(&format!("{call} {wrong} Q336=0")), Err("cycle-parameter"), "{wrong}");
    }
    let negative = call.replace("Q249=+5", "Q249=-5");
    assert_eq!(klartext(&format!("{negative} Q253=750 Q214=1")), Err("cycle-parameter"));
}
