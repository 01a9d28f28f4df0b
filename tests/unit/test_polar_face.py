# SPDX-License-Identifier: GPL-2.0-or-later
"""Which moves of a section go out as X and Y of the face, and what they ask of C and the slide."""

from math import atan2, cos, degrees, hypot, inf, pi, radians, sin

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Arc, Contour, Line, Mark, Plunge, path_length
from g12.moves.steps import BlockMoves
from g12.polar.face import (
    FaceLimits,
    FaceMove,
    FaceSwitch,
    chosen,
    flows_into,
    in_face,
    is_able,
    parted,
    passed,
)
from g12.polar.plan import PolarSettings, plan

LIMITS = FaceLimits(1000.0, 707.0, 1000.0, radians(3600.0), radians(360.0), 1.0, 0.0)
SETTINGS = PolarSettings(0.005, 0.001, 707.0, 3600.0, 21600.0, face=LIMITS)
ROUNDING = 1e-6


def line(*ends, feed=1000.0, z=(0.0, 0.0)):
    (x0, c0), (x1, c1) = ends
    return Line(1, feed, 0.0, x0, c0, z[0], x1, c1, z[1])


def arc(centre, radius, start, sweep, feed=1000.0):
    (x0, c0), (x1, c1) = (
        (centre[0] + radius * cos(angle), centre[1] + radius * sin(angle))
        for angle in (start, start + sweep)
    )
    return Arc(1, feed, 0.0, x0, c0, 0.0, x1, c1, 0.0, *centre, sweep)


def test_far_from_the_pole_a_move_is_able():
    assert is_able(line((40, -20), (40, 20)), LIMITS)


@pytest.mark.parametrize(
    "move",
    [
        line((10, -20), (10, 20)),  # a stop of the feed would ask too much of C
        line((30, 0), (0, 0)),
        line((0, 0), (30, 0)),
        arc((20, 0), 15, 0, 2 * pi),
    ],
)
def test_near_the_pole_it_is_not(move):
    assert not is_able(move, LIMITS)


@pytest.mark.parametrize(
    "move",
    [line((10, -150), (10, 150), feed=3000.0), arc((60, 0), 55, 0, 2 * pi, feed=3000.0)],
)
def test_a_long_move_is_parted_where_c_cannot_follow(move):
    parts, stopping = parted([move], [True], LIMITS)
    assert [is_able(part, LIMITS) for part in parts] == [True, False, True]
    assert stopping == [False, False, True]
    assert sum(map(path_length, parts)) == pytest.approx(path_length(move))
    assert path_length(parts[1]) < 0.5 * path_length(move)
    for before, after in zip(parts, parts[1:]):
        assert (before.x1, before.c1) == pytest.approx((after.x0, after.c0))


@pytest.mark.parametrize(
    "move",
    [
        line((40, -20), (40, 20)),  # all on the face
        line((10, -10), (10, 10)),  # nothing on it
        line((10, -30), (10, 30), feed=3000.0),  # not worth the way there
    ],
)
def test_other_moves_stay_whole(move):
    limits = LIMITS._replace(pieces_speed=30.0)
    assert parted([move, Mark(1, None)], [False, False], limits)[0] == [move, Mark(1, None)]


def test_parts_on_the_face_are_slower_where_that_is_quicker_than_pieces():
    limits = LIMITS._replace(override=2.0, pieces_speed=20.0)
    circle = arc((20, 0), 10, 0, 2 * pi, feed=3000.0)
    there, beside, back = parted([circle], [True], limits)[0]
    assert [is_able(part, limits) for part in (there, beside, back)] == [True, False, True]
    assert beside.feed == 3000.0
    whole, slower = (
        parted([circle], [True], LIMITS._replace(pieces_speed=speed))[0] for speed in (20.0, 5.0)
    )
    assert [part.feed for part in whole] == [3000.0] * 3
    assert slower[0].feed == slower[2].feed < slower[1].feed == 3000.0
    assert path_length(slower[0]) > path_length(whole[0])
    assert path_length(there) + path_length(beside) + path_length(back) == pytest.approx(20 * pi)


