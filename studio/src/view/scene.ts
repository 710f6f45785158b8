/** What is drawn: the walk's lines as far as they are in sight, those that are picked out, the tool. The same for every renderer. */

import type { Range } from "../cursor.ts";
import type { WalkAbout } from "../protocol/asks.ts";
import type { Blocks } from "./blocks.ts";
import type { Board, Flat } from "./board.ts";
import { isSame, toScreen, type Projection, type Size } from "./camera.ts";
import { errorOf, inSight, KEPT, levelFor, SEEN, type Best, type Chunk, type Vertices } from "./chunks.ts";
import { MARKED, RAPID, UNKNOWN, WRONG, type Mode, type Theme } from "./colours.ts";
import { GAP, NEEDLES, needlesOf } from "./needles.ts";
import { painterOf, type Painter } from "./painted.ts";
import { Raster } from "./raster.ts";
import type { Rows } from "./rows.ts";
import { Mark, symbolsOf, type Symbol } from "./symbols.ts";
import { CHUNK_MOVES, Style, VERTEX_BYTES, vertexOf, type Paint, type Strip, type Triangles } from "./strip.ts";
import { frameOf, pathOf, type Seen, type Sight, type Sights } from "./sight.ts";
import { surfaceOf } from "./surface.ts";
import type { Vector } from "./vector.ts";

export interface Looks {
    mode: Mode;
    width: number;
    rapids: boolean;
    /** The tool axis at some of the moves. */
    axes: boolean;
    theme: Theme;
}

/** Where the cursor is, and what belongs to it. */
export interface Marks {
    /** The moves after this one are still ahead; null: nothing is. */
    now: number | null;
    /** What is ahead is pale. */
    pale: boolean;
    ofBlock: Range[];
    mismatch: number | null;
    tool: Triangles | null;
    bodies: Triangles[];
}

export interface Picture {
    /** What a wire cuts: it stays while the lines do. */
    surfaces: Triangles[];
    /** What lies below all else. */
    flats: Flat[];
    strips: Strip[];
    /** What is picked out, over the others. */
    over: Strip[];
    bodies: Triangles[];
    symbols: Symbol[];
    /** How far lines may be off while finer ones are on their way or too many, pixels; 0 where that is not seen, infinite where nobody knows. */
    off: number;
}

/** The most places of a board that are marked. */
const PLACES = 400;

/** The most points in a picture. */
const POINTS = 1.5e6;

const SURFACE: Triangles["colour"] = [205, 218, 235];

/** Pixels round the pointer in which a line is looked for. */
const REACH = 6;

/** Lines of a chunk: in their frame, or from its middle. */
interface Lines {
    chunk: Chunk;
    vertices: ArrayBuffer;
    frame?: Projection | undefined;
}

/** The same, of a level; null where that is not known. */
interface There extends Lines, Best {}

/** The most pixels beside the window in which cuts are looked for that reach into it. */
const BESIDE = 600;

/** How long a view rests before what is seen in it is asked for, ms: also where levels that are fine enough have not come until then. */
const REST = 100;
const LATE = 600;

/** Of a block, so many ranges of moves are picked out exactly. */
const RANGES = 200;

export class Scene {
    private painter: { mode: Mode; paint: Painter | null } = { mode: "kind", paint: null };

    private alike: { looks: Looks | null; paints: Map<Uint32Array, Paint> } = { looks: null, paints: new Map() };

    /** The board that the program is of, when it has come. */
    board: Board | null = null;

    /** Of the last picture. */
    private last: { scale: number; level: number } | null = null;

    private readonly surfaces = new WeakMap<ArrayBuffer, Triangles>();

    private widths: { looks: Looks | null; board: Board | null; scale: number; paints: Paint[] } = { looks: null, board: null, scale: 0, paints: [] };

    constructor(
        readonly walk: WalkAbout,
        readonly chunks: Vertices,
        private readonly rows: Rows,
        /** Of a wire: how high its upper end is over the lower one, mm. */
        private readonly wire: number | null = null,
        /** The blocks of glass that pulses are in. */
        private readonly blocks: Blocks | null = null,
    ) {}

    /** The surface of a chunk, made once. */
    private surface(surfaces: Triangles[], chunk: Chunk, vertices: ArrayBuffer, height: number): void {
        const known = this.surfaces.get(vertices);
        if (known !== undefined) return void surfaces.push(known);
        const [straight, round] = ["feed", "arc"].map((kind) => this.walk.kinds.indexOf(kind)) as [number, number];
        const corners = surfaceOf(chunk, vertices, this.rows, { height, straight, round });
        if (corners === null) return;
        const made = { corners, colour: SURFACE };
        this.surfaces.set(vertices, made);
        surfaces.push(made);
    }

