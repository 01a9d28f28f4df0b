# SPDX-License-Identifier: GPL-2.0-or-later
"""Contours of one section: a deep cut of one into another is refused, what is right is cut.

Judged by shapely: the path of the tool's centre along one contour against the other's outline.
"""

import cmath
import math
import random
from collections import Counter

import pytest
from shapely.geometry import JOIN_STYLE
from shapely.geometry.polygon import orient
from shapely.ops import nearest_points

from g12.compensation.contour import Contour
from g12.compensation.offset import tool_path
from g12.errors import Refusal
from support import random_contours
from support.contour_geometry import Round, Straight, lines
from support.growth import growth
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
    shapes = [shape.reversed() for shape in reversed(part.shapes)]
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


def near(gap, *depths, begins=0):
    """Return a boss of eight sides, one of them 10 from the centre, and a round one beside it.

    It begins so many lines after the middle of the far side.
    """
    corners = [cmath.rect(10 / math.cos(math.pi / 8), math.pi * (2 * k + 1) / 8) for k in range(8)]
    sides = polygon([*corners[3::-1], *corners[:3:-1]])  # in nine lines
    sides = sides[begins:] + sides[:begins]
    return [(boss(sides, 3.0), depths[0]), (boss(circle(5.0, at=15.0 + gap), 3.0), depths[-1])]


def test_a_deep_cut_into_any_side_of_another_contour_is_refused():
    for begins in range(9):
        assert refusal(*near(4.0, -5.0, begins=begins)) == (
            f"G12.1 line 16: the tool of radius 3 cannot follow both lines {3 + (3 - begins) % 9} "
            "and 16: beside one of them it cuts into the other"
        )


@pytest.mark.parametrize(("gap", "refused"), [(4.49, True), (4.51, False), (5.0, False)])
def test_a_shallow_cut_may_be_an_allowance(gap, refused):
    assert is_refused(*near(gap, -5.0)) is refused


@pytest.mark.parametrize("depths", [(-3.0,), (-2.0, -4.0), (-2.0, -3.0, -4.0)])
@pytest.mark.parametrize("others", [(-3.0,), (-1.0, -5.0), (-4.0, -1.0)])
def test_a_deep_cut_is_refused_where_both_are_cut_at_one_height(depths, others):
    (one, _), (other, _) = near(4.0, -5.0)
    cuts = [*((one, z) for z in depths), *((other, z) for z in others)]
    for order in (cuts, cuts[::-1], cuts[::2] + cuts[1::2]):
        assert is_refused(*order) == bool({*depths} & {*others})


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


@pytest.mark.parametrize(("over", "refused"), [(UP, True), (-5.0, False)])
def test_a_way_through_the_air_enters_nothing(over, refused):
    """It goes along a face beside the square, then over the square or through it."""
    corners = [40 - 40j, 14 - 40j, 14 + 0j, -40 + 0j, -40 - 40j]
    way = boss(lines(*corners), 3.0)
    other = way, [-5.0, -5.0, over, -5.0]
    for parts in ([(FACED, -5.0), other], [other, (FACED, -5.0)]):
        assert is_refused(*parts) is refused


@pytest.mark.parametrize(
    ("right", "heights", "depth_there"),
    [(9.5, [-5.0, -6.0, -5.0, -5.0], -6.0), (10.5, -5.0, -5.0)],
)
def test_a_contour_that_enters_anywhere_may_cut_anywhere(right, heights, depth_there):
    """It comes past a bar's left side, too near, and goes round to its right side.

    There it takes what the bar has left, below the bar's own pass, or leaves that something.
    """
    bar = boss(closed([10 + 30j, 10 - 30j, -10 - 30j, -10 + 30j]), 3.0)
    corners = [-40 + 30j, -14 + 30j, -14 - 60j, 40 - 60j, 40 + 60j, right + 60j, right - 25j]
    around = boss(lines(*corners), 3.0)
    for parts in ([(bar, heights), (around, depth_there)], [(around, depth_there), (bar, heights)]):
        assert refusal(*parts) == ""
    short = boss(around.shapes[:4], 3.0)
    assert is_refused((bar, heights), (short, depth_there))


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


def test_a_thin_wall_beside_a_pocket_is_not_cut_off():
    hollow = pocket(polygon([9.7 + 15j, 9.7 - 9j, -9 - 9j, -9 + 15j]), 3.0)
    for order in ([FACED, hollow], [hollow, FACED]):
        assert refusal(*((part, -5.0) for part in order)) == ""
        assert is_refused(*((part, -5.0) for part in (*order, boss(NARROW, 3.0))))


