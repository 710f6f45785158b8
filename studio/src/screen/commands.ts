import type { Signal } from "@preact/signals";
import type { Command } from "../commands.ts";
import { VIEWS } from "../view/camera.ts";
import { MODES } from "../view/colours.ts";
import type { Drawing } from "../view/viewer.ts";
import { axisOf, type Screen } from "./screen.ts";

const flip = (on: Signal<boolean>) => (): void => {
    on.value = !on.value;
};

export function commandsOf(screen: Screen): Command[] {
    return [...general(screen), ...looking(screen), ...replaying(screen)];
}

function general(screen: Screen): Command[] {
    const { studio } = screen;
    const show = (dialog: typeof screen.dialog.value) => () => {
        screen.dialog.value = dialog;
    };
    return [
        { name: "commands", title: "Commands", keys: ["Ctrl+k"], run: show("commands") },
        { name: "keys", title: "Keys", keys: ["?"], view: true, run: show("keys") },
        { name: "source", title: "Open a source", keys: ["Ctrl+o"], run: show("source") },
        { name: "program", title: "Prove a program from a file against this toolpath", run: show("program") },
        { name: "machine", title: "Choose the machine", keys: ["Ctrl+m"], run: show("machine") },
        { name: "again", title: "Post again", run: () => void studio.again() },
        { name: "options", title: "Options of posting", run: () => screen.toOption("") },
        { name: "save", title: "Save the program", keys: ["Ctrl+s"], run: () => screen.save() },
        { name: "next-program", title: "Next program of the board", run: () => screen.nextProgram(1) },
        { name: "last-program", title: "Previous program of the board", run: () => screen.nextProgram(-1) },
        { name: "discard", title: "Discard the edits by hand", run: () => void studio.discard() },
        { name: "go", title: "Go to a block, source line, move or time", keys: ["Ctrl+g"], run: show("go") },
        { name: "find", title: "Find a text", keys: ["Ctrl+f"], run: () => screen.find() },
        { name: "cancel", title: "Cancel what runs", keys: ["Escape"], run: () => studio.cancel() },
        { name: "next-finding", title: "Next place of a finding", keys: ["F8"], run: () => screen.nextFinding(1) },
        { name: "last-finding", title: "Previous place of a finding", keys: ["Shift+F8"], run: () => screen.nextFinding(-1) },
        { name: "next-pane", title: "Next pane", keys: ["F6"], run: () => screen.nextPane(1) },
        { name: "last-pane", title: "Previous pane", keys: ["Shift+F6"], run: () => screen.nextPane(-1) },
        { name: "to-program", title: "To this block in the program", keys: ["Enter"], view: true, run: () => screen.toText("program") },
        { name: "to-source", title: "To this line in the source", keys: ["Shift+Enter"], view: true, run: () => screen.toText("source") },
    ];
}

