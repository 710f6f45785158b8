/** The same pictures by the graphics processor: vertices are pulled from a texture, and a line is two triangles of its width. */

import type { Flat } from "./board.ts";
import type { Projection, Size } from "./camera.ts";
import type { Theme } from "./colours.ts";
import { shaded } from "./raster.ts";
import type { Renderer } from "./renderer.ts";
import type { Picture } from "./scene.ts";
import { Style, type Paint, type Strip, type Triangles } from "./strip.ts";

const ROW = 2048;

/** Frames after which a texture that nobody drew is given back. */
const IDLE = 120;

const LINES = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
uniform usampler2D vertices;
uniform usampler2D moves;
uniform sampler2D palette;
uniform vec3 right, down, away, at;
uniform vec2 size;
uniform float reach, lift, width;
uniform uint shift, mask, hidden, dashes, dots;
uniform int dashed, tool;
uniform bool byMove, rounded;
out vec4 colour;
out float along;
out vec2 place_;
flat out float broken;
flat out vec4 ends;
flat out float radius;

uvec4 vertex(int number) { return texelFetch(vertices, ivec2(number % ${ROW}, number / ${ROW}), 0); }

vec3 pixel(uvec4 word) {
    vec3 p = uintBitsToFloat(word.xyz);
    return vec3(dot(right, p), dot(down, p), dot(away, p)) + at;
}

