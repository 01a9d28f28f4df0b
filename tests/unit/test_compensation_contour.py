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


def started(**options):
    return Contour(10.0, 0.0, 5.0, **options)


def test_a_coordinate_left_out_stays():
    contour = started()
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
    """Give a contour a block, as "arc turn=1 x=3 radius=4"; its feed is 100 if it says none."""
    name, *words = text.split()
    pairs = (word.split("=") for word in words)
    values = {ROLES.get(key, key): json.loads(value) for key, value in pairs}
    if name in ("straight", "arc"):
        values.setdefault("feed", 100.0)
    if name == "mark":
        contour.mark(Action(line, "M8", None))
    else:
        getattr(contour, name)(**values, at=line)


def refused(*blocks, start=(10.0, 0.0, 5.0), **options):
    """Return the sentence with which the last of the blocks from line 1 on is refused."""
    contour = Contour(*start, **options)
    for line, text in enumerate(blocks[:-1], 1):
        block(contour, text, line)
    with pytest.raises(Refusal) as refusal:
        block(contour, blocks[-1], len(blocks))
    assert len(refusal.value.message) < LONGEST_MESSAGE
    return refusal.value.message


ROLES = {"x": "first", "c": "second", "z": "height"}
ON = "compensate side=41 radius=2"
RAMP = "straight c=5"
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
        ([ON, RAMP], OWN_BLOCK),
        ([ON, "compensate side=40 radius=0"], OWN_BLOCK),
        ([ON, "arc turn=1 x=3 radius=9"], "G41 with G3: compensation is switched by a G1 only"),
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
    ],
)
def test_refused_blocks(blocks, message):
    line = 2 if "with G3" in message else 1
    assert refused(*blocks) == f"G12.1 line {line}: {message}"


@pytest.mark.parametrize(
    ("length", "side", "message"),
    [
        (1.9, 41, "the G1 with G41 is 1.9 long: it must be at least the tool radius 2"),
        (0.0, 42, "G42 needs a G1 with X or C in its own block"),
    ],
)
def test_a_ramp_is_at_least_as_long_as_the_tool_radius(length, side, message):
    contour = started()
    contour.compensate(side, 2.0, at=7)
    with pytest.raises(Refusal) as refusal:
        contour.straight(second=length, height=-1.0, at=7, feed=100.0)
    assert refusal.value.message == f"G12.1 line 7: {message}"


def under_compensation(code="G12.1"):
    contour = started(code=code)
    contour.compensate(41, 2.0, at=1)
    contour.straight(second=5.0, at=1, feed=100.0)
    return contour


def test_what_compensation_in_force_refuses():
    contour = under_compensation()
    with pytest.raises(Refusal, match=r"^G12\.1 line 2: G42: cancel G41 of line 1 with G40 first$"):
        contour.compensate(42, 2.0, at=2)
    contour = under_compensation()
    contour.compensate(40, 0.0, at=3)
    with pytest.raises(Refusal, match=r"^G12\.1 line 3: the G1 with G40 is 1 long: .* radius 2$"):
        contour.straight(second=6.0, at=3, feed=100.0)
    contour = under_compensation("G12.3")
    with pytest.raises(
        Refusal, match=r"^G12\.3 line 9: G41 of line 1 is still on: G40 is missing$"
    ):
        contour.close(at=9)


def test_no_block_may_wait_for_the_machine_under_compensation():
    contour = Contour(10.0, 0.0, 0.0)
    contour.wait(at=1)
    contour.compensate(42, 2.0, at=2)
    contour.straight(10.0, 5.0, at=2, feed=100.0)
    with pytest.raises(Refusal, match=r"^G12\.1 line 3: M66 waits .* G42 of line 2 is on$"):
        contour.wait(at=3)


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


# A tool that stands beside the programmed place until a G1 takes it there.


@pytest.mark.parametrize("beside", [3.0, -3.0])
def test_an_arc_cannot_be_the_first(beside):
    contour = Contour(20.0, 0.0, 0.0, beside=beside)
    contour.straight(height=-1.0, at=6, feed=100.0)
    with pytest.raises(Refusal) as refused:
        contour.arc(1, 0.0, 20.0, radius=20.0, at=7, feed=100.0)
    assert refused.value.message == (
        "G12.1 line 7: G3 needs a G1 with X or C before it: the tool is 3 beside X's line "
        "(POLAR_TOOL_OFFSET)"
    )


def test_behind_a_g1_an_arc_begins_where_that_was_programmed_to_end():
    contour = Contour(20.0, 0.0, 0.0, beside=3.0)
    contour.straight(30.0, at=6, feed=100.0)
    contour.arc(1, 0.0, 30.0, i=-30.0, at=7, feed=100.0)
    line, arc = contour.elements
    assert (line.start, line.end, arc.start) == (20.0 + 3j, 30.0 + 0j, 30.0 + 0j)
    assert arc.curve.sweep == pytest.approx(math.pi / 2)
