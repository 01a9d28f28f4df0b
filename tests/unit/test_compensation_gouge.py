# SPDX-License-Identifier: GPL-2.0-or-later
"""A contour that the tool would cut into on its own way is refused; what is right is cut.

Judged by shapely: the way of the tool's centre against the part's outline.
"""

import cmath
import math
import random

import pytest

from g12.compensation.compensated import closing_of
from g12.compensation.contour import Contour
from g12.errors import Refusal
from support.contour_geometry import Round, Straight, arc, lines
from support.growth import growth
from support.random_contours import (
    TOLERANCE,
    Drawn,
    blind_path,
    closed,
    contour_of,
    depth,
    drawn,
    open_path,
    polygon,
    refusal,
)

LEFT, RIGHT = 41, 42


def gouges(contour):
    return "cuts into the other" in refusal(contour)


def cut(shapes, side, radius):
    """Return the refusal of a contour, and what is told of it."""
    contour = contour_of(Drawn(shapes, side, radius, shapes))
    return refusal(contour), contour.notes


# Contours made at random.


@pytest.mark.parametrize(
    ("made", "seeds", "least"),
    [
        (drawn, 400, (150, 4)),
        (lambda draw: drawn(draw, crossing=True), 300, (40, 50)),
        (open_path, 150, (50, 40)),
    ],
)
def test_what_cuts_into_itself_is_refused_and_nothing_else(monkeypatch, made, seeds, least):
    right = wrong = spirals = 0
    for seed in range(seeds):
        part = made(random.Random(seed))
        if not part:
            continue
        contour = contour_of(part)
        try:
            path = blind_path(monkeypatch, contour)
        except Refusal:  # a corner too tight: refused without a look at the whole
            continue
        if made is open_path:  # beside its ends there may be no material
            path = [move for move in path if 2 < move.line < 9000]
        deep = depth(path, part)
        if deep < 0.9 * TOLERANCE:
            right += 1
            assert refusal(contour) == "", seed
        elif deep > 1.5 * TOLERANCE:
            wrong += 1
            if made is open_path and not gouges(contour):
                spirals += not contour.notes  # else one end is taken for a lead
            else:
                assert gouges(contour), seed
    assert right > least[0] and wrong > least[1] and spirals < 0.05 * wrong + 1


# Contours that begin and end as they do in shops.

SQUARE = [10 + 10j, 10 - 10j, -10 - 10j, -10 + 10j]  # clockwise: the tool is outside with G41
BOSS = [10 + 0j, *SQUARE[1:], SQUARE[0], 10 + 0j]


def test_leads_from_the_other_side_of_a_closed_contour_suggest_the_other_code():
    led = lines(30 + 2j, *BOSS, 30 - 2j)
    assert cut(led, LEFT, 3.0) == ("", [])
    text, _ = cut(led, RIGHT, 3.0)
    assert text.endswith("both lines 4 and 9: beside one of them it cuts into the other. G41?")


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_a_size_correction_to_the_other_side_has_its_leads_across_the_contour(side):
    x = 30 if side == LEFT else 2  # outside, inside
    led = lines(x + 2j, *BOSS, x - 2j)
    for radius in (0.0, 0.2, -0.2, -2.0):
        assert cut(led, side, radius) == ("", [])


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_a_refusal_names_the_code_of_the_program_also_with_a_negative_diameter(side):
    contour = Contour(20.0, 0.0, 0.0)
    contour.compensate(side, -1.0, at=1)
    contour.straight(10.0, 0.0, at=1, feed=100.0)
    assert refusal(contour) == f"G12.1 line 1: G{side} needs a block of the contour after its G1"


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
        (extended(0.0, 40.0), LEFT),
        (FIN, LEFT),
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


