//! Single words put into proven programs: what they switch, set or change in addition to the motion is refused, in front of the cuts
//! and behind the last of them.

use crate::files::root;
use control::Action;
use machine::{Machine, load, load_text};
use program::Program;

fn read(text: &str) -> Program {
    source::apt::read("job.cls", text.as_bytes(), &Default::default()).unwrap().program
}

fn file(name: &str) -> Program {
    read(&std::fs::read_to_string(root().join(name)).unwrap())
}

/// The proven program of a source.
fn proven(source: &Program, machine: &Machine) -> String {
    let output = post::write(source, machine).unwrap_or_else(|found| panic!("{found:?}"));
    let text = String::from_utf8(output.text).unwrap();
    assert_eq!(rules(source, machine, &text), [""; 0], "{}", machine.name);
    text
}

/// The rules that a program breaks.
fn rules(source: &Program, machine: &Machine, text: &str) -> Vec<&'static str> {
    let report = proof::prove(source, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.iter().map(|found| found.rule.name()).collect()
}

/// The text with a line put in before line `at`, from 0; Klartext is numbered anew.
fn with(machine: &Machine, text: &str, at: usize, line: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let numbered = format!("0 {line}");
    lines.insert(at, if machine.reader == "klartext" { &numbered } else { line });
    let mut number = 0;
    let renumber = |line: &&str| match line.split_once(' ') {
        Some((digits, rest)) if machine.reader == "klartext" && digits.parse::<u32>().is_ok() => {
            number += 1;
            format!("{} {rest}\n", number - 1)
        }
        _ => format!("{line}\n"),
    };
    lines.iter().map(renumber).collect()
}

/// The place of the last line that has one of these words.
fn last(text: &str, words: &[&str]) -> usize {
    let has = |line: &str| words.iter().any(|word| line.contains(word));
    text.lines().enumerate().filter(|(_, line)| has(line)).last().unwrap().0
}

/// The place of the block that cuts first.
fn first_cut(machine: &Machine, text: &str) -> usize {
    let settings = nc::settings(machine, control::Setup::default()).unwrap();
    let mut first = None;
    let cuts =
        |action: &Action| matches!(action, Action::Line(_) | Action::Arc(_) | Action::Hole(_));
    control::read(&settings, "p", text.as_bytes(), &mut |event| {
        first = first.or(cuts(&event.action).then_some(event.line as usize));
        Ok(())
    })
    .unwrap();
    first.unwrap() - 1
}

#[test]
fn a_word_that_takes_something_from_the_operator_is_refused_wherever_it_stands() {
    for (name, source, words, rule) in [
        (
            "sinumerik-840d-table-ac",
            "machines/samples/five-axes.cls",
            &["R24=0", "R24=45"][..],
            "operator-data",
        ),
        (
            "sinumerik-840d-traori",
            "machines/samples/five-axes.cls",
            &["G26 X10", "G25 X-5", "G26 S900"],
            "operator-data",
        ),
        (
            "sinumerik-840d-traori",
            "machines/samples/five-axes.cls",
            &["WALIMOF"],
            "operator-controls",
        ),
        (
            "sinumerik-840d-traori",
            "machines/samples/five-axes.cls",
            &["ACC[X]=200", "JERKLIMA[A]=150"],
            "axis-dynamics",
        ),
        ("sinumerik-840d-traori", "machines/samples/five-axes.cls", &["M41", "M45"], "gear"),
        ("generic-3axis-fanuc", "examples/plate.cls", &["#500=5.", "#700=5."], "operator-data"),
        ("generic-3axis-haas", "examples/plate.cls", &["#500=5.", "#700=5."], "operator-data"),
        ("generic-3axis-heidenhain", "examples/plate.cls", &["QR5 = 3"], "operator-data"),
        ("generic-3axis-heidenhain", "examples/plate.cls", &["M107", "M141"], "operator-controls"),
        (
            "generic-3axis-heidenhain",
            "examples/plate.cls",
            &["M101", "M101 BT5"],
            "replacement-tool",
        ),
        ("generic-3axis-fanuc", "examples/plate.cls", &["M49", "G63"], "operator-controls"),
        ("generic-3axis-haas", "examples/plate.cls", &["M49"], "operator-controls"),
        ("mach3-mill", "machines/samples/three-axes.cls", &["M49"], "operator-controls"),
        (
            "generic-3axis-linuxcnc",
            "examples/plate.cls",
            &["M49", "M50 P0", "M51 P0", "M53 P0"],
            "operator-controls",
        ),
        ("generic-3axis-linuxcnc", "examples/plate.cls", &["M52 P1", "M52"], "adaptive-feed"),
    ] {
        let (machine, source) = (load(name).unwrap(), file(source));
        let text = proven(&source, &machine);
        let end = last(&text, &["M30", "M2", "M17"]);
        for word in words {
            for at in [first_cut(&machine, &text), end] {
                let damaged = with(&machine, &text, at, word);
                let found = rules(&source, &machine, &damaged);
                assert!(found.contains(&rule), "{name}: {word} before line {at}: {found:?}");
            }
        }
    }
}

