/**
 * `TOOLPOST_SPEED=1000000 npm test -- --project page speed`: a spiral of so many moves on a mill, in Debian's Chromium without a graphics
 * processor. The figures are those of the command that TOOLPOST names: a debug build posts many times slower.
 */

import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, describe, test } from "vitest";
import { absent, launch, Server, visit } from "./harness.ts";

const moves = Number(process.env.TOOLPOST_SPEED ?? 0);

const MACHINE = "generic-3axis-fanuc";

/** Rings of a growing radius, each a little deeper: 0.5 mm a move. */
function spiral(count: number): string {
    const lines = ["UNITS/MM", "LOADTL/1", "CUTTER/6,3", "SPINDL/9000,RPM,CLW", "RAPID", "GOTO/0,0,50", "FEDRAT/3000,MMPM"];
    for (let i = 0, angle = 0; i < count; i++) {
        const radius = 2 + (i / count) * 90;
        angle += 0.5 / radius;
        lines.push(`GOTO/${(radius * Math.cos(angle)).toFixed(4)},${(radius * Math.sin(angle)).toFixed(4)},${((-i / count) * 20).toFixed(4)}`);
    }
    return [...lines, "FINI", ""].join("\n");
}

/** When something was first seen in the page, ms since 1970. */
interface Seen {
    usable?: number;
    chosen?: number;
    picture?: number;
    verdict?: number;
}

/** It runs in the page. */
function watch(): void {
    const seen: Seen = {};
    Object.assign(globalThis, { seen });
    const now = (): number => performance.timeOrigin + performance.now();
    new MutationObserver(() => {
        if (document.querySelector(".bar button") !== null) seen.usable ??= now();
        if (document.querySelector(".bar output > .done") !== null) seen.verdict ??= now();
    }).observe(document, { childList: true, subtree: true, attributes: true });
    addEventListener("click", ({ timeStamp }) => (seen.chosen = performance.timeOrigin + timeStamp), { capture: true });
    const put = CanvasRenderingContext2D.prototype.putImageData;
    CanvasRenderingContext2D.prototype.putImageData = function (...given: [ImageData, ...number[]]): void {
        Reflect.apply(put, this, given);
        const pixels = new Uint32Array(given[0].data.buffer);
        if (seen.picture === undefined && pixels.some((pixel) => pixel !== pixels[0])) seen.picture = now();
    };
}

/** Waits for verdict and picture. */
async function all(page: Page): Promise<Required<Seen>> {
    await page.waitForFunction(() => {
        const { verdict, picture } = (globalThis as unknown as { seen: Seen }).seen;
        return verdict !== undefined && picture !== undefined;
    }, undefined, { timeout: 600_000 });
    return page.evaluate(() => (globalThis as unknown as { seen: Required<Seen> }).seen);
}

/** Picture and verdict of a source that is chosen in a page that is open. */
async function chosen(browser: Browser, source: string): Promise<string> {
    const server = await Server.start([], ["-m", MACHINE]);
    copyFileSync(source, join(server.folder, basename(source)));
    const { page } = await visit(browser, server.link, {}, watch);
    await page.keyboard.press("Control+o");
    await page.getByRole("dialog").getByText(basename(source)).click();
    const { chosen, picture, verdict } = await all(page);
    await page.close();
    await server.end();
    return `from the choice in an open page: picture ${Math.round(picture - chosen)} ms, verdict ${Math.round(verdict - chosen)} ms`;
}

/** The most memory that a process has had, MB. */
const peak = (id: number): number => Math.round(Number(/VmHWM:\s*(\d+)/.exec(readFileSync(`/proc/${id}/status`, "utf8"))![1]) / 1e3);

/**
 * Clicks on moves, ms in the order of their length: from the browser's own time of the event to the end of the frame in which block,
 * record, template and readout are those of the move.
 */
