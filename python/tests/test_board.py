"""Boards that are built."""

from __future__ import annotations

import json
import math

import pytest

import toolpost
from toolpost import Board


def resistor():
    built = Board.builder()
    for node, x in ("a", -5.08), ("b", 5.08):
        built.node(node, (x, 0)).pad(node, "circle", 1.8).hole(node, 0.8, plated=False)
    return built


def test_a_board_says_what_was_built():
    board = (
        Board.builder("lamp")
        .node("plus", (4, 14))
        .pad("plus", "square", 2, rotation=45, layer="both", net="+5V")
        .track(["plus", (20, 14)], 0.8)
        .hole("plus", 1)
        .edge([(0, 0), (30, 0), (30, 20), (0, 20)])
        .build()
    )
    assert json.loads(board.text) == {
        "name": "lamp",
        "nodes": {"plus": [4, 14]},
        "pads": [
            {
                "node": "plus",
                "shape": "square",
                "size": 2,
                "rotation": 45,
                "layer": "both",
                "net": "+5V",
            }
        ],
        "tracks": [{"nodes": ["plus", [20, 14]], "width": 0.8, "layer": "front"}],
        "holes": [{"node": "plus", "diameter": 1}],
        "edges": [{"nodes": [[0, 0], [30, 0], [30, 20], [0, 20]]}],
    }
    assert board.name == "lamp"
    assert board.extents == ((0, 0), (30, 20))
    assert board.warnings == ()
    assert repr(board) == "<Board lamp>"


def test_groups_are_copies_in_their_places():
    part = resistor()
    board = Board.builder().group("R1", part, (10, 0)).group("R2", part, (0, 10), rotation=90)
    part.hole((50, 50), 1)
    low, high = board.build().extents
    # Both ends of the first, the lower and the upper end of the second.
    assert low == pytest.approx((-0.9, -0.9))
    assert high == pytest.approx((10 + 5.08 + 0.9, 10 + 5.08 + 0.9))
    mirrored = Board.builder().group("R1", part, (0, 0), mirrored=True).build()
    assert json.loads(mirrored.text)["groups"][0]["mirrored"] is True


def test_what_is_saved_is_the_text(tmp_path):
    board = Board.builder("one").hole((1, 2), 3).build()
    board.save(tmp_path / "one.json")
    assert (tmp_path / "one.json").read_text() == board.text


def test_warnings_are_reported():
    outside = Board.builder().edge([(0, 0), (9, 0), (9, 9)]).hole((50, 1), 1).hole((5, 1), 1)
    assert [found.rule for found in outside.build().warnings] == ["layers-shifted", "hole-outside"]


@pytest.mark.parametrize(
    ("wrong", "rule"),
    [
        (lambda board: board.hole("nowhere", 1), "node-unknown"),
        (lambda board: board.hole((0, 0), -1), "width"),
        (lambda board: board.pad((0, 0), "oval", 1), "board-file"),
        (lambda board: board.track([(0, 0)], 1), "node"),
        (lambda board: board, "no-board"),
    ],
)
def test_what_is_no_board_is_refused(wrong, rule):
    with pytest.raises(toolpost.Error) as raised:
        wrong(Board.builder()).build()
    assert raised.value.rule == rule


def test_what_no_board_can_say_is_refused_at_once():
    board = Board.builder().node("a", (0, 0))
    with pytest.raises(toolpost.Error, match="NaN"):
        board.hole((math.nan, 0), 1)
    with pytest.raises(toolpost.Error, match="already"):
        board.node("a", (1, 1))
    with pytest.raises(toolpost.Error, match="inf"):
        board.track(["a", (1, 1)], math.inf)
    assert json.loads(board.hole("a", 1).build().text)["nodes"] == {"a": [0, 0]}


def test_groups_lie_as_deep_as_they_may_and_no_deeper():
    nest = resistor()
    for _ in range(64):
        nest = Board.builder().group("g", nest, (0, 0))
    assert nest.build().extents[0] == pytest.approx((-5.98, -0.9))
    with pytest.raises(toolpost.Error, match="more than 64 deep") as raised:
        Board.builder().group("g", nest, (0, 0))
    assert raised.value.rule == "group"


def test_copies_of_copies_end():
    def fourfold(nest):
        outer = Board.builder()
        for name in "abcd":
            outer.group(name, nest, (0, 0))
        return outer

    nest = resistor()
    # Some 300 bytes; the eighth time they would be more than 16 MiB.
    for _ in range(7):
        nest = fourfold(nest)
    with pytest.raises(toolpost.Error, match="bytes are no board") as raised:
        fourfold(nest)
    assert raised.value.rule == "board-file"
