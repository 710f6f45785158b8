/** The box of what is cut and of the rapids about it: home, and the ways from there and back, are left out. */

import type { WalkAbout } from "../protocol/asks.ts";
import type { Box } from "./camera.ts";
import type { Chunk, Vertices } from "./chunks.ts";
import { kindOf } from "./strip.ts";
import { along, type Vector } from "./vector.ts";

const CUTS = new Set(["feed", "arc", "pulse"]);

/** How far rapids may lead away from the cuts and still be about them, as a part of the cuts' size. */
const ABOUT = 0.5;

export interface Cuts {
    /** Null where nothing is cut. */
    box: Box | null;
    /** All vertices are known: nothing that comes changes it. */
    isWhole: boolean;
    /** Numbers of the kinds of moves that there are. */
    kinds: Set<number>;
}

/** Chunks whose vertices have not come count as a whole. */
export function cutsOf({ kinds, chunks }: Pick<WalkAbout, "kinds" | "chunks">, vertices: Vertices): Cuts {
    const isCut = kinds.map((kind) => CUTS.has(kind));
    const box = nothing();
    const seen = new Set<number>();
    // The chunks are known when their index has come.
    let isWhole = vertices.chunks.length >= chunks;
    for (const chunk of vertices.chunks) {
        const octets = vertices.known(chunk.number);
        if (octets === null) {
            isWhole = false;
            grow(box, along(chunk.origin, chunk.half, -1));
            grow(box, along(chunk.origin, chunk.half, 1));
        } else eachMove(chunk, octets, (kind, from, to) => {
            seen.add(kind);
            if (isCut[kind] !== true) return;
            grow(box, from);
            grow(box, to);
        });
    }
    if (box.low[0] > box.high[0]) return { box: null, isWhole, kinds: seen };
    const size = Math.max(...box.high.map((high, i) => high - box.low[i]!));
    const about: Box = { low: along(box.low, [1, 1, 1], -size * ABOUT), high: along(box.high, [1, 1, 1], size * ABOUT) };
    const all: Box = { low: [...box.low], high: [...box.high] };
    for (const chunk of vertices.chunks) {
        const octets = vertices.known(chunk.number);
        if (octets !== null) eachMove(chunk, octets, (_, __, to) => isWithin(about, to) && grow(all, to));
    }
    return { box: all, isWhole, kinds: seen };
}

/** Calls `see` with the kind and both ends of each line. */
function eachMove({ origin: [x, y, z] }: Chunk, octets: ArrayBuffer, see: (kind: number, from: Vector, to: Vector) => void): void {
    const numbers = new Float32Array(octets);
    const words = new Uint32Array(octets);
    let [from, to]: [Vector, Vector] = [[0, 0, 0], [0, 0, 0]];
    for (let i = 0; i + 3 < numbers.length; i += 4) {
        [from, to] = [to, from];
        to[0] = x + numbers[i]!;
        to[1] = y + numbers[i + 1]!;
        to[2] = z + numbers[i + 2]!;
        // The first vertex only begins.
        if (i > 0) see(kindOf(words[i + 3]!), from, to);
    }
}

const nothing = (): Box => ({ low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] });

const isWithin = ({ low, high }: Box, [x, y, z]: Vector): boolean =>
    x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1] && z >= low[2] && z <= high[2];

/** Round a point too. */
export function grow({ low, high }: Box, point: Vector): void {
    for (let i = 0; i < 3; i++) {
        if (point[i]! < low[i]!) low[i] = point[i]!;
        if (point[i]! > high[i]!) high[i] = point[i]!;
    }
}
