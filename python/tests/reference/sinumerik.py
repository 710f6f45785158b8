"""SINUMERIK 840D: programs with positions of axes, with TRAORI, and with CYCLE800.

Sources: Siemens, *NC programming*, 12/2019 (FGROUP, FGREF: 57.296 mm where it is not set; TRAORI,
A3 B3 C3; G group 15); *Programming Guide Cycles*, 11.02 (CYCLE81 to 86); parameters of CYCLE800.
"""

from __future__ import annotations

import re
from typing import Callable

import numpy as np

from .control import Control, Feed, depths
from .machine import ARRAY, X, Y, Z, matrix

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
TOKEN = re.compile(
    rf"""(?P<call>(?:MCALL\s+)?CYCLE\d+\([^)]*\)|FGROUP\([^)]*\)|WORKPIECE\([^)]*\)|MSG\("[^"]*"\))
    |(?P<name>TRAORI|TRAFOOF|ORIWKS|ORIVECT|FFWON|FFWOF|SOFT|BRISK|SUPA|CIP|MCALL)
    |(?P<address>[ABC]3|[IJK]1|TURN|FGREF\[[ABC]\]|[ABCT])=(?P<value>"[^"]*"|DC\({NUMBER}\)|{NUMBER})
        (?P<operator>\+R\d+)?
    |(?P<letter>[NGMTDSFXYZABCIJK])(?P<number>{NUMBER})""",
    re.VERBOSE,
)
#: Codes that set what this reference takes for granted, or that change nothing it compares.
ASSUMED = {17, 40, 54, 60, 64, 71, 90, 601, 602, 710}
POSITIONS = {"X", "Y", "Z", "A", "B", "C", "A3", "B3", "C3"}
#: Degrees about the pole within which a vector that passes it is led through it: MD24530, as
#: delivered. Nearer than the second, the way of the source itself goes through it.
POLE, THROUGH = 2.0, 0.001


