# SPDX-License-Identifier: GPL-2.0-or-later
"""Spacing by itself: shares of a deviation, and no element that takes segments for ever."""

import math

import numpy as np
import pytest

from g12.errors import Refusal
from g12.moves.steps import MOST_SEGMENTS_OF_MOVE, spaced
from support.contour_geometry import Round
from support.planned_cuts import programmed
from support.section_starts import polar


def test_the_most_segments_are_made():
    places, _ = spaced(1.0, lambda _: (MOST_SEGMENTS_OF_MOVE - 1.0, 1.0))
    assert len(places) == MOST_SEGMENTS_OF_MOVE + 1


def test_an_arc_of_too_many_segments_is_refused_with_its_line():
    far = Round(1e6 + 0j, 1e5 + 0j, 2 * math.pi)
    with pytest.raises(Refusal) as refused:
        polar(tolerance=1e-5).plan(programmed([far]))
    assert refused.value.message == (
        "G12.1 line 1: more than 100000 moves would be needed to stay within POLAR_TOLERANCE"
    )


@pytest.mark.parametrize(("start", "end"), [(0.5, 4.0), (-4.0, -0.5), (-3.0, 4.0)])
@pytest.mark.parametrize("fine", [2.9, 7.3, 40.0])
def test_segments_are_equal_parts_of_the_density_but_for_what_the_ends_lose(start, end, fine):
    """An end that is exactly on the path loses 0.18 segments; an apsis, at 0 here, loses none."""
    apsides = [0.0] if start * end < 0.0 else []
    steps = []

    def density(at):
        place = start + at
        steps.append(place)
        return fine / (1.0 + 0.2 * abs(place)), 0.1 * (5.0 + place)

    inside = [apsis - start for apsis in apsides]
    places, shares = spaced(end - start, density, inside, lambda at: abs(start + at))
    places = [start + at for at in places]
    assert max(map(abs, steps)) < max(abs(start), abs(end)) + 1.0 / fine
    every = np.linspace(start, end, 4001)
    segments = np.append(0.0, np.cumsum(abs(np.diff(every)) * fine / (1.0 + 0.2 * abs(every[1:]))))
    measured = np.interp(places, every, segments)
    cuts = [start, *apsides, end]
    for first, last in zip(cuts, cuts[1:]):
        inside = slice(places.index(first), places.index(last) + 1)
        lost = 0.18 * ((first == start) + (last == end))
        gaps, count = np.diff(measured[inside]), measured[inside][-1] - measured[inside][0]
        assert len(gaps) - 1.02 < count + lost < len(gaps) + 0.02
        length = count / (len(gaps) - lost)
        whole = np.full(len(gaps), length)
        whole[0] -= 0.18 * length * (first == start)
        whole[-1] -= 0.18 * length * (last == end)
        assert gaps == pytest.approx(whole, abs=0.008)
        inner = slice(inside.start + 1, inside.stop - 1)
        off = [length**2 * 0.1 * (5.0 + place) for place in places[inner]]
        assert shares[inner] == pytest.approx(off, abs=0.008)
    assert shares[0] == shares[-1] == 0.0
