//! Where the tool goes while the axes of a machine go, each from where it stands to where it shall be: rapids and cuts in which rotary
//! axes turn and the control does not keep the tip, and motions of the joints of an arm.
//!
//! **Units and frames** are those of [`crate::linkage`], which is the chain that is used: positions in mm and degrees in the order of
//! [`Linkage::axes`], tip (mm) and tool axis in the work frame.
//!
//! How many chords the way of the tip is drawn with is a bound, not a trial. The tip is led by links that slide by `V` mm in all and turn
//! by `W` radians in all, and is never further than `r` from the line about which one turns. Each of them bends its way by its own turn and
//! by what the others do: the second derivative is at most `W² r + 2 W V`, and a chord of `n` is off by an eighth of that over n² at most.
//! Of `r` some samples are looked at: between two of them the tip comes nearer to a line, or goes away from it, by no more than it moves.

use crate::linkage::{LinkKind, Linkage};
use crate::{Machine, time};
use arm::{Joints, Structure};
use geom::{Frame, Mat3, Quat, Vec3};
use std::f64::consts::TAU;

/// At so many places at the most the distance of the tip from the lines of the axes is looked at.
const MOST_SAMPLES: f64 = 64.0;

/// A machine as the chain of its axes, for any number of motions.
#[derive(Clone, Debug)]
pub struct Chain {
    linkage: Linkage,
    machine: Machine,
    /// No line about which something turns on the side of the part is further from the work zero than this, mm.
    part_reach: f64,
    /// For each link whether it carries the tool.
    carries_tool: Vec<bool>,
}

/// Tip (mm) and tool axis (unit vector), work frame.
pub type Tool = (Vec3, Vec3);

impl Chain {
    /// Of a machine.
    pub fn of(machine: &Machine) -> Chain {
        let linkage = Linkage::of(machine);
        let mut carries_tool = vec![false; linkage.links.len()];
        let mut at = Some(linkage.tool.on);
        while let Some(link) = at {
            carries_tool[link] = true;
            at = linkage.links[link].on;
        }
        // From the work zero from line to line, as far as the bed.
        let mut point = Vec3::from_array(linkage.part.frame[3]);
        let (mut part_reach, mut at) = (0.0, Some(linkage.part.on));
        while let Some(link) = at.map(|at| &linkage.links[at]) {
            if link.kind == LinkKind::Turn {
                let next = Vec3::from_array(link.point);
                part_reach += point.distance(next);
                point = next;
            }
            at = link.on;
        }
        Chain { linkage, machine: machine.clone(), part_reach, carries_tool }
    }

    /// The motion from positions to positions, at the end of which the tool is known. `together`: all axes go evenly and arrive at the same
    /// time; otherwise each one goes as fast as it can, and arrives as [`time::each`] has it. Nothing where something is not known.
    pub fn motion(
        &self,
        [from, to]: [&[f64]; 2],
        end: Tool,
        together: bool,
    ) -> Option<AxisMotion<'_>> {
        let count = self.linkage.axes.len();
        let known = |axes: &[f64]| axes.len() == count && axes.iter().all(|at| at.is_finite());
        if !known(from) || !known(to) || !end.0.is_finite() || !end.1.is_finite() {
            return None;
        }
        let arrivals = if together { Vec::new() } else { self.arrivals(from, to) };
        let [from, to] = [from, to].map(<[f64]>::to_vec);
        Some(AxisMotion { chain: self, from, to, end, arrivals })
    }

    /// How long the tool of a mill is, mm, whose tip is there with the axes at these positions.
    pub fn tool_length(&self, axes: &[f64], tip: Vec3) -> f64 {
        let frame = self.linkage.tool_in_part(&self.linkage.frames(axes));
        -frame.inverse().transform_point3(tip).z
    }

    /// Where the axes of an arm are at a part of a motion, 0 to 1, in which the control keeps the tip on its way and turns the tool evenly about
    /// one axis, and the tool axis there. `ends` are the positions of the axes before and behind it, `end` is where the tool is behind it, and `tip`
    /// where it is then. Nothing where something is not known, or the arm does not reach it as it stands at the end.
    pub fn keeping_tip(
        &self,
        ends: [&[f64]; 2],
        end: Tool,
        tip: Vec3,
        part: f64,
    ) -> Option<(Vec<f64>, Vec3)> {
        let (arm, cell) = (self.machine.arm.as_ref()?, self.machine.cell.as_ref()?);
        let rails = ends.map(|axes| axes.get(6).copied().unwrap_or(0.0));
        let joints = |axes: &[f64]| {
            let shown: Joints = axes.get(..6)?.try_into().ok()?;
            arm.model(&shown.map(f64::to_radians))
        };
        let models = [joints(ends[0])?, joints(ends[1])?];
        let flange = |i: usize| cell.foot(rails[i]) * arm.flange(&models[i]);
        let flanges = [flange(0), flange(1)];
        let inverse = flanges[1].inverse();
        let off = inverse.transform_point3(cell.part.transform_point3(end.0));
        let axis = inverse.transform_vector3(cell.part.transform_vector3(end.1));
        let [from, to] = flanges.map(|flange| Quat::from_mat3(&flange.matrix3));
        let turned = Mat3::from_quat(from.slerp(to, part));
        let origin = cell.part.transform_point3(tip) - turned * off;
        let rail = rails[0] + (rails[1] - rails[0]) * part;
        let foot = cell.foot(rail).inverse();
        let there = foot * Frame::from_mat3_translation(turned, origin);
        let even: Joints =
            std::array::from_fn(|i| models[0][i] + (models[1][i] - models[0][i]) * part);
        let free =
            if matches!(arm.structure(), Structure::Spherical(_)) { even[3] } else { even[5] };
        let found = arm.inverse_in(arm.posture(&models[1]), &there, free)?;
        // Of all turns those that are nearest to where the joint is on its even way.
        let found: Joints =
            std::array::from_fn(|i| found[i] + ((even[i] - found[i]) / TAU).round() * TAU);
        let shown = arm.shown(&found)?.map(f64::to_degrees);
        let axes = shown.into_iter().chain(ends[1].get(6).map(|_| rail)).collect();
        Some((axes, cell.part.inverse().transform_vector3(turned * axis)))
    }

    /// When each axis arrives, as a part of the time that the slowest takes.
    fn arrivals(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let way = |axis: usize| to[axis] - from[axis];
        let mut turn = [0.0; 3];
        for (axis, place) in self.machine.rotary.iter().zip(3..) {
            turn[axis.index()] = way(place);
        }
        let linear = Vec3::from_array([0, 1, 2].map(way));
        let seconds: Vec<f64> = time::each(&self.machine, linear, turn).collect();
        let all = seconds.iter().copied().fold(0.0, f64::max);
        seconds.into_iter().map(|seconds| if all > 0.0 { seconds / all } else { 1.0 }).collect()
    }
}

