//! Steps that were found, followed exactly: joints at every sample, without jumps, and every figure checked.

use crate::grid::{cost_at, share};
use crate::samples::{Job, Sample};
use crate::{Position, Section, Why, Worst};
use arm::{Arm, Joints, Posture, Structure, Vec3};
use geom::ending::go_on;
use geom::wrap;
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Margins that nothing has made less.
pub(crate) const NO_WORST: Worst = Worst {
    wrist: (f64::INFINITY, 0),
    shoulder: (f64::INFINITY, 0),
    elbow: (f64::INFINITY, 0),
    limit: (f64::INFINITY, 0),
    speed: (0.0, 0),
};

/// What comes of following the steps.
pub(crate) enum Taken {
    /// It is passed.
    Passed(Section),
    /// It is not passed in this interval, counted from 1.
    Stopped(usize),
    /// It does not begin, or fits into no turns of its joints.
    Nowhere,
}

/// Follows the steps of the turn at the knots.
pub(crate) fn follow(
    job: &Job,
    knots: &[usize],
    steps: &[usize],
    posture: Posture,
    last: Option<Joints>,
    worst: &mut Worst,
) -> Taken {
    let first = knots[0];
    let angle = job.step_angle();
    let mut turn = steps[0] as f64 * angle;
    let Some(joints) = solve(job, &job.samples[first], turn, posture) else {
        return Taken::Nowhere;
    };
    // Joints and turn at each sample.
    let mut passed = vec![(joints, turn)];
    let mut speed = (0.0_f64, 0);
    for interval in 1..knots.len() {
        go_on();
        let samples = &job.samples[knots[interval - 1] + 1..=knots[interval]];
        let whole: f64 = samples.iter().map(|sample| sample.time).sum();
        let count = i64::from(job.settings.turns);
        let by = (steps[interval] as i64 - steps[interval - 1] as i64).rem_euclid(count);
        let by = (if by * 2 > count { by - count } else { by }) as f64 * angle;
        let (start, mut elapsed) = (turn, 0.0);
        for (i, sample) in samples.iter().enumerate() {
            elapsed += sample.time;
            let part = if i + 1 == samples.len() || whole <= 0.0 { 1.0 } else { elapsed / whole };
            turn = start + by * part;
            let Some((before, _)) = passed.last() else { return Taken::Nowhere };
            let Some(found) = solve(job, sample, turn, posture) else {
                return Taken::Stopped(interval);
            };
            let joints: Joints = std::array::from_fn(|k| before[k] + wrap(found[k] - before[k]));
            for k in 0..6 {
                let used = share(job.arm, k, joints[k] - before[k], sample.time);
                if used > job.settings.speed {
                    return Taken::Stopped(interval);
                }
                if used > speed.0 {
                    speed = (used, sample.point);
                }
            }
            passed.push((joints, turn));
        }
    }
    let Some(shift) = shift(job, &passed, last) else { return Taken::Stopped(knots.len() - 1) };
    if speed.0 > worst.speed.0 {
        worst.speed = speed;
    }
    let mut positions = Vec::new();
    for ((joints, turn), sample) in passed.iter().zip(&job.samples[first..]) {
        let joints: Joints = std::array::from_fn(|k| joints[k] + shift[k]);
        note(job.arm, &joints, sample.point, worst);
        if sample.is_point {
            positions.push(Position { joints, side: job.side_in_part(sample, *turn) });
        }
    }
    Taken::Passed(Section { first: job.samples[first].point, posture, positions, reentry: None })
}

/// The joints of a sample, where the settings allow them.
fn solve(job: &Job, sample: &Sample, turn: f64, posture: Posture) -> Option<Joints> {
    let joints = job.arm.inverse_in(posture, &job.frame(sample, turn), 0.0)?;
    cost_at(job.arm, &joints, job.settings).ok()?;
    Some(joints)
}

/// Whole turns for each joint, that bring the whole section within the limits; those nearest to where the section before ended.
fn shift(job: &Job, passed: &[(Joints, f64)], last: Option<Joints>) -> Option<Joints> {
    let mut shift = [0.0; 6];
    for (k, shift) in shift.iter_mut().enumerate() {
        let of = |joints: &(Joints, f64)| joints.0[k];
        let low = passed.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = passed.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let (least, most) = fitting(job, k, low, high)?;
        let start = passed.first().map_or(0.0, of);
        let joint = &job.arm.joints()[k];
        let wanted = last.map_or((joint.min + joint.max) / 2.0, |last| last[k]);
        *shift = TAU * ((wanted - start) / TAU).round().clamp(least, most);
    }
    let within = |(joints, _): &(Joints, f64)| {
        job.arm.allows(&std::array::from_fn(|k| joints[k] + shift[k]))
    };
    passed.iter().all(within).then_some(shift)
}

/// The fewest and the most whole turns that bring a joint that goes from `low` to `high` within its limits.
pub(crate) fn fitting(job: &Job, joint: usize, low: f64, high: f64) -> Option<(f64, f64)> {
    let limits = &job.arm.joints()[joint];
    // Half a microradian for what single precision has rounded.
    let (min, max) =
        (limits.min + job.settings.limit - 5e-7, limits.max - job.settings.limit + 5e-7);
    let (least, most) = (((min - low) / TAU).ceil(), ((max - high) / TAU).floor());
    (least <= most).then_some((least, most))
}

