//! `toolpost glass`.

use crate::folder::{Folder, Said};
use std::process::Command;

/// A closed roof of 3 mm, as a text STL.
fn body() -> String {
    let [a, b, c, d] = ["0 0 0", "3 0 0", "0 3 0", "0 0 3"];
    let mut text = String::from("solid roof\n");
    for [p, q, r] in [[a, c, b], [a, b, d], [a, d, c], [b, c, d]] {
        text.push_str(&format!(
            "facet normal 0 0 0\nouter loop\nvertex {p}\nvertex {q}\nvertex {r}\nendloop\nendfacet\n"
        ));
    }
    text + "endsolid roof\n"
}

fn engrave(folder: &Folder, more: &[&str]) -> Said {
    let mut words = vec!["glass", "roof.stl", "--block", "20x20x30", "--material", "k9"];
    words.extend(["--lens", "70", "--rounds", "1", "-o", "roof.prg"]);
    if !more.contains(&"--machine") {
        words.extend(["--machine", "glass-xyz-100hz"]);
    }
    words.extend(more);
    folder.run(&words)
}

#[test]
fn the_tables_of_the_glass_engraver_agree_and_name_the_slips() {
    let folder = Folder::empty();
    let said = folder.run(&["glass", "tables"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("(24, 30)") && said.out.contains("<- not its point"), "{said:?}");
    assert!(said.out.contains("Slips of the source"), "{said:?}");
    assert!(!said.out.contains("<- differs"), "{said:?}");
    // Four charts of them.
    assert_eq!(folder.run(&["glass", "tables", "-o", "rates.svg"]).out, said.out);
    let svg = folder.read("rates.svg");
    for label in ["50 HZ, 0.08 M/S", "100 HZ, 0.1 M/S", "SORTING ANGLE, DEGREES", "200 HZ, 1.5 M/S"]
    {
        assert!(svg.contains(&format!("aria-label=\"{label}\"")), "{label}");
    }
    let said = folder.run(&["glass", "tables", "-o", "rates.gif"]);
    assert!(said.code == 2 && said.err.contains("error[drawing]"), "{said:?}");
}

#[test]
fn a_body_becomes_a_proven_program_and_a_report() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    let said = engrave(&folder, &[]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("proof       passed") && said.err.is_empty(), "{said:?}");
    let first = folder.read("roof.prg");
    assert!(first.starts_with("N1 BEGIN BLOCK X20.000 Y20.000 Z30.000 POINTS "), "{first:.100}");
    let report: serde_json::Value =
        serde_json::from_str(&folder.read("roof.prg.report.json")).unwrap();
    let proof = &report["glass"]["proof"];
    assert_eq!(proof["pulses"].as_u64(), Some(first.lines().count() as u64 - 2));
    assert_eq!(
        (proof["shadowed"].as_u64(), proof["ticks"].as_u64()),
        (Some(0), report["glass"]["planned_ticks"].as_u64())
    );
    for (digest, file) in [("program", "roof.prg"), ("source", "roof.stl")] {
        let sum = Command::new("sha256sum").arg(folder.path().join(file)).output().unwrap();
        let sum = String::from_utf8(sum.stdout).unwrap();
        assert_eq!(report["sha256"][digest].as_str(), sum.split(' ').next(), "{file}");
    }
    // The same words give the same program.
    assert_eq!(engrave(&folder, &["--json"]).json()["status"], "done");
    assert_eq!(folder.read("roof.prg"), first);

    // A machine and a material of one's own.
    let shown = folder.run(&["glass", "show", "glass-xyz-100hz"]);
    folder.write(
        "mine.toml",
        shown.out.replace("\"numbered\"   #", "\"gcode\"\nfire = \"M101 P0\" #"),
    );
    let table = folder.run(&["glass", "show", "materials"]).out;
    folder.write(
        "table.toml",
        table.replace("[k9]", "[lead]\ntitle = \"SF6\"\nindex = 1.8126\nwavelength = 532\n\n[k9]"),
    );
    let own = ["--machine", "mine.toml", "--materials", "table.toml", "--material", "lead"];
    let words: Vec<&str> =
        vec!["glass", "roof.stl", "--block", "20x20x30", "--lens", "70", "-o", "own.ngc"];
    let said = folder.run(&[&words[..], &own[..]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    assert!(folder.read("own.ngc").contains("G21 G90\nG0 X"), "{said:?}");
}

#[test]
fn a_body_is_placed_by_itself_and_proven_there() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    folder.write("dots.xyz", "0 0 0\n1 0 0\n");
    let placed = ["dots.xyz", "--place", "2 scale=2 turn=0,0,90 mirror=x,y move=5,0,-4"];
    let said = engrave(&folder, &placed);
    assert!(said.code == 0, "{said:?}");
    // 1 mm, twice as large and along Y, around 10 + 5, 10, 15 - 4.
    let row = "placed      body 2 by itself, scale 2, from 15.000 9.000 11.000 to 15.000 11.000 11.000 mm";
    assert!(said.out.contains(row), "{said:?}");
    let prove = |place: &str| {
        let mut words =
            vec!["glass", "prove", "roof.prg", "roof.stl", "dots.xyz", "--place", place];
        words.extend(["--block", "20x20x30", "--material", "k9", "--lens", "70"]);
        words.extend(["--machine", "glass-xyz-100hz"]);
        folder.run(&words)
    };
    assert_eq!(prove(placed[2]).code, 0);
    let said = prove("2 scale=2 turn=0,0,90 mirror=x,y move=4,0,-4");
    assert!(said.code == 1 && said.err.contains("error[lost]"), "{said:?}");
    for (place, what) in [
        ("0", "the number of a body comes first"),
        ("scale=2", "the number of a body comes first"),
        ("2 scale=0", "greater than 0"),
        ("2 scale=2 fit", "cannot both be"),
        ("2 turn=1,2", "three numbers"),
        ("2 turn=nan,2,3", "three numbers"),
        ("2 mirror=w", "the axes x, y and z"),
        ("2 move=1,1,1 move=2,2,2", "stands twice"),
        ("2 spin=1", "is none of"),
        ("3", "no body 3"),
    ] {
        let said = engrave(&folder, &["dots.xyz", "--place", place]);
        assert!(said.code == 2 && said.err.contains(what), "{place}: {said:?}");
    }
}

#[test]
fn what_cannot_be_engraved_is_refused_and_saves_nothing() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    let refused = |more: &[&str], code: i32, what: &str| {
        let said = engrave(&folder, more);
        assert_eq!(said.code, code, "{more:?}: {said:?}");
        assert!(said.err.contains(what), "{more:?}: {said:?}");
        assert_eq!(folder.names(), ["roof.stl"], "{more:?}");
    };
    refused(&["--order", "kdz", "--slopes", "0.1,0.1"], 1, "error[shadowed]");
    refused(&["--scale", "10"], 2, "error[does-not-fit]");
    refused(&["--spacing", "0.05"], 2, "error[spacing]");
    refused(&["--machine", "glass-xyz-300hz"], 2, "there are: glass-xyz-50hz");
    refused(&["roof.step"], 2, "error[form]");
    let said = folder.run(&["glass", "roof.stl", "--block", "20x20"]);
    assert!(said.code == 2 && said.err.contains("three sides in mm are needed"), "{said:?}");
    folder.write("roof.stl", &body()[..200]);
    refused(&[], 2, "roof.stl");
}

