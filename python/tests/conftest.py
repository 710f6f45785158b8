"""What the tests share: the project's folder, and parts to try things on."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

import toolpost

if TYPE_CHECKING:
    from collections.abc import Callable

# The seed (Makefile) decides what is drawn, not what has failed before; a machine may be slow.
settings.register_profile(
    "toolpost", settings.get_profile("default"), database=None, deadline=None, derandomize=False
)
settings.load_profile("toolpost")

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"

#: Machines of the library with two rotary axes: table and table, head and table.
FIVE_AXES = [machine.name for machine in toolpost.library() if len(machine.rotary) == 2]


def absent(why: str) -> None:
    """Skip the test whose judge is missing; with CI=true, which `.ci/run` sets, it fails."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"{why}; with CI=true every judge has to be there")
    pytest.skip(why)


def real(folder: str) -> Path:
    """Give a folder of the real input: of `TOOLPOST_DATA`, or of `../shared/data`."""
    path = Path(os.environ.get("TOOLPOST_DATA", ROOT.parent / "shared" / "data")) / folder
    if not path.is_dir():
        absent(f"there is no real input in {path} (TOOLPOST_DATA)")
    return path


@pytest.fixture(scope="session")
def dome() -> toolpost.Program:
    """Read the part with five axes."""
    return toolpost.read(EXAMPLES / "dome.cls")


@pytest.fixture(scope="session")
def plate() -> toolpost.Program:
    """Read the part with holes, arcs and compensation."""
    return toolpost.read(EXAMPLES / "plate.cls")


@pytest.fixture(scope="session")
def slot() -> toolpost.Program:
    """Build a slot with a round end and two holes."""
    return (
        toolpost.Program.builder("slot")
        .operation("Slot")
        .tool(1, "END MILL", diameter=10.0)
        .spindle(3000)
        .feed(500)
        .coolant("flood")
        .rapid((0, 0, 30))
        .rapid((0, 0, 2))
        .line((0, 0, -1))
        .line((50, 0, -1))
        .arc((50, 20, -1), (50, 10, -1))
        .line((0, 20, -1))
        .rapid((0, 20, 30))
        .tool(2, "DRILL", diameter=5)
        .spindle(1000)
        .feed(100)
        .rapid((10, 10, 30))
        .drill([(10, 10, 0), (20, 10, 0)], 12, clearance=2, retract=10, kind="deep", peck=3)
        .rapid((20, 10, 30))
        .build()
    )


@pytest.fixture(scope="session")
def native() -> Path:
    """Build the command without Python."""
    cargo = ["cargo", "build", "--locked", "--bin", "toolpost", "--message-format", "json"]
    done = subprocess.run(cargo, cwd=ROOT, check=True, capture_output=True, text=True)
    found = re.findall(r'"executable":"([^"]+)"', done.stdout)
    return Path(found[-1])


@pytest.fixture(scope="session")
def installed() -> Path:
    """Give the command that the package has put in place."""
    return Path(sys.executable).with_name("toolpost.exe" if os.name == "nt" else "toolpost")


@pytest.fixture(scope="session")
def run() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Give the way to run a command."""

    def run(*words: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(words, capture_output=True, text=True, check=False)

    return run
