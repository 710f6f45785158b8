//! In which modes a control starts a program: what its manual fixes, and what somebody sets up at the machine. A program that leans
//! on the latter without a word is reported, once for each mode.

use toolpost_control::{Action, Dialect, Settings, StartModes};

/// The findings about modes that the program has not said, by the word that it lacks.
fn lacks(settings: &Settings, text: &str) -> Vec<&'static str> {
    let found = crate::common::ops(settings, "p.nc", text);
    let found = found.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let word = |action: &Action| match action {
        Action::Risk(risk) if risk.rule.name() == "start-mode" => {
            assert!(risk.refused);
            risk.help.split(' ').nth(1)
        }
        _ => None,
    };
    let mut found: Vec<_> = found.iter().filter_map(word).collect();
    found.sort_unstable();
    found
}

fn machine(dialect: Dialect) -> Settings {
    Settings::new(dialect, [false; 3])
}

const CUT: &str = "G0 X0 Y0\nZ0\nG1 X10. F100.\nG2 X20. I5. J0\nG1 X30.\n";

/// FANUC 3402#1 to #4 (plane, G91, G94), I J K fixed; Mach3 "Active Plane", "Distance Mode", "IJ Mode" of General Config and its
/// initialisation string; LinuxCNC RS274NGC_STARTUP_CODE ("not a substitute for specifying modal g-codes at the top of each ngc
/// file"); GRBL $N0, I J K fixed (`gcode.c`). Haas: power-on values of its list of G codes, to which a program's end goes back with setting
/// 56 alone; Marlin: those of its firmware, which has no end of a program.
#[test]
fn a_mode_that_is_set_up_at_the_machine_is_said_by_the_program() {
    let table: [(Dialect, &str, &[&str]); 6] = [
        (Dialect::Fanuc, "M30\n", &["G17", "G90", "G94"]),
        (Dialect::Haas, "M30\n", &["G17", "G90", "G94"]),
        (Dialect::LinuxCnc, "M2\n", &["G17", "G90", "G91.1", "G94"]),
        (Dialect::Mach3, "M30\n", &["G17", "G90", "G91.1", "G94"]),
        (Dialect::Grbl, "M2\n", &["G17", "G90", "G94"]),
        (Dialect::Marlin, "", &["G17", "G90"]),
    ];
    for (dialect, end, expected) in table {
        let cut = match dialect {
            // Each line has its own command.
            Dialect::Marlin => CUT.replace("\nZ0", "\nG0 Z0"),
            _ => CUT.to_owned(),
        };
        let with = |words: &str| match dialect {
            Dialect::Marlin => format!("G21\n{words}\n{cut}{end}"),
            _ => format!("G21\n{words}\nG54\n{cut}{end}"),
        };
        assert_eq!(lacks(&machine(dialect), &with("")), expected, "{dialect:?}");
        for word in expected {
            let others: Vec<_> = expected.iter().filter(|other| *other != word).copied().collect();
            assert_eq!(lacks(&machine(dialect), &with(word)), others, "{dialect:?} {word}");
        }
        assert!(lacks(&machine(dialect), &with(&expected.join("\n"))).is_empty());
        let stated = Settings { start_modes: StartModes::SURE, ..machine(dialect) };
        assert!(lacks(&stated, &with("")).is_empty());
    }
}

