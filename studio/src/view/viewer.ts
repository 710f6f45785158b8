/** One view: its camera, what the pointer does in it, and when it is drawn. */

import { fit, orbit, pan, project, VIEWS, zoom, zoomTo, alongTool, type Box, type Camera, type Projection, type Size } from "./camera.ts";
import { overlay, type Over } from "./overlay.ts";
import { Plain, type Renderer } from "./renderer.ts";
import type { Looks, Marks, Scene } from "./scene.ts";
import { Sights } from "./sight.ts";
import type { Vector } from "./vector.ts";
import { Gl } from "./webgl.ts";

export interface Shown {
    scene: Scene | null;
    looks: Looks;
    marks: Marks;
    tip: Over["tip"];
    box: Box | null;
    isBoxShown: boolean;
}

/** What a view can be fitted to: what is cut, all that is there, or the machine round it. */
export type Whole = "cuts" | "all" | "machine";

/** `auto`: by the graphics processor where there is one that is not played by the processor. */
export type Drawing = "auto" | "plain" | "webgl";

interface Drag {
    kind: "orbit" | "pan" | "zoom" | "ruler";
    from: [number, number];
    last: [number, number];
    moved: boolean;
    /** The move where the button was pressed: looked for before it is known whether this is a click. */
    picked: Promise<number | null>;
}

/** How long the pointer rests before what is under it is fetched, ms. */
const REST = 40;

/** How long after its last move a view is drawn with all its pixels, ms. */
const STILL = 150;

/** What a view tells. */
export interface Tell {
    picked(move: number): void;
    pointed(at: Vector | null): void;
    /** The lines of the picture may be so many pixels off. */
    off(pixels: number): void;
    /** A picture with lines is drawn. */
    drawn(): void;
}

export class Viewer {
    camera: Camera;
    /** Dragging measures. */
    ruler = false;
    private renderer: Renderer;
    private readonly over = document.createElement("canvas");
    private readonly context = this.over.getContext("2d")!;
    /** Whether there is a graphics processor is looked for behind the first picture. */
    private isSought: boolean;
    private drag: Drag | null = null;
    private measured: Over["drag"] = null;
    private readonly sights = new Sights(() => this.redraw());
    private frame = 0;
    /** The browser's first frame may be long in coming: a picture does not wait for it. */
    private hadFrame = false;
    private resting: ReturnType<typeof setTimeout> | undefined;
    /** While the view moves. */
    private moving: ReturnType<typeof setTimeout> | undefined;
    /** What is shown as a whole, also when the window changes; null when somebody has moved or zoomed. */
    private fitted: Whole | null = "cuts";
    /** How it was before the machine was shown as a whole. */
    private before: { camera: Camera; fitted: Whole | null } | null = null;
    private readonly sizes = new ResizeObserver(() => this.refit(false));

    constructor(
        readonly host: HTMLElement,
        view: number,
        private readonly shown: () => Shown,
        private readonly boxOf: (what: Whole) => Box | null,
        private readonly tell: Tell,
        how: Drawing,
    ) {
        this.camera = { ...VIEWS[view]!, middle: [0, 0, 0], scale: 1 };
        // A graphics processor takes its time to be found: the first picture does not wait for it.
        this.renderer = how === "auto" ? new Plain() : this.rendererFor(how);
        this.isSought = how === "auto";
        host.append(this.renderer.canvas, this.over);
        this.sizes.observe(host);
        requestAnimationFrame(() => (this.hadFrame = true));
        host.addEventListener("pointerdown", (event) => this.down(event));
        host.addEventListener("pointermove", (event) => this.move(event));
        host.addEventListener("pointerup", (event) => this.up(event));
        host.addEventListener("pointerleave", () => tell.pointed(null));
        host.addEventListener("contextmenu", (event) => event.preventDefault());
        host.addEventListener("dblclick", () => this.fitTo("cuts"));
        host.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    }

    /** Without WebGL, and where it is lost, by the rasteriser. */
    private rendererFor(how: Drawing): Renderer {
        return (how === "plain" ? null : this.webgl(how === "webgl")) ?? new Plain();
    }

    private webgl(evenSlow: boolean): Renderer | null {
        try {
            return new Gl(() => this.drawBy("plain"), { evenSlow });
        } catch {
            return null;
        }
    }

    private seek(): void {
        if (!this.isSought) return;
        this.isSought = false;
        const found = this.webgl(false);
        if (found !== null) this.draws(found);
    }

    drawBy(how: Drawing): void {
        this.isSought = false;
        this.draws(this.rendererFor(how));
    }

    private draws(renderer: Renderer): void {
        this.renderer.canvas.remove();
        this.renderer = renderer;
        this.host.prepend(this.renderer.canvas);
        this.redraw();
    }

    close(): void {
        this.isSought = false;
        clearTimeout(this.resting);
        clearTimeout(this.moving);
        cancelAnimationFrame(this.frame);
        this.frame = 0;
        this.sizes.disconnect();
        this.sights.forget();
        this.host.replaceChildren();
    }

    private get ratio(): number {
        return Math.min(2, devicePixelRatio);
    }

    private get size(): Size {
        const { clientWidth, clientHeight } = this.host;
        return { width: Math.max(1, Math.round(clientWidth * this.ratio)), height: Math.max(1, Math.round(clientHeight * this.ratio)) };
    }

    private get projection(): Projection {
        return project(this.camera, this.size);
    }

    /** Reads all that a picture depends on, so that an effect runs again when it changes, and draws. */
    touch(): void {
        this.shown();
        this.redraw();
    }

    redraw(): void {
        if (this.frame === 0) {
            this.frame = requestAnimationFrame(() => this.drawNow());
            if (!this.hadFrame) setTimeout(() => this.drawNow());
        }
    }

