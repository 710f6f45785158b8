/** What a pane of a text shows, and what is done in it: apart from the pane, which is there before its editor. */

import { effect, untracked, type Signal } from "@preact/signals";
import { readText } from "../protocol/text.ts";
import type { Blocks, Job, Text } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { familyOf } from "../text/dialects.ts";
import { Editor, type Origin } from "../text/editor.ts";

export type Of = "program" | "source";

/** What is chosen in the pane. */
export interface Shown {
    /** Of a program in several files, the called one; null: the program itself. */
    file: Signal<string | null>;
    /** Differences to the posted program. */
    compared: Signal<boolean>;
}

/** The lines of a file. */
function linesOf(blocks: Blocks[], file: string | null): number[] {
    const ranges = blocks.filter((one) => one.file === file).flatMap((one) => one.ranges);
    return ranges.flatMap(([from, to]) => Array.from({ length: to - from }, (_, i) => from + i));
}

/** The editor in the host, until it is ended. */
export function keepUp(screen: Screen, of: Of, host: HTMLElement, { file, compared }: Shown): () => void {
    const { studio } = screen;
    const { cursor, seam } = studio;
    let posted: string | null = null;
    const editor = new Editor(host, of === "program" ? "Program" : "Source", {
        picked: (value) => {
            if (studio.edited.peek() !== null && !studio.isCurrent.peek()) return;
            void cursor.to({ by: of === "program" ? "block" : "source", value, file: file.peek() });
        },
        edited: (text) => studio.typed(text),
        whole: (text) => {
            if (studio.edited.peek() === null) posted = text;
        },
    });
    screen.editors[of] = editor;
    host.focus = () => editor.focus();

    const origin = (job: Job, text: Text): Origin => ({
        lines: job.parts.find((part) => part.file === file.value)?.lines ?? text.lines,
        family: of === "source" ? familyOf(null, text.file) : familyOf(job.machine.dialect, text.file),
        isEditable: of === "program" && job.parts.length === 0,
        read: (from, to) => screen.reading.end(readText(seam, { revision: job.revision, of, file: file.value, from, to })),
    });

    // The line comes before the text, of which the lines round it come first.
    const stops = [
        effect(() => {
            const place = cursor.place.value;
            const line = (of === "program" ? place?.block : place?.source) ?? null;
            if (line !== null) file.value = line.file;
            const name = file.value ?? studio.job.value?.[of]?.file;
            const wrong = studio.findings.value.filter((finding) => finding.of === of && finding.line > 0 && finding.file === name).flatMap(({ line, lines }) => [line, ...lines]);
            const also = of === "program" && place?.source ? linesOf(place.blocks, file.value) : [];
            editor.mark({ at: line?.line ?? null, also, wrong: wrong.slice(0, 1000) });
        }),
        effect(() => {
            const job = studio.job.value;
            const text = job?.[of] ?? null;
            const edited = of === "program" ? untracked(() => studio.edited.value) : null;
            if (job === null || text === null) {
                if (edited === null) void editor.show(null);
            } else if (edited !== null) editor.replace(edited, origin(job, text));
            else void editor.show(origin(job, text)).catch(() => {});
        }),
        effect(() => {
            const on = compared.value && studio.edited.value !== null;
            void editor.compare(on ? posted : null);
        }),
    ];
    return () => {
        for (const stop of stops) stop();
        editor.close();
        delete screen.editors[of];
    };
}
