"""A FreeCAD job as one JSON document: what Toolpost reads.

`job(objectslist)` takes the objects that FreeCAD hands to a post-processor, in their order, and gives
the interchange form that docs/sources/freecad.md describes. As a program it takes a document:

    TOOLPOST_FCSTD=part.FCStd TOOLPOST_JSON=part.json freecadcmd toolpost_job.py

Nothing is judged here: what a command means, and whether it can be done, is Toolpost's to say.
"""

COOLANT = {"Flood": "flood", "Mist": "mist"}


def job(objectslist, name=""):
    """The job that these objects make, as a dictionary that JSON can hold."""
    sections = [section for obj in objectslist for section in _paths(obj)]
    controllers = {}
    for obj in sections:
        controller = obj if hasattr(obj, "ToolNumber") else _property(obj, "ToolController")
        if controller is not None:
            controllers.setdefault(controller.Name, controller)
    return {
        "toolpost": "freecad-job",
        "version": 1,
        "name": name,
        "tools": [_tool(controller) for controller in controllers.values()],
        "operations": [_operation(obj) for obj in sections],
    }


def _paths(obj):
    """The objects with commands of their own: groups opened, in their order."""
    if not hasattr(obj, "Path") or hasattr(obj, "Group"):
        for child in getattr(obj, "Group", []):
            yield from _paths(child)
    else:
        yield obj


def _operation(obj):
    operation = {"label": obj.Label, "commands": obj.Path.toGCode()}
    controller = _property(obj, "ToolController")
    if controller is not None:
        operation["tool"] = controller.ToolNumber
    coolant = COOLANT.get(_property(obj, "CoolantMode"))
    if coolant:
        operation["coolant"] = coolant
    if _property(obj, "Active") is False:
        operation["active"] = False
    return operation


def _tool(controller):
    tool = {"number": controller.ToolNumber, "name": controller.Label}
    bit = getattr(controller, "Tool", None)
    for key, name in (("diameter", "Diameter"), ("length", "Length")):
        value = getattr(bit, name, None)
        if value is not None:
            tool[key] = float(getattr(value, "Value", value))
    return tool


def _property(obj, name):
    """A property of the operation, or of the one that a dressup stands on."""
    while obj is not None and not hasattr(obj, name):
        obj = getattr(obj, "Base", None)
        if isinstance(obj, (list, tuple)):
            return None
    return getattr(obj, name, None)