/// A block that leans on an older one: `G81` for `G80`, `G29` for the last `G28`, `G43` without its H.
#[test]
fn a_block_that_leans_on_an_older_one_is_refused() {
    for (name, source, from, to, rule) in [
        ("generic-3axis-fanuc", "examples/plate.cls", "G80", "G81", "cycle"),
        ("generic-3axis-haas", "examples/plate.cls", "G80", "G81", "cycle"),
        ("generic-3axis-fanuc", "examples/plate.cls", "G91 G28 Z0", "G91 G29 Z0", "home"),
        ("generic-3axis-haas", "examples/plate.cls", "G91 G28 Z0", "G91 G29 Z0", "home"),
        ("fanuc-table-bc", "machines/samples/five-axes.cls", " H", " ", "length-offset"),
    ] {
        let (machine, source) = (load(name).unwrap(), file(source));
        let text = proven(&source, &machine);
        // The last of them, but for the head of the program.
        let at = match rule {
            "length-offset" => last(&text, &["G43"]),
            _ => last(&text, &[from]),
        };
        let replace = |(i, line): (usize, &str)| match i == at && rule == "length-offset" {
            true => {
                let words = line.split(' ').filter(|word| !word.starts_with('H'));
                words.collect::<Vec<_>>().join(" ") + "\n"
            }
            false if i == at => line.replace(from, to) + "\n",
            false => format!("{line}\n"),
        };
        let damaged: String = text.lines().enumerate().map(replace).collect();
        assert_ne!(damaged, text);
        let found = rules(&source, &machine, &damaged);
        assert!(found.contains(&rule), "{name} {to}: {found:?}");
    }
}

/// At the start the tool may stand beside a clamp: each control's own way to send X and Y home with Z, or before it, gets a warning.
#[test]
fn x_and_y_home_with_z_or_before_it_at_the_start_get_a_warning() {
    let source = file("machines/samples/three-axes.cls");
    for (name, z, others) in [
        ("generic-3axis-haas", "G91 G28 Z0", &["G91 G28", "G91 G28 X0 Y0 Z0", "G91 G28 Y0 Z0"][..]),
        ("generic-3axis-mach3", "G91 G28 Z0", &["G91 G28", "G91 G28 X0 Y0 Z0", "G91 G28 Y0 Z0"]),
        ("generic-3axis-fanuc", "G91 G28 Z0", &["G91 G28 X0 Y0 Z0", "G91 G28 X0\nG28 Z0"]),
        ("generic-3axis-iso", "G91 G28 Z0", &["G91 G28 X0 Y0 Z0", "G91 G28 X0\nG28 Z0"]),
        (
            "generic-3axis-sinumerik",
            "G0 SUPA Z0 D0",
            &["G74 X1=0 Y1=0 Z1=0\nD0", "G74 X1=0\nG74 Z1=0\nD0"],
        ),
    ] {
        let machine = load(name).unwrap();
        let text = proven(&source, &machine);
        let warned = |text: &str| {
            let report = proof::prove(&source, &machine, "p", text.as_bytes(), &Default::default());
            assert!(report.proven, "{name}: {:?}\n{text}", report.mismatches);
            report.warnings.iter().filter(|found| found.rule.name() == "home").count()
        };
        assert_eq!(warned(&text), 0, "{name}");
        for other in others {
            assert_eq!(warned(&text.replacen(z, other, 1)), 1, "{name}: {other}");
        }
    }
}

