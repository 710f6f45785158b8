/** What the page is at: the folder, the work, its job, and what runs. Panes read the signals and call the methods. */

import { batch, computed, signal, type Signal } from "@preact/signals";
import { Cursor } from "./cursor.ts";
import { Latest, Newest } from "./newest.ts";
import type { Arrays } from "./protocol/frames.ts";
import { said, Stopped, type Asking, type Progress, type Seam, type State } from "./protocol/seam.ts";
import { readText } from "./protocol/text.ts";
import type { BoardAbout, Command, Draft, Edit, Field, Finding, Given, Job, MachineEntry, Opened, Verdict, Walked, Work } from "./protocol/asks.ts";
import type { Unkept } from "./protocol/session.ts";
import { Walking } from "./view/walking.ts";

export class Studio {
    readonly link: Signal<State>;
    readonly opened: Signal<Opened | null> = signal(null);
    readonly machines: Signal<MachineEntry[]> = signal([]);
    readonly form: Signal<Field[]> = signal([]);
    readonly drafts: Signal<Draft[]> = signal([]);
    readonly work: Signal<Work | null> = signal(null);
    /** The machine that was chosen last, also before there is a source. */
    readonly machine: Signal<string | null> = signal(null);
    readonly job: Signal<Job | null> = signal(null);
    /** The board that was posted: it stays while one of its programs is edited, which is a job by itself. */
    readonly board: Signal<BoardAbout | null> = signal(null);
    readonly running: Signal<Progress | null> = signal(null);
    /** What the proof that runs has walked, where there is no job to show: nothing of it is proven. */
    readonly walking: Signal<{ walking: Walking; moves: number } | null> = signal(null);
    /** How the last work ended that gave nothing. */
    readonly stop: Signal<Verdict | null> = signal(null);
    /** Why there is no job, or why something else was not done. */
    readonly stopped: Signal<Finding[]> = signal([]);
    readonly said: Signal<string> = signal("");
    /** Files that the work was made of and that are not there any more. */
    readonly gone: Signal<string[]> = signal([]);
    /** The program as edited by hand; null while it is as posted. */
    readonly edited: Signal<Edit | null> = signal(null);
    /** Name of the program that was dropped in the place of the posted one. */
    readonly given: Signal<string | null> = signal(null);
    /** The files of the program as they were posted, as far as they were read. */
    readonly posted = new Map<string | null, string>();
    /** Warnings of the posting that are not of its program, as long as what is shown is that program or an edit of it. */
    private readonly warned: Signal<Finding[]> = signal([]);
    /** What runs, where that matters to others: a posting, or files that are on their way to the server. */
    private readonly doing: Signal<"post" | "upload" | null> = signal(null);
    /** What is shown is not of what was chosen last, and takes no keys. */
    readonly isPosting = computed(() => this.doing.value === "post");
    /** The program that was dropped with the toolpath, until that is posted. */
    private beside: File[] | null = null;
    /** Grows with each program that is no edit of the one before. */
    program = 0;
    /** The file of the folder that was proven in the place of what is posted. */
    private there: string | null = null;
    /** The job whose files those are that were not edited; null where no server has it. */
    private base: number | null = null;
    /** The job is of the program as it stands now. */
    readonly isCurrent: Signal<boolean> = signal(false);
    readonly canSave = computed(() => this.isCurrent.value && (this.job.value?.verdict === "done" || this.job.value?.verdict === "partly"));
    private typing: ReturnType<typeof setTimeout> | undefined;
    /** The source that the job is of. */
    private shown = "";
    /** Name of the draft that this page keeps its edit under. */
    private kept: string | null = null;
    /** Those of the edits which made room, the last one behind: the server's list may not have them yet. */
    private aside: string[] = [];
    /** The edit that the server has said to have kept. */
    private readonly known: Signal<Studio["edited"]["value"]> = signal(null);
    private readonly keeping = new Newest<Work>((work) => this.keepEdit(work));
    /** What has asked for room last. */
    private room: Promise<unknown> = Promise.resolve();
    /** An edit that was on the page when it was left, until a server has it. */
    left: Unkept | null = null;
    /** Why the server could not keep the edit: a full disk, a folder that is read only. */
    readonly notKept: Signal<string | null> = signal(null);
    /** The edit as it stands is in no draft of a server that is there. */
    readonly isAlone = computed(() => this.edited.value !== null && (this.link.value !== "open" || this.known.value !== this.edited.value));
    /** What stops the work comes first. */
    readonly findings = computed(() => {
        const ofJob = this.job.value?.findings ?? [];
        const told = new Set(ofJob.map(nameOf));
        // What the posting has warned of is true of an edit too, whose proof does not look at all of it.
        const stay = this.job.value === null ? [] : this.warned.value.filter((finding) => !told.has(nameOf(finding)));
        const all = [...this.stopped.value, ...ofJob, ...stay];
        return all.toSorted((a, b) => Number(b.severity === "error") - Number(a.severity === "error"));
    });
    readonly cursor: Cursor;
    /** A machine has to be chosen before anything can be posted. */
    asksMachine: () => void = () => {};
    /** The command whose form is shown. */
    private formOf: Command | null = null;
    private readonly forms = new Latest();
    private readonly listed = new Latest();
    private abort: AbortController | null = null;

