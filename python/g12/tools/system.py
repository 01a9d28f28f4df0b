# SPDX-License-Identifier: GPL-2.0-or-later
"""The system that LinuxCNC is installed on, and how the commands are called on it."""

from __future__ import annotations

PYTHON = "/usr/bin/python3"  # LinuxCNC's Python modules belong to the system's Python
DEBIAN_PACKAGE = "/usr/share/linuxcnc-g12/"
CALL = "g12" if __file__.startswith(DEBIAN_PACKAGE) else "python3 python/g12"
