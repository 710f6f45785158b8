//! NC programs as contours: through a virtual control, and record by record.

use control::{Action, Position};
use geom::Vec2;
use program::{ArcTo, Axes, Circle, Compensation, Cycle, CycleKind, Op, Pose, Program};
use std::f64::consts::PI;
use toolpost_wire::points::{Step, points};
use toolpost_wire::segment::{self, Segment};
use toolpost_wire::{Path, contours, cuts, offset_contours};

type Vec3 = geom::Vec3;

fn program(text: &str) -> Program {
    let settings = control::Settings::new(control::Dialect::Fanuc, [false; 3]);
    let mut program = Program::new("test");
    control::read(&settings, "test.nc", text.as_bytes(), &mut |event| {
        let op = match event.action {
            Action::Rapid(to) => Op::Rapid(flat(&to)),
            Action::Line(to) => Op::Line(flat(&to)),
            Action::Arc(arc) => {
                let control::ArcTo { center, normal, turns, .. } = *arc;
                Op::Arc(Box::new(ArcTo {
                    end: flat(&arc.end),
                    circle: Circle::new(center, normal, turns).unwrap(),
                }))
            }
            Action::Compensation(side) => Op::Compensation(side),
            Action::ThreadWire => Op::ThreadWire,
            Action::CutWire => Op::CutWire,
            Action::Home(axes) if axes.contains(Axes::X) => Op::MachineMove(Box::default()),
            _ => return Ok(()),
        };
        program.push(event.line, op);
        Ok(())
    })
    .unwrap();
    program
}

/// A position of a program that never says Z.
fn flat(position: &Position) -> Pose {
    Pose::upright(position.point.with_z(0.0)).unwrap()
}

fn pose(x: f64, y: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, 0.0)).unwrap()
}

fn of(ops: Vec<Op>) -> Program {
    let mut program = Program::new("test");
    for (op, line) in ops.into_iter().zip(1..) {
        program.push(line, op);
    }
    program
}

fn rule(ops: Vec<Op>) -> (&'static str, u32) {
    let refused = contours(&of(ops), None).unwrap_err();
    (refused.rule.name(), refused.line)
}

/// The sector of the source, then an opening: rapids part them, the lines are those of the program.
#[test]
fn rapids_part_the_contours_of_a_program() {
    let text = "O1 G21 G90 G17 G94\nG0 X0. Y0. Z0.\nG1 X40. F6.6\nG3 X0. Y40. R40.\nG1 Y0.\n\
                G0 X100. Y5.\nG2 I-5. J0.\nM30\n";
    let found = contours(&program(text), None).unwrap();
    let [sector, hole] = found.as_slice() else { panic!("{found:?}") };
    assert!(sector.is_closed() && hole.is_closed());
    assert!((sector.area() - PI * 400.0).abs() < 1e-9);
    assert!((hole.area() + PI * 25.0).abs() < 1e-9);
    let lines: Vec<u32> = sector.elements().iter().map(|e| e.line).collect();
    assert_eq!((lines, hole.elements()[0].line), (vec![3, 4, 5], 7));
    assert_eq!(hole.start(), Vec2::new(100.0, 5.0));
    // Each is begun by its rapid, and so is the program of it.
    assert_eq!((sector.starts_by(), hole.starts_by()), (2, 6));
    let segments = [sector, hole].map(|contour| Segment::of(Path::upright(contour.clone())));
    let made = segment::program("a", &segments, 0.0, false).unwrap();
    let lines: Vec<u32> = made.records.iter().map(|record| record.line).collect();
    // Rapid, threading, the cuts, the wire is cut; then the end of the program.
    assert_eq!(lines, [2, 2, 3, 4, 5, 5, 6, 6, 7, 7, 7]);
    let found = points(&[&Path::upright(sector.clone())], Step::Length(0.1), None).unwrap();
    assert_eq!(found[0].of_line(4).next().unwrap().len(), 629);
}

/// A square below and a smaller one above: two programs, move by move.
#[test]
fn two_programs_are_the_two_ends_of_the_wire() {
    let square = |half: f64| {
        let text = format!(
            "O1 G21 G90 G94\nG0 X{half:.1} Y-{half:.1}\nG1 Y{half:.1} F5.\nX-{half:.1}\n\
             Y-{half:.1}\nX{half:.1}\nM30\n"
        );
        cuts(&program(&text), None).unwrap().remove(0).elements
    };
    let path = Path::by_block(square(10.0), square(9.0)).unwrap();
    let found = points(&[&path], Step::Length(1.0), None).unwrap().remove(0);
    assert_eq!(found.lower.len(), 5);
    let lean: Vec<Vec2> = found.upper.iter().zip(&found.lower).map(|(u, l)| *u - *l).collect();
    assert_eq!(lean[0], Vec2::new(-1.0, 1.0));
    assert_eq!(lean[2], Vec2::new(1.0, -1.0));
}

