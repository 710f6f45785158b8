//! `toolpost pcb`: a board in; the proven programs that isolate, drill and cut it out, a picture of each
//! and one report out.

mod plan;
mod report;
mod setup;
mod source;
mod work;

use crate::answer::{Answer, Stop, Verdict};
use crate::args::pcb::{Part, Pcb, Picture};
use crate::files::{self, Target};
use crate::post::{self, Posted};
use crate::progress::Progress;
use crate::summary::rows;
use crate::toolpath::{self, Toolpath};
use ::pcb::board::Face;
use ::pcb::job::{self, Heights};
use ::pcb::{Board, Operation};
use drawing::{BoardPicture, Format};
use geom::Vec2;
use levelling::{Allowed, Grid, Probing, follow, level};
use machine::Machine;
use program::heights::HeightMap;
use program::{Diagnostic, Op, Record};
use rayon::prelude::*;
use setup::Setup;
use std::path::Path;
use work::Work;

/// Writes the programs, proves them, and only then saves them with their pictures and the report.
pub fn run(args: &Pcb, silent: bool) -> Result<Answer, Stop> {
    let machine = toolpath::machine_with(&args.machine, &args.option)?;
    if machine.wire.is_some() {
        let message = format!("`{}` cuts by wire: it mills and drills nothing", machine.name);
        let help = "name a mill: `toolpost machines` lists what there is";
        return Err(Diagnostic::error("machine-kind", message).help(help).into());
    }
    let heights = heights(args)?;
    files::check_folder(&args.output)?;
    not_among_inputs(args)?;
    let progress = Progress::new(4, silent);
    progress.step("reading");
    let source = source::read(&args.board)?;
    let parts = plan::parts(&source.artwork, args)?;
    let surface = surface(&parts, args)?;
    if let Some(places) = args.running.probe.filter(|_| args.running.on_control) {
        can_probe(&parts, places, &machine)?;
    }
    progress.step("planning");
    let side = |face: Face, board: Board| planned(face, board, &parts, args, &machine);
    let ([front, back], mut warnings) = source.artwork.each_side(side).map_err(Stop::invalid)?;
    let ((front, mut works), (back, more)) = (front?, back?);
    works.extend(more);
    works.sort_by_key(|(part, _)| plan::order(*part, args));
    warnings.extend(plan::late_pins(&parts, args));
    let rack = Rack::of(&works);
    progress.step("writing and proving");
    let shop = Shop { args, machine: &machine, front, back, rack, heights, surface };
    let mut programs = Vec::with_capacity(works.len() + 1);
    if let Some(grid) = args.running.probe.filter(|_| !args.running.on_control) {
        programs.push(shop.probing(grid)?);
    }
    let made: Vec<_> = works.par_iter().map(|(part, work)| shop.make(*part, work)).collect();
    for (made, (part, work)) in made.into_iter().zip(works) {
        let (posted, picture) = made?;
        let probes = shop.probes(part, &work);
        let up = Some(plan::face(part, args));
        programs.push(Made { name: part.name(), up, work, posted, picture, probes });
    }
    for made in &programs {
        let file = format!("{}.nc", made.name);
        warnings.extend(made.work.warnings.iter().map(|found| found.clone().file(&file)));
    }
    if let Some(failed) =
        programs.iter().position(|made| made.posted.account.verdict != Verdict::Done)
    {
        return Ok(programs.swap_remove(failed).posted.account.not_saved());
    }
    let mut warnings = toolpath::held(warnings, args.strict)?;
    warnings.extend(older(args, &programs));
    progress.step("saving");
    let report =
        report::of(&source.layers, &shop.front.board, args, &programs, &machine, &warnings);
    let saved = save(args, &source.files, &programs, &format!("{:#}\n", report.data))?;

    let mut lines = report.rows;
    let folder = args.output.display();
    lines.push(("saved", format!("in {folder}: {}", saved.join(", "))));
    Ok(Answer::summary(Verdict::Done, rows(&lines), report.data).findings(warnings))
}

/// How the board lies with a side up, and what is cut of it then.
fn planned(
    face: Face,
    board: Board,
    parts: &[Part],
    args: &Pcb,
    machine: &Machine,
) -> Result<(Setup, Vec<(Part, Work)>), Stop> {
    let setup = Setup::of(face, board, args)?;
    let parts = parts.par_iter().filter(|part| plan::face(**part, args) == face);
    let works = parts.map(|part| Ok((*part, Work::of(*part, &setup, args, machine)?)));
    let works = works.collect::<Vec<_>>().into_iter().collect::<Result<_, Stop>>()?;
    Ok((setup, works))
}

