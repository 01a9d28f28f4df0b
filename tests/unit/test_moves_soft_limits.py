# SPDX-License-Identifier: GPL-2.0-or-later
"""The travel of a machine's axes."""

import pytest

from g12.machine_ini import Axis
from g12.moves.soft_limits import AxisScale, Beyond, SoftLimits
from g12.moves.steps import BlockMoves

AXES = {
    "X": Axis(-10, 300, 150, 1000),
    "C": Axis(-1e99, 1e99, 360, 1),
    "Z": Axis(-1e99, 1e99, 1, 1),
}


def travel(offset=0.0):
    scale = {"X": AxisScale(1.0, offset), "Z": AxisScale(1.0, 0.0), "C": AxisScale(1.0, 0.0)}
    return SoftLimits(AXES, scale, "mm")


def test_moves_within_the_travel():
    steps = [BlockMoves(3, "XC", [(0, 0, 0, 1), (300, 1e6, 0, 1)], False), "an action"]
    assert travel().beyond(steps) is None
    assert travel().beyond([]) is None


def test_the_first_move_beyond_is_named_in_machine_coordinates():
    steps = [
        BlockMoves(3, "XC", [(290, 0, 0, 1)], False),
        BlockMoves(4, "XC", [(20, 0, 0, 1), (301, 0, 0, 1)], False),
    ]
    assert travel().beyond(steps) == Beyond(4, "X", 301, 300, "mm", False)
    assert travel(offset=20).beyond(steps) == Beyond(3, "X", 310, 300, "mm", False)


def test_inches_on_a_metric_machine():
    scales = {"X": AxisScale(25.4, -1.0), "Z": AxisScale(25.4, 0.0), "C": AxisScale(1.0, 0.0)}
    beyond = SoftLimits(AXES, scales, "mm").beyond([BlockMoves(3, "XC", [(12, 0, 0, 1)], False)])
    assert beyond.position == pytest.approx(12 * 25.4 - 1)
    assert beyond.limit == pytest.approx(300)
    assert beyond.unit == "mm" and beyond.converted


def test_an_inch_that_the_ini_rounds_is_an_inch():
    """As with LINEAR_UNITS = 0.0393700787."""
    scales = dict.fromkeys("XZC", AxisScale(1 - 2e-9, 0.0))
    beyond = SoftLimits(AXES, scales, "in").beyond([BlockMoves(3, "XC", [(400, 0, 0, 1)], False)])
    assert not beyond.converted
