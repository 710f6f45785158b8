//! Circuit boards: a board in, the proven programs that isolate, drill and cut it out. What each program cuts is planned by
//! the crate `pcb`.

mod report;
mod source;

pub use ::pcb::board::{Axis, Layer};
pub use ::pcb::plan::{Problem, Settings};
pub use ::pcb::{Drawn, Line};
pub use drawing::{Area, AreaKind, BoardAreas};
pub use source::{SETTINGS, is_board, is_named_board};

use crate::account::{Account, Stop, Verdict};
use crate::input;
use crate::post::{self, Posted};
use crate::prove;
use crate::summary::number;
use crate::toolpath::{self, Toolpath};
use crate::watch::Watch;
use ::pcb::board::Face;
use ::pcb::job::{self, Heights};
use ::pcb::plan::{self, Part, Running, Setup, Work};
use ::pcb::{Board, Operation};
use control::Folders;
use drawing::{BoardPicture, BoardSheet, BoardSide, Format};
use geom::Vec2;
use levelling::{Allowed, Grid, Probing, follow, level};
use machine::limits::Limits;
use machine::{Machine, OptionKey, OptionValue};
use program::heights::HeightMap;
use program::{Diagnostic, Feed, Op, Record, Rule, Spindle, not_both};
use proof::{Observer, Tolerances};
use rayon::prelude::*;
use serde_json::json;
use std::borrow::Cow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is made of a board, and on which machine.
pub struct Job<'a> {
    machine: &'a Machine,
    settings: &'a Settings,
    tolerances: &'a Tolerances,
    heights: Heights,
    /// Measured heights that the programs follow: what a probing program has logged, or X, Y and Z in columns.
    pub surface: Option<input::Source>,
    /// Files of the board of which the caller says what they hold.
    pub named: Vec<(input::Source, Layer)>,
    /// The name of a folder of which the board's files are all that are in it, where a caller has them in memory: what is no file of
    /// a board is left out then, and not refused.
    pub folder: Option<String>,
    /// How a picture is drawn next to each program; `None`: not at all.
    pub picture: Option<Format>,
    /// Whether a warning about the board, or a program that cannot be made, stops the work.
    pub strict: bool,
    /// The options with which the board is made, as they are typed: the report keeps them for a later proof.
    pub options: Vec<String>,
}

/// A program of a board that was there already, compared with what is made of the board.
pub struct Compared {
    /// What is reported of it.
    pub account: Account,
    /// What it was compared with.
    pub toolpath: Toolpath,
    /// The machine that it is for, with the program's own number.
    pub machine: Machine,
    /// As of [`Program::widths`].
    pub widths: Vec<(u32, String, f64)>,
    /// What the board is called.
    pub board: String,
    /// As of [`Made::files`].
    pub files: Vec<input::Source>,
    /// As of [`Made::layers`].
    pub layers: Vec<(String, String)>,
    kind: source::Kind,
    /// What of the board it is about, and how that lies; `None` where it measures its height.
    placed: Option<(Part, Setup)>,
}

/// The programs of a board.
pub struct Made {
    /// Those that are proven, in the order in which they are run.
    pub programs: Vec<Program>,
    /// Those that are not made.
    pub left_out: Vec<LeftOut>,
    /// The files that were read.
    pub files: Vec<input::Source>,
    layers: Vec<(String, String)>,
    kind: source::Kind,
    /// The board with its front up, and with its back up.
    setups: [Setup; 2],
    /// Whether it is turned over for one of the programs.
    is_turned: bool,
    warnings: Vec<Diagnostic>,
    /// Both sides on a sheet to print, where the caller wants pictures.
    sheet: Option<Vec<u8>>,
}

