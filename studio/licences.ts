/** `licences.txt` beside the page: the terms of every package that is in it. A package without terms ends the build. */

import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import type { Plugin } from "vite";

export const licences: Plugin = {
    name: "licences",
    generateBundle(_, bundle) {
        const modules = Object.values(bundle).flatMap((file) => (file.type === "chunk" ? file.moduleIds : []));
        const folders = new Set(modules.flatMap((path) => /^.*\/node_modules\/(?:@[^/]+\/)?[^/]+/.exec(path.replace("\0", "")) ?? []));
        const terms = [...folders].toSorted().map((folder) => {
            const { name, version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8")) as { name: string; version: string };
            const file = readdirSync(folder).find((one) => /^licen[cs]e/i.test(one));
            if (file === undefined) throw new Error(`${name} has no licence`);
            return `${name} ${version}\n\n${readFileSync(join(folder, file), "utf8").trim()}\n`;
        });
        this.emitFile({ type: "asset", fileName: "licences.txt", source: terms.join("\n---\n\n") });
    },
};
