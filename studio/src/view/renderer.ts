import type { Projection, Size } from "./camera.ts";
import type { Theme } from "./colours.ts";
import { Raster, rgb } from "./raster.ts";
import type { Picture } from "./scene.ts";

/** Draws pictures on a canvas of its own. */
export interface Renderer {
    readonly canvas: HTMLCanvasElement;
    draw(picture: Picture, projection: Projection, size: Size, theme: Theme): void;
}

/** The renderer that needs nothing of the computer but its processor. */
export class Plain implements Renderer {
    readonly canvas = document.createElement("canvas");
    private readonly context = this.canvas.getContext("2d", { alpha: false })!;
    private raster = new Raster(1, 1);

    draw({ strips, bodies }: Picture, projection: Projection, { width, height }: Size, { paper }: Theme): void {
        if (this.raster.width !== width || this.raster.height !== height) {
            this.raster = new Raster(width, height);
            this.canvas.width = width;
            this.canvas.height = height;
        }
        const { raster } = this;
        raster.clear(rgb(...paper));
        for (const strip of strips) raster.strip(strip, projection);
        for (const body of bodies) raster.triangles(body, projection);
        const octets = new Uint8ClampedArray(raster.seen.buffer);
        this.context.putImageData(new ImageData(octets, width, height), 0, 0);
    }
}
