/** What is asked of the server, and what it answers: each ask with its params and its answer. The types are the server's own. */

import type {
    BoardPicture,
    Changes,
    ChangesParams,
    Command,
    CommandParams,
    Draft,
    DraftName,
    DraftParams,
    Field,
    FolderParams,
    Found,
    Given,
    Job,
    JobParams,
    KindsParams,
    Listing,
    MachineEntry,
    MachineKind,
    Moves,
    MovesParams,
    Nothing,
    Opened,
    Place,
    PlaceParams,
    PlotParams,
    PostParams,
    ProveParams,
    SaveParams,
    Saved,
    SearchParams,
    TextAbout,
    TextParams,
} from "./types.ts";

export type * from "./types.ts";

/** What is worked on: enough to post it again. */
export interface Work {
    source: Given;
    /** Of a file that was dropped. */
    name?: string;
    machine: string | null;
    options: [name: string, value: string][];
    /** Of a board the file of the program that is edited. */
    file?: string;
}

/** The texts of the files that were edited, by their names; null: the program itself. */
export type Edit = ReadonlyMap<string | null, string>;

/** What may be null may be left out. */
export type Asked<T> = { [K in keyof T as null extends T[K] ? never : K]: T[K] } & { [K in keyof T as null extends T[K] ? K : never]?: T[K] };

type NoParams = Record<string, never>;

/** Ask by ask: what it takes and what it gives. */
export interface Asks {
    open: [NoParams, Opened];
    folder: [FolderParams, Listing];
    machines: [NoParams, MachineEntry[]];
    command: [Asked<CommandParams>, Command];
    kinds: [KindsParams, MachineKind[]];
    form: [{ command?: Command }, Field[]];
    post: [Asked<PostParams>, Job];
    prove: [Asked<ProveParams>, Job];
    job: [JobParams, Job];
    board: [JobParams, BoardPicture];
    text: [Asked<TextParams>, TextAbout];
    search: [Asked<SearchParams>, Found];
    place: [Asked<PlaceParams>, Place | null];
    moves: [Asked<MovesParams>, Moves];
    plot: [PlotParams, Nothing];
    changes: [Asked<ChangesParams>, Changes];
    save: [SaveParams, Saved];
    drafts: [NoParams, Draft[]];
    draft: [DraftParams, Nothing];
    draft_text: [DraftName, Nothing];
    drop_draft: [DraftName, Nothing];
}
