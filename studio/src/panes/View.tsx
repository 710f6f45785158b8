import { effect, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { Entry } from "../protocol/asks.ts";
import { offered } from "../text/names.ts";
import { counted } from "../numbers.ts";
import { axisOf, vector, type Screen } from "../screen/screen.ts";
import type { Studio } from "../studio.ts";
import { VIEWS } from "../view/camera.ts";
import { MODES } from "../view/colours.ts";
import { Viewer } from "../view/viewer.ts";
import { Legend } from "./Legend.tsx";
import { Readout, UNKNOWN } from "./Readout.tsx";

/** The picture of the walk: one view, or four. */
export function View({ screen }: { screen: Screen }) {
    const { four, mode, rapids, ruler, box } = screen;
    return (
        <section class="pane view" aria-label="View">
            <header>
                <h2>View</h2>
                {VIEWS.map(({ name }, number) => (
                    <button key={name} type="button" title={`${name} (${number + 1})`} aria-label={`${number + 1} ${name}`} onClick={() => screen.viewer?.view(number)}>
                        {number + 1}
                    </button>
                ))}
                <button type="button" title="Fit what is cut; again: all (F)" onClick={() => screen.viewer?.fit()}>
                    Fit
                </button>
                <Toggle on={four} title="Four views (Q)" text="Four" />
                <Toggle on={rapids} title="Rapids (R)" text="Rapids" />
                <Toggle on={screen.axes} title="Tool axes (V)" text="Axes" />
                <Toggle on={screen.machine} title="Machine (M)" text="Machine" />
                <Toggle on={box} title="Box of all moves (B)" text="Box" />
                <Toggle on={ruler} title="Ruler (L)" text="Ruler" />
                <label>
                    <span class="unseen">Colour by</span>
                    <select title="Colours by (C)" value={mode.value} onChange={(event) => (mode.value = event.currentTarget.value as typeof mode.value)}>
                        {MODES.map(({ name, title }) => (
                            <option key={name} value={name}>
                                {title}
                            </option>
                        ))}
                    </select>
                </label>
            </header>
            <div class={four.value ? "body views four" : "body views"}>
                {(four.value ? [5, 0, 1, 2] : [5]).map((view, number) => (
                    <One key={view} screen={screen} view={view} first={number === 0} />
                ))}
                <Legend screen={screen} />
                <MachineAbsent screen={screen} />
                {screen.off.value > 0 && <p class="off soft">{coarse(screen.off.value)}</p>}
                <Proving screen={screen} />
                {screen.studio.job.value === null && screen.studio.running.value === null && <Empty screen={screen} />}
            </div>
            <Readout screen={screen} />
        </section>
    );
}

/** Why the machine is not drawn. */
function MachineAbsent({ screen }: { screen: Screen }) {
    const unknown = screen.machine.value ? screen.unknownAxes : [];
    if (unknown.length === 0) return null;
    return (
        <p class="absent soft" title={UNKNOWN}>
            machine not drawn here: where {unknown.join(", ")} {unknown.length === 1 ? "stands" : "stand"} is not known. So it is before the first moves, behind a way home, and by a tool whose length is not given: go on to another move
        </p>
    );
}

const coarse = (off: number): string =>
    Number.isFinite(off) ? `lines are up to ${counted(off)} pixels off here: finer ones are coming, or are too many` : "lines are coarse here: finer ones are coming";

function Toggle({ on, title, text }: { on: { value: boolean }; title: string; text: string }) {
    return (
        <button type="button" title={title} aria-pressed={on.value} onClick={() => (on.value = !on.value)}>
            {text}
        </button>
    );
}

function One({ screen, view, first }: { screen: Screen; view: number; first: boolean }) {
    const host = useRef<HTMLDivElement>(null);
    useEffect(() => {
        const { studio } = screen;
        const viewer = new Viewer(
            host.current!,
            view,
            () => {
                const place = studio.cursor.place.value;
                const at = place === null ? null : vector(place.tip);
                const tip = place === null || at === null ? null : { at, axis: axisOf(place.axis) };
                return { scene: screen.scene.value, looks: screen.looks.value, marks: screen.marks(), tip, box: screen.all, isBoxShown: screen.box.value };
            },
            (what) => screen.boxOf(what),
            {
                picked: (move) => void studio.cursor.toMove(move),
                pointed: (at) => (screen.pointer.value = at),
                off: (pixels) => screen.offBy(view, pixels),
                drawn: () => screen.drawn(),
            },
            screen.drawing.peek(),
        );
        screen.viewers.push(viewer);
        if (first) screen.viewer = viewer;
        viewer.refit(true);
        const stop = effect(() => {
            viewer.ruler = screen.ruler.value;
            void screen.news.value;
            viewer.touch();
        });
        let drawing = screen.drawing.peek();
        const stopDrawing = effect(() => {
            if (screen.drawing.value !== drawing) viewer.drawBy(screen.drawing.value);
            drawing = screen.drawing.value;
        });
        return () => {
            stop();
            stopDrawing();
            screen.viewers.splice(screen.viewers.indexOf(viewer), 1);
            viewer.close();
            screen.offBy(view, 0);
        };
    }, []);
    return (
        <div
            ref={host}
            class="canvas"
            role="application"
            aria-label={`Toolpath, ${VIEWS[view]!.name.toLowerCase()}. Arrows turn, Shift and arrows move, Page Up and Page Down zoom, comma and period step by block; ? lists all keys.`}
            tabIndex={0}
            data-view
            data-pane
            onFocus={() => (screen.viewer = screen.viewers.find((viewer) => viewer.host === host.current) ?? screen.viewer)}
        />
    );
}

/** Over the picture of what the proof has walked so far, or of a source that the machine cannot cut: nobody takes it for proven. */
function Proving({ screen }: { screen: Screen }) {
    const walked = screen.studio.walking.value;
    const job = screen.studio.job.value;
    if (job !== null && job.program === null) {
        return (
            <p class="proving">
                <strong class="warning">▲ there is no program: this is the path of the source</strong>, see the findings below
            </p>
        );
    }
    if (walked === null || job !== null) return null;
    return (
        <p class="proving">
            <strong class="warning">▲ the proof runs: nothing of this is proven yet</strong> {counted(walked.moves)} moves so far
        </p>
    );
}

function whyEmpty({ work, findings }: Studio): string {
    if (work.value === null) return "Drop a toolpath here (CL data, or an NC program), the files of a circuit board, or bodies to engrave inside glass.";
    if (work.value.machine === null) return "There is no program yet: choose the machine that it is for.";
    return findings.value.length === 0 ? "There is no program." : "There is no program: see the findings below.";
}

/** More are found in the dialog. */
const NEAR = 8;

/** Files of the folder, to begin with: what CAM has written last stands first. */
function Near({ screen }: { screen: Screen }) {
    const { studio } = screen;
    const entries = useSignal<Entry[]>([]);
    const isOpen = studio.opened.value !== null;
    useEffect(() => {
        if (isOpen) void studio.seam.ask("folder", { path: "" }).then(({ done }) => (entries.value = done.entries));
    }, [isOpen]);
    if (entries.value.every(({ kind }) => kind === "folder")) return null;
    return (
        <p class="near">
            In this folder, newest first:{" "}
            {offered(entries.value, studio.machines.value.map(({ name }) => name)).slice(0, NEAR).map(({ name, path }) => (
                <button key={path} type="button" onClick={() => void studio.open({ file: path })}>
                    {name}
                </button>
            ))}
        </p>
    );
}

/** To try it without a toolpath at hand. They are fetched when they are asked for. */
const examples = [
    { title: "a plate, three axes", name: "plate.cls", text: () => import("../../../examples/plate.cls?raw") },
    { title: "a leaning tool, five axes", name: "lean.cls", text: () => import("../../../examples/lean.cls?raw") },
    { title: "a circuit board", name: "lamp.toml", text: () => import("../../../examples/lamp.toml?raw") },
];

function Examples({ screen: { studio } }: { screen: Screen }) {
    return (
        <p class="near">
            Examples:{" "}
            {examples.map(({ title, name, text }) => (
                <button key={name} type="button" onClick={async () => studio.drop([new File([(await text()).default], name)])}>
                    {title}
                </button>
            ))}
        </p>
    );
}

function Empty({ screen }: { screen: Screen }) {
    return (
        <div class="empty">
            <p>{whyEmpty(screen.studio)}</p>
            <p>
                <button type="button" onClick={() => (screen.dialog.value = "source")}>
                    Open a file…
                </button>{" "}
                <button type="button" onClick={() => (screen.dialog.value = "machine")}>
                    Choose a machine…
                </button>
            </p>
            {screen.studio.work.value === null && (
                <>
                    <Near screen={screen} />
                    <Examples screen={screen} />
                </>
            )}
            <p class="soft">A program dropped on the left pane, or beside its toolpath, is proven against it.</p>
        </div>
    );
}