#[test]
fn what_is_no_way_of_a_wire_is_refused_with_its_line() {
    let start = Op::Rapid(pose(0.0, 0.0));
    assert_eq!(rule(vec![]), ("empty-contour", 0));
    assert_eq!(rule(vec![start.clone(), Op::Line(pose(0.0, 0.0))]), ("empty-contour", 0));
    assert_eq!(rule(vec![Op::Line(pose(1.0, 0.0))]), ("unknown-position", 1));
    let gone = vec![start.clone(), Op::MachineMove(Box::default()), Op::Line(pose(1.0, 0.0))];
    assert_eq!(rule(gone), ("unknown-position", 3));
    let open = vec![start.clone(), Op::Compensation(Compensation::Left(Some(1)))];
    assert_eq!(rule(open), ("open-compensation", 2));
    assert_eq!(rule(vec![start.clone(), Op::Hole(pose(1.0, 0.0))]), ("not-a-cut", 2));
    let leaning = Pose::new(Vec3::ZERO, Vec3::new(0.1, 0.0, 0.995).normalize()).unwrap();
    assert_eq!(rule(vec![start.clone(), Op::Line(leaning)]), ("not-upright", 2));
    let arc = |end: Pose, center: Vec3, normal: Vec3, turns: u32| {
        Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, normal, turns).unwrap() }))
    };
    let (end, center) = (pose(2.0, 0.0), Vec3::X);
    let upright = arc(end, center, Vec3::X, 0);
    assert_eq!(rule(vec![start.clone(), upright]), ("not-a-cut", 2));
    assert_eq!(rule(vec![start.clone(), arc(end, center, Vec3::Z, 1)]), ("not-a-cut", 2));
    assert_eq!(rule(vec![start.clone(), arc(end, Vec3::X * 0.9, Vec3::Z, 0)]), ("arc-center", 2));
    // A cycle that makes no hole cuts nothing.
    let cycle = Cycle {
        kind: CycleKind::Drill,
        depth: 1.0,
        clearance: 1.0,
        retract: 1.0,
        feed: None,
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    let ops = vec![start, Op::Cycle(Box::new(cycle)), Op::CycleOff, Op::Line(pose(1.0, 0.0))];
    assert_eq!(contours(&of(ops), None).unwrap().len(), 1);
}

#[test]
fn where_the_start_is_known_a_program_may_begin_with_a_cut() {
    let cut = of(vec![Op::Line(pose(10.0, 0.0))]);
    let found = contours(&cut, Some(Vec2::new(4.0, 0.0))).unwrap();
    assert_eq!(found[0].length(), 6.0);
}

/// A million moves of 0.02 µm are a million points, and too many for a small memory.
#[test]
fn a_million_tiny_moves() {
    let moves =
        (0..1_000_000).map(|i| Op::Line(pose(f64::from(i) * 2e-5, f64::from(i % 2) * 1e-5)));
    let ops = std::iter::once(Op::Rapid(pose(0.0, 0.0))).chain(moves).collect();
    let found = contours(&of(ops), None).unwrap();
    let path = Path::upright(found[0].clone());
    assert_eq!(points(&[&path], Step::ChordError(0.001), None).unwrap()[0].lower.len(), 1_000_000);
    let refused = points(&[&path], Step::Fit, Some(1000)).unwrap_err();
    assert_eq!((refused.diagnostic.rule.name(), refused.offer), ("memory", None));
}

/// A square of 20 mm with the wire in it, and one next to it with the wire outside.
const TWO: &str = "O1 G21 G90 G17 G94\nG0 X10. Y10. Z0.\nG1 G41 D1 X0. F6.\nY0.\nX20.\nY20.\nX0.\nY10.\n\
                   G1 G40 X10.\nG0 X50. Y-5.\nG1 G42 D1 Y0.\nX60.\nY20.\nX40.\nY0.\nX50.\nG1 G40 Y-5.\nM30\n";

#[test]
fn what_the_control_would_offset_is_a_contour_with_its_side_and_thread_point() {
    let found = offset_contours(&program(TWO), None).unwrap().unwrap();
    let [inner, outer] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!((inner.left, inner.thread), (true, Vec2::new(10.0, 10.0)));
    assert_eq!((outer.left, outer.thread), (false, Vec2::new(50.0, -5.0)));
    // The leads are no part of it.
    assert!(inner.contour.is_closed() && outer.contour.is_closed());
    assert_eq!((inner.contour.area(), outer.contour.area()), (400.0, 400.0));
    assert_eq!(inner.contour.elements()[0].line, 4);
    assert_eq!(
        offset_contours(&program("G21 G90\nG0 X0. Y0. Z0.\nG1 X1. F1.\nM30\n"), None),
        Ok(None)
    );
}

#[test]
fn an_offset_that_is_no_lead_contour_and_lead_is_refused_with_its_line() {
    let rule = |from: &str, to: &str| {
        let found = offset_contours(&program(&TWO.replace(from, to)), None).unwrap_err();
        (found.rule.name(), found.line)
    };
    assert_eq!(rule("G0 X50. Y-5.\n", "G1 X50. Y-5.\n"), ("open-compensation", 10));
    assert_eq!(rule("X20.\nY20.\nX0.\n", "X20.\nG0 Y20.\nG1 X0.\n"), ("open-compensation", 6));
    let again = "G1 G42 D2 X0.\nY20.\nX20.\nY0.\nX0.\nY10.\nG40 X10.\nG0 X50. Y-5.\n";
    assert_eq!(rule("G0 X50. Y-5.\n", again), ("source-passes", 10));
    let nowhere = of(vec![
        Op::Compensation(Compensation::Left(Some(1))),
        Op::Line(pose(1.0, 1.0)),
        Op::Line(pose(2.0, 1.0)),
    ]);
    assert_eq!(offset_contours(&nowhere, None).unwrap_err().rule.name(), "unknown-position");
}
