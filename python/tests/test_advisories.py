"""What `scripts/advisories` makes of the answer, of no network, and of no cargo-deny."""

from __future__ import annotations

import os
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

from conftest import ROOT

if TYPE_CHECKING:
    from pathlib import Path

DATABASE = "https://github.com/RustSec/advisory-db"


def asked(folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the script with what lies in `folder/bin` before everything else."""
    path = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        [ROOT / "scripts" / "advisories"],
        env={**os.environ, "PATH": path, **environment},
        check=False,
        capture_output=True,
        text=True,
    )


def command(folder: Path, name: str, text: str) -> None:
    (folder / "bin").mkdir(exist_ok=True)
    file = folder / "bin" / name
    file.write_text(f"#!/bin/sh\n{text}\n")
    file.chmod(0o755)


@pytest.mark.parametrize("code", [0, 1])
def test_the_locks_of_the_project_and_of_the_fuzz_targets_are_asked_for(
    tmp_path: Path, code: int
) -> None:
    log = tmp_path / "log"
    command(tmp_path, "git", "exit 0")
    command(tmp_path, "cargo-deny", f'echo "$@" >> {log}; exit {code}')
    done = asked(tmp_path)
    assert done.returncode == code
    calls = log.read_text().splitlines()
    project = "deny --locked check advisories"
    fuzz = "deny --locked --manifest-path fuzz/Cargo.toml --config deny.toml check advisories"
    # A weakness that is known ends it at once.
    assert calls == ([project, fuzz] if code == 0 else [project])


def test_where_the_database_does_not_answer_nothing_is_asked(tmp_path: Path) -> None:
    command(tmp_path, "git", "exit 128")
    command(tmp_path, "cargo-deny", "exit 1")
    done = asked(tmp_path)
    assert (done.returncode, done.stdout) == (
        0,
        f"advisories: not asked: {DATABASE} does not answer\n",
    )


@pytest.mark.skipif(shutil.which("cargo-deny") is None, reason="there is no cargo-deny")
@pytest.mark.parametrize(("crate", "code"), [("libc", 1), ("of-nobody", 0)])
def test_a_weakness_in_a_database_made_by_hand_is_found(
    tmp_path: Path, crate: str, code: int
) -> None:
    database = tmp_path / "db"
    entry = database / "crates" / crate / "RUSTSEC-2026-9001.md"
    entry.parent.mkdir(parents=True)
    entry.write_text(
        f'```toml\n[advisory]\nid = "RUSTSEC-2026-9001"\npackage = "{crate}"\n'
        'date = "2026-11-24"\n\n[versions]\npatched = [">= 99999.0.0"]\n```\n\n'
        "# Made by hand\n\nNo weakness at all.\n"
    )
    author = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
    for words in (["init", "-q", "-b", "main"], ["add", "-A"], [*author, "commit", "-qm", "a"]):
        subprocess.run(["git", *words], cwd=database, check=True)
    git = tmp_path / "gitconfig"
    git.write_text(f'[url "file://{database}"]\n\tinsteadOf = {DATABASE}\n')
    # The copies that cargo-deny keeps stay here.
    home = tmp_path / "cargo"
    home.mkdir()
    real = os.environ.get("CARGO_HOME", os.path.expanduser("~/.cargo"))
    for name in os.listdir(real):
        if not name.startswith("advisory"):
            (home / name).symlink_to(os.path.join(real, name))
    done = asked(tmp_path, GIT_CONFIG_GLOBAL=str(git), CARGO_HOME=str(home))
    assert done.returncode == code, done.stdout + done.stderr
    assert ("RUSTSEC-2026-9001" in done.stdout + done.stderr) == (code == 1)