function looking(screen: Screen): Command[] {
    const { studio } = screen;
    const turn = (dx: number, dy: number) => () => screen.viewer?.turn(dx, dy);
    const shift = (dx: number, dy: number) => () => screen.viewer?.shift(dx, dy);
    const axis = (): void => {
        const place = studio.cursor.place.value;
        if (place !== null) screen.viewer?.along(axisOf(place.axis));
    };
    const drawBy = (how: Drawing): void => {
        screen.drawing.value = how;
    };
    const wider = (): void => {
        screen.width.value = (screen.width.value % 4) + 1;
    };
    const colours = (): void => {
        const at = MODES.findIndex(({ name }) => name === screen.mode.value);
        screen.mode.value = MODES[(at + 1) % MODES.length]!.name;
    };
    return [
        ...VIEWS.map(({ name }, number) => ({ name: `view-${number + 1}`, title: `${name} view`, keys: [String(number + 1)], view: true, run: () => screen.viewer?.view(number) })),
        { name: "view-tool", title: "Look along the tool", keys: ["0"], view: true, run: axis },
        { name: "fit", title: "Fit what is cut; again: all", keys: ["f"], view: true, run: () => screen.viewer?.fit() },
        { name: "zoom-place", title: "Zoom to the cursor", keys: ["z"], view: true, run: () => screen.zoomToCursor() },
        { name: "zoom-in", title: "Zoom in", keys: ["PageUp"], view: true, run: () => screen.viewer?.zoom(1.25) },
        { name: "zoom-out", title: "Zoom out", keys: ["PageDown"], view: true, run: () => screen.viewer?.zoom(0.8) },
        { name: "turn-left", title: "Turn left", keys: ["ArrowLeft"], view: true, run: turn(25, 0) },
        { name: "turn-right", title: "Turn right", keys: ["ArrowRight"], view: true, run: turn(-25, 0) },
        { name: "turn-up", title: "Turn up", keys: ["ArrowUp"], view: true, run: turn(0, 25) },
        { name: "turn-down", title: "Turn down", keys: ["ArrowDown"], view: true, run: turn(0, -25) },
        { name: "move-left", title: "Move the picture left", keys: ["Shift+ArrowLeft"], view: true, run: shift(-40, 0) },
        { name: "move-right", title: "Move the picture right", keys: ["Shift+ArrowRight"], view: true, run: shift(40, 0) },
        { name: "move-up", title: "Move the picture up", keys: ["Shift+ArrowUp"], view: true, run: shift(0, -40) },
        { name: "move-down", title: "Move the picture down", keys: ["Shift+ArrowDown"], view: true, run: shift(0, 40) },
        { name: "four", title: "Four views, or one", keys: ["q"], view: true, run: flip(screen.four) },
        { name: "rapids", title: "Show rapids, or hide them", keys: ["r"], view: true, run: flip(screen.rapids) },
        { name: "axes", title: "Show tool axes, or hide them", keys: ["v"], view: true, run: flip(screen.axes) },
        { name: "machine-bodies", title: "Show the machine, or hide it", keys: ["m"], view: true, run: flip(screen.machine) },
        { name: "pale", title: "What is ahead is pale, or not", keys: ["n"], view: true, run: flip(screen.pale) },
        { name: "box", title: "Box of all moves", keys: ["b"], view: true, run: flip(screen.box) },
        { name: "ruler", title: "Ruler: dragging measures", keys: ["l"], view: true, run: flip(screen.ruler) },
        { name: "measure", title: "Measure from this place, or no more", keys: ["d"], view: true, run: () => screen.measure() },
        { name: "colours", title: "Colours by the next thing", keys: ["c"], view: true, run: colours },
        { name: "draw-plain", title: "Draw without the graphics processor", run: () => drawBy("plain") },
        { name: "draw-webgl", title: "Draw by WebGL", run: () => drawBy("webgl") },
        { name: "wider", title: "Wider lines", keys: ["w"], view: true, run: wider },
    ];
}

function replaying({ player, studio }: Screen): Command[] {
    return [
        { name: "play", title: "Play, or pause", keys: ["Space"], view: true, run: () => player.toggle() },
        { name: "next-block", title: "Next block", keys: ["."], view: true, run: () => player.stepTo(1, "block") },
        { name: "last-block", title: "Previous block", keys: [","], view: true, run: () => player.stepTo(-1, "block") },
        { name: "next-move", title: "Next move", keys: ["Shift+."], view: true, run: () => player.stepTo(1, "move") },
        { name: "last-move", title: "Previous move", keys: ["Shift+,"], view: true, run: () => player.stepTo(-1, "move") },
        { name: "next-operation", title: "Next operation", keys: ["Ctrl+."], view: true, run: () => player.stepTo(1, "operation") },
        { name: "last-operation", title: "Previous operation", keys: ["Ctrl+,"], view: true, run: () => player.stepTo(-1, "operation") },
        { name: "next-tool", title: "Next tool", keys: ["t"], view: true, run: () => player.stepTo(1, "tool") },
        { name: "last-tool", title: "Previous tool", keys: ["Shift+t"], view: true, run: () => player.stepTo(-1, "tool") },
        { name: "next-of-block", title: "Next move of this block", keys: ["p"], view: true, run: () => void studio.cursor.turn(1) },
        { name: "last-of-block", title: "Previous move of this block", keys: ["Shift+p"], view: true, run: () => void studio.cursor.turn(-1) },
        { name: "first", title: "First move", keys: ["Home"], view: true, run: () => player.end(-1) },
        { name: "last", title: "Last move", keys: ["End"], view: true, run: () => player.end(1) },
        { name: "faster", title: "Faster replay", keys: ["+"], view: true, run: () => player.faster(1) },
        { name: "slower", title: "Slower replay", keys: ["-"], view: true, run: () => player.faster(-1) },
    ];
}
