import { effect, signal } from "@preact/signals";
import { render } from "preact";
import { Page } from "./Page.tsx";
import { Socket, Stopped, type State } from "./protocol/seam.ts";
import { rememberedWork, rememberWork } from "./protocol/session.ts";
import { token } from "./protocol/token.ts";
import { Studio } from "./studio.ts";

const link = signal<State>("connecting");
const studio = new Studio(new Socket(token(), (state) => (link.value = state)), link);
studio.work.value = rememberedWork();
effect(() => rememberWork(studio.work.value));
effect(() => {
    if (link.value === "open") void studio.begin();
});
// What the server refuses to a pane that has not asked why is shown with the findings.
addEventListener("unhandledrejection", (event) => {
    if (!(event.reason instanceof Stopped)) return;
    event.preventDefault();
    if (event.reason.verdict !== "cancelled") studio.stopped.value = event.reason.findings;
});
render(<Page studio={studio} />, document.querySelector("#page")!);
