//! Cutter-location data in text form (APT, ISO 4343), of any CAM system.
//!
//! [`read`] takes the bytes of a file and gives a [`Program`] whose poses are all in the work frame
//! and in mm: inches, frames, relative motion, surface speeds and modal words are resolved. The CAM
//! system is detected from the content of the file ([`Dialect`]).
//!
//! What cannot be resolved is an error with file, line and column, never a guess and never left out
//! silently. What is known not to matter for the program is ignored; what is not known is a warning,
//! one a word. The statements and the sources of their meaning are in `docs/sources/apt.md`.
//!
//! From bytes to program: `statement` finds lines and fields, `table` the handler of each major word,
//! and the handlers are in `motion`, `arc`, `cycle`, `frame`, `technology` and `text`.

mod arc;
mod cycle;
mod dialect;
mod frame;
mod motion;
mod number;
mod report;
mod statement;
mod table;
mod technology;
mod text;

pub use dialect::Dialect;

use cycle::ActiveCycle;
use frame::Setup;
use geom::Vec3;
use motion::Next;
use program::{
    CompensatedPath, Compensation, Coolant, Diagnostic, Feed, Op, PathEvidence, Pose, Program,
    Progress, Pulse, Purpose, Record, Rule, Spindle, Tool, encoding,
};
use report::{Fault, Report};
use statement::{Joiner, Line, Lines, is_blank};
use std::cell::Cell;
use std::f64::consts::PI;
use technology::FeedUnit;

/// How to read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Warnings are errors.
    pub strict: bool,
    /// In which frame the coordinates of a file with `CSYS` are, where the file does not show it.
    pub csys: Option<Csys>,
    /// Which path the coordinates behind `CUTCOM` are, where the file does not show it.
    pub cutcom: Option<CompensatedPath>,
    /// What the file is read for.
    pub purpose: Purpose,
}

/// The frame of coordinates and vectors that follow a `CSYS` of SolidWorks CAM.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Csys {
    /// In the frame of that `CSYS`.
    Local,
    /// In one frame, whatever `CSYS` says.
    World,
}

/// The set-ups of a file with `CSYS`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SetUps {
    /// Where their coordinates have been read.
    pub csys: Csys,
    /// The options have said so, and not the file.
    pub is_given: bool,
    /// How often the origin is another one than before.
    pub changes: usize,
}

/// What is known of the coordinates of a file with `CUTCOM`; the program has it as its
/// [`Program::compensated_path`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutcom {
    /// Which path they are, where it is known.
    pub path: Option<CompensatedPath>,
    /// What in the file shows it.
    pub evidence: Option<PathEvidence>,
}

/// What a file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its program.
    pub program: Program,
    /// What the reader did not pass on or had to assume, one for each cause.
    pub warnings: Vec<Diagnostic>,
    /// The CAM system that wrote it.
    pub dialect: Dialect,
    /// Its set-ups; none where it has no `CSYS`.
    pub set_ups: Option<SetUps>,
    /// Which path its coordinates behind `CUTCOM` are; none where it switches no compensation on.
    pub cutcom: Option<Cutcom>,
}

/// Reads cutter-location data. `file_name` is for the messages, and names the program where the file
/// does not.
///
/// Time and memory are linear in `text`; a move takes at most 64 bytes.
///
/// # Errors
/// Every error found, at most twenty, in the order of their lines. There is no partial program.
pub fn read(file_name: &str, text: &[u8], options: &Options) -> Result<Reading, Vec<Diagnostic>> {
    read_for(file_name, text, options, &())
}

