//! How a polar machine is driven (spec 2.16, 4.17): point by point, along arcs of its arm, or along tracks of its table.
//!
//! On arcs and tracks pulses are fired in motion, one a tick, so points must lie where the motion passes on a tick: the cloud is
//! moved to such sites, layer by layer from below. All of a layer have one height, so none of them shadows another.

use crate::clock::Clock;
use crate::cloud::{self, Point};
use crate::fly::{self, Run};
use crate::machine::{Machine, Table};
use crate::polar::{Branch, Polar, Pose};
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Along what a polar machine fires in motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scenario {
    /// The arm sweeps, the table turns by a constant angle between sweeps (scenario 1).
    Arcs,
    /// The table turns under all blocks, the arm steps between turns (scenario 2).
    Tracks,
}

/// Where a polar machine stands at each point of a job.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The cloud of one block, µm, in its order.
    pub cloud: Vec<Point>,
    /// Where the axes stand at each pulse of all blocks, but for Z; steps.
    pub axes: Vec<[i32; 2]>,
    /// The point of each pulse: its number in `cloud`.
    pub points: Vec<u32>,
    /// Pulses in motion.
    pub runs: Vec<Run>,
    /// How far the farthest point was moved, mm.
    pub moved: f64,
    /// Points that fell onto the site of another one, or moved beyond the margin.
    pub merged: u64,
}

/// The blocks on the table of a polar machine.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<'m> {
    /// The machine.
    pub machine: &'m Machine,
    /// Its table.
    pub table: Table,
    /// Sides of each block, mm.
    pub block: [f64; 3],
    /// How many there are.
    pub count: u32,
}

