// Written by `TOOLPOST_DOCS=write cargo test -p toolpost-studio types`: the types of crates/studio/src/ask.rs.

/**
 * The first frame of a page.
 */
export type Hello = { 
/**
 * The token of the link.
 */
token: string, };

/**
 * Ends the work of an ask.
 */
export type Cancel = { 
/**
 * Its id.
 */
cancel: number, };

/**
 * What an ask was for.
 */
export type Done<T> = { 
/**
 * Its id.
 */
id: number, 
/**
 * The answer.
 */
done: T, };

/**
 * An ask that has no answer.
 */
export type Stopped = { 
/**
 * Its id.
 */
id: number, 
/**
 * How it ended, and why.
 */
stop: Stop, };

/**
 * How work without a result ended, and why.
 */
export type Stop = { 
/**
 * How.
 */
verdict: Verdict, 
/**
 * Why.
 */
findings: Array<Finding>, };

/**
 * How work ended.
 */
export type Verdict = "done" | "partly" | "failed" | "invalid" | "cancelled";

/**
 * How far an ask has come.
 */
export type Progress = { 
/**
 * `progress`.
 */
event: "progress", 
/**
 * Of which ask.
 */
id: number, 
/**
 * What is being done: `reading`, `writing`, `proving`.
 */
step: string, 
/**
 * How much of it is done, from 0 to 1, where that is known.
 */
part: number | null, };

/**
 * What the proof that runs has walked since the last such event: the next chunks of moves, thinned so that all of them have about 250,000
 * vertices. The arrays are `index` and `vertices` (u8), as [`crate::geometry`] describes them; an entry's vertices of level 0 are those
 * that are sent. Nothing of it is proven.
 */
export type Walked = { 
/**
 * `walked`.
 */
event: "walked", 
/**
 * Of which ask.
 */
id: number, 
/**
 * Name of the program's file.
 */
file: string, 
/**
 * Number of the first chunk.
 */
chunk: number, 
/**
 * How many moves there are so far.
 */
moves: number, 
/**
 * When the last one of them is over, s.
 */
time_s: number, 
/**
 * What the numbers of kinds mean.
 */
kinds: Array<string>, };

/**
 * A finding, as `--json` prints it.
 */
export type Finding = { 
/**
 * How bad it is.
 */
severity: Severity, 
/**
 * The rule that it is of; `toolpost explain RULE` says more.
 */
rule: string, 
/**
 * What is wrong, with values and units.
 */
message: string, 
/**
 * The way out.
 */
help: string, 
/**
 * Name of the file; empty where there is none.
 */
file: string, 
/**
 * Which text that file is, where it is one of the job's.
 */
of: Of | null, 
/**
 * Line from 1; 0 where it is about the whole.
 */
line: number, 
/**
 * Column from 1 in characters; 0 where it is about the whole line.
 */
column: number, 
/**
 * How many characters it covers.
 */
width: number, 
/**
 * The text of the line, and a mark below it; empty where it is not at hand.
 */
excerpt: string, 
/**
 * How often it occurred.
 */
count: number, 
/**
 * Lines of the first few like it.
 */
lines: Array<number>, 
/**
 * Lines of all others that it stands for, the first ten thousand.
 */
places: Array<number>, };

/**
 * How bad a finding is.
 */
export type Severity = "warning" | "error";

/**
 * `open {}`: what there is.
 */
export type Opened = { 
/**
 * Of the command.
 */
version: string, 
/**
 * Name of the folder.
 */
folder: string, 
/**
 * What the command line named.
 */
source: Given | null, 
/**
 * The same.
 */
machine: string | null, 
/**
 * Drafts that are kept.
 */
drafts: Array<Draft>, 
/**
 * What the server takes.
 */
limits: Limits, };

/**
 * What the server takes.
 */
export type Limits = { 
/**
 * The largest upload, bytes.
 */
upload: number, 
/**
 * The largest frame, bytes.
 */
frame: number, 
/**
 * How many jobs are open at the same time; the older ones go.
 */
jobs: number, 
/**
 * How many sockets are open at the same time.
 */
sockets: number, };