/// A control that has T1 in its spindle skips a change to T1: the second tool never comes.
#[test]
fn two_tools_under_one_number_are_refused_on_every_mill() {
    let text = |second: &str, diameter: &str| {
        format!(
            "UNITS/MM\nLOADTL/1\nCUTTER/10\nSPINDL/1000,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,20\nGOTO/0,0,0\n\
             RAPID\nGOTO/0,0,20\nLOADTL/{second}\nCUTTER/{diameter}\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/5,0,20\nGOTO/5,0,0\n\
             RAPID\nGOTO/5,0,20\nFINI\n"
        )
    };
    let (twice, other, same) =
        (read(&text("1", "6")), read(&text("2", "6")), read(&text("1", "10")));
    let mills = crate::files::mills();
    for machine in mills {
        let found = post::write(&twice, &machine).unwrap_err();
        let found: Vec<_> = found.iter().map(|found| (found.rule.name(), found.line)).collect();
        assert_eq!(found, [("tool-twice", 11)], "{}", machine.name);
        let written = proven(&same, &machine);
        assert!(rules(&twice, &machine, &written).contains(&"tool-twice"), "{}", machine.name);
        proven(&other, &machine);
    }
}

/// PM19 p. 181. The way by which a rapid goes from (10, 0, 0) to (110, 5, 40) dives next to the part where each axis goes by itself.
#[test]
fn behind_rtliof_a_rapid_is_no_straight_line() {
    let source = read(
        "UNITS/MM\nLOADTL/1\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,0\nGOTO/10,0,0\n\
         RAPID\nGOTO/110,5,40\nGOTO/110,5,0\nRAPID\nGOTO/0,5,50\nFINI\n",
    );
    let machine = |rapid_path: &str| {
        let text = format!(
            "extends = \"generic-3axis-sinumerik\"\n[settings]\nrapid_path = \"{rapid_path}\"\n"
        );
        load_text("rapids", &text).unwrap()
    };
    let (straight, independent) = (machine("linear"), machine("independent"));
    let text = proven(&source, &straight);
    let rtliof = with(&straight, &text, first_cut(&straight, &text), "RTLIOF");
    assert!(rules(&source, &straight, &rtliof).contains(&"rapid-path"));
    assert!(rules(&source, &independent, &text).contains(&"rapid-path"));
    // The word counts, not what the machine file says of a control without it.
    let rtlion = with(&independent, &text, first_cut(&independent, &text), "RTLION");
    assert_eq!(rules(&source, &independent, &rtlion), [""; 0]);
    // What is written for axes that go by themselves needs no straight lines.
    let careful = proven(&source, &independent);
    let taken_back = with(&independent, &careful, last(&careful, &["M30"]), "RTLION");
    let rtliof = with(&independent, &taken_back, first_cut(&independent, &careful), "RTLIOF");
    assert_eq!(rules(&source, &independent, &rtliof), [""; 0]);
}

