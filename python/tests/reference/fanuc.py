"""FANUC 30i family: tool-centre control (G43.4) and tilted planes (G68.2, G53.1).

Sources: FANUC, *Tool center point control for 5-axis machining*, A-79348E (coordinates fixed to the
table, F is the speed of the tip against the part); *Operator's Manual* B-64304 and B-64484 (G68.2:
turns about Z, the new X, the new Z; G53.1 turns the rotary axes only; G98; G83, G73; G93).
"""

from __future__ import annotations

import re

import numpy as np

from .control import Control, depths
from .machine import X, Y, Z, matrix

TOKEN = re.compile(r"([A-Z])([-+]?(?:\d+\.?\d*|\.\d+))")
ASSUMED = {17.0, 18.0, 19.0, 21.0, 40.0, 54.0, 64.0, 90.0, 91.0, 98.0}
CYCLES = {73.0, 74.0, 81.0, 82.0, 83.0, 84.0, 85.0, 86.0, 89.0}


class Fanuc(Control):
    """Runs a program."""

    #: X10 without a point counts in steps, or in mm: the parameter is not known.
    points = True

    def run(self, text: str) -> None:
        self.motion, self.cycle = 0, 0.0
        self.plane_of_arcs = Z
        self.held: dict[str, float] = {}
        self.relative = False
        self.initial = 0.0
        self.turned_up = True
        for number, line in enumerate(text.splitlines(), 1):
            self.line = number
            words = re.sub(r"\([^)]*\)", "", line).strip()
            if words in ("", "%") or re.fullmatch(r"O\d+", words):
                continue
            if self.ended:
                raise self.fault("a block behind the end")
            self.block(words)
        if not self.ended:
            raise self.fault("the program has no end")

    def block(self, line: str) -> None:
        if TOKEN.sub("", line).strip():
            raise self.fault(f"not known: {line!r}")
        words: dict[str, float] = {}
        codes: list[float] = []
        functions: list[int] = []
        for letter, value in TOKEN.findall(line):
            if letter == "G":
                codes.append(float(value))
            elif letter == "M":
                functions.append(int(value))
            elif letter in words:
                raise self.fault(f"{letter} stands twice")
            else:
                whole = self.points and "." not in value and float(value) != 0
                if letter in "XYZABCIJKR" and whole:
                    raise self.fault(f"{letter}{value} has no point")
                words[letter] = float(value)
        words.pop("N", None)
        self.execute(words, codes, functions)

    def execute(self, words: dict[str, float], codes: list[float], functions: list[int]) -> None:
        if 4 in codes:
            # A dwell has no words but its time; its unit may be set in front of it.
            for code in set(codes) - {4.0}:
                self.code(code, {})
            return
        if 29 in functions:
            functions.remove(29)
            self.speed = words.pop("S")
        for code in codes:
            self.code(code, words)
        self.speed = words.pop("S", self.speed)
        self.rate = words.pop("F", self.rate)
        if "T" in words:
            self.pending = int(words.pop("T"))
        for function in functions:
            self.function(function)
        if 28 in codes:
            if not self.relative or words != {"Z": 0.0}:
                raise self.fault("G28 with more than G91 Z0")
            self.home()
        elif 53.1 in codes:
            if self.plane is None:
                raise self.fault("G53.1 without G68.2")
            # Parameters 19696 and 5402 choose: the nearer solution is taken here.
            now = self.turns
            self.turned_up = True
            self.swivel(self.plane[0][:, 2], lambda turns: float(abs(turns - now).sum()))
        elif words and 68.2 not in codes:
            self.go(words)

    def code(self, code: float, words: dict[str, float]) -> None:
        if code in (0, 1, 2, 3):
            self.motion, self.cycle = int(code), 0.0
        elif code in (93, 94, 95):
            self.mode = {93: "block", 94: "minute", 95: "turn"}[int(code)]
        elif code in (90, 91):
            self.relative = code == 91
        elif code in (40, 41, 42):
            self.side = {41: "left", 42: "right", 40: ""}[int(code)]
        elif code in (17, 18, 19):
            self.plane_of_arcs = {17: Z, 18: Y, 19: X}[int(code)]
        elif code in (43, 43.4):
            if words.pop("H", 0) != self.tool:
                raise self.fault("H is not that of the tool")
            self.length_on, self.centre = True, code == 43.4
            self.enter()
        elif code == 49:
            self.length_on = self.centre = False
            self.enter()
        elif code == 69:
            self.plane = None
            self.enter()
        elif code == 68.2:
            turn = matrix(Z, words["I"]) @ matrix(X, words["J"]) @ matrix(Z, words["K"])
            self.plane = (turn, np.array([words["X"], words["Y"], words["Z"]]))
            self.turned_up = False
            self.enter()
        elif code in CYCLES:
            self.cycle, self.held, self.initial = code, {}, float(self.at[2])
        elif code == 80:
            self.cycle = 0.0
        elif code not in ASSUMED | {28, 53.1}:
            raise self.fault(f"G{code} is not known")

    def function(self, function: int) -> None:
        if function in (3, 4, 5):
            self.direction = {3: 1, 4: -1, 5: 0}[function]
        elif function in (7, 8, 9):
            self.coolant = function != 9
        elif function == 6:
            self.change(self.pending)
        elif function in (2, 30):
            self.ended = True
        elif function not in (0, 1):
            raise self.fault(f"M{function} is not known")

    def degrees(self) -> tuple[float, ...]:
        # G94: F is the length of the way in mm and degrees alike (B-64484, feed functions).
        return tuple(1.0 for _ in self.machine.rotary)

    def go(self, words: dict[str, float]) -> None:
        if self.relative:
            raise self.fault("a relative motion")
        if self.plane is not None and not self.turned_up:
            raise self.fault("a motion between G68.2 and G53.1")
        words.pop("D", None)
        if self.cycle:
            self.drill(words)
        elif self.motion in (2, 3):
            end = np.array([words.get(letter, at) for letter, at in zip("XYZ", self.at)])
            arm = np.array([words.get(letter, 0.0) for letter in "IJK"])
            if not set(words) <= set("XYZIJK"):
                raise self.fault("an arc with other words than X Y Z I J K")
            self.arc(end, self.at + arm, self.plane_of_arcs, self.motion == 2)
        elif set(words) <= set("XYZABC"):
            if not (self.length_on or self.motion == 0):
                raise self.fault("a cut without tool length")
            self.line_to(words, self.motion == 0)
        else:
            raise self.fault(f"not known: {sorted(words)}")

    def drill(self, words: dict[str, float]) -> None:
        self.held.update(words)
        bottom, clear = self.held["Z"], self.held["R"]
        place = {letter: self.held[letter] for letter in "XY" if letter in self.held}
        pecks, back, out = [], 1.0, None
        rate = self.rate
        if self.cycle in (73, 83):
            pecks = depths(clear, bottom, self.held["Q"])
            back = 0.5 if self.cycle == 83 else -0.5
        elif self.cycle in (74, 84, 85, 89):
            out = rate
        # G98: back to the height at which the cycle was called.
        levels = (clear, bottom, max(self.initial, clear))
        self.hole(place, levels, pecks, back, out)
