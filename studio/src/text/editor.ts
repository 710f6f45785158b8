/**
 * One text: CodeMirror in a shadow root, whose style sheets are constructed, so that the content policy needs no exception.
 * Of a long text it keeps a window of lines, numbered as in the file.
 */

import { defaultKeymap, history, historyKeymap, undoDepth } from "@codemirror/commands";
import { Compartment, EditorState, StateEffect, StateField, Transaction, type ChangeSpec, type Extension, type Text } from "@codemirror/state";
import { Decoration, EditorView, drawSelection, keymap, lineNumbers, type DecorationSet, type ViewUpdate } from "@codemirror/view";
import { coloured, type Family } from "./dialects.ts";
import { firstWindow, isNearEnd, isWithin, KEPT, lastWindow, LONG, missing, placesIn, type Window } from "./window.ts";

/** Between two jumps to lines that are not here, ms. */
const JUMPS = 250;

/** How long the cursor rests before more lines around it are fetched, ms: sooner where all will be here then. */
const REST = 1500;
const REST_TO_ALL = 100;

/** A text that is somewhere else. */
export interface Origin {
    /** Of a program in several files, the called one; null: the text itself. */
    file: string | null;
    /** Of which program it is: edits of one have the same. */
    program: number;
    lines: number;
    family: Family;
    isEditable: boolean;
    read(from: number, to: number): Promise<string>;
}

export interface Listener {
    picked(line: number, file: string | null): void;
    edited(text: string, file: string | null): void;
    /** All lines are here. */
    whole(text: string, file: string | null): void;
}

/** Lines, from 1: that of the cursor, all that belong to it, those with findings. */
export interface Marked {
    at: number | null;
    also: number[];
    wrong: number[];
    /** A text that was searched for: marked where it stands in the cursor's line. */
    found: string;
}

const setMarked = StateEffect.define<Marked>();
const atLine = Decoration.line({ class: "at", attributes: { "aria-current": "true" } });
const alsoLine = Decoration.line({ class: "also" });
const wrongLine = Decoration.line({ class: "wrong" });

const foundText = Decoration.mark({ class: "found" });

function decorations(text: Text, { at, also, wrong, found }: Marked): DecorationSet {
    const marked = (lines: number[], mark: Decoration) => lines.map((line) => ({ line, mark }));
    const lines = [...marked(wrong, wrongLine), ...marked(also, alsoLine), ...(at === null ? [] : [{ line: at, mark: atLine }])];
    const within = lines.filter(({ line }) => line >= 1 && line <= text.lines);
    const own = at !== null && at >= 1 && at <= text.lines ? text.line(at) : null;
    const places = own === null ? [] : placesIn(own.text, found).map((place) => foundText.range(own.from + place, own.from + place + found.length));
    return Decoration.set([...within.map(({ line, mark }) => mark.range(text.line(line).from)), ...places], true);
}

const marks = StateField.define<DecorationSet>({
    create: () => Decoration.none,
    update(value, change) {
        const set = change.effects.find((effect) => effect.is(setMarked));
        if (set !== undefined) return decorations(change.state.doc, set.value as Marked);
        return value.map(change.changes);
    },
    provide: (field) => EditorView.decorations.from(field),
});

const look = EditorView.theme({
    "&": { height: "100%", color: "var(--ink)", backgroundColor: "var(--paper)", font: "var(--code)" },
    ".cm-scroller": { font: "var(--code)" },
    ".cm-gutters": { color: "var(--soft)", backgroundColor: "var(--panel)", border: "none" },
    ".cm-content": { caretColor: "var(--ink)" },
    "&.cm-focused": { outline: "none" },
    ".cm-cursor": { borderLeftColor: "var(--ink)" },
    "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground": { backgroundColor: "var(--selected)" },
    ".cm-selectionBackground": { backgroundColor: "var(--selected)" },
    // The outline is seen where the system takes its own colours.
    ".at": { backgroundColor: "var(--lit)", boxShadow: "inset 3px 0 var(--accent)", outline: "1px solid transparent", outlineOffset: "-1px" },
    ".also": { boxShadow: "inset 3px 0 var(--accent)" },
    ".found": { outline: "2px solid var(--accent)", borderRadius: "2px" },
    ".wrong": { textDecoration: "underline wavy var(--bad)" },
});

/** Whether both are of one file of the same program. */
const isOne = (one: Origin, other: Origin | null): boolean => other !== null && one.file === other.file && one.program === other.program;

