# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the kinematics of configs/kinematics are installed, and what needs them."""

import re
import shutil
from pathlib import Path

import pytest


def installed():
    """Tell whether the LinuxCNC that the tests run finds the module."""
    script = Path(shutil.which("linuxcnc")).read_text(encoding="utf-8", errors="replace")
    folder = re.search(r"^LINUXCNC_RTLIB_DIR=(\S+)", script, re.MULTILINE)[1]
    return Path(folder, "polar_xzc.so").exists()


needs_kinematics = pytest.mark.skipif(not installed(), reason="first: make kinematics")


def marked(inis):
    """Return INI files as parameters of a test, those with the kinematics marked."""
    marks = {True: needs_kinematics, False: ()}
    return [pytest.param(ini, marks=marks["kinematics" in ini.stem]) for ini in inis]
