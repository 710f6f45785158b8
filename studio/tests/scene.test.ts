import { describe, expect, test, vi } from "vitest";
import type { WalkAbout } from "../src/protocol/asks.ts";
import { Blocks } from "../src/view/blocks.ts";
import { project, VIEWS } from "../src/view/camera.ts";
import { Chunks, inSight, levelFor, readIndex, type Vertices } from "../src/view/chunks.ts";
import { MARKED, theme } from "../src/view/colours.ts";
import { Raster } from "../src/view/raster.ts";
import { Painting } from "../src/view/renderer.ts";
import type { Rows } from "../src/view/rows.ts";
import { Scene, type Looks, type Marks } from "../src/view/scene.ts";
import { Sights } from "../src/view/sight.ts";
import { Style, wordOf } from "../src/view/strip.ts";

/** Buffers are alike when their bytes are: vitest by itself compares nothing of them. */
expect.addEqualityTesters([
    (a: unknown, b: unknown) => (a instanceof ArrayBuffer && b instanceof ArrayBuffer ? Buffer.from(a).equals(Buffer.from(b)) : undefined),
]);

const size = { width: 100, height: 50 };
const above = project({ ...VIEWS[0]!, middle: [0, 0, 0], scale: 1 }, size);

test("the index of a chunk is read as the server writes it", () => {
    const data = new DataView(new ArrayBuffer(128));
    [1.5, -2.5, 3.5].forEach((value, i) => data.setFloat64(64 + i * 8, value, true));
    [10, 20, 30].forEach((value, i) => data.setFloat32(64 + 24 + i * 4, value, true));
    data.setUint32(64 + 36, 4096, true);
    expect(readIndex(data.buffer)[1]).toEqual({ number: 1, origin: [1.5, -2.5, 3.5], half: [10, 20, 30], first: 4096, isCrowded: false });
});

test("a chunk is in sight as soon as a corner of its box is", () => {
    const at = (x: number) => ({ number: 0, origin: [x, 0, 0] as [number, number, number], half: [10, 1, 1] as [number, number, number], first: 0, isCrowded: false });
    // The window reaches 50 mm to each side; 4 pixels are left for wide lines.
    expect([0, 59, 65, -59, -65].map((x) => inSight(at(x), above, size))).toEqual([true, true, false, true, false]);
});

test("the coarsest level whose error is at most half a pixel", () => {
    const levels = [0.002, 0.008, 0.032].map((error) => ({ error, vertices: 1 }));
    expect([1, 15, 16, 62, 63, 1000].map((scale) => levelFor({ levels }, scale))).toEqual([2, 2, 1, 1, 0, 0]);
});

const walk: WalkAbout = {
    moves: 4097, left_out: 0, chunks: 2, levels: [{ error: 0, vertices: 9 }, { error: 0.01, vertices: 4 }], box: null, time_s: 1,
    tools: [], operations: [], kinds: ["rapid", "feed", "gap"], row: 16, mismatch: null, deviation: null, jumps: [], jumps_in_all: 0, excursions: [], excursions_in_all: 0,
};

/** Points and words. */
function vertices(...points: [x: number, y: number, move: number, kind: number][]): ArrayBuffer {
    const made = new ArrayBuffer(points.length * 16);
    points.forEach(([x, y, move, kind], i) => {
        new Float32Array(made).set([x, y, 0], i * 4);
        new Uint32Array(made)[i * 4 + 3] = wordOf(move, kind, 0);
    });
    return made;
}

/** What a server answers that has these: an index, or chunks of a level behind the numbers of their vertices. */
function answer(has: Record<string, ArrayBuffer>, path: string): ArrayBuffer {
    if (path === "index") return has.index!;
    if (path.startsWith("sight/")) return has.sight!;
    const [, level, from, to] = /^(\w+)\/(\d+)-(\d+)$/.exec(path)!;
    const parts = Array.from({ length: Number(to) - Number(from) }, (_, i) => new Uint8Array(has[`${level}/${Number(from) + i}`]!));
    const sizes = new Uint8Array(Uint32Array.from([parts.length, ...parts.map((part) => part.length / 16)]).buffer);
    return Uint8Array.from([...sizes, ...parts.flatMap((part) => [...part])]).buffer;
}

