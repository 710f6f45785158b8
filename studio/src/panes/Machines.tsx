import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Command, MachineEntry } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { fits } from "../studio.ts";
import { Choose } from "./Choose.tsx";

/** The machines, of which those come first that can take the source. */
export function Machines({ screen, close }: { screen: Screen; close(): void }) {
    const { studio } = screen;
    const command = useSignal<Command | null>(null);
    const source = studio.work.value?.source;
    useEffect(() => {
        // A machine file may have come into the folder. Without a connection those of before stay; all are asked for when there is one.
        void studio.seam.ask("machines", {}).then(({ done }) => (studio.machines.value = done), () => {});
        if (source === undefined) return;
        const ask = () => studio.seam.ask("command", { source, machine: null }).then(({ done }) => void (command.value = done));
        // The form may ask the same meanwhile, which ends this one. What cannot be read says so when it is posted.
        void ask().catch(ask).catch(() => {});
    }, []);
    const rank = ({ kind }: MachineEntry): number => (fits(kind, command.value) ? 0 : 1);
    const machines = studio.machines.value.toSorted((a, b) => rank(a) - rank(b));
    return (
        <Choose
            label="Search the machines, or type the path of a machine file"
            close={close}
            typed={(path) => (path.endsWith(".toml") && !machines.some(({ name }) => name === path) ? [{ name: path, title: path, more: "a machine file of this folder", run: () => void studio.choose(path) }] : [])}
            choices={machines.map((machine) => ({
                name: machine.name,
                title: `${machine.name}: ${machine.title}`,
                more: fits(machine.kind, command.value) ? `${machine.control}, ${machine.axes.join(" ")}` : "not for this source",
                run: () => void studio.choose(machine.name),
            }))}
        />
    );
}
