//! Programs of wires: written, proven, damaged.

use geom::Vec3;
use machine::Machine;
use program::{ArcTo, Circle, Compensation, Diagnostic, Feed, Op, Pose, Program, Tool};
use proof::{Report, Tolerances};
use proptest::prelude::*;

/// The list of coordinates with its upper plane 40 mm over the lower.
const LIST: &str = "extends = \"bp-95d\"\n[wire]\nheight = 40\nuv_travel = 15\ntaper_max = 20\n";

fn machine(text: &str) -> Machine {
    machine::load_text("shop.toml", text).unwrap()
}

fn upright(x: f64, y: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, 0.0)).unwrap()
}

/// A wire that is at `x` `y` below, and `u` `v` from that 40 mm above.
fn leaning(x: f64, y: f64, u: f64, v: f64) -> Pose {
    Pose::new(Vec3::new(x, y, 0.0), Vec3::new(u, v, 40.0).normalize()).unwrap()
}

fn program(ops: impl IntoIterator<Item = Op>) -> Program {
    let mut program = Program::new("part");
    for (line, op) in (1..).zip(ops) {
        program.push(line, op);
    }
    program
}

/// From `start` through `ways` in one opening.
fn opening(start: Pose, ways: impl IntoIterator<Item = Op>) -> Program {
    let before = [Op::Rapid(start), Op::ThreadWire];
    program(before.into_iter().chain(ways).chain([Op::CutWire, Op::End]))
}

/// A square of 10 mm whose upper end is a square of 14 mm about the same centre.
fn frustum() -> Program {
    let corners = [(10.0, 0.0, 2.0, -2.0), (10.0, 10.0, 2.0, 2.0), (0.0, 10.0, -2.0, 2.0)];
    let ways = corners.into_iter().chain([(0.0, 0.0, -2.0, -2.0)]);
    opening(leaning(0.0, 0.0, -2.0, -2.0), ways.map(|(x, y, u, v)| Op::Line(leaning(x, y, u, v))))
}

/// A quarter of a circle of 40 mm between two radii, counter-clockwise.
fn sector() -> Program {
    let end = upright(0.0, 40.0);
    let arc = ArcTo { end, circle: Circle::new(Vec3::ZERO, Vec3::Z, 0).unwrap() };
    let ways = [Op::Line(upright(40.0, 0.0)), Op::Arc(Box::new(arc)), Op::Line(upright(0.0, 0.0))];
    opening(upright(0.0, 0.0), ways)
}

fn written(program: &Program, machine: &Machine) -> String {
    let output = post::write(program, machine).unwrap_or_else(|found| panic!("{}", found[0]));
    String::from_utf8(output.text).unwrap()
}

fn refused(program: &Program, machine: &Machine) -> Diagnostic {
    post::write(program, machine).unwrap_err().remove(0)
}

fn proof(program: &Program, machine: &Machine, text: &str) -> Report {
    proof::prove(program, machine, "part.pts", text.as_bytes(), &Tolerances::default())
}

#[track_caller]
fn proven(program: &Program, machine: &Machine, text: &str) {
    let report = proof(program, machine, text);
    assert!(report.proven, "{:#?}\n{text}", report.mismatches);
}

#[test]
fn a_list_has_a_line_a_point_and_says_everywhere_how_the_wire_leans() {
    let (program, machine) = (frustum(), machine(LIST));
    let text = written(&program, &machine);
    let expected = "0.000 0.000 -2.000 -2.000\n10.000 0.000 2.000 -2.000\n10.000 10.000 2.000 2.000\n\
                    0.000 10.000 -2.000 2.000\n0.000 0.000 -2.000 -2.000\n";
    assert_eq!(text, expected);
    proven(&program, &machine, &text);
}

#[test]
fn an_upright_wire_has_no_u_and_v_and_arcs_become_points() {
    let (program, machine) = (sector(), machine("extends = \"bp-95d\""));
    let text = written(&program, &machine);
    // Chords of 0.005 mm on R 40 turn by 4·asin(√(0.005/80)): 50 of them make 90°.
    assert_eq!(text.lines().count(), 3 + 50);
    assert!(text.lines().all(|line| line.split(' ').count() == 2), "{text}");
    proven(&program, &machine, &text);
}

