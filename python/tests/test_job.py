"""Jobs of FreeCAD, as text and as dictionaries."""

from __future__ import annotations

import json

import numpy as np
import pytest

import toolpost
from conftest import EXAMPLES

JOB = EXAMPLES / "bracket.json"


def test_a_job_is_the_same_from_its_file_its_text_and_a_dictionary():
    read = toolpost.read(JOB)
    for given in [JOB.read_text(), JOB.read_bytes(), json.loads(JOB.read_text())]:
        job = toolpost.read_job(given, toolpost.machine("emco-concept-mill-105"), file=JOB.name)
        np.testing.assert_array_equal(job.positions, read.positions)
        assert [repr(record) for record in job] == [repr(record) for record in read]
        assert (job.file, job.dialect) == (read.file, read.dialect)


def test_a_job_is_posted_and_proven():
    job = toolpost.read_job(JOB.read_text())
    result = toolpost.post(job, toolpost.machine("emco-concept-mill-105"))
    labels = [operation["label"] for operation in json.loads(JOB.read_text())["operations"]]
    assert set(labels) <= {op["label"] for op in result.report.data()["source"]["operations"]}


def test_what_is_wrong_with_a_job_names_its_operation():
    job = json.loads(JOB.read_text())
    label = job["operations"][0]["label"]
    job["operations"][0]["commands"] += "G99999\n"
    for given in [job, json.dumps(job)]:
        with pytest.raises(toolpost.Error, match=label) as caught:
            toolpost.read_job(given, file="bracket.json")
        assert caught.value.line > 0


def nested(depth):
    """Answer a dictionary in so many others."""
    return {"name": nested(depth - 1)} if depth else {}


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({}, "missing field `toolpost`"),
        ({"toolpost": "freecad-job", "version": 2, "operations": []}, "version 2"),
        ({"toolpost": "freecad-job", "version": 1, "operations": {}}, "expected a sequence"),
        ({"toolpost": float("nan")}, "a number of the job is NaN"),
        ({"toolpost": 10**400}, "`toolpost` is a <class 'int'>"),
        ({"toolpost": object()}, "`toolpost` is a <class 'object'>"),
        ({"toolpost": "\ud800"}, "`toolpost` is a <class 'str'>"),
        ({"toolpost": {1: "one"}}, "`toolpost` has a key that is no text"),
        ({"\ud800": 1}, "`job` has a key that is no text"),
        (nested(100), "`name` is in too many lists and dictionaries"),
        ({"label": [[[[[[[[[]]]]]]]]]}, "`label` is in too many lists and dictionaries"),
    ],
)
def test_a_dictionary_that_is_no_job_is_refused(wrong, said):
    with pytest.raises(toolpost.Error, match=said):
        toolpost.read_job(wrong)


def test_what_is_no_json_is_a_wrong_argument():
    with pytest.raises(toolpost.Error) as caught:
        toolpost.read_job({"toolpost": object()})
    assert caught.value.rule == "argument"


class Number:
    """A number that does something when it is asked for."""

    def __init__(self, asked):
        """Do `asked`."""
        self.asked = asked

    def __index__(self):
        """Answer 1."""
        self.asked()
        return 1


def test_tuples_are_lists():
    job = json.loads(JOB.read_text())
    listed = toolpost.read_job(job)
    job["operations"] = tuple(job["operations"])
    np.testing.assert_array_equal(toolpost.read_job(job).positions, listed.positions)


def test_a_job_that_changes_while_it_is_read_is_read_as_it_was():
    job = {}
    job.update({"toolpost": Number(lambda: job.update({str(len(job)): 1})), "version": 1})
    with pytest.raises(toolpost.Error):
        toolpost.read_job(job)
    numbers = []
    numbers.extend([Number(lambda: numbers.append(numbers[0]))])
    with pytest.raises(toolpost.Error):
        toolpost.read_job({"toolpost": numbers})


@pytest.mark.parametrize("raised", [KeyboardInterrupt, ValueError])
def test_what_a_number_raises_is_raised(raised):
    def asked():
        raise raised

    with pytest.raises(raised):
        toolpost.read_job({"version": Number(asked)})


def test_options_of_a_machine_are_set_by_keywords(slot):
    machine = toolpost.machine("emco-concept-mill-105-emco-post", time="noon")
    assert "noon" in toolpost.post(slot, machine).text
    with pytest.raises(toolpost.Error, match="colour") as caught:
        toolpost.machine("emco-concept-mill-105-emco-post", colour="red")
    assert caught.value.rule == "option"
