//! The judge: pulses of a program compared with the cloud that they are to make.
//!
//! Every pulse lies within the crack of its point, no point is lost and none gets two pulses, no two pulses are nearer than the
//! spacing, the axes stay within their travels, and no finished point shadows one below it. The focus is traced by Snell's law, and
//! the shadow is looked for in a tree of boxes: neither is shared with the planning. The cloud is that of the job; its minimum
//! distance is proven by [`crate::cloud::distances`].

use crate::clock::Clock;
use crate::cloud::{self, Grid, Pair, Point, Slabs, in_order};
use crate::control::{Motion, Pulse, Pulses, Run};
use crate::machine::{Lens, Machine, Table};
use crate::polar::Pose;
use crate::watch::Watch;
use glam::{DVec2, DVec3};
use program::{Diagnostic, Findings, Rule};
use rayon::prelude::*;
use serde::Serialize;
use std::borrow::Cow;
use std::collections::HashMap;

/// What a program is to make.
#[derive(Clone, Copy, Debug)]
pub struct Task<'t> {
    /// The cloud in the frame of the block, µm, in any order.
    pub cloud: &'t [Point],
    /// The machine.
    pub machine: &'t Machine,
    /// Its lens.
    pub lens: Lens,
    /// Index of refraction of the block.
    pub index: f64,
    /// Sides of each block, mm.
    pub block: [f64; 3],
    /// How many equal blocks there are, each with the whole cloud.
    pub blocks: u32,
    /// Smallest distance of two pulses, mm.
    pub spacing: f64,
    /// Whether shadowed points pass.
    pub accept_shadowed: bool,
}

/// What was found of a program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Proof {
    /// Pulses.
    pub pulses: u64,
    /// The largest distance of a pulse from its point across the beam, mm.
    pub across: f64,
    /// And along it, mm.
    pub along: f64,
    /// The nearest two pulses in the glass, by their numbers from 0; `None` where no two are within twice the spacing.
    pub nearest: Option<Pair>,
    /// Pairs of pulses that are nearer than the spacing.
    pub too_close: u64,
    /// Points that a point finished before them shadows.
    pub shadowed: u64,
    /// From pulse to pulse through the glass, mm; between blocks nothing.
    pub travel: f64,
    /// Ticks of the laser.
    pub ticks: u64,
    /// Time, s.
    pub seconds: f64,
    /// Part of the pulses of the laser that are used.
    pub used: f64,
}

/// The focus by the outermost ray: how deep it is in the glass for each mm that it is driven below the top face.
fn depth(lens: &Lens, beam: f64, index: f64) -> (f64, f64) {
    let in_air = (0.5 * beam / lens.focal).atan();
    let in_glass = (in_air.sin() / index).asin();
    (in_air.tan() / in_glass.tan(), in_glass.tan())
}

/// Where a beam comes to its focus in the glass, by the outermost ray.
#[derive(Clone, Copy, Debug)]
pub struct Focus {
    /// Sides of each block, mm.
    pub block: [f64; 3],
    /// How many equal blocks there are.
    pub blocks: u32,
    /// How deep it is for each mm that it is driven below the top face.
    deeper: f64,
}

impl Focus {
    /// That of a task.
    pub fn new(task: &Task) -> Focus {
        let (deeper, _) = depth(&task.lens, task.machine.laser.beam, task.index);
        Focus { block: task.block, blocks: task.blocks, deeper }
    }

    /// The same in the frame of the first block, whatever block the beam is over.
    pub fn from_first(self) -> Focus {
        Focus { blocks: 1, ..self }
    }

    /// Where it is with the axes of `machine` at these positions (mm or degrees): mm in the frame of the block under the beam, and the number
    /// of that, from 0.
    pub fn at(&self, machine: &Machine, [a, b, z]: [f64; 3]) -> (DVec3, u32) {
        let (flat, block) = match &machine.polar {
            Some(table) => self.on_table(a, b, table),
            None => {
                let chain = &machine.chain;
                (chain.map_or(DVec2::new(a, b), |chain| chain.forward([a, b])), 0)
            }
        };
        (flat.extend(self.block[2] + z * self.deeper), block)
    }