/// The same for somebody who waits for it.
///
/// # Errors
/// As [`read`]; the work was ended (`cancelled`).
pub fn read_for(
    file_name: &str,
    text: &[u8],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Reading, Vec<Diagnostic>> {
    let text = encoding::without_mark(text);
    let mut pulse = Pulse::new(progress, text.len(), LINES_AT_ONCE);
    let mut reader = Reader::new(file_name, text, options);
    if text.starts_with(b"\xff\xfe") || text.starts_with(b"\xfe\xff") {
        reader.report.error(encoding::utf_16().line(1));
        return Err(reader.report.errors);
    }
    let mut joiner = Joiner::default();
    let mut lines = Lines::of(text);
    let mut last = Line { number: 0, text: b"" };
    while let Some(line) = lines.next() {
        pulse
            .step(line.text.as_ptr() as usize - text.as_ptr() as usize)
            .map_err(|end| vec![*end])?;
        if reader.obey_plain_goto(line.number, line.text) {
            last = line;
            continue;
        }
        if line.text.len() <= statement::LONGEST && line.text.iter().all(|c| is_blank(*c)) {
            continue;
        }
        last = line;
        match joiner.statement(line, &mut lines) {
            Ok(statement) => {
                if let Err(fault) = reader.obey(&statement) {
                    reader.report.fault(&statement, *fault);
                }
            }
            Err(error) => reader.report.error(*error),
        }
        if reader.hopeless || reader.report.is_full() {
            break;
        }
    }
    reader.finish(text, last)
}

/// After so many lines whoever waits is asked: a millisecond at the most.
const LINES_AT_ONCE: u32 = 1024;

/// How far what a motion needs has been settled since the last statement that could change it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ready {
    /// Not at all.
    No,
    /// For a rapid.
    Rapid,
    /// For a cut.
    Cut,
}

/// A rapid before the first tool is loaded.
struct Early {
    line: u32,
    /// Number of records before it.
    records: usize,
    /// Diameter of the tool, where the file has given one by then.
    diameter: Option<f64>,
}

/// A surface speed, which holds for the tools to come as well.
#[derive(Clone, Copy)]
struct SurfaceSpeed {
    /// Line that gives it.
    line: u32,
    /// mm/min.
    speed: f64,
    /// `MAXRPM` of its statement, or of the last one that has it.
    max: Option<MaxRpm>,
}

/// `MAXRPM`: the highest speed of the spindle at a surface speed.
#[derive(Clone, Copy)]
struct MaxRpm {
    /// Line that gives it.
    line: u32,
    /// 1/min.
    speed: f64,
}

impl SurfaceSpeed {
    /// The spindle speed in 1/min on `diameter` mm.
    ///
    /// # Errors
    /// It is above the `MAXRPM` of an older statement: whether that still counts, nothing says.
    fn on(self, diameter: f64) -> Result<f64, Box<Fault>> {
        let speed = self.speed / (PI * diameter);
        match self.max.filter(|max| speed > max.speed) {
            Some(max) if max.line != self.line => {
                let message = format!(
                    "the surface speed of line {} means {speed:.0} 1/min on a diameter of {diameter} mm, above the MAXRPM of {} in line {}: \
                     whether that still counts, the data do not say",
                    self.line, max.speed, max.line
                );
                Err(Fault::new(Rule::Spindle, message)
                    .help("say MAXRPM in the statement of the surface speed too"))
            }
            Some(max) => Ok(max.speed),
            None => Ok(speed),
        }
    }
}

