# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the kinematics of configs/kinematics are installed, and what needs them."""

import numpy as np
import pytest

from g12.tools.install.lathe.kinematics import is_outdated, module_file

MODULE = module_file()
needs_kinematics = pytest.mark.skipif(
    not MODULE or is_outdated(MODULE), reason="first: make kinematics"
)


def on_the_face(machine):
    """Tell whether X and Y are those of the face."""
    return machine.get("polar-xzc.face")


def place(machine):
    """Return X, Y and C of the world in force, as a screen shows them."""
    x, y, _, _, _, c, *_ = machine.stat().position
    return pytest.approx((x, y, c), abs=1e-6)


def keeps_its_limits(samples, seed=None):
    """Check that no joint ever went faster than it can: no jump between the worlds."""
    for axis, most in (("X", 150), ("C", 360)):
        assert np.abs(np.diff(samples.axes[axis])).max() * 1e3 <= most * 1.001, seed


def marked(inis):
    """Return INI files as parameters of a test, those with the kinematics marked."""
    marks = {True: needs_kinematics, False: ()}
    return [pytest.param(ini, marks=marks["kinematics" in ini.stem]) for ini in inis]
