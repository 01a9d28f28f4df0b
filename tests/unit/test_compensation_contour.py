# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks of a section as lines and arcs: what they mean, and which are refused."""

import cmath
import json
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from g12.compensation.contour import Contour, Plunge
from g12.errors import LONGEST_MESSAGE, Refusal
from g12.section.effects import Action
from support import planned_moves


def test_a_coordinate_left_out_stays():
    contour = Contour(10.0, 0.0, 5.0)
    contour.straight(second=3.0, at=1, feed=100.0)
    contour.straight(first=-4.0, at=2, feed=50.0)
    contour.straight(height=1.0, at=3, feed=25.0)
    assert contour.elements == [
        planned_moves.line(10.0, 0.0, 10.0, 3.0, 5.0, 5.0),
        planned_moves.line(10.0, 3.0, -4.0, 3.0, 5.0, 5.0, number=2, feed=50.0),
        Plunge(3, 25.0, 5.0, 1.0),
    ]
    assert (contour.first, contour.second, contour.height) == (-4.0, 3.0, 1.0)


coordinate = st.floats(-30.0, 30.0)
point = st.builds(complex, coordinate, coordinate)


@given(point, point, st.floats(0.1, 6.2), st.sampled_from([1, -1]))
def test_an_arc_anywhere_by_its_centre_and_by_its_radius(start, arm, angle, turn):
    radius, centre = abs(arm), start + arm
    assume(radius > 0.1 and abs(angle - math.pi) > 0.1)
    end = centre - arm * cmath.exp(1j * turn * angle)
    by_centre = dict(i=arm.real, j=arm.imag)
    for words in (by_centre, dict(radius=math.copysign(radius, math.pi - angle))):
        contour = Contour(start.real, start.imag, 5.0)
        contour.arc(turn, end.real, end.imag, -2.0, at=1, feed=100.0, **words)
        (arc,) = contour.elements
        assert (arc.start, arc.h0, arc.h1) == (start, 5.0, -2.0)
        assert arc.end == pytest.approx(end, abs=1e-9)
        assert arc.curve.centre == pytest.approx(centre, abs=1e-9)
        assert arc.curve.sweep == pytest.approx(turn * angle, abs=1e-9)


def block(contour, text, line):
    """Give a contour a block: "compensate side=41 radius=2; straight c=5"; else its F is 100."""
    for command in text.split("; "):
        name, *words = command.split()
        pairs = (word.split("=") for word in words)
        values = {ROLES.get(key, key): json.loads(value) for key, value in pairs}
        if name in ("straight", "arc"):
            values.setdefault("feed", 100.0)
        if name == "mark":
            contour.mark(Action(line, "M8", None))
        else:
            getattr(contour, name)(**values, at=line)


ROLES = {"x": "first", "c": "second", "z": "height"}
ON = "compensate side=41 radius=2"
RAMP = f"{ON}; straight c=5"
OWN_BLOCK = "G41 needs a G1 with X or C in its own block"


