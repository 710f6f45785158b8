import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { Programs } from "./Programs.tsx";
import type { Screen } from "../screen/screen.ts";
import { MORE, type Of } from "./more.ts";

/** Program or source. The cursor's line is lit; a line that one clicks becomes the cursor. */
export function TextPane({ screen, of }: { screen: Screen; of: Of }) {
    const { studio } = screen;
    const host = useRef<HTMLDivElement>(null);
    const compared = useSignal(false);
    const text = studio.job.value?.[of] ?? null;
    const parts = studio.job.value?.[MORE[of]] ?? [];
    const file = screen.files[of];
    const title = of === "program" ? "Program" : "Source";

    useEffect(() => {
        let end: (() => void) | null = () => {};
        // The editor is most of the page, and the picture does not wait for it.
        void screen.settled().then(() => import("./editing.ts")).then(({ keepUp }) => {
            if (end !== null) end = keepUp(screen, of, host.current!, compared);
        });
        return () => {
            end?.();
            end = null;
        };
    }, []);

    const isEdited = of === "program" && studio.edited.value !== null;
    return (
        <section class={`pane ${of}`} aria-label={title}>
            <header>
                <h2>
                    {title} <span class="soft">{(of === "program" ? studio.given.value : null) ?? text?.file}</span>
                </h2>
                {parts.length > 0 && (
                    <select aria-label={`File of the ${of}`} value={file.value ?? ""} onChange={(event) => screen.choose(of, event.currentTarget.value || null)}>
                        {[null, ...parts.map((part) => part.file)].map((name) => (
                            <option key={name} value={name ?? ""}>
                                {of === "program" && stateOf(screen, name)} {name ?? text?.file}
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

/** Whether a file has errors, or was edited. */
function stateOf({ studio }: Screen, file: string | null): string {
    const name = file ?? studio.job.value?.program?.file;
    const isWrong = studio.findings.value.some((finding) => finding.severity === "error" && finding.of === "program" && finding.file === name);
    return `${isWrong ? "✗" : ""}${studio.edited.value?.has(file) ? "▲" : ""}`;
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