@pytest.mark.parametrize(("pieces_speed", "feed"), [(5.0, 1920.0), (10.0, 2400.0)])
def test_the_slower_pieces_are_the_more_is_made_on_the_face_and_the_slower(pieces_speed, feed):
    """Tried are 1, 0.8, 0.64 and 0.5 of F3000; none that is needlessly small is taken."""
    limits = LIMITS._replace(override=1.2, pieces_speed=pieces_speed)
    there, beside, back = parted([arc((20, 0), 10, 0, 2 * pi, feed=3000.0)], [True], limits)[0]
    assert [part.feed for part in (there, beside, back)] == pytest.approx([feed, 3000.0, feed])
    places = 16 * path_length(there) / (5 * pi)  # of each quarter, 16 are looked at
    assert places == pytest.approx(round(places))
    for part in (there, back):
        assert is_able(part, limits)
        assert not is_able(part._replace(feed=feed / 0.8), limits)


def test_each_part_on_the_face_has_as_much_of_the_feed_as_it_can():
    """In front of the pole a short part, which needs less feed to be worth it, behind it a long."""
    limits = LIMITS._replace(pieces_speed=5.0)
    parts = parted([line((-40, 8), (200, 8), feed=3000.0)], [True], limits)[0]
    assert [part.feed for part in parts] == pytest.approx([2400.0, 3000.0, 3000.0])
    assert [is_able(part, limits) for part in parts] == [True, False, True]
    assert not is_able(parts[0]._replace(feed=3000.0), limits)


def away_from_the_pole(length):
    """Return a line that C can follow from some way on, and from which of its places on."""
    move = line((10, 0), (10, length), feed=3000.0)
    free = (k for k in range(16) if is_able(line((10, length * k / 16), (10, length)), FAST))
    return move, length * next(free) / 16


FAST = LIMITS._replace(override=3.0)  # at F1000, as at F3000 without


def test_a_part_on_the_face_would_take_half_a_second_at_half_its_feed():
    limits, shortest = LIMITS._replace(pieces_speed=1.0), inf
    for length in np.arange(20.0, 60.0, 0.5):
        move, _ = away_from_the_pole(length)
        parts = parted([move], [True], limits)[0]
        if len(parts) > 1:
            shortest = min(shortest, path_length(parts[-1]) / 25.0)
    assert 0.5 <= shortest < 0.6


@pytest.mark.parametrize("length", [70.0, 100.0])
def test_a_move_is_parted_if_it_gains_a_twentieth_switching_included(length):
    """On the face it goes at 50 a second; a switch there and back takes a quarter."""
    (move, near), found = away_from_the_pole(length), set()
    for speed in np.arange(30.05, 48.0, 0.1):
        gains = near / speed + (length - near) / 50.0 + 0.25 <= 0.95 * length / speed
        found.add(bool(gains))
        parts = parted([move], [True], LIMITS._replace(pieces_speed=speed))[0]
        assert (len(parts) > 1) == gains
    assert found == {False, True}


@pytest.mark.parametrize(("seconds", "worth"), [(0.0995, False), (0.1005, True)])
def test_a_tenth_of_a_second_is_worth_the_way_to_the_face(seconds, worth):
    far = line((40, 0), (40, 10 * seconds), feed=600.0)
    assert chosen([far], LIMITS) == [worth]
    assert chosen([far, Mark(2, "M8")], LIMITS) == [worth] * 2  # which takes no time
    assert chosen([far, Mark(2, "M8"), far], LIMITS._replace()) == [2 * seconds > 0.1] * 3


def test_a_move_that_pieces_make_as_fast_stays_whole():
    move = line((10, -150), (10, 150), feed=1000.0)
    assert len(parted([move], [True], LIMITS)[0]) == 3
    assert len(parted([move], [True], LIMITS._replace(pieces_speed=20.0))[0]) == 1


@pytest.mark.parametrize(
    ("following", "flows"),
    [
        (line((20, 10), (0, 10)), True),
        (line((20, 10), (0, 10.1)), False),
        (line((20, 10), (0, 10 + 20 * 0.9e-6)), True),
        (line((20, 10), (0, 10 - 20 * 1.1e-6)), False),
        (line((20, 10), (40, 10)), False),
        (arc((20, 0), 10, pi / 2, 1), True),
        (arc((20, 20), 10, -pi / 2, -1), True),
        (arc((20, 20), 10, -pi / 2, 1), False),
        (Plunge(1, 100.0, 0.0, -1.0), False),
    ],
)
def test_an_arc_that_flows_into_what_follows(following, flows):
    assert flows_into(arc((20, 0), 10, 0, pi / 2), following) is flows
    assert not flows_into(line((0, 10), (20, 10)), following)


