"""Toolpost itself, as FreeCAD reaches it: the Python package where FreeCAD's Python has it, otherwise the command.

Both give the same: programs as text, and reports as dictionaries, those that docs/proof.md describes.
"""

import json
import os
import shutil
import subprocess
import tempfile


class Refusal(Exception):
    """Why there is no proven program: messages for the report view."""

    def __init__(self, *messages):
        super().__init__("\n".join(messages))
        self.messages = messages


def spoken(finding):
    """A finding of a report as a message."""
    place = finding["file"]
    if finding["line"]:
        place += ":%d" % finding["line"]
    lines = ["%s: %s [%s]" % (place or finding["severity"], finding["message"], finding["rule"])]
    lines += finding["excerpt"].splitlines()
    if finding["help"]:
        lines.append("help: " + finding["help"])
    return "\n    ".join(lines)


def core():
    """What posts and proves here."""
    command = shutil.which("toolpost")
    if command is None:
        message = "Toolpost is not installed where FreeCAD finds it"
        help = "help: `pip install toolpost` with FreeCAD's Python, or put the command `toolpost` on the PATH"
        raise Refusal(message, help)
    return Command(command)


class Command:
    """The command `toolpost`, with files in a folder of its own."""

    def __init__(self, path):
        self.path = path

    def post(self, job, options):
        """The program of a job, and its report."""
        with tempfile.TemporaryDirectory(prefix="toolpost-") as folder:
            program = os.path.join(folder, "program.nc")
            changed = [word for option in options.option for word in ("--option", option)]
            words = [_written(folder, job), "--output", program, *changed, *_words(options)]
            report = self._run("post", *words)
            with open(program, encoding="utf-8", newline="") as file:
                return file.read(), report

    def prove(self, text, job, options):
        """The report of a program that was edited."""
        with tempfile.TemporaryDirectory(prefix="toolpost-") as folder:
            program = os.path.join(folder, "program.nc")
            with open(program, "w", encoding="utf-8", newline="") as file:
                file.write(text)
            words = [program, "--against", _written(folder, job), *_words(options)]
            return self._run("prove", *words)

    def _run(self, *words):
        # Windows would open a console for it.
        flags = getattr(subprocess, "CREATE_NO_WINDOW", 0)
        words = [self.path, "--json", *words]
        done = subprocess.run(
            words,
            capture_output=True,
            stdin=subprocess.DEVNULL,
            encoding="utf-8",
            creationflags=flags,
        )
        try:
            report = json.loads(done.stdout)
        except ValueError:
            raise Refusal("%s: %s" % (self.path, done.stderr.strip() or "no answer")) from None
        if report["status"] != "done":
            raise Refusal(*map(spoken, report["errors"]))
        return report


def _written(folder, job):
    path = os.path.join(folder, "job.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(job, file, ensure_ascii=False)
    return path


def _words(options):
    words = ["--machine", options.machine]
    if options.tolerance is not None:
        words += ["--tolerance", repr(options.tolerance)]
    return words
