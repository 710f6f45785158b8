//! Robots whose controllers take no program of that size: in several files, which a main program calls, proven together.

use crate::robot::source;
use control::Folders;
use machine::Machine;
use program::Program;
use proof::Report;
use std::collections::BTreeMap;

/// Rows of points that rise and fall, each with a retract behind it.
fn rows(count: usize, points: usize) -> String {
    let mut text =
        String::from("PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nFEDRAT/MMPM,1200\n");
    for row in 0..count {
        let y = 40.0 * row as f64 / count as f64;
        text += &format!("RAPID\nGOTO/0,{y:.3},30\nGOTO/0,{y:.3},-1\n");
        for point in 1..=points {
            let x = 60.0 * point as f64 / points as f64;
            let z = -1.0 - 0.5 * (x / 5.0).sin().abs();
            text += &format!("GOTO/{x:.3},{y:.3},{z:.3}\n");
        }
        text += &format!("RAPID\nGOTO/60,{y:.3},30\n");
    }
    text + "FINI\n"
}

/// A robot of the library whose control takes no larger file.
fn bounded(name: &str, bound: &str) -> Machine {
    let title = "title = ";
    crate::robot::changed(name, &[(title, &format!("capabilities = {{ {bound} }}\n{title}"))])
}

/// A program, and the files that it calls.
#[derive(Clone, Debug)]
struct Written {
    text: String,
    parts: BTreeMap<String, Vec<u8>>,
}

fn written(source: &Program, machine: &Machine) -> Written {
    let output = post::write(source, machine).unwrap();
    let parts = output.parts.into_iter().map(|part| (part.file, part.text)).collect();
    Written { text: String::from_utf8(output.text).unwrap(), parts }
}

fn proof_of(source: &Program, machine: &Machine, written: &Written) -> Report {
    let folders = Folders::from(written.parts.clone());
    let text = ("job", written.text.as_bytes(), &folders);
    proof::prove_files(source, machine, text, &Default::default(), &mut ())
}

fn rules(report: &Report) -> Vec<&str> {
    report.mismatches.iter().map(|found| found.rule.name()).collect()
}

/// How many lines carry a number.
fn numbered(text: &[u8]) -> usize {
    let text = String::from_utf8_lossy(text);
    text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())).count()
}

#[test]
fn a_job_of_10_000_points_is_divided_at_retracts_and_proven_with_its_parts() {
    let source = source(&rows(100, 100));
    for (name, bound) in [
        ("fanuc-lrmate-200id-mill", "program_lines = 2500"),
        ("fanuc-lrmate-200id-mill", "program_points = 2500"),
        ("kuka-kr6-r900", "program_bytes = 200000"),
        ("kuka-kr6-r900", "program_lines = 2500"),
        ("abb-irb120-mill", "program_lines = 2500"),
    ] {
        let machine = bounded(name, bound);
        let written = written(&source, &machine);
        let report = proof_of(&source, &machine, &written);
        assert!(report.proven, "{name}: {:#?}", report.mismatches);
        assert!((4..=6).contains(&written.parts.len()), "{name}: {}", written.parts.len());
        for (file, text) in &written.parts {
            let can = &machine.capabilities;
            let lines = match name.starts_with("fanuc") {
                true => numbered(text),
                false => text.iter().filter(|byte| **byte == b'\n').count(),
            };
            let text = String::from_utf8_lossy(text);
            let points = text.matches("P[").count();
            assert!(lines <= can.program_lines, "{file} has {lines} lines");
            assert!(text.len() <= can.program_bytes, "{file} has {} bytes", text.len());
            assert!(points / 2 <= can.program_points, "{file} has {points} points");
        }
    }
}

#[test]
fn a_program_that_fits_is_whole() {
    let source = source(&rows(3, 10));
    let machine = machine::load("fanuc-lrmate-200id-mill").unwrap();
    assert!(written(&source, &machine).parts.is_empty());
}

/// Four rows, each in a file of its own.
fn four(name: &str, bound: &str) -> (Program, Machine, Written) {
    let (source, machine) = (source(&rows(4, 10)), bounded(name, bound));
    let written = written(&source, &machine);
    let report = proof_of(&source, &machine, &written);
    assert!(report.proven, "{written:?}\n{:#?}", report.mismatches);
    assert_eq!(written.parts.len(), 4, "{written:?}");
    (source, machine, written)
}

const ROBOTS: [(&str, &str); 3] = [
    ("fanuc-lrmate-200id-mill", "program_lines = 42"),
    ("kuka-kr6-r900", "program_lines = 44"),
    ("abb-irb120-mill", "program_lines = 38"),
];

