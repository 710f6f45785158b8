"""The command that the package installs, compared with the one without Python."""

from __future__ import annotations

import struct
import subprocess
import sys
import zlib

import pytest

import toolpost
from conftest import EXAMPLES
from toolpost import _command


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


def blocks(data: bytes) -> bytes:
    """Write a block as helpers read and write it, with its length and sum, and an end."""
    total = zlib.crc32(data)
    return struct.pack("<II", len(data), total) + data + struct.pack("<II", 0, total)


def test_the_helper_of_the_studio_does_a_step_without_the_package():
    name = f"{toolpost.__version__} region".encode()
    # The intersection of nothing with nothing.
    asked = blocks(bytes([len(name)]) + name + bytes([1, 1]) + bytes(8))
    with subprocess.Popen(
        _command.helper(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as helper:
        helper.stdin.write(asked)
        helper.stdin.flush()
        # No reason against it, and no islands.
        assert helper.stdout.read() == blocks(bytes(5))
        assert helper.wait() == 0
        assert helper.stderr.read() == b""
    for wrong in [b"", b"studio", asked[:-1], asked.replace(b"region", b"legion")]:
        done = subprocess.run(_command.helper(), input=wrong, capture_output=True, check=False)
        assert (done.returncode, done.stdout, done.stderr) == (1, b"", b"")
