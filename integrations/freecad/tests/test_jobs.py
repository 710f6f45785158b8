"""Jobs of FreeCAD's own operations: proven for every mill, and as LinuxCNC understands them."""

import json
import re

import judge
import pytest
from conftest import toolpost

MILLS = [
    machine["name"]
    for machine in toolpost("machines", "list")["machines"]
    if machine["control"] not in ("wire-iso", "points")
]

# Jobs that ask for flood coolant.
COOLED = [
    *(f"several-{what}" for what in ("Fixture", "Operation", "Tool")),
    *(f"split-{what}-{part}" for what in ("Fixture", "Operation", "Tool") for part in (1, 2)),
]

# What FreeCAD does not say, or a machine cannot do: the rule by which it is refused.
REFUSED = {
    # As FreeCAD ships it, this job has neither feeds nor speeds.
    ("boxtest-Job", ""): "feed",
    # The teaching mill: 200 mm of travel in X, tools up to 55 mm.
    ("Drilling_1", "emco"): "axis-limit",
    ("boxtest-Job001", "emco"): "tool-range",
    # A small router: 45 mm in Z.
    ("Drilling_1", "grbl-3018"): "axis-limit",
    # A router without coolant.
    ("mist", "grbl-3018"): "missing-block",
    **{(job, "grbl-3018"): "missing-block" for job in COOLED},
    # Controls without mist.
    ("mist", "dmu50-heidenhain"): "missing-block",
    ("mist", "generic-3axis-heidenhain"): "missing-block",
    ("mist", "generic-3axis-haas"): "missing-block",
    ("mist", "haas-umc-750"): "missing-block",
    ("mist", "generic-3axis-grbl"): "missing-block",
}


def refusals(name, mill):
    """Answer the rules by which this job is refused for this mill."""
    return {rule for (job, of), rule in REFUSED.items() if job == name and mill.startswith(of)}


def names(folder):
    """Answer the names of the jobs in a folder."""
    return sorted(path.stem for path in folder.glob("*.json"))


def test_a_job_says_how_large_its_stock_is(jobs):
    # The part of 100 x 80 x 20 mm, and 1 mm more on each side, as FreeCAD makes a stock.
    stock = json.loads((jobs / "profile.json").read_text())["stock"]
    assert stock["low"] == pytest.approx([-1, -1, -1])
    assert stock["high"] == pytest.approx([101, 81, 21])


def test_every_operation_of_freecad_is_among_the_jobs(jobs):
    patterns = {name for name in names(jobs) if name.startswith("pocket-")}
    # FreeCAD 0.20 has these five.
    assert len(patterns) >= 5
    single = {"profile", "profile-inside", "face", "helix", "adaptive", "engrave", "tags", "ramps"}
    drills = {"drill", "drill-dwell", "drill-peck", "drill-G99"}
    shipped = {"boxtest-Job", "boxtest-Job-fed", "boxtest-Job001", "Drilling_1", "test_holes00"}
    assert single | drills | shipped <= set(names(jobs))
    cuts = {name: (jobs / f"{name}.json").read_text().count("\\nG") for name in names(jobs)}
    assert all(count > 5 for count in cuts.values()), cuts


@pytest.mark.parametrize("mill", MILLS)
def test_a_mill_gets_proven_programs(jobs, mill, tmp_path):
    wrong = {}
    for name in names(jobs):
        report = toolpost("post", jobs / f"{name}.json", "-m", mill, "-o", tmp_path / "part.nc")
        refused = refusals(name, mill)
        rules = {error["rule"] for error in report["errors"]}
        if rules != refused or not (refused or report["proof"]["proven"]):
            wrong[name] = report["errors"][:1]
    assert not wrong


@pytest.mark.parametrize("name", ["several-Fixture", "several-Tool", "several-Operation"])
def test_a_document_is_posted_as_in_the_window(jobs, tmp_path, name):
    programs = []
    for source in (jobs / f"{name}.json", jobs / f"{name}.FCStd"):
        program = tmp_path / "part.ngc"
        report = toolpost("post", source, "-m", "generic-3axis-linuxcnc", "-o", program)
        assert report["status"] == "done", report["errors"]
        # The first line is the name: that of the job, or of its document.
        programs.append(program.read_text().splitlines()[1:])
    assert programs[0] == programs[1]


def test_linuxcnc_moves_as_with_the_post_of_freecad(jobs, tmp_path):
    differences = {}
    for name in names(jobs):
        if refusals(name, "generic-3axis-linuxcnc"):
            continue
        ours = tmp_path / "ours.ngc"
        report = toolpost("post", jobs / f"{name}.json", "-m", "generic-3axis-linuxcnc", "-o", ours)
        assert report["status"] == "done", report["errors"]
        theirs = jobs / f"{name}.ngc"
        if name == "boxtest-Job001":
            theirs = without_comments(theirs, tmp_path)
        difference = judge.difference(judge.moves(ours, tmp_path), judge.moves(theirs, tmp_path))
        if difference:
            differences[name] = difference
    assert not differences


def test_the_post_of_freecad_writes_labels_that_linuxcnc_refuses(jobs, tmp_path):
    """FreeCAD puts the label `FirstOp-(T1)` into a comment as it is; LinuxCNC nests none."""
    with pytest.raises(judge.JudgeError, match="Nested comment"):
        judge.moves(jobs / "boxtest-Job001.ngc", tmp_path)


def test_the_post_of_freecad_writes_a_cut_without_feed(jobs, tmp_path):
    """FreeCAD leaves F out where it is 0; we refuse the job, LinuxCNC the program."""
    with pytest.raises(judge.JudgeError, match="zero feed rate"):
        judge.moves(jobs / "boxtest-Job.ngc", tmp_path)


def without_comments(program, folder):
    """Answer a copy of the program without lines that are comments."""
    copy = folder / "without-comments.ngc"
    lines = program.read_text().splitlines()
    copy.write_text("\n".join(line for line in lines if not re.match(r"\(.*\)\s*$", line)) + "\n")
    return copy