    constructor(
        readonly seam: Seam,
        link: Signal<State>,
    ) {
        this.link = link;
        this.cursor = new Cursor(seam, this.job);
    }

    /** After the first connection and after each that was lost: revisions may be others now, so the work is posted again. */
    async begin(): Promise<void> {
        const { done: opened } = await this.seam.ask("open", {});
        this.known.value = null;
        // What is worked on is asked for first, the lists behind it, without waiting for one another.
        const work = batch(() => {
            this.machine.value ??= this.work.value?.machine ?? opened.machine;
            // What was left behind is offered when it is kept: it would be kept behind the back of who goes on with it.
            if (this.left === null) this.drafts.value = opened.drafts.filter(({ name }) => name !== this.kept);
            this.opened.value = opened;
            if (this.edited.value !== null) return this.prove(this.edited.value);
            if (this.work.value !== null) return this.post({ ...this.work.value, machine: this.work.value.machine ?? this.machine.value });
            return opened.source === null ? null : this.open(opened.source);
        });
        if (this.left !== null) await this.offer(this.left);
        this.machines.value = (await this.seam.ask("machines", {})).done;
        await this.askForm();
        await work;
    }

    /** The options of the machine's command; while the machines have not come, this is asked behind them. */
    private async askForm(): Promise<void> {
        if (this.machines.value.length === 0) return;
        const isNewest = this.forms.begin();
        const kind = this.machines.value.find(({ name }) => name === this.machine.value)?.kind;
        const ofMachine: Command = kind === "wire" || kind === "glass" ? kind : "post";
        const work = this.work.value;
        // What cannot be read says so when it is posted.
        const command = work === null ? ofMachine : await this.seam.ask("command", { source: work.source, machine: this.machine.value })
            .then(({ done }) => done, () => ofMachine);
        if (!isNewest() || this.formOf === command) return;
        const { done: form } = await this.seam.ask("form", { command });
        if (!isNewest()) return;
        this.formOf = command;
        this.form.value = form;
    }

    open(source: Given): Promise<void> {
        return this.begunWith({ source, machine: this.machine.value, options: [] });
    }

    /** Another source: a machine of another kind, which cannot take it, is not kept. */
    private async begunWith(work: Work): Promise<void> {
        this.said.value = "";
        this.beside = null;
        const kind = this.machines.value.find(({ name }) => name === work.machine)?.kind;
        const posting = this.post(work).then(() => {});
        if (kind === undefined) return posting;
        // What cannot be read says so when it is posted.
        const kinds = await this.seam.ask("kinds", { source: work.source }).then(({ done }) => done, () => [kind]);
        // An edit may still be making room for it.
        await this.room;
        if (kinds.includes(kind) || this.work.value !== work) return posting;
        await this.post({ ...work, machine: null });
    }

