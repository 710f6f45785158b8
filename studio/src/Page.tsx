import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { commandOf, keyOf } from "./commands.ts";
import { Bar } from "./panes/Bar.tsx";
import { Dialogs } from "./panes/Dialogs.tsx";
import { Low } from "./panes/Low.tsx";
import { Split } from "./panes/Split.tsx";
import { TextPane } from "./panes/TextPane.tsx";
import { Timeline } from "./panes/Timeline.tsx";
import { View } from "./panes/View.tsx";
import { commandsOf } from "./screen/commands.ts";
import type { Screen } from "./screen/screen.ts";
import { isToolpath } from "./text/names.ts";

/** The whole window: its panes, and the keys. */
export function Page({ screen }: { screen: Screen }) {
    const { studio } = screen;
    const sizes = useSignal({ program: Math.min(300, innerWidth * 0.24), source: Math.min(300, innerWidth * 0.22), low: Math.min(200, innerHeight * 0.28) });
    const commands = useMemo(() => commandsOf(screen), [screen]);

    useEffect(() => {
        const press = (event: KeyboardEvent): void => {
            const inView = event.target instanceof Element && event.target.closest("[data-view]") !== null;
            const command = commandOf(commands, keyOf(event), inView);
            if (command === undefined || document.querySelector("dialog[open]") !== null) return;
            event.preventDefault();
            command.run();
        };
        document.addEventListener("keydown", press);
        return () => document.removeEventListener("keydown", press);
    }, [commands]);

    /** What is dropped on the program is one for the source that is open, as is what is dropped beside a toolpath; any other file is a source, and several are those of a board. */
    const drop = async (event: DragEvent): Promise<void> => {
        event.preventDefault();
        const files = [...(event.dataTransfer?.files ?? [])];
        if (files.length === 0) return;
        const onProgram = event.target instanceof Element && event.target.closest(".program") !== null;
        if (onProgram && studio.work.value !== null) return studio.proveOther(files);
        const toolpaths = files.filter(({ name }) => isToolpath(name));
        const [toolpath] = toolpaths;
        const program = files.find((file) => file !== toolpath);
        if (files.length === 2 && toolpaths.length === 1) return studio.dropBoth(toolpath!, program!);
        await studio.drop(files);
    };

    const { program, source, low } = sizes.value;
    return (
        <main
            class="studio"
            onDragOver={(event) => event.preventDefault()}
            onDrop={(event) => void drop(event)}
            style={{ "--program": `${program}px`, "--source": `${source}px`, "--low": `${low}px` }}
        >
            <Bar screen={screen} />
            <Split name="s1" label="Width of the program" value={program} sign={1} set={(value) => (sizes.value = { ...sizes.value, program: value })} />
            <Split name="s2" label="Width of the source" value={source} sign={-1} set={(value) => (sizes.value = { ...sizes.value, source: value })} />
            <Split name="s3" label="Height of the findings" value={low} sign={-1} lying set={(value) => (sizes.value = { ...sizes.value, low: value })} />
            <TextPane screen={screen} of="program" />
            <View screen={screen} />
            <TextPane screen={screen} of="source" />
            <Timeline screen={screen} />
            <Low screen={screen} />
            <Dialogs screen={screen} commands={commands} />
        </main>
    );
}
