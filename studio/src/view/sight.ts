/**
 * What is seen in one view, as the server has looked at it: exact lines, in pixels of that view. It is asked for when the view rests, where the levels of the
 * chunks are too coarse for it, or would be too many.
 */

import type { Projection, Size } from "./camera.ts";
import type { Vertices } from "./chunks.ts";
import type { Range } from "../cursor.ts";
import { divided } from "./strip.ts";
import type { Vector } from "./vector.ts";

/** What is seen of a chunk. */
export interface Seen {
    chunk: number;
    vertices: ArrayBuffer;
}

export function readSight(octets: ArrayBuffer): Seen[] {
    const data = new DataView(octets);
    const words = Array.from({ length: 2 * data.getUint32(0, true) }, (_, i) => data.getUint32(4 + 4 * i, true));
    const chunks = words.filter((_, i) => i % 2 === 0);
    const vertices = divided(octets, 4 + 4 * words.length, words.filter((_, i) => i % 2 === 1));
    return vertices.map((vertices, i) => ({ chunk: chunks[i] ?? 0, vertices }));
}

/** How a view is asked for: with so many pixels more on each side, without the kinds of these bits; only some moves, or all. */
export function pathOf({ right, down, away, at: [x, y, z] }: Projection, { width, height }: Size, beside: number, hidden: number, moves: Range[] | null): string {
    const size = [width + 2 * beside, height + 2 * beside];
    const ranges = moves === null ? "all" : moves.map(([from, to]) => `${from}-${to}`).join(",");
    return `${size.join()}/${[...right, ...down, ...away, x + beside, y + beside, z].join()}/${hidden}/${ranges}`;
}

/** How pixels of a view are drawn in it. */
export const frameOf = ({ scale }: Projection, beside: number): Projection =>
    ({ right: [1, 0, 0], down: [0, 1, 0], away: [0, 0, 1], at: [-beside, -beside, 0] satisfies Vector, scale });

/** One sight: what has come, and what is on its way. */
export class Sight {
    private come: { from: Vertices; path: string; seen: Seen[] | null } | null = null;
    private asked: { from: Vertices; path: string; stop: () => void } | null = null;

    constructor(private readonly changed: () => void) {}

    /** Asks for it, where it has not come, when nothing else has been wished for so long, ms; null until then, and where it cannot be had. */
    of(from: Vertices, path: string, rests: number): Seen[] | null {
        if (this.come?.from === from && this.come.path === path) return this.come.seen;
        if (this.asked?.from === from && this.asked.path === path) return null;
        this.forget();
        const abort = new AbortController();
        const rest = setTimeout(() => {
            const take = (seen: Seen[] | null): void => {
                if (abort.signal.aborted) return;
                this.asked = null;
                this.come = { from, path, seen };
                this.changed();
            };
            from.sight(path, abort.signal).then(take, () => take(null));
        }, rests);
        const stop = (): void => {
            clearTimeout(rest);
            abort.abort();
        };
        this.asked = { from, path, stop };
        return null;
    }

    /** Nothing is wished for any more; what has come is given back. */
    forget(): void {
        this.asked?.stop();
        this.asked = null;
        this.come = null;
    }
}

/** Those of a view: of all lines, and of what is picked out. */
export class Sights {
    readonly lines: Sight;
    readonly now: Sight;
    readonly block: Sight;
    readonly mismatch: Sight;
    /** What the last picture was drawn of: there a click looks for its move. */
    drawn: { projection: Projection; seen: Seen[]; beside: number } | null = null;

    constructor(changed: () => void) {
        this.lines = new Sight(changed);
        this.now = new Sight(changed);
        this.block = new Sight(changed);
        this.mismatch = new Sight(changed);
    }

    forget(): void {
        for (const sight of [this.lines, this.now, this.block, this.mismatch]) sight.forget();
        this.drawn = null;
    }
}
