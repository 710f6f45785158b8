//! A job: one source with one machine, its program, its verdict and its walk. What is asked of it is answered here.

use crate::ask::{
    self, Blocks, Command, Finding, Found, JobMachine, Level, Line, MachineKind, Mismatch, Moves,
    Of, Place, Saved, Template, TextAbout, WalkAbout,
};
use crate::board;
use crate::drawing::Piece;
use crate::edit::{Existing, Files, Text};
use crate::folder::Folder;
use crate::geometry::{self, Geometry};
use crate::glass::{self, Glass};
use crate::inputs::Inputs;
use crate::lines::{Lines, readable};
use crate::machines::{self, Any};
use crate::message::{Array, Values};
use crate::origin::Texts;
use crate::place::{self, At};
use crate::plots::{Plots, What};
use crate::sketch;
use crate::walk::{By, Drawn, Follower, KINDS, NO_TOOL, Slot, Walk};
use ::post::{Origins, Part};
use app::report::{self, Digests};
use app::toolpath::{self, Toolpath};
use app::{Account, Source, Stop, Verdict, Watch, files, post, prove, wire};
use control::Folders;
use geom::ending::{Ended, go_on};
use machine::linkage::Linkage;
use machine::{Machine, Reach, library};
use program::{Diagnostic, Findings, Program, Purpose, Rule, encoding};
use proof::{Observer, Report, Tolerances};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The most bytes of a text that are answered at once.
const MOST_TEXT: usize = 4 << 20;

/// The most ranges of moves that are answered.
const MOST_RANGES: usize = 1000;

/// The most blocks of a record that are answered.
const MOST_BLOCKS: usize = 10_000;

/// What the command's options say of a job.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Every warning about the toolpath is an error.
    pub strict: bool,
    /// What the source does not say itself.
    pub origin: app::Origin,
    /// How close the program has to be.
    pub tolerances: Tolerances,
    /// Options of the machine file.
    pub machine: Vec<(String, String)>,
    /// Name of the program's file, with its ending or without; `None`: that of the source.
    pub file: Option<String>,
    /// How a wire cuts, where the machine is one.
    pub wire: Option<wire::Settings>,
    /// How a board is made.
    pub board: Option<Box<board::Settings>>,
    /// How bodies are engraved inside glass.
    pub glass: Option<Box<app::glass::Settings>>,
}

impl Options {
    /// The same, with every file that they name read in the folder, or lying in it.
    ///
    /// # Errors
    /// One leads out of the folder, or cannot be read.
    fn within(mut self, folder: &Folder, inputs: &Inputs) -> Result<Options, Stop> {
        let origin = &mut self.origin;
        origin.reach = Reach::Folder(folder.path().to_owned());
        let in_memory = |source: &mut Source| {
            if let Source::File(path) = source {
                let name = path.to_string_lossy();
                folder.target(&name)?;
                *source = Source::memory(&*path, inputs.read(folder, &name, Of::Source)?);
            }
            Ok::<(), Stop>(())
        };
        let upper = self.wire.as_mut().and_then(|wire| wire.upper.as_mut());
        let named = self.board.iter_mut().flat_map(|board| board.files());
        let materials = self.glass.as_mut().and_then(|glass| glass.materials.as_mut());
        for source in origin.tools.iter_mut().chain(upper).chain(named).chain(materials) {
            in_memory(source)?;
        }
        if let Some(from) = origin.from.as_deref().filter(|from| machine::is_path(from)) {
            let path = folder.target(from)?.to_string_lossy().into_owned();
            inputs.look_at_machine(folder, from);
            origin.from = Some(path);
        }
        let own = |path: &PathBuf| folder.inner_folder(path);
        origin.folders = origin.folders.iter().map(own).collect::<Result<_, _>>()?;
        Ok(self)
    }
}

/// Who waits for a job.
pub trait Waits: Sync {
    /// The next step begins.
    fn step(&self, what: &'static str);

    /// So much of it is done, 0 to 1.
    fn reached(&self, part: f64);

    /// The proof of the program `file` has walked and drawn a chunk.
    fn walked(&self, file: &str, piece: Piece);
}

/// Nobody.
impl Waits for () {
    fn step(&self, _what: &'static str) {}

    fn reached(&self, _part: f64) {}

    fn walked(&self, _file: &str, _piece: Piece) {}
}

/// Follows the work on a job, or on all those of a board at the same time.
pub(crate) struct Follows<'a> {
    waits: &'a dyn Waits,
    ended: &'a Ended,
    /// Where it reads, and what it has read.
    pub(crate) folder: &'a Folder,
    pub(crate) inputs: &'a Arc<Inputs>,
    /// The walks, by the files of their programs.
    walks: Mutex<Vec<(String, Slot)>>,
}

impl Follows<'_> {
    /// Walks the source itself, of which there is no program `file`.
    fn sketch(&self, file: &str, source: &Program, machine: &Machine) {
        let slot = Slot::default();
        let waits = (self.waits, self.ended);
        let follower = Follower::new(file, source, machine, waits, Slot::clone(&slot));
        let mut follower = follower.of_source();
        sketch::follow(source, machine, &mut follower);
        follower.ended(&Report::default());
        let mut walks = self.walks.lock().unwrap_or_else(PoisonError::into_inner);
        walks.push((file.to_owned(), slot));
    }

