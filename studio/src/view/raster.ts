/**
 * Draws lines and triangles into two planes: depth, and what is seen there, a colour or the number of a move (from 1; 0 is
 * nothing). The planes are a window of the picture at `left`, `top`: the whole of it to be shown, or a few pixels to see
 * what is there.
 */

import type { Flat } from "./board.ts";
import type { Projection } from "./camera.ts";
import { Style, type Strip, type Triangles } from "./strip.ts";
import { along, cross, dot, unit, type Vector } from "./vector.ts";

/** Beyond this a pixel's number is no longer exact, and what is not finite is beyond it. */
const FAR = 1e7;

/** Pixels of a line that may be left out where others are drawn that it is among. */
const SHORT = 12;

export class Raster {
    readonly seen: Uint32Array<ArrayBuffer>;
    readonly depth: Float32Array;
    /** Of short lines and of points one in so many is drawn, and of the pixels of a thin long line, besides its end. */
    stride = 1;
    /** Pixels that lines have gone through since the plane was cleared, drawn or not. */
    gone = 0;

    constructor(
        readonly width: number,
        readonly height: number,
        private readonly planes: { sees: "colours" | "moves"; left: number; top: number } = { sees: "colours", left: 0, top: 0 },
    ) {
        this.seen = new Uint32Array(width * height);
        this.depth = new Float32Array(width * height);
    }

    clear(background: number): void {
        this.seen.fill(background);
        this.depth.fill(Number.POSITIVE_INFINITY);
        this.gone = 0;
    }