    /** A toolpath, and a program that is proven against it. */
    async dropBoth(toolpath: File, program: File): Promise<void> {
        await this.drop([toolpath]);
        if (this.job.value !== null) return this.proveOther([program]);
        // A machine is still to be chosen, or an option to be set.
        if (this.work.value?.name !== toolpath.name) return;
        this.beside = [program];
        this.said.value = `${program.name} is proven when ${toolpath.name} is posted`;
    }

    /** A file is a toolpath or a board; several are the files of a board. */
    async drop(files: File[]): Promise<void> {
        const name = files.map((file) => file.name).join(", ");
        const uploads = await this.told(async ({ signal }) => {
            const ids: string[] = [];
            for (const file of files) ids.push(await this.seam.upload(file, signal));
            return ids;
        }, "upload");
        if (uploads === undefined) {
            if (this.stop.value === null) this.said.value = `${name} is not taken: something else was begun meanwhile`;
            return;
        }
        const source = uploads.length === 1 ? { upload: uploads[0]! } : { uploads };
        await this.begunWith({ source, name, machine: this.machine.value, options: [] });
    }

    async choose(machine: string): Promise<void> {
        const work = this.work.value;
        this.said.value = "";
        // It is for the file that comes.
        if (work !== null && this.doing.value !== "upload") {
            await this.post({ ...work, machine });
            return;
        }
        this.machine.value = machine;
        await this.askForm();
    }

    /** Posts and proves. An edit by hand is kept, and offered; nothing is done where it cannot be: false. */
    async post(work: Work): Promise<boolean> {
        if (!(await this.setAside())) return false;
        clearTimeout(this.typing);
        this.work.value = work;
        this.edited.value = null;
        this.kept = null;
        this.isCurrent.value = false;
        const { source, machine, options } = work;
        this.machine.value = machine;
        if (machine === null) {
            this.end();
            this.job.value = null;
            // What is dropped before the first connection is posted with it: the command may have named a machine.
            if (this.opened.value === null) return true;
            void this.askForm();
            this.asksMachine();
            return true;
        }
        // The picture of another source says nothing of this one, nor does a place in it.
        if (this.shown !== JSON.stringify(source)) {
            if (this.shown !== "") this.cursor.first = null;
            this.job.value = this.board.value = null;
        }
        this.shown = JSON.stringify(source);
        const posting = this.told(async (asking) => (await this.seam.ask("post", { source, machine, options }, asking)).done, "post");
        void this.askForm();
        const job = await posting;
        // Something newer is under way, and what is shown belongs to it.
        if (this.work.value !== work) return true;
        if (job === undefined) this.cursor.keep();
        batch(() => {
            this.board.value = job?.board ?? null;
            this.hasWarned(job ?? null);
            if (this.edited.value === null) this.isNew(job ?? null);
            this.show(job ?? null);
            this.isCurrent.value = job !== undefined && this.edited.value === null;
        });
        if (this.edited.value === null) void this.askDrafts();
        const { beside } = this;
        if (beside !== null && job !== undefined) {
            this.beside = null;
            await this.proveOther(beside);
            return true;
        }
        const same = job?.board?.programs.find(({ file, revision }) => file === work.file && revision !== job.revision);
        if (same !== undefined && this.edited.value === null) await this.chooseProgram(same.revision);
        return true;
    }

    /** Posts what is open as it lies in the folder now; a program that was proven instead is proven again. False where an edit is in the way. */
    async again(): Promise<boolean> {
        if (this.there !== null) return this.proveFile(this.there);
        return this.work.value === null || this.post(this.work.value);
    }

    /** The job whose files are watched; null: what gave none; undefined: nothing is. */
    get watched(): number | null | undefined {
        const { work, job, stop } = this;
        if (this.link.value !== "open" || this.running.value !== null || work.value === null || work.value.machine === null) return undefined;
        if (this.isCurrent.value || stop.value === null) return job.value?.revision;
        return stop.value === "cancelled" ? undefined : null;
    }

    private hasWarned(job: Job | null): void {
        this.warned.value = (job?.findings ?? []).filter(({ severity, of }) => severity === "warning" && of !== "program");
    }

    /** The job of a program that is no edit of the one before. */
    private isNew(job: Job | null): void {
        this.given.value = null;
        this.there = null;
        this.base = job?.revision ?? null;
        this.posted.clear();
        this.program++;
    }

