# SPDX-License-Identifier: GPL-2.0-or-later
"""What is led through the spindle's centre, and what stands in its place."""

import math
from itertools import groupby

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Contour, Plunge
from g12.geometry.curve import Arc
from g12.polar.pole import through_pole
from support import planned_moves
from support.contour_geometry import shape_of

REACH = 0.0025


def line(x0, c0, x1, c1, h0=0.0, h1=0.0):
    return planned_moves.line(x0, c0, x1, c1, h0, h1, number=3)


def arc(cx, cc, x0, c0, sweep, h0=0.0, h1=0.0):
    return planned_moves.arc(complex(cx, cc), complex(x0, c0), sweep, h0, h1, number=3)


def led(*path, reach=REACH, refused=False):
    return through_pole(Contour(10.0, 0.0, 0.0), list(path), reach, refused)


def ends(parts):
    """Return the ends of moves, one after the other, and check that they are."""
    for one, other in zip(parts, parts[1:]):
        assert (one.end, one.h1) == (pytest.approx(other.start, abs=1e-12), pytest.approx(other.h0))
    first, places = parts[0], [(part.end.real, part.end.imag, part.h1) for part in parts]
    return [(first.start.real, first.start.imag, first.h0), *places]


@pytest.mark.parametrize("radius", [0.003, 0.0039])
def test_of_a_small_circle_a_sixth_on_either_side_is_replaced_at_most(radius):
    first, to, fro, last = led(arc(radius, 0, 2 * radius, 0, 2 * math.pi))
    assert abs(to.start) == pytest.approx(radius)
    assert abs(fro.end) == pytest.approx(radius)
    assert [part.curve.sweep for part in (first, last)] == pytest.approx([2 / 3 * math.pi] * 2)


def at_pole(plunge):
    """Return a plunge in the pole as a line of no length in the plane."""
    return plunge if not isinstance(plunge, Plunge) else line(0, 0, 0, 0, plunge.h0, plunge.h1)


def points(move, count):
    """Return places of a move, complex, and their heights."""
    return shape_of(move.curve).points(count), np.linspace(move.h0, move.h1, count)


beside = st.sampled_from([0.0, 0.5, -0.5, 0.9, -0.9, 1.1, -1.1, 4.0]).map(lambda b: b * REACH)
where = st.floats(-9.0, 9.0) | st.sampled_from([0.0, 0.4 * REACH, -0.9 * REACH, 0.03])
angle = st.floats(-math.pi, math.pi)
sweeps = st.floats(0.1, 6.2) | st.just(2 * math.pi)


def turned_line(b, first, last, by):
    unit = complex(math.cos(by), math.sin(by))
    start, end = (unit * (at + 1j * b) for at in (first, last))
    return line(start.real, start.imag, end.real, end.imag, 0.0, -4.0)


def turned_arc(b, radius, first, sweep, by):
    unit = complex(math.cos(by), math.sin(by))
    centre = unit * (radius + b)
    start = centre + radius * unit * complex(math.cos(first), math.sin(first))
    return arc(centre.real, centre.imag, start.real, start.imag, sweep, 0.0, -4.0)


near_lines = st.builds(turned_line, beside, where, where, angle)
signed = sweeps.flatmap(lambda turn: st.sampled_from((turn, -turn)))
from_pole = angle | st.sampled_from([math.pi, 3.1415, 3.12])
near_arcs = st.builds(turned_arc, beside, st.floats(0.02, 40.0), from_pole, signed, angle)


@settings(max_examples=150)
@given(near_lines | near_arcs)
def test_what_is_led_through_the_pole_is_the_move_but_for_its_reach(move):
    """In order, as high as it, never farther from it; what is farther from the pole stays."""
    whole, heights = points(move, 4001)
    near, step = abs(whole).min(), abs(whole[1] - whole[0])
    assume(step and abs(near - REACH) > step and abs(whole).max() > 10 * REACH)
    made = [at_pole(part) for part in led(move)]
    places = ends(made)
    assert [places[0][2], places[-1][2]] == pytest.approx([0.0, -4.0], abs=1e-9)
    assert near < REACH or made == [move]
    places = [place for place, _ in groupby(place[:2] for place in places)]
    passes = places.count((0.0, 0.0))
    assert passes == (near < REACH) * (1 + (isinstance(move.curve, Arc) and ends_twice(move)))
    for part in made:
        assert (part.line, part.feed) == (3, 100.0)
        for place, height in zip(*points(part, 7)):
            nearest = abs(whole - place).argmin()
            assert abs(whole[nearest] - place) <= 1.2 * REACH + step
            assert abs(heights[abs(whole - place) < 1.5 * REACH + step] - height).min() < 0.02
    turns = {math.copysign(1.0, part.curve.sweep) for part in made if isinstance(part.curve, Arc)}
    assert turns <= {math.copysign(1.0, getattr(move.curve, "sweep", 0.0))}


def ends_twice(move):
    """Return whether an arc both begins and ends within reach, with a way between them."""
    return max(abs(move.start), abs(move.end)) <= REACH
