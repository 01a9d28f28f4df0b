# SPDX-License-Identifier: GPL-2.0-or-later
"""The Mitsubishi planner by itself: planes, offset and messages, without LinuxCNC."""

import pytest

from g12.cycles.mitsubishi import MitsubishiCircle, plan_circle
from g12.errors import Refusal
from g12.request.words import Words
from support.planner_context import BAD_MODES, MM

STANDING = MM._replace(x=1.0, y=2.0, z=3.0)


def plan(found=STANDING, **values):
    return plan_circle(Words("G13", values), found)


@pytest.mark.parametrize(
    ("plane", "circle"),
    [
        ("G17", MitsubishiCircle(17, 1.0, 40.0)),
        ("G18", MitsubishiCircle(18, 3.0, 40.0)),
        ("G19", MitsubishiCircle(19, 2.0, 40.0)),
    ],
)
def test_the_circle_lies_along_the_plane_s_first_axis(plane, circle):
    assert plan(found=STANDING._replace(plane=plane), I=50.0, D=2) == circle


@pytest.mark.parametrize(
    ("words", "radius"),
    [
        (dict(I=50.0, D=2), 40.0),
        (dict(I=-50.0, D=2), 40.0),
        (dict(I=50.0, D=0), 50.0),
        (dict(I=50.0, D=4), 50.0),
        (dict(I=50.0, D=3), 52.0),
        (dict(I=1.0, D=3), 3.0),
        (dict(I=0.00508, D=0), 0.00508),
        (dict(I=10.00508, D=2), pytest.approx(0.00508)),
    ],
)
def test_a_positive_offset_reduces_the_circle(words, radius):
    assert plan(**words).radius == radius


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (dict(R=0.5, D=2), "G13: R0.5 is not a word of this cycle, which knows I D F"),
        (dict(D=2), "G13: I is missing: the radius of the circle"),
        (
            dict(I=50.0),
            "G13: D is missing: the tool whose radius reduces the circle, D0 for none",
        ),
        (
            dict(I=10.0, D=2),
            "G13: I10 must be greater than the tool radius 10 (D2) by at least 0.00508",
        ),
        (
            dict(I=-5.0, D=2),
            "G13: I-5 must be greater than the tool radius 10 (D2) by at least 0.00508",
        ),
        (
            dict(I=0.0, D=0),
            "G13: I0 must be greater than the tool radius 0 (D0) by at least 0.00508",
        ),
        (dict(I=50.0, D=-2), "G13: D-2 must be at least 0"),
        (dict(I=50.0, D=1.5), "G13: D1.5 must be a whole number"),
        (dict(I=50.0, D=77), "G13: D77 is not in the tool table"),
        (
            dict(I=50.0, D=2, Z=-1.0),
            "G13: Z-1 is not a word of this cycle, which knows I D F",
        ),
        (
            dict(I=50.0, D=2, Q=1.0),
            "G13: Q1 is not a word of this cycle, which knows I D F",
        ),
    ],
)
def test_a_bad_block_is_refused_by_name(words, message):
    with pytest.raises(Refusal) as refused:
        plan(**words)
    assert refused.value.message == message


@pytest.mark.parametrize(
    ("modes", "rule"),
    [
        *BAD_MODES,
        (
            dict(offset_pending=True),
            "the tool still stands offset: after G40 move in X or Y first",
        ),
        (
            dict(plane="G17.1, G18.1 or G19.1"),
            "needs plane G17, G18 or G19, but G17.1, G18.1 or G19.1 is active",
        ),
    ],
)
def test_a_mode_that_cannot_work_is_refused(modes, rule):
    with pytest.raises(Refusal) as refused:
        plan(found=STANDING._replace(**modes), I=50.0, D=2)
    assert refused.value.message == f"G13: {rule}"
