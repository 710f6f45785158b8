import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { counted, rounded } from "../numbers.ts";
import type { Excursion, Job, Mismatch } from "../protocol/asks.ts";
import { readText } from "../protocol/text.ts";
import type { Screen } from "../screen/screen.ts";
import { Moves } from "./Moves.tsx";

/** The most places that are listed. */
const SHOWN = 400;

/** What is counted where moves are shown. */
export const MOVES = "as the control makes them: with ways home and to a tool change, retracts that it needs, and each stroke of a cycle. The proof counts moves of the toolpath";

/** The rows of the command's summary, and where a failed proof first differs. */
export function Verdict({ screen }: { screen: Screen }) {
    const job = screen.studio.job.value;
    if (job === null) return <p class="soft hint">No program yet.</p>;
    return (
        <div class="hint">
            {job.mismatch !== null && <SideBySide screen={screen} job={job} mismatch={job.mismatch} />}
            <table>
                <tbody>
                    {[...(job.board?.rows ?? []), ...job.rows].map(([head, text], row) => (
                        <tr key={row}>
                            {head === "" ? <td /> : <th scope="row">{head}</th>}
                            <td>{text}</td>
                        </tr>
                    ))}
                    {job.program !== null && job.machine.kind !== "glass" && (
                        <tr>
                            <th scope="row">in the view</th>
                            <td>
                                {counted(job.walk.moves)} moves, {MOVES}
                            </td>
                        </tr>
                    )}
                </tbody>
            </table>
            <Excursions screen={screen} job={job} />
            {job.board !== null && <Places screen={screen} />}
        </div>
    );
}

/** Where the tool leaves the cut and comes back to it. */
function Excursions({ screen, job }: { screen: Screen; job: Job }) {
    const { excursions, excursions_in_all: all } = job.walk;
    const text = ({ lift_mm }: Excursion): string => (lift_mm === 0 ? "home" : `${rounded(lift_mm)} mm along the tool`);
    return (
        <Moves screen={screen} moves={excursions} all={all} most={SHOWN} text={text}>
            <strong class="warning">△ {counted(all)}</strong> {all === 1 ? "excursion" : "excursions"} from a cut and back to it
        </Moves>
    );
}

/** What is to be looked at on the board: gaps that are not cut, copper that is taken. */
function Places({ screen }: { screen: Screen }) {
    const places = screen.board.value?.about.places ?? [];
    if (places.length === 0) return null;
    return (
        <ol class="findings" aria-label="Places to look at">
            {places.slice(0, SHOWN).map(({ x, y, what }, number) => (
                <li key={number}>
                    <button type="button" onClick={() => screen.toPlace(x, y)}>
                        ✗ X{x.toFixed(3)} Y{y.toFixed(3)}: {what}
                    </button>
                </li>
            ))}
            {places.length > SHOWN && <li class="soft">and {counted(places.length - SHOWN)} more</li>}
        </ol>
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
