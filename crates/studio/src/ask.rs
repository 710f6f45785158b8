//! What the page asks for and what it is answered: the types of the socket's heads, in Rust and, by a test, in TypeScript
//! (`studio/src/protocol/types.ts`).
//!
//! An ask is `{ "id": 7, "ask": "folder", "params": {...} }`, answered by [`Done`], with arrays where the type says so, or by [`Stopped`].
//! Meanwhile come [`Progress`] events; [`Cancel`] ends it. What nobody knows is null, and never 0.

use machine::linkage::Linkage;
use program::Diagnostic;
use serde::{Deserialize, Serialize};
use serde_json::Value;
#[cfg(test)]
use ts_rs::TS;

/// The first frame of a page.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct Hello {
    /// The token of the link.
    pub token: String,
}

/// Ends the work of an ask.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct Cancel {
    /// Its id.
    pub cancel: u32,
}

/// What an ask was for.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Done<T> {
    /// Its id.
    pub id: u32,
    /// The answer.
    pub done: T,
}

/// An ask that has no answer.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Stopped {
    /// Its id.
    pub id: u32,
    /// How it ended, and why.
    pub stop: Stop,
}

/// How work without a result ended, and why.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Stop {
    /// How.
    pub verdict: Verdict,
    /// Why.
    pub findings: Vec<Finding>,
}

/// How work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It is done, and where it is a program, proven.
    Done,
    /// Something is left out.
    Partly,
    /// The machine cannot do it, or the proof failed.
    Failed,
    /// The input is wrong.
    Invalid,
    /// A newer ask, or the page, has ended it.
    Cancelled,
}

impl From<app::Verdict> for Verdict {
    fn from(verdict: app::Verdict) -> Verdict {
        match verdict {
            app::Verdict::Done => Verdict::Done,
            app::Verdict::Partly => Verdict::Partly,
            app::Verdict::Failed => Verdict::Failed,
            app::Verdict::Invalid => Verdict::Invalid,
            app::Verdict::Cancelled => Verdict::Cancelled,
        }
    }
}

/// How far an ask has come.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Progress {
    /// `progress`.
    #[cfg_attr(test, ts(type = "\"progress\""))]
    pub event: &'static str,
    /// Of which ask.
    pub id: u32,
    /// What is being done: `reading`, `writing`, `proving`.
    pub step: &'static str,
    /// How much of it is done, from 0 to 1, where that is known.
    pub part: Option<f64>,
}

/// What the proof that runs has walked since the last such event: the next chunks of moves, thinned so that all of them have about 250,000
/// vertices. The arrays are `index` and `vertices` (u8), as [`crate::geometry`] describes them; an entry's vertices of level 0 are those
/// that are sent. Nothing of it is proven.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Walked {
    /// `walked`.
    #[cfg_attr(test, ts(type = "\"walked\""))]
    pub event: &'static str,
    /// Of which ask.
    pub id: u32,
    /// Name of the program's file.
    pub file: String,
    /// Number of the first chunk.
    pub chunk: u32,
    /// How many moves there are so far.
    pub moves: u32,
    /// When the last one of them is over, s.
    pub time_s: f64,
    /// What the numbers of kinds mean.
    pub kinds: Vec<&'static str>,
}

/// A finding, as `--json` prints it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// The rule that it is of; `toolpost explain RULE` says more.
    pub rule: &'static str,
    /// What is wrong, with values and units.
    pub message: String,
    /// The way out.
    pub help: String,
    /// Name of the file; empty where there is none.
    pub file: String,
    /// Which text that file is, where it is one of the job's.
    pub of: Option<Of>,
    /// Line from 1; 0 where it is about the whole.
    pub line: u32,
    /// Column from 1 in characters; 0 where it is about the whole line.
    pub column: u32,
    /// How many characters it covers.
    pub width: u32,
    /// The text of the line, and a mark below it; empty where it is not at hand.
    pub excerpt: String,
    /// How often it occurred.
    pub count: u32,
    /// Lines of the first few like it.
    pub lines: Vec<u32>,
    /// Lines of all others that it stands for, the first ten thousand.
    pub places: Vec<u32>,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The result is good.
    Warning,
    /// There is no result.
    Error,
}