@pytest.mark.parametrize(
    ("blocks", "message"),
    [
        (["straight x=3 feed=0"], "F0 must be above zero (no feed commanded?)"),
        (["arc turn=1 x=3 i=-1 feed=-1"], "F-1 must be above zero (no feed commanded?)"),
        (["arc turn=1 x=3 i=-1 radius=4"], "G3: either R or I and J, not both"),
        (["arc turn=-1 x=3 i=0 j=0"], "G2 needs R, or the centre in I and J"),
        (["arc turn=1 radius=4"], "G3 R4: a full circle needs I and J, not R"),
        (
            ["arc turn=1 x=0 radius=4"],
            "G3 R4 does not close: the ends are 10 apart, R must be at least 5",
        ),
        (
            ["arc turn=-1 x=0 c=10 i=-9"],
            "G2 does not close: its centre is 9 from the start, 10.049876 from the end",
        ),
        (
            ["arc turn=-1 x=0 c=5 i=-5"],
            "G2 does not close: its centre is 5 from the start, 7.071068 from the end",
        ),
        ([ON, "mark"], OWN_BLOCK),
        ([ON, "close"], OWN_BLOCK),
        ([ON, "straight c=5"], OWN_BLOCK),
        ([ON, "compensate side=40 radius=0"], OWN_BLOCK),
        ([f"{ON}; arc turn=1 x=3 radius=9"], "G41 with G3: compensation is switched by a G1 only"),
        *(
            ([f"straight {word}=-2e6"], f"{word.upper()}-2000000 is no length: at most 1000000")
            for word in "xcz"
        ),
        *(
            (
                [f"arc turn=1 x=1 i=1 {word}=2e6"],
                f"{word.upper()}2000000 is no length: at most 1000000",
            )
            for word in "xczij"
        ),
        (["arc turn=1 x=1 radius=2e6"], "R2000000 is no length: at most 1000000"),
        (
            [f"{ON}; straight c=1.9 z=-1"],
            "the G1 with G41 is 1.9 long: it must be at least the tool radius 2",
        ),
        ([f"{ON}; straight c=0 z=-1"], OWN_BLOCK),
        ([RAMP, "compensate side=42 radius=2"], "G42: cancel G41 of line 1 with G40 first"),
        (
            [RAMP, "compensate side=40 radius=0; straight c=6"],
            "the G1 with G40 is 1 long: it must be at least the tool radius 2",
        ),
        ([RAMP, "close"], "G41 of line 1 is still on: G40 is missing"),
        ([RAMP, "wait"], "M66 waits for the machine, which needs G40: G41 of line 1 is on"),
    ],
)
def test_refused_blocks(blocks, message):
    """The last one is, or the one whose G41 has no G1."""
    contour = Contour(10.0, 0.0, 5.0)
    with pytest.raises(Refusal) as refused:
        for line, text in enumerate(blocks, 1):
            block(contour, text, line)
    line = 1 if message == OWN_BLOCK else len(blocks)
    assert refused.value.message == f"G12.1 line {line}: {message}"
    assert len(refused.value.message) < LONGEST_MESSAGE


# What LinuxCNC forgives any arc: a thousandth of its radius, or what rounded words need.
ROUNDED = dict(radius_tolerance=0.0127)


@pytest.mark.parametrize(("share", "closes"), [(0.98, True), (1.02, False)])
@pytest.mark.parametrize(
    ("radius", "options", "off", "word"),
    [
        *((10.0, {}, off, "i") for off in (0.01, -0.01)),
        *((10.0, ROUNDED, off, "i") for off in (0.0127, -0.0127)),
        (100.0, ROUNDED, 0.1, "i"),
        (10.0, {}, 0.01, "radius"),
        (1.0, ROUNDED, 0.00635, "radius"),
    ],
)
def test_the_end_of_an_arc_may_be_off_its_circle(radius, options, off, word, share, closes):
    """The radius of a half circle may be too small."""
    contour, off = Contour(radius, 0.0, 0.0, **options), share * off
    end, value = ((0.0, radius + off), -radius) if word == "i" else ((-radius, 0.0), radius - off)
    try:
        contour.arc(1, *end, **{word: value}, at=1, feed=100.0)
    except Refusal as refusal:
        assert not closes and "does not close" in refusal.message
    else:
        assert closes


def test_a_tool_beside_the_programmed_place_needs_a_g1_before_an_arc():
    contour = Contour(20.0, 0.0, 0.0, beside=3.0)
    contour.straight(height=-1.0, at=5, feed=100.0)
    beside = r"G3 needs a G1 .*: the tool is 3 beside X's line \(POLAR_TOOL_OFFSET\)$"
    with pytest.raises(Refusal, match=beside):
        contour.arc(1, 0.0, 20.0, radius=20.0, at=5, feed=100.0)
    contour.straight(30.0, at=6, feed=100.0)
    contour.arc(1, 0.0, 30.0, i=-30.0, at=7, feed=100.0)
    _, line, arc = contour.elements
    assert (line.start, line.end, arc.start) == (20.0 + 3j, 30.0 + 0j, 30.0 + 0j)
    assert arc.curve.sweep == pytest.approx(math.pi / 2)
