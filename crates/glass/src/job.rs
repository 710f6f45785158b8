//! A job: bodies and points placed in a block, made into a cloud, ordered, written, read back and proven.

use crate::chain::Chain;
use crate::cloud::{self, Distances, Point};
use crate::curve::Layers;
use crate::fill::{self, Fill, Filling, Left, Shells};
use crate::fly::{self, Run};
use crate::machine::{Lens, Machine};
use crate::material::Material;
use crate::mesh::{self, Health, Mesh, Shape};
use crate::optics::{self, Beam, Cut, Ray};
use crate::order::{self, Effort, Shadow};
use crate::origin::{Origins, Placed};
use crate::picture::{Picture, Sheet};
use crate::proof::{self, Proof};
use crate::sample::Apart;
use crate::scenario::{Blocks, Scenario};
use crate::watch::Watch;
use crate::{control, post, stitch, weld};
use glam::{DMat3, DVec3};
use program::{Diagnostic, Rule};
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;

/// In which order points are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Legal, in the fewest ticks that are found.
    Fastest,
    /// `Sort Kdz` of the source, with K for points above and below.
    Kdz(f64, f64),
    /// `Sort by layers` of the source, with the height of a layer, mm; without, the spacing.
    Layers(Option<f64>),
    /// In motion, on a polar machine.
    Scenario(Scenario),
}

/// How a body lies in its block.
#[derive(Clone, Copy, Debug)]
pub struct Placing {
    /// The block's sides along X, Y and Z, mm.
    pub block: [f64; 3],
    /// How far all points stay from its faces, mm.
    pub margin: f64,
    /// By how much it is scaled; without, as large as fits within the margins where `fit` is set, else as it is.
    pub scale: Option<f64>,
    /// Whether it is scaled to fit.
    pub fit: bool,
    /// Turned about X, then Y, then Z, degrees.
    pub turn: [f64; 3],
    /// Mirrored along these axes, first of all.
    pub mirror: [bool; 3],
    /// Moved from the middle of the block, last of all, mm.
    pub shift: [f64; 3],
}

/// What a job takes besides its bodies.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How they lie.
    pub placing: Placing,
    /// Bodies that lie by themselves, without regard to the others: their numbers, from 0, and how. Block and margin are those of
    /// `placing`.
    pub alone: Vec<(usize, Placing)>,
    /// How many equal blocks are made.
    pub blocks: u32,
    /// Focal length of the lens, mm.
    pub focal: f64,
    /// Smallest distance of points, mm; without, that of the lens.
    pub spacing: Option<f64>,
    /// How bodies become points.
    pub filling: Filling,
    /// Copies of the surface within bodies, of [`Fill::Surface`].
    pub shells: Shells,
    /// How often curves are repeated, and where points lie along them.
    pub layers: Layers,
    /// By which ray the focus is found.
    pub ray: Ray,
    /// The order.
    pub order: Order,
    /// How much is tried for it.
    pub effort: Effort,
    /// Chooses among clouds that are as good.
    pub seed: u64,
    /// Whether a program that shadows points passes.
    pub accept_shadowed: bool,
}

/// What is reported of a job.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Points of the cloud.
    pub points: u64,
    /// Points that were too close to others and left out.
    pub welded: u64,
    /// What of the bodies became no points.
    pub left: Left,
    /// Where the cloud lies, mm.
    pub from: [f64; 3],
    /// To where.
    pub to: [f64; 3],
    /// By how much the bodies were scaled that lie in one frame.
    pub scale: f64,
    /// Bodies that lie by themselves.
    pub alone: Vec<Alone>,
    /// Smallest distance asked for, mm.
    pub spacing: f64,
    /// What it is.
    pub distances: Distances,
    /// What is unusual about each body; of points nothing.
    pub health: Vec<Health>,
    /// Index of refraction.
    pub index: f64,
    /// The ray by which the focus is found.
    pub ray: Ray,
    /// How much deeper the deepest point lies when the other ray is meant, mm in the glass.
    pub rays_apart: f64,
    /// Where side faces cut the beam.
    pub cut: Cut,
    /// Equal blocks, each with all points.
    pub blocks: u32,
    /// Energy of a pulse in the glass of each block, mJ; of a laser that states its energy only.
    pub energy: Option<f64>,
    /// Fields of a scanner.
    pub fields: u64,
    /// Pulses in motion at constant speed.
    pub in_motion: u64,
    /// How far the farthest point was moved so that a motion passes it, mm, and how many points fell together; of a scenario only.
    pub moved: Option<(f64, u64)>,
    /// The part of the block, seen from above, that the arm does not reach; of a polar machine only.
    pub unreachable: Option<f64>,
    /// Ticks as planned; of a program that was not made here none.
    pub planned_ticks: Option<u64>,
    /// Ticks that any order takes at least, under the shadow rule; not found for more than a million points, for pulses in motion,
    /// fields and several blocks on a table.
    pub least_ticks: Option<u64>,
    /// Rules that were let pass, and broken.
    pub accepted: Vec<Rule>,
    /// What the proof found.
    pub proof: Proof,
}

/// Where a body lies that is placed by itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Alone {
    /// Its number, from 1.
    pub body: usize,
    /// By how much it was scaled.
    pub scale: f64,
    /// Where it begins, mm.
    pub from: [f64; 3],
    /// Where it ends, mm.
    pub to: [f64; 3],
}

/// A job that is done.
#[derive(Debug)]
pub struct Made {
    /// The program.
    pub text: Vec<u8>,
    /// The cloud in the frame of the block, µm; of a program that was made here in its order.
    pub cloud: Vec<Point>,
    /// What the virtual machine read.
    pub run: control::Run,
    /// The report.
    pub report: Report,
    /// Whether it is proven.
    pub proven: bool,
    /// What is worth knowing, and what is wrong.
    pub findings: Vec<Diagnostic>,
}

