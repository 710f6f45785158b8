//! Programs that find the surface themselves: written, proven, and what goes wrong.

use geom::{Vec2, Vec3};
use program::{
    ArcTo, Circle, Cycle, CycleKind, Feed, Op, Pose, Probe, Program, Spindle, Tool, WorkOffset,
};
use toolpost_levelling::{Allowed, Grid, Probing, follow};

const ALLOWED: Allowed = Allowed { deviation: 0.005, outside: 5.0 };
const PROBING: Probing = Probing { travel: 2.0, reach: 1.0, feed: 50.0 };

fn pose(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

fn grid(columns: usize, rows: usize) -> Grid {
    Grid::new(Vec2::ZERO, Vec2::new(40.0, 20.0), columns, rows).unwrap()
}

/// A tool, a move down at (10, 5), and these cuts.
fn board(cuts: Vec<Op>) -> Program {
    let mut program = Program::new("board");
    let mut push = |op| program.push(0, op);
    push(Op::Tool(Box::new(Tool { number: 1, length: Some(20.0), ..Tool::default() })));
    push(Op::Spindle(Spindle::Clockwise(9000.0)));
    push(Op::Rapid(pose(10.0, 5.0, 2.0)));
    push(Op::Rapid(pose(10.0, 5.0, 0.5)));
    push(Op::Feed(Feed::PerMinute(60.0)));
    push(Op::Line(pose(10.0, 5.0, -0.1)));
    cuts.into_iter().for_each(&mut push);
    push(Op::Rapid(pose(10.0, 15.0, 2.0)));
    push(Op::Spindle(Spindle::Off));
    push(Op::End);
    program
}

/// A machine that says lengths by two decimals.
fn two_decimals() -> machine::Machine {
    let words = ["X", "Y", "Z", "I", "J"].map(|word| format!("{word} = {{ decimals = 2 }}\n"));
    let text = format!("extends = \"generic-3axis-linuxcnc\"\n[words]\n{}", words.concat());
    machine::load_text("m.toml", &text).unwrap()
}

fn text(program: &Program) -> String {
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    String::from_utf8(post::write(program, &machine).unwrap().text).unwrap()
}

fn blocks(text: &str) -> Vec<&str> {
    text.lines().collect()
}

fn is_proven(program: &Program, text: &str) -> bool {
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    proof::prove(program, &machine, "board", text.as_bytes(), &Default::default()).proven
}

fn followed(cuts: Vec<Op>, columns: usize, rows: usize) -> Program {
    follow(&board(cuts), &grid(columns, rows), &PROBING, 0.02, &ALLOWED).unwrap()
}

/// By hand: (10, 5) is a quarter of the width along and a quarter of the height across, so its height is 9/16 of that of the corner
/// at the zero, 3/16 of those next to that, 1/16 of the one opposite. A line along X stays one on any bilinear surface.
#[test]
fn between_four_places_each_corner_has_its_part() {
    let program = followed(vec![Op::Line(pose(30.0, 5.0, -0.1))], 2, 2);
    let text = text(&program);
    let blocks = blocks(&text);
    let probing = "G0 X0 Y0|G43 Z2 H1|G38.2 Z-1 F50|#1001=#5063|G0 Z2|X40|G38.2 Z-1|#1002=#5063|G0 Z2|Y20|G38.2 Z-1|\
        #1004=#5063|G0 Z2|X0|G38.2 Z-1|#1003=#5063|G0 Z3|(MSG, take the probe off the tool)|G53 G0 Z0|M0|S9000 M3";
    let cut = "G0 X10 Y5|G43 Z3 H1|Z[0.5+0.5625*#1001+0.1875*#1002+0.1875*#1003+0.0625*#1004]|\
        G1 Z[-0.1+0.5625*#1001+0.1875*#1002+0.1875*#1003+0.0625*#1004] F60|\
        X30 Z[-0.1+0.1875*#1001+0.5625*#1002+0.0625*#1003+0.1875*#1004]|G0 X10 Y15 Z3";
    for right in [probing, cut] {
        assert!(blocks.join("|").contains(right), "{text}");
    }
    assert!(
        text.contains("T1 M6\n(MSG, clip the probe to the board and to the tool)\nM0\nG0 X0 Y0\n")
    );
    assert!(is_proven(&program, &text));
}

/// Columns at 0, 20 and 40, rows at 0, 10 and 20: the line crosses a column, and then runs along a row.
#[test]
fn a_line_is_divided_where_it_crosses_the_grid() {
    let cuts = [(30.0, 5.0), (30.0, 10.0), (40.0, 10.0)];
    let program = followed(cuts.map(|(x, y)| Op::Line(pose(x, y, -0.1))).to_vec(), 3, 3);
    let text = text(&program);
    let right = "G1 Z[-0.1+0.25*#1001+0.25*#1002+0.25*#1004+0.25*#1005] F60|\
        X20 Z[-0.1+0.5*#1002+0.5*#1005]|X30 Z[-0.1+0.25*#1002+0.25*#1003+0.25*#1005+0.25*#1006]|\
        Y10 Z[-0.1+0.5*#1005+0.5*#1006]|X40 Z[-0.1+#1006]|G0 X10 Y15 Z3";
    assert!(blocks(&text).join("|").contains(right), "{text}");
    assert!(is_proven(&program, &text));
}

/// Half a circle of 10 mm over four patches, as helices; a full one; holes.
fn curved() -> Program {
    let arc = |x: f64, center: f64, turns: u32| {
        let (end, center) = (pose(x, 5.0, -0.1), Vec3::new(center, 5.0, -0.1));
        Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, Vec3::NEG_Z, turns).unwrap() }))
    };
    let cycle = Cycle {
        kind: CycleKind::Drill,
        depth: 0.2,
        clearance: 0.5,
        retract: 2.0,
        feed: Some(Feed::PerMinute(30.0)),
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    let holes = [
        Op::Cycle(Box::new(cycle)),
        Op::Hole(pose(12.0, 5.0, 0.0)),
        Op::Hole(pose(33.0, 18.0, 0.0)),
    ];
    let mut cuts = vec![arc(30.0, 20.0, 0), arc(30.0, 28.0, 0), Op::Rapid(pose(30.0, 5.0, 2.0))];
    cuts.extend(holes);
    cuts.push(Op::CycleOff);
    followed(cuts, 3, 3)
}

