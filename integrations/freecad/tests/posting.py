"""Runs inside `freecadcmd`: posts jobs that are right and jobs that are not.

    TOOLPOST_CASES=folder TOOLPOST_LONG=1000000 freecadcmd posting.py

For each case the folder gets `NAME.said` with all that FreeCAD printed, and `cases.json` has what
`export` answered. The longest job has as many commands as is said.
"""

import functools
import json
import os
import sys
import time
from unittest import mock

import Path

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.dirname(sys.path[0]))

import PathScripts.PathCustom as PathCustom
import PathScripts.PathProfile as PathProfile
import toolpost_core
import toolpost_job
import toolpost_post
from work import Piece, Work, run

FOLDER = os.environ["TOOLPOST_CASES"]
LONG = int(os.environ["TOOLPOST_LONG"])
LINUXCNC = "--machine generic-3axis-linuxcnc"
# One of each language, and what its files end with.
ROBOTS = {
    "kuka-kr6-r900": "src",
    "universal-ur5e": "script",
    "fanuc-lrmate-200id-mill": "ls",
    "abb-irb120-mill": "mod",
}

cases = {}


def case(name, objects, arguments=LINUXCNC, filename=None):
    """Post, with what is printed going to a file of its own."""
    filename = os.path.join(FOLDER, name + ".ngc") if filename is None else filename
    sys.stdout.flush()
    kept = os.dup(1), os.dup(2)
    with open(os.path.join(FOLDER, name + ".said"), "wb") as said:
        os.dup2(said.fileno(), 1)
        os.dup2(said.fileno(), 2)
        begun = time.monotonic()
        answer = toolpost_post.export(objects, filename, arguments)
        took = time.monotonic() - begun
        sys.stdout.flush()
        os.dup2(kept[0], 1)
        os.dup2(kept[1], 2)
    cases[name] = {"answer": answer, "file": filename, "seconds": took}


class Wrapped:
    """An object as FreeCAD 1.2 hands it to a post: a copy of its path, the rest its own."""

    def __init__(self, source):
        self.source = source
        self.Label = source.Label
        self.Path = Path.Path(source.Path.Commands)

    def __getattr__(self, name):
        return getattr(self.source, name)


def custom(work, *lines):
    operation = PathCustom.Create("Custom")
    operation.Label = "Custom"
    operation.ToolController = work.mill
    operation.Gcode = list(lines)
    work.document.recompute()
    return operation


def profile(work, label="Profile", **properties):
    return work.operation(PathProfile, label, **properties)


def right():
    work = Work("right")
    profile(work, "Außenkontur ∅5 – „fertig“")
    objects = work.objects()[0]
    case("file", objects)
    case("answer", objects, filename="-")
    case("report", objects, LINUXCNC + " --report " + os.path.join(FOLDER, "report.json"))
    case("offset", objects, LINUXCNC + " --work-offset G56")
    case("offset-unknown", objects, LINUXCNC + " --work-offset G53")
    case("offset-twice-dotted", objects, LINUXCNC + " --work-offset G54.7")
    case("offset-of-none", objects[1:], LINUXCNC + " --work-offset G56")
    case("sinumerik", objects, "--machine generic-3axis-sinumerik")
    for robot, ending in ROBOTS.items():
        case(robot, objects, f"--machine {robot}", os.path.join(FOLDER, f"part_1.{ending}"))
    operation = work.job.Operations.Group[0]
    group = work.document.addObject("App::DocumentObjectGroup", "Outer")
    compound = work.document.addObject("Path::FeatureCompound", "Compound")
    compound.Group = [operation]
    group.Group = [compound]
    work.document.recompute()
    case("groups", [*objects[:-1], group])
    case("machine-missing", objects, "")
    case("machine-unknown", objects, "--machine generic-3axis-linuxcmc")
    case("argument-unknown", objects, LINUXCNC + " --modal")
    case("argument-open", objects, LINUXCNC + " --report 'here")
    case("option-unknown", objects, LINUXCNC + " --option colour=red")
    case("option-bare", objects, LINUXCNC + " --option colour")
    case("option-of-the-function", objects, LINUXCNC + " --option name_or_path=3")
    targets(objects)
    case("no-folder", objects, filename=os.path.join(FOLDER, "missing", "part.ngc"))
    # Not even root writes there.
    case("read-only", objects, filename="/sys/part.ngc")
    case("wrapped", [Wrapped(obj) for obj in objects])
    operation.Active = False
    case("inactive", objects)
    work.close()