    /// The walk of the program that is called `file`, and its drawing.
    fn drawn(&self, file: &str) -> Drawn {
        let walks = self.walks.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = walks.iter().find(|(of, _)| of == file).map(|(_, slot)| slot);
        let drawn = |slot: &Slot| slot.lock().unwrap_or_else(PoisonError::into_inner).take();
        slot.and_then(drawn).unwrap_or_default()
    }
}

impl Watch for Follows<'_> {
    fn step(&self, what: &'static str) {
        self.waits.step(what);
    }

    fn reached(&self, part: f64) {
        self.waits.reached(part);
    }

    fn has_read(&self, path: &Path) {
        self.inputs.add_read(self.folder, path, Of::Source);
    }

    fn is_cancelled(&self) -> bool {
        // On a thread of the work nothing is made of what is there so far.
        go_on();
        self.ended.is_ended()
    }

    fn follow<'a>(
        &'a self,
        file: &str,
        source: &'a Program,
        machine: &'a Machine,
    ) -> Box<dyn Observer + 'a> {
        let slot = Slot::default();
        let mut walks = self.walks.lock().unwrap_or_else(PoisonError::into_inner);
        walks.push((file.to_owned(), Slot::clone(&slot)));
        Box::new(Follower::new(file, source, machine, (self.waits, self.ended), slot))
    }
}

/// What a job is made of.
pub struct Asked<'a> {
    /// The toolpath, or the board.
    pub source: Sources,
    /// Name of the machine, as it was asked for.
    pub machine: &'a str,
    /// What the options say, as options of that command.
    pub options: &'a dyn Fn(Command) -> Result<Options, Stop>,
    /// Name of the program's file.
    pub file: Option<String>,
    /// The program, where it is there already.
    pub program: Option<Existing>,
    /// The files that it is made of; those that are read for it are added.
    pub inputs: &'a Arc<Inputs>,
}

/// What programs are made of, read.
#[derive(Debug)]
pub enum Sources {
    /// A file.
    One(Source),
    /// The files of a board.
    Several(Vec<Source>),
    /// All files of a folder of this name, which is a board.
    Folder(String, Vec<Source>),
}

impl Sources {
    /// How many bytes there are of them in memory.
    pub fn bytes(&self) -> usize {
        let files = match self {
            Sources::One(file) => std::slice::from_ref(file),
            Sources::Several(files) | Sources::Folder(_, files) => files,
        };
        let bytes = |file: &Source| match file {
            Source::Memory { bytes, .. } => bytes.len(),
            Source::File(_) => 0,
        };
        files.iter().map(bytes).sum()
    }

    /// What writes the programs.
    pub fn command(&self, machine: Option<&Any>) -> Command {
        match (self, machine) {
            (_, Some(Any::Fires(_))) => Command::Glass,
            (Sources::One(file), _) if app::pcb::is_board(file) => Command::Pcb,
            (Sources::One(file), _) if app::glass::is_body(file) => Command::Glass,
            (Sources::One(_), Some(Any::Moves(machine))) if machine.wire.is_some() => Command::Wire,
            (Sources::One(_), _) => Command::Post,
            (Sources::Several(files), _) if files.iter().all(app::glass::is_body) => Command::Glass,
            (Sources::Several(_) | Sources::Folder(..), _) => Command::Pcb,
        }
    }

    /// Of which kinds a machine can take them, by their names and what they begin with.
    pub fn kinds(&self) -> Vec<MachineKind> {
        use MachineKind::{Glass, Mill, Robot, Wire};
        let files = match self {
            Sources::One(file) => std::slice::from_ref(file),
            Sources::Several(files) | Sources::Folder(_, files) => files,
        };
        let own: &[MachineKind] = match self {
            _ if files.iter().all(app::glass::is_body) => &[],
            Sources::One(file) if app::pcb::is_board(file) => &[Mill, Robot],
            Sources::One(file) if app::wire::is_drawing(file) => &[Wire],
            Sources::One(_) => &[Mill, Robot, Wire],
            Sources::Several(_) | Sources::Folder(..) => &[Mill, Robot],
        };
        let is_engraved = files.iter().all(|file| app::glass::check(file).is_ok());
        own.iter().copied().chain(is_engraved.then_some(Glass)).collect()
    }
}

/// A program with its verdict and its moves.
#[derive(Debug)]
pub struct Job {
    account: Account,
    /// What is saved next to the program; `None` where one report is of all programs of a board.
    report: Option<Reported>,
    machine_name: String,
    machine: Any<Glass>,
    machine_files: BTreeMap<String, Lines>,
    source: Arc<Texts>,
    /// The lines of the toolpath's records, as [`Texts`] count them; 0 for none.
    record_lines: Vec<u32>,
    file: String,
    files: Files,
    /// The program as it was posted, where this one is an edit of it.
    posted: Option<Files>,
    /// Files of that which it does not call any more: they are shown, and not saved.
    uncalled: BTreeSet<String>,
    /// The files that it is made of.
    inputs: Arc<Inputs>,
    walk: Walk,
    geometry: Geometry,
    plots: Plots,
    /// The board that it is one of the programs of.
    board: Option<board::Place>,
    /// Whether its name says which program of a board it is.
    keeps_name: bool,
    /// Whether there is a program: otherwise what is walked is the source.
    has_program: bool,
}

