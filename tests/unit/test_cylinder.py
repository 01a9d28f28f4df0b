# SPDX-License-Identifier: GPL-2.0-or-later
"""Contours on the unrolled surface as moves of Z and C, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Contour, Start
from g12.cylinder import (
    CYLINDER_WORDS,
    CYLINDERS,
    Cylinder,
    CylinderSteps,
)
from g12.errors import Refusal
from g12.machine_ini import Axis
from g12.moves.setup import SectionMachine
from g12.section.block_rules import SectionBlock
from g12.section.effects import codes_of_section
from g12.section.line import BlockLocation
from g12.settings import Settings
from support import planned_moves
from support.section_starts import START as POLAR_START
from support.section_starts import with_found

RADIUS = 20.0
AXES = {
    "X": Axis(-10.0, 100.0, 50.0, 900.0),
    "Z": Axis(-100.0, 100.0, 50.0, 1100.0),
    "C": Axis(-720.0, 720.0, 360.0, 3600.0),
}
START = with_found(
    POLAR_START,
    location=BlockLocation("G7.1", 7),
    words={"C": RADIUS},
    x=22.0,
    c=30.0,
    z=5.0,
    plane="G19",
)


def empty(c=0.0, z=0.0, x=22.0):
    """Return the contour of a section that begins at C in degrees, Z and X."""
    start = Start(z, math.radians(c), x)
    return Contour(math.radians(c) * RADIUS, z, x, plane=CYLINDER_WORDS.plane, start=start)


@settings(max_examples=150)
@given(
    size=st.floats(1e-3, 500.0),
    centre=st.complex_numbers(max_magnitude=300.0),
    sweep=st.floats(0.01, 2 * math.pi),
    turn=st.sampled_from([1, -1]),
    surface=st.floats(0.5, 300.0),
    deviation=st.sampled_from([1e-4, 0.005, 0.1]),
)
def test_the_segments_of_any_arc_keep_to_it(size, centre, sweep, turn, surface, deviation):
    """Chords between the ends are no farther from the circle than half as much again inside."""
    start, end = centre + size * np.exp(1j * np.array([0.3, 0.3 + turn * sweep]))
    arc = planned_moves.arc(centre, complex(start), turn * sweep)
    split = CylinderSteps(empty(), section(words={"C": surface})).split(arc, deviation)
    places = np.array(split.angles) * surface + 1j * np.array(split.slides)
    assert places[[0, -1]] == pytest.approx([start, end])
    places -= centre
    middles = (places[1:] + places[:-1]) / 2
    off = np.concatenate([abs(places), abs(middles)]) - size
    assert abs(off).max() <= deviation * (1 + 1e-6) + 1e-9
    assert abs(off[: len(places)]).max() <= size / 48 + 1e-9  # two thirds of the widest bulge
    assert split.lengths[-1] == pytest.approx(size * sweep)
    angles = np.unwrap(np.angle(places))
    assert (np.diff(angles) * turn > 0).all()
    widest = math.sqrt(12 * deviation / size)  # the angle of a chord that bulges by 3/2 of it
    assert len(places) - 1 <= sweep * max(1 / widest, 2.0) + 1.4


# ---------------------------------------------------------------- how it begins, its words


def section(letters="XZC", axes=AXES, **found):
    machine = SectionMachine(frozenset(letters), Settings(), axes)
    return Cylinder(with_found(START, **found), machine)


def test_one_code_switches_on_and_off():
    codes = codes_of_section("G7.1", [], "cylinder_mode", "cylinder_mode", "C")

    def block(g=71, **words):
        return SectionBlock((-1, g), (), g, words)

    assert codes.off_code == "G7.1 C0"
    for made, begins, ends in (
        (block(C=5.0), True, False), (block(), True, False), (block(C=0.0), False, True),
        (block(g=72), False, False), (block(g=72, C=0.0), False, False),
    ):  # fmt: skip
        assert (codes.begins(made), codes.ends(made)) == (begins, ends)


# ---------------------------------------------------------------- on a mill with A or B


ON_MILL = {
    letter: Axis(-500.0, 500.0, 50.0, acceleration)
    for letter, acceleration in zip("XYZAB", (900.0, 1000.0, 1100.0, 3600.0, 3600.0))
}
AT_AXIS = {"A": dict(x=30.0, z=22.0, c=0.0), "B": dict(x=0.0, y=30.0, z=22.0)}


def on_mill(letter, settings=Settings(), letters="XYZAB", **found):  # noqa: B008 - it is frozen
    start = with_found(START, **{"words": {letter: RADIUS}, **AT_AXIS[letter], **found})
    return CYLINDERS[letter](start, SectionMachine(frozenset(letters), settings, ON_MILL))


@pytest.mark.parametrize(
    ("letter", "found", "rule"),
    [
        ("C", {"rotation": 1.0}, "needs an unrotated work offset (G10 L2 R0)"),
        ("C", {"words": {"C": 0.0}},
         "C0, the cylinder's radius, must be above 0 and at most 1000000"),
        ("A", {"words": {"A": -2.0}},
         "A-2, the cylinder's radius, must be above 0 and at most 1000000"),
        ("A", {"words": {}}, "needs A, the cylinder's radius; A0 ends a section"),
        ("B", {"x": -0.01},
         "needs X0: the tool must stand on the axis of rotation, not at X-0.01"),
        ("B", {"letters": "XYZ"}, "needs a machine with an Y, B and a Z axis"),
        ("A", {"shifts": {"X": 9.0, "Y": 0.0, "Z": -3.0}},
         "Z0 must be the axis of rotation: G52 or G92 shifts Z by -3; cancel it with G92.1"
         " (a Z offset of G54 may stay)"),
        ("B", {"shifts": {"X": 2.0, "Y": 9.0, "Z": 0.0}},
         "X0 must be the axis of rotation: G52 or G92 shifts X by 2; cancel it with G92.1"
         " (an X offset of G54 may stay)"),
    ],
)  # fmt: skip
def test_where_no_section_begins(letter, found, rule):
    with pytest.raises(Refusal) as refused:
        section(**found) if letter == "C" else on_mill(letter, **found)
    assert refused.value.message == f"G7.1 line 7: {rule}"
