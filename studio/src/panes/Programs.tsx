import type { Screen } from "../screen/screen.ts";

/** The programs of a board: which one is shown, and those that could not be made. */
export function Programs({ screen }: { screen: Screen }) {
    const { studio } = screen;
    const job = studio.job.value;
    const board = job?.board ?? null;
    if (job === null || board === null) return null;
    return (
        <div class="programs" role="group" aria-label="Programs of the board">
            {board.programs.map(({ name, file, revision }) => (
                <button key={name} type="button" class="small" title={file} aria-pressed={revision === job.revision} onClick={() => void studio.chooseProgram(revision)}>
                    ✓ {name}
                </button>
            ))}
            {board.left_out.map(({ file, findings }) => (
                <button key={file} type="button" class="small error" title={findings[0]?.message} onClick={() => (screen.tab.value = "findings")}>
                    ✗ {file}
                </button>
            ))}
        </div>
    );
}
