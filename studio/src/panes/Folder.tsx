import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Entry } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";
import { Choose, type Choice } from "./Choose.tsx";

interface Props {
    screen: Screen;
    close(): void;
    take(path: string): void;
    takeOther(file: File): void;
}

/** The files of the named folder; any other file is picked or dropped. */
export function Folder({ screen, close, take, takeOther }: Props) {
    const { studio } = screen;
    const path = useSignal("");
    const entries = useSignal<Entry[]>([]);
    useEffect(() => {
        void studio.seam.ask("folder", { path: path.value }).then(({ done }) => (entries.value = done.entries));
    }, [path.value]);
    const up: Choice[] =
        path.value === ""
            ? []
            : [{ name: "..", title: "..", more: "folder above", run: () => (path.value = path.value.replace(/\/?[^/]*$/, "")) }];
    const choices = entries.value.map(({ name, path: to, kind, bytes }) => ({
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
                    A file from elsewhere{" "}
                    <input
                        type="file"
                        onChange={(event) => {
                            const file = event.currentTarget.files?.[0];
                            close();
                            if (file) takeOther(file);
                        }}
                    />
                </label>
            </p>
            <Choose key={path.value} label={`Search the folder ${path.value}`} choices={[...up, ...choices]} close={() => {}} />
        </>
    );
}

export function size(bytes: number): string {
    if (bytes < 1000) return `${bytes} B`;
    return bytes < 1e6 ? `${(bytes / 1e3).toFixed(1)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
