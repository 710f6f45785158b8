//! The machines that can be picked: those of the library, and the folder's own.

use crate::ask::{Axis, AxisKind, MachineEntry, MachineKind};
use crate::folder::Folder;
use app::{Stop, glass, toolpath};
use machine::{Machine, Reach, is_path, library};
use program::{Diagnostic, Rule};
use std::borrow::Borrow;
use std::sync::OnceLock;

/// A machine that was opened, whatever makes its programs.
#[derive(Clone, Debug)]
pub enum Any<G = glass::Machine> {
    /// It moves a tool, a wire or an arm.
    Moves(Box<Machine>),
    /// It fires inside glass: the machine, or what has it.
    Fires(Box<G>),
}

impl<G: Borrow<glass::Machine>> Any<G> {
    /// What a person calls it.
    pub fn title(&self) -> &str {
        match self {
            Any::Moves(machine) => &machine.title,
            Any::Fires(glass) => &(**glass).borrow().title,
        }
    }

    /// What it is.
    pub fn kind(&self) -> MachineKind {
        match self {
            Any::Fires(_) => MachineKind::Glass,
            Any::Moves(machine) => match (&machine.wire, &machine.arm) {
                (Some(_), _) => MachineKind::Wire,
                (_, Some(_)) => MachineKind::Robot,
                _ => MachineKind::Mill,
            },
        }
    }

    /// The dialect of its programs.
    pub fn dialect(&self) -> &str {
        match self {
            Any::Moves(machine) => &machine.reader,
            Any::Fires(_) => "glass",
        }
    }

    /// The control that it has, in a word.
    fn control(&self) -> &str {
        match self {
            Any::Moves(machine) => &machine.control,
            Any::Fires(_) => "glass",
        }
    }

    /// Its axes, in the order in which their positions are kept.
    pub fn axes(&self) -> Vec<Axis> {
        match self {
            Any::Moves(machine) => axes(machine, self.kind()),
            Any::Fires(glass) => crate::glass::axes((**glass).borrow()),
        }
    }

    fn entry(&self, name: &str) -> MachineEntry {
        MachineEntry {
            name: name.to_owned(),
            title: self.title().to_owned(),
            kind: self.kind(),
            control: self.control().to_owned(),
            axes: self.axes().into_iter().map(|axis| axis.name).collect(),
            is_own: false,
            findings: Vec::new(),
        }
    }
}

/// Opens the machine of a name in the library, or of a file of the folder; what it extends lies there too.
///
/// # Errors
/// Where there is none, its file has a mistake, or leads out of the folder.
pub fn open(name: &str, folder: &Folder) -> Result<Any, Stop> {
    let reach = Reach::Folder(folder.path().to_owned());
    if !is_path(name) {
        return match glass::library(name) {
            Ok(text) => Ok(Any::Fires(glass::machine_of(text.as_bytes(), name)?.into())),
            Err(_) => Ok(Any::Moves(toolpath::machine_within(name, &reach)?.into())),
        };
    }
    let text = folder.read(name)?;
    if glass::is_machine(&text) {
        return Ok(Any::Fires(glass::machine_of(&text, name)?.into()));
    }
    let text = String::from_utf8(text).map_err(|_| {
        let found = Diagnostic::error(Rule::MachineFile, "this is no text in UTF-8").file(name);
        found.help("save it in UTF-8")
    })?;
    let path = folder.target(name)?;
    let mut machine = toolpath::machine_of(&path.to_string_lossy(), &text, &reach)?;
    // Its files are called as the page calls them.
    let of_blocks = machine.blocks.values_mut().map(|block| &mut block.file);
    of_blocks.chain([&mut machine.file]).for_each(|file| folder.shorten(file));
    Ok(Any::Moves(machine.into()))
}

/// How many files of the folder are looked at for machines, and the largest of them, bytes.
const MOST_OWN: usize = 200;
const LARGEST_OWN: u64 = 1 << 20;

