/** `npm run speed`: frames of 1280 x 720 by the rasteriser, of spirals all over the picture. */

import { bench } from "vitest";
import { project } from "../src/view/camera.ts";
import { Raster } from "../src/view/raster.ts";
import { wordOf, type Strip } from "../src/view/strip.ts";

const size = { width: 1280, height: 720 };
const raster = new Raster(size.width, size.height);
const paint = {
    palette: new Uint32Array(256).fill(0xff0000ff),
    byMove: null,
    shift: 12,
    mask: 15,
    styles: new Uint8Array(16),
    dashed: -1,
    width: 1,
    tool: -1,
    round: false,
    lift: 0,
};

function strips(segments: number): Strip[] {
    return Array.from({ length: Math.ceil(segments / 4096) }, (_, chunk) => {
        const vertices = new ArrayBuffer(4097 * 16);
        const numbers = new Float32Array(vertices);
        const words = new Uint32Array(vertices);
        for (let i = 0; i <= 4096; i++) {
            const angle = (chunk * 4096 + i) * 0.05;
            const radius = 5 + ((chunk * 4096 + i) / segments) * 45;
            numbers.set([Math.cos(angle) * radius, Math.sin(angle) * radius, Math.sin(angle * 3) * 5], i * 4);
            words[i * 4 + 3] = wordOf(i & 4095, 1, 0);
        }
        return { vertices, origin: [0, 0, 0], first: chunk * 4096, from: 1, to: 4097, paint };
    });
}

let turn = 0;
for (const segments of [200_000, 1_000_000, 5_000_000]) {
    const all = strips(segments);
    bench(`${segments.toLocaleString("en")} segments`, () => {
        turn += 7;
        raster.clear(0);
        const projection = project({ turn, height: 35, middle: [0, 0, 0], scale: 6 }, size);
        for (const strip of all) raster.strip(strip, projection);
    }, { time: 2000 });
}
