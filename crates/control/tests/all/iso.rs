//! What the makers' manuals say of ISO code, as programs and the records they must give. Sources are
//! in `docs/controls/`.

use geom::Vec3;
use program::{
    Axes, Compensation, Coolant, Cycle, CycleKind, Diagnostic, Feed, PathMode, Spindle, WorkOffset,
};
use toolpost_control::{
    Action, ArcTo, Dialect, Orientation, Position, Settings, StartModes, TiltChoice,
};

const FANUC: Dialect = Dialect::Fanuc;
const LINUXCNC: Dialect = Dialect::LinuxCnc;
const GRBL: Dialect = Dialect::Grbl;

fn run(dialect: Dialect, rotary: [bool; 3], text: &str) -> Result<Vec<Action>, Box<Diagnostic>> {
    let settings = Settings {
        auxiliary: vec![26],
        dwell_p_milliseconds: Some(true),
        rotary_by_sign: Some(false),
        // They have tests of their own.
        start_modes: StartModes::SURE,
        ..Settings::new(dialect, rotary)
    };
    // Most of these programs are in mm and do not say so.
    let says_unit = ["%", "G20", "G21"].iter().any(|word| text.contains(word));
    let text = if says_unit { text.to_owned() } else { format!("G21\n{text}") };
    let mut actions = crate::common::ops(&settings, "p.nc", text)?;
    // What is only reported has tests of its own (`side_effects.rs`).
    actions.retain(|action| !matches!(action, Action::Risk(risk) if !risk.refused));
    Ok(actions)
}

/// The records of a program on a machine with A and C.
fn ops(dialect: Dialect, text: &str) -> Vec<Action> {
    run(dialect, [true, false, true], text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The records of a program on a machine with three axes.
fn ops_3(dialect: Dialect, text: &str) -> Vec<Action> {
    run(dialect, [false; 3], text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The rule that a program breaks.
#[track_caller]
fn rule(dialect: Dialect, text: &str) -> &'static str {
    match run(dialect, [true, false, true], text) {
        Ok(ops) => panic!("taken:\n{text}\n{ops:?}"),
        Err(error) => {
            assert!(error.line > 0 && error.column > 0 && error.file == "p.nc", "{error}");
            error.rule.name()
        }
    }
}

/// A pose on a machine with three axes.
fn at(x: f64, y: f64, z: f64) -> Position {
    let orientation = Orientation::Rotary { degrees: [0.0; 3], tool_center: false };
    Position { point: Vec3::new(x, y, z), orientation }
}

/// Arcs of a program: end, centre, normal.
fn arcs(dialect: Dialect, text: &str) -> Vec<(Vec3, Vec3, Vec3)> {
    let arc = |op| match op {
        Action::Arc(arc) => Some((arc.end.point, arc.center, arc.normal)),
        _ => None,
    };
    ops_3(dialect, text).into_iter().filter_map(arc).collect()
}

const HOLE: Cycle = Cycle {
    kind: CycleKind::Drill,
    depth: 12.0,
    clearance: 0.0,
    retract: 48.0,
    feed: None,
    dwell: 0.0,
    first_peck: None,
    peck: None,
};

#[test]
fn a_fanuc_program_from_start_to_end() {
    let got = ops_3(
        FANUC,
        "%\nO0001(PART)\nN10 G17 G21 G40 G49 G80 G90 G94\nG91 G28 Z0\nT5 M6\nG90 G54\nS3000 M3\n\
         G0 X1. Y2.\nG43 H5 Z50. M8\nG1 Z-1. F100.\nX10. M26\nG0 Z50. M9\nM5\nG91 G28 Z0\nG90\nM30\n%\n",
    );
    let nan = f64::NAN;
    let tool = program::Tool { number: 5, ..Default::default() };
    let expected = [
        Action::Comment("PART".into()),
        Action::Home(Axes::Z),
        Action::Tool(Box::new(tool)),
        Action::WorkOffset(WorkOffset::FIRST),
        Action::Spindle(Spindle::Clockwise(3000.0)),
        Action::Rapid(at(1.0, 2.0, nan)),
        Action::Coolant(Coolant::Flood),
        Action::LengthOffset(Some(5)),
        Action::Rapid(at(1.0, 2.0, 50.0)),
        Action::Feed(Feed::PerMinute(100.0)),
        Action::Line(at(1.0, 2.0, -1.0)),
        Action::Auxiliary(program::Auxiliary::of(26)),
        Action::Line(at(10.0, 2.0, -1.0)),
        Action::Rapid(at(10.0, 2.0, 50.0)),
        Action::Coolant(Coolant::Off),
        Action::Spindle(Spindle::Off),
        Action::Home(Axes::Z),
        Action::End,
    ];
    // NaN is not equal to itself: compare as they show.
    assert_eq!(format!("{got:#?}"), format!("{:#?}", expected.to_vec()));
}

#[test]
fn a_fanuc_number_without_a_point_is_refused_unless_it_is_zero() {
    assert_eq!(rule(FANUC, "G0 X10\n"), "decimal-point");
    assert_eq!(rule(FANUC, "G0 X0. Y0. Z0.\nG2 X10. R5 F9\n"), "decimal-point");
    assert_eq!(rule(FANUC, "G0 C90\n"), "decimal-point");
    assert_eq!(rule(FANUC, "G0 Z9. X0 Y0\nG83 Z-1. R1. Q1 F9\n"), "decimal-point");
    assert_eq!(ops_3(FANUC, "G0 X0 Y-0 Z0.\n").len(), 1);
    assert_eq!(ops_3(LINUXCNC, "G0 X10 Y-10 Z0.\n"), [Action::Rapid(at(10.0, -10.0, 0.0))]);
}

#[test]
fn a_dwell_is_in_seconds_but_for_fanuc_p_in_milliseconds() {
    assert_eq!(ops(FANUC, "G4 P1500\n"), [Action::Dwell(1.5)]);
    assert_eq!(ops(FANUC, "G4 X1.5\n"), [Action::Dwell(1.5)]);
    assert_eq!(ops(LINUXCNC, "G4 P1.5\n"), [Action::Dwell(1.5)]);
    assert_eq!(ops(GRBL, "G4 P2\n"), [Action::Dwell(2.0)]);
    assert_eq!(rule(FANUC, "G4 P1.5\n"), "number");
    assert_eq!(rule(FANUC, "G4 X2\n"), "decimal-point");
    assert_eq!(rule(FANUC, "G4 U1.\n"), "unknown-word");
}

#[test]
fn the_planes_are_right_handed_so_that_g2_in_g18_turns_from_z_to_x_backwards() {
    let start = "G90 G0 X0. Y0. Z0.\nF100\n";
    for dialect in [FANUC, LINUXCNC, GRBL] {
        // From the origin round (5, 0, 0): the first quarter goes to (5, 0, ±5).
        let g18 = arcs(dialect, &format!("{start}G18 G2 X5. Z5. I5. K0\n"));
        assert_eq!(g18, [(Vec3::new(5.0, 0.0, 5.0), Vec3::new(5.0, 0.0, 0.0), Vec3::NEG_Y)]);
        let g17 = arcs(dialect, &format!("{start}G17 G3 X5. Y-5. I5. J0\n"));
        assert_eq!(g17, [(Vec3::new(5.0, -5.0, 0.0), Vec3::new(5.0, 0.0, 0.0), Vec3::Z)]);
        let g19 = arcs(dialect, &format!("{start}G19 G2 Y5. Z5. J5. K0\n"));
        assert_eq!(g19, [(Vec3::new(0.0, 5.0, 5.0), Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_X)]);
    }
}

#[test]
fn a_negative_radius_is_the_long_way() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        let program = "G90 G0 X0. Y0. Z0.\nG2 X10. Y0. R13. F100\nG3 X0. R-13.\n";
        let arcs = arcs(dialect, program);
        // 5-12-13: clockwise the short way the centre is on the right of the way, which is below.
        assert!(arcs[0].1.distance(Vec3::new(5.0, -12.0, 0.0)) < 1e-12, "{arcs:?}");
        // Back, counter-clockwise the long way: on the right again, which is now above.
        assert!(arcs[1].1.distance(Vec3::new(5.0, 12.0, 0.0)) < 1e-12, "{arcs:?}");
    }
}

#[test]
fn a_full_circle_has_a_centre_and_a_helix_a_third_axis() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        let program = "G90 G0 X1. Y2. Z3.\nG2 X1. Y2. I5. F100\nG3 X11. Y2. Z1. I5. J0\n";
        let got = ops_3(dialect, program);
        let circle = ArcTo {
            end: at(1.0, 2.0, 3.0),
            center: Vec3::new(6.0, 2.0, 3.0),
            normal: Vec3::NEG_Z,
            turns: 0,
        };
        assert!(got.contains(&Action::Arc(Box::new(circle))), "{got:?}");
        let helix = ArcTo { end: at(11.0, 2.0, 1.0), normal: Vec3::Z, ..circle };
        assert!(got.contains(&Action::Arc(Box::new(helix))), "{got:?}");
        assert_eq!(rule(dialect, "G90 G0 X0. Y0. Z0.\nG2 X0. Y0. R5. F9\n"), "arc");
    }
    // GRBL wants an axis word of the plane (its error 26), the others do not.
    assert_eq!(rule(GRBL, "G0 X0 Y0 Z0\nG2 I5 F9\n"), "arc");
    assert_eq!(arcs(FANUC, "G90 G0 X0. Y0. Z0.\nG2 I5. F9\n").len(), 1);
}

