/** How a machine's axes carry its bodies, its tool and its part. The core gives the links; here they are only multiplied. */

import type { Linkage } from "../protocol/types.ts";
import type { Triangles } from "./strip.ts";
import { along, cross, dot, type Vector } from "./vector.ts";

type Link = Linkage["links"][number];

/** A frame in a link, column by column. */
type Seat = Linkage["tool"];

/** Columns X, Y, Z and origin, one after the other. */
export type Matrix = number[];

const IDENTITY: Matrix = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];

const column = (matrix: Matrix, i: number): Vector => [matrix[i * 3]!, matrix[i * 3 + 1]!, matrix[i * 3 + 2]!];

/** Where a point of the frame is. */
export function apply(matrix: Matrix, [x, y, z]: Vector): Vector {
    return along(along(along(column(matrix, 3), column(matrix, 0), x), column(matrix, 1), y), column(matrix, 2), z);
}

const turned = (matrix: Matrix, way: Vector): Vector => along(along(along([0, 0, 0], column(matrix, 0), way[0]), column(matrix, 1), way[1]), column(matrix, 2), way[2]);

export function times(a: Matrix, b: Matrix): Matrix {
    return [...[0, 1, 2].flatMap((i) => turned(a, column(b, i))), ...apply(a, column(b, 3))];
}

/** Of a frame whose columns are at right angles. */
export function inverse(matrix: Matrix): Matrix {
    const [x, y, z, origin] = [0, 1, 2, 3].map((i) => column(matrix, i)) as [Vector, Vector, Vector, Vector];
    const rows = [0, 1, 2].flatMap((i) => [x[i]!, y[i]!, z[i]!]);
    return [...rows, -dot(x, origin), -dot(y, origin), -dot(z, origin)];
}

/** A right-handed turn about the line through `point`. */
function turn(direction: Vector, point: Vector, degrees: number): Matrix {
    const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
    const rotate = (way: Vector): Vector => {
        const across = cross(direction, way);
        const part = dot(direction, way) * (1 - c);
        return [0, 1, 2].map((i) => way[i]! * c + across[i]! * s + direction[i]! * part) as Vector;
    };
    return [...rotate([1, 0, 0]), ...rotate([0, 1, 0]), ...rotate([0, 0, 1]), ...along(point, rotate(point), -1)];
}

function own({ kind, direction, point, zero, terms }: Link, axes: number[]): Matrix {
    const amount = terms.reduce((sum, [axis, factor]) => sum + factor * axes[axis]!, zero);
    if (kind === "slide") return [...IDENTITY.slice(0, 9), ...along([0, 0, 0], direction, amount)];
    return kind === "turn" ? turn(direction, point, amount) : IDENTITY;
}

/** Where each link is. Links stand on links before them. */
export function place({ links }: Pick<Linkage, "links">, axes: number[]): Matrix[] {
    const placed: Matrix[] = [];
    for (const link of links) placed.push(times(link.on === null ? IDENTITY : placed[link.on]!, own(link, axes)));
    return placed;
}

const seat = ({ on, frame }: Seat, placed: Matrix[]): Matrix => times(placed[on]!, frame.flat());

/** The tip of a tool in the frame of the part. */
export function tipOf({ tool, part }: Pick<Linkage, "tool" | "part">, placed: Matrix[], length: number): Vector {
    return apply(inverse(seat(part, placed)), apply(seat(tool, placed), [0, 0, -length]));
}

const FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]] as const;

/**
 * The bodies as boxes in the frame of the part. The axes of a mill may count from another zero than the machine's: `tool` then moves
 * what carries the tool so that it stands at its tip.
 */
export function bodiesOf(linkage: Linkage, axes: number[], tool: { tip: Vector; length: number } | null): Triangles[] {
    const placed = place(linkage, axes);
    const home = place(linkage, axes.map(() => 0));
    const work = inverse(seat(linkage.part, placed));
    const off: Vector = tool === null ? [0, 0, 0] : along(tool.tip, tipOf(linkage, placed, tool.length), -1);
    const carriers = carriersOf(linkage, linkage.part.on);
    return linkage.bodies.map(({ on, low, high }) => {
        const matrix = times(work, times(placed[on]!, inverse(home[on]!)));
        const shift: Vector = carriers.has(on) ? [0, 0, 0] : off;
        const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => {
            const corner: Vector = [bits & 1 ? high[0] : low[0], bits & 2 ? high[1] : low[1], bits & 4 ? high[2] : low[2]];
            return along(apply(matrix, corner), shift, 1);
        });
        const triangles = FACES.flatMap(([a, b, c, d]) => [a, b, c, a, c, d].flatMap((corner) => corners[corner]!));
        return { corners: Float32Array.from(triangles), colour: carriers.has(on) ? [120, 150, 170] : [150, 150, 150] };
    });
}

/** A link and all that it stands on. */
function carriersOf({ links }: Linkage, link: number): Set<number> {
    const carriers = new Set<number>();
    for (let at: number | null = link; at !== null; at = links[at]!.on) carriers.add(at);
    return carriers;
}
