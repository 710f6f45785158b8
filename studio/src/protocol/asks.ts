/** What the server answers. Lengths in mm, angles in degrees, times in seconds, feeds in mm/min; null is what nobody knows. */

export type Verdict = "done" | "partly" | "failed" | "invalid" | "cancelled";
export type Severity = "error" | "warning" | "note";

export interface Spot {
    file?: string | null;
    line?: number | null;
    column?: number | null;
    width?: number | null;
}

export interface Finding extends Spot {
    severity: Severity;
    rule: string;
    message: string;
    help?: string | null;
    text?: string | null;
    places?: Spot[] | null;
}

export interface Text {
    file: string;
    lines: number;
    bytes: number;
    dialect?: string | null;
    parts?: { file: string; lines: number; bytes: number }[] | null;
}

export interface Axis {
    name: string;
    unit: string;
    low?: number | null;
    high?: number | null;
    kind: "linear" | "rotary" | "joint" | "rail";
}

export interface Tool {
    number: number | null;
    name: string | null;
    move?: number | null;
    diameter?: number | null;
    corner?: number | null;
    length?: number | null;
}

export interface Walk {
    moves: number;
    chunks: number;
    levels: { error: number; vertices: number }[];
    box: { low: number[]; high: number[] } | null;
    time_s: number | null;
    tools: Tool[];
    kinds: string[];
    operations?: { name: string; move: number }[] | null;
    row?: 16 | 36;
    mismatch?: number | null;
}

export interface Machine {
    name: string;
    title: string;
    axes: Axis[];
    file?: string | null;
}

export interface Job {
    revision: number;
    verdict: Verdict;
    rows: [string, string][];
    findings: Finding[];
    program: Text | null;
    source: Text | null;
    machine: Machine | null;
    walk: Walk | null;
    mismatch?: { program: number | null; source: number | null } | null;
}

export interface Line {
    file?: string | null;
    line: number;
    text: string;
}

export interface Place {
    time_s: number | null;
    move: number;
    kind: string;
    block: Line | null;
    source: Line | null;
    template: (Line & { name: string }) | null;
    tool: Tool | null;
    tip: number[];
    axis: number[] | null;
    axes: (number | null)[];
    feed: number | null;
    spindle: string | null;
    coolant: string | null;
    compensation: string | null;
    cycle?: string | null;
}

export interface MachineEntry {
    name: string;
    title: string;
    kind: string;
    control: string;
    axes: string;
}

export interface Option {
    name: string;
    help: string;
    values: string[] | null;
    default: string | null;
    group: string | null;
}

export interface Entry {
    name: string;
    path: string;
    kind: "folder" | "file";
    bytes: number;
}

export interface Draft {
    name: string;
    of: Work;
}

export interface Opened {
    version: string;
    folder: string;
    source: string | null;
    machine: string | null;
    drafts: Draft[];
}

export type SourceName = { file: string } | { upload: string };

/** What is worked on: enough to post it again. */
export interface Work {
    source: SourceName;
    machine: string | null;
    options: Record<string, string>;
}

export interface By {
    by: "time" | "move" | "block" | "source";
    value: number;
    file?: string | null;
}

/** Ask by ask: what it takes and what it gives. */
export interface Asks {
    open: [Record<string, never>, Opened];
    folder: [{ path: string }, { entries: Entry[] }];
    machines: [Record<string, never>, { machines: MachineEntry[] }];
    form: [Record<string, never>, { options: Option[] }];
    post: [Work, Job];
    prove: [Work & { program?: { file: string } }, Job];
    text: [
        { revision: number; of: "program" | "source" | "machine"; file?: string | null; from: number; to: number },
        { lines: number; bytes: number },
    ];
    search: [
        { revision: number; of: "program" | "source" | "machine"; file?: string | null; text: string; from: number },
        { line: number; column: number } | null,
    ];
    place: [By & { revision: number }, Place | null];
    moves: [{ revision: number; by: "block" | "source"; value: number; file?: string | null }, { ranges: [number, number][] }];
    plot: [{ revision: number; what: string; from: number; to: number; pixels: number }, object];
    save: [{ revision: number; path: string; replace: boolean }, { files: string[] }];
    draft: [{ name: string; of: Work }, object];
    drafts: [Record<string, never>, { drafts: Draft[] }];
    draft_text: [{ name: string }, object];
    drop_draft: [{ name: string }, object];
}
