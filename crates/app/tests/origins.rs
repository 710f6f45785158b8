//! Which template and which record made each line of a program, against the template's own words and against the record that the proof
//! finds for the same line.

use machine::{Machine, library};
use program::{Program, Purpose, Record};
use proof::{Motion, MotionKind, Observer, Tolerances};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use toolpost_app::post::{self, Posted};
use toolpost_app::{Origin, Source, Verdict, Watch, toolpath, wire};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The records of the source, and the motions.
#[derive(Default)]
struct Walked(Mutex<(Vec<Record>, Vec<Motion>)>);

struct Follower<'a> {
    walked: &'a Walked,
    motions: Vec<Motion>,
}

impl Watch for Walked {
    fn follow<'a>(
        &'a self,
        _file: &str,
        source: &'a Program,
        _machine: &'a Machine,
    ) -> Box<dyn Observer + 'a> {
        self.0.lock().unwrap().0.clone_from(&source.records);
        Box::new(Follower { walked: self, motions: Vec::new() })
    }
}

impl Observer for Follower<'_> {
    fn wants_motions(&self) -> bool {
        true
    }

    fn moved(&mut self, motion: &Motion) {
        self.motions.push(motion.clone());
    }

    fn ended(&mut self, _report: &proof::Report) {
        self.walked.0.lock().unwrap().1 = std::mem::take(&mut self.motions);
    }
}

/// The literal text of each line of a template, in pieces: between what stands in braces. No lines where it has statements, which may
/// leave out any of them.
fn literals(template: &str) -> Vec<Vec<String>> {
    if template.contains("{%") || template.contains("{#") {
        return Vec::new();
    }
    let pieces = |line: &str| {
        let (mut pieces, mut rest) = (Vec::new(), line);
        while let Some((before, behind)) = rest.split_once("{{") {
            pieces.push(before.to_owned());
            rest = behind.split_once("}}").map_or("", |(_, rest)| rest);
        }
        pieces.push(rest.to_owned());
        pieces.retain(|piece| !piece.trim().is_empty());
        pieces.iter().map(|piece| piece.trim().to_owned()).collect()
    };
    template.lines().map(pieces).collect()
}

/// Whether these pieces stand in the line, one behind the other.
fn has(mut line: &str, pieces: &[String]) -> bool {
    pieces.iter().all(|piece| match line.split_once(&**piece) {
        Some((_, behind)) => {
            line = behind;
            true
        }
        None => false,
    })
}

/// Compares the origins of one program; how many lines have a template without statements, and how many motions were compared.
fn compare(machine: &Machine, posted: &Posted, walked: Walked) -> (usize, usize) {
    let name = &machine.name;
    assert_eq!(posted.account.verdict, Verdict::Done, "{name}: {:?}", posted.account.findings);
    let (records, motions) = walked.0.into_inner().unwrap();
    let mut files = BTreeMap::from([(None, (&posted.text, &posted.origins))]);
    for part in &posted.parts {
        files.insert(Some(&*part.file), (&part.text, &part.origins));
    }
    let mut plain = 0;
    for (text, origins) in files.values() {
        let text = String::from_utf8_lossy(text);
        assert_eq!(origins.lines(), text.lines().count(), "{name}");
        for (i, line) in text.lines().enumerate() {
            let origin = origins.of(i as u32 + 1).unwrap();
            let template = origin.template(machine).unwrap_or_else(|| panic!("{name}: {origin:?}"));
            let literals = literals(&template.text);
            let found = literals.is_empty() || literals.iter().any(|pieces| has(line, pieces));
            assert!(found, "{name}, line {}: {line:?} is not of {template:?}", i + 1);
            plain += usize::from(!literals.is_empty());
            assert!(
                origin.record.is_none_or(|record| record < records.len()),
                "{name}: {origin:?}"
            );
        }
        assert_eq!(origins.of(0), None);
        assert_eq!(origins.of(text.lines().count() as u32 + 1), None);
    }
    let mut compared = 0;
    for motion in &motions {
        // Of a rapid of several blocks the last one makes the record; the others may be on the way to a tool change. An arm goes straight up on its way
        // home, which is no record's.
        let pose = records.get(motion.record).and_then(|record| record.op.pose());
        let arrives = pose.is_some_and(|to| to.point().distance(motion.tool[1].tip) < 0.01);
        let (_, origins) = files[&motion.file.as_deref()];
        let origin = origins.of(motion.line).unwrap();
        let is_up = machine.arm.is_some() && origin.record.is_none();
        let is_rapid = is_up || matches!(motion.kind, MotionKind::Rapid | MotionKind::Joints);
        if is_rapid && !arrives {
            continue;
        }
        let wrote = origin.record.map(|record| records[record].line);
        assert_eq!(wrote, Some(motion.source_line), "{name}, line {}: {motion:?}", motion.line);
        if machine.wire.is_none() && !matches!(motion.kind, MotionKind::Rapid | MotionKind::Joints)
        {
            assert_eq!(origin.record, Some(motion.record), "{name}, line {}", motion.line);
        }
        compared += 1;
    }
    (plain, compared)
}

