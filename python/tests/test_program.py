"""Programs: read from files, as sequences and as arrays."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import toolpost
from conftest import EXAMPLES
from toolpost import Kind


def goto_lines(name: str) -> tuple[list[int], np.ndarray]:
    """Find the lines of an APT file that say GOTO, and their numbers."""
    lines, numbers, axis = [], [], [0.0, 0.0, 1.0]
    for number, line in enumerate((EXAMPLES / name).read_text().splitlines(), 1):
        if line.startswith("GOTO/"):
            values = [float(value) for value in re.findall(r"-?[\d.]+", line)]
            axis = values[3:] or axis
            lines.append(number)
            numbers.append(values[:3] + axis)
    return lines, np.array(numbers)


def test_positions_axes_and_lines_are_those_of_the_file(dome):
    lines, numbers = goto_lines("dome.cls")
    assert dome.lines.tolist() == lines
    np.testing.assert_array_equal(dome.positions, numbers[:, :3])
    # The file has seven decimals.
    np.testing.assert_allclose(dome.axes, numbers[:, 3:], atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(dome.axes, axis=1), 1, atol=1e-12)


def test_a_feed_holds_until_the_next_and_a_rapid_has_none(plate):
    # plate.cls: facing at 600, the way down into the pocket at 300, then 450.
    feeds = dict(zip(plate.lines.tolist(), plate.feeds.tolist()))
    assert np.isnan(feeds[11])
    assert (feeds[15], feeds[35], feeds[43]) == (600, 300, 450)
    rapids = plate.kinds == Kind.RAPID
    assert np.isnan(plate.feeds[rapids]).all()
    # The last three holes are tapped, at mm a turn.
    assert np.isnan(plate.feeds[~rapids]).tolist() == [False] * 20 + [True] * 3


def test_kinds_and_records_lead_to_the_record_of_a_move(plate):
    names = {kind: kind.name.lower() for kind in Kind}
    for row, index in enumerate(plate.records.tolist()):
        record = plate[index]
        assert record.kind == names[Kind(plate.kinds[row])]
        assert record.line == plate.lines[row]
        assert record.point == tuple(plate.positions[row])
    counts = plate.statistics()
    assert counts["holes"] == (plate.kinds == Kind.HOLE).sum()
    assert counts["arcs"] == (plate.kinds == Kind.ARC).sum()


def test_arrays_are_the_same_memory_each_time_and_read_only(dome):
    for name in ["positions", "axes", "feeds", "lines", "kinds", "records"]:
        array = getattr(dome, name)
        assert np.shares_memory(array, getattr(dome, name))
        assert array.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.setflags(write=True)


def test_arrays_outlive_the_program():
    positions = toolpost.read(EXAMPLES / "plate.cls").positions
    junk = [np.full_like(positions, np.nan) for _ in range(100)]
    assert positions[0].tolist() == [-25, 18, 50]
    assert len(junk) == 100


def test_a_program_is_a_sequence_of_records(plate):
    records = list(plate)
    assert len(records) == len(plate)
    assert records[-1].kind == plate[-1].kind == "end"
    assert [record.line for record in plate[2:9:3]] == [records[i].line for i in (2, 5, 8)]
    assert [record.kind for record in plate[::-1]] == [record.kind for record in records][::-1]
    for beyond in [len(plate), -len(plate) - 1]:
        with pytest.raises(IndexError, match="records"):
            plate[beyond]


def test_records_say_what_the_file_says(plate):
    said = {record.kind: record for record in reversed(plate)}
    # LOADTL/1, CUTTER/40,0; SPINDL/1200,RPM,CLW; CIRCLE/60,40,0,0,0,1,8 and GOTO/68,40,-3.
    assert (said["tool"].words["number"], said["tool"].words["diameter"]) == (1, 40)
    assert said["spindle"].words == {"speed": 1200, "clockwise": True}
    assert said["arc"].words == {"center": (60, 40, 0), "normal": (0, 0, 1), "turns": 0}
    assert said["arc"].point == (68, 40, -3)
    assert "Record(line=" in repr(said["arc"])


def test_an_nc_program_needs_its_control():
    with pytest.raises(toolpost.Error) as caught:
        toolpost.read(EXAMPLES / "flange.nc")
    assert caught.value.rule == "source"
    program = toolpost.read(EXAMPLES / "flange.nc", "fanuc-31i")
    assert program.dialect == toolpost.read(EXAMPLES / "flange.nc", control="fanuc-31i").dialect
    assert (program.kinds == Kind.ARC).any()


def test_what_the_operator_has_set_up_is_said_by_keywords(tmp_path):
    nc = tmp_path / "part.nc"
    nc.write_text("G90 G0 X10 Y0 Z5\n/G1 Z0 F100\nG1 X20 F200\nM30\n")
    with pytest.raises(toolpost.Error) as caught:
        toolpost.read(nc, "fanuc-31i", units="mm")
    assert (caught.value.file, caught.value.line) == ("part.nc", 1)
    read = toolpost.read(nc, "fanuc-31i", units="inch", whole_numbers="units", block_delete=True)
    np.testing.assert_allclose(read.positions, [[254, 0, 127], [508, 0, 127]])


def test_a_program_draws_itself(plate):
    svg = plate._repr_svg_()
    assert svg == plate.svg()
    assert ET.fromstring(svg).tag == "{http://www.w3.org/2000/svg}svg"
    assert "plate.cls" in svg
