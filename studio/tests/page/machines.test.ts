import { copyFileSync, readFileSync, utimesSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, test } from "vitest";
import type { Job, Place } from "../../src/protocol/asks.ts";
import { read } from "../../src/protocol/frames.ts";
import { place, tipOf } from "../../src/view/linkage.ts";
import { absent, accessible, browserOfTests, covered, example, goTo, lit, proven, readout, Server, visit, visitOn } from "./harness.ts";

/** Of a tool of dome.cls, which says none, in the cell of universal-ur10e, mm. */
const LENGTH = 50;

describe.skipIf(absent() !== null)("the same part on machines of other kinds", () => {
    const browser = browserOfTests();

    test("a robot's view is fitted to what is cut, by F to all with home, and to the arm while that is shown", async () => {
        const server = await Server.start([example("bracket.json")], ["-m", "universal-ur10e"]);
        const { page, complaints } = await visit(browser(), server.link);
        await proven(page);
        await page.locator(".canvas").focus();
        const canvas = page.locator(".canvas canvas").first();
        const shot = async (key: string): Promise<string> => {
            await page.keyboard.press(key);
            await page.waitForTimeout(400);
            return (await canvas.screenshot()).toString("base64");
        };
        const cuts = await shot("Shift");
        const all = await shot("f");
        const again = await shot("f");
        expect(all).not.toBe(cuts);
        expect(again).toBe(cuts);
        // The arm is in sight as a whole: none of it at the edge.
        await page.keyboard.press("m");
        await page.waitForTimeout(400);
        const edge = await canvas.evaluate((element) => {
            const { width, height } = element as HTMLCanvasElement;
            const pixels = new Uint32Array((element as HTMLCanvasElement).getContext("2d")!.getImageData(0, 0, width, height).data.buffer);
            const seen = (x: number, y: number): boolean => pixels[y * width + x] !== pixels[0];
            return Array.from({ length: height }, (_, y) => y).some((y) => seen(0, y) || seen(width - 1, y)) || Array.from({ length: width }, (_, x) => x).some((x) => seen(x, height - 1));
        });
        expect(edge).toBe(false);
        expect(await shot("m")).toBe(cuts);
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("all places of a finding are reached, by its buttons and by F8", async () => {
        const server = await Server.start([example("dome.cls")], ["-m", "sinumerik-840d-traori"]);
        const { page, complaints } = await visit(browser(), server.link);
        await proven(page);
        const finding = page.locator(".findings li", { hasText: "[rewind]" });
        await finding.getByText(/^\d+ places$/).waitFor();
        const count = Number(/\d+/.exec(await finding.getByText(/^\d+ places$/).innerText())![0]);
        expect(count).toBeGreaterThan(2);
        const seen: string[] = [];
        for (let place = 1; place <= 3; place++) {
            await finding.getByLabel("Next place of this finding").click();
            await finding.getByText(`: ${place} of ${count} places`).waitFor();
            const line = /line ([\d,]+)/.exec(await finding.locator(".steps").innerText())![1]!.replace(",", "");
            await page.locator(".cm-gutterElement.cm-activeLineGutter, .cm-gutterElement", { hasText: new RegExp(`^${line}$`) }).first().waitFor();
            seen.push(await lit(page, "program"));
        }
        await page.keyboard.press("F8");
        await finding.getByText(`: 4 of ${count} places`).waitFor();
        await page.keyboard.press("Shift+F8");
        await finding.getByText(`: 3 of ${count} places`).waitFor();
        expect(new Set(seen).size).toBe(3);
        await accessible(page, "places of a finding");
        // Each such way out and back is an excursion of the program.
        await page.getByRole("tab", { name: "Verdict" }).click();
        await page.getByText(`${count} excursions from a cut and back to it`).click();
        const excursions = page.locator(".jumps li");
        const move = /move ([\d,]*\d)/.exec(await excursions.nth(1).innerText())![1];
        await excursions.nth(1).getByRole("button").click();
        await page.locator(".readout", { hasText: new RegExp(`Move\\s*${move} rapid`) }).waitFor();
        await accessible(page, "excursions");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test.each([
        ["five axes", "fanuc-table-bc", ["X", "Y", "Z", "B", "C"]],
        ["a robot", "universal-ur10e", ["J1", "J2", "J3", "J4", "J5", "J6"]],
    ])("%s: the tip is where the record goes, and each axis is read out", async (_, machine, axes) => {
        const server = await Server.start([example("dome.cls")], ["-m", machine]);
        const { page, complaints } = await visit(browser(), server.link);
        await proven(page);
        await page.locator(".program .cm-line.at").waitFor();
        const before = await lit(page, "source");
        await goTo(page, "m500");
        await expect.poll(() => lit(page, "source")).not.toBe(before);
        const record = await lit(page, "source");
        const read = await readout(page);
        for (const axis of axes) expect(read).toHaveProperty(axis);
        const tip = read.Tip!.split(" ").slice(0, 3).map(Number);
        const to = record.replace("GOTO/", "").split(",").slice(0, 3).map(Number);
        // The program has three decimals.
        tip.forEach((part, i) => expect(Math.abs(part - to[i]!)).toBeLessThan(0.002));
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("in the midst of each move the arm as it is drawn leads to the tip as it is read out", async () => {
        const server = await Server.start([example("dome.cls")], ["-m", "universal-ur10e"]);
        const page = await browser().newPage();
        const [jobs, places]: [Job[], Place[]] = [[], []];
        page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => {
            const { done } = read(Uint8Array.from(payload as Buffer).buffer).head as { done?: Partial<Job & Place> };
            if (done?.machine !== undefined) jobs.push(done as Job);
            if (done?.tip !== undefined) places.push(done as Place);
        }));
        await visitOn(page, server.link);
        await proven(page);
        // From home to the part by fractions of a second, and on through lines and arcs.
        await page.getByLabel("Time of the machine").evaluate(async (slider: HTMLInputElement) => {
            for (let time = 0; time < 60; time += time < 8 ? 0.1 : 2) {
                slider.value = String(time);
                slider.dispatchEvent(new Event("input", { bubbles: true }));
                await new Promise((resolve) => setTimeout(resolve, 30));
            }
        });
        const { linkage } = jobs.at(-1)!.machine;
        for (const one of ["joints", "feed", "arc"]) expect(places.filter(({ kind }) => kind === one).length).toBeGreaterThan(5);
        for (const { axes, tip } of places) {
            const drawn = tipOf(linkage, place(linkage, axes as number[]), LENGTH);
            drawn.forEach((part, i) => expect(Math.abs(part - tip[i]!)).toBeLessThan(1e-9));
        }
        await page.close();
    });

    test("a machine that is not drawn says why: the tip is led, and the tool's length is not given", async () => {
        const server = await Server.start([example("dome.cls")], ["-m", "fanuc-table-bc"]);
        const { page } = await visit(browser(), server.link);
        await proven(page);
        await page.getByRole("button", { name: "Machine", exact: true }).click();
        await goTo(page, "m1146");
        await page.getByText("not drawn here: where X, Y, Z stand is not known").waitFor();
        expect(await page.locator(".readout > div", { hasText: "Z–" }).first().getAttribute("title")).toContain("whose length is not given");
        // Tool 1 cuts on three axes, all of which the program says.
        await goTo(page, "m20");
        await page.getByText("not drawn here").waitFor({ state: "detached" });
        // The picture keeps its size, whatever is said beside it.
        await page.mouse.move(700, 300);
        await page.waitForTimeout(200);
        const size = await page.locator(".canvas").boundingBox();
        await page.mouse.move(700, 700);
        await goTo(page, "m1");
        await expect.poll(async () => (await readout(page)).X).toMatch(/^–/);
        expect(await page.locator(".canvas").boundingBox()).toEqual(size);
        await accessible(page, "machine");
        await page.close();
    });

    test("all blocks of a record are marked: on a HEIDENHAIN the centre of an arc has a block of its own", async () => {
        const server = await Server.start([example("plate.cls")], ["-m", "generic-3axis-heidenhain"]);
        const { page, complaints } = await visit(browser(), server.link);
        await proven(page);
        // The way of `CIRCLE/72,40,-6,0,0,1,3` to its end.
        await goTo(page, "s47");
        await page.locator(".source .cm-line.at", { hasText: "GOTO/72,43,-6" }).waitFor();
        const marked = await page.locator(".program .cm-line.also").allInnerTexts();
        expect(marked.filter((block) => /^\d+ (CC|C) /.test(block)).map((block) => block.replace(/^\d+ /, "").replace(/ (F|M).*/, ""))).toEqual(["CC X+72 Y+40", "C Y+43 DR+"]);
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a cut that turns a rotary axis far is marked and leads to its place; deviations have a plot and a colour", async () => {
        const server = await Server.start([], ["-m", "fanuc-table-bc"]);
        // The tool leans by 2 degrees, first over Y and then over X: C turns by 90 degrees, which are written as two cuts of 45.
        const lean = (x: string, y: string): string => `${x},${y},0.9993908`;
        const lines = [
            "UNITS/MM", "MULTAX/ON", "TLDATA/MILL,16,0,90,0,0", "LOAD/TOOL,1", "SPINDL/RPM,3200,CLW", "RAPID", `GOTO/0,0,50,${lean("0", "0.0348995")}`,
            "FEDRAT/MMPM,300", `GOTO/0,0,0,${lean("0", "0.0348995")}`, `GOTO/10,0,0,${lean("0", "0.0348995")}`, `GOTO/20,0,0,${lean("0.0348995", "0")}`, "RAPID",
            `GOTO/20,0,50,${lean("0.0348995", "0")}`, "FINI", "",
        ];
        writeFileSync(join(server.folder, "pole.cls"), lines.join("\n"));
        const { page, complaints } = await visit(browser(), server.link);
        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("pole.cls").click();
        await proven(page);
        await page.getByRole("tab", { name: "Axes over time" }).click();
        await page.getByText("2 cuts turn a rotary axis by more than 30°").click();
        const jumps = page.locator(".jumps button");
        for (const text of await jumps.allInnerTexts()) {
            const [, from, to] = /^C (-?[\d.]+)° → (-?[\d.]+)°/.exec(text)!;
            expect(Math.abs(Number(to) - Number(from))).toBeCloseTo(45, 2);
        }
        await jumps.nth(1).click();
        await page.locator(".source .cm-line.at", { hasText: "GOTO/20,0,0" }).waitFor();
        await page.getByRole("img", { name: "deviation over time" }).waitFor();
        await page.getByLabel("Colour by").selectOption("deviation");
        // Three decimals are written.
        const most = Number(/([\d.]+) mm/.exec(await page.locator(".legend").innerText())![1]);
        expect(most).toBeLessThan(0.002);
        await accessible(page, "jumps");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a page with nothing on it offers the folder's files, the newest first, and examples", async () => {
        const server = await Server.start([], ["-m", "fanuc-table-bc"]);
        for (const [day, name] of ["b.cls", "c.cls", "a.cls"].entries()) {
            copyFileSync(example("plate.cls"), join(server.folder, name));
            utimesSync(join(server.folder, name), 1e9, 1e9 + day * 86_400);
        }
        const { page, complaints } = await visit(browser(), server.link);
        await expect.poll(() => page.getByText("In this folder").getByRole("button").allInnerTexts()).toEqual(["a.cls", "c.cls", "b.cls"]);
        await accessible(page, "nothing yet");
        await page.getByText("Examples:").getByRole("button", { name: "a leaning tool, five axes" }).click();
        await proven(page);
        await page.locator(".source .cm-line", { hasText: "PARTNO/LEAN" }).waitFor();
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a wire: what the program leaves open is asked for, and the wire's four axes are read out", async () => {
        const server = await Server.start([example("sector.nc")], ["-m", "bp-95d"]);
        const { page, complaints } = await visit(browser(), server.link);
        await page.getByRole("button", { name: "Set --from…" }).click();
        const given = { from: "fanuc-31i", side: "inside", wire: "0.25", gap: "0.02", thread: "12,12", "round-corners": null };
        for (const [name, value] of Object.entries(given)) {
            await page.getByLabel("Search the options").fill(name);
            const field = page.locator(`#option-${name}`);
            if (value === null) await field.check();
            else if (await field.evaluate((one) => one.tagName === "SELECT")) await field.selectOption(value);
            else await field.fill(value);
        }
        await page.getByRole("button", { name: "Post" }).click();
        await proven(page);
        for (const axis of ["X", "Y", "U", "V"]) expect(await readout(page)).toHaveProperty(axis);
        // Lines alone cover less than a fiftieth of the view.
        await expect.poll(() => page.locator(".canvas canvas").first().evaluate(covered)).toBeGreaterThan(0.1);
        const slider = page.getByLabel("Time of the machine");
        await slider.focus();
        await page.keyboard.press("End");
        await expect.poll(async () => (await readout(page)).Move).not.toMatch(/^1 /);
        // Points have no feed: the verdict's row says the same.
        expect(await page.locator(".clock").innerText()).toBe("time not known");
        await page.getByRole("tab", { name: "Verdict" }).click();
        await page.locator("#low").getByText("not known: --feed gives the feed").waitFor();
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a source that the machine cannot cut is shown, and its findings lead to its lines", async () => {
        const server = await Server.start([example("lean.cls")], ["-m", "generic-3axis-fanuc"]);
        const { page, complaints } = await visit(browser(), server.link);
        await page.getByText("✗ NOT POSTED").waitFor();
        await page.getByText("there is no program: this is the path of the source").waitFor();
        await page.locator(".source .cm-line", { hasText: "GOTO/" }).first().waitFor();
        await expect.poll(() => page.locator(".canvas canvas").first().evaluate(covered)).toBeGreaterThan(0.0005);
        const found = page.getByRole("button", { name: /unreachable-orientation/ });
        const [, line] = /lean\.cls:(\d+)/.exec(await found.innerText())!;
        await found.click();
        const lines = readFileSync(example("lean.cls"), "utf8").split("\n");
        await expect.poll(() => lit(page, "source")).toBe(lines[Number(line) - 1]);
        expect(await page.locator(".program .cm-content").innerText()).toBe("\n");
        await page.keyboard.press("Control+s");
        await page.getByText("there is no program to save").waitFor();
        // Another machine can.
        await page.keyboard.press("Control+m");
        await page.keyboard.type("fanuc-table-bc");
        await page.keyboard.press("Enter");
        await proven(page);
        await page.locator(".program .cm-line", { hasText: "G43.4" }).first().waitFor();
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a program without a control leads to the option that it needs", async () => {
        const server = await Server.start([example("flange.nc")], ["-m", "generic-3axis-fanuc"]);
        const { page } = await visit(browser(), server.link);
        await page.getByRole("button", { name: "Set --from…" }).click();
        await page.locator("#option-from:focus").waitFor();
        await page.keyboard.type("fanuc-31i");
        await page.getByRole("button", { name: "Post" }).click();
        await page.getByText(/PROVEN|NOT POSTED/).waitFor();
        await expect.poll(() => page.getByText("no control named").count()).toBe(0);
        await page.close();
    });
});
