import type { ComponentChildren } from "preact";
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { matching } from "../commands.ts";
import type { Field } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { isWholeBoard } from "../text/names.ts";
import { optionsIn } from "./Findings.tsx";

type Given = [name: string, value: string][];

/** The options of the command, as it describes them itself. */
export function Options({ screen, close }: { screen: Screen; close(): void }) {
    const { studio } = screen;
    const search = useSignal(screen.option.value);
    const given = useSignal<Given>(studio.work.value?.options ?? []);
    const set = (name: string, values: string[]): void => {
        given.value = [...given.value.filter(([one]) => one !== name), ...values.map((value): Given[number] => [name, value])];
    };
    const work = studio.work.value;
    const source = work?.source;
    const isWhole = source !== undefined && "file" in source && isWholeBoard(source.file);
    const form = studio.form.value.filter(({ group }) => !(isWhole && group === LAYERS));
    const asked = new Set(studio.findings.value.flatMap(({ help }) => optionsIn(help, form)));
    const found = matching(form, search.value, ({ name, help }) => `${name} ${help}`);
    const isLedTo = search.value !== "" && search.value === screen.option.value;
    const also = isLedTo ? form.filter((field) => screen.options.value.includes(field.name) && !found.includes(field)) : [];
    // The one that is named comes before those that its finding names too, and these before those that speak of it.
    const rank = ({ name }: Field): number => Number(name === search.value) * 2 + Number(isLedTo && screen.options.value.includes(name));
    const fields = [...found, ...also].toSorted((a, b) => rank(b) - rank(a));
    const into = (name: string | undefined): void => document.querySelector<HTMLElement>(`#option-${name}`)?.focus();
    // Who was led to an option types into it.
    useEffect(() => {
        if (screen.option.value !== "") into(screen.option.value);
    }, []);
    return (
        <form
            onSubmit={(event) => {
                event.preventDefault();
                close();
                if (work !== null) void studio.post({ ...work, options: given.value });
            }}
        >
            <input
                type="search"
                aria-label="Search the options"
                placeholder="Search the options"
                autofocus
                value={search.value}
                onInput={(event) => (search.value = event.currentTarget.value)}
                onKeyDown={(event) => {
                    if (event.key !== "Enter") return;
                    event.preventDefault();
                    into(fields[0]?.name);
                }}
            />
            <div class="choices" role="group" aria-label="Options" tabIndex={0}>
                {(search.value === "" ? grouped(fields, asked) : [{ name: null, fields }]).map(({ name, fields }) => (
                    <Group key={name} name={name}>
                        {fields.map((field) => (
                            <Row
                                key={field.name}
                                field={field}
                                values={given.value.filter(([name]) => name === field.name).map(([, value]) => value)}
                                set={(values) => set(field.name, values)}
                            />
                        ))}
                    </Group>
                ))}
            </div>
            <p>
                <button type="submit" disabled={work === null}>
                    Post
                </button>
            </p>
        </form>
    );
}

/** The head that files of single layers stand under. */
const LAYERS = "Gerber and drill files";

/** Those that the findings ask for come first, then each group in its order. */
function grouped(fields: Field[], asked: Set<string>): { name: string | null; fields: Field[] }[] {
    const groups = new Map<string, Field[]>();
    for (const field of fields) {
        const group = asked.has(field.name) ? ASKED : (field.group ?? "General");
        groups.set(group, [...(groups.get(group) ?? []), field]);
    }
    const rank = (name: string): number => (name === ASKED ? 0 : name === LAYERS ? 2 : 1);
    return [...groups].map(([name, fields]) => ({ name, fields })).toSorted((a, b) => rank(a.name) - rank(b.name));
}

const ASKED = "Named by the findings";

function Group({ name, children }: { name: string | null; children: ComponentChildren }) {
    if (name === null) return <>{children}</>;
    return (
        <fieldset class="fields">
            <legend>{name}</legend>
            {children}
        </fieldset>
    );
}

interface Props {
    field: Field;
    values: string[];
    set(values: string[]): void;
}

function Row({ field, values, set }: Props) {
    const id = `option-${field.name}`;
    return (
        <div class="field">
            <label for={id}>
                {field.name} <span class="soft">{field.value}</span>
            </label>
            <Input id={id} field={field} values={values} set={set} />
            <div class="soft" id={`${id}-help`}>
                {field.help.replace(/[^.]$/, "$&.")}
                {field.repeats && " One a line."}
            </div>
        </div>
    );
}

const linesOf = (text: string): string[] => text.split("\n").filter((line) => line.trim() !== "");

function Input({ id, field, values, set }: Props & { id: string }) {
    const help = `${id}-help`;
    if (field.value === null) {
        return <input id={id} type="checkbox" aria-describedby={help} checked={values.length > 0} onChange={(event) => set(event.currentTarget.checked ? [""] : [])} />;
    }
    if (field.repeats) {
        return <textarea id={id} rows={2} aria-describedby={help} value={values.join("\n")} onChange={(event) => set(linesOf(event.currentTarget.value))} />;
    }
    const put = (value: string): void => set(value === "" ? [] : [value]);
    if (field.values.length === 0) {
        return <input id={id} type="text" aria-describedby={help} value={values[0] ?? ""} placeholder={field.default ?? ""} onInput={(event) => put(event.currentTarget.value)} />;
    }
    return (
        <select id={id} aria-describedby={help} value={values[0] ?? ""} onChange={(event) => put(event.currentTarget.value)}>
            <option value="">{field.default ?? ""}</option>
            {field.values.map(([value, meaning]) => (
                <option key={value} value={value} title={meaning}>
                    {value}
                </option>
            ))}
        </select>
    );
}
