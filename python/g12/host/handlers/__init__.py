# SPDX-License-Identifier: GPL-2.0-or-later
"""The functions that LinuxCNC calls for each code: they read, plan, and hand over the motion."""
