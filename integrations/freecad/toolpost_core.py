"""Toolpost itself, as FreeCAD reaches it: its Python package, or else its command.

Programs are text, reports are dictionaries: what the command answers with `--json`.
"""

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
        return result.text, result.report.data()

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
        machine = self.package.machine(options.machine, **dict(options.option))
        text = json.dumps(job, ensure_ascii=False)
        return self.read_job(text, machine, file=f"{_stem(job)}.json"), machine


class Command:
    """The command `toolpost`, which gets its files in a folder of their own."""

    def __init__(self, path):
        self.path = path

    def post(self, job, options):
        """Answer the program of a job, and its report."""
        with _Folder(job) as folder:
            program = folder.path("nc")
            changed = [f"--option={name}={value}" for name, value in options.option]
            words = [folder.job, "--output", program, *changed, *_words(options)]
            report = self._run("post", words)
            with open(program, encoding="utf-8", newline="") as file:
                return file.read(), report

    def prove(self, text, job, options):
        """Answer the report of a program that was edited."""
        with _Folder(job) as folder:
            program = folder.path("nc")
            with open(program, "w", encoding="utf-8", newline="") as file:
                file.write(text)
            return self._run("prove", [program, "--against", folder.job, *_words(options)])

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


class _Folder(tempfile.TemporaryDirectory):
    """A folder with a job in it, for as long as it is needed."""

    def __init__(self, job):
        super().__init__(prefix="toolpost-")
        self.stem = _stem(job)
        self.job = self.path("json")
        with open(self.job, "w", encoding="utf-8") as file:
            file.write(json.dumps(job, ensure_ascii=False))

    def __enter__(self):
        return self

    def path(self, ending):
        """Answer where the file with this ending is."""
        return os.path.join(self.name, f"{self.stem}.{ending}")


def _stem(job):
    """Answer what the files of a job are called: what is said of them names them so."""
    return re.sub(r"[^\w.-]", "_", job["name"])


def _words(options):
    tolerance = [] if options.tolerance is None else ["--tolerance", repr(options.tolerance)]
    return ["--machine", options.machine, *tolerance]