    picture(projection: Projection, size: Size, looks: Looks, marks: Marks, sights: Sights | null = null): Picture {
        const strips: Strip[] = [];
        const symbols: Symbol[] = [];
        const surfaces: Triangles[] = [];
        const chunks = this.chunks.chunks.filter((chunk) => inSight(chunk, projection, size));
        const level = this.levelOf(projection.scale, chunks.length);
        this.last = { scale: projection.scale, level };
        const there = chunks.flatMap((chunk): There[] => {
            // Finer levels of a crowded chunk are no better.
            const best = this.chunks.best(chunk.isCrowded ? this.walk.levels.length - 1 : level, chunk.number);
            return best === null ? [] : [{ ...best, chunk }];
        });
        for (const { chunk, vertices } of there) {
            if (this.wire !== null) this.surface(surfaces, chunk, vertices, this.wire);
            if (looks.axes) this.needles(strips, chunk, vertices, looks, projection);
        }
        const off = Math.max(0, ...there.map(({ chunk, level }) => this.off(chunk, level, projection)));
        const isSeen = chunks.some((chunk) => this.off(chunk, level, projection) > 0);
        // Levels that are fine enough are on their way: they mostly come before the view is asked for.
        const seen = sights !== null && (isSeen || off > 0) ? this.seen(projection, size, looks, sights, isSeen ? REST : LATE) : null;
        if (seen === null && sights !== null) sights.drawn = null;
        if (!isSeen && off === 0) sights?.lines.forget();
        const lines = seen ?? there;
        for (const one of lines) {
            this.bands(strips, one, looks, marks, projection.scale);
            this.lines(strips, one, looks, marks);
            symbolsOf(symbols, one, one.frame ?? projection, size);
        }
        const over = this.picked(there, isSeen, projection, size, looks, marks, sights);
        const edges = this.blocks?.edges(looks.theme) ?? null;
        if (edges !== null) strips.push(edges);
        const tabs = this.board?.tabLines(looks.theme) ?? null;
        if (tabs !== null) strips.push(tabs);
        const flats = this.board?.flats(looks.theme) ?? [];
        this.places(symbols, projection, size);
        return { off: seen === null ? off : 0, flats, surfaces, strips, over, symbols, bodies: marks.tool === null ? marks.bodies : [...marks.bodies, marks.tool] };
    }

    /** How far the lines of a chunk are off at a level, pixels; 0 where that is not seen. */
    private off(chunk: Chunk, level: number | null, { scale }: Projection): number {
        if (this.isPoints || (level === null && this.walk.levels.length === 1 && !chunk.isCrowded)) return 0;
        const off = level === null ? Number.POSITIVE_INFINITY : errorOf(chunk, this.walk.levels[level]!.error) * scale;
        return off > SEEN ? off : 0;
    }

    /** What is seen in this view: null until it has come. */
    private seen(projection: Projection, size: Size, looks: Looks, sights: Sights, rest: number): There[] | null {
        const widest = Math.max(0, ...this.bandPaints(looks, projection.scale).map(({ width }) => width));
        const beside = Math.min(BESIDE, Math.ceil(widest / 2));
        const rapid = this.walk.kinds.indexOf("rapid");
        const hidden = looks.rapids || rapid < 0 ? 0 : 1 << rapid;
        const seen = sights.lines.of(this.chunks, pathOf(projection, size, beside, hidden, null), rest);
        sights.drawn = seen === null ? null : { projection, seen, beside };
        return seen === null ? null : this.framed(seen, projection, beside);
    }

    private framed(seen: Seen[], projection: Projection, beside: number): There[] {
        const frame = frameOf(projection, beside);
        return seen.flatMap(({ chunk: number, vertices }) => {
            const chunk = this.chunks.chunks[number];
            return chunk === undefined ? [] : [{ chunk: { ...chunk, origin: [0, 0, 0] }, vertices, level: 0, frame }];
        });
    }

    /** The least and the greatest feed that is known, mm/min. */
    get feeds(): [least: number, most: number] | null {
        const ends = this.painter.paint?.ends?.() ?? null;
        return ends !== null && ends[0] <= ends[1] ? ends : null;
    }

    /** Points of a laser, which no lines join. */
    private get isPoints(): boolean {
        return this.blocks !== null;
    }

