# SPDX-License-Identifier: GPL-2.0-or-later
"""Cutter compensation in the plane: the tool touches the part, and nothing it cannot reach."""

import random

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from g12.compensation.centre_path import tool_path
from g12.compensation.contour import Contour
from g12.errors import LONGEST_MESSAGE, Refusal
from g12.section.effects import Action
from support.contour_geometry import distance, shape_of
from support.random_contours import (
    TOLERANCE,
    as_shapely,
    contour_of,
    drawn,
    open_path,
    outline,
    points_of,
    stands,
)

LEFT, RIGHT = 41, 42


def along_part(contour):
    """Return the moves of the tool's centre along the part, without ramps."""
    path = tool_path(contour, contour.elements, TOLERANCE)
    return [move for move in path if 2 < move.line < 9000]


@pytest.mark.parametrize("side", [LEFT, RIGHT])
@pytest.mark.parametrize("sign", [1, -1])  # of the diameter in the tool table
def test_the_tools_centre_runs_on_the_boundary_of_the_grown_or_shrunk_part(side, sign):
    count = 0
    for seed in range(200):
        part = drawn(random.Random(seed))
        part = part and part._replace(side=side, radius=sign * part.radius)
        try:
            made = part and along_part(contour_of(part))
        except Refusal:
            continue
        if made:
            assert outline(part).is_valid
            grown, way = part.radius if stands(part) else -part.radius, as_shapely(made)
            ring = outline(part).buffer(grown, 100).exterior
            assert way.buffer(TOLERANCE).covers(ring), seed
            assert ring.buffer(TOLERANCE).covers(way), seed
            count += 1
    assert count > 70


# Joints, one at a time: lines in, coordinates of the tool's centre out.


def joined(*blocks, side=LEFT, radius=2.0):
    """Return the places where the tool's centre ends each block, rounded."""
    contour = Contour(10.0, 0.0, 0.0)
    contour.compensate(side, radius, at=1)
    contour.straight(10.0, 5.0, at=1, feed=100.0)
    for line, block in enumerate(blocks, 2):
        block(contour, line)
    contour.compensate(40, 0.0, at=50)
    contour.straight(30.0, -20.0, at=50, feed=100.0)
    path = tool_path(contour, contour.elements, TOLERANCE)
    moves = [element for element in path if hasattr(element, "curve")]
    return {move.line: (round(move.end.real, 6), round(move.end.imag, 6)) for move in moves}


def to(x, c):
    return lambda contour, line: contour.straight(x, c, at=line, feed=100.0)


def mark(contour, line):
    contour.mark(Action(line, "M8", None))


# What the tool cannot reach.


def round_to(turn, x, c, radius):
    return lambda contour, line: contour.arc(turn, x, c, radius=radius, at=line, feed=100.0)


BETWEEN = (
    "line {}: the arc of radius 1.5 is smaller than the tool radius 2 (between lines {} and {})"
)
CORNER = "line 3: the tool of radius 2 cannot reach both lines 2 and 3: their corner is too tight"
SHORT = "line 4: too short for the tool radius 2 between its inside corners with lines 2 and 5"


@pytest.mark.parametrize(
    ("blocks", "message"),
    [
        ([to(20, 5), round_to(1, 20, 8, 1.5), to(10, 8)], BETWEEN.format(3, 2, 4)),
        ([round_to(1, 12, 7, 1.5), to(12, 30)], BETWEEN.format(2, 1, 3)),
        ([to(20, 5), round_to(1, 20, 8, 1.5)], BETWEEN.format(3, 2, 50)),
        ([to(20, 5), to(20, 6), to(30, 6)], CORNER),
        ([to(20, 5), round_to(1, 18, 8, 3.0), to(10, 8)], CORNER),
        ([to(20, 5), round_to(1, 18, 6.5, 2.6), to(10, 12)], CORNER),
        ([to(20, 5), mark, to(20, 8), to(10, 8)], SHORT),
        ([], "line 50: G40 follows G41 of line 1 with nothing between them to cut"),
    ],
)
def test_too_tight_names_both_lines(blocks, message):
    with pytest.raises(Refusal) as refused:
        joined(*blocks)
    assert refused.value.message == f"G12.1 {message}"
    assert len(refused.value.message) < LONGEST_MESSAGE


@settings(max_examples=150)
@given(st.randoms(use_true_random=False))
def test_any_contour_is_cut_at_the_tools_radius_or_refused(draw):
    part = open_path(draw)
    assume(part)
    contour = contour_of(part)
    try:
        made = along_part(contour)
    except Refusal as refusal:
        assert refusal.message.startswith("G12.1 line ")
        return
    for move in made:
        own = part.shapes[move.line - 3 : move.line - 1]  # nearly straight ones are cut as one
        off = [abs(shape.distance(points_of(move)) - part.radius) for shape in own]
        at_radius = np.min(off, axis=0).max() <= TOLERANCE
        assert at_radius or is_cut_deeper_elsewhere(own, move, made, part.radius)


def is_cut_deeper_elsewhere(walls, move, made, radius):
    """Tell whether each point that a move gouges is cut deeper by another portion: a spiral."""
    others = [shape_of(each.curve) for each in made if abs(each.line - move.line) > 1]
    points = np.concatenate([points_of(wall) for wall in walls])
    away = shape_of(move.curve).distance(points)
    gouged = away < radius - TOLERANCE
    return gouged.any() and others and (distance(points, others) < away)[gouged].all()
