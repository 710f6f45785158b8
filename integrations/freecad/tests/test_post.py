"""The post inside FreeCAD: what it answers, saves and says."""

import json
import pathlib

import pytest

# Each case with something that must be said: what is wrong, where, and the way out.
REFUSALS = {
    "empty": ["no operation of the job moves the tool", "make them active"],
    "inactive": ["no operation of the job moves the tool", "make them active"],
    "tool-not-called": ["operation `Profile`", "no tool has been called", "tool controller"],
    "tool-without-number": ["operation `Mill 5`", "the tool has no number"],
    "spindle-0": ["operation `Profile`", "spindle", "give the tool controller its speed"],
    "feed-0": [
        "operation `Profile`",
        "feed",
        "give the tool controller of the operation its feeds",
    ],
    "code-unknown": ["operation `Custom`:5", "G999", "change the commands of the operation"],
    # FreeCAD writes all of them as one number.
    "nan": ["operation `Broken`:3", "is no number", "recompute the operation"],
    "infinite": ["operation `Broken`:3", "is no number", "recompute the operation"],
    "huge": ["operation `Broken`:3", "is no number", "recompute the operation"],
    "command-of-two-lines": ["operation `Broken` has 3 commands on 4 lines", "line break"],
    "moved": ["Profile is moved by its Placement", "set it to zero"],
    "machine-missing": ["--machine", "name in the library"],
    "machine-unknown": [
        "`generic-3axis-linuxcmc` is not in the library",
        "did you mean `generic-3axis-linuxcnc`",
    ],
    "argument-unknown": ["--modal", "--machine NAME|FILE"],
    "argument-open": ["No closing quotation"],
    "option-unknown": ["no option `colour`"],
    "option-bare": ["--option", "colour is no NAME=VALUE"],
    "option-of-the-function": ["name_or_path"],
    "same": ["would be both report and program", "choose another name"],
    "folder": ["is no ordinary file", "choose another name"],
    "device": ["/dev/null is no ordinary file"],
    "new": ["second.ngc cannot be saved: Permission denied"],
    "kept": ["second.ngc cannot be saved: Permission denied"],
    "offset-unknown": ["G53 is no work offset"],
    "offset-twice-dotted": ["G54.7 is no work offset"],
    "offset-of-none": ["no operation calls the work offset of the job", "choose it in the job"],
    "offset-of-two": ["this has G54, G55"],
    "no-folder": ["missing/part.ngc cannot be saved: No such file or directory"],
    "read-only": ["/sys/part.ngc cannot be saved: "],
}


@pytest.mark.parametrize("name", REFUSALS)
def test_a_refusal_says_what_to_do_and_saves_nothing(cases, name):
    case = cases["cases"][name]
    assert case["answer"] is None
    assert case["saved"] is None
    assert all(words in case["said"] for words in REFUSALS[name]), case["said"]
    assert "nothing was saved" in case["said"]
    assert "Traceback" not in case["said"]
    assert "a mistake in the post" not in case["said"]


def test_a_program_is_answered_and_saved(cases):
    case = cases["cases"]["file"]
    assert case["saved"] == case["answer"]
    assert "proven" in case["said"]


def test_without_a_file_the_program_is_only_answered(cases):
    case = cases["cases"]["answer"]
    assert case["saved"] is None
    assert "G1 X" in case["answer"]


@pytest.mark.parametrize(
    ("robot", "named"),
    [
        ("kuka-kr6-r900", "\nDEF part_1 ( )\n"),
        ("universal-ur5e", "def job_part_1():\n"),
        ("fanuc-lrmate-200id-mill", "/PROG PART_1\n"),
        ("abb-irb120-mill", "MODULE MOD_part_1\n"),
    ],
)
def test_a_robot_gets_a_program_of_the_name_of_its_file(cases, robot, named):
    case = cases["cases"][robot]
    assert case["saved"] is not None, case["said"]
    assert named in case["saved"]
    assert "proven" in case["said"]


def test_the_report_is_saved_where_it_is_asked_for(cases):
    case = cases["cases"]["report"]
    folder = case["file"].rsplit("/", 1)[0]
    with open(f"{folder}/report.json", encoding="utf-8") as file:
        assert json.load(file)["proof"]["proven"] is True
    assert case["saved"] == case["answer"]


def test_of_two_files_both_are_saved_or_none(cases):
    folder = pathlib.Path(cases["cases"]["file"]["file"]).parent
    assert not (folder / "new.json").exists()
    assert (folder / "kept.json").read_text() == "earlier"


def test_a_link_stays_one(cases):
    link = pathlib.Path(cases["cases"]["link"]["file"])
    assert link.is_symlink()
    assert link.read_text() == cases["cases"]["link"]["answer"]


def test_a_label_that_no_file_can_hold_is_posted(cases):
    assert cases["cases"]["surrogate"]["saved"] == cases["cases"]["surrogate"]["answer"]
    assert "a mistake in the post" not in cases["cases"]["surrogate"]["said"]


def test_a_work_offset_takes_the_place_of_that_of_the_job(cases):
    offset = cases["cases"]["offset"]["answer"]
    assert "G56" in offset
    assert "G54" not in offset.split("G56", 1)[1]


def test_labels_become_what_the_control_can_print(cases):
    assert cases["cases"]["sinumerik"]["answer"].isascii()
    assert "Aussenkontur" in cases["cases"]["sinumerik"]["answer"]


@pytest.mark.parametrize("name", ["groups", "wrapped"])
def test_what_an_object_stands_in_changes_nothing(cases, name):
    inside, plain = (cases["cases"][case]["answer"].splitlines() for case in (name, "file"))
    # The first line is the name.
    assert inside[1:] == plain[1:]


def test_a_comment_cannot_become_a_motion(cases):
    answer = cases["cases"]["comment-of-two-lines"]["answer"]
    assert "X99" not in [line for line in answer.splitlines() if not line.startswith("(")]
    assert "(one G1 X99)" in answer.replace("ONE", "one")


def test_each_fixture_gets_its_program(cases):
    first, second = (cases["cases"][f"split-{number}"]["answer"] for number in (1, 2))
    assert "G54" in first
    assert "G55" not in first
    assert "G55" in second
    both = cases["cases"]["fixtures"]["answer"]
    assert both.index("G54") < both.index("G55")


def test_a_long_job_is_posted(cases):
    """As many as a million commands, of which nothing is lost."""
    assert cases["cases"]["long"]["answer"].count("\nX") > 0.9 * cases["long"]
    # Seconds, on a slow machine with a command that was built for debugging.
    assert cases["cases"]["long"]["seconds"] < 120


def test_the_lists_of_a_job_are_those_of_freecad(cases):
    for ours, freecads in cases["order"].values():
        assert ours == freecads
