import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, test } from "vitest";
import { absent, browserOfTests, covered, example, proven, readout, Server, visit, writable } from "./harness.ts";

describe.skipIf(absent() !== null)("the page and others", () => {
    const browser = browserOfTests();

    test("a page of another origin gets no socket and no data, even with the token", async () => {
        const server = await Server.start([example("plate.cls")], ["-m", "generic-3axis-fanuc"]);
        const other = createServer((_, response) => response.setHeader("content-type", "text/html").end("<p>elsewhere")).listen(0, "127.0.0.1");
        const page = await browser().newPage();
        await page.goto(`http://127.0.0.1:${(other.address() as AddressInfo).port}/`);
        const { origin, hash } = new URL(server.link);
        const token = hash.slice(1);
        const got = await page.evaluate(async ({ origin, token }) => {
            const asked = await fetch(`${origin}/geometry/1/index`, { headers: { "x-toolpost-token": token } }).then(() => "data", () => "refused");
            const blind = await fetch(`${origin}/geometry/1/index`, { mode: "no-cors" }).then((answer) => answer.type, () => "refused");
            const socket = await new Promise<string>((tell) => {
                const opened = new WebSocket(`${origin.replace("http", "ws")}/socket`);
                opened.addEventListener("open", () => tell("open"));
                opened.addEventListener("error", () => tell("refused"));
            });
            return { asked, blind, socket };
        }, { origin, token });
        expect(got.asked).toBe("refused");
        expect(got.socket).toBe("refused");
        // What a page cannot read, it gets at most as an opaque refusal.
        expect(["refused", "opaque"]).toContain(got.blind);
        await page.close();
        other.close();
    });

    test("a link with another token is refused, and the page says so", async () => {
        const server = await Server.start([]);
        const { page } = await visit(browser(), `${server.link.slice(0, -4)}0000`);
        await page.getByText("the link is not of this server").waitFor();
        await page.close();
    });

    test("markup in files is text", async () => {
        const server = await Server.start([]);
        const file = join(server.folder, "x<img src=x onerror=alert(1)>.cls");
        writeFileSync(file, "PARTNO/<script>alert(1)</script>\nUNITS/MM\nLOADTL/1\nSPINDL/900,RPM,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,0\nPPRINT/<b onmouseover=alert(2)>\nGOTO/10,0,0\nFINI\n");
        const { page, complaints } = await visit(browser(), server.link);
        let alerts = 0;
        page.on("dialog", (dialog) => {
            alerts++;
            void dialog.dismiss();
        });
        await page.keyboard.press("Control+m");
        await page.getByText("generic-3axis-fanuc:").waitFor();
        await page.keyboard.type("generic-3axis-fanuc");
        await page.keyboard.press("Enter");
        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("x<img src=x").click();
        await proven(page);
        await page.locator(".source .cm-line", { hasText: "<script>alert(1)</script>" }).waitFor();
        expect(await page.locator("img, script:not([src]), b[onmouseover]").count()).toBe(0);
        expect([alerts, complaints]).toEqual([0, []]);
        await page.close();
    });

    test("names of tools and nets are text", async () => {
        const [tool, net] = ["<img src=x onerror=alert(3)>", "<img src=x onerror=alert(4)>"];
        const source = `TOOL PATH/OP,TOOL,${tool}\nTLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000\nUNITS/MM\nLOADTL/1\nSPINDL/900,RPM,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,0\nGOTO/10,0,0\nEND-OF-PATH\nFINI\n`;
        const server = await Server.start([], ["-m", "linuxcnc-mill"]);
        writeFileSync(join(server.folder, "tool.cls"), source);
        writeFileSync(join(server.folder, "net.toml"), readFileSync(example("lamp.toml"), "utf8").replace('net = "LED"', `net = "${net}"`));
        const { page, complaints } = await visit(browser(), server.link);
        let alerts = 0;
        page.on("dialog", (dialog) => {
            alerts++;
            void dialog.dismiss();
        });
        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("tool.cls").click();
        await proven(page);
        await page.getByRole("tab", { name: "Verdict" }).click();
        await page.locator("#low td", { hasText: tool }).waitFor();

        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("net.toml").click();
        // Why nothing is posted is shown, whatever was below before.
        await page.getByRole("button", { name: "Set --tool…" }).first().click();
        await page.locator("#option-tool").fill("0.4");
        await page.getByRole("button", { name: "Post" }).click();
        await proven(page);
        await page.locator("[data-view]").focus();
        await page.keyboard.press("1");
        await expect.poll(() => page.locator(".canvas canvas").first().evaluate(covered)).toBeGreaterThan(0.1);
        // Down the track from X 24 Y 14 to the diode: the board, 30 by 20 mm, fills the picture.
        const view = (await page.locator(".canvas").boundingBox())!;
        for (let y = 0.25; y < 0.6 && (await readout(page)).Net !== net; y += 0.02) {
            for (let x = 0.6; x < 0.9 && (await readout(page)).Net !== net; x += 0.01) await page.mouse.move(view.x + view.width * x, view.y + view.height * y);
        }
        expect((await readout(page)).Net).toBe(net);
        expect(await page.locator("img, script:not([src]), b[onmouseover]").count()).toBe(0);
        expect([alerts, complaints]).toEqual([0, []]);
        await page.close();
    });

    test("what takes long says how far it is, and is cancelled", async () => {
        const server = await Server.start([], ["-m", "generic-3axis-fanuc"]);
        const moves = Array.from({ length: 400_000 }, (_, i) => `GOTO/${i % 100},${(i * 7) % 90},${-(i % 5)}`);
        writeFileSync(join(server.folder, "long.cls"), ["UNITS/MM", "LOADTL/1", "SPINDL/900,RPM,CLW", "RAPID", "GOTO/0,0,50", "FEDRAT/900,MMPM", ...moves, "FINI", ""].join("\n"));
        const { page, complaints } = await visit(browser(), server.link);
        await page.keyboard.press("Control+o");
        await page.getByRole("dialog").getByText("long.cls").click();
        await page.getByRole("progressbar").waitFor();
        await page.getByText(/reading|writing|proving/).waitFor();
        await page.getByRole("button", { name: "Cancel" }).click();
        await page.getByText("■ CANCELLED").waitFor();
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("where no edit can be kept the page says so, and gives it as a file", async () => {
        const server = await Server.start([example("plate.cls")], ["-m", "generic-3axis-fanuc"]);
        // No folder of drafts can be made there.
        writeFileSync(join(server.folder, ".toolpost"), "");
        const { page, complaints } = await visit(browser(), server.link);
        await proven(page);
        await writable(page);
        await page.locator(".program .cm-line").first().click();
        await page.keyboard.press("End");
        await page.keyboard.type(" (mine)");
        await page.getByText(/your edit is in this page alone: .+/).waitFor();
        const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download it" }).click()]);
        expect(readFileSync(await download.path(), "utf8")).toContain("(mine)");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a killed server loses no edit: the page says that it is gone, the next server offers the edit", async () => {
        const files = [example("plate.cls")];
        const machine = ["-m", "generic-3axis-fanuc"];
        const first = await Server.start(files, machine);
        const { page } = await visit(browser(), first.link);
        await proven(page);
        await writable(page);
        await page.locator(".program .cm-line").first().click();
        await page.keyboard.press("End");
        await page.keyboard.type(" (kept)");
        const drafts = join(first.folder, ".toolpost/drafts");
        // Each key goes to the server: the last one is awaited, and what the draft is of.
        const kept = (): string => (existsSync(drafts) ? readdirSync(drafts) : []).filter((name) => /\.(json|text)$/.test(name)).map((name) => readFileSync(join(drafts, name), "utf8")).join();
        await expect.poll(kept).toMatch(/plate\.cls[^]*\(kept\)/);
        await first.end("SIGKILL");
        await page.getByText("connection lost").waitFor();
        await page.close();

        const second = await Server.start([], machine, first.folder);
        const again = await visit(browser(), second.link);
        await again.page.getByRole("button", { name: "Continue" }).click();
        await again.page.locator(".program .cm-line", { hasText: "(kept)" }).waitFor();
        expect(again.complaints).toEqual([]);
        await again.page.close();
    });
});