def targets(objects):
    """Save where two files cannot be, or one, or only the first of two."""
    inside = functools.partial(os.path.join, FOLDER)
    case("same", objects, LINUXCNC + " --report " + inside(".", "same.ngc"))
    case("folder", objects, filename=FOLDER)
    case("device", objects, LINUXCNC + " --report /dev/null")
    with open(inside("linked.ngc"), "w") as file:
        file.write("earlier")
    os.symlink("linked.ngc", inside("link.ngc"))
    case("link", objects)
    replace = os.replace

    def refuse(source, target):
        if target == inside("second.ngc"):
            raise PermissionError(13, "Permission denied")
        replace(source, target)

    with mock.patch.object(os, "replace", refuse):
        for first in ("new", "kept"):
            if first == "kept":
                with open(inside("kept.json"), "w") as file:
                    file.write("earlier")
            report = inside(first + ".json")
            case(first, objects, f"{LINUXCNC} --report {report}", inside("second.ngc"))


def wrong():
    work = Work("wrong")
    case("empty", work.objects()[0])
    operation = profile(work)
    objects = work.objects()[0]
    case("tool-not-called", [objects[0], operation])
    work.mill.ToolNumber = 0
    work.document.recompute()
    case("tool-without-number", objects)
    work.settle(work.mill, 0, 1, 200, 100)
    work.document.recompute()
    case("spindle-0", objects)
    work.settle(work.mill, 2000, 1, 0, 0)
    work.document.recompute()
    case("feed-0", objects)
    work.settle(work.mill, 2000, 1, 200, 100)
    work.document.recompute()
    operation.Active = False
    start, tool = objects[0], work.mill
    lines = ["G0 X0 Y0 Z30", "G1 X5 Y5 Z25 F3", "G999 X1"]
    case("code-unknown", [start, tool, custom(work, *lines)])
    whole = [Path.Command("G0", {"X": 0, "Y": 0, "Z": 30}), Path.Command("G1", {"X": 1, "F": 3})]
    for name, value in (("nan", float("nan")), ("infinite", float("inf")), ("huge", 1e25)):
        case(name, [start, tool, Piece("Broken", [*whole, Path.Command("G1", {"Y": value})])])
    case(
        "surrogate",
        [start, tool, Piece("Half \udc80", whole)],
        filename=os.path.join(FOLDER, "half-\udcff.ngc"),
    )
    broken = Path.Command("(one\nG1 X99)")
    case("comment-of-two-lines", [start, tool, Piece("Broken", [*whole, broken])])
    two = Path.Command("G1")
    two.Name = "G1 X5\nG1 Z-20"
    case("command-of-two-lines", [start, tool, Piece("Broken", [*whole, two])])
    operation.Active = True
    operation.Placement.Base.z = 5
    case("moved", [start, tool, operation])
    work.close()


def two_fixtures():
    work = Work("fixtures")
    work.job.Fixtures = ["G54", "G55"]
    work.job.OrderOutputBy = "Fixture"
    profile(work)
    case("fixtures", work.objects()[0])
    case("offset-of-two", work.objects()[0], LINUXCNC + " --work-offset G56")
    work.job.SplitOutput = True
    for number, objects in enumerate(work.objects(), 1):
        case(f"split-{number}", objects)
    work.close()


def order():
    """Our lists of a job, compared with those of FreeCAD."""
    work = Work("order")
    other = work.tool("Mill 8", "endmill.fcstd", 8, 3)
    work.job.Fixtures = ["G54", "G55"]
    profile(work, "one")
    profile(work, "two", tool=other)
    profile(work, "off", Active=False)
    profile(work, "three", tool=other)
    profile(work, "four")
    found = {}
    for by in ("Fixture", "Tool", "Operation"):
        work.job.OrderOutputBy = by
        work.job.SplitOutput = True
        found[by] = [
            [[(obj.Label, obj.Path.toGCode()) for obj in objects] for objects in lists]
            for lists in (toolpost_job.lists(work.job), work.objects())
        ]
    work.close()
    return found


def long():
    """Post a long job: the commands as FreeCAD's reader of G-code makes them."""
    steps = ((n % 100 * 0.5, n // 100 * 0.001) for n in range(LONG))
    lines = [f"G1 X{x:.3f} Y{y:.3f} Z1 F3" for x, y in steps]
    work = Work("long")
    start = work.objects()[0][0]
    piece = Piece("Long", [])
    piece.Path = Path.Path("G0 X0 Y0 Z30\n" + "\n".join(lines))
    case("long", [start, work.mill, piece])
    work.close()


def main():
    right()
    wrong()
    two_fixtures()
    long()
    with open(os.path.join(FOLDER, "cases.json"), "w", encoding="utf-8") as file:
        core = type(toolpost_core.core()).__name__
        json.dump({"core": core, "cases": cases, "order": order()}, file)


run(main)