#[test]
fn the_radii_of_an_arc_may_differ_by_what_the_control_allows() {
    let arc = |end: &str, center: &str| format!("G0 X0. Y0. Z0.\nG2 X{end} Y0. I{center} J0. F9\n");
    // gcode.c: 0.005 mm, or 0.1 % of the radius up to 0.5 mm.
    assert_eq!(arcs(GRBL, &arc("10.004", "5.")).len(), 1);
    assert_eq!(rule(GRBL, &arc("10.012", "5.")), "arc");
    assert_eq!(arcs(GRBL, &arc("1000.4", "500.")).len(), 1);
    assert_eq!(rule(GRBL, &arc("1001.1", "500.")), "arc");
    assert_eq!(rule(GRBL, &arc("2001.1", "1000.")), "arc");
    // `rs274`: 2√2 of 0.01 mm, or 0.1 % of the radius up to a hundred times that; see also its own test.
    assert_eq!(arcs(LINUXCNC, &arc("10.028", "5.")).len(), 1);
    assert_eq!(rule(LINUXCNC, &arc("10.0284", "5.")), "arc");
    assert_eq!(arcs(LINUXCNC, &arc("2001", "1000.")).len(), 1);
    assert_eq!(rule(LINUXCNC, &arc("1000.6", "500.")), "arc");
    assert_eq!(arcs(FANUC, &arc("10.009", "5.")).len(), 1);
    assert_eq!(rule(FANUC, &arc("10.011", "5.")), "arc");
    // A half circle by rounding: LinuxCNC has 0.000 05 inch to spare, the others have nothing.
    assert_eq!(arcs(LINUXCNC, "G0 X0 Y0 Z0\nG2 X10 R4.999 F9\n").len(), 1);
    assert_eq!(rule(GRBL, "G0 X0 Y0 Z0\nG2 X10 R4.999 F9\n"), "arc");
}

