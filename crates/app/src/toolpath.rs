//! Opening toolpaths and machines.

use crate::account::{Stop, Verdict};
use crate::fcstd;
use crate::files;
use crate::glass;
use crate::input::Source;
use crate::parallel::parallel;
use crate::pcb;
use crate::summary::{Shape, number};
use crate::watch::{Waits, Watch};
use crate::wire;
use control::{Folders, Setup, Units, WholeNumbers};
use freecad::{Job, Listing};
use geom::Vec3;
use machine::{Machine, Reach, Wire, library};
use program::{
    CompensatedPath, Diagnostic, Digest, Op, Program, Purpose, Rule, Severity, encoding, line_of,
};
use serde_json::{Value, json};
use source::apt::{self, Csys, Cutcom, SetUps};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What a source does not say itself: what an NC program was written for and what the operator has set up, and how
/// statements of CL data are meant.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// The source is an NC program of this control or machine: a name in the library, or the path of a file. A job of
    /// FreeCAD's has the rotary axes of this machine.
    pub from: Option<String>,
    /// Where the file of that machine and all that it extends may lie.
    pub reach: Reach,
    /// Tool table (LinuxCNC's format): with it cutter radius compensation becomes the path of the tool's centre.
    pub tools: Option<Source>,
    /// Folders in which called programs are looked for; nothing outside them is opened.
    pub folders: Vec<PathBuf>,
    /// Called programs that the caller has in memory, by the names of their files: they are found before those of the folders.
    pub called: BTreeMap<String, Vec<u8>>,
    /// Whether `X10` means 10 mm or 10 increments, on a control that can be set to both.
    pub whole_numbers: WholeNumbers,
    /// What lengths count before the program says it.
    pub units: Option<Units>,
    /// In which direction a boring bar moves off the wall of a hole, along X or Y, where a parameter of the control decides.
    pub aside: Option<Vec3>,
    /// Whether blocks that begin with `/` are skipped.
    pub block_delete: bool,
    /// The position of the tool when the program starts, mm.
    pub start: Option<Vec3>,
    /// The frame of the coordinates behind a `CSYS` of SolidWorks CAM; `None`: as the file says.
    pub csys: Option<Csys>,
    /// Which path the coordinates behind `CUTCOM` are; else what an arc in the file shows.
    pub cutcom: Option<CompensatedPath>,
}

/// A frame of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// That of the part: where the tip of the tool goes.
    Part,
    /// That of the machine: where X, Y and Z go.
    Machine,
}

/// A toolpath as it was read.
#[derive(Debug)]
pub struct Toolpath {
    /// What it was read from; nothing where it was put together in memory.
    source: Option<Source>,
    /// What else was read for it: the tool table, called programs.
    read_with: Vec<PathBuf>,
    /// SHA-256 of what was read (of a FreeCAD document, of its job), in hexadecimal digits; none for what was put
    /// together in memory.
    digest: Option<String>,
    /// Name of its file.
    pub file: String,
    /// The CAM system whose habits the file has, or the control that it was written for.
    pub dialect: String,
    /// What it says.
    pub program: Program,
    /// What was not passed on.
    pub warnings: Vec<Diagnostic>,
    /// The commands of a FreeCAD job that the lines of the program come from.
    listing: Option<Listing>,
    /// The set-ups of SolidWorks CAM, where it matters in which frame they are read.
    set_ups: Option<SetUps>,
    /// Of cutter-location data with `CUTCOM`, which path its coordinates are.
    cutcom: Option<Cutcom>,
}

/// Endings that NC programs have.
const NC_ENDINGS: [&str; 13] =
    ["nc", "ngc", "mpf", "spf", "h", "gcode", "tap", "cnc", "eia", "min", "din", "gc", "g"];

/// Reads a toolpath: a job of FreeCAD's, an NC program where `origin` says what it was written for, or
/// cutter-location data. Words for rotary axes in a job are those of the machine of `origin`, and where it
/// names none, of `machine`.
///
/// # Errors
/// What is wrong with the file; with `strict` also what would be a warning.
pub fn read(
    source: &Source,
    strict: bool,
    origin: &Origin,
    machine: Option<&Machine>,
    purpose: Purpose,
) -> Result<Toolpath, Stop> {
    read_for(source, strict, origin, machine, purpose, &())
}