impl Job {
    /// Does the work: a job, or one for each program of a board.
    ///
    /// # Errors
    /// Why there is no program; or that the work was ended.
    pub fn make(
        asked: Asked,
        folder: &Folder,
        waits: &dyn Waits,
        ended: &Ended,
    ) -> Result<Vec<Job>, Stop> {
        let inputs = asked.inputs;
        let follows = Follows { waits, ended, folder, inputs, walks: Mutex::default() };
        follows.step("reading");
        inputs.look_at_machine(folder, asked.machine);
        let machine = machines::open(asked.machine, folder)?;
        let command = asked.source.command(Some(&machine));
        // What can never be is said before its options are asked for.
        match (&machine, command) {
            (Any::Fires(_), _) => glass::check(&asked.source)?,
            (Any::Moves(machine), Command::Glass) => {
                let message = format!("{} does not fire inside glass", machine.title);
                let found = Diagnostic::error(Rule::StudioAsk, message);
                return Err(found.help("choose a machine whose name begins with `glass-`").into());
            }
            (Any::Moves(_), _) => {}
        }
        let options = (asked.options)(command)?.within(folder, inputs)?;
        let mut machine = match machine {
            Any::Fires(machine) => {
                let text = asked.program.map(|program| program.text);
                let (machine, program) = ((asked.machine, machine), (asked.file, text));
                return Ok(vec![glass::make(asked.source, &options, machine, program, &follows)?]);
            }
            Any::Moves(machine) => *machine,
        };
        for (name, value) in &options.machine {
            machine.set_option(name, value)?;
        }
        let source = match asked.source {
            Sources::One(source) if command != Command::Pcb => source,
            board => {
                let machine = (asked.machine, &machine);
                let Some(given) = asked.program else {
                    return board::make(board, &options, machine, &follows);
                };
                let file = asked.file.ok_or_else(|| {
                    let message = "the name of the file says which program of the board it is";
                    Diagnostic::error(Rule::StudioAsk, message)
                })?;
                let of = given.of.clone();
                let program = (file, given);
                let job = board::prove(board, &options, machine, program, &follows)?;
                return Ok(vec![job.edit_of(of.as_deref())]);
            }
        };
        let file = asked.file.unwrap_or_else(|| {
            let named = options.file.as_deref().map(Path::new);
            match named {
                Some(name) if name.extension().is_some() => files::name(name),
                _ => {
                    files::name(&named.unwrap_or(source.path()).with_extension(&machine.extension))
                }
            }
        });
        let of = asked.program.as_ref().and_then(|given| given.of.clone());
        let made = match (&options.wire, asked.program) {
            (Some(settings), None) => cut(&source, &options, &machine, settings, &file, &follows)?,
            (Some(settings), Some(given)) => {
                recut(&source, &options, &machine, settings, (&file, given.text), &follows)?
            }
            (None, None) => posted(&source, &options, &machine, &file, &follows)?,
            (None, Some(given)) => compared(&source, &options, &machine, (&file, given), &follows)?,
        };
        follows.step("drawing");
        let machine = (asked.machine, Any::Moves(machine.into()));
        let text = source_lines(&made.toolpath, &source);
        let text = Texts::of(made.toolpath.file.clone(), text).into();
        let job = Job::of(made, text, (file, machine), &follows)?;
        Ok(vec![job.edit_of(of.as_deref())])
    }

    /// The job of a program that is called `file`, on a machine that was asked for by a name.
    ///
    /// # Errors
    /// The work was ended.
    pub(crate) fn of(
        made: Made,
        source: Arc<Texts>,
        named: (String, (&str, Any<Glass>)),
        follows: &Follows,
    ) -> Result<Job, Stop> {
        let drawn = follows.drawn(&named.0);
        if follows.ended.is_ended() {
            return Err(Stop::cancelled());
        }
        Ok(Job::drawn(made, drawn, source, named, follows))
    }

    /// The same with a walk that is at hand.
    pub(crate) fn drawn(
        made: Made,
        Drawn { mut walk, geometry }: Drawn,
        source: Arc<Texts>,
        (file, (machine_name, machine)): (String, (&str, Any<Glass>)),
        Follows { folder, inputs, .. }: &Follows,
    ) -> Job {
        walk.set_widths(&made.widths);
        let has_program = made.has_program();
        let Made { toolpath, account, text, origins, parts, report, board, lines, .. } = made;
        let record_lines = lines
            .unwrap_or_else(|| toolpath.program.records.iter().map(|record| record.line).collect());
        walk.set_source_lines(&record_lines);
        toolpath.files().into_iter().for_each(|path| inputs.add_read(folder, path, Of::Source));
        let machine_files = match &machine {
            Any::Moves(machine) => {
                let files = machine.loaded_from.files.iter();
                files.for_each(|path| inputs.add_read(folder, path, Of::Machine));
                texts_of(machine, folder)
            }
            Any::Fires(_) => BTreeMap::new(),
        };
        let part = |Part { file, text, origins }| (file, Text::of(text, origins));
        let parts = parts.into_iter().map(part).collect();
        Job {
            account,
            report,
            machine_name: machine_name.to_owned(),
            machine_files,
            source,
            record_lines,
            machine,
            file,
            files: Files { program: Text::of(text, origins), parts },
            posted: None,
            uncalled: BTreeSet::new(),
            inputs: Arc::clone(inputs),
            walk,
            geometry,
            plots: Plots::default(),
            board,
            keeps_name: false,
            has_program,
        }
    }

    /// The same, of which the name of its file says which program of a board it is.
    pub(crate) fn keeping_its_name(self) -> Job {
        Job { keeps_name: true, ..self }
    }

