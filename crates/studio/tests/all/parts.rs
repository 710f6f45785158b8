//! Programs of several files: each is edited, all are proven and saved together.

use crate::client::{Socket, Studio};
use serde_json::{Value, json};
use std::fs;
use toolpost_studio::message::Array;

/// A robot whose programs are divided after a few rows: its machine file, the ending of its programs, what stands before a coordinate of a cut, and a
/// line that may be added without any effect.
struct Robot {
    machine: &'static str,
    ending: &'static str,
    number: &'static str,
    nothing: Option<&'static str>,
}

const ROBOTS: [Robot; 3] = [
    Robot { machine: "fanuc-lrmate-200id-mill", ending: "ls", number: "X = ", nothing: None },
    Robot {
        machine: "kuka-kr6-r900",
        ending: "src",
        number: "LIN {X ",
        nothing: Some("; by hand"),
    },
    Robot {
        machine: "abb-irb120-mill",
        ending: "mod",
        number: "MoveL [[",
        nothing: Some("! by hand"),
    },
];

/// Rows of cuts from Y on, a way up between any two.
fn rows(y: f64, count: usize) -> String {
    let row = |i: usize| {
        let (y, cut) = (y + i as f64, "GOTO/80,{},0\nGOTO/100,{},0\nGOTO/120,{},0\n");
        let cut = cut.replace("{}", &y.to_string());
        format!("RAPID\nGOTO/80,{y},20\nFEDRAT/MMPM,600\n{cut}RAPID\nGOTO/120,{y},20\n")
    };
    let rows: String = (0..count).map(row).collect();
    format!(
        "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\n{rows}SPINDL/OFF\nFINI\n"
    )
}

/// A cell whose controller takes 60 lines a file, and a job that needs several.
fn set_up(studio: &Studio, machine: &str) {
    let machine = format!("extends = \"{machine}\"\n\n[capabilities]\nprogram_lines = 60\n");
    fs::write(studio.own().join("mine.toml"), machine).unwrap();
    fs::write(studio.own().join("job.cls"), rows(30.0, 30)).unwrap();
}

fn post(page: &mut Socket, file: &str) -> Value {
    let params = json!({ "source": { "file": "job.cls" }, "machine": "mine.toml", "file": file });
    page.answer("post", params, &[]).unwrap_or_else(|stop| panic!("{stop}")).head["done"].clone()
}

/// The bytes of a file of a job's program, with the ends of lines that the page sees.
fn text(page: &mut Socket, job: &Value, file: Option<&str>) -> String {
    let params = json!({ "revision": job["revision"], "of": "program", "file": file, "from": 1, "to": 1_000_000 });
    let mut frame = page.answer("text", params, &[]).unwrap();
    String::from_utf8(frame.take_text("text").unwrap()).unwrap()
}

/// Proves an edit of files of a job's program.
fn prove(page: &mut Socket, job: &Value, edits: &[(Option<&str>, &str)]) -> Result<Value, Value> {
    let files: Vec<Value> = edits.iter().map(|(file, text)| json!([file, text.len()])).collect();
    let all: String = edits.iter().map(|(_, text)| *text).collect();
    let params = json!({
        "source": { "file": "job.cls" }, "machine": "mine.toml", "revision": job["revision"], "files": files,
    });
    let frame = page.answer("prove", params, &[Array::text("text", all)])?;
    Ok(frame.head["done"].clone())
}

fn save(page: &mut Socket, job: &Value, path: &str) -> Result<Value, Value> {
    let params = json!({ "revision": job["revision"], "path": path, "replace": true });
    page.answer("save", params, &[]).map(|frame| frame.head["done"].clone())
}

/// The text with a tenth more in the first coordinate behind `before`, and the line that it stands in.
fn damaged(text: &str, before: &str) -> (String, u64) {
    let at = text.find(before).unwrap_or_else(|| panic!("{before} in {text}"));
    let point = at + text[at..].find('.').unwrap();
    let digit = if &text[point + 1..point + 2] == "1" { "2" } else { "1" };
    let line = text[..at].matches('\n').count() as u64 + 1;
    (format!("{}{digit}{}", &text[..=point], &text[point + 2..]), line)
}

