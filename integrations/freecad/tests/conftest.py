"""FreeCAD without a window, run once for all tests that need what it makes."""

import functools
import json
import os
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ADDON = HERE.parent
# Where `make python` puts the package.
PACKAGE = HERE.parents[2] / "python"
# Seconds after which FreeCAD is ended.
LONGEST = 300
# The version of Debian 12. From 0.21 on the modules are called otherwise (`Path.Main.Job`).
KNOWN = "0.20"


def pytest_configure():
    """See that there is a Toolpost to be tested."""
    if shutil.which("toolpost") is None:
        pytest.exit("the command toolpost is not on the PATH: build and install it first", 1)


def run(command, home, code=0, **environment):
    """Run FreeCAD, whose settings are in a folder of their own, and answer what it printed.

    Whatever ends the wait ends all that was started: `xvfb-run` leaves its screen and FreeCAD.
    """
    environment = {name: str(value) for name, value in environment.items()}
    process = subprocess.Popen(
        list(map(str, command)),
        env={**os.environ, "FREECAD_USER_HOME": str(home), **environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
        start_new_session=True,
    )
    try:
        said, _ = process.communicate(timeout=LONGEST)
    except BaseException:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        raise
    assert process.returncode == code, said
    return said


@functools.cache
def missing():
    """Answer why FreeCAD cannot be tested here, or None."""
    if shutil.which("freecadcmd") is None:
        return "FreeCAD (Debian package freecad) is not installed"
    with tempfile.TemporaryDirectory() as home:
        version = run(["freecadcmd", HERE / "version.py"], home).split()[-1]
    if version != KNOWN:
        return f"the scripts build jobs with the modules of FreeCAD {KNOWN}, and this is {version}"
    return None


def absent(why):
    """Skip the test whose judge is missing; with CI=true, which `.ci/run` sets, it fails."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"{why}; with CI=true every judge has to be there (`scripts/setup`)")
    pytest.skip(why)


def freecad(script, home, code=0, **environment):
    """Run a script inside FreeCAD without its window."""
    if missing():
        absent(missing())
    return run(["freecadcmd", HERE / script], home, code, **environment)


def toolpost(*words):
    """Run the command and answer what it says."""
    words = ["toolpost", "--json", *map(str, words)]
    done = subprocess.run(words, capture_output=True, encoding="utf-8", check=False)
    return json.loads(done.stdout)


@pytest.fixture(scope="session")
def jobs(tmp_path_factory):
    """Make the folder with the jobs, and with FreeCAD's own programs next to them."""
    folder = tmp_path_factory.mktemp("jobs")
    freecad("build_jobs.py", tmp_path_factory.mktemp("home"), TOOLPOST_JOBS=folder)
    return folder


@pytest.fixture(scope="session", params=["command", "package"])
def cases(request, tmp_path_factory):
    """Post jobs right and wrong: for each case what is answered, saved and said."""
    folder = tmp_path_factory.mktemp("cases")
    way = {"TOOLPOST_CASES": folder, "TOOLPOST_LONG": 1_000_000}
    if request.param == "package":
        way = {**way, "TOOLPOST_LONG": 10_000, "PYTHONPATH": PACKAGE}
    freecad("posting.py", tmp_path_factory.mktemp("home"), **way)
    found = json.loads((folder / "cases.json").read_text())
    for name, case in found["cases"].items():
        case["said"] = (folder / f"{name}.said").read_text()
        case["saved"] = Path(case["file"]).read_text() if Path(case["file"]).is_file() else None
    assert found["core"] == request.param.title()
    found["long"] = way["TOOLPOST_LONG"]
    left = [path.name for path in folder.iterdir() if ".part" in path.name]
    assert not left, "half-written files"
    return found
