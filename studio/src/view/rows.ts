/** The rows of moves, by chunk, as they come: end time, block, source line, feed, and where tools lean, the tool axis. */

import type { Seam } from "../protocol/seam.ts";

export class Rows {
    private readonly rows = new Map<number, Float32Array | null>();

    constructor(
        private readonly seam: Seam,
        private readonly revision: number,
        /** Numbers in a row. */
        readonly width: number,
        private readonly changed: () => void,
    ) {}

    /** Null until they have come. */
    of(chunk: number): Float32Array | null {
        const known = this.rows.get(chunk);
        if (known !== undefined) return known;
        this.rows.set(chunk, null);
        void this.fetch(chunk);
        return null;
    }

    private async fetch(chunk: number): Promise<void> {
        try {
            this.rows.set(chunk, new Float32Array(await this.seam.octets(`/moves/${this.revision}/${chunk}`)));
            this.changed();
        } catch {
            this.rows.delete(chunk);
        }
    }
}
