//! Bad input: a clear error that names file, line and rule; nothing saved.

use crate::folder::{Folder, MACHINE, SOURCE, Said};
use std::fs::File;
use std::io::Write;

/// Posts `source` with `machine` and expects an error of `rule` on `line` of it (0 for the whole file).
fn refused(source: impl AsRef<[u8]>, machine: &str, code: i32, line: u32, rule: &str) -> Said {
    let folder = Folder::new();
    folder.write("part.cls", source);
    let said = folder.run(&["post", "part.cls", "-m", machine, "-o", "out.mpf"]);
    assert_eq!(said.code, code, "{rule}: {said:?}");
    let place = if line > 0 { format!("part.cls:{line}:") } else { String::from("part.cls: ") };
    let found = said
        .err
        .lines()
        .any(|text| text.starts_with(&place) && text.contains(&format!("error[{rule}]")));
    assert!(found, "error[{rule}] on line {line} is missing in\n{}", said.err);
    assert_eq!(folder.names(), ["part.cls"]);
    said
}

/// [`SOURCE`] with its line `line` (from 1) replaced.
fn with_line(line: usize, text: &str) -> String {
    let lines = SOURCE.lines().enumerate();
    lines.map(|(i, old)| format!("{}\n", if i + 1 == line { text } else { old })).collect()
}

#[test]
fn a_file_that_is_no_toolpath() {
    refused("", MACHINE, 2, 0, "not-cldata");
    let binary: Vec<u8> =
        (0..4096u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let folder = Folder::new();
    folder.write("part.cls", binary);
    let said = folder.post();
    assert_eq!((said.code, said.err.contains("part.cls:")), (2, true), "{said:?}");
    assert_eq!(folder.names(), ["part.cls"]);
}

#[test]
fn a_file_that_is_not_there() {
    let folder = Folder::new();
    for path in ["missing.cls", ".", "/dev/zero"] {
        let said = folder.run(&["post", path, "-m", MACHINE, "-o", "out.mpf"]);
        assert_eq!(said.code, 2);
        assert!(said.err.contains(&format!("{path}: error[unreadable]")), "{said:?}");
    }
}

#[test]
fn a_line_of_a_gigabyte() {
    let folder = Folder::new();
    // A sparse file: the gigabyte is NUL bytes, and takes no room on the disk.
    let mut file = File::create(folder.path().join("part.cls")).unwrap();
    file.write_all(b"UNITS/MM\nGOTO/1,2,").unwrap();
    file.set_len(1 << 30).unwrap();
    let said = folder.post();
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.err.contains("part.cls:2:"), "{said:?}");
    assert_eq!(folder.names(), ["part.cls"]);
}

#[test]
fn every_way_to_end_a_line_and_to_write_a_letter_makes_the_same_program() {
    let folder = Folder::new();
    assert_eq!(folder.post().code, 0);
    let program = folder.read("out.mpf");
    for end in ["\r\n", "\r", "\0\n"] {
        folder.write("part.cls", SOURCE.replace('\n', end));
        assert_eq!(folder.post().code, 0);
        assert_eq!(folder.read("out.mpf"), program);
    }
    let mut latin = b"$$ Kopf fr\xe4sen\n".to_vec();
    latin.extend(SOURCE.bytes());
    folder.write("part.cls", latin);
    let said = folder.post();
    assert_eq!(said.code, 0, "{said:?}");
}

#[test]
fn a_record_that_is_malformed_or_means_nothing() {
    for (line, text, at, rule) in [
        (7, "GOTO/0,0,50,0,0,0", 7, "zero-vector"),
        (12, "GOTO/40,NaN,-2", 12, "malformed"),
        (12, "GOTO/1e308,0,-2", 12, "out-of-range"),
        (2, "UNITS/PARSEC", 2, "unknown-unit"),
        (12, "CIRCLE/20,0,-2,0,0,1,20\nGOTO/41,0,-2", 13, "off-the-circle"),
        (12, "CYCLE/DRILL,FEDTO,10\nGOTO/40,0,-2", 12, "no-clear-plane"),
        (3, "LOAD/TOOL,0", 3, "tool-number"),
    ] {
        refused(with_line(line, text), MACHINE, 2, at, rule);
    }
    let no_end = SOURCE.replace("RAPID\nGOTO/40,30,50\n", "CIRCLE/40,20,-2,0,0,1,10\n");
    refused(no_end, MACHINE, 2, 15, "circle-without-goto");
    let truncated = &SOURCE[..SOURCE.find("30,-2").unwrap()];
    refused(truncated, MACHINE, 2, 13, "truncated");
}

