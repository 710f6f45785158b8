"""The wheel in an environment that has nothing else, the sources away from the repository."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

from conftest import EXAMPLES, ROOT

USE = """
import sys, toolpost
program = toolpost.read(sys.argv[1])
result = toolpost.post(program, toolpost.machine("dmu50-heidenhain"))
result.save(sys.argv[2])
print(len(program.positions), toolpost.__version__)
"""


def test_the_wheel_works_in_a_clean_environment(tmp_path, run):
    # The profile in which the package is built for the other tests, so that nothing is built twice.
    maturin = ["maturin", "build", "--quiet", "--profile", "dev", "--out", tmp_path / "wheels"]
    subprocess.run([sys.executable, "-m", *maturin], cwd=ROOT, check=True)
    (wheel,) = (tmp_path / "wheels").glob("*.whl")
    assert "-cp39-abi3-" in wheel.name
    names = zipfile.ZipFile(wheel).namelist()
    for needed in ["toolpost/py.typed", "toolpost/_native.pyi", "toolpost/__init__.py"]:
        assert needed in names

    clean = tmp_path / "clean"
    venv.create(clean, with_pip=True)
    binaries = next(path for path in [clean / "bin", clean / "Scripts"] if path.is_dir())
    pip = [binaries / "python", "-m", "pip", "install", "--quiet", wheel]
    subprocess.run(pip, check=True)
    program = tmp_path / "dome.h"
    used = run(binaries / "python", "-I", "-c", USE, EXAMPLES / "dome.cls", program)
    assert (used.returncode, used.stderr) == (0, "")
    moves, version = used.stdout.split()
    assert moves == "1773"
    report = program.with_name(f"{program.name}.report.json")
    assert json.loads(report.read_text())["toolpost"] == version

    again = tmp_path / "again.h"
    post = ["post", EXAMPLES / "dome.cls", "-m", "dmu50-heidenhain", "-o", again]
    assert run(binaries / "toolpost", *post).returncode == 0
    assert again.read_bytes() == program.read_bytes()


def test_the_source_package_has_all_that_the_package_is_built_from(tmp_path):
    maturin = [sys.executable, "-m", "maturin", "sdist", "--out", tmp_path]
    subprocess.run(maturin, cwd=ROOT, check=True)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as packed:
        names = {name.partition("/")[2] for name in packed.getnames()}
    # What cargo has found when it built the package for the other tests.
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    (found,) = target.glob("debug/*_native.d")
    paths = [Path(path).resolve() for path in found.read_text().split()[1:]]
    # A folder stands for the files in it.
    folders = [file for path in paths if path.is_dir() for file in path.rglob("*")]
    files = [file for file in paths + folders if file.is_file()]
    needed = {file.relative_to(ROOT.resolve()).as_posix() for file in files}
    assert "python/src/lib.rs" in needed
    assert needed <= names
