"""Runs inside `freecadcmd`: how long posting takes, compared with FreeCAD's own `linuxcnc_post`.

    freecadcmd integrations/freecad/bench/speed.py

One operation of 200,000 moves at feed, every tenth of them an arc. Every figure is two: processor
time, of all threads of this process and of the programs that it runs, and wall. The round that is
fastest by wall counts, with its own processor time; they are compared each with its own kind.

It fails where `linuxcnc_post` does not take ten times what we take with the proof, and twenty times
what we take without it, by processor time and by wall. Nothing is posted without a proof, so its
share is measured by itself.
"""

import contextlib
import io
import math
import os
import resource
import sys
import tempfile
import time
from typing import NamedTuple

import Path
from PathScripts.post import linuxcnc_post

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(HERE), os.path.join(os.path.dirname(HERE), "tests")]

import toolpost_core
import toolpost_job
import toolpost_post
from work import Piece, Work, run

MOVES = 200_000
# How many times what we take FreeCAD's own post has to take.
WITH_PROOF, WITHOUT = 10, 20
MACHINE = "--machine generic-3axis-linuxcnc"
ROUNDS = 5
THEIRS = "FreeCAD's linuxcnc_post"
OURS = "toolpost, with its proof"
PROOF = "  of it: the proof"


def commands():
    """Answer the moves: turns of a spiral in ten levels, every tenth move an arc."""
    yield Path.Command("G0", {"X": 1.0, "Y": 0.0, "Z": 30.0})
    x, y = 1.0, 0.0
    for number in range(1, MOVES):
        angle = number * 0.05
        radius = 1.0 + number % 20_000 * 0.001
        start = (x, y)
        x, y = radius * math.cos(angle), radius * math.sin(angle)
        words = {"X": x, "Y": y, "Z": 20.0 - number // 20_000, "F": 10 / 3}
        if number % 10:
            yield Path.Command("G1", words)
        else:
            yield Path.Command("G3", {**words, **centre(start, (x, y)), "K": 0.0})


def centre(start, end):
    """Answer I and J of the arc of 60 degrees, counter-clockwise, between two points."""
    along = (end[0] - start[0], end[1] - start[1])
    aside = math.sqrt(0.75)
    return {"I": along[0] / 2 - along[1] * aside, "J": along[1] / 2 + along[0] * aside}


class Taken(NamedTuple):
    """What work has taken, in seconds."""

    wall: float
    processor: float

    def beyond(self, part):
        """Answer what is left without a part."""
        return Taken(self.wall - part.wall, self.processor - part.processor)


def now():
    """Answer the wall, and the processor time here and of the programs that have ended."""
    usages = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    processor = sum(usage.ru_utime + usage.ru_stime for usage in usages)
    return Taken(time.monotonic(), processor)


def fastest(works):
    """Run all of them in turn, a few times, and answer what the fastest round of each has taken."""
    best = {}
    for _ in range(ROUNDS):
        for what, work in works.items():
            begun = now()
            with contextlib.redirect_stdout(io.StringIO()):
                assert work(), "nothing was made"
            took = now().beyond(begun)
            # By wall, which comes first.
            best[what] = min(took, best.get(what, took))
    print(f"{'':44} {'processor time':>16} {'wall':>10}")
    for what, took in best.items():
        print(f"{what:44} {took.processor:14.3f} s {took.wall:8.3f} s", flush=True)
    return best


def main():
    """Measure, and hold the figures against each other."""
    work = Work("speed")
    piece = Piece("Adaptive", list(commands()))
    objects = [work.objects()[0][0], work.mill, piece]
    core = toolpost_core.core()
    options = toolpost_post.parser.parse_args(MACHINE.split())
    job = toolpost_job.job(objects, "part")
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "part.ngc")
        works = {
            THEIRS: lambda: linuxcnc_post.export(objects, file, "--no-show-editor"),
            OURS: lambda: toolpost_post.export(objects, file, MACHINE),
            "  of it: the job from FreeCAD's objects": lambda: toolpost_job.job(objects, "part"),
            "  of it: reading, writing and proving": lambda: core.post(job, options),
        }
        if isinstance(core, toolpost_core.Package):
            machine = core.package.machine(options.machine)
            program = core.package.read_job(job, machine)
            text, _ = core.post(job, options)
            works[PROOF] = lambda: core.package.prove(text, machine, program)
        best = fastest(works)
    held(best[THEIRS], best[OURS], WITH_PROOF, "what we take")
    if PROOF in best:
        without = best[OURS].beyond(best[PROOF])
        held(best[THEIRS], without, WITHOUT, "what we take without the proof")
    else:
        print("the proof's share is measured with the Python package alone")


def held(theirs, ours, least, what):
    """Print how many times our time FreeCAD's own post takes, and see that both are enough."""
    processor, wall = theirs.processor / ours.processor, theirs.wall / ours.wall
    print(f"FreeCAD's own takes {processor:.1f} times {what} by processor time, {wall:.1f} by wall")
    print(f"at least {least} is asked for, by both")
    assert min(processor, wall) >= least, "too slow"


run(main)
