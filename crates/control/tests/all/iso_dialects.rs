//! Haas, Mach3, Marlin and GRBL: what each has of its own, and what it does not know.

use geom::Vec3;
use program::{Axes, Coolant, Cycle, CycleKind, Diagnostic, PathMode, Spindle};
use toolpost_control::{Action, Dialect, Settings, StartModes, read};

fn run(dialect: Dialect, text: &str) -> Result<Vec<Action>, Box<Diagnostic>> {
    let start_modes = StartModes::SURE;
    let settings = Settings { start_modes, ..Settings::new(dialect, [false; 3]) };
    crate::common::ops(&settings, "p.nc", text)
}

fn ops(dialect: Dialect, text: &str) -> Vec<Action> {
    run(dialect, text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[track_caller]
fn rule(dialect: Dialect, text: &str) -> &'static str {
    match run(dialect, text) {
        Ok(ops) => panic!("taken:\n{text}\n{ops:?}"),
        Err(error) => error.rule.name(),
    }
}

fn points(ops: &[Action]) -> Vec<Vec3> {
    ops.iter().filter_map(|op| Some(op.position()?.point)).collect()
}

#[track_caller]
fn are(points: &[Vec3], expected: &[[f64; 3]]) {
    let near = |(a, b): (&Vec3, &[f64; 3])| a.distance(Vec3::from(*b)) < 1e-9;
    let same = points.len() == expected.len() && points.iter().zip(expected).all(near);
    assert!(same, "{points:?}\n{expected:?}");
}

#[test]
fn haas_patterns_make_a_hole_of_the_cycle_at_each_place() {
    let program = |pattern: &str| {
        format!("G21 G90 G0 X10. Y5. Z20.\nG98 G81 Z-3. R2. F100. L0\n{pattern}\nG80\n")
    };
    let holes = |pattern: &str| -> Vec<Vec3> {
        let hole = |op| if let Action::Hole(pose) = op { Some(pose.point) } else { None };
        ops(Dialect::Haas, &program(pattern)).into_iter().filter_map(hole).collect()
    };
    // Radius 4, the first at 90°, four of them, counter-clockwise about (10, 5).
    let circle = [[10.0, 9.0, 2.0], [6.0, 5.0, 2.0], [10.0, 1.0, 2.0], [14.0, 5.0, 2.0]];
    are(&holes("G70 I4. J90. L4"), &circle);
    are(&holes("G71 I4. J0. K90. L2"), &[[14.0, 5.0, 2.0], [10.0, 9.0, 2.0]]);
    are(&holes("G72 I3. J90. L3"), &[[10.0, 5.0, 2.0], [10.0, 8.0, 2.0], [10.0, 11.0, 2.0]]);
    assert_eq!(rule(Dialect::Haas, &program("G70 I4. J90.")), "pattern");
    assert_eq!(rule(Dialect::Haas, "G21 G0 X0 Y0 Z0\nG70 I4. J90. L4\n"), "pattern");
}

#[test]
fn a_haas_taps_without_m3_and_counts_seconds_where_there_is_a_point() {
    let got = ops(Dialect::Haas, "G21 G90 G0 X0 Y0 Z9.\nS500\nG99 G84 Z-9. R1. F625.\nG80\n");
    let tap = Cycle {
        kind: CycleKind::Tap { pitch: 1.25, left: false },
        depth: 10.0,
        clearance: 0.0,
        retract: 0.0,
        feed: None,
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    assert!(got.contains(&Action::Cycle(Box::new(tap))), "{got:?}");
    assert!(got.contains(&Action::Spindle(Spindle::Clockwise(500.0))), "{got:?}");
    assert_eq!(ops(Dialect::Haas, "G4 P1.5\nG4 P250\n"), [Action::Dwell(1.5), Action::Dwell(0.25)]);
}

#[test]
fn haas_coolant_through_the_spindle_has_its_own_way_off() {
    let got = ops(Dialect::Haas, "M88\nM89\nM8\nM9\n");
    let expected =
        [Coolant::Through, Coolant::Off, Coolant::Flood, Coolant::Off].map(Action::Coolant);
    assert_eq!(got, expected);
    assert_eq!(rule(Dialect::Haas, "M88\nM9\n"), "coolant");
    assert_eq!(rule(Dialect::Haas, "M8\nM88\n"), "coolant");
    assert_eq!(rule(Dialect::Haas, "M7\n"), "unknown-word");
}

#[test]
fn haas_refuses_with_the_reason() {
    for word in ["G12 I5.", "G13 I5.", "G47", "G77", "G107", "G141", "G143", "G150", "G174"] {
        let error = run(Dialect::Haas, &format!("G21\n{word}\n")).unwrap_err();
        assert_eq!(error.rule.name(), "unknown-word", "{word}");
        assert!(!error.help.is_empty(), "{word}");
    }
    // How far it may leave the path: G187 with E, and without it as the machine is set up.
    let corners = [
        PathMode::Blend(0.01),
        PathMode::ExactStop,
        PathMode::Blend(0.01),
        PathMode::AsSetUp,
        PathMode::AsSetUp,
        PathMode::ExactStop,
        PathMode::AsSetUp,
    ];
    let said = "G103 P1\nG21\nG187 P3 E0.01\nG61\nG64\nG187 P2\nG187\nG61\nG64\n";
    assert_eq!(ops(Dialect::Haas, said), corners.map(Action::PathMode));
    for p in ["P9", "P-1", "P1.5", "P0"] {
        assert_eq!(rule(Dialect::Haas, &format!("G21\nG187 {p} E0.01\n")), "number", "{p}");
    }
    assert_eq!(rule(Dialect::Haas, "G21\nG0 X1\n"), "decimal-point");
}

#[test]
fn mach3_cuts_a_circular_pocket_out_and_back() {
    let got = ops(Dialect::Mach3, "G21 G90 G0 X1 Y2 Z-1\nF100\nG13 I5\nG12 I5\n");
    let moves = &got[2..];
    let ccw = |op: &Action| matches!(op, Action::Arc(arc) if arc.normal == Vec3::Z);
    assert!(
        matches!(moves[0], Action::Line(_))
            && ccw(&moves[1])
            && matches!(moves[2], Action::Line(_))
    );
    assert!(matches!(&moves[4], Action::Arc(arc) if arc.normal == Vec3::NEG_Z));
    let Action::Arc(arc) = &moves[1] else { panic!() };
    assert_eq!((arc.center, arc.turns), (Vec3::new(1.0, 2.0, -1.0), 0));
    let way = [[6.0, 2.0, -1.0], [6.0, 2.0, -1.0], [1.0, 2.0, -1.0]];
    are(&points(moves), &[way, way].concat());
}

#[test]
fn mach3_takes_its_own_words_and_no_others() {
    // G70 and G71 are inches and mm; small letters and numbers without a point are understood.
    let got = ops(Dialect::Mach3, "g70\ng0 x1 y2 z3\n");
    are(&points(&got), &[[25.4, 50.8, 76.2]]);
    let got = ops(Dialect::Mach3, "G21 G90.1 G0 X0 Y0 Z0\nG2 X10 Y0 I5 J0 F9\n");
    assert!(matches!(&got[2], Action::Arc(arc) if arc.center == Vec3::new(5.0, 0.0, 0.0)));
    for word in ["G33", "G38.2", "G43.4", "G51.1", "G7", "G76", "G96", "M88", "M62"] {
        assert_eq!(rule(Dialect::Mach3, &format!("{word}\n")), "unknown-word", "{word}");
    }
    let both = [Action::Coolant(Coolant::Mist), Action::Coolant(Coolant::FloodAndMist)];
    assert_eq!(ops(Dialect::Mach3, "M7\nM8\n"), both);
}

#[test]
fn marlin_takes_one_command_a_line_and_needs_it_on_each() {
    let got = ops(Dialect::Marlin, "G21\nG90\nG0 X1 Y2 Z3\nG1 X5 F300\n; done\nM400\n");
    are(&points(&got), &[[1.0, 2.0, 3.0], [5.0, 2.0, 3.0]]);
    assert_eq!(rule(Dialect::Marlin, "G21 G90\n"), "many-commands");
    assert_eq!(rule(Dialect::Marlin, "G21\nG0 X1\nX2\n"), "missing-word");
    assert_eq!(rule(Dialect::Marlin, "G21\nG0 X1 E2\n"), "unknown-word");
    assert_eq!(rule(Dialect::Marlin, "G21\ng0 X1\n"), "syntax");
    assert_eq!(rule(Dialect::Marlin, "(no comment)\n"), "syntax");
    assert_eq!(rule(Dialect::Marlin, "%\n"), "syntax");
    assert_eq!(rule(Dialect::Marlin, "G21\nG0 X\n"), "number");
}

#[test]
fn marlin_dwells_homes_and_ends_in_its_own_way() {
    let mut got = ops(Dialect::Marlin, "G4 P500\nG4 S2\nG28 X Y\nG28\nM3 S1000\nM5\n");
    // Where the switch of Z is.
    got.retain(|action| !matches!(action, Action::Risk(_)));
    let expected = [
        Action::Dwell(0.5),
        Action::Dwell(2.0),
        Action::Home(Axes::X | Axes::Y),
        Action::Home(Axes::LINEAR),
        Action::Spindle(Spindle::Clockwise(1000.0)),
        Action::Spindle(Spindle::Off),
        Action::End,
    ];
    assert_eq!(got, expected);
    for word in ["M2", "M30", "M6", "M106", "G81", "G43", "G41", "G10", "G5", "G93"] {
        assert_eq!(rule(Dialect::Marlin, &format!("{word}\n")), "unknown-word", "{word}");
    }
    let deletes = run(Dialect::Marlin, "M30\n").unwrap_err();
    assert!(deletes.help.contains("deletes"), "{}", deletes.help);
}

/// `GcodeSuite::M3_M4` of Marlin: without S at SPEED_POWER_STARTUP of the firmware, and not at the speed before.
#[test]
fn marlin_needs_s_with_each_start_of_the_spindle() {
    for start in ["M3\n", "M4\n", "M3 S2000\nM5\nM3\n", "M3 S2000\nM4\n", "M3 S2000\nM3\n"] {
        assert_eq!(rule(Dialect::Marlin, start), "spindle", "{start}");
    }
    let got = ops(Dialect::Marlin, "M3 S2000\nM5\nM4 S1000\n");
    let [Action::Spindle(first), _, Action::Spindle(second), Action::End] = &got[..] else {
        panic!("{got:?}")
    };
    assert_eq!((*first, *second), (Spindle::Clockwise(2000.0), Spindle::CounterClockwise(1000.0)));
}

#[test]
fn marlin_keeps_its_axes_while_m84_only_says_how_long() {
    assert_eq!(ops(Dialect::Marlin, "M84 S0\nM18 S1800\n"), [Action::End]);
    assert_eq!(rule(Dialect::Marlin, "M84\n"), "unknown-position");
    assert_eq!(rule(Dialect::Marlin, "G21\nG0 X1 S5\n"), "unused-word");
}

#[test]
fn marlin_shows_texts() {
    let message = |text: &str| Action::Message(text.into());
    assert_eq!(
        ops(Dialect::Marlin, "M0 Attach ZProbe\nM117 2D Profile1 ; shown\nM0\n")[..4],
        [
            message("Attach ZProbe"),
            Action::Stop,
            Action::Comment("shown".into()),
            message("2D Profile1")
        ]
    );
    // How long it waits, which no record says.
    assert_eq!(rule(Dialect::Marlin, "M0 S5\n"), "unused-word");
}

#[test]
fn linuxcnc_runs_programs_of_the_machine_with_p_and_q() {
    assert!(run(Dialect::LinuxCnc, "M190 P1\n").unwrap_err().help.contains("auxiliary"));
    let settings =
        Settings { auxiliary: vec![190], ..Settings::new(Dialect::LinuxCnc, [false; 3]) };
    let read = |text: &str| read(&settings, "p", text.as_bytes(), &mut |_| Ok(()));
    assert!(read("M190 P1 Q2\n").is_ok());
    assert!(read("M190 R1\n").is_err());
}

#[test]
fn grbl_says_what_is_for_its_console_and_its_sender() {
    let help = |text: &str| run(Dialect::Grbl, text).unwrap_err().help;
    assert!(help("$H\n").contains("by hand"));
    assert!(help("%Z = 5\n").contains("take the line out"));
    assert!(help("T1\nM6\n").contains("write M0"));
    assert!(help("G64\n").contains("take it out"));
    // protocol_main_loop: what stands in a comment is thrown away up to the first bracket that closes.
    assert_eq!(ops(Dialect::Grbl, "M8 (a (b) M3 S9\n").len(), 3);
}

#[test]
fn grbl_writes_offsets_homes_and_probes() {
    let got = ops(
        Dialect::Grbl,
        "G21 G90\nG92.1\nG10 L2 P1 X1 Y1 Z1\nG0 X1 Y1 Z1\nG10 L2 P1 X3\nX1\nG10 L20 P0 X0\nX1\nG92 Z0\nZ1\nG92.1\nZ1\n",
    );
    are(
        &points(&got),
        // The zero moves by 2, then to where the tool is, then up by 1, then back.
        &[[1.0, 1.0, 1.0], [3.0, 1.0, 1.0], [4.0, 1.0, 1.0], [4.0, 1.0, 2.0], [4.0, 1.0, 1.0]],
    );
    for (word, kind) in [
        ("G38.2", (false, true)),
        ("G38.3", (false, false)),
        ("G38.4", (true, true)),
        ("G38.5", (true, false)),
    ] {
        let got = ops(Dialect::Grbl, &format!("G21\nG0 X0 Y0 Z0\nF9\n{word} Z-5\n"));
        let Some(Action::Probe(probe)) = got.last() else { panic!("{got:?}") };
        assert_eq!((probe.away, probe.must_answer), kind, "{word}");
    }
    for words in ["$H", "$J=G91X1", "G43 H1", "G10 L1 P1 Z1", "G92.2", "G52 X1", "M6"] {
        assert!(run(Dialect::Grbl, &format!("G21\n{words}\n")).is_err(), "{words}");
    }
}

/// U, V and W are axes that run along X, Y and Z where a machine has them, and on lathes their increments: no machine of ours has
/// them, and a block that moves them is never read as one that does not.
#[test]
fn further_axes_are_refused_by_what_they_are_on_each_control() {
    for (dialect, says) in [
        (Dialect::Fanuc, "parameter 1020"),
        (Dialect::Haas, "auxiliary"),
        (Dialect::LinuxCnc, "[TRAJ]COORDINATES"),
        (Dialect::Mach3, "six axes"),
        (Dialect::Grbl, "error 20"),
        (Dialect::Marlin, "AXIS4_NAME"),
        (Dialect::FanucWire, "a wire has X, Y, U and V"),
        (Dialect::Sodick, "a wire has X, Y, U and V"),
        (Dialect::Agie, "a wire has X, Y, U and V"),
    ] {
        let units = if dialect == Dialect::Agie { "G71" } else { "G21" };
        for word in ["U5.", "V5.", "W5.", "X1. W0."] {
            let is_wire = matches!(dialect, Dialect::FanucWire | Dialect::Sodick | Dialect::Agie);
            if is_wire && !word.contains('W') {
                continue;
            }
            let z = if is_wire { "" } else { "Z5. " };
            let error = run(dialect, &format!("{units}\nG90\nG0 X0. Y0. {z}\nG0 {word}\n"));
            let error = error.map(|_| ()).unwrap_err();
            assert_eq!(error.rule, "unknown-word", "{dialect:?} {word}");
            assert!(error.help.contains(says), "{dialect:?}: {}", error.help);
        }
    }
}
