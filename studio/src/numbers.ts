/** Numbers as they are shown. `toLocaleString` would load the browser's tables of languages first, which holds up the first picture. */

const grouped = (digits: string): string => digits.replaceAll(/\B(?=(\d{3})+$)/g, ",");

/** `1234567` as `1,234,567`. */
export const counted = (count: number): string => grouped(String(count));

/** At most four digits behind the point. */
export function rounded(value: number): string {
    const [whole = "", ...behind] = String(Number(value.toFixed(4))).split(".");
    return [grouped(whole), ...behind].join(".");
}