def test_along_a_radius_it_is_however_near_it_comes():
    assert is_able(line((30, 0), (1, 0)), LIMITS)


@pytest.mark.parametrize(("slide_speed", "able"), [(50.0, True), (49.99, False)])
def test_along_a_radius_the_slide_goes_as_fast_as_it_can(slide_speed, able):
    limits = LIMITS._replace(slide_speed=slide_speed)
    assert is_able(line((30, 0), (10, 0), feed=3000.0), limits) is able
    assert is_able(line((-3, 4), (-6, 8), feed=3000.0), limits) is able


def test_a_higher_feed_needs_more_room():
    slow, fast = (line((17, -20), (17, 20), feed=feed) for feed in (500.0, 6000.0))
    assert is_able(slow, LIMITS)
    assert not is_able(fast, LIMITS)


def test_the_override_counts():
    move = line((18.5, -20), (18.5, 20), feed=3000.0)
    assert is_able(move, LIMITS)
    assert not is_able(move, LIMITS._replace(override=3.0))


coordinates = st.floats(-60, 60)
places = st.tuples(coordinates, coordinates)
lines = st.builds(
    lambda a, b, feed: line(a, b, feed=feed), places, places, st.floats(100, 9000)
).filter(lambda move: hypot(move.x1 - move.x0, move.c1 - move.c0) > 0.1)
arcs = st.builds(
    arc,
    places,
    st.floats(1, 60),
    st.floats(-pi, pi),
    st.floats(0.1, 2 * pi).flatmap(lambda turn: st.sampled_from((turn, -turn))),
    st.floats(100, 9000),
)


@settings(max_examples=400, deadline=None)
@given(st.one_of(lines, arcs))
def test_an_able_move_at_its_feed_keeps_c_and_the_slide_within_their_limits(move):
    if not is_able(move, LIMITS):
        return
    points, speed = motion(move)
    radius, angle = abs(points), np.unwrap(np.angle(points))
    step = abs(np.diff(points)).mean() / speed
    turning = np.abs(np.diff(angle)) / step
    assert turning.max() <= LIMITS.c_speed * 1.02
    assert np.abs(np.diff(angle, 2)).max() / step**2 <= LIMITS.c_acceleration * 1.02
    assert np.abs(np.diff(radius, 2)).max() / step**2 <= LIMITS.slide_acceleration * 1.02


def share_of_limits(move, limits):
    """Return how much of the limits a move takes, in numbers, wherever it goes on, stops or starts.

    C and the slide are where they have to be for 2,000 places; how they change from one to the next
    tells their speeds and accelerations, those along the path included.
    """
    points, speed = motion(move, limits)
    slide = np.sqrt(abs(points) ** 2 - limits.beside**2)
    angle = np.unwrap(np.angle(points) - np.arctan2(limits.beside, slide))
    most, curving = limits.acceleration, 0.0
    if isinstance(move, Arc):
        most = limits.round_acceleration
        curving = speed**2 / hypot(move.x0 - move.cx, move.c0 - move.cc)
    left, step = np.sqrt(max(0.0, most**2 - curving**2)), abs(points[1] - points[0])
    shares = []
    for axis, fastest, quickest in (
        (angle, limits.c_speed, limits.c_acceleration),
        (slide, limits.slide_speed, limits.slide_acceleration),
    ):
        rate, bend = abs(np.gradient(axis, step)), abs(np.gradient(np.gradient(axis, step), step))
        inner = slice(2, -2)
        shares += [speed * rate.max() / fastest, most * rate.max() / quickest]
        shares.append((speed**2 * bend + left * rate)[inner].max() / quickest)
    return max(shares)


@settings(max_examples=300, deadline=None)
@given(
    st.one_of(lines, arcs),
    st.sampled_from([0.0, 0.0, 3.0, -10.0]),
    st.sampled_from([inf, 60.0]),
    st.floats(0.2, 5.0),
)
def test_a_move_is_able_if_its_place_that_asks_the_most_is(move, beside, slide_speed, quick):
    limits = LIMITS._replace(
        beside=beside, slide_speed=slide_speed, c_acceleration=quick * LIMITS.c_acceleration
    )
    assume(abs(motion(move)[0]).min() > abs(beside) + 0.5)
    share = share_of_limits(move, limits)
    assert is_able(move, limits) == (share < 1.0) or 0.97 < share < 1.1


