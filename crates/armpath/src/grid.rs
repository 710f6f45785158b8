//! Every step of the turn and every posture, followed through each interval with the turn standing still.

use crate::samples::{Job, Sample};
use crate::{SPACING, Settings, Why};
use arm::{Arm, Joints, Margins, Posture};
use geom::ending::{go_on, is_ended};
use geom::wrap;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;

/// Postures of each step.
pub(crate) const POSTURES: usize = 8;

/// Intervals that one thread follows one after the other: the joints at the end of one are those at the start of the next.
const RUN: usize = 32;

/// A turn and a posture at the end of an interval, or at the start of a cut.
#[derive(Clone, Copy)]
pub(crate) struct Node {
    /// Cost of the interval, s; infinite where it cannot be passed.
    pub(crate) cost: f32,
    /// Largest part of a joint's speed.
    pub(crate) speed: f32,
    /// The joints at its end.
    pub(crate) end: [f32; 6],
    /// By how much the joints change in it.
    pub(crate) net: [f32; 6],
    /// How far each joint goes below its start.
    pub(crate) low: [f32; 6],
    /// How far each joint goes above its start.
    pub(crate) high: [f32; 6],
}

impl Node {
    const DEAD: Node = Node {
        cost: f32::INFINITY,
        speed: 0.0,
        end: [0.0; 6],
        net: [0.0; 6],
        low: [0.0; 6],
        high: [0.0; 6],
    };

    pub(crate) fn is_dead(&self) -> bool {
        self.cost.is_infinite()
    }
}

/// The nodes of an interval: those of the first step's eight postures, then of the next.
pub(crate) type Row = Vec<Node>;

/// The joints of a sample, with the turn at a step, in a posture; and what it costs to be there.
type Candidate = Option<(Joints, f32)>;

/// The nodes at the start of a cut, at a sample.
pub(crate) fn start(job: &Job, sample: usize, steps: usize) -> Row {
    candidates(job, &job.samples[sample], steps)
        .into_iter()
        .map(|candidate| match candidate {
            Some((joints, cost)) => {
                Node { cost, end: joints.map(|q| q as f32), ..Node { cost: 0.0, ..Node::DEAD } }
            }
            None => Node::DEAD,
        })
        .collect()
}

/// The rows of the intervals between knots, each from the sample of one knot to that of the next.
pub(crate) fn rows(job: &Job, knots: &[usize], steps: usize) -> Vec<Row> {
    let intervals: Vec<Range<usize>> = knots.windows(2).map(|pair| pair[0]..pair[1]).collect();
    let of = |run| if is_ended() { Vec::new() } else { follow(job, run, steps) };
    let rows = intervals.par_chunks(RUN).flat_map_iter(of).collect();
    go_on();
    rows
}

fn follow(job: &Job, run: &[Range<usize>], steps: usize) -> Vec<Row> {
    let Some(first) = run.first() else { return Vec::new() };
    let mut here = candidates(job, &job.samples[first.start], steps);
    let mut rows = Vec::with_capacity(run.len());
    for interval in run {
        go_on();
        let mut row: Row = here
            .iter()
            .map(|candidate| match candidate {
                Some(_) => Node { cost: 0.0, ..Node::DEAD },
                None => Node::DEAD,
            })
            .collect();
        for (at, time) in looks(job, interval) {
            let next = candidates(job, &job.samples[at], steps);
            for ((node, from), to) in row.iter_mut().zip(&here).zip(&next) {
                advance(node, from, to, time, job);
            }
            here = next;
        }
        for (node, candidate) in row.iter_mut().zip(&here) {
            match candidate {
                Some((joints, _)) => node.end = joints.map(|q| q as f32),
                None => *node = Node::DEAD,
            }
        }
        rows.push(row);
    }
    rows
}

/// The samples of an interval at which all turns and postures are looked at, with the time from one to the next: where points are
/// dense not all of them. The choice is followed through each ([`crate::follow`]).
fn looks(job: &Job, interval: &Range<usize>) -> Vec<(usize, f64)> {
    let mut looks = Vec::new();
    let (mut last, mut time) = (&job.samples[interval.start], 0.0);
    for at in interval.start + 1..=interval.end {
        let sample = &job.samples[at];
        time += sample.time;
        // The next one would be too far.
        let next = job.samples[..=interval.end].get(at + 1);
        if next.is_none_or(|next| !is_near(last, next)) {
            looks.push((at, time));
            (last, time) = (sample, 0.0);
        }
    }
    looks
}

