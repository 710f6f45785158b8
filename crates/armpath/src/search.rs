//! The cheapest steps through the intervals of each cut.

use crate::follow::{self, Taken};
use crate::grid::{self, Node, POSTURES, Row};
use crate::samples::{Cut, Job};
use crate::{Blocked, Choice, Section, Why, Worst};
use arm::{Joints, Posture};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Intervals whose rows are in memory at the same time.
const BLOCK: usize = 512;

/// How often steps are searched anew, where they turn out not to be passed exactly.
const TRIES: usize = 16;

/// The turn of an edge: from the step below, the same, or from the step above.
const TURNS: [i32; 3] = [-1, 0, 1];

/// What an edge costs for turning the tool by a step, s.
const TURNING: f32 = 0.02;

/// What another posture costs than the one before where it is to be kept, s: more than any path.
const POSTURE: f32 = 1e5;

/// What it costs to come from home into another posture, s: the tool swings on the way, which may not be clear. A minute right at a limit costs as much.
const FROM_HOME: f32 = 60.0;

/// The cheapest steps to a node.
#[derive(Clone, Copy)]
struct Label {
    cost: f32,
    /// Joints without jumps, and the range in which each has been since the start.
    joints: [f32; 6],
    low: [f32; 6],
    high: [f32; 6],
}

impl Label {
    const DEAD: Label =
        Label { cost: f32::INFINITY, joints: [0.0; 6], low: [0.0; 6], high: [0.0; 6] };
}

/// An edge that turned out not to be passed: the knot at its end (its sample), its node there, and whence it came.
pub(crate) type Edge = (usize, usize, i32);

pub(crate) fn search(job: &Job) -> Result<Choice, Blocked> {
    let mut choice = Choice { sections: Vec::new(), worst: follow::NO_WORST };
    let mut last = job.settings.home.filter(|_| job.settings.keeps_posture);
    for cut in &job.cuts {
        let (mut from, mut reentry) = (cut.samples.start, None);
        loop {
            let within = from > cut.samples.start;
            // Where a cut is entered again the wrist turns over more easily above the cuts than the whole arm.
            let passed = match section(job, cut, from, (last, within), &mut choice.worst) {
                Err(_) if within => section(job, cut, from, (last, false), &mut choice.worst),
                passed => passed,
            }?;
            last = passed.section.positions.last().map(|position| position.joints);
            choice.sections.push(Section { reentry, ..passed.section });
            from = passed.end;
            if from + 1 >= cut.samples.end {
                break;
            }
            reentry = Some(passed.ended);
        }
    }
    Ok(choice)
}

/// How long a step of the turn takes at least, s.
fn step_time(job: &Job) -> f64 {
    job.step_angle() / job.settings.turn_rate
}

/// Samples of a cut, from `start` on, at which the turn may have changed by a step: all of them points.
fn knots(job: &Job, cut: &Cut, start: usize) -> Vec<usize> {
    let least = if cut.fixed { 0.0 } else { step_time(job) };
    let end = cut.samples.end;
    let (mut knots, mut time) = (vec![start], 0.0);
    for at in start + 1..end {
        time += job.samples[at].time;
        let is_last = at + 1 == end;
        let is_far = || !grid::is_near(&job.samples[knots[knots.len() - 1]], &job.samples[at]);
        if job.samples[at].is_point && (is_last || (time >= least && (cut.fixed || is_far()))) {
            knots.push(at);
            time = 0.0;
        }
    }
    knots
}

/// A section that is passed, and the sample at its end.
struct Passed {
    section: Section,
    end: usize,
    /// What ends it, where it is not the end of the cut.
    ended: Why,
}

