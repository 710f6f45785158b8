import type { RefObject } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { counted, rounded } from "../numbers.ts";
import type { Axis } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";

/** What nobody knows is a dash. */
const number = (value: number | null | undefined, digits = 3): string => (value === null || value === undefined ? "–" : value.toFixed(digits));

/** Feeds and speeds: a feed a turn may be 0.05 mm, and a robot's speed is that of a step of its output. */
const rate = (value: number | null | undefined): string => (value === null || value === undefined ? "–" : String(Number(value.toFixed(3))));

/** Why an axis or the tip is a dash. */
export const UNKNOWN =
    "The program alone does not tell: it depends on what is set at the machine, behind a way home or a retract in machine coordinates, or while the control leads the tip of a tool whose length is not given";

/** Why something else is. */
const NOT_SAID = "None, or the program has not said it so far";

/** Axes, feed, spindle and the rest at the cursor. */
export function Readout({ screen }: { screen: Screen }) {
    const place = screen.studio.cursor.place.value;
    const axes = screen.studio.job.value?.machine?.axes ?? [];
    const tool = screen.toolOf(place?.tool ?? null);
    const pointer = screen.pointer.value;
    const { net } = screen;
    const list = useRef<HTMLDListElement>(null);
    useEffect(() => keepHeight(list), [axes.length]);
    const job = screen.studio.job.value;
    const isGlass = job?.machine.kind === "glass";
    const own: [string, string, string][] = place === null ? [] : [
        ...axes.map(({ name, unit }, i): [string, string, string] => [name, number(place.axes[i]), unit]),
        [isGlass ? "Focus" : "Tip", place.tip.map((part) => number(part)).join("  "), "mm"],
    ];
    const from = screen.from.value;
    const way = from === null || place === null ? null : place.tip.map((part, i) => (part === null ? null : part - from[i]!));
    const length = way?.includes(null) === false ? Math.hypot(...(way as number[])) : null;
    const parts: [string, string, string][] = place === null ? [] : isGlass ? [
        ...own,
        ["Pulse", `${counted(place.move + 1)} of ${counted(job.walk.moves)}`, ""],
    ] : [
        ...own,
        ["Feed", rate(place.feed?.value), place.feed?.unit ?? ""],
        ["Spindle", place.spindle === null ? "–" : `${place.spindle.turns} ${place.spindle.speed === null ? "" : rate(place.spindle.speed)}`, "1/min"],
        ["Coolant", place.coolant ?? "–", ""],
        ["Comp.", place.compensation ?? "–", ""],
        ["Cycle", place.cycle ?? "–", ""],
        ["Tool", tool === null ? "–" : `${tool.number} ${tool.name}`, ""],
        ["Move", `${counted(place.move + 1)} ${place.kind}`, ""],
    ];
    return (
        <dl ref={list} class="readout" aria-label="At the cursor">
            {parts.map(([name, value, unit], row) => (
                <div key={name} title={why(value, row <= axes.length) ?? travelOf(axes[row], place?.axes[row])}>
                    <dt>{name}</dt>
                    <dd>
                        {value} <small>{unit === "degrees" ? "°" : unit}</small>
                        <Travel axis={axes[row]} at={place?.axes[row]} />
                    </dd>
                </div>
            ))}
            {way !== null && (
                <div title="From the place that was marked (D) to this one">
                    <dt>Measured</dt>
                    <dd>
                        {way.map((part) => number(part)).join("  ")}, {number(length)} <small>mm</small>
                    </dd>
                </div>
            )}
            {pointer !== null && (
                <div class="soft">
                    <dt>Pointer</dt>
                    <dd>{pointer.map((value) => value.toFixed(3)).join(" ")}</dd>
                </div>
            )}
            {net !== null && (
                <div>
                    <dt>Net</dt>
                    <dd>{net}</dd>
                </div>
            )}
        </dl>
    );
}

const shown = (axis: Axis | undefined): axis is Axis & { low: number; high: number } => typeof axis?.low === "number" && typeof axis.high === "number";

/** The travel of an axis, and how much of it is left. */
function travelOf(axis: Axis | undefined, at: number | null | undefined): string | undefined {
    if (axis === undefined) return undefined;
    if (!shown(axis)) return `The travel of ${axis.name} is not known, or does not count from the zero of this program`;
    const { name, low, high } = axis;
    const unit = axis.unit === "degrees" ? "°" : " mm";
    const left = typeof at === "number" ? Math.min(at - low, high - at) : null;
    const rest = left === null ? "" : left < 0 ? `, ${rounded(-left)}${unit} beyond it` : `, ${rounded(left)}${unit} left to the nearer end`;
    return `Travel of ${name}: ${rounded(low)} to ${rounded(high)}${unit}${rest}`;
}

/** Where in its travel an axis stands. */
function Travel({ axis, at }: { axis: Axis | undefined; at: number | null | undefined }) {
    if (!shown(axis) || typeof at !== "number") return null;
    const part = (at - axis.low) / (axis.high - axis.low);
    return (
        <span class={part < 0 || part > 1 ? "travel beyond" : "travel"} role="img" aria-label={travelOf(axis, at)}>
            <i style={{ left: `${Math.max(0, Math.min(1, part)) * 100}%` }} />
        </span>
    );
}

/** What needs more lines for a while keeps them: else the picture above would change its size with each place, and with the pointer. */
function keepHeight(list: RefObject<HTMLElement | null>): () => void {
    const element = list.current!;
    let width = -1;
    const sizes = new ResizeObserver(() => {
        if (element.offsetWidth !== width) element.style.minHeight = "";
        width = element.offsetWidth;
        element.style.minHeight = `${element.offsetHeight}px`;
    });
    sizes.observe(element);
    return () => sizes.disconnect();
}

/** Why there is a dash, where there is one: the axes and the tip come first. */
function why(value: string, isPosition: boolean): string | undefined {
    if (!value.includes("–")) return undefined;
    return isPosition ? UNKNOWN : NOT_SAID;
}
