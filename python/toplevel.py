# SPDX-License-Identifier: GPL-2.0-or-later
"""The [PYTHON]TOPLEVEL module for users who have none of their own."""

import remap  # noqa: F401 - LinuxCNC finds the handlers through this name