async function clicked(page: Page, count: number): Promise<number[]> {
    const view = (await page.locator(".canvas").boundingBox())!;
    const times: number[] = [];
    for (let i = 0; i < count; i++) {
        const armed = await page.evaluateHandle(() => {
            const line = (pane: string): string | undefined => document.querySelector(`.${pane} > .body`)!.shadowRoot!.querySelector(".at")?.textContent ?? undefined;
            const lit = () => [line("program"), line("source"), document.querySelector(".readout")?.textContent];
            const before = lit();
            const isLit = (): boolean => document.querySelector(".template .code") !== null && lit().every((text, part) => text !== undefined && text !== before[part]);
            const time = new Promise<number>((tell) => {
                const released = ({ timeStamp }: PointerEvent): void => {
                    const look = (): void => {
                        if (performance.now() - timeStamp > 10_000) return tell(Number.POSITIVE_INFINITY);
                        if (!isLit()) return void requestAnimationFrame(look);
                        // A message comes behind the frame that is being made.
                        const { port1, port2 } = new MessageChannel();
                        port1.addEventListener("message", () => tell(performance.now() - timeStamp));
                        port1.start();
                        port2.postMessage(null);
                    };
                    requestAnimationFrame(look);
                };
                addEventListener("pointerup", released, { once: true, capture: true });
            });
            return { time };
        });
        const angle = i * 2.4;
        await page.mouse.click(view.x + view.width / 2 + (20 + i * 7) * Math.cos(angle), view.y + view.height / 2 + (20 + i * 7) * 0.5 * Math.sin(angle));
        times.push(Math.round(await armed.evaluate(({ time }) => time)));
        // Until the page has fetched what it keeps round the cursor.
        await page.waitForTimeout(3000);
    }
    return times.toSorted((a, b) => a - b);
}

describe.skipIf(moves === 0 || absent() !== null)(`the page with ${moves} moves`, () => {
    afterAll(() => Server.stopAll());

    test("figures", async () => {
        const source = join(tmpdir(), "spiral.cls");
        writeFileSync(source, spiral(moves));
        const browser = await launch();
        const server = await Server.start([source], ["-m", MACHINE]);
        const { page } = await visit(browser, server.link, {}, watch);
        const seen = await all(page);
        const opened = await page.evaluate(() => performance.timeOrigin);
        const since = (from: number): string => (["usable", "picture", "verdict"] as const).map((what) => `${what} ${Math.round(seen[what] - from)} ms`).join(", ");
        const figures = [`from the command: ${since(server.begun)}`, `from opening the page: ${since(opened)}`];
        await page.locator(".program .cm-line.at").waitFor({ timeout: 60_000 });

        // Turning: a step of the pointer in each frame, all of which is drawn.
        const turned = await page.evaluate(async () => {
            const view = document.querySelector(".canvas")!;
            const { left, top } = view.getBoundingClientRect();
            view.setPointerCapture = () => {};
            const point = (kind: string, by: number): boolean => view.dispatchEvent(new PointerEvent(kind, { clientX: left + 100 + by, clientY: top + 100, pointerId: 1 }));
            const frame = (): Promise<number> => new Promise((resolve) => requestAnimationFrame(resolve));
            point("pointerdown", 0);
            const from = performance.now();
            let frames = 0;
            for (; performance.now() - from < 4000; frames++) {
                point("pointermove", 10 + frames);
                await frame();
            }
            point("pointerup", 0);
            return (frames * 1000) / (performance.now() - from);
        });
        figures.push(`turning ${turned.toFixed(1)} frames/s`);

        const clicks = await clicked(page, 15);
        figures.push(`click to lit ${clicks[7]} ms (from ${clicks[0]} to ${clicks[14]})`);

        const scrubbed = await page.evaluate(async () => {
            const slider = document.querySelector<HTMLInputElement>(".time input")!;
            const lit = (): string => document.querySelector(".readout")!.textContent;
            let [shown, last] = [0, ""];
            const from = performance.now();
            for (let i = 0; performance.now() - from < 3000; i++) {
                slider.value = String((Number(slider.max) * (i % 97)) / 97);
                slider.dispatchEvent(new Event("input", { bubbles: true }));
                await new Promise((resolve) => requestAnimationFrame(resolve));
                if (lit() !== last) shown++;
                last = lit();
            }
            return (shown * 1000) / (performance.now() - from);
        });
        figures.push(`scrubbing ${scrubbed.toFixed(1)} places/s`);
        const debug = await page.context().newCDPSession(page);
        const { usedSize } = (await debug.send("Runtime.getHeapUsage")) as { usedSize: number };
        figures.push(`heap ${Math.round(usedSize / 1e6)} MB`);
        const processes = (await (await browser.newBrowserCDPSession()).send("SystemInfo.getProcessInfo")).processInfo;
        const pages = processes.filter(({ type }) => type === "renderer").map(({ id }) => peak(id));
        figures.push(`page ${Math.max(...pages)} MB`, `server ${peak(server.pid)} MB at most`);
        await page.close();
        await server.end();
        figures.push(await chosen(browser, source));
        process.stdout.write(`${figures.join("\n")}\n`);
        await browser.close();
    }, 900_000);
});
