"""Harsh five-axis jobs, made by a seed: cutter-location data as a CAM system would write it."""

from __future__ import annotations

import math
import random

Vector = tuple[float, float, float]


class Job:
    """Writes one file. The part is a block of 80 x 60 x 30 mm about the origin, its top at Z 0."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.lines = [f"PARTNO/JOB{seed}", "UNITS/MM", "MULTAX/ON"]
        self.at: Vector = (0.0, 0.0, 0.0)
        self.axis: Vector = (0.0, 0.0, 1.0)
        operations = [self.facing, self.tilted, self.turning, self.pole, self.holes, self.corner]
        for number in range(1, self.random.randint(2, 4)):
            self.load(number)
            for _ in range(self.random.randint(1, 3)):
                self.random.choice(operations)()
        self.lines.append("FINI")

    @property
    def text(self) -> str:
        return "\n".join(self.lines) + "\n"

    def load(self, number: int) -> None:
        length = self.random.choice([60.0, 95.5, 140.0])
        self.lines += [
            f"LOAD/TOOL,{number},LENGTH,{length}",
            f"SPINDL/RPM,{self.random.choice([800, 4000, 9000])},CLW",
            self.random.choice(["COOLNT/ON", "COOLNT/OFF"]),
        ]

    def tilt(self, lean: float, around: float) -> Vector:
        """Tool axis from the angle to Z, and the direction about it; degrees."""
        t, p = math.radians(lean), math.radians(around)
        return (math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))

    def to(self, tip: Vector, axis: Vector, rapid: bool = False) -> None:
        if rapid:
            self.lines.append("RAPID")
        self.lines.append("GOTO/" + ",".join(f"{v:.6f}" for v in (*tip, *axis)))
        self.at, self.axis = tip, axis

    def away(self, height: float) -> None:
        """Rapid along the tool axis."""
        self.to(along(self.at, self.axis, height), self.axis, rapid=True)

    def begin(self, tip: Vector, axis: Vector, height: float) -> None:
        """Rapid to a height above the start, to just above it, then by feed."""
        self.to(along(tip, axis, height), axis, rapid=True)
        self.to(along(tip, axis, 2.0), axis, rapid=True)
        self.feed()
        self.to(tip, axis)

    def feed(self) -> None:
        self.lines.append(f"FEDRAT/MMPM,{self.random.choice([150, 600, 1500])}")

    def spot(self) -> Vector:
        r = self.random
        return (
            round(r.uniform(-38, 38), 3),
            round(r.uniform(-28, 28), 3),
            round(r.uniform(-6, 0), 3),
        )

    def height(self) -> float:
        return self.random.choice([60.0, 90.0, 120.0])

    def facing(self) -> None:
        """Cut with the tool upright, with an arc."""
        x, y, z = self.spot()
        up = (0.0, 0.0, 1.0)
        height = self.height()
        self.begin((x, y, z), up, height)
        self.to((x + 10, y, z), up)
        radius = self.random.uniform(2, 15)
        self.lines.append(f"CIRCLE/{x + 10:.6f},{y + radius:.6f},{z:.6f},0,0,1,{radius:.6f}")
        self.to((x + 10, y + 2 * radius, z), up)
        self.to((x - 5, y + 2 * radius, z), up)
        self.away(height)

    def tilted(self) -> None:
        """Cut a slope with one tool axis, and cross low over it by rapid."""
        axis = self.tilt(self.random.uniform(5, 75), self.random.uniform(-180, 180))
        side = across(axis)
        start = self.spot()
        height = self.height()
        self.begin(start, axis, height)
        self.to(along(start, side, 12.0), axis)
        self.away(self.random.choice([3.0, 8.0]))
        self.to(along(self.at, side, -20.0), axis, rapid=True)
        self.to(along(self.at, axis, -2.5), axis, rapid=True)
        self.feed()
        self.to(along(self.at, axis, -1.0), axis)
        self.to(along(self.at, side, 10.0), axis)
        self.away(height)

    def turning(self) -> None:
        """Turn the tool while it cuts: a big turn about Z, or a swing, in steps of any size."""
        r = self.random
        lean, around = r.uniform(5, 60), r.uniform(-180, 180)
        turn, swing = r.choice([40, 200, 500, -720]), r.uniform(-30, 30)
        steps = r.choice([6, 20, 60]) if abs(turn) < 90 else 60
        tip = self.spot()
        height = self.height()
        self.begin(tip, self.tilt(lean, around), height)
        for k in range(1, steps + 1):
            s = k / steps
            swung = min(max(lean + swing * s, 2.0), 80.0)
            spread = 25 * s
            place = (
                tip[0] + spread * math.cos(6 * s),
                tip[1] + spread * math.sin(6 * s),
                tip[2] - s,
            )
            self.to(place, self.tilt(swung, around + turn * s))
        self.away(height)

    def pole(self) -> None:
        """Pass over the pole, or close to it, while cutting."""
        r = self.random
        lean, around = r.uniform(5, 40), r.uniform(-180, 180)
        miss = r.choice([0.0, 0.02, 0.5, 3.0])
        tip = self.spot()
        height = self.height()
        side = self.tilt(90, around)
        steps = r.choice([2, 8, 30])
        self.begin(tip, self.lean_over(side, lean, miss), height)
        for k in range(1, steps + 1):
            angle = lean * (1 - 2 * k / steps)
            self.to(along(tip, side, 30 * k / steps), self.lean_over(side, angle, miss))
        self.away(height)

    def lean_over(self, side: Vector, angle: float, miss: float) -> Vector:
        one, two = math.radians(angle), math.radians(miss)
        cross = (-side[1], side[0], 0.0)
        return (
            side[0] * math.sin(one) + cross[0] * math.cos(one) * math.sin(two),
            side[1] * math.sin(one) + cross[1] * math.cos(one) * math.sin(two),
            math.cos(one) * math.cos(two),
        )

    def holes(self) -> None:
        """Drill some holes, each with an axis of its own or all with one."""
        r = self.random
        kind = r.choice(["DRILL", "DEEP", "BRKCHP", "REAM"])
        step = ",STEP,2" if kind in ("DEEP", "BRKCHP") else ""
        same = r.random() < 0.6
        axis = self.tilt(r.choice([0.0, r.uniform(5, 70)]), r.uniform(-180, 180))
        self.to(along(self.spot(), axis, 60.0), axis, rapid=True)
        self.lines.append(f"CYCLE/{kind},RAPTO,3,FEDTO,7,RTRCTO,40,MMPM,150{step}")
        for _ in range(r.randint(1, 4)):
            if not same:
                axis = self.tilt(r.uniform(0, 50), r.uniform(-180, 180))
            self.to(self.spot(), axis)
        self.lines.append("CYCLE/OFF")
        self.to(along(self.at, axis, 70.0), axis, rapid=True)

    def corner(self) -> None:
        """Go by rapid to another tool axis close to the part."""
        r = self.random
        one = self.tilt(r.uniform(0, 30), r.uniform(-180, 180))
        two = self.tilt(r.uniform(0, 60), r.uniform(-180, 180))
        start = self.spot()
        self.begin(start, one, self.height())
        self.to(along(start, across(one), 5.0), one)
        self.away(r.choice([4.0, 12.0]))
        self.to(along(self.spot(), two, r.choice([5.0, 25.0])), two, rapid=True)
        self.feed()
        self.to(along(self.at, two, -4.0), two)
        self.to(along(self.at, across(two), 6.0), two)
        self.away(90.0)


def along(point: Vector, way: Vector, length: float) -> Vector:
    x, y, z = (p + length * w for p, w in zip(point, way))
    return (x, y, z)


def across(axis: Vector) -> Vector:
    """Return a direction at right angles to the tool axis."""
    flat = math.hypot(axis[0], axis[1])
    if flat < 1e-9:
        return (1.0, 0.0, 0.0)
    return (-axis[1] / flat, axis[0] / flat, 0.0)


def job(seed: int) -> str:
    """Text of the job of a seed."""
    return Job(seed).text
