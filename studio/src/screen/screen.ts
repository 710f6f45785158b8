/** What is on the screen and not in the work: dialogs, tabs, the views and how they look. */

import { computed, effect, signal, untracked, type Signal } from "@preact/signals";
import { Together } from "../newest.ts";
import { Player } from "../player.ts";
import type { Finding, Job, Place, ToolUse } from "../protocol/asks.ts";
import type { Left } from "../protocol/session.ts";
import type { Studio } from "../studio.ts";
import type { Editor } from "../text/editor.ts";
import { Blocks } from "../view/blocks.ts";
import { Board } from "../view/board.ts";
import { axes, type Box } from "../view/camera.ts";
import { Chunks } from "../view/chunks.ts";
import { theme, type Mode } from "../view/colours.ts";
import { cutsOf, grow, type Cuts } from "../view/cuts.ts";
import { bodiesOf } from "../view/linkage.ts";
import { Rows } from "../view/rows.ts";
import { Scene, type Looks, type Marks } from "../view/scene.ts";
import { lengthOf, toolBody, wireBody } from "../view/solids.ts";
import type { Triangles } from "../view/strip.ts";
import { along, type Vector } from "../view/vector.ts";
import type { Walking } from "../view/walking.ts";
import type { Drawing, Viewer, Whole } from "../view/viewer.ts";

export type Dialog = "commands" | "keys" | "machine" | "source" | "program" | "options" | "save" | "go" | "find";
export type Tab = "findings" | "verdict" | "plots";

/** The lines of all that a finding stands for. */
export const placesOf = ({ line, places }: Pick<Finding, "line" | "places">): number[] => (line === 0 ? [] : [line, ...places.filter((other) => other !== line)]);

/** What tells it from others, also in the list of another posting. */
const nameOf = ({ rule, message, file, line, column }: Finding): string => JSON.stringify([rule, message, file, line, column]);

/** A point of which nobody knows a coordinate is none. */
export function vector(coordinates: (number | null)[]): Vector | null {
    const known = coordinates.filter((coordinate) => coordinate !== null);
    return known.length === 3 ? (known as Vector) : null;
}

/** Upright where it is not known. */
export const axisOf = (axis: (number | null)[]): Vector => vector(axis) ?? [0, 0, 1];

/** Length of a tool of which nothing is known, where the machine is drawn round it, mm. */
const POINTER = 80;

/** Place of the feed in the row of a move. */
const FEED = 3;

/** What waits for the picture does not wait longer, ms. */
const LATE = 2000;

export class Screen {
    readonly dialog: Signal<Dialog | null> = signal(null);
    readonly tab: Signal<Tab> = signal("findings");
    /** What the options are searched for when they are shown. */
    readonly option: Signal<string> = signal("");
    /** Those that are shown with it: named by the same finding. */
    readonly options: Signal<string[]> = signal([]);
    /** Pane that is searched, and its editors. */
    readonly searched: Signal<"program" | "source"> = signal("program");
    /** What is searched for there. */
    readonly found: Signal<string> = signal("");
    readonly reading = new Together();
    readonly editors: Partial<Record<"program" | "source", Editor>> = {};
    /** Of a program or a source in several files, the one that is shown; null: the first. */
    readonly files: Record<"program" | "source", Signal<string | null>> = { program: signal(null), source: signal(null) };
    /** How many places had been asked for when a file was chosen: none of them leads away from it, however late its answer comes. */
    readonly chosen: Record<"program" | "source", number> = { program: 0, source: 0 };
    /** The finding that was led to last. */
    private readonly led: Signal<{ number: number; found: string }> = signal({ number: -1, found: "" });
    /** Its number among those that there are now, -1 where it is gone, and that of its place among those of that finding. */
    readonly finding = computed(() => {
        const { number, found } = this.led.value;
        const all = this.studio.findings.value.map(nameOf);
        return all[number] === found ? number : all.indexOf(found);
    });
    readonly findingPlace: Signal<number> = signal(0);
    readonly player: Player;

