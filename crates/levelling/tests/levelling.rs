//! Levelled programs compared with the surface that they follow, sample by sample.

use geom::{Arc, Vec2, Vec3};
use program::heights::HeightMap;
use program::{
    ArcTo, Circle, Cycle, CycleKind, Feed, Op, Pose, Program, Record, Spindle, Tool, WorkOffset,
};
use proptest::prelude::*;
use toolpost_levelling::{Allowed, Grid, Probing, follow, height_map, level, read};

const ALLOWED: Allowed = Allowed { deviation: 0.005, outside: 5.0 };

/// A map of 4 by 3 places at uneven distances over 0 to 60 and 0 to 40 mm.
fn map(heights: &[f64]) -> HeightMap {
    let (columns, rows) = ([0.0, 13.0, 31.0, 60.0], [0.0, 22.0, 40.0]);
    let places = rows.iter().flat_map(|&y| columns.map(|x| (x, y)));
    let points = places.zip(heights).map(|((x, y), &z)| Vec3::new(x, y, z));
    height_map(&points.collect::<Vec<_>>()).unwrap()
}

fn pose(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

fn program(ops: Vec<Op>) -> Program {
    let mut program = Program::new("board");
    ops.into_iter().zip(1..).for_each(|(op, line)| program.push(line, op));
    program
}

/// The moves of a program as moves in space: rapid or not, and the point at any part of each.
fn program_moves(program: &Program) -> Vec<(u32, bool, Arc, bool)> {
    let mut here: Option<Vec3> = None;
    let mut moves = Vec::new();
    for record in &program.records {
        let Some(end) = record.op.pose().map(|pose| pose.point()) else { continue };
        if let Some(start) = here.replace(end) {
            let line = Arc { start, end, center: start, normal: Vec3::Z, sweep: 0.0 };
            match &record.op {
                Op::Arc(arc) => {
                    let arc = arc.circle.arc(start, end, 0.02).unwrap();
                    moves.push((record.line, false, arc, true));
                }
                op => moves.push((record.line, matches!(op, Op::Rapid(_)), line, false)),
            }
        }
    }
    moves
}

/// Points of a move, its ends among them.
fn samples(arc: &Arc, is_arc: bool, count: usize) -> impl Iterator<Item = Vec3> + '_ {
    (0..=count).map(move |n| {
        let t = n as f64 / count as f64;
        if is_arc { arc.at(t) } else { arc.start.lerp(arc.end, t) }
    })
}

/// A cut of the source, from (x, y) at a depth to (x, y) at another, straight or as an arc about a centre.
#[derive(Clone, Debug)]
enum Move {
    Line([f64; 3]),
    Arc { center: [f64; 2], sweep: f64, turns: u32, rise: f64, clockwise: bool },
}

fn moves() -> impl Strategy<Value = Move> {
    let inside = || (5.0..55.0, 5.0..35.0);
    prop_oneof![
        (inside(), -1.0..0.0).prop_map(|((x, y), z)| Move::Line([x, y, z])),
        (inside(), 0.05..6.25, 0u32..3, -0.3..0.3, any::<bool>()).prop_map(
            |((x, y), sweep, turns, rise, clockwise)| Move::Arc {
                center: [x, y],
                sweep,
                turns,
                rise,
                clockwise
            }
        ),
    ]
}

/// The program of these moves: a rapid, a plunge, the cuts, a rapid.
fn source(moves: &[Move]) -> Program {
    let mut ops = vec![Op::Rapid(pose(20.0, 20.0, 2.0)), Op::Feed(Feed::PerMinute(100.0))];
    let mut here = Vec3::new(20.0, 20.0, -0.1);
    ops.push(Op::Line(Pose::upright(here).unwrap()));
    for step in moves {
        match *step {
            Move::Line(end) => {
                here = Vec3::from_array(end);
                ops.push(Op::Line(Pose::upright(here).unwrap()));
            }
            Move::Arc { center, sweep, turns, rise, clockwise } => {
                let center = Vec2::from_array(center);
                let spoke = here.truncate() - center;
                // Within the map and its rim.
                if !(0.1..18.0).contains(&spoke.length()) {
                    continue;
                }
                let sense = if clockwise { -1.0 } else { 1.0 };
                let end = center + Vec2::from_angle(sense * sweep).rotate(spoke);
                here = end.extend((here.z + rise).min(0.0));
                ops.push(Op::Arc(Box::new(ArcTo {
                    end: Pose::upright(here).unwrap(),
                    circle: Circle::new(center.extend(0.0), Vec3::Z * sense, turns).unwrap(),
                })));
            }
        }
    }
    ops.push(Op::Rapid(pose(here.x, here.y, 2.0)));
    program(ops)
}

