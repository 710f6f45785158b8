/** The chunks of a walk: where each is, which are seen, and the vertices of those that have come. */

import type { WalkAbout } from "../protocol/asks.ts";
import type { Projection, Size } from "./camera.ts";
import { readSight, type Seen } from "./sight.ts";
import { divided } from "./strip.ts";
import type { Vector } from "./vector.ts";

const INDEX_BYTES = 64;
/** A bit of the flags. */
const CROWDED = 2;

/** Of the lines' error in pixels: more would be seen. */
export const SEEN = 0.5;

/** Vertices kept, bytes: those not drawn for longest go first. */
export const KEPT = 300e6;

/** Requests at the same time. */
const REQUESTS = 6;

/** Chunks of one request, at the most. */
const TOGETHER = 64;

export interface Chunk {
    number: number;
    /** The middle of its box, mm, which the vertices count from. */
    origin: Vector;
    half: Vector;
    first: number;
    /** Its arcs are coarser than the levels say. */
    isCrowded: boolean;
}

export function readIndex(octets: ArrayBuffer): Chunk[] {
    const data = new DataView(octets);
    return Array.from({ length: Math.floor(octets.byteLength / INDEX_BYTES) }, (_, number) => {
        const at = number * INDEX_BYTES;
        const double = (i: number): number => data.getFloat64(at + i * 8, true);
        const single = (i: number): number => data.getFloat32(at + 24 + i * 4, true);
        const origin: Vector = [double(0), double(1), double(2)];
        const isCrowded = (data.getUint32(at + 60, true) & CROWDED) !== 0;
        return { number, origin, half: [single(0), single(1), single(2)], first: data.getUint32(at + 36, true), isCrowded };
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

/** The coarsest level whose error is not seen at this scale (pixels a millimetre), else the finest. */
export function levelFor({ levels }: Pick<WalkAbout, "levels">, scale: number): number {
    return Math.max(0, levels.findLastIndex(({ error }) => error * scale <= SEEN));
}

/** How far the lines of a chunk are off at a level, mm: numbers of 32 bits from its middle have 24 digits. */
export function errorOf({ half, isCrowded }: Chunk, error: number): number {
    return isCrowded ? Number.POSITIVE_INFINITY : error + Math.hypot(...half) * 2 ** -24;
}

/** Between two pictures while chunks come, ms: at the least, and for each chunk, since a picture of many takes longer. */
const BETWEEN = 60;
const BETWEEN_EACH = 0.2;

interface Kept {
    vertices: ArrayBuffer;
    used: number;
}

export interface Best {
    vertices: ArrayBuffer;
    /** They are of this level; null where that is not known. */
    level: number | null;
}

/** Where the vertices of a walk come from. */
export interface Vertices {
    readonly chunks: Chunk[];
    /** A picture begins. */
    begin(): void;
    /** Of a chunk, at the level or the nearest that is there. */
    best(level: number, chunk: number): Best | null;
    /** Of a chunk, at whatever level has come; nothing is asked for. */
    known(chunk: number): ArrayBuffer | null;
    /** At exactly this level; null where that cannot be had. */
    exact(level: number, chunk: number): Promise<ArrayBuffer | null>;
    /** What is seen in a view, asked for as `pathOf` says. */
    sight(path: string, signal: AbortSignal): Promise<Seen[]>;
}

export class Chunks implements Vertices {
    chunks: Chunk[];
    private readonly kept = new Map<number, Kept>();
    private readonly wanted = new Set<number>();
    /** What is on its way. */
    private readonly coming = new Map<number, Promise<boolean>>();
    private telling: ReturnType<typeof setTimeout> | undefined;
    /** Something has come since it was told. */
    private isNews = false;
    private running = 0;
    private bytes = 0;
    private frame = 0;

    constructor(
        readonly walk: WalkAbout,
        private readonly octets: (path: string, signal?: AbortSignal) => Promise<ArrayBuffer>,
        private readonly changed: () => void,
        /** Of the same walk while it was proven: drawn until something better has come. */
        private readonly before: Vertices | null = null,
    ) {
        this.chunks = [...(before?.chunks ?? [])];
    }

    async load(): Promise<void> {
        this.chunks = readIndex(await this.octets("index"));
        this.changed();
    }

    /** At once, and then now and then: a picture for each of many chunks that come would hold them up. */
    private tell(): void {
        if (this.telling !== undefined) {
            this.isNews = true;
            return;
        }
        this.isNews = false;
        this.changed();
        this.telling = setTimeout(() => {
            this.telling = undefined;
            if (this.isNews) this.tell();
        }, Math.max(BETWEEN, BETWEEN_EACH * this.walk.chunks));
    }

    private key(level: number, chunk: number): number {
        return level * this.walk.chunks + chunk;
    }

    /** A frame begins: what the one before wished for and did not get is forgotten. */
    begin(): void {
        this.frame++;
        this.wanted.clear();
    }

    /** The vertices at this level, else at the nearest that is there; what is missing is asked for. */
    best(level: number, chunk: number): Best | null {
        const vertices = this.take(level, chunk);
        if (vertices !== null) return { vertices, level };
        this.want(this.key(level, chunk));
        return this.nearest(level, chunk) ?? this.before?.best(level, chunk) ?? null;
    }

    known(chunk: number): ArrayBuffer | null {
        return this.nearest(0, chunk)?.vertices ?? this.before?.known(chunk) ?? null;
    }

    private nearest(level: number, chunk: number): Best | null {
        const coarser = Array.from({ length: this.walk.levels.length - level }, (_, i) => level + i);
        const finer = Array.from({ length: level }, (_, i) => level - 1 - i);
        for (const other of [...coarser, ...finer]) {
            const vertices = this.take(other, chunk);
            if (vertices !== null) return { vertices, level: other };
        }
        return null;
    }

    async sight(path: string, signal: AbortSignal): Promise<Seen[]> {
        return readSight(await this.octets(`sight/${path}`, signal));
    }

    /** The vertices at exactly this level. */
    async exact(level: number, chunk: number): Promise<ArrayBuffer | null> {
        const kept = this.take(level, chunk);
        if (kept !== null) return kept;
        await (this.coming.get(this.key(level, chunk)) ?? this.fetch(level, chunk, chunk + 1));
        return this.take(level, chunk);
    }

    private take(level: number, chunk: number): ArrayBuffer | null {
        const kept = this.kept.get(this.key(level, chunk));
        if (kept === undefined) return null;
        kept.used = this.frame;
        return kept.vertices;
    }

    private want(key: number): void {
        if (this.coming.has(key)) return;
        // When all that a picture wants is known.
        if (this.wanted.size === 0) queueMicrotask(() => this.workAll());
        this.wanted.add(key);
    }

    private workAll(): void {
        for (let request = 0; request < REQUESTS; request++) void this.work();
    }

    private async work(): Promise<void> {
        if (this.running >= REQUESTS) return;
        this.running++;
        try {
            for (let run = this.run(); run !== null; run = this.run()) {
                const { level, from, to } = run;
                if (await this.fetch(level, from, to)) this.tell();
            }
        } finally {
            this.running--;
        }
    }

    /** Chunks that are wanted, one behind the other. */
    private run(): { level: number; from: number; to: number } | null {
        const [first] = this.wanted;
        if (first === undefined) return null;
        const level = Math.floor(first / this.walk.chunks);
        const from = first % this.walk.chunks;
        let to = from;
        while (to < this.walk.chunks && to - from < TOGETHER && this.wanted.delete(this.key(level, to))) to++;
        return { level, from, to };
    }

    /** Fetches chunks of one level; whether any has come. */
    private fetch(level: number, from: number, to: number): Promise<boolean> {
        const come = this.get(level, from, to).then((got) => {
            got.forEach((vertices, i) => this.keep(this.key(level, from + i), vertices));
            return got.length > 0;
        }, () => false);
        const keys = Array.from({ length: to - from }, (_, i) => this.key(level, from + i));
        for (const key of keys) this.coming.set(key, come);
        return come.finally(() => {
            for (const key of keys) this.coming.delete(key);
        });
    }

    /** The vertices of chunks: the server may give fewer than were asked for. */
    private async get(level: number, from: number, to: number): Promise<ArrayBuffer[]> {
        const octets = await this.octets(`${level}/${from}-${to}`);
        const data = new DataView(octets);
        const counts = Array.from({ length: data.getUint32(0, true) }, (_, i) => data.getUint32(4 + 4 * i, true));
        return divided(octets, 4 + 4 * counts.length, counts);
    }

    private keep(key: number, vertices: ArrayBuffer): void {
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
