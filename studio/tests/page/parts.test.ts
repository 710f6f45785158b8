/** A robot's program of several files, as it stands in the folder and on the page. */

import { existsSync, mkdtempSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { afterEach, beforeAll, describe, expect, test } from "vitest";
import { absent, accessible, answersLate, browserOfTests, goTo, lit, proven, Server, visit, writable, type Visit } from "./harness.ts";

/** Rows of cuts, a way up between any two. */
const rows = Array.from({ length: 30 }, (_, i) => 30 + i).map((y) =>
    `RAPID\nGOTO/80,${y},20\nFEDRAT/MMPM,600\nGOTO/80,${y},0\nGOTO/100,${y},0\nGOTO/120,${y},0\nRAPID\nGOTO/120,${y},20\n`);
const source = `PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\n${rows.join("")}SPINDL/OFF\nFINI\n`;
const machine = 'extends = "kuka-kr6-r900"\n\n[capabilities]\nprogram_lines = 60\n';

/** As the command starts with a source and a machine that lie in its folder. */
const start = (folder: string): Promise<Server> => Server.start([], [join(folder, "job.cls"), "-m", join(folder, "mine.toml")], folder);

describe.skipIf(absent() !== null)("the page with a program of several files", () => {
    const browser = browserOfTests();
    let server: Server;
    let open: Visit | null = null;

    beforeAll(async () => {
        const folder = mkdtempSync(join(tmpdir(), "studio-"));
        writeFileSync(join(folder, "job.cls"), source);
        writeFileSync(join(folder, "mine.toml"), machine);
        server = await start(folder);
    });
    afterEach(async () => {
        expect(open?.complaints ?? []).toEqual([]);
        await open?.page.close();
        open = null;
    });

    const begin = async (of = server): Promise<Page> => {
        open = await visit(browser(), of.link);
        await proven(open.page);
        await open.page.locator(".program .cm-line").first().waitFor();
        return open.page;
    };
    const choose = async (page: Page, file: string): Promise<void> => {
        await page.getByLabel("File of the program").selectOption(file);
        await shows(page, file);
    };
    /** A part of a program for a KUKA begins with its name. */
    const shows = (page: Page, file: string): Promise<void> =>
        page.locator(".program .cm-line", { hasText: `DEF ${file.replace(".src", "")} ( )` }).waitFor();
    /** Behind the text of a line. */
    const type = async (page: Page, line: string, text: string): Promise<void> => {
        await writable(page);
        await page.locator(".program .cm-line", { hasText: line }).first().click();
        await page.keyboard.press("End");
        await page.keyboard.type(text);
    };
    const text = (page: Page): Promise<string> => page.locator(".program .cm-content").innerText();
    const discard = async (page: Page): Promise<void> => {
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
    };

    test("a file that is chosen is shown, and the cursor leads to that of its block", async () => {
        const page = await begin();
        await choose(page, "job_3.src");
        // It stays while nothing else is asked for.
        await page.waitForTimeout(500);
        await shows(page, "job_3.src");
        await page.locator(".program .cm-line", { hasText: "LIN {" }).nth(2).click();
        await expect.poll(() => lit(page, "program")).toMatch(/^LIN \{/);
        await goTo(page, "m1");
        await shows(page, "job_1.src");
        await accessible(page, "parts");
    });

    test("a file that is chosen stays, however late the click before is answered, and when all is posted anew", async () => {
        open = await visit(browser(), server.link, {}, answersLate);
        const { page } = open;
        await proven(page);
        await choose(page, "job_1.src");
        const third = async (): Promise<void> => {
            expect(await page.getByLabel("File of the program").inputValue()).toBe("job_3.src");
            // The place is in another file: this one stands at its head.
            await shows(page, "job_3.src");
        };
        await page.evaluate(() => Object.assign(globalThis, { late: 700 }));
        await page.locator(".program .cm-line", { hasText: "LIN {" }).nth(2).click();
        await page.getByLabel("File of the program").selectOption("job_3.src");
        await expect.poll(() => lit(page, "source")).toMatch(/^GOTO/);
        await page.waitForTimeout(1000);
        await third();
        await page.evaluate(() => Object.assign(globalThis, { late: 0 }));
        writeFileSync(join(server.folder, "mine.toml"), `title = "Ours"\n${machine}`);
        await page.getByText("mine.toml changed: posted again").waitFor();
        await proven(page);
        await page.waitForTimeout(500);
        await third();
        // The next place leads away.
        await goTo(page, "m1");
        await shows(page, "job_1.src");
    });

    test("an edit of one file is proven with all others, named where it is wrong, and saved with them", async () => {
        const page = await begin();
        await choose(page, "job_2.src");
        await type(page, "LIN {X 100.", " ; mine");
        await page.getByText("▲ edited").waitFor();
        await proven(page);
        await shows(page, "job_2.src");
        expect(await text(page)).toContain("; mine");
        // Its place is one: the block in the part, the record, and the template that wrote it.
        await writable(page);
        await page.locator(".program .cm-line", { hasText: "LIN {X 120." }).first().click();
        await expect.poll(() => lit(page, "program")).toContain("LIN {X 120.");
        expect(await lit(page, "source")).toMatch(/^GOTO\/120,/);
        await page.getByRole("group", { name: "Template of the block" }).getByText("linear").waitFor();
        // A second file, and what was typed can be undone in each.
        await choose(page, "job_4.src");
        await type(page, "LIN {X 100.", " ; yours");
        // Its proof begins when the typing rests: PROVEN is said of the edit before until then.
        await page.waitForTimeout(1000);
        await proven(page);
        await choose(page, "job_2.src");
        expect(await text(page)).toContain("; mine");
        await page.getByRole("button", { name: "Differences" }).click();
        await expect.poll(() => page.locator(".program .cm-changedLine").count()).toBe(1);
        await page.getByRole("button", { name: "Differences" }).click();
        await page.locator(".program .cm-content").focus();
        for (let undone = 0; undone < 7 && (await text(page)).includes("; mine"); undone++) await page.keyboard.press("Control+z");
        expect(await text(page)).not.toContain("; mine");
        await proven(page);
        // A wrong number: the file and the line are named, and nothing can be saved.
        await writable(page);
        await page.locator(".program .cm-line", { hasText: "LIN {X 120." }).first().click();
        await page.keyboard.press("Home");
        for (let at = 0; at < 7; at++) await page.keyboard.press("ArrowRight");
        await page.keyboard.type("1");
        await page.getByText("✗ NOT PROVEN").waitFor();
        await page.getByRole("tab", { name: "Verdict" }).click();
        expect(await page.getByRole("region", { name: "First mismatch" }).innerText()).toContain("job_2.src line");
        expect(await page.getByLabel("File of the program").locator("option", { hasText: "job_2.src" }).innerText()).toContain("✗▲");
        expect(await page.getByRole("button", { name: "Save…" }).isDisabled()).toBe(true);
        await writable(page);
        await page.locator(".program .cm-content").focus();
        await page.keyboard.press("Control+z");
        await proven(page);
        await page.keyboard.press("Control+s");
        await page.getByRole("dialog").getByRole("button", { name: "Save" }).click();
        await page.getByText(/saved job\.src, job_1\.src, .*job\.src\.report\.json/).waitFor();
        const read = (name: string): string => readFileSync(join(server.folder, name), "utf8");
        expect(read("job_4.src")).toContain("; yours\r\n");
        expect(read("job_2.src")).not.toContain("mine");
        await discard(page);
        expect(await text(page)).not.toContain("; yours");
    });

    test("edits of several files outlive a reload and a killed server, and are proven with what is posted then", async () => {
        const folder = mkdtempSync(join(tmpdir(), "studio-"));
        writeFileSync(join(folder, "job.cls"), source);
        writeFileSync(join(folder, "mine.toml"), machine);
        const first = await start(folder);
        const drafts = join(folder, ".toolpost/drafts");
        const kept = (): string => (existsSync(drafts) ? readdirSync(drafts) : []).filter((name) => name.endsWith(".text")).map((name) => readFileSync(join(drafts, name), "utf8")).join("");
        let page = await begin(first);
        await choose(page, "job_2.src");
        await type(page, "LIN {X 100.", " ; mine");
        await choose(page, "job_4.src");
        await type(page, "LIN {X 100.", " ; yours");
        await proven(page);
        await expect.poll(kept).toMatch(/; mine[^]*; yours/);
        const resumed = async (page: Page): Promise<void> => {
            await page.getByRole("button", { name: "Continue" }).click();
            await page.getByText("▲ edited").waitFor();
            await proven(page);
            for (const [file, text] of [["job_2.src", "; mine"], ["job_4.src", "; yours"]] as const) {
                await choose(page, file);
                await page.locator(".program .cm-line", { hasText: text }).waitFor();
            }
            await page.getByRole("button", { name: "Differences" }).click();
            await expect.poll(() => page.locator(".program .cm-changedLine").count()).toBe(1);
        };
        // Right behind a key.
        await page.locator(".program .cm-content").focus();
        await page.keyboard.type("!");
        await page.reload();
        await resumed(page);
        await page.locator(".program .cm-line", { hasText: "; yours!" }).waitFor();
        await first.end("SIGKILL");
        await page.getByText("connection lost").waitFor();
        open!.complaints.length = 0;
        await page.close();
        const second = await start(folder);
        page = await begin(second);
        await resumed(page);
        await discard(page);
        await expect.poll(kept).toBe("");
    });

    test("a program that calls itself by the name of its file gets another one, where its controller takes none of the source", async () => {
        writeFileSync(join(server.folder, "a-b.cls"), source);
        open = await visit(browser(), server.link);
        const { page } = open;
        await proven(page);
        await page.keyboard.press("Control+o");
        await page.getByRole("listbox").getByText("a-b.cls", { exact: true }).click();
        await page.getByText(/`a-b` is none/).waitFor();
        await page.getByRole("button", { name: "Set --output…" }).first().click();
        await page.locator("#option-output").fill("a_b");
        await page.getByRole("button", { name: "Post", exact: true }).click();
        await proven(page);
        await page.keyboard.press("Control+s");
        await page.keyboard.press("Enter");
        await page.getByText(/saved a_b\.src/).waitFor();
        expect(readFileSync(join(server.folder, "a_b.src"), "utf8")).toContain("DEF a_b");
    });

    test("files of the program that are dropped on it take the place of those of the same names", async () => {
        const page = await begin();
        const posted = await text(page);
        await page.keyboard.press("Control+k");
        await page.keyboard.type("prove a program");
        await page.keyboard.press("Enter");
        const part = readFileSync(join(server.folder, "job_1.src"), "utf8").replace("LIN {X 100.", "LIN {X 101.");
        await page.locator("dialog input[type=file]").setInputFiles([{ name: "job_1.src", mimeType: "text/plain", buffer: Buffer.from(part) }]);
        await page.getByText("✗ NOT PROVEN").waitFor();
        await choose(page, "job_1.src");
        await page.locator(".program .cm-line", { hasText: "LIN {X 101." }).waitFor();
        await discard(page);
        expect(posted).not.toContain("X 101.");
    });
});
