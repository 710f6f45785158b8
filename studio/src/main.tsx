import { effect, signal } from "@preact/signals";
import { render } from "preact";
import { Page } from "./Page.tsx";
import { Socket, Stopped, type State } from "./protocol/seam.ts";
import { rememberedWork, rememberWork } from "./protocol/session.ts";
import { keepToken, token } from "./protocol/token.ts";
import { Studio } from "./studio.ts";

const { token: given, isNew } = token();
const link = signal<State>("connecting");
const studio = new Studio(new Socket(given, (state) => (link.value = state)), link);
// A link that is opened anew shows what its command names.
if (!isNew) studio.work.value = rememberedWork();
effect(() => {
    if (link.value === "open") void studio.begin();
});
// The browser's storage takes its time to open: what was asked goes out before.
setTimeout(() => {
    if (isNew) keepToken(given);
    effect(() => rememberWork(studio.work.value));
}, 100);
// What the server refuses to a pane that has not asked why is shown with the findings.
addEventListener("unhandledrejection", (event) => {
    if (!(event.reason instanceof Stopped)) return;
    event.preventDefault();
    if (event.reason.verdict !== "cancelled") studio.stopped.value = event.reason.findings;
});
render(<Page studio={studio} />, document.querySelector("#page")!);