impl<'a> Job<'a> {
    /// What `settings` ask for, on `machine`.
    ///
    /// # Errors
    /// The machine is no mill, or the settings contradict each other.
    pub fn new(
        machine: &'a Machine,
        settings: &'a Settings,
        tolerances: &'a Tolerances,
    ) -> Result<Job<'a>, Stop> {
        if machine.wire.is_some() {
            let message = format!("`{}` cuts by wire: it mills and drills nothing", machine.name);
            let help = "name a mill: `toolpost machines` lists what there is";
            return Err(Diagnostic::error(Rule::MachineKind, message).help(help).into());
        }
        settings.check()?;
        let heights = heights(&settings.running)?;
        let (surface, folder, picture, strict) = (None, None, None, false);
        let (named, options) = (Vec::new(), Vec::new());
        Ok(Job {
            machine,
            settings,
            tolerances,
            heights,
            surface,
            named,
            folder,
            picture,
            strict,
            options,
        })
    }

    /// Writes the programs of the board that `board` is (a folder of files, some files, a board of KiCad's, a model) and
    /// proves them, all at the same time.
    ///
    /// # Errors
    /// What is wrong with the board; where none of its programs can be made, or one cannot and the job is strict, why. A program
    /// that cannot be made is left out otherwise, and all others are made.
    pub fn make(&self, board: &[input::Source], watch: &dyn Watch) -> Result<Made, Stop> {
        let running = &self.settings.running;
        let Begun { shop, tasks, mut left_out, mut warnings, layers, files, kind } =
            self.begun(board, watch)?;
        let mut programs = Vec::with_capacity(tasks.len() + 1);
        if let Some(grid) = running.probe.filter(|_| !running.on_control) {
            let probing = shop.probing(grid)?;
            if probing.posted.account.verdict != Verdict::Done {
                return Err(probing.posted.account.into());
            }
            programs.push(probing);
        }
        let done = AtomicUsize::new(0);
        let made = tasks.par_iter().map(|task| {
            let made = shop.made(task);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            watch.reached(done as f64 / tasks.len() as f64);
            made
        });
        let made: Vec<_> = made.collect();
        for (made, task) in made.into_iter().zip(tasks) {
            let part = task.part;
            let Cut { toolpath, machine, posted, picture } = match made {
                Ok(made) => made,
                Err(stop) if stop.verdict == Verdict::Cancelled => return Err(stop),
                Err(stop) => {
                    left_out.push(self.left_out(part, stop));
                    continue;
                }
            };
            if posted.account.verdict != Verdict::Done {
                left_out.push(self.left_out(part, posted.account.into()));
                continue;
            }
            let probes = shop.probes(part, &task.work);
            let up = Some(plan::face(part, self.settings));
            let Task { name, work, .. } = task;
            let file = self.file(&name);
            programs.push(Program {
                name,
                file,
                part: Some(part),
                up,
                work,
                toolpath,
                machine,
                posted,
                picture,
                probes,
            });
        }
        for made in &programs {
            warnings.extend(made.work.warnings.iter().map(|found| found.clone().file(&made.file)));
        }
        if left_out.is_empty() {
            warnings = toolpath::held(warnings, self.strict)?;
        }
        let sheet = self.picture.map(|format| format.bytes(shop.sheet())).transpose()?;
        let Shop { front, back, is_turned, .. } = shop;
        let setups = [front, back];
        Ok(Made { programs, left_out, files, layers, kind, setups, is_turned, warnings, sheet })
    }

    /// Proves the text of the program `name` (`front`, `drill`), which is called `file` and may call those of `folders`, against what
    /// the same job makes of the board.
    ///
    /// # Errors
    /// What is wrong with the board; `no-such-part` where the job makes no program of this name.
    pub fn prove(
        &self,
        board: &[input::Source],
        (name, file): (&str, &str),
        (text, folders): (&[u8], &Folders),
        watch: &dyn Watch,
    ) -> Result<Compared, Stop> {
        let running = &self.settings.running;
        let Begun { shop, tasks, layers, files, kind, .. } = self.begun(board, watch)?;
        let is_called = |of: &str| of == name || self.file(of) == file;
        let probe = running.probe.filter(|_| is_called(PROBE) && !running.on_control);
        let (toolpath, place) = match (probe, tasks.iter().find(|task| is_called(&task.name))) {
            (Some(places), _) => (shop.probe_path(places)?, Part::ALL.len()),
            (None, Some(task)) => (shop.toolpath(task)?, task.place),
            (None, None) => {
                let made: Vec<&str> = tasks.iter().map(|task| task.name.as_str()).collect();
                let message =
                    format!("no program of this board is called `{name}`: {}", made.join(", "));
                let help =
                    "name the file as it was saved, and give the settings with which it was made";
                return Err(Diagnostic::error(Rule::NoSuchPart, message).help(help).into());
            }
        };
        let machine = self.shaped(numbered(self.machine, place)).into_owned();
        let text = (file, text, folders);
        let account = prove::compare(&toolpath, &machine, text, self.tolerances, watch)?;
        let (part, work) = match tasks.into_iter().find(|task| is_called(&task.name)) {
            Some(Task { part, work, .. }) => (Some(part), work),
            None => (None, Work::default()),
        };
        let widths = widths(&toolpath, &work);
        let board = shop.front.board.name.clone();
        let placed = part.map(|part| match plan::face(part, self.settings) {
            Face::Front => (part, shop.front),
            Face::Back => (part, shop.back),
        });
        Ok(Compared { account, toolpath, machine, widths, board, files, layers, kind, placed })
    }

    /// Everything up to the programs: the board is read, and what is cut of it is planned.
    fn begun<'s>(
        &'s self,
        board: &[input::Source],
        watch: &'s dyn Watch,
    ) -> Result<Begun<'s>, Stop> {
        let Job { machine, settings, .. } = *self;
        let measured = settings.running.on_control && self.surface.is_some();
        not_both("on_control", "heights", measured)?;
        watch.begin("reading")?;
        let source = source::read(board, &self.named, self.folder.as_deref(), settings)?;
        let parts = plan::parts(&source.artwork, settings)?;
        can_run(&parts, settings, machine)?;
        let deep = plan::deep_cuts(&parts, settings)?;
        let surface = surface(&parts, settings, self.surface.as_ref())?;
        let running = &settings.running;
        if let Some(places) = running.probe.filter(|_| running.on_control) {
            can_probe(&parts, places, machine)?;
        }
        watch.begin("planning")?;
        let side = |face: Face, board: Board| {
            planned(face, board, &parts, settings, machine.spindle.max, watch)
        };
        let ([front, back], mut warnings) = source.artwork.each_side(side)?;
        let ((front, mut planned), (back, more)) = (front?, back?);
        planned.extend(more);
        planned.sort_by_key(|(part, _)| plan::order(*part, settings));
        let (works, left_out) = self.divided(planned)?;
        warnings.extend(deep);
        warnings.extend(plan::late_pins(&parts, settings));
        let rack = Rack::of(&works);
        let is_turned = works.iter().any(|(part, _)| plan::face(*part, settings) == Face::Back);
        watch.begin("writing and proving")?;
        let shop = Shop { job: self, front, back, is_turned, rack, watch, surface };
        let tasks = tasks(works, running.split_tools);
        let source::Source { layers, files, kind, .. } = source;
        Ok(Begun { shop, tasks, left_out, warnings, layers, files, kind })
    }

    /// The file in which a program of this name is saved.
    fn file(&self, name: &str) -> String {
        file_of(self.machine, name)
    }

    fn left_out(&self, part: Part, stop: Stop) -> LeftOut {
        LeftOut { part, file: self.file(part.name()), account: stop.into() }
    }

    /// The work of programs, apart from those that cannot be made.
    ///
    /// # Errors
    /// A setting is wrong, no program can be made, or one cannot and the job is strict.
    fn divided(&self, planned: Vec<Planned>) -> Result<(Works, Vec<LeftOut>), Stop> {
        let (mut works, mut left_out) = (Vec::with_capacity(planned.len()), Vec::new());
        for (part, work) in planned {
            match work {
                Ok(work) => works.push((part, work)),
                Err(findings) => left_out.push(self.left_out(part, Stop::invalid(findings))),
            }
        }
        let findings = || left_out.iter().flat_map(|left| &left.account.findings);
        let is_refused = self.strict || findings().any(plan::is_about_settings);
        if works.is_empty() || is_refused && !left_out.is_empty() {
            // What is wrong with both sides is said once.
            let mut said: Vec<Diagnostic> = Vec::new();
            for found in findings() {
                if !said.contains(found) {
                    said.push(found.clone());
                }
            }
            return Err(Stop::invalid(said));
        }
        Ok((works, left_out))
    }
}

