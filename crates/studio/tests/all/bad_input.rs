//! What is odd or endless: it is answered, soon, and with a way out.

use crate::client::Studio;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::time::{Duration, Instant};
use toolpost_studio::message::Array;

const HEAD: &str = "UNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\n";
const END: &str = "RAPID\nGOTO/0,0,10\n";

/// Posts a source, and answers what was done or why not, within a time that is long for a busy machine and short for a hang.
fn post(studio: &Studio, text: &str, machine: &str) -> Result<Value, Value> {
    std::fs::write(studio.own().join("odd.cls"), text).unwrap();
    let params = json!({ "source": { "file": "odd.cls" }, "machine": machine });
    let begun = Instant::now();
    let answer = studio.socket().answer("post", params, &[]);
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
    answer.map(|mut frame| frame.head.remove("done").unwrap())
}

#[test]
fn a_million_findings_are_told_in_a_few_and_counted() {
    let studio = Studio::new();
    let mut text = HEAD.to_owned();
    for i in 0..1_000_000 {
        let _ = writeln!(text, "NOSUCHWORD/{i}");
    }
    let job = post(&studio, &(text + "GOTO/1,0,-1\n" + END), "generic-3axis-linuxcnc").unwrap();
    let found = job["findings"].as_array().unwrap();
    let most = found.iter().max_by_key(|found| found["count"].as_u64()).unwrap();
    assert_eq!((&most["count"], &most["line"]), (&json!(1_000_000), &json!(7)), "{}", found.len());
    assert_eq!(most["places"].as_array().unwrap().len(), 10_000);
    // Each of another kind: it is no toolpath, and that is told at once.
    let mut text = HEAD.to_owned();
    for i in 0..1_000_000 {
        let _ = writeln!(text, "WORD{i}/1");
    }
    let stop = post(&studio, &text, "generic-3axis-linuxcnc").unwrap_err();
    let found = stop["findings"].as_array().unwrap();
    assert_eq!((found.len(), &found[0]["rule"]), (1, &json!("not-cldata")), "{stop}");
}

#[test]
fn a_place_a_thousand_kilometres_away_is_refused_or_drawn_there() {
    let studio = Studio::new();
    for far in ["1000000000", "1e9", "1e15", "1e300"] {
        let text = format!("{HEAD}GOTO/0,0,-1\nGOTO/{far},0,-1\n{END}");
        match post(&studio, &text, "generic-3axis-linuxcnc") {
            Ok(job) => {
                let far: f64 = far.parse().unwrap();
                assert_eq!(job["walk"]["box"][1][0].as_f64(), Some(far), "{}", job["walk"]);
                studio.get(&format!("/geometry/{}/0/0", job["revision"]));
            }
            Err(stop) => {
                let help = stop["findings"][0]["help"].as_str().unwrap();
                assert!(!help.is_empty(), "{stop}");
            }
        }
    }
}

/// LinuxCNC: `P` of an arc is the number of its turns.
#[test]
fn a_helix_of_a_hundred_thousand_turns_is_read_and_the_page_is_told() {
    let studio = Studio::new();
    let source = format!("{HEAD}GOTO/10,0,0\nGOTO/10,0,-1\n{END}");
    std::fs::write(studio.own().join("odd.cls"), source).unwrap();
    let program = "G21 G90 G17 G94\nT1 M6\nS900 M3\nG0 X0 Y0 Z10\nG1 X10 Y0 Z0 F90\nG2 X10 Y0 Z-1 I-10 J0 P100000\nM30\n";
    let params = json!({ "source": { "file": "odd.cls" }, "machine": "generic-3axis-linuxcnc", "file": "odd.ngc" });
    let begun = Instant::now();
    let answer = studio.socket().answer("prove", params, &[Array::text("text", program)]);
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
    let head = answer.map_or_else(|stop| stop, |frame| frame.head["done"].clone());
    assert_eq!(head["verdict"], "failed", "{head}");
    assert!(!head["findings"].as_array().unwrap().is_empty());
}

/// Of a walk that is empty all is asked that a page asks.
#[test]
fn a_source_without_moves_is_a_program_without_places() {
    let studio = Studio::new();
    for text in ["", "UNITS/MM\nFINI\n", "UNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nFINI\n"] {
        let job = match post(&studio, text, "generic-3axis-linuxcnc") {
            Ok(job) => job,
            Err(stop) => {
                assert_ne!(stop["findings"][0]["help"], "", "{stop}");
                continue;
            }
        };
        let mut page = studio.socket();
        let revision = &job["revision"];
        assert!(job["walk"]["box"].is_null(), "{}", job["walk"]);
        for by in ["time", "move", "block", "source"] {
            let place = page.done("place", json!({ "revision": revision, "by": by, "value": 1 }));
            assert!(place.is_null() || place["tip"][0].is_null(), "{place}");
        }
        let plot = json!({ "revision": revision, "what": "X", "from": 0, "to": 1, "pixels": 10 });
        page.done("plot", plot);
        studio.get(&format!("/geometry/{revision}/index"));
    }
}

