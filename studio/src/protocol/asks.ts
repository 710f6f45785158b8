/** What is asked of the server, and what it answers: each ask with its params and its answer. */

/**
 * How work ended.
 */
export type Verdict = "done" | "partly" | "failed" | "invalid" | "cancelled";

/**
 * A finding, as `--json` prints it.
 */
export type Finding = { severity: Severity, rule: string, message: string, help: string, file: string, of: Of | null, line: number, column: number, width: number, excerpt: string, count: number, lines: Array<number>, };

/**
 * How bad a finding is.
 */
export type Severity = "warning" | "error";

/**
 * `open {}`: what there is.
 */
export type Opened = { version: string, folder: string, source: FileOrUpload | null, machine: string | null, drafts: Array<Draft>, limits: Limits, };

/**
 * What the server takes.
 */
export type Limits = { upload: number, frame: number, jobs: number, sockets: number, };

/**
 * A file of the folder, or what was uploaded.
 */
export type FileOrUpload = { "file": string } | { "upload": string };

/**
 * What is in a folder.
 */
export type Listing = { entries: Array<Entry>, is_whole: boolean, };

/**
 * An entry of a folder.
 */
export type Entry = { name: string, path: string, kind: EntryKind, bytes: number | null, };

/**
 * What an entry is.
 */
export type EntryKind = "folder" | "file";

/**
 * `machines {}`: a machine that can be picked.
 */
export type MachineEntry = { name: string, title: string, kind: MachineKind, control: string, axes: Array<string>, is_own: boolean, findings: Array<Finding>, };

/**
 * What a machine is.
 */
export type MachineKind = "mill" | "wire" | "robot";

/**
 * One of the texts of a job.
 */
export type Of = "program" | "source" | "machine";

/**
 * An edit that is kept, and nowhere saved.
 */
export type Draft = { name: string, of: unknown, bytes: number, };

/**
 * An answer that says no more than that it is done.
 */
export type Nothing = Record<string, never>;

/**
 * `post { source, machine, options }`: writes the program and proves it. Answered by a [`Job`]; a newer `post` or `prove` of the same page
 * ends an older one.
 */
export type PostParams = { source: FileOrUpload, machine: string, options?: Array<[string, string]>, file?: string | null, };

/**
 * `prove { source, machine, options, program }`, or with the array `text` in place of `program`: proves a program, also one that was edited by
 * hand. Answered by a [`Job`].
 */
export type ProveParams = { source: FileOrUpload, machine: string, options?: Array<[string, string]>, file?: string | null, program?: FileOrUpload | null, };

/**
 * A program with its verdict and its moves.
 */
export type Job = { revision: number, verdict: Verdict, rows: Array<[string, string]>, findings: Array<Finding>, program: Text | null, parts: Array<Text>, source: Text, machine: JobMachine, walk: WalkAbout, mismatch: Mismatch | null, };

/**
 * The first mismatch, side by side.
 */
export type Mismatch = { file: string | null, program: number, block: string, source: number, };

/**
 * A text of a job.
 */
export type Text = { file: string, lines: number, bytes: number, };

/**
 * The machine of a job.
 */
export type JobMachine = { name: string, title: string, kind: MachineKind, dialect: string, axes: Array<Axis>, files: Array<Text>, };

/**
 * An axis of a machine.
 */
export type Axis = { name: string, kind: AxisKind, unit: string, low: number | null, high: number | null, };

/**
 * What an axis is.
 */
export type AxisKind = "linear" | "rotary" | "joint" | "rail";

/**
 * What there is of the moves.
 */
export type WalkAbout = { moves: number, left_out: number, chunks: number, levels: Array<Level>, box: [[number, number, number], [number, number, number]] | null, time_s: number, tools: Array<ToolUse>, operations: Array<Operation>, kinds: Array<string>, row: number, mismatch: number | null, };

/**
 * A level of detail.
 */
export type Level = { error: number, vertices: number, };

/**
 * A tool, from its first use on.
 */
