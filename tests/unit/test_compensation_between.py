# SPDX-License-Identifier: GPL-2.0-or-later
"""Contours of one section: what the tool of one cuts of another is found, what is right is cut.

Judged by shapely: the way of the tool's centre along one contour against the other's outline.
"""

import cmath
import math
import random
import time
from collections import Counter

import numpy as np
import pytest
from shapely.geometry import JOIN_STYLE, Polygon
from shapely.geometry.polygon import orient

from g12.compensation import between
from g12.compensation.closing import Closing
from g12.compensation.contour import Arc, Contour, Line, is_move
from g12.compensation.gouge import place_count
from g12.compensation.offset import tool_path
from g12.errors import LONGEST_MESSAGE, Refusal
from support.contour_geometry import Round, Straight
from support.planned_cuts import add
from support.random_contours import (
    TOLERANCE,
    Drawn,
    as_shapely,
    away,
    blind_path,
    contour_of,
    depth,
    points_of,
    polygon,
    rounded,
    star,
)

LEFT, RIGHT = 41, 42
UP = 5.0
SEEDS = range(250)
DEEPEST_TOLD = 0.5  # of the tool's radius


def section(*parts, ramp=None):
    """Return a section of contours, each what is drawn and its Z; ``ramp``: to it and from it.

    Z may be that of each shape.
    """
    contour, line = Contour(90.0, UP), 1
    for drawn, height in parts:
        heights = height if isinstance(height, list) else [height] * len(drawn.shapes)
        first, last = drawn.shapes[0], drawn.shapes[-1]
        start = first.start + (ramp or away(drawn)) * cmath.rect(1.0, first.headings()[0])
        end = last.end + (ramp or away(drawn)) * cmath.rect(1.0, last.headings()[1])
        contour.line(start.real, start.imag, line=line, feed=300.0)
        contour.line(z=heights[0], line=line, feed=300.0)
        contour.compensation(drawn.side, drawn.radius, line=line + 1)
        contour.line(first.start.real, first.start.imag, line=line + 1, feed=300.0)
        for behind, (z, shape) in enumerate(zip(heights, drawn.shapes), line + 2):
            contour.line(z=z, line=behind, feed=300.0)
            add(contour, shape, line=behind, feed=300.0)
        line += 2 + len(drawn.shapes)
        contour.compensation(40, 0.0, line=line)
        contour.line(end.real, end.imag, line=line, feed=300.0)
        contour.line(z=UP, line=line + 1, feed=300.0)
        line += 2
    return contour


def found(*parts, ramp=None):
    """Return the message with which a section is refused, if it is, and what is told of it."""
    contour = section(*parts, ramp=ramp)
    try:
        tool_path(contour, contour.elements, TOLERANCE)
    except Refusal as refused:
        assert len(refused.message) < LONGEST_MESSAGE
        return refused.message, contour.notes
    assert all(len(note) < LONGEST_MESSAGE for note in contour.notes)
    return "", contour.notes


def boss(shapes, radius=6.0):
    """Return what stands: the tool is outside of clockwise shapes."""
    return Drawn(shapes, LEFT, radius, shapes)


def pocket(shapes, radius=6.0):
    """Return what is hollow: the tool is inside of clockwise shapes."""
    return Drawn(shapes, RIGHT, radius, shapes)


def way_back(drawn):
    """Return lines that are cut the other way round, from the same side."""
    shapes = [Straight(shape.end, shape.start) for shape in reversed(drawn.shapes)]
    return drawn._replace(shapes=shapes, body=shapes, side=LEFT + RIGHT - drawn.side)


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


def closed(corners):
    return [Straight(*ends) for ends in zip(corners, [*corners[1:], corners[0]])]


HEXAGON = boss(regular(6, 15.6))


# What shops make.


