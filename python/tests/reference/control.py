"""What a control does, whatever its dialect: axes, the frame of the words, and rows of motion.

A row is a piece of motion along which everything that is interpolated changes evenly.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .cldata import chords
from .machine import ARRAY, Machine, Z, slerp

ONE = np.eye(3)


@dataclass(frozen=True)
class Frame:
    """What coordinates mean."""

    #: The control follows the part: coordinates are a place in it. Otherwise they are axes.
    follows: bool
    #: Columns: axes of the coordinates in the part.
    turn: ARRAY
    #: Of a frame that follows the part its zero there, otherwise what is added to coordinates.
    origin: ARRAY
    #: Tool length that the control knows of in this frame.
    length: float
    #: Tool length as it is.
    real: float


class Feed(NamedTuple):
    """How fast a row goes: `rate` a minute along the way that `mode` means."""

    #: `rapid`, `minute` (mm of way), `block` (whole blocks), as SINUMERIK, FANUC mean it.
    mode: str
    rate: float = np.nan
    #: The part of the block that this row is.
    share: float = 1.0
    #: Millimetres of way for a degree of each rotary axis, or nothing where the tip is meant.
    degrees: tuple[float, ...] | None = None


class Row(NamedTuple):
    """A piece of motion."""

    line: int
    frame: int
    start: ARRAY
    end: ARRAY
    turns: tuple[ARRAY, ARRAY]
    #: Tool axes at both ends, where the control interpolates the axis and not the angles.
    axes: tuple[ARRAY, ARRAY] | None
    feed: Feed
    state: tuple[int, float, bool, str]


class FaultError(Exception):
    """The program does what the reference holds for wrong, or does not know."""


class Control(ABC):
    """State of a control that runs a program."""

    def __init__(
        self,
        machine: Machine,
        lengths: dict[int, float],
        start: tuple[float, float],
        turns: tuple[float, ...] = (),
        modulo: bool = False,
    ) -> None:
        self.machine, self.lengths, self.modulo = machine, lengths, modulo
        self.frames: list[Frame] = []
        self.rows: list[Row] = []
        self.turns = np.array(turns or [0.0] * len(machine.rotary))
        # A program begins somewhere: that Z is home, it has to see to itself.
        self.at = np.array([*start, machine.home - 50])
        self.line = 0
        self.tool, self.length_on = 0, False
        self.speed, self.direction, self.coolant, self.side = 0.0, 0, False, ""
        self.rate, self.mode = np.nan, "minute"
        self.ended = False
        #: Turn and origin of a tilted plane, and tool-centre control.
        self.plane: tuple[ARRAY, ARRAY] | None = None
        self.centre = False
        self.frames.append(Frame(False, ONE, np.zeros(3), 0.0, 0.0))

    @abstractmethod
    def run(self, text: str) -> None:
        """Run a program to its end."""

    def fault(self, why: str) -> FaultError:
        return FaultError(f"block {self.line}: {why}")

    @property
    def real(self) -> float:
        """Length of the tool in the spindle."""
        return self.lengths.get(self.tool, self.lengths.get(0, 0.0))

    def axes(self) -> ARRAY:
        """Positions of the linear axes, of which the machine has a scale each."""
        frame = self.frames[-1]
        if not frame.follows:
            return self.at + frame.origin
        tip = frame.origin + frame.turn @ self.at
        length = np.array([frame.length])
        return np.asarray(self.machine.inverse(tip[None], self.turns[None], length)[0])

    def enter(self, frame: Frame | None = None) -> None:
        """Mean coordinates otherwise from here on; nothing moves."""
        axes = self.axes()
        if frame is None:
            length = self.real if self.length_on else 0.0
            if self.plane is not None:
                frame = Frame(True, *self.plane, length, self.real)
            elif self.centre:
                frame = Frame(True, ONE, np.zeros(3), length, self.real)
            else:
                frame = Frame(False, ONE, self.machine.zero + length * Z, length, self.real)
        self.frames.append(frame)
        if not frame.follows:
            self.at = axes - frame.origin
            return
        tip, _ = self.machine.forward(axes[None], self.turns[None], np.array([frame.length]))
        self.at = frame.turn.T @ (tip[0] - frame.origin)

    def state(self) -> tuple[int, float, bool, str]:
        return (self.tool, self.speed * self.direction, self.coolant, self.side)

    def row(self, end: ARRAY, turns: ARRAY, feed: Feed, axes: Any = None) -> None:
        """Go on to a place, and to positions of the rotary axes."""
        ends = (self.turns, turns)
        frame = len(self.frames) - 1
        self.rows.append(Row(self.line, frame, self.at, end, ends, axes, feed, self.state()))
        self.at, self.turns = end, turns

    def feed(self, rapid: bool) -> Feed:
        if rapid:
            return Feed("rapid")
        if np.isnan(self.rate):
            raise self.fault("a cut without F")
        if self.mode == "turn":
            return Feed("minute", self.rate * self.speed)
        return Feed(self.mode, self.rate)

    def turned(self, words: dict[str, float]) -> ARRAY:
        """Positions of the rotary axes behind a block."""
        turns = self.turns.copy()
        for index, axis in enumerate(self.machine.rotary):
            if axis.letter in words:
                value = words[axis.letter]
                endless = np.isinf(axis.low)
                if endless and (self.modulo if axis.modulo is None else axis.modulo):
                    value = turns[index] + (value - turns[index] + 180) % 360 - 180
                turns[index] = value
        return turns

    def line_to(self, words: dict[str, float], rapid: bool, along: ARRAY | None = None) -> None:
        """Straight motion to what a block says; what it does not say stays."""
        end = np.array([words.get(letter, now) for letter, now in zip("XYZ", self.at)])
        turns = self.turned(words)
        feed = self.feed(rapid)
        if along is not None:
            self.swing(end, along, feed)
            return
        if rapid and not self.machine.straight and not self.frames[-1].follows:
            self.dog_leg(end, turns)
            return
        if not rapid and not self.frames[-1].follows and (turns != self.turns).any():
            feed = feed._replace(degrees=self.degrees())
        self.row(end, turns, feed)

    def swing(self, end: ARRAY, along: ARRAY, feed: Feed) -> None:
        """Straight motion while the tool axis turns on the great circle; the axes follow it."""
        start = self.at
        before = self.machine.forward(np.zeros((1, 3)), self.turns[None], np.zeros(1))[1][0]
        sweep = float(np.degrees(np.arccos(np.clip(before @ along, -1, 1))))
        # Close to the pole the axes turn much in a small step: smaller steps tell which way.
        for finest in (2.0, 0.1, 0.005):
            count = max(int(np.ceil(sweep / finest)), 1)
            share = np.arange(1, count + 1) / count
            axes = slerp(np.tile(before, (count, 1)), np.tile(along, (count, 1)), share)
            places = self.track(self.machine.orient(axes))
            if abs(np.diff(places, axis=0)).max() < 15:
                break
        for part, axis, turns in zip(share, axes, places[1:]):
            self.row(start + (end - start) * part, turns, feed, (before, axis))
            before = axis

    def track(self, both: ARRAY) -> ARRAY:
        """Rotary positions that go on from where the axes are, out of both answers to each pose."""
        places = [self.turns]
        for pair in both.transpose(1, 0, 2):
            now = places[-1]
            # What the pole leaves free stays.
            near = np.where(np.isnan(pair), now, pair)
            near += 360 * np.round((now - near) / 360)
            places.append(near[abs(near - now).sum(1).argmin()])
        return np.array(places)

    def degrees(self) -> tuple[float, ...]:
        """Millimetres of way that a degree of each rotary axis counts; a dialect says it."""
        raise self.fault("a feed with rotary axes without tool-centre control")

    def dog_leg(self, end: ARRAY, turns: ARRAY) -> None:
        """Rapid in which each axis goes at its own speed."""
        speeds = [*self.machine.rapid, *(axis.rapid for axis in self.machine.rotary)]
        start = np.array([*self.at, *self.turns])
        goal = np.array([*end, *turns])
        times = abs(goal - start) / speeds
        for time in sorted({float(time) for time in times if time > 0}):
            share = np.minimum(time / np.where(times > 0, times, np.inf), 1)
            place = np.where(time >= times, goal, start + (goal - start) * share)
            self.row(place[:3], place[3:], Feed("rapid"))

    def arc(
        self, end: ARRAY, centre: ARRAY, normal: ARRAY, clockwise: bool, turns: int = 0
    ) -> None:
        """Arc or helix about a normal of the plane."""
        radii = [float(np.linalg.norm(np.cross(p - centre, normal))) for p in (self.at, end)]
        if abs(radii[0] - radii[1]) > 0.01:
            raise self.fault(f"radii of an arc differ: {radii}")
        points = chords(self.at, end, centre, -normal if clockwise else normal, turns)
        feed = self.feed(rapid=False)._replace(share=1 / len(points))
        for point in points:
            self.row(point, self.turns, feed)

    def machine_to(self, words: dict[str, float]) -> None:
        """Rapid in machine coordinates of the gauge line."""
        self.enter(Frame(False, ONE, np.zeros(3), 0.0, self.real))
        self.line_to(words, rapid=True)
        self.enter()

    def change(self, tool: int) -> None:
        """Put a tool into the spindle, which has to stand clear of the part."""
        if self.machine.retracts:
            self.home()
        elif abs(self.axes()[2] - self.machine.home) > 1e-6:
            raise self.fault("the tool is changed, and Z is not home")
        self.tool = tool
        self.enter()

    def home(self) -> None:
        """Z goes to where the machine changes tools, or has its reference."""
        self.machine_to({"Z": self.machine.home})

    def swivel(self, along: ARRAY, choose: Any) -> None:
        """Turn the rotary axes, and nothing else, until the tool is along an axis of the part."""
        answers = self.machine.reach(along, self.turns)
        if not answers:
            raise self.fault(f"no positions of {self.machine.letters} within travels reach {along}")
        turns = min(answers, key=choose)
        axes = self.axes()
        self.frames.append(Frame(False, ONE, np.zeros(3), 0.0, self.real))
        self.at = axes
        self.row(axes, turns, Feed("rapid"))
        self.enter()

    def hole(
        self,
        place: dict[str, float],
        levels: tuple[float, float, float],
        pecks: list[float],
        back: float,
        feed_out: float | None = None,
    ) -> None:
        """Hole of a canned cycle: across, to the first level, by feed to depths, out to the last.

        `levels` are where the feed begins, the bottom, and where the tool goes at the end. After
        each depth but the last the tool goes out, and by rapid back to `back` above that depth; a
        negative `back` breaks the chip in the hole.
        """
        clear, bottom, out = levels
        self.line_to(place, rapid=True)
        self.line_to({"Z": clear}, rapid=True)
        for depth in [*pecks, bottom]:
            self.line_to({"Z": depth}, rapid=False)
            if depth != bottom:
                self.line_to({"Z": clear if back > 0 else depth - back}, rapid=True)
                if back > 0:
                    self.line_to({"Z": min(depth + back, clear)}, rapid=True)
        if feed_out is not None:
            rate, self.rate = self.rate, feed_out
            self.line_to({"Z": clear}, rapid=False)
            self.rate = rate
        self.line_to({"Z": out}, rapid=True)


def depths(start: float, bottom: float, step: float) -> list[float]:
    """Depths of even pecks before the bottom."""
    if step <= 0:
        return []
    count = int(np.ceil((start - bottom) / step - 1e-6))
    return [start - step * k for k in range(1, count)]
