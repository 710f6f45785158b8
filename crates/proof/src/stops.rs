//! The stops of a rapid on its way: axis by axis, and retracts along the tool axis.

use crate::gauge::Gauge;
use crate::resolved_pose::ResolvedPose;
use control::Orientation;
use geom::Vec3;

/// A coordinate of a block counts as repeated below this (mm or degrees): noise of a control's
/// arithmetic, far below any word.
const SAME: f64 = 1e-6;

/// How the stops between two places are explained.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Retract {
    /// How far the tool was lifted along its axis above where it left, mm.
    pub left_mm: f64,
    /// How far above where it arrives it stood before it came down along its axis, mm.
    pub came_mm: f64,
}

/// Explains the stops of a rapid from `start` to `end`: first, perhaps, away along the tool axis,
/// last, perhaps, down along it, and between these axis by axis, so that each coordinate is as before
/// or as after. Where `free`, rotary axes may stand anywhere while the machine is at home.
///
/// # Errors
/// The first stop that nothing explains.
pub(crate) fn explain<'s>(
    gauge: &Gauge,
    start: &ResolvedPose,
    stops: &'s [ResolvedPose],
    end: &ResolvedPose,
    free: bool,
) -> Result<Retract, &'s ResolvedPose> {
    let above = |base: &ResolvedPose, stop: &ResolvedPose| {
        lifted(gauge, base, stop).then(|| base.place.above(stop.place.tip).0)
    };
    let mut retract = Retract::default();
    let (mut left, mut came) = (start, end);
    let mut middle = stops;
    while let [first, rest @ ..] = middle {
        let Some(height) = above(start, first) else { break };
        retract.left_mm = retract.left_mm.max(height);
        (left, middle) = (first, rest);
    }
    while let [rest @ .., last] = middle {
        let Some(height) = above(end, last) else { break };
        retract.came_mm = retract.came_mm.max(height);
        (came, middle) = (last, rest);
    }
    match middle.iter().find(|stop| !corner(gauge, stop, left, came, free)) {
        Some(stop) => Err(stop),
        None => Ok(retract),
    }
}

/// Whether `stop` is above `base` along its tool axis, with the tool as it stands there. Both are rounded, and the axis is
/// known as well as its words say it, so the higher, the farther from the axis.
pub(crate) fn lifted(gauge: &Gauge, base: &ResolvedPose, stop: &ResolvedPose) -> bool {
    let (height, aside) = base.place.above(stop.place.tip);
    let slack = gauge.slack(stop);
    let axis_degrees = gauge.allowed.axis_degrees;
    let same_axis = base.place.apart(&stop.place).1 <= 2.0 * axis_degrees;
    let rounding = slack + gauge.slack(base) + height * axis_degrees.to_radians();
    height > slack && aside <= rounding && same_axis
}

/// Whether `s` is `a`, or `b`, or not known.
fn either(s: f64, a: f64, b: f64, slack: f64) -> bool {
    s.is_nan() || (s - a).abs() <= slack || (s - b).abs() <= slack
}

/// The same for each coordinate.
fn each(s: Vec3, a: Vec3, b: Vec3, slack: f64) -> bool {
    (0..3).all(|i| either(s[i], a[i], b[i], slack))
}

/// Whether each coordinate of `stop` is that of `start`, that of `end`, or not known.
fn corner(
    gauge: &Gauge,
    stop: &ResolvedPose,
    start: &ResolvedPose,
    end: &ResolvedPose,
    free: bool,
) -> bool {
    let rotary = |pose: &ResolvedPose| match pose.position.orientation {
        Orientation::Rotary { degrees, tool_center } => Some((degrees, tool_center)),
        Orientation::Axis(_) => None,
    };
    if let (Some((s, kind)), Some((a, before)), Some((b, after))) =
        (rotary(stop), rotary(start), rotary(end))
        && kind == before
        && kind == after
    {
        let turned = (0..3).all(|i| either(s[i], a[i], b[i], SAME));
        let parked = free && !stop.place.tip.is_finite();
        return each(stop.position.point, start.position.point, end.position.point, SAME)
            && (turned || parked);
    }
    // Blocks in different kinds of coordinates meet in the work frame.
    let slack = gauge.slack(stop);
    let (s, a, b) = (stop.place.tip, start.place.tip, end.place.tip);
    let axis = stop.place.axis;
    let same_axis =
        |other: Vec3| geom::angle_between(axis, other).to_degrees() <= gauge.allowed.axis_degrees;
    if !s.is_finite() {
        return partly_known(stop, start, end, gauge.slack(end));
    }
    let aligned = same_axis(start.place.axis) || same_axis(end.place.axis);
    aligned && (each(s, a, b, slack) || corner_of_tilted_box(s, a, b, axis, slack))
}

/// The same for a stop whose place is not known, in a kind of coordinates that not both ends have. What
/// its block says counts against the end that has the same; where neither has, only the height must be
/// unknown: then Z is home. Where the axes of the machine go meanwhile, `approach` looks at.
fn partly_known(stop: &ResolvedPose, start: &ResolvedPose, end: &ResolvedPose, slack: f64) -> bool {
    let s = stop.position;
    let alike = |other: &ResolvedPose| s.orientation == other.position.orientation;
    let said = |other: &ResolvedPose| if alike(other) { other.position.point } else { Vec3::NAN };
    match alike(start) || alike(end) {
        true => each(s.point, said(start), said(end), slack),
        false => s.point.z.is_nan(),
    }
}

/// Whether `s` is a corner of a box between `a` and `b` that stands along `axis`, turned about it in
/// any way: in the plane of work such a corner sees the two ends at a right angle.
fn corner_of_tilted_box(s: Vec3, a: Vec3, b: Vec3, axis: Vec3, slack: f64) -> bool {
    let (from, to) = (s - a, s - b);
    let height = from.dot(axis).abs().min(to.dot(axis).abs());
    let (u, v) = (from.reject_from_normalized(axis), to.reject_from_normalized(axis));
    let right = u.dot(v).abs() <= slack * (u.length() + v.length() + slack);
    height <= slack && right
}
