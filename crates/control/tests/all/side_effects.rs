//! What a control does besides its words: lengths that end or change, home positions that cancel, stops that switch off,
//! feeds that count otherwise on arcs. Each fact is from the manual that is named with it.

use geom::Vec3;
use program::{Coolant, Diagnostic, Feed, PathMode, Spindle};
use toolpost_control::{Action, Dialect, Kinematics, Orientation, Position, Settings, TableAxis};

/// What a program does on a machine with B and C.
fn run(dialect: Dialect, text: &str) -> Result<Vec<Action>, Box<Diagnostic>> {
    crate::common::ops(&Settings::new(dialect, [false, true, true]), "p.nc", text)
}

fn actions(dialect: Dialect, text: &str) -> Vec<Action> {
    run(dialect, text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The same where the machine's file says how B and C are counted.
fn risks_counted(dialect: Dialect, modulo: Option<bool>, text: &str) -> Vec<&'static str> {
    let settings = Settings {
        modulo: [None, modulo, modulo],
        rotary_by_sign: Some(false),
        ..Settings::new(dialect, [false, true, true])
    };
    let actions =
        crate::common::ops(&settings, "p.nc", text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    rules(&actions)
}

/// The rules of what hangs on something that the program does not say.
fn risks(dialect: Dialect, text: &str) -> Vec<&'static str> {
    rules(&actions(dialect, text))
}

/// Those that the proof refuses. What the end of a program leaves on has tests of its own (`left_on.rs`), and so have the modes of
/// its start (`start.rs`).
fn rules(actions: &[Action]) -> Vec<&'static str> {
    let rule = |action: &Action| match action {
        Action::Risk(risk)
            if risk.refused && !["left-on", "start-mode"].contains(&risk.rule.name()) =>
        {
            Some(risk.rule.name())
        }
        _ => None,
    };
    actions.iter().filter_map(rule).collect()
}

/// B-64484EN-2, "Tool length compensation"; parameter 5006, bit 6: the axis moves where it is 0, the coordinates where
/// it is 1 (B-63943EN-1 p. 1654: "If no move command is specified together with the G43, G44, or G49 command, the tool will not
/// move" is said of the latter alone). G28, G30 and G53 take the offset away at their end (B-63844EN p. 204), so that G49 behind them
/// moves nothing, while a length that begins at home does; where a block says Z its end is the same on both.
#[test]
fn a_length_that_changes_on_fanuc_moves_z_or_does_not() {
    const START: &str = "G21 G90 G94 G17 G54\nT1 M6\nG91 G28 Z0.\nG90 G0 X0. Y0.\n";
    for (block, harmless) in [
        ("G43 H1 Z50.\nG49", false),
        ("G43 H1 Z50.\nG43 H0", false),
        ("G43 H1 Z50.\nH2\nZ60.", false),
        ("G43 H1 Z50.\nG43 H2\nZ60.", false),
        ("G43.4 H1 Z50.\nG49", false),
        ("G0 Z50.\nG43 H1\nZ40.", false),
        ("G43 H1 Z50.\nG49 Z60.", true),
        ("G43 H1 Z50.\nG91 G28 Z0.\nG49", true),
        ("G43 H1 Z50.\nG90 G53 Z0.\nG49", true),
        ("G43 H1 Z50.\nG91 G28 Z0.\nG90 X50.\nG49", true),
        ("G43 H1 Z50.\nG91 G28 X0.\nG49", false),
        ("G43 H1 Z50.\nG91 G28 Z0.\nG90 Z30.\nG49", false),
        ("G43.4 H1 Z50.\nG91 G28 Z0.\nG49", true),
        // With the tool centre kept, words of X and Y may move Z.
        ("G43.4 H1 Z50.\nG91 G28 Z0.\nG90 X50. Y0. B0. C0.\nG49", false),
        // At home a length moves Z as anywhere else: up beyond its end, or, with negative registers, down onto the part.
        ("G43 H1\nZ50.", false),
        ("G43 H1\nG90 Z50.", false),
        ("G43.4 H1\nX0. Y0. Z50.", false),
        ("G43.4 X0. Y0. Z50. H1", true),
        ("G43 H1 Z50.\nG91 G28 Z0.\nG90 G43 H2\nZ50.", false),
        ("G43 H1 Z50.\nG91 G28 Z0.\nG90 G43 H2 Z50.", true),
        // No length is active.
        ("Z50.\nG49", true),
    ] {
        let expected: &[&str] = if harmless { &[] } else { &["length-change"] };
        let mut found = risks(Dialect::Fanuc, &format!("{START}{block}\nM30\n"));
        found.dedup();
        assert_eq!(found, expected, "{block}");
    }
    // By so much, from where it was: with 5006#6 = 0 the length is added to that. Z of a cycle is the bottom of its hole.
    let known = "G10 L10 P1 R30.\nG10 L10 P2 R40.\nG43 H1 Z50.";
    for (block, reported) in [
        ("G91 G43 H2 Z-10.\nG90", true),
        ("G43 H2 G98 G81 X5. Y5. Z-5. R2. F100.\nG80", true),
        ("G43 H2 Z40.", false),
    ] {
        let found = risks(Dialect::Fanuc, &format!("{START}{known}\n{block}\nM30\n"));
        assert_eq!(found.contains(&"length-change"), reported, "{block}");
    }
}

/// On a machine whose file says that the coordinates move (5006#6 is 1) a length may begin wherever it likes.
#[test]
fn a_length_that_begins_alone_moves_nothing_where_the_coordinates_take_it() {
    let text = "G21 G90 G94 G17 G54\nT1 M6\nG91 G28 Z0.\nG90 G0 X0. Y0.\nG43 H1\nZ50.\nG91 G28 Z0.\nG49\nM30\n";
    for (moves_axis, expected) in
        [(Some(false), &[][..]), (Some(true), &["length-change"]), (None, &["length-change"])]
    {
        let settings = Settings {
            length_moves_axis: moves_axis,
            ..Settings::new(Dialect::Fanuc, [false, true, true])
        };
        assert_eq!(
            rules(&crate::common::ops(&settings, "p.nc", text).unwrap()),
            expected,
            "{moves_axis:?}"
        );
    }
}

/// B-63844EN p. 204: "When G53, G28, or G30 is specified in tool length offset mode, tool length offset vectors are canceled ...
/// However, the previously specified modal G code remains displayed"; which block gives them back parameter 5001#6 says.
#[test]
fn behind_g28_of_a_fanuc_the_length_counts_again_where_g43_and_h_say_so() {
    const START: &str =
        "G21 G90 G94 G17 G98 G54\nT1 M6\nG91 G28 Z0.\nG90 G0 X0. Y0.\nG43 H1 Z50.\n";
    for (blocks, harmless) in [
        ("G91 G28 Z0.\nG90 Z50.", false),
        ("G91 G30 Z0.\nG90 Z50.", false),
        ("G53 Z0.\nX5.\nZ50.", false),
        ("G91 G28 Z0.\nG90 G43 H1 Z50.", true),
        ("G91 G28 Z0.\nG90 X5.\nG43 Z50. H1", true),
        ("G53 Z0.\nH1 Z50.", true),
        ("G91 G28 Z0.\nG49\nG90 Z50.", true),
        ("G91 G28 X0.\nG90 Z50.", true),
        ("G91 G28 Z0.\nG90 X50. Y50.", true),
    ] {
        let expected: &[&str] = if harmless { &[] } else { &["length-change"] };
        let found = risks(Dialect::Fanuc, &format!("{START}{blocks}\nG91 G28 Z0.\nM30\n"));
        let found: Vec<_> = found.into_iter().filter(|rule| *rule != "stored-position").collect();
        assert_eq!(found, expected, "{blocks}");
    }
    // Haas ends the length there, which the next move without one is refused for; LinuxCNC keeps it.
    let other = format!("{START}G91 G28 Z0.\nG90 Z50.\nM30\n");
    assert_eq!(risks(Dialect::Haas, &other), [""; 0]);
}

/// B-64484EN, "AI contour control": a mode for contours. Where else it may be on is a matter of model and parameters.
#[test]
fn look_ahead_is_for_contours() {
    const START: &str = "G21 G90 G94 G17 G98 G54\nT1 M6\nS500 M3\nG91 G28 Z0.\nG90 G0 X0. Y0. B0. C0.\nG43 H1 Z50.\n";
    const FIVE: &str = "G91 G28 Z0.\nG90 G49";
    const BEGINS: &str = "G43.4 X0. Y0. Z50. H1";
    const ENDS: &str = "G91 G28 Z0.\nG90 G49";
    for (on, off) in [("G5.1 Q1", "G5.1 Q0"), ("G5 P10000", "G5 P0"), ("G8 P1", "G8 P0")] {
        for (blocks, harmless) in [
            (format!("{on}\nG1 Z1. F100.\n{off}"), true),
            (format!("{on}\nG1 Z1. F100."), false),
            (format!("{on}\nG81 Z-5. R2. F100.\nG80\n{off}"), false),
            (format!("{on}\n{off}\nG81 Z-5. R2. F100.\nG80"), true),
            (format!("{on}\nG91 G28 Z0.\nG90\nT2 M6\n{off}"), false),
            (
                format!("{on}\nG91 G28 Z0.\nG90\nG49\nG68.2 X0. Y0. Z0. I0. J9. K0.\nG69\n{off}"),
                false,
            ),
            (format!("{FIVE}\n{on}\n{BEGINS}\n{off}\n{ENDS}"), false),
            (format!("{FIVE}\n{BEGINS}\n{on}\n{off}\n{ENDS}"), true),
            (format!("{FIVE}\n{BEGINS}\n{on}\n{ENDS}\n{off}"), false),
        ] {
            let expected: &[&str] = if harmless { &[] } else { &["look-ahead"] };
            assert_eq!(
                risks(Dialect::Fanuc, &format!("{START}{blocks}\nM30\n")),
                expected,
                "{blocks}"
            );
        }
    }
}

/// A number that is missing is not 0, and look-ahead neither begins nor ends by a word that says which of both nowhere.
#[test]
fn look_ahead_goes_on_and_off_by_its_number_in_a_block_of_its_own() {
    for block in
        ["G5.1", "G5", "G8", "G5.1 P1", "G8 Q1", "G8 P2", "G5 P1", "G5.1 Q1 X5.", "G8 P1 G0"]
    {
        let text = format!("G21 G90 G94 G17\nG0 X0. Y0. Z5.\n{block}\nM30\n");
        let found = run(Dialect::Fanuc, &text).map(|_| ()).map_err(|error| error.rule.name());
        assert!(found.is_err(), "{block}");
    }
}

/// iTNC 530 (60642x-04) p. 202: M101 changes to a replacement tool by itself, between two blocks, when the life of the tool is over;
/// TNC 320 (77185x-01) p. 355: M148 takes the tool off the contour by up to 2 mm at a stop.
#[test]
fn a_heidenhain_that_changes_a_worn_tool_or_lifts_it_off_by_itself_is_reported() {
    let reported = |function: &str| {
        let program = format!(
            "BEGIN PGM T MM\nTOOL CALL 5 Z S100\nL X+0 Y+0 Z+9 B+0 C+0 R0 FMAX {function}\nL X+5 F100\nEND PGM T MM\n"
        );
        let risk = |action: &Action| match action {
            Action::Risk(risk) => Some((risk.rule.name(), risk.refused)),
            _ => None,
        };
        actions(Dialect::Klartext, &program).iter().filter_map(risk).collect::<Vec<_>>()
    };
    assert_eq!(reported("M101"), [("replacement-tool", true)]);
    assert_eq!(reported("M101 BT10"), [("replacement-tool", true)]);
    assert_eq!(reported("M102"), []);
    assert_eq!(reported("M148"), [("stop-retract", false)]);
    assert_eq!(reported("M149"), []);
}

