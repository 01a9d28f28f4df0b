# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar sections made by hand, right and wrong, and what is measured of them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from g12.tools.path.lathe_axes import LatheAxes, Rates
from g12.tools.path.part import Part
from g12.tools.verify.compare.section import judge_toolpath
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.sections.section import measure_section
from g12.tools.verify.sections.view import view_of
from support.made_moves import Hand, samples_of, seen_by

FACE = Part(turning=True)
TOLERANCE = 0.006
TOOL = 6.0
CORNERS = [20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20 + 0j]  # counterclockwise from 20+0j
AXES = LatheAxes(Rates(150.0, 1000.0), Rates(150.0, 1000.0), Rates(360.0, 3600.0))


def line(number, start, end, side=0, ramp=False):
    return Element(number, start, end, side, ramp, 0.0)


def square(side):
    """Return a square of 40 mm, counterclockwise, with leads along X."""
    ends = [20 + 0j, *CORNERS]
    walls = [line(2 + i, a, b, side) for i, (a, b) in enumerate(zip(ends, ends[1:]))]
    return [line(1, 40 + 0j, 20 + 0j, side, True), *walls, line(9, 20 + 0j, 40 + 0j, 0, True)]


def section(elements, x=40.0, end=None, doubt="", z=0.0, **more):
    return SectionContour(1, 9, 1, end, "G12.1", complex(x), tuple(elements), doubt, z, **more)


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
    found = section(elements, end=len(hand.moves), **options)
    seen = seen_by(FACE, hand, {1: 2 * TOOL}, real)
    return measure_section(view_of(found, *seen, axes=AXES, tolerance=TOLERANCE))


def codes(facts):
    """Return the codes of what is found and noted, each with its line; a hand knows no stops."""
    found = ((each.code, each.line) for each in facts.judged)
    return [each for each in found if not each[0].startswith("blended")]


def test_a_good_section_has_no_findings():
    facts = measure(cut(around(TOOL)), square(-1))
    assert facts.deviation < 1e-3
    assert facts.values["radii"] == pytest.approx((20, 20 * math.sqrt(2)), abs=1e-3)
    assert facts.values["reached"] == pytest.approx(facts.values["radii"], abs=1e-3)
    assert np.array(facts.values["across_flats"]) == pytest.approx(np.array([[40, 40], [40, 40]]))
    assert facts.commanded.sides == [-1]
    assert codes(facts) == []


@pytest.mark.parametrize("laps", [1, 3])
def test_every_lap_is_followed(laps):
    lead, *walls, away = square(-1)
    every = [replace(wall, line=wall.line + 5 * lap) for lap in range(laps) for wall in walls]
    elements = [lead, *every, replace(away, line=5 * laps + 2)]
    assert measure(cut(laps * around(TOOL)), elements).deviation < 1e-3
    assert measure(cut((laps + 1) * around(TOOL)), elements).deviation > 1
    assert measure(cut(laps * around(TOOL)), [*elements[:-1], *walls, away]).deviation > 1


@pytest.mark.parametrize("centre", [0, 24])
def test_a_contour_of_two_elements_that_closes_on_its_lead_in(centre):
    # A D: down a line at X12, back to it clockwise over the long or the short arc of radius 20.
    start, corner, top = 12 + 30j, 12 - 16j, 12 + 16j
    sweep = (np.angle(top - centre) - np.angle(corner - centre)) % (2 * math.pi) - 2 * math.pi
    arc = Element(3, corner, top, 1, False, 0.0, complex(centre), sweep)
    leads = [line(1, 40 + 0j, 40 + 30j), line(2, 40 + 30j, start, 1, True)]
    walls = [*leads, line(3, start, corner, 1), replace(arc, line=4)]
    first = (np.angle(corner - centre) + math.pi) % (2 * math.pi) - math.pi
    about = corner + 6 * np.exp(1j * np.linspace(0, first, 200))
    round_ = centre + 26 * np.exp(1j * (first + np.linspace(0, sweep, 2000)))
    ways = [dense([40 + 30j, 18 + 30j]), dense([18 + 30j, 18 - 16j]), [*about, *round_]]
    facts = measure(cut(ways, 40 + 0j, 40 + 16j), [*walls, line(9, top, 40 + 16j, 0, True)])
    assert facts.deviation < 1e-3
    assert facts.values["radii"] == pytest.approx((12, 20) if not centre else (4, 20), abs=0.01)


