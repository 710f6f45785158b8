import { expect, test } from "vitest";
import type { Projection } from "../src/view/camera.ts";
import { Raster, rgb } from "../src/view/raster.ts";
import { Painting } from "../src/view/renderer.ts";
import { reaching } from "../src/view/scene.ts";
import { Style, vertexOf, wordOf, type Paint, type Strip } from "../src/view/strip.ts";

/** One pixel a millimetre, X right, Y down, Z away. */
const flat: Projection = { right: [1, 0, 0], down: [0, 1, 0], away: [0, 0, 1], at: [0, 0, 0], scale: 1 };

const letters = ".abcdefgh";
const shown = (raster: Raster): string[] =>
    Array.from({ length: raster.height }, (_, y) =>
        Array.from(raster.seen.slice(y * raster.width, (y + 1) * raster.width), (id) => letters[id]).join(""));

const paint = (more: Partial<Paint> = {}): Paint => ({
    palette: Uint32Array.from({ length: 256 }, (_, index) => index),
    byMove: null,
    shift: 12,
    mask: 15,
    styles: new Uint8Array(16),
    dashed: -1,
    width: 1,
    tool: -1,
    round: false,
    lift: 0,
    ...more,
});

function strip(points: number[][], more: Partial<Strip> = {}): Strip {
    const vertices = new ArrayBuffer(points.length * 16);
    const numbers = new Float32Array(vertices);
    const words = new Uint32Array(vertices);
    points.forEach(([x, y, z, kind = 0, tool = 0], i) => {
        numbers.set([x!, y!, z ?? 0], i * 4);
        words[i * 4 + 3] = wordOf(Math.max(0, i - 1), kind, tool);
    });
    return { vertices, origin: [0, 0, 0], first: 0, from: 1, to: points.length, paint: paint(), ...more };
}

/** The moves that are seen. */
function drawn(width: number, height: number, ...strips: Strip[]): Raster {
    return fill(new Raster(width, height, { sees: "moves", left: 0, top: 0 }), 0, strips);
}

function coloured(width: number, height: number, ...strips: Strip[]): Raster {
    return fill(new Raster(width, height), 99, strips);
}

function fill(raster: Raster, background: number, strips: Strip[]): Raster {
    raster.clear(background);
    for (const one of strips) raster.strip(one, flat);
    return raster;
}

test("a polyline: each segment has its move's number", () => {
    expect(shown(drawn(6, 4, strip([[0.5, 0.5], [4.5, 0.5], [4.5, 3.5]])))).toEqual([
        "aaaab.",
        "....b.",
        "....b.",
        "....b.",
    ]);
});

test("a slope has one pixel in each column", () => {
    expect(shown(drawn(8, 3, strip([[0.5, 0.5], [7.5, 2.5]])))).toEqual([
        "aa......",
        "..aaaa..",
        "......aa",
    ]);
});

test("what is near covers what is far, in whatever order they come", () => {
    const far = strip([[0.5, 1.5, 5], [4.5, 1.5, 5]], { first: 0 });
    const near = strip([[2.5, 0.5, 1], [2.5, 2.5, 1]], { first: 1 });
    const picture = ["..b..", "aabaa", "..b.."];
    expect(shown(drawn(5, 3, far, near))).toEqual(picture);
    expect(shown(drawn(5, 3, near, far))).toEqual(picture);
});

test("lifted lines lie on the same lines", () => {
    const line = [[0.5, 0.5, 2], [3.5, 0.5, 2]];
    const lifted = strip(line, { first: 1, paint: paint({ lift: 1 }) });
    expect(shown(drawn(4, 1, lifted, strip(line)))).toEqual(["bbbb"]);
});

test("wide lines", () => {
    expect(shown(drawn(5, 5, strip([[1.5, 2.5], [3.5, 2.5]], { paint: paint({ width: 3 }) })))).toEqual([
        ".....",
        ".aaa.",
        ".aaa.",
        ".aaa.",
        ".....",
    ]);
});