    strip(strip: Strip, projection: Projection): void {
        const { origin, paint, first } = strip;
        const { right, down, away, at } = strip.frame ?? projection;
        const { palette, byMove, shift, mask, styles, dashed, width, tool, round, lift } = paint;
        const isMoves = this.planes.sees === "moves";
        const numbers = new Float32Array(strip.vertices);
        const words = new Uint32Array(strip.vertices);
        const [rx, ry, rz] = right;
        const [dx, dy, dz] = down;
        const [ax, ay, az] = away;
        const [ox, oy, oz] = origin;
        const cx = at[0] + rx * ox + ry * oy + rz * oz - this.planes.left;
        const cy = at[1] + dx * ox + dy * oy + dz * oz - this.planes.top;
        const cz = at[2] + ax * ox + ay * oy + az * oz - lift;

        const { stride } = this;
        let turn = 0;
        let gone = 0;
        let x0 = 0;
        let y0 = 0;
        let z0 = 0;
        for (let vertex = strip.from - 1, i = vertex * 4; vertex < strip.to; vertex++, i += 4) {
            const x = numbers[i]!;
            const y = numbers[i + 1]!;
            const z = numbers[i + 2]!;
            const x1 = rx * x + ry * y + rz * z + cx;
            const y1 = dx * x + dy * y + dz * z + cy;
            const z1 = ax * x + ay * y + az * z + cz;
            if (vertex >= strip.from) {
                const word = words[i + 3]!;
                const style = styles[(word >>> 12) & 15];
                if (style !== Style.hidden && (tool < 0 || ((word >>> 16) & 255) === tool)) {
                    const length = Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0));
                    gone += length;
                    if (stride > 1 && (length < SHORT || style === Style.dot) && ++turn % stride !== 0) {
                        x0 = x1;
                        y0 = y1;
                        z0 = z1;
                        continue;
                    }
                    const dash = style === Style.dashed;
                    const index = dash && dashed >= 0 ? dashed : byMove === null ? (word >>> shift) & mask : byMove[word & 4095]!;
                    const seen = isMoves ? first + (word & 4095) + 1 : palette[index]!;
                    if (style === Style.dot) this.square(x1, y1, z1, seen, width);
                    else if (round) this.stroke([x0, y0, z0], [x1, y1, z1], seen, width / 2);
                    else this.line(x0, y0, z0, x1, y1, z1, seen, width, dash);
                }
            }
            x0 = x1;
            y0 = y1;
            z0 = z1;
        }
        this.gone += gone;
    }

    /** A line of `width` pixels; dashes of five pixels in eight, counted from its beginning. */
    line(x0: number, y0: number, z0: number, x1: number, y1: number, z1: number, seen: number, width: number, dashed: boolean): void {
        const w = this.width;
        const h = this.height;
        const inside = x0 >= 0 && x1 >= 0 && y0 >= 0 && y1 >= 0 && x0 < w && x1 < w && y0 < h && y1 < h;
        if (inside && width === 1 && !dashed) this.thin(x0, y0, z0, x1, y1, z1, seen);
        else this.any(x0, y0, z0, x1, y1, z1, seen, width, dashed);
    }

    /** Nearly all lines: a pixel wide and within the window. The longer way is stepped through pixel by pixel. */
    private thin(x0: number, y0: number, z0: number, x1: number, y1: number, z1: number, seen: number): void {
        const { width, depth, seen: plane, stride } = this;
        const dx = x1 - x0;
        const dy = y1 - y0;
        const steps = Math.ceil(Math.max(Math.abs(dx), Math.abs(dy)));
        if (steps > 1) {
            const part = stride / steps;
            const sx = dx * part;
            const sy = dy * part;
            const sz = (z1 - z0) * part;
            for (let step = 0; step < steps; step += stride) {
                const at = (y0 | 0) * width + (x0 | 0);
                if (z0 <= depth[at]!) {
                    depth[at] = z0;
                    plane[at] = seen;
                }
                x0 += sx;
                y0 += sy;
                z0 += sz;
            }
        }
        const at = (y1 | 0) * width + (x1 | 0);
        if (z1 > depth[at]!) return;
        depth[at] = z1;
        plane[at] = seen;
    }

    private any(x0: number, y0: number, z0: number, x1: number, y1: number, z1: number, seen: number, width: number, dashed: boolean): void {
        const [w, h] = [this.width + width, this.height + width];
        if ((x0 < -width && x1 < -width) || (x0 > w && x1 > w) || (y0 < -width && y1 < -width) || (y0 > h && y1 > h)) return;
        if (!(Math.abs(x0) < FAR && Math.abs(y0) < FAR && Math.abs(x1) < FAR && Math.abs(y1) < FAR)) return;
        const [dx, dy] = [x1 - x0, y1 - y0];
        const steps = Math.ceil(Math.max(Math.abs(dx), Math.abs(dy), 1));
        const [begin, end] = this.within(x0, dx, -width, w, steps, this.within(y0, dy, -width, h, steps, [0, steps]));
        const [sx, sy, sz] = [dx / steps, dy / steps, (z1 - z0) / steps];
        const half = (width - 1) / 2;
        const isWide = Math.abs(dx) >= Math.abs(dy);
        for (let step = begin; step <= end; step++) {
            if (dashed && (step & 7) >= 5) continue;
            const [x, y, z] = [x0 + step * sx, y0 + step * sy, z0 + step * sz];
            for (let side = -half; side <= half; side++) this.dot(isWide ? x : x + side, isWide ? y + side : y, z, seen);
        }
    }

    /** A point of `width` pixels. */
    private square(x: number, y: number, z: number, seen: number, width: number): void {
        const half = (width - 1) / 2;
        for (let down = -half; down <= half; down++) {
            for (let side = -half; side <= half; side++) this.dot(x + side, y + down, z, seen);
        }
    }

    /** All that is within a radius of a line, in pixels. */
    private stroke(a: Vector, b: Vector, seen: number, radius: number): void {
        const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        const top = Math.max(0, Math.ceil(Math.min(a[1], b[1]) - radius - 0.5));
        const bottom = Math.min(this.height - 1, Math.floor(Math.max(a[1], b[1]) + radius - 0.5));
        if (Math.max(a[0], b[0]) + radius < 0 || Math.min(a[0], b[0]) - radius > this.width) return;
        if (![a[0], a[1], b[0], b[1]].every((part) => Math.abs(part) < FAR)) return;
        const squared = dx * dx + dy * dy;
        const length = Math.sqrt(squared);
        const [nx, ny] = length > 0 ? [(-dy / length) * radius, (dx / length) * radius] : [0, 0];
        for (let y = top; y <= bottom; y++) {
            const row = y + 0.5;
            let [left, right] = [Infinity, -Infinity];
            for (const end of [a, b]) {
                const off = row - end[1];
                if (Math.abs(off) > radius) continue;
                const half = Math.sqrt(radius * radius - off * off);
                left = Math.min(left, end[0] - half);
                right = Math.max(right, end[0] + half);
            }
            // The sides of what lies between the ends.
            for (const way of [-1, 1]) {
                const part = dy === 0 ? -1 : (row - a[1] - way * ny) / dy;
                if (part < 0 || part > 1) continue;
                const x = a[0] + way * nx + dx * part;
                left = Math.min(left, x);
                right = Math.max(right, x);
            }
            const last = Math.min(this.width - 1, Math.floor(right - 0.5));
            for (let x = Math.max(0, Math.ceil(left - 0.5)); x <= last; x++) {
                const along = squared > 0 ? Math.max(0, Math.min(1, ((x + 0.5 - a[0]) * dx + (row - a[1]) * dy) / squared)) : 0;
                const z = a[2] + (b[2] - a[2]) * along;
                const at = y * this.width + x;
                if (z > this.depth[at]!) continue;
                this.depth[at] = z;
                this.seen[at] = seen;
            }
        }
    }

    /** Areas below all else: they have no depth. */
    flat({ corners, colour }: Flat, { right, down, at }: Projection): void {
        const [ax, ay] = [at[0] - this.planes.left, at[1] - this.planes.top];
        const xs = new Float64Array(4);
        const ys = new Float64Array(4);
        for (let i = 0; i + 7 < corners.length; i += 8) {
            let [top, bottom] = [Infinity, -Infinity];
            for (let k = 0; k < 4; k++) {
                const [x, y] = [corners[i + 2 * k]!, corners[i + 2 * k + 1]!];
                xs[k] = right[0] * x + right[1] * y + ax;
                ys[k] = down[0] * x + down[1] * y + ay;
                top = Math.min(top, ys[k]!);
                bottom = Math.max(bottom, ys[k]!);
            }
            const last = Math.min(this.height - 1, Math.ceil(bottom - 0.5) - 1);
            for (let y = Math.max(0, Math.ceil(top - 0.5)); y <= last; y++) {
                const row = y + 0.5;
                let [from, to] = [Infinity, -Infinity];
                for (let k = 0; k < 4; k++) {
                    const next = (k + 1) & 3;
                    const [ya, yb] = [ys[k]!, ys[next]!];
                    if (ya <= row === yb <= row) continue;
                    const x = xs[k]! + ((xs[next]! - xs[k]!) * (row - ya)) / (yb - ya);
                    from = Math.min(from, x);
                    to = Math.max(to, x);
                }
                // Half open: of areas side by side each pixel is in one.
                const begin = Math.max(0, Math.ceil(from - 0.5));
                const end = Math.min(this.width, Math.ceil(to - 0.5));
                if (begin < end) this.seen.fill(colour, y * this.width + begin, y * this.width + end);
            }
        }
    }

    /** Of the steps, those that are between `low` and `high`. */
    private within(from: number, way: number, low: number, high: number, steps: number, [begin, end]: [number, number]): [number, number] {
        if (way === 0) return [begin, end];
        const [enter, leave] = way > 0 ? [low, high] : [high, low];
        return [
            Math.max(begin, Math.floor(((enter - from) / way) * steps)),
            Math.min(end, Math.ceil(((leave - from) / way) * steps)),
        ];
    }

    private dot(x: number, y: number, z: number, seen: number): void {
        if (x < 0 || y < 0 || x >= this.width || y >= this.height) return;
        const at = (y | 0) * this.width + (x | 0);
        if (z > this.depth[at]!) return;
        this.depth[at] = z;
        this.seen[at] = seen;
    }

    /** Flat faces. They are no move. */
    triangles({ corners, colour }: Triangles, projection: Projection): void {
        const { right, down, away, at } = projection;
        const colours = shaded({ corners, colour }, projection);
        for (let i = 0; i + 8 < corners.length; i += 9) {
            const points = [0, 3, 6].map((k): Vector => {
                const [x, y, z] = [corners[i + k]!, corners[i + k + 1]!, corners[i + k + 2]!];
                return [
                    right[0] * x + right[1] * y + right[2] * z + at[0] - this.planes.left,
                    down[0] * x + down[1] * y + down[2] * z + at[1] - this.planes.top,
                    away[0] * x + away[1] * y + away[2] * z + at[2],
                ];
            });
            this.face(points as [Vector, Vector, Vector], rgb(colours[i]! * 255, colours[i + 1]! * 255, colours[i + 2]! * 255));
        }
    }

    private face([a, b, c]: [Vector, Vector, Vector], colour: number): void {
        const area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (!(Math.abs(area) > 1e-9 && Math.abs(area) < FAR * FAR)) return;
        const low = Math.max(0, Math.floor(Math.min(a[1], b[1], c[1])));
        const high = Math.min(this.height - 1, Math.floor(Math.max(a[1], b[1], c[1])));
        const near = Math.max(0, Math.floor(Math.min(a[0], b[0], c[0])));
        const far = Math.min(this.width - 1, Math.floor(Math.max(a[0], b[0], c[0])));
        for (let y = low; y <= high; y++) {
            for (let x = near; x <= far; x++) {
                const [px, py] = [x + 0.5, y + 0.5];
                const u = ((b[0] - px) * (c[1] - py) - (b[1] - py) * (c[0] - px)) / area;
                const v = ((c[0] - px) * (a[1] - py) - (c[1] - py) * (a[0] - px)) / area;
                if (u < 0 || v < 0 || u + v > 1) continue;
                const z = u * a[2] + v * b[2] + (1 - u - v) * c[2];
                const at = y * this.width + x;
                if (z > this.depth[at]!) continue;
                this.depth[at] = z;
                this.seen[at] = this.planes.sees === "moves" ? 0 : colour;
            }
        }
    }
}

/** A colour as its four bytes are stored. */
export function rgb(red: number, green: number, blue: number): number {
    return ((255 << 24) | (Math.round(blue) << 16) | (Math.round(green) << 8) | Math.round(red)) >>> 0;
}

/** Colours of the corners, from 0 to 1: flat faces, lit from beside and above the eye, so that faces of a box differ. */
export function shaded({ corners, colour }: Triangles, { right, down, away }: Projection): Float32Array {
    const lamp = unit(along(along(away, right, 0.35), down, 0.55));
    const colours = new Float32Array(corners.length);
    for (let i = 0; i + 8 < corners.length; i += 9) {
        const edge = (k: number): Vector => [corners[i + k]! - corners[i]!, corners[i + k + 1]! - corners[i + 1]!, corners[i + k + 2]! - corners[i + 2]!];
        const normal = unit(cross(edge(3), edge(6)));
        const light = 0.35 + 0.65 * Math.abs(dot(normal, lamp));
        for (let k = 0; k < 9; k++) colours[i + k] = Math.min(1, (colour[k % 3]! * light) / 255);
    }
    return colours;
}