@pytest.mark.parametrize(
    ("gap", "rounding", "reported"),
    [(0.019, 0.0, False), (0.021, 0.0, True), (0.059, 0.03, False), (0.061, 0.03, True)],
)
@pytest.mark.parametrize("at_start", [False, True])
def test_a_contour_closes_over_four_tolerances_or_twice_what_arcs_are_forgiven(
    gap, rounding, reported, at_start
):
    sides = extended(*((-gap, 40.0) if at_start else (40.0, -gap)))
    contour = contour_of(Drawn(sides, LEFT, 3.0, []))
    contour.radius_tolerance = rounding
    assert refusal(contour) == ""
    assert bool(contour.notes) is reported
    assert cut(sides, RIGHT, 3.0)[0]


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_leads_that_cross_are_told_once(side):
    """The tool inside cuts beyond one side with the lead of the other; a loop does so again."""
    told = "G12.1 line 6: lines 3 and 6 cross: taken for the leads of a contour that closes there"
    contour, again = (contour_of(Drawn(extended(5.0, 5.0), side, 3.0, [])) for _ in range(2))
    first = again.elements[0].start
    contour.straight(first.real, first.imag, at=9001, feed=300.0)
    contour.elements += again.elements
    assert (refusal(contour), contour.notes) == ("", [told])


def both_ways(shapes):
    """Yield lines, and the other way round from the same side."""
    yield shapes, LEFT
    yield [shape.portion(1.0, 0.0) for shape in reversed(shapes)], RIGHT


def test_the_end_of_an_open_contour_may_be_cut_from_its_far_side_alone():
    """Below a ledge the tool comes back to the line on which it went up, or will go down."""
    hook = lines((0, -20), (0, 0), (20, 0), (20, -10), (1, -10))
    first = "lines 3 and 6 cut into each other: one is taken for a lead"
    for shapes, side in both_ways(hook):
        assert cut(shapes, side, 3.0) == ("", [f"G12.1 line 6: {first}"])
    inner = [Straight(-20 - 20j, -20j), *hook]
    own_side = lines((0, -20), (0, 0), (20, 0), (20, 20), (-4, 20), (-4, -15))
    for shapes, side in (*both_ways(inner), *both_ways(own_side)):
        assert "cuts into the other" in cut(shapes, side, 3.0)[0]


# Where a contour closes beside its leads.

NEAR = 0.02


def closing(shapes, radius=3.0):
    """Return where shapes that are cut one after the other close."""
    return closing_of(shapes, radius, NEAR)


def rolled(on, off, overlap):
    """Return the square with an arc to lead on and one to lead off, and lines beyond them."""
    start, end = 10 + 0j, 10 - 1j * overlap
    arc_on = Round(start + 5 + 5j, start + 5, 0.5 * math.pi)
    arc_off = Round(end, end + 5, 0.5 * math.pi)
    corners = [start, *SQUARE[1:], SQUARE[0], end]
    far, near = arc_on.start, arc_off.end
    front = [Straight(far + 4 * k + 4, far + 4 * k) for k in reversed(range(on - 1))]
    after = [Straight(near + 4 * k, near + 4 * k + 4) for k in range(off - 1)]
    return [*front, arc_on, *lines(*corners), arc_off, *after]


@pytest.mark.parametrize("overlap", [0.0, 2.0])
@pytest.mark.parametrize(
    ("on", "off", "closes"), [(1, 3, True), (3, 2, True), (1, 4, False), (4, 1, False)]
)
def test_leads_have_up_to_three_moves(on, off, closes, overlap):
    assert closing(rolled(on, off, overlap)).closed is closes


@pytest.mark.parametrize("after", [False, True])
@pytest.mark.parametrize(
    ("lead", "radius", "closes"),
    [(39.0, 6.0, True), (41.0, 6.0, False), (41.0, 4.9, True), (41.0, 5.1, False)],
)
def test_a_contour_is_half_as_long_as_its_leads_or_four_tool_radii(lead, radius, closes, after):
    """The square is 20 round; anything shorter is the spur of an open contour."""
    corners = [5 + 0j, 0j, 5j, 5 + 5j]
    first, second, third, last = closed(corners)
    if after:
        last = Straight(last.start, last.end - 1j * lead)
    else:
        first = Straight(first.start + lead, first.end)
    assert closing([first, second, third, last], radius).closed is closes


