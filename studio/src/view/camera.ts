/** A parallel projection, Z up: where one looks from, what is in the middle, and pixels a millimetre. */

import { along, between, cross, dot, times, unit, type Vector } from "./vector.ts";

export interface Box {
    low: Vector;
    high: Vector;
}

export interface Camera {
    /** Round Z, degrees: 0 looks along +Y, from the front. */
    turn: number;
    /** Above the table, degrees: 90 looks down. */
    height: number;
    middle: Vector;
    /** Pixels a millimetre. */
    scale: number;
}

export interface Size {
    width: number;
    height: number;
}

/** Pixels right, down and away: `x = right . p + at[0]`, and so on; near is less. */
export interface Projection {
    right: Vector;
    down: Vector;
    away: Vector;
    at: Vector;
    scale: number;
}

/** The keys 1 to 6. */
export const VIEWS: { name: string; turn: number; height: number }[] = [
    { name: "Top", turn: 0, height: 90 },
    { name: "Front", turn: 0, height: 0 },
    { name: "Right", turn: 90, height: 0 },
    { name: "Back", turn: 180, height: 0 },
    { name: "Left", turn: -90, height: 0 },
    { name: "Isometric", turn: -45, height: 35.264 },
];

const radians = Math.PI / 180;

/** Right, up and away as unit vectors. */
export function axes({ turn, height }: Pick<Camera, "turn" | "height">): { right: Vector; up: Vector; away: Vector } {
    const [c, s] = [Math.cos(turn * radians), Math.sin(turn * radians)];
    const [ch, sh] = [Math.cos(height * radians), Math.sin(height * radians)];
    const right: Vector = [c, s, 0];
    const away: Vector = [-s * ch, c * ch, -sh];
    return { right, away, up: cross(right, away) };
}

export function project(camera: Camera, { width, height }: Size): Projection {
    const { right, up, away } = axes(camera);
    const { scale, middle } = camera;
    const projection = { right: times(right, scale), down: times(up, -scale), away: times(away, scale), scale };
    return {
        ...projection,
        at: [width / 2 - dot(projection.right, middle), height / 2 - dot(projection.down, middle), -dot(projection.away, middle)],
    };
}

export function toScreen({ right, down, away, at }: Projection, point: Vector): Vector {
    return [dot(right, point) + at[0], dot(down, point) + at[1], dot(away, point) + at[2]];
}

export function orbit(camera: Camera, dx: number, dy: number): Camera {
    const height = Math.max(-90, Math.min(90, camera.height + dy * 0.4));
    return { ...camera, turn: ((((camera.turn - dx * 0.4 + 180) % 360) + 360) % 360) - 180, height };
}

export function pan(camera: Camera, dx: number, dy: number): Camera {
    const { right, up } = axes(camera);
    const middle = along(along(camera.middle, right, -dx / camera.scale), up, dy / camera.scale);
    return { ...camera, middle };
}

/** What is under the pixel stays there. */
export function zoom(camera: Camera, by: number, x: number, y: number, { width, height }: Size): Camera {
    const scale = Math.max(1e-4, Math.min(1e5, camera.scale * by));
    const { right, up } = axes(camera);
    const millimetres = 1 / camera.scale - 1 / scale;
    const middle = along(
        along(camera.middle, right, (x - width / 2) * millimetres),
        up,
        (height / 2 - y) * millimetres,
    );
    return { ...camera, scale, middle };
}

const corners = ({ low, high }: Box): Vector[] =>
    [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => [
        bits & 1 ? high[0] : low[0],
        bits & 2 ? high[1] : low[1],
        bits & 4 ? high[2] : low[2],
    ]);

/** All of the box, with a margin. */
export function fit(camera: Camera, box: Box, { width, height }: Size): Camera {
    const { right, up } = axes(camera);
    const spread = (way: Vector): number => {
        const places = corners(box).map((corner) => dot(way, corner));
        return Math.max(...places) - Math.min(...places);
    };
    const scale = 0.9 * Math.min(width / Math.max(spread(right), 1e-3), height / Math.max(spread(up), 1e-3));
    const middle = along(box.low, between(box.low, box.high), 0.5);
    return { ...camera, middle, scale: Math.max(1e-4, Math.min(1e4, scale)) };
}

/** The rectangle of pixels fills the window. */
export function zoomTo(camera: Camera, from: [number, number], to: [number, number], size: Size): Camera {
    const [w, h] = [Math.abs(to[0] - from[0]), Math.abs(to[1] - from[1])];
    if (w < 4 || h < 4) return camera;
    const moved = pan(camera, size.width / 2 - (from[0] + to[0]) / 2, size.height / 2 - (from[1] + to[1]) / 2);
    return { ...moved, scale: Math.min(1e5, camera.scale * Math.min(size.width / w, size.height / h)) };
}

/** Looks along the tool, from its shank to its tip. */
export function alongTool(camera: Camera, axis: Vector): Camera {
    const [x, y, z] = unit(axis);
    const height = Math.asin(Math.max(-1, Math.min(1, z))) / radians;
    return { ...camera, height, turn: Math.hypot(x, y) < 1e-9 ? 0 : Math.atan2(x, -y) / radians };
}

/** Whether two projections put everything at the same place. */
export const isSame = (a: Projection, b: Projection): boolean =>
    ([a.right, a.down, a.away, a.at] as const).every((way, i) => way.every((part, k) => part === [b.right, b.down, b.away, b.at][i]![k]));
