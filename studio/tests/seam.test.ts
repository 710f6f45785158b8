import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { read, write } from "../src/protocol/frames.ts";
import { Socket, Stopped, type State } from "../src/protocol/seam.ts";

/** A socket whose other end is the test. */
class Other extends EventTarget {
    static last: Other;
    binaryType = "";
    readonly sent: Record<string, unknown>[] = [];

    constructor() {
        super();
        Other.last = this;
    }

    send(frame: Uint8Array<ArrayBuffer>): void {
        this.sent.push(read(frame.buffer).head);
    }

    says(head: Record<string, unknown>): void {
        this.dispatchEvent(new MessageEvent("message", { data: write({ head, arrays: {} }).buffer }));
    }

    closes(code: number): void {
        this.dispatchEvent(Object.assign(new Event("close"), { code }));
    }
}

const states: State[] = [];
let seam: Socket;
beforeEach(() => {
    vi.useFakeTimers();
    vi.stubGlobal("WebSocket", Other);
    states.length = 0;
    seam = new Socket("secret", (state) => states.push(state), "ws://here/socket");
    Other.last.dispatchEvent(new Event("open"));
});
afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
});

test("the token is the first thing that is said", () => {
    expect(Other.last.sent).toEqual([{ token: "secret" }]);
    expect(states).toEqual(["connecting", "open"]);
});

test("answers find their asks, whatever their order, and progress comes before", async () => {
    const seen: unknown[] = [];
    const first = seam.ask("folder", { path: "a" }, { progress: (now) => seen.push(now.step) });
    const second = seam.ask("folder", { path: "b" });
    const [, a, b] = Other.last.sent;
    Other.last.says({ event: "progress", id: a!.id, step: "reading", part: 0.5 });
    Other.last.says({ id: b!.id, done: "b" });
    Other.last.says({ id: a!.id, done: "a" });
    expect([(await first).done, (await second).done]).toEqual(["a", "b"]);
    expect(seen).toEqual(["reading"]);
});

test("what is stopped says why", async () => {
    const ask = seam.ask("folder", { path: ".." });
    Other.last.says({ id: Other.last.sent[1]!.id, stop: { verdict: "invalid", findings: [{ message: "outside the folder" }] } });
    await expect(ask).rejects.toThrow("outside the folder");
});

test("cancelling tells the server, once and only while it works", () => {
    const abort = new AbortController();
    void seam.ask("folder", { path: "" }, { signal: abort.signal });
    const { id } = Other.last.sent[1]!;
    abort.abort();
    expect(Other.last.sent[2]).toEqual({ cancel: id });
});

test("a lost connection stops what waits, and is made again, ever more slowly", async () => {
    const ask = seam.ask("folder", { path: "" });
    const before = Other.last;
    Other.last.closes(1006);
    await expect(ask).rejects.toBeInstanceOf(Stopped);
    await expect(seam.ask("folder", { path: "" })).rejects.toThrow("the connection was lost");
    vi.advanceTimersByTime(250);
    expect(Other.last).not.toBe(before);
    const second = Other.last;
    second.closes(1006);
    vi.advanceTimersByTime(250);
    expect(Other.last).toBe(second);
    vi.advanceTimersByTime(250);
    expect(Other.last).not.toBe(second);
});

test("a wrong token is not tried again", () => {
    const before = Other.last;
    before.closes(4401);
    vi.advanceTimersByTime(10_000);
    expect(Other.last).toBe(before);
    expect(states.at(-1)).toBe("refused");
});

test("an upload that is ended says so, and one without a server that there is none", async () => {
    const fails = (): Promise<never> => Promise.reject(new TypeError("failed to fetch"));
    vi.stubGlobal("fetch", fails);
    const abort = new AbortController();
    await expect(seam.upload(new File([""], "a.cls"), abort.signal)).rejects.toMatchObject({ verdict: "cancelled", findings: [{ rule: "connection" }] });
    abort.abort();
    await expect(seam.upload(new File([""], "a.cls"), abort.signal)).rejects.toMatchObject({ verdict: "cancelled", findings: [{ rule: "cancelled" }] });
});