    private drawNow(): void {
        if (this.frame === 0) return;
        cancelAnimationFrame(this.frame);
        this.frame = 0;
        this.draw();
    }

    private draw(): void {
        const { size, projection } = this;
        const { scene, looks, marks, tip, box, isBoxShown } = this.shown();
        scene?.chunks.begin();
        const picture = scene?.picture(projection, size, looks, marks, this.sights) ?? { off: 0, flats: [], surfaces: [], strips: [], over: [], bodies: [], symbols: [] };
        this.renderer.draw(picture, projection, size, looks.theme, this.moving !== undefined);
        if (this.over.width !== size.width || this.over.height !== size.height) Object.assign(this.over, size);
        if (scene !== null) this.tell.off(picture.off / this.ratio);
        if (picture.strips.length > 0) {
            this.tell.drawn();
            if (this.isSought) setTimeout(() => this.seek());
        }
        overlay(this.context, { box: isBoxShown ? box : null, tip, symbols: picture.symbols, drag: this.measured }, projection, size, looks.theme, this.ratio);
    }

    look(camera: Camera): void {
        this.camera = camera;
        this.fitted = null;
        this.redraw();
    }

    /** As `look`, and the next picture is likely to follow at once. */
    private go(camera: Camera): void {
        clearTimeout(this.moving);
        this.moving = setTimeout(() => {
            this.moving = undefined;
            this.redraw();
        }, STILL);
        this.look(camera);
    }

    /** What is cut; a second time, all that is there. */
    fit(): void {
        this.fitTo(this.fitted === "cuts" ? "all" : "cuts");
    }

    private fitTo(what: Whole): void {
        const box = this.boxOf(what);
        if (box === null) return;
        this.look(fit(this.camera, box, this.size));
        this.fitted = what;
    }

    /** The machine as a whole when it comes, and as it was before when it goes, unless somebody has moved the view. */
    fitMachine(isShown: boolean): void {
        const { camera, fitted, before } = this;
        if (isShown) {
            this.before = { camera, fitted };
            return this.fitTo("machine");
        }
        this.before = null;
        if (before === null || fitted !== "machine") return;
        this.look(before.camera);
        this.fitted = before.fitted;
    }

    /** After another posting: what somebody has zoomed to stays, unless all is another part. */
    refit(isOther: boolean): void {
        const { fitted } = this;
        if (isOther) this.fitTo(fitted ?? "cuts");
        else if (fitted !== null) this.fitTo(fitted);
        else this.redraw();
    }

    /** A standard view, numbered as in `VIEWS`. */
    view(number: number): void {
        this.camera = { ...this.camera, ...VIEWS[number]! };
        this.fitTo(this.fitted ?? "cuts");
    }

    along(axis: Vector): void {
        this.look(alongTool(this.camera, axis));
    }

    turn(dx: number, dy: number): void {
        this.go(orbit(this.camera, dx, dy));
    }

    shift(dx: number, dy: number): void {
        this.go(pan(this.camera, dx, dy));
    }

    zoom(by: number): void {
        const { size } = this;
        this.go(zoom(this.camera, by, size.width / 2, size.height / 2, size));
    }

    private at(event: MouseEvent): [number, number] {
        const { left, top } = this.host.getBoundingClientRect();
        return [(event.clientX - left) * this.ratio, (event.clientY - top) * this.ratio];
    }

    private down(event: PointerEvent): void {
        clearTimeout(this.resting);
        const from = this.at(event);
        const kind = this.ruler ? "ruler" : event.ctrlKey ? "zoom" : event.button !== 0 || event.shiftKey ? "pan" : "orbit";
        this.drag = { kind, from, last: from, moved: false, picked: this.pick(...from) };
        this.measured = null;
        this.host.setPointerCapture(event.pointerId);
    }

    private move(event: PointerEvent): void {
        const to = this.at(event);
        const { drag } = this;
        if (drag === null) {
            this.restAt(to);
            return this.tell.pointed(this.pointOf(to));
        }
        const [dx, dy] = [to[0] - drag.last[0], to[1] - drag.last[1]];
        drag.moved ||= Math.hypot(to[0] - drag.from[0], to[1] - drag.from[1]) > 3;
        if (!drag.moved) return;
        drag.last = to;
        if (drag.kind === "orbit") this.turn(dx / this.ratio, dy / this.ratio);
        else if (drag.kind === "pan") this.shift(dx, dy);
        else {
            this.measured = { kind: drag.kind, from: drag.from, to };
            this.redraw();
        }
    }

    /** Where the pointer rests somebody may click: the exact lines there are fetched before. */
    private restAt(at: [number, number]): void {
        clearTimeout(this.resting);
        this.resting = setTimeout(() => void this.pick(...at), REST);
    }

    private up(event: PointerEvent): void {
        const { drag } = this;
        this.drag = null;
        if (drag === null) return;
        if (!drag.moved) void drag.picked.then((move) => move !== null && this.tell.picked(move));
        else if (drag.kind === "zoom") {
            this.measured = null;
            this.look(zoomTo(this.camera, drag.from, this.at(event), this.size));
        }
    }

    private wheel(event: WheelEvent): void {
        event.preventDefault();
        const [x, y] = this.at(event);
        this.go(zoom(this.camera, Math.exp(-event.deltaY * 0.0015), x, y, this.size));
    }

    private async pick(x: number, y: number): Promise<number | null> {
        const { scene, looks } = this.shown();
        return (await scene?.pick(this.projection, looks, x, y, this.sights)) ?? null;
    }

    /** The point under the pixel, in the plane of the view through the camera's middle. */
    private pointOf([x, y]: [number, number]): Vector {
        const { size } = this;
        return pan(this.camera, size.width / 2 - x, size.height / 2 - y).middle;
    }
}
