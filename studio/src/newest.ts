/** Asks one after the other: of those that come meanwhile only the newest is asked. */
export class Newest<T> {
    private busy = false;
    private waiting: T | undefined;

    constructor(private readonly run: (value: T) => Promise<void>) {}

    async ask(value: T): Promise<void> {
        this.waiting = value;
        if (this.busy) return;
        this.busy = true;
        try {
            while (this.waiting !== undefined) {
                const next = this.waiting;
                this.waiting = undefined;
                await this.run(next);
            }
        } finally {
            this.busy = false;
        }
    }
}
