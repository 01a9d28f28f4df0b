# SPDX-License-Identifier: GPL-2.0-or-later
"""A control on a machine: what the machine's INI says of the codes that differ between machines.

A control says ``clamp C``, ``C axis on`` and ``M3 $live``; the INI defines the machine's codes for
them. A machine without a clamp, or whose C is always an axis, needs none.
"""

import os
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from g12.machine_ini import Remap, face_joints, remap_lines
from g12.tools.machine.ini import Ini
from g12.tools.machine.stored_positions import unset_positions
from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import AXIS_NUMBERS

SPINDLE_C = {"C axis on": "spindle_c_on", "C axis off": "spindle_c_off"}
USER_M_CODE = re.compile(r"M(1[0-9]{2})")
REFUSE_LIVE_TOOL = (
    "refuse: it is the live tool's: say [G12] LIVE_SPINDLE in the INI, LinuxCNC's spindle that "
    "drives the tool (install --with programs-… sets it)"
)


def on_machine(control: Control, ini: Ini) -> Control:
    """Return a control with the machine's own axes, codes, spindle and positions never set."""
    settings, remaps = ini.settings, _remaps_in_force(ini)
    clamp = [f"M{code}" for code in settings.c_clamp]
    own = dict(zip(("clamp C", "unclamp C"), clamp))
    own |= {meaning: _code_of(remaps, name) or "comment" for meaning, name in SPINDLE_C.items()}
    live = settings.live_spindle
    holes: dict[str, Any] = {"clamp": " ".join(clamp)} if clamp else {}
    holes |= {"spindle": int(live)} if live else {}
    of_machine = {"holes": holes, "reference": {"unset": unset_positions(ini)}}
    polar = (_code_of(remaps, "polar_on", "G"), _code_of(remaps, "polar_off", "G"))
    cylinder = _code_of(remaps, "cylinder_mode", "G")
    own_axes = ini.axes.replace("Y", "") if face_joints(ini.get) else ini.axes  # Y is the face's
    axes = "".join(axis for axis in AXIS_NUMBERS if axis in own_axes)
    return replace(
        control,
        axes=control.axes if control.onto else axes,
        meanings={code: _meaning_here(m, own, live) for code, m in control.meanings.items()},
        tables={
            **control.tables,
            **{n: {**control.tables.get(n, {}), **t} for n, t in of_machine.items()},
        },
        machine_codes=_machine_codes(ini, remaps),
        live_spindle=live,
        polar_codes=polar if all(polar) else control.polar_codes,
        cylinder_code=(cylinder, settings.cylinder_word) if cylinder else control.cylinder_code,
    )


def _remaps_in_force(ini: Ini) -> list[Remap]:
    """Return the REMAP lines; of two for one code, G12.1 and G012.1, LinuxCNC takes the last."""
    return list({remap.number: remap for remap in remap_lines(ini.all)}.values())


def _code_of(remaps: Sequence[Remap], name: str, letter: str = "") -> str:
    """Return the code of the first REMAP line with a handler or a subroutine, "" if none has it."""
    found = (
        remap.code
        for remap in remaps
        if name in remap.handlers or remap.keywords.get("ngc") == name
    )
    return next((code for code in found if code.startswith(letter)), "")


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


def _machine_codes(ini: Ini, remaps: Sequence[Remap]) -> frozenset[str]:
    """Return the machine's M codes besides LinuxCNC's: REMAP lines and M1xx files."""
    numbers = (remap.number for remap in remaps)
    remapped = {f"M{tenths // 10}" for letter, tenths in numbers if letter == "M"}
    names = [ini.get("DISPLAY", "PROGRAM_PREFIX"), ini.get("RS274NGC", "USER_M_PATH")]
    paths = [path for name in names if name for path in name.split(":")]
    folders = [ini.directory / os.path.expanduser(path) for path in paths]
    files = [file for folder in folders if folder.is_dir() for file in folder.iterdir()]
    return frozenset(remapped | {file.name for file in files if _is_code(file)})


def _is_code(file: Path) -> bool:
    return bool(USER_M_CODE.fullmatch(file.name)) and os.access(file, os.X_OK)
