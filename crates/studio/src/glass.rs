//! Jobs of a laser that fires inside glass: each pulse is a move, and the block is drawn round them.

use crate::ask::{Axis, AxisKind, GlassBlock, Of};
use crate::geometry::{CHUNK, Exact, Geometry};
use crate::job::{Follows, Job, Made, Options, Reported, Sources};
use crate::lines::Lines;
use crate::machines::Any;
use crate::origin::Texts;
use crate::place::{At, Stand};
use crate::walk::{Drawn, Pulse, Walk};
use ::post::Origins;
use app::glass::{Focus, Format, Machine, Moves, Run, Steps, Table, job};
use app::toolpath::Toolpath;
use app::{Source, Stop, Watch, glass};
use geom::{Vec2, Vec3};
use machine::linkage::{self, Link, LinkBody, LinkKind, Linkage};
use program::{Diagnostic, Program, Rule};
use std::borrow::{Borrow, Cow};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// The most pulses of a program: while it is made, each takes some 220 bytes.
const MOST_PULSES: u64 = 12_000_000;

/// The machine of a job, and what the job says of it.
#[derive(Debug)]
pub struct Glass {
    machine: Machine,
    focus: Focus,
    /// Focal length of the lens, mm.
    focal: f64,
    /// A binary program as its control reads it: a line for each pulse.
    pub listing: Option<Lines>,
}

/// The axes of a machine, in the order in which their positions are kept: those of its stage first.
pub fn axes(machine: &Machine) -> Vec<Axis> {
    let axis = |name: &str, turns, [low, high]: [f64; 2]| {
        let (kind, unit) =
            if turns { (AxisKind::Rotary, "degrees") } else { (AxisKind::Linear, "mm") };
        Axis { name: name.to_owned(), kind, unit, low: Some(low), high: Some(high) }
    };
    let stage = machine.stage.iter().flat_map(|stage| [("X", stage.x), ("Y", stage.y)]);
    let stage = stage.map(|(name, own)| axis(name, false, own.travel));
    let own = machine.coordinates().into_iter().map(|of| {
        // What turns on and on has no ends.
        let ends = axis(of.word, of.turns, of.axis.travel);
        if of.endless { Axis { low: None, high: None, ..ends } } else { ends }
    });
    stage.chain(own).collect()
}

/// What carries what, in a frame whose Z is up and whose Z 0 is the top face of the block.
struct Carried {
    linkage: Linkage,
    /// The links that carry the block and the beam.
    block: usize,
    beam: usize,
}

impl Carried {
    /// The bed alone, of a machine with these axes.
    fn bed(axes: &[Axis]) -> Carried {
        let axis = |axis: &Axis| linkage::Axis {
            name: axis.name.clone(),
            unit: axis.unit,
            low: axis.low,
            high: axis.high,
        };
        let linkage = Linkage {
            axes: axes.iter().map(axis).collect(),
            links: vec![Link::bed()],
            bodies: Vec::new(),
            tool: seat(0, Vec3::ZERO),
            part: seat(0, Vec3::ZERO),
        };
        Carried { linkage, block: 0, beam: 0 }
    }

    /// An axis moves what carries the block, or the beam: along a way, or about an upright line through a point.
    fn add(&mut self, axis: usize, moves: Moves, kind: LinkKind, [direction, point]: [Vec3; 2]) {
        let name = self.linkage.axes[axis].name.clone();
        let link = self.linkage.links.len();
        let carrier = match moves {
            Moves::Block => &mut self.block,
            Moves::Beam => &mut self.beam,
        };
        let on = Some(std::mem::replace(carrier, link));
        let [direction, point] = [direction, point].map(|vector| vector.to_array());
        let terms = vec![(axis, 1.0)];
        self.linkage.links.push(Link { name, on, kind, direction, point, zero: 0.0, terms });
    }

    fn body(&mut self, name: &str, on: usize, low: [f64; 3], high: [f64; 3]) {
        self.linkage.bodies.push(LinkBody {
            name: name.to_owned(),
            on,
            low,
            high,
            is_given: false,
        });
    }
}

fn seat(on: usize, at: Vec3) -> linkage::Place {
    let [x, y, z] = Vec3::AXES.map(|axis| axis.to_array());
    linkage::Place { on, frame: [x, y, z, at.to_array()] }
}

