import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import type { Page } from "playwright-core";
import { describe, expect, test } from "vitest";
import { absent, accessible, browserOfTests, covered, goTo, lit, proven, readout, Server, visit, writable } from "./harness.ts";

const command = process.env.TOOLPOST ?? join(process.env.CARGO_TARGET_DIR ?? resolve(import.meta.dirname, "../../../target"), "debug/toolpost");

/** A sphere of this radius, mm, as a text STL. */
export function ball(radius: number): string {
    const at = (i: number, j: number): string => {
        const [a, b] = [(i * Math.PI) / 24, (j * Math.PI) / 24];
        return `vertex ${[Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)].map((part) => (part * radius).toFixed(6)).join(" ")}\n`;
    };
    const faces = Array.from({ length: 24 * 48 }, (_, k) => {
        const [i, j] = [Math.floor(k / 48), k % 48];
        return [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]];
    });
    return `solid ball\n${faces.flat().map((corners) => `facet normal 0 0 0\nouter loop\n${corners.join("")}endloop\nendfacet\n`).join("")}endsolid ball\n`;
}

/** What the findings ask for is given by the form. */
async function give(page: Page, options: Record<string, string>): Promise<void> {
    const [first] = Object.keys(options);
    await page.getByRole("button", { name: `Set --${first}…` }).first().click();
    await expect.poll(() => page.evaluate(() => document.activeElement?.id)).toBe(`option-${first}`);
    // The others that it names stand below it.
    for (const [name, value] of Object.entries(options)) await page.locator(`#option-${name}`).fill(value);
    await page.getByRole("button", { name: "Post" }).click();
}

const OPTIONS = { block: "20x20x30", material: "k9", lens: "70" };