#[test]
fn a_cut_that_no_machine_may_make() {
    // Feed 0, and a spindle that was never started: told at the first cut.
    refused(with_line(10, "FEDRAT/MMPM,0"), MACHINE, 2, 11, "no-feed");
    refused(with_line(4, "$$"), MACHINE, 2, 11, "spindle-off");
}

/// Said once, with what can be done; each of the moves was a finding without a way out.
#[test]
fn a_five_axis_toolpath_on_a_three_axis_machine_is_called_that() {
    let folder = Folder::new();
    let tilted = "GOTO/0,0,50,0,0,1\nRAPID\nGOTO/0,0,50,0,0.6,0.8\nRAPID\nGOTO/0,0,60,0.8,0,0.6\nRAPID\nGOTO/0,0,70,0,0,1";
    folder.write("part.cls", with_line(7, tilted));
    let said = folder.run(&["post", "part.cls", "-m", "generic-3axis-linuxcnc", "-o", "part.ngc"]);
    assert_eq!(said.code, 1, "{said:?}");
    // arccos 0.6
    let found = "part.cls:9: error[unreachable-orientation]: five-axis toolpath, three-axis machine: the toolpath \
                 tilts the tool by up to 53.130° from Z, and the machine has no rotary axes (2 times, first here)";
    assert!(said.err.contains(found), "{}", said.err);
    assert_eq!(said.err.matches("error[").count(), 1, "{}", said.err);
    let way_out = "= choose a machine with rotary axes, such as `linuxcnc-xyzac`, `linuxcnc-xyzbc-head`, `linuxcnc-xyzbc`, ";
    assert!(said.err.contains(way_out), "{}", said.err);
}

