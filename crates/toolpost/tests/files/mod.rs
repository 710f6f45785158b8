//! The files of cutter-location data that the tests read, and the mills they are for.

#![allow(dead_code, reason = "each test file uses its part")]

use machine::Machine;
use machine::library::{MACHINES, names};
use std::path::{Path, PathBuf};

/// The top folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The folder of real cutter-location data: in `TOOLPOST_DATA`, or in `../shared/data` beside the
/// checkout.
pub fn cldata() -> PathBuf {
    let beside = root().join("../shared/data");
    std::env::var_os("TOOLPOST_DATA").map_or(beside, PathBuf::from).join("cldata")
}

/// Every file of cutter-location data that there is: our examples and the real ones. A folder that is
/// missing is named on stderr.
pub fn sources() -> Vec<PathBuf> {
    let real = ["makino", "nx", "solidworks"].map(|system| cldata().join(system));
    let mut files = Vec::new();
    for folder in real.into_iter().chain([root().join("examples")]) {
        let Ok(entries) = std::fs::read_dir(&folder) else {
            eprintln!("note: no {} here", folder.display());
            continue;
        };
        files.extend(entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_file()));
    }
    // Our examples have NC programs, a job of FreeCAD's and a board among them.
    let others = ["nc", "json", "toml"];
    files.retain(|file| file.extension().is_none_or(|ending| others.iter().all(|o| ending != *o)));
    files.sort();
    files
}

/// The mills of the library.
pub fn mills() -> impl Iterator<Item = Machine> {
    names(MACHINES).map(|name| machine::load(name).unwrap()).filter(|m| m.wire.is_none())
}
