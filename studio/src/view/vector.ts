export type Vector = [number, number, number];

export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export const cross = (a: Vector, b: Vector): Vector => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];

export const along = (from: Vector, way: Vector, by: number): Vector => [
    from[0] + way[0] * by,
    from[1] + way[1] * by,
    from[2] + way[2] * by,
];

export const between = (a: Vector, b: Vector): Vector => [b[0] - a[0], b[1] - a[1], b[2] - a[2]];

export function unit(a: Vector): Vector {
    const length = Math.hypot(...a);
    return length > 0 ? [a[0] / length, a[1] / length, a[2] / length] : [0, 0, 1];
}

export const times = (way: Vector, by: number): Vector => [way[0] * by, way[1] * by, way[2] * by];
