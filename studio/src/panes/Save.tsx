import { useSignal } from "@preact/signals";
import type { Screen } from "../screen/screen.ts";

export function Save({ screen, close }: { screen: Screen; close(): void }) {
    const { studio } = screen;
    const board = studio.job.value?.board ?? null;
    const parts = studio.job.value?.parts.map(({ file }) => file) ?? [];
    const path = useSignal(board === null ? (studio.job.value?.program?.file.replace(/^.*\//, "") ?? "") : `${board.name}-programs`);
    const replace = useSignal(false);
    const why = useSignal<string | null>(null);
    const save = async (event: Event): Promise<void> => {
        event.preventDefault();
        if (await studio.save(path.value, replace.value)) close();
        else {
            // It is said here, where it can be mended: the program is none the worse for it.
            why.value = studio.stopped.value[0]?.message ?? "not saved";
            studio.stopped.value = [];
        }
    };
    return (
        <form onSubmit={(event) => void save(event)}>
            <p>
                <label for="save-path">
                    {board === null ? ["File", ...(parts.length === 0 ? [] : [`with ${parts.join(", ")} beside it`])].join(" ") : `Folder for ${board.programs.map(({ file }) => file).join(", ")} and the report`}, in {studio.opened.value?.folder}
                </label>
                <input id="save-path" type="text" value={path.value} onInput={(event) => (path.value = event.currentTarget.value)} />
            </p>
            <p>
                <label>
                    <input type="checkbox" checked={replace.value} onChange={(event) => (replace.value = event.currentTarget.checked)} />{" "}
                    replace what is there
                </label>
            </p>
            {why.value !== null && <p class="error">✗ {why.value}</p>}
            <button type="submit">Save</button>
        </form>
    );
}