#[test]
fn a_polar_machine_makes_several_blocks_in_motion_and_an_edited_program_is_proven() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    let polar = ["--machine", "glass-polar-100hz", "--blocks", "4"];
    for order in ["arcs", "tracks", "fastest"] {
        let said = engrave(&folder, &[&polar[..], &["--order", order]].concat());
        assert!(said.code == 0 && said.out.contains("4, each with all points"), "{said:?}");
        let program = folder.read("roof.prg");
        assert!(program.contains(" BLOCKS 4\nN2 "), "{program:.200}");
    }
    let prove = |blocks: &str| {
        let words = ["glass", "prove", "roof.prg", "roof.stl", "--block", "20x20x30"];
        let more = ["--material", "k9", "--lens", "70", "--machine", "glass-polar-100hz"];
        folder.run(&[&words[..], &more[..], &["--blocks", blocks]].concat())
    };
    assert_eq!(prove("4").code, 0);
    let said = prove("3");
    assert!(said.code == 1 && said.err.contains("is for 4 blocks, not for 3"), "{said:?}");
    let said = engrave(&folder, &["--order", "tracks"]);
    assert!(said.code == 2 && said.err.contains("no turning table"), "{said:?}");
}

#[test]
fn a_run_is_simulated_stopped_and_goes_on() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    assert_eq!(engrave(&folder, &[]).code, 0);
    let simulate = |more: &[&str]| {
        folder.run(&[&["glass", "simulate", "roof.prg", "-m", "glass-xyz-100hz"], more].concat())
    };
    let report: serde_json::Value =
        serde_json::from_str(&folder.read("roof.prg.report.json")).unwrap();
    let seconds = report["glass"]["proof"]["seconds"].as_f64().unwrap();
    let said = simulate(&[]);
    assert!(said.code == 0 && said.out.contains(&format!("{seconds:.2} s; ")), "{said:?}");
    let said =
        simulate(&["--until", "2", "--start", "2026-11-26 20:15:00", "-o", "statistica.txt"]);
    assert!(said.code == 0 && said.out.contains("go on by --from "), "{said:?}");
    let text = folder.read("statistica.txt");
    assert!(
        text.contains("Start date: 2026-11-26 20:15:00\nPredicted end: 2026-11-26 20:15:"),
        "{text}"
    );
    let said = simulate(&["--misses", "0.1", "--feedback"]);
    assert!(said.code == 0, "{said:?}");
    let said = simulate(&["--door", "1"]);
    assert!(said.out.contains("the door is open; ") && said.out.contains("--from "), "{said:?}");
    let states = simulate(&["--door", "1", "--json"]).json()["statistics"]["states"].clone();
    assert_eq!(states.as_array().unwrap().last().unwrap(), "fault");
    assert!(simulate(&["--from", "99999999"]).err.contains("no point 99999999"));
    assert_eq!(simulate(&["--start", "tomorrow"]).code, 2);
    folder.write("roof.prg", "N1 BEGIN\n");
    assert!(simulate(&[]).err.contains("roof.prg:1: error[glass-program]"));
}

