//! Outputs, inputs and functions of the machine's builder: from a program into one of another machine.

use control::Setup;
use machine::Machine;
use program::{Diagnostic, Purpose};
use std::process::{Command, Stdio};

/// A program for LinuxCNC with everything that switches.
const SWITCHING: &str = "G21 G90 G94 G17 G40 G54\nT1 M6\nS1000 M3\nG0 X0 Y0\nG43 H1 Z5\nM64 P1\nG1 Z-1 F100\nM62 P2\n\
    X10\nM63 P2\nM66 P3 L3 Q5\nY10\nM67 E1 Q2.5\nX0\nM68 E0 Q-0.5\nM66 P3\nM66 E1\nM101 P2 Q-3.5\nM101\nY0\nM65 P1\n\
    G0 Z5\nM2\n";

fn machine(text: &str) -> Machine {
    machine::load_text("mine.toml", text).unwrap()
}

fn linuxcnc() -> Machine {
    machine("extends = \"generic-3axis-linuxcnc\"\nauxiliary = [101]\n")
}

/// The program of `text` of `from`, for `to`, proven.
fn rewritten(from: &Machine, text: &str, to: &Machine) -> Result<String, Vec<Diagnostic>> {
    let reading = nc::read(from, Setup::default(), "old", text.as_bytes()).unwrap();
    let output = post::write(&reading.program, to)?;
    let report = proof::prove(&reading.program, to, "new", &output.text, &Default::default());
    assert!(report.proven, "{:?}\n{}", report.mismatches, String::from_utf8_lossy(&output.text));
    Ok(String::from_utf8(output.text).unwrap())
}

/// The blocks of a program that switch something or cut.
fn switching(text: &str) -> Vec<&str> {
    let after_tool = text.lines().skip_while(|block| !block.starts_with("G43"));
    let is = |block: &&str| {
        ["M62", "M63", "M64", "M65", "M66", "M67", "M68", "M101"]
            .iter()
            .any(|m| block.starts_with(m))
    };
    after_tool.filter(is).collect()
}

#[test]
fn linuxcnc_says_again_what_it_has_been_sent() {
    let text = rewritten(&linuxcnc(), SWITCHING, &linuxcnc()).unwrap();
    let own = [
        "M64 P1",
        "M62 P2",
        "M63 P2",
        "M66 P3 L3 Q5",
        "M67 E1 Q2.5",
        "M68 E0 Q-0.5",
        "M66 P3 L0",
        "M66 E1 L0",
        "M101 P2 Q-3.5",
        "M101",
        "M65 P1",
    ];
    assert_eq!(switching(&text), own);
    let at = |block: &str| text.lines().position(|line| line == block).unwrap();
    assert!(at("M64 P1") < at("G1 Z-1 F100") && at("G1 Z-1 F100") < at("M62 P2"), "{text}");
}

/// LinuxCNC's own interpreter makes of the new program what it makes of the old one.
#[test]
fn linuxcnc_itself_switches_as_in_the_source() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    // Its interpreter runs no programs of the user's.
    let source = SWITCHING.replace("M101 P2 Q-3.5\nM101\n", "");
    let text = rewritten(&linuxcnc(), &source, &linuxcnc()).unwrap();
    let (old, new) = (canonical(&source), canonical(&text));
    assert_eq!(old.len(), 6 + 5, "{old:?}");
    assert_eq!(old, new);
}

/// Outputs and cuts that `rs274` makes of a program.
fn canonical(text: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("program.ngc", text);
    write("tool.tbl", "T1 P1 Z0 D6\n");
    write("rs274.var", "");
    let said = Command::new("rs274")
        .args(["-t", "tool.tbl", "-v", "rs274.var", "-g", "program.ngc"])
        .current_dir(folder.path())
        .env("HOME", folder.path())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let said = String::from_utf8(said.stdout).unwrap();
    let calls = said.lines().filter_map(|line| line.split_once("..... ")).map(|(_, call)| call);
    let counts = ["STRAIGHT_FEED", "OUTPUT_BIT", "OUTPUT_VALUE"];
    calls.filter(|call| counts.iter().any(|word| call.contains(word))).map(String::from).collect()
}

#[test]
fn a_control_without_words_for_it_refuses_with_the_line() {
    let found = rewritten(&linuxcnc(), SWITCHING, &machine("extends = \"generic-3axis-fanuc\"\n"));
    let found = found.unwrap_err();
    let lines: Vec<u32> = found.iter().map(|found| found.line).collect();
    assert_eq!(lines[..4], [6, 8, 10, 11], "{found:?}");
    assert!(found.iter().all(|found| !found.help.is_empty()), "{found:?}");
}

