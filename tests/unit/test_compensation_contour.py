# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks of a section as lines and arcs: what they mean, and which are refused."""

import cmath
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from g12.compensation.contour import Contour, Mark, Plunge
from g12.errors import LONGEST_MESSAGE, Refusal
from g12.geometry.curve import Arc
from support import planned_moves


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
        planned_moves.line(10.0, 0.0, 10.0, 3.0, 5.0, 5.0),
        planned_moves.line(10.0, 3.0, -4.0, 3.0, 5.0, 5.0, number=2, feed=50.0),
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
    return arc.curve


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
    assert arc.centre == pytest.approx(complex(*centre), abs=1e-12)
    assert arc.sweep == pytest.approx(sweep)


coordinate = st.floats(-30.0, 30.0)
point = st.builds(complex, coordinate, coordinate)


@given(point, point, st.floats(0.1, 6.2), st.sampled_from([1, -1]))
def test_an_arc_anywhere_by_its_centre_and_by_its_radius(start, arm, angle, turn):
    radius, centre = abs(arm), start + arm
    assume(radius > 0.1 and abs(angle - math.pi) > 0.1)
    end = centre - arm * cmath.exp(1j * turn * angle)
    by_centre = dict(i=arm.real, j=arm.imag)
    for words in (by_centre, dict(radius=math.copysign(radius, math.pi - angle))):
        contour = Contour(start.real, 5.0, start.imag)
        contour.arc(turn, end.real, end.imag, -2.0, line=1, feed=100.0, **words)
        (arc,) = contour.elements
        assert (arc.start, arc.z0, arc.z1) == (start, 5.0, -2.0)
        assert arc.end == pytest.approx(end, abs=1e-9)
        assert arc.curve.centre == pytest.approx(centre, abs=1e-9)
        assert arc.curve.sweep == pytest.approx(turn * angle, abs=1e-9)


@pytest.mark.parametrize("words", [dict(i=-3.0), dict(j=4.0), dict(i=-3.0, j=4.0)])
@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("end", [(), (10.0, 0.0), (10.0, 1e-12)])
def test_no_end_or_the_start_as_end_is_a_full_circle(turn, end, words):
    arc = arc_of(turn, *end, **words)
    assert arc.sweep == turn * 2 * math.pi
    assert arc.centre == complex(10.0 + words.get("i", 0.0), words.get("j", 0.0))


def test_a_rounded_centre_is_moved_to_be_as_far_from_both_ends():
    arc = arc_of(1, 0.0, 10.0, i=-10.0, j=0.004)
    assert abs(10.0 - arc.centre) == pytest.approx(abs(10j - arc.centre))
    assert abs(arc.centre) < 0.004


def test_a_half_circle_with_a_rounded_radius_closes():
    contour = started(closing=0.001)
    contour.arc(1, -10.0, 0.0, radius=9.9996, line=1, feed=100.0)
    assert contour.elements[0].curve.sweep == pytest.approx(math.pi)


def test_a_helix_keeps_its_heights():
    contour = started()
    contour.arc(1, z=-3.0, i=-10.0, line=1, feed=100.0)
    (arc,) = contour.elements
    assert isinstance(arc.curve, Arc)
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
            [("arc", dict(turn=-1, x=3.0, j=-1.0, radius=4.0, **CUT))],
            "G12.1 line 1: G2: either R or I and J, not both",
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


@pytest.mark.parametrize("words", [dict(i=-7.0), dict(radius=3.0)])
def test_no_reading_is_named_that_does_not_close_the_arc(words):
    """From (20, 5) to (12, 13), or to half of either X: neither a radius of 7 nor one of 3."""
    contour = raised()
    with pytest.raises(Refusal, match=r"(end|at least 5\.\d+)$"):
        contour.arc(1, 12.0, 13.0, line=2, feed=100.0, **words)


def test_where_the_section_began_x_is_known_whatever_its_words_mean():
    """From the machine's X10 to a word of 8: a diameter, then the quarter has the radius 6."""
    message = refused([("arc", dict(turn=1, x=8.0, c=6.0, i=-6.0, **CUT))])
    assert message.endswith("it would close with X read as a diameter (POLAR_X = diameter)")


def test_no_reading_is_named_where_no_word_is_a_diameter():
    quarter = dict(turn=1, x=0.0, c=5.0, i=-5.0, **CUT)  # it would close from X5 on
    assert refused([("arc", quarter)], diameter=None).endswith("from the end")


# What LinuxCNC forgives any arc: a thousandth of its radius, or what rounded words need.
ROUNDED = dict(closing=0.0127)


