import { expect, test } from "vitest";
import type { Chunk, Vertices } from "../src/view/chunks.ts";
import { cutsOf } from "../src/view/cuts.ts";
import { wordOf } from "../src/view/strip.ts";

const KINDS = ["gap", "rapid", "feed", "arc", "joints"];
const walk = { kinds: KINDS, chunks: 1 };

type Point = [x: number, y: number, z: number, kind: string];

/** Chunks of vertices from an origin at X100; null: they have not come. */
function given(...all: (Point[] | null)[]): Vertices {
    const chunks = all.map((_, number): Chunk => ({ number, origin: [100, 0, 0], half: [7, 7, 7], first: number * 4096, isCrowded: false }));
    const octets = all.map((points) => {
        if (points === null) return null;
        const made = new ArrayBuffer(points.length * 16);
        points.forEach(([x, y, z, kind], i) => {
            new Float32Array(made).set([x, y, z], i * 4);
            new Uint32Array(made)[i * 4 + 3] = wordOf(i, KINDS.indexOf(kind), 0);
        });
        return made;
    });
    return { chunks, begin: () => {}, best: () => null, exact: () => Promise.resolve(null), sight: () => Promise.resolve([]), known: (chunk) => octets[chunk]! };
}

test("home, also in the midst for another tool, and the ways there are left out; rapids about the cuts are not", () => {
    const one: Point[] = [[0, 0, 900, "gap"], [0, 0, 50, "joints"], [1, 0, 2, "rapid"], [1, 0, -1, "feed"], [1, 5, -1, "feed"], [1, 5, 3, "rapid"], [0, 0, 900, "joints"]];
    const two: Point[] = [[0, 0, 900, "joints"], [9, 5, 6, "rapid"], [9, 5, -1, "feed"], [11, 5, -1, "arc"], [11, 5, 800, "rapid"]];
    // The cuts go from X1 to 11, Y0 to 5, Z-1 to 6, and begin at a rapid's end.
    expect(cutsOf(walk, given(one, two))).toEqual({ box: { low: [101, 0, -1], high: [111, 5, 6] }, isWhole: true, kinds: expect.any(Set) });
});

test("a chunk whose vertices have not come counts as a whole", () => {
    expect(cutsOf(walk, given([[0, 0, 0, "gap"], [1, 1, 1, "feed"]], null))).toEqual({ box: { low: [93, -7, -7], high: [107, 7, 7] }, isWhole: false, kinds: new Set([2]) });
});

test("before the chunks are known nothing is", () => {
    expect(cutsOf({ ...walk, chunks: 2 }, given([[0, 0, 0, "gap"], [1, 1, 1, "feed"]])).isWhole).toBe(false);
    expect(cutsOf(walk, given()).isWhole).toBe(false);
});

test("where nothing is cut there is no box", () => {
    expect(cutsOf(walk, given([[0, 0, 0, "gap"], [1, 1, 1, "rapid"]]))).toEqual({ box: null, isWhole: true, kinds: expect.any(Set) });
});
