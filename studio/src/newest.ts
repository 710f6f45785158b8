/** Asks one after the other: of those that come meanwhile only the newest is asked. */
export class Newest<T> {
    private waiting: T | undefined;
    private running: Promise<void> | null = null;

    constructor(private readonly run: (value: T) => Promise<void>) {}

    async ask(value: T): Promise<void> {
        this.waiting = value;
        if (this.running === null) {
            this.running = this.work();
            await this.running;
        }
    }

    /** When nothing is asked any more, whatever came of it. */
    async rest(): Promise<void> {
        await this.running?.catch(() => {});
    }

    private async work(): Promise<void> {
        try {
            while (this.waiting !== undefined) {
                const next = this.waiting;
                this.waiting = undefined;
                await this.run(next);
            }
        } finally {
            this.running = null;
        }
    }
}

/** Of what is asked several times only the answer to the newest ask counts. */
export class Latest {
    private last = 0;

    /** Begins an ask: whether it is still the newest. */
    begin(): () => boolean {
        const own = ++this.last;
        return () => own === this.last;
    }
}

/** What is begun in the same turn ends together: one frame shows all of it. */
export class Together {
    private begun: Promise<unknown>[] = [];

    async end<T>(one: Promise<T>): Promise<T> {
        if (this.begun.length === 0) queueMicrotask(() => (this.begun = []));
        const { begun } = this;
        begun.push(one);
        await one;
        await Promise.allSettled(begun);
        return one;
    }
}