    /// Where the beam hits at these angles of arm and table (degrees): in the frame of the block under it, or of the first one where
    /// there is none.
    fn on_table(&self, arm: f64, turned: f64, table: &Table) -> (DVec2, u32) {
        let polar = table.with(self.block[0]);
        let hits = |block: u32| {
            let turned = turned - 360.0 / f64::from(table.blocks) * f64::from(block);
            polar.forward(Pose { arm: arm.to_radians(), table: turned.to_radians() })
        };
        let lies =
            |at: DVec2| at.min_element() >= 0.0 && at.x <= self.block[0] && at.y <= self.block[1];
        let under = (0..self.blocks).map(|block| (hits(block), block)).find(|(at, _)| lies(*at));
        under.unwrap_or_else(|| (hits(0), 0))
    }
}

/// Where pulses lie in the glass.
#[derive(Clone, Copy, Debug)]
pub struct Glass<'t> {
    pulses: &'t Pulses,
    machine: &'t Machine,
    focus: Focus,
}

impl<'t> Glass<'t> {
    /// The pulses of `run` in the blocks of `task`.
    pub fn new(run: &'t Run, task: &Task<'t>) -> Glass<'t> {
        Glass { pulses: &run.pulses, machine: task.machine, focus: Focus::new(task) }
    }

    /// How many pulses there are.
    pub fn len(&self) -> usize {
        self.pulses.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.pulses.is_empty()
    }

    /// Where the pulse of this number lies: mm in the frame of its block, and the number of that, both from 0.
    pub fn place(&self, number: usize) -> (DVec3, u32) {
        let at = self.pulses.get(number).map_or([0.0; 3], |pulse| pulse.at);
        self.focus.at(self.machine, at)
    }
}

/// Where pulses lie in the glass, those of several blocks side by side.
struct Places<'t> {
    glass: Glass<'t>,
    /// From block to block, mm.
    apart: f64,
    /// Along the longest axis of the cloud.
    axis: usize,
    slabs: Slabs,
}

impl<'t> Places<'t> {
    fn new(glass: Glass<'t>, apart: f64, axis: usize) -> Places<'t> {
        let none = Slabs::new(0, |_| 0);
        let places = Places { glass, apart, axis, slabs: none };
        let slabs = Slabs::new(glass.len(), |number| places.on_axis(places.at(number as u32)));
        Places { slabs, ..places }
    }

    /// Where a pulse lies, mm.
    fn at(&self, number: u32) -> DVec3 {
        let (place, block) = self.glass.place(number as usize);
        place + DVec3::X * (self.apart * f64::from(block))
    }

    /// Where a place lies along the axis, µm; beyond 2 m it is stray anyway.
    fn on_axis(&self, place: DVec3) -> i32 {
        (place[self.axis] * 1e3).round().clamp(-2e6, 2e6) as i32
    }

    /// From where to where a slab goes, µm.
    fn ends(&self, slab: &[u32]) -> (i64, i64) {
        let end = |i: Option<&u32>| i.map_or(0, |&i| i64::from(self.on_axis(self.at(i))));
        (end(slab.first()), end(slab.last()))
    }
}

/// The clouds of all blocks side by side, farther apart than a block is wide, and that distance, µm.
fn side_by_side<'t>(task: &Task<'t>) -> (Cow<'t, [Point]>, i32) {
    let apart = ((task.block[0] + 50.0) * 1e3) as i32;
    // Beams side by side make the same points in each block.
    if task.machine.polar.is_none() || task.blocks == 1 {
        return (Cow::Borrowed(task.cloud), apart);
    }
    let moved = |block: u32| {
        let shift = apart * block as i32;
        task.cloud.iter().map(move |[x, y, z]| [x + shift, *y, *z])
    };
    (Cow::Owned((0..task.blocks).flat_map(moved).collect()), apart)
}

/// Compares the pulses of `run` with `task`.
///
/// # Errors
/// Where there are no pulses.
pub fn prove(run: &Run, task: &Task) -> Result<(Proof, Vec<Diagnostic>), Vec<Diagnostic>> {
    prove_for(run, task, &())
}