/**
 * A file of the folder, or what was uploaded.
 */
export type FileOrUpload = { "file": string } | { "upload": string };

/**
 * What programs are made of: a file, or a board of several.
 */
export type Given = { "file": string } | { "upload": string } | { "folder": string } | { "uploads": Array<string> };

/**
 * What programs are written by: that says whose options a form has.
 */
export type Command = "post" | "wire" | "pcb" | "glass";

/**
 * `command { source, machine }`: answers the [`Command`] that writes programs of a source for a machine.
 */
export type CommandParams = { 
/**
 * What is made.
 */
source: Given, 
/**
 * The machine; null where none is chosen yet.
 */
machine: string | null, };

/**
 * `kinds { source }`: answers the [`MachineKind`]s of which a machine can take the source.
 */
export type KindsParams = { 
/**
 * What is made.
 */
source: Given, };

/**
 * `folder { path }`.
 */
export type FolderParams = { 
/**
 * Below the named folder; empty for itself.
 */
path: string, };

/**
 * What is in a folder.
 */
export type Listing = { 
/**
 * Folders first, in the order of their names.
 */
entries: Array<Entry>, 
/**
 * Whether these are all.
 */
is_whole: boolean, };

/**
 * An entry of a folder.
 */
export type Entry = { 
/**
 * Its name.
 */
name: string, 
/**
 * Its path below the named folder.
 */
path: string, 
/**
 * What it is.
 */
kind: EntryKind, 
/**
 * Size of a file.
 */
bytes: number | null, 
/**
 * When it was written last, s since 1970 (UTC); 0 where the system does not say.
 */
written: number, };

/**
 * What an entry is.
 */
export type EntryKind = "folder" | "file";

/**
 * `machines {}`: a machine that can be picked.
 */
export type MachineEntry = { 
/**
 * A name of the library, or the path of a file of the folder.
 */
name: string, 
/**
 * What a person calls it.
 */
title: string, 
/**
 * What it is.
 */
kind: MachineKind, 
/**
 * The control that it extends.
 */
control: string, 
/**
 * Names of its axes.
 */
axes: Array<string>, 
/**
 * Whether it is a file of the folder.
 */
is_own: boolean, 
/**
 * What is wrong with its file.
 */
findings: Array<Finding>, };

/**
 * What a machine is.
 */
export type MachineKind = "mill" | "wire" | "robot" | "glass";

/**
 * One of the texts of a job.
 */
export type Of = "program" | "source" | "machine";

/**
 * An edit that is kept, and nowhere saved.
 */
export type Draft = { 
/**
 * Its name.
 */
name: string, 
/**
 * What the page has said of it (source, machine, options, file).
 */
of: unknown, 
/**
 * Size of its text.
 */
bytes: number, };

/**
 * `draft { name, of }` with the array `text`: keeps it.
 */
export type DraftParams = { 
/**
 * Up to 100 letters, digits, `-`, `_` and `.`.
 */
name: string, 
/**
 * What the page wants to know of it later.
 */
of: unknown, };

/**
 * `draft_text { name }`: answers the array `text`; `drop_draft { name }`.
 */
export type DraftName = { 
/**
 * Its name.
 */
name: string, };

/**
 * An answer that says no more than that it is done.
 */
export type Nothing = Record<symbol, never>;

/**
 * `PUT /upload/NAME` is answered with it.
 */
export type Uploaded = { 
/**
 * Its id: a digest of its name and bytes.
 */
upload: string, 
/**
 * Its name.
 */
name: string, 
/**
 * Its size.
 */
bytes: number, };

/**
 * `post { source, machine, options }`: writes the program and proves it. Answered by a [`Job`], of a board by that of its first program; a newer `post` or `prove` of the same page
 * ends an older one.
 */
