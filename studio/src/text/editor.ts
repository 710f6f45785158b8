/**
 * One text: CodeMirror in a shadow root, whose style sheets are constructed, so that the content policy needs no exception.
 * Of a long text it keeps a window of lines, numbered as in the file.
 */

import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { Compartment, EditorState, StateEffect, StateField, Transaction, type Extension, type Text } from "@codemirror/state";
import { Decoration, EditorView, drawSelection, keymap, lineNumbers, type DecorationSet, type ViewUpdate } from "@codemirror/view";
import { coloured, type Family } from "./dialects.ts";
import { FIRST, isNearEnd, isWithin, KEPT, windowAround, type Window } from "./window.ts";

/** Between two jumps to lines that are not here, ms. */
const JUMPS = 250;

/** How long the cursor rests before all lines around it are fetched, ms. */
const REST = 700;

/** A text that is somewhere else. */
export interface Origin {
    lines: number;
    family: Family;
    isEditable: boolean;
    read(from: number, to: number): Promise<string>;
}

export interface Listener {
    picked(line: number): void;
    edited(text: string): void;
}

interface Marked {
    /** Lines in the editor, from 1. */
    at: number | null;
    wrong: number[];
}

const setMarked = StateEffect.define<Marked>();
const atLine = Decoration.line({ class: "at", attributes: { "aria-current": "true" } });
const wrongLine = Decoration.line({ class: "wrong" });

function decorations(text: Text, { at, wrong }: Marked): DecorationSet {
    const lines = [...wrong.map((line) => ({ line, mark: wrongLine })), ...(at === null ? [] : [{ line: at, mark: atLine }])];
    const within = lines.filter(({ line }) => line >= 1 && line <= text.lines);
    return Decoration.set(within.map(({ line, mark }) => mark.range(text.line(line).from)), true);
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
    ".at": { backgroundColor: "var(--lit)", boxShadow: "inset 3px 0 var(--accent)" },
    ".wrong": { textDecoration: "underline wavy var(--bad)" },
});

export class Editor {
    private readonly view: EditorView;
    private readonly extensions: Extension;
    readonly more = new Compartment();
    private window: Window = { from: 1, to: 1 };
    private origin: Origin | null = null;
    /** Of which text the lines in the editor are. */
    private shown: Origin | null = null;
    private marked: { at: number | null; wrong: number[] } = { at: null, wrong: [] };
    private reading = 0;
    /** The window that is on its way. */
    private coming: Window | null = null;
    private isSetting = false;
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
            EditorView.updateListener.of((update) => this.updated(update)),
        ];
        this.view = new EditorView({ root, parent: root, state: EditorState.create({ extensions: this.extensions }) });
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

    async show(origin: Origin | null): Promise<void> {
        this.origin = origin;
        if (origin === null) return this.set("", { from: 1, to: 1 });
        await this.fetch(this.marked.at ?? 1);
    }

    /** The text as somebody has edited it. */
    replace(text: string, origin: Origin): void {
        this.origin = origin;
        if (this.text !== text) this.set(text, { from: 1, to: Number.MAX_SAFE_INTEGER });
    }

    private async fetch(line: number, kept = FIRST): Promise<void> {
        const { origin } = this;
        if (origin === null) return;
        const reading = ++this.reading;
        clearTimeout(this.resting);
        const window = windowAround(line, origin.lines, origin.lines <= KEPT ? KEPT : kept);
        if (window.to - window.from < Math.min(KEPT, origin.lines)) this.resting = setTimeout(() => void this.widen(), REST);
        this.coming = window;
        try {
            const text = await origin.read(window.from, window.to);
            if (reading === this.reading) this.move(text, window);
        } finally {
            if (reading === this.reading) this.coming = null;
        }
    }

    /** Other lines of the same text take the place of these; those of another text begin anew. */
    private move(text: string, window: Window): void {
        if (this.shown !== this.origin || this.origin === null || this.origin.lines <= KEPT) return this.set(text, window);
        this.window = window;
        this.isSetting = true;
        const { length } = this.view.state.doc;
        this.view.dispatch({ changes: { from: 0, to: length, insert: text }, annotations: Transaction.addToHistory.of(false), selection: { anchor: 0 } });
        this.isSetting = false;
        this.draw(true);
    }

    private set(text: string, window: Window): void {
        this.window = window;
        const { origin } = this;
        this.shown = origin;
        const isEditable = origin?.isEditable === true && this.isWhole;
        this.isSetting = true;
        this.view.setState(
            EditorState.create({
                doc: text,
                extensions: [this.extensions, coloured(origin?.family ?? "iso"), EditorState.readOnly.of(!isEditable), this.more.of([])],
            }),
        );
        this.isSetting = false;
        this.draw(true);
    }

    /** The line of the cursor, which comes into sight, and the lines with findings; numbered as in the file. */
    mark(at: number | null, wrong: number[]): void {
        const isNew = at !== this.marked.at;
        this.marked = { at, wrong };
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
        const { at, wrong } = this.marked;
        const shift = (line: number): number => line - this.window.from + 1;
        const line = at === null || !isWithin(this.window, at) ? null : shift(at);
        const effects: StateEffect<unknown>[] = [setMarked.of({ at: line, wrong: wrong.filter((one) => isWithin(this.window, one)).map(shift) })];
        const { doc } = this.view.state;
        if (isNew && line !== null && line <= doc.lines) effects.push(EditorView.scrollIntoView(doc.line(line).from, { y: "nearest", yMargin: 60 }));
        this.view.dispatch({ effects });
    }

    private updated(update: ViewUpdate): void {
        if (this.isSetting) return;
        if (update.docChanged) {
            this.listener.edited(this.text);
            return;
        }
        const { state, viewport } = update.view;
        if (update.selectionSet && update.transactions.some((change) => change.isUserEvent("select"))) {
            const line = state.doc.lineAt(state.selection.main.head).number + this.window.from - 1;
            if (line !== this.marked.at) this.listener.picked(line);
        }
        if (update.viewportChanged && this.origin !== null && !this.isWhole) {
            const line = (position: number): number => state.doc.lineAt(position).number + this.window.from - 1;
            const [first, last] = [line(viewport.from), line(viewport.to)];
            const isResting = this.window.to - this.window.from >= KEPT && this.coming === null;
            if (isResting && isNearEnd(this.window, first, last, this.origin.lines)) void this.widen();
        }
    }

    /** As many lines as are kept, with the same ones in sight. */
    private async widen(): Promise<void> {
        const { view } = this;
        const first = view.state.doc.lineAt(view.lineBlockAtHeight(view.scrollDOM.scrollTop).from).number + this.window.from - 1;
        await this.fetch(first, KEPT);
        const { doc } = view.state;
        const at = Math.max(1, Math.min(doc.lines, first - this.window.from + 1));
        view.dispatch({ effects: EditorView.scrollIntoView(doc.line(at).from, { y: "start" }) });
    }

    /** Puts the selection on a line of the file, as if it were clicked. */
    async go(line: number): Promise<void> {
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
