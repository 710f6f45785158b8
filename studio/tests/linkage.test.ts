import { readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import type { Linkage } from "../src/protocol/types.ts";
import { bodiesOf, place, tipOf } from "../src/view/linkage.ts";
import type { Vector } from "../src/view/vector.ts";

interface Machine {
    machine: string;
    linkage: Linkage;
    cases: { axes: number[]; links: number[][]; tool_length: number; tip: number[] }[];
}

/** Written by the core from its own chain: see crates/machine. */
const machines = JSON.parse(readFileSync(new URL("vectors/linkage.json", import.meta.url), "utf8")) as Machine[];

describe.each(machines)("the chain of $machine", ({ linkage, cases }) => {
    test.each(cases)("at $axes is that of the core", ({ axes, links, tool_length, tip }) => {
        const placed = place(linkage, axes);
        const off = (numbers: number[], others: number[]): number => Math.max(...numbers.map((number, i) => Math.abs(number - others[i]!)));
        expect(Math.max(...placed.map((matrix, link) => off(matrix, links[link]!)))).toBeLessThanOrEqual(1e-9);
        expect(off(tipOf(linkage, placed, tool_length), tip)).toBeLessThanOrEqual(1e-9);
    });

    test("carries its bodies to where the tool is", () => {
        const { axes, tool_length, tip } = cases[1]!;
        const bodies = bodiesOf(linkage, axes, { tip: tip as Vector, length: tool_length });
        expect(bodies.length).toBe(linkage.bodies.length);
        for (const { corners } of bodies) expect([...corners].every(Number.isFinite)).toBe(true);
    });
});

const lone: Linkage = {
    axes: [{ name: "Z", unit: "mm", low: null, high: null }],
    links: [
        { name: "bed", on: null, kind: "fixed", direction: [0, 0, 0], point: [0, 0, 0], zero: 0, terms: [] },
        { name: "Z", on: 0, kind: "slide", direction: [0, 0, 1], point: [0, 0, 0], zero: 0, terms: [[0, 1]] },
    ],
    bodies: [{ name: "spindle", on: 1, low: [-1, -1, 0], high: [1, 1, 5], is_given: true }],
    tool: { on: 1, frame: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]] },
    part: { on: 0, frame: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]] },
};

test("a spindle stands above the tip by the tool's length, also where the axes count from another zero", () => {
    const { corners } = bodiesOf(lone, [50], { tip: [7, 8, 9], length: 20 })[0]!;
    const heights = Array.from(corners).filter((_, i) => i % 3 === 2);
    expect([Math.min(...heights), Math.max(...heights)]).toEqual([29, 34]);
    const across = Array.from(corners).filter((_, i) => i % 3 === 0);
    expect([Math.min(...across), Math.max(...across)]).toEqual([6, 8]);
});
