//! Bad input: a clear error that names file, line and rule; nothing saved.

use crate::folder::{Folder, MACHINE, SOURCE, Said};
use std::fs::File;
use std::io::Write;
use std::time::{Duration, Instant};

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
    // Feed 0, and a spindle that was never started: reported at the first cut.
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
    let command = ["post", "part.cls", "-m", "generic-3axis-linuxcnc", "-o", "part.ngc", "--json"];
    let answer: serde_json::Value = serde_json::from_str(&folder.run(&command).out).unwrap();
    assert_eq!(answer["errors"][0]["places"], serde_json::json!([11]));
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
    // Words are looked at by their names, WORD0 stands on line 3. The third stands for all others, of which the first ten thousand are listed.
    let mut words: Vec<(String, u64)> = (0..20_000).map(|i| (format!("WORD{i}"), i + 3)).collect();
    words.sort();
    let lines: Vec<u64> = words.into_iter().map(|(_, line)| line).collect();
    let places = answer["errors"][2]["places"].as_array().unwrap();
    let places: Vec<u64> = places.iter().map(|line| line.as_u64().unwrap()).collect();
    assert_eq!((answer["errors"][2]["line"].as_u64(), &places[..]), (Some(13), &lines[3..10_003]));
    assert!(answer["errors"][1].get("places").is_none());
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
        said.out.contains("travel         only stroke lengths checked; set work_zero"),
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
    assert!(said.out.contains("travel         positions checked"), "{said:?}");
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

