//! Every kind of record with those that handle it: the table of `docs/architecture.md`, found by doing it.
//!
//! `TOOLPOST_DOCS=write cargo test -p toolpost --test all records` writes the table anew.

use crate::samples::{Sample, at, lines, sample};
use geom::Vec3;
use machine::Machine;
use program::statistics::Statistics;
use program::{ArcTo, Circle, Compensation, Feed, Kind, Op, Program, Spindle, Tool};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A program of a mill around the sample, with and without its record.
fn milled(kind: Kind) -> [Program; 2] {
    let Sample { before, op, after } = sample(kind);
    [true, false].map(|with| {
        let start = [
            Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })),
            Op::Spindle(Spindle::Clockwise(1000.0)),
            Op::Feed(Feed::PerMinute(300.0)),
            Op::Rapid(at(0.0, 0.0, 6.0)),
            Op::Line(at(0.0, 0.0, -1.0)),
        ];
        let rest = [Op::Line(at(10.0, 5.0, -1.0)), Op::Rapid(at(10.0, 5.0, 6.0)), Op::End];
        let rest = if kind == Kind::End { Vec::new() } else { rest.to_vec() };
        let op = with.then_some(op.clone());
        let all = start.into_iter().chain(before.clone()).chain(op).chain(after.clone());
        lines(all.chain(rest))
    })
}

/// A program of a wire machine, with and without the record: in an opening, or instead of the record that opens or
/// ends it. What is switched on ends with the last cut.
fn wired(kind: Kind) -> [Program; 2] {
    [true, false].map(|with| {
        let own = matches!(kind, Kind::ThreadWire | Kind::CutWire | Kind::End);
        let op = match kind {
            Kind::Line => Op::Line(at(25.0, 10.0, 0.0)),
            Kind::Arc => {
                let (end, center) = (at(20.0, 10.0, 0.0), Vec3::new(20.0, 5.0, 0.0));
                Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, Vec3::Z, 0).unwrap() }))
            }
            Kind::Compensation => Op::Compensation(Compensation::Left(Some(1))),
            other => sample(other).op,
        };
        let off = match kind {
            Kind::Compensation => Some(Op::Compensation(Compensation::Off)),
            Kind::Taper => Some(Op::Taper(0.0)),
            _ => None,
        };
        let cuts = [at(20.0, 0.0, 0.0), at(20.0, 20.0, 0.0), at(0.0, 20.0, 0.0)].map(Op::Line);
        let [first, second, third] = cuts;
        let all = [Op::Rapid(at(0.0, 0.0, 0.0)), Op::ThreadWire, first]
            .into_iter()
            .chain((with && !own).then_some(op))
            .chain([second, third])
            .chain(off.filter(|_| with))
            .chain([Op::Line(at(0.0, 10.0, 0.0)), Op::CutWire, Op::End]);
        lines(all.filter(|op| with || !own || op.kind() != kind))
    })
}

/// What the writer makes of the record: a text, or the rule by which it refuses.
fn writes(with: &Program, without: &Program, machine: &Machine) -> String {
    let text = |program: &Program| post::write(program, machine);
    match (text(with), text(without)) {
        (Ok(with), Ok(without)) if with.text == without.text => {
            let is_reported = with.warnings.len() > without.warnings.len();
            if is_reported { "leaves it out, with a warning" } else { "nothing" }.into()
        }
        (Ok(_), _) => "writes it".into(),
        (Err(found), _) => format!("refuses (`{}`)", found[0].rule),
    }
}

/// What the proof makes of it: whether a program without the record is refused as one of the source with it, or the
/// other way round. A record that cannot be compared is refused whatever the program says.
fn proves(with: &Program, without: &Program, machine: &Machine) -> &'static str {
    let text = |program: &Program| post::write(program, machine).ok().map(|output| output.text);
    let prove = |source: &Program, text: &[u8]| {
        proof::prove(source, machine, "sample", text, &Default::default())
    };
    let proven = |source: &Program, text: &[u8]| prove(source, text).proven;
    match (text(with), text(without)) {
        (Some(own), other) => {
            let report = prove(with, &own);
            let text = String::from_utf8_lossy(&own);
            assert!(report.proven, "{:?}\n{text}\n{:?}", with.records, report.mismatches);
            let accepted = proven(without, &own) && other.is_none_or(|text| proven(with, &text));
            if accepted { "not compared" } else { "compares it" }
        }
        (None, Some(other)) => {
            if proven(with, &other) {
                "passes it over"
            } else {
                "refuses"
            }
        }
        (None, None) => "refuses",
    }
}

/// How long what the writer makes of it takes, s; none where it refuses.
fn takes(program: &Program, machine: &Machine) -> Option<f64> {
    let text = post::write(program, machine).ok()?.text;
    let report = proof::prove(program, machine, "sample", &text, &Default::default());
    Some(report.program.time_s.total())
}

