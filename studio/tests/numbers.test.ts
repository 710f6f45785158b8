import { expect, test } from "vitest";
import { counted, rounded } from "../src/numbers.ts";

test("numbers are shown as English has them", () => {
    const counts = [0, 7, 999, 1000, 12_345, 999_999, 1_000_000, 10_000_000];
    expect(counts.map(counted)).toEqual(counts.map((count) => count.toLocaleString("en")));
    const values = [0, 0.5, -0.25, 0.000_04, 0.000_06, 1.5, 1234.5, -98_765.432_19, 1e6];
    expect(values.map(rounded)).toEqual(values.map((value) => value.toLocaleString("en", { maximumFractionDigits: 4 })));
});
