"""Posting and proving."""

from __future__ import annotations

import json
import pickle
import threading
import time

import pytest

import toolpost
from conftest import EXAMPLES


def test_the_program_and_its_report_are_those_of_the_command(native, tmp_path, dome, run):
    out = tmp_path / "dome.mpf"
    done = run(native, "post", EXAMPLES / "dome.cls", "-m", "sinumerik-840d-table-ac", "-o", out)
    result = toolpost.post(dome, toolpost.machine("sinumerik-840d-table-ac"), file="dome.mpf")
    assert result.data == out.read_bytes()
    assert result.report.json == out.with_name(f"{out.name}.report.json").read_text()
    assert result.text.encode() == result.data
    printed = {" ".join(line.split()) for line in done.stdout.splitlines()}
    rows = {" ".join(f"{head} {text}".split()) for head, text in result.report.rows if head}
    assert rows <= printed


def test_a_program_is_saved_with_its_report(tmp_path, slot):
    result = toolpost.post(slot, toolpost.machine("emco-concept-mill-105"))
    result.save(tmp_path / "slot.mpf")
    assert (tmp_path / "slot.mpf").read_bytes() == result.data
    saved = json.loads((tmp_path / "slot.mpf.report.json").read_text())
    assert saved == result.report.data()
    assert saved["proof"]["proven"] is True
    assert saved["program"]["file"] == "slot.mpf"
    result.save(tmp_path / "alone.mpf", report=False)
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "alone.mpf",
        "slot.mpf",
        "slot.mpf.report.json",
    ]


def test_a_program_is_not_saved_over_what_it_was_made_of(tmp_path, slot):
    result = toolpost.post(slot, toolpost.machine("generic-3axis-linuxcnc"))
    result.save(tmp_path / "part.ngc", report=False)
    own = tmp_path / "own.toml"
    own.write_text('extends = "generic-3axis-linuxcnc"\n')
    (tmp_path / "link.ngc").symlink_to("part.ngc")
    source, machine = toolpost.read(tmp_path / "part.ngc", "linuxcnc"), toolpost.machine(own)
    result = toolpost.post(source, machine)
    for name in ("part.ngc", "link.ngc", "own.toml"):
        before = (tmp_path / name).read_bytes()
        with pytest.raises(toolpost.Error, match="it is the input"):
            result.save(tmp_path / name)
        assert (tmp_path / name).read_bytes() == before
    assert not list(tmp_path.glob("*.report.json"))


def test_where_it_cannot_be_saved_nothing_is(tmp_path, slot):
    result = toolpost.post(slot, toolpost.machine("emco-concept-mill-105"))
    with pytest.raises(toolpost.Error) as caught:
        result.save(tmp_path / "missing" / "slot.mpf")
    assert caught.value.rule == "output-folder"
    assert not list(tmp_path.iterdir())


def test_a_program_that_was_edited_is_not_proven(slot):
    machine = toolpost.machine("emco-concept-mill-105")
    text = toolpost.post(slot, machine).text
    assert toolpost.prove(text, machine, slot).proven
    assert toolpost.prove(text.encode(), machine, slot).proven
    edited = text.replace("X50", "X51", 1)
    report = toolpost.prove(edited, machine, slot, file="slot.mpf")
    assert not report.proven
    finding = report.findings[0]
    line = next(i for i, line in enumerate(edited.splitlines(), 1) if "X51" in line)
    assert (finding.severity, finding.file, finding.line) == ("error", "slot.mpf", line)
    assert "1 mm" in finding.message
    assert toolpost.prove(edited, machine, slot, tolerance=1.5).proven
    assert "FAILED" in str(report)
    assert report.data()["proof"]["proven"] is False


