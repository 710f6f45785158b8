"""What the scripts inside FreeCAD work with: a block, a job, tools, operations."""

import os
import traceback

import FreeCAD
import Part
import Path
import PathScripts.PathJob as PathJob
import PathScripts.PathPost as PathPost
import PathScripts.PathToolBit as PathToolBit
import PathScripts.PathToolController as PathToolController
from FreeCAD import Vector

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


class Work:
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
        controller.HorizFeed = f"{horizontal} mm/min"
        controller.VertFeed = f"{vertical} mm/min"

    def tool(self, label, shape, diameter, number, speed=3000, horizontal=300, vertical=90):
        bit = PathToolBit.Factory.Create(
            label, os.path.join(FreeCAD.getHomePath(), "Mod/Path/Tools/Shape", shape)
        )
        bit.Diameter = diameter
        controller = PathToolController.Create(label, bit, number)
        self.settle(controller, speed, number, horizontal, vertical)
        self.job.Proxy.addToolController(controller)
        return controller

    def operation(self, module, label, faces=None, tool=None, **properties):
        # Without a window FreeCAD cannot ask which tool is meant, and fails with several.
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
        """Answer what FreeCAD hands to a post-processor, one list for each file."""
        self.document.recompute()
        return PathPost.CommandPathPost.buildPostList(None, self.job)

    def close(self):
        FreeCAD.closeDocument(self.document.Name)


class Piece:
    """An object with commands, as FreeCAD's own for fixtures is."""

    def __init__(self, label, commands):
        self.Name = self.Label = label
        self.Path = Path.Path(commands)


def run(main):
    """Run a script and leave FreeCAD, which would go on to its console."""
    try:
        main()
    except BaseException:
        traceback.print_exc()
        os._exit(1)
    os._exit(0)