test("rapids are dashed, and can be hidden", () => {
    const styles = new Uint8Array(16);
    styles[3] = Style.dashed;
    const rapid = strip([[0.5, 0.5], [11.5, 0.5, 0, 3]], { paint: paint({ styles }) });
    expect(shown(drawn(12, 1, rapid))).toEqual(["aaaaa...aaaa"]);
    styles[3] = Style.hidden;
    expect(shown(drawn(12, 1, rapid))).toEqual(["............"]);
});

test("lines that leave the window are cut off at its edge, and keep their dashes", () => {
    expect(shown(drawn(4, 4, strip([[-1e6, -1e6], [1e6, 1e6]])))).toEqual(["a...", ".a..", "..a.", "...a"]);
    expect(shown(drawn(4, 2, strip([[-5, 5], [-1, 9]])))).toEqual(["....", "...."]);
    const whole = strip([[0.5, 0.5], [15.5, 0.5, 0, 1]], { paint: paint({ styles: new Uint8Array(16).fill(Style.dashed) }) });
    const part = fill(new Raster(8, 1, { sees: "moves", left: 4, top: 0 }), 0, [whole]);
    expect(shown(part)[0]).toBe(shown(drawn(16, 1, whole))[0]!.slice(4, 12));
});

test.each([Number.NaN, Number.POSITIVE_INFINITY, 1e30])("a vertex at %f draws nothing and hurts nothing", (x) => {
    expect(shown(drawn(3, 1, strip([[x, 0.5], [x, 0.5], [0.5, 0.5], [2.5, 0.5]])))).toEqual(["ccc"]);
});

test("colours: by kind, by tool, by a table of moves", () => {
    const points = [[0.5, 0.5], [0.5, 0.5, 0, 2, 7], [1.5, 0.5, 0, 4, 9]];
    const byKind = coloured(2, 1, strip(points));
    expect([...byKind.seen]).toEqual([2, 4]);
    const byTool = coloured(2, 1, strip(points, { paint: paint({ shift: 16, mask: 255 }) }));
    expect([...byTool.seen]).toEqual([7, 9]);
    const byMove = coloured(2, 1, strip(points.slice(0, 2), { paint: paint({ byMove: new Uint8Array([33, 44]) }) }));
    expect([...byMove.seen]).toEqual([33, 99]);
});

test("a part of a strip, found by its moves", () => {
    const whole = strip([[0.5, 0.5], [1.5, 0.5], [2.5, 0.5], [3.5, 0.5], [4.5, 0.5]]);
    expect(vertexOf(whole.vertices, 0)).toBe(1);
    expect(vertexOf(whole.vertices, 2)).toBe(3);
    expect(vertexOf(whole.vertices, 9)).toBe(5);
    expect(shown(drawn(5, 1, { ...whole, from: 3, to: 4 }))).toEqual(["...c."]);
});

test("a face covers the pixels whose middles are in it, and hides what is behind", () => {
    const raster = coloured(4, 4, strip([[0.5, 1.5, 5], [3.5, 1.5, 5]]));
    raster.triangles({ corners: Float32Array.from([0, 0, 1, 4, 0, 1, 0, 4, 1]), colour: [200, 100, 50] }, flat);
    // The lamp stands 0.35 beside and 0.55 above the eye: 0.35 + 0.65 / sqrt(1 + 0.35² + 0.55²) = 0.8945 of the colour.
    const face = rgb(179, 89, 45);
    const picture = Array.from(raster.seen, (colour) => (colour === face ? "#" : colour === 99 ? "." : "a")).join("");
    expect(picture.match(/.{4}/g)).toEqual(["####", "###a", "##..", "#..."]);
});

