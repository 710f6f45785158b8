"""Toolpost itself, as FreeCAD reaches it: its Python package, or else its command.

Programs are text, reports are dictionaries: what the command answers with `--json`.
"""

import contextlib
import inspect
import json
import os
import re
import shutil
import subprocess
import tempfile


class PostError(Exception):
    """Why there is no proven program, as a message for the report view."""


def core():
    """Find what posts and proves here."""
    try:
        import toolpost

        return Package(toolpost, toolpost.read_job)
    # A folder of that name imports too, and has nothing in it.
    except (ImportError, AttributeError):
        command = shutil.which("toolpost")
    if command is None:
        raise PostError(
            "Toolpost is not installed where FreeCAD finds it\n"
            "    help: install it for the Python of FreeCAD, or so that its command is on the PATH"
        )
    return Command(command)


def _whole(text, report):
    """Answer a program and its report, where it is one file: FreeCAD saves no more."""
    parts = report["program"].get("parts", [])
    if parts:
        raise PostError(
            "the program is larger than a file of the controller may be: "
            f"it has {len(parts)} parts\n"
            "    help: post fewer operations at a time, or post the job by the command `toolpost`"
        )
    return text, report


class Package:
    """The Python package `toolpost`."""

    def __init__(self, package, read_job):
        self.package = package
        self.read_job = read_job

    def post(self, job, options):
        """Answer the program of a job, and its report."""
        try:
            program, machine = self._read(job, options)
            result = self.package.post(program, machine, tolerance=options.tolerance)
        except self.package.Error as error:
            raise _refusal(error.findings) from None
        return _whole(result.text, result.report.data())

    def prove(self, text, job, options):
        """Answer the report of a program that was edited."""
        file = f"{_stem(job)}.nc"
        try:
            program, machine = self._read(job, options)
            report = self.package.prove(
                text, machine, program, file=file, tolerance=options.tolerance
            )
        except self.package.Error as error:
            raise _refusal(error.findings) from None
        if not report.proven:
            raise _refusal(report.findings)
        return report.data()

    def _read(self, job, options):
        machine = self._machine(options.machine, dict(options.option))
        return self.read_job(job, machine, file=f"{_stem(job)}.json"), machine

    def _machine(self, name, changed):
        try:
            inspect.signature(self.package.machine).bind(name, **changed)
        except TypeError as error:
            # The function has a parameter of that name already.
            raise PostError(f"--option: the machine has no option of that name: {error}") from None
        return self.package.machine(name, **changed)


class Command:
    """The command `toolpost`, which gets its files in a folder of their own."""

    def __init__(self, path):
        self.path = path

    def post(self, job, options):
        """Answer the program of a job, and its report."""
        with _folder(job) as file:
            changed = [f"--option={name}={value}" for name, value in options.option]
            words = [file("json"), "--output", file("nc"), *changed, *_words(options)]
            report = self._run("post", words)
            with open(file("nc"), encoding="utf-8", newline="") as program:
                return _whole(program.read(), report)

    def prove(self, text, job, options):
        """Answer the report of a program that was edited."""
        with _folder(job) as file:
            with open(file("nc"), "w", encoding="utf-8", newline="") as program:
                program.write(text)
            return self._run("prove", [file("nc"), "--against", file("json"), *_words(options)])

    def _run(self, what, words):
        done = subprocess.run(
            [self.path, "--json", what, *words],
            check=False,
            capture_output=True,
            stdin=subprocess.DEVNULL,
            encoding="utf-8",
            # Windows would open a console for it.
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        try:
            report = json.loads(done.stdout)
        except ValueError:
            raise PostError(f"{self.path}: {done.stderr.strip() or 'no answer'}") from None
        if report["status"] != "done":
            raise PostError("\n".join(map(spoken, report["errors"])))
        return report


def _refusal(findings):
    findings = [finding._asdict() for finding in findings]
    errors = [finding for finding in findings if finding["severity"] == "error"]
    return PostError("\n".join(map(spoken, errors)))


def spoken(finding):
    """Answer a finding of a report as a message."""
    place = finding["file"] + (f":{finding['line']}" if finding["line"] else "")
    lines = [f"{place or finding['severity']}: {finding['message']} [{finding['rule']}]"]
    lines += finding["excerpt"].splitlines()
    if finding["help"]:
        lines.append("help: " + finding["help"])
    return "\n    ".join(lines)


@contextlib.contextmanager
def _folder(job):
    """Make a folder with a job in it; answer what tells where the file with an ending is there."""
    try:
        with tempfile.TemporaryDirectory(prefix="toolpost-") as folder:

            def file(ending):
                return os.path.join(folder, f"{_stem(job)}.{ending}")

            with open(file("json"), "w", encoding="utf-8") as written:
                written.write(json.dumps(job))
            yield file
    except OSError as error:
        raise PostError(f"the folder for temporary files, or the command: {error}") from None


def _stem(job):
    """Answer what the files of a job are called: what is said of them names them so."""
    return re.sub(r"[^\w.-]", "_", job["name"])


def _words(options):
    tolerance = [] if options.tolerance is None else ["--tolerance", repr(options.tolerance)]
    return ["--machine", options.machine, *tolerance]
