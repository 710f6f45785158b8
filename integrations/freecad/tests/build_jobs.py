"""Runs inside `freecadcmd`: makes jobs with FreeCAD's own operations, and writes each as JSON.

    TOOLPOST_JOBS=folder freecadcmd build_jobs.py

Next to each job `NAME.json` is `NAME.ngc`, what FreeCAD's own `linuxcnc_post` makes of it.
"""

import json
import os
import sys

import FreeCAD
import Part
import PathScripts.PathAdaptive as PathAdaptive
import PathScripts.PathDressupHoldingTags as PathDressupHoldingTags
import PathScripts.PathDressupRampEntry as PathDressupRampEntry
import PathScripts.PathDrilling as PathDrilling
import PathScripts.PathEngrave as PathEngrave
import PathScripts.PathHelix as PathHelix
import PathScripts.PathJob as PathJob
import PathScripts.PathMillFace as PathMillFace
import PathScripts.PathPocketShape as PathPocketShape
import PathScripts.PathPost as PathPost
import PathScripts.PathProfile as PathProfile
from FreeCAD import Vector
from PathScripts.post import linuxcnc_post

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.dirname(sys.path[0]))

import toolpost_job
from work import LARGE_HOLE, POCKET_FLOOR, SMALL_HOLES, TOP, Work, run

FOLDER = os.environ["TOOLPOST_JOBS"]


def write(work):
    for index, objects in enumerate(work.objects(), 1):
        save(f"{work.name}-{index}" if work.job.SplitOutput else work.name, objects)
    work.close()


def save(name, objects):
    path = os.path.join(FOLDER, name)
    job = toolpost_job.job(objects, name)
    with open(path + ".json", "w", encoding="utf-8") as file:
        json.dump(job, file, ensure_ascii=False, indent=1)
    linuxcnc_post.export(objects, path + ".ngc", "--no-show-editor --no-header")
    moves = sum(operation["commands"].count("\n") for operation in job["operations"])
    print(f"{name}: {len(job['operations'])} operations, {moves} commands")


def single(name, module, **properties):
    work = Work(name)
    work.operation(module, name, **properties)
    write(work)


def drilling(name, **properties):
    work = Work(name)
    drill = work.tool("Drill 5", "drill.fcstd", 5, 2)
    work.operation(PathDrilling, name, SMALL_HOLES, drill, **properties)
    write(work)


def engraving():
    work = Work("engrave")
    wire = work.document.addObject("Part::Feature", "Wire")
    line = Part.makePolygon([Vector(20, 50, 20), Vector(40, 50, 20), Vector(40, 70, 20)])
    arc = Part.Arc(Vector(40, 70, 20), Vector(30, 75, 20), Vector(20, 70, 20)).toShape()
    wire.Shape = Part.Wire([*line.Edges, arc])
    work.job.Model.addObject(wire)
    work.operation(PathEngrave, "engrave", BaseShapes=[wire], StartDepth=20, FinalDepth=19.5)
    write(work)


def tags():
    work = Work("tags")
    profile = work.operation(PathProfile, "profile")
    dressup = PathDressupHoldingTags.Create(profile, "tags")
    # In the window the dressup takes the place of its base.
    work.job.Operations.Group = [dressup]
    write(work)


def ramps():
    work = Work("ramps")
    profile = work.operation(PathProfile, "profile")
    ramp = work.document.addObject("Path::FeaturePython", "RampEntryDressup")
    PathDressupRampEntry.ObjectDressup(ramp)
    ramp.Base = profile
    work.job.Proxy.addOperation(ramp, profile, True)
    ramp.Proxy.setup(ramp)
    write(work)


def several(name, order, split):
    """Two fixtures, three tools, coolant, an inactive operation and labels beyond ASCII."""
    work = Work(name)
    work.job.Fixtures = ["G54", "G55"]
    work.job.OrderOutputBy = order
    work.job.SplitOutput = split
    drill = work.tool("Bohrer ø5", "drill.fcstd", 5, 2)
    large = work.tool("Mill 8", "endmill.fcstd", 8, 3)
    work.operation(PathMillFace, "Plan", TOP, large, CoolantMode="Flood")
    work.operation(PathPocketShape, "Tasche größer", POCKET_FLOOR, CoolantMode="Flood")
    work.operation(PathDrilling, "Bohren", SMALL_HOLES, drill, PeckEnabled=True)
    work.operation(PathProfile, "not wanted", Active=False)
    work.operation(PathHelix, "Helix", LARGE_HOLE, large)
    work.document.saveAs(os.path.join(FOLDER, name + ".FCStd"))
    write(work)


def patterns():
    """Answer the ways in which this FreeCAD clears a pocket."""
    work = Work("patterns")
    found = work.operation(PathPocketShape, "pocket", POCKET_FLOOR)
    found = found.getEnumerationsOfProperty("OffsetPattern")
    work.close()
    return found


def shipped():
    """Write the jobs of FreeCAD's own package; a document that holds only a solid gets one."""
    tests = os.path.join(FreeCAD.getHomePath(), "Mod/Path/PathTests")
    for file in ("boxtest.fcstd", "Drilling_1.FCStd", "test_holes00.fcstd"):
        document = FreeCAD.open(os.path.join(tests, file))
        name = os.path.splitext(file)[0]
        jobs = [obj for obj in document.Objects if hasattr(obj, "PostProcessorOutputFile")]
        if not jobs:
            shapes = [obj for obj in document.Objects if getattr(obj, "Shape", None)]
            job = PathJob.Create("Job", [[obj for obj in shapes if obj.Shape.Solids][-1]])
            Work.settle(job.Tools.Group[0], 1500, 1, 150, 60)
            PathDrilling.Create("Drilling")
            PathProfile.Create("Profile")
            document.recompute()
            jobs = [job]
        for job in jobs:
            called = name if len(jobs) == 1 else f"{name}-{job.Name}"
            save(called, PathPost.CommandPathPost.buildPostList(None, job)[0])
            if not job.Tools.Group[0].HorizFeed:
                # This one comes without feeds and speeds.
                Work.settle(job.Tools.Group[0], 1500, 1, 150, 60)
                document.recompute()
                save(called + "-fed", PathPost.CommandPathPost.buildPostList(None, job)[0])
        FreeCAD.closeDocument(document.Name)


def main():
    os.makedirs(FOLDER, exist_ok=True)
    single("profile", PathProfile)
    single("profile-inside", PathProfile, faces=POCKET_FLOOR, Side="Inside", Direction="CCW")
    single("face", PathMillFace, faces=TOP)
    single("helix", PathHelix, faces=LARGE_HOLE, StepDown=3)
    single(
        "adaptive",
        PathAdaptive,
        faces=POCKET_FLOOR,
        FinalDepth=12,
        StartDepth=20,
        UseHelixArcs=True,
    )
    single("mist", PathProfile, CoolantMode="Mist")
    for pattern in patterns():
        single(
            "pocket-" + pattern,
            PathPocketShape,
            faces=POCKET_FLOOR,
            OffsetPattern=pattern,
            StepOver=50,
        )
    drilling("drill")
    drilling("drill-dwell", DwellEnabled=True, DwellTime=0.5)
    drilling("drill-peck", PeckEnabled=True, PeckDepth=3)
    drilling("drill-G99", ReturnLevel="G99")
    engraving()
    tags()
    ramps()
    for order in ("Fixture", "Tool", "Operation"):
        several("several-" + order, order, False)
        several("split-" + order, order, True)
    shipped()


run(main)