export type ToolUse = { number: number, name: string, diameter: number | null, corner: number | null, length: number | null, tapered: boolean, move: number, time_s: number, };

/**
 * An operation, from its first move on.
 */
export type Operation = { name: string, move: number, time_s: number, };

/**
 * `text { revision, of, file, from, to }`: lines `from` up to, not including, `to`, from 1. Answered with the array `text`, each line ended by LF.
 */
export type TextParams = { revision: number, of: Of, file?: string | null, from: number, to: number, };

/**
 * What was answered of a text.
 */
export type TextAbout = { lines: number, bytes: number, from: number, to: number, cut: number, };

/**
 * `search { revision, of, file, text, from }`: the next line that has a text in it.
 */
export type SearchParams = { revision: number, of: Of, file?: string | null, text: string, from: number, };

/**
 * Where a text was found.
 */
export type Found = { line: number | null, column: number | null, };

/**
 * By what a place is looked up.
 */
export type By = "time" | "move" | "block" | "source";

/**
 * `place { revision, by, value, file }`.
 */
export type PlaceParams = { revision: number, by: By, value: number, file?: string | null, };

/**
 * `moves { revision, by, value, file }`: which moves a line makes.
 */
export type MovesParams = { revision: number, by: By, value: number, file?: string | null, };

/**
 * Ranges of moves: first, and behind the last; the first thousand.
 */
export type Moves = { ranges: Array<[number, number]>, };

/**
 * One place: at once a time, a move, a block, a line of the source and a template.
 */
export type Place = { time_s: number, move: number, part: number, kind: string, marks: number, block: Line, source: Line | null, template: Template | null, tool: number | null, tip: [number | null, number | null, number | null], axis: [number | null, number | null, number | null], axes: Array<number | null>, feed: FeedAbout | null, spindle: SpindleAbout | null, coolant: string | null, compensation: string | null, cycle: string | null, work_offset: number | null, };

/**
 * A line of a text.
 */
export type Line = { file: string | null, line: number, text: string, };

/**
 * A template of a machine file.
 */
export type Template = { name: string, file: string | null, line: number, text: string, };

/**
 * A feed.
 */
export type FeedAbout = { value: number, unit: string, };

/**
 * A spindle.
 */
export type SpindleAbout = { turns: string, speed: number | null, };

/**
 * `plot { revision, what, from, to, pixels }`: answered with the arrays `least` and `most` (f32, one for each pixel; NaN: nothing known).
 */
export type PlotParams = { revision: number, what: string, from: number, to: number, pixels: number, };

/**
 * `save { revision, path, replace }`: saves program and report, both or neither; what is not proven is refused.
 */
export type SaveParams = { revision: number, path: string, replace: boolean, };

/**
 * What was saved.
 */
export type Saved = { files: Array<string>, };

/**
 * A field of the form that is made of the command's own arguments (`form {}`).
 */
export type Field = { name: string, help: string, value: string | null, values: Array<[string, string]>, default: string | null, group: string | null, repeats: boolean, };

/** What is worked on: enough to post it again. */
export interface Work {
    source: FileOrUpload;
    machine: string | null;
    options: [name: string, value: string][];
}

type NoParams = Record<string, never>;

/** Ask by ask: what it takes and what it gives. */
export interface Asks {
    open: [NoParams, Opened];
    folder: [{ path: string }, Listing];
    machines: [NoParams, MachineEntry[]];
    form: [NoParams, Field[]];
    post: [PostParams, Job];
    prove: [ProveParams, Job];
    text: [TextParams, TextAbout];
    search: [SearchParams, Found];
    place: [PlaceParams, Place | null];
    moves: [MovesParams, Moves];
    plot: [PlotParams, Nothing];
    save: [SaveParams, Saved];
    drafts: [NoParams, Draft[]];
    draft: [{ name: string; of: Work }, Nothing];
    draft_text: [{ name: string }, Nothing];
    drop_draft: [{ name: string }, Nothing];
}