    /** The level at a scale; where more would be in sight than is kept, and of points, which do not thin out as lines do, than can be drawn, a coarser one. */
    private levelOf(scale: number, inSight: number): number {
        const { levels, chunks } = this.walk;
        const most = this.isPoints ? POINTS : KEPT / 2 / VERTEX_BYTES;
        const isTooMany = (level: number): boolean => (levels[Math.max(0, level)]!.vertices * inSight) / Math.max(1, chunks) > most;
        let level = levelFor(this.walk, scale);
        while (level + 1 < levels.length && isTooMany(level)) level++;
        return level;
    }

    /** Places of the board that are to be looked at. */
    private places(symbols: Symbol[], projection: Projection, { width, height }: Size): void {
        for (const { x, y } of this.board?.about.places.slice(0, PLACES) ?? []) {
            const [px, py] = toScreen(projection, [x, y, 0]);
            if (px >= 0 && py >= 0 && px < width && py < height) symbols.push({ x: px, y: py, marks: Mark.finding });
        }
    }

    /** What has been cut, as wide as the tool: of what is ahead nothing, while that is pale. */
    private bands(strips: Strip[], there: Lines, looks: Looks, { now, pale }: Pick<Marks, "now" | "pale">, scale: number): void {
        const { chunk: { first }, vertices } = there;
        const count = vertices.byteLength / 16;
        const isDone = !pale || now === null || now >= first + CHUNK_MOVES;
        const border = isDone ? count : now < first ? 1 : vertexOf(vertices, now - first + 1);
        for (const paint of this.bandPaints(looks, scale)) add(strips, there, [1, border], paint);
    }

    /** A paint for each tool whose width is known and is seen at this scale. */
    private bandPaints(looks: Looks, scale: number): Paint[] {
        if (this.widths.looks === looks && this.widths.board === this.board && this.widths.scale === scale) return this.widths.paints;
        const { kinds } = this.walk;
        const only = this.board?.about.width ?? null;
        const tools = this.walk.tools.length > 0 || only === null ? this.walk.tools.map(({ width }, tool) => ({ width, tool })) : [{ width: only, tool: -1 }];
        const styles = Uint8Array.from({ length: 16 }, (_, kind) => (kinds[kind] === "feed" || kinds[kind] === "arc" ? Style.line : Style.hidden));
        const paints = tools.flatMap(({ width, tool }): Paint[] => {
            const pixels = (width ?? 0) * scale;
            return pixels < 2 ? [] : [{ palette: looks.theme.cut, byMove: null, shift: 16, mask: 63, styles, dashed: -1, width: pixels, tool, round: true, lift: -1 }];
        });
        this.widths = { looks, board: this.board, scale, paints };
        return paints;
    }

    private needles(strips: Strip[], chunk: Chunk, vertices: ArrayBuffer, looks: Looks, { scale }: Projection): void {
        const stride = Math.max(1, Math.ceil(((vertices.byteLength / 16) * this.chunks.chunks.length) / NEEDLES));
        const styles = Uint8Array.from({ length: 16 }, (_, kind) => (kind === GAP ? Style.hidden : Style.line));
        const paint = { palette: new Uint32Array([looks.theme.done[UNKNOWN]!]), byMove: null, shift: 0, mask: 0, styles, dashed: -1, width: 1, tool: -1, round: false, lift: 0 };
        const needles = needlesOf(chunk, vertices, this.rows, stride, 18 / scale, paint);
        if (needles !== null) strips.push(needles);
    }

    private lines(strips: Strip[], there: Lines, looks: Looks, { now, pale }: Pick<Marks, "now" | "pale">): void {
        const { chunk, chunk: { first }, vertices } = there;
        const count = vertices.byteLength / 16;
        const { done, ahead } = looks.theme;
        const isDone = !pale || now === null || now >= first + CHUNK_MOVES;
        const border = isDone ? count : now < first ? 1 : vertexOf(vertices, now - first + 1);
        add(strips, there, [1, border], this.paint(chunk, looks, done));
        add(strips, there, [border, count], this.paint(chunk, looks, ahead));
    }

