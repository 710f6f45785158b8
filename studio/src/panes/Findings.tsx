import { counted } from "../numbers.ts";
import type { Finding, Severity } from "../protocol/asks.ts";
import { placesOf, type Screen } from "../screen/screen.ts";

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
                <Row key={number} screen={screen} finding={finding} number={number} />
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

/** The places of a finding that stands for several, one after the other. */
function Places({ screen, finding, number }: { screen: Screen; finding: Finding; number: number }) {
    const places = placesOf(finding);
    if (places.length < 2) return null;
    const isLit = number === screen.finding.value;
    const at = isLit ? screen.findingPlace.value : -1;
    return (
        <div class="steps">
            <button type="button" class="small" title="Previous place (Shift F8)" aria-label="Previous place of this finding" onClick={() => screen.toFinding(number, at - 1)}>
                ‹
            </button>
            <span aria-live={isLit ? "polite" : "off"}>{isLit ? `line ${counted(places[at]!)}: ${counted(at + 1)} of ${counted(places.length)} places` : `${counted(places.length)} places`}</span>
            <button type="button" class="small" title="Next place (F8)" aria-label="Next place of this finding" onClick={() => screen.toFinding(number, at + 1)}>
                ›
            </button>
        </div>
    );
}

function Row({ screen, finding, number }: { screen: Screen; finding: Finding; number: number }) {
    const place = [finding.file, finding.line, finding.column].filter(Boolean).join(":");
    return (
        <li aria-current={number === screen.finding.value}>
            <button type="button" onClick={() => screen.toFinding(number)}>
                <strong class={finding.severity}>
                    {marks[finding.severity]} {finding.severity}
                </strong>{" "}
                {finding.message} {finding.count > 1 && <b>({counted(finding.count)} times)</b>} <span class="soft">[{finding.rule}]</span>
                {place !== "" && <span class="code soft"> {place}</span>}
            </button>
            <Places screen={screen} finding={finding} number={number} />
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
