# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers that the REMAP lines of `configs/include/` name: one or two per code."""

from __future__ import annotations

from g12.host.loading import loaded_handlers

CYCLES = (
    "circle_mill_perimeter",
    "circle_mill_pocket",
    "cycle_done",
    "g12_haas",
    "g12_mitsubishi",
    "g12_yasnac",
    "g13_haas",
    "g13_mitsubishi",
    "g13_yasnac",
)
POLAR = ("polar_off", "polar_on")
CYLINDER = ("cylinder_mode",)
SHAPES = ("polar_shape", "polar_shape_done")
SPINDLE_C = ("spindle_c_is_on", "spindle_c_off", "spindle_c_on")
# for `from g12.remap import *` in a user's own remap
__all__ = [*CYCLES, *POLAR, *CYLINDER, *SHAPES, *SPINDLE_C]

globals().update(loaded_handlers("g12.host.handlers.cycles", CYCLES))
globals().update(loaded_handlers("g12.host.handlers.polar", POLAR))
globals().update(loaded_handlers("g12.host.handlers.cylinder", CYLINDER))
globals().update(loaded_handlers("g12.host.handlers.shapes", SHAPES))
globals().update(loaded_handlers("g12.host.spindle_c", SPINDLE_C))
