# SPDX-License-Identifier: GPL-2.0-or-later
"""A contour that the tool would cut into on its own way is refused; what is right is cut.

Judged by shapely: the way of the tool's centre against the part's outline.
"""

import cmath
import math
import random

import pytest

from g12.compensation.contour import Contour
from g12.compensation.offset import tool_path
from g12.errors import LONGEST_MESSAGE, Refusal
from support.contour_geometry import Round, Straight, arc, lines
from support.growth import growth
from support.planned_cuts import add
from support.random_contours import (
    TOLERANCE,
    Drawn,
    blind_path,
    contour_of,
    depth,
    polygon,
    rounded,
    star,
)

LEFT, RIGHT = 41, 42


def refusal(contour):
    """Return the message with which a contour is refused, or an empty text."""
    try:
        tool_path(contour, contour.elements, TOLERANCE)
    except Refusal as refused:
        assert len(refused.message) < LONGEST_MESSAGE
        return refused.message
    return ""


def cut(shapes, side, radius):
    """Return the refusal of a contour, and what is told of it."""
    contour = contour_of(Drawn(shapes, side, radius, shapes))
    return refusal(contour), contour.notes


# Contours made at random.


def drawn(draw, crossing):
    corners = star(draw, draw.randint(3, 9))
    if crossing:
        draw.shuffle(corners)
    shapes = polygon(corners)
    if min(shape.length for shape in shapes) < 0.3:
        return None
    if draw.random() < 0.6:
        shapes = rounded(draw, shapes)
    return Drawn(shapes, draw.choice([LEFT, RIGHT]), draw.choice([0.3, 1.0, 3.0, 6.0]), shapes)


@pytest.mark.parametrize(("crossing", "seeds"), [(False, 400), (True, 300)])
def test_what_cuts_into_itself_is_refused_and_nothing_else(monkeypatch, crossing, seeds):
    right = wrong = 0
    for seed in range(seeds):
        part = drawn(random.Random(seed), crossing)
        if not part:
            continue
        contour = contour_of(part)
        try:
            deep = depth(blind_path(monkeypatch, contour), part)
        except Refusal:  # a corner too tight: refused without a look at the whole
            continue
        if deep < 0.9 * TOLERANCE:
            right += 1
            assert refusal(contour) == "", seed
        elif deep > 1.5 * TOLERANCE:
            wrong += 1
            assert "cuts into the other" in refusal(contour), seed
    assert right > (40 if crossing else 150)
    assert wrong > (50 if crossing else 4)


# Contours that begin and end as they do in shops.

SQUARE = [10 + 10j, 10 - 10j, -10 - 10j, -10 + 10j]  # clockwise: the tool is outside with G41


def closed(corners):
    return [Straight(*ends) for ends in zip(corners, [*corners[1:], corners[0]])]


def test_a_pocket_that_begins_in_its_corner_is_refused():
    text, _ = cut(closed(SQUARE), RIGHT, 3.0)
    assert text == (
        "G12.1 line 6: the tool of radius 3 cannot follow both lines 3 and 6: beside one of them "
        "it cuts into the other"
    )


def test_a_slot_narrower_than_the_tool_is_refused_with_its_walls():
    slot = [*lines((30, 20), (5, 20), (5, -10)), arc((2.5, -10), 2.5, 0, -180),
            *lines((0, -10), (0, 20), (-30, 20))]  # fmt: skip
    assert cut(slot, RIGHT, 2.4) == ("", [])
    narrow = [Straight(30 + 20j, 5 + 20j), Straight(5 + 20j, 5 - 10j), Straight(5 - 10j, 1 - 20j)]
    narrow += [Straight(1 - 20j, -9 - 20j), Straight(-9 - 20j, 0 - 10j), Straight(-10j, 20j)]
    narrow += [Straight(20j, -30 + 20j)]
    assert "cannot follow both lines 3 and 8" in cut(narrow, RIGHT, 2.6)[0]


def extended(front, after):
    """Return the square from the middle of no side: both ends may stick out by some length."""
    first, *_, last = sides = closed(SQUARE)
    sides[0] = Straight(first.start + 1j * front, first.end)
    sides[-1] = Straight(last.start, last.end + after)
    return sides