impl From<Diagnostic> for Finding {
    fn from(found: Diagnostic) -> Finding {
        Finding {
            severity: if found.is_error() { Severity::Error } else { Severity::Warning },
            rule: found.rule.name(),
            message: found.message,
            help: found.help,
            file: found.file,
            of: None,
            line: found.line,
            column: found.column,
            width: found.width,
            excerpt: found.excerpt,
            count: found.count,
            lines: found.lines,
            places: found.places,
        }
    }
}

/// `open {}`: what there is.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Opened {
    /// Of the command.
    pub version: &'static str,
    /// Name of the folder.
    pub folder: String,
    /// What the command line named.
    pub source: Option<Given>,
    /// The same.
    pub machine: Option<String>,
    /// Drafts that are kept.
    pub drafts: Vec<Draft>,
    /// What the server takes.
    pub limits: Limits,
}

/// What the server takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Limits {
    /// The largest upload, bytes.
    pub upload: u64,
    /// The largest frame, bytes.
    pub frame: u64,
    /// How many jobs are open at the same time; the older ones go.
    pub jobs: u32,
    /// How many sockets are open at the same time.
    pub sockets: u32,
}

/// A file of the folder, or what was uploaded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum FileOrUpload {
    /// Its path in the folder.
    File(String),
    /// The id that the upload was answered with.
    Upload(String),
}

/// What programs are made of: a file, or a board of several.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Given {
    /// The path of a file in the folder.
    File(String),
    /// The id that an upload was answered with.
    Upload(String),
    /// The path of a folder in the folder, whose files are those of a board.
    Folder(String),
    /// The ids of the files of a board.
    Uploads(Vec<String>),
}

/// `folder { path }`.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct FolderParams {
    /// Below the named folder; empty for itself.
    pub path: String,
}

/// What is in a folder.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Listing {
    /// Folders first, in the order of their names.
    pub entries: Vec<Entry>,
    /// Whether these are all.
    pub is_whole: bool,
}

/// An entry of a folder.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Its path below the named folder.
    pub path: String,
    /// What it is.
    pub kind: EntryKind,
    /// Size of a file.
    pub bytes: Option<u64>,
    /// When it was written last, s since 1970 (UTC); 0 where the system does not say.
    pub written: u64,
}

/// What an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum EntryKind {
    /// A folder.
    Folder,
    /// A file.
    File,
}

/// `machines {}`: a machine that can be picked.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct MachineEntry {
    /// A name of the library, or the path of a file of the folder.
    pub name: String,
    /// What a person calls it.
    pub title: String,
    /// What it is.
    pub kind: MachineKind,
    /// The control that it extends.
    pub control: String,
    /// Names of its axes.
    pub axes: Vec<String>,
    /// Whether it is a file of the folder.
    pub is_own: bool,
    /// What is wrong with its file.
    pub findings: Vec<Finding>,
}

/// What a machine is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum MachineKind {
    /// A mill, a router or an engraver.
    Mill,
    /// Wire EDM.
    Wire,
    /// An arm with its control.
    Robot,
    /// A laser that fires inside glass.
    Glass,
}

/// One of the texts of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum Of {
    /// The program.
    Program,
    /// The source.
    Source,
    /// The machine file.
    Machine,
}

/// An edit that is kept, and nowhere saved.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Draft {
    /// Its name.
    pub name: String,
    /// What the page has said of it (source, machine, options, file).
    #[cfg_attr(test, ts(type = "unknown"))]
    pub of: Value,
    /// Size of its text.
    pub bytes: u64,
}

/// `draft { name, of }` with the array `text`: keeps it.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct DraftParams {
    /// Up to 100 letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// What the page wants to know of it later.
    #[cfg_attr(test, ts(type = "unknown"))]
    pub of: Value,
}

/// `draft_text { name }`: answers the array `text`; `drop_draft { name }`.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct DraftName {
    /// Its name.
    pub name: String,
}

/// An answer that says no more than that it is done.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Nothing {}

/// `PUT /upload/NAME` is answered with it.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Uploaded {
    /// Its id: a digest of its name and bytes.
    pub upload: String,
    /// Its name.
    pub name: String,
    /// Its size.
    pub bytes: u64,
}

