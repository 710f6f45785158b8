/** Files that the work is made of and that others change meanwhile: what has changed is said, and posted anew. */

import type { Changes, Edit } from "./protocol/asks.ts";
import type { Studio } from "./studio.ts";

/** How often the server is asked, ms. */
const EVERY = 1000;

/** What was found, and beside what. */
interface Seen {
    state: string;
    revision: number | null;
    edit: Edit | null;
}

export class Watch {
    private seen: Seen | null = null;
    /** For what the work was posted anew. */
    private posted = "";

    constructor(private readonly studio: Studio) {}

    /** Looks every second, while somebody sees the page. */
    begin(): void {
        const look = async (): Promise<void> => {
            // A connection that is lost opens itself again, and posts then.
            if (!document.hidden) await this.look().catch(() => {});
            setTimeout(() => void look(), EVERY);
        };
        setTimeout(() => void look(), EVERY);
    }

    /** Looks once. A file is taken as it is when it is the same twice: an editor may write it in two steps, and somebody may be typing. */
    async look(): Promise<void> {
        const { studio } = this;
        const revision = studio.watched;
        if (revision === undefined) return;
        const { done } = await studio.seam.ask("changes", { revision });
        if (studio.watched !== revision) return;
        const { seen } = this;
        const now = { state: done.state, revision, edit: studio.edited.value };
        this.seen = now;
        if (done.files.length === 0) studio.gone.value = [];
        if (done.files.length === 0 || seen === null || seen.state !== now.state || seen.revision !== revision || seen.edit !== now.edit) return;
        await this.take(done);
    }

    private async take({ files, state }: Changes): Promise<void> {
        const { studio } = this;
        const gone = files.filter(({ is_gone }) => is_gone).map(({ path }) => path);
        // What is shown stays until the file comes back, as it was or another one.
        studio.gone.value = gone;
        if (gone.length > 0) return;
        const names = namesOf(files.map(({ path }) => path || "the folder"));
        if (this.posted === state) {
            // Its time is ahead of the clock of this computer: nobody knows what was read.
            studio.said.value = `${names} changed while it was read: post again`;
            return;
        }
        this.posted = state;
        studio.said.value = `${names} changed: posted again`;
        await studio.again();
    }
}

/** A few names, and how many more. */
export function namesOf(paths: string[]): string {
    const more = paths.length - 3;
    return [...paths.slice(0, 3), ...(more > 0 ? [`${more} more`] : [])].join(", ");
}
