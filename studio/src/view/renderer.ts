import type { Flat } from "./board.ts";
import type { Projection, Size } from "./camera.ts";
import type { Theme } from "./colours.ts";
import { Raster, rgb } from "./raster.ts";
import type { Picture } from "./scene.ts";
import type { Paint, Strip, Triangles } from "./strip.ts";

/** Draws pictures on a canvas of its own. */
export interface Renderer {
    readonly canvas: HTMLCanvasElement;
    draw(picture: Picture, projection: Projection, size: Size, theme: Theme): void;
}

/** Pictures by the rasteriser. While only what lies over the lines changes, the lines are not drawn again. */
export class Painting {
    private readonly raster: Raster;
    private lines: { flats: Flat[]; surfaces: Triangles[]; strips: Strip[]; projection: Projection; paper: number; seen: Uint32Array; depth: Float32Array } | null = null;

    constructor(
        readonly width: number,
        readonly height: number,
    ) {
        this.raster = new Raster(width, height);
    }

    /** The colours of all pixels. */
    draw({ flats, surfaces, strips, over, bodies }: Omit<Picture, "symbols">, projection: Projection, paper: number): Uint32Array<ArrayBuffer> {
        const { raster, lines } = this;
        if (lines !== null && lines.paper === paper && areAlike(lines.flats, flats) && areAlike(lines.surfaces, surfaces) && isSame(lines.projection, projection) && areSame(lines.strips, strips)) {
            raster.seen.set(lines.seen);
            raster.depth.set(lines.depth);
        } else {
            raster.clear(paper);
            for (const flat of flats) raster.flat(flat, projection);
            for (const surface of surfaces) raster.triangles(surface, projection);
            for (const strip of strips) raster.strip(strip, projection);
            const { seen, depth } = lines ?? { seen: raster.seen.slice(), depth: raster.depth.slice() };
            seen.set(raster.seen);
            depth.set(raster.depth);
            this.lines = { flats, surfaces, strips, projection, paper, seen, depth };
        }
        for (const strip of over) raster.strip(strip, projection);
        for (const body of bodies) raster.triangles(body, projection);
        return raster.seen;
    }
}

const areAlike = <T>(a: T[], b: T[]): boolean => a.length === b.length && a.every((one, i) => one === b[i]);

const areSame = (a: Strip[], b: Strip[]): boolean =>
    a.length === b.length && a.every(({ vertices, from, to, paint }, i) => {
        const other = b[i]!;
        return vertices === other.vertices && from === other.from && to === other.to && (paint === other.paint || isAlike(paint, other.paint));
    });

const isAlike = (a: Paint, b: Paint): boolean => (Object.keys(a) as (keyof Paint)[]).every((key) => a[key] === b[key]);

const isSame = (a: Projection, b: Projection): boolean =>
    ([a.right, a.down, a.away, a.at] as const).every((way, i) => way.every((part, k) => part === [b.right, b.down, b.away, b.at][i]![k]));

/** The renderer that needs nothing of the computer but its processor. */
export class Plain implements Renderer {
    readonly canvas = document.createElement("canvas");
    private readonly context = this.canvas.getContext("2d", { alpha: false })!;
    private painting = new Painting(1, 1);

    draw(picture: Picture, projection: Projection, { width, height }: Size, { paper }: Theme): void {
        if (this.painting.width !== width || this.painting.height !== height) {
            this.painting = new Painting(width, height);
            this.canvas.width = width;
            this.canvas.height = height;
        }
        const octets = new Uint8ClampedArray(this.painting.draw(picture, projection, rgb(...paper)).buffer);
        this.context.putImageData(new ImageData(octets, width, height), 0, 0);
    }
}
