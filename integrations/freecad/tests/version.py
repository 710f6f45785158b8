"""Runs inside `freecadcmd`: which FreeCAD it is, as the last line that is printed."""

import os

import FreeCAD

print("\n" + ".".join(FreeCAD.Version()[:2]), flush=True)
os._exit(0)