    /// The same as an edit of the program of another job, where it is one: files that it does not call any more are shown too, and lines that are as
    /// they were posted come from where they came from.
    fn edit_of(mut self, of: Option<&Job>) -> Job {
        let Some(of) = of else { return self };
        let posted = of.posted.as_ref().unwrap_or(&of.files);
        // The source, or the machine, may have been changed since.
        let origins =
            (&self.record_lines, &self.machine_name) == (&of.record_lines, &of.machine_name);
        self.files = self.files.edited(&of.files, posted, origins);
        for (file, text) in &of.files.parts {
            if !self.files.parts.contains_key(file) {
                self.files.parts.insert(file.clone(), Arc::clone(text));
                self.uncalled.insert(file.clone());
            }
        }
        self.posted = Some(posted.clone());
        self
    }

    /// The files of the program.
    pub(crate) fn files(&self) -> &Files {
        &self.files
    }

    /// The name of the program's file.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// How much memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        let records = size_of_val(&self.record_lines[..]);
        let posted = self.posted.as_ref().map_or(0, Files::bytes);
        // All programs of a board have one.
        let source = self.source.bytes() / Arc::strong_count(&self.source);
        let texts = source + self.files.bytes() + posted;
        let board = self.board.as_ref().map_or(0, board::Place::bytes);
        let listing = match &self.machine {
            Any::Fires(glass) => glass.bytes(),
            Any::Moves(_) => 0,
        };
        texts + records + self.walk.bytes() + self.geometry.bytes() + board + listing
    }

    /// The files that it is made of.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// The board that it is one of the programs of.
    pub fn board(&self) -> Option<&board::Place> {
        self.board.as_ref()
    }

    /// The walk.
    pub fn walk(&self) -> &Walk {
        &self.walk
    }

    /// What is drawn.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// What is said of it.
    pub fn about(&self, revision: u64, folder: &Folder) -> ask::Job {
        let mut findings = self.account.findings.clone();
        if self.walk.left_out() > 0 {
            let message = format!(
                "the view has the first {} moves; {} more are proven and not shown",
                self.walk.len(),
                self.walk.left_out()
            );
            findings.push(Diagnostic::warning(Rule::StudioLimit, message));
        }
        findings.extend(self.board.iter().flat_map(|board| board.findings()).cloned());
        let findings = findings.into_iter().collect::<Findings>().finish();
        let text = |file: &str, lines: &Lines| ask::Text {
            file: file.to_owned(),
            lines: lines.count(),
            bytes: lines.text().len() as u64,
        };
        let mut sources: Vec<ask::Text> =
            self.source.all().map(|(file, lines)| text(file, lines)).collect();
        ask::Job {
            revision,
            verdict: self.account.verdict.into(),
            rows: rows(&self.account),
            findings: findings.into_iter().map(|found| self.finding(found, folder)).collect(),
            program: self.has_program.then(|| text(&self.file, self.shown_program())),
            parts: self.files.parts.iter().map(|(file, part)| text(file, &part.lines)).collect(),
            source: sources.remove(0),
            sources,
            machine: JobMachine {
                name: self.machine_name.clone(),
                title: self.machine.title().to_owned(),
                kind: self.machine.kind(),
                dialect: self.machine.dialect().to_owned(),
                axes: self.machine.axes(),
                files: self.machine_files.iter().map(|(file, lines)| text(file, lines)).collect(),
                linkage: match &self.machine {
                    Any::Moves(machine) => Linkage::of(machine),
                    Any::Fires(glass) => glass.linkage(),
                },
            },
            walk: self.walk_about(),
            mismatch: self.mismatch(),
            board: self.board.as_ref().map(|board| board.about(revision)),
            blocks: match &self.machine {
                Any::Moves(_) => Vec::new(),
                Any::Fires(glass) => glass.blocks(),
            },
        }
    }

    fn walk_about(&self) -> WalkAbout {
        let (walk, geometry) = (&self.walk, &self.geometry);
        let level = |(error, vertices)| Level { error, vertices: vertices as u64 };
        WalkAbout {
            moves: walk.len(),
            left_out: u32::try_from(walk.left_out()).unwrap_or(u32::MAX),
            chunks: geometry.chunks() as u32,
            levels: geometry.levels().map(level).collect(),
            r#box: geometry.bounds().map(|bounds| bounds.map(|corner| corner.to_array())),
            time_s: walk.seconds(),
            tools: walk.tool_uses().to_vec(),
            operations: walk.operations().to_vec(),
            kinds: KINDS.to_vec(),
            row: geometry::row_bytes(walk) as u32,
            deviation: walk.largest_deviation(),
            jumps: walk.jumps().0.to_vec(),
            jumps_in_all: walk.jumps().1,
            excursions: walk.excursions().0.to_vec(),
            excursions_in_all: walk.excursions().1,
            mismatch: walk.mismatch(),
        }
    }

    /// The first mismatch, as the report has it.
    fn mismatch(&self) -> Option<Mismatch> {
        let first = self.account.data.get("proof")?.get("first_mismatch")?.as_object()?;
        let line = |key| first.get(key)?.as_u64().and_then(|line| u32::try_from(line).ok());
        Some(Mismatch {
            file: first.get("program_file").and_then(|file| Some(file.as_str()?.to_owned())),
            program: line("program_line")?,
            block: readable(first.get("block")?.as_str()?.as_bytes()).0,
            source: line("source_line")?,
        })
    }

    fn finding(&self, found: Diagnostic, folder: &Folder) -> Finding {
        let of = match &*found.file {
            "" => None,
            file if file == self.file || self.files.parts.contains_key(file) => Some(Of::Program),
            file if self.source.text(Some(file)).is_some() => Some(Of::Source),
            file if self.machine_files.contains_key(file) => Some(Of::Machine),
            _ => None,
        };
        Finding { of, ..folder.finding(found) }
    }

    /// The program as it is shown: a binary one as its control reads it.
    fn shown_program(&self) -> &Lines {
        match &self.machine {
            Any::Fires(glass) => glass.listing.as_ref().unwrap_or(&self.files.program.lines),
            Any::Moves(_) => &self.files.program.lines,
        }
    }

    fn lines(&self, of: Of, file: Option<&str>) -> Result<&Lines, Stop> {
        let found = match (of, file) {
            (Of::Program, None) => Some(self.shown_program()),
            (Of::Program, Some(file)) if file == self.file => Some(self.shown_program()),
            (Of::Program, Some(file)) => self.files.parts.get(file).map(|part| &part.lines),
            (Of::Source, file) => self.source.text(file),
            (Of::Machine, None) => match &self.machine {
                Any::Moves(machine) => self.machine_files.get(&machine.file),
                Any::Fires(_) => None,
            },
            (Of::Machine, Some(file)) => self.machine_files.get(file),
        };
        found.ok_or_else(|| {
            let message = "this program has no text of this name";
            Diagnostic::error(Rule::StudioAsk, message).into()
        })
    }

    /// Lines of a text.
    ///
    /// # Errors
    /// There is no such text.
    pub fn text(
        &self,
        of: Of,
        file: Option<&str>,
        from: u32,
        to: u32,
    ) -> Result<(TextAbout, Array), Stop> {
        let lines = self.lines(of, file)?;
        let (text, cut, behind) = lines.shown(from, to, MOST_TEXT);
        let bytes = lines.text().len() as u64;
        let about = TextAbout { lines: lines.count(), bytes, from: from.max(1), to: behind, cut };
        Ok((about, Array::text("text", text)))
    }

    /// The next line that has a text in it.
    ///
    /// # Errors
    /// There is no such text.
    pub fn search(&self, of: Of, file: Option<&str>, text: &str, from: u32) -> Result<Found, Stop> {
        let (line, column) = self.lines(of, file)?.find(text.as_bytes(), from).unzip();
        Ok(Found { line, column })
    }

    /// The place that was asked for; `None` where there are no moves.
    pub fn place(&self, by: ask::By, value: f64, file: Option<&str>) -> Option<Place> {
        let whole =
            if value.is_finite() { value.clamp(0.0, f64::from(u32::MAX)) as u32 } else { 0 };
        let walk = &self.walk;
        let at = match by {
            ask::By::Time => place::at_time(walk, value),
            ask::By::Move => place::at_move(walk, whole),
            // Lines count from 1.
            ask::By::Block | ask::By::Source if whole == 0 => None,
            ask::By::Block => place::at_line(walk, By::Block(file), whole),
            ask::By::Source => {
                let at = place::at_line(walk, By::Source, self.source.number(file, whole)?)?;
                // What another file makes is no answer.
                let (of, _) = self.source.place(walk.source_line(at.r#move));
                let is_of_it =
                    file.unwrap_or(self.source.name()) == of.unwrap_or(self.source.name());
                is_of_it.then_some(at)
            }
        }?;
        Some(self.place_at(at))
    }

    fn place_at(&self, at: At) -> Place {
        let (walk, number) = (&self.walk, at.r#move);
        let stand = match &self.machine {
            Any::Moves(machine) => place::stand(walk, machine, at),
            Any::Fires(glass) => glass.stand(walk, at),
        };
        let known = |value: f64| value.is_finite().then_some(value);
        let state = walk.state(number);
        let (file, line) = (walk.file(number), walk.line(number));
        let (lines, origins) = match file.and_then(|file| self.files.parts.get(file)) {
            Some(part) => (Some(&part.lines), &part.origins),
            None => (file.is_none().then(|| self.shown_program()), &self.files.program.origins),
        };
        let shown = |lines: &Lines, line: u32| readable(lines.line(line)).0;
        let template = origins.of(line).map(|origin| {
            let block = match &self.machine {
                Any::Moves(machine) => origin.template(machine),
                Any::Fires(_) => None,
            };
            Template {
                name: origin.block.to_owned(),
                file: block.map(|block| block.file.clone()),
                line: block.map_or(0, |block| block.line),
                text: block.map(|block| block.text.clone()).unwrap_or_default(),
            }
        });
        let source_line = walk.source_line(number);
        let source = (source_line > 0).then(|| {
            let (file, line) = self.source.place(source_line);
            let text = self.source.text(file).map(|text| shown(text, line));
            Line { file: file.map(str::to_owned), line, text: text.unwrap_or_default() }
        });
        let block_moves = match line {
            // Of no block.
            0 => vec![[number, number + 1]],
            line => walk.moves_of(By::Block(file), line, MOST_RANGES),
        };
        let source_moves = match source_line {
            0 => vec![[number, number + 1]],
            line => walk.moves_of(By::Source, line, MOST_RANGES),
        };
        Place {
            block_moves,
            blocks: self.blocks_of(&source_moves, source_line),
            source_moves,
            time_s: at.seconds,
            r#move: number,
            part: at.part,
            kind: place::kind(walk, at),
            marks: walk.marks(number),
            block: Line {
                file: file.map(str::to_owned),
                line,
                text: lines.map(|lines| shown(lines, line)).unwrap_or_default(),
            },
            source,
            template,
            tool: Some(walk.tool(number)).filter(|tool| *tool != NO_TOOL).map(u32::from),
            tip: stand.tip.to_array().map(known),
            axis: stand.axis.to_array().map(known),
            axes: stand.positions.into_iter().map(known).collect(),
            feed: walk.feed(number).map(place::feed),
            spindle: state.map(place::spindle),
            coolant: state.map(|state| place::coolant(state.coolant)),
            compensation: state.map(|state| place::compensation(state.compensation)),
            cycle: state.and_then(|state| Some(place::cycle(state.cycle.as_ref()?.kind))),
            work_offset: state.and_then(|state| state.work_offset).map(|offset| offset.number()),
        }
    }

    /// The blocks that a record of the source has become: those of its moves, and those beside them that were written for the same line.
    fn blocks_of(&self, moves: &[[u32; 2]], source_line: u32) -> Vec<Blocks> {
        let walk = &self.walk;
        let mut lines: BTreeMap<Option<&str>, BTreeSet<u32>> = BTreeMap::new();
        for at in moves.iter().flat_map(|[first, behind]| *first..*behind).take(MOST_BLOCKS) {
            lines.entry(walk.file(at)).or_default().insert(walk.line(at));
        }
        for (file, lines) in &mut lines {
            let origins = self.files.get(*file).map(|text| &text.origins);
            let record = |line: u32| origins.and_then(|origins| origins.of(line)?.record);
            // A record that is of no line of a file, as those of a board, is asked for by a move, and is of itself alone.
            let own = lines.first().and_then(|line| record(*line));
            let is_of_it = |line: u32| match (record(line), source_line) {
                (None, _) => false,
                (record, 0) => record == own,
                (Some(at), _) => self.record_lines.get(at) == Some(&source_line),
            };
            *lines = grown(lines, is_of_it);
        }
        lines.into_iter().map(|(file, lines)| Blocks::of(file, lines)).collect()
    }

    /// The moves that a line makes.
    pub fn moves(&self, by: ask::By, line: u32, file: Option<&str>) -> Result<Moves, Stop> {
        let (by, line) = match by {
            ask::By::Block => (By::Block(file), line),
            // A line that there is none of makes no move.
            ask::By::Source => (By::Source, self.source.number(file, line).unwrap_or(0)),
            ask::By::Time | ask::By::Move => {
                let message = "moves are asked for by a line: by `block` or by `source`";
                return Err(Diagnostic::error(Rule::StudioAsk, message).into());
            }
        };
        Ok(Moves { ranges: self.walk.moves_of(by, line, MOST_RANGES) })
    }

    /// An axis or the feed over time.
    ///
    /// # Errors
    /// There is no such axis.
    pub fn plot(&self, what: &str, times: [f64; 2], pixels: u32) -> Result<Vec<Array>, Stop> {
        let axis = || self.machine.axes().iter().position(|axis| axis.name == what);
        let what = match what {
            "feed" => What::Feed,
            "deviation" => What::Deviation,
            _ => What::Axis(axis().ok_or_else(|| {
                let message =
                    "there is no plot of this name: an axis of the machine, `feed` or `deviation`";
                Diagnostic::error(Rule::StudioAsk, message)
            })?),
        };
        let [least, most] = self.plots.plot(&self.walk, what, times, pixels);
        let array = |name: &str, values| Array::new(name, Values::F32(values));
        Ok(vec![array("least", least), array("most", most)])
    }

    /// Saves the program with what it calls and its report, all or none.
    ///
    /// # Errors
    /// It is not proven, or not of the files as they are now; it leads out of the folder, or cannot be saved. Nothing is changed then.
    pub fn save(&self, folder: &Folder, path: &str, replace: bool) -> Result<Saved, Stop> {
        let refused = |message: &str, help: &str| {
            Stop::from(Diagnostic::error(Rule::OutputFile, message).help(help).file(path))
        };
        if self.account.verdict != Verdict::Done {
            let message = "the program is not proven: it is not saved";
            return Err(refused(message, "correct what the findings name, and prove it again"));
        }
        self.inputs.check(folder)?;
        if let Some(board) = &self.board {
            return board.save(folder, path, replace, &self.inputs);
        }
        let target = folder.target(path)?;
        if target.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
            let message = "a program is not saved as `.toml`: such files are machines and settings";
            return Err(refused(message, "give a name that ends as programs of this control do"));
        }
        if target.exists() && !replace {
            return Err(refused("it is there already", "give another name, or replace it"));
        }
        let calls_itself = matches!(&self.machine, Any::Moves(machine) if machine.cell.is_some());
        if calls_itself && files::name(&target) != self.file {
            let message =
                format!("the program calls itself by the name of its file, {}", self.file);
            return Err(refused(
                &message,
                "keep the name, and give another folder; or post it with --output, which gives the program another name",
            ));
        }
        if self.keeps_name && files::name(&target) != self.file {
            let message = format!(
                "the name of its file says which program of the board it is: {}",
                self.file
            );
            return Err(refused(&message, "keep the name, and give another folder"));
        }
        let parent = Path::new(path).parent().unwrap_or(Path::new(""));
        let within = |name: &str| parent.join(name).to_string_lossy().into_owned();
        let mut saved = vec![path.to_owned()];
        let parts = self.files.parts.iter().filter(|(file, _)| !self.uncalled.contains(*file));
        let parts: Vec<(&str, &[u8])> =
            parts.map(|(file, part)| (&**file, part.lines.text())).collect();
        for (part, _) in &parts {
            folder.target(&within(part))?;
            saved.push(within(part));
        }
        let report = self.report.as_ref().map(|report| self.report(report, &files::name(&target)));
        if report.is_some() {
            let name = files::name(&files::report_of(&target));
            folder.target(&within(&name))?;
            saved.push(within(&name));
        }
        let inputs = self.inputs.files(folder, None);
        let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
        let text = self.files.program.lines.text();
        let own: Vec<&str> = parts.iter().map(|(file, _)| *file).collect();
        let left = files::parts_left(&target, &own).map(|found| found.file(path).into());
        files::save_program(&target, text, &parts, report.as_deref(), &inputs)?;
        let of_board = target.with_file_name(board::REPORT);
        let stale = (self.keeps_name && of_board.exists()).then(|| {
            Diagnostic::warning(
                Rule::ReportPair,
                format!("is of the board as it was posted, not of this {}", self.file),
            )
            .help("what is said of this program stands in its own report beside it")
            .file(within(board::REPORT))
            .into()
        });
        Ok(Saved { files: saved, findings: stale.into_iter().chain(left).collect() })
    }

    /// The text of a report of the program that is saved in a file of this name.
    fn report(&self, report: &Reported, file: &str) -> String {
        let of = if let Reported::Own(account) = report { account } else { &self.account };
        let mut account = of.clone();
        account.rename_program(&self.file, file);
        match report {
            Reported::Account | Reported::Own(_) => account.report(),
            Reported::Wire(listing) => listing.report(&account),
        }
    }
}

/// Lines with those beside them, up to the next one, that `is_of_it`.
fn grown(lines: &BTreeSet<u32>, is_of_it: impl Fn(u32) -> bool) -> BTreeSet<u32> {
    let is_new = |line: &u32| !lines.contains(line) && is_of_it(*line);
    let beside = lines.iter().flat_map(|line| {
        let above = (1..*line).rev().take_while(is_new);
        above.chain((line + 1..).take_while(is_new)).chain([*line])
    });
    beside.take(MOST_BLOCKS).collect()
}

/// What is reported of something, as the page shows it.
pub(crate) fn rows(account: &Account) -> Vec<(String, String)> {
    account.rows.iter().map(|(head, text)| ((*head).to_owned(), text.clone())).collect()
}

/// What the report of a program has, which is written when the program is saved: it has the name that its file then has.
#[derive(Debug)]
pub(crate) enum Reported {
    /// What its account says.
    Account,
    /// What this account says: that of the page has findings of its own.
    Own(Box<Account>),
    /// What its account says, and what a wire cuts.
    Wire(wire::Listing),
}

/// What was made of a source.
pub(crate) struct Made {
    pub toolpath: Toolpath,
    pub account: Account,
    pub text: Vec<u8>,
    pub origins: Origins,
    pub parts: Vec<Part>,
    pub report: Option<Reported>,
    /// Numbers and names of tools, and how wide they cut, mm, where that is known.
    pub widths: Vec<(u32, String, f64)>,
    pub board: Option<board::Place>,
    /// The lines of the toolpath's records as the texts of its source count them; where there are none, the records have them.
    pub lines: Option<Vec<u32>>,
}

impl Made {
    /// Whether there is a program.
    fn has_program(&self) -> bool {
        !self.account.data.is_null()
    }
}

/// Writes the program for a mill or a robot, and proves it; where the machine cannot do what the source asks for, there is none, and the source is walked.
fn posted(
    source: &Source,
    options: &Options,
    machine: &Machine,
    file: &str,
    follows: &Follows,
) -> Result<Made, Stop> {
    let toolpath = toolpath_of(source, options, machine, follows)?;
    let posted = post::proven(&toolpath, machine, file, &options.tolerances, follows);
    let post::Posted { text, origins, parts, account } = match posted {
        Err(Stop { verdict: Verdict::Failed, findings }) => {
            follows.step("drawing");
            follows.sketch(file, &toolpath.program, machine);
            let (rows, data) = (toolpath.rows(Some(machine)), serde_json::Value::Null);
            let account = Account { verdict: Verdict::Failed, rows, data, findings };
            let (text, origins, parts) = (Vec::new(), Origins::default(), Vec::new());
            post::Posted { text, origins, parts, account }
        }
        posted => posted?,
    };
    let report = Some(Reported::Account);
    Ok(Made {
        toolpath,
        account,
        text,
        origins,
        parts,
        report,
        widths: Vec::new(),
        board: None,
        lines: None,
    })
}

/// Proves a program that is there already.
fn compared(
    source: &Source,
    options: &Options,
    machine: &Machine,
    (file, given): (&str, Existing),
    watch: &dyn Watch,
) -> Result<Made, Stop> {
    if encoding::is_utf_16(&given.text) {
        return Err(encoding::utf_16().file(file).into());
    }
    let toolpath = toolpath_of(source, options, machine, watch)?;
    let folders = called_from(machine, &given);
    let program = (file, encoding::without_mark(&given.text), &folders);
    let mut account = prove::compare(&toolpath, machine, program, &options.tolerances, watch)?;
    let (text, parts) = called(&account, given, &folders);
    complete(&mut account, &text, &parts, &toolpath, machine);
    let (origins, widths, report) = (Origins::default(), Vec::new(), Some(Reported::Account));
    Ok(Made { toolpath, account, text, origins, parts, report, widths, board: None, lines: None })
}

/// Where programs are looked for that a program calls: those of a robot are its own, or lie beside it.
pub(crate) fn called_from(machine: &Machine, given: &Existing) -> Folders {
    if machine.arm.is_none() {
        return Folders::default();
    }
    Folders::from(given.folders.clone()).with_texts(given.called.clone()).keeping()
}

/// A program, and the files that it has called; where it is not proven also those that it was given: nobody knows what it would have called.
pub(crate) fn called(
    account: &Account,
    given: Existing,
    folders: &Folders,
) -> (Vec<u8>, Vec<Part>) {
    let mut called = folders.take_kept();
    if account.verdict != Verdict::Done {
        for (file, text) in given.called {
            called.entry(file).or_insert(text);
        }
    }
    let part = |(file, text)| Part { file, text, origins: Origins::default() };
    (given.text, called.into_iter().map(part).collect())
}

/// Adds to the account of a program that was proven and not written, and of the files that it calls, in the order of their names, what its
/// report has besides.
pub(crate) fn complete(
    account: &mut Account,
    text: &[u8],
    parts: &[Part],
    toolpath: &Toolpath,
    machine: &Machine,
) {
    if account.verdict != Verdict::Done {
        return;
    }
    let texts: Vec<&[u8]> = parts.iter().map(|part| &part.text[..]).collect();
    let digests = Digests::of(text, &texts, toolpath, machine);
    let parts = parts.iter().map(|part| (&*part.file, &part.text[..]));
    report::complete(account, parts, &digests);
}

/// Proves a program of a wire that was edited.
fn recut(
    source: &Source,
    options: &Options,
    machine: &Machine,
    settings: &wire::Settings,
    (file, text): (&str, Vec<u8>),
    watch: &dyn Watch,
) -> Result<Made, Stop> {
    if encoding::is_utf_16(&text) {
        return Err(encoding::utf_16().file(file).into());
    }
    let Options { strict, origin, tolerances, .. } = options;
    let read = (file, encoding::without_mark(&text));
    let (strict, owned) = (*strict, machine.clone());
    let (toolpath, mut account) =
        wire::prove(source, strict, origin, owned, settings, read, tolerances, watch)?;
    complete(&mut account, &text, &[], &toolpath, machine);
    let (origins, parts, widths) = (Origins::default(), Vec::new(), Vec::new());
    let report = Some(Reported::Account);
    Ok(Made { toolpath, account, text, origins, parts, report, widths, board: None, lines: None })
}

/// Writes the program of a wire, and proves it.
fn cut(
    source: &Source,
    options: &Options,
    machine: &Machine,
    settings: &wire::Settings,
    file: &str,
    watch: &dyn Watch,
) -> Result<Made, Stop> {
    let Options { strict, origin, tolerances, .. } = options;
    let machine = machine.clone();
    let made = wire::make(source, *strict, origin, machine, settings, file, tolerances, watch)?;
    let wire::Made { posted, toolpath, listing } = made;
    let post::Posted { text, origins, parts, account } = posted;
    let (report, widths) = (Some(Reported::Wire(listing)), Vec::new());
    Ok(Made { toolpath, account, text, origins, parts, report, widths, board: None, lines: None })
}

fn toolpath_of(
    source: &Source,
    options: &Options,
    machine: &Machine,
    watch: &dyn Watch,
) -> Result<Toolpath, Stop> {
    let Options { strict, origin, .. } = options;
    toolpath::read_for(source, *strict, origin, Some(machine), Purpose::Program, watch)
}

/// The lines of a source as its findings count them: those of the file, or the commands of a FreeCAD job.
fn source_lines(toolpath: &Toolpath, source: &Source) -> Lines {
    if let Some(text) = toolpath.commands() {
        return Lines::of(text.to_vec());
    }
    match (source, source.text()) {
        (Source::Memory { bytes, .. }, Ok(text)) if text.len() == bytes.len() => {
            Lines::of(Arc::clone(bytes))
        }
        (_, text) => Lines::of(text.unwrap_or_default().into_owned()),
    }
}

/// The files in which the templates of a machine stand.
fn texts_of(machine: &Machine, folder: &Folder) -> BTreeMap<String, Lines> {
    let of_blocks = machine.blocks.values().map(|block| &block.file);
    let names = of_blocks.chain([&machine.file]);
    let mut texts: BTreeMap<String, Lines> = BTreeMap::new();
    for name in names {
        if texts.contains_key(name) {
            continue;
        }
        let own =
            machine.loaded_from.files.iter().find(|path| folder.within(path) == Path::new(name));
        let stem = name.strip_suffix(".toml").unwrap_or(name);
        let text = match own {
            Some(path) => files::read(path).ok(),
            None => library::find(stem, library::EVERYTHING).map(|(_, text)| text.into()),
        };
        if let Some(text) = text {
            texts.insert(name.clone(), Lines::of(text));
        }
    }
    texts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_grow_by_those_beside_them_up_to_the_next_one() {
        let grown = |lines: &[u32]| {
            let lines = grown(&lines.iter().copied().collect(), |line| {
                ![1, 4, 9].contains(&line) && line < 13
            });
            lines.into_iter().collect::<Vec<_>>()
        };
        assert_eq!(grown(&[6, 7]), [5, 6, 7, 8]);
        assert_eq!(grown(&[2]), [2, 3]);
        assert_eq!(grown(&[1, 12]), [1, 2, 3, 10, 11, 12]);
        assert!(grown(&[]).is_empty());
    }
}
