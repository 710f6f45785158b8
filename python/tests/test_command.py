"""The command that the package installs, compared with the one without Python."""

from __future__ import annotations

import subprocess
import sys

import pytest

from conftest import EXAMPLES


@pytest.mark.parametrize(
    "words",
    [
        ["--version"],
        ["--help"],
        ["machines", "list"],
        ["machines", "list", "--json"],
        ["explain", "arc_tolerance"],
        ["show", EXAMPLES / "plate.cls"],
        ["show", EXAMPLES / "nothing.cls"],
        ["post", EXAMPLES / "plate.cls"],
        ["wrong"],
        [],
        ["prove", EXAMPLES / "flange.nc", "-m", "nothing", "--against", EXAMPLES / "plate.cls"],
    ],
)
def test_both_commands_say_the_same(native, installed, run, words):
    one, other = run(native, *words), run(installed, *words)
    assert other.returncode == one.returncode
    assert other.stdout == one.stdout
    assert other.stderr == one.stderr


def test_the_codes_of_the_end_are_those_that_the_help_names(installed, run, tmp_path):
    out = tmp_path / "a.ngc"
    post = ["post", EXAMPLES / "dome.cls", "-o", out, "-m"]
    assert run(installed, *post, "generic-3axis-linuxcnc").returncode == 1
    assert run(installed, *post, "nothing").returncode == 2
    assert not out.exists()
    assert run(installed, *post, "dmu50-heidenhain").returncode == 0
    assert out.exists()


def test_the_package_is_the_command_too(installed, run):
    module = subprocess.run(
        [sys.executable, "-m", "toolpost", "--version"], capture_output=True, text=True, check=True
    )
    assert module.stdout == run(installed, "--version").stdout


def test_the_reader_of_the_output_may_leave(installed):
    with subprocess.Popen([installed, "explain"], stdout=subprocess.PIPE) as command:
        command.stdout.close()
        assert command.wait() == 0