void main() {
    int segment = gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    uvec4 end = vertex(segment + 1);
    vec3 a = pixel(vertex(segment)), b = pixel(end);
    uint kind = (end.w >> 12u) & 15u;
    if (((hidden >> kind) & 1u) == 1u || (tool >= 0 && int((end.w >> 16u) & 255u) != tool)) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
    bool dash = ((dashes >> kind) & 1u) == 1u;
    bool point = ((dots >> kind) & 1u) == 1u;
    if (point) a = b;
    uint place = byMove ? texelFetch(moves, ivec2(int(end.w & 4095u), 0), 0).r : (end.w >> shift) & mask;
    if (dash && dashed >= 0) place = uint(dashed);
    colour = texelFetch(palette, ivec2(int(place), 0), 0);
    vec2 way = b.xy - a.xy;
    float length_ = length(way);
    way = length_ > 0.0 ? way / length_ : vec2(1.0, 0.0);
    bool last = corner == 1 || corner == 2 || corner == 4;
    float side = (corner == 0 || corner == 1 || corner == 3) ? -0.5 : 0.5;
    float beyond = rounded || point ? max(width, 1.0) * 0.5 : 0.5;
    vec2 p = (last ? b.xy + way * beyond : a.xy - way * beyond) + vec2(-way.y, way.x) * side * max(width, 1.0);
    place_ = p;
    ends = vec4(a.xy, b.xy);
    radius = rounded ? width * 0.5 : 0.0;
    along = last ? length_ : 0.0;
    broken = dash ? 1.0 : 0.0;
    float z = (last ? b.z : a.z) - lift;
    gl_Position = vec4(p.x / size.x * 2.0 - 1.0, 1.0 - p.y / size.y * 2.0, z / reach, 1.0);
}`;

const FACES = `#version 300 es
precision highp float;
uniform vec3 right, down, away, at;
uniform vec2 size;
uniform float reach;
layout(location = 0) in vec3 point;
layout(location = 1) in vec3 shade;
out vec4 colour;
out float along;
out vec2 place_;
flat out float broken;
flat out vec4 ends;
flat out float radius;
void main() {
    vec3 p = vec3(dot(right, point), dot(down, point), dot(away, point)) + at;
    gl_Position = vec4(p.x / size.x * 2.0 - 1.0, 1.0 - p.y / size.y * 2.0, p.z / reach, 1.0);
    colour = vec4(shade, 1.0);
    along = 0.0;
    broken = 0.0;
    place_ = vec2(0.0);
    ends = vec4(0.0);
    radius = 0.0;
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec4 colour;
in float along;
in vec2 place_;
flat in float broken;
flat in vec4 ends;
flat in float radius;
out vec4 seen;
void main() {
    if (radius > 0.0) {
        vec2 way = ends.zw - ends.xy;
        float part = clamp(dot(place_ - ends.xy, way) / max(dot(way, way), 1e-12), 0.0, 1.0);
        if (distance(place_, ends.xy + way * part) > radius) discard;
    }
    if (broken > 0.5 && mod(along, 8.0) >= 5.0) discard;
    seen = colour;
}`;

interface Program {
    program: WebGLProgram;
    at(name: string): WebGLUniformLocation | null;
}

export class Gl implements Renderer {
    readonly canvas = document.createElement("canvas");
    private readonly gl: WebGL2RenderingContext;
    private readonly lines: Program;
    private readonly faces: Program;
    private readonly empty: WebGLVertexArrayObject;
    private readonly kept = new Map<object, { texture: WebGLTexture; frame: number }>();
    private readonly areas = new Map<Flat, { array: WebGLVertexArrayObject; buffers: WebGLBuffer[]; frame: number }>();
    private frame = 0;

    /** Throws where there is no WebGL 2, or only one that is slower than the rasteriser. */
    constructor(lost: () => void, { evenSlow = false } = {}) {
        const gl = this.canvas.getContext("webgl2", { alpha: false, antialias: false, failIfMajorPerformanceCaveat: !evenSlow });
        if (gl === null) throw new Error("no WebGL 2");
        if (!evenSlow && isPlayed(gl)) throw new Error("WebGL 2 by the processor");
        this.gl = gl;
        this.canvas.addEventListener("webglcontextlost", lost, { once: true });
        this.lines = this.program(LINES);
        this.faces = this.program(FACES);
        this.empty = gl.createVertexArray();
    }

    private program(vertex: string): Program {
        const { gl } = this;
        const program = gl.createProgram();
        for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, FRAGMENT]] as const) {
            const shader = gl.createShader(kind)!;
            gl.shaderSource(shader, source);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
        }
        gl.linkProgram(program);
        if (gl.getProgramParameter(program, gl.LINK_STATUS) !== true) throw new Error(gl.getProgramInfoLog(program) ?? "shader");
        const places = new Map<string, WebGLUniformLocation | null>();
        const at = (name: string): WebGLUniformLocation | null => {
            if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
            return places.get(name) ?? null;
        };
        return { program, at };
    }

    draw({ flats, surfaces, strips, over, bodies }: Picture, projection: Projection, size: Size, { paper }: Theme): void {
        const { gl, canvas } = this;
        if (gl.isContextLost()) return;
        this.frame++;
        if (canvas.width !== size.width || canvas.height !== size.height) Object.assign(canvas, size);
        gl.viewport(0, 0, size.width, size.height);
        gl.clearColor(paper[0] / 255, paper[1] / 255, paper[2] / 255, 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.depthFunc(gl.LEQUAL);
        this.use(this.faces, projection, size, 1);
        gl.uniform3f(this.faces.at("at"), projection.at[0], projection.at[1], 0);
        gl.uniform3f(this.faces.at("away"), 0, 0, 0);
        gl.disable(gl.DEPTH_TEST);
        for (const flat of flats) this.flat(flat);
        gl.enable(gl.DEPTH_TEST);
        const reach = reachOf(strips, projection);
        this.use(this.lines, projection, size, reach);
        gl.bindVertexArray(this.empty);
        gl.uniform1i(this.lines.at("vertices"), 0);
        gl.uniform1i(this.lines.at("palette"), 1);
        gl.uniform1i(this.lines.at("moves"), 2);
        for (const strip of [...strips, ...over]) this.strip(strip, projection);
        this.use(this.faces, projection, size, reach);
        gl.uniform3f(this.faces.at("at"), ...projection.at);
        for (const body of [...surfaces, ...bodies]) this.body(body, projection);
        this.forget();
    }

    private use({ program, at }: Program, { right, down, away }: Projection, size: Size, reach: number): void {
        const { gl } = this;
        gl.useProgram(program);
        gl.uniform3f(at("right"), ...right);
        gl.uniform3f(at("down"), ...down);
        gl.uniform3f(at("away"), ...away);
        gl.uniform2f(at("size"), size.width, size.height);
        gl.uniform1f(at("reach"), reach);
    }

    private strip({ vertices, origin, from, to, paint, frame }: Strip, projection: Projection): void {
        const { gl, lines } = this;
        const { right, down, away, at } = frame ?? projection;
        gl.uniform3f(lines.at("right"), ...right);
        gl.uniform3f(lines.at("down"), ...down);
        gl.uniform3f(lines.at("away"), ...away);
        const offset = (way: readonly number[], plus: number): number => way[0]! * origin[0] + way[1]! * origin[1] + way[2]! * origin[2] + plus;
        gl.uniform3f(lines.at("at"), offset(right, at[0]), offset(down, at[1]), offset(away, at[2]));
        this.bind(0, vertices, () => this.vertexTexture(vertices));
        this.bind(1, paint.palette, () => this.paletteTexture(paint.palette));
        const { byMove } = paint;
        const places = byMove ?? NO_MOVES;
        this.bind(2, places, () => this.moveTexture(places));
        gl.uniform1i(lines.at("byMove"), byMove === null ? 0 : 1);
        gl.uniform1f(lines.at("lift"), paint.lift);
        gl.uniform1f(lines.at("width"), paint.width);
        gl.uniform1i(lines.at("tool"), paint.tool);
        gl.uniform1i(lines.at("rounded"), paint.round ? 1 : 0);
        gl.uniform1ui(lines.at("shift"), paint.shift);
        gl.uniform1ui(lines.at("mask"), paint.mask);
        gl.uniform1ui(lines.at("hidden"), bits(paint, Style.hidden));
        gl.uniform1ui(lines.at("dashes"), bits(paint, Style.dashed));
        gl.uniform1ui(lines.at("dots"), bits(paint, Style.dot));
        gl.uniform1i(lines.at("dashed"), paint.dashed);
        gl.drawArrays(gl.TRIANGLES, (from - 1) * 6, (to - from) * 6);
    }

    private bind(unit: number, key: object, make: () => WebGLTexture): void {
        const { gl } = this;
        gl.activeTexture(gl.TEXTURE0 + unit);
        let kept = this.kept.get(key);
        if (kept === undefined) {
            kept = { texture: make(), frame: 0 };
            this.kept.set(key, kept);
        }
        kept.frame = this.frame;
        gl.bindTexture(gl.TEXTURE_2D, kept.texture);
    }

    private texture(): WebGLTexture {
        const { gl } = this;
        const texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        return texture;
    }

    private vertexTexture(vertices: ArrayBuffer): WebGLTexture {
        const { gl } = this;
        const texture = this.texture();
        const words = new Uint32Array(vertices);
        const rows = Math.max(1, Math.ceil(words.length / 4 / ROW));
        const padded = new Uint32Array(rows * ROW * 4);
        padded.set(words);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32UI, ROW, rows, 0, gl.RGBA_INTEGER, gl.UNSIGNED_INT, padded);
        return texture;
    }

    private paletteTexture(palette: Uint32Array): WebGLTexture {
        const { gl } = this;
        const texture = this.texture();
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, palette.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(palette.buffer));
        return texture;
    }

    private moveTexture(places: Uint8Array): WebGLTexture {
        const { gl } = this;
        const texture = this.texture();
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8UI, places.length, 1, 0, gl.RED_INTEGER, gl.UNSIGNED_BYTE, places);
        return texture;
    }

    private body(triangles: Triangles, projection: Projection): void {
        const { gl } = this;
        const array = gl.createVertexArray();
        gl.bindVertexArray(array);
        const buffers = [triangles.corners, shaded(triangles, projection)].map((numbers, place) => {
            const buffer = gl.createBuffer();
            gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
            gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STREAM_DRAW);
            gl.enableVertexAttribArray(place);
            gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
            return buffer;
        });
        gl.drawArrays(gl.TRIANGLES, 0, triangles.corners.length / 3);
        for (const buffer of buffers) gl.deleteBuffer(buffer);
        gl.deleteVertexArray(array);
    }

    /** Areas in the plane Z 0: their corners stay on the graphics processor. */
    private flat(flat: Flat): void {
        const { gl } = this;
        let kept = this.areas.get(flat);
        if (kept === undefined) {
            kept = { ...this.areasOf(flat), frame: 0 };
            this.areas.set(flat, kept);
        }
        kept.frame = this.frame;
        gl.bindVertexArray(kept.array);
        const { colour } = flat;
        gl.vertexAttrib3f(1, (colour & 255) / 255, ((colour >> 8) & 255) / 255, ((colour >> 16) & 255) / 255);
        gl.drawElements(gl.TRIANGLES, (flat.corners.length / 8) * 6, gl.UNSIGNED_INT, 0);
    }

    private areasOf({ corners }: Flat): { array: WebGLVertexArrayObject; buffers: WebGLBuffer[] } {
        const { gl } = this;
        const array = gl.createVertexArray();
        gl.bindVertexArray(array);
        const points = gl.createBuffer();
        gl.bindBuffer(gl.ARRAY_BUFFER, points);
        gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
        const order = gl.createBuffer();
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
        const places = new Uint32Array((corners.length / 8) * 6);
        for (let area = 0; area * 8 < corners.length; area++) places.set([0, 1, 2, 0, 2, 3].map((corner) => area * 4 + corner), area * 6);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, places, gl.STATIC_DRAW);
        return { array, buffers: [points, order] };
    }

    private forget(): void {
        for (const [flat, { array, buffers, frame }] of this.areas) {
            if (this.frame - frame < IDLE) continue;
            this.gl.deleteVertexArray(array);
            for (const buffer of buffers) this.gl.deleteBuffer(buffer);
            this.areas.delete(flat);
        }
        for (const [key, { texture, frame }] of this.kept) {
            if (this.frame - frame < IDLE) continue;
            this.gl.deleteTexture(texture);
            this.kept.delete(key);
        }
    }
}

/** Browsers do not always tell that the processor plays the graphics processor; its name does. */
function isPlayed(gl: WebGL2RenderingContext): boolean {
    const more = gl.getExtension("WEBGL_debug_renderer_info");
    const name: unknown = gl.getParameter(more?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(String(name));
}

const NO_MOVES = new Uint8Array(1);

const bits = ({ styles }: Paint, style: number): number => styles.reduce((all, one, kind) => (one === style ? all | (1 << kind) : all), 0);

/** What is farthest, near or away, pixels: depths are parts of it. */
function reachOf(strips: Strip[], { away, at, scale }: Projection): number {
    let reach = 1000;
    for (const { origin } of strips) reach = Math.max(reach, Math.abs(away[0] * origin[0] + away[1] * origin[1] + away[2] * origin[2] + at[2]));
    // A chunk reaches beyond its middle by no more than the walk's size, which is at most this many millimetres.
    return reach * 2 + 1000 * scale;
}