/// PM p. 678: `_TC` names the swivel data set; the name may be left out where the machine has one only. Another set is
/// another kinematics.
#[test]
fn a_swivel_data_set_is_the_one_of_the_machines_file() {
    let found = |stated: &str, named: &str, rotary: [bool; 3]| {
        let settings =
            Settings { swivel_data: stated.into(), ..Settings::new(Dialect::Sinumerik, rotary) };
        let text =
            format!("T1 M6 D1\nG0 X0 Y0 Z9\nCYCLE800(1,{named},0,57,0,0,0,30,0,0,0,0,0,-1)\nM30\n");
        rules(
            &crate::common::ops(&settings, "p.mpf", &text)
                .unwrap_or_else(|e| panic!("{e}\n{text}")),
        )
    };
    let five = [true, false, true];
    for (stated, named, same) in [
        ("", "\"\"", true),
        ("", "", true),
        ("", "\"R_DATA\"", false),
        ("TABLE", "\"TABLE\"", true),
        ("TABLE", "\"HEAD\"", false),
        ("TABLE", "\"\"", false),
        ("TABLE", "", false),
    ] {
        let expected: &[&str] = if same { &[] } else { &["swivel-data"] };
        assert_eq!(found(stated, named, five), expected, "{stated} {named}");
    }
    // Without rotary axes the plane is a frame, and no kinematics is asked for.
    assert_eq!(found("", "\"R_DATA\"", [false; 3]), [""; 0]);
}

/// Haas, "G234 - Tool Center Point Control": of the group of the tool length, ended by `G49`.
#[test]
fn g234_of_haas_keeps_the_tool_tip_and_ends_by_g49() {
    const START: &str = "G21 G90 G94 G17 G98 G54\nT1 M6\nS500 M3\nG53 G0 Z0.\nG0 B30. C0.\n";
    let center = |text: &str| -> Vec<bool> {
        let text = format!("{START}{text}\nM30\n");
        let lines = actions(Dialect::Haas, &text).into_iter().filter_map(|action| match action {
            Action::Line(Position {
                orientation: Orientation::Rotary { tool_center, .. }, ..
            }) => Some(tool_center),
            _ => None,
        });
        lines.collect()
    };
    let cut = "G1 X0. Y0. Z0. F100.\nX5. B40.\n";
    assert_eq!(center(&format!("G234 H1 X0. Y0. Z50.\n{cut}G49\nG53 G0 Z0.")), [true; 2]);
    assert_eq!(center(&format!("G43 H1 X0. Y0. Z50.\n{cut}")), [false; 2]);
    for (blocks, rule) in [
        ("G234 X0. Y0. Z50.", "length-offset"),
        ("G234 H1 X0. Y0. Z50.\nG53 G0 Z0.", "machine-position"),
        ("G234 H1 X0. Y0. Z50.\nG91 G28 Z0.", "machine-position"),
        ("G234 H1 X0. Y0. Z50.\nG81 Z-5. R2. F100.", "cycle"),
        // Nobody knows where the table turns.
        ("G254", "dynamic-offset"),
    ] {
        let found = run(Dialect::Haas, &format!("{START}{blocks}\nM30\n")).unwrap_err();
        assert_eq!(found.rule.name(), rule, "{blocks}");
    }
}