/// How a program calls a part.
fn call_of(robot: &str, number: usize) -> String {
    match robot.split_once('-') {
        Some(("fanuc", _)) => format!("CALL JOB_{number} ;"),
        Some(("kuka", _)) => format!("JOB_{number} ( )"),
        _ => format!(
            "Load \\Dynamic,diskhome\\File:=\"job_{number}.mod\";\r\n%\"JOB_{number}\"%;\r\nUnLoad diskhome\\File:=\"job_{number}.mod\";"
        ),
    }
}

#[test]
fn a_main_program_calls_its_parts_by_the_names_of_their_files() {
    let (.., written) = four(ROBOTS[0].0, ROBOTS[0].1);
    let calls =
        "1:CALL JOB_1 ;\r\n2:CALL JOB_2 ;\r\n3:CALL JOB_3 ;\r\n4:CALL JOB_4 ;\r\n/POS\r\n/END\r\n";
    assert!(written.text.ends_with(calls), "{}", written.text);
    assert!(written.text.contains("/PROG JOB\r\n") && written.text.contains("LINE_COUNT = 4;"));
    let names: Vec<&str> = written.parts.keys().map(String::as_str).collect();
    assert_eq!(names, ["job_1.ls", "job_2.ls", "job_3.ls", "job_4.ls"]);
    // Each part is a whole program: it states its frames and begins by the joints.
    let part = String::from_utf8_lossy(&written.parts["job_2.ls"]);
    assert!(
        part.starts_with("/PROG JOB_2\r\n") && part.contains("\r\n17:J P[1] 20% FINE ;\r\n"),
        "{part}"
    );
    let (.., written) = four(ROBOTS[1].0, ROBOTS[1].1);
    let calls = "JOB_1 ( )\r\nJOB_2 ( )\r\nJOB_3 ( )\r\nJOB_4 ( )\r\nEND\r\n";
    assert!(written.text.ends_with(calls), "{}", written.text);
    let part = String::from_utf8_lossy(&written.parts["job_2.src"]);
    assert!(part.contains("DEF JOB_2 ( )\r\n") && part.contains("\r\nPTP {A1 "), "{part}");
    // The example of `Load` in the Technical reference manual RAPID: load, a call by name, unload.
    let (.., written) = four(ROBOTS[2].0, ROBOTS[2].1);
    let calls: Vec<String> = (1..=4).map(|number| call_of(ROBOTS[2].0, number)).collect();
    let calls =
        format!("PROC main()\r\n{}\r\nEXIT;\r\nENDPROC\r\nENDMODULE\r\n", calls.join("\r\n"));
    assert!(written.text.ends_with(&calls), "{}", written.text);
    let part = String::from_utf8_lossy(&written.parts["job_2.mod"]);
    let (begins, ends) = ("MODULE MOD_JOB_2\r\n", "\r\nENDPROC\r\nENDMODULE\r\n");
    assert!(part.starts_with(begins) && part.ends_with(ends) && !part.contains("EXIT"), "{part}");
    assert!(part.contains("\r\nPROC JOB_2()\r\n") && part.contains("\r\nMoveAbsJ "), "{part}");
}

/// Each damage to the files of a program, and the rule by which the proof refuses it.
#[test]
fn a_part_that_is_missing_or_in_the_wrong_order_or_called_twice_or_begins_in_a_cut_is_refused() {
    for (name, bound) in ROBOTS {
        let (source, machine, written) = four(name, bound);
        let call = |number: usize| call_of(name, number);
        let damaged = |text: String| {
            assert_ne!(text, written.text);
            let report =
                proof_of(&source, &machine, &Written { text, parts: written.parts.clone() });
            assert!(!report.proven);
            rules(&report).join(" ")
        };
        // A file is not there; a call is left out; two are exchanged; one is there twice.
        let mut without = written.clone();
        without.parts.retain(|file, _| !file.contains("_3"));
        assert_eq!(rules(&proof_of(&source, &machine, &without)), ["called-program"], "{name}");
        let ending = if name.starts_with("fanuc") { "3:" } else { "" };
        let left_out = format!("{ending}{}\r\n", call(3));
        assert_eq!(damaged(written.text.replace(&left_out, "")), "end-point", "{name}");
        let exchanged = written.text.replace(&call(2), "?").replace(&call(3), &call(2));
        assert_eq!(damaged(exchanged.replace('?', &call(3))), "end-point", "{name}");
        assert_eq!(damaged(written.text.replace(&call(3), &call(2))), "end-point", "{name}");
        assert_eq!(damaged(written.text.replace(&call(1), &call(2))), "home", "{name}");
        // The name in a file is that of another.
        let mut renamed = written.clone();
        let two = renamed.parts[&format!("job_2.{}", machine.extension)].clone();
        renamed.parts.insert(format!("job_3.{}", machine.extension), two);
        assert_eq!(rules(&proof_of(&source, &machine, &renamed)), ["called-program"], "{name}");
    }
}