#[test]
fn an_edited_program_is_proven_against_its_body() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    let made = engrave(&folder, &[]);
    assert_eq!(made.code, 0);
    let passed =
        made.out.split("passed: ").nth(1).and_then(|rest| rest.split(" pulses").next()).unwrap();
    let prove = |block: &str| {
        let words =
            ["glass", "prove", "roof.prg", "roof.stl", "--block", block, "--material", "k9"];
        folder.run(&[&words[..], &["--lens", "70", "--machine", "glass-xyz-100hz"]].concat())
    };
    let said = prove("20x20x30");
    assert!(said.code == 0 && said.out.contains(&format!("passed: {passed} pulses")), "{said:?}");
    // For another block.
    let said = prove("20x20x31");
    assert!(said.code == 1 && said.err.contains("roof.prg:1: error[glass-block]"), "{said:?}");
    // The tenth pulse is that of the eleventh.
    let text = folder.read("roof.prg");
    let lines: Vec<&str> = text.lines().collect();
    let eleventh = lines[11].split_once(' ').unwrap().1;
    folder.write("roof.prg", text.replace(lines[10], &format!("N11 {eleventh}")));
    let said = prove("20x20x30");
    assert!(said.code == 1 && said.err.contains("roof.prg:12: error[twice]"), "{said:?}");
    assert!(said.err.contains("error[lost]"), "{said:?}");
    folder.write("roof.prg", text.replace("N12 PULSE", "N12 PULZE"));
    let said = prove("20x20x30");
    assert!(said.code == 2 && said.err.contains("roof.prg:12: error[glass-program]"), "{said:?}");
}

#[test]
fn a_body_is_filled_cut_and_met_by_rays() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    for (more, warned) in [
        (&["--fill", "solid", "--step", "0.4"][..], ""),
        (&["--fill", "sections", "--layer-distance", "0.5", "--twist", "0.5"], "warning[mesh]"),
        (&["--fill", "triangles", "--full"], ""),
        (&["--fill", "rays", "--axis", "x", "--tilt", "0,15,15"], ""),
        // As the source does it: closer than the spacing, and welded.
        (&["--fill", "triangles", "--step", "0.05"], ""),
    ] {
        let said = engrave(&folder, more);
        assert!(said.code == 0 && said.out.contains("passed: "), "{more:?}: {said:?}");
        assert_eq!(said.err.is_empty(), warned.is_empty(), "{more:?}: {said:?}");
        assert!(said.err.contains(warned), "{more:?}: {said:?}");
    }
}