/// A line of `[words]` for each of them.
#[test]
fn many_like_findings_are_a_few_and_their_count() {
    let folder = Folder::new();
    let words: String = (0..20_000).map(|i| format!("WORD{i} = {{ decimals = 3 }}\n")).collect();
    let file = format!("extends = \"generic-3axis-linuxcnc\"\n[words]\n{words}");
    folder.write("mill.toml", file);
    let said = folder.run(&["machines", "check", "mill.toml"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert_eq!(said.err.matches("error[").count(), 3, "{}", said.err);
    assert!(said.err.contains("… and 19,997 more like this, at lines "), "{}", said.err);
    let said = folder.run(&["machines", "check", "mill.toml", "--json"]);
    let answer: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let counts: Vec<u64> =
        answer["errors"].as_array().unwrap().iter().map(|e| e["count"].as_u64().unwrap()).collect();
    assert_eq!(counts, [1, 1, 19_998]);
    assert_eq!(answer["errors"][2]["lines"].as_array().unwrap().len(), 5);
}

#[test]
fn an_orientation_out_of_reach() {
    let tilted = with_line(7, "GOTO/0,0,50,0,0,1\nRAPID\nGOTO/0,0,50,0,0.6,0.8");
    refused(&tilted, MACHINE, 1, 9, "unreachable-orientation");
    // A goes from -30 to 120 degrees there: upside down is out of reach.
    let under = with_line(7, "MULTAX/ON\nGOTO/0,0,50,0,0,-1");
    refused(under, "sinumerik-840d-table-ac", 1, 8, "axis-limit");
}

#[test]
fn a_limit_broken_by_a_micrometre() {
    // X travels 850 mm, and the work zero is not known: the part may be 850 mm long.
    let machine = "fanuc-table-bc";
    let folder = Folder::new();
    folder.write("part.cls", with_line(12, "GOTO/850,0,-2"));
    let said = folder.run(&["post", "part.cls", "-m", machine, "-o", "out.mpf"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(
        said.out.contains("travel      only stroke lengths checked; set work_zero"),
        "{said:?}"
    );
    refused(with_line(12, "GOTO/850.001,0,-2"), machine, 1, 12, "axis-limit");
}

#[test]
fn a_limit_in_machine_coordinates_broken_by_a_micrometre() {
    // The work zero stands 300 mm from the middle of a travel of 400 mm each way.
    let folder = Folder::new();
    let text = "extends = \"sinumerik-840d-table-ac\"\nwork_zero = [300, 0, 0]\n";
    folder.write("mine.toml", text);
    let post = ["post", "part.cls", "-m", "mine.toml", "-o", "out.mpf"];
    folder.write("part.cls", with_line(12, "GOTO/100.001,0,-2"));
    let said = folder.run(&post);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        said.err.contains("part.cls:12:") && said.err.contains("error[axis-limit]"),
        "{said:?}"
    );
    folder.write("part.cls", with_line(12, "GOTO/100,0,-2"));
    let said = folder.run(&post);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("travel      positions checked"), "{said:?}");
}

/// Checks and posts with a machine that extends [`MACHINE`] by `text`; both must refuse it at `place`.
fn machine_refused(text: &str, place: &str, rule: &str) {
    let folder = Folder::new();
    folder.write("mine.toml", format!("extends = \"{MACHINE}\"\ntitle = \"mine\"\n{text}"));
    for arguments in [
        &["machines", "check", "mine.toml"][..],
        &["post", "part.cls", "-m", "mine.toml", "-o", "out.mpf"],
    ] {
        let said = folder.run(arguments);
        assert_eq!(said.code, 2, "{text}: {said:?}");
        assert!(said.err.contains(&format!("mine.toml:{place}")), "{text}: {said:?}");
        assert!(said.err.contains(&format!("error[{rule}]")), "{text}: {said:?}");
    }
    assert_eq!(folder.names(), ["mine.toml", "part.cls"]);
}

#[test]
fn a_machine_file_with_a_mistake() {
    machine_refused("reader = \"nonesuch\"\n", "3:", "reader");
    machine_refused("colour = \"red\"\n", "3:1:", "machine-file");
    machine_refused("[blocks]\nlinear = \"{{N}} G1 {{XX}}\"\n", "4:", "template-name");
    machine_refused("[blocks]\nlinear = \"{{N} G1\"\n", "4:", "template");
}

#[test]
fn a_template_that_can_never_run() {
    for (template, rule) in [
        ("{% for a in range(999) %}{% for b in range(999) %}{% endfor %}{% endfor %}", "template"),
        ("{{ '%1000000000d'|format(1) }}", "template"),
        ("{% include '../../etc/passwd' %}", "template"),
        ("{{ tool.number / 0 }}", "template"),
        ("{{ tool.name|nonesuch }}", "template-name"),
        ("{{ options.default_tool ~ 'x' * 99999999 }}", "template-output"),
    ] {
        machine_refused(&format!("[blocks]\nprogram_start = \"{template}\"\n"), "4:", rule);
    }
}

#[test]
fn a_text_that_the_control_would_run() {
    let refused = |text, place| machine_refused(text, place, "template-comment");
    refused("[blocks]\ncomment = \"{{N}} {{ text }}\"\n", "4:21");
    refused("[blocks]\nmessage = '''\n; said\nMSG({{ text }})\n'''\n", "6:8");
    refused("[blocks]\noperation_start = \"{{ operation.name }} ; begins\"\n", "4:23");
}

#[cfg(unix)]
#[test]
fn a_machine_file_that_is_a_pipe_or_a_device_is_refused() {
    let folder = Folder::new();
    let pipe = folder.path().join("pipe.toml");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("endless.toml")).unwrap();
    folder.write("mine.toml", "extends = \"pipe.toml\"\n");
    for machine in ["pipe.toml", "endless.toml", "mine.toml"] {
        let said = folder.run(&["post", "part.cls", "-m", machine, "-o", "out.mpf"]);
        assert_eq!(said.code, 2, "{said:?}");
        assert!(said.err.contains("it is not a file"), "{said:?}");
    }
}

#[test]
fn a_machine_file_shows_nothing_of_files_outside_its_folder() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("theirs")).unwrap();
    let secret = "password = \"swordfish\"\n";
    folder.write("secret.txt", secret);
    folder.write("secret.toml", secret);
    #[cfg(unix)]
    std::os::unix::fs::symlink("../secret.txt", folder.path().join("theirs/link.toml")).unwrap();
    let absolute = folder.path().join("secret.txt").display().to_string();
    for outside in ["../secret.txt", "../secret.toml", "link.toml", &absolute] {
        folder.write("theirs/mill.toml", format!("extends = '{outside}'\n"));
        let said = folder.run(&["post", "part.cls", "-m", "theirs/mill.toml", "-o", "out.mpf"]);
        assert_eq!(said.code, 2, "{said:?}");
        let shown = format!("{}{}", said.out, said.err);
        assert!(!shown.contains("password") && !shown.contains("swordfish"), "{outside}: {shown}");
    }
    // A machine file of the shop's, in the folder above, is extended as before.
    folder.write("shop.toml", format!("extends = \"{MACHINE}\"\n"));
    folder.write("theirs/mill.toml", "extends = \"../shop.toml\"\n");
    let said = folder.run(&["post", "part.cls", "-m", "theirs/mill.toml", "-o", "out.mpf"]);
    assert_eq!(said.code, 0, "{said:?}");
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_text_and_utf_16_is_said() {
    let folder = Folder::new();
    let program =
        "G21 G17 G90 G94 G54\nT1 M6\nM3 S1000\nG43 H1\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM2\n";
    let nc = ["--from", "linuxcnc", "--tools", "tools.tbl"];
    for (name, text, options) in [("part.cls", SOURCE, &[][..]), ("part.ngc", program, &nc)] {
        let show = [&["show", name], options].concat();
        folder.write("tools.tbl", "\u{feff}T1 P1 D6 Z50\n");
        folder.write(name, format!("\u{feff}{text}"));
        let said = folder.run(&show);
        assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
        let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        for mark in [&[][..], &[0xff, 0xfe]] {
            folder.write(name, [mark, &wide].concat());
            let said = folder.run(&show);
            assert_eq!(said.code, 2, "{said:?}");
            assert!(said.err.contains("error[encoding]: this file is in UTF-16"), "{said:?}");
        }
    }
}

