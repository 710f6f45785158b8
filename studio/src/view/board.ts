/** A board below the cuts of its program: areas of copper by net, holes, and places to look at; tabs lie over the cuts. */

import type { BoardPicture } from "../protocol/asks.ts";
import type { Theme } from "./colours.ts";
import { rgb } from "./raster.ts";
import { Style, VERTEX_BYTES, wordOf, type Paint, type Strip } from "./strip.ts";
import type { Vector } from "./vector.ts";

/** Convex areas with four corners in the plane Z 0, of one colour: they lie below all that is drawn. */
export interface Flat {
    /** x, y of each corner, in turn around the area. */
    corners: Float32Array;
    /** Red, green, blue, alpha in the order of the bytes. */
    colour: number;
}

/** Numbers of a trapezoid: low and high Y, left and right X below, left and right X above. */
const TRAPEZOID = 6;
const STROKE = 5;
const SIDES = 24;

/** How wide the line of a tab is, pixels. */
const TAB = 5;

/** How many colours conductors have. */
const COLOURS = 8;

type Colour = Vector;

const light = {
    board: [239, 233, 210] as Colour,
    hole: [74, 79, 85] as Colour,
    tab: [17, 17, 17] as Colour,
    rest: [209, 32, 47] as Colour,
    copper: [[226, 178, 122], [159, 197, 168], [188, 183, 160], [219, 166, 173], [195, 179, 221], [165, 207, 208], [211, 197, 143], [201, 183, 166]] as Colour[],
};

const dark: typeof light = {
    board: [44, 48, 42],
    hole: [12, 14, 16],
    tab: [235, 235, 235],
    rest: [230, 70, 80],
    copper: [[128, 92, 52], [66, 104, 76], [98, 94, 74], [122, 76, 82], [98, 84, 124], [70, 108, 110], [112, 100, 56], [104, 88, 74]],
};

export class Board {
    private lines: { theme: Theme; strip: Strip } | null = null;

    private painted: { theme: Theme; flats: Flat[] } | null = null;

    constructor(
        readonly about: BoardPicture,
        private readonly trapezoids: Float32Array,
        private readonly holes: Float32Array,
        private readonly tabs: Float32Array,
    ) {}

    /** Where tabs stay, over the cuts: they are no moves. */
    tabLines(theme: Theme): Strip | null {
        const count = this.tabs.length / 4;
        if (count === 0) return null;
        if (this.lines?.theme === theme) return this.lines.strip;
        const vertices = new ArrayBuffer(count * 2 * VERTEX_BYTES);
        const numbers = new Float32Array(vertices);
        const words = new Uint32Array(vertices);
        for (let end = 0; end < count * 2; end++) {
            numbers.set(this.tabs.subarray(end * 2, end * 2 + 2), end * 4);
            words[end * 4 + 3] = wordOf(0, end % 2, 0);
        }
        const styles = Uint8Array.from({ length: 16 }, (_, kind) => (kind === 0 ? Style.hidden : Style.line));
        const palette = new Uint32Array([rgb(...(theme.isDark ? dark : light).tab)]);
        const paint: Paint = { palette, byMove: null, shift: 0, mask: 0, styles, dashed: -1, width: TAB, tool: -1, round: false, lift: 1000 };
        const strip: Strip = { vertices, origin: [0, 0, 0], first: -1, from: 1, to: count * 2, paint };
        this.lines = { theme, strip };
        return strip;
    }

    /** The areas, the lowest first. */
    flats(theme: Theme): Flat[] {
        if (this.painted?.theme !== theme) this.painted = { theme, flats: this.paint(theme) };
        return this.painted.flats;
    }

    private paint({ isDark }: Theme): Flat[] {
        const colours = isDark ? dark : light;
        const looks = [colours.board, ...colours.copper, colours.rest];
        const by = looks.map((): number[] => []);
        this.each((place, { kind, conductor }) => {
            const look = kind === "board" ? 0 : kind === "copper" ? 1 + (conductor % COLOURS) : looks.length - 1;
            this.cornersOf(place, by[look]!);
        });
        const rest = by.pop()!;
        const holes: number[] = [];
        for (let i = 0; i < this.holes.length; i += STROKE) stroke(holes, this.holes.subarray(i, i + STROKE));
        const flat = (corners: number[], colour: Colour): Flat => ({ corners: Float32Array.from(corners), colour: rgb(...colour) });
        const areas = by.map((corners, look) => flat(corners, looks[look]!));
        return [...areas, flat(holes, colours.hole), flat(rest, colours.rest)].filter(({ corners }) => corners.length > 0);
    }