export class Editor {
    private readonly view: EditorView;
    private readonly extensions: Extension;
    private readonly more = new Compartment();
    private readonly locked = new Compartment();
    private window: Window = { from: 1, to: 1 };
    private origin: Origin | null = null;
    /** Of which text the lines in the editor are. */
    private shown: Origin | null = null;
    /** Files that were edited and are not shown now, with what can be undone of each. */
    private readonly left = new Map<string | null, EditorState>();
    /** Until the first lines of the text that is to be shown are here. */
    private showing: Promise<void> = Promise.resolve();
    private marked: Marked = { at: null, also: [], wrong: [], found: "" };
    private reading = 0;
    /** The lines that are on their way for a jump. */
    private coming: Window | null = null;
    private isGrowing = false;
    /** The part that was asked for last while more lines grew. */
    private asked: { origin: Origin; from: number; to: number; text: Promise<string> } | null = null;
    private isSetting = false;
    private isHeld = false;
    private jumping: ReturnType<typeof setTimeout> | undefined;
    private resting: ReturnType<typeof setTimeout> | undefined;

    constructor(host: HTMLElement, label: string, private readonly listener: Listener) {
        const root = host.attachShadow({ mode: "open" });
        this.extensions = [
            look,
            marks,
            history(),
            drawSelection(),
            keymap.of([...defaultKeymap, ...historyKeymap]),
            lineNumbers({ formatNumber: (line) => String(line + this.window.from - 1) }),
            EditorView.contentAttributes.of({ "aria-label": label, tabindex: "0", spellcheck: "false", autocapitalize: "off" }),
            // The page takes a file that is dropped; the editor would put its text in.
            EditorView.domEventHandlers({ drop: (event) => event.dataTransfer?.types.includes("Files") === true }),
            EditorView.updateListener.of((update) => this.updated(update)),
        ];
        this.view = new EditorView({ root, parent: root, state: this.state("", "iso") });
        this.lock();
    }

    private state(doc: string, family: Family): EditorState {
        return EditorState.create({ doc, extensions: [this.extensions, coloured(family), this.locked.of([]), this.more.of([])] });
    }

    close(): void {
        clearTimeout(this.resting);
        clearTimeout(this.jumping);
        this.view.destroy();
    }

    focus(): void {
        this.view.focus();
    }

    get text(): string {
        return this.view.state.doc.toString();
    }

    /** Whether all lines are here: only then it can be edited. */
    get isWhole(): boolean {
        return this.origin !== null && this.window.from === 1 && this.window.to > this.origin.lines;
    }

    /** A text; where `isSame`, the lines that are here are kept, if they are of that file of the same program. */
    async show(origin: Origin | null, isSame = false): Promise<void> {
        const { shown } = this;
        if (isSame && origin !== null && this.origin === shown && isOne(origin, shown)) {
            this.origin = this.shown = origin;
            return;
        }
        this.origin = origin;
        if (origin === null) return this.set("", { from: 1, to: 1 });
        // Until it is here, what is seen is another text, and no key makes it an edit of this one.
        this.lock();
        this.showing = this.fetch(this.marked.at ?? 1);
        await this.showing;
    }

    /** The text as somebody has edited it. */
    replace(text: string, origin: Origin): void {
        // What was on its way is not of this file.
        this.reading++;
        this.coming = null;
        this.origin = origin;
        if (!isOne(origin, this.shown) || this.text !== text) return this.set(text, { from: 1, to: Number.MAX_SAFE_INTEGER });
        this.shown = origin;
        this.lock();
    }

    /** All lines of a text, or of a long one those round `line`; the others come when the cursor rests. */
    private async fetch(line: number): Promise<void> {
        const { origin } = this;
        if (origin === null) return;
        const reading = ++this.reading;
        // What was growing has ended by this: a new place must not end what is fetched for it in its stead.
        this.isGrowing = false;
        clearTimeout(this.resting);
        const window = firstWindow(line, origin.lines, Math.ceil(this.view.scrollDOM.clientHeight / this.view.defaultLineHeight));
        this.coming = window;
        try {
            const text = await origin.read(window.from, window.to);
            if (reading !== this.reading) return;
            this.move(text, window);
            if (!this.isWhole) this.growLater();
        } finally {
            if (reading === this.reading) this.coming = null;
        }
    }

