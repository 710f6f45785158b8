//! From files to a [`Machine`]: reading, merging along `extends`, checking.
//!
//! A [`crate::sheet::Sheet`] is one [`mod@file`] as it stands; every key may be missing, no other key may be
//! there. The sheets of a chain are [`checked`] and merged, the nearer one winning field by field, and the
//! result must be whole.

mod arm;
mod checked;
mod file;
mod mistakes;

use crate::library;
use crate::model::{LoadedFrom, Machine};
use checked::CheckedSheet;
use file::SheetFile;
use program::{Diagnostic, Digest, Rule};
use std::path::{Path, PathBuf};

/// How many files a chain of `extends` may have.
const LONGEST_CHAIN: usize = 16;

use program::Outcome;

/// Where machine files may be read, all that they extend with them. The library is within every reach.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Reach {
    /// Wherever a path leads: for whoever sits at the computer.
    #[default]
    Anywhere,
    /// In this folder and those in it, by whatever links.
    Folder(PathBuf),
    /// Nowhere.
    Library,
}

impl Reach {
    /// Loads a machine: a name of the library, or the path of a file (with a `/` or ending in `.toml`).
    ///
    /// # Errors
    /// The first mistake in the chain of files, with file, line, column and the way out.
    pub fn load(&self, name_or_path: &str) -> Outcome<Machine> {
        let file = if is_path(name_or_path) {
            SheetFile::read(Path::new(name_or_path), self)?
        } else {
            SheetFile::of_library(name_or_path, library::LOADABLE)?
        };
        build(file, self)
    }

    /// Loads what a program was written for: a machine as [`Reach::load`] does, or a control of the library.
    ///
    /// # Errors
    /// As [`Reach::load`].
    pub fn load_origin(&self, name_or_path: &str) -> Outcome<Machine> {
        match is_path(name_or_path) {
            true => self.load(name_or_path),
            false => build(SheetFile::of_library(name_or_path, library::EVERYTHING)?, self),
        }
    }

    /// Loads a machine from TOML text, as if it stood in `file_name`. What it extends by path is looked up from the
    /// folder of that name.
    ///
    /// # Errors
    /// As [`Reach::load`].
    pub fn load_text(&self, file_name: &str, text: &str) -> Outcome<Machine> {
        build(SheetFile::new(PathBuf::from(file_name), text.to_string(), true), self)
    }

    /// The files that the machine in the file `path` is made of, the nearest first, as far as they can be read: the last one may have a
    /// mistake, or not be there. Those of the library are left out.
    pub fn chain(&self, path: &Path) -> Vec<PathBuf> {
        let mut files = vec![path.to_owned()];
        while files.len() < LONGEST_CHAIN {
            let parent = || {
                let file = SheetFile::read(files.last()?, self).ok()?;
                let extends = file.parse().ok()?.extends?.into_inner();
                is_path(&extends).then(|| file.beside(&extends))
            };
            let Some(parent) = parent() else { break };
            files.push(parent);
        }
        files
    }

    /// # Errors
    /// The file `path` lies elsewhere.
    fn check(&self, path: &Path) -> Outcome {
        let (is_inside, help) = match self {
            Reach::Anywhere => return Ok(()),
            Reach::Folder(folder) => {
                let inside = match (path.canonicalize(), folder.canonicalize()) {
                    (Ok(file), Ok(folder)) => file.starts_with(folder),
                    _ => false,
                };
                (inside, format!("copy it into {}", folder.display()))
            }
            Reach::Library => (false, String::from("name a control or a machine of the library")),
        };
        if is_inside {
            return Ok(());
        }
        let found =
            Diagnostic::error(Rule::MachineReach, "this file may not be read here").help(help);
        Err(found.file(path.display().to_string()).into())
    }
}

/// Loads a machine as [`Reach::load`] does, from anywhere.
///
/// # Errors
/// As there.
pub fn load(name_or_path: &str) -> Outcome<Machine> {
    Reach::Anywhere.load(name_or_path)
}

/// Loads a control of the library by its name, as the machine that says nothing beyond it.
///
/// # Errors
/// As [`load`].
pub fn load_control(name: &str) -> Outcome<Machine> {
    build(SheetFile::of_library(name, library::CONTROLS)?, &Reach::Library)
}

/// Loads what a program was written for as [`Reach::load_origin`] does, from anywhere.
///
/// # Errors
/// As there.
pub fn load_origin(name_or_path: &str) -> Outcome<Machine> {
    Reach::Anywhere.load_origin(name_or_path)
}