const index = new DataView(new ArrayBuffer(128));
for (const chunk of [0, 1]) {
    [50, 25, 1].forEach((half, i) => index.setFloat32(chunk * 64 + 24 + i * 4, half, true));
    index.setUint32(chunk * 64 + 36, chunk * 4096, true);
}

const server: Record<string, ArrayBuffer> = {
    index: index.buffer,
    // Coarse: one line for moves 0 to 2; exact: three of them, the middle one a way that is not known.
    "1/0": vertices([-40, 0, 0, 1], [40, 0, 2, 1]),
    "0/0": vertices([-40, 0, 0, 1], [-10, 0, 0, 1], [10, 0, 1, 2], [40, 0, 2, 1]),
    "0/1": vertices([40, 0, 0, 0], [40, 20, 0, 0]),
    "1/1": vertices([40, 0, 0, 0], [40, 20, 0, 0]),
};

async function scene(): Promise<Scene> {
    const chunks = new Chunks(walk, async (path) => answer(server, path), () => {});
    await chunks.load();
    return new Scene(walk, chunks, {} as Rows);
}

const looks: Looks = { mode: "kind", width: 1, rapids: true, axes: false, theme: theme(false) };
const marks: Marks = { now: null, pale: false, ofBlock: [], mismatch: null, tool: null, bodies: [] };
const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

test("what has not come is asked for, and what is there is drawn meanwhile", async () => {
    const one = await scene();
    expect(one.picture(above, size, looks, marks).strips).toEqual([]);
    await settled();
    expect(one.picture(above, size, looks, marks).strips.map(({ vertices }) => vertices)).toEqual([server["1/0"], server["1/1"]]);
    const near = { ...above, scale: 1000 };
    expect(one.picture(near, size, looks, marks).strips[0]!.vertices).toEqual(server["1/0"]);
    await settled();
    expect(one.picture(near, size, looks, marks).strips[0]!.vertices).toEqual(server["0/0"]);
});

test("a chunk that is on its way is not asked for again, and what was walked before is drawn until it has come", async () => {
    const asked: string[] = [];
    const before = { chunks: [], best: () => ({ vertices: server["1/0"]!, level: null }) } as unknown as Vertices;
    const octets = async (path: string) => {
        asked.push(path);
        await settled();
        return answer(server, path);
    };
    const chunks = new Chunks(walk, octets, () => {}, before);
    await chunks.load();
    const one = new Scene(walk, chunks, {} as Rows);
    for (let frame = 0; frame < 3; frame++) {
        chunks.begin();
        const { strips, off } = one.picture(above, size, looks, marks);
        expect(strips.map(({ vertices }) => vertices)).toEqual([server["1/0"], server["1/0"]]);
        // How coarse what was walked is nobody knows.
        expect(off).toBe(Number.POSITIVE_INFINITY);
    }
    await settled();
    await settled();
    expect(asked).toEqual(["index", "1/0-2"]);
    const { strips, off } = one.picture(above, size, looks, marks);
    expect([strips.map(({ vertices }) => vertices), off]).toEqual([[server["1/0"], server["1/1"]], 0]);
});

test("what was walked is drawn before anything of the job has come", async () => {
    const known = new Chunks(walk, async (path) => answer(server, path), () => {});
    await known.load();
    const before = { chunks: known.chunks.slice(0, 1), best: () => ({ vertices: server["1/0"]!, level: null }) } as unknown as Vertices;
    const chunks = new Chunks(walk, () => new Promise(() => {}), () => {}, before);
    const one = new Scene(walk, chunks, {} as Rows);
    expect(one.picture(above, size, looks, marks).strips.map(({ vertices }) => vertices)).toEqual([server["1/0"]]);
});