/// What carries what of a machine while blocks of these sides (mm) are on it, with boxes for the table, the lens and what leads it: its file
/// says nothing of their shapes.
pub fn linkage(machine: &Machine, [x, y, z]: [f64; 3], focal: f64) -> Linkage {
    let mut carried = Carried::bed(&axes(machine));
    let along = |way: [f64; 2]| [Vec2::from(way).normalize_or_zero().extend(0.0), Vec3::ZERO];
    let about = |point: [f64; 2]| [Vec3::Z, Vec2::from(point).extend(0.0)];
    let (slide, turn) = (LinkKind::Slide, LinkKind::Turn);
    // Where the block's corner and the beam are while all axes stand at zero.
    let (mut corner, mut spot, mut first) = (Vec2::ZERO, Vec2::ZERO, 0);
    match (machine.polar, &machine.chain) {
        (Some(table), _) => {
            carried.add(1, Moves::Block, turn, about([0.0; 2]));
            carried.add(0, Moves::Beam, turn, about([0.0, table.distance]));
            corner = Vec2::new(-0.5 * x, table.offset);
            spot = Vec2::new(0.0, table.distance - table.arm);
        }
        (None, Some(chain)) => {
            for (axis, joint) in [chain.a, chain.b].into_iter().enumerate() {
                match (joint.about, joint.along) {
                    (Some(point), _) => carried.add(axis, joint.moves, turn, about(point)),
                    (None, way) => {
                        carried.add(axis, joint.moves, slide, along(way.unwrap_or_default()));
                    }
                }
            }
            (corner, spot) = (chain.corner.into(), chain.spot.into());
        }
        (None, None) => {
            // A growing position brings the beam to where it grows in the block.
            carried.add(1, Moves::Block, slide, along([0.0, -1.0]));
            carried.add(0, Moves::Block, slide, along([-1.0, 0.0]));
            if machine.stage.is_some() {
                first = 2;
                carried.add(2, Moves::Beam, slide, along([1.0, 0.0]));
                carried.add(3, Moves::Beam, slide, along([0.0, 1.0]));
            }
        }
    }
    let (head, table) = (carried.beam, carried.block);
    carried.add(first + 2, Moves::Beam, slide, [Vec3::Z, Vec3::ZERO]);
    let lens = carried.beam;
    let [a, b] = spot.to_array();
    carried.body("lens", lens, [a - 12.0, b - 12.0, focal], [a + 12.0, b + 12.0, focal + 12.0]);
    match machine.polar {
        Some(Table { radius, distance, .. }) => {
            carried.body("table", table, [-radius, -radius, -z - 10.0], [radius, radius, -z]);
            let arm = [[-10.0, b - 12.0, focal + 20.0], [10.0, distance + 12.0, focal + 35.0]];
            carried.body("arm", head, arm[0], arm[1]);
        }
        None => {
            let [c, d] = corner.to_array();
            let low = [c - 10.0, d - 10.0, -z - 10.0];
            carried.body("table", table, low, [c + x + 10.0, d + y + 10.0, -z]);
        }
    }
    let mut linkage = carried.linkage;
    linkage.tool = seat(lens, spot.extend(0.0));
    linkage.part = seat(table, corner.extend(-z));
    linkage
}

/// Whether a source is bodies, by their names.
///
/// # Errors
/// It is a folder, or a file that is none.
pub(crate) fn check(source: &Sources) -> Result<(), Stop> {
    match source {
        Sources::One(body) => glass::check(body),
        Sources::Several(bodies) => bodies.iter().try_for_each(glass::check),
        Sources::Folder(name, _) => {
            let message = format!("{name} is a folder: a block of glass is made of bodies");
            let found = Diagnostic::error(Rule::StudioAsk, message);
            Err(found.help("open the file of a body, or drop several bodies").into())
        }
    }
}