#[test]
fn a_list_with_any_number_damaged_is_refused() {
    let (program, machine) = (frustum(), machine(LIST));
    let lines: Vec<String> = written(&program, &machine).lines().map(str::to_owned).collect();
    let judge = |lines: &[String], what: &str| {
        let text = lines.join("\n") + "\n";
        assert!(!proof(&program, &machine, &text).proven, "{what}:\n{text}");
    };
    for (i, line) in lines.iter().enumerate() {
        let words: Vec<&str> = line.split(' ').collect();
        for (j, word) in words.iter().enumerate() {
            let number: f64 = word.parse().unwrap();
            for other in [number + 0.02, -number] {
                if other == number {
                    continue;
                }
                let mut changed: Vec<String> = words.iter().map(|w| (*w).to_owned()).collect();
                changed[j] = format!("{other:.3}");
                let mut damaged = lines.clone();
                damaged[i] = changed.join(" ");
                judge(&damaged, &format!("word {j} of line {}", i + 1));
            }
        }
        let mut dropped = lines.clone();
        dropped.remove(i);
        judge(&dropped, &format!("line {} dropped", i + 1));
        let mut swapped = lines.clone();
        if i + 1 < lines.len() {
            swapped.swap(i, i + 1);
            judge(&swapped, &format!("lines {} and {} swapped", i + 1, i + 2));
        }
    }
    let mut longer = lines.clone();
    longer.push("5.000 0.000 0.000 -2.000".into());
    judge(&longer, "one more");
}

#[test]
fn a_point_list_that_cuts_an_arc_off_is_refused() {
    let (program, machine) = (sector(), machine("extends = \"bp-95d\""));
    let mut lines: Vec<String> = written(&program, &machine).lines().map(str::to_owned).collect();
    // Without two neighbours of 50 the chord error is nine times as large.
    lines.drain(20..22);
    let report = proof(&program, &machine, &(lines.join("\n") + "\n"));
    assert_eq!(report.mismatches[0].rule.name(), "path", "{:?}", report.mismatches);
}

#[test]
fn what_a_wire_cannot_do_is_refused_with_its_line() {
    let list = machine(LIST);
    let rule = |ops: Vec<Op>| refused(&program(ops), &list).rule.name();
    let (start, end) = (upright(0.0, 0.0), upright(10.0, 0.0));
    assert_eq!(rule(vec![Op::Rapid(start), Op::Line(end)]), "no-wire");
    assert_eq!(rule(vec![Op::Rapid(start), Op::CutWire]), "no-wire");
    assert_eq!(rule(vec![Op::Rapid(start), Op::ThreadWire, Op::Rapid(end)]), "wire-threaded");
    assert_eq!(rule(vec![Op::Rapid(start), Op::ThreadWire, Op::ThreadWire]), "wire-threaded");
    let ends = vec![Op::Rapid(start), Op::ThreadWire, Op::Line(end), Op::End];
    assert_eq!(rule(ends), "wire-threaded");
    let below = Pose::upright(Vec3::new(1.0, 0.0, -2.0)).unwrap();
    assert_eq!(rule(vec![Op::Rapid(below)]), "wire-plane");
    let one = [Op::Rapid(start), Op::ThreadWire, Op::Line(end), Op::CutWire];
    assert_eq!(rule([one.clone(), one].concat()), "one-opening");
    assert_eq!(rule(vec![Op::Rapid(leaning(0.0, 0.0, 15.1, 0.0))]), "uv-limit");
    // 15 mm in 40 mm both ways: atan(√2·15/40) = 27.9°.
    assert_eq!(rule(vec![Op::Rapid(leaning(0.0, 0.0, 15.0, 15.0))]), "taper-limit");
    assert_eq!(
        rule(vec![Op::Tool(Box::new(Tool { number: 1, ..Tool::default() }))]),
        "missing-block"
    );
    let found = refused(&frustum(), &machine("extends = \"bp-95d\""));
    assert_eq!((found.rule.name(), found.line), ("wire-height", 1));
    let small = machine("extends = \"bp-95d\"\n[wire]\nmemory = 52\n");
    assert_eq!(refused(&sector(), &small).rule.name(), "memory");
}

