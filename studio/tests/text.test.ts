import { expect, test } from "vitest";
import { familyOf, tokens } from "../src/text/dialects.ts";
import { isNearEnd, missing, placesIn, windowAround } from "../src/text/window.ts";

test("a short text is kept whole, of a long one as much as is allowed, with the line in the middle", () => {
    expect(windowAround(500, 1000, 1000)).toEqual({ from: 1, to: 1001 });
    expect(windowAround(5000, 10_000, 1000)).toEqual({ from: 4500, to: 5500 });
    expect(windowAround(3, 10_000, 1000)).toEqual({ from: 1, to: 1001 });
    expect(windowAround(9999, 10_000, 1000)).toEqual({ from: 9001, to: 10_001 });
});

test("lines near the end of a window ask for more, unless it is the end of the text", () => {
    const window = { from: 4500, to: 5500 };
    expect(isNearEnd(window, 5000, 5050, 10_000, 100)).toBe(false);
    expect(isNearEnd(window, 4550, 4600, 10_000, 100)).toBe(true);
    expect(isNearEnd(window, 5390, 5440, 10_000, 100)).toBe(true);
    expect(isNearEnd({ from: 1, to: 1001 }, 1, 1000, 1000, 100)).toBe(false);
});

test("a window grows by parts, first above and then below, until it has all lines that are kept", () => {
    const kept = { from: 100, to: 700 };
    expect(missing({ from: 450, to: 500 }, kept, 250)).toEqual({ from: 200, to: 450 });
    expect(missing({ from: 200, to: 500 }, kept, 250)).toEqual({ from: 100, to: 200 });
    expect(missing({ from: 100, to: 500 }, kept, 250)).toEqual({ from: 500, to: 700 });
    expect(missing({ from: 100, to: 700 }, kept, 250)).toBe(null);
});

test.each([
    ["iso", "N10 G1 X-2.5 (to the wall)", ["N10", "G1", "X", "-2.5", "(to the wall)"], ["meta", "keyword", "typeName", "number", "comment"]],
    ["iso", "#101=5 ; count", ["#101", "=", "5", "; count"], ["variableName", null, "number", "comment"]],
    ["heidenhain", "12 L X+1 FMAX M3 ; up", ["12", "L", "X", "+1", "FMAX", "M3", "; up"], ["meta", "keyword", "typeName", "number", "keyword", "keyword", "comment"]],
    ["krl", "LIN {X 1} C_DIS", ["LIN", "{", "X", "1", "}", "C_DIS"], ["keyword", null, "typeName", "number", null, "keyword"]],
    ["rapid", "MoveL p1, v10; ! cut", ["MoveL", "p1", ",", "v10", ";", "! cut"], ["keyword", "typeName", null, "typeName", null, "comment"]],
    ["ls", "67:!Bore ;", ["67:", "!Bore ;"], ["meta", "comment"]],
    ["ls", "20:L P[2] 100mm/sec CNT50 ;", ["20:", "L", "P", "[", "2", "]", "100", "mm", "/", "sec", "CNT50", ";"], ["meta", "keyword", "variableName", null, "number", null, "number", "typeName", null, "typeName", "keyword", null]],
    ["apt", "GOTO/1,2 $$ there", ["GOTO", "/", "1", ",", "2", "$$ there"], ["keyword", null, "number", null, "number", "comment"]],
    ["toml", 'linear = "{{N}} G1" # tip', ["linear", "=", '"{{N}} G1"', "# tip"], ["keyword", null, "string", "comment"]],
] as const)("words of %s: %s", (family, line, words, tags) => {
    const found = tokens(family, line).filter(([word]) => word.trim() !== "").map(([word, tag]) => [word.trim(), tag]);
    expect(found).toEqual(words.map((word, i) => [word, tags[i]]));
});

test("every character of a line is in one token", () => {
    const line = 'G1 X1 ("}{ \u{1F600} \\ < script > é';
    for (const family of ["iso", "heidenhain", "krl", "rapid", "ls", "script", "apt", "toml"] as const) {
        expect(tokens(family, line).map(([word]) => word).join("")).toBe(line);
    }
});

test("the family is known by the dialect, else by the name of the file", () => {
    expect(familyOf("heidenhain", "a.txt")).toBe("heidenhain");
    expect(familyOf(null, "part.H")).toBe("heidenhain");
    expect(familyOf(null, "part.mpf")).toBe("iso");
    expect(familyOf("fanuc", "part.src")).toBe("krl");
    expect(familyOf(null, "dome.cls")).toBe("apt");
});

test("what was searched for is found in a line whatever its case, and not over itself", () => {
    expect(placesIn("N10 G1 x1 X10 X1", "x1")).toEqual([7, 10, 14]);
    expect(placesIn("aaaa", "AA")).toEqual([0, 2]);
    expect(placesIn("G0", "")).toEqual([]);
});
