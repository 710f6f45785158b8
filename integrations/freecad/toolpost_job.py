"""A FreeCAD job as one JSON document, which is what Toolpost reads (docs/sources/freecad.md).

`job` takes the objects that FreeCAD hands to a post-processor. As a program it takes a document:

    TOOLPOST_FCSTD=part.FCStd TOOLPOST_JSON=part.json freecadcmd toolpost_job.py

What a command means, and whether it can be done, is not judged here.
"""

import json
import os
import re
import struct
import zipfile
import zlib
from xml.etree import ElementTree

COOLANT = {"Flood": "flood", "Mist": "mist"}

OFFSET = re.compile(r"^G5(?:[4-8]|9(?:\.[1-9])?)$", re.MULTILINE)


class JobError(Exception):
    """What cannot be exported of a job, with the way out."""


def job(objects, name):
    """Answer the job that these objects make, as a dictionary that JSON can hold."""
    parts = [part for obj in objects for part in _parts(obj)]
    controllers = {}
    for part in parts:
        controller = part if hasattr(part, "ToolNumber") else _property(part, "ToolController")
        if controller is not None:
            controllers.setdefault(controller.Name, controller)
    stock = _stock(objects)
    return {
        "toolpost": "freecad-job",
        "version": 1,
        "name": storable(name),
        **({"stock": stock} if stock else {}),
        "tools": [_tool(controller) for controller in controllers.values()],
        "operations": [_operation(part) for part in parts],
    }


def _stock(objects):
    """Answer the box around the stock of the job of these objects, where there is one."""
    groups = [group for obj in objects for group in getattr(obj, "InList", [])]
    owners = [owner for group in groups for owner in (group, *getattr(group, "InList", []))]
    for owner in owners:
        box = getattr(getattr(getattr(owner, "Stock", None), "Shape", None), "BoundBox", None)
        if hasattr(owner, "PostProcessorOutputFile") and box is not None and box.isValid():
            return {
                "low": [box.XMin, box.YMin, box.ZMin],
                "high": [box.XMax, box.YMax, box.ZMax],
            }
    return None


def storable(label):
    """Answer a label with a question mark for each surrogate, which no file can hold."""
    if label.isascii():
        return label
    return label.encode("utf-8", "replace").decode("utf-8")


def move(job, offset):
    """Put a job at another work offset than the one that it has."""
    if not OFFSET.fullmatch(offset):
        raise JobError(f"{offset} is no work offset: one of G54 to G59, G59.1 to G59.9")
    texts = [operation["commands"] for operation in job["operations"]]
    offsets = ", ".join(sorted({offset for text in texts for offset in OFFSET.findall(text)}))
    if not offsets:
        raise JobError(
            f"no operation calls the work offset of the job, and {offset} cannot take its place: "
            "choose it in the job, under Output"
        )
    if "," in offsets:
        raise JobError(f"another work offset is for a job with one, and this has {offsets}")
    for operation in job["operations"]:
        operation["commands"] = OFFSET.sub(offset, operation["commands"])


def document(path):
    """Answer the job of the document at `path`."""
    import FreeCAD

    paths = _saved(path)
    opened = FreeCAD.open(path)
    _see_that_all_is_restored(opened, paths)
    jobs = [obj for obj in opened.Objects if hasattr(obj, "PostProcessorOutputFile")]
    if len(jobs) != 1:
        labels = ", ".join(found.Label for found in jobs)
        raise JobError(f"the document has {len(jobs)} jobs, and one is needed: {labels}")
    posted = [obj for objects in lists(jobs[0]) for obj in objects]
    return job(posted, jobs[0].Label)


# What Python's readers of archives raise where one is damaged.
DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    RuntimeError,
    ValueError,
    KeyError,
    ElementTree.ParseError,
)


