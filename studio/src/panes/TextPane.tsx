import { effect, untracked, useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { readText } from "../protocol/text.ts";
import type { Blocks, Job, Text } from "../protocol/asks.ts";
import { Programs } from "./Programs.tsx";
import type { Screen } from "../screen/screen.ts";
import { familyOf } from "../text/dialects.ts";
import { Editor, type Origin } from "../text/editor.ts";

type Of = "program" | "source";

/** Program or source. The cursor's line is lit; a line that one clicks becomes the cursor. */
export function TextPane({ screen, of }: { screen: Screen; of: Of }) {
    const { studio } = screen;
    const host = useRef<HTMLDivElement>(null);
    /** Of a program in several files, the called one that is shown; null: the program itself. */
    const file = useSignal<string | null>(null);
    const compared = useSignal(false);
    const text = studio.job.value?.[of] ?? null;
    const parts = of === "program" ? (studio.job.value?.parts ?? []) : [];
    const title = of === "program" ? "Program" : "Source";

    useEffect(() => keepUp(screen, of, host.current!, file, compared), []);

    const isEdited = of === "program" && studio.edited.value !== null;
    return (
        <section class={`pane ${of}`} aria-label={title}>
            <header>
                <h2>
                    {title} <span class="soft">{text?.file}</span>
                </h2>
                {parts.length > 0 && (
                    <select aria-label="File of the program" value={file.value ?? ""} onChange={(event) => (file.value = event.currentTarget.value || null)}>
                        <option value="">{text?.file}</option>
                        {parts.map((part) => (
                            <option key={part.file} value={part.file}>
                                {part.file}
                            </option>
                        ))}
                    </select>
                )}
                {of === "program" && <Programs screen={screen} />}
                {of === "program" && <Turns screen={screen} />}
                {isEdited && (
                    <>
                        <strong class="warning">▲ edited</strong>
                        <button type="button" aria-pressed={compared.value} onClick={() => (compared.value = !compared.value)}>
                            Differences
                        </button>
                        <button type="button" onClick={() => void studio.discard()}>
                            Discard
                        </button>
                    </>
                )}
            </header>
            <div class="body" data-pane ref={host} />
            {of === "program" && <Template screen={screen} />}
        </section>
    );
}

/** A block that moves often: which of its moves the cursor is at. */
function Turns({ screen }: { screen: Screen }) {
    const { place, ofBlock } = screen.studio.cursor;
    const ranges = ofBlock.value;
    const move = place.value?.move ?? 0;
    const all = ranges.reduce((sum, [from, to]) => sum + to - from, 0);
    if (all < 2) return null;
    const before = ranges.reduce((sum, [from, to]) => sum + Math.max(0, Math.min(to, move) - from), 0);
    return (
        <span>
            <button type="button" title="Previous move of this block (Shift P)" aria-label="Previous move of this block" onClick={() => void screen.studio.cursor.turn(-1)}>
                ‹
            </button>{" "}
            {before + 1} of {all}{" "}
            <button type="button" title="Next move of this block (P)" aria-label="Next move of this block" onClick={() => void screen.studio.cursor.turn(1)}>
                ›
            </button>
        </span>
    );
}

/** The template of the machine file that wrote the block. */
function Template({ screen }: { screen: Screen }) {
    const template = screen.studio.cursor.place.value?.template ?? null;
    if (template === null) return null;
    return (
        <footer class="template" role="group" aria-label="Template of the block" tabIndex={0}>
            <span class="soft">
                written by <b>{template.name}</b>
                {template.file === null ? ", built in" : `, ${template.file} line ${template.line}`}
            </span>
            <div class="code">{template.text}</div>
        </footer>
    );
}

/** The lines of a file. */
function linesOf(blocks: Blocks[], file: string | null): number[] {
    const ranges = blocks.filter((one) => one.file === file).flatMap((one) => one.ranges);
    return ranges.flatMap(([from, to]) => Array.from({ length: to - from }, (_, i) => from + i));
}

/** The editor in the host, as long as the pane is there. */
function keepUp(screen: Screen, of: Of, host: HTMLElement, file: Signal<string | null>, compared: Signal<boolean>): () => void {
    const { studio } = screen;
    const { cursor, seam } = studio;
    const editor = new Editor(host, of === "program" ? "Program" : "Source", {
        picked: (value) => {
            if (studio.edited.peek() !== null && !studio.isCurrent.peek()) return;
            void cursor.to({ by: of === "program" ? "block" : "source", value, file: file.peek() });
        },
        edited: (text) => studio.typed(text),
    });
    screen.editors[of] = editor;
    host.focus = () => editor.focus();
    let posted: string | null = null;

    const origin = (job: Job, text: Text): Origin => ({
        lines: job.parts.find((part) => part.file === file.value)?.lines ?? text.lines,
        family: of === "source" ? familyOf(null, text.file) : familyOf(job.machine.dialect, text.file),
        isEditable: of === "program" && job.parts.length === 0,
        read: (from, to) => readText(seam, { revision: job.revision, of, file: file.value, from, to }),
    });

    const stops = [
        effect(() => {
            const job = studio.job.value;
            const text = job?.[of] ?? null;
            const edited = of === "program" ? untracked(() => studio.edited.value) : null;
            if (job === null || text === null) {
                if (edited === null) void editor.show(null);
            } else if (edited !== null) editor.replace(edited, origin(job, text));
            else {
                void editor.show(origin(job, text)).then(() => (posted = editor.text)).catch(() => {});
            }
        }),
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
