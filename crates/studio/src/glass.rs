//! Jobs of a laser that fires inside glass: each pulse is a move, and the block is drawn round them.

use crate::ask::{Axis, AxisKind, GlassBlock};
use crate::folder::Folder;
use crate::geometry::{CHUNK, Exact, Geometry};
use crate::job::{Follows, Job, Made, Options, Sources};
use crate::lines::Lines;
use crate::machines::Any;
use crate::place::{At, Stand};
use crate::walk::{Drawn, Pulse, Walk};
use ::post::Origins;
use app::glass::{Focus, Format, Machine, Run, Settings, Steps, job};
use app::toolpath::Toolpath;
use app::{Source, Stop, Verdict, Watch, glass};
use geom::{Vec2, Vec3};
use machine::linkage::{self, Link, LinkKind, Linkage};
use program::{Diagnostic, Program, Rule};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::PathBuf;

/// What a job of such a machine has more than others.
#[derive(Debug)]
pub struct Glass {
    focus: Focus,
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

/// No bodies: no machine file says what such a machine looks like.
pub fn linkage(axes: &[Axis]) -> Linkage {
    let bed = Link {
        name: String::from("bed"),
        on: None,
        kind: LinkKind::Fixed,
        direction: [0.0; 3],
        point: [0.0; 3],
        zero: 0.0,
        terms: Vec::new(),
    };
    let at_bed = linkage::Place {
        on: 0,
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]],
    };
    let axis = |axis: &Axis| linkage::Axis {
        name: axis.name.clone(),
        unit: axis.unit,
        low: axis.low,
        high: axis.high,
    };
    Linkage {
        axes: axes.iter().map(axis).collect(),
        links: vec![bed],
        bodies: Vec::new(),
        tool: at_bed,
        part: at_bed,
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
    (mut inputs, folder): (Vec<PathBuf>, &Folder),
    follows: &Follows,
) -> Result<Job, Stop> {
    let bodies = match source {
        Sources::One(body) => vec![body],
        Sources::Several(bodies) => bodies,
        Sources::Folder(name, _) => {
            let message = format!("{name} is a folder: a block of glass is made of bodies");
            let found = Diagnostic::error(Rule::StudioAsk, message);
            return Err(found.help("open the file of a body, or drop several bodies").into());
        }
    };
    let settings = options.glass.as_deref().ok_or_else(|| {
        Stop::from(Diagnostic::error(Rule::StudioAsk, "there are no options for glass here"))
    })?;
    if program.is_some() && matches!(settings.job.order, job::Order::Scenario(_)) {
        let message = "the order `arcs` or `tracks` moves points to where its motions pass: an edited program cannot be compared with them";
        let found = Diagnostic::error(Rule::StudioAsk, message);
        return Err(found.help("discard the edit, or take another --order").into());
    }
    let mut read = Vec::new();
    let mut beside = |body: &Source, name: &str| {
        let path = body.path().with_file_name("").join(name).to_string_lossy().into_owned();
        let own = folder.target(&body.path().to_string_lossy()).ok();
        if !own.is_some_and(|own| inputs.contains(&own)) {
            return Err(format!(
                "`{name:.80}` is not read for a dropped body: put both into the folder of the studio"
            ));
        }
        read.extend(folder.target(&path).ok());
        folder.read(&path).map_err(|found| format!("{name:.80}: {}", found.message))
    };
    let file = file.unwrap_or_else(|| {
        let name = bodies.first().map(Source::name).unwrap_or_default();
        let stem = name.rsplit_once('.').map_or(&*name, |(stem, _)| stem);
        format!("{stem}.{}", glass::extension(&machine))
    });
    let job = glass::Job::read(&bodies, (*machine).clone(), settings, &mut beside)?;
    let made = match program {
        Some(text) => {
            let text = job.program(&Source::memory(&file, text))?;
            job.prove(&file, text, follows)?
        }
        None => job.make(follows)?,
    };
    inputs.extend(read);
    if machine::is_path(machine_name) {
        inputs.push(folder.target(machine_name)?);
    }
    follows.step("drawing");
    let drawn = drawn(&made, settings, follows)?;
    let focus = made.focus(settings)?;
    // As the command saves it: there findings of a program that it has made name no file.
    let report = (made.account.verdict == Verdict::Done).then(|| made.account.report());
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
    let (name, source) = shown(&bodies);
    let made = Made {
        toolpath: Toolpath::of_program(Program::new(name), "glass"),
        account,
        text,
        origins: Origins::default(),
        parts: Vec::new(),
        report,
        widths: Vec::new(),
        board: None,
    };
    let glass = Glass { focus, listing };
    let named = (file, (machine_name, Any::Fires(machine)));
    Ok(Job::drawn(made, drawn, source, named, inputs).with_glass(glass))
}

/// What is shown as the source: the text of a body, where it is one; of others what they are.
fn shown(bodies: &[Source]) -> (String, Lines) {
    let line = |body: &Source| {
        let bytes = body.read().map_or(0, |bytes| bytes.len());
        format!("{}: {bytes} bytes\n", body.name())
    };
    let text = match bodies {
        [one] => one.read().ok().filter(|bytes| std::str::from_utf8(bytes).is_ok()),
        _ => None,
    };
    let names = bodies.iter().map(Source::name).collect::<Vec<_>>().join(", ");
    let lines = || bodies.iter().map(line).collect::<String>().into_bytes();
    (names, Lines::of(text.unwrap_or_else(lines)))
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
fn drawn(made: &glass::Made, settings: &Settings, watch: &dyn Watch) -> Result<Drawn, Stop> {
    let (run, machine) = (&made.made.run, &made.machine);
    let focus = made.focus(settings)?;
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
        let (_, block) = focus.at(machine, pulse.at);
        if focus.blocks > 1 && machine.polar.is_some() && before.replace(block) != Some(block) {
            operation = Some(format!("block {}", block + 1));
        }
        ticks = ticks.saturating_add(steps.get(number));
        let [a, b, z] = pulse.at;
        let positions = match center {
            Some([x, y]) => vec![x, y, a - x, b - y, z],
            None => vec![a, b, z],
        };
        Pulse {
            line: pulse.line,
            at: focus.from_first().at(machine, pulse.at).0,
            positions,
            end: ticks as f64 / machine.laser.rate,
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

impl Glass {
    /// How much memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.listing.as_ref().map_or(0, Lines::bytes)
    }

    /// The blocks, in the frame of the first.
    pub fn blocks(&self, machine: &Machine) -> Vec<GlassBlock> {
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
    pub fn stand(&self, walk: &Walk, machine: &Machine, at: At) -> Stand {
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
