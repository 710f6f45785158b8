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
/// file"); GRBL $N0, I J K fixed (`gcode.c`). Haas: power-on values of its list of G codes; Marlin: those of its firmware.
#[test]
fn a_mode_that_is_set_up_at_the_machine_is_said_by_the_program() {
    let table: [(Dialect, &str, &[&str]); 6] = [
        (Dialect::Fanuc, "M30\n", &["G17", "G90", "G94"]),
        (Dialect::Haas, "M30\n", &[]),
        (Dialect::LinuxCnc, "M2\n", &["G17", "G90", "G91.1", "G94"]),
        (Dialect::Mach3, "M30\n", &["G17", "G90", "G91.1", "G94"]),
        (Dialect::Grbl, "M2\n", &["G17", "G90", "G94"]),
        (Dialect::Marlin, "", &[]),
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