/// A mode is leaned on by what it gives a meaning to, and by nothing else.
#[test]
fn what_does_not_lean_on_a_mode_does_not_ask_for_it() {
    let mach3 =
        |blocks: &str| lacks(&machine(Dialect::Mach3), &format!("G21 G54\n{blocks}\nM30\n"));
    // Nothing moves; a place of the machine, which is always absolute.
    assert!(mach3("S1000 M3\nG4 P1").is_empty());
    assert_eq!(mach3("G0 X0 Y0 Z5"), ["G90"]);
    assert_eq!(mach3("G90 G0 X0 Y0 Z5\nG1 Z0 F100"), ["G94"]);
    assert_eq!(mach3("G90 G94\nG0 X0 Y0 Z5\nG2 X10 R5 F100"), ["G17"]);
    assert_eq!(mach3("G90 G94 G17\nG0 X0 Y0 Z5\nG2 X10 I5 J0 F100"), ["G91.1"]);
    assert_eq!(mach3("G90 G94 G17 G90.1\nG0 X0 Y0 Z5\nG2 X10 I5 J0 F100\nG91.1"), [""; 0]);
    assert_eq!(mach3("G90 G94 G98\nG0 X0 Y0 Z5\nG81 X1 Y1 Z-1 R1 F100\nG80"), ["G17"]);
    assert_eq!(mach3("G90 G94\nG0 X0 Y0 Z5\nG41 D1 G1 X5 F100\nG40 G0 X9"), ["G17"]);
    // In the same block, and G91 as well as G90.
    assert_eq!(mach3("G90 G0 X0 Y0 Z5\nG93 G1 X5 F2"), [""; 0]);
}

/// `M72` brings back how it was, which nobody had said.
#[test]
fn what_comes_back_has_not_been_said() {
    let text = "G21 G54\nM70\nG17 G90 G91.1 G94\nM72\nG0 X0 Y0 Z0\nG1 X1 F100\nG2 X3 I1 J0\nM2\n";
    assert_eq!(lacks(&machine(Dialect::LinuxCnc), text), ["G17", "G90", "G91.1", "G94"]);
    let before = text.replace("M70\nG17 G90 G91.1 G94", "G17 G90 G91.1 G94\nM70");
    assert!(lacks(&machine(Dialect::LinuxCnc), &before).is_empty());
}

/// MD20150: groups 6, 13, 14 and 15 are among those whose reset state is set up (NC programming 12/2019, 4.3); delivered are G17,
/// G71, G90, G94. I J K count from the start of an arc in any case.
#[test]
fn a_sinumerik_program_says_plane_unit_distance_and_feed() {
    let lacking =
        |words: &str| lacks(&machine(Dialect::Sinumerik), &format!("G54\n{words}\n{CUT}M30\n"));
    assert_eq!(lacking(""), ["G17", "G710", "G90", "G94"]);
    for unit in ["G71", "G710", "G70", "G700"] {
        assert_eq!(lacking(unit), ["G17", "G90", "G94"]);
    }
    assert_eq!(lacking("G17 G710 G94"), ["G90"]);
    assert!(lacking("G17 G710 G90 G94").is_empty());
    assert!(lacking("G710 G94\nG90 G17").is_empty());
    let compensated = "G71 G90 G94 G54\nG0 X0 Y0 Z0\nT1 M6 D1\nG41 G1 X5 F100\nG40 X9\nM30\n";
    assert_eq!(lacks(&machine(Dialect::Sinumerik), compensated), ["G17"]);
    let stated = Settings { start_modes: StartModes::SURE, ..machine(Dialect::Sinumerik) };
    assert!(lacks(&stated, &format!("G54\n{CUT}M30\n")).is_empty());
}

