/** Which lines of a long text the editor keeps. */

/** Lines from the first to before the last, counted from 1 as in the file. */
export interface Window {
    from: number;
    to: number;
}

/** Texts up to so many lines are kept whole. */
export const KEPT = 200_000;

/** Texts up to so many lines come at once; of a longer one first those round the cursor. */
const SHORT = 5000;

/** Of a text that is not kept whole, as many lines are kept when the cursor rests. */
export const LONG = 20_000;

/** Lines of one answer to be added: more would hold the page up. */
const PART = 5000;

/** The lines that are fetched first: of a longer text as many as fill the pane wherever in it the line comes to stand. */
export const firstWindow = (line: number, lines: number, inSight: number): Window => windowAround(line, lines, lines <= SHORT ? SHORT : 2 * inSight + 10);

/** The lines that are there in the end. */
export const lastWindow = (line: number, lines: number): Window => windowAround(line, lines, lines <= KEPT ? KEPT : LONG);

/** All of a text, or as many lines as are kept, with `line` in the middle. */
export function windowAround(line: number, lines: number, kept: number): Window {
    if (lines <= kept) return { from: 1, to: lines + 1 };
    const from = Math.max(1, Math.min(lines - kept + 1, line - Math.floor(kept / 2)));
    return { from, to: from + kept };
}

export const isWithin = ({ from, to }: Window, line: number): boolean => from <= line && line < to;

/** Whether the lines in sight come so near to an end of the window that more has to be fetched. */
export function isNearEnd(window: Window, first: number, last: number, lines: number, margin = 1000): boolean {
    return (window.from > 1 && first - window.from < margin) || (window.to <= lines && window.to - last < margin);
}

/** The next lines to fetch, at most `part`, so that `here` grows to all of `kept`; null when it has. */
export function missing(here: Window, kept: Window, part = PART): Window | null {
    if (here.from > kept.from) return { from: Math.max(kept.from, here.from - part), to: here.from };
    return here.to < kept.to ? { from: here.to, to: Math.min(kept.to, here.to + part) } : null;
}

/** A line that is longer is not looked through, characters. */
const LOOKED_THROUGH = 100_000;

/** Where a text stands in a line, whatever its case. */
export function placesIn(line: string, text: string): number[] {
    if (line.length > LOOKED_THROUGH) return [];
    const [all, one] = [line.toLowerCase(), text.toLowerCase()];
    const places: number[] = [];
    for (let at = one === "" ? -1 : all.indexOf(one); at >= 0 && places.length < 100; at = all.indexOf(one, at + one.length)) places.push(at);
    return places;
}
