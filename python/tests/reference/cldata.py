"""Cutter-location data: ISO 4343 as NX, SolidWorks CAM and Makino write it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from .machine import ARRAY, Z, rotate

#: Words that move nothing and say nothing that is compared.
SILENT = [
    "PARTNO",
    "PPRINT",
    "INSERT",
    "PAINT",
    "TOOL",
    "TLDATA",
    "CUTTER",
    "TPRINT",
    "CSI_SET_FLUTE_LENGTH",
    "END-OF-PATH",
    "CSI_SET_EXTENSION_LENGTH",
    "SELECT",
    "SELCTL",
    "SET",
    "MODE",
    "STOP",
    "OPSTOP",
    "DELAY",
    "INTOL",
    "OUTTOL",
    "FINI",
]
#: Chord error of arcs, mm.
CHORD = 1e-3


@dataclass
class Move:
    """A straight piece of the way: from a pose to a pose."""

    start: ARRAY | None
    end: ARRAY
    axis: tuple[ARRAY, ARRAY]
    rapid: bool
    line: int
    #: mm/min; of a rapid, and of the way out of a hole, none.
    feed: float | None
    #: Tool, spindle speed (clockwise positive), coolant on, side of compensation.
    state: tuple[int, float, bool, str]
    hole: bool = False
    #: Of a hole: how far above the surface of the part its feed begins, mm.
    clear: float = 0.0


@dataclass
class Source:
    """What a file makes the tool do."""

    moves: list[Move] = field(default_factory=list)
    #: Length from the gauge line, by tool, where the file gives it.
    lengths: dict[int, float] = field(default_factory=dict)


class Reader:
    """Modal state while a file is read."""

    def __init__(self, text: str) -> None:
        self.out = Source()
        self.nx = "TOOL PATH/" in text
        # NX and Makino count arcs clockwise about the vector, SolidWorks CAM and ISO do not.
        self.way = -1.0 if self.nx or "APTCL-SPEC,MAKINO" in text else 1.0
        self.at: ARRAY | None = None
        self.axis = Z
        self.scale, self.frame, self.first = 1.0, np.eye(4), np.empty((0, 0))
        # A file that loads no tool is cut with the first one.
        self.tool, self.speed, self.coolant, self.side = 1, 0.0, False, ""
        self.feed: tuple[float, str] = (np.nan, "MMPM")
        self.rapid = False
        self.circle: list[float] | None = None
        self.cycle: dict[str, float] | None = None
        self.cycle_kind = ""
        self.level: float | None = None
        for number, record in records(text):
            self.line = number
            word, _, rest = record.partition("/")
            values = [part.strip() for part in rest.split(",")] if rest else []
            name = re.sub(r"[^A-Za-z0-9]", "_", word.split()[0].strip()).lower()
            if word.split()[0] in SILENT:
                if word == "TOOL PATH":
                    self.circle = None
                continue
            handler = getattr(self, f"on_{name}", None)
            if handler is None:
                raise ValueError(f"line {number}: {record}: not known")
            handler(values)

    # Words, in alphabetical order.

    def on_circle(self, values: list[str]) -> None:
        self.circle = [float(value) for value in values[:7]]

    def on_coolnt(self, values: list[str]) -> None:
        self.coolant = values[0] != "OFF"

    def on_csys(self, values: list[str]) -> None:
        # Coordinates are those of the world; the tool stands along the third column until a GOTO
        # gives its axis.
        self.axis = np.array([float(values[k]) for k in (2, 6, 10)])

    def on_cutcom(self, values: list[str]) -> None:
        self.side = {"LEFT": "left", "RIGHT": "right", "OFF": ""}[values[0]]

    def on_cycle(self, values: list[str]) -> None:
        kind, rest = values[0], values[1:]
        if kind in ("INIT", "CLEAR"):
            return
        self.level = None
        if kind == "OFF":
            self.cycle = None
            return
        words: dict[str, float] = {}
        while rest:
            word = rest.pop(0)
            auto = bool(rest) and rest[0] == "AUTO"
            words[word] = np.nan if auto else float(rest[0])
            rest.pop(0)
        self.cycle_kind, self.cycle = kind, words

    def on_fedrat(self, values: list[str]) -> None:
        unit = [value for value in values if value.isalpha()]
        number = next(float(value) for value in values if not value.isalpha())
        self.feed = (number, unit[0] if unit else self.feed[1])

    def on_from(self, values: list[str]) -> None:
        self.at = self.pose(values)[0]

    def on_goto(self, values: list[str]) -> None:
        end, axis = self.pose(values)
        if self.cycle is not None and not self.rapid:
            self.drill(end, axis)
        elif self.circle is not None:
            self.arc(end, axis)
        else:
            self.to(end, axis, self.rapid)
        self.rapid, self.circle = False, None

    def on_load(self, values: list[str]) -> None:
        self.tool = int(values[1])
        # The change stops the spindle and the coolant.
        self.speed, self.coolant = 0.0, False
        if "LENGTH" in values:
            self.out.lengths[self.tool] = float(values[values.index("LENGTH") + 1])

    def on_loadtl(self, values: list[str]) -> None:
        self.on_load(["TOOL", *values])

    def on_msys(self, values: list[str]) -> None:
        numbers = np.array([float(value) for value in values])
        frame = np.eye(4)
        frame[:3, 3] = numbers[:3]
        frame[:3, 0], frame[:3, 1] = numbers[3:6], numbers[6:9]
        frame[:3, 2] = np.cross(numbers[3:6], numbers[6:9])
        if not self.first.size:
            self.first = frame
        self.frame = np.linalg.inv(self.first) @ frame
        self.axis = self.frame[:3, 2]

    def on_multax(self, values: list[str]) -> None:
        if values == ["OFF"]:
            self.axis = Z

    def on_rapid(self, _: list[str]) -> None:
        self.rapid = True

    def on_spindl(self, values: list[str]) -> None:
        if values == ["OFF"]:
            self.speed = 0.0
            return
        number = next(float(value) for value in values if not value.isalpha())
        if "RPM" not in values:
            raise ValueError(f"line {self.line}: spindle in another unit than RPM")
        self.speed = -number if "CCLW" in values else number

    def on_trntyp(self, values: list[str]) -> None:
        if values != ["WORLD", "0", "0", "0"]:
            raise ValueError(f"line {self.line}: coordinates are not those of the world")

    def on_unit(self, values: list[str]) -> None:
        self.scale = {"MM": 1.0, "INCHES": 25.4, "IN": 25.4, "INCH": 25.4}[values[0]]

    on_units = on_unit

    # Motion.

    def pose(self, values: list[str]) -> tuple[ARRAY, ARRAY]:
        numbers = [float(value) for value in values]
        if len(numbers) not in (3, 6):
            raise ValueError(f"line {self.line}: GOTO of {len(numbers)} values")
        turn = self.frame[:3, :3]
        axis = self.axis
        if len(numbers) == 6:
            axis = turn @ np.array(numbers[3:])
            axis = axis / np.linalg.norm(axis)
        return turn @ (self.scale * np.array(numbers[:3])) + self.frame[:3, 3], axis

    def rate(self, feed: tuple[float, str]) -> float:
        number, unit = feed
        factor = {
            "MMPM": 1.0,
            "IPM": 25.4,
            "PERMIN": self.scale,
            "MMPR": abs(self.speed),
            "IPR": 25.4 * abs(self.speed),
            "PERREV": self.scale * abs(self.speed),
        }
        return number * factor[unit]

    def to(
        self, end: ARRAY, axis: ARRAY, rapid: bool, feed: float | None = None, hole: bool = False
    ) -> None:
        if not rapid and feed is None:
            feed = self.rate(self.feed)
        state = (self.tool, self.speed, self.coolant, self.side)
        ways = (self.axis, axis)
        move = Move(self.at, end, ways, rapid, self.line, None if rapid else feed, state, hole)
        self.out.moves.append(move)
        self.at, self.axis = end, axis

    def arc(self, end: ARRAY, axis: ARRAY) -> None:
        if self.at is None or self.circle is None or not np.allclose(axis, self.axis, atol=1e-6):
            raise ValueError(f"line {self.line}: an arc without start, or with a turning axis")
        turn = self.frame[:3, :3]
        centre = turn @ (self.scale * np.array(self.circle[:3])) + self.frame[:3, 3]
        about = turn @ np.array(self.circle[3:6]) * self.way
        about /= np.linalg.norm(about)
        for point in chords(self.at, end, centre, about):
            self.to(point, axis, rapid=False)

    def drill(self, point: ARRAY, axis: ARRAY) -> None:
        words = self.cycle or {}
        depth = abs(words.get("FEDTO", words.get("DEPTH", np.nan))) * self.scale
        clear = max(words.get(word, -np.inf) for word in ("RAPTO", "CLEAR")) * self.scale
        out = words.get("RTRCTO", words.get("RETURN", -np.inf)) * self.scale
        if np.isnan(out):
            # The level from which the tool came to the first hole of the cycle.
            if self.level is None:
                self.level = float((self.at - point) @ axis) if self.at is not None else clear
            out = self.level
        out = max(out, clear)
        unit = next(word for word in words if word in ("MMPM", "IPM", "MMPR", "IPR", "PERMIN"))
        feed = self.rate((words[unit], unit))
        if self.at is not None and np.allclose(axis, self.axis, atol=1e-6):
            height = float((self.at - point) @ axis)
            if height > clear:
                self.to(point + height * axis, axis, rapid=True)
        self.to(point + clear * axis, axis, rapid=True)
        self.to(point - depth * axis, axis, rapid=False, feed=feed, hole=True)
        self.out.moves[-1].clear = clear
        self.to(point + out * axis, axis, rapid=True)


def chords(start: ARRAY, end: ARRAY, centre: ARRAY, about: ARRAY, turns: int = 0) -> list[ARRAY]:
    """Return points of an arc or helix, counter-clockwise about a vector; full if the ends meet."""
    arm, last = start - centre, end - centre
    rise = float((last - arm) @ about)
    flat = last - rise * about
    base = arm - (arm @ about) * about
    goal = flat - (flat @ about) * about
    sweep = float(np.arctan2(np.cross(base, goal) @ about, base @ goal)) % (2 * np.pi)
    if sweep < 1e-6 or 2 * np.pi - sweep < 1e-9:
        sweep = 2 * np.pi
    sweep += 2 * np.pi * turns
    radius = float(np.linalg.norm(base))
    step = 2 * np.arccos(max(1 - CHORD / max(radius, CHORD), 0.5))
    count = int(np.ceil(sweep / step))
    share = np.arange(1, count + 1) / count
    # A radius that rounding has made unequal at the ends changes along the arc.
    grow = 1 + (np.linalg.norm(goal) / radius - 1) * share
    points = rotate(np.tile(base, (count, 1)), about, sweep * share) * grow[:, None]
    points += centre + np.outer(float(arm @ about) + rise * share, about)
    points[-1] = end
    return list(points)


def records(text: str) -> list[tuple[int, str]]:
    """Return records with the line each begins in, joined where `$` ends a line."""
    found: list[tuple[int, str]] = []
    joined = ""
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.split("$$")[0].strip()
        more = line.endswith("$")
        joined += line.rstrip("$").strip()
        if joined and not more:
            found.append((number, joined))
        if not more:
            joined = ""
    return found


def read(text: str) -> Source:
    """Read a file of cutter-location data."""
    return Reader(text).out
