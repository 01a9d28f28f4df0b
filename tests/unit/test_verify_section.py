# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar sections made by hand, right and wrong, and what is measured of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.tools.path.follow import follow
from g12.tools.path.part import Part
from g12.tools.path.track import track
from g12.tools.units import MM
from g12.tools.verify.contour_distance import ContourDistances
from g12.tools.verify.findings import (
    contour_findings,
    section_findings,
    turn_findings,
)
from g12.tools.verify.section import measure_section
from g12.tools.verify.section_motion import SectionAxes
from g12.tools.verify.wanted_contour import Element, SectionContour
from support.made_moves import LIMITS, Hand, samples_of

FACE = Part(turning=True)
TOLERANCE = 0.006
TOOL = 6.0
CORNERS = [20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20 + 0j]  # counterclockwise from 20+0j
AXES = SectionAxes(1000.0, 1000.0, math.radians(3600.0), 360.0)


def line(number, start, end, side=0, ramp=False):
    return Element(number, start, end, side, ramp, -1.0)


def square(side):
    """Return a square of 40 mm, counterclockwise, with leads along X."""
    ends = [20 + 0j, *CORNERS]
    walls = [line(2 + i, a, b, side) for i, (a, b) in enumerate(zip(ends, ends[1:]))]
    return [line(1, 40 + 0j, 20 + 0j, side, True), *walls, line(9, 20 + 0j, 40 + 0j, 0, True)]


def section(elements, x=40.0, end=None, doubt="", z=0.0):
    return SectionContour(1, 9, 1, end, "G12.1", x, tuple(elements), doubt, z)


def dense(points, step=0.05):
    """Return points (complex) along a polyline."""
    found = [points[0]]
    for start, end in zip(points, points[1:]):
        count = max(1, round(abs(end - start) / step))
        found += [start + (end - start) * k / count for k in range(1, count + 1)]
    return found


def around(radius):
    """Return the tool centre's way round the square on its outside, one list per wall."""
    ways, corner = [], [0, 1, 2, 3]
    at = complex(20 + radius, 0)
    for index in corner:
        turn = 1j**index
        first = complex(20 + radius, 20) * turn
        arc = [
            (20 + 20j) * turn + radius * turn * complex(math.cos(a), math.sin(a))
            for a in np.linspace(0, math.pi / 2, 200)
        ]
        ways.append([*dense([at, first]), *arc])
        at = arc[-1]
    return [*ways, dense([at, complex(20 + radius, 0)])]


def cut(ways, first=40 + 0j, last=40 + 0j):
    """Return a hand that went those ways, one block each, with straight leads."""
    hand = Hand().rapid(x=40.0)
    hand.polar(dense([first, ways[0][0]])[1:])
    for way in ways:
        hand.next_block().polar(way[1:])
    hand.block = max(9, len(ways) + 2)
    return hand.polar(dense([ways[-1][-1], last])[1:])


def measure(hand, elements, real=None, **options):
    path = track(FACE, hand.moves, LIMITS)
    found = section(elements, end=len(hand.moves), **options)
    run = follow(path, hand.moves, real(path), 1.0) if real else None
    return measure_section(found, path, hand.moves, {1: 2 * TOOL}, AXES, TOLERANCE, run)


def findings(facts):
    """Return what is wrong in the plane and of C, or why nothing can be said."""
    if facts.section.doubt:
        return " | ".join(section_findings(facts, TOLERANCE))
    return " | ".join([*contour_findings(facts, TOLERANCE, MM), *turn_findings(facts)])


# ---------------------------------------------------------------- distances


def test_the_left_of_a_line_is_positive():
    shape = ContourDistances([line(1, 0j, 10 + 0j)])
    assert shape.distances(np.array([5 + 3j, 5 - 4j, 13 + 4j])) == pytest.approx([3, 4, 5])
    _, side = shape.nearest(np.array([5 + 3j, 5 - 4j]))
    assert side[0] > 0 > side[1]


