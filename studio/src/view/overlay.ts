/** What lies over the picture: the axes, the box with its lengths, ruler and selection. Drawn by the browser. */

import { toScreen, type Box, type Projection, type Size } from "./camera.ts";
import type { Theme } from "./colours.ts";
import { Mark, type Symbol } from "./symbols.ts";
import type { Vector } from "./vector.ts";

export interface Over {
    box: Box | null;
    /** Two pixels: a rectangle to zoom to, or what is measured. */
    drag: { kind: "zoom" | "ruler"; from: [number, number]; to: [number, number] } | null;
    symbols: Symbol[];
    /** The tool's axis at the tip. */
    tip: { at: Vector; axis: Vector } | null;
}

export function overlay(context: CanvasRenderingContext2D, over: Over, projection: Projection, size: Size, theme: Theme, ratio: number): void {
    context.clearRect(0, 0, size.width, size.height);
    context.font = `${12 * ratio}px system-ui, sans-serif`;
    context.lineWidth = ratio;
    if (over.box !== null) lengths(context, over.box, projection, theme);
    triad(context, projection, size, theme, ratio);
    for (const symbol of over.symbols) shape(context, symbol, theme, ratio);
    if (over.tip !== null) cross(context, toScreen(projection, over.tip.at), theme, ratio);
    if (over.drag !== null) dragged(context, over.drag, projection, theme);
}

const line = (context: CanvasRenderingContext2D, from: number[], to: number[]): void => {
    context.beginPath();
    context.moveTo(from[0]!, from[1]!);
    context.lineTo(to[0]!, to[1]!);
    context.stroke();
};

const AXES: [string, Vector, string][] = [
    ["X", [1, 0, 0], "#d9480f"],
    ["Y", [0, 1, 0], "#2b8a3e"],
    ["Z", [0, 0, 1], "#1c7ed6"],
];

/** The directions of X, Y and Z in the corner. */
function triad(context: CanvasRenderingContext2D, { right, down, scale }: Projection, { height }: Size, theme: Theme, ratio: number): void {
    const at = [44 * ratio, height - 44 * ratio];
    for (const [name, [x, y, z], colour] of AXES) {
        const reach = (28 * ratio) / scale;
        const to = [
            at[0]! + (right[0] * x + right[1] * y + right[2] * z) * reach,
            at[1]! + (down[0] * x + down[1] * y + down[2] * z) * reach,
        ];
        context.strokeStyle = colour;
        line(context, at, to);
        context.fillStyle = theme.ink;
        context.fillText(name, to[0]! + 3 * ratio, to[1]! - 3 * ratio);
    }
}

const millimetres = (length: number): string => `${length.toFixed(length < 10 ? 3 : 1)} mm`;

/** The box of all moves, with the lengths of its three edges. */
function lengths(context: CanvasRenderingContext2D, { low, high }: Box, projection: Projection, theme: Theme): void {
    const corner = (bits: number): Vector => [bits & 1 ? high[0] : low[0], bits & 2 ? high[1] : low[1], bits & 4 ? high[2] : low[2]];
    context.strokeStyle = theme.soft;
    context.globalAlpha = 0.5;
    for (const bit of [1, 2, 4]) {
        for (const from of [0, 1, 2, 3, 4, 5, 6, 7]) {
            if ((from & bit) === 0) line(context, toScreen(projection, corner(from)), toScreen(projection, corner(from | bit)));
        }
    }
    context.globalAlpha = 1;
    context.fillStyle = theme.soft;
    [1, 2, 4].forEach((bit, axis) => {
        const [a, b] = [toScreen(projection, corner(0)), toScreen(projection, corner(bit))];
        if (Math.hypot(a[0] - b[0], a[1] - b[1]) > 60) context.fillText(millimetres(high[axis]! - low[axis]!), (a[0] + b[0]) / 2, (a[1] + b[1]) / 2 + 14);
    });
}

/** A cross for findings, a triangle for excursions, a diamond where the radius compensation changes. */
function shape(context: CanvasRenderingContext2D, { x, y, marks }: Symbol, theme: Theme, ratio: number): void {
    const r = 5 * ratio;
    context.strokeStyle = marks & Mark.finding ? theme.bad : marks & Mark.excursion ? theme.warn : theme.ink;
    context.lineWidth = 2 * ratio;
    if (marks & Mark.finding) {
        line(context, [x - r, y - r], [x + r, y + r]);
        line(context, [x - r, y + r], [x + r, y - r]);
    } else {
        const corners = marks & Mark.excursion ? [[0, -r], [r, r], [-r, r]] : [[0, -r], [r, 0], [0, r], [-r, 0]];
        context.beginPath();
        for (const [dx, dy] of corners) context.lineTo(x + dx!, y + dy!);
        context.closePath();
        context.stroke();
    }
    context.lineWidth = ratio;
}

function cross(context: CanvasRenderingContext2D, [x, y]: Vector, theme: Theme, ratio: number): void {
    context.strokeStyle = theme.ink;
    context.beginPath();
    context.arc(x, y, 6 * ratio, 0, 2 * Math.PI);
    context.stroke();
    line(context, [x - 10 * ratio, y], [x + 10 * ratio, y]);
    line(context, [x, y - 10 * ratio], [x, y + 10 * ratio]);
}

function dragged(context: CanvasRenderingContext2D, { kind, from, to }: NonNullable<Over["drag"]>, { scale }: Projection, theme: Theme): void {
    context.strokeStyle = theme.ink;
    context.fillStyle = theme.ink;
    if (kind === "zoom") {
        context.strokeRect(from[0], from[1], to[0] - from[0], to[1] - from[1]);
        return;
    }
    line(context, from, to);
    const [dx, dy] = [(to[0] - from[0]) / scale, (to[1] - from[1]) / scale];
    context.fillText(`${millimetres(Math.hypot(dx, dy))} (${millimetres(Math.abs(dx))} across, ${millimetres(Math.abs(dy))} up)`, to[0] + 10, to[1] - 6);
}
