import { counted } from "../numbers.ts";
import type { Finding, Severity } from "../protocol/asks.ts";
import type { Screen } from "../screen/screen.ts";

/** A shape beside the colour. */
const marks: Record<Severity, string> = { error: "✗", warning: "▲" };

/** More than this nobody reads; the rest is counted. */
const SHOWN = 1000;

export function Findings({ screen }: { screen: Screen }) {
    const { findings } = screen.studio;
    if (findings.value.length === 0) return <p class="soft hint">No findings.</p>;
    return (
        <ol class="findings">
            {findings.value.slice(0, SHOWN).map((finding, number) => (
                <Row key={number} screen={screen} finding={finding} lit={number === screen.finding.value} lead={() => screen.toFinding(number)} />
            ))}
            {findings.value.length > SHOWN && <li class="soft">and {counted(findings.value.length - SHOWN)} more</li>}
        </ol>
    );
}

/** Options of the form that the way out names. */
export function optionsIn(help: string, form: { name: string }[]): string[] {
    const named = new Set([...help.matchAll(/--([a-z][a-z-]*)/g)].map(([, name]) => name));
    return form.map(({ name }) => name).filter((name) => named.has(name));
}

function Row({ screen, finding, lit, lead }: { screen: Screen; finding: Finding; lit: boolean; lead(): void }) {
    const place = [finding.file, finding.line, finding.column].filter(Boolean).join(":");
    return (
        <li aria-current={lit}>
            <button type="button" onClick={lead}>
                <strong class={finding.severity}>
                    {marks[finding.severity]} {finding.severity}
                </strong>{" "}
                {finding.message} {finding.count > 1 && <b>({counted(finding.count)} times)</b>} <span class="soft">[{finding.rule}]</span>
                {place !== "" && <span class="code soft"> {place}</span>}
            </button>
            {finding.excerpt && <div class="code">{finding.excerpt}</div>}
            {finding.help && (
                <div class="soft">
                    → {finding.help}{" "}
                    {optionsIn(finding.help, screen.studio.form.value).map((name) => (
                        <button key={name} type="button" class="small" onClick={() => screen.toOption(name, optionsIn(finding.help, screen.studio.form.value))}>
                            Set --{name}…
                        </button>
                    ))}
                </div>
            )}
        </li>
    );
}