CIRCLE = arc((0, 0), 10, 0, 360)
FIN = lines((-30, 0), (0, 0), (0, 20), (0.1, 20), (0.1, 0), (30, 0))


@pytest.mark.parametrize(
    ("shapes", "side"),
    [
        (closed(SQUARE), LEFT),  # a part may begin in its corner
        (extended(5.0, 0.0), LEFT),  # the extension of a side as a lead
        (extended(0.0, 5.0), LEFT),
        (extended(40.0, 0.0), LEFT),
        (FIN, LEFT),
        ([Straight(10 - 20j, 10 + 0j), CIRCLE], RIGHT),
        ([Straight(10 - 3j, 10 + 0j), CIRCLE], RIGHT),
        (polygon(SQUARE) * 2, LEFT),  # cut twice
        (polygon(SQUARE) * 2, RIGHT),
    ],
)
def test_what_shops_make_is_cut(shapes, side):
    assert cut(shapes, side, 3.0) == ("", [])


@pytest.mark.parametrize("turned", [-0.5, 0.0, 0.5])
def test_a_lead_to_the_corner_where_a_contour_closes_crosses_nothing(turned):
    lead = 20 * cmath.exp(1j * turned)
    for corner in range(4):
        around, way = [*SQUARE[corner:], *SQUARE[:corner]], 1 / 1j**corner
        on, off = around[0] + 1j * lead * way, around[0] + lead.conjugate() * way
        assert cut([Straight(on, around[0]), *closed(around)], LEFT, 3.0) == ("", [])
        assert cut([*closed(around), Straight(around[0], off)], LEFT, 3.0) == ("", [])


@pytest.mark.parametrize(("front", "after"), [(40.0, -0.015), (-0.015, 40.0)])
def test_a_contour_closes_though_rounding_left_a_gap(front, after):
    """Here of three tolerances, between the end of a side and the one that runs on beyond it."""
    assert cut(extended(front, after), LEFT, 3.0) == ("", [])
    assert cut(extended(front, after), RIGHT, 3.0)[0]


@pytest.mark.parametrize(("gap", "reported"), [(0.059, False), (0.061, True)])
@pytest.mark.parametrize("at_start", [False, True])
def test_a_contour_closes_over_twice_what_arcs_are_forgiven(gap, reported, at_start):
    ends = (-gap, 40.0) if at_start else (40.0, -gap)
    contour = contour_of(Drawn(extended(*ends), LEFT, 3.0, []))
    contour.radius_tolerance = 0.03
    assert refusal(contour) == ""
    assert bool(contour.notes) is reported


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_leads_that_cross_are_told(side):
    """The tool inside cuts beyond one side with the lead of the other."""
    text, notes = cut(extended(5.0, 5.0), side, 3.0)
    assert not text
    assert notes == [
        "G12.1 line 6: lines 3 and 6 cross: taken for the leads of a contour that closes there"
    ]


def test_what_a_loop_cuts_again_is_told_once():
    drawn = Drawn(extended(5.0, 5.0), LEFT, 3.0, [])
    contour, again = contour_of(drawn), contour_of(drawn)
    contour.line(again.elements[0].start.real, again.elements[0].start.imag, line=9001, feed=300.0)
    contour.elements += again.elements
    assert refusal(contour) == ""
    assert len(contour.notes) == 1


def backwards(shapes):
    """Return lines the other way round."""
    return [Straight(shape.end, shape.start) for shape in reversed(shapes)]


def test_a_lead_that_crosses_the_other_may_not_cut_the_part():
    """The square has a tower: its wall stands in the way of the tool that comes down from above."""
    tower = lines((10, 50), (10, -10), (-10, -10), (-10, 40), (11, 40), (11, 20), (0, 20), (0, 10),
                  (15, 10))  # fmt: skip
    for shapes, side in ((tower, LEFT), (backwards(tower), RIGHT)):
        assert "cuts into the other" in cut(shapes, side, 3.0)[0]
    low = [corner if corner.real < 11 else corner - 3 for corner in (s.start for s in tower)]
    clear = [Straight(*pair) for pair in zip(low, [*low[1:], 15 + 10j])]
    for shapes, side in ((clear, LEFT), (backwards(clear), RIGHT)):
        text, (note,) = cut(shapes, side, 3.0)
        assert not text and "lines 3 and 10 cross" in note


