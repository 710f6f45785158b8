/** Colours that vertices do not tell: by operation, order, feed and deviation. One byte a move, made where a chunk is first seen. */

import type { WalkAbout } from "../protocol/asks.ts";
import type { Chunk } from "./chunks.ts";
import { UNKNOWN, step, type Mode } from "./colours.ts";
import type { Rows } from "./rows.ts";
import { CHUNK_MOVES } from "./strip.ts";

export interface Painter {
    (chunk: Chunk): Uint8Array | null;
    /** The values at the ends of the ramp, as far as they are known. */
    ends?(): [least: number, most: number];
}

export function painterOf(mode: Mode, walk: WalkAbout, rows: Rows): Painter | null {
    if (mode === "operation") return byOperation(walk);
    if (mode === "order") return byOrder(walk);
    if (mode === "deviation") return byDeviation(rows, walk.deviation ?? 0);
    return mode === "feed" ? byFeed(rows) : null;
}

/** From none to the largest of the program. It is the last number of a row. */
export function byDeviation(rows: Pick<Rows, "of" | "width">, most: number): Painter {
    const made = new Map<number, Uint8Array>();
    return ({ number }) => {
        const known = made.get(number);
        if (known !== undefined) return known;
        const chunk = rows.of(number);
        const places = new Uint8Array(CHUNK_MOVES).fill(UNKNOWN);
        if (chunk === null) return places;
        for (let move = 0; move * rows.width < chunk.length; move++) places[move] = step(chunk[(move + 1) * rows.width - 1]!, 0, most);
        made.set(number, places);
        return places;
    };
}

export function byOperation({ operations, moves }: Pick<WalkAbout, "operations" | "moves">): Painter {
    const made = new Map<number, Uint8Array>();
    return ({ number, first }) => {
        const known = made.get(number);
        if (known !== undefined) return known;
        const places = new Uint8Array(CHUNK_MOVES).fill(UNKNOWN);
        operations.forEach(({ move }, operation) => {
            const end = operations[operation + 1]?.move ?? moves;
            if (end > first && move < first + CHUNK_MOVES) places.fill(operation % 64, Math.max(0, move - first), end - first);
        });
        made.set(number, places);
        return places;
    };
}

/** From the first move to the last. */
export function byOrder({ moves }: Pick<WalkAbout, "moves">): Painter {
    const made = new Map<number, Uint8Array>();
    return ({ number, first }) => {
        const known = made.get(number);
        if (known !== undefined) return known;
        const places = Uint8Array.from({ length: CHUNK_MOVES }, (_, move) => step(first + move, 0, moves - 1));
        made.set(number, places);
        return places;
    };
}

/** The ramp grows with the feeds that come, and what was painted is painted anew. */
export function byFeed(rows: Pick<Rows, "of" | "width">): Painter {
    const made = new Map<number, Uint8Array>();
    const seen = new Set<number>();
    let [least, most] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];

    const widen = (feeds: Float32Array): void => {
        const before = [least, most];
        for (let at = 3; at < feeds.length; at += rows.width) {
            const feed = feeds[at]!;
            if (!(feed > 0 && feed < 1e9)) continue;
            least = Math.min(least, feed);
            most = Math.max(most, feed);
        }
        if (before[0] !== least || before[1] !== most) made.clear();
    };

    const paint: Painter = ({ number }) => {
        const known = made.get(number);
        if (known !== undefined) return known;
        const places = new Uint8Array(CHUNK_MOVES).fill(UNKNOWN);
        const chunk = rows.of(number);
        if (chunk === null) return places;
        if (!seen.has(number)) {
            seen.add(number);
            widen(chunk);
        }
        for (let move = 0; move * rows.width < chunk.length; move++) places[move] = step(chunk[move * rows.width + 3]!, least, most);
        made.set(number, places);
        return places;
    };
    paint.ends = () => [least, most];
    return paint;
}