    /** Other lines of the same text take the place of these; those of another text begin anew. */
    private move(text: string, window: Window): void {
        if (this.shown !== this.origin || this.origin === null) return this.set(text, window);
        const { state } = this.view;
        const insert = state.toText(text);
        this.window = window;
        this.isSetting = true;
        this.view.dispatch({
            changes: { from: 0, to: state.doc.length, insert },
            annotations: Transaction.addToHistory.of(false),
            selection: { anchor: 0 },
            effects: this.drawn(insert, true),
        });
        this.isSetting = false;
    }

    private growLater(): void {
        clearTimeout(this.resting);
        this.resting = setTimeout(() => void this.grow(), (this.origin?.lines ?? 0) > KEPT ? REST : REST_TO_ALL);
    }

    /** As many lines as are kept, round those in sight. They come in parts, so that a jump need not wait for all of them. */
    private async grow(): Promise<void> {
        const { origin } = this;
        if (origin === null) return;
        const reading = ++this.reading;
        const kept = lastWindow(this.inSight.from, origin.lines);
        this.isGrowing = true;
        this.drop(kept);
        try {
            for (let part = missing(this.window, kept); part !== null && reading === this.reading; part = missing(this.window, kept)) {
                const text = await this.read(origin, part);
                if (reading !== this.reading) return;
                this.add(text, part);
                // The editor measures what was added once a frame.
                await new Promise(requestAnimationFrame);
            }
            if (reading === this.reading && this.isWhole) this.finish();
        } finally {
            if (reading === this.reading) this.isGrowing = false;
        }
    }

    /** The lines of a part. What a new place ends is not asked for again when the cursor rests: the answer is on its way. */
    private async read(origin: Origin, { from, to }: Window): Promise<string> {
        const { asked } = this;
        if (asked?.origin !== origin || asked.from !== from || asked.to !== to) this.asked = { origin, from, to, text: origin.read(from, to) };
        const mine = this.asked;
        try {
            return await mine!.text;
        } catch (error) {
            if (this.asked === mine) this.asked = null;
            throw error;
        }
    }

    /** The lines between those that are here and the next ones on either side. */
    private add(text: string, part: Window): void {
        const { from, to } = this.window;
        const isAbove = part.to === from;
        const at = isAbove ? 0 : this.view.state.doc.length;
        this.change({ from: at, insert: isAbove ? `${text}\n` : `\n${text}` }, { from: Math.min(from, part.from), to: Math.max(to, part.to) });
    }

    /** All lines are here: they may be edited. */
    private finish(): void {
        this.lock();
        this.listener.whole(this.text, this.shown?.file ?? null);
    }

    /** Held, it takes no keys: another text is to come. */
    hold(isHeld: boolean): void {
        this.isHeld = isHeld;
        this.lock();
    }

    /** Only where all lines of the text are here it can be edited. */
    private lock(): void {
        const { origin, shown, isWhole, isHeld } = this;
        const isOpen = origin?.isEditable === true && origin === shown && isWhole && !isHeld;
        this.view.dispatch({ effects: this.locked.reconfigure(EditorState.readOnly.of(!isOpen)) });
    }

    /** The lines that are not among the kept ones. */
    private drop(kept: Window): void {
        const { from, to } = this.window;
        const { doc } = this.view.state;
        if (to > kept.to) this.change({ from: doc.line(kept.to - from).to, to: doc.length }, { from, to: kept.to });
        if (from < kept.from) this.change({ from: 0, to: doc.line(kept.from - from + 1).from }, { from: kept.from, to: Math.min(to, kept.to) });
    }

    /** What is in sight stays there. */
    private change(change: ChangeSpec, window: Window): void {
        const changes = this.view.state.changes(change);
        const scrolled = this.view.scrollSnapshot().map(changes);
        this.window = window;
        this.isSetting = true;
        this.view.dispatch({ changes, annotations: Transaction.addToHistory.of(false) });
        // Behind the change: the editor would not scroll beyond the end that it had before.
        if (scrolled !== undefined) this.view.dispatch({ effects: scrolled });
        this.isSetting = false;
    }

    /** Lines of the file. */
    private get inSight(): Window {
        const { state, viewport } = this.view;
        const line = (position: number): number => state.doc.lineAt(position).number + this.window.from - 1;
        return { from: line(viewport.from), to: line(viewport.to) };
    }