def test_the_end_of_an_open_contour_may_be_cut_from_its_far_side():
    """Below a ledge the tool comes back to the line on which it went up, or will go down."""
    hook = lines((0, -20), (0, 0), (20, 0), (20, -10), (1, -10))
    first = "lines 3 and 6 cut into each other: one is taken for a lead"
    assert cut(hook, LEFT, 3.0) == ("", [f"G12.1 line 6: {first}"])
    assert cut(backwards(hook), RIGHT, 3.0) == ("", [f"G12.1 line 6: {first}"])
    inner = [Straight(-20 - 20j, -20j), *hook]
    for shapes, side in ((inner, LEFT), (backwards(inner), RIGHT)):
        assert "cuts into the other" in cut(shapes, side, 3.0)[0]


def test_the_end_of_an_open_contour_may_not_be_cut_from_its_own_side():
    hook = lines((0, -20), (0, 0), (20, 0), (20, 20), (-4, 20), (-4, -15))
    for shapes, side in ((hook, LEFT), (backwards(hook), RIGHT)):
        assert "cuts into the other" in cut(shapes, side, 3.0)[0]


@pytest.mark.parametrize("overlap", [0.0, 2.0])
@pytest.mark.parametrize(("side", "inward"), [(LEFT, 1), (RIGHT, -1)])
def test_a_contour_is_rolled_on_and_off_with_arcs(side, inward, overlap):
    start = 10 + 0j
    to_tool = 5.0 * inward
    on = Round(start + to_tool + 5j, start + to_tool, 0.5 * math.pi * inward)
    end = start - 1j * overlap
    off = Round(end, end + to_tool, 0.5 * math.pi * inward)
    ends = [start, *SQUARE[1:], SQUARE[0], end]
    contour = [on, *(Straight(*pair) for pair in zip(ends, ends[1:])), off]
    assert cut(contour, side, 3.0) == ("", [])


@pytest.mark.parametrize("radius", [0.3, 6.0])
@pytest.mark.parametrize(("share", "deep"), [(0.9, False), (1.15, True)])
def test_a_cut_deeper_than_the_tolerance_is_found_wherever_it_is(radius, share, deep):
    """A round nose over a wall: on its way round it the tool cuts into the wall below."""
    nose, low = 0.1, 2 * radius - share * TOLERANCE
    high, end = low + 4 * radius, 5 * radius
    for k in range(30):
        at = 0.0137 * k * radius
        slot = lines((-end, high), (-end, 0), (end, 0), (end, high), (at + nose, high),
                     (at + nose, low + nose))  # fmt: skip
        slot += [arc((at, low + nose), nose, 0, -180)]
        slot += lines((at - nose, low + nose), (at - nose, high + 1))
        assert ("cuts into the other" in cut(slot, LEFT, radius)[0]) is deep


@pytest.mark.parametrize("allowance", [0.3, 1.5, 100.0, 500.0])
def test_a_finishing_pass_runs_behind_the_one_before(allowance):
    """What that leaves is in tolerances: at the last side it goes over into the finishing pass."""
    left = 1.0 + 0.1 * allowance * TOLERANCE
    rough = [left * corner for corner in (10 + 0j, *SQUARE[1:], SQUARE[0])]
    both = [*rough, 10 + 0j, *SQUARE[1:], SQUARE[0], 10 + 0j]
    assert cut([Straight(*pair) for pair in zip(both, both[1:])], LEFT, 3.0) == ("", [])


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_a_spiral_runs_behind_itself(side):
    turn = -math.pi if side == LEFT else math.pi  # the tool is outside
    radii = [40.0 - 0.5 * k for k in range(60)]
    at, shapes = 40 + 0j, []
    for radius in radii:
        way = 1 if at.real > 0 else -1
        centre = at - way * radius
        shapes.append(Round(at, centre, turn))
        at = shapes[-1].end
    assert cut(shapes, side, 6.0) == ("", [])