    readonly mode: Signal<Mode> = signal("kind");
    readonly width: Signal<number> = signal(1);
    readonly rapids: Signal<boolean> = signal(true);
    readonly axes: Signal<boolean> = signal(false);
    readonly machine: Signal<boolean> = signal(false);
    /** While one replays, what is ahead of the cursor is pale. */
    readonly pale: Signal<boolean> = signal(true);
    readonly four: Signal<boolean> = signal(false);
    readonly ruler: Signal<boolean> = signal(false);
    readonly drawing: Signal<Drawing> = signal("auto");
    readonly box: Signal<boolean> = signal(false);
    /** A place that is measured from. */
    readonly from: Signal<Vector | null> = signal(null);
    readonly pointer: Signal<Vector | null> = signal(null);
    private readonly dark: Signal<boolean> = signal(false);
    readonly looks = computed((): Looks => ({
        mode: this.mode.value,
        width: this.width.value,
        rapids: this.rapids.value,
        axes: this.axes.value,
        theme: theme(this.dark.value),
    }));
    readonly scene: Signal<Scene | null> = signal(null);
    /** The program of a wire states no feed: nobody knows how long its cuts take. */
    readonly isUntimed: Signal<boolean> = signal(false);
    /** The board that the program is of. */
    readonly board: Signal<Board | null> = signal(null);
    /** Grows with each chunk that comes. */
    readonly news: Signal<number> = signal(0);
    private cuts: Cuts = { box: null, isWhole: true, kinds: new Set() };
    /** The source that the views were fitted to. */
    private fitted: string | null = null;
    /** What was shown while the proof ran: it stays until the job's own lines have come. */
    private walking: Walking | null = null;
    readonly viewers: Viewer[] = [];
    /** There has been a picture. */
    readonly isDrawn: Signal<boolean> = signal(false);
    /** How many pixels lines may be off; 0 where that is not seen. */
    readonly off: Signal<number> = signal(0);
    private readonly offs = new Map<number, number>();
    /** The ends of the ramp of feeds, mm/min. */
    readonly feeds: Signal<[least: number, most: number] | null> = signal(null);
    /** The view that had the focus last. */
    viewer: Viewer | null = null;

    constructor(readonly studio: Studio) {
        studio.asksMachine = () => (this.dialog.value = "machine");
        this.player = new Player(studio.cursor, studio.job);
        const dark = matchMedia("(prefers-color-scheme: dark)");
        this.dark.value = dark.matches;
        dark.addEventListener("change", () => (this.dark.value = dark.matches));
        effect(() => {
            const isShown = this.machine.value;
            untracked(() => this.viewers.forEach((viewer) => viewer.fitMachine(isShown)));
        });
        let isFitted = false;
        effect(() => {
            // Where its axes are not known, as at home, it comes into sight at a later place.
            const isDrawn = this.machine.value && studio.cursor.place.value !== null && this.unknownAxes.length === 0;
            if (isDrawn && !isFitted) untracked(() => this.viewers.forEach((viewer) => viewer.refit(false)));
            isFitted = this.machine.value && (isFitted || isDrawn);
        });
        effect(() => {
            if (studio.stop.value === "invalid" || studio.job.value?.program === null) this.tab.value = "findings";
        });
        effect(() => {
            const job = studio.job.value;
            const walked = studio.walking.value;
            untracked(() => (job === null && walked !== null ? this.meanwhile(walked.walking) : this.begin(job)));
        });
    }

    /** When there is a picture, or none will come: what is large and behind it can be loaded. */
    settled(): Promise<void> {
        const { opened, work, stop: stopped, job } = this.studio;
        const isNoneToCome = computed(() => opened.value !== null && (work.value === null || work.value.machine === null || stopped.value !== null || job.value?.walk.moves === 0));
        const isSettled = computed(() => this.isDrawn.value || isNoneToCome.value);
        return new Promise((resolve) => {
            const end = (): void => {
                stop();
                clearTimeout(late);
                setTimeout(resolve);
            };
            const late = setTimeout(end, LATE);
            const stop = isSettled.subscribe((is) => is && requestAnimationFrame(end));
        });
    }

    /** How the page stands, to be resumed when it is loaded again. */
    get left(): Left {
        const { cursor, unkept } = this.studio;
        const place = cursor.place.value;
        return { place: place === null ? null : { by: "move", value: place.move }, pace: this.player.pace.value, edit: unkept };
    }

    /** Goes on as the page was left. */
    resume(left: Left | null): void {
        if (left === null) return;
        this.studio.cursor.first = left.place;
        this.player.pace.value = left.pace;
        this.studio.left = left.edit;
    }

