import type { Command } from "../commands.ts";
import type { Screen } from "./screen.ts";

export function commandsOf(screen: Screen): Command[] {
    const { studio } = screen;
    const show = (dialog: typeof screen.dialog.value) => () => {
        screen.dialog.value = dialog;
    };
    return [
        { name: "commands", title: "Commands", keys: ["Ctrl+k"], run: show("commands") },
        { name: "keys", title: "Keys", keys: ["?"], view: true, run: show("keys") },
        { name: "source", title: "Open a source", keys: ["Ctrl+o"], run: show("source") },
        { name: "machine", title: "Choose the machine", keys: ["Ctrl+m"], run: show("machine") },
        { name: "options", title: "Options of posting", run: show("options") },
        { name: "save", title: "Save the program", keys: ["Ctrl+s"], run: show("save") },
        { name: "go", title: "Go to a block, source line, move or time", keys: ["Ctrl+g"], run: show("go") },
        { name: "cancel", title: "Cancel what runs", keys: ["Escape"], run: () => studio.cancel() },
        { name: "next-finding", title: "Next finding", keys: ["F8"], run: () => screen.toFinding(screen.finding.value + 1) },
        { name: "last-finding", title: "Finding before", keys: ["Shift+F8"], run: () => screen.toFinding(screen.finding.value - 1) },
        { name: "next-pane", title: "Next pane", keys: ["F6"], run: () => screen.nextPane(1) },
        { name: "last-pane", title: "Pane before", keys: ["Shift+F6"], run: () => screen.nextPane(-1) },
    ];
}