    /** A job, in the place of what was walked of it. */
    private show(job: Job | null): void {
        batch(() => {
            this.walking.value = null;
            this.job.value = job;
        });
    }

    /** Another program of the board. */
    async chooseProgram(revision: number): Promise<void> {
        if (!(await this.setAside())) return;
        const job = await this.told(async () => (await this.seam.ask("job", { revision })).done);
        if (job === undefined) return;
        clearTimeout(this.typing);
        batch(() => {
            this.edited.value = null;
            this.work.value = ofProgram(this.work.value, job);
            this.hasWarned(job);
            this.isNew(job);
            this.job.value = job;
            this.isCurrent.value = true;
        });
        void this.askDrafts();
    }

    /** A file of the program is being edited: all are proven when the typing rests. */
    typed(text: string, file: string | null = null): void {
        this.work.value = ofProgram(this.work.value, this.job.value);
        const edit = new Map(this.edited.value ?? []).set(file, text);
        this.edited.value = edit;
        this.isCurrent.value = false;
        this.stop.value = null;
        // No key waits for the proof: what a draft holds is not lost.
        if (this.work.value !== null) void this.keeping.ask(this.work.value);
        clearTimeout(this.typing);
        this.typing = setTimeout(() => void this.prove(edit), 400);
    }

    /** Proves a program of the folder against the toolpath that is open. False where an edit is in the way. */
    async proveFile(file: string): Promise<boolean> {
        const work = this.work.value;
        if (work === null || work.machine === null) return true;
        if (!(await this.setAside())) return false;
        const { source, machine, options } = work;
        const program = { file };
        const job = await this.told(async (asking) => (await this.seam.ask("prove", { source, machine, options, program }, asking)).done);
        if (job === undefined) return true;
        batch(() => {
            this.edited.value = null;
            this.isNew(job);
            this.warned.value = [];
            this.there = file;
            this.show(job);
            this.isCurrent.value = true;
        });
        return true;
    }

    /** Proves a program that is in no folder here: of one of several files each stands for the one of its name. */
    async proveOther(files: File[]): Promise<void> {
        const parts = new Set(this.job.value?.parts.map(({ file }) => file));
        const own = ({ name }: File): string | null => (parts.has(name) ? name : null);
        const edit = new Map(await Promise.all(files.map(async (file) => [own(file), await file.text()] as const)));
        if (edit.size === files.length) {
            if (!(await this.setAside())) return;
            this.given.value = files.find((file) => own(file) === null)?.name ?? null;
            this.warned.value = [];
            return this.prove(edit);
        }
        const names = [...parts].join(", ") || "none";
        this.stopped.value = [said("program-files", "these are several programs", `give one, with files that it calls (${names})`)];
    }

    /** Proves the program as edited by hand, all its files together, and keeps the edit as a draft. */
    async prove(edit: Edit): Promise<void> {
        const work = this.work.value;
        if (work === null || work.machine === null) return;
        this.edited.value = edit;
        this.isCurrent.value = false;
        if (this.known.value !== edit) void this.keeping.ask(work);
        const job = await this.told((asking) => this.judge(work, new Texts(edit), asking));
        if (job === undefined) return;
        batch(() => {
            this.base = job.revision;
            this.show(job);
            // Somebody may have typed on meanwhile.
            this.isCurrent.value = this.edited.value === edit;
        });
    }

    /** The job of an edit of the program. */
    private async judge(work: Work, { edit, files, octets }: Texts, asking: Asking): Promise<Job> {
        const { source, options, file = null } = work;
        const machine = work.machine!;
        const ask = async (): Promise<Job> => {
            const of = this.base === null ? {} : { revision: this.base, files };
            return (await this.seam.ask("prove", { source, machine, options, file, ...of }, { arrays: { text: octets }, ...asking })).done;
        };
        if (this.base !== null) {
            try {
                return await ask();
            } catch (error) {
                if (!isOf(error, NOT_OPEN)) throw error;
            }
        }
        // This server has not, or not any more, what was edited.
        this.base = null;
        const posted = await this.seam.ask("post", { source, machine, options }, asking).then(({ done }) => done, (error: unknown) => {
            // What cannot be posted can have been written by hand.
            if (edit.size === 1 && edit.has(null) && error instanceof Stopped && error.verdict !== "cancelled") return null;
            throw error;
        });
        if (posted !== null) await this.begun(posted, work, edit, asking);
        return ask();
    }

