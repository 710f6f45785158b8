/** What a wire cuts: the ruled surface between the lower and the upper end of the wire, as triangles. */

import type { Chunk } from "./chunks.ts";
import type { Rows } from "./rows.ts";
import { kindOf, moveOf } from "./strip.ts";

/** Where the axis begins in a row that has one, and the numbers of such a row. */
const AXIS = 4;
const LEANING = 10;

export interface Cut {
    /** From the lower end of the wire to the upper one, mm. */
    height: number;
    /** The kinds of moves that cut: straight, and round. */
    straight: number;
    round: number;
}

type Lean = [x: number, y: number];

/** Corners of the triangles, six for each line that cuts; null where the way that the wire leans has not come. */
export function surfaceOf(chunk: Chunk, vertices: ArrayBuffer, rows: Rows, { height, straight, round }: Cut): Float32Array | null {
    const leans = rows.width < LEANING ? null : rows.of(chunk.number);
    if (leans === null && rows.width >= LEANING) return null;
    const numbers = new Float32Array(vertices);
    const words = new Uint32Array(vertices);
    const count = words.length / 4;
    /** How far the upper end is from above the lower one, at the end of a move. */
    const leanOf = (move: number): Lean => {
        const at = move * rows.width + AXIS;
        const [x = 0, y = 0, z = 1] = leans === null || move < 0 ? [] : [leans[at]!, leans[at + 1]!, leans[at + 2]!];
        return z > 0 && Number.isFinite(x / z) ? [(x / z) * height, (y / z) * height] : [0, 0];
    };
    const lean = new Float32Array(count * 2);
    const set = (vertex: number, [x, y]: Lean): void => lean.set([x, y], vertex * 2);
    for (let first = 1; first < count; ) {
        const move = moveOf(words[first * 4 + 3]!);
        let last = first;
        while (last + 1 < count && moveOf(words[(last + 1) * 4 + 3]!) === move) last++;
        const [from, to] = [leanOf(move - 1), leanOf(move)];
        const isRound = kindOf(words[last * 4 + 3]!) === round;
        if (first === 1) set(0, isRound && move === 0 ? to : move === 0 ? to : from);
        for (let vertex = first; vertex <= last; vertex++) {
            const part = (vertex - first + 1) / (last - first + 1);
            set(vertex, isRound ? turned(numbers, vertex, last, from, to, part) : [from[0] + (to[0] - from[0]) * part, from[1] + (to[1] - from[1]) * part]);
        }
        first = last + 1;
    }
    const corners: number[] = [];
    const lower = (vertex: number): number[] => [0, 1, 2].map((i) => chunk.origin[i]! + numbers[vertex * 4 + i]!);
    const upper = (vertex: number): number[] => {
        const [x, y, z] = lower(vertex) as [number, number, number];
        return [x + lean[vertex * 2]!, y + lean[vertex * 2 + 1]!, z + height];
    };
    for (let vertex = 1; vertex < count; vertex++) {
        const kind = kindOf(words[vertex * 4 + 3]!);
        if (kind !== straight && kind !== round) continue;
        const [a, b, c, d] = [lower(vertex - 1), lower(vertex), upper(vertex), upper(vertex - 1)];
        corners.push(...a, ...b, ...c, ...a, ...c, ...d);
    }
    return Float32Array.from(corners);
}

/** Round an arc the wire keeps its way across the path: what it leans at the end, turned back as far as the path turns from here on. */
function turned(numbers: Float32Array, vertex: number, last: number, from: Lean, to: Lean, part: number): Lean {
    const direction = (at: number): number => Math.atan2(numbers[at * 4 + 1]! - numbers[at * 4 - 3]!, numbers[at * 4]! - numbers[at * 4 - 4]!);
    // A vertex looks half a chord further than the chord before it, as the last one does.
    const angle = vertex === last ? 0 : direction(vertex) - direction(last);
    const [begin, end] = [Math.hypot(...from), Math.hypot(...to)];
    const scale = end > 0 ? 1 + (begin / end - 1) * (1 - part) : 0;
    const [c, s] = [Math.cos(angle) * scale, Math.sin(angle) * scale];
    return [to[0] * c - to[1] * s, to[0] * s + to[1] * c];
}