fn error(rule: Rule, message: String, help: &str) -> Vec<Diagnostic> {
    vec![Diagnostic::error(rule, message).help(help)]
}

/// Makes the program of `shapes` in one block of `material` for `machine`.
///
/// # Errors
/// Where the settings cannot be, the body does not fit, or the machine cannot hold or reach the points.
pub fn make(
    shapes: Vec<Shape>,
    material: &Material,
    machine: &Machine,
    settings: &Settings,
) -> Result<Made, Vec<Diagnostic>> {
    make_for(shapes, material, machine, settings, &())
}

/// As [`make`], for who may end the work.
///
/// # Errors
/// As there, or that it was ended.
pub fn make_for(
    shapes: Vec<Shape>,
    material: &Material,
    machine: &Machine,
    settings: &Settings,
    watch: &dyn Watch,
) -> Result<Made, Vec<Diagnostic>> {
    let mut job = Job::new(shapes, material, machine, settings, watch)?;
    watch.step("ordering");
    let Ordered { axes, runs, fields, least } = job.order();
    watch.go_on()?;
    let clock = machine.clock();
    let mut planned = 1 + fly::ticks(&axes, &runs, [0.0; 3], machine.late(), &clock);
    for pair in fields.windows(2) {
        let ((_, from), (next, to)) = (pair[0], pair[1]);
        let mm = |at: [i32; 2]| at.map(|value| f64::from(value) * 1e-3);
        let [before, after] = [(next - 1, from), (next, to)].map(|(i, center)| {
            let [x, y, z] = axes[i];
            [x - center[0], y - center[1], z]
        });
        let mirrors = u64::from(clock.step(before, after));
        planned += mirrors.max(machine.carried(mm(from), mm(to)));
        planned -= u64::from(clock.step(axes[next - 1], axes[next]));
    }
    let text =
        post::write(&axes, &runs, &fields, machine, (settings.placing.block, settings.blocks));
    drop(axes);
    job.judge(text, Some((planned, least)))
}

/// Proves the program `text`, also one edited by hand, against `shapes` in one block of `material`: the cloud is made anew.
///
/// # Errors
/// As [`make`]; or where the machine would not take the program.
pub fn prove(
    text: Vec<u8>,
    shapes: Vec<Shape>,
    material: &Material,
    machine: &Machine,
    settings: &Settings,
) -> Result<Made, Vec<Diagnostic>> {
    prove_for(text, shapes, material, machine, settings, &())
}

/// As [`prove`], for who may end the work.
///
/// # Errors
/// As there, or that it was ended.
pub fn prove_for(
    text: Vec<u8>,
    shapes: Vec<Shape>,
    material: &Material,
    machine: &Machine,
    settings: &Settings,
    watch: &dyn Watch,
) -> Result<Made, Vec<Diagnostic>> {
    Job::new(shapes, material, machine, settings, watch)?.judge(text, None)
}

/// Where the axes stand at each pulse, in steps; which pulses are fired in motion; the first pulse and the middle of each field.
struct Ordered {
    axes: Vec<Point>,
    runs: Vec<Run>,
    fields: Vec<(usize, [i32; 2])>,
    /// Ticks of any order at least.
    least: Option<u64>,
}

/// A cloud in its block, and what was found of it.
struct Job<'m> {
    cloud: Vec<Point>,
    welded: u64,
    left: Left,
    scale: f64,
    alone: Vec<Alone>,
    spacing: f64,
    micrometres: u32,
    apart: Apart,
    moved: Option<(f64, u64)>,
    health: Vec<Health>,
    lens: Lens,
    beam: Beam,
    material: &'m Material,
    machine: &'m Machine,
    settings: &'m Settings,
    watch: &'m dyn Watch,
    findings: Vec<Diagnostic>,
}

