/**
 * `TOOLPOST_SPEED=1000000 npm test -- --project page speed`: a spiral of so many moves on a mill, in Debian's Chromium without a graphics
 * processor. The figures are those of the command that TOOLPOST names: a debug build posts many times slower.
 */

import { writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { describe, test } from "vitest";
import { absent, launch, lit, Server, visit } from "./harness.ts";

const moves = Number(process.env.TOOLPOST_SPEED ?? 0);

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

describe.skipIf(moves === 0 || absent() !== null)(`the page with ${moves} moves`, () => {
    test("figures", async () => {
        const source = join(tmpdir(), "spiral.cls");
        writeFileSync(source, spiral(moves));
        const browser = await launch();
        const begun = performance.now();
        const since = (): string => `${Math.round(performance.now() - begun)} ms`;
        const server = await Server.start([source], ["-m", "generic-3axis-fanuc"]);
        const { page } = await visit(browser, server.link);
        await page.getByRole("button", { name: "Commands" }).waitFor();
        const figures = [`usable ${since()}`];
        await page.getByText("✓ PROVEN").waitFor({ timeout: 600_000 });
        figures.push(`verdict ${since()}`);
        await page.locator(".program .cm-line.at").waitFor();
        await page.waitForLoadState("networkidle");
        figures.push(`picture ${since()}`);

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

        const view = (await page.locator(".canvas").boundingBox())!;
        const before = await lit(page, "program");
        const clicked = performance.now();
        await page.mouse.click(view.x + view.width / 2 + 31, view.y + view.height / 2 + 9);
        await page.waitForFunction((text) => document.querySelector(".program > .body")!.shadowRoot!.querySelector(".at")?.textContent !== text, before, { polling: 5 });
        figures.push(`click to lit ${Math.round(performance.now() - clicked)} ms`);

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
        process.stdout.write(`${figures.join(", ")}\n`);
        await browser.close();
        await Server.stopAll();
    }, 900_000);
});
