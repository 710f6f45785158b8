import { counted } from "../numbers.ts";
import type { Screen } from "../screen/screen.ts";

/** What nobody knows is a dash. */
const number = (value: number | null | undefined, digits = 3): string => (value === null || value === undefined ? "–" : value.toFixed(digits));

/** Axes, feed, spindle and the rest at the cursor. */
export function Readout({ screen }: { screen: Screen }) {
    const place = screen.studio.cursor.place.value;
    const axes = screen.studio.job.value?.machine?.axes ?? [];
    const tool = screen.toolOf(place?.tool ?? null);
    const pointer = screen.pointer.value;
    const { net } = screen;
    const parts: [string, string, string][] = place === null ? [] : [
        ...axes.map(({ name, unit }, i): [string, string, string] => [name, number(place.axes[i]), unit]),
        ["Tip", place.tip.map((part) => number(part)).join("  "), "mm"],
        ["Feed", number(place.feed?.value, 0), place.feed?.unit ?? ""],
        ["Spindle", place.spindle === null ? "–" : `${place.spindle.turns} ${place.spindle.speed ?? ""}`, "1/min"],
        ["Coolant", place.coolant ?? "–", ""],
        ["Comp.", place.compensation ?? "–", ""],
        ["Cycle", place.cycle ?? "–", ""],
        ["Tool", tool === null ? "–" : `${tool.number} ${tool.name}`, ""],
        ["Move", `${counted(place.move + 1)} ${place.kind}`, ""],
    ];
    return (
        <dl class="readout" aria-label="At the cursor">
            {parts.map(([name, value, unit]) => (
                <div key={name}>
                    <dt>{name}</dt>
                    <dd>
                        {value} <small>{unit === "degrees" ? "°" : unit}</small>
                    </dd>
                </div>
            ))}
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