impl<'m> Job<'m> {
    fn new(
        shapes: Vec<Shape>,
        material: &'m Material,
        machine: &'m Machine,
        settings: &'m Settings,
        watch: &'m dyn Watch,
    ) -> Result<Job<'m>, Vec<Diagnostic>> {
        watch.go_on()?;
        let Distance { lens, beam, spacing, micrometres, apart } =
            Distance::of(material, machine, settings)?;
        on_machine(machine, settings)?;
        enough_energy(material, machine, &lens, settings)?;
        let Placing { block, margin, .. } = settings.placing;
        let room = DVec3::from_array(block) - 2.0 * margin;
        let (mut parts, scale, alone) = placed(shapes, room, apart, settings)?;
        let mut findings = std::mem::take(&mut parts.warnings);
        findings.extend(parts.health.iter().filter_map(unhealthy));
        watch.go_on()?;
        let (cloud, welded, left) = discretise(&parts, settings, apart, watch)?;
        watch.go_on()?;
        findings.extend(left_out(&left, &settings.filling));
        if let Some(chain) = &machine.chain {
            chain_reaches(&cloud, chain, machine)?;
        }
        if let Some(blocks) = blocks_of(machine, settings) {
            within_reach(&cloud, &blocks)?;
        }
        let health = parts.health;
        let turns = machine.polar.map_or(1, |_| u64::from(settings.blocks));
        let pulses = cloud.len() as u64 * turns;
        if pulses > watch.most_pulses() {
            return Err(too_many(pulses as f64, watch.most_pulses()));
        }
        if pulses > machine.program.points {
            let message = format!(
                "{pulses} points are more than the {} that {} holds",
                machine.program.points, machine.title
            );
            let help = "take a larger --spacing or a smaller --scale";
            return Err(error(Rule::Points, message, help));
        }
        Ok(Job {
            cloud,
            welded,
            left,
            scale,
            alone,
            spacing,
            micrometres,
            apart,
            moved: None,
            health,
            lens,
            beam,
            material,
            machine,
            settings,
            watch,
            findings,
        })
    }

    /// Puts the cloud in the order of its pulses.
    fn order(&mut self) -> Ordered {
        let Job { lens, beam, machine, settings, watch, .. } = *self;
        let clock = machine.clock();
        let on_table = blocks_of(machine, settings);
        let top = settings.placing.block[2] * 1e3;
        let drive = beam.drive(settings.ray);
        let down = |point: &Point| ((f64::from(point[2]) - top) * drive).round() as i32;
        if let (Some(blocks), Order::Scenario(scenario)) = (&on_table, settings.order) {
            let (step, margin) = (self.apart.rounded(), settings.placing.margin);
            let plan = blocks.plan(&self.cloud, scenario, step, margin, &clock);
            self.moved = Some((plan.moved, plan.merged));
            self.cloud = plan.cloud;
            let pulses = plan.axes.iter().zip(&plan.points);
            let at = |(&[a, b], &i): (&[i32; 2], &u32)| [a, b, down(&self.cloud[i as usize])];
            let axes = pulses.map(at).collect();
            return Ordered { axes, runs: plan.runs, fields: Vec::new(), least: None };
        }
        let axes: Vec<Point> = match &on_table {
            Some(blocks) => {
                let poses = blocks.poses(&self.cloud);
                poses.iter().zip(&self.cloud).map(|(&[a, b], at)| [a, b, down(at)]).collect()
            }
            None => {
                let posed = |at: &Point| {
                    let [a, b] = machine
                        .chain
                        .and_then(|chain| positions(at, &chain, machine))
                        .unwrap_or([at[0], at[1]]);
                    [a, b, down(at)]
                };
                self.cloud.par_iter().map(posed).collect()
            }
        };
        let shadow = Shadow {
            slope: beam.slope_in_glass() * WIDER,
            radius: 0.5 * lens.crack[0] * 1e3 * WIDER,
        };
        let cloud = &self.cloud;
        let is_one = on_table.as_ref().is_none_or(|blocks| blocks.count == 1);
        let has_bound =
            is_one && machine.stage.is_none() && !machine.program.runs && cloud.len() <= MOST_BOUND;
        // The first point's pulse counts too.
        let least =
            has_bound.then(|| 1 + order::bound_for(cloud, &axes, Some(shadow), &clock, watch));
        let mut fields = Vec::new();
        let order = match settings.order {
            _ if machine.stage.is_some() => {
                let (all, spacing) = (machine.coordinates(), f64::from(self.micrometres));
                let size = [0, 1].map(|axis: usize| {
                    let [low, high] = all[axis].axis.travel;
                    1e3 * (high - low)
                });
                let mut order: Vec<u32> = Vec::with_capacity(cloud.len());
                for field in stitch::fields(cloud, size, shadow, spacing) {
                    fields.push((order.len(), field.center));
                    let own = |all: &[Point]| -> Vec<Point> {
                        field.points.iter().map(|&i| all[i as usize]).collect()
                    };
                    let (cloud, axes, effort) = (own(cloud), own(&axes), settings.effort);
                    let within = order::fastest_for(&cloud, &axes, shadow, &clock, effort, watch);
                    order.extend(within.iter().map(|&i| field.points[i as usize]));
                }
                order
            }
            Order::Fastest => {
                order::fastest_for(cloud, &axes, shadow, &clock, settings.effort, watch)
            }
            // `on_machine` has refused it elsewhere.
            Order::Scenario(_) => (0..cloud.len() as u32).collect(),
            Order::Kdz(up, down) => order::kdz(cloud, up, down),
            Order::Layers(height) => {
                let height = height.or(settings.spacing).unwrap_or(lens.spacing);
                order::layers(cloud, (height * 1e3).round().max(1.0) as u32)
            }
        };
        let own =
            |all: &[Point]| -> Vec<Point> { order.iter().map(|&i| all[i as usize]).collect() };
        let own_axes = own(&axes);
        drop(axes);
        self.cloud = own(cloud);
        let mut axes = own_axes;
        let count = axes.len();
        for (block, blocks) in
            on_table.iter().flat_map(|blocks| (1..blocks.count).map(move |i| (i, blocks)))
        {
            let turned = blocks.turned(block);
            axes.extend_from_within(..count);
            axes[count * block as usize..].iter_mut().for_each(|at| at[1] += turned);
        }
        let runs = if machine.program.runs {
            fly::runs(&axes, machine.coordinates().map(|of| of.steps()), machine.late(), &clock)
        } else {
            Vec::new()
        };
        Ordered { axes, runs, fields, least }
    }

    /// Reads the program back and compares it with the cloud; `ticks` are those of the order that was written, and its bound.
    fn judge(
        mut self,
        text: Vec<u8>,
        ticks: Option<(u64, Option<u64>)>,
    ) -> Result<Made, Vec<Diagnostic>> {
        let planned = ticks.map(|(planned, _)| planned);
        let Job { spacing, beam, material, machine, settings, moved, watch, .. } = self;
        watch.step("proving");
        let (cloud, mut findings) = (&self.cloud, std::mem::take(&mut self.findings));
        let placing = &settings.placing;
        let cut = optics::cut(cloud, placing.block, beam.slope_in_glass());
        findings.extend(cut_off(cut, placing.margin));
        let distances = cloud::distances(cloud, i64::from(self.micrometres));
        if distances.too_close > 0 {
            let message =
                format!("{} pairs of points are nearer than {spacing} mm", distances.too_close);
            return Err(error(Rule::Spacing, message, MISTAKE));
        }
        let task = task(cloud, material, machine, settings)?;
        watch.go_on()?;
        let run = control::read(&text, machine)?;
        watch.go_on()?;
        let (proof, found) = proof::prove_for(&run, &task, watch)?;
        findings.extend(found);
        if let Some(planned) = planned.filter(|planned| *planned != proof.ticks) {
            let message =
                format!("the program takes {} ticks, planned were {planned}", proof.ticks);
            findings.extend(error(Rule::Ticks, message, MISTAKE));
        }
        let (low, high) = cloud::bounds(cloud).unwrap_or_default();
        findings.extend(small(cloud::place(low), cloud::place(high), placing));
        let deepest = placing.block[2] - f64::from(low[2]) * 1e-3;
        let accepts = settings.accept_shadowed && proof.shadowed > 0;
        let report = Report {
            points: cloud.len() as u64,
            welded: self.welded,
            left: self.left,
            from: low.map(|value| f64::from(value) / 1e3),
            to: high.map(|value| f64::from(value) / 1e3),
            scale: self.scale,
            alone: self.alone,
            spacing,
            distances,
            health: self.health,
            index: material.index,
            ray: settings.ray,
            rays_apart: deepest * beam.aberration(),
            cut,
            blocks: settings.blocks,
            energy: energy(material, machine, settings),
            fields: run.fields.len() as u64,
            in_motion: run.motions.iter().map(|motion| u64::from(motion.count)).sum(),
            moved,
            unreachable: machine.polar.map(|table| table.with(placing.block[0]).unreachable(200)),
            planned_ticks: planned,
            least_ticks: ticks.and_then(|(_, least)| least),
            accepted: if accepts { vec![Rule::Shadowed] } else { vec![] },
            proof,
        };
        let proven = !findings.iter().any(Diagnostic::is_error);
        Ok(Made { text, cloud: self.cloud, run, report, proven, findings })
    }
}

