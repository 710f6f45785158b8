/** What the name of a file tells. */

import type { Entry } from "../protocol/asks.ts";

const TOOLPATHS = new Set(["cls", "apt", "aptsource", "cl", "ncl"]);

const endingOf = (file: string): string => file.replace(/^.*\./, "").toLowerCase();

/** CL data, which is no program of a control. */
export const isToolpath = (file: string): boolean => TOOLPATHS.has(endingOf(file));

/** What was found out about a program is neither a source nor a program. */
export const isReport = (file: string): boolean => file.endsWith(".report.json");

/** The files that one may want to open, the newest first, without those of machines, which are named; programs with a report beside them, which were posted from something else here, behind all others. */
export function offered(entries: Entry[], machines: string[]): Entry[] {
    const files = entries.filter(({ kind }) => kind === "file");
    const names = new Set(files.map(({ name }) => name));
    const rank = ({ name }: Entry): number => Number(names.has(`${name}.report.json`));
    return files.filter(({ name, path }) => !isReport(name) && !machines.includes(path)).toSorted((a, b) => rank(a) - rank(b) || b.written - a.written);
}

/** A board in one file, of which no layer is a file of its own. */
export const isWholeBoard = (file: string): boolean => ["kicad_pcb", "toml"].includes(endingOf(file));