/// The same for somebody who watches.
///
/// # Errors
/// As [`read`]; the work was ended.
pub fn read_for(
    source: &Source,
    strict: bool,
    origin: &Origin,
    machine: Option<&Machine>,
    purpose: Purpose,
    watch: &dyn Watch,
) -> Result<Toolpath, Stop> {
    let bytes = match fcstd::is(source.path()) {
        true => Cow::Owned(fcstd::job(source, watch).map_err(stopped(watch))?),
        false => source.read()?,
    };
    let file = source.name();
    let text = encoding::without_mark(&bytes);
    if encoding::is_utf_16(&bytes) || !Job::begins(text) {
        let set_up = |machine| machine;
        return Reader { source, strict, origin, purpose, set_up, watch }.read(bytes);
    }
    origin.is_of_no_record(&file)?;
    if origin.set_up().is_some() {
        let message = "a job of FreeCAD's runs on no control that somebody has set up";
        let help = "leave out the tool table, units and the like: the job says them itself";
        return Err(Diagnostic::error(Rule::Origin, message).help(help).file(file).into());
    }
    let named = origin.from.as_deref().map(|from| origin.reach.load_origin(from)).transpose()?;
    let digest = Some(Digest::of([&bytes[..]]));
    let job = Job::of(&file, text)?;
    let toolpath = job_for(&file, job, strict, named.as_ref().or(machine), purpose, watch)?;
    Ok(Toolpath { source: Some(source.clone()), digest, ..toolpath })
}

/// Reads a job of FreeCAD's, which is called `file`. Words for rotary axes are those of
/// `machine`.
///
/// # Errors
/// As [`read`].
pub fn read_job(
    file: &str,
    job: Job,
    strict: bool,
    machine: Option<&Machine>,
    purpose: Purpose,
) -> Result<Toolpath, Stop> {
    job_for(file, job, strict, machine, purpose, &())
}

fn job_for(
    file: &str,
    job: Job,
    strict: bool,
    machine: Option<&Machine>,
    purpose: Purpose,
    watch: &dyn Watch,
) -> Result<Toolpath, Stop> {
    let machine = match machine {
        Some(machine) => machine,
        None => &machine::load_control(THREE_AXES)?,
    };
    let freecad::Reading { program, listing, warnings } =
        freecad::read_for(machine, file, job, purpose, &Waits(watch)).map_err(stopped(watch))?;
    Ok(Toolpath {
        file: file.to_owned(),
        warnings: held(warnings, strict)?,
        listing: Some(listing),
        ..Toolpath::of_program(program, "FreeCAD job")
    })
}

/// The control of a job without a named machine: it has three axes.
const THREE_AXES: &str = "iso";

/// The same for a wire that `onto` cuts; a source of the same machine counts U and V in the plane that is set up there.
///
/// # Errors
/// As [`read`].
pub(crate) fn read_wire(
    source: &Source,
    strict: bool,
    origin: &Origin,
    onto: &Machine,
    watch: &dyn Watch,
) -> Result<Toolpath, Stop> {
    let set_up = |own: Machine| Machine { wire: wire_of(&own, onto), ..own };
    let purpose = Purpose::Contour;
    Reader { source, strict, origin, purpose, set_up, watch }.read(source.read()?)
}

/// The wire of the machine of a source that `onto` cuts: of the same machine it is set up as there.
pub(crate) fn wire_of(own: &Machine, onto: &Machine) -> Option<Wire> {
    if own.loaded_from.digest == onto.loaded_from.digest { onto.wire } else { own.wire }
}

/// What has stopped the work: whoever watches, or the finding.
fn stopped<T: Into<Stop>>(watch: &dyn Watch) -> impl FnOnce(T) -> Stop {
    move |found| if watch.is_cancelled() { Stop::cancelled() } else { found.into() }
}

/// Reads an NC program or cutter-location data.
struct Reader<'r, SetUp> {
    source: &'r Source,
    strict: bool,
    origin: &'r Origin,
    purpose: Purpose,
    /// Sets up the machine that an NC program was written for.
    set_up: SetUp,
    watch: &'r dyn Watch,
}

