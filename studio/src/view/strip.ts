/** Lines of one chunk as both renderers draw them. A vertex is x, y, z (f32 from the origin) and a word of what it belongs to. */

import type { Projection } from "./camera.ts";
import type { Vector } from "./vector.ts";

export const VERTEX_BYTES = 16;
export const CHUNK_MOVES = 4096;

export const moveOf = (word: number): number => word & 4095;
export const kindOf = (word: number): number => (word >>> 12) & 15;
export const toolOf = (word: number): number => (word >>> 16) & 255;
export const marksOf = (word: number): number => word >>> 24;
export const wordOf = (move: number, kind: number, tool: number, marks = 0): number =>
    (move | (kind << 12) | (tool << 16) | (marks << 24)) >>> 0;

/** The vertices of several chunks, which are one behind the other from a byte on, so many of each. */
export function divided(octets: ArrayBuffer, from: number, counts: number[]): ArrayBuffer[] {
    let at = from;
    return counts.map((count) => {
        const begin = at;
        at += count * VERTEX_BYTES;
        return octets.slice(begin, at);
    });
}

/** How a kind of move is drawn. */
export const Style = { line: 0, dashed: 1, hidden: 2, dot: 3 } as const;

/** How lines get their colours: by a table of the chunk's moves, or by bits of the vertex's word. */
export interface Paint {
    /** Red, green, blue, alpha in the order of the bytes. */
    palette: Uint32Array;
    byMove: Uint8Array | null;
    shift: number;
    mask: number;
    /** Style of each kind. */
    styles: Uint8Array;
    /** Colour in the palette of what is dashed, whatever else it is; -1: that of the others. */
    dashed: number;
    width: number;
    /** Place of the only tool whose lines are drawn; -1: all. */
    tool: number;
    /** Ends are round, and the width is exact: what a round tool covers. */
    round: boolean;
    /** Pixels that the lines are nearer than they are, to lie on top of the same lines. */
    lift: number;
}

/** A polyline: the segment that ends at a vertex, or the dot at it, belongs to the vertex's move. */
export interface Strip {
    vertices: ArrayBuffer;
    origin: Vector;
    /** Number of the chunk's first move. */
    first: number;
    /** The segments that end at the vertices from `from` to before `to`; never 0, which only begins. */
    from: number;
    to: number;
    paint: Paint;
    /** How the vertices are projected, where not as the picture is: those of a sight are in its pixels. */
    frame?: Projection | undefined;
}

export interface Triangles {
    /** x, y, z of each corner. */
    corners: Float32Array;
    colour: [number, number, number];
}

/** The first vertex of a move not before `move` (in the chunk): vertices are in the order of the moves. */
export function vertexOf(vertices: ArrayBuffer, move: number): number {
    const words = new Uint32Array(vertices);
    let [low, high] = [1, words.length / 4];
    while (low < high) {
        const middle = (low + high) >>> 1;
        if (moveOf(words[middle * 4 + 3]!) < move) low = middle + 1;
        else high = middle;
    }
    return low;
}
