# SPDX-License-Identifier: GPL-2.0-or-later
"""Plane geometry that planners and tools share: values with methods, no units, no LinuxCNC.

Points are complex numbers. Angles are radians, counterclockwise positive.
"""
