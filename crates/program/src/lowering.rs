//! What a machine cannot do as a whole, in smaller steps: hole cycles as moves.

use crate::{Cycle, CycleKind, Feed, Op, Pose, Spindle};

/// How far a rapid back into a hole stops above the last depth, mm: chips lie there.
pub const REENTRY: f64 = 0.5;

/// How far the tool draws back to break a chip, mm.
pub const CHIP_BREAK: f64 = 0.5;

/// The most pecks one hole may take; a cycle that asks for more is a slip of the keyboard.
pub const MAX_PECKS: usize = 10_000;

/// A part of a hole that is made without a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HoleMove {
    /// By rapid to a pose.
    Rapid(Pose),
    /// At the feed of the cycle to a pose.
    Line(Pose),
    /// A dwell, s.
    Dwell(f64),
    /// The spindle stops, or turns again.
    Spindle(Spindle),
}

impl From<HoleMove> for Op {
    fn from(part: HoleMove) -> Op {
        match part {
            HoleMove::Rapid(pose) => Op::Rapid(pose),
            HoleMove::Line(pose) => Op::Line(pose),
            HoleMove::Dwell(seconds) => Op::Dwell(seconds),
            HoleMove::Spindle(spindle) => Op::Spindle(spindle),
        }
    }
}

/// The moves of one hole, from the R plane on: the tool is at `hole` + clearance, and ends at
/// `hole` + retract. `spindle` is what runs, so that a boring cycle can start it again.
///
/// Returns `None` where moves cannot do it: tapping needs the control to couple feed and spindle, a
/// withdrawal has to stop the spindle in position, a peck that is not positive, or would take more than [`MAX_PECKS`], has no
/// end, and heights that are not finite are nowhere.
pub fn hole(cycle: &Cycle, hole: &Pose, spindle: Spindle) -> Option<Vec<HoleMove>> {
    let at = |height: f64| hole.lifted(height).ok();
    let mut moves = Vec::with_capacity(4);
    match cycle.kind {
        CycleKind::Tap { .. } | CycleKind::FineBore(_) | CycleKind::BackBore { .. } => return None,
        CycleKind::Drill | CycleKind::Bore | CycleKind::Ream => {
            moves.push(HoleMove::Line(at(-cycle.depth)?))
        }
        CycleKind::Deep | CycleKind::BreakChip => {
            let bottoms = pecks(cycle)?;
            for (i, &bottom) in bottoms.iter().enumerate() {
                if i > 0 && cycle.kind == CycleKind::Deep {
                    moves.push(HoleMove::Rapid(at(
                        (REENTRY - bottoms[i - 1]).min(cycle.clearance)
                    )?));
                }
                moves.push(HoleMove::Line(at(-bottom)?));
                if i + 1 < bottoms.len() {
                    moves.push(match cycle.kind == CycleKind::Deep {
                        true => HoleMove::Rapid(at(cycle.clearance)?),
                        false => HoleMove::Rapid(at((CHIP_BREAK - bottom).min(cycle.clearance))?),
                    });
                }
            }
        }
    }
    if cycle.dwell > 0.0 {
        moves.push(HoleMove::Dwell(cycle.dwell));
    }
    if cycle.kind == CycleKind::Ream {
        moves.push(HoleMove::Line(at(cycle.clearance)?));
    }
    if cycle.kind == CycleKind::Bore {
        moves.push(HoleMove::Spindle(Spindle::Off));
    }
    if cycle.kind != CycleKind::Ream || cycle.retract != cycle.clearance {
        moves.push(HoleMove::Rapid(at(cycle.retract)?));
    }
    if cycle.kind == CycleKind::Bore {
        moves.push(HoleMove::Spindle(spindle));
    }
    Some(moves)
}

