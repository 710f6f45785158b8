//! What nobody has said is not zero: the length of a tool that a head tilts, where a rotary axis lies, where the work
//! lies on a turned table. A program that hangs on it is refused, by the writer and by the proof.

use crate::files::root;
use machine::{Machine, load_text};
use program::{Diagnostic, Op, Program};

/// A job that tilts the tool from -Y to +Y, its tool 120 mm long where `length` says so.
fn source(length: &str) -> Program {
    let text = format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1{length}\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/10,5,80,0,0,1\n\
         RAPID\nGOTO/10,5,80,0,0.5,0.8660254\nGOTO/20,5,70,0,0.5,0.8660254\nRAPID\nGOTO/20,5,80,0,0,1\nFINI\n"
    );
    source::apt::read("job.apt", text.as_bytes(), &Default::default())
        .unwrap_or_else(|found| panic!("{found:?}"))
        .program
}

/// A mill whose control turns A by its positions alone: the A of a head or a table, and further lines of its table and
/// of the machine.
fn mill(on: &str, axis: &str, top: &str) -> Machine {
    let text = format!(
        "extends = \"sinumerik-840d\"\nsafe_height = 400\n{top}\n[orientation]\nsimultaneous = \"machine-angles\"\n\
         [axes]\nZ = {{ min = -900, max = 900, rapid = 9000, acceleration = 3 }}\n\
         [[rotary]]\nletter = \"A\"\non = \"{on}\"\naxis = [1, 0, 0]\n{axis}\nmin = -100\nmax = 100\n\
         rapid = 9000\nacceleration = 300\n"
    );
    load_text("mill.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

fn written(machine: &Machine, source: &Program) -> Result<post::Output, Box<Diagnostic>> {
    post::write(source, machine).map_err(|found| Box::new(found.into_iter().next().unwrap()))
}

fn proven(machine: &Machine, source: &Program, text: &[u8]) -> Result<(), Box<Diagnostic>> {
    let report = proof::prove(source, machine, "p", text, &Default::default());
    report.mismatches.into_iter().next().map_or(Ok(()), |found| Err(Box::new(found)))
}

/// The tip of a tool that is 120 mm longer than somebody thinks stands 120 mm · sin 30° from the place.
#[test]
fn a_head_tilts_no_tool_of_unknown_length() {
    let (known, unknown) = (source(",LENGTH,120"), source(""));
    assert!(matches!(
        unknown.records.iter().find_map(|record| match &record.op {
            Op::Tool(tool) => Some(tool.length),
            _ => None,
        }),
        Some(None)
    ));
    let machine = mill("head", "point = [0, 0, 200]", "");
    let output = written(&machine, &known).unwrap();
    proven(&machine, &known, &output.text).unwrap();
    for found in [
        written(&machine, &unknown).unwrap_err(),
        proven(&machine, &unknown, &output.text).unwrap_err(),
    ] {
        assert_eq!(found.rule, "tool-length", "{found}");
        assert!(found.help.contains("LENGTH") && found.line > 0, "{found}");
    }
    // A table turns the part, whatever the tool is.
    let table = mill("table", "point = [0, 0, 0]", "work_zero = [0, 0, 0]");
    let output = written(&table, &unknown).unwrap();
    proven(&table, &unknown, &output.text).unwrap();
}

#[test]
fn an_axis_of_which_nobody_says_where_it_lies_turns_nothing() {
    let source = source(",LENGTH,120");
    for (on, whole, missing, key) in [
        ("head", ("point = [0, 0, 200]", ""), ("", ""), "`point = "),
        (
            "table",
            ("point = [0, 0, -50]", "work_zero = [0, 0, 0]"),
            ("", "work_zero = [0, 0, 0]"),
            "`point = ",
        ),
        (
            "table",
            ("point = [0, 0, -50]", "work_zero = [0, 0, 0]"),
            ("point = [0, 0, -50]", ""),
            "`work_zero = ",
        ),
    ] {
        let machine = mill(on, whole.0, whole.1);
        let output = written(&machine, &source).unwrap();
        proven(&machine, &source, &output.text).unwrap();
        let lacking = mill(on, missing.0, missing.1);
        for found in [
            written(&lacking, &source).unwrap_err(),
            proven(&lacking, &source, &output.text).unwrap_err(),
        ] {
            assert_eq!(found.rule, "kinematics", "{on}, {key}: {found}");
            assert!(found.help.contains(key) && found.line > 0, "{on}, {key}: {found}");
        }
    }
}

/// Where the control keeps the tip, it knows its axes itself; what Toolpost does not know of them, it does not check.
#[test]
fn travel_that_depends_on_it_is_reported_as_unchecked() {
    let unchecked = |machine: &Machine, source: &Program| {
        let text = written(machine, source).unwrap().text;
        let report = proof::prove(source, machine, "p", &text, &Default::default());
        assert!(report.proven, "{:?}", report.mismatches);
        report.travel.unsaid
    };
    let sample = root().join("machines/samples/five-axes.cls");
    let sample = std::fs::read(sample).unwrap();
    let sample = source::apt::read("five-axes.cls", &sample, &Default::default()).unwrap().program;
    let machine = machine::load("fanuc-table-bc").unwrap();
    assert_eq!(unchecked(&machine, &sample), [machine::Unsaid::AxisPoint('B')]);
    let table = mill("table", "point = [0, 0, 0]", "work_zero = [0, 0, 0]");
    assert_eq!(unchecked(&table, &source("")), [machine::Unsaid::ToolLength]);
    assert!(unchecked(&table, &source(",LENGTH,120")).is_empty());
}

/// The first mismatch of a proof of `text` for the sample of three axes.
fn rule_of(machine: &Machine, sample: &Program, text: &str) -> Option<&'static str> {
    let report = proof::prove(sample, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.first().map(|found| found.rule.name())
}

fn three_axes() -> Program {
    let sample = std::fs::read(root().join("machines/samples/three-axes.cls")).unwrap();
    source::apt::read("three-axes.cls", &sample, &Default::default()).unwrap().program
}

/// SINUMERIK W1 11/2006 p. 13: without a D behind M6 the edge is that of MD20270. A D before M6 is for the tool before.
#[test]
fn a_sinumerik_program_says_the_edge_behind_the_change() {
    let sample = three_axes();
    let machine = machine::load("generic-3axis-sinumerik").unwrap();
    let with = |line: &str| {
        let text = format!("extends = \"generic-3axis-sinumerik\"\n[settings]\n{line}\n");
        load_text("mill.toml", &text).unwrap()
    };
    let stated = [0, 1, 2].map(|edge| with(&format!("edge_at_change = {edge}")));
    let text = String::from_utf8(written(&machine, &sample).unwrap().text).unwrap();
    assert_eq!(text.matches(" M6\n").count(), text.matches(" D1\n").count(), "{text}");
    let unnumbered = |text: &str| -> Vec<String> {
        text.lines().map(|line| line.split_once(' ').unwrap().1.to_owned()).collect()
    };
    let before = text.replace(" T1\n", " T1 D1\n").replace(" T2\n", " T2 D1\n");
    let before: String = before
        .split_inclusive('\n')
        .filter(|line| !line.ends_with(" D1\n") || line.contains('T'))
        .collect();
    assert!(before.contains(" T1 D1\n") && !unnumbered(&before).contains(&"D1".into()), "{before}");
    let never = before.replace(" D1\n", "\n");
    for silent in [&before, &never] {
        assert_eq!(rule_of(&machine, &sample, silent), Some("tool-edge"));
        assert_eq!(rule_of(&stated[0], &sample, silent), Some("length-offset"));
        assert_eq!(rule_of(&stated[1], &sample, silent), None);
        assert_eq!(rule_of(&stated[2], &sample, silent), Some("length-offset"));
    }
    // In the block of M6 it is the new tool's.
    let within = never.replace(" M6\n", " M6 D1\n");
    assert_eq!(rule_of(&machine, &sample, &within), None);

    // A block for the change that says none: the next rapid says it, unless the machine does.
    let change = "[blocks]\ntool_change = \"\"\"\n{% if not place.home %}{{N}} G0 SUPA {{SAFE_HEIGHT}} D0{% endif %}\n{{N}} {{T}} M6\n\"\"\"\n";
    for (machine, says) in
        [(with(change), true), (with(&format!("edge_at_change = 1\n{change}")), false)]
    {
        let text = String::from_utf8(written(&machine, &sample).unwrap().text).unwrap();
        assert_eq!(text.contains(" D1 Z"), says, "{text}");
        assert_eq!(rule_of(&machine, &sample, &text), None);
    }
}

/// Mach3 General Config, "IJ Mode": whether I and J are places or count from the start of the arc is the operator's; so is "Distance
/// Mode". FANUC 3402, SINUMERIK MD20150, RS274NGC_STARTUP_CODE of LinuxCNC, `$N0` of GRBL: the builder's or the operator's.
#[test]
fn a_program_says_the_modes_that_are_set_up_at_the_machine() {
    let sample = three_axes();
    for (name, words) in [
        ("mach3-mill", &["G17", "G90", "G91.1", "G94"][..]),
        ("linuxcnc-mill", &["G17", "G90", "G91.1", "G94"]),
        ("generic-3axis-fanuc", &["G17", "G90", "G94"]),
        ("generic-3axis-grbl", &["G17", "G90", "G94"]),
        ("generic-3axis-sinumerik", &["G17", "G710", "G90", "G94"]),
    ] {
        let machine = machine::load(name).unwrap();
        let text = String::from_utf8(written(&machine, &sample).unwrap().text).unwrap();
        assert_eq!(rule_of(&machine, &sample, &text), None, "{name}");
        for word in words {
            // Everywhere, since a change of the tool may say it again.
            let lines = text.lines().map(|line| {
                let left: Vec<_> = line.split(' ').filter(|said| said != word).collect();
                left.join(" ") + "\n"
            });
            let silent: String = lines.collect();
            let found = rule_of(&machine, &sample, &silent);
            if *word == "G90" {
                // Behind `G91 G28` the moves are then increments, whatever holds at the start.
                assert!(found.is_some(), "{name}:\n{silent}");
                continue;
            }
            assert_eq!(found, Some("start-mode"), "{name} without {word}:\n{silent}");
            let mode = word.replace("G710", "G71");
            let file = format!("extends = \"{name}\"\n[settings]\nstart_modes = [\"{mode}\"]\n");
            let stated = load_text("stated.toml", &file).unwrap();
            assert_eq!(rule_of(&stated, &sample, &silent), None, "{name} states {word}");
        }
    }
}

/// SINUMERIK SD42940 = 0 as delivered, FANUC parameter 5001: a length counts along the axis that stands on the plane, and MD20150 and
/// 3402 say in which plane the control starts. A program of lines alone leans on it, and one that says G17 with its first arc has gone
/// down before that.
#[test]
fn a_tool_length_counts_from_where_the_plane_is_said() {
    let text = "UNITS/MM\nLOADTL/3\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,40\nRAPID\nGOTO/0,0,5\nGOTO/0,0,-2\nGOTO/50,0,-2\n\
                RAPID\nGOTO/50,0,40\nFINI\n";
    let lines = source::apt::read("job.apt", text.as_bytes(), &Default::default()).unwrap().program;
    for (name, leans) in [
        ("generic-3axis-sinumerik", true),
        ("generic-3axis-sinumerik-828d", true),
        ("generic-3axis-fanuc", true),
        ("generic-3axis-haas", false),
        ("generic-3axis-linuxcnc", false),
        ("generic-3axis-mach3", false),
    ] {
        let machine = machine::load(name).unwrap();
        let text = String::from_utf8(written(&machine, &lines).unwrap().text).unwrap();
        assert_eq!(rule_of(&machine, &lines, &text), None, "{name}");
        let silent = text.replace(" G17", "");
        assert_ne!(silent, text, "{name}");
        let expected = leans.then_some("start-mode");
        assert_eq!(rule_of(&machine, &lines, &silent), expected, "{name}:\n{silent}");
        if !leans {
            continue;
        }
        let late: String =
            silent
                .split_inclusive('\n')
                .map(|line| {
                    if line.contains(" X50") { line.replacen(' ', " G17 ", 1) } else { line.into() }
                })
                .collect();
        assert!(late.contains(" G17 "), "{late}");
        assert_eq!(rule_of(&machine, &lines, &late), expected, "{name}:\n{late}");
        let file = format!("extends = \"{name}\"\n[settings]\nlength_along_z = true\n");
        let stated = load_text("stated.toml", &file).unwrap();
        assert_eq!(rule_of(&stated, &lines, &silent), None, "{name}");
    }
}

/// FANUC 3402#6, 1202#3; Haas setting 56; Mach3 "Logic"; LinuxCNC parameter 5220; GRBL MDI; Marlin in machine space after power on: which
/// work offset is active before the program names one, no program sees.
#[test]
fn a_program_names_its_work_offset() {
    let sample = three_axes();
    for name in ["fanuc", "haas", "iso", "mach3", "linuxcnc", "grbl", "marlin"] {
        let name = format!("generic-3axis-{name}");
        let machine = machine::load(&name).unwrap();
        let text = String::from_utf8(written(&machine, &sample).unwrap().text).unwrap();
        assert_eq!(rule_of(&machine, &sample, &text), None, "{name}");
        let silent = text.replace(" G54", "").replace("G54\n", "");
        assert_ne!(silent, text, "{name}");
        assert_eq!(rule_of(&machine, &sample, &silent), Some("work-offset"), "{name}");
        let file = format!("extends = \"{name}\"\n[settings]\nstart_modes = [\"G54\"]\n");
        let stated = load_text("stated.toml", &file).unwrap();
        assert_eq!(rule_of(&stated, &sample, &silent), None, "{name}");
    }
}

/// Marlin 2.1.2: `G28` takes the work offset of its axes away, and `G54` said again does not bring it back.
#[test]
fn behind_the_switches_of_a_marlin_a_move_by_g53_brings_the_work_offset_back() {
    let sample = three_axes();
    let machine = machine::load("generic-3axis-marlin").unwrap();
    let text = String::from_utf8(written(&machine, &sample).unwrap().text).unwrap();
    let retract = "G53 G0 Z200 F10000\n";
    let (head, rest) = text.split_once(retract).unwrap_or_else(|| panic!("{text}"));
    let with = |behind: &str| {
        let text = format!("{head}{retract}{behind}{rest}");
        rule_of(&machine, &sample, &text)
    };
    assert_eq!(with(""), None);
    assert_eq!(with("G28 X Y\n"), Some("work-offset"));
    assert_eq!(with("G28 X Y\nG54\n"), Some("work-offset"));
    assert_eq!(with(&format!("G28 X Y\n{retract}")), None);
    // Without the first move by G53 it may be away since the operator has homed the machine.
    assert_eq!(rule_of(&machine, &sample, &format!("{head}{rest}")), Some("work-offset"));
}
