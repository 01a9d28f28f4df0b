# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the kinematics of configs/kinematics are installed, and what needs them."""

import pytest

from g12.tools.install.kinematics_rules import module_installed

needs_kinematics = pytest.mark.skipif(
    not module_installed("polar_xzc"), reason="first: make kinematics"
)


def marked(inis):
    """Return INI files as parameters of a test, those with the kinematics marked."""
    marks = {True: needs_kinematics, False: ()}
    return [pytest.param(ini, marks=marks["kinematics" in ini.stem]) for ini in inis]
