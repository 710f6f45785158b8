"""What LinuxCNC's own interpreter, `rs274`, makes of a program: its cuts and the rapids between them."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass


@dataclass(frozen=True)
class Move:
    """A move with the state in which the machine makes it; lengths in mm, mm/min, rpm."""

    start: tuple
    # None for a rapid.
    feed: float | None
    # End point; for an arc also its centre in the plane and its turns.
    shape: tuple
    tool: int
    # How many tool changes have been.
    changes: int
    spindle: tuple
    coolant: frozenset
    work_offset: int

    def same(self, other, tolerance):
        numbers = (self.start + self.shape, other.start + other.shape)
        near = len(numbers[0]) == len(numbers[1]) and all(
            abs(a - b) <= tolerance for a, b in zip(*numbers)
        )
        feeds = (self.feed, other.feed)
        alike = feeds[0] == feeds[1] if None in feeds else abs(feeds[0] - feeds[1]) <= 0.1
        state = (self.tool, self.spindle, self.coolant, self.work_offset)
        return (
            near
            and alike
            and state == (other.tool, other.spindle, other.coolant, other.work_offset)
        )


class Refused(Exception):
    """Why `rs274` does not run a program."""


def moves(program, folder):
    """The moves of a file, without those from one tool to the next, which posts are free to choose."""
    table = "".join("T%d P%d Z0 D%f\n" % (n, n, 5 / 25.4) for n in range(1, 20))
    (folder / "tool.tbl").write_text(table)
    (folder / "rs274.var").write_text("")
    # Its tool table is a file in the home folder, which all interpreters share.
    words = ["rs274", "-t", "tool.tbl", "-v", "rs274.var", "-g", str(program)]
    done = subprocess.run(
        words,
        cwd=folder,
        env={"HOME": str(folder), "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
        timeout=60,
    )
    if done.returncode:
        raise Refused(done.stderr.strip())
    return _between_tools(_canonical(done.stdout))


def _canonical(printed):
    """The moves among the canonical calls."""
    found, at, feed, unit = [], (0.0, 0.0, 0.0), 0.0, 1.0
    tool, changes, speed, turns, coolant, offset = 0, 0, 0.0, "", frozenset(), 1
    for line in printed.splitlines():
        call = re.match(r"\s*\d+ N\S*\s+(\w+)\((.*)\)", line)
        if not call:
            continue
        name, arguments = call.groups()
        numbers = [float(number) for number in re.findall(r"-?\d+\.?\d*", arguments)]
        shape = None
        if name == "USE_LENGTH_UNITS":
            unit = 1.0 if arguments == "CANON_UNITS_MM" else 25.4
        elif name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            end = shape = tuple(number * unit for number in numbers[:3])
        elif name == "ARC_FEED":
            x, y, center_x, center_y, turns_of_arc, z = numbers[:6]
            end = tuple(number * unit for number in (x, y, z))
            shape = (*end, center_x * unit, center_y * unit, turns_of_arc)
        elif name == "SET_FEED_RATE":
            feed = numbers[0] * unit
        elif name == "CHANGE_TOOL":
            tool = int(numbers[0])
            changes += 1
        elif name == "SET_SPINDLE_SPEED":
            speed = numbers[1]
        elif name.endswith(("_SPINDLE_CLOCKWISE", "_SPINDLE_COUNTERCLOCKWISE", "_SPINDLE_TURNING")):
            turns = name
        elif name in ("MIST_ON", "FLOOD_ON"):
            coolant |= {name.split("_")[0]}
        elif name in ("MIST_OFF", "FLOOD_OFF"):
            coolant -= {name.split("_")[0]}
        elif name == "SET_G5X_OFFSET":
            offset = int(numbers[0])
        if shape:
            # A line to where the tool stands is no move.
            if len(shape) > 3 or end != at:
                rapid = name == "STRAIGHT_TRAVERSE"
                found.append(
                    Move(
                        at,
                        None if rapid else feed,
                        shape,
                        tool,
                        changes,
                        (turns, speed),
                        coolant,
                        offset,
                    )
                )
            at = end
    return found


def _between_tools(moves):
    """The moves from the first cut after each tool change, at each work offset, to the last."""
    runs = []
    for move in moves:
        if not runs or (runs[-1][-1].changes, runs[-1][-1].work_offset) != (
            move.changes,
            move.work_offset,
        ):
            runs.append([])
        runs[-1].append(move)
    kept = []
    for run in runs:
        cuts = [index for index, move in enumerate(run) if move.feed is not None]
        if cuts:
            kept += run[cuts[0] : cuts[-1] + 1]
    return kept


def difference(ours, theirs, tolerance=0.0011):
    """The first move that is not the same, or None. Each program rounds to a thousandth by itself."""
    for index in range(max(len(ours), len(theirs))):
        pair = ours[index : index + 1] + theirs[index : index + 1]
        if len(pair) < 2 or not pair[0].same(pair[1], tolerance):
            return "move %d of %d and %d\nours   %s\ntheirs %s" % (
                index,
                len(ours),
                len(theirs),
                ours[index : index + 1],
                theirs[index : index + 1],
            )
    return None