impl Job<'_> {
    /// The machine with what this job says otherwise: how long its spindle is waited for, and text of the user's.
    fn shaped<'m>(&self, machine: Cow<'m, Machine>) -> Cow<'m, Machine> {
        let Running { spin_up, text: [before, after], .. } = &self.settings.running;
        if spin_up.is_none() && before.is_empty() && after.is_empty() {
            return machine;
        }
        let mut machine = machine.into_owned();
        machine.spindle.dwell = spin_up.unwrap_or(machine.spindle.dwell);
        if let Some(block) = machine.blocks.get_mut("program_start").filter(|_| !before.is_empty())
        {
            block.text = format!("{}\n{}\n", block.text.trim_end_matches('\n'), plain(before));
        }
        if let Some(block) = machine.blocks.get_mut("program_end").filter(|_| !after.is_empty()) {
            block.text = format!("{}\n{}", plain(after), block.text);
        }
        Cow::Owned(machine)
    }
}

/// A text as a block that is written as it stands.
fn plain(text: &str) -> String {
    // Nothing of it is taken for the end of what stands as it is.
    let text = text.trim_end().replace("{%", "{ %");
    format!("{{% raw %}}{text}{{% endraw %}}")
}

impl Compared {
    /// As of [`Made::lines`].
    pub fn lines(&self, job: &Job) -> Vec<Option<Line>> {
        let Some((part, setup)) = &self.placed else { return Vec::new() };
        let drawn = source::drawn(&self.files, &self.kind, job.settings);
        drawn.lines(*part, setup, job.settings, &self.toolpath.program)
    }
}

