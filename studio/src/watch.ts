/** Files that the work is made of and that others change meanwhile: what has changed is said, and posted anew. */

import type { Changes, Edit } from "./protocol/asks.ts";
import type { Studio } from "./studio.ts";

/** How often the server is asked, ms. */
const EVERY = 1000;

/** After so many looks that found something else each time it is said. */
const RESTLESS = 3;

/** What was found, and beside what. */
interface Seen {
    state: string;
    revision: number | null;
    edit: Edit | null;
}

export class Watch {
    private seen: Seen | null = null;
    /** For what the work was posted anew; or was not, since an edit is in the way. */
    private posted = { state: "", isDone: true };
    /** How often in a row something else was found. */
    private restless = 0;

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
        const isSame = seen !== null && seen.state === now.state && seen.revision === revision && seen.edit === now.edit;
        this.restless = done.files.length === 0 || isSame ? 0 : this.restless + 1;
        if (this.restless === RESTLESS) studio.said.value = `${namesOf(pathsOf(done))} changes all the time: posted again when it rests`;
        if (done.files.length > 0 && isSame) await this.take(done);
    }

    private async take(changes: Changes): Promise<void> {
        const { files, state } = changes;
        const { studio, posted } = this;
        const gone = files.filter(({ is_gone }) => is_gone).map(({ path }) => path);
        // What is shown stays until the file comes back, as it was or another one.
        studio.gone.value = gone;
        if (gone.length > 0) return;
        const names = namesOf(pathsOf(changes));
        if (posted.state === state) {
            // Its time is ahead of the clock of this computer: nobody knows what was read.
            if (posted.isDone) studio.said.value = `${names} changed while it was read: post again`;
            return;
        }
        studio.said.value = `${names} changed: posted again`;
        const isDone = await studio.again();
        this.posted = { state, isDone };
        if (!isDone) studio.said.value = `${names} changed, and is not posted again: the edit on this page cannot be kept`;
    }
}

const pathsOf = ({ files }: Changes): string[] => files.map(({ path }) => path || "the folder");

/** A few names, and how many more. */
export function namesOf(paths: string[]): string {
    const more = paths.length - 3;
    return [...paths.slice(0, 3), ...(more > 0 ? [`${more} more`] : [])].join(", ");
}
