import { useSignal } from "@preact/signals";
import { matching } from "../commands.ts";
import type { Option } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";

/** The options of the command, as it describes them itself. */
export function Options({ screen, close }: { screen: Screen; close(): void }) {
    const { studio } = screen;
    const search = useSignal("");
    const given = useSignal(studio.work.value?.options ?? {});
    const set = (name: string, value: string): void => {
        const { [name]: _, ...rest } = given.value;
        given.value = value === "" ? rest : { ...rest, [name]: value };
    };
    const work = studio.work.value;
    return (
        <form
            onSubmit={(event) => {
                event.preventDefault();
                close();
                if (work !== null) void studio.post({ ...work, options: given.value });
            }}
        >
            <input type="search" aria-label="Search the options" placeholder="Search the options" onInput={(event) => (search.value = event.currentTarget.value)} />
            <div class="choices" role="group" aria-label="Options" tabIndex={0}>
                {matching(studio.form.value, search.value, ({ name, help }) => `${name} ${help}`).map((option) => (
                    <Field key={option.name} option={option} value={given.value[option.name] ?? ""} set={(value) => set(option.name, value)} />
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

function Field({ option, value, set }: { option: Option; value: string; set(value: string): void }) {
    const id = `option-${option.name}`;
    return (
        <div class="field">
            <label for={id}>{option.name}</label>
            {option.values === null ? (
                <input id={id} type="text" value={value} placeholder={option.default ?? ""} aria-describedby={`${id}-help`} onInput={(event) => set(event.currentTarget.value)} />
            ) : (
                <select id={id} value={value} aria-describedby={`${id}-help`} onChange={(event) => set(event.currentTarget.value)}>
                    <option value="">{option.default ?? ""}</option>
                    {option.values.map((one) => (
                        <option key={one}>{one}</option>
                    ))}
                </select>
            )}
            <div class="soft" id={`${id}-help`}>
                {option.help}
            </div>
        </div>
    );
}
