import type { Command } from "../commands.ts";
import { shownKey } from "./Dialogs.tsx";

export function Keys({ commands }: { commands: Command[] }) {
    return (
        <>
            <p>Keys without Ctrl or a function key work while the view has the focus (F6 goes there).</p>
            <div class="choices" role="region" aria-label="List of keys" tabIndex={0}>
                <table>
                <tbody>
                    {commands
                        .filter(({ keys }) => keys !== undefined)
                        .map(({ name, keys, title }) => (
                            <tr key={name}>
                                <th scope="row">
                                    {keys!.map((key) => (
                                        <kbd key={key}>{shownKey(key)}</kbd>
                                    ))}
                                </th>
                                <td>{title}</td>
                            </tr>
                        ))}
                </tbody>
                </table>
            </div>
        </>
    );
}