def test_what_is_not_proven_is_not_given_out(tmp_path, slot):
    # A control file that sends the tool elsewhere.
    file = tmp_path / "wrong.toml"
    file.write_text('extends = "generic-3axis-linuxcnc"\n[words.X]\nscale = 1.001\n')
    with pytest.raises(toolpost.Error) as caught:
        toolpost.post(slot, toolpost.machine(file))
    assert caught.value.report is not None
    assert not caught.value.report.proven
    assert caught.value.rule == caught.value.report.findings[0].rule


def test_what_cannot_be_written_says_where_and_why():
    builder = toolpost.Program.builder("far").tool(1).spindle(1000).feed(100)
    program = builder.rapid((0, 0, 50)).line((5000, 0, 50)).build()
    with pytest.raises(toolpost.Error, match="axis-limit") as caught:
        toolpost.post(program, toolpost.machine("emco-concept-mill-105"))
    error = caught.value
    assert (error.rule, error.report) == ("axis-limit", None)
    assert (error.file, error.line) == ("far", 5)
    assert "200 mm" in str(error)
    assert {finding.severity for finding in error.findings} == {"error"}


def test_errors_go_from_one_process_to_another():
    with pytest.raises(toolpost.Error) as caught:
        toolpost.read(EXAMPLES / "nothing.cls")
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.findings == caught.value.findings
    assert str(again) == str(caught.value)


def test_a_wire_machine_has_a_command_of_its_own(slot):
    with pytest.raises(toolpost.Error, match="toolpost wire") as caught:
        toolpost.post(slot, toolpost.machine("bp-95d"))
    assert caught.value.rule == "machine-kind"


def test_a_wrong_machine_is_refused_with_those_there_are():
    with pytest.raises(toolpost.Error, match="generic-3axis-linuxcnc") as caught:
        toolpost.machine("generic-linuxcnc")
    assert caught.value.rule == "machine-unknown"


def test_errors_of_a_machine_file_have_line_and_column(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text('extends = "generic-3axis-iso"\n[words.X]\ndecimals = "many"\n')
    with pytest.raises(toolpost.Error) as caught:
        toolpost.machine(file)
    assert caught.value.file.endswith("own.toml")
    assert (caught.value.line, caught.value.column) == (3, 12)


def test_every_error_of_a_file_is_reported(tmp_path):
    file = tmp_path / "bad.cls"
    file.write_text("UNITS/MM\nGOTO/1,2\nRAPID\nGOTO/1,2,3\nGOTO/1,2,3,0,0,0\n")
    with pytest.raises(toolpost.Error) as caught:
        toolpost.read(file)
    assert [finding.line for finding in caught.value.findings] == [2, 5]
    assert caught.value.line == 2


@pytest.mark.parametrize("tolerance", [0, -1, float("nan"), float("inf")])
def test_a_tolerance_is_a_length(slot, tolerance):
    with pytest.raises(toolpost.Error, match="tolerance"):
        toolpost.post(slot, toolpost.machine("generic-3axis-iso"), tolerance=tolerance)


def test_the_library_has_every_machine_by_its_name():
    for machine in toolpost.library():
        assert toolpost.machine(machine.name).title == machine.title


def test_a_report_is_a_table_in_a_notebook(slot):
    machine = toolpost.machine("emco-concept-mill-105")
    html = toolpost.post(slot, machine).report._repr_html_()
    assert html.startswith("<table><tr><th>toolpath</th><td>slot (built)</td></tr>")
    html = toolpost.prove("N10 G0 X<b>\n", machine, slot)._repr_html_()
    assert "<b>" not in html
    assert "&lt;b&gt;" in html


def test_other_threads_run_while_a_program_is_posted(dome):
    machine = toolpost.machine("sinumerik-840d-table-ac")
    beats, done = [], threading.Event()

    def beat() -> None:
        while not done.is_set():
            beats.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=beat)
    thread.start()
    begin = time.monotonic()
    toolpost.post(dome, machine)
    end = time.monotonic()
    done.set()
    thread.join()
    assert sum(begin < at < end for at in beats) >= 5