    private set(text: string, window: Window): void {
        const { origin, shown } = this;
        if (shown !== null && shown.file !== origin?.file && undoDepth(this.view.state) > 0) this.left.set(shown.file, this.view.state);
        if (shown?.program !== origin?.program) this.left.clear();
        const left = this.left.get(origin?.file ?? null);
        this.window = window;
        this.shown = origin;
        this.isSetting = true;
        this.view.setState(left?.doc.toString() === text ? left : this.state(text, origin?.family ?? "iso"));
        this.view.dispatch({ effects: this.more.reconfigure([]) });
        this.lock();
        this.isSetting = false;
        this.draw(true);
        // The cursor is in none of its lines: it begins at its head, wherever the one before it was scrolled to.
        if (shown?.file !== origin?.file && this.marked.at === null) this.view.dispatch({ effects: EditorView.scrollIntoView(0, { y: "start" }) });
        if (this.isWhole) this.listener.whole(text, origin?.file ?? null);
    }

    /** Lines as they are numbered in the file; that of the cursor comes into sight. */
    mark(marked: Marked): void {
        const isNew = marked.at !== this.marked.at;
        this.marked = marked;
        // The lines of the place come first.
        if (isNew && this.isGrowing) {
            this.reading++;
            this.isGrowing = false;
            this.growLater();
        }
        if (isNew && this.isElsewhere) this.jump();
        else this.draw(isNew);
    }

    /** The cursor's line is not among those that are here or on their way. */
    private get isElsewhere(): boolean {
        const { at } = this.marked;
        return at !== null && this.origin !== null && at <= this.origin.lines && !isWithin(this.coming ?? this.window, at);
    }

    /** At once, but while somebody scrubs through a long text only now and then. */
    private jump(): void {
        if (this.jumping !== undefined) return;
        void this.fetch(this.marked.at!);
        this.jumping = setTimeout(() => {
            this.jumping = undefined;
            if (this.isElsewhere) this.jump();
        }, JUMPS);
    }

    private draw(isNew: boolean): void {
        this.view.dispatch({ effects: this.drawn(this.view.state.doc, isNew) });
    }

    /** The marks in the lines that are here; a new line of the cursor comes into sight. */
    private drawn(doc: Text, isNew: boolean): StateEffect<unknown>[] {
        const { at, also, wrong, found } = this.marked;
        const here = (lines: number[]): number[] => lines.filter((one) => isWithin(this.window, one)).map((one) => one - this.window.from + 1);
        const [line = null] = at === null ? [] : here([at]);
        const effects: StateEffect<unknown>[] = [setMarked.of({ at: line, also: here(also), wrong: here(wrong), found })];
        if (isNew && line !== null && line <= doc.lines) effects.push(EditorView.scrollIntoView(doc.line(line).from, { y: "nearest", yMargin: 60 }));
        return effects;
    }

    private updated(update: ViewUpdate): void {
        if (this.isSetting) return;
        const file = this.shown?.file ?? null;
        if (update.docChanged) {
            // What is on its way of the same file is older.
            if (this.origin?.file === file) this.reading++;
            this.listener.edited(this.text, file);
            return;
        }
        const { state } = update.view;
        if (update.selectionSet && update.transactions.some((change) => change.isUserEvent("select"))) {
            const line = state.doc.lineAt(state.selection.main.head).number + this.window.from - 1;
            if (line !== this.marked.at) this.listener.picked(line, file);
        }
        if (update.viewportChanged && this.origin !== null && !this.isWhole) {
            const { from, to } = this.inSight;
            const isResting = this.window.to - this.window.from >= LONG && this.coming === null && !this.isGrowing;
            if (isResting && isNearEnd(this.window, from, to, this.origin.lines)) void this.grow();
        }
    }

    /** Puts the selection on a line of the file, as if it were clicked. */
    async go(line: number): Promise<void> {
        await this.showing.catch(() => {});
        if (!isWithin(this.window, line)) await this.fetch(line);
        const { doc } = this.view.state;
        const at = Math.max(1, Math.min(doc.lines, line - this.window.from + 1));
        this.view.dispatch({ selection: { anchor: doc.line(at).from }, scrollIntoView: true, userEvent: "select" });
        this.view.focus();
    }

    /** Differences to another text, by an extension that is loaded when it is wanted. */
    async compare(original: string | null): Promise<void> {
        const more = original === null ? [] : await differences(original);
        this.view.dispatch({ effects: this.more.reconfigure(more) });
    }
}

async function differences(original: string): Promise<Extension> {
    const { unifiedMergeView } = await import("@codemirror/merge");
    return unifiedMergeView({ original, mergeControls: false });
}