    /** What was posted is that of which there is an edit. */
    private async begun(first: Job, { source, file }: Work, edit: Edit, { signal }: Asking): Promise<void> {
        const own = first.board?.programs.find((program) => program.file === file);
        const job = own === undefined || own.revision === first.revision ? first : (await this.seam.ask("job", { revision: own.revision })).done;
        const texts = await Promise.all([...edit.keys()].map(async (name) => {
            const lines = (name === null ? job.program : job.parts.find((part) => part.file === name))?.lines ?? 0;
            return [name, await readText(this.seam, { revision: job.revision, of: "program", file: name, from: 1, to: lines + 1 })] as const;
        }));
        if (signal?.aborted) return;
        this.shown = JSON.stringify(source);
        batch(() => {
            this.hasWarned(job);
            this.isNew(job);
            for (const [name, text] of texts) this.posted.set(name, text);
            this.board.value = first.board;
            this.show(job);
        });
    }

    /** Keeps the edit as it stands; of a long one, which takes its time, not at each key. */
    private async keepEdit(work: Work): Promise<void> {
        const edited = this.edited.value;
        if (edited === null) return;
        const begun = performance.now();
        if (await this.keep(work, edited)) this.known.value = edited;
        await new Promise((resolve) => setTimeout(resolve, Math.min(1000, 3 * (performance.now() - begun))));
    }

    /** Keeps an edit as a draft; beside that of another page, where one edits the same program. Whether it is kept. */
    private async keep(work: Work, edit: Edit): Promise<boolean> {
        const { files, octets } = new Texts(edit);
        const of: Drafted = files.length === 1 && files[0]![0] === null ? work : { ...work, files };
        const name = draftName(work);
        // What is kept already is another edit, and stays as it is.
        const offered = new Set([...this.drafts.value.map((draft) => draft.name), ...this.aside]);
        const names = new Set([this.kept ?? name, name, ...[2, 3, 4, 5, 6, 7, 8, 9].map((number) => `${name}-${number}`)]);
        if (this.kept === null && offered.has(name)) this.said.value = "there is another edit of this program: both edits are kept";
        for (const own of [...names].filter((one) => one === this.kept || !offered.has(one))) {
            this.kept = own;
            try {
                await this.seam.ask("draft", { name: own, of }, { arrays: { text: octets } });
                this.notKept.value = null;
                return true;
            } catch (error) {
                if (!isOf(error, OTHER_PAGE)) {
                    // That there is no server is said already.
                    if (error instanceof Stopped && error.verdict !== "cancelled") this.notKept.value = error.message;
                    return false;
                }
                this.said.value = "another tab edits this program too: both edits are kept";
            }
        }
        this.notKept.value = "there are nine edits of this program already: drop some";
        return false;
    }

    /**
     * An edit makes room for something else: it stays among the drafts, and is offered. False where it cannot be kept: then nothing else is done.
     * One behind the other: of two that ask for room the later one has it.
     */
    private setAside(): Promise<boolean> {
        const made = this.room.then(() => this.makeRoom());
        this.room = made.catch(() => {});
        return made;
    }

    private async makeRoom(): Promise<boolean> {
        const { edited, known, work } = this;
        if (edited.value === null || work.value === null) return true;
        await this.keeping.rest();
        // Keys may come while it is being kept.
        while (edited.value !== null && edited.value !== known.value) {
            const edit: Edit = edited.value;
            await this.keeping.ask(work.value);
            await this.keeping.rest();
            if (known.value === edit || edited.value !== edit) continue;
            this.stopped.value = [said("edit-not-kept", `the edit on this page cannot be kept: ${this.notKept.value ?? "there is no server"}`, "save it, download it, or discard it; nothing else was done")];
            return false;
        }
        clearTimeout(this.typing);
        if (this.kept !== null) this.aside.push(this.kept);
        this.kept = null;
        edited.value = null;
        void this.askDrafts();
        return true;
    }

