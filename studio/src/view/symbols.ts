/** Moves with something to see that lines do not show: each has a shape of its own, not only a colour. */

import { toScreen, type Projection, type Size } from "./camera.ts";
import type { Chunk } from "./chunks.ts";
import { marksOf } from "./strip.ts";
import type { Vector } from "./vector.ts";

/** Bits of a vertex's marks. */
export const Mark = { compensation: 1, excursion: 2, finding: 4, notProven: 8 } as const;

export interface Symbol {
    x: number;
    y: number;
    marks: number;
}

/** More than these would hide the picture. */
const MOST = 400;

const found = new WeakMap<ArrayBuffer, Uint32Array>();

/** The vertices that are marked and have a shape; looked for once a chunk. */
function marked(vertices: ArrayBuffer): Uint32Array {
    const known = found.get(vertices);
    if (known !== undefined) return known;
    const words = new Uint32Array(vertices);
    const places: number[] = [];
    for (let vertex = 1; vertex * 4 < words.length; vertex++) {
        if ((marksOf(words[vertex * 4 + 3]!) & ~Mark.notProven) !== 0) places.push(vertex);
    }
    const made = Uint32Array.from(places);
    found.set(vertices, made);
    return made;
}

export function symbolsOf(symbols: Symbol[], { chunk, vertices }: { chunk: Chunk; vertices: ArrayBuffer }, projection: Projection, { width, height }: Size): void {
    const numbers = new Float32Array(vertices);
    const words = new Uint32Array(vertices);
    const { origin } = chunk;
    for (const vertex of marked(vertices)) {
        if (symbols.length >= MOST) return;
        const at = vertex * 4;
        const point: Vector = [origin[0] + numbers[at]!, origin[1] + numbers[at + 1]!, origin[2] + numbers[at + 2]!];
        const [x, y] = toScreen(projection, point);
        if (x >= 0 && y >= 0 && x < width && y < height) symbols.push({ x, y, marks: marksOf(words[at + 3]!) });
    }
}
