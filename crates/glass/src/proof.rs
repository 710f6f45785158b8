//! The judge: pulses of a program compared with the cloud that they are to make.
//!
//! Every pulse lies within the crack of its point, no point is lost and none gets two pulses, no two pulses are nearer than the
//! spacing, the axes stay within their travels, and no finished point shadows one below it. The focus is traced by Snell's law, and
//! the shadow is looked for in a tree of boxes: neither is shared with the planning. The cloud is that of the job; its minimum
//! distance is proven by [`crate::cloud::distances`].

use crate::cloud::{self, Grid, Pair, Point};
use crate::control::{Motion, Pulse, Run};
use crate::machine::{Lens, Machine, Table};
use crate::polar::Pose;
use glam::{DVec2, DVec3};
use program::{Diagnostic, Findings, Rule};
use rayon::prelude::*;
use serde::Serialize;

/// What a program is to make.
#[derive(Clone, Copy, Debug)]
pub struct Task<'t> {
    /// The cloud in the frame of the block, µm, in any order.
    pub cloud: &'t [Point],
    /// The machine.
    pub machine: &'t Machine,
    /// Its lens.
    pub lens: &'t Lens,
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

/// Where the pulses of a run lie in the glass, in their order: mm in the frame of their block, and the number of that, from 0.
pub fn places(run: &Run, task: &Task) -> Vec<(DVec3, u32)> {
    let (deeper, _) = depth(task.lens, task.machine.laser.beam, task.index);
    let in_glass = |pulse: &Pulse| {
        let [a, b, z] = pulse.at;
        let (flat, block) = match &task.machine.polar {
            Some(table) => on_table(a, b, table, task),
            None => (DVec2::new(a, b), 0),
        };
        (flat.extend(task.block[2] + z * deeper), block)
    };
    run.pulses.iter().map(in_glass).collect()
}

/// Where the beam hits at these angles of arm and table (degrees): in the frame of the block under it, or of the first one where
/// there is none.
fn on_table(arm: f64, turned: f64, table: &Table, task: &Task) -> (DVec2, u32) {
    let polar = table.with(task.block[0]);
    let hits = |block: u32| {
        let turned = turned - 360.0 / f64::from(table.blocks) * f64::from(block);
        polar.forward(Pose { arm: arm.to_radians(), table: turned.to_radians() })
    };
    let lies =
        |at: DVec2| at.min_element() >= 0.0 && at.x <= task.block[0] && at.y <= task.block[1];
    let under = (0..task.blocks).map(|block| (hits(block), block)).find(|(at, _)| lies(*at));
    under.unwrap_or_else(|| (hits(0), 0))
}

/// The clouds of all blocks side by side, farther apart than a block is wide, and that distance, µm.
fn side_by_side(task: &Task) -> (Vec<Point>, i32) {
    let apart = ((task.block[0] + 50.0) * 1e3) as i32;
    let moved = |block: u32| {
        let shift = apart * block as i32;
        task.cloud.iter().map(move |[x, y, z]| [x + shift, *y, *z])
    };
    // Beams side by side make the same points in each block.
    let made = if task.machine.polar.is_some() { task.blocks } else { 1 };
    ((0..made).flat_map(moved).collect(), apart)
}