    /** The scene of a job that is new. */
    private begin(job: Job | null): void {
        const board = this.studio.board.value === null ? null : this.board.value;
        const walked = this.walking;
        this.board.value = null;
        this.walking = null;
        this.isUntimed.value = false;
        if (job === null || job.walk.moves === 0) {
            this.scene.value = null;
            return;
        }
        const { walk, revision } = job;
        const chunks = new Chunks(walk, (path, signal) => this.studio.seam.octets(`/geometry/${revision}/${path}`, signal), () => this.come(), walked);
        this.scene.value = new Scene(walk, chunks, new Rows(this.studio.seam, revision, walk.row / 4, () => this.news.value++), this.wireOf(job), this.blocksOf(job));
        this.lookForCuts();
        void chunks.load().catch(() => {});
        if (job.machine.kind === "wire") void this.lookForFeeds(job).catch(() => {});
        if (job.board !== null) void this.askBoard(job).catch(() => {});
        else if (board !== null) this.show(board);
        const isOther = this.fitted !== job.source.file;
        this.fitted = job.source.file;
        if (isOther) {
            this.from.value = null;
            this.begun(job);
        }
        for (const viewer of this.viewers) viewer.refit(isOther);
    }

    private async lookForFeeds({ revision, walk }: Job): Promise<void> {
        const rows = new Float32Array(await this.studio.seam.octets(`/moves/${revision}/0`));
        const feeds = rows.filter((_, at) => at % (walk.row / 4) === FEED);
        if (this.studio.job.value?.revision === revision) this.isUntimed.value = !feeds.some((feed) => feed > 0);
    }

    /** Something of the picture has come. */
    private come(): void {
        this.news.value++;
        if (this.cuts.isWhole) return;
        this.lookForCuts();
        for (const viewer of this.viewers) viewer.refit(false);
    }

    private lookForCuts(): void {
        const scene = this.scene.peek();
        this.cuts = scene === null ? { box: null, isWhole: true, kinds: new Set() } : cutsOf(scene.walk, scene.chunks);
    }

    /** Of a wire, the height of the part as it was given, else of the plane of the upper guide; null of another machine. */
    private wireOf({ machine }: Job): number | null {
        if (machine.kind !== "wire") return null;
        const given = ["height", "uv-height"].map((name) => Number(this.studio.work.value?.options.find(([option]) => option === name)?.[1]));
        const guide = machine.linkage.bodies.find(({ name }) => name === "upper guide")?.low[2] ?? 0;
        return given.find((height) => height > 0) ?? guide;
    }

    /** Another source: pulses are all of one kind, and their order shows more of a body. */
    private begun({ machine }: Job): void {
        const [from, to]: [Mode, Mode] = machine.kind === "glass" ? ["kind", "order"] : ["order", "kind"];
        if (this.mode.value === from) this.mode.value = to;
    }

    private blocksOf({ blocks }: Job): Blocks | null {
        return blocks.length === 0 ? null : new Blocks(blocks);
    }

    /** The board below the cuts. */
    private async askBoard({ revision }: Job): Promise<void> {
        const { done, arrays } = await this.studio.seam.ask("board", { revision });
        if (this.studio.job.value?.revision !== revision || this.scene.value === null) return;
        const { areas, holes, tabs } = arrays as Record<string, Float32Array>;
        this.show(new Board(done, areas!, holes!, tabs!));
        for (const viewer of this.viewers) viewer.refit(false);
    }

    private show(board: Board): void {
        if (this.scene.value === null) return;
        this.scene.value.board = board;
        this.board.value = board;
        this.news.value++;
    }

    /** What the proof that runs has walked. */
    private meanwhile(walking: Walking): void {
        this.walking = walking;
        const rows = new Rows(this.studio.seam, 0, 4, () => {});
        this.scene.value = new Scene(walking.walk, walking, rows);
        this.lookForCuts();
        this.news.value++;
        for (const viewer of this.viewers) viewer.refit(false);
    }

    /** The net of the copper under the pointer. */
    get net(): string | null {
        const at = this.pointer.value;
        const board = this.board.value;
        const away = this.viewer === null ? null : axes(this.viewer.camera).away;
        if (at === null || board === null || away === null || Math.abs(away[2]) < 0.05) return null;
        // Along the look to the surface, which is at Z 0.
        const [x, y] = along(at, away, -at[2] / away[2]);
        return board.netAt(x, y);
    }

