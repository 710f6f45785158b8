"""The editor between posting and saving: FreeCAD's own, and a proof of what was edited."""

import difflib

import FreeCAD
from toolpost_core import PostError

# Characters of a program, or pairs of lines to compare: beyond it the user would wait for minutes.
LARGEST = 2_000_000


def edit(text, report, prove):
    """Show a program; answer it as it is to be saved, with its report, or None where it is not.

    What was changed goes through `prove`, which answers a report. What is not proven goes back to
    the editor, or is given up.
    """
    if len(text) > LARGEST:
        _say(f"the program is too long for the editor, {len(text)} characters")
        return text, report
    ending = "\r\n" if "\r\n" in text else "\n"
    original = edited = text.replace("\r\n", "\n")
    while True:
        edited = _shown(edited)
        if edited is None:
            return None
        if edited == original:
            return text, report
        for line in _difference(original.splitlines(), edited.splitlines()):
            _say(line)
        changed = edited.replace("\n", ending)
        try:
            return changed, prove(changed)
        except PostError as refusal:
            FreeCAD.Console.PrintError(f"toolpost: {refusal}\n")
            if not _again(refusal):
                return None


def _shown(text):
    """Answer the text as the user leaves it, or None."""
    try:
        from Path.Post.Utils import GCodeEditorDialog
    except ImportError:
        from PathScripts.PostUtils import GCodeEditorDialog
    dialog = GCodeEditorDialog()
    dialog.setWindowTitle("Toolpost")
    dialog.editor.setPlainText(text)
    return dialog.editor.toPlainText() if dialog.exec_() else None


def _again(refusal):
    """Answer whether the user wants to go on editing."""
    from PySide import QtGui

    box = QtGui.QMessageBox
    text = f"The edited program is not proven, and is not saved as it is.\n\n{refusal}"
    return box.warning(None, "Toolpost", text, box.Retry | box.Cancel, box.Retry) == box.Retry


def _difference(before, after, most=20):
    """Answer what was changed between two lists of lines, as lines for the report view."""
    same = 0
    while same < min(len(before), len(after)) and before[same] == after[same]:
        same += 1
    rest = min(len(before), len(after)) - same
    tail = 0
    while tail < rest and before[-1 - tail] == after[-1 - tail]:
        tail += 1
    before, after = before[same : len(before) - tail], after[same : len(after) - tail]
    if len(before) * len(after) > LARGEST:
        return [f"edited: {len(after)} lines from line {same + 1} on, in place of {len(before)}"]
    changes = [f"edited: {line}" for line in difflib.ndiff(before, after) if line[0] in "+-"]
    more = [f"edited: and {len(changes) - most} lines more"] if len(changes) > most else []
    return changes[:most] + more


def _say(text):
    FreeCAD.Console.PrintMessage(f"toolpost: {text}\n")
