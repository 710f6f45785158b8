//! Any faithful program is proven, and any single damage to it is refused.

use crate::common::*;
use control::{Action, Position};
use geom::Vec3;
use program::*;
use proptest::prelude::*;

/// A piece of a program: what the source says and what the program says, in the same place.
#[derive(Clone, Debug)]
enum Piece {
    Rapid(Vec3),
    Line(Vec3),
    /// A turn of so many degrees to the left or, negative, to the right, round a centre in that
    /// direction.
    Arc {
        radius: f64,
        from: f64,
        turn: f64,
        rise: f64,
    },
    Hole {
        x: f64,
        y: f64,
        depth: f64,
    },
    Feed(u32),
    Speed(u32),
    Coolant(bool),
    Dwell(f64),
    Stop,
    Tool,
}

fn coordinate() -> impl Strategy<Value = f64> {
    (-80_000..80_000i32).prop_map(|thousandths| f64::from(thousandths) / 1e3)
}

fn point() -> impl Strategy<Value = Vec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from_array)
}

fn piece() -> impl Strategy<Value = Piece> {
    prop_oneof![
        3 => point().prop_map(Piece::Rapid),
        6 => point().prop_map(Piece::Line),
        4 => (1.0..50.0, 0.0..360.0, 20.0..340.0, any::<bool>(), -5.0..5.0f64).prop_map(
            |(radius, from, turn, left, rise): (f64, f64, f64, bool, f64)| {
                let turn = if left { turn } else { -turn };
                Piece::Arc { radius, from, turn, rise }
            }
        ),
        2 => (coordinate(), coordinate(), 1.0..30.0).prop_map(|(x, y, depth)| Piece::Hole { x, y, depth }),
        1 => (10..5000u32).prop_map(Piece::Feed),
        1 => (10..5000u32).prop_map(Piece::Speed),
        1 => any::<bool>().prop_map(Piece::Coolant),
        1 => (0.1..9.0).prop_map(Piece::Dwell),
        1 => Just(Piece::Stop),
        1 => Just(Piece::Tool),
    ]
}

/// The source and the program of these pieces, which begin with a rapid and end with a cut.
fn both(pieces: &[Piece]) -> (Vec<Op>, Vec<Action>) {
    let (mut own, mut nc) = (start(), nc_start());
    let (mut here, mut number) = (Vec3::new(0.0, 0.0, 90.0), 1);
    let go = |to: Vec3, own: &mut Vec<Op>, nc: &mut Vec<Action>, op: fn(Pose) -> Op| {
        own.push(op(at(to.x, to.y, to.z)));
        let rounded = (to * 1e3).round() / 1e3;
        nc.push(action(&op(at(rounded.x, rounded.y, rounded.z))));
    };
    go(here, &mut own, &mut nc, Op::Rapid);
    for piece in pieces {
        let mut alike = |op: Op| {
            nc.push(action(&op));
            own.push(op);
        };
        match piece {
            Piece::Rapid(to) | Piece::Line(to) if to.distance(here) < 0.1 => {}
            Piece::Rapid(to) => {
                go(*to, &mut own, &mut nc, Op::Rapid);
                here = *to;
            }
            Piece::Line(to) => {
                go(*to, &mut own, &mut nc, Op::Line);
                here = *to;
            }
            Piece::Arc { radius, from, turn, rise } => {
                let normal = if *turn > 0.0 { Vec3::Z } else { Vec3::NEG_Z };
                let spoke = geom::rotate(Vec3::X * *radius, Vec3::Z, from.to_radians());
                let center = here - spoke;
                let to = center + geom::rotate(spoke, Vec3::Z, turn.to_radians()) + Vec3::Z * *rise;
                own.push(Op::Arc(arc(at(to.x, to.y, to.z), center.into(), normal)));
                let (end, middle) = ((to * 1e3).round() / 1e3, (center * 1e3).round() / 1e3);
                nc.push(Action::Arc(arc_block(block(end.x, end.y, end.z), middle.into(), normal)));
                here = to;
            }
            Piece::Hole { x, y, depth } => {
                let depth = (depth * 1e3).round() / 1e3;
                alike(Op::Cycle(Box::new(Cycle { depth, feed: None, ..drill() })));
                go(Vec3::new(*x, *y, 0.0), &mut own, &mut nc, Op::Hole);
                here = Vec3::new(*x, *y, 20.0);
            }
            Piece::Feed(feed) => alike(Op::Feed(Feed::PerMinute(f64::from(*feed)))),
            Piece::Speed(speed) => alike(Op::Spindle(Spindle::Clockwise(f64::from(*speed)))),
            Piece::Coolant(on) => {
                alike(Op::Coolant(if *on { Coolant::Flood } else { Coolant::Off }))
            }
            Piece::Dwell(seconds) => alike(Op::Dwell(*seconds)),
            Piece::Stop => alike(Op::Stop),
            Piece::Tool => {
                number += 1;
                nc.push(Action::Home(Axes::Z));
                let op = Op::Tool(tool(number));
                nc.push(action(&op));
                own.push(op);
                nc.push(Action::LengthOffset(Some(number)));
                own.extend(start()[1..].iter().cloned());
                nc.extend(actions(&start()[1..]));
                here = Vec3::new(5.0 * f64::from(number), 5.0, 95.0);
                // From home across first, then down.
                nc.push(Action::Rapid(block(here.x, here.y, f64::NAN)));
                go(here, &mut own, &mut nc, Op::Rapid);
            }
        }
    }
    // A last cut, so that no word stands where it does nothing.
    here.z += if here.z > 0.0 { -31.0 } else { 31.0 };
    go(here, &mut own, &mut nc, Op::Line);
    nc.push(Action::Home(Axes::Z));
    nc.extend(end());
    (own, nc)
}

