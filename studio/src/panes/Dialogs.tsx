import type { ComponentChildren, RefObject } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import type { Command } from "../commands.ts";
import type { Dialog, Screen } from "../screen/screen.ts";
import { Choose } from "./Choose.tsx";
import { Find } from "./Find.tsx";
import { Folder } from "./Folder.tsx";
import { Go } from "./Go.tsx";
import { Keys } from "./Keys.tsx";
import { Machines } from "./Machines.tsx";
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
    const element = useRef<HTMLDialogElement>(null);
    // The browser's dialog ends at once and gives the focus back: what runs next may set it elsewhere.
    const close = (): void => {
        element.current?.close();
        // What had it before may be gone, as the list of the start page behind a choice.
        if (document.activeElement === document.body) document.querySelector<HTMLElement>(".bar button")?.focus();
        dialog.value = null;
    };
    const done = (): void => {
        close();
        // An Enter too many would go into the text of a program.
        if (document.activeElement?.closest(".program")) document.querySelector<HTMLElement>("#low")?.focus();
    };
    const open = dialog.value;
    if (open === null) return null;
    return (
        <Modal key={open} element={element} title={titles[open]} close={close}>
            {open === "commands" && (
                <Choose
                    label="Search the commands"
                    close={done}
                    choices={commands.map(({ name, title, keys, run }) => ({ name, title, run, more: shownKey(keys?.[0]) }))}
                />
            )}
            {open === "keys" && <Keys commands={commands} />}
            {open === "machine" && <Machines screen={screen} close={done} />}
            {open === "source" && (
                <Folder
                    screen={screen}
                    close={done}
                    take={(file) => void studio.open({ file })}
                    takeFolder={(folder) => void studio.open({ folder })}
                    takeOther={(files) => void studio.drop(files)}
                />
            )}
            {open === "program" && (
                <Folder
                    screen={screen}
                    close={done}
                    take={(file) => void studio.proveFile(file)}
                    takeOther={(files) => void studio.proveOther(files)}
                />
            )}
            {open === "options" && <Options screen={screen} close={done} />}
            {open === "save" && <Save screen={screen} close={done} />}
            {open === "find" && <Find screen={screen} close={close} />}
            {open === "go" && <Go screen={screen} close={close} />}
        </Modal>
    );
}

/** `Ctrl+k` is shown as `Ctrl K`, `+` as itself. */
export const shownKey = (key: string | undefined): string =>
    (key ?? "").split(/(?<=.)\+/).map((part) => (part.length === 1 ? part.toUpperCase() : part)).join(" ");

interface ModalProps {
    element: RefObject<HTMLDialogElement | null>;
    title: string;
    close(): void;
    children: ComponentChildren;
}

/** The browser's own dialog: it keeps the focus within, and Escape closes it. */
function Modal({ element, title, close, children }: ModalProps) {
    // Before the browser draws, so that no key that is typed next is lost.
    useLayoutEffect(() => element.current?.showModal(), []);
    return (
        <dialog
            ref={element}
            aria-label={title}
            // Told late: by then another dialog may be open, in the place of this one.
            onClose={(event) => event.currentTarget.isConnected && close()}
            onClick={(event) => event.target === element.current && close()}
        >
            <h2>{title}</h2>
            {children}
            {/* Behind all else: what is asked for has the focus first. */}
            <button type="button" class="close" title="Close (Escape); nothing is changed" aria-label="Close" onClick={close}>
                ✕
            </button>
        </dialog>
    );
}
