//! Holes: canned cycles and the moves that make them.

use crate::common::*;
use control::Action;
use program::*;

/// A source with two holes of a cycle, at the height -1, from 20 mm above.
fn holes(of: Cycle) -> Program {
    source(vec![
        Op::Rapid(at(0.0, 0.0, 19.0)),
        Op::Cycle(Box::new(of)),
        Op::Hole(at(5.0, 0.0, -1.0)),
        Op::Hole(at(15.0, 0.0, -1.0)),
        Op::CycleOff,
        Op::Rapid(at(15.0, 0.0, 60.0)),
    ])
}

/// The same as a control with an R plane and no surface sees it.
fn canned(of: Cycle, first: Action) -> Vec<&'static str> {
    let seen = Cycle {
        depth: of.depth + of.clearance,
        clearance: 0.0,
        retract: of.retract - of.clearance,
        ..of
    };
    judged(of, vec![cycle(seen), first, Action::Hole(block(15.0, 0.0, 1.0)), Action::CycleOff])
}

fn judged(of: Cycle, between: Vec<Action>) -> Vec<&'static str> {
    let start = vec![Action::Rapid(block(0.0, 0.0, 19.0))];
    let end = vec![Action::Rapid(block(15.0, 0.0, 60.0))];
    rules(&judge(&mill(), &holes(of), [start, between, end].concat()))
}

fn first() -> Action {
    Action::Hole(block(5.0, 0.0, 1.0))
}

fn second() -> Action {
    Action::Hole(block(15.0, 0.0, 1.0))
}

#[test]
fn a_cycle_may_count_from_another_plane() {
    assert!(canned(drill(), first()).is_empty());
    let same = vec![
        cycle(drill()),
        Action::Hole(block(5.0, 0.0, -1.0)),
        Action::Rapid(block(15.0, 0.0, 19.0)),
        Action::Hole(block(15.0, 0.0, -1.0)),
    ];
    assert!(judged(drill(), same).is_empty());
}

#[test]
fn a_hole_elsewhere_twice_or_not_at_all_is_refused() {
    assert_eq!(canned(drill(), Action::Hole(block(5.0, 0.01, 1.0))), ["hole"]);
    assert_eq!(canned(drill(), Action::Hole(block(5.0, 0.0, 0.9))), ["hole"]);
    assert_eq!(canned(drill(), Action::Hole(block(5.0, f64::NAN, 1.0))), ["hole"]);
    assert_eq!(canned(drill(), Action::Comment("".into())), ["hole"]);
    let seen = Cycle { depth: 12.0, clearance: 0.0, retract: 18.0, ..drill() };
    let hole = |x| Action::Hole(block(x, 0.0, 1.0));
    assert_eq!(judged(drill(), vec![cycle(seen), hole(5.0), hole(5.0), hole(15.0)]), ["hole"]);
    assert_eq!(judged(drill(), vec![cycle(seen), hole(5.0), hole(15.0), hole(15.0)]), ["hole"]);
    assert_eq!(judged(drill(), vec![hole(5.0), hole(15.0)]), ["hole"]);
}

/// The rules that a program breaks whose cycle differs so.
fn altered(of: Cycle, alter: impl Fn(&mut Cycle)) -> Vec<&'static str> {
    let mut other = of;
    alter(&mut other);
    judged(
        of,
        vec![
            cycle(other),
            Action::Hole(block(5.0, 0.0, -1.0)),
            Action::Hole(block(15.0, 0.0, -1.0)),
        ],
    )
}

#[test]
fn depth_planes_feed_dwell_and_kind_are_those_of_the_source() {
    assert!(altered(drill(), |_| {}).is_empty());
    assert_eq!(altered(drill(), |c| c.depth = 10.01), ["hole"]);
    assert_eq!(altered(drill(), |c| c.depth = f64::NAN), ["hole"]);
    assert_eq!(altered(drill(), |c| c.clearance = 1.0), ["hole"]);
    assert_eq!(altered(drill(), |c| c.retract = 2.0), ["hole"]);
    assert_eq!(altered(drill(), |c| c.feed = None), ["feed"]);
    assert_eq!(altered(drill(), |c| c.feed = Some(Feed::PerMinute(1200.0))), ["feed"]);
    assert_eq!(altered(drill(), |c| c.dwell = 0.5), ["dwell"]);
    assert_eq!(altered(drill(), |c| c.kind = CycleKind::Ream), ["cycle"]);
    let tap = Cycle { kind: CycleKind::Tap { pitch: 0.7, left: false }, ..drill() };
    assert!(altered(tap, |_| {}).is_empty());
    assert_eq!(altered(tap, |c| c.kind = CycleKind::Tap { pitch: 0.75, left: false }), ["cycle"]);
    assert_eq!(altered(tap, |c| c.kind = CycleKind::Tap { pitch: 0.7, left: true }), ["cycle"]);
}

fn deep() -> Cycle {
    Cycle { kind: CycleKind::Deep, first_peck: Some(5.0), peck: Some(3.0), ..drill() }
}

