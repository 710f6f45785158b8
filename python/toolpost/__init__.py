"""Turn any toolpath into a program that a machine runs, and prove it by reading it back.

>>> import toolpost
>>> program = toolpost.read("part.cls")                          # doctest: +SKIP
>>> result = toolpost.post(program, toolpost.machine("sinumerik-840d-table-ac"))  # doctest: +SKIP
>>> result.save("part.mpf")                                      # doctest: +SKIP

Lengths are mm, feeds mm/min, times s, spindle speeds 1/min, angles degrees. Whatever goes wrong is
a :class:`toolpost.Error`. Threads may share every object but a builder; what takes long lets the
others run.
"""

from ._answers import BoardResult, Error, Finding, Kind, Report, Result
from ._native import (
    Board,
    BoardBuilder,
    Builder,
    Machine,
    Program,
    Record,
    __version__,
    library,
    machine,
    pcb,
    post,
    prove,
    read,
    read_job,
    wire,
)

__all__ = [
    "Board",
    "BoardBuilder",
    "BoardResult",
    "Builder",
    "Error",
    "Finding",
    "Kind",
    "Machine",
    "Program",
    "Record",
    "Report",
    "Result",
    "__version__",
    "library",
    "machine",
    "pcb",
    "post",
    "prove",
    "read",
    "read_job",
    "wire",
]