/// Haas, "G254 - Dynamic Work Offset (DWO)" (UMC-750 manual p. 40): X, Y and Z count from the work zero as the table has carried
/// it. By hand: B turns about a line 100 mm below the zero, against the right hand: B30 takes the zero to X -100 sin 30°,
/// Z -100 (1 - cos 30°).
#[test]
fn g254_of_haas_carries_the_work_zero_with_the_table() {
    const START: &str = "G21 G90 G94 G17 G98 G54\nT1 M6\nS500 M3\nG53 G0 Z0.\nG0 B30. C0.\n";
    let axes = [
        TableAxis { index: 2, point: Vec3::new(0.0, 0.0, -100.0), axis: -Vec3::Z, offset: 0.0 },
        TableAxis { index: 1, point: Vec3::new(0.0, 0.0, -100.0), axis: -Vec3::Y, offset: 0.0 },
    ];
    let haas = Settings {
        table_axes: Some(axes.to_vec()),
        ..Settings::new(Dialect::Haas, [false, true, true])
    };
    let run = |text: &str| crate::common::ops(&haas, "p.nc", format!("{START}{text}\nM30\n"));
    let cuts = |text: &str| -> Vec<Position> {
        let actions = run(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let cut = |action| if let Action::Line(to) = action { Some(to) } else { None };
        actions.into_iter().filter_map(cut).collect()
    };
    let approach = "G0 X0. Y0.\nG43 H1 Z50.\n";
    let cut = "G1 X10. Y20. Z30. F100.";
    let carried = Vec3::new(-50.0, 0.0, -100.0 * (1.0 - 30f64.to_radians().cos()));
    let [plain] = cuts(&format!("{approach}{cut}"))[..] else { panic!() };
    let [dynamic] = cuts(&format!("G254\n{approach}{cut}\nG53 G0 Z0.\nG255"))[..] else { panic!() };
    assert_eq!(plain.point, Vec3::new(10.0, 20.0, 30.0));
    assert!(dynamic.point.distance(plain.point + carried) < 1e-12, "{dynamic:?}");
    assert_eq!(dynamic.orientation, plain.orientation);
    // Behind G255 the zero is where it was set up.
    let after = cuts(&format!("G254\nG255\n{approach}{cut}"));
    assert_eq!(after, [plain]);
    // What stood there before says nothing of X, Y and Z behind it.
    let unsaid = cuts(&format!("{approach}G254\nG1 X5. F100.\nG255"));
    assert!(unsaid[0].point.y.is_nan() && unsaid[0].point.z.is_nan(), "{unsaid:?}");
    for blocks in [
        "G254 X0.",
        "G254\nG0 B0.",
        "G254\nG53 G0 B0.",
        "G254\nG55",
        "G254\nG52 X5.",
        "G254\nG92 X5.",
        "G254\nG68 X0. Y0. R30.",
        "G254\nG51 X0. Y0. P2.",
        "G254\nG101 X0.",
        "G254\nG234 H1 X0. Y0. Z50.",
        "G254\nG10 L2 P1 X0.",
        "G254\nG91 G28 Z0.",
        "G55\nG254",
        "G52 X5.\nG254",
        "G234 H1 X0. Y0. Z50.\nG254",
    ] {
        let found = run(blocks).expect_err(blocks);
        assert_eq!(found.rule.name(), "dynamic-offset", "{blocks}: {found}");
    }
    let unturned =
        crate::common::ops(&haas, "p.nc", "G21 G90 G94 G17 G54\nG53 G0 Z0.\nG254\nM30\n");
    assert!(unturned.unwrap_err().message.contains("how the table stands"));
}

/// Out of a tilted plane the reference position is reached before `G49` and `G69`; where the tool then stands in the
/// work nobody knows.
#[test]
fn fanuc_goes_home_out_of_a_tilted_plane() {
    const TILTED: &str = "G21 G90 G94 G17 G54\nT1 M6\nG91 G28 Z0.\nG90 G68.2 X0. Y0. Z0. I0. J30. K0.\nG53.1\n\
                          G0 X0. Y0.\nG43 H1 Z50.\n";
    assert!(
        risks(Dialect::Fanuc, &format!("{TILTED}G91 G28 Z0.\nG90\nG49\nG69\nM30\n")).is_empty()
    );
    let over_the_part = format!("{TILTED}G49\nG69\nM30\n");
    assert_eq!(risks(Dialect::Fanuc, &over_the_part), ["length-change"]);
    let unknown = format!("{TILTED}G91 G28 Z0.\nG90 G69\nG1 X5. F100.\nM30\n");
    let cut = actions(Dialect::Fanuc, &unknown);
    let cut = cut.iter().find_map(|a| if let Action::Line(to) = a { Some(to.point) } else { None });
    assert!(cut.is_some_and(|point| point.x == 5.0 && point.y.is_nan() && point.z.is_nan()));
}

/// Parameters 1013#1 and 1015#7: P counts milliseconds, or tenths of them. 3405#1: seconds under `G95`, or turns. `G4 X` with
/// its point counts seconds under `G94` everywhere.
#[test]
fn how_long_a_fanuc_dwells_hangs_on_its_parameters() {
    let dwell = |dwell_p_milliseconds, block: &str| {
        let settings =
            Settings { dwell_p_milliseconds, ..Settings::new(Dialect::Fanuc, [false; 3]) };
        let text = format!("G21\nG90 G94 G17 G54\nS100 M3\nG0 X0. Y0. Z5.\n{block}\nM30\n");
        let found =
            crate::common::ops(&settings, "p.nc", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let seconds = found.iter().find_map(|action| match action {
            Action::Dwell(seconds) => Some(*seconds),
            Action::Cycle(cycle) => Some(cycle.dwell),
            _ => None,
        });
        (rules(&found), seconds.unwrap())
    };
    let (known, unknown) = (vec![], vec!["dwell-unit"]);
    let cycle = "G98 G82 Z-5. R2. P500 F100";
    for block in ["G4 P500", cycle] {
        assert_eq!(dwell(None, block), (unknown.clone(), 0.5));
        assert_eq!(dwell(Some(true), block), (known.clone(), 0.5));
        assert_eq!(dwell(Some(false), block), (known.clone(), 0.05));
    }
    assert_eq!(dwell(None, "G4 X0.5"), (known.clone(), 0.5));
    assert_eq!(dwell(None, "G4 P0"), (known.clone(), 0.0));
    assert_eq!(dwell(None, "G95 G4 X0.5"), (unknown, 0.5));
    assert_eq!(dwell(None, "G95\nG94 G4 X0.5"), (known, 0.5));
}

/// B-64484EN-2, "Inch/metric conversion": in a block of its own. What moves is the same, so that it is reported and not refused.
#[test]
fn fanuc_wants_the_unit_in_a_block_of_its_own() {
    for (block, found) in [("G21", 0), ("N10 G21", 0), ("G21 G17 G40", 1), ("G20 G90", 1)] {
        let text = format!("{block}\nM30\n");
        let reported: Vec<_> = actions(Dialect::Fanuc, &text)
            .into_iter()
            .filter_map(|a| {
                if let Action::Risk(risk) = a {
                    Some((risk.rule.name(), risk.refused))
                } else {
                    None
                }
            })
            .collect();
        assert_eq!(reported, vec![("unit-block", false); found], "{block}");
        assert_eq!(risks(Dialect::Haas, &text), [""; 0]);
    }
}

/// Haas, *Mill Operator's Manual*, G28: the return to machine zero cancels the tool length offset.
#[test]
fn haas_cancels_the_length_at_machine_zero() {
    let lengths = |dialect| {
        let text =
            "G21 G90 G94 G17 G54\nT1 M6\nG0 X0. Y0.\nG43 H1 Z50.\nG28 G91 Z0.\nG90 X5.\nM30\n";
        let offset = |action: &Action| match action {
            Action::LengthOffset(register) => Some(*register),
            _ => None,
        };
        actions(dialect, text).iter().filter_map(offset).collect::<Vec<_>>()
    };
    assert_eq!(lengths(Dialect::Haas), [Some(1), None]);
    assert_eq!(lengths(Dialect::Fanuc), [Some(1)]);
}

/// Haas, *Mill Operator's Manual*, M00 and M01: the spindle stops, and the coolant goes off.
#[test]
fn a_stop_of_haas_stops_the_spindle_and_the_coolant() {
    for stop in ["M0", "M1"] {
        let text = format!("G21 G90 G94 G17 G54\nT1 M6\nS1000 M3\nM8\n{stop}\nM30\n");
        let after = |dialect| {
            let found = actions(dialect, &text);
            let at = found.iter().position(|a| matches!(a, Action::Stop | Action::OptionalStop));
            found[at.unwrap() + 1..].to_vec()
        };
        let off = [Action::Spindle(Spindle::Off), Action::Coolant(Coolant::Off), Action::End];
        assert_eq!(after(Dialect::Haas), off);
        assert_eq!(after(Dialect::Fanuc), [Action::End]);
    }
}

/// Somebody opens the door behind a stop. That spindle and coolant then stand is sure on Haas (*Mill Operator's Manual*, M00), and
/// of the spindle of a HEIDENHAIN at `M0` (TNC 640, "M0": spindle STOP; `M1`: as the machine's builder has it). GRBL's `M0` is a feed
/// hold, which leaves both on (wiki, "Grbl v1.1 Commands"); LinuxCNC's pauses the program ("M0, M1"). `M1` of GRBL does nothing.
#[test]
fn a_stop_with_spindle_or_coolant_running_is_reported_where_the_control_need_not_stop_them() {
    use Dialect as D;
    for (dialect, stops, running) in [
        (D::Fanuc, ["M0", "M1"], [true; 3]),
        (D::Haas, ["M0", "M1"], [false; 3]),
        (D::LinuxCnc, ["M0", "M1"], [true; 3]),
        (D::Mach3, ["M0", "M1"], [true; 3]),
        (D::Grbl, ["M0", "M0"], [true; 3]),
        (D::Grbl, ["M1", "M1"], [false; 3]),
        (D::Marlin, ["M0", "M0"], [true; 3]),
        (D::Sinumerik, ["M0", "M1"], [true; 3]),
        (D::Klartext, ["M0", "M0"], [true, false, true]),
        (D::Klartext, ["M1", "STOP"], [true; 3]),
        // A change of the tool stops the spindle everywhere, of coolant that is sure of the TNC alone (640 p. 171).
        (D::Fanuc, ["T2 M6", "T2 M6"], [true, false, true]),
        (D::Haas, ["T2 M6", "T2 M6"], [true, false, true]),
        (D::LinuxCnc, ["T2 M6", "T2 M6"], [true, false, true]),
        (D::Mach3, ["T2 M6", "T2 M6"], [true, false, true]),
        (D::Sinumerik, ["T2 M6", "T2 M6"], [true, false, true]),
        (D::Klartext, ["TOOL CALL 2 Z S100", "TOOL CALL 2 Z S100"], [false; 3]),
    ] {
        for stop in stops {
            let on = [("M3", "M8"), ("M3", "M9"), ("M5", "M8")];
            for ((spindle, coolant), running) in on.into_iter().zip(running) {
                let blocks = match dialect {
                    D::Klartext => {
                        numbered(&format!("TOOL CALL 1 Z S100\n{spindle}\n{coolant}\n{stop}\nM30"))
                    }
                    D::Sinumerik => {
                        format!("G54 G90 G94\nT1\nM6\nS1000 {spindle}\n{coolant}\n{stop}\nM30\n")
                    }
                    D::Grbl | D::Marlin => {
                        format!("G21\nG90\nG54\n{spindle} S1000\n{coolant}\n{stop}\n")
                    }
                    _ => {
                        format!("G90 G94 G17 G54\nT1 M6\nS1000 {spindle}\n{coolant}\n{stop}\nM30\n")
                    }
                };
                let expected: &[&str] = if running { &["stop-running"] } else { &[] };
                assert_eq!(risks(dialect, &blocks), expected, "{dialect:?}\n{blocks}");
            }
        }
    }
    // A tool that is put in by hand, and the stop of a macro.
    let by_hand = "G21 G90 G94 G17 G54\nT1\nM0\nM8\nT2\nM0\nM30\n";
    assert_eq!(risks(D::Grbl, by_hand), ["stop-running"]);
    let by_macro = "G21 G90 G94 G17 G54\nT1 M6\nS1000 M3\n#3006=1 (LOOK)\nM30\n";
    assert_eq!(risks(D::Fanuc, by_macro), ["stop-running"]);
}

/// B-62764EN, "Inverse time feed": on an arc F is the feed divided by the radius. Half a circle of radius 10 at
/// 200 mm/min: F20, and a π·10/200 of a minute. Haas counts strokes a minute there too.
#[test]
fn in_inverse_time_an_arc_of_fanuc_counts_by_its_radius() {
    for (dialect, rate) in [
        (Dialect::Fanuc, 20.0 / std::f64::consts::PI),
        (Dialect::Haas, 20.0),
        (Dialect::LinuxCnc, 20.0),
    ] {
        let text = "G21 G90 G94 G17 G54\nG0 X10. Y0. Z0.\nG93 G3 X-10. Y0. I-10. J0. F20.\nG1 X-20. F20.\nM30\n";
        let feeds: Vec<Feed> = actions(dialect, text)
            .iter()
            .take_while(|action| !matches!(action, Action::Line(_)))
            .filter_map(|action| if let Action::Feed(feed) = action { Some(*feed) } else { None })
            .collect();
        let at = feeds.len() - if dialect == Dialect::Fanuc { 2 } else { 1 };
        let Feed::InverseTime(counted) = feeds[at] else { panic!("{feeds:?}") };
        assert!((counted - rate).abs() < 1e-12, "{dialect:?} {feeds:?}");
        assert_eq!(feeds.last(), Some(&Feed::InverseTime(20.0)));
    }
}

/// B-62764EN, "Inverse time feed": F1 is 0.001, or 1 where parameter 3401#0 is 1; F1.0 is 1; F takes 0.001 to 9999.999.
#[test]
fn in_inverse_time_f_of_fanuc_needs_its_point_and_ends_at_9999_999() {
    let read = |whole_numbers, f: &str| {
        let mut settings = Settings::new(Dialect::Fanuc, [false; 3]);
        settings.setup.whole_numbers = whole_numbers;
        let text = format!("G21 G90 G94 G17 G54\nG0 X10. Y0. Z0.\nG93 G1 X0. {f}\nM30\n");
        let mut rate = None;
        let run = toolpost_control::read(&settings, "p.nc", text.as_bytes(), &mut |event| {
            if let Action::Feed(Feed::InverseTime(f)) = event.action {
                rate = Some(f);
            }
            Ok(())
        });
        run.map(|()| rate.unwrap()).map_err(|found| found.rule.name())
    };
    use toolpost_control::WholeNumbers::{Increments, Units, Unknown};
    assert_eq!(read(Unknown, "F20"), Err("decimal-point"));
    assert_eq!(read(Increments, "F20"), Ok(0.02));
    assert_eq!(read(Units, "F20"), Ok(20.0));
    assert_eq!(read(Unknown, "F20."), Ok(20.0));
    assert_eq!(read(Unknown, "F9999.999"), Ok(9999.999));
    assert_eq!(read(Unknown, "F10000."), Err("feed"));
}

/// TNC 620 user's manual, "Shorter-path traverse of rotary axes: M126"; SINUMERIK *Axes and Spindles*, MD30310 and MD30455;
/// FANUC B-64484EN-2, "Rotary axis roll-over". The sources say nothing of an axis that is not counted modulo 360°.
#[test]
fn the_way_of_a_rotary_axis_over_the_part_is_the_same_however_it_is_counted() {
    let klartext = |start: &str, moves: &str| {
        let text =
            format!("BEGIN PGM P MM\nTOOL CALL 1 Z S1000\n{start}\n{moves}M30\nEND PGM P MM\n");
        text.lines().enumerate().map(|(i, line)| format!("{i} {line}\n")).collect::<String>()
    };
    let turn = |from: f64, to: f64| {
        format!("L B+0 C{from:+} R0 FMAX\nL X+0 Y+0 Z+10 R0 FMAX\nL C{to:+} R0 F1000\n")
    };
    for (from, to, plain, shorter) in [
        (-9.8, 0.16, false, true),
        (350.0, 370.0, false, true),
        (10.0, 40.0, true, true),
        (-30.0, -10.0, true, true),
        (0.0, 180.0, false, false),
        (0.0, 200.0, false, false),
    ] {
        let expected = |held: bool| if held { vec![] } else { vec!["rotary-way"] };
        let moves = turn(from, to);
        for modulo in [None, Some(true)] {
            let found = |start| risks_counted(Dialect::Klartext, modulo, &klartext(start, &moves));
            assert_eq!(found("M127"), expected(plain), "{from} {to}");
            assert_eq!(found("M126"), expected(shorter), "{from} {to}");
            let fanuc = format!(
                "G21 G90 G94 G54\nG0 B0. C{from:.3}\nX0. Y0. Z10.\nG1 C{to:.3} F100.\nM30\n"
            );
            assert_eq!(risks_counted(Dialect::Fanuc, modulo, &fanuc), expected(shorter));
            let sinumerik =
                format!("G54 G90 G94\nG0 B0 C={from}\nX0 Y0 Z10\nG1 C={to} F100\nM30\n");
            let within = modulo.is_none() || (0.0..360.0).contains(&to);
            let risks = risks_counted(Dialect::Sinumerik, modulo, &sinumerik);
            assert_eq!(risks, expected(plain && within), "{from} {to}");
        }
        let counts_on = risks_counted(Dialect::Klartext, Some(false), &klartext("M127", &moves));
        assert!(counts_on.is_empty());
        // Away from the part an axis may turn as it likes.
        let away = klartext(
            "M127",
            &format!("L C{from:+} R0 FMAX\nL Z+0 R0 FMAX M91\nL C{to:+} R0 FMAX\n"),
        );
        assert!(risks_counted(Dialect::Klartext, None, &away).is_empty());
    }
    let by_dc = "G54 G90 G94\nG0 B0 C=350\nX0 Y0 Z10\nG1 C=DC(10) F100\nC=IC(300)\nM30\n";
    assert!(risks_counted(Dialect::Sinumerik, None, by_dc).is_empty());
}

/// SINUMERIK Axes and Spindles, "Modulo rotary axis": a position is within 0 to 359.999, otherwise alarm 16830, unless bit 0 of
/// MD30455 brings it there.
#[test]
fn a_position_of_a_modulo_axis_is_within_a_turn() {
    let sinumerik =
        |block: &str| format!("G54 G90 G94\nG0 B0 C=350\nX0 Y0 Z10\nG1 {block} F100\nM30\n");
    for block in ["C=DC(370)", "C=DC(-10)", "C=DC(360)", "C=ACP(400)", "C=ACN(-1)"] {
        let rule = run(Dialect::Sinumerik, &sinumerik(block)).map_err(|error| error.rule.name());
        assert_eq!(rule, Err("modulo-position"), "{block}");
    }
    for (block, found) in [("C=-10", 1), ("C=370", 1), ("C=340", 0), ("C=IC(40)", 0)] {
        let risks = risks_counted(Dialect::Sinumerik, Some(true), &sinumerik(block));
        assert_eq!(risks, vec!["rotary-way"; found], "{block}");
        assert!(risks_counted(Dialect::Sinumerik, Some(false), &sinumerik(block)).is_empty());
    }
}

/// FANUC parameter 1008#1 and LinuxCNC's `WRAPPED_ROTARY`: the sign of the word is the direction. GRBL and Mach3 have neither
/// word nor parameter.
#[test]
fn the_sign_of_a_rotary_word_may_be_its_direction() {
    let risks = |dialect, rotary_by_sign, (from, to): (f64, f64)| {
        let settings = Settings { rotary_by_sign, ..Settings::new(dialect, [false, true, true]) };
        let text =
            format!("G21\nG90 G94 G54\nG0 B0. C{from:.3}\nX0. Y0. Z10.\nG1 C{to:.3} F100.\nM30\n");
        rules(
            &crate::common::ops(&settings, "p.nc", &text).unwrap_or_else(|e| panic!("{e}\n{text}")),
        )
    };
    for (turn, shorter, by_sign) in [
        ((10.0, 40.0), true, true),
        ((10.0, 300.0), false, true),
        ((40.0, 10.0), true, false),
        ((10.0, -20.0), true, false),
        ((350.0, 370.0), true, true),
    ] {
        let expected = |held: bool| if held { vec![] } else { vec!["rotary-way"] };
        assert_eq!(risks(Dialect::Fanuc, Some(false), turn), expected(shorter), "{turn:?}");
        assert_eq!(risks(Dialect::Fanuc, Some(true), turn), expected(by_sign), "{turn:?}");
        assert_eq!(risks(Dialect::Fanuc, None, turn), expected(shorter && by_sign), "{turn:?}");
        assert_eq!(risks(Dialect::LinuxCnc, None, turn), expected(by_sign), "{turn:?}");
        assert!(risks(Dialect::Mach3, None, turn).is_empty());
    }
}

/// Fundamentals 12/2019, "Settable work offset": on an 828D G58 and G59 call the fifth and the sixth, and there is no G505,
/// G506; on an 840D sl G58 and G59 are programmable.
#[test]
fn the_fifth_work_offset_of_an_828d_is_g58() {
    let offsets = |dialect, text: &str| -> Result<Vec<u32>, &'static str> {
        let settings = Settings::new(dialect, [false; 3]);
        let found =
            crate::common::ops(&settings, "p.nc", text).map_err(|error| error.rule.name())?;
        let number = |action: &Action| match action {
            Action::WorkOffset(offset) => Some(offset.number()),
            _ => None,
        };
        Ok(found.iter().filter_map(number).collect())
    };
    let (of_840d, of_828d) = (Dialect::Sinumerik, Dialect::Sinumerik828d);
    assert_eq!(offsets(of_828d, "G58\nG0 X1\nG59 X1\nG507 X1\nM30\n"), Ok(vec![58, 59, 60]));
    assert_eq!(offsets(of_840d, "G505\nG0 X1\nG506 X1\nG507 X1\nM30\n"), Ok(vec![58, 59, 60]));
    assert_eq!(offsets(of_828d, "G505\nM30\n"), Err("unknown-word"));
    assert_eq!(offsets(of_840d, "G54\nG58 X10\nG0 X1\nM30\n"), Ok(vec![54]));
}

/// SINUMERIK *Tools*, SD42940: as delivered the plane decides along which axis the length counts, G17 Z, G18 Y, G19 X. FANUC
/// parameter 5001: length type A is Z, type B the axis that stands on the plane.
#[test]
fn a_tool_length_in_another_plane_counts_along_another_axis() {
    let risks = |dialect, length_along_z, text: &str| {
        let settings = Settings { length_along_z, ..Settings::new(dialect, [false; 3]) };
        rules(
            &crate::common::ops(&settings, "p.nc", text).unwrap_or_else(|e| panic!("{e}\n{text}")),
        )
    };
    let sinumerik = "G54 G90 G94 G17\nT1\nM6\nD1\nG0 X0 Y0 Z5\nG18 G1 Z0 F100\nG2 X10 Z0 I5 K0\nG17 G0 Z5\nM30\n";
    for (length_along_z, found) in [(None, 2), (Some(false), 2), (Some(true), 0)] {
        let expected = vec!["length-plane"; found];
        assert_eq!(risks(Dialect::Sinumerik, length_along_z, sinumerik), expected);
    }
    // Without an edge there is no length.
    let none = sinumerik.replace("\nD1\n", "\nD0\n");
    assert!(risks(Dialect::Sinumerik, None, &none).is_empty());

    let fanuc = "G21 G90 G94 G54\nT1 M6\nG18\nG0 X0. Y0.\nG43 Z5. H1\nM30\n";
    for (length_along_z, found) in [(None, 1), (Some(false), 1), (Some(true), 0)] {
        let expected = vec!["length-plane"; found];
        assert_eq!(risks(Dialect::Fanuc, length_along_z, fanuc), expected);
        assert!(risks(Dialect::Haas, length_along_z, fanuc).is_empty());
    }
    // What has begun along Z stays there.
    let before = fanuc.replace("G18\n", "").replace("M30", "G18 G1 X5. F100.\nM30");
    assert!(risks(Dialect::Fanuc, None, &before).is_empty());
}

/// SINUMERIK W1 11/2006 p. 13, "Selection of the cutting edge when changing tool": the edge that is programmed; else what MD20270
/// says, which is none (0), an edge by its number, or the number of the tool before (-1). With MD22550 = 1 a D before M6 is an edge of
/// the tool that is still in the spindle. In G17 the length counts along Z, and with the first motion of that axis.
#[test]
fn the_edge_of_a_sinumerik_is_said_behind_the_change() {
    let found = |edge_at_change, blocks: &str| {
        let settings =
            Settings { edge_at_change, ..Settings::new(Dialect::Sinumerik, [true, false, true]) };
        let text = format!("G17 G54 G71 G90 G94\nG0 SUPA Z0 D0\n{blocks}\nM30\n");
        let actions = crate::common::ops(&settings, "p.mpf", &text);
        let actions = actions.unwrap_or_else(|e| panic!("{e}\n{text}"));
        let edge = actions.iter().rev().find_map(|action| match action {
            Action::LengthOffset(edge) => Some(*edge),
            _ => None,
        });
        (rules(&actions).len(), rules(&actions).iter().all(|r| *r == "tool-edge"), edge.unwrap())
    };
    let leans = (1, true, Some(1));
    for blocks in [
        "T1 D1\nM6\nG0 X0 Y0\nZ5",
        "D1 T1\nM6\nG0 X0 Y0 Z5",
        "T1 M6\nG0 X0 Y0\nZ5\nG1 Z1 F100",
        "D0\nT1\nM6\nG0 X0 Y0 Z5",
        // One tool is said its edge, the next one is not.
        "T1 M6 D1\nG0 X0 Y0 Z5\nSUPA Z0 D0\nT2 M6\nG0 X0 Y0\nZ5",
        "T1 M6\nG0 X0 Y0\nF100\nCYCLE81(5,0,2,-5)",
        "T1 M6\nG0 G41 X0 Y0\nG40 X5",
        "T1 M6\nTRAORI\nORIWKS ORIVECT\nG54\nG0 X0 Y0",
        "T1 M6\nCYCLE800(0,\"\",0,57,0,0,0,0,30,0,0,0,0,1)\nG0 X0 Y0",
        "T1 M6\nPOS[Z]=5",
        "T1 M6\nG18\nG0 Y5",
    ] {
        let (count, only, edge) = found(None, blocks);
        // G18 with an edge, and a frame that turns, are reported for themselves.
        assert!(count >= leans.0 && edge == leans.2, "{blocks} {count} {edge:?}");
        assert!(only || blocks.contains("G18"), "{blocks}");
        assert!(found(Some(1), blocks).0 < count, "{blocks}");
    }
    for (blocks, edge) in [
        ("T1\nM6\nD1\nG0 X0 Y0 Z5", Some(1)),
        ("T1 D1 M6\nG0 X0 Y0 Z5", Some(1)),
        ("T1 M6 D2\nG0 X0 Y0 Z5", Some(2)),
        ("T1 M6\nG0 X0 Y0\nZ5 D1\nG1 Z1 F100", Some(1)),
        ("T1 M6\nD0\nG0 X0 Y0 Z5", None),
        // The place of an axis in the machine has nothing to do with the length.
        ("T1 M6\nG75 Z0\nSUPA X0 Y0\nD1\nG0 X0 Y0 Z5", Some(1)),
    ] {
        assert_eq!(found(None, blocks), (0, true, edge), "{blocks}");
    }
    let silent = "T1 M6\nG0 X0 Y0 Z5";
    assert_eq!(found(Some(0), silent), (0, true, None));
    assert_eq!(found(Some(2), silent), (0, true, Some(2)));
    assert_eq!(found(Some(2), "T1 D1\nM6\nG0 X0 Y0 Z5"), (0, true, Some(2)));
}

/// Before any D the edge of the program before may count (MD20110, bit 6), and `SUPA` leaves it on.
#[test]
fn where_a_sinumerik_is_in_the_machine_is_known_behind_d0_alone() {
    let height = |blocks: &str| {
        let found = actions(Dialect::Sinumerik, &format!("G90\n{blocks}\nM30\n"));
        let moved = found.iter().find_map(|action| match action {
            Action::MachineMove(to) => to.linear[2],
            _ => None,
        });
        moved.unwrap()
    };
    assert!(height("G0 SUPA Z0").is_nan());
    assert_eq!(height("G0 SUPA Z0 D0"), 0.0);
    assert_eq!(height("D0\nG0 SUPA Z0"), 0.0);
    assert!(height("D0\nT1 M6\nG0 SUPA Z0").is_nan());
}

/// Job Planning 7.2.6 and NC programming 4.3.51: MD21104 decides whether ORIWKS and ORIMKS or ORIVECT and ORIAXES say how the tool
/// turns within a block. Vectors are meant on the great circle, positions of axes as the axes turn evenly.
#[test]
fn how_the_tool_turns_under_traori_is_said_by_two_words_that_agree() {
    let settings = Settings::new(Dialect::Sinumerik, [true, false, true]);
    let risks = |text: &str| {
        let found =
            crate::common::ops(&settings, "p.mpf", text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        rules(&found).into_iter().filter(|rule| *rule == "orientation-way").count()
    };
    let vectors = |words: &str| {
        risks(&format!(
            "G54 G90 G94\nTRAORI\nG54 D1\n{words}G0 X0 Y0 Z50 A3=0 B3=0 C3=1\nG1 X5 F500\nX10 A3=0.1 B3=0 C3=1\nX20 A3=0.1 B3=0 C3=1\nM30\n"
        ))
    };
    let positions = |words: &str| {
        risks(&format!(
            "G54 G90 G94\nTRAORI\nG54 D1\n{words}G0 X0 Y0 Z50 A0 C0\nG1 X5 F500\nX10 A10 C5\nX20 A10 C5\nM30\n"
        ))
    };
    for (words, by_vectors, by_positions) in [
        ("", 1, 1),
        ("ORIWKS\n", 1, 1),
        ("ORIVECT\n", 1, 1),
        ("ORIAXES\n", 1, 1),
        ("ORIWKS\nORIVECT\n", 0, 1),
        ("ORIWKS\nORIPLANE\n", 0, 1),
        ("ORIWKS\nORIAXES\n", 1, 1),
    ] {
        assert_eq!((vectors(words), positions(words)), (by_vectors, by_positions), "{words}");
    }
    // With ORIMKS no vector is taken at all.
    for (words, found) in [("ORIMKS\n", 1), ("ORIMKS\nORIVECT\n", 1), ("ORIMKS\nORIAXES\n", 0)] {
        assert_eq!(positions(words), found, "{words}");
    }
    // The last word of a group counts.
    assert_eq!(positions("ORIMKS\nORIAXES\nORIVECT\n"), 1);
}

/// FANUC parameters 1241 to 1243, LinuxCNC #5161 and #5181, GRBL `G28.1`: these positions are the operator's. A way home
/// that the program itself has stored is known.
#[test]
fn a_stored_position_is_no_reference_position() {
    for (dialect, block, reported) in [
        (Dialect::Fanuc, "G91 G28 Z0.", false),
        (Dialect::Fanuc, "G91 G30 Z0.", true),
        (Dialect::Fanuc, "G91 G30 P4 Z0.", true),
        (Dialect::Fanuc, "G91 G30 P4 X0.", false),
        (Dialect::Haas, "G91 G28 Z0.", false),
        (Dialect::Haas, "G91 G30 Z0.", true),
        (Dialect::Mach3, "G91 G28 Z0", false),
        (Dialect::Mach3, "G91 G30 Z0", true),
        (Dialect::LinuxCnc, "G91 G28 Z0", true),
        (Dialect::LinuxCnc, "G30", true),
        (Dialect::Grbl, "G91 G28 Z0", true),
    ] {
        let settings = Settings::new(dialect, [false; 3]);
        let text = format!("G21 G90 G94 G17 G54\nG0 X0. Y0. Z50.\n{block}\nM30\n");
        let found =
            crate::common::ops(&settings, "p.nc", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let expected: &[&str] = if reported { &["stored-position"] } else { &[] };
        assert_eq!(rules(&found), expected, "{dialect:?} {block}");
    }
}

/// TNC 620 10/2017 p. 556: MOVE tilts the tool relative to its tip, and so X, Y and Z go along.
#[test]
fn plane_move_takes_z_away_from_home() {
    let settings = Settings::new(Dialect::Klartext, [false, true, true]);
    for (block, reported) in [
        ("PLANE SPATIAL SPA+30 SPB+0 SPC+0 MOVE FMAX", true),
        ("PLANE SPATIAL SPA+30 SPB+0 SPC+0 MOVE DIST50 F1000", true),
        ("PLANE RESET MOVE FMAX", true),
        ("PLANE SPATIAL SPA+30 SPB+0 SPC+0 TURN FMAX", false),
        ("PLANE RESET STAY", false),
    ] {
        let blocks = ["TOOL CALL 1 Z S900", "L Z+0 R0 FMAX M91", block, "PLANE RESET STAY", "M30"];
        let blocks = blocks.into_iter().chain(["END PGM P MM"]).enumerate();
        let text: String = blocks.map(|(i, block)| format!("{} {block}\n", i + 1)).collect();
        let found =
            crate::common::ops(&settings, "p.h", format!("0 BEGIN PGM P MM\n{text}")).unwrap();
        let expected: &[&str] = if reported { &["turn-height"] } else { &[] };
        assert_eq!(rules(&found), expected, "{block}");
    }
}

/// TNC 640, "Programmed interruption": `STOP` interrupts the program; spindle and coolant are switched by `M0`.
#[test]
fn stop_of_a_heidenhain_leaves_the_spindle_turning() {
    let settings = Settings::new(Dialect::Klartext, [false; 3]);
    let read = |off: &str, stop: &str| {
        let blocks =
            ["TOOL CALL 1 Z S900", "L X+0 Y+0 Z+9 R0 FMAX M3", off, stop, "M8", "M5", "M9", "M30"];
        let actions = crate::common::ops(&settings, "p.h", numbered(&blocks.join("\n"))).unwrap();
        let stops = actions.iter().position(|action| *action == Action::Stop).unwrap();
        let off_by_stop =
            matches!(actions.get(stops + 1), Some(Action::Spindle(program::Spindle::Off)));
        (rules(&actions).contains(&"stop-running"), off_by_stop)
    };
    assert_eq!(read("M9", "STOP"), (true, false));
    assert_eq!(read("M9", "M0"), (false, true));
    assert_eq!(read("M5", "STOP"), (false, false));
}

/// TNC 640, cycle 32: TA is how far the rotary axes may be off with M128; where the program says none, a parameter does.
#[test]
fn cycle_32_says_under_m128_by_how_much_the_tool_turns() {
    let settings = Settings {
        path_tolerance: 0.05,
        orientation_tolerance: 0.1,
        ..Settings::new(Dialect::Klartext, [false, true, true])
    };
    let read = |tolerance: &[&str]| {
        let start = ["TOOL CALL 1 Z S900", "L B+0 C+0 R0 FMAX", "M128", "CYCL DEF 32.0 TOLERANCE"];
        let cut = ["L X+0 Y+0 Z+9 R0 FMAX M3", "L X+5 B+3 F100", "M129", "M5", "M30"];
        let blocks: Vec<&str> = start.iter().chain(tolerance).chain(&cut).copied().collect();
        let found =
            rules(&crate::common::ops(&settings, "p.h", numbered(&blocks.join("\n"))).unwrap());
        found.contains(&"orientation-tolerance")
    };
    assert!(read(&["CYCL DEF 32.1 T0.02"]));
    assert!(!read(&["CYCL DEF 32.1 T0.02", "CYCL DEF 32.2 HSC-MODE:0 TA0.05"]));
    assert!(!read(&["CYCL DEF 32.1"]));
}

/// `M6` belongs to a tool call: with none it stops the program, or changes to a tool that nobody has called.
#[test]
fn m6_of_a_heidenhain_belongs_to_a_tool_call() {
    let settings = Settings::new(Dialect::Klartext, [false; 3]);
    let read = |end: &str| {
        let blocks = ["TOOL CALL 1 Z S900", "M6", "L X+0 Y+0 Z+9 R0 FMAX M3", "L Z+0 F100", end];
        crate::common::ops(&settings, "p.h", numbered(&blocks.join("\n"))).map(|_| ())
    };
    assert!(read("M30").is_ok());
    assert_eq!(read("M6").unwrap_err().rule.name(), "m-function");
}

/// M7 and M8 switch a coolant each, M9 both (the builder's PLC may have it otherwise). RET with arguments goes on elsewhere.
#[test]
fn a_sinumerik_adds_one_coolant_to_the_other_and_goes_back_behind_its_call() {
    let settings = Settings::new(Dialect::Sinumerik, [false; 3]);
    let read = |blocks: &str| {
        let text = format!("G17 G54\nG0 X0 Y0 Z50\n{blocks}\n");
        crate::common::ops(&settings, "p.nc", &text).map_err(|error| error.rule.name())
    };
    let both = Action::Coolant(program::Coolant::FloodAndMist);
    assert!(read("M7\nM8\nM9\nM30").unwrap().contains(&both));
    assert!(read("M8\nM7\nM9\nM30").unwrap().contains(&both));
    assert!(!read("M7\nM9\nM8\nM9\nM30").unwrap().contains(&both));
    assert!(read("RET").is_ok());
    for end in ["RET(5)", "RET(\"X\")", "RET(\"\",\"\",2)"] {
        assert_eq!(read(end).unwrap_err(), "call", "{end}");
    }
}

/// B-64484EN-2, "Rigid tapping": the spindle is an axis meanwhile; Haas `G84` turns it as well.
#[test]
fn no_spindle_is_switched_between_two_holes_of_a_rigid_tap() {
    for (dialect, rigid) in [(Dialect::Fanuc, "M29 S500\n"), (Dialect::Haas, "S500\n")] {
        let settings = Settings::new(dialect, [false; 3]);
        let read = |between: &str| {
            let text = format!(
                "G21\nG90 G94 G98 G17 G54\nG0 X0. Y0. Z9.\n{rigid}G98 G84 X5. Z-9. R2. F500.\n{between}\nX9.\nG80\nM30\n"
            );
            crate::common::ops(&settings, "p.nc", &text).map_err(|error| error.rule.name())
        };
        assert!(read("").is_ok(), "{dialect:?}");
        for word in ["M3", "M4", "M5", "M19"] {
            assert_eq!(read(word).unwrap_err(), "cycle", "{dialect:?} {word}");
        }
        assert!(read("G80 M5").is_ok() || read("G80\nM5").is_ok(), "{dialect:?}");
    }
}

/// NC programming, "Fixed point approach (G75)": FP=2 to 4 are MD30600[1] to [3], anywhere.
#[test]
fn a_further_fixed_point_of_a_sinumerik_is_a_stored_position() {
    let settings = Settings::new(Dialect::Sinumerik, [false; 3]);
    let read = |block: &str| {
        crate::common::ops(&settings, "p.nc", format!("G17 G54\nG0 X0 Y0 Z50\n{block}\nM30\n"))
    };
    for (block, reported) in [
        ("G75 Z0", false),
        ("G75 FP=1 Z0", false),
        ("G75 FP=2 Z0", true),
        ("G75 FP=4 Z1=0", true),
        ("G75 FP=3 X0", false),
        ("G74 Z1=0", false),
    ] {
        let expected: &[&str] = if reported { &["stored-position"] } else { &[] };
        assert_eq!(rules(&read(block).unwrap()), expected, "{block}");
    }
    assert_eq!(read("G75 FP=5 Z0").unwrap_err().rule.name(), "home");
}

/// GRBL and LinuxCNC: `G43.1` puts a length in; Marlin: `G28` goes to the switches; SINUMERIK *Fundamentals*, "Smoothing", and
/// "Compressor": MD33100 and MD33120 say how far, CTOL where it is written (Basic Functions 09/2011 p. 204: not for G644; below 0 it
/// takes back what was programmed).
#[test]
fn lengths_switches_and_smoothing_that_nobody_states_are_reported() {
    let risks_within = |dialect, path_tolerance, block: &str| {
        let settings = Settings { path_tolerance, ..Settings::new(dialect, [false; 3]) };
        let text = format!("G90\nG17\nG54\nG0 X0 Y0 Z50\n{block}\nG0 X5\n");
        let text =
            if dialect == Dialect::Sinumerik { text + "M30\n" } else { format!("G21\n{text}") };
        // What its own zeros are, Marlin says behind a move by G53.
        let text = match dialect {
            Dialect::Marlin => text.replace("G54\n", "G54\nG53 G0 Z100\n"),
            _ => text,
        };
        rules(
            &crate::common::ops(&settings, "p.nc", &text).unwrap_or_else(|e| panic!("{e}\n{text}")),
        )
    };
    assert_eq!(risks_within(Dialect::Grbl, 0.0, "G43.1 Z10"), ["operator-data"]);
    assert_eq!(risks_within(Dialect::Marlin, 0.0, "G28 Z"), ["stored-position"]);
    assert_eq!(risks_within(Dialect::Marlin, 0.0, "G28 X Y"), ["work-offset"]);
    assert_eq!(risks_within(Dialect::Marlin, 0.0, "G28 Y"), [""; 0]);
    // What the machine file allows is not what the machine data say.
    for word in ["G642", "G643", "G644", "G645", "COMPCAD", "COMPON", "CTOL=0\nCTOL=-1\nG645"] {
        for allowed in [0.0, 0.01] {
            let found = risks_within(Dialect::Sinumerik, allowed, word);
            assert_eq!(found, ["path-tolerance"], "{word}");
        }
    }
    for bounded in ["CTOL=0.01 G642", "COMPCAD G645\nCTOL=0.01", "G645\nCYCLE832(0.01,_FINISH,1)"] {
        assert_eq!(risks_within(Dialect::Sinumerik, 0.01, bounded), [""; 0], "{bounded}");
    }
    // No tolerance of CTOL counts for G644, and none is left when CYCLE832 has ended.
    for word in ["CTOL=0.01 G644", "G645\nCYCLE832(0.01,_FINISH,1)\nCYCLE832(0,_OFF,1)"] {
        assert_eq!(risks_within(Dialect::Sinumerik, 0.01, word), ["path-tolerance"], "{word}");
    }
    for off in ["G64\nCOMPOF\nG60", "G642\nG64", "COMPCAD\nCOMPOF", "G641 ADIS=0 ADISPOS=0"] {
        assert_eq!(risks_within(Dialect::Sinumerik, 0.0, off), [""; 0], "{off}");
    }
    let error = crate::common::ops(
        &Settings::new(Dialect::Fanuc, [false; 3]),
        "p.nc",
        "G21 G90\nG91 G28 Z0.\nG90 G29 Z5.\nM30\n",
    );
    assert_eq!(error.unwrap_err().rule.name(), "home");
}

/// What is switched off behind a block that says nothing of it: B-64484EN-2 and the Haas manual, "M functions"; SINUMERIK MD20270
/// for the edge; LinuxCNC "M Codes"; GRBL `gc_execute_line`, step 21; TNC 640, `TOOL CALL`, `M1`.
#[test]
fn a_change_a_stop_and_an_end_switch_what_their_control_switches() {
    const SPINDLE: Action = Action::Spindle(Spindle::Off);
    const COOLANT: Action = Action::Coolant(Coolant::Off);
    let edge = Action::LengthOffset(Some(1));
    let table: [(Dialect, &str, &[Action]); 15] = [
        (Dialect::Fanuc, "T2 M6", &[SPINDLE]),
        (Dialect::Fanuc, "M0", &[]),
        (Dialect::Fanuc, "M1", &[]),
        (Dialect::Fanuc, "M30", &[]),
        (Dialect::Haas, "M30", &[SPINDLE, COOLANT]),
        (Dialect::LinuxCnc, "T2 M6", &[SPINDLE]),
        (Dialect::LinuxCnc, "M2", &[SPINDLE, COOLANT]),
        (Dialect::Mach3, "T2 M6", &[SPINDLE]),
        (Dialect::Grbl, "M30", &[SPINDLE, COOLANT]),
        (Dialect::Sinumerik, "T2\nM6", &[SPINDLE, COOLANT, edge]),
        (Dialect::Sinumerik, "M1", &[]),
        (Dialect::Sinumerik, "M30", &[SPINDLE]),
        (Dialect::Mach3, "M30", &[]),
        (Dialect::Klartext, "TOOL CALL 2 Z S100", &[SPINDLE, COOLANT]),
        (Dialect::Klartext, "M1", &[SPINDLE, COOLANT]),
    ];
    for (dialect, block, switched) in table {
        // M17 of a SINUMERIK switches nothing.
        let end = match dialect {
            _ if block.starts_with("M30") || block == "M2" => "",
            Dialect::Sinumerik => "\nM17",
            _ => "\nM30",
        };
        let text = match dialect {
            Dialect::Klartext => format!("TOOL CALL 1 Z S100\nM13\n{block}{end}"),
            Dialect::Grbl => format!("G21 G90 G94 G17 G54\nS1000 M3\nM8\n{block}{end}\n"),
            Dialect::Sinumerik => format!("G54 G90 G94\nT1\nM6\nS1000 M3\nM8\n{block}{end}\n"),
            _ => format!("G90 G94 G17 G54\nT1 M6\nS1000 M3\nM8\n{block}{end}\n"),
        };
        let text = if dialect == Dialect::Klartext { numbered(&text) } else { text };
        let found = actions(dialect, &text);
        // What follows the coolant, up to the end of the program.
        let on = found.iter().position(|a| matches!(a, Action::Coolant(Coolant::Flood))).unwrap();
        let kept = |a: &&Action| {
            matches!(a, Action::Spindle(_) | Action::Coolant(_) | Action::LengthOffset(_))
        };
        let until_end = found[on + 1..].iter().filter(kept).cloned();
        let found: Vec<Action> = until_end.take(switched.len().max(1)).collect();
        assert_eq!(found, switched, "{dialect:?} {block}");
    }
}

/// A program of Klartext with its numbers.
fn numbered(blocks: &str) -> String {
    let text = format!("BEGIN PGM P MM\n{blocks}\nEND PGM P MM");
    text.lines().enumerate().map(|(i, line)| format!("{i} {line}\n")).collect()
}

/// Haas, "G43": nothing moves, the next Z counts. LinuxCNC 2.9 itself: the same, and an X behind it brings no Z.
#[test]
fn a_length_alone_moves_nothing_and_leaves_z_unknown_until_it_is_named() {
    for dialect in [Dialect::Haas, Dialect::LinuxCnc] {
        let text =
            "G21 G90 G94 G17 G54\nT1 M6\nG0 X0. Y0. Z50.\nG43 H1\nX5.\nZ40.\nG49\nX6.\nM30\n";
        let found = actions(dialect, text);
        let places: Vec<[f64; 2]> = found
            .iter()
            .filter_map(|a| if let Action::Rapid(to) = a { Some(to.point) } else { None })
            .map(|point| [point.x, point.z])
            .collect();
        assert_eq!(places.len(), 4, "{dialect:?} {places:?}");
        assert_eq!((places[0], places[2]), ([0.0, 50.0], [5.0, 40.0]));
        for place in [places[1], places[3]] {
            assert!(place[0] > 0.0 && place[1].is_nan(), "{dialect:?} {places:?}");
        }
        assert!(rules(&found).is_empty());
    }
}

/// Data and keys of the operator: what is written stays when the program has ended.
#[test]
fn data_and_keys_of_the_operator_are_reported() {
    for (dialect, block, rule) in [
        (Dialect::Fanuc, "G10 L2 P1 X0. Y0. Z-5.", "operator-data"),
        (Dialect::Fanuc, "G92 X0.", "operator-data"),
        (Dialect::Fanuc, "#3003=1", "operator-controls"),
        (Dialect::Fanuc, "#3004=7", "operator-controls"),
        (Dialect::LinuxCnc, "G92 X0", "operator-data"),
        (Dialect::LinuxCnc, "G52 X1", "operator-data"),
        (Dialect::LinuxCnc, "G10 L2 P1 X0", "operator-data"),
        (Dialect::LinuxCnc, "G43.1 Z5", "operator-data"),
        (Dialect::LinuxCnc, "M61 Q2", "operator-data"),
        (Dialect::Sinumerik, "$P_UIFR[1,X,TR]=5", "operator-data"),
        (Dialect::Sinumerik, "G25 X-5", "operator-data"),
        (Dialect::Sinumerik, "G26 Z900", "operator-data"),
        (Dialect::Sinumerik, "G26 S3000", "operator-data"),
        (Dialect::Fanuc, "#500=5.", "operator-data"),
        (Dialect::Fanuc, "#999=5.", "operator-data"),
        (Dialect::Haas, "#700=5.", "operator-data"),
        (Dialect::Klartext, "QR5 = 3", "operator-data"),
        (Dialect::Klartext, "FN 0: QR5 = 3", "operator-data"),
        (Dialect::Klartext, "TOOL DEF 5 L+10 R+3", "operator-data"),
    ] {
        let text = match dialect {
            Dialect::Klartext => numbered(&format!("{block}\nTOOL CALL 5 Z S100\nM30")),
            Dialect::Sinumerik => format!("G90 G94\n{block}\nM30\n"),
            _ => format!("G21\nG90 G94 G17 G54\n{block}\nM30\n"),
        };
        assert_eq!(risks(dialect, &text), [rule], "{dialect:?} {block}");
    }
}

/// LinuxCNC "M Codes", "Override Control": P1, or none, is on. B-64154EN/01 p. 53 (G61 to G64); PM, "Working area limitation"; iTNC
/// 530, "M107", "M141".
#[test]
fn overrides_and_guards_stay_with_the_operator() {
    const LOCKED: &[&str] = &["operator-controls"];
    for (dialect, block, expected) in [
        (Dialect::LinuxCnc, "M48", &[][..]),
        (Dialect::LinuxCnc, "M49", LOCKED),
        (Dialect::LinuxCnc, "M50 P0", LOCKED),
        (Dialect::LinuxCnc, "M50 P1", &[]),
        (Dialect::LinuxCnc, "M51", &[]),
        (Dialect::LinuxCnc, "M51 P0", LOCKED),
        (Dialect::LinuxCnc, "M52 P0", &[]),
        (Dialect::LinuxCnc, "M52 P1", &["adaptive-feed"]),
        (Dialect::LinuxCnc, "M52", &["adaptive-feed"]),
        (Dialect::LinuxCnc, "M53 P0", LOCKED),
        (Dialect::LinuxCnc, "M53", &[]),
        (Dialect::Fanuc, "M48", &[]),
        (Dialect::Fanuc, "M49", LOCKED),
        (Dialect::Fanuc, "G63", LOCKED),
        (Dialect::Fanuc, "G62", &[]),
        (Dialect::Haas, "M49", LOCKED),
        (Dialect::Mach3, "M49", LOCKED),
        (Dialect::Sinumerik, "WALIMOF", LOCKED),
        (Dialect::Sinumerik, "WALIMON", &[]),
        (Dialect::Sinumerik, "S100 M3\nG63 X1 F100", LOCKED),
        (Dialect::Klartext, "M107", LOCKED),
        (Dialect::Klartext, "M108", &[]),
        (Dialect::Klartext, "M141", LOCKED),
    ] {
        let text = match dialect {
            Dialect::Klartext => numbered(&format!("TOOL CALL 5 Z S100\n{block}\nM30")),
            Dialect::Sinumerik => format!("G90 G94\n{block}\nM30\n"),
            _ => format!("G21\nG90 G94 G17 G54\n{block}\nM30\n"),
        };
        assert_eq!(risks(dialect, &text), expected, "{dialect:?} {block}");
    }
}

/// An R parameter of `operator_parameters` counts as 0 and holds what the operator has entered: a program sets it by no value.
#[test]
fn no_program_sets_a_parameter_of_the_operator() {
    let settings = Settings {
        operator_parameters: vec![24],
        ..Settings::new(Dialect::Sinumerik, [true, false, true])
    };
    let risks = |blocks: &str| {
        let text = format!("G90 G94\n{blocks}\nM30\n");
        rules(
            &crate::common::ops(&settings, "p.mpf", &text)
                .unwrap_or_else(|e| panic!("{e}\n{text}")),
        )
    };
    for set in ["R24=0", "R[24]=45", "$R[24]=360", "FOR R24=1 TO 1\nENDFOR", "G0 C=R24\nR24=0"] {
        assert!(risks(set).contains(&"operator-data"), "{set}");
    }
    assert!(risks("R25=0\nG0 C=30+R24").is_empty());
}

/// PM19 p. 181: RTLIOF, each axis by itself; not with a transformation, with which rapids are straight whatever MD20730 is. With RTLION
/// all arrive together.
#[test]
fn rtlion_and_rtliof_say_how_the_axes_go_in_a_rapid() {
    let settings = Settings::new(Dialect::Sinumerik, [true, false, true]);
    let said = |blocks: &str| {
        let text = format!("G90 G94\n{blocks}\nM30\n");
        let found =
            crate::common::ops(&settings, "p.mpf", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let together = |action: &Action| match action {
            Action::RapidsTogether(together) => Some(*together),
            _ => None,
        };
        found.iter().filter_map(together).collect::<Vec<_>>()
    };
    assert_eq!(said("G0 X1"), []);
    assert_eq!(said("RTLIOF\nRTLIOF\nG0 X1\nRTLION"), [Some(false), Some(true)]);
    assert_eq!(said("RTLIOF\nTRAORI\nTRAFOOF"), [Some(false), Some(true), Some(false)]);
    assert_eq!(said("TRAORI\nTRAFOOF\nRTLION\nTRAORI"), [Some(true), None, Some(true)]);
    let called = "N1 GOTOF BEHIND\nBEHIND:\nUP\nM30\n%_N_UP_SPF\nPROC UP SAVE\nRTLIOF\nRET\n";
    let text = format!("%_N_P_MPF\n{called}");
    let found =
        crate::common::ops(&settings, "p.mpf", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let said: Vec<&Action> =
        found.iter().filter(|action| matches!(action, Action::RapidsTogether(_))).collect();
    assert_eq!(said, [&Action::RapidsTogether(Some(false)), &Action::RapidsTogether(None)]);
}

/// PGZ 2-86 and the cycles of the TNC 640 ([cycles](../../../docs/controls/cycles.md)): what a call asks for in addition to the hole.
#[test]
fn what_a_cycle_does_in_addition_to_its_hole_is_reported() {
    let sinumerik = |call: &str| {
        let text = format!("G90 G94 F100 S1000 M3\nG0 X5 Y6\n{call}\nM30\n");
        risks(Dialect::Sinumerik, &text)
    };
    let none = [""; 0];
    for (call, expected) in [
        ("CYCLE84(10,0,2,-20,,0,3,,1.25,0,400,400)", &none[..]),
        ("CYCLE84(10,0,2,-20,,0,3,,1.25,0,400,0)", &none),
        ("CYCLE84(10,0,2,-20,,0,3,,1.25,0,400)", &none),
        ("CYCLE84(10,0,2,-20,,0,5,,1.25,0,400,400)", &none),
        ("CYCLE84(10,0,2,-20,,0,4,,-1.25,0,400,400)", &none),
        ("CYCLE84(10,0,2,-20,,0,3,,-1.25,0,400,400)", &none),
        ("CYCLE84(10,0,2,-20,,0,3,,1.25,0,400,401)", &["spindle"]),
        ("CYCLE84(10,0,2,-20,,0,3,,1.25,0,400,4000)", &["spindle"]),
        ("CYCLE84(10,0,2,-20,,0,4,,1.25,0,400,400)", &["spindle"]),
        ("CYCLE83(50,0,1,-25,,,5,0,0,0,1,1)", &none),
        ("CYCLE83(50,0,1,-25,,,5,0,0,1,1,1)", &["dwell"]),
        ("CYCLE83(50,0,1,-25,,,5,0,0,-999,1,1)", &["dwell"]),
        // Only where chips are cleared does it go up and wait.
        ("CYCLE83(50,0,1,-25,,,5,0,0,1,1,0)", &none),
        ("CYCLE83(50,0,1,-25,,,5,0,0.2,0,1,1,,,,0.2)", &none),
        ("CYCLE83(50,0,1,-25,,,5,0,9,0,1,1,,,,0.2)", &["dwell"]),
    ] {
        assert_eq!(sinumerik(call), expected, "{call}");
    }
    let klartext = |number: u32, parameters: &str| {
        let cycle = format!("CYCL DEF {number} NAME {parameters}");
        let blocks = format!(
            "TOOL CALL 5 Z S100\nL X+0 Y+0 Z+9 B+0 C+0 R0 FMAX M3\n{cycle}\nCYCL CALL\nM30"
        );
        risks(Dialect::Klartext, &numbered(&blocks))
    };
    let tap = "Q200=+2 Q201=-20 Q239=+1 Q203=+0 Q204=+50 Q257=+5 Q256=+1 Q336=+0";
    assert_eq!(klartext(209, tap), none);
    assert_eq!(klartext(209, &format!("{tap} Q403=+1")), none);
    assert_eq!(klartext(209, &format!("{tap} Q403=+3")), ["spindle"]);
    let pecks = |stop: &str, chip: &str| {
        format!(
            "Q200=+2 Q201=-20 Q206=+100 Q202=+5 Q203=+0 Q204=+50 Q212=+0 Q205=+0 {stop} {chip} Q256=+0.5 Q211=+0 Q379=+0 Q253=+750"
        )
    };
    assert_eq!(klartext(205, &pecks("Q258=+0.5 Q259=+0.5", "Q257=+0")), none);
    assert_eq!(klartext(205, &pecks("Q258=+0 Q259=+0.5", "Q257=+0")), ["peck"]);
    assert_eq!(klartext(205, &pecks("Q258=+0.5 Q259=+0", "Q257=+0")), ["peck"]);
    let plain = |clearance: &str| {
        format!("Q200={clearance} Q201=-20 Q206=+100 Q202=+5 Q210=+0 Q203=+0 Q204=+50 Q211=+0")
    };
    assert_eq!(klartext(200, &plain("+2")), none);
    assert_eq!(klartext(200, &plain("+0")), ["peck"]);
}

/// PM 2.13 and "Percentage acceleration override"; S1, "Minimum / maximum speed of the gear stage".
#[test]
fn gears_and_axes_beyond_their_machine_data_are_reported() {
    let on_machine = |auxiliary: &[u32], block: &str| {
        let auxiliary = auxiliary.to_vec();
        let settings = Settings { auxiliary, ..Settings::new(Dialect::Sinumerik, [false; 3]) };
        let text = format!("G90 G94\n{block}\nM30\n");
        rules(
            &crate::common::ops(&settings, "p.mpf", &text)
                .unwrap_or_else(|e| panic!("{e}\n{text}")),
        )
    };
    for gear in 41..=45 {
        assert_eq!(on_machine(&[], &format!("M{gear}")), ["gear"]);
        assert_eq!(on_machine(&[gear], &format!("M{gear}")), [""; 0]);
    }
    assert_eq!(on_machine(&[], "M40"), [""; 0]);
    assert_eq!(on_machine(&[], "ACC[X]=100 VELOLIMA[X]=80"), [""; 0]);
    for word in ["ACC[X]=200", "ACCLIMA[X]=101", "JERKLIMA[Z]=150", "VELOLIMA[Y]=120"] {
        assert_eq!(on_machine(&[], word), ["axis-dynamics"], "{word}");
    }
}

/// H2 and PM 2.6: M3 takes the S that is there, and nobody knows which that is before the program has said one.
#[test]
fn a_sinumerik_starts_no_spindle_at_a_speed_that_nobody_has_said() {
    let started = |blocks: &str| {
        let text = format!("G90 G94\n{blocks}\nM30\n");
        run(Dialect::Sinumerik, &text).map(drop).map_err(|error| error.rule.name())
    };
    for block in ["M3", "M4", "M1=3", "G0 X0 Y0\nCYCLE84(10,0,2,-20,,0,3,,1.25,0,400)"] {
        assert_eq!(started(block), Err("spindle"), "{block}");
    }
    assert_eq!(started("S100 M3"), Ok(()));
    assert_eq!(started("S100\nM4"), Ok(()));
    assert_eq!(started("M5"), Ok(()));
    assert_eq!(started("CYCLE832(-0.99,_FINISH,1)"), Err("cycle-parameter"));
    assert_eq!(started("ADIS=-1"), Err("number"));
}

/// LinuxCNC "G92.1, G92.2 Reset G92 Offsets": the finding names the word that stands there.
#[test]
fn what_g92_2_takes_away_is_reported_as_that_of_g92_2() {
    for word in ["G92.1", "G92.2"] {
        let text = format!("G21 G90 G94 G17\nG54\nG0 X1 Y1 Z1\n{word}\nX2\nM2\n");
        let error = run(Dialect::LinuxCnc, &text).unwrap_err();
        assert_eq!(error.rule.name(), "unknown-shift");
        assert!(error.message.starts_with(word), "{}", error.message);
    }
}

/// B-64484EN-2: `G29` "immediately following the G28 command"; `G49` and another tool leave no H to lean on; and a cycle says where its
/// holes are.
#[test]
fn a_word_that_leans_on_an_older_block_is_refused() {
    const START: &str = "G21\nG90 G94 G17 G98 G54\nT1 M6\nS100 M3\nG0 X0. Y0.\nG43 H1 Z50.\n";
    for (blocks, rule) in [
        ("G91 G28 Z0.\nG29 Z-5.", None),
        ("G91 G28 Z0.\nG90 G0 Z50.\nG91 G29 Z0.", Some("home")),
        ("G91 G28 Z0.\nT2 M6\nG29 Z-5.", Some("home")),
        ("G91 G28 Z0.\nG49\nG90 G43 Z50.", Some("length-offset")),
        ("G91 G28 Z0.\nT2 M6\nG90 G43 Z50.", Some("length-offset")),
        ("G91 G28 Z0.\nG49\nH2\nG90 G43 Z50.", None),
        ("G81 Z-5. R2. F100.\nG81", Some("cycle")),
        ("G81 Z-5. R2. F100.\nG80", None),
        ("G95\nM29 S100\nG84 Z-5. R2. F1.\nG80", None),
    ] {
        for dialect in [Dialect::Fanuc, Dialect::Haas] {
            if dialect == Dialect::Haas && blocks.contains("M29") {
                continue;
            }
            let found = run(dialect, &format!("{START}{blocks}\nM30\n"));
            assert_eq!(found.err().map(|found| found.rule.name()), rule, "{dialect:?} {blocks}");
        }
    }
    // "Between M29 and G84 no axis moves."
    let between = run(Dialect::Fanuc, &format!("{START}M29 S100\nG1 Z1. F100.\nM30\n"));
    assert_eq!(between.unwrap_err().rule.name(), "cycle");
}

/// B-64484EN-2, "M99": in a main program it goes back to its begin.
#[test]
fn m99_begins_a_program_of_fanuc_and_haas_again_and_is_refused() {
    for dialect in [Dialect::Fanuc, Dialect::Haas] {
        let found = actions(dialect, "G21\nG90\nM99\n");
        let [.., Action::Risk(risk), Action::End] = &found[..] else { panic!("{found:?}") };
        assert_eq!((risk.rule.name(), risk.refused), ("program-repeats", true));
    }
}

/// Marlin's G-code index, "G0-G1": both have one feed.
#[test]
fn a_cut_of_marlin_goes_at_the_feed_of_the_rapid_before() {
    let found = actions(Dialect::Marlin, "G21\nG90\nG1 X1 Y0 Z5 F200\nG0 X2 F5000\nG1 X3\n");
    let feeds: Vec<Feed> = found
        .iter()
        .filter_map(|action| if let Action::Feed(feed) = action { Some(*feed) } else { None })
        .collect();
    assert_eq!(feeds, [Feed::PerMinute(200.0), Feed::PerMinute(5000.0)]);
}

/// TNC 620 user's manual p. 340: M128 is reset before positioning with M91.
#[test]
fn m128_is_off_before_a_move_in_machine_coordinates() {
    let text = "TOOL CALL 5 Z S100\nL B+0 C+0 R0 FMAX\nL X+0 Y+0 Z+9 R0 FMAX\nM128\nL Z+0 R0 FMAX M91\nM30";
    let found = run(Dialect::Klartext, &numbered(text)).unwrap_err();
    assert_eq!((found.rule.name(), found.line), ("tool-center", 6));
    assert!(run(Dialect::Klartext, &numbered(&text.replace("L Z+0", "M129\nL Z+0"))).is_ok());
}

/// What a program does on a LinuxCNC with B and C whose builder switches the kinematics by `M428` and `M429`.
fn switched(text: &str) -> Result<Vec<Action>, &'static str> {
    let settings = Settings {
        kinematics: Some(Kinematics { tip: 428, axes: 429 }),
        ..Settings::new(Dialect::LinuxCnc, [false, true, true])
    };
    crate::common::ops(&settings, "p.ngc", text).map_err(|found| found.rule.name())
}

/// Measured on LinuxCNC 2.9: the kinematics stay when the program has ended, `5axiskins` starts with those of the tip, and
/// `M428` leaves the axes where they are: the tip then stands at other coordinates, (15.5, 10.7, 90.7) instead of (5, -7, 83).
#[test]
fn a_switch_of_the_kinematics_moves_nothing_and_leaves_the_position_unknown() {
    const START: &str = "G21 G90 G94 G17\nT1 M6\nM429\nG0 B30 C40\nX0 Y0\nG43 Z50 H1\nM428\n";
    let rapids = |text: &str| {
        let actions = switched(text).unwrap();
        let rapid = |action: &Action| match action {
            Action::Rapid(to) => Some(*to),
            _ => None,
        };
        actions.iter().filter_map(rapid).collect::<Vec<_>>()
    };
    let moves = rapids(&format!("{START}X10 Y5\nZ20\nM429\nG53 G0 Z100\nM2\n"));
    let by_tip = |to: &Position| {
        matches!(
            to.orientation,
            Orientation::Rotary { tool_center: true, degrees: [_, 30.0, 40.0] }
        )
    };
    assert_eq!(moves.iter().map(by_tip).collect::<Vec<_>>(), [false, false, false, true, true]);
    // Behind the switch X and Y say nothing of Z.
    assert_eq!((moves[3].point.x, moves[3].point.y), (10.0, 5.0));
    assert!(moves[3].point.z.is_nan());
    assert_eq!(moves[4].point.to_array(), [10.0, 5.0, 20.0]);
    assert_eq!(switched(&format!("{START}G91 Z1\nM429\nM2\n")), Err("unknown-position"));
    // Back again, nothing of it is known either.
    assert_eq!(switched(&format!("{START}X1 Y2 Z3\nM429\nG91 Z1\nM2\n")), Err("unknown-position"));
}

/// Measured on LinuxCNC 2.9 with A at 30 degrees, by the kinematics of the tip: `G53 G0 Z100` goes along Z of the turned
/// work (the slide ends at 86.8), `G91 G28 Z0` brings the slide down to 3.4; `G43` of a tool that is 20 mm longer makes Y
/// jump by 10 mm within two milliseconds.
#[test]
fn by_the_kinematics_of_the_tip_no_length_changes_and_nothing_goes_to_a_fixed_place() {
    const START: &str =
        "G21 G90 G94 G17\nT1 M6\nM429\nG0 B30 C40\nX0 Y0\nG43 Z50 H1\nM428\nX1 Y2 Z3\n";
    for (block, right) in [
        ("G1 Z2 F100", true),
        ("G2 X2 Y3 J1 F100", true),
        ("G43 H1", true),
        ("G43 H2", false),
        ("G49", false),
        ("G43.1 Z20", false),
        ("G53 G0 Z100", false),
        ("G28", false),
        ("G91 G28 Z0", false),
        ("G30", false),
        ("G28.1", false),
        ("M428 X2", false),
        ("M428 M8", false),
    ] {
        let found = switched(&format!("{START}{block}\nG90\nM429\nM2\n"));
        assert_eq!(found.err(), (!right).then_some("kinematics"), "{block}");
    }
    // It would drill along Z of the work, wherever the tool points.
    assert_eq!(switched(&format!("{START}G98 G81 Z-5 R2 F100\nG80\nM429\nM2\n")), Err("cycle"));
}

#[test]
fn a_program_says_which_kinematics_it_has_and_leaves_those_of_the_axes() {
    for text in ["G21 G90\nG0 X1 Y2\nM2\n", "G21 G90\nG28\nM2\n", "G21 G90\nG53 G0 Z0\nM2\n"] {
        assert_eq!(switched(text), Err("kinematics"), "{text}");
        assert!(switched(&text.replacen('\n', "\nM429\n", 1)).is_ok(), "{text}");
    }
    for (end, left_on) in [("M2", true), ("M429\nM2", false)] {
        let found = switched(&format!("G21 G90\nM428\n{end}\n")).unwrap();
        let is_left = |a: &Action| matches!(a, Action::Risk(risk) if risk.rule.name() == "left-on");
        assert_eq!(found.iter().any(is_left), left_on, "{end}");
    }
}

/// A-79348E p. 19: the work offset "at that point of time" is fixed on the table, and "the angle of the table's rotary axis
/// represents the initial state". At 0 both readings are one; a head turns no table.
#[test]
fn in_which_frame_g43_4_counts_with_a_turned_table_the_machine_file_says() {
    let risks = |table, table_frame_at_zero, turn: &str| {
        let settings = Settings {
            table,
            table_frame_at_zero,
            length_moves_axis: Some(false),
            ..Settings::new(Dialect::Fanuc, [false, true, true])
        };
        let text = format!("G21\nG90 G94 G54\nG91 G28 Z0.\nG90\nT1 M6\n{turn}G43.4 H1\nM30\n");
        rules(
            &crate::common::ops(&settings, "p.nc", &text).unwrap_or_else(|e| panic!("{e}\n{text}")),
        )
    };
    let (head, table) = ([false; 3], [false, true, true]);
    for (mount, setting, turn, is_risk) in [
        (table, None, "G0 B30. C0.\n", true),
        (table, Some(false), "G0 B30. C0.\n", true),
        (table, Some(true), "G0 B30. C0.\n", false),
        (table, None, "G0 B0. C90.\n", true),
        // Nobody knows where the table stands.
        (table, None, "", true),
        (table, None, "G0 B0. C0.\n", false),
        (head, None, "G0 B30. C90.\n", false),
        (head, None, "", false),
    ] {
        let found = risks(mount, setting, turn);
        assert_eq!(
            found.contains(&"table-frame"),
            is_risk,
            "{mount:?} {setting:?} {turn}: {found:?}"
        );
    }
}

/// TNC 640 cycles, "Tolerance": TA is how far the rotary axes may be off while the control keeps the tip. SINUMERIK ONE 12/2019, p. 1108:
/// the tens of S_TOLM say that S_OTOL is a tolerance of the orientation; where they do not it is a version.
#[test]
fn a_tolerance_of_the_orientation_is_what_the_machines_file_allows() {
    let risks_within = |dialect, orientation_tolerance, block: &str| {
        let settings = Settings {
            path_tolerance: 0.1,
            orientation_tolerance,
            ..Settings::new(dialect, [false, true, true])
        };
        rules(
            &crate::common::ops(&settings, "p.nc", block)
                .unwrap_or_else(|e| panic!("{e}\n{block}")),
        )
    };
    let none = [""; 0];
    let beyond = ["orientation-tolerance"];
    for (dialect, block) in [
        (
            Dialect::Klartext,
            "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.05\nCYCL DEF 32.2 HSC-MODE:1 TA0.5",
        ),
        (Dialect::Sinumerik, "CYCLE832(0.05,_ORI_ROUGH,0.5)\nM30\n"),
        (Dialect::Sinumerik, "CYCLE832(0.05,13,0.5)\nM30\n"),
        (Dialect::Sinumerik, "CYCLE832(0.05,2000011,0.5)\nM30\n"),
        (Dialect::Sinumerik, "OTOL=0.5\nM30\n"),
    ] {
        let block = match dialect {
            Dialect::Klartext => format!("BEGIN PGM T MM\n{block}\nEND PGM T MM\n"),
            _ => block.to_owned(),
        };
        assert_eq!(risks_within(dialect, 0.0, &block), beyond, "{block}");
        assert_eq!(risks_within(dialect, 0.49, &block), beyond, "{block}");
        assert_eq!(risks_within(dialect, 0.5, &block), none, "{block}");
    }
    for harmless in
        ["CYCLE832(0.05,_FINISH,1)", "CYCLE832(0.05,3,1)", "CYCLE832(0,_OFF,1)", "CYCLE832()"]
    {
        assert_eq!(risks_within(Dialect::Sinumerik, 0.0, &format!("{harmless}\nM30\n")), none);
    }
    // While the control keeps the tip, setting data say by how much where no word does (SINUMERIK ONE IM9, "CYCLE832": ten times the
    // tolerance of the path as delivered).
    let five = |words: &str| {
        let text = format!(
            "G54 G90 G94\nTRAORI\nG54 D1\nG0 X0 Y0 Z50 B0 C0\n{words}\nG1 X5 F500\nX10\nCYCLE832(0,_OFF,1)\nM30\n"
        );
        risks_within(Dialect::Sinumerik, 0.1, &text)
    };
    for unsaid in ["CYCLE832(0.05,_FINISH,1)", "CYCLE832(0.05,3,1)", "CYCLE832(0.05)"] {
        assert_eq!(five(unsaid), ["orientation-tolerance"], "{unsaid}");
        assert_eq!(five(&format!("TRAFOOF\n{unsaid}")), none, "{unsaid}");
    }
    for said in [
        "CYCLE832(0.05,_ORI_FINISH,0.1)",
        "CYCLE832(0.05,13,0.1)",
        "CYCLE832(0.05,_FINISH,1)\nOTOL=0.1",
        "CYCLE832(0.05,_FINISH,1)\nCYCLE832(0,_OFF,1)",
        "CYCLE832(0.05,_FINISH,1)\nCYCLE832(0.05,_ORI_FINISH,0.1)",
    ] {
        assert_eq!(five(said), none, "{said}");
    }
    // SD42674 to SD42678 say by how much, and nobody has said these.
    for loose in ["OSC", "OSS", "OSSE", "OSD", "OST", "ORISON"] {
        let program = format!("{loose}\nM30\n");
        assert_eq!(risks_within(Dialect::Sinumerik, 0.5, &program), beyond, "{loose}");
    }
    assert_eq!(risks_within(Dialect::Sinumerik, 0.0, "OSOF ORISOF\nM30\n"), none);
    for wrong in [
        "CYCLE832(0.05,_ORI_FINISH)",
        "CYCLE832(0.05,11,0)",
        "CYCLE832(0.05,_ORI_OFF,1)",
        "CYCLE832(0.05,_FINE,1)",
        "CYCLE832(0.05,25,1)",
    ] {
        let settings = Settings {
            path_tolerance: 0.1,
            ..Settings::new(Dialect::Sinumerik, [false, true, true])
        };
        let error = crate::common::ops(&settings, "p.nc", format!("{wrong}\nM30\n")).unwrap_err();
        assert_eq!(error.rule.name(), "cycle-parameter", "{wrong}");
    }
}

/// iTNC 530 user's manual, M140: it goes along the tool axis to the end of the travel, also with tilted planes and with M128, and the tool
/// axis has to be known from a TOOL CALL. CYCLE800: `_FR` 4 goes along the tool as far as it can, 5 by `_FR_I`.
#[test]
fn a_retract_along_the_tool_is_a_way_home_only_where_the_tool_stands_along_z_of_the_machine() {
    let risks_on = |dialect, table, blocks: &str| {
        let settings = Settings { table, ..Settings::new(dialect, [false, true, true]) };
        let actions = crate::common::ops(&settings, "p.nc", blocks)
            .unwrap_or_else(|e| panic!("{e}\n{blocks}"));
        let home = actions.iter().any(|a| matches!(a, Action::Home(_)));
        (rules(&actions), home)
    };
    let (tables, heads) = ([false, true, true], [false; 3]);
    let klartext = |turn: &str| {
        format!(
            "BEGIN PGM T MM\nTOOL CALL 1 Z S100\nL B+0 C+0 R0 FMAX\nL X+0 Y+0 Z+9 R0 FMAX\n{turn}\nL M140 MB MAX\nEND PGM T MM\n"
        )
    };
    for turn in [
        "L B+30 R0 FMAX",
        "PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX SEQ+",
        "M128\nL B+30 F9 M126",
    ] {
        let program = klartext(turn);
        assert_eq!(
            risks_on(Dialect::Klartext, heads, &program),
            (vec!["leaning-retract"], true),
            "{turn}"
        );
        assert_eq!(risks_on(Dialect::Klartext, tables, &program), (vec![], true), "{turn}");
    }
    assert_eq!(risks_on(Dialect::Klartext, heads, &klartext("M3")), (vec![], true));
    let before = "BEGIN PGM T MM\nL M140 MB MAX\nEND PGM T MM\n";
    assert_eq!(run(Dialect::Klartext, before).unwrap_err().rule.name(), "m-function");

    let sinumerik = |retract: u8| {
        format!(
            "T1 M6 D1\nG0 X0 Y0 Z9 B20 C0\nCYCLE800({retract},\"\",0,57,0,0,0,0,30,0,0,0,0,-1,50)\nM30\n"
        )
    };
    assert_eq!(risks_on(Dialect::Sinumerik, heads, &sinumerik(1)), (vec![], true));
    assert_eq!(risks_on(Dialect::Sinumerik, heads, &sinumerik(4)), (vec!["leaning-retract"], true));
    assert_eq!(risks_on(Dialect::Sinumerik, tables, &sinumerik(4)), (vec![], true));
    // By how much it goes along the tool says nothing of where Z is home.
    assert_eq!(risks_on(Dialect::Sinumerik, tables, &sinumerik(5)), (vec![], false));
}

/// TNC 640, FUNCTION TCPM: with PATHCTRL AXIS (as with M128) the axes turn evenly, with PATHCTRL VECTOR the tool turns in the plane of its
/// two directions.
#[test]
fn the_tool_turns_under_tcpm_as_pathctrl_says() {
    let turning = |on: &str, words: &str| {
        let program = format!(
            "BEGIN PGM T MM\nTOOL CALL 1 Z S100\nL B+0 C+0 R0 FMAX\n{on}\nL X+0 Y+0 Z+9 FMAX\n{words}\nEND PGM T MM\n"
        );
        risks_counted(Dialect::Klartext, Some(false), &program)
    };
    let tcpm = |axis: &str, way: &str| format!("FUNCTION TCPM F TCP AXIS {axis} PATHCTRL {way}");
    let wrong = ["orientation-way"];
    let (positions, vector) = ("L X+5 B+30 F100", "LN X+5 Y+0 Z+9 TX+0.6 TY+0 TZ+0.8 F100");
    assert_eq!(turning("M128", positions), [""; 0]);
    assert_eq!(turning(&tcpm("POS", "AXIS"), positions), [""; 0]);
    assert_eq!(turning(&tcpm("POS", "VECTOR"), positions), wrong);
    assert_eq!(turning(&tcpm("SPAT", "VECTOR"), positions), [""; 0]);
    assert_eq!(turning(&tcpm("SPAT", "AXIS"), positions), wrong);
    assert_eq!(turning(&tcpm("POS", "VECTOR"), vector), [""; 0]);
    assert_eq!(turning(&tcpm("POS", "AXIS"), vector), wrong);
    assert_eq!(turning("M128", vector), wrong);
    // A tool that does not turn goes the same way with both.
    assert_eq!(turning(&tcpm("POS", "VECTOR"), "L X+5 B+0 F100"), [""; 0]);
}

/// TNC manuals, "Defining the blank": two corners, the MIN point absolute, the MAX point absolute or incremental.
#[test]
fn the_blank_of_a_heidenhain_has_two_corners_and_a_thickness() {
    let blank = |blocks: &str| {
        let program = format!("BEGIN PGM T MM\n{blocks}\nEND PGM T MM\n");
        run(Dialect::Klartext, &program).map(drop).map_err(|error| error.rule.name())
    };
    assert_eq!(blank("BLK FORM 0.1 Z X+0 Y+0 Z-40\nBLK FORM 0.2 X+100 Y+100 Z+0"), Ok(()));
    assert_eq!(blank("BLK FORM 0.1 Z X+0 Y+0 Z-40\nBLK FORM 0.2 IX+100 IY+100 IZ+40"), Ok(()));
    for wrong in [
        "BLK FORM 0.1 Z X+0 Y+0 Z-40\nBLK FORM 0.2 X+100 Y+100 Z-40",
        "BLK FORM 0.1 Z X+0 Y+0 Z-40\nBLK FORM 0.2 X-1 Y+100 Z+0",
        "BLK FORM 0.1 Z IX+0 Y+0 Z-40",
        "BLK FORM 0.2 X+100 Y+100 Z+0",
    ] {
        assert_eq!(blank(wrong), Err("blank"), "{wrong}");
    }
}

/// SINUMERIK "Exact stop (G60, G9, G601, G602, G603)": `G60` holds up to `G64`, `G9` for its block, as that of FANUC and Haas.
#[test]
fn an_exact_stop_is_reported() {
    let text = "G54 G90 G94\nT1\nM6\nS500 M3\nG0 X0 Y0 Z5\nG60\nG1 X5 F100\nG64\nG1 X9\nM30\n";
    let actions = actions(Dialect::Sinumerik, text);
    let modes: Vec<PathMode> = actions
        .iter()
        .filter_map(|action| if let Action::PathMode(mode) = action { Some(*mode) } else { None })
        .collect();
    assert_eq!(modes, [PathMode::ExactStop, PathMode::AsSetUp]);
    for (dialect, start) in [
        (Dialect::Sinumerik, "G54 G90 G94\nT1\nM6\nS500 M3\nG0 X0 Y0 Z5"),
        (Dialect::Fanuc, "G21 G54 G90 G94\nT1 M6\nS500 M3\nG0 X0. Y0. Z5."),
        (Dialect::Haas, "G21 G54 G90 G94\nT1 M6\nS500 M3\nG0 X0. Y0. Z5."),
    ] {
        let reported = |block: &str| {
            let found = self::actions(dialect, &format!("{start}\n{block}\nM30\n"));
            let exact = |action: &&Action| matches!(action, Action::Risk(risk) if risk.rule.name() == "path-mode" && !risk.refused);
            found.iter().filter(exact).count()
        };
        assert_eq!([reported("G9 G1 X5. F100."), reported("G1 X5. F100.")], [1, 0], "{dialect:?}");
    }
}

/// LinuxCNC "G7 Lathe Diameter Mode"; SINUMERIK PM, "Channel-specific diameter/radius programming (DIAMON, DIAM90)".
#[test]
fn where_x_is_a_diameter_the_word_that_says_so_is_reported() {
    for (dialect, unit, on, off) in [
        (Dialect::LinuxCnc, "G21", "G7", "G8"),
        (Dialect::Sinumerik, "G71", "DIAMON", "DIAMOF"),
        (Dialect::Sinumerik, "G71", "DIAM90", "DIAMOF"),
    ] {
        let text =
            |word: &str| format!("{unit} G90 G17 G94 G54\n{word}\nG0 X10 Y0 Z5\n{off}\nM30\n");
        assert_eq!(risks(dialect, &text(on)), ["diameter-mode"], "{on}");
        assert_eq!(risks(dialect, &text(off)), [""; 0], "{off}");
    }
}
