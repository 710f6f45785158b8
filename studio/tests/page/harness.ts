/** The real command, and Debian's Chromium without a graphics processor. */

import { spawn, type ChildProcess } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { chromium, type Browser, type Page, type Route } from "playwright-core";
import { afterAll, beforeAll, expect } from "vitest";

const root = resolve(import.meta.dirname, "../../..");
const command = process.env.TOOLPOST ?? join(process.env.CARGO_TARGET_DIR ?? join(root, "target"), "debug/toolpost");
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

export const example = (name: string): string => join(root, "examples", name);

/** Why the page cannot be tested here; an error where nothing may be left out (CI=true). */
export function absent(): string | null {
    const missing = [command, browserPath].filter((path) => !existsSync(path));
    if (missing.length === 0) return null;
    const why = `nothing is judged: ${missing.join(", ")} is missing`;
    if (process.env.CI === "true") throw new Error(why);
    process.stderr.write(`${why}\n`);
    return why;
}

export class Server {
    private static readonly running = new Set<Server>();

    private constructor(
        readonly link: string,
        readonly folder: string,
        /** When the command was started, ms since 1970. */
        readonly begun: number,
        private readonly process: ChildProcess,
    ) {}

    /** A folder of its own with copies of the files; the first is the source. */
    static async start(files: string[], more: string[] = [], folder = mkdtempSync(join(tmpdir(), "studio-"))): Promise<Server> {
        for (const file of files) copyFileSync(file, join(folder, basename(file)));
        const source = files.slice(0, 1).map((file) => join(folder, basename(file)));
        const begun = Date.now();
        const child = spawn(command, ["studio", "--no-open", "--folder", folder, ...source, ...more], { stdio: ["ignore", "pipe", "inherit"] });
        for await (const line of createInterface({ input: child.stdout! })) {
            const link = /http:\S+/.exec(line)?.[0];
            if (link === undefined) continue;
            const server = new Server(link, folder, begun, child);
            Server.running.add(server);
            return server;
        }
        throw new Error("the command has printed no link");
    }

    get pid(): number {
        return this.process.pid!;
    }

    /** Ends it as Ctrl-C does. */
    async end(signal: NodeJS.Signals = "SIGINT"): Promise<void> {
        const ended = new Promise((done) => this.process.once("exit", done));
        this.process.kill(signal);
        await ended;
        Server.running.delete(this);
    }

    /** Ends all that still run, also those of tests that failed. */
    static async stopAll(): Promise<void> {
        for (const server of Server.running) {
            await server.end();
            rmSync(server.folder, { recursive: true, force: true });
        }
    }
}

export const launch = (): Promise<Browser> =>
    chromium.launch({ executablePath: browserPath, args: ["--no-sandbox", "--enable-unsafe-swiftshader", ...(newer ? ["--disable-features=LocalNetworkAccessChecks"] : [])] });

/** The browser of the tests of a `describe`, behind which it and all servers end. */
export function browserOfTests(): () => Browser {
    let browser: Browser;
    beforeAll(async () => {
        browser = await launch();
    });
    afterAll(async () => {
        await browser.close();
        await Server.stopAll();
    });
    return () => browser;
}

/** The part of a canvas that is not its ground. It runs in the page. */
export function covered(canvas: SVGElement | HTMLElement): number {
    const { width, height } = canvas as HTMLCanvasElement;
    const pixels = new Uint32Array((canvas as HTMLCanvasElement).getContext("2d")!.getImageData(0, 0, width, height).data.buffer);
    return pixels.filter((pixel) => pixel !== pixels[0]).length / pixels.length;
}

export interface Visit {
    page: Page;
    /** What the browser complained of: to be nothing at the end. */
    complaints: string[];
}