#[test]
fn arcs_become_helices_and_holes_moves() {
    let program = curved();
    let text = text(&program);
    let arcs = program.records.iter().filter(|record| matches!(record.op, Op::Arc(_))).count();
    // On the steepest surface the height along the half circle has the second derivative (10 * 0.028 + 100 * 0.002) * pi^2
    // = 4.8 mm: 11 pieces bulge by 4.8 / 121 / 8 = 0.005. Along the circle it is 2.5 mm, in 8 pieces. The grid divides more.
    assert!((19..=24).contains(&arcs), "{arcs}");
    let helices = text.lines().filter(|line| line.contains('I') && line.contains("Z[")).count();
    assert_eq!(helices, arcs, "{text}");
    // (33, 18) is 13 of 20 along the patch and 8 of 10 across.
    let down = "X33 Y18|Z[0.5+0.07*#1005+0.13*#1006+0.28*#1008+0.52*#1009]|\
        G1 Z[-0.2+0.07*#1005+0.13*#1006+0.28*#1008+0.52*#1009]|G0 Z3";
    assert!(blocks(&text).join("|").contains(down), "{text}");
    assert!(text.lines().all(|line| line.len() <= 255));
    assert!(is_proven(&program, &text));
}

/// What is wrong by a thousandth of a height, or by another place, is found.
#[test]
fn a_wrong_part_of_a_height_is_no_proof() {
    let program = curved();
    let text = text(&program);
    for (was, is) in [
        ("0.25*#1005", "0.249*#1005"),
        ("0.25*#1005", "0.25*#1006"),
        ("0.25*#1001+", ""),
        ("#1005=#5063\n", ""),
        ("#1005=#5063\n", "#1006=#5063\n"),
        ("#1005=#5063\n", "#1005=0\n"),
        ("#1005=#5063\n", "#1005=[#5063+0.001]\n"),
        ("G38.2 Z-1\n#1005", "#1005"),
        ("G38.2 Z-1\n#1005", "G38.2 Z-0.5\n#1005"),
        ("G38.2 Z-1\n#1005", "G38.3 Z-1\n#1005"),
        ("Z3\n(MSG, take", "Z0.5\n(MSG, take"),
        ("G1 Z[-0.1", "G1 Z[-0.2"),
        ("M0\nG0", "G0"),
        ("Z0\nM0\nS9000", "Z0\nS9000"),
        ("M0\nG0", "M0\nS9000 M3\nG0"),
    ] {
        let wrong = text.replacen(was, is, 1);
        assert_ne!(wrong, text, "{was}");
        assert!(!is_proven(&program, &wrong), "{was} as {is}");
    }
    // Each part of a height by itself, three times what it is.
    let parts: Vec<usize> = text.match_indices("*#").map(|(at, _)| at).collect();
    for at in parts {
        let wrong = format!("{}*3{}", &text[..at], &text[at..]);
        assert!(!is_proven(&program, &wrong), "{}", &text[at - 20..at + 6]);
    }
}