/// What the programs of a job are to make.
fn task<'t>(
    cloud: &'t [Point],
    material: &Material,
    machine: &'t Machine,
    settings: &Settings,
) -> Result<proof::Task<'t>, Vec<Diagnostic>> {
    let lens = machine.lens(settings.focal).map_err(|found| vec![*found])?;
    Ok(proof::Task {
        cloud,
        machine,
        lens,
        index: material.index,
        block: settings.placing.block,
        blocks: settings.blocks,
        spacing: settings.spacing.unwrap_or(lens.spacing),
        accept_shadowed: settings.accept_shadowed,
    })
}

/// Where the beam of a program that is made comes to its focus.
///
/// # Errors
/// The machine has no such lens.
pub fn focus(
    made: &Made,
    material: &Material,
    machine: &Machine,
    settings: &Settings,
) -> Result<proof::Focus, Vec<Diagnostic>> {
    Ok(proof::Focus::new(&task(&made.cloud, material, machine, settings)?))
}

/// Where the pulses of a program that is made lie in the glass, in their order, mm.
///
/// # Errors
/// The machine has no such lens.
pub fn places(
    made: &Made,
    material: &Material,
    machine: &Machine,
    settings: &Settings,
) -> Result<Vec<DVec3>, Vec<Diagnostic>> {
    let task = task(&made.cloud, material, machine, settings)?;
    let glass = proof::Glass::new(&made.run, &task);
    Ok((0..glass.len()).map(|pulse| glass.place(pulse).0).collect())
}

/// The blocks on the table of a polar machine.
fn blocks_of<'m>(machine: &'m Machine, settings: &Settings) -> Option<Blocks<'m>> {
    let (block, count) = (settings.placing.block, settings.blocks);
    machine.polar.map(|table| Blocks { machine, table, block, count })
}

/// The energy of a pulse in the glass of each block, mJ: beams that are open share it evenly.
fn energy(material: &Material, machine: &Machine, settings: &Settings) -> Option<f64> {
    let beams = if machine.polar.is_some() { 1 } else { settings.blocks };
    Some(machine.laser.energy? * material.passes() / f64::from(beams))
}

/// Whether a pulse has what a crack of the lens needs, where both are stated.
fn enough_energy(
    material: &Material,
    machine: &Machine,
    lens: &Lens,
    settings: &Settings,
) -> Result<(), Vec<Diagnostic>> {
    let (Some(own), Some([least, most])) = (energy(material, machine, settings), lens.energy)
    else {
        return Ok(());
    };
    if (least..=most).contains(&own) {
        return Ok(());
    }
    let message = format!(
        "a pulse has {own:.3} mJ in the glass of each block; cracks of f = {} mm take {least} to {most} mJ",
        lens.focal
    );
    let help = if own < least {
        "open fewer beams: take fewer --blocks"
    } else {
        "weaken the beam: laser.energy"
    };
    Err(error(Rule::GlassBlock, message, help))
}

/// Whether the machine has what is asked for besides points.
fn on_machine(machine: &Machine, settings: &Settings) -> Result<(), Vec<Diagnostic>> {
    let most = machine.blocks();
    if !(1..=most).contains(&settings.blocks) {
        let message =
            format!("{} has places for {most} blocks, not {}", machine.title, settings.blocks);
        return Err(error(Rule::GlassBlock, message, "take fewer --blocks"));
    }
    if let Some(message) = machine.refuses(settings.placing.block, settings.blocks) {
        return Err(error(Rule::GlassBlock, message, "take smaller blocks"));
    }
    if machine.stage.is_some() && settings.order != Order::Fastest {
        let message = format!("{} goes from field to field in an order of its own", machine.title);
        return Err(error(Rule::GlassBlock, message, "leave --order out"));
    }
    if matches!(settings.order, Order::Scenario(_))
        && (machine.polar.is_none() || !machine.program.runs)
    {
        let message = match machine.polar {
            Some(_) => format!("{} does not fire in motion: `runs` is not set", machine.title),
            None => format!("{} has no arm and no turning table", machine.title),
        };
        return Err(error(Rule::GlassBlock, message, "take another --order, or a polar machine"));
    }
    Ok(())
}