def test_a_contour_that_crosses_itself_is_refused_whatever_the_angle():
    for angle in (5, 10, 30, 60, 90, 120):
        over = cmath.rect(40.0, math.radians(angle))
        loop = [Straight(-40 + 0j, 0j), Straight(0j, 60 + 0j), Straight(60 + 0j, 60 - 30j)]
        loop += [Straight(60 - 30j, -over), Straight(-over, over)]
        loop += [Straight(over, over + 20j), Straight(over + 20j, over - 60 + 20j)]
        for side in (LEFT, RIGHT):
            assert cut(loop, side, 1.0)[0], (angle, side)


def wavy(side, wave, high, count):
    """Return lines along a straight one that go to both sides of it, by some length each."""
    along = cmath.rect(1.0, side.headings()[0])
    first = 0.5 * (side.start + side.end - count * wave * along)
    peaks = [
        first + (0.25 * wave * (2 * k + 1) + 1j * (-1) ** k * high) * along
        for k in range(2 * count)
    ]
    corners = [side.start, first, *peaks, first + count * wave * along, side.end]
    return [Straight(*pair) for pair in zip(corners, corners[1:])]


@pytest.mark.parametrize(
    ("wave", "radius", "most"),
    [(1.0, 6.0, 0.12), (2.0, 6.0, 0.12), (4.0, 6.0, 0.12), (4.0, 0.5, 4 * TOLERANCE)],
)
@pytest.mark.parametrize("count", [1, None])
@pytest.mark.parametrize(("share", "found"), [(0.93, False), (1.07, True)])
def test_a_pass_may_not_go_to_both_sides_of_another(wave, radius, most, share, found, count):
    """Waves of some radii, a fiftieth of the radius or four tolerances to either side."""
    first, *others = closed([0.4 * radius * corner for corner in SQUARE])
    waves = wavy(first, wave * radius, share * most, count or int(7.0 / wave))
    for one, other in (([first], waves), (waves, [first])):
        for laps in (([*one, *others], [*other, *others]), ([*others, *one], [*others, *other])):
            for heights in ((-1.0, -1.0), (-1.0, -2.0), (-2.0, -1.0)):
                contour = stacked(radius, *zip(heights, laps))
                assert ("cuts into the other" in refusal(contour)) is found


@pytest.mark.parametrize(("degrees", "found"), [(24.0, False), (27.5, True)])
def test_a_pass_behind_another_goes_the_same_way_within_26_degrees(degrees, found):
    """The second lap goes 4 deeper into a side, at an angle, and comes out again."""
    first, *others = closed([3 * corner for corner in SQUARE])
    slant = 4j / math.tan(math.radians(degrees))
    dip = [30 + 20j, 26 + 20j - slant, 26 - 20j + slant, 30 - 20j]
    corners = [first.start, *dip, first.end]
    deeper = [Straight(*pair) for pair in zip(corners, corners[1:])]
    text = refusal(stacked(3.0, (-1.0, [first, *others]), (-1.0, [*deeper, *others])))
    assert ("cuts into the other" in text) is found


def test_a_pass_may_touch_the_tip_of_another():
    """It comes from beyond one flank of a sharp corner, or of the other, and crosses neither."""
    spike = lines((-20, 0), (-20, 8), (0, 8), (30, 0), (0, -8), (-20, -8), (-20, 0))
    around = lines((-20, 0), (-20, 22), (42, 22), (18, -22), (-20, -22), (-20, 0))
    upside_down = [Straight(s.end.conjugate(), s.start.conjugate()) for s in reversed(around)]
    for outer in (around, upside_down):
        assert refusal(stacked(3.0, (-1.0, spike), (-3.0, outer))) == ""


def stacked(radius, *laps):
    """Return laps outside of a part in one contour, each with its Z and its shapes."""
    (_, (first, *_)), *_, (_, (*_, last)) = laps
    start = first.start + 2j * radius * cmath.rect(1.0, first.headings()[0])
    end = last.end + 2j * radius * cmath.rect(1.0, last.headings()[1])
    contour = Contour(80.0, 5.0)
    contour.line(start.real, start.imag, line=1, feed=300.0)
    contour.compensation(LEFT, radius, line=2)
    contour.line(first.start.real, first.start.imag, line=2, feed=300.0)
    line = 3
    for z, shapes in laps:
        contour.line(z=z, line=line, feed=300.0)
        for shape in shapes:
            add(contour, shape, line=line, feed=300.0)
            line += 1
    contour.compensation(40, 0.0, line=line)
    contour.line(end.real, end.imag, line=line, feed=300.0)
    return contour


