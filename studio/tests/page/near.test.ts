/** What is drawn of many turns, compared with the true path, which is worked out here. */

import { writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { describe, expect, test } from "vitest";
import { absent, browserOfTests, proven, Server, visit } from "./harness.ts";

type Point = [x: number, y: number, z: number];

interface Turns {
    /** Records of the source, behind the one that goes to the first point. */
    records: string[];
    /** Each turn as a function of its part, 0 to 1. */
    at: ((part: number) => Point)[];
    from: Point;
}

const place = (point: Point): string => point.map((value) => value.toFixed(6)).join(",");

/** Full turns of 50 mm, each lower by `pitch` mm. */
function helix(count: number, pitch: number): Turns {
    const at = Array.from({ length: count }, (_, turn) => (part: number): Point =>
        [50 * Math.cos(part * 2 * Math.PI), 50 * Math.sin(part * 2 * Math.PI), -pitch * (turn + part)]);
    const records = at.flatMap((turn) => [`CIRCLE/0,0,${turn(0)[2].toFixed(6)},0,0,1,50`, `GOTO/${place(turn(1))}`]);
    return { records, at, from: [50, 0, 0] };
}

/** Half circles in a plane, each of a radius that is greater by `growth` mm. */
function spiral(count: number, growth: number): Turns {
    const end = (half: number): number => (5 + half * growth) * (half % 2 === 0 ? 1 : -1);
    const at = Array.from({ length: count }, (_, half) => (part: number): Point => {
        const [middle, spoke] = [(end(half) + end(half + 1)) / 2, (end(half) - end(half + 1)) / 2];
        return [middle + spoke * Math.cos(part * Math.PI), spoke * Math.sin(part * Math.PI), 0];
    });
    const records = at.flatMap((half, i) => {
        const [middle, spoke] = [(end(i) + end(i + 1)) / 2, Math.abs(end(i) - end(i + 1)) / 2];
        return [`CIRCLE/${middle.toFixed(6)},0,0,0,0,1,${spoke.toFixed(6)}`, `GOTO/${place(half(1))}`];
    });
    return { records, at, from: [5, 0, 0] };
}

const source = ({ records, from }: Turns): string =>
    ["UNITS/MM", "LOADTL/1", "SPINDL/900,RPM,CLW", "RAPID", `GOTO/${from[0]},${from[1]},5`, "FEDRAT/900,MMPM", `GOTO/${place(from)}`, ...records, "FINI", ""].join("\n");

/** Pixels right and down of a point. */
type Look = (point: Point) => [number, number];

/** How the page has asked for what is seen last: by its camera. */
function look(asked: string): Look {
    const [rx, ry, rz, dx, dy, dz, , , , x, y] = asked.split("/")[1]!.split(",").map(Number) as [number, number, number, number, number, number, number, number, number, number, number];
    return ([px, py, pz]) => [x + rx * px + ry * py + rz * pz, y + dx * px + dy * py + dz * pz];
}

/** The picture: where it is not paper. */
async function painted(page: Page): Promise<{ width: number; height: number; isPainted: (x: number, y: number) => boolean }> {
    const { width, height, pixels } = await page.locator(".canvas canvas").first().evaluate((canvas) => {
        const { width, height } = canvas as HTMLCanvasElement;
        const pixels = new Uint32Array((canvas as HTMLCanvasElement).getContext("2d")!.getImageData(0, 0, width, height).data.buffer);
        return { width, height, pixels: Array.from(pixels, (pixel) => (pixel === pixels[0] ? 0 : 1)) };
    });
    return { width, height, isPainted: (x, y) => x >= 0 && y >= 0 && x < width && y < height && pixels[y * width + x] === 1 };
}

/** Points in the window that are further than half a pixel from all that is painted, and painted pixels that no point is near to; the tool's are left out. */
async function wrong(page: Page, { at, from }: Turns, to: Look, steps: number): Promise<{ points: number; missed: number; alien: number }> {
    const { width, height, isPainted } = await painted(page);
    const near = new Uint8Array(width * height);
    let [points, missed] = [0, 0];
    const visit = ([x, y]: [number, number]): void => {
        const [left, top] = [Math.floor(x), Math.floor(y)];
        if (left < -1 || top < -1 || left > width || top > height) return;
        // At the edge its pixel may be the one beside the window.
        const isWithin = left > 0 && top > 0 && left < width - 1 && top < height - 1;
        let best = Number.POSITIVE_INFINITY;
        for (let row = top - 1; row <= top + 1; row++) {
            for (let column = left - 1; column <= left + 1; column++) {
                if (column >= 0 && row >= 0 && column < width && row < height) near[row * width + column] = 1;
                if (!isPainted(column, row)) continue;
                best = Math.min(best, Math.hypot(Math.max(column - x, 0, x - column - 1), Math.max(row - y, 0, y - row - 1)));
            }
        }
        if (isWithin) points++;
        if (isWithin && best > 0.5) missed++;
    };
    for (const turn of at) {
        for (let step = 0; step <= steps; step++) visit(to(turn(step / steps)));
    }
    for (let z = 0; z <= 5; z += 0.01) visit(to([from[0], from[1], z]));
    const tool = to([from[0], from[1], 5]);
    let alien = 0;
    for (let y = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
            if (isPainted(x, y) && near[y * width + x] === 0 && Math.hypot(x - tool[0], y - tool[1]) > 70) alien++;
        }
    }
    return { points, missed, alien };
}