/// Writes the program of bodies and proves it, or proves one that is there.
///
/// # Errors
/// Why there is none, or that the work was ended.
pub(crate) fn make(
    source: Sources,
    options: &Options,
    (machine_name, machine): (&str, Box<Machine>),
    (file, program): (Option<String>, Option<Vec<u8>>),
    follows: &Follows,
) -> Result<Job, Stop> {
    let bodies = match source {
        Sources::One(body) => vec![body],
        Sources::Several(bodies) | Sources::Folder(_, bodies) => bodies,
    };
    let settings = options.glass.as_deref().ok_or_else(|| {
        Stop::from(Diagnostic::error(Rule::StudioAsk, "there are no options for glass here"))
    })?;
    if program.is_some() && matches!(settings.job.order, job::Order::Scenario(_)) {
        let message = "the order `arcs` or `tracks` moves points to where its motions pass: an edited program cannot be compared with them";
        let found = Diagnostic::error(Rule::StudioAsk, message);
        return Err(found.help("discard the edit, or take another --order").into());
    }
    let (folder, inputs) = (follows.folder, follows.inputs);
    let bodies_read = inputs.files(folder, Some(Of::Source));
    let mut beside = |body: &Source, name: &str| {
        let path = body.path().with_file_name("").join(name).to_string_lossy().into_owned();
        let own = folder.target(&body.path().to_string_lossy()).ok();
        if !own.is_some_and(|own| bodies_read.contains(&own)) {
            return Err(format!(
                "`{name:.80}` is not read for a dropped body: put both into the folder of the studio"
            ));
        }
        inputs
            .read(folder, &path, Of::Source)
            .map_err(|found| format!("{name:.80}: {}", found.message))
    };
    let file = file.unwrap_or_else(|| {
        let name = bodies.first().map(Source::name).unwrap_or_default();
        let stem = name.rsplit_once('.').map_or(&*name, |(stem, _)| stem);
        format!("{stem}.{}", glass::extension(&machine))
    });
    let job = glass::Job::read(&bodies, (*machine).clone(), settings, &mut beside)?;
    let job = job.within(MOST_PULSES);
    let texts = texts(&bodies);
    let origins = (bodies.len() > 1 || bodies.iter().any(glass::is_list))
        .then(|| job.origins(&bodies))
        .transpose()?;
    let made = match program {
        Some(text) => {
            let text = job.program(&Source::memory(&file, text))?;
            job.prove(&file, text, follows)?
        }
        None => job.make(follows)?,
    };
    follows.step("drawing");
    let focus = made.focus(settings)?;
    let line = |at: glass::Point| {
        let (body, line) = origins.as_ref()?.of(at)?;
        match (line, &bodies[..]) {
            (Some(line), [_]) => texts.number(None, line),
            (Some(line), _) => texts.number(Some(&bodies.get(body)?.name()), line),
            (None, [_]) => None,
            // Of several bodies each has a line in the list of them.
            (None, _) => texts.number(None, body as u32 + 1),
        }
    };
    // As it was made here, but where the points were moved to the motions, the cloud is in the order of the pulses.
    let is_in_order = made.made.report.planned_ticks.is_some() && made.made.report.moved.is_none();
    let drawn = drawn(&made, focus, (is_in_order, &line), follows)?;
    // As the command saves it: there findings of a program that it has made name no file.
    let report = Some(Reported::Own(made.account.clone().into()));
    let glass::Made { made: job::Made { text, run, .. }, mut account, .. } = made;
    let listing = (machine.program.format == Format::Binary).then(|| listing(&run));
    if listing.is_some() {
        let message = "the program is binary: it is shown as its control reads it";
        let found = Diagnostic::warning(Rule::StudioLimit, message).file(&file);
        account.findings.push(found.help("to change it, change the bodies or the options"));
    }
    for found in account.findings.iter_mut().filter(|found| found.line > 0) {
        found.file.clone_from(&file);
    }
    let made = Made {
        toolpath: Toolpath::of_program(Program::new(texts.name()), "glass"),
        account,
        text,
        origins: Origins::default(),
        parts: Vec::new(),
        report,
        widths: Vec::new(),
        board: None,
        lines: None,
    };
    let glass = Glass { machine: *machine, focus, focal: settings.job.focal, listing };
    let named = (file, (machine_name, Any::Fires(glass.into())));
    Ok(Job::drawn(made, drawn, texts.into(), named, follows))
}

/// What is shown as the source: the text of a body, where it is one; of others what they are, and those of them that are lists of points.
fn texts(bodies: &[Source]) -> Texts {
    let text = |body: &Source| {
        let bytes = body.read().ok().filter(|bytes| std::str::from_utf8(bytes).is_ok());
        bytes.map(Cow::into_owned)
    };
    let line = |body: &Source| {
        let bytes = body.read().map_or(0, |bytes| bytes.len());
        format!("{}: {bytes} bytes\n", body.name())
    };
    let listed = || bodies.iter().map(line).collect::<String>().into_bytes();
    if let [one] = bodies {
        return Texts::of(one.name(), Lines::of(text(one).unwrap_or_else(listed)));
    }
    let names = bodies.iter().map(Source::name).collect::<Vec<_>>().join(", ");
    let lists = bodies.iter().filter(|body| glass::is_list(body));
    let lists = lists.filter_map(|body| Some((body.name(), Lines::of(text(body)?))));
    lists.fold(Texts::of(names, Lines::of(listed())), |all, (name, text)| all.with(name, text))
}

