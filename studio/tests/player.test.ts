import { expect, test } from "vitest";
import { nextStart, rate } from "../src/player.ts";
import { whereOf } from "../src/panes/Go.tsx";

test("a cutting speed in m/s: 0.05 m/s at 1500 mm/min runs twice as fast as the machine", () => {
    // 1500 mm/min are 25 mm/s; 0.05 m/s are 50 mm/s.
    expect(rate({ metres: 0.05 }, { feed: { value: 1500, unit: "mm/min" } }, 1)).toBe(2);
});

test("what has no feed goes on at the rate before", () => {
    expect(rate({ metres: 0.05 }, { feed: null }, 3)).toBe(3);
    expect(rate({ metres: 0.05 }, { feed: { value: 0.1, unit: "mm/turn" } }, 3)).toBe(3);
    expect(rate({ factor: 10 }, null, 3)).toBe(10);
});

test("steps by operation or tool", () => {
    expect(nextStart([0, 10, 20], 10, 1, 100)).toBe(20);
    expect(nextStart([0, 10, 20], 10, -1, 100)).toBe(0);
    expect(nextStart([0, 10, 20], 25, 1, 100)).toBe(99);
});

test.each([
    ["120", { by: "block", value: 120 }],
    ["N120", { by: "block", value: 120 }],
    ["s7", { by: "source", value: 7 }],
    ["m 5000", { by: "move", value: 4999 }],
    ["3:12", { by: "time", value: 192 }],
    ["1:00:01.5", { by: "time", value: 3601.5 }],
    ["12.5 s", { by: "time", value: 12.5 }],
    ["4s", { by: "time", value: 4 }],
    ["over there", null],
])("go to %s", (text, where) => {
    expect(whereOf(text)).toEqual(where);
});