export type PostParams = { 
/**
 * The toolpath, or the board.
 */
source: Given, 
/**
 * A name of the library, or the path of a file of the folder.
 */
machine: string, 
/**
 * Options as the command line has them, without dashes: `[["from", "fanuc-31i"], ["strict", ""]]`.
 */
options: Array<[string, string]>, 
/**
 * Name of the program's file; null: that of the source with the machine's ending.
 */
file: string | null, };

/**
 * `prove { source, machine, options, program }`, or with the array `text` in place of `program`: proves a program, also one that was edited by
 * hand. With `revision` it is an edit of that job's program: its other files are those of the job, and none is looked for in a folder. Answered by a [`Job`].
 */
export type ProveParams = { 
/**
 * The toolpath, or the board.
 */
source: Given, 
/**
 * As in `post`.
 */
machine: string, 
/**
 * As in `post`.
 */
options: Array<[string, string]>, 
/**
 * As in `post`: what a text is called that no file has.
 */
file: string | null, 
/**
 * The program, where it is no edited text.
 */
program: FileOrUpload | null, 
/**
 * The job whose program was edited, where that is still open.
 */
revision: number | null, 
/**
 * The files of its program that were edited, null for the program itself: they stand one behind the other in `text`, each with so many
 * bytes. Left out: `text` is the program itself.
 */
files?: Array<[string | null, number]>, };

/**
 * A program with its verdict and its moves.
 */
export type Job = { 
/**
 * By which all else is asked for.
 */
revision: number, 
/**
 * How it ended.
 */
verdict: Verdict, 
/**
 * What is reported of it: head (empty for a further line of the one before) and text.
 */
rows: Array<[string, string]>, 
/**
 * What is wrong with it, or worth knowing.
 */
findings: Array<Finding>, 
/**
 * The program; null where none was written.
 */
program: Text | null, 
/**
 * The files that it calls.
 */
parts: Array<Text>, 
/**
 * The source.
 */
source: Text, 
/**
 * More files of it, as those of a board.
 */
sources: Array<Text>, 
/**
 * The machine.
 */
machine: JobMachine, 
/**
 * The moves that the proof has walked.
 */
walk: WalkAbout, 
/**
 * Where a failed proof first differs.
 */
mismatch: Mismatch | null, 
/**
 * All programs of the board that it is one of; null where it is of no board.
 */
board: BoardAbout | null, 
/**
 * The blocks of glass that it fires in, in the frame of the first; none of another machine.
 */
blocks: Array<GlassBlock>, };

/**
 * `job { revision }`: answers the [`Job`] again, as another program of a board.
 */
export type JobParams = { 
/**
 * Of the job.
 */
revision: number, };

/**
 * A block of glass.
 */
export type GlassBlock = { 
/**
 * A corner of it, mm.
 */
corner: [number, number, number], 
/**
 * Its sides from there, mm.
 */
sides: [[number, number, number], [number, number, number], [number, number, number]], };

/**
 * A board, and all that is made of it.
 */
export type BoardAbout = { 
/**
 * What it is called.
 */
name: string, 
/**
 * `done`, or `partly` where a program is left out.
 */
verdict: Verdict, 
/**
 * What is reported of all programs together.
 */
rows: Array<[string, string]>, 
/**
 * The programs, in the order in which they are run.
 */
programs: Array<BoardProgram>, 
/**
 * Those that could not be made.
 */
left_out: Array<LeftOut>, };

/**
 * A program of a board.
 */
export type BoardProgram = { 
/**
 * What it does: `front`, `drill`.
 */
name: string, 
/**
 * Its file.
 */
file: string, 
/**
 * By which its job is asked for.
 */
revision: number, 
/**
 * How many findings it has of its own.
 */
findings: number, };

/**
 * A program of a board that could not be made.
 */
export type LeftOut = { 
/**
 * Its file.
 */
file: string, 
/**
 * Why.
 */
findings: Array<Finding>, };

