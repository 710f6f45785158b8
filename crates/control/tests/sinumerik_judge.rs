//! The programs and positions of CEAD's interpreter for SINUMERIK programs, an outside judge.
//!
//! Each program runs until it ends or meets a word that this control does not have; what it has moved
//! by then must be what the judge says. `TOOLPOST_DATA` names the folder with the data.

mod sinumerik_common;

use geom::Vec3;
use program::{Diagnostic, Record};
use std::path::PathBuf;
use toolpost_control::read;

/// The programs, and the rule of the error where they use what is not supported (the judge knows
/// loops, variables, axes of any name and arcs without a centre).
const PROGRAMS: &[(&str, Option<&str>)] = &[
    ("actual_position", Some("unsupported")),
    ("arrays", Some("unsupported")),
    ("basic_math", None),
    ("case_insensitive_variables", Some("unsupported")),
    ("def_string", Some("unsupported")),
    ("edge_cases", Some("unknown-word")),
    ("function_calls", Some("unknown-word")),
    ("if_statement", Some("unsupported")),
    ("logic_operators", Some("unsupported")),
    ("multiple_m_codes", Some("group-conflict")),
    ("r_param", Some("unsupported")),
    ("simple", Some("arc")),
    ("tool", None),
    ("trans2", None),
    ("trans_reset", None),
    ("variables", Some("unsupported")),
];

fn data() -> Option<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");
    let folder = std::env::var_os("TOOLPOST_DATA").map_or_else(|| beside.into(), PathBuf::from);
    let folder = folder.join("sinumerik");
    folder.is_dir().then_some(folder)
}

/// The points that a program moves to, with the error that ends it.
fn moved(text: &str) -> (Vec<Vec3>, Option<Box<Diagnostic>>) {
    let mut settings = sinumerik_common::settings();
    settings.auxiliary.extend([101, 102, 103]);
    // The judge knows no feed; this control does not cut without one.
    let program = format!("F1000 T1\n{text}\n{}", if text.contains("M30") { "" } else { "M30\n" });
    let mut points = Vec::new();
    let ran = read(&settings, "judge.mpf", program.as_bytes(), &mut |record: Record| {
        points.extend(record.op.pose().map(|pose| pose.point));
        Ok(())
    });
    (points, ran.err())
}

/// The positions of the judge, one a line; NaN where an axis has not been named.
fn judged(csv: &str) -> Vec<Vec3> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let column = |name| head.iter().position(|h| *h == name);
    let columns = [column("X"), column("Y"), column("Z")];
    let number = |fields: &[&str], column: Option<usize>| {
        column.and_then(|c| fields.get(c)?.parse().ok()).unwrap_or(f64::NAN)
    };
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            Vec3::from_array(columns.map(|column| number(&fields, column)))
        })
        .collect()
}

fn same(a: Vec3, b: Vec3) -> bool {
    let close = |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() < 6e-4;
    close(a.x, b.x) && close(a.y, b.y) && close(a.z, b.z)
}

#[test]
fn positions_are_those_of_the_judge_in_order() {
    let Some(folder) = data() else {
        eprintln!("skipped: no data (TOOLPOST_DATA)");
        return;
    };
    for (name, rule) in PROGRAMS {
        let file =
            |ending| std::fs::read_to_string(folder.join(name).with_extension(ending)).unwrap();
        let (points, error) = moved(&file("mpf"));
        assert_eq!(error.as_ref().map(|e| e.rule), *rule, "{name}: {error:?}");
        let judged = judged(&file("csv"));
        let mut rest = judged.iter();
        for point in &points {
            assert!(rest.any(|j| same(*j, *point)), "{name}: {point} is not among {judged:?}");
        }
        if rule.is_none() {
            let last = judged.last().copied().unwrap_or(Vec3::NAN);
            assert!(points.last().is_none_or(|p| same(*p, last)), "{name}: ends elsewhere");
        }
    }
}
