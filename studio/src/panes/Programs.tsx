import type { Screen } from "../screen/screen.ts";

/** The programs of a board: which one is shown, and those that could not be made. */
export function Programs({ screen }: { screen: Screen }) {
    const { studio } = screen;
    const board = studio.board.value;
    const job = studio.job.value;
    if (board === null || job === null) return null;
    if (studio.edited.value !== null) {
        return <span class="soft">of {board.name}: save or discard the edit to see its other programs</span>;
    }
    return (
        <div class="programs" role="group" aria-label="Programs of the board">
            {board.programs.map(({ name, file, revision, findings }) => (
                <button
                    key={name}
                    type="button"
                    class="small"
                    title={file}
                    aria-pressed={file === job.program?.file}
                    onClick={() => void studio.chooseProgram(revision)}
                >
                    ✓ {name}
                    {findings > 0 && <span title={`${findings} findings`}> ▲</span>}
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