    /** The first mismatch, the moves of the cursor's block, and the move that it is at. */
    private picked(there: There[], isSeen: boolean, projection: Projection, size: Size, looks: Looks, { now, ofBlock, mismatch }: Marks, sights: Sights | null): Strip[] {
        const over: Strip[] = [];
        const pick = (sight: Sight | undefined, ranges: Range[], paint: () => Paint): void => {
            const [few, more] = [ranges.slice(0, RANGES), ranges.slice(RANGES)];
            // At a coarse level others may be drawn for a move.
            const isCoarse = there.some(({ chunk, level }) => (isSeen || level !== 0) && few.some((range) => within(range, chunk) !== null));
            const seen = isCoarse ? (sight?.of(this.chunks, pathOf(projection, size, 0, 0, few), REST) ?? null) : null;
            for (const one of this.framed(seen ?? [], projection, 0)) add(over, one, [1, one.vertices.byteLength / VERTEX_BYTES], paint());
            for (const one of there) {
                for (const range of seen === null ? ranges : more) this.marked(over, one, range, paint);
            }
        };
        if (mismatch !== null) pick(sights?.mismatch, [[mismatch, mismatch + 1]], () => this.plain(WRONG, looks, 4, 2));
        if (ofBlock.length > 0) pick(sights?.block, ofBlock, () => this.plain(MARKED, looks, 2, 2));
        if (now !== null) pick(sights?.now, [[now, now + 1]], () => this.plain(MARKED, looks, 3, 3));
        return over;
    }

    private marked(over: Strip[], there: There, range: Range, paintOf: () => Paint): void {
        const { chunk, vertices, level } = there;
        const own = within(range, chunk);
        if (own === null) return;
        const begin = vertexOf(vertices, own[0]);
        // At a coarse level a move may have no vertex of its own: the one that it is in is marked.
        const least = level === 0 ? begin : Math.min(begin + 1, vertices.byteLength / 16);
        add(over, there, [begin, Math.max(vertexOf(vertices, own[1]), least)], paintOf());
    }

    private paint(chunk: Chunk, looks: Looks, palette: Uint32Array): Paint {
        const { mode } = looks;
        if (this.painter.mode !== mode) this.painter = { mode, paint: painterOf(mode, this.walk, this.rows) };
        const byMove = this.painter.paint?.(chunk) ?? null;
        const paint = this.byBits(looks, palette);
        return byMove === null ? paint : { ...paint, byMove };
    }

    /** The paint of all chunks alike: by tool, or by kind. */
    private byBits(looks: Looks, palette: Uint32Array): Paint {
        if (this.alike.looks !== looks) this.alike = { looks, paints: new Map() };
        const known = this.alike.paints.get(palette);
        if (known !== undefined) return known;
        const styles = Uint8Array.from({ length: 16 }, (_, kind) => this.styleOf(kind, looks.rapids));
        const bits = looks.mode === "tool" ? { shift: 16, mask: 63 } : { shift: 12, mask: 15 };
        // On the edge of a surface lines lie over it.
        const width = looks.width + (this.isPoints ? 1 : 0);
        const paint = { palette, byMove: null, ...bits, styles, dashed: RAPID, width, tool: -1, round: false, lift: this.wire === null ? 0 : 1.5 };
        this.alike.paints.set(palette, paint);
        return paint;
    }

    private plain(place: number, looks: Looks, wider: number, lift: number): Paint {
        const styles = Uint8Array.from({ length: 16 }, (_, kind) => this.styleOf(kind, true)).map((style) => (style === Style.dashed ? Style.line : style));
        const palette = new Uint32Array([looks.theme.done[place]!]);
        return { palette, byMove: null, shift: 0, mask: 0, styles, dashed: -1, width: looks.width + wider, tool: -1, round: false, lift };
    }

    private styleOf(kind: number, rapids: boolean): number {
        const name = this.walk.kinds[kind];
        if (name === "gap") return Style.hidden;
        if (name === "pulse") return Style.dot;
        if (name !== "rapid") return Style.line;
        return rapids ? Style.dashed : Style.hidden;
    }

    /** The move under the pixel: found in what is drawn, then, where that is coarse, among the exact lines of that chunk. */
    async pick(camera: Projection, looks: Looks, x: number, y: number, sights: Sights | null = null): Promise<number | null> {
        const drawn = sights?.drawn ?? null;
        if (drawn !== null && isSame(drawn.projection, camera)) {
            const strips: Strip[] = [];
            for (const one of this.framed(drawn.seen, camera, drawn.beside)) this.pickable(strips, one, looks, camera.scale);
            return seen(strips, camera, x, y);
        }
        const rough = seen(this.near(camera, looks, x, y), camera, x, y);
        if (rough === null) return null;
        const chunk = this.chunks.chunks[Math.floor(rough / CHUNK_MOVES)];
        if (chunk === undefined) return rough;
        const vertices = await this.chunks.exact(0, chunk.number);
        if (vertices === null) return rough;
        const exact: Strip[] = [];
        this.pickable(exact, { chunk, vertices }, looks, camera.scale);
        return seen(exact, camera, x, y) ?? rough;
    }

