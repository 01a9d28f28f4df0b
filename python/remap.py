# SPDX-License-Identifier: GPL-2.0-or-later
"""The `remap` module for users who have none of their own."""

from g12.remap import *  # noqa: F403 - LinuxCNC looks the handlers up here by name
