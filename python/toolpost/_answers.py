"""What Toolpost answers: programs with their reports, findings, errors."""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence
    from typing import Any


class Kind(enum.IntEnum):
    """What a move is, in :attr:`Program.kinds`."""

    RAPID = 0
    LINE = 1
    ARC = 2
    THREAD = 3
    PROBE = 4
    HOLE = 5


class Finding(NamedTuple):
    """What there is to say about a place in a file.

    Attributes
    ----------
    severity : str
        ``error`` or ``warning``.
    rule : str
        Short name of the rule, which does not change: ``axis-limit``, ``zero-vector``.
    message : str
        What is wrong, with values and units.
    help : str
        The way out.
    file : str
        Name of the file; empty where there is none.
    line, column : int
        Where it is, from 1; 0 where it is about the whole of the file, or of the line.
    excerpt : str
        The line, with a mark under the place.
    times : int
        How often it was found, or one like it that is not listed.
    text : str
        All of that, as the command line prints it.
    """

    severity: str
    rule: str
    message: str
    help: str
    file: str
    line: int
    column: int
    excerpt: str
    times: int
    text: str

    def __str__(self) -> str:
        return self.text


class Error(Exception):
    """Why there is no result; nothing was changed.

    ``rule``, ``message``, ``help``, ``file``, ``line`` and ``column`` are those of the first error.

    Attributes
    ----------
    findings : tuple of Finding
        Everything that was found, warnings too; at least one is an error.
    report : Report or None
        Of a program that was written and is not proven.
    """

    def __init__(self, findings: Sequence[Finding]) -> None:
        super().__init__(findings)
        self.findings: tuple[Finding, ...] = tuple(findings)
        self.report: Report | None = None
        errors = (finding for finding in self.findings if finding.severity == "error")
        first = next(errors, self.findings[0])
        self.rule, self.message, self.help = first.rule, first.message, first.help
        self.file, self.line, self.column = first.file, first.line, first.column

    def __str__(self) -> str:
        return "\n".join(str(finding) for finding in self.findings)


class Report:
    """The result of comparing a program with its toolpath; a table in a notebook.

    Attributes
    ----------
    proven : bool
        Whether the program makes the motion of the toolpath.
    rows : tuple of pairs of str
        What a person wants to know, each under its head.
    findings : tuple of Finding
        What is wrong, where it is not proven; and what is worth knowing.
    json : str
        The report in full, as it is saved next to the program.
    """

    def __init__(
        self,
        proven: bool,
        rows: Sequence[tuple[str, str]],
        findings: Sequence[Finding],
        json: str,
    ) -> None:
        self.proven = proven
        self.rows = tuple(rows)
        self.findings = tuple(findings)
        self.json = json

    def data(self) -> dict[str, Any]:
        """Give the report in full: the ``json`` as a dictionary."""
        import json  # noqa: PLC0415 - only who asks for it waits for it

        data: dict[str, Any] = json.loads(self.json)
        return data

    def __repr__(self) -> str:
        return f"<Report: {'proven' if self.proven else 'NOT proven'}>"

    def __str__(self) -> str:
        wide = max((len(head) for head, _ in self.rows), default=0)
        lines = [f"{head:{wide}}  {text}" for head, text in self.rows]
        return "\n".join(lines + [str(finding) for finding in self.findings])

    def _repr_html_(self) -> str:
        from html import escape  # noqa: PLC0415 - only a notebook asks for it

        cells = [f"<th>{escape(head)}</th><td>{escape(text)}</td>" for head, text in self.rows]
        found = [
            f"<th>{escape(f.severity)}</th><td><pre>{escape(f.text)}</pre></td>"
            for f in self.findings
        ]
        return "<table>" + "".join(f"<tr>{row}</tr>" for row in cells + found) + "</table>"


class Result:
    """A proven program.

    Attributes
    ----------
    data : bytes
        The program, as it is saved.
    report : Report
        The findings about it.
    parts : dict of str to bytes
        The files that it calls, by their names: those of a robot's program that is larger than its
        controller takes. Empty where the program is whole.
    """

    def __init__(
        self,
        data: bytes,
        report: Report,
        inputs: Sequence[str | os.PathLike[str]] = (),
        parts: dict[str, bytes] | None = None,
    ) -> None:
        self.data = data
        self.report = report
        self.parts = dict(parts or {})
        # The files that it was made of, which stay.
        self._inputs = tuple(inputs)

    @property
    def text(self) -> str:
        """The program."""
        return self.data.decode()

    def save(self, path: str | os.PathLike[str], *, report: bool = True) -> None:
        """Save the program, the files that it calls and its report next to it: all or none.

        Parameters
        ----------
        path : str or os.PathLike
            Where; the report is there under its name and ``.report.json``. None of
            them can be a file that the program was made of.
        report : bool
            Whether the report is saved too.

        Raises
        ------
        toolpost.Error
            Where that cannot be done; what was there before is as it was.
        """
        from ._native import save  # noqa: PLC0415 - which imports this module

        saved = self.report.json if report else None
        save(path, self.data, list(self.parts.items()), saved, self._inputs)

    def __repr__(self) -> str:
        return f"<Result: {len(self.data)} bytes, {self.report!r}>"


class BoardResult:
    """The proven programs of a circuit board.

    Attributes
    ----------
    programs : dict of str to bytes
        The programs by their names (``front``, ``drill``), in the order in which they are run.
    left_out : tuple of str
        The programs that cannot be made; the findings of the report say why.
    files : dict of str to bytes
        All that is saved, by file name: programs, pictures and the report.
    report : Report
        What is reported of all programs together.
    """

    def __init__(
        self,
        files: dict[str, bytes],
        order: Sequence[str],
        report: Report,
        inputs: Sequence[str | os.PathLike[str]] = (),
    ) -> None:
        self.files = files
        self.programs = {file.rsplit(".", 1)[0]: files[file] for file in order}
        self.report = report
        self.left_out = tuple(str(left["name"]) for left in report.data()["left_out"])
        # The files that they were made of, which stay.
        self._inputs = tuple(inputs)

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Save all files in a folder, which is made where it is missing: all or none.

        Parameters
        ----------
        folder : str or os.PathLike
            Where. No file can be one that the programs were made of.

        Raises
        ------
        toolpost.Error
            Where that cannot be done; what was there before is as it was.
        """
        from ._native import save_in  # noqa: PLC0415 - which imports this module

        save_in(folder, list(self.files.items()), self._inputs)

    def __repr__(self) -> str:
        return f"<BoardResult: {', '.join(self.programs)}, {self.report!r}>"
