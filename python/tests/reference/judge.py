"""Compares the motion of a program with that of its source, densely between the ends.

While cutting, tip and tool axis stay on the way of the source, at its feed, with its tool, spindle,
coolant and compensation. All else that moves (rapids, approach, home) stays in the corridor about
the rapids of the source, or on the tool axis through the end of a cut, or clear of all that is cut:
the line of the tool, from the tip up, stays out of the box of all cuts. All axes keep their
travels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Callable

import numpy as np

from .cldata import Move, Source
from .control import Control
from .machine import ARRAY, slerp


@dataclass(frozen=True)
class Limits:
    """What may differ."""

    #: Tip at the ends, mm: half a step of three words, of arcs twice, and the chord error.
    end: float = 0.004
    #: Tip between ends: what machines may leave lines by (`orientation.tolerance`), and arcs.
    between: float = 0.011
    #: Rounding of a rotary word, at the distance from the centre; degrees.
    word: float = 0.0008
    axis: float = 0.004
    sweep: float = 1.05
    corridor: float = 0.11
    #: How far the line of the tool stays from the box of all cuts, mm.
    clear: float = 0.5
    #: The tip's speed against the feed of the source: over a block at most, over half a
    #: millimetre at most, over a block at least.
    fast: float = 1.02
    peak: float = 1.1
    slow: float = 0.9
    #: Steps of samples: mm, and degrees.
    step: float = 1.0
    turn: float = 0.5


@dataclass
class Verdict:
    """What was found, and what was looked at."""

    faults: list[str] = field(default_factory=list)
    samples: int = 0
    off: float = 0.0
    fastest: float = 0.0
    slowest: float = np.inf

    def add(self, rule: str, line: int, text: str) -> None:
        self.faults.append(f"{rule}: line {line}: {text}")


@dataclass
class Samples:
    """Poses along all rows, one after another."""

    row: ARRAY
    share: ARRAY
    tip: ARRAY
    along: ARRAY
    axes: ARRAY
    turns: ARRAY


def apart(one: ARRAY, two: ARRAY) -> ARRAY:
    """Angles between axes, degrees."""
    cross = np.linalg.norm(np.cross(one, two), axis=-1)
    return np.asarray(np.degrees(np.arctan2(cross, (one * two).sum(-1))))


def sample(control: Control, limits: Limits) -> Samples:
    """Poses along all rows of a program, at most a step apart."""
    rows, machine = control.rows, control.machine
    start = np.array([row.start for row in rows])
    end = np.array([row.end for row in rows])
    before = np.array([row.turns[0] for row in rows])
    behind = np.array([row.turns[1] for row in rows])
    frame = np.array([row.frame for row in rows])
    way = np.linalg.norm(end - start, axis=1)
    turn = abs(behind - before).max(1)
    # Without a turning axis the way is straight.
    step = np.where(turn > 0, limits.step / 4, limits.step)
    vectors = np.array([row.axes is not None for row in rows])
    count = np.maximum(np.ceil(way / step), np.ceil(turn / limits.turn)).astype(int)
    count = count.clip(1, 4000)
    row = np.repeat(np.arange(len(rows)), count + 1)
    first = np.cumsum(count + 1) - (count + 1)
    share = (np.arange(len(row)) - first[row]) / count[row]
    place = start[row] + (end - start)[row] * share[:, None]
    turns = before[row] + (behind - before)[row] * share[:, None]
    tip, along = np.empty((len(row), 3)), np.empty((len(row), 3))
    axes = np.empty((len(row), 3))
    by_vector = vectors[row]
    if by_vector.any():
        none = np.zeros(3)
        ends = [row.axes if row.axes is not None else (none, none) for row in rows]
        one, two = np.array([pair[0] for pair in ends]), np.array([pair[1] for pair in ends])
        of = row[by_vector]
        along[by_vector] = slerp(one[of], two[of], share[by_vector])
        both = machine.orient(along[by_vector])
        both = np.where(np.isnan(both), turns[by_vector], both)
        both += 360 * np.round((turns[by_vector] - both) / 360)
        nearer = abs(both - turns[by_vector]).max(2).argmin(0)
        turns[by_vector] = both[nearer, np.arange(len(nearer))]
    for index in np.unique(frame):
        means = control.frames[index]
        here = frame[row] == index
        number = int(here.sum())
        known, real = np.full(number, means.length), np.full(number, means.real)
        if means.follows:
            part = means.origin + place[here] @ means.turn.T
            axes[here] = machine.inverse(part, turns[here], known)
        else:
            axes[here] = place[here] + means.origin
        found, lean = machine.forward(axes[here], turns[here], real)
        tip[here] = found
        along[here] = np.where(by_vector[here, None], along[here], lean)
    return Samples(row, share, tip, along, axes, turns)


class Judge:
    """One program against its source."""

    def __init__(self, source: Source, control: Control, limits: Limits | None = None) -> None:
        self.limits = limits or Limits()
        self.control, self.machine = control, control.machine
        self.rows = control.rows
        self.verdict = Verdict()
        self.moves, self.lengths = moving(source.moves), source.lengths
        self.samples = sample(control, self.limits)
        self.verdict.samples = len(self.samples.row)
        self.last = np.flatnonzero(np.append(np.diff(self.samples.row) > 0, True))
        self.begin = np.append(0, self.last[:-1] + 1)
        self.columns()
        self.walk()
        self.cuts()
        self.air()
        self.speeds()
        self.travels()

    def columns(self) -> None:
        moves = self.moves
        none = np.full(3, np.nan)
        self.start = np.array([none if m.start is None else m.start for m in moves])
        self.end = np.array([m.end for m in moves])
        self.lean = np.array([m.axis[0] for m in moves]), np.array([m.axis[1] for m in moves])
        self.cutting = np.array([not m.rapid for m in moves])
        self.touched = touching(moves)
        self.box = self.touched.min(0), self.touched.max(0)
        # Runs of cuts without a rapid between them; a hole is a run of its own.
        self.runs: list[tuple[int, int]] = []
        for index, move in enumerate(moves):
            if move.rapid:
                continue
            joined = self.runs and self.runs[-1][1] == index and not move.hole
            if joined and not moves[index - 1].hole:
                self.runs[-1] = (self.runs[-1][0], index + 1)
            else:
                self.runs.append((index, index + 1))

    # Which piece of the source a row cuts.

    def walk(self) -> None:
        """Give each row its piece of the source, in order, or none: it goes through the air."""
        self.piece = np.full((len(self.rows), 2), -1)
        #: What the rounding of rotary words moves the tip by, where the control does not follow it.
        follows = np.array([frame.follows for frame in self.control.frames])
        follows = follows[np.array([row.frame for row in self.rows])]
        far = np.linalg.norm(self.samples.tip[self.last], axis=1)
        self.reach = np.where(follows, 0, math.radians(self.limits.word) * far).tolist()
        self.ends_along = self.samples.along[self.last].tolist()
        self.lean_lists = self.lean[0].tolist(), self.lean[1].tolist()
        self.sweep = np.radians(apart(*self.lean)).tolist()
        starts, ends = self.start.tolist(), self.end.tolist()
        self.lists = starts, ends
        #: How far along its last piece a row ends.
        self.share = np.ones(len(self.rows))
        #: For rows in the air: the run before, and whether that one is not done yet.
        self.zone: list[tuple[int, bool]] = []
        run, index, share = -1, 0, 1.0
        tips = self.samples.tip.tolist()
        for number, row in enumerate(self.rows):
            one, two = tips[self.begin[number]], tips[self.last[number]]
            if row.feed.mode != "rapid":
                where = None
                if run >= 0:
                    where = self.forward(run, index, share, one, two, number)
                if where is None and self.completed(run, index, share) and run + 1 < len(self.runs):
                    first = self.runs[run + 1][0]
                    if self.near(one, self.lists[0][first], self.limits.end * 2):
                        where = self.forward(run + 1, first, 0.0, one, two, number)
                        if where is not None:
                            run, index, share = run + 1, first, 0.0
                if where is not None:
                    self.piece[number] = (index, where[0])
                    self.share[number] = where[1]
                    index, share = where
                    self.zone.append((run, False))
                    continue
            self.zone.append((run, not self.completed(run, index, share)))
        if not self.completed(run, index, share) or run + 1 < len(self.runs):
            line = self.moves[self.runs[min(run + 1, len(self.runs) - 1)][0]].line
            self.verdict.add("missing", self.rows[-1].line, f"not cut from source line {line} on")

    def completed(self, run: int, index: int, share: float) -> bool:
        if run < 0:
            return True
        last = self.runs[run][1] - 1
        left = (1 - share) * math.dist(self.lists[0][index], self.lists[1][index])
        return index == last and left <= self.limits.end * 2

    @staticmethod
    def near(one: list[float], two: list[float], limit: float) -> bool:
        return math.dist(one, two) <= limit

    def forward(
        self, run: int, index: int, share: float, one: list[float], two: list[float], number: int
    ) -> tuple[int, float] | None:
        """Place on the run, from here on, at which a row ends that begins here."""
        limit = self.limits.end + self.reach[number]
        starts, ends = self.lists
        here = [a + (b - a) * share for a, b in zip(starts[index], ends[index])]
        if self.moves[index].hole and not self.completed(run, index, share):
            # The tool comes back into the hole by rapid, and feeds on from above the last depth.
            axis = self.lean_lists[0][index]
            back = max(sum((a - b) * c for a, b, c in zip(one, here, axis)), 0.0)
            here = [a + back * c for a, c in zip(here, axis)]
        if not self.near(one, here, 2 * limit + 0.004):
            return None
        way = [b - a for a, b in zip(one, two)]
        length2 = sum(value * value for value in way)
        loose = self.limits.between + limit
        for k in range(index, self.runs[run][1]):
            p, q = starts[k], ends[k]
            side = [b - a for a, b in zip(p, q)]
            square = sum(value * value for value in side)
            if square < 1e-18:
                at = self.turned(number, k)
            else:
                at = sum((b - a) * s for a, b, s in zip(p, two, side)) / square
            at = min(max(at, share if k == index else 0.0), 1.0)
            place = [a + s * at for a, s in zip(p, side)]
            if self.near(two, place, limit) and self.leans(number, k, at):
                return k, at
            # The row goes through the corner behind this piece, or it does not come further.
            if length2 < 1e-18:
                return None
            corner = sum((b - a) * w for a, b, w in zip(one, q, way)) / length2
            corner = min(max(corner, 0.0), 1.0)
            if not self.near(q, [a + w * corner for a, w in zip(one, way)], loose):
                return None
        return None

    def turned(self, number: int, k: int) -> float:
        """Share of a turn without motion of the tip at which a row ends."""
        along = self.samples.along[self.last[number]]
        sweep = float(apart(self.lean[0][k], self.lean[1][k]))
        return float(apart(self.lean[0][k], along)) / sweep if sweep > 0 else 1.0

    def leans(self, number: int, k: int, at: float) -> bool:
        """Say whether the tool axis at the end of a row is that of the place."""
        along = self.ends_along[number]
        one, two = self.lean_lists[0][k], self.lean_lists[1][k]
        sweep = self.sweep[k]
        if sweep < 1e-9:
            goal = one
        else:
            a, b = math.sin((1 - at) * sweep), math.sin(at * sweep)
            goal = [(a * x + b * y) / math.sin(sweep) for x, y in zip(one, two)]
        return self.near(along, goal, math.radians(self.limits.sweep))

    # Cuts.

    def cuts(self) -> None:
        """Compare tip, axis and state of each sample of a cut with its piece of the source."""
        of = self.samples.row
        here = np.flatnonzero(self.piece[of, 0] >= 0)
        row = of[here]
        low, high = self.piece[row, 0], self.piece[row, 1]
        best, lean = np.full(len(here), np.inf), np.full(len(here), np.inf)
        for step in range(int((high - low).max(initial=0)) + 1):
            k = np.minimum(low + step, high)
            far, angle = self.distance(here, k)
            closer = far < best
            lean = np.where(
                closer, angle, np.where(far < best + 1e-3, np.minimum(lean, angle), lean)
            )
            best = np.minimum(best, far)
        turning = np.array([(r.turns[0] != r.turns[1]).any() for r in self.rows])[row]
        follows = np.array([frame.follows for frame in self.control.frames])
        follows = follows[np.array([r.frame for r in self.rows])][row]
        reach = np.where(follows, 0, np.radians(self.limits.word)) * np.linalg.norm(
            self.samples.tip[here], axis=1
        )
        self.verdict.off = float(best.max(initial=0))
        inner = (self.samples.share[here] > 0) & (self.samples.share[here] < 1)
        allowed = reach + np.where(inner, self.limits.between, self.limits.end)
        self.report("path", row, best - allowed, lambda n: f"tip {best[n]:.4f} mm off its way")
        # The source says the axis at its own points only; between them the sweep is limited.
        lines = np.array([r.line for r in self.rows] + [-1])
        last = (self.share > 1 - 1e-6) & (lines[1:] != lines[:-1])
        corner = ~inner & last[row] & (self.samples.share[here] > 0)
        angles = np.where(turning & ~corner, self.limits.sweep, self.limits.axis)
        self.report("axis", row, lean - angles, lambda n: f"axis {lean[n]:.3f} degrees off")
        self.states(np.flatnonzero(self.piece[:, 0] >= 0))

    def distance(self, here: ARRAY, k: ARRAY) -> tuple[ARRAY, ARRAY]:
        """Distances of samples from pieces of the source: of the tip, and of the axis there."""
        start, way = self.start[k], self.end[k] - self.start[k]
        square = (way * way).sum(1)
        tip, along = self.samples.tip[here], self.samples.along[here]
        turns_only = square < 1e-18
        at = ((tip - start) * way).sum(1) / np.where(turns_only, 1, square)
        at = at.clip(0, 1)
        one, two = self.lean[0][k], self.lean[1][k]
        far = np.linalg.norm(start + way * at[:, None] - tip, axis=1)
        angle = apart(slerp(one, two, at), along)
        if turns_only.any():
            # Where only the axis turns, its place on the great circle is the nearest one.
            sweep = np.radians(apart(one, two))
            gone = np.radians(apart(one, along))
            share = (gone / np.where(sweep > 0, sweep, 1)).clip(0, 1)
            angle = np.where(turns_only, apart(slerp(one, two, share), along), angle)
        return far, angle

    def states(self, rows: ARRAY) -> None:
        names: dict[int, int] = {}
        for number in rows.tolist():
            row, move = self.rows[number], self.moves[self.piece[number, 1]]
            tool, speed, coolant, side = row.state
            if tool < 0:
                tool = names.setdefault(tool, move.state[0])
            expected = move.state
            if (tool, coolant) != (expected[0], expected[2]) or abs(speed - expected[1]) > 0.51:
                self.verdict.add("state", row.line, f"{row.state} and not {expected}")
                return
            if side and side != expected[3]:
                self.verdict.add("compensation", row.line, f"{side} and not {expected[3]}")
                return

    def report(self, rule: str, row: ARRAY, excess: ARRAY, text: Callable[[int], str]) -> None:
        """Add the worst sample of each block that is over its limit."""
        seen: set[int] = set()
        over = np.flatnonzero(excess > 0)
        for n in over[np.argsort(-excess[over])].tolist():
            line = self.rows[int(row[n])].line
            if line not in seen and len(seen) < 20:
                seen.add(line)
                self.verdict.add(rule, line, text(n))

    # The air.

    def air(self) -> None:
        """Keep samples outside of cuts with the rapids of the source, or clear of all cuts."""
        of = self.samples.row
        free = self.piece[of, 0] < 0
        # Up to Z home before anything else: where the axes stand at the start, no program knows.
        for number, row in enumerate(self.rows):
            only_z = not self.control.frames[row.frame].follows and (row.start == row.end)[:2].all()
            if not (only_z and (row.turns[0] == row.turns[1]).all() and row.end[2] >= row.start[2]):
                break
            free &= of != number
        fine = ~free
        loose = np.flatnonzero(free)
        zones = sorted({self.zone[n] for n in np.unique(of[loose]).tolist()})
        places = {zone: index for index, zone in enumerate(zones)}
        zone = np.array([places.get(zone, -1) for zone in self.zone])[of[loose]]
        loose = loose[np.argsort(zone, kind="stable")]
        bounds = np.append(0, np.cumsum(np.bincount(zone, minlength=len(zones))))
        # The end of the last cut before each row: along its axis the tool may leave, and come back.
        cut = np.where(self.piece[:, 0] >= 0, np.arange(len(self.rows)), -1)
        before = np.maximum.accumulate(cut)[of]
        for index, (run, inside) in enumerate(zones):
            here = loose[bounds[index] : bounds[index + 1]]
            ok = np.zeros(len(here), dtype=bool)
            for k in self.rapids(run, inside):
                ok |= self.with_rapid(here, k)
            if run >= 0:
                last = self.last[before[here]]
                ok |= self.on_axis(here, self.samples.tip[last], self.samples.along[last])
            if run + 1 < len(self.runs) and not inside:
                first = self.runs[run + 1][0]
                ok |= self.on_axis(here, self.start[[first]], self.lean[0][[first]])
            fine[here] = ok
        left = np.flatnonzero(~fine)
        fine[left] = self.clear(left)
        bad = np.flatnonzero(~fine)
        self.report(
            "rapid",
            of[bad],
            np.ones(len(bad)),
            lambda n: (
                f"tip at {np.round(self.samples.tip[bad[n]], 2)}, axis "
                f"{np.round(self.samples.along[bad[n]], 3)}: not on a way of the source, not clear"
            ),
        )

    def rapids(self, run: int, inside: bool) -> range:
        """Pieces of the source between a run and the next."""
        if inside:
            return range(0)
        first = self.runs[run][1] if run >= 0 else 0
        last = self.runs[run + 1][0] if run + 1 < len(self.runs) else len(self.moves)
        return range(first, last)

    def with_rapid(self, here: ARRAY, k: int) -> ARRAY:
        if np.isnan(self.start[k]).any():
            far = np.linalg.norm(self.samples.tip[here] - self.end[k], axis=1)
            angle = apart(np.tile(self.lean[1][k], (len(here), 1)), self.samples.along[here])
        else:
            far, angle = self.distance(here, np.full(len(here), k))
            far = np.where(self.over_rapid(here, k), 0, far)
        return np.asarray((far <= self.limits.corridor) & (angle <= self.limits.sweep))

    def over_rapid(self, here: ARRAY, k: int) -> ARRAY:
        """Above a rapid, along the tool: what it takes up there, it took on the rapid, too."""
        axis, way = self.lean[0][k], self.end[k] - self.start[k]
        if apart(axis[None], self.lean[1][k][None])[0] > 1e-6:
            return np.zeros(len(here), dtype=bool)
        across = way - (way @ axis) * axis
        away = self.samples.tip[here] - self.start[k]
        # A way along the tool counts from its lower end.
        lower = np.full(len(here), float(way @ axis < 0))
        length = float(across @ across)
        share = (away @ across / length).clip(0, 1) if length > 1e-12 else lower
        away -= share[:, None] * way
        up = away @ axis
        side = np.linalg.norm(away - up[:, None] * axis, axis=1)
        return np.asarray((side <= self.limits.corridor) & (up >= 0))

    def on_axis(self, here: ARRAY, tip: ARRAY, axis: ARRAY) -> ARRAY:
        """Above a pose, along its axis."""
        away = self.samples.tip[here] - tip
        up = (away * axis).sum(1)
        side = np.linalg.norm(away - up[:, None] * axis, axis=1)
        angle = apart(axis, self.samples.along[here])
        return np.asarray(
            (side <= self.limits.corridor) & (up > -0.01) & (angle <= self.limits.sweep)
        )

    def clear(self, here: ARRAY) -> ARRAY:
        """Say where the line from the tip up to the spindle stays out of the box of all cuts."""
        low, high = self.box[0] - self.limits.clear, self.box[1] + self.limits.clear
        tip, along = self.samples.tip[here], self.samples.along[here]
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = (low - tip) / along, (high - tip) / along
        flat = abs(along) < 1e-12
        out = (flat & ((tip < low) | (tip > high))).any(1)
        enter = np.where(flat, -np.inf, np.minimum(one, two)).max(1)
        leave = np.where(flat, np.inf, np.maximum(one, two)).min(1)
        return np.asarray(out | (enter > leave) | (leave < 0) | self.beyond(tip, along))

    def beyond(self, tip: ARRAY, along: ARRAY) -> ARRAY:
        """Say where all cuts lie behind the plane through the tip, at right angles to the tool."""
        if not len(tip):
            return np.zeros(0, dtype=bool)
        axes, which = np.unique(np.round(along, 6), axis=0, return_inverse=True)
        farthest = np.array([(self.touched @ axis).max() for axis in axes])
        return np.asarray((tip * along).sum(1) > farthest[which.ravel()] + self.limits.clear)

    # Speed and travels.

    def speeds(self) -> None:
        """Compare the tip's speed with the feed of the source, by what the control makes of F."""
        limits = self.limits
        for number in np.flatnonzero(self.piece[:, 0] >= 0).tolist():
            row, move = self.rows[number], self.moves[self.piece[number, 1]]
            span = slice(self.begin[number], self.last[number] + 1)
            tip = self.samples.tip[span]
            steps = np.linalg.norm(np.diff(tip, axis=0), axis=1)
            way = float(steps.sum())
            if move.feed is None or way < 1e-6:
                continue
            minutes = self.minutes(number, way)
            mean = way / minutes / move.feed
            peak = max(mean, self.peak(steps) * len(steps) / minutes / move.feed)
            self.verdict.fastest = max(self.verdict.fastest, peak)
            self.verdict.slowest = min(self.verdict.slowest, mean)
            # Words have three decimals: of a short way its length is not known better than that.
            blur = 0.0025 / way
            text = f"{move.feed * mean:.1f}, at most {move.feed * peak:.1f} mm/min"
            if mean > limits.fast + blur or peak > limits.peak + blur:
                self.verdict.add("fast", row.line, f"{text} at a feed of {move.feed:.0f}")
            elif mean < limits.slow - blur and not self.held_back(number, way / move.feed):
                self.verdict.add("slow", row.line, f"{text} at a feed of {move.feed:.0f}")

    @staticmethod
    def peak(steps: ARRAY) -> float:
        """Longest step that the tip makes in even times, over at least half a millimetre of way."""
        gone = np.append(0, np.cumsum(steps))
        # Where the way gone is half a millimetre more than at each sample.
        reach = np.searchsorted(gone, gone + 0.5)
        here = np.flatnonzero(reach < len(gone))
        if not len(here):
            return 0.0
        span = reach[here]
        return float(((gone[span] - gone[here]) / (span - here)).max())

    def minutes(self, number: int, way: float) -> float:
        """Time of a row."""
        row = self.rows[number]
        mode, rate, share, degrees = row.feed
        if mode == "block":
            return share / rate
        if degrees is not None:
            turn = abs(row.turns[1] - row.turns[0]) * np.array(degrees)
            way = float(np.hypot(np.linalg.norm(row.end - row.start), np.linalg.norm(turn)))
        return way / rate

    def held_back(self, number: int, minutes: float) -> bool:
        """Say whether a rotary axis would have to go faster than it can."""
        row = self.rows[number]
        turn = np.asarray(row.turns[1] - row.turns[0]) / minutes
        rates: list[float] = abs(turn).tolist()
        return any(rate > 0.9 * axis.rapid for rate, axis in zip(rates, self.machine.rotary))

    @staticmethod
    def position(letter: str, at: ARRAY) -> Callable[[int], str]:
        return lambda n: f"{letter}{at[n]:.3f}"

    def travels(self) -> None:
        """Every axis stays within its travel; linear ones where the file says where they stand."""
        of = self.samples.row
        for index, axis in enumerate(self.machine.rotary):
            at = self.samples.turns[:, index]
            over = np.maximum(axis.low - at, at - axis.high) - 1e-3
            self.report("travel", of, over, self.position(axis.letter, at))
        if not self.machine.placed:
            return
        # Without the length of the tool nobody knows where Z stands, and no axis under a head.
        known = bool(self.lengths)
        heads = any(axis.head for axis in self.machine.rotary)
        judged = np.array([known or not heads, known or not heads, known])
        over = np.maximum(
            self.machine.low - self.samples.axes, self.samples.axes - self.machine.high
        )
        self.report(
            "travel",
            of,
            np.where(judged, over, -1).max(1) - 2e-3,
            lambda n: f"axes at {np.round(self.samples.axes[n], 3)}",
        )