    /** The lines of a view may be so many pixels off: what is said is the most of all views. */
    offBy(view: number, pixels: number): void {
        this.offs.set(view, Math.ceil(pixels));
        this.off.value = Math.max(...this.offs.values());
    }

    /** A view has drawn lines. */
    drawn(): void {
        this.isDrawn.value = true;
        const feeds = this.scene.value?.feeds ?? null;
        if (String(feeds) !== String(this.feeds.value)) this.feeds.value = feeds;
    }

    marks(): Marks {
        const { cursor, job } = this.studio;
        const place = cursor.place.value;
        const pixel = 1 / Math.max(this.viewer?.camera.scale ?? 1, 1e-3);
        const bodies = place === null || !this.machine.value ? [] : this.bodiesAt(place);
        const isHeld = bodies.length > 0 && job.value?.machine.kind !== "robot";
        const size = isHeld ? POINTER : 40 * pixel;
        return {
            now: place === null ? null : place.move,
            pale: this.pale.value && cursor.by.value === "time",
            ofBlock: cursor.ofBlock.value,
            mismatch: job.value?.walk.mismatch ?? null,
            bodies,
            tool: place === null ? null : this.toolAt(place, size, pixel),
        };
    }

    /** The tool, where it is known where it is. */
    private toolAt({ tool, tip, axis }: Place, size: number, pixel: number): Triangles | null {
        const { job } = this.studio;
        const at = vector(tip);
        if (at === null || job.value === null) return null;
        // Of a laser the focus is marked: it has no body.
        if (job.value.machine.kind === "glass") return null;
        const wire = this.wireOf(job.value);
        return wire === null ? toolBody(this.toolOf(tool), at, axisOf(axis), size) : wireBody(at, axisOf(axis), wire, 1.5 * pixel);
    }

    /** The axes of which nobody knows where they are: then the machine is not drawn. */
    get unknownAxes(): string[] {
        const place = this.studio.cursor.place.value;
        const axes = this.studio.job.value?.machine.axes ?? [];
        return place === null ? [] : axes.flatMap(({ name }, i) => ((place.axes[i] ?? null) === null ? [name] : []));
    }

    /** The machine round the tool, where all its axes are known. */
    private bodiesAt({ axes, tip, tool }: Place): Triangles[] {
        const { linkage, kind } = this.studio.job.value!.machine;
        const known = axes.filter((position) => position !== null);
        if (known.length !== axes.length) return [];
        const at = vector(tip);
        if (kind === "robot" || kind === "glass") return bodiesOf(linkage, known, null);
        // The lower end of a wire is in the plane that the machine's own zero is in.
        const length = kind === "wire" ? 0 : lengthOf(this.toolOf(tool), POINTER);
        return at === null ? [] : bodiesOf(linkage, known, { tip: at, length });
    }

    toolOf(place: number | null): ToolUse | null {
        return (place === null ? null : this.studio.job.value?.walk.tools[place]) ?? null;
    }

    /** All that is drawn. */
    get all(): Box | null {
        if (this.studio.job.value === null) return this.studio.walking.value?.walking.box ?? null;
        const [low, high] = this.studio.job.value.walk.box ?? [];
        return low === undefined || high === undefined ? null : this.round({ low, high });
    }

    /** The box with what belongs to it: board, blocks of glass, the height of a wire. */
    private round({ low, high }: Box): Box {
        const job = this.studio.job.value;
        const wire = job === null ? 0 : (this.wireOf(job) ?? 0);
        const box: Box = { low: [...low], high: [high[0], high[1], high[2] + wire] };
        const other = this.board.value?.box ?? (job === null ? null : this.blocksOf(job)?.box) ?? null;
        if (other !== null) for (const corner of [other.low, other.high]) grow(box, corner);
        return box;
    }

    /** Numbers of the kinds of moves that have come. */
    get kinds(): Set<number> {
        return this.cuts.kinds;
    }

    boxOf(what: Whole): Box | null {
        if (what === "all" || this.cuts.box === null) return this.all;
        const box = this.round(this.cuts.box);
        const place = this.studio.cursor.place.value;
        if (what === "cuts" || place === null) return box;
        for (const { corners } of this.bodiesAt(place)) {
            for (let i = 0; i + 2 < corners.length; i += 3) grow(box, [corners[i]!, corners[i + 1]!, corners[i + 2]!]);
        }
        return box;
    }

