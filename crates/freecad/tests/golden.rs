//! The printed program of `emco_post`: M. Frnoch, University of West Bohemia in Pilsen, 2018, appendix 2 (what
//! FreeCAD dumped) and appendix 3 (what came out), as far as both are printed. `golden/part.dump` and
//! `golden/part.mpf` hold these lines, without the marks for what is left out between the operations.

use machine::Machine;
use program::{Op, Pose, Purpose};
use toolpost_freecad::{self as freecad, Job, Reading};

const DUMP: &str = include_str!("golden/part.dump");
const PRINTED: &str = include_str!("golden/part.mpf");

/// What FreeCAD had in memory where five digits do not show it: the first Z12.5 differs in its last bits
/// from the next, and a Y rounds down.
const LOST: [(&str, &str); 2] =
    [("Command G0 [ Z:12.5 ]", "Command G0 [ Z:12.5000001 ]"), ("Y:-6.4775 ", "Y:-6.47748 ")];

fn read(dump: &str) -> Reading {
    let machine = machine::load("emco-concept-mill-105").unwrap();
    let job = Job::of("part.dump", dump.as_bytes()).unwrap();
    freecad::read(&machine, "part.dump", job, Purpose::Program).unwrap()
}

fn emco_post() -> Machine {
    let mut machine = machine::load("emco-concept-mill-105-emco-post").unwrap();
    machine.set_option("time", "15.05.2018 21:09:46").unwrap();
    machine
}

/// The proven program.
fn proven(reading: &Reading, machine: &Machine) -> String {
    let text = post::write(&reading.program, machine).unwrap().text;
    let report = proof::prove(&reading.program, machine, "part.mpf", &text, &Default::default());
    assert!(report.proven, "{:?}", report.mismatches);
    String::from_utf8(text).unwrap()
}

fn nudged() -> String {
    LOST.iter().fold(DUMP.to_owned(), |dump, (shown, held)| {
        assert_eq!(dump.matches(shown).count(), 1, "{shown}");
        dump.replace(shown, held)
    })
}

/// A block and its number.
fn split(block: &str) -> (u32, &str) {
    let (number, rest) = block.split_once(' ').unwrap();
    (number.strip_prefix('N').unwrap().parse().unwrap(), rest)
}

/// The blocks that differ: ours and the printed one. Up to the first gap the numbers are compared too.
fn differences<'a>(ours: &'a str, printed: &'a str) -> Vec<(&'a str, &'a str)> {
    assert_eq!(ours.lines().count(), printed.lines().count());
    let pairs = ours.lines().zip(printed.lines()).zip(1u32..);
    let differs = pairs.filter_map(|((a, b), place)| {
        let ((number, ours), (printed_number, printed)) = (split(a), split(b));
        assert_eq!(number, 10 * place);
        assert!(printed_number == number || number > 260, "{a} {b}");
        (ours != printed).then_some((ours, printed))
    });
    differs.collect()
}

#[test]
fn the_printed_program_comes_out_block_for_block_and_is_proven() {
    assert_eq!(PRINTED.lines().count(), 76);
    let text = proven(&read(&nudged()), &emco_post());
    assert_eq!(differences(&text, PRINTED), Vec::new());
    // As the control wants it: a line end behind M30.
    assert!(text.ends_with(" M30\n"));
}

#[test]
fn from_five_digits_two_blocks_are_others_and_no_more() {
    let text = proven(&read(DUMP), &emco_post());
    let expected = [
        ("G1 X7.000 Y-7.000 F200", "G1 X7.000 Y-7.000 Z12.500 F200"),
        ("X43.789 Y-6.478 I-36.477 J1.211", "X43.789 Y-6.477 I-36.477 J1.211"),
    ];
    assert_eq!(differences(&text, PRINTED), expected);
}