test("what is wanted comes in few answers, also where the server gives fewer chunks than were asked for; of those that come soon behind the first there is one picture", async () => {
    let told = 0;
    const asked: string[] = [];
    const octets = async (path: string) => {
        asked.push(path);
        const [, from, to] = /(\d+)-(\d+)/.exec(path)!;
        const chunks = Math.min(40, Number(to) - Number(from));
        return answer(Object.fromEntries(Array.from({ length: chunks }, (_, i) => [`1/${i}`, server["1/0"]!])), `1/0-${chunks}`);
    };
    const chunks = new Chunks({ ...walk, chunks: 150 }, octets, () => told++);
    const missing = () => Array.from({ length: 150 }, (_, chunk) => chunks.best(1, chunk)).filter((best) => best === null).length;
    expect(missing()).toBe(150);
    await settled();
    expect(asked).toEqual(["1/0-64", "1/64-128", "1/128-150"]);
    expect([missing(), told]).toEqual([24 + 24, 1]);
    await settled();
    expect([missing(), asked.slice(3)]).toEqual([0, ["1/40-64", "1/104-128"]]);
    await new Promise((resolve) => setTimeout(resolve, 100));
    expect(told).toBe(2);
});

test("who waits for a chunk that is on its way gets it, without another request", async () => {
    let asked = 0;
    const chunks = new Chunks(walk, async (path) => {
        asked++;
        await settled();
        return answer(server, path);
    }, () => {});
    const both = await Promise.all([chunks.exact(0, 0), chunks.exact(0, 0)]);
    expect([both, asked]).toEqual([[server["0/0"], server["0/0"]], 1]);
});

test("a click finds the exact move below a coarse line, and nothing where nothing is", async () => {
    const one = await scene();
    one.picture(above, size, looks, marks);
    await settled();
    expect(await one.pick(above, looks, 20, 27)).toBe(0);
    expect(await one.pick(above, looks, 80, 25)).toBe(2);
    expect(await one.pick(above, looks, 90, 10)).toBe(4096);
    expect(await one.pick(above, looks, 20, 45)).toBe(null);
});

test("rapids that are hidden are not clicked", async () => {
    const one = await scene();
    one.picture(above, size, looks, marks);
    await settled();
    expect(await one.pick(above, { ...looks, rapids: false }, 90, 10)).toBe(null);
});

test("behind the cursor's move all is pale, and the moves of its block are marked over it", async () => {
    const one = await scene();
    one.picture(above, size, looks, marks);
    await settled();
    await one.chunks.exact(0, 0);
    const near = { ...above, scale: 1000 };
    one.picture(near, size, looks, marks);
    await settled();
    const { strips, over } = one.picture(near, size, looks, { ...marks, now: 0, pale: true, ofBlock: [[2, 3]] });
    const first = [...strips, ...over].filter((strip) => strip.first === 0).map(({ from, to, paint }) => [from, to, paint.palette]);
    const { done, ahead } = looks.theme;
    const mark = new Uint32Array([done[MARKED]!]);
    expect(first).toEqual([[1, 2, done], [2, 4, ahead], [3, 4, mark], [1, 2, mark]]);
    const raster = new Raster(size.width, size.height);
    raster.clear(0);
    for (const strip of [...strips, ...over]) raster.strip(strip, above);
    expect([20, 50, 80].map((x) => raster.seen[25 * 100 + x])).toEqual([done[MARKED], 0, done[MARKED]]);
});

test("while the cursor moves, only what is marked is drawn anew; the picture is as if all were", async () => {
    const one = await scene();
    one.picture(above, size, looks, marks);
    await settled();
    const painting = new Painting(size.width, size.height);
    const drawn = vi.spyOn(Raster.prototype, "strip");
    const draw = (on: Painting, now: number, by = looks) => on.draw(one.picture(above, size, by, { ...marks, now }), above, 7).slice();
    const first = draw(painting, 0);
    expect(drawn).toHaveBeenCalledTimes(3);
    // A click looks for its move in planes of its own, and leaves the lines as they were.
    expect(await one.pick(above, looks, 80, 25)).toBe(2);
    drawn.mockClear();
    const second = draw(painting, 4096);
    expect(drawn).toHaveBeenCalledTimes(1);
    expect(second).not.toEqual(first);
    expect(second).toEqual(draw(new Painting(size.width, size.height), 4096));
    drawn.mockClear();
    draw(painting, 4096, { ...looks, width: 2 });
    expect(drawn).toHaveBeenCalledTimes(3);
    drawn.mockRestore();
});