#[test]
fn an_arc_or_an_increment_from_nowhere_is_refused() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        assert_eq!(rule(dialect, "G0 X0. Y0.\nG2 X10. I5. F9\n"), "unknown-position");
        assert_eq!(rule(dialect, "G91 G0 X1.\n"), "unknown-position");
        assert_eq!(rule(dialect, "G0 X0. Y0. Z0.\nG55\nG91 X1.\n"), "unknown-position");
        assert_eq!(rule(dialect, "G0 X0. Y0. Z0.\nG28 Z5.\nG91 G0 Z1.\n"), "unknown-position");
    }
}

#[test]
fn fanuc_drilling_returns_to_the_initial_level_or_to_r() {
    let got = ops_3(
        FANUC,
        "G90 G0 X0 Y0 Z50.\nG98 G81 X10. Y5. Z-10. R2. F100\nX20.\nG99 X30.\nF50\nG80\nG0 Z50.\n",
    );
    let expected = [
        Action::Rapid(at(0.0, 0.0, 50.0)),
        Action::Feed(Feed::PerMinute(100.0)),
        Action::Cycle(Box::new(HOLE)),
        Action::Hole(at(10.0, 5.0, 2.0)),
        Action::Hole(at(20.0, 5.0, 2.0)),
        Action::Cycle(Box::new(Cycle { retract: 0.0, ..HOLE })),
        Action::Hole(at(30.0, 5.0, 2.0)),
        Action::Feed(Feed::PerMinute(50.0)),
        Action::CycleOff,
        Action::Rapid(at(30.0, 5.0, 50.0)),
    ];
    assert_eq!(got, expected);
}

#[test]
fn fanuc_cycle_words_stay_until_g80_and_k_repeats_in_a_row() {
    let got = ops_3(
        FANUC,
        "G90 G0 X0 Y0 Z50.\nG99 G83 X10. Y5. Z-10. R2. Q3. F100\nG82 X20. P250\nG91 X5. K2\nG90 X0 K0\n\
         G80\n",
    );
    let deep = Cycle {
        kind: CycleKind::Deep,
        retract: 0.0,
        first_peck: Some(3.0),
        peck: Some(3.0),
        ..HOLE
    };
    let expected = [
        Action::Cycle(Box::new(deep)),
        Action::Hole(at(10.0, 5.0, 2.0)),
        Action::Cycle(Box::new(Cycle { retract: 0.0, dwell: 0.25, ..HOLE })),
        Action::Hole(at(20.0, 5.0, 2.0)),
        Action::Hole(at(25.0, 5.0, 2.0)),
        Action::Hole(at(30.0, 5.0, 2.0)),
        Action::CycleOff,
    ];
    assert_eq!(got[2..], expected);
}

#[test]
fn in_g91_r_counts_from_the_initial_level_and_z_from_r() {
    for (dialect, repeats) in [(FANUC, 'K'), (LINUXCNC, 'L')] {
        let program =
            format!("G90 G0 X0 Y0 Z50.\nG91 G98 G81 X10. Z-12. R-48. F100 {repeats}3\nG80\n");
        let got = ops_3(dialect, &program);
        let holes = [10.0, 20.0, 30.0].map(|x| Action::Hole(at(x, 0.0, 2.0)));
        assert_eq!(got[2], Action::Cycle(Box::new(HOLE)));
        assert_eq!(got[3..6], holes);
    }
}

#[test]
fn fanuc_rigid_tapping_turns_the_spindle_itself_and_leaves_it_standing() {
    let got =
        ops_3(FANUC, "G90 G0 X0 Y0 Z50.\nM29 S500\nG84 X10. Y5. Z-10. R2. F625.\nG80\nG0 Z60.\n");
    let tap = Cycle { kind: CycleKind::Tap { pitch: 1.25, left: false }, ..HOLE };
    let expected = [
        Action::Feed(Feed::PerMinute(625.0)),
        Action::Spindle(Spindle::Clockwise(500.0)),
        Action::Cycle(Box::new(tap)),
        Action::Hole(at(10.0, 5.0, 2.0)),
        Action::CycleOff,
        Action::Spindle(Spindle::Off),
        Action::Rapid(at(10.0, 5.0, 60.0)),
    ];
    assert_eq!(got[1..], expected);
    // In G95 the feed is the pitch; the left-hand tap turns the other way.
    let got = ops_3(FANUC, "G90 G0 X0 Y0 Z50.\nS500 M4\nG95 G74 X10. Y5. Z-10. R2. F1.25\nG80\n");
    let left = Cycle { kind: CycleKind::Tap { pitch: 1.25, left: true }, ..HOLE };
    assert!(got.contains(&Action::Cycle(Box::new(left))), "{got:?}");
    let wrong = "G90 G0 X0 Y0 Z50.\nS500 M4\nG84 X10. Y5. Z-10. R2. F625.\n";
    assert_eq!(rule(FANUC, wrong), "cycle");
}

#[test]
fn every_cycle_has_its_kind() {
    for (words, kind, dwell) in [
        ("G73 Q3.", CycleKind::BreakChip, 0.0),
        ("G81", CycleKind::Drill, 0.0),
        ("G82 P500", CycleKind::Drill, 0.5),
        ("G83 Q3.", CycleKind::Deep, 0.0),
        ("G85", CycleKind::Ream, 0.0),
        ("G86", CycleKind::Bore, 0.0),
        ("G89 P500", CycleKind::Ream, 0.5),
    ] {
        let got = ops_3(FANUC, &format!("G90 G0 X0 Y0 Z50.\n{words} Z-10. R2. F100\n"));
        let peck = words.contains('Q').then_some(3.0);
        let cycle = Cycle { kind, dwell, first_peck: peck, peck, ..HOLE };
        assert_eq!(got[2], Action::Cycle(Box::new(cycle)), "{words}");
    }
}