#[test]
fn the_axes_have_to_reach_what_the_probe_can_find() {
    let machine = |low: f64| {
        let text = format!(
            "extends = \"generic-3axis-linuxcnc\"\nwork_zero = [0, 0, -50]\n[axes]\nZ = {{ min = {low}, max = 0 }}\n"
        );
        machine::load_text("m.toml", &text).unwrap()
    };
    let flat = board(vec![Op::Line(pose(30.0, 5.0, -0.1))]);
    let program = followed(vec![Op::Line(pose(30.0, 5.0, -0.1))], 2, 2);
    // The cut can be at -31.1.
    assert!(post::write(&flat, &machine(-31.09)).is_ok());
    assert!(post::write(&program, &machine(-31.11)).is_ok());
    let found = post::write(&program, &machine(-31.09)).unwrap_err();
    assert_eq!(found[0].rule.name(), "axis-limit", "{}", found[0]);
}

#[test]
fn a_control_that_keeps_no_heights_is_refused() {
    let program = followed(vec![Op::Line(pose(30.0, 5.0, -0.1))], 2, 2);
    for name in ["grbl-3018", "mach3-mill", "marlin-cnc", "generic-3axis-fanuc"] {
        let found = post::write(&program, &machine::load(name).unwrap()).unwrap_err();
        let refused = found.iter().any(|found| found.message.contains("keeps no heights"));
        assert!(refused, "{name}: {found:?}");
    }
}

/// Half a circle becomes helices that the grid divides, of which the machine makes lines.
#[test]
fn arcs_that_the_machine_takes_in_parts_are_refused() {
    let program = curved();
    let machine = |can: &str| {
        let text = format!("extends = \"generic-3axis-linuxcnc\"\n[capabilities]\n{can}\n");
        machine::load_text("m.toml", &text).unwrap()
    };
    for can in ["helix = false", "arcs = []"] {
        let found = post::write(&program, &machine(can)).unwrap_err();
        assert_eq!(found[0].rule.name(), "surface", "{}", found[0]);
        assert!(found[0].message.contains("in parts only"), "{}", found[0]);
    }
    // A program without arcs needs none.
    let straight = followed(vec![Op::Line(pose(30.0, 5.0, -0.1))], 2, 2);
    assert!(post::write(&straight, &machine("helix = false")).is_ok());
}

/// A machine of two decimals, and arcs of a few steps of it.
#[test]
fn arcs_too_short_for_the_decimals_become_one_line() {
    let machine = two_decimals();
    let arcs = |radius: f64, sweep: f64| {
        let center = Vec3::new(10.0 + radius, 5.0, -0.1);
        let spoke = Vec3::new(-sweep.cos(), sweep.sin(), 0.0) * radius;
        let end = Pose::upright(center + spoke).unwrap();
        let arc =
            Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, Vec3::NEG_Z, 0).unwrap() }));
        let allowed = Allowed { deviation: 0.0001, ..ALLOWED };
        let cuts = board(vec![arc, Op::Line(pose(30.0, 5.0, -0.1))]);
        follow(&cuts, &grid(3, 3), &PROBING, 0.02, &allowed).unwrap()
    };
    let (mut as_arcs, mut as_lines) = (0, 0);
    for radius in [0.01, 0.014, 0.017, 0.02, 0.03, 0.05] {
        for sweep in [1.0, 1.5, 2.5, 3.0, 4.0, 6.0] {
            let program = arcs(radius, sweep);
            let text = post::write(&program, &machine).unwrap().text;
            let proof = proof::prove(&program, &machine, "board", &text, &Default::default());
            assert!(proof.proven, "{radius} mm, {sweep} rad: {proof:?}");
            let made = |op: &&program::Record| matches!(op.op, Op::Arc(_));
            let arcs = program.records.iter().filter(made).count();
            let text = String::from_utf8(text).unwrap();
            let helices =
                text.lines().filter(|line| line.contains('I') && line.contains("Z[")).count();
            (as_arcs, as_lines) = (as_arcs + helices, as_lines + arcs - helices);
        }
    }
    assert!(as_arcs > 10 && as_lines > 10, "{as_arcs} {as_lines}");
    // Two arcs of 2 rad each: no line is one of them.
    let found = post::write(&arcs(0.006, 4.0), &machine).unwrap_err();
    assert_eq!(found[0].rule.name(), "surface", "{}", found[0]);
}

