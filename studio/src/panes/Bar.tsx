import { counted } from "../numbers.ts";
import { MOVES } from "./Verdict.tsx";
import type { Screen } from "../screen/screen.ts";
import type { Job, Verdict, Work } from "../protocol/asks.ts";
import type { Studio } from "../studio.ts";
import { namesOf } from "../watch.ts";

const verdicts: Record<Verdict, string> = {
    done: "✓ PROVEN",
    partly: "◐ PARTLY PROVEN",
    failed: "✗ NOT PROVEN",
    invalid: "✗ NOT POSTED",
    cancelled: "■ CANCELLED",
};

const nameOf = ({ source, name }: Work): string => name ?? Object.values(source).flat().join(", ").replace(/^.*\//, "");

export function Bar({ screen }: { screen: Screen }) {
    const { studio, dialog } = screen;
    const { work, machine, job, running, link, stop } = studio;
    const name = work.value === null ? "Open a source…" : nameOf(work.value);
    return (
        <header class="bar">
            <h1>Toolpost</h1>
            <button type="button" title="Open a source (Ctrl O)" onClick={() => (dialog.value = "source")}>
                {name}
            </button>
            <button type="button" title="Choose the machine (Ctrl M)" onClick={() => (dialog.value = "machine")}>
                {machine.value ?? "Choose a machine…"}
            </button>
            <button type="button" onClick={() => screen.toOption("")}>
                Options
            </button>
            <output class="grow" aria-live="polite">
                {running.value !== null ? <Running screen={screen} /> : <VerdictOf job={job.value} stop={stop.value} isCurrent={studio.isCurrent.value} />}{" "}
                {studio.stop.value === "cancelled" && studio.edited.value !== null && running.value === null && (
                    <button type="button" onClick={() => void studio.prove(studio.edited.value!)}>
                        Prove
                    </button>
                )}
            </output>
            {link.value !== "open" && <strong class="bad error">{links[link.value]}</strong>}
            {studio.isAlone.value && (link.value !== "open" || studio.notKept.value !== null) && <Alone studio={studio} />}
            {studio.gone.value.length > 0 && (
                <strong class="warning" role="status">
                    ▲ {namesOf(studio.gone.value)} {studio.gone.value.length === 1 ? "is" : "are"} not there any more: what was read before is shown
                </strong>
            )}
            <span class="soft" role="status">
                {studio.said.value}
            </span>
            {studio.offers.value.slice(0, 1).map((draft) => (
                <span key={draft.name}>
                    ▲ an edit of {nameOf(draft.of as Work)} is kept{studio.offers.value.length > 1 && ` (and ${studio.offers.value.length - 1} more)`}{" "}
                    <button type="button" onClick={() => void studio.resume(draft)}>
                        Continue
                    </button>{" "}
                    <button type="button" onClick={() => void studio.dropDraft(draft.name)}>
                        Delete it
                    </button>
                </span>
            ))}
            <button type="button" disabled={!studio.canSave.value} onClick={() => (dialog.value = "save")}>
                Save…
            </button>
            <button type="button" onClick={() => (dialog.value = "commands")}>
                Commands <kbd>Ctrl K</kbd>
            </button>
        </header>
    );
}

const links = {
    connecting: "connecting…",
    lost: "connection lost; connecting again…",
    refused: "the link is not of this server: paste the link that `toolpost studio` printed last into this tab",
    open: "",
};

/** While there is no server, or it cannot write, the edit is in this page alone. */
function Alone({ studio }: { studio: Studio }) {
    const download = (): void => {
        for (const [file, text] of studio.unkept?.edit ?? []) {
            const link = document.createElement("a");
            link.href = URL.createObjectURL(new Blob([text]));
            link.download = file ?? studio.job.value?.program?.file ?? "program.txt";
            link.click();
            setTimeout(() => URL.revokeObjectURL(link.href), 1000);
        }
    };
    return (
        <span>
            <strong class="warning">▲ your edit is in this page alone{studio.link.value === "open" && `: ${studio.notKept.value}`}</strong>{" "}
            <button type="button" onClick={download}>
                Download it
            </button>
        </span>
    );
}

function Running({ screen }: { screen: Screen }) {
    const { running } = screen.studio;
    const part = running.value?.part ?? null;
    return (
        <>
            {running.value?.step}… <progress aria-label="Progress" {...(part === null ? {} : { value: part })} />{" "}
            <button type="button" onClick={() => screen.studio.cancel()}>
                Cancel
            </button>
        </>
    );
}

/** The verdict is of the program as it stands on the page, or there is none. */
function VerdictOf({ job, stop, isCurrent }: { job: Job | null; stop: Verdict | null; isCurrent: boolean }) {
    if (job === null && stop === null) return <span class="soft">no program yet</span>;
    if (job === null) return stop === "cancelled" ? <strong>{verdicts.cancelled}</strong> : <strong class="invalid">{verdicts.invalid}</strong>;
    if (!isCurrent && stop === "invalid") return <strong class="failed">{verdicts.failed}</strong>;
    if (!isCurrent) return <strong class="warning">▲ {stop === "cancelled" ? "NOT PROVEN: CANCELLED" : "TO BE PROVEN"}</strong>;
    if (job.program === null) return <strong class="failed">{verdicts.invalid}</strong>;
    const isPartly = job.board?.verdict === "partly" && job.verdict === "done";
    const moves = `${counted(job.walk.moves)} ${job.machine.kind === "glass" ? "pulses" : "moves"}`;
    return (
        <>
            <strong class={isPartly ? "partly" : job.verdict}>{isPartly ? "◐ PROVEN, PARTLY MADE" : verdicts[job.verdict]}</strong> <span title={MOVES}>{moves}</span>
        </>
    );
}