/// Refuses a folder of output that is the board's own: what is saved there would be read as the board's the
/// next time.
fn not_among_inputs(args: &Pcb) -> Result<(), Stop> {
    let whole = |path: &Path| std::fs::canonicalize(path).ok();
    let output = whole(&args.output);
    if args.board.iter().any(|path| path.is_dir() && whole(path) == output) {
        let message = "the programs would be saved among the files of the board";
        let found = Diagnostic::error("output-folder", message).help("give a folder of its own");
        return Err(found.file(args.output.display().to_string()).into());
    }
    Ok(())
}

/// The tools of all programs of a board: each has one number, whichever program calls it.
struct Rack(Vec<String>);

impl Rack {
    fn of(works: &[(Part, Work)]) -> Rack {
        let mut names: Vec<String> = Vec::new();
        for operation in works.iter().flat_map(|(_, work)| &work.operations) {
            if !names.contains(&operation.tool.name) {
                names.push(operation.tool.name.clone());
            }
        }
        Rack(names)
    }

    /// The number of a tool, from 1.
    fn number(&self, tool: &str) -> u32 {
        let place = self.0.iter().position(|name| name == tool).unwrap_or(self.0.len());
        u32::try_from(place + 1).unwrap_or(u32::MAX)
    }

    /// The first number that no tool has.
    fn next(&self) -> u32 {
        self.number("")
    }
}

/// Tells of programs and pictures of another call that stay beside those of this one.
fn older(args: &Pcb, programs: &[Made]) -> Option<Diagnostic> {
    let is_made = |name: &str| programs.iter().any(|made| made.name == name);
    let names = Part::ALL.into_iter().map(Part::name).chain([PROBE]);
    let others = names.filter(|name| !is_made(name)).map(|name| format!("{name}.nc"));
    let there: Vec<String> = others.filter(|file| args.output.join(file).exists()).collect();
    (!there.is_empty()).then(|| {
        let message = format!("of an earlier call there are still {}", there.join(", "));
        let help = "they are not of these programs: remove them, or save in a new folder";
        Diagnostic::warning("file-older", message).help(help)
    })
}

/// How high tools are above the board.
fn heights(args: &Pcb) -> Result<Heights, Stop> {
    let heights = Heights { travel: args.running.travel, approach: args.running.approach };
    let Heights { travel, approach } = heights;
    if travel >= approach {
        return Ok(heights);
    }
    let message =
        format!("rapid moves are {travel} mm over the board, and tools feed from {approach} mm on");
    let help = "give --travel no less than --approach";
    Err(Diagnostic::error("travel", message).help(help).into())
}

/// How far inside the edge of the board the outermost places are, mm: on the edge itself there may be no copper.
const INSIDE: f64 = 1.0;

/// How closely programs follow the surface that was measured, and up to 5 mm beyond the board the height of the
/// outermost places.
const LEVELLED: Allowed = Allowed { deviation: 0.005, outside: INSIDE + 5.0 };

/// The surface that programs follow, where one was measured.
fn surface(parts: &[Part], args: &Pcb) -> Result<Option<HeightMap>, Stop> {
    let Some(file) = &args.running.heights else { return Ok(None) };
    let is_up = |face| parts.iter().any(|part| plan::face(*part, args) == face);
    if is_up(Face::Front) && is_up(Face::Back) {
        let message = "the heights are those of one side, and programs of both are asked for";
        let help = "make the programs of each side with its own heights: name them with --only";
        return Err(Diagnostic::error("heights", message).help(help).into());
    }
    let text = files::text(file)?;
    Ok(Some(levelling::read(&files::name(file), &text).map_err(Stop::invalid)?))
}

/// How much a surface rises on which programs that measure it keep to that, mm a mm.
const STEEPNESS: f64 = 0.02;

