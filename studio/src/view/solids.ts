/** Triangles of the tool and of boxes. */

import type { ToolUse } from "../protocol/asks.ts";
import type { Triangles } from "./strip.ts";
import { along, cross, unit, type Vector } from "./vector.ts";

const SIDES = 16;

/** A solid of revolution: radii and heights above the tip, from below to above. */
function turned(tip: Vector, axis: Vector, outline: [radius: number, height: number][], colour: Triangles["colour"]): Triangles {
    const away = unit(axis);
    const u = unit(cross(away, Math.abs(away[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    const v = cross(away, u);
    const point = ([radius, height]: [number, number], side: number): Vector => {
        const angle = (side / SIDES) * 2 * Math.PI;
        return along(along(along(tip, away, height), u, radius * Math.cos(angle)), v, radius * Math.sin(angle));
    };
    const corners: number[] = [];
    for (let ring = 0; ring + 1 < outline.length; ring++) {
        for (let side = 0; side < SIDES; side++) {
            const [a, b] = [point(outline[ring]!, side), point(outline[ring]!, side + 1)];
            const [c, d] = [point(outline[ring + 1]!, side), point(outline[ring + 1]!, side + 1)];
            corners.push(...a, ...b, ...d, ...a, ...d, ...c);
        }
    }
    return { corners: Float32Array.from(corners), colour };
}

/** How long the tool is drawn: a pointer of `size` mm where nothing of it is known. */
export function lengthOf(tool: ToolUse | null, size: number): number {
    const length = tool?.length ?? 0;
    if (length > 0) return length;
    const diameter = tool?.diameter ?? 0;
    return diameter > 0 ? diameter * 2 : size;
}

/** The tool at its tip: its own shape where it is known, else a pointer of `size` mm. */
export function toolBody(tool: ToolUse | null, tip: Vector, axis: Vector, size: number): Triangles {
    const radius = (tool?.diameter ?? 0) / 2;
    const length = lengthOf(tool, size);
    if (radius <= 0) return turned(tip, axis, [[0, 0], [size / 6, size / 2], [size / 6, length]], [230, 120, 0]);
    const corner = Math.min(tool?.corner ?? 0, radius);
    const rounded = [0, 1, 2, 3, 4, 5, 6].map((i): [number, number] => {
        const angle = (i / 6) * (Math.PI / 2);
        return [radius - corner + corner * Math.sin(angle), corner - corner * Math.cos(angle)];
    });
    return turned(tip, axis, [[0, 0], ...rounded, [radius, length], [0, length]], [200, 170, 60]);
}

/** A wire from its lower end to a plane `height` mm above it. */
export function wireBody(low: Vector, axis: Vector, height: number, radius: number): Triangles {
    const length = height / axis[2];
    return turned(low, axis, [[0, 0], [radius, 0], [radius, length], [0, length]], [230, 120, 0]);
}
