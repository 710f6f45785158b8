import { useSignal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import { matching } from "../commands.ts";

export interface Choice {
    name: string;
    title: string;
    /** Beside the title: keys, kind, size. */
    more?: string;
    run(): void;
}

interface Props {
    label: string;
    choices: Choice[];
    close(): void;
    /** What is no entry of the list, but can be typed. */
    typed?: (text: string) => Choice[];
}

/** A list that one searches as one types: arrows and Enter choose. */
export function Choose({ label, choices, close, typed }: Props) {
    const field = useRef<HTMLInputElement>(null);
    // Also where the list is another one in a dialog that is open.
    useLayoutEffect(() => field.current?.focus(), []);
    const search = useSignal("");
    const at = useSignal(0);
    const found = [...matching(choices, search.value, ({ name, title, more }) => `${name} ${title} ${more ?? ""}`).slice(0, 300), ...(typed?.(search.value.trim()) ?? [])];
    const chosen = Math.min(at.value, found.length - 1);
    const run = (choice: Choice | undefined): void => {
        if (choice === undefined) return;
        close();
        choice.run();
    };
    const press = (event: KeyboardEvent): void => {
        const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10 }[event.key];
        if (event.key === "Enter") run(found[chosen]);
        else if (step !== undefined) at.value = Math.max(0, Math.min(found.length - 1, chosen + step));
        else return;
        event.preventDefault();
        document.querySelector(`#choice-${at.value}`)?.scrollIntoView({ block: "nearest" });
    };
    return (
        <>
            <input
                ref={field}
                type="text"
                role="combobox"
                list={undefined}
                autofocus
                aria-label={label}
                aria-expanded="true"
                aria-controls="choices"
                {...(found.length === 0 ? {} : { "aria-activedescendant": `choice-${chosen}` })}
                placeholder={label}
                value={search.value}
                onInput={(event) => {
                    search.value = event.currentTarget.value;
                    at.value = 0;
                }}
                onKeyDown={press}
            />
            <ul class="choices" id="choices" role="listbox" aria-label={label}>
                {found.map((choice, number) => (
                    <li key={choice.name} id={`choice-${number}`} role="option" aria-selected={number === chosen} onClick={() => run(choice)}>
                        <span>{choice.title}</span>
                        <span class="soft">{choice.more}</span>
                    </li>
                ))}
            </ul>
            {found.length === 0 && <p class="soft">Nothing is found.</p>}
        </>
    );
}
