/** The one file of the page that knows how the server is reached: everything else asks. */

import { read, write, type Arrays, type Frame } from "./frames.ts";
import type { Asks, Finding, Verdict, Walked } from "./asks.ts";

export interface Progress {
    step: string;
    part: number | null;
}

export interface Asking {
    arrays?: Arrays;
    signal?: AbortSignal;
    progress?: (progress: Progress) => void;
    /** What the proof that runs has walked so far, chunk by chunk. */
    walked?: (walked: Walked, arrays: Arrays) => void;
}

export interface Answer<T> {
    done: T;
    arrays: Arrays;
}

/** The server did not do it, and says why. */
export class Stopped extends Error {
    constructor(
        readonly verdict: Verdict,
        readonly findings: Finding[],
    ) {
        super(findings[0]?.message ?? verdict);
    }
}

export type State = "connecting" | "open" | "lost" | "refused";

export interface Seam {
    ask<A extends keyof Asks>(ask: A, params: Asks[A][0], asking?: Asking): Promise<Answer<Asks[A][1]>>;
    /** Octets that never change: chunks of geometry. */
    octets(path: string, signal?: AbortSignal): Promise<ArrayBuffer>;
    upload(file: File, signal?: AbortSignal): Promise<string>;
}

interface Pending {
    resolve(answer: Answer<never>): void;
    reject(error: Error): void;
    asking: Asking;
}

const lost = (): Stopped =>
    new Stopped("cancelled", [said("connection", "the connection was lost", "the page connects again by itself")]);

const ended = (): Stopped => new Stopped("cancelled", [said("cancelled", "the file is not taken: something else was begun, or this was cancelled", "give it again")]);

/** A finding of the page's own. */
export const said = (rule: string, message: string, help: string): Finding => ({
    severity: "error", rule, message, help, file: "", of: null, line: 0, column: 0, width: 0, excerpt: "", count: 1, lines: [], places: [],
});

/** The server's code for a token that is none of its own: no use in trying again. */
const WRONG_TOKEN = 4401;

/** A socket that opens itself again, and asks that wait for it. */
export class Socket implements Seam {
    private readonly pending = new Map<number, Pending>();
    private next = 1;
    private socket: WebSocket | null = null;
    /** The socket that is open, or on its way to be. */
    private opening: WebSocket | null = null;
    private again: ReturnType<typeof setTimeout> | undefined;
    private waits = 250;

    constructor(
        private token: string,
        private readonly tell: (state: State) => void,
        private readonly address = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/socket`,
    ) {
        this.connect();
    }

    /** The token of a server that has taken the place of the one before: connects anew. */
    renew(token: string): void {
        this.token = token;
        this.waits = 250;
        clearTimeout(this.again);
        this.opening?.close();
        this.drop();
        this.connect();
    }

    private connect(): void {
        this.tell("connecting");
        const socket = new WebSocket(this.address);
        this.opening = socket;
        socket.binaryType = "arraybuffer";
        socket.addEventListener("open", () => {
            if (this.opening !== socket) return;
            socket.send(write({ head: { token: this.token }, arrays: {} }));
            this.waits = 250;
            this.socket = socket;
            this.tell("open");
        });
        socket.addEventListener("message", (event) => this.take(read(event.data as ArrayBuffer)));
        socket.addEventListener("close", (event) => this.opening === socket && this.closed(event.code));
    }

    private drop(): void {
        this.socket = null;
        for (const pending of this.pending.values()) pending.reject(lost());
        this.pending.clear();
    }

    private closed(code: number): void {
        this.drop();
        if (code === WRONG_TOKEN) return this.tell("refused");
        this.tell("lost");
        this.again = setTimeout(() => this.connect(), this.waits);
        this.waits = Math.min(this.waits * 2, 4000);
    }

    private take({ head, arrays }: Frame): void {
        const pending = this.pending.get(head.id as number);
        if (pending === undefined) return;
        if (head.event === "progress") return pending.asking.progress?.(head as unknown as Progress);
        if (head.event === "walked") return pending.asking.walked?.(head as unknown as Walked, arrays);
        this.pending.delete(head.id as number);
        const stop = head.stop as { verdict: Verdict; findings: Finding[] } | undefined;
        if (stop !== undefined) return pending.reject(new Stopped(stop.verdict, stop.findings));
        pending.resolve({ done: head.done as never, arrays });
    }

    ask<A extends keyof Asks>(ask: A, params: Asks[A][0], asking: Asking = {}): Promise<Answer<Asks[A][1]>> {
        const socket = this.socket;
        if (socket === null) return Promise.reject(lost());
        const id = this.next++;
        return new Promise((resolve, reject) => {
            this.pending.set(id, { resolve, reject, asking });
            asking.signal?.addEventListener("abort", () => {
                if (this.pending.has(id)) socket.send(write({ head: { cancel: id }, arrays: {} }));
            });
            socket.send(write({ head: { id, ask, params }, arrays: asking.arrays ?? {} }));
        });
    }

    private async fetch(path: string, request: RequestInit): Promise<Response> {
        const response = await fetch(path, { ...request, cache: "no-store", headers: { "x-toolpost-token": this.token } }).catch(() => {
            throw request.signal?.aborted ? ended() : lost();
        });
        if (response.ok) return response;
        const message = (await response.text()).slice(0, 500) || `the server answers ${response.status}`;
        throw new Stopped("invalid", [said("connection", message, "")]);
    }

    async octets(path: string, signal?: AbortSignal): Promise<ArrayBuffer> {
        return (await this.fetch(path, signal ? { signal } : {})).arrayBuffer();
    }

    async upload(file: File, signal?: AbortSignal): Promise<string> {
        const path = `/upload/${encodeURIComponent(file.name)}`;
        const response = await this.fetch(path, { method: "PUT", body: file, ...(signal ? { signal } : {}) });
        return ((await response.json()) as { upload: string }).upload;
    }
}
