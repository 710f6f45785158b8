/** Files that are changed in an editor while the page shows what was made of them. */

import { copyFileSync, existsSync, mkdtempSync, readFileSync, renameSync, unlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { describe, expect, test } from "vitest";
import { absent, accessible, browserOfTests, example, goTo, lit, proven, Server, visit, writable } from "./harness.ts";

const MILL = 'extends = "generic-3axis-linuxcnc"\n';

describe.skipIf(absent() !== null)("files that change while they are open", () => {
    const browser = browserOfTests();

    /** A plate on a machine of the folder. */
    async function begin(mill = MILL) {
        const folder = mkdtempSync(join(tmpdir(), "studio-"));
        const own = (name: string): string => join(folder, name);
        writeFileSync(own("mill.toml"), mill);
        const server = await Server.start([example("plate.cls")], ["-m", own("mill.toml")], folder);
        const { page, complaints } = await visit(browser(), server.link);
        return { own, page, complaints };
    }

    test("a machine file is posted anew at the same record, and one that is half written is waited for", async () => {
        const { own, page, complaints } = await begin();
        await proven(page);
        await goTo(page, "s20");
        const record = "GOTO/145,52,2";
        await expect.poll(() => lit(page, "source")).toBe(record);
        // An editor that empties the file before it writes it.
        writeFileSync(own("mill.toml"), "");
        await page.waitForTimeout(300);
        writeFileSync(own("mill.toml"), `${MILL}[blocks]\ncomment = "(OURS {{text}})"\n`);
        await page.getByText("mill.toml changed: posted again").waitFor();
        await proven(page);
        expect(await lit(page, "source")).toBe(record);
        await page.keyboard.press("Control+f");
        await page.keyboard.type("(OURS");
        await page.keyboard.press("Enter");
        await page.locator(".program .cm-line", { hasText: "(OURS" }).first().waitFor();
        await page.keyboard.press("Escape");
        await accessible(page, "posted again");
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("a machine file with a mistake says so, and is posted as soon as it is mended, at the same record", async () => {
        const { own, page, complaints } = await begin();
        await proven(page);
        await goTo(page, "s20");
        const record = "GOTO/145,52,2";
        await expect.poll(() => lit(page, "source")).toBe(record);
        writeFileSync(own("mill.toml"), `${MILL}speed = 1\n`);
        await page.getByText("✗ NOT POSTED").waitFor();
        await page.getByText("mill.toml:2:1").waitFor();
        // As editors do that write another file and give it the name.
        writeFileSync(own("new"), MILL);
        renameSync(own("new"), own("mill.toml"));
        await proven(page);
        await expect.poll(() => lit(page, "source")).toBe(record);
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("nothing is saved that is of other files than those on the disk, and a file that is gone leaves what is shown", async () => {
        const { own, page, complaints } = await begin();
        await proven(page);
        await page.getByRole("button", { name: "Save…" }).click();
        // Faster than the page looks.
        writeFileSync(own("mill.toml"), `${MILL}title = "Ours"\n`);
        await page.getByRole("dialog").getByRole("button", { name: "Save" }).click();
        await page.getByRole("alert").getByText("mill.toml has changed since this program was proven").waitFor();
        await accessible(page, "a save that is refused");
        expect(existsSync(own("plate.ngc"))).toBe(false);
        await page.getByText("mill.toml changed: posted again").waitFor({ state: "attached" });
        await page.getByText("✓ PROVEN").waitFor({ state: "attached" });
        await page.getByRole("dialog").getByRole("button", { name: "Save" }).click();
        await page.getByText("saved plate.ngc").waitFor();
        const before = readFileSync(own("plate.cls"));
        unlinkSync(own("plate.cls"));
        await page.getByText("plate.cls is not there any more").waitFor();
        await page.getByText("✓ PROVEN").waitFor();
        expect(await page.locator(".program .cm-line").count()).toBeGreaterThan(5);
        await accessible(page, "a file that is gone");
        await page.keyboard.press("Control+s");
        await page.getByRole("dialog").getByLabel("replace what is there").check();
        await page.getByRole("dialog").getByRole("button", { name: "Save" }).click();
        await page.getByRole("alert").getByText("plate.cls is not there any more").waitFor();
        await page.keyboard.press("Escape");
        writeFileSync(own("plate.cls"), before);
        await page.getByText("▲ plate.cls is not there any more").waitFor({ state: "detached" });
        expect(complaints).toEqual([]);
        await page.close();
    });

    test("an edit by hand is kept and offered, and Post again is a command", async () => {
        const { own, page, complaints } = await begin();
        await proven(page);
        await writable(page);
        await page.locator(".program .cm-content").focus();
        await page.keyboard.press("Control+End");
        await page.keyboard.type("(by hand)");
        await page.getByText("▲ edited").waitFor();
        await proven(page);
        copyFileSync(example("lean.cls"), own("other.cls"));
        writeFileSync(own("plate.cls"), `${readFileSync(own("plate.cls"), "utf8")}$$ another end\n`);
        await page.getByText("▲ an edit of plate.cls is kept").waitFor();
        await page.getByText("plate.cls changed: posted again").waitFor();
        await proven(page);
        expect(await page.getByText("▲ edited").count()).toBe(0);
        await page.getByRole("button", { name: "Continue" }).click();
        await page.getByText("▲ edited").waitFor();
        // The text comes when the program has been posted, and only what is in sight is in the page.
        await expect.poll(async () => {
            await page.locator(".program .cm-content").focus();
            await page.keyboard.press("Control+End");
            return page.locator(".program .cm-line", { hasText: "(by hand)" }).count();
        }).toBe(1);
        await proven(page);
        await page.keyboard.press("Control+k");
        await page.keyboard.type("post again");
        await page.keyboard.press("Enter");
        await page.getByText("▲ an edit of plate.cls is kept").waitFor();
        await proven(page);
        expect(complaints).toEqual([]);
        await page.close();
    });
});
