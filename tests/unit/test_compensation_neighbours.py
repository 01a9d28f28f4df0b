# SPDX-License-Identifier: GPL-2.0-or-later
"""Contours of one section: a deep cut of one into another is refused, what is right is cut.

Judged by shapely: the path of the tool's centre along one contour against the other's outline.
"""

import cmath
import math
import random
from collections import Counter

import pytest
from shapely.ops import nearest_points

from g12.compensation.contour import Contour
from g12.errors import Refusal
from support import random_contours
from support.contour_geometry import Round, Straight, lines
from support.planned_cuts import add
from support.random_contours import (
    TOLERANCE,
    Drawn,
    as_shapely,
    away,
    blind_path,
    closed,
    contour_of,
    depth,
    drawn,
    outline,
    polygon,
    stands,
)

LEFT, RIGHT = 41, 42
UP = 5.0
ALLOWANCE = 0.5  # of the tool's radius: what is cut deeper is refused


def section(*parts, ramp=None):
    """Return a section of contours, each what is drawn and its Z; ``ramp``: to it and from it.

    Z may be that of each shape.
    """
    contour, line = Contour(90.0, 0.0, UP), 1
    for part, height in parts:
        heights = height if isinstance(height, list) else [height] * len(part.shapes)
        first, last = part.shapes[0], part.shapes[-1]
        start = first.start + (ramp or away(part)) * first.direction(0.0)
        end = last.end + (ramp or away(part)) * last.direction(1.0)
        contour.straight(start.real, start.imag, at=line, feed=300.0)
        contour.straight(height=heights[0], at=line, feed=300.0)
        contour.compensate(part.side, part.radius, at=line + 1)
        contour.straight(first.start.real, first.start.imag, at=line + 1, feed=300.0)
        for after, (z, shape) in enumerate(zip(heights, part.shapes), line + 2):
            contour.straight(height=z, at=after, feed=300.0)
            add(contour, shape, line=after, feed=300.0)
        line += 2 + len(part.shapes)
        contour.compensate(40, 0.0, at=line)
        contour.straight(end.real, end.imag, at=line, feed=300.0)
        contour.straight(height=UP, at=line + 1, feed=300.0)
        line += 2
    return contour


def refusal(*parts, ramp=None):
    """Return the message with which a section is refused, or what is told of it."""
    contour = section(*parts, ramp=ramp)
    return random_contours.refusal(contour) or "".join(contour.notes)


def is_refused(*parts, ramp=None):
    return "cuts into the other" in refusal(*parts, ramp=ramp)


def boss(shapes, radius=6.0):
    """Return what stands: the tool is outside of clockwise shapes."""
    return Drawn(shapes, LEFT, radius, shapes)


def pocket(shapes, radius=6.0):
    """Return what is hollow: the tool is inside of clockwise shapes."""
    return Drawn(shapes, RIGHT, radius, shapes)


def way_back(part):
    """Return lines that are cut the other way round, from the same side."""
    shapes = [shape.portion(1.0, 0.0) for shape in reversed(part.shapes)]
    return part._replace(shapes=shapes, body=shapes, side=LEFT + RIGHT - part.side)


def circle(radius, at=0j):
    return [Round(at + radius, at, -2 * math.pi)]


def regular(count, radius, at=0j):
    return polygon([at + cmath.rect(radius, -2 * math.pi * k / count) for k in range(count)])


def slot(width, length, at=0j, turn=0.0):
    across, along = 0.5j * width * cmath.rect(1, turn), 0.5 * (length - width) * cmath.rect(1, turn)
    ends = [at + across, at + across + along, at - across + along]
    return [
        Straight(ends[0], ends[1]),
        Round(ends[1], at + along, -math.pi),
        Straight(ends[2], at - across - along),
        Round(at - across - along, at - along, -math.pi),
        Straight(at + across - along, ends[0]),
    ]


HEXAGON = boss(regular(6, 15.6))
FLATS = [boss([Straight(turn * (13.5 + 25j), turn * (13.5 - 25j))]) for turn in (1, 1j, -1, -1j)]


# What shops make.