@settings(max_examples=100, deadline=None)
@given(st.one_of(lines, arcs), st.sampled_from([0.0, 3.0]), st.floats(0.05, 1.0))
def test_what_is_able_does_not_depend_on_the_unit(move, beside, quick):
    """In units of ten metres nothing is greater than 1."""
    limits = LIMITS._replace(
        beside=beside, slide_speed=60.0, c_acceleration=quick * LIMITS.c_acceleration
    )
    small = {name: 1e-4 * getattr(limits, name) for name in LENGTHS}
    ends = {name: 1e-4 * getattr(move, name) for name in move._fields if name[:1] in "xc"}
    scaled = move._replace(feed=1e-4 * move.feed, **ends)
    assert is_able(scaled, limits._replace(**small)) == is_able(move, limits)


LENGTHS = ("acceleration", "round_acceleration", "slide_acceleration", "slide_speed", "beside")


@settings(max_examples=60, deadline=None)
@given(st.one_of(lines, arcs), st.floats(1.0, 3.0), st.sampled_from([0.5, 5.0, 20.0]))
def test_parts_are_the_move_as_fast_as_they_can_be(move, override, pieces_speed):
    """What is made of pieces has its whole feed, the rest as much as C can follow."""
    limits = LIMITS._replace(override=override, pieces_speed=pieces_speed)
    move = move._replace(feed=3.0 * move.feed)
    parts, stopping = parted([move], [True], limits)
    assert sum(map(path_length, parts)) == pytest.approx(path_length(move))
    assert stopping == [*[False] * (len(parts) - 1), True]
    for before, after in zip(parts, parts[1:]):
        assert (before.x1, before.c1) == pytest.approx((after.x0, after.c0))
    for part in parts:
        feeds = (share * move.feed for share in (1.0, 0.8, 0.64, 0.5))
        if is_able(part, limits):
            feeds = (feed for feed in feeds if is_able(part._replace(feed=feed), limits))
        assert part.feed == pytest.approx(next(feeds))


def motion(move, limits=LIMITS):
    """Return 2,000 places of a move, as complex numbers, and its speed per second."""
    parts, speed = np.linspace(0.0, 1.0, 2000), move.feed / 60.0
    start, end = complex(move.x0, move.c0), complex(move.x1, move.c1)
    if isinstance(move, Line):
        return start + parts * (end - start), speed
    centre = complex(move.cx, move.cc)
    speed = min(speed, (limits.round_acceleration * abs(start - centre)) ** 0.5)
    return centre + (start - centre) * np.exp(1j * parts * move.sweep), speed


@settings(max_examples=200, deadline=None)
@given(st.one_of(lines, arcs), st.floats(-20, 20))
def test_the_face_is_the_plane_turned(move, angle):
    turned = in_face(move, angle)
    before, after = motion(move)[0], motion(turned)[0]
    assert after * np.exp(1j * angle) == pytest.approx(before, abs=1e-9)


@settings(max_examples=200, deadline=None)
@given(st.one_of(lines, arcs), st.floats(-20, 20))
def test_passed_tells_the_end_and_the_farthest(move, off):
    points = motion(move)[0]
    if abs(points).min() < 0.5:
        return
    begin = atan2(move.c0, move.x0) + off
    places = passed(move, begin)
    angles = np.unwrap(np.angle(points))
    assert places[-1][0] == pytest.approx(hypot(move.x1, move.c1))
    assert places[-1][1] - begin == pytest.approx(angles[-1] - angles[0], abs=1e-6)
    assert max(radius for radius, *_ in [*places, (abs(points[0]),)]) >= abs(points).max() - 1e-4


def test_marks_and_plunges_go_with_what_is_in_front():
    far, near = line((40, -20), (40, 20)), line((5, -20), (5, 20))
    mark, plunge = Mark(2, "M8"), Plunge(3, 500.0, 0.0, -1.0)
    path = [mark, far, mark, plunge, near, plunge, far, mark]
    assert chosen(path, LIMITS) == [False, True, True, True, False, False, True, True]


def test_a_short_way_far_out_is_not_worth_two_switches():
    near, short = line((5, -20), (5, 20)), line((40, 0), (40, 1))
    assert chosen([near, short, near], LIMITS) == [False] * 3