/// Loads a machine from text as [`Reach::load_text`] does; what it extends may be anywhere.
///
/// # Errors
/// As there.
pub fn load_text(file_name: &str, text: &str) -> Outcome<Machine> {
    Reach::Anywhere.load_text(file_name, text)
}

fn build(file: SheetFile, reach: &Reach) -> Outcome<Machine> {
    let name = file.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let shown = file.name();
    let mut control = None;
    let mut merged = CheckedSheet::new(file.parse()?, &file)?;
    let (mut texts, mut files, mut keys) = (Digest::default(), Vec::new(), Vec::new());
    let mut add = |file: &SheetFile| {
        texts.add(file.text.as_bytes());
        if file.own || keys.is_empty() {
            keys.extend(file.stated());
        }
        files.extend(file.own.then(|| file.path.clone()));
    };
    add(&file);
    let mut here = file;
    for depth in 0.. {
        let Some(parent) = merged.extends.take() else { break };
        if depth == LONGEST_CHAIN {
            return Err(here
                .at("extends", &parent, "the chain of `extends` has no end")
                .help("no file may extend itself, not even through others")
                .into());
        }
        let next = here.parent(&parent, reach)?;
        // Of a machine that extends another one, the control is what that one extends.
        if control.as_deref().is_none_or(|name| library::find(name, library::CONTROLLED).is_some())
        {
            control = Some(parent.get_ref().clone());
        }
        merged = CheckedSheet::new(next.parse()?, &next)?.under(merged);
        add(&next);
        here = next;
    }
    let missing = |what: &str| {
        let message = format!("{what} is missing, here and in everything that this file extends");
        Box::new(Diagnostic::error(Rule::MachineIncomplete, message).file(shown.clone()))
    };
    if let Some((_, text)) = merged.arm_model().and_then(|arm| library::find(arm, library::ARMS)) {
        texts.add(text.as_bytes());
    }
    let control = control.unwrap_or_else(|| name.clone());
    let machine = merged.finish(name.clone(), shown.clone(), control, &missing)?;
    Ok(Machine { loaded_from: LoadedFrom { files, keys, digest: texts.finish() }, ..machine })
}