@pytest.mark.parametrize(
    ("on", "off", "corners", "closes"),
    [
        *((0, 0, 3, True), (1, 1, 3, True), (1, 1, 4, True), (2, 2, 3, False), (2, 2, 4, False)),
        *((0, 1, 4, True), (1, 0, 4, True), (1, 2, 4, False), (2, 1, 4, False)),
    ],
)
def test_leads_may_cross_with_one_move_beyond_them(on, off, corners, closes):
    ring = [20 * cmath.exp(-2j * math.pi * k / corners) for k in range(corners)]
    first, *others, last = closed(ring)
    overrun = 0.2
    sides = [first.portion(-overrun, 1.0), *others, last.portion(0.0, 1.0 + overrun)]
    for _ in range(on):
        sides = [Straight(1.1 * sides[0].start, sides[0].start), *sides]
    for _ in range(off):
        sides = [*sides, Straight(sides[-1].end, 1.1 * sides[-1].end)]
    assert closing(sides).crossing is closes


@pytest.mark.parametrize(("slope", "through"), [(0.06, True), (0.04, False), (-1.0, False)])
@pytest.mark.parametrize(("turned", "size"), [(0.0, 1.0), (0.7, 1.0), (2.5, 0.025)])
def test_a_side_goes_through_where_two_others_join(slope, through, turned, size):
    """A lead comes to the corner from beyond the last side: from this side it does not cross it."""
    first, *others, last = closed(SQUARE)
    on = Straight(first.start + 20 + 20j * slope, first.start)
    over = Straight(last.start, last.end + 5)
    around = cmath.rect(size, turned)
    assert closing([s.turned(around) for s in (on, first, *others, over)]).crossing is through


# Passes after each other, and heights.

AIR = 5.0


def stacked(radius, *laps):
    """Return laps outside of a part in one contour, each a line of the program.

    Each has its Z, or one for each of its corners: to that first, then to the first corner.
    """
    (_, (first, second, *_)), *_, (_, (*_, before, last)) = laps
    start, end = (
        at + 2j * radius * (to - from_) / abs(to - from_)
        for at, from_, to in ((first, first, second), (last, before, last))
    )
    contour = Contour(80.0, 0.0, AIR)
    contour.straight(start.real, start.imag, at=1, feed=300.0)
    contour.compensate(LEFT, radius, at=2)
    contour.straight(first.real, first.imag, at=2, feed=300.0)
    for line, (z, corners) in enumerate(laps, 3):
        heights = z if isinstance(z, list) else [z] * len(corners)
        contour.straight(height=heights[0], at=line, feed=300.0)
        for corner, height in zip(corners, heights):
            contour.straight(corner.real, corner.imag, height, at=line, feed=300.0)
    contour.compensate(40, 0.0, at=90)
    contour.straight(end.real, end.imag, at=90, feed=300.0)
    return contour


def wavy(start, end, wave, high, count):
    """Return points on a straight way, and to both sides of it by some length each."""
    along = (end - start) / abs(end - start)
    first = 0.5 * (start + end - count * wave * along)
    peaks = [
        first + (0.25 * wave * (2 * k + 1) + 1j * (-1) ** k * high) * along
        for k in range(2 * count)
    ]
    return [start, first, *peaks, first + count * wave * along, end]


@pytest.mark.parametrize(
    ("wave", "radius", "most"), [(1.0, 6.0, 0.12), (4.0, 6.0, 0.12), (4.0, 0.5, 4 * TOLERANCE)]
)
@pytest.mark.parametrize("count", [1, None])
@pytest.mark.parametrize(("share", "found"), [(0.93, False), (1.07, True)])
def test_a_pass_may_not_go_to_both_sides_of_another(wave, radius, most, share, found, count):
    """Waves of some radii, a fiftieth of the radius or four tolerances to either side."""
    first, second, *others = (0.4 * radius * corner for corner in SQUARE)
    waves = wavy(first, second, wave * radius, share * most, count or int(7.0 / wave))
    for pair in (([first, second], waves), (waves, [first, second])):
        for laps in (
            [[*side, *others, first] for side in pair],
            [[second, *others, *side] for side in pair],
        ):
            for heights in ((-1.0, -1.0), (-1.0, -2.0), (-2.0, -1.0)):
                assert gouges(stacked(radius, *zip(heights, laps))) is found


