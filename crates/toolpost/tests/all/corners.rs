//! How far a control may leave the path at corners: what Toolpost writes bounds it, and a program that does not is
//! refused, whoever wrote it.

use machine::{Machine, load, load_text};
use std::path::Path;

fn sample() -> program::Program {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/samples/three-axes.cls");
    let text = std::fs::read(&file).unwrap();
    source::apt::read("three-axes.cls", &text, &Default::default()).unwrap().program
}

fn posted(machine: &Machine) -> String {
    let output = post::write(&sample(), machine).unwrap_or_else(|found| panic!("{found:?}"));
    String::from_utf8(output.text).unwrap()
}

/// Whether the program is proven on the machine, or the rule of the first mismatch.
fn proven(machine: &Machine, text: &str) -> Result<(), &'static str> {
    let report = proof::prove(&sample(), machine, "t", text.as_bytes(), &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err(found.rule.name()))
}

/// The same with `line` instead of the line that starts with `old`.
fn instead(text: &str, old: &str, line: &str) -> String {
    let is_old = |l: &&str| {
        l.trim_start_matches(|c: char| c == 'N' || c.is_ascii_digit()).trim().starts_with(old)
    };
    assert_eq!(text.lines().filter(is_old).count(), 1, "{old}\n{text}");
    let lines = text.lines().map(|l| if is_old(&l) { line } else { l });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

/// A real LinuxCNC 2.9 misses a corner of 90° at 6000 mm/min by 10.36 mm after `G64` and after `G64 P0`, by 0.0105 mm
/// after `G64 P0.01 Q0`, and by nothing after `G61`.
#[test]
fn linuxcnc_keeps_to_the_path_within_the_bound_of_its_file() {
    let machine = load("linuxcnc-mill").unwrap();
    let text = posted(&machine);
    assert_eq!(proven(&machine, &text), Ok(()));
    for (line, held) in [
        ("", false),
        ("G64", false),
        ("G64 P0", false),
        ("G64 P5", false),
        ("G64 P0.005 Q0.006", false),
        // Without Q lines within P are one as well.
        ("G64 P0.006", false),
        ("G64 P0.005", true),
        ("G64 P0.01 Q0", true),
        ("G61", true),
        ("G61.1", true),
    ] {
        let expected = if held { Ok(()) } else { Err("path-tolerance") };
        assert_eq!(proven(&machine, &instead(&text, "G64", line)), expected, "{line}");
    }
    assert_eq!(proven(&machine, &instead(&text, "G64", "G64 P-1")), Err("path-mode"));
    // In inches a bound is in inches.
    let inches = instead(&text, "G64", "G20 G64 P0.005 Q0\nG21");
    assert_eq!(proven(&machine, &inches), Err("path-tolerance"));
    let between = text.replacen("M6\n", "M6\nG64\n", 1);
    assert_eq!(proven(&machine, &between), Err("path-tolerance"));
}

/// What is accepted is listed, and nothing else passes with it.
#[test]
fn a_rule_that_is_accepted_passes_and_stands_in_the_report() {
    let machine = load("linuxcnc-mill").unwrap();
    let text = instead(&posted(&machine), "G64", "G64");
    let accepted = proof::Accepted::default().and("path-tolerance").unwrap();
    let tolerances = proof::Tolerances { accepted, ..Default::default() };
    let prove = |text: &str| proof::prove(&sample(), &machine, "t", text.as_bytes(), &tolerances);
    let report = prove(&text);
    assert!(report.proven && report.mismatches.is_empty());
    let [found] = &report.accepted[..] else { panic!("{:?}", report.accepted) };
    assert!(
        found.rule.name() == "path-tolerance" && !found.is_error() && found.count > 1,
        "{found:?}"
    );
    assert!(found.message.contains("by any amount"), "{}", found.message);
    let deeper = prove(&text.replacen("Z-2 ", "Z-3 ", 1));
    assert_eq!(deeper.mismatches[0].rule.name(), "path");
    for rule in ["end-point", "tool", "machine-position", ""] {
        assert!(proof::Accepted::default().and(rule).is_err(), "{rule}");
    }
}

#[test]
fn a_machine_that_keeps_to_the_path_gets_the_word_for_it() {
    let exact = "extends = \"linuxcnc-mill\"\n[options]\npath_tolerance = 0\n";
    let machine = load_text("own.toml", exact).unwrap();
    let text = posted(&machine);
    assert!(text.lines().any(|line| line == "G61"), "{text}");
    assert_eq!(proven(&machine, &text), Ok(()));
    assert_eq!(proven(&machine, &text.replace("G61", "G64 P0.001")), Err("path-tolerance"));
}

/// Its constant velocity is as the operator set it up, so it counts only where the machine's file says how far.
#[test]
fn constant_velocity_of_mach3_is_as_its_file_says() {
    let machine = load("mach3-mill").unwrap();
    let text = posted(&machine);
    assert_eq!(proven(&machine, &text), Ok(()));
    for line in ["", "G64"] {
        let damaged = instead(&text, "G61", line);
        assert_eq!(proven(&machine, &damaged), Err("path-tolerance"), "{line}");
    }
    let smooth = "extends = \"mach3-mill\"\n[options]\npath_tolerance = 0.02\n";
    let smooth = load_text("own.toml", smooth).unwrap();
    let text = posted(&smooth);
    assert!(text.contains("G64\n"), "{text}");
    assert_eq!(proven(&smooth, &text), Ok(()));
}

/// Haas, "G187": without E corners are rounded as setting 85 says, with the word or without, and nothing of a program bounds
/// that; `G61` stops in each.
#[test]
fn a_haas_rounds_corners_as_far_as_g187_says_and_no_program_leaves_that_to_setting_85() {
    let haas = load("generic-3axis-haas").unwrap();
    let text = posted(&haas);
    let written = "G187 E0.01";
    assert!(text.contains(written), "{text}");
    assert_eq!(proven(&haas, &text), Ok(()));
    for (line, held) in [
        ("G187 P3 E5.", false),
        ("G187 P1 E0.", true),
        ("G187 P2", false),
        ("G187", false),
        ("", false),
        ("G61", true),
        ("G187 E0.01\nG61\nG64", true),
        ("G187 E0.01\nG187 P3", false),
        ("G64", false),
    ] {
        let damaged = text.replacen(written, line, 1);
        let expected = if held { Ok(()) } else { Err("path-tolerance") };
        assert_eq!(proven(&haas, &damaged), expected, "{line}");
    }
    let exact = "extends = \"generic-3axis-haas\"\n[options]\npath_tolerance = 0\n";
    let exact = load_text("own.toml", exact).unwrap();
    let text = posted(&exact);
    assert!(text.contains("G61\n") && !text.contains("G187"), "{text}");
    assert_eq!(proven(&exact, &text), Ok(()));
}

#[test]
fn a_tolerance_beyond_the_machines_file_is_refused_on_other_controls() {
    let heidenhain = load("generic-3axis-heidenhain").unwrap();
    let text = posted(&heidenhain);
    assert_eq!(proven(&heidenhain, &text), Ok(()));
    for (cycle, held) in [
        ("T5", false),
        ("T0.02", false),
        ("T0.005\n4 CYCL DEF 32.2 HSC-MODE:1 TA0.5", true),
        ("T0.005", true),
        // It ends the cycle: what the builder has set up is not known.
        ("", false),
    ] {
        let damaged = text.replacen("32.1 T0.01", &format!("32.1 {cycle}"), 1);
        let damaged = numbered(&damaged);
        assert_eq!(proven(&heidenhain, &damaged).is_ok(), held, "{cycle}");
    }
    let without: String = text
        .lines()
        .filter(|line| !line.contains("CYCL DEF 32"))
        .map(|line| format!("{line}\n"))
        .collect();
    assert_eq!(proven(&heidenhain, &numbered(&without)), Err("path-tolerance"));
    let sinumerik = load("generic-3axis-sinumerik").unwrap();
    let text = posted(&sinumerik);
    assert_eq!(proven(&sinumerik, &text), Ok(()));
    let written = "CYCLE832(0.01,_FINISH,1)";
    for (words, held) in [
        ("CYCLE832(0.02,_FINISH,1)", false),
        ("CYCLE832(0.01,_ROUGH,1)", true),
        ("CTOL=0.02 G642", false),
        ("CTOL=0.01 G642", true),
        ("G641 ADIS=0.02", false),
        ("G641 ADIS=0.01", true),
        ("G641 ADISPOS=0.02", false),
        // Without a word nobody says that the path is smoothed at all.
        ("G64", true),
        ("G642", false),
    ] {
        let damaged = text.replace(written, words);
        assert_ne!(text, damaged);
        let damaged = damaged.replace("CYCLE832(0,_OFF,1)", "G64 CTOL=-1 ADIS=0 ADISPOS=0");
        let rule = proven(&sinumerik, &damaged).err();
        assert_eq!(rule == Some("path-tolerance"), !held, "{words}: {rule:?}");
    }
}

/// HEIDENHAIN numbers each block; a line that goes on has no number.
fn numbered(text: &str) -> String {
    let mut next = 0;
    let number = |line: &str| {
        let rest = match line.split_once(' ') {
            Some((number, rest)) if number.parse::<u32>().is_ok() => rest,
            _ if line.starts_with('Q') => return format!("{line}\n"),
            _ => line,
        };
        next += 1;
        format!("{} {rest}\n", next - 1)
    };
    text.lines().map(number).collect()
}

/// A slot for each of three tools: the source says 0.05 mm for roughing, 0.004 mm for finishing, and nothing at first.
const BY_OPERATION: &str = "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,60\nCUTTER/10,0\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,20\n\
    FEDRAT/300,MMPM\nGOTO/0,0,-1\nGOTO/20,0,-1\nRAPID\nGOTO/20,0,20\n\
    LOADTL/2,LENGTH,60\nCUTTER/10,0\nINTOL/0.02\nOUTTOL/0.03\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,10,20\nFEDRAT/300,MMPM\n\
    GOTO/0,10,-1\nGOTO/20,10,-1\nRAPID\nGOTO/20,10,20\n\
    LOADTL/3,LENGTH,60\nCUTTER/10,0\nINTOL/0.001\nOUTTOL/0.003\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,20,20\nFEDRAT/300,MMPM\n\
    GOTO/0,20,-1\nGOTO/20,20,-1\nRAPID\nGOTO/20,20,20\nFINI\n";

/// Each control is given the tolerance of the operation before its first cut, and one that is looser there is refused.
#[test]
fn the_tolerance_of_each_operation_is_written_and_compared() {
    let source = source::apt::read("job.cls", BY_OPERATION.as_bytes(), &Default::default());
    let source = source.unwrap().program;
    let rough = "roughing_tolerance = 0.04\n";
    for (name, options, sign, expected) in [
        // P is half of it: lines within P are made one besides.
        ("linuxcnc-mill", "", "G64 ", &["P0.005 Q0.005", "P0.002"][..]),
        ("linuxcnc-mill", rough, "G64 ", &["P0.005 Q0.005", "P0.02", "P0.002"]),
        ("generic-3axis-haas", "", "G187 ", &["E0.01", "E0.004"]),
        ("generic-3axis-haas", rough, "G187 ", &["E0.01", "P1 E0.04", "E0.004"]),
        ("generic-3axis-heidenhain", "", "CYCL DEF 32.1 ", &["T0.01", "T0.004"]),
        ("generic-3axis-heidenhain", rough, "CYCL DEF 32.1 ", &["T0.01", "T0.04", "T0.004"]),
        (
            "generic-3axis-heidenhain",
            rough,
            "CYCL DEF 32.2 ",
            &["HSC-MODE:0 TA0", "HSC-MODE:1 TA0", "HSC-MODE:0 TA0"],
        ),
        // CYCLE832 ends before each tool.
        (
            "generic-3axis-sinumerik",
            rough,
            "CYCLE832(0.",
            &["01,_FINISH,1)", "04,_ROUGH,1)", "004,_FINISH,1)"],
        ),
        ("mach3-mill", "path_tolerance = 0.02\n", "G6", &["4", "1"]),
    ] {
        let machine = format!("extends = \"{name}\"\n[options]\n{options}");
        let machine = load_text("own.toml", &machine).unwrap();
        let output = post::write(&source, &machine).unwrap_or_else(|found| panic!("{found:?}"));
        assert!(!output.warnings.iter().any(|found| found.rule.name() == "path-mode"));
        let text = String::from_utf8(output.text).unwrap();
        let said: Vec<_> = text.lines().filter_map(|line| Some(line.split_once(sign)?.1)).collect();
        assert_eq!(said, expected, "{name}\n{text}");
        let first = |text: &str| {
            let report = proof::prove(&source, &machine, "t", text.as_bytes(), &Default::default());
            report.mismatches.first().map(|found| found.rule.name())
        };
        assert_eq!(first(&text), None, "{name}");
        if sign.starts_with("CYCL DEF 32.2") {
            continue;
        }
        // As loose as before, where the source asks for less.
        let (before, last) = (&expected[expected.len() - 2], &expected[expected.len() - 1]);
        let looser = text.replace(&format!("{sign}{last}"), &format!("{sign}{before}"));
        assert_eq!(first(&looser), Some("path-tolerance"), "{name}\n{looser}");
        if options == rough {
            let [own, rough, ..] = expected else { unreachable!() };
            let first_cuts = text.replacen(&format!("{sign}{own}"), &format!("{sign}{rough}"), 1);
            assert_eq!(first(&first_cuts), Some("path-tolerance"), "{name}\n{first_cuts}");
        }
    }
}

/// `G61` of a source is `G61` where the control has it, else the least that its word says.
#[test]
fn a_source_that_keeps_to_the_path_is_followed() {
    let linuxcnc = load("linuxcnc-mill").unwrap();
    let text = "G21 G90 G17 G94 G54 G61\nT1 M6\nS1000 M3\nG43 H1\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX9\nG64 P0.1\nX18\nG0 Z50\nM30\n";
    let source = nc::read(&linuxcnc, Default::default(), "s.ngc", text.as_bytes()).unwrap().program;
    for (name, exact, loose) in [
        ("linuxcnc-mill", "G61\n", "G64 P0.005\n"),
        ("generic-3axis-haas", "G187 E0.001\n", "G187 E0.01\n"),
        ("generic-3axis-heidenhain", "CYCL DEF 32.1 T0.001\n", "CYCL DEF 32.1 T0.01\n"),
        ("generic-3axis-sinumerik", "CYCLE832(0,_OFF,1)\n", "CYCLE832(0.01,_FINISH,1)\n"),
    ] {
        let machine = load(name).unwrap();
        let output = post::write(&source, &machine).unwrap_or_else(|found| panic!("{found:?}"));
        assert!(!output.warnings.iter().any(|found| found.rule.name() == "path-mode"));
        let text = String::from_utf8(output.text).unwrap();
        let at = |what: &str| text.find(what).unwrap_or(usize::MAX);
        let (exact_at, loose_at) = (at(exact), text.rfind(loose).unwrap_or(0));
        let cut = at("X9").min(at("X+9"));
        assert!(exact_at < cut && cut < loose_at && loose_at < text.len(), "{name}\n{text}");
        let first = |text: &str| {
            let report = proof::prove(&source, &machine, "t", text.as_bytes(), &Default::default());
            report.mismatches.first().map(|found| found.rule.name())
        };
        assert_eq!(first(&text), None, "{name}\n{text}");
        assert_eq!(first(&text.replacen(exact, loose, 1)), Some("path-tolerance"), "{name}");
    }
}

/// A FANUC rounds corners as its parameters say, and no word of a program says how far; a GRBL goes through each corner, `$11` says
/// how fast.
#[test]
fn a_tolerance_for_which_a_control_has_no_word_is_warned_of() {
    let source = source::apt::read("job.cls", BY_OPERATION.as_bytes(), &Default::default());
    let source = source.unwrap().program;
    for (name, is_warned) in [("generic-3axis-fanuc", true), ("generic-3axis-grbl", false)] {
        let machine = load(name).unwrap();
        let output = post::write(&source, &machine).unwrap_or_else(|found| panic!("{found:?}"));
        let warned: Vec<_> =
            output.warnings.iter().filter(|found| found.rule.name() == "path-mode").collect();
        assert_eq!(!warned.is_empty(), is_warned, "{name}: {warned:#?}");
        assert!(warned.len() <= 1, "{warned:#?}");
    }
}

#[test]
fn what_a_source_asks_for_and_the_machine_does_not_give_is_reported() {
    let silent = "extends = \"linuxcnc-mill\"\n[blocks]\nlook_ahead_on = \"\"\n";
    let machine = load_text("own.toml", silent).unwrap();
    let reported = |mode: &str| {
        let text = format!(
            "G21 G90 G17 G94 G54 {mode}\nT1 M6\nS1000 M3\nG43 H1\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX9\nG0 Z50\nM30\n"
        );
        let read = nc::read(&machine, Default::default(), "s.ngc", text.as_bytes()).unwrap();
        let output = post::write(&read.program, &machine).unwrap();
        let rules = output.warnings.iter().filter(|found| found.rule.name() == "path-mode");
        rules.map(|found| found.message.clone()).collect::<Vec<_>>()
    };
    assert_eq!(reported("G64 P0.1"), [""; 0]);
    assert_eq!(reported("G64"), [""; 0]);
    assert_eq!(
        reported("G61.1"),
        ["the source stops at each corner: this control leaves it by 0.01 mm at the most there"]
    );
    assert_eq!(
        reported("G64 P0.001"),
        [
            "the source leaves the path by 0.002 mm at corners: this control leaves it by 0.01 mm at the most there"
        ]
    );
}

/// A slot down to Z-30, out of it by rapid to Z2 and on by rapid to X80: the rounding of that corner goes through its wall.
const SLOT: &str = "PARTNO/SLOT\nUNITS/MM\nLOADTL/1,LENGTH,60\nCUTTER/10,0\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,50\nRAPID\n\
    GOTO/0,0,2\nFEDRAT/300,MMPM\nGOTO/0,0,-30\nGOTO/20,0,-30\nRAPID\nGOTO/20,0,2\nRAPID\nGOTO/80,0,2\nGOTO/80,0,-5\nRAPID\n\
    GOTO/80,0,50\nFINI\n";

/// A real LinuxCNC 2.9 leaves a corner between two rapids after `G64 P20` by 3.6 mm, and by nothing after `G61`. Of Mach3, Haas and
/// HEIDENHAIN no manual says that their rounding ends at rapids.
#[test]
fn corners_of_rapids_near_the_part_are_rounded_no_more_than_the_machine_file_lets_rapids() {
    let source = source::apt::read("slot.cls", SLOT.as_bytes(), &Default::default()).unwrap();
    for (name, out, cut, wide, narrow, tight) in [
        ("linuxcnc-mill", "G0 Z2", "G1 Z-5", "G64 P20", "G64 P0.005 Q0.005", "G64 P0.05 Q0.05"),
        ("linuxcnc-mill", "G0 Z2", "G1 Z-5", "G64", "G61", "G61.1"),
        ("mach3-mill", "G0 Z2", "G1 Z-5", "G64", "G61", "G61"),
        ("generic-3axis-haas", "G0 Z2.", "G1 Z-5.", "G187 E20.", "G187 E0.01", "G187 E0.1"),
        ("generic-3axis-haas", "G0 Z2.", "G1 Z-5.", "G187", "G187 E0.01", "G61"),
        ("haas-umc-750", "G0 Z2.", "G1 Z-5.", "G187 E20.", "G187 E0.01", "G187 E0.1"),
        (
            "generic-3axis-heidenhain",
            "L Z+2 R0 FMAX",
            "L Z-5 R0",
            "CYCL DEF 32.0 TOLERANCE\n0 CYCL DEF 32.1 T5",
            "CYCL DEF 32.0 TOLERANCE\n0 CYCL DEF 32.1 T0.01",
            "CYCL DEF 32.0 TOLERANCE\n0 CYCL DEF 32.1 T0.1",
        ),
    ] {
        let machine = load(name).unwrap();
        let output = post::write(&source.program, &machine).unwrap();
        let text = String::from_utf8(output.text).unwrap();
        let klartext = machine.reader == "klartext";
        let with = |words: &str| {
            let number = |line: &str| line.split_once(' ').map_or("", |(_, rest)| rest).to_owned();
            let is = |line: &str, block: &str| number(line) == block || line == block;
            // The rapid out of the slot is the last of these.
            let at = text.lines().enumerate().filter(|(_, line)| is(line, out)).last();
            let at = at.unwrap_or_else(|| panic!("{out}\n{text}")).0;
            let mut damaged = String::new();
            for (i, line) in text.lines().enumerate() {
                let before = match () {
                    () if i == at => words,
                    () if is(line, cut) => narrow,
                    () => "",
                };
                let zero = if klartext { "0 " } else { "" };
                if !before.is_empty() {
                    damaged += &format!("{zero}{before}\n");
                }
                damaged += &format!("{line}\n");
            }
            assert_eq!(text.lines().filter(|line| is(line, cut)).count(), 1, "{text}");
            if klartext { numbered(&damaged) } else { damaged }
        };
        let rules = |text: &str| {
            let report =
                proof::prove(&source.program, &machine, "t", text.as_bytes(), &Default::default());
            let found = report.mismatches.iter().map(|found| found.rule.name());
            found.collect::<Vec<_>>()
        };
        assert_eq!(rules(&text), [""; 0], "{name}");
        assert_eq!(rules(&with(wide)).first(), Some(&"path-tolerance"), "{name} {wide}");
        assert_eq!(rules(&with(tight)), [""; 0], "{name} {tight}");
    }
}