/**
 * `board { revision }`: what the board is drawn with below the cuts of a program, the lowest first. Answered with the arrays `areas` (f32, six for
 * each trapezoid between two lines along X: the lower and the upper Y, left and right X at the lower, left and right X at the upper one),
 * `holes` (f32, five for each stroke with round ends: X, Y, X, Y, width) and `tabs` (f32, four for each line: X, Y, X, Y), all mm.
 */
export type BoardPicture = { 
/**
 * What the trapezoids are, in their order.
 */
areas: Array<BoardArea>, 
/**
 * Places to look at: gaps that are not cut, copper that is taken, the worst first.
 */
places: Array<BoardPlace>, 
/**
 * The line about which the board is turned over, where it is.
 */
turning: Turning | null, 
/**
 * How wide the only tool cuts, mm, where the program has one: a control that changes no tools does not name it.
 */
width: number | null, 
/**
 * How far the areas may be from what they are of, mm.
 */
error: number, 
/**
 * Whether these are all areas.
 */
is_whole: boolean, };

/**
 * An area of a board.
 */
export type BoardArea = { 
/**
 * What it is.
 */
kind: BoardAreaKind, 
/**
 * The name of its net, where a file says it.
 */
net: string | null, 
/**
 * The number of its conductor: islands of one net are one.
 */
conductor: number, 
/**
 * How many trapezoids it has.
 */
count: number, };

/**
 * What an area of a board is.
 */
export type BoardAreaKind = "board" | "copper" | "rest";

/**
 * A place of a board to be looked at.
 */
export type BoardPlace = { 
/**
 * mm.
 */
x: number, 
/**
 * mm.
 */
y: number, 
/**
 * `joined`, `slot`, `bitten`, `severed` or `not-made`.
 */
kind: string, 
/**
 * What is there.
 */
what: string, };

/**
 * The line about which a board is turned over.
 */
export type Turning = { 
/**
 * The axis that it runs along: `X` or `Y`.
 */
along: string, 
/**
 * Where it is on the other axis, mm.
 */
at: number, };

/**
 * The first mismatch, side by side.
 */
export type Mismatch = { 
/**
 * The called file that the block stands in; null for the program itself.
 */
file: string | null, 
/**
 * Line of the program.
 */
program: number, 
/**
 * Its text.
 */
block: string, 
/**
 * Line of the source; 0 for none.
 */
source: number, };

/**
 * A text of a job.
 */
export type Text = { 
/**
 * Name of its file.
 */
file: string, 
/**
 * How many lines it has.
 */
lines: number, 
/**
 * Its size.
 */
bytes: number, };

/**
 * The machine of a job.
 */
export type JobMachine = { 
/**
 * As it was asked for.
 */
name: string, 
/**
 * What a person calls it.
 */
title: string, 
/**
 * What it is.
 */
kind: MachineKind, 
/**
 * Its dialect, for colours.
 */
dialect: string, 
/**
 * Its axes, in the order of [`Place::axes`].
 */
axes: Array<Axis>, 
/**
 * The files that it is made of, as far as its templates stand in them.
 */
files: Array<Text>, 
/**
 * What carries what, and the bodies that are drawn.
 */
linkage: Linkage, };

/**
 * An axis of a machine.
 */
export type Axis = { 
/**
 * Its name.
 */
name: string, 
/**
 * What it is.
 */
kind: AxisKind, 
/**
 * `mm` or `degrees`.
 */
unit: string, 
/**
 * The lower end of its travel; null where it is not known, or positions do not count from the zero of the machine.
 */
low: number | null, 
/**
 * The upper end.
 */
high: number | null, };

/**
 * What an axis is.
 */
export type AxisKind = "linear" | "rotary" | "joint" | "rail";

/**
 * What there is of the moves.
 */