#[test]
fn a_cycle_that_lacks_something_is_refused() {
    let start = "G90 G0 X0 Y0 Z50.\nF100\n";
    for block in [
        "G81 X1. Z-1.",
        "G81 X1. R2.",
        "G83 X1. Z-1. R2.",
        "G82 X1. Z-1. R2.",
        "G81 X1. Z5. R2.",
        "G81 X1. Z-1. R60.",
        "G18 G81 X1. Z-1. R2.",
        "G84 X1. Z-1. R2.",
        "G81 X1. Z-1. R2. A5.",
        "G81 X1. Z-1. R2. K99999",
    ] {
        assert_eq!(rule(FANUC, &format!("{start}{block}\n")), "cycle", "{block}");
    }
    assert_eq!(rule(FANUC, "G0 X0 Y0\nG81 X1. Z-1. R2. F9\n"), "unknown-position");
    // Also where the mode changes between two holes of one cycle.
    for text in ["G93\nG0 X0 Y0 Z9\nG81 Z-1 R2 F9\n", "G0 X0 Y0 Z9\nG81 Z-1 R2 F9\nG93 X5 F9\n"] {
        assert_eq!(rule(LINUXCNC, text), "cycle");
    }
    // rs274 returns to R where neither is given, the manual does not say: so it must be said.
    assert_eq!(rule(LINUXCNC, "G0 X0 Y0 Z9\nG81 Z-1 R2 F9\n"), "cycle");
}

/// LinuxCNC, "G96, G97 Spindle Control Mode": S is metres or feet a minute, D the most speed.
#[test]
fn constant_surface_speed_is_a_state_apart_from_the_most_speed() {
    let spindle = |text: &str| -> Vec<Action> {
        let speeds = |op: &Action| matches!(op, Action::Spindle(_) | Action::SurfaceSpeed(_));
        ops_3(LINUXCNC, text).into_iter().filter(speeds).collect()
    };
    let clockwise = |speed| Action::Spindle(Spindle::Clockwise(speed));
    let constant = |speed| Action::SurfaceSpeed(Some(speed));
    assert_eq!(
        spindle("S500 M3\nG96 D2500 S100\nS70\nG97 S800\nM5\n"),
        [
            clockwise(500.0),
            constant(100.0),
            clockwise(2500.0),
            constant(70.0),
            Action::SurfaceSpeed(None),
            clockwise(800.0),
            Action::Spindle(Spindle::Off)
        ]
    );
    assert_eq!(spindle("G20\nG96 S100\n"), [constant(30.48)]);
    assert_eq!(spindle("G96 S100\nM3\n"), [constant(100.0), clockwise(f64::INFINITY)]);
    assert_eq!(rule(LINUXCNC, "G96 S100 D0\n"), "spindle");
    assert_eq!(rule(LINUXCNC, "G96 S100\nG97\n"), "spindle");
    let tap = "G99 G0 X0 Y0 Z9\nG96 S100 D500 M3\nG84 Z-1 R2 F100\n";
    assert_eq!(rule(LINUXCNC, tap), "cycle");
}

#[test]
fn grbl_has_no_cycles_no_compensation_no_length_register_and_no_tool_change() {
    for block in
        ["G81 X1 Z-1 R1", "G41 D1 X1", "G43 H1", "M6", "G64", "G90.1", "G59.1", "G95", "M19"]
    {
        assert_eq!(rule(GRBL, &format!("G0 X0 Y0 Z9\n{block}\n")), "unknown-word", "{block}");
    }
    for word in ["A1", "D1", "H1", "Q1", "U1", "O1"] {
        assert_eq!(rule(GRBL, &format!("G0 {word}\n")), "unknown-word", "{word}");
    }
    assert_eq!(rule(GRBL, "%\n"), "syntax");
    assert_eq!(rule(GRBL, "$H\n"), "syntax");
    let exact = Action::PathMode(PathMode::ExactStop);
    assert_eq!(ops(GRBL, "M1\nG40 G49 G61 G91.1\n"), [exact]);
}

#[test]
fn a_grbl_tool_is_set_up_at_first_and_changed_by_hand_at_m0_later() {
    let tool = |number| Action::Tool(Box::new(program::Tool { number, ..Default::default() }));
    let start = "G53 G0 Z0\nT3\nG0 X0 Y0 Z5\nG1 Z0 F9\n";
    let got = ops_3(GRBL, &format!("{start}T4\nG0 Z9\nM0\nG1 X1\nM0\n"));
    assert_eq!(got[1], tool(3));
    assert_eq!((&got[6], &got[8]), (&tool(4), &Action::Stop));
    // The new tool is of another length.
    assert!(got[7].position().unwrap().point.z.is_nan());
    assert_eq!(rule(GRBL, &format!("{start}T4\nG1 X1\n")), "tool");
    assert_eq!(rule(GRBL, &format!("S9 M3\n{start}T4\nM0\n")), "tool");
    assert_eq!(rule(GRBL, "G0 X0\nG1 X1 F9\nT4\nX2\n"), "tool");
}

#[test]
fn a_grbl_block_has_79_characters_at_most_blanks_and_comments_apart() {
    let block = |digits: usize| format!("G0 X0 Y0 Z1.{} (and a comment)\n", "0".repeat(digits));
    assert_eq!(ops(GRBL, &block(79 - 9)).len(), 2);
    assert_eq!(rule(GRBL, &block(79 - 8)), "block-length");
}