/// As [`prove`], for who may end the work.
///
/// # Errors
/// As there, or that it was ended.
pub fn prove_for(
    run: &Run,
    task: &Task,
    watch: &dyn Watch,
) -> Result<(Proof, Vec<Diagnostic>), Vec<Diagnostic>> {
    let pulses = &run.pulses;
    if pulses.is_empty() {
        let found = Diagnostic::error(Rule::Lost, "the program makes no pulse");
        return Err(vec![found.help("write the program anew")]);
    }
    let mut findings = Findings::default();
    findings_of_block(run, task, &mut findings);
    travels(run, task, &mut findings);
    let (deeper, slope) = depth(&task.lens, task.machine.laser.beam, task.index);
    let (cloud, apart_by) = side_by_side(task);
    let glass = Glass::new(run, task);
    let task = &Task { cloud: &cloud, ..*task };
    let places = Places::new(glass, f64::from(apart_by) * 1e-3, cloud::longest(task.cloud));
    watch.go_on()?;
    let (order, across, along) = matched(pulses, &places, task, &mut findings, watch);
    watch.go_on()?;
    let (nearest, too_close) = distances(&places, task.spacing, watch);
    drop(places);
    watch.go_on()?;
    let apart = apart(nearest, too_close, pulses, task.spacing, deeper);
    let radius = 500.0 * task.lens.crack[0];
    let shadowed = shadows(&order, task.cloud, slope, radius, watch);
    watch.go_on()?;
    let hidden = finding_of_shadows(&shadowed, &order, pulses, task);
    apart.into_iter().chain(hidden).for_each(|found| findings.push(found));
    let ticks = Steps::new(run, task.machine).sum();
    let proof = Proof {
        pulses: pulses.len() as u64,
        across,
        along,
        nearest,
        too_close,
        shadowed: shadowed.len() as u64,
        travel: travel(&glass),
        ticks,
        seconds: ticks as f64 / task.machine.laser.rate,
        used: pulses.len() as f64 / ticks as f64,
    };
    Ok((proof, findings.finish()))
}

/// The program states the block that the task has.
fn findings_of_block(run: &Run, task: &Task, findings: &mut Findings) {
    if let Some(blocks) =
        run.block.map(|_| run.blocks.unwrap_or(1)).filter(|own| *own != task.blocks)
    {
        let message = format!("the program is for {blocks} blocks, not for {}", task.blocks);
        findings.push(
            Diagnostic::error(Rule::GlassBlock, message)
                .line(1)
                .help("give --blocks as for the program, or write the program anew"),
        );
    }
    let Some(block) = run.block else { return };
    if block.iter().zip(task.block).any(|(stated, side)| (stated - side).abs() > 5e-4) {
        let ([a, b, c], [x, y, z]) = (block, task.block);
        let message =
            format!("the program is for a block of {a} x {b} x {c} mm, not of {x} x {y} x {z} mm");
        findings.push(
            Diagnostic::error(Rule::GlassBlock, message)
                .line(1)
                .help("give the block of the program, or write the program anew"),
        );
    }
}

/// What is said of shadowed points: where they are accepted, a warning.
fn finding_of_shadows(
    shadowed: &[(u32, u32)],
    order: &[u32],
    pulses: &Pulses,
    task: &Task,
) -> Option<Diagnostic> {
    let &(below, above) = shadowed.iter().min()?;
    let show = |i: u32| {
        let [x, y, z] = task.cloud[i as usize].map(|value| f64::from(value) * 1e-3);
        format!("{x:.3} {y:.3} {z:.3}")
    };
    let message = format!(
        "{} points are made below a finished point that scatters their beam; the first one at {} mm, below {} mm",
        shadowed.len(),
        show(order[below as usize]),
        show(order[above as usize])
    );
    let line = line(pulses, below);
    Some(match task.accept_shadowed {
        true => Diagnostic::warning(Rule::Shadowed, message)
            .line(line)
            .help("accepted by `--accept shadowed`; `--order fastest` shadows none"),
        false => Diagnostic::error(Rule::Shadowed, message)
            .line(line)
            .help("order by `--order fastest`, which keeps the rule, or add `--accept shadowed`"),
    })
}