describe.skipIf(absent() !== null)("engraving inside glass", () => {
    const browser = browserOfTests();

    async function opened(machine = "glass-xyz-100hz"): Promise<{ server: Server; page: Page; complaints: string[] }> {
        const folder = mkdtempSync(join(tmpdir(), "studio-"));
        writeFileSync(join(folder, "ball.stl"), ball(4));
        const own = mkdtempSync(join(tmpdir(), "studio-"));
        const server = await Server.start([join(folder, "ball.stl")], ["-m", machine], own);
        rmSync(folder, { recursive: true });
        const { page, complaints } = await visit(browser(), server.link);
        await give(page, OPTIONS);
        await proven(page);
        return { server, page, complaints };
    }

    test("a body asks for what it lacks, is proven, seen in its block, picked, replayed and read out", async () => {
        const { page, complaints } = await opened();
        await page.getByText(/^✓ PROVEN/).locator("..").getByText("pulses").waitFor();
        const canvas = page.locator(".canvas canvas").first();
        await expect.poll(() => canvas.evaluate(covered)).toBeGreaterThan(0.01);
        const view = page.locator("[data-view]");
        const box = (await view.boundingBox())!;
        // The ball is in the middle of the block.
        const before = await lit(page, "program");
        await view.click({ position: { x: box.width / 2, y: box.height / 2 } });
        await expect.poll(() => lit(page, "program")).not.toBe(before);
        const block = await lit(page, "program");
        expect(block).toMatch(/PULSE X[\d.]+ Y[\d.]+ Z-[\d.]+$/);
        const read = await readout(page);
        expect(Object.keys(read).slice(0, 5)).toEqual(["X", "Y", "Z", "Focus", "Pulse"]);
        // The readout's axes are the words of the block, and the focus lies on the ball, whose middle is that of the block.
        for (const axis of ["X", "Y", "Z"]) expect(read[axis]).toContain(new RegExp(`${axis}(-?[\\d.]+)`).exec(block)![1]!);
        const [x, y, z] = read.Focus!.split(/\s+/).map(Number) as [number, number, number];
        expect(Math.abs(Math.hypot(x - 10, y - 10, z - 15) - 4)).toBeLessThan(0.05);
        // The slider goes through the pulses in their order.
        const slider = page.getByLabel("Time of the machine");
        await slider.evaluate((input: HTMLInputElement) => {
            input.value = String(Number(input.max) / 2);
            input.dispatchEvent(new Event("input", { bubbles: true }));
        });
        await expect.poll(async () => (await readout(page)).Pulse).not.toBe(read.Pulse);
        const [now, all] = (await readout(page)).Pulse!.replaceAll(",", "").split(" of ").map(Number) as [number, number];
        expect(Math.abs(now / all - 0.5)).toBeLessThan(0.05);
        await goTo(page, "1");
        // The first line tells what the program is: the first pulse is what it leads to.
        await expect.poll(async () => (await readout(page)).Pulse).toMatch(/^1 of/);
        expect(await page.getByLabel("Colour by").inputValue()).toBe("order");
        for (const colours of ["kind", "operation"]) await page.getByLabel("Colour by").selectOption(colours);
        await page.getByLabel("Colour by").selectOption("order");
        // The engraver round it.
        const alone = await canvas.evaluate(covered);
        await view.focus();
        await page.keyboard.press("m");
        await expect.poll(() => canvas.evaluate(covered)).toBeGreaterThan(alone + 0.01);
        await accessible(page, "glass");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("what is saved are the bytes of the command, and an edit is proven or refused", async () => {
        const { server, page, complaints } = await opened();
        await page.keyboard.press("Control+s");
        await page.getByLabel("Name of the program's file").waitFor();
        await page.getByRole("dialog").getByRole("button", { name: "Save" }).click();
        await page.getByText("saved ball.prg, ball.prg.report.json").waitFor();
        const words = Object.entries(OPTIONS).flatMap(([name, value]) => [`--${name}`, value]);
        const made = spawnSync(command, ["glass", "ball.stl", "-m", "glass-xyz-100hz", "-o", "command.prg", ...words], { cwd: server.folder });
        expect(made.status, String(made.stderr)).toBe(0);
        const read = (name: string): string => readFileSync(join(server.folder, name), "utf8");
        expect(read("ball.prg")).toBe(read("command.prg"));
        expect(read("ball.prg.report.json")).toBe(read("command.prg.report.json"));

        await goTo(page, "9");
        await expect.poll(() => lit(page, "program")).toMatch(/^N9 /);
        await writable(page);
        await page.locator(".program .cm-line.at").click();
        await page.keyboard.press("End");
        await page.keyboard.press("Backspace");
        await page.keyboard.press("Backspace");
        await page.keyboard.press("Backspace");
        await page.keyboard.type("999");
        await page.getByText("✗ NOT PROVEN").waitFor();
        expect(await page.locator(".findings").innerText()).toMatch(/stray|lost/);
        // What its control does not take is not proven either.
        await page.keyboard.type(" X");
        await page.getByText("a word too many").waitFor();
        await page.getByText("✗ NOT PROVEN").waitFor();
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("points that are dropped are offered the machines that can take them, and are drawn by WebGL as by the rasteriser", async () => {
        const server = await Server.start([], []);
        const { page, complaints } = await visit(browser(), server.link);
        // So far apart that lines between them would be seen.
        const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => `${12 * (i & 1)} ${6 * (i & 2)} ${5 * (i & 4)}\n`).join("");
        const data = await page.evaluateHandle((text) => {
            const transfer = new DataTransfer();
            transfer.items.add(new File([text], "corners.xyz"));
            return transfer;
        }, corners);
        await page.dispatchEvent(".view", "drop", { dataTransfer: data });
        await page.getByRole("dialog", { name: "Machine" }).waitFor();
        const options = page.getByRole("dialog").getByRole("option");
        // They come first, and of the others each says that it is none for it.
        await expect.poll(async () => (await options.allInnerTexts()).slice(0, 6).every((text) => text.startsWith("glass-"))).toBe(true);
        for (const text of (await options.allInnerTexts()).slice(6)) expect(text).toMatch(/^(?!glass-)[^]*not for this source$/);
        await page.keyboard.type("planar");
        await page.keyboard.press("Enter");
        await give(page, OPTIONS);
        await proven(page);
        const canvas = page.locator(".canvas canvas").first();
        const inked = async (): Promise<number> => {
            await page.waitForTimeout(500);
            const shot = (await canvas.screenshot()).toString("base64");
            return page.evaluate(async (png) => {
                const image = new Image();
                image.src = `data:image/png;base64,${png}`;
                await image.decode();
                const copy = document.createElement("canvas");
                Object.assign(copy, { width: image.width, height: image.height });
                const context = copy.getContext("2d")!;
                context.drawImage(image, 0, 0);
                const pixels = new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
                return pixels.filter((pixel) => pixel !== pixels[0]).length;
            }, shot);
        };
        const plain = await inked();
        expect(plain).toBeGreaterThan(1000);
        await page.keyboard.press("Control+k");
        await page.keyboard.type("draw by webgl");
        await page.keyboard.press("Enter");
        expect(Math.abs((await inked()) / plain - 1)).toBeLessThan(0.1);
        expect(complaints).toEqual([]);
        await page.close();
    });
});
