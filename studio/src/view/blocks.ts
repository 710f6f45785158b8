/** Blocks of glass round the pulses in them: their edges. */

import type { GlassBlock } from "../protocol/asks.ts";
import type { Box } from "./camera.ts";
import type { Theme } from "./colours.ts";
import { rgb } from "./raster.ts";
import { Style, VERTEX_BYTES, wordOf, type Paint, type Strip } from "./strip.ts";
import { along, type Vector } from "./vector.ts";

const light: Vector = [120, 150, 165];
const dark: Vector = [105, 130, 145];

/** Corners by bits: which sides lead to them. */
const EDGES = [1, 2, 4].flatMap((bit) => [0, 1, 2, 3, 4, 5, 6, 7].filter((from) => (from & bit) === 0).map((from) => [from, from | bit] as const));

function corner({ corner: at, sides }: GlassBlock, bits: number): Vector {
    return sides.reduce<Vector>((point, side, i) => (bits & (1 << i) ? along(point, side, 1) : point), at);
}

export class Blocks {
    private made: { theme: Theme; strip: Strip } | null = null;

    constructor(private readonly blocks: GlassBlock[]) {}

    /** They are no moves. */
    edges(theme: Theme): Strip {
        if (this.made?.theme === theme) return this.made.strip;
        const ends = this.blocks.flatMap((block) => EDGES.flatMap((edge) => edge.map((bits) => corner(block, bits))));
        const vertices = new ArrayBuffer(ends.length * VERTEX_BYTES);
        const numbers = new Float32Array(vertices);
        const words = new Uint32Array(vertices);
        ends.forEach((point, end) => {
            numbers.set(point, end * 4);
            words[end * 4 + 3] = wordOf(0, end % 2, 0);
        });
        const styles = Uint8Array.from({ length: 16 }, (_, kind) => (kind === 0 ? Style.hidden : Style.line));
        const palette = new Uint32Array([rgb(...(theme.isDark ? dark : light))]);
        const paint: Paint = { palette, byMove: null, shift: 0, mask: 0, styles, dashed: -1, width: 1, tool: -1, round: false, lift: 0 };
        const strip: Strip = { vertices, origin: [0, 0, 0], first: -1, from: 1, to: ends.length, paint };
        this.made = { theme, strip };
        return strip;
    }

    /** A box around all of them. */
    get box(): Box {
        const corners = this.blocks.flatMap((block) => [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => corner(block, bits)));
        const of = (way: (...parts: number[]) => number): Vector => [0, 1, 2].map((axis) => way(...corners.map((point) => point[axis]!))) as Vector;
        return { low: of(Math.min), high: of(Math.max) };
    }
}