/// The ticks before each pulse of a run, 1 before the first: every motion from stop to stop takes whole ticks, and pulses in one
/// motion are as many apart as it says.
pub struct Steps<'r> {
    run: &'r Run,
    clock: Clock,
    /// Steps of each axis in a mm or degree.
    units: [f64; 3],
    /// The ticks before pulses to which more leads than a motion from the pulse before.
    own: HashMap<usize, u64>,
}

impl<'r> Steps<'r> {
    /// Of `run` on `machine`.
    pub fn new(run: &'r Run, machine: &Machine) -> Steps<'r> {
        let (clock, units) = (machine.clock(), machine.coordinates().map(|of| of.steps()));
        let mut steps = Steps { run, clock, units, own: HashMap::new() };
        steps.motions(machine);
        // From field to field the stage moves, while the mirrors lead the beam to its place in the next one.
        for pair in run.fields.windows(2) {
            let ((_, _, from), (next, _, to)) = (pair[0], pair[1]);
            let Some((before, after)) = steps.between(next as usize) else { continue };
            let inside =
                |at: [f64; 3], center: [f64; 2]| [at[0] - center[0], at[1] - center[1], at[2]];
            let mirrors = steps.step(inside(before.at, from), inside(after.at, to));
            steps.own.insert(next as usize, mirrors.max(machine.carried(from, to)));
        }
        for stops in run.stops.chunk_by(|a, b| a.pulses == b.pulses) {
            let next = stops[0].pulses as usize;
            let Some((before, after)) = steps.between(next) else { continue };
            // After the first pulse every axis has been sent to a place.
            let known = stops.iter().filter_map(|stop| match stop.at {
                [Some(x), Some(y), Some(z)] => Some([x, y, z]),
                _ => None,
            });
            let chain: Vec<[f64; 3]> =
                std::iter::once(before.at).chain(known).chain([after.at]).collect();
            let ticks = chain.windows(2).map(|pair| steps.step(pair[0], pair[1]));
            let ticks = ticks.fold(0, u64::saturating_add);
            steps.own.insert(next, ticks);
        }
        steps
    }

    /// How many pulses there are.
    pub fn len(&self) -> usize {
        self.run.pulses.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.run.pulses.is_empty()
    }

    /// The ticks before the pulse of this number, from 0.
    pub fn get(&self, number: usize) -> u64 {
        match (self.own.get(&number), self.between(number)) {
            (Some(own), _) => *own,
            (None, None) => 1,
            (None, Some((from, to))) if to.passed == 0 => self.step(from.at, to.at),
            (None, Some((_, to))) => u64::from(to.passed),
        }
    }

    /// The ticks of all of them.
    pub fn sum(&self) -> u64 {
        (0..self.len())
            .into_par_iter()
            .map(|number| self.get(number))
            .reduce(|| 0, u64::saturating_add)
    }

    fn between(&self, next: usize) -> Option<(Pulse, Pulse)> {
        let pulses = &self.run.pulses;
        Some((pulses.get(next.checked_sub(1)?)?, pulses.get(next)?))
    }

    fn in_steps(&self, at: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| at[axis] * self.units[axis])
    }

    fn step(&self, from: [f64; 3], to: [f64; 3]) -> u64 {
        let [from, to] = [from, to].map(|at| self.in_steps(at).map(|value| value.round() as i32));
        u64::from(self.clock.step(from, to))
    }

