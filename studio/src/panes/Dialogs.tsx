import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import type { Command } from "../commands.ts";
import type { Dialog, Screen } from "../screen/screen.ts";
import { Choose } from "./Choose.tsx";
import { Find } from "./Find.tsx";
import { Folder } from "./Folder.tsx";
import { Go } from "./Go.tsx";
import { Keys } from "./Keys.tsx";
import { Options } from "./Options.tsx";
import { Save } from "./Save.tsx";

const titles: Record<Dialog, string> = {
    commands: "Commands",
    keys: "Keys",
    machine: "Machine",
    source: "Source",
    program: "Program to prove",
    options: "Options",
    save: "Save",
    go: "Go to",
    find: "Find",
};

export function Dialogs({ screen, commands }: { screen: Screen; commands: Command[] }) {
    const { dialog, studio } = screen;
    const close = (): void => {
        dialog.value = null;
    };
    const open = dialog.value;
    if (open === null) return null;
    return (
        <Modal key={open} title={titles[open]} close={close}>
            {open === "commands" && (
                <Choose
                    label="Search the commands"
                    close={close}
                    choices={commands.map(({ name, title, keys, run }) => ({ name, title, run, more: shownKey(keys?.[0]) }))}
                />
            )}
            {open === "keys" && <Keys commands={commands} />}
            {open === "machine" && (
                <Choose
                    label="Search the machines"
                    close={close}
                    choices={studio.machines.value.map((machine) => ({
                        name: machine.name,
                        title: `${machine.name}: ${machine.title}`,
                        more: `${machine.control}, ${machine.axes.join(" ")}`,
                        run: () => void studio.choose(machine.name),
                    }))}
                />
            )}
            {open === "source" && (
                <Folder
                    screen={screen}
                    close={close}
                    take={(file) => void studio.open({ file })}
                    takeOther={(file) => void studio.drop(file)}
                />
            )}
            {open === "program" && (
                <Folder
                    screen={screen}
                    close={close}
                    take={(file) => void studio.proveFile(file)}
                    takeOther={(file) => void file.text().then((text) => studio.prove(text))}
                />
            )}
            {open === "options" && <Options screen={screen} close={close} />}
            {open === "save" && <Save screen={screen} close={close} />}
            {open === "find" && <Find screen={screen} close={close} />}
            {open === "go" && <Go screen={screen} close={close} />}
        </Modal>
    );
}

/** `Ctrl+k` is shown as `Ctrl K`, `+` as itself. */
export const shownKey = (key: string | undefined): string =>
    (key ?? "").split(/(?<=.)\+/).map((part) => (part.length === 1 ? part.toUpperCase() : part)).join(" ");

/** The browser's own dialog: it keeps the focus within, and Escape closes it. */
function Modal({ title, close, children }: { title: string; close(): void; children: ComponentChildren }) {
    const dialog = useRef<HTMLDialogElement>(null);
    // Before the browser draws, so that no key that is typed next is lost.
    useLayoutEffect(() => dialog.current?.showModal(), []);
    return (
        <dialog ref={dialog} aria-label={title} onClose={close} onClick={(event) => event.target === dialog.current && close()}>
            <h2>{title}</h2>
            {children}
        </dialog>
    );
}
