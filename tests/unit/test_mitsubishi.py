# SPDX-License-Identifier: GPL-2.0-or-later
"""The Mitsubishi planner by itself: planes, offset and messages, without LinuxCNC."""

import pytest

from g12.cycles.mitsubishi import MitsubishiCircle, plan_circle
from g12.request.words import Words
from support.planner_context import BAD_MODES, MM, reported, words_of

STANDING = MM._replace(x=1.0, y=2.0, z=3.0)


def plan(words, **found):
    return plan_circle(Words("G13", words_of(words)), STANDING._replace(**found))


@pytest.mark.parametrize(
    ("plane", "number", "along"), [("G17", 17, 1), ("G18", 18, 3), ("G19", 19, 2)]
)
def test_the_circle_lies_along_the_plane_s_first_axis(plane, number, along):
    assert plan("I50 D2", plane=plane) == MitsubishiCircle(number, along, 40.0)


@pytest.mark.parametrize(
    ("words", "radius"),
    [
        ("I.00508 D0", 0.00508),
        ("I1 D3", 3.0),
    ],
)
def test_a_positive_offset_reduces_the_circle_a_negative_one_enlarges_it(words, radius):
    assert plan(words).radius == pytest.approx(radius)


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        ("R.5 D2", "R0.5 is not a word of this cycle, which knows I D F"),
        ("I50", "D is missing: the tool whose radius reduces the circle, D0 for none"),
        ("I0 D0", "I0 must be greater than the tool radius 0 (D0) by at least 0.00508"),
    ],
)
def test_a_bad_block_is_refused_by_name(words, rule):
    assert reported(plan, words) == f"G13: {rule}"


@pytest.mark.parametrize(
    ("modes", "rule"),
    [
        *BAD_MODES,
        (dict(offset_pending=True), "the tool is still offset: after G40 move in X or Y first"),
        (dict(plane="G17.1"), "needs plane G17, G18 or G19, but G17.1 is active"),
    ],
)
def test_a_mode_that_cannot_work_is_refused(modes, rule):
    assert reported(plan, "I50 D2", **modes) == f"G13: {rule}"