@pytest.mark.parametrize(
    "parts",
    [
        [(HEXAGON, -5.0), (pocket(slot(14, 40, at=40.0)), -5.0)],  # a slot beside
        [(boss(regular(6, 17.0)), -5.0), (HEXAGON, -5.0)],  # a roughing pass first
        [(HEXAGON, -float(k)) for k in range(1, 6)],
        [(HEXAGON, -5.0), (pocket(slot(14, 60, turn=0.5)), -5.0)],  # across, as deep
        [(HEXAGON, -5.0), (pocket(slot(14, 60, turn=0.9)), -3.0)],
        [(HEXAGON, -5.0), (pocket(circle(9.0), 4.0), -5.0)],
        [(boss(circle(9.0), 2.0), -5.0), (pocket(circle(14.0), 2.0), -5.0)],  # a groove
        [(pocket(circle(7.5)), -5.0), (pocket(slot(14.5, 50)), -5.0)],  # a hole to go down in
        [(boss(regular(6, 17.0)), -5.0), (way_back(HEXAGON), -5.0)],  # finished the other way
        [(flat, -5.0) for flat in FLATS],
        [(FLATS[0], -5.0), (boss(circle(5.0, at=25.0)), -5.0)],  # its end is in the air
        [*((boss(circle(r)), -1.0) for r in (15, 5)), (pocket(circle(10.0)), -1.0)],  # a pip
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_what_is_right_is_cut_in_any_order(parts, turned):
    assert refusal(*parts[:: -1 if turned else 1]) == ""


def near(gap, depth):
    """Return a boss of eight sides, one of them 10 from the centre, and a round one beside it."""
    corners = [cmath.rect(10 / math.cos(math.pi / 8), math.pi * (2 * k + 1) / 8) for k in range(8)]
    sides = polygon([*corners[3::-1], *corners[:3:-1]])  # in nine lines
    return [(boss(sides, 3.0), depth), (boss(circle(5.0, at=15.0 + gap), 3.0), depth)]


@pytest.mark.parametrize(("gap", "refused"), [(4.49, True), (4.51, False), (5.0, False)])
def test_a_shallow_cut_may_be_an_allowance(gap, refused):
    assert is_refused(*near(gap, -5.0)) is refused


FACED = boss(closed([10 + 10j, 10 - 10j, -10 - 10j, -10 + 10j]), 3.0)
FACE = Straight(14 - 20j, 14 + 20j)  # two radii from there would be 16
IN_FRONT, BEHIND = Straight(40 - 20j, 14 - 20j), Straight(14 + 20j, 40 + 20j)
BESIDE = lines(14 + 30j, 14 + 50j, 40 + 50j, 40 + 30j, 14 + 30j)
NARROW = lines(40 - 3j, 14 - 3j, 14 + 3j, 40 + 3j)
ROUND = [FACE, BEHIND, Straight(40 + 20j, 40 - 20j), IN_FRONT]


@pytest.mark.parametrize(
    ("shapes", "lead"),
    [
        ([FACE], True),
        ([IN_FRONT, FACE], True),
        ([FACE, BEHIND], True),
        ([IN_FRONT, FACE, BEHIND], False),
        (ROUND, False),
        (ROUND[2:] + ROUND[:2], False),
        ([*lines(14 - 20j, 14 + 30j), *BESIDE], True),
        ([*lines(14 - 20j, 14 + 25j, 14 + 30j), *BESIDE], True),
        ([*lines(14 - 5j, 14 + 25j, 14 + 30j), *BESIDE], True),
        ([BESIDE[0].portion(-2.5, 1.0), *BESIDE[1:3], BESIDE[3].portion(0.0, 1.4)], True),
        ([ROUND[3].portion(-0.3, 1.0), *ROUND[:2], ROUND[2].portion(0.0, 1.2)], False),
        ([ROUND[0].portion(-0.3, 1.0), *ROUND[1:3], ROUND[3].portion(0.0, 1.0)], False),
    ],
)
def test_what_cuts_may_be_a_lead(shapes, lead):
    """What stands right of the square has a face that is too near to it, or a lead along that."""
    turned = [Straight(-shape.start, -shape.end) for shape in shapes]
    for led in (boss(shapes, 3.0), boss(turned, 3.0), way_back(boss(shapes, 3.0))):
        for order in ([FACED, led], [led, FACED]):
            assert is_refused(*((part, -5.0) for part in order)) is not lead


def test_what_a_third_contour_takes_away_may_be_cut():
    """A slot in three passes across the square, where another contour is too near to it."""
    face = boss(NARROW, 3.0)
    passes = [boss([Straight(complex(-40, c), complex(40, c))], 3.0) for c in (-9, -3, 3)]
    parts = [(FACED, -5.0), (face, -5.0)]
    assert is_refused(*parts)
    for k in range(3):
        slot_across = [(each, -5.0) for each in passes]
        assert refusal(*slot_across[k:], *parts, *slot_across[:k]) == ""
    assert is_refused(*parts, (passes[0], -5.0))


@pytest.mark.parametrize(("at", "refused"), [(9.9, True), (9.6, True), (9.4, False)])
def test_a_flat_is_no_leave_to_cut_deep_into_it(at, refused):
    """The tool comes to 8 from the square's centre; the flat is no contour that closes."""
    flat = boss(lines(40 + 20j, at + 20j, at - 20j, 40 - 20j), 3.0)
    face = boss([IN_FRONT, FACE, BEHIND], 3.0)
    for order in ([FACED, flat, face], [face, FACED, flat], [flat, face, FACED]):
        assert is_refused(*((part, -5.0) for part in order)) is refused


# Contours made at random.


def enters(one, other):
    """Return how far a contour goes into the material of another one."""
    line, inside = as_shapely(one.body), outline(other)
    left = line.intersection(inside) if stands(other) else line.difference(inside)
    parts = [part for part in getattr(left, "geoms", [left]) if part.length > 0.0]
    places = (part.interpolate(k / 40, normalized=True) for part in parts for k in range(41))
    return max(map(inside.exterior.distance, places), default=0.0)


def two(draw):
    """Return two contours, often with a narrow channel between them, or None."""
    radius, parts = draw.choice([0.5, 1.0, 2.0, 4.0]), [drawn(draw, reach=12.0) for _ in range(2)]
    if None in parts:
        return None
    one, other = (part._replace(radius=radius) for part in parts)
    near = nearest_points(as_shapely(one.body), as_shapely(other.body))
    apart = complex(near[1].x - near[0].x, near[1].y - near[0].y)
    if apart and draw.random() < 0.7:
        by = apart / abs(apart) * draw.uniform(0.0, 2.5) * radius - apart
        shapes = [shape.moved(by) for shape in other.shapes]
        other = other._replace(shapes=shapes, body=shapes)
    return one, other


def cut_depths(monkeypatch, parts):
    """Return how deep the tool of one of two parts cuts the other, and without its ramps.

    Minus infinity for both if one cannot be cut.
    """
    try:
        paths = [blind_path(monkeypatch, contour_of(part)) for part in parts]
    except Refusal:
        return -math.inf, -math.inf
    if any(refusal((part, -1.0)) for part in parts):
        return -math.inf, -math.inf
    deep = max(depth(path, part) for path, part in zip(paths, parts[::-1]))
    passes = [[way for way in path if 2 < way.line < 9000] for path in paths]
    return deep, max(depth(path, part) for path, part in zip(passes, parts[::-1]))


def test_what_cuts_into_another_is_found_and_nothing_else(monkeypatch):
    count = Counter()
    for seed in range(300):
        draw = random.Random(seed)
        parts = two(draw)
        if not parts:
            continue
        deep, of_pass = cut_depths(monkeypatch, parts)
        if deep == -math.inf:
            continue
        text = refusal(*((part, -1.0) for part in parts))
        met = max(enters(*parts), enters(*parts[::-1]))
        if 0.5 * TOLERANCE < met < 3.0 * TOLERANCE:
            continue
        if met > TOLERANCE:
            count["met"] += 1
            assert not text, seed  # one cuts of the other what is meant
        elif deep < 0.9 * TOLERANCE:
            count["right"] += 1
            assert not text, seed
        elif deep > 1.5 * TOLERANCE:
            count["wrong"] += 1
            count["refused"] += bool(text)
            limit = ALLOWANCE * parts[0].radius
            if abs(of_pass - limit) > TOLERANCE:
                assert bool(text) == (of_pass > limit), seed
    assert min(count["right"], count["wrong"], count["met"], count["refused"]) >= 6