impl Blocks<'_> {
    fn polar(&self) -> Polar {
        self.table.with(self.block[0])
    }

    /// The angle from each place for a block to the next, degrees.
    fn apart(&self) -> f64 {
        360.0 / f64::from(self.table.blocks)
    }

    /// Arm and table at a point of the first block, degrees: the arm from -180 to 180.
    fn pose(&self, at: DVec2) -> Option<[f64; 2]> {
        let Pose { arm, table } = self.polar().inverse(at, self.table.branch)?;
        let arm = if arm > 0.5 * TAU { arm - TAU } else { arm };
        Some([arm.to_degrees(), table.to_degrees()])
    }

    /// Whether the arm gets to a point within its travel.
    pub fn reaches(&self, point: Point) -> bool {
        let [low, high] = self.machine.coordinates()[0].axis.travel;
        let at = cloud::place(point).truncate();
        self.pose(at).is_some_and(|[arm, _]| (low..=high).contains(&arm))
    }

    /// Whether the arm gets to the middle of each cell of the block, row by row from its near side, `columns` in a row.
    pub fn map(&self, columns: u32) -> Vec<bool> {
        let step = self.block[0] / f64::from(columns);
        let rows = (self.block[1] / step).round().max(1.0) as u32;
        let up = self.block[1] / f64::from(rows);
        let middle = |i: u32, step: f64| ((f64::from(i) + 0.5) * step * 1e3).round() as i32;
        let cell = |(row, column)| self.reaches([middle(column, step), middle(row, up), 0]);
        (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))).map(cell).collect()
    }

    /// Steps of arm and table.
    fn steps(&self, degrees: [f64; 2]) -> [i32; 2] {
        let [arm, table, _] = self.machine.coordinates().map(|of| of.steps());
        [(degrees[0] * arm).round() as i32, (degrees[1] * table).round() as i32]
    }

    /// Where arm and table stand at each of `cloud`, all of which it reaches, in the first block.
    pub fn poses(&self, cloud: &[Point]) -> Vec<[i32; 2]> {
        let pose = |point: &Point| {
            self.steps(self.pose(cloud::place(*point).truncate()).unwrap_or_default())
        };
        cloud.iter().map(pose).collect()
    }

    /// How far the table turns from the first block to the one of this number, steps.
    pub fn turned(&self, block: u32) -> i32 {
        self.steps([0.0, f64::from(block) * self.apart()])[1]
    }

    /// Moves `cloud` to sites at least `step` mm apart, and orders them; points keep `margin` mm from the sides of the block.
    pub fn plan(
        &self,
        cloud: &[Point],
        scenario: Scenario,
        step: f64,
        margin: f64,
        clock: &Clock,
    ) -> Plan {
        match scenario {
            Scenario::Arcs => self.arcs(cloud, step, margin, clock),
            Scenario::Tracks => self.tracks(cloud, step, margin, clock),
        }
    }

    /// Whether a site keeps the margin.
    fn holds(&self, at: DVec3, margin: f64) -> bool {
        let most = DVec3::from_array(self.block) - margin + 1e-3;
        at.min_element() >= margin - 1e-3 && at.cmple(most).all()
    }

    fn tracks(&self, cloud: &[Point], step: f64, margin: f64, clock: &Clock) -> Plan {
        let polar = self.polar();
        let blocks = i64::from(self.table.blocks);
        // As many ticks in a turn as fit, the same from each block to the next.
        let turn = |track: i64| {
            let radius = track as f64 * step;
            let fit = 0.5 * TAU / (0.5 * step / radius).min(1.0).asin();
            (fit as i64 / blocks).max(1) * blocks
        };
        let place = |&(layer, track, tick): &Site| {
            let angle = tick as f64 / turn(track) as f64 * TAU;
            let radius = track as f64 * step;
            let at = DVec2::new(radius * angle.sin(), radius * angle.cos() - polar.offset);
            (at + DVec2::X * 0.5 * self.block[0]).extend(layer as f64 * step)
        };
        let site = |at: DVec3| {
            let from = DVec2::new(at.x - 0.5 * self.block[0], at.y + polar.offset);
            let track = (from.length() / step).round() as i64;
            let tick = from.x.atan2(from.y) / TAU * turn(track) as f64;
            ((at.z / step).round() as i64, track, tick.round() as i64)
        };
        let mut plan = Plan::default();
        let sites = self.sites(cloud, margin, site, place, &mut plan);
        for row in sites.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let (_, track, _) = row[0];
            let count = turn(track);
            let Some([arm, _]) = self.pose(place(&row[0]).truncate()) else { continue };
            // All points of a track are one pose of the arm, and as far from their table angles.
            let middle = DVec2::new(0.5 * self.block[0], track as f64 * step - polar.offset);
            let Some([_, begins]) = self.pose(middle) else { continue };
            let speed = 360.0 / count as f64;
            let first = plan.cloud.len() as u32;
            plan.cloud.extend(row.iter().filter_map(|site| cloud::point(place(site))));
            let passes: Vec<(i64, u32)> = (0..i64::from(self.count))
                .flat_map(|block| {
                    let more = block * count / blocks;
                    row.iter().zip(first..).map(move |((_, _, tick), i)| (tick + more, i))
                })
                .collect();
            let at = |tick: i64| [arm, begins + tick as f64 * speed];
            self.add(&passes, at, [0.0, speed], clock, &mut plan);
        }
        plan
    }

    fn arcs(&self, cloud: &[Point], step: f64, margin: f64, clock: &Clock) -> Plan {
        let polar = self.polar();
        let sign = if self.table.branch == Branch::Left { -1.0 } else { 1.0 };
        let tick = 2.0 * (0.5 * step / polar.arm).asin().to_degrees();
        // Neighbouring arcs are nearest where the arm is nearest to the line of the axes.
        let arms = cloud.iter().filter_map(|at| self.pose(cloud::place(*at).truncate()));
        let least = arms.map(|[arm, _]| arm.abs()).fold(90.0, f64::min) - tick;
        let index = (step / polar.arc_pitch(least.max(0.1).to_radians())).to_degrees();
        let place = |&(layer, arc, tick_of): &Site| {
            let arm = (sign * tick_of as f64 * tick).to_radians();
            let table = (arc as f64 * index).to_radians();
            polar.forward(Pose { arm, table }).extend(layer as f64 * step)
        };
        let site = |at: DVec3| {
            let [arm, table] = self.pose(at.truncate()).unwrap_or_default();
            let arc = (table / index).round() as i64;
            ((at.z / step).round() as i64, arc, (arm.abs() / tick).round() as i64)
        };
        let mut plan = Plan::default();
        let sites = self.sites(cloud, margin, site, place, &mut plan);
        let mut back = false;
        for layer in sites.chunk_by(|a, b| a.0 == b.0) {
            let first = plan.cloud.len() as u32;
            plan.cloud.extend(layer.iter().filter_map(|site| cloud::point(place(site))));
            // The layer in all blocks before the focus moves on.
            for block in 0..self.count {
                let mut number = first;
                for row in layer.chunk_by(|a, b| a.1 == b.1) {
                    let mut passes: Vec<(i64, u32)> =
                        row.iter().zip(number..).map(|((_, _, tick), i)| (*tick, i)).collect();
                    number += row.len() as u32;
                    if back {
                        passes.reverse();
                        passes.iter_mut().for_each(|(tick, _)| *tick = -*tick);
                    }
                    let table = row[0].1 as f64 * index + f64::from(block) * self.apart();
                    let way = if back { -sign } else { sign } * tick;
                    let at = |ticks: i64| [ticks as f64 * way, table];
                    self.add(&passes, at, [way, 0.0], clock, &mut plan);
                    back = !back;
                }
            }
        }
        plan
    }

    /// The sites of a cloud in their order, each once.
    fn sites(
        &self,
        cloud: &[Point],
        margin: f64,
        site: impl Fn(DVec3) -> Site,
        place: impl Fn(&Site) -> DVec3,
        plan: &mut Plan,
    ) -> Vec<Site> {
        let mut sites = BTreeSet::new();
        for point in cloud {
            let from = cloud::place(*point);
            let site = site(from);
            let to = place(&site);
            if self.holds(to, margin) && sites.insert(site) {
                plan.moved = plan.moved.max(from.distance(to));
            } else {
                plan.merged += 1;
            }
        }
        sites.into_iter().collect()
    }
}

/// A layer, an arc or a track in it, and a tick of the motion along that.
type Site = (i64, i64, i64);

impl Blocks<'_> {
    /// Adds a row of pulses: `passes` are ticks of the motion, in their order, and the points that are made then. A gap that the axes
    /// cross faster from rest to rest ends the motion.
    fn add(
        &self,
        passes: &[(i64, u32)],
        at: impl Fn(i64) -> [f64; 2],
        speed: [f64; 2],
        clock: &Clock,
        plan: &mut Plan,
    ) {
        let steps = self.machine.coordinates().map(|of| of.steps());
        let speed = fly::stated([speed[0] * steps[0], speed[1] * steps[1], 0.0], steps);
        let skips = |pair: &(i64, u32), next: &(i64, u32)| {
            let ticks = next.0 - pair.0;
            let way = speed.map(|speed| speed * ticks as f64);
            clock.between(way, speed, speed) >= ticks as u64
        };
        for motion in passes.chunk_by(skips) {
            if motion.len() > 1 && clock.allows(speed) {
                plan.runs.push(Run { first: plan.axes.len(), count: motion.len(), speed });
            }
            plan.axes.extend(motion.iter().map(|(tick, _)| self.steps(at(*tick))));
            plan.points.extend(motion.iter().map(|(_, point)| *point));
        }
    }
}
