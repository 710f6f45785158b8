"""How the add-on reaches Toolpost, without FreeCAD."""

import argparse
import sys
import tempfile

import pytest
from conftest import ADDON

sys.path.insert(0, str(ADDON))

import toolpost_core

OPTIONS = argparse.Namespace(machine="mill", option=[], tolerance=None)


def test_without_a_temporary_folder_there_is_no_program(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
    with pytest.raises(toolpost_core.PostError, match="No such file or directory"):
        toolpost_core.Command("toolpost").post({"name": "part"}, OPTIONS)


def test_without_the_command_there_is_no_program(tmp_path):
    with pytest.raises(toolpost_core.PostError, match="No such file or directory"):
        toolpost_core.Command(str(tmp_path / "toolpost")).post({"name": "part"}, OPTIONS)
