import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { ToolUse } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { FACTORS, type Pace } from "../player.ts";

const two = (part: number): string => String(part).padStart(2, "0");

/** Minutes and seconds, with hours where there are any. */
export function clock(seconds: number): string {
    const whole = Math.floor(seconds);
    const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
    return h > 0 ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}.${Math.floor((seconds - whole) * 10)}`;
}

const STEPS = [
    { of: "tool", back: "«", on: "»", title: "tool" },
    { of: "block", back: "‹", on: "›", title: "block" },
] as const;

/** Pixels of the button of a tool. */
const BUTTON = 26;

/** Tools whose buttons do not lie over one another; the others are reached by a step. `pixel`: its time, s. */
export function apart(tools: ToolUse[], pixel: number): ToolUse[] {
    let last = Number.NEGATIVE_INFINITY;
    return tools.filter(({ time_s }) => {
        if ((time_s - last) / pixel < BUTTON) return false;
        last = time_s;
        return true;
    });
}

/** Where the cursor is in the machine's time. */
export function Timeline({ screen }: { screen: Screen }) {
    const { player, studio } = screen;
    const walk = studio.job.value?.walk ?? null;
    const length = walk?.time_s ?? 0;
    const time = studio.cursor.place.value?.time_s ?? 0;
    const tools = useRef<HTMLSpanElement>(null);
    const width = useSignal(0);
    useEffect(() => {
        const slide = tools.current!.parentElement!;
        const sizes = new ResizeObserver(() => (width.value = slide.clientWidth));
        sizes.observe(slide);
        return () => sizes.disconnect();
    }, []);
    const step = (by: 1 | -1) =>
        STEPS.map(({ of, back, on, title }) => (
            <button key={of} type="button" disabled={walk === null} aria-label={`${by === 1 ? "Next" : "Previous"} ${title}`} title={`${by === 1 ? "Next" : "Previous"} ${title}`} onClick={() => player.stepTo(by, of)}>
                {by === 1 ? on : back}
            </button>
        ));
    return (
        <section class="pane time" aria-label="Timeline">
            <div class="line">
                {step(-1)}
                <button type="button" class="play" disabled={walk === null} onClick={() => player.toggle()}>
                    {player.playing.value ? "Pause" : "Play"}
                </button>
                {step(1).toReversed()}
                <span class="slide">
                    <input
                        type="range"
                        aria-label="Time of the machine"
                        aria-valuetext={screen.isUntimed.value ? "time not known" : `${clock(time)} of ${clock(length)}`}
                        min={0}
                        max={length || 1}
                        step="any"
                        value={time}
                        disabled={walk === null}
                        data-pane
                        onInput={(event) => {
                            player.playing.value = false;
                            void studio.cursor.to({ by: "time", value: event.currentTarget.valueAsNumber });
                        }}
                    />
                    <span class="tools" ref={tools}>
                        {apart(walk?.tools ?? [], (length || 1) / Math.max(1, width.value)).map((tool) => (
                            <button
                                key={tool.move}
                                type="button"
                                style={{ left: `${(100 * tool.time_s) / (length || 1)}%` }}
                                title={`Tool ${tool.number} ${tool.name}`}
                                onClick={() => void studio.cursor.toMove(tool.move)}
                            >
                                T{tool.number}
                            </button>
                        ))}
                    </span>
                </span>
                {screen.isUntimed.value ? (
                    <span class="clock" title="The program states no feed: how long a cut takes is not known, and the replay goes as fast as the machine can">
                        time not known
                    </span>
                ) : (
                    <span class="clock">
                        {clock(time)} / {clock(length)}
                    </span>
                )}
                <Speed screen={screen} />
            </div>
        </section>
    );
}

const named = (pace: Pace): string => ("factor" in pace ? `f${pace.factor}` : `m${pace.metres}`);

/** A factor of the machine's time, or a speed of the cut in m/s. */
function Speed({ screen }: { screen: Screen }) {
    const { pace } = screen.player;
    const paces: Pace[] = [...FACTORS.map((factor) => ({ factor })), ...[0.01, 0.05, 0.1, 0.5, 1, 5].map((metres) => ({ metres }))];
    const all = paces.some((one) => named(one) === named(pace.value)) ? paces : [...paces, pace.value];
    return (
        <label>
            <span class="unseen">Speed of the replay</span>
            <select value={named(pace.value)} title="Speed of the replay (+ and -)" onChange={(event) => (pace.value = all.find((one) => named(one) === event.currentTarget.value)!)}>
                {all.map((one) => (
                    <option key={named(one)} value={named(one)}>
                        {"factor" in one ? `× ${one.factor}` : `${one.metres} m/s`}
                    </option>
                ))}
            </select>
        </label>
    );
}