#[test]
fn a_program_says_itself_how_it_moves_first() {
    // G0 after power on, G1 behind the M30 of the program before (`gcode.c`, step 21).
    assert_eq!(rule(GRBL, "X1 Y2 Z3\n"), "missing-word");
    assert_eq!(rule(LINUXCNC, "X1\n"), "missing-word");
    assert_eq!(rule(FANUC, "X1.\n"), "missing-word");
    assert_eq!(rule(GRBL, "G0 X1\nG80\nX2\n"), "missing-word");
    assert_eq!(rule(GRBL, "G0 G80\n"), "modal-group");
    assert_eq!(ops_3(FANUC, "G0 G80 X1. Y1. Z1.\n").len(), 1);
}

#[test]
fn two_words_of_a_modal_group_are_refused() {
    for block in ["G0 G1", "G17 G18", "G90 G91", "G20 G21", "G54 G55", "G93 G94", "M3 M4", "M0 M30"]
    {
        for dialect in [FANUC, LINUXCNC, GRBL] {
            assert_eq!(rule(dialect, &format!("{block}\n")), "modal-group", "{block}");
        }
    }
    assert_eq!(rule(FANUC, "G1 G81 X1.\n"), "modal-group");
    assert_eq!(rule(FANUC, "M3 M8 S9\n"), "m-function");
}

#[test]
fn a_word_that_nothing_uses_is_refused() {
    for block in ["G0 X1. R5.", "G0 X1. P1", "G1 F9. I5.", "G0 X1. K1.", "J1."] {
        for dialect in [FANUC, LINUXCNC, GRBL] {
            assert_eq!(rule(dialect, &format!("{block}\n")), "unused-word", "{block}");
        }
    }
    assert_eq!(rule(LINUXCNC, "G43 H1 D2\n"), "unused-word");
}

#[test]
fn a_control_without_parameters_says_so() {
    for block in ["#1=5", "G0 X#1", "G0 X[1+2]"] {
        for dialect in [GRBL, Dialect::Marlin] {
            let error = run(dialect, [false; 3], &format!("{block}\n")).unwrap_err();
            assert!(error.message.contains("no parameters"), "{error}");
        }
    }
    assert_eq!(rule(GRBL, "o100 sub\n"), "unknown-word");
    let error = run(GRBL, [false; 3], "N5 M98 P1000\n").unwrap_err();
    assert_eq!((error.line, error.column, error.width), (2, 4, 3));
    assert_eq!(error.help, "this control has no subprograms");
}

#[test]
fn an_m_function_is_the_controls_or_the_builders() {
    assert_eq!(rule(FANUC, "M77\n"), "unknown-word");
    // The builder of this machine has an M26.
    assert_eq!(ops(FANUC, "M26\n"), [Action::Auxiliary(program::Auxiliary::of(26))]);
}

#[test]
fn a_feed_must_be_given_and_belongs_to_its_mode() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        assert_eq!(rule(dialect, "G1 X1.\n"), "feed");
        assert_eq!(rule(dialect, "G1 X1. F0\n"), "feed");
        assert_eq!(rule(dialect, "G1 X1. F9\nG93 X2.\n"), "feed");
        assert_eq!(rule(dialect, "G93 G1 X1. F9.\nX2.\n"), "feed");
        let got = ops(dialect, "G20\nG93 G1 X1. F9.\nG94 X2. F9\n");
        let feeds: Vec<Action> =
            got.into_iter().filter(|op| matches!(op, Action::Feed(_))).collect();
        assert_eq!(
            feeds,
            [Action::Feed(Feed::InverseTime(9.0)), Action::Feed(Feed::PerMinute(9.0 * 25.4))]
        );
    }
}

#[test]
fn inches_are_25_4_mm() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        let got = ops_3(dialect, "G20\nG0 X1. Y-2. Z.5\nG1 X0. F10.\n");
        let expected = [
            Action::Rapid(at(25.4, -50.8, 12.7)),
            Action::Feed(Feed::PerMinute(254.0)),
            Action::Line(at(0.0, -50.8, 12.7)),
        ];
        assert_eq!(got, expected);
    }
    assert_eq!(rule(FANUC, "G21\nG0 X1.\nG20\n"), "units");
    // Before either has been given the unit is that of the program before.
    for dialect in [FANUC, LINUXCNC] {
        assert_eq!(rule(dialect, "%\nG90 G0 X1.\n"), "units");
        assert_eq!(rule(dialect, "%\nF100\n"), "units");
    }
    assert_eq!(rule(FANUC, "%\nG91 G28 Z0\nG21 F100\n"), "units");
}

#[test]
fn a_feed_in_a_block_with_the_units_is_in_those_that_the_control_takes_first() {
    let feed = |per_minute| [Action::Feed(Feed::PerMinute(per_minute))];
    for dialect in [FANUC, Dialect::Haas, GRBL] {
        assert_eq!(ops(dialect, "G20 G90 F10.\n"), feed(254.0));
    }
    // `rs274`: SET_FEED_RATE(20) comes before USE_LENGTH_UNITS(CANON_UNITS_MM).
    assert_eq!(ops(LINUXCNC, "G20\nG21 F20\n"), feed(508.0));
    assert_eq!(ops(GRBL, "G20\nG21 F20\n"), feed(20.0));
    assert_eq!(rule(FANUC, "G20\nG21 F20\n"), "feed");
    for dialect in [LINUXCNC, Dialect::Mach3] {
        assert_eq!(rule(dialect, "%\nG20 F10\n"), "feed");
    }
    assert_eq!(rule(Dialect::Mach3, "G20\nG21 F20\n"), "feed");
}