/// Each cut of `source`, sampled densely, is where `source` has it in X and Y, within `deviation` of the height of the
/// surface above it, from its start to its end; how far it is off that at most.
fn off(source: &Program, levelled: &Program, map: &HeightMap, deviation: f64) -> f64 {
    let cuts = program_moves(source).into_iter().filter(|(_, rapid, ..)| !rapid);
    let levelled = program_moves(levelled);
    let mut most = 0.0f64;
    for (line, _, arc, is_arc) in cuts {
        let pieces: Vec<_> = levelled.iter().filter(|(of, ..)| *of == line).collect();
        assert!(!pieces.is_empty());
        let flat = match is_arc {
            true => arc.radius() * arc.sweep,
            false => arc.start.truncate().distance(arc.end.truncate()),
        };
        if arc.start.truncate() == arc.end.truncate() && !is_arc {
            // Straight down from above.
            assert_eq!(pieces.len(), 1);
            assert!((pieces[0].2.end.z - arc.end.z - map.at(arc.end.truncate())).abs() < 1e-9);
            continue;
        }
        let mut gone = 0.0;
        for (_, _, piece, bent) in pieces {
            let whole = piece.start.truncate().distance(piece.end.truncate());
            let own = match bent {
                true => piece.radius() * piece.sweep,
                false => whole,
            };
            for (n, point) in samples(piece, *bent, 64).enumerate() {
                // Where the source is when it has gone as far in the plane.
                let t = ((gone + own * n as f64 / 64.0) / flat).min(1.0);
                let said = if is_arc { arc.at(t) } else { arc.start.lerp(arc.end, t) };
                let off = said.truncate().distance(point.truncate());
                assert!(off < 2e-3, "{t}: {said} {point}");
                let wanted = said.z + map.at(said.truncate());
                most = most.max((point.z - wanted).abs());
                let allowed = deviation + 1e-3 * 0.2;
                assert!((point.z - wanted).abs() <= allowed, "{} instead of {wanted}", point.z);
            }
            gone += own;
        }
        assert!((gone - flat).abs() < 1e-3 * flat.max(1.0));
    }
    most
}

/// A surface of 4 by 3 places 20 mm apart, which rises by `steepness` mm a mm along one of their sides, by less along
/// all others.
fn as_steep(heights: &[f64], steepness: f64) -> HeightMap {
    let at = |column: usize, row: usize| heights[row * 4 + column];
    let along_x = (0..9).map(|n| (n % 3, n / 3)).map(|(x, y)| at(x + 1, y) - at(x, y));
    let along_y = (0..8).map(|n| (n % 4, n / 4)).map(|(x, y)| at(x, y + 1) - at(x, y));
    let steepest = along_x.chain(along_y).fold(1e-9, |most: f64, rise| most.max(rise.abs()));
    let places = [0.0, 20.0, 40.0].iter().flat_map(|&y| [0.0, 20.0, 40.0, 60.0].map(|x| (x, y)));
    let scale = 20.0 * steepness / steepest;
    let points = places.zip(heights).map(|((x, y), z)| Vec3::new(x, y, z * scale));
    height_map(&points.collect::<Vec<_>>()).unwrap()
}

/// The tool is called first, with which a surface is found.
fn with_tool(mut source: Program) -> Program {
    let tool = Tool { number: 1, ..Tool::default() };
    source.records.insert(0, Record { line: 0, op: Op::Tool(Box::new(tool)) });
    source
}