def test_the_left_of_a_counterclockwise_arc_is_inside():
    arc = Element(1, 10 + 0j, 10j, 0, False, 0.0, 0j, math.pi / 2)
    shape = ContourDistances([arc])
    near, side = shape.nearest(np.array([7 + 7j, 8 + 8j, -3 + 12j]))
    assert abs(near[0]) == pytest.approx(10) and near[2] == 10j
    assert side[0] > 0 > side[1]


@given(
    x=st.floats(-40, 40),
    y=st.floats(-40, 40),
    sweep=st.floats(-6.2, 6.2).filter(lambda s: abs(s) > 0.1),
)
def test_distances_to_arcs_agree_with_many_points(x, y, sweep):
    start = 10 * np.exp(0.7j)
    arc = Element(1, start, start * np.exp(1j * sweep), 0, False, 0.0, 0j, sweep)
    points = np.array([arc.point(share) for share in np.linspace(0, 1, 2000)])
    exact = ContourDistances([arc]).distances(np.array([complex(x, y)]))[0]
    assert exact == pytest.approx(np.abs(points - complex(x, y)).min(), abs=0.02)


# ---------------------------------------------------------------- sections


def test_a_good_section_has_no_findings():
    facts = measure(cut(around(TOOL)), square(-1))
    assert facts.deviation < 1e-3
    assert (facts.left, facts.gouge) == (0, 0)
    assert facts.wanted == pytest.approx((20, 20 * math.sqrt(2)), abs=1e-3)
    assert facts.reached == pytest.approx(facts.wanted, abs=1e-3)
    assert facts.sides == (-1,)
    assert findings(facts) == ""


@pytest.mark.parametrize("wrong", [-0.02, 0.02])
def test_a_wrong_offset_is_found(wrong):
    facts = measure(cut(around(TOOL + wrong)), square(-1))
    assert facts.deviation == pytest.approx(0.02, rel=0.02)
    band = 160 * (0.02 - TOLERANCE)
    found, other = (facts.gouge, facts.left) if wrong < 0 else (facts.left, facts.gouge)
    assert found == pytest.approx(band, rel=0.1)
    assert other == 0


@pytest.mark.parametrize("wrong", [-0.02, 0.02])
def test_what_is_off_in_every_lap_is_off_once(wrong):
    (lead, *walls, away), ways = square(-1), around(TOOL + wrong)
    once = measure(cut(ways), [lead, *walls, away])
    laps = [replace(wall, line=wall.line + 5 * lap) for lap in range(4) for wall in walls]
    found = measure(cut(4 * ways), [lead, *laps, replace(away, line=22)])
    assert (found.left, found.gouge) == pytest.approx((once.left, once.gouge), rel=0.1)
    assert len(ContourDistances(laps).elements) == len(walls)


def test_the_wrong_side_is_found():
    facts = measure(cut(around(TOOL)), square(+1))
    assert facts.deviation == pytest.approx(2 * TOOL, rel=0.01)
    assert facts.gouge > 1000


def test_a_wall_that_is_left_out_is_found():
    ways = around(TOOL)
    skipped = [*ways[:1], dense([ways[0][-1], ways[2][0]]), *ways[2:]]
    facts = measure(cut(skipped), square(-1))
    assert facts.deviation > 5
    assert "off the contour" in findings(facts)


def test_a_cut_through_the_contour_is_a_gouge():
    ways = around(TOOL)
    ways[-1] = [*ways[-1], complex(20 + TOOL - 3, 0), complex(20 + TOOL, 0)]
    facts = measure(cut(ways), square(-1))
    assert facts.deviation == pytest.approx(3, rel=0.01) and facts.gouge > 1