/// Each would take minutes if every key were compared with every other.
#[test]
fn a_machine_file_with_very_many_unknown_names_is_refused_in_linear_time() {
    let folder = Folder::new();
    let lines = |count: usize, line: &str| -> String {
        (0..count).map(|i| line.replace('#', &i.to_string())).collect()
    };
    for (table, line, count, rule) in [
        ("", "k#=1\n", 300_000, "machine-file"),
        ("[words]\n", "w#={decimals=3}\n", 50_000, "machine-word"),
        ("[blocks]\n", "b#=\"\"\n", 50_000, "template-block"),
    ] {
        let text = format!("extends = \"generic-3axis-fanuc\"\n{table}{}", lines(count, line));
        folder.write("own.toml", text);
        let begun = Instant::now();
        let said = folder.run(&["machines", "check", "own.toml"]);
        assert!(
            said.code == 2 && said.err.contains(&format!("error[{rule}]")),
            "{table}: {said:?}"
        );
        assert!(begun.elapsed() < Duration::from_secs(60), "{table}: {:?}", begun.elapsed());
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

/// Every kind of text that is read: a file of `fuzz/seeds`, its name, and what reads it.
const READERS: &[(&str, &str, &str)] = &[
    ("apt/nx.cls", "in.cls", "show in.cls"),
    ("apt/nx.cls", "in.cls", "wire in.cls -m fanuc-wire -o out.nc"),
    ("apt/nx.cls", "in.cls", "fit in.cls -m universal-ur5e"),
    (
        "../../examples/flange.tbl",
        "in.tbl",
        "fit flange.nc --from fanuc-31i --tools in.tbl -m generic-3axis-fanuc",
    ),
    ("CALLED", "O0100", "fit calls.nc --from fanuc-31i --folder . -m generic-3axis-fanuc"),
    ("MACHINE", "in.toml", "fit fanuc.nc --from in.toml -m generic-3axis-fanuc"),
    ("MACHINE", "in.toml", "fit part.cls -m in.toml"),
    ("MACHINE", "in.toml", "show part.cls -m in.toml"),
    (
        "../../crates/glass/machines/glass-polar-100hz.toml",
        "in.toml",
        "glass reach -m in.toml --block 20x20x30 -o out.svg",
    ),
    ("../../examples/plate.cls", "in.cls", "post in.cls -m generic-3axis-fanuc -o out.nc"),
    (
        "../../machines/samples/three-axes.cls",
        "in.cls",
        "prove fanuc.nc -m generic-3axis-fanuc --against in.cls",
    ),
    ("iso/linuxcnc.nc", "in.ngc", "show in.ngc --from linuxcnc"),
    ("iso/fanuc-milling.nc", "in.nc", "show in.nc --from fanuc-31i"),
    ("iso/haas-subprograms.nc", "in.nc", "show in.nc --from haas"),
    ("iso/grbl.nc", "in.nc", "prove in.nc --against part.cls -m grbl-3018"),
    ("../../machines/samples/generic-3axis-iso.nc", "in.nc", "show in.nc --from iso"),
    ("../../machines/samples/mach3-mill.tap", "in.tap", "show in.tap --from mach3"),
    ("../../machines/samples/marlin-cnc.gcode", "in.gcode", "show in.gcode --from marlin"),
    ("../../machines/samples/fanuc-wire.nc", "in.nc", "show in.nc --from fanuc-wire"),
    ("../../machines/samples/sodick-iso.nc", "in.nc", "show in.nc --from sodick-iso"),
    ("../../machines/samples/agie-iso.nc", "in.nc", "show in.nc --from agie-iso"),
    ("../../machines/samples/bp-95d.pts", "in.pts", "prove in.pts -m bp-95d --against part.cls"),
    ("sinumerik/style.mpf", "in.mpf", "show in.mpf --from sinumerik-840d"),
    ("sinumerik/style.mpf", "in.mpf", "show in.mpf --from sinumerik-828d"),
    ("klartext/milling.h", "in.h", "show in.h --from heidenhain-tnc640"),
    ("SETTINGS", "in.toml", "pcb board.toml -m grbl-3018 --tool 0.3 -o out --settings in.toml"),
    (
        "millproject/small.millproject",
        "in",
        "pcb board.toml -m grbl-3018 --tool 0.3 -o out --settings in",
    ),
    ("krl/job.src", "in.src", "prove in.src -m kuka-kr6-r900 --against part.cls"),
    ("urscript/job.script", "in.script", "prove in.script -m universal-ur5e --against part.cls"),
    ("ls/job.ls", "in.ls", "prove in.ls -m fanuc-lrmate-200id-mill --against part.cls"),
    ("rapid/job.mod", "in.mod", "prove in.mod -m abb-irb120-mill --against part.cls"),
    (
        "../../examples/flange.tbl",
        "in.tbl",
        "post flange.nc --from fanuc-31i --tools in.tbl -m generic-3axis-fanuc -o out.nc",
    ),
    ("../../examples/flange.tbl", "in.tbl", "show flange.nc --from fanuc-31i --tools in.tbl"),
    (
        "../../examples/flange.tbl",
        "in.tbl",
        "wire flange.nc --from fanuc-31i --tools in.tbl -m fanuc-wire -o out.nc",
    ),
    (
        "../../examples/flange.tbl",
        "in.tbl",
        "prove fanuc.nc -m generic-3axis-fanuc --against flange.nc --from fanuc-31i --tools in.tbl",
    ),
    ("CALLED", "O0100", "show calls.nc --from fanuc-31i --folder ."),
    (
        "CALLED",
        "O0100",
        "post calls.nc --from fanuc-31i --folder . -m generic-3axis-fanuc -o out.nc",
    ),
    ("CALLED", "O0100", "wire calls.nc --from fanuc-31i --folder . -m fanuc-wire -o out.nc"),
    (
        "CALLED",
        "O0100",
        "prove calls.nc --folder . -m generic-3axis-fanuc --against calls.nc --from fanuc-31i",
    ),
    ("freecad/bracket.json", "in.json", "show in.json"),
    ("freecad/part.dump", "in.dump", "show in.dump"),
    ("excellon/holes.drl", "in.drl", "pcb in.drl -m grbl-3018 -o out"),
    ("gerber/pads.gbr", "in.gtl", "pcb in.gtl -m grbl-3018 -o out"),
    ("gerber/pads.gbr", "plots/in.gtl", "pcb plots -m grbl-3018 -o out"),
    ("gerber/pads.gbr", "in.gtl", "pcb --front in.gtl -m grbl-3018 -o out"),
    ("gerber/pads.gbr", "in.gbl", "pcb --back in.gbl -m grbl-3018 -o out"),
    ("gerber/pads.gbr", "in.gko", "pcb board.toml --outline in.gko -m grbl-3018 -o out"),
    ("excellon/holes.drl", "in.drl", "pcb --drill in.drl -m grbl-3018 -o out"),
    ("board/lamp.toml", "in.toml", "pcb in.toml -m grbl-3018 -o out"),
    ("board/two-pins.json", "in.json", "pcb in.json -m grbl-3018 -o out"),
    ("kicad/v6.kicad_pcb", "in.kicad_pcb", "pcb in.kicad_pcb -m grbl-3018 -o out"),
    ("kicad/v9.kicad_pcb", "in.kicad_pcb", "pcb in.kicad_pcb -m grbl-3018 -o out"),
    (
        "levelling/table.txt",
        "in.txt",
        "pcb board.toml -m grbl-3018 -o out --only front --heights in.txt",
    ),
    (
        "levelling/grbl.txt",
        "in.txt",
        "pcb board.toml -m grbl-3018 -o out --only front --heights in.txt",
    ),
    (
        "levelling/linuxcnc.txt",
        "in.txt",
        "pcb board.toml -m grbl-3018 -o out --only front --heights in.txt",
    ),
    (
        "CLOUD",
        "in.xyz",
        "glass in.xyz --block 9x9x9 --material k9 --lens 70 -m glass-xyz-100hz -o out.prg",
    ),
    (
        "../../crates/glass/machines/glass-xyz-100hz.toml",
        "in.toml",
        "glass cloud.xyz --block 9x9x9 --material k9 --lens 70 -m in.toml -o out.prg",
    ),
    (
        "../../crates/glass/data/materials.toml",
        "in.toml",
        "glass cloud.xyz --block 9x9x9 --material k9 --materials in.toml --lens 70 -m glass-xyz-50hz -o out.prg",
    ),
    (
        "glass_body/roof.obj",
        "in.obj",
        "glass in.obj --block 20x20x30 --material k9 --lens 70 -m glass-xyz-100hz -o out.prg",
    ),
    (
        "wire/lines.dxf",
        "in.dxf",
        "glass in.dxf --block 99x99x30 --material k9 --lens 70 --rounds 0 -m glass-xyz-100hz -o out.prg",
    ),
    (
        "glass_body/lines.plt",
        "in.plt",
        "glass in.plt --block 99x99x30 --material k9 --lens 70 --rounds 0 -m glass-xyz-100hz -o out.prg",
    ),
    (
        "PULSES",
        "in.prg",
        "glass prove in.prg cloud.xyz --block 9x9x9 --material k9 --lens 70 -m glass-xyz-100hz",
    ),
    (
        "../../crates/glass/machines/glass-xyz-100hz.toml",
        "in.toml",
        "glass prove out.prg cloud.xyz --block 9x9x9 --material k9 --lens 70 -m in.toml",
    ),
    (
        "../../crates/glass/data/materials.toml",
        "in.toml",
        "glass prove out.prg cloud.xyz --block 9x9x9 --material k9 --materials in.toml --lens 70 -m glass-xyz-50hz",
    ),
    (
        "../../crates/glass/machines/glass-xyz-100hz.toml",
        "in.toml",
        "glass simulate out.prg -m in.toml",
    ),
    ("PULSES", "in.prg", "glass simulate in.prg -m glass-xyz-100hz"),
    (
        "../../crates/glass/machines/glass-xyz-100hz.toml",
        "in.toml",
        "glass sweep out.prg -m in.toml",
    ),
    ("PULSES", "in.prg", "glass sweep in.prg -m glass-xyz-100hz"),
    ("wire/lines.dxf", "in.dxf", "wire in.dxf -m fanuc-wire -o out.nc"),
    ("wire/lines.dxf", "in.dxf", "wire part.cls --upper in.dxf -m fanuc-wire -o out.nc"),
    ("import/shop.pp", "in.pp", "machines import in.pp -o mine.toml"),
    ("urdf/small.urdf", "in.urdf", "machines import in.urdf -o mine.toml"),
    ("calibration/ur5e.yaml", "in.yaml", "machines import in.yaml --extends ur5e -o mine.toml"),
    ("import/board.txt", "in.txt", "machines import in.txt -o mine.toml"),
    ("MACHINE", "in.toml", "machines import shop.pp --extends in.toml -o mine.toml"),
    ("MACHINE", "in.toml", "machines check in.toml"),
    ("MACHINE", "in.toml", "machines check extends.toml"),
    ("MACHINE", "in.toml", "machines new mine --from in.toml"),
    ("MACHINE", "in.toml", "post part.cls -m in.toml -o out.nc"),
    ("MACHINE", "in.toml", "prove fanuc.nc -m in.toml --against part.cls"),
    ("MACHINE", "in.toml", "pcb board.toml -m in.toml -o out --only front"),
    ("MACHINE", "in.toml", "post fanuc.nc --from in.toml -m generic-3axis-fanuc -o out.nc"),
    (
        "MACHINE",
        "in.toml",
        "prove fanuc.nc -m generic-3axis-fanuc --against fanuc.nc --from in.toml",
    ),
    ("MACHINE", "in.toml", "show fanuc.nc --from in.toml"),
    ("MACHINE", "in.toml", "wire fanuc.nc --from in.toml -m fanuc-wire -o out.nc"),
    ("WIRE", "in.toml", "wire part.cls -m in.toml -o out.nc"),
];

/// The text of a row of [`READERS`].
fn text_of(seed: &str) -> Vec<u8> {
    match seed {
        "CALLED" => b"%\nO0100\nG1 X40. F200.\nM99\n%\n".to_vec(),
        "CLOUD" => b"0 0 0\n1 0 0\n".to_vec(),
        "SETTINGS" => b"passes = 2\ndepth = 0.1\n".to_vec(),
        "MACHINE" => b"extends = \"generic-3axis-fanuc\"\n".to_vec(),
        "PULSES" => b"N1 BEGIN BLOCK X9.000 Y9.000 Z9.000 POINTS 1\nN2 PULSE X3.000 Y3.000 Z-3.947\nN3 END\n".to_vec(),
        "WIRE" => b"extends = \"fanuc-wire\"\n".to_vec(),
        file => std::fs::read(seeds().join(file)).unwrap_or_else(|e| panic!("{file}: {e}")),
    }
}

fn seeds() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds")
}

/// What the command of a row of [`READERS`] says where `name` has these bytes.
fn reads(name: &str, bytes: &[u8], command: &str) -> Said {
    const CALLS: &str = "%\nO0001\nG21 G90 G94 G17 G54\nT1 M6\nS900 M3\nG0 X0. Y0.\nG43 H1 Z5.\nG1 Z-1. F100.\nM98 P100\nG0 Z20.\nM5\n\
                         G91 G28 Z0.\nG90\nM30\n%\n";
    let folder = Folder::new();
    folder.write("board.toml", text_of("board/lamp.toml"));
    folder.write("flange.nc", text_of("../../examples/flange.nc"));
    folder.write("fanuc.nc", text_of("../../machines/samples/generic-3axis-fanuc.nc"));
    folder.write("shop.pp", text_of("import/shop.pp"));
    folder.write("calls.nc", CALLS);
    folder.write("extends.toml", "extends = \"in.toml\"\n");
    folder.write("part.cls", SOURCE);
    folder.write("cloud.xyz", text_of("CLOUD"));
    folder.write("out.prg", text_of("PULSES"));
    std::fs::create_dir(folder.path().join("plots")).unwrap();
    folder.write(name, bytes);
    folder.run(&command.split(' ').collect::<Vec<_>>())
}

#[test]
fn every_reader_passes_over_a_byte_order_mark_and_explains_utf_16() {
    for (seed, name, command) in READERS {
        let text = text_of(seed);
        let plain = reads(name, &text, command);
        let marked = reads(name, &[b"\xef\xbb\xbf", text.as_slice()].concat(), command);
        assert_eq!((plain.code, &plain.err), (marked.code, &marked.err), "{seed}: {command}");
        assert!(!plain.err.contains("UTF"), "{plain:?}");
        let units = || String::from_utf8_lossy(&text).encode_utf16().collect::<Vec<_>>();
        let little: Vec<u8> = units().into_iter().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().into_iter().flat_map(u16::to_be_bytes).collect();
        for wide in
            [[&[0xff, 0xfe], &little[..]].concat(), [&[0xfe, 0xff], &big[..]].concat(), little]
        {
            let said = reads(name, &wide, command);
            let file = name.rsplit('/').next().unwrap();
            let explained = said.err.contains("is in UTF-16") && said.err.contains(file);
            assert!(said.code != 0 && explained, "{seed}: {command}\n{said:?}");
        }
    }
}

/// The commands below one, that have none below them.
fn commands(folder: &Folder, above: &str) -> Vec<String> {
    let words: Vec<&str> =
        above.split(' ').filter(|word| !word.is_empty()).chain(["--help"]).collect();
    let help = folder.run(&words).out;
    let Some((_, list)) = help.split_once("Commands:\n") else { return vec![above.to_owned()] };
    let names = list.lines().take_while(|line| !line.is_empty());
    let names = names.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names =
        names.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help");
    names.flat_map(|name| commands(folder, format!("{above} {name}").trim())).collect()
}

/// A file that a command comes to read stands in [`READERS`], and so does a language: each place of a file in the help of a command,
/// each control of the library, each folder of seeds.
#[test]
fn every_file_that_is_read_stands_in_the_list_of_readers() {
    let folder = Folder::new();
    let mut missing = Vec::new();
    for command in commands(&folder, "") {
        let command = command.as_str();
        // It hands files to its server, whose tests are those of the crate `studio`.
        if command == "studio" {
            continue;
        }
        let mut words: Vec<&str> = command.split(' ').collect();
        words.push("--help");
        let help = folder.run(&words).out;
        for line in help.lines().map(str::trim).filter(|line| line.starts_with(['-', '<'])) {
            let Some((before, place)) = line.split_once('<') else { continue };
            let place = place.split_once('>').map_or(place, |(place, _)| place);
            let flag = before.split([',', ' ']).rfind(|word| word.starts_with('-'));
            let is_file =
                ["FILE", "NAME|FILE", "FOLDER", "SOURCE", "PROGRAM", "BOARD"].contains(&place);
            // What is written.
            if !is_file || matches!(flag, Some("--output" | "--picture")) {
                continue;
            }
            let short = before.split([',', ' ']).find(|word| word.len() == 2);
            let stands = READERS.iter().any(|(_, name, line)| {
                let first = name.split('/').next().unwrap();
                let Some(rest) = line.strip_prefix(command) else { return false };
                let words: Vec<&str> = rest.split_whitespace().collect();
                let at = words
                    .iter()
                    .position(|word| *word == first || *word == "." || *word == "extends.toml");
                let Some(at) = at else { return false };
                match flag {
                    Some(_) => at > 0 && [flag, short].contains(&Some(words[at - 1])),
                    None => at == 0,
                }
            });
            if !stands {
                missing.push(format!("{command} {} <{place}>", flag.unwrap_or_default()));
            }
        }
    }
    for control in std::fs::read_dir(seeds().join("../../controls")).unwrap() {
        let name = control.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
        // These are read as the machines that build on them.
        let machines: &[&str] = match name.as_str() {
            "points" => &["bp-95d"],
            "wire-iso" => &["fanuc-wire"],
            "linuxcnc-switchkins" => &["linuxcnc"],
            "grbl" => &["grbl-3018"],
            "krl" => &["kuka-kr6-r900"],
            "urscript" => &["universal-ur5e"],
            "fanuc-robot" => &["fanuc-lrmate-200id-mill"],
            "rapid" => &["abb-irb120-mill"],
            _ => &[],
        };
        let named =
            |line: &str| line.split(' ').any(|word| word == name || machines.contains(&word));
        if !READERS.iter().any(|(_, _, line)| named(line)) {
            missing.push(name);
        }
    }
    for kind in std::fs::read_dir(seeds()).unwrap() {
        let name = kind.unwrap().file_name().to_string_lossy().into_owned();
        // Cutter-location data for the writer, and bytes that draw regions; frames, which no command reads; pictures, and pulses, which
        // stand in the list as `PULSES`.
        if !["post", "region", "frame", "board_edit", "glass_picture", "glass_program"]
            .contains(&name.as_str())
            && !READERS.iter().any(|(seed, _, _)| seed.starts_with(&format!("{name}/")))
        {
            missing.push(name);
        }
    }
    assert!(missing.is_empty(), "{missing:?}");
}

/// A number of 300 digits in place of some numbers of a text: nothing that is said of it repeats them but the line itself, which is
/// cut, and names that hold them.
#[test]
fn no_message_says_a_number_of_300_digits() {
    let many = "9".repeat(300);
    for (seed, name, command) in READERS {
        let text = String::from_utf8_lossy(&text_of(seed)).into_owned();
        let bytes = text.as_bytes();
        let begins = |at: &usize| {
            bytes[*at].is_ascii_digit()
                && !bytes[at - 1].is_ascii_alphanumeric()
                && bytes[at - 1] != b'.'
        };
        let starts: Vec<usize> = (1..bytes.len()).filter(begins).collect();
        for &at in starts.iter().step_by(1 + starts.len() / 4) {
            let end = at + bytes[at..].iter().take_while(|b| b.is_ascii_digit()).count();
            let text = format!("{}{many}{}", &text[..at], &text[end..]);
            let said = reads(name, text.as_bytes(), command);
            let long = |line: &&str| !line.starts_with("    | ") && line.contains(&many[..40]);
            let zeros = |line: &&str| line.contains(&"0".repeat(40));
            let found = said.err.lines().find(|line| long(line) || zeros(line));
            assert_eq!(found, None, "{command}: {}", &text[at.saturating_sub(30)..at]);
        }
    }
}

/// A change of T1 against T1 is none: the first of the two tools goes on. Wherever a source gives tools sizes, two under one number are
/// refused, and nothing is saved; boards count their tools themselves.
#[test]
fn two_tools_of_one_number_are_refused_in_every_source_that_gives_them_sizes() {
    let cut = |name: &str| {
        format!(
            "{name}\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,20\nFEDRAT/100\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,20\n"
        )
    };
    let cl = |second: u32| {
        let tool = |diameter: u32| cut(&format!("LOADTL/1\nCUTTER/{diameter}"));
        format!("PARTNO/T\nUNITS/MM\n{}{}FINI\n", tool(10), tool(second))
    };
    let klartext = |second: u32| {
        let tool = |radius: u32| {
            format!(
                "TOOL DEF 1 L+50 R+{radius}\nTOOL CALL 1 Z S900\nL X+0 Y+0 Z+20 R0 FMAX M3\nL Z-1 F100\nL Z+20 FMAX\n"
            )
        };
        format!("BEGIN PGM T MM\n{}{}M30\nEND PGM T MM\n", tool(5), tool(second))
    };
    let job = |second: u32| {
        let tool = |diameter: u32| {
            format!("{{\"number\": 1, \"name\": \"M\", \"diameter\": {diameter}.0}}")
        };
        let example = String::from_utf8(text_of("../../examples/bracket.json")).unwrap();
        let at = example.find("\"tools\": [").unwrap() + 10;
        format!("{}{}, {},{}", &example[..at], tool(6), tool(second), &example[at..])
    };
    let table = |second: u32| format!("T1 P1 Z25 D6 ;one\nT{second} P2 Z30 D10 ;two\n");
    let fanuc = ["-m", "generic-3axis-fanuc", "-o", "out.nc"];
    for (name, twice, rule, words) in [
        ("in.cls", cl(6), "tool-twice", &["post", "in.cls"][..]),
        ("in.h", klartext(3), "tool-twice", &["post", "in.h", "--from", "heidenhain-tnc640"]),
        ("in.json", job(8), "two-tools", &["post", "in.json"]),
        (
            "in.tbl",
            table(1),
            "tool-table",
            &["post", "flange.nc", "--from", "fanuc-31i", "--tools", "in.tbl"],
        ),
    ] {
        let folder = Folder::new();
        folder.write("flange.nc", text_of("../../examples/flange.nc"));
        folder.write(name, &twice);
        let said = folder.run(&[words, &fanuc].concat());
        assert!(said.code != 0 && said.err.contains(&format!("error[{rule}]")), "{name}: {said:?}");
        assert!(!folder.names().contains(&"out.nc".to_owned()), "{name}");
    }
    for (name, once, words) in [
        ("in.cls", cl(10), &["post", "in.cls"][..]),
        ("in.h", klartext(5), &["post", "in.h", "--from", "heidenhain-tnc640"]),
        ("in.tbl", table(2), &["post", "flange.nc", "--from", "fanuc-31i", "--tools", "in.tbl"]),
    ] {
        let folder = Folder::new();
        folder.write("flange.nc", text_of("../../examples/flange.nc"));
        folder.write(name, &once);
        let said = folder.run(&[words, &fanuc].concat());
        assert_eq!(said.code, 0, "{name}: {said:?}");
    }
    // A program that calls T1 for both is not proven either.
    let folder = Folder::new();
    folder.write("once.cls", cl(10));
    folder.write("twice.cls", cl(6));
    assert_eq!(folder.run(&[&["post", "once.cls"][..], &fanuc].concat()).code, 0);
    let said =
        folder.run(&["prove", "out.nc", "--against", "twice.cls", "-m", "generic-3axis-fanuc"]);
    assert!(said.code == 1 && said.err.contains("error[tool-twice]"), "{said:?}");
}

/// What an operator who is new reads: the way out as he needs it.
#[test]
fn the_ways_out_that_a_newcomer_missed_are_there() {
    let folder = Folder::new();
    for name in ["plate.cls", "dome.cls"] {
        folder.write(name, text_of(&format!("../../examples/{name}")));
    }
    folder.write("whole.nc", "%\nO1\nG21\nG90 G94\nT1 M6\nS900 M3\nG0 X0 Y0 Z5\nM30\n%\n");
    for (words, expected) in [
        // M5
        ("post dome.cls -m generic-3axis-fanuc -o a.nc", "five-axis toolpath, three-axis machine"),
        (
            "post dome.cls -m generic-3axis-fanuc -o a.nc",
            "choose a machine with rotary axes, such as `fanuc-table-bc`",
        ),
        ("post plate.cls -m generic-3axis-grbl -o a.nc", "moves cannot tap"),
        (
            "post plate.cls -m generic-3axis-grbl -o a.nc",
            "tap by hand or mill the thread, or take a machine whose control has a tapping cycle",
        ),
        // M6
        ("post plate.cls -m grbl-3018 -o a.nc", "lower the clearance planes in the CAM system"),
        // M16
        ("show whole.nc --from fanuc-31i", "`--whole-numbers units` where X10 is 10 mm"),
    ] {
        let said = folder.run(&words.split(' ').collect::<Vec<_>>());
        assert!(said.code != 0 && said.err.contains(expected), "{words}: {expected}\n{}", said.err);
    }
}