/// What programs are written by: that says whose options a form has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum Command {
    /// Mills and robots.
    #[default]
    Post,
    /// Wire EDM.
    Wire,
    /// Circuit boards.
    Pcb,
    /// Points inside glass.
    Glass,
}

/// `command { source, machine }`: answers the [`Command`] that writes programs of a source for a machine.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct CommandParams {
    /// What is made.
    pub source: Given,
    /// The machine; null where none is chosen yet.
    #[serde(default)]
    pub machine: Option<String>,
}

/// `kinds { source }`: answers the [`MachineKind`]s of which a machine can take the source.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct KindsParams {
    /// What is made.
    pub source: Given,
}

/// `form { command }`: answers the fields.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct FormParams {
    /// Of which command; left out: `post`.
    #[serde(default)]
    #[cfg_attr(test, ts(optional, as = "Option<_>"))]
    pub command: Command,
}

/// `post { source, machine, options }`: writes the program and proves it. Answered by a [`Job`], of a board by that of its first program; a newer `post` or `prove` of the same page
/// ends an older one.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct PostParams {
    /// The toolpath, or the board.
    pub source: Given,
    /// A name of the library, or the path of a file of the folder.
    pub machine: String,
    /// Options as the command line has them, without dashes: `[["from", "fanuc-31i"], ["strict", ""]]`.
    #[serde(default)]
    pub options: Vec<(String, String)>,
    /// Name of the program's file; null: that of the source with the machine's ending.
    #[serde(default)]
    pub file: Option<String>,
}

/// `prove { source, machine, options, program }`, or with the array `text` in place of `program`: proves a program, also one that was edited by
/// hand. With `revision` it is an edit of that job's program: its other files are those of the job, and none is looked for in a folder. Answered by a [`Job`].
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct ProveParams {
    /// The toolpath, or the board.
    pub source: Given,
    /// As in `post`.
    pub machine: String,
    /// As in `post`.
    #[serde(default)]
    pub options: Vec<(String, String)>,
    /// As in `post`: what a text is called that no file has.
    #[serde(default)]
    pub file: Option<String>,
    /// The program, where it is no edited text.
    #[serde(default)]
    pub program: Option<FileOrUpload>,
    /// The job whose program was edited, where that is still open.
    #[serde(default)]
    pub revision: Option<u64>,
    /// The files of its program that were edited, null for the program itself: they stand one behind the other in `text`, each with so many
    /// bytes. Left out: `text` is the program itself.
    #[serde(default)]
    #[cfg_attr(test, ts(optional, as = "Option<_>"))]
    pub files: Vec<(Option<String>, u64)>,
}

/// A program with its verdict and its moves.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Job {
    /// By which all else is asked for.
    pub revision: u64,
    /// How it ended.
    pub verdict: Verdict,
    /// What is reported of it: head (empty for a further line of the one before) and text.
    pub rows: Vec<(String, String)>,
    /// What is wrong with it, or worth knowing.
    pub findings: Vec<Finding>,
    /// The program; null where none was written.
    pub program: Option<Text>,
    /// The files that it calls.
    pub parts: Vec<Text>,
    /// The source.
    pub source: Text,
    /// More files of it, as those of a board.
    pub sources: Vec<Text>,
    /// The machine.
    pub machine: JobMachine,
    /// The moves that the proof has walked.
    pub walk: WalkAbout,
    /// Where a failed proof first differs.
    pub mismatch: Option<Mismatch>,
    /// All programs of the board that it is one of; null where it is of no board.
    pub board: Option<BoardAbout>,
    /// The blocks of glass that it fires in, in the frame of the first; none of another machine.
    pub blocks: Vec<GlassBlock>,
}

/// A block of glass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GlassBlock {
    /// A corner of it, mm.
    pub corner: [f64; 3],
    /// Its sides from there, mm.
    pub sides: [[f64; 3]; 3],
}

/// `job { revision }`: answers the [`Job`] again, as another program of a board.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct JobParams {
    /// Of the job.
    pub revision: u64,
}

