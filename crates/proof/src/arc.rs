//! An arc of the source against the arcs, or the lowered lines, of the program.

use crate::expected::ExpectedMotion;
use crate::gauge::Gauge;
use crate::line::{Followed, turn, within};
use crate::resolved_pose::{PartialPose, ResolvedPose};
use control::{ArcTo, Position};
use geom::{Arc, Vec3};
use std::f64::consts::{PI, TAU};

/// How far rounding moves a point of an arc, in tip tolerances: an end by 0.82 of one (√½ steps in the
/// plane), and the centre by as much, which moves the far side of a full circle by twice that while its
/// ends stay.
const ROUNDINGS: f64 = 3.0;

/// How far an arc may turn past its end by rounding: so many tip tolerances.
pub(crate) const PAST: f64 = 4.0;

/// The arc that a block of the program makes, in the work frame, or `None` where it makes none.
pub(crate) fn of_block(gauge: &Gauge, here: &ResolvedPose, to: &ArcTo) -> Option<Arc> {
    let tip = |point: Vec3| {
        PartialPose::of(gauge.machine, &Position { point, ..to.end }, gauge.tool_length).tip
    };
    let center = tip(to.center);
    let normal = tip(to.center + to.normal) - center;
    let start = here.place.tip;
    let radius = start.distance(center);
    Arc::new(start, tip(to.end.point), center, normal, to.turns, radius).ok()
}

/// Follows an arc of the program on the source arc `arc`, of which `t` is done.
///
/// # Errors
/// How it leaves the arc: another plane or direction, another way round, another centre.
pub(crate) fn follow(
    gauge: &Gauge,
    arc: &Arc,
    goal: &ExpectedMotion,
    t: f64,
    block: &Arc,
    here: &ResolvedPose,
    to: &ResolvedPose,
) -> Result<Followed, String> {
    let slack = gauge.slack(to);
    let aligned = arc.normal.dot(block.normal);
    if aligned.is_nan() || aligned <= 0.0 {
        return Err("turns the other way round, or in another plane".into());
    }
    let reached = parameter(arc, to.place.tip, t + block.sweep / arc.sweep);
    let left_mm = left(arc, reached);
    within("turns past the end of the arc", -left_mm, PAST * slack, "mm")?;
    let allowed = ROUNDINGS * slack;
    let steepness = steepness(arc);
    let mut followed = Followed { t: reached, path_mm: 0.0, axis_degrees: 0.0, left_mm };
    // Four chords of a half circle do not hide a wrong centre; longer arcs get more samples.
    let samples = 4 * (block.sweep / PI).ceil().clamp(1.0, 100.0) as u32;
    for i in 1..=samples {
        let part = f64::from(i) / f64::from(samples);
        let (aside, along) = off(arc, steepness, t + part * (reached - t), block.at(part));
        within("leaves the arc", aside, allowed, "mm")?;
        within("is elsewhere on the arc", along, allowed, "mm")?;
        followed.path_mm = followed.path_mm.max(aside);
    }
    followed.axis_degrees = axis(gauge, goal, here, to)?;
    Ok(followed)
}

/// Follows a straight move of the program as a chord of the source arc `arc`, of which `t` is done.
///
/// # Errors
/// How it leaves the arc.
pub(crate) fn follow_chord(
    gauge: &Gauge,
    arc: &Arc,
    goal: &ExpectedMotion,
    t: f64,
    here: &ResolvedPose,
    to: &ResolvedPose,
) -> Result<Followed, String> {
    let spoke = |p: Vec3| (p - arc.center).reject_from_normalized(arc.normal);
    let (a, b) = (spoke(here.place.tip), spoke(to.place.tip));
    let turned = arc.normal.dot(a.cross(b)).atan2(a.dot(b));
    let slack = gauge.slack(to);
    within("goes back on the arc", -turned * arc.radius(), slack, "mm")?;
    let reached = t + turned / arc.sweep;
    let left_mm = left(arc, reached);
    within("turns past the end of the arc", -left_mm, PAST * slack, "mm")?;
    let steepness = steepness(arc);
    let (end, along) = off(arc, steepness, reached, to.place.tip);
    within("leaves the arc", end, ROUNDINGS * slack, "mm")?;
    within("is elsewhere on the arc", along, ROUNDINGS * slack, "mm")?;
    let middle = (here.place.tip + to.place.tip) / 2.0;
    let (middle, _) = off(arc, steepness, (t + reached) / 2.0, middle);
    within("cuts the arc off", middle, ROUNDINGS * slack + gauge.allowed.chord_mm, "mm")?;
    let axis_degrees = axis(gauge, goal, here, to)?;
    Ok(Followed { t: reached, path_mm: end.max(middle), axis_degrees, left_mm })
}

/// The parameter at which the angle of `point` about the axis of `arc` is, in the turn of `near`.
fn parameter(arc: &Arc, point: Vec3, near: f64) -> f64 {
    let spoke = |p: Vec3| (p - arc.center).reject_from_normalized(arc.normal);
    let (a, b) = (spoke(arc.start), spoke(point));
    let angle = arc.normal.dot(a.cross(b)).atan2(a.dot(b));
    let turns = ((near * arc.sweep - angle) / TAU).round();
    (angle + turns * TAU) / arc.sweep
}

/// How far `point` is from `arc` at `t`, and along it, mm. Along a helix of this [`steepness`] counts as its
/// turn does: a small error of the angle is a long way there, but no other path.
fn off(arc: &Arc, steepness: f64, t: f64, point: Vec3) -> (f64, f64) {
    let on = arc_point(arc, t);
    let spoke = (on - arc.center).reject_from_normalized(arc.normal);
    let tangent = arc.normal.cross(spoke) * arc.sweep + arc.normal * arc.rise();
    let along = (point - on).dot(tangent) / tangent.length();
    let aside = (point - on - tangent.normalize() * along).length();
    (aside, along.abs() / steepness)
}

/// What is left of `arc` from `t` on, mm of its turn.
fn left(arc: &Arc, t: f64) -> f64 {
    (1.0 - t) * arc.length() / steepness(arc)
}

/// Length of a helix as a multiple of its turn.
fn steepness(arc: &Arc) -> f64 {
    arc.length() / (arc.radius() * arc.sweep)
}

/// The point of `arc` at `t`, which may lie a little behind its end: there it goes on as it came.
fn arc_point(arc: &Arc, t: f64) -> Vec3 {
    if t <= 1.0 {
        return arc.at(t);
    }
    let over = t - 1.0;
    arc.center
        + geom::rotate(arc.end - arc.center, arc.normal, arc.sweep * over)
        + arc.normal * (arc.rise() * over)
}

/// Holds the tool axis against the source, in which it stands still during an arc: how far it is off, degrees.
fn axis(
    gauge: &Gauge,
    goal: &ExpectedMotion,
    here: &ResolvedPose,
    to: &ResolvedPose,
) -> Result<f64, String> {
    if turn(&here.position, &to.position).is_some() {
        return Err("turns a rotary axis during an arc".into());
    }
    let off = goal.to.apart(&to.place).1;
    within("tilts the tool during an arc", off, gauge.allowed.axis_degrees, "°")?;
    Ok(off)
}
