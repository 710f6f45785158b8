import { effect, signal } from "@preact/signals";
import { render } from "preact";
import { Page } from "./Page.tsx";
import { Socket, Stopped, type State } from "./protocol/seam.ts";
import { leave, rememberedWork, rememberWork, takeLeft } from "./protocol/session.ts";
import { givenToken, keepToken, token } from "./protocol/token.ts";
import { Screen } from "./screen/screen.ts";
import { Studio } from "./studio.ts";
import { Watch } from "./watch.ts";

const { token: given, isNew } = token();
const link = signal<State>("connecting");
const socket = new Socket(given, (state) => (link.value = state));
const studio = new Studio(socket, link);
const screen = new Screen(studio);
// A link that is opened anew shows what its command names.
if (!isNew) {
    studio.work.value = rememberedWork();
    screen.resume(takeLeft());
}
effect(() => {
    if (link.value === "open") void studio.begin();
});
// The browser's storage takes its time to open: what was asked goes out before.
setTimeout(() => {
    if (isNew) keepToken(given);
    effect(() => rememberWork(studio.work.value));
}, 100);
// A link that is pasted into this tab is of a server that has taken the place of the one before: the page goes on with it.
addEventListener("hashchange", () => {
    const other = givenToken();
    if (other === null) return;
    keepToken(other);
    socket.renew(other);
});
addEventListener("pagehide", () => leave(screen.left));
addEventListener("beforeunload", (event) => {
    // A reload finds it again, but neither another page nor another server does.
    if (studio.unkept !== null) event.preventDefault();
});
// What the server refuses to a pane that has not asked why is shown with the findings.
addEventListener("unhandledrejection", (event) => {
    if (!(event.reason instanceof Stopped)) return;
    event.preventDefault();
    if (event.reason.verdict !== "cancelled") studio.stopped.value = event.reason.findings;
});
new Watch(studio).begin();
render(<Page screen={screen} />, document.querySelector("#page")!);