impl Made {
    /// What is reported of all programs together, and of `more` that the caller has found; where nothing is saved, what is
    /// reported of the first program that is not proven.
    pub fn account(&self, job: &Job, more: Vec<Diagnostic>) -> Account {
        let nothing = self.programs.iter().all(|made| made.up.is_none());
        if let Some(first) = self.left_out.first().filter(|_| nothing || job.strict) {
            return first.account.clone();
        }
        let mut findings = self.warnings.clone();
        findings.extend(more);
        let mut report = report::of(self, job.settings, job.machine, &findings);
        report.data["options"] = json!(job.options);
        findings.extend(self.left_out.iter().flat_map(LeftOut::findings));
        let verdict = if self.left_out.is_empty() { Verdict::Done } else { Verdict::Partly };
        Account { verdict, rows: report.rows, data: report.data, findings }
    }
}

impl Made {
    /// The board as it lies for one of its programs, as areas.
    pub fn areas(&self, program: &Program) -> BoardAreas {
        let [front, back] = &self.setups;
        let setup = if program.up == Some(Face::Back) { back } else { front };
        let Program { work, toolpath, .. } = program;
        BoardAreas::of(&picture(setup, work, &toolpath.program, self.is_turned))
    }

    /// What the files of the board draw: they are read once more.
    pub fn drawn(&self, job: &Job) -> Drawn {
        source::drawn(&self.files, &self.kind, job.settings)
    }

    /// Of each record of a program's toolpath the line of [`Made::files`] that it comes from.
    pub fn lines(&self, job: &Job, drawn: &Drawn, program: &Program) -> Vec<Option<Line>> {
        let [front, back] = &self.setups;
        let setup = if program.up == Some(Face::Back) { back } else { front };
        let lines = |part| drawn.lines(part, setup, job.settings, &program.toolpath.program);
        program.part.map(lines).unwrap_or_default()
    }

    /// What the board is called.
    pub fn name(&self) -> &str {
        &self.setups[0].board.name
    }

    /// The files that were read, and what each was taken for.
    pub fn layers(&self) -> &[(String, String)] {
        &self.layers
    }

    /// All files that are saved, by their names: the report first, pictures, and the programs at last.
    pub fn contents<'a>(&'a self, job: &Job, report: &'a str) -> Vec<(String, &'a [u8])> {
        let ending = if matches!(job.picture, Some(Format::Png)) { "png" } else { "svg" };
        let mut contents = vec![(String::from("report.json"), report.as_bytes())];
        contents.extend(self.sheet.as_deref().map(|bytes| (format!("{SHEET}.{ending}"), bytes)));
        for Program { name, picture, .. } in &self.programs {
            contents.extend(picture.as_deref().map(|bytes| (format!("{name}.{ending}"), bytes)));
        }
        for Program { file, posted, .. } in &self.programs {
            contents.extend(posted.parts.iter().map(|part| (part.file.clone(), &part.text[..])));
            contents.push((file.clone(), &posted.text));
        }
        contents
    }
}

/// A board that is read, and what is cut of it.
struct Begun<'a> {
    shop: Shop<'a>,
    tasks: Vec<Task>,
    left_out: Vec<LeftOut>,
    warnings: Vec<Diagnostic>,
    layers: Vec<(String, String)>,
    files: Vec<input::Source>,
    kind: source::Kind,
}

/// Every program is written and proven for who watches all of them: their steps are not reported.
struct Quiet<'a>(&'a dyn Watch);

impl Watch for Quiet<'_> {
    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }

    fn follow<'a>(
        &'a self,
        file: &str,
        source: &'a ::program::Program,
        machine: &'a Machine,
    ) -> Box<dyn Observer + 'a> {
        self.0.follow(file, source, machine)
    }
}

/// What programs do.
type Works = Vec<(Part, Work)>;

/// What one program does.
struct Task {
    part: Part,
    /// What the program is called.
    name: String,
    /// How many programs are before it of all that a board can have.
    place: usize,
    work: Work,
}

/// A program for each part of the board, or for each tool of each.
fn tasks(works: Works, split: bool) -> Vec<Task> {
    let place = |part: Part| Part::ALL.iter().position(|other| *other == part).unwrap_or_default();
    // Those of the parts, and the probe.
    let mut more = Part::ALL.len() + 1;
    let mut tasks = Vec::with_capacity(works.len());
    for (part, mut work) in works {
        let operations = std::mem::take(&mut work.operations);
        if !split || operations.len() < 2 {
            work.operations = operations;
            tasks.push(Task { part, name: part.name().to_owned(), place: place(part), work });
            continue;
        }
        for (i, operation) in operations.into_iter().enumerate() {
            let name = format!("{}-{}-{}mm", part.name(), i + 1, number(operation.width(), 3));
            // What is odd about all of them is reported with the first.
            let work = Work { operations: vec![operation], ..std::mem::take(&mut work) };
            tasks.push(Task { part, name, place: more, work });
            more += 1;
        }
    }
    tasks
}

/// What a program does, or why it cannot.
type Planned = (Part, Result<Work, Vec<Diagnostic>>);

