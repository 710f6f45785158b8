//! The one cursor: from a time, a move, a block or a line of the source to everything that holds there.

use crate::ask::{FeedAbout, SpindleAbout};
use crate::walk::{ARC, By, KINDS, Walk};
use geom::Vec3;
use machine::Machine;
use program::{Compensation, Coolant, CycleKind, Feed};
use proof::{Course, MachineState, SpindleState};

/// A place within a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    /// The move.
    pub r#move: u32,
    /// How much of it is done, 0 to 1.
    pub part: f64,
    /// Seconds from the start.
    pub seconds: f64,
}

/// The place at a time, s; that of the start or the end where there is nothing before or behind.
pub fn at_time(walk: &Walk, seconds: f64) -> Option<At> {
    let seconds = if seconds.is_finite() { seconds.clamp(0.0, walk.seconds()) } else { 0.0 };
    let at = walk.at_time(seconds)?;
    let begin = walk.end_before(at) + walk.waited(at);
    let takes = walk.end(at) - begin;
    let part = if takes > 0.0 { ((seconds - begin) / takes).clamp(0.0, 1.0) } else { 1.0 };
    Some(At { r#move: at, part, seconds })
}

/// The end of a move; that of the last one where there are fewer.
pub fn at_move(walk: &Walk, number: u32) -> Option<At> {
    let at = number.min(walk.len().checked_sub(1)?);
    Some(At { r#move: at, part: 1.0, seconds: walk.end(at) })
}

/// The end of the first move that a line makes; where it makes none, of the first one of the next line that makes some.
pub fn at_line(walk: &Walk, by: By, line: u32) -> Option<At> {
    let next = match walk.moves_of(by, line, 1).first() {
        Some([first, _]) => Some(*first),
        None => walk.next_line(by, line),
    };
    at_move(walk, next?)
}

/// The tool and the axes at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Stand {
    /// The tip, work frame, mm; NaN where it is not known.
    pub tip: Vec3,
    /// The tool axis.
    pub axis: Vec3,
    /// The axes.
    pub positions: Vec<f64>,
}

/// Where tool and axes are at a place. Between the ends of a move they are where the control has them ([`Course`]): either the axes lead the
/// tip, or the tip is on its line or arc, the rotary axes turn evenly, and the linear axes, or the joints of an arm, are where the machine's
/// kinematics have them.
pub fn stand(walk: &Walk, machine: &Machine, at: At) -> Stand {
    let (before, behind) = (walk.before(at.r#move), walk.behind(at.r#move));
    let end = walk.positions(at.r#move);
    if at.part >= 1.0 {
        return Stand { tip: behind.tip, axis: behind.axis, positions: end.to_vec() };
    }
    let part = at.part;
    if let Some(motion) = walk.led(at.r#move).filter(|_| before.tip.is_finite()) {
        let (tip, axis) = motion.tool()(part);
        return Stand { tip, axis, positions: motion.axes(part) };
    }
    let tip = match walk.arc(at.r#move) {
        Some(arc) => arc.at(part),
        None => before.tip.lerp(behind.tip, part),
    };
    if let Some((positions, axis)) = walk.keeping_tip(at.r#move, tip, part) {
        return Stand { tip, axis, positions };
    }
    let start = at.r#move.checked_sub(1).map(|last| walk.positions(last));
    let between = |(place, end): (usize, &f64)| {
        let start = start.as_ref().and_then(|start| start.get(place).copied()).unwrap_or(f64::NAN);
        start + (end - start) * part
    };
    let mut positions: Vec<f64> = end.iter().enumerate().map(between).collect();
    let mut axis = geom::between(before.axis, behind.axis, part);
    let is_mill = machine.wire.is_none() && machine.arm.is_none();
    // On the way to and from home no tip is known, and the axes go evenly.
    if is_mill && tip.is_finite() && behind.tip.is_finite() {
        let degrees = |positions: &[f64]| {
            let mut degrees = [0.0; 3];
            for (axis, position) in machine.rotary.iter().zip(positions.iter().skip(3)) {
                degrees[axis.index()] = *position;
            }
            degrees
        };
        let length = walk.tool_length(at.r#move).unwrap_or(0.0);
        let linear = |tip, positions: &[f64]| machine.linear_for(tip, degrees(positions), length);
        // What positions count from is the same at the end of the move.
        let moved = linear(tip, &positions) - linear(behind.tip, &end);
        for ((position, moved), end) in positions.iter_mut().zip(moved.to_array()).zip(&*end) {
            *position = end + moved;
        }
        let turned = machine.axis_at(degrees(&positions));
        if walk.course(at.r#move) == Course::Tip && turned.is_finite() {
            axis = turned;
        }
    } else if walk.kind(at.r#move) == ARC && machine.wire.is_some() {
        let moved = (tip - behind.tip).to_array();
        for ((position, moved), end) in positions.iter_mut().zip(moved).zip(&*end) {
            *position = end + moved;
        }
    }
    Stand { tip, axis, positions }
}

/// What a move is called.
pub fn kind(walk: &Walk, at: At) -> &'static str {
    KINDS[usize::from(walk.kind(at.r#move))]
}

/// A feed in its unit.
pub fn feed(feed: Feed) -> FeedAbout {
    let unit = match feed {
        Feed::PerMinute(_) => "mm/min",
        Feed::PerTurn(_) => "mm/turn",
        Feed::InverseTime(_) => "1/min",
    };
    FeedAbout { value: feed.value(), unit }
}

/// A spindle.
pub fn spindle(state: &MachineState) -> SpindleAbout {
    let (turns, speed) = match state.spindle {
        SpindleState::Off => ("off", Some(0.0)),
        SpindleState::Clockwise(speed) => ("clockwise", Some(speed)),
        SpindleState::CounterClockwise(speed) => ("counter-clockwise", Some(speed)),
        SpindleState::On(speed) => ("on", speed),
    };
    SpindleAbout { turns, speed }
}

/// Coolant in words.
pub fn coolant(coolant: Coolant) -> &'static str {
    match coolant {
        Coolant::Off => "off",
        Coolant::Flood => "flood",
        Coolant::Mist => "mist",
        Coolant::FloodAndMist => "flood and mist",
        Coolant::Through => "through",
    }
}

/// Compensation in words.
pub fn compensation(compensation: Compensation) -> &'static str {
    match compensation {
        Compensation::Off => "off",
        Compensation::Left(_) => "left",
        Compensation::Right(_) => "right",
    }
}

/// A cycle in words.
pub fn cycle(kind: CycleKind) -> &'static str {
    match kind {
        CycleKind::Drill => "drill",
        CycleKind::Deep => "deep",
        CycleKind::BreakChip => "break chip",
        CycleKind::Tap { .. } => "tap",
        CycleKind::Ream => "ream",
        CycleKind::Bore => "bore",
        CycleKind::FineBore(_) => "fine bore",
        CycleKind::BackBore { .. } => "back bore",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::walk_of;
    use proof::{AxisPositions, Course, MotionKind, ToolPose};

    /// B of a head, 200 mm above the gauge point, and a tool of 100 mm: the tip is 300 mm from the axis. The tip stays where it is while B turns from 0
    /// to 60 degrees, so that at 30 the axis is 300 mm from it at 30 degrees: X 150, and Z 259.81 - 200 = 59.81 with the gauge point at Z 100 at B 0.
    /// No block says how long the tool is.
    #[test]
    fn a_head_keeps_the_tip_with_the_arm_of_head_and_tool() {
        let text = "reader = \"fanuc\"\nwork_zero = [0, 0, 0]\n[orientation]\nsimultaneous = \"tool-center-angles\"\ntolerance = 0.01\n\
                    [words]\nX = { decimals = 3 }\nB = { decimals = 3 }\n\
                    [[rotary]]\nletter = \"B\"\non = \"head\"\naxis = [0, 1, 0]\npoint = [0, 0, 200]\nrapid = 1e4\nacceleration = 100\n";
        let machine = machine::load_text("head.toml", text).unwrap();
        let (s, c) = 60_f64.to_radians().sin_cos();
        let stands = [
            (Vec3::new(0.0, 0.0, 100.0), 0.0, Vec3::Z),
            (Vec3::new(300.0 * s, 0.0, 300.0 * c - 200.0), 60.0, Vec3::new(s, 0.0, c)),
        ];
        let moves = stands.map(|(linear, b, axis)| {
            let axes = AxisPositions::Mill { linear, rotary: [0.0, b, 0.0] };
            (MotionKind::Line, Course::Tip, axes, ToolPose { tip: Vec3::ZERO, axis })
        });
        let walk = walk_of(&machine, moves);
        let found = stand(&walk, &machine, At { r#move: 1, part: 0.5, seconds: 1.5 });
        let (s, c) = 30_f64.to_radians().sin_cos();
        let wanted = [300.0 * s, 0.0, 300.0 * c - 200.0, 30.0];
        let off = found.positions.iter().zip(wanted).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9, "{found:?}, not {wanted:?}");
        assert!(found.tip.length() < 1e-9 && found.axis.distance(Vec3::new(s, 0.0, c)) < 1e-9);
    }
}