def moving(moves: list[Move]) -> list[Move]:
    """Give the moves that move."""
    none = np.full(3, np.nan)
    way = np.array([m.end - (none if m.start is None else m.start) for m in moves])
    turn = np.array([m.axis[1] - m.axis[0] for m in moves])
    apart_by = np.maximum(abs(way).max(1), abs(turn).max(1))
    return [move for move, by in zip(moves, apart_by) if not by < 1e-9 or move.hole]


def touching(moves: list[Move]) -> ARRAY:
    """Return the ends of cuts, but not the upper one of a cut along the tool: there is air.

    A hole begins at the surface of the part, which its source states. The R plane is above it in
    the air, and the tool comes there by rapid.
    """
    cuts = [move for move in moves if not move.rapid]
    axis = np.array([move.axis[0] for move in cuts])
    none = np.full(3, np.nan)
    start = np.array([none if move.start is None else move.start for move in cuts])
    end = np.array([move.end for move in cuts])
    way = end - start
    down = (way * axis).sum(1)
    aside = np.linalg.norm(way - down[:, None] * axis, axis=1)
    holes = np.array([move.hole for move in cuts], dtype=bool)
    turned = apart(axis, np.array([move.axis[1] for move in cuts]))
    alone = (aside < 1e-3) & (turned < 1e-6) & ~holes
    start = start - np.array([move.clear for move in cuts])[:, None] * axis
    return np.concatenate([start[~(alone & (down < 0))], end[~(alone & (down > 0))]])
