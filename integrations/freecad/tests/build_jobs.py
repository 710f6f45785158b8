"""Runs inside `freecadcmd`: builds solids and jobs with FreeCAD's own operations, and writes each job as JSON.

    TOOLPOST_JOBS=folder freecadcmd build_jobs.py

Beside each job `NAME.json` lies `NAME.ngc`, what FreeCAD's own `linuxcnc_post` makes of the same objects.
"""

import json
import os
import sys

import FreeCAD
import Part
import Path
from FreeCAD import Vector

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))

import toolpost_job

import PathScripts.PathAdaptive as PathAdaptive
import PathScripts.PathCustom as PathCustom
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
import PathScripts.PathToolBit as PathToolBit
import PathScripts.PathToolController as PathToolController
from PathScripts.post import linuxcnc_post

FOLDER = os.environ["TOOLPOST_JOBS"]

# Faces of `block`, in the order in which FreeCAD numbers them.
SMALL_HOLES = ["Face11", "Face12", "Face13", "Face14"]
LARGE_HOLE = ["Face15"]
POCKET_FLOOR = ["Face16"]
TOP = ["Face3"]


def block(document):
    """100 x 80 x 20 mm with a pocket 40 x 30 x 8, four holes of 5 mm and one of 20 mm through."""
    solid = Part.makeBox(100, 80, 20)
    solid = solid.cut(Part.makeBox(40, 30, 8, Vector(10, 10, 12)))
    for x in (70, 90):
        for y in (15, 35):
            solid = solid.cut(Part.makeCylinder(2.5, 20, Vector(x, y, 0)))
    solid = solid.cut(Part.makeCylinder(10, 20, Vector(75, 60, 0)))
    part = document.addObject("Part::Feature", "Block")
    part.Shape = solid
    document.recompute()
    return part


class Bench:
    """One document with the block on it, a job, and its tools."""

    def __init__(self, name):
        self.name = name
        self.document = FreeCAD.newDocument(name)
        self.job = PathJob.Create("Job", [block(self.document)])
        self.model = self.job.Model.Group[0]
        self.mill = self.job.Tools.Group[0]
        self.mill.Label = "Mill 5"
        self.settle(self.mill, 2000, 1, 200, 100)

    @staticmethod
    def settle(controller, speed, number, horizontal, vertical):
        """Spindle speed in rpm, feeds in mm/min."""
        controller.ToolNumber = number
        controller.SpindleSpeed = speed
        controller.HorizFeed = "%s mm/min" % horizontal
        controller.VertFeed = "%s mm/min" % vertical

    def tool(self, label, shape, diameter, number, speed=3000, horizontal=300, vertical=90):
        bit = PathToolBit.Factory.Create(label, os.path.join(FreeCAD.getHomePath(), "Mod/Path/Tools/Shape", shape))
        bit.Diameter = diameter
        controller = PathToolController.Create(label, bit, number)
        self.settle(controller, speed, number, horizontal, vertical)
        self.job.Proxy.addToolController(controller)
        return controller

    def operation(self, module, label, faces=None, tool=None, **properties):
        # Without a window FreeCAD cannot ask which tool is meant, and fails where there are several.
        tools = self.job.Tools.Group
        self.job.Tools.Group = [tool or self.mill]
        operation = module.Create(label)
        self.job.Tools.Group = tools
        operation.Label = label
        operation.ToolController = tool or self.mill
        if faces is not None:
            operation.Base = [(self.model, faces)]
        for name, value in properties.items():
            operation.setExpression(name, None)
            setattr(operation, name, value)
        self.document.recompute()
        return operation

    def objects(self):
        """What FreeCAD hands to a post-processor, one list for each file."""
        self.document.recompute()
        return PathPost.CommandPathPost.buildPostList(None, self.job)

    def write(self):
        for index, objects in enumerate(self.objects()):
            name = self.name + ("-%d" % (index + 1) if self.job.SplitOutput else "")
            save(name, objects)
        FreeCAD.closeDocument(self.document.Name)


def save(name, objects):
    path = os.path.join(FOLDER, name)
    job = toolpost_job.job(objects, name)
    with open(path + ".json", "w", encoding="utf-8") as file:
        json.dump(job, file, ensure_ascii=False, indent=1)
    linuxcnc_post.export(objects, path + ".ngc", "--no-show-editor --no-header --precision 5")
    moves = sum(operation["commands"].count("\n") for operation in job["operations"])
    print("%s: %d operations, %d commands" % (name, len(job["operations"]), moves))


def single(name, module, **properties):
    bench = Bench(name)
    bench.operation(module, name, **properties)
    bench.write()