def test_a_contour_that_hardly_crosses_itself_behind_a_corner_is_refused():
    sliver = lines((13.28, 9.154), (13.809, 10.3136), (14.0905, 9.9972), (8.608, 15.3087))
    assert "cuts into the other" in cut(sliver, LEFT, 1.0)[0]


# Heights.


def levels(*depths, across=None):
    """Return a boss, cut at some heights without a G40 between them; ``across``: a way above it."""
    contour = Contour(20.0, 5.0)
    contour.compensation(LEFT, 3.0, line=2)
    contour.line(10.0, 0.0, line=2, feed=300.0)
    for depth_of_cut in depths:
        contour.line(z=depth_of_cut, line=3, feed=100.0)
        for line, corner in enumerate([*SQUARE[1:], SQUARE[0], 10 + 0j], 4):
            contour.line(corner.real, corner.imag, line=line, feed=300.0)
        if across is not None:
            contour.line(z=across, line=10, feed=300.0)
            contour.line(x=-20.0, line=11, feed=300.0)
            contour.line(z=depth_of_cut, line=14, feed=300.0)
            contour.line(c=30.0, line=15, feed=300.0)
    contour.compensation(40, 0.0, line=20)
    contour.line(30.0 if across is None else -30.0, line=20, feed=300.0)
    return contour


def test_what_leads_through_the_air_is_no_part():
    assert refusal(levels(-1.0, across=5.0)) == ""
    assert "cuts into the other" in refusal(levels(-1.0, across=-1.0))
    assert refusal(levels(-1.0, -2.0, -3.0)) == ""


BOSS = [10 + 0j, *SQUARE[1:], SQUARE[0], 10 + 0j]
WALL = [-40 - 30j, -40 + 0j, -11.5 + 0j, -11.5 + 30j]  # its corner is where the tool rounds BOSS
AIR = 5.0


def parts(*paths):
    """Return paths cut one after the other, through the air between them.

    Each has its corners and the Z at each of them, or at all of them.
    """
    first = paths[0][0][0]
    contour = Contour(40.0, AIR)
    contour.line(first.real + 20.0, first.imag, line=1, feed=300.0)
    contour.compensation(LEFT, 3.0, line=2)
    contour.line(first.real, first.imag, line=2, feed=300.0)
    for line, (corners, z) in enumerate(paths, 3):
        heights = [z] * len(corners) if isinstance(z, float) else z
        if line > 3:
            contour.line(z=AIR, line=line, feed=300.0)
            before = 2 * corners[0] - corners[1]  # straight on from there
            for corner in (before, corners[0]):
                contour.line(corner.real, corner.imag, line=line, feed=300.0)
        contour.line(z=heights[0], line=line, feed=300.0)
        for corner, height in zip(corners[1:], heights[1:]):
            contour.line(corner.real, corner.imag, height, line=line, feed=300.0)
    contour.compensation(40, 0.0, line=20)
    end = 1.2 * paths[-1][0][-1] + 10
    contour.line(end.real, end.imag, line=20, feed=300.0)
    return contour


