"""Runs inside FreeCAD's window: posts a job by the command of the menu, as a user does.

    TOOLPOST_WINDOW=folder xvfb-run freecad window.py

The folder gets pictures of the window, and `window.json` with what came of each posting.
"""

import json
import os
import sys

import FreeCADGui
from PathScripts import PathDrilling, PathJobGui, PathPocketShape, PathPreferences, PathProfile
from PySide import QtCore, QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from work import POCKET_FLOOR, SMALL_HOLES, Work, run

FOLDER = os.environ["TOOLPOST_WINDOW"]
PROGRAM = os.path.join(FOLDER, "block.mpf")


def picture(name):
    """Save what the screen shows."""
    for _ in range(20):
        QtGui.QApplication.processEvents()
    screen = QtGui.QApplication.primaryScreen()
    screen.grabWindow(0).save(os.path.join(FOLDER, name + ".png"))


def arrange():
    """Show the panels that a user has: the tree or a task at the left, an empty report below."""
    window = FreeCADGui.getMainWindow()
    panels = {panel.objectName(): panel for panel in window.findChildren(QtGui.QDockWidget)}
    panels["Python console"].hide()
    panels["Report view"].show()
    panels["Report view"].findChild(QtGui.QTextEdit).clear()
    window.resizeDocks([panels["Combo View"]], [380], QtCore.Qt.Horizontal)
    window.resizeDocks([panels["Report view"]], [150], QtCore.Qt.Vertical)


def post(job, *answers, program=PROGRAM):
    """Post the job; each dialog on the way gets one of the answers, and one too many is left."""
    answers = list(answers)
    shown = []
    unexpected = []

    def answer():
        dialog = QtGui.QApplication.activeModalWidget()
        if dialog is not None and answers:
            editor = dialog.findChild(QtGui.QTextEdit)
            shown.append(editor.toPlainText() if editor else dialog.text())
            answers.pop(0)(dialog)
        elif dialog is not None:
            unexpected.append(dialog.windowTitle())
            dialog.reject()

    timer = QtCore.QTimer()
    timer.timeout.connect(answer)
    timer.start(200)
    if os.path.exists(program):
        os.remove(program)
    job.PostProcessorOutputFile = program
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(job)
    FreeCADGui.runCommand("Path_Post")
    timer.stop()
    saved = None
    if os.path.exists(program):
        with open(program, encoding="utf-8") as file:
            saved = file.read()
    return {"shown": shown, "saved": saved, "left": len(answers), "unexpected": unexpected}


def accept(dialog):
    """Take the program as it is."""
    dialog.accept()


def cancel(dialog):
    """Give up."""
    dialog.reject()


def look(dialog):
    """Take a picture of the editor, and the program as it is."""
    dialog.resize(500, 420)
    dialog.move(560, 160)
    picture("freecad-editor")
    dialog.accept()


def change(before, after):
    """Make an answer that edits the program."""

    def edit(dialog):
        editor = dialog.editor
        editor.setPlainText(editor.toPlainText().replace(before, after, 1))
        dialog.accept()

    return edit


def main():
    """Build a job, choose the post, and post the job in each way that the editor allows."""
    window = FreeCADGui.getMainWindow()
    window.showMaximized()
    work = Work("block")
    drill = work.tool("Drill 5", "drill.fcstd", 5, 2)
    work.operation(PathProfile, "Contour")
    work.operation(PathPocketShape, "Pocket", POCKET_FLOOR, CoolantMode="Flood")
    work.operation(PathDrilling, "Holes", SMALL_HOLES, drill, PeckEnabled=True)
    job = work.job
    offered = PathPreferences.allAvailablePostProcessors()
    job.PostProcessor = offered
    job.PostProcessor = "toolpost"
    job.PostProcessorArgs = "--machine emco-concept-mill-105"
    job.PostProcessorOutputFile = PROGRAM
    work.document.recompute()
    show(work)
    arrange()
    choose(job)
    found = {
        "offered": offered,
        "as it is": post(job, look),
        "comment": post(job, change("M30", "; ready\nM30")),
        "moved": post(job, change("X102.5", "X102.6"), cancel),
        "moved and put right": post(
            job, change("X102.5", "X102.6"), again, change("X102.6", "X102.5")
        ),
        "cancelled": post(job, cancel),
    }
    job.PostProcessorArgs = "--machine kuka-kr6-r900"
    found["robot"] = post(job, accept, program=os.path.join(FOLDER, "block.src"))
    with open(os.path.join(FOLDER, "window.json"), "w", encoding="utf-8") as file:
        json.dump(found, file)


def show(work):
    """Give what was made without the window its look: paths and part, neither stock nor tools."""
    job = work.job
    job.ViewObject.Proxy = PathJobGui.ViewProvider(job.ViewObject)
    job.ViewObject.addExtension("Gui::ViewProviderGroupExtensionPython")
    job.ViewObject.Proxy.deleteOnReject = False
    for operation in job.Operations.Group:
        operation.ViewObject.Proxy = 0
        operation.ViewObject.Visibility = True
    for obj in work.document.Objects:
        if obj == job.Stock or hasattr(obj, "BitShape"):
            obj.ViewObject.Visibility = False
    view = FreeCADGui.ActiveDocument.ActiveView
    view.viewIsometric()
    view.fitAll()


def choose(job):
    """Take a picture of the job's panel, where the post is chosen."""
    FreeCADGui.ActiveDocument.setEdit(job.Name)
    form = job.ViewObject.Proxy.taskPanel.form
    tabs = form.findChild(QtGui.QTabWidget) or form
    for index in range(tabs.count()):
        if tabs.tabText(index) == "Output":
            tabs.setCurrentIndex(index)
    picture("freecad-job")
    job.ViewObject.Proxy.taskPanel.accept()


def again(dialog):
    """Go back to the editor."""
    picture("freecad-not-proven")
    dialog.button(QtGui.QMessageBox.Retry).click()


QtCore.QTimer.singleShot(500, lambda: run(main))
