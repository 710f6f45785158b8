import { expect, test } from "vitest";
import type { BoardPicture } from "../src/protocol/asks.ts";
import { Board } from "../src/view/board.ts";
import type { Projection } from "../src/view/camera.ts";
import { theme } from "../src/view/colours.ts";
import { Raster, rgb } from "../src/view/raster.ts";
import { Style, wordOf, type Paint, type Strip } from "../src/view/strip.ts";

/** One pixel a millimetre, X right, Y down, Z away. */
const flat: Projection = { right: [1, 0, 0], down: [0, 1, 0], away: [0, 0, 1], at: [0, 0, 0], scale: 1 };

const area = (kind: "board" | "copper" | "rest", net: string | null, conductor: number, count: number) => ({ kind, net, conductor, count });

/** A board of 10 x 6 mm with two nets, the second of them with a slope, a hole and a tab. */
function board(): Board {
    const about: BoardPicture = {
        areas: [area("board", null, 0, 1), area("copper", "GND", 0, 1), area("copper", null, 1, 1)],
        places: [{ x: 5, y: 3, kind: "joined", what: "two nets stay joined" }],
        turning: null,
        width: null,
        error: 0.002,
        is_whole: true,
    };
    const areas = Float32Array.from([0, 6, 0, 10, 0, 10, 1, 3, 1, 4, 1, 4, 1, 5, 6, 7, 8, 9]);
    return new Board(about, areas, Float32Array.from([2.5, 2.5, 2.5, 2.5, 2.2]), Float32Array.from([1, 0.5, 4, 0.5, 1, 5.5, 4, 5.5]));
}

test("the net under a place is that of its copper", () => {
    const one = board();
    expect(one.netAt(2, 2)).toBe("GND");
    expect(one.netAt(5, 2)).toBe(null);
    // Half way up the slope it reaches from 7 to 8.
    expect(one.netAt(7.5, 3)).toBe("without a name (2)");
    expect(one.netAt(6.5, 3)).toBe(null);
    expect(one.box).toEqual({ low: [0, 0, 0], high: [10, 6, 0] });
});

const shown = (raster: Raster, letters: Map<number, string>): string[] =>
    Array.from({ length: raster.height }, (_, y) =>
        Array.from(raster.seen.slice(y * raster.width, (y + 1) * raster.width), (colour) => letters.get(colour) ?? "?").join(""));

test("areas are filled in their order, and lie below all that has depth", () => {
    const raster = new Raster(10, 6);
    raster.clear(0);
    const flats = board().flats(theme(false));
    for (const one of flats) raster.flat(one, flat);
    const names = ["b", "1", "2", "h"];
    const letters = new Map(flats.map(({ colour }, i) => [colour, names[i]!]));
    // The hole reaches 1.1 mm about X 2.5 Y 2.5.
    expect(shown(raster, letters)).toEqual([
        "bbbbbbbbbb",
        "b1h1bb2bbb",
        "bhhhbbb2bb",
        "bbhbbbb2bb",
        "bbbbbbbb2b",
        "bbbbbbbbbb",
    ]);
    expect(raster.depth.every((depth) => depth === Number.POSITIVE_INFINITY)).toBe(true);
});

test("tabs lie over the cuts, each by itself, and are no moves", () => {
    const strip = board().tabLines(theme(false))!;
    const tab = { ...strip, paint: { ...strip.paint, width: 1 } };
    const raster = new Raster(6, 6);
    raster.clear(0);
    raster.strip(cut([[0, 0.5], [6, 0.5]], { width: 2 }), flat);
    raster.strip(tab, flat);
    const black = rgb(17, 17, 17);
    expect(Array.from(raster.seen.slice(0, 6))).toEqual([1, black, black, black, black, 1]);
    expect(Array.from(raster.seen.slice(12, 24)).every((seen) => seen === 0)).toBe(true);
    const moves = new Raster(6, 6, { sees: "moves", left: 0, top: 0 });
    moves.clear(0);
    moves.strip(tab, flat);
    expect(moves.seen.every((seen) => seen === 0)).toBe(true);
});

function cut(points: number[][], more: Partial<Paint>): Strip {
    const vertices = new ArrayBuffer(points.length * 16);
    const numbers = new Float32Array(vertices);
    const words = new Uint32Array(vertices);
    points.forEach(([x, y, tool = 0], i) => {
        numbers.set([x!, y!, 0], i * 4);
        words[i * 4 + 3] = wordOf(i, 2, tool);
    });
    const paint: Paint = {
        palette: Uint32Array.from({ length: 256 }, (_, index) => index + 1),
        byMove: null,
        shift: 16,
        mask: 63,
        styles: new Uint8Array(16).fill(Style.line),
        dashed: -1,
        width: 4,
        tool: -1,
        round: true,
        lift: 0,
        ...more,
    };
    return { vertices, origin: [0, 0, 0], first: 0, from: 1, to: points.length, paint };
}

test("a cut is as wide as its tool, with round ends", () => {
    const raster = new Raster(12, 6);
    raster.clear(0);
    raster.strip(cut([[3, 3], [8, 3]], {}), flat);
    const letters = new Map([[0, "."], [1, "c"]]);
    // Middles of pixels that are within 2 of the line from X 3 to X 8: at the ends discs.
    expect(shown(raster, letters)).toEqual([
        "............",
        "..ccccccc...",
        ".ccccccccc..",
        ".ccccccccc..",
        "..ccccccc...",
        "............",
    ]);
});

test("a slanted cut is as wide as a straight one", () => {
    const raster = new Raster(60, 60);
    raster.clear(0);
    raster.strip(cut([[10, 10], [50, 50]], { width: 8 }), flat);
    const covered = raster.seen.reduce((sum, seen) => sum + (seen === 0 ? 0 : 1), 0);
    // 40 * sqrt 2 long, 8 wide, and a disc.
    expect(Math.abs(covered - (40 * Math.SQRT2 * 8 + Math.PI * 16))).toBeLessThan(12);
});

test("of several tools only the one that is meant is drawn", () => {
    const raster = new Raster(12, 12);
    raster.clear(0);
    raster.strip(cut([[3, 3, 0], [8, 3, 0], [8, 9, 1]], { tool: 1, width: 2 }), flat);
    expect(new Set(raster.seen)).toEqual(new Set([0, 2]));
    expect(raster.seen[3 * 12 + 4]).toBe(0);
});

test("dark is another paint", () => {
    const [light, dark] = [theme(false), theme(true)].map((one) => board().flats(one)[0]!.colour);
    expect(light).toBe(rgb(239, 233, 210));
    expect(dark).not.toBe(light);
});
