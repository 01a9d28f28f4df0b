# SPDX-License-Identifier: GPL-2.0-or-later
"""Cutter compensation in the plane: the tool touches the part, and nothing it cannot reach.

The proof is shapely's: the tool's centre runs on the boundary of the part, grown by its radius.
"""

import cmath
import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Polygon

from g12.compensation.contour import Contour
from g12.compensation.offset import tool_path
from g12.errors import LONGEST_MESSAGE, Refusal
from g12.polar.plan import PolarSettings, plan
from support.contour_geometry import Round, Straight, distance_from_path, phase, spaced
from support.planned_cuts import SAGITTA, add, cuts, path

TOLERANCE = 0.005
LATHE = PolarSettings(TOLERANCE, 0.001, 1000.0, 3600.0, 21600.0)
EXACT = LATHE._replace(least_x=1e-9)
OUTSIDE, INSIDE = 42, 41  # of a part that is cut counterclockwise


def compensated(shapes, side, radius):
    """Return the contour that cuts the shapes, from line 3 on, and the shapes as they lie there.

    Everything is turned so that the tool comes from the positive X axis, square to the first shape;
    it leaves square to the last.
    """
    away = (1.5 * radius + 0.5) * (1j if side == 41 else -1j)
    come = shapes[0].start + away * cmath.rect(1.0, shapes[0].headings()[0])
    shapes = [shape.turned(cmath.exp(-1j * phase(come))) for shape in shapes]
    leave = shapes[-1].end + away * cmath.rect(1.0, shapes[-1].headings()[1])
    contour = Contour(abs(come), 3.0)
    contour.compensation(side, radius, line=1)
    contour.line(shapes[0].start.real, shapes[0].start.imag, line=1, feed=300.0)
    contour.line(z=-1.0, line=2, feed=100.0)
    for line, shape in enumerate(shapes, 3):
        add(contour, shape, line=line, feed=300.0)
    contour.compensation(40, 0.0, line=90)
    contour.line(leave.real, leave.imag, line=90, feed=300.0)
    contour.close(line=91)
    return contour, shapes


def along_the_part(shapes, side, radius):
    """Return the tool's path along the shapes, without the ramps, and the shapes as they lie."""
    contour, shapes = compensated(shapes, side, radius)
    made = cuts(contour, plan(contour, EXACT, c=0.0))
    return [cut for cut in made if 3 <= cut.line < 90], shapes


def outline(shapes):
    """Return a part's outline as shapely has it, arcs as fine polygons."""
    count = {Straight: 2, Round: 200}
    return np.concatenate([shape.points(count[type(shape)])[:-1] for shape in shapes])


