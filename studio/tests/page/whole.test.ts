import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, test } from "vitest";
import { absent, accessible, answersLate, example, goTo, launch, lit, proven, readout, Server, visit, visitOn, writable, type Visit } from "./harness.ts";

/** The numbers of a `GOTO/`. */
const goto = (text: string): number[] => text.replace(/^GOTO\s*\//, "").split(",").map(Number);

/** An edited program, from its first line on: the place may be farther down. */
async function editedFromTop(page: Page): Promise<void> {
    await page.getByText("▲ edited").waitFor();
    await page.locator(".program .cm-scroller").evaluate((element) => (element.scrollTop = 0));
}

/** The files of the edits that the server keeps: of each its text, and what it is of. */
const drafts = (server: Server): string[] => {
    const folder = join(server.folder, ".toolpost/drafts");
    return existsSync(folder) ? readdirSync(folder) : [];
};

describe.skipIf(absent() !== null)("the page on a mill of three axes", () => {
    let browser: Browser;
    let server: Server;
    let open: Visit | null = null;

    beforeAll(async () => {
        [browser, server] = await Promise.all([launch(), Server.start([example("plate.cls")], ["-m", "generic-3axis-fanuc"])]);
    });
    afterAll(async () => {
        await browser.close();
        await Server.stopAll();
    });
    afterEach(async () => {
        const complaints = open?.complaints ?? [];
        await open?.page.close();
        open = null;
        // No violation of the content policy, nothing that failed unseen.
        expect(complaints).toEqual([]);
    });

    const begin = async (more = {}) => {
        open = await visit(browser, server.link, more);
        await proven(open.page);
        await open.page.locator(".program .cm-line.at").waitFor();
        return open.page;
    };

    test("the token is taken out of the address", async () => {
        const page = await begin();
        expect(page.url()).not.toContain(new URL(server.link).hash.slice(1));
    });

    test("a reload shows what was worked on; the link, opened again in the same tab, what its command named", async () => {
        const page = await begin();
        const button = page.getByTitle("Open a source (Ctrl O)");
        const named = await button.innerText();
        await page.keyboard.press("Control+m");
        await page.keyboard.type("generic-3axis-haas");
        await page.keyboard.press("Enter");
        const machine = page.getByTitle("Choose the machine (Ctrl M)");
        await expect.poll(() => machine.innerText()).toBe("generic-3axis-haas");
        await proven(page);
        await page.reload();
        await proven(page);
        expect([await button.innerText(), await machine.innerText()]).toEqual([named, "generic-3axis-haas"]);
        await page.goto("about:blank");
        await page.goto(server.link);
        await proven(page);
        expect([await button.innerText(), await machine.innerText()]).toEqual([named, "generic-3axis-fanuc"]);
    });

    test("by keyboard alone a source in a folder below is opened", async () => {
        const page = await begin();
        mkdirSync(join(server.folder, "below"), { recursive: true });
        copyFileSync(example("plate.cls"), join(server.folder, "below/other.cls"));
        await page.keyboard.press("Control+o");
        await page.getByText("below/").waitFor();
        await page.keyboard.type("below");
        await page.keyboard.press("Enter");
        await page.getByText("other.cls").waitFor();
        // The first entry is a file, not all of them as a board.
        await page.keyboard.press("Enter");
        await expect.poll(() => page.getByTitle("Open a source (Ctrl O)").innerText()).toBe("other.cls");
        await proven(page);
    });

    test.each([1, 2, 0.5])("a click on a move lights its block and its record, and the axes stand where the record goes; zoom %d", async (deviceScaleFactor) => {
        const page = await begin({ deviceScaleFactor });
        const view = (await page.locator(".canvas").boundingBox())!;
        const before = await lit(page, "program");
        // A spiral of clicks from the middle, until one meets a line.
        for (let step = 0; step < 40 && (await lit(page, "program")) === before; step++) {
            const radius = step * 4;
            await page.mouse.click(view.x + view.width / 2 + radius * Math.cos(step), view.y + view.height / 2 + radius * Math.sin(step));
            await page.waitForTimeout(60);
        }
        // The last click may still be on its way.
        await page.waitForTimeout(300);
        const block = await lit(page, "program");
        expect(block).not.toBe(before);
        await expect.poll(async () => {
            const { X, Y, Z } = await readout(page);
            return [X, Y, Z].map((value) => Number.parseFloat(value!));
        }).toEqual(goto(await lit(page, "source")).slice(0, 3).map((value) => expect.closeTo(value, 3)));
        expect(block).toMatch(/[XYZ]/);
    });

    test("what has come of a picture is not fetched again when the cursor moves", async () => {
        const page = await begin();
        await page.waitForTimeout(300);
        const asked: string[] = [];
        page.on("request", (request) => request.url().includes("/geometry/") && asked.push(request.url()));
        await goTo(page, "m8");
        await goTo(page, "m20");
        await page.waitForTimeout(300);
        expect(asked).toEqual([]);
    });

    test("a click on a block goes to its move: the axes stand where its words say", async () => {
        const page = await begin();
        const line = page.locator(".program .cm-line", { hasText: /X-?[\d.]+.*Y-?[\d.]+/ }).first();
        const text = await line.innerText();
        await line.click();
        await page.locator(".program .cm-line.at", { hasText: text }).waitFor();
        const { X, Y } = await readout(page);
        expect(Number.parseFloat(X!)).toBeCloseTo(Number(/X(-?[\d.]+)/.exec(text)![1]), 3);
        expect(Number.parseFloat(Y!)).toBeCloseTo(Number(/Y(-?[\d.]+)/.exec(text)![1]), 3);
    });

    test("a click on a record of the source lights the block that it became", async () => {
        const page = await begin();
        const line = page.locator(".source .cm-line", { hasText: /^GOTO\// }).nth(3);
        const [x] = goto(await line.innerText());
        await line.click();
        await expect.poll(async () => Number.parseFloat((await readout(page)).X ?? "")).toBeCloseTo(x!, 3);
    });

    test("an edit by hand is proven anew; discarding it brings back what was posted", async () => {
        const page = await begin();
        await goTo(page, "m8");
        const text = await lit(page, "program");
        await writable(page);
        await page.locator(".program .cm-line.at").click();
        await page.keyboard.press("End");
        await page.keyboard.type(" Z-7.777");
        await page.getByText("✗ NOT PROVEN").waitFor();
        expect(await page.getByRole("button", { name: "Save…" }).isDisabled()).toBe(true);
        await page.keyboard.press("Control+s");
        await page.getByText("it is not saved").waitFor();
        expect(await page.getByRole("dialog").count()).toBe(0);
        await page.keyboard.type("name.nc");
        expect(await page.locator(".program .cm-content").innerText()).not.toContain("name.nc");
        await page.getByRole("tab", { name: "Verdict" }).click();
        expect(await page.getByRole("region", { name: "First mismatch" }).innerText()).toContain("Z-7.777");
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
        await page.locator(".program .cm-line", { hasText: text }).first().waitFor();
        expect(await page.locator(".program .cm-content").innerText()).not.toContain("Z-7.777");
    });

    test("an edit outlives a reload: it is offered again, and goes on", async () => {
        const page = await begin();
        await writable(page);
        await page.locator(".program .cm-line").first().click();
        await page.keyboard.press("End");
        await page.keyboard.type(" (mine)");
        await page.getByText("▲ edited").waitFor();
        await expect.poll(() => drafts(server)).toHaveLength(2);
        await page.reload();
        await page.getByRole("button", { name: "Continue" }).click();
        await editedFromTop(page);
        await page.locator(".program .cm-line", { hasText: "(mine)" }).waitFor();
        // It is an edit of what is posted: what differs from that is known.
        await page.getByRole("button", { name: "Differences" }).click();
        await expect.poll(() => page.locator(".program .cm-changedLine").count()).toBe(1);
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
        expect(await page.getByRole("button", { name: "Continue" }).count()).toBe(0);
    });

    const edit = async (page: Page, text: string): Promise<void> => {
        await writable(page);
        await page.locator(".program .cm-line").first().click();
        await page.keyboard.press("End");
        await page.keyboard.type(text);
        await page.getByText("▲ edited").waitFor();
    };

    test("a reload right behind a key loses none, and place and speed are those of before", async () => {
        const page = await begin();
        await goTo(page, "m8");
        await page.getByLabel("Speed of the replay").selectOption({ label: "× 50" });
        const at = await lit(page, "source");
        await writable(page);
        await page.locator(".program .cm-line").nth(1).click();
        await page.keyboard.press("End");
        await page.keyboard.type(" (last key)");
        await goTo(page, "m8");
        page.on("dialog", (dialog) => void dialog.accept());
        await writable(page);
        await page.locator(".program .cm-line").nth(1).click();
        await page.keyboard.press("End");
        await page.keyboard.type("(!)");
        await page.reload();
        await page.getByText("an edit of plate.cls is kept").waitFor();
        await proven(page);
        expect(await page.getByLabel("Speed of the replay").inputValue()).toBe("f50");
        await page.getByRole("button", { name: "Continue" }).click();
        await editedFromTop(page);
        await page.locator(".program .cm-line", { hasText: "(last key)(!)" }).waitFor();
        expect(await page.getByRole("button", { name: "Continue" }).count()).toBe(0);
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
        await goTo(page, "m8");
        await expect.poll(() => lit(page, "source")).toBe(at);
        await page.reload();
        await proven(page);
        await expect.poll(() => lit(page, "source")).toBe(at);
    });

    test("keys that come before the first program is here are no edit", async () => {
        const page = await browser.newPage();
        open = { page, complaints: [] };
        await page.addInitScript(answersLate);
        // The editor comes when there is a program already, and its text behind it.
        let comes = (): void => {};
        const coming = new Promise<void>((resolve) => (comes = resolve));
        await page.route(/\/editing-[^/]*\.js$/, (route) => coming.then(() => route.continue()));
        await visitOn(page, server.link);
        await proven(page);
        await page.evaluate(() => Object.assign(globalThis, { late: 1000 }));
        comes();
        await page.locator(".program .cm-content").waitFor();
        expect(await page.locator(".program .cm-content").getAttribute("aria-readonly")).toBe("true");
        await page.locator(".program .cm-content").focus();
        await page.keyboard.type("?");
        await writable(page);
        expect(await page.locator(".program .cm-content").innerText()).not.toContain("?");
        expect(await page.getByText("▲ edited").count()).toBe(0);
    });

    test("keys that come before the new program is here are no edit of it", async () => {
        open = await visit(browser, server.link, {}, answersLate);
        const { page } = open;
        await proven(page);
        await writable(page);
        await page.keyboard.press("Control+m");
        await page.keyboard.type("generic-3axis-haas");
        await page.getByRole("dialog").getByRole("option").first().waitFor();
        await page.evaluate(() => Object.assign(globalThis, { late: 1500 }));
        await page.keyboard.press("Enter");
        // Nothing is answered yet, and the text of the program before is still there.
        await page.locator(".program .cm-content").focus();
        await page.keyboard.type("?");
        await page.evaluate(() => Object.assign(globalThis, { late: 0 }));
        await writable(page);
        expect(await page.locator(".program .cm-content").innerText()).not.toContain("?");
        expect(await page.getByText("▲ edited").count()).toBe(0);
        await proven(page);
    });

    test("an Enter too many behind the choice of a machine is no edit", async () => {
        const page = await begin();
        await writable(page);
        await page.locator(".program .cm-line.at").click();
        await page.keyboard.press("Control+m");
        await page.keyboard.type("generic-3axis-haas");
        for (let i = 0; i < 3; i++) await page.keyboard.press("Enter");
        await page.getByRole("button", { name: "generic-3axis-haas" }).waitFor();
        await writable(page);
        await page.keyboard.press("Enter");
        await proven(page);
        expect(await page.getByText("▲ edited").count()).toBe(0);
    });

    test("an edit makes room for another machine, other options or a dropped program, and is offered each time; none overwrites another", async () => {
        const page = await begin();
        const offer = page.getByText(/an edit of plate\.cls is kept/);
        const texts = (): string[] => drafts(server).filter((name) => name.endsWith(".text")).map((name) => /\((one|two|three)\)/.exec(readFileSync(join(server.folder, ".toolpost/drafts", name), "utf8"))?.[1] ?? "").toSorted();
        await edit(page, " (one)");
        await page.keyboard.press("Control+m");
        await page.keyboard.type("generic-3axis-haas");
        await page.keyboard.press("Enter");
        await proven(page);
        await offer.waitFor();
        await page.keyboard.press("Control+m");
        await page.keyboard.type("generic-3axis-fanuc");
        await page.keyboard.press("Enter");
        await proven(page);
        // The posted one stands there, and says that there is an edit.
        await offer.waitFor();
        expect(texts()).toEqual(["one"]);
        await edit(page, " (two)");
        await expect.poll(texts).toEqual(["one", "two"]);
        await page.getByRole("button", { name: "Options", exact: true }).click();
        await page.getByRole("button", { name: "Post", exact: true }).click();
        await proven(page);
        await page.getByText("is kept (and 1 more)").waitFor();
        await page.getByRole("button", { name: "Continue" }).click();
        await editedFromTop(page);
        await page.locator(".program .cm-line", { hasText: /\((one|two)\)/ }).waitFor();
        const dropped = await page.evaluateHandle(() => {
            const data = new DataTransfer();
            data.items.add(new File(["%\n(three)\nM30\n%\n"], "three.nc"));
            return data;
        });
        await page.dispatchEvent(".program", "drop", { dataTransfer: dropped });
        await page.locator(".program .cm-line", { hasText: "(three)" }).waitFor();
        await expect.poll(texts).toEqual(["one", "three", "two"]);
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
        for (const left of [1, 0]) {
            await page.getByRole("button", { name: "Delete it" }).click();
            await expect.poll(() => texts().length).toBe(left);
        }
        await page.getByRole("button", { name: "Delete it" }).waitFor({ state: "detached" });
    });

    test("a server that is killed takes no edit with it: the page asks before it goes, and goes on by the new link", async () => {
        const first = await Server.start([example("plate.cls")], ["-m", "generic-3axis-fanuc"]);
        const { page } = await visit(browser, first.link);
        await proven(page);
        await page.locator(".program .cm-line.at").waitFor();
        await edit(page, " (before)");
        await first.end("SIGKILL");
        await page.getByText("connection lost").waitFor();
        await page.keyboard.type("(behind)");
        await page.getByText("your edit is in this page alone").waitFor();
        const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download it" }).click()]);
        expect(readFileSync(await download.path(), "utf8")).toContain("(before)(behind)");
        const asked: string[] = [];
        page.once("dialog", (dialog) => {
            asked.push(dialog.type());
            void dialog.dismiss();
        });
        await page.reload({ timeout: 1000 }).catch(() => {});
        expect(asked).toEqual(["beforeunload"]);
        const second = await Server.start([example("plate.cls")], ["-m", "generic-3axis-fanuc"], first.folder);
        expect(new URL(second.link).port).toBe(new URL(first.link).port);
        await page.getByText("the link is not of this server").waitFor();
        await page.evaluate((link) => location.assign(link), second.link);
        await page.getByText("the link is not of this server").waitFor({ state: "detached" });
        await page.getByText(/PROVEN/).waitFor();
        await page.locator(".program .cm-line", { hasText: "(before)(behind)" }).waitFor();
        await expect.poll(() => drafts(second).filter((name) => name.endsWith(".text")).map((name) => readFileSync(join(second.folder, ".toolpost/drafts", name), "utf8").includes("(before)(behind)"))).toEqual([true]);
        expect(page.url()).not.toContain(new URL(second.link).hash.slice(1));
        await page.close();
    });

    test("two tabs on one source: the second says that another edits it, and both edits are kept", async () => {
        const first = await begin();
        await edit(first, " (first)");
        const drafts = join(server.folder, ".toolpost/drafts");
        const kept = (): string[] => (existsSync(drafts) ? readdirSync(drafts) : []).filter((name) => name.endsWith(".text"));
        await expect.poll(() => kept().length).toBe(1);
        const { page: second, complaints } = await visit(browser, server.link);
        await proven(second);
        await edit(second, " (second)");
        await second.getByText(/another (tab edits|edit of) this program.*: both edits are kept/).waitFor();
        await expect.poll(() => kept().map((name) => /\((first|second)\)/.exec(readFileSync(join(drafts, name), "utf8"))?.[1]).toSorted()).toEqual(["first", "second"]);
        for (const page of [second, first]) {
            await page.getByRole("button", { name: "Discard" }).click();
            await proven(page);
        }
        await expect.poll(kept).toEqual([]);
        expect(complaints).toEqual([]);
        await second.close();
    });

    test("by keyboard alone: another machine, a step, a view, a place, saved", async () => {
        const page = await begin();
        await page.keyboard.press("Control+k");
        await page.keyboard.type("choose machine");
        await page.keyboard.press("Enter");
        await page.keyboard.type("grbl-3018");
        await page.keyboard.press("Enter");
        await page.getByRole("button", { name: "grbl-3018" }).waitFor();
        await page.getByText(/PROVEN|NOT POSTED/).waitFor();
        await page.keyboard.press("Control+m");
        await page.keyboard.type("generic-3axis-fanuc");
        await page.keyboard.press("Enter");
        await page.getByRole("button", { name: "generic-3axis-fanuc" }).waitFor();
        await proven(page);

        for (let pane = 0; pane < 6 && (await page.locator(".canvas:focus").count()) === 0; pane++) await page.keyboard.press("F6");
        const before = await lit(page, "program");
        await page.keyboard.press("Home");
        await page.keyboard.press(".");
        await page.keyboard.press(".");
        await expect.poll(() => lit(page, "program")).not.toBe(before);
        await page.keyboard.press("1");
        await page.keyboard.press("?");
        await page.getByRole("dialog", { name: "Keys" }).waitFor();
        await page.keyboard.press("Escape");

        await goTo(page, "m3");
        await expect.poll(async () => (await readout(page)).Move).toMatch(/^3 /);

        await page.keyboard.press("Control+s");
        await page.keyboard.press("Tab");
        await page.keyboard.press("Enter");
        await page.getByText(/saved /).waitFor();
        const saved = (await page.getByText(/saved /).innerText()).replace("saved ", "").split(", ");
        expect(existsSync(join(server.folder, saved[0]!))).toBe(true);
        expect(readFileSync(join(server.folder, saved[0]!), "utf8")).toContain("G1");
    });

    test("a dialog that opens right behind Escape stays: the one before tells of its end later", async () => {
        const page = await begin();
        await page.locator(".canvas").focus();
        await page.keyboard.press("?");
        await page.getByRole("dialog", { name: "Keys" }).waitFor();
        await page.evaluate(() => {
            document.querySelector("dialog")!.close();
            document.dispatchEvent(new KeyboardEvent("keydown", { key: "g", code: "KeyG", ctrlKey: true }));
        });
        await page.waitForTimeout(200);
        await page.keyboard.type("m3");
        await page.keyboard.press("Enter");
        await expect.poll(async () => (await readout(page)).Move).toMatch(/^3 /);
    });

    test("who leaves a dialog is where they were before it", async () => {
        const page = await begin();
        await page.locator(".canvas").focus();
        await goTo(page, "m3");
        expect(await page.locator(".canvas:focus").count()).toBe(1);
        await page.keyboard.press("?");
        await page.getByRole("dialog", { name: "Keys" }).waitFor();
        await page.keyboard.press("Escape");
        await page.getByRole("dialog").waitFor({ state: "detached" });
        expect(await page.locator(".canvas:focus").count()).toBe(1);
    });

    test("a program beside its toolpath is proven: from the folder, and dropped on its pane", async () => {
        const page = await begin();
        await page.keyboard.press("Control+s");
        await page.locator("#save-path").fill("beside.nc");
        await page.keyboard.press("Enter");
        await page.getByText("saved beside.nc").waitFor();
        await page.keyboard.press("Control+k");
        await page.keyboard.type("prove program file");
        await page.keyboard.press("Enter");
        await page.getByRole("listbox").getByText("beside.nc", { exact: true }).click();
        // What the writer finds is not said of a program that is given.
        await page.getByRole("tab", { name: "Findings 0" }).waitFor();
        await proven(page);
        await page.locator(".program .template").waitFor({ state: "detached" });

        const other = readFileSync(join(server.folder, "beside.nc"), "utf8").replace("X145.", "X146.");
        const dropped = await page.evaluateHandle((text) => {
            const data = new DataTransfer();
            data.items.add(new File([text], "other.nc"));
            return data;
        }, other);
        await page.dispatchEvent(".program", "drop", { dataTransfer: dropped });
        await page.getByText("✗ NOT PROVEN").waitFor();
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
    });

    test("a toolpath and its program, dropped together, are proven against each other; the program keeps its name", async () => {
        const page = await begin();
        const [toolpath, posted] = [readFileSync(example("plate.cls"), "utf8"), readFileSync(join(server.folder, "beside.nc"), "utf8")];
        for (const [text, verdict] of [[posted, "✓ PROVEN"], [posted.replace("X145.", "X146."), "✗ NOT PROVEN"]] as const) {
            const dropped = await page.evaluateHandle(([program, source]) => {
                const data = new DataTransfer();
                data.items.add(new File([program!], "mine.nc"));
                data.items.add(new File([source!], "theirs.cls"));
                return data;
            }, [text, toolpath]);
            await page.dispatchEvent(".canvas", "drop", { dataTransfer: dropped });
            await page.locator(".program h2", { hasText: "mine.nc" }).waitFor();
            await page.getByText(verdict).waitFor();
            expect(await page.getByTitle("Open a source (Ctrl O)").innerText()).toBe("theirs.cls");
            await page.getByRole("button", { name: "Discard" }).click();
            await page.locator(".program h2", { hasText: "mine.nc" }).waitFor({ state: "detached" });
            await proven(page);
        }
    });

    test("what is typed whole is what Enter takes; a machine that cannot take a source is not kept for it", async () => {
        const page = await begin();
        const machine = page.getByTitle("Choose the machine (Ctrl M)");
        await page.keyboard.press("Control+m");
        await page.keyboard.type("linuxcnc-xyzbc");
        await page.keyboard.press("Enter");
        await expect.poll(() => machine.innerText()).toBe("linuxcnc-xyzbc");
        const body = await page.evaluateHandle(() => {
            const data = new DataTransfer();
            const facet = (a: string, b: string, c: string): string => `facet normal 0 0 0\nouter loop\nvertex ${a}\nvertex ${b}\nvertex ${c}\nendloop\nendfacet\n`;
            data.items.add(new File([`solid one\n${facet("0 0 0", "9 0 0", "0 9 0")}${facet("0 0 0", "9 0 0", "0 0 9")}endsolid one\n`], "one.stl"));
            return data;
        });
        await page.dispatchEvent(".canvas", "drop", { dataTransfer: body });
        await page.getByRole("dialog", { name: "Machine" }).waitFor();
        await expect.poll(() => machine.innerText()).toBe("Choose a machine…");
        // Which machines can take it the server says a moment later.
        await expect.poll(() => page.getByRole("dialog").getByRole("option").first().innerText()).toContain("glass");
        await page.keyboard.press("Escape");
        await page.getByText("choose the machine that it is for").waitFor();
    });

    test("what is searched for is marked in its line; a save that is refused leaves no error beside the proven program", async () => {
        const page = await begin();
        const before = await page.locator("#tab-findings").innerText();
        await page.keyboard.press("Control+f");
        await page.keyboard.type("x145");
        await page.keyboard.press("Enter");
        await page.locator(".program .cm-line.at .found", { hasText: "X145" }).waitFor();
        await page.keyboard.press("Escape");
        await page.keyboard.press("Control+s");
        await page.locator("#save-path").fill("plate.cls");
        await page.keyboard.press("Enter");
        await page.getByRole("dialog").locator(".error").waitFor();
        await page.keyboard.press("Escape");
        await page.getByRole("tab", { name: before }).waitFor();
    });

    test("from a place that is marked the readout measures, by keyboard", async () => {
        const page = await begin();
        const at = async (move: string): Promise<number[]> => {
            await goTo(page, move);
            await expect.poll(async () => (await readout(page)).Move).toMatch(new RegExp(`^${move.slice(1)} `));
            return (await readout(page)).Tip!.split(/\s+/).slice(0, 3).map(Number);
        };
        const from = await at("m5");
        await page.locator(".canvas").focus();
        await page.keyboard.press("d");
        const to = await at("m8");
        const way = to.map((part, i) => part - from[i]!);
        const measured = (await readout(page)).Measured!.split(/[\s,]+/).slice(0, 4).map(Number);
        expect(measured).toEqual([...way, Math.hypot(...way)].map((part) => expect.closeTo(part, 3)));
        await page.locator(".canvas").focus();
        await page.keyboard.press("d");
        await expect.poll(async () => (await readout(page)).Measured).toBe(undefined);
    });

    test("the view says what its colours mean", async () => {
        const page = await begin();
        const legend = page.locator(".legend");
        await legend.getByText("feed, arc").waitFor();
        await page.getByTitle("Colours by (C)").selectOption("feed");
        await legend.getByText(/^\d[\d,]* *[\d,]+ mm\/min$/).waitFor();
        await page.getByTitle("Colours by (C)").selectOption("tool");
        await legend.getByText("T1").first().waitFor();
        // Also of a job of which nothing was walked in the view.
        await page.getByTitle("Colours by (C)").selectOption("kind");
        await page.getByRole("button", { name: "Options", exact: true }).click();
        await page.getByRole("button", { name: "Post", exact: true }).click();
        await page.getByRole("dialog").waitFor({ state: "detached" });
        await proven(page);
        await page.waitForTimeout(1000);
        await legend.getByText("feed, arc").waitFor();
    });

    test("near an arc what is seen is asked for as the view is, and stays so without an end of requests", async () => {
        const page = await begin();
        // `CIRCLE/72,40,-6,0,0,1,3` is gone round to here.
        await goTo(page, "s47");
        await page.locator(".source .cm-line.at", { hasText: "GOTO/72,43,-6" }).waitFor();
        const asked: string[] = [];
        page.on("request", (request) => request.url().includes("/geometry/") && asked.push(request.url().replace(/^.*geometry\/\d+\//, "")));
        await page.locator(".canvas").focus();
        await page.keyboard.press("z");
        for (let step = 0; step < 25; step++) await page.keyboard.press("PageUp");
        const whole = () => asked.filter((path) => /^sight\/.*\/all$/.test(path));
        await expect.poll(() => whole().length).toBeGreaterThan(0);
        await page.waitForTimeout(600);
        const { length } = whole();
        expect(new Set(whole()).size).toBe(length);
        await page.mouse.move(5, 5);
        await page.waitForTimeout(600);
        expect(whole().length).toBe(length);
    });

    test("a program that is dropped into the text of the program is proven, and nothing is put into that text", async () => {
        const page = await begin();
        await writable(page);
        const dropped = await page.evaluateHandle(() => {
            const data = new DataTransfer();
            data.items.add(new File(["%\n(dropped)\nM30\n%\n"], "other.nc"));
            return data;
        });
        await page.dispatchEvent(".program .cm-line", "drop", { dataTransfer: dropped });
        await page.locator(".program .cm-line", { hasText: "(dropped)" }).waitFor();
        await page.getByText("✗ NOT PROVEN").waitFor();
        expect(await page.locator(".program .cm-line").count()).toBeLessThan(6);
        const texts = (): string[] => drafts(server).filter((name) => name.endsWith(".text"));
        expect(texts().length).toBeLessThan(2);
        await page.getByRole("button", { name: "Discard" }).click();
        await proven(page);
        await expect.poll(texts).toEqual([]);
    });

    test("a file that is dropped keeps its name, also in the notice of its edit", async () => {
        const page = await begin();
        const dropped = await page.evaluateHandle((text) => {
            const data = new DataTransfer();
            data.items.add(new File([text], "dropped.cls"));
            return data;
        }, readFileSync(example("plate.cls"), "utf8"));
        await page.dispatchEvent(".canvas", "drop", { dataTransfer: dropped });
        await page.getByRole("button", { name: "dropped.cls", exact: true }).waitFor();
        await proven(page);
        await writable(page);
        await page.locator(".program .cm-line").first().click();
        await page.keyboard.press("End");
        await page.keyboard.type(" (kept)");
        await page.getByText("▲ edited").waitFor();
        await page.waitForTimeout(800);
        await page.reload();
        await page.getByText("an edit of dropped.cls is kept").waitFor();
        await page.getByRole("button", { name: "Delete it" }).click();
    });

    test("replay moves the cursor on, and stops at the end", async () => {
        const page = await begin();
        await page.getByLabel("Speed of the replay").selectOption({ label: "× 1000" });
        await page.getByRole("button", { name: "Play" }).click();
        await page.getByRole("button", { name: "Play" }).waitFor();
        const slider = page.getByLabel("Time of the machine");
        await expect.poll(() => slider.evaluate((input: HTMLInputElement) => input.valueAsNumber / Number(input.max))).toBeCloseTo(1, 3);
    });

    test("the picture is the same by the rasteriser and, nearly, by WebGL", async () => {
        const page = await begin();
        const canvas = page.locator(".canvas canvas").first();
        const shot = async (): Promise<number[]> => {
            await page.waitForTimeout(500);
            return [...(await canvas.screenshot())];
        };
        const plain = await shot();
        await page.keyboard.press("Control+k");
        await page.keyboard.type("draw by webgl");
        await page.keyboard.press("Enter");
        expect((await shot()).length).toBeGreaterThan(plain.length * 0.5);
        await page.evaluate(() => {
            const gl = document.querySelector<HTMLCanvasElement>(".canvas canvas")!.getContext("webgl2");
            gl?.getExtension("WEBGL_lose_context")?.loseContext();
        });
        // Lost: the rasteriser draws the same as before.
        await expect.poll(shot).toEqual(plain);
    });

    test.each([[640, 360], [320, 256]])("in a window of %d x %d, as zoomed, the page scrolls one way, and the view stays in sight while it is replayed", async (width, height) => {
        const page = await begin({ viewport: { width, height }, deviceScaleFactor: 2 });
        const view = page.locator(".canvas");
        expect((await view.boundingBox())!.height).toBeGreaterThan(120);
        await view.focus();
        for (const key of ["End", ",", ",", "Home", "."]) {
            await page.keyboard.press(key);
            await page.waitForTimeout(150);
        }
        await expect.poll(async () => (await lit(page, "program")).length).toBeGreaterThan(0);
        const { y, height: high } = (await view.boundingBox())!;
        expect(y + high).toBeGreaterThan(0);
        expect(y).toBeLessThan(height);
        expect(await page.evaluate(() => [document.documentElement.scrollWidth <= innerWidth, document.documentElement.scrollHeight > innerHeight])).toEqual([true, true]);
        for (const name of ["Axes", "Machine", "Box", "Ruler", "Play"]) await page.getByRole("button", { name, exact: true }).click({ trial: true });
        await page.getByRole("tab", { name: "Verdict" }).click();
        await accessible(page, `${width} x ${height}`);
    });

    test.each(["light", "dark"] as const)("axe-core finds nothing, %s, in the smallest window", async (colorScheme) => {
        const page = await begin({ colorScheme, viewport: { width: 1024, height: 640 } });
        await accessible(page, "page");
        for (const tab of ["Verdict", "Axes over time"]) {
            await page.getByRole("tab", { name: tab }).click();
            await accessible(page, tab);
        }
        for (const key of ["Control+k", "Control+o", "Control+m", "Control+g", "Control+f", "Control+s"]) {
            await page.keyboard.press(key);
            await page.getByRole("dialog").waitFor();
            await accessible(page, key);
            await page.keyboard.press("Escape");
        }
    });
});