/// Whether it is the path of a file (with a `/`, or ending in `.toml`), not a name of the library.
pub fn is_path(name: &str) -> bool {
    name.contains(['/', '\\']) || name.ends_with(".toml")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::*;

    const MILL: &str = r#"
title = "A mill"
reader = "linuxcnc"
[words.X]
decimals = 4
[blocks]
rapid = "G0 {{X}}"
tool_change = """
T{{T}}
M6
"""
[axes.X]
min = 0
max = 200.5
"#;

    fn refusal(text: &str) -> String {
        load_text("mill.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn what_is_written_is_what_is_loaded_and_the_rest_has_defaults() {
        let mill = load_text("shop/mill.toml", MILL).unwrap();
        assert_eq!((mill.name.as_str(), mill.title.as_str()), ("mill", "A mill"));
        assert_eq!(mill.words["X"].decimals, 4);
        assert_eq!(mill.linear[0].max, 200.5);
        assert_eq!(mill.linear[1].max, f64::INFINITY);
        assert_eq!(mill.orientation.simultaneous, OrientationMode::Fixed);
        assert_eq!(mill.resolution(), 1e-4);
    }

    #[test]
    fn the_kinematics_are_switched_by_two_functions_of_a_linuxcnc() {
        let with = |reader: &str, settings: &str| {
            let text = MILL.replace("linuxcnc", reader);
            load_text("mill.toml", &format!("{text}[settings]\n{settings}"))
        };
        let both = "tip_kinematics = 428\naxis_kinematics = 429\n";
        let mill = with("linuxcnc", both).unwrap();
        assert_eq!(mill.settings.kinematics, Some(Kinematics { tip: 428, axes: 429 }));
        for (reader, settings) in [
            ("linuxcnc", "tip_kinematics = 428\n"),
            ("linuxcnc", "axis_kinematics = 429\n"),
            ("linuxcnc", "tip_kinematics = 428\naxis_kinematics = 428\n"),
            ("fanuc", both),
        ] {
            let found = with(reader, settings).unwrap_err().to_string();
            assert!(found.contains("tip_kinematics"), "{reader} {settings}: {found}");
        }
    }

    #[test]
    fn a_block_knows_where_its_text_begins() {
        let mill = load_text("mill.toml", MILL).unwrap();
        assert_eq!((mill.blocks["rapid"].line, mill.blocks["rapid"].column), (7, 10));
        assert_eq!((mill.blocks["tool_change"].line, mill.blocks["tool_change"].column), (9, 1));
        assert!(mill.blocks["tool_change"].text.starts_with("T{{T}}\n"));
    }

    #[test]
    fn an_unknown_key_is_named_with_line_and_column() {
        let shown = refusal("reader = \"grbl\"\n[spindle]\nmaxx = 5\n");
        assert!(shown.starts_with(
            "mill.toml:3:1: error[machine-file]: no key of this table is called `maxx`"
        ));
        assert!(shown.contains("`max`"));
    }

    #[test]
    fn a_key_in_the_wrong_place_or_misspelt_or_twice_says_where_it_belongs() {
        let said = |text: &str, place: &str, help: &str| {
            let found = load_text("mill.toml", text).unwrap_err();
            assert!(found.to_string().starts_with(&format!("mill.toml:{place}: ")), "{found}");
            assert!(found.help.contains(help), "{found}");
        };
        let top = "at the top of the file, above all tables";
        said(
            "reader = \"grbl\"\n[blocks]\nstop = \"\"\"\n[M0]\n\"\"\"\nsafe_height = 0\n",
            "6:15",
            top,
        );
        said("[blocks]\nsafe_height = 0\n", "2:15", "and stands below [blocks] here");
        said("[spindle]\nfeed_max = 5000\n", "2:1", top);
        said(
            "rapid_path = \"linear\"\n",
            "1:1",
            "belongs below [settings], and stands at the top here",
        );
        said("safe_heigth = 0\n", "1:1", "did you mean `safe_height`?");
        said("[settings]\nrapid_path = \"linaer\"\n", "2:14", "did you mean `linear`?");
        said("[axes]\nX = { rapd = 3 }\n", "2:7", "did you mean `rapid`?");
        said("[settings]\ntool_radius = \"center\"\n", "2:15", "its values are `full`, `wear`");
        said(
            "feed_max = \"fast\"\n",
            "1:12",
            "correct the file at the mark; `toolpost explain feed_max` says what it takes",
        );
        // The first of two.
        said("a = 1\nfeed_max = 3\nfeed_max = 4\n", "3:1", "the first one stands in line 2");
        said(
            "[axes]\nX.min = 3\n\n[spindle]\n[axes]\n",
            "5:2",
            "the table stands in line 1 already",
        );
        said("[words.X]\ndecimals = 3\n'decimals' = 4\n", "3:1", "the first one stands in line 2");
        said("[[rotary]]\nmin = 3\n[[rotary]]\nmax = 1\nmax = 4\n", "5:1", "stands in line 4");
    }

    #[test]
    fn a_wrong_value_is_told_with_its_key_and_what_it_takes() {
        for (text, message) in [
            ("[settings]\nrapid_path = \"linaer\"", "rapid_path: `linaer` is none of its values"),
            ("[settings]\nstart_modes = [\"G177\"]", "start_modes: `G177` is none of its values"),
            ("[capabilities]\ncycles = [\n \"drill\",\n \"bored\"]", "cycles: `bored` is none"),
            ("[[rotary]]\nletter = \"B\"\n[[rotary]]\non = \"Table\"", "on: `Table` is none"),
            (
                "[axes]\nX = { min = 0, max = \"a\" }",
                "max: the text \"a\" is given, and a number is needed",
            ),
            ("[axes.X]\nmax = \"a\"", "max: the text \"a\" is given"),
            ("work_zero = [1, 2]", "work_zero: a list of 2 is given, and a list of 3 is needed"),
            ("[feed_max]\na = 1", "feed_max: a table is given, and a number is needed"),
            ("[settings]\nrapid_path = true", "rapid_path: a text is needed"),
            (
                "[options]\npath_tolerance = \"x\"",
                "path_tolerance: the text \"x\" is given, and a number from 0 to 10 mm is needed",
            ),
            (
                "[options]\ntouch_feed = true",
                "touch_feed: true is given, and 0, or a number from 1 to",
            ),
            ("[options]\nmine = [8]", "mine: a text, a number, true or false is needed"),
        ] {
            let found = refusal(&format!("{text}\n"));
            assert!(found.contains(&format!("error[machine-file]: {message}")), "{text}: {found}");
            assert!(!found.contains("invalid type") && !found.contains("expected"), "{found}");
        }
    }

    #[test]
    fn mistakes_that_only_a_machinist_sees_are_reported_at_their_place() {
        let rotary = |fields: &str| {
            refusal(&format!(
                "reader = \"grbl\"\n[orientation]\nsimultaneous = \"vectors\"\n[[rotary]]\nletter = \
                 \"A\"\non = \"table\"\nrapid = 1\nacceleration = 1\n{fields}\n"
            ))
        };
        assert!(rotary("axis = [0, 0, 0]").contains("rotary A: `axis` has no direction"));
        assert!(rotary("axis = [1, 0, 0]\nsign = 2").contains("`sign` is 1 or -1"));
        assert!(rotary("axis = [1, 0, 0]\nmin = 5\nmax = 5").contains("`min` is less than `max`"));
        assert!(refusal("reader = \"g\"\n[words.X]\ndecimals = 12").contains(":3:12:"));
        let travel = refusal("reader = \"g\"\n[axes.X]\nmin = 3\nmax = 3");
        assert!(travel.starts_with("mill.toml:2:1: "), "{travel}");
        assert!(travel.contains("axes.X: `min` is less than `max`, not 3 mm and 3 mm"), "{travel}");
        let refused = |text, place, what| {
            let shown = refusal(text);
            assert!(shown.starts_with(&format!("mill.toml:{place}: ")), "{shown}");
            assert!(shown.contains(what), "{shown}");
        };
        refused("[axes]\nX = { min = 100, max = -100 }", "2:5", "axes.X: `min` is less than `max`");
        refused(
            "[axes]\nY = { rapid = 0 }",
            "2:15",
            "rapid: 0.0 is given, and a number above 0, at most 1000000 mm/min, is needed",
        );
        refused("[spindle]\nmin = 9\nmax = 1", "1:1", "spindle: `min`");
        refused("approach = [\"XY\"]", "1:12", "approach: X, Y and Z come once each");
        refused(
            "[tools]\nmax_length = -1",
            "2:14",
            "max_length: -1.0 is given, and a number above 0, at most 10000 mm, is needed",
        );
        refused("work_zero = [0, nan, 0]", "1:13", "three numbers from -100000 to 100000 mm");
        assert!(refusal("title = \"no reader\"").contains("`reader`"));
    }

    #[test]
    fn orientation_needs_rotary_axes_and_the_other_way_round() {
        let shown = refusal("reader = \"g\"\n[orientation]\nsimultaneous = \"vectors\"");
        assert!(shown.starts_with("mill.toml:2:1: ") && shown.contains("[[rotary]]"), "{shown}");
        let axis = "letter = \"A\"\non = \"head\"\naxis = [1, 0, 0]\nrapid = 1\nacceleration = 1";
        let shown = refusal(&format!("reader = \"g\"\n[[rotary]]\n{axis}"));
        assert!(shown.starts_with("mill.toml:2:"), "{shown}");
        assert!(shown.contains("`orientation.simultaneous`"), "{shown}");
    }

    #[test]
    fn a_touch_off_is_refused_where_a_machine_has_none() {
        let place = "[options]\ntouch_travel = 15\n";
        for (parent, why) in [
            (
                "mach3-mill",
                "touch_travel: the block `tool_change` of this control writes no touch-off",
            ),
            ("marlin-cnc", "writes no touch-off"),
            ("generic-3axis-fanuc", "writes no touch-off"),
            ("linuxcnc-xyzac", "touch_travel: a machine with rotary axes has no touch-off"),
        ] {
            let shown = refusal(&format!("extends = \"{parent}\"\n{place}"));
            assert!(shown.starts_with("mill.toml:3:16: "), "{parent}: {shown}");
            assert!(
                shown.contains(why) && shown.contains("GRBL and LinuxCNC"),
                "{parent}: {shown}"
            );
            load_text(
                "mill.toml",
                &format!("extends = \"{parent}\"\n{}", place.replace("15", "0")),
            )
            .unwrap();
        }
        for parent in ["grbl-3018", "linuxcnc-mill"] {
            load_text("mill.toml", &format!("extends = \"{parent}\"\n{place}")).unwrap();
        }
        let mut five = load("linuxcnc-xyzac").unwrap();
        let shown = five.set_option("touch_travel", "15").unwrap_err().to_string();
        assert!(shown.contains("option `touch_travel`: a machine with rotary axes"), "{shown}");
        five.set_option("touch_travel", "0").unwrap();
    }

    #[test]
    fn a_wire_leans_by_u_and_v_and_by_no_rotary_axis() {
        let wire = load_text("w.toml", "reader = \"g\"\n[wire]\nmemory = 900\n").unwrap().wire;
        let unlimited = Wire {
            height: None,
            uv_travel: f64::INFINITY,
            taper_max: 90.0,
            thread: None,
            cut: None,
            memory: Some(900),
        };
        assert_eq!(wire, Some(unlimited));
        let axis = "letter = \"A\"\non = \"head\"\naxis = [1, 0, 0]\nrapid = 1\nacceleration = 1";
        let modes = "[orientation]\nsimultaneous = \"vectors\"";
        let shown = refusal(&format!("reader = \"g\"\n[wire]\n{modes}\n[[rotary]]\n{axis}"));
        assert!(shown.starts_with("mill.toml:2:1: ") && shown.contains("U and V"), "{shown}");
    }

    #[test]
    fn what_two_files_make_wrong_together_is_reported_in_the_nearer_one() {
        let folder = std::env::temp_dir().join(format!("toolpost-both-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("base.toml"), MILL).unwrap();
        let file = folder.join("mine.toml");
        std::fs::write(&file, "extends = \"base.toml\"\n\n[axes.X]\nmax = -1\n").unwrap();
        let shown = load(file.to_str().unwrap()).unwrap_err().to_string();
        assert!(
            shown.contains("mine.toml:3:1: ") && shown.contains("not 0 mm and -1 mm"),
            "{shown}"
        );
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_caller_says_where_machine_files_may_be_read() {
        let folder = std::env::temp_dir().join(format!("toolpost-reach-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("shop")).unwrap();
        std::fs::write(folder.join("base.toml"), MILL).unwrap();
        std::fs::write(folder.join("shop/base.toml"), MILL).unwrap();
        let within = Reach::Folder(folder.join("shop"));
        let mine = folder.join("shop/mine.toml").display().to_string();
        let load = |reach: &Reach, extends: &str| {
            let text = format!("extends = \"{extends}\"");
            reach.load_text(&mine, &text).map_err(|found| found.to_string())
        };
        for extends in ["base.toml", "../shop/base.toml", "emco-concept-mill-105"] {
            assert!(load(&within, extends).is_ok(), "{extends}");
        }
        for reach in [&within, &Reach::Library] {
            let shown = load(reach, "../base.toml").unwrap_err();
            assert!(shown.contains("mine.toml:1:11: ") && shown.contains("may not be read here"));
        }
        assert!(load(&Reach::Anywhere, "../base.toml").is_ok());
        assert!(load(&Reach::Library, "base.toml").is_err());
        assert!(load(&Reach::Library, "emco-concept-mill-105").is_ok());
        // Nor by a link that leads out; one that leads to a file within is followed.
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            symlink("../base.toml", folder.join("shop/out.toml")).unwrap();
            symlink("base.toml", folder.join("shop/in.toml")).unwrap();
            symlink("..", folder.join("shop/up")).unwrap();
            for extends in ["out.toml", "up/base.toml"] {
                let shown = load(&within, extends).unwrap_err();
                assert!(shown.contains("may not be read here"), "{shown}");
            }
            assert!(load(&within, "in.toml").is_ok());
            let link = folder.join("shop/out.toml").display().to_string();
            assert_eq!(within.load(&link).unwrap_err().rule, "machine-reach");
        }
        let outside = folder.join("base.toml").display().to_string();
        assert_eq!(within.load(&outside).unwrap_err().rule, "machine-reach");
        assert_eq!(Reach::Library.load_origin(&mine).unwrap_err().rule, "machine-reach");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_missing_or_endless_ancestor_is_reported_where_it_is_named() {
        let shown = refusal("extends = \"nowhere\"");
        assert!(
            shown.starts_with("mill.toml:1:11: error[machine-file]: extends: `nowhere`"),
            "{shown}"
        );
        let folder = std::env::temp_dir().join(format!("toolpost-load-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("round.toml");
        std::fs::write(&file, "extends = \"round.toml\"").unwrap();
        let shown = load(file.to_str().unwrap()).unwrap_err().to_string();
        assert!(shown.contains("the chain of `extends` has no end"), "{shown}");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_nearer_file_changes_single_values_and_keeps_the_rest() {
        let folder = std::env::temp_dir().join(format!("toolpost-merge-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("base.toml"), MILL).unwrap();
        let file = folder.join("mine.toml");
        let text = "extends = \"base.toml\"\n[words.X]\nmodal = true\n[blocks]\nrapid = \"G0\"\n";
        std::fs::write(&file, text).unwrap();
        let mine = load(file.to_str().unwrap()).unwrap();
        assert_eq!((mine.words["X"].decimals, mine.words["X"].modal), (4, true));
        assert_eq!(mine.blocks["rapid"].text, "G0");
        assert!(mine.blocks.contains_key("tool_change"));
        assert_eq!((mine.control.as_str(), mine.title.as_str()), ("base.toml", "A mill"));
        let mine = load_text("mine.toml", "extends = \"emco-concept-mill-105\"").unwrap();
        assert_eq!(mine.control, "sinumerik-828d");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