@pytest.mark.parametrize(
    ("radius", "options", "forgiven"),
    [(10.0, {}, 0.01), (10.0, ROUNDED, 0.0127), (100.0, ROUNDED, 0.1)],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_the_end_of_an_arc_may_be_off_its_circle_by_what_is_forgiven(
    radius, options, forgiven, sign
):
    for share in (0.98, 1.02):
        contour = Contour(radius, 0.0, **options)
        end = radius + sign * share * forgiven
        if share < 1.0:
            contour.arc(1, 0.0, end, i=-radius, line=1, feed=100.0)
            continue
        with pytest.raises(Refusal, match="does not close"):
            contour.arc(1, 0.0, end, i=-radius, line=1, feed=100.0)


@pytest.mark.parametrize(
    ("half", "options", "forgiven"), [(10.0, {}, 0.01), (1.0, ROUNDED, 0.00635)]
)
def test_the_radius_of_a_half_circle_may_be_too_small_by_what_is_forgiven(half, options, forgiven):
    for share in (0.98, 1.02):
        contour = Contour(half, 0.0, **options)
        words = dict(radius=half - share * forgiven, line=1, feed=100.0)
        if share < 1.0:
            contour.arc(1, -half, 0.0, **words)
            continue
        with pytest.raises(Refusal, match="does not close"):
            contour.arc(1, -half, 0.0, **words)


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


@pytest.mark.parametrize(("rounding", "taken"), [(0.9e-6, True), (1.1e-6, False)])
def test_rounding_counts_neither_for_ramps_nor_for_ends(rounding, taken):
    """Ends so near to each other are one place."""
    contour = started()
    contour.compensation(41, 2.0, line=1)
    arc = dict(x=10.0 - rounding, c=0.0, radius=4.0, line=1, feed=100.0)
    if taken:
        contour.line(c=2.0 - rounding, line=1, feed=100.0)
        with pytest.raises(Refusal, match="a full circle needs I and J"):
            started().arc(1, **arc)
        return
    with pytest.raises(Refusal, match="must be at least the tool radius"):
        contour.line(c=2.0 - rounding, line=1, feed=100.0)
    started().arc(1, **arc)


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


@pytest.mark.parametrize("word", ["x", "c", "z"])
def test_a_line_beyond_any_machine(word):
    contour = started()
    with pytest.raises(Refusal) as refused:
        contour.line(**{word: -2e6}, line=7, feed=100.0)
    assert refused.value.message == (
        f"G12.1 line 7: {word.upper()}-2000000 is no length: at most 1000000"
    )
    contour.line(**{word: 1e6}, line=7, feed=100.0)


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


@pytest.mark.parametrize("words", [dict(i=-10.0), dict(j=5.0), dict(radius=4.7)])
def test_the_other_reading_of_x_counts_for_start_and_end(words):
    """From (20, 5) to (12, 13): with half of each X an arc about (0, 5), or about (10, 10)."""
    contour = raised()
    with pytest.raises(Refusal) as refused:
        contour.arc(1, 12.0, 13.0, line=2, feed=100.0, **words)
    assert refused.value.message.endswith(
        "it would close with X read as a diameter (POLAR_X = diameter)"
    )


def raised():
    """Return a contour that has come to (20, 5)."""
    contour = Contour(20.0, 0.0)
    contour.line(c=5.0, line=1, feed=100.0)
    return contour


# A tool that stands beside the programmed place until a G1 takes it there.


@pytest.mark.parametrize("beside", [3.0, -3.0])
@pytest.mark.parametrize("plunged", [False, True])
def test_an_arc_cannot_be_the_first(beside, plunged):
    contour = Contour(20.0, 0.0, beside=beside)
    if plunged:
        contour.line(z=-1.0, line=6, feed=100.0)
    with pytest.raises(Refusal) as refused:
        contour.arc(1, 0.0, 20.0, radius=20.0, line=7, feed=100.0)
    assert refused.value.message == (
        "G12.1 line 7: G3 needs a G1 with X or C before it: the tool stands 3 beside X's line "
        "(POLAR_TOOL_OFFSET)"
    )


def test_behind_a_g1_an_arc_begins_where_that_was_programmed_to_end():
    contour = Contour(20.0, 0.0, beside=3.0)
    contour.line(30.0, line=6, feed=100.0)
    contour.arc(1, 0.0, 30.0, i=-30.0, line=7, feed=100.0)
    line, arc = contour.elements
    assert (line.start, line.end, arc.start) == (20.0 + 3j, 30.0 + 0j, 30.0 + 0j)
    assert arc.curve.sweep == pytest.approx(math.pi / 2)