    /// Into a motion at constant speed the axes gain it, out of it they brake.
    fn motions(&mut self, machine: &Machine) {
        let late = machine.late();
        let mut ends: Vec<(usize, [f64; 3], [f64; 3])> = Vec::new();
        for Motion { first, count, speed } in &self.run.motions {
            let (before, after) = (*first as usize, (first + count) as usize);
            let speed = self.in_steps(*speed);
            match ends.last_mut().filter(|end| end.0 == before) {
                Some(end) => end.2 = speed,
                None => ends.push((before, [0.0; 3], speed)),
            }
            ends.push((after, speed, [0.0; 3]));
        }
        for (next, leaves, enters) in ends {
            let Some((from, to)) = self.between(next) else { continue };
            // At the trigger, which is a little before.
            let led = |at: [f64; 3], speed: [f64; 3]| {
                let at = self.in_steps(at);
                [0, 1, 2].map(|axis| at[axis] - speed[axis] * late)
            };
            let (a, b) = (led(from.at, leaves), led(to.at, enters));
            let way = [0, 1, 2].map(|axis| b[axis].round() - a[axis].round());
            self.own.insert(next, self.clock.between(way, leaves, enters));
        }
    }
}

/// The nearest two of `places`, and how many pairs are nearer than `spacing` (mm). Places beyond 2 m are left out: they are stray.
fn distances(places: &Places, spacing: f64, watch: &dyn Watch) -> (Option<Pair>, u64) {
    let found = distances_within(places, spacing, 1.25 * spacing, watch);
    match found.0 {
        Some(_) => found,
        None => distances_within(places, spacing, 2.0 * spacing, watch),
    }
}

/// As [`distances`]; pairs farther apart than `most` (mm, more than the spacing) are not looked at.
fn distances_within(
    places: &Places,
    spacing: f64,
    most: f64,
    watch: &dyn Watch,
) -> (Option<Pair>, u64) {
    // Places are up to a µm from their points in each axis.
    let reach = (1e3 * most).ceil() as i64 + 2;
    let join = |a: ((f64, u32, u32), u64), b: ((f64, u32, u32), u64)| {
        (if b.0 < a.0 { b.0 } else { a.0 }, a.1 + b.1)
    };
    let none = || ((f64::MAX, 0, 0), 0);
    let of_slab = |slab: &[u32]| {
        let (low, high) = places.ends(slab);
        let known = |&i: &u32| {
            let place = places.at(i);
            Some((i, place, cloud::point(place)?))
        };
        let seen = in_order(places.slabs.within(low - reach, high + reach));
        let seen: Vec<(u32, DVec3, Point)> = seen.par_iter().filter_map(known).collect();
        let points: Vec<Point> = seen.iter().map(|(_, _, point)| *point).collect();
        let grid = Grid::new(&points, reach);
        let of = |i: &u32| {
            let (mut nearest, mut close) = ((f64::MAX, 0, 0), 0u64);
            let known = known(i).filter(|_| !watch.is_ended());
            let Some((i, place, point)) = known else { return (nearest, close) };
            for &(j, there, _) in grid.near(point).map(|near| &seen[near as usize]) {
                let square = place.distance_squared(there);
                if j > i && square <= most * most {
                    let distance = square.sqrt();
                    if (distance, i, j) < nearest {
                        nearest = (distance, i, j);
                    }
                    close += u64::from(distance < spacing - ROUNDING);
                }
            }
            (nearest, close)
        };
        in_order(slab).par_iter().map(of).reduce(none, join)
    };
    let (nearest, close) = places.slabs.each().map(of_slab).fold(none(), join);
    let pair = |(distance, a, b)| Pair { points: [a, b], distance };
    ((nearest.0 < f64::MAX).then(|| pair(nearest)), close)
}

/// Part of a mm that sums of coordinates lose.
const ROUNDING: f64 = 1e-9;

/// What is said of pulses that are too close: an error beyond what whole µm of the drive take, `deeper` µm of depth.
fn apart(
    nearest: Option<Pair>,
    too_close: u64,
    pulses: &Pulses,
    spacing: f64,
    deeper: f64,
) -> Option<Diagnostic> {
    let Pair { points: [a, b], distance } = nearest.filter(|_| too_close > 0)?;
    let [first, second] = [a, b].map(|i| line(pulses, i));
    let message = format!(
        "{too_close} pairs of pulses are nearer than {spacing} mm, the nearest {distance:.4} mm, of the lines {first} and {second}"
    );
    let found = if distance < spacing - 1e-3 * deeper - ROUNDING {
        Diagnostic::error(Rule::Spacing, message)
            .help("their cracks join and break the glass: write the program anew")
    } else {
        Diagnostic::warning(Rule::Spacing, message).help(format!(
            "whole µm of the drive are {deeper:.2} µm of depth; --spacing {:.3} keeps {spacing} mm",
            spacing + 1e-3 * deeper.ceil()
        ))
    };
    Some(found.line(second))
}