    /** What is drawn of the chunks that reach to the pixel. */
    private near(camera: Projection, looks: Looks, x: number, y: number): Strip[] {
        const strips: Strip[] = [];
        const level = this.last?.scale === camera.scale ? this.last.level : this.levelOf(camera.scale, this.chunks.chunks.length);
        const reach = REACH + Math.max(0, ...this.bandPaints(looks, camera.scale).map(({ width }) => width / 2));
        const round = { ...camera, at: [camera.at[0] - x + reach, camera.at[1] - y + reach, camera.at[2]] as Vector };
        for (const chunk of this.chunks.chunks) {
            if (!inSight(chunk, round, { width: reach * 2, height: reach * 2 })) continue;
            const best = this.chunks.best(level, chunk.number);
            if (best !== null) this.pickable(strips, { ...best, chunk }, looks, camera.scale);
        }
        return strips;
    }

    private pickable(strips: Strip[], there: Lines, looks: Looks, scale: number): void {
        const all = { now: null, pale: false };
        this.bands(strips, there, looks, all, scale);
        this.lines(strips, there, looks, all);
    }
}

/** The move of the nearest line, or of the cut that the pixel is in. */
function seen(strips: Strip[], projection: Projection, x: number, y: number): number | null {
    const lines = strips.flatMap((strip) => (strip.paint.round ? [] : [{ ...strip, paint: { ...strip.paint, width: 1 } }]));
    return nearest(lines, projection, x, y) ?? nearest(strips.filter(({ paint }) => paint.round), projection, x, y);
}

function add(strips: Strip[], { chunk: { origin, first }, vertices, frame }: Lines, [from, to]: Range, paint: Paint): void {
    if (from < to) strips.push({ vertices, origin, first, from, to, paint, frame });
}

/** The moves of a range that a chunk has, counted from its first one. */
function within([from, to]: Range, { first }: Chunk): Range | null {
    const [low, high] = [Math.max(from - first, 0), Math.min(to - first, CHUNK_MOVES)];
    return low < high ? [low, high] : null;
}

/** The move whose line is nearest to the pixel, and of those the one that is seen. */
export function nearest(strips: Strip[], projection: Projection, x: number, y: number): number | null {
    const side = REACH * 2 + 1;
    const [left, top] = [Math.floor(x) - REACH, Math.floor(y) - REACH];
    const raster = new Raster(side, side, { sees: "moves", left, top });
    raster.clear(0);
    for (const strip of strips) {
        for (const [from, to] of reaching(strip, projection, { left, top, side })) raster.strip({ ...strip, from, to }, projection);
    }
    let best: number | null = null;
    let least = (REACH + 0.5) ** 2;
    raster.seen.forEach((id, at) => {
        if (id === 0) return;
        const distance = ((at % side) - REACH) ** 2 + (Math.floor(at / side) - REACH) ** 2;
        if (distance >= least) return;
        least = distance;
        best = id - 1;
    });
    return best;
}


/** Of a strip, the lines that may come into a square of pixels: of millions there are few, and only these are drawn. */
export function reaching({ vertices, origin, from, to, paint, frame }: Strip, projection: Projection, { left, top, side }: { left: number; top: number; side: number }): Range[] {
    const { right, down, at } = frame ?? projection;
    const numbers = new Float32Array(vertices);
    const [rx, ry, rz] = right;
    const [dx, dy, dz] = down;
    const reach = paint.width / 2 + 1;
    const size = side + 2 * reach;
    const cx = at[0] + rx * origin[0] + ry * origin[1] + rz * origin[2] - left + reach;
    const cy = at[1] + dx * origin[0] + dy * origin[1] + dz * origin[2] - top + reach;
    const found: Range[] = [];
    let x0 = 0;
    let y0 = 0;
    for (let vertex = from - 1, i = vertex * 4; vertex < to; vertex++, i += 4) {
        const x = numbers[i]!;
        const y = numbers[i + 1]!;
        const z = numbers[i + 2]!;
        const x1 = rx * x + ry * y + rz * z + cx;
        const y1 = dx * x + dy * y + dz * z + cy;
        const isBeside = (x0 < 0 && x1 < 0) || (y0 < 0 && y1 < 0) || (x0 > size && x1 > size) || (y0 > size && y1 > size);
        if (vertex >= from && !isBeside) {
            const last = found.at(-1);
            if (last?.[1] === vertex) last[1] = vertex + 1;
            else found.push([vertex, vertex + 1]);
        }
        x0 = x1;
        y0 = y1;
    }
    return found;
}
