/** Replay in the machine's time: by a factor of it, or at one speed of the cut. */

import { signal, type Signal } from "@preact/signals";
import type { Cursor } from "./cursor.ts";
import type { Job, Place } from "./protocol/asks.ts";

export type Pace = { factor: number } | { metres: number };

export const FACTORS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 25, 50, 100, 250, 1000];

/** Seconds of the machine for one of ours. What has no feed (a rapid, a dwell) goes by `last`: it never stops the replay. */
export function rate(pace: Pace, place: Pick<Place, "feed"> | null, last: number): number {
    if ("factor" in pace) return pace.factor;
    const feed = place?.feed?.unit === "mm/min" ? place.feed.value : 0;
    return feed > 0 ? (pace.metres * 60_000) / feed : last;
}

export class Player {
    readonly playing: Signal<boolean> = signal(false);
    readonly pace: Signal<Pace> = signal({ factor: 10 });
    private time = 0;
    private before = 0;
    private last = 1;

    constructor(
        private readonly cursor: Cursor,
        private readonly job: Signal<Job | null>,
    ) {}

    get length(): number {
        return this.job.value?.walk.time_s ?? 0;
    }

    toggle(): void {
        if (this.playing.value) this.playing.value = false;
        else this.play();
    }

    faster(by: 1 | -1): void {
        const { value } = this.pace;
        if ("metres" in value) this.pace.value = { metres: Math.max(0.001, value.metres * (by === 1 ? 2 : 0.5)) };
        else {
            const at = FACTORS.findIndex((factor) => factor >= value.factor);
            this.pace.value = { factor: FACTORS[Math.max(0, Math.min(FACTORS.length - 1, at + by))]! };
        }
    }

    private play(): void {
        if (this.length === 0) return;
        const at = this.cursor.place.value?.time_s ?? 0;
        this.time = at >= this.length ? 0 : at;
        this.before = performance.now();
        this.playing.value = true;
        requestAnimationFrame(() => this.step());
    }

    private step(): void {
        if (!this.playing.value || this.job.value === null) return;
        const now = performance.now();
        this.last = rate(this.pace.value, this.cursor.place.value, this.last);
        this.time = Math.min(this.length, this.time + ((now - this.before) / 1000) * this.last);
        this.before = now;
        void this.cursor.to({ by: "time", value: this.time });
        if (this.time >= this.length) this.playing.value = false;
        else requestAnimationFrame(() => this.step());
    }

    /** A move, or the next or last beginning of something. */
    stepTo(step: 1 | -1, of: "move" | "block" | "operation" | "tool"): void {
        this.playing.value = false;
        const walk = this.job.value?.walk;
        if (!walk) return;
        void this.cursor.step(({ move, block_moves }) => {
            if (of === "move") return move + step;
            if (of === "block") {
                const [from, behind] = block_moves.find(([from, to]) => from <= move && move < to) ?? [move, move + 1];
                return step === 1 ? behind : from - 1;
            }
            const starts = (of === "tool" ? walk.tools : walk.operations).map((one) => one.move);
            return nextStart(starts, move, step, walk.moves);
        });
    }

    end(step: 1 | -1): void {
        void this.cursor.toMove(step === 1 ? (this.job.value?.walk?.moves ?? 1) - 1 : 0);
    }
}

export function nextStart(starts: number[], move: number, step: 1 | -1, moves: number): number {
    const sorted = starts.toSorted((a, b) => a - b);
    return step === 1 ? (sorted.find((start) => start > move) ?? moves - 1) : (sorted.findLast((start) => start < move) ?? 0);
}