impl<SetUp: Fn(Machine) -> Machine> Reader<'_, SetUp> {
    fn read(self, bytes: Cow<[u8]>) -> Result<Toolpath, Stop> {
        self.origin.goes_with(&self.source.name())?;
        let text = files::text_of(self.source.path(), Cow::Borrowed(&bytes))?;
        let (toolpath, digest) = parallel(|| self.text(&text), || Digest::of([&bytes[..]]));
        Ok(Toolpath { digest: Some(digest), ..toolpath? })
    }

    /// The same of its text, without a digest.
    fn text(self, bytes: &[u8]) -> Result<Toolpath, Stop> {
        let Reader { source, strict, origin, purpose, set_up, watch } = self;
        let progress = Waits(watch);
        let file = source.name();
        let mut read_with = Vec::new();
        let (dialect, program, warnings, set_ups, cutcom) = match &origin.from {
            Some(from) => {
                let machine = set_up(origin.reach.load_origin(from)?);
                let setup = origin.setup(from, purpose)?;
                let folders = setup.folders.clone();
                let asked = |found: &Diagnostic| is_unknown_position(found.rule);
                let text = (&*file, bytes);
                let reading = nc::read_for(&machine, setup.clone(), text, &progress);
                // Where it failed, a called program may be what is to be mended, or is yet to come.
                let looked = reading.is_err().then_some(&origin.folders);
                let read = folders.files_read();
                read.iter().chain(looked.into_iter().flatten()).for_each(|at| watch.has_read(at));
                let reading = match reading {
                    Err(_) if watch.is_cancelled() => return Err(Stop::cancelled()),
                    Err(found) if purpose != Purpose::Program && asked(&found) => {
                        flat(&machine, setup, &file, bytes)?.ok_or(found)?
                    }
                    read => read?,
                };
                read_with.extend(origin.tools.as_ref().and_then(Source::file).map(Path::to_owned));
                read_with.extend(machine.loaded_from.files.clone());
                read_with.extend(folders.files_read());
                (machine.title, reading.program, reading.warnings, None, None)
            }
            None => {
                let Origin { csys, cutcom, .. } = *origin;
                let options = apt::Options { strict, csys, cutcom, purpose };
                let reading = apt::read_for(&file, bytes, &options, &progress);
                let reading = reading.map_err(|findings| match is_nc(source.path()) {
                    _ if watch.is_cancelled() => Stop::cancelled(),
                    _ if pcb::is_board(source) => {
                        of_other(&file, "a file of a circuit board", "`toolpost pcb` makes")
                    }
                    _ if glass::is_body(source) => {
                        of_other(&file, "a body, a picture or points", "`toolpost glass` makes")
                    }
                    _ if wire::is_drawing(source) => {
                        of_other(&file, "a drawing", "`toolpost wire` and `toolpost glass` make")
                    }
                    true => without_origin(&file),
                    false => Stop { verdict: Verdict::Invalid, findings },
                })?;
                let matters = |set_ups: &SetUps| set_ups.is_given || set_ups.changes > 0;
                let set_ups = reading.set_ups.filter(matters);
                let apt::Reading { program, warnings, dialect, cutcom, .. } = reading;
                (dialect.to_string(), program, warnings, set_ups, cutcom)
            }
        };
        let warnings = held(warnings, strict)?;
        let listing = None;
        Ok(Toolpath {
            source: Some(source.clone()),
            read_with,
            digest: None,
            file,
            dialect,
            program,
            warnings,
            listing,
            set_ups,
            cutcom,
        })
    }
}

/// The NC program of a machine with rotary axes as a picture shows it: the tip goes by rapid where the axes take it.
///
/// # Errors
/// As [`read`].
pub fn swinging(source: &Source, origin: &Origin, frame: Frame) -> Result<Option<Program>, Stop> {
    let from = origin.from.as_deref().filter(|_| !fcstd::is(source.path()));
    let Some(from) = from else { return Ok(None) };
    let machine = origin.reach.load_origin(from)?;
    if machine.rotary.is_empty() && frame == Frame::Part {
        return Ok(None);
    }
    let bytes = source.text()?;
    if Job::begins(&bytes) {
        return Ok(None);
    }
    let name = source.name();
    let setup = origin.setup(from, Purpose::Picture)?;
    let program = match frame {
        Frame::Part => nc::read_with_rapids_sampled(&machine, setup, &name, &bytes)?,
        Frame::Machine => nc::read_in_machine(&machine, setup, &name, &bytes)?,
    };
    Ok(Some(program))
}

