import type { Screen } from "../screen/screen.ts";

/** How many findings a program has; of an edit there is another mark. */
function Count({ findings }: { findings: number }) {
    const text = findings === 1 ? "1 finding" : `${findings} findings`;
    return (
        <>
            {" "}
            <span class="count" title={`${text}: choose the program, and look at Findings below`} aria-hidden="true">
                {findings}
            </span>
            <span class="unseen">, {text}</span>
        </>
    );
}

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
                    {findings > 0 && <Count findings={findings} />}
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