#[test]
fn what_is_no_number_is_refused_on_its_line() {
    let studio = Studio::new();
    for wrong in ["NaN", "nan", "inf", "-inf", "1e999", "0x10", "1.2.3", "--1"] {
        let text = format!("{HEAD}GOTO/1,0,-1\nGOTO/{wrong},0,-1\n{END}");
        let stop = post(&studio, &text, "generic-3axis-linuxcnc").unwrap_err();
        let found = &stop["findings"][0];
        assert_eq!((&found["severity"], &found["line"]), (&json!("error"), &json!(8)), "{stop}");
    }
    // The same in a program that is proven.
    let job =
        post(&studio, &format!("{HEAD}GOTO/1,0,-1\n{END}"), "generic-3axis-linuxcnc").unwrap();
    let mut page = studio.socket();
    let lines = json!({ "revision": job["revision"], "of": "program", "from": 1, "to": 99 });
    let text = page.answer("text", lines, &[]).unwrap().take_text("text").unwrap();
    let text = String::from_utf8(text).unwrap();
    let line = 1 + text.lines().position(|line| line.contains("X1")).unwrap();
    for wrong in ["NaN", "nan", "inf", "-inf", "1e999", "1.2.3"] {
        let program = text.replacen("X1", &format!("X{wrong}"), 1);
        let params = json!({ "source": { "file": "odd.cls" }, "machine": "generic-3axis-linuxcnc", "file": "odd.ngc" });
        let answer = page.answer("prove", params, &[Array::text("text", program)]);
        let head = answer.map_or_else(|stop| stop, |frame| frame.head["done"].clone());
        let found = &head["findings"][0];
        assert_ne!(head["verdict"], "done", "{wrong}");
        assert_eq!((&found["severity"], &found["line"]), (&json!("error"), &json!(line)), "{head}");
    }
    // What is asked for: JSON has no such numbers, and those that are too large for any are none either.
    let job =
        post(&studio, &format!("{HEAD}GOTO/1,0,-1\n{END}"), "generic-3axis-linuxcnc").unwrap();
    let mut page = studio.socket();
    let place = json!({ "revision": job["revision"], "by": "time", "value": null });
    assert_eq!(page.refused("place", place), "studio-ask");
    let plot = json!({ "revision": job["revision"], "what": "X", "from": 1e300, "to": -1e300, "pixels": 4_000_000_000_u32 });
    let frame = page.answer("plot", plot, &[]);
    assert!(frame.is_err() || frame.is_ok_and(|frame| frame.arrays.len() == 2));
}

#[test]
fn a_machine_without_travels_has_none() {
    let studio = Studio::new();
    let machine = "extends = \"generic-3axis-linuxcnc\"\ntitle = \"Bare\"\n";
    std::fs::write(studio.own().join("bare.toml"), machine).unwrap();
    let job = post(&studio, &format!("{HEAD}GOTO/1,0,-1\n{END}"), "bare.toml").unwrap();
    assert_eq!(job["verdict"], "done", "{job}");
    for axis in job["machine"]["axes"].as_array().unwrap() {
        assert_eq!((&axis["low"], &axis["high"]), (&Value::Null, &Value::Null), "{axis}");
    }
    assert_eq!(job["machine"]["linkage"]["axes"].as_array().unwrap().len(), 3);
}

#[test]
fn templates_that_loop_or_print_for_ever_are_refused() {
    let studio = Studio::new();
    for template in [
        "{% for a in range(99999) %}{% for b in range(99999) %}{% endfor %}{% endfor %}",
        "{% for a in range(99999) %}xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx{% endfor %}",
        "{% macro a() %}{{ a() }}{% endmacro %}{{ a() }}",
    ] {
        let machine =
            format!("extends = \"generic-3axis-linuxcnc\"\n[blocks]\nlinear = \"{template}\"\n");
        std::fs::write(studio.own().join("endless.toml"), machine).unwrap();
        let mut text = HEAD.to_owned();
        (0..2000).for_each(|i| _ = writeln!(text, "GOTO/{i},0,-1"));
        let stop = post(&studio, &(text + END), "endless.toml").unwrap_err();
        let mut found = stop["findings"].as_array().unwrap().iter();
        let found = found.find(|found| found["severity"] == "error").unwrap();
        assert!(found["rule"].as_str().unwrap().starts_with("template"), "{stop}");
        let file = found["file"].as_str().unwrap();
        assert!(file.ends_with("endless.toml") && found["help"] != "", "{stop}");
    }
}