#[test]
fn a_function_of_the_builder_is_written_where_the_machine_file_has_it() {
    let fanuc = |more: &str| machine(&format!("extends = \"generic-3axis-fanuc\"\n{more}"));
    let has = fanuc("auxiliary = [21, 22]\n");
    let text = "G21 G90 G94 G17 G54\nT1 M6\nS900 M3\nG0 X0. Y0.\nG43 H1 Z5.\nM21\nG1 Z-1. F90.\nM22\nX9.\nG0 Z5.\nM30\n";
    let new = rewritten(&has, text, &has).unwrap();
    let blocks: Vec<&str> =
        new.lines().map(|block| block.split_once(' ').map_or("", |(_, b)| b)).collect();
    let at = |wanted: &str| blocks.iter().position(|block| *block == wanted).unwrap();
    assert!(
        at("M21") < at("G1 Z-1. F90.") && at("G1 Z-1. F90.") < at("M22") && at("M22") < at("X9."),
        "{new}"
    );

    let found = rewritten(&has, text, &fanuc("")).unwrap_err();
    assert_eq!(
        found.iter().map(|found| (found.rule.name(), found.line)).collect::<Vec<_>>(),
        [("auxiliary", 6), ("auxiliary", 8)]
    );
    // As the help says: an empty block leaves them out, with a warning.
    let without = fanuc("[blocks]\nauxiliary = \"\"\n");
    let reading = nc::read(&has, Setup::default(), "old", text.as_bytes()).unwrap();
    let output = post::write(&reading.program, &without).unwrap();
    let warned: Vec<_> =
        output.warnings.iter().filter(|found| found.rule.name() == "auxiliary").collect();
    assert_eq!(warned.len(), 2, "{:?}", output.warnings);
    assert!(rewritten(&has, text, &without).is_ok());
    // A control that hands no values over refuses them.
    let calls = SWITCHING
        .replace("M101\n", "")
        .lines()
        .filter(|b| !b.starts_with("M6"))
        .collect::<Vec<_>>()
        .join("\n");
    let found = rewritten(&linuxcnc(), &calls, &fanuc("auxiliary = [101]\n")).unwrap_err();
    assert!(found.iter().any(|found| found.rule.name() == "auxiliary"), "{found:?}");
}

#[test]
fn every_control_of_mills_has_a_word_for_functions_of_the_builder() {
    let source = "PARTNO/T\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,900,CLW\nRAPID\nGOTO/0,0,5\nFEDRAT/MMPM,90\nAUXFUN/61\nGOTO/0,0,-1\n\
        AUXFUN/62\nGOTO/9,0,-1\nRAPID\nGOTO/9,0,5\nFINI\n";
    let reading = source::apt::read("t.apt", source.as_bytes(), &Default::default()).unwrap();
    for name in [
        "fanuc",
        "haas",
        "sinumerik",
        "sinumerik-828d",
        "heidenhain",
        "linuxcnc",
        "mach3",
        "grbl",
        "marlin",
    ] {
        let to = machine(&format!("extends = \"generic-3axis-{name}\"\nauxiliary = [61, 62]\n"));
        // M61 and M62 are LinuxCNC's own.
        let output = post::write(&reading.program, &to).unwrap();
        let text = String::from_utf8(output.text).unwrap();
        let report =
            proof::prove(&reading.program, &to, "new", text.as_bytes(), &Default::default());
        assert_eq!(report.proven, name != "linuxcnc", "{name}: {:?}\n{text}", report.mismatches);
    }
}

/// The numbers of the M functions of the builder that a program calls, in order.
fn called(program: &program::Program) -> Vec<u32> {
    let calls = program.records.iter().filter_map(|record| match &record.op {
        program::Op::Auxiliary(function) => Some(function.number),
        _ => None,
    });
    calls.collect()
}

const MILLS: [&str; 9] =
    ["fanuc", "haas", "iso", "linuxcnc", "mach3", "grbl", "marlin", "sinumerik", "heidenhain"];