/// A position of a joint within its limits, by whole turns from `position`, that is nearest to `wanted`.
pub(crate) fn turned(arm: &Arm, joint: usize, position: f64, wanted: f64) -> f64 {
    let limits = &arm.joints()[joint];
    let (least, most) =
        (((limits.min - position) / TAU).ceil(), ((limits.max - position) / TAU).floor());
    match least <= most {
        true => position + TAU * ((wanted - position) / TAU).round().clamp(least, most),
        false => position,
    }
}

/// Keeps what is less than before.
fn note(arm: &Arm, joints: &Joints, point: usize, worst: &mut Worst) {
    let less = |kept: &mut (f64, usize), now: f64| {
        if now < kept.0 {
            *kept = (now, point);
        }
    };
    let margins = arm.margins(joints);
    less(&mut worst.wrist, margins.wrist);
    less(&mut worst.shoulder, margins.shoulder);
    less(&mut worst.elbow, margins.elbow);
    for (joint, q) in arm.joints().iter().zip(joints) {
        less(&mut worst.limit, (q - joint.min).min(joint.max - q));
    }
}

/// What keeps the arm from a sample, in the turn and the posture of these that come nearest: limits first, then singularities, then reach.
pub(crate) fn nearest(job: &Job, sample: &Sample, steps: usize, of: &[Posture]) -> Why {
    let mut found: Option<Why> = None;
    for step in 0..steps {
        let flange = job.frame(sample, step as f64 * job.step_angle());
        for (posture, joints) in job.arm.inverse(&flange, 0.0).iter() {
            if of.contains(&posture)
                && let Err(why) = cost_at(job.arm, joints, job.settings)
                && found.is_none_or(|found| is_nearer(why, found))
            {
                found = Some(why);
            }
        }
    }
    found.unwrap_or_else(|| Why::Reach(out_of_reach(job, sample, steps)))
}

/// A singularity is nearer than a limit: the limit allows it. Of two of a kind the one with less to go.
fn is_nearer(a: Why, b: Why) -> bool {
    let rank = |why: Why| match why {
        Why::Speed(_, share, _) => (0, share),
        Why::Wrist(margin) | Why::Elbow(margin) | Why::Shoulder(margin) => (1, -margin),
        Why::Limit(_, by) => (2, by),
        Why::Range(_) | Why::Apart => (3, 0.0),
        Why::Reach(mm) => (4, mm),
        Why::Numbers => (5, 0.0),
    };
    let (a, b) = (rank(a), rank(b));
    a.0 < b.0 || (a.0 == b.0 && a.1 < b.1)
}

/// By how much a sample is too far from the shoulder, or (negative) too near, mm, in the turn for which that is least.
fn out_of_reach(job: &Job, sample: &Sample, steps: usize) -> f64 {
    let height = match job.arm.structure() {
        Structure::Spherical(arm) => arm.c1,
        Structure::Ur(dh, _) => dh.d1,
    };
    let shoulder = Vec3::new(0.0, 0.0, height - job.arm.world_height());
    let off = |step: usize| {
        let frame = job.frame(sample, step as f64 * job.step_angle());
        let outward = (frame.translation - shoulder).normalize_or(Vec3::X);
        let reaches = |by: f64| {
            let mut frame = frame;
            frame.translation -= outward * by;
            job.arm.inverse(&frame, 0.0).iter().next().is_some()
        };
        // The middle of the reach, from which the edge is found by halving.
        let mut inside = frame.translation.distance(shoulder) - job.arm.reach() * 0.6;
        if !reaches(inside) {
            return inside;
        }
        let mut outside = 0.0;
        while (inside - outside).abs() > 0.01 {
            let middle = f64::midpoint(inside, outside);
            if reaches(middle) { inside = middle } else { outside = middle }
        }
        inside
    };
    (0..steps).map(off).min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or_default()
}

/// What ends every choice of these postures in an interval, and at which of its samples: the first one that is not reached at all, or
/// the least speed that is too much.
pub(crate) fn stopped(
    job: &Job,
    interval: RangeInclusive<usize>,
    steps: usize,
    of: &[Posture],
) -> (usize, Why) {
    for at in interval.start() + 1..=*interval.end() {
        let [before, sample] = [&job.samples[at - 1], &job.samples[at]];
        let (mut speed, mut reached): (Option<Why>, bool) = (None, false);
        for step in 0..steps {
            let turn = step as f64 * job.step_angle();
            for &posture in of {
                let Some(to) = solve(job, sample, turn, posture) else { continue };
                reached = true;
                let Some(from) = solve(job, before, turn, posture) else { continue };
                let used =
                    (0..6).map(|k| (k + 1, share(job.arm, k, wrap(to[k] - from[k]), sample.time)));
                let (joint, used) =
                    used.fold((0, 0.0), |most, now| if now.1 > most.1 { now } else { most });
                let now = Why::Speed(joint, used, job.settings.speed);
                if speed.is_none_or(|least| is_nearer(now, least)) {
                    speed = Some(now);
                }
            }
        }
        match speed {
            _ if !reached => return (at, nearest(job, sample, steps, of)),
            Some(Why::Speed(_, used, most)) if used <= most => {}
            Some(why) => return (at, why),
            None => return (at, Why::Apart),
        }
    }
    (*interval.end(), Why::Apart)
}
