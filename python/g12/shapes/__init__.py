# SPDX-License-Identifier: GPL-2.0-or-later
"""The planners of shapes and holes on a lathe: entries in, the values of the sub out."""

SHAPE_SUBS = ("polar_polygon", "polar_slot", "polar_pocket")