/// A direction square to the motion that follows a cut at `from`, as it begins: of an arc away from its centre.
fn off_what_follows(from: Vec3, following: &[Action]) -> Vec3 {
    let off = following.iter().find_map(|action| match action {
        Action::Arc(to) => Some((from - to.center).reject_from(to.normal)),
        action => Some((action.position()?.point - from).any_orthogonal_vector()),
    });
    off.and_then(Vec3::try_normalize).unwrap_or(Vec3::X)
}

/// Damages the action at `index` in the way that `how` chooses, by at least ten times the tolerance. `None` where there
/// is no such damage, or it would not change what the machine does.
fn damaged(nc: &[Action], index: usize, how: usize, by: f64) -> Option<Vec<Action>> {
    let action = &nc[index];
    let shift = |position: &Position| {
        let mut position = *position;
        position.point[how % 3] += by;
        position
    };
    Some(match (action, how) {
        // Where Z is not known yet it cannot be shifted, and beyond all cuts it may come down with X and Y.
        (Action::Rapid(position), 2 | 3) if position.point.z.is_nan() => return None,
        (
            Action::Rapid(_)
            | Action::Line(_)
            | Action::Hole(_)
            | Action::Arc(_)
            | Action::Dwell(_)
            | Action::Stop,
            3,
        ) => {
            vec![]
        }
        (Action::Tool(_), 3) => vec![],
        // A stop too many is no harm before a tool change, so it is not among the damages.
        (Action::Dwell(_) | Action::Hole(_), 4) => vec![action.clone(), action.clone()],
        (Action::Rapid(position), 4) => vec![Action::Line(*position)],
        (Action::Line(position), 4) => vec![Action::Rapid(*position)],
        (Action::Rapid(position), 0..3) => vec![Action::Rapid(shift(position))],
        (Action::Line(position), 0..3) => vec![Action::Line(shift(position))],
        (Action::Hole(position), 0..3) => vec![Action::Hole(shift(position))],
        (Action::Line(position), 5) => {
            let off = off_what_follows(position.point, &nc[index + 1..]);
            let point = position.point + off * (4.0 * by);
            vec![action.clone(), Action::Line(Position { point, ..*position })]
        }
        (Action::Arc(to), 0..3) => {
            vec![Action::Arc(Box::new(control::ArcTo { end: shift(&to.end), ..**to }))]
        }
        (Action::Arc(to), 4) => {
            vec![Action::Arc(Box::new(control::ArcTo { normal: -to.normal, ..**to }))]
        }
        (Action::Arc(to), 5) => {
            vec![Action::Arc(Box::new(control::ArcTo { turns: to.turns + 1, ..**to }))]
        }
        (Action::Arc(to), 6) => {
            let center = to.center + Vec3::new(by.signum() * 20.0, 20.0, 0.0);
            vec![Action::Arc(Box::new(control::ArcTo { center, ..**to }))]
        }
        (Action::Arc(to), 7) => vec![Action::Line(to.end)],
        (Action::Dwell(seconds), 5) => vec![Action::Dwell(seconds * 10.0)],
        (Action::Stop, 5) => vec![Action::OptionalStop],
        (Action::Tool(called), 5) => vec![Action::Tool(tool(called.number + 1))],
        (Action::Cycle(of), 0) => vec![cycle(Cycle { depth: of.depth + by, ..**of })],
        (Action::Cycle(of), 1) => vec![cycle(Cycle { clearance: of.clearance + by, ..**of })],
        (Action::Cycle(of), 2) => vec![cycle(Cycle { retract: of.retract + by, ..**of })],
        (Action::Cycle(of), 3) => vec![cycle(Cycle { kind: CycleKind::Ream, ..**of })],
        (Action::LengthOffset(_), 0) => vec![],
        (Action::End, 0) => vec![],
        _ => return None,
    })
}