/// Columns 40/3 mm apart, in words of two decimals.
#[test]
fn places_are_found_though_their_words_are_rounded() {
    let machine = two_decimals();
    let program = followed(vec![Op::Line(pose(30.0, 5.0, -0.1))], 4, 4);
    let text = post::write(&program, &machine).unwrap().text;
    let proof = proof::prove(&program, &machine, "board", &text, &Default::default());
    assert!(proof.proven, "{proof:?}");
}

/// Nine places from #1001 on, also in a program that has probed none of them.
#[test]
fn a_parameter_that_the_control_does_not_have_is_refused() {
    let machine = |max: u32| {
        let text =
            format!("extends = \"generic-3axis-linuxcnc\"\n[words]\nHEIGHT = {{ max = {max} }}\n");
        machine::load_text("m.toml", &text).unwrap()
    };
    let mut program = followed(vec![Op::Line(pose(30.0, 15.0, -0.1))], 3, 3);
    assert!(post::write(&program, &machine(1009)).is_ok());
    for _ in 0..2 {
        let found = post::write(&program, &machine(1008)).unwrap_err();
        assert_eq!(found[0].rule.name(), "number-range", "{}", found[0]);
        assert!(found[0].message.contains("1009"), "{}", found[0]);
        program.records.retain(|record| !matches!(record.op, Op::Probe(_)));
    }
}

/// What no writer makes over such a surface, behind the cuts of a program that finds one.
#[test]
fn what_does_not_follow_a_surface_is_refused() {
    let program = followed(vec![Op::Line(pose(30.0, 5.0, -0.1))], 2, 2);
    let surface = program.records.iter().find(|record| matches!(record.op, Op::Surface(_)));
    let probe = Probe { end: pose(10.0, 15.0, -1.0), away: false, must_answer: true, place: None };
    let cycle = Cycle {
        kind: CycleKind::Drill,
        depth: 1.0,
        clearance: 0.5,
        retract: 2.0,
        feed: None,
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    for ops in [
        vec![Op::WorkOffset(WorkOffset::numbered(55).unwrap())],
        vec![Op::Cycle(Box::new(cycle)), Op::Hole(pose(10.0, 15.0, 0.0))],
        vec![Op::Probe(Box::new(probe))],
        vec![surface.unwrap().op.clone()],
    ] {
        let mut program = program.clone();
        let end = program.records.len() - 2;
        let records = ops.into_iter().map(|op| program::Record { line: 7, op });
        program.records.splice(end..end, records);
        let machine = machine::load("generic-3axis-linuxcnc").unwrap();
        let found = post::write(&program, &machine).unwrap_err();
        assert_eq!((found[0].rule.name(), found[0].line), ("surface", 7), "{}", found[0]);
    }
}

#[track_caller]
fn refuses(program: &Program, message: &str) {
    let found = follow(program, &grid(2, 2), &PROBING, 0.02, &ALLOWED).unwrap_err();
    assert_eq!(found.rule.name(), "levelling", "{found}");
    assert!(found.message.contains(message), "{found}");
}

#[test]
fn what_cannot_find_its_surface_is_refused() {
    let mut program = board(Vec::new());
    program.records.swap(0, 1);
    refuses(&program, "a spindle that turns before a tool");
    program.records.remove(0);
    program.records.remove(0);
    refuses(&program, "a move before a tool");
    refuses(&Program::new("empty"), "no tool is called");
    // A rapid at Z 0.1 is 1.1 mm up, and a cut begins at Z 1.5.
    let low = [
        Op::Rapid(pose(10.0, 5.0, 0.1)),
        Op::Rapid(pose(12.0, 5.0, 0.1)),
        Op::Rapid(pose(12.0, 5.0, 3.0)),
        Op::Rapid(pose(12.0, 5.0, 1.5)),
    ];
    refuses(&board(low.to_vec()), "and a rapid across the board at Z1.1 mm");
    let twice = followed(Vec::new(), 2, 2);
    refuses(&twice, "a probing move");
    for steepness in [0.0, -1.0, f64::NAN, 2.0] {
        let found = follow(&board(Vec::new()), &grid(2, 2), &PROBING, steepness, &ALLOWED);
        assert_eq!(found.unwrap_err().rule.name(), "levelling-tolerance");
    }
}
