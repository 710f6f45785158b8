"""What goes out with the package names the terms of all that is linked into it."""

import json
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


# The heading of the notices for each licence of deny.toml.
HEADINGS = {
    "Apache-2.0": "Apache License 2.0",
    "BSD-2-Clause": 'BSD 2-Clause "Simplified" License',
    "BSD-3-Clause": 'BSD 3-Clause "New" or "Revised" License',
    "BSL-1.0": "Boost Software License 1.0",
    "MIT": "MIT License",
    "Unicode-3.0": "Unicode License v3",
    "Zlib": "zlib License",
}


def test_each_crate_stands_under_a_licence_that_it_has_declared():
    """Without cargo-about: what each crate declares is in its manifest, which cargo has at hand."""
    ask = ["cargo", "metadata", "--locked", "--format-version", "1"]
    done = subprocess.run(ask, cwd=ROOT, check=True, capture_output=True, text=True)
    packages = json.loads(done.stdout)["packages"]
    declared = {(one["name"], one["version"]): one["license"] or "" for one in packages}
    under: dict[tuple[str, str], set[str]] = {}
    heading = ""
    for line in (ROOT / "THIRD-PARTY.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            heading = line.removeprefix("## ")
        if found := re.match(r"- (\S+) (\S+)", line):
            under.setdefault((found[1], found[2]), set()).add(heading)
    assert len(under) > 100
    for crate, headings in under.items():
        names = set(re.findall(r"[A-Za-z][A-Za-z0-9.-]*", declared[crate])) & HEADINGS.keys()
        assert headings <= {HEADINGS[name] for name in names}, (crate, declared[crate])
        # Of terms that hold together (AND) each has to be there.
        if " AND " in declared[crate]:
            assert len(headings) > 1, (crate, declared[crate])


def test_no_version_in_the_notices_is_of_another_day():
    text = (ROOT / "THIRD-PARTY.md").read_text(encoding="utf-8")
    lock = (ROOT / "Cargo.lock").read_text(encoding="utf-8")
    locked = set(re.findall(r'name = "(\S+)"\nversion = "(\S+)"', lock))
    named = set(re.findall(r"^- (\S+) (\S+)", text, re.MULTILINE))
    assert named - locked == set(), "make notices"
