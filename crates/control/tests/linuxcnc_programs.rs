//! All NC programs that LinuxCNC's Debian package brings along, run through its own interpreter
//! (`rs274 -g`) and through ours: the same moves, program by program.

mod linuxcnc_common;

use linuxcnc_common::difference;
use std::fs;
use std::path::{Path, PathBuf};

/// Where the programs are.
const PLACES: [&str; 3] =
    ["/usr/share/linuxcnc/ncfiles", "/usr/share/doc/linuxcnc/examples", "/usr/share/axis"];

/// Where called programs are looked for beside the folder of the program.
const LIBRARIES: [&str; 5] = [
    "ngcgui_lib",
    "ngcgui_lib/utilitysubs",
    "macros/mill",
    "remap-subroutines",
    "remap_lib/common_nc_subs",
];

/// What both controls have been told: a unit, and to which level cycles return.
const BEFORE: &str = "G21 G98\n";

/// The programs, sorted.
fn programs() -> Vec<PathBuf> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        let Ok(entries) = fs::read_dir(folder) else { return };
        for path in entries.flatten().map(|entry| entry.path()) {
            // Links lead to programs that are found where they are.
            if path.is_symlink() {
                continue;
            }
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "ngc") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    PLACES.iter().for_each(|place| walk(Path::new(place), &mut found));
    found.sort();
    found
}

fn folders(program: &Path) -> Vec<PathBuf> {
    let own = program.parent().unwrap();
    let near = ["", "../nc_subroutines", "../remap_subs"].map(|name| own.join(name));
    let libraries = LIBRARIES.iter().map(|name| Path::new(PLACES[0]).join(name));
    near.into_iter().chain(libraries).filter(|folder| folder.is_dir()).collect()
}

/// How a program differs; none where it does not.
fn difference_of(path: &Path) -> Option<Option<String>> {
    let text = fs::read(path).unwrap();
    // The set-up stands behind a leading `%`.
    let behind = match text.first() {
        Some(b'%') => text.iter().position(|&b| b == b'\n').map_or(text.len(), |n| n + 1),
        _ => 0,
    };
    let text = [&text[..behind], BEFORE.as_bytes(), &text[behind..]].concat();
    difference(&text, &folders(path))
}

/// The programs that differ, by the end of their path, and why (`docs/controls/linuxcnc.md`).
const DIFFER: &[(&str, &str)] = &[
    ("craftsman/macros/m106.ngc", "an endsub of another name, in a subroutine that is not called"),
    ("ncfiles/lathe_g70_71_demo.ngc", "lathe cycles are refused"),
    ("ncfiles/lathe_g7x_face_boring.ngc", "lathe cycles are refused"),
    ("ncfiles/lathe_g7x_quadrants.ngc", "lathe cycles are refused"),
    ("ncfiles/plasmatest.ngc", "an arc after M6, which may move the machine"),
    ("ncfiles/smartprobe.ngc", "it steers by what the probe finds"),
    ("ncfiles/x-trim.ngc", "it counts from where the probe stops"),
    (
        "ncfiles/gmoccapy_2_tools_with_cutter_radius_compensation.ngc",
        "a move in X and Y after M6 and G43, where Z is not known",
    ),
    ("ncfiles/mmount.ngc", "G33.1 is told as the moves of a thread, by rs274 as one call"),
    ("ncfiles/systems.ngc", "splines: other points of the same curve"),
    (
        "manual-toolchange-with-tool-length-switch/nc_files/tcdemo.ngc",
        "splines: other points of the same curve",
    ),
];

#[test]
fn every_program_of_linuxcnc_makes_the_same_moves_or_stands_in_the_list() {
    let programs = programs();
    let reason = |path: &Path| DIFFER.iter().find(|(end, _)| path.ends_with(end));
    let mut unexpected = String::new();
    for path in &programs {
        let Some(difference) = difference_of(path) else { return };
        match (difference, reason(path)) {
            (Some(_), Some(_)) | (None, None) => {}
            (Some(difference), None) => {
                unexpected += &format!("### {}\n{difference}\n", path.display());
            }
            (None, Some((end, _))) => unexpected += &format!("### {end} agrees now\n"),
        }
    }
    println!("{} of {} programs agree", programs.len() - DIFFER.len(), programs.len());
    assert!(unexpected.is_empty(), "{unexpected}");
}