/// The table, a row for each kind.
fn table() -> String {
    let load = |text: &str| machine::load_text("sample.toml", text).unwrap();
    let mill = load("extends = \"generic-3axis-linuxcnc\"\nauxiliary = [101]\n");
    let wire = load("extends = \"fanuc-wire\"\nauxiliary = [101]\n");
    let mut table = String::from(
        "| record | a mill (LinuxCNC) | a wire machine (FANUC) | proof | time | statistics | picture |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for kind in Kind::ALL {
        let [with, without] = milled(kind);
        let [wire_with, wire_without] = wired(kind);
        let own = matches!(kind, Kind::ThreadWire | Kind::CutWire | Kind::Taper);
        let proof = match own {
            true => proves(&wire_with, &wire_without, &wire),
            false => proves(&with, &without, &mill),
        };
        let counts = |differs: bool| if differs { "counts" } else { "" };
        // A record more is counted whatever it is.
        let statistics = |program: &Program| Statistics { records: 0, ..Statistics::of(program) };
        let picture = |program: &Program| drawing::tool_path("sample", program);
        writeln!(
            table,
            "| `{}` | {} | {} | {proof} | {} | {} | {} |",
            kind.name(),
            writes(&with, &without, &mill),
            writes(&wire_with, &wire_without, &wire),
            counts(takes(&with, &mill).is_some_and(|time| Some(time) != takes(&without, &mill))),
            counts(statistics(&with) != statistics(&without)),
            counts(picture(&with) != picture(&without)),
        )
        .unwrap();
    }
    table
}

fn architecture() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/architecture.md")
}

#[test]
fn the_table_of_records_is_that_of_the_documentation() {
    let text = std::fs::read_to_string(architecture()).unwrap();
    let (head, rest) = text.split_once("<!-- records -->\n").expect("a place for the table");
    let (stored, tail) = rest.split_once("<!-- end of records -->").expect("its end");
    let table = table();
    if std::env::var("TOOLPOST_DOCS").is_ok_and(|how| how == "write") {
        let text = format!("{head}<!-- records -->\n{table}<!-- end of records -->{tail}");
        std::fs::write(architecture(), text).unwrap();
        return;
    }
    assert_eq!(stored, table, "TOOLPOST_DOCS=write cargo test -p toolpost --test all records");
}

/// What is compared with nothing changes neither where the tool goes nor what it does there: a cycle matters for its
/// holes alone, a frame for the way in which poses are written, and every program has an end of its own. Clamps hold the axes
/// of the source's machine; those of this one are held to where its axes turn. Work offsets are the operator's, unless the
/// machine's file declares that programs write them (`operator.rs`).
#[test]
fn no_record_that_moves_or_switches_anything_is_proven_uncompared() {
    let free = [
        Kind::CycleOff,
        Kind::Preselect,
        Kind::Frame,
        Kind::Clamp,
        Kind::WorkOffsetData,
        Kind::Operation,
        Kind::EndOfOperation,
        Kind::Comment,
        Kind::Message,
        Kind::End,
    ];
    for row in table().lines().skip(2) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let name = cells[1].trim_matches('`');
        let is_free = free.iter().any(|kind| kind.name() == name);
        let compared = matches!(cells[4], "compares it" | "refuses");
        assert_ne!(is_free, compared, "{row}");
    }
}

/// Seeds of the fuzz targets and the samples of the library, hostile and plain, read as programs.
fn readings() -> Vec<(String, Program)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let files = |folder: &str| {
        let all = std::fs::read_dir(root.join(folder)).unwrap();
        let mut all: Vec<PathBuf> = all.map(|entry| entry.unwrap().path()).collect();
        all.sort();
        all.into_iter().filter(|path| path.is_file())
    };
    let mut found = Vec::new();
    let mut read = |machine: &str, path: &Path, text: &[u8]| {
        let machine = machine::load(machine).unwrap();
        for start in [None, Some(Vec3::ZERO)] {
            let setup = control::Setup { start, ..control::Setup::default() };
            if let Ok(reading) = nc::read(&machine, setup, "p", text) {
                found.push((path.display().to_string(), reading.program));
            }
        }
    };
    for path in files("fuzz/seeds/iso") {
        let bytes = std::fs::read(&path).unwrap();
        let Some((_, text)) = bytes.split_first() else { continue };
        for machine in ["generic-3axis-fanuc", "generic-3axis-linuxcnc", "fanuc-table-bc"] {
            read(machine, &path, text);
        }
    }
    for (folder, machine) in [
        ("fuzz/seeds/sinumerik", "sinumerik-840d-table-ac"),
        ("fuzz/seeds/klartext", "dmu50-heidenhain"),
    ] {
        files(folder).for_each(|path| read(machine, &path, &std::fs::read(&path).unwrap()));
    }
    for path in files("machines/samples") {
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.extension().is_some_and(|extension| extension != "cls") {
            read(&name, &path, &std::fs::read(&path).unwrap());
        }
    }
    for path in files("fuzz/seeds/apt") {
        let text = std::fs::read(&path).unwrap();
        if let Ok(reading) = source::apt::read("p", &text, &Default::default()) {
            found.push((path.display().to_string(), reading.program));
        }
    }
    found
}

/// A control may not know where the tool is; a program always does.
#[test]
fn a_program_that_has_been_read_holds_finite_numbers_alone() {
    let readings = readings();
    assert!(readings.len() > 40, "{}", readings.len());
    for (file, program) in readings {
        for record in &program.records {
            let shown = format!("{:?}", record.op);
            let text = matches!(record.op, Op::Comment(_) | Op::Message(_) | Op::Operation(_));
            let odd = ["NaN", "(inf", " inf", "-inf"].iter().any(|number| shown.contains(number));
            assert!(text || !odd, "{file}: {shown}");
        }
    }
}