def contour(*points, feed=2000.0):
    """Return a contour of lines from X30 on."""
    drawn = Contour(30.0, 0.0, code="G12.1", diameter=False, closing=0.0127)
    x, c = 30.0, 0.0
    for number, (to_x, to_c) in enumerate(points, 7):
        drawn.elements.append(Line(number, feed, 0.0, x, c, 0.0, to_x, to_c, 0.0))
        x, c = to_x, to_c
    return drawn


def test_a_section_goes_to_the_face_and_back():
    made = plan(contour((30, 20), (-30, 20), (-30, 0)), SETTINGS, c=10.0)
    kinds = [type(step) for step in made.steps]
    assert kinds == [FaceSwitch, FaceMove, FaceMove, FaceMove, FaceSwitch]
    assert [step.line for step in made.steps] == [7, 7, 8, 9, 9]
    assert made.steps[0] == FaceSwitch(7, True, (30.0, 10.0, 0.0))
    assert made.place == pytest.approx((30.0, 190.0, 0.0))
    assert made.angle == pytest.approx(pi)


def test_arcs_on_the_face_leave_the_machine_at_their_end():
    """Clockwise over three quarters of a circle, C goes from 0 to 90 about a centre far out."""
    drawn = Contour(60.0, 0.0)
    drawn.arc(-1, 40.0, 20.0, i=-20.0, line=7, feed=1000.0)
    drawn.line(40.0, 30.0, -1.0, line=8, feed=1000.0)
    made = plan(drawn, SETTINGS, c=10.0)
    there, arc_on, line_on, back = made.steps
    for step, (x, c), z in ((arc_on, (40, 20), 0.0), (line_on, (40, 30), -1.0)):
        assert step.pieces[-1] == pytest.approx((hypot(x, c), 10 + degrees(atan2(c, x)), z))
    assert len(arc_on.pieces) > 40
    assert made.place == pytest.approx(line_on.pieces[-1])
    assert (there.place, back.place) == ((60.0, 10.0, 0.0), made.place)
    assert hypot(line_on.move.x0, line_on.move.c0) == pytest.approx(hypot(40, 20))


def test_the_part_beside_the_pole_is_made_of_pieces_and_the_face_begins_anew():
    made = plan(contour((30, 20), (3, 20), (3, -30), (30, -30), (30, 0)), SETTINGS, c=0.0)
    assert [step.on for step in made.steps if isinstance(step, FaceSwitch)] == [True, False] * 2
    assert {step.line for step in made.steps if isinstance(step, BlockMoves)} == {9}
    switch, again = made.steps[-5:-3]
    assert (again.line, again.move.c0) == (9, pytest.approx(0.0, abs=0.002))
    assert again.move.x0 == pytest.approx(switch.place[0])
    assert 3 < again.move.x0 < hypot(3, 30)


def test_without_kinematics_all_is_pieces():
    made = plan(contour((30, 20), (-30, 20)), SETTINGS._replace(face=None), c=0.0)
    assert {type(step) for step in made.steps} == {BlockMoves}


def test_no_limits_no_pieces():
    free = LIMITS._replace(c_acceleration=inf, c_speed=inf, slide_acceleration=inf)
    assert is_able(line((0.001, -20), (0.001, 20)), free)


def test_a_plunge_on_the_face_keeps_x_and_c():
    drawn = contour((30, 20), (-30, 20))
    drawn.elements.append(Plunge(9, 500.0, 0.0, -1.0))
    made = plan(drawn, SETTINGS, c=10.0)
    down, back = made.steps[-2:]
    assert down.move == Plunge(9, 500.0, 0.0, -1.0)
    assert [pytest.approx((hypot(30, 20), 10 + degrees(atan2(20, -30)), -1.0))] == down.pieces
    assert back == FaceSwitch(9, False, made.place)
    assert made.place.z == -1.0


@pytest.mark.parametrize("sweep", [0.9, -0.9, 2 * pi, -2 * pi])
@pytest.mark.parametrize("part", [2.5 / 16, 7.5 / 16, 13.5 / 16])
@pytest.mark.parametrize(("share", "able"), [(0.9999, False), (1.0001, True)])
def test_an_arc_is_looked_at_where_it_is_nearest_to_the_pole(sweep, part, share, able):
    """A circle of radius 10 about X20 passes the pole at 10, wherever it begins."""
    free = FaceLimits(1e9, 1e9, inf, inf, share * (1000.0 / 60.0) / 10.0, 1.0, 0.0)
    assert is_able(arc((20, 0), 10, pi - part * sweep, sweep), free) is able
