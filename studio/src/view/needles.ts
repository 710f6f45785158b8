/** The tool axis at some of the moves, as needles from the tip. */

import type { Chunk } from "./chunks.ts";
import type { Rows } from "./rows.ts";
import { moveOf, wordOf, type Paint, type Strip } from "./strip.ts";

/** As many in a picture: more would hide it. */
export const NEEDLES = 1500;

/** Kinds of a needle's two vertices: the way to it is not drawn. */
export const GAP = 0;
const NEEDLE = 1;

/** Needles of `length` mm at every `stride`th vertex; null where the tool does not lean, or its axes have not come. */
export function needlesOf(chunk: Chunk, vertices: ArrayBuffer, rows: Rows, stride: number, length: number, paint: Paint): Strip | null {
    if (rows.width < 9) return null;
    const axes = rows.of(chunk.number);
    if (axes === null) return null;
    const numbers = new Float32Array(vertices);
    const words = new Uint32Array(vertices);
    const count = Math.floor((words.length / 4 - 1) / stride);
    if (count === 0) return null;
    const made = new ArrayBuffer((count * 2 + 1) * 16);
    const madeNumbers = new Float32Array(made);
    const madeWords = new Uint32Array(made);
    for (let needle = 0; needle < count; needle++) {
        const from = (1 + needle * stride) * 4;
        const move = moveOf(words[from + 3]!);
        const axis = move * rows.width + 4;
        const to = (1 + needle * 2) * 4;
        for (let i = 0; i < 3; i++) {
            madeNumbers[to + i] = numbers[from + i]!;
            madeNumbers[to + 4 + i] = numbers[from + i]! + axes[axis + i]! * length;
        }
        madeWords[to + 3] = wordOf(move, GAP, 0);
        madeWords[to + 7] = wordOf(move, NEEDLE, 0);
    }
    return { vertices: made, origin: chunk.origin, first: chunk.first, from: 1, to: count * 2 + 1, paint };
}