#[test]
fn on_the_machine_as_it_is_repeated_values_are_compared_as_they_are_printed() {
    let machine = machine::load("emco-concept-mill-105").unwrap();
    let text = proven(&read(&nudged()), &machine);
    // Z 12.5000001 and 12.5 are written alike.
    assert!(text.contains(" G1 X7 Y-7 F200\n"), "{text}");
    for word in ["G710", "G94", "\nN120 D1\n"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

/// What the printed blocks say of the part: circles, the helix, the bounds.
#[test]
fn the_toolpath_has_the_measures_of_the_part() {
    let program = read(DUMP).program;
    let mut operation = "";
    let mut from: Option<Pose> = None;
    let (mut circles, mut levels) = (Vec::new(), Vec::new());
    for record in &program.records {
        match &record.op {
            Op::Operation(name) => operation = name,
            Op::Arc(arc) => {
                let start = from.unwrap().point();
                let center = arc.circle.center().with_z(start.z);
                let (radius, end) = (start.distance(center), arc.end.point().with_z(start.z));
                assert!((radius - end.distance(center)).abs() < 1e-3);
                assert!((center.x - 45.0).abs() < 1e-3 && (center.y - 30.0).abs() < 1e-3);
                circles.push((operation, radius));
                if operation == "Helix" {
                    levels.push(arc.end.point().z);
                }
            }
            _ => {}
        }
        if let Some(pose) = record.op.pose() {
            let point = pose.point();
            assert!((6.0..=83.0).contains(&point.x) && (-20.0..=67.0).contains(&point.y));
            assert!((12.5..=20.0).contains(&point.z));
            from = Some(*pose);
        }
    }
    for (operation, radius) in circles {
        let expected: &[f64] = match operation {
            "Pocket_Shape" => &[36.497],
            "Helix" => &[4.0],
            _ => &[14.0, 13.0],
        };
        assert!(expected.iter().any(|r| (radius - r).abs() < 2e-3), "{operation}: R {radius}");
    }
    // Six half turns from Z15 to Z12.5, and a full turn there.
    let expected = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 6.0, 6.0].map(|half| 15.0 - half * 2.5 / 6.0);
    assert_eq!(levels.len(), expected.len());
    assert!(levels.iter().zip(expected).all(|(level, z)| (level - z).abs() < 1e-3), "{levels:?}");
}

/// A command whose line is broken in print is one command.
#[test]
fn broken_lines_are_joined() {
    let broken = DUMP.replace(" Z:12.5 ]", "\n  Z:12.5 ]");
    assert_eq!(read(&broken).program, read(DUMP).program);
}

/// The rules that the thesis found on the control (3.6.1, 5): a program that breaks one is not proven.
#[test]
fn what_the_control_does_not_take_is_not_proven() {
    let (reading, machine) = (read(&nudged()), emco_post());
    let text = proven(&reading, &machine);
    let broken = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let text = text.replacen(from, to, 1);
        let report =
            proof::prove(&reading.program, &machine, "p", text.as_bytes(), &Default::default());
        assert!(!report.proven, "{to}");
        report.mismatches[0].rule
    };
    // A comment begins with ; behind the block number.
    assert_eq!(broken(" ;T1: D16", " (T1: D16)"), "syntax");
    assert_eq!(broken(" ;T1: D16", " T1: D16;"), "syntax");
    // An arc that changes Z says both of its end points in the plane, changed or not.
    assert_eq!(broken(" X41.000 Y30.000 Z13.750", " X41.000 Z13.750"), "helix-end-point");
    assert_eq!(broken(" X41.000 Y30.000 Z13.750", " Y30.000 Z13.750"), "helix-end-point");
    // M30 ends the program, and a line end M30.
    assert_eq!(broken(" M30\n", " M30"), "line-end");
    assert_eq!(broken(" M30\n", " M5\n"), "program-end");
    // One G function of a group in a block.
    assert_eq!(broken(" G17 G40", " G17 G18"), "modal-group");
    assert_eq!(broken(" G0 Z20.000", " G0 G1 Z20.000"), "modal-group");
    // An arc in the plane may leave Z out: most of those printed do.
    assert!(text.contains(" G2 X46.211 Y66.477 I26.149 J25.461\n"));
}
