# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks of a section as lines and arcs: what they mean, and which are refused."""

import math

import pytest

from g12.errors import LONGEST_MESSAGE, Refusal
from g12.flat.contour import Arc, Contour, Line, Mark, Plunge


def started(**options):
    return Contour(10.0, 5.0, **options)


def test_a_section_starts_at_c_zero():
    contour = started()
    assert (contour.x, contour.c, contour.z, contour.side) == (10.0, 0.0, 5.0, 40)


def test_a_coordinate_left_out_stays():
    contour = started()
    contour.line(c=3.0, line=1, feed=100.0)
    contour.line(x=-4.0, line=2, feed=50.0)
    contour.line(z=1.0, line=3, feed=25.0)
    assert contour.elements == [
        Line(1, 100.0, 0.0, 10.0, 0.0, 5.0, 10.0, 3.0, 5.0),
        Line(2, 50.0, 0.0, 10.0, 3.0, 5.0, -4.0, 3.0, 5.0),
        Plunge(3, 25.0, 5.0, 1.0),
    ]
    assert (contour.x, contour.c, contour.z) == (-4.0, 3.0, 1.0)


def test_a_move_to_nowhere_is_none():
    contour = started()
    contour.line(10.0, 0.0, 5.0, line=1, feed=100.0)
    assert contour.elements == []


def test_a_feed_below_one_is_a_feed():
    contour = started()
    contour.line(c=3.0, line=1, feed=0.5)
    contour.arc(1, i=-10.0, line=2, feed=1e-6)
    assert [element.feed for element in contour.elements] == [0.5, 1e-6]


def arc_of(turn, *end, **words):
    contour = started()
    contour.arc(turn, *end, line=1, feed=100.0, **words)
    (arc,) = contour.elements
    return arc


@pytest.mark.parametrize(
    ("turn", "words", "centre", "sweep"),
    [
        (1, dict(i=-10.0), (0.0, 0.0), math.pi / 2),
        (-1, dict(i=-10.0), (0.0, 0.0), -3 * math.pi / 2),
        (1, dict(radius=10.0), (0.0, 0.0), math.pi / 2),
        (1, dict(radius=-10.0), (10.0, 10.0), 3 * math.pi / 2),
        (-1, dict(radius=10.0), (10.0, 10.0), -math.pi / 2),
        (-1, dict(radius=-10.0), (0.0, 0.0), -3 * math.pi / 2),
    ],
)
def test_arcs_to_the_top_of_a_circle(turn, words, centre, sweep):
    arc = arc_of(turn, 0.0, 10.0, **words)
    assert (arc.cx, arc.cc) == pytest.approx(centre, abs=1e-12)
    assert arc.sweep == pytest.approx(sweep)


@pytest.mark.parametrize("words", [dict(i=-3.0), dict(j=4.0), dict(i=-3.0, j=4.0)])
@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("end", [(), (10.0, 0.0), (10.0, 1e-12)])
def test_no_end_or_the_start_as_end_is_a_full_circle(turn, end, words):
    arc = arc_of(turn, *end, **words)
    assert arc.sweep == turn * 2 * math.pi
    assert (arc.cx, arc.cc) == (10.0 + words.get("i", 0.0), words.get("j", 0.0))


def test_a_rounded_centre_is_moved_to_be_as_far_from_both_ends():
    arc = arc_of(1, 0.0, 10.0, i=-10.0, j=0.004)
    assert math.hypot(10.0 - arc.cx, arc.cc) == pytest.approx(math.hypot(arc.cx, 10.0 - arc.cc))
    assert math.hypot(arc.cx, arc.cc) < 0.004


def test_a_half_circle_with_a_rounded_radius_closes():
    contour = started(closing=0.001)
    contour.arc(1, -10.0, 0.0, radius=9.9996, line=1, feed=100.0)
    assert contour.elements[0].sweep == pytest.approx(math.pi)


def test_a_helix_keeps_its_heights():
    contour = started()
    contour.arc(1, z=-3.0, i=-10.0, line=1, feed=100.0)
    (arc,) = contour.elements
    assert isinstance(arc, Arc)
    assert (arc.z0, arc.z1, contour.z) == (5.0, -3.0, -3.0)


