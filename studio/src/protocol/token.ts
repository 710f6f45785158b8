/** The token of the link: taken out of the address bar, kept for this tab so that a reload finds it. */

const KEY = "toolpost-token";

/** The token, and whether the link with it was opened just now. */
export function token(): { token: string; isNew: boolean } {
    const given = givenToken();
    return given === null ? { token: sessionStorage.getItem(KEY) ?? "", isNew: false } : { token: given, isNew: true };
}

/** That of a link that was opened just now; null where there was none. */
export function givenToken(): string | null {
    const given = location.hash.slice(1).replace(/^token=/, "");
    if (given === "") return null;
    history.replaceState(null, "", location.pathname);
    return given;
}

export const keepToken = (given: string): void => sessionStorage.setItem(KEY, given);
