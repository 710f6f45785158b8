/** Colours that the colour-blind tell apart (Okabe and Ito; the ramp runs in lightness as well as in hue). */

import { rgb } from "./raster.ts";

export type Mode = "kind" | "tool" | "operation" | "feed" | "deviation" | "order";
export const MODES: { name: Mode; title: string }[] = [
    { name: "kind", title: "kind" },
    { name: "tool", title: "tool" },
    { name: "operation", title: "operation" },
    { name: "feed", title: "feed" },
    { name: "deviation", title: "deviation" },
    { name: "order", title: "order" },
];

type Colour = [number, number, number];

/** Places in every palette. */
export const RAPID = 255;
export const MARKED = 254;
export const WRONG = 253;
export const UNKNOWN = 252;
/** The ramp of feed and deviation: 64 steps from here. */
export const RAMP = 128;
export const RAMP_STEPS = 64;

export interface Theme {
    isDark: boolean;
    paper: Colour;
    ink: string;
    soft: string;
    warn: string;
    bad: string;
    /** What has been run, what is ahead of the cursor, and what is picked out. */
    done: Uint32Array;
    ahead: Uint32Array;
    /** What a tool has cut, as wide as it is: the lines are seen on it. */
    cut: Uint32Array;
}

const light: Colour[] = [[0, 114, 178], [213, 94, 0], [0, 130, 95], [170, 70, 130], [150, 110, 0], [40, 120, 190], [90, 60, 160], [110, 75, 40]];
const dark: Colour[] = [[86, 180, 233], [230, 159, 0], [0, 190, 140], [220, 140, 190], [240, 228, 66], [120, 150, 255], [190, 150, 255], [220, 170, 120]];

/** From blue over grey to yellow, after cividis. */
const ends: Colour[] = [[0, 50, 110], [90, 95, 110], [150, 140, 110], [255, 230, 80]];

function ramp(part: number): Colour {
    const at = part * (ends.length - 1);
    const i = Math.min(ends.length - 2, Math.floor(at));
    return mix(ends[i]!, ends[i + 1]!, at - i);
}

const mix = (a: Colour, b: Colour, part: number): Colour => [
    a[0] + (b[0] - a[0]) * part,
    a[1] + (b[1] - a[1]) * part,
    a[2] + (b[2] - a[2]) * part,
];

export function theme(isDark: boolean): Theme {
    const paper: Colour = isDark ? [22, 25, 29] : [255, 255, 255];
    const few = isDark ? dark : light;
    const palette = Array.from({ length: 256 }, (_, place): Colour => {
        if (place === RAPID) return isDark ? [130, 140, 150] : [130, 138, 146];
        if (place === MARKED) return isDark ? [255, 240, 120] : [0, 0, 0];
        if (place === WRONG) return isDark ? [255, 120, 120] : [200, 0, 20];
        if (place === UNKNOWN) return isDark ? [160, 160, 160] : [120, 120, 120];
        if (place >= RAMP && place < RAMP + RAMP_STEPS) {
            const part = (place - RAMP) / (RAMP_STEPS - 1);
            return isDark ? mix(ramp(part), [255, 255, 255], 0.25) : mix(ramp(part), [0, 0, 0], 0.15);
        }
        return few[place % few.length]!;
    });
    const words = (part: number): Uint32Array => Uint32Array.from(palette, (colour) => rgb(...mix(colour, paper, part)));
    return {
        isDark,
        paper,
        ink: isDark ? "#e6e9ed" : "#1a1d21",
        soft: isDark ? "#a9b3bf" : "#4f5863",
        warn: isDark ? "#f0bd4f" : "#815200",
        bad: isDark ? "#ff8f8f" : "#b3141d",
        done: words(0),
        ahead: words(0.72),
        cut: words(0.5),
    };
}

/** The step of the ramp for a value between the least and the greatest. */
export function step(value: number, least: number, most: number): number {
    if (!Number.isFinite(value)) return UNKNOWN;
    const part = most > least ? (value - least) / (most - least) : 0;
    return RAMP + Math.round(Math.max(0, Math.min(1, part)) * (RAMP_STEPS - 1));
}