/// The steps of both declared axes at a point.
fn positions(at: &Point, chain: &Chain, machine: &Machine) -> Option<[i32; 2]> {
    let [a, b, _] = machine.coordinates();
    let found = chain.inverse(cloud::place(*at).truncate(), [a.axis.travel, b.axis.travel])?;
    Some([(found[0] * a.steps()).round() as i32, (found[1] * b.steps()).round() as i32])
}

/// All points lie where the declared axes bring the beam.
fn chain_reaches(cloud: &[Point], chain: &Chain, machine: &Machine) -> Result<(), Vec<Diagnostic>> {
    let missed = |at: &&Point| positions(at, chain, machine).is_none();
    let Some(first) = cloud.par_iter().find_first(missed) else { return Ok(()) };
    let count = cloud.par_iter().filter(missed).count();
    let message = format!(
        "the axes a and b do not bring the beam to {count} points within their travels, the first one at {:.3} mm",
        cloud::place(*first)
    );
    Err(error(Rule::Travel, message, "take a smaller block, move the body, or look at chain.near"))
}

/// All points lie within the reach of the arm.
fn within_reach(cloud: &[Point], blocks: &Blocks) -> Result<(), Vec<Diagnostic>> {
    let beyond: Vec<&Point> = cloud.iter().filter(|point| !blocks.reaches(**point)).collect();
    let Some(first) = beyond.first() else { return Ok(()) };
    let polar = blocks.table.with(blocks.block[0]);
    let message = format!(
        "the arm does not reach {} points, the first one at {:.3} mm; it misses {:.1} % of the block",
        beyond.len(),
        cloud::place(**first),
        100.0 * polar.unreachable(200)
    );
    let help = "move the body away from the table's axis (--move 0,5,0), or take a longer arm: polar.arm no shorter than polar.distance - polar.offset";
    Err(error(Rule::Travel, message, help))
}

/// The way out of what cannot be.
const MISTAKE: &str = "this is a mistake in Toolpost: report it with the body";

/// mm in an inch.
const INCH: f64 = 25.4;

/// A body that takes less than this part of the room is pointed out.
const SMALL: f64 = 0.04;

/// Points out a body that is so small that its file is likely in inches.
fn small(low: DVec3, high: DVec3, placing: &Placing) -> Option<Diagnostic> {
    let room = DVec3::from_array(placing.block) - 2.0 * placing.margin;
    let part = ((high - low) / room).max_element();
    let message = format!(
        "the body is only {:.3} mm large, {:.1} % of the room",
        (high - low).max_element(),
        100.0 * part
    );
    let found = Diagnostic::warning(Rule::Small, message);
    (part < SMALL).then(|| {
        found
            .help(format!("if its file is in inches, --scale {INCH}; --fit takes the largest size"))
    })
}

/// The cone that the planning keeps is wider by this part than the rule's, so that rounding breaks nothing.
const WIDER: f64 = 1.0 + 1e-9;

fn check(placing: &Placing, lens: &Lens) -> Result<(), Vec<Diagnostic>> {
    let Placing { block, margin, .. } = *placing;
    if block[2] > lens.block {
        let message = format!(
            "the block is {} mm high; f = {} mm is for {} mm at most",
            block[2], lens.focal, lens.block
        );
        return Err(error(Rule::GlassBlock, message, "take a lens of a longer focal length"));
    }
    if block.iter().any(|side| *side <= 2.0 * margin) {
        let message = format!("a margin of {margin} mm leaves nothing of a block of {block:?} mm");
        return Err(error(Rule::GlassBlock, message, "take a smaller --margin"));
    }
    Ok(())
}

fn spacing_in_micrometres(spacing: f64, lens: &Lens) -> Result<u32, Vec<Diagnostic>> {
    // A spacing that is no whole number of µm counts as the next larger one.
    let micrometres = (spacing * 1e3 - 1e-6).ceil();
    if spacing < lens.spacing - 1e-9 || spacing.is_nan() {
        let message = format!(
            "{spacing} mm are less than the {} mm that cracks of f = {} mm need",
            lens.spacing, lens.focal
        );
        return Err(error(
            Rule::Spacing,
            message,
            "nearer cracks join and break the glass: take a larger --spacing, or a shorter lens",
        ));
    }
    if micrometres > 1e5 {
        let message = format!("a spacing of {spacing} mm is more than 100 mm");
        return Err(error(Rule::Spacing, message, "lengths are mm"));
    }
    Ok(micrometres as u32)
}

/// How near to each other points may be, and what says so.
struct Distance {
    lens: Lens,
    beam: Beam,
    /// mm.
    spacing: f64,
    micrometres: u32,
    apart: Apart,
}

impl Distance {
    fn of(
        material: &Material,
        machine: &Machine,
        settings: &Settings,
    ) -> Result<Distance, Vec<Diagnostic>> {
        let lens = machine.lens(settings.focal).map_err(|found| vec![*found])?;
        check(&settings.placing, &lens)?;
        let spacing = settings.spacing.unwrap_or(lens.spacing);
        let micrometres = spacing_in_micrometres(spacing, &lens)?;
        let beam = Beam::new(&lens, machine.laser.beam, material.index);
        // Two heights are rounded by half a µm of drive each.
        // Angles are rounded too: less than a µm of the place of two points.
        let more = u32::from(machine.polar.is_some() || machine.chain.is_some());
        let apart = Apart { spacing: micrometres + more, lost: 1.0 / beam.drive(Ray::Marginal) };
        Ok(Distance { lens, beam, spacing, micrometres, apart })
    }
}

