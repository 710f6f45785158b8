import type { Screen } from "../screen/screen.ts";

/** The rows of the command's summary. */
export function Verdict({ screen }: { screen: Screen }) {
    const job = screen.studio.job.value;
    if (job === null) return <p class="soft hint">No program yet.</p>;
    return (
        <table class="hint">
            <tbody>
                {job.rows.map(([head, text]) => (
                    <tr key={head}>
                        <th scope="row">{head}</th>
                        <td>{text}</td>
                    </tr>
                ))}
            </tbody>
        </table>
    );
}