/// A difference, and what is not understood, in a part: the finding has its file and the line in it.
#[test]
fn a_finding_in_a_part_names_its_file_and_its_line() {
    for (name, bound) in ROBOTS {
        let (source, machine, written) = four(name, bound);
        let (file, from, to, unknown) = match name.split_once('-') {
            Some(("fanuc", _)) => ("job_2.ls", ":L P[5]", ":L P[6]", "syntax"),
            Some(("kuka", _)) => {
                ("job_2.src", "LIN {X 12.000,Y 10.000", "LIN {X 12.000,Y 11.000", "unknown-word")
            }
            _ => ("job_2.mod", "MoveL [[12.000,10.000", "MoveL [[12.000,11.000", "syntax"),
        };
        let text = String::from_utf8(written.parts[file].clone()).unwrap();
        let line = 1 + text.lines().position(|line| line.contains(from)).unwrap();
        for (to, rule) in [(to, "path"), ("nonsense", unknown)] {
            let mut damaged = written.clone();
            damaged.parts.insert(file.into(), text.replacen(from, to, 1).into_bytes());
            let report = proof_of(&source, &machine, &damaged);
            let found = &report.mismatches[0];
            assert_eq!(
                (found.rule.name(), &*found.file, found.line),
                (rule, file, line as u32),
                "{found}"
            );
            assert!(found.excerpt.contains(to), "{found}");
            let first = report.first_mismatch.unwrap();
            assert_eq!(first.program_file.as_deref(), Some(file));
            assert!(first.block.contains(to), "{first:?}");
        }
    }
}

/// A load that only the operator knows, chosen at the beginning of a part.
#[test]
fn another_load_in_a_part_is_refused() {
    let (source, machine, mut written) = four(ROBOTS[0].0, ROBOTS[0].1);
    let part = String::from_utf8(written.parts["job_2.ls"].clone()).unwrap();
    let part = part.replacen("/MN\r\n", "/MN\r\n1:PAYLOAD[2] ;\r\n", 1);
    written.parts.insert("job_2.ls".into(), part.into_bytes());
    let report = proof_of(&source, &machine, &written);
    assert_eq!(rules(&report), ["payload"], "{:?}", report.mismatches);
    assert_eq!(report.mismatches[0].file, "job_2.ls");
}

/// Where the first cut of a file begins: the instructions before stay in the file before.
#[test]
fn a_file_that_begins_within_a_cut_is_refused() {
    for (name, bound) in ROBOTS {
        let (source, machine, written) = four(name, bound);
        let is_fanuc = name.starts_with("fanuc");
        let (file, other, mark, begin, end) = match name.split_once('-') {
            Some(("fanuc", _)) => ("job_2.ls", "job_9.ls", ":L P[", "/MN\r\n", "/POS"),
            Some(("kuka", _)) => ("job_2.src", "job_9.src", "LIN {", "( )\r\n", "END\r\n"),
            _ => ("job_2.mod", "job_9.mod", "MoveL [", "()\r\n", "ENDPROC\r\n"),
        };
        let mut part = String::from_utf8(written.parts[file].clone()).unwrap();
        // A corner that is passed is refused before that.
        while let Some(at) = part.find("[FALSE,0.") {
            let end = at + part[at..].find(']').unwrap();
            part.replace_range(at..=end, "fine");
        }
        // Its fifth line of a cut and all behind it go into a file of their own, with the same head and positions.
        let at = part.match_indices(mark).nth(4).unwrap().0;
        let at = part[..at].rfind("\r\n").unwrap() + 2;
        let end = part.find(end).unwrap();
        let begin = part.find(begin).unwrap() + begin.len();
        let number = if is_fanuc { "99:" } else { "" };
        let call = format!("{number}{}\r\n", call_of(name, 9));
        let first = format!("{}{call}{}", &part[..at], &part[end..]);
        let second = format!("{}{}{}", &part[..begin], &part[at..end], &part[end..]);
        let mut damaged = written.clone();
        damaged.parts.insert(file.into(), first.into_bytes());
        let second = second.replace("JOB_2", "JOB_9");
        damaged.parts.insert(other.into(), second.into_bytes());
        let report = proof_of(&source, &machine, &damaged);
        assert_eq!(rules(&report), ["file-border"], "{name}: {:?}", report.mismatches);
    }
}

#[test]
fn what_cannot_be_divided_is_refused() {
    let source = source(&rows(1, 200));
    let found = post::write(&source, &bounded(ROBOTS[0].0, "program_lines = 150")).unwrap_err();
    assert!(found[0].message.contains("no retract"), "{}", found[0]);
    // A control without a call.
    let found =
        post::write(&source, &bounded("universal-ur5e", "program_lines = 150")).unwrap_err();
    assert!(found[0].message.contains("no call of another file"), "{}", found[0]);
    assert!(found[0].help.contains("for each operation"), "{}", found[0]);
}
