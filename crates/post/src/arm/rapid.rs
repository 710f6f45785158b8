//! How a rapid of an arm goes: by its joints where the tool is then as high as the source ever goes, along itself and along Z, and beyond all cuts, else straight.

use super::plan::Position;
use ::arm::{Arm, Joints, Posture};
use geom::ending::go_on;
use geom::{Frame, Mat3, Quat, Vec3, angle_between, nearest_on_segment, wrap};
use machine::{Capabilities, Cell, Machine};
use program::{CutBox, LYING, Program, Tops};
use std::cell::OnceCell;

/// Joints are looked at so near to each other that the tip moves by no more than this, mm.
const STRIDE: f64 = 0.5;

/// Points of a straight path are at most so far apart, mm, and the tool turns by at most so much between them, radians.
const SPACING: f64 = 2.0;
const TURN: f64 = 0.02;

/// A joint that turns by more than this between two of them leaps, radians.
const LEAP: f64 = 0.2;

/// The part of a joint's speed that a straight rapid uses at the most.
const SPEED: f64 = 0.8;

/// What is needed to find the path of a rapid.
pub(super) struct RapidPlanner<'a> {
    pub(super) arm: &'a Arm,
    pub(super) cell: &'a Cell,
    can: &'a Capabilities,
    /// How fast the tool turns where it turns on the spot, its axis and about it together, degrees/s; `None` where it cannot be said.
    turn_rate: Option<f64>,
    source: &'a Program,
    cuts: CutBox,
    /// How high the source goes, once that is asked for.
    tops: OnceCell<Tops<'a>>,
}

/// How a rapid goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RapidPath {
    /// By the joints.
    Joints,
    /// Straight, at so many mm/min.
    Straight(f64),
}

/// A part of a rapid.
#[derive(Clone, Copy, Debug)]
pub(super) struct RapidSegment {
    pub(super) path: RapidPath,
    pub(super) end: Position,
}

/// Straight from a position to where joints may lead the tool on: the end of each piece, and the feed of it. None where joints may do so at once.
struct WayOut(Vec<(Position, f64)>);

impl WayOut {
    /// Where it ends, which begins there.
    fn end(&self, from: &Position) -> Position {
        self.0.last().map_or(*from, |(end, _)| *end)
    }

    fn there(&self) -> impl Iterator<Item = RapidSegment> {
        self.0.iter().map(|(end, feed)| straight(*end, *feed))
    }

    /// The same from its end back to where it begins.
    fn back(&self, from: &Position) -> impl Iterator<Item = RapidSegment> {
        let ends = [*from].into_iter().chain(self.0.iter().map(|(end, _)| *end));
        let back: Vec<_> = ends.zip(&self.0).map(|(end, (_, feed))| straight(end, *feed)).collect();
        back.into_iter().rev()
    }
}

/// Straight to there at so many mm/min.
fn straight(end: Position, feed: f64) -> RapidSegment {
    RapidSegment { path: RapidPath::Straight(feed), end }
}

/// How far the tool is retracted beyond what it has to be, mm: the first that gives a path is taken.
pub(super) const RETRACTS: [f64; 6] = [0.0, 2.0, 10.0, 30.0, 80.0, 200.0];

/// Wrist and elbow are at least so far from stretched or folded along a straight line, radians, and the wrist so far from axis 1, mm:
/// nearer to that controllers slow down or stop.
const NEAREST: f64 = 0.02;
const NEAREST_AXIS: f64 = 6.0;

