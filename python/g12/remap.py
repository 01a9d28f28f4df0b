# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers that the REMAP lines of `configs/include/` name: one or two per code."""

from __future__ import annotations

from g12.host.loading import loaded_handlers

HANDLERS_OF_MODULE = {
    "g12.host.handlers.aborts": ("g12_on_abort",),
    "g12.host.handlers.cycles": (
        "circle_mill_perimeter",
        "circle_mill_pocket",
        "cycle_done",
        "g12_bore",
        "g12_frame",
        "g12_haas",
        "g12_mitsubishi",
        "g12_thread",
        "g12_yasnac",
        "g13_bore",
        "g13_frame",
        "g13_haas",
        "g13_mitsubishi",
        "g13_thread",
        "g13_yasnac",
    ),
    "g12.host.handlers.polar": ("polar_off", "polar_on"),
    "g12.host.handlers.cylinder": ("cylinder_mode",),
    "g12.host.handlers.shapes": ("polar_shape", "polar_shape_done"),
    "g12.host.spindle_c": ("spindle_c_is_on", "spindle_c_off", "spindle_c_on"),
}
# for `from g12.remap import *` in a user's own remap
__all__ = [name for names in HANDLERS_OF_MODULE.values() for name in names]

for module, names in HANDLERS_OF_MODULE.items():
    globals().update(loaded_handlers(module, names))