/// A board, and all that is made of it.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BoardAbout {
    /// What it is called.
    pub name: String,
    /// `done`, or `partly` where a program is left out.
    pub verdict: Verdict,
    /// What is reported of all programs together.
    pub rows: Vec<(String, String)>,
    /// The programs, in the order in which they are run.
    pub programs: Vec<BoardProgram>,
    /// Those that could not be made.
    pub left_out: Vec<LeftOut>,
}

/// A program of a board.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BoardProgram {
    /// What it does: `front`, `drill`.
    pub name: String,
    /// Its file.
    pub file: String,
    /// By which its job is asked for.
    pub revision: u64,
    /// How many findings it has of its own.
    pub findings: u32,
}

/// A program of a board that could not be made.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct LeftOut {
    /// Its file.
    pub file: String,
    /// Why.
    pub findings: Vec<Finding>,
}

/// `board { revision }`: what the board is drawn with below the cuts of a program, the lowest first. Answered with the arrays `areas` (f32, six for
/// each trapezoid between two lines along X: the lower and the upper Y, left and right X at the lower, left and right X at the upper one),
/// `holes` (f32, five for each stroke with round ends: X, Y, X, Y, width) and `tabs` (f32, four for each line: X, Y, X, Y), all mm.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BoardPicture {
    /// What the trapezoids are, in their order.
    pub areas: Vec<BoardArea>,
    /// Places to look at: gaps that are not cut, copper that is taken, the worst first.
    pub places: Vec<BoardPlace>,
    /// The line about which the board is turned over, where it is.
    pub turning: Option<Turning>,
    /// How wide the only tool cuts, mm, where the program has one: a control that changes no tools does not name it.
    pub width: Option<f64>,
    /// How far the areas may be from what they are of, mm.
    pub error: f64,
    /// Whether these are all areas.
    pub is_whole: bool,
}

/// An area of a board.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BoardArea {
    /// What it is.
    pub kind: BoardAreaKind,
    /// The name of its net, where a file says it.
    pub net: Option<String>,
    /// The number of its conductor: islands of one net are one.
    pub conductor: u32,
    /// How many trapezoids it has.
    pub count: u32,
}

/// What an area of a board is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum BoardAreaKind {
    /// The board without its copper.
    Board,
    /// Copper.
    Copper,
    /// What stays that should not.
    Rest,
}

/// A place of a board to be looked at.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BoardPlace {
    /// mm.
    pub x: f64,
    /// mm.
    pub y: f64,
    /// `joined`, `slot`, `bitten`, `severed` or `not-made`.
    pub kind: &'static str,
    /// What is there.
    pub what: String,
}

/// The line about which a board is turned over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Turning {
    /// The axis that it runs along: `X` or `Y`.
    pub along: &'static str,
    /// Where it is on the other axis, mm.
    pub at: f64,
}

/// The first mismatch, side by side.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Mismatch {
    /// The called file that the block stands in; null for the program itself.
    pub file: Option<String>,
    /// Line of the program.
    pub program: u32,
    /// Its text.
    pub block: String,
    /// Line of the source; 0 for none.
    pub source: u32,
}

/// A text of a job.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Text {
    /// Name of its file.
    pub file: String,
    /// How many lines it has.
    pub lines: u32,
    /// Its size.
    pub bytes: u64,
}

/// The machine of a job.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct JobMachine {
    /// As it was asked for.
    pub name: String,
    /// What a person calls it.
    pub title: String,
    /// What it is.
    pub kind: MachineKind,
    /// Its dialect, for colours.
    pub dialect: String,
    /// Its axes, in the order of [`Place::axes`].
    pub axes: Vec<Axis>,
    /// The files that it is made of, as far as its templates stand in them.
    pub files: Vec<Text>,
    /// What carries what, and the bodies that are drawn.
    #[cfg_attr(test, ts(type = "Linkage"))]
    pub linkage: Linkage,
}

/// An axis of a machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Axis {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: AxisKind,
    /// `mm` or `degrees`.
    pub unit: &'static str,
    /// The lower end of its travel; null where it is not known, or positions do not count from the zero of the machine.
    pub low: Option<f64>,
    /// The upper end.
    pub high: Option<f64>,
}

