//! The files of cutter-location data that the tests read, and the mills they are for.

use machine::Machine;
use machine::library::{MACHINES, names};
use std::path::{Path, PathBuf};

/// The top folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every file of cutter-location data that there is: our examples and the real ones.
pub fn sources() -> Vec<PathBuf> {
    let systems = ["cldata/makino", "cldata/nx", "cldata/solidworks"];
    let mut files = Vec::new();
    for folder in systems.into_iter().filter_map(judge::data).chain([root().join("examples")]) {
        let entries = std::fs::read_dir(&folder).unwrap();
        files.extend(entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_file()));
    }
    // Our examples have NC programs, a tool table, a job of FreeCAD's and a board among them.
    let others = ["nc", "mpf", "tbl", "json", "toml"];
    files.retain(|file| file.extension().is_none_or(|ending| others.iter().all(|o| ending != *o)));
    files.sort();
    files
}

/// The mills of the library.
pub fn mills() -> impl Iterator<Item = Machine> {
    names(MACHINES).map(|name| machine::load(name).unwrap()).filter(|m| m.wire.is_none())
}