/// What of `shapes` is where in the block, as a job of the same settings puts them there.
///
/// # Errors
/// As [`make`].
pub fn origins(
    shapes: Vec<Shape>,
    material: &Material,
    machine: &Machine,
    settings: &Settings,
) -> Result<Origins, Vec<Diagnostic>> {
    let Distance { apart, .. } = Distance::of(material, machine, settings)?;
    let room = DVec3::from_array(settings.placing.block) - 2.0 * settings.placing.margin;
    let (parts, ..) = placed(shapes, room, apart, settings)?;
    Ok(Origins::new(&parts.bodies, &parts.mesh.vertices, &parts.points))
}

/// What shapes are made of.
#[derive(Default)]
struct Parts {
    /// What of it each shape is.
    bodies: Vec<Placed>,
    /// All bodies as one.
    mesh: Mesh,
    /// What is unusual about each of them.
    health: Vec<Health>,
    /// All points.
    points: Vec<DVec3>,
    /// Pictures, each with the number of its sheets.
    pictures: Vec<(Picture, usize)>,
    /// Three corners of each sheet, and the fourth: what has to fit into the block.
    corners: Vec<DVec3>,
    /// The corners of all curves, and how many each has.
    curves: Vec<DVec3>,
    lengths: Vec<usize>,
    /// What is said of the files.
    warnings: Vec<Diagnostic>,
}

impl Parts {
    /// Of `shapes` in a block with `room` (mm) within its margins.
    fn new(
        shapes: Vec<(usize, Shape)>,
        room: DVec3,
        apart: Apart,
    ) -> Result<Parts, Vec<Diagnostic>> {
        let mut parts = Parts::default();
        for (number, shape) in shapes {
            let (vertices, points) = (parts.mesh.vertices.len(), parts.points.len());
            // Curves are repeated, and pictures lie on sheets.
            let is_bounded = matches!(shape, Shape::Mesh(_) | Shape::Points(_));
            match shape {
                Shape::Mesh(body) => {
                    if !body.triangles.is_empty() {
                        parts.health.push(body.health());
                    }
                    parts.mesh.join(body);
                }
                Shape::Points(more) => parts.points.extend(more),
                Shape::Curves(more) => {
                    parts.lengths.extend(more.curves.iter().map(|curve| curve.corners.len()));
                    parts.curves.extend(more.curves.into_iter().flat_map(|curve| curve.corners));
                    parts.warnings.extend(more.warnings);
                }
                Shape::Picture(picture) => {
                    let least = apart.rounded();
                    let (_, distance) = picture.setting.sheets;
                    if distance.is_some_and(|distance| distance < least - 1e-9) {
                        let message =
                            format!("sheets of a picture are at least {least:.3} mm apart");
                        return Err(error(
                            Rule::Spacing,
                            message,
                            "take a larger --sheet-distance",
                        ));
                    }
                    // Its edges are open on purpose: nothing is reported of its health.
                    parts.mesh.join(picture.relief(room, apart));
                    let sheets = picture.sheets(room, apart);
                    parts.corners.extend(sheets.iter().flat_map(Sheet::corners));
                    parts.pictures.push((picture, sheets.len()));
                }
            }
            let vertices = vertices..parts.mesh.vertices.len();
            let points = points..parts.points.len();
            parts.bodies.push(Placed { number, vertices, points, is_bounded });
        }
        Ok(parts)
    }

    /// Takes over what `other` has.
    fn join(&mut self, other: Parts) {
        let (vertices, points) = (self.mesh.vertices.len(), self.points.len());
        let behind = |own: &Range<usize>, first: usize| own.start + first..own.end + first;
        self.bodies.extend(other.bodies.into_iter().map(|body| Placed {
            vertices: behind(&body.vertices, vertices),
            points: behind(&body.points, points),
            ..body
        }));
        self.mesh.join(other.mesh);
        self.health.extend(other.health);
        self.points.extend(other.points);
        self.pictures.extend(other.pictures);
        self.corners.extend(other.corners);
        self.curves.extend(other.curves);
        self.lengths.extend(other.lengths);
        self.warnings.extend(other.warnings);
    }

    /// Moves all to its place in the block; answers the scale, and from where to where it reaches.
    fn place(&mut self, placing: &Placing) -> Result<(f64, [DVec3; 2]), Vec<Diagnostic>> {
        let Parts { mesh, points, corners, curves, .. } = self;
        place([&mut mesh.vertices, points, corners, curves], placing)
    }

    /// The corners of each curve, as they are placed.
    fn curves(&self) -> impl Iterator<Item = &[DVec3]> + Clone {
        let start = |at: &mut usize, length: &usize| Some(std::mem::replace(at, *at + length));
        let starts = self.lengths.iter().scan(0, start);
        starts.zip(&self.lengths).map(|(start, length)| &self.curves[start..start + length])
    }

    /// The pictures with their sheets, as they are placed.
    fn sheets(&self) -> impl Iterator<Item = (&Picture, Sheet)> {
        let pictures = self.pictures.iter();
        let each = pictures.flat_map(|(picture, count)| std::iter::repeat_n(picture, *count));
        each.zip(self.corners.chunks_exact(4).map(Sheet::new))
    }
}

