//! A straight move of the source against the feed moves of the program.

use crate::expected::ExpectedMotion;
use crate::gauge::Gauge;
use crate::resolved_pose::{Number, PartialPose, ResolvedPose};
use control::{Orientation, Position};
use geom::{Vec3, between, nearest_on_segment, off_great_circle};

/// How far a program has come on a source move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Followed {
    /// 0 at the start, 1 at the end.
    pub t: f64,
    /// Largest distance of the tip from the path, mm.
    pub path_mm: f64,
    /// Largest angle of the tool axis to where it should be, degrees.
    pub axis_degrees: f64,
    /// What is left of the path, mm; less than 0 behind its end.
    pub left_mm: f64,
}

/// Rotary axes turn at most this much between two samples of a move, degrees.
const SAMPLE: f64 = 3.0;

/// Follows a feed move of the program from `here` to `to` on the source line `goal`, of which `t` is
/// done.
///
/// # Errors
/// How the move leaves the line: sideways, backwards, or with the tool axis elsewhere.
pub(crate) fn follow(
    gauge: &Gauge,
    goal: &ExpectedMotion,
    t: f64,
    here: &ResolvedPose,
    to: &ResolvedPose,
) -> Result<Followed, String> {
    let from = goal.from.unwrap_or(goal.to);
    let length = from.tip.distance(goal.to.tip);
    let slack = gauge.slack(to);
    let (reached, aside) = nearest_on_segment(from.tip, goal.to.tip, to.place.tip);
    within("leaves the line", aside, slack, "mm")?;
    within("goes back on the line", (t - reached) * length, slack, "mm")?;
    let expected = |t: f64| match length > 2.0 * slack {
        true => Some(between(from.axis, goal.to.axis, t)),
        false => None,
    };
    let axis_degrees = axis(gauge, &from, &goal.to, || expected(reached), to.place.axis)?;
    let left_mm = (1.0 - reached) * length;
    let mut followed = Followed { t: reached, path_mm: aside, axis_degrees, left_mm };
    if let Some(turn) = turn(&here.position, &to.position) {
        let samples = (turn / SAMPLE).ceil().clamp(1.0, 360.0) as u32;
        for i in 1..=samples {
            let part = f64::from(i) / f64::from(samples + 1);
            let pose = blend(&here.position, &to.position, part);
            let place = PartialPose::of(gauge.machine, &pose, gauge.tool_length);
            if !matches!(pose.orientation, Orientation::Rotary { tool_center: true, .. }) {
                let (_, aside) = nearest_on_segment(from.tip, goal.to.tip, place.tip);
                let allowed = slack + gauge.allowed.linearisation_mm;
                within("swings off the line between its ends", aside, allowed, "mm")?;
                followed.path_mm = followed.path_mm.max(aside);
            }
            let expected = || expected(t + (reached - t) * part);
            let off = axis(gauge, &from, &goal.to, expected, place.axis)?;
            followed.axis_degrees = followed.axis_degrees.max(off);
        }
    } else if unlike(here, to) {
        return Err("turns the tool while the kind of coordinates changes".into());
    }
    Ok(followed)
}

/// Holds the tool axis on the way between the axes of `from` and `to` against where it should be, or
/// against the great circle where the tip stands still: how far it is off, degrees.
fn axis(
    gauge: &Gauge,
    from: &PartialPose,
    to: &PartialPose,
    expected: impl FnOnce() -> Option<Vec3>,
    axis: Vec3,
) -> Result<f64, String> {
    if from.axis == to.axis && axis == to.axis {
        return Ok(0.0);
    }
    let off = match expected() {
        Some(expected) => geom::angle_between(expected, axis).to_degrees(),
        None => off_great_circle(from.axis, to.axis, axis).to_degrees(),
    };
    let swept = from.apart(to).1 > gauge.allowed.axis_degrees;
    let sweep = if swept { gauge.allowed.sweep_degrees } else { 0.0 };
    within("turns the tool axis off its way", off, gauge.allowed.axis_degrees + sweep, "°")?;
    Ok(off)
}

/// The largest turn of a rotary axis between two poses, degrees, where one turns and both say so in
/// the same kind of coordinates.
pub(crate) fn turn(from: &Position, to: &Position) -> Option<f64> {
    match (from.orientation, to.orientation) {
        (
            Orientation::Rotary { degrees: a, tool_center: s },
            Orientation::Rotary { degrees: b, tool_center: t },
        ) if s == t && a != b => {
            Some(a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
        }
        _ => None,
    }
}

/// Whether the machine turns the tool in a move of its own axes that began in other coordinates: the
/// way of the tip is then not known.
fn unlike(here: &ResolvedPose, to: &ResolvedPose) -> bool {
    let same_kind = match (here.position.orientation, to.position.orientation) {
        (
            Orientation::Rotary { tool_center: s, .. },
            Orientation::Rotary { tool_center: t, .. },
        ) => s == t,
        _ => false,
    };
    matches!(to.position.orientation, Orientation::Rotary { tool_center: false, .. })
        && !same_kind
        && here.place.axis.distance_squared(to.place.axis) > 1e-18
}

/// The pose `t` (0 to 1) of the way between two poses of the same kind, as a control interpolates.
pub(crate) fn blend(from: &Position, to: &Position, t: f64) -> Position {
    let point = from.point.lerp(to.point, t);
    let orientation = match (from.orientation, to.orientation) {
        (
            Orientation::Rotary { degrees: a, .. },
            Orientation::Rotary { degrees: b, tool_center },
        ) => {
            let degrees = std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t);
            Orientation::Rotary { degrees, tool_center }
        }
        (_, orientation) => orientation,
    };
    Position { point, orientation }
}

/// Refuses a deviation that is larger than allowed, or not known.
pub(crate) fn within(what: &str, value: f64, allowed: f64, unit: &str) -> Result<(), String> {
    match value <= allowed {
        true => Ok(()),
        false if value.is_nan() => {
            Err(format!("whether it {what} is not known: no block says all of its coordinates"))
        }
        false => Err(format!("{what} by {} {unit} ({} allowed)", Number(value), Number(allowed))),
    }
}