def test_a_crossing_that_an_inside_corner_keeps_the_tool_from_is_no_gouge():
    """The third level crosses the first on the drawing; the tool turns back in front of it."""
    first = [0.8 + 27.5j, -11.3 - 25.6j, -19 + 27j]
    second, third = [first[-1], 5.4 - 1j], [5.4 - 1j, -24 + 1.8j, 12 - 14j]
    assert refusal(stacked(2.0, (5.0, first), (1.8, second), (-2.8, third))) == ""


WALL = [-40 - 30j, -40 + 0j, -11.5 + 0j, -11.5 + 30j]  # its corner is where the tool rounds BOSS


def through_air(*laps):
    """Return laps with a way through the air to each but the first, straight on into it."""
    (first, *others) = laps
    made = [first]
    for z, corners in others:
        made += [(AIR, [2 * corners[0] - corners[1], corners[0]]), (z, corners)]
    return stacked(3.0, *made)


@pytest.mark.parametrize(
    ("laps", "deep"),
    [
        ([(-1.0, BOSS), (-2.0, WALL)], False),
        ([(-3.0, BOSS), (-2.0, WALL)], True),
        ([(-3.0, BOSS), (-1.0, BOSS), (-2.0, WALL)], True),
        ([(-3.0, WALL), (-2.0, BOSS)], False),
        ([(-1.0, WALL), (-2.0, BOSS)], True),
        ([(-1.0, WALL), (-3.0, WALL), (-2.0, BOSS)], True),
        # down and up along the side of the boss, or along the wall to its corner
        ([([-1.0, -5.0, -5.0, -1.0, -1.0, -1.0], BOSS), (-2.0, WALL)], True),
        ([([-1.0, -1.0, -1.5, -1.0, -1.0, -1.0], BOSS), (-2.0, WALL)], False),
        ([(-2.0, BOSS), ([-1.0, -5.0, -5.0, -1.0, -1.0, -1.0], BOSS), (-3.0, WALL)], True),
        ([([-5.0, -5.0, -1.0, -5.0], WALL), (-2.0, BOSS)], True),
        ([([-5.0, -5.0, -2.5, -5.0], WALL), (-2.0, BOSS)], False),
    ],
)
def test_the_tool_cuts_what_is_as_high_as_its_tip_or_higher(laps, deep):
    assert gouges(through_air(*laps)) is deep


# How long it takes.


def waves(count, radius=20.0, wave=2.0):
    angles = [2 * math.pi * k / count for k in range(count + 1)]
    return lines(*(cmath.rect(radius + wave * math.sin(5 * angle), angle) for angle in angles))


def laps(count):
    return polygon(SQUARE) * (count // 5)


@pytest.mark.parametrize(("made", "side"), [(waves, RIGHT), (waves, LEFT), (laps, LEFT)])
def test_elements_are_not_compared_each_with_each(made, side):
    def planned(count):
        contour = contour_of(Drawn(made(count), side, 3.0, made(count)))
        return lambda: refusal(contour)

    assert planned(2000)() == ""
    assert growth(planned, 500) < 10


@pytest.mark.parametrize(
    ("heights", "deep"), [([-2.0] * 5, False), ([-2.0, -2.0, -1.0, -1.0, -1.0], True)]
)
def test_a_pass_behind_a_wall_clears_it_where_it_is_as_deep(heights, deep):
    """Between both a tool comes down, half a millimetre into the wall: there it must be gone."""
    behind = [-39 - 30j, -39 - 1j, -38 - 1j, -10.5 - 1j, -10.5 + 30j]
    between = [-33 + 30j, -33 + 2.5j]
    text = refusal(through_air((-2.0, WALL), (-3.0, between), (heights, behind)))
    assert ("cannot follow both lines 3 and 5" in text) is deep