/// Puts `shapes` to their places in the block: those that lie by themselves one by one, and all others in one frame, whose scale is
/// answered.
fn placed(
    shapes: Vec<Shape>,
    room: DVec3,
    apart: Apart,
    settings: &Settings,
) -> Result<(Parts, f64, Vec<Alone>), Vec<Diagnostic>> {
    let count = shapes.len();
    for (at, (number, _)) in settings.alone.iter().enumerate() {
        let message = if *number >= count {
            format!("there are {count} bodies, no body {}", number + 1)
        } else if settings.alone[..at].iter().any(|(earlier, _)| earlier == number) {
            format!("body {} is placed twice", number + 1)
        } else {
            continue;
        };
        return Err(error(
            Rule::GlassBlock,
            message,
            "give each --place the number of another body, from 1",
        ));
    }
    let (mut together, mut by_themselves) = (Vec::new(), Vec::new());
    for (number, shape) in shapes.into_iter().enumerate() {
        match settings.alone.iter().find(|(own, _)| *own == number) {
            Some((_, placing)) => by_themselves.push((number, shape, placing)),
            None => together.push((number, shape)),
        }
    }
    let has_frame = !together.is_empty() || by_themselves.is_empty();
    let mut parts = Parts::new(together, room, apart)?;
    let scale = if has_frame { parts.place(&settings.placing)?.0 } else { 1.0 };
    let mut alone = Vec::new();
    for (number, shape, placing) in by_themselves {
        let Placing { block, margin, .. } = settings.placing;
        let in_body = |found: Diagnostic| {
            let message = format!("body {}: {}", number + 1, found.message);
            Diagnostic { message, ..found }
        };
        let mut own = Parts::new(vec![(number, shape)], room, apart)?;
        let (scale, ends) = own
            .place(&Placing { block, margin, ..*placing })
            .map_err(|found| found.into_iter().map(in_body).collect::<Vec<_>>())?;
        let [from, to] = ends.map(|end| end.to_array());
        alone.push(Alone { body: number + 1, scale, from, to });
        parts.join(own);
    }
    Ok((parts, scale, alone))
}

/// What is said of parts of bodies that became no points.
fn left_out(left: &Left, filling: &Filling) -> Option<Diagnostic> {
    let (message, help) = match (left, filling.fill) {
        (Left { triangles: 1.., .. }, Fill::Triangles(false)) => (
            format!("{} triangles are smaller than the grid and get no point", left.triangles),
            "add --full for a point in each of them, or take --fill surface",
        ),
        (Left { along: 1.., .. }, _) => (
            format!("{} triangles lie along the planes or rays and get no points", left.along),
            "take another --axis or a --tilt, or --fill surface",
        ),
        (Left { columns: 1.., first_column: Some([x, y, z]), .. }, _) => (
            format!(
                "{} columns enter the body more often than they leave it, the first one at {x:.3} {y:.3} {z:.3} mm: they are left empty",
                left.columns
            ),
            "close the body in the program that made it",
        ),
        _ => return None,
    };
    Some(Diagnostic::warning(Rule::Mesh, message).help(help))
}

fn unhealthy(health: &Health) -> Option<Diagnostic> {
    let Health { open, first_open, flat, crowded, turned, volume } = *health;
    let mut parts = Vec::new();
    if let (true, Some([x, y, z])) = (open > 0, first_open) {
        parts.push(format!("{open} open edges, one of them at {x:.3} {y:.3} {z:.3}"));
    }
    if flat > 0 {
        parts.push(format!("{flat} triangles without area"));
    }
    if crowded > 0 {
        parts.push(format!("{crowded} edges of more than two triangles"));
    }
    if turned > 0 {
        parts.push(format!("{turned} edges at which a triangle is inside out"));
    } else if open == 0 && volume < 0.0 {
        parts.push(String::from("all triangles inside out"));
    }
    let found = Diagnostic::warning(Rule::Mesh, format!("the body has {}", parts.join("; ")));
    (!parts.is_empty()).then(|| found.help("its surface is engraved as it is; repair it in the program that made it if that is not wanted"))
}

fn cut_off(cut: Cut, margin: f64) -> Option<Diagnostic> {
    let message = format!(
        "the side faces cut off part of the beam of {} points: they get less energy. A margin of {:.2} mm would do",
        cut.points,
        margin + cut.more
    );
    let found = Diagnostic::warning(Rule::BeamCut, message);
    (cut.points > 0).then(|| {
        found.help("take that --margin, a larger block, or keep the sides clean and polished")
    })
}

/// Moves bodies, points and pictures to their place in the block; answers their scale, and from where to where they reach.
fn place(
    mut groups: [&mut Vec<DVec3>; 4],
    placing: &Placing,
) -> Result<(f64, [DVec3; 2]), Vec<Diagnostic>> {
    let [x, y, z] = placing.turn.map(f64::to_radians);
    let mirror =
        DVec3::from_array(placing.mirror.map(|mirrored| if mirrored { -1.0 } else { 1.0 }));
    let turn = DMat3::from_rotation_z(z)
        * DMat3::from_rotation_y(y)
        * DMat3::from_rotation_x(x)
        * DMat3::from_diagonal(mirror);
    let mut each = |change: &dyn Fn(DVec3) -> DVec3| {
        let all = groups.iter_mut().flat_map(|places| places.iter_mut());
        all.for_each(|place| *place = change(*place));
        let bounds = groups.iter().filter_map(|places| mesh::bounds(places));
        bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    };
    let Some((low, high)) = each(&|place| turn * place) else {
        return Err(error(
            Rule::Empty,
            String::from("there is no point to engrave"),
            "give a body or points",
        ));
    };
    let size = high - low;
    let room = DVec3::from_array(placing.block) - 2.0 * placing.margin;
    let fitting = (room / size.max(DVec3::splat(1e-12))).min_element();
    let scale = placing.scale.unwrap_or(if placing.fit { fitting } else { 1.0 });
    let (middle, target) = (
        0.5 * (low + high),
        0.5 * DVec3::from_array(placing.block) + DVec3::from_array(placing.shift),
    );
    let Some((low, high)) = each(&|place| (place - middle) * scale + target) else {
        return Ok((scale, [target; 2]));
    };
    let (least, most) = (
        DVec3::splat(placing.margin - SLACK),
        DVec3::from_array(placing.block) - placing.margin + SLACK,
    );
    if low.cmplt(least).any() || high.cmpgt(most).any() {
        let size = high - low;
        let message = format!(
            "the body is {:.3} x {:.3} x {:.3} mm, from {:.3} {:.3} {:.3}: it does not fit into {} x {} x {} mm with margins of {} mm",
            size.x,
            size.y,
            size.z,
            low.x,
            low.y,
            low.z,
            placing.block[0],
            placing.block[1],
            placing.block[2],
            placing.margin
        );
        // A factor of 25.4 is the usual mistake; half the size is not.
        let help = match fitting / scale {
            part if part < 0.5 && part * INCH >= 1.0 => {
                format!(
                    "--scale {fitting:.4} or --fit makes it fit; if it was exported {INCH} times too large, --scale {:.6}",
                    scale / INCH
                )
            }
            part if part < 1.0 => format!("--scale {fitting:.4} or --fit makes it fit"),
            _ => String::from("it is small enough: take another --move"),
        };
        return Err(error(Rule::DoesNotFit, message, &help));
    }
    Ok((scale, [low, high]))
}

