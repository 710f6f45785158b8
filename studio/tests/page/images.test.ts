/** The pictures of docs/studio.md: `make images-studio`. */

import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { describe, test } from "vitest";
import { absent, example, goTo, launch, proven, Server, visit } from "./harness.ts";

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
        await page.waitForTimeout(300);
        await page.locator(".program .cm-line.at").click();
        await page.keyboard.press("End");
        await page.keyboard.type(" Z-3.");
        await page.getByText("✗ NOT PROVEN").waitFor();
        await page.getByRole("tab", { name: "Verdict" }).click();
        await page.waitForTimeout(500);
        await page.screenshot({ path: join(folder!, "studio-failed.png") });
        await board(browser);
        await browser.close();
        await Server.stopAll();
    }, 120_000);
});
