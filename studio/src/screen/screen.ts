/** What is on the screen and not in the work: dialogs, tabs, the selected finding. */

import { signal, type Signal } from "@preact/signals";
import type { Finding } from "../protocol/types.ts";
import type { Studio } from "../studio.ts";

export type Dialog = "commands" | "keys" | "machine" | "source" | "options" | "save" | "go";
export type Tab = "findings" | "verdict" | "axes";

export class Screen {
    readonly dialog: Signal<Dialog | null> = signal(null);
    readonly tab: Signal<Tab> = signal("findings");
    /** Number of the finding that was led to last. */
    readonly finding: Signal<number> = signal(-1);

    constructor(readonly studio: Studio) {}

    /** Leads to the finding's place, in every pane. */
    toFinding(number: number): void {
        const { findings, job, cursor } = this.studio;
        const count = findings.value.length;
        if (count === 0) return;
        this.finding.value = (number + count) % count;
        this.tab.value = "findings";
        const place = placeOf(findings.value[this.finding.value]!);
        if (place === null || job.value === null) return;
        const by = place.file === job.value.source?.file ? "source" : "block";
        void cursor.to({ by, value: place.line, file: place.file });
    }

    /** The panes in turn (F6). */
    nextPane(step: 1 | -1): void {
        const panes = [...document.querySelectorAll<HTMLElement>("[data-pane]")];
        const at = panes.findIndex((pane) => pane.contains(document.activeElement));
        panes[(at + step + panes.length) % panes.length]?.focus();
    }
}

function placeOf(finding: Finding): { file: string; line: number } | null {
    for (const { file, line } of [finding, ...(finding.places ?? [])]) {
        if (file && line) return { file, line };
    }
    return null;
}