/// All that can be picked: the library's in the order of their names, then those of the folder and of folders in it, the nearest first.
pub fn list(folder: &Folder) -> Vec<MachineEntry> {
    static LIBRARY: OnceLock<Vec<MachineEntry>> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| {
        let names = library::names(library::CONTROLLED).chain(glass::names());
        names.filter_map(|name| Some(open(name, folder).ok()?.entry(name))).collect()
    });
    let mut all = library.clone();
    for name in folder.files_below(".toml", MOST_OWN, LARGEST_OWN) {
        match open(&name, folder) {
            Ok(machine) => all.push(MachineEntry { is_own: true, ..machine.entry(&name) }),
            Err(stop) if is_meant(&name, folder) => {
                let findings =
                    stop.findings.into_iter().map(|found| folder.finding(found)).collect();
                let (title, control) = (String::new(), String::new());
                let (kind, axes) = (MachineKind::Mill, Vec::new());
                all.push(MachineEntry { name, title, kind, control, axes, is_own: true, findings });
            }
            // Settings, boards and whatever else is written in TOML.
            Err(_) => {}
        }
    }
    all
}

/// Whether a file that has a mistake is meant as a machine.
fn is_meant(name: &str, folder: &Folder) -> bool {
    let text = folder.read(name).unwrap_or_default();
    let extends = |line: &[u8]| line.starts_with(b"extends");
    text.split(|byte| *byte == b'\n').any(extends) || glass::is_machine(&text)
}