/// Whether the origin of a program is a control of the library, of whose machine nothing is known.
fn is_control(from: &str) -> bool {
    library::find(from, library::CONTROLS).is_some()
        && library::find(from, library::MACHINES).is_none()
}

/// The program of a mill's control as a contour in the plane XY, at Z 0 where no block says Z: a wire goes through all
/// heights. Nothing where that is not what it lacks.
///
/// # Errors
/// A cut at another Z, which the program says.
fn flat(
    machine: &Machine,
    setup: Setup,
    file: &str,
    bytes: &[u8],
) -> Result<Option<nc::Reading>, Stop> {
    let setup = Setup { flat: true, ..setup };
    let Ok(mut reading) = nc::read(machine, setup, file, bytes) else { return Ok(None) };
    let height = |op: &Op| match op {
        Op::Line(pose) | Op::Hole(pose) => Some(pose.point().z),
        Op::Arc(arc) => Some(arc.end.point().z),
        _ => None,
    };
    let heights = reading.program.records.iter().filter_map(|r| height(&r.op).map(|z| (r.line, z)));
    if let Some((line, z)) = heights.into_iter().find(|(_, z)| z.abs() > SAME_HEIGHT) {
        let message = format!(
            "this cut is at Z {}, and one before it at a height that no block says",
            number(z, 4)
        );
        let found = Diagnostic::error(Rule::FlatContour, message).file(file);
        let help = "give Z in the first block, or leave it out of all: then the contour is flat";
        let text = line_of(bytes, line);
        return Err(found.help(help).at(line, text, 0, text.trim_ascii_end().len()).into());
    }
    let message = "the program cuts before a block says Z: it is read as a flat contour, at Z 0";
    reading.warnings.push(Diagnostic::warning(Rule::FlatContour, message));
    Ok(Some(reading))
}

/// Whether a block needs a position that no block before has given.
pub(crate) fn is_unknown_position(rule: Rule) -> bool {
    [Rule::UnknownPosition, Rule::CompensationUnknownPosition].contains(&rule)
}

/// Within which two heights of a flat contour are the same, mm.
const SAME_HEIGHT: f64 = 1e-6;

/// The warnings; with `strict` they stop the work.
pub(crate) fn held(warnings: Vec<Diagnostic>, strict: bool) -> Result<Vec<Diagnostic>, Stop> {
    if !strict || warnings.is_empty() {
        return Ok(warnings);
    }
    let strictly = |found: Diagnostic| Diagnostic { severity: Severity::Error, ..found };
    let findings = warnings.into_iter().map(strictly).collect();
    Err(Stop { verdict: Verdict::Invalid, findings })
}

/// Which path the coordinates behind `CUTCOM` are, and what says so.
fn compensated(cutcom: &Cutcom) -> String {
    match (cutcom.path, cutcom.evidence) {
        (None, _) => String::from("not known which path it means: --cutcom says it"),
        (Some(path), None) => format!("{}, as --cutcom says", path.described()),
        (Some(path), Some(shown)) => format!(
            "{}: the arc in line {} (radius {} mm) is one that a tool of radius {} mm can only make with its centre; {} of {} \
             contours show it so",
            path.described(),
            shown.line,
            number(shown.radius, 3),
            number(shown.tool_radius, 3),
            shown.showing,
            shown.stretches
        ),
    }
}

/// What the frame of set-ups is called.
fn name(csys: Csys) -> &'static str {
    match csys {
        Csys::Local => "local",
        Csys::World => "world",
    }
}

