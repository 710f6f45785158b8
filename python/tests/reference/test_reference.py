"""Programs of real files, examples and harsh jobs, judged by the reference."""

from __future__ import annotations

import os

import numpy as np
import pytest

import toolpost
from conftest import EXAMPLES, ROOT, real

from .cases import READERS, STATED, judge, reference, stated
from .cldata import read
from .control import FaultError
from .damage import DAMAGES, damaged
from .jobs import job
from .judge import touching
from .machine import library, load
from .sinumerik import Sinumerik, pole_passed

LONG = os.environ.get("TOOLPOST_JUDGES") == "long"
NAMES = sorted(READERS)
SAMPLE = ROOT / "machines" / "samples" / "five-axes.cls"
#: Files that take seconds each: with TOOLPOST_JUDGES=long only.
LARGE = [
    "Plane_2",
    "coremill",
    "Interface-glue",
    "SupPetriLED",
    "Teflon-gasket",
    "Top-light-cover",
    "basemach",
]
FILES = [
    "makino/Plane_1.cldata",
    "makino/Plane_2.cldata",
    "nx/coremill.cls",
    "nx/simple_block.cls",
    *(
        f"solidworks/{name}.apt"
        for name in [
            "Dem-target1",
            "Dem-target2",
            "Interface-glue",
            "Sacrifice-Board",
            "SupPetriLED",
            "Teflon-gasket",
            "Teste-Metrologia",
            "Top-light-cover",
            "basemach",
            "shimemcunha",
        ]
    ),
]
#: What a machine of the library says when it cannot run a source.
REFUSED = {"axis-limit", "unreachable-orientation", "cycle-tap", "pole-way"}


def found(name, path, machine=None, sees=None):
    """Post a file and judge the program; nothing where the machine cannot run it."""
    text = path.read_text(encoding="latin-1")
    machine = machine or toolpost.machine(name)
    try:
        program = toolpost.post(toolpost.read(path), machine).text
    except toolpost.Error as error:
        if error.rule in REFUSED and error.report is None:
            return []
        raise
    return judge(name, sees or reference(name), read(text), program, 2 if LONG else 1).faults


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("file", FILES)
def test_a_program_of_a_real_file_does_what_its_source_says(file, name):
    if not LONG and any(large in file for large in LARGE):
        pytest.skip("takes seconds: TOOLPOST_JUDGES=long")
    assert found(name, real("cldata") / file) == []


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("file", [*sorted(EXAMPLES.glob("*.cls")), SAMPLE], ids=lambda p: p.stem)
def test_a_program_of_an_example_does_what_its_source_says(file, name):
    assert found(name, file) == []


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", range(200 if LONG else 8))
def test_a_program_of_a_harsh_job_does_what_its_source_says(name, seed, tmp_path):
    path = tmp_path / "job.cls"
    path.write_text(job(seed))
    machine = sees = None
    # Every second job meets a machine whose centres lie where nothing is easy, with travels.
    if seed % 2:
        text = stated(name, *STATED[name])
        file = tmp_path / "machine.toml"
        file.write_text(text)
        machine, sees = toolpost.machine(file), load(text, *library(ROOT, name)[1:])
    assert found(name, path, machine, sees) == []


def test_every_damage_of_a_program_is_found():
    source = read(SAMPLE.read_text())
    program = toolpost.read(SAMPLE)
    done = 0
    missed = []
    for name, damages in DAMAGES.items():
        machine = reference(name)
        text = toolpost.post(program, toolpost.machine(name)).text
        before = set(judge(name, machine, source, text, 1).faults)
        for seed, damage in enumerate(damages):
            worse = damaged(text, damage, seed)
            if worse is None:
                missed.append(f"{name}: {damage.name}: no block takes it")
                continue
            done += 1
            try:
                faults = set(judge(name, machine, source, worse, 1).faults)
            except FaultError:
                continue
            if not faults - before:
                missed.append(f"{name}: {damage.name}")
    assert not missed, "\n".join(missed)
    assert done >= 30


def test_a_tilted_head_that_comes_from_home_too_low_is_found(tmp_path):
    name = "linuxcnc-xyzbc-head"
    text, path = stated(name, *STATED[name]), tmp_path / "job.cls"
    (tmp_path / "machine.toml").write_text(text)
    path.write_text(job(29))
    machine = toolpost.machine(tmp_path / "machine.toml")
    sees = load(text, *library(ROOT, name)[1:])
    program = toolpost.post(toolpost.read(path), machine).text
    # From home it comes to the height of the job's highest place, and then along the tool. The
    # reference wants a millimetre above all cuts, of which the surface of a hole at -1.244 is the
    # highest, and what is kept for rounding; it looks at places a millimetre apart.
    ways = [
        ("X52.6305 Y35.5037", (35.665335, -15.668456, -2.536206), (0.139168, 0.419772, 0.896897)),
        ("X48.8039 Y158.0838", (31.606629, -16.168463, -2.448296), (0.083326, 0.844307, 0.529341)),
    ]
    for above, place, axis in ways:
        for height, expected in ((-0.234, set()), (-2, {"rapid"})):
            x, y, _ = np.array(place) + np.array(axis) * (height - place[2]) / axis[2]
            begin = f"\n{above}\nZ106.7997\n"
            assert begin in program
            lower = program.replace(begin, f"\nX{x:.4f} Y{y:.4f}\nZ{height}\n")
            faults = judge(name, sees, read(job(29)), lower, 1).faults
            assert {fault.partition(":")[0] for fault in faults} == expected, (above, height)


