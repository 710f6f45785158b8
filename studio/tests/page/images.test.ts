/** The pictures of docs/studio.md: `make images-studio`. */

import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { describe, expect, test } from "vitest";
import { absent, example, goTo, launch, proven, readout, Server, visit } from "./harness.ts";

const folder = process.env.TOOLPOST_IMAGES;

/** Two thirds of the replay. */
async function replayed(page: Page): Promise<void> {
    await page.getByLabel("Time of the machine").evaluate((slider: HTMLInputElement) => {
        slider.value = String(Number(slider.max) * 0.66);
        slider.dispatchEvent(new Event("input", { bubbles: true }));
    });
    await page.getByRole("tab", { name: "Axes over time" }).click();
    await page.waitForTimeout(1500);
}

/** A knot as a text STL: a tube round a line that goes three times up and down while it goes round twice. */
function knot(): string {
    const line = (t: number): number[] => [(2 + Math.cos(3 * t)) * Math.cos(2 * t), (2 + Math.cos(3 * t)) * Math.sin(2 * t), Math.sin(3 * t)].map((part) => part * 4.6);
    const minus = (a: number[], b: number[]): number[] => a.map((part, i) => part - b[i]!);
    const cross = ([a, b, c]: number[], [d, e, f]: number[]): number[] => [b! * f! - c! * e!, c! * d! - a! * f!, a! * e! - b! * d!];
    const unit = (way: number[]): number[] => way.map((part) => part / Math.hypot(...way));
    const at = (i: number, j: number): string => {
        const t = (i / 240) * 2 * Math.PI;
        const along = unit(minus(line(t + 1e-4), line(t)));
        const across = unit(cross(along, [0, 0, 1]));
        const up = cross(across, along);
        const turn = (j / 24) * 2 * Math.PI;
        return `vertex ${line(t).map((part, k) => (part + 2.4 * (Math.cos(turn) * across[k]! + Math.sin(turn) * up[k]!)).toFixed(5)).join(" ")}\n`;
    };
    const faces = Array.from({ length: 240 * 24 }, (_, k): string => {
        const [i, j] = [Math.floor(k / 24), k % 24];
        return [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]]
            .map((corners) => `facet normal 0 0 0\nouter loop\n${corners.join("")}endloop\nendfacet\n`).join("");
    });
    return `solid knot\n${faces.join("")}endsolid knot\n`;
}

/** A body inside glass, two thirds engraved. */
async function glass(browser: Browser): Promise<void> {
    const own = mkdtempSync(join(tmpdir(), "studio-"));
    writeFileSync(join(own, "knot.stl"), knot());
    const server = await Server.start([], ["-m", "glass-xyz-100hz", join(own, "knot.stl")], own);
    const { page } = await visit(browser, server.link, { colorScheme: "dark" });
    await page.getByRole("button", { name: "Set --block…" }).first().click();
    await page.getByLabel("Search the options").fill("");
    for (const [name, value] of [["block", "40x40x30"], ["material", "k9"], ["lens", "70"]] as const) await page.locator(`#option-${name}`).fill(value);
    await page.getByRole("button", { name: "Post" }).click();
    await proven(page, 60_000);
    await page.getByLabel("Colour by").selectOption("order");
    await replayed(page);
    await page.getByRole("tab", { name: "Verdict" }).click();
    await page.waitForTimeout(500);
    await page.screenshot({ path: join(folder!, "studio-glass.png") });
}

/** The front of a board, half milled, from above. */
async function board(browser: Browser): Promise<void> {
    const server = await Server.start([example("lamp.toml")], ["-m", "linuxcnc-mill"]);
    const { page } = await visit(browser, server.link);
    await page.getByRole("button", { name: "Set --tool…" }).first().click();
    await page.locator("#option-tool").fill("0.4");
    await page.getByRole("button", { name: "Post" }).click();
    await proven(page);
    await page.locator("[data-view]").focus();
    await page.keyboard.press("1");
    await replayed(page);
    await page.getByRole("tab", { name: "Verdict" }).click();
    await page.waitForTimeout(500);
    await page.screenshot({ path: join(folder!, "studio-board.png") });
}

describe.skipIf(folder === undefined || absent() !== null)("pictures of the documentation", () => {
    test("a replay, dark and light, and a proof that failed", async () => {
        const browser = await launch();
        const source = process.env.TOOLPOST_PART ?? example("dome.cls");
        const server = await Server.start([source], ["-m", process.env.TOOLPOST_MACHINE ?? "fanuc-table-bc"]);
        for (const [name, colorScheme] of [["studio", "light"], ["studio-dark", "dark"]] as const) {
            const { page } = await visit(browser, server.link, { colorScheme });
            await proven(page);
            await replayed(page);
            await page.screenshot({ path: join(folder!, `${name}.png`) });
            await page.close();
        }
        const { page } = await visit(browser, server.link);
        await proven(page);
        await goTo(page, "m40");
        await expect.poll(async () => (await readout(page)).Move).toMatch(/^40\b/);
        await page.locator(".program .cm-line.at").click();
        await page.keyboard.press("End");
        await page.keyboard.type(" Z-3.");
        await page.getByText("✗ NOT PROVEN").waitFor();
        await page.getByRole("tab", { name: "Verdict" }).click();
        await page.waitForTimeout(500);
        await page.screenshot({ path: join(folder!, "studio-failed.png") });
        await board(browser);
        await glass(browser);
        await browser.close();
        await Server.stopAll();
    }, 120_000);
});