/// FANUC parameter 5001 (length type B) and SINUMERIK SD42940 = 0 as delivered (*Tools*): a length counts along the axis that stands on
/// the plane, so a program of lines alone leans on the plane at its start. Haas, LinuxCNC, Mach3 and GRBL: along Z.
#[test]
fn a_tool_length_leans_on_the_plane() {
    let lacking = |dialect, length_along_z, text: &str| {
        lacks(&Settings { length_along_z, ..Settings::new(dialect, [true, false, true]) }, text)
    };
    let fanuc =
        "G21\nG90 G94 G54\nT1 M6\nG0 X0. Y0.\nG43 H1 Z5.\nG1 X5. F100.\nG91 G28 Z0\nG49\nM30\n";
    for (length_along_z, expected) in
        [(None, &["G17"][..]), (Some(false), &["G17"]), (Some(true), &[])]
    {
        assert_eq!(lacking(Dialect::Fanuc, length_along_z, fanuc), expected);
    }
    let with = |from: &str, to: &str| {
        assert!(fanuc.contains(from));
        lacking(Dialect::Fanuc, None, &fanuc.replace(from, to))
    };
    // The axis is that of the plane in which the length begins.
    assert!(with("G90 G94", "G17 G90 G94").is_empty());
    assert!(with("G43 H1", "G17 G43 H1").is_empty());
    assert_eq!(with("G1 X5.", "G17 G1 X5."), ["G17"]);
    assert_eq!(with("G43 H1", "A0 C0\nG43.4 H1"), ["G17"]);
    // No length.
    assert!(with("G43 H1 ", "G43 H0 ").is_empty());
    assert!(with("G43 H1 ", "G49 ").is_empty());
    let haas = fanuc.replace("G91 G28 Z0\nG49", "G49\nG53 G0 Z0");
    assert!(lacking(Dialect::Haas, None, &haas).is_empty());
    for dialect in [Dialect::LinuxCnc, Dialect::Mach3] {
        let text = haas.replace("G90 G94", "G90 G94 G91.1");
        assert!(lacking(dialect, None, &text).is_empty(), "{dialect:?}");
    }

    let sinumerik = "G710 G90 G94 G54\nT1\nM6\nD1\nG0 X0 Y0\nZ5\nG1 X5 F100\nG0 SUPA Z0 D0\nM30\n";
    for (length_along_z, expected) in
        [(None, &["G17"][..]), (Some(false), &["G17"]), (Some(true), &[])]
    {
        assert_eq!(lacking(Dialect::Sinumerik, length_along_z, sinumerik), expected);
    }
    let with = |from: &str, to: &str| {
        assert!(sinumerik.contains(from));
        lacking(Dialect::Sinumerik, None, &sinumerik.replace(from, to))
    };
    // It counts with each move, by the plane of the move.
    assert!(with("\nG0 X0", "\nG17 G0 X0").is_empty());
    assert_eq!(with("\nZ5", "\nG17 Z5"), ["G17"]);
    assert!(with("D1", "D0").is_empty());
    // The tool stands in its head as the plane says (W1 11/2006 p. 129), also where no edge counts.
    let on = |words: &str| {
        let text =
            format!("G710 G90 G94 G54\nT1\nM6\nD0\n{words}\nG0 X0 Y0 Z5 A0 C0\nTRAFOOF\nM30\n");
        lacking(Dialect::Sinumerik, None, &text)
    };
    assert_eq!(on("TRAORI"), ["G17"]);
    assert!(on("G17\nTRAORI").is_empty());
    assert!(on("").is_empty());
}

/// What counts in the plane without a length: turned and polar coordinates, corners.
#[test]
fn what_counts_in_the_plane_leans_on_it() {
    let sinumerik = |text: &str| {
        lacks(&machine(Dialect::Sinumerik), &format!("G71 G90 G94 G54\n{text}\nM30\n"))
    };
    assert_eq!(sinumerik("G0 X0 Y0 Z0\nG111 X0 Y0\nG1 AP=30 RP=10 F100"), ["G17"]);
    assert_eq!(sinumerik("ROT RPL=30\nG0 X0 Y0 Z0\nROT"), ["G17"]);
    assert!(sinumerik("ROT Z30\nG0 X0 Y0 Z0\nROT").is_empty());
    assert_eq!(sinumerik("G0 X0 Y0 Z0\nG1 X10 CHF=1 F100\nY10"), ["G17"]);
    let fanuc = |text: &str| {
        lacks(&machine(Dialect::Fanuc), &format!("G21\nG90 G94 G54\nG0 X0. Y0. Z0.\n{text}\nM30\n"))
    };
    assert_eq!(fanuc("G1 X10. ,C1. F100.\nY10."), ["G17"]);
    assert_eq!(fanuc("G16\nG1 X10. Y30. F100.\nG15"), ["G17"]);
    assert_eq!(fanuc("G68 X0. Y0. R30.\nG69"), ["G17"]);
    assert_eq!(
        lacks(&machine(Dialect::LinuxCnc), "G21 G54 G90 G94\nG0 X1 Y0 Z0\nG1 @10 ^30 F100\nM2\n"),
        ["G17"]
    );
}

