"""What LinuxCNC's own interpreter, `rs274`, makes of a program: cuts and the rapids between."""

from __future__ import annotations

import itertools
import re
import shutil
import subprocess
from dataclasses import dataclass, replace

from conftest import absent


@dataclass(frozen=True)
class Move:
    """A move with the state in which the machine makes it; mm, mm/min, 1/min."""

    start: tuple = (0.0, 0.0, 0.0)
    # The end; of an arc also its centre in the plane, and its turns.
    shape: tuple = ()
    rapid: bool = True
    feed: float = 0.0
    tool: int = 0
    # How many tool changes have been.
    changes: int = 0
    turns: str = ""
    speed: float = 0.0
    mist: bool = False
    flood: bool = False
    work_offset: int = 1

    def same(self, other, tolerance):
        """Answer whether it is the same move, its numbers within the tolerance."""
        ours, theirs = (move.start + move.shape for move in (self, other))
        near = len(ours) == len(theirs) and all(
            abs(a - b) <= tolerance for a, b in zip(ours, theirs)
        )
        return near and self.state() == other.state()

    def state(self):
        """Answer all but the places; a feed counts in tenths, and not in a rapid."""
        feed = None if self.rapid else round(self.feed, 1)
        return replace(self, start=(), shape=(), feed=feed, changes=0)


class JudgeError(Exception):
    """Why `rs274` does not run a program."""


def moves(program, folder):
    """Answer the moves of a file, without those from tool to tool, which posts choose freely."""
    if shutil.which("rs274") is None:
        absent("rs274 (Debian package linuxcnc-uspace) is not installed")
    # By itself the interpreter counts inches.
    table = "".join(f"T{n} P{n} Z0 D{5 / 25.4:f}\n" for n in range(1, 20))
    (folder / "tool.tbl").write_text(table)
    (folder / "rs274.var").write_text("")
    done = subprocess.run(
        ["rs274", "-t", "tool.tbl", "-v", "rs274.var", "-g", str(program)],
        cwd=folder,
        # Its tool table is a file in the home folder, which all interpreters share.
        env={"HOME": str(folder), "PATH": "/usr/bin:/bin"},
        check=False,
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
        timeout=60,
    )
    if done.returncode:
        raise JudgeError(done.stderr.strip())
    return [move for run in _runs(_canonical(done.stdout)) for move in run]


# What a canonical call changes, of the state and its numbers.
SETTINGS = {
    "SET_FEED_RATE": lambda _, numbers: {"feed": numbers[0]},
    "CHANGE_TOOL": lambda now, numbers: {"tool": numbers[0], "changes": now.changes + 1},
    "SET_SPINDLE_SPEED": lambda _, numbers: {"speed": numbers[1]},
    "START_SPINDLE_CLOCKWISE": lambda *_: {"turns": "clockwise"},
    "START_SPINDLE_COUNTERCLOCKWISE": lambda *_: {"turns": "counter-clockwise"},
    "STOP_SPINDLE_TURNING": lambda *_: {"turns": ""},
    "MIST_ON": lambda *_: {"mist": True},
    "MIST_OFF": lambda *_: {"mist": False},
    "FLOOD_ON": lambda *_: {"flood": True},
    "FLOOD_OFF": lambda *_: {"flood": False},
    "SET_G5X_OFFSET": lambda _, numbers: {"work_offset": numbers[0]},
    "STRAIGHT_TRAVERSE": lambda _, numbers: {"rapid": True, "shape": tuple(numbers[:3])},
    "STRAIGHT_FEED": lambda _, numbers: {"rapid": False, "shape": tuple(numbers[:3])},
    # X, Y, centre, turns, Z.
    "ARC_FEED": lambda _, numbers: {
        "rapid": False,
        "shape": (*numbers[:2], numbers[5], *numbers[2:5]),
    },
}


def _canonical(printed):
    """Give the moves among the canonical calls; a line to where the tool stands is none."""
    assert "CANON_UNITS_INCHES" not in printed
    now = Move()
    for name, arguments in re.findall(r"^ *\d+ N\S* +(\w+)\((.*)\)$", printed, re.MULTILINE):
        if name in SETTINGS:
            numbers = [float(number) for number in re.findall(r"-?\d+\.?\d*", arguments)]
            now = replace(now, **SETTINGS[name](now, numbers))
        if now.shape:
            end = now.shape[:3]
            if now.shape != now.start:
                yield now
            now = replace(now, start=end, shape=())


def _runs(moves):
    """Give the moves from first to last cut after each tool change, at each work offset."""
    for _, group in itertools.groupby(moves, lambda move: (move.changes, move.work_offset)):
        run = list(group)
        cuts = [index for index, move in enumerate(run) if not move.rapid]
        if cuts:
            yield run[cuts[0] : cuts[-1] + 1]


def difference(ours, theirs, tolerance=0.0011):
    """Answer the first move that is not the same; each program rounds to a thousandth by itself."""
    for index, (one, other) in enumerate(itertools.zip_longest(ours, theirs)):
        if one is None or other is None or not one.same(other, tolerance):
            return f"move {index} of {len(ours)} and {len(theirs)}\nours   {one}\ntheirs {other}"
    return None