def test_compensation_is_left_above_zero_and_right_below():
    contour = started()
    for line, side in enumerate((41, 40, 42, 40), 1):
        contour.compensation(side, 2.0, line=line)
        contour.line(c=5.0 * line, line=line, feed=100.0)
    assert [element.offset for element in contour.elements] == [2.0, 0.0, -2.0, 0.0]


@pytest.mark.parametrize("side", [40, 41])
def test_compensation_that_is_in_force_already_changes_nothing(side):
    contour = started()
    contour.compensation(41, 2.0, line=1)
    contour.line(c=5.0, line=1, feed=100.0)
    if side == 40:
        contour.compensation(40, 0.0, line=2)
        contour.line(c=9.0, line=2, feed=100.0)
    contour.compensation(side, 2.0, line=3)
    contour.arc(1, i=-1.0, line=3, feed=100.0)
    assert contour.side == side


def test_compensation_of_a_tool_without_radius_is_legal():
    contour = started()
    contour.compensation(41, 0.0, line=1)
    contour.line(c=0.001, line=1, feed=100.0)
    assert contour.side == 41


def test_marks_stand_between_the_moves():
    contour = started()
    contour.mark("M8", line=1)
    assert contour.elements == [Mark(1, "M8")]


def refused(blocks, **options):
    contour = started(**options)
    with pytest.raises(Refusal) as refusal:
        for line, (block, words) in enumerate(blocks, 1):
            getattr(contour, block)(**words, line=line)
    assert len(refusal.value.message) < LONGEST_MESSAGE
    return refusal.value.message


ON = [("compensation", dict(side=41, radius=2.0))]
CUT = dict(feed=100.0)


OWN_BLOCK = "G12.1 line 1: G41 needs a G1 with X or C in its own block"


def ramp_on(contour):
    contour.compensation(41, 2.0, line=1)
    contour.line(c=5.0, line=1, feed=100.0)


@pytest.mark.parametrize(
    ("blocks", "message"),
    [
        (
            [("line", dict(x=3.0, feed=0.0))],
            "G12.1 line 1: F0 must be above zero (no feed commanded?)",
        ),
        (
            [("arc", dict(turn=1, x=3.0, i=-1.0, feed=-1.0))],
            "G12.1 line 1: F-1 must be above zero (no feed commanded?)",
        ),
        (
            [("arc", dict(turn=1, x=3.0, i=-1.0, radius=4.0, **CUT))],
            "G12.1 line 1: G3: either R or I and J, not both",
        ),
        (
            [("arc", dict(turn=-1, x=3.0, **CUT))],
            "G12.1 line 1: G2 needs R, or the centre in I and J",
        ),
        (
            [("arc", dict(turn=-1, x=3.0, i=0.0, j=0.0, **CUT))],
            "G12.1 line 1: G2 needs R, or the centre in I and J",
        ),
        (
            [("arc", dict(turn=1, radius=4.0, **CUT))],
            "G12.1 line 1: G3 R4: a full circle needs I and J, not R",
        ),
        (
            [("arc", dict(turn=1, x=0.0, radius=4.0, **CUT))],
            "G12.1 line 1: G3 R4 does not close: the ends are 10 apart, R must be at least 5"
            "; it would close with X read as a diameter (POLAR_X = diameter)",
        ),
        (
            [("arc", dict(turn=-1, x=0.0, c=10.0, i=-9.0, **CUT))],
            "G12.1 line 1: G2 does not close: its centre is 9 from the start, 10.049876 from "
            "the end",
        ),
        (
            [("arc", dict(turn=-1, x=0.0, c=5.0, i=-5.0, **CUT))],
            "G12.1 line 1: G2 does not close: its centre is 5 from the start, 7.071068 from "
            "the end; it would close with X read as a diameter (POLAR_X = diameter)",
        ),
        (
            [*ON, ("mark", dict(action="M8"))],
            OWN_BLOCK,
        ),
        ([*ON, ("close", {})], OWN_BLOCK),
        (
            [*ON, ("line", dict(c=5.0, **CUT))],
            OWN_BLOCK,
        ),
        (
            [*ON, ("compensation", dict(side=40, radius=0.0))],
            OWN_BLOCK,
        ),
        (
            [*ON, ("arc", dict(turn=1, x=3.0, radius=9.0, **CUT))],
            "G12.1 line 2: G41 with G3: compensation is switched by a G1 only",
        ),
    ],
)
def test_refused_blocks(blocks, message):
    assert refused(blocks) == message