/// MD33100 is 0.1 mm as delivered, and the file of the machine allows 0.01 mm.
#[test]
fn smoothing_is_bounded_by_a_word_of_the_program_and_not_by_machine_data() {
    let (machine, source) =
        (load("sinumerik-840d-traori").unwrap(), file("machines/samples/five-axes.cls"));
    let text = proven(&source, &machine);
    let start = text.lines().position(|line| line.contains("G54")).unwrap() + 1;
    for (word, rule) in [
        ("G642", "path-tolerance"),
        ("G644", "path-tolerance"),
        ("G645", "path-tolerance"),
        ("COMPCAD", "path-tolerance"),
        ("G641 ADISPOS=5", "path-tolerance"),
        ("CYCLE832(-0.99,_FINISH,1)", "cycle-parameter"),
    ] {
        let found = rules(&source, &machine, &with(&machine, &text, start, word));
        assert!(found.contains(&rule), "{word}: {found:?}");
    }
    // With a tolerance that the file allows, and without the cycle that takes it back again.
    let kept: String = text
        .lines()
        .filter(|line| !line.contains("CYCLE832"))
        .map(|line| format!("{line}\n"))
        .collect();
    let taken_back = with(&machine, &kept, last(&kept, &["M30"]), "CTOL=-1 G64");
    let bounded = with(&machine, &taken_back, start, "CTOL=0.01 G642");
    assert_eq!(rules(&source, &machine, &bounded), [""; 0]);
}

/// PGZ, CYCLE83 and CYCLE84: a speed of the way out, a direction behind the thread, a dwell above the hole.
#[test]
fn a_cycle_that_asks_for_more_than_the_source_is_refused() {
    let (machine, source) = (load("generic-3axis-sinumerik").unwrap(), file("examples/plate.cls"));
    let text = proven(&source, &machine);
    for (from, to, rule) in [
        (",3,,1.25,0,400,400)", ",3,,1.25,0,400,99999)", "spindle"),
        (",3,,1.25,0,400,400)", ",3,,1.25,0,400,401)", "spindle"),
        (",3,,1.25,0,400,400)", ",4,,1.25,0,400,400)", "spindle"),
        (",3,,1.25,0,400,400)", ",3,,1.25,0,401,401)", "spindle"),
        (",0,0,0,1,1)", ",0,0,1,1,1)", "dwell"),
        (",0,0,0,1,1)", ",0,0,-999,1,1)", "dwell"),
    ] {
        assert!(text.contains(from), "{from}\n{text}");
        let found = rules(&source, &machine, &text.replace(from, to));
        assert!(found.contains(&rule), "{to}: {found:?}");
    }
    // As the other controls: the spindle starts at a speed that somebody has said.
    let stopped = text.lines().position(|line| line.contains("M5")).unwrap();
    let before = with(&machine, &text, stopped, "M4");
    assert!(rules(&source, &machine, &before).contains(&"spindle"));
}

/// FANUC, "Single direction positioning (G60)": the axis goes past the end by parameter 5440, which may be into the part.
#[test]
fn a_rapid_that_goes_past_its_end_is_refused() {
    let source = file("examples/plate.cls");
    for name in ["generic-3axis-fanuc", "generic-3axis-haas"] {
        let machine = load(name).unwrap();
        let text = proven(&source, &machine);
        assert!(text.contains("G0 Z2."), "{text}");
        let past = text.replacen("G0 Z2.", "G60 Z2.", 1);
        assert_eq!(rules(&source, &machine, &past), ["rapid-path"], "{name}");
    }
}

/// The words of a dialect that a proof takes in front of the first cut of a sample: what each does is read here, by a person.
/// Whoever adds a word to a dialect finds it here, or refused.
#[test]
fn each_word_that_a_proof_takes_before_a_cut_has_been_read() {
    for (name, source, expected) in TAKEN {
        let (machine, source) = (load(name).unwrap(), file(source));
        let text = proven(&source, &machine);
        let at = first_cut(&machine, &text);
        let dialect = control::Dialect::named(&machine.reader).unwrap();
        let taken = control::vocabulary(dialect)
            .into_iter()
            .filter(|word| rules(&source, &machine, &with(&machine, &text, at, word)).is_empty());
        let taken: Vec<String> = taken.collect();
        assert_eq!(taken.join(" "), *expected, "{name}");
    }
}

