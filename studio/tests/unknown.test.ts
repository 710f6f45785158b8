/** What nobody knows is not zero. */

import { expect, it } from "vitest";
import { axisOf, vector } from "../src/screen/screen.ts";

it("makes no point of a tip of which a coordinate is not known", () => {
    expect(vector([1, 2, 0])).toEqual([1, 2, 0]);
    expect(vector([null, 2, 3])).toBeNull();
    expect(vector([null, null, null])).toBeNull();
    expect(vector([])).toBeNull();
});

it("takes the axis of a tool as upright where it is not known", () => {
    expect(axisOf([0, 0.6, 0.8])).toEqual([0, 0.6, 0.8]);
    expect(axisOf([null, null, null])).toEqual([0, 0, 1]);
});
