/** What is saved and called proven is the program as it stands on the page. */

import { signal } from "@preact/signals";
import { expect, test } from "vitest";
import { said, Stopped, type Asking, type Seam, type State } from "../src/protocol/seam.ts";
import { Studio } from "../src/studio.ts";

const settled = () => new Promise((resolve) => setTimeout(resolve));

const piece = (chunk: number): Parameters<NonNullable<Asking["walked"]>> => [
    { event: "walked", id: 1, file: "a.nc", chunk, moves: 4096 * (chunk + 1), time_s: 1, kinds: [] },
    { index: new Uint8Array(64), vertices: new Uint8Array(0) },
];

/** A server that has answered `post`, and answers `prove` when it is told to. */
function open(taken: string[] = [], posts = true, kept: { name: string }[] = []) {
    const asked: string[] = [];
    const proofs: ((job: object) => void)[] = [];
    let walked: Asking["walked"];
    const job = (revision: number) => ({ revision, verdict: "done", findings: [], walk: { moves: 0, mismatch: null } });
    const seam = {
        ask: (ask: string, params: { revision: number; name: string }, asking?: Asking) => {
            const named = { save: params.revision, draft: params.name, drop_draft: params.name }[ask];
            asked.push(named === undefined ? ask : `${ask} ${named}`);
            if (ask === "draft" && taken.includes(params.name)) return Promise.reject(new Stopped("invalid", [said("studio-draft", "another page has it", "")]));
            walked = asking?.walked ?? walked;
            if (ask === "post" && !posts) return Promise.reject(new Stopped("failed", [said("posture", "it cannot be posted", "")]));
            if (ask === "post") return Promise.resolve({ done: job(1), arrays: {} });
            if (ask === "drafts") return Promise.resolve({ done: kept, arrays: {} });
            if (ask === "prove") return new Promise((resolve) => proofs.push((done) => resolve({ done, arrays: {} })));
            return Promise.resolve({ done: { files: ["a.nc"] }, arrays: {} });
        },
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    return { studio, asked, proved: (revision: number) => proofs.shift()!(job(revision)), walk: (chunk: number) => walked!(...piece(chunk)) };
}

/** An edit of the program itself. */
const main = (text: string) => new Map([[null, text]]);

const work = { source: { file: "a.cls" }, machine: "mill", options: [] };

test("an edit whose proof runs is neither saved nor called proven, and its proof goes on", async () => {
    const { studio, asked, proved } = open();
    await studio.post(work as never);
    expect(studio.canSave.value).toBe(true);
    const proof = studio.prove(main("G0 X1\n"));
    expect(await studio.save("a.nc", true)).toBe(false);
    expect(asked.filter((ask) => ask.startsWith("save"))).toEqual([]);
    expect(studio.stopped.value[0]!.rule).toBe("not-proven");
    proved(2);
    await proof;
    expect([studio.canSave.value, studio.job.value!.revision]).toEqual([true, 2]);
    expect(await studio.save("a.nc", true)).toBe(true);
    expect(asked).toContain("save 2");
});

test("a proof that ends when somebody has typed on is not that of the text on the page", async () => {
    const { studio, proved } = open();
    await studio.post(work as never);
    studio.typed("G0 X1\n");
    const proof = studio.prove(main("G0 X1\n"));
    studio.typed("G0 X2\n");
    proved(2);
    await proof;
    await settled();
    expect([studio.isCurrent.value, studio.canSave.value]).toEqual([false, false]);
    expect(await studio.save("a.nc", true)).toBe(false);
});

test("an edit of a program that another page edits has a draft of its own, and that is the one that is dropped", async () => {
    const { studio, asked, proved } = open(["a.cls.mill", "a.cls.mill-2"]);
    await studio.post(work as never);
    const proof = studio.prove(main("G0 X1\n"));
    await settled();
    expect(studio.said.value).toContain("another tab");
    expect(asked.filter((ask) => ask.startsWith("draft "))).toEqual(["draft a.cls.mill", "draft a.cls.mill-2", "draft a.cls.mill-3"]);
    proved(2);
    await proof;
    await studio.discard();
    expect(asked.filter((ask) => ask.startsWith("drop"))).toEqual(["drop_draft a.cls.mill-3"]);
});

test("where an edit cannot be kept, another machine is not taken, and the head does not name it", async () => {
    const { studio, asked } = open(["", ...Array.from({ length: 8 }, (_, number) => `-${number + 2}`)].map((end) => `a.cls.mill${end}`));
    await studio.post(work as never);
    studio.typed("G0 X1\n");
    await studio.choose("lathe");
    expect([studio.machine.value, studio.work.value!.machine, studio.stopped.value[0]!.rule]).toEqual(["mill", "mill", "edit-not-kept"]);
    expect(asked.filter((ask) => ask === "post")).toHaveLength(1);
});

test("an edit that is discarded before the server has its draft leaves none", async () => {
    const { studio, asked } = open();
    await studio.post(work as never);
    void studio.prove(main("G0 X1\n"));
    await studio.discard();
    expect(asked.filter((ask) => ask.includes("draft") && ask !== "drafts")).toEqual(["draft a.cls.mill", "drop_draft a.cls.mill"]);
});

test("an edit makes room for another posting: it stays among the drafts and is offered, and the next edit does not overwrite it", async () => {
    const kept: { name: string }[] = [];
    const { studio, asked } = open([], true, kept);
    await studio.post(work as never);
    studio.typed("G0 X1\n");
    kept.push({ name: "a.cls.mill" });
    await studio.post({ ...work, options: [["safe", "5"]] } as never);
    await settled();
    expect(studio.edited.value).toBe(null);
    expect(studio.offers.value.map(({ name }) => name)).toEqual(["a.cls.mill"]);
    expect(asked.filter((ask) => ask.startsWith("drop"))).toEqual([]);
    studio.typed("G0 X2\n");
    await settled();
    expect(asked.filter((ask) => ask.startsWith("draft "))).toEqual(["draft a.cls.mill", "draft a.cls.mill-2"]);
});

test("an edit of several files is one of what is posted, also after the server has another; its draft says where each begins", async () => {
    const asked: [string, Record<string, unknown>, string][] = [];
    let first = 1;
    const seam = {
        ask: async (ask: string, params: Record<string, unknown>, asking?: Asking) => {
            const octets = asking?.arrays?.text as Uint8Array | undefined;
            if (["post", "prove", "draft"].includes(ask)) asked.push([ask, params, new TextDecoder().decode(octets)]);
            if (ask === "text") return { done: { to: 3 }, arrays: { text: new TextEncoder().encode("posted\n") } };
            if (ask === "open") return { done: { machine: null, drafts: [] }, arrays: {} };
            if (ask === "machines" || ask === "drafts") return { done: [], arrays: {} };
            if (ask === "draft_text") return { done: {}, arrays: { text: new TextEncoder().encode("ä main\npart\n") } };
            if (ask === "prove" && Number(params.revision) < first) throw new Stopped("invalid", [said("studio-limit", "not open any more", "")]);
            const revision = ask === "post" ? first : first + 1;
            return { done: { revision, verdict: "done", findings: [], program: { file: "a.src", lines: 2 }, parts: [{ file: "a_1.src", lines: 2 }], walk: { moves: 0, mismatch: null } }, arrays: {} };
        },
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    await studio.post(work as never);
    const edit = new Map([["a_1.src", "x"], [null, "ö"]]);
    await studio.prove(edit);
    const files = [["a_1.src", 2], [null, 3]];
    const last = (ask: string) => asked.findLast(([name]) => name === ask)!;
    expect([last("prove")[1].revision, last("prove")[1].files, last("prove")[2]]).toEqual([1, files, "x\nö\n"]);
    expect([last("draft")[1].of, last("draft")[2]]).toEqual([{ ...work, files }, "x\nö\n"]);
    // Another server.
    first = 10;
    await studio.begin();
    expect(asked.slice(-3).map(([ask, params]) => [ask, params.revision])).toEqual([["prove", 2], ["post", undefined], ["prove", 10]]);
    expect([studio.isCurrent.value, studio.edited.value, studio.posted.get("a_1.src")]).toEqual([true, edit, "posted"]);
    // A draft: the bytes of each file, not its characters.
    await studio.resume({ name: "d", of: { ...work, files: [[null, 8], ["a_1.src", 5]] }, bytes: 13 });
    expect([...studio.edited.value!]).toEqual([[null, "ä main"], ["a_1.src", "part"]]);
    expect(last("prove")[1]).toMatchObject({ revision: 10, files: [[null, 8], ["a_1.src", 5]] });
    // Of the program itself, as drafts are without a word on files.
    await studio.resume({ name: "e", of: work, bytes: 13 });
    expect([...studio.edited.value!]).toEqual([[null, "ä main\npart"]]);
});

test("what cannot be saved says why", async () => {
    const { studio } = open();
    expect(studio.refusal()?.message).toBe("there is no program to save");
    await studio.post(work as never);
    expect(studio.refusal()).toBe(null);
    void studio.prove(main("G0 X1\n"));
    expect(studio.refusal()?.help).toBe("wait until its proof has passed");
});

test("what the proof has walked is there until it ends, and nothing of it is proven or saved", async () => {
    const { studio, proved, walk } = open([], false);
    studio.work.value = work as never;
    const proof = studio.prove(main("G0 X1\n"));
    await settled();
    walk(0);
    walk(1);
    expect(studio.walking.value?.moves).toBe(8192);
    expect([studio.job.value, studio.canSave.value, studio.isCurrent.value]).toEqual([null, false, false]);
    proved(2);
    await proof;
    expect([studio.walking.value, studio.job.value!.revision]).toEqual([null, 2]);
});

test("while an edit is proven, the picture of the program before stays", async () => {
    const { studio, walk } = open();
    await studio.post(work as never);
    void studio.prove(main("G0 X1\n"));
    walk(0);
    expect(studio.walking.value).toBe(null);
});

test("the end of an old run that comes behind the result of a newer one changes nothing", async () => {
    const ends: (() => void)[] = [];
    const seam = {
        ask: (ask: string, params: { source?: { file: string } }) => {
            if (ask !== "post") return Promise.resolve({ done: [], arrays: {} });
            if (params.source!.file === "new.cls") {
                return Promise.resolve({ done: { revision: 2, verdict: "done", findings: [], walk: { moves: 0, mismatch: null } }, arrays: {} });
            }
            return new Promise((_, reject) => ends.push(() => reject(new Stopped("cancelled", []))));
        },
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    const old = studio.post({ ...work, source: { file: "old.cls" } } as never);
    await settled();
    await studio.post({ ...work, source: { file: "new.cls" } } as never);
    expect(ends).toHaveLength(1);
    ends[0]!();
    await old;
    expect([studio.job.value?.revision, studio.canSave.value, studio.stop.value]).toEqual([2, true, null]);
});

test("what is dropped before there is a connection is posted with the machine that the command names", async () => {
    const machines: (string | null)[] = [];
    const opened = { machine: "mill", source: null, drafts: [] };
    const seam = {
        ask: (ask: string, params: { machine: string | null }) => {
            if (ask === "post") machines.push(params.machine);
            const job = { revision: 1, verdict: "done", findings: [], walk: { moves: 0, mismatch: null } };
            return Promise.resolve({ done: { open: opened, machines: [], drafts: [], post: job }[ask], arrays: {} });
        },
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("connecting"));
    let asks = 0;
    studio.asksMachine = () => asks++;
    await studio.post({ ...work, machine: null });
    await studio.begin();
    expect([asks, machines, studio.work.value?.machine]).toEqual([0, ["mill"], "mill"]);
    // From then on it is asked for.
    await studio.post({ ...work, machine: null });
    expect([asks, machines]).toEqual([1, ["mill"]]);
});

test("the form is that of the machine that was chosen last, in whatever order its options come", async () => {
    const forms: ((name: string) => void)[] = [];
    const seam = {
        ask: (ask: string) => new Promise((resolve) => {
            if (ask === "form") forms.push((name) => resolve({ done: [{ name }], arrays: {} }));
        }),
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    studio.machines.value = [{ name: "mill", kind: "mill" }, { name: "engraver", kind: "glass" }] as never;
    void studio.choose("mill");
    void studio.choose("engraver");
    await settled();
    const [ofMill, ofEngraver] = forms;
    ofEngraver!("block");
    await settled();
    ofMill!("fixture");
    await settled();
    expect(studio.form.value.map(({ name }) => name)).toEqual(["block"]);
    // Back again, the form is another one again.
    void studio.choose("mill");
    await settled();
    forms[2]!("fixture");
    await settled();
    expect(studio.form.value.map(({ name }) => name)).toEqual(["fixture"]);
});

/** An edit that the server has not kept at once, and now does, the newest ask first. */
async function unkept() {
    const { studio } = open();
    const { ask } = studio.seam;
    await studio.post(work as never);
    await settled();
    const waiting: (() => void)[] = [];
    const texts: string[] = [];
    studio.seam.ask = (async (name: string, params: never, asking?: Asking) => {
        if (name === "draft") {
            if (texts.push(new TextDecoder().decode(asking!.arrays!.text)) === 1) throw new Stopped("failed", [said("write", "the disk is full", "")]);
            await new Promise<void>((resolve) => waiting.push(resolve));
        }
        return ask(name as never, params, asking);
    }) as never;
    studio.typed("G0 X1\n");
    const until = async (work: Promise<unknown>): Promise<void> => {
        const answers = setInterval(() => waiting.pop()?.());
        await work;
        clearInterval(answers);
    };
    return { studio, texts, until };
}

test("of two machines that are chosen while the edit makes room the later one stays", async () => {
    const { studio, until } = await unkept();
    await until(Promise.all([studio.choose("lathe"), studio.choose("robot")]));
    expect([studio.work.value?.machine, studio.machine.value]).toEqual(["robot", "robot"]);
});

test("keys that come while the edit makes room are in the draft", async () => {
    const { studio, texts, until } = await unkept();
    const chosen = studio.choose("lathe");
    await expect.poll(() => texts.length).toBe(2);
    studio.typed("G0 X12\n");
    await until(chosen);
    expect(texts.at(-1)).toBe("G0 X12\n");
    expect(studio.edited.value).toBe(null);
});

test("what the posting has warned of is said of an edit too, and once", async () => {
    const warning = (message: string, of: string | null) => ({ ...said("deep-cut", message, ""), severity: "warning", of });
    const posted = [warning("of the source", "source"), warning("of all", null), warning("of the program", "program")];
    const seam = {
        ask: (ask: string) => Promise.resolve({ done: ask === "drafts" ? [] : { revision: ask === "post" ? 1 : 2, verdict: "done", findings: ask === "post" ? posted : [posted[1]], walk: { moves: 0, mismatch: null } }, arrays: {} }),
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    await studio.post(work as never);
    expect(studio.findings.value.map(({ message }) => message)).toEqual(["of the source", "of all", "of the program"]);
    await studio.prove(main("G0 X1\n"));
    expect(studio.findings.value.map(({ message }) => message)).toEqual(["of all", "of the source"]);
});

test("a machine that cannot take the source is not kept, and nothing is said of it", async () => {
    const seam = {
        ask: (ask: string, _: object, asking?: Asking) => new Promise((resolve, reject) => {
            if (ask === "kinds") resolve({ done: ["mill"], arrays: {} });
            asking?.signal?.addEventListener("abort", () => reject(new Stopped("cancelled", [said("cancelled", "the work was cancelled", "")])));
        }),
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    studio.machines.value = [{ name: "engraver", kind: "glass" }] as never;
    studio.machine.value = "engraver";
    await studio.open({ file: "a.cls" });
    await settled();
    expect([studio.work.value?.machine, studio.stop.value, studio.stopped.value, studio.running.value, studio.isPosting.value]).toEqual([null, null, [], null, false]);
});

test("a machine that is chosen while a file is on its way is for that file", async () => {
    let arrives: (upload: string) => void = () => {};
    const posts: object[] = [];
    const seam = {
        upload: () => new Promise<string>((resolve) => (arrives = resolve)),
        ask: (ask: string, params: object) => {
            if (ask === "post") posts.push(params);
            return new Promise(() => {});
        },
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    studio.work.value = work as never;
    void studio.drop([new File([""], "b.cls")]);
    await studio.choose("lathe");
    arrives("u1");
    await settled();
    expect(posts).toEqual([{ source: { upload: "u1" }, machine: "lathe", options: [] }]);
});

test("a file that something else keeps from being taken is named", async () => {
    const seam = {
        upload: (_: File, signal: AbortSignal) => new Promise((_resolve, reject) => signal.addEventListener("abort", () => reject(new Stopped("cancelled", [])))),
        ask: () => new Promise(() => {}),
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    studio.work.value = work as never;
    void studio.drop([new File([""], "b.cls")]);
    void studio.post(work as never);
    await settled();
    expect(studio.said.value).toBe("b.cls is not taken: something else was begun meanwhile");
});

test("a program that is dropped with its toolpath is proven when a machine has been chosen", async () => {
    const asked: string[] = [];
    const job = { revision: 1, verdict: "done", findings: [], parts: [], walk: { moves: 0, mismatch: null } };
    const seam = {
        upload: () => Promise.resolve("u1"),
        ask: (ask: string, _: object, asking?: Asking) => {
            if (ask === "post" || ask === "prove") asked.push(ask === "post" ? ask : new TextDecoder().decode(asking!.arrays!.text));
            return Promise.resolve({ done: ask === "post" || ask === "prove" ? job : [], arrays: {} });
        },
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    await studio.dropBoth(new File(["GOTO"], "a.cls"), new File(["G0 X1\n"], "mine.nc"));
    expect([asked, studio.said.value]).toEqual([[], "mine.nc is proven when a.cls is posted"]);
    await studio.choose("mill");
    expect(asked).toEqual(["post", "G0 X1\n"]);
    expect(studio.given.value).toBe("mine.nc");
    // For that source alone.
    await studio.choose("lathe");
    expect(asked.filter((one) => one !== "post").length).toBe(1);
});

test("what is refused while a posting runs is not said of what it gives", async () => {
    const { studio } = open();
    const posted = studio.post(work as never);
    studio.running.subscribe((running) => {
        if (running !== null) queueMicrotask(() => (studio.stopped.value = [studio.refusal()!]));
    });
    await posted;
    expect(studio.canSave.value).toBe(true);
    expect(studio.findings.value).toEqual([]);
});
