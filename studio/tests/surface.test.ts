import { expect, test } from "vitest";
import type { Chunk } from "../src/view/chunks.ts";
import type { Rows } from "../src/view/rows.ts";
import { surfaceOf } from "../src/view/surface.ts";
import { wordOf } from "../src/view/strip.ts";

const [RAPID, FEED, ARC] = [1, 2, 3];
const chunk: Chunk = { number: 0, origin: [100, 0, 0], half: [1, 1, 1], first: 0, isCrowded: false };
const cut = { height: 20, straight: FEED, round: ARC };

function vertices(...points: [x: number, y: number, move: number, kind: number][]): ArrayBuffer {
    const made = new ArrayBuffer(points.length * 16);
    points.forEach(([x, y, move, kind], i) => {
        new Float32Array(made).set([x, y, 0], i * 4);
        new Uint32Array(made)[i * 4 + 3] = wordOf(move, kind, 0);
    });
    return made;
}

/** Rows of moves that end with these axes. */
function rows(...axes: number[][]): Rows {
    const numbers = Float32Array.from(axes.flatMap((axis) => [0, 0, 0, 0, ...axis, 0, 0, 0]));
    return { width: 10, of: () => numbers } as unknown as Rows;
}

const upright = { width: 5, of: () => null } as unknown as Rows;
const points = (corners: Float32Array): number[][] => Array.from({ length: corners.length / 3 }, (_, i) => Array.from(corners.slice(i * 3, i * 3 + 3), (part) => Math.round(part * 1e3) / 1e3));

test("an upright wire cuts walls, and nothing on its rapids", () => {
    const surface = surfaceOf(chunk, vertices([0, 0, 0, RAPID], [1, 0, 0, RAPID], [1, 5, 1, FEED]), upright, cut)!;
    expect(points(surface)).toEqual([[101, 0, 0], [101, 5, 0], [101, 5, 20], [101, 0, 0], [101, 5, 20], [101, 0, 20]]);
});

test("between straight guides the surface is ruled: the upper end goes from where it leaned before", () => {
    const leaning = rows([0, 0, 1], [0.3, 0, 1]);
    const surface = surfaceOf(chunk, vertices([0, 0, 0, FEED], [1, 0, 0, FEED], [1, 5, 1, FEED]), leaning, cut)!;
    expect(points(surface).slice(6)).toEqual([[101, 0, 0], [101, 5, 0], [107, 5, 20], [101, 0, 0], [107, 5, 20], [101, 0, 20]]);
});

test("round an arc a taper is a cone: the upper end keeps its distance from the centre", () => {
    // A quarter round (100, 0), radius 10, in ten chords; the wire leans outwards by a tenth: 2 mm over the height.
    const arc = Array.from({ length: 11 }, (_, i): [number, number, number, number] => {
        const angle = (i * Math.PI) / 20;
        return [10 * Math.cos(angle), 10 * Math.sin(angle), i === 0 ? 0 : 1, i === 0 ? RAPID : ARC];
    });
    const surface = surfaceOf(chunk, vertices([10, 0, 0, RAPID], ...arc), rows([0.1, 0, 1], [0, 0.1, 1]), cut)!;
    const upper = points(surface).filter(([, , z]) => z === 20);
    for (const [x, y] of upper) expect(Math.hypot(x! - 100, y!)).toBeCloseTo(12, 1);
    expect(upper.at(-2)).toEqual([100, 12, 20]);
});

test("nothing is drawn before it is known how the wire leans", () => {
    expect(surfaceOf(chunk, vertices([0, 0, 0, FEED], [1, 0, 0, FEED]), { width: 10, of: () => null } as unknown as Rows, cut)).toBe(null);
});
