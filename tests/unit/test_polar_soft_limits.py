# SPDX-License-Identifier: GPL-2.0-or-later
"""What the INI file says of a machine, and the travel of its axes."""

import re

import pytest

from g12.errors import Refusal
from g12.machine_ini import (
    Axis,
    axes_of,
    coordinates_of,
    millimetres_of,
    owns_g12_1,
    refuse_owned_codes,
    remaps_of,
)
from g12.polar.plan import Run
from g12.polar.soft_limits import Beyond, Scale, Travel

INI = """
[RS274NGC]
REMAP = G12.1 modalgroup=1 python=polar_on
REMAP=m410 modalgroup=10 argspec=P ngc=m410
[TRAJ]
LINEAR_UNITS = {units}
[AXIS_X]
MIN_LIMIT = -10 ; comment
MAX_LIMIT = 300
MAX_VELOCITY = 150
MAX_ACCELERATION = 1000
[AXIS_C]
MAX_VELOCITY = 360
"""


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("MAX_ACCELERATION = 0", "[AXIS_C] MAX_ACCELERATION = 0: must be above 0"),
        ("MAX_VELOCITY = -5", "[AXIS_C] MAX_VELOCITY = -5: must be above 0"),
        ("MAX_LIMIT = foo", "[AXIS_C] MAX_LIMIT = foo: must be a number"),
    ],
)
def test_an_axis_that_cannot_be(line, reason):
    with pytest.raises(Refusal, match=re.escape(reason)):
        axes_of(f"[AXIS_C]\n{line}\n")


def test_axes():
    axes = axes_of(INI)
    assert axes["X"] == Axis(-10, 300, 150, 1000)
    assert axes["C"] == Axis(-1e99, 1e99, 360, 1)
    assert axes["Z"] == Axis(-1e99, 1e99, 1, 1)


@pytest.mark.parametrize(
    ("units", "length"),
    [("mm", 1), ("metric", 1), ("inch", 25.4), ("in", 25.4), ("IMPERIAL", 25.4)],
)
def test_units(units, length):
    assert millimetres_of(INI.format(units=units)) == length
    assert millimetres_of("") == 1


def test_coordinates():
    assert coordinates_of("[TRAJ]\nCOORDINATES = X Z C\n") == {"X", "Z", "C"}
    assert coordinates_of("[TRAJ]\nCOORDINATES = xzc\n") == {"X", "Z", "C"}
    assert coordinates_of("") == set()


def test_remaps():
    assert remaps_of(INI) == {
        "G12.1": {"modalgroup": "1", "python": "polar_on"},
        "M410": {"modalgroup": "10", "argspec": "P", "ngc": "m410"},
    }


def travel(offset=0.0):
    axes = axes_of(INI)
    scale = {"X": Scale(1.0, offset), "Z": Scale(1.0, 0.0), "C": Scale(1.0, 0.0)}
    return Travel(axes, scale)


def test_moves_within_the_travel():
    steps = [Run(3, "XC", [(0, 0, 0, 1), (300, 1e6, 0, 1)], False), "an action"]
    assert travel().beyond(steps) is None
    assert travel().beyond([]) is None


def test_the_first_move_beyond_is_named_in_machine_coordinates():
    steps = [
        Run(3, "XC", [(290, 0, 0, 1)], False),
        Run(4, "XC", [(20, 0, 0, 1), (301, 0, 0, 1)], False),
    ]
    assert travel().beyond(steps) == Beyond(4, "X", 301, 300)
    assert travel(offset=20).beyond(steps) == Beyond(3, "X", 310, 300)


def test_inches_on_a_metric_machine():
    scales = {"X": Scale(25.4, -1.0), "Z": Scale(25.4, 0.0), "C": Scale(1.0, 0.0)}
    beyond = Travel(axes_of(INI), scales).beyond([Run(3, "XC", [(12, 0, 0, 1)], False)])
    assert beyond.position == pytest.approx(12 * 25.4 - 1)
    assert beyond.limit == pytest.approx(300)


def test_a_linuxcnc_with_a_g12_1_of_its_own_is_told_at_start_up():
    remaps = remaps_of(INI)
    refuse_owned_codes(remaps, owned=False)
    refuse_owned_codes({"G12.3": {}, "G13.3": {}}, owned=True)
    with pytest.raises(Refusal, match=r"REMAP = G12\.1: .*polar_g12_3\.inc"):
        refuse_owned_codes(remaps, owned=True)


@pytest.mark.parametrize(
    ("version", "owned"),
    [("2.9.0~pre1+git1.f12", False), ("2.9.10", False), ("2.10.0~pre1", True), ("3.0", True)],
)
def test_versions_that_own_g12_1(version, owned):
    assert owns_g12_1(version) == owned
