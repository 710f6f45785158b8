import { useSignal } from "@preact/signals";
import type { Where } from "../cursor.ts";
import type { Screen } from "../screen/screen.ts";

/** `120` is a line of the program, `s120` one of the source, `m5000` a move, `3:12` or `12.5 s` a time. */
export function whereOf(text: string): Where | null {
    const trimmed = text.trim().toLowerCase();
    const time = /^(?:(\d+):)?(?:(\d+):)?(\d+(?:\.\d+)?)\s*s?$/.exec(trimmed);
    const line = /^([nsm]?)\s*(\d+)$/.exec(trimmed);
    if (line !== null) {
        const value = Number(line[2]);
        if (line[1] === "m") return { by: "move", value: Math.max(0, value - 1) };
        return { by: line[1] === "s" ? "source" : "block", value };
    }
    if (time === null) return null;
    const parts = [time[1], time[2], time[3]].filter((part) => part !== undefined).map(Number);
    return { by: "time", value: parts.reduce((sum, part) => sum * 60 + part, 0) };
}

export function Go({ screen, close }: { screen: Screen; close(): void }) {
    const text = useSignal("");
    const where = whereOf(text.value);
    return (
        <form
            onSubmit={(event) => {
                event.preventDefault();
                if (where === null) return;
                close();
                void screen.studio.cursor.to({ ...where, file: where.by === "block" ? screen.files.program.value : where.by === "source" ? screen.files.source.value : null });
            }}
        >
            <label for="go">Line of the program (120), line of the source (s120), move (m5000) or time (3:12, 12.5 s)</label>
            <input id="go" type="text" value={text.value} onInput={(event) => (text.value = event.currentTarget.value)} />
            <p class="soft">{where === null ? " " : `${where.by} ${where.value}`}</p>
        </form>
    );
}
