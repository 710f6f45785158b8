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
lines: Array<number>, };

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
source: FileOrUpload | null, 
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
bytes: number | null, };

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
export type MachineKind = "mill" | "wire" | "robot";

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
 * Its id.
 */
upload: string, 
/**
 * Its size.
 */
bytes: number, };