/// What an axis is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum AxisKind {
    /// Straight.
    Linear,
    /// It turns.
    Rotary,
    /// Of an arm.
    Joint,
    /// On which an arm stands.
    Rail,
}

/// What there is of the moves.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct WalkAbout {
    /// How many there are.
    pub moves: u32,
    /// How many were left out, because there are too many.
    pub left_out: u32,
    /// How many chunks of 4,096 moves.
    pub chunks: u32,
    /// The levels of detail, the exact one first.
    pub levels: Vec<Level>,
    /// The box of all that is drawn, mm: low and high.
    pub r#box: Option<[[f64; 3]; 2]>,
    /// How long all of it takes, s.
    pub time_s: f64,
    /// The first 255 in the order of their first use: vertices name them by their place, and by 255 one that is not listed or not known.
    pub tools: Vec<ToolUse>,
    /// The operations of the source.
    pub operations: Vec<Operation>,
    /// What the numbers of kinds mean.
    pub kinds: Vec<&'static str>,
    /// How many bytes the row of a move has: 20, or 40 where any tool leans.
    pub row: u32,
    /// The largest deviation of a tip from the source, mm; null where nothing was compared.
    pub deviation: Option<f64>,
    /// The first thousand cuts in which a rotary axis turns by more than 30 degrees.
    pub jumps: Vec<Jump>,
    /// How many there are.
    pub jumps_in_all: u32,
    /// The first thousand excursions: where the tool leaves the cut and comes back to it.
    pub excursions: Vec<Excursion>,
    /// How many there are.
    pub excursions_in_all: u32,
    /// The last move before the first mismatch.
    pub mismatch: Option<u32>,
}

/// A cut in which a rotary axis turns far.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Jump {
    /// Its place in `machine.axes`.
    pub axis: u32,
    /// The move.
    pub r#move: u32,
    /// When that begins, s.
    pub time_s: f64,
    /// Where the axis is before it, degrees.
    pub from: f64,
    /// And behind it.
    pub to: f64,
}

/// Where the tool leaves the cut and comes back to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Excursion {
    /// Its first move.
    pub r#move: u32,
    /// When that begins, s.
    pub time_s: f64,
    /// How far the tool is lifted along its axis, mm; 0 where it goes home instead.
    pub lift_mm: f64,
}

/// A level of detail.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Level {
    /// How far its lines may be from the exact ones, mm.
    pub error: f64,
    /// How many vertices it has.
    pub vertices: u64,
}

/// A tool, from its first use on.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ToolUse {
    /// Place in the magazine.
    pub number: u32,
    /// Its name; empty for none.
    pub name: String,
    /// mm.
    pub diameter: Option<f64>,
    /// Corner radius, mm.
    pub corner: Option<f64>,
    /// From the gauge line to the tip, mm.
    pub length: Option<f64>,
    /// Whether its side or end leans.
    pub tapered: bool,
    /// How wide it cuts where it goes deepest, mm, where that is known: a board says it.
    pub width: Option<f64>,
    /// The first move with it.
    pub r#move: u32,
    /// When that begins, s.
    pub time_s: f64,
}

impl ToolUse {
    /// A tool that is first used in a move.
    pub fn new(tool: &program::Tool, first: u32, time_s: f64) -> ToolUse {
        ToolUse {
            number: tool.number,
            name: tool.name.clone(),
            diameter: tool.diameter,
            corner: tool.corner_radius,
            length: tool.length,
            tapered: tool.tapered,
            width: None,
            r#move: first,
            time_s,
        }
    }

    /// Adds what the source knows of the same tool, which the control calls by its number or, where it does so, by its name.
    pub fn know(&mut self, tool: &program::Tool) {
        let (number, name) = (self.number, self.name.clone());
        if !proof::same_tool(tool, &program::Tool { number, name, ..program::Tool::default() }) {
            return;
        }
        if self.number == 0 {
            self.number = tool.number;
        }
        if self.name.is_empty() {
            self.name.clone_from(&tool.name);
        }
        self.diameter = self.diameter.or(tool.diameter);
        self.corner = self.corner.or(tool.corner_radius);
        self.length = self.length.or(tool.length);
        self.tapered |= tool.tapered;
    }
}

