import type { Asked, TextParams } from "./asks.ts";
import type { Seam } from "./seam.ts";

/** Lines of a text, in as many answers as the server gives it in. They are joined by LF, without one at the end. */
export async function readText(seam: Seam, params: Asked<TextParams>): Promise<string> {
    const decoder = new TextDecoder();
    let text = "";
    for (let { from } = params; from < params.to; ) {
        const { done, arrays } = await seam.ask("text", { ...params, from });
        text += decoder.decode(arrays.text as Uint8Array | undefined, { stream: true });
        if (done.to <= from) break;
        from = done.to;
    }
    return text.replace(/\n$/, "");
}