def test_a_fin_that_is_cut_off_may_be_cut_on_both_sides():
    """The tool goes over the fin: half its radius before the deepest point of that is air."""
    fin = boss(closed([0.5 + 20j, 0.5 - 20j, -0.5 - 20j, -0.5 + 20j]), 3.0)
    beside = boss(lines(-40 + 13j, -3 + 13j, -3 + 10j, -40 + 10j), 3.0)
    off = boss(lines(40 + 18j, -2 + 18j, 0.4 - 2j, 40 - 2j), 3.0)
    parts = [(part, -5.0) for part in (fin, beside, off)]
    assert is_refused(*parts[:2])
    assert refusal(*parts) == refusal(*parts[::-1]) == ""


def test_a_corner_cut_off_by_little_is_meant():
    """The tip of a corner reaches 0.035 over a line."""
    back = [0.035 - 20 * cmath.exp(math.pi / 6 * turn) for turn in (1j, -1j)]
    one = boss(polygon([*back, 0.035 + 0j][::-1]), 3.0)
    for k in range(8):
        corners = [0.03j * k + 21j, 20 + 20j, 20 - 20j, 0.03j * k - 20j]
        other = pocket(polygon(corners), 3.0)
        for parts in ([one, other], [other, one]):
            assert refusal(*((part, -5.0) for part in parts)) == "", k


@pytest.mark.parametrize("depth", [-5.0, -6.0])
@pytest.mark.parametrize(("gap", "ramp"), [(4.4, 3.3), (4.4, 9.0), (5.3, 9.0)])
def test_a_ramp_never_hides_a_pass(depth, gap, ramp):
    """The second square begins where it is nearest to the first, its ramp comes from in there."""
    at = 10 + gap
    square = [at + 0j, at + 5j, at + 10 + 5j, at + 10 - 5j, at - 5j]
    parts = (FACED, -5.0), (boss(closed(square), 3.0), depth)
    assert is_refused(*parts, ramp=ramp * 1j) == (gap < 4.5 and depth == -5.0)


def test_a_tool_smaller_than_the_tolerance_cuts_into_nothing():
    assert refusal((boss(circle(5.0), 0.8 * TOLERANCE), -5.0)) == ""


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


def test_a_finishing_pass_may_cut_what_roughing_left(monkeypatch):
    count = 0
    for seed in range(150):
        draw = random.Random(seed)
        finish = drawn(draw)
        if not finish:
            continue
        left = draw.uniform(0.05, 1.8) * finish.radius  # the finishing pass takes it all
        outside = outline(finish).buffer(
            left if stands(finish) else -left, join_style=JOIN_STYLE.mitre
        )
        if outside.geom_type != "Polygon" or outside.is_empty or outside.interiors:
            continue
        sign = 1.0 if outline(finish).exterior.is_ccw else -1.0
        corners = [complex(*corner) for corner in orient(outside, sign).exterior.coords[:-1]]
        rough = finish._replace(shapes=polygon(corners))
        if refusal((rough, -1.0)) or refusal((finish, -1.0)):
            continue
        if depth(blind_path(monkeypatch, contour_of(rough)), finish) > 0.9 * TOLERANCE:
            continue  # its ramp does, in a small pocket
        parts = [(rough, -1.0), (finish, -1.0)]
        draw.shuffle(parts)
        count += 1
        assert refusal(*parts) == "", seed
    assert count > 30


# How long it takes.


def waves(count, radius):
    angles = [2 * math.pi * k / count for k in range(count + 1)]
    points = [cmath.rect(radius + 2.0 * math.sin(5 * a), -a) for a in angles]
    return boss(lines(*points), 3.0)


@pytest.mark.parametrize(
    "parts",
    [
        lambda n: [(waves(n // 25, 20.0 + 0.1 * k), -1.0 - k) for k in range(50)],
        lambda n: [(waves(n // 10, 25.0 - 0.1 * k), -1.0) for k in range(20)],
        lambda n: [(waves(n, 20.0), -1.0), (waves(n, 19.992), -1.0)],
    ],
)
def test_elements_are_not_compared_each_with_each(parts):
    def planned(count):
        contour = section(*parts(count))
        assert len(contour.elements) > 1.98 * count
        return lambda: tool_path(contour, contour.elements, TOLERANCE)

    assert growth(planned, 500) < 10
