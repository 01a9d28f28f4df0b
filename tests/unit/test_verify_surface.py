# SPDX-License-Identifier: GPL-2.0-or-later
"""Sections on a cylinder made by hand, right and wrong, and what is measured of them.

The surface has the radius 20. The tool's centre is drawn on it unrolled: to the right the way
round, upwards Z; X is the height.
"""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

from g12.tools.path.lathe_axes import LatheAxes, Rates
from g12.tools.path.surface import Surface
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.sections.section import measure_section
from g12.tools.verify.sections.view import view_of
from support.made_moves import Hand, samples_of, seen_by

RADIUS, DEPTH, AIR, TOOL = 20.0, 18.0, 24.0, 3.0
TOLERANCE = 0.006
AXES = LatheAxes(Rates(150.0, 1000.0), Rates(150.0, 1000.0), Rates(360.0, 3600.0))
RISE = 40 + 12j  # where a groove ends that begins at 0: along C, and by Z
QUARTER = Element(4, 30 + 0j, 40 + 10j, 0, False, DEPTH, 30 + 10j, math.pi / 2, 600.0)


class Unrolled(Hand):
    """A hand that draws on the surface; C begins at 90 degrees and X at the height of the air."""

    def __init__(self):
        super().__init__()
        self.rapid(x=AIR, z=-7.0, c=90.0)

    def cut(self, *points, feed=600.0, number=None):
        """Go straight to points of the contour's plane; the feed is that along the surface."""
        self.block = number or self.block + 1
        for point in points:
            c, z = 90.0 + math.degrees(point.real / RADIUS), -7.0 + point.imag
            length = math.hypot(math.radians(c - self.at[5]) * RADIUS, z - self.at[2])
            moved = abs(z - self.at[2]) or abs(c - self.at[5])
            self.feed = feed * moved / length
            self.line(z=z, c=c)
        return self

    def down(self, x=DEPTH):
        self.block, self.feed = self.block + 1, 200.0
        return self.line(x=x)

    def up(self):
        return self.down(AIR)


def drawn(*ends, side=0, first=3):
    """Return the elements of a groove through points, plunge and retreat around it."""
    elements = [Element(2, 0j, 0j, 0, False, DEPTH, feed=200.0)]
    for number, (start, end) in enumerate(zip((0j, *ends), ends), first):
        elements.append(Element(number, start, end, side, False, DEPTH, feed=600.0))
    last = elements[-1]
    return [*elements, Element(last.line + 1, last.end, last.end, 0, False, AIR, feed=200.0)]


def facts_of(hand, elements, real=None):
    contour = SectionContour(
        1, 9, 1, len(hand.moves), "G7.1", 0j, tuple(elements), height=AIR, surface=RADIUS
    )
    return measured(hand, contour, real)


def measured(hand, contour, real=None):
    seen = seen_by(Surface(turning=True, radius=RADIUS), hand, {1: 2 * TOOL}, real)
    return measure_section(view_of(contour, *seen, axes=AXES, tolerance=TOLERANCE))


def findings(hand, elements):
    for index, move in enumerate(hand.moves):
        hand.moves[index] = move._replace(exact=True)
    return texts(facts_of(hand, elements))


def texts(facts):
    """Return what is found and noted: codes, lines and sentences."""
    return " | ".join(f"{each.code} {each.line}: {each.text()}" for each in facts.judged)


def groove(c=0.0):
    """Return a groove with a corner, cut right but for C."""
    return Unrolled().down().cut(30 + 0j + c).cut(RISE + c).up()


ASKED = drawn(30 + 0j, RISE)


def test_a_groove_of_lines_is_exact():
    facts = facts_of(groove(), ASKED)
    assert findings(groove(), ASKED) == ""
    assert facts.deviation < 1e-9 and facts.values["segments"] == 2
    assert facts.values["along_z"] == pytest.approx((0, 12))
    assert facts.values["reached"] == pytest.approx((0, 12))
    assert facts.values["lowest"] == DEPTH


@pytest.mark.parametrize(
    ("hand", "found"),
    [
        (groove(c=0.05), "path-off 3: the contour is 0.05 mm off"),
        (Unrolled().down().cut(RISE, number=4).up(), "path-off 3"),
        (Unrolled().down().cut(RISE, number=4).cut(30 + 0j, number=3).up(), "path-off 3"),
    ],
)
def test_a_wrong_groove_is_found(hand, found):
    assert found in findings(hand, ASKED)


def arc(count, radius=10.0):
    """Return points along the quarter of an arc of QUARTER's centre."""
    turns = np.linspace(0, math.pi / 2, count + 1)[1:]
    return [30 + 10j + cmath.rect(radius, turn - math.pi / 2) for turn in turns]


@pytest.mark.parametrize(("count", "off"), [(40, 0.002), (4, 0.19)])
def test_the_segments_of_an_arc(count, off):
    hand = Unrolled().down().cut(30 + 0j).cut(*arc(count)).up()
    line = drawn(30 + 0j)
    up = replace(line[2], start=QUARTER.end, end=QUARTER.end)
    facts = facts_of(hand, [*line[:2], QUARTER, up])
    assert facts.deviation == pytest.approx(10 * (1 - math.cos(math.pi / 4 / count)), rel=0.05)
    assert (facts.deviation > TOLERANCE) == (off > TOLERANCE)
    assert facts.values["direction_jump"] == pytest.approx(90 / count)


def wall(side):
    """Return a wall along C from 10 to 40 with leads from Z and back."""
    return [
        Element(2, 10j, 0j, side, True, DEPTH, feed=600.0),
        Element(3, 0j, 40 + 0j, side, False, DEPTH, feed=600.0),
        Element(4, 40 + 0j, 40 + 10j, 0, True, DEPTH, feed=600.0),
    ]


def beside(away):
    return Unrolled().rapid(z=3.0, x=DEPTH).cut(away * 1j).cut(40 + away * 1j).cut(40 + 10j)


@pytest.mark.parametrize(
    ("side", "away", "found"),
    [
        (1, TOOL, ""),
        (1, TOOL - 0.1, "path-off 2: the ramp is 0.1 mm off"),
        (1, TOOL + 0.1, "path-off 2: the ramp is 0.1 mm off"),
        (-1, TOOL, "path-off 2"),
    ],
)
def test_compensation_keeps_the_cutter_on_its_side(side, away, found):
    hand = beside(away)
    contour = SectionContour(
        1, 9, 2, len(hand.moves), "G7.1", 10j, tuple(wall(side)), height=DEPTH, surface=RADIUS
    )
    facts = measured(hand, contour)
    assert found in texts(facts)
    assert bool(found) == (facts.deviation > TOLERANCE)


def run_beside(z):
    """Return what makes samples of a run that is beside its path along Z."""

    def run(path):
        samples = samples_of(path, axes="XZC")
        return replace(samples, axes={**samples.axes, "Z": samples.axes["Z"] + z})

    return run


def test_a_run_is_measured_on_the_surface():
    runs = [run_beside(0.0), run_beside(0.03)]
    right, beside = (facts_of(groove(), ASKED, run) for run in runs)
    assert right.deviation < 0.001 and beside.deviation == pytest.approx(0.03)
    assert right.values["seconds"] > 5.0
