/**
 * A frame of the socket: the length of its head (u32, little-endian), the head (JSON), zeros up to a multiple of 8, then
 * the arrays, each padded to 8. The head's `arrays` names them in the order of their bytes.
 */

export type Numbers = Uint8Array | Uint32Array | Float32Array | Float64Array;
export type Arrays = Record<string, Numbers>;

const kinds = { u8: Uint8Array, u32: Uint32Array, f32: Float32Array, f64: Float64Array } as const;
type Kind = keyof typeof kinds;

interface ArrayHead {
    name: string;
    type: Kind;
    length: number;
}

/** The head of any frame, before it is known which one it is. */
export type Head = Record<string, unknown>;

export interface Frame {
    head: Head;
    arrays: Arrays;
}

const padded = (bytes: number): number => Math.ceil(bytes / 8) * 8;

function kindOf(array: Numbers): Kind {
    if (array instanceof Uint8Array) return "u8";
    if (array instanceof Uint32Array) return "u32";
    return array instanceof Float32Array ? "f32" : "f64";
}

export function write({ head, arrays }: Frame): Uint8Array<ArrayBuffer> {
    const named = Object.entries(arrays);
    const heads = named.map(([name, array]): ArrayHead => ({ name, type: kindOf(array), length: array.length }));
    const text = new TextEncoder().encode(JSON.stringify(heads.length > 0 ? { ...head, arrays: heads } : head));

    let at = padded(4 + text.length);
    const bytes = new Uint8Array(at + named.reduce((sum, [, array]) => sum + padded(array.byteLength), 0));
    new DataView(bytes.buffer).setUint32(0, text.length, true);
    bytes.set(text, 4);
    for (const [, array] of named) {
        bytes.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), at);
        at += padded(array.byteLength);
    }
    return bytes;
}

/** Reads a frame; its arrays are views of `buffer`. Throws where the frame is cut short or its head is not one. */
export function read(buffer: ArrayBuffer): Frame {
    if (buffer.byteLength < 4) throw new Error("frame without a head");
    const length = new DataView(buffer).getUint32(0, true);
    if (length > buffer.byteLength - 4) throw new Error("frame cut short in its head");
    const head: unknown = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(new Uint8Array(buffer, 4, length)));
    if (typeof head !== "object" || head === null || Array.isArray(head)) throw new Error("the head is no object");

    const arrays: Arrays = {};
    let at = padded(4 + length);
    const { arrays: heads = [], ...rest } = head as Head & { arrays?: ArrayHead[] };
    for (const { name, type, length: count } of heads) {
        const kind = kinds[type];
        if (kind === undefined || !Number.isSafeInteger(count) || count < 0) throw new Error(`array ${name} is not described`);
        const size = count * kind.BYTES_PER_ELEMENT;
        if (at + size > buffer.byteLength) throw new Error(`frame cut short in array ${name}`);
        arrays[name] = new kind(buffer, at, count);
        at += padded(size);
    }
    return { head: rest, arrays };
}