export type WalkAbout = { 
/**
 * How many there are.
 */
moves: number, 
/**
 * How many were left out, because there are too many.
 */
left_out: number, 
/**
 * How many chunks of 4,096 moves.
 */
chunks: number, 
/**
 * The levels of detail, the exact one first.
 */
levels: Array<Level>, 
/**
 * The box of all that is drawn, mm: low and high.
 */
box: [[number, number, number], [number, number, number]] | null, 
/**
 * How long all of it takes, s.
 */
time_s: number, 
/**
 * The first 255 in the order of their first use: vertices name them by their place, and by 255 one that is not listed or not known.
 */
tools: Array<ToolUse>, 
/**
 * The operations of the source.
 */
operations: Array<Operation>, 
/**
 * What the numbers of kinds mean.
 */
kinds: Array<string>, 
/**
 * How many bytes the row of a move has: 20, or 40 where any tool leans.
 */
row: number, 
/**
 * The largest deviation of a tip from the source, mm; null where nothing was compared.
 */
deviation: number | null, 
/**
 * The first thousand cuts in which a rotary axis turns by more than 30 degrees.
 */
jumps: Array<Jump>, 
/**
 * How many there are.
 */
jumps_in_all: number, 
/**
 * The first thousand excursions: where the tool leaves the cut and comes back to it.
 */
excursions: Array<Excursion>, 
/**
 * How many there are.
 */
excursions_in_all: number, 
/**
 * The last move before the first mismatch.
 */
mismatch: number | null, };

/**
 * A cut in which a rotary axis turns far.
 */
export type Jump = { 
/**
 * Its place in `machine.axes`.
 */
axis: number, 
/**
 * The move.
 */
move: number, 
/**
 * When that begins, s.
 */
time_s: number, 
/**
 * Where the axis is before it, degrees.
 */
from: number, 
/**
 * And behind it.
 */
to: number, };

/**
 * Where the tool leaves the cut and comes back to it.
 */
export type Excursion = { 
/**
 * Its first move.
 */
move: number, 
/**
 * When that begins, s.
 */
time_s: number, 
/**
 * How far the tool is lifted along its axis, mm; 0 where it goes home instead.
 */
lift_mm: number, };

/**
 * A level of detail.
 */
export type Level = { 
/**
 * How far its lines may be from the exact ones, mm.
 */
error: number, 
/**
 * How many vertices it has.
 */
vertices: number, };

/**
 * A tool, from its first use on.
 */
export type ToolUse = { 
/**
 * Place in the magazine.
 */
number: number, 
/**
 * Its name; empty for none.
 */
name: string, 
/**
 * mm.
 */
diameter: number | null, 
/**
 * Corner radius, mm.
 */
corner: number | null, 
/**
 * From the gauge line to the tip, mm.
 */
length: number | null, 
/**
 * Whether its side or end leans.
 */
tapered: boolean, 
/**
 * How wide it cuts where it goes deepest, mm, where that is known: a board says it.
 */
width: number | null, 
/**
 * The first move with it.
 */
move: number, 
/**
 * When that begins, s.
 */
time_s: number, };

/**
 * An operation, from its first move on.
 */
export type Operation = { 
/**
 * Its name.
 */
name: string, 
/**
 * Its first move.
 */
move: number, 
/**
 * When that begins, s.
 */
time_s: number, };

/**
 * `text { revision, of, file, from, to }`: lines `from` up to, not including, `to`, from 1. Answered with the array `text`, each line ended by LF.
 */
export type TextParams = { 
/**
 * Of the job.
 */
revision: number, 
/**
 * Which text.
 */
of: Of, 
/**
 * A called file of the program, or a file of the machine; null for the program and the machine's own.
 */
file: string | null, 
/**
 * First line.
 */
from: number, 
/**
 * The line behind the last one.
 */
to: number, };

/**
 * What was answered of a text.
 */
export type TextAbout = { 
/**
 * How many lines the whole text has.
 */
lines: number, 
/**
 * Its size.
 */
bytes: number, 
/**
 * The first line answered.
 */
from: number, 
/**
 * The line behind the last one answered: fewer than asked for where they are large.
 */
to: number, 
/**
 * How many of them are longer than 2,000 characters, and cut.
 */
cut: number, };