/// The depth of each peck below the point of the hole, mm, the last one the full depth. The first
/// peck counts from the point, as CLDATA's `1STPECK` and `INCR` do.
pub fn pecks(cycle: &Cycle) -> Option<Vec<f64>> {
    let further = cycle.peck.or(cycle.first_peck)?;
    let first = cycle.first_peck.unwrap_or(further);
    if !(first > 0.0 && further > 0.0) || cycle.depth / further > MAX_PECKS as f64 {
        return None;
    }
    let mut bottoms = Vec::new();
    let mut bottom = first;
    // A rest below a micrometre is rounding, not a peck.
    while bottom < cycle.depth - 1e-3 {
        bottoms.push(bottom);
        bottom += further;
    }
    bottoms.push(cycle.depth);
    Some(bottoms)
}

/// The feed in mm/min for a move of `length` mm while the spindle turns at `speed` 1/min.
pub fn feed_per_minute(feed: Feed, length: f64, speed: f64) -> f64 {
    match feed {
        Feed::PerMinute(f) => f,
        Feed::PerTurn(f) => f * speed,
        Feed::InverseTime(f) => f * length,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Withdrawal;
    use geom::Vec3;

    fn cycle(kind: CycleKind) -> Cycle {
        Cycle {
            kind,
            depth: 12.0,
            clearance: 3.0,
            retract: 25.0,
            feed: None,
            dwell: 0.0,
            first_peck: Some(5.0),
            peck: Some(4.0),
        }
    }

    fn heights(moves: &[HoleMove]) -> Vec<f64> {
        let ops = moves.iter().map(|part| Op::from(*part));
        ops.filter_map(|op| op.pose().map(|p| p.point().z)).collect()
    }

    const POSE: fn() -> Pose = || Pose::upright(Vec3::ZERO).unwrap();

    #[test]
    fn drilling_feeds_in_and_goes_out_by_rapid() {
        let ops = hole(&cycle(CycleKind::Drill), &POSE(), Spindle::Off).unwrap();
        assert!(matches!(ops[..], [HoleMove::Line(_), HoleMove::Rapid(_)]));
        assert_eq!(heights(&ops), [-12.0, 25.0]);
    }

    #[test]
    fn deep_drilling_clears_the_hole_after_each_peck() {
        let ops = hole(&cycle(CycleKind::Deep), &POSE(), Spindle::Off).unwrap();
        assert_eq!(heights(&ops), [-5.0, 3.0, -4.5, -9.0, 3.0, -8.5, -12.0, 25.0]);
    }

    #[test]
    fn a_chip_break_stays_in_the_hole() {
        let ops = hole(&cycle(CycleKind::BreakChip), &POSE(), Spindle::Off).unwrap();
        assert_eq!(heights(&ops), [-5.0, -4.5, -9.0, -8.5, -12.0, 25.0]);
    }

    #[test]
    fn reaming_feeds_out_and_boring_stops_the_spindle_at_the_bottom() {
        let ops = hole(&cycle(CycleKind::Ream), &POSE(), Spindle::Off).unwrap();
        assert!(matches!(ops[..], [HoleMove::Line(_), HoleMove::Line(_), HoleMove::Rapid(_)]));
        let ops = hole(&cycle(CycleKind::Bore), &POSE(), Spindle::Clockwise(500.0)).unwrap();
        assert!(matches!(
            ops[..],
            [
                HoleMove::Line(_),
                HoleMove::Spindle(Spindle::Off),
                HoleMove::Rapid(_),
                HoleMove::Spindle(Spindle::Clockwise(500.0))
            ]
        ));
    }

    #[test]
    fn what_has_no_end_or_needs_the_control_is_refused() {
        let withdrawal = Withdrawal { aside: Vec3::X, angle: None };
        for kind in [
            CycleKind::Tap { pitch: 1.0, left: false },
            CycleKind::FineBore(withdrawal),
            CycleKind::BackBore { withdrawal, through: None },
        ] {
            assert_eq!(hole(&cycle(kind), &POSE(), Spindle::Off), None);
        }
        for peck in [0.0, -1.0, f64::NAN, 1e-6] {
            let c = Cycle { peck: Some(peck), first_peck: None, ..cycle(CycleKind::Deep) };
            assert_eq!(hole(&c, &POSE(), Spindle::Off), None);
        }
    }
}
