# SPDX-License-Identifier: GPL-2.0-or-later
"""A control on a machine: what the machine's INI says of the codes that differ between machines.

A control says ``clamp C``, ``C axis on`` and ``M3 $live``; the INI defines the machine's codes for
them. A machine without a clamp, or whose C is always an axis, needs none.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import zip_longest
from typing import Any

from g12.machine_ini import Remap, face_joints, m_codes_of, remap_lines
from g12.settings import INI_SECTION, LIVE_SPINDLE
from g12.tools.machine.ini import Ini
from g12.tools.machine.stored_positions import unset_positions
from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import AXIS_NUMBERS

ON_MILL = {"G7": "G8", "G18": "G17"}  # at the start, in place of a lathe's
SPINDLE_C = {"C axis on": "spindle_c_on", "C axis off": "spindle_c_off"}


def on_machine(control: Control, ini: Ini) -> Control:
    """Return a control with the machine's own axes, codes, spindle and positions never set."""
    control = _round_part_of_mill(control, ini)
    settings, remaps = ini.settings, _remaps_in_force(ini)
    clamp = [f"M{code}" for code in settings.c_clamp]
    own = dict(zip_longest(("clamp C", "unclamp C"), clamp, fillvalue="comment"))
    own |= {meaning: _code_of(remaps, name) or "comment" for meaning, name in SPINDLE_C.items()}
    on_mill = bool(control.value("mill", "turn", ""))
    live = "0" if on_mill else ini.get(INI_SECTION, LIVE_SPINDLE) or ""
    holes: dict[str, Any] = {"clamp": " ".join(clamp)} if clamp else {}
    of_machine = {"holes": holes, "reference": {"unset": unset_positions(ini)}}
    m_codes = m_codes_of(ini.get, remaps, ini.directory)
    polar = (_code_of(remaps, "polar_on", "G"), _code_of(remaps, "polar_off", "G"))
    cylinder = _code_of(remaps, "cylinder_mode", "G")
    own_axes = ini.axes.replace("Y", "") if face_joints(ini.get) else ini.axes  # Y is the face's
    axes = "".join(axis for axis in AXIS_NUMBERS if axis in own_axes)
    return replace(
        control,
        axes=control.axes if control.onto else axes,
        meanings={code: own.get(m, m) for code, m in control.meanings.items()},
        tables={
            **control.tables,
            **{n: {**control.tables.get(n, {}), **t} for n, t in of_machine.items()},
        },
        machine_codes=frozenset(f"M{code}" for code in m_codes),
        live_spindle=live,
        polar_codes=polar if all(polar) else control.polar_codes,
        cylinder_code=(cylinder, settings.cylinder_word) if cylinder else control.cylinder_code,
    )


def _round_part_of_mill(control: Control, ini: Ini) -> Control:
    """Return a control for programs round a part with a mill's rotary axis, if the INI has one."""
    turn = next((letter for letter in "AB" if letter in ini.axes), "")
    if control.onto != "round" or not turn or "Y" not in ini.axes:
        return control
    sense = -1.0 if ini.settings.rotary_sense == "reversed" else 1.0
    mill = {**control.tables["mill"], "turn": turn, "sense": sense}
    start = [ON_MILL.get(code, code) for code in control.start]
    tables = {**control.tables, "mill": mill}
    return replace(control, axes=f"XYZ{turn}", start=tuple(start), tables=tables)


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