/// In which frame set-ups have been read, and why.
fn set_up_frame(set_ups: &SetUps) -> String {
    let count = match set_ups.changes {
        0 => String::from("one CSYS origin"),
        1 => String::from("the CSYS origin changes once"),
        n => format!("the CSYS origin changes {n} times"),
    };
    let frame = match set_ups.csys {
        Csys::Local => "in the frame of each CSYS",
        Csys::World => "in the world",
    };
    let why = match set_ups.is_given {
        true => "as --csys says",
        false => "as TRNTYP/WORLD says (--csys local reads them in each CSYS)",
    };
    format!("{count}; coordinates read {frame}, {why}")
}

/// Whether a file has the name of an NC program.
fn is_nc(path: &Path) -> bool {
    NC_ENDINGS.contains(&files::ending(path).as_str())
}

/// The refusal of an NC program without a named control.
fn without_origin(file: &str) -> Stop {
    let controls = library::names(library::CONTROLS).collect::<Vec<_>>();
    let message = "this is no cutter-location data, and as an NC program it has no control named";
    Diagnostic::error(Rule::Source, message)
        .help(format!("--from with a machine or one of {}", controls.join(", ")))
        .file(file)
        .into()
}

/// The refusal of what another command makes programs of.
fn of_other(file: &str, what: &str, commands: &str) -> Stop {
    Diagnostic::error(Rule::Source, format!("this is no toolpath but {what}"))
        .help(format!("{commands} programs of it"))
        .file(file)
        .into()
}

impl Origin {
    /// The option that says more than what the source was written for, where one does.
    fn set_up(&self) -> Option<&'static str> {
        let Origin {
            from: _,
            reach: _,
            tools,
            folders,
            called,
            whole_numbers,
            units,
            aside,
            block_delete,
            start,
            csys: _,
            cutcom: _,
        } = self;
        let given = [
            ("--tools", tools.is_some()),
            ("--folder", !folders.is_empty() || !called.is_empty()),
            ("--whole-numbers", *whole_numbers != WholeNumbers::Unknown),
            ("--units", units.is_some()),
            ("--aside", aside.is_some()),
            ("--block-delete", *block_delete),
            ("--start", start.is_some()),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(name, _)| name)
    }

    /// Checks that what it says goes together for the source `file`.
    ///
    /// # Errors
    /// It says how a control is set up and names none, or names one and says how statements of CL data are meant.
    pub(crate) fn goes_with(&self, file: &str) -> Result<(), Stop> {
        if self.from.is_some() {
            return self.is_of_no_record(file);
        }
        let Some(name) = self.set_up() else { return Ok(()) };
        let message =
            format!("{name} is for an NC program, and no control is named for this source");
        let help = format!(
            "name its control or machine by --from (`control` in Python), or leave {name} out"
        );
        Err(Diagnostic::error(Rule::Origin, message).help(help).file(file).into())
    }

    /// Refuses what is said of records for a source that cannot have them.
    pub(crate) fn is_of_no_record(&self, file: &str) -> Result<(), Stop> {
        let given =
            [("csys", "CSYS", self.csys.is_some()), ("cutcom", "CUTCOM", self.cutcom.is_some())];
        let Some((name, record, _)) = given.into_iter().find(|(.., given)| *given) else {
            return Ok(());
        };
        let message = format!(
            "--{name} is for cutter-location data with {record} records, which this is not"
        );
        Err(Diagnostic::error(Rule::Origin, message).help("leave it out").file(file).into())
    }

    /// What the operator has set up at the control of `from`, for a program that is read for `purpose`.
    fn setup(&self, from: &str, purpose: Purpose) -> Result<Setup, Stop> {
        let tools = match &self.tools {
            None => Vec::new(),
            Some(table) => {
                let found = control::tools::read(&table.text()?);
                found.map_err(|found| found.file(table.name()))?
            }
        };
        Ok(Setup {
            tools,
            folders: Folders::from(self.folders.clone()).with_texts(self.called.clone()),
            whole_numbers: self.whole_numbers,
            units: self.units,
            aside: self.aside,
            block_delete: self.block_delete,
            start: self.start,
            flat: false,
            purpose,
            rotary_at_zero: is_control(from),
            surface: Vec::new(),
        })
    }
}