#[test]
fn each_line_names_the_template_and_the_record_that_made_it() {
    let (mut lines, mut motions, mut machines) = (0, 0, 0);
    for name in library::names(library::CONTROLLED) {
        let machine = machine::load(name).unwrap();
        if machine.wire.is_some() {
            continue;
        }
        let sample = match (machine.cell.is_some(), machine.rotary.is_empty()) {
            (true, _) => "robot",
            (_, true) => "three-axes",
            (_, false) => "five-axes",
        };
        let source = root().join("machines/samples").join(sample).with_extension("cls");
        let source = Source::from(source);
        let toolpath =
            toolpath::read(&source, false, &Origin::default(), Some(&machine), Purpose::Program);
        let walked = Walked::default();
        let tolerances = Tolerances::default();
        let posted =
            post::proven(&toolpath.unwrap(), &machine, "sample", &tolerances, &walked).unwrap();
        let (plain, compared) = compare(&machine, &posted, walked);
        (lines, motions, machines) = (lines + plain, motions + compared, machines + 1);
    }
    assert!(lines > 600 && motions > 600 && machines > 30, "{lines} {motions} {machines}");
}

#[test]
fn lines_of_a_wire_name_the_record_of_the_contour() {
    let origin = wire_origin();
    for name in library::names(library::MACHINES) {
        let machine = machine::load(name).unwrap();
        if machine.wire.is_none() {
            continue;
        }
        let walked = Walked::default();
        let source = Source::from(root().join("examples/sector.nc"));
        let settings = wire::Settings::default();
        let tolerances = Tolerances::default();
        let made = wire::make(
            &source,
            false,
            &origin,
            machine.clone(),
            &settings,
            "w",
            &tolerances,
            &walked,
        );
        let (_, compared) = compare(&machine, &made.unwrap().posted, walked);
        assert!(compared >= 3, "{name}: {compared}");
    }
}

fn wire_origin() -> Origin {
    Origin { from: Some("fanuc-31i".into()), ..Origin::default() }
}

#[test]
fn lines_of_the_files_of_a_robot_name_their_records_too() {
    let mut text =
        String::from("PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,12000,CLW\nFEDRAT/MMPM,1200\n");
    for row in 0..8 {
        let y = 5.0 * f64::from(row);
        text += &format!("RAPID\nGOTO/0,{y},30\nGOTO/0,{y},-1\n");
        (1..=10)
            .for_each(|x| text += &format!("GOTO/{},{y},{}\n", 6 * x, -1.0 - 0.1 * f64::from(x)));
        text += &format!("RAPID\nGOTO/60,{y},30\n");
    }
    text += "FINI\n";
    for (name, bound) in [("fanuc-lrmate-200id-mill", 60), ("kuka-kr6-r900", 120)] {
        let file = format!("extends = \"{name}\"\n[capabilities]\nprogram_lines = {bound}\n");
        let machine = machine::load_text("bounded.toml", &file).unwrap();
        let source = Source::memory("job.cls", text.clone().into_bytes());
        let toolpath =
            toolpath::read(&source, false, &Origin::default(), Some(&machine), Purpose::Program);
        let (walked, tolerances) = (Walked::default(), Tolerances::default());
        let posted =
            post::proven(&toolpath.unwrap(), &machine, "job", &tolerances, &walked).unwrap();
        assert!(posted.parts.len() > 1, "{name}: {}", posted.parts.len());
        let (_, compared) = compare(&machine, &posted, walked);
        assert!(compared > 80, "{name}: {compared}");
    }
}

#[test]
fn what_the_head_has_more_shifts_no_record() {
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let source = Source::from(root().join("machines/samples/three-axes.cls"));
    let toolpath =
        toolpath::read(&source, false, &Origin::default(), Some(&machine), Purpose::Program);
    let accepted = proof::Accepted::default().and("left-on").unwrap();
    let tolerances = Tolerances { accepted, ..Tolerances::default() };
    let walked = Walked::default();
    let posted = post::proven(&toolpath.unwrap(), &machine, "s", &tolerances, &walked).unwrap();
    assert!(String::from_utf8_lossy(&posted.text).contains("accepted for this run"));
    compare(&machine, &posted, walked);
}

/// The texts of codes are the machine file's: one that breaks lines makes no program, and harms nothing.
#[test]
fn a_code_that_breaks_lines_ends_no_writer() {
    let many = "N\\n".repeat(100);
    let file = format!(
        "extends = \"fanuc-lrmate-200id-mill\"\n[words.wrist]\ncodes = {{ plain = \"{many}\", flipped = \"{many}\" }}\n"
    );
    let machine = machine::load_text("odd.toml", &file).unwrap();
    let source = Source::from(root().join("machines/samples/robot.cls"));
    let toolpath =
        toolpath::read(&source, false, &Origin::default(), Some(&machine), Purpose::Program);
    let tolerances = Tolerances::default();
    let posted = post::proven(&toolpath.unwrap(), &machine, "odd", &tolerances, &());
    assert!(posted.is_err() || posted.unwrap().account.verdict != Verdict::Done);
}