    /** What is kept of edits that are not on this page. */
    private async askDrafts(): Promise<void> {
        const isNewest = this.listed.begin();
        const drafts = await this.seam.ask("drafts", {}).then(({ done }) => done, () => null);
        if (drafts !== null && isNewest()) this.drafts.value = drafts.filter(({ name }) => name !== this.kept);
    }

    /** Those of the program that is shown come first, and of them the one that made room last. */
    readonly offers = computed(() => {
        const work = this.work.value;
        const name = work === null ? null : draftName(work);
        const rank = (draft: Draft): number => (name === null || draft.name.replace(/-\d$/, "") !== name ? 2 : draft.name === this.aside.at(-1) ? 0 : 1);
        return this.drafts.value.toSorted((a, b) => rank(a) - rank(b));
    });

    /** The edit, where no server has said to have kept it. */
    get unkept(): Unkept | null {
        const { edited, work, isAlone } = this;
        if (edited.value === null || work.value === null || !isAlone.value) return this.left;
        return { of: work.value, edit: [...edited.value], name: this.kept };
    }

    /** Gives the server an edit that it has not got, and offers it. */
    private async offer({ of, edit, name }: Unkept): Promise<void> {
        // What was kept of the same edit before is older.
        this.kept = name;
        if (await this.keep(of, new Map(edit))) this.left = this.kept = null;
        await this.askDrafts();
    }

    private async dropOwn(): Promise<void> {
        const { kept } = this;
        this.kept = null;
        if (kept !== null) await this.dropDraft(kept);
    }

    /** Back to the program as posted. */
    async discard(): Promise<void> {
        const work = this.work.value;
        if (work === null) return;
        clearTimeout(this.typing);
        this.edited.value = null;
        await this.keeping.rest();
        await this.dropOwn();
        // Something else may have been opened meanwhile, and stays.
        if (this.work.value === work) await this.post(work);
    }

    /** Goes on with an edit that was kept. */
    async resume(draft: Draft): Promise<void> {
        if (!(await this.setAside())) return;
        const { arrays } = await this.seam.ask("draft_text", { name: draft.name });
        const { files, ...work } = draft.of as Drafted;
        clearTimeout(this.typing);
        this.work.value = work;
        this.kept = draft.name;
        this.machine.value = work.machine;
        this.takeOut(draft.name);
        void this.askForm();
        // It is an edit of what is posted today.
        this.base = null;
        await this.prove(editOf(arrays.text as Uint8Array | undefined, files));
    }

    /** It is offered no more. */
    private takeOut(name: string): void {
        this.aside = this.aside.filter((one) => one !== name);
        this.drafts.value = this.drafts.value.filter((draft) => draft.name !== name);
    }

    async dropDraft(name: string): Promise<void> {
        this.takeOut(name);
        await this.seam.ask("drop_draft", { name }).catch(() => {});
        // A list that was asked for before may have it in it.
        await this.askDrafts();
    }

    /** Why the program cannot be saved as it stands on the page. */
    refusal(): Finding | null {
        if (this.canSave.value) return null;
        if (this.job.value === null || this.job.value.program === null) return said("nothing-to-save", "there is no program to save", "post a toolpath that the machine can cut");
        const help = this.isCurrent.value ? "mend what the findings name, or discard the edit" : "wait until its proof has passed";
        return said("not-proven", "the program as it stands here is not proven: it is not saved", help);
    }

    /** Saves the program as it stands on the page, which is proven; a proof that runs is not ended for it. */
    async save(path: string, replace: boolean): Promise<boolean> {
        const job = this.job.value;
        const work = this.work.value;
        if (job === null || work === null) return false;
        const refusal = this.refusal();
        if (refusal !== null) {
            this.stopped.value = [refusal];
            return false;
        }
        const saved = await this.told(async () => (await this.seam.ask("save", { revision: job.revision, path, replace })).done);
        if (saved === undefined) return false;
        this.said.value = `saved ${saved.files.join(", ")}`;
        this.stopped.value = saved.findings;
        if (this.isCurrent.value) await this.dropOwn();
        return true;
    }