impl Toolpath {
    /// A drawing, which has contours and no moves.
    pub(crate) fn of_drawing(source: &Source, bytes: &[u8], dialect: &str) -> Toolpath {
        let name = source.path().file_stem().unwrap_or_default().to_string_lossy();
        Toolpath {
            source: Some(source.clone()),
            digest: Some(Digest::of([bytes])),
            file: source.name(),
            ..Toolpath::of_program(Program::new(name), dialect)
        }
    }

    /// A program that no file says: its lines are what who put it together counts.
    pub fn of_program(program: Program, dialect: &str) -> Toolpath {
        Toolpath {
            source: None,
            read_with: Vec::new(),
            digest: None,
            file: program.name.clone(),
            dialect: dialect.to_owned(),
            program,
            warnings: Vec::new(),
            listing: None,
            set_ups: None,
            cutcom: None,
        }
    }

    /// With another toolpath that it was read together with: the upper contour of a wire.
    pub(crate) fn read_with(mut self, other: Toolpath) -> Toolpath {
        self.read_with.extend(other.files().into_iter().map(Path::to_owned));
        let both = self.digest.iter().chain(&other.digest).map(String::as_bytes);
        self.digest = Some(Digest::of(both));
        self.warnings.extend(other.warnings);
        self
    }

    /// All files that it was read from.
    pub fn files(&self) -> Vec<&Path> {
        let own = self.source.as_ref().and_then(Source::file);
        own.into_iter().chain(self.read_with.iter().map(PathBuf::as_path)).collect()
    }

    /// SHA-256 of what was read, in hexadecimal digits; none where nothing was.
    pub fn digest(&self) -> Option<&str> {
        self.digest.as_deref()
    }

    /// With what was not passed on; with `strict` that stops the work.
    ///
    /// # Errors
    /// The warnings, where they do.
    pub(crate) fn warned(
        mut self,
        warnings: Vec<Diagnostic>,
        strict: bool,
    ) -> Result<Toolpath, Stop> {
        self.warnings = held(warnings, strict)?;
        Ok(self)
    }

    /// Puts the file's name and the text of the line to findings that have nothing but a line of the
    /// source. The file is read again: while all goes well, nobody needs its text.
    pub fn quote(&self, findings: &mut [Diagnostic]) {
        let mut lines = None;
        for finding in findings.iter_mut().filter(|f| f.file.is_empty() && f.line > 0) {
            if let Some(listing) = &self.listing {
                *finding = listing.located(finding.clone());
                continue;
            }
            let text = lines.get_or_insert_with(|| self.text());
            *finding =
                finding.clone().on(finding.line, line_of(text, finding.line)).file(&self.file);
        }
    }

    /// What stops the work because of the toolpath, with the text of its line.
    pub fn refused(&self, found: Diagnostic) -> Stop {
        let mut findings = vec![found];
        self.quote(&mut findings);
        Stop { verdict: Verdict::Invalid, findings }
    }

    /// The source and its measures, as JSON.
    pub fn describe(&self, shape: &Shape) -> Value {
        let mut source = json!({ "file": self.file, "dialect": self.dialect, "measures": shape });
        if let Some(set_ups) = &self.set_ups {
            let SetUps { csys, is_given, changes } = *set_ups;
            let said_by = if is_given { "--csys" } else { "TRNTYP/WORLD" };
            source["set_ups"] =
                json!({ "csys": name(csys), "said_by": said_by, "changes_of_origin": changes });
        }
        if let Some(cutcom) = &self.cutcom {
            source["cutcom"] = json!({ "path": cutcom.path.map(CompensatedPath::name) });
            if let Some(shown) = cutcom.evidence {
                source["cutcom"]["shown_by"] = json!({
                    "line": shown.line,
                    "arc_radius_mm": shown.radius,
                    "tool_radius_mm": shown.tool_radius,
                    "stretches": shown.stretches,
                    "stretches_that_show_it": shown.showing,
                });
            }
        }
        if let Some(listing) = &self.listing {
            let operation = |(label, before)| json!({ "label": label, "before": before });
            source["operations"] = listing.operations().map(operation).collect();
        }
        source
    }

