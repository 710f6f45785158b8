import { useSignal } from "@preact/signals";
import type { Finding } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";

const listed = (all: string[]): string => `${all.slice(0, -1).join(", ")} and ${all.at(-1)}`;

export function Save({ screen, close }: { screen: Screen; close(): void }) {
    const { studio } = screen;
    const board = studio.job.value?.board ?? null;
    const parts = studio.job.value?.parts.map(({ file }) => file) ?? [];
    const path = useSignal(board === null ? (studio.job.value?.program?.file.replace(/^.*\//, "") ?? "") : `${board.name}-programs`);
    const folder = studio.opened.value?.folder;
    const what = board === null
        ? `${listed(["The program", ...parts, "its report"])} are written into the folder “${folder}”.`
        : `${listed([...board.programs.map(({ file }) => file), "their report"])} are written into it. It lies in the folder “${folder}”.`;
    const replace = useSignal(false);
    const why = useSignal<Finding | null>(null);
    const save = async (event: Event): Promise<void> => {
        event.preventDefault();
        if (await studio.save(path.value, replace.value)) close();
        else {
            // It is said here, where it can be mended: the program is none the worse for it.
            why.value = studio.stopped.value[0] ?? null;
            studio.stopped.value = [];
        }
    };
    return (
        <form onSubmit={(event) => void save(event)}>
            <p>
                <label for="save-path">{board === null ? "Name of the program's file" : "Name of the folder for the programs"}</label>
                <input id="save-path" type="text" value={path.value} aria-describedby="save-what" onInput={(event) => (path.value = event.currentTarget.value)} />
            </p>
            <p class="soft" id="save-what">
                {what}
            </p>
            <p>
                <label>
                    <input type="checkbox" checked={replace.value} onChange={(event) => (replace.value = event.currentTarget.checked)} />{" "}
                    replace what is there
                </label>
            </p>
            {why.value !== null && (
                <div role="alert">
                    <p class="error">✗ {why.value.message}</p>
                    <p class="soft">→ {why.value.help}</p>
                </div>
            )}
            <button type="submit">Save</button>
        </form>
    );
}
