interface Props {
    name: string;
    label: string;
    value: number;
    /** 1 where the pane before the splitter has the size, -1 where the one behind it has. */
    sign: 1 | -1;
    /** A line between above and below. */
    lying?: boolean;
    set(value: number): void;
}

/** The line between two panes: dragged, or moved by the arrow keys. */
export function Split({ name, label, value, sign, lying = false, set }: Props) {
    const bounded = (size: number): void => set(Math.max(60, Math.min((lying ? innerHeight : innerWidth) * 0.6, size)));
    const drag = (down: PointerEvent): void => {
        const line = down.currentTarget as HTMLElement;
        line.setPointerCapture(down.pointerId);
        const from = lying ? down.clientY : down.clientX;
        const move = (event: PointerEvent): void => bounded(value + sign * ((lying ? event.clientY : event.clientX) - from));
        line.addEventListener("pointermove", move);
        line.addEventListener("lostpointercapture", () => line.removeEventListener("pointermove", move), { once: true });
    };
    const press = (event: KeyboardEvent): void => {
        const steps: Record<string, number> = lying ? { ArrowUp: -1, ArrowDown: 1 } : { ArrowLeft: -1, ArrowRight: 1 };
        const step = steps[event.key];
        if (step === undefined) return;
        event.preventDefault();
        bounded(value + sign * step * (event.shiftKey ? 80 : 16));
    };
    return (
        <div
            class={`split ${name}`}
            role="separator"
            tabIndex={0}
            aria-label={label}
            aria-orientation={lying ? "horizontal" : "vertical"}
            aria-valuenow={Math.round(value)}
            aria-valuemin={60}
            onPointerDown={drag}
            onKeyDown={press}
        />
    );
}
