//! Program and report are saved together or not at all, and nothing else is touched.

use crate::folder::{Folder, MACHINE, SOURCE};
use std::fs;
use std::process::Command;

#[test]
fn program_and_report_are_saved_and_nothing_else() {
    let folder = Folder::new();
    let said = folder.post();
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    assert_eq!(folder.names(), ["out.mpf", "out.report.json", "part.cls"]);
    let report: serde_json::Value = serde_json::from_str(&folder.read("out.report.json")).unwrap();
    assert_eq!(report["proof"]["proven"], true);
    assert_eq!(report["program"]["bytes"], folder.read("out.mpf").len());
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let (one, two) = (Folder::new(), Folder::new());
    for folder in [&one, &two] {
        assert_eq!(folder.post().code, 0);
    }
    for name in ["out.mpf", "out.report.json"] {
        assert_eq!(one.read(name), two.read(name));
    }
}

#[test]
fn what_cannot_be_made_leaves_earlier_files_as_they_were() {
    let folder = Folder::new();
    // A three-axis machine cannot tilt the tool.
    folder.write("part.cls", SOURCE.replace("GOTO/0,0,5\n", "GOTO/0,0,5,0,0.6,0.8\n"));
    assert_eq!(folder.post().code, 1);
    assert_eq!(folder.names(), ["part.cls"]);
    folder.write("out.mpf", "earlier");
    folder.write("out.report.json", "earlier report");
    assert_eq!(folder.post().code, 1);
    assert_eq!(folder.names(), ["out.mpf", "out.report.json", "part.cls"]);
    assert_eq!(folder.read("out.mpf"), "earlier");
    assert_eq!(folder.read("out.report.json"), "earlier report");
}

#[test]
fn the_input_is_never_the_output() {
    let folder = Folder::new();
    folder.write("part.report.json", SOURCE);
    fs::hard_link(folder.path().join("part.cls"), folder.path().join("hard.mpf")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("part.cls", folder.path().join("soft.mpf")).unwrap();
    let before = folder.names();
    let calls = [
        ("part.cls", "part.cls"),
        ("part.cls", "./part.cls"),
        ("part.cls", "hard.mpf"),
        #[cfg(unix)]
        ("part.cls", "soft.mpf"),
        // Not the program but its report would take the place of the source.
        ("part.report.json", "part.mpf"),
    ];
    for (source, output) in calls {
        let said = folder.run(&["post", source, "-m", MACHINE, "-o", output]);
        assert_eq!(said.code, 2, "{output}: {said:?}");
        assert!(
            said.err.contains("error[output]") && said.err.contains("is the input"),
            "{said:?}"
        );
        assert_eq!(folder.names(), before);
        assert_eq!(folder.read("part.cls"), SOURCE);
        assert_eq!(folder.read("part.report.json"), SOURCE);
    }
}

#[test]
fn the_machine_file_is_never_the_output() {
    let folder = Folder::new();
    assert_eq!(folder.run(&["machines", "new", "mine", "--from", MACHINE]).code, 0);
    let before = folder.read("mine.toml");
    let said = folder.run(&["post", "part.cls", "-m", "mine.toml", "-o", "mine.toml"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert_eq!(folder.read("mine.toml"), before);
}

#[test]
fn a_place_where_nothing_can_be_saved_is_told_before_the_work() {
    let folder = Folder::new();
    fs::create_dir(folder.path().join("folder.mpf")).unwrap();
    let calls = [
        ("missing/out.mpf", "error[output-folder]: cannot be saved: there is no folder missing"),
        ("folder.mpf", "error[output]: cannot be saved: it is not a file"),
        ("part.cls/out.mpf", "error[output-folder]"),
        ("/dev/null", "error[output]: cannot be saved: it is not a file"),
        ("..", "error[output]: cannot be saved: it names no file"),
    ];
    for (output, expected) in calls {
        let said = folder.run(&["post", "part.cls", "-m", MACHINE, "-o", output]);
        assert_eq!(said.code, 2, "{said:?}");
        assert!(said.err.contains(expected), "{output}: {said:?}");
    }
    assert_eq!(folder.names(), ["folder.mpf", "part.cls"]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_the_file_behind_it_is_replaced() {
    let folder = Folder::new();
    folder.write("real.mpf", "earlier");
    let link = folder.path().join("out.mpf");
    std::os::unix::fs::symlink("real.mpf", &link).unwrap();
    assert_eq!(folder.post().code, 0);
    assert!(fs::symlink_metadata(link).unwrap().is_symlink());
    assert_ne!(folder.read("real.mpf"), "earlier");
    std::os::unix::fs::symlink("nowhere", folder.path().join("dangling.mpf")).unwrap();
    let said = folder.run(&["post", "part.cls", "-m", MACHINE, "-o", "dangling.mpf"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("a link to nothing"), "{said:?}");
}

#[test]
fn names_in_the_source_never_become_paths() {
    let folder = Folder::new();
    fs::create_dir(folder.path().join("deep")).unwrap();
    let source = SOURCE
        .replace("SAMPLE", "../../etc/passwd")
        .replace("LOAD/TOOL,1", "TOOL PATH/../../operation,TOOL,../../tool\nLOAD/TOOL,1");
    folder.write("part.cls", source.replace("FINI", "END-OF-PATH\nFINI"));
    let said = folder.run(&["post", "part.cls", "-m", MACHINE, "-o", "deep/out.mpf"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert_eq!(folder.names(), ["deep", "part.cls"]);
    assert_eq!(fs::read_dir(folder.path().join("deep")).unwrap().count(), 2);
}

/// A file system of 64 kB that vanishes with the folder.
struct SmallDisk(Folder);

impl SmallDisk {
    /// `None` where it may not be mounted.
    fn new() -> Option<SmallDisk> {
        let folder = Folder::new();
        fs::create_dir(folder.path().join("disk")).unwrap();
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=64k", "tmpfs", "disk"])
            .current_dir(folder.path())
            .output()
            .is_ok_and(|output| output.status.success());
        mounted.then_some(SmallDisk(folder))
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("disk").current_dir(self.0.path()).status();
    }
}

#[test]
fn a_full_disk_keeps_the_earlier_files_and_nothing_half_written() {
    let Some(disk) = SmallDisk::new() else {
        eprintln!("no small file system can be mounted here: a full disk is not tested");
        return;
    };
    let folder = &disk.0;
    let mut source = SOURCE.replace("FINI\n", "FEDRAT/MMPM,200\n");
    for i in 0..8000 {
        source.push_str(&format!("GOTO/40,{},-2\n", 30.0 + f64::from(i) * 0.01));
    }
    folder.write("part.cls", source + "FINI\n");
    folder.write("disk/out.mpf", "earlier");
    folder.write("disk/out.report.json", "earlier report");
    let said = folder.run(&["post", "part.cls", "-m", MACHINE, "-o", "disk/out.mpf"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.err.contains("error[output]"), "{said:?}");
    assert_eq!(folder.read("disk/out.mpf"), "earlier");
    assert_eq!(folder.read("disk/out.report.json"), "earlier report");
    assert_eq!(fs::read_dir(folder.path().join("disk")).unwrap().count(), 2);
}
