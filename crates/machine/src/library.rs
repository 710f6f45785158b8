//! The library of machines and controls that comes with the program.

use include_dir::{Dir, include_dir};

static CONTROL_FILES: Dir = include_dir!("$CARGO_MANIFEST_DIR/../../controls");
static MACHINE_FILES: Dir = include_dir!("$CARGO_MANIFEST_DIR/../../machines");
static ROBOT_FILES: Dir = include_dir!("$CARGO_MANIFEST_DIR/../../machines/robots");
static ARM_FILES: Dir = include_dir!("$CARGO_MANIFEST_DIR/../../machines/arms");

/// A folder of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Dialects.
    Control,
    /// Machines.
    Machine,
    /// Robots: an arm with its control and its cell.
    Robot,
    /// Arms, as kinematics: no programs are written for them.
    Arm,
}

/// The machines alone.
pub const MACHINES: &[Kind] = &[Kind::Machine];
/// The controls alone.
pub const CONTROLS: &[Kind] = &[Kind::Control];
/// What has a control: machines and robots.
pub const CONTROLLED: &[Kind] = &[Kind::Machine, Kind::Robot];
/// The robots alone.
pub const ROBOTS: &[Kind] = &[Kind::Robot];
/// The arms alone.
pub const ARMS: &[Kind] = &[Kind::Arm];
/// Machines, robots and arms: what is loaded by its name.
pub const LOADABLE: &[Kind] = &[Kind::Machine, Kind::Robot, Kind::Arm];
/// Machines, robots, arms and controls.
pub const EVERYTHING: &[Kind] = &[Kind::Machine, Kind::Robot, Kind::Arm, Kind::Control];

/// Path (within the library) and text of the file of that name.
pub fn find(name: &str, kinds: &[Kind]) -> Option<(&'static str, &'static str)> {
    files(kinds).find(|(path, _)| stem(path) == name)
}

/// The names in alphabetical order, folder by folder.
pub fn names(kinds: &[Kind]) -> impl Iterator<Item = &'static str> {
    files(kinds).map(|(path, _)| stem(path))
}

/// An option of a control of the library, as its file states it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatedOption {
    /// The control whose file states it; those that extend that one have it too.
    pub control: &'static str,
    /// Its key below `[options]`.
    pub name: &'static str,
    /// What holds where a machine file says nothing, as TOML.
    pub value: &'static str,
    /// The comment above it, with its unit.
    pub help: String,
}

/// The options of the controls, in the order of their files. A comment stands for each key below it until the next comment.
pub fn options() -> Vec<StatedOption> {
    let mut all = Vec::new();
    for (path, text) in files(CONTROLS) {
        let mut within = false;
        let (mut help, mut is_open) = (String::new(), false);
        for line in text.lines() {
            if line.starts_with('[') {
                within = line == "[options]";
            } else if let (true, Some(comment)) = (within, line.strip_prefix("# ")) {
                if !std::mem::replace(&mut is_open, true) {
                    help.clear();
                }
                let space = if help.is_empty() { "" } else { " " };
                help = format!("{help}{space}{comment}");
            } else if let (true, Some((name, value))) = (within, line.split_once(" = ")) {
                is_open = false;
                all.push(StatedOption { control: stem(path), name, value, help: help.clone() });
            }
        }
    }
    all
}

fn stem(path: &str) -> &str {
    let file = path.rsplit('/').next().unwrap_or(path);
    file.strip_suffix(".toml").unwrap_or(file)
}

fn files(kinds: &[Kind]) -> impl Iterator<Item = (&'static str, &'static str)> {
    let folders = kinds.iter().map(|kind| match kind {
        Kind::Control => ("controls", &CONTROL_FILES),
        Kind::Machine => ("machines", &MACHINE_FILES),
        Kind::Robot => ("machines/robots", &ROBOT_FILES),
        Kind::Arm => ("machines/arms", &ARM_FILES),
    });
    folders.flat_map(|(_, folder)| {
        let mut files: Vec<_> = (folder.files())
            .filter_map(|file| Some((file.path().to_str()?, file.contents_utf8()?)))
            .filter(|(path, _)| path.ends_with(".toml"))
            .collect();
        files.sort();
        files
    })
}