    /// The first lines of a summary: what was read, and for which machine it was done.
    pub fn rows(&self, machine: Option<&Machine>) -> Vec<(&'static str, String)> {
        let mut rows = vec![("toolpath", format!("{} ({})", self.file, self.dialect))];
        rows.extend(
            machine.map(|machine| ("machine", format!("{} ({})", machine.title, machine.name))),
        );
        if let Some(set_ups) = &self.set_ups {
            rows.push(("set-ups", set_up_frame(set_ups)));
        }
        if let Some(cutcom) = &self.cutcom {
            rows.push(("CUTCOM", compensated(cutcom)));
        }
        if self.listing.is_some() {
            let operations = self.program.records.iter().filter_map(|record| match &record.op {
                Op::Operation(name) => Some(name.as_ref()),
                _ => None,
            });
            rows.push(("operations", operations.collect::<Vec<_>>().join(", ")));
        }
        rows
    }

    /// The location of a line of the source, and its text; empty where there is none.
    pub fn location(&self, number: u32) -> (String, String) {
        if let Some(location) = self.listing.as_ref().map(|listing| listing.location(number)) {
            let text = String::from_utf8_lossy(location.text).into_owned();
            return (format!("{}:{}", location.file, location.command), text);
        }
        let text = String::from_utf8_lossy(line_of(&self.text(), number)).into_owned();
        (format!("{}:{number}", self.file), text)
    }

    /// The commands of a FreeCAD job, one a line: the lines of its program are theirs. None of any other source, whose program has the
    /// lines of its file.
    pub fn commands(&self) -> Option<&[u8]> {
        self.listing.as_ref().map(Listing::text)
    }

    /// The text of the source, as far as there is one still.
    fn text(&self) -> Cow<'_, [u8]> {
        self.source.as_ref().and_then(|source| source.text().ok()).unwrap_or_default()
    }
}

/// The machine of a name in the library or of a file.
///
/// # Errors
/// Where there is none, or its file has a mistake.
pub fn machine(name_or_path: &str) -> Result<Machine, Stop> {
    machine_within(name_or_path, &Reach::Anywhere)
}

/// The same, whose files lie where `reach` says.
///
/// # Errors
/// As [`machine()`], and a file that lies elsewhere.
pub fn machine_within(name_or_path: &str, reach: &Reach) -> Result<Machine, Stop> {
    checked(reach.load(name_or_path)?)
}

/// The machine of a text, as if it stood in the file `name`. What it extends lies where `reach` says.
///
/// # Errors
/// As [`machine_within`].
pub fn machine_of(name: &str, text: &str, reach: &Reach) -> Result<Machine, Stop> {
    checked(reach.load_text(name, text)?)
}

/// The same, or an arm for which no programs are written.
///
/// # Errors
/// As [`machine()`], but for such an arm.
pub fn machine_or_arm(name_or_path: &str) -> Result<Machine, Stop> {
    let machine = machine::load(name_or_path)?;
    if machine.has_control() { checked(machine) } else { Ok(machine) }
}

/// # Errors
/// It writes for no machine.
fn checked(machine: Machine) -> Result<Machine, Stop> {
    if !machine.has_control() {
        let message = format!(
            "{} is an arm whose kinematics alone are known: no programs are written for it",
            machine.title
        );
        let help =
            format!("`toolpost machines check {}` prints its reach and its joints", machine.name);
        return Err(Diagnostic::error(Rule::ArmKinematics, message)
            .help(help)
            .file(&machine.file)
            .into());
    }
    nc::settings(&machine, Setup::default())?;
    Ok(machine)
}

/// The same with other values for some of its options.
///
/// # Errors
/// As [`machine()`], or where it has no such option.
pub fn machine_with(name_or_path: &str, options: &[(String, String)]) -> Result<Machine, Stop> {
    let mut machine = machine(name_or_path)?;
    for (name, value) in options {
        machine.set_option(name, value)?;
    }
    Ok(machine)
}

/// What a machine is called, as JSON.
pub fn describe(machine: &Machine) -> Value {
    json!({
        "name": machine.name,
        "title": machine.title,
        "control": machine.control,
        "reader": machine.reader,
        "extension": machine.extension,
        "path_tolerance_mm": machine.path_tolerance(),
        "orientation_tolerance_degrees": machine.orientation_tolerance(),
    })
}