/// What the control makes of a program that finds this surface.
fn found(source: &Program, map: &HeightMap, steepness: f64, allowed: &Allowed) -> Program {
    let grid = Grid::new(Vec2::ZERO, Vec2::new(60.0, 40.0), 4, 3).unwrap();
    let found = follow(&with_tool(source.clone()), &grid, &PROBING, steepness, allowed).unwrap();
    map.raise(&found).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_cut_follows_the_surface(
        heights in prop::collection::vec(-0.5..0.5, 12),
        moves in prop::collection::vec(moves(), 1..6),
    ) {
        let (map, source) = (map(&heights), source(&moves));
        let allowed = Allowed { outside: 20.0, ..ALLOWED };
        let levelled = level(&source, &map, &allowed).unwrap();
        off(&source, &levelled, &map, ALLOWED.deviation);
    }

    /// Divided without knowing the heights, it keeps to any surface that is no steeper than it was divided for; on one
    /// that is three times as steep it is three times as far off at most.
    #[test]
    fn every_cut_follows_a_surface_that_the_control_finds(
        heights in prop::collection::vec(-0.5..0.5, 12),
        moves in prop::collection::vec(moves(), 1..6),
    ) {
        let source = source(&moves);
        let allowed = Allowed { outside: 20.0, ..ALLOWED };
        for times in [1.0, 3.0] {
            let map = as_steep(&heights, times * 0.02);
            let raised = found(&source, &map, 0.02, &allowed);
            off(&source, &raised, &map, times * ALLOWED.deviation);
        }
    }
}

/// A saddle between four places, and a line along its diagonal. Where the sides rise by 0.02 mm a mm, two corners are
/// 0.4 mm above the others, and the middle of the diagonal between those is at 0.2 mm.
#[test]
fn a_surface_steeper_than_was_said_is_followed_less_closely() {
    let saddle = |steepness| as_steep(&[0., 1., 0., 1., 1., 0., 1., 0., 0., 1., 0., 1.], steepness);
    let diagonal = source(&[Move::Line([40.0, 40.0, -0.1])]);
    let off = |is: f64, said: f64| {
        let raised = found(&diagonal, &saddle(is), said, &ALLOWED);
        off(&diagonal, &raised, &saddle(is), 1.0)
    };
    // A part of n bulges by a part of n squared: 7 do where 0.2 mm may become 0.005, and 13 for 0.8 mm.
    for (is, said, right) in
        [(0.02, 0.02, 0.2 / 49.0), (0.02, 0.08, 0.2 / 169.0), (0.08, 0.02, 0.8 / 49.0)]
    {
        let off = off(is, said);
        assert!((off - right).abs() < 1e-4, "{is} for {said}: {off}");
    }
}

#[test]
fn a_flat_surface_shifts_a_program_and_divides_nothing() {
    let source = source(&[
        Move::Line([40.0, 30.0, -0.1]),
        Move::Arc { center: [30.0, 20.0], sweep: 6.0, turns: 2, rise: 0.0, clockwise: true },
    ]);
    let levelled = level(&source, &map(&[0.25; 12]), &ALLOWED).unwrap();
    assert_eq!(levelled.records.len(), source.records.len());
    for (was, is) in source.records.iter().zip(&levelled.records) {
        assert_eq!(was.line, is.line);
        if let (Some(was), Some(is)) = (was.op.pose(), is.op.pose()) {
            assert!((was.point() + Vec3::Z * 0.25).distance(is.point()) < 1e-12);
        }
    }
    assert_eq!(level(&source, &map(&[0.0; 12]), &ALLOWED).unwrap(), source);
}

