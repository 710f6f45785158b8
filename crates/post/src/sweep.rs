//! Cuts in which the rotary axes, each moving evenly, would swing the tool out of the plane of its turn:
//! near a singular pose, and in large steps. They are split where the tool axis of the source is half
//! way, until the swing is small. Where a cut leaves a singular pose in another direction than the one
//! before came in, the tool stands there first, so that the free axis may turn about it.

use geom::{Vec3, angle_between, between};
use machine::{Machine, OrientationMode};
use program::{Feed, Op, Pose, Program, Record};

/// How far the tool axis may leave its way, radians: half a degree.
const SWING: f64 = std::f64::consts::PI / 360.0;

/// A turn of the tool axis below this (radians, 1°) cannot swing it out by more than [`SWING`].
const SMALL: f64 = 2.0 * SWING;

/// What rounding may add to a position at the end of a travel, degrees.
const ROUNDING: f64 = 1e-6;

/// How often a cut is halved at the most.
const HALVINGS: u32 = 8;

/// So many times the records of the source may be added: what would need more is left as it is.
const MOST: usize = 4;

/// The records of `program` with such cuts split, and the lines of the source that were; `None` where
/// there are none.
pub(crate) fn split(program: &Program, machine: &Machine) -> Option<(Vec<Record>, Vec<u32>)> {
    let turned = [OrientationMode::ToolCenterAngles, OrientationMode::MachineAngles];
    if machine.rotary.len() < 2 || !turned.contains(&machine.orientation.simultaneous) {
        return None;
    }
    let mut split: Vec<Record> = Vec::new();
    let mut lines = Vec::new();
    let (mut here, mut feed) = (None, None);
    // The last tool axis that was another than that of `here`.
    let mut came = None;
    let mut room = MOST * program.records.len();
    for (index, record) in program.records.iter().enumerate() {
        let from: Option<Pose> = here;
        if let Some(to) = record.op.pose() {
            here = Some(*to);
        }
        if let Op::Feed(new) = record.op {
            feed = Some(new);
        }
        if let (Op::Line(to), Some(from)) = (&record.op, from) {
            let parts = parts(machine, came, &from, to, room);
            if from.axis() != to.axis() {
                came = Some(from.axis());
            }
            if !parts.is_empty() {
                if lines.is_empty() {
                    split.extend_from_slice(&program.records[..index]);
                }
                room = room.saturating_sub(parts.len() + 2);
                lines.push(record.line);
                put(&mut split, record, &parts, feed);
                continue;
            }
        }
        if !lines.is_empty() {
            split.push(record.clone());
        }
    }
    (!lines.is_empty()).then_some((split, lines))
}

/// Puts a cut behind its parts. In inverse time each has its part of the time; parts of one cut turn
/// the tool axis by as much each.
fn put(split: &mut Vec<Record>, cut: &Record, parts: &[Pose], feed: Option<Feed>) {
    let mut push = |op| split.push(Record { line: cut.line, op });
    let inverse = match feed {
        Some(Feed::InverseTime(rate)) => Some(rate),
        _ => None,
    };
    if let Some(rate) = inverse {
        push(Op::Feed(Feed::InverseTime(rate * (parts.len() + 1) as f64)));
    }
    parts.iter().for_each(|pose| push(Op::Line(*pose)));
    push(cut.op.clone());
    if let Some(rate) = inverse {
        push(Op::Feed(Feed::InverseTime(rate)));
    }
}

