"""Programs that are built."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import toolpost
from conftest import EXAMPLES
from toolpost import Kind, Program


def test_a_built_program_is_that_of_the_same_file():
    read = toolpost.read(EXAMPLES / "plate.cls")
    built = Program.builder()
    # The first operation of plate.cls, by hand.
    built.tool(1, diameter=40).spindle(1200).coolant("flood")
    built.rapid((-25, 18, 50)).rapid((-25, 18, 2)).feed(600)
    built.line((-25, 18, 0)).line((145, 18, 0)).rapid((145, 18, 2)).rapid((145, 52, 2))
    built.line((145, 52, 0)).line((-25, 52, 0)).rapid((-25, 52, 50))
    program = built.build()
    moves = len(program.positions)
    np.testing.assert_array_equal(program.positions, read.positions[:moves])
    np.testing.assert_array_equal(program.feeds, read.feeds[:moves])
    np.testing.assert_array_equal(program.kinds, read.kinds[:moves])


def test_a_program_for_linuxcnc_has_the_blocks_written_by_hand(slot):
    blocks = toolpost.post(slot, toolpost.machine("generic-3axis-linuxcnc")).text.splitlines()
    cuts = blocks.index("G1 Z-1 F500")
    assert blocks[cuts : cuts + 4] == ["G1 Z-1 F500", "X50", "G3 Y20 I0 J10", "G1 X0"]
    # Pecks of 3 mm from the R plane at 2 to the bottom at -12; G98 goes back to the level before.
    hole = blocks.index("Z10")
    assert blocks[hole + 1 : hole + 4] == ["G98 G83 X10 Y10 Z-12 R2 Q3 F100", "X20 Y10", "G80"]


def test_what_is_built_is_proven_on_every_mill(slot):
    mills = {machine.name: machine for machine in toolpost.library() if not machine.wire}
    with pytest.raises(toolpost.Error, match="coolant"):
        toolpost.post(slot, mills.pop("grbl-3018"))
    for name, machine in mills.items():
        assert toolpost.post(slot, machine).report.proven, name


def test_records_are_numbered_as_lines(slot):
    assert [record.line for record in slot] == list(range(1, len(slot) + 1))


def test_every_kind_of_hole_can_be_built():
    more = {
        "deep": {"peck": 2, "first_peck": 3},
        "break-chip": {"peck": 2},
        "tap": {"pitch": 1.5, "left": True},
        "fine-bore": {"aside": (0.5, 0, 0), "angle": 90},
        "back-bore": {"aside": (0, 2, 0)},
    }
    for kind in ["drill", "ream", "bore", *more]:
        words = {"depth": 9, "clearance": 2, "retract": 5, "dwell": 0.5, "feed": 80}
        words |= more.get(kind, {})
        program = Program.builder().drill([(1, 2, 3)], kind=kind, **words).build()
        said = program[0].words
        assert {**words, "cycle": kind, "unit": "mm/min"}.items() <= said.items()
        assert [record.kind for record in program] == ["cycle", "hole", "cycle-off", "end"]
        assert program.feeds.tolist() == [80]


def test_a_clockwise_arc_turns_about_the_other_side():
    start = Program.builder().rapid((10, 0, 0))
    arc = start.arc((0, 10, 0), (0, 0, 0), clockwise=True).build()[1]
    assert arc.words["normal"] == (0, 0, -1)


def test_a_program_goes_on_after_it_was_built():
    builder = Program.builder("a").rapid((1, 2, 3))
    first = builder.build()
    second = builder.line((4, 5, 6)).build()
    assert [record.kind for record in first] == ["rapid", "end"]
    assert [record.kind for record in second] == ["rapid", "line", "end"]


def test_a_tool_axis_holds_until_the_next():
    program = Program.builder().rapid((0, 0, 0), (0, 3, 4)).line((1, 0, 0)).build()
    np.testing.assert_allclose(program.axes, [[0, 0.6, 0.8]] * 2)


def test_every_word_of_a_program_can_be_built():
    program = (
        Program.builder("all")
        .operation("Walls")
        .comment("for who reads it")
        .message("for the screen")
        .work_offset(55)
        .tool(7, "BALL", diameter=6, corner_radius=3, length=120, offset=17)
        .spindle(800, clockwise=False)
        .feed(0.2, "mm/rev")
        .coolant("through")
        .compensation("left", 7)
        .compensation("off")
        .dwell(1.5)
        .stop()
        .stop(optional=True)
        .output(3, True)
        .output(1, 2.5, with_motion=True)
        .auxiliary(21)
        .spindle(0)
        .home()
        .build()
    )
    said = [(record.kind, record.words) for record in program]
    assert said == [
        ("operation", {"name": "Walls"}),
        ("comment", {"text": "for who reads it"}),
        ("message", {"text": "for the screen"}),
        ("work-offset", {"number": 55}),
        (
            "tool",
            {
                "number": 7,
                "name": "BALL",
                "diameter": 6,
                "corner_radius": 3,
                "length": 120,
                "offset": 17,
            },
        ),
        ("spindle", {"speed": 800, "clockwise": False}),
        ("feed", {"feed": 0.2, "unit": "mm/rev"}),
        ("coolant", {"coolant": "through"}),
        ("compensation", {"side": "left", "register": 7}),
        ("compensation", {"side": "off", "register": None}),
        ("dwell", {"seconds": 1.5}),
        ("stop", {}),
        ("optional-stop", {}),
        ("output", {"number": 3, "value": True, "with_motion": False}),
        ("output", {"number": 1, "value": 2.5, "with_motion": True}),
        ("auxiliary", {"number": 21, "values": [None, None]}),
        ("spindle", {"speed": 0, "clockwise": True}),
        ("home", {"axes": "Z"}),
        ("end", {}),
    ]


@pytest.mark.parametrize(
    ("rule", "wrong"),
    [
        ("number", lambda b: b.line((0, 0, math.nan))),
        ("number", lambda b: b.rapid((0, math.inf, 0))),
        ("zero-vector", lambda b: b.line((0, 0, 0), (0, 0, 0))),
        ("no-start", lambda b: b.arc((1, 0, 0), (0, 0, 0))),
        ("off-the-circle", lambda b: b.rapid((1, 0, 0)).arc((0, 2, 0), (0, 0, 0))),
        ("off-the-circle", lambda b: b.rapid((0, 0, 0)).arc((0, 0, 0), (0, 0, 0))),
        ("zero-vector", lambda b: b.rapid((1, 0, 0)).arc((0, 1, 0), (0, 0, 0), normal=(0, 0, 0))),
        ("no-start", lambda b: b.rapid((1, 0, 0)).home().arc((0, 1, 0), (0, 0, 0))),
        ("number", lambda b: b.rapid((1, 0, 0)).arc((1, 0, 0), (0, 0, 0), turns=20_000)),
        ("number", lambda b: b.feed(0)),
        ("number", lambda b: b.feed(-100)),
        ("argument", lambda b: b.feed(100, "inch/min")),
        ("number", lambda b: b.spindle(-1)),
        ("number", lambda b: b.tool(0)),
        ("number", lambda b: b.tool(1, diameter=-6)),
        ("number", lambda b: b.dwell(0)),
        ("argument", lambda b: b.coolant("beer")),
        ("argument", lambda b: b.compensation("up")),
        ("number", lambda b: b.drill([(0, 0, 0)], 0, clearance=1)),
        ("no-clear-plane", lambda b: b.drill([(0, 0, 0)], 5, clearance=-5)),
        ("no-clear-plane", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, retract=1)),
        ("peck", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, kind="deep")),
        ("peck", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, peck=1)),
        ("pitch", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, kind="tap")),
        ("pitch", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, pitch=1)),
        ("number", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, kind="tap", pitch=0)),
        ("aside", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, kind="fine-bore")),
        ("aside", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, aside=(1, 0, 0))),
        ("argument", lambda b: b.drill([(0, 0, 0)], 5, clearance=2, kind="punch")),
        ("number", lambda b: b.drill([(0, 0, math.nan)], 5, clearance=2)),
    ],
)
def test_what_no_program_can_say_is_refused_and_leaves_no_trace(rule, wrong):
    builder = Program.builder()
    with pytest.raises(toolpost.Error) as caught:
        wrong(builder)
    assert caught.value.rule == rule
    moved = ["rapid"] if len(builder.build()) > 1 else []
    kinds = [record.kind for record in builder.build()]
    assert kinds in (["end"], [*moved, "end"], [*moved, "home", "end"])


POINT = st.tuples(*[st.floats(-1e4, 1e4)] * 3)
MOVES = st.lists(st.tuples(st.sampled_from(["rapid", "line"]), POINT), max_size=40)


@given(MOVES)
def test_arrays_have_what_was_built(moves):
    builder = Program.builder()
    for kind, point in moves:
        getattr(builder, kind)(point)
    program = builder.build()
    assert program.positions.shape == (len(moves), 3)
    assert program.positions.tolist() == [list(point) for _, point in moves]
    assert [Kind(kind).name.lower() for kind in program.kinds] == [kind for kind, _ in moves]
    assert program.axes.tolist() == [[0, 0, 1]] * len(moves)


def contour(path=None):
    """Build a program with compensation around two walls."""
    built = Program.builder("walls").tool(1, diameter=6).spindle(5000).feed(300)
    built.rapid((0, -9, 5)).line((0, -9, -1)).compensation("left", path=path)
    built.line((0, 0, -1)).line((30, 0, -1)).compensation("off").line((30, -9, -1))
    return built.rapid((30, -9, 5)).build()


def test_who_builds_a_program_with_compensation_says_which_path_it_is():
    mill = toolpost.machine("generic-3axis-linuxcnc")
    assert "G41 D1" in toolpost.post(contour("contour"), mill).text
    assert "G41" not in toolpost.post(contour("centre"), mill).text
    with pytest.raises(toolpost.Error) as error:
        toolpost.post(contour(), mill)
    assert error.value.rule == "compensated-path"
    both = Program.builder("both").tool(1).compensation("left", path="centre")
    with pytest.raises(toolpost.Error):
        both.compensation("right", path="contour")


def test_which_path_cutcom_means_is_an_option_of_reading():
    plate = EXAMPLES / "plate.cls"
    assert toolpost.read(plate, cutcom="centre").name == toolpost.read(plate).name
    with pytest.raises(toolpost.Error) as error:
        toolpost.read(plate, cutcom="contour")
    assert (error.value.rule, error.value.line) == ("compensated-path", 47)


def test_two_tools_of_one_number_are_refused_when_the_program_is_posted():
    def job(second: float) -> Program:
        built = Program.builder("twice")
        for diameter in (10, second):
            built.tool(1, "MILL", diameter=diameter).spindle(2000).feed(300)
            built.rapid((0, 0, 50)).rapid((0, 0, 5)).line((0, 0, -1)).line((10, 0, -1))
            built.rapid((10, 0, 50))
        return built.build()

    machine = toolpost.machine("generic-3axis-fanuc")
    assert toolpost.post(job(10), machine).report.proven
    with pytest.raises(toolpost.Error) as caught:
        toolpost.post(job(6), machine)
    # The second tool is the ninth record.
    assert (caught.value.rule, caught.value.line) == ("tool-twice", 9)
