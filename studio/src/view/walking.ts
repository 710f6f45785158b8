/** What a proof that still runs has walked: it comes chunk by chunk, as fine as can be drawn, and is gone when the proof ends. */

import type { WalkAbout, Walked } from "../protocol/asks.ts";
import type { Arrays } from "../protocol/frames.ts";
import type { Box } from "./camera.ts";
import { readIndex, type Best, type Chunk, type Vertices } from "./chunks.ts";
import { VERTEX_BYTES } from "./strip.ts";
import { along } from "./vector.ts";

export class Walking implements Vertices {
    readonly chunks: Chunk[] = [];
    private readonly vertices: ArrayBuffer[] = [];
    moves = 0;

    constructor(
        /** Name of the program: of several that are proven at the same time, the first is shown. */
        readonly file: string,
        private readonly kinds: string[],
    ) {}

    /** Whether there is more than before. */
    add(walked: Walked, { index, vertices }: Arrays): boolean {
        if (walked.file !== this.file || walked.chunk !== this.chunks.length || index === undefined || vertices === undefined) return false;
        const octets = new Uint8Array(index);
        const sizes = new DataView(octets.buffer);
        let at = 0;
        for (const [number, chunk] of readIndex(octets.buffer).entries()) {
            const bytes = sizes.getUint32(number * 64 + 48, true) * VERTEX_BYTES;
            this.chunks.push({ ...chunk, number: this.chunks.length });
            this.vertices.push(new Uint8Array(vertices.subarray(at, at + bytes)).buffer);
            at += bytes;
        }
        this.moves = walked.moves;
        return true;
    }

    begin(): void {}

    best(_: number, chunk: number): Best | null {
        const vertices = this.vertices[chunk];
        return vertices === undefined ? null : { vertices, level: null };
    }

    known(chunk: number): ArrayBuffer | null {
        return this.vertices[chunk] ?? null;
    }

    exact(): Promise<null> {
        return Promise.resolve(null);
    }

    sight(): Promise<never> {
        return Promise.reject(new Error("the proof runs"));
    }

    /** A walk of which nothing more is known. */
    get walk(): WalkAbout {
        return {
            moves: this.moves, left_out: 0, chunks: this.chunks.length, levels: [{ error: 0, vertices: 0 }], box: null, time_s: 0,
            tools: [], operations: [], kinds: this.kinds, row: 20, deviation: null, jumps: [], jumps_in_all: 0, excursions: [], excursions_in_all: 0, mismatch: null,
        };
    }

    get box(): Box | null {
        const [first] = this.chunks;
        if (first === undefined) return null;
        const box = { low: along(first.origin, first.half, -1), high: along(first.origin, first.half, 1) };
        for (const { origin, half } of this.chunks) {
            for (let i = 0; i < 3; i++) {
                box.low[i] = Math.min(box.low[i]!, origin[i]! - half[i]!);
                box.high[i] = Math.max(box.high[i]!, origin[i]! + half[i]!);
            }
        }
        return box;
    }
}
