import type { Screen, Tab } from "../screen/screen.ts";
import { Findings } from "./Findings.tsx";
import { Plots } from "./Plots.tsx";
import { Verdict } from "./Verdict.tsx";

/** The panes below: one of them is shown. */
export function Low({ screen }: { screen: Screen }) {
    const { tab, studio } = screen;
    const tabs: [Tab, string][] = [
        ["findings", `Findings ${studio.findings.value.length}`],
        ["verdict", "Verdict"],
        ["plots", "Axes over time"],
    ];
    const press = (event: KeyboardEvent): void => {
        const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (step === undefined) return;
        const at = tabs.findIndex(([name]) => name === tab.value);
        const next = tabs[(at + step + tabs.length) % tabs.length]!;
        tab.value = next[0];
        document.querySelector<HTMLElement>(`#tab-${next[0]}`)?.focus();
    };
    return (
        <section class="pane low" aria-label="Findings and verdict">
            <div class="tabs" role="tablist" onKeyDown={press}>
                {tabs.map(([name, title]) => (
                    <button
                        key={name}
                        id={`tab-${name}`}
                        type="button"
                        role="tab"
                        aria-selected={tab.value === name}
                        aria-controls="low"
                        tabIndex={tab.value === name ? 0 : -1}
                        onClick={() => (tab.value = name)}
                    >
                        {title}
                    </button>
                ))}
            </div>
            <div class="body" id="low" role="tabpanel" aria-labelledby={`tab-${tab.value}`} tabIndex={0} data-pane>
                {tab.value === "findings" && <Findings screen={screen} />}
                {tab.value === "verdict" && <Verdict screen={screen} />}
                {tab.value === "plots" && <Plots screen={screen} />}
            </div>
        </section>
    );
}
