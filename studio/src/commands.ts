/** All commands in one list: the palette, the keys and the page of keys read it. */

export interface Command {
    name: string;
    title: string;
    /** As `Ctrl+Shift+g`, `F8`, `,`; the first is shown. */
    keys?: string[];
    /** Keys without Ctrl or a function key work only while a view has the focus (WCAG 2.1.4). */
    view?: boolean;
    run(): void;
}

const named: Record<string, string> = { " ": "Space" };

/** The key as commands name it: `Ctrl+k`, `Shift+.`, `Space`. */
export function keyOf(event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey" | "code">): string {
    const plain = plainKey(event);
    const modifiers = [
        (event.ctrlKey || event.metaKey) && "Ctrl",
        event.altKey && "Alt",
        event.shiftKey && plain !== "?" && plain !== "+" && "Shift",
    ];
    return [...modifiers.filter((modifier) => modifier !== false), plain].join("+");
}

/** With Shift, `,` becomes `<` on one keyboard and `;` on another: the place of the key tells. */
function plainKey({ key, code, shiftKey }: Pick<KeyboardEvent, "key" | "code" | "shiftKey">): string {
    if (shiftKey && code === "Comma") return ",";
    if (shiftKey && code === "Period") return ".";
    return named[key] ?? (key.length === 1 ? key.toLowerCase() : key);
}

export function commandOf(commands: Command[], key: string, inView: boolean): Command | undefined {
    return commands.find(({ keys, view }) => keys?.includes(key) === true && (inView || view !== true));
}

/** Those of which every word of the search is somewhere in the text. That which begins with the search comes first, most of all where its first word ends with it. */
export function matching<T>(all: T[], search: string, textOf: (one: T) => string): T[] {
    const whole = search.toLowerCase().trim();
    const words = whole.split(/\s+/).filter(Boolean);
    const rank = (text: string): number => (`${text} `.startsWith(`${whole} `) ? 0 : text.startsWith(whole) ? 1 : 2);
    return all
        .map((one) => ({ one, text: textOf(one).toLowerCase() }))
        .filter(({ text }) => words.every((word) => text.includes(word)))
        .toSorted((a, b) => (whole === "" ? 0 : rank(a.text) - rank(b.text)))
        .map(({ one }) => one);
}