/// An operation, from its first move on.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Operation {
    /// Its name.
    pub name: String,
    /// Its first move.
    pub r#move: u32,
    /// When that begins, s.
    pub time_s: f64,
}

/// `text { revision, of, file, from, to }`: lines `from` up to, not including, `to`, from 1. Answered with the array `text`, each line ended by LF.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct TextParams {
    /// Of the job.
    pub revision: u64,
    /// Which text.
    pub of: Of,
    /// A called file of the program, or a file of the machine; null for the program and the machine's own.
    #[serde(default)]
    pub file: Option<String>,
    /// First line.
    pub from: u32,
    /// The line behind the last one.
    pub to: u32,
}

/// What was answered of a text.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct TextAbout {
    /// How many lines the whole text has.
    pub lines: u32,
    /// Its size.
    pub bytes: u64,
    /// The first line answered.
    pub from: u32,
    /// The line behind the last one answered: fewer than asked for where they are large.
    pub to: u32,
    /// How many of them are longer than 2,000 characters, and cut.
    pub cut: u32,
}

/// `search { revision, of, file, text, from }`: the next line that has a text in it.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct SearchParams {
    /// Of the job.
    pub revision: u64,
    /// Which text.
    pub of: Of,
    /// As in `text`.
    #[serde(default)]
    pub file: Option<String>,
    /// What is looked for, whatever its capitals.
    pub text: String,
    /// From which line on; behind the last line it goes on at the first.
    pub from: u32,
}

/// Where a text was found.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Found {
    /// The line; null where it is nowhere.
    pub line: Option<u32>,
    /// The column, characters from 1.
    pub column: Option<u32>,
}

/// By what a place is looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum By {
    /// Seconds from the start.
    Time,
    /// Number of a move, from 0: the place is at its end.
    Move,
    /// Line of the program, from 1: its first move, or that of the next line that moves.
    Block,
    /// Line of the source, the same.
    Source,
}

/// `place { revision, by, value, file }`.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct PlaceParams {
    /// Of the job.
    pub revision: u64,
    /// By what.
    pub by: By,
    /// Seconds, or the number of a move or of a line.
    pub value: f64,
    /// The called file of a block.
    #[serde(default)]
    pub file: Option<String>,
}

/// `moves { revision, by, value, file }`: which moves a line makes.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct MovesParams {
    /// Of the job.
    pub revision: u64,
    /// `block` or `source`.
    pub by: By,
    /// The line.
    pub value: u32,
    /// The called file of a block.
    #[serde(default)]
    pub file: Option<String>,
}

/// Ranges of moves: first, and behind the last; the first thousand.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Moves {
    /// The ranges, in their order.
    pub ranges: Vec<[u32; 2]>,
}

/// One place: at once a time, a move, a block, a line of the source and a template.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Place {
    /// Seconds from the start.
    pub time_s: f64,
    /// The move, from 0.
    pub r#move: u32,
    /// How much of it is done, 0 to 1.
    pub part: f64,
    /// How it goes: one of `walk.kinds`.
    pub kind: &'static str,
    /// What is marked of it.
    pub marks: u8,
    /// The block that makes it.
    pub block: Line,
    /// All moves of that block, as in [`Moves`].
    pub block_moves: Vec<[u32; 2]>,
    /// The record that it makes.
    pub source: Option<Line>,
    /// All moves of that record's line, as in [`Moves`]; where there is none, this move.
    pub source_moves: Vec<[u32; 2]>,
    /// All blocks that the record's line has become, the first ten thousand.
    pub blocks: Vec<Blocks>,
    /// The template that wrote the block.
    pub template: Option<Template>,
    /// Place of its tool in `walk.tools`.
    pub tool: Option<u32>,
    /// The tip, work frame, mm.
    pub tip: [Option<f64>; 3],
    /// The tool axis, work frame.
    pub axis: [Option<f64>; 3],
    /// Positions of the axes, in the order of `machine.axes`.
    pub axes: Vec<Option<f64>>,
    /// The feed.
    pub feed: Option<FeedAbout>,
    /// The spindle.
    pub spindle: Option<SpindleAbout>,
    /// Coolant: `off`, `flood`, `mist`, `flood and mist`, `through`.
    pub coolant: Option<&'static str>,
    /// Compensation of the tool's radius: `off`, `left`, `right`.
    pub compensation: Option<&'static str>,
    /// The hole cycle that is on; null for none.
    pub cycle: Option<&'static str>,
    /// The work offset, as `G54` counts them; null where it is not known.
    pub work_offset: Option<u32>,
}