/// # Errors
/// The control cannot keep what a probe finds at so many places, or a program cuts what no tool feels.
fn can_probe(parts: &[Part], [columns, rows]: [u32; 2], machine: &Machine) -> Result<(), Stop> {
    let wrong = |message: String, help: &str| {
        Err(Diagnostic::error("on-control", message).help(help).into())
    };
    if !machine.blocks.contains_key("keep_height") {
        let message = format!(
            "`{}` has a control that keeps no heights to calculate with: it cannot follow what it measures",
            machine.name
        );
        let help = "leave out --on-control: run probe.nc first, and give its heights by --heights";
        return wrong(message, help);
    }
    let kept =
        machine.words.get("HEIGHT").map_or(0.0, |word| word.max - f64::from(word.first) + 1.0);
    if f64::from(columns) * f64::from(rows) > kept {
        let message = format!("{columns} by {rows} places, and the control keeps {kept} heights");
        return wrong(message, "fewer columns or rows");
    }
    let is_coated = |part: &&Part| part.face().is_some() && !part.is_copper();
    if let Some(part) = parts.iter().find(is_coated) {
        let message = format!("the {} conducts nothing: the tool does not feel it", part.what());
        return wrong(
            message,
            "make the programs of the copper by themselves: name them with --only",
        );
    }
    match parts.iter().any(|part| part.is_copper()) {
        true => Ok(()),
        false => wrong(
            "no program cuts copper: none would measure".into(),
            "leave out --probe and --on-control",
        ),
    }
}

/// A program that was made.
struct Made {
    /// What it and its picture are called.
    name: &'static str,
    /// The side of the board that is up when it runs; `None` where it is run for either.
    up: Option<Face>,
    work: Work,
    posted: Posted,
    picture: Option<Vec<u8>>,
    /// Columns and rows of the heights that it measures itself.
    probes: Option<[u32; 2]>,
}

/// How the height of the board is probed: slowly, and a millimetre above what it may rise to from place to place.
const PROBED: Probing = Probing { travel: 2.0, reach: 1.0, feed: 50.0 };

/// What the program is called that measures the height of the board.
const PROBE: &str = "probe";

/// The file in which LinuxCNC keeps what it finds; to other controls it is a comment.
const HEIGHTS: &str = "heights.txt";

/// What all programs of a board share.
struct Shop<'a> {
    args: &'a Pcb,
    machine: &'a Machine,
    /// The board with its front up.
    front: Setup,
    /// The board with its back up.
    back: Setup,
    rack: Rack,
    heights: Heights,
    /// The surface that programs follow, where one was measured.
    surface: Option<HeightMap>,
}