/// Whether all turns and postures need to be looked at only in one of two samples.
pub(crate) fn is_near(a: &Sample, b: &Sample) -> bool {
    // A degree.
    const LEAN: f64 = std::f64::consts::PI / 180.0;
    a.tip.distance_squared(b.tip) < SPACING * SPACING
        && a.out.distance_squared(b.out) < LEAN * LEAN
        && a.side.distance_squared(b.side) < LEAN * LEAN
}

/// One sample further, in `time`.
fn advance(node: &mut Node, from: &Candidate, to: &Candidate, time: f64, job: &Job) {
    let (Some((from, _)), Some((to, cost)), false) = (from, to, node.is_dead()) else {
        *node = Node::DEAD;
        return;
    };
    let mut fastest = 0.0_f64;
    for i in 0..6 {
        let change = wrap(to[i] - from[i]);
        fastest = fastest.max(share(job.arm, i, change, time));
        node.net[i] += change as f32;
        node.low[i] = node.low[i].min(node.net[i]);
        node.high[i] = node.high[i].max(node.net[i]);
    }
    node.speed = node.speed.max(fastest as f32);
    // Half of the cost is standing near to where the arm must not be, half the effort of its joints.
    node.cost += (time as f32) * (cost + fastest as f32);
    if fastest > job.settings.speed {
        *node = Node::DEAD;
    }
}

/// The part of a joint's speed that a change in `time` needs.
pub(crate) fn share(arm: &Arm, joint: usize, change: f64, time: f64) -> f64 {
    let needed = change.abs() / arm.joints()[joint].speed;
    if needed <= 1e-12 { 0.0 } else { needed / time }
}

/// All joints of a sample: eight postures of each step.
fn candidates(job: &Job, sample: &Sample, steps: usize) -> Vec<Candidate> {
    let mut candidates = Vec::with_capacity(steps * POSTURES);
    for step in 0..steps {
        let solutions = job.arm.inverse(&job.frame(sample, step as f64 * job.step_angle()), 0.0);
        for posture in Posture::ALL {
            let joints = solutions.get(posture);
            candidates.push(
                joints.and_then(|joints| {
                    Some((*joints, cost_at(job.arm, joints, job.settings).ok()?))
                }),
            );
        }
    }
    candidates
}

/// What it costs to be at these joints, at most some tens.
///
/// # Errors
/// Where it must not.
pub(crate) fn cost_at(arm: &Arm, joints: &Joints, settings: &Settings) -> Result<f32, Why> {
    let mut cost = 0.0;
    let mut turned = *joints;
    for (i, (joint, q)) in arm.joints().iter().zip(&mut turned).enumerate() {
        let (low, high) = (joint.min + settings.limit, joint.max - settings.limit);
        *q += TAU * ((low - *q) / TAU).ceil();
        if *q > high {
            // The nearer of the limits, with this turn or the one below.
            return Err(Why::Limit(i + 1, (*q - high).min(low + TAU - *q)));
        }
        // Of the joints that go round several turns are good: which one, the whole section says.
        if high - low < TAU {
            cost += near((*q - low).min(high - *q), 0.1);
        }
    }
    if !arm.allows(&turned) {
        return Err(Why::Limit(3, 0.0));
    }
    let Margins { wrist, shoulder, elbow } = arm.margins(joints);
    if wrist < settings.wrist {
        return Err(Why::Wrist(wrist));
    }
    if shoulder < settings.shoulder {
        return Err(Why::Shoulder(shoulder));
    }
    if elbow < settings.elbow {
        return Err(Why::Elbow(elbow));
    }
    Ok((cost + near(wrist, 0.3) + near(shoulder, 100.0) + near(elbow, 0.3)) as f32)
}

/// 1 at the distance 0, a quarter at `scale`, and less and less farther away.
fn near(distance: f64, scale: f64) -> f64 {
    let part = 1.0 / (1.0 + distance / scale);
    part * part
}
