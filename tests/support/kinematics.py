# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the kinematics of configs/kinematics are installed, and what needs them."""

import pytest

from g12.tools.install.kinematics_rules import module_has, module_installed

needs_kinematics = pytest.mark.skipif(
    not (module_installed("polar_xzc") and module_has(".tool-offset")),
    reason="first: make kinematics",
)


def on_the_face(machine):
    """Tell whether X and Y are those of the face."""
    return machine.get("polar-xzc.face")


def place(machine):
    """Return X, Y and C of the world in force, as a screen shows them."""
    x, y, _, _, _, c, *_ = machine.stat().position
    return pytest.approx((x, y, c), abs=1e-6)


def marked(inis):
    """Return INI files as parameters of a test, those with the kinematics marked."""
    marks = {True: needs_kinematics, False: ()}
    return [pytest.param(ini, marks=marks["kinematics" in ini.stem]) for ini in inis]
