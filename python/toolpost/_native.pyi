# The compiled part. Its docstrings explain each name: help(toolpost.post).

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, SupportsIndex, TypeAlias, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._answers import BoardResult, Finding, Report, Result

__all__ = [
    "Board",
    "BoardBuilder",
    "Builder",
    "Machine",
    "Program",
    "Record",
    "__version__",
    "library",
    "machine",
    "pcb",
    "post",
    "prove",
    "read",
    "read_job",
    "run_command",
    "save",
    "save_in",
    "wire",
]

__version__: str

_Path: TypeAlias = str | os.PathLike[str]
_Point: TypeAlias = Sequence[float] | NDArray[np.float64]
_Floats: TypeAlias = NDArray[np.float64]
_Tuple3: TypeAlias = tuple[float, float, float]

_Node: TypeAlias = str | Sequence[float] | NDArray[np.float64]
_Layer: TypeAlias = Literal["front", "back", "both"]
_Part: TypeAlias = Literal[
    "front",
    "back",
    "drill",
    "outline",
    "front-mask",
    "back-mask",
    "front-legend",
    "back-legend",
]

@final
class Board:
    @staticmethod
    def builder(name: str = "board") -> BoardBuilder: ...
    @property
    def name(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def warnings(self) -> tuple[Finding, ...]: ...
    @property
    def extents(self) -> tuple[tuple[float, float], tuple[float, float]]: ...
    def save(self, path: _Path) -> None: ...

@final
class BoardBuilder:
    def node(self, name: str, position: _Point) -> BoardBuilder: ...
    def track(
        self,
        nodes: Sequence[_Node],
        width: float,
        *,
        layer: _Layer = "front",
        net: str | None = None,
    ) -> BoardBuilder: ...
    def pad(
        self,
        node: _Node,
        shape: Literal["circle", "square", "octagon"],
        size: float,
        *,
        rotation: float = 0.0,
        layer: _Layer = "front",
        net: str | None = None,
    ) -> BoardBuilder: ...
    def hole(self, node: _Node, diameter: float, *, plated: bool | None = None) -> BoardBuilder: ...
    def edge(self, nodes: Sequence[_Node]) -> BoardBuilder: ...
    def group(
        self,
        name: str,
        group: BoardBuilder,
        at: _Node,
        *,
        rotation: float = 0.0,
        mirrored: bool = False,
    ) -> BoardBuilder: ...
    def build(self) -> Board: ...

@final
class Record:
    @property
    def kind(self) -> str: ...
    @property
    def line(self) -> int: ...
    @property
    def point(self) -> _Tuple3 | None: ...
    @property
    def axis(self) -> _Tuple3 | None: ...
    @property
    def words(self) -> dict[str, Any]: ...

@final
class Program:
    @staticmethod
    def builder(name: str = "part") -> Builder: ...
    @property
    def name(self) -> str: ...
    @property
    def file(self) -> str: ...
    @property
    def dialect(self) -> str: ...
    @property
    def warnings(self) -> tuple[Finding, ...]: ...
    @property
    def positions(self) -> _Floats: ...
    @property
    def axes(self) -> _Floats: ...
    @property
    def feeds(self) -> _Floats: ...
    @property
    def lines(self) -> NDArray[np.uint32]: ...
    @property
    def kinds(self) -> NDArray[np.uint8]: ...
    @property
    def records(self) -> NDArray[np.uint64]: ...
    def statistics(self) -> dict[str, Any]: ...
    def svg(self) -> str: ...
    def _repr_svg_(self) -> str: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: SupportsIndex, /) -> Record: ...
    @overload
    def __getitem__(self, index: slice, /) -> list[Record]: ...
    def __iter__(self) -> Iterator[Record]: ...