/// A motion in which the axes lead the tip.
#[derive(Clone, Debug)]
pub struct AxisMotion<'a> {
    chain: &'a Chain,
    from: Vec<f64>,
    to: Vec<f64>,
    end: Tool,
    /// When each axis arrives, as a part of the time of the motion; empty where all of them arrive at its end.
    arrivals: Vec<f64>,
}

impl AxisMotion<'_> {
    /// Where the axes are at a part of the time, 0 to 1.
    pub fn axes(&self, part: f64) -> Vec<f64> {
        let ends = self.from.iter().zip(&self.to).enumerate();
        ends.map(|(axis, (from, to))| {
            let arrives = self.arrivals.get(axis).copied().unwrap_or(1.0);
            if part >= arrives { *to } else { from + (to - from) * (part / arrives) }
        })
        .collect()
    }

    /// Where the tool is, for parts of the time, 0 to 1.
    pub fn tool(&self) -> impl Fn(f64) -> Tool {
        let (tip, axis) = self.local();
        move |part| {
            let frame = self.frame(part);
            (frame.transform_point3(tip), frame.transform_vector3(axis))
        }
    }

    /// Parts of the time, the last of which is 1: the straight lines between the places of the tip there, from its first one on, are within
    /// `near` mm of its way, unless that takes more than `most`.
    pub fn parts(&self, near: f64, most: usize) -> Vec<f64> {
        let mut stops: Vec<f64> = self.arrivals.iter().copied().filter(|at| *at > 0.0).collect();
        stops.push(1.0);
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        let most = (most / stops.len()).max(1);
        let (mut parts, mut begin) = (Vec::new(), 0.0);
        for stop in stops {
            let count = self.chords([begin, stop], near, most);
            let part = |i: usize| begin + (stop - begin) * (i as f64 / count as f64);
            parts.extend((1..count).map(part));
            parts.push(stop);
            begin = stop;
        }
        parts
    }

    fn frame(&self, part: f64) -> Frame {
        let linkage = &self.chain.linkage;
        linkage.tool_in_part(&linkage.frames(&self.axes(part)))
    }

    /// Tip and axis in the frame of the tool.
    fn local(&self) -> Tool {
        let inverse = self.frame(1.0).inverse();
        (inverse.transform_point3(self.end.0), inverse.transform_vector3(self.end.1))
    }

    /// Into how many equal parts the time from `begin` to `end` is divided.
    fn chords(&self, [begin, end]: [f64; 2], near: f64, most: usize) -> usize {
        let linkage = &self.chain.linkage;
        let [from, to] = [begin, end].map(|part| self.axes(part));
        let way: Vec<f64> = from.iter().zip(&to).map(|(from, to)| to - from).collect();
        let (mut slides, mut turns, mut leads_tool) = (0.0, 0.0, false);
        for ((link, amount), carries) in linkage.amounts(&way).zip(&self.chain.carries_tool) {
            if link.kind == LinkKind::Turn {
                turns += amount.abs();
                leads_tool |= amount != 0.0 && *carries;
            } else {
                slides += amount.abs();
            }
        }
        let count = |reach: f64| {
            let bend = turns * turns * reach + 2.0 * turns * slides;
            (bend / (8.0 * near)).sqrt().ceil()
        };
        if turns == 0.0 {
            return 1;
        }
        // The lines of a table stay where they are on the part, but for those that carry others.
        if !leads_tool && turns < 0.5 && end == 1.0 {
            let reach = (self.end.0.length() + self.chain.part_reach + slides) / (1.0 - turns);
            if count(reach) <= 1.0 {
                return 1;
            }
        }
        let samples = (2.0 * turns).ceil().clamp(1.0, MOST_SAMPLES);
        let (tip, _) = self.local();
        let mut reach: f64 = 0.0;
        for sample in 0..=samples as usize {
            let part = begin + (end - begin) * (sample as f64 / samples);
            let frames = linkage.frames(&self.axes(part));
            for (link, amount) in linkage.amounts(&way) {
                if link.kind == LinkKind::Turn && amount != 0.0 {
                    reach = reach.max(linkage.lever(link, &frames, tip));
                }
            }
        }
        let rest = 1.0 - turns / (2.0 * samples);
        let reach = (reach + slides / (2.0 * samples)) / rest;
        let count = if rest > 0.0 { count(reach) } else { f64::INFINITY };
        // A number of whatever size becomes one of chords that can be drawn.
        count.clamp(1.0, most as f64) as usize
    }
}
