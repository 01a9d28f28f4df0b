# SPDX-License-Identifier: GPL-2.0-or-later
"""The travel of a machine's axes."""

import pytest

from g12.machine_ini import Axis
from g12.moves.setup import AxisScale, Beyond, SoftLimits
from g12.moves.steps import Segments

AXES = {
    "X": Axis(-10, 300, 150, 1000),
    "C": Axis(-1e99, 1e99, 360, 1),
    "Z": Axis(-1e99, 1e99, 1, 1),
}


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