test("where more is in sight than can be kept, the next level is drawn, and the picture says how far its lines may be off", async () => {
    const within = async (vertices: number): Promise<Scene> => {
        const levels = [{ error: 0.1, vertices }, { error: 3, vertices: 4 }];
        const chunks = new Chunks({ ...walk, levels }, async (path) => answer(server, path), () => {});
        await chunks.load();
        for (const level of [0, 1]) for (const chunk of [0, 1]) await chunks.exact(level, chunk);
        return new Scene({ ...walk, levels }, chunks, {} as Rows);
    };
    // A pixel a millimetre; 150 MB are 9.4 million vertices.
    const few = (await within(9e6)).picture(above, size, looks, marks);
    expect([few.strips[0]!.vertices, few.off]).toEqual([server["0/0"], 0]);
    const many = (await within(10e6)).picture(above, size, looks, marks);
    expect(many.strips[0]!.vertices).toEqual(server["1/0"]);
    // And what numbers of 32 bits lose 56 mm from the middle: 56 / 2²⁴.
    expect(many.off).toBeCloseTo(3 + 56 / 2 ** 24, 6);
});

describe("where the levels are too coarse", () => {
    const levels = [{ error: 0.01, vertices: 9 }, { error: 0.04, vertices: 4 }];
    // A line of move 4097 across the window, and half of it as move 4096 below, in pixels.
    const line = vertices([0, 10, 0, 0], [100, 10, 1, 1]);
    const sight = Uint8Array.from([...new Uint8Array(Uint32Array.from([1, 1, 2]).buffer), ...new Uint8Array(line)]).buffer;
    const near = project({ ...VIEWS[0]!, middle: [0, 0, 0], scale: 1000 }, size);

    async function within(index: ArrayBuffer, asked: string[], fails = false): Promise<Scene> {
        const octets = async (path: string) => {
            asked.push(path);
            if (fails && path.startsWith("sight/")) throw new Error("gone");
            return answer({ ...server, index, sight }, path);
        };
        const chunks = new Chunks({ ...walk, levels }, octets, () => {});
        await chunks.load();
        for (const chunk of [0, 1]) await chunks.exact(0, chunk);
        asked.length = 0;
        return new Scene({ ...walk, levels }, chunks, {} as Rows);
    }

    test("what is seen is asked for when the view rests, once, and is drawn in its pixels and clicked", async () => {
        const asked: string[] = [];
        const one = await within(server.index!, asked);
        let news = 0;
        const sights = new Sights(() => news++);
        // The view turns: only the last one is asked for.
        one.picture({ ...near, at: [1, 2, 3] }, size, looks, marks, sights);
        const before = one.picture(near, size, looks, marks, sights);
        expect([before.strips[0]!.vertices, before.off > 10]).toEqual([server["0/0"], true]);
        await expect.poll(() => news).toBe(1);
        const rounded = asked.map((path) => path.replaceAll(/-?[\d.]+e-\d+/g, "0"));
        expect(rounded).toEqual(["sight/100,50/1000,0,0,0,-1000,0,0,0,-1000,50,25,0/0/all"]);
        const { strips, off } = one.picture(near, size, looks, marks, sights);
        expect([strips.map(({ vertices }) => vertices), off]).toEqual([[line], 0]);
        const raster = new Raster(size.width, size.height);
        raster.clear(7);
        for (const strip of strips) raster.strip(strip, near);
        expect([9, 10, 11].map((row) => raster.seen.slice(row * 100, row * 100 + 100).filter((seen) => seen !== 7).length)).toEqual([0, 100, 0]);
        expect(await one.pick(near, looks, 70, 12, sights)).toBe(4097);
        expect(await one.pick(near, looks, 70, 40, sights)).toBe(null);
        expect(asked.length).toBe(1);
    });

    test("a chunk whose arcs are coarser than its levels say is such a case at any scale, and its finer levels are not asked for", async () => {
        const crowded = new DataView(server.index!.slice(0));
        crowded.setUint32(60, 2, true);
        const asked: string[] = [];
        const one = await within(crowded.buffer, asked, true);
        const sights = new Sights(() => {});
        const there = project({ ...VIEWS[0]!, middle: [0, 0, 0], scale: 20 }, size);
        expect(one.picture(there, size, looks, marks, sights).off).toBe(Number.POSITIVE_INFINITY);
        await expect.poll(() => asked.toSorted()).toEqual(["1/0-1", expect.stringMatching(/^sight/)]);
        // It cannot be had: nothing is asked for again, and the picture says so.
        await settled();
        expect(one.picture(there, size, looks, marks, sights).off).toBe(Number.POSITIVE_INFINITY);
        await new Promise((resolve) => setTimeout(resolve, 150));
        expect(asked.length).toBe(2);
    });

    test("a move that is picked out is drawn by its own lines, also where at a coarse level others stand for it", async () => {
        const asked: string[] = [];
        const chunks = new Chunks(walk, async (path) => {
            asked.push(path);
            return answer({ ...server, sight }, path);
        }, () => {});
        await chunks.load();
        for (const chunk of [0, 1]) await chunks.exact(1, chunk);
        const one = new Scene(walk, chunks, {} as Rows);
        const sights = new Sights(() => {});
        const marked = { ...marks, now: 1, ofBlock: [[1, 2], [4096, 4097]] as [number, number][] };
        const over = () => one.picture(above, size, looks, marked, sights).over.map(({ vertices }) => vertices);
        expect(over()).toEqual([server["1/0"], server["1/1"], server["1/0"]]);
        await expect.poll(() => asked.filter((path) => path.startsWith("sight")).map((path) => path.split("/").at(-1))).toEqual(["1-2,4096-4097", "1-2"]);
        await settled();
        expect(over()).toEqual([line, line]);
    });
});