    /** Leads to a place of a finding, in every pane. */
    toFinding(number: number, which = 0): void {
        const { findings, job, cursor } = this.studio;
        const found = findings.value[number];
        if (found === undefined) return;
        const places = placesOf(found);
        const at = (which + places.length) % Math.max(1, places.length);
        this.led.value = { number, found: nameOf(found) };
        this.findingPlace.value = at;
        this.tab.value = "findings";
        const line = places[at];
        if (job.value === null) return;
        // Of a board it may be of another program than the one that is shown.
        const other = this.studio.board.value?.programs.find(({ file }) => file === found.file);
        if (other !== undefined && other.revision !== job.value.revision && this.studio.edited.value === null) {
            return void this.studio.chooseProgram(other.revision).then(() => (line === undefined ? undefined : cursor.to({ by: "block", value: line })));
        }
        if (line === undefined) return;
        const file = found.file === (found.of === "source" ? job.value.source : job.value.program)?.file ? null : found.file;
        if (found.of === "source") void cursor.to({ by: "source", value: line, file });
        else if (found.of === "program") void cursor.to({ by: "block", value: line, file });
    }

    /** All places of all findings in turn. */
    nextFinding(step: 1 | -1): void {
        const findings = this.studio.findings.value;
        const [at, which] = [this.finding.value, this.findingPlace.value + step];
        const here = findings[at];
        if (here !== undefined && which >= 0 && which < placesOf(here).length) return this.toFinding(at, which);
        const next = (Math.max(at, step === 1 ? -1 : 0) + step + findings.length) % Math.max(1, findings.length);
        this.toFinding(next, step === 1 ? 0 : -1);
    }

    /** The dialog; where nothing can be saved, why. */
    save(): void {
        const refusal = this.studio.refusal();
        if (refusal === null) {
            this.dialog.value = "save";
            return;
        }
        this.studio.stopped.value = [refusal];
        this.tab.value = "findings";
        // What is typed next is no text of the program.
        document.querySelector<HTMLElement>("#low")?.focus();
    }

    /** The form, at an option. */
    toOption(name: string, also: string[] = []): void {
        this.option.value = name;
        this.options.value = also;
        this.dialog.value = "options";
    }

    /** Shows a file of a text, or stays with it: it was chosen, or is typed in. */
    choose(of: "program" | "source", file: string | null): void {
        this.chosen[of] = this.studio.cursor.asks;
        this.files[of].value = file;
    }

    toText(of: "program" | "source"): void {
        const place = this.studio.cursor.place.value;
        const line = of === "program" ? place?.block : place?.source;
        if (!line) return;
        this.choose(of, line.file);
        void this.editors[of]?.go(line.line);
    }

    /** The programs of a board in turn. */
    nextProgram(step: number): void {
        const { job, board, edited } = this.studio;
        if (edited.value !== null) return;
        const programs = board.value?.programs ?? [];
        const at = programs.findIndex(({ file }) => file === job.value?.program?.file);
        const next = programs[(at + step + programs.length) % programs.length];
        if (next !== undefined) void this.studio.chooseProgram(next.revision);
    }

    /** Leads to a place of the board. */
    toPlace(x: number, y: number): void {
        if (this.viewer === null) return;
        const { camera } = this.viewer;
        this.viewer.look({ ...camera, middle: [x, y, 0], scale: Math.max(camera.scale, 40) });
    }

    /** Measures from the tip at the cursor, or no more. */
    measure(): void {
        this.from.value = this.from.value === null ? vector(this.studio.cursor.place.value?.tip ?? []) : null;
    }

    zoomToCursor(): void {
        const middle = vector(this.studio.cursor.place.value?.tip ?? []);
        if (middle === null || this.viewer === null) return;
        const { camera } = this.viewer;
        this.viewer.look({ ...camera, middle, scale: Math.max(camera.scale, 20) });
    }

    /** The text that has the focus, else the program, is searched. */
    find(): void {
        this.searched.value = document.activeElement?.closest(".source") ? "source" : "program";
        this.dialog.value = "find";
    }

    /** The panes in turn (F6). */
    nextPane(step: 1 | -1): void {
        const panes = [...document.querySelectorAll<HTMLElement>("[data-pane]")];
        const at = panes.findIndex((pane) => pane.contains(document.activeElement));
        panes[(at + step + panes.length) % panes.length]?.focus();
    }
}
