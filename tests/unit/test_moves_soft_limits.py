# SPDX-License-Identifier: GPL-2.0-or-later
"""The travel of a machine's axes."""

import pytest

from g12.machine_ini import Axis
from g12.moves.setup import AxisScale, Beyond, SoftLimits
from g12.moves.steps import Segments
from g12.section.modes import Action

AXES = {
    "X": Axis(-10, 300, 150, 1000),
    "C": Axis(-1e99, 1e99, 360, 1),
    "Z": Axis(-1e99, 1e99, 1, 1),
}


def travel(offset=0.0):
    scale = {"X": AxisScale(1.0, offset), "C": AxisScale(1.0, 0.0), "Z": AxisScale(1.0, 0.0)}
    return SoftLimits(AXES, scale, "mm")


def test_moves_within_the_travel():
    steps = [Segments(3, "XC", [(0, 0, 0, 1), (300, 1e6, 0, 1)], False), Action(4, "M8", None)]
    assert travel().beyond(steps) is None
    assert travel().beyond([]) is None


def test_the_first_move_beyond_is_named_in_machine_coordinates():
    steps = [
        Segments(3, "XC", [(290, 0, 0, 1)], False),
        Segments(4, "XC", [(20, 0, 0, 1), (301, 0, 0, 1)], False),
    ]
    assert travel().beyond(steps) == Beyond(4, "X", 301, 300, "mm", False)
    assert travel(offset=20).beyond(steps) == Beyond(3, "X", 310, 300, "mm", False)


@pytest.mark.parametrize(
    ("place", "beyond"),
    [
        ((-10.001, 0, 0), ("X", -10.001, -10)),
        ((0, 720.001, 0), ("C", 720.001, 720)),
        ((0, -360.001, 0), ("C", -360.001, -360)),
        ((0, 0, 20.001), ("Z", 20.001, 20)),
        ((0, 0, -200.001), ("Z", -200.001, -200)),
        ((-11, 0, -201), ("X", -11, -10)),
    ],
)
def test_every_axis_has_its_ends_and_may_stand_on_them(place, beyond):
    axes = {**AXES, "C": Axis(-360, 720, 1, 1), "Z": Axis(-200, 20, 1, 1)}
    limits = SoftLimits(axes, dict.fromkeys("XCZ", AxisScale(1.0, 0.0)), "mm")
    ends = [(-10, -360, -200, 1), (300, 720, 20, 1)]
    within = Segments(3, "XCZ", ends, False)
    assert limits.beyond([within]) is None
    out = Segments(4, "XCZ", [*ends, (*place, 1)], False)
    unit = "degrees" if beyond[0] == "C" else "mm"
    assert limits.beyond([within, out]) == (4, *beyond, unit, False)


@pytest.mark.parametrize(
    ("beyond", "text"),
    [
        (("X", 301, 300, "mm", True), "X axis would go to 301 mm (radius), beyond its limit 300 mm"
                                      " (G20 is active)"),
        (("Z", 5.5, 5, "in", True), "Z axis would go to 5.5 in, beyond its limit 5 in"
                                    " (G21 is active)"),
        (("C", 721, 720, "degrees", False), "C axis would go to 721 degrees, beyond its limit"
                                            " 720 degrees"),
    ],
)  # fmt: skip
def test_the_words_for_it(beyond, text):
    """A machine shows the radius of X, in its own unit."""
    assert Beyond(4, *beyond).text(True) == f"the {text}"
    assert Beyond(4, *beyond).text(False) == f"the {text}".replace(" (radius)", "")


def test_inches_on_a_metric_machine():
    scales = {"X": AxisScale(25.4, -1.0), "C": AxisScale(1.0, 0.0), "Z": AxisScale(25.4, 0.0)}
    beyond = SoftLimits(AXES, scales, "mm").beyond([Segments(3, "XC", [(12, 0, 0, 1)], False)])
    assert beyond.position == pytest.approx(12 * 25.4 - 1)
    assert beyond.limit == pytest.approx(300)
    assert beyond.unit == "mm" and beyond.converted


def test_an_inch_that_the_ini_rounds_is_an_inch():
    """As with LINEAR_UNITS = 0.0393700787."""
    scales = dict.fromkeys("XCZ", AxisScale(1 - 2e-9, 0.0))
    beyond = SoftLimits(AXES, scales, "in").beyond([Segments(3, "XC", [(400, 0, 0, 1)], False)])
    assert not beyond.converted