/// A machine, a source, and the words that are taken there.
const TAKEN: &[(&str, &str, &str)] = &[
    // What is on already; ends of what is not on (G15, G49 is not among them: the length is on); G60 without an
    // axis; G62, which only slows down at inner corners.
    (
        "generic-3axis-fanuc",
        "examples/plate.cls",
        "G0 G1 G9 G15 G17 G21 G40 G43 G50 G54 G60 G61 G62 G64 G67 G69 G80 G90 G94 G97 G98 G99 M3 M8 \
         M48",
    ),
    // The same; G103; G255 and M89 end what is not on.
    (
        "generic-3axis-haas",
        "examples/plate.cls",
        "G0 G1 G9 G17 G21 G40 G43 G50 G54 G60 G61 G64 G67 G69 G80 G90 G94 G97 G98 G99 G103 G255 M3 M8 M48 \
         M89",
    ),
    // The same; M48 and M50 to M53 give overrides and feed hold back; M70 to M73 keep modes.
    (
        "generic-3axis-linuxcnc",
        "examples/plate.cls",
        "G0 G8 G17 G21 G40 G43 G54 G61 G61.1 G80 G90 G91.1 G94 G97 G98 G99 M3 M8 M48 M50 M51 M53 M70 \
         M71 M73",
    ),
    // The same: the coolant is off.
    (
        "mach3-mill",
        "machines/samples/three-axes.cls",
        "G0 G1 G15 G17 G21 G40 G50 G54 G61 G69 G71 G80 G90 G91.1 G94 G97 G98 G99 M3 M9 M48",
    ),
    // The same; M1 does nothing.
    (
        "generic-3axis-grbl",
        "machines/samples/three-axes.cls",
        "G0 G1 G17 G21 G40 G49 G54 G61 G80 G90 G91.1 G94 M1 M3 M9",
    ),
    // The same; M17, M82, M83, M117, M400 let nothing move.
    (
        "generic-3axis-marlin",
        "machines/samples/three-axes.cls",
        "G0 G1 G17 G21 G54 G80 G90 M9 M17 M82 M83 M117 M400",
    ),
    // The same; M126 and M127 on a machine without rotary axes; speeds in corners, ends of what is not on, lift-off at a
    // stop (with a warning).
    (
        "generic-3axis-heidenhain",
        "examples/plate.cls",
        "M3 M8 M13 M126 M127 M129 M137 M148 M90 M102 M108 M111 M117 M121 M134 M135 M145 M149",
    ),
    // The same; a motion that the next block replaces; frames and poles without values; how the path is driven
    // as it is delivered (SOFT, DRIVE and FFWON this program takes back at its end); addresses of corners that are not there; where the axes go at a stop (POLF and its kin, with a warning).
    (
        "sinumerik-840d-traori",
        "machines/samples/five-axes.cls",
        "G0 G1 G2 G3 CIP CT G33 G331 G332 TRANS ATRANS ROT AROT SCALE ASCALE MIRROR AMIRROR G58 G59 G110 \
         G111 G112 G17 G40 G54 G53 G153 SUPA G60 G64 G9 G601 G71 G710 G90 G94 CFC NORM G450 BRISK SOFT \
         DRIVE CUT2D CDOF FFWOF FFWON ORIWKS ORIMKS WALIMON DIAMOF COMPOF OSOF FNORM LFOF LFTXT SPATH G290 \
         G460 CP ORIEULER ORIVECT ORIPLANE ORIAXES PAROTOF TOROTOF RTLION FENDNORM DYNNORM ORISOF FRC=1 \
         POLF[X]=150 DILF=1 ALF=1 TRAFOOF CYCLE832 FGROUP GROUP_BEGIN GROUP_END GROUP_ADDEND \
         STOPRE WORKPIECE POLFA POLFMASK POLFMLIN SETMS MCALL M3 M8 M40",
    ),
];