/// Blocks of a file.
#[derive(Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Blocks {
    /// The called file that they stand in; null for the program itself.
    pub file: Option<String>,
    /// Their lines as ranges: first, and behind the last.
    pub ranges: Vec<[u32; 2]>,
}

impl Blocks {
    /// Of lines that go up.
    pub fn of(file: Option<&str>, lines: impl IntoIterator<Item = u32>) -> Blocks {
        let mut ranges: Vec<[u32; 2]> = Vec::new();
        for line in lines {
            match ranges.last_mut() {
                Some([_, behind]) if *behind == line => *behind += 1,
                _ => ranges.push([line, line + 1]),
            }
        }
        Blocks { file: file.map(str::to_owned), ranges }
    }
}

/// A line of a text.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Line {
    /// Name of the file; null for the program or source itself.
    pub file: Option<String>,
    /// From 1.
    pub line: u32,
    /// Its text, up to 2,000 characters.
    pub text: String,
}

/// A template of a machine file.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Template {
    /// Its name: a key of `[blocks]`.
    pub name: String,
    /// The file that it stands in; null where it is built in.
    pub file: Option<String>,
    /// Line of that file at which it begins; 0 where it is built in.
    pub line: u32,
    /// Its text.
    pub text: String,
}

/// A feed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct FeedAbout {
    /// How much.
    pub value: f64,
    /// `mm/min`, `mm/turn`, or `1/min` for moves a minute.
    pub unit: &'static str,
}

/// A spindle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SpindleAbout {
    /// `off`, `clockwise`, `counter-clockwise`, `on`.
    pub turns: &'static str,
    /// Turns a minute.
    pub speed: Option<f64>,
}

/// `plot { revision, what, from, to, pixels }`: answered with the arrays `least` and `most` (f32, one for each pixel; NaN: nothing known).
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct PlotParams {
    /// Of the job.
    pub revision: u64,
    /// Name of an axis, `feed` (mm/min), or `deviation` of the tip from the source (mm).
    pub what: String,
    /// First time, s.
    pub from: f64,
    /// Last time, s.
    pub to: f64,
    /// How many pixels, up to 10,000.
    pub pixels: u32,
}

/// `changes { revision }`: which files a job was made of are others now; without a revision, those that the last work of this page was made of
/// that gave no job.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct ChangesParams {
    /// Of the job.
    pub revision: Option<u64>,
}

/// What has become of the files that a work was made of.
#[derive(Debug, Default, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Changes {
    /// Those that are others now.
    pub files: Vec<ChangedFile>,
    /// The same while they stay as they are now; empty where there are none.
    pub state: String,
}

/// A file that is another one now, or a folder with other files.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ChangedFile {
    /// Its path in the folder.
    pub path: String,
    /// What it was read as.
    pub of: Of,
    /// It is not there any more, or cannot be read.
    pub is_gone: bool,
}

/// `save { revision, path, replace }`: saves program and report, both or neither; what is not proven, or whose files have changed since, is refused. Of a board all programs
/// and their report are saved, all or none.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct SaveParams {
    /// Of the job.
    pub revision: u64,
    /// Where, in the folder: the file, or for a board the folder of its programs.
    pub path: String,
    /// Whether it may take the place of a file that is there.
    pub replace: bool,
}

/// What was saved.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Saved {
    /// Paths in the folder, the program first.
    pub files: Vec<String>,
    /// Reports beside them that are of other programs now, and parts that nothing calls any more.
    pub findings: Vec<Finding>,
}