def test_a_later_pass_may_cross_the_extension_of_the_lead_in():
    elements = square(-1)
    elements[:2] = [line(1, 40 - 15j, 20 - 15j, -1, True), line(2, 20 - 15j, 20 + 20j, -1)]
    elements[-2] = line(6, 20 - 20j, 20 - 5j, -1)  # ends on the first wall
    elements[-1] = line(9, 20 - 5j, 40 - 5j, 0, True)
    start = complex(20 + TOOL, -15)
    ways = around(TOOL)
    ways[0] = [*dense([start, ways[0][0]]), *ways[0]]
    ways[-1] = dense([ways[-1][0], complex(20 + TOOL, -5)])
    facts = measure(cut(ways, 40 - 15j, 40 - 5j), elements, x=abs(40 - 15j))
    assert facts.gouge == 0


def diving(hand_ways, *, air, depth):
    """Return a hand that goes straight across the square at a height, then round it at a depth."""
    hand = Hand().rapid(x=40.0, z=2.0)
    hand.line(z=air).polar([0 + 39j, -39 + 0j, 0 - 39j, 20 - 15j, 20 + 15j, 40 + 0j])
    hand.line(z=depth).polar(dense([40 + 0j, hand_ways[0][0]])[1:])
    for way in hand_ways:
        hand.next_block().polar(way[1:])
    hand.block = 9
    return hand.polar(dense([hand_ways[-1][-1], 40 + 0j])[1:])


@pytest.mark.parametrize(
    ("air", "depth", "gouges"),
    [(2.0, -3.0, False), (0.5, -3.0, False), (-1.0, -3.0, True), (-3.0, -3.0, True)],
)
def test_what_the_cutter_sweeps_above_the_face_is_no_gouge(air, depth, gouges):
    facts = measure(diving(around(TOOL), air=air, depth=depth), square(-1), z=2.0)
    assert (facts.gouge > 10) is facts.through is gouges
    assert ("gouged" in findings(facts)) is gouges


def test_above_a_contour_that_lies_above_z0_is_the_air():
    facts = measure(diving(around(TOOL), air=1.0, depth=0.5), square(-1), z=2.0)
    assert findings(facts) == ""


def test_a_plunge_into_the_wall_is_a_gouge():
    hand = Hand().rapid(x=40.0, z=2.0).polar([22 + 10j]).line(z=-3.0).line(z=2.0).polar([40 + 0j])
    hand.line(z=-3.0).polar(dense([40 + 0j, 26 + 0j])[1:])
    for way in around(TOOL):
        hand.next_block().polar(way[1:])
    assert measure(hand, square(-1), z=2.0).gouge > 1


@pytest.mark.parametrize("centre", [0, 24])
def test_a_contour_of_two_elements_that_closes_on_its_lead_in(centre):
    # A D: down a line at X12, back to it clockwise over the long or the short arc of radius 20.
    start, corner, top = 12 + 30j, 12 - 16j, 12 + 16j
    sweep = (np.angle(top - centre) - np.angle(corner - centre)) % (2 * math.pi) - 2 * math.pi
    arc = Element(3, corner, top, 1, False, 0.0, complex(centre), sweep)
    walls = [line(1, 40 + 30j, start, 1, True), line(2, start, corner, 1), arc]
    first = (np.angle(corner - centre) + math.pi) % (2 * math.pi) - math.pi
    about = corner + 6 * np.exp(1j * np.linspace(0, first, 200))
    round_ = centre + 26 * np.exp(1j * (first + np.linspace(0, sweep, 2000)))
    ways = [[*dense([18 + 30j, 18 - 16j]), *about], list(round_)]
    facts = measure(cut(ways, 40 + 30j, 40 + 16j), [*walls, line(9, top, 40 + 16j, 0, True)])
    assert facts.deviation < 1e-3


def test_of_a_cut_right_through_only_a_part_is_measured():
    ways = around(TOOL)
    ways[-1] = [*ways[-1], 0j, complex(20 + TOOL, 0)]
    facts = measure(cut(ways), square(-1))
    assert facts.through and "at least" in findings(facts)


