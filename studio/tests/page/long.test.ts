/** A program of more lines than the page keeps. */

import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, test } from "vitest";
import { absent, browserOfTests, covered, goTo, lit, proven, Server, visit, writable } from "./harness.ts";

const MOVES = 400_000;

const source = (moves: number): string => {
    const lines = Array.from({ length: moves }, (_, i) => `GOTO/${i % 100},${(i * 7) % 90},${-(i % 5)}`);
    return ["UNITS/MM", "LOADTL/1", "SPINDL/900,RPM,CLW", "RAPID", "GOTO/0,0,50", "FEDRAT/900,MMPM", ...lines, "FINI", ""].join("\n");
};

/** It runs in the page: a connection is open a second later. */
function opensLate(): void {
    globalThis.WebSocket = class extends WebSocket {
        constructor(...given: ConstructorParameters<typeof WebSocket>) {
            super(...given);
            this.addEventListener("open", (event) => {
                if (!event.isTrusted) return;
                event.stopImmediatePropagation();
                setTimeout(() => this.dispatchEvent(new Event("open")), 1000);
            });
        }
    };
}

describe.skipIf(absent() !== null)("a long program", () => {
    const browser = browserOfTests();

    test("the place is lit and stays in sight, also while the lines round the one before are on their way", async () => {
        const server = await Server.start([], ["-m", "generic-3axis-fanuc"]);
        writeFileSync(join(server.folder, "long.cls"), source(MOVES));
        const { page, complaints } = await visit(browser(), server.link);
        await page.keyboard.press("Control+o");
        // What is walked is there before the verdict, and is not called proven. It may be there for a moment only.
        const walking = page.evaluate(() => new Promise<{ proven: boolean; saved: boolean }>((resolve) => {
            const look = (): void => {
                if (!document.body.textContent.includes("the proof runs: nothing of this is proven yet")) return;
                const save = [...document.querySelectorAll("button")].find((button) => button.textContent.startsWith("Save"));
                resolve({ proven: document.querySelector(".done") !== null, saved: save?.disabled === false });
            };
            new MutationObserver(look).observe(document.body, { subtree: true, childList: true, characterData: true });
        }));
        await page.getByRole("dialog").getByText("long.cls").click();
        expect(await walking).toEqual({ proven: false, saved: false });
        await expect.poll(() => page.locator(".canvas canvas").first().evaluate(covered)).toBeGreaterThan(0);
        await proven(page, 90_000);
        await page.getByText("nothing of this is proven yet").waitFor({ state: "detached" });
        const lit = page.locator(".source .cm-line.at");
        // All but the first two moves are lines of the source behind its seventh.
        for (const line of [150_000, 60_000, 62_000]) {
            await goTo(page, `s${line}`);
            const i = line - 7;
            await expect.poll(() => lit.innerText()).toBe(`GOTO/${i % 100},${(i * 7) % 90},${-(i % 5)}`);
            await page.waitForTimeout(1600);
        }
        await page.waitForTimeout(4000);
        expect(await lit.isVisible()).toBe(true);
        const { y, height } = (await page.locator(".source > .body").boundingBox())!;
        const box = (await lit.boundingBox())!;
        expect(box.y).toBeGreaterThanOrEqual(y);
        expect(box.y + box.height).toBeLessThanOrEqual(y + height);
        // The numbers of the lines are those of the file.
        const numbers = await page.locator(".source .cm-lineNumbers .cm-gutterElement").allInnerTexts();
        expect(numbers).toContain("62000");
        expect(complaints).toEqual([]);
        await page.close();
    }, 150_000);

    test("files are listed as soon as there is a connection, also where they are asked for before", async () => {
        const server = await Server.start([], ["-m", "generic-3axis-fanuc"]);
        writeFileSync(join(server.folder, "small.cls"), source(10));
        const { page, complaints } = await visit(browser(), server.link, {}, opensLate);
        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("small.cls").waitFor();
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("of a text that is kept whole the lines round the place come first; when all are here it can be edited", async () => {
        const server = await Server.start([], ["-m", "generic-3axis-fanuc"]);
        writeFileSync(join(server.folder, "middling.cls"), source(12_000));
        const { page, complaints } = await visit(browser(), server.link);
        const asked: string[] = [];
        page.on("websocket", (socket) => socket.on("framesent", ({ payload }) => asked.push(String(payload))));
        await page.reload();
        await page.getByRole("button", { name: /^Commands/ }).waitFor();
        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("middling.cls").click();
        await proven(page, 60_000);
        await page.locator(".program .cm-line.at").waitFor();
        const first = asked.findIndex((ask) => ask.includes('"of":"program"'));
        // Some twenty lines are in sight.
        const { to } = JSON.parse(/\{"revision".*?\}/.exec(asked[first]!)![0]) as { to: number };
        expect(to).toBeLessThan(100);
        // Its last block stands beyond what came first.
        const before = await lit(page, "program");
        await goTo(page, "11000");
        await expect.poll(() => lit(page, "program")).not.toBe(before);
        await writable(page);
        await page.locator(".program .cm-line.at").click();
        await page.keyboard.press("End");
        await page.keyboard.type(" (LOOK)");
        await page.getByText("▲ edited").waitFor();
        await proven(page, 60_000);
        await page.getByRole("button", { name: "Differences" }).click();
        await expect.poll(() => page.locator(".program .cm-changedLine").innerText()).toContain("(LOOK)");
        expect(await page.locator(".program .cm-changedLine").count()).toBe(1);
        expect(complaints).toEqual([]);
        await page.close();
    }, 120_000);
});