/// A field of the form that is made of the command's own arguments.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Field {
    /// The option, without dashes.
    pub name: String,
    /// What it means.
    pub help: String,
    /// What its value is called; null for a switch.
    pub value: Option<String>,
    /// The values that it takes, each with its meaning; empty where it takes any.
    pub values: Vec<(String, String)>,
    /// Its value where nothing is given.
    pub default: Option<String>,
    /// Under which head it stands.
    pub group: Option<String>,
    /// Whether it may be given several times.
    pub repeats: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write as _;
    use std::path::Path;
    use ts_rs::Config;

    /// What a machine's linkage is: `machine::linkage` has what each field means.
    const LINKAGE: &str = r#"
/**
 * What carries what, for drawing a machine.
 */
export type Linkage = {
axes: Array<{ name: string, unit: string, low: number | null, high: number | null, }>,
links: Array<{ name: string, on: number | null, kind: "fixed" | "slide" | "turn", direction: [number, number, number], point: [number, number, number], zero: number, terms: Array<[number, number]>, }>,
bodies: Array<{ name: string, on: number, low: [number, number, number], high: [number, number, number], is_given: boolean, }>,
tool: { on: number, frame: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]], },
part: { on: number, frame: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]], }, };
"#;

    /// That type is written by hand: its fields are those that are sent.
    #[test]
    fn the_type_of_a_linkage_has_the_fields_that_are_sent() {
        let machine = machine::load("fanuc-table-bc").unwrap();
        let sent = serde_json::json!(Linkage::of(&machine));
        let mut fields = Vec::new();
        for key in sent.as_object().unwrap().keys() {
            fields.push(key.clone());
            let inner = sent[key].get(0).unwrap_or(&sent[key]);
            fields.extend(inner.as_object().unwrap().keys().cloned());
        }
        for field in &fields {
            assert!(LINKAGE.contains(&format!("{field}: ")), "{field}");
        }
        let declared = LINKAGE.matches(": ").count();
        assert_eq!(declared, fields.len(), "{fields:?}");
    }

    /// The types as TypeScript, each with its sentence.
    fn types() -> String {
        let config = Config::new().with_large_int("number");
        let mut text = String::from(
            "// Written by `TOOLPOST_DOCS=write cargo test -p toolpost-studio types`: the types of crates/studio/src/ask.rs.\n",
        );
        macro_rules! declare {
            ($($type:ty),* $(,)?) => { $(
                let docs = <$type as TS>::docs().unwrap_or_default();
                let _ = write!(text, "\n{docs}export {}\n", <$type as TS>::decl(&config));
            )* };
        }
        declare!(
            Hello,
            Cancel,
            Done<Nothing>,
            Stopped,
            Stop,
            Verdict,
            Progress,
            Walked,
            Finding,
            Severity,
            Opened,
            Limits,
            FileOrUpload,
            Given,
            Command,
            CommandParams,
            KindsParams,
            FolderParams,
            Listing,
            Entry,
            EntryKind,
            MachineEntry,
            MachineKind,
            Of,
            Draft,
            DraftParams,
            DraftName,
            Nothing,
            Uploaded,
            PostParams,
            ProveParams,
            Job,
            JobParams,
            GlassBlock,
            BoardAbout,
            BoardProgram,
            LeftOut,
            BoardPicture,
            BoardArea,
            BoardAreaKind,
            BoardPlace,
            Turning,
            Mismatch,
            Text,
            JobMachine,
            Axis,
            AxisKind,
            WalkAbout,
            Jump,
            Excursion,
            Level,
            ToolUse,
            Operation,
            TextParams,
            TextAbout,
            SearchParams,
            Found,
            By,
            PlaceParams,
            MovesParams,
            Moves,
            Place,
            Blocks,
            Line,
            Template,
            FeedAbout,
            SpindleAbout,
            PlotParams,
            ChangesParams,
            Changes,
            ChangedFile,
            SaveParams,
            Saved,
            Field,
        );
        text + LINKAGE
    }

    #[test]
    fn the_types_of_the_page_are_those_of_the_server() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studio/src/protocol/types.ts");
        let types = types();
        if std::env::var_os("TOOLPOST_DOCS").is_some() {
            std::fs::write(&path, &types).unwrap();
        }
        let kept = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(kept == types, "run `TOOLPOST_DOCS=write cargo test -p toolpost-studio types`");
    }
}
