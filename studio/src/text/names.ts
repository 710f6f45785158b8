/** What the name of a file tells. */

const TOOLPATHS = new Set(["cls", "apt", "aptsource", "cl", "ncl"]);

const endingOf = (file: string): string => file.replace(/^.*\./, "").toLowerCase();

/** CL data, which is no program of a control. */
export const isToolpath = (file: string): boolean => TOOLPATHS.has(endingOf(file));

/** What was found out about a program is neither a source nor a program. */
export const isReport = (file: string): boolean => file.endsWith(".report.json");
