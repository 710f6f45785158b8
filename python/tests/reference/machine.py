"""Kinematics of a machine with two rotary axes, from the facts in its file."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ARRAY = np.ndarray[Any, np.dtype[Any]]
X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class Rotary:
    """A rotary axis: a letter, where it is, the line that it turns about, its way and speed."""

    letter: str
    head: bool
    axis: ARRAY
    point: ARRAY
    sign: float
    low: float
    high: float
    rapid: float
    modulo: bool | None


@dataclass(frozen=True)
class Machine:
    """Linear axes, rotary axes from the bed outwards, and where the work zero stands."""

    low: ARRAY
    high: ARRAY
    rapid: ARRAY
    rotary: tuple[Rotary, ...]
    zero: ARRAY
    home: float
    #: The file states every point and the work zero, so that positions of axes can be judged.
    placed: bool
    #: A tool change takes Z home by itself.
    retracts: bool
    #: Rapids go straight; otherwise each axis goes at its own speed.
    straight: bool

    @property
    def letters(self) -> str:
        """Letters of the rotary axes, as one text."""
        return "".join(axis.letter for axis in self.rotary)

    def tool(self, turns: ARRAY, length: ARRAY) -> tuple[ARRAY, ARRAY]:
        """Tool tip from the gauge line, and tool axis, both in machine coordinates."""
        tip = -np.outer(length, Z)
        along = np.tile(Z, (len(turns), 1))
        for index in reversed(range(len(self.rotary))):
            axis = self.rotary[index]
            if axis.head:
                angle = np.radians(axis.sign * turns[:, index])
                tip = axis.point + rotate(tip - axis.point, axis.axis, angle)
                along = rotate(along, axis.axis, angle)
        return tip, along

    def forward(self, axes: ARRAY, turns: ARRAY, length: ARRAY) -> tuple[ARRAY, ARRAY]:
        """Tip and tool axis in the part, from positions of the axes."""
        tip, along = self.tool(turns, length)
        tip = axes + tip
        for index, axis in enumerate(self.rotary):
            if not axis.head:
                angle = np.radians(-axis.sign * turns[:, index])
                tip = axis.point + rotate(tip - axis.point, axis.axis, angle)
                along = rotate(along, axis.axis, angle)
        return tip - self.zero, along

    def inverse(self, tip: ARRAY, turns: ARRAY, length: ARRAY) -> ARRAY:
        """Positions of the linear axes for tips in the part, the rotary axes being known."""
        place = tip + self.zero
        for index in reversed(range(len(self.rotary))):
            axis = self.rotary[index]
            if not axis.head:
                angle = np.radians(axis.sign * turns[:, index])
                place = axis.point + rotate(place - axis.point, axis.axis, angle)
        return place - self.tool(turns, length)[0]

    def orient(self, along: ARRAY) -> ARRAY:
        """Both pairs of rotary angles that bring the tool along `along`; (2, n, 2), NaN where any.

        Turning p about the second axis and then about the first gives q: the point between
        lies where two cones meet (Paden and Kahan, second subproblem).
        """
        first, second = self.rotary
        up = np.tile(Z, (len(along), 1))
        # A head takes Z to the tool axis of the part; tables take the axis of the part to Z.
        heads = (first.head, second.head)
        if heads == (True, True):
            p, q = up, along
        elif heads == (False, False):
            p, q = along, up
        else:
            raise ValueError("a head with a table is not modelled")
        u, v = first.axis, second.axis
        cos, across = u @ v, np.cross(u, v)
        one = (cos * (p @ v) - q @ u) / (cos * cos - 1)
        two = (cos * (q @ u) - p @ v) / (cos * cos - 1)
        square = (1 - one * one - two * two - 2 * one * two * cos) / (across @ across)
        if (square < -1e-9).any():
            raise ValueError("orientation out of reach")
        found = []
        for way in (-1, 1):
            between = np.outer(one, u) + np.outer(two, v)
            between += way * np.outer(np.sqrt(square.clip(0)), across)
            angles = [angle(u, between, q) / first.sign, angle(v, p, between) / second.sign]
            found.append(np.degrees(np.column_stack(angles)))
        return np.array(found)

    def reach(self, along: ARRAY, now: ARRAY) -> list[ARRAY]:
        """Rotary positions within the travels for one tool axis, each nearest to `now`."""
        answers = []
        for pair in self.orient(along[None])[:, 0]:
            place = [nearest(value, at, axis) for value, at, axis in zip(pair, now, self.rotary)]
            if all(value is not None for value in place):
                answers.append(np.array(place, dtype=float))
        return answers


def nearest(value: float, now: float, axis: Rotary) -> float | None:
    """Position within the travel that shows `value`, a full turn apart, nearest to `now`."""
    if np.isnan(value):
        return now
    turns = [value + 360 * k for k in range(-3, 4)]
    fit = [turn for turn in turns if axis.low - 1e-6 <= turn <= axis.high + 1e-6]
    return min(fit, key=lambda turn: abs(turn - now), default=None)


def rotate(vectors: ARRAY, axis: ARRAY, angle: ARRAY) -> ARRAY:
    """Turn vectors about an axis through the origin by angles in radians."""
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    along = np.outer(vectors @ axis, axis)
    return np.asarray(along + (vectors - along) * cos + np.cross(axis, vectors) * sin)


def angle(axis: ARRAY, start: ARRAY, end: ARRAY) -> ARRAY:
    """Angle about an axis from start to end in radians; NaN where one of them lies on it."""
    sin = np.cross(start, end) @ axis
    cos = (start * end).sum(1) - (start @ axis) * (end @ axis)
    turn = np.arctan2(sin, cos)
    return np.where(np.hypot(sin, cos) < 1e-10, np.nan, turn)


def unit(vectors: ARRAY) -> ARRAY:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def slerp(start: ARRAY, end: ARRAY, share: ARRAY) -> ARRAY:
    """Axes on the great circle between two; rows of unit vectors."""
    cross = np.linalg.norm(np.cross(start, end), axis=1)
    sweep = np.arctan2(cross, (start * end).sum(1))
    sin = np.where(cross > 1e-9, np.sin(sweep), 1.0)
    one = np.where(cross > 1e-9, np.sin((1 - share) * sweep) / sin, 1 - share)
    two = np.where(cross > 1e-9, np.sin(share * sweep) / sin, share)
    return unit(start * one[:, None] + end * two[:, None])


def matrix(axis: ARRAY, degrees: float) -> ARRAY:
    """Matrix that turns by degrees about an axis."""
    return rotate(np.eye(3), axis, np.full(3, np.radians(degrees))).T


def load(text: str, *below: str) -> Machine:
    """Take the facts of a machine file; the files that it builds on follow, the nearest first."""
    file = tomllib.loads(text)
    axes = [file["axes"][letter] for letter in "XYZ"]
    top = float(file.get("safe_height", axes[2]["max"]))
    # What the file does not state is assumed, and no travels are judged: a part well below the top.
    zero = np.array(file.get("work_zero", [0, 0, top - 450]), dtype=float)
    rotary = []
    placed = "work_zero" in file
    for table in file.get("rotary", []):
        axis = np.array(table["axis"], dtype=float)
        placed &= "point" in table
        rotary.append(
            Rotary(
                letter=table["letter"],
                head=table["on"] == "head",
                axis=axis / np.linalg.norm(axis),
                point=np.array(table.get("point", zero if table["on"] == "table" else [0, 0, 0])),
                sign=float(table.get("sign", 1)),
                low=float(table.get("min", -np.inf)),
                high=float(table.get("max", np.inf)),
                rapid=float(table["rapid"]),
                modulo=table.get("modulo"),
            )
        )
    low, high, rapid = (
        np.array([float(axis[k]) for axis in axes]) for k in ("min", "max", "rapid")
    )
    settings: dict[str, Any] = {}
    for part in reversed((text, *below)):
        settings.update(tomllib.loads(part).get("settings", {}))
    return Machine(
        low=low,
        high=high,
        rapid=rapid,
        rotary=tuple(rotary),
        zero=zero,
        home=top,
        placed=placed,
        retracts=bool(file.get("tools", {}).get("retracts", False)),
        straight=settings.get("rapid_path") == "linear",
    )


def library(root: Path, name: str) -> list[str]:
    """Text of a machine file of the library, and of the controls that it builds on."""
    texts = [(root / "machines" / f"{name}.toml").read_text()]
    while "extends" in (file := tomllib.loads(texts[-1])):
        texts.append((root / "controls" / f"{file['extends']}.toml").read_text())
    return texts
