//! Arms in the library: listed, checked, copied, and refused where a program is asked for.

use crate::folder::Folder;

#[test]
fn arms_are_listed_with_their_reach() {
    let folder = Folder::new();
    let said = folder.run(&["machines", "list"]).out;
    let row = said.lines().find(|line| line.contains("kuka-kr6-r900-sixx")).unwrap();
    assert!(row.contains("KUKA KR 6 R900 sixx: six joints, reach 901.5 mm"), "{row}");
    let row = said.lines().find(|line| line.contains("kuka-kr120-rail")).unwrap();
    assert!(row.ends_with("six joints, reach 2705.4 mm, on a rail of 6000 mm"), "{row}");
    let listed = folder.run(&["machines", "list", "--json"]).json();
    assert_eq!(listed["arms"].as_array().unwrap().len(), 12);
    for arm in listed["arms"].as_array().unwrap() {
        let said = folder.run(&["machines", "check", arm["name"].as_str().unwrap()]);
        assert!(said.code == 0 && said.out.contains("joint 6"), "{said:?}");
    }
}

#[test]
fn what_the_file_of_an_arm_leaves_open_is_said() {
    let folder = Folder::new();
    let said = folder.run(&["machines", "check", "abb-irb2400"]).out;
    assert!(
        said.contains("`coupling` is missing in [arm]") && said.contains("times are estimates"),
        "{said}"
    );
    let said = folder.run(&["machines", "check", "kuka-kr6-r900-sixx"]).out;
    assert!(!said.contains("coupling") && !said.contains("estimates"), "{said}");
    assert!(said.contains("-190 to 45 degrees, 300 degrees/s"), "{said}");
    let said = folder.run(&["machines", "check", "kuka-kr6-r900-six"]);
    assert!(said.code == 2 && said.err.contains("did you mean `kuka-kr6-r900-sixx`"), "{said:?}");
}

#[test]
fn an_arm_is_copied_and_checked_and_no_program_is_written_for_it() {
    let folder = Folder::new();
    assert_eq!(folder.run(&["machines", "new", "mine", "--from", "ur5e"]).code, 0);
    let text = folder.read("mine.toml");
    assert!(text.contains("[arm]") && !text.contains("[spindle]"), "{text}");
    assert_eq!(folder.run(&["machines", "check", "mine.toml"]).code, 0);
    folder.write("part.cls", "GOTO/0,0,0\n");
    for machine in ["mine.toml", "ur5e"] {
        let said = folder.run(&["post", "part.cls", "--machine", machine, "-o", "out.txt"]);
        assert_eq!(said.code, 2, "{said:?}");
        assert!(said.err.contains("no programs are written for it"), "{said:?}");
        assert!(!folder.names().contains(&"out.txt".to_string()));
    }
}

#[test]
fn a_file_whose_name_no_program_of_a_kuka_has_is_refused_before_anything_is_written() {
    let folder = Folder::new();
    folder.write(
        "part.cls",
        "PARTNO/P\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\nGOTO/0,0,0\nRAPID\nGOTO/0,0,50\nFINI\n",
    );
    let post =
        |file: &str| folder.run(&["post", "part.cls", "--machine", "kuka-kr6-r900", "-o", file]);
    for (file, what) in [
        ("my-part.src", "`my-part` is none"),
        ("1abc.src", "`1abc` is none"),
        ("for.src", "`for` is none"),
        ("bas.src", "KUKA's own software"),
        ("abs.src", "function of the language"),
        ("a_name_of_more_than_24_letters.src", "is none"),
    ] {
        let said = post(file);
        assert_eq!(said.code, 2, "{file}: {said:?}");
        assert!(
            said.err.contains("by the name of its file") && said.err.contains(what),
            "{said:?}"
        );
        assert!(!said.out.contains("proof") && !said.err.contains("proof"), "{said:?}");
        assert!(!folder.names().contains(&file.to_string()));
    }
    assert_eq!(post("my_part.src").code, 0);
}

const CALIBRATION: &str = "kinematics:\n  shoulder: # mm\n    x: 0\n    y: 0\n    z: 0.1626\n    roll: 0\n    pitch: 0\n    yaw: 0\n";