/// How the board lies with a side up, and what is cut of it then.
fn planned(
    face: Face,
    board: Board,
    parts: &[Part],
    settings: &Settings,
    fastest: f64,
    watch: &dyn Watch,
) -> Result<(Setup, Vec<Planned>), Stop> {
    watch.go_on()?;
    let setup = Setup::of(face, board, settings)?;
    let parts = parts.par_iter().filter(|part| plan::face(**part, settings) == face);
    let goes_on = |_| !watch.is_cancelled();
    let works = parts.map(|part| {
        watch.go_on()?;
        Ok((*part, Work::of(*part, &setup, settings, fastest, &goes_on)))
    });
    let works = works.collect::<Result<_, Stop>>()?;
    watch.go_on()?;
    Ok((setup, works))
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

/// How high tools are above the board.
fn heights(running: &Running) -> Result<Heights, Stop> {
    let heights = Heights { travel: running.travel, approach: running.approach };
    let Heights { travel, approach } = heights;
    if travel >= approach {
        return Ok(heights);
    }
    let message =
        format!("rapid moves are {travel} mm over the board, and tools feed from {approach} mm on");
    let help = "give --travel no less than --approach";
    Err(Diagnostic::error(Rule::TravelHeight, message).help(help).into())
}

/// How far inside the edge of the board the outermost places are, mm: on the edge itself there may be no copper.
const INSIDE: f64 = 1.0;

/// How closely programs follow the surface that was measured, and up to 5 mm beyond the board the height of the
/// outermost places.
const LEVELLED: Allowed = Allowed { deviation: 0.005, outside: INSIDE + 5.0 };

/// The surface that programs follow, where one was measured.
fn surface(
    parts: &[Part],
    settings: &Settings,
    heights: Option<&input::Source>,
) -> Result<Option<HeightMap>, Stop> {
    let Some(file) = heights else { return Ok(None) };
    let is_up = |face| parts.iter().any(|part| plan::face(*part, settings) == face);
    if is_up(Face::Front) && is_up(Face::Back) {
        let message = "a height map is of one side, and programs of both sides would be written";
        let help = "make the programs of each side with its own heights: name them with --only";
        return Err(Diagnostic::error(Rule::Heights, message).help(help).into());
    }
    let text = file.text()?;
    Ok(Some(levelling::read(&file.name(), &text)?))
}

/// How much a surface rises on which programs that measure it keep to that, mm a mm.
const STEEPNESS: f64 = 0.02;

/// # Errors
/// A feed or the speed of the settings is beyond what the machine does, and one of `parts` asks for it. The message begins with the
/// name of the setting.
fn can_run(parts: &[Part], settings: &Settings, machine: &Machine) -> Result<(), Stop> {
    let running = &settings.running;
    let is_milled = settings.drilling.hole_mill.is_some();
    let cuts = |part: &Part| !matches!(part, Part::Drill | Part::Outline);
    let mills = |part: &Part| *part == Part::Outline || *part == Part::Drill && is_milled;
    let any = |takes: &dyn Fn(&Part) -> bool| parts.iter().any(takes);
    let limits = Limits::new(machine);
    let feed = |name, feed: f64, is_used: bool| {
        let wrong =
            limits.feed(Feed::PerMinute(feed), Spindle::Off, 0).err().filter(|_| is_used)?;
        Some(Diagnostic { message: format!("`{name}` is {feed} mm/min"), ..*wrong })
    };
    let speed = |speed: f64| {
        let wrong = limits.spindle(Spindle::Clockwise(speed), 0).err()?;
        Some(Diagnostic { message: format!("`speed` is {speed} 1/min"), ..*wrong })
    };
    let found = [
        feed("feed", running.feed, any(&cuts)),
        feed("plunge", running.plunge, any(&|part| cuts(part) || mills(part))),
        feed("drill_feed", running.drill_feed, any(&|part| *part == Part::Drill)),
        feed("outline_feed", running.outline_feed, any(&mills)),
        running.speed.and_then(speed),
    ];
    let findings: Vec<Diagnostic> = found.into_iter().flatten().collect();
    match findings.is_empty() {
        true => Ok(()),
        false => Err(Stop { verdict: Verdict::Failed, findings }),
    }
}

/// # Errors
/// The control cannot keep what a probe finds at so many places, or a program cuts what no tool feels.
fn can_probe(parts: &[Part], [columns, rows]: [u32; 2], machine: &Machine) -> Result<(), Stop> {
    let wrong = |message: String, help: &str| {
        Err(Diagnostic::error(Rule::OnControl, message).help(help).into())
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
pub struct Program {
    /// What its picture is called.
    pub name: String,
    /// What it is called, as the control wants it.
    pub file: String,
    /// What of the board it is about; `None` where it measures its height.
    part: Option<Part>,
    /// The side of the board that is up when it runs; `None` where it is run for either.
    up: Option<Face>,
    work: Work,
    /// What it is to do.
    pub toolpath: Toolpath,
    /// The machine that it is for, with the program's own number.
    pub machine: Machine,
    /// The program, and what is reported of it.
    pub posted: Posted,
    /// Its picture, where the caller wants one.
    pub picture: Option<Vec<u8>>,
    /// Columns and rows of the heights that it measures itself.
    probes: Option<[u32; 2]>,
}

impl Program {
    /// Its tools, by number and name, and how wide each cuts where it goes deepest, mm; one that is called twice comes twice.
    pub fn widths(&self) -> Vec<(u32, String, f64)> {
        widths(&self.toolpath, &self.work)
    }
}

fn widths(toolpath: &Toolpath, work: &Work) -> Vec<(u32, String, f64)> {
    let tools = toolpath.program.records.iter().filter_map(|record| match &record.op {
        Op::Tool(tool) => Some((tool.number, tool.name.clone())),
        _ => None,
    });
    let widths = work.operations.iter().map(Operation::width);
    tools.zip(widths).map(|((number, name), width)| (number, name, width)).collect()
}

/// A program that is not made.
pub struct LeftOut {
    /// What it is about.
    pub part: Part,
    /// The file in which it would be saved.
    pub file: String,
    account: Account,
}

impl LeftOut {
    /// Why, each with a file: that of the board which is wrong, or the program.
    pub fn findings(&self) -> impl Iterator<Item = Diagnostic> {
        let file = &self.file;
        let errors = self.account.findings.iter().filter(|found| found.is_error()).cloned();
        errors.map(move |found| match found.file.is_empty() {
            true => found.file(file),
            false => found,
        })
    }
}

/// How the height of the board is probed: slowly, and a millimetre above what it may rise to from place to place.
const PROBED: Probing = Probing { travel: 2.0, reach: 1.0, feed: 50.0 };

/// What the program is called that measures the height of the board.
pub const PROBE: &str = "probe";

/// The file in which LinuxCNC keeps what it finds; to other controls it is a comment.
const HEIGHTS: &str = "heights.txt";

/// What all programs of a board share.
struct Shop<'a> {
    job: &'a Job<'a>,
    /// The board with its front up.
    front: Setup,
    /// The board with its back up.
    back: Setup,
    /// Whether the board is turned over for one of the programs.
    is_turned: bool,
    rack: Rack,
    watch: &'a dyn Watch,
    /// The surface that programs follow, where one was measured.
    surface: Option<HeightMap>,
}

/// What the sheet with both sides is called.
const SHEET: &str = "sheet";

impl Shop<'_> {
    /// Both sides on a sheet to print.
    fn sheet(&self) -> String {
        fn shown(setup: &Setup) -> BoardSide<'_> {
            let Board { outline, front, .. } = &setup.board;
            (outline.as_ref(), front.copper.as_ref(), setup.drilled().collect())
        }
        let sheet = BoardSheet {
            sides: [shown(&self.front), shown(&self.back)],
            turning: self.front.axis,
            stock: self.front.stock(self.job.settings),
        };
        drawing::board_sheet(&self.front.board.name, &sheet)
    }

    /// How the board lies for a program.
    fn setup(&self, part: Part) -> &Setup {
        match plan::face(part, self.job.settings) {
            Face::Front => &self.front,
            Face::Back => &self.back,
        }
    }

    /// What the program of a part of the board is to do.
    fn toolpath(&self, task: &Task) -> Result<Toolpath, Stop> {
        let Task { part, work, .. } = task;
        let part = *part;
        let board = &self.setup(part).board;
        let name = format!("{}-{}", board.name, task.name);
        let number = |operation: &Operation| self.rack.number(&operation.tool.name);
        let operations: Vec<(u32, &Operation)> =
            work.operations.iter().map(|operation| (number(operation), operation)).collect();
        let mut program =
            job::program(&name, &operations, &self.job.heights).map_err(Box::<Diagnostic>::from)?;
        if let Some(surface) = &self.surface {
            program = level(&program, surface, &LEVELLED)?;
        }
        if let Some(places) = self.probes(part, work) {
            let grid = self.touched(part, work, grid(board, places)?)?;
            program = follow(&program, &grid, &PROBED, STEEPNESS, &LEVELLED)?;
        }
        self.name(&mut program, &task.name);
        Ok(Toolpath::of_program(program, "board"))
    }

    /// The program of a part of the board, proven, and its picture.
    fn made(&self, task: &Task) -> Result<Cut, Stop> {
        let Task { part, work, .. } = task;
        let setup = self.setup(*part);
        let toolpath = self.toolpath(task)?;
        let format = self.job.picture;
        let widths: Vec<f64> = work.operations.iter().map(Operation::width).collect();
        let picture = BoardPicture {
            widths: &widths,
            stock: Some(setup.stock(self.job.settings)),
            ..picture(setup, work, &toolpath.program, self.is_turned)
        };
        let name = &toolpath.program.name;
        let (posted, picture) = rayon::join(
            || self.proven(&toolpath, &task.name, task.place),
            || format.map(|format| format.bytes(drawing::board(name, &picture))).transpose(),
        );
        let (machine, posted) = posted?;
        let picture = picture?;
        Ok(Cut { toolpath, machine, posted, picture })
    }

    /// Columns and rows of the heights that the program of a part measures itself, where it cuts anything.
    fn probes(&self, part: Part, work: &Work) -> Option<[u32; 2]> {
        let running = &self.job.settings.running;
        let cuts = work.operations.iter().any(|operation| !operation.cuts.is_empty());
        running.probe.filter(|_| running.on_control && part.is_copper() && cuts)
    }

    /// The grid with no place at which the tool touches the rim of a hole, or nothing, where the holes are there already. What
    /// counts is the width that the tool has at the surface when its tip is as deep as it probes.
    ///
    /// # Errors
    /// Columns and rows cannot be moved out of the holes.
    fn touched(&self, part: Part, work: &Work, grid: Grid) -> Result<Grid, Stop> {
        if !plan::is_drilled(part, self.job.settings) {
            return Ok(grid);
        }
        let width = |operation: &Operation| operation.tool.cutter.width(PROBED.reach);
        let radius = work.operations.first().map_or(0.0, width) / 2.0;
        let found = match clear_of(&grid, &[self.setup(part)], radius) {
            Ok(grid) => return Ok(grid),
            Err(found) => found,
        };
        let help = "another number of columns or rows, or --from back: then holes are drilled after the back is cut";
        Err(found.help(help).file(self.job.file(part.name())).into())
    }

    /// What the program does that measures the height of the board.
    fn probe_path(&self, places: [u32; 2]) -> Result<Toolpath, Stop> {
        // It is run for either side, and for one of them the holes are there.
        let sides = [&self.front, &self.back];
        let sides = if self.is_turned { &sides[..] } else { &sides[..1] };
        let grid = clear_of(&grid(&self.front.board, places)?, sides, PROBE_RIM)
            .map_err(|found| found.help("another number of columns or rows"))?;
        let name = format!("{}-{PROBE}", self.front.board.name);
        let mut program = PROBED.program(&name, &grid, Some(HEIGHTS))?;
        let tool = program::Tool {
            number: self.rack.next(),
            name: String::from(PROBE),
            ..program::Tool::default()
        };
        program.records.insert(0, Record { line: 0, op: Op::Tool(Box::new(tool)) });
        self.name(&mut program, PROBE);
        Ok(Toolpath::of_program(program, "board"))
    }

    /// The program that measures the height of the board.
    fn probing(&self, places: [u32; 2]) -> Result<Program, Stop> {
        let toolpath = self.probe_path(places)?;
        let (machine, posted) = self.proven(&toolpath, PROBE, Part::ALL.len())?;
        let (work, picture, probes) = (Work::default(), None, None);
        let (name, file) = (String::from(PROBE), self.job.file(PROBE));
        let (part, up) = (None, None);
        Ok(Program { name, file, part, up, work, toolpath, machine, posted, picture, probes })
    }

    /// Controllers of robots know a program by the name of its file.
    fn name(&self, program: &mut ::program::Program, name: &str) {
        if let Some(stem) = robot_name(self.job.machine, name) {
            program.name = stem;
        }
    }

    /// The text of a program, proven, that is so many places behind the first of all programs that a board can have, and the
    /// machine that it is for.
    fn proven(
        &self,
        toolpath: &Toolpath,
        name: &str,
        place: usize,
    ) -> Result<(Machine, Posted), Stop> {
        let file = self.job.file(name);
        let Job { machine, tolerances, .. } = self.job;
        let machine = self.job.shaped(numbered(machine, place));
        let posted = post::proven(toolpath, &machine, &file, tolerances, &Quiet(self.watch))?;
        Ok((machine.into_owned(), posted))
    }
}

