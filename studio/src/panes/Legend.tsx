import { counted, rounded } from "../numbers.ts";
import type { Job } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { RAMP, RAMP_STEPS, RAPID, UNKNOWN, type Theme } from "../view/colours.ts";

/** The most that are named. */
const NAMED = 8;

const NAMES: Record<string, string> = { feed: "feed, straight", arc: "feed, arc", joints: "by joints", rapid: "rapid", pulse: "pulse" };

interface Entry {
    name: string;
    colour: string;
    isDashed?: boolean;
}

/** What the colours of the lines mean. */
export function Legend({ screen }: { screen: Screen }) {
    const job = screen.studio.job.value;
    const { mode, theme } = screen.looks.value;
    // Kinds are known as they come.
    void screen.news.value;
    if (job === null || screen.scene.value === null) return null;
    const ramp = rampOf(screen, job);
    const all = ramp === null ? entriesOf(screen, job, theme) : [];
    if (ramp === null && all.length === 0) return null;
    return (
        <ul class="legend" aria-label={`Colours by ${mode}`}>
            {ramp !== null && (
                <li>
                    {ramp[0]} <i class="ramp" style={{ backgroundImage: gradient(theme) }} /> {ramp[1]}
                </li>
            )}
            {ramp !== null && mode !== "order" && (
                <li>
                    <i style={{ background: css(theme.done[UNKNOWN]!) }} /> {mode === "feed" ? "no feed" : "not compared"}
                </li>
            )}
            {all.slice(0, NAMED).map(({ name, colour, isDashed }) => (
                <li key={name}>
                    <i class={isDashed ? "dashed" : ""} style={{ [isDashed ? "color" : "background"]: colour }} /> {name}
                </li>
            ))}
            {all.length > NAMED && <li>and {counted(all.length - NAMED)} more</li>}
        </ul>
    );
}

const css = (word: number): string => `rgb(${word & 255} ${(word >> 8) & 255} ${(word >> 16) & 255})`;

const gradient = ({ done }: Theme): string =>
    `linear-gradient(to right, ${[0, 1, 2, 3, 4, 5, 6].map((part) => css(done[RAMP + Math.round((part / 6) * (RAMP_STEPS - 1))]!)).join(", ")})`;

/** The ends of a ramp; null where the colours are single ones. */
function rampOf(screen: Screen, { walk }: Job): [string, string] | null {
    const mode = screen.mode.value;
    if (mode === "order") return ["first", "last"];
    if (mode === "deviation") return walk.deviation === null ? null : ["0", `${rounded(walk.deviation)} mm`];
    if (mode !== "feed") return null;
    const [least, most] = screen.feeds.value ?? [0, 0];
    return least > 0 ? [rounded(least), `${rounded(most)} mm/min`] : ["least", "greatest feed"];
}

function entriesOf(screen: Screen, { walk }: Job, { done }: Theme): Entry[] {
    const mode = screen.mode.value;
    const rapid: Entry[] = screen.rapids.value && screen.kinds.has(walk.kinds.indexOf("rapid")) ? [{ name: NAMES.rapid!, colour: css(done[RAPID]!), isDashed: true }] : [];
    if (mode === "tool") {
        const known = new Map(walk.tools.map(({ number, name }, place) => [`T${number} ${name}`.trim(), css(done[place & 63]!)]));
        return [...[...known].map(([name, colour]) => ({ name, colour })), ...rapid];
    }
    if (mode === "operation") return [...walk.operations.map(({ name }, place) => ({ name: name || `operation ${place + 1}`, colour: css(done[place % 64]!) })), ...rapid];
    if (mode === "deviation") return [{ name: "nothing is compared", colour: css(done[UNKNOWN]!) }];
    return [
        ...walk.kinds.flatMap((kind, place) => (screen.kinds.has(place) && kind !== "gap" && kind !== "rapid" ? [{ name: NAMES[kind] ?? kind, colour: css(done[place]!) }] : [])),
        ...rapid,
    ];
}