impl Shop<'_> {
    /// How the board lies for a program.
    fn setup(&self, part: Part) -> &Setup {
        match plan::face(part, self.args) {
            Face::Front => &self.front,
            Face::Back => &self.back,
        }
    }

    /// The program of a part of the board, proven, and its picture.
    fn make(&self, part: Part, work: &Work) -> Result<(Posted, Option<Vec<u8>>), Stop> {
        let board = &self.setup(part).board;
        let name = format!("{}-{}", board.name, part.name());
        let number = |operation: &Operation| self.rack.number(&operation.tool.name);
        let operations: Vec<(u32, &Operation)> =
            work.operations.iter().map(|operation| (number(operation), operation)).collect();
        let mut program =
            job::program(&name, &operations, &self.heights).map_err(Box::<Diagnostic>::from)?;
        if let Some(surface) = &self.surface {
            program = level(&program, surface, &LEVELLED)?;
        }
        if let Some(places) = self.probes(part, work) {
            let grid = grid(board, places)?;
            self.touches(part, work, &grid)?;
            program = follow(&program, &grid, &PROBED, STEEPNESS, &LEVELLED)?;
        }
        let toolpath = Toolpath::of_program(program, "board");
        let format = match self.args.picture {
            Picture::Svg => Some(Format::Svg),
            Picture::Png => Some(Format::Png),
            Picture::None => None,
        };
        let widths: Vec<f64> = work.operations.iter().map(Operation::width).collect();
        let picture = BoardPicture {
            outline: board.outline.as_ref(),
            copper: board.front.copper.as_ref(),
            holes: &board.holes,
            program: &toolpath.program,
            widths: &widths,
            problems: &work.places,
        };
        let (posted, picture) = rayon::join(
            || self.proven(&toolpath, part.name()),
            || format.map(|format| format.bytes(drawing::board(&name, &picture))).transpose(),
        );
        Ok((posted?, picture?))
    }

    /// Columns and rows of the heights that the program of a part measures itself, where it cuts anything.
    fn probes(&self, part: Part, work: &Work) -> Option<[u32; 2]> {
        let running = &self.args.running;
        let cuts = work.operations.iter().any(|operation| !operation.cuts.is_empty());
        running.probe.filter(|_| running.on_control && part.is_copper() && cuts)
    }

    /// # Errors
    /// A place at which the tool touches the rim of a hole, or nothing, since the holes are there already. What counts
    /// is the width that it has at the surface when its tip is as deep as it probes.
    fn touches(&self, part: Part, work: &Work, grid: &Grid) -> Result<(), Stop> {
        if !plan::is_drilled(part, self.args) {
            return Ok(());
        }
        let width = |operation: &Operation| operation.tool.cutter.width(PROBED.reach);
        let beside = work.operations.first().map_or(0.0, width) / 2.0;
        for place in grid.places() {
            let mut holes = self.setup(part).drilled();
            let Some(hole) = holes.find(|hole| hole.distance(place) < beside) else { continue };
            let (low, high) = hole.extents();
            let at = low.midpoint(high);
            let message = format!(
                "the height is measured at X{:.3} Y{:.3}, in the hole of {} mm at X{:.3} Y{:.3} or less than {beside:.3} mm \
                 beside it, and it is drilled before",
                place.x, place.y, hole.diameter, at.x, at.y
            );
            let help = "another number of columns or rows, or --from back: then holes are drilled after the back is cut";
            let found = Diagnostic::error("probe-in-hole", message).help(help);
            return Err(found.file(format!("{}.nc", part.name())).into());
        }
        Ok(())
    }

    /// The program that measures the height of the board.
    fn probing(&self, places: [u32; 2]) -> Result<Made, Stop> {
        let grid = grid(&self.front.board, places)?;
        let name = format!("{}-{PROBE}", self.front.board.name);
        let mut program = PROBED.program(&name, &grid, Some(HEIGHTS))?;
        let tool = program::Tool {
            number: self.rack.next(),
            name: String::from(PROBE),
            ..program::Tool::default()
        };
        program.records.insert(0, Record { line: 0, op: Op::Tool(Box::new(tool)) });
        let posted = self.proven(&Toolpath::of_program(program, "board"), PROBE)?;
        let (work, picture, probes) = (Work::default(), None, None);
        Ok(Made { name: PROBE, up: None, work, posted, picture, probes })
    }

    /// The text of a program, proven.
    fn proven(&self, toolpath: &Toolpath, name: &str) -> Result<Posted, Stop> {
        let tolerances = self.args.closeness.tolerances();
        let file = format!("{name}.nc");
        post::proven(toolpath, self.machine, &file, &tolerances, &|_| {})
    }
}

/// So many columns and rows of places over a board, [`INSIDE`] its edge; on a small one a quarter of it.
fn grid(board: &Board, [columns, rows]: [u32; 2]) -> Result<Grid, Stop> {
    let (low, high) = board.extents().unwrap_or_default();
    let inside = Vec2::splat(INSIDE).min((high - low) / 4.0);
    Ok(Grid::new(low + inside, high - inside, columns as usize, rows as usize)?)
}

/// Saves everything, or nothing; answers the names of the files.
fn save(
    args: &Pcb,
    inputs: &[std::path::PathBuf],
    programs: &[Made],
    report: &str,
) -> Result<Vec<String>, Stop> {
    let mut contents: Vec<(String, &[u8])> = vec![("report.json".into(), report.as_bytes())];
    let ending = if args.picture == Picture::Png { "png" } else { "svg" };
    for made in programs {
        let name = made.name;
        contents.extend(made.picture.as_deref().map(|bytes| (format!("{name}.{ending}"), bytes)));
    }
    for made in programs {
        contents.push((format!("{}.nc", made.name), &made.posted.text));
    }
    let inputs: Vec<&Path> = inputs.iter().map(|file| file.as_path()).collect();
    let made = files::folder(&args.output)?;
    let mut targets = Vec::with_capacity(contents.len());
    for (name, _) in &contents {
        targets.push(Target::new(&args.output.join(name), &inputs)?);
    }
    let bytes = contents.iter().map(|(_, bytes)| *bytes);
    files::save(&targets.iter().zip(bytes).collect::<Vec<_>>())?;
    made.keep();
    Ok(contents.into_iter().map(|(name, _)| name).collect())
}