/** `watch` runs in the page before anything else there. */
export async function visit(browser: Browser, link: string, more: Parameters<Browser["newPage"]>[0] = {}, watch: () => void = () => {}): Promise<Visit> {
    const page = await browser.newPage({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce", ...more });
    if (seed !== undefined) await page.addInitScript(tardy, seed);
    await page.addInitScript(watch);
    page.setDefaultTimeout(20_000);
    const complaints: string[] = [];
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    page.on("pageerror", (error) => complaints.push(String(error)));
    await visitOn(page, link);
    return { page, complaints };
}

/** `TOOLPOST_LATE=1 npm test`: all that the page waits for comes late by chance, which this number begins. What it shows may not hang on it. */
const seed = process.env.TOOLPOST_LATE;

/** It runs in the page. Connections, answers and what is fetched come up to 400 ms late; what belongs to one ask stays in its order. */
function tardy(seed: string): void {
    let state = Number(seed) + 1;
    const late = (): number => {
        state = (state * 48271) % 2147483647;
        return state % 3 === 0 ? state % 400 : 0;
    };
    const { fetch } = globalThis;
    globalThis.fetch = async (...given) => {
        const answer = await fetch(...given);
        await new Promise((resolve) => setTimeout(resolve, late()));
        return answer;
    };
    globalThis.WebSocket = class extends WebSocket {
        private readonly due = new Map<number, number>();

        constructor(...given: ConstructorParameters<typeof WebSocket>) {
            super(...given);
            const after = (event: Event, at: number, again: () => Event): void => {
                event.stopImmediatePropagation();
                setTimeout(() => this.dispatchEvent(again()), at - performance.now());
            };
            this.addEventListener("open", (event) => event.isTrusted && after(event, performance.now() + late(), () => new Event("open")));
            this.addEventListener("message", (event) => {
                if (!event.isTrusted) return;
                const data = event.data as ArrayBuffer;
                const head = new Uint8Array(data, 4, new DataView(data).getUint32(0, true));
                const { id } = JSON.parse(new TextDecoder().decode(head)) as { id: number };
                const at = Math.max(this.due.get(id) ?? 0, performance.now() + late());
                this.due.set(id, at);
                after(event, at, () => new MessageEvent("message", { data }));
            });
        }
    };
}

/** It runs in the page: what the server says comes so many milliseconds late as `late` says. */
export function answersLate(): void {
    const global = globalThis as unknown as { late?: number };
    const come = new WeakSet<Event>();
    globalThis.WebSocket = class extends WebSocket {
        constructor(...given: ConstructorParameters<typeof WebSocket>) {
            super(...given);
            this.addEventListener("message", (event) => {
                const { late = 0 } = global;
                if (come.has(event) || late === 0) return;
                event.stopImmediatePropagation();
                const again = new MessageEvent("message", { data: event.data });
                come.add(again);
                setTimeout(() => this.dispatchEvent(again), late);
            });
        }
    };
}

/** In a page that is there. */
export async function visitOn(page: Page, link: string): Promise<void> {
    if (newer !== undefined) await page.route(/\/(assets\/.*)?$/, (route) => serve(route, newer));
    await page.goto(link);
    // The keys are listened to from here on.
    await page.getByRole("button", { name: /^Commands/ }).waitFor();
}

/** While the page is worked on: the folder of a build that the command has not in it yet. The headers are the command's. */
const newer = process.env.TOOLPOST_DIST;

async function serve(route: Route, folder: string): Promise<void> {
    const { origin, pathname } = new URL(route.request().url());
    const path = join(folder, pathname === "/" ? "index.html" : pathname);
    const { "content-security-policy": policy = "" } = (await route.fetch({ url: `${origin}/` })).headers();
    await route.fulfill({ path, headers: { "content-security-policy": policy } });
}

export async function proven(page: Page, timeout = 30_000): Promise<void> {
    await page.getByText("✓ PROVEN").waitFor({ timeout }).catch(async (error: Error) => {
        throw new Error(`${error.message}\nThe page says: ${await page.locator("main").innerText()}`);
    });
}

/** All lines of the program are here, so that keys go into it. */
export async function writable(page: Page): Promise<void> {
    await page.locator(".program .cm-content:not([aria-readonly])").waitFor();
}

/** The lit line of a pane: the number in its text, and what stands there. */
export async function lit(page: Page, pane: "program" | "source"): Promise<string> {
    return page.locator(`.${pane} .cm-line.at`).innerText();
}

/** By the keyboard, as `120`, `s7`, `m3` or `1:20`. */
export async function goTo(page: Page, where: string): Promise<void> {
    await page.keyboard.press("Control+g");
    await page.keyboard.type(where);
    await page.keyboard.press("Enter");
    await page.getByRole("dialog").waitFor({ state: "detached" });
    const move = /^m(\d+)$/.exec(where)?.[1];
    if (move !== undefined) await expect.poll(async () => (await readout(page)).Move?.replaceAll(",", "")).toMatch(new RegExp(`^${move} `));
}

/** What the readout says, by name. */
export async function readout(page: Page): Promise<Record<string, string>> {
    const rows = page.locator(".readout > div");
    // The place is asked for behind the verdict.
    await rows.first().waitFor();
    const parts = await rows.allInnerTexts();
    return Object.fromEntries(parts.map((part) => {
        const [name = "", ...rest] = part.split(/\s+/);
        return [name, rest.join(" ")];
    }));
}

const axe = readFileSync(join(root, "studio/node_modules/axe-core/axe.min.js"), "utf8");

/** Nothing that axe-core finds, of whatever impact. It is put in by the debugger: the page's own policy lets nothing in. */
export async function accessible(page: Page, where: string): Promise<void> {
    const debug = await page.context().newCDPSession(page);
    await debug.send("Runtime.evaluate", { expression: axe });
    const run = "axe.run(document, { resultTypes: ['violations'], runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] })";
    const { violations } = (await page.evaluate(run)) as { violations: { id: string; nodes: { html: string }[] }[] };
    expect(violations.map(({ id, nodes }) => `${where}: ${id} ${nodes[0]?.html}`)).toEqual([]);
}
