/** The one cursor: where every pane is. A place is a time, a move, a block, a line of the source and a template at once. */

import { computed, effect, signal, untracked, type Signal } from "@preact/signals";
import { Newest } from "./newest.ts";
import type { Seam } from "./protocol/seam.ts";
import type { Asked, Job, Place, PlaceParams } from "./protocol/asks.ts";

/** What a place is asked by. */
export type Where = Asked<Omit<PlaceParams, "revision">>;

/** Moves from the first to before the last. */
export type Range = [number, number];

export class Cursor {
    readonly place: Signal<Place | null> = signal(null);
    /** The moves that the block of the place makes: several where it stands in a loop or a cycle. */
    readonly ofBlock = computed((): Range[] => this.place.value?.block_moves ?? []);
    /** What the place was asked by. */
    readonly by: Signal<Where["by"]> = signal("move");
    /** How many places were asked for, those of before in a job that is new not counted. */
    asks = 0;
    /** By which of these asks the place came. */
    answers = 0;
    private readonly asked: Newest<{ where: Where; ask: number }>;
    private steps: Promise<void> = Promise.resolve();
    /** Of which job the place is. */
    private revision = 0;
    /** Where to begin, when there is a job. */
    first: Where | null = null;

    constructor(
        private readonly seam: Seam,
        private readonly job: Signal<Job | null>,
    ) {
        this.asked = new Newest(({ where, ask }) => this.find(where, ask));
        effect(() => {
            const now = this.job.value;
            untracked(() => this.again(now));
        });
    }

    to(where: Where, ask = ++this.asks): Promise<void> {
        this.by.value = where.by;
        return this.asked.ask({ where, ask });
    }

    toMove(move: number, ask?: number): Promise<void> {
        const moves = this.job.value?.walk.moves ?? 0;
        return this.to({ by: "move", value: Math.max(0, Math.min(moves - 1, move)) }, ask);
    }

    /** A step from the place that was asked for last, as soon as that is known: of two that come fast none is lost. */
    step(to: (place: Place) => number): Promise<void> {
        const step = async (): Promise<void> => {
            await this.asked.rest();
            const place = this.place.value;
            if (place !== null) await this.toMove(to(place));
        };
        this.steps = this.steps.then(step, step);
        return this.steps;
    }

    /** The next or the last move of the same block, in turn. */
    turn(by: 1 | -1): Promise<void> {
        return this.step(({ block_moves, move }) => neighbour(block_moves, move, by));
    }

    private async find(by: Where, ask: number): Promise<void> {
        const job = this.job.value;
        if (job === null || job.walk.moves === 0) return;
        const { done } = await this.seam.ask("place", { ...by, revision: job.revision });
        if (this.job.value?.revision !== job.revision) return;
        if (done === null) {
            // Of another job, and this one does not come so far: its end, which is the first mismatch of a failed proof.
            // Another program of a board makes nothing of that file: there the place is the move of this number.
            const isOther = by.by === "source" && (by.file ?? null) !== null;
            const move = isOther ? (this.place.value?.move ?? 0) : job.walk.moves - 1;
            if (this.revision !== job.revision) void this.toMove(job.walk.mismatch ?? move, ask);
            return;
        }
        this.revision = job.revision;
        this.answers = ask;
        this.place.value = done;
    }

    /** There is no job for a while: the next one begins where this one was left. */
    keep(): void {
        const source = this.place.value?.source;
        if (source) this.first ??= { by: "source", value: source.line, file: source.file };
    }

    /** After a new posting: the same record of the source, or the same time where there is none. */
    private again(job: Job | null): void {
        const place = this.place.value;
        const walk = job?.walk ?? null;
        const { first } = this;
        if (walk === null || walk.moves === 0) {
            this.place.value = null;
        } else if (first !== null) {
            this.first = null;
            void this.to(first);
        } else if (place?.source) {
            void this.to({ by: "source", value: place.source.line, file: place.source.file }, this.answers);
        } else {
            void this.toMove(place?.move ?? walk.mismatch ?? 0, place === null ? undefined : this.answers);
        }
    }
}

/** The move beside `move` in the ranges, round in a ring. */
export function neighbour(ranges: Range[], move: number, step: 1 | -1): number {
    const at = ranges.findIndex(([from, to]) => from <= move && move < to);
    const range = ranges[at];
    if (range === undefined) return ranges[0]?.[0] ?? move;
    const next = move + step;
    if (range[0] <= next && next < range[1]) return next;
    const beside = ranges[(at + step + ranges.length) % ranges.length]!;
    return step === 1 ? beside[0] : beside[1] - 1;
}
