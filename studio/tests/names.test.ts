import { expect, test } from "vitest";
import type { Entry } from "../src/protocol/asks.ts";
import { isWholeBoard, offered } from "../src/text/names.ts";

const entry = (name: string, written: number, kind: Entry["kind"] = "file"): Entry => ({ name, path: name, kind, bytes: 1, written });

test("what CAM has written last stands first, and what was posted from it behind all others", () => {
    const entries = [entry("a.cls", 1), entry("b.cls", 3), entry("a.nc", 9), entry("a.nc.report.json", 9), entry("own.nc", 2), entry("out", 10, "folder")];
    expect(offered(entries, []).map(({ name }) => name)).toEqual(["b.cls", "own.nc", "a.cls", "a.nc"]);
});

test("a machine file is no source, a board in TOML is one", () => {
    const entries = [entry("mill.toml", 2), entry("lamp.toml", 1)];
    expect(offered(entries, ["linuxcnc-mill", "mill.toml"]).map(({ name }) => name)).toEqual(["lamp.toml"]);
});

test("a model and a board of KiCad are whole, a plot is one layer", () => {
    expect(["lamp.toml", "a/b.KICAD_PCB", "front.gbr"].map(isWholeBoard)).toEqual([true, true, false]);
});
