# SPDX-License-Identifier: GPL-2.0-or-later
"""The travel of a machine's axes, for moves in the program's coordinates."""

import pytest

from g12.machine_ini import Axis
from g12.moves.setup import SectionMachine
from g12.moves.steps import Segments
from g12.polar.polar_section import Polar
from g12.settings import Settings
from support.section_starts import START, with_found

AXES = {"X": Axis(-10, 300, 1, 1), "C": Axis(-360, 720, 1, 1), "Z": Axis(-200, 20, 1, 1)}


def leaving(steps, **found):
    start = with_found(START, **{"offsets": dict.fromkeys("XCZ", 0.0), **found})
    return Polar(start, SectionMachine(frozenset("XZC"), Settings(), AXES)).beyond_travel(steps)


@pytest.mark.parametrize(
    ("place", "axis", "text"),
    [
        ((-10.001, 0, 0), "X", "-10.001 mm, beyond its limit -10 mm"),
        ((0, 720.001, 0), "C", "720.001 degrees, beyond its limit 720 degrees"),
        ((0, -360.001, 0), "C", "-360.001 degrees, beyond its limit -360 degrees"),
        ((0, 0, 20.001), "Z", "20.001 mm, beyond its limit 20 mm"),
        ((0, 0, -200.001), "Z", "-200.001 mm, beyond its limit -200 mm"),
        ((-11, 0, -201), "X", "-11 mm, beyond its limit -10 mm"),
    ],
)
def test_every_axis_has_its_ends_and_may_stand_on_them(place, axis, text):
    ends = [(-10, -360, -200, 1), (300, 720, 20, 1)]
    within, after = Segments(3, "XCZ", ends, False), Segments(5, "XCZ", [(999, 0, 0, 1)], False)
    assert leaving([within]) is None
    line, beyond = leaving([within, Segments(4, "XCZ", [*ends, (*place, 1)], False), after])
    assert (line, beyond.axis) == (4, axis)
    assert beyond.rule == f"the {axis} axis would go to {text}"


@pytest.mark.parametrize(
    ("end", "text"),
    [
        ((12.3, 631.0), "C axis would go to 721 degrees"),
        ((12.4, 0), "X axis would go to 302.26 mm"),
    ],
)
def test_offsets_are_of_the_program_and_limits_of_the_machine(end, text):
    offsets = {"X": -0.5, "C": 90.0, "Z": 0.0}
    run = Segments(3, "XC", [(*end, 0, 1)], False)
    _, beyond = leaving([run], inch=True, offsets=offsets)
    assert beyond.rule.startswith(f"the {text}")