/// The longest section from a sample on.
fn section(
    job: &Job,
    cut: &Cut,
    start: usize,
    before: Before,
    worst: &mut Worst,
) -> Result<Passed, Blocked> {
    let knots = &knots(job, cut, start)[..];
    let mut forbidden = BTreeSet::new();
    for _ in 0..TRIES {
        let (steps, posture, used_up) = cheapest(job, cut, knots, before, &forbidden)?;
        let (stopped, why) = match knots.get(steps.len() - 1..=steps.len()) {
            Some(&[from, to]) => {
                let of = same_arm(posture);
                let why = follow::stopped(job, from..=to, job.steps(cut), &of);
                match used_up {
                    Some(joint) if why.1 == Why::Apart => (why.0, Why::Range(joint)),
                    _ => why,
                }
            }
            _ => (0, Why::Apart),
        };
        // A cut is divided at the end of a motion.
        let last = knots[steps.len() - 1];
        let is_end = |at: &usize| {
            let sample = &job.samples[*at];
            at + 1 == cut.samples.end || (sample.is_point && !sample.inside)
        };
        let end = (start..=last).rfind(is_end);
        let Some(end) = end.filter(|end| *end > start || *end == last) else {
            return Err(job.blocked(stopped, why, job.steps(cut)));
        };
        match follow::follow(job, &knots[..steps.len()], &steps, posture, before.0, worst) {
            Taken::Passed(mut section) => {
                section.positions.truncate(job.samples[end].point + 1 - section.first);
                return Ok(Passed { section, end, ended: why });
            }
            Taken::Stopped(interval) => {
                let node = steps[interval] * POSTURES + posture.index();
                let turn = turn(steps[interval - 1], steps[interval], job.steps(cut));
                forbidden.insert((knots[interval], node, turn));
            }
            Taken::Nowhere => break,
        }
    }
    Err(job.blocked(knots[usize::from(knots.len() > 1)], Why::Apart, job.steps(cut)))
}

/// The turn that leads from one step to a neighbour, as in [`TURNS`] with the opposite sign.
fn turn(from: usize, to: usize, steps: usize) -> i32 {
    match (to + steps - from) % steps {
        0 => 0,
        1 => 1,
        _ => -1,
    }
}

/// The steps of the turn at each knot as far as they pass, its posture, and the joint (number from 1) whose range ends them.
fn cheapest(
    job: &Job,
    cut: &Cut,
    knots: &[usize],
    before: Before,
    forbidden: &BTreeSet<Edge>,
) -> Result<(Vec<usize>, Posture, Option<usize>), Blocked> {
    let steps = job.steps(cut);
    let first = grid::start(job, knots[0], steps);
    let mut labels: Vec<Label> = first.iter().map(|node| begin(job, node, before)).collect();
    let mut nodes = first;
    if nodes.iter().all(Node::is_dead) {
        let sample = &job.samples[knots[0]];
        let why = follow::nearest(job, sample, steps, &Posture::ALL);
        return Err(job.blocked(knots[0], why, steps));
    }
    // From which step the cheapest comes, at each knot behind the first.
    let mut back: Vec<Vec<i8>> = Vec::new();
    let mut used_up = None;
    'all: for block in (0..knots.len() - 1).step_by(BLOCK) {
        let until = (block + BLOCK).min(knots.len() - 1);
        for (i, row) in grid::rows(job, &knots[block..=until], steps).into_iter().enumerate() {
            let knot = knots[block + i + 1];
            let time: f64 =
                job.samples[knots[block + i] + 1..=knot].iter().map(|sample| sample.time).sum();
            let (next, from) = layer(job, &labels, &nodes, &row, time, knot, forbidden);
            if next.iter().all(|label| label.cost.is_infinite()) {
                used_up = used_up_by(job, &labels, &row);
                break 'all;
            }
            (labels, nodes) = (next, row);
            back.push(from);
        }
    }
    if back.is_empty() && knots.len() > 1 {
        let (at, why) = follow::stopped(job, knots[0]..=knots[1], steps, &Posture::ALL);
        return Err(job.blocked(at, why, steps));
    }
    let cheapest = (0..labels.len()).min_by(|a, b| labels[*a].cost.total_cmp(&labels[*b].cost));
    let end = cheapest.unwrap_or_default();
    let (mut step, posture) = (end / POSTURES, Posture::ALL[end % POSTURES]);
    let mut taken = vec![step];
    for from in back.iter().rev() {
        let turn = i32::from(from[step * POSTURES + posture.index()]);
        step = neighbour(step, turn, steps);
        taken.push(step);
    }
    taken.reverse();
    Ok((taken, posture, used_up))
}

/// The step from which a turn comes.
fn neighbour(step: usize, turn: i32, steps: usize) -> usize {
    (step as i32 + turn).rem_euclid(steps as i32) as usize
}

/// The postures that differ from one by the wrist alone.
fn same_arm(as_of: Posture) -> Vec<Posture> {
    let is_same = |of: &Posture| (of.rear(), of.below()) == (as_of.rear(), as_of.below());
    Posture::ALL.into_iter().filter(is_same).collect()
}

/// Where the arm stands before a section, and whether it may turn its wrist over alone.
type Before = (Option<Joints>, bool);