/// Words that count where the next cut begins.
fn word_damaged(action: &Action) -> Option<Vec<Action>> {
    Some(match action {
        Action::Feed(Feed::PerMinute(feed)) => vec![Action::Feed(Feed::PerMinute(feed + 1.0))],
        Action::Spindle(Spindle::Clockwise(speed)) => {
            vec![Action::Spindle(Spindle::CounterClockwise(*speed))]
        }
        Action::Coolant(Coolant::Flood) => vec![Action::Coolant(Coolant::Mist)],
        _ => return None,
    })
}

/// Whether a word is followed by a cut before another word of its kind, so that it does something.
fn matters(nc: &[Action], index: usize) -> bool {
    let kind = std::mem::discriminant(&nc[index]);
    for action in &nc[index + 1..] {
        match action {
            Action::Line(_) | Action::Arc(_) | Action::Hole(_) => return true,
            action if std::mem::discriminant(action) == kind => return false,
            Action::Tool(_) if !matches!(nc[index], Action::Feed(_) | Action::Tool(_)) => {
                return false;
            }
            _ => {}
        }
    }
    false
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_faithful_program_is_proven_and_every_single_damage_is_refused(
        pieces in prop::collection::vec(piece(), 1..12),
        by in prop_oneof![Just(0.02), Just(-0.02), Just(3.0), Just(-3.0)],
    ) {
        let machine = mill();
        let (own, nc) = both(&pieces);
        let own = program(own);
        let faithful = run(&machine, &own, nc.clone());
        prop_assert!(faithful.proven, "{:#?}", faithful.mismatches);
        for (index, action) in nc.iter().enumerate() {
            for how in 0..8 {
                let Some(instead) = damaged(&nc, index, how, by).or_else(|| word_damaged(action)) else { continue };
                let word = !matches!(action, Action::Rapid(_) | Action::Line(_) | Action::Arc(_) | Action::Hole(_) | Action::Dwell(_) | Action::Stop | Action::End);
                if word && !matters(&nc, index) {
                    continue;
                }
                let mut bad = nc.clone();
                bad.splice(index..=index, instead.clone());
                let report = run(&machine, &own, bad);
                prop_assert!(!report.proven, "{action:?} at {index} became {instead:?}");
            }
        }
        for index in 1..nc.len() {
            let moves = |action: &Action| action.position().copied();
            if let (Some(a), Some(b)) = (moves(&nc[index - 1]), moves(&nc[index]))
                && a.point.distance(b.point) > 0.1
            {
                let mut bad = nc.clone();
                bad.swap(index - 1, index);
                prop_assert!(!run(&machine, &own, bad).proven, "swapped at {index}");
            }
        }
    }
}
