import type { Flat } from "./board.ts";
import { isSame, type Projection, type Size } from "./camera.ts";
import type { Theme } from "./colours.ts";
import { Raster, rgb } from "./raster.ts";
import type { Picture } from "./scene.ts";
import type { Paint, Strip, Triangles } from "./strip.ts";

/** Draws pictures on a canvas of its own. */
export interface Renderer {
    readonly canvas: HTMLCanvasElement;
    /** `isMoving`: the next picture follows at once, and this one may lack some of the pixels of its lines. */
    draw(picture: Picture, projection: Projection, size: Size, theme: Theme, isMoving: boolean): void;
}

/** What a picture that moves has of lines: of more, which then lie close together, some are left out. */
const MOVING = { lines: 400e3, pixels: 3e6 };

/**
 * Pictures by the rasteriser. While only what lies over the lines changes, the lines are not drawn again. While the picture moves,
 * long lines may be drawn as dots, and of short ones some, so that no picture takes longer the more there is in it: what is drawn is
 * where it is, and nothing that is large is left out.
 */
export class Painting {
    private readonly raster: Raster;
    private lines: { flats: Flat[]; surfaces: Triangles[]; strips: Strip[]; projection: Projection; paper: number; stride: number; seen: Uint32Array; depth: Float32Array } | null = null;
    /** Pixels that the lines went through in the last picture. */
    private gone = 0;

    constructor(
        readonly width: number,
        readonly height: number,
    ) {
        this.raster = new Raster(width, height);
    }

    /** The colours of all pixels. */
    draw({ flats, surfaces, strips, over, bodies }: Omit<Picture, "symbols" | "off">, projection: Projection, paper: number, isMoving = false): Uint32Array<ArrayBuffer> {
        const { raster, lines } = this;
        const stride = isMoving ? this.strideFor(strips) : 1;
        if (lines !== null && (isMoving || lines.stride === 1) && lines.paper === paper && areAlike(lines.flats, flats) && areAlike(lines.surfaces, surfaces) && isSame(lines.projection, projection) && areSame(lines.strips, strips)) {
            raster.seen.set(lines.seen);
            raster.depth.set(lines.depth);
        } else {
            raster.clear(paper);
            for (const flat of flats) raster.flat(flat, projection);
            for (const surface of surfaces) raster.triangles(surface, projection);
            raster.stride = stride;
            for (const strip of strips) raster.strip(strip, projection);
            raster.stride = 1;
            this.gone = raster.gone;
            const { seen, depth } = lines ?? { seen: raster.seen.slice(), depth: raster.depth.slice() };
            seen.set(raster.seen);
            depth.set(raster.depth);
            this.lines = { flats, surfaces, strips, projection, paper, stride, seen, depth };
        }
        for (const strip of over) raster.strip(strip, projection);
        for (const body of bodies) raster.triangles(body, projection);
        return raster.seen;
    }

    private strideFor(strips: Strip[]): number {
        const count = strips.reduce((sum, { from, to }) => sum + to - from, 0);
        return Math.max(1, Math.ceil(Math.max(count / MOVING.lines, this.gone / MOVING.pixels)));
    }
}

const areAlike = <T>(a: T[], b: T[]): boolean => a.length === b.length && a.every((one, i) => one === b[i]);

const areSame = (a: Strip[], b: Strip[]): boolean =>
    a.length === b.length && a.every(({ vertices, from, to, paint }, i) => {
        const other = b[i]!;
        return vertices === other.vertices && from === other.from && to === other.to && (paint === other.paint || isAlike(paint, other.paint));
    });

const isAlike = (a: Paint, b: Paint): boolean => (Object.keys(a) as (keyof Paint)[]).every((key) => a[key] === b[key]);

/** The renderer that needs nothing of the computer but its processor. */
export class Plain implements Renderer {
    readonly canvas = document.createElement("canvas");
    private readonly context = this.canvas.getContext("2d", { alpha: false })!;
    private painting = new Painting(1, 1);

    draw(picture: Picture, projection: Projection, { width, height }: Size, { paper }: Theme, isMoving: boolean): void {
        if (this.painting.width !== width || this.painting.height !== height) {
            this.painting = new Painting(width, height);
            this.canvas.width = width;
            this.canvas.height = height;
        }
        const octets = new Uint8ClampedArray(this.painting.draw(picture, projection, rgb(...paper), isMoving).buffer);
        this.context.putImageData(new ImageData(octets, width, height), 0, 0);
    }
}
