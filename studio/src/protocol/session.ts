/** What this tab works on, so that a reload finds it. */

import type { Work } from "./asks.ts";

const KEY = "toolpost-work";

export function rememberWork(work: Work | null): void {
    if (work !== null) sessionStorage.setItem(KEY, JSON.stringify(work));
}

export function rememberedWork(): Work | null {
    const kept = sessionStorage.getItem(KEY);
    return kept === null ? null : (JSON.parse(kept) as Work);
}