    /** Each trapezoid with the area that it is part of. */
    private each(take: (place: number, area: BoardPicture["areas"][number]) => void): void {
        let place = 0;
        for (const area of this.about.areas) {
            for (let i = 0; i < area.count; i++, place++) take(place, area);
        }
    }

    private cornersOf(place: number, corners: number[]): void {
        const [low, high, a, b, c, d] = this.trapezoids.subarray(place * TRAPEZOID, place * TRAPEZOID + TRAPEZOID) as unknown as [number, number, number, number, number, number];
        corners.push(a, low, b, low, d, high, c, high);
    }

    /** What is copper at this place: its net, or that it has no name; null where there is none. */
    netAt(x: number, y: number): string | null {
        let found: string | null = null;
        const numbers = this.trapezoids;
        this.each((place, { kind, net, conductor }) => {
            const i = place * TRAPEZOID;
            const [low, high] = [numbers[i]!, numbers[i + 1]!];
            if (kind !== "copper" || y < low || y > high) return;
            const part = high > low ? (y - low) / (high - low) : 0;
            const left = numbers[i + 2]! + (numbers[i + 4]! - numbers[i + 2]!) * part;
            const right = numbers[i + 3]! + (numbers[i + 5]! - numbers[i + 3]!) * part;
            if (x >= left && x <= right) found = net ?? `without a name (${conductor + 1})`;
        });
        return found;
    }

    /** The corners of a box around the board, flat. */
    get box(): { low: Vector; high: Vector } | null {
        const count = this.about.areas.reduce((sum, area) => sum + area.count, 0);
        if (count === 0) return null;
        const low: Vector = [Infinity, Infinity, 0];
        const high: Vector = [-Infinity, -Infinity, 0];
        const numbers = this.trapezoids;
        for (let i = 0; i < numbers.length; i += TRAPEZOID) {
            low[0] = Math.min(low[0], numbers[i + 2]!, numbers[i + 4]!);
            high[0] = Math.max(high[0], numbers[i + 3]!, numbers[i + 5]!);
            low[1] = Math.min(low[1], numbers[i]!);
            high[1] = Math.max(high[1], numbers[i + 1]!);
        }
        return { low, high };
    }
}

/** A stroke from x, y to x, y of a width as convex areas: the middle, and at its ends halves of discs. */
function stroke(corners: number[], [x0, y0, x1, y1, width]: ArrayLike<number> & Iterable<number>): void {
    const length = Math.hypot(x1! - x0!, y1! - y0!);
    const [ux, uy] = length > 0 ? [(x1! - x0!) / length, (y1! - y0!) / length] : [1, 0];
    const r = width! / 2;
    const [nx, ny] = [-uy * r, ux * r];
    if (length > 0) corners.push(x0! + nx, y0! + ny, x0! - nx, y0! - ny, x1! - nx, y1! - ny, x1! + nx, y1! + ny);
    // Strips of a disc across the stroke.
    const end = (x: number, y: number, way: number): void => {
        const at = (angle: number, side: number): [number, number] => {
            const [c, s] = [Math.cos(angle) * r * way, Math.sin(angle) * r * side];
            return [x + ux * c - uy * s, y + uy * c + ux * s];
        };
        for (let i = 0; i < SIDES / 4; i++) {
            const [from, to] = [(Math.PI / 2) * (1 - i / (SIDES / 4)), (Math.PI / 2) * (1 - (i + 1) / (SIDES / 4))];
            corners.push(...at(from, 1), ...at(from, -1), ...at(to, -1), ...at(to, 1));
        }
    };
    end(x0!, y0!, -1);
    end(x1!, y1!, 1);
}