/// A surface that rises evenly: each line stays one, and an arc is divided as the sine asks for.
#[test]
fn a_tilted_plane_divides_arcs_alone() {
    let tilted: Vec<f64> = [0.0, 22.0, 40.0]
        .iter()
        .flat_map(|y| [0.0, 13.0, 31.0, 60.0].map(|x| 0.01 * x + 0.002 * y))
        .collect();
    let line = source(&[Move::Line([55.0, 35.0, -0.1])]);
    assert_eq!(level(&line, &map(&tilted), &ALLOWED).unwrap().records.len(), line.records.len());
    let arc = source(&[Move::Arc {
        center: [30.0, 20.0],
        sweep: std::f64::consts::PI,
        turns: 0,
        rise: 0.0,
        clockwise: false,
    }]);
    let levelled = level(&arc, &map(&tilted), &ALLOWED).unwrap();
    // The height goes as 0.102 sin: chords of 40° bulge by 0.102 · 0.7² / 8 = 0.006 at most.
    let pieces = levelled.records.iter().filter(|r| matches!(r.op, Op::Arc(_))).count();
    assert!((4..=9).contains(&pieces), "{pieces}");
}

#[test]
fn rapids_are_lifted_and_holes_go_down_from_their_surface() {
    let cycle = Cycle {
        kind: CycleKind::Drill,
        depth: 1.8,
        clearance: 0.5,
        retract: 2.0,
        feed: None,
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    let source = program(vec![
        Op::Rapid(pose(0.0, 0.0, 3.0)),
        Op::Cycle(Box::new(cycle)),
        Op::Hole(pose(0.0, 0.0, 0.0)),
        Op::Hole(pose(60.0, 40.0, 0.0)),
        Op::CycleOff,
        Op::Rapid(pose(60.0, 40.0, 3.0)),
    ]);
    let mut heights = [0.0; 12];
    (heights[0], heights[11], heights[5]) = (-0.2, 0.3, 0.4);
    let levelled = level(&source, &map(&heights), &ALLOWED).unwrap();
    let z: Vec<f64> =
        levelled.records.iter().filter_map(|r| Some(r.op.pose()?.point().z)).collect();
    assert_eq!(z, [3.4, -0.2, 0.3, 3.4]);
}

/// Straight down it is as far above the surface as the source has it, and across the board above all of it, from
/// where it was on.
#[test]
fn rapids_straight_down_keep_their_distance_from_the_surface() {
    let source = program(vec![
        Op::Rapid(pose(0.0, 0.0, 2.0)),
        Op::Rapid(pose(0.0, 0.0, 0.5)),
        Op::Rapid(pose(60.0, 40.0, 0.5)),
        Op::Rapid(pose(60.0, 40.0, 0.2)),
        Op::Rapid(pose(60.0, 40.0, 2.0)),
    ]);
    let mut heights = [0.0; 12];
    (heights[0], heights[11], heights[5]) = (-0.2, 0.3, 0.4);
    let levelled = level(&source, &map(&heights), &ALLOWED).unwrap();
    let at: Vec<Vec3> =
        levelled.records.iter().filter_map(|r| Some(r.op.pose()?.point())).collect();
    let right = [
        (0., 0., 2.4),
        (0., 0., 0.3),
        (0., 0., 0.9),
        (60., 40., 0.9),
        (60., 40., 0.5),
        (60., 40., 2.4),
    ];
    assert_eq!(at.len(), right.len(), "{at:?}");
    assert!(at.iter().zip(right).all(|(at, right)| at.distance(right.into()) < 1e-12), "{at:?}");
}

#[track_caller]
fn refuses(ops: Vec<Op>, message: &str) {
    let line = ops.len() as u32;
    let found = level(&program(ops), &map(&[0.1; 12]), &ALLOWED).unwrap_err();
    assert_eq!((found.rule.name(), found.line), ("levelling", line), "{found}");
    assert!(found.message.contains(message), "{found}");
}

#[test]
fn what_cannot_be_levelled_is_refused_with_its_line() {
    let above = Op::Rapid(pose(1.0, 1.0, 2.0));
    refuses(vec![Op::Line(pose(1.0, 1.0, 0.0))], "a position that is not known");
    refuses(vec![above.clone(), Op::Line(pose(66.0, 1.0, 0.0))], "6.000 mm beyond");
    refuses(vec![above.clone(), Op::Rapid(pose(2.0, 1.0, -1.0))], "a rapid along the board");
    let tilted = Pose::new(Vec3::ZERO, Vec3::X).unwrap();
    refuses(vec![above.clone(), Op::Line(tilted)], "tilted");
    let arc = ArcTo {
        end: pose(1.0, 1.0, 2.0),
        circle: Circle::new(Vec3::new(1.0, 1.0, 0.0), Vec3::Y, 0).unwrap(),
    };
    refuses(vec![above.clone(), Op::Arc(Box::new(arc))], "plane XY");
    let flat = ArcTo { circle: Circle::new(arc.circle.center(), Vec3::Z, 0).unwrap(), ..arc };
    refuses(vec![above.clone(), Op::Arc(Box::new(flat))], "not equally far");
    refuses(vec![Op::Feed(Feed::InverseTime(3.0))], "inverse time");
    refuses(
        vec![Op::WorkOffset(WorkOffset::FIRST), Op::WorkOffset(WorkOffset::numbered(55).unwrap())],
        "several work offsets",
    );
    // A place that is not known is in no program.
    assert!(Pose::upright(Vec3::new(f64::NAN, 0.0, 0.0)).is_err());
    for deviation in [0.0, 1e-5, f64::NAN] {
        let allowed = Allowed { deviation, ..ALLOWED };
        let found = level(&Program::new("x"), &map(&[0.0; 12]), &allowed).unwrap_err();
        assert_eq!(found.rule.name(), "levelling-tolerance");
    }
}

/// A helix of four thousand million turns has no end, and is refused in time and memory.
#[test]
fn an_arc_without_end_is_refused() {
    let arc = ArcTo {
        end: pose(20.0, 20.0, 0.0),
        circle: Circle::new(Vec3::new(25.0, 20.0, 0.0), Vec3::Z, u32::MAX).unwrap(),
    };
    let mut heights = [0.0; 12];
    heights[5] = 0.3;
    let source = program(vec![Op::Rapid(pose(20.0, 20.0, 2.0)), Op::Arc(Box::new(arc))]);
    let found = level(&source, &map(&heights), &ALLOWED).unwrap_err();
    assert!(found.message.contains("100000 pieces"), "{found}");
}

const GRID: fn() -> Grid = || Grid::new(Vec2::new(2.0, 3.0), Vec2::new(62.0, 43.0), 4, 3).unwrap();
const PROBING: Probing = Probing { travel: 2.0, reach: 1.5, feed: 40.0 };

#[test]
fn a_grid_is_probed_row_by_row_there_and_back() {
    let places: Vec<Vec2> = GRID().places().collect();
    assert_eq!(places.len(), 12);
    let expected = [(2.0, 3.0), (22.0, 3.0), (42.0, 3.0), (62.0, 3.0), (62.0, 23.0), (42.0, 23.0)];
    assert_eq!(places[..6], expected.map(|(x, y)| Vec2::new(x, y)));
    assert_eq!(places[11], Vec2::new(62.0, 43.0));
    for (columns, rows) in [(1, 5), (5, 0), (1000, 1000), (usize::MAX, 2)] {
        let found = Grid::new(Vec2::ZERO, Vec2::ONE, columns, rows).unwrap_err();
        assert_eq!(found.rule.name(), "probing-grid");
    }
    assert!(Grid::new(Vec2::ZERO, Vec2::X, 2, 2).is_err());
    // 10 mm in 100 parts are 0.1 mm each.
    assert!(Grid::new(Vec2::ZERO, Vec2::splat(10.0), 2, 101).is_ok());
    let found = Grid::new(Vec2::ZERO, Vec2::splat(10.0), 2, 102).unwrap_err();
    assert!(found.message.contains("102 rows over 10 mm are 0.099"), "{found}");
    assert!(Grid::new(Vec2::ZERO, Vec2::new(f64::INFINITY, 1.0), 2, 2).is_err());
    for wrong in [
        Probing { reach: 0.0, ..PROBING },
        Probing { travel: 1.5, ..PROBING },
        Probing { feed: f64::NAN, ..PROBING },
    ] {
        assert_eq!(wrong.program("p", &GRID(), None).unwrap_err().rule.name(), "probing");
    }
    assert!(PROBING.program("p", &GRID(), Some("a) G0 Z-9")).is_err());
}

#[test]
fn columns_and_rows_of_a_grid_go_out_of_holes() {
    let far = |hole: Vec2| move |place: Vec2| place.distance(hole) >= 3.0;
    // A hole on the second column: it goes by 0.02 of the 20 mm to the next at a time, 3.2 mm being the first that is enough.
    let cleared = GRID().clear_of(far(Vec2::new(22.0, 23.0))).unwrap();
    let places: Vec<Vec2> = cleared.places().collect();
    assert!((places[1].x - 25.2).abs() < 1e-9 && places[1].y == 3.0, "{places:?}");
    assert_eq!(
        (places[0], places[2], places.len()),
        (Vec2::new(2.0, 3.0), Vec2::new(42.0, 3.0), 12)
    );
    // The outermost go inwards.
    let cleared = GRID().clear_of(far(Vec2::new(62.0, 43.0))).unwrap();
    assert!((cleared.places().nth(3).unwrap().x - 58.8).abs() < 1e-9);
    assert_eq!(GRID().clear_of(|_| true), Some(GRID()));
    assert_eq!(GRID().clear_of(|_| false), None);
    // 0.8 of their distance at most is between two columns.
    assert_eq!(GRID().clear_of(|place| (place.x - 22.0).abs() > 8.5 && place.y != 3.0), None);
}

/// Written, proven, and what a machine would answer read back.
#[test]
fn machines_probe_and_follow_what_they_found() {
    for (name, log) in
        [("generic-3axis-linuxcnc", Some("heights.txt")), ("generic-3axis-grbl", None)]
    {
        let machine = machine::load(name).unwrap();
        let probing = PROBING.program("probe", &GRID(), log).unwrap();
        let written = post::write(&probing, &machine).unwrap();
        let proof = proof::prove(&probing, &machine, "probe", &written.text, &Default::default());
        assert!(proof.proven, "{:?}", proof);
        let text = String::from_utf8(written.text).unwrap();
        assert_eq!(text.matches("G38.2").count(), 12, "{text}");
        assert_eq!(text.contains("(PROBEOPEN heights.txt)"), log.is_some(), "{text}");
        assert_eq!(text.contains("(PROBECLOSE)"), log.is_some(), "{text}");
        let grid = GRID();
        let answers = grid.places().map(|at| {
            let z = 0.004 * at.x - 0.0001 * at.x * at.y;
            match log {
                Some(_) => format!("{:.6} {:.6} {z:.6} 0.0 0.0 0.0 0.0 0.0 0.0\n", at.x, at.y),
                None => format!("[PRB:{:.3},{:.3},{:.3}:1]\n", at.x - 90.0, at.y - 50.0, z - 30.0),
            }
        });
        let zero = if log.is_none() { "[G54:-90.000,-50.000,-30.000]\n" } else { "" };
        let answers = zero.to_owned() + &answers.collect::<String>();
        let map = read("heights.txt", answers.as_bytes()).unwrap();
        assert!((map.at(Vec2::new(32.0, 23.0)) - (0.128 - 0.0736)).abs() < 1e-3);
        let mut board = source(&[
            Move::Line([50.0, 30.0, -0.1]),
            Move::Arc { center: [40.0, 25.0], sweep: 6.0, turns: 0, rise: 0.0, clockwise: true },
        ]);
        board
            .records
            .insert(0, program::Record { line: 0, op: Op::Spindle(Spindle::Clockwise(9000.0)) });
        let levelled = level(&board, &map, &ALLOWED).unwrap();
        assert!(levelled.records.len() > board.records.len() + 3);
        let written = post::write(&levelled, &machine).unwrap();
        let proof = proof::prove(&levelled, &machine, "board", &written.text, &Default::default());
        assert!(proof.proven, "{name}: {:?}", proof);
        let text = String::from_utf8(written.text).unwrap();
        assert!(text.lines().any(|line| line.starts_with("G2") && line.contains('Z')), "{text}");
    }
}
