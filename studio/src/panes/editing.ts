/** What a pane of a text shows, and what is done in it: apart from the pane, which is there before its editor. */

import { effect, untracked, type Signal } from "@preact/signals";
import { readText } from "../protocol/text.ts";
import type { Blocks, Job, Text } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { familyOf } from "../text/dialects.ts";
import { Editor, type Origin } from "../text/editor.ts";
import { MORE, type Of } from "./more.ts";

/** The lines of a file. */
function linesOf(blocks: Blocks[], file: string | null): number[] {
    const ranges = blocks.filter((one) => one.file === file).flatMap((one) => one.ranges);
    return ranges.flatMap(([from, to]) => Array.from({ length: to - from }, (_, i) => from + i));
}

/** The editor in the host, until it is ended; `compared`: differences to the posted program. */
export function keepUp(screen: Screen, of: Of, host: HTMLElement, compared: Signal<boolean>): () => void {
    const { studio } = screen;
    const { cursor, seam } = studio;
    const file = screen.files[of];
    const editor = new Editor(host, of === "program" ? "Program" : "Source", {
        picked: (value, file) => {
            if (studio.edited.peek() !== null && !studio.isCurrent.peek()) return;
            void cursor.to({ by: of === "program" ? "block" : "source", value, file });
        },
        edited: (text, file) => {
            screen.choose(of, file);
            studio.typed(text, file);
        },
        whole: (text, file) => {
            if (of === "program" && !studio.edited.peek()?.has(file)) studio.posted.set(file, text);
        },
    });
    screen.editors[of] = editor;
    host.focus = () => editor.focus();

    const origin = (job: Job, text: Text, file: string | null): Origin => ({
        file,
        program: studio.program,
        lines: text.lines,
        family: of === "source" ? familyOf(null, text.file) : familyOf(job.machine.dialect, text.file),
        isEditable: of === "program",
        read: (from, to) => screen.reading.end(readText(seam, { revision: job.revision, of, file, from, to })),
    });

    // The line comes before the text, of which the lines round it come first.
    const stops = [
        effect(() => {
            const place = cursor.place.value;
            const line = (of === "program" ? place?.block : place?.source) ?? null;
            if (line !== null && cursor.answers > screen.chosen[of]) file.value = line.file;
        }),
        effect(() => {
            const place = cursor.place.value;
            const line = (of === "program" ? place?.block : place?.source) ?? null;
            const name = file.value ?? studio.job.value?.[of]?.file;
            const wrong = studio.findings.value.filter((finding) => finding.of === of && finding.line > 0 && finding.file === name).flatMap(({ line, lines }) => [line, ...lines]);
            const also = of === "program" && place?.source ? linesOf(place.blocks, file.value) : [];
            editor.mark({ at: line?.file === file.value ? line.line : null, also, wrong: wrong.slice(0, 1000), found: screen.searched.value === of ? screen.found.value : "" });
        }),
        effect(() => {
            const job = studio.job.value;
            const name = file.value;
            const text = (name === null ? job?.[of] : job?.[MORE[of]].find((part) => part.file === name)) ?? null;
            const edit = of === "program" ? untracked(() => studio.edited.value) : null;
            if (job === null || text === null) {
                if (name !== null && job !== null) file.value = null;
                else if (edit === null) void editor.show(null);
                return;
            }
            const edited = edit?.get(name);
            if (edited !== undefined) editor.replace(edited, origin(job, text, name));
            else void editor.show(origin(job, text, name), edit !== null).catch(() => {});
        }),
        effect(() => editor.hold(studio.isPosting.value)),
        effect(() => {
            void studio.job.value;
            const isEdited = of === "program" && studio.edited.value?.has(file.value);
            void editor.compare(compared.value && isEdited ? (studio.posted.get(file.value) ?? null) : null);
        }),
    ];
    return () => {
        for (const stop of stops) stop();
        editor.close();
        delete screen.editors[of];
    };
}
