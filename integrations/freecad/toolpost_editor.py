"""The editor between posting and saving: FreeCAD's own, and a proof of what was edited."""

import difflib

import FreeCAD

from toolpost_core import Refusal

# Beyond it Qt's editor takes minutes to open.
LARGEST = 2_000_000


def edit(text, prove):
    """Shows the program. Answers it as edited with the report of `prove`, which is none where nothing
    was changed; or None where the user does not want it.

    What is not proven goes back to the editor, or is given up.
    """
    if len(text) > LARGEST:
        FreeCAD.Console.PrintMessage(
            "toolpost: the program is too long for the editor, %d characters\n" % len(text)
        )
        return text, None
    ending = "\r\n" if "\r\n" in text else "\n"
    original = shown = text.replace("\r\n", "\n")
    while True:
        shown = _shown(shown)
        if shown is None:
            return None
        if shown == original:
            return text, None
        edited = shown.replace("\n", ending)
        for line in _difference(original, shown):
            FreeCAD.Console.PrintMessage("toolpost: %s\n" % line)
        try:
            report = prove(edited)
        except Refusal as refusal:
            FreeCAD.Console.PrintError("toolpost: %s\n" % refusal)
            if not _again(str(refusal)):
                return None
            continue
        FreeCAD.Console.PrintMessage("toolpost: the edited program is proven\n")
        return edited, report


def _shown(text):
    """The text as the user leaves it, or None."""
    try:
        from Path.Post.Utils import GCodeEditorDialog
    except ImportError:
        from PathScripts.PostUtils import GCodeEditorDialog
    dialog = GCodeEditorDialog()
    dialog.editor.setPlainText(text)
    return dialog.editor.toPlainText() if dialog.exec_() else None


def _again(message):
    """Whether the user wants to go on editing."""
    from PySide import QtGui

    box = QtGui.QMessageBox
    text = "The edited program is not proven, and is not saved as it is.\n\n" + message
    asked = box.warning(None, "Toolpost", text, box.Retry | box.Cancel, box.Retry)
    return asked == box.Retry


def _difference(before, after, most=20):
    """What was changed, in lines for the report view."""
    before, after = before.splitlines(), after.splitlines()
    same = 0
    while same < min(len(before), len(after)) and before[same] == after[same]:
        same += 1
    tail = 0
    while tail < min(len(before), len(after)) - same and before[-1 - tail] == after[-1 - tail]:
        tail += 1
    old, new = before[same : len(before) - tail], after[same : len(after) - tail]
    if max(len(old), len(new)) > 2000:
        return [
            "edited: lines %d to %d, %d in place of %d"
            % (same + 1, same + len(new), len(new), len(old))
        ]
    changes = [line for line in difflib.ndiff(old, new) if line[0] in "+-"]
    more = ["... and %d lines more" % (len(changes) - most)] if len(changes) > most else []
    return ["edited: " + line for line in changes[:most]] + more