/// A program with `SAVE` gives back what its caller has not said.
#[test]
fn what_a_subprogram_gives_back_has_not_been_said() {
    let text = "G71 G90 G94 G54\nT1\nM6\nD1\nINNER\nG0 X0 Y0 Z0\nM30\n\
                %_N_INNER_SPF\nPROC INNER SAVE\nG17\nG0 X0 Y0 Z9\nRET\n";
    assert_eq!(lacks(&machine(Dialect::Sinumerik), text), ["G17"]);
}

/// How often a program leans on a work offset of which nobody has said that it is active.
fn leans_on_offset(settings: &Settings, text: &str) -> usize {
    let found = crate::common::ops(settings, "p.nc", text)
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let risk = |action: &&Action| match action {
        Action::Risk(risk) => risk.refused && risk.rule.name() == "work-offset",
        _ => false,
    };
    found.iter().filter(risk).count()
}

/// FANUC 3402#6, 1202#3; Haas setting 56; Mach3 "Logic"; LinuxCNC parameter 5220, which `Interp::init` takes the number from, and
/// RS274NGC_STARTUP_CODE; GRBL MDI and `$N`.
#[test]
fn a_program_names_its_work_offset_before_it_goes_to_a_place() {
    for dialect in [Dialect::Fanuc, Dialect::Haas, Dialect::LinuxCnc, Dialect::Mach3, Dialect::Grbl]
    {
        let leans =
            |blocks: &str| leans_on_offset(&machine(dialect), &format!("G21 G90\n{blocks}\nM30\n"));
        assert_eq!(leans("G0 X0. Y0.\nZ5.\nX9."), 1, "{dialect:?}");
        assert_eq!(leans("G54 G0 X0. Y0.\nZ5."), 0, "{dialect:?}");
        assert_eq!(leans("G55\nG0 X0. Y0.\nZ5."), 0, "{dialect:?}");
        assert_eq!(leans("G0 X0.\nG54\nY0.\nZ5."), 1, "{dialect:?}");
        // A place of the machine counts from its own zero, and G92 says the zero of its axes.
        assert_eq!(leans("G53 G0 Z0"), 0, "{dialect:?}");
        assert_eq!(leans("G92 X0. Y0.\nG0 X1. Y1."), 0, "{dialect:?}");
        assert_eq!(leans("G92 X0. Y0.\nG0 X1. Y1.\nZ5."), 1, "{dialect:?}");
        let stated = Settings { start_modes: StartModes::SURE, ..machine(dialect) };
        assert_eq!(leans_on_offset(&stated, "G21 G90\nG0 X0. Y0.\nM30\n"), 0);
    }
    // What comes back has not been named.
    let text = "G21 G90\nM70\nG55\nM72\nG0 X0 Y0 Z0\nM2\n";
    assert_eq!(leans_on_offset(&machine(Dialect::LinuxCnc), text), 1);
}

