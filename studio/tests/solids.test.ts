import { expect, test } from "vitest";
import type { ToolUse } from "../src/protocol/asks.ts";
import { lengthOf, toolBody, wireBody } from "../src/view/solids.ts";
import type { Triangles } from "../src/view/strip.ts";

const tool = (known: Partial<ToolUse>): ToolUse => ({ number: 1, name: "", diameter: null, corner: null, length: null, tapered: false, width: null, move: 0, time_s: 0, ...known });

/** Least and most of each coordinate. */
function box({ corners }: Triangles): [number, number][] {
    return [0, 1, 2].map((i) => {
        const all = [...corners].filter((_, at) => at % 3 === i);
        return [Math.min(...all), Math.max(...all)].map((value) => Math.round(value * 1e4) / 1e4) as [number, number];
    });
}

test("a tool is as long as it is known to be, else twice its diameter, else a pointer; what holds it stands at that length", () => {
    const tools = [tool({ diameter: 10, length: 75 }), tool({ diameter: 10, length: 15 }), tool({ diameter: 10 }), tool({}), null];
    expect(tools.map((one) => lengthOf(one, 40))).toEqual([75, 15, 20, 40, 40]);
    for (const one of tools) expect(box(toolBody(one, [1, 2, 3], [0, 0, 1], 40))[2]).toEqual([3, 3 + lengthOf(one, 40)]);
});

test("a wire ends at the height of the upper plane, also where it leans", () => {
    expect(box(wireBody([5, 0, 0], [0, 0, 1], 30, 0.5))).toEqual([[4.5, 5.5], [-0.5, 0.5], [0, 30]]);
    // 3-4-5: 40 mm high, 30 mm aside, by the middle of its round.
    const leaning = box(wireBody([0, 0, 0], [0.6, 0, 0.8], 40, 1e-6));
    expect([leaning[0]![1], leaning[2]![1]]).toEqual([30, 40]);
});
