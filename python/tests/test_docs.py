"""The examples of the documentation do what they say."""

from __future__ import annotations

import doctest
import re

import pytest

from conftest import ROOT

PAGES = [ROOT / "docs" / "python.md"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_examples_of_a_page_do_what_they_say(page, tmp_path, monkeypatch):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    text = page.read_text()
    examples = []
    for block in re.finditer(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        found = doctest.DocTestParser().get_examples(block[1], page.name)
        before = text.count("\n", 0, block.start(1))
        for example in found:
            example.lineno += before
        examples += found
    assert examples
    said: list[str] = []
    test = doctest.DocTest(examples, {}, page.name, str(page), 0, None)
    result = doctest.DocTestRunner().run(test, out=said.append)
    assert result.failed == 0, "".join(said)


def test_the_example_of_the_readme_does_what_it_says(tmp_path, monkeypatch):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "README.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert blocks
    for block in blocks:
        exec(compile(block, "README.md", "exec"), {})
    assert (tmp_path / "dome.nc").is_file()
    assert (tmp_path / "dome.nc.report.json").is_file()
