/** Colours of the texts: for each family of languages, what its words look like. First come, first served. */

import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { tags } from "@lezer/highlight";
import { isToolpath } from "./names.ts";

export type Tag = "comment" | "string" | "keyword" | "meta" | "number" | "typeName" | "variableName";
export type Family = "iso" | "heidenhain" | "krl" | "rapid" | "ls" | "script" | "apt" | "toml";

type Rule = [RegExp, Tag];

const number: Rule = [/[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?/y, "number"];
const text: Rule = [/"[^"]*"?/y, "string"];
const ordered = (words: string): RegExp => new RegExp(`\\b(${words})\\b`, "iy");

const RULES: Record<Family, Rule[]> = {
    iso: [
        [/\([^)]*\)?|;.*/y, "comment"],
        text,
        [/[NO:]\s*\d+|^%.*|^\/\d?/iy, "meta"],
        [/[GM]\s*\d+(\.\d+)?/iy, "keyword"],
        [/#(<[^>]*>|\d+)|R\d+(?=\s*=)|Q\d+/iy, "variableName"],
        [/[A-Z_$][A-Z_0-9$]+/iy, "typeName"],
        [/[A-Z]/iy, "typeName"],
        number,
    ],
    heidenhain: [
        [/;.*/y, "comment"],
        text,
        [/^\s*\d+(?=\s)/y, "meta"],
        [/\bM\d+/iy, "keyword"],
        [ordered("BEGIN|END|PGM|BLK|FORM|TOOL|CALL|DEF|CYCL|LBL|FN|L|C|CC|CP|CR|CT|LP|LN|RND|CHF|APPR|DEP|STOP|PLANE|FMAX|MAX|R0|RL|RR"), "keyword"],
        [/Q[LRS]?\d+/iy, "variableName"],
        [/[A-Z]/iy, "typeName"],
        number,
    ],
    krl: [
        [/;.*/y, "comment"],
        text,
        [/^&.*/y, "meta"],
        [ordered("DEF|DEFFCT|DEFDAT|END|ENDFCT|ENDDAT|DECL|PTP|LIN|CIRC|SPTP|SLIN|SCIRC|SPLINE|ENDSPLINE|WAIT|FOR|SEC|IF|THEN|ELSE|ENDIF|WHILE|ENDWHILE|LOOP|ENDLOOP|INT|REAL|BOOL|BAS|C_DIS|C_PTP|TRIGGER|DO"), "keyword"],
        [/\$\w+/y, "variableName"],
        [/[A-Z_]\w*/iy, "typeName"],
        number,
    ],
    rapid: [
        [/!.*/y, "comment"],
        text,
        [ordered("MODULE|ENDMODULE|PROC|ENDPROC|FUNC|ENDFUNC|CONST|PERS|VAR|LOCAL|TASK|MoveL|MoveJ|MoveC|MoveAbsJ|IF|THEN|ELSE|ENDIF|FOR|FROM|TO|DO|ENDFOR|WHILE|ENDWHILE|RETURN|TRUE|FALSE|Load|UnLoad|Set|Reset|WaitTime"), "keyword"],
        [/\\\w+/y, "variableName"],
        [/[A-Z_]\w*/iy, "typeName"],
        number,
    ],
    ls: [
        [/(?<=^\s*\d*\s*:\s*)!.*/y, "comment"],
        text,
        [/^\s*\/[A-Z]+|^\s*\d*\s*:/iy, "meta"],
        [ordered("J|L|C|A|S|FINE|CNT\\d+|WAIT|CALL|IF|THEN|ELSE|ENDIF|JMP|LBL|FOR|TO|ENDFOR|RUN|END|ABORT|PAUSE|OVERRIDE|ON|OFF|ACC\\d*|Offset|Tool_Offset"), "keyword"],
        [/(PR|P|R|DO|DI|RO|RI|AO|AI|GO|GI|UFRAME|UTOOL|SR|F)(?=\[)|\$[\w.]+/iy, "variableName"],
        [/[A-Z_]\w*/iy, "typeName"],
        number,
    ],
    script: [
        [/(#|\/\/|--).*/y, "comment"],
        text,
        [ordered("def|end|if|elif|else|while|for|return|global|local|thread|sync|movej|movel|movec|movep|True|False|program|begin|function|do|then"), "keyword"],
        [/[A-Z_]\w*/iy, "typeName"],
        number,
    ],
    apt: [
        [/\$\$.*/y, "comment"],
        [/(PPRINT|PARTNO|REMARK|INSERT)\b.*/iy, "comment"],
        text,
        [/[A-Z]\w*(?=\s*\/)/iy, "keyword"],
        [/[A-Z]\w*/iy, "typeName"],
        number,
    ],
    toml: [
        [/#.*/y, "comment"],
        [/"""|'''/y, "string"],
        text,
        [/'[^']*'?/y, "string"],
        [/^\s*\[\[?[^\]]*\]\]?/y, "meta"],
        [/[\w-]+(?=\s*=)/y, "keyword"],
        [/\{[{%][^}]*[}%]\}?/y, "variableName"],
        number,
    ],
};

/** The tokens of a line: text and tag. */
export function tokens(family: Family, line: string): [string, Tag | null][] {
    const found: [string, Tag | null][] = [];
    for (let at = 0; at < line.length; ) {
        const [length, tag] = tokenAt(family, line, at);
        const last = found.at(-1);
        if (tag === null && last?.[1] === null) last[0] += line.slice(at, at + length);
        else found.push([line.slice(at, at + length), tag]);
        at += length;
    }
    return found;
}

function tokenAt(family: Family, line: string, at: number): [number, Tag | null] {
    for (const [rule, tag] of RULES[family]) {
        rule.lastIndex = at;
        const length = rule.exec(line)?.[0].length ?? 0;
        if (length > 0) return [length, tag];
    }
    return [1, null];
}

/** By what the server calls the dialect, else by the file's name. */
export function familyOf(dialect: string | null | undefined, file: string): Family {
    const name = (dialect ?? "").toLowerCase();
    const extension = file.replace(/^.*\./, "").toLowerCase();
    if (extension === "toml") return "toml";
    if (name.includes("heidenhain") || extension === "h") return "heidenhain";
    if (name.includes("krl") || name.includes("kuka") || ["src", "dat"].includes(extension)) return "krl";
    if (name.includes("rapid") || ["mod", "prg", "modx"].includes(extension)) return "rapid";
    if (extension === "ls") return "ls";
    if (name.includes("script") || ["script", "urp", "jbi", "jss"].includes(extension)) return "script";
    if (isToolpath(file)) return "apt";
    return "iso";
}

const style = HighlightStyle.define([
    { tag: tags.comment, color: "var(--code-comment)", fontStyle: "italic" },
    { tag: tags.string, color: "var(--code-string)" },
    { tag: tags.keyword, color: "var(--code-keyword)", fontWeight: "bold" },
    { tag: tags.meta, color: "var(--soft)" },
    { tag: tags.number, color: "var(--ink)" },
    { tag: tags.typeName, color: "var(--code-name)" },
    { tag: tags.variableName, color: "var(--code-variable)" },
]);

const made = new Map<Family, Extension>();

export function coloured(family: Family): Extension {
    const known = made.get(family);
    if (known !== undefined) return known;
    const language = StreamLanguage.define({
        name: family,
        token(stream) {
            const [length, tag] = tokenAt(family, stream.string, stream.pos);
            stream.pos += length;
            return tag;
        },
    });
    const extension = [language, syntaxHighlighting(style)];
    made.set(family, extension);
    return extension;
}