/// Before the first tool, between two cuts, in a cycle, with a move and behind the last one.
#[test]
fn functions_of_the_builder_go_from_each_control_to_each_other() {
    let list = "auxiliary = [10, 11, 162]\n";
    let mine = |name: &str| machine(&format!("extends = \"generic-3axis-{name}\"\n{list}"));
    let text = "G21 G90 G94 G17 G54\nM10\nT1 M6\nS900 M3\nM162\nG0 X0. Y0.\nG43 H1 Z5.\nM10\nG1 Z-1. F90.\nM11\n\
                X10. M162\nG0 Z5.\nG81 G98 X1. Y1. Z-3. R2. F90.\nM10\nX5.\nG80\nM11\nG0 Z5.\nM162\nM30\n";
    let numbers = [10, 162, 10, 11, 162, 10, 11, 162];
    for name in MILLS {
        let to = mine(name);
        let new = rewritten(&mine("fanuc"), text, &to).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        let back = nc::read(&to, Setup::default(), "new", new.as_bytes()).unwrap().program;
        assert_eq!(called(&back), numbers, "{name}:\n{new}");
    }
}

#[test]
fn functions_of_the_builder_in_operations_of_freecad_are_written_or_refused() {
    let cut = "G0 Z20.0\nG0 X1.0 Y2.0\nG1 F2.0 X1.0 Y2.0 Z0.0\nG1 F2.0 X5.0\nM11\nG1 F2.0 X9.0\nG0 Z20.0\n";
    let operation =
        |label: &str, commands: &str| serde_json::json!({ "label": label, "commands": commands });
    let job = serde_json::json!({
        "toolpost": "freecad-job", "version": 1, "name": "part",
        "tools": [{ "number": 1, "name": "Mill", "diameter": 5.0 }],
        "operations": [
            operation("First", "M10\n"),
            operation("Mill", "M6 T1.000000\nM3 S2000.000000\n"),
            operation("Custom", "(Custom)\nM162\n"),
            operation("Profile", cut),
            operation("Last", "M10\n"),
        ],
    });
    let job = freecad::Job::of("part.json", job.to_string().as_bytes()).unwrap();
    for name in MILLS {
        let text = format!("extends = \"generic-3axis-{name}\"\nauxiliary = [10, 11, 162]\n");
        let to = machine(&text);
        let program =
            freecad::read(&to, "part.json", job.clone(), Purpose::Program).unwrap().program;
        assert_eq!(called(&program), [10, 162, 11, 10], "{name}");
        let output = post::write(&program, &to).unwrap();
        let report = proof::prove(&program, &to, "new", &output.text, &Default::default());
        assert!(report.proven, "{name}: {:?}", report.mismatches);
        let without = machine(&format!("extends = \"generic-3axis-{name}\"\n"));
        let found =
            freecad::read(&without, "part.json", job.clone(), Purpose::Program).unwrap_err();
        assert!(
            found.message.contains("M10") && found.help.contains("auxiliary"),
            "{name}: {found}"
        );
    }
}

#[test]
fn a_function_that_does_nothing_on_the_control_itself_is_the_builders_where_the_file_lists_it() {
    for (name, number) in
        [("fanuc", 48), ("linuxcnc", 48), ("marlin", 17), ("sinumerik", 41), ("heidenhain", 90)]
    {
        let own = machine(&format!("extends = \"generic-3axis-{name}\"\n"));
        let listed =
            machine(&format!("extends = \"generic-3axis-{name}\"\nauxiliary = [{number}]\n"));
        let text = match name {
            "heidenhain" => format!("0 BEGIN PGM A MM\n1 M{number}\n2 END PGM A MM\n"),
            "marlin" => format!("M{number}\n"),
            _ => format!("M{number}\nM30\n"),
        };
        let calls = |machine: &Machine| {
            called(&nc::read(machine, Setup::default(), "old", text.as_bytes()).unwrap().program)
        };
        assert_eq!((calls(&own), calls(&listed)), (vec![], vec![number]), "{name}");
    }
}

#[test]
fn the_contour_of_a_wire_leaves_them_out_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("mine.toml", "extends = \"generic-3axis-fanuc\"\nauxiliary = [21]\n");
    let cut = "G1 X20. F9.\nM21\nY20.\nM21\nX0.\nY0.\nM30\n";
    write("part.nc", &format!("G21 G90 G94 G17 G54\nG0 X0. Y0. Z0.\n{cut}"));
    let run = |more: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_toolpost"))
            .args(["wire", "part.nc", "--from", "mine.toml", "-m", "fanuc-wire", "-o", "part.iso"])
            .args(more)
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    let done = run(&[]);
    let said = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success(), "{said}");
    assert!(
        said.contains("part.nc:4: warning[auxiliary]: M21 of the source is left out"),
        "{said}"
    );
    assert!(said.contains("(2 times, first here)"), "{said}");
    assert!(!run(&["--strict"]).status.success());
}