/// The pulses of a binary program.
fn listing(run: &Run) -> Lines {
    let mut text = String::with_capacity(32 * run.pulses.len());
    for pulse in run.pulses.iter() {
        let [a, b, c] = pulse.at;
        let _ = writeln!(text, "{a:.4} {b:.4} {c:.4}");
    }
    Lines::of(text.into_bytes())
}

/// The pulses as the virtual machine has fired them, in levels of detail.
fn drawn(
    made: &glass::Made,
    focus: Focus,
    (is_in_order, line): (bool, &dyn Fn(glass::Point) -> Option<u32>),
    watch: &dyn Watch,
) -> Result<Drawn, Stop> {
    let cloud = &made.made.cloud;
    let (run, machine) = (&made.made.run, &made.machine);
    let (in_first, are_several) = (focus.from_first(), focus.blocks > 1 && machine.polar.is_some());
    let steps = Steps::new(run, machine);
    let (mut ticks, mut before) = (0_u64, None);
    let mut fields = run.fields.iter().peekable();
    let mut center = None;
    let pulses = run.pulses.iter().enumerate().map(|(number, pulse)| {
        let mut operation = None;
        if let Some((_, _, middle)) = fields.next_if(|(first, ..)| *first as usize == number) {
            center = Some(*middle);
            operation = Some(format!("field at X{:.3} Y{:.3}", middle[0], middle[1]));
        }
        if are_several {
            let (_, block) = focus.at(machine, pulse.at);
            if before.replace(block) != Some(block) {
                operation = Some(format!("block {}", block + 1));
            }
        }
        ticks = ticks.saturating_add(steps.get(number));
        let [a, b, z] = pulse.at;
        let positions = match center {
            Some([x, y]) => vec![x, y, a - x, b - y, z],
            None => vec![a, b, z],
        };
        let from = match is_in_order {
            // Each block has the same points.
            true => cloud.get(number % cloud.len().max(1)).copied(),
            false => glass::point(focus.at(machine, pulse.at).0),
        };
        Pulse {
            line: pulse.line,
            at: in_first.at(machine, pulse.at).0,
            positions,
            end: ticks as f64 / machine.laser.rate,
            source_line: from.and_then(line).unwrap_or(0),
            operation,
        }
    });
    let mut goes_on = || !watch.is_cancelled();
    let mut walk = Walk::of_pulses(pulses, &goes_on).ok_or_else(Stop::cancelled)?;
    let wrong = made.account.findings.iter().filter(|found| found.is_error());
    walk.mark_blocks(wrong.flat_map(|found| found.places.iter().copied().chain([found.line])));
    let mut geometry = Geometry::default();
    for chunk in 0..walk.len().div_ceil(CHUNK) {
        let exact = Exact::of(&walk, chunk);
        geometry.add(exact, &mut goes_on).ok_or_else(Stop::cancelled)?;
    }
    Ok(Drawn { walk, geometry })
}

impl Borrow<Machine> for Glass {
    fn borrow(&self) -> &Machine {
        &self.machine
    }
}

