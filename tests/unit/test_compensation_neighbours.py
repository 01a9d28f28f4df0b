# SPDX-License-Identifier: GPL-2.0-or-later
"""Contours of one section: a deep cut of one into another is refused, what is right is cut.

Judged by shapely: the path of the tool's centre along one contour against the other's outline.
"""

import cmath
import math
import random
from collections import Counter

import pytest
from shapely.geometry import JOIN_STYLE, Polygon
from shapely.geometry.polygon import orient

from g12.compensation.contour import Contour
from g12.compensation.offset import tool_path
from g12.errors import LONGEST_MESSAGE, Refusal
from support.contour_geometry import Round, Straight
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
    polygon,
    rounded,
    star,
)

LEFT, RIGHT = 41, 42
UP = 5.0
SEEDS = range(150)
ALLOWANCE = 0.5  # of the tool's radius: what is cut deeper is refused


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
        for after, (z, shape) in enumerate(zip(heights, drawn.shapes), line + 2):
            contour.line(z=z, line=after, feed=300.0)
            add(contour, shape, line=after, feed=300.0)
        line += 2 + len(drawn.shapes)
        contour.compensation(40, 0.0, line=line)
        contour.line(end.real, end.imag, line=line, feed=300.0)
        contour.line(z=UP, line=line + 1, feed=300.0)
        line += 2
    return contour


def refusal(*parts, ramp=None):
    """Return the message with which a section is refused, or an empty text."""
    contour = section(*parts, ramp=ramp)
    try:
        tool_path(contour, contour.elements, TOLERANCE)
    except Refusal as refused:
        assert len(refused.message) < LONGEST_MESSAGE
        return refused.message
    return "".join(contour.notes)


def is_refused(*parts, ramp=None):
    return "cuts into the other" in refusal(*parts, ramp=ramp)


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
        (pocket(slot(14, 60, turn=0.5)), HEXAGON),
        (boss(circle(9.0), 2.0), pocket(circle(14.0), 2.0)),
    ],
)
def test_a_closed_contour_may_begin_anywhere(one, other):
    for k in range(2 * len(one.shapes)):
        for parts in ((begun_at(one, k), other), (other, begun_at(one, k))):
            assert refusal(*((part, -5.0) for part in parts)) == "", k


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
        (ROUND[2:] + ROUND[:2], False),
        ([Straight(14 - 20j, 14 + 30j), *BESIDE], True),
        ([Straight(14 - 20j, 14 + 25j), Straight(14 + 25j, 14 + 30j), *BESIDE], True),
        ([Straight(14 - 5j, 14 + 25j), Straight(14 + 25j, 14 + 30j), *BESIDE], True),
        ([BESIDE[0].between(-2.5, 1.0), *BESIDE[1:3], BESIDE[3].between(0.0, 1.4)], True),
        ([ROUND[3].between(-0.3, 1.0), *ROUND[:2], ROUND[2].between(0.0, 1.2)], False),
        ([ROUND[0].between(-0.3, 1.0), *ROUND[1:3], ROUND[3].between(0.0, 1.0)], False),
    ],
)
def test_what_cuts_may_be_a_lead(shapes, lead):
    """What stands right of the square has a face that is too near to it, or a lead along that."""
    turned = [Straight(-shape.start, -shape.end) for shape in shapes]
    for drawn in (boss(shapes, 3.0), boss(turned, 3.0), way_back(boss(shapes, 3.0))):
        for order in ([FACED, drawn], [drawn, FACED]):
            assert is_refused(*((part, -5.0) for part in order)) is not lead


@pytest.mark.parametrize(("over", "refused"), [(UP, True), (-5.0, False)])
def test_a_way_through_the_air_enters_nothing(over, refused):
    """It goes along a face beside the square, then over the square or through it."""
    corners = [40 - 40j, 14 - 40j, 14 + 0j, -40 + 0j, -40 - 40j]
    way = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
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
    around = boss([Straight(*pair) for pair in zip(corners, corners[1:])], 3.0)
    for parts in ([(bar, heights), (around, depth_there)], [(around, depth_there), (bar, heights)]):
        assert refusal(*parts) == ""
    short = boss(around.shapes[:4], 3.0)
    assert is_refused((bar, heights), (short, depth_there))


