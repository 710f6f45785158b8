"""Single damages of a program, each of which changes what the machine does."""

from __future__ import annotations

import random
import re
from typing import Callable, NamedTuple


class Damage(NamedTuple):
    """A kind of damage: which lines it takes, and what it makes of one; empty ones are dropped."""

    name: str
    takes: str
    makes: Callable[[str], str]
    #: The last of the lines, instead of any.
    last: bool = False


def shift(word: str, by: float) -> Callable[[str], str]:
    """Add to the number of a word."""
    pattern = re.compile(rf"(?<![A-Z=]){word}([-+]?\d+\.?\d*)")

    def makes(line: str) -> str:
        found = pattern.search(line)
        if found is None:
            raise ValueError(line)
        number = float(found[1]) + by
        sign = "+" if found[1].startswith("+") and number >= 0 else ""
        text = f"{number:.6f}".rstrip("0")
        return line[: found.start(1)] + sign + text + line[found.end(1) :]

    return makes


def swap(old: str, new: str) -> Callable[[str], str]:
    """Replace a text once."""
    return lambda line: line.replace(old, new, 1)


def drop(_: str) -> str:
    """Leave a line out."""
    return ""


#: The slope of the sample.
PLANE = '(0,"",0,57,0,0,0,-35.26439,30,0,0,0,0,-1,0)'
SINUMERIK = [
    Damage("X of a cut", r"G1.*X-?\d|^N\d+ X30$", shift("X", 0.1)),
    Damage("Z of a cut", r"G1.*Z-?\d", shift("Z", -0.05)),
    Damage("sign of a centre", r"G3.*J\d", swap("J", "J-")),
    Damage("rapid instead of a cut", r"G1Z|G1 Z", swap("G1", "G0")),
    Damage("feed", r"F\d+", shift("F", 100)),
    Damage("way of an arc", r"G3", swap("G3", "G2")),
    Damage("spindle speed", r"S\d+ ?M3", shift("S", 400)),
    Damage("spindle the wrong way", r"S\d+ ?M3", swap("M3", "M4")),
    Damage("no spindle", r"S\d+ ?M3", drop),
    Damage("no coolant", r"M8$", drop),
    Damage("bottom of a hole", r"CYCLE81", swap(",21.071)", ",19.071)")),
    Damage("surface of a hole", r"CYCLE81", swap(",27.071,", ",17.071,")),
]
TABLE = [
    *(damage for damage in SINUMERIK if damage.name != "feed"),
    # F of a block is worked out for its axes: up to ten times that of the tip.
    Damage("feed", r"F\d+", shift("F", 3000)),
    Damage("A of an operation", r"G0A45C", shift("A", 0.5)),
    Damage("sign of C", r"G0A45C", swap("C=-", "C=")),
    Damage("a cut left out", r"C=26\.302", drop),
    Damage("C of a cut", r"C=8\.", swap("C=8.", "C=7.")),
    # From 50 mm over the part there would be room for the turn: it comes 2 mm over it.
    Damage("no retract", r"^N\d+ G75Z0$", swap("G75Z0", "G0Z2")),
]
TRAORI = [
    *SINUMERIK,
    Damage("vector", r"A3=-0\.08", swap("A3=-0.08", "A3=-0.18")),
    Damage("sign of a vector", r"G1.*A3=", swap("B3=", "B3=-")),
    Damage("no TRAORI", r"TRAORI", drop),
    Damage("plane", r"CYCLE800\(0", swap("-35.26439", "-36.26439")),
    Damage("origin of the plane", r"CYCLE800\(0", swap(",57,0,", ",57,1,")),
    Damage("order of the turns", r"CYCLE800\(0", swap(",57,", ",27,")),
    # It is said off twice: before the axes turn back, and at the tool change.
    Damage("plane on again", r"CYCLE800\(\)", swap("()", PLANE), last=True),
]
FANUC = [
    Damage("X of a cut", r"G1.*X-?\d", shift("X", 0.1)),
    Damage("Z of a cut", r"G1.*Z-?\d", shift("Z", -0.05)),
    Damage("sign of a centre", r"G3.*I\d", swap("I", "I-")),
    Damage("rapid instead of a cut", r"G1 Z", swap("G1", "G0")),
    Damage("feed", r"F\d+", shift("F", 100)),
    Damage("way of an arc", r"G3", swap("G3", "G2")),
    Damage("spindle speed", r"S\d+ M3", shift("S", 400)),
    Damage("no coolant", r"M8$", drop),
    Damage("bottom of a hole", r"G81", shift("Z", -2)),
    Damage("R plane of a hole", r"G81", shift("R", -8)),
    Damage("register of the length", r"G43.4 .*H2", swap("H2", "H1")),
    Damage("no length", r"G43 Z", lambda line: line.replace("G43 ", "").replace(" H1", "")),
    Damage("no tool-centre control", r"G43.4", swap("G43.4", "G43")),
    Damage("no tilted plane", r"G68.2", drop),
    Damage("plane not turned to", r"G53.1", drop),
    Damage("angle of the plane", r"G68.2", shift("J", 1)),
    Damage("B of a cut", r"G1.*|X-5\. .*B-11", swap("B-11.169", "B-12.169")),
    Damage("sign of C", r"X-5\. .*C-63", swap("C-63", "C63")),
    Damage("a point lost", r"G1 X-10\.", swap("X-10.", "X-10")),
]
KLARTEXT = [
    Damage("X of a cut", r"L X.*R0 F\d|L X\+30 R0", shift("X", 0.1)),
    Damage("Z of a cut", r"L Z.*R0 F\d", shift("Z", -0.05)),
    Damage("centre", r"CC X", shift("Y", 1)),
    Damage("rapid instead of a cut", r"L Z.*F800", swap("F800", "FMAX")),
    Damage("feed", r"F\d+", shift("F", 100)),
    Damage("way of an arc", r"DR\+", swap("DR+", "DR-")),
    Damage("spindle speed", r"S4000", swap("S4000", "S400")),
    Damage("bottom of a hole", r"Q201=-6", swap("-6", "-8")),
    Damage("surface of a hole", r"Q203", swap("27.071", "17.071")),
    Damage("feed of a hole", r"Q206=", swap("150", "450")),
    Damage("no tool-centre control", r" M128", swap("M128", "M129")),
    Damage("angle of the plane", r"SPATIAL", shift("SPB", 1)),
    Damage("order of the plane", r"SPATIAL", swap("SPA-39.2315", "SPA+39.2315")),
    Damage("B of a cut", r"B\+15\.821 C-58", swap("B+15.", "B+16.")),
    Damage("sign of C", r"C-84", swap("C-84", "C+84")),
    Damage("M91 under M128", r"M129", swap("M129", "M128")),
]
LINUXCNC = [
    Damage("X of a cut", r"G1 X|^X30$", shift("X", 0.1)),
    Damage("feed", r"F\d+", shift("F", 100)),
    Damage("way of an arc", r"G3", swap("G3", "G2")),
    Damage("kinematics of the axes", r"M428", swap("M428", "M429")),
    Damage("kinematics not stated", r"M429", drop),
    Damage("C of a cut", r"C-26", swap("C-26", "C-27")),
    Damage("sign of A", r"A45", swap("A45", "A-45")),
    Damage("bottom of a hole", r"G81", shift("Z", -2)),
    Damage("register of the length", r"G43 H2", swap("H2", "H1")),
]
DAMAGES = {
    "linuxcnc-xyzac": LINUXCNC,
    "sinumerik-840d-table-ac": TABLE,
    "sinumerik-840d-traori": TRAORI,
    "fanuc-table-bc": FANUC,
    "dmu50-heidenhain": KLARTEXT,
}


def damaged(text: str, damage: Damage, seed: int) -> str | None:
    """Text with one line damaged that the kind of damage takes; nothing where there is none."""
    lines = text.split("\n")
    fit = [k for k, line in enumerate(lines) if re.search(damage.takes, line)]
    changed = []
    for k in fit:
        try:
            line = damage.makes(lines[k])
        except ValueError:
            continue
        if line != lines[k]:
            changed.append((k, line))
    if not changed:
        return None
    k, line = changed[-1] if damage.last else random.Random(seed).choice(changed)
    kept = [line] if line else []
    # Klartext counts its blocks: one that is dropped becomes a comment.
    if not kept and re.match(r"\d+ ", lines[k]):
        kept = [f"{lines[k].split()[0]} ;"]
    return "\n".join(lines[:k] + kept + lines[k + 1 :])
