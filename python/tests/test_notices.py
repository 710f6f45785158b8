"""What goes out with the package names the terms of all that is linked into it."""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]


def linked() -> set[tuple[str, str]]:
    tree = ["cargo", "tree", "--locked", "--package", "toolpost-python", "--prefix", "none"]
    tree += ["--edges", "normal,no-proc-macro", "--target", "all"]
    done = subprocess.run(tree, cwd=ROOT, check=True, capture_output=True, text=True)
    crates = set(re.findall(r"^(\S+) v(\S+)", done.stdout, re.MULTILINE))
    return {(name, version) for name, version in crates if not name.startswith("toolpost")}


def test_every_crate_that_is_linked_is_in_the_notices_with_its_version():
    text = (ROOT / "THIRD-PARTY.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^- (\S+) (\S+)", text, re.MULTILINE))
    assert linked() - named == set(), "make notices"


def test_no_version_in_the_notices_is_of_another_day():
    text = (ROOT / "THIRD-PARTY.md").read_text(encoding="utf-8")
    lock = (ROOT / "Cargo.lock").read_text(encoding="utf-8")
    locked = set(re.findall(r'name = "(\S+)"\nversion = "(\S+)"', lock))
    named = set(re.findall(r"^- (\S+) (\S+)", text, re.MULTILINE))
    assert named - locked == set(), "make notices"
