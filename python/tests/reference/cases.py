"""Post a source for a machine, run the program on the reference, and judge it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from .cldata import Source
from .control import Control
from .fanuc import Fanuc
from .judge import Judge, Limits, Verdict
from .klartext import Klartext
from .linuxcnc import LinuxCNC
from .machine import Machine, library, load
from .sinumerik import Sinumerik

ROOT = Path(__file__).resolve().parents[3]
READERS: dict[str, Any] = {
    "sinumerik-840d-table-ac": Sinumerik,
    "sinumerik-840d-traori": Sinumerik,
    "fanuc-table-bc": Fanuc,
    "dmu50-heidenhain": Klartext,
    "linuxcnc-xyzac": LinuxCNC,
    "linuxcnc-xyzbc": LinuxCNC,
    "linuxcnc-xyzbc-head": LinuxCNC,
}


def reference(name: str) -> Machine:
    """Give a machine of the library as the reference sees it."""
    return load(*library(ROOT, name))


def judge(
    name: str,
    machine: Machine,
    source: Source,
    text: str,
    starts: int = 2,
    limits: Limits | None = None,
) -> Verdict:
    """Run a program from one or two places of the axes at its start, and compare each time.

    The second time, endless rotary axes whose file does not say so count modulo 360 degrees.
    """
    verdict = Verdict()
    lengths = {0: 120.0, **source.lengths}
    for corner, modulo in ((machine.low, False), (machine.high, True))[:starts]:
        start = (float(corner[0]), float(corner[1]))
        control: Control = READERS[name](machine, lengths, start, modulo=modulo)
        control.run(text)
        found = Judge(source, control, limits).verdict
        verdict.faults += found.faults
        verdict.samples += found.samples
        verdict.off = max(verdict.off, found.off)
        verdict.fastest = max(verdict.fastest, found.fastest)
        verdict.slowest = min(verdict.slowest, found.slowest)
    return verdict


def stated(name: str, zero: list[float], points: dict[str, list[float]]) -> str:
    """Text of a machine of the library, with a work zero and centres of its rotary axes."""
    text = library(ROOT, name)[0]
    text = re.sub(r"^work_zero = .*\n", "", text, flags=re.MULTILINE)
    text = re.sub(
        r"^(extends = .*)$", rf"\1\nwork_zero = {zero}", text, count=1, flags=re.MULTILINE
    )
    for letter, point in points.items():
        head, tail = text.split(f'letter = "{letter}"\n')
        tail = re.sub(r"^point = .*\n", "", tail, count=1, flags=re.MULTILINE)
        text = f'{head}letter = "{letter}"\npoint = {point}\n{tail}'
    return text


#: A work zero and centres for machines whose files state none: nothing is where it would be easy.
STATED = {
    "sinumerik-840d-table-ac": ([40, -25, -190], {"A": [5, 10, -260], "C": [20, -10, -240]}),
    "sinumerik-840d-traori": ([150, 80, -560], {"C": [0, 0, 0], "A": [0, 30, 220]}),
    "fanuc-table-bc": ([30, -20, -150], {"B": [10, 0, -210], "C": [20, -15, -200]}),
    "linuxcnc-xyzac": ([40, -25, -90], {"A": [5, 10, -160], "C": [20, -10, -140]}),
    "linuxcnc-xyzbc": ([30, -20, -100], {"B": [10, 0, -160], "C": [20, -15, -150]}),
    "linuxcnc-xyzbc-head": ([150, 80, -160], {"C": [0, 0, 0], "B": [30, 0, 250]}),
    "dmu50-heidenhain": ([25, -15, -120], {"B": [0, 5, -160], "C": [15, -10, -150]}),
}