/// What has been read, and what holds.
struct Reader {
    report: Report,
    program: Program,
    dialect: Dialect,
    /// mm in a unit of the file.
    unit: f64,
    /// Whether the file has said so.
    unit_known: bool,
    /// Whether it was reported that it has not.
    unit_assumed: bool,
    /// Line of the first value that was read before it has; 0 for none.
    unit_used: Cell<u32>,
    /// Line of the statement at hand.
    line: u32,
    setup: Setup,
    /// The last point of the data, work frame; missing values and relative motion count from it.
    point: Option<Vec3>,
    /// Where the tool is; above the point after a hole.
    tip: Option<Pose>,
    /// The tool axis, work frame.
    axis: Vec3,
    /// `FROM`, until the first motion.
    from: Option<(u32, Pose)>,
    next: Next,
    /// Line of the `CIRCLE` that waits for its `GOTO`.
    circle_at: u32,
    /// `INDIRV`, work frame.
    towards: Option<Vec3>,
    /// Where the arc of the last motion starts, where that was one.
    last_arc: Option<Vec3>,
    /// Whether the last statement was a `GOTO`, which lines of coordinates may continue.
    inside_goto: bool,
    /// Whether there is an arc of a `CIRCLE`, whose direction is a habit.
    circles: bool,
    /// How far the path may lie inside and outside of the part, in the unit of the file: `INTOL`, `OUTTOL`.
    tolerances: [f64; 2],
    /// Whether the program says so already.
    says_tolerance: bool,
    /// What it has said last, both together in mm; 0 for none.
    said_tolerance: f64,
    feed: Option<Feed>,
    feed_unit: FeedUnit,
    spindle: Spindle,
    /// The last that turned, for `SPINDL/ON`.
    last_spindle: Option<Spindle>,
    /// The surface speed that it was resolved from, where it was.
    surface: Option<SurfaceSpeed>,
    /// The last `MAXRPM`.
    max_rpm: Option<MaxRpm>,
    /// The record of the tool whose speed is still to be found from it.
    speed_due: Option<usize>,
    /// The last kind, for `COOLNT/ON`.
    last_coolant: Coolant,
    /// Which path the coordinates behind `CUTCOM` are, where the options say it.
    cutcom: Option<CompensatedPath>,
    /// The last side, for `CUTCOM/ON`.
    last_side: Option<Compensation>,
    /// The tool in the spindle; number 0 for none.
    tool: Tool,
    /// Its record, until the first motion with it.
    tool_record: Option<usize>,
    /// Line of the first statement of the file that loads a tool.
    first_load: Option<u32>,
    /// The first rapid, where it comes before that statement.
    early: Option<Early>,
    /// What is said of the tool to come.
    next_tool: Tool,
    /// Line that says it.
    next_line: u32,
    /// Point angle of the tool, degrees.
    point_angle: Option<f64>,
    /// Number of records right after a comment that may turn out to be the name of a tool.
    inserted: Option<usize>,
    cycle: Option<ActiveCycle>,
    /// For `CYCLE/ON`.
    last_cycle: Option<ActiveCycle>,
    /// Open `TOOL PATH`, with its line.
    operation: Option<(u32, Box<str>)>,
    /// Open sections of a Makino file, with their lines.
    sections: Vec<(u32, Box<str>)>,
    ready: Ready,
    /// A cut with a standing spindle, or without a feed, has been reported, or is not asked about.
    stands: bool,
    no_feed: bool,
    ended: bool,
    /// Some statement was cutter-location data.
    known: bool,
    /// The file is something else.
    hopeless: bool,
}

impl Reader {
    fn new(file_name: &str, text: &[u8], options: &Options) -> Reader {
        let stem = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
        let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
        Reader {
            report: Report::new(file_name, options.strict),
            program: Program::new(stem),
            dialect: Dialect::of(text),
            unit: 1.0,
            unit_known: false,
            unit_assumed: false,
            unit_used: Cell::new(0),
            line: 0,
            setup: Setup::new(options.csys),
            point: None,
            tip: None,
            axis: Vec3::Z,
            from: None,
            next: Next::Line,
            circle_at: 0,
            towards: None,
            last_arc: None,
            inside_goto: false,
            circles: false,
            tolerances: [0.0; 2],
            says_tolerance: true,
            said_tolerance: 0.0,
            feed: None,
            feed_unit: FeedUnit::PerMinute,
            spindle: Spindle::Off,
            last_spindle: None,
            surface: None,
            max_rpm: None,
            speed_due: None,
            // Coolant as such is flood.
            last_coolant: Coolant::Flood,
            cutcom: options.cutcom,
            last_side: None,
            tool: Tool::default(),
            tool_record: None,
            first_load: statement::first_load(text),
            early: None,
            next_tool: Tool::default(),
            next_line: 0,
            point_angle: None,
            inserted: None,
            cycle: None,
            last_cycle: None,
            operation: None,
            sections: Vec::new(),
            ready: Ready::No,
            stands: !options.purpose.asks_technology(),
            no_feed: !options.purpose.asks_technology(),
            ended: false,
            known: false,
            hopeless: false,
        }
    }

    #[inline]
    fn push(&mut self, line: u32, op: Op) {
        self.program.records.push(Record { line, op });
    }

    /// What can only be said at the end of `text`, of which `last` is the last line that was read.
    fn finish(mut self, text: &[u8], last: Line) -> Result<Reading, Vec<Diagnostic>> {
        if self.report.errors.is_empty() {
            self.judge_the_end(last);
            self.judge_the_arcs(text);
        }
        if self.report.errors.is_empty() {
            match self.judge_the_compensation() {
                Ok(cutcom) => {
                    let set_ups = self.setup.set_ups();
                    let Reader { mut program, report, dialect, .. } = self;
                    program.compensated_path = cutcom.and_then(|cutcom| cutcom.path);
                    let warnings = report.warnings;
                    return Ok(Reading { program, warnings, dialect, set_ups, cutcom });
                }
                Err(mut finding) => {
                    if let Some(line) = Lines::of(text).find(|line| line.number == finding.line) {
                        finding = finding.at(line.number, line.text, 0, line.text.len()).into();
                    }
                    self.report.error(*finding);
                }
            }
        }
        Err(self.report.errors)
    }

