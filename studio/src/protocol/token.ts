/** The token of the link: taken out of the address bar, kept for this tab so that a reload finds it. */

const KEY = "toolpost-token";

export function token(): string {
    const given = location.hash.slice(1).replace(/^token=/, "");
    if (given === "") return sessionStorage.getItem(KEY) ?? "";
    sessionStorage.setItem(KEY, given);
    history.replaceState(null, "", location.pathname);
    return given;
}