describe.skipIf(absent() !== null)("many turns", () => {
    const browser = browserOfTests();

    async function open(turns: Turns): Promise<{ page: Page; complaints: string[]; rested: () => Promise<Look> }> {
        const server = await Server.start([], ["-m", "generic-3axis-fanuc"]);
        writeFileSync(join(server.folder, "turns.cls"), source(turns));
        const { page, complaints } = await visit(browser(), server.link);
        let asked = "";
        let pending = 0;
        page.on("request", (request) => {
            const path = /geometry\/\d+\/sight\/(.*)\/all$/.exec(request.url())?.[1];
            if (path === undefined) return;
            asked = path;
            pending++;
        });
        for (const over of ["requestfinished", "requestfailed"] as const) {
            page.on(over as "requestfinished", (request) => void (/\/sight\/.*\/all$/.test(request.url()) && pending--));
        }
        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("turns.cls").click();
        await proven(page, 120_000);
        await page.locator(".canvas").focus();
        await page.keyboard.press("r");
        const rested = async (): Promise<Look> => {
            asked = "";
            await expect.poll(() => asked !== "" && pending === 0, { timeout: 15_000 }).toBe(true);
            await page.locator(".off").waitFor({ state: "detached", timeout: 15_000 });
            await page.waitForTimeout(300);
            return look(asked);
        };
        return { page, complaints, rested };
    }

    test("of a helix lie within half a pixel of it in each view, and no line is elsewhere", async () => {
        const turns = helix(5000, 0.002);
        const { page, complaints, rested } = await open(turns);
        for (const [key, zooms] of [["1", 0], ["2", 0], ["6", 0], ["6", 12], ["5", 0]] as const) {
            const rests = rested();
            await page.keyboard.press(key);
            await page.keyboard.press("f");
            if (zooms > 0) await page.keyboard.press("Home");
            for (let step = 0; step < zooms; step++) await page.keyboard.press("PageUp");
            const to = await rests;
            const found = await wrong(page, turns, to, 700);
            expect({ key, zooms, ...found }).toEqual({ key, zooms, points: expect.any(Number), missed: 0, alien: 0 });
        }
        expect(complaints).toEqual([]);
        await page.close();
    }, 240_000);

    test("of a spiral are seen one by one where one looks close", async () => {
        const turns = spiral(2000, 0.015);
        const { page, complaints, rested } = await open(turns);
        for (let zoom = 0; zoom < 2; zoom++) {
            const rests = rested();
            await page.keyboard.press("1");
            await page.keyboard.press("f");
            if (zoom === 1) {
                const box = (await page.locator(".canvas").boundingBox())!;
                await page.mouse.move(box.x + box.width / 2, box.y + box.height * 0.3);
                for (let step = 0; step < 4; step++) await page.mouse.wheel(0, -500);
            }
            const to = await rests;
            const found = await wrong(page, turns, to, 15_000);
            expect({ zoom, ...found }).toEqual({ zoom, points: expect.any(Number), missed: 0, alien: 0 });
            expect(found.points).toBeGreaterThan(1000);
        }
        expect(complaints).toEqual([]);
        await page.close();
    }, 240_000);
});