@pytest.mark.parametrize("reading", ["radius", "diameter"])
def test_the_reading_of_x_that_closes_the_arc_is_named(reading):
    """A quarter about the spindle, its X words read the other way."""
    right = 20.0 if reading == "radius" else 5.0
    quarter = dict(turn=1, x=0.0, c=right, i=-right, **CUT)
    message = refused([("arc", quarter)], diameter=reading == "radius")
    assert message.endswith(f"it would close with X read as a {reading} (POLAR_X = {reading})")


def test_no_reading_is_named_that_does_not_close_the_arc():
    assert refused([("arc", dict(turn=1, x=0.0, c=3.0, i=-8.0, **CUT))]).endswith("from the end")


@pytest.mark.parametrize(
    ("length", "side", "message"),
    [
        (1.9, 41, "the G1 with G41 is 1.9 long: it must be at least the tool radius 2"),
        (0.0, 42, "G42 needs a G1 with X or C in its own block"),
    ],
)
def test_a_ramp_is_at_least_as_long_as_the_tool_radius(length, side, message):
    contour = started()
    contour.compensation(side, 2.0, line=7)
    with pytest.raises(Refusal) as refusal:
        contour.line(c=length, z=-1.0, line=7, feed=100.0)
    assert refusal.value.message == f"G12.1 line 7: {message}"


def test_the_ramp_off_is_as_long_too():
    contour = started()
    ramp_on(contour)
    contour.line(c=20.0, line=2, feed=100.0)
    contour.compensation(40, 0.0, line=3)
    with pytest.raises(Refusal, match=r"^G12\.1 line 3: the G1 with G40 is 1 long: .* radius 2$"):
        contour.line(c=21.0, line=3, feed=100.0)


def test_the_side_cannot_change_without_g40():
    contour = started()
    ramp_on(contour)
    with pytest.raises(Refusal, match=r"^G12\.1 line 2: G42: cancel G41 of line 1 with G40 first$"):
        contour.compensation(42, 2.0, line=2)


def test_compensation_must_be_off_at_the_end():
    contour = started(code="G12.3")
    ramp_on(contour)
    with pytest.raises(
        Refusal, match=r"^G12\.3 line 9: G41 of line 1 is still on: G40 is missing$"
    ):
        contour.close(line=9)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (dict(x=2e6, i=1.0), "X2000000 is no length: at most 1000000"),
        (dict(c=-2e6, i=1.0), "C-2000000 is no length: at most 1000000"),
        (dict(z=2e6, i=1.0), "Z2000000 is no length: at most 1000000"),
        (dict(i=2e6), "I2000000 is no length: at most 1000000"),
        (dict(j=-2e6), "J-2000000 is no length: at most 1000000"),
        (dict(x=1.0, radius=2e6), "R2000000 is no length: at most 1000000"),
    ],
)
def test_an_arc_beyond_any_machine(words, message):
    with pytest.raises(Refusal) as refused:
        started().arc(1, line=7, feed=100.0, **words)
    assert refused.value.message == f"G12.1 line 7: {message}"


@pytest.mark.parametrize("words", [dict(i=-10.0), dict(radius=10.0)])
def test_the_other_reading_of_x_counts_for_start_and_end(words):
    """From (20, 0) to (12, 8): with half of each X it is a tenth of a circle about the spindle."""
    contour = Contour(20.0, 0.0)
    words = words if "i" in words else dict(radius=4.7)
    with pytest.raises(Refusal) as refused:
        contour.arc(1, 12.0, 8.0, line=1, feed=100.0, **words)
    assert refused.value.message.endswith(
        "it would close with X read as a diameter (POLAR_X = diameter)"
    )