/// What a part of the board is cut by.
struct Cut {
    toolpath: Toolpath,
    machine: Machine,
    posted: Posted,
    picture: Option<Vec<u8>>,
}

/// A board that lies so, and what a program does to it.
fn picture<'a>(
    setup: &'a Setup,
    work: &'a Work,
    program: &'a ::program::Program,
    is_turned: bool,
) -> BoardPicture<'a> {
    let Setup { board, axis, .. } = setup;
    BoardPicture {
        outline: board.outline.as_ref(),
        copper: board.front.copper.as_ref(),
        holes: &board.holes,
        program,
        widths: &[],
        problems: &work.problems,
        rest: &work.rest,
        turning: is_turned.then_some(*axis),
        tabs: &work.tabs,
        stock: None,
    }
}

/// The file of the program that is called so, as its control wants it: on a robot by the name that the program has in it.
pub fn file_of(machine: &Machine, name: &str) -> String {
    let stem = robot_name(machine, name).unwrap_or_else(|| name.to_owned());
    format!("{stem}.{}", machine.extension)
}

/// The files of programs that a board may have on this machine, and that are none of these.
pub fn other_files(machine: &Machine, programs: &[Program]) -> Vec<String> {
    let is_made = |name: &str| programs.iter().any(|made| made.name == name);
    let names = Part::ALL.into_iter().map(Part::name).chain([PROBE]);
    names.filter(|name| !is_made(name)).map(|name| file_of(machine, name)).collect()
}