/// The axes of a machine that moves something.
fn axes(machine: &Machine, kind: MachineKind) -> Vec<Axis> {
    let known = |value: f64| value.is_finite().then_some(value);
    let axis = |name: String, kind, unit, low: f64, high: f64| {
        let (low, high) = (known(low), known(high));
        Axis { name, kind, unit, low, high }
    };
    match kind {
        MachineKind::Mill | MachineKind::Glass => {
            // Travels count from the zero of the machine; so do positions where the work zero is known.
            let counts = machine.work_zero.is_some();
            let linear = ["X", "Y", "Z"].into_iter().zip(&machine.linear).map(|(name, linear)| {
                let (low, high) =
                    if counts { (linear.min, linear.max) } else { (f64::NAN, f64::NAN) };
                axis(name.to_owned(), AxisKind::Linear, "mm", low, high)
            });
            let rotary = machine.rotary.iter().map(|rotary| {
                let name = rotary.letter.to_string();
                axis(name, AxisKind::Rotary, "degrees", rotary.min, rotary.max)
            });
            linear.chain(rotary).collect()
        }
        MachineKind::Wire => {
            let travel = machine.wire.as_ref().map_or(f64::NAN, |wire| wire.uv_travel);
            let linear = |name: &str, travel: f64| {
                axis(name.to_owned(), AxisKind::Linear, "mm", -travel, travel)
            };
            let (x, u) = (f64::NAN, travel);
            [("X", x), ("Y", x), ("Z", x), ("U", u), ("V", u)]
                .map(|(name, travel)| linear(name, travel))
                .to_vec()
        }
        MachineKind::Robot => {
            let arm = machine.arm.as_ref();
            // Whether joint 2 has no part in what the controller shows as joint 3.
            let is_alone = arm
                .and_then(|arm| arm.shown(&[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]))
                .is_some_and(|shown| shown[2] == 0.0);
            let joints = arm.iter().flat_map(|arm| arm.joints()).zip(1..).map(|(joint, number)| {
                // How the controller counts joint 3 depends on joint 2, or is not known.
                let (low, high) = match number {
                    3 if !is_alone => (f64::NAN, f64::NAN),
                    _ => (joint.min.to_degrees(), joint.max.to_degrees()),
                };
                axis(format!("J{number}"), AxisKind::Joint, "degrees", low, high)
            });
            let rail =
                machine.cell.as_ref().and_then(|cell| cell.rail.as_ref()).map(|rail| {
                    axis(String::from("rail"), AxisKind::Rail, "mm", rail.min, rail.max)
                });
            joints.chain(rail).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Limits of the makers' data sheets: KR 6 R900 sixx -120 to 156; FANUC counts joint 3 against the horizontal.
    #[test]
    fn joint_3_has_limits_where_joint_2_has_no_part_in_it() {
        let joint_3 = |name: &str| {
            let axis = axes(&machine::load(name).unwrap(), MachineKind::Robot).remove(2);
            (axis.low, axis.high)
        };
        let (low, high) = joint_3("kuka-kr6-r900");
        assert!((low.unwrap() + 120.0).abs() < 1e-9 && (high.unwrap() - 156.0).abs() < 1e-9);
        assert_eq!(joint_3("fanuc-m20ia-mill"), (None, None));
    }

    #[test]
    fn a_machine_of_the_folder_may_extend_what_is_in_it_and_in_the_library() {
        let all = tempfile::tempdir().unwrap();
        let own = all.path().join("own");
        fs::create_dir(&own).unwrap();
        fs::write(all.path().join("out.toml"), "extends = \"iso\"\n").unwrap();
        fs::write(own.join("good.toml"), "extends = \"generic-3axis-linuxcnc\"\n").unwrap();
        fs::write(own.join("better.toml"), "extends = \"good.toml\"\ntitle = \"Better\"\n")
            .unwrap();
        fs::write(own.join("leads-out.toml"), "extends = \"../out.toml\"\n").unwrap();
        fs::write(own.join("whole.toml"), format!("extends = {:?}\n", all.path().join("out.toml")))
            .unwrap();
        fs::write(own.join("board.toml"), "[board]\nsize = [1, 2]\n").unwrap();
        fs::create_dir_all(own.join("shop/mills")).unwrap();
        fs::write(own.join("shop/mills/far.toml"), "extends = \"../../good.toml\"\n").unwrap();
        let folder = Folder::open(&own).unwrap();
        assert_eq!(open("better.toml", &folder).unwrap().title(), "Better");
        for name in ["leads-out.toml", "whole.toml"] {
            let stop = open(name, &folder).unwrap_err();
            assert!(
                stop.findings[0].message.contains("may not be read here"),
                "{:?}",
                stop.findings
            );
        }
        let stop = open("../out.toml", &folder).unwrap_err();
        assert!(stop.findings[0].rule == "folder-reach", "{:?}", stop.findings);
        let listed = list(&folder);
        let own: Vec<_> = listed.iter().filter(|entry| entry.is_own).collect();
        let names: Vec<_> = own.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(
            names,
            ["better.toml", "good.toml", "leads-out.toml", "whole.toml", "shop/mills/far.toml"]
        );
        assert!(own[4].findings.is_empty(), "{:?}", own[4]);
        assert_eq!((own[0].findings.len(), own[2].findings.len()), (0, 1));
        let named = |name: &str| listed.iter().find(|entry| entry.name == name).unwrap();
        assert_eq!(named("fanuc-table-bc").axes, ["X", "Y", "Z", "B", "C"]);
        assert_eq!(named("bp-95d").kind, MachineKind::Wire);
    }

    #[cfg(unix)]
    #[test]
    fn a_machine_that_is_a_link_out_or_extends_one_is_not_read() {
        let all = tempfile::tempdir().unwrap();
        let own = all.path().join("own");
        fs::create_dir(&own).unwrap();
        fs::write(all.path().join("out.toml"), "extends = \"generic-3axis-linuxcnc\"\n").unwrap();
        std::os::unix::fs::symlink("../out.toml", own.join("link.toml")).unwrap();
        fs::write(own.join("by-link.toml"), "extends = \"link.toml\"\n").unwrap();
        let folder = Folder::open(&own).unwrap();
        let found = |name| open(name, &folder).unwrap_err().findings.remove(0);
        assert_eq!(found("link.toml").rule, Rule::FolderReach);
        assert!(found("by-link.toml").message.contains("may not be read here"));
    }
}