describe("pulses in a block of glass", () => {
    const sides: [[number, number, number], [number, number, number], [number, number, number]] = [[4, 0, 0], [0, 3, 0], [0, 0, 2]];
    const blocks = new Blocks([{ corner: [0, 0, 0], sides }, { corner: [10, 0, 0], sides }]);
    const pulses: WalkAbout = { ...walk, kinds: ["gap", "pulse"] };

    async function within(levels: WalkAbout["levels"]): Promise<Scene> {
        const chunks = new Chunks({ ...pulses, levels }, async (path) => answer(server, path), () => {});
        await chunks.load();
        for (const level of [0, 1]) for (const chunk of [0, 1]) await chunks.exact(level, chunk);
        return new Scene({ ...pulses, levels }, chunks, {} as Rows, null, blocks);
    }

    test("are dots, also where they are picked out, and the blocks are their twelve edges each, which are no moves", async () => {
        const one = await within(walk.levels);
        const { strips, over } = one.picture(above, size, looks, { ...marks, now: 1 });
        expect(strips[0]!.paint.styles[1]).toBe(Style.dot);
        expect(over[0]!.paint.styles[1]).toBe(Style.dot);
        const edges = strips.at(-1)!;
        expect(edges.vertices.byteLength).toBe(2 * 12 * 2 * 16);
        const lengths = Array.from({ length: 24 }, (_, edge) => {
            const ends = new Float32Array(edges.vertices);
            return Math.hypot(...[0, 1, 2].map((axis) => ends[edge * 8 + 4 + axis]! - ends[edge * 8 + axis]!));
        });
        expect(lengths.toSorted()).toEqual([2, 3, 4].flatMap((length) => Array.from({ length: 8 }, () => length)));
        expect(edges.first).toBe(-1);
        expect(blocks.box).toEqual({ low: [0, 0, 0], high: [14, 3, 2] });
        expect(await one.pick(above, looks, 55, 50)).toBe(null);
    });

    test("come at a coarser level where too many are in sight", async () => {
        const few = await within([{ error: 0.1, vertices: 1e6 }, { error: 9, vertices: 4 }]);
        expect(few.picture(above, size, looks, marks).strips[0]!.vertices.byteLength).toBe(4 * 16);
        const many = await within([{ error: 0.1, vertices: 4e6 }, { error: 9, vertices: 4 }]);
        expect(many.picture(above, size, looks, marks).strips[0]!.vertices.byteLength).toBe(2 * 16);
    });
});
