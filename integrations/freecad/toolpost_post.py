"""The post-processor `toolpost` of FreeCAD's CAM workbench: a job in, a proven program out.

FreeCAD calls `export` once for each file of a job. Up to 0.21 it names the file, and the post
writes it; later it gives "-", and writes what `export` answers, or nothing where that is None.
"""

import argparse
import contextlib
import json
import os
import shlex
import shutil
import tempfile

import FreeCAD
import toolpost_editor
import toolpost_job
from toolpost_core import PostError, core, spoken

TOOLTIP = """Writes the program of a job for a machine of Toolpost's library, or one of your own,
and proves it: a virtual control reads the program back, and one that does not do what the job says
is not saved. The machine is named in the arguments, such as --machine emco-concept-mill-105"""


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise PostError(
            f"the arguments of the post: {message}; it knows these\n{self.format_help()}"
        )


def _option(text):
    name, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text} is no NAME=VALUE")
    return name, value


parser = _Parser(prog="toolpost", usage=argparse.SUPPRESS, add_help=False, allow_abbrev=False)
argument = parser.add_argument
argument(
    "--machine", metavar="NAME|FILE", required=True, help="name in the library, or a .toml file"
)
argument(
    "--option",
    metavar="NAME=VALUE",
    type=_option,
    action="append",
    default=[],
    help="another value for one of the options of the machine; may be given several times",
)
argument("--work-offset", metavar="G54", help="work offset in place of the one that the job has")
argument(
    "--tolerance", metavar="MM", type=float, help="largest distance of the tool tip from the path"
)
argument("--report", metavar="FILE", help="save the report of the proof here, as JSON")
argument("--no-show-editor", action="store_true", help="save without showing the program first")

TOOLTIP_ARGS = parser.format_help()


def export(objectslist, filename, argstring):
    """Post these objects to a file; where that is "-", only answer the program.

    The answer is None where there is no proven program, or where the user did not want it: no file
    is touched then, and the report view says why.
    """
    try:
        return _export(objectslist, filename, argstring)
    except (PostError, toolpost_job.JobError) as refusal:
        _error(refusal)
    except Exception as mistake:
        _error(f"a mistake in the post, please report it: {type(mistake).__name__}: {mistake}")
    _error("nothing was saved")
    return None


def _export(objectslist, filename, argstring):
    try:
        options = parser.parse_args(shlex.split(argstring or ""))
    except ValueError as error:
        raise PostError(f"the arguments of the post: {error}") from None
    targets = _targets(filename, options.report)
    job = toolpost_job.job(objectslist, _name(objectslist, filename))
    if options.work_offset:
        toolpost_job.move(job, options.work_offset)
    toolpost = core()
    text, report = toolpost.post(job, options)
    _tell(job, options, report)
    if FreeCAD.GuiUp and not options.no_show_editor:
        edited = toolpost_editor.edit(
            text, report, lambda text: {**report, **toolpost.prove(text, job, options)}
        )
        if edited is None:
            _message("cancelled, nothing was saved")
            return None
        text, report = edited
    texts = {
        "report": json.dumps(report, indent=2, ensure_ascii=False) + "\n",
        "program": text,
    }
    _save({path: texts[what] for what, path in targets.items()})
    return text


def _targets(filename, report):
    """Answer where the report and the program are to be saved, as far as they are."""
    named = {"report": report, "program": None if filename == "-" else filename}
    # A file that a link leads to is written where it is.
    targets = {what: os.path.realpath(path) for what, path in named.items() if path}
    for path in targets.values():
        if os.path.exists(path) and not os.path.isfile(path):
            raise PostError(f"{path} is no ordinary file: choose another name")
    if len(set(map(os.path.normcase, targets.values()))) < len(targets):
        raise PostError(
            f"{report} would be both report and program: choose another name after --report"
        )
    return targets


def _name(objectslist, filename):
    """Answer what the program is called: as its file is, or as the job."""
    if filename != "-":
        return os.path.splitext(os.path.basename(filename))[0]
    for obj in objectslist:
        for group in getattr(obj, "InList", []):
            for job in [group, *group.InList]:
                if hasattr(job, "PostProcessorOutputFile"):
                    return job.Label
    return "job"


def _tell(job, options, report):
    for warning in report["warnings"]:
        FreeCAD.Console.PrintWarning(f"toolpost: {spoken(warning)}\n")
    blocks = report["program"]["blocks"]
    off = report["proof"]["deviations"]["tip_mm"]["value"]
    _message(
        f"{job['name']} for {options.machine}: {blocks} blocks, proven; "
        f"the tool tip is off by at most {off:.5f} mm"
    )


def _message(text):
    FreeCAD.Console.PrintMessage(f"toolpost: {toolpost_job.storable(str(text))}\n")


def _error(text):
    FreeCAD.Console.PrintError(f"toolpost: {toolpost_job.storable(str(text))}\n")


def _save(files):
    """Write each file under a temporary name in its folder, then rename all, or none at all."""
    try:
        with contextlib.ExitStack() as made, contextlib.ExitStack() as undo:
            ready = {}
            for path, text in files.items():
                ready[path] = _beside(path, made)
                with open(ready[path], "w", encoding="utf-8", newline="") as file:
                    file.write(text)
                    file.flush()
                    os.fsync(file.fileno())
            # When the last one is in place, nothing is left that could fail.
            for path in list(files)[:-1]:
                if os.path.exists(path):
                    earlier = _beside(path, made)
                    shutil.copy2(path, earlier)
                    undo.callback(os.replace, earlier, path)
                else:
                    undo.callback(_remove, path)
                os.replace(ready[path], path)
            for path in list(files)[-1:]:
                os.replace(ready[path], path)
            undo.pop_all()
    except OSError as error:
        raise PostError(f"{path} cannot be saved: {error.strerror}") from None


def _beside(path, made):
    """Make an empty file in the folder of another and with its rights, and note it as made."""
    handle, name = tempfile.mkstemp(".part", ".toolpost-", os.path.dirname(path))
    made.callback(_remove, name)
    os.close(handle)
    # Some disks know no rights.
    with contextlib.suppress(OSError):
        if os.path.exists(path):
            shutil.copymode(path, name)
        else:
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(name, 0o666 & ~mask)
    return name


def _remove(name):
    with contextlib.suppress(FileNotFoundError):
        os.remove(name)
