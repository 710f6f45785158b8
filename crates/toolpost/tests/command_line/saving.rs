//! Program and report are saved together or not at all, and nothing else is touched.

use crate::folder::{Folder, MACHINE, SOURCE, Said};
use std::fs;
use std::process::Command;

#[test]
fn program_and_report_are_saved_and_nothing_else() {
    let folder = Folder::new();
    let said = folder.post();
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    assert_eq!(folder.names(), ["out.mpf", "out.mpf.report.json", "part.cls"]);
    let report: serde_json::Value =
        serde_json::from_str(&folder.read("out.mpf.report.json")).unwrap();
    assert_eq!(report["proof"]["proven"], true);
    assert_eq!(report["program"]["bytes"], folder.read("out.mpf").len());
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let (one, two) = (Folder::new(), Folder::new());
    for folder in [&one, &two] {
        assert_eq!(folder.post().code, 0);
    }
    for name in ["out.mpf", "out.mpf.report.json"] {
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
    folder.write("out.mpf.report.json", "earlier report");
    assert_eq!(folder.post().code, 1);
    assert_eq!(folder.names(), ["out.mpf", "out.mpf.report.json", "part.cls"]);
    assert_eq!(folder.read("out.mpf"), "earlier");
    assert_eq!(folder.read("out.mpf.report.json"), "earlier report");
}

#[test]
fn the_input_is_never_the_output() {
    let folder = Folder::new();
    folder.write("part.mpf.report.json", SOURCE);
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
        ("part.mpf.report.json", "part.mpf"),
    ];
    for (source, output) in calls {
        let said = folder.run(&["post", source, "-m", MACHINE, "-o", output]);
        assert_eq!(said.code, 2, "{output}: {said:?}");
        assert!(
            said.err.contains("error[output-file]") && said.err.contains("is the input"),
            "{said:?}"
        );
        assert_eq!(folder.names(), before);
        assert_eq!(folder.read("part.cls"), SOURCE);
        assert_eq!(folder.read("part.mpf.report.json"), SOURCE);
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
fn a_place_where_nothing_can_be_saved_is_refused_before_the_work() {
    let folder = Folder::new();
    fs::create_dir(folder.path().join("folder.mpf")).unwrap();
    let calls = [
        ("missing/out.mpf", "error[output-folder]: cannot be saved: there is no folder missing"),
        ("folder.mpf", "error[output-file]: cannot be saved: it is not a file"),
        ("part.cls/out.mpf", "error[output-folder]"),
        ("/dev/null", "error[output-file]: cannot be saved: it is not a file"),
        ("..", "error[output-file]: cannot be saved: it names no file"),
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
    folder.write("disk/out.mpf.report.json", "earlier report");
    let said = folder.run(&["post", "part.cls", "-m", MACHINE, "-o", "disk/out.mpf"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.err.contains("error[output-file]"), "{said:?}");
    assert_eq!(folder.read("disk/out.mpf"), "earlier");
    assert_eq!(folder.read("disk/out.mpf.report.json"), "earlier report");
    assert_eq!(fs::read_dir(folder.path().join("disk")).unwrap().count(), 2);
}

/// Posts with `tools.tbl`, calls `sub.ngc`, for a machine that extends `base.toml`.
fn post_with_all_kinds_of_input(folder: &Folder, output: &str) -> Said {
    folder.write(
        "main.ngc",
        "G21 G17 G90 G94 G54\nT1 M6\nM3 S1000\nG43 H1\nG0 X0 Y0 Z5\no<sub> call\nM2\n",
    );
    folder.write("sub.ngc", "o<sub> sub\nG1 Z-1 F100\nX20\nG0 Z5\no<sub> endsub\n");
    folder.write("tools.tbl", "T1 P1 D6 Z50\n");
    folder.write("base.toml", "extends = \"generic-3axis-linuxcnc\"\n");
    folder.write("mine.toml", "extends = \"base.toml\"\n");
    let source =
        ["post", "main.ngc", "--from", "linuxcnc", "--folder", ".", "--tools", "tools.tbl"];
    folder.run(&[&source[..], &["-m", "mine.toml", "-o", output]].concat())
}

#[test]
fn no_file_that_was_read_is_the_output() {
    let folder = Folder::empty();
    let said = post_with_all_kinds_of_input(&folder, "out.ngc");
    assert_eq!(said.code, 0, "{said:?}");
    for input in ["main.ngc", "sub.ngc", "tools.tbl", "base.toml", "mine.toml"] {
        let before = folder.read(input);
        let said = post_with_all_kinds_of_input(&folder, input);
        assert_eq!(said.code, 2, "{input}: {said:?}");
        assert!(said.err.contains(&format!("is the input {input}")), "{said:?}");
        assert_eq!(folder.read(input), before);
    }
}

#[test]
fn two_programs_of_one_name_have_a_report_each() {
    let folder = Folder::new();
    for (machine, output) in
        [("generic-3axis-fanuc", "part.nc"), ("generic-3axis-heidenhain", "part.h")]
    {
        let said = folder.run(&["post", "part.cls", "-m", machine, "-o", output]);
        assert_eq!(said.code, 0, "{said:?}");
    }
    let names = ["part.cls", "part.h", "part.h.report.json", "part.nc", "part.nc.report.json"];
    assert_eq!(folder.names(), names);
}

#[cfg(unix)]
#[test]
fn a_read_only_file_is_not_replaced() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let path = folder.write("out.mpf", "proven last year");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    let said = folder.post();
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.err.contains("read-only"), "{said:?}");
    assert_eq!(folder.read("out.mpf"), "proven last year");
}

#[test]
fn prove_says_whether_the_report_belongs_to_the_program() {
    let folder = Folder::new();
    folder.write("mine.toml", format!("extends = \"{MACHINE}\"\n"));
    let post = || folder.run(&["post", "part.cls", "-m", "mine.toml", "-o", "out.mpf"]);
    let prove = || folder.run(&["prove", "out.mpf", "-m", "mine.toml", "--against", "part.cls"]);
    assert_eq!(post().code, 0);
    let report: serde_json::Value =
        serde_json::from_str(&folder.read("out.mpf.report.json")).unwrap();
    assert_eq!(report["schema"], 4);
    let said = prove();
    assert!(said.out.contains("out.mpf.report.json belongs to this program"), "{said:?}");
    // Still proven, but by another text, another toolpath, another machine file.
    for (file, more, what) in [
        ("out.mpf", "; a word of the shop\n", "program"),
        ("part.cls", "$$ a word of the programmer\n", "toolpath"),
        ("mine.toml", "# a word of the machinist\n", "machine file"),
    ] {
        assert_eq!(post().code, 0);
        let text = folder.read(file);
        let changed =
            if file == "out.mpf" { format!("{more}{text}") } else { format!("{text}{more}") };
        folder.write(file, changed);
        let said = prove();
        assert_eq!(said.code, 0, "{said:?}");
        let expected = format!("is the report of another {what}\n");
        assert!(
            said.err.contains("warning[report-pair]") && said.err.contains(&expected),
            "{said:?}"
        );
    }
}

#[test]
fn what_a_killed_command_left_is_removed_and_nothing_else() {
    let folder = Folder::new();
    folder.write(".toolpost-aB3dE9.tmp", "half");
    folder.write(".toolpost-notes.md", "mine");
    fs::create_dir(folder.path().join(".toolpost-folder.tmp")).unwrap();
    assert_eq!(folder.post().code, 0);
    let kept = [
        ".toolpost-folder.tmp",
        ".toolpost-notes.md",
        "out.mpf",
        "out.mpf.report.json",
        "part.cls",
    ];
    assert_eq!(folder.names(), kept);
}

/// Also where nothing comes of the next command: the input is wrong, and nothing is saved.
#[test]
fn what_a_killed_command_left_is_removed_by_the_next_one_whatever_comes_of_it() {
    let folder = Folder::new();
    folder.write("part.cls", SOURCE.replace("GOTO/0,0,5\n", "GOTO/0,0,5,0,0.6,0.8\n"));
    folder.write(".toolpost-aB3dE9.tmp", "half");
    assert_eq!(folder.post().code, 1);
    assert_eq!(folder.names(), ["part.cls"]);
}

/// A file beyond `ulimit -f` ends a process by SIGXFSZ, without a word and with what it had begun left behind.
#[cfg(unix)]
#[test]
fn a_program_beyond_the_largest_file_of_the_shell_is_not_begun() {
    let folder = Folder::new();
    let mut long = SOURCE.replace("FINI\n", "");
    for i in 0..2000 {
        long.push_str(&format!("GOTO/{},{},-2\n", i % 97, i % 89));
    }
    folder.write("long.cls", long + "FINI\n");
    let call = format!(
        "ulimit -f 4; exec {} --quiet post long.cls -m {MACHINE} -o out.mpf",
        env!("CARGO_BIN_EXE_toolpost")
    );
    let said = Command::new("sh").args(["-c", &call]).current_dir(folder.path()).output().unwrap();
    let err = String::from_utf8_lossy(&said.stderr).into_owned();
    assert_eq!(said.status.code(), Some(2), "{err}");
    assert!(err.contains("error[output-file]") && err.contains("ulimit -f"), "{err}");
    assert_eq!(folder.names(), ["long.cls", "part.cls"]);
}

/// The digest that the report next to `out.mpf` gives for it is that of `out.mpf`.
fn is_a_pair(folder: &Folder) -> bool {
    let report: serde_json::Value =
        serde_json::from_str(&folder.read("out.mpf.report.json")).unwrap();
    report["program"]["bytes"] == folder.read("out.mpf").len()
}

#[test]
fn of_two_commands_that_save_the_same_files_one_saves_both() {
    let folder = Folder::new();
    // The two programs differ in length.
    folder.write(
        "other.cls",
        SOURCE.replace("GOTO/40,30,-2\n", "GOTO/40,30,-2\nGOTO/0,30,-2\nGOTO/0,10,-2\n"),
    );
    for _ in 0..20 {
        let writers = ["part.cls", "other.cls"].map(|source| {
            Command::new(env!("CARGO_BIN_EXE_toolpost"))
                .args(["--quiet", "post", source, "-m", MACHINE, "-o", "out.mpf"])
                .current_dir(folder.path())
                .spawn()
                .unwrap()
        });
        for mut writer in writers {
            assert!(writer.wait().unwrap().success());
        }
        assert!(is_a_pair(&folder));
    }
}

#[cfg(unix)]
#[test]
fn a_command_that_is_interrupted_leaves_nothing() {
    let folder = Folder::new();
    let mut long = SOURCE.replace("FINI\n", "");
    for i in 0..200_000 {
        long.push_str(&format!("GOTO/{}.{},{},-2\n", i % 97, i % 10, i % 89));
    }
    folder.write("long.cls", long + "FINI\n");
    for delay in [30, 120] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_toolpost"));
        command.args(["--quiet", "post", "long.cls", "-m", MACHINE, "-o", "out.mpf"]);
        let mut writer = command.current_dir(folder.path()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(delay));
        let kill = Command::new("kill").args(["-INT", &writer.id().to_string()]).status().unwrap();
        assert!(kill.success());
        // Killed by the signal where it came before the command had begun.
        assert!(matches!(writer.wait().unwrap().code(), None | Some(130)));
        assert_eq!(folder.names(), ["long.cls", "part.cls"]);
    }
}
