"""Kinematics of machines, for arrays."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import toolpost
from conftest import FIVE_AXES

MACHINES = {name: toolpost.machine(name) for name in FIVE_AXES}

POSE = st.tuples(*[st.floats(-500, 500)] * 3, st.floats(0, math.radians(44)), st.floats(-3.2, 3.2))


@pytest.mark.parametrize("name", FIVE_AXES)
@given(poses=st.lists(POSE, min_size=1, max_size=20), length=st.floats(0, 300))
def test_forward_leads_back_to_where_inverse_came_from(name, poses, length):
    machine = MACHINES[name]
    x, y, z, tilt, around = np.array(poses).T
    points = np.column_stack([x, y, z])
    lean = np.sin(tilt)
    axes = np.column_stack([lean * np.cos(around), lean * np.sin(around), np.cos(tilt)])
    linear, rotary = machine.inverse(points, axes, length)
    assert linear.shape == (len(poses), 3)
    assert rotary.shape == (len(poses), 2)
    assert ((rotary > -180) & (rotary <= 180)).all()
    tips, directions = machine.forward(linear, rotary, length)
    # The tip is that of the rotary positions found; a lean below 1e-6 is taken for none.
    np.testing.assert_allclose(tips, points, rtol=0, atol=1e-9)
    np.testing.assert_allclose(directions, axes, rtol=0, atol=1e-6)


def test_a_table_turns_the_part_by_hand_calculation(tmp_path):
    # A trunnion about X, 50 mm below the work zero.
    file = tmp_path / "trunnion.toml"
    file.write_text(
        'extends = "generic-3axis-iso"\n'
        "work_zero = [0, 0, 0]\n"
        '[orientation]\nsimultaneous = "machine-angles"\n'
        "[[rotary]]\n"
        'letter = "A"\non = "table"\naxis = [1, 0, 0]\npoint = [0, 0, -50]\nsign = 1\n'
        "min = -90\nmax = 90\nrapid = 1000\nacceleration = 100\n"
    )
    machine = toolpost.machine(file)
    assert machine.rotary == ("A",)
    tips, axes = machine.forward([[0, 0, 0]], [[90]])
    # Turned right-handed about X by 90 degrees, what was along -Y of the part is along -Z of the
    # machine: the tool, along Z of the machine, is along Y of the part.
    np.testing.assert_allclose(axes, [[0, 1, 0]], atol=1e-12)
    # The machine's origin is 50 above the trunnion; turned back by 90 degrees it lies 50 to its +Y.
    np.testing.assert_allclose(tips, [[0, 50, -50]], atol=1e-12)
    linear, rotary = machine.inverse(tips, axes)
    np.testing.assert_allclose(linear, [[0, 0, 0]], atol=1e-9)
    np.testing.assert_allclose(rotary, [[90]], atol=1e-6)


def test_a_machine_without_rotary_axes_has_no_columns_for_them():
    machine = toolpost.machine("generic-3axis-linuxcnc")
    linear, rotary = machine.inverse([[1, 2, 3]], [[0, 0, 5]])
    assert linear.tolist() == [[1, 2, 3]]
    assert rotary.shape == (1, 0)
    tips, axes = machine.forward(linear, rotary)
    assert (tips.tolist(), axes.tolist()) == ([[1, 2, 3]], [[0, 0, 1]])


def test_no_poses_are_fine():
    linear, rotary = MACHINES[FIVE_AXES[0]].inverse(np.empty((0, 3)), np.empty((0, 3)))
    assert linear.shape == (0, 3)
    assert rotary.shape == (0, 2)


@pytest.mark.parametrize("kind", [np.float32, np.int64, list])
def test_any_array_of_numbers_is_taken_also_a_view_of_every_second_row(kind):
    machine = MACHINES[FIVE_AXES[0]]
    points, axes = [[1, 2, 3], [4, 5, 6], [7, 8, 9]], [[0, 0, 1]] * 3
    if kind is list:
        linear, _ = machine.inverse(points, axes)
    else:
        linear, _ = machine.inverse(np.array(points, kind), np.array(axes, kind))
    wanted = machine.inverse(np.array(points, float)[::2], np.array(axes, float)[::2])[0]
    np.testing.assert_array_equal(linear[::2], wanted)


@pytest.mark.parametrize(
    ("rule", "points", "axes", "said"),
    [
        ("zero-vector", [[0, 0, 0]] * 2, [[0, 0, 1], [0, 0, 0]], "row 1"),
        ("number", [[0, math.nan, 0]], [[0, 0, 1]], "row 0"),
        ("array-shape", [[0, 0]], [[0, 0, 1]], "2 columns"),
        ("array-shape", [[0, 0, 0]], [[0, 0, 1]] * 2, "1 rows"),
    ],
)
def test_what_makes_no_pose_is_refused_with_its_row(rule, points, axes, said):
    with pytest.raises(toolpost.Error, match=said) as caught:
        MACHINES[FIVE_AXES[0]].inverse(points, axes)
    assert caught.value.rule == rule


def test_an_orientation_out_of_reach_is_reported_with_its_distance():
    with pytest.raises(toolpost.Error, match=r"row 0.*45\.0000 degrees") as caught:
        toolpost.machine("generic-3axis-iso").inverse([[0, 0, 0]], [[0, 1, 1]])
    assert caught.value.rule == "unreachable-orientation"


def test_a_tool_length_that_is_none_is_refused():
    with pytest.raises(toolpost.Error, match="tool_length is NaN"):
        MACHINES[FIVE_AXES[0]].inverse([[0, 0, 0]], [[0, 0, 1]], math.nan)
