import { expect, test } from "vitest";
import type { Walked } from "../src/protocol/asks.ts";
import { Walking } from "../src/view/walking.ts";

const walked = (more: Partial<Walked>): Walked => ({ event: "walked", id: 1, file: "a.nc", chunk: 0, moves: 0, time_s: 0, kinds: ["rapid"], ...more });

/** Chunks at x, with so many vertices; each vertex has the number of its chunk for x. */
function arrays(...chunks: [x: number, vertices: number][]) {
    const index = new DataView(new ArrayBuffer(chunks.length * 64));
    chunks.forEach(([x, vertices], i) => {
        index.setFloat64(i * 64, x, true);
        index.setFloat32(i * 64 + 24, 5, true);
        index.setUint32(i * 64 + 48, vertices, true);
    });
    const numbers = chunks.flatMap(([x, vertices]) => Array.from({ length: vertices * 4 }, () => x));
    return { index: new Uint8Array(index.buffer), vertices: new Uint8Array(Float32Array.from(numbers).buffer) };
}

test("chunks that come are put behind those that are there, each with its vertices", () => {
    const walking = new Walking("a.nc", ["rapid"]);
    expect(walking.box).toBe(null);
    expect(walking.add(walked({ moves: 8192 }), arrays([10, 2], [20, 3]))).toBe(true);
    expect(walking.add(walked({ chunk: 2, moves: 8200 }), arrays([-30, 1]))).toBe(true);
    expect(walking.chunks.map(({ number, origin }) => [number, origin[0]])).toEqual([[0, 10], [1, 20], [2, -30]]);
    expect([0, 1, 2].map((chunk) => [...new Float32Array(walking.best(0, chunk)!.vertices)])).toEqual([Array(8).fill(10), Array(12).fill(20), Array(4).fill(-30)]);
    expect([walking.walk.moves, walking.walk.chunks]).toEqual([8200, 3]);
    expect([walking.box!.low[0], walking.box!.high[0]]).toEqual([-35, 25]);
});

test("what belongs to another program, or leaves a gap, is not taken", () => {
    const walking = new Walking("a.nc", ["rapid"]);
    expect(walking.add(walked({ file: "b.nc" }), arrays([1, 1]))).toBe(false);
    expect(walking.add(walked({ chunk: 1 }), arrays([1, 1]))).toBe(false);
    expect(walking.chunks).toEqual([]);
});