#[test]
fn d_and_h_stay_for_the_words_that_use_them() {
    for dialect in [FANUC, Dialect::Haas] {
        let got = ops_3(dialect, "T4 D14 M6\nG0 X0. Y0.\nH4\nG43 Z9.\nG1 G41 X5. F9\n");
        let expected = [
            Action::LengthOffset(Some(4)),
            Action::Rapid(at(0.0, 0.0, 9.0)),
            Action::Feed(Feed::PerMinute(9.0)),
            Action::Compensation(Compensation::Left(Some(14))),
            Action::Line(at(5.0, 0.0, 9.0)),
        ];
        assert_eq!(got[got.len() - 5..], expected);
        // While G43 is on, another H is another length, and H0 none.
        let mut got = ops(dialect, "G43 H4\nH5\nH0\n");
        got.retain(|action| matches!(action, Action::LengthOffset(_)));
        assert_eq!(got, [Some(4), Some(5), None].map(Action::LengthOffset));
        assert_eq!(rule(dialect, "G0 X0. Y0.\nG1 G41 D1 X5. F9\nX6. D2\n"), "compensation");
        assert_eq!(rule(dialect, "G43 Z9.\n"), "length-offset");
    }
    assert_eq!(rule(LINUXCNC, "T4 D14 M6\n"), "unused-word");
}

#[test]
fn look_ahead_moves_nothing() {
    assert_eq!(ops(FANUC, "G5 P10000\nG5.1 Q1 R5\nG5.1 Q0\nG5 P0\n"), []);
    for other in ["G5.1 Q2", "G5 P10001", "G5.1", "G5 Q1"] {
        assert_eq!(rule(FANUC, &format!("{other}\n")), "look-ahead", "{other}");
    }
}

#[test]
fn the_semicolon_of_a_fanuc_ends_its_block() {
    for dialect in [FANUC, Dialect::Haas] {
        assert_eq!(ops(dialect, ";\nM8 ;\nM9; (off)\n").len(), 3);
        assert_eq!(rule(dialect, "M8; on\n"), "syntax");
        assert_eq!(rule(dialect, "G43; H01\n"), "syntax");
    }
}

#[test]
fn the_centre_along_the_axis_of_an_arc_is_nothing() {
    let arc = |k: &str| format!("G0 X0. Y0. Z0.\nG1 G17 F9\nG2 X10. I5. J0. {k}\n");
    for dialect in [FANUC, Dialect::Haas, Dialect::Mach3, GRBL] {
        assert_eq!(ops_3(dialect, &arc("K0.")), ops_3(dialect, &arc("")));
    }
    // gcode.c, step 20, clears all three.
    assert_eq!(ops_3(GRBL, &arc("K1.")), ops_3(GRBL, &arc("")));
    assert_eq!(rule(FANUC, &arc("K1.")), "arc");
    // `rs274`: "K word given for arc in xy plane".
    assert_eq!(rule(LINUXCNC, &arc("K0.")), "arc");
}

#[test]
fn compensation_starts_with_a_linear_move() {
    for (dialect, words) in [(FANUC, "G41 D7"), (LINUXCNC, "G41 D7")] {
        let program =
            format!("G0 X0 Y0 Z0\nG1 F9\n{words}\nZ-1.\nX5.\nG2 X15. Y0 I5.\nG40\nG1 Z5.\nX20.\n");
        let got = ops_3(dialect, &program);
        let start =
            got.iter().position(|op| *op == Action::Compensation(Compensation::Left(Some(7))));
        let end = got.iter().position(|op| *op == Action::Compensation(Compensation::Off));
        // LinuxCNC switches with any straight move, FANUC with one in the plane.
        let (first, last) = match dialect {
            LINUXCNC => (at(0.0, 0.0, -1.0), at(15.0, 0.0, 5.0)),
            _ => (at(5.0, 0.0, -1.0), at(20.0, 0.0, 5.0)),
        };
        assert_eq!(got[start.unwrap() + 1], Action::Line(first));
        assert_eq!(got[end.unwrap() + 1], Action::Line(last));
        for wrong in [
            "G1 G41 D1 X5.\nG40 G2 X15. I5.",
            "G1 G41 D1 X5.\nG28 Z9.",
            "G1 G41 D1 X5.\nG18",
            "G1 G41 D1 X5.\nG98 G81 Z-5. R-2.",
            "G1 G41 D1 X5.\nT1 M6",
        ] {
            let program = format!("G0 X0 Y0 Z0\nF9 {wrong}\n");
            assert_eq!(rule(dialect, &program), "compensation", "{program}");
        }
    }
    let on_an_arc = "G0 X0 Y0 Z0\nF9 G41 D1 G2 X10. I5.\n";
    assert_eq!(rule(FANUC, on_an_arc), "compensation");
    assert_eq!(rule(LINUXCNC, on_an_arc), "compensation-entry");
    assert_eq!(rule(FANUC, "G41 X1.\n"), "compensation");
    // In another plane than the tool's it must be resolved, and the tool is not known here.
    assert_eq!(rule(FANUC, "G18 G0 X0 Y0 Z0\nG41 D1 X9.\n"), "compensation-plane");
}