impl<'a> RapidPlanner<'a> {
    /// For the rapids of `program`.
    pub(super) fn new(
        program: &'a Program,
        machine: &'a Machine,
        (arm, cell): (&'a Arm, &'a Cell),
    ) -> RapidPlanner<'a> {
        RapidPlanner {
            arm,
            cell,
            can: &machine.capabilities,
            turn_rate: machine.turn_speed().map(|speed| 2.0 * speed),
            source: program,
            cuts: CutBox::of(program),
            tops: OnceCell::new(),
        }
    }

    /// The position at home, with this tool.
    pub(super) fn home(&self, tool: &Frame) -> Position {
        self.at_joints(tool, (&self.home_joints(), self.cell.rail_home()))
    }

    /// The joints at home.
    pub(super) fn home_joints(&self) -> Joints {
        self.arm.model(&self.cell.home.map(f64::to_radians)).unwrap_or_default()
    }

    /// The position of these joints, and of the rail.
    pub(super) fn at_joints(&self, tool: &Frame, (joints, rail): (&Joints, f64)) -> Position {
        let at = self.cell.part_from(rail).inverse() * self.arm.flange(joints) * *tool;
        Position { tool: at, joints: *joints, rail }
    }

    /// Whether joints are those at home.
    pub(super) fn is_home(&self, at: &Position) -> bool {
        at.joints == self.home_joints() && at.rail == self.cell.rail_home()
    }

    /// How the arm goes from one position to another, where it can: by its joints, or straight, or straight out, by its joints, and
    /// straight in. From home and to home no line of the source leads.
    pub(super) fn route(
        &self,
        tool: &Frame,
        [from, to]: [&Position; 2],
    ) -> Option<Vec<RapidSegment>> {
        let is_own = !self.is_home(from) && !self.is_home(to);
        let line = is_own.then_some([from, to].map(|end| end.tool.translation));
        if self.is_clear(tool, [from, to], line) {
            return Some(vec![RapidSegment { path: RapidPath::Joints, end: *to }]);
        }
        if is_own && let Some(feed) = self.straight(tool, from, to) {
            return Some(vec![RapidSegment { path: RapidPath::Straight(feed), end: *to }]);
        }
        RETRACTS.into_iter().find_map(|height| {
            let [outs, ins] = [from, to].map(|at| self.ways_out(tool, at, height));
            let ways = outs.iter().flat_map(|out| ins.iter().map(move |way_in| (out, way_in)));
            let is_clear = |(out, way_in): &(&WayOut, &WayOut)| {
                self.is_clear(tool, [&out.end(from), &way_in.end(to)], None)
            };
            let (out, way_in) = ways.into_iter().find(is_clear)?;
            let across = RapidSegment { path: RapidPath::Joints, end: way_in.end(to) };
            Some(out.there().chain([across]).chain(way_in.back(to)).collect())
        })
    }

    /// Straight up out of a cut, by the joints above all cuts, and straight down to the same place with other joints, near the cut at
    /// `feed`; and how far up, mm. The joints go by way of home where they cannot go at once.
    pub(super) fn reentry(
        &self,
        tool: &Frame,
        [from, to, home]: [&Position; 3],
        feed: f64,
    ) -> Option<(Vec<RapidSegment>, f64)> {
        let near = |at: &Position| self.raised(tool, at, self.can.rapid_clearance);
        let (out, slow_out) = near(from)?;
        let (over, slow_in) = near(to)?;
        let joints = |end: Position| RapidSegment { path: RapidPath::Joints, end };
        RETRACTS.into_iter().find_map(|height| {
            let [up, down] = [&out, &over].map(|at| self.along_tool(tool, at, height));
            let (up, down) = (up?, down?);
            let (start, end) = (up.end(&out), down.end(&over));
            let is_clear = |from: &Position, to: &Position| self.is_clear(tool, [from, to], None);
            // Where the joints go from one posture into the other in one motion the tool may tilt too far.
            let through = match is_clear(&start, &end) {
                true => None,
                false if is_clear(&start, home) && is_clear(home, &end) => Some(*home),
                false => return None,
            };
            let mut route = vec![straight(out, feed.min(slow_out))];
            route.extend(up.there());
            route.extend(through.into_iter().chain([end]).map(joints));
            route.extend(down.back(&over));
            route.push(straight(*to, feed.min(slow_in)));
            Some((route, start.tool.translation.distance(from.tool.translation)))
        })
    }

    /// How high the source goes.
    pub(super) fn tops(&self) -> &Tops<'_> {
        self.tops.get_or_init(|| Tops::of(self.source))
    }

    /// How far the tool is below where joints may lead it from or to, mm along its axis and along Z: as high as the source ever goes, beyond all cuts by
    /// the clearance, and higher by what joints may be off.
    pub(super) fn below(&self, at: &Position) -> [f64; 2] {
        let axis = -at.tool.matrix3.z_axis;
        let tip = at.tool.translation;
        let own = self.floor(axis) - tip.dot(axis);
        // Along the tool, as far as the way in asks for.
        let along_ways_in = |short: f64, cosine: f64| (short + self.arm.unmeasured()) / cosine;
        let along_tool = self.tops().along_ways_in((tip, axis), own, along_ways_in);
        [along_tool, self.floor_along_z() - tip.z]
    }

    fn floor_along_z(&self) -> f64 {
        self.tops().upward() + self.arm.unmeasured()
    }

    fn floor(&self, axis: Vec3) -> f64 {
        let beyond = self.cuts.reach(axis) + self.can.rapid_clearance;
        beyond.max(self.tops().along(axis)) + self.arm.unmeasured()
    }

    /// Whether the tool is beyond all cuts along its axis by the clearance.
    pub(super) fn is_beyond_cuts(&self, tool: &Frame) -> bool {
        let axis = -tool.matrix3.z_axis;
        let clearance = self.can.rapid_clearance + self.arm.unmeasured();
        let beyond = tool.translation.dot(axis) - self.cuts.reach(axis);
        beyond >= clearance - self.can.rapid_corridor / 2.0
    }

    /// The ways straight out to so far above where joints may lead the tool, the best first: along its shaft; and, of a tool that lies, along Z behind that.
    fn ways_out(&self, tool: &Frame, at: &Position, above: f64) -> Vec<WayOut> {
        let along = self.along_tool(tool, at, above);
        let lies = -at.tool.matrix3.z_axis.z < LYING;
        let then_up = lies.then(|| self.along_tool_and_z(tool, at, above)).flatten();
        along.into_iter().chain(then_up).collect()
    }

    /// Straight up along the tool until it is so far above where joints may lead it. Home is where it is.
    fn along_tool(&self, tool: &Frame, at: &Position, above: f64) -> Option<WayOut> {
        let Some([along, up]) = self.lacks(at, above) else { return Some(WayOut(Vec::new())) };
        let rise = -at.tool.matrix3.z_axis.z;
        let length = if up <= 0.0 { along } else { along.max(up / rise.max(0.0)) };
        let reaches = length <= 2.0 * self.arm.reach();
        reaches.then(|| self.raised(tool, at, length)).flatten().map(|end| WayOut(vec![end]))
    }

    /// Straight up along the tool until it is so far above where joints may lead it, and then along Z to so far above all of the source. A tool that points down goes so far out that it
    /// is high enough along itself all the way up.
    fn along_tool_and_z(&self, tool: &Frame, at: &Position, above: f64) -> Option<WayOut> {
        let [along, _] = self.lacks(at, above)?;
        let top = self.tops().along(Vec3::Z) + self.arm.unmeasured() + above;
        let up = top - at.tool.translation.z;
        let rise = -at.tool.matrix3.z_axis.z;
        let out = match rise >= 0.0 {
            true => along,
            false => (along - up.max(0.0) * rise) / (1.0 - rise * rise),
        };
        let slack = self.can.rapid_corridor / 2.0;
        let mut pieces = Vec::new();
        let mut here = *at;
        if out > slack {
            let piece = self.raised(tool, at, out)?;
            here = piece.0;
            pieces.push(piece);
        }
        let up = up - (here.tool.translation.z - at.tool.translation.z);
        if up <= slack {
            return None;
        }
        pieces.push(self.moved(tool, &here, Vec3::Z * up)?);
        Some(WayOut(pieces))
    }

    /// How far the tool is below a place so far above where joints may lead it, mm along its axis and along Z; `None` where they may lead it from here, or
    /// it is home.
    fn lacks(&self, at: &Position, above: f64) -> Option<[f64; 2]> {
        let slack = self.can.rapid_corridor / 2.0;
        let lacks = self.below(at).map(|below| below + above);
        (lacks.iter().any(|lack| *lack > slack) && !self.is_home(at)).then_some(lacks)
    }

    /// The position so many mm up along the tool, and the feed to go between it and `at`.
    fn raised(&self, tool: &Frame, at: &Position, height: f64) -> Option<(Position, f64)> {
        self.moved(tool, at, -at.tool.matrix3.z_axis * height)
    }

    /// The position so far from another one, the tool as there, and the feed to go straight between them.
    fn moved(&self, tool: &Frame, at: &Position, way: Vec3) -> Option<(Position, f64)> {
        let tip = at.tool.translation + way;
        let raised = Frame::from_mat3_translation(at.tool.matrix3, tip);
        let flange = self.cell.part_from(at.rail) * raised * tool.inverse();
        let posture = self.arm.posture(&at.joints);
        let joints = self.arm.inverse_in(posture, &flange, at.joints[3])?;
        let joints = std::array::from_fn(|i| at.joints[i] + wrap(joints[i] - at.joints[i]));
        let raised = Position { tool: raised, joints, ..*at };
        self.straight(tool, at, &raised).map(|feed| (raised, feed))
    }

    /// Whether the tool is free of the part while the joints go, or near the line: beyond all cuts along its own axis, and as high as the source ever goes,
    /// along the tool as it leans at the nearer end, along the ways in to which it leans near there, and along Z.
    fn is_clear(&self, tool: &Frame, [from, to]: [&Position; 2], line: Option<[Vec3; 2]>) -> bool {
        let turns: f64 = from.joints.iter().zip(to.joints).map(|(a, b)| (b - a).abs()).sum();
        let lever = 1.5 * self.arm.reach() + tool.translation.length();
        let unmeasured = self.arm.unmeasured();
        let slack = self.can.rapid_corridor / 2.0;
        let ends = [from, to].map(|end| -end.tool.matrix3.z_axis);
        let floors = ends.map(|axis| self.floor(axis));
        let lowest = self.floor_along_z() - slack;
        let along = (to.rail - from.rail).abs();
        let count = ((turns * lever + along) / STRIDE).ceil().clamp(1.0, 1e6);
        (0..=count as usize).all(|step| {
            let part = step as f64 / count;
            let joints =
                std::array::from_fn(|i| from.joints[i] + part * (to.joints[i] - from.joints[i]));
            let world = self.cell.part_from(from.rail + part * (to.rail - from.rail)).inverse();
            let at = world * self.arm.flange(&joints) * *tool;
            let near = line
                .filter(|_| unmeasured == 0.0)
                .is_some_and(|[from, to]| nearest_on_segment(from, to, at.translation).1 <= slack);
            if near {
                return true;
            }
            let leans = ends.map(|axis| angle_between(axis, -at.matrix3.z_axis));
            let end = usize::from(leans[1] < leans[0]);
            let tip = at.translation;
            let lacks = |short: f64, _: f64| short + unmeasured;
            self.is_beyond_cuts(&at)
                && tip.z >= lowest
                && tip.dot(ends[end]) >= floors[end] - slack
                && self.tops().along_ways_in((tip, ends[end]), slack, lacks) <= slack
        })
    }

    /// The feed at which the arm goes straight, mm/min, in one posture and to these very joints.
    fn straight(&self, tool: &Frame, from: &Position, to: &Position) -> Option<f64> {
        let posture = self.arm.posture(&from.joints);
        if self.arm.posture(&to.joints) != posture || from.rail != to.rail {
            return None;
        }
        let world = self.cell.part_from(from.rail);
        let length = from.tool.translation.distance(to.tool.translation);
        let [a, b] = [&from.tool.matrix3, &to.tool.matrix3].map(Quat::from_mat3);
        let turn = a.angle_between(b);
        let count = (length / SPACING).max(turn / TURN).ceil().clamp(1.0, 1e5);
        let off = tool.inverse();
        let (mut joints, mut slowest) = (from.joints, 0.0_f64);
        for step in 1..=count as usize {
            go_on();
            let part = step as f64 / count;
            let turned = Mat3::from_quat(a.slerp(b, part));
            let tip = from.tool.translation.lerp(to.tool.translation, part);
            let flange = world * Frame::from_mat3_translation(turned, tip) * off;
            let next = self.next(&flange, posture, &joints)?;
            for (i, joint) in self.arm.joints().iter().enumerate() {
                slowest = slowest.max((next[i] - joints[i]).abs() / (SPEED * joint.speed));
            }
            joints = next;
        }
        let arrived = joints.iter().zip(&to.joints).all(|(a, b)| (a - b).abs() < 1e-6);
        if !arrived {
            return None;
        }
        let time = slowest * count;
        let rapid = self.cell.rapid;
        match length > 1e-6 {
            true if time > 0.0 => Some(rapid.min(60.0 * length / time)),
            true => Some(rapid),
            false => {
                self.turn_rate.is_some_and(|rate| time <= turn.to_degrees() / rate).then_some(rapid)
            }
        }
    }

    /// The joints that put the flange there, near where they stand.
    fn next(&self, flange: &Frame, posture: Posture, before: &Joints) -> Option<Joints> {
        let found = self.arm.inverse_in(posture, flange, before[3])?;
        let joints: Joints = std::array::from_fn(|i| before[i] + wrap(found[i] - before[i]));
        let leaps = joints.iter().zip(before).any(|(a, b)| (a - b).abs() > LEAP);
        let margins = self.arm.margins(&joints);
        let is_near = margins.wrist.min(margins.elbow) < NEAREST || margins.shoulder < NEAREST_AXIS;
        (!leaps && !is_near && self.arm.allows(&joints)).then_some(joints)
    }
}
