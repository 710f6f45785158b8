import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Job, Mismatch } from "../protocol/asks.ts";
import { readText } from "../protocol/text.ts";
import type { Screen } from "../screen/screen.ts";

/** The rows of the command's summary, and where a failed proof first differs. */
export function Verdict({ screen }: { screen: Screen }) {
    const job = screen.studio.job.value;
    if (job === null) return <p class="soft hint">No program yet.</p>;
    return (
        <div class="hint">
            {job.mismatch !== null && <SideBySide screen={screen} job={job} mismatch={job.mismatch} />}
            <table>
                <tbody>
                    {job.rows.map(([head, text], row) => (
                        <tr key={row}>
                            {head === "" ? <td /> : <th scope="row">{head}</th>}
                            <td>{text}</td>
                        </tr>
                    ))}
                </tbody>
            </table>
        </div>
    );
}

function SideBySide({ screen, job, mismatch }: { screen: Screen; job: Job; mismatch: Mismatch }) {
    const { seam, cursor } = screen.studio;
    const text = useSignal("");
    useEffect(() => {
        if (mismatch.source === 0) return;
        const line = { revision: job.revision, of: "source" as const, from: mismatch.source, to: mismatch.source + 1 };
        void readText(seam, line).then((read) => (text.value = read)).catch(() => {});
    }, [job.revision]);
    return (
        <section aria-label="First mismatch" class="sides">
            <div>
                <button type="button" onClick={() => void cursor.to({ by: "block", value: mismatch.program, file: mismatch.file })}>
                    ✗ {mismatch.file ?? job.program?.file} line {mismatch.program}
                </button>
                <div class="code">{mismatch.block}</div>
            </div>
            <div>
                <button type="button" disabled={mismatch.source === 0} onClick={() => void cursor.to({ by: "source", value: mismatch.source })}>
                    {job.source.file} {mismatch.source === 0 ? "" : `line ${mismatch.source}`}
                </button>
                <div class="code">{text.value || "nothing that makes this move"}</div>
            </div>
        </section>
    );
}
