# SPDX-License-Identifier: GPL-2.0-or-later
"""Codes that differ between machines: the clamp of C, C itself, the spindle that drives the tool.

A control says ``clamp C``, ``C axis on`` and ``M3 $live``; the machine's INI defines its codes
for them. A machine without a clamp, or whose C is always an axis, needs none.
"""

from collections.abc import Sequence
from dataclasses import replace

from g12.machine_ini import Remap
from g12.settings import Settings
from g12.tools.translate.blocks.control import Control

SPINDLE_C = {"C axis on": "spindle_c_on", "C axis off": "spindle_c_off"}
REFUSE_LIVE_TOOL = (
    "refuse: it is the live tool's: say [G12] LIVE_SPINDLE in the INI, LinuxCNC's spindle that "
    "drives the tool (install --with programs-… sets it)"
)


def on_machine(control: Control, settings: Settings, remaps: Sequence[Remap]) -> Control:
    """Return a control with the machine's own codes in place of those meanings."""
    own_codes = {
        **dict(zip(("clamp C", "unclamp C"), (f"M{code}" for code in settings.c_clamp))),
        **{
            meaning: remap.code
            for meaning, name in SPINDLE_C.items()
            for remap in reversed(remaps)  # the first counts
            if name in remap.handlers or remap.keywords.get("ngc") == name
        },
    }
    meanings = {
        code: _meaning_here(meaning, own_codes, settings.live_spindle)
        for code, meaning in control.meanings.items()
    }
    tables = {**control.tables, "holes": {**control.tables.get("holes", {}), **_of_holes(settings)}}
    return replace(control, meanings=meanings, tables=tables, live_spindle=settings.live_spindle)


def _of_holes(settings: Settings) -> dict[str, object]:
    clamp = " ".join(f"M{code}" for code in settings.c_clamp)
    found: dict[str, object] = {"clamp": clamp} if clamp else {}
    return {**found, "spindle": int(settings.live_spindle)} if settings.live_spindle else found


def _meaning_here(meaning: str, own_codes: dict[str, str], live: str) -> str:
    """Return what a code is on the machine; ``live`` is the live tool's spindle, "" unknown."""
    if meaning in ("clamp C", "unclamp C", *SPINDLE_C):
        return own_codes.get(meaning, "comment")
    if "$live" not in meaning and "$all" not in meaning:
        return meaning
    if not live:
        return meaning.replace(" $all", "") if "$all" in meaning else REFUSE_LIVE_TOOL
    first = live == "0"
    texts = {"$live": "" if first else f"${live}", "$all": "" if first else "$-1"}
    return " ".join(filter(None, (texts.get(text, text) for text in meaning.split())))