def drilling(name, **properties):
    bench = Bench(name)
    drill = bench.tool("Drill 5", "drill.fcstd", 5, 2)
    bench.operation(PathDrilling, name, SMALL_HOLES, drill, **properties)
    bench.write()


def engraving():
    bench = Bench("engrave")
    wire = bench.document.addObject("Part::Feature", "Wire")
    line = Part.makePolygon([Vector(20, 50, 20), Vector(40, 50, 20), Vector(40, 70, 20)])
    arc = Part.Arc(Vector(40, 70, 20), Vector(30, 75, 20), Vector(20, 70, 20)).toShape()
    wire.Shape = Part.Wire(line.Edges + [arc])
    bench.job.Model.addObject(wire)
    bench.operation(PathEngrave, "engrave", BaseShapes=[wire], StartDepth=20, FinalDepth=19.5)
    bench.write()


def tags():
    bench = Bench("tags")
    profile = bench.operation(PathProfile, "profile")
    dressup = PathDressupHoldingTags.Create(profile, "tags")
    # In the window the dressup takes the place of its base.
    bench.job.Operations.Group = [dressup]
    bench.write()


def ramps():
    bench = Bench("ramps")
    profile = bench.operation(PathProfile, "profile")
    ramp = bench.document.addObject("Path::FeaturePython", "RampEntryDressup")
    PathDressupRampEntry.ObjectDressup(ramp)
    ramp.Base = profile
    bench.job.Proxy.addOperation(ramp, profile, True)
    ramp.Proxy.setup(ramp)
    bench.write()


def several(name, order, split):
    """Two fixtures, three tools, coolant, an inactive operation and labels beyond ASCII."""
    bench = Bench(name)
    bench.job.Fixtures = ["G54", "G55"]
    bench.job.OrderOutputBy = order
    bench.job.SplitOutput = split
    drill = bench.tool("Bohrer ø5", "drill.fcstd", 5, 2)
    large = bench.tool("Mill 8", "endmill.fcstd", 8, 3)
    bench.operation(PathMillFace, "Plan", TOP, large, CoolantMode="Flood")
    bench.operation(PathPocketShape, "Tasche größer", POCKET_FLOOR, CoolantMode="Mist")
    bench.operation(PathDrilling, "Bohren", SMALL_HOLES, drill, PeckEnabled=True)
    bench.operation(PathProfile, "not wanted", Active=False)
    bench.operation(PathHelix, "Helix", LARGE_HOLE, large)
    bench.write()


def shipped():
    """The jobs of FreeCAD's own package; where a document holds no job, one is made on its solid."""
    tests = os.path.join(FreeCAD.getHomePath(), "Mod/Path/PathTests")
    for file in ("boxtest.fcstd", "Drilling_1.FCStd", "test_holes00.fcstd"):
        document = FreeCAD.open(os.path.join(tests, file))
        name = os.path.splitext(file)[0]
        jobs = [obj for obj in document.Objects if hasattr(obj, "PostProcessorOutputFile")]
        if not jobs:
            solid = [obj for obj in document.Objects if getattr(obj, "Shape", None) and obj.Shape.Solids][-1]
            job = PathJob.Create("Job", [solid])
            Bench.settle(job.Tools.Group[0], 1500, 1, 150, 60)
            PathDrilling.Create("Drilling")
            PathProfile.Create("Profile")
            jobs = [job]
        document.recompute()
        for number, job in enumerate(jobs, 1):
            for objects in PathPost.CommandPathPost.buildPostList(None, job):
                save(name if len(jobs) == 1 else "%s-%d" % (name, number), objects)
        FreeCAD.closeDocument(document.Name)


def main():
    os.makedirs(FOLDER, exist_ok=True)
    single("profile", PathProfile)
    single("profile-inside", PathProfile, faces=POCKET_FLOOR, Side="Inside", Direction="CCW")
    single("face", PathMillFace, faces=TOP)
    single("helix", PathHelix, faces=LARGE_HOLE, StepDown=3)
    single("adaptive", PathAdaptive, faces=POCKET_FLOOR, FinalDepth=12, StartDepth=20, UseHelixArcs=True)
    probe = Bench("patterns")
    patterns = probe.operation(PathPocketShape, "p", POCKET_FLOOR).getEnumerationsOfProperty("OffsetPattern")
    FreeCAD.closeDocument(probe.document.Name)
    for pattern in patterns:
        single("pocket-" + pattern, PathPocketShape, faces=POCKET_FLOOR, OffsetPattern=pattern, StepOver=50)
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


try:
    main()
except Exception:
    import traceback

    traceback.print_exc()
    os._exit(1)
