import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Command } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { Choose } from "./Choose.tsx";

/** The machines: for a body those that engrave inside glass, since no other can take it. */
export function Machines({ screen, close }: { screen: Screen; close(): void }) {
    const { studio } = screen;
    const command = useSignal<Command | null>(null);
    const source = studio.work.value?.source;
    useEffect(() => {
        // What cannot be read says so when it is posted.
        if (source !== undefined) void studio.seam.ask("command", { source, machine: null }).then(({ done }) => (command.value = done), () => {});
    }, []);
    const machines = studio.machines.value.filter(({ kind }) => command.value !== "glass" || kind === "glass");
    return (
        <Choose
            label="Search the machines"
            close={close}
            choices={machines.map((machine) => ({
                name: machine.name,
                title: `${machine.name}: ${machine.title}`,
                more: `${machine.control}, ${machine.axes.join(" ")}`,
                run: () => void studio.choose(machine.name),
            }))}
        />
    );
}
