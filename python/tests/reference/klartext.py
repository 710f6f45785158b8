"""HEIDENHAIN TNC 640, Klartext: M128, PLANE SPATIAL, cycles 200 to 207.

Sources: HEIDENHAIN, *TNC 640 User's Manual for Klartext* (PLANE SPATIAL: turns about the fixed axes
X, Y, Z in that order; without SEQ the shorter way among the solutions within the travels; M128: the
tip stays, M91 only after M129; coordinates turn with the table); *Cycle Programming* (200, 201,
202, 205, 207).
"""

from __future__ import annotations

import re

import numpy as np

from .control import Control, depths
from .machine import X, Y, Z, matrix

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
WORD = re.compile(rf"(IPA|IZ|[XYZABC])({NUMBER})(?=\s|$)")
Q = re.compile(rf"(Q\d+)=({NUMBER})")


class Klartext(Control):
    """Runs a program; the tool length is known from each TOOL CALL on."""

    def run(self, text: str) -> None:
        self.length_on = True
        self.cycle: tuple[int, dict[str, float]] | None = None
        self.shift = np.zeros(3)
        self.pole = np.zeros(3)
        text = re.sub(r"~\n", "~ ", re.sub(r"(;[^~\n]*)~\n", "~ ", text))
        for count, line in enumerate(text.splitlines()):
            found = re.fullmatch(r"(\d+)\s+(.*?)(?:;.*)?", line)
            if found is None or int(found[1]) != count:
                raise self.fault(f"blocks are not counted: {line}")
            self.line = count
            if self.ended and not found[2].startswith("END PGM"):
                raise self.fault("a block behind the end")
            if found[2].strip():
                self.block(found[2].strip())
        if not self.ended:
            raise self.fault("the program has no end")

    def block(self, text: str) -> None:
        head, _, rest = text.partition(" ")
        if re.fullmatch(r"M\d+", text):
            self.function(int(text[1:]))
        elif head == "L":
            self.straight(rest)
        elif head == "CC":
            place = {letter: float(value) for letter, value in WORD.findall(rest)}
            self.pole = np.array([place["X"], place["Y"], 0.0])
        elif head in ("C", "CP"):
            self.circle(head, rest)
        elif head == "TOOL":
            self.tool_call(rest)
        elif head == "PLANE":
            self.tilt(rest)
        elif head == "CYCL":
            self.define(rest)
        elif text == "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS":
            self.function(128)
        elif text == "FUNCTION RESET TCPM":
            self.function(129)
        elif head not in ("BEGIN", "END", "BLK"):
            raise self.fault(f"not known: {text}")

    def straight(self, text: str) -> None:
        words = {letter: float(value) for letter, value in WORD.findall(text)}
        rapid = machine = call = False
        for part in WORD.sub("", text).split():
            if part == "FMAX":
                rapid = True
            elif part == "M91":
                machine = True
            elif part == "M99":
                call = True
            elif part == "M126":
                pass
            elif part in ("R0", "RL", "RR"):
                self.side = {"R0": "", "RL": "left", "RR": "right"}[part]
            elif re.fullmatch(rf"F{NUMBER}", part):
                self.rate = float(part[1:])
            else:
                raise self.fault(f"not known: {part}")
        if self.shift.any() and self.plane is None and not machine:
            raise self.fault("a motion with a shifted datum and no plane")
        if machine:
            if self.centre or not rapid:
                raise self.fault("M91 under M128, or by feed")
            self.machine_to(words)
        elif call:
            self.drill(words)
        else:
            self.line_to(words, rapid)

    def circle(self, head: str, text: str) -> None:
        words = {letter: float(value) for letter, value in WORD.findall(text)}
        clockwise = None
        for part in WORD.sub("", text).split():
            if part in ("DR+", "DR-"):
                clockwise = part == "DR-"
            elif re.fullmatch(rf"F{NUMBER}", part):
                self.rate = float(part[1:])
            else:
                raise self.fault(f"not known: {part}")
        if clockwise is None:
            raise self.fault("an arc without DR")
        centre = np.array([*self.pole[:2], self.at[2]])
        if head == "C":
            end = np.array([words.get("X", self.at[0]), words.get("Y", self.at[1]), self.at[2]])
            self.arc(end, centre, Z, clockwise)
            return
        sweep = words["IPA"]
        if (sweep < 0) != clockwise:
            raise self.fault("IPA turns the other way than DR")
        end = centre + matrix(Z, sweep) @ (self.at - centre) + words.get("IZ", 0.0) * Z
        turns = int(np.ceil(abs(sweep) / 360 - 1e-9)) - 1
        self.arc(end, centre, Z, clockwise, turns)

    def tool_call(self, text: str) -> None:
        if text.startswith("DEF"):
            return
        found = re.fullmatch(r"CALL(?: (\d+) Z)?(?: S(\d+))?", text)
        if found is None:
            raise self.fault(f"not known: TOOL {text}")
        if found[1]:
            if self.centre:
                raise self.fault("TOOL CALL under M128")
            self.change(int(found[1]))
        if found[2]:
            self.speed = float(found[2])

    def tilt(self, text: str) -> None:
        now = self.turns
        # STAY: the plane ends, and no axis moves.
        if text == "RESET STAY":
            self.plane = None
            self.enter()
            return
        if text == "RESET TURN FMAX":
            self.plane = None
            self.enter()
            self.line_to({axis.letter: 0.0 for axis in self.machine.rotary}, rapid=True)
            return
        found = re.fullmatch(
            rf"SPATIAL SPA({NUMBER}) SPB({NUMBER}) SPC({NUMBER}) TURN FMAX(?: SEQ([-+]))?", text
        )
        if found is None:
            raise self.fault(f"not known: PLANE {text}")
        a, b, c = (float(found[k]) for k in (1, 2, 3))
        turn = matrix(Z, c) @ matrix(Y, b) @ matrix(X, a)
        self.plane = (turn, self.shift)
        self.enter()
        # SEQ names the side of the master axis: the first from the bed where tables turn the part.
        side = {"+": 1, "-": -1, None: 0}[found[4]]
        self.swivel(
            turn[:, 2],
            lambda turns: (side * turns[0] < 0, float(abs(turns - now).sum())),
        )

    def define(self, text: str) -> None:
        found = re.match(r"DEF (\d+)(?:\.(\d))?\s*(.*)", text)
        if found is None:
            raise self.fault(f"not known: CYCL {text}")
        number, part, rest = int(found[1]), found[2], found[3]
        if number == 7:
            if part != "0":
                letter, value = rest[0], float(rest[1:])
                self.shift = self.shift.copy()
                self.shift["XYZ".index(letter)] = value
                if self.plane is not None:
                    raise self.fault("the datum is shifted in a tilted plane")
        elif number in (200, 201, 202, 205, 207):
            self.cycle = (number, {name: float(value) for name, value in Q.findall(rest)})
        elif number not in (9, 32):
            raise self.fault(f"cycle {number} is not known")

    def drill(self, words: dict[str, float]) -> None:
        if self.cycle is None:
            raise self.fault("M99 without a cycle")
        number, q = self.cycle
        surface, safety = q["Q203"], q["Q200"]
        bottom = surface + q["Q201"]
        clear = surface + safety
        pecks, back, out = [], 1.0, None
        rate = self.rate
        self.rate = q.get("Q206", rate)
        if number == 200:
            pecks, back = depths(surface, bottom, q["Q202"]), safety
        elif number == 205:
            step = q["Q257"] or q["Q202"]
            pecks, back = depths(surface, bottom, step), -q["Q256"] if q["Q257"] else q["Q258"]
        elif number == 201:
            out = q["Q208"] or q["Q206"]
        elif number == 207:
            self.rate = abs(q["Q239"]) * self.speed
            out = self.rate
        self.hole(words, (clear, bottom, max(surface + q["Q204"], clear)), pecks, back, out)
        self.rate = rate

    def function(self, function: int) -> None:
        if function in (3, 4, 5):
            self.direction = {3: 1, 4: -1, 5: 0}[function]
        elif function in (7, 8, 9):
            self.coolant = function != 9
        elif function in (128, 129):
            self.centre = function == 128
            self.enter()
        elif function in (2, 30):
            self.ended = True
        elif function not in (0, 1, 126):
            raise self.fault(f"M{function} is not known")
