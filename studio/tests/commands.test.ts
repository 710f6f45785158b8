import { expect, test } from "vitest";
import { optionsIn } from "../src/panes/Findings.tsx";
import { commandOf, keyOf, matching, type Command } from "../src/commands.ts";

const press = (key: string, more: Partial<KeyboardEvent> = {}) =>
    keyOf({ key, code: "", ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...more });

test("keys are named as commands name them", () => {
    expect(press(" ")).toBe("Space");
    expect(press("K", { ctrlKey: true })).toBe("Ctrl+k");
    expect(press("k", { metaKey: true })).toBe("Ctrl+k");
    expect(press("<", { shiftKey: true, code: "Comma" })).toBe("Shift+,");
    expect(press("?", { shiftKey: true })).toBe("?");
    expect(press("F8", { shiftKey: true })).toBe("Shift+F8");
});

test("single letters are commands only while a view has the focus", () => {
    const commands: Command[] = [
        { name: "fit", title: "Fit", keys: ["f"], view: true, run() {} },
        { name: "palette", title: "Commands", keys: ["Ctrl+k"], run() {} },
    ];
    expect(commandOf(commands, "f", false)).toBeUndefined();
    expect(commandOf(commands, "f", true)?.name).toBe("fit");
    expect(commandOf(commands, "Ctrl+k", false)?.name).toBe("palette");
});

test("a finding's way out leads to the options that it names", () => {
    const form = [{ name: "from" }, { name: "strict" }, { name: "work-zero" }];
    expect(optionsIn("for an NC program add `--from CONTROL`, and `--work-zero X,Y,Z` or --unknown", form)).toEqual(["from", "work-zero"]);
});

test("a search finds what has all its words, in any order", () => {
    expect(matching(["DMU 50, HEIDENHAIN", "Fanuc table B C"], "heiden dmu", (text) => text)).toEqual(["DMU 50, HEIDENHAIN"]);
    expect(matching(["b", "a"], "", (text) => text)).toEqual(["b", "a"]);
    // What somebody types whole is what Enter takes.
    expect(matching(["mill-xyz-head", "old mill-xyz", "mill-xyz big", "mill-xyz"], "mill-xyz", (text) => text)).toEqual(["mill-xyz big", "mill-xyz", "mill-xyz-head", "old mill-xyz"]);
});