    /// Whether the file ends as one of its kind does.
    fn judge_the_end(&mut self, last: Line) {
        let place = |d: Diagnostic| match last.number {
            0 => d,
            number => d.at(number, last.text, 0, last.text.len()),
        };
        if !self.known {
            let what = if last.number == 0 { "the file is empty" } else { "no statement is known" };
            let help = "cutter-location data (APT, .cls, .apt, .ncl) is expected";
            return self.report.error(Diagnostic::error(Rule::NotCldata, what).help(help));
        }
        if let Err(fault) = self.no_pending_circle() {
            let statement = statement::Statement::whole(last);
            return self.report.fault(&statement, *fault);
        }
        if self.point.is_none() {
            return self
                .report
                .error(Diagnostic::error(Rule::NoMotion, "nothing moves in this file"));
        }
        if self.setup.lacks_csys() {
            let message = "where coordinates stand is asked for by `csys`, and the file has no CSYS statement";
            return self
                .report
                .error(Diagnostic::error(Rule::Frame, message).help("leave `--csys` out"));
        }
        if let (Some(early), Some(load)) = (&self.early, self.first_load) {
            // What looked like a statement was part of another one.
            let message = format!("line {} moves, but line {load} loads no tool", early.line);
            let help = "add LOAD/TOOL,n before the first motion";
            return self
                .report
                .error(place(Diagnostic::error(Rule::ToolNumber, message).help(help)));
        }
        let open = self.operation.take().or_else(|| self.sections.pop());
        if let Some((line, name)) = open {
            let message = format!("the file ends within {name}, which line {line} begins");
            let error = Diagnostic::error(Rule::Truncated, message);
            return self.report.error(place(error.help("the file is cut off: write it again")));
        }
        match self.dialect {
            _ if self.ended => {}
            Dialect::SolidWorksCam => {
                let error = Diagnostic::error(Rule::Truncated, "the file ends without FINI");
                self.report.error(place(error.help("the file is cut off: write it again")));
            }
            // These close what they open instead.
            Dialect::Nx | Dialect::Makino => self.push(last.number, Op::End),
            Dialect::Iso | Dialect::Catia | Dialect::Creo => {
                let warning = Diagnostic::warning(Rule::NoFini, "the file ends without FINI");
                let help = "check that it is not cut off";
                self.report.warning(place(warning.help(help)));
                self.push(last.number, Op::End);
            }
        }
    }

    /// Which path the coordinates behind `CUTCOM` are.
    ///
    /// # Errors
    /// The file shows both, or another than the options say; the options say it, and there is no `CUTCOM`.
    fn judge_the_compensation(&self) -> Result<Option<Cutcom>, Box<Diagnostic>> {
        let evidence = PathEvidence::of(&self.program)?;
        match (self.cutcom, evidence) {
            (Some(_), _) if self.program.compensates().is_none() => {
                let message =
                    "which path CUTCOM means is given by `cutcom`, and the file has no CUTCOM";
                let found = Diagnostic::error(Rule::CompensatedPath, message);
                Err(found.help("leave `--cutcom` out").into())
            }
            (Some(given), Some(shown)) if given != shown.path => {
                let message = format!(
                    "`cutcom` says {}, and this arc (radius {:.3} mm, tool radius {:.3} mm) can only be {}",
                    given.name(),
                    shown.radius,
                    shown.tool_radius,
                    shown.path.described()
                );
                let found = Diagnostic::error(Rule::CompensatedPath, message).line(shown.line);
                Err(found.help(format!("`--cutcom {}`, or leave it out", shown.path.name())).into())
            }
            (given, evidence) => {
                let path = given.or(evidence.map(|evidence| evidence.path));
                Ok(self.program.compensates().map(|_| Cutcom { path, evidence }))
            }
        }
    }

    /// Whether the arcs turn as the path shows.
    fn judge_the_arcs(&mut self, text: &[u8]) {
        if !self.circles {
            return;
        }
        let Some(mut finding) = arc::judge(&self.program, self.dialect) else { return };
        if let Some(line) = Lines::of(text).find(|line| line.number == finding.line) {
            finding = finding.at(line.number, line.text, 0, line.text.len());
        }
        if finding.is_error() {
            self.report.error(finding);
        } else {
            self.report.warning(finding);
        }
    }
}
