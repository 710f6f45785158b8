import { expect, test } from "vitest";
import { VIEWS, alongTool, fit, orbit, pan, project, toScreen, zoom, zoomTo, type Camera } from "../src/view/camera.ts";
import type { Vector } from "../src/view/vector.ts";

const size = { width: 200, height: 100 };
const seen = (camera: Camera, point: Vector) => toScreen(project(camera, size), point).map((pixel) => Math.round(pixel * 1e6) / 1e6 + 0);
const view = (name: string): Camera => ({ ...VIEWS.find((one) => one.name === name)!, middle: [0, 0, 0], scale: 2 });

test("from above, X is right, Y is up and Z is near", () => {
    expect(seen(view("Top"), [10, 0, 0])).toEqual([120, 50, 0]);
    expect(seen(view("Top"), [0, 10, 0])).toEqual([100, 30, 0]);
    expect(seen(view("Top"), [0, 0, 10])).toEqual([100, 50, -20]);
});

test("from the front, X is right and Z is up; from the right, Y is right; from behind, X is left", () => {
    expect(seen(view("Front"), [10, 0, 10])).toEqual([120, 30, 0]);
    expect(seen(view("Right"), [0, 10, 10])).toEqual([120, 30, 0]);
    expect(seen(view("Back"), [10, 0, 0])).toEqual([80, 50, 0]);
    expect(seen(view("Left"), [0, 10, 0])).toEqual([80, 50, 0]);
});

test("in the isometric view the three axes are of one length on the screen", () => {
    const lengths = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]] as Vector[]).map((axis) => {
        const [x, y] = seen(view("Isometric"), axis);
        return Math.hypot(x! - 100, y! - 50);
    });
    // 2 px/mm times sqrt(2/3).
    for (const length of lengths) expect(length).toBeCloseTo(2 * Math.sqrt(2 / 3), 4);
});

test("what is under the pixel stays there while one zooms", () => {
    const camera = { ...view("Isometric"), middle: [3, 4, 5] as Vector };
    const { right, down, at } = project(camera, size);
    const point: Vector = [1, 2, 3];
    const [x, y] = [right[0] + 2 * right[1] + 3 * right[2] + at[0], down[0] + 2 * down[1] + 3 * down[2] + at[1]];
    const [x2, y2] = toScreen(project(zoom(camera, 5, x, y, size), size), point);
    expect([x2, y2].map((pixel) => pixel.toFixed(6))).toEqual([x, y].map((pixel) => pixel.toFixed(6)));
});

test("panning moves the picture by the pixels", () => {
    expect(seen(pan(view("Front"), 7, -3), [0, 0, 0])).toEqual([107, 47, 0]);
});

test("fit shows the whole box with a margin", () => {
    const camera = fit(view("Top"), { low: [0, 0, 0], high: [100, 10, 1] }, size);
    expect(seen(camera, [0, 5, 0.5])).toEqual([10, 50, 0]);
    expect(seen(camera, [100, 5, 0.5])).toEqual([190, 50, 0]);
});

test("a box of one point can be fitted", () => {
    expect(Number.isFinite(fit(view("Top"), { low: [1, 1, 1], high: [1, 1, 1] }, size).scale)).toBe(true);
});

test("zoom to box: its corners become those of the window", () => {
    const camera = zoomTo(view("Top"), [100, 50], [120, 60], size);
    // (0, 0) was at pixel (100, 50), (10, -5) at (120, 60).
    expect(seen(camera, [0, 0, 0])).toEqual([0, 0, 0]);
    expect(seen(camera, [10, -5, 0])).toEqual([200, 100, 0]);
});

test("along the tool, shank and tip are the same pixel", () => {
    const axis: Vector = [0.6, 0, 0.8];
    const camera = alongTool(view("Front"), axis);
    expect(seen(camera, [6, 0, 8]).slice(0, 2)).toEqual([100, 50]);
    expect(seen(camera, [6, 0, 8])[2]).toBeLessThan(0);
    expect(alongTool(view("Front"), [0, 0, 1])).toMatchObject({ turn: 0, height: 90 });
});

test("one cannot turn over the pole", () => {
    expect(orbit(view("Top"), 0, 50).height).toBe(90);
});