# The reference itself, by hand and by the tables of the specification.


@pytest.mark.parametrize(
    ("vector", "angles"),
    [
        ((0, 1, 0), (90, 0)),
        ((1, 0, 0), (90, -90)),
        ((0, -1, 0), (90, 180)),
        ((-1, 0, 0), (90, 90)),
        ((0.5, 0.5, np.sqrt(0.5)), (45, -45)),
    ],
)
def test_angles_of_an_ac_table_are_those_of_the_specification(vector, angles):
    machine = reference("sinumerik-840d-table-ac")
    answers = machine.orient(np.array([vector], dtype=float))[:, 0]
    turned = [(pair - angles + 180) % 360 - 180 for pair in answers]
    assert min(float(abs(turn).max()) for turn in turned) < 1e-6


def test_at_the_pole_c_is_free_and_stays():
    machine = reference("sinumerik-840d-table-ac")
    answers = machine.reach(np.array([0.0, 0.0, 1.0]), np.array([10.0, 77.0]))
    assert [answer.tolist() for answer in answers] == [[0.0, 77.0]] * len(answers)


@pytest.mark.parametrize("name", NAMES)
def test_axes_found_for_a_pose_lead_back_to_it(name):
    machine = load(stated(name, *STATED[name]), *library(ROOT, name)[1:])
    chance = np.random.default_rng(1)
    tip = chance.uniform(-100, 100, (50, 3))
    along = np.column_stack([chance.uniform(-0.4, 0.4, (50, 2)), np.ones(50)])
    along /= np.linalg.norm(along, axis=1)[:, None]
    length = chance.uniform(20, 200, 50)
    for turns in machine.orient(along):
        axes = machine.inverse(tip, turns, length)
        back, lean = machine.forward(axes, turns, length)
        np.testing.assert_allclose(back, tip, atol=1e-9)
        np.testing.assert_allclose(lean, along, atol=1e-9)


def test_a_fork_head_swings_the_tip_by_hand_calculation():
    machine = reference("sinumerik-840d-traori")
    # A 90: what was 220 + 100 below the pivot is 320 to its side, at its height.
    tip, along = machine.tool(np.array([[0.0, 90.0]]), np.array([100.0]))
    np.testing.assert_allclose(tip, [[0, 320, 220]], atol=1e-9)
    np.testing.assert_allclose(along, [[0, -1, 0]], atol=1e-12)


def test_a_vector_that_passes_the_pole_within_two_degrees_is_a_fault():
    # From 20 degrees off Z to 20 on the other side, about which the way leaves Z by so much.
    for near, is_fault in ((0.0005, False), (0.07, True), (1.9, True), (2.1, False)):
        aside = np.tan(np.radians(near))
        ends = [
            np.array([x, aside, 1.0]) for x in (np.tan(np.radians(20)), -np.tan(np.radians(20)))
        ]
        assert pole_passed(*(end / np.linalg.norm(end) for end in ends)) == pytest.approx(near)
        one, two = (" ".join(f"{n}={v:.7f}" for n, v in zip(("A3", "B3", "C3"), e)) for e in ends)
        text = f"""G0 SUPA Z0 D0
T1
M6
D1
TRAORI
G0 X0 Y0 Z100 {one}
G0 X5 {two}
TRAFOOF
M30"""
        control = Sinumerik(reference("sinumerik-840d-traori"), {0: 120.0}, (0.0, 0.0))
        if is_fault:
            with pytest.raises(FaultError, match="past the pole"):
                control.run(text)
        else:
            control.run(text)
    # An end within the limit: what C does there, more data say.
    assert pole_passed(np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8])) is None


def test_a_hole_touches_the_part_at_its_surface_and_not_at_its_r_plane():
    source = read(
        "UNITS/MM\nMULTAX/ON\nLOAD/TOOL,1,LENGTH,60\nSPINDL/RPM,4000,CLW\nRAPID\nGOTO/0,0,50,0,0,1\n"
        "CYCLE/DRILL,RAPTO,3,FEDTO,7,MMPM,150\nGOTO/1,2,-5,0,0,1\nCYCLE/OFF\nFINI\n"
    )
    hole = next(move for move in source.moves if move.hole)
    assert (hole.start[2], hole.end[2], hole.clear) == (-2, -12, 3)
    touched = touching(source.moves)
    np.testing.assert_allclose(touched, [[1, 2, -5], [1, 2, -12]])


def test_a_job_is_the_same_each_time():
    assert job(7) == job(7)
    assert job(7) != job(8)