#[test]
fn the_pulses_are_drawn_where_a_picture_is_asked_for() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    let said = engrave(&folder, &["--picture", "roof.svg"]);
    assert!(said.code == 0 && said.out.contains("roof.svg"), "{said:?}");
    let svg = folder.read("roof.svg");
    assert!(svg.contains("<title>Points in glass of roof.stl</title>"), "{svg:.300}");
    assert!(svg.matches("h.1").count() > 800, "{}", svg.len());
    let said = engrave(&folder, &["--picture", "roof.png"]);
    assert!(said.code == 0, "{said:?}");
    let png = std::fs::read(folder.path().join("roof.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
    // A program that is not proven is not drawn where it would be saved; one that is looked at is.
    let words = ["glass", "prove", "roof.prg", "roof.stl", "--block", "20x20x31", "--lens", "70"];
    let more = ["--material", "k9", "--machine", "glass-xyz-100hz", "--picture", "edited.svg"];
    assert_eq!(folder.run(&[&words[..], &more].concat()).code, 1);
    assert!(folder.read("edited.svg").starts_with("<svg"));
    let said = engrave(&folder, &["--picture", "roof.gif"]);
    assert!(said.code == 2 && said.err.contains("error[drawing]"), "{said:?}");
    let said = engrave(&folder, &["--picture", "roof.stl"]);
    assert!(said.code == 2 && !folder.read("roof.stl").is_empty(), "{said:?}");
}

#[test]
fn a_picture_is_seen_as_the_camera_says() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    let view = |more: &[&str]| {
        let said = engrave(&folder, &[&["--picture", "roof.svg"], more].concat());
        assert_eq!(said.code, 0, "{more:?}: {said:?}");
        folder.read("roof.svg")
    };
    let plain = view(&[]);
    for more in [
        ["--camera", "30,-10,0"],
        ["--camera", "-63,19,-45"],
        ["--distance", "50"],
        ["--zoom", "3"],
        ["--grid", "5"],
    ] {
        assert_ne!(view(&more), plain, "{more:?}");
    }
    assert_eq!(view(&["--camera=-63,19,0", "--zoom", "1"]), plain);
    let grid = view(&["--grid", "5"]);
    assert!(grid.contains("BLOCK 20 X 20 X 30 MM, POINTS ") && grid.contains(", GRID 5 MM"));
    for (more, what) in [
        (["--camera", "0,91,0"], "the second from -90 to 90"),
        (["--camera", "0,nan,0"], "three angles are needed"),
        (["--zoom", "0"], "from 0.1 to 1000"),
        (["--distance", "41"], "within the block"),
        (["--grid", "0.1"], "--grid of 0.300 mm or more"),
    ] {
        let said = engrave(&folder, &[&["--picture", "roof.svg"][..], &more].concat());
        assert!(said.code == 2 && said.err.contains(what), "{more:?}: {said:?}");
    }
    let said = engrave(&folder, &["--zoom", "2"]);
    assert!(said.code == 2 && said.err.contains("--picture"), "{said:?}");
}

#[test]
fn a_list_of_points_is_checked_for_its_smallest_distance() {
    let folder = Folder::empty();
    folder.write("cloud.csv", "x;y;z;n\n0;0;0;7\n0;0;0.129;8\n1;1;1;9\n");
    let said = folder.run(&["glass", "check", "cloud.csv", "--spacing", "0.13"]);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.out.contains("0.1290 mm: 0.000 0.000 0.000 and 0.000 0.000 0.129"), "{said:?}");
    assert!(said.out.contains("1 pairs under 0.13 mm, 2 points"), "{said:?}");
    assert_eq!(folder.run(&["glass", "check", "cloud.csv", "--spacing", "0.129"]).code, 0);
    let said =
        folder.run(&["glass", "check", "cloud.csv", "--spacing", "0.13", "--columns", "1,2,4"]);
    assert_eq!(said.code, 0, "{said:?}");
}