@final
class Builder:
    def rapid(self, point: _Point, axis: _Point | None = None) -> Builder: ...
    def line(self, point: _Point, axis: _Point | None = None) -> Builder: ...
    def arc(
        self,
        end: _Point,
        center: _Point,
        *,
        clockwise: bool = False,
        normal: _Point = ...,
        turns: int = 0,
    ) -> Builder: ...
    def drill(
        self,
        points: Sequence[_Point] | _Floats,
        depth: float,
        *,
        clearance: float,
        retract: float | None = None,
        kind: Literal[
            "drill", "deep", "break-chip", "tap", "ream", "bore", "fine-bore", "back-bore"
        ] = "drill",
        feed: float | None = None,
        dwell: float = 0.0,
        peck: float | None = None,
        first_peck: float | None = None,
        pitch: float | None = None,
        left: bool = False,
        aside: _Point | None = None,
        angle: float | None = None,
        axis: _Point | None = None,
    ) -> Builder: ...
    def tool(
        self,
        number: int,
        name: str = "",
        *,
        diameter: float | None = None,
        corner_radius: float | None = None,
        length: float | None = None,
        offset: int | None = None,
    ) -> Builder: ...
    def feed(
        self, feed: float, unit: Literal["mm/min", "mm/rev", "1/min"] = "mm/min"
    ) -> Builder: ...
    def spindle(self, speed: float, *, clockwise: bool = True) -> Builder: ...
    def coolant(
        self, coolant: Literal["off", "flood", "mist", "flood-and-mist", "through"]
    ) -> Builder: ...
    def compensation(
        self,
        side: Literal["off", "left", "right"],
        register: int | None = None,
        *,
        path: Literal["centre", "contour"] | None = None,
    ) -> Builder: ...
    def work_offset(self, number: int) -> Builder: ...
    def home(self) -> Builder: ...
    def dwell(self, seconds: float) -> Builder: ...
    def stop(self, *, optional: bool = False) -> Builder: ...
    def output(self, number: int, value: bool | float, *, with_motion: bool = False) -> Builder: ...
    def auxiliary(self, number: int) -> Builder: ...
    def operation(self, name: str) -> Builder: ...
    def comment(self, text: str) -> Builder: ...
    def message(self, text: str) -> Builder: ...
    def build(self) -> Program: ...

@final
class Machine:
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def control(self) -> str: ...
    @property
    def reader(self) -> str: ...
    @property
    def extension(self) -> str: ...
    @property
    def rotary(self) -> tuple[str, ...]: ...
    @property
    def wire(self) -> bool: ...
    def inverse(
        self, points: ArrayLike, axes: ArrayLike, tool_length: float = 0.0
    ) -> tuple[_Floats, _Floats]: ...
    def forward(
        self, linear: ArrayLike, rotary: ArrayLike, tool_length: float = 0.0
    ) -> tuple[_Floats, _Floats]: ...

