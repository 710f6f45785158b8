import type { ComponentChildren } from "preact";
import { counted } from "../numbers.ts";
import type { Screen } from "../screen/screen.ts";
import { clock } from "./Timeline.tsx";

interface Listed {
    move: number;
    time_s: number;
}

/** Moves to look at: a line that says what they are, and below it a button for each that leads there; of more than `most` their count. */
export function Moves<M extends Listed>(props: { screen: Screen; moves: M[]; all: number; most: number; text(move: M): string; children: ComponentChildren }) {
    const shown = props.moves.slice(0, props.most);
    const more = props.all - shown.length;
    if (props.all === 0) return null;
    return (
        <details class="jumps">
            <summary>{props.children}</summary>
            <ol>
                {shown.map((listed, number) => (
                    <li key={number}>
                        <button type="button" onClick={() => void props.screen.studio.cursor.toMove(listed.move)}>
                            {props.text(listed)}
                        </button>{" "}
                        <span class="soft">
                            move {counted(listed.move + 1)}, {clock(listed.time_s)}
                        </span>
                    </li>
                ))}
                {more > 0 && <li class="soft">and {counted(more)} more</li>}
            </ol>
        </details>
    );
}