/// Every axis stays within its travel, wherever it stops.
fn travels(run: &Run, task: &Task, findings: &mut Findings) {
    let pulse = |(i, pulse): (usize, Pulse)| {
        let begun = run.fields.partition_point(|(first, _, _)| *first as usize <= i);
        let center = begun.checked_sub(1).map_or([0.0; 2], |field| run.fields[field].2);
        let [x, y, z] = pulse.at;
        // What a subtraction leaves of whole µm.
        let whole =
            |value: f64| if run.fields.is_empty() { value } else { (value * 1e6).round() / 1e6 };
        (pulse.line, [whole(x - center[0]), whole(y - center[1]), z].map(Some))
    };
    for (_, line, center) in &run.fields {
        let stage = task.machine.stage.iter().flat_map(|stage| [("X", stage.x), ("Y", stage.y)]);
        for ((name, axis), at) in stage.zip(center) {
            let [low, high] = axis.travel;
            if !(low..=high).contains(at) {
                let message = format!(
                    "{name}{at:.3} of the stage is beyond its travel from {low} to {high} mm"
                );
                let found = Diagnostic::error(Rule::Travel, message).line(*line);
                findings.push(found.help("take a smaller block, or move the body"));
            }
        }
    }
    let stops = run.stops.iter().map(|stop| (stop.line, stop.at));
    // Where the axes begin to gain the speed of a motion, and where they stand when they have braked.
    let clock = task.machine.clock();
    let coordinates = task.machine.coordinates();
    let turned = run.motions.iter().flat_map(|motion| {
        let steps = [0, 1, 2].map(|axis| motion.speed[axis] * coordinates[axis].steps());
        let gained = clock.gained(steps).1;
        let ends = [(motion.first, -1.0), (motion.first + motion.count - 1, 1.0)];
        ends.map(|(pulse, side)| {
            let Pulse { line, at, .. } = run.pulses.get(pulse as usize).unwrap_or_default();
            let beyond = |axis: usize| at[axis] + side * gained[axis] / coordinates[axis].steps();
            (line, [0, 1, 2].map(|axis| Some(beyond(axis))))
        })
    });
    let pulses = run.pulses.iter().enumerate().map(pulse);
    let all = pulses.chain(stops).chain(turned);
    for (i, of) in coordinates.into_iter().enumerate().filter(|(_, of)| !of.endless) {
        let (name, [low, high]) = (of.word, of.axis.travel);
        let unit = if of.turns { "°" } else { "mm" };
        let beyond = all.clone().filter_map(|(line, at)| Some((line, at[i]?)));
        for (line, at) in beyond.filter(|(_, at)| !(low..=high).contains(at)) {
            let message = format!("{name}{at:.3} is beyond the travel from {low} to {high} {unit}");
            let found = Diagnostic::error(Rule::Travel, message).line(line);
            findings.push(found.help("take a smaller block, or move the body"));
        }
    }
}

/// No number of a point.
const NONE: u32 = u32::MAX;

