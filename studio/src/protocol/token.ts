/** The token of the link: taken out of the address bar, kept for this tab so that a reload finds it. */

const KEY = "toolpost-token";

/** The token, and whether the link with it was opened just now. */
export function token(): { token: string; isNew: boolean } {
    const given = location.hash.slice(1).replace(/^token=/, "");
    if (given === "") return { token: sessionStorage.getItem(KEY) ?? "", isNew: false };
    history.replaceState(null, "", location.pathname);
    return { token: given, isNew: true };
}

export const keepToken = (given: string): void => sessionStorage.setItem(KEY, given);