/// A die in ISO code, offset and leant by the control: in from the middle, round three sides and an arc, and back.
fn die() -> Program {
    let arc =
        ArcTo { end: upright(0.0, 40.0), circle: Circle::new(Vec3::ZERO, Vec3::Z, 0).unwrap() };
    let ways = [
        Op::Feed(Feed::PerMinute(6.0)),
        Op::Compensation(Compensation::Left(Some(1))),
        Op::Taper(-2.5),
        Op::Line(upright(15.0, 0.0)),
        Op::Line(upright(40.0, 0.0)),
        Op::Arc(Box::new(arc)),
        Op::Line(upright(0.0, 0.0)),
        Op::Line(upright(15.0, 0.0)),
        Op::Compensation(Compensation::Off),
        Op::Taper(0.0),
        Op::Line(upright(15.0, 15.0)),
    ];
    opening(upright(15.0, 15.0), ways)
}

#[test]
fn any_damage_to_a_program_of_iso_code_is_refused() {
    let machine = machine("extends = \"fanuc-wire\"\n[wire]\nheight = 40\n");
    let leaning = frustum();
    for program in [&die(), &leaning] {
        let text = written(program, &machine);
        proven(program, &machine, &text);
        let lines: Vec<&str> = text.lines().collect();
        // Behind the name of the program and the block that sets the control up.
        for (i, line) in lines.iter().enumerate().skip(3) {
            let number = line.split(' ').next().unwrap_or_default();
            if !number.starts_with('N') {
                continue;
            }
            let judge = |other: &str| {
                let mut damaged = lines.clone();
                damaged[i] = other;
                let damaged = damaged.join("\n") + "\n";
                let same = *line == other;
                assert!(same || !proof(program, &machine, &damaged).proven, "{line} -> {other}");
            };
            judge(number);
            for (from, to) in [
                ("M60", "M50"),
                ("M50", "M60"),
                ("G41", "G42"),
                ("G40", "G41 D1"),
                ("D1", "D2"),
                ("G52", "G51"),
                ("T2.5", "T2.6"),
                ("G50", "G51 T1."),
                (" G50", ""),
                ("G3", "G2"),
                ("G1", "G0"),
                ("G0", "G1"),
                ("F6.", "F7."),
            ] {
                judge(&line.replace(from, to));
            }
            for letter in ["X", "Y", "U", "V", "I"] {
                let Some(word) = line.split(' ').find(|word| word.starts_with(letter)) else {
                    continue;
                };
                let value: f64 = word[1..].parse().unwrap();
                for other in [-value, value + 0.01] {
                    if other != value {
                        judge(&line.replace(word, &format!("{letter}{other:.3}")));
                    }
                }
            }
        }
    }
}

/// `G92` takes the zero away from under the cut: it would lie where the wire stands.
#[test]
fn a_program_that_moves_the_zero_to_the_wire_is_refused() {
    let machine = machine("extends = \"fanuc-wire\"\n[wire]\nheight = 40\n");
    let text = written(&die(), &machine);
    let first = text.find("G0").unwrap();
    let block = text[..first].rfind('\n').unwrap() + 1;
    let moved = format!("{}G92 X100. Y50.\n{}", &text[..block], &text[block..]);
    let found = proof(&die(), &machine, &moved);
    assert!(!found.proven);
    assert_eq!(found.mismatches[0].rule.name(), "operator-data");
}

#[test]
fn a_mill_threads_no_wire() {
    let mill = machine("extends = \"generic-3axis-fanuc\"");
    assert_eq!(refused(&sector(), &mill).rule.name(), "unsupported");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any way of the wire, leaning as it likes within the machine.
    #[test]
    fn any_way_of_a_wire_is_proven_on_every_wire_machine(
        points in prop::collection::vec((-90.0..90.0f64, -90.0..90.0f64, -9.0..9.0f64, -9.0..9.0f64), 2..30),
        leans in any::<bool>(),
        feed in prop::option::of(1.0..20.0f64),
    ) {
        let pose = |&(x, y, u, v): &(f64, f64, f64, f64)| {
            if leans { leaning(x, y, u, v) } else { upright(x, y) }
        };
        for control in ["bp-95d", "fanuc-wire", "sodick-iso", "agie-iso"] {
            let machine = machine(&format!("extends = \"{control}\"\n[wire]\nheight = 40\n"));
            let says_feed = feed.filter(|_| machine.words.contains_key("F"));
            let feed = says_feed.map(|feed| Op::Feed(Feed::PerMinute(feed)));
            let ways = points.iter().skip(1).map(|point| Op::Line(pose(point)));
            let program = opening(pose(&points[0]), feed.into_iter().chain(ways));
            let text = written(&program, &machine);
            let report = proof(&program, &machine, &text);
            prop_assert!(report.proven, "{control}: {:?}\n{text}", report.mismatches);
        }
    }
}
