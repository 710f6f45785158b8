//! Cuts in which the rotary axes, each moving evenly, would swing the tool out of the plane of its turn:
//! near a singular pose, and in large steps. They are split where the tool axis of the source is half
//! way, until the swing is small. Where a cut leaves a singular pose in another direction than the one
//! before came in, the tool stands there first, so that the free axis may turn about it.

use geom::{Vec3, angle_between, between};
use machine::{Machine, OrientationMode};
use program::{Feed, Op, Outcome, Pose, Program, Progress, Pulse, Record};

/// How far the tool axis may leave its way, radians: half a degree.
const SWING: f64 = std::f64::consts::PI / 360.0;

/// A turn of the tool axis below this (radians, 1°) cannot swing it out by more than [`SWING`].
const SMALL: f64 = 2.0 * SWING;

/// What rounding may add to a position at the end of a travel, degrees.
const ROUNDING: f64 = 1e-6;

/// How often a cut is halved at the most.
const HALVINGS: u32 = 8;

/// After so many records whoever waits is asked: a millisecond at the most.
const AT_ONCE: u32 = 256;

/// So many times the records of the source may be added: what would need more is left as it is.
const MOST: usize = 4;

/// A program with such cuts split.
pub(crate) struct Split {
    pub(crate) records: Vec<Record>,
    /// The place of each in the source.
    pub(crate) places: Vec<u32>,
    /// The lines of the source that were split.
    pub(crate) lines: Vec<u32>,
}

/// `program` with such cuts split; `None` where there are none.
///
/// # Errors
/// The work was ended.
pub(crate) fn split(
    program: &Program,
    machine: &Machine,
    progress: &dyn Progress,
) -> Outcome<Option<Split>> {
    let turned = [OrientationMode::ToolCenterAngles, OrientationMode::MachineAngles];
    if machine.rotary.len() < 2 || !turned.contains(&machine.orientation.simultaneous) {
        return Ok(None);
    }
    let waits = |_| progress.reached(0.0);
    let mut pulse = Pulse::new(&waits, program.records.len(), AT_ONCE);
    let mut split: Vec<Record> = Vec::new();
    let mut places: Vec<u32> = Vec::new();
    let mut lines = Vec::new();
    let (mut here, mut feed) = (None, None);
    // The last tool axis that was another than that of `here`.
    let mut came = None;
    let mut room = MOST * program.records.len();
    for (index, record) in program.records.iter().enumerate() {
        pulse.step(index)?;
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
            if let Some(parts) = parts {
                if lines.is_empty() {
                    split.extend_from_slice(&program.records[..index]);
                    places.extend(0..index as u32);
                }
                room = room.saturating_sub(parts.poses.len() + 2);
                lines.push(record.line);
                let inverse = match feed {
                    Some(Feed::InverseTime(rate)) => Some(rate),
                    Some(Feed::PerMinute(_) | Feed::PerTurn(_)) | None => None,
                };
                let length = from.point().distance(to.point());
                let timed = machine.capabilities.inverse_time;
                put(&mut split, record, &parts, inverse.map(|rate| Timed { rate, length, timed }));
                places.resize(split.len(), index as u32);
                continue;
            }
        }
        if !lines.is_empty() {
            split.push(record.clone());
            places.push(index as u32);
        }
    }
    Ok((!lines.is_empty()).then_some(Split { records: split, places, lines }))
}

/// The poses before the end of a cut, and in how many parts of the same turn it is split: in a singular pose the tool
/// stands, which is none.
struct Parts {
    poses: Vec<Pose>,
    count: usize,
    /// Whether it does so before it sets out.
    stands_first: bool,
}

/// A cut in inverse time.
struct Timed {
    rate: f64,
    /// Path length of the tip, mm.
    length: f64,
    /// Whether the control knows it.
    timed: bool,
}

/// Puts a cut behind its parts. In inverse time each has its part of the time; where the control does not know that, the axes
/// turn about a standing tool at the number of the feed along the way.
fn put(split: &mut Vec<Record>, cut: &Record, parts: &Parts, feed: Option<Timed>) {
    let mut push = |op| split.push(Record { line: cut.line, op });
    let Some(Timed { rate, length, timed }) = feed else {
        parts.poses.iter().for_each(|pose| push(Op::Line(*pose)));
        return push(cut.op.clone());
    };
    let part = Feed::InverseTime(rate * parts.count as f64);
    push(Op::Feed(part));
    for (i, pose) in parts.poses.iter().enumerate() {
        let stands = i == 0 && parts.stands_first || i > 0 && parts.poses[i - 1] == *pose;
        if stands && !timed {
            push(Op::Feed(Feed::PerMinute(rate * length)));
            push(Op::Line(*pose));
            push(Op::Feed(part));
        } else {
            push(Op::Line(*pose));
        }
    }
    push(cut.op.clone());
    push(Op::Feed(Feed::InverseTime(rate)));
}

/// How a cut is split evenly: not where the swing is small, or where there is no room for so many parts.
fn parts(
    machine: &Machine,
    came: Option<Vec3>,
    from: &Pose,
    to: &Pose,
    room: usize,
) -> Option<Parts> {
    let (a, b) = (from.axis(), to.axis());
    // Cheaper than the angle, and on the safe side.
    if a.distance_squared(b) < SMALL * SMALL || angle_between(a, b) < SMALL {
        return None;
    }
    for halvings in 0..=HALVINGS {
        let count = 1 << halvings;
        let axis = |i: usize| between(a, b, i as f64 / count as f64);
        if (0..count).all(|i| swing(machine, axis(i), axis(i + 1)) <= SWING) {
            let part = |i: usize| {
                let point = from.point().lerp(to.point(), i as f64 / count as f64);
                Pose::new(point, axis(i))
            };
            // In a singular pose the tool stands while the axis that is free there turns.
            let stands = |i: usize| {
                let before = if i == 0 { came } else { Some(axis(i - 1)) };
                before.is_some_and(|before| turns_round(machine, before, axis(i), axis(i + 1)))
            };
            let at = |i: usize| {
                let go = (i > 0).then(|| part(i));
                go.into_iter().chain(stands(i).then(|| part(i)))
            };
            // What cannot be split goes as it is, and the proof looks at it.
            let poses: Vec<Pose> = (0..count).flat_map(at).collect::<Result<_, _>>().ok()?;
            let stands_first = stands(0);
            return (count <= room && !poses.is_empty()).then_some(Parts {
                poses,
                count,
                stands_first,
            });
        }
    }
    None
}

/// Whether the axis that is free in the singular pose `at` stands so far from where `to` needs it, after
/// `came`, that turning on the way would swing the tool.
fn turns_round(machine: &Machine, came: Vec3, at: Vec3, to: Vec3) -> bool {
    let Some(free) = machine.inverse(at).ok().and_then(|singular| singular.free) else {
        return false;
    };
    let [Ok(before), Ok(after)] = [came, to].map(|axis| machine.inverse(axis)) else {
        return false;
    };
    if after.free.is_some() {
        return false;
    }
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
pub(crate) fn short_way(from: f64, to: f64) -> f64 {
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
    machine.swing([way.map(|(start, _)| start), way.map(|(start, turn)| start + turn)], [a, b])
}