class Sinumerik(Control):
    """Runs a main program or a subprogram."""

    def run(self, text: str) -> None:
        self.motion = 0
        self.group: tuple[str, ...] = ()
        self.reference = dict.fromkeys("ABC", 180 / np.pi)
        self.modal: Callable[[dict[str, float]], None] | None = None
        self.names: dict[str, int] = {}
        for number, line in enumerate(text.splitlines(), 1):
            self.line = number
            if self.ended and line.strip():
                raise self.fault("a block behind the end")
            self.block(re.sub(r'"[^"]*"|;.*', lambda m: "" if m[0][0] == ";" else m[0], line))
        if not self.ended:
            raise self.fault("the program has no end")

    def block(self, line: str) -> None:
        words: dict[str, float] = {}
        codes: list[int] = []
        functions: list[int] = []
        names: list[str] = []
        at = 0
        for token in TOKEN.finditer(line):
            if line[at : token.start()].strip():
                raise self.fault(f"not known: {line[at : token.start()]!r}")
            at = token.end()
            if token["call"]:
                self.call(token["call"])
            elif token["name"]:
                names.append(token["name"])
            elif token["address"]:
                self.assign(token["address"], token["value"], words)
            elif token["letter"] in "GM":
                (codes if token["letter"] == "G" else functions).append(int(token["number"]))
            elif token["letter"] == "T":
                self.pending = int(token["number"])
            else:
                if token["letter"] in words:
                    raise self.fault(f"{token['letter']} stands twice")
                words[token["letter"]] = float(token["number"])
        if line[at:].strip():
            raise self.fault(f"not known: {line[at:]!r}")
        words.pop("N", None)
        self.execute(words, codes, functions, names)

    def assign(self, address: str, value: str, words: dict[str, float]) -> None:
        if address == "T":
            # The tool of a name is the next new one; the judge compares it by what it cuts.
            self.pending = self.names.setdefault(value, -1 - len(self.names))
        elif address.startswith("FGREF"):
            self.reference[address[6]] = float(value)
        elif value.startswith("DC"):
            words[address] = float(value[3:-1])
        else:
            words[address] = float(value)

    def call(self, text: str) -> None:
        name, _, inside = text.partition("(")
        values = [part.strip() for part in inside[:-1].split(",")]
        name = " ".join(name.split())
        if name == "FGROUP":
            self.group = tuple(values)
        elif name == "CYCLE800":
            self.cycle800(values)
        elif name.startswith("MCALL CYCLE"):
            cycle, at = name[-2:], [float(value) if value else np.nan for value in values]
            self.modal = lambda place: self.drill(cycle, at, place)
        elif name not in ("MSG", "CYCLE832", "WORKPIECE"):
            raise self.fault(f"not known: {text}")

    def cycle800(self, values: list[str]) -> None:
        if values in ([], [""]):
            self.plane = None
            self.enter()
            return
        if values[:4] != ["0", '""', "0", "57"] or values[13:] not in (
            ["-1", "0"],
            ["-1", "0", "0"],
        ):
            raise self.fault('CYCLE800 with other parameters than 0,"",0,57 and -1,0')
        n = np.array([float(value) for value in values[4:13]])
        turn = matrix(X, n[3]) @ matrix(Y, n[4]) @ matrix(Z, n[5])
        self.plane = (turn, n[:3] + turn @ n[6:9])
        self.enter()
        # Direction -1: the smaller position of the first rotary axis.
        self.swivel(turn[:, 2], lambda turns: float(turns[0]))

    def drill(self, cycle: str, v: list[float], place: dict[str, float]) -> None:
        plane, surface, safety, depth = v[:4]
        if np.isnan(depth):
            depth = surface - v[4]
        levels = (surface + safety, depth, plane)
        pecks, back, out = [], 1.0, None
        rate = self.rate, self.mode
        if cycle == "83":
            if v[7] != 0 or not np.isnan(v[5]):
                raise self.fault("CYCLE83 with degression or an absolute first depth")
            pecks, back = depths(surface, depth, v[6]), 0.6 if v[11] == 1 else -1.0
        elif cycle == "84":
            self.rate, self.mode = abs(v[8]) * v[10], "minute"
            out = self.rate
        elif cycle == "85":
            self.rate, out = v[6], v[7]
        elif cycle not in ("81", "82", "86"):
            raise self.fault(f"CYCLE{cycle} is not known")
        self.hole(place, levels, pecks, back, out)
        self.rate, self.mode = rate

    def degrees(self) -> tuple[float, ...]:
        if not self.group:
            raise self.fault("rotary axes turn in the cut, and FGROUP is not said")
        ways = []
        for axis in self.machine.rotary:
            radius = self.reference[axis.letter] if axis.letter in self.group else 0.0
            ways.append(radius * np.pi / 180)
        return tuple(ways)

    def execute(
        self, words: dict[str, float], codes: list[int], functions: list[int], names: list[str]
    ) -> None:
        if "S" in words:
            self.speed = words.pop("S")
        if 4 in codes:
            return
        if "F" in words:
            self.rate = words.pop("F")
        for code in codes:
            self.code(code)
        if "D" in words:
            self.length_on = words.pop("D") != 0
            self.enter()
        for function in functions:
            self.function(function)
        for name in names:
            self.name(name)
        if 75 in codes:
            # A fixed point: its place is the machine's; Z goes there, whatever its value is.
            if set(words) != {"Z"}:
                raise self.fault("G75 with other axes than Z")
            self.home()
            return
        if "SUPA" in names:
            if self.motion != 0 or self.centre:
                raise self.fault("SUPA by feed, or under TRAORI")
            self.machine_to(words)
            return
        if words:
            self.go(words, names)

    def code(self, code: int) -> None:
        if code in (0, 1, 2, 3):
            self.motion = code
        elif code in (93, 94, 95):
            mode = {93: "block", 94: "minute", 95: "turn"}[code]
            if mode != self.mode:
                self.mode = mode
        elif code in (41, 42, 40):
            self.side = {41: "left", 42: "right", 40: ""}[code]
        elif code not in ASSUMED and code != 75:
            raise self.fault(f"G{code} is not known")

    def function(self, function: int) -> None:
        if function in (3, 4, 5):
            self.direction = {3: 1, 4: -1, 5: 0}[function]
        elif function in (7, 8, 9):
            self.coolant = function != 9
        elif function == 6:
            self.change(self.pending)
        elif function in (2, 17, 30):
            self.ended = True
        elif function not in (0, 1, 26, 27, 28, 29):
            raise self.fault(f"M{function} is not known")

    def name(self, name: str) -> None:
        if name == "TRAORI":
            self.centre = True
            self.enter()
        elif name == "TRAFOOF":
            self.centre = False
            self.enter()
        elif name == "MCALL":
            self.modal = None

    def go(self, words: dict[str, float], names: list[str]) -> None:
        along: ARRAY | None = None
        if "A3" in words:
            if not self.centre:
                raise self.fault("A3 B3 C3 without TRAORI")
            along = np.array([words.pop("A3"), words.pop("B3"), words.pop("C3")])
            along /= np.linalg.norm(along)
        if self.modal is not None and set(words) & POSITIONS:
            self.modal(words)
        elif "CIP" in names:
            self.through(words)
        elif self.motion in (2, 3):
            end = np.array([words.get(letter, at) for letter, at in zip("XYZ", self.at)])
            arm = np.array([words.get("I", 0.0), words.get("J", 0.0), 0.0])
            if "K" in words or not set(words) <= {*"XYZIJ", "TURN"}:
                raise self.fault("an arc out of the plane XY")
            self.arc(end, self.at + arm, Z, self.motion == 2, int(words.get("TURN", 0)))
        else:
            self.line_to(words, self.motion == 0, along)

    def swing(self, end: ARRAY, along: ARRAY, feed: Feed) -> None:
        """Refuse a way past the pole, where C ends elsewhere than the great circle has it."""
        before = self.machine.forward(np.zeros((1, 3)), self.turns[None], np.zeros(1))[1][0]
        near = pole_passed(before, along)
        if near is not None and THROUGH < near < POLE:
            raise self.fault(f"a vector goes past the pole at {near:.3f} degrees")
        super().swing(end, along, feed)

    def through(self, words: dict[str, float]) -> None:
        """Go along CIP: a circle through a point to the end; I1 J1 K1 are absolute under G90."""
        start = self.at
        via, end = (
            np.array([words.get(name, at) for name, at in zip(names, start)])
            for names in (("I1", "J1", "K1"), ("X", "Y", "Z"))
        )
        normal = np.cross(via - start, end - via)
        normal /= np.linalg.norm(normal)
        rows = np.array([2 * (via - start), 2 * (end - start), normal])
        right = [via @ via - start @ start, end @ end - start @ start, normal @ start]
        self.arc(end, np.linalg.solve(rows, np.array(right)), normal, clockwise=False)


def pole_passed(one: ARRAY, two: ARRAY) -> float | None:
    """Degrees from the pole, where C turns about Z, at which the tool passes it between two axes.

    Nothing where an end is within its limit, or where an end is the nearest place of the way.
    """
    across = np.cross(one, two)
    size = float(np.linalg.norm(across))
    ends = np.degrees(np.arcsin(np.linalg.norm([one[:2], two[:2]], axis=1).clip(0, 1)))
    if size < 1e-9 or ends.min() <= POLE:
        return None
    normal = across / size
    foot = Z - (Z @ normal) * normal
    sides = np.cross(one, foot) @ normal, np.cross(foot, two) @ normal
    # Both of one sign: the foot of Z on the way lies between the ends, or that of -Z.
    if sides[0] * sides[1] <= 0:
        return None
    return float(np.degrees(np.arcsin(min(abs(Z @ normal), 1.0))))
