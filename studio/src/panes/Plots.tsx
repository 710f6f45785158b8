import { effect, useComputed, useSignal, type ReadonlySignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { Newest } from "../newest.ts";
import { counted, rounded } from "../numbers.ts";
import type { Axis, Job, Jump } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import type { Theme } from "../view/colours.ts";
import { Moves } from "./Moves.tsx";
import { clock } from "./Timeline.tsx";

type Span = [from: number, to: number];

/** Axes, feed and deviation over the machine's time, with the limits of the axes. */
export function Plots({ screen }: { screen: Screen }) {
    const job = screen.studio.job.value;
    const length = job?.walk.time_s ?? 0;
    const zoomed = useSignal<Span | null>(null);
    const span = useComputed((): Span => zoomed.value ?? [0, screen.studio.job.value?.walk.time_s ?? 0]);
    if (job === null || length === 0) return <p class="soft hint">No times yet.</p>;
    const zoom = (by: number): void => {
        const middle = screen.studio.cursor.place.value?.time_s ?? length / 2;
        const half = Math.min(length, (span.value[1] - span.value[0]) * by) / 2;
        const from = Math.max(0, Math.min(length - 2 * half, middle - half));
        zoomed.value = [from, from + 2 * half];
    };
    const plain = (name: string, unit: string): Axis => ({ name, unit, kind: "linear", low: null, high: null });
    // Pulses have no feed.
    const feed = job.machine.kind === "glass" ? [] : [plain("feed", "mm/min")];
    const axes = [...job.machine.axes, ...feed, ...(job.walk.deviation === null ? [] : [plain("deviation", "mm")])];
    return (
        <div class="plots">
            <p>
                <button type="button" onClick={() => zoom(0.25)}>
                    Zoom to the cursor
                </button>{" "}
                <button type="button" onClick={() => (zoomed.value = null)}>
                    All
                </button>{" "}
                <span class="soft">
                    {clock(span.value[0])} to {clock(span.value[1])}; dashed lines are limits, where they are near
                </span>
            </p>
            <Jumps screen={screen} job={job} />
            {axes.map((axis, number) => (
                <Plot key={axis.name} screen={screen} axis={axis} number={number} span={span} />
            ))}
        </div>
    );
}

/** More than these nobody looks through. */
const LISTED = 200;

/** Cuts in which a rotary axis turns far: where a tool may swing the wrong way. */
function Jumps({ screen, job }: { screen: Screen; job: Job }) {
    const { jumps, jumps_in_all: all } = job.walk;
    const text = ({ axis, from, to }: Jump): string => `${job.machine.axes[axis]?.name} ${rounded(from)}° → ${rounded(to)}°`;
    return (
        <Moves screen={screen} moves={jumps} all={all} most={LISTED} text={text}>
            <strong class="warning">▼ {counted(all)}</strong> {all === 1 ? "cut turns a rotary axis" : "cuts turn a rotary axis"} by more than 30°
        </Moves>
    );
}

interface Band {
    least: Float32Array;
    most: Float32Array;
}

function Plot({ screen, axis, number, span }: { screen: Screen; axis: Axis; number: number; span: ReadonlySignal<Span> }) {
    const canvas = useRef<HTMLCanvasElement>(null);
    const band = useSignal<Band | null>(null);
    const { studio } = screen;

    useEffect(() => {
        const asked = new Newest<{ revision: number; span: Span }>(async ({ revision, span: [from, to] }) => {
            const pixels = Math.max(1, Math.min(4000, canvas.current?.clientWidth ?? 600));
            try {
                const { arrays } = await studio.seam.ask("plot", { revision, what: axis.name, from, to, pixels });
                band.value = { least: arrays.least as Float32Array, most: arrays.most as Float32Array };
            } catch {
                band.value = null;
            }
        });
        const stops = [
            effect(() => {
                const revision = studio.job.value?.revision;
                if (revision !== undefined) void asked.ask({ revision, span: span.value });
            }),
            effect(() => {
                const time = studio.cursor.place.value?.time_s ?? null;
                const jumps = studio.job.value?.walk.jumps.filter((jump) => jump.axis === number) ?? [];
                if (canvas.current !== null) draw(canvas.current, { axis, band: band.value, jumps }, span.value, time, screen.looks.value.theme);
            }),
        ];
        return () => {
            for (const stop of stops) stop();
        };
    }, []);

    const known = band.value === null ? [] : extent(band.value);
    const unit = axis.unit === "degrees" ? "°" : axis.unit;
    return (
        <figure class="plot">
            <figcaption>
                <div>
                    {axis.name} <span class="soft">{known.length === 2 ? `${rounded(known[0]!)} … ${rounded(known[1]!)} ${unit}` : "–"}</span>
                </div>
                <Limits axis={axis} known={known} unit={unit} />
            </figcaption>
            <canvas
                ref={canvas}
                role="img"
                aria-label={`${axis.name} over time`}
                onClick={(event) => {
                    const { left, width } = event.currentTarget.getBoundingClientRect();
                    const [from, to] = span.value;
                    void studio.cursor.to({ by: "time", value: from + ((event.clientX - left) / width) * (to - from) });
                }}
            />
        </figure>
    );
}

/** The travel, and the least that is left of it in what is shown: limits far away are in no curve. */
function Limits({ axis: { low, high }, known: [least, most], unit }: { axis: Axis; known: number[]; unit: string }) {
    if (low === null && high === null) return null;
    const left = Math.min(least === undefined || low === null ? Infinity : least - low, most === undefined || high === null ? Infinity : high - most);
    const end = (limit: number | null): string => (limit === null ? "∞" : rounded(limit));
    return (
        <small class="soft">
            travel {end(low)} … {end(high)} {unit}
            {left < 0 && <strong class="error"> ✗ {rounded(-left)} beyond</strong>}
            {left >= 0 && left < Infinity && `, ${rounded(left)} left`}
        </small>
    );
}

/** Least and most of what is known. */
function extent({ least, most }: Band): number[] {
    let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
    for (const value of least) if (value < low) low = value;
    for (const value of most) if (value > high) high = value;
    return low <= high ? [low, high] : [];
}

interface Curve {
    axis: Axis;
    band: Band | null;
    jumps: Jump[];
}

function draw(canvas: HTMLCanvasElement, { axis, band, jumps }: Curve, [from, to]: Span, time: number | null, { ink, soft, warn }: Pick<Theme, "ink" | "soft" | "warn">): void {
    const { clientWidth: width, clientHeight: height } = canvas;
    const ratio = Math.min(2, devicePixelRatio);
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const context = canvas.getContext("2d")!;
    context.scale(ratio, ratio);
    const [low, high] = band === null ? [] : extent(band);
    if (band === null || low === undefined || high === undefined) return;
    const limits = [axis.low, axis.high].filter((limit) => typeof limit === "number");
    // Limits far away would flatten the curve: they are drawn where they are near.
    const spread = Math.max(high - low, 1e-6);
    const near = limits.filter((limit) => limit > low - spread && limit < high + spread);
    const [bottom, top] = [Math.min(low, ...near) - spread * 0.05, Math.max(high, ...near) + spread * 0.05];
    const y = (value: number): number => height - ((value - bottom) / (top - bottom)) * height;

    context.fillStyle = ink;
    const step = width / band.least.length;
    band.least.forEach((least, pixel) => {
        const [high, low] = [y(band.most[pixel]!), y(least)];
        if (Number.isFinite(high)) context.fillRect(pixel * step, high, Math.max(1, step), Math.max(1, low - high));
    });
    context.strokeStyle = soft;
    context.setLineDash([6, 4]);
    for (const limit of near) {
        context.beginPath();
        context.moveTo(0, y(limit));
        context.lineTo(width, y(limit));
        context.stroke();
    }
    context.setLineDash([]);
    context.fillStyle = warn;
    for (const { time_s } of jumps) {
        const x = ((time_s - from) / (to - from)) * width;
        context.beginPath();
        context.moveTo(x - 5, 0);
        context.lineTo(x + 5, 0);
        context.lineTo(x, 8);
        context.fill();
    }
    if (time !== null && time >= from && time <= to) {
        context.strokeStyle = "#d9480f";
        const x = ((time - from) / (to - from)) * width;
        context.strokeRect(x, -1, 0.5, height + 2);
    }
}