#[test]
fn the_way_home_leads_through_the_point_of_the_block() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        let mut got = ops_3(dialect, "G90 G0 X1. Y2. Z3.\nG28 Z20.\nG0 Z1.\nG91 G28 X0 Y0\n");
        // On two of them the operator has stored where that is.
        got.retain(|action| !matches!(action, Action::Risk(_)));
        let nan = f64::NAN;
        let expected = vec![
            Action::Rapid(at(1.0, 2.0, 3.0)),
            Action::Rapid(at(1.0, 2.0, 20.0)),
            Action::Home(Axes::Z),
            Action::Rapid(at(1.0, 2.0, 1.0)),
            Action::Home(Axes::X | Axes::Y),
        ];
        assert_eq!(format!("{got:?}"), format!("{expected:?}"));
        let after = ops_3(dialect, "G90 G0 X1. Y2. Z3.\nG53 G0 Z0\nX5.\n");
        assert_eq!(format!("{:?}", after[2]), format!("{:?}", Action::Rapid(at(5.0, 2.0, nan))));
        assert_eq!(rule(dialect, "G91 G53 G0 Z0\n"), "machine-position");
    }
    assert_eq!(rule(FANUC, "G28\n"), "home");
    assert_eq!(ops(GRBL, "G28\n")[1..], [Action::Home(Axes::LINEAR)]);
    assert_eq!(
        ops(LINUXCNC, "G30\n")[1..],
        [Action::Home(Axes::X | Axes::Y | Axes::Z | Axes::A | Axes::C)]
    );
}

#[test]
fn the_tool_centre_point_is_kept_from_g43_4_to_g49() {
    let got = ops(FANUC, "G0 X0 Y0 Z0 A0 C0\nG43.4 H3 Z9.\nG1 X1. A30. C-45. F9\nG49\n");
    let center = Orientation::Rotary { degrees: [30.0, 0.0, -45.0], tool_center: true };
    assert_eq!(got[1], Action::LengthOffset(Some(3)));
    assert_eq!(
        got[4],
        Action::Line(Position { point: Vec3::new(1.0, 0.0, 9.0), orientation: center })
    );
    assert!(matches!(got[5], Action::Risk(_)));
    assert_eq!(got[6], Action::LengthOffset(None));
    let three = run(FANUC, [false; 3], "G43.4 H1\n").unwrap_err();
    assert_eq!(three.rule.name(), "unknown-axis");
    assert_eq!(rule(FANUC, "G0 B5.\n"), "unknown-axis");
}

#[test]
fn a_tilted_plane_turns_about_z_then_new_x_then_newest_z() {
    // J90 alone turns Z to -Y and Y to Z; I90 before it turns X to Y.
    let got =
        ops(FANUC, "G68.2 X10. Y20. Z30. I90. J90. K0\nG53.1\nG0 X1. Y2. Z3.\nG69\nG0 X0 Y0 Z0\n");
    assert_eq!(got[0], Action::Swivel(TiltChoice::LeastTurn));
    let Action::Rapid(pose) = &got[1] else { panic!("{got:?}") };
    // X of the plane is Y, its Z is X, so its Y is Z.
    assert!(pose.point.distance(Vec3::new(10.0 + 3.0, 20.0 + 1.0, 30.0 + 2.0)) < 1e-12, "{pose:?}");
    assert!(pose.axis().unwrap().distance(Vec3::X) < 1e-12, "{pose:?}");
    let Action::Rapid(pose) = &got[2] else { panic!("{got:?}") };
    let Orientation::Rotary { degrees, tool_center: false } = pose.orientation else { panic!() };
    assert!(degrees[0].is_nan() && degrees[1] == 0.0 && degrees[2].is_nan());
    // 45° about X: a hole along (0, -1, 1).
    let got =
        ops(FANUC, "G68.2 X0 Y0 Z0 I0 J45. K0\nG53.1\nG0 X0 Y0 Z50.\nG81 Z-10. R2. F9\nG80\n");
    let Action::Hole(pose) = &got[4] else { panic!("{got:?}") };
    let half = 0.5_f64.sqrt();
    assert!(pose.axis().unwrap().distance(Vec3::new(0.0, -half, half)) < 1e-12);
    assert!(pose.point.distance(Vec3::new(0.0, -2.0 * half, 2.0 * half)) < 1e-12);
}

#[test]
fn x_and_y_of_a_tilted_plane_are_known_before_its_z_is() {
    let got = ops(FANUC, "G68.2 X10. Y20. Z30. I90. J90. K0\nG53.1\nG0 X1. Y2.\nZ3.\n");
    let Action::Across(over) = &got[1] else { panic!("{got:?}") };
    assert!(over.point.distance(Vec3::new(10.0, 20.0 + 1.0, 30.0 + 2.0)) < 1e-12, "{over:?}");
    assert!(over.axis().unwrap().distance(Vec3::X) < 1e-12, "{over:?}");
    let Action::Rapid(pose) = &got[2] else { panic!("{got:?}") };
    assert!(pose.point.distance(Vec3::new(10.0 + 3.0, 20.0 + 1.0, 30.0 + 2.0)) < 1e-12, "{pose:?}");
}

#[test]
fn a_tilted_plane_is_complete_and_reached_before_anything_moves() {
    let plane = "G68.2 X0 Y0 Z0 I0 J45. K0\n";
    for rest in
        ["G0 X1.", "G53.1\nG0 A5.", "G53.1\nG53 Z0", "G53.1\nG43.4 H1", "G68.2 X0 Y0 Z0 I0 J0 K0"]
    {
        assert_eq!(rule(FANUC, &format!("{plane}{rest}\n")), "tilted-plane", "{rest}");
    }
    assert_eq!(rule(FANUC, "G68.2 X0 Y0 Z0 I0 J45.\n"), "tilted-plane");
    assert_eq!(rule(FANUC, "G53.1\n"), "tilted-plane");
}