#[test]
fn each_file_of_a_program_is_edited_and_all_are_proven_and_saved_together() {
    for Robot { machine, ending, number, nothing } in ROBOTS {
        let studio = Studio::new();
        let own = |name: &str| studio.own().join(name);
        set_up(&studio, machine);
        let main = format!("job.{ending}");
        let mut page = studio.socket();
        // An older program of the same name lies in the folder, with all its parts.
        let older = post(&mut page, &main);
        assert_eq!(older["verdict"], "done", "{older}");
        save(&mut page, &older, &main).unwrap();
        fs::write(own("job.cls"), rows(30.5, 30)).unwrap();
        let job = post(&mut page, &main);
        let parts: Vec<String> = job["parts"]
            .as_array()
            .unwrap()
            .iter()
            .map(|part| part["file"].as_str().unwrap().to_owned())
            .collect();
        assert!(parts.len() > 2, "{parts:?}");
        let read = |name: &str| fs::read_to_string(own(name)).unwrap();
        let before: Vec<String> = parts.iter().chain([&main]).map(|name| read(name)).collect();

        // As posted, each file by itself and all together, it is the same program; those in the folder are others.
        let whole: Vec<(Option<&str>, String)> = [None]
            .into_iter()
            .chain(parts.iter().map(|part| Some(&**part)))
            .map(|file| (file, text(&mut page, &job, file)))
            .collect();
        let all: Vec<(Option<&str>, &str)> =
            whole.iter().map(|(file, text)| (*file, &**text)).collect();
        for edits in [&all[..1], &all[1..2], &all[..]] {
            let same = prove(&mut page, &job, edits).unwrap();
            assert_eq!(
                (&same["verdict"], &same["walk"]["moves"]),
                (&json!("done"), &job["walk"]["moves"]),
                "{same}"
            );
            assert_eq!(same["parts"], job["parts"]);
            assert_eq!(same["program"], job["program"]);
        }
        let older =
            prove(&mut page, &job, &[(Some(&parts[1]), &before[1].replace("\r\n", "\n"))]).unwrap();
        assert_eq!(
            (&older["verdict"], &older["mismatch"]["file"]),
            (&json!("failed"), &json!(parts[1])),
            "{older}"
        );

        // A tenth more in one number of a part: the part and its line are named, and nothing is saved.
        let (wrong, line) = damaged(&whole[2].1, number);
        let failed = prove(&mut page, &job, &[(Some(&parts[1]), &wrong)]).unwrap();
        assert_eq!(failed["verdict"], "failed", "{failed}");
        let place = &failed["mismatch"];
        if ending != "ls" {
            assert_eq!(
                (&place["file"], &place["program"]),
                (&json!(parts[1]), &json!(line)),
                "{failed}"
            );
        }
        assert_eq!(place["file"], json!(parts[1]), "{failed}");
        assert_eq!(failed["findings"][0]["of"], "program", "{failed}");
        // All files are still there to be edited.
        assert_eq!(failed["parts"].as_array().unwrap().len(), parts.len());
        assert_eq!(
            save(&mut page, &failed, &main).unwrap_err()["findings"][0]["rule"],
            "output-file"
        );
        assert_eq!(parts.iter().chain([&main]).map(|name| read(name)).collect::<Vec<_>>(), before);

        // An edit without effect: what stands behind it has moved, and each place is the same record, template and all.
        let part = Some(&*parts[1]);
        let (edited, moved) = match nothing {
            Some(nothing) => {
                let at = whole[2].1.find(number).unwrap();
                let begin = whole[2].1[..at].rfind('\n').unwrap() + 1;
                let (above, below) = whole[2].1.split_at(begin);
                (format!("{above}{nothing}\n{below}"), 1)
            }
            None => (whole[2].1.replacen(" ;\n", "  ;\n", 1), 0),
        };
        assert_ne!(edited, whole[2].1);
        // Based on the failed one, of which no more is taken than the files that are not edited.
        let good = prove(&mut page, &failed, &[(part, &edited)]).unwrap();
        assert_eq!(
            (&good["verdict"], &good["walk"]["moves"]),
            (&json!("done"), &job["walk"]["moves"]),
            "{good}"
        );
        let last = job["walk"]["moves"].as_u64().unwrap();
        let mut in_part = 0;
        for at in (0..last).step_by(5) {
            let place = |page: &mut Socket, job: &Value| {
                page.done(
                    "place",
                    json!({ "revision": job["revision"], "by": "move", "value": at }),
                )
            };
            let (was, is) = (place(&mut page, &job), place(&mut page, &good));
            let is_in = was["block"]["file"] == parts[1];
            let is_below = is_in && was["block"]["line"].as_u64() >= Some(line);
            let more = if is_below { moved } else { 0 };
            in_part += u64::from(is_in);
            assert_eq!(
                is["block"]["line"].as_u64(),
                was["block"]["line"].as_u64().map(|line| line + more),
                "{is}"
            );
            for key in ["source", "template", "tip", "axes"] {
                assert_eq!(is[key], was[key], "{key} of {at}");
            }
            assert!(!is["template"].is_null(), "{is}");
            let block = json!({ "revision": good["revision"], "by": "block", "value": is["block"]["line"], "file": is["block"]["file"] });
            assert_eq!(page.done("place", block)["block"], is["block"]);
        }
        assert!(in_part > 0);

        // Where one of the files cannot be saved, none is.
        fs::remove_file(own(&parts[0])).unwrap();
        fs::create_dir(own(&parts[0])).unwrap();
        assert!(save(&mut page, &good, &main).is_err());
        let others = parts[1..].iter().chain([&main]);
        assert_eq!(others.map(|name| read(name)).collect::<Vec<_>>(), before[1..]);
        fs::remove_dir(own(&parts[0])).unwrap();

        // All are saved as they were proven, with a report that names them.
        let saved = save(&mut page, &good, &main).unwrap();
        let names: Vec<&str> =
            saved["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
        let report = format!("{main}.report.json");
        let expected: Vec<&str> = [&*main]
            .into_iter()
            .chain(parts.iter().map(|part| &**part))
            .chain([&*report])
            .collect();
        assert_eq!((names, &saved["findings"]), (expected, &json!([])));
        for (file, text) in &whole {
            let text = if *file == part { &edited } else { text };
            // The ends of lines are those of the control.
            assert_eq!(read(file.unwrap_or(&main)), text.replace('\n', "\r\n"), "{file:?}");
        }
        let report: Value = serde_json::from_str(&read(&report)).unwrap();
        let texts: Vec<String> = [&main].into_iter().chain(&parts).map(|name| read(name)).collect();
        assert_eq!(
            report["sha256"]["program"],
            json!(program::Digest::of(texts.iter().map(|text| text.as_bytes())))
        );
        assert_eq!(
            report["program"]["parts"][1],
            json!({ "file": parts[1], "bytes": texts[2].len() })
        );
        assert_eq!(report["program"]["bytes"], texts.iter().map(String::len).sum::<usize>());
    }
}

#[test]
fn files_that_a_program_has_not_are_refused() {
    let studio = Studio::new();
    set_up(&studio, "kuka-kr6-r900");
    let mut page = studio.socket();
    let job = post(&mut page, "job.src");
    let main = text(&mut page, &job, None);
    let mut refused = |files: Value, text: &str| {
        let params = json!({ "source": { "file": "job.cls" }, "machine": "mine.toml", "revision": job["revision"], "files": files });
        let stop = page.answer("prove", params, &[Array::text("text", text)]).unwrap_err();
        stop["findings"][0]["rule"].as_str().unwrap().to_owned()
    };
    for files in [
        json!([["other.src", main.len()]]),
        json!([["../job.src", main.len()]]),
        json!([[null, main.len() + 1]]),
        json!([[null, main.len() - 1]]),
        json!([[null, u64::MAX]]),
        json!([[null, main.len()], ["job.src", 0]]),
        json!([["job_1.src", main.len()], ["job_1.src", 0]]),
    ] {
        assert_eq!(refused(files.clone(), &main), "studio-ask", "{files}");
    }
    // Its part lies in the folder, and is none of the program's.
    fs::write(studio.own().join("other.src"), "DEF other ( )\nEND\n").unwrap();
    let calls = main.replacen("job_1 ( )", "other ( )\njob_1 ( )", 1);
    assert_ne!(calls, main);
    let failed = prove(&mut page, &job, &[(None, &calls)]).unwrap();
    assert_eq!(
        (&failed["verdict"], &failed["findings"][0]["rule"]),
        (&json!("failed"), &json!("called-program")),
        "{failed}"
    );
    let params = json!({ "source": { "file": "job.cls" }, "machine": "mine.toml", "revision": 1 });
    let stop = page.answer("prove", params, &[Array::text("text", main)]).unwrap_err();
    assert_eq!(stop["findings"][0]["rule"], "studio-limit");
}

/// A program of several files that lies in the folder is shown, edited and saved as a whole.
#[test]
fn the_files_that_a_program_of_the_folder_calls_are_its_own() {
    let studio = Studio::new();
    set_up(&studio, "kuka-kr6-r900");
    let mut page = studio.socket();
    let job = post(&mut page, "job.src");
    save(&mut page, &job, "job.src").unwrap();
    let params = json!({ "source": { "file": "job.cls" }, "machine": "mine.toml", "program": { "file": "job.src" } });
    let there = page.done("prove", params);
    assert_eq!((&there["verdict"], &there["parts"]), (&json!("done"), &job["parts"]), "{there}");
    assert_eq!(
        text(&mut page, &there, Some("job_2.src")),
        text(&mut page, &job, Some("job_2.src"))
    );
    fs::create_dir(studio.own().join("away")).unwrap();
    let saved = save(&mut page, &there, "away/job.src").unwrap();
    assert_eq!(
        saved["files"].as_array().unwrap().len(),
        2 + job["parts"].as_array().unwrap().len()
    );
    for file in ["job.src", "job_1.src", "job_2.src"] {
        let read = |folder: &str| fs::read(studio.own().join(folder).join(file)).unwrap();
        assert_eq!(read("away"), read(""), "{file}");
    }
}