#[test]
fn a_photograph_a_depth_map_and_a_3mf_become_proven_programs() {
    let folder = Folder::empty();
    let picture =
        image::GrayImage::from_fn(30, 20, |x, y| image::Luma([(x * 6 + y * 3) as u8 + 10]));
    picture.save(folder.path().join("face.png")).unwrap();
    let mut zip =
        zip::ZipWriter::new(std::fs::File::create(folder.path().join("roof.3mf")).unwrap());
    zip.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default()).unwrap();
    let model = "<model unit=\"centimeter\"><resources><object id=\"1\"><mesh><vertices>\
        <vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\".3\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\".3\" z=\"0\"/>\
        </vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object></resources>\
        <build><item objectid=\"1\"/></build></model>";
    std::io::Write::write_all(&mut zip, model.as_bytes()).unwrap();
    zip.finish().unwrap();
    let engrave = |words: &[&str]| {
        let more = ["--block", "10x10x10", "--material", "k9", "--lens", "70", "--rounds", "1"];
        let more2 = ["--machine", "glass-xyz-100hz", "-o", "out.prg"];
        folder.run(&[&["glass"][..], words, &more, &more2].concat())
    };
    for words in [
        &["face.png"][..],
        &["face.png", "--image", "raster", "--threshold", "0.4", "--plane", "xy", "--invert"],
        &["face.png", "--image", "relief", "--depth", "2"],
        &["face.png", "--width", "4", "--sheets", "2", "roof.3mf"],
    ] {
        let said = engrave(words);
        assert!(said.code == 0 && said.out.contains("passed: "), "{words:?}: {said:?}");
    }
    let said = engrave(&["face.png", "--image", "relief"]);
    assert!(said.code == 2 && said.err.contains("--depth"), "{said:?}");
    folder.write("face.jpg", "no picture");
    let said = engrave(&["face.jpg"]);
    assert!(said.code == 2 && said.err.contains("face.jpg: error[image]"), "{said:?}");
}

#[test]
fn a_cloud_is_saved_for_other_programs_and_colours_lie_in_the_folder_of_the_body() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    let said = engrave(&folder, &["--cloud", "roof.ply"]);
    assert_eq!(said.code, 0, "{said:?}");
    let points = folder.read("roof.prg").lines().count() - 2;
    let bytes = std::fs::read(folder.path().join("roof.ply")).unwrap();
    let head = format!(
        "element vertex {points}\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    );
    let at = bytes.windows(head.len()).position(|own| own == head.as_bytes()).unwrap();
    assert_eq!(bytes.len(), at + head.len() + 12 * points);
    // The points are those of the program, exactly.
    let said = folder.run(&["glass", "check", "roof.ply", "--spacing", "0.13", "--json"]);
    assert_eq!((said.code, said.json()["points"].as_u64()), (0, Some(points as u64)), "{said:?}");

    let text = "mtllib ../sheet.mtl\nv 0 0 0\nv 9 0 0\nv 0 9 0\nusemtl paper\nf 1 2 3\n";
    folder.write("sheet.obj", text);
    let words = ["glass", "sheet.obj", "--block", "20x20x30", "--material", "k9", "--lens", "70"];
    let shaded =
        ["--machine", "glass-xyz-100hz", "--rounds", "0", "--fill", "shaded", "-o", "a.prg"];
    let words = [&words[..], &shaded[..]].concat();
    let said = folder.run(&words);
    assert!(said.code != 0 && said.err.contains("does not lie in the folder"), "{said:?}");
    folder.write("sheet.obj", text.replace("../", ""));
    assert!(folder.run(&words).err.contains("sheet.mtl"));
    folder.write("sheet.mtl", "newmtl paper\nKd 0.5 0.5 0.5\n");
    assert_eq!(folder.run(&words).code, 0);
    let grey = folder.read("a.prg").lines().count() - 2;
    assert_eq!(folder.run(&[&words[..], &["--invert"]].concat()).code, 0);
    let dark = folder.read("a.prg").lines().count() - 2;
    // A grey of 0.5 has 0.214 of the light of white.
    let part = grey as f64 / (grey + dark) as f64;
    assert!((part - 0.214).abs() < 0.001, "{grey} {dark}");
}

