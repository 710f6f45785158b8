//! Real files, which are not part of the project.

use std::path::{Path, PathBuf};

/// The folder of Gerber and Excellon files, or nothing where it is missing, which is said.
pub fn folder() -> Option<PathBuf> {
    let here = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");
    let data = std::env::var_os("TOOLPOST_DATA").map_or_else(|| PathBuf::from(here), PathBuf::from);
    let folder = data.join("gerber");
    if !folder.is_dir() {
        eprintln!("skipped: no real files in {}", folder.display());
        return None;
    }
    Some(folder)
}

/// All files below `folder` whose names end so, in order.
pub fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            found.extend(files(&entry, ending));
        } else if entry.to_string_lossy().ends_with(ending) {
            found.push(entry);
        }
    }
    found
}

/// The bytes of a file.
pub fn bytes(file: &Path) -> Vec<u8> {
    std::fs::read(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()))
}
