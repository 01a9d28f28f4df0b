# SPDX-License-Identifier: GPL-2.0-or-later
"""The system that LinuxCNC is installed on."""

from __future__ import annotations

PYTHON = "/usr/bin/python3"  # LinuxCNC's Python modules belong to the system's Python
