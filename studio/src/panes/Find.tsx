import { useSignal } from "@preact/signals";
import type { Screen } from "../screen/screen.ts";
import { MORE } from "./more.ts";

/** Searches the whole text, which the page may not have: the server does. */
export function Find({ screen, close }: { screen: Screen; close(): void }) {
    const { studio, searched } = screen;
    const text = useSignal("");
    const from = useSignal(1);
    /** Of a text in several files, the one that is searched next. */
    const file = useSignal(screen.files[searched.value].value);
    const said = useSignal("");
    const next = async (): Promise<void> => {
        const job = studio.job.value;
        if (job === null || text.value === "") return;
        const of = searched.value;
        const files = [null, ...job[MORE[of]].map((part) => part.file)];
        // Behind the last line of a file the next one follows.
        for (let more = files.length; more >= 0; more--) {
            const { done } = await studio.seam.ask("search", { revision: job.revision, of, file: file.value, text: text.value, from: from.value });
            if (done.line !== null && (done.line >= from.value || files.length === 1)) {
                said.value = file.value === null ? `line ${done.line}` : `${file.value}, line ${done.line}`;
                from.value = done.line + 1;
                return studio.cursor.to({ by: of === "program" ? "block" : "source", value: done.line, file: file.value });
            }
            if (files.length === 1) break;
            file.value = files[(files.indexOf(file.value) + 1) % files.length]!;
            from.value = 1;
        }
        said.value = from.value > 1 ? "No more; Enter begins at the top." : "Nothing is found.";
        from.value = 1;
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
                    text.value = screen.found.value = event.currentTarget.value;
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
                    if (line === 0) return;
                    screen.choose(searched.value, file.value);
                    void screen.editors[searched.value]?.go(line);
                }}
            >
                Go there
            </button>
        </form>
    );
}