/// Compares the pulses of `run` with `task`.
///
/// # Errors
/// Where there are no pulses.
pub fn prove(run: &Run, task: &Task) -> Result<(Proof, Vec<Diagnostic>), Vec<Diagnostic>> {
    let pulses = &run.pulses;
    if pulses.is_empty() {
        let found = Diagnostic::error(Rule::Lost, "the program makes no pulse");
        return Err(vec![found.help("write the program anew")]);
    }
    let mut findings = Findings::default();
    findings_of_block(run, task, &mut findings);
    travels(run, task, &mut findings);
    let (deeper, slope) = depth(task.lens, task.machine.laser.beam, task.index);
    let (cloud, apart_by) = side_by_side(task);
    let task = &Task { cloud: &cloud, ..*task };
    let shift = |(place, block): (DVec3, u32)| {
        place + DVec3::X * (f64::from(apart_by) * 1e-3 * f64::from(block))
    };
    let places: Vec<DVec3> = places(run, task).into_iter().map(shift).collect();
    let (order, across, along) = matched(pulses, &places, task, &mut findings);
    let (nearest, too_close) = distances(&places, task.spacing);
    let apart = apart(nearest, too_close, pulses, task.spacing, deeper);
    let shadowed = shadows(&order, task.cloud, slope, 500.0 * task.lens.crack[0]);
    let hidden = finding_of_shadows(&shadowed, &order, pulses, task);
    apart.into_iter().chain(hidden).for_each(|found| findings.push(found));
    let ticks = steps(run, task.machine).into_par_iter().sum::<u64>();
    let proof = Proof {
        pulses: pulses.len() as u64,
        across,
        along,
        nearest,
        too_close,
        shadowed: shadowed.len() as u64,
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
    pulses: &[Pulse],
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
    let line = pulses[below as usize].line;
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
pub fn steps(run: &Run, machine: &Machine) -> Vec<u64> {
    let clock = machine.clock();
    let units = machine.coordinates().map(|of| of.steps());
    let in_steps = |at: [f64; 3]| [0, 1, 2].map(|axis| at[axis] * units[axis]);
    let step = |from: [f64; 3], to: [f64; 3]| {
        let [from, to] = [from, to].map(|at| in_steps(at).map(|value| value.round() as i32));
        u64::from(clock.step(from, to))
    };
    let straight = |pair: &[Pulse]| match pair[1].passed {
        0 => step(pair[0].at, pair[1].at),
        passed => u64::from(passed),
    };
    let mut ticks: Vec<u64> = run.pulses.iter().take(1).map(|_| 1).collect();
    ticks.par_extend(run.pulses.par_windows(2).map(straight));
    // Into a motion at constant speed the axes gain it, out of it they brake.
    let late = machine.late();
    let mut ends: Vec<(usize, [f64; 3], [f64; 3])> = Vec::new();
    for Motion { first, count, speed } in &run.motions {
        let (before, after) = (*first as usize, (first + count) as usize);
        let speed = in_steps(*speed);
        match ends.last_mut().filter(|end| end.0 == before) {
            Some(end) => end.2 = speed,
            None => ends.push((before, [0.0; 3], speed)),
        }
        ends.push((after, speed, [0.0; 3]));
    }
    let between = |next: usize| -> Option<(Pulse, Pulse)> {
        Some((*run.pulses.get(next.checked_sub(1)?)?, *run.pulses.get(next)?))
    };
    for (next, leaves, enters) in ends {
        let Some((from, to)) = between(next) else { continue };
        // At the trigger, which is a little before.
        let led = |at: [f64; 3], speed: [f64; 3]| {
            let at = in_steps(at);
            [0, 1, 2].map(|axis| at[axis] - speed[axis] * late)
        };
        let (a, b) = (led(from.at, leaves), led(to.at, enters));
        let way = [0, 1, 2].map(|axis| b[axis].round() - a[axis].round());
        ticks[next] = clock.between(way, leaves, enters);
    }
    // From field to field the stage moves, while the mirrors lead the beam to its place in the next one.
    for pair in run.fields.windows(2) {
        let ((_, _, from), (next, _, to)) = (pair[0], pair[1]);
        let Some((before, after)) = between(next as usize) else { continue };
        let inside = |at: [f64; 3], center: [f64; 2]| [at[0] - center[0], at[1] - center[1], at[2]];
        let mirrors = step(inside(before.at, from), inside(after.at, to));
        ticks[next as usize] = mirrors.max(machine.carried(from, to));
    }
    for stops in run.stops.chunk_by(|a, b| a.pulses == b.pulses) {
        let next = stops[0].pulses as usize;
        let Some((before, after)) = between(next) else { continue };
        // After the first pulse every axis has been sent to a place.
        let known = stops.iter().filter_map(|stop| match stop.at {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        });
        let chain: Vec<[f64; 3]> =
            std::iter::once(before.at).chain(known).chain([after.at]).collect();
        ticks[next] = chain.windows(2).map(|pair| step(pair[0], pair[1])).sum();
    }
    ticks
}

/// The nearest two of `places` (mm), and how many pairs are nearer than `spacing` (mm). Places beyond 2 m are left out: they are stray.
fn distances(places: &[DVec3], spacing: f64) -> (Option<Pair>, u64) {
    let far = |place: &DVec3| cloud::point(*place);
    let known: Vec<(u32, Point)> =
        places.iter().zip(0..).filter_map(|(place, i)| Some((i, far(place)?))).collect();
    let points: Vec<Point> = known.iter().map(|(_, point)| *point).collect();
    // Places are up to a µm from their points in each axis.
    let grid = Grid::new(&points, (2e3 * spacing).ceil() as i64 + 2);
    let of = |&(i, point): &(u32, Point)| {
        let (mut nearest, mut close) = ((f64::MAX, 0, 0), 0u64);
        for j in grid.near(point).map(|near| known[near as usize].0).filter(|j| *j > i) {
            let distance = places[i as usize].distance(places[j as usize]);
            if distance < nearest.0 {
                nearest = (distance, i, j);
            }
            close += u64::from(distance < spacing - ROUNDING);
        }
        (nearest, close)
    };
    let less = |a: (f64, u32, u32), b: (f64, u32, u32)| match a.0.total_cmp(&b.0) {
        std::cmp::Ordering::Greater => b,
        std::cmp::Ordering::Less => a,
        std::cmp::Ordering::Equal if (a.1, a.2) <= (b.1, b.2) => a,
        std::cmp::Ordering::Equal => b,
    };
    let join = |a: ((f64, u32, u32), u64), b: ((f64, u32, u32), u64)| (less(a.0, b.0), a.1 + b.1);
    let (nearest, close) = known.par_iter().map(of).reduce(|| ((f64::MAX, 0, 0), 0), join);
    let pair = |(distance, a, b)| Pair { points: [a, b], distance };
    ((nearest.0 <= 2.0 * spacing).then(|| pair(nearest)), close)
}

/// Part of a mm that sums of coordinates lose.
const ROUNDING: f64 = 1e-9;

/// What is said of pulses that are too close: an error beyond what whole µm of the drive take, `deeper` µm of depth.
fn apart(
    nearest: Option<Pair>,
    too_close: u64,
    pulses: &[Pulse],
    spacing: f64,
    deeper: f64,
) -> Option<Diagnostic> {
    let Pair { points: [a, b], distance } = nearest.filter(|_| too_close > 0)?;
    let [first, second] = [a, b].map(|i| pulses[i as usize].line);
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
    let pulses = run.pulses.iter().enumerate().map(|(i, pulse)| {
        let begun = run.fields.partition_point(|(first, _, _)| *first as usize <= i);
        let center = begun.checked_sub(1).map_or([0.0; 2], |field| run.fields[field].2);
        let [x, y, z] = pulse.at;
        // What a subtraction leaves of whole µm.
        let whole =
            |value: f64| if run.fields.is_empty() { value } else { (value * 1e6).round() / 1e6 };
        (pulse.line, [whole(x - center[0]), whole(y - center[1]), z].map(Some))
    });
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
            let Pulse { line, at, .. } = run.pulses[pulse as usize];
            let beyond = |axis: usize| at[axis] + side * gained[axis] / coordinates[axis].steps();
            (line, [0, 1, 2].map(|axis| Some(beyond(axis))))
        })
    });
    let all: Vec<(u32, [Option<f64>; 3])> = pulses.chain(stops).chain(turned).collect();
    for (i, of) in coordinates.into_iter().enumerate().filter(|(_, of)| !of.endless) {
        let (name, [low, high]) = (of.word, of.axis.travel);
        let unit = if of.turns { "°" } else { "mm" };
        let beyond = all.iter().filter_map(|(line, at)| Some((*line, at[i]?)));
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
    pulses: &[Pulse],
    places: &[DVec3],
    task: &Task,
    findings: &mut Findings,
) -> (Vec<u32>, f64, f64) {
    let [radius, height] = task.lens.crack.map(|size| 500.0 * size);
    let grid = Grid::new(task.cloud, radius.max(height).ceil() as i64);
    let nearest = |place: &DVec3| {
        let place = place.to_array().map(|value| value * 1e3);
        let rounded = place.map(|value| value.round() as i32);
        let way = |j: u32| {
            let point = task.cloud[j as usize].map(f64::from);
            let (x, y, z) = (place[0] - point[0], place[1] - point[1], place[2] - point[2]);
            (x.hypot(y), z.abs())
        };
        let inside = grid.near(rounded).map(|j| (way(j), j)).filter(|((across, along), _)| {
            (across / radius).powi(2) + (along / height).powi(2) <= 1.0
        });
        let far = |((across, along), j): &((f64, f64), u32)| (across * across + along * along, *j);
        inside.min_by(|a, b| far(a).0.total_cmp(&far(b).0).then(a.1.cmp(&b.1)))
    };
    let found: Vec<_> = places.par_iter().map(nearest).collect();
    let mut by: Vec<u32> = vec![NONE; task.cloud.len()];
    let mut order = Vec::with_capacity(pulses.len());
    let (mut most_across, mut most_along) = (0.0f64, 0.0f64);
    for (i, (pulse, found)) in pulses.iter().zip(found).enumerate() {
        let Some(((across, along), j)) = found else {
            let DVec3 { x, y, z } = places[i];
            let message =
                format!("the pulse at {x:.3} {y:.3} {z:.3} mm lies in the crack of no point");
            findings.push(
                Diagnostic::error(Rule::Stray, message)
                    .line(pulse.line)
                    .help("write the program anew"),
            );
            continue;
        };
        (most_across, most_along) = (most_across.max(across), most_along.max(along));
        if by[j as usize] != NONE {
            let first = pulses[by[j as usize] as usize].line;
            let message = format!("the point of this pulse was made on line {first} already");
            findings.push(
                Diagnostic::error(Rule::Twice, message)
                    .line(pulse.line)
                    .help("write the program anew"),
            );
            continue;
        }
        by[j as usize] = i as u32;
        order.push(j);
    }
    let lost = by.iter().filter(|by| **by == NONE).count();
    if let Some(first) = by.iter().position(|by| *by == NONE) {
        let [x, y, z] = task.cloud[first].map(|value| f64::from(value) * 1e-3);
        let message = format!("{lost} points get no pulse, one of them at {x:.3} {y:.3} {z:.3} mm");
        findings.push(Diagnostic::error(Rule::Lost, message).help("write the program anew"));
    }
    (order, most_across * 1e-3, most_along * 1e-3)
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

/// The places in the order of points that are shadowed, each with that of the first point that shadows it.
fn shadows(order: &[u32], cloud: &[Point], slope: f64, radius: f64) -> Vec<(u32, u32)> {
    let mut points: Vec<(Point, u32)> =
        order.iter().enumerate().map(|(when, &i)| (cloud[i as usize], when as u32)).collect();
    if points.is_empty() {
        return Vec::new();
    }
    let tree = Node::new(&mut points);
    let shadower = |(when, &i): (usize, &u32)| {
        let by = tree.shadower(cloud[i as usize], when as u32, slope, radius)?;
        Some((when as u32, by))
    };
    order.par_iter().enumerate().filter_map(shadower).collect()
}
