# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers that the REMAP lines of `configs/include/` name: one or two per code.

Each module is loaded separately: a broken one does not affect the others.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterable

from g12.errors import Refusal
from g12.host import messages

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
    "g12.host.handlers.sections": ("cylinder_mode", "polar_off", "polar_on"),
    "g12.host.handlers.shapes": ("polar_shape", "polar_shape_done"),
    "g12.host.spindle_c": ("spindle_c_is_on", "spindle_c_off", "spindle_c_on"),
}
# for `from g12.remap import *` in a user's own remap
__all__ = [name for names in HANDLERS_OF_MODULE.values() for name in names]


def loaded_handlers(module: str, names: Iterable[str]) -> dict[str, Callable]:
    """Return the handlers of a module by name.

    If it does not load, the operator gets the reason when LinuxCNC starts, and each handler refuses
    with it. (An exception here would stop LinuxCNC with an empty message on the screen.)
    """
    try:
        loaded = importlib.import_module(module)
        if hasattr(loaded, "check_at_start"):
            loaded.check_at_start()
        return {name: getattr(loaded, name) for name in names}
    except Exception as error:
        text = _why(error)
        messages.report_at_start(text.removeprefix("g12: "))
        return {name: _refusing(name, text) for name in names}


def _why(error: Exception) -> str:
    if isinstance(error, Refusal):
        return error.message
    sys.excepthook(type(error), error, error.__traceback__)
    return messages.fault_text(error)


def _refusing(name: str, text: str) -> Callable:
    def refuse(self, **words):
        raise Refusal(text)

    refuse.__name__ = name
    return messages.handler(refuse)


for module, names in HANDLERS_OF_MODULE.items():
    globals().update(loaded_handlers(module, names))