impl Glass {
    /// How much memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.listing.as_ref().map_or(0, Lines::bytes)
    }

    /// What carries what.
    pub fn linkage(&self) -> Linkage {
        linkage(&self.machine, self.focus.block, self.focal)
    }

    /// The blocks, in the frame of the first.
    pub fn blocks(&self) -> Vec<GlassBlock> {
        let machine = &self.machine;
        let Focus { block: [x, y, z], blocks, .. } = self.focus;
        let block = |number: u32| match machine.polar {
            Some(table) => {
                // Turned on about the table's axis, as they come under the beam one after the other.
                let turned = -TAU / f64::from(table.blocks) * f64::from(number);
                let turn = |way: [f64; 2]| Vec2::from_angle(turned).rotate(way.into());
                let axis = Vec2::new(0.5 * x, -table.offset);
                let corner = axis + turn([-0.5 * x, table.offset]);
                let sides = [turn([x, 0.0]).extend(0.0), turn([0.0, y]).extend(0.0)];
                (corner.extend(0.0), sides)
            }
            None => {
                let apart = machine.laser.channel_distance * f64::from(number);
                (Vec3::new(apart, 0.0, 0.0), [Vec3::X * x, Vec3::Y * y])
            }
        };
        let about = |(corner, [x, y]): (Vec3, [Vec3; 2])| GlassBlock {
            corner: corner.to_array(),
            sides: [x, y, Vec3::Z * z].map(|side| side.to_array()),
        };
        (0..blocks).map(block).map(about).collect()
    }

    /// Where the beam and the axes are at a place: between pulses every axis goes evenly, one that turns on and on the shorter way.
    pub fn stand(&self, walk: &Walk, at: At) -> Stand {
        let machine = &self.machine;
        let end = walk.positions(at.r#move);
        if at.part >= 1.0 {
            let tip = walk.behind(at.r#move).tip;
            return Stand { tip, axis: Vec3::Z, positions: end.to_vec() };
        }
        let start = at.r#move.checked_sub(1).map(|before| walk.positions(before));
        let is_endless = machine.coordinates().map(|of| of.endless);
        let stage = end.len() - is_endless.len();
        let between = |(place, end): (usize, &f64)| {
            let Some(start) = start.map(|start| start[place]) else { return f64::NAN };
            let way = end - start;
            let turns = place >= stage && is_endless[place - stage];
            match turns {
                true => (start + (way - 360.0 * (way / 360.0).round()) * at.part).rem_euclid(360.0),
                false => start + way * at.part,
            }
        };
        let positions: Vec<f64> = end.iter().enumerate().map(between).collect();
        let axes = match positions[..] {
            [x, y, u, v, z] => [x + u, y + v, z],
            [a, b, z] => [a, b, z],
            _ => [f64::NAN; 3],
        };
        Stand { tip: self.focus.from_first().at(machine, axes).0, axis: Vec3::Z, positions }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two turning axes, one on the block and one on the beam.
    const CHAIN: &str = "[chain]\na = { moves = \"beam\", about = [0, 200] }\nb = { moves = \"block\", about = [0, 0] }\nspot = [0, 65]\ncorner = [-10, 70]\nnear = [-20, 20]\n";

    fn machines() -> Vec<Machine> {
        let mut machines: Vec<Machine> =
            glass::names().map(|name| glass::machine(name).unwrap()).collect();
        let plain = glass::library("glass-xyz-100hz").unwrap();
        let chain = plain
            .replace("kind = \"xyz\"", "kind = \"chain\"")
            .replace("travel = [0, 170]", "travel = [-90, 90]")
            .replace("[axes.x]", "[axes.a]")
            .replace("[axes.y]", "[axes.b]");
        machines.push(glass::machine_of(format!("{chain}\n{CHAIN}").as_bytes(), "c.toml").unwrap());
        machines
    }

    /// Through its links each machine brings the beam to the place of the block at which its virtual control has it; the focus is where it
    /// would be in air.
    #[test]
    fn links_lead_the_beam_to_where_the_virtual_control_has_it() {
        for machine in machines() {
            let block = [20.0, 22.0, 30.0];
            let linkage = linkage(&machine, block, 70.0);
            let coordinates = machine.coordinates();
            assert_eq!(
                linkage.axes.len(),
                coordinates.len() + 2 * usize::from(machine.stage.is_some())
            );
            let task = ::glass::proof::Task {
                cloud: &[],
                machine: &machine,
                lens: machine.lens(70.0).unwrap(),
                index: 1.5195,
                block,
                blocks: 1,
                spacing: 0.13,
                accept_shadowed: false,
            };
            let focus = Focus::new(&task);
            for number in 0..27 {
                let part = [number % 3, number / 3 % 3, number / 9].map(|n| f64::from(n) / 2.0);
                let at = [0, 1, 2].map(|axis| {
                    let [low, high] = coordinates[axis].axis.travel;
                    low + (high - low) * part[axis]
                });
                let positions = match machine.stage {
                    Some(_) => vec![3.0, 4.0, at[0] - 3.0, at[1] - 4.0, at[2]],
                    None => at.to_vec(),
                };
                let (found, expected) = (linkage.tip(&positions, 0.0), focus.at(&machine, at).0);
                let flat = found.truncate().distance(expected.truncate());
                assert!(flat < 1e-9, "{}: {found} {expected}", machine.title);
                assert!((found.z - (30.0 + at[2])).abs() < 1e-9, "{}: {found}", machine.title);
            }
        }
    }
}