def test_the_tool_centre_on_the_contour():
    elements = [line(2, 40 + 0j, 40 + 20j), line(3, 40 + 20j, 0 + 20j)]
    hand = Hand().rapid(x=40.0).next_block().polar(dense([40, 40 + 20j])[1:])
    hand.next_block().polar(dense([40 + 20j, 20j])[1:])
    facts = measure(hand, elements)
    assert facts.deviation < 1e-3 and findings(facts) == ""
    assert facts.reached[0] == pytest.approx(20, abs=1e-3)


def test_coarse_pieces_stray_from_the_contour():
    turn = np.exp(1j * math.pi / 4)  # the plane turns with the part, which begins at C-45
    hand = Hand().rapid(x=abs(20 - 20j), c=-45.0).next_block().polar([20 + 5j, 20 + 20j])
    wall = line(2, (20 - 20j) * turn, (20 + 20j) * turn)
    facts = measure(hand, [wall], x=abs(20 - 20j))
    assert facts.deviation > 0.5
    assert facts.pieces == 2 and facts.longest > facts.shortest > 10


def test_an_unread_contour_is_no_proof():
    facts = measure(cut(around(TOOL)), square(-1), doubt="line 3 calls o<x>")
    assert findings(facts) == "the contour cannot be read from the words: line 3 calls o<x>"


def test_real_motion_is_measured():
    def aside(path):
        return samples_of(path, 6000, shift=0.05, axes="XZC")

    facts = measure(cut(around(TOOL)), square(-1), real=aside)
    assert facts.deviation == pytest.approx(0.05, rel=0.1)
    assert facts.left > 0 and facts.gouge == 0


def test_the_speed_of_c_is_told_with_its_limit():
    hand = Hand(feed=1e6).rapid(x=1.0).next_block().line(c=90.0)
    facts = measure(hand, [line(2, 1 + 0j, 1j)], x=1.0)
    assert facts.c_speed == pytest.approx(360) and facts.c_limit == 360


def test_the_lowest_feed_is_placed_in_the_sections_own_plane():
    hand = Hand().rapid(x=40.0, c=90.0).next_block().line(c=120.0)
    facts = measure(hand, [line(2, 40 + 0j, 40 * np.exp(1j * math.radians(30)))])
    assert facts.slowest_at == pytest.approx((40 * math.cos(math.pi / 6), 20.0, 0.0), abs=0.1)


# ---------------------------------------------------------------- block by block


def blockwise(depths, feeds, asked=(600.0, 600.0)):
    """Return a section of a lead-in, a plunge and a side, made at those depths and feeds."""
    hand = Hand().rapid(x=40.0)
    hand.feed = feeds[0]
    hand.line(z=depths[0])
    hand.next_block().polar(dense([40, 40 + 20j])[1:], feed=600.0)
    hand.moves[-1] = hand.moves[-1]._replace(
        end=(*hand.moves[-1].end[:2], depths[1], *hand.moves[-1].end[3:])
    )
    elements = [
        Element(1, 40 + 0j, 40 + 0j, 0, False, -1.0, feed=asked[0]),
        Element(2, 40 + 0j, 40 + 20j, 0, False, -1.0, feed=None),
    ]
    return measure(hand, elements)


def test_depth_and_feed_of_each_block_are_those_of_the_words():
    facts = blockwise((-1.0, -1.0), (600.0,))
    assert (facts.depth_off, facts.feed_off) == (None, None)


@pytest.mark.parametrize(
    ("depths", "line", "found"), [((-2.0, -2.0), 1, -2.0), ((-1.0, -1.5), 2, -1.5)]
)
def test_another_depth_is_told_with_its_line(depths, line, found):
    assert blockwise(depths, (600.0,)).depth_off == pytest.approx((line, found, -1.0))


