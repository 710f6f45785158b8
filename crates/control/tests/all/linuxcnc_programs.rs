//! All NC programs that LinuxCNC's Debian package brings along, run through its own interpreter
//! (`rs274 -g`) and through ours: the same moves, program by program.

use crate::common::linuxcnc::difference;
use std::fs;
use std::path::{Path, PathBuf};

/// Where the programs are.
const PLACES: [&str; 3] =
    ["/usr/share/linuxcnc/ncfiles", "/usr/share/doc/linuxcnc/examples", "/usr/share/axis"];

/// Where called programs are looked for in addition to the folder of the program.
const LIBRARIES: [&str; 5] = [
    "ngcgui_lib",
    "ngcgui_lib/utilitysubs",
    "macros/mill",
    "remap-subroutines",
    "remap_lib/common_nc_subs",
];

/// What both controls have been sent: a unit, and to which level cycles return.
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
    difference(&text, [true; 3], &folders(path))
}

/// The programs that differ, by the end of their path, and why (`docs/controls/linuxcnc.md`).
const DIFFER: &[(&str, &str)] = &[
    ("craftsman/macros/m106.ngc", "an endsub of another name, in a subroutine that is not called"),
    ("db_demo/base.ngc", "it asks `#<_task>`: at the machine it goes where a preview does not"),
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
    ("ncfiles/systems.ngc", "splines: other points of the same curve"),
    (
        "manual-toolchange-with-tool-length-switch/nc_files/tcdemo.ngc",
        "splines: other points of the same curve",
    ),
];

#[test]
fn every_program_of_linuxcnc_makes_the_same_moves_or_stands_in_the_list() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let programs = programs();
    assert!(programs.len() > 100, "{} programs in {PLACES:?}", programs.len());
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

/// Folders of subroutines for `ngcgui`, which names the arguments in comments: `#<depth> = #4 (=0.5 depth)`.
const SUBROUTINES: [&str; 3] = ["ngcgui_lib", "ngcgui_lib/lathe", "ngcgui_lib/utilitysubs"];

/// Those that differ: the diameter of the tool (`#5410`), which counts in the unit of the machine, is
/// refused.
const SUBROUTINES_DIFFER: [&str; 9] =
    ["arc1", "arc2", "db25", "helix", "helix_rtheta", "ihex", "ohex", "qpex_mm", "slot"];

/// The arguments that a subroutine suggests, 1 where it suggests none.
fn arguments(text: &str) -> Vec<String> {
    let mut arguments = Vec::new();
    for line in text.lines() {
        let Some((_, behind)) = line.split_once('=') else { continue };
        let Some(behind) = behind.trim_start().strip_prefix('#') else { continue };
        let digits = behind.len() - behind.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let Ok(number @ 1..=30) = behind[..digits].parse::<usize>() else { continue };
        let comment = behind[digits..].trim_start().strip_prefix("(=").unwrap_or_default();
        let value = comment.split([' ', ')', ',']).next().unwrap_or_default();
        let value = if value.parse::<f64>().is_ok() { value } else { "1" };
        arguments.resize(arguments.len().max(number), "1".to_owned());
        value.clone_into(&mut arguments[number - 1]);
    }
    arguments
}

#[test]
fn every_subroutine_of_ngcgui_makes_the_same_moves_with_the_arguments_it_suggests() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let mut unexpected = String::new();
    for folder in SUBROUTINES.map(|name| Path::new(PLACES[0]).join(name)) {
        let entries = fs::read_dir(&folder).expect("linuxcnc-uspace brings it");
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths.iter().filter(|path| path.extension().is_some_and(|e| e == "ngc")) {
            let name = path.file_stem().unwrap().to_str().unwrap();
            if SUBROUTINES_DIFFER.contains(&name) {
                continue;
            }
            let arguments = arguments(&String::from_utf8_lossy(&fs::read(path).unwrap()));
            for before in ["G20", "G21"] {
                let text = format!(
                    "{before} G17 G40 G49 G90 G94 G98\nF10 S100\nG0 X0 Y0 Z1\no<{name}> call [{}]\nM2\n",
                    arguments.join("] [")
                );
                let text = text.replace("call []", "call");
                match difference(text.as_bytes(), [true; 3], &folders(path)) {
                    None => return,
                    Some(None) => {}
                    Some(Some(difference)) => unexpected += &format!("### {text}{difference}\n"),
                }
            }
        }
    }
    assert!(unexpected.is_empty(), "{unexpected}");
}