/// The label of a node at the start: what the arm needs to come here from where the section before ended.
fn begin(job: &Job, node: &Node, (last, keeps_arm): Before) -> Label {
    let arm = job.arm;
    if node.is_dead() {
        return Label::DEAD;
    }
    let seconds = |i: usize, before: f64| {
        let change = follow::turned(arm, i, f64::from(node.end[i]), before) - before;
        change.abs() / arm.joints()[i].speed
    };
    let time = last.map_or(0.0, |last| (0..6).map(|i| seconds(i, last[i])).fold(0.0, f64::max));
    let end = node.end.map(f64::from);
    let [earlier, posture] = [last.unwrap_or(end), end].map(|joints| arm.posture(&joints));
    if keeps_arm && !same_arm(earlier).contains(&posture) {
        return Label::DEAD;
    }
    let keeping = match last {
        None if job.settings.home.is_some_and(|home| arm.posture(&home) != posture) => FROM_HOME,
        Some(_) if job.settings.keeps_posture && earlier != posture => POSTURE,
        None | Some(_) => 0.0,
    };
    Label {
        cost: node.cost + time as f32 + keeping,
        joints: node.end,
        low: node.end,
        high: node.end,
    }
}

/// The labels at the end of an interval, and whence each came.
fn layer(
    job: &Job,
    labels: &[Label],
    before: &Row,
    row: &Row,
    time: f64,
    knot: usize,
    forbidden: &BTreeSet<Edge>,
) -> (Vec<Label>, Vec<i8>) {
    let steps = row.len() / POSTURES;
    let mut next = vec![Label::DEAD; row.len()];
    let mut from = vec![0_i8; row.len()];
    let turns = if steps < 3 || time < step_time(job) { &TURNS[1..2] } else { &TURNS[..] };
    for (at, node) in row.iter().enumerate().filter(|(_, node)| !node.is_dead()) {
        let (step, posture) = (at / POSTURES, at % POSTURES);
        for turn in turns {
            let source = neighbour(step, *turn, steps) * POSTURES + posture;
            let (label, earlier) = (&labels[source], &row[source]);
            // In an interval in which the tool turns, both of the steps have to be passed.
            let dead = label.cost.is_infinite() || before[source].is_dead() || earlier.is_dead();
            if dead || forbidden.contains(&(knot, at, -turn)) {
                continue;
            }
            if let Some(label) = extend(job, label, earlier, node, *turn, time)
                && label.cost < next[at].cost
            {
                (next[at], from[at]) = (label, *turn as i8);
            }
        }
    }
    (next, from)
}

/// The joint, number from 1, that would leave its range on an interval in which the cheapest label that could go on stands still.
fn used_up_by(job: &Job, labels: &[Label], row: &Row) -> Option<usize> {
    let alive =
        labels.iter().zip(row).filter(|(label, node)| label.cost.is_finite() && !node.is_dead());
    let (label, node) = alive.min_by(|(a, _), (b, _)| a.cost.total_cmp(&b.cost))?;
    let leaves = |i: &usize| {
        let low = label.low[*i].min(label.joints[*i] + node.low[*i]);
        let high = label.high[*i].max(label.joints[*i] + node.high[*i]);
        follow::fitting(job, *i, f64::from(low), f64::from(high)).is_none()
    };
    (0..6).find(leaves).map(|joint| joint + 1)
}

/// The label behind an interval that begins with the step of `earlier` and ends with that of `node`.
fn extend(
    job: &Job,
    label: &Label,
    earlier: &Node,
    node: &Node,
    turn: i32,
    time: f64,
) -> Option<Label> {
    let mut next = Label { cost: label.cost + earlier.cost.max(node.cost), ..*label };
    if turn != 0 {
        next.cost += TURNING;
    }
    for i in 0..6 {
        let turned = wrap32(node.end[i] - earlier.end[i]);
        // The turn comes on top of the motion along the path.
        let used = f64::from(earlier.speed.max(node.speed))
            + grid::share(job.arm, i, f64::from(turned), time);
        if turn != 0 && used > job.settings.speed {
            return None;
        }
        next.low[i] = next.low[i].min(label.joints[i] + earlier.low[i]);
        next.high[i] = next.high[i].max(label.joints[i] + earlier.high[i]);
        next.joints[i] += earlier.net[i] + turned;
        next.low[i] = next.low[i].min(next.joints[i]);
        next.high[i] = next.high[i].max(next.joints[i]);
        follow::fitting(job, i, f64::from(next.low[i]), f64::from(next.high[i]))?;
    }
    Some(next)
}

fn wrap32(angle: f32) -> f32 {
    let turn = TAU as f32;
    angle - turn * (angle / turn).round()
}
