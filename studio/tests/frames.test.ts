import { expect, test } from "vitest";
import { read, write } from "../src/protocol/frames.ts";

const bytes = (...parts: (string | number[])[]): ArrayBuffer =>
    Uint8Array.from(parts.flatMap((part) => (typeof part === "string" ? [...new TextEncoder().encode(part)] : part))).buffer;

test("a frame is the length of its head, the head, zeros to a multiple of 8, and its arrays", () => {
    const frame = write({ head: { id: 7 }, arrays: { text: new Uint8Array([65, 66]), x: new Float64Array([1]) } });
    const head = '{"id":7,"arrays":[{"name":"text","type":"u8","length":2},{"name":"x","type":"f64","length":1}]}';
    expect(head.length).toBe(95);
    const zeros = Array.from({ length: 104 - 4 - 95 }, () => 0);
    expect([...frame]).toEqual([
        ...new Uint8Array(bytes([95, 0, 0, 0], head, zeros, "AB", [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0xf0, 0x3f])),
    ]);
});

test("what is written is read", () => {
    const arrays = { a: new Uint32Array([1, 4_000_000_000]), b: new Float32Array([0.5]), c: new Uint8Array(0) };
    const frame = read(write({ head: { id: 1, ask: "text", params: { name: "Größe ∅" } }, arrays }).buffer);
    expect(frame).toEqual({ head: { id: 1, ask: "text", params: { name: "Größe ∅" } }, arrays });
});

test("a frame without arrays is read", () => {
    expect(read(bytes([8, 0, 0, 0], '{"id":3}', [0, 0, 0, 0]))).toEqual({ head: { id: 3 }, arrays: {} });
});

test.each([
    ["without a head", bytes([1, 0])],
    ["cut short in its head", bytes([200, 0, 0, 0], "{}")],
    ["the head is no object", bytes([2, 0, 0, 0], "[]", [0, 0])],
    ["JSON", bytes([2, 0, 0, 0], "{x", [0, 0])],
    ["cut short in array a", bytes([52, 0, 0, 0], '{"arrays":[{"name":"a","type":"f64","length":1000}]}', [0])],
    ["array a is not described", bytes([48, 0, 0, 0], '{"arrays":[{"name":"a","type":"i9","length":1}]}')],
    ["array a is not described", bytes([49, 0, 0, 0], '{"arrays":[{"name":"a","type":"u8","length":-1}]}')],
])("refused: %s", (message, frame) => {
    expect(() => read(frame)).toThrow(message);
});