def check(shapes, side, radius):
    """Check that the tool's centre runs on the boundary of the grown or shrunk part, all round."""
    made, shapes = along_the_part(shapes, side, radius)
    made, part = path(made), outline(shapes)
    solid = Polygon(np.column_stack([part.real, part.imag]))
    grown = solid.buffer(radius if side == OUTSIDE else -radius, 100)
    assert isinstance(grown, Polygon) and not grown.is_empty
    ring = np.array(grown.exterior.coords)
    ring = ring[:, 0] + 1j * ring[:, 1]
    slack = TOLERANCE + SAGITTA + 5e-4  # polygons for arcs
    assert distance_from_path(made[::5], ring).max() <= slack
    assert distance_from_path(ring[:: max(1, len(ring) // 100)], made).max() <= slack
    clear = distance_from_path(made[::5], np.append(part, part[0]))
    assert abs(clear - radius).max() <= slack


def polygon(*corners):
    return [Straight(*ends) for ends in zip(corners, [*corners[1:], corners[0]])]


@st.composite
def convex_polygons(draw):
    radius = draw(st.floats(5.0, 20.0))
    gaps = [draw(st.floats(0.4, 1.0)) for _ in range(draw(st.integers(3, 7)))]
    angles = np.cumsum(gaps) / sum(gaps) * 2 * math.pi
    centre = complex(draw(st.floats(-25.0, 25.0)), draw(st.floats(-25.0, 25.0)))
    middle = centre + radius * (np.exp(1j * angles[-1]) + np.exp(1j * angles[0])) / 2
    corners = [centre + radius * cmath.exp(1j * angle) for angle in angles]
    return polygon(middle, *corners), radius


@settings(max_examples=25, deadline=None)
@given(convex_polygons(), st.sampled_from([0.5, 3.0, 12.0]))
def test_outside_a_polygon_the_tool_rolls_round_the_corners(part, radius):
    check(part[0], OUTSIDE, radius)


@settings(max_examples=25, deadline=None)
@given(convex_polygons(), st.floats(0.05, 0.15))
def test_inside_a_polygon_the_tool_stops_short_of_the_corners(part, share):
    check(part[0], INSIDE, share * part[1])


def slot(length, width):
    """Return a slot across the spindle, counterclockwise from the middle of a side on."""
    right, top = length / 2, 1j * width / 2
    return [
        Straight(-top, right - top),
        Round(right - top, complex(right), math.pi),
        Straight(right + top, -right + top),
        Round(-right + top, complex(-right), math.pi),
        Straight(-right - top, -top),
    ]


def pillow(half, sweep):
    """Return a square, counterclockwise, whose sides are arcs: hollow with a sweep below zero."""
    corners = [half * cmath.exp(1j * math.pi * (0.25 + 0.5 * k)) for k in range(4)]
    shapes = []
    for a, b in zip(corners, [*corners[1:], corners[0]]):
        centre = (a + b) / 2 + 1j * (b - a) / abs(b - a) * abs(b - a) / 2 / math.tan(sweep / 2)
        shapes.append(Round(a, centre, sweep))
    middle = shapes[0].points(3)[1]
    first, last = (Round(at, shapes[0].centre, sweep / 2) for at in (middle, shapes[0].start))
    return [first, *shapes[1:], last]


@pytest.mark.parametrize("side", [OUTSIDE, INSIDE])
@pytest.mark.parametrize(
    "shapes",
    [slot(30.0, 8.0), pillow(20.0, 1), pillow(20.0, -1), pillow(20.0, 0.3), pillow(20.0, -0.3)],
    ids=["slot", "bulging", "hollow", "nearly straight", "slightly hollow"],
)
def test_arcs_meet_lines_and_arcs(shapes, side):
    check(shapes, side, 2.0)


# Anything at all is cut right, or refused.


coordinate = st.floats(-20.0, 20.0)
point = st.builds(complex, coordinate, coordinate)
sweep = st.floats(0.1, 5.0)
arc = st.tuples(point, st.builds(math.copysign, sweep, st.sampled_from([1, -1])))


@st.composite
def drawings(draw):
    at, shapes = draw(point), []
    for element in draw(st.lists(point | arc, min_size=2, max_size=4)):
        shape = Straight(at, element) if isinstance(element, complex) else Round(at, *element)
        assume(shape.length > 0.5 and abs(shape.start - shape.end) > 0.1)
        shapes.append(shape)
        at = shape.end
    drawn = np.concatenate([shape.points(60) for shape in shapes])
    assume(LineString(np.column_stack([drawn.real, drawn.imag])).is_simple)
    return shapes


@settings(max_examples=150, deadline=None)
@given(drawings(), st.sampled_from([41, 42]), st.sampled_from([0.1, 1.0, 4.0]))
@example([Round(0j, -1 - 1j, -4.5), Straight(Round(0j, -1 - 1j, -4.5).end, 5 + 1j)], 41, 0.1)
@example([Round(-2j, 0j, 4.0), Round(Round(-2j, 0j, 4.0).end, -1j, 3.0)], 41, 1.0)
@example([Straight(0j, 1 + 0j), Straight(1 + 0j, -0.001j), Straight(-0.001j, -1 + 0j)], 42, 0.1)
@example([Round(2j, 0j, -2.0), Round(Round(2j, 0j, -2.0).end, 0.3 + 0j, -5.0)], 41, 0.1)
def test_any_contour_is_cut_at_the_tools_radius_or_refused_or_told(shapes, side, radius):
    contour, shapes = compensated(shapes, side, radius)
    try:
        moves = plan(contour, EXACT, c=0.0)
    except Refusal as refusal:
        assert str(refusal).startswith("G12.1 line ")
        return
    if contour.notes:  # where the leads of a contour cut
        return
    made = [cut for cut in cuts(contour, moves) if 3 <= cut.line < 90]
    beside = {cut.line: cut.run for cut in made}  # the last run of a line; others turn at corners
    for cut in made:
        index = cut.line - 3
        as_one = in_line(shapes, index)
        off = np.min([abs(shape.distance(cut.points) - radius) for shape in as_one], axis=0)
        assert off.max() <= TOLERANCE
        for neighbour in near_sides(shapes, index, radius, cut.run == beside[cut.line]):
            if neighbour.distance(cut.points).min() < radius - 2 * TOLERANCE:
                assert runs_behind(shapes[index], neighbour, side, radius)


def runs_behind(shape, other, side, radius):
    """Return whether a shape trails all that its tool cuts of another one, the same way.

    These are passes of a spiral: they may cut into each other.
    """
    left = 1j if side == 41 else -1j
    (passes, passing), (places, ways) = (along(one, radius / 8) for one in (shape, other))
    tool = passes + left * radius * passing
    is_cut = distance_from_path(places, tool) < radius - 2 * TOLERANCE
    places, ways = places[is_cut, None], ways[is_cut, None]
    arms = (passes - places) / (left * ways)
    trailing = (-2 * radius < arms.real) & (arms.real < 0) & (abs(arms.imag) < radius)
    return (trailing & ((passing / ways).real > 0.9)).any(axis=1).all()


def along(shape, step):
    """Return places along a shape and its direction at each, unit vectors."""
    points = spaced(shape, step)
    steps = np.diff(points)
    return (points[1:] + points[:-1]) / 2, steps / abs(steps)


def in_line(shapes, index):
    """Return a shape and the next one if they are nearly in line: such are cut as one."""
    shape, *trailing = shapes[index : index + 2]
    turns = [cmath.phase(cmath.rect(1, b.headings()[0] - shape.headings()[1])) for b in trailing]
    return [shape, *(b for b, turn in zip(trailing, turns) if abs(turn) < 0.01)]


def near_sides(shapes, index, radius, with_next):
    """Yield the neighbours of a shape, without their far ends: beyond these others begin."""
    for at, first, last in ((index - 1, 1.0, 0.0), (index + 1, 0.0, 1.0)):
        if 0 <= at < len(shapes) and (with_next or at < index):
            far = 5.0 * radius / shapes[at].length
            if far < 1.0:
                yield shapes[at].between(first * far, 1.0 - last * far)


# Joints, one at a time: lines in, coordinates of the tool's centre out.


def joined(*blocks, side=41, radius=2.0):
    """Return the places where the tool's centre ends each run, rounded."""
    contour = Contour(10.0, 0.0)
    contour.compensation(side, radius, line=1)
    contour.line(10.0, 5.0, line=1, feed=100.0)
    for line, block in enumerate(blocks, 2):
        block(contour, line)
    contour.compensation(40, 0.0, line=50)
    contour.line(30.0, -20.0, line=50, feed=100.0)
    made = cuts(contour, plan(contour, EXACT, c=0.0))
    ends = {}
    for cut in made:
        place = complex(cut.radius[1] * cmath.exp(1j * cut.angle[1]))
        ends[cut.line] = (round(place.real, 6), round(place.imag, 6))
    return ends


def to(x, c):
    return lambda contour, line: contour.line(x, c, line=line, feed=100.0)


def mark(contour, line):
    contour.mark("M8", line=line)


def down(contour, line):
    contour.line(z=-1.0, line=line, feed=100.0)


@pytest.mark.parametrize(
    ("blocks", "radius", "expected"),
    [
        # ramps square to the contour, an inside corner at the crossing of the parallels
        ([to(20, 5), to(20, 15)], 2.0, {1: (10.0, 7.0), 2: (18.0, 7.0), 3: (18.0, 15.0)}),
        ([down, mark, to(20, 5), mark, down, to(20, 15)], 2.0, {1: (10.0, 7.0), 4: (18.0, 7.0)}),
        ([to(20, 5), to(20, 9), to(10, 9)], 2.0, {2: (18.0, 7.0), 3: None}),  # used up
        ([to(20, 5), to(20, -15)], 2.0, {2: (20.0, 7.0), 3: (22.0, -15.0)}),  # rounded
        ([to(20, 5), to(15, 5)], 2.0, {3: (15.0, 3.0)}),  # straight back
        ([to(20, 5), to(20, 15)], 0.0, {1: (10.0, 5.0), 2: (20.0, 5.0), 3: (20.0, 15.0)}),
    ],
)
def test_where_the_tools_centre_ends_each_block(blocks, radius, expected):
    ends = joined(*blocks, radius=radius)
    assert {line: ends.get(line) for line in expected} == expected


@pytest.mark.parametrize(
    ("bend", "by", "segments"),
    [
        (0.0280, 0.0, 1),  # a 25th of the tolerance nearer to the corner than an arc
        (0.0286, 0.0, 2),
        (0.0049, 1.0, 1),  # gap of two tolerances
        (0.0051, 1.0, 2),
        (0.0049, -1.0, 1),
        (0.0051, -1.0, 2),
    ],
)
def test_parallels_are_joined_where_nobody_could_tell(bend, by, segments):
    """An outside corner of a few minutes of arc, from a line to a line or to an arc."""
    way, corner = cmath.exp(1j * bend), 20 + 5j
    follows = Round(corner, corner + 5j * by * way, by) if by else Straight(corner, corner + way)
    contour = Contour(10.0, 0.0)
    contour.compensation(42, 2.0, line=1)
    contour.line(10.0, 5.0, line=1, feed=100.0)
    contour.line(20.0, 5.0, line=2, feed=100.0)
    add(contour, follows, line=3, feed=100.0)
    contour.compensation(40, 0.0, line=4)
    contour.line(30.0, -10.0, line=4, feed=100.0)
    made = [move for move in tool_path(contour, contour.elements, TOLERANCE) if move.line == 3]
    assert len(made) == segments
    assert abs(abs(made[0].start - corner) - 2.0) <= 0.04 * TOLERANCE


def test_no_block_may_wait_for_the_machine_under_compensation():
    contour = Contour(10.0, 0.0)
    contour.wait(line=1)
    contour.compensation(42, 2.0, line=2)
    contour.line(10.0, 5.0, line=2, feed=100.0)
    with pytest.raises(Refusal, match=r"^G12\.1 line 3: M66 waits .* G42 of line 2 is on$"):
        contour.wait(line=3)


@pytest.mark.parametrize("z", [None, -1.0])
def test_a_ramp_square_to_the_contour_and_as_long_as_the_radius_is_no_way_at_all(z):
    contour = Contour(12.0, 0.0)
    contour.line(c=5.0, line=1, feed=100.0)
    contour.compensation(41, 2.0, line=2)
    contour.line(x=10.0, z=z, line=2, feed=100.0)
    contour.line(c=-5.0, line=3, feed=100.0)
    contour.compensation(40, 0.0, line=4)
    contour.line(x=12.0, z=z and 0.0, line=4, feed=100.0)
    contour.line(c=-6.0, line=5, feed=100.0)
    steps = plan(contour, EXACT, c=0.0).steps
    assert [step.line for step in steps] == [1, *[2] * bool(z), 3, *[4] * bool(z), 5]
    assert {step.axes for step in steps if step.line in (2, 4)} <= {"Z"}
    made = [cut for cut in cuts(contour, plan(contour, EXACT, c=0.0)) if cut.length]
    assert path(made).real == pytest.approx(12.0, abs=TOLERANCE)


def test_a_ramp_hardly_longer_than_the_radius_and_hardly_square_to_the_contour_is_made():
    beside = 0.001
    contour = Contour(12.0, 0.0)
    contour.line(c=5.0 + beside, line=1, feed=100.0)
    contour.compensation(41, 2.0, line=2)
    contour.line(10.0, 5.0, line=2, feed=100.0)
    contour.line(c=-5.0, line=3, feed=100.0)
    contour.compensation(40, 0.0, line=4)
    contour.line(12.0, -5.0 - beside, line=4, feed=100.0)
    moves = tool_path(contour, contour.elements, TOLERANCE)
    assert [(move.line, round(move.end.real, 9), round(move.end.imag, 9)) for move in moves] == [
        (1, 12.0, 5.001), (2, 12.0, 5.0), (3, 12.0, -5.0), (4, 12.0, -5.001),
    ]  # fmt: skip


# What the tool cannot reach.


def refusal(*blocks, side=41, radius=2.0):
    with pytest.raises(Refusal) as refused:
        joined(*blocks, side=side, radius=radius)
    assert len(refused.value.message) < LONGEST_MESSAGE
    return refused.value.message


def round_to(turn, x, c, radius):
    return lambda contour, line: contour.arc(turn, x, c, radius=radius, line=line, feed=100.0)


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
    assert refusal(*blocks) == f"G12.1 {message}"


@pytest.mark.parametrize(
    ("shapes", "side", "radius"),
    [
        ([Straight(-15j, -3 + 6j), Round(-3 + 6j, -1.5 + 9j, 2 * math.pi)], 41, 3.0),
        ([Straight(-15j, -3 + 6j), Round(-3 + 6j, -1.5 + 9j, 1.9 * math.pi)], 41, 3.0),
        ([Straight(4 + 2j, 0j), Round(0j, 1 - 2j, -2 * math.pi)], 42, 0.5),
        ([Straight(-3j, 0j), Round(0j, -1 + 0j, -1.0)], 41, 1.0),  # it curls back onto the tool
    ],
)
def test_a_line_and_an_arc_that_come_too_near_to_each_other(shapes, side, radius):
    with pytest.raises(Refusal, match=r"^G12\.1 line 4: .* follow both lines 3 and 4: beside one"):
        along_the_part(shapes, side, radius)


@pytest.mark.parametrize("side", [41, 42])
def test_a_ramp_alone_cannot_be_cut(side):
    contour = Contour(10.0, 0.0)
    contour.compensation(side, 2.0, line=1)
    contour.line(10.0, 5.0, line=1, feed=100.0)
    needs = "needs a block of the contour after its G1"
    with pytest.raises(Refusal, match=rf"^G12\.1 line 1: G{side} {needs}$"):
        plan(contour, LATHE, c=0.0)
