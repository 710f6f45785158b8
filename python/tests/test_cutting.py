"""Wires and boards, without the command."""

from __future__ import annotations

import json

import pytest

import toolpost
from conftest import EXAMPLES, ROOT

SECTOR = EXAMPLES / "sector.nc"


def sector(**more):
    settings = {
        "side": "inside",
        "wire": 0.25,
        "gap": 0.02,
        "leave": [0.03],
        "thread": [(15, 15)],
        "round_corners": True,
        "feed": [0.1, 0.2],
    }
    machine = toolpost.machine("bp-95d")
    return toolpost.wire(SECTOR, machine, "fanuc-31i", **{**settings, **more})


def test_the_program_of_a_wire_and_its_report_are_those_of_the_command(native, tmp_path, run):
    out = tmp_path / "sector.pts"
    words = "--side inside --wire 0.25 --gap 0.02 --leave 0.03 --thread 15,15 --round-corners"
    words = [*words.split(), "--feed", "0.1,0.2", "--from", "fanuc-31i", "-m", "bp-95d"]
    run(native, "wire", SECTOR, *words, "-o", out)
    result = sector()
    assert result.data == out.read_bytes()
    assert result.data == (ROOT / "machines/samples/bp-95d.pts").read_bytes()
    assert result.report.json == out.with_name("sector.pts.report.json").read_text()
    assert result.report.data()["instructions"]
    result.save(tmp_path / "again.pts")
    assert (tmp_path / "again.pts").read_bytes() == result.data
    with pytest.raises(toolpost.Error, match="it is the input"):
        result.save(SECTOR)


@pytest.mark.parametrize(
    ("more", "rule"),
    [
        ({"wire": float("nan")}, "setting"),
        ({"leave": [-1]}, "setting"),
        ({"side": None}, "setting"),
        ({"by_control": True, "tab": 2.0}, "setting"),
        ({"side": "above"}, "argument"),
        ({"step": 0.1, "fit": True}, "setting"),
        ({"sync": "length"}, "setting"),
        ({"rounding": "constant"}, "setting"),
        ({"layers": ["0"]}, "origin"),
        ({"close": 0.1}, "origin"),
        ({"wire": 60}, "offset-vanishes"),
        ({"feed": [1, 2, 3]}, "feed"),
    ],
)
def test_a_wire_that_cannot_be_cut_raises(more, rule):
    with pytest.raises(toolpost.Error) as caught:
        sector(**more)
    assert caught.value.rule == rule, caught.value
    assert caught.value.help


def lamp(**more):
    machine = toolpost.machine("grbl-3018")
    return toolpost.pcb(EXAMPLES / "lamp.toml", machine, **{"tool": 0.3, **more})


def test_the_programs_of_a_board_are_those_of_the_command(native, tmp_path, run):
    command, own = tmp_path / "command", tmp_path / "own"
    words = ["-m", "grbl-3018", "--tool", "0.3", "--passes", "2", "-o", command]
    run(native, "pcb", EXAMPLES / "lamp.toml", *words)
    made = lamp(passes=2, picture="svg")
    made.save(own)
    names = sorted(file.name for file in command.iterdir())
    assert sorted(file.name for file in own.iterdir()) == names
    files = [name for name in names if name != "report.json"]
    assert all((own / name).read_bytes() == (command / name).read_bytes() for name in files)
    # The words that were typed are the command's alone.
    typed, built = (json.loads((at / "report.json").read_text()) for at in (command, own))
    assert typed.pop("options") == ["--tool=0.3", "--passes=2"]
    assert built.pop("options") == []
    assert built == typed
    assert list(made.programs) == ["front", "drill", "back", "outline"]
    assert made.report.proven
    assert json.loads(made.files["report.json"]) == made.report.data()


def test_the_options_of_the_command_are_keywords(native, tmp_path, run):
    words = "--tool 0.8,0.3 --isolation-width 0.5 --hole-mill 1 --mill-holes-over 1.2"
    words += " --tab-at 0,5 --rectangular --board-margin 1 --rotate 90 --spin-up 3"
    words += " --text-before (clamp)@M0 --unit mm"
    run(native, "pcb", EXAMPLES / "lamp.toml", "-m", "grbl-3018", *words.split(), "-o", tmp_path)
    made = lamp(
        tool=[0.8, 0.3],
        isolation_width=0.5,
        hole_mill=1,
        mill_holes_over=1.2,
        tab_at=[(0, 5)],
        rectangular=True,
        board_margin=1,
        rotate=90,
        spin_up=3,
        text_before=["(clamp)", "M0"],
        unit="mm",
    )
    for name, program in made.programs.items():
        assert program == (tmp_path / f"{name}.gcode").read_bytes(), name
    with pytest.raises(toolpost.Error) as caught:
        lamp(isolation_width=1, passes=2)
    assert "passes" in str(caught.value)
    assert b"G3" in lamp(invert=True, only=["front"]).programs["front"]


def test_a_board_that_was_built_needs_no_file():
    built = toolpost.Board.builder("pads")
    for node, x in ("a", 5), ("b", 15):
        built.node(node, (x, 5)).pad(node, "circle", 2).hole(node, 0.8)
    board = built.edge([(0, 0), (20, 0), (20, 10), (0, 10)]).build()
    made = toolpost.pcb(board, toolpost.machine("linuxcnc-mill"), vee=30, only=["front", "drill"])
    assert list(made.programs) == ["front", "drill"]
    assert b"G81" in made.programs["drill"]


def test_what_cannot_be_made_of_a_board_is_left_out_and_the_rest_is_made():
    made = lamp(tool=9)
    assert made.left_out == ("front",)
    assert list(made.programs) == ["drill", "back", "outline"]
    assert {str(found.rule) for found in made.report.findings} >= {"tool-too-wide"}
    assert [left["name"] for left in made.report.data()["left_out"]] == ["front"]


@pytest.mark.parametrize(
    ("more", "rule"),
    [
        ({"tool": 0}, "setting"),
        ({"overlap": 1.5}, "setting"),
        ({"vee": 30}, "setting"),
        ({"tip": 0.2}, "setting"),
        ({"margin": 1.0}, "setting"),
        ({"spacing": 5.0}, "setting"),
        ({"on_control": True}, "setting"),
        ({"probe": (2, 2), "on_control": True, "heights": "z.txt"}, "setting"),
        ({"corner": (0, float("inf"))}, "setting"),
        ({"panel": (0, 1)}, "setting"),
        ({"passes": 1000}, "setting"),
        ({"only": ["lid"]}, "argument"),
        ({"tool": None}, "no-tool"),
        ({"travel": 0.1}, "travel-height"),
        ({"tool": 9, "strict": True}, "tool-too-wide"),
    ],
)
def test_a_board_that_cannot_be_made_raises(more, rule):
    with pytest.raises(toolpost.Error) as caught:
        lamp(**more)
    assert caught.value.rule == rule, caught.value
    assert caught.value.help
