//! Every command: what it says, on which stream, with which exit code.

use crate::folder::{Folder, MACHINE, SOURCE};
use serde_json::json;

#[test]
fn a_summary_tells_tools_lengths_extents_and_proof() {
    let said = Folder::new().post();
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    // Cut: 7 mm down, 40 mm, 30 mm; rapid: 45 mm down, 52 mm up.
    for line in [
        "toolpath       part.cls (ISO 4343)",
        "tools          T1  cuts 77.0 mm",
        "moves          3 lines, 0 arcs, 0 holes, 3 rapids",
        "rapid          97.0 mm",
        "X              0 ... 40 mm (40)",
        "Z              -2 ... 50 mm (52)",
        "travel         not checked: the machine file gives no travel",
        "saved          out.mpf",
    ] {
        assert!(said.out.contains(line), "{line} is missing in\n{}", said.out);
    }
}

/// Whoever asks for silence still has to know on what the program rests.
#[test]
fn quiet_still_says_that_the_unit_was_guessed() {
    let folder = Folder::new();
    folder.write("no-unit.cls", "LOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/1,2,3\nFINI\n");
    let said = folder.run(&["post", "no-unit.cls", "-m", MACHINE, "-o", "out.mpf", "--quiet"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.err.contains("read as mm") && said.out.is_empty(), "{said:?}");
}

#[test]
fn quiet_says_nothing_when_all_is_well() {
    let folder = Folder::new();
    folder.write("part.cls", SOURCE.replace("COOLNT/ON", "NEVERHEARD/1"));
    let arguments = ["post", "part.cls", "-m", MACHINE, "-o", "out.mpf", "--quiet"];
    let said = folder.run(&arguments);
    assert_eq!((said.code, said.out.as_str(), said.err.as_str()), (0, "", ""));
}

#[test]
fn strict_takes_a_warning_as_an_error() {
    let folder = Folder::new();
    folder.write("part.cls", SOURCE.replace("COOLNT/ON", "NEVERHEARD/1"));
    let said = folder.post();
    assert_eq!(said.code, 0);
    assert!(said.err.contains("part.cls:5:") && said.err.contains("warning["), "{said:?}");
    let said = folder.run(&["post", "part.cls", "--strict", "-m", MACHINE, "-o", "strict.mpf"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("part.cls:5:") && said.err.contains("error["), "{said:?}");
}

#[test]
fn json_is_one_object_with_status_and_findings() {
    let folder = Folder::new();
    let said = folder.run(&["post", "part.cls", "-m", MACHINE, "-o", "out.mpf", "--json"]);
    let answer = said.json();
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    assert_eq!(answer["status"], "done");
    assert_eq!(answer["source"]["file"], "part.cls");
    assert_eq!(answer["source"]["measures"]["cutting_length"], 77.0);
    assert_eq!(answer["machine"]["name"], MACHINE);
    assert_eq!(answer["proof"]["proven"], true);
    assert_eq!((&answer["errors"], &answer["warnings"]), (&json!([]), &json!([])));

    folder.write("part.cls", SOURCE.replace("GOTO/40,0,-2", "GOTO/40,abc,-2"));
    let said = folder.run(&["--json", "post", "part.cls", "-m", MACHINE, "-o", "out.mpf"]);
    let answer = said.json();
    assert_eq!((said.code, said.err.as_str()), (2, ""));
    assert_eq!(answer["status"], "invalid");
    assert_eq!(answer["errors"][0]["file"], "part.cls");
    assert_eq!(answer["errors"][0]["line"], 12);
}

#[test]
fn a_wrong_command_line_is_answered_in_json_too() {
    let folder = Folder::new();
    let said = folder.run(&["--json", "post", "part.cls"]);
    let answer = said.json();
    assert_eq!((said.code, said.err.as_str()), (2, ""), "{said:?}");
    assert_eq!(
        (&answer["status"], &answer["errors"][0]["rule"]),
        (&json!("invalid"), &json!("argument"))
    );
    let message = answer["errors"][0]["message"].as_str().unwrap();
    assert!(
        message.contains("--machine <NAME|FILE>") && message.contains("--output <FILE>"),
        "{message}"
    );
    // Help is asked for, and is no mistake.
    let said = folder.run(&["--json", "post", "--help"]);
    assert!(said.code == 0 && said.out.contains("Usage: toolpost post"), "{said:?}");
}

#[test]
fn what_another_command_makes_programs_of_is_sent_there() {
    let folder = Folder::empty();
    let sources = [
        ("lamp.kicad_pcb", "toolpost pcb"),
        ("b-F_Cu.gbr", "toolpost pcb"),
        ("ball.stl", "toolpost glass"),
    ];
    for (file, command) in sources {
        folder.write(file, "(kicad_pcb (version 20240108))");
        let said = folder.run(&["post", file, "-m", MACHINE, "-o", "out.mpf"]);
        assert!(said.code == 2 && said.err.contains(&format!("`{command}`")), "{said:?}");
    }
}

#[test]
fn a_damaged_program_is_shown_with_its_source() {
    let folder = Folder::new();
    assert_eq!(folder.post().code, 0);
    let prove = ["prove", "out.mpf", "-m", MACHINE, "--against", "part.cls"];
    let said = folder.run(&prove);
    assert_eq!(said.code, 0, "{said:?}");

    let program = folder.read("out.mpf");
    assert_eq!(program.matches("Y30").count(), 1, "{program}");
    folder.write("out.mpf", program.replace("Y30", "Y31"));
    let said = folder.run(&prove);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.out.contains("source says   part.cls:13  GOTO/40,30,-2"), "{}", said.out);
    assert!(said.out.contains("Y31"), "{}", said.out);
    assert_eq!(folder.run(&[&prove[..], &["--json"]].concat()).json()["status"], "failed");
    // A wider tolerance is for the user to ask for.
    assert_eq!(folder.run(&[&prove[..], &["--tolerance", "1.5"]].concat()).code, 0);
}

#[test]
fn show_counts_and_draws_the_same_picture_every_time() {
    let folder = Folder::new();
    let said = folder.run(&["show", "part.cls", "-o", "a.svg"]);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    assert!(said.out.contains("cutting   77.0 mm"), "{}", said.out);
    assert_eq!(folder.run(&["show", "part.cls", "-o", "b.svg"]).code, 0);
    assert_eq!(folder.run(&["show", "part.cls", "-o", "c.png"]).code, 0);
    let svg = folder.read("a.svg");
    assert_eq!(svg, folder.read("b.svg"));
    assert!(svg.starts_with("<svg") && svg.contains("stroke-dasharray"), "{svg}");
    let png = std::fs::read(folder.path().join("c.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
    assert_eq!(folder.run(&["show", "part.cls", "-o", "d.gif"]).code, 2);
    let said = folder.run(&["show", "part.cls", "--frame", "machine", "-o", "d.svg"]);
    assert!(
        said.code == 2 && said.err.contains("machine-frame") && said.err.contains("--from"),
        "{}",
        said.err
    );
    assert_eq!(folder.names(), ["a.svg", "b.svg", "c.png", "part.cls"]);
}

#[test]
fn every_machine_of_the_library_is_listed_and_has_no_mistake() {
    let folder = Folder::new();
    let listed = folder.run(&["machines", "list", "--json"]).json();
    let machines = listed["machines"].as_array().unwrap();
    for name in ["sinumerik-840d-table-ac", "sinumerik-840d-traori", "dmu50-heidenhain"] {
        assert!(machines.iter().any(|machine| machine["name"] == name), "{name}");
    }
    let listed = folder.run(&["machines", "list"]).out;
    assert!(listed.contains("\ncontrols,") && listed.contains("\ngrbl "), "{listed}");
    let row = |name: &str| listed.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(row("grbl-3018").ends_with("XYZ, 300 x 180 x 45 mm, post"), "{listed}");
    assert!(row("fanuc-table-bc").contains("XYZBC, 850 x 700 x 800 mm, post"), "{listed}");
    assert!(row("bp-95d").ends_with(", wire"), "{listed}");
    assert!(row("generic-3axis-fanuc").contains("no travel stated"), "{listed}");
    for machine in machines {
        let said = folder.run(&["machines", "check", machine["name"].as_str().unwrap()]);
        assert_eq!(said.code, 0, "{said:?}");
    }
}

/// The lines that a copy of a machine of the library has besides, but its title.
fn offered(folder: &Folder, machine: &str) -> (String, Vec<String>) {
    assert_eq!(folder.run(&["machines", "new", "mine", "--from", machine]).code, 0);
    let (copy, shown) = (folder.read("mine.toml"), folder.run(&["machines", "show", machine]).out);
    let title = |text: &str| {
        text.lines().find_map(|line| line.strip_prefix("title = \"")).unwrap().to_owned()
    };
    assert_eq!(title(&copy), format!("mine: {}", title(&shown)));
    let own: Vec<&str> = shown.lines().collect();
    let is_added = |line: &&str| !own.contains(line) && !line.starts_with("title");
    let added: Vec<String> = copy.lines().filter(is_added).map(String::from).collect();
    // What it may state besides is there as comments, below headers of tables that it did not have.
    let is_quiet = |line: &String| line.is_empty() || line.starts_with(['#', '[']);
    assert!(added.iter().all(is_quiet), "{added:?}");
    (copy, added)
}

/// The keys of a copy are taken where they stand: without each `#`.
fn takes_all(folder: &Folder, copy: &str, added: &[String]) {
    let bare = |line: &str| match line.strip_prefix("# ").filter(|_| line.contains(" = ")) {
        Some(key) if added.iter().any(|added| added == line) => key.to_owned(),
        _ => line.to_owned(),
    };
    let text: Vec<String> = copy.lines().map(bare).collect();
    assert_ne!(text.join("\n"), copy.trim_end());
    folder.write("keys.toml", text.join("\n"));
    let said = folder.run(&["machines", "check", "keys.toml"]);
    assert_eq!(said.code, 0, "{said:?}");
}

#[test]
fn a_robot_of_ones_own_is_told_the_keys_of_its_cell() {
    let folder = Folder::new();
    let (copy, added) = offered(&folder, "kuka-kr120-rail");
    let cell = &copy[copy.find("[cell]").unwrap()..copy.find("[cell.rail]").unwrap()];
    for key in ["# reentry_feed = ", "# cable_joint_4 = ", "# load_mass = ", "# load_center = "] {
        assert!(cell.contains(key), "{key}\n{copy}");
    }
    takes_all(&folder, &copy, &added);
}

#[test]
fn a_machine_of_ones_own_starts_as_a_copy() {
    let folder = Folder::new();
    let (copy, added) = offered(&folder, MACHINE);
    let top = &copy[..copy.find("\n[").unwrap()];
    assert!(top.contains("# work_zero = ") && top.contains("mm/min"), "{copy}");
    // A table that is there is not offered again.
    assert!(["[axes]", "[spindle]"].iter().all(|table| copy.matches(table).count() == 1), "{copy}");
    takes_all(&folder, &copy, &added);
    assert_eq!(folder.run(&["machines", "check", "mine.toml"]).code, 0);
    let said = folder.run(&["machines", "new", "mine", "--from", MACHINE]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("there is such a file already"), "{said:?}");
    assert_eq!(folder.run(&["machines", "new", "other", "--from", "mine.toml"]).code, 0);
    let title = |file: &str| {
        folder.read(file).lines().find(|line| line.starts_with("title")).map(String::from)
    };
    assert_eq!(title("other.toml"), title("mine.toml").map(|title| title.replace("mine", "other")));
    let said = folder.run(&["post", "part.cls", "-m", "other.toml", "-o", "out.mpf"]);
    assert_eq!(said.code, 0, "{said:?}");
    for name in ["../mine", "", "a/b", ".hidden", "/tmp/x"] {
        let said = folder.run(&["machines", "new", name, "--from", MACHINE]);
        assert_eq!(said.code, 2, "{name}");
        assert!(said.err.contains("machine-name"), "{said:?}");
    }
}

#[test]
fn a_check_says_what_it_leaves_open() {
    let folder = Folder::new();
    let check = |name: &str| folder.run(&["machines", "check", name]).out;
    assert!(check("generic-3axis-fanuc").contains("no min or no max"));
    assert!(check("grbl-3018").contains("work_zero is missing"));
    let stated = check("haas-umc-750");
    assert!(!stated.contains("work_zero") && stated.contains("read it"), "{stated}");
}

/// A number for which the control has another use switches no coolant: it opens a brake, changes the tool, jumps.
#[test]
fn a_check_refuses_coolant_by_a_function_of_the_control() {
    let folder = Folder::new();
    for (base, number) in [
        ("generic-3axis-haas", 11),
        ("generic-3axis-haas", 16),
        ("generic-3axis-haas", 96),
        ("generic-3axis-fanuc", 98),
        ("generic-3axis-fanuc", 198),
        ("generic-3axis-sinumerik", 17),
        ("generic-3axis-sinumerik", 70),
        ("generic-3axis-heidenhain", 91),
        ("generic-3axis-marlin", 112),
    ] {
        let text = format!("extends = \"{base}\"\n[coolant]\nflood = {number}\n");
        folder.write("own.toml", text);
        let said = folder.run(&["machines", "check", "own.toml"]);
        assert_eq!(said.code, 2, "{base} {number}: {said:?}");
        assert!(said.err.contains(&format!("M{number} is a function of the control")), "{said:?}");
    }
    let own = "extends = \"generic-3axis-haas\"\n[coolant]\nflood = 51\n";
    folder.write("own.toml", own);
    assert_eq!(folder.run(&["machines", "check", "own.toml"]).code, 0);
}

#[test]
fn a_mistyped_machine_brings_the_nearest_alone() {
    let folder = Folder::new();
    let said = folder.run(&["post", "part.cls", "-m", "generic-3axis-fanuk", "-o", "out.nc"]);
    assert!(said.err.contains("did you mean `generic-3axis-fanuc`"), "{said:?}");
    assert!(!said.err.contains("marlin"), "{said:?}");
}

#[test]
fn a_machine_that_is_not_there_is_refused_with_those_that_are() {
    let folder = Folder::new();
    for arguments in [
        &["machines", "show", "nonesuch"][..],
        &["machines", "new", "mine", "--from", "nonesuch"],
        &["machines", "check", "nonesuch"],
        &["post", "part.cls", "-m", "nonesuch", "-o", "out.mpf"],
    ] {
        let said = folder.run(arguments);
        assert_eq!(said.code, 2, "{said:?}");
        assert!(said.err.contains("nonesuch") && said.err.contains(MACHINE), "{said:?}");
    }
}

#[test]
fn a_control_in_place_of_a_machine_is_refused_with_the_machines_that_build_on_it() {
    let folder = Folder::new();
    let said = folder.run(&["post", "part.cls", "-m", "grbl", "-o", "out.mpf"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("`grbl` is a control, not a machine"), "{said:?}");
    assert!(said.err.contains("generic-3axis-grbl") && !said.err.contains("fanuc"), "{said:?}");
    // 828D extends 840D: its machines build on both.
    let said = folder.run(&["machines", "check", "sinumerik-840d"]);
    assert!(said.err.contains("emco-concept-mill-105"), "{said:?}");
}

#[test]
fn explain_gives_unit_and_help_of_every_name() {
    let folder = Folder::new();
    let one = folder.run(&["explain", "f"]);
    assert_eq!(one.code, 0);
    assert!(one.out.starts_with('F') && one.out.contains("mm/min"), "{one:?}");
    let all = folder.run(&["explain", "--json"]).json();
    let names = all["names"].as_array().unwrap();
    assert!(names.len() > 30);
    assert!(names.iter().all(|name| name["help"].as_str().is_some_and(|help| !help.is_empty())));
    assert_eq!(folder.run(&["explain", "nonesuch"]).code, 2);
    // Of a block it says what each control writes that has it: GRBL tilts no plane.
    let flood = folder.run(&["explain", "coolant_flood"]).out;
    assert!(flood.contains("\nfanuc-31i\n    {{N}} M8\n"), "{flood}");
    let tilt = folder.run(&["explain", "plane_tilt"]).out;
    assert!(tilt.contains("\nfanuc-31i\n") && !tilt.contains("\ngrbl\n"), "{tilt}");
    // The keys of the files too: each table that has one of the name, with its own unit.
    // A key of another table has the name of the block.
    let change = folder.run(&["explain", "tool_change"]).out;
    assert!(change.contains("cell.tool_change") && change.contains("{{N}} {{T}} M6"), "{change}");
    // Options of the controls, with what each of them states.
    let tolerance = folder.run(&["explain", "path_tolerance"]).out;
    for said in ["T of cycle 32", "heidenhain-tnc640: 0.01", "(G187 E)", "haas: 0.01", "krl: 0.05"]
    {
        assert!(tolerance.contains(said), "{said}: {tolerance}");
    }
    for option in ["preselect_tools", "stop_between_tools", "hsc_mode", "tcpm", "swivel_data"] {
        let one = folder.run(&["explain", option]);
        assert!(one.code == 0 && one.out.contains(&format!("options.{option}")), "{one:?}");
    }
    let min = folder.run(&["explain", "min"]).out;
    for (key, help) in
        [("axes.X.min ", "Lower end of"), ("rotary.min ", "Lower"), ("spindle.min ", "The slowest")]
    {
        let row = min.lines().find(|row| row.starts_with(key)).unwrap_or_default();
        assert!(row[key.len()..].trim_start().starts_with(help), "{key}: {min}");
    }
    assert!(min.contains("(degrees)") && min.contains("(mm)") && min.contains("(1/min)"), "{min}");
    for key in ["decimals", "trim", "lowering_tolerance", "prefer", "rapid", "work_zero"] {
        assert_eq!(folder.run(&["explain", key]).code, 0, "{key}");
    }
    assert_eq!(folder.run(&["explain", "orientation.simultaneous"]).out.lines().count(), 1);
}

#[test]
fn completions_are_there_for_the_usual_shells() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let said = Folder::new().run(&["completions", shell]);
        assert_eq!(said.code, 0);
        assert!(said.out.contains("machines"), "{shell}");
    }
}

#[test]
fn a_wrong_call_is_a_mistake_of_usage() {
    let folder = Folder::new();
    for arguments in [
        &[][..],
        &["nonesuch"],
        &["post", "part.cls"],
        &["post", "part.cls", "-m", MACHINE, "-o", "out.mpf", "--tolerance", "0"],
        &["post", "part.cls", "-m", MACHINE, "-o", "out.mpf", "--tolerance", "nan"],
        &["post", "part.cls", "-m", MACHINE, "-o", "out.mpf", "--tolerance", "1e9"],
        &["completions", "nonesuch"],
    ] {
        let said = folder.run(arguments);
        assert_eq!(said.code, 2, "{arguments:?}");
        assert!(!said.err.is_empty() && said.out.is_empty());
    }
    assert_eq!(folder.run(&["--help"]).code, 0);
    assert_eq!(folder.run(&["--version"]).code, 0);
}

/// Two set-ups whose origins are 60 mm apart: in the world their holes lie apart, in the frame of each at the same place.
#[test]
fn the_summary_says_in_which_frame_set_ups_are_read_and_why() {
    let folder = Folder::new();
    let set_up = |origin: u32, x: u32| {
        format!(
            "TRNTYP/WORLD,0,0,0\nCSYS/1,0,0,{origin},0,1,0,0,0,0,1,0\nGOTO/{x},5,0\nGOTO/{},5,0\n",
            x + 20
        )
    };
    let head = "UNITS/MM\nLOADTL/1\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/10,5,20\n";
    let cycle = "CYCLE/DRILL,FEDTO,5,RAPTO,2,MMPM,100\n";
    let text = format!("{head}{cycle}{}{}CYCLE/OFF\nFINI\n", set_up(0, 10), set_up(60, 70));
    folder.write("two.apt", text);
    let said = folder.run(&["show", "two.apt"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("read in the world, as TRNTYP/WORLD says"), "{}", said.out);
    assert!(said.out.contains("10 ... 90 mm"), "{}", said.out);
    let said = folder.run(&["show", "two.apt", "--csys", "local"]);
    assert!(said.out.contains("read in the frame of each CSYS, as --csys says"), "{}", said.out);
    assert!(said.out.contains("10 ... 150 mm"), "{}", said.out);
    let post = ["post", "two.apt", "-m", MACHINE, "-o", "two.mpf", "--json"];
    let answer = folder.run(&post).json();
    let expected =
        serde_json::json!({ "csys": "world", "said_by": "TRNTYP/WORLD", "changes_of_origin": 1 });
    assert_eq!(answer["source"]["set_ups"], expected, "{answer}");
    // A file without the record has no use for the option.
    let said = folder.run(&["show", "part.cls", "--csys", "world"]);
    assert!(said.code == 2 && said.err.contains("no CSYS"), "{said:?}");
}

/// What a file does not say on which programs hang: all at once, as lines to add.
#[test]
fn a_machine_file_that_is_older_than_a_key_is_refused_with_the_line_to_add() {
    let folder = Folder::new();
    let rotary = "[[rotary]]\nletter = \"C\"\non = \"table\"\naxis = [0, 0, 1]\nrapid = 9000\nacceleration = 300\n";
    let old = format!(
        "extends = \"sinumerik-840d\"\n[orientation]\nsimultaneous = \"machine-angles\"\n{rotary}"
    );
    folder.write("old.toml", &old);
    let said = folder.run(&["machines", "check", "--upgrade", "old.toml"]);
    assert_eq!(said.code, 0, "{said:?}");
    for line in [
        "safe_height = 0",
        "work_zero = [0, 0, 0]",
        "length_along_z = false",
        "tool_radius = \"full\"",
        "point = [0, 0, 0]",
        "modulo = true",
    ] {
        assert!(said.out.contains(&format!("\n{line}\n")), "{line}: {}", said.out);
    }
    let linuxcnc = format!(
        "extends = \"linuxcnc\"\n[orientation]\nsimultaneous = \"tool-center-angles\"\n{rotary}"
    );
    // What is printed is the whole file, which takes the place of the old one.
    assert!(said.out.contains("an example: write the value of your machine)\nsafe_height = 0\n"));
    assert!(said.out.contains("as delivered: read it on yours)\nlength_along_z = false\n"));
    folder.write("upgraded.toml", &said.out);
    let again = folder.run(&["machines", "check", "--upgrade", "upgraded.toml"]);
    assert_eq!((again.code, again.out.as_str()), (0, "nothing is missing\n"), "{}", said.out);
    folder.write("settings.toml", format!("{old}[settings] # ours\ntool_radius = \"wear\"\n"));
    let said = folder.run(&["machines", "check", "--upgrade", "settings.toml"]);
    assert_eq!(said.out.matches("[settings]").count(), 1, "{}", said.out);
    folder.write("upgraded.toml", &said.out);
    assert_eq!(folder.run(&["machines", "check", "upgraded.toml"]).code, 0, "{}", said.out);
    folder.write("linuxcnc.toml", &linuxcnc);
    let said = folder.run(&["machines", "check", "--upgrade", "linuxcnc.toml"]);
    assert!(said.out.contains("\ntip_kinematics = 428\n"), "{}", said.out);
    assert!(said.out.contains("\naxis_kinematics = 429\n"), "{}", said.out);
    let new = format!(
        "extends = \"sinumerik-840d\"\nsafe_height = 0\nwork_zero = [0, 0, 0]\n[settings]\n\
         length_along_z = false\ntool_radius = \"full\"\n[orientation]\nsimultaneous = \"machine-angles\"\n{rotary}point = [0, 0, 0]\nmodulo = true\n"
    );
    folder.write("new.toml", &new);
    let said = folder.run(&["machines", "check", "--upgrade", "new.toml"]);
    assert_eq!((said.code, said.out.as_str()), (0, "nothing is missing\n"));
}

/// Each run named the first only.
#[test]
fn every_mistake_of_a_machine_file_is_named_in_one_run() {
    let folder = Folder::new();
    let text = "extends = \"fanuc-31i\"\nfeed_maxx = 3\n[axes]\nX = { min = 10, max = -10 }\nY = { rapid = 0 }\n\
                [spindle]\nmax = \"fast\"\n[blocks]\ndwell = \"\"\"\n{{N}} G4 {{DWEL}}\n\"\"\"\ncoolant_flood = \"{{N}} M8\"\n";
    folder.write("mine.toml", text);
    let said = folder.run(&["machines", "check", "mine.toml"]);
    assert_eq!(said.code, 2, "{said:?}");
    for place in ["2:1", "4:5", "5:15", "7:7", "10:12"] {
        assert!(said.err.contains(&format!("mine.toml:{place}: error[")), "{place}: {}", said.err);
    }
    assert_eq!(said.err.matches("error[").count(), 5, "{}", said.err);
}

#[test]
fn a_table_is_explained_with_its_keys() {
    let folder = Folder::new();
    let said = folder.run(&["explain", "axes"]);
    for key in ["axes.X.min", "axes.X.rapid", "axes.X.acceleration"] {
        assert!(said.out.contains(key), "{key}: {}", said.out);
    }
}

#[test]
fn of_an_argument_that_fills_the_terminal_the_start_is_printed() {
    let folder = Folder::new();
    let long = "x".repeat(300);
    for words in [
        vec!["wire", "part.cls", "-m", "bp-95d", "-o", "x.pts", "--step", &long[..]],
        vec!["wire", "part.cls", &long[..], "-m", "bp-95d", "-o", "x.pts"],
        vec![&long[..]],
    ] {
        let said = folder.run(&words);
        let shown = said.err.contains(&format!("{}...", &long[..80]));
        assert!(said.code == 2 && shown && !said.err.contains(&long[..81]), "{said:?}");
    }
}

#[test]
fn which_path_cutcom_means_is_asked_for_where_no_arc_shows_it() {
    let folder = Folder::new();
    let part = "UNITS/MM\nCUTTER/6,0\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,-9,5\nFEDRAT/300,MMPM\n\
                GOTO/0,-9,-1\nCUTCOM/LEFT\nGOTO/0,0,-1\nGOTO/30,0,-1\nCUTCOM/OFF\nGOTO/30,-9,-1\nRAPID\nGOTO/30,-9,5\nFINI\n";
    folder.write("part.apt", part);
    let post = |more: &[&str]| {
        let common = ["post", "part.apt", "-m", "generic-3axis-linuxcnc", "-o", "part.ngc"];
        folder.run(&[&common[..], more].concat())
    };
    let said = post(&[]);
    assert_eq!(said.code, 2, "{said:?}");
    assert!(
        said.err.contains("part.apt:9") && said.err.contains("`--cutcom centre`"),
        "{}",
        said.err
    );
    assert_eq!(post(&["--cutcom", "contour"]).code, 0);
    assert!(folder.read("part.ngc").contains("G41 D1"));
    let said = post(&["--cutcom", "centre"]);
    assert_eq!(said.code, 0);
    assert!(said.err.contains("written without radius compensation"), "{}", said.err);
    assert!(said.out.contains("the path of the tool's centre, as --cutcom says"), "{}", said.out);
    assert!(!folder.read("part.ngc").contains("G41"));
    // The program of the contour is no program of the centre.
    post(&["--cutcom", "contour"]);
    let prove = ["prove", "part.ngc", "-m", "generic-3axis-linuxcnc", "--against", "part.apt"];
    for (path, code) in [("contour", 0), ("centre", 1)] {
        assert_eq!(folder.run(&[&prove[..], &["--cutcom", path]].concat()).code, code, "{path}");
    }
}