/**
 * `search { revision, of, file, text, from }`: the next line that has a text in it.
 */
export type SearchParams = { 
/**
 * Of the job.
 */
revision: number, 
/**
 * Which text.
 */
of: Of, 
/**
 * As in `text`.
 */
file: string | null, 
/**
 * What is looked for, whatever its capitals.
 */
text: string, 
/**
 * From which line on; behind the last line it goes on at the first.
 */
from: number, };

/**
 * Where a text was found.
 */
export type Found = { 
/**
 * The line; null where it is nowhere.
 */
line: number | null, 
/**
 * The column, characters from 1.
 */
column: number | null, };

/**
 * By what a place is looked up.
 */
export type By = "time" | "move" | "block" | "source";

/**
 * `place { revision, by, value, file }`.
 */
export type PlaceParams = { 
/**
 * Of the job.
 */
revision: number, 
/**
 * By what.
 */
by: By, 
/**
 * Seconds, or the number of a move or of a line.
 */
value: number, 
/**
 * The called file of a block.
 */
file: string | null, };

/**
 * `moves { revision, by, value, file }`: which moves a line makes.
 */
export type MovesParams = { 
/**
 * Of the job.
 */
revision: number, 
/**
 * `block` or `source`.
 */
by: By, 
/**
 * The line.
 */
value: number, 
/**
 * The called file of a block.
 */
file: string | null, };

/**
 * Ranges of moves: first, and behind the last; the first thousand.
 */
export type Moves = { 
/**
 * The ranges, in their order.
 */
ranges: Array<[number, number]>, };

/**
 * One place: at once a time, a move, a block, a line of the source and a template.
 */
export type Place = { 
/**
 * Seconds from the start.
 */
time_s: number, 
/**
 * The move, from 0.
 */
move: number, 
/**
 * How much of it is done, 0 to 1.
 */
part: number, 
/**
 * How it goes: one of `walk.kinds`.
 */
kind: string, 
/**
 * What is marked of it.
 */
marks: number, 
/**
 * The block that makes it.
 */
block: Line, 
/**
 * All moves of that block, as in [`Moves`].
 */
block_moves: Array<[number, number]>, 
/**
 * The record that it makes.
 */
source: Line | null, 
/**
 * All moves of that record's line, as in [`Moves`]; where there is none, this move.
 */
source_moves: Array<[number, number]>, 
/**
 * All blocks that the record's line has become, the first ten thousand.
 */
blocks: Array<Blocks>, 
/**
 * The template that wrote the block.
 */
template: Template | null, 
/**
 * Place of its tool in `walk.tools`.
 */
tool: number | null, 
/**
 * The tip, work frame, mm.
 */
tip: [number | null, number | null, number | null], 
/**
 * The tool axis, work frame.
 */
axis: [number | null, number | null, number | null], 
/**
 * Positions of the axes, in the order of `machine.axes`.
 */
axes: Array<number | null>, 
/**
 * The feed.
 */
feed: FeedAbout | null, 
/**
 * The spindle.
 */
spindle: SpindleAbout | null, 
/**
 * Coolant: `off`, `flood`, `mist`, `flood and mist`, `through`.
 */
coolant: string | null, 
/**
 * Compensation of the tool's radius: `off`, `left`, `right`.
 */
compensation: string | null, 
/**
 * The hole cycle that is on; null for none.
 */
cycle: string | null, 
/**
 * The work offset, as `G54` counts them; null where it is not known.
 */
work_offset: number | null, };

/**
 * Blocks of a file.
 */
export type Blocks = { 
/**
 * The called file that they stand in; null for the program itself.
 */
file: string | null, 
/**
 * Their lines as ranges: first, and behind the last.
 */
ranges: Array<[number, number]>, };

/**
 * A line of a text.
 */
export type Line = { 
/**
 * Name of the file; null for the program or source itself.
 */
file: string | null, 
/**
 * From 1.
 */
line: number, 
/**
 * Its text, up to 2,000 characters.
 */
text: string, };