/// That such files of an earlier call stay in the folder, where there are any.
pub fn older(others: &[String], folder: &Path) -> Option<Diagnostic> {
    let there: Vec<&str> =
        others.iter().filter(|file| folder.join(file).exists()).map(String::as_str).collect();
    (!there.is_empty()).then(|| {
        let message = format!("of an earlier call there are still {}", there.join(", "));
        let help = "they are not of these programs: remove them, or save in a new folder";
        Diagnostic::warning(Rule::FileOlder, message).help(help)
    })
}

fn robot_name(machine: &Machine, name: &str) -> Option<String> {
    machine.cell.as_ref().map(|_| name.replace('-', "_"))
}

/// The machine with the number of the program that is so many places behind the first, whose number `program_number` says
/// (1 where it says none): programs of one number replace each other in the memory of a control. What says no number is left
/// to the writer, which refuses it.
fn numbered(machine: &Machine, place: usize) -> Cow<'_, Machine> {
    let first = match machine.option(OptionKey::ProgramNumber) {
        Some(OptionValue::Number(number)) => ::post::number_of(&number.to_string()),
        Some(OptionValue::Text(text)) if text.trim().is_empty() => Some(1),
        Some(OptionValue::Text(text)) => ::post::number_of(text.trim()),
        Some(OptionValue::Flag(_)) | None => None,
    };
    let Some(first) = first else { return Cow::Borrowed(machine) };
    let mut machine = machine.clone();
    let number = OptionValue::Text((first as usize + place).to_string());
    machine.options.insert(OptionKey::ProgramNumber.name().into(), number);
    Cow::Owned(machine)
}

