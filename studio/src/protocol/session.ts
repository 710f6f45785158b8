/** What this tab works on, so that a reload finds it. */

import type { Where } from "../cursor.ts";
import type { Pace } from "../player.ts";
import type { Work } from "./asks.ts";

const KEY = "toolpost-work";

export function rememberWork(work: Work | null): void {
    if (work !== null) sessionStorage.setItem(KEY, JSON.stringify(work));
}

export function rememberedWork(): Work | null {
    const kept = sessionStorage.getItem(KEY);
    return kept === null ? null : (JSON.parse(kept) as Work);
}

const LEFT = "toolpost-left";

/** An edit by hand, as it is kept in a draft. */
export interface Unkept {
    of: Work;
    /** The files that were edited, each with its text: [`Edit`] as JSON has it. */
    edit: [string | null, string][];
    /** Name of the draft that has an older text of it. */
    name: string | null;
}

/** How a tab was left. */
export interface Left {
    place: Where | null;
    pace: Pace;
    /** The edit by hand that no server has said to have kept. */
    edit: Unkept | null;
}

/** As the tab is left; false where that is more than a browser keeps. */
export function leave(left: Left): boolean {
    try {
        sessionStorage.setItem(LEFT, JSON.stringify(left));
        return true;
    } catch {
        sessionStorage.removeItem(LEFT);
        return false;
    }
}

/** How it was left, once. */
export function takeLeft(): Left | null {
    const left = sessionStorage.getItem(LEFT);
    sessionStorage.removeItem(LEFT);
    return left === null ? null : (JSON.parse(left) as Left);
}