@pytest.mark.parametrize(
    ("paths", "deep"),
    [
        ([(BOSS, -1.0), (WALL, -2.0)], False),
        ([(BOSS, -3.0), (WALL, -2.0)], True),
        ([(BOSS, -1.0), (BOSS, -3.0), (WALL, -2.0)], True),
        ([(BOSS, -3.0), (BOSS, -1.0), (WALL, -2.0)], True),
        ([(WALL, -3.0), (BOSS, -2.0)], False),
        ([(WALL, -1.0), (BOSS, -2.0)], True),
        ([(WALL, -1.0), (WALL, -3.0), (BOSS, -2.0)], True),
        ([(WALL, -3.0), (WALL, -1.0), (BOSS, -2.0)], True),
        # down and up along the side of the boss, or along the wall to its corner
        ([(BOSS, [-1.0, -5.0, -5.0, -1.0, -1.0, -1.0]), (WALL, -2.0)], True),
        ([(BOSS, [-1.0, -1.0, -1.5, -1.0, -1.0, -1.0]), (WALL, -2.0)], False),
        ([(BOSS, [-1.0, -5.0, -5.0, -1.0, -1.0, -1.0]), (BOSS, -2.0), (WALL, -3.0)], True),
        ([(BOSS, -2.0), (BOSS, [-1.0, -5.0, -5.0, -1.0, -1.0, -1.0]), (WALL, -3.0)], True),
        ([(WALL, [-5.0, -5.0, -1.0, -5.0]), (BOSS, -2.0)], True),
        ([(WALL, [-5.0, -5.0, -2.5, -5.0]), (BOSS, -2.0)], False),
    ],
)
def test_the_tool_cuts_what_is_as_high_as_its_tip_or_higher(paths, deep):
    assert ("cuts into the other" in refusal(parts(*paths))) is deep


@pytest.mark.parametrize(
    ("heights", "deep"), [([-2.0] * 5, False), ([-2.0, -2.0, -1.0, -1.0, -1.0], True)]
)
def test_a_pass_behind_a_wall_clears_it_where_it_is_as_deep(heights, deep):
    """Between both a tool comes down, half a millimetre into the wall: there it must be gone."""
    behind = [-39 - 30j, -39 - 1j, -38 - 1j, -10.5 - 1j, -10.5 + 30j]
    between = [-33 + 30j, -33 + 2.5j]
    text = refusal(parts((WALL, -2.0), (between, -3.0), (behind, heights)))
    assert ("cannot follow both lines 3 and 4" in text) is deep


ACROSS = [10 + 0j, -30 + 0j]
BEYOND = [-30 + 0j, -30 - 10j, -50 - 10j, -50 + 10j]


def levels_of(*paths):
    """Return paths that go on into each other, each at its Z."""
    (_, (first, *_)), *_ = paths
    contour = Contour(first.real + 10.0, 10.0)
    contour.line(first.real + 10.0, first.imag, line=1, feed=300.0)
    contour.compensation(LEFT, 3.0, line=2)
    contour.line(first.real, first.imag, line=2, feed=300.0)
    line, at = 3, first
    for z, corners in paths:
        contour.line(z=z, line=line, feed=300.0)
        for at in corners:
            contour.line(at.real, at.imag, line=line, feed=300.0)
            line += 1
    contour.compensation(40, 0.0, line=20)
    contour.line(at.real - 10.0, at.imag, line=20, feed=300.0)
    return contour


@pytest.mark.parametrize(
    ("first", "across", "last", "through_the_air"),
    [
        (-1.0, 5.0, -1.0, True),
        (-1.0, 5.0, 3.0, True),
        (-1.0, -1.0, -1.0, False),
        (-1.0, -3.0, -1.0, False),
        (-1.0, 5.0, 5.0, False),  # beyond is a part at that height, and the way there one of it
        (5.0, -1.0, -1.0, False),
    ],
)
def test_a_way_is_through_the_air_from_a_lift_to_a_plunge(first, across, last, through_the_air):
    contour = levels_of((first, BOSS), (across, ACROSS[1:]), (last, BEYOND[1:]))
    assert (refusal(contour) == "") is through_the_air


# How long it takes.


def waves(count, radius=20.0, wave=2.0):
    return [
        cmath.rect(radius + wave * math.sin(10 * math.pi * k / count), 2 * math.pi * k / count)
        for k in range(count + 1)
    ]


def around(count):
    points = waves(count)
    return [Straight(*pair) for pair in zip(points, points[1:])]


def laps(count):
    return polygon(SQUARE) * (count // 5)


@pytest.mark.parametrize(("made", "side"), [(around, RIGHT), (around, LEFT), (laps, LEFT)])
def test_elements_are_not_compared_each_with_each(made, side):
    def planned(count):
        contour = contour_of(Drawn(made(count), side, 3.0, made(count)))
        return lambda: refusal(contour)

    assert planned(2000)() == ""
    assert growth(planned, 500) < 10