#[test]
fn pecks_are_those_of_the_source() {
    assert!(altered(deep(), |_| {}).is_empty());
    assert_eq!(altered(deep(), |c| c.peck = Some(3.5)), ["peck"]);
    assert_eq!(altered(deep(), |c| c.peck = Some(0.3)), ["peck"]);
    assert_eq!(altered(deep(), |c| c.first_peck = Some(6.0)), ["peck"]);
    assert_eq!(altered(deep(), |c| (c.first_peck, c.peck) = (None, None)), ["peck"]);
    assert_eq!(altered(deep(), |c| c.kind = CycleKind::BreakChip), ["cycle"]);
    assert!(altered(deep(), |c| c.first_peck = Some(3.0)).is_empty());
}

#[test]
fn what_must_hold_in_a_cut_must_hold_in_a_hole() {
    for (word, rule) in [
        (Action::Spindle(Spindle::Off), "spindle"),
        (Action::Coolant(Coolant::Off), "coolant"),
        (Action::Compensation(Compensation::Left(None)), "compensation"),
        (Action::LengthOffset(None), "length-offset"),
    ] {
        let hole = |x| Action::Hole(block(x, 0.0, -1.0));
        assert_eq!(judged(drill(), vec![word, cycle(drill()), hole(5.0), hole(15.0)])[0], rule);
    }
}

/// Both holes by moves, over each first, with the same moves in each.
fn moves(of: Cycle, in_hole: impl Fn(f64) -> Vec<Action>) -> Vec<&'static str> {
    let mut does = vec![Action::Feed(Feed::PerMinute(120.0))];
    for x in [5.0, 15.0] {
        does.push(Action::Rapid(block(x, 0.0, 19.0)));
        does.push(Action::Rapid(block(x, 0.0, 1.0)));
        does.extend(in_hole(x));
    }
    judged(of, does)
}

#[test]
fn drilling_by_moves_is_proven() {
    let line = |x, z| Action::Line(block(x, 0.0, z));
    let rapid = |x, z| Action::Rapid(block(x, 0.0, z));
    assert!(moves(drill(), |x| vec![line(x, -11.0), rapid(x, 19.0)]).is_empty());
    assert!(moves(drill(), |x| vec![line(x, -11.0), rapid(x, 1.0), rapid(x, 19.0)]).is_empty());
    for (wrong, rule) in [
        (vec![(false, -10.9), (true, 19.0)], "hole"),
        (vec![(false, -11.1), (true, 19.0)], "hole"),
        (vec![(true, -11.0), (true, 19.0)], "hole"),
        (vec![(false, -11.0), (false, 19.0)], "hole"),
        (vec![(false, -11.0), (true, 25.0)], "hole"),
        (vec![(false, -5.0), (true, 1.0), (false, -11.0), (true, 19.0)], "hole"),
        (vec![(true, 0.0), (false, -11.0), (true, 19.0)], "hole"),
        (vec![(true, 5.0), (false, -11.0), (true, 19.0)], "hole"),
    ] {
        let found = moves(drill(), |x| {
            let step = |&(fast, z): &(bool, f64)| if fast { rapid(x, z) } else { line(x, z) };
            wrong.iter().map(step).collect()
        });
        assert_eq!(found, [rule], "{wrong:?}");
    }
}

#[test]
fn the_way_to_a_hole_goes_down_only_over_it() {
    let seen = Cycle { depth: 12.0, clearance: 0.0, retract: 18.0, ..drill() };
    let rapid = |x, z| Action::Rapid(block(x, 0.0, z));
    let by_moves = |way: Vec<Action>| {
        let hole = vec![Action::Line(block(15.0, 0.0, -11.0)), rapid(15.0, 19.0)];
        let words =
            vec![cycle(seen), first(), Action::CycleOff, Action::Feed(Feed::PerMinute(120.0))];
        judged(drill(), [words, way, hole].concat())
    };
    assert!(by_moves(vec![rapid(15.0, 19.0), rapid(15.0, 1.0)]).is_empty());
    assert!(by_moves(vec![rapid(5.0, 25.0), rapid(15.0, 25.0), rapid(15.0, 1.0)]).is_empty());
    assert_eq!(by_moves(vec![rapid(15.0, 1.0)]), ["hole"]);
    assert_eq!(by_moves(vec![rapid(5.0, 1.0), rapid(15.0, 1.0)]), ["hole"]);
    let by_cycle = |way: Vec<Action>| {
        judged(drill(), [vec![cycle(seen), first()], way, vec![second()]].concat())
    };
    assert!(by_cycle(vec![rapid(15.0, 19.0)]).is_empty());
    assert_eq!(by_cycle(vec![rapid(5.0, 1.0)]), ["hole"]);
}

/// The moves that [`lowering::hole`] makes, in blocks.
fn lowered(of: Cycle, x: f64) -> Vec<Action> {
    let moves = lowering::hole(&of, &at(x, 0.0, -1.0), Spindle::Clockwise(1000.0)).unwrap();
    let ops: Vec<Op> = moves.into_iter().map(Op::from).collect();
    actions(&ops)
}

