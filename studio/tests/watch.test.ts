/** Files that others change while they are open. */

import { signal } from "@preact/signals";
import { expect, test } from "vitest";
import { Stopped, said, type Seam, type State } from "../src/protocol/seam.ts";
import { Studio } from "../src/studio.ts";
import { namesOf, Watch } from "../src/watch.ts";

const changed = (state: string, path = "mill.toml", is_gone = false) => ({ state, files: [{ path, of: "machine", is_gone }] });
const same = { state: "", files: [] };
const work = { source: { file: "a.cls" }, machine: "mill.toml", options: [] };

/** A server that says what has changed as it is told to. */
function open() {
    const asked: string[] = [];
    let [now, revision, posts, keeps]: [object, number, boolean, boolean] = [same, 0, true, true];
    const seam = {
        ask: (ask: string, params: { revision?: number | null; name?: string }) => {
            asked.push(ask === "changes" ? `changes ${params.revision}` : ask);
            if (ask === "changes") return Promise.resolve({ done: now, arrays: {} });
            if (ask === "post" && !posts) return Promise.reject(new Stopped("invalid", [said("machine-file", "it has a mistake", "")]));
            if (ask === "draft" && !keeps) return Promise.reject(new Stopped("invalid", [said("studio-folder", "it is read-only", "")]));
            if (["post", "prove"].includes(ask)) revision++;
            const job = { revision, verdict: "done", findings: [], parts: [], walk: { moves: 0, mismatch: null } };
            return Promise.resolve({ done: ask === "drafts" ? [] : job, arrays: {} });
        },
    } as unknown as Seam;
    const studio = new Studio(seam, signal<State>("open"));
    const watch = new Watch(studio);
    return {
        studio,
        asked,
        posted: () => asked.filter((ask) => ask === "post").length,
        becomes: (next: object) => (now = next),
        breaks: (is: boolean) => (posts = !is),
        keeps: (is: boolean) => (keeps = is),
        look: async (times = 1) => {
            for (let time = 0; time < times; time++) await watch.look();
        },
    };
}

test("a file that is the same twice is posted anew, once, and one that is being written is waited for", async () => {
    const { studio, posted, becomes, look } = open();
    await look(2);
    await studio.post(work as never);
    await look(3);
    expect(posted()).toBe(1);
    for (const state of ["half", "whole"]) {
        becomes(changed(state));
        await look();
    }
    expect(posted()).toBe(1);
    await look();
    expect([posted(), studio.said.value, studio.canSave.value]).toEqual([2, "mill.toml changed: posted again", true]);
    becomes(same);
    await look(3);
    expect(posted()).toBe(2);
});

test("a file that is gone leaves what is shown, and says so until it is back", async () => {
    const { studio, posted, becomes, look } = open();
    await studio.post(work as never);
    const job = studio.job.value;
    becomes({ state: "gone", files: [...changed("", "a.cls", true).files, ...changed("").files] });
    await look(3);
    expect([posted(), studio.job.value, studio.gone.value]).toEqual([1, job, ["a.cls"]]);
    becomes(changed("back"));
    await look(2);
    expect([posted(), studio.gone.value]).toEqual([2, []]);
});

test("what could not be posted is watched too", async () => {
    const { studio, asked, posted, becomes, breaks, look } = open();
    breaks(true);
    await studio.post(work as never);
    await look(2);
    expect([posted(), asked.filter((ask) => ask === "changes null").length]).toEqual([1, 2]);
    breaks(false);
    becomes(changed("mended"));
    await look(2);
    expect([posted(), studio.job.value?.revision, studio.stopped.value]).toEqual([2, 1, []]);
});

test("a file whose time is ahead is not posted without end", async () => {
    const { studio, posted, becomes, look } = open();
    await studio.post(work as never);
    becomes(changed("ahead"));
    await look(10);
    expect(posted()).toBe(2);
    expect(studio.said.value).toBe("mill.toml changed while it was read: post again");
});

test("an edit is kept when its program is posted anew, and nothing is while somebody types or a run goes on", async () => {
    const { studio, asked, posted, becomes, look } = open();
    await studio.post(work as never);
    await studio.prove(new Map([[null, "G0 X1\n"]]));
    becomes(changed("new"));
    await look();
    studio.edited.value = new Map([[null, "G0 X12\n"]]);
    await look();
    expect(posted()).toBe(1);
    studio.running.value = { step: "proving", part: null };
    await look(3);
    expect(posted()).toBe(1);
    studio.running.value = null;
    const before = asked.filter((ask) => ask === "draft").length;
    await look(2);
    expect([posted(), studio.edited.value, asked.filter((ask) => ask === "draft").length > before]).toEqual([2, null, true]);
});

test("a file that changes all the time is said", async () => {
    const { studio, posted, becomes, look } = open();
    await studio.post(work as never);
    for (const state of ["a", "b"]) {
        becomes(changed(state));
        await look();
    }
    expect(studio.said.value).not.toContain("mill.toml");
    becomes(changed("c"));
    await look();
    expect([posted(), studio.said.value]).toEqual([1, "mill.toml changes all the time: posted again when it rests"]);
    await look();
    expect([posted(), studio.said.value]).toEqual([2, "mill.toml changed: posted again"]);
});

test("where the edit on the page cannot be kept nothing is posted, and it is not said to be", async () => {
    const { studio, posted, becomes, keeps, look } = open();
    await studio.post(work as never);
    keeps(false);
    await studio.prove(new Map([[null, "G0 X1\n"]]));
    becomes(changed("new"));
    await look(4);
    expect([posted(), studio.edited.value?.size]).toEqual([1, 1]);
    expect(studio.said.value).toBe("mill.toml changed, and is not posted again: the edit on this page cannot be kept");
    expect(studio.stopped.value[0]?.rule).toBe("edit-not-kept");
});

test("of many names a few are said", () => {
    expect(namesOf(["a"])).toBe("a");
    expect(namesOf(["a", "b", "c", "d", "e"])).toBe("a, b, c, 2 more");
});