def test_what_a_third_contour_takes_away_may_be_cut():
    """A slot in three passes across the square, where another contour is too near to it."""
    ends = [40 - 3j, 14 - 3j, 14 + 3j, 40 + 3j]
    face = boss([Straight(*pair) for pair in zip(ends, ends[1:])], 3.0)
    passes = [boss([Straight(complex(-40, c), complex(40, c))], 3.0) for c in (-9, -3, 3)]
    parts = [(FACED, -5.0), (face, -5.0)]
    assert is_refused(*parts)
    for k in range(3):
        slot_across = [(each, -5.0) for each in passes]
        assert refusal(*slot_across[k:], *parts, *slot_across[:k]) == ""
    assert is_refused(*parts, (passes[0], -5.0))


def test_a_cut_that_goes_on_over_the_beginning_is_one():
    """Beside the square's side down to where the other contour goes into it."""
    for end in (-30 + 9j, 0 + 9j):
        other = boss([Straight(14 - 20j, 14 + 9j), Straight(14 + 9j, end)], 3.0)
        for k in range(8):
            assert refusal((begun_at(FACED, k), -5.0), (other, -5.0)) == "", k


def tip(turn, angle, at, begins):
    """Return a boss with one corner of so many degrees, at a place: it points to +x, turned.

    ``begins``: 1 or 2; at the corner itself no arc would lead about it.
    """
    half = math.radians(angle / 2)
    corners = [0j, *(-20 * cmath.exp(k * half * 1j) for k in (1, -1))]
    shapes = closed([at + corner * cmath.rect(1.0, turn) for corner in corners])
    return boss(shapes[begins:] + shapes[:begins], 3.0)


@pytest.mark.parametrize("angle", [40, 100])
@pytest.mark.parametrize("gap", [3.6, 4.48, 4.52])
def test_the_deepest_pass_counts_at_every_place(angle, gap):
    """Two corners that point to each other: beside the arcs about them all is shallower."""
    for k in range(8):
        one = tip(0.0, angle, 0j, 1 + k % 2)
        other = tip(math.pi - 0.2 * k, angle, gap + 0j, 1 + k // 2 % 2)
        deep = 6.0 - as_shapely(one.shapes).distance(as_shapely(other.shapes))
        assert is_refused((one, -5.0), (other, -5.0)) == (deep > 1.5), k


def test_a_corner_cut_off_by_little_is_meant():
    """The tip of a corner reaches 0.035 over a line."""
    one = tip(0.0, 60, 0.035 + 0j, 1)
    for k in range(8):
        corners = [0.03j * k - 20j, 0.03j * k + 21j, 20 + 20j, 20 - 20j]
        other = begun_at(pocket(closed(corners), 3.0), 3)
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
    if any(refusal((part, -1.0)) for part in parts):
        return -math.inf, -math.inf
    deep = max(depth(path, part) for path, part in zip(paths, parts[::-1]))
    passes = [[way for way in path if 2 < way.line < 9000] for path in paths]
    return deep, max(depth(path, part) for path, part in zip(passes, parts[::-1]))


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
        if refusal((rough, -1.0)) or refusal((finish, -1.0)):
            continue
        if depth(blind_path(monkeypatch, contour_of(rough)), finish) > 0.9 * TOLERANCE:
            continue  # its ramp does, in a small pocket
        parts = [(rough, -1.0), (finish, -1.0)]
        draw.shuffle(parts)
        count += 1
        assert refusal(*parts) == "", seed
    assert count > len(SEEDS) / 4


# How long it takes.


def waves(count, radius, turns=10, made=boss):
    angles = [2 * math.pi * k / count for k in range(count + 1)]
    points = [cmath.rect(radius + 2.0 * math.sin(turns * a / 2), -a) for a in angles]
    return made([Straight(*pair) for pair in zip(points, points[1:])], 3.0)


@pytest.mark.parametrize(
    "parts",
    [
        lambda n: [(waves(n, 20.5), -1.0), (waves(n, 20.0), -1.0)],
        lambda n: [(waves(n // 25, 20.0 + 0.1 * k), -1.0 - k) for k in range(50)],
        lambda n: [(waves(n // 25, 25.0 - 0.1 * k), -1.0) for k in range(50)],
        lambda n: [(waves(n, 20.0), -1.0), (waves(n, 25.0, made=pocket), -1.0)],
        lambda n: [(waves(n, 20.0), -1.0), (waves(n, 19.992), -1.0)],
    ],
)
def test_elements_are_not_compared_each_with_each(parts):
    def planned(count):
        contour = section(*parts(count))
        assert len(contour.elements) > 1.98 * count
        return lambda: tool_path(contour, contour.elements, TOLERANCE)

    assert growth(planned, 500) < 10