#[test]
fn descriptions_of_arms_are_imported_by_their_ending_and_nothing_is_saved_of_what_is_refused() {
    let folder = Folder::new();
    let refused = |words: &[&str], what: &str| {
        let said = folder.run(words);
        assert!(said.code == 2 && said.err.contains(what), "{words:?}: {said:?}");
        assert!(!folder.names().contains(&"mine.toml".to_string()));
    };
    folder.write("arm.urdf", "<robot/>");
    folder.write("calibration.yaml", CALIBRATION);
    refused(&["machines", "import", "arm.urdf", "-o", "mine.toml"], "there is no joint in it");
    refused(
        &["machines", "import", "arm.urdf", "-o", "mine.toml", "--extends", "ur5e"],
        "leave --extends out",
    );
    refused(
        &["machines", "import", "arm.urdf", "-o", "mine.toml", "--reach", "0"],
        "a number greater than 0 is needed",
    );
    refused(
        &["machines", "import", "calibration.yaml", "-o", "mine.toml"],
        "`x` of `upper_arm` is missing",
    );
    let words = ["machines", "import", "calibration.yaml", "-o", "mine.toml", "--reach", "850"];
    refused(&words, "--reach is for the description of an arm");
    let links = [
        "upper_arm:\n    x: 0\n    y: 0\n    z: 0\n    roll: 1.570796327\n    pitch: 0\n    yaw: 0",
        "forearm:\n    x: -0.425\n    y: 0\n    z: 0\n    roll: 0\n    pitch: 0\n    yaw: 0",
        "wrist_1:\n    x: -0.3922\n    y: 0\n    z: 0.1333\n    roll: 0\n    pitch: 0\n    yaw: 0",
        "wrist_2:\n    x: 0\n    y: -0.0997\n    z: 0\n    roll: 1.570796327\n    pitch: 0\n    yaw: 0",
        "wrist_3:\n    x: 0\n    y: 0.0996\n    z: 0\n    roll: 1.570796327\n    pitch: 3.141592654\n    yaw: 3.141592654",
    ];
    folder.write(
        "calibration.yaml",
        format!("{CALIBRATION}  {}\n  hash: calib_1\n", links.join("\n  ")),
    );
    let said = folder.run(&[
        "machines",
        "import",
        "calibration.yaml",
        "--extends",
        "ur5e",
        "-o",
        "mine.toml",
    ]);
    assert!(said.code == 0 && said.err.contains("mm from `ur5e`"), "{said:?}");
    let said = folder.run(&["machines", "check", "mine.toml"]);
    assert!(said.code == 0 && said.out.contains("as the factory has measured them"), "{said:?}");
}

/// As a mill that cannot make a toolpath: exit code 1, and nothing is saved.
#[test]
fn what_a_robot_cannot_do_is_no_wrong_input() {
    let folder = Folder::new();
    let job = |feed: &str| {
        format!(
            "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,{feed}\nGOTO/0,0,-2\nGOTO/60,0,-2\nRAPID\n\
             GOTO/60,0,50\nFINI\n"
        )
    };
    // A feed between two tenths of inch/min.
    folder.write("slow.cls", job("6.6"));
    folder.write("good.cls", job("300"));
    for (file, robot, code, what) in [
        ("slow.cls", "fanuc-lrmate-200id-mill", 1, "5.08 or 7.62 mm/min in the source"),
        ("good.cls", "fanuc-lrmate-200id-mill", 0, ""),
    ] {
        let said = folder.run(&["post", file, "--machine", robot, "-o", "out.txt"]);
        assert!(said.code == code && said.err.contains(what), "{file}: {said:?}");
    }
}

/// A program that begins by rapid in the plane of its cuts: from home the tool comes down to it along its own axis.
#[test]
fn a_rapid_from_home_into_the_plane_of_the_cuts_is_proven() {
    let folder = Folder::new();
    let sector = "%\nO0001\nG21\nG17 G40 G90 G94\nG0 X0. Y0. Z0.\nG1 X40. Y0. F60\nG3 X0. Y40. R40.\nG1 X0. Y0.\nM30\n%\n";
    folder.write("sector.nc", sector);
    for robot in ["kuka-kr6-r900", "universal-ur5e", "fanuc-lrmate-200id-mill", "abb-irb120-mill"] {
        let said = folder.run(&[
            "post",
            "sector.nc",
            "--from",
            "fanuc-31i",
            "--machine",
            robot,
            "-o",
            "out.txt",
        ]);
        assert_eq!(said.code, 0, "{robot}: {said:?}");
    }
}

/// Four rows with a retract behind each.
fn rows() -> String {
    let mut text =
        String::from("PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nFEDRAT/MMPM,1200\n");
    for y in [0, 10, 20, 30] {
        text += &format!("RAPID\nGOTO/0,{y},30\nGOTO/0,{y},-1\n");
        for x in 1..=10 {
            text += &format!("GOTO/{},{y},{}\n", 6 * x, -1 - x % 2);
        }
        text += &format!("RAPID\nGOTO/60,{y},30\n");
    }
    text + "FINI\n"
}

