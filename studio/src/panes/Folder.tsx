import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Entry } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { isReport } from "../text/names.ts";
import { Choose, type Choice } from "./Choose.tsx";

interface Props {
    screen: Screen;
    close(): void;
    take(path: string): void;
    /** A folder whose files are those of a board. */
    takeFolder?: (path: string) => void;
    takeOther(files: File[]): void;
}

/** The files of the named folder; any other file is picked or dropped. */
export function Folder({ screen, close, take, takeFolder, takeOther }: Props) {
    const { studio } = screen;
    const path = useSignal("");
    const entries = useSignal<Entry[]>([]);
    // A page that has just been opened may have no connection yet, and one that was lost comes back.
    const isOpen = studio.link.value === "open";
    useEffect(() => {
        if (!isOpen) return;
        const asked = path.value;
        // One may have gone on to another folder meanwhile.
        void studio.seam.ask("folder", { path: asked }).then(({ done }) => asked === path.value && (entries.value = done.entries));
    }, [path.value, isOpen]);
    const up: Choice[] =
        path.value === ""
            ? []
            : [{ name: "..", title: "..", more: "folder above", run: () => (path.value = path.value.replace(/\/?[^/]*$/, "")) }];
    const whole: Choice[] =
        takeFolder === undefined
            ? []
            : [
                  {
                      name: ".",
                      title: `All files of ${path.value === "" ? "this folder" : path.value} as a circuit board`,
                      run: () => {
                          close();
                          takeFolder(path.value);
                      },
                  },
              ];
    const choices = entries.value.filter(({ name }) => !isReport(name)).map(({ name, path: to, kind, bytes }) => ({
        name: to,
        title: kind === "folder" ? `${name}/` : name,
        more: bytes === null ? "" : size(bytes),
        run: () => {
            if (kind === "folder") path.value = to;
            else {
                close();
                take(to);
            }
        },
    }));
    return (
        <>
            <p>
                <label>
                    {takeFolder === undefined ? "A file from elsewhere" : "A file from elsewhere, or those of a board or a block of glass"}{" "}
                    <input
                        type="file"
                        multiple
                        onChange={(event) => {
                            const files = [...(event.currentTarget.files ?? [])];
                            close();
                            if (files.length > 0) takeOther(files);
                        }}
                    />
                </label>
            </p>
            <Choose key={path.value} label={`Search the folder ${path.value}`} choices={[...choices, ...up, ...whole]} close={() => {}} />
        </>
    );
}

export function size(bytes: number): string {
    if (bytes < 1000) return `${bytes} B`;
    return bytes < 1e6 ? `${(bytes / 1e3).toFixed(1)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