#[test]
fn in_a_tilted_plane_nothing_goes_down_at_an_unknown_place() {
    let plane = "G68.2 X0 Y0 Z0 I0 J45. K0\nG53.1\nG0 ";
    assert_eq!(rule(FANUC, &format!("{plane}X0 Z9.\n")), "unknown-position");
    assert_eq!(ops(FANUC, &format!("{plane}X0 Y0\nZ9.\n")).len(), 3);
}

#[test]
fn a_spindle_needs_a_speed_and_coolants_add_up_where_the_manual_says_so() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        assert_eq!(rule(dialect, "M3\n"), "spindle");
        let got = ops(dialect, "S500 M4\nS600\nM5\nM7\nM9\nM2\n");
        let expected = [
            Action::Spindle(Spindle::CounterClockwise(500.0)),
            Action::Spindle(Spindle::CounterClockwise(600.0)),
            Action::Spindle(Spindle::Off),
            Action::Coolant(Coolant::Mist),
            Action::Coolant(Coolant::Off),
            Action::End,
        ];
        assert_eq!(got, expected);
    }
    // Whether a FANUC then runs both is the builder's choice; LinuxCNC's and GRBL's manuals say so.
    assert_eq!(rule(FANUC, "M7\nM8\n"), "coolant");
    for dialect in [LINUXCNC, GRBL] {
        let both = [Action::Coolant(Coolant::Flood), Action::Coolant(Coolant::FloodAndMist)];
        assert_eq!(ops(dialect, "M8\nM7\n"), both);
    }
    assert_eq!(rule(FANUC, "S1 M3\nG1 X1. F9 M5\n"), "m-function");
    // The cycle ends in the block, which then goes by rapid.
    let drilled = "G0 X0. Y0. Z9.\nM8\nG98 G81 Z-1. R1. F9\n";
    for end in ["G80 G0 Z20. M9", "G0 Z20. M9", "G80 M9"] {
        let got = ops_3(FANUC, &format!("{drilled}{end}\n"));
        assert_eq!(got.last(), Some(&Action::Coolant(Coolant::Off)), "{end}");
    }
    for end in ["G80 G1 Z20. M9", "X5. M9", "G81 X5. M9"] {
        assert_eq!(rule(FANUC, &format!("{drilled}{end}\n")), "m-function", "{end}");
    }
}

#[test]
fn nothing_follows_the_end_of_a_program() {
    for dialect in [FANUC, LINUXCNC, GRBL] {
        assert_eq!(rule(dialect, "M30\nG0 X1.\n"), "after-end");
        assert_eq!(ops(dialect, "M2\n\n(only words)\n").len(), 2);
    }
    assert_eq!(rule(FANUC, "%\nO1\nM30\n%\nO2\n"), "after-end");
    assert_eq!(rule(LINUXCNC, "%\n%\n%\n"), "syntax");
}

#[test]
fn comments_are_reported_and_messages_too() {
    let got = ops(LINUXCNC, "(first) G0 (MSG, look) ; last\n");
    let expected = [
        Action::Comment("first".into()),
        Action::Message("look".into()),
        Action::Comment("last".into()),
    ];
    assert_eq!(got, expected);
    assert_eq!(rule(FANUC, "G0 ; no comment\n"), "syntax");
    assert_eq!(rule(FANUC, "(a (b))\n"), "comment");
    assert_eq!(rule(GRBL, "(never closed\n"), "comment");
}

#[test]
fn blanks_within_a_number_are_refused_though_linuxcnc_would_close_them_up() {
    assert_eq!(rule(LINUXCNC, "G0 X1 0\n"), "syntax");
    assert_eq!(rule(FANUC, "g0 x1.\n"), "syntax");
    assert_eq!(ops_3(LINUXCNC, "g0 x 1 y2z3\n"), [Action::Rapid(at(1.0, 2.0, 3.0))]);
}

/// The points of a spline, and how far the lines between them leave it. `at` gives the curve.
fn along_a_spline(blocks: &str, at: impl Fn(f64) -> [f64; 2]) {
    let text = format!("G21 G90\nF100 G0 X0 Y0 Z0\n{blocks}\nM2\n");
    let curve: Vec<[f64; 2]> = (0..=20_000).map(|i| at(f64::from(i) / 20_000.0)).collect();
    let mut here = [0.0; 2];
    let mut count = 0;
    for op in ops_3(LINUXCNC, &text) {
        let Action::Line(pose) = op else { continue };
        let to = [pose.point.x, pose.point.y];
        let near = |p: [f64; 2]| {
            let far = |q: &[f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
            curve.iter().map(far).fold(f64::INFINITY, f64::min)
        };
        let middle = [(here[0] + to[0]) / 2.0, (here[1] + to[1]) / 2.0];
        // The curve is known in steps of about 0.0003 mm.
        assert!(near(to) < 2e-4 && near(middle) < 7e-4, "{blocks}: {to:?}");
        (here, count) = (to, count + 1);
    }
    assert!(count > 5 && here == at(1.0), "{blocks}: {count} lines to {here:?}");
}

#[test]
fn splines_are_the_curves_of_bezier_that_their_words_give() {
    // LinuxCNC's manual: I J from the start, P Q from the end, are the two points between.
    along_a_spline("G5 I0 J3 P0 Q-3 X1 Y1", |t| {
        let (a, b, c) = (3.0 * t * (1.0 - t) * (1.0 - t), 3.0 * t * t * (1.0 - t), t * t * t);
        [b + c, 3.0 * a - 2.0 * b + c]
    });
    // A quadratic one has one point between: G5.1 I J.
    along_a_spline("G5.1 X-2 Y0 I-1 J2", |t| {
        let (a, b) = (2.0 * t * (1.0 - t), t * t);
        [-a - 2.0 * b, 2.0 * a]
    });
}
