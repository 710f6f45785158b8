import { effect, signal } from "@preact/signals";
import { render } from "preact";
import { Page } from "./Page.tsx";
import { Socket, type State } from "./protocol/seam.ts";
import { token } from "./protocol/token.ts";
import { Studio } from "./studio.ts";

const link = signal<State>("connecting");
const studio = new Studio(new Socket(token(), (state) => (link.value = state)), link);
effect(() => {
    if (link.value === "open") void studio.begin();
});
render(<Page studio={studio} />, document.querySelector("#page")!);