/// How far the places of `probe.nc` stay from the rims of holes, mm: half the width of a probe.
const PROBE_RIM: f64 = 0.5;

/// The grid with no place in a hole of a board that lies so, or nearer to one than `radius` mm; what is in the way where its
/// columns and rows cannot be moved out of them.
fn clear_of(grid: &Grid, sides: &[&Setup], radius: f64) -> Result<Grid, Box<Diagnostic>> {
    let holes = sides.iter().flat_map(|side| side.drilled());
    let mut holes: Vec<_> = holes.map(|hole| (hole.extents(), hole)).collect();
    holes.sort_by(|((a, _), _), ((b, _), _)| a.x.total_cmp(&b.x));
    let widest = holes.iter().map(|((low, high), _)| high.x - low.x).fold(0.0, f64::max);
    let hole_at = |place: Vec2| {
        let from = place.x - radius - widest;
        let first = holes.partition_point(|((low, _), _)| low.x < from);
        let near = holes.iter().skip(first);
        let mut near = near.take_while(|((low, _), _)| low.x <= place.x + radius);
        near.find(|(_, hole)| hole.distance(place) < radius).map(|(_, hole)| *hole)
    };
    let touched: Vec<Vec2> = grid.places().filter(|place| hole_at(*place).is_some()).collect();
    let Some((first, hole)) = touched.first().and_then(|first| Some((*first, hole_at(*first)?)))
    else {
        return Ok(grid.clone());
    };
    if let Some(grid) = grid.clear_of(|place| hole_at(place).is_none()) {
        return Ok(grid);
    }
    let (low, high) = hole.extents();
    let at = low.midpoint(high);
    let message = format!(
        "the height is measured at X{:.3} Y{:.3}, in the hole of {} mm at X{:.3} Y{:.3} or less than {radius:.3} mm \
         from it, and the hole is drilled before; moving columns and rows does not help",
        first.x, first.y, hole.diameter, at.x, at.y
    );
    Err(Diagnostic::error(Rule::ProbeInHole, message).into())
}

/// So many columns and rows of places over a board, [`INSIDE`] its edge; on a small one a quarter of it.
fn grid(board: &Board, [columns, rows]: [u32; 2]) -> Result<Grid, Stop> {
    let (low, high) = board.extents().unwrap_or_default();
    let inside = Vec2::splat(INSIDE).min((high - low) / 4.0);
    Ok(Grid::new(low + inside, high - inside, columns as usize, rows as usize)?)
}