def _saved(path):
    """Answer the text of each path in a document, by object and property.

    FreeCAD restores what it can of a damaged document, and says nothing of the rest.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            damaged = archive.testzip()
            if damaged is not None:
                raise _damaged(damaged)
            root = ElementTree.fromstring(archive.read("Document.xml"))
            # An `XLink` names another document.
            named = {found.get("file") for found in root.iter() if found.tag != "XLink"}
            missing = named - {None, "", *archive.namelist()}
            if missing:
                raise _damaged(f"{min(missing)} is missing")
            return {
                (found.get("name"), kept.get("name")): archive.read(file.get("file")).decode()
                for found in root.iterfind("ObjectData/Object")
                for kept in found.iterfind("Properties/Property")
                for file in kept.iterfind("Path[@file]")
            }
    except DAMAGE as error:
        raise _damaged(error) from None


def _see_that_all_is_restored(opened, paths):
    """Refuse a document of whose paths FreeCAD has not restored every command."""
    import Path

    for (name, kept), text in paths.items():
        restored, path = getattr(opened.getObject(name), kept, None), Path.Path()
        try:
            path.setFromGCode(text)
        except RuntimeError:
            restored = None
        # A text that ends within a line has lost its rest.
        if restored is None or restored.Size != path.Size or text[-1:] not in ("", "\n"):
            raise _damaged(f"the path of {name} is not whole")


def _damaged(what):
    return JobError(f"the document is damaged ({what}): save it again in FreeCAD")


def lists(job):
    """Answer the lists of objects that FreeCAD hands to a post-processor, one for each file."""
    operations = [
        found for found in job.Operations.Group if _property(found, "Active") is not False
    ]
    fixtures = [Fixture(name, job) for name in job.Fixtures]
    if job.OrderOutputBy == "Fixture":
        parts = [([fixture], operations) for fixture in fixtures]
    elif job.OrderOutputBy == "Tool":
        parts = [(fixtures, run) for run in _runs(operations)]
    else:
        parts = [(fixtures, [operation]) for operation in operations]
    return [_with_tools(*part) for part in parts]


class Fixture:
    """A work offset as an object with commands: the offset, and up to the clearance height."""

    def __init__(self, name, job):
        import Path

        clearance = job.Stock.Shape.BoundBox.ZMax + job.SetupSheet.ClearanceHeightOffset.Value
        self.Name = self.Label = name
        self.Path = Path.Path([Path.Command(name), Path.Command("G0", {"Z": clearance})])


def _runs(operations):
    """Answer the operations in runs with the same tool."""
    runs, number = [], None
    for operation in operations:
        controller = _property(operation, "ToolController")
        if not runs or (controller is not None and number not in (None, controller.ToolNumber)):
            runs.append([])
        if controller is not None:
            number = controller.ToolNumber
        runs[-1].append(operation)
    return runs


def _with_tools(fixtures, operations):
    """Answer the operations at each fixture, with a tool controller wherever it changes."""
    objects, at_work = [], None
    for fixture in fixtures:
        objects.append(fixture)
        for operation in operations:
            controller = _property(operation, "ToolController")
            if controller not in (None, at_work):
                objects.append(controller)
                at_work = controller
            objects.append(operation)
    return objects


def _parts(obj):
    """Answer the objects with commands of their own: groups opened, in their order."""
    if hasattr(obj, "Group"):
        for child in obj.Group:
            yield from _parts(child)
    elif hasattr(obj, "Path"):
        yield obj


def _operation(part):
    path = _placed(part)
    operation = {
        "label": storable(part.Label),
        "count": path.Size,
        "commands": storable(_commands(path)),
    }
    controller = _property(part, "ToolController")
    if controller is not None:
        operation["tool"] = controller.ToolNumber
    coolant = COOLANT.get(_property(part, "CoolantMode"))
    if coolant:
        operation["coolant"] = coolant
    if _property(part, "Active") is False:
        operation["active"] = False
    # FreeCAD has not been able to recompute it: its path is empty, or an old one.
    if "Invalid" in getattr(part, "State", ()):
        operation["invalid"] = True
    return operation


def _commands(path):
    """Answer the commands of a path, one a line, also those comments that have a line break."""
    text = path.toGCode()
    if "(" not in text or text.count("\n") == path.Size:
        return text
    return "".join(" ".join(command.toGCode().split("\n")) + "\n" for command in path.Commands)


def _placed(part):
    """Answer the path where the object's placement puts it."""
    placement = getattr(part, "Placement", None)
    if placement is None or placement.isIdentity():
        return part.Path
    try:
        from PathScripts.PathUtils import getPathWithPlacement
    except ImportError:
        raise JobError(
            f"{part.Label} is moved by its Placement, which FreeCAD 0.20 shows and does not post: "
            "set it to zero, and move the model or the work offset"
        ) from None
    return getPathWithPlacement(part)


def _tool(controller):
    tool = {"number": controller.ToolNumber, "name": storable(controller.Label)}
    bit = getattr(controller, "Tool", None)
    for name in ("Diameter", "Length"):
        value = getattr(bit, name, None)
        if value is not None:
            tool[name.lower()] = float(getattr(value, "Value", value))
    # "endmill.fcstd", in FreeCAD 1.1 "Endmill": each tool controller may have a copy of its bit.
    shape = getattr(bit, "BitShape", None) or getattr(bit, "ShapeType", None)
    if shape:
        tool["shape"] = storable(os.path.splitext(os.path.basename(shape))[0].lower())
    feed = getattr(controller, "HorizFeed", None)
    if feed is not None:
        # mm/s
        tool["horizontal_feed"] = float(getattr(feed, "Value", feed))
    return tool


def _property(obj, name):
    """Answer a property of an operation, or of the one that a dressup stands on."""
    while obj is not None and not hasattr(obj, name):
        obj = getattr(obj, "Base", None)
    return getattr(obj, name, None)


def main(path, target):
    """Write the job of a document to a file; what is wrong is the last line that is printed."""
    code = 1
    try:
        text = json.dumps(document(path), ensure_ascii=False)
        with open(target, "w", encoding="utf-8") as file:
            file.write(text)
        code = 0
    except (JobError, OSError) as error:
        # FreeCAD has not ended the line of its progress.
        print(f"\n{error}", flush=True)
    # FreeCAD would go on to its console.
    os._exit(code)


if "TOOLPOST_FCSTD" in os.environ:
    main(os.environ["TOOLPOST_FCSTD"], os.environ["TOOLPOST_JSON"])