    cancel(): void {
        this.abort?.abort();
    }

    /** Ends what runs and forgets what it has said: it is of something else. */
    private end(): void {
        this.abort?.abort();
        this.abort = null;
        batch(() => {
            this.running.value = this.doing.value = this.stop.value = this.walking.value = null;
            this.stopped.value = [];
        });
    }

    /** Runs one thing at a time: a newer one ends the older. What stops it is shown. */
    private async told<T>(run: (asking: Required<Pick<Asking, "signal" | "progress" | "walked">>) => Promise<T>, doing: "post" | "upload" | null = null): Promise<T | undefined> {
        this.abort?.abort();
        const abort = new AbortController();
        this.abort = abort;
        this.running.value = { step: "reading", part: null };
        this.doing.value = doing;
        this.stopped.value = [];
        this.stop.value = null;
        this.walking.value = null;
        const progress = (now: Progress): void => {
            if (this.abort === abort) this.running.value = now;
        };
        const walked = (now: Walked, arrays: Arrays): void => {
            if (this.abort !== abort || this.job.value !== null) return;
            const walking = this.walking.value?.walking ?? new Walking(now.file, now.kinds);
            if (walking.add(now, arrays)) this.walking.value = { walking, moves: walking.moves };
        };
        try {
            const done = await run({ signal: abort.signal, progress, walked });
            if (this.abort !== abort) return undefined;
            // What was refused while it ran was refused for its sake.
            this.stopped.value = [];
            return done;
        } catch (error) {
            if (this.abort !== abort) return undefined;
            if (!(error instanceof Stopped)) throw error;
            this.stopped.value = error.findings;
            this.stop.value = error.verdict;
            this.walking.value = null;
            return undefined;
        } finally {
            if (this.abort === abort) {
                this.abort = null;
                this.running.value = this.doing.value = null;
            }
        }
    }
}

/** What tells one finding from another. */
const nameOf = ({ rule, message, file, line }: Finding): string => [rule, message, file, line].join("\n");

/** The server's rule where another page keeps a draft of that name. */
const OTHER_PAGE = "studio-draft";

/** The server's rule where a job is not open any more. */
const NOT_OPEN = "studio-limit";

const isOf = (error: unknown, rule: string): boolean => error instanceof Stopped && error.findings[0]?.rule === rule;

/** What a draft is of; where more than the program itself was edited, which files, and how many bytes each has. */
type Drafted = Work & { files?: [string | null, number][] };

/** The texts of an edit one behind the other, as they are sent and kept. */
class Texts {
    readonly octets: Uint8Array<ArrayBuffer>;
    readonly files: [string | null, number][];

    constructor(readonly edit: Edit) {
        const encoder = new TextEncoder();
        const texts = [...edit].map(([file, text]) => [file, encoder.encode(text.endsWith("\n") ? text : `${text}\n`)] as const);
        this.files = texts.map(([file, octets]) => [file, octets.length]);
        this.octets = new Uint8Array(texts.reduce((sum, [, { length }]) => sum + length, 0));
        let at = 0;
        for (const [, octets] of texts) {
            this.octets.set(octets, at);
            at += octets.length;
        }
    }
}

/** The edit that was kept so; without a word on files it is of the program itself. */
function editOf(octets: Uint8Array = new Uint8Array(), files: Drafted["files"] = [[null, octets.length]]): Edit {
    const decoder = new TextDecoder();
    let at = 0;
    // Without the end of the last line, as texts are read.
    return new Map(files.map(([file, length]) => [file, decoder.decode(octets.subarray(at, (at += length))).replace(/\n$/, "")]));
}

/** Of a program of a board the work says which it is. */
function ofProgram(work: Work | null, job: Job | null): Work | null {
    const file = job?.board ? job.program?.file : undefined;
    return work === null || file === undefined ? work : { ...work, file };
}

export function draftName({ source, machine, file }: Work): string {
    const name = [...Object.values(source).flat(), ...(file === undefined ? [] : [file])].join("-");
    return `${name}.${machine ?? "no-machine"}`.replaceAll(/[^\w.-]+/g, "_");
}
