"""The post-processor `toolpost` of FreeCAD's CAM workbench: a job in, a proven program out.

FreeCAD calls `export` once for each file of a job. Up to 0.21 it names the file, and the post
writes it; later it gives "-", and writes what `export` answers, or nothing where that is None.
"""

import argparse
import json
import os
import shlex

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
    files = {}
    if options.report:
        files[options.report] = json.dumps(report, indent=2, ensure_ascii=False) + "\n"
    if filename != "-":
        files[filename] = text
    _save(files)
    return text


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
    FreeCAD.Console.PrintMessage(f"toolpost: {text}\n")


def _error(text):
    FreeCAD.Console.PrintError(f"toolpost: {text}\n")


def _save(files):
    """Write each file beside its place, then move all of them there: none is ever half there."""
    beside = {path: f"{path}.{os.getpid()}.part" for path in files}
    try:
        for path, text in files.items():
            with open(beside[path], "x", encoding="utf-8", newline="") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
        for path in files:
            os.replace(beside[path], path)
    except OSError as error:
        raise PostError(f"{path} cannot be saved: {error.strerror}") from None
    finally:
        for written in filter(os.path.exists, beside.values()):
            os.remove(written)