/**
 * A template of a machine file.
 */
export type Template = { 
/**
 * Its name: a key of `[blocks]`.
 */
name: string, 
/**
 * The file that it stands in; null where it is built in.
 */
file: string | null, 
/**
 * Line of that file at which it begins; 0 where it is built in.
 */
line: number, 
/**
 * Its text.
 */
text: string, };

/**
 * A feed.
 */
export type FeedAbout = { 
/**
 * How much.
 */
value: number, 
/**
 * `mm/min`, `mm/turn`, or `1/min` for moves a minute.
 */
unit: string, };

/**
 * A spindle.
 */
export type SpindleAbout = { 
/**
 * `off`, `clockwise`, `counter-clockwise`, `on`.
 */
turns: string, 
/**
 * Turns a minute.
 */
speed: number | null, };

/**
 * `plot { revision, what, from, to, pixels }`: answered with the arrays `least` and `most` (f32, one for each pixel; NaN: nothing known).
 */
export type PlotParams = { 
/**
 * Of the job.
 */
revision: number, 
/**
 * Name of an axis, `feed` (mm/min), or `deviation` of the tip from the source (mm).
 */
what: string, 
/**
 * First time, s.
 */
from: number, 
/**
 * Last time, s.
 */
to: number, 
/**
 * How many pixels, up to 10,000.
 */
pixels: number, };

/**
 * `changes { revision }`: which files a job was made of are others now; without a revision, those that the last work of this page was made of
 * that gave no job.
 */
export type ChangesParams = { 
/**
 * Of the job.
 */
revision: number | null, };

/**
 * What has become of the files that a work was made of.
 */
export type Changes = { 
/**
 * Those that are others now.
 */
files: Array<ChangedFile>, 
/**
 * The same while they stay as they are now; empty where there are none.
 */
state: string, };

/**
 * A file that is another one now, or a folder with other files.
 */
export type ChangedFile = { 
/**
 * Its path in the folder.
 */
path: string, 
/**
 * What it was read as.
 */
of: Of, 
/**
 * It is not there any more, or cannot be read.
 */
is_gone: boolean, };

/**
 * `save { revision, path, replace }`: saves program and report, both or neither; what is not proven, or whose files have changed since, is refused. Of a board all programs
 * and their report are saved, all or none.
 */
export type SaveParams = { 
/**
 * Of the job.
 */
revision: number, 
/**
 * Where, in the folder: the file, or for a board the folder of its programs.
 */
path: string, 
/**
 * Whether it may take the place of a file that is there.
 */
replace: boolean, };

/**
 * What was saved.
 */
export type Saved = { 
/**
 * Paths in the folder, the program first.
 */
files: Array<string>, 
/**
 * Reports beside them that are of other programs now, and parts that nothing calls any more.
 */
findings: Array<Finding>, };

/**
 * A field of the form that is made of the command's own arguments.
 */
export type Field = { 
/**
 * The option, without dashes.
 */
name: string, 
/**
 * What it means.
 */
help: string, 
/**
 * What its value is called; null for a switch.
 */
value: string | null, 
/**
 * The values that it takes, each with its meaning; empty where it takes any.
 */
values: Array<[string, string]>, 
/**
 * Its value where nothing is given.
 */
default: string | null, 
/**
 * Under which head it stands.
 */
group: string | null, 
/**
 * Whether it may be given several times.
 */
repeats: boolean, };

/**
 * What carries what, for drawing a machine.
 */
export type Linkage = {
axes: Array<{ name: string, unit: string, low: number | null, high: number | null, }>,
links: Array<{ name: string, on: number | null, kind: "fixed" | "slide" | "turn", direction: [number, number, number], point: [number, number, number], zero: number, terms: Array<[number, number]>, }>,
bodies: Array<{ name: string, on: number, low: [number, number, number], high: [number, number, number], is_given: boolean, }>,
tool: { on: number, frame: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]], },
part: { on: number, frame: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]], }, };