/// The cloud of bodies, pictures and points, and how many points of them were too close to others.
fn discretise(
    parts: &Parts,
    settings: &Settings,
    apart: Apart,
    watch: &dyn Watch,
) -> Result<(Vec<Point>, u64, Left), Vec<Diagnostic>> {
    let Parts { mesh, points, .. } = parts;
    let Settings { filling, layers, seed, .. } = settings;
    // A saturated packing has 0.6966 points in a square of the spacing; some more where it is curved.
    let sheets = parts.sheets().map(|(_, sheet)| sheet.area()).sum::<f64>();
    let sheets = sheets * 1e6 / f64::from(apart.spacing).powi(2);
    let step = filling.step.unwrap_or(apart.rounded());
    let sides = parts.curves().flat_map(|curve| curve.windows(2));
    let curves =
        sides.map(|side| side[0].distance(side[1])).sum::<f64>() / step * f64::from(layers.count);
    let surfaces = f64::from(settings.shells.count.max(1));
    let expected = sheets + curves + surfaces * filling.expected(mesh, apart.spacing);
    if expected > MOST_POINTS {
        let message =
            format!("some {:.0} million points are more than can be made", 0.7 * expected * 1e-6);
        return Err(error(Rule::Points, message, "take a larger --spacing or a smaller --scale"));
    }
    let most = watch.most_pulses();
    if 0.7 * expected > most as f64 {
        return Err(too_many(0.7 * expected, most));
    }
    let fill::Points { sampled: mut cloud, mut others, left } =
        fill::points(mesh, filling, apart, *seed);
    if filling.fill == Fill::Surface {
        others = fill::shells(mesh, settings.shells, apart, *seed);
    }
    let mut asked = cloud.len() + others.len();
    let given: Option<Vec<Point>> = points.iter().map(|place| cloud::point(*place)).collect();
    let Some(mut given) = given else {
        return Err(error(
            Rule::Coordinate,
            String::from("a point is beyond 2 m"),
            "lengths are mm: take a --scale",
        ));
    };
    let distance = layers.distance.unwrap_or(apart.rounded());
    let along = layers.points(parts.curves(), step, distance, filling.direction);
    if layers.count > 1 {
        all_within(&along, &settings.placing)?;
    }
    given.extend(along);
    for (number, (picture, sheet)) in parts.sheets().enumerate() {
        watch.go_on()?;
        given.extend(picture.points(&sheet, apart, seed.wrapping_add(number as u64)));
    }
    asked += given.len();
    if !cloud.is_empty() && filling.keeps(apart) {
        others = weld::clear(&others, &cloud, apart);
    }
    cloud.append(&mut others);
    // Shells come near each other where the body is hollow.
    if !given.is_empty() || !filling.keeps(apart) || settings.shells.count > 1 {
        cloud.append(&mut given);
        cloud = weld::welded(&cloud, apart.spacing);
    }
    if cloud.is_empty() {
        return Err(error(
            Rule::Empty,
            String::from("there is no point to engrave"),
            "give a body, points, or a picture that is not black (--invert)",
        ));
    }
    let left_out = (asked - cloud.len()) as u64;
    Ok((cloud, left_out, left))
}

/// That there is no memory for so many pulses.
fn too_many(pulses: f64, most: u64) -> Vec<Diagnostic> {
    let millions = |count: f64| (count * 1e-6).ceil();
    let message = format!(
        "some {} million points are more than the {} million that there is memory for here",
        millions(pulses),
        millions(most as f64)
    );
    let help = "take a larger --spacing or a smaller --scale, or the command `toolpost glass`";
    error(Rule::Points, message, help)
}

/// Layers of curves stay within the margins.
fn all_within(points: &[Point], placing: &Placing) -> Result<(), Vec<Diagnostic>> {
    let Some((low, high)) = cloud::bounds(points) else { return Ok(()) };
    let (low, high) = (cloud::place(low), cloud::place(high));
    let most = DVec3::from_array(placing.block) - placing.margin + SLACK;
    if low.min_element() < placing.margin - SLACK || high.cmpgt(most).any() {
        let message = format!("the layers of the curves reach from {low:.3} to {high:.3} mm");
        let help = "take fewer --layers, a smaller --layer-distance, or another --axis";
        return Err(error(Rule::DoesNotFit, message, help));
    }
    Ok(())
}

/// Points are rounded to whole µm: half of one beyond the margin is no matter, mm.
const SLACK: f64 = 1e-3;

/// The most points whose order's bound is looked for.
const MOST_BOUND: usize = 1_000_000;

/// Squares of the spacing on a surface beyond which no cloud is begun: 200 million points.
const MOST_POINTS: f64 = 3e8;
