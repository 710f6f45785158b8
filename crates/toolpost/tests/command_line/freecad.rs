//! Jobs of FreeCAD as the source.

use crate::folder::{Folder, Said};
use std::fs;
use std::process::Command;

const EXAMPLE: &str = include_str!("../../../../examples/bracket.json");

const MILL: [&str; 2] = ["-m", "emco-concept-mill-105"];

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("bracket.json", EXAMPLE);
    folder
}

fn post(folder: &Folder, source: &str, more: &[&str]) -> Said {
    folder.run(&[&["post", source, "-o", "out.mpf"], more].concat())
}

#[test]
fn the_example_is_posted_and_proven_and_its_operations_are_named() {
    let folder = folder();
    let said = post(&folder, "bracket.json", &MILL);
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    assert!(said.out.contains("bracket.json (FreeCAD job)"), "{said:?}");
    assert!(said.out.contains("Profile, Bore, Drilling"), "{said:?}");
    let text = folder.read("out.mpf");
    // Four holes of one cycle: from Z2 down to Z-8 in pecks of 2.5 mm.
    assert!(text.contains("MCALL CYCLE83(2,2,0,-8,,,2.5,0,0,0,1,1)\n"), "{text}");
    assert_eq!(text.matches("MCALL CYCLE83").count(), 1);
    let report: serde_json::Value =
        serde_json::from_str(&folder.read("out.mpf.report.json")).unwrap();
    let labels = report["source"]["operations"].as_array().unwrap().iter();
    let labels: Vec<_> = labels.map(|operation| operation["label"].as_str().unwrap()).collect();
    assert_eq!(labels, ["G54", "Mill 6", "Profile", "Bore", "Drill 5", "Drilling"]);
    let prove = [&["prove", "out.mpf", "--against", "bracket.json"], &MILL[..]].concat();
    assert_eq!(folder.run(&prove).code, 0);
    assert!(folder.run(&["show", "bracket.json"]).out.contains("Profile, Bore, Drilling"));
}

#[test]
fn the_example_is_posted_and_proven_on_robots_of_each_language() {
    let folder = folder();
    let robots = [
        ("kuka-kr6-r900", "HALT"),
        ("universal-ur5e", "popup("),
        ("fanuc-lrmate-200id-mill", "PAUSE ;"),
        ("abb-irb120-mill", "Stop;"),
    ];
    for (robot, stop) in robots {
        let said = folder.run(&["post", "bracket.json", "-o", "out.prog", "-m", robot]);
        assert_eq!(said.code, 0, "{said:?}");
        // It mills and drills: both tools are put in by hand, and nobody has to ask for that.
        assert!(said.err.contains("tool-by-hand"), "{said:?}");
        assert_eq!(folder.read("out.prog").matches(stop).count(), 2, "{robot}");
        let prove = ["prove", "out.prog", "--against", "bracket.json", "-m", robot];
        assert_eq!(folder.run(&prove).code, 0, "{robot}");
    }
}

/// A helix is written as chords: the tool that leans at one of their ends is not the source's.
#[test]
fn a_tool_that_leans_within_a_helix_of_a_robot_is_refused() {
    let folder = folder();
    let robot = "kuka-kr6-r900";
    assert_eq!(folder.run(&["post", "bracket.json", "-o", "out.src", "-m", robot]).code, 0);
    let (good, text) = ("Z -0.250,A 0.0000,B 0.0000,C 180.0000", folder.read("out.src"));
    assert!(text.contains(good));
    for bad in ["Z -0.250,A 0.0000,B 0.0000,C 178.0000", "Z -0.250,A 0.0000,B 1.0000,C 180.0000"] {
        folder.write("out.src", text.replacen(good, bad, 1));
        let prove = ["prove", "out.src", "--against", "bracket.json", "-m", robot];
        let said = folder.run(&prove);
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains("off that of the source on the arc"), "{said:?}");
    }
}

