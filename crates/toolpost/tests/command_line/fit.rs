//! How a robot leads a tool: where a part would fit it, and its joints as a picture.

use crate::folder::Folder;
use std::process::Command;

const JOB: &str = "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,300\nGOTO/0,0,-2\nFEDRAT/MMPM,1200\nGOTO/60,0,-2\n\
GOTO/60,40,-2\nRAPID\nGOTO/60,40,50\nFINI\n";

/// The cell of the library with the part somewhere else.
fn cell(part: &str) -> String {
    format!("extends = \"kuka-kr6-r900\"\n[cell]\npart = {part}\n")
}

/// A metre away nothing reaches; at each place that is found the job is made and proven, with the margins that are printed.
#[test]
fn places_are_found_at_which_the_job_is_proven() {
    let folder = Folder::new();
    folder.write("job.cls", JOB);
    folder.write("far.toml", cell("[1000, 0, 150, 0, 0, 0]"));
    let post = |machine: &str| folder.run(&["post", "job.cls", "-m", machine, "-o", "job.src"]);
    let refused = post("far.toml");
    assert!(refused.code == 1 && refused.err.contains("out of reach"), "{refused:?}");
    let words = ["fit", "job.cls", "-m", "far.toml", "--within", "500"];
    let said = folder.run(&words);
    assert!(said.code == 0 && said.out.contains("out of reach"), "{said:?}");
    let found = folder.run(&[&words[..], &["--json"]].concat()).json();
    assert!(found["here"]["refused"]["message"].as_str().unwrap().contains("out of reach"));
    let places = found["places"].as_array().unwrap();
    assert!(!places.is_empty(), "{found}");
    let margin = |place: &serde_json::Value| place["margins"]["margin_percent"].as_f64().unwrap();
    assert!(places.windows(2).all(|pair| margin(&pair[0]) >= margin(&pair[1])), "{found}");
    for place in places {
        folder.write("near.toml", cell(&place["part"].to_string()));
        let made = post("near.toml");
        assert!(made.code == 0, "{place}: {made:?}");
        // The proof follows the joints by itself, and at home the arm may be nearer to a limit.
        let report: serde_json::Value =
            serde_json::from_str(&folder.read("job.src.report.json")).unwrap();
        let wrist = report["proof"]["arm"]["wrist_degrees"].as_f64().unwrap();
        assert!(
            (wrist - place["margins"]["wrist_degrees"].as_f64().unwrap()).abs() < 2.0,
            "{report}"
        );
    }
}

/// The same places, however many threads look.
#[test]
fn the_places_are_the_same_on_any_number_of_threads() {
    let folder = Folder::new();
    folder.write("job.cls", JOB);
    let said = |threads: &str| {
        let words = ["fit", "job.cls", "-m", "universal-ur5e", "--within", "200"];
        let mut command = Command::new(env!("CARGO_BIN_EXE_toolpost"));
        let command = command.args(words).current_dir(folder.path());
        let output = command.env("RAYON_NUM_THREADS", threads).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let one = said("1");
    assert!(one.contains("place") && one == said("3"), "{one}");
}

#[test]
fn where_nothing_fits_it_is_said_with_the_reasons() {
    let folder = Folder::new();
    folder.write("job.cls", JOB);
    folder.write("far.toml", cell("[3000, 0, 150, 0, 0, 0]"));
    let said = folder.run(&["fit", "job.cls", "-m", "far.toml"]);
    assert!(said.code == 1 && said.out.contains("none: a larger --within"), "{said:?}");
    let said = folder.run(&["fit", "job.cls", "-m", "emco-concept-mill-105"]);
    assert!(said.code == 2 && said.err.contains("is no robot"), "{said:?}");
}

/// Joints and margins in a picture, the same figures in words, and the reason where the robot cannot lead the tool.
#[test]
fn the_joints_of_a_robot_are_drawn() {
    let folder = Folder::new();
    folder.write("job.cls", JOB);
    let words = ["show", "job.cls", "-m", "kuka-kr6-r900", "-o", "job.svg"];
    let said = folder.run(&words);
    assert!(said.code == 0 && said.out.contains("of a joint's speed"), "{said:?}");
    let drawn = folder.read("job.svg");
    // The limits of joint 2 in the data sheet.
    for text in ["JOINT 6", "\"-190\"", "\"45\"", "MARGIN BELOW 25 %"] {
        assert!(drawn.contains(text), "{text}: {drawn}");
    }
    let found = folder.run(&[&words[..], &["--json"]].concat()).json();
    let fit = folder.run(&["fit", "job.cls", "-m", "kuka-kr6-r900", "--json"]).json();
    assert_eq!(found["margins"], fit["here"]["margins"]);
    assert!(found["margins"]["speed_percent"].as_f64().unwrap() > 0.0, "{found}");
    folder.write("far.toml", cell("[1000, 0, 150, 0, 0, 0]"));
    let said = folder.run(&["show", "job.cls", "-m", "far.toml", "-o", "far.png"]);
    assert!(
        said.code == 1 && said.err.contains("job.cls:6") && said.err.contains("out of reach"),
        "{said:?}"
    );
    assert!(!folder.names().contains(&String::from("far.png")));
    let said = folder.run(&["show", "job.cls", "-m", "emco-concept-mill-105"]);
    assert!(said.err.contains("is no robot"), "{said:?}");
}