@pytest.mark.parametrize(
    "parts",
    [
        [(HEXAGON, -5.0), (pocket(slot(14, 40, at=40.0)), -5.0)],  # a slot beside
        [(boss(regular(6, 17.0)), -5.0), (HEXAGON, -5.0)],  # a roughing pass first
        [(HEXAGON, -5.0), (boss(regular(6, 17.0)), -5.0)],
        [(HEXAGON, -float(k)) for k in range(1, 6)],
        [(HEXAGON, -5.0), (pocket(slot(14, 60, turn=0.5)), -5.0)],  # across, as deep
        [(HEXAGON, -5.0), (pocket(slot(14, 60, turn=0.9)), -3.0)],
        [(HEXAGON, -5.0), (pocket(circle(9.0), 4.0), -5.0)],
        [(boss(circle(9.0), 2.0), -5.0), (pocket(circle(14.0), 2.0), -5.0)],  # a groove
        [(pocket(circle(7.5)), -5.0), (pocket(slot(14.5, 50)), -5.0)],  # a hole to go down in
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_what_is_right_is_cut_in_any_order(parts, turned):
    assert found(*parts[:: -1 if turned else 1]) == ("", [])


def begun_at(drawn, k):
    """Return a closed contour that begins with its k-th shape, or in the middle of that."""
    shapes = drawn.shapes[k // 2 :] + drawn.shapes[: k // 2]
    if k % 2:
        middle, sweep = shapes[0].points(3)[1], getattr(shapes[0], "sweep", 0.0)
        end = Straight(shapes[0].start, middle)
        begin = Straight(middle, shapes[0].end)
        if sweep:
            end, begin = (Round(z, shapes[0].centre, sweep / 2) for z in (end.start, middle))
        shapes = [begin, *shapes[1:], end]
    return drawn._replace(shapes=shapes, body=shapes)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (HEXAGON, boss(regular(6, 17.0))),
        (HEXAGON, pocket(slot(14, 60, turn=0.5))),
        (boss(circle(9.0), 2.0), pocket(circle(14.0), 2.0)),
        (HEXAGON, boss(regular(5, 12.0, at=14.0 + 3j), 6.0)),
    ],
)
def test_a_closed_contour_may_begin_anywhere(one, other):
    for k in range(2 * len(one.shapes)):
        for parts in ((begun_at(one, k), other), (other, begun_at(one, k))):
            assert found(*((part, -5.0) for part in parts)) == ("", []), k
    for k in range(2 * len(other.shapes)):
        assert found((one, -5.0), (begun_at(other, k), -5.0)) == ("", []), k


def test_a_pass_the_other_way_round_may_finish():
    assert found((boss(regular(6, 17.0)), -5.0), (way_back(HEXAGON), -5.0)) == ("", [])


def test_four_flats_may_each_be_a_contour():
    flats = [[Straight(turn * (13.5 + 25j), turn * (13.5 - 25j))] for turn in (1, 1j, -1, -1j)]
    assert found(*((boss(flat), -5.0) for flat in flats)) == ("", [])


def near(gap, *depths, begins=0):
    """Return a boss of eight sides, one of them 10 from the centre, and a round one beside it.

    It begins so many lines behind the middle of the far side.
    """
    corners = [cmath.rect(10 / math.cos(math.pi / 8), math.pi * (2 * k + 1) / 8) for k in range(8)]
    sides = polygon([*corners[3::-1], *corners[:3:-1]])  # in nine lines
    sides = sides[begins:] + sides[:begins]
    return [(boss(sides, 3.0), depths[0]), (boss(circle(5.0, at=15.0 + gap), 3.0), depths[-1])]


def test_a_gap_of_the_tools_width_is_enough():
    assert found(*near(6.0, -5.0)) == ("", [])


def test_a_deep_cut_into_another_contour_is_refused():
    text, _ = found(*near(4.0, -5.0))
    assert text == (
        "G12.1 line 16: the tool of radius 3 cannot follow both lines 6 and 16: beside one of "
        "them it cuts into the other"
    )


@pytest.mark.parametrize("at", [0j, 40 + 30j, -40 - 30j])
@pytest.mark.parametrize("turn", [1, 1j, -1, -1j])
def test_contours_may_lie_anywhere(at, turn):
    one, other = (
        boss([Straight(*(at + turn * end for end in shape)) for shape in shapes], 3.0)
        for shapes in (FACED.shapes, ROUND)
    )
    for parts in ((one, other), (other, one)):
        assert "cuts into the other" in found(*((part, -5.0) for part in parts))[0]


@pytest.mark.parametrize("begins", range(9))
def test_any_side_of_a_closed_contour_is_looked_at(begins):
    text, _ = found(*near(4.0, -5.0, begins=begins))
    assert f"cannot follow both lines {3 + (3 - begins) % 9} and 16" in text


def test_a_shallow_one_may_be_an_allowance_and_is_told():
    text, notes = found(*near(5.0, -5.0))
    assert (text, notes) == ("", ["G12.1 line 16: the tool cuts 1 into the contour of line 6"])


def test_what_another_depth_cuts_is_told():
    text, notes = found(*near(4.0, -5.0, -6.0))
    assert not text
    assert len(notes) == 1


@pytest.mark.parametrize("depths", [(-3.0,), (-2.0, -4.0), (-4.0, -2.0), (-2.0, -3.0, -4.0)])
@pytest.mark.parametrize(
    "others", [(-3.0,), (-2.0,), (-1.0, -5.0), (-5.0, -4.0), (-4.0, -1.0), (-2.0, -5.0)]
)
def test_a_deep_cut_is_refused_where_both_are_cut_at_one_height(depths, others):
    (one, _), (other, _) = near(4.0, -5.0)
    cuts = [*((one, z) for z in depths), *((other, z) for z in others)]
    for order in (cuts, cuts[::-1], cuts[::2] + cuts[1::2]):
        text, notes = found(*order)
        assert ("cuts into the other" in text) == bool({*depths} & {*others})
        assert text or len(notes) == 1


FACED = boss(closed([10 + 10j, 10 - 10j, -10 - 10j, -10 + 10j]), 3.0)
FACE = Straight(14 - 20j, 14 + 20j)  # two radii from there would be 16
IN_FRONT, BEHIND = Straight(40 - 20j, 14 - 20j), Straight(14 + 20j, 40 + 20j)
BESIDE = [Straight(14 + 30j, 14 + 50j), Straight(14 + 50j, 40 + 50j), Straight(40 + 50j, 40 + 30j),
          Straight(40 + 30j, 14 + 30j)]  # fmt: skip
ROUND = [FACE, BEHIND, Straight(40 + 20j, 40 - 20j), IN_FRONT]


@pytest.mark.parametrize(
    ("shapes", "lead"),
    [
        ([FACE], True),
        ([IN_FRONT, FACE], True),
        ([FACE, BEHIND], True),
        ([IN_FRONT, FACE, BEHIND], False),
        (ROUND, False),
        (ROUND[1:] + ROUND[:1], False),
        (ROUND[2:] + ROUND[:2], False),
        ([Straight(14 - 20j, 14 + 30j), *BESIDE], True),
        ([Straight(14 - 20j, 14 + 50j), *BESIDE[1:]], True),
        ([Straight(14 - 20j, 14 + 25j), Straight(14 + 25j, 14 + 30j), *BESIDE], True),
        ([Straight(14 - 5j, 14 + 25j), Straight(14 + 25j, 14 + 30j), *BESIDE], True),
        ([BESIDE[0].between(-2.5, 1.0), *BESIDE[1:3], BESIDE[3].between(0.0, 1.4)], True),
        ([ROUND[3].between(-0.3, 1.0), *ROUND[:2], ROUND[2].between(0.0, 1.2)], False),
        ([ROUND[0].between(-0.3, 1.0), *ROUND[1:3], ROUND[3].between(0.0, 1.0)], False),
    ],
)
def test_what_cuts_may_be_a_lead_and_is_told(shapes, lead):
    """What stands right of the square has a face that is too near to it, or a lead along that."""
    turned = [Straight(-shape.start, -shape.end) for shape in shapes]
    for drawn in (boss(shapes, 3.0), boss(turned, 3.0), way_back(boss(shapes, 3.0))):
        for order in ([FACED, drawn], [drawn, FACED]):
            text, notes = found(*((part, -5.0) for part in order))
            assert bool(text) is not lead
            assert any("the tool cuts" in note for note in notes) is lead


def test_an_open_contour_may_end_in_the_air_and_is_told():
    flat = boss([Straight(13.5 + 25j, 13.5 - 25j)])
    text, notes = found((flat, -5.0), (boss(circle(5.0, at=25.0)), -5.0))
    assert not text
    assert notes


def followed(monkeypatch, drawn, heights=-5.0):
    """Return a contour as it is compared with others."""
    seen = []
    with monkeypatch.context() as patch:
        patch.setattr(between, "_verdicts", lambda contours: seen.extend(contours) or [])
        found((drawn, heights), (boss(circle(5.0, at=190.0), 3.0), -5.0))
    return seen[0]


@pytest.mark.parametrize(
    ("shapes", "leads", "others"),
    [
        (BESIDE, [], [(0, 11 + 30j), (3, 14 + 27j)]),  # begins and ends in a corner
        ([Straight(14 - 20j, 14 + 30j), *BESIDE], [(0, 11 - 20j), (0, 11 + 30j)], [(1, 11 + 30j)]),
        ([Straight(14 - 20j, 14 + 50j), *BESIDE[1:]], [(0, 11 - 20j), (0, 11 + 29j)],
         [(0, 11 + 31j), (0, 11 + 50j), (3, 14 + 27j)]),
        ([*BESIDE, Straight(14 + 30j, 0 + 30j)], [(4, 14 + 27j), (4, 0 + 27j)],
         [(0, 11 + 30j), (3, 14 + 27j)]),
        ([*BESIDE[:3], BESIDE[3].between(0.0, 2.0)], [(3, 13 + 27j), (3, -12 + 27j)],
         [(3, 40 + 27j), (3, 15 + 27j)]),
        ([ROUND[0].between(-0.3, 1.0), *ROUND[1:3], ROUND[3].between(0.0, 1.2)],
         [(0, 11 - 30j), (0, 11 + 0j), (3, 27 - 23j), (3, 9 - 23j)], [(1, 27 + 23j)]),  # it crosses
    ],
)  # fmt: skip
def test_what_is_in_front_of_a_closed_contour_or_behind_it_is_a_lead(
    monkeypatch, shapes, leads, others
):
    contour = followed(monkeypatch, boss(shapes, 3.0))
    for index, place in leads:
        assert contour.leads(index, (place.real, place.imag))
    for index, place in others:
        assert not contour.leads(index, (place.real, place.imag))


def test_places_are_numbered_on_where_parts_of_a_contour_join(monkeypatch):
    corners = [30j, 0j, 40 + 30j, 40 + 0j, 80 + 0j]
    walls = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    contour = followed(monkeypatch, walls, [-5.0, UP, -5.0, -5.0])
    first, third, last = (place_count(contour.parts[k], TOLERANCE) for k in (0, 2, 3))
    assert contour.first_places == {0: 0, 2: first + 1, 3: first + 1 + third}
    assert contour.last_place == first + third + last
    assert contour.count == first + third + last


def test_beyond_the_ends_of_an_open_contour_nobody_knows(monkeypatch):
    """In front of, behind and beside an angle, and on its own lines."""
    angle = followed(monkeypatch, boss([Straight(10j, 0j), Straight(0j, 20 + 0j)], 3.0))
    places = [11j, 3 + 11j, -3 + 11j, 21 + 0j, 21 + 3j, 21 - 3j]
    assert [angle.height_of((z.real, z.imag))[1] for z in places] == [True] * 6
    places = {3 + 9j: 3.0, -3 + 9j: -3.0, 3 + 2j: 2.0, -3 - 4j: -5.0, 19 + 1j: 1.0, 19 - 1j: -1.0}
    for z, height in places.items():
        assert angle.height_of((z.real, z.imag)) == (pytest.approx(height), False)


@pytest.mark.parametrize(("end", "told"), [(20.0, False), (40.0, True)])
def test_what_another_cuts_at_the_end_of_an_open_contour_may_be_air(end, told):
    """One comes up to a wall, beyond its end or not, with the tool on this side of it."""
    wall = [Straight(-20j, 1 + 0j), Straight(1 + 0j, 1j * end)]
    across = [Straight(-25 + 25j, -1 + 25j)]
    at, turn = 7 + 3j, cmath.rect(1.0, 0.4)
    wall, across = ([Straight(*(at + turn * z for z in s)) for s in one] for one in (wall, across))
    for one in (boss(wall, 3.0), way_back(boss(wall, 3.0))):
        for other in (pocket(across, 3.0), way_back(pocket(across, 3.0))):
            text, notes = found((one, -5.0), (other, -5.0))
            assert not text and bool(notes) is told


@pytest.mark.parametrize("levels", [(-3.0,), (-4.0, -3.0), (-3.0, -4.0)])
@pytest.mark.parametrize(("height", "told"), [(-2.0, False), (-3.0, True), (-3.5, True)])
def test_a_wall_is_as_high_as_the_highest_of_its_levels(levels, height, told):
    """A line ends 2 in front of the square: the tool there cuts it, or passes above it."""
    beside = boss([Straight(60 + 0j, 12 + 0j)], 3.0)
    for parts in ([(FACED, z) for z in levels] + [(beside, height)],
                  [(beside, height)] + [(FACED, z) for z in levels]):  # fmt: skip
        text, notes = found(*parts)
        assert not text and bool(notes) is told


@pytest.mark.parametrize(
    ("levels", "height", "told"),
    [((-5.0,), -5.0, False), ((-5.0,), -3.0, True), ((-3.0, -5.0), -3.0, False)],
)
def test_a_pass_above_the_material_enters_nothing(levels, height, told):
    """It comes across the square, at a height, and goes down and away along a face beside it."""
    corners = [-40 + 0j, 14 + 0j, 14 + 40j, 40 + 40j]
    across = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    walls, other = [(FACED, z) for z in levels], (across, [height, -5.0, -5.0])
    for parts in ([*walls, other], [other, *walls]):
        text, notes = found(*parts)
        assert not text and bool(notes) is told  # the square's own pass cuts off the step's wall


def test_what_passes_above_a_cut_is_not_told():
    """Where it comes near to the square it is too high, then it goes down beside it, too near."""
    corners = [40 - 40j, 14 - 40j, 14 - 5j, 15 + 0j, 15 + 40j]
    shapes = [Straight(*pair) for pair in zip(corners, corners[1:])]
    parts = [(begun_at(FACED, 5), -5.0), (boss(shapes, 3.0), [-5.0, UP, UP, -5.0])]
    for order in (parts, parts[::-1]):
        text, notes = found(*order)
        assert not text and told_depths(notes) == [pytest.approx(1.0, abs=TOLERANCE)]


@pytest.mark.parametrize(
    ("depths", "told"), [((-3.0, -6.0), True), ((-6.0, -3.0), True), ((-3.0, -4.0), False)]
)
def test_a_pass_that_falls_or_rises_is_as_deep_as_its_deeper_end(depths, told):
    """A line ends 2 in front of the square, which is cut at -5."""
    contour = section(
        (boss(FACED.shapes, 3.0), -5.0), (boss([Straight(60 + 0j, 12 + 0j)], 3.0), -3.0)
    )
    (k,) = (k for k, e in enumerate(contour.elements) if is_move(e) and (e.x0, e.x1) == (60, 12))
    contour.elements[k] = contour.elements[k]._replace(z0=depths[0], z1=depths[1])
    tool_path(contour, contour.elements, TOLERANCE)
    assert bool(contour.notes) is told


@pytest.mark.parametrize(("over", "refused"), [(UP, True), (-5.0, False)])
def test_a_way_through_the_air_enters_nothing(over, refused):
    """It goes along a face beside the square, then over the square or through it."""
    corners = [40 - 40j, 14 - 40j, 14 + 0j, -40 + 0j, -40 - 40j]
    way = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    other = way, [-5.0, -5.0, over, -5.0]
    for parts in ([(FACED, -5.0), other], [other, (FACED, -5.0)]):
        text, notes = found(*parts)
        assert ("cuts into the other" in text) is refused and notes == []


@pytest.mark.parametrize(("tolerances", "told"), [(0.9, False), (1.8, True), (2.2, False)])
def test_what_enters_the_material_by_two_tolerances_is_meant(tolerances, told):
    x = 10.0 - tolerances * TOLERANCE
    again = boss([Straight(x + 8j, x - 8j)], 3.0)
    for parts in ((FACED, again), (again, FACED)):
        text, notes = found(*((part, -5.0) for part in parts))
        assert not text and bool(notes) is told


def test_one_cut_may_be_meant_and_another_of_the_same_contour_told():
    """A slot across a bar, and beside the bar a face that is too near to it."""
    bar = boss(closed([10 + 30j, 10 - 30j, -10 - 30j, -10 + 30j]), 3.0)
    corners = [40 + 5j, 14 + 5j, 14 + 45j, -30 + 45j, -30 - 20j, 40 - 20j]
    slot_and_face = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    for k in range(8):
        right = 3 + (-(k // 2) % 4 or k % 2 * 4)  # its line; of two halves the second one's
        note = f"G12.1 line {12 + k % 2}: the tool cuts 2 into the contour of line {right}"
        text, notes = found((begun_at(bar, k), -5.0), (slot_and_face, -5.0))
        assert (text, of_passes(notes, begun_at(bar, k), slot_and_face)) == ("", [note])


@pytest.mark.parametrize(
    ("right", "heights", "depth_there"),
    [(9.5, [-5.0, -6.0, -5.0, -5.0], -6.0), (10.5, -5.0, -5.0)],
)
def test_a_pass_over_the_same_wall_is_told_where_else_it_cuts(right, heights, depth_there):
    """It comes past a bar's left side, too near, and goes round to its right side.

    There it takes what the bar has left, below the bar's own pass, or leaves that something.
    """
    bar = boss(closed([10 + 30j, 10 - 30j, -10 - 30j, -10 + 30j]), 3.0)
    corners = [-40 + 30j, -14 + 30j, -14 - 60j, 40 - 60j, 40 + 60j, right + 60j, right - 25j]
    around = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    for parts in ([(bar, heights), (around, depth_there)], [(around, depth_there), (bar, heights)]):
        text, notes = found(*parts)
        assert not text and len(notes) == 1
    short = boss(around.shapes[:4], 3.0)
    assert "cuts into the other" in found((bar, heights), (short, depth_there))[0]


def test_cuts_of_two_walls_with_air_between_them_are_two():
    """Another contour goes into the end of the first one, and is too near to the second's start."""
    corners = [30j, 0j, 100 + 30j, 100 + 0j]
    walls = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    corners = [104 + 10j, 104 + 60j, 50 + 60j, 50 + 3j, -30 + 3j]
    other = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    for parts in (
        [(walls, [-5.0, UP, -5.0]), (other, -5.0)],
        [(other, -5.0), (walls, [-5.0, UP, -5.0])],
    ):
        text, notes = found(*parts)
        assert not text and len(of_passes(notes, *(drawn for drawn, _ in parts))) == 1


def test_a_cut_that_goes_on_over_the_beginning_is_one():
    """Beside the square's side down to where the other contour goes into it."""
    for end in (-30 + 9j, 0 + 9j):
        other = boss([Straight(14 - 20j, 14 + 9j), Straight(14 + 9j, end)], 3.0)
        for k in range(8):
            assert found((begun_at(FACED, k), -5.0), (other, -5.0)) == ("", []), k


def test_a_ramp_that_cuts_another_contour_is_told():
    beside = boss([Round(20 + 0j, 25 + 0j, -2 * math.pi)], 3.0)
    assert found((FACED, -5.0), (beside, -5.0)) == ("", [])
    text, notes = found((FACED, -5.0), (beside, -5.0), ramp=11j)
    assert not text and len(notes) == 1


def tip(turn, angle, at, begins):
    """Return a boss with one corner of so many degrees, at a place: it points to +x, turned.

    ``begins``: 1 or 2; at the corner itself no arc would lead about it.
    """
    half = math.radians(angle / 2)
    corners = [0j, *(-20 * cmath.exp(k * half * 1j) for k in (1, -1))]
    shapes = closed([at + corner * cmath.rect(1.0, turn) for corner in corners])
    return boss(shapes[begins:] + shapes[:begins], 3.0)


def of_passes(notes, *drawn):
    """Return notes without those that tell what a ramp cuts."""
    ramps, line = set(), 1
    for part in drawn:
        ramps |= {line + 1, line + 2 + len(part.shapes)}
        line += 4 + len(part.shapes)
    return [note for note in notes if int(note.split()[2][:-1]) not in ramps]


def told_depths(notes):
    return [float(note.split(" cuts ")[1].split()[0]) for note in notes]


@pytest.mark.parametrize("angle", [40, 70, 100])
@pytest.mark.parametrize("gap", [3.6, 4.48, 4.52, 5.3])
def test_the_deepest_pass_counts_at_every_place(angle, gap):
    """Two corners that point to each other: beside the arcs about them all is shallower."""
    for k in range(8):
        one = tip(0.0, angle, 0j, 1 + k % 2)
        other = tip(math.pi - 0.2 * k, angle, gap + 0j, 1 + k // 2 % 2)
        deep = 6.0 - as_shapely(one.shapes).distance(as_shapely(other.shapes))
        text, notes = found((one, -5.0), (other, -5.0))
        assert bool(text) == (deep > 1.5), k
        assert text or told_depths(notes) == [pytest.approx(deep, abs=TOLERANCE)]


@pytest.mark.parametrize("turned", [False, True])
def test_of_several_cuts_of_two_contours_the_deepest_is_told(turned):
    """It goes round the square, nearer to one side than to the other."""
    corners = [60 - 40j, 15.1 - 40j, 15.1 + 40j, -15.3 + 40j, -15.3 - 40j, -60 - 40j]
    drawn = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    drawn = way_back(drawn) if turned else drawn
    square = begun_at(FACED, 7)  # with its ramps where nothing is near
    for parts in ([square, drawn], [drawn, square]):
        text, notes = found(*((part, -5.0) for part in parts))
        assert not text and told_depths(notes) == [pytest.approx(0.9)]


@pytest.mark.parametrize("k", range(8))
def test_a_corner_cut_off_by_little_is_meant(k):
    """The tip of a corner reaches 0.035 over a line."""
    one = tip(0.0, 60, 0.035 + 0j, 1)
    corners = [0.03j * k - 20j, 0.03j * k + 21j, 20 + 20j, 20 - 20j]
    other = begun_at(pocket(closed(corners), 3.0), 3)
    for parts in ([one, other], [other, one]):
        assert found(*((part, -5.0) for part in parts)) == ("", [])


@pytest.mark.parametrize("depths", [(-5.0, -5.0), (-5.0, -6.0)])
@pytest.mark.parametrize(("gap", "ramp"), [(4.4, 3.3), (4.4, 9.0), (5.3, 3.3), (5.3, 9.0)])
def test_a_ramp_never_hides_a_pass(depths, gap, ramp):
    """The second square begins where it is nearest to the first, its ramp comes from in there."""
    at = 10 + gap
    square = [at + 0j, at + 5j, at + 10 + 5j, at + 10 - 5j, at - 5j]
    other = boss(closed(square), 3.0)
    text, notes = found((FACED, depths[0]), (other, depths[1]), ramp=ramp * 1j)
    assert bool(text) == (gap < 4.5 and depths[0] == depths[1])
    across = min(ramp - gap, 0.0)  # from the first square's side to where the ramp begins
    assert text or told_depths(notes) == [
        pytest.approx(6.0 - gap, abs=TOLERANCE),
        pytest.approx(3.0 + across, abs=TOLERANCE),
    ]


def test_a_tool_smaller_than_the_tolerance_cuts_into_nothing():
    assert found((boss(circle(5.0), 0.8 * TOLERANCE), -5.0)) == ("", [])


def test_a_pip_in_a_pocket_is_told():
    face = [(boss(circle(15.0)), -1.0), (boss(circle(5.0)), -1.0)]
    assert not found(*face, (pocket(circle(10.0)), -1.0))[0]


# Contours made at random.


def shape(draw, at):
    corners = star(draw, draw.randint(3, 8))
    centre = sum(corners) / len(corners)
    corners = clockwise(Polygon([(z.real, z.imag) for z in corners]))
    made = polygon([0.5 * (corner - centre) + at for corner in corners])
    if min(side.length for side in made) < 0.3:
        return None
    return rounded(draw, made) if draw.random() < 0.5 else made


def clockwise(outline):
    return [complex(*corner) for corner in orient(outline, -1.0).exterior.coords[:-1]]


def outline(drawn):
    return Polygon(as_shapely(drawn.body).coords)


def enters(one, other):
    """Return how far a contour goes into the material of another one."""
    line, inside = as_shapely(one.body), outline(other)
    left = line.intersection(inside) if other.side == LEFT else line.difference(inside)
    parts = [part for part in getattr(left, "geoms", [left]) if part.length > 0.0]
    places = (part.interpolate(k / 40, normalized=True) for part in parts for k in range(41))
    return max(map(inside.exterior.distance, places), default=0.0)


def two(draw):
    """Return two contours, one beside or in the other, or None."""
    radius = draw.choice([0.5, 1.0, 2.0, 4.0])
    sides = draw.choice([(LEFT, LEFT), (LEFT, RIGHT), (RIGHT, RIGHT)])
    places = 0j, cmath.rect(draw.uniform(0.0, 25.0), draw.uniform(0.0, 2 * math.pi))
    shapes = [shape(draw, place) for place in places]
    if None in shapes:
        return None
    return [Drawn(made, side, radius, made) for made, side in zip(shapes, sides)]


def cut_depths(monkeypatch, parts):
    """Return how deep the tool of one of two parts cuts the other, and without its ramps.

    Minus infinity for both if one cannot be cut.
    """
    try:
        paths = [blind_path(monkeypatch, contour_of(part)) for part in parts]
    except Refusal:
        return -math.inf, -math.inf
    if any(refused(part) for part in parts):
        return -math.inf, -math.inf
    deep = max(depth(path, part) for path, part in zip(paths, parts[::-1]))
    passes = [[way for way in path if 2 < way.line < 9000] for path in paths]
    return deep, max(depth(path, part) for path, part in zip(passes, parts[::-1]))


def refused(part):
    text, notes = found((part, -1.0))
    return text or notes


def test_what_cuts_into_another_is_found_and_nothing_else(monkeypatch):
    count = Counter()
    for seed in SEEDS:
        draw = random.Random(seed)
        parts = two(draw)
        if not parts:
            continue
        deep, of_pass = cut_depths(monkeypatch, parts)
        if deep == -math.inf:
            continue
        text, notes = found(*((part, -1.0) for part in parts))
        met = max(enters(*parts), enters(*parts[::-1]))
        if 0.5 * TOLERANCE < met < 3.0 * TOLERANCE:
            continue
        if met > TOLERANCE:
            count["met"] += 1
            assert not text, seed  # one cuts of the other what is meant: told at most
        elif deep < 0.9 * TOLERANCE:
            count["right"] += 1
            assert (text, notes) == ("", []), seed
        elif deep > 1.5 * TOLERANCE:
            count["wrong"] += 1
            assert text or max(told_depths(notes)) == pytest.approx(deep, abs=TOLERANCE), seed
            count["refused"] += bool(text)
            limit = DEEPEST_TOLD * parts[0].radius
            if abs(of_pass - limit) > TOLERANCE:
                assert bool(text) == (of_pass > limit), seed
    assert min(count["right"], count["wrong"], count["met"], count["refused"]) >= len(SEEDS) / 50


def test_a_finishing_pass_may_cut_what_roughing_left(monkeypatch):
    count = 0
    for seed in SEEDS:
        draw = random.Random(seed)
        made, side = shape(draw, 0j), draw.choice([LEFT, RIGHT])
        if not made:
            continue
        radius = draw.choice([0.5, 1.0, 2.0])
        left = draw.uniform(0.05, 1.8) * radius  # the finishing pass takes it all
        finish = Drawn(made, side, radius, made)
        away_by = left if side == LEFT else -left
        outside = outline(finish).buffer(away_by, join_style=JOIN_STYLE.mitre)
        if outside.geom_type != "Polygon" or outside.is_empty or outside.interiors:
            continue
        rough = Drawn(polygon(clockwise(outside)), side, radius, [])
        if refused(rough) or refused(finish):
            continue
        if depth(blind_path(monkeypatch, contour_of(rough)), finish) > 0.9 * TOLERANCE:
            continue  # its ramp does, in a small pocket
        parts = [(rough, -1.0), (finish, -1.0)]
        draw.shuffle(parts)
        count += 1
        assert found(*parts) == ("", []), seed
    assert count > len(SEEDS) / 4


def passes_of(monkeypatch, drawn):
    """Return places of the tool along a polyline, and where it touches that; no ramps."""
    places, touches = [], []
    for way in blind_path(monkeypatch, contour_of(drawn)):
        if not 2 < way.line < 9000:
            continue
        ends = points_of(way)
        count = 2 + int(10 * np.sum(abs(np.diff(ends))))
        at = np.interp(np.linspace(0, 1, count), np.linspace(0, 1, len(ends)), ends)
        normal = 1j * (ends[-1] - ends[0]) / abs(ends[-1] - ends[0])
        places.append(at)
        corner = complex(way.cx, way.cc) if hasattr(way, "cx") else None
        touches.append(at - way.offset * normal if corner is None else 0 * at + corner)
    return np.concatenate(places), np.concatenate(touches)


def air_under(drawn, points):
    """Return how far points are from a polyline on the tool's side, below 0 on the other.

    It is -inf beyond the ends of an open one.
    """
    nearest, across = np.full(len(points), np.inf), np.zeros(len(points))
    first, last = (None, None) if is_closed(drawn) else (drawn.shapes[0], drawn.shapes[-1])
    for line in drawn.shapes:
        along = (points - line.start) * np.conj(line.end - line.start) / line.length
        beyond = (line is first) & (along.real < 0) | (line is last) & (along.real > line.length)
        away, side = line.distance(points), along.imag * (1 if drawn.side == LEFT else -1)
        closer = (away < nearest - 1e-9) | (away < nearest + 1e-9) & (abs(side) > abs(across))
        across = np.where(closer, np.where(beyond, -np.inf, side), across)
        nearest = np.minimum(away, nearest)
    return np.where(np.isinf(across), across, np.copysign(nearest, across))


def unmeant(monkeypatch, wall, other, margin):
    """Return whether the tool cuts a run of places of a wall that its contour enters nowhere.

    It has to enter and to reach by a margin more.
    """
    places, touches = passes_of(monkeypatch, other)
    entering = places[air_under(wall, touches) < -2 * TOLERANCE - margin]
    points = np.concatenate([line.points(2 + int(5 * line.length)) for line in wall.shapes])
    deep = wall.radius - np.min(abs(points[:, None] - places), axis=1)
    if is_closed(wall):
        points, deep = (np.roll(one, -np.argmin(deep)) for one in (points, deep))
    runs = np.split(np.arange(len(points)), np.flatnonzero(np.diff(deep > TOLERANCE)) + 1)
    return any(
        deep[run[0]] > TOLERANCE
        and not np.any(abs(points[run][:, None] - entering) < wall.radius - TOLERANCE - margin)
        for run in runs
    )


def is_closed(drawn):
    return abs(drawn.shapes[0].start - drawn.shapes[-1].end) < 1e-9


def polyline(draw):
    """Return an open polyline, or a closed one, with the tool on either side."""
    lines = polygon(star(draw, 5)[::-1])
    if draw.random() < 0.6:
        z = [complex(draw.randint(-40, 40), draw.randint(-40, 40)) for _ in range(5)]
        lines = [Straight(*pair) for pair in zip(z, z[1:])]
    return Drawn(lines, draw.choice([LEFT, RIGHT]), 3.0, lines)


def test_it_is_told_where_one_contour_cuts_another_and_does_not_enter(monkeypatch):
    count = Counter()
    for seed in range(200):
        draw = random.Random(seed)
        parts = [polyline(draw), polyline(draw)]
        if any(refused(part) or min(s.length for s in part.shapes) < 0.1 for part in parts):
            continue
        told = {
            any(unmeant(monkeypatch, *pair, margin) for pair in (parts, parts[::-1]))
            for margin in (-0.008, 0.008, 0.1)
        }
        text, notes = found(*((part, -5.0) for part in parts))
        if len(told) == 1:
            assert bool(text or of_passes(notes, *parts)) in told, seed
            count[(told.pop(), *map(is_closed, parts))] += 1
    assert len(count) == 8


@pytest.mark.parametrize(
    ("wall", "side", "heights", "other"),
    [
        ([13 + 13j, 10 + 33j, -2 - 26j, -22 - 36j, -30 - 24j], LEFT, -5.0,
         [-1 - 30j, -26 + 14j, -13 + 38j, 10 + 12j]),
        ([-7 + 8j, -12 + 8j, -15 + 15j, -14 + 24j, 9 + 21j, -1 + 8j, -7 + 8j], RIGHT,
         [-5.0, -5.0, UP, -5.0, -5.0, -5.0], [-1 + 29j, -17 + 18j, -24 + 27j, 22 + 34j]),
    ],
)  # fmt: skip
def test_where_a_wall_ends_air_and_material_change_without_it(wall, side, heights, other):
    """The other contour enters behind the end of an open wall, or of one that is cut in parts."""
    wall, other = ([Straight(*pair) for pair in zip(z, z[1:])] for z in (wall, other))
    wall, other = Drawn(wall, side, 3.0, wall), boss(other, 3.0)
    text, notes = found((wall, heights), (other, -5.0))
    assert (text, of_passes(notes, wall, other)) == ("", [])


def test_what_is_only_rounding_of_a_move_is_no_part_of_a_contour():
    move = Line(1, 300.0, 3.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0)
    assert Closing(0, 2.0 - 1e-12, 4, 1.0, True, False).part(0, move) == (0.0, 0.0)
    assert Closing(0, 1.0, 4, 1.0, True, False).part(0, move) == (0.5, 1.0)


# How long it takes.


@pytest.mark.parametrize(("most", "compared"), [(88, False), (89, True)])
def test_what_would_take_too_long_is_not_compared(monkeypatch, most, compared):
    """Only the last two of six come near to each other, but the boxes round any two beside do."""
    places = [cmath.rect(along, math.pi / 4) for along in (0.0, 20.0, 40.0, 60.0, 80.0, 94.0)]
    bosses = [boss(circle(5.0, at=place), 3.0) for place in places]
    monkeypatch.setattr(between, "MOST", most)  # each of the others takes eleven, both ways
    assert bool(found(*((one, -5.0) for one in bosses))[0]) is compared


def waves(count, radius, turns=10, made=boss):
    angles = [2 * math.pi * k / count for k in range(count + 1)]
    points = [cmath.rect(radius + 2.0 * math.sin(turns * a / 2), -a) for a in angles]
    return made([Straight(*pair) for pair in zip(points, points[1:])], 3.0)


@pytest.mark.parametrize(
    ("parts", "told"),
    [
        ([(waves(5000, 20.5), -1.0), (waves(5000, 20.0), -1.0)], False),
        ([(waves(200, 20.0 + 0.1 * k), -1.0 - k) for k in range(50)], False),
        ([(waves(5000, 20.0), -1.0), (waves(5000, 25.0, made=pocket), -1.0)], True),
        ([(waves(5000, 20.0), -1.0), (waves(5000, 19.992), -1.0)], True),
    ],
)
def test_ten_thousand_elements_are_not_compared_each_with_each(parts, told):
    contour = section(*parts)
    assert len(contour.elements) > 9_900
    start = time.process_time()
    tool_path(contour, contour.elements, TOLERANCE)
    assert time.process_time() - start < 8.0  # below one, told two, where nothing else runs
    assert bool(contour.notes) is told


@pytest.mark.parametrize("offset", [4.0, -4.0])
@pytest.mark.parametrize("sweep", [0.0, 1.0, -2.0])
def test_so_long_is_the_way_of_the_place_where_a_tool_touches(offset, sweep):
    """Along a line, and beside arcs on both sides."""
    start, end, centre = 7 - 3j, 27 - 3j, -5 + 2j
    way = Line(1, 1.0, offset, start.real, start.imag, 0.0, end.real, end.imag, 0.0)
    if sweep:
        end = centre + (start - centre) * cmath.rect(1.0, sweep)
        ends = (start.real, start.imag, 0.0, end.real, end.imag, 0.0)
        way = Arc(1, 1.0, offset, *ends, centre.real, centre.imag, sweep)
    shape = Round(start, centre, sweep) if sweep else Straight(start, end)
    touches = [between._touch(way, (z.real, z.imag), offset) for z in shape.points(2001)]
    assert shape.distance(np.array([complex(*z) for z in touches])) == pytest.approx(4.0)
    length = sum(map(math.dist, touches, touches[1:]))
    assert between._touched_length(way, touches[7]) == pytest.approx(length, rel=1e-5)