/// Gives each pulse the nearest point: the points in the order of their pulses, and the largest distances across and along the beam, mm.
fn matched(
    pulses: &Pulses,
    places: &Places,
    task: &Task,
    findings: &mut Findings,
    watch: &dyn Watch,
) -> (Vec<u32>, f64, f64) {
    let (found, across, along) = nearest_points(places, task, watch);
    let mut by: Vec<u32> = vec![NONE; task.cloud.len()];
    let mut order = Vec::with_capacity(pulses.len());
    for (i, j) in (0..).zip(found) {
        if j == NONE {
            let DVec3 { x, y, z } = places.at(i);
            let message =
                format!("the pulse at {x:.3} {y:.3} {z:.3} mm lies in the crack of no point");
            findings.push(
                Diagnostic::error(Rule::Stray, message)
                    .line(line(pulses, i))
                    .help("write the program anew"),
            );
            continue;
        }
        if by[j as usize] != NONE {
            let first = line(pulses, by[j as usize]);
            let message = format!("the point of this pulse was made on line {first} already");
            findings.push(
                Diagnostic::error(Rule::Twice, message)
                    .line(line(pulses, i))
                    .help("write the program anew"),
            );
            continue;
        }
        by[j as usize] = i;
        order.push(j);
    }
    let lost = by.iter().filter(|by| **by == NONE).count();
    if let Some(first) = by.iter().position(|by| *by == NONE) {
        let [x, y, z] = task.cloud[first].map(|value| f64::from(value) * 1e-3);
        let message = format!("{lost} points get no pulse, one of them at {x:.3} {y:.3} {z:.3} mm");
        findings.push(Diagnostic::error(Rule::Lost, message).help("write the program anew"));
    }
    (order, across, along)
}

/// Of each pulse the nearest point in whose crack it lies, `NONE` where it lies in none, and the largest distances across and along
/// the beam, mm.
fn nearest_points(places: &Places, task: &Task, watch: &dyn Watch) -> (Vec<u32>, f64, f64) {
    let [radius, height] = task.lens.crack.map(|size| 500.0 * size);
    let reach = radius.max(height).ceil() as i64 + 1;
    let points = Slabs::new(task.cloud.len(), |i| task.cloud[i][places.axis]);
    let mut found: Vec<u32> = vec![NONE; places.glass.len()];
    let (mut most_across, mut most_along) = (0.0f64, 0.0f64);
    for slab in places.slabs.each() {
        let (low, high) = places.ends(slab);
        let seen = in_order(points.within(low - reach, high + reach));
        let own: Vec<Point> = seen.par_iter().map(|&j| task.cloud[j as usize]).collect();
        let grid = Grid::new(&own, reach);
        let nearest = |&i: &u32| {
            if watch.is_ended() {
                return (i, None);
            }
            let place = places.at(i).to_array().map(|value| value * 1e3);
            let rounded = place.map(|value| value.round() as i32);
            let way = |near: u32| {
                let point = own[near as usize].map(f64::from);
                let (x, y, z) = (place[0] - point[0], place[1] - point[1], place[2] - point[2]);
                (x.hypot(y), z.abs())
            };
            let inside = grid.near(rounded).map(|near| (way(near), seen[near as usize]));
            let inside = inside.filter(|((across, along), _)| {
                (across / radius).powi(2) + (along / height).powi(2) <= 1.0
            });
            let far = |((across, along), _): &((f64, f64), u32)| across * across + along * along;
            let best = inside.min_by(|a, b| far(a).total_cmp(&far(b)).then(a.1.cmp(&b.1)));
            (i, best)
        };
        let of_slab: Vec<_> = in_order(slab).par_iter().map(nearest).collect();
        for (i, ((across, along), j)) in
            of_slab.into_iter().filter_map(|(i, best)| Some((i, best?)))
        {
            found[i as usize] = j;
            (most_across, most_along) = (most_across.max(across), most_along.max(along));
        }
    }
    (found, most_across * 1e-3, most_along * 1e-3)
}

/// The length of the lines from pulse to pulse, mm. Each is rounded to µm, so that their sum does not depend on who adds which.
fn travel(glass: &Glass) -> f64 {
    let length = |number: usize| {
        let ((from, before), (to, after)) = (glass.place(number - 1), glass.place(number));
        if before == after { (from.distance(to) * 1e3).round() as u64 } else { 0 }
    };
    (1..glass.len()).into_par_iter().map(length).reduce(|| 0, u64::saturating_add) as f64 * 1e-3
}

/// The line of a pulse.
fn line(pulses: &Pulses, number: u32) -> u32 {
    pulses.get(number as usize).map_or(0, |pulse| pulse.line)
}

/// A box of points, and when the first of them is made.
struct Node {
    low: [f64; 2],
    high: [f64; 2],
    top: f64,
    first: u32,
    /// The points of a leaf, or both halves.
    parts: Parts,
}

