//! The programs and positions of CEAD's interpreter for SINUMERIK programs, an outside judge.
//!
//! Each program must move as the judge says, from its first block to its last. Where the judge takes what
//! a control does not, the program is adapted, and the adaptation says what it is. `TOOLPOST_DATA` names
//! the folder with the data.

use geom::Vec3;
use program::Diagnostic;
use toolpost_control::{Event, Setup, read};

/// A program of the judge.
struct Case {
    name: &'static str,
    /// Definitions that a control needs and the judge does not.
    definitions: &'static str,
    /// What a control does not take, and what it is replaced by.
    replaced: &'static [(&'static str, &'static str)],
    /// A program that is called.
    called: &'static str,
    /// The rule by which it is refused whatever is replaced.
    refused: Option<&'static str>,
}

const fn case(name: &'static str) -> Case {
    Case { name, definitions: "", replaced: &[], called: "", refused: None }
}

/// The programs.
const CASES: &[Case] = &[
    case("actual_position"),
    // The judge takes variables that nothing defines, and names of one letter.
    Case {
        definitions: "DEF INT NN, MM, OO\n",
        replaced: &[
            ("FOR m=", "FOR mm="),
            ("FOR o=", "FOR oo="),
            ("[nn,m,o]", "[nn,mm,oo]"),
            ("nn*100+m*10+o", "nn*100+mm*10+oo"),
        ],
        ..case("arrays")
    },
    case("basic_math"),
    case("case_insensitive_variables"),
    case("def_string"),
    // Axes that the machine does not have, variables that nothing defines, a definition behind the first
    // move, and a call of a program that is not there.
    Case {
        definitions: "DEF REAL E_MULTIPLIER, F_MULTI, DEPTH = 2.5\n",
        replaced: &[
            (" B=-1.5", ""),
            (" ELX=3087.022334", ""),
            ("\nE=0\n", "\n"),
            (" E=IC(E_MULTIPLIER*0.02988)", ""),
            (" E=IC(0.25*E_MULTIPLIER)", ""),
            ("\nDEF REAL DEPTH = 2.5\n", "\n"),
        ],
        called: "%_N_MATERIAL_UPDATE_SPF\nM17\n",
        ..case("edge_cases")
    },
    // An alarm that only the control sets.
    Case { replaced: &[("12345", "66000")], ..case("function_calls") },
    case("if_statement"),
    case("logic_operators"),
    // M2 M3 M4 M5 in one block.
    Case { refused: Some("modal-group"), ..case("multiple_m_codes") },
    // R parameters are there and cannot be defined.
    Case { replaced: &[("DEF REAL R0=0", "R0=0")], ..case("r_param") },
    // An arc without a centre.
    Case { refused: Some("arc"), ..case("simple") },
    case("tool"),
    case("trans2"),
    case("trans_reset"),
    case("variables"),
];

/// The points that a program moves to, with the error that ends it.
fn moved(case: &Case, text: &str) -> (Vec<Vec3>, Option<Box<Diagnostic>>) {
    let mut settings = crate::common::sinumerik::settings();
    settings.auxiliary.extend([101, 102, 103]);
    if case.name == "actual_position" {
        settings.setup = Setup { start: Some(Vec3::ZERO), ..Setup::default() };
    }
    let mut text = text.to_owned();
    for (from, to) in case.replaced {
        assert!(text.contains(from), "{}: {from}", case.name);
        text = text.replace(from, to);
    }
    // The judge knows no feed; this control does not cut without one. Definitions come first.
    let head = |line: &&str| {
        let line = line.trim_start();
        line.is_empty() || line.starts_with(';') || line.contains("DEF ")
    };
    let head: String = text.lines().take_while(head).flat_map(|line| [line, "\n"]).collect();
    let rest = text.get(head.len()..).unwrap_or("");
    let end = if rest.contains("M30") { "" } else { "\nM30" };
    let Case { definitions, called, .. } = case;
    let program = format!("{definitions}{head}F1000 T1\n{rest}{end}\n{called}");
    let mut points = Vec::new();
    let ran = read(&settings, "judge.mpf", program.as_bytes(), &mut |record: Event| {
        points.extend(record.action.position().map(|pose| pose.point));
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
    let Some(folder) = judge::data("sinumerik") else { return };
    for case in CASES {
        let name = case.name;
        let file =
            |ending| std::fs::read_to_string(folder.join(name).with_extension(ending)).unwrap();
        let (points, error) = moved(case, &file("mpf"));
        assert_eq!(error.as_ref().map(|e| e.rule.name()), case.refused, "{name}: {error:?}");
        let mut judged = judged(&file("csv"));
        let mut rest = judged.iter();
        for point in &points {
            assert!(rest.any(|j| same(*j, *point)), "{name}: {point} is not among {judged:?}");
        }
        if case.refused.is_some() {
            continue;
        }
        // Nothing is left out either: without the blocks that do not move, both are the same.
        let mut points = points;
        judged.retain(|point| !point.is_nan_mask().all());
        judged.dedup_by(|a, b| same(*a, *b));
        points.dedup_by(|a, b| same(*a, *b));
        assert_eq!(points.len(), judged.len(), "{name}: {points:?} {judged:?}");
    }
}
