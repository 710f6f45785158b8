/** Colours that vertices do not tell: by operation, feed and deviation. One byte a move, made where a chunk is first seen. */

import type { Seam } from "../protocol/seam.ts";
import type { Chunk } from "./chunks.ts";
import { UNKNOWN, step, type Mode } from "./colours.ts";
import type { Scene } from "./scene.ts";
import { CHUNK_MOVES } from "./strip.ts";

type Painter = (chunk: Chunk) => Uint8Array | null;

export function painted(mode: Mode, scene: Scene, seam: Seam, revision: number, changed: () => void): Painter | null {
    if (mode === "operation") return byOperation(scene);
    if (mode === "feed") return byFeed(scene, seam, revision, changed);
    return null;
}

function byOperation({ walk }: Scene): Painter {
    const starts = walk.operations.map(({ move }) => move);
    return ({ first }) => {
        const places = new Uint8Array(CHUNK_MOVES).fill(UNKNOWN);
        starts.forEach((start, operation) => {
            const end = starts[operation + 1] ?? walk.moves;
            if (end > first && start < first + CHUNK_MOVES) places.fill(operation % 64, Math.max(0, start - first), end - first);
        });
        return places;
    };
}

/** Feeds of a chunk come as they are wanted; the ramp grows with them, and what has come is painted anew. */
function byFeed({ walk }: Scene, seam: Seam, revision: number, changed: () => void): Painter {
    const feeds = new Map<number, Float32Array | null>();
    const places = new Map<number, Uint8Array>();
    let [least, most] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
    const row = walk.row / 4;

    const fetch = async (chunk: number): Promise<void> => {
        const rows = new Float32Array(await seam.octets(`/moves/${revision}/${chunk}`));
        const feed = Float32Array.from({ length: Math.floor(rows.length / row) }, (_, move) => rows[move * row + 3]!);
        feeds.set(chunk, feed);
        const before = [least, most];
        for (const value of feed) {
            if (!(value > 0 && value < 1e9)) continue;
            least = Math.min(least, value);
            most = Math.max(most, value);
        }
        if (before[0] !== least || before[1] !== most) places.clear();
        changed();
    };

    return ({ number }) => {
        const known = places.get(number);
        if (known !== undefined) return known;
        const feed = feeds.get(number);
        if (feed === undefined) {
            feeds.set(number, null);
            void fetch(number).catch(() => feeds.delete(number));
        }
        const made = new Uint8Array(CHUNK_MOVES).fill(UNKNOWN);
        if (!feed) return made;
        feed.forEach((value, move) => {
            if (value > 0) made[move] = step(value, least, most);
        });
        places.set(number, made);
        return made;
    };
}