def read(
    path: _Path,
    control: _Path | None = None,
    *,
    tools: _Path | None = None,
    folders: Sequence[_Path] = ...,
    whole_numbers: Literal["units", "increments"] | None = None,
    units: Literal["mm", "inch"] | None = None,
    aside: Literal["+X", "-X", "+Y", "-Y"] | None = None,
    csys: Literal["local", "world"] | None = None,
    cutcom: Literal["centre", "contour"] | None = None,
    block_delete: bool = False,
    start: _Point | None = None,
    strict: bool = False,
) -> Program: ...
def read_job(
    job: dict[str, Any] | str | bytes,
    machine: Machine | None = None,
    *,
    file: str = "job.json",
    strict: bool = False,
) -> Program: ...
def machine(name_or_path: _Path, /, **options: str | float | bool) -> Machine: ...
def library() -> list[Machine]: ...
def post(
    program: Program, machine: Machine, *, file: str | None = None, tolerance: float | None = None
) -> Result: ...
def prove(
    text: str | bytes,
    machine: Machine,
    program: Program,
    *,
    file: str = "program",
    tolerance: float | None = None,
    parts: dict[str, bytes] | None = None,
) -> Report: ...
def wire(
    path: _Path,
    machine: Machine,
    control: _Path | None = None,
    *,
    side: Literal["inside", "outside", "part", "left", "right"] | None = None,
    wire: float = 0.0,
    gap: float = 0.0,
    leave: Sequence[float] = ...,
    trims: Literal["alternate", "repeat"] = "alternate",
    thread: Sequence[_Point] = ...,
    lead: float = 0.0,
    lead_arc: float | None = None,
    begin: _Point | None = None,
    tab: float | None = None,
    taper: float | None = None,
    rounding: Literal["conical", "constant"] = "conical",
    by_control: bool = False,
    round_corners: bool = False,
    feed: Sequence[float] = ...,
    upper: _Path | None = None,
    sync: Literal["block", "length"] = "block",
    height: float | None = None,
    uv_height: float | None = None,
    layers: Sequence[str] = ...,
    close: float = 0.01,
    step: float | None = None,
    chord_error: float | None = None,
    fit: bool = False,
    memory: int | None = None,
    file: str | None = None,
    tolerance: float | None = None,
    strict: bool = False,
) -> Result: ...
def pcb(
    board: Board | _Path | Sequence[_Path],
    machine: Machine,
    *,
    only: Sequence[_Part] = ...,
    unit: Literal["mm", "inch"] | None = None,
    tool: float | Sequence[float] | None = None,
    vee: float | None = None,
    tip: float = 0.1,
    depth: float = 0.1,
    step: float | None = None,
    passes: int = 1,
    isolation_width: float | None = None,
    overlap: float = 0.25,
    direction: Literal["climb", "conventional"] = "climb",
    narrow: Literal["bite", "leave-out", "middle"] = "bite",
    isolate: Literal["contours", "middle", "lines"] = "contours",
    invert: bool = False,
    clear: Sequence[float] = ...,
    margin: float = 0.0,
    mask_tool: float | None = None,
    legend_tool: float | None = None,
    engrave: float = 0.05,
    drills: Sequence[float] = ...,
    drill_tolerance: float = 0.05,
    hole_mill: float | None = None,
    mill_holes_over: float | None = None,
    peck: float | None = None,
    from_side: Literal["front", "back"] = "front",
    outline_tool: float = 2.0,
    outline_step: float = 0.5,
    tabs: int = 4,
    tab_at: Sequence[_Point] = ...,
    tab_width: float = 2.0,
    tab_height: float = 0.6,
    close_gaps: float = 0.3,
    board_margin: float | None = None,
    rectangular: bool = False,
    thickness: float = 1.6,
    through: float = 0.2,
    rotate: float = 0.0,
    corner: _Point | None = None,
    as_drawn: bool = False,
    turn: Literal["y", "x"] = "y",
    alignment: float | None = None,
    panel: tuple[int, int] | None = None,
    spacing: float = 4.0,
    feed: float = 200.0,
    plunge: float = 60.0,
    drill_feed: float = 100.0,
    outline_feed: float = 150.0,
    speed: float | None = None,
    travel: float = 2.0,
    approach: float = 0.5,
    spin_up: float | None = None,
    text_before: Sequence[str] = ...,
    text_after: Sequence[str] = ...,
    probe: tuple[int, int] | None = None,
    on_control: bool = False,
    split_tools: bool = False,
    heights: _Path | None = None,
    picture: Literal["svg", "png"] | None = None,
    tolerance: float | None = None,
    strict: bool = False,
) -> BoardResult: ...
def save_in(
    folder: _Path, contents: Sequence[tuple[str, bytes]], inputs: Sequence[_Path]
) -> None: ...
def save(
    path: _Path,
    text: bytes,
    parts: Sequence[tuple[str, bytes]],
    report: str | None,
    inputs: Sequence[_Path],
) -> None: ...
def run_command(words: Sequence[str], helper: Sequence[str]) -> int: ...