/// The second `G1` of the profile goes to X-3 Y32.
#[test]
fn a_proof_that_fails_names_operation_and_command() {
    let folder = folder();
    assert_eq!(post(&folder, "bracket.json", &MILL).code, 0);
    folder.write("out.mpf", folder.read("out.mpf").replacen("Y32", "Y31", 1));
    let prove = [&["prove", "out.mpf", "--against", "bracket.json"], &MILL[..]].concat();
    let said = folder.run(&prove);
    let place = "bracket.json: operation `Profile`:6  G1 F10.000000 X-3.000000 Y32.000000";
    assert!(said.code == 1 && said.out.contains(place), "{said:?}");
}

#[test]
fn what_the_machine_cannot_do_names_operation_and_command() {
    let folder = folder();
    folder.write("bracket.json", EXAMPLE.replace("S4500.000000", "S9000.000000"));
    let said = post(&folder, "bracket.json", &MILL);
    let place = "bracket.json: operation `Mill 6`:3: error[spindle-range]";
    assert!(said.code == 1 && said.err.contains(place), "{said:?}");
    assert_eq!(folder.names(), ["bracket.json", "part.cls"]);
}

#[test]
fn options_of_the_machine_file_take_another_value() {
    let folder = folder();
    let set = ["-m", "emco-concept-mill-105-emco-post"];
    let time = ["--option", "time=21.11.2026 12:00:00"];
    assert_eq!(post(&folder, "bracket.json", &[&set[..], &time].concat()).code, 0);
    assert!(folder.read("out.mpf").contains("N20 ;Cas exportu: 21.11.2026 12:00:00\n"));
    let said = post(&folder, "bracket.json", &[&set[..], &["--option", "tim=1"]].concat());
    assert!(said.code == 2 && said.err.contains("its options are blank, default_tool"), "{said:?}");
    let said = post(&folder, "bracket.json", &[&set[..], &["--option", "default_tool=a"]].concat());
    assert!(said.code == 2 && said.err.contains("is a number, not `a`"), "{said:?}");
}

/// Posts `part.FCStd` where `freecadcmd` is this script, or nothing.
#[cfg(unix)]
fn post_document(folder: &Folder, freecad: Option<&str>) -> Said {
    use std::os::unix::fs::PermissionsExt;
    folder.write("part.FCStd", "a document\n");
    let programs = folder.path().join("programs");
    fs::create_dir_all(&programs).unwrap();
    if let Some(script) = freecad {
        let path = programs.join("freecadcmd");
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let output = Command::new(env!("CARGO_BIN_EXE_toolpost"))
        .args(["post", "part.FCStd", "-o", "out.mpf", MILL[0], MILL[1]])
        .current_dir(folder.path())
        .env("PATH", &programs)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Said { code: output.status.code().unwrap(), out: text(output.stdout), err: text(output.stderr) }
}

#[cfg(unix)]
#[test]
fn a_document_is_read_by_the_freecad_that_is_installed() {
    let folder = folder();
    let example = folder.path().join("bracket.json");
    // What is asked of FreeCAD: to run our script on the document, and to write the job where we say.
    let script = format!(
        "test -f \"$1\" && read -r content < \"$TOOLPOST_FCSTD\"\n\
         test \"$content\" = 'a document' && /bin/cp '{}' \"$TOOLPOST_JSON\"",
        example.display()
    );
    let said = post_document(&folder, Some(&script));
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("part.FCStd (FreeCAD job)"), "{said:?}");
}

#[cfg(unix)]
#[test]
fn without_freecad_or_a_job_a_document_is_refused() {
    let folder = folder();
    let said = post_document(&folder, None);
    assert!(said.code == 2 && said.err.contains("there is no freecadcmd"), "{said:?}");
    let said = post_document(&folder, Some("echo the document has no job"));
    assert!(said.code == 2 && said.err.contains("the document has no job"), "{said:?}");
    assert_eq!(folder.names(), ["bracket.json", "part.FCStd", "part.cls", "programs"]);
}
