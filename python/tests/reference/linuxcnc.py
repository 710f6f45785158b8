"""LinuxCNC with kinematics that M428 and M429 switch (the tip in the part, or the axes).

Sources: LinuxCNC 2.9, *G-codes* and *5-Axis Kinematics*: G94 counts X, Y and Z alone where one of
them moves, else degrees; G53 takes axes, whatever length is active; G0 goes straight; G98.
"""

from __future__ import annotations

from .fanuc import Fanuc


class LinuxCNC(Fanuc):
    """Runs a program. Whether the kinematics follow the tip is not known until it says so."""

    points = False
    stated = False

    def execute(self, words: dict[str, float], codes: list[float], functions: list[int]) -> None:
        for code in (64, 61):
            if code in codes:
                codes.remove(code)
                words = {letter: v for letter, v in words.items() if letter not in "PQ"}
        # I, J and K from the start of the arc, as they are read here; G90.1 is not known.
        if 91.1 in codes:
            codes.remove(91.1)
        for function in (428, 429):
            if function in functions:
                functions.remove(function)
                self.stated, self.centre = True, function == 428
                self.enter()
        if {43, 49} & set(codes) and self.centre:
            raise self.fault("the tool length changes while the kinematics follow the tip")
        if 53 in codes:
            codes.remove(53)
            if self.centre or codes != [0] or set(words) - set("XYZ"):
                raise self.fault("G53 under M428, or not by rapid of X, Y, Z")
            self.code(0, words)
            self.machine_to(words)
            return
        if 33.1 in codes:
            self.tap(words)
            return
        moves = set(words) & set("XYZABC")
        if moves and not self.stated:
            raise self.fault("a motion before M428 or M429")
        self.linear = bool(set(words) & set("XYZ"))
        super().execute(words, codes, functions)

    def tap(self, words: dict[str, float]) -> None:
        """G33.1: down by a pitch a turn, and back with the spindle reversed to where it began."""
        rate, top = self.rate, float(self.at[2])
        self.rate = words["K"] * self.speed
        self.line_to({"Z": words["Z"]}, rapid=False)
        self.line_to({"Z": top}, rapid=False)
        self.rate = rate

    def degrees(self) -> tuple[float, ...]:
        # Rotary axes follow X, Y and Z in their time; alone they go by degrees a minute.
        weight = 0.0 if self.linear else 1.0
        return tuple(weight for _ in self.machine.rotary)
