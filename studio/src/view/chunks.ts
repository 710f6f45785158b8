/** The chunks of a walk: where each is, which are seen, and the vertices of those that have come. */

import type { WalkAbout } from "../protocol/asks.ts";
import type { Projection, Size } from "./camera.ts";
import { VERTEX_BYTES } from "./strip.ts";
import type { Vector } from "./vector.ts";

const INDEX_BYTES = 64;

/** Of the lines' error in pixels: more would be seen. */
const SEEN = 0.5;

/** Vertices kept, bytes: those not drawn for longest go first. */
const KEPT = 300e6;

/** Requests at the same time. */
const REQUESTS = 6;

export interface Chunk {
    number: number;
    /** The middle of its box, mm, which the vertices count from. */
    origin: Vector;
    half: Vector;
    first: number;
}

export function readIndex(octets: ArrayBuffer): Chunk[] {
    const data = new DataView(octets);
    return Array.from({ length: Math.floor(octets.byteLength / INDEX_BYTES) }, (_, number) => {
        const at = number * INDEX_BYTES;
        const double = (i: number): number => data.getFloat64(at + i * 8, true);
        const single = (i: number): number => data.getFloat32(at + 24 + i * 4, true);
        const origin: Vector = [double(0), double(1), double(2)];
        return { number, origin, half: [single(0), single(1), single(2)], first: data.getUint32(at + 36, true) };
    });
}

/** Whether any of the chunk's box is in the picture. */
export function inSight({ origin, half }: Chunk, { right, down, at }: Projection, { width, height }: Size): boolean {
    const within = (way: Vector, offset: number, size: number): boolean => {
        const place = way[0] * origin[0] + way[1] * origin[1] + way[2] * origin[2] + offset;
        const spread = Math.abs(way[0]) * half[0] + Math.abs(way[1]) * half[1] + Math.abs(way[2]) * half[2] + 4;
        return place + spread >= 0 && place - spread <= size;
    };
    return within(right, at[0], width) && within(down, at[1], height);
}

/** The coarsest level whose error is not seen at this scale (pixels a millimetre). */
export function levelFor(levels: WalkAbout["levels"], scale: number): number {
    for (let level = levels.length - 1; level > 0; level--) {
        if (levels[level]!.error * scale <= SEEN) return level;
    }
    return 0;
}

interface Kept {
    vertices: ArrayBuffer;
    used: number;
}

export class Chunks {
    chunks: Chunk[] = [];
    private readonly kept = new Map<number, Kept>();
    private readonly wanted = new Map<number, (vertices: ArrayBuffer | null) => void>();
    private running = 0;
    private bytes = 0;
    private frame = 0;

    constructor(
        readonly walk: WalkAbout,
        private readonly octets: (path: string) => Promise<ArrayBuffer>,
        private readonly changed: () => void,
    ) {}

    async load(): Promise<void> {
        this.chunks = readIndex(await this.octets("index"));
        this.changed();
    }

    private key(level: number, chunk: number): number {
        return level * this.walk.chunks + chunk;
    }

    /** A frame begins: what the one before wished for and did not get is forgotten. */
    begin(): void {
        this.frame++;
        for (const given of this.wanted.values()) given(null);
        this.wanted.clear();
    }

    /** The vertices at this level, else at the nearest that is there; what is missing is asked for. */
    best(level: number, chunk: number): { vertices: ArrayBuffer; isExact: boolean } | null {
        const coarser = Array.from({ length: this.walk.levels.length - level }, (_, i) => level + i);
        const finer = Array.from({ length: level }, (_, i) => level - 1 - i);
        for (const other of [...coarser, ...finer]) {
            const vertices = this.take(other, chunk);
            if (vertices === null && other === level) this.want(level, chunk, () => this.changed());
            if (vertices !== null) return { vertices, isExact: other === 0 };
        }
        return null;
    }

    /** The vertices at exactly this level. */
    async exact(level: number, chunk: number): Promise<ArrayBuffer | null> {
        return this.take(level, chunk) ?? this.fetch(level, chunk);
    }

    private take(level: number, chunk: number): ArrayBuffer | null {
        const kept = this.kept.get(this.key(level, chunk));
        if (kept === undefined) return null;
        kept.used = this.frame;
        return kept.vertices;
    }

    private want(level: number, chunk: number, then: () => void): void {
        const key = this.key(level, chunk);
        if (this.wanted.has(key)) return;
        this.wanted.set(key, (vertices) => vertices !== null && then());
        void this.work();
    }

    private async work(): Promise<void> {
        if (this.running >= REQUESTS) return;
        this.running++;
        try {
            for (let next = this.wanted.entries().next(); !next.done; next = this.wanted.entries().next()) {
                const [key, given] = next.value;
                this.wanted.delete(key);
                const vertices = await this.fetch(Math.floor(key / this.walk.chunks), key % this.walk.chunks);
                given(vertices);
            }
        } finally {
            this.running--;
        }
    }

    private async fetch(level: number, chunk: number): Promise<ArrayBuffer | null> {
        try {
            const vertices = await this.octets(`${level}/${chunk}`);
            this.keep(this.key(level, chunk), vertices);
            return vertices;
        } catch {
            return null;
        }
    }

    private keep(key: number, vertices: ArrayBuffer): void {
        if (vertices.byteLength % VERTEX_BYTES !== 0) return;
        this.bytes += vertices.byteLength - (this.kept.get(key)?.vertices.byteLength ?? 0);
        this.kept.set(key, { vertices, used: this.frame });
        if (this.bytes <= KEPT) return;
        const oldest = [...this.kept].filter(([, { used }]) => used < this.frame).toSorted(([, a], [, b]) => a.used - b.used);
        for (const [old, { vertices }] of oldest) {
            if (this.bytes <= KEPT / 2) break;
            this.kept.delete(old);
            this.bytes -= vertices.byteLength;
        }
    }
}