test("a point is a square of its width at its vertex, and no line leads to it", () => {
    const styles = Uint8Array.from({ length: 16 }, (_, kind) => (kind === 5 ? Style.dot : Style.hidden));
    const points = [[1.5, 1.5, 0], [1.5, 1.5, 0, 5], [6.5, 2.5, 0, 5]];
    expect(shown(drawn(8, 4, strip(points, { paint: paint({ styles }) })))).toEqual([
        "........",
        ".a......",
        "......b.",
        "........",
    ]);
    expect(shown(drawn(8, 4, strip(points, { paint: paint({ styles, width: 3 }) })))).toEqual([
        "aaa.....",
        "aaa..bbb",
        "aaa..bbb",
        ".....bbb",
    ]);
    // The nearer one is seen; what is out of the picture is not.
    const hidden = [[1, 1, 5], [1, 1, 5, 5], [1, 1, 2, 5], [1, 1, 9, 5], [-50, 1, 0, 5]];
    expect(shown(drawn(2, 2, strip(hidden, { paint: paint({ styles }) })))).toEqual(["..", ".b"]);
});

test("where one pixel in so many is drawn, it is one of the line, and so is the end", () => {
    const raster = new Raster(16, 2);
    raster.clear(0);
    const line = strip([[0, 0, 0], [15, 1, 0, 1]]);
    raster.stride = 4;
    raster.strip(line, flat);
    expect(shown(raster)).toEqual(["a...a...a...a...", "...............a"]);
    expect(raster.gone).toBe(15);
    raster.clear(0);
    raster.stride = 1;
    raster.strip(line, flat);
    expect(shown(raster)).toEqual(["aaaaaaaaaaaaaaa.", "...............a"]);
});

test("of short lines and points one in so many is drawn", () => {
    const raster = new Raster(9, 1);
    raster.clear(0);
    raster.stride = 3;
    const points = Array.from({ length: 8 }, (_, x) => [x, 0, 0, 1]);
    raster.strip(strip(points), flat);
    expect(shown(raster)).toEqual(["...a..a.."]);
    raster.clear(0);
    raster.strip(strip(points, { paint: paint({ styles: Uint8Array.of(0, Style.dot) }) }), flat);
    expect(shown(raster)).toEqual(["...a..a.."]);
    expect(raster.gone).toBe(7);
});

test("a picture that moves has no more pixels of lines to draw than a bounded number, and all of them when it rests", () => {
    const ends = Array.from({ length: 40_001 }, (_, i) => [i % 2 === 0 ? 0 : 199, i % 100, 0]);
    const many = strip(ends, { paint: paint({ mask: 0, palette: Uint32Array.of(1) }) });
    const picture = { flats: [], surfaces: [], strips: [many], over: [], bodies: [] };
    const painting = new Painting(200, 100);
    const pixels = (isMoving: boolean): number => painting.draw(picture, { ...flat, at: [0, 0, Math.random()] }, 0, isMoving).reduce((sum, one) => sum + Number(one !== 0), 0);
    const all = pixels(false);
    const some = pixels(true);
    // Of 8 million pixels a third.
    expect(some).toBeGreaterThan(all / 4);
    expect(some).toBeLessThan(all / 1.5);
    expect(pixels(true)).toBe(some);
    // At rest nothing of it is kept, also where nothing else has changed.
    const at = { ...flat, at: [0, 0, 7] as [number, number, number] };
    const hurried = painting.draw(picture, at, 0, true).slice();
    const whole = painting.draw(picture, at, 0).slice();
    expect(hurried).not.toEqual(whole);
    expect(whole).toEqual(new Painting(200, 100).draw(picture, at, 0));
});

test("the lines that may come into a square are among all of them, and no others are far from it", () => {
    const points = [[0, 0], [40, 0], [50, 50], [0, 60], [1e9, 61], [48, 52, 1e30], [49, 49], [0, 0]].map(([x, y, z]) => [x!, y!, z ?? 0]);
    const square = { left: 45, top: 45, side: 10 };
    expect(reaching(strip(points), flat, square)).toEqual([[2, 4], [5, 8]]);
    // A line of 12 pixels comes in from beside.
    const wide = (x: number): unknown => reaching(strip([[x, 0], [x, 90]], { paint: paint({ width: 12 }) }), flat, square);
    expect([wide(37), wide(39), wide(61), wide(63)]).toEqual([[], [[1, 2]], [[1, 2]], []]);
});