@pytest.mark.parametrize(
    ("depth", "off", "end"),
    [(-2.0, 0.006, None), (-2.0, 0.009, None), (-20.0, 0.009, None), (-2.0, 0.0, -2.003)],
)
def test_inside_a_line_that_changes_z_the_tolerance_holds_in_space(depth, off, end):
    hand = Hand().rapid(x=40.0)
    hand.line(x=30.0, z=depth / 2 + off).line(x=20.0, z=end or depth)
    found = measure(hand, [Element(1, 40 + 0j, 20 + 0j, 0, False, depth, feed=600.0)]).depth_off
    if end:
        assert found == pytest.approx((1, end, depth))
    elif off > 1e-3 + TOLERANCE * math.hypot(1.0, depth / 20.0):
        assert found == pytest.approx((1, depth / 2 + off, depth / 2))
    else:
        assert found is None


def test_another_feed_is_told_with_its_line():
    assert blockwise((-1.0, -1.0), (700.0,)).feed_off == pytest.approx((1, 700.0, 600.0))


def beside_centre(share, side=0, x=0.02, turn=72.0):
    """Return what is off of one move in X and C from X0.02, made as a line or for a curve.

    With C alone it is 6.7 % longer than its chord.
    """
    hand = Hand().rapid(x=0.02).next_block().line(x=x, c=turn)
    start, end = 0.02 + 0j, x * np.exp(1j * math.radians(turn))
    programmed = abs(x - 0.02) or turn
    feed = share * 600.0 * programmed / abs(end - start)
    hand.moves[-1] = hand.moves[-1]._replace(feed=feed)
    return measure(hand, [Element(2, start, end, side, False, 0.0, feed=600.0)]).feed_off


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize(("x", "turn"), [(0.02, 72.0), (-0.004, 120.0)])
def test_a_spiral_beside_the_centre_lasts_as_long_as_its_chord(side, x, turn):
    assert beside_centre(1.0, side, x, turn) is None
    assert beside_centre(1.03, side, x, turn) and beside_centre(1.1, side, x, turn)


def test_of_a_line_the_chord_alone_tells_the_feed():
    assert beside_centre(0.97) == pytest.approx((2, 582.0, 600.0))
    assert beside_centre(0.97, side=1) is None  # compensated it may be for a curve as well


def test_a_long_curve_is_its_own_length_but_for_the_tolerance():
    hand = Hand().rapid(x=10.0).next_block()
    hand.line(c=57.3)
    hand.moves[-1] = hand.moves[-1]._replace(feed=618.0 * 57.3 / (10.0 * math.radians(57.3)))
    sweep = math.radians(57.3)
    arc = Element(2, 10 + 0j, 10 * np.exp(1j * sweep), 0, False, 0.0, 0j, sweep, 600.0)
    assert measure(hand, [arc]).feed_off == pytest.approx((2, 618.0, 600.0), rel=1e-4)


@pytest.mark.parametrize(("share", "found"), [(0.93, True), (1.0, False), (1.07, True)])
def test_chords_round_a_small_arc_last_as_long_as_it_does(share, found):
    centre, radius, pieces = 20 + 0j, 0.125, 6
    angle = math.pi / pieces
    places = centre + radius * np.exp(1j * angle * np.arange(1, pieces + 1))
    places[:-1] += (places[:-1] - centre) / radius * TOLERANCE  # outside of the arc
    start = centre + radius
    hand = Hand().rapid(x=start.real).next_block().polar(places)
    for index in range(1, len(hand.moves)):
        move = hand.moves[index]
        programmed = abs(move.end[0] - move.start[0])
        feed = share * 600.0 * programmed / (radius * angle)
        hand.moves[index] = move._replace(feed=feed)
    arc = Element(2, start, places[-1], 0, False, 0.0, centre, math.pi, 600.0)
    facts = measure(hand, [arc], x=start.real)
    assert bool(facts.feed_off) is found