/// Marlin 2.1.2: `active_coordinate_system` is -1 after power on (`gcode.cpp`); `set_axis_is_at_home` sets the shift of an axis to 0
/// (`motion.cpp`), at the start of the day too; `select_coordinate_system` does nothing where its number is the active one, and `G53`
/// goes through -1 and back (`G53-G59.cpp`).
#[test]
fn marlin_takes_the_work_offset_away_at_the_switches() {
    let leans =
        |lines: &str| leans_on_offset(&machine(Dialect::Marlin), &format!("G21\nG90\n{lines}\n"));
    assert_eq!(leans("G0 X0 Y0"), 1);
    assert_eq!(leans("G53 G0 Z9\nG0 X0 Y0"), 1);
    // It may be active already, and taken away.
    assert_eq!(leans("G54\nG0 X0 Y0"), 1);
    assert_eq!(leans("G54\nG53 G0 Z9\nG0 X0 Y0\nG0 Z1"), 0);
    assert_eq!(leans("G53 G0 Z9\nG54\nG0 X0 Y0"), 0);
    assert_eq!(leans("G55\nG54\nG0 X0 Y0"), 0);
    let homed = |lines: &str| leans(&format!("G54\nG53 G0 Z9\n{lines}"));
    assert_eq!(homed("G28 X Y\nG0 X0 Y0"), 1);
    assert_eq!(homed("G28 X Y\nG54\nG0 X0 Y0"), 1);
    assert_eq!(homed("G28 X Y\nG53 G0 Z9\nG0 X0 Y0"), 0);
    assert_eq!(homed("G28 X Y\nG55\nG0 X0 Y0"), 0);
    assert_eq!(homed("G28 X Y\nG55\nG54\nG0 X0 Y0"), 0);
    // Its own axes alone.
    assert_eq!(homed("G28 X\nG0 Y0\nG0 Z1"), 0);
    assert_eq!(homed("G28 X\nG0 Y0\nG1 X5 F100"), 1);
    assert_eq!(homed("G1 X1 F100\nG1 X2\nG28 X\nG1 Y2\nG1 Y3\nG1 X2"), 1);
    assert_eq!(homed("G28\nG0 Z1"), 1);
    // G92 says where the axis stands.
    assert_eq!(leans("G28 X Y\nG92 X0 Y0\nG0 X1 Y1"), 0);
}

/// G98 is what a FANUC and a Haas power on with; G99 of MDI, or of a program that was broken off, may be left.
#[test]
fn a_cycle_says_how_high_it_goes_back() {
    for dialect in [Dialect::Fanuc, Dialect::Haas] {
        let lacking = |cycle: &str| {
            let text = format!(
                "G21\nG17 G90 G94 G54\nG0 X0. Y0. Z9.\n{cycle} X5. Z-1. R2. F100.\nG80\nM30\n"
            );
            lacks(&machine(dialect), &text)
        };
        assert_eq!(lacking("G81"), ["G98"], "{dialect:?}");
        assert!(lacking("G98 G81").is_empty(), "{dialect:?}");
        assert!(lacking("G99 G81").is_empty(), "{dialect:?}");
    }
}

/// Mach3 General Config, "G04 Dwell param in Milliseconds": the same P3 is 3 s or 3 ms.
#[test]
fn how_long_mach3_dwells_is_set_up() {
    let dwell = |dwell_p_milliseconds, block: &str| {
        let settings = Settings { dwell_p_milliseconds, ..machine(Dialect::Mach3) };
        let found = crate::common::ops(&settings, "p.nc", format!("G21\n{block}\nM30\n")).unwrap();
        let seconds = found.iter().find_map(|action| match action {
            Action::Dwell(dwell) => Some(*dwell),
            _ => None,
        });
        let asked = found.iter().any(|action| match action {
            Action::Risk(risk) => risk.refused && risk.rule.name() == "dwell-unit",
            _ => false,
        });
        (seconds, asked)
    };
    assert_eq!(dwell(None, "G4 P3"), (Some(3.0), true));
    assert_eq!(dwell(Some(false), "G4 P3"), (Some(3.0), false));
    assert_eq!(dwell(Some(false), "G4 P0.5"), (Some(0.5), false));
    assert_eq!(dwell(Some(true), "G4 P3000"), (Some(3.0), false));
    assert!(!dwell(None, "G4 P0").1);
}