#[test]
fn every_lowered_cycle_is_proven_and_none_of_its_moves_is_superfluous() {
    let kinds =
        [CycleKind::Drill, CycleKind::Deep, CycleKind::BreakChip, CycleKind::Ream, CycleKind::Bore];
    for kind in kinds {
        let of = Cycle { kind, dwell: 0.25, ..deep() };
        assert!(moves(of, |x| lowered(of, x)).is_empty(), "{kind:?}");
        let count = lowered(of, 0.0).len();
        for missing in 0..count {
            let found = moves(of, |x| {
                let mut others = lowered(of, x);
                // The spindle starts again after boring, which nothing but the next hole needs.
                others.remove(missing);
                others
            });
            assert!(!found.is_empty(), "{kind:?} without move {missing}");
        }
    }
}

#[test]
fn pecks_by_moves_are_those_of_the_source() {
    let line = |x, z| Action::Line(block(x, 0.0, z));
    let rapid = |x, z| Action::Rapid(block(x, 0.0, z));
    // Pecks end 5, 8 and 10 mm below the point at -1.
    let pecked = |a: f64, b: f64, up: f64, gap: f64| {
        moves(deep(), |x| {
            vec![
                line(x, a),
                rapid(x, up),
                rapid(x, a + gap),
                line(x, b),
                rapid(x, up),
                rapid(x, b + gap),
                line(x, -11.0),
                rapid(x, 19.0),
            ]
        })
    };
    assert!(pecked(-6.0, -9.0, 1.0, 0.5).is_empty());
    assert!(pecked(-6.0, -9.0, 1.0, 1.0).is_empty());
    assert_eq!(pecked(-7.0, -9.0, 1.0, 0.5), ["hole"]);
    assert_eq!(pecked(-6.0, -8.0, 1.0, 0.5), ["hole"]);
    assert_eq!(pecked(-6.0, -9.0, -3.0, 0.5), ["hole"]);
    assert_eq!(pecked(-6.0, -9.0, 1.0, 0.0), ["hole"]);
    assert_eq!(pecked(-6.0, -9.0, 1.0, 3.0), ["hole"]);
}

#[test]
fn tapping_by_moves_is_refused() {
    let tap = Cycle { kind: CycleKind::Tap { pitch: 0.7, left: false }, ..drill() };
    let line = |x, z| Action::Line(block(x, 0.0, z));
    assert_eq!(moves(tap, |x| vec![line(x, -11.0), line(x, 1.0)]), ["hole"]);
}

/// Each of two places is rounded for itself: half a step up, half a step down.
#[test]
fn a_way_from_hole_to_hole_is_level_but_for_the_rounding_of_both_ends() {
    let seen = Cycle { depth: 12.0, clearance: 0.0, retract: 18.0, ..drill() };
    let rapid = |z| Action::Rapid(block(15.0, 0.0, z));
    let across_at = |z: f64| {
        let way = vec![cycle(seen), first(), Action::CycleOff, rapid(z), rapid(1.0)];
        let hole = vec![
            Action::Feed(Feed::PerMinute(120.0)),
            Action::Line(block(15.0, 0.0, -11.0)),
            rapid(19.0),
        ];
        judged(drill(), [way, hole].concat())
    };
    assert!(across_at(19.0 - 0.0015).is_empty());
    assert_eq!(across_at(19.0 - 0.003), ["hole"]);
}

/// Where the machine's own axes are said, a tip is known to 0.0018 mm here: a peck that ends 0.0015 mm above the bottom is not
/// the last.
#[test]
fn a_peck_that_ends_within_rounding_of_the_bottom_is_not_the_last() {
    let machine = five_axes();
    let of = Cycle { depth: 10.0015, first_peck: Some(5.0), peck: Some(5.0), ..deep() };
    let line = |z| Action::Line(block(5.0, 0.0, z));
    let rapid = |z| Action::Rapid(block(5.0, 0.0, z));
    let own = source(vec![
        Op::Rapid(at(5.0, 0.0, 19.0)),
        Op::Cycle(Box::new(of)),
        Op::Hole(at(5.0, 0.0, -1.0)),
        Op::CycleOff,
    ]);
    let drilled = |pecks: &[Action]| {
        let start = vec![Action::Feed(Feed::PerMinute(120.0)), rapid(19.0), rapid(1.0)];
        rules(&judge(&machine, &own, [start, pecks.to_vec(), vec![rapid(19.0)]].concat()))
    };
    let pecks = [
        line(-6.0),
        rapid(1.0),
        rapid(-5.5),
        line(-11.0),
        rapid(1.0),
        rapid(-10.5),
        line(-11.0015),
    ];
    assert!(drilled(&pecks).is_empty(), "{:?}", drilled(&pecks));
    // Back in where nothing is left to drill.
    let again = [&pecks[..], &[rapid(1.0), rapid(-10.5), line(-11.0015)]].concat();
    assert_eq!(drilled(&again), ["hole"]);
}
