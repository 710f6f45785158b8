//! NC programs as the source.

use crate::folder::Folder;
use std::time::{Duration, Instant};

/// The outside of a square of 40 mm, with the tool on its left.
const SQUARE: &str = "\
%
O0012 (SQUARE)
G21 G90 G17 G40 G49 G80 G54
T1 M6
S3000 M3
G0 X-10. Y-20.
G43 Z5. H1
G1 Z-1. F100.
G41 D1 X0. Y-10. F400.
Y40.
X40.
Y0.
X-10.
G40 X-20. Y-10.
G0 Z50.
M30
%
";

const FANUC: [&str; 2] = ["--from", "fanuc-31i"];

fn post(folder: &Folder, more: &[&str]) -> crate::folder::Said {
    folder.run(&[&["post", "old.nc"], &FANUC[..], more].concat())
}

#[test]
fn an_old_program_becomes_one_of_another_control_and_is_proven_again_against_it() {
    let folder = Folder::new();
    folder.write("old.nc", SQUARE);
    let target = ["-m", "generic-3axis-heidenhain", "-o", "new.h"];
    let said = post(&folder, &target);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("old.nc (FANUC 31i)"), "{said:?}");
    let new = folder.read("new.h");
    for block in ["L X+0 Y-10 RL F400", "L Y+40 RL", "L X-20 Y-10 R0"] {
        assert!(new.contains(block), "{block}: {new}");
    }
    let against = ["--against", "old.nc", "--from", "fanuc-31i"];
    let prove = [&["prove", "new.h", "-m", "generic-3axis-heidenhain"], &against[..]].concat();
    assert_eq!(folder.run(&prove).code, 0);
    folder.write("new.h", new.replace("Y+40 RL", "Y+41 RL"));
    assert_eq!(folder.run(&prove).code, 1);
}

#[test]
fn with_the_tool_table_compensation_becomes_the_path_of_the_centre() {
    let folder = Folder::new();
    folder.write("old.nc", SQUARE);
    folder.write("tools.tbl", "T1 P1 Z80 D10 ;MILL\n");
    let target = ["-m", "generic-3axis-grbl", "-o", "new.gcode"];
    // Without it a control that has no compensation cannot make it.
    let said = post(&folder, &target);
    assert!(said.code == 2 && said.err.contains("--tools"), "{said:?}");
    let said = post(&folder, &[&["--tools", "tools.tbl"], &target[..]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    let new = folder.read("new.gcode");
    // 5 mm off the square, at its corners too.
    assert!(new.contains("X-5 Y-10 F400\nY45\nX45\nY-5\nX-10\nX-20 Y-10\n"), "{new}");
    let said = post(&folder, &[&["--tools", "nowhere.tbl"], &target[..]].concat());
    assert!(said.code == 2 && said.err.contains("nowhere.tbl"), "{said:?}");
    folder.write("tools.tbl", "T1 D10\nT1 D12\n");
    let said = post(&folder, &[&["--tools", "tools.tbl"], &target[..]].concat());
    assert!(said.code == 2 && said.err.contains("tools.tbl:2:"), "{said:?}");
}

#[test]
fn an_nc_program_without_its_control_is_refused_with_the_way_to_name_it() {
    let folder = Folder::new();
    folder.write("old.nc", SQUARE);
    let said = folder.run(&["show", "old.nc"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("--from") && said.err.contains("fanuc-31i"), "{said:?}");
    assert!(said.err.lines().count() <= 3, "{said:?}");
    let said = folder.run(&["show", "old.nc", "--from", "nonesuch"]);
    assert!(said.code == 2 && said.err.contains("fanuc-31i"), "{said:?}");
    let said = folder.run(&["show", "part.cls", "--units", "mm"]);
    assert_eq!(said.code, 2);
}

#[test]
fn what_the_operator_knows_is_asked_for_and_not_guessed() {
    let folder = Folder::new();
    let show = |more: &[&str]| folder.run(&[&["show", "old.nc"], &FANUC[..], more].concat());
    folder.write("old.nc", "G90 G54\nG0 X10. Y0. Z5.\nG1 X20 F100\nM30\n");
    assert!(show(&[]).err.contains("units"));
    let units = ["--units", "mm"];
    assert!(show(&units).err.contains("old.nc:3:"), "{:?}", show(&units));
    let all = [&units[..], &["--whole-numbers", "increments", "--json"]].concat();
    let measures = show(&all).json();
    assert_eq!(measures["source"]["measures"]["cutting_length"], 9.98);
    let all = [&units[..], &["--whole-numbers", "units", "--json"]].concat();
    assert_eq!(show(&all).json()["source"]["measures"]["cutting_length"], 10.0);
    // A cut from where the tool stands.
    folder.write("old.nc", "G21 G90 G54\nG1 X20. F100.\nM30\n");
    assert!(show(&[]).err.contains("start"));
    let said = show(&["--start", "0,0,0", "--json"]);
    assert_eq!(said.json()["source"]["measures"]["cutting_length"], 20.0, "{said:?}");
    assert_eq!(show(&["--start", "0,0"]).code, 2);
}

/// Refused with the line, in a bounded time, and nothing written.
fn refused(from: &str, text: &str, line: u32, says: &str) {
    let folder = Folder::new();
    folder.write("old.ngc", text);
    let begun = Instant::now();
    let target = ["-m", "generic-3axis-grbl", "-o", "new.gcode"];
    let said =
        folder.run(&[&["post", "old.ngc", "--from", from, "--folder", "."], &target[..]].concat());
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.err.contains(&format!("old.ngc:{line}:")), "{said:?}");
    assert!(said.err.contains(says), "{says}: {said:?}");
    assert!(!folder.path().join("new.gcode").exists());
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
}

#[test]
fn programs_that_never_end_or_call_what_is_not_there_are_refused() {
    let start = "G21 G90 G54 G0 X0 Y0 Z5\n";
    refused("linuxcnc", &format!("{start}o1 while [1]\n#1=2\no1 endwhile\nM2\n"), 4, "never ends");
    refused("linuxcnc", &format!("{start}o1 sub\no1 call\no1 endsub\no1 call\nM2\n"), 3, "deep");
    refused("linuxcnc", &format!("{start}o<gone> call\nM2\n"), 2, "gone.ngc");
    refused("linuxcnc", &format!("{start}o<../gone> call\nM2\n"), 2, "folder");
    refused("fanuc-31i", "G21 G90 G54\nWHILE[1EQ1]DO1\nEND1\nM30\n", 3, "never ends");
    refused("fanuc-31i", "G21 G90 G54\nM98 P7\nM30\n", 2, "O0007");
    refused("sinumerik-840d", "G0 G90 G54 X0 Y0 Z5\nLOOP\nENDLOOP\nM30\n", 3, "never ends");
    refused("sinumerik-840d", "G0 G90 G54\nGONE(1)\nM30\n", 2, "GONE");
}

#[test]
fn a_line_of_ten_megabytes_is_refused_quickly() {
    let long = "G1 X1 ".repeat((10 << 20) / 6);
    for from in ["linuxcnc", "fanuc-31i", "sinumerik-840d", "grbl", "heidenhain-tnc640"] {
        let line = if from == "heidenhain-tnc640" { 1 } else { 2 };
        refused(from, &format!("G54\n{long}\nM2\n"), line, "error");
    }
}
