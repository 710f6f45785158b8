import { mkdtempSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { mkdir } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { describe, expect, test } from "vitest";
import { absent, accessible, browserOfTests, example, lit, proven, readout, Server, visit, writable } from "./harness.ts";

const HEAD = "%FSLAX46Y46*%\n%MOMM*%\n";
const track = `${HEAD}%ADD10C,1.0*%\nD10*\nX2000000Y2000000D02*\nX8000000Y2000000D01*\nM02*\n`;
const edge = (last: string): string =>
    `${HEAD}%ADD10C,0.1*%\nD10*\nX0Y0D02*\nX10000000Y0D01*\nX10000000Y5000000D01*\nX0Y5000000D01*\n${last}M02*\n`;

/** The program of this name is chosen, and its job has come. */
async function choose(page: Page, name: string): Promise<void> {
    const tab = page.getByRole("group", { name: "Programs of the board" }).getByRole("button", { name: new RegExp(`^✓ ${name}($| ?,)`) });
    await tab.click();
    await expect.poll(() => tab.getAttribute("aria-pressed")).toBe("true");
}

/** What the findings ask for is given by the form. */
async function give(page: Page, name: string, value: string): Promise<void> {
    await page.getByRole("button", { name: `Set --${name}…` }).first().click();
    await expect.poll(() => page.evaluate(() => document.activeElement?.id)).toBe(`option-${name}`);
    await page.locator(`#option-${name}`).fill(value);
    await page.getByRole("button", { name: "Post" }).click();
}

describe.skipIf(absent() !== null)("circuit boards", () => {
    const browser = browserOfTests();

    test("a board opens, its tool is asked for, its programs are chosen, a click on a cut lights its block, all are saved together", async () => {
        const server = await Server.start([example("lamp.toml")], ["-m", "grbl-3018"]);
        const { page, complaints } = await visit(browser(), server.link);
        await give(page, "tool", "0.3");
        await proven(page);
        const programs = page.getByRole("group", { name: "Programs of the board" });
        // GRBL has no cycles: the holes are drilled by moves, which is a finding of that program.
        expect((await programs.getByRole("button").allInnerTexts()).map((text) => text.replace("\n", ""))).toEqual(["✓ front", "✓ drill 1, 1 finding", "✓ back", "✓ outline"]);
        await choose(page, "outline");
        await expect.poll(() => page.locator(".program h2").innerText()).toContain("outline.gcode");
        await choose(page, "front");
        await expect.poll(() => page.locator(".program h2").innerText()).toContain("front.gcode");

        // From above, a cut is found near the middle of the picture: the lamp has copper all over.
        const view = page.locator("[data-view]");
        await view.focus();
        await page.keyboard.press("1");
        const box = (await view.boundingBox())!;
        const before = await lit(page, "program");
        let found = false;
        for (let step = 0; step < 60 && !found; step++) {
            await view.click({ position: { x: box.width * (0.2 + step * 0.01), y: box.height / 2 } });
            found = (await lit(page, "program")) !== before;
        }
        expect(found).toBe(true);
        await expect.poll(() => lit(page, "program")).toMatch(/^[GXYZ]/);
        expect((await readout(page)).Tool).toContain("mill");

        // The net under the pointer has its name.
        const nets = new Set<string>();
        for (let step = 0; step < 80; step++) {
            await page.mouse.move(box.x + box.width * (0.1 + step * 0.01), box.y + box.height * 0.5);
            const net = (await readout(page)).Net;
            if (net !== undefined) nets.add(net);
        }
        expect(nets.size).toBeGreaterThan(0);

        await page.keyboard.press("Control+s");
        await page.getByLabel("Name of the folder for the programs").fill("out");
        await page.getByRole("dialog").getByRole("button", { name: "Save" }).click();
        await page.getByText(/^saved out\/front.gcode/).waitFor();
        expect(readdirSync(join(server.folder, "out")).toSorted()).toEqual(["back.gcode", "drill.gcode", "front.gcode", "outline.gcode", "report.json"]);
        const report = JSON.parse(readFileSync(join(server.folder, "out/report.json"), "utf8")) as { options: string[] };
        expect(report.options).toEqual(["--tool=0.3"]);
        await accessible(page, "a board");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a folder of plots is picked; what could not be made is named, with its finding", async () => {
        const folder = mkdtempSync(join(tmpdir(), "studio-"));
        await mkdir(join(folder, "plots"));
        writeFileSync(join(folder, "plots/b.gtl"), track);
        writeFileSync(join(folder, "plots/b.gko"), edge(""));
        const server = await Server.start([], ["-m", "grbl-3018"], folder);
        const { page, complaints } = await visit(browser(), server.link);
        await page.keyboard.press("Control+o");
        await page.getByRole("option", { name: /^plots\// }).click();
        await page.getByRole("option", { name: "All files of plots as a circuit board" }).click();
        await give(page, "tool", "0.3");
        await page.getByText("◐ PROVEN, PARTLY MADE").waitFor();
        expect(await page.getByRole("group", { name: "Programs of the board" }).getByRole("button").allInnerTexts()).toEqual(["✓ front", "✗ outline.gcode"]);
        expect(await page.locator(".findings").innerText()).toContain("outline-open");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a program of a board is edited: proven anew, refused when it cuts otherwise, saved by itself, and discarded", async () => {
        const server = await Server.start([example("lamp.toml")], ["-m", "grbl-3018"]);
        const { page, complaints } = await visit(browser(), server.link);
        await give(page, "tool", "0.3");
        await proven(page);
        await choose(page, "drill");
        await page.getByText("G21 G17").first().waitFor();
        const line = page.locator(".program .cm-line").filter({ hasText: /^G1 Z-|^Z-/ }).first();
        await writable(page);
        await line.click();
        await page.keyboard.press("End");
        await page.keyboard.press("Backspace");
        await page.getByText("✗ NOT PROVEN").waitFor();
        await page.keyboard.press("Control+z");
        await page.keyboard.press("End");
        await page.keyboard.type(" ");
        await proven(page);
        await page.getByText("of lamp: save or discard the edit to see its other programs").waitFor();
        await expect.poll(() => page.getByRole("button", { name: "✓ front" }).count()).toBe(0);
        await page.keyboard.press("Control+s");
        await page.getByLabel("Name of the program's file").waitFor();
        await page.getByRole("dialog").getByRole("button", { name: "Save" }).click();
        await page.getByText("saved drill.gcode, drill.gcode.report.json").waitFor();
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
        await expect.poll(() => page.locator(".program h2").innerText()).toContain("drill.gcode");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("several files that are dropped are a board", async () => {
        const server = await Server.start([], ["-m", "grbl-3018"]);
        const { page, complaints } = await visit(browser(), server.link);
        const data = await page.evaluateHandle(([copper, line]) => {
            const transfer = new DataTransfer();
            transfer.items.add(new File([copper!], "b.gtl"));
            transfer.items.add(new File([line!], "b.gko"));
            return transfer;
        }, [track, edge("X0Y0D01*\n")]);
        await page.dispatchEvent(".view", "drop", { dataTransfer: data });
        await give(page, "tool", "0.3");
        await proven(page);
        expect(await page.getByRole("group", { name: "Programs of the board" }).getByRole("button").allInnerTexts()).toEqual(["✓ front", "✓ outline"]);
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("two boards in one folder are refused with the way out", async () => {
        const folder = mkdtempSync(join(tmpdir(), "studio-"));
        await mkdir(join(folder, "two"));
        for (const name of ["a", "b"]) writeFileSync(join(folder, `two/${name}.kicad_pcb`), "(kicad_pcb (version 20221018))");
        const server = await Server.start([], ["-m", "grbl-3018"], folder);
        const { page } = await visit(browser(), server.link);
        await page.keyboard.press("Control+o");
        await page.getByRole("option", { name: /^two\// }).click();
        await page.getByRole("option", { name: /as a circuit board/ }).click();
        await page.getByText("there are several boards in this folder").waitFor();
        await page.getByText("give the file of the one").waitFor();
        await page.close();
    });
});
