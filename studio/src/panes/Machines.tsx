import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { MachineEntry, MachineKind } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { Choose } from "./Choose.tsx";

/** The machines, of which those come first that can take the source. */
export function Machines({ screen, close }: { screen: Screen; close(): void }) {
    const { studio } = screen;
    const kinds = useSignal<MachineKind[] | null>(null);
    const source = studio.work.value?.source;
    useEffect(() => {
        // A machine file may have come into the folder. Without a connection those of before stay; all are asked for when there is one.
        void studio.seam.ask("machines", {}).then(({ done }) => (studio.machines.value = done), () => {});
        if (source === undefined) return;
        // What cannot be read says so when it is posted.
        void studio.seam.ask("kinds", { source }).then(({ done }) => (kinds.value = done), () => {});
    }, []);
    const fits = ({ kind }: MachineEntry): boolean => kinds.value?.includes(kind) ?? true;
    const machines = studio.machines.value.toSorted((a, b) => Number(fits(b)) - Number(fits(a)));
    return (
        <Choose
            label="Search the machines, or type the path of a machine file"
            close={close}
            typed={(path) => (path.endsWith(".toml") && !machines.some(({ name }) => name === path) ? [{ name: path, title: path, more: "a machine file of this folder", run: () => void studio.choose(path) }] : [])}
            choices={machines.map((machine) => ({
                name: machine.name,
                title: `${machine.name}: ${machine.title}`,
                more: fits(machine) ? `${machine.control}, ${machine.axes.join(" ")}` : "not for this source",
                run: () => void studio.choose(machine.name),
            }))}
        />
    );
}