def test_the_tool_centre_on_the_contour():
    elements = [line(2, 40 + 0j, 40 + 20j), line(3, 40 + 20j, 0 + 20j)]
    hand = Hand().rapid(x=40.0).next_block().polar(dense([40, 40 + 20j])[1:])
    hand.next_block().polar(dense([40 + 20j, 20j])[1:])
    facts = measure(hand, elements)
    assert facts.deviation < 1e-3 and codes(facts) == []
    assert facts.values["reached"][0] == pytest.approx(20, abs=1e-3)


def test_an_unread_contour_is_no_proof():
    facts = measure(cut(around(TOOL)), square(-1), doubt="line 3 calls o<x>")
    (found,) = facts.judged
    assert found.is_note and facts.values["deviation"] is None
    assert "cannot be read from the words, line 3 calls o<x>" in found.text()


def test_real_motion_is_measured():
    def aside(path):
        return samples_of(path, 6000, shift=0.05, axes="XZC")

    facts = measure(cut(around(TOOL)), square(-1), real=aside)
    assert facts.deviation == pytest.approx(0.05, rel=0.1)


def test_the_speed_of_c_is_told_with_its_limit():
    hand = Hand(feed=1e6).rapid(x=1.0).next_block().line(c=90.0)
    facts = measure(hand, [line(2, 1 + 0j, 1j)], x=1.0)
    assert facts.values["c_speed"] == pytest.approx(360) and facts.values["c_limit"] == 360


def test_c_may_pass_its_limit_by_half_the_acceleration_of_a_period():
    axes = AXES._replace(c=Rates(90.0, 1200.0))
    assert axes.most_c_speed == pytest.approx(90.6)


def test_a_place_is_told_as_the_program_writes_it():
    facts = measure(cut(around(TOOL + 0.02)), square(-1), diameters=True)
    (found,) = [each for each in facts.judged if each.code == "path-off"]
    assert found.text().endswith("at X52.04 C0.05 Z0")
    assert found.place == pytest.approx((26.02, 0.05, 0))


def test_the_lowest_feed_is_placed_in_the_sections_own_plane():
    hand = Hand().rapid(x=40.0, c=90.0).next_block().line(c=120.0)
    facts = measure(hand, [line(2, 40 + 0j, 40 * np.exp(1j * math.radians(30)))])
    place = [value for _, value in facts.values["lowest_feed_words"]]
    assert place == pytest.approx([40 * math.cos(math.pi / 6), 20.0, 0.0], abs=0.1)


# ---------------------------------------------------------------- levels and feeds


@pytest.mark.parametrize(("off", "found"), [(0.005, False), (0.009, True)])
def test_inside_a_line_that_changes_z_the_tolerance_holds_in_space(off, found):
    hand = Hand().rapid(x=40.0)
    hand.line(x=30.0, z=-1.0 + off).line(x=20.0, z=-2.0)
    facts = measure(hand, [Element(1, 40 + 0j, 20 + 0j, 0, False, -2.0, feed=600.0)])
    assert (("path-off", 1) in codes(facts)) is found


@pytest.mark.parametrize(("x", "turn"), [(2.0, 72.0), (3.0, 60.0)])
@pytest.mark.parametrize(("share", "off"), [(0.97, True), (1.0, False), (1.03, True)])
def test_a_spiral_beside_the_centre_lasts_as_long_as_the_line_that_it_is_for(x, turn, share, off):
    hand = Hand().rapid(x=2.0).next_block().line(x=x, c=turn)
    start, end = 2.0 + 0j, x * np.exp(1j * math.radians(turn))
    programmed = abs(x - 2.0) or turn
    feed = share * 600.0 * programmed / abs(end - start)
    hand.moves[-1] = hand.moves[-1]._replace(feed=feed)
    made = section([replace(line(2, start, end), feed=600.0)], end=2, x=2.0)
    view = view_of(made, *seen_by(FACE, hand, {}), axes=AXES, tolerance=1.0)
    assert [each.code for each in judge_toolpath(view)] == ["feed"] * off


@pytest.mark.parametrize(("share", "found"), [(0.98, True), (1.0, False), (1.02, True)])
def test_chords_round_a_small_arc_last_as_long_as_it_does(share, found):
    centre, radius, segments = 20 + 0j, 0.125, 6
    angle = math.pi / segments
    places = centre + radius * np.exp(1j * angle * np.arange(1, segments + 1))
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
    assert ("feed", 2) in codes(facts) if found else codes(facts) == []
