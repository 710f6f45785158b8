import { expect, test } from "vitest";
import type { Chunk } from "../src/view/chunks.ts";
import { RAMP, RAMP_STEPS, UNKNOWN } from "../src/view/colours.ts";
import { needlesOf } from "../src/view/needles.ts";
import { byDeviation, byFeed, byOperation, byOrder } from "../src/view/painted.ts";
import type { Rows } from "../src/view/rows.ts";
import { wordOf } from "../src/view/strip.ts";

const chunk = (number: number): Chunk => ({ number, origin: [0, 0, 0], half: [1, 1, 1], first: number * 4096, isCrowded: false });
const operation = (name: string, move: number) => ({ name, move, time_s: 0 });

test("each move has its operation's colour, also in the chunks that it reaches into", () => {
    const paint = byOperation({ moves: 9000, operations: [operation("rough", 2), operation("finish", 5000)] });
    expect(Array.from(paint(chunk(0))!.slice(0, 3))).toEqual([UNKNOWN, UNKNOWN, 0]);
    expect(paint(chunk(1))![5000 - 4096 - 1]).toBe(0);
    expect(paint(chunk(1))![5000 - 4096]).toBe(1);
    expect(paint(chunk(2))![0]).toBe(1);
});

test("deviations are painted from none to the largest, by the last number of each row", () => {
    const given = Float32Array.of(0, 0, 0, 9, 0, 0, 0, 0, 9, 0.004, 0, 0, 0, 9, Number.NaN);
    const paint = byDeviation({ width: 5, of: (number) => (number === 0 ? given : null) }, 0.004);
    expect(Array.from(paint(chunk(0))!.slice(0, 3))).toEqual([RAMP, RAMP + RAMP_STEPS - 1, UNKNOWN]);
    expect(paint(chunk(1))![0]).toBe(UNKNOWN);
});

test("feeds are painted from the least to the greatest that is known", () => {
    const given: Record<number, Float32Array | null> = { 0: Float32Array.of(0, 0, 0, 100, 0, 0, 0, Number.NaN, 0, 0, 0, 200), 1: null };
    const paint = byFeed({ width: 4, of: (number) => given[number]! });
    expect(Array.from(paint(chunk(0))!.slice(0, 3))).toEqual([RAMP, UNKNOWN, RAMP + RAMP_STEPS - 1]);
    expect(paint(chunk(1))![0]).toBe(UNKNOWN);
    given[1] = Float32Array.of(0, 0, 0, 300);
    expect(paint(chunk(1))![0]).toBe(RAMP + RAMP_STEPS - 1);
    // 200 is now in the middle.
    expect(paint(chunk(0))![2]).toBe(RAMP + Math.round((RAMP_STEPS - 1) / 2));
});

test("a needle stands at the tip and goes along the tool", () => {
    const vertices = new ArrayBuffer(3 * 16);
    new Float32Array(vertices).set([9, 9, 9, 0, 1, 2, 3, 0, 4, 5, 6, 0]);
    new Uint32Array(vertices)[7] = wordOf(0, 1, 0);
    new Uint32Array(vertices)[11] = wordOf(1, 1, 0);
    const rows = { width: 9, of: () => Float32Array.of(0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0.6, 0, 0.8, 0, 0) } as unknown as Rows;
    const paint = { palette: new Uint32Array(1), byMove: null, shift: 0, mask: 0, styles: new Uint8Array(16), dashed: -1, width: 1, tool: -1, round: false, lift: 0 };
    const strip = needlesOf(chunk(0), vertices, rows, 1, 10, paint)!;
    const numbers = new Float32Array(strip.vertices);
    const points = [1, 2, 3, 4].map((i) => Array.from(numbers.slice(i * 4, i * 4 + 3)));
    expect(points).toEqual([[1, 2, 3], [1, 2, 13], [4, 5, 6], [10, 5, 14]]);
    expect([strip.from, strip.to]).toEqual([1, 5]);
});

test("the order runs through the ramp from the first move to the last", () => {
    const paint = byOrder({ moves: 4096 + 65 });
    expect(paint(chunk(0))![0]).toBe(RAMP);
    expect(paint(chunk(1))![64]).toBe(RAMP + RAMP_STEPS - 1);
    expect(paint(chunk(0))![2080]).toBe(RAMP + RAMP_STEPS / 2);
});