/// The poses on the way of a cut at which it is split evenly: none where the swing is small, or where
/// there is no room for so many.
fn parts(machine: &Machine, came: Option<Vec3>, from: &Pose, to: &Pose, room: usize) -> Vec<Pose> {
    let (a, b) = (from.axis(), to.axis());
    // Cheaper than the angle, and on the safe side.
    if a.distance_squared(b) < SMALL * SMALL || angle_between(a, b) < SMALL {
        return Vec::new();
    }
    for halvings in 0..=HALVINGS {
        let count = 1 << halvings;
        let axis = |i: usize| between(a, b, i as f64 / count as f64);
        if (0..count).all(|i| swing(machine, axis(i), axis(i + 1)) <= SWING) {
            let part = |i: usize| {
                let point = from.point().lerp(to.point(), i as f64 / count as f64);
                Pose::new(point, axis(i))
            };
            let stands = came.is_some_and(|came| turns_round(machine, came, a, b));
            let all = stands.then_some(Ok(*from)).into_iter().chain((1..count).map(part));
            // What cannot be split goes as it is, and the proof looks at it.
            return if count <= room {
                all.collect::<Result<_, _>>().unwrap_or_default()
            } else {
                Vec::new()
            };
        }
    }
    Vec::new()
}

/// Whether the axis that is free in the singular pose `at` stands so far from where `to` needs it, after
/// `came`, that turning on the way would swing the tool.
fn turns_round(machine: &Machine, came: Vec3, at: Vec3, to: Vec3) -> bool {
    let [Ok(before), Ok(singular), Ok(after)] = [came, at, to].map(|axis| machine.inverse(axis))
    else {
        return false;
    };
    let Some(free) = singular.free.filter(|_| after.free.is_none()) else { return false };
    let ways = (0..4).map(|k| {
        let (start, end) = (before.degrees[k / 2], after.degrees[k % 2]);
        [0, 1, 2].map(|i| (start[i], short_way(start[i], end[i])))
    });
    let turns = ways.filter(|way| within_travel(machine, way)).map(|way| way[free].1.abs());
    let turn = turns.reduce(f64::min).unwrap_or_default().to_radians();
    // Half way out it is off by half of the turn, seen from the pole.
    angle_between(at, to) / 2.0 * turn / 2.0 > SWING
}

/// The short way round from one position of a rotary axis to another, degrees.
fn short_way(from: f64, to: f64) -> f64 {
    let turn = to - from;
    turn - 360.0 * (turn / 360.0).round()
}

/// Whether both ends of a way are within the travels of the rotary axes, which may count whole turns.
fn within_travel(machine: &Machine, way: &[(f64, f64); 3]) -> bool {
    let held = |axis: &machine::RotaryAxis, at: f64| {
        (-1..=1).any(|turns| {
            let at = at + 360.0 * f64::from(turns);
            at >= axis.min - ROUNDING && at <= axis.max + ROUNDING
        })
    };
    machine.rotary.iter().all(|axis| {
        let (start, turn) = way[axis.index()];
        held(axis, start) && held(axis, start + turn)
    })
}

/// How far the tool axis leaves the great circle from `a` to `b` while the rotary axes go evenly and the
/// shortest way, radians; nothing where there is no way.
fn swing(machine: &Machine, a: Vec3, b: Vec3) -> f64 {
    let (Ok(from), Ok(to)) = (machine.inverse(a), machine.inverse(b)) else { return 0.0 };
    let way = |mut start: [f64; 3], mut end: [f64; 3]| {
        if let Some(free) = from.free {
            start[free] = end[free];
        }
        if let Some(free) = to.free {
            end[free] = start[free];
        }
        [0, 1, 2].map(|i| (start[i], short_way(start[i], end[i])))
    };
    let ways = (0..4).map(|k| way(from.degrees[k / 2], to.degrees[k % 2]));
    let length = |way: &[(f64, f64); 3]| way.iter().map(|(_, turn)| turn.abs()).sum::<f64>();
    let Some(way) = ways
        .filter(|way| within_travel(machine, way))
        .min_by(|v, w| length(v).total_cmp(&length(w)))
    else {
        return 0.0;
    };
    let off = |t: f64| {
        let degrees = way.map(|(start, turn)| start + t * turn);
        angle_between(machine.axis_at(degrees), between(a, b, t))
    };
    [0.25, 0.5, 0.75].into_iter().map(off).fold(0.0, f64::max)
}