#[test]
fn a_program_in_several_files_is_saved_whole_or_not_at_all_and_proven_from_its_folder() {
    let folder = Folder::new();
    folder.write("rows.cls", rows());
    let own = "extends = \"fanuc-lrmate-200id-mill\"\n[capabilities]\nprogram_lines = 42\n";
    folder.write("own.toml", own);
    let post = ["post", "rows.cls", "--machine", "own.toml", "-o", "rows-a.ls"];
    // A file of that name that may not be written: nothing is saved.
    std::fs::create_dir(folder.path().join("rows_a_3.ls")).unwrap();
    let before = folder.names();
    assert_eq!(folder.run(&post).code, 2);
    assert_eq!(folder.names(), before);
    std::fs::remove_dir(folder.path().join("rows_a_3.ls")).unwrap();
    let said = folder.run(&post);
    assert_eq!(said.code, 0, "{said:?}");
    let parts = ["rows_a_1.ls", "rows_a_2.ls", "rows_a_3.ls", "rows_a_4.ls"];
    let mut names = vec!["own.toml", "part.cls", "rows-a.ls", "rows-a.ls.report.json", "rows.cls"];
    names.extend(parts);
    names.sort_unstable();
    let mut saved = folder.names();
    saved.sort_unstable();
    assert_eq!(saved, names);
    let size: usize = parts.iter().map(|part| folder.read(part).len()).sum();
    let size = size + folder.read("rows-a.ls").len();
    let text =
        format!("files           5 of {size} bytes together: the main program calls 4 parts");
    assert!(said.out.contains(&text), "{text}\n{}", said.out);
    assert!(folder.read("rows-a.ls").contains("/PROG ROWS_A\r\n"));
    let prove = ["prove", "rows-a.ls", "--machine", "own.toml", "--against", "rows.cls"];
    let said = folder.run(&prove);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("belongs to this program"), "{}", said.out);
    // The summary counts the lines of all files, and names the file of a line.
    let lines: usize =
        parts.iter().chain(&["rows-a.ls"]).map(|name| folder.read(name).lines().count()).sum();
    assert!(said.out.contains(&format!("program         {lines} blocks")), "{lines} {}", said.out);
    assert!(said.out.contains("at most (rows_a_"), "{}", said.out);
    // Another program whose parts would have the same names takes none of them.
    let other = ["post", "rows.cls", "--machine", "own.toml", "-o", "rows_a.ls"];
    let said = folder.run(&other);
    assert!(said.code == 2 && said.err.contains("rows_a_1.ls: error[output-file]"), "{said:?}");
    assert_eq!(folder.names().len(), names.len());
    // Nor does a program take the place of a part.
    folder.write("own-one.toml", "extends = \"fanuc-lrmate-200id-mill\"\n");
    let whole = |output| ["post", "rows.cls", "--machine", "own-one.toml", "-o", output];
    let said = folder.run(&whole("rows_a_1.ls"));
    assert!(said.code == 2 && said.err.contains("a part of the program of rows-a.ls"), "{said:?}");
    // Written in one file, its parts stay, and that is told.
    let said = folder.run(&whole("rows-a.ls"));
    assert!(
        said.code == 0
            && said
                .err
                .contains("rows_a_1.ls, rows_a_2.ls, rows_a_3.ls, rows_a_4.ls of the program"),
        "{said:?}"
    );
    assert_eq!(folder.names().len(), names.len() + 1);
    for part in parts {
        std::fs::remove_file(folder.path().join(part)).unwrap();
    }
    assert_eq!(folder.run(&post).code, 0);
    // A digit of a part: the proof refuses it; a remark: the report is of another program.
    let third = folder.read("rows_a_3.ls");
    folder.write("rows_a_3.ls", third.replacen("TOOLPOST", "TOOLPOSE", 1));
    let said = folder.run(&prove);
    assert!(said.code == 0 && said.err.contains("report-pair"), "{said:?}");
    folder.write("rows_a_3.ls", third.replacen("Z = -2.000", "Z = -3.000", 1));
    let said = folder.run(&prove);
    // The part, and the line and the text in it, that leads to the position.
    let line =
        1 + third.lines().position(|line| line.ends_with(":L P[3] 120cm/min FINE ;")).unwrap();
    let place = format!("rows_a_3.ls:{line}: error[path]");
    assert!(said.code == 1 && said.err.contains(&place), "{place}: {said:?}");
    assert!(said.err.contains(":L P[3] 120cm/min FINE ;"), "{said:?}");
    std::fs::remove_file(folder.path().join("rows_a_3.ls")).unwrap();
    let said = folder.run(&prove);
    assert!(said.code == 1 && said.err.contains("called-program"), "{said:?}");
}
