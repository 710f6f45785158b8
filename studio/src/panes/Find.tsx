import { useSignal } from "@preact/signals";
import type { Screen } from "../screen/screen.ts";

/** Searches the whole text, which the page may not have: the server does. */
export function Find({ screen, close }: { screen: Screen; close(): void }) {
    const { studio, searched } = screen;
    const text = useSignal("");
    const from = useSignal(1);
    const said = useSignal("");
    const next = async (): Promise<void> => {
        const job = studio.job.value;
        if (job === null || text.value === "") return;
        const of = searched.value;
        const { done } = await studio.seam.ask("search", { revision: job.revision, of, text: text.value, from: from.value });
        if (done.line === null) {
            said.value = from.value > 1 ? "No more; Enter begins at the top." : "Nothing is found.";
            from.value = 1;
            return;
        }
        said.value = `line ${done.line}`;
        from.value = done.line + 1;
        await studio.cursor.to({ by: of === "program" ? "block" : "source", value: done.line });
    };
    return (
        <form
            onSubmit={(event) => {
                event.preventDefault();
                void next();
            }}
        >
            <label for="find">Text in the {searched.value}; Enter finds the next</label>
            <input
                id="find"
                type="text"
                value={text.value}
                onInput={(event) => {
                    text.value = event.currentTarget.value;
                    from.value = 1;
                }}
            />
            <p aria-live="polite">{said.value}</p>
            <button type="submit">Next</button>{" "}
            <button
                type="button"
                onClick={() => {
                    const line = from.value - 1;
                    close();
                    if (line > 0) void screen.editors[searched.value]?.go(line);
                }}
            >
                Go there
            </button>
        </form>
    );
}