enum Parts {
    Leaf(Vec<(Point, u32)>),
    Halves(Box<(Node, Node)>),
}

/// Most points of a leaf.
const LEAF: usize = 16;

impl Node {
    /// Of points with their places in the order; at least one.
    fn new(points: &mut [(Point, u32)]) -> Node {
        let axis = |axis: usize| points.iter().map(move |(point, _)| f64::from(point[axis]));
        let span = |a: usize| (axis(a).fold(f64::MAX, f64::min), axis(a).fold(f64::MIN, f64::max));
        let spans = [span(0), span(1), span(2)];
        let first = points.iter().map(|(_, when)| *when).min().unwrap_or(NONE);
        let parts = if points.len() <= LEAF {
            Parts::Leaf(points.to_vec())
        } else {
            let wide = |i: &usize| spans[*i].1 - spans[*i].0;
            let longest = (0..3).max_by(|a, b| wide(a).total_cmp(&wide(b))).unwrap_or(0);
            let middle = points.len() / 2;
            points.select_nth_unstable_by_key(middle, |(point, when)| (point[longest], *when));
            let (left, right) = points.split_at_mut(middle);
            Parts::Halves(Box::new(rayon::join(|| Node::new(left), || Node::new(right))))
        };
        let [x, y, z] = spans;
        Node { low: [x.0, y.0], high: [x.1, y.1], top: z.1, first, parts }
    }

    /// The earliest point made before `when` that shadows `point`: its place in the order.
    fn shadower(&self, point: Point, when: u32, slope: f64, radius: f64) -> Option<u32> {
        let [x, y, z] = point.map(f64::from);
        let reach = radius + slope * (self.top - z);
        if self.first >= when || self.top <= z {
            return None;
        }
        let off = |value: f64, low: f64, high: f64| (low - value).max(value - high).max(0.0);
        if off(x, self.low[0], self.high[0]).hypot(off(y, self.low[1], self.high[1])) >= reach {
            return None;
        }
        match &self.parts {
            Parts::Leaf(points) => {
                let hides = |(above, made): &&(Point, u32)| {
                    let [a, b, c] = above.map(f64::from);
                    *made < when && c > z && (a - x).hypot(b - y) < radius + slope * (c - z)
                };
                points.iter().filter(hides).map(|(_, made)| *made).min()
            }
            Parts::Halves(halves) => {
                let both = [&halves.0, &halves.1];
                both.into_iter().filter_map(|half| half.shadower(point, when, slope, radius)).min()
            }
        }
    }
}

/// The places in the order of points that are shadowed, each with that of the first point that shadows it. Points above are
/// taken slab by slab, with the slabs below of which some points are made after them.
fn shadows(
    order: &[u32],
    cloud: &[Point],
    slope: f64,
    radius: f64,
    watch: &dyn Watch,
) -> Vec<(u32, u32)> {
    let point = |when: u32| cloud[order[when as usize] as usize];
    let heights = Slabs::new(order.len(), |when| point(when as u32)[2]);
    let slabs: Vec<(&[u32], u32)> =
        heights.each().map(|slab| (slab, slab.iter().copied().max().unwrap_or(0))).collect();
    let mut first: Vec<u32> = vec![NONE; order.len()];
    for (number, (above, _)) in slabs.iter().enumerate() {
        let mut points: Vec<(Point, u32)> = above.iter().map(|&when| (point(when), when)).collect();
        let tree = Node::new(&mut points);
        for (below, _) in slabs[..=number].iter().filter(|(_, last)| *last > tree.first) {
            let shadower = |&when: &u32| {
                let when = (!watch.is_ended()).then_some(when)?;
                Some((when, tree.shadower(point(when), when, slope, radius)?))
            };
            let found: Vec<(u32, u32)> = below.par_iter().filter_map(shadower).collect();
            for (when, by) in found {
                first[when as usize] = first[when as usize].min(by);
            }
        }
    }
    (0..).zip(first).filter(|(_, by)| *by != NONE).collect()
}
