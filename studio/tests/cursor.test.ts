import { signal } from "@preact/signals";
import { expect, test } from "vitest";
import { Cursor, neighbour } from "../src/cursor.ts";
import { Player } from "../src/player.ts";
import { Newest, Together } from "../src/newest.ts";
import type { Seam } from "../src/protocol/seam.ts";
import type { Job, Place, PlaceParams } from "../src/protocol/asks.ts";

const settled = () => new Promise((resolve) => setTimeout(resolve));

test("the moves of a block are stepped through in a ring", () => {
    const ranges: [number, number][] = [[4, 6], [10, 11]];
    expect([4, 5, 10].map((move) => neighbour(ranges, move, 1))).toEqual([5, 10, 4]);
    expect([4, 5, 10].map((move) => neighbour(ranges, move, -1))).toEqual([10, 4, 5]);
    expect(neighbour([], 7, 1)).toBe(7);
});

test("of asks that come while one runs, only the newest is asked", async () => {
    const ran: number[] = [];
    const newest = new Newest<number>(async (value) => {
        ran.push(value);
        await settled();
    });
    const first = newest.ask(1);
    await newest.ask(2);
    await newest.ask(3);
    await first;
    expect(ran).toEqual([1, 3]);
});

const job = (revision: number): Job =>
    ({ revision, walk: { moves: 9, chunks: 1, levels: [], box: null, time_s: 9, tools: [], kinds: [] } }) as unknown as Job;

test("where a new job does not come as far as the record, the cursor is at its end", async () => {
    const asked: PlaceParams[] = [];
    const seam = {
        async ask(_: string, params: PlaceParams) {
            asked.push(params);
            const place = { move: params.value, block: { file: null, line: 1, text: "" }, source: { file: null, line: 40, text: "" } };
            return { done: params.by === "source" ? null : place, arrays: {} };
        },
    } as unknown as Seam;
    const now = signal<Job | null>(job(1));
    const cursor = new Cursor(seam, now);
    await settled();
    now.value = job(2);
    await settled();
    expect(asked.at(-1)).toEqual({ revision: 2, by: "move", value: 8 });
    expect(cursor.place.value?.move).toBe(8);
});

test("the cursor is at the same record of the source after a new posting", async () => {
    const asked: PlaceParams[] = [];
    const seam = {
        async ask(_: string, params: PlaceParams) {
            asked.push(params);
            return { done: { move: params.value, block: { file: null, line: 1, text: "" }, source: { file: null, line: 40, text: "" } } as unknown as Place, arrays: {} };
        },
    } as unknown as Seam;
    const now = signal<Job | null>(job(1));
    const cursor = new Cursor(seam, now);
    await cursor.toMove(100);
    await settled();
    now.value = job(2);
    await settled();
    expect(asked.at(-1)).toEqual({ revision: 2, by: "source", value: 40, file: null });
    expect(asked.at(-2)).toEqual({ revision: 1, by: "move", value: 8 });
    now.value = null;
    expect(cursor.place.value).toBe(null);
});

test("another program of a board, which makes nothing of the same file, is shown at the move of the same number", async () => {
    const asked: PlaceParams[] = [];
    const seam = {
        async ask(_: string, params: PlaceParams) {
            asked.push(params);
            const place = { move: params.value, block: { file: null, line: 1, text: "" }, source: { file: "front.gbr", line: 40, text: "" } } as unknown as Place;
            return { done: params.by === "source" ? null : place, arrays: {} };
        },
    } as unknown as Seam;
    const now = signal<Job | null>(job(1));
    const cursor = new Cursor(seam, now);
    await cursor.toMove(5);
    await settled();
    now.value = job(2);
    await settled();
    expect(asked.slice(-2)).toEqual([
        { revision: 2, by: "source", value: 40, file: "front.gbr" },
        { revision: 2, by: "move", value: 5 },
    ]);
});

test("steps that come before the answer to the one before are all made", async () => {
    const now = signal<Job | null>(job(1));
    // Blocks of two moves each.
    const seam = {
        async ask(_: string, { value: move }: PlaceParams) {
            await settled();
            const first = move - (move % 2);
            return { done: { move, block: { file: null, line: 1, text: "" }, block_moves: [[first, first + 2]], source: null }, arrays: {} };
        },
    } as unknown as Seam;
    const cursor = new Cursor(seam, now);
    const player = new Player(cursor, now);
    await settled();
    player.stepTo(1, "block");
    player.stepTo(1, "block");
    player.stepTo(1, "move");
    player.stepTo(-1, "block");
    await cursor.step(({ move }) => move);
    expect(cursor.place.value?.move).toBe(3);
    void cursor.toMove(6);
    await cursor.turn(1);
    expect(cursor.place.value?.move).toBe(7);
});

test("what is begun in one turn ends together, whatever becomes of the others; what is begun later does not wait for it", async () => {
    const together = new Together();
    const ended: string[] = [];
    const turns: [resolve: (text: string) => void, reject: (error: Error) => void][] = [];
    const later = () => new Promise<string>((...turn) => turns.push(turn));
    const wait = (one: Promise<string>) => void together.end(one).then((text) => ended.push(text), () => ended.push("none"));
    wait(later());
    wait(later());
    await settled();
    turns[0]![0]("first");
    wait(Promise.resolve("later"));
    await settled();
    expect(ended).toEqual(["later"]);
    turns[1]![1](new Error("no"));
    await settled();
    expect(ended.toSorted()).toEqual(["first", "later", "none"]);
});