#[test]
fn what_an_arm_reaches_is_drawn() {
    let folder = Folder::empty();
    let machine = folder.run(&["glass", "show", "glass-polar-100hz"]).out;
    // The example of the source: the arm misses 17.4 % of a block of 50 mm.
    folder.write("short.toml", machine.replace("arm = 135", "arm = 120"));
    let words = ["glass", "reach", "-m", "short.toml", "--block", "50x50x80", "-o", "reach.svg"];
    let said = folder.run(&[&words[..], &["--json"]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    let missed = said.json()["unreachable"].as_f64().unwrap();
    assert!((missed - 0.1736).abs() < 0.001, "{missed}");
    assert!(folder.read("reach.svg").starts_with("<svg"), "{:.60}", folder.read("reach.svg"));
    let wrong = folder.run(&[
        "glass",
        "reach",
        "-m",
        "glass-xyz-100hz",
        "--block",
        "50x50x80",
        "-o",
        "a.svg",
    ]);
    assert!(wrong.code != 0 && wrong.err.contains("no arm"), "{wrong:?}");
}

#[test]
fn shells_and_channels_are_given_on_the_command_line() {
    let folder = Folder::empty();
    folder.write("roof.stl", body());
    assert_eq!(engrave(&folder, &[]).code, 0);
    let one = folder.read("roof.prg").lines().count();
    assert_eq!(engrave(&folder, &["--shells", "2"]).code, 0);
    assert!(folder.read("roof.prg").lines().count() * 10 > one * 12);
    // Four beams, two of them open: the program says so, and its pulses are those of one block.
    let beams = ["--machine", "glass-xyz-50hz", "--blocks", "2"];
    let said = engrave(&folder, &beams);
    assert_eq!(said.code, 0, "{said:?}");
    let first = folder.read("roof.prg");
    assert!(first.lines().next().unwrap().ends_with("BLOCKS 2"), "{first:.100}");
    assert_eq!(first.lines().count(), one);
    assert!(engrave(&folder, &["--machine", "glass-xyz-50hz", "--blocks", "5"]).code != 0);
}

#[test]
fn what_a_program_takes_on_other_drives_is_told_and_drawn() {
    let folder = Folder::empty();
    // Steps of 0.187 and 0.7 mm: at 7.5 m/s², 0.1 m/s and 100 Hz one tick and two.
    folder.write(
        "three.prg",
        "N1 BEGIN BLOCK X20.000 Y20.000 Z30.000 POINTS 3\nN2 PULSE X1.000 Y1.000 Z-1.000\nN3 PULSE X1.187 Y1.000 Z-1.000\nN4 PULSE X1.187 Y1.700 Z-1.000\nN5 END\n",
    );
    let words = ["glass", "sweep", "three.prg", "-m", "glass-xyz-100hz"];
    let said = folder.run(&words);
    assert_eq!(said.code, 0, "{said:?}");
    let row = |start: &str| -> Vec<String> {
        let line = said.out.lines().find(|line| line.trim_start().starts_with(start));
        line.unwrap_or_default().split_whitespace().map(str::to_owned).collect()
    };
    // 4 ticks of 10 ms.
    assert_eq!(row("7.500")[4..7], ["75.00", "0.0", "s"], "{said:?}");
    // A quarter of the acceleration: 0.187 mm takes 2 √(0.187 / 1875) = 19.97 ms, 2 ticks, 0.7 mm 38.64 ms, 4 ticks, all 7; at 50 Hz 1, 2
    // and 1 for the first pulse.
    assert_eq!(row("1.875")[4], "42.86", "{said:?}");
    assert_eq!(row("1.875")[1], "37.50", "{said:?}");
    // At 200 Hz and 30 m/s²: 0.187 mm takes 4.99 ms, 0.7 mm 10.3 ms (it does not go faster than 0.1 m/s): 1, 1 and 3 ticks.
    assert_eq!(row("30.000")[7], "120.00", "{said:?}");
    assert_eq!(folder.run(&[&words[..], &["-o", "three.svg"]].concat()).out, said.out);
    let svg = folder.read("three.svg");
    assert!(svg.contains("aria-label=\"200 HZ\"") && svg.contains("aria-label=\"TIME, S\""));
    let json = folder.run(&[&words[..], &["--json"]].concat()).json();
    assert_eq!(json["swept"].as_array().map(Vec::len), Some(27), "{json}");
    // A scanner's time is that of its stage too.
    folder.write("roof.stl", body());
    assert_eq!(engrave(&folder, &["--machine", "glass-galvo-1000hz"]).code, 0);
    let said = folder.run(&["glass", "sweep", "roof.prg", "-m", "glass-galvo-1000hz"]);
    assert!(said.code == 2 && said.err.contains("from rest to rest"), "{said:?}");
}