/// Every kind of text that is read: a file of `fuzz/seeds`, and what reads it.
const READERS: &[(&str, &str, &[&str])] = &[
    ("apt/nx.cls", "in.cls", &["show", "in.cls"]),
    ("iso/linuxcnc.nc", "in.ngc", &["show", "in.ngc", "--from", "linuxcnc"]),
    ("iso/fanuc-milling.nc", "in.nc", &["show", "in.nc", "--from", "fanuc-31i"]),
    ("sinumerik/style.mpf", "in.mpf", &["show", "in.mpf", "--from", "sinumerik-840d"]),
    ("klartext/milling.h", "in.h", &["show", "in.h", "--from", "heidenhain-tnc640"]),
    ("iso/grbl.nc", "in.nc", &["prove", "in.nc", "--against", "part.cls", "-m", "grbl-3018"]),
    ("freecad/bracket.json", "in.json", &["show", "in.json"]),
    ("excellon/holes.drl", "in.drl", &["pcb", "in.drl", "-m", "grbl-3018", "-o", "out"]),
    ("gerber/pads.gbr", "in.gtl", &["pcb", "in.gtl", "-m", "grbl-3018", "-o", "out"]),
    ("board/lamp.toml", "in.toml", &["pcb", "in.toml", "-m", "grbl-3018", "-o", "out"]),
    ("board/two-pins.json", "in.json", &["pcb", "in.json", "-m", "grbl-3018", "-o", "out"]),
    (
        "kicad/v9.kicad_pcb",
        "in.kicad_pcb",
        &["pcb", "in.kicad_pcb", "-m", "grbl-3018", "-o", "out"],
    ),
    (
        "levelling/table.txt",
        "in.txt",
        &[
            "pcb",
            "board.toml",
            "-m",
            "grbl-3018",
            "-o",
            "out",
            "--only",
            "front",
            "--heights",
            "in.txt",
        ],
    ),
    ("wire/lines.dxf", "in.dxf", &["wire", "in.dxf", "-m", "fanuc-wire", "-o", "out.nc"]),
    ("import/shop.pp", "in.pp", &["machines", "import", "in.pp", "-o", "mine.toml"]),
    ("../../machines/grbl-3018.toml", "in.toml", &["machines", "check", "in.toml"]),
    ("../../machines/grbl-3018.toml", "in.toml", &["machines", "new", "mine", "--from", "in.toml"]),
];

#[test]
fn every_reader_passes_over_a_byte_order_mark_and_explains_utf_16() {
    let seeds = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    for (seed, name, command) in READERS {
        let text = std::fs::read(seeds.join(seed)).unwrap();
        let run = |bytes: &[u8]| {
            let folder = Folder::new();
            let board = std::fs::read(seeds.join("board/lamp.toml")).unwrap();
            folder.write("board.toml", board);
            folder.write("part.cls", SOURCE);
            folder.write(name, bytes);
            folder.run(command)
        };
        let (plain, marked) = (run(&text), run(&[b"\xef\xbb\xbf", text.as_slice()].concat()));
        assert_eq!((plain.code, &plain.err), (marked.code, &marked.err), "{seed}: {command:?}");
        assert!(!plain.err.contains("UTF"), "{plain:?}");
        let units = || String::from_utf8_lossy(&text).encode_utf16().collect::<Vec<_>>();
        let little: Vec<u8> = units().into_iter().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().into_iter().flat_map(u16::to_be_bytes).collect();
        for wide in
            [[&[0xff, 0xfe], &little[..]].concat(), [&[0xfe, 0xff], &big[..]].concat(), little]
        {
            let said = run(&wide);
            let explained = said.err.contains("this file is in UTF-16") && said.err.contains(name);
            assert!(said.code != 0 && explained, "{seed}: {command:?}\n{said:?}");
        }
    }
}
